//! One suite of laws for every kind of curve, at every size and offset.
//!
//! The oracles are slow and dumb: dense samples, polylines and finite differences. Each law states its slack in the
//! rounding of the coordinates (`grain`) or in the resolution of the samples.

use kurbo::{Affine, Point, Vec2};
use proptest::prelude::*;
use squinch::curve::{BreakKind, Curve, End};
use squinch::domain::Drawing;
use squinch::import::outline;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_3, PI, TAU};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn points(coordinates: &[(f64, f64)]) -> Vec<Point> {
    coordinates.iter().map(|c| p(c.0, c.1)).collect()
}

fn bezier(coordinates: &[(f64, f64)]) -> Curve {
    Curve::bezier(points(coordinates)).unwrap()
}

/// The unit circle as a rational quadratic spline (The NURBS Book, example 7.2).
fn nurbs_circle() -> Curve {
    let s = FRAC_1_SQRT_2;
    let square = [(1., 0.), (1., 1.), (0., 1.), (-1., 1.), (-1., 0.), (-1., -1.), (0., -1.), (1., -1.), (1., 0.)];
    let knots = [0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.];
    Curve::nurbs(2, &knots, &points(&square), Some(&[1., s, 1., s, 1., s, 1., s, 1.])).unwrap()
}

fn periodic_b_spline() -> Curve {
    let mut ring: Vec<Point> = (0..7)
        .map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 7.0).sin_cos();
            p(cos * (1.0 + 0.3 * f64::from(i % 2)), 0.7 * sin)
        })
        .collect();
    ring.extend_from_within(..3);
    let knots: Vec<f64> = (0..14).map(f64::from).collect();
    Curve::nurbs(3, &knots, &ring, None).unwrap()
}

/// Sample curves about one unit in size, near the origin.
fn samples() -> Vec<(&'static str, Curve)> {
    let wave = points(&[(0., 0.), (0.2, 0.4), (0.5, 0.1), (0.6, 0.6), (1., 0.5), (1.2, -0.1)]);
    let ring = points(&[(1., 0.), (0.6, 0.8), (-0.3, 0.7), (-1., 0.1), (-0.2, -0.6), (0.5, -0.9)]);
    let knots = [0., 0., 0., 0., 0.3, 0.5, 0.5, 1., 1., 1., 1.];
    let seven = points(&[(0., 0.), (0.1, 0.5), (0.4, 0.7), (0.7, 0.2), (1., 0.4), (1.1, 1.), (0.6, 1.2)]);
    let doubled = points(&[(0., 0.), (0., 0.), (0.4, 0.7), (0.4, 0.7), (1., 0.4), (1.1, 1.), (1.1, 1.)]);
    let corner_knots = [0., 0., 0., 1., 1., 2., 2., 2.];
    let corner = points(&[(0., 0.), (0.5, 0.1), (1., 0.), (1.2, 0.6), (1., 1.)]);
    let nine: Vec<Point> = (0..10)
        .map(|i| {
            let x = f64::from(i) / 9.0;
            p(x, 0.6 * (5.0 * x).sin() * (1.0 - x))
        })
        .collect();
    vec![
        ("line", Curve::line(p(0.1, 0.2), p(0.9, -0.4)).unwrap()),
        ("arc", Curve::arc(p(0.1, 0.2), 0.7, 0.4, 1.3).unwrap()),
        ("clockwise arc", Curve::arc(p(0.1, 0.2), 0.7, 0.4, -4.9).unwrap()),
        ("circle", Curve::circle(p(0.1, -0.2), 0.8).unwrap()),
        ("flat arc", Curve::bulge(p(0., 0.), p(1., 0.3), 1e-7).unwrap()),
        ("arc through", Curve::arc_through(p(0., 0.), p(0.5, 0.4), p(1., 0.1)).unwrap()),
        ("ellipse", Curve::ellipse(p(0.1, 0.1), Vec2::new(1., 0.2), Vec2::new(-0.1, 0.5), 0.3, TAU).unwrap()),
        ("skew ellipse", Curve::ellipse(p(0., 0.1), Vec2::new(1., 0.2), Vec2::new(0.7, 0.4), 2., -3.9).unwrap()),
        ("thin ellipse", Curve::ellipse(p(0., 0.), Vec2::new(1., 0.), Vec2::new(0., 0.01), 0.1, 3.).unwrap()),
        ("quadratic", bezier(&[(0., 0.), (0.4, 0.9), (1., 0.2)])),
        ("cubic", bezier(&[(0., 0.), (0.3, 0.5), (0.7, 0.6), (1., 0.1)])),
        ("s cubic", bezier(&[(0., 0.), (0.9, 0.9), (0.1, -0.7), (1., 0.1)])),
        ("loop cubic", bezier(&[(0., 0.), (1.4, 1.), (-0.4, 1.), (1., 0.)])),
        ("cusp cubic", bezier(&[(0., 0.), (1., 1.), (0., 1.), (1., 0.)])),
        ("double start", bezier(&[(0., 0.), (0., 0.), (0.6, 0.6), (1., 0.)])),
        ("double ends", bezier(&[(0., 0.), (0., 0.), (1., 0.3), (1., 0.3)])),
        ("double end", bezier(&[(0., 0.), (0.3, 0.6), (1., 0.1), (1., 0.1)])),
        ("bent between double ends", bezier(&[(0., 0.), (0., 0.), (0.4, 0.8), (1., 0.3), (1., 0.3)])),
        ("triple start", bezier(&[(0., 0.), (0., 0.), (0., 0.), (0.6, 0.6), (1., 0.)])),
        ("quadratic of one handle", bezier(&[(0., 0.), (0., 0.), (1., 0.3)])),
        (
            "rational double end",
            Curve::rational_bezier(points(&[(0., 0.), (0.3, 0.6), (1., 0.1), (1., 0.1)]), vec![1., 0.5, 2., 1.])
                .unwrap(),
        ),
        ("b-spline of double points", Curve::nurbs(3, &knots, &doubled, None).unwrap()),
        ("there and back", bezier(&[(0., 0.), (1., 0.5), (0.2, 0.1)])),
        ("straight cubic", bezier(&[(0., 0.), (0.25, 0.125), (0.75, 0.375), (1., 0.5)])),
        ("degree 1", bezier(&[(0.2, 0.), (1., 0.4)])),
        ("degree 9", Curve::bezier(nine).unwrap()),
        (
            "rational quadratic",
            Curve::rational_bezier(points(&[(0., 0.), (0.5, 1.), (1., 0.)]), vec![1., 3., 2.]).unwrap(),
        ),
        (
            "rational cubic",
            Curve::rational_bezier(points(&[(0., 0.), (0.1, 0.8), (0.8, -0.5), (1., 0.3)]), vec![1., 0.4, 2., 1.])
                .unwrap(),
        ),
        ("b-spline", Curve::nurbs(3, &knots, &seven, None).unwrap()),
        ("corner spline", Curve::nurbs(2, &corner_knots, &corner, None).unwrap()),
        (
            "polyline spline",
            Curve::nurbs(1, &[0., 0., 1., 2., 2.], &points(&[(0., 0.), (0.5, 0.5), (1., 0.)]), None).unwrap(),
        ),
        ("nurbs circle", nurbs_circle()),
        ("periodic b-spline", periodic_b_spline()),
        ("natural spline", Curve::natural_spline(&wave).unwrap()),
        ("periodic spline", Curve::periodic_spline(&ring).unwrap()),
        ("clothoid from a line", Curve::clothoid(p(0., 0.1), 0.3, [0.0, 2.5], 1.2).unwrap()),
        ("clothoid to a line", Curve::clothoid(p(-0.5, 0.1), -0.7, [-3.1, 0.0], 1.4).unwrap()),
        ("clothoid of one sign", Curve::clothoid(p(0.2, 0.1), 2.3, [0.7, 3.0], 1.5).unwrap()),
        ("s clothoid", Curve::clothoid(p(0., 0.), 0.5, [-3.0, 4.0], 1.3).unwrap()),
        ("tight clothoid", Curve::clothoid(p(0.1, -0.2), 1.0, [2.0, 14.0], 2.5).unwrap()),
        ("clothoid of many turns", Curve::clothoid(p(0.4, 0.2), 4.0, [-30.0, 20.0], 2.0).unwrap()),
        ("flat clothoid", Curve::clothoid(p(0., 0.), 0.2, [2e-7, -3e-7], 1.1).unwrap()),
        ("clothoid like an arc", Curve::clothoid(p(0.3, 0.), 0.2, [1.4, 1.4000001], 1.5).unwrap()),
        ("clothoid of an arc", Curve::clothoid(p(0.3, 0.), 0.2, [-1.3, -1.3], 1.5).unwrap()),
        ("clothoid of a line", Curve::clothoid(p(0.3, 0.), 0.2, [0.0, 0.0], 0.9).unwrap()),
    ]
}

/// A sample at some size and offset, with what its numbers are good for.
struct Case {
    name: String,
    curve: Curve,
    size: f64,
    /// One unit in the last place of the largest coordinate.
    grain: f64,
}

/// Every sample at sizes 1e-6 to 1e6, near the origin and 1e7 sizes away from it.
fn cases() -> Vec<Case> {
    let mut all = Vec::new();
    for (name, curve) in samples() {
        for decade in -6..=6 {
            let size = 10f64.powi(decade);
            for offset in [0.0, 1e7 * size] {
                let map = Affine::translate((offset, -0.7 * offset)) * Affine::scale(size);
                let curve = curve.transformed(map);
                let grain = f64::EPSILON * (offset + 2.0 * size);
                all.push(Case { name: format!("{name} of size {size:e} at {offset:e}"), curve, size, grain });
            }
        }
    }
    all
}

/// n + 1 parameters over t0..t1.
fn grid(n: u32, t0: f64, t1: f64) -> impl Iterator<Item = f64> {
    (0..=n).map(move |i| t0 + (t1 - t0) * f64::from(i) / f64::from(n))
}

/// Whether a fifth of the way or more lies between t and the breaks: finite differences need room.
fn is_regular_near(curve: &Curve, t: f64, room: f64) -> bool {
    let breaks = curve.breaks();
    breaks.iter().all(|b| (b.t - t).abs() > room)
}

fn angle_between(u: Vec2, v: Vec2) -> f64 {
    u.cross(v).atan2(u.dot(v)).abs()
}

/// Distance from p to the chord xy.
fn distance_to_chord(q: Point, x: Point, y: Point) -> f64 {
    let c = y - x;
    let s = if c.hypot2() > 0.0 { ((q - x).dot(c) / c.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
    (q - (x + c * s)).hypot()
}

#[test]
fn ends_are_exact_and_part_reversed_and_welded_curves_keep_the_points() {
    for Case { name, curve, size, grain } in cases() {
        assert_eq!((curve.point(0.0), curve.point(1.0)), (curve.start(), curve.end()), "{name}");
        let reversed = curve.reversed();
        assert_eq!((reversed.start(), reversed.end()), (curve.end(), curve.start()), "{name}");
        let (t0, t1) = (0.237, 0.861);
        let part = curve.part(t0, t1);
        assert_eq!((part.start(), part.end()), (curve.point(t0), curve.point(t1)), "{name}");
        assert_eq!(part.kind(), curve.kind(), "{name}");
        let (dx, dy) = (Vec2::new(3e-9, -2e-9) * size, Vec2::new(-1e-9, 4e-9) * size);
        let closed = curve.start() == curve.end();
        let ends = (curve.start() + dx, if closed { curve.end() + dx } else { curve.end() + dy });
        let welded = curve.with_ends(ends.0, ends.1);
        assert_eq!((welded.start(), welded.end()), ends, "{name}");
        assert_eq!((welded.point(0.0), welded.point(1.0)), ends, "{name}");
        assert_eq!(curve.with_ends(curve.start(), curve.end()), curve);
        for s in grid(16, 0.0, 1.0) {
            let there = curve.point(t0 + s * (t1 - t0));
            assert!(
                (part.point(s) - there).hypot() <= 8.0 * grain,
                "{name}: part off by {} grains",
                (part.point(s) - there).hypot() / grain
            );
            assert!((reversed.point(1.0 - s) - curve.point(s)).hypot() <= 8.0 * grain, "{name}: reversed at {s}");
            // A similarity that moves the ends by δ moves no point at distance d from an end by more than δ(1 +
            // 2d/chord).
            let chord = (curve.end() - curve.start()).hypot();
            let reach = if closed { 1.0 } else { 1.0 + 4.0 * size / chord };
            let moved = (welded.point(s) - curve.point(s)).hypot();
            assert!(moved <= 6e-9 * size * reach + 16.0 * grain, "{name}: welding moved {s} by {moved:e}");
        }
        for s in [0.0, 0.3, 1.0] {
            let side = if s == 0.0 { End::Start } else { End::Finish };
            let turned = angle_between(part.tangent(s, side), curve.tangent(t0 + s * (t1 - t0), side));
            let speed = part.derivative(s).hypot().max(1e-3 * size);
            assert!(turned < 1e-6 + 64.0 * grain / speed, "{name}: tangent of the part at {s} is off by {turned:e}");
        }
    }
}

#[test]
fn welding_moves_no_point_much_farther_than_the_ends() {
    let nearly: Vec<Curve> = vec![
        Curve::arc(p(0.3, 0.1), 1.0, 0.2, TAU - 1e-6).unwrap(),
        Curve::ellipse(p(0.3, 0.1), Vec2::new(1., 0.), Vec2::new(0.2, 0.4), 0.2, 1e-6 - TAU).unwrap(),
        bezier(&[(0., 0.), (1.4, 1.), (-0.4, 1.), (1e-6, 1e-7)]),
        nurbs_circle(),
    ];
    let all = samples().into_iter().map(|(_, curve)| curve).chain(nearly);
    for (curve, step) in all.flat_map(|c| [(c.clone(), 1e-3), (c, 1e-7)]) {
        let ends = (curve.start() + Vec2::new(step, 0.0), curve.end() + Vec2::new(-0.3, -0.9) * step);
        // Opened, moved, and closed.
        for (start, end) in [ends, (ends.0, ends.0)] {
            let welded = curve.with_ends(start, end);
            assert_eq!((welded.point(0.0), welded.point(1.0)), (start, end));
            let farthest = (start - curve.start()).hypot().max((end - curve.end()).hypot());
            for t in grid(50, 0.0, 1.0) {
                let moved = (welded.point(t) - curve.point(t)).hypot();
                assert!(moved <= 5.0 * farthest + 1e-14, "{curve:?} moved by {moved:e} at {t} for {farthest:e}");
            }
        }
    }
}

#[test]
fn derivatives_are_the_limits_of_differences() {
    for Case { name, curve, size, grain } in cases() {
        for t in [0.11, 0.37, 0.52, 0.83] {
            let h = (grain / size).cbrt().max(1e-4);
            let breaks_or_knot = |h: f64| {
                let Curve::Spline(s) = &curve else { return false };
                s.knots.iter().any(|k| (k - t).abs() <= h)
            };
            if !is_regular_near(&curve, t, h) || breaks_or_knot(h) {
                continue;
            }
            let d = (curve.point(t + h) - curve.point(t - h)) / (2.0 * h);
            let slack = 2e3 * size * h * h + 4.0 * grain / h;
            assert!(
                (d - curve.derivative(t)).hypot() <= slack,
                "{name}: derivative at {t}: {d:?} {:?}",
                curve.derivative(t)
            );
            let dd = (curve.derivative(t + h) - curve.derivative(t - h)) / (2.0 * h);
            let slack = 1e5 * size * h * h + 400.0 * grain / h;
            assert!((dd - curve.second_derivative(t)).hypot() <= slack, "{name}: second derivative at {t}");
            assert!(angle_between(curve.tangent(t, End::Start), curve.derivative(t)) < 1e-9, "{name}");
            let (d, dd) = (curve.derivative(t), curve.second_derivative(t));
            let curvature = d.cross(dd) / d.hypot().powi(3);
            assert!((curve.curvature(t) - curvature).abs() <= 1e-12 * curvature.abs() + 1e-13 / size, "{name}");
        }
        let step = 1e-5f64.max((grain / size).sqrt());
        for (end, t, inward) in [(End::Start, 0.0, step), (End::Finish, 1.0, -step)] {
            // Where it stands still, a curve has not gone far enough by then for its direction to be told.
            if curve.breaks().is_empty() && curve.derivative(t).hypot() > 0.01 * size {
                let leaving = curve.point(t + inward) - curve.point(t);
                assert!(angle_between(leaving, curve.direction_at(end)) < 0.01, "{name}");
            }
        }
    }
}

/// Handles of no length, as drawing programs write corner nodes: the tangent there leads to the first control point
/// that differs.
#[test]
fn where_a_curve_stands_still_its_tangent_is_the_limit() {
    for Case { name, curve, grain, size } in cases() {
        for (end, t, inward) in [(End::Start, 0.0, 1.0), (End::Finish, 1.0, -1.0)] {
            if grain > 1e-12 * size || curve.derivative(t).hypot() > 0.0 {
                continue;
            }
            for step in [1e-3, 1e-2] {
                let leaving = curve.point(t + inward * step) - curve.point(t);
                assert!(angle_between(leaving, curve.direction_at(end)) <= 4.0 * step, "{name}: {end:?}");
            }
        }
    }
}

#[test]
fn boxes_hold_the_samples_and_are_touched() {
    for Case { name, curve, size, grain } in cases() {
        for (t0, t1) in [(0.0, 1.0), (0.21, 0.64)] {
            let b = curve.bounds_of(t0, t1);
            let n = 400;
            let inner = squinch::geometry::bounds_of(grid(n, t0, t1).map(|t| curve.point(t))).unwrap();
            let slack = 4.0 * grain;
            assert!(b.x0 <= inner.x0 + slack && b.y0 <= inner.y0 + slack, "{name}");
            assert!(b.x1 >= inner.x1 - slack && b.y1 >= inner.y1 - slack, "{name}");
            // Between samples the curve bulges by at most |P″|/8n², and a corner sticks out by |P′|/n.
            let kink = if curve.breaks().is_empty() { 0.0 } else { 3.0 * size / f64::from(n) };
            let bulge = 400.0 * size / f64::from(8 * n * n) + kink + slack;
            assert!(inner.x0 - b.x0 <= bulge && inner.y0 - b.y0 <= bulge, "{name}");
            assert!(b.x1 - inner.x1 <= bulge && b.y1 - inner.y1 <= bulge, "{name}");
        }
    }
}

#[test]
fn a_curve_lies_in_the_cones_from_its_ends() {
    let mut cones = 0;
    for case in cases() {
        for (t0, t1) in [(0.0, 1.0), (0.0, 0.3), (0.3, 0.6), (0.6, 1.0)] {
            let part = case.curve.part(t0, t1);
            for (end, apex) in [(End::Start, part.start()), (End::Finish, part.end())] {
                let Some(cone) = part.cone_from(end) else { continue };
                let slack = 64.0 * case.grain;
                cones += 1;
                for t in grid(64, 0.0, 1.0) {
                    let v = part.point(t) - apex;
                    let off = |side: Vec2, other: f64| side.cross(v) * other / side.hypot();
                    let inside = off(cone.right, 1.0) >= -slack && off(cone.left, -1.0) >= -slack;
                    assert!(inside, "{} {t0}..{t1} from {end:?}: {v:?} not in {cone:?}", case.name);
                }
            }
        }
    }
    assert!(cones > 100, "{cones}");
}

#[test]
fn the_nearest_point_is_found_beside_a_slow_end() {
    // The curve starts at a ten-millionth of its speed, and passes q before it has gained any.
    let points =
        [(3.7500000000000826, 3.250000000000102), (3.7499994, 3.2499996), (-3.999, -3.9999998), (-3.999, -4.0)];
    let curve = Curve::bezier(points.map(|(x, y)| Point::new(x, y)).to_vec()).unwrap();
    for t in [1e-9, 3e-8, 1e-7, 1e-6] {
        let q = curve.point(t);
        let noise = 8.0 * f64::EPSILON;
        assert!(curve.nearest(q, 0.0, 1.0).1 <= noise, "{t}: {:?}", curve.nearest(q, 0.0, 1.0));
        assert!(curve.reversed().nearest(q, 0.0, 1.0).1 <= noise, "{t}");
    }
}

#[test]
fn the_nearest_point_is_nearest() {
    for Case { name, curve, size, grain } in cases() {
        let center = curve.bounds().center();
        let queries = [(0.0, 0.0), (0.31, 0.22), (-0.4, 0.53), (0.05, -0.37), (3.0, 2.0)];
        for (x, y) in queries {
            let q = center + Vec2::new(x, y) * size;
            for (t0, t1) in [(0.0, 1.0), (0.15, 0.7)] {
                let (t, distance) = curve.nearest(q, t0, t1);
                assert!(t >= t0 && t <= t1, "{name}");
                assert!(((curve.point(t) - q).hypot() - distance).abs() <= 4.0 * grain, "{name}");
                let sampled = grid(300, t0, t1).map(|t| (curve.point(t) - q).hypot()).fold(f64::INFINITY, f64::min);
                assert!(distance <= sampled + 4.0 * grain, "{name}: {distance} > {sampled}");
                assert!(distance >= sampled - 0.1 * size, "{name}: {distance} < {sampled}");
            }
        }
        for t in grid(7, 0.0, 1.0) {
            let (_, distance) = curve.nearest(curve.point(t), 0.0, 1.0);
            assert!(
                distance <= 4.0 * grain,
                "{name}: a point of the curve at {t} is {distance:e} away, {} grains",
                distance / grain
            );
        }
    }
}

#[test]
fn turning_is_that_of_dense_tangents() {
    for (name, curve) in samples() {
        let breaks = curve.breaks();
        // Tangents on both sides of every sample see jumps; of an even number so that t = ½ is none.
        let n = 4001;
        let sampled = |t0: f64, t1: f64| {
            let mut total = 0.0;
            let mut last = curve.tangent(t0, End::Start);
            for t in grid(n, t0, t1).skip(1) {
                for tangent in [curve.tangent(t, End::Finish), curve.tangent(t, End::Start)] {
                    if t < t1 || tangent == curve.tangent(t, End::Finish) {
                        total += angle_between(last, tangent);
                        last = tangent;
                    }
                }
            }
            total
        };
        for (t0, t1) in [(0.0, 1.0), (0.123, 0.456), (0.3, 0.95)] {
            let (exact, seen) = (curve.turning(t0, t1), sampled(t0, t1));
            assert!(
                (exact - seen).abs() < 2e-3 * (1.0 + exact),
                "{name} {t0}..{t1}: {exact} but sampled {seen}, {breaks:?}"
            );
        }
    }
}

#[test]
fn turning_is_additive_and_the_same_at_every_size_and_offset() {
    let unit: Vec<(f64, usize, usize)> =
        samples().iter().map(|(_, c)| (c.turning(0.0, 1.0), c.breaks().len(), c.inflections().len())).collect();
    for (i, Case { name, curve, size, grain }) in cases().into_iter().enumerate() {
        let (turning, breaks, inflections) = unit[i / 26];
        // Control points off by a grain turn the tangent, and bend it, by that over their distance.
        let slack = 400.0 * grain / size + 1e-11;
        assert!(
            (curve.turning(0.0, 1.0) - turning).abs() <= slack,
            "{name}: {} is not {turning}",
            curve.turning(0.0, 1.0)
        );
        assert_eq!(curve.breaks().len(), breaks, "{name}");
        assert_eq!(curve.inflections().len(), inflections, "{name}");
        let t = 0.434;
        let sum = curve.turning(0.0, t) + curve.turning(t, 1.0);
        assert!((sum - turning).abs() <= slack, "{name}: {sum} in two parts, {turning} in one");
        let part = curve.part(0.2, 0.7);
        let whole = curve.turning(0.2, 0.7);
        assert!((part.turning(0.0, 1.0) - whole).abs() <= 10.0 * slack, "{name}: {} {whole}", part.turning(0.0, 1.0));
        assert!((curve.reversed().turning(0.0, 1.0) - turning).abs() <= slack, "{name}");
    }
}

#[test]
fn breaks_and_inflections_are_where_they_are_known_to_be() {
    let by_name = |wanted: &str| samples().into_iter().find(|(name, _)| *name == wanted).unwrap().1;
    let cusp = by_name("cusp cubic").breaks();
    assert!(cusp.len() == 1 && cusp[0].kind == BreakKind::Cusp && (cusp[0].t - 0.5).abs() < 1e-12, "{cusp:?}");
    assert!((cusp[0].turn_rad - PI).abs() < 1e-12);
    let back = by_name("there and back");
    let breaks = back.breaks();
    assert!(
        breaks.len() == 1 && breaks[0].kind == BreakKind::Cusp && (breaks[0].turn_rad - PI).abs() < 1e-9,
        "{breaks:?}"
    );
    let corner = by_name("corner spline").breaks();
    assert!(corner.len() == 1 && corner[0].kind == BreakKind::TangentJump && corner[0].t == 0.5, "{corner:?}");
    let expected = angle_between(Vec2::new(0.5, -0.1), Vec2::new(0.2, 0.6));
    assert!((corner[0].turn_rad - expected).abs() < 1e-14);
    let s = by_name("s cubic").inflections();
    assert_eq!(s.len(), 1);
    assert!(by_name("s cubic").curvature(s[0]).abs() < 1e-12);
    for name in ["cubic", "loop cubic", "straight cubic", "double start", "nurbs circle", "circle", "ellipse"] {
        assert!(by_name(name).breaks().is_empty() && by_name(name).inflections().is_empty(), "{name}");
    }
    for (name, curve) in samples() {
        let straight =
            ["line", "degree 1", "straight cubic", "double ends", "quadratic of one handle", "clothoid of a line"]
                .contains(&name);
        assert_eq!(curve.is_straight(), straight, "{name}");
    }
    // Collinear, with a derivative that vanishes in the middle but does not reverse.
    let pause = bezier(&[(0., 0.), (1., 1.), (1., 1.), (2., 2.)]);
    assert!(pause.breaks().is_empty() && pause.turning(0.0, 1.0) == 0.0 && pause.is_straight());
    let stop = bezier(&[(0., 0.), (1., 0.), (1., 0.), (1., 0.), (2., 0.)]);
    assert!(stop.breaks().is_empty() && stop.turning(0.0, 1.0) == 0.0, "{:?}", stop.breaks());
    // Twice back and forth along a line.
    let zigzag = bezier(&[(0., 0.), (3., 3.), (-2., -2.), (1., 1.)]);
    assert_eq!(zigzag.breaks().len(), 2);
    assert!((zigzag.turning(0.0, 1.0) - TAU).abs() < 1e-12 && !zigzag.is_straight());
    assert!((nurbs_circle().turning(0.0, 1.0) - TAU).abs() < 1e-12);
}

#[test]
fn cuts_leave_parts_of_equal_turning_below_the_limit() {
    for (i, Case { name, curve, size, grain }) in cases().into_iter().enumerate() {
        if i % 26 % 5 != 0 {
            continue;
        }
        for tau in [0.1, 0.5, FRAC_PI_3] {
            let cuts = curve.cuts_of_turning(tau);
            let breaks = curve.breaks();
            let all: Vec<f64> = [0.0].into_iter().chain(cuts.iter().copied()).chain([1.0]).collect();
            assert!(all.windows(2).all(|w| w[0] < w[1]), "{name}: {all:?}");
            assert!(breaks.iter().all(|b| cuts.contains(&b.t)), "{name}");
            // A parameter is good for a few ulp; a tangent for the rounding of control points.
            let slack = 2e3 * grain / size * f64::from(grain > 1e-10 * size) + 1e-9;
            let turnings: Vec<f64> = all.windows(2).map(|w| curve.turning(w[0], w[1])).collect();
            assert!(turnings.iter().all(|t| *t <= tau + slack), "{name}: {turnings:?}");
            let total: f64 = curve.turning(0.0, 1.0) - breaks.iter().map(|b| b.turn_rad).sum::<f64>();
            let fewest = (total / tau).ceil() as usize;
            assert!(
                all.len() - 1 <= fewest + 1 + 2 * breaks.len(),
                "{name}: {} parts, {fewest} suffice",
                all.len() - 1
            );
            if breaks.is_empty() && turnings.len() > 1 {
                let even = total / turnings.len() as f64;
                assert!(turnings.iter().all(|t| (t - even).abs() <= slack), "{name}: {turnings:?}");
            }
        }
    }
    assert_eq!(Curve::circle(Point::ZERO, 1.0).unwrap().cuts_of_turning(FRAC_PI_3).len(), 5);
}

#[test]
fn lengths_and_areas_are_the_limits_of_polylines() {
    for (i, Case { name, curve, size, grain }) in cases().into_iter().enumerate() {
        if i % 26 % 7 != 0 {
            continue;
        }
        let origin = curve.bounds().center() + Vec2::new(0.3, 0.4) * size;
        // Richardson: both limits are approached with the square of the step.
        let polyline = |n: u32| {
            let q: Vec<Point> = grid(n, 0.0, 1.0).map(|t| curve.point(t)).collect();
            let length: f64 = q.windows(2).map(|w| (w[1] - w[0]).hypot()).sum();
            let area: f64 = q.windows(2).map(|w| 0.5 * (w[0] - origin).cross(w[1] - origin)).sum();
            (length, area)
        };
        let (coarse, fine) = (polyline(512), polyline(1024));
        let length = fine.0 + (fine.0 - coarse.0) / 3.0;
        let area = fine.1 + (fine.1 - coarse.1) / 3.0;
        // Kinks leave an error of the order of the squared step.
        let rough = if curve.breaks().is_empty() { 1e-6 } else { 1e-4 };
        assert!(
            (curve.length() - length).abs() <= rough * size + 2048.0 * grain,
            "{name}: {} {length}",
            curve.length()
        );
        assert!(
            (curve.signed_area(origin) - area).abs() <= (rough * size + 8.0 * grain) * size,
            "{name}: {} {area}",
            curve.signed_area(origin)
        );
        let (t0, t1) = (0.1, 0.83);
        let parts = curve.length_of(0.0, t0) + curve.length_of(t0, t1) + curve.length_of(t1, 1.0);
        assert!((parts - curve.length()).abs() <= 1e-12 * size, "{name}: {parts} {}", curve.length());
        let sum: f64 = [(0.0, t0), (t0, t1), (t1, 1.0)].iter().map(|r| curve.part(r.0, r.1).signed_area(origin)).sum();
        assert!(
            (sum - curve.signed_area(origin)).abs() <= 1e-13 * size * size + 32.0 * grain * size,
            "{name}: {sum} {}",
            curve.signed_area(origin)
        );
    }
    let circle = nurbs_circle();
    assert!((circle.length() - TAU).abs() < 1e-14 && (circle.signed_area(p(5.0, -3.0)) - PI).abs() < 1e-13);
    // A parabola: asinh form.
    let parabola = bezier(&[(0., 0.), (0.5, 0.), (1., 1.)]);
    assert!((parabola.length() - (5f64.sqrt() / 2.0 + 2f64.asinh() / 4.0)).abs() < 1e-15);
}

/// Parts of turning at most π/3, where the mesher asks its questions.
fn tame_parts(curve: &Curve) -> Vec<(f64, f64)> {
    let cuts = curve.cuts_of_turning(FRAC_PI_3);
    let all: Vec<f64> = [0.0].into_iter().chain(cuts).chain([1.0]).collect();
    all.windows(2).map(|w| (w[0], w[1])).collect()
}

#[test]
fn crossings_lie_on_the_line_and_on_the_curve_and_none_is_missed() {
    for Case { name, curve, size, grain } in cases() {
        for (t0, t1) in tame_parts(&curve) {
            let t = curve.bisector_crossing(t0, t1);
            let (x, y, z) = (curve.point(t0), curve.point(t1), curve.point(t));
            assert!(t > t0 && t < t1, "{name}: {t} in {t0}..{t1}");
            // The parameter's own last place may be coarse where the curve is quick.
            let step = (4.0 * f64::EPSILON) * curve.derivative(t).hypot();
            let off = ((z - x).hypot() - (z - y).hypot()).abs();
            assert!(off <= 16.0 * grain + 2.0 * step, "{name}: off the bisector by {} grains at {t}", off / grain);
        }
        let center = curve.bounds().center();
        for angle in [0.3f64, 1.2, 2.5] {
            let direction = Vec2::new(angle.cos(), angle.sin()) * 3.0;
            let a = center + Vec2::new(0.031, 0.017) * size;
            let side = |t: f64| (curve.point(t) - a).cross(direction) / 3.0;
            for (t0, t1) in [(0.0, 1.0), (0.11, 0.77)] {
                let found = curve.line_crossings(a, direction, t0, t1);
                assert!(
                    found.windows(2).all(|w| w[0] < w[1]) && found.iter().all(|t| *t > t0 && *t < t1),
                    "{name} {found:?}"
                );
                for t in &found {
                    assert!(side(*t).abs() <= 16.0 * grain + 2e-15 * size, "{name}: {} grains", side(*t).abs() / grain);
                }
                let signs: Vec<bool> = grid(997, t0, t1).map(|t| side(t) > 0.0).collect();
                let changes = signs.windows(2).filter(|w| w[0] != w[1]).count();
                assert_eq!(found.len(), changes, "{name}: {found:?}");
            }
        }
    }
}

#[test]
fn the_ball_is_left_at_its_radius_and_for_the_first_time() {
    for Case { name, curve, size, grain } in cases() {
        for (t0, t1) in [(0.0, 1.0), (0.17, 0.74)] {
            for end in [End::Start, End::Finish] {
                let from = if end == End::Start { t0 } else { t1 };
                let x = curve.point(from);
                for radius in [1e-3, 0.05, 0.3, 0.9, 40.0].map(|r| r * size) {
                    let inside = |t: f64| (curve.point(t) - x).hypot() < radius + 8.0 * grain;
                    match curve.leaves_ball(end, radius, t0, t1) {
                        None => assert!(grid(200, t0, t1).all(inside), "{name}: {radius} is reached"),
                        Some(t) => {
                            let off = ((curve.point(t) - x).hypot() - radius).abs();
                            let step = 4.0 * f64::EPSILON * curve.derivative(t).hypot();
                            assert!(off <= 16.0 * grain + step, "{name}: {} grains off", off / grain);
                            assert!(grid(200, from, t).all(inside), "{name}: {radius} is reached before {t}");
                        }
                    }
                }
                assert_eq!(curve.leaves_ball(end, 0.0, t0, t1), Some(from), "{name}");
            }
        }
    }
}

#[test]
fn lens_angle_and_chord_error_bound_the_samples_and_are_met() {
    for (i, Case { name, curve, size, grain }) in cases().into_iter().enumerate() {
        if i % 26 % 3 != 0 {
            continue;
        }
        let mut parts = tame_parts(&curve);
        parts.truncate(3);
        parts.push((0.0, 1.0));
        for (t0, t1) in parts {
            let (x, y) = (curve.point(t0), curve.point(t1));
            let (mut turn, mut far) = (0.0f64, 0.0f64);
            for t in grid(500, t0, t1) {
                let z = curve.point(t);
                far = far.max(distance_to_chord(z, x, y));
                // Next to x and y the direction is rounding.
                let near = (z - x).hypot().min((y - z).hypot());
                if near > 1e5 * grain {
                    turn = turn.max(angle_between(z - x, y - z) - 8.0 * grain / near);
                }
            }
            if x != y {
                turn = turn.max(angle_between(curve.tangent(t0, End::Start), y - x) - 8.0 * grain / (y - x).hypot());
                turn = turn.max(angle_between(y - x, curve.tangent(t1, End::Finish)) - 8.0 * grain / (y - x).hypot());
            }
            let lens = curve.lens_angle(t0, t1);
            // The end of the thin ellipse is a hundredth of its size: so much more does a grain turn there.
            assert!(turn <= lens + 1e-12 + 100.0 * grain / size, "{name} {t0}..{t1}: {turn} > {lens}");
            let regular = !curve.breaks().iter().any(|b| b.t > t0 && b.t < t1);
            if regular && x != y && curve.turning(t0, t1) <= FRAC_PI_3 + 1e-6 {
                assert!(lens <= 1.03 * turn + 1e-4, "{name} {t0}..{t1}: {lens} for {turn}");
                assert!(lens <= curve.turning(t0, t1) + 1e-12, "{name}");
            }
            let error = curve.chord_error(t0, t1);
            assert!(far <= error + 4.0 * grain, "{name} {t0}..{t1}: {far} > {error}");
            assert!(
                error <= far * 1.001 + 1e-3 * size * f64::from(t0 == 0.0 && t1 == 1.0) + 4.0 * grain,
                "{name}: {error} for {far}"
            );
        }
    }
}

#[test]
fn arcs_and_circles_agree_with_their_rational_twins() {
    let circle = Curve::circle(Point::ZERO, 1.0).unwrap();
    let twin = nurbs_circle();
    for i in 0..40 {
        let q = p(f64::from(i % 7) * 0.4 - 1.1, f64::from(i % 11) * 0.25 - 1.3);
        assert!((circle.nearest(q, 0.0, 1.0).1 - twin.nearest(q, 0.0, 1.0).1).abs() < 1e-15 * 4.0);
    }
    // On quarters the parameter agrees too.
    for (t0, t1) in [(0.0, 0.25), (0.0, 0.5), (0.25, 1.0)] {
        assert!((circle.chord_error(t0, t1) - twin.chord_error(t0, t1)).abs() < 1e-14);
        assert!((circle.lens_angle(t0, t1) - twin.lens_angle(t0, t1)).abs() < 1e-7, "{}", twin.lens_angle(t0, t1));
        assert!((circle.length_of(t0, t1) - twin.length_of(t0, t1)).abs() < 1e-13);
        assert!((circle.turning(t0, t1) - twin.turning(t0, t1)).abs() < 1e-13);
    }
    let b = circle.bounds();
    assert!([b.x0, b.y0, b.x1, b.y1].iter().all(|v| (v.abs() - 1.0).abs() <= f64::EPSILON), "{b}");
}

#[test]
fn splines_pass_through_their_points_and_are_smooth() {
    let q = points(&[(0., 0.), (0.2, 0.4), (0.2, 0.4), (0.5, 0.1), (0.500001, 0.1), (1., 0.5), (1.2, -0.1)]);
    for (curve, closed) in [(Curve::natural_spline(&q).unwrap(), false), (Curve::periodic_spline(&q).unwrap(), true)] {
        let Curve::Spline(s) = &curve else { panic!("a spline is a spline") };
        let wanted: Vec<Point> = q.iter().copied().enumerate().filter(|(i, _)| *i != 2).map(|(_, p)| p).collect();
        for (k, point) in s.knots.iter().zip(wanted.iter().chain(closed.then_some(&wanted[0]))) {
            assert_eq!(curve.point(*k), *point);
        }
        let n = s.spans.len();
        for i in usize::from(!closed)..n {
            let before = (i + n - 1) % n;
            let step = |j: usize| s.knots[j + 1] - s.knots[j];
            let slopes = (s.spans[before].derivative_at_end(step(before)), s.spans[i].derivative_at_start(step(i)));
            assert!((slopes.0.0 - slopes.1.0).hypot() < 1e-9 * slopes.0.0.hypot(), "C¹ at {i}");
            assert!((slopes.0.1 - slopes.1.1).hypot() < 1e-6 * slopes.0.1.hypot().max(1.0), "C² at {i}: {slopes:?}");
        }
        if !closed {
            let start = s.spans[0].derivative_at_start(s.knots[1]).1;
            assert!(start.hypot() < 1e-9, "natural at its start: {start:?}");
        }
        assert!(curve.breaks().is_empty(), "{:?}", curve.breaks());
    }
    assert!(Curve::natural_spline(&[p(1., 1.); 4]).is_err() && Curve::periodic_spline(&q[..3]).is_err());
}

/// First and second derivatives of a cubic span at its ends, by its control points.
trait CubicEnds {
    fn derivative_at_start(&self, step: f64) -> (Vec2, Vec2);
    fn derivative_at_end(&self, step: f64) -> (Vec2, Vec2);
}

impl CubicEnds for squinch::curve::Bezier {
    fn derivative_at_start(&self, step: f64) -> (Vec2, Vec2) {
        let [a, b, c] = [self.points[0], self.points[1], self.points[2]];
        ((b - a) * (3.0 / step), ((c - b) - (b - a)) * (6.0 / (step * step)))
    }
    fn derivative_at_end(&self, step: f64) -> (Vec2, Vec2) {
        let [a, b, c] = [self.points[1], self.points[2], self.points[3]];
        ((c - b) * (3.0 / step), ((c - b) - (b - a)) * (6.0 / (step * step)))
    }
}

#[test]
fn b_splines_are_their_basis_functions_sums() {
    // Cox–de Boor, by the recursion of the textbook.
    fn basis(i: usize, degree: usize, knots: &[f64], t: f64) -> f64 {
        if degree == 0 {
            return f64::from(knots[i] <= t && t < knots[i + 1]);
        }
        let share = |low: f64, high: f64, x: f64| if high > low { x / (high - low) } else { 0.0 };
        share(knots[i], knots[i + degree], t - knots[i]) * basis(i, degree - 1, knots, t)
            + share(knots[i + 1], knots[i + degree + 1], knots[i + degree + 1] - t) * basis(i + 1, degree - 1, knots, t)
    }
    let q = points(&[(0., 0.), (0.1, 0.5), (0.4, 0.7), (0.7, 0.2), (1., 0.4), (1.1, 1.), (0.6, 1.2)]);
    let w = [1.0, 0.5, 2.0, 1.0, 3.0, 0.7, 1.0];
    for degree in 1..=5 {
        for knots in [
            (0..7 + degree + 1).map(|i| i as f64).collect::<Vec<f64>>(),
            (0..7 + degree + 1).map(|i| (i.clamp(degree, 7) - degree) as f64).collect(),
            (0..7 + degree + 1).map(|i| (i / 2) as f64).collect(),
        ] {
            for weights in [None, Some(&w[..])] {
                let Ok(curve) = Curve::nurbs(degree, &knots, &q, weights) else {
                    assert_eq!(degree, 1, "only degree 1 cannot have double knots");
                    continue;
                };
                let (low, high) = (knots[degree], knots[7]);
                for s in grid(37, 0.0, 0.999) {
                    let t = low + s * (high - low);
                    let (mut sum, mut total) = (Vec2::ZERO, 0.0);
                    for i in 0..7 {
                        let b = basis(i, degree, &knots, t) * weights.map_or(1.0, |w| w[i]);
                        sum += q[i].to_vec2() * b;
                        total += b;
                    }
                    let off = (curve.point(s) - (sum / total).to_point()).hypot();
                    assert!(off < 4e-15, "degree {degree}, {knots:?} at {s}: off by {off:e}");
                }
            }
        }
    }
}

#[test]
fn scaling_by_a_power_of_two_scales_every_answer_exactly() {
    for (name, curve) in samples() {
        for factor in [2f64.powi(40), 2f64.powi(-40)] {
            let big = curve.scaled(factor);
            let same = |a: f64, b: f64, what: &str| assert_eq!(a.to_bits(), b.to_bits(), "{name}: {what}: {a} {b}");
            let q = p(0.31, -0.22);
            for t in grid(13, 0.0, 1.0) {
                assert_eq!(squinch::geometry::scaled(curve.point(t), factor), big.point(t), "{name} at {t}");
                assert_eq!(curve.derivative(t) * factor, big.derivative(t), "{name} at {t}");
            }
            assert_eq!(curve.part(0.2, 0.6).scaled(factor), big.part(0.2, 0.6), "{name}");
            same(
                curve.nearest(q, 0.0, 1.0).0,
                big.nearest(squinch::geometry::scaled(q, factor), 0.0, 1.0).0,
                "nearest",
            );
            same(curve.turning(0.1, 0.9), big.turning(0.1, 0.9), "turning");
            same(curve.lens_angle(0.1, 0.9), big.lens_angle(0.1, 0.9), "lens angle");
            same(curve.chord_error(0.1, 0.9) * factor, big.chord_error(0.1, 0.9), "chord error");
            same(curve.length() * factor, big.length(), "length");
            same(
                curve.signed_area(q) * factor * factor,
                big.signed_area(squinch::geometry::scaled(q, factor)),
                "green",
            );
            same(curve.bisector_crossing(0.1, 0.9), big.bisector_crossing(0.1, 0.9), "bisector");
            let leaves = |c: &Curve, r: f64| c.leaves_ball(End::Start, r, 0.0, 1.0).unwrap_or(2.0);
            same(leaves(&curve, 0.3), leaves(&big, 0.3 * factor), "leaves");
            assert_eq!(curve.cuts_of_turning(0.3), big.cuts_of_turning(0.3), "{name}");
            assert_eq!(curve.breaks(), big.breaks(), "{name}");
            let direction = Vec2::new(0.6, 0.7);
            let crossings = |c: &Curve, k: f64| c.line_crossings(p(0.4 * k, 0.1 * k), direction, 0.0, 1.0);
            assert_eq!(crossings(&curve, 1.0), crossings(&big, factor), "{name}");
        }
    }
    let q = points(&[(0., 0.), (0.2, 0.4), (0.5, 0.1), (0.6, 0.6), (1., 0.5)]);
    let big: Vec<Point> = q.iter().map(|v| squinch::geometry::scaled(*v, 8.0)).collect();
    assert_eq!(Curve::natural_spline(&q).unwrap().scaled(8.0), Curve::natural_spline(&big).unwrap());
    assert_eq!(Curve::periodic_spline(&q).unwrap().scaled(8.0), Curve::periodic_spline(&big).unwrap());
}

#[test]
fn affine_images_keep_the_points() {
    let maps = [
        Affine::rotate(0.7) * Affine::scale(3.0),
        Affine::FLIP_Y * Affine::rotate(-2.0),
        Affine::new([1.0, 0.3, -0.8, 0.5, 2.0, -1.0]),
    ];
    for (name, curve) in samples() {
        for map in maps {
            let image = curve.transformed(map);
            let kind = match curve.kind() {
                "arc" if map == maps[2] => "ellipse",
                "clothoid" if map == maps[2] => "spline",
                kind => kind,
            };
            assert_eq!(image.kind(), kind, "{name}");
            for t in grid(20, 0.0, 1.0) {
                let off = (image.point(t) - map * curve.point(t)).hypot();
                assert!(off < 1e-14, "{name} at {t}: off by {off:e}");
            }
        }
    }
}

#[test]
fn flat_arcs_are_as_exact_as_their_ends() {
    for bulge in [1e-3, 1e-6, 1e-9, 1e-12, 1e-200] {
        let arc = Curve::bulge(p(0., 0.), p(1., 0.), bulge).unwrap();
        // bulge = 2·height/chord; a positive one passes below, left to right.
        let middle = arc.point(0.5);
        assert!(
            (middle.x - 0.5).abs() < 1e-15 && (middle.y + 0.5 * bulge).abs() < 1e-15 * bulge,
            "{bulge}: {middle:?}"
        );
        let (t, distance) = arc.nearest(p(0.3, -1.0), 0.0, 1.0);
        assert!((t - 0.3).abs() < 1e-2 && distance <= (arc.point(0.3) - p(0.3, -1.0)).hypot(), "{bulge}: {t}");
        let crossing = arc.line_crossings(p(0.3, -1.0), Vec2::new(0.0, 1.0), 0.0, 1.0);
        assert!(crossing.len() == 1 && (arc.point(crossing[0]).x - 0.3).abs() < 1e-15, "{bulge}: {crossing:?}");
    }
}

#[test]
fn constructors_refuse_what_is_no_curve() {
    let (o, q) = (Point::ZERO, p(1., 0.));
    let (u, v) = (Vec2::new(1., 0.), Vec2::new(0., 1.));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let b = p(bad, 0.0);
        assert!(Curve::line(o, b).is_err() && Curve::line(b, o).is_err());
        assert!(Curve::circle(b, 1.0).is_err() && Curve::circle(o, bad).is_err());
        assert!(Curve::arc(o, 1.0, bad, 1.0).is_err() && Curve::arc(o, 1.0, 0.0, bad).is_err());
        assert!(Curve::bulge(o, b, 1.0).is_err() && Curve::bulge(o, q, bad).is_err());
        assert!(Curve::arc_through(o, b, q).is_err() && Curve::arc_through(b, o, b).is_err());
        assert!(Curve::ellipse(b, u, v, 0.0, 1.0).is_err() && Curve::ellipse(o, u * bad, v, 0.0, 1.0).is_err());
        assert!(Curve::ellipse(o, u, v, bad, 1.0).is_err() && Curve::ellipse(o, u, v, 0.0, bad).is_err());
        assert!(Curve::bezier(vec![o, b]).is_err() && Curve::rational_bezier(vec![o, q], vec![1.0, bad]).is_err());
        assert!(Curve::nurbs(1, &[0., 0., 1., 1.], &[o, b], None).is_err());
        assert!(Curve::nurbs(1, &[0., 0., 1., bad], &[o, q], None).is_err());
        assert!(Curve::nurbs(1, &[0., 0., 1., 1.], &[o, q], Some(&[bad, 1.0])).is_err());
        assert!(Curve::clothoid(b, 0.0, [0.0, 1.0], 1.0).is_err() && Curve::clothoid(o, bad, [0.0, 1.0], 1.0).is_err());
        assert!(Curve::clothoid(o, 0.0, [bad, 1.0], 1.0).is_err() && Curve::clothoid(o, 0.0, [0.0, 1.0], bad).is_err());
        assert!(Curve::natural_spline(&[o, b]).is_err() && Curve::periodic_spline(&[o, q, b]).is_err());
    }
    assert!(Curve::circle(o, 0.0).is_err() && Curve::circle(o, -1.0).is_err());
    assert!(Curve::arc(o, 1.0, 0.0, 0.0).is_err() && Curve::arc(o, 1.0, 0.0, 7.0).is_err());
    assert!(Curve::ellipse(o, u, u, 0.0, 1.0).is_err());
    assert!(Curve::clothoid(o, 0.0, [0.0, 1.0], 0.0).is_err() && Curve::clothoid(o, 0.0, [0.0, 1.0], -1.0).is_err());
    assert!(Curve::clothoid(o, 0.0, [0.0, 1300.0], 1.0).is_err(), "103 times around");
    assert!(Curve::clothoid(o, 0.0, [1e200, -1e200], 1e200).is_err());
    assert!(Curve::clothoid(p(f64::MAX, 0.0), 0.0, [0.0, 0.0], f64::MAX).is_err());
    assert!(Curve::bezier(vec![o]).is_err() && Curve::bezier(vec![]).is_err());
    assert!(Curve::rational_bezier(vec![o, q], vec![1.0, 0.0]).is_err());
    assert!(Curve::rational_bezier(vec![o, q], vec![1.0]).is_err());
    assert!(Curve::nurbs(1, &[0., 1., 0., 1.], &[o, q], None).is_err());
    assert!(Curve::nurbs(1, &[0., 0., 0., 0.], &[o, q], None).is_err());
    assert!(Curve::nurbs(0, &[0., 1.], &[o], None).is_err() && Curve::nurbs(2, &[0.; 5], &[o, q], None).is_err());
    assert!(Curve::nurbs(2, &[0., 1., 1.], &[o, q], None).is_err());
    assert!(Curve::nurbs(1, &[0., 0., 1., 1., 2., 2.], &[o, q, p(2., 2.), o], None).is_err(), "a gap");
    assert!(Curve::arc_through(o, p(2., 0.), q).is_err() && Curve::arc_through(o, o, o).is_err());
}

/// Every question at once; the answers need not make sense, but must come.
fn ask_everything(curve: &Curve, q: Point) {
    let (t0, t1) = (0.25, 0.75);
    for c in [curve.clone(), curve.part(t0, t1), curve.reversed(), curve.with_ends(q, q)] {
        std::hint::black_box((
            c.kind(),
            c.bounds(),
            c.length(),
            c.nearest(q, t0, t1),
            c.signed_area(q),
            c.turning(0.0, 1.0),
            c.breaks(),
            c.inflections(),
            c.cuts_of_turning(0.5),
            (c.lens_angle(t0, t1), c.chord_error(t0, t1), c.bisector_crossing(t0, t1)),
            c.line_crossings(q, Vec2::new(q.y, 1.0), t0, t1),
            (c.leaves_ball(End::Start, q.x.abs(), t0, t1), c.leaves_ball(End::Finish, 1.0, t0, t1)),
        ));
        for t in [0.0, 0.3, 1.0] {
            std::hint::black_box((
                c.tangent(t, End::Start),
                c.tangent(t, End::Finish),
                c.curvature(t),
                c.is_straight(),
            ));
        }
    }
}

/// Any finite number, most of them plain; also huge, tiny and equal ones.
fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..2.0f64,
        2 => (-3i8..4).prop_map(f64::from),
        1 => prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
    ]
}

fn wild_point() -> impl Strategy<Value = Point> {
    (wild(), wild()).prop_map(|(x, y)| p(x, y))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_finite_input_brings_a_question_down(
        q in prop::collection::vec(wild_point(), 2..8),
        numbers in prop::collection::vec(wild(), 8),
    ) {
        let n = q.len();
        let weights: Vec<f64> = numbers[..n].iter().map(|w| w.abs()).collect();
        let mut knots: Vec<f64> = numbers.iter().copied().chain(numbers.iter().copied()).take(n + 3).collect();
        knots.sort_by(f64::total_cmp);
        let vector = q[1].to_vec2();
        let curves = [
            Curve::line(q[0], q[1]),
            Curve::circle(q[0], numbers[0]),
            Curve::arc(q[0], numbers[0].abs(), numbers[1], numbers[2]),
            Curve::bulge(q[0], q[1], numbers[0]),
            Curve::arc_through(q[0], q[1], q[n - 1]),
            Curve::ellipse(q[0], vector, Vec2::new(numbers[0], numbers[1]), numbers[2], numbers[3]),
            Curve::bezier(q.clone()),
            Curve::rational_bezier(q.clone(), weights.clone()),
            Curve::nurbs(2, &knots, &q, Some(&weights)),
            Curve::nurbs(2, &knots, &q, None),
            Curve::natural_spline(&q),
            Curve::periodic_spline(&q),
            Curve::clothoid(q[0], numbers[0], [numbers[1], numbers[2]], numbers[3].abs()),
        ];
        for curve in curves.into_iter().flatten() {
            prop_assert!(curve.start().is_finite() && curve.end().is_finite());
            ask_everything(&curve, p(numbers[4], numbers[5]));
        }
    }

    #[test]
    fn plain_cubics_keep_the_laws(q in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 4), x in -1.0..1.0f64, y in -1.0..1.0f64) {
        let curve = bezier(&q);
        let at = p(x, y);
        let (t, distance) = curve.nearest(at, 0.0, 1.0);
        let sampled = grid(200, 0.0, 1.0).map(|t| (curve.point(t) - at).hypot()).fold(f64::INFINITY, f64::min);
        prop_assert!(distance <= sampled + 1e-15 && (0.0..=1.0).contains(&t));
        for pair in [0.0].into_iter().chain(curve.cuts_of_turning(0.5)).chain([1.0]).collect::<Vec<f64>>().windows(2) {
            prop_assert!(curve.turning(pair[0], pair[1]) <= 0.5 + 1e-9);
        }
        prop_assert!(curve.inflections().len() <= 2 && curve.turning(0.0, 1.0) <= 3.0 * PI);
    }
}

#[test]
fn outlines_hold_every_kind_to_the_last_bit() {
    for (name, curve) in samples() {
        let mut drawing = Drawing::default();
        drawing.add(curve, "rim", name.to_owned());
        let text = outline::to_json(&drawing);
        let again = outline::read(text.as_bytes(), "sample").unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(again.curves[0].curve, drawing.curves[0].curve, "{name}");
    }
}
