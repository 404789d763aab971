//! Part of an ellipse, by conjugate half axes.

use super::arc::{checked_sweep, passages};
use super::{Bezier, CurveError, EllipticArc, check_finite};
use crate::geometry::{Point, Vec2};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

impl EllipticArc {
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

    pub(super) fn angle(&self, t: f64) -> f64 {
        self.start_rad + self.sweep_rad * t
    }

    /// Derivative by the angle.
    pub(super) fn along(&self, angle: f64) -> Vec2 {
        let (sin, cos) = libm::sincos(angle);
        self.v * cos - self.u * sin
    }

    /// Measured from the start, with the rounding of the ends spread along the arc.
    pub(super) fn point(&self, t: f64) -> Point {
        let [start, end] = self.ends;
        let half = 0.5 * self.sweep_rad;
        let from_start = |t: f64| self.along(self.start_rad + half * t) * (2.0 * libm::sin(half * t));
        start + (from_start(t) + ((end - start) - from_start(1.0)) * t)
    }

    pub(super) fn derivative(&self, t: f64) -> Vec2 {
        self.along(self.angle(t)) * self.sweep_rad
    }

    pub(super) fn second_derivative(&self, t: f64) -> Vec2 {
        let (sin, cos) = libm::sincos(self.angle(t));
        (self.u * cos + self.v * sin) * (-self.sweep_rad * self.sweep_rad)
    }

    pub(super) fn part(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Self {
        EllipticArc { start_rad: self.angle(t0), sweep_rad: self.sweep_rad * (t1 - t0), ends, ..*self }
    }

    /// Where x or y may be extreme.
    pub(super) fn extremes(&self, t0: f64, t1: f64) -> Vec<f64> {
        let (x, y) = (libm::atan2(self.v.x, self.u.x), libm::atan2(self.v.y, self.u.y));
        let mut found = passages(self.start_rad, self.sweep_rad, x, PI, t0, t1);
        found.extend(passages(self.start_rad, self.sweep_rad, y, PI, t0, t1));
        found
    }

    /// Turning over t0..t1. The affine image of a half turn is a half turn, and within one (d₀ × d₁) = (u × v) sin Δ.
    pub(super) fn turning(&self, t0: f64, t1: f64) -> f64 {
        let sweep = (self.sweep_rad * (t1 - t0)).abs();
        let halves = libm::floor(sweep / PI);
        let rest = sweep - halves * PI;
        let (from, to) = (self.angle(t0), self.angle(t0) + rest.copysign(self.sweep_rad));
        let cross = self.u.cross(self.v).abs() * libm::sin(rest);
        halves * PI + libm::atan2(cross.max(0.0), self.along(from).dot(self.along(to)))
    }

    /// The parameter at which the curve has turned by `turned` ≥ 0 since its start.
    pub(super) fn at_turning(&self, turned: f64) -> f64 {
        let halves = libm::floor(turned / PI);
        let orientation = 1f64.copysign(self.u.cross(self.v) * self.sweep_rad);
        let (sin, cos) = libm::sincos((turned - halves * PI) * orientation);
        let d = self.along(self.start_rad);
        let wanted = Vec2::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y);
        let angle = libm::atan2(self.v.cross(wanted), self.u.cross(wanted));
        let sign = 1f64.copysign(self.sweep_rad);
        let ahead = (angle - self.start_rad) * sign;
        // Up to rounding of the angle itself, which may fall just short of zero.
        let rest = ahead - PI * libm::floor(ahead / PI + 4.0 * f64::EPSILON);
        ((halves * PI + rest) / self.sweep_rad.abs()).clamp(0.0, 1.0)
    }

    /// Exact rational quadratics of at most a quarter turn over t0..t1, each with its range; see [`conic_parameter`].
    pub(super) fn conics(&self, t0: f64, t1: f64) -> Vec<(Bezier, f64, f64)> {
        let sweep = self.sweep_rad * (t1 - t0);
        let count = libm::ceil(sweep.abs() / FRAC_PI_2).clamp(1.0, 4.0);
        let at = |k: f64| if k == count { t1 } else { t0 + (t1 - t0) * (k / count) };
        (0..count as u32)
            .map(|k| {
                let (from, to) = (at(f64::from(k)), at(f64::from(k) + 1.0));
                let half = 0.5 * self.sweep_rad * (to - from);
                let (start, end) = (self.point(from), self.point(to));
                let apex = start + self.along(self.angle(from)) * libm::tan(half);
                let weights = vec![1.0, libm::cos(half), 1.0];
                (Bezier { points: vec![start, apex, end], weights: Some(weights) }, from, to)
            })
            .collect()
    }
}

/// The share of the angle that a rational quadratic arc of half angle `half` has covered at its own parameter s.
pub(super) fn conic_parameter(s: f64, half: f64) -> f64 {
    let (sin, cos) = libm::sincos(half);
    libm::atan2(s * sin, (1.0 - s) + s * cos) / half
}
