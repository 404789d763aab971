//! A straight segment.

use super::kind::Kind;
use super::span::Span;
use super::weld::Similarity;
use super::{Bezier, Break, Cone, Curve, End, Line, length, unit};
use crate::geometry::{Point, Vec2, scaled};
use std::borrow::Cow;

impl Line {
    fn chord(&self) -> Vec2 {
        self.end - self.start
    }

    fn over(ends: [Point; 2]) -> Curve {
        Curve::Line(Line { start: ends[0], end: ends[1] })
    }
}

impl Kind for Line {
    fn name(&self) -> &'static str {
        "line"
    }
    fn ends(&self) -> [Point; 2] {
        [self.start, self.end]
    }
    /// Computed from the nearer end, so that both ends are exact.
    fn inner_point(&self, t: f64) -> Point {
        if t <= 0.5 { self.start + self.chord() * t } else { self.end - self.chord() * (1.0 - t) }
    }
    fn derivative(&self, _t: f64) -> Vec2 {
        self.chord()
    }
    fn second_derivative(&self, _t: f64) -> Vec2 {
        Vec2::ZERO
    }
    fn spans(&self, t0: f64, t1: f64) -> Vec<Span<'_>> {
        let bezier = Bezier { points: vec![self.start, self.end], weights: None };
        vec![Span::even(Cow::Owned(bezier), [t0, t1], [t0, t1])]
    }
    fn control_count(&self) -> usize {
        1
    }
    fn may_meet_itself(&self) -> bool {
        false
    }
    fn part(&self, _t0: f64, _t1: f64, ends: [Point; 2]) -> Curve {
        Self::over(ends)
    }
    fn reversed(&self) -> Curve {
        Self::over([self.end, self.start])
    }
    fn scaled(&self, factor: f64) -> Curve {
        Self::over(self.ends().map(|p| scaled(p, factor)))
    }
    fn transformed(&self, map: kurbo::Affine) -> Curve {
        Self::over(self.ends().map(|p| map * p))
    }
    fn moved(&self, _map: &Similarity, ends: [Point; 2]) -> Curve {
        Self::over(ends)
    }
    fn spread(&self, _moves: [Vec2; 2], ends: [Point; 2]) -> Curve {
        Self::over(ends)
    }
    fn is_round(&self) -> bool {
        true
    }

    fn tangent(&self, _t: f64, _side: End) -> Vec2 {
        unit(self.chord())
    }
    fn is_straight(&self) -> bool {
        true
    }
    fn extremes(&self, _t0: f64, _t1: f64) -> Vec<f64> {
        Vec::new()
    }
    fn length_of(&self, t0: f64, t1: f64) -> f64 {
        length(self.chord()) * (t1 - t0)
    }
    fn nearest(&self, p: Point, t0: f64, t1: f64) -> f64 {
        let chord = self.chord();
        let along = (p - self.start).dot(chord) / chord.dot(chord);
        if along.is_nan() { t0 } else { along.clamp(t0, t1) }
    }
    fn area_over_chord(&self) -> f64 {
        0.0
    }
    fn turning(&self, _t0: f64, _t1: f64) -> f64 {
        0.0
    }
    fn breaks(&self) -> Vec<Break> {
        Vec::new()
    }
    fn inflections(&self) -> Vec<f64> {
        Vec::new()
    }
    fn cuts_of_turning(&self, _tau: f64) -> Vec<f64> {
        Vec::new()
    }
    fn lens_angle(&self, _t0: f64, _t1: f64) -> f64 {
        0.0
    }
    fn chord_error(&self, _t0: f64, _t1: f64) -> f64 {
        0.0
    }
    fn bisector_crossing(&self, t0: f64, t1: f64) -> f64 {
        0.5 * (t0 + t1)
    }
    fn line_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        let t = (a - self.start).cross(direction) / self.chord().cross(direction);
        if t > t0 && t < t1 { vec![t] } else { Vec::new() }
    }
    fn leaves_ball(&self, end: End, radius: f64, t0: f64, t1: f64) -> Option<f64> {
        let step = radius / length(self.chord());
        // The quotient of two rounded numbers: an error of 2 units in the last place.
        if !(0.0..=(t1 - t0) * (1.0 + 2.0 * f64::EPSILON)).contains(&step) {
            return None;
        }
        Some(match end {
            End::Start => (t0 + step).min(t1),
            End::Finish => (t1 - step).max(t0),
        })
    }
    fn widens(&self, _cone: &mut Cone, _end: End) -> bool {
        true
    }
    fn each_of_hull(&self, take: &mut dyn FnMut(Point)) -> bool {
        self.ends().into_iter().for_each(take);
        true
    }
}
