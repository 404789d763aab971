//! The clothoid against what is known of it: Fresnel's integrals, slow quadrature, and drawings that hold some.
//!
//! The laws of all kinds of curves: `curve_conformance.rs`.

use squinch::curve::{Curve, End, MeetingKind, meetings, self_meetings};
use squinch::domain::{ArrangeOptions, Drawing, DrawnCurve};
use squinch::geometry::{Point, Vec2};
use squinch::import::outline;
use squinch::run::request::{Engine, Order, Request};
use squinch::run::{Exit, Extent, Source, run};
use squinch::size::Limits;
use squinch::watch::no_clock;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn clothoid(start: Point, heading_rad: f64, curvatures: [f64; 2], length: f64) -> Curve {
    Curve::clothoid(start, heading_rad, curvatures, length).unwrap()
}

/// ∫ f over 0..to by Simpson's rule on so many steps: slow, and of another family than what is tested. The rounding of
/// each sum is carried on.
fn simpson(f: impl Fn(f64) -> Vec2, to: f64, steps: u32) -> Vec2 {
    let h = to / f64::from(steps);
    let (mut sum, mut lost) = (Vec2::ZERO, Vec2::ZERO);
    for k in 0..steps {
        let a = f64::from(k) * h;
        let term = (f(a) + f(a + 0.5 * h) * 4.0 + f(a + h)) * (h / 6.0) + lost;
        let next = sum + term;
        lost = term - (next - sum);
        sum = next;
    }
    sum
}

/// The point at the share t, by Simpson's rule: its error is (step · curvature)⁴/2880 of the radius, below 1e-17.
fn slow_point(start: Point, heading: f64, [k0, k1]: [f64; 2], length: f64, t: f64) -> Point {
    let tangent = |s: f64| {
        let angle = heading + k0 * s + (k1 - k0) * s * s / (2.0 * length);
        Vec2::new(angle.cos(), angle.sin())
    };
    let steps = (5000.0 * length * (1.0 + k0.abs().max(k1.abs()))) as u32;
    start + simpson(tangent, length * t, steps.max(1000))
}

#[test]
fn fresnel_integrals_have_their_known_values() {
    // C(x) and S(x) of ∫cos(πu²/2) and ∫sin(πu²/2): Abramowitz & Stegun, table 7.7, to more digits.
    for (x, c, s) in [
        (0.5, 0.492_344_225_871_446_4, 0.064_732_432_859_999_28),
        (1.0, 0.779_893_400_376_822_8, 0.438_259_147_390_354_8),
        (1.5, 0.445_261_176_039_821_55, 0.697_504_960_082_093),
        (2.0, 0.488_253_406_075_340_73, 0.343_415_678_363_698_25),
        (5.0, 0.563_631_188_704_012_2, 0.499_191_381_917_116_87),
    ] {
        let end = clothoid(Point::ZERO, 0.0, [0.0, PI * x], x).end();
        assert!((end.x - c).abs() <= 1e-15 && (end.y - s).abs() <= 1e-15, "{x}: {end:?}, not ({c}, {s})");
    }
}

#[test]
fn points_are_those_of_slow_quadrature() {
    let half = (13.0 * SQRT_2, 7.0);
    for (curvatures, length) in [
        ([0.0, 2.5], 1.2),
        ([-3.0, 4.0], 1.3),
        ([2.0, 14.0], 2.5),
        ([-30.0, 20.0], 2.0),
        ([1e-8, 3e-8], 1.0),
        ([1.4, 1.4000001], 1.5),
        ([half.0, -half.1], 1.7),
        ([0.005, 0.0], 120.0),
        ([3.0, 3.0], 2.0),
        ([3.0, 3.0001], 20.0),
    ] {
        let (start, heading) = (p(0.3, -0.4), 0.7);
        let curve = clothoid(start, heading, curvatures, length);
        for k in 0..=24 {
            let t = f64::from(k) / 24.0;
            let off = curve.point(t).distance(slow_point(start, heading, curvatures, length, t));
            // A few roundings of the length, and those of the sum that it is compared with.
            assert!(off <= 3.0 * f64::EPSILON * (length + 1.0), "{curvatures:?} at {t}: off by {off:e}");
        }
    }
}

#[test]
fn many_turns_stay_as_exact_and_too_many_are_refused() {
    let (curvatures, length) = ([600.0, 620.0], 1.0);
    let curve = clothoid(p(0.0, 0.0), 0.0, curvatures, length);
    assert!((curve.turning(0.0, 1.0) / TAU - 97.0).abs() < 0.2);
    for t in [0.1, 0.37, 0.5, 0.93, 1.0] {
        let off = curve.point(t).distance(slow_point(Point::ZERO, 0.0, curvatures, length, t));
        // The heading is good for 600 · ε: over a turn, a hundredth of the length, that is some more roundings of it.
        assert!(off <= 8.0 * f64::EPSILON * length, "{t}: {off:e}");
    }
    assert_eq!(curve.cuts_of_turning(0.5).len() + 1, curve.parts_of_turning(0.5));
    assert!(Curve::clothoid(Point::ZERO, 0.0, [1.0, 1.0], TAU).is_ok());
    assert!(Curve::clothoid(Point::ZERO, 0.0, [1.0, 1.0], 1.5 * TAU).is_err(), "along itself");
    let error = Curve::clothoid(Point::ZERO, 0.0, [600.0, 700.0], 1.0).unwrap_err();
    assert!(error.to_string().contains("times around"), "{error}");
}

#[test]
fn closed_forms_are_those_of_the_definition() {
    let curve = clothoid(p(1.0, 2.0), 0.5, [-3.0, 4.0], 1.4);
    assert_eq!(curve.inflections(), [3.0 / 7.0]);
    // Two triangles below the curvature.
    let turning = 0.5 * (3.0 * 3.0 / 7.0 + 4.0 * 4.0 / 7.0) * 1.4;
    assert!((curve.turning(0.0, 1.0) - turning).abs() < 1e-15);
    assert!((curve.length() - 1.4).abs() < 1e-15 && (curve.length_of(0.25, 0.5) - 0.35).abs() < 1e-15);
    for t in [0.0, 0.2, 3.0 / 7.0, 0.9, 1.0] {
        assert!((curve.curvature(t) - (7.0 * t - 3.0)).abs() < 1e-14, "{t}");
        let heading = 0.5 + 1.4 * (-3.0 * t + 3.5 * t * t);
        assert!((curve.tangent(t, End::Start) - Vec2::new(heading.cos(), heading.sin())).hypot() < 1e-15, "{t}");
    }
    // Cut at the inflection, each side bends one way, to the end.
    for part in [curve.part(0.0, 3.0 / 7.0), curve.part(3.0 / 7.0, 1.0)] {
        assert!(part.inflections().is_empty(), "{part:?}");
    }
    // Of no curvature, and of an even one.
    let line = clothoid(p(1.0, 2.0), 0.5, [0.0, 0.0], 3.0);
    assert!(line.is_straight() && line.turning(0.0, 1.0) == 0.0 && line.cuts_of_turning(0.1).is_empty());
    assert!(line.inflections().is_empty());
    let arc = clothoid(p(1.0, 0.0), FRAC_PI_2, [1.0, 1.0], PI);
    for t in [0.1, 0.5, 0.8, 1.0] {
        assert!(arc.point(t).distance(p((PI * t).cos(), (PI * t).sin())) < 1e-15);
    }
}

#[test]
fn areas_are_those_of_slow_quadrature() {
    for (curvatures, length) in [([0.0, 2.5], 1.2), ([-3.0, 4.0], 1.3), ([2.0, 14.0], 2.5), ([0.02, -0.01], 90.0)] {
        let heading = 0.3;
        let curve = clothoid(Point::ZERO, heading, curvatures, length);
        // ½∫ P × P′, with P carried along by steps of Simpson's rule.
        let tangent = |s: f64| {
            let angle = heading + curvatures[0] * s + (curvatures[1] - curvatures[0]) * s * s / (2.0 * length);
            Vec2::new(angle.cos(), angle.sin())
        };
        let steps = 20_000;
        let h = length / f64::from(steps);
        let (mut at, mut area) = (Vec2::ZERO, 0.0);
        for k in 0..steps {
            let s = f64::from(k) * h;
            let run = |share: f64| {
                let (a, b, c) = (tangent(s), tangent(s + 0.5 * share * h), tangent(s + share * h));
                (a + b * 4.0 + c) * (share * h / 6.0)
            };
            let rate = |share: f64| (at + run(share)).cross(tangent(s + share * h));
            area += 0.5 * (rate(0.0) + 4.0 * rate(0.5) + rate(1.0)) * (h / 6.0);
            at += run(1.0);
        }
        let found = curve.signed_area(Point::ZERO);
        assert!((found - area).abs() <= 1e-12 * area.abs(), "{curvatures:?}: {found}, not {area}");
    }
}

#[test]
fn images_are_clothoids_under_similarities_and_splines_else() {
    let curve = clothoid(p(0.2, 0.1), 0.4, [-1.0, 3.0], 1.5);
    let mirrored = curve.transformed(kurbo::Affine::FLIP_X * kurbo::Affine::scale(2.0));
    let Curve::Clothoid(image) = &mirrored else { panic!("{mirrored:?}") };
    assert_eq!((image.curvatures(), image.length()), ([0.5, -1.5], 3.0));
    assert!((image.heading_rad().cos() + 0.4f64.cos()).abs() < 1e-15);
    let skewed = curve.transformed(kurbo::Affine::new([1.0, 0.3, -0.8, 0.5, 2.0, -1.0]));
    assert_eq!(skewed.kind(), "spline");
    // Welded by a little it is a clothoid of another heading and length; closed, it is a spline.
    let welded = curve.with_ends(curve.start() + Vec2::new(1e-9, 0.0), curve.end());
    assert_eq!(welded.kind(), "clothoid");
    assert_eq!(curve.with_ends(curve.start(), curve.start()).kind(), "spline");
}

#[test]
fn clothoids_meet_lines_arcs_beziers_and_each_other() {
    let spiral = clothoid(p(-1.0, 0.0), 0.5, [-3.0, 4.0], 2.5);
    let others = [
        Curve::line(p(-1.0, -0.05), p(1.5, 0.3)).unwrap(),
        Curve::circle(p(0.2, 0.3), 0.5).unwrap(),
        Curve::ellipse(p(0.0, 0.2), Vec2::new(0.8, 0.1), Vec2::new(-0.1, 0.4), 0.0, TAU).unwrap(),
        Curve::bezier(vec![p(-1.0, 0.5), p(0.0, -1.5), p(0.5, 1.5), p(1.0, -0.5)]).unwrap(),
        Curve::natural_spline(&[p(-1.0, 0.4), p(-0.2, -0.2), p(0.4, 0.5), p(1.0, -0.3)]).unwrap(),
        clothoid(p(-1.0, 0.3), -0.9, [2.0, -3.0], 2.5),
        clothoid(p(0.3, 0.2), 0.0, [2.0, 9.0], 3.0),
    ];
    let mut crossings = 0;
    for other in &others {
        let found = meetings(&spiral, other, 1e-10).unwrap();
        assert!(found.overlaps.is_empty(), "{found:?}");
        for m in &found.points {
            assert!(spiral.point(m.t).distance(other.point(m.u)) <= 1e-10, "{m:?}");
            crossings += usize::from(m.kind == MeetingKind::Crossing);
        }
        // Every crossing that a fine polyline of either shows.
        let polyline = |c: &Curve| (0..=2000).map(|k| c.point(f64::from(k) / 2000.0)).collect::<Vec<_>>();
        let (a, b) = (polyline(&spiral), polyline(other));
        let side = |l: &[Point], q: Point| (l[1] - l[0]).cross(q - l[0]) > 0.0;
        let cross = |l: &[Point], m: &[Point]| side(l, m[0]) != side(l, m[1]) && side(m, l[0]) != side(m, l[1]);
        let seen = a.windows(2).map(|l| b.windows(2).filter(|m| cross(l, m)).count()).sum::<usize>();
        assert_eq!(found.points.len(), seen, "{} {found:?}", other.kind());
    }
    assert!(crossings >= 7, "{crossings}");
    // A part lies on the whole.
    let part = spiral.part(0.3, 0.7);
    let shared = meetings(&spiral, &part, 1e-10).unwrap();
    assert_eq!(shared.overlaps.len(), 1, "{shared:?}");
    let [t, u] = [shared.overlaps[0].t, shared.overlaps[0].u];
    assert!((t[0] - 0.3).abs() < 1e-9 && (t[1] - 0.7).abs() < 1e-9 && u == [0.0, 1.0], "{shared:?}");
    // Tangent to a line at its start, and to the circle that it ends in.
    let transition = clothoid(p(0.0, 0.0), 0.0, [0.0, 0.5], 2.0);
    let line = Curve::line(p(-2.0, 0.0), p(0.0, 0.0)).unwrap();
    let touching = meetings(&line, &transition, 1e-10).unwrap();
    assert_eq!((touching.points.len(), touching.overlaps.len()), (1, 0), "{touching:?}");
    assert_eq!((touching.points[0].t, touching.points[0].u), (1.0, 0.0));
}

#[test]
fn a_clothoid_meets_itself_only_where_its_turns_run_together() {
    let spiral = clothoid(p(0.0, 0.0), 0.0, [2.0, 14.0], 4.0);
    assert!(self_meetings(&spiral, 1e-9).unwrap().is_empty());
    let double = clothoid(p(0.0, 0.0), 0.5, [-12.0, 9.0], 3.0);
    assert!(self_meetings(&double, 1e-9).unwrap().is_empty());
    // One and a half times around one circle, nearly.
    let wound = clothoid(p(0.0, 0.0), 0.0, [1.0, 1.0 + 1e-12], 1.5 * TAU);
    assert!(!self_meetings(&wound, 1e-9).unwrap().is_empty());
}

fn read(text: &str) -> Drawing {
    outline::read(text.as_bytes(), "stem").unwrap_or_else(|e| panic!("{e}"))
}

fn entry(clothoid: &str) -> String {
    format!("{{ \"squinch\": 1, \"curves\": [{{ \"clothoid\": {clothoid} }}] }}")
}

#[test]
fn outlines_hold_clothoids_to_the_last_bit() {
    let by_degrees = read(&entry(r#"{ "from": [1, 2], "heading_deg": 90, "curvature": [0, 0.5], "length": 3 }"#));
    let by_radians =
        read(&entry(r#"{ "from": [1, 2], "heading_rad": 1.5707963267948966, "curvature": [0, 0.5], "length": 3 }"#));
    assert_eq!(by_degrees.curves, by_radians.curves);
    let again = |drawing: &Drawing| read(&outline::to_json(drawing));
    let mut drawing = by_degrees;
    let third = 1.0 / 3.0;
    for step in 0..6 {
        let text = outline::to_json(&drawing);
        assert!(text.contains("\"clothoid\""), "{text}");
        assert_eq!(again(&drawing).curves[0].curve, drawing.curves[0].curve, "{step}: {text}");
        let curve = &drawing.curves[0].curve;
        let next = match step {
            0 => curve.part(0.1, third),
            1 => curve.reversed(),
            2 => curve.with_ends(curve.start() + Vec2::new(1e-9, 2e-9), curve.end()),
            3 => curve.transformed(kurbo::Affine::rotate(third) * kurbo::Affine::FLIP_Y * kurbo::Affine::scale(1e-7)),
            _ => curve.transformed(kurbo::Affine::translate((3.0, -7.0)) * kurbo::Affine::rotate(2.0)),
        };
        drawing.curves[0].curve = next;
    }
}

#[test]
fn a_written_end_is_taken_and_a_wrong_one_refused() {
    let with = |to: &str| {
        entry(&format!(r#"{{ "from": [0, 0], "heading_deg": 0, "curvature": [0, 0.01], "length": 50, "to": {to} }}"#))
    };
    let exact = clothoid(Point::ZERO, 0.0, [0.0, 0.01], 50.0).end();
    let written = format!("[{:.5}, {:.5}]", exact.x, exact.y);
    let drawing = read(&with(&written));
    let curve = &drawing.curves[0].curve;
    assert_eq!((curve.kind(), format!("[{:.5}, {:.5}]", curve.end().x, curve.end().y)), ("clothoid", written));
    assert!(curve.end() != exact && curve.end().distance(exact) < 1e-5);
    let refused = |text: &str| outline::read(text.as_bytes(), "stem").unwrap_err().to_string();
    assert!(refused(&with("[49.7, 4.1]")).contains("`to` does not lie"));
    let no_heading = entry(r#"{ "from": [0, 0], "curvature": [0, 0.01], "length": 50 }"#);
    assert!(refused(&no_heading).contains("needs `heading_deg` or `heading_rad`"));
    let no_length = entry(r#"{ "from": [0, 0], "heading_deg": 0, "curvature": [0, 1], "length": 0 }"#);
    assert!(refused(&no_length).contains("the length 0 is not positive"));
}

#[test]
fn a_drawing_of_clothoids_that_cross_is_arranged() {
    let mut drawing = Drawing { format: "test".into(), ..Drawing::default() };
    let name = drawing.names.intern("boundary");
    let mut add = |curve: Curve| {
        let entity = format!("curve {}", drawing.curves.len());
        drawing.curves.push(DrawnCurve::new(curve, name, entity));
    };
    // A closed loop of two mirror images, crossed by an S, a line and a spiral.
    let half = clothoid(p(0.0, 0.0), 0.9, [-1.5, -0.5], 2.0);
    let chord = half.end() - half.start();
    let mirror = kurbo::Affine::rotate(chord.atan2()) * kurbo::Affine::FLIP_Y * kurbo::Affine::rotate(-chord.atan2());
    add(half.transformed(mirror));
    add(half);
    add(clothoid(p(0.3, -1.0), 1.2, [-3.0, 4.0], 2.5));
    add(clothoid(p(0.8, 0.0), 0.0, [3.0, 14.0], 2.0));
    add(Curve::line(p(-0.5, 0.2), p(2.5, 0.1)).unwrap());
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    assert_eq!(domain.flaws(), Vec::<String>::new());
    assert!(domain.regions().len() > 4, "{}", domain.regions().len());
}

/// The area of `samples/transition.json`, by quadrature to 20 digits.
const LOOP_AREA: f64 = 2_296.975_761_656_415;

#[test]
fn the_railway_loop_is_meshed_and_every_guarantee_holds() {
    let bytes = std::fs::read("samples/transition.json").unwrap();
    let source = Source { path: "transition.json", bytes: &bytes, format: None, nodes: None, of_many: false };
    for (engine, order, max_edge) in [
        (Engine::Lop, Order::First, None),
        (Engine::Gcdr, Order::First, None),
        (Engine::Lop, Order::Second, None),
        (Engine::Gcdr, Order::Second, Some(1.5)),
    ] {
        let limits = Limits { max_edge, ..Limits::default() };
        let request = Request { engine, order, limits, ..Request::default() };
        let outcome = run(&source, &request, Extent::Whole(&mut |_| true), &no_clock);
        assert_eq!(outcome.exit, Exit::Done, "{engine:?} {order:?}: {:#?}", outcome.report);
        let verdict = outcome.verdict.unwrap();
        assert!(verdict.kept() && verdict.exempt.is_empty(), "{engine:?} {order:?}");
        let domain = outcome.domain.unwrap();
        assert_eq!(domain.flaws(), Vec::<String>::new());
        assert!(domain.curves().iter().any(|c| c.curve.kind() == "clothoid"));
        // Each region is its boundary's integral, once around.
        let drawn: f64 = domain
            .curves()
            .iter()
            .filter(|c| domain.names().text(c.name) != "joint")
            .map(|c| {
                c.curve.signed_area(Point::ZERO).abs()
                    * if domain.names().text(c.name) == "rail side" { 1.0 } else { -1.0 }
            })
            .sum();
        assert!((drawn - LOOP_AREA).abs() <= 1e-12 * LOOP_AREA, "{drawn}");
    }
}
