//! A part of a circle.

use super::kind::Kind;
use super::span::Span;
use super::sweep::{angle_minus_sine, checked_sweep, passages};
use super::weld::{Similarity, spread_to};
use super::{Break, CircularArc, Cone, Curve, CurveError, EllipticArc, End, check_finite, ellipse, length, turning};
use crate::geometry::{Point, Vec2, scaled};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The point of the unit circle at an angle, and the unit tangent there.
fn on_circle(angle: f64) -> (Vec2, Vec2) {
    let (sin, cos) = libm::sincos(angle);
    (Vec2::new(cos, sin), Vec2::new(-sin, cos))
}

/// The parts of an affine map that is a similarity.
pub(super) struct SimilarityOf {
    /// The factor of all lengths.
    pub scale: f64,
    /// The direction of the image of the x axis, in radians.
    pub turn_rad: f64,
    /// 1, or −1 for a map that mirrors.
    pub hand: f64,
}

/// The map as a similarity, if it is one up to 4 units in the last place.
pub(super) fn similarity_of(map: kurbo::Affine) -> Option<SimilarityOf> {
    let [a, b, c, d, _, _] = map.as_coeffs();
    let scale = length(Vec2::new(a, b));
    let slack = 4.0 * f64::EPSILON * scale;
    let hand = if (a - d).abs() <= slack && (b + c).abs() <= slack {
        1.0
    } else if (a + d).abs() <= slack && (b - c).abs() <= slack {
        -1.0
    } else {
        return None;
    };
    Some(SimilarityOf { scale, turn_rad: libm::atan2(b, a), hand })
}

impl CircularArc {
    /// See [`Curve::arc`](super::Curve::arc).
    pub(super) fn new(center: Point, radius: f64, start_rad: f64, sweep_rad: f64) -> Result<Self, CurveError> {
        check_finite([center.x, center.y, radius, start_rad, sweep_rad])?;
        if radius <= 0.0 {
            return Err(CurveError::Radius { radius });
        }
        let sweep_rad = checked_sweep(sweep_rad)?;
        let start = center + on_circle(start_rad).0 * radius;
        let end = if sweep_rad.abs() == TAU { start } else { center + on_circle(start_rad + sweep_rad).0 * radius };
        check_finite([start.x, start.y, end.x, end.y])?;
        Ok(CircularArc { center, radius, start_rad, sweep_rad, ends: [start, end] })
    }

    /// The arc with the given ends and sweep, which is neither 0 nor a full turn.
    ///
    /// ```text
    ///            ╭───────╮            The angle between the chord and the tangents at both ends is half the sweep; the
    ///     start ●─────────● end       distance of the center from the chord's middle is ½ |chord| cos(½ sweep) / sin(½
    ///            ╲       ╱            sweep).
    ///              ╲   ╱
    ///                · center
    /// ```
    pub(super) fn over_chord(start: Point, end: Point, sweep_rad: f64) -> Result<Self, CurveError> {
        check_finite([start.x, start.y, end.x, end.y, sweep_rad])?;
        let chord = end - start;
        let (sin, cos) = libm::sincos(0.5 * sweep_rad);
        let radius = 0.5 * length(chord) / sin.abs();
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(CurveError::Radius { radius });
        }
        let to_center = Vec2::new(-chord.y, chord.x) * (0.5 * cos / sin);
        let center = start + (chord * 0.5 + to_center);
        check_finite([center.x, center.y])?;
        // At the middle of the arc the tangent is parallel to the chord.
        let start_rad = libm::atan2(chord.y, chord.x) - 0.5 * sweep_rad - FRAC_PI_2.copysign(sweep_rad);
        Ok(CircularArc { center, radius, start_rad, sweep_rad, ends: [start, end] })
    }

    /// Whether the ends lie off the circle by more than rounding. Such is the result where the ends of an arc of more
    /// than half a circle were moved ([`Curve::with_ends`](super::Curve::with_ends)): the arc winds from one end to the
    /// other. Its parts of up to half a circle are arcs of other circles.
    pub(crate) fn is_spiral(&self) -> bool {
        let slack = 64.0 * f64::EPSILON * (self.center.x.abs() + self.center.y.abs() + self.radius);
        let angles = [self.start_rad, self.start_rad + self.sweep_rad];
        let is_off = |(end, angle): (Point, f64)| length(end - self.center - on_circle(angle).0 * self.radius) > slack;
        self.ends.into_iter().zip(angles).any(is_off)
    }

    /// The same arc as part of an ellipse.
    pub(super) fn elliptic(&self) -> EllipticArc {
        let (u, v) = (Vec2::new(self.radius, 0.0), Vec2::new(0.0, self.radius));
        let CircularArc { center, start_rad, sweep_rad, ends, .. } = *self;
        EllipticArc { center, u, v, start_rad, sweep_rad, ends }
    }

    /// The image under a similarity (up to 4 units in the last place); `None` where the map is none.
    fn image(&self, map: kurbo::Affine) -> Option<Self> {
        let SimilarityOf { scale, turn_rad, hand } = similarity_of(map)?;
        let (start_rad, sweep_rad) = (turn_rad + self.start_rad * hand, self.sweep_rad * hand);
        let (center, radius) = (map * self.center, self.radius * scale);
        Some(CircularArc { center, radius, start_rad, sweep_rad, ends: self.ends.map(|p| map * p) })
    }

    /// The unit tangent at t.
    fn along(&self, t: f64) -> Vec2 {
        on_circle(self.start_rad + self.sweep_rad * t).1 * 1f64.copysign(self.sweep_rad)
    }

    /// Candidates for the nearest point: the two where the circle's normal passes through p. They are computed by their
    /// angles from the start, which stay accurate however flat the arc is.
    fn normals_through(&self, p: Point, t0: f64, t1: f64) -> Vec<f64> {
        let outward = on_circle(self.start_rad).0;
        let offset = p - self.ends[0];
        let angle = libm::atan2(outward.cross(offset), self.radius + outward.dot(offset));
        passages(0.0, self.sweep_rad, angle, PI, t0, t1)
    }

    /// The parameters where the line meets the circle. Let u = tan(φ/2) for the angle φ from the start, h the signed
    /// distance of the start from the line, n the line's unit normal and e the unit vector from the center to the
    /// start. Then (h/R − 2 n·e) u² + 2 (n·e⊥) u + h/R = 0.
    fn circle_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        let normal = Vec2::new(-direction.y, direction.x) / length(direction);
        let (outward, along) = on_circle(self.start_rad);
        let start = normal.dot(self.ends[0] - a) / self.radius;
        let (square, half_linear) = (start - 2.0 * normal.dot(outward), normal.dot(along));
        let discriminant = half_linear * half_linear - start * square;
        if discriminant <= 0.0 || discriminant.is_nan() {
            return Vec::new();
        }
        // The sum without cancellation; the other root follows from the product of the two.
        let sum = -(half_linear + discriminant.sqrt().copysign(half_linear));
        let mut found = passages(0.0, self.sweep_rad, 2.0 * libm::atan2(sum, square), TAU, t0, t1);
        found.extend(passages(0.0, self.sweep_rad, 2.0 * libm::atan2(start, sum), TAU, t0, t1));
        found.sort_by(f64::total_cmp);
        found
    }

    /// One Newton step from a parameter near the foot of the perpendicular from p, if the step decreases the distance.
    fn polished_foot(&self, p: Point, t: f64, t0: f64, t1: f64) -> f64 {
        let (offset, d, dd) = (self.point(t) - p, self.derivative(t), self.second_derivative(t));
        let step = offset.dot(d) / (d.dot(d) + offset.dot(dd));
        let stepped = (t - step).clamp(t0, t1);
        if length(self.point(stepped) - p) < length(offset) { stepped } else { t }
    }
}

impl Kind for CircularArc {
    fn name(&self) -> &'static str {
        "arc"
    }
    fn ends(&self) -> [Point; 2] {
        self.ends
    }
    /// Up to half a circle the point is computed from the chord and the sweep alone. So it is as accurate as the ends,
    /// however distant the center of a flat arc is. Beyond half a circle the rounding of the ends is spread along the
    /// arc.
    fn inner_point(&self, t: f64) -> Point {
        let [start, end] = self.ends;
        let half = 0.5 * self.sweep_rad;
        if self.sweep_rad.abs() <= PI {
            let chord = end - start;
            let (sin, cos) = libm::sincos(-half * (1.0 - t));
            let reach = libm::sin(half * t) / libm::sin(half);
            return start + Vec2::new(cos * chord.x - sin * chord.y, sin * chord.x + cos * chord.y) * reach;
        }
        let from_start = |t: f64| {
            let along = on_circle(self.start_rad + half * t).1;
            along * (2.0 * self.radius * libm::sin(half * t))
        };
        start + (from_start(t) + ((end - start) - from_start(1.0)) * t)
    }
    fn derivative(&self, t: f64) -> Vec2 {
        self.along(t) * (self.radius * self.sweep_rad.abs())
    }
    fn second_derivative(&self, t: f64) -> Vec2 {
        on_circle(self.start_rad + self.sweep_rad * t).0 * (-self.radius * self.sweep_rad * self.sweep_rad)
    }
    fn spans(&self, t0: f64, t1: f64) -> Vec<Span<'_>> {
        ellipse::conic_spans(&self.elliptic(), t0, t1)
    }
    fn control_count(&self) -> usize {
        1
    }
    fn may_meet_itself(&self) -> bool {
        false
    }
    fn part(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Curve {
        let start_rad = self.start_rad + self.sweep_rad * t0;
        let part = CircularArc { start_rad, sweep_rad: self.sweep_rad * (t1 - t0), ends, ..*self };
        if part.sweep_rad.abs() > PI || !part.is_spiral() {
            return Curve::Arc(part);
        }
        Curve::Arc(Self::over_chord(ends[0], ends[1], part.sweep_rad).unwrap_or(part))
    }
    fn reversed(&self) -> Curve {
        let (start_rad, [start, end]) = (self.start_rad + self.sweep_rad, self.ends);
        Curve::Arc(CircularArc { start_rad, sweep_rad: -self.sweep_rad, ends: [end, start], ..*self })
    }
    fn scaled(&self, factor: f64) -> Curve {
        let scale = |p: Point| scaled(p, factor);
        let (center, radius) = (scale(self.center), self.radius * factor);
        Curve::Arc(CircularArc { center, radius, ends: self.ends.map(scale), ..*self })
    }
    /// A part of an ellipse where the map is no similarity.
    fn transformed(&self, map: kurbo::Affine) -> Curve {
        self.image(map).map_or_else(|| self.elliptic().transformed(map), Curve::Arc)
    }
    fn moved(&self, map: &Similarity, ends: [Point; 2]) -> Curve {
        let (center, radius) = (map.point(self.center), self.radius * map.scale());
        Curve::Arc(CircularArc { center, radius, start_rad: self.start_rad + map.turn_rad(), ends, ..*self })
    }
    /// The circle moves by the mean of both moves, and [`Kind::inner_point`] spreads the rest.
    fn spread(&self, moves: [Vec2; 2], ends: [Point; 2]) -> Curve {
        Curve::Arc(CircularArc { center: self.center + spread_to(moves, 0.5), ends, ..*self })
    }
    fn is_round(&self) -> bool {
        true
    }
    fn as_ellipse(&self) -> Option<EllipticArc> {
        Some(self.elliptic())
    }

    fn tangent(&self, t: f64, _side: End) -> Vec2 {
        self.along(t)
    }
    fn is_straight(&self) -> bool {
        false
    }
    fn extremes(&self, t0: f64, t1: f64) -> Vec<f64> {
        passages(self.start_rad, self.sweep_rad, 0.0, FRAC_PI_2, t0, t1)
    }
    fn length_of(&self, t0: f64, t1: f64) -> f64 {
        self.radius * (self.sweep_rad * (t1 - t0)).abs()
    }
    fn nearest(&self, p: Point, t0: f64, t1: f64) -> f64 {
        let feet = self.normals_through(p, t0, t1).into_iter().map(|t| self.polished_foot(p, t, t0, t1));
        let mut best = (f64::INFINITY, t0);
        for t in feet.chain([t0, t1]) {
            let distance = length(self.point(t) - p);
            if distance < best.0 {
                best = (distance, t);
            }
        }
        best.1
    }
    fn area_over_chord(&self) -> f64 {
        0.5 * self.radius * self.radius * angle_minus_sine(self.sweep_rad)
    }
    fn turning(&self, t0: f64, t1: f64) -> f64 {
        (self.sweep_rad * (t1 - t0)).abs()
    }
    fn breaks(&self) -> Vec<Break> {
        Vec::new()
    }
    fn inflections(&self) -> Vec<f64> {
        Vec::new()
    }
    fn cuts_of_turning(&self, tau: f64) -> Vec<f64> {
        turning::shares(self.sweep_rad.abs(), tau).map(|share| share / self.sweep_rad.abs()).collect()
    }
    fn lens_angle(&self, t0: f64, t1: f64) -> f64 {
        0.5 * (self.sweep_rad * (t1 - t0)).abs()
    }
    fn chord_error(&self, t0: f64, t1: f64) -> f64 {
        let quarter = libm::sin(0.25 * self.sweep_rad * (t1 - t0));
        2.0 * self.radius * quarter * quarter
    }
    fn bisector_crossing(&self, t0: f64, t1: f64) -> f64 {
        0.5 * (t0 + t1)
    }
    fn line_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        let polished = |t: f64| {
            let step = (self.point(t) - a).cross(direction) / self.derivative(t).cross(direction);
            Some(t - step).filter(|s| *s > t0 && *s < t1).unwrap_or(t)
        };
        self.circle_crossings(a, direction, t0, t1).into_iter().map(polished).collect()
    }
    fn leaves_ball(&self, end: End, radius: f64, t0: f64, t1: f64) -> Option<f64> {
        let sine = radius / (2.0 * self.radius);
        // The quotient is rounded: a few units in the last place beyond the end count as the end.
        let slack = 1.0 + 4.0 * f64::EPSILON;
        if !(0.0..=slack).contains(&sine) {
            return None;
        }
        let step = 2.0 * libm::asin(sine.min(1.0)) / self.sweep_rad.abs();
        if step > (t1 - t0) * slack {
            return None;
        }
        Some(match end {
            End::Start => (t0 + step).min(t1),
            End::Finish => (t1 - step).max(t0),
        })
    }
    fn widens(&self, cone: &mut Cone, end: End) -> bool {
        ellipse::widens(self, cone, end)
    }
    fn each_of_hull(&self, take: &mut dyn FnMut(Point)) -> bool {
        ellipse::each_of_hull(self, take)
    }
}
