//! Questions answered span by span, on exact Bézier pieces of any curve.
//!
//! Each becomes the sign of a polynomial in Bernstein form; its sign changes are isolated and then sharpened on the geometry itself.

use super::bernstein::{self, SignChange, crossing};
use super::bezier::Polygon;
use super::ellipse::conic_parameter;
use super::{Bezier, Curve, EllipticArc, End, length};
use crate::geometry::{Point, Rect, Vec2, boxes::distance_to_box};
use std::borrow::Cow;

/// A Bézier piece of a curve, restricted to part of its own parameter.
pub(super) struct Span<'a> {
    pub bezier: Cow<'a, Bezier>,
    /// Range of the Bézier's own parameter.
    pub from: f64,
    pub to: f64,
    clock: Clock,
}

/// How the curve's parameter runs over a span.
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

impl Span<'_> {
    /// The curve's parameter at s ∈ [0, 1] of the restricted span.
    pub(super) fn t(&self, s: f64) -> f64 {
        let (t0, t1, share) = match self.clock {
            Clock::Linear { t0, t1 } => (t0, t1, s),
            Clock::Conic { t0, t1, half_rad } => (t0, t1, conic_parameter(s, half_rad)),
        };
        if share <= 0.5 { t0 + share * (t1 - t0) } else { t1 - (1.0 - share) * (t1 - t0) }
    }

    pub(super) fn about(&self, origin: Point) -> Polygon {
        self.bezier.about(origin).restricted(self.from, self.to)
    }

    pub(super) fn hodograph(&self) -> Vec<Vec2> {
        bernstein::restricted(&self.bezier.hodograph(), self.from, self.to)
    }

    /// A box around the whole Bézier, quick but loose.
    fn hull(&self) -> Rect {
        crate::geometry::bounds_of(self.bezier.points.iter().copied()).unwrap_or(Rect::ZERO)
    }
}

/// The Bézier pieces of t0..t1, in order.
pub(super) fn spans(curve: &Curve, t0: f64, t1: f64) -> Vec<Span<'_>> {
    let plain = |bezier, from, to, t0, t1| Span { bezier, from, to, clock: Clock::Linear { t0, t1 } };
    match curve {
        Curve::Line(l) => {
            let bezier = Bezier { points: vec![l.start, l.end], weights: None };
            vec![plain(Cow::Owned(bezier), t0, t1, t0, t1)]
        }
        Curve::Arc(a) => {
            let (u, v) = (Vec2::new(a.radius, 0.0), Vec2::new(0.0, a.radius));
            let (start_rad, sweep_rad, ends) = (a.start_rad, a.sweep_rad, a.ends);
            conic_spans(&EllipticArc { center: a.center, u, v, start_rad, sweep_rad, ends }, t0, t1)
        }
        Curve::Ellipse(e) => conic_spans(e, t0, t1),
        Curve::Bezier(b) => vec![plain(Cow::Borrowed(&**b), t0, t1, t0, t1)],
        Curve::Spline(s) => {
            let pieces = s.spans_in(t0, t1).map(|(i, from, to)| {
                plain(Cow::Borrowed(&s.spans[i]), from, to, s.knots[i].max(t0), s.knots[i + 1].min(t1))
            });
            pieces.collect()
        }
    }
}

fn conic_spans(e: &EllipticArc, t0: f64, t1: f64) -> Vec<Span<'static>> {
    e.conics(t0, t1)
        .into_iter()
        .map(|(bezier, t0, t1)| {
            let half_rad = 0.5 * e.sweep_rad * (t1 - t0);
            Span { bezier: Cow::Owned(bezier), from: 0.0, to: 1.0, clock: Clock::Conic { t0, t1, half_rad } }
        })
        .collect()
}

/// Parameters at which x or y may be extreme, knots included.
pub(super) fn extremes(curve: &Curve, t0: f64, t1: f64) -> Vec<f64> {
    let mut found = Vec::new();
    for span in spans(curve, t0, t1) {
        let hodograph = span.hodograph();
        for axis in [|v: &Vec2| v.x, |v: &Vec2| v.y] {
            let slope: Vec<f64> = hodograph.iter().map(axis).collect();
            found.extend(bernstein::roots(&slope, 0.0).into_iter().map(|s| span.t(s)));
        }
        found.extend([span.t(0.0), span.t(1.0)]);
    }
    found
}

/// See [`Curve::is_straight`], of all control points at once.
pub(super) fn is_straight(curve: &Curve) -> bool {
    let pieces = spans(curve, 0.0, 1.0);
    let points = pieces.iter().flat_map(|span| span.bezier.points.iter().copied()).collect();
    let noise = pieces.iter().map(|span| span.bezier.hodograph_noise()).fold(0.0, f64::max);
    Bezier { points, weights: None }.is_straight(noise)
}

/// Rounding of a product of two polynomials with the largest coefficients `a` and `b`, one of them of so many coefficients.
fn product_noise(a: f64, b: f64, count: usize) -> f64 {
    // Each coefficient is a sum with positive weights of total 1, each term off by a few ulp.
    4.0 * f64::EPSILON * a * b * count as f64
}

/// Where the distance to p is stationary or a span ends.
pub(super) fn nearest(curve: &Curve, p: Point, t0: f64, t1: f64) -> f64 {
    let pieces = spans(curve, t0, t1);
    let mut best = [t0, t1]
        .map(|t| (length(curve.point(t) - p), t))
        .into_iter()
        .fold((f64::INFINITY, t0), |a, b| if b.0 < a.0 { b } else { a });
    let bounds: Vec<f64> = pieces.iter().map(|span| distance_to_box(p, span.hull())).collect();
    let first = (0..pieces.len()).min_by(|i, j| bounds[*i].total_cmp(&bounds[*j])).unwrap_or(0);
    for i in std::iter::once(first).chain((0..pieces.len()).filter(|i| *i != first)) {
        if bounds[i] > best.0 {
            continue;
        }
        let span = &pieces[i];
        let offsets = span.about(p);
        let hodograph = span.hodograph();
        let numerators = offsets.numerators();
        let slope = bernstein::product(&numerators, &hodograph, |q, d| q.dot(d));
        let noise = product_noise(bernstein::longest(&numerators), bernstein::longest(&hodograph), slope.len());
        let exact = |s: f64| offsets.value(s).dot(bernstein::value(&hodograph, s));
        let stationary = bernstein::sign_changes(&slope, noise).into_iter().filter(|c| c.rising);
        for s in stationary.map(|change| crossing(exact, &change)).chain([0.0, 1.0]) {
            let distance = length(offsets.value(s));
            if distance < best.0 {
                best = (distance, span.t(s));
            }
        }
    }
    best.1
}
