//! A part of an ellipse, by conjugate half axes.

use super::kind::Kind;
use super::span::Span;
use super::sweep::{self, checked_sweep, passages};
use super::weld::{Similarity, spread_to};
use super::{Bezier, Break, Cone, Curve, CurveError, EllipticArc, End, check_finite, length, quadrature, turning};
use crate::geometry::{Point, Vec2, scaled};
use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

impl EllipticArc {
    /// See [`Curve::ellipse`](super::Curve::ellipse).
    pub(super) fn new(center: Point, u: Vec2, v: Vec2, start_rad: f64, sweep_rad: f64) -> Result<Self, CurveError> {
        check_finite([center.x, center.y, u.x, u.y, v.x, v.y, start_rad, sweep_rad])?;
        // The radius of the circle of the same area.
        let radius = u.cross(v).abs().sqrt();
        if radius == 0.0 {
            return Err(CurveError::Radius { radius });
        }
        check_finite([radius])?;
        let sweep_rad = checked_sweep(sweep_rad)?;
        let at = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            center + (u * cos + v * sin)
        };
        let start = at(start_rad);
        let end = if sweep_rad.abs() == TAU { start } else { at(start_rad + sweep_rad) };
        check_finite([start.x, start.y, end.x, end.y])?;
        Ok(EllipticArc { center, u, v, start_rad, sweep_rad, ends: [start, end] })
    }

    fn angle(&self, t: f64) -> f64 {
        self.start_rad + self.sweep_rad * t
    }

    /// The derivative by the parameter angle.
    fn along(&self, angle: f64) -> Vec2 {
        let (sin, cos) = libm::sincos(angle);
        self.v * cos - self.u * sin
    }

    /// The parameter at which the curve has turned by `turned` ≥ 0 from its start.
    fn at_turning(&self, turned: f64) -> f64 {
        let halves = libm::floor(turned / PI);
        let orientation = 1f64.copysign(self.u.cross(self.v) * self.sweep_rad);
        let (sin, cos) = libm::sincos((turned - halves * PI) * orientation);
        let d = self.along(self.start_rad);
        let wanted = Vec2::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y);
        let angle = libm::atan2(self.v.cross(wanted), self.u.cross(wanted));
        let sign = 1f64.copysign(self.sweep_rad);
        let ahead = (angle - self.start_rad) * sign;
        // With an allowance for rounding: the angle may be just below 0.
        let rest = ahead - PI * libm::floor(ahead / PI + 4.0 * f64::EPSILON);
        ((halves * PI + rest) / self.sweep_rad.abs()).clamp(0.0, 1.0)
    }

    /// Exact rational quadratics over t0..t1, each over at most a quarter turn of the parameter angle, with its range
    /// of t; see [`conic_parameter`].
    ///
    /// ```text
    ///             ● apex, weight cos(half)      The control points are both ends and the meeting point of their
    ///          ╱ ╭───╮ ╲                        tangents. `half` is half the range of the parameter angle.
    ///       ╱╭───╯   ╰───╮╲
    ///   start ●         ● end
    /// ```
    fn conics(&self, t0: f64, t1: f64) -> Vec<(Bezier, f64, f64)> {
        let sweep = self.sweep_rad * (t1 - t0);
        let count = libm::ceil(sweep.abs() / FRAC_PI_2).clamp(1.0, 4.0);
        let at = |k: f64| if k == count { t1 } else { t0 + (t1 - t0) * (k / count) };
        (0..count as u32)
            .map(|k| {
                let (from, to) = (at(f64::from(k)), at(f64::from(k) + 1.0));
                let half = 0.5 * self.sweep_rad * (to - from);
                let (start, end) = (self.inner_point(from), self.inner_point(to));
                let apex = start + self.along(self.angle(from)) * libm::tan(half);
                let weights = vec![1.0, libm::cos(half), 1.0];
                (Bezier { points: vec![start, apex, end], weights: Some(weights) }, from, to)
            })
            .collect()
    }
}

impl Kind for EllipticArc {
    fn name(&self) -> &'static str {
        "ellipse"
    }
    fn ends(&self) -> [Point; 2] {
        self.ends
    }
    /// Computed from the start, with the rounding of the ends spread along the arc.
    fn inner_point(&self, t: f64) -> Point {
        let [start, end] = self.ends;
        let half = 0.5 * self.sweep_rad;
        let from_start = |t: f64| self.along(self.start_rad + half * t) * (2.0 * libm::sin(half * t));
        start + (from_start(t) + ((end - start) - from_start(1.0)) * t)
    }
    fn derivative(&self, t: f64) -> Vec2 {
        self.along(self.angle(t)) * self.sweep_rad
    }
    fn second_derivative(&self, t: f64) -> Vec2 {
        let (sin, cos) = libm::sincos(self.angle(t));
        (self.u * cos + self.v * sin) * (-self.sweep_rad * self.sweep_rad)
    }
    fn spans(&self, t0: f64, t1: f64) -> Vec<Span<'_>> {
        conic_spans(self, t0, t1)
    }
    fn control_count(&self) -> usize {
        1
    }
    fn may_meet_itself(&self) -> bool {
        false
    }
    fn part(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Curve {
        let (start_rad, sweep_rad) = (self.angle(t0), self.sweep_rad * (t1 - t0));
        boxed(EllipticArc { start_rad, sweep_rad, ends, ..*self })
    }
    fn reversed(&self) -> Curve {
        let [start, end] = self.ends;
        boxed(EllipticArc { start_rad: self.angle(1.0), sweep_rad: -self.sweep_rad, ends: [end, start], ..*self })
    }
    fn scaled(&self, factor: f64) -> Curve {
        let scale = |p: Point| scaled(p, factor);
        let (center, u, v) = (scale(self.center), self.u * factor, self.v * factor);
        boxed(EllipticArc { center, u, v, ends: self.ends.map(scale), ..*self })
    }
    fn transformed(&self, map: kurbo::Affine) -> Curve {
        let [a, b, c, d, _, _] = map.as_coeffs();
        let (x_axis, y_axis) = (Vec2::new(a, b), Vec2::new(c, d));
        let vector = |v: Vec2| x_axis * v.x + y_axis * v.y;
        let (center, u, v) = (map * self.center, vector(self.u), vector(self.v));
        boxed(EllipticArc { center, u, v, ends: self.ends.map(|p| map * p), ..*self })
    }
    fn moved(&self, map: &Similarity, ends: [Point; 2]) -> Curve {
        let (center, u, v) = (map.point(self.center), map.vector(self.u), map.vector(self.v));
        boxed(EllipticArc { center, u, v, ends, ..*self })
    }
    /// The ellipse moves by the mean of both moves, and [`Kind::inner_point`] spreads the rest.
    fn spread(&self, moves: [Vec2; 2], ends: [Point; 2]) -> Curve {
        boxed(EllipticArc { center: self.center + spread_to(moves, 0.5), ends, ..*self })
    }
    fn as_ellipse(&self) -> Option<EllipticArc> {
        Some(*self)
    }
    /// Points are computed from the start with the axes, which may be long compared with the arc.
    fn reach(&self) -> f64 {
        self.u.hypot2().sqrt() + self.v.hypot2().sqrt()
    }

    fn is_straight(&self) -> bool {
        false
    }
    fn extremes(&self, t0: f64, t1: f64) -> Vec<f64> {
        let (x, y) = (libm::atan2(self.v.x, self.u.x), libm::atan2(self.v.y, self.u.y));
        let mut found = passages(self.start_rad, self.sweep_rad, x, PI, t0, t1);
        found.extend(passages(self.start_rad, self.sweep_rad, y, PI, t0, t1));
        found
    }
    fn length_of(&self, t0: f64, t1: f64) -> f64 {
        let scale = (length(self.u) + length(self.v)) * (self.sweep_rad * (t1 - t0)).abs();
        quadrature::integral(|t| length(self.derivative(t)), t0, t1, scale)
    }
    fn area_over_chord(&self) -> f64 {
        0.5 * self.u.cross(self.v) * sweep::angle_minus_sine(self.sweep_rad)
    }
    /// The affine image of a half turn is a half turn, and within one (d₀ × d₁) = (u × v) sin Δ.
    fn turning(&self, t0: f64, t1: f64) -> f64 {
        let sweep = (self.sweep_rad * (t1 - t0)).abs();
        let halves = libm::floor(sweep / PI);
        let rest = sweep - halves * PI;
        let (from, to) = (self.angle(t0), self.angle(t0) + rest.copysign(self.sweep_rad));
        let cross = self.u.cross(self.v).abs() * libm::sin(rest);
        halves * PI + libm::atan2(cross.max(0.0), self.along(from).dot(self.along(to)))
    }
    fn breaks(&self) -> Vec<Break> {
        Vec::new()
    }
    fn inflections(&self) -> Vec<f64> {
        Vec::new()
    }
    fn cuts_of_turning(&self, tau: f64) -> Vec<f64> {
        turning::shares(self.turning(0.0, 1.0), tau).map(|share| self.at_turning(share)).collect()
    }
    fn widens(&self, cone: &mut Cone, end: End) -> bool {
        widens(self, cone, end)
    }
    fn each_of_hull(&self, take: &mut dyn FnMut(Point)) -> bool {
        each_of_hull(self, take)
    }
}

fn boxed(arc: EllipticArc) -> Curve {
    Curve::Ellipse(Box::new(arc))
}

/// The rational quadratics of an arc over t0..t1.
pub(super) fn conic_spans(arc: &EllipticArc, t0: f64, t1: f64) -> Vec<Span<'static>> {
    let span = |(bezier, t0, t1)| Span::conic(Cow::Owned(bezier), [t0, t1], 0.5 * arc.sweep_rad * (t1 - t0));
    arc.conics(t0, t1).into_iter().map(span).collect()
}

/// See [`Kind::widens`]: an arc that turns by less than π lies between its tangent and its chord.
pub(super) fn widens(arc: &impl Kind, cone: &mut Cone, end: End) -> bool {
    let [start, finish] = arc.ends();
    let (chord, direction) = match end {
        End::Start => (finish - start, arc.tangent(0.0, End::Start)),
        End::Finish => (start - finish, -arc.tangent(1.0, End::Finish)),
    };
    arc.turning(0.0, 1.0) < PI && cone.widen(direction, chord)
}

/// See [`Kind::each_of_hull`]: half a circle or less lies in the rectangle on its chord up to its middle; for an
/// ellipse in the affine image of that.
pub(super) fn each_of_hull(arc: &impl Kind, take: &mut dyn FnMut(Point)) -> bool {
    if arc.turning(0.0, 1.0) > PI {
        return false;
    }
    let ends = arc.ends();
    let bulge = arc.point(0.5) - ends[0].midpoint(ends[1]);
    ends.into_iter().flat_map(|end| [end, end + bulge]).for_each(take);
    true
}
