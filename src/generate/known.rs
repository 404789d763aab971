//! Drawings that are hard to arrange, with their area known by formula.

use super::Rng;
use crate::curve::{Curve, CurveError};
use crate::domain::{Drawing, FillRule};
use crate::geometry::{Point, Vec2, direction, magnitude};
use kurbo::Affine;
use std::f64::consts::{PI, TAU};

/// A drawing with the known area of its regions.
#[derive(Clone, Debug)]
pub struct Known {
    /// The curves, with the fill rule for which the area holds.
    pub drawing: Drawing,
    /// The area of all regions, in squared units of the drawing.
    pub area: f64,
    /// The length of the border of all regions, counted once: an error of the coordinates changes the area in
    /// proportion to it.
    pub perimeter: f64,
}

impl Known {
    fn new(fill: FillRule, area: f64, perimeter: f64) -> Self {
        let drawing = Drawing { format: "generated".into(), fill, ..Drawing::default() };
        Self { drawing, area, perimeter }
    }

    fn add(&mut self, curve: Result<Curve, CurveError>) {
        let entity = format!("curve {}", self.drawing.curves.len());
        self.drawing.add(curve.expect("a generated curve is sound"), "wall", entity);
    }

    fn add_polygon(&mut self, corners: &[Point]) {
        for (i, &corner) in corners.iter().enumerate() {
            self.add(Curve::line(corner, corners[(i + 1) % corners.len()]));
        }
    }

    /// Every length times a factor.
    pub fn scaled(mut self, factor: f64) -> Self {
        let scale =
            |c: &Curve| if is_power_of_two(factor) { c.scaled(factor) } else { c.transformed(Affine::scale(factor)) };
        self.drawing.curves.iter_mut().for_each(|c| c.curve = scale(&c.curve));
        Self { area: self.area * factor * factor, perimeter: self.perimeter * factor, ..self }
    }

    /// The drawing moved by a vector; its coordinates are rounded there.
    pub fn moved(mut self, by: Vec2) -> Self {
        self.drawing.curves.iter_mut().for_each(|c| c.curve = c.curve.transformed(Affine::translate(by)));
        self
    }

    /// The relative error that a correct area may have: 1e-9, or the effect of four units in the last place of the
    /// coordinates along the border.
    pub fn slack(&self) -> f64 {
        let largest = self.drawing.bounds().map_or(0.0, magnitude);
        (4.0 * f64::EPSILON * largest * self.perimeter / self.area).max(1e-9)
    }
}

fn is_power_of_two(factor: f64) -> bool {
    libm::frexp(factor).0 == 0.5
}

/// The union of `n` circles that cross each other at random.
pub fn crossing_circles(seed: u64, n: usize) -> Known {
    let mut rng = Rng::new(seed);
    let side = 1.2 * (n as f64).sqrt();
    let circles: Vec<(Point, f64)> =
        (0..n).map(|_| (Point::new(rng.between(0.0, side), rng.between(0.0, side)), rng.between(0.3, 1.2))).collect();
    let (area, perimeter) = union_of(&circles);
    let mut known = Known::new(FillRule::NonZero, area, perimeter);
    circles.iter().for_each(|&(center, radius)| known.add(Curve::circle(center, radius)));
    known
}

/// The area and the border length of a union of circles, by Green's theorem along the arcs that no other circle covers.
fn union_of(circles: &[(Point, f64)]) -> (f64, f64) {
    let (mut area, mut border) = (0.0, 0.0);
    for (i, &(center, radius)) in circles.iter().enumerate() {
        let others = circles.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, other)| other);
        let Some(covered) = others.map(|&other| covered_by((center, radius), other)).collect::<Option<Vec<_>>>() else {
            continue;
        };
        let mut covered: Vec<(f64, f64)> = covered.into_iter().flatten().collect();
        covered.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut from = 0.0;
        for (start, end) in covered.into_iter().chain([(TAU, TAU)]) {
            if start > from {
                let turned = direction(start) - direction(from);
                area += 0.5 * radius * (radius * (start - from) + center.x * turned.y - center.y * turned.x);
                border += radius * (start - from);
            }
            from = end.max(from);
        }
    }
    (area, border)
}

/// The angles of a circle's points that lie in another circle, as ranges of 0..2π; `None` if all of them do.
fn covered_by((center, radius): (Point, f64), (other, reach): (Point, f64)) -> Option<Vec<(f64, f64)>> {
    let away = other - center;
    let distance = libm::hypot(away.x, away.y);
    if distance >= radius + reach || distance + reach <= radius {
        return Some(Vec::new());
    }
    if distance + radius <= reach {
        return None;
    }
    let cosine = (distance * distance + radius * radius - reach * reach) / (2.0 * distance * radius);
    let (middle, half) = (libm::atan2(away.y, away.x), libm::acos(cosine));
    let start = (middle - half).rem_euclid(TAU);
    let end = start + 2.0 * half;
    Some(if end > TAU { vec![(start, TAU), (0.0, end - TAU)] } else { vec![(start, end)] })
}

/// Pairs of shapes that nearly touch or nearly coincide.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Near {
    /// Two circles that overlap in a lens as wide as the separation.
    Lens,
    /// Two circles apart by the separation.
    Gap,
    /// A circle within another, at a distance of the separation.
    Inside,
    /// Concentric circles whose radii differ by the separation.
    Concentric,
    /// Two squares that overlap by the separation along most of a side.
    Squares,
    /// A half disk whose arc a second arc repeats, with a bulge that differs by the separation.
    Arcs,
}

impl Near {
    /// Every kind, in the order of the enum.
    pub const ALL: [Self; 6] = [Self::Lens, Self::Gap, Self::Inside, Self::Concentric, Self::Squares, Self::Arcs];
}

/// Two shapes with the given `separation`, rotated by `turn_rad`. A negative separation turns a gap into an overlap and
/// vice versa. Every bounded face is a region.
pub fn nearly(near: Near, separation: f64, turn_rad: f64) -> Known {
    let at = |x: f64, y: f64| Point::ORIGIN + direction(turn_rad) * x + direction(turn_rad + 0.5 * PI) * y;
    let circles = |circles: [(f64, f64); 2]| {
        let circles = circles.map(|(x, radius)| (at(x, 0.0), radius));
        let (area, _) = union_of(&circles);
        let mut known = Known::new(FillRule::Regions, area, TAU * (circles[0].1 + circles[1].1));
        circles.iter().for_each(|&(center, radius)| known.add(Curve::arc(center, radius, turn_rad + 1.0, TAU)));
        known
    };
    match near {
        Near::Lens => circles([(-1.0, 1.0), (1.0 - separation, 1.0)]),
        Near::Gap => circles([(-1.0, 1.0), (1.0 + separation, 1.0)]),
        Near::Inside => circles([(0.0, 1.0), (0.5 - separation, 0.5)]),
        Near::Concentric => circles([(0.0, 1.0), (0.0, 1.0 + separation)]),
        Near::Squares => {
            let mut known = Known::new(FillRule::Regions, 2.0 + separation - 0.75 * separation.max(0.0), 8.0);
            known.add_polygon(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]);
            let left = 1.0 - separation;
            known.add_polygon(&[at(left, 0.25), at(2.0, 0.25), at(2.0, 1.25), at(left, 1.25)]);
            known
        }
        Near::Arcs => {
            // A segment of half angle a over a chord of 2: (a − sin a cos a) / sin² a, and tan(a/2) is the bulge.
            let half = 2.0 * libm::atan(1.0 + separation.max(0.0));
            let (sin, cos) = (libm::sin(half), libm::cos(half));
            let mut known = Known::new(FillRule::Regions, (half - sin * cos) / (sin * sin), 2.0 + 2.0 * PI);
            let [a, b] = [at(-1.0, 0.0), at(1.0, 0.0)];
            known.add(Curve::line(a, b));
            known.add(Curve::bulge(b, a, 1.0));
            known.add(Curve::bulge(b, a, 1.0 + separation));
            known
        }
    }
}

/// A square plate with n × n round holes of random sizes.
pub fn plate_with_holes(seed: u64, n: usize) -> Known {
    let mut rng = Rng::new(seed);
    let side = n as f64;
    let mut known = Known::new(FillRule::EvenOdd, side * side, 4.0 * side);
    known.add_polygon(&[(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(x, y)| Point::new(x, y)));
    for i in 0..n * n {
        let radius = rng.between(0.05, 0.3);
        let at = |k: usize, rng: &mut Rng| k as f64 + 0.5 + rng.between(-0.1, 0.1);
        let center = Point::new(at(i % n, &mut rng), at(i / n, &mut rng));
        known.add(Curve::circle(center, radius));
        known.area -= PI * radius * radius;
        known.perimeter += TAU * radius;
    }
    known
}

/// `n` concentric circles, filled alternately.
pub fn rings(seed: u64, n: usize) -> Known {
    let mut rng = Rng::new(seed);
    let center = Point::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0));
    let mut known = Known::new(FillRule::EvenOdd, 0.0, 0.0);
    let mut radius = 0.0;
    for k in 0..n {
        radius += rng.between(0.2, 1.0);
        known.add(Curve::arc(center, radius, rng.between(0.0, TAU), TAU));
        // The outermost ring is filled.
        let sign = if (n - k) % 2 == 1 { 1.0 } else { -1.0 };
        known.area += sign * PI * radius * radius;
        known.perimeter += TAU * radius;
    }
    known
}

/// A band of width `width` (below 2) along a spiral of `n` half circles, whose radii grow by 1.
pub fn spiral(n: usize, width: f64) -> Known {
    let mut known = Known::new(FillRule::EvenOdd, 0.0, 2.0 * width);
    let end = |k: usize, out: f64| {
        // After an even number of half circles on the right, after an odd number on the left.
        let reach = 1.0 + k as f64 + out;
        Point::new(if k.is_multiple_of(2) { reach } else { 1.0 - reach }, 0.0)
    };
    for out in [0.0, width] {
        // Half circle k runs around (0, 0) above, or around (1, 0) below, with the radius k + 1.
        (0..n).for_each(|k| known.add(Curve::bulge(end(k, out), end(k + 1, out), 1.0)));
    }
    known.add(Curve::line(end(0, 0.0), end(0, width)));
    known.add(Curve::line(end(n, 0.0), end(n, width)));
    for k in 0..n {
        let radius = 0.5 * end(k, 0.0).distance(end(k + 1, 0.0));
        known.area += 0.5 * PI * width * (2.0 * radius + width);
        known.perimeter += PI * (2.0 * radius + width);
    }
    known
}

/// A symmetric section of `n` straight lines (NACA 0012 with a closed trailing edge). Its area is computed by the
/// shoelace formula.
pub fn section(n: usize) -> Known {
    let corner = |i: usize| {
        let angle = TAU * i as f64 / n as f64;
        let x = 0.5 * (1.0 + libm::cos(angle));
        let half = 0.6 * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
        Point::new(x, if 2 * i < n { half } else { -half })
    };
    let mut corners: Vec<Point> = (0..n).map(corner).collect();
    corners[0] = Point::new(1.0, 0.0);
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    let area = sum(sides().map(|(a, b)| 0.5 * a.to_vec2().cross(b.to_vec2())));
    let mut known = Known::new(FillRule::EvenOdd, area, sides().map(|(a, b)| a.distance(*b)).sum());
    known.add_polygon(&corners);
    known
}

/// A compensated sum (Neumaier 1974).
fn sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0f64, 0.0);
    for term in terms {
        let total = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - total) + term } else { (term - total) + sum };
        sum = total;
    }
    sum + lost
}
