//! A straight segment.

use super::{End, Line, length};
use crate::geometry::{Point, Vec2};

impl Line {
    pub(super) fn chord(&self) -> Vec2 {
        self.end - self.start
    }

    /// Measured from the nearer end, so that both ends are exact.
    pub(super) fn point(&self, t: f64) -> Point {
        if t <= 0.5 { self.start + self.chord() * t } else { self.end - self.chord() * (1.0 - t) }
    }

    pub(super) fn nearest(&self, p: Point, t0: f64, t1: f64) -> f64 {
        let chord = self.chord();
        let along = (p - self.start).dot(chord) / chord.dot(chord);
        if along.is_nan() { t0 } else { along.clamp(t0, t1) }
    }

    pub(super) fn line_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        let t = (a - self.start).cross(direction) / self.chord().cross(direction);
        if t > t0 && t < t1 { vec![t] } else { Vec::new() }
    }

    pub(super) fn leaves_ball(&self, end: End, radius: f64, t0: f64, t1: f64) -> Option<f64> {
        let step = radius / length(self.chord());
        // The quotient of two rounded numbers: 2 ulp.
        if !(0.0..=(t1 - t0) * (1.0 + 2.0 * f64::EPSILON)).contains(&step) {
            return None;
        }
        Some(match end {
            End::Start => (t0 + step).min(t1),
            End::Finish => (t1 - step).max(t0),
        })
    }
}
