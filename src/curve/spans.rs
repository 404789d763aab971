//! Queries computed span by span, on the Bézier spans of any curve.
//!
//! Each becomes a polynomial in Bernstein form. Its sign changes are isolated, and then refined on the curve itself.

use super::bernstein::{self, SignChange, crossing};
use super::kind::Kind;
use super::polygon::Polygon;
use super::quadrature::integral;
use super::span::Span;
use super::{Bezier, Cone, End, length};
use crate::geometry::{Point, Vec2, boxes::distance_to_box, turn_from};

/// Parameters at which x or y may be extreme, knots included.
pub(super) fn extremes(spans: &[Span]) -> Vec<f64> {
    let mut found = Vec::new();
    for span in spans {
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
pub(super) fn is_straight(spans: &[Span]) -> bool {
    let points = spans.iter().flat_map(|span| span.bezier.points.iter().copied()).collect();
    let noise = spans.iter().map(|span| span.bezier.hodograph_noise()).fold(0.0, f64::max);
    Bezier { points, weights: None }.is_straight_within(noise)
}

/// The rounding error of a product of two polynomials with largest coefficients `a` and `b`, one of them with `count`
/// coefficients.
fn product_noise(a: f64, b: f64, count: usize) -> f64 {
    // Each coefficient is a mean with positive weights; each term has an error of a few units in the last place.
    4.0 * f64::EPSILON * a * b * count as f64
}

/// The parameter of the point nearest to p: among the places where the distance is stationary, and the ends of spans.
pub(super) fn nearest(curve: &(impl Kind + ?Sized), p: Point, t0: f64, t1: f64) -> f64 {
    let pieces = curve.spans(t0, t1);
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
    let is_end = [t0, t1].contains(&best.1) || pieces.iter().any(|span| span.t(0.0) == best.1);
    if is_end { descended(curve, p, best, [t0, t1]) } else { best.1 }
}

/// Descends from an end of a span that seems nearest to p, along the curve, as long as the distance decreases. This is
/// needed where the curve starts slowly, and the slope's coefficients are below noise. The steps are Newton's, or
/// Gauss–Newton's where the distance is not convex; each is halved until the distance decreases.
fn descended(curve: &(impl Kind + ?Sized), p: Point, (mut distance, mut t): (f64, f64), [t0, t1]: [f64; 2]) -> f64 {
    const BUDGET: usize = 40;
    let mut share = 1.0;
    for _ in 0..BUDGET {
        let (offset, d, dd) = (curve.point(t) - p, curve.derivative(t), curve.second_derivative(t));
        let step = offset.dot(d) / (d.dot(d) + offset.dot(dd).max(0.0));
        let stepped = (t - share * step).clamp(t0, t1);
        if stepped == t || stepped.is_nan() {
            break;
        }
        let nearer = length(curve.point(stepped) - p);
        if nearer < distance {
            (distance, t, share) = (nearer, stepped, 1.0);
        } else {
            share *= 0.5;
        }
    }
    t
}

/// See [`Curve::line_crossings`](super::Curve::line_crossings): the sign changes of the distance from the line.
pub(super) fn line_crossings(spans: &[Span], a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut before: Option<bool> = None;
    for span in spans {
        let anchor = span.bezier.points[0];
        let local = span.about(anchor);
        // Only the constant carries the rounding of a distant `a`: it moves the line as a whole.
        let distance = local.linear_form(|v| v.cross(direction), (anchor - a).cross(direction));
        let noise = product_noise(bernstein::longest(&local.numerators()), length(direction), 1);
        let Some((first, last, _)) = bernstein::variations(&distance, noise) else { continue };
        if before.is_some_and(|sign| sign != first) {
            found.push(span.t(0.0));
        }
        let exact = |s: f64| bernstein::value(&distance, s);
        found.extend(bernstein::sign_changes(&distance, noise).iter().map(|change| span.t(crossing(exact, change))));
        before = Some(last);
    }
    found.retain(|t| *t > t0 && *t < t1);
    found
}

/// See [`Curve::bisector_crossing`](super::Curve::bisector_crossing): a bisection over the knots down to one span, then
/// a root within it.
///
/// ```text
///               │ bisector
///          ╭────●────╮            x and y: the ends of the part. `beyond` is (z − x)·chord − ½ chord², negative on the
///      x ●─╯    │    ╰─● y        side of x, positive on that of y.
///               │
/// ```
pub(super) fn bisector_crossing(curve: &(impl Kind + ?Sized), t0: f64, t1: f64) -> f64 {
    let (x, y) = (curve.point(t0), curve.point(t1));
    let chord = y - x;
    if chord == Vec2::ZERO {
        return 0.5 * (t0 + t1);
    }
    let half = 0.5 * chord.dot(chord);
    let pieces = curve.spans(t0, t1);
    let (mut low, mut high) = (0, pieces.len());
    while high - low > 1 {
        let mid = low + (high - low) / 2;
        let start = pieces[mid].start();
        if (start - x).dot(chord) < half { low = mid } else { high = mid }
    }
    let span = &pieces[low];
    let beyond = span.about(x).linear_form(|v| v.dot(chord), -half);
    let change = SignChange { lo: 0.0, hi: 1.0, rising: true };
    span.t(crossing(|s| bernstein::value(&beyond, s), &change))
}

/// The squared distance from the polygon's origin minus the squared radius, times the squared denominator.
fn beyond_ball(polygon: &Polygon, radius: f64) -> Vec<f64> {
    let numerators = polygon.numerators();
    let square = bernstein::product(&numerators, &numerators, |a, b| a.dot(b));
    match polygon.weights() {
        None => square.into_iter().map(|d| d - radius * radius).collect(),
        Some(w) => {
            let weights = bernstein::product(&w, &w, |a, b| a * b);
            square.iter().zip(&weights).map(|(d, w)| d - radius * radius * w).collect()
        }
    }
}

/// The parameter, in its own range, at which the polygon's curve first leaves the ball around the origin.
fn first_beyond(polygon: &Polygon, radius: f64) -> Option<f64> {
    /// After this many halvings there is no number between the ends of a part.
    const DEPTH: u32 = 52;
    const PIECE_BUDGET: usize = 1 << 12;
    let exact = |s: f64| length(polygon.value(s)) - radius;
    let mut stack = vec![(0.0, 1.0, 0, polygon.clone())];
    for _ in 0..PIECE_BUDGET {
        let (lo, hi, depth, piece) = stack.pop()?;
        let beyond = beyond_ball(&piece, radius);
        let Some((first, last, count)) = bernstein::variations(&beyond, 0.0) else { continue };
        if first {
            return Some(lo);
        }
        if count == 0 {
            continue;
        }
        if count == 1 || depth >= DEPTH {
            if last {
                return Some(crossing(exact, &SignChange { lo, hi, rising: true }));
            }
            continue;
        }
        let mid = 0.5 * (lo + hi);
        let (left, right) = piece.split(0.5);
        stack.push((mid, hi, depth + 1, right));
        stack.push((lo, mid, depth + 1, left));
    }
    None
}

/// See [`Curve::leaves_ball`](super::Curve::leaves_ball).
pub(super) fn leaves_ball(curve: &(impl Kind + ?Sized), end: End, radius: f64, t0: f64, t1: f64) -> Option<f64> {
    let (center_t, far_t) = match end {
        End::Start => (t0, t1),
        End::Finish => (t1, t0),
    };
    let center = curve.point(center_t);
    let mut pieces = curve.spans(t0, t1);
    if end == End::Finish {
        pieces.reverse();
    }
    for span in pieces {
        let polygon = span.about(center);
        if polygon.points().iter().all(|p| length(*p) < radius) {
            continue;
        }
        let found = match end {
            End::Start => first_beyond(&polygon, radius).map(|s| span.t(s)),
            End::Finish => first_beyond(&polygon.reversed(), radius).map(|s| span.t(1.0 - s)),
        };
        if let Some(t) = found {
            return Some(t.clamp(t0, t1));
        }
    }
    // The far end itself may lie on the ball, up to rounding of the distance.
    let reach = length(curve.point(far_t) - center);
    (reach >= radius * (1.0 - 4.0 * f64::EPSILON)).then_some(far_t)
}

/// The largest distance from the chord. It is taken at an end of a span, or where the tangent is parallel to the chord.
/// If the curve leaves the strip between the perpendiculars at the chord's ends, it may also be where the distance from
/// an end of the chord is stationary, or where the curve leaves the strip.
pub(super) fn chord_error(curve: &(impl Kind + ?Sized), t0: f64, t1: f64) -> f64 {
    let (x, y) = (curve.point(t0), curve.point(t1));
    let chord = y - x;
    let square = chord.dot(chord);
    let distance = |offset: Vec2| {
        let along = if square > 0.0 { (offset.dot(chord) / square).clamp(0.0, 1.0) } else { 0.0 };
        if along > 0.0 && along < 1.0 {
            offset.cross(chord).abs() / square.sqrt()
        } else {
            length(offset - chord * along)
        }
    };
    let mut largest = 0.0f64;
    for span in curve.spans(t0, t1) {
        let offsets = span.about(x);
        let hodograph = span.hodograph();
        let mut forms = vec![hodograph.iter().map(|d| d.cross(chord)).collect::<Vec<f64>>()];
        let past = square == 0.0 || offsets.points().iter().any(|v| !(0.0..=square).contains(&v.dot(chord)));
        if past {
            let from_end = span.about(y);
            for polygon in [&offsets, &from_end] {
                forms.push(bernstein::product(&polygon.numerators(), &hodograph, |v, d| v.dot(d)));
                forms.push(polygon.linear_form(|v| v.dot(chord), 0.0));
            }
        }
        let stationary = forms.iter().flat_map(|form| {
            let noise = product_noise(bernstein::largest(form), 1.0, form.len());
            bernstein::roots(form, noise)
        });
        for s in stationary.chain([0.0, 1.0]) {
            largest = largest.max(distance(offsets.value(s)));
        }
    }
    largest
}

/// The arc length of the restricted spans, by quadrature.
pub(super) fn length_of(spans: &[Span]) -> f64 {
    let of = |span: &Span| {
        let polygon_length: f64 = span.bezier.points.windows(2).map(|p| length(p[1] - p[0])).sum();
        let scale = polygon_length * (span.to - span.from);
        integral(|u| length(span.bezier.derivative(u)), span.from, span.to, scale)
    };
    spans.iter().map(of).sum()
}

/// ½∮(x dy − y dx) between whole spans and the chord of them all.
pub(super) fn area_over_chord(spans: &[Span]) -> f64 {
    let Some(start) = spans.first().map(|span| span.bezier.points[0]) else { return 0.0 };
    let above = |span: &Span| {
        let (a, b) = (span.bezier.points[0], span.bezier.points[span.bezier.degree()]);
        0.5 * (a - start).cross(b - a) + span.bezier.segment_area()
    };
    spans.iter().map(above).sum()
}

/// See [`Kind::widens`]: a Bézier curve lies in the hull of its control points.
pub(super) fn widens(spans: &[Span], cone: &mut Cone, [start, finish]: [Point; 2], end: End) -> bool {
    let (apex, other) = match end {
        End::Start => (start, finish),
        End::Finish => (finish, start),
    };
    spans.iter().all(|span| cone.widen_to(&span.bezier.points, apex, other - apex))
}

/// The largest turn at a point z of the part between the directions x → z and z → y.
///
/// Let W be the denominator, N = (z − x)·W and c = y − x. Then the tangent of the turn is e/f, with e = (N × c)·W and f
/// = (N·c)·W − N·N. Both vanish at x and at y, so they are divided by t and by 1 − t there. The quotient is stationary
/// where e′f − ef′ = 0.
pub(super) fn lens_angle(curve: &(impl Kind + ?Sized), t0: f64, t1: f64) -> f64 {
    let (x, y) = (curve.point(t0), curve.point(t1));
    let chord = y - x;
    if chord == Vec2::ZERO {
        return std::f64::consts::PI;
    }
    let pieces = curve.spans(t0, t1);
    let last = pieces.len() - 1;
    // At x and at y the limit of the turn is the angle between tangent and chord.
    let at_x = turn_from(curve.tangent(t0, End::Start), chord).abs();
    let mut largest = turn_from(chord, curve.tangent(t1, End::Finish)).abs().max(at_x);
    for (k, span) in pieces.iter().enumerate() {
        let (e, f) = lens_quotient(&span.about(x), chord, k == 0, k == last);
        let (de, df) = (bernstein::derivative(&e), bernstein::derivative(&f));
        let left = bernstein::product(&de, &f, |a, b| a * b);
        let right = bernstein::product(&e, &df, |a, b| a * b);
        let slope: Vec<f64> = left.iter().zip(&right).map(|(a, b)| a - b).collect();
        let noise = product_noise(bernstein::largest(&e), bernstein::largest(&f), slope.len() * e.len());
        let stationary = bernstein::roots(&slope, noise);
        let on_chord = bernstein::roots(&e, 0.0);
        let inner_knot = (k < last).then_some(1.0);
        for s in stationary.into_iter().chain(on_chord).chain(inner_knot) {
            largest = largest.max(libm::atan2(bernstein::value(&e, s).abs(), bernstein::value(&f, s)));
        }
    }
    largest
}

/// The polynomials e and f of [`lens_angle`] over a span, which may begin at x or end at y.
fn lens_quotient(polygon: &Polygon, chord: Vec2, at_start: bool, at_end: bool) -> (Vec<f64>, Vec<f64>) {
    let numerators = polygon.numerators();
    let ones = vec![1.0; numerators.len()];
    let weights = polygon.weights().unwrap_or(ones);
    let across: Vec<f64> = numerators.iter().map(|v| v.cross(chord)).collect();
    let along: Vec<f64> = numerators.iter().map(|v| v.dot(chord)).collect();
    let times = |a: f64, b: f64| a * b;
    let mut e = bernstein::product(&across, &weights, times);
    let square = bernstein::product(&numerators, &numerators, |a, b| a.dot(b));
    let mut f: Vec<f64> = bernstein::product(&along, &weights, times).iter().zip(&square).map(|(a, s)| a - s).collect();
    if at_start {
        (e, f) = (bernstein::over_t(&e), bernstein::over_t(&f));
    }
    if at_end {
        (e, f) = (bernstein::over_one_minus_t(&e), bernstein::over_one_minus_t(&f));
    }
    (e, f)
}
