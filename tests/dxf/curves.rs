//! Entities that are curves, each in its own kind.

use super::*;
use squinch::options::Switch;

#[test]
fn a_line_is_named_by_its_layer_and_says_where_it_stands() {
    let drawing = drawn("0 LINE; 5 2F; 8 rim; 10 1.5; 11 2; 20 -0.25; 21 3D0; 30 0; 31 0");
    assert_eq!(*only(&drawing), Curve::line(Point::new(1.5, -0.25), Point::new(2.0, 3.0)).unwrap());
    assert_eq!(names(&drawing), ["rim"]);
    assert_eq!(drawing.curves[0].entity, "LINE (handle 2F, line 6)");
    assert_eq!((drawing.format.as_str(), drawing.title.as_str()), ("dxf (no version)", "stem"));
    assert_eq!(drawing.fill, FillRule::EvenOdd);
}

#[test]
fn circles_and_arcs_stay_arcs() {
    let circle = drawn("0 CIRCLE; 10 1; 20 2; 40 0.5");
    assert_eq!(*only(&circle), Curve::circle(Point::new(1.0, 2.0), 0.5).unwrap());
    assert_eq!(names(&circle), ["0"]);
    let arc = drawn("0 ARC; 10 0; 20 0; 40 2; 50 270; 51 90");
    let Curve::Arc(over_zero) = only(&arc) else { panic!("no arc") };
    near(over_zero.sweep_rad, PI);
    near_point(over_zero.ends[0], (0.0, -2.0));
    near_point(over_zero.ends[1], (0.0, 2.0));
    for full in ["50 0; 51 360", "50 30; 51 30", "50 0; 51 359.999999", "50 -90; 51 270"] {
        let drawing = drawn(&format!("0 ARC; 10 0; 20 0; 40 2; {full}"));
        near(area(&drawing), 4.0 * PI);
    }
    let none = drawn("0 CIRCLE; 10 0; 20 0; 40 0; 0 CIRCLE; 10 0; 20 0; 40 -1");
    assert_eq!(skipped(&none), [("CIRCLE", 2, "of no extent")]);
}

#[test]
fn an_entity_seen_from_below_is_mirrored() {
    let arc = drawn("0 ARC; 10 5; 20 1; 30 3; 40 2; 50 0; 51 90; 210 0; 220 0; 230 -1");
    let Curve::Arc(arc) = only(&arc) else { panic!("no arc") };
    near_point(arc.center, (-5.0, 1.0));
    near_point(arc.ends[0], (-7.0, 1.0));
    near_point(arc.ends[1], (-5.0, 3.0));
    near(arc.sweep_rad, -FRAC_PI_2);
    let polyline = drawn("0 LWPOLYLINE; 10 1; 20 0; 42 1; 10 3; 20 0; 230 -1; 220 0; 210 0");
    near_point(only(&polyline).point(0.5), (-2.0, -1.0));
    // Those of a line and of a spline are coordinates of the drawing whatever the direction is.
    let line = drawn("0 LINE; 10 1; 20 0; 11 2; 21 0; 210 0; 220 0; 230 -1");
    near_point(only(&line).start(), (1.0, 0.0));
}

#[test]
fn what_is_tilted_is_left_out_and_counted() {
    let tilted = "210 1; 220 0; 230 0";
    let drawing = drawn(&format!(
        "0 CIRCLE; 10 0; 20 0; 40 1; {tilted}; {SQUARE}; {tilted}; 0 LINE; 10 0; 20 0; 11 1; 21 0; 31 1;
         0 ELLIPSE; 10 0; 20 0; 11 1; 21 0; 31 1; 40 1; 0 INSERT; 2 B; 10 0; 20 0; {tilted}; 0 POINT; 10 0; 20 0"
    ));
    let why = "not parallel to the XY plane";
    let expected = ["CIRCLE", "ELLIPSE", "INSERT", "LINE", "LWPOLYLINE"].map(|kind| (kind, 1, why));
    assert_eq!(skipped(&drawing), expected);
    assert!(drawing.curves.is_empty());
}

#[test]
fn heights_are_dropped_and_said() {
    let drawing = drawn("0 CIRCLE; 10 0; 20 0; 30 2; 40 1; 0 LINE; 10 0; 20 0; 30 -1; 11 1; 21 0; 31 -1");
    assert!(noted(&drawing, "heights from -1 to 2"), "{:?}", drawing.notes);
    assert!(!noted(&drawn("0 CIRCLE; 10 0; 20 0; 30 2; 40 1"), "heights"));
}

#[test]
fn bulges_are_arcs() {
    let disc = drawn("0 LWPOLYLINE; 70 1; 43 0; 10 -1; 20 0; 42 1; 10 1; 20 0; 42 1");
    assert!(curves(&disc).iter().all(|c| matches!(c, Curve::Arc(_))));
    near(area(&disc), PI);
    assert_eq!(disc.curves[1].entity, "LWPOLYLINE (line 6), segment 2");
    // Open; the bulge of the last vertex starts nothing. Straight where the bulge is a rounding of 0.
    let open = drawn("0 LWPOLYLINE; 10 0; 20 0; 42 1e-17; 10 1; 20 0; 42 -1; 10 1; 20 2; 42 1");
    assert_eq!(curves(&open).iter().map(Curve::kind).collect::<Vec<_>>(), ["line", "arc"]);
    near_point(open.curves[1].curve.point(0.5), (0.0, 1.0));
    // The closing segment of a polyline that ends where it starts is none.
    assert_eq!(drawn("0 LWPOLYLINE; 70 1; 10 0; 20 0; 10 1; 20 0; 10 1; 20 1; 10 0; 20 0").curves.len(), 3);
    assert_eq!(skipped(&drawn("0 LWPOLYLINE; 70 1; 10 0; 20 0")), [("LWPOLYLINE", 1, "of no extent")]);
    assert!(noted(&drawn("0 LWPOLYLINE; 43 0.5; 10 0; 20 0; 10 1; 20 0"), "centre lines"));
}

#[test]
fn old_polylines_have_vertices_of_their_own() {
    let head = "0 POLYLINE; 8 old; 66 1; 10 0; 20 0; 30 0";
    let bulged = drawn(&format!(
        "{head}; 70 1; 0 VERTEX; 8 old; 10 -1; 20 0; 42 1; 0 VERTEX; 8 old; 10 1; 20 0; 42 1; 0 SEQEND; {SQUARE}"
    ));
    near(area(&bulged), PI + 16.0);
    assert_eq!(names(&bulged)[..3], ["old", "old", "rim"]);
    // Fitted by a spline: vertices with the flag 8 are the curve, those with 16 its frame.
    let fitted = drawn(&format!(
        "{head}; 70 4; 0 VERTEX; 10 5; 20 5; 70 16; 0 VERTEX; 10 0; 20 0; 70 8; 0 VERTEX; 10 1; 20 0; 70 8;
         0 VERTEX; 10 9; 20 9; 70 16; 0 VERTEX; 10 1; 20 1; 70 8; 0 SEQEND"
    ));
    assert_eq!(fitted.curves.len(), 2);
    near_point(fitted.curves[1].curve.end(), (1.0, 1.0));
}

#[test]
fn polylines_in_space_are_kept_where_they_are_flat() {
    let vertices = |z: f64| format!("0 VERTEX; 10 0; 20 0; 30 1; 70 32; 0 VERTEX; 10 1; 20 0; 30 {z}; 70 32; 0 SEQEND");
    assert_eq!(drawn(&format!("0 POLYLINE; 70 8; {}", vertices(1.0))).curves.len(), 1);
    let steep = drawn(&format!("0 POLYLINE; 70 8; {}", vertices(2.0)));
    assert_eq!(skipped(&steep), [("POLYLINE", 1, "not parallel to the XY plane")]);
    let corner = |x: i32, y: i32, more: &str| format!("0 VERTEX; 10 {x}; 20 {y}; {more};");
    let corners = |more: &str| [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(x, y)| corner(x, y, more)).concat();
    // Two by two vertices: four edges. Two faces of three corners: the one between them is not shown.
    let grid = drawn(&format!("0 POLYLINE; 70 16; 71 2; 72 2; {} 0 SEQEND", corners("70 64")));
    assert_eq!(grid.curves.len(), 4);
    near(measure(&grid), 1.0);
    let faces =
        "0 VERTEX; 70 128; 71 1; 72 -2; 73 3; 0 VERTEX; 70 128; 71 -3; 72 2; 73 4; 0 VERTEX; 70 128; 71 3; 72 4; 73 -2";
    let polyface = drawn(&format!("0 POLYLINE; 70 64; {} {faces}; 0 SEQEND", corners("70 192")));
    assert_eq!(polyface.curves.len(), 4);
    near(measure(&polyface), 1.0);
    let lost = refused(&plain(&format!("0 POLYLINE; 70 64; {} 0 VERTEX; 70 128; 71 1; 72 5", corners("70 192"))));
    assert!(lost.what.contains("vertex 1 to 5 of 4"), "{lost}");
}

#[test]
fn ellipses_run_by_their_parameters() {
    let full = drawn("0 ELLIPSE; 10 1; 20 2; 11 0; 21 3; 40 0.5; 41 0; 42 6.283185");
    near(area(&full), 4.5 * PI);
    let quarter = drawn("0 ELLIPSE; 10 0; 20 0; 11 4; 21 0; 40 0.5; 41 0; 42 1.5707963267948966");
    near_point(only(&quarter).start(), (4.0, 0.0));
    near_point(only(&quarter).end(), (0.0, 2.0));
    // From 3π/2 to π/2 past 0; from below the minor axis points the other way.
    let right = drawn("0 ELLIPSE; 10 0; 20 0; 11 4; 21 0; 40 0.5; 41 4.71238898038469; 42 1.5707963267948966");
    near_point(only(&right).point(0.5), (4.0, 0.0));
    let below = drawn("0 ELLIPSE; 10 0; 20 0; 11 4; 21 0; 40 0.5; 41 0; 42 1.5707963267948966; 210 0; 220 0; 230 -1");
    near_point(only(&below).end(), (0.0, -2.0));
    assert_eq!(skipped(&drawn("0 ELLIPSE; 10 0; 20 0; 11 4; 21 0; 40 0")), [("ELLIPSE", 1, "of no extent")]);
}

#[test]
fn splines_are_exact() {
    let quarter = drawn(QUARTER);
    assert_eq!(only(&quarter).kind(), "nurbs");
    for i in 0..=8 {
        near(only(&quarter).point(f64::from(i) / 8.0).to_vec2().hypot(), 1.0);
    }
    // Without z, and with weights that say nothing.
    let flat = "0 SPLINE; 70 8; 71 2; 40 0; 40 0; 40 0; 40 1; 40 1; 40 1; 10 0; 20 0; 10 1; 20 2; 10 2; 20 0";
    assert_eq!(only(&drawn(flat)).kind(), "spline");
    near_point(only(&drawn(flat)).point(0.5), (1.0, 1.0));
    let uniform = drawn("0 SPLINE; 71 2; 10 0; 20 0; 10 1; 20 2; 10 2; 20 0");
    assert_eq!(curves(&uniform), curves(&drawn(flat)));
    assert!(noted(&uniform, "without knots"));
}

#[test]
fn a_periodic_spline_may_give_one_period() {
    let control = "10 1; 20 0; 10 0; 20 1; 10 -1; 20 0; 10 0; 20 -1";
    let period = drawn(&format!("0 SPLINE; 70 3; 71 3; 40 0; 40 1; 40 2; 40 3; 40 4; {control}"));
    let knots: String = (-3..=7).map(|k| format!("40 {k};")).collect();
    let wrapped = drawn(&format!("0 SPLINE; 70 3; 71 3; {knots} {control}; 10 1; 20 0; 10 0; 20 1; 10 -1; 20 0"));
    assert_eq!(curves(&period), curves(&wrapped));
    near_point(only(&period).start(), (0.0, 2.0 / 3.0));
    assert_eq!(only(&period).start(), only(&period).end());
}

#[test]
fn splines_through_fit_points() {
    let fit = "11 0; 21 0; 31 0; 11 1; 21 1; 31 0; 11 2; 21 0; 31 0";
    let open = drawn(&format!("0 SPLINE; 70 8; 71 3; 74 3; {fit}"));
    let points = [Point::new(0.0, 0.0), Point::new(1.0, 1.0), Point::new(2.0, 0.0)];
    assert_eq!(*only(&open), Curve::fitted_spline(&points, [None, None]).unwrap());
    assert!(noted(&open, "fit points"));
    let closed = drawn(&format!("0 SPLINE; 70 1; 71 3; 74 3; {fit}"));
    assert_eq!(*only(&closed), Curve::periodic_spline(&points).unwrap());
    let tangents = drawn(&format!("0 SPLINE; 70 8; 71 3; 12 1; 22 0; 32 0; {fit}"));
    assert!(noted(&tangents, "tangents"));
    assert!(only(&tangents).direction_at(End::Start).cross(Vec2::new(1.0, 0.0)).abs() < 1e-15);
    // By chord length: the natural cubic through 0, 1 and 9 on a line, whose parameter is the place itself, stays on it
    // at even pace.
    let uneven = drawn("0 SPLINE; 70 8; 71 3; 74 3; 11 0; 21 0; 11 1; 21 0; 11 9; 21 0");
    near_point(only(&uneven).point(0.5), (4.5, 0.0));
}

#[test]
fn a_spline_that_contradicts_itself_is_an_error() {
    let control = "10 0; 20 0; 10 1; 20 2; 10 2; 20 0";
    let knots = "40 0; 40 0; 40 0; 40 1; 40 1; 40 1";
    for (short, part) in [
        (format!("0 SPLINE; 5 A; 71 2; 40 0; 40 1; {control}"), "6 knots"),
        (format!("0 SPLINE; 5 A; 71 2; 40 1; 40 0; 40 0; 40 1; 40 1; 40 1; {control}"), "ascend"),
        (format!("0 SPLINE; 5 A; 71 2; {knots}; 41 1; 41 0; 41 1; {control}"), "weight 1"),
        (format!("0 SPLINE; 5 A; 71 2; {knots}; 41 1; {control}"), "weights"),
        (format!("0 SPLINE; 5 A; 71 31; {knots}; {control}"), "degree 31"),
        ("0 SPLINE; 5 A; 71 2".into(), "without points"),
        ("0 SPLINE; 5 A; 71 2; 10 0; 10 1; 20 1".into(), "point 1 has no y"),
    ] {
        let error = refused(&plain(&short));
        assert!(error.what.contains(part) && error.what.contains("SPLINE (handle A, line 6)"), "{error}");
    }
}

#[test]
fn faces_are_outlines() {
    let corners = "10 0; 20 0; 11 1; 21 0; 12 0; 22 1; 13 1; 23 1";
    // The corners of SOLID go across, those of 3DFACE around.
    near(area(&drawn(&format!("0 SOLID; {corners}"))), 1.0);
    near(area(&drawn(&format!("0 3DFACE; {corners}"))), 0.0);
    let triangle = drawn("0 TRACE; 10 0; 20 0; 11 1; 21 0; 12 0; 22 1; 13 0; 23 1");
    assert_eq!(triangle.curves.len(), 3);
    near(area(&triangle), 0.5);
    // Two faces side by side are both inside.
    let two = drawn(
        "0 3DFACE; 10 0; 20 0; 11 1; 21 0; 12 1; 22 1; 13 0; 23 1; 0 3DFACE; 10 1; 20 0; 11 2; 21 0; 12 2; 22 1; 13 1; 23 1",
    );
    near(measure(&two), 2.0);
    assert_eq!(skipped(&drawn("0 SOLID; 10 0; 20 0; 11 0; 21 0; 12 0; 22 0")), [("SOLID", 1, "of no extent")]);
}

#[test]
fn points_are_kept_and_other_entities_counted() {
    let drawing = drawn(&format!(
        "0 POINT; 5 7; 8 probe; 10 1; 20 2; 30 0; {SQUARE}; 0 TEXT; 1 x; 0 MTEXT; 0 TEXT; 0 3DSOLID; 0 XLINE; 0 NEWTYPE"
    ));
    assert_eq!(drawing.points[0].at, Point::new(1.0, 2.0));
    assert_eq!(drawing.names.text(drawing.points[0].name.unwrap()), "probe");
    let kinds: Vec<(&str, usize)> = drawing.skipped.iter().map(|s| (s.entity.as_str(), s.count)).collect();
    assert_eq!(kinds, [("3DSOLID", 1), ("MTEXT", 1), ("NEWTYPE", 1), ("TEXT", 2), ("XLINE", 1)]);
    assert!(drawing.skipped.iter().all(|s| !s.why.is_empty()));
}

#[test]
fn end_tangents_of_splines_through_fit_points() {
    // Between two points, with tangents of 45° up and down: by chord length the cubic of Hermite data (4/√2, ±4/√2).
    let chord = "0 LINE; 10 4; 20 0; 11 0; 21 0";
    let spline = "0 SPLINE; 70 8; 71 3; 74 2; 12 3; 22 3; 13 0.1; 23 -0.1; 11 0; 21 0; 11 4; 21 0";
    let m = 4.0 / 2f64.sqrt();
    // ∫ y dx of Hermite curves with y = m(u(1−u)), x = 4 h(u) + m(…), by the control points of the Bézier curve.
    let bezier = [(0.0, 0.0), (m / 3.0, m / 3.0), (4.0 - m / 3.0, m / 3.0), (4.0, 0.0)];
    let cross = |i: usize, j: usize| bezier[i].0 * bezier[j].1 - bezier[i].1 * bezier[j].0;
    let under = (6.0 * cross(0, 1)
        + 3.0 * cross(0, 2)
        + cross(0, 3)
        + 3.0 * cross(1, 2)
        + 3.0 * cross(1, 3)
        + 6.0 * cross(2, 3))
        / 20.0;
    near(measure(&drawn(&format!("{spline}; {chord}"))), under.abs());
}

#[test]
fn knots_and_weights_as_writers_take_liberties() {
    let spline = |knots: &str, weights: &str| {
        format!(
            "0 SPLINE; 70 8; 71 2; 72 7; 73 4; 42 0.000000001; {knots}; 10 0; 20 0; {weights} 10 2; 20 4; {weights} 10 4; 20 4; {weights} 10 6; 20 0; {weights}"
        )
    };
    let clean = "40 0; 40 0; 40 0; 40 1; 40 2; 40 2; 40 2";
    let plain_curve = only(&drawn(&spline(clean, ""))).clone();
    let negative = only(&drawn(&spline(clean, "41 -1;"))).clone();
    let jitter = drawn(&spline("40 0; 40 0; 40 -0.0000000001; 40 1; 40 2; 40 2; 40 2", ""));
    assert!(noted(&jitter, "out of order"));
    for t in [0.0, 0.3, 0.5, 0.8, 1.0] {
        for curve in [&negative, only(&jitter)] {
            assert!(curve.point(t).distance(plain_curve.point(t)) < 1e-12);
        }
    }
    refused(&plain(&spline("40 0; 40 0; 40 -0.001; 40 1; 40 2; 40 2; 40 2", "")));
    refused(&plain(&spline(clean, "41 -1;").replacen("41 -1", "41 1", 1)));
}

#[test]
fn full_turns_with_few_digits() {
    let ellipse = |to: &str| drawn(&format!("0 ELLIPSE; 10 0; 20 0; 11 2; 21 0; 40 0.5; 41 0.0; 42 {to}"));
    for to in ["6.283185307179586", "6.28318", "6.2832", "6.283", "6.28"] {
        near(measure(&ellipse(to)), 2.0 * PI);
    }
    assert!(noted(&ellipse("6.283"), "miss a full turn"));
    for to in ["6.2", "6.27", "6.2830000", "3.14159"] {
        assert!(only(&ellipse(to)).start().distance(only(&ellipse(to)).end()) > 1e-9, "{to}");
    }
    near(measure(&drawn("0 ARC; 10 0; 20 0; 40 1; 50 0; 51 359.99")), PI);
    near(
        measure(&drawn(&hatch(0, "92 1; 93 1; 72 3; 10 0; 20 0; 11 2; 21 0; 40 0.5; 50 0; 51 359.9; 73 1; 97 0"))),
        2.0 * PI,
    );
}

#[test]
fn what_leaves_the_plane_is_named_and_can_be_projected() {
    let stray = "0 LINE; 5 A1; 10 0; 20 0; 30 0; 11 4; 21 0; 31 0.1; 0 LINE; 10 4; 20 0; 11 0; 21 3; 0 LINE; 10 0; 20 3; 11 0; 21 0";
    let drawing = drawn(stray);
    assert_eq!(drawing.curves.len(), 2);
    assert_eq!(drawing.off_plane.len(), 1);
    assert!(drawing.off_plane[0].entity.starts_with("LINE (handle A1"));
    assert_eq!(drawing.off_plane[0].ends, [Point::new(0.0, 0.0), Point::new(4.0, 0.0)]);
    let flatten = DxfOptions { flatten_z: Switch::On, ..DxfOptions::default() };
    let flat = with(flatten, &plain(stray));
    near(measure(&flat), 6.0);
    assert!(flat.off_plane.is_empty() && noted(&flat, "projected onto it: 1."));
    // A circle in a plane turned by 60° about the x axis is half as high as wide.
    let circle = "0 CIRCLE; 10 1; 20 2; 30 3; 40 2; 210 0; 220 -0.8660254037844386; 230 0.5";
    near(measure(&with(flatten, &plain(circle))), 4.0 * PI * 0.5);
    let disc = "0 LWPOLYLINE; 70 1; 38 5; 10 -2; 20 0; 42 1; 10 2; 20 0; 42 1; 210 0; 220 -0.8660254037844386; 230 0.5";
    near(measure(&with(flatten, &plain(disc))), 4.0 * PI * 0.5);
    // An ellipse by its own axes, of which the major one leaves the plane.
    let ellipse = "0 ELLIPSE; 10 0; 20 0; 30 0; 11 2; 21 0; 31 2; 40 0.5; 41 0; 42 6.283185307179586; 210 -0.7071067811865476; 220 0; 230 0.7071067811865476";
    near(measure(&with(flatten, &plain(ellipse))), PI * 2.0 * 2f64.sqrt());
    assert_eq!(skipped(&with(flatten, &plain("0 CIRCLE; 10 0; 20 0; 40 1; 210 1; 220 0; 230 0"))).len(), 1);
}

#[test]
fn a_multiline_is_its_parallel_lines() {
    let corner = |x: f64, y: f64, mx: f64, my: f64| {
        format!(
            "11 {x}; 21 {y}; 31 0; 12 1; 22 0; 32 0; 13 {mx}; 23 {my}; 33 0; 74 2; 41 1.4142135623730951; 41 0; 75 0; 74 2; 41 -1.4142135623730951; 41 0; 75 0;"
        )
    };
    let r = 0.5f64.sqrt();
    let corners = [(0.0, 0.0, r, r), (10.0, 0.0, -r, r), (10.0, 10.0, -r, -r), (0.0, 10.0, r, -r)];
    let corners: String = corners.into_iter().map(|(x, y, mx, my)| corner(x, y, mx, my)).collect();
    let walls = drawn(&format!("0 MLINE; 2 STANDARD; 40 2; 70 1; 71 3; 72 4; 73 2; 10 0; 20 0; {corners}"));
    near(measure(&walls), 144.0 - 64.0);
    let open = drawn(&format!("0 MLINE; 2 STANDARD; 40 2; 70 1; 71 1; 72 4; 73 2; 10 0; 20 0; {corners}"));
    assert_eq!(open.curves.len(), 6);
    assert!(noted(&open, "without caps"));
}
