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

/// A clamped cubic B-spline over x ∈ [0, 3] whose abscissae are its Greville points, so that x(t) = 3t; the area under
/// it is Σ yᵢ·(uᵢ₊₄ − uᵢ)/4.
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
            let error = (domain.area() - area * scale * scale).abs() / (bounds.width() * bounds.height());
            // Ends welded at the offset are rounded to its last place: 1e3·ε of the size.
            let allowed = 1e-12 + 16.0 * f64::EPSILON * offset / scale;
            assert!(error <= allowed, "{name} at scale {scale}, offset {offset}: off by {error:e} of the box");
            let cut = domain.split_to_turning(0.1).area();
            assert!(
                (cut - domain.area()).abs() <= allowed * bounds.width() * bounds.height(),
                "{name}, cut to τ = 0.1"
            );
        }
    }
}

/// The unit quarter circle as a rational quadratic whose parameter runs at the pace c: the weights of index i times cⁱ.
fn paced_quarter(c: f64) -> Vec<Result<Curve, CurveError>> {
    let ring = points(&[(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    let arc = Curve::rational_bezier(ring, vec![1.0, FRAC_1_SQRT_2 * c, c * c]);
    vec![arc, line((0.0, 1.0), (0.0, 0.0)), line((0.0, 0.0), (1.0, 0.0))]
}

/// The conic from (1, 0) to (0, 1) under the shoulder (1, 1) with the middle weight w, and the area between it and its
/// chord: with w = cos θ the affine image of a circular segment r²(θ − sin θ cos θ) in a triangle of area r² sin³ θ /
/// cos θ; here that is ½. Beyond w = 1 the arc cosine turns hyperbolic.
fn conic_segment(w: f64) -> (Result<Curve, CurveError>, f64) {
    let arc = Curve::rational_bezier(points(&[(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]), vec![1.0, w, 1.0]);
    let square = 1.0 - w * w;
    let angle = if w < 1.0 { w.acos() / square.sqrt() } else { w.acosh() / (-square).sqrt() };
    (arc, w / (2.0 * square) * (angle - w))
}

fn measured(curves: Vec<Result<Curve, CurveError>>) -> squinch::domain::Domain {
    let mut drawing = Drawing::default();
    for curve in curves {
        drawing.add(curve.expect("a sound curve"), "edge", "curve");
    }
    drawing.arrange(&ArrangeOptions { tolerance: Some(0.0), ..ArrangeOptions::default() }).expect("a sound drawing")
}

#[test]
fn a_circle_is_a_circle_at_every_pace_of_its_parameter() {
    for exponent in [-12, -6, -3, -1, 1, 3, 6, 12] {
        let c = 10f64.powi(exponent);
        let domain = measured(paced_quarter(c));
        assert!((domain.area() - PI / 4.0).abs() < 4e-15, "pace {c:e}: {}", domain.area());
        let arc = paced_quarter(c).swap_remove(0).expect("an arc");
        assert!((arc.length() - PI / 2.0).abs() < 4e-15, "pace {c:e}: {}", arc.length());
        assert!((arc.turning(0.0, 1.0) - PI / 2.0).abs() < 1e-14, "pace {c:e}: {}", arc.turning(0.0, 1.0));
        let parts = domain.split_to_turning(0.1);
        let most = parts.curves().iter().map(|c| c.curve.turning(0.0, 1.0)).fold(0.0, f64::max);
        assert!(most <= 0.1 + 1e-12, "pace {c:e}: a part turns {most}");
    }
}

#[test]
fn conics_of_any_weight_have_the_area_and_turning_of_closed_forms() {
    for w in [1e-12, 1e-6, 1e-3, 0.1, 1e5, 1e8, 1e12] {
        let (arc, area) = conic_segment(w);
        let arc = arc.expect("an arc");
        // Near the shoulder the radius of curvature is 1/w: coordinates rounded there turn its tangents by some ε·w.
        let rounding = 1e-12 + 16.0 * f64::EPSILON * w;
        assert!((arc.turning(0.0, 1.0) - PI / 2.0).abs() < rounding, "weight {w:e}: turns {}", arc.turning(0.0, 1.0));
        let green = arc.signed_area(Point::new(0.0, 1.0));
        assert!((green - area).abs() < 1e-14, "weight {w:e}: {green} and not {area}");
    }
}
