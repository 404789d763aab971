//! The curves of one element: a spline through its contour, cut at the nose, and its trailing edge.

use super::TrailingEdge;
use super::contour::Contour;
use super::crossing::first_crossing;
use super::trailing_edge::{trailing_edge, truncation};
use crate::curve::{Bezier, Curve, CurveError, Spline};
use crate::geometry::{Point, Vec2};
use crate::import::ImportError;
use crate::import::airfoil::HELP;

/// The curves of one element.
pub struct Section {
    /// The upper surface, from the trailing edge to the nose.
    pub upper: Curve,
    /// The lower surface, from the nose to the trailing edge.
    pub lower: Curve,
    /// The trailing edge, from the lower surface to the upper one; empty where it is sharp.
    pub te: Vec<Curve>,
    /// The nose.
    pub nose: Point,
    /// The middle of the trailing edge.
    pub tail: Point,
    /// The chord of the contour, before its trailing edge is cut off.
    pub chord: f64,
    /// The first and the last line in the file.
    pub lines: [usize; 2],
}

impl Section {
    /// The curves of a contour, with the trailing edge asked for; adds to `notes` what was done.
    ///
    /// # Errors
    ///
    /// Where curves would cross, or where the trailing edge cannot be cut off.
    pub fn build(contour: &Contour, edge: TrailingEdge, notes: &mut Vec<String>) -> Result<Self, ImportError> {
        let failed = |e: CurveError| ImportError::at(contour.lines[0], e.to_string(), HELP);
        let whole = interpolate(contour, notes)?;
        let at_nose = parameter_of_point(&whole, contour.nose, contour.points.len());
        let cut_off = contour.is_sharp() && matches!(edge, TrailingEdge::Blunt | TrailingEdge::Round);
        let (from, to) = if cut_off { truncation(contour, &whole, at_nose)? } else { (0.0, 1.0) };
        if cut_off {
            notes.push("The sharp trailing edge was cut off at 99 % chord.".into());
        }
        let (upper, lower) = (whole.part(from, at_nose), whole.part(at_nose, to));
        let (first, last) = (upper.start(), lower.end());
        let te = trailing_edge(first, last, contour, edge).map_err(failed)?;
        let (tail, nose) = (first.midpoint(last), contour.nose_point());
        Ok(Self { upper, lower, te, nose, tail, chord: contour.chord(), lines: contour.lines })
    }
}

/// The parameter of data point `i` of `n`; the splines have a knot at every point.
fn parameter_of_point(whole: &Curve, i: usize, n: usize) -> f64 {
    let knots = whole.knots();
    if knots.len() == n { knots[i] } else { i as f64 / (n - 1) as f64 }
}

/// One curve through all points: the smoothest of three kinds that does not cross itself.
fn interpolate(contour: &Contour, notes: &mut Vec<String>) -> Result<Curve, ImportError> {
    let crossing = |curve: &Curve| first_crossing(&outline(curve, &contour.base)).map(|(at, _)| at);
    let spline =
        Curve::natural_spline(&contour.points).map_err(|e| ImportError::at(contour.lines[0], e.to_string(), HELP))?;
    let Some(at) = crossing(&spline) else { return Ok(spline) };
    let place = format!("near ({:.4}, {:.4})", at.x, at.y);
    let tame = monotone_cubic(&contour.points);
    if crossing(&tame).is_none() {
        notes.push(format!(
            "A C2 spline would cross itself {place}; a monotone C1 cubic goes through the points instead."
        ));
        return Ok(tame);
    }
    let straight = piecewise_linear(&contour.points);
    if let Some(at) = crossing(&straight) {
        // The contour as read does not cross itself, so the shearing caused this.
        let what = format!("the surfaces cross at ({}, {}) where the trailing edge is sheared to a point", at.x, at.y);
        return Err(ImportError::at(contour.lines[0], what, "keep it: --trailing-edge keep"));
    }
    notes.push(format!("Smooth surfaces would cross {place}; straight lines join the points instead."));
    Ok(straight)
}

/// Centripetal knots over 0..1: steps proportional to the square root of the distance.
fn centripetal_knots(points: &[Point]) -> Vec<f64> {
    let mut knots = vec![0.0];
    let mut sum = 0.0;
    for w in points.windows(2) {
        sum += (w[1] - w[0]).hypot().sqrt();
        knots.push(sum);
    }
    knots.iter_mut().for_each(|k| *k /= sum);
    knots
}

fn piecewise_linear(points: &[Point]) -> Curve {
    let spans = points.windows(2).map(|w| Bezier { points: w.to_vec(), weights: None }).collect();
    Curve::Spline(Box::new(Spline { knots: centripetal_knots(points), spans }))
}

/// The C¹ cubic through the points whose coordinates are monotone wherever those of the points are (Fritsch & Butland
/// 1984, weights by Brodlie).
fn monotone_cubic(points: &[Point]) -> Curve {
    let knots = centripetal_knots(points);
    let step = |i: usize| knots[i + 1] - knots[i];
    let slope = |i: usize| (points[i + 1] - points[i]) / step(i);
    let n = points.len();
    let tangent = |i: usize| match i {
        0 => slope(0),
        i if i == n - 1 => slope(n - 2),
        i => {
            let (before, after) = (slope(i - 1), slope(i));
            let (h, k) = (step(i - 1), step(i));
            let mean = |a: f64, b: f64| match a * b > 0.0 {
                true => 3.0 * (h + k) / ((h + 2.0 * k) / b + (2.0 * h + k) / a),
                false => 0.0,
            };
            Vec2::new(mean(before.x, after.x), mean(before.y, after.y))
        }
    };
    let span = |i: usize| {
        let (a, b, third) = (points[i], points[i + 1], step(i) / 3.0);
        Bezier { points: vec![a, a + third * tangent(i), b - third * tangent(i + 1), b], weights: None }
    };
    let spans = (0..n - 1).map(span).collect();
    Curve::Spline(Box::new(Spline { knots, spans }))
}

/// The contour as a ring of points, eight a span. That is enough to detect crossings of cubics through points that do
/// not cross themselves.
fn outline(spline: &Curve, base: &[Point]) -> Vec<Point> {
    const CHORDS: usize = 8;
    let mut ring = Vec::new();
    for w in spline.knots().windows(2) {
        let at = |k: usize| w[0] + (w[1] - w[0]) * k as f64 / CHORDS as f64;
        ring.extend((0..CHORDS).map(|k| spline.point(at(k))));
    }
    ring.push(spline.end());
    ring.extend(base);
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}

/// A point inside the section: midway between the surfaces on a line across the chord, first tried at mid-chord.
///
/// ```text
///          ╭────●─── above ──╮
///     nose ●    ·  inside     ╲── tail
///          ╰────●─── below ──╯
/// ```
pub fn inside(section: &Section) -> Option<Point> {
    let chord = section.tail - section.nose;
    let across = Vec2::new(-chord.y, chord.x);
    [0.5, 0.4, 0.3, 0.25, 0.2, 0.6, 0.1, 0.05].into_iter().find_map(|part| {
        let at = section.nose + part * chord;
        let meet = |c: &Curve| c.line_crossings(at, across, 0.0, 1.0).iter().map(|&t| c.point(t)).collect::<Vec<_>>();
        match (&meet(&section.upper)[..], &meet(&section.lower)[..]) {
            (&[above], &[below]) if above != below => Some(above.midpoint(below)),
            _ => None,
        }
    })
}
