//! The exact area of a domain, of every kind of curve, against closed forms.

use squinch::curve::{Curve, CurveError};
use squinch::domain::{ArrangeOptions, Drawing};
use squinch::geometry::{Point, Vec2};
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

fn points(list: &[(f64, f64)]) -> Vec<Point> {
    list.iter().map(|&(x, y)| Point::new(x, y)).collect()
}

fn line(from: (f64, f64), to: (f64, f64)) -> Result<Curve, CurveError> {
    Curve::line(Point::new(from.0, from.1), Point::new(to.0, to.1))
}

/// A unit circle as a NURBS of degree 2 with nine points.
fn nurbs_circle() -> Result<Curve, CurveError> {
    let w = FRAC_1_SQRT_2;
    let ring = [
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 1.0),
        (-1.0, 1.0),
        (-1.0, 0.0),
        (-1.0, -1.0),
        (0.0, -1.0),
        (1.0, -1.0),
        (1.0, 0.0),
    ];
    let weights = [1.0, w, 1.0, w, 1.0, w, 1.0, w, 1.0];
    let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    Curve::nurbs(2, &knots, &points(&ring), Some(&weights))
}

/// A clamped cubic B-spline over x ∈ [0, 3] whose abscissae are its Greville points, so that x(t) = 3t; the area under it is
/// Σ yᵢ·(uᵢ₊₄ − uᵢ)/4.
fn cubic_b_spline() -> (Result<Curve, CurveError>, f64) {
    let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0];
    let ordinates = [0.0, 1.0, 2.0, 1.5, 0.5, 0.0];
    let greville = |i: usize| (knots[i + 1] + knots[i + 2] + knots[i + 3]) / 3.0;
    let control: Vec<Point> = (0..6).map(|i| Point::new(greville(i), ordinates[i])).collect();
    let area = (0..6).map(|i| ordinates[i] * (knots[i + 4] - knots[i]) / 4.0).sum();
    (Curve::nurbs(3, &knots, &control, None), area)
}

/// Name, curves and area of a domain.
type Known = (&'static str, Vec<Result<Curve, CurveError>>, f64);

fn domains() -> Vec<Known> {
    let origin = Point::ZERO;
    let (b_spline, under_b_spline) = cubic_b_spline();
    let square = vec![
        line((0.0, 0.0), (1.0, 0.0)),
        line((1.0, 0.0), (1.0, 1.0)),
        line((1.0, 1.0), (0.0, 1.0)),
        line((0.0, 1.0), (0.0, 0.0)),
    ];
    vec![
        ("square", square, 1.0),
        ("circle", vec![Curve::circle(origin, 1.0)], PI),
        ("half disk", vec![Curve::arc(origin, 1.0, 0.0, PI), line((-1.0, 0.0), (1.0, 0.0))], PI / 2.0),
        (
            "ellipse of conjugate axes",
            vec![Curve::ellipse(origin, Vec2::new(2.0, 1.0), Vec2::new(0.5, 1.0), 0.3, TAU)],
            1.5 * PI,
        ),
        (
            "parabola",
            vec![Curve::bezier(points(&[(-1.0, 0.0), (0.0, 2.0), (1.0, 0.0)])), line((-1.0, 0.0), (1.0, 0.0))],
            4.0 / 3.0,
        ),
        (
            "cubic",
            vec![
                Curve::bezier(points(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)])),
                line((0.0, 0.0), (1.0, 0.0)),
            ],
            0.6,
        ),
        (
            "quintic",
            vec![
                Curve::bezier(points(&[(0.0, 0.0), (0.2, 1.0), (0.4, 1.0), (0.6, 1.0), (0.8, 1.0), (1.0, 0.0)])),
                line((0.0, 0.0), (1.0, 0.0)),
            ],
            4.0 / 6.0,
        ),
        (
            "quarter disk of a rational Bézier curve",
            vec![
                Curve::rational_bezier(points(&[(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]), vec![1.0, FRAC_1_SQRT_2, 1.0]),
                line((0.0, 0.0), (1.0, 0.0)),
                line((0.0, 0.0), (0.0, 1.0)),
            ],
            PI / 4.0,
        ),
        ("NURBS circle", vec![nurbs_circle()], PI),
        ("B-spline", vec![b_spline, line((0.0, 0.0), (3.0, 0.0))], under_b_spline),
        // Equal spacing: x is linear and y is 3t/2 − t³/2 on the way up.
        (
            "natural spline",
            vec![Curve::natural_spline(&points(&[(-1.0, 0.0), (0.0, 1.0), (1.0, 0.0)])), line((-1.0, 0.0), (1.0, 0.0))],
            1.25,
        ),
        // By symmetry every quarter is (3u/2 − u³/2, 3t/2 − t³/2), u = 1 − t.
        (
            "periodic spline",
            vec![Curve::periodic_spline(&points(&[(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]))],
            3.05,
        ),
    ]
}

#[test]
fn areas_of_every_kind_of_curve_are_those_of_closed_forms() {
    for (scale, offset) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e3)] {
        for (name, curves, area) in domains() {
            let mut drawing = Drawing::default();
            let map = kurbo::Affine::translate((offset, -offset)) * kurbo::Affine::scale(scale);
            for curve in curves {
                drawing.add(curve.expect(name).transformed(map), "edge", name);
            }
            let domain = drawing.arrange(&ArrangeOptions::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
            let bounds = domain.bounds();
            let error = (domain.measure() - area * scale * scale).abs() / (bounds.width() * bounds.height());
            // Ends welded at the offset are rounded to its last place: 1e3·ε of the size.
            let allowed = 1e-12 + 16.0 * f64::EPSILON * offset / scale;
            assert!(error <= allowed, "{name} at scale {scale}, offset {offset}: off by {error:e} of the box");
            let cut = domain.split_to_turning(0.1).measure();
            assert!(
                (cut - domain.measure()).abs() <= allowed * bounds.width() * bounds.height(),
                "{name}, cut to τ = 0.1"
            );
        }
    }
}
