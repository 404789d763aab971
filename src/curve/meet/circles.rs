//! First guesses in closed form, for two circular arcs or a line and an arc.

use super::Guess;
use super::contact::Contacts;
use super::hull::length;
use crate::curve::{CircularArc, Curve, Line};
use crate::geometry::{Point, Vec2};
use std::f64::consts::TAU;

/// Pairs of parameters, at least one in every contact of two circular arcs or of a line and an arc. `None` for other
/// kinds, and where a circle is so large or so far away that the rounding of the closed form exceeds the tolerance,
/// unless the circles are certainly apart.
///
/// Every contact contains a crossing, a place where the circles are nearest (on the line of centers), or an end.
///
/// ```text
///                ● crossing
///    ○──────· p ─┼─○───· q      ● the crossings of the circles p and q, at the ends of their common chord; ○ the
///                │              points of p on the line of centers, where the circles are nearest.
///                ● crossing
/// ```
pub(super) fn guesses(contacts: &Contacts) -> Option<Vec<Guess>> {
    let (a, b) = (contacts.a.curve, contacts.b.curve);
    let places = match (a.as_arc(), b.as_arc()) {
        (Some(p), Some(q)) => circle_with_circle(p, q),
        (None, Some(q)) => line_with_circle(a.as_line()?, q),
        (Some(p), None) => line_with_circle(b.as_line()?, p),
        (None, None) => return None,
    };
    // A few units of rounding for each of about ten operations.
    let rounding = 64.0 * f64::EPSILON * reach_of(a).max(reach_of(b));
    if rounding > contacts.tolerance {
        let (p, q) = (a.as_arc()?, b.as_arc()?);
        return are_clear(p, q, contacts.tolerance, rounding).then(Vec::new);
    }
    let mut guesses = Vec::new();
    for place in places {
        for t in beside(a, place) {
            guesses.extend(beside(b, place).into_iter().map(|u| polished(contacts, t, u)));
        }
    }
    for e in [0.0, 1.0] {
        guesses.extend(beside(b, a.point(e)).into_iter().map(|u| Guess::at(e, u)));
        guesses.extend(beside(a, b.point(e)).into_iter().map(|t| Guess::at(t, e)));
    }
    guesses.retain(|g| length(a.point(g.t) - b.point(g.u)) <= contacts.tolerance);
    Some(guesses)
}

/// Whether one circle lies outside of the other, or within it, by more than the tolerance, with allowance for rounding.
fn are_clear(p: &CircularArc, q: &CircularArc, tolerance: f64, rounding: f64) -> bool {
    let distance = length(q.center - p.center);
    let gap = (distance - p.radius - q.radius).max((p.radius - q.radius).abs() - distance);
    // The ends of both may lie off their circles by twice the rounding.
    !p.is_spiral() && !q.is_spiral() && gap > tolerance + 8.0 * rounding
}

/// The largest length from which points of the curve are computed.
fn reach_of(curve: &Curve) -> f64 {
    curve.as_arc().map_or(0.0, |arc| arc.center.x.abs().max(arc.center.y.abs()) + arc.radius)
}

/// A guess near a crossing, refined to the crossing by Newton's method.
fn polished(contacts: &Contacts, t: f64, u: f64) -> Guess {
    let (a, b) = (contacts.a.curve, contacts.b.curve);
    let sine = |t: f64, u: f64| {
        let (da, db) = (a.derivative(t), b.derivative(u));
        (da.cross(db) / (length(da) * length(db))).abs()
    };
    // Below a thousandth Newton's method may run along the curves. Following the contact finds the place as well.
    if sine(t, u) < 1.0 / 1024.0 {
        return Guess::at(t, u);
    }
    let ([t, u], converged) = contacts.root(t, u, [[0.0, 1.0]; 2]);
    if !converged {
        return Guess::at(t, u);
    }
    let (sine, place) = (sine(t, u), a.point(t));
    let reach = 2.0 * contacts.tolerance / sine;
    // Over that length the angle between the curves changes by less than a quarter.
    let bends_little = 4.0 * reach * (a.curvature(t).abs() + b.curvature(u).abs()) <= sine;
    let ends = [a.start(), a.end(), b.start(), b.end()];
    let is_clear = bends_little && ends.iter().all(|&end| length(end - place) > reach);
    Guess { t, u, root: true, clear: if is_clear { reach } else { 0.0 } }
}

/// The parameters of a line or an arc beside a place: of the nearest point of line or circle, or of both ends where the
/// arc does not extend there.
fn beside(curve: &Curve, place: Point) -> Vec<f64> {
    match curve.as_arc() {
        Some(arc) => {
            let from_center = place - arc.center;
            let angle = libm::atan2(from_center.y, from_center.x);
            let travelled = (angle - arc.start_rad) * arc.sweep_rad.signum();
            let t = (travelled - TAU * libm::floor(travelled / TAU)) / arc.sweep_rad.abs();
            if t < 1.0 { vec![t] } else { vec![0.0, 1.0] }
        }
        None => {
            let (start, along) = (curve.start(), curve.end() - curve.start());
            let t = (place - start).dot(along) / along.hypot2();
            // A line of no length: any parameter.
            vec![if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) }]
        }
    }
}

/// The places where the circles meet, and where they are nearest.
fn circle_with_circle(p: &CircularArc, q: &CircularArc) -> Vec<Point> {
    let apart = q.center - p.center;
    let distance = length(apart);
    if distance == 0.0 {
        return Vec::new();
    }
    let toward = apart / distance;
    // The distance from p's center at which the common chord crosses the line of centers: (d² + r² − s²)/2d.
    let along = 0.5 * (distance + (p.radius - q.radius) * (p.radius + q.radius) / distance);
    let mut places = vec![p.center + toward * p.radius, p.center - toward * p.radius];
    places.extend(on_chord(p.center + toward * along, toward, (p.radius - along) * (p.radius + along)));
    places
}

/// The places where the line meets the circle, and where they are nearest.
fn line_with_circle(line: &Line, arc: &CircularArc) -> Vec<Point> {
    let along = line.end - line.start;
    if along == Vec2::ZERO {
        return Vec::new();
    }
    let unit = along / length(along);
    let normal = Vec2::new(-unit.y, unit.x);
    let away = normal.dot(line.start - arc.center);
    let middle = arc.center + normal * away;
    let mut places = vec![middle];
    places.extend(on_chord(middle, normal, (arc.radius - away) * (arc.radius + away)));
    places
}

/// The ends of a chord with the middle `middle`, perpendicular to the unit vector `normal`; half its length is
/// √`half2`.
fn on_chord(middle: Point, normal: Vec2, half2: f64) -> Vec<Point> {
    if half2 <= 0.0 {
        return Vec::new();
    }
    let half = Vec2::new(-normal.y, normal.x) * half2.sqrt();
    vec![middle + half, middle - half]
}
