//! One Bézier span of a curve.

use super::polygon::Polygon;
use super::sweep::conic_parameter;
use super::{Bezier, bernstein};
use crate::geometry::{Point, Rect, Vec2};
use std::borrow::Cow;

/// A Bézier span of a curve, restricted to a part of its own parameter.
pub(super) struct Span<'a> {
    /// The whole Bézier curve.
    pub bezier: Cow<'a, Bezier>,
    /// The start of the range of the Bézier's own parameter.
    pub(super) from: f64,
    /// The end of that range.
    pub(super) to: f64,
    clock: Clock,
}

/// How the curve's parameter depends on that of the span.
enum Clock {
    Linear {
        t0: f64,
        t1: f64,
    },
    /// An elliptic arc's angle, over a rational quadratic.
    Conic {
        t0: f64,
        t1: f64,
        half_rad: f64,
    },
}

impl<'a> Span<'a> {
    /// The range `of` of the Bézier's own parameter; the curve's parameter runs linearly through `t0..t1` over it.
    pub(super) fn even(bezier: Cow<'a, Bezier>, of: [f64; 2], [t0, t1]: [f64; 2]) -> Self {
        Span { bezier, from: of[0], to: of[1], clock: Clock::Linear { t0, t1 } }
    }

    /// A rational quadratic over an angle of twice `half_rad`; the curve's parameter, proportional to the angle, runs
    /// through `t0..t1`.
    pub(super) fn conic(bezier: Cow<'a, Bezier>, [t0, t1]: [f64; 2], half_rad: f64) -> Self {
        Span { bezier, from: 0.0, to: 1.0, clock: Clock::Conic { t0, t1, half_rad } }
    }
}

impl Span<'_> {
    /// The curve's parameter at s ∈ [0, 1] of the restricted span.
    pub(super) fn t(&self, s: f64) -> f64 {
        let (t0, t1, share) = match self.clock {
            Clock::Linear { t0, t1 } => (t0, t1, s),
            Clock::Conic { t0, t1, half_rad } => (t0, t1, conic_parameter(s, half_rad)),
        };
        if share <= 0.5 { t0 + share * (t1 - t0) } else { t1 - (1.0 - share) * (t1 - t0) }
    }

    /// The control polygon of the restricted span, relative to `origin`.
    pub(super) fn about(&self, origin: Point) -> Polygon {
        self.bezier.about(origin).restricted(self.from, self.to)
    }

    /// The coefficients of the hodograph over the restricted span: for a rational span, those of a positive multiple.
    pub(super) fn hodograph(&self) -> Vec<Vec2> {
        bernstein::restricted(&self.bezier.hodograph(), self.from, self.to)
    }

    /// The range of the curve's parameter.
    pub(super) fn range(&self) -> [f64; 2] {
        match self.clock {
            Clock::Linear { t0, t1 } | Clock::Conic { t0, t1, .. } => [t0, t1],
        }
    }

    /// The start point of the restricted span.
    pub(super) fn start(&self) -> Point {
        self.bezier.at(self.from)
    }

    /// A box around the whole Bézier, quick but loose.
    pub(super) fn hull(&self) -> Rect {
        crate::geometry::bounds_of(self.bezier.points.iter().copied()).unwrap_or(Rect::ZERO)
    }
}
