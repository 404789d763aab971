//! A Bézier curve of any degree, polynomial or rational.
//!
//! All arithmetic uses differences from a nearby point, so a distant origin costs only one rounding at the end.

use super::bernstein;
use super::kind::Kind;
use super::polygon::{Polygon, Weighted};
use super::span::Span;
use super::spans;
use super::weld::{Similarity, spread_to};
use super::{Bezier, Curve, CurveError, End, check_finite, check_points, length, quadrature, unit};
use crate::geometry::{Point, Vec2, scaled, unit_scale};
use std::borrow::Cow;

/// The largest degree. Above it, binomial coefficients of the products (three times the degree) exceed the range of
/// `f64`.
const DEGREE_MAX: usize = 300;

impl Bezier {
    /// Whether all control points, and so the curve, lie on one side of the line through `a` along `direction`, farther
    /// from it than rounding.
    pub(super) fn is_beside_line(&self, a: Point, direction: Vec2) -> bool {
        let farthest = self.points.iter().map(|p| (*p - a).hypot()).fold(0.0, f64::max);
        let clear = 64.0 * f64::EPSILON * farthest * direction.hypot();
        let mut sides = self.points.iter().map(|p| (*p - a).cross(direction));
        let Some(first) = sides.next().filter(|side| side.abs() > clear) else { return false };
        sides.all(|side| side.abs() > clear && (side > 0.0) == (first > 0.0))
    }

    /// A Bézier curve from control points and weights, as in [`Curve::rational_bezier`]; the weights are not evened.
    pub(super) fn new(points: Vec<Point>, weights: Option<Vec<f64>>) -> Result<Self, CurveError> {
        check_points(&points)?;
        if !(2..=DEGREE_MAX + 1).contains(&points.len()) {
            let needs = format!("2 to {} control points", DEGREE_MAX + 1);
            return Err(CurveError::Count { what: "a Bézier curve", needs, has: points.len() });
        }
        if let Some(weights) = &weights {
            check_weights(weights, points.len())?;
        }
        // Equal weights are dropped. A common factor has no effect, so it is chosen to keep products of weights in
        // range.
        let weights = weights.filter(|w| w.iter().any(|v| *v != w[0])).map(|mut w| {
            let scale = unit_scale(bernstein::largest(&w));
            w.iter_mut().for_each(|v| *v *= scale);
            w
        });
        Ok(Bezier { points, weights })
    }

    /// The degree: the number of control points minus one.
    pub(super) fn degree(&self) -> usize {
        self.points.len() - 1
    }

    fn weighted(&self, weights: &[f64], i: usize) -> Weighted {
        Weighted { at: (self.points[i] - self.points[0]) * weights[i], weight: weights[i] }
    }

    /// The point at t; exactly an end where t ≤ 0 or t ≥ 1.
    pub(super) fn at(&self, t: f64) -> Point {
        let first = self.points[0];
        if t <= 0.0 {
            return first;
        }
        if t >= 1.0 {
            return self.points[self.degree()];
        }
        let count = self.points.len();
        first
            + match &self.weights {
                None => bernstein::value_by(count, |i| self.points[i] - first, t),
                Some(w) => bernstein::value_by(count, |i| self.weighted(w, i), t).point(),
            }
    }

    /// The control polygon relative to `origin`.
    pub(super) fn about(&self, origin: Point) -> Polygon {
        match &self.weights {
            None => Polygon::Plain(self.points.iter().map(|p| *p - origin).collect()),
            Some(w) => Polygon::Rational(
                self.points.iter().zip(w).map(|(p, w)| Weighted { at: (*p - origin) * *w, weight: *w }).collect(),
            ),
        }
    }

    /// The coefficients of a polynomial vector in the direction of the derivative. For a polynomial curve it is the
    /// derivative over the degree n. For a rational curve that is multiplied by the squared denominator: (W N′ − N
    /// W′)/n = Σ wᵢ wⱼ₊₁ (Pⱼ₊₁ − Pᵢ), over the products of degree n − 1.
    pub(super) fn hodograph(&self) -> Vec<Vec2> {
        let p = &self.points;
        let Some(w) = &self.weights else {
            return p.windows(2).map(|pair| pair[1] - pair[0]).collect();
        };
        let indices: Vec<usize> = (0..p.len()).collect();
        bernstein::product(&indices[..self.degree()], &indices[1..], |i, j| (p[j] - p[i]) * (w[i] * w[j]))
    }

    /// The error of a coefficient of the hodograph that comes from the rounding of control points.
    pub(super) fn hodograph_noise(&self) -> f64 {
        let largest = self.points.iter().fold(0.0f64, |m, p| m.max(p.x.abs()).max(p.y.abs()));
        let weight = self.weights.as_ref().map_or(1.0, |w| w.iter().fold(0.0f64, |m, v| m.max(*v)));
        // A coefficient is a difference of two points. Each has an error of √2 · ½ units in the last place as given,
        // and once more where a part was cut or welded.
        4.0 * f64::EPSILON * largest * weight * weight
    }

    /// The part t0..t1 with the given ends.
    pub(super) fn cut_out(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Self {
        let first = self.points[0];
        let polygon = self.about(first).restricted(t0, t1);
        let mut points: Vec<Point> = polygon.points().into_iter().map(|v| first + v).collect();
        let last = points.len() - 1;
        (points[0], points[last]) = (ends[0], ends[1]);
        Bezier { points, weights: polygon.weights() }
    }

    /// The same curve followed the other way.
    pub(super) fn turned_round(&self) -> Self {
        let mut reversed = self.clone();
        reversed.points.reverse();
        if let Some(w) = &mut reversed.weights {
            w.reverse();
        }
        reversed
    }

    /// The span of a longer curve over its t0..t1, with the moves of that curve's ends spread by the parameter.
    pub(super) fn spread_over(&self, moves: [Vec2; 2], [t0, t1]: [f64; 2]) -> Self {
        let mut moved = self.clone();
        let last = moved.degree();
        for (i, p) in moved.points.iter_mut().enumerate() {
            // Neighbouring spans move their joint by the same bits.
            let t = if i == last { t1 } else { t0 + (t1 - t0) * (i as f64 / last as f64) };
            *p += spread_to(moves, t);
        }
        moved
    }

    /// The curve with `map` applied to its control points; for affine maps its image.
    pub(super) fn mapped(&self, map: impl Fn(Point) -> Point) -> Self {
        Bezier { points: self.points.iter().map(|p| map(*p)).collect(), weights: self.weights.clone() }
    }

    /// ½∮(x dy − y dx) between the curve and its chord.
    pub(super) fn segment_area(&self) -> f64 {
        let first = self.points[0];
        let area_rate = match self.about(first) {
            Polygon::Plain(c) => {
                let rate = bernstein::product(&c, &bernstein::derivative(&c), |p, d| p.cross(d));
                rate.iter().sum::<f64>() / rate.len() as f64
            }
            // (N × N′)/W².
            Polygon::Rational(c) => {
                let slopes = bernstein::derivative(&c);
                let size = bernstein::longest(&self.about(first).points());
                let rate = |t: f64| {
                    let (value, slope) = (bernstein::value(&c, t), bernstein::value(&slopes, t));
                    value.at.cross(slope.at) / (value.weight * value.weight)
                };
                quadrature::integral(rate, 0.0, 1.0, size * size)
            }
        };
        0.5 * area_rate
    }

    /// Whether no control point is off the chord, and no leg goes back along it, by more than `noise`.
    pub(super) fn is_straight_within(&self, noise: f64) -> bool {
        let chord = self.points[self.degree()] - self.points[0];
        let len = length(chord);
        if len <= noise {
            return self.points.iter().all(|p| length(*p - self.points[0]) <= noise);
        }
        self.points.iter().all(|p| (*p - self.points[0]).cross(chord).abs() <= noise * len)
            && self.points.windows(2).all(|p| (p[1] - p[0]).dot(chord) >= -noise * len)
    }
}

impl Kind for Bezier {
    fn name(&self) -> &'static str {
        if self.weights.is_none() { "bezier" } else { "rational bezier" }
    }
    fn ends(&self) -> [Point; 2] {
        [self.points[0], self.points[self.degree()]]
    }
    fn inner_point(&self, t: f64) -> Point {
        self.at(t)
    }
    fn derivative(&self, t: f64) -> Vec2 {
        let n = self.degree();
        let Some(w) = &self.weights else {
            return bernstein::value_by(n, |i| self.points[i + 1] - self.points[i], t) * n as f64;
        };
        let value = bernstein::value_by(n + 1, |i| self.weighted(w, i), t);
        let slope = bernstein::value_by(n, |i| self.weighted(w, i + 1) - self.weighted(w, i), t) * n as f64;
        (slope.at - value.point() * slope.weight) / value.weight
    }
    fn second_derivative(&self, t: f64) -> Vec2 {
        let n = self.degree();
        let factor = (n * (n - 1)) as f64;
        let p = &self.points;
        let Some(w) = &self.weights else {
            if n < 2 {
                return Vec2::ZERO;
            }
            return bernstein::value_by(n - 1, |i| (p[i + 2] - p[i + 1]) - (p[i + 1] - p[i]), t) * factor;
        };
        let q = |i: usize| self.weighted(w, i);
        let value = bernstein::value_by(n + 1, q, t);
        let slope = bernstein::value_by(n, |i| q(i + 1) - q(i), t) * n as f64;
        let bend = if n < 2 {
            Weighted { at: Vec2::ZERO, weight: 0.0 }
        } else {
            bernstein::value_by(n - 1, |i| (q(i + 2) - q(i + 1)) - (q(i + 1) - q(i)), t) * factor
        };
        let first = (slope.at - value.point() * slope.weight) / value.weight;
        (bend.at - first * (2.0 * slope.weight) - value.point() * bend.weight) / value.weight
    }
    fn spans(&self, t0: f64, t1: f64) -> Vec<Span<'_>> {
        vec![Span::even(Cow::Borrowed(self), [t0, t1], [t0, t1])]
    }
    fn control_count(&self) -> usize {
        self.points.len()
    }
    fn may_meet_itself(&self) -> bool {
        true
    }
    fn part(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Curve {
        boxed(self.cut_out(t0, t1, ends))
    }
    fn reversed(&self) -> Curve {
        boxed(self.turned_round())
    }
    fn scaled(&self, factor: f64) -> Curve {
        boxed(self.mapped(|p| scaled(p, factor)))
    }
    fn transformed(&self, map: kurbo::Affine) -> Curve {
        boxed(self.mapped(|p| map * p))
    }
    fn moved(&self, map: &Similarity, ends: [Point; 2]) -> Curve {
        let mut moved = self.mapped(|p| map.point(p));
        set_ends(std::slice::from_mut(&mut moved), ends);
        boxed(moved)
    }
    fn spread(&self, moves: [Vec2; 2], ends: [Point; 2]) -> Curve {
        let mut moved = self.spread_over(moves, [0.0, 1.0]);
        set_ends(std::slice::from_mut(&mut moved), ends);
        boxed(moved)
    }

    fn tangent(&self, t: f64, side: End) -> Vec2 {
        let hodograph = self.hodograph();
        let noise = self.hodograph_noise();
        let there = bernstein::value(&hodograph, t);
        if length(there) > noise {
            return unit(there);
        }
        let (before, after) = bernstein::split(&hodograph, t);
        let limit = |side| match side {
            End::Start => after.iter().find(|d| length(**d) > noise),
            End::Finish => before.iter().rev().find(|d| length(**d) > noise),
        };
        let other = if side == End::Start { End::Finish } else { End::Start };
        unit(limit(side).or_else(|| limit(other)).copied().unwrap_or(self.points[self.degree()] - self.points[0]))
    }
    fn is_straight(&self) -> bool {
        self.is_straight_within(self.hodograph_noise())
    }
    fn line_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        if self.is_beside_line(a, direction) {
            return Vec::new();
        }
        spans::line_crossings(&self.spans(t0, t1), a, direction, t0, t1)
    }
}

fn boxed(bezier: Bezier) -> Curve {
    Curve::Bezier(Box::new(bezier))
}

/// Sets the exact ends of a chain of spans.
pub(super) fn set_ends(spans: &mut [Bezier], [start, end]: [Point; 2]) {
    if let Some(first) = spans.first_mut().and_then(|span| span.points.first_mut()) {
        *first = start;
    }
    if let Some(last) = spans.last_mut().and_then(|span| span.points.last_mut()) {
        *last = end;
    }
}

/// Refuses weights that are not `count` positive finite numbers.
pub(super) fn check_weights(weights: &[f64], count: usize) -> Result<(), CurveError> {
    if weights.len() != count {
        let needs = format!("{count} weights, one a control point");
        return Err(CurveError::Count { what: "a rational curve", needs, has: weights.len() });
    }
    check_finite(weights.iter().copied())?;
    match weights.iter().position(|w| *w <= 0.0) {
        Some(index) => Err(CurveError::Weight { index }),
        None => Ok(()),
    }
}
