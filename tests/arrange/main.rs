//! Drawings as people make them, arranged: what is kept, what is mended, what is refused.

mod auxiliary;
mod curves;
mod free_ends;
mod hubs;
mod laws;
mod lines;
mod names;
mod oracles;
mod painted;
mod tolerances;

use squinch::curve::Curve;
use squinch::domain::{
    ArrangeError, ArrangeOptions, Domain, Drawing, DrawnPoint, FillRule, Layer, Loose, OffPlane, RepairKind, Seed,
    SeedKind, Shape,
};
use squinch::geometry::{Point, Vec2};
use squinch::ids::{CurveId, Id};
use std::f64::consts::{PI, TAU};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(a: (f64, f64), b: (f64, f64)) -> Curve {
    Curve::line(p(a.0, a.1), p(b.0, b.1)).unwrap()
}

fn drawing(curves: impl IntoIterator<Item = Curve>) -> Drawing {
    let mut drawing = Drawing::default();
    for (i, curve) in curves.into_iter().enumerate() {
        drawing.add(curve, "wall", format!("curve {}", i + 1));
    }
    drawing
}

fn polygon(points: &[(f64, f64)]) -> Vec<Curve> {
    (0..points.len()).map(|i| line(points[i], points[(i + 1) % points.len()])).collect()
}

fn square(x: f64, y: f64, side: f64) -> Vec<Curve> {
    polygon(&[(x, y), (x + side, y), (x + side, y + side), (x, y + side)])
}

fn circle(x: f64, y: f64, r: f64) -> Curve {
    Curve::circle(p(x, y), r).unwrap()
}

/// The domain by a fill rule, after asking it for flaws.
fn filled(drawing: &Drawing, fill: FillRule) -> Domain {
    let domain = drawing.arrange(&ArrangeOptions { fill: Some(fill), ..Default::default() }).unwrap();
    assert_eq!(domain.flaws(), [""; 0]);
    domain
}

fn regions(drawing: &Drawing) -> Domain {
    filled(drawing, FillRule::Regions)
}

fn areas(domain: &Domain) -> Vec<f64> {
    domain.regions().iter().map(|r| r.area).collect()
}

fn close(found: &[f64], wanted: &[f64]) {
    assert_eq!(found.len(), wanted.len(), "{found:?} instead of {wanted:?}");
    for (f, w) in found.iter().zip(wanted) {
        assert!((f - w).abs() <= 1e-12 * w, "{found:?} instead of {wanted:?}");
    }
}

fn repairs(domain: &Domain, kind: RepairKind) -> usize {
    domain.repairs().iter().filter(|r| r.kind == kind).count()
}

fn seed(x: f64, y: f64, kind: SeedKind) -> Seed {
    Seed { at: p(x, y), kind, entity: format!("seed at {x} {y}") }
}

/// Closed outlines of every kind around (50, 50), `width` across where they are narrowest, with their areas.
fn outlines(width: f64) -> Vec<(&'static str, Vec<Curve>, f64)> {
    let (r, o) = (width / 2.0, 50.0);
    let around = |turn: f64, r: f64| p(o, o) + Vec2::from_angle(turn) * r;
    let spline =
        Curve::periodic_spline(&(0..8).map(|i| around(f64::from(i) * TAU / 8.0, r)).collect::<Vec<_>>()).unwrap();
    let ellipse = |start: f64| Curve::ellipse(p(o, o), Vec2::new(3.0 * r, 0.0), Vec2::new(0.0, r), start, TAU).unwrap();
    let tear = Curve::bezier(vec![p(o - r, o), p(o + 4.0 * r, o - 4.0 * r), p(o + 4.0 * r, o + 4.0 * r), p(o - r, o)])
        .unwrap();
    let (west, east) = (around(PI, r), around(0.0, r));
    let halves = [Curve::bulge(west, east, 1.0).unwrap(), Curve::bulge(east, west, 1.0).unwrap()];
    let (low, high) = (around(PI, width), around(0.0, width));
    let cap = vec![Curve::line(low, high).unwrap(), Curve::bulge(high, low, 1.0).unwrap()];
    let (spline_area, tear_area) = (spline.signed_area(p(o, o)), tear.signed_area(p(o, o)));
    vec![
        ("circle", vec![circle(o, o, r)], PI * r * r),
        ("ellipse", vec![ellipse(0.0)], 3.0 * PI * r * r),
        ("ellipse from its flat side", vec![ellipse(PI / 2.0)], 3.0 * PI * r * r),
        ("bezier", vec![tear], tear_area),
        ("spline", vec![spline], spline_area),
        ("arcs", halves.to_vec(), PI * r * r),
        ("arc and line", cap, PI * width * width / 2.0),
        ("square", square(o - r, o - r, width), width * width),
    ]
}

/// Points less curves plus faces, the unbounded one included, against one more than the connected parts.
fn euler(domain: &Domain) -> (usize, usize) {
    let mut root: Vec<usize> = (0..domain.points().len()).collect();
    let find = |root: &Vec<usize>, mut i: usize| {
        while root[i] != i {
            i = root[i];
        }
        i
    };
    let mut parts = domain.points().len();
    for curve in domain.curves().iter() {
        let [a, b] = curve.ends.map(|end| find(&root, end.index()));
        parts -= usize::from(a != b);
        root[a] = b;
    }
    (domain.points().len() + domain.regions().len() + 1, 1 + parts + domain.curves().len())
}

/// A drawing with something of everything, scaled and moved.
fn mixture(factor: f64, offset: f64) -> Drawing {
    let mut curves = square(-4.0, -4.0, 8.0);
    curves.extend([circle(0.0, 0.0, 2.0), circle(1.0, 0.0, 1.0), circle(-3.0, -3.0, 0.5)]);
    curves.push(line((-5.0, 1.0), (5.0, 1.5)));
    curves.push(Curve::bezier(vec![p(-4.0, -4.0), p(0.0, 3.0), p(1.0, -6.0), p(3.0, 2.0)]).unwrap());
    curves.push(Curve::ellipse(p(2.0, 2.0), Vec2::new(1.5, 0.5), Vec2::new(-0.2, 0.7), 0.0, TAU).unwrap());
    let moved = |c: Curve| c.transformed(kurbo::Affine::translate((offset, offset)));
    drawing(curves.into_iter().map(|c| if offset == 0.0 { c } else { moved(c) }).map(|c| c.scaled(factor)))
}

/// A fixed sequence of numbers in 0..1.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    }
}

/// A heap of curves of every kind, on top of each other; on a grid, so that ends and tangents coincide, where asked.
fn heap(seed: u64, grid: bool) -> Vec<Curve> {
    let mut number = numbers(seed * 7919 + 13);
    let mut up_to = move |size: f64| {
        let x = number() * size;
        if grid { (x * 8.0).round() / 8.0 } else { x }
    };
    let mut curves = Vec::new();
    for k in 0..6 + seed % 14 {
        let mut places = |n: usize| -> Vec<Point> { (0..n).map(|_| p(up_to(2.0), up_to(2.0))).collect() };
        let at = places(1)[0];
        let curve = match (k + seed) % 7 {
            0 => Curve::line(at, places(1)[0]),
            1 => Curve::circle(at, 0.125 + up_to(0.8)),
            2 => Curve::arc(at, 0.125 + up_to(0.8), up_to(6.0), 0.3 + up_to(5.0)),
            3 => {
                let (u, v) = (Vec2::new(0.2 + up_to(0.5), up_to(0.3)), Vec2::new(-up_to(0.1), 0.1 + up_to(0.5)));
                Curve::ellipse(at, u, v, 0.0, TAU)
            }
            4 => Curve::bezier(places(4)),
            5 => Curve::natural_spline(&places(7)),
            _ => Curve::periodic_spline(&places(5)),
        };
        let Ok(curve) = curve else { continue };
        if k % 5 == 4 {
            curves.push(curve.part(0.2, 0.7));
        }
        curves.push(curve);
    }
    curves
}

/// Shapes in the order in which they are painted: name, rule and outlines.
fn painted<const N: usize>(shapes: [(&str, bool, Vec<Curve>); N]) -> Drawing {
    let mut drawing = Drawing { fill: FillRule::Shapes, ..Drawing::default() };
    for (name, even_odd, curves) in shapes {
        let name = drawing.names.intern(name);
        let shape = drawing.shapes.push(Shape::new(name, even_odd, "path"));
        for curve in curves {
            drawing.add(curve, "ink", "curve");
            drawing.curves.last_mut().unwrap().shape = Some(shape);
        }
    }
    drawing
}

fn areas_by_name(domain: &Domain) -> Vec<(&str, f64)> {
    domain.regions().iter().map(|r| (domain.name(r.name), r.area)).collect()
}
