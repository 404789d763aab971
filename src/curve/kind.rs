//! The private trait of all kinds of curves, with one implementation a file.
//!
//! A kind implements what differs: its ends, points and derivatives, its Bézier spans ([`Kind::spans`]), and its
//! images. Every other query has a default here that works span by span; kinds with a closed form (lines, arcs)
//! override it. A kind that is no rational curve has no exact spans. Its spans equal it to a few units in the last
//! place of its coordinates and of [`Kind::reach`], and its points are computed from them (see `clothoid.rs`: a chain
//! of Hermite pieces, with the drift of its end spread along it).
//!
//! ```text
//!   Curve ──▶ &dyn Kind ──┬─▶ line.rs  arc.rs  ellipse.rs  bezier.rs  spline.rs  clothoid.rs     what differs by kind
//!   (mod.rs, one match)   └─▶ spans.rs  turning.rs                                               the rest, by spans
//! ```
//!
//! *A new kind*: a file with its type and `impl Kind`, a variant of [`Curve`] and its arm in `Curve::as_kind`. The
//! compiler then reports each match over kinds outside of this folder.

use super::span::Span;
use super::spans;
use super::weld::Similarity;
use super::{Break, Cone, Curve, EllipticArc, End, turning, unit};
use crate::geometry::{Point, Vec2};
use std::f64::consts::PI;

/// A kind of curve over t ∈ [0, 1]. Ranges t0..t1 are ascending and lie within it.
pub(super) trait Kind {
    // ---- what each kind implements ----

    /// The usual name of the kind.
    fn name(&self) -> &'static str;
    /// The exact ends.
    fn ends(&self) -> [Point; 2];
    /// The point at t, strictly inside.
    fn inner_point(&self, t: f64) -> Point;
    fn derivative(&self, t: f64) -> Vec2;
    fn second_derivative(&self, t: f64) -> Vec2;
    /// The Bézier spans of t0..t1, in order; for their error see [`Kind::reach`].
    fn spans(&self, t0: f64, t1: f64) -> Vec<Span<'_>>;
    /// The number of points that it stores: its cost in memory.
    fn control_count(&self) -> usize;
    /// Whether it may cross or touch itself other than by closing.
    fn may_meet_itself(&self) -> bool;
    /// The part t0..t1, of the same kind, with its exact ends.
    fn part(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Curve;
    fn reversed(&self) -> Curve;
    /// All coordinates times a power of two: exact.
    fn scaled(&self, factor: f64) -> Curve;
    /// See [`Curve::transformed`].
    fn transformed(&self, map: kurbo::Affine) -> Curve;
    /// The image under a similarity, with exactly these ends, which are the images of its own up to rounding.
    fn moved(&self, map: &Similarity, ends: [Point; 2]) -> Curve;
    /// The curve with the moves of its ends spread along it, and exactly these ends: no point moves farther than an
    /// end.
    fn spread(&self, moves: [Vec2; 2], ends: [Point; 2]) -> Curve;

    // ---- what some kinds override ----

    /// The curve as an elliptic arc, if it is one.
    fn as_ellipse(&self) -> Option<EllipticArc> {
        None
    }
    /// The largest length that its points are computed from, where it may exceed the coordinates; else 0. Points and
    /// spans are accurate to a few units in the last place of it.
    fn reach(&self) -> f64 {
        0.0
    }
    /// See [`Curve::is_round`].
    fn is_round(&self) -> bool {
        false
    }
    /// See [`Curve::with_rounded_end`].
    fn with_rounded_end(&self, _end: Point) -> Option<Curve> {
        None
    }
    /// 0, the parameters at which one formula ends and the next begins, and 1.
    fn knots(&self) -> Vec<f64> {
        vec![0.0, 1.0]
    }

    // ---- computed from spans, where the kind has no closed form ----

    /// The point at t; an exact end where t is not inside.
    fn point(&self, t: f64) -> Point {
        if t <= 0.0 {
            return self.ends()[0];
        }
        if t >= 1.0 {
            return self.ends()[1];
        }
        self.inner_point(t)
    }
    /// See [`Curve::tangent`].
    fn tangent(&self, t: f64, _side: End) -> Vec2 {
        unit(self.derivative(t))
    }
    fn is_straight(&self) -> bool {
        spans::is_straight(&self.spans(0.0, 1.0))
    }
    /// Parameters inside t0..t1 at which x or y may be extreme.
    fn extremes(&self, t0: f64, t1: f64) -> Vec<f64> {
        spans::extremes(&self.spans(t0, t1))
    }
    fn length_of(&self, t0: f64, t1: f64) -> f64 {
        spans::length_of(&self.spans(t0, t1))
    }
    fn nearest(&self, p: Point, t0: f64, t1: f64) -> f64 {
        spans::nearest(self, p, t0, t1)
    }
    /// ½∮(x dy − y dx) between the curve and its chord.
    fn area_over_chord(&self) -> f64 {
        spans::area_over_chord(&self.spans(0.0, 1.0))
    }
    fn turning(&self, t0: f64, t1: f64) -> f64 {
        turning::turning(&self.spans(t0, t1))
    }
    fn breaks(&self) -> Vec<Break> {
        turning::breaks(&self.spans(0.0, 1.0))
    }
    fn inflections(&self) -> Vec<f64> {
        turning::inflections(&self.spans(0.0, 1.0))
    }
    fn cuts_of_turning(&self, tau: f64) -> Vec<f64> {
        turning::cuts_of_turning(&self.spans(0.0, 1.0), tau)
    }
    fn lens_angle(&self, t0: f64, t1: f64) -> f64 {
        // The stationary points are accurate to rounding, and the angle is flat there: the excess covers both.
        let measured = spans::lens_angle(self, t0, t1) * (1.0 + 1e-12) + 64.0 * f64::EPSILON;
        measured.min(self.turning(t0, t1)).min(PI)
    }
    fn chord_error(&self, t0: f64, t1: f64) -> f64 {
        spans::chord_error(self, t0, t1)
    }
    fn bisector_crossing(&self, t0: f64, t1: f64) -> f64 {
        spans::bisector_crossing(self, t0, t1)
    }
    fn line_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        spans::line_crossings(&self.spans(t0, t1), a, direction, t0, t1)
    }
    fn leaves_ball(&self, end: End, radius: f64, t0: f64, t1: f64) -> Option<f64> {
        spans::leaves_ball(self, end, radius, t0, t1)
    }
    /// Widens a cone with its apex at an end until it contains the curve. Returns whether the curve stays ahead of the
    /// apex.
    fn widens(&self, cone: &mut Cone, end: End) -> bool {
        spans::widens(&self.spans(0.0, 1.0), cone, self.ends(), end)
    }
    /// Calls `take` with points whose convex hull contains the curve, up to rounding. Returns whether there are such
    /// points.
    fn each_of_hull(&self, take: &mut dyn FnMut(Point)) -> bool {
        self.spans(0.0, 1.0).iter().flat_map(|span| span.bezier.points.iter().copied()).for_each(take);
        true
    }
}
