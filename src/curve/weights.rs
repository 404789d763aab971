//! Very unequal weights: the same curve in spans over which its parameter is nearly proportional to length.
//!
//! Weights w·cⁱ give the same curve with another parameter, t ↦ ct/(1 − t + ct) (Farin, *Curves and Surfaces for CAGD*,
//! 13.5). So a weight of 1e12 maps half of a curve to a range of the parameter of length 1e-12, in which `f64` has 1e4
//! values near 1. A large weight in the middle bends the curve within an equally short range. When a conic is halved
//! and reparametrised, its middle weight w becomes √((1 + w)/2): a few halvings suffice.

use super::{Bezier, Curve, Spline, length};
use crate::geometry::magnitude;

/// The largest ratio of weights that is accepted: it costs a few digits of the parameter. Conics of less than 179° are
/// within it.
const EVEN: f64 = 64.0;
/// The largest number of halvings: weights of 1e300 take nine.
const DEPTH: u32 = 10;

/// The rational curve; as a spline of several spans where its weights are too far apart.
pub(super) fn evened(bezier: Bezier) -> Curve {
    let mut spans = even_spans(bezier);
    if spans.len() == 1
        && let Some(only) = spans.pop()
    {
        return Curve::Bezier(Box::new(only));
    }
    let knots = (0..=spans.len()).map(|k| k as f64 / spans.len() as f64).collect();
    Curve::Spline(Box::new(Spline { knots, spans }))
}

/// The spans over which the weights of a curve are not far apart, in order: usually the curve itself.
pub(super) fn even_spans(bezier: Bezier) -> Vec<Bezier> {
    let mut spans = Vec::new();
    even_pieces(bezier, DEPTH, &mut spans);
    spans
}

fn even_pieces(bezier: Bezier, depth: u32, pieces: &mut Vec<Bezier>) {
    if is_even(&bezier) {
        return pieces.push(bezier);
    }
    let bezier = at_even_pace(bezier);
    if depth == 0 || is_even(&bezier) || is_point(&bezier) {
        return pieces.push(bezier);
    }
    let middle = bezier.at(0.5);
    let [first, last] = [bezier.points[0], bezier.points[bezier.degree()]];
    even_pieces(bezier.cut_out(0.0, 0.5, [first, middle]), depth - 1, pieces);
    even_pieces(bezier.cut_out(0.5, 1.0, [middle, last]), depth - 1, pieces);
}

fn is_even(bezier: &Bezier) -> bool {
    let Some(weights) = &bezier.weights else { return true };
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    let most = weights.iter().copied().fold(0.0, f64::max);
    most <= EVEN * least
}

/// Whether the curve is no larger than rounding.
fn is_point(bezier: &Bezier) -> bool {
    let first = bezier.points[0];
    let reach = bezier.points.iter().map(|p| length(*p - first)).fold(0.0, f64::max);
    let bounds = crate::geometry::bounds_of(bezier.points.iter().copied());
    reach <= 16.0 * f64::EPSILON * bounds.map_or(0.0, magnitude)
}

/// The same curve, reparametrised so that its first and last weights are (nearly) equal.
fn at_even_pace(mut bezier: Bezier) -> Bezier {
    let degree = bezier.degree();
    let Some(weights) = &mut bezier.weights else { return bezier };
    let pace = (libm::log2(weights[0]) - libm::log2(weights[degree])) / degree as f64;
    // A power of two changes no bit of the curve; at a low degree the nearest one is good enough.
    let pace = if degree <= 12 { pace.round() } else { pace };
    // By logarithms, since the factors alone may overflow.
    let logs: Vec<f64> = weights.iter().enumerate().map(|(i, w)| libm::log2(*w) + pace * i as f64).collect();
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max).round();
    for (i, w) in weights.iter_mut().enumerate() {
        let shift = pace * i as f64 - most;
        let whole = libm::floor(shift);
        *w = libm::ldexp(*w * libm::exp2(shift - whole), whole as i32);
    }
    bezier
}
