//! B-splines and NURBS as their exact Bézier spans, and interpolating cubic splines.
//!
//! ```text
//!   knots    0        0.3            0.6       1      The distinct knots are mapped to 0..1. Between two neighbours
//!            ●─────────●──────────────●────────●      lies a span: a Bézier curve with its own parameter from 0 to 1.
//!   spans         0            1           2          It begins where the span before it ends.
//! ```

use super::bezier::{check_weights, set_ends};
use super::kind::Kind;
use super::span::Span;
use super::weights::even_spans;
use super::weld::Similarity;
use super::{Bezier, Curve, CurveError, End, Spline, check_finite, check_points, length};
use crate::geometry::{Point, Vec2, magnitude, scaled, unit_scale};
use std::borrow::Cow;

impl Spline {
    /// The spans of a full knot vector, each by its blossom (Ramshaw 1987; the same as inserting knots until each has
    /// full multiplicity). The domain runs from knot `degree` to knot `points.len()`. See [`Curve::nurbs`].
    pub(super) fn from_knots(
        degree: usize,
        knots: &[f64],
        points: &[Point],
        weights: Option<&[f64]>,
    ) -> Result<Self, CurveError> {
        check_points(points)?;
        check_finite(knots.iter().copied())?;
        if degree == 0 || points.len() <= degree {
            let needs = format!("a degree of at least 1 and more than {degree} control points");
            return Err(CurveError::Count { what: "a spline", needs, has: points.len() });
        }
        if knots.len() != points.len() + degree + 1 {
            let needs = format!("{} knots (control points + degree + 1)", points.len() + degree + 1);
            return Err(CurveError::Count { what: "a spline", needs, has: knots.len() });
        }
        if let Some(index) = (1..knots.len()).find(|i| knots[*i] < knots[*i - 1]) {
            return Err(CurveError::Knots { index });
        }
        if let Some(weights) = weights {
            check_weights(weights, points.len())?;
        }
        let mut starts = Vec::new();
        let mut spans: Vec<Bezier> = Vec::new();
        // A span whose control points coincide is one point: it is left out.
        let moves = |k: usize| points[k - degree..=k].iter().any(|p| *p != points[k]);
        let never_moves = points.iter().all(|p| *p == points[0]);
        for k in (degree..points.len()).filter(|k| knots[*k] < knots[*k + 1] && (moves(*k) || never_moves)) {
            let mut span = span_of(degree, knots, points, weights, k)?;
            if let Some(before) = spans.last() {
                let joint = before.points[before.degree()];
                // Both are roundings of the same point, each by at most a dozen units in the last place. Farther apart,
                // the curve has a gap.
                let slack = 32.0
                    * f64::EPSILON
                    * degree as f64
                    * crate::geometry::bounds_of(points.iter().copied()).map_or(0.0, magnitude);
                if length(span.points[0] - joint) > slack {
                    let needs = "inner knots of a multiplicity of at most the degree".to_string();
                    return Err(CurveError::Count { what: "a spline", needs, has: degree + 1 });
                }
                span.points[0] = joint;
            }
            let even = even_spans(span);
            let share = |i: usize| i as f64 / even.len() as f64;
            starts.extend((0..even.len()).map(|i| knots[k] * (1.0 - share(i)) + knots[k + 1] * share(i)));
            spans.extend(even);
        }
        if spans.is_empty() {
            return Err(CurveError::Count {
                what: "a spline",
                needs: "two distinct knots in its domain".into(),
                has: 1,
            });
        }
        starts.push(knots[points.len()]);
        Ok(Spline { knots: to_unit(&starts), spans })
    }

    /// The natural cubic spline: C², with a second derivative of zero at both ends.
    pub(super) fn natural(points: &[Point]) -> Result<Self, CurveError> {
        let points = without_repeats(points)?;
        if points.len() < 2 {
            let needs = "two distinct points".into();
            return Err(CurveError::Count { what: "a natural spline", needs, has: points.len() });
        }
        let steps = centripetal_steps(&points);
        Ok(Self::open(&points, &steps, [None, None]))
    }

    /// The cubic spline with parameters by chord length and the given directions as unit tangents at its ends; natural
    /// at an end that has none.
    pub(super) fn fitted(points: &[Point], tangents: [Option<Vec2>; 2]) -> Result<Self, CurveError> {
        /// Points nearer to each other than this share of the longest step become one: the square of their step has no
        /// digits left.
        const ONE: f64 = 1e-12;
        check_points(points)?;
        check_finite(tangents.iter().flatten().flat_map(|t| [t.x, t.y]))?;
        let longest = points.windows(2).map(|p| length(p[1] - p[0])).fold(0.0, f64::max);
        let mut points = points.to_vec();
        points.dedup_by(|b, a| length(*b - *a) <= ONE * longest);
        if points.len() < 2 {
            let needs = "two distinct points".into();
            return Err(CurveError::Count { what: "a spline through points", needs, has: points.len() });
        }
        let scale = unit_scale(longest);
        let steps: Vec<f64> = points.windows(2).map(|p| length(p[1] - p[0]) * scale).collect();
        let unit = |t: Vec2| t * (unit_scale(t.x.abs().max(t.y.abs())));
        let slope = |t: Option<Vec2>| t.map(unit).filter(|t| length(*t) > 0.0).map(|t| t / (length(t) * scale));
        Ok(Self::open(&points, &steps, tangents.map(slope)))
    }

    /// The C² cubic through points at given steps of the parameter, with the given derivatives at its ends; at an end
    /// without one its second derivative is zero.
    fn open(points: &[Point], steps: &[f64], ends: [Option<Vec2>; 2]) -> Self {
        let n = points.len();
        let (mut diagonal, mut right) = (vec![0.0; n], vec![Vec2::ZERO; n]);
        for i in 0..n - 1 {
            // The span adds (2 mᵢ + mᵢ₊₁)/h = 3 Δ/h² to the row of its start, and the mirror image to the row of its
            // end.
            let slope = (points[i + 1] - points[i]) * (3.0 / (steps[i] * steps[i]));
            for row in [i, i + 1] {
                diagonal[row] += 2.0 / steps[i];
                right[row] += slope;
            }
        }
        let mut beside: Vec<f64> = steps.iter().map(|h| 1.0 / h).collect();
        // A known slope is eliminated: its row states it, and its term in the neighbour's row moves to the right side.
        for (slope, row, neighbour, step) in [(ends[0], 0, 1, 0), (ends[1], n - 1, n - 2, n - 2)] {
            if let Some(slope) = slope {
                right[neighbour] -= slope * beside[step];
                (diagonal[row], right[row], beside[step]) = (1.0, slope, 0.0);
            }
        }
        let slopes = solve_tridiagonal(&diagonal, &beside, right);
        hermite(points, steps, &slopes)
    }

    /// The closed cubic spline, C² everywhere.
    pub(super) fn periodic(points: &[Point]) -> Result<Self, CurveError> {
        let mut points = without_repeats(points)?;
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        let n = points.len();
        if n < 3 {
            return Err(CurveError::Count { what: "a periodic spline", needs: "three distinct points".into(), has: n });
        }
        points.push(points[0]);
        let steps = centripetal_steps(&points);
        let (mut diagonal, mut right) = (vec![0.0; n], vec![Vec2::ZERO; n]);
        for i in 0..n {
            let slope = (points[i + 1] - points[i]) * (3.0 / (steps[i] * steps[i]));
            for row in [i, (i + 1) % n] {
                diagonal[row] += 2.0 / steps[i];
                right[row] += slope;
            }
        }
        // The corner entries by the Sherman–Morrison formula: A = T + w·e eᵀ with e = e₀ + eₙ₋₁.
        let corner = 1.0 / steps[n - 1];
        diagonal[0] -= corner;
        diagonal[n - 1] -= corner;
        let beside: Vec<f64> = steps[..n - 1].iter().map(|h| 1.0 / h).collect();
        let mut rank_one = vec![Vec2::ZERO; n];
        rank_one[0].x = corner;
        rank_one[n - 1].x = corner;
        let plain = solve_tridiagonal(&diagonal, &beside, right);
        let response = solve_tridiagonal(&diagonal, &beside, rank_one);
        let factor = (plain[0] + plain[n - 1]) / (1.0 + response[0].x + response[n - 1].x);
        let mut slopes: Vec<Vec2> = plain.iter().zip(&response).map(|(p, r)| *p - factor * r.x).collect();
        slopes.push(slopes[0]);
        Ok(hermite(&points, &steps, &slopes))
    }

    /// The span at t and the parameter within it; at a knot the span after (`Start`) or before it (`Finish`).
    fn locate(&self, t: f64, side: End) -> (usize, f64) {
        let after = match side {
            End::Start => self.knots.partition_point(|k| *k <= t),
            End::Finish => self.knots.partition_point(|k| *k < t),
        };
        let i = after.clamp(1, self.spans.len()) - 1;
        (i, self.within(i, t))
    }

    /// The parameter within span i.
    fn within(&self, i: usize, t: f64) -> f64 {
        ((t - self.knots[i]) / self.step(i)).clamp(0.0, 1.0)
    }

    fn step(&self, i: usize) -> f64 {
        self.knots[i + 1] - self.knots[i]
    }

    /// The spans that t0..t1 passes, with the range of each one's own parameter.
    fn spans_in(&self, t0: f64, t1: f64) -> impl DoubleEndedIterator<Item = (usize, f64, f64)> + '_ {
        let (first, last) = (self.locate(t0, End::Start).0, self.locate(t1, End::Finish).0);
        (first..=last.max(first)).map(move |i| {
            let from = if i == first { self.within(i, t0) } else { 0.0 };
            let to = if i == last { self.within(i, t1) } else { 1.0 };
            (i, from, to)
        })
    }

    /// The part t0..t1 with the given ends.
    fn cut_out(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Self {
        let mut knots = vec![t0];
        let mut spans = Vec::new();
        let pieces: Vec<_> = self.spans_in(t0, t1).collect();
        // A cut at a joint may miss it by rounding, and by more where the curves meet at a small angle. The sliver that
        // remains has no reliable direction, so its neighbour replaces it. The direction of legs that are a few
        // thousand units in the last place long is accurate to a thousandth.
        let is_sliver = |&(i, from, to): &(usize, f64, f64)| {
            let reach = self.spans[i].points.iter().map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
            to - from <= 64.0 * f64::EPSILON || net_of(&self.spans[i], from, to) <= 4096.0 * f64::EPSILON * reach
        };
        let first = usize::from(pieces.len() > 1 && is_sliver(&pieces[0]));
        let last = pieces.len() - 1;
        let last = if last > first && is_sliver(&pieces[last]) { last - 1 } else { last };
        for (k, &(i, from, to)) in pieces.iter().enumerate().take(last + 1).skip(first) {
            let span = &self.spans[i];
            let start = if k == first { ends[0] } else { span.points[0] };
            let end = if k == last { ends[1] } else { span.points[span.degree()] };
            let whole = [from, to] == [0.0, 1.0] && [start, end] == [span.points[0], span.points[span.degree()]];
            spans.push(if whole { span.clone() } else { span.cut_out(from, to, [start, end]) });
            knots.push(if k == last { t1 } else { self.knots[i + 1] });
        }
        Spline { knots: to_unit(&knots), spans }
    }

    fn turned_round(&self) -> Self {
        let knots: Vec<f64> = self.knots.iter().rev().map(|k| 1.0 - k).collect();
        Spline { knots: to_unit(&knots), spans: self.spans.iter().rev().map(Bezier::turned_round).collect() }
    }

    fn mapped(&self, map: impl Fn(Point) -> Point) -> Self {
        Spline { knots: self.knots.clone(), spans: self.spans.iter().map(|s| s.mapped(&map)).collect() }
    }
}

impl Kind for Spline {
    fn name(&self) -> &'static str {
        if self.spans.iter().all(|span| span.weights.is_none()) { "spline" } else { "nurbs" }
    }
    fn ends(&self) -> [Point; 2] {
        let last = &self.spans[self.spans.len() - 1];
        [self.spans[0].points[0], last.points[last.degree()]]
    }
    fn inner_point(&self, t: f64) -> Point {
        let (i, u) = self.locate(t, End::Start);
        self.spans[i].at(u)
    }
    fn derivative(&self, t: f64) -> Vec2 {
        let (i, u) = self.locate(t, End::Start);
        self.spans[i].derivative(u) / self.step(i)
    }
    fn second_derivative(&self, t: f64) -> Vec2 {
        let (i, u) = self.locate(t, End::Start);
        self.spans[i].second_derivative(u) / self.step(i) / self.step(i)
    }
    fn spans(&self, t0: f64, t1: f64) -> Vec<Span<'_>> {
        let span = |(i, from, to): (usize, f64, f64)| {
            Span::even(Cow::Borrowed(&self.spans[i]), [from, to], [self.knots[i].max(t0), self.knots[i + 1].min(t1)])
        };
        self.spans_in(t0, t1).map(span).collect()
    }
    fn control_count(&self) -> usize {
        self.spans.iter().map(|span| span.points.len()).sum()
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
        set_ends(&mut moved.spans, ends);
        boxed(moved)
    }
    fn spread(&self, moves: [Vec2; 2], ends: [Point; 2]) -> Curve {
        let knots = self.knots.windows(2).map(|pair| [pair[0], pair[1]]);
        let mut spans: Vec<Bezier> = self.spans.iter().zip(knots).map(|(s, t)| s.spread_over(moves, t)).collect();
        set_ends(&mut spans, ends);
        boxed(Spline { knots: self.knots.clone(), spans })
    }
    fn knots(&self) -> Vec<f64> {
        self.knots.clone()
    }

    fn tangent(&self, t: f64, side: End) -> Vec2 {
        let (i, u) = self.locate(t, side);
        self.spans[i].tangent(u, side)
    }
}

fn boxed(spline: Spline) -> Curve {
    Curve::Spline(Box::new(spline))
}

/// The length of the control polygon of a part of a span: an upper bound of the part's length.
fn net_of(span: &Bezier, from: f64, to: f64) -> f64 {
    let part = span.cut_out(from, to, [span.at(from), span.at(to)]);
    part.points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// Ascending numbers mapped to 0..1, strictly ascending despite rounding.
fn to_unit(knots: &[f64]) -> Vec<f64> {
    let last = knots.len() - 1;
    // Halved first, since a difference may overflow.
    let span = 0.5 * knots[last] - 0.5 * knots[0];
    let mut unit: Vec<f64> = knots.iter().map(|k| (0.5 * k - 0.5 * knots[0]) / span).collect();
    (unit[0], unit[last]) = (0.0, 1.0);
    for i in 1..last {
        unit[i] = unit[i].max(unit[i - 1].next_up());
    }
    for i in (1..last).rev() {
        unit[i] = unit[i].min(unit[i + 1].next_down());
    }
    unit
}

/// A weighted point between two others; exact where `share` is 0 or 1.
fn between(a: (Point, f64), b: (Point, f64), share: f64) -> (Point, f64) {
    if share >= 1.0 {
        return b;
    }
    let weight = a.1 + (b.1 - a.1) * share;
    (a.0 + (b.0 - a.0) * (share * b.1 / weight), weight)
}

/// The Bézier control points over knots k..k+1: the j-th is the blossom at knot k (degree − j times) and knot k + 1 (j
/// times).
fn span_of(
    degree: usize,
    knots: &[f64],
    points: &[Point],
    weights: Option<&[f64]>,
    k: usize,
) -> Result<Bezier, CurveError> {
    let local: Vec<(Point, f64)> = (k - degree..=k).map(|i| (points[i], weights.map_or(1.0, |w| w[i]))).collect();
    let controls: Vec<(Point, f64)> = (0..=degree)
        .map(|j| {
            let mut d = local.clone();
            for round in 1..=degree {
                let at = if round <= degree - j { knots[k] } else { knots[k + 1] };
                for i in (round..=degree).rev() {
                    let (low, high) = (knots[k - degree + i], knots[k + 1 + i - round]);
                    d[i] = between(d[i - 1], d[i], (0.5 * at - 0.5 * low) / (0.5 * high - 0.5 * low));
                }
            }
            d[degree]
        })
        .collect();
    let weights = weights.map(|_| controls.iter().map(|c| c.1).collect());
    Bezier::new(controls.into_iter().map(|c| c.0).collect(), weights)
}

fn without_repeats(points: &[Point]) -> Result<Vec<Point>, CurveError> {
    check_points(points)?;
    let mut distinct = points.to_vec();
    distinct.dedup();
    Ok(distinct)
}

/// Parameter steps by the square root of the distance (Lee 1989). They make neither loops nor cusps within a span, as
/// uniform and chord-length parameters may (proven for the Catmull–Rom spline by Yuksel, Schaefer & Keyser 2011). The
/// bits are the same at every scale.
fn centripetal_steps(points: &[Point]) -> Vec<f64> {
    let distances: Vec<f64> = points.windows(2).map(|p| length(p[1] - p[0])).collect();
    let scale = unit_scale(distances.iter().fold(0.0, |m: f64, d| m.max(*d)));
    distances.iter().map(|d| (d * scale).sqrt()).collect()
}

/// Solves the symmetric, diagonally dominant system (Thomas' algorithm).
fn solve_tridiagonal(diagonal: &[f64], beside: &[f64], mut right: Vec<Vec2>) -> Vec<Vec2> {
    let n = diagonal.len();
    let mut pivots = diagonal.to_vec();
    for i in 1..n {
        let factor = beside[i - 1] / pivots[i - 1];
        pivots[i] -= factor * beside[i - 1];
        let above = right[i - 1];
        right[i] -= above * factor;
    }
    right[n - 1] /= pivots[n - 1];
    for i in (0..n - 1).rev() {
        right[i] = (right[i] - right[i + 1] * beside[i]) / pivots[i];
    }
    right
}

/// The cubic spans through points with given derivatives (Hermite interpolation).
fn hermite(points: &[Point], steps: &[f64], slopes: &[Vec2]) -> Spline {
    let mut knots = vec![0.0];
    let mut spans = Vec::with_capacity(steps.len());
    for (i, step) in steps.iter().enumerate() {
        let third = step / 3.0;
        let (a, b) = (points[i], points[i + 1]);
        spans.push(Bezier { points: vec![a, a + slopes[i] * third, b - slopes[i + 1] * third, b], weights: None });
        knots.push(knots[i] + step);
    }
    Spline { knots: to_unit(&knots), spans }
}
