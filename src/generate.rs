//! Hard inputs from a seed: complexes of curves that meet at all angles down to zero.
//!
//! A complex is a grid of cells in a frame. Each cell holds one *motif* of random size and rotation, so nothing crosses
//! by accident. Curves that share a tangent at a point differ there in curvature by at least 0.1 / radius. With a
//! smaller difference, the separation σ of the pair would take more vertices than a test can hold.

pub mod known;

use crate::curve::Curve;
use crate::domain::{Drawing, FillRule};
pub use crate::geometry::rng::Rng;
use crate::geometry::{Point, Vec2};
use std::f64::consts::{PI, TAU};

/// A rotated frame in a cell; its unit is the cell's usable radius.
struct Place {
    center: Point,
    radius: f64,
    turn: f64,
}

impl Place {
    /// The point at (x, y) of the frame.
    fn at(&self, x: f64, y: f64) -> Point {
        let (s, c) = (libm::sin(self.turn), libm::cos(self.turn));
        self.center + Vec2::new(c * x - s * y, s * x + c * y) * self.radius
    }
}

/// A complex of curves with angles down to zero in a frame; the same seed gives the same drawing.
pub fn curved_complex(seed: u64) -> Drawing {
    let mut rng = Rng::new(seed);
    let cells = 1 + rng.below(3);
    let mut drawing = Drawing { format: "generated".into(), fill: FillRule::Regions, ..Drawing::default() };
    let size = cells as f64 * 2.2;
    frame(&mut drawing, &mut rng, size);
    for i in 0..cells {
        for j in 0..cells {
            let center = Point::new(2.2 * (i as f64 + 0.5), 2.2 * (j as f64 + 0.5));
            let place = Place { center, radius: rng.between(0.5, 1.0), turn: rng.between(0.0, TAU) };
            motif(&mut drawing, &mut rng, &place);
        }
    }
    drawing
}

/// A square of side `size`; some of its sides may bulge.
fn frame(drawing: &mut Drawing, rng: &mut Rng, size: f64) {
    let corners = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)].map(|(x, y)| Point::new(x, y));
    for i in 0..4 {
        let bulge = if rng.below(3) == 0 { rng.between(0.05, 0.6) } else { 0.0 };
        add(drawing, Curve::bulge(corners[i], corners[(i + 1) % 4], bulge), "frame");
    }
}

fn add<E: std::fmt::Debug>(drawing: &mut Drawing, curve: Result<Curve, E>, name: &str) {
    let entity = format!("curve {}", drawing.curves.len());
    drawing.add(curve.expect("a generated curve is sound"), name, entity);
}

fn motif(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    match rng.below(9) {
        0 => tangent_circles(drawing, rng, place),
        1 => tangent_fan(drawing, rng, place),
        2 => lens(drawing, rng, place),
        3 => tangent_cubics(drawing, rng, place),
        4 => blob(drawing, rng, place),
        5 => wedge(drawing, rng, place),
        6 => ellipse_and_chord(drawing, rng, place),
        7 => half_disk(drawing, rng, place),
        _ => spline_and_point(drawing, rng, place),
    }
}

/// Two circles that touch, one inside the other or side by side.
fn tangent_circles(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let inner = rng.below(2) == 0;
    let (r, s) = if inner { (0.9, rng.between(0.2, 0.8)) } else { (0.45, rng.between(0.15, 0.45)) };
    let first = if inner { 0.0 } else { -0.45 };
    let second = if inner { r - s } else { s };
    let touch = place.at(first + r, 0.0);
    for (center, radius) in [(first, r), (second, s)] {
        let arc = circle_from(place, center, radius, if inner || center == first { 0.0 } else { PI });
        add(drawing, arc.map(|c| c.with_ends(touch, touch)), "circle");
    }
}

/// A circle with its center on the frame's x axis, which starts at the angle `start` of the frame.
fn circle_from(place: &Place, x: f64, radius: f64, start: f64) -> Result<Curve, crate::curve::CurveError> {
    Curve::arc(place.at(x, 0.0), radius * place.radius, place.turn + start, TAU)
}

/// Arcs that leave one point along one tangent with different curvatures.
fn tangent_fan(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let k = 2 + rng.below(4);
    let root = place.at(-0.8, 0.0);
    for i in 0..k {
        let curvature = (i as f64 - (k - 1) as f64 / 2.0) * 0.45 + rng.between(-0.15, 0.15);
        let length = rng.between(0.8, 1.4);
        // The end of the arc with this curvature and length that leaves the root along the frame's x axis.
        let half = curvature * length / 2.0;
        let chord = if half.abs() < 1e-9 { length } else { length * libm::sin(half) / half };
        let end = place.at(-0.8 + chord * libm::cos(half), chord * libm::sin(half));
        add(drawing, Curve::bulge(root, end, libm::tan(half / 2.0)), "fan");
    }
}

/// Two arcs with both ends in common, at a small or zero angle.
fn lens(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let (a, b) = (place.at(-0.8, 0.0), place.at(0.8, 0.0));
    let low = rng.between(0.0, 0.3);
    let high = low + rng.between(0.02, 0.3);
    add(drawing, Curve::bulge(a, b, low), "lens");
    add(drawing, Curve::bulge(a, b, high), "lens");
}

/// Cubics tangent to a line at one point: y = c·x² there.
fn tangent_cubics(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let root = place.at(-0.7, 0.0);
    add(drawing, Curve::line(root, place.at(0.7, 0.0)), "cubic");
    for sign in [-1.0, 1.0] {
        let lift = sign * rng.between(0.2, 0.6);
        let points = vec![root, place.at(-0.3, 0.0), place.at(0.2, 0.5 * lift), place.at(0.6, lift)];
        add(drawing, Curve::bezier(points), "cubic");
    }
}

/// A closed spline through points around a circle.
fn blob(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let n = 5 + rng.below(8);
    let points: Vec<Point> = (0..n)
        .map(|i| {
            let (angle, r) = (TAU * i as f64 / n as f64, rng.between(0.5, 0.9));
            place.at(r * libm::cos(angle), r * libm::sin(angle))
        })
        .collect();
    add(drawing, Curve::periodic_spline(&points), "blob");
}

/// Straight segments at a small angle, and an arc across their ends.
fn wedge(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let angle = rng.between(0.02, 0.6);
    let (apex, end) = (place.at(-0.8, 0.0), place.at(0.7, 0.0));
    let other = place.at(-0.8 + 1.5 * libm::cos(angle), 1.5 * libm::sin(angle) * 0.6);
    add(drawing, Curve::line(apex, end), "wedge");
    add(drawing, Curve::line(apex, other), "wedge");
    if rng.below(2) == 0 {
        add(drawing, Curve::bulge(end, other, 0.2), "wedge");
    }
}

/// An ellipse and a line that touches it at its vertex.
fn ellipse_and_chord(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let (a, b) = (0.8, rng.between(0.25, 0.6));
    let (u, v) = (place.at(a, 0.0) - place.center, place.at(0.0, b) - place.center);
    let touch = place.at(0.0, b);
    let ellipse = Curve::ellipse(place.center, u, v, PI / 2.0, TAU);
    add(drawing, ellipse.map(|c| c.with_ends(touch, touch)), "ellipse");
    add(drawing, Curve::line(touch, place.at(0.6, b)), "ellipse");
}

/// A D: an arc and its chord.
fn half_disk(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let (a, b) = (place.at(-0.7, -0.3), place.at(0.7, -0.3));
    add(drawing, Curve::line(a, b), "half disk");
    add(drawing, Curve::bulge(b, a, rng.between(0.1, 0.9)), "half disk");
}

/// An open spline, and a point beside it.
fn spline_and_point(drawing: &mut Drawing, rng: &mut Rng, place: &Place) {
    let points: Vec<Point> = (0..5).map(|i| place.at(-0.8 + 0.4 * f64::from(i), rng.between(-0.3, 0.3))).collect();
    add(drawing, Curve::natural_spline(&points), "spline");
    let at = place.at(0.0, rng.between(0.5, 0.8));
    drawing.points.push(crate::domain::DrawnPoint { at, name: None, entity: "point".into() });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_the_same_drawing_and_another_seed_another() {
        let picture = |seed| format!("{:?}", curved_complex(seed));
        assert_eq!(picture(7), picture(7));
        assert_ne!(picture(7), picture(8));
    }
}
