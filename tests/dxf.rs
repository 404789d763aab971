//! What the DXF reader takes, what it makes of it, and how it refuses.

use proptest::prelude::*;
use squinch::curve::{Curve, End};
use squinch::domain::{ArrangeOptions, Drawing, FillRule, SeedKind};
use squinch::geometry::{Point, Vec2};
use squinch::import::{self, DxfOptions, Format, ImportError, LineTypes, Options, Selection};
use squinch::section;
use std::f64::consts::{FRAC_PI_2, PI};

fn read(bytes: &[u8], format: Format, stem: &str, options: &Options) -> Result<Drawing, ImportError> {
    section::drawn(import::read(bytes, format, stem, options)?, &section::Options::default())
}

// ---- files in short: `0 LINE; 8 rim; 10 0` is three pairs ----

fn pairs(short: &str) -> Vec<(i32, &str)> {
    short
        .split([';', '\n'])
        .map(str::trim_start)
        .filter(|text| !text.is_empty())
        .map(|text| text.split_once(' ').unwrap_or((text, "")))
        .map(|(code, value)| (code.parse().expect("a group code"), value))
        .collect()
}

fn text(short: &str) -> String {
    pairs(short).iter().map(|(code, value)| format!("{code:>3}\n{value}\n")).collect()
}

fn section(name: &str, short: &str) -> String {
    format!("0 SECTION; 2 {name}; {short}; 0 ENDSEC;")
}

/// A file of nothing but these entities.
fn plain(entities: &str) -> String {
    section("ENTITIES", entities) + "0 EOF"
}

fn from_bytes(bytes: &[u8]) -> Result<Drawing, ImportError> {
    read(bytes, Format::Dxf, "stem", &Options::default())
}

fn whole(short: &str) -> Drawing {
    from_bytes(text(short).as_bytes()).unwrap_or_else(|e| panic!("{e}\n{short}"))
}

fn drawn(entities: &str) -> Drawing {
    whole(&plain(entities))
}

#[track_caller]
fn refused(short: &str) -> ImportError {
    match from_bytes(text(short).as_bytes()) {
        Err(error) => error,
        Ok(drawing) => panic!("read {} curves", drawing.curves.len()),
    }
}

fn curves(drawing: &Drawing) -> Vec<Curve> {
    drawing.curves.iter().map(|c| c.curve.clone()).collect()
}

#[track_caller]
fn only(drawing: &Drawing) -> &Curve {
    assert_eq!(drawing.curves.len(), 1, "{:?}", drawing.skipped);
    &drawing.curves[0].curve
}

/// The area that the curves go around, drawn as closed outlines in one direction.
fn area(drawing: &Drawing) -> f64 {
    drawing.curves.iter().map(|c| c.curve.green(Point::ORIGIN)).sum()
}

/// The area of the kept regions.
fn measure(drawing: &Drawing) -> f64 {
    drawing.arrange(&ArrangeOptions::default()).unwrap_or_else(|e| panic!("{e}")).measure()
}

fn skipped(drawing: &Drawing) -> Vec<(&str, usize, &str)> {
    drawing.skipped.iter().map(|s| (s.entity.as_str(), s.count, s.why.as_str())).collect()
}

fn noted(drawing: &Drawing, part: &str) -> bool {
    drawing.notes.iter().any(|note| note.contains(part))
}

fn names(drawing: &Drawing) -> Vec<&str> {
    drawing.curves.iter().map(|c| drawing.names.text(c.name)).collect()
}

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{a} is not {b}");
}

#[track_caller]
fn near_point(a: Point, b: (f64, f64)) {
    assert!(a.distance(Point::new(b.0, b.1)) <= 1e-12 * (1.0 + b.0.abs() + b.1.abs()), "{a:?} is not {b:?}");
}

const SQUARE: &str = "0 LWPOLYLINE; 8 rim; 90 4; 70 1; 10 0; 20 0; 10 4; 20 0; 10 4; 20 4; 10 0; 20 4";

// ---- curves ----

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

/// A quarter of the unit circle, rational.
const QUARTER: &str = "0 SPLINE; 70 12; 71 2; 72 6; 73 3; 40 0; 40 0; 40 0; 40 1; 40 1; 40 1;
    41 1; 41 0.7071067811865476; 41 1; 10 1; 20 0; 30 0; 10 1; 20 1; 30 0; 10 0; 20 1; 30 0";

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
    // By chord length: the natural cubic through 0, 1 and 9 on a line, whose parameter is the place itself, stays on it at even pace.
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

// ---- what is seen ----

fn with_layers(layers: &str, entities: &str) -> Drawing {
    whole(&(section("TABLES", &format!("0 TABLE; 2 LAYER; {layers}; 0 ENDTAB")) + &plain(entities)))
}

#[test]
fn what_is_not_seen_is_left_out_and_counted() {
    let drawing = with_layers(
        "0 LAYER; 2 Ice; 70 1; 62 7; 0 LAYER; 2 Dark; 70 64; 62 -3; 0 LAYER; 2 Shown; 70 0; 62 7",
        "0 LINE; 8 ice; 10 x; 0 CIRCLE; 8 DARK; 10 0; 20 0; 40 1; 0 CIRCLE; 8 shown; 10 0; 20 0; 40 1;
         0 CIRCLE; 8 Defpoints; 10 0; 20 0; 40 1; 0 CIRCLE; 67 1; 10 0; 20 0; 40 1; 0 CIRCLE; 60 1; 10 0; 20 0; 40 1",
    );
    assert_eq!(names(&drawing), ["Shown"]);
    let expected = [
        ("CIRCLE", 1, "in paper space"),
        ("CIRCLE", 1, "invisible"),
        ("CIRCLE", 1, "on a layer that is off"),
        ("CIRCLE", 1, "on the layer Defpoints, of construction points"),
        ("LINE", 1, "on a frozen layer"),
    ];
    assert_eq!(skipped(&drawing), expected);
}

#[test]
fn a_block_is_as_visible_as_its_layers() {
    let block =
        "0 BLOCK; 2 B; 10 0; 20 0; 0 CIRCLE; 8 0; 10 0; 20 0; 40 1; 0 CIRCLE; 8 own; 10 0; 20 0; 40 2; 0 ENDBLK";
    let seen = |layer: &str| {
        let tables = "0 LAYER; 2 ice; 70 1; 62 7; 0 LAYER; 2 dark; 70 0; 62 -3";
        let insert = format!("0 INSERT; 8 {layer}; 2 B; 10 0; 20 0");
        let file = section("TABLES", tables) + &section("BLOCKS", block) + &plain(&insert);
        let drawing = whole(&file);
        names(&drawing).iter().map(|n| n.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(seen("part"), ["part", "own"]);
    assert_eq!(seen("dark"), ["own"]);
    assert_eq!(seen("Defpoints"), ["own"]);
    assert!(seen("ice").is_empty());
}

// ---- blocks ----

fn with_blocks(blocks: &str, entities: &str) -> String {
    section("BLOCKS", blocks) + &plain(entities)
}

const UNIT_LINE: &str = "0 BLOCK; 2 L; 70 0; 10 1; 20 1; 30 0; 0 LINE; 5 1C; 8 0; 10 1; 20 1; 11 2; 21 1; 0 ENDBLK";

#[track_caller]
fn inserted(insert: &str, from: (f64, f64), to: (f64, f64)) {
    let drawing = whole(&with_blocks(UNIT_LINE, insert));
    near_point(only(&drawing).start(), from);
    near_point(only(&drawing).end(), to);
}

#[test]
fn a_block_is_scaled_turned_moved_and_mirrored_about_its_base() {
    inserted("0 INSERT; 2 l; 10 5; 20 6", (5.0, 6.0), (6.0, 6.0));
    inserted("0 INSERT; 2 L; 10 5; 20 6; 41 3; 42 1; 50 90", (5.0, 6.0), (5.0, 9.0));
    inserted("0 INSERT; 2 L; 10 5; 20 6; 41 -2; 50 30", (5.0, 6.0), (5.0 - 3f64.sqrt(), 5.0));
    inserted("0 INSERT; 2 L; 10 5; 20 6; 50 90; 210 0; 220 0; 230 -1", (-5.0, 6.0), (-5.0, 7.0));
    let none = whole(&with_blocks(UNIT_LINE, "0 INSERT; 2 L; 10 0; 20 0; 41 0; 0 INSERT; 2 M; 10 0; 20 0"));
    let expected =
        [("INSERT", 1, "a block drawn with the scale 0"), ("INSERT", 1, "of a block that the file does not define")];
    assert_eq!(skipped(&none), expected);
}

#[test]
fn curves_in_blocks_keep_their_kind() {
    let block = "0 BLOCK; 2 B; 10 0; 20 0; 0 CIRCLE; 10 0; 20 0; 40 1; 0 LWPOLYLINE; 70 1; 10 -1; 20 0; 42 1; 10 1; 20 0; 42 1; 0 ENDBLK";
    let mirrored = whole(&with_blocks(block, "0 INSERT; 2 B; 10 3; 20 0; 41 -2; 42 2; 50 17"));
    assert!(curves(&mirrored).iter().all(|c| matches!(c, Curve::Arc(_))));
    near(area(&mirrored), -8.0 * PI);
    let stretched = whole(&with_blocks(block, "0 INSERT; 2 B; 10 3; 20 0; 41 3; 42 2; 50 17"));
    assert!(curves(&stretched).iter().all(|c| matches!(c, Curve::Ellipse(_))));
    near(area(&stretched), 12.0 * PI);
}

#[test]
fn rows_and_columns_follow_the_turned_axes_unscaled() {
    let drawing =
        whole(&with_blocks(UNIT_LINE, "0 INSERT; 2 L; 10 0; 20 0; 41 5; 42 5; 50 90; 70 3; 71 2; 44 10; 45 20"));
    let starts: Vec<Point> = curves(&drawing).iter().map(Curve::start).collect();
    let expected = [(0.0, 0.0), (0.0, 10.0), (0.0, 20.0), (-20.0, 0.0), (-20.0, 10.0), (-20.0, 20.0)];
    assert_eq!(starts.len(), expected.len());
    starts.into_iter().zip(expected).for_each(|(start, expected)| near_point(start, expected));
}

#[test]
fn blocks_stand_in_blocks() {
    let outer = "0 BLOCK; 2 Outer; 10 0; 20 0; 0 INSERT; 5 9; 8 0; 2 L; 10 1; 20 0; 41 2; 42 2; 0 ENDBLK";
    let drawing = whole(&with_blocks(
        &format!("{UNIT_LINE}; {outer}"),
        "0 INSERT; 5 2F; 8 part; 2 OUTER; 10 10; 20 0; 50 90; 41 3; 42 3",
    ));
    near_point(only(&drawing).start(), (10.0, 3.0));
    near_point(only(&drawing).end(), (10.0, 9.0));
    assert_eq!(names(&drawing), ["part"]);
    let entity = &drawing.curves[0].entity;
    assert!(entity.starts_with("INSERT \"OUTER\" (handle 2F, line "), "{entity}");
    assert!(
        entity.contains(" > INSERT \"L\" (handle 9, line ") && entity.ends_with(" > LINE (handle 1C, line 18)"),
        "{entity}"
    );
}

#[test]
fn a_block_that_holds_itself_is_not_followed() {
    let a = "0 BLOCK; 2 A; 10 0; 20 0; 0 CIRCLE; 10 0; 20 0; 40 1; 0 INSERT; 2 B; 10 0; 20 0; 0 ENDBLK";
    let b = "0 BLOCK; 2 B; 10 0; 20 0; 0 INSERT; 2 a; 10 1; 20 0; 0 ENDBLK";
    let drawing = whole(&with_blocks(&format!("{a}; {b}"), "0 INSERT; 2 A; 10 0; 20 0"));
    assert_eq!(drawing.curves.len(), 1);
    assert_eq!(skipped(&drawing), [("INSERT", 1, "of a block that holds itself")]);
}

#[test]
fn blocks_unfold_within_bounds() {
    let error = refused(&with_blocks(UNIT_LINE, "0 INSERT; 5 2F; 2 L; 10 0; 20 0; 70 30000; 71 30000; 44 2; 45 2"));
    assert!(error.what.contains("more than 1000000 curves") && error.what.contains("handle 2F"), "{error}");
    // Thirty blocks, each with two of the next: nothing is drawn, and it would take 2³⁰ steps.
    let chain = |n: usize, more: &str| -> String {
        (0..n)
            .map(|i| format!("0 BLOCK; 2 B{i}; 10 0; 20 0; {} 0 ENDBLK;", more.replace('#', &(i + 1).to_string())))
            .collect()
    };
    let twice = "0 INSERT; 2 B#; 10 0; 20 0; 0 INSERT; 2 B#; 10 1; 20 0;";
    let error = refused(&with_blocks(&chain(30, twice), "0 INSERT; 2 B0; 10 0; 20 0"));
    assert!(error.what.contains("more than 1000000 curves"), "{error}");
    let error = refused(&with_blocks(&chain(1000, "0 INSERT; 2 B#; 10 0; 20 0;"), "0 INSERT; 2 B0; 10 0; 20 0"));
    assert!(error.what.contains("more than 32 deep"), "{error}");
    // A spline counts by its control points.
    let control: String = (0..1000).map(|i| format!("10 {i}; 20 0;")).collect();
    let spline = format!("0 BLOCK; 2 S; 10 0; 20 0; 0 SPLINE; 71 3; {control} 0 ENDBLK");
    let error = refused(&with_blocks(&spline, "0 INSERT; 2 S; 10 0; 20 0; 70 1000; 44 1"));
    assert!(error.what.contains("more than 1000000 curves"), "{error}");
    let huge = "0 INSERT; 2 L; 10 0; 20 0; 41 1e140; 42 1e140; 0 INSERT; 2 L; 10 0; 20 0";
    let nested = format!("{UNIT_LINE}; 0 BLOCK; 2 H; 10 0; 20 0; {huge}; 0 ENDBLK");
    let error = refused(&with_blocks(&nested, "0 INSERT; 2 H; 10 0; 20 0; 41 1e20; 42 1e20"));
    assert!(error.what.contains("too large or too small"), "{error}");
}

// ---- hatches ----

/// A hatch with these paths.
fn hatch(style: u8, paths: &str) -> String {
    let count = paths.matches("92 ").count();
    format!(
        "0 HATCH; 5 4D; 8 steel; 10 0; 20 0; 30 0; 210 0; 220 0; 230 1; 2 ANSI31; 70 0; 71 0; 91 {count}; {paths};
         75 {style}; 76 1; 52 0; 41 1; 77 0; 78 1; 53 45; 43 0; 44 0; 45 1; 46 1; 79 0; 98 1; 10 99; 20 99"
    )
}

/// The unit disc, as a path without its flags.
const DISC: &str =
    "93 2; 72 2; 10 0; 20 0; 40 1; 50 0; 51 180; 73 1; 72 2; 10 0; 20 0; 40 1; 50 180; 51 360; 73 1; 97 1; 330 1F";

#[test]
fn a_drawing_of_hatches_is_a_picture_of_shapes() {
    let square = "92 7; 72 0; 73 1; 93 4; 10 -4; 20 -4; 10 4; 20 -4; 10 4; 20 4; 10 -4; 20 4; 97 0;";
    let drawing = drawn(&hatch(0, &format!("{square} 92 16; {}", DISC)));
    assert_eq!(drawing.fill, FillRule::Shapes);
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    assert_eq!(domain.regions().len(), 1);
    assert_eq!(domain.name(domain.regions().iter().next().unwrap().name), "steel");
    near(domain.measure(), 64.0 - PI);
    assert_eq!(drawing.curves[0].entity, "HATCH (handle 4D, line 6)");
}

#[test]
fn the_edges_of_a_hatch() {
    // A slot: bottom line, right arc, top line, left arc.
    let slot = |right: &str, left: &str| {
        let lines = ["72 1; 10 0; 20 0; 11 3; 21 0", "72 1; 10 3; 20 2; 11 0; 21 2"];
        let path =
            format!("{}; 72 2; 10 3; 20 1; 40 1; {right}; {}; 72 2; 10 0; 20 1; 40 1; {left}", lines[0], lines[1]);
        measure(&drawn(&hatch(0, &format!("92 1; 93 4; {path}; 97 0"))))
    };
    near(slot("50 270; 51 90; 73 1", "50 90; 51 270; 73 1"), 6.0 + PI);
    // The angles of a clockwise arc are measured clockwise.
    near(slot("50 90; 51 270; 73 0", "50 270; 51 90; 73 0"), 6.0 - PI);
    // An elliptic arc by angles: the quarter from the major axis to the ray of 45°, closed by two lines through the center.
    let sector = "92 1; 93 3; 72 3; 10 0; 20 0; 11 2; 21 0; 40 0.5; 50 0; 51 45; 73 1;
                  72 1; 10 0.894427190999916; 20 0.894427190999916; 11 0; 21 0; 72 1; 10 0; 20 0; 11 2; 21 0; 97 0";
    // A sector of the unit disc by parameter, stretched twofold.
    near(measure(&drawn(&hatch(0, sector))), 2.0 * 0.5 * 2f64.atan());
    let spline = "92 1; 93 2; 72 4; 94 2; 73 1; 74 0; 95 6; 96 3; 40 0; 40 0; 40 0; 40 1; 40 1; 40 1;
                  10 1; 20 0; 42 1; 10 1; 20 1; 42 0.7071067811865476; 10 0; 20 1; 42 1; 97 0; 72 1; 10 0; 20 1; 11 1; 21 0; 97 0";
    near(measure(&drawn(&hatch(0, spline))), 0.25 * PI - 0.5);
}

#[test]
fn islands_of_a_hatch_follow_its_style() {
    let square = |flags: u8, r: i32| {
        format!(
            "92 {flags}; 72 0; 73 1; 93 4; 10 -{r}; 20 -{r}; 10 {r}; 20 -{r}; 10 {r}; 20 {r}; 10 -{r}; 20 {r}; 97 0;"
        )
    };
    let nested = square(7, 3) + &square(22, 2) + &square(6, 1);
    for (style, area) in [(0, 36.0 - 16.0 + 4.0), (1, 36.0 - 16.0), (2, 36.0)] {
        near(measure(&drawn(&hatch(style, &nested))), area);
    }
    // Older files do not say which path is which, and boxes around text are no islands.
    let unsaid = square(2, 3) + &square(2, 2);
    near(measure(&drawn(&hatch(1, &unsaid))), 36.0 - 16.0);
    near(measure(&drawn(&hatch(0, &(square(3, 3) + &square(10, 1))))), 36.0);
}

#[test]
fn edges_of_a_hatch_are_turned_and_gaps_closed() {
    // The second edge runs against the others, the third is missing.
    let edges =
        "92 1; 93 3; 72 1; 10 0; 20 0; 11 2; 21 0; 72 1; 10 2; 20 2; 11 2; 21 0; 72 1; 10 0; 20 2; 11 0; 21 0; 97 0";
    let drawing = drawn(&hatch(0, edges));
    near(area(&drawing), 4.0);
    assert!(noted(&drawing, "Gaps"));
    // Two loops in one path.
    let two =
        "92 1; 93 2; 72 2; 10 0; 20 0; 40 2; 50 0; 51 360; 73 1; 72 2; 10 0; 20 0; 40 1; 50 0; 51 360; 73 0; 97 0";
    near(measure(&drawn(&hatch(0, two))), 3.0 * PI);
    let error = refused(&plain(&hatch(0, "92 1; 93 1; 72 7; 10 0; 97 0")));
    assert!(error.what.contains("HATCH (handle 4D, line 6)") && error.what.contains("type 7"), "{error}");
    assert_eq!(skipped(&drawn(&hatch(0, ""))), [("HATCH", 1, "of no boundary")]);
}

#[test]
fn beside_outlines_a_hatch_names_a_region() {
    let ring = "0 CIRCLE; 8 rim; 10 0; 20 0; 40 4; 0 CIRCLE; 8 rim; 10 0; 20 0; 40 3";
    // As a polygon, as some writers do it.
    let corner = |r: f64, i: u32| {
        let (sin, cos) = (f64::from(i) * PI / 8.0).sin_cos();
        format!("10 {}; 20 {};", r * cos, r * sin)
    };
    let polygon =
        |r: f64| format!("92 2; 72 0; 73 1; 93 16; {} 97 0;", (0..16).map(|i| corner(r, i)).collect::<String>());
    let drawing = drawn(&format!("{ring}; {}", hatch(0, &(polygon(4.0) + &polygon(3.0)))));
    assert_eq!((drawing.curves.len(), drawing.seeds.len(), drawing.fill), (2, 1, FillRule::EvenOdd));
    assert!(matches!(drawing.seeds[0].kind, SeedKind::Region { max_area: None, .. }));
    assert!(noted(&drawing, "Hatches name the regions"));
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    let regions: Vec<_> = domain.regions().iter().map(|r| domain.name(r.name)).collect();
    assert_eq!(regions, ["steel"]);
    near(domain.measure(), 7.0 * PI);
}

// ---- header ----

fn with_header(header: &str, entities: &str) -> Drawing {
    whole(&(section("HEADER", header) + &plain(entities)))
}

#[test]
fn units_and_version() {
    let unit = |header: &str| with_header(header, SQUARE).unit;
    let named = |unit: &str, from: &str| Some((unit.to_owned(), from.to_owned()));
    assert_eq!(unit("9 $INSUNITS; 70 4; 9 $MEASUREMENT; 70 0"), named("mm", "$INSUNITS = 4"));
    assert_eq!(unit("9 $INSUNITS; 70 0; 9 $MEASUREMENT; 70 0"), named("in", "$MEASUREMENT = 0, imperial"));
    assert_eq!(unit("9 $INSUNITS; 70 99; 9 $MEASUREMENT; 70 1"), named("mm", "$MEASUREMENT = 1, metric"));
    assert_eq!(unit("9 $ACADVER; 1 AC1009"), None);
    let drawing = with_header("9 $ACADVER; 1 AC1032", SQUARE);
    assert!(noted(&drawing, "names no unit") && drawing.format == "dxf (AC1032)");
    for number in 1..=24 {
        let (unit, _) = unit(&format!("9 $INSUNITS; 70 {number}")).unwrap();
        assert!(squinch::geometry::metres(&unit).is_some(), "{unit}");
    }
}

#[test]
fn names_as_people_read_them() {
    let layer = |header: &str, name: &[u8]| {
        let before = text(&section("HEADER", header)) + "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n";
        let after = "\n10\n0\n20\n0\n40\n1\n0\nENDSEC\n0\nEOF\n";
        let drawing = from_bytes(&[before.as_bytes(), name, after.as_bytes()].concat()).unwrap();
        names(&drawing)[0].to_owned()
    };
    assert_eq!(layer("9 $ACADVER; 1 AC1021", "Maß".as_bytes()), "Maß");
    assert_eq!(layer("9 $DWGCODEPAGE; 3 ANSI_1252", "Maß".as_bytes()), "Maß");
    assert_eq!(layer("9 $DWGCODEPAGE; 3 ANSI_1252", b"Ma\xdf"), "Maß");
    assert_eq!(layer("9 $DWGCODEPAGE; 3 ANSI_1251", b"\xcb\xe8\xf1\xf2"), "Лист");
    assert_eq!(layer("9 $DWGCODEPAGE; 3 ansi_932", b"\x90\x7d"), "図");
    assert_eq!(layer("9 $DWGCODEPAGE; 3 none", b"Ma\\U+00DF \\U+XYZ"), "Maß \\U+XYZ");
    assert_eq!(layer("9 $ACADVER; 1 AC1021", b"   "), "0");
}

#[test]
fn one_layer_whatever_the_case() {
    let drawing = drawn("0 CIRCLE; 8 Rim; 10 0; 20 0; 40 1; 0 CIRCLE; 8 RIM; 10 0; 20 0; 40 2");
    assert_eq!(names(&drawing), ["Rim", "Rim"]);
}

// ---- dress ----

/// A file with something of everything.
fn sampler() -> String {
    let header = section("HEADER", "9 $ACADVER; 1 AC1015; 9 $INSUNITS; 70 6");
    let tables = section("TABLES", "0 TABLE; 2 LAYER; 70 1; 0 LAYER; 2 rim; 70 0; 62 7; 0 ENDTAB");
    let outline = format!("{SQUARE}; 0 CIRCLE; 10 2; 20 2; 40 1; {QUARTER}; 0 INSERT; 2 L; 10 0; 20 9; 70 2; 44 3");
    let ellipse = "0 ELLIPSE; 10 9; 20 9; 11 2; 21 0; 40 0.5; 41 0; 42 3";
    let entities = format!("{outline}; {ellipse}; {}; 0 POINT; 10 1; 20 1", hatch(0, &format!("92 1; {DISC}")));
    header + &tables + &with_blocks(UNIT_LINE, &entities)
}

fn same(a: &Drawing, b: &Drawing) {
    assert_eq!(curves(a), curves(b));
    assert_eq!((names(a), &a.unit, &a.points.len()), (names(b), &b.unit, &b.points.len()));
    assert_eq!(a.seeds.iter().map(|s| s.at).collect::<Vec<_>>(), b.seeds.iter().map(|s| s.at).collect::<Vec<_>>());
}

#[test]
fn line_ends_and_blanks_do_not_matter() {
    let plain = whole(&sampler());
    assert_eq!(plain.curves.len(), 4 + 1 + 1 + 2 + 1 + 2);
    let lf = text(&sampler());
    for dress in [
        lf.replace('\n', "\r\n"),
        lf.replace('\n', "\r"),
        lf.replace('\n', " \t\n"),
        format!("\u{feff}{lf}"),
        format!("\n\n{lf}\n\n"),
        format!("999\nmade by hand\n{lf}"),
        lf.trim_end().to_owned(),
        lf.to_lowercase().replace("$insunits", "$INSUNITS").replace("ac1015", "AC1015"),
    ] {
        same(&from_bytes(dress.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{dress}")), &plain);
    }
}

/// The same pairs as a binary file, with codes of one byte or of two.
fn binary(short: &str, wide: bool) -> Vec<u8> {
    let mut bytes = b"AutoCAD Binary DXF\r\n\x1a\0".to_vec();
    for (code, value) in pairs(short) {
        match u8::try_from(code) {
            Ok(code) if !wide && code < 255 => bytes.push(code),
            _ => {
                bytes.extend((!wide).then_some(255));
                bytes.extend((code as i16).to_le_bytes());
            }
        }
        match code {
            10..=59 | 210..=239 => bytes.extend(value.parse::<f64>().unwrap().to_le_bytes()),
            60..=79 => bytes.extend(value.parse::<i16>().unwrap().to_le_bytes()),
            90..=99 => bytes.extend(value.parse::<i32>().unwrap().to_le_bytes()),
            290..=299 => bytes.push(value.parse::<u8>().unwrap()),
            1004 => bytes.extend([2, 0, 10]),
            1070 => bytes.extend(value.parse::<i16>().unwrap().to_le_bytes()),
            _ => bytes.extend([value.as_bytes(), b"\0"].concat()),
        }
    }
    bytes
}

#[test]
fn binary_files_hold_the_same() {
    let short = sampler().replace("0 POINT;", "0 POINT; 290 1; 1001 APP; 1004 x; 1070 7;");
    let plain = whole(&sampler());
    for wide in [false, true] {
        let bytes = binary(&short, wide);
        assert_eq!(Format::sniff(&bytes), Some(Format::Dxf));
        let drawing = from_bytes(&bytes).unwrap();
        same(&drawing, &plain);
        assert_eq!(drawing.format, "dxf (AC1015, binary)");
        assert!(drawing.curves[0].entity.starts_with("LWPOLYLINE (byte "), "{}", drawing.curves[0].entity);
        let error = from_bytes(&bytes[..bytes.len() - 30]).unwrap_err();
        assert!(error.what.contains("middle of section ENTITIES"), "{error}");
    }
    // Sent as text on its way.
    let mut sent = binary(&short, true);
    sent.remove(18);
    same(&from_bytes(&sent).unwrap(), &plain);
    let nan =
        [binary("0 SECTION; 2 ENTITIES; 0 LINE; 5 A", true), vec![10, 0], f64::NAN.to_le_bytes().to_vec()].concat();
    let error =
        from_bytes(&[nan, binary("20 0; 11 0; 21 0; 0 ENDSEC; 0 EOF", true)[22..].to_vec()].concat()).unwrap_err();
    assert!(error.what.contains("byte 54: LINE (handle A, byte 43): group 10 is NaN"), "{error}");
}

#[test]
fn the_content_tells_the_format() {
    assert_eq!(Format::sniff(text(&plain(SQUARE)).as_bytes()), Some(Format::Dxf));
    assert_eq!(Format::sniff(b"999\r\nlibdxfrw\r\n  0\r\nSECTION\r\n"), Some(Format::Dxf));
    assert_ne!(Format::sniff(b"0\n1\n"), Some(Format::Dxf));
    assert_ne!(Format::sniff(b"NACA 0012\n1 0\n0 0\n"), Some(Format::Dxf));
    assert_eq!(squinch::import::format_of(std::path::Path::new("A.DXF")), Some(Format::Dxf));
}

// ---- refusals ----

#[test]
fn a_bad_number_is_refused_with_its_entity() {
    for number in ["nan", "inf", "1e400", "1,5", "", "0x10", "1e200", "--1"] {
        let error = refused(&plain(&format!("0 LINE; 5 2F; 10 0; 20 {number}; 11 1; 21 0")));
        assert_eq!(error.line, Some(12), "{error}");
        assert!(error.what.contains("LINE (handle 2F, line 6): group 20 is") && !error.help.is_empty(), "{error}");
    }
    assert!(refused(&plain("0 LINE; 10 0; 20 0; 11 1")).what.contains("group 21 is missing"));
    assert!(refused(&plain("0 LWPOLYLINE; 10 0; 20 0; 42 1e9; 10 1; 20 0")).what.contains("bulge"));
}

#[test]
fn a_file_that_is_cut_is_refused() {
    let bytes = text(&sampler());
    let entities_end = bytes.rfind("ENDSEC").unwrap();
    for end in 0..bytes.len() {
        let result = from_bytes(&bytes.as_bytes()[..end]);
        // With the name of ENDSEC whole, so is the drawing.
        assert_eq!(result.is_ok(), end >= entities_end + "ENDSEC".len(), "cut at {end} of {}", bytes.len());
    }
    let cut = refused("0 SECTION; 2 ENTITIES; 0 LINE; 10 0; 20 0");
    assert_eq!((cut.line, cut.what.as_str()), (Some(11), "the file ends in the middle of section ENTITIES"));
    assert!(noted(&whole(&section("ENTITIES", SQUARE)), "does not say where it ends"));
    assert!(noted(&whole(&format!("0 SECTION; 2 ENTITIES; {SQUARE}; 0 EOF")), "has no end"));
    let damaged = text(&section("ENTITIES", SQUARE)) + "0\nSECTION\n2\nOBJECTS\nwhat\n1\n";
    assert!(noted(&from_bytes(damaged.as_bytes()).unwrap(), "is damaged"));
    let trash = text(&plain(SQUARE)) + "and\nmore\n";
    assert!(noted(&from_bytes(trash.as_bytes()).unwrap(), "follows the end"));
}

#[test]
fn what_is_no_dxf_is_refused() {
    assert_eq!(from_bytes(b" \n ").unwrap_err().what, "the file is empty");
    let error = from_bytes(b"hello\nworld\n").unwrap_err();
    assert!(error.line == Some(1) && error.what.contains("group code"), "{error}");
    let error = from_bytes(b"0\nLINE\n").unwrap_err();
    assert!(error.line == Some(2) && error.what.contains("expected a section"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any bytes, as text or behind the sentinel, are a drawing or an error.
    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..300), is_binary: bool) {
        let head: &[u8] = if is_binary { b"AutoCAD Binary DXF\r\n\x1a\0" } else { b"" };
        let _ = from_bytes(&[head, &bytes].concat());
    }

    /// A file with a few values replaced is a drawing that can be looked at, or an error.
    #[test]
    fn a_damaged_file_is_read_or_refused(
        places in proptest::collection::vec((any::<prop::sample::Index>(), 0usize..20), 1..6),
        is_wide in proptest::option::of(any::<bool>()),
    ) {
        let values = [
            "0", "1", "-1", "2", "3", "16", "64", "128", "30000", "1e-300", "1e149", "-1e149", "1e-17", "90", "0.5", "360",
            "1e9", "7", "31", "L",
        ];
        let fitting = |code: i32, value: &str| match code {
            10..=59 | 210..=239 => value.parse::<f64>().is_ok(),
            60..=79 | 90..=99 => value.parse::<i16>().is_ok(),
            _ => code != 0,
        };
        let sampler = sampler();
        let mut short: Vec<(i32, &str)> = pairs(&sampler);
        for (place, value) in places {
            let pair = place.get(&short);
            let at = short.iter().position(|p| std::ptr::eq(p, pair)).unwrap();
            if fitting(short[at].0, values[value]) {
                short[at].1 = values[value];
            }
        }
        let short: String = short.iter().map(|(code, value)| format!("{code} {value};")).collect();
        let result = match is_wide {
            Some(is_wide) => from_bytes(&binary(&short, is_wide)),
            None => from_bytes(text(&short).as_bytes()),
        };
        if let Ok(drawing) = result {
            prop_assert!(drawing.curves.iter().all(|c| c.curve.start().is_finite() && c.curve.end().is_finite()));
            prop_assert!(drawing.bounds().is_none_or(|b| b.is_finite()));
        }
    }
}

// ---- layers, handles, last decimals ----

fn chosen(short: &str, only: &[&str], skip: &[&str]) -> Drawing {
    let globs = |texts: &[&str]| texts.iter().map(|text| text.parse().unwrap()).collect();
    let selection = Selection { only: globs(only), skip: globs(skip) };
    read(text(short).as_bytes(), Format::Dxf, "stem", &Options { selection, ..Options::default() }).unwrap()
}

#[test]
fn layers_are_listed_with_the_line_types_drawn_on_them() {
    let tables = section(
        "TABLES",
        "0 TABLE; 2 LAYER; 0 LAYER; 2 Part; 70 0; 62 7; 6 Continuous; 0 LAYER; 2 Cut; 70 0; 62 7; 6 DASHED; 0 ENDTAB",
    );
    let block = "0 BLOCK; 2 B; 10 0; 20 0; 0 LINE; 8 0; 10 0; 20 0; 11 1; 21 1; 0 LINE; 8 0; 6 BYBLOCK; 10 1; 20 1; 11 2; 21 1; 0 ENDBLK";
    let entities = "0 LINE; 5 2F; 8 part; 10 0; 20 0; 11 1; 21 0; 0 INSERT; 8 CUT; 6 Dot; 2 B; 10 0; 20 0; \
                    0 LINE; 8 new; 10 0; 20 0; 11 0; 21 1";
    let drawing = whole(&(tables + &section("BLOCKS", block) + &plain(entities)));
    let layers: Vec<(&str, Vec<(&str, usize)>)> = (drawing.layers.iter())
        .map(|l| (l.name.as_str(), l.line_types.iter().map(|(name, &n)| (name.as_str(), n)).collect()))
        .collect();
    assert_eq!(
        layers,
        [
            ("0", vec![]),
            ("Part", vec![("CONTINUOUS", 1)]),
            ("Cut", vec![("DASHED", 1), ("DOT", 1)]),
            ("new", vec![("CONTINUOUS", 1)])
        ]
    );
    let of_curves: Vec<&str> = drawing.curves.iter().map(|c| drawing.layers[c.layer.unwrap()].name.as_str()).collect();
    assert_eq!(of_curves, ["Part", "Cut", "Cut", "new"]);
    assert_eq!(drawing.curves[0].handle, Some(0x2f));
    assert_eq!(drawing.curves[1].handle, None);
}

#[test]
fn layers_can_be_chosen_and_left_out() {
    let block = "0 BLOCK; 2 B; 10 0; 20 0; 0 LINE; 8 0; 10 0; 20 0; 11 1; 21 1; 0 ENDBLK";
    let entities = "0 LINE; 8 Part; 10 0; 20 0; 11 1; 21 0; 0 LINE; 8 FRAME 1; 10 0; 20 0; 11 0; 21 1; \
                    0 INSERT; 8 frame 2; 2 B; 10 0; 20 0";
    let file = section("BLOCKS", block) + &plain(entities);
    for (only, skip) in [(vec!["PART"], vec![]), (vec![], vec!["Frame*"]), (vec!["*"], vec!["frame ?"])] {
        let drawing = chosen(&file, &only, &skip);
        assert_eq!(drawing.curves.len(), 1, "{only:?} {skip:?}");
        assert_eq!(drawing.unmatched, []);
        let left_out: Vec<_> = drawing.skipped.iter().map(|s| (s.entity.as_str(), s.count, s.why.as_str())).collect();
        assert_eq!(left_out, [("LINE", 2, "on a layer that --layers or --skip-layers leaves out")]);
    }
    let drawing = chosen(&file, &[], &["FRMAE 1"]);
    assert_eq!(drawing.unmatched[0].near[0], "FRAME 1");
}

#[test]
fn the_last_decimal_is_that_of_the_text() {
    let last_decimal = |entity: &str| drawn(entity).curves[0].last_decimal;
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b, "{a} {b}");
    near(last_decimal("0 LINE; 10 0.000; 20 0.000; 11 80.000; 21 0.000"), 1e-3);
    near(last_decimal("0 LINE; 10 0; 20 1.25E-2; 11 80; 21 0.5"), 1e-4);
    assert_eq!(last_decimal("0 LINE; 10 0.0; 20 0; 11 80.0; 21 -3."), 0.0);
    near(last_decimal("0 LWPOLYLINE; 70 1; 10 0; 20 0; 42 0.41421356; 10 80.25; 20 0; 10 0; 20 9"), 1e-2);
    near(last_decimal("0 POLYLINE; 70 1; 0 VERTEX; 10 0; 20 0; 0 VERTEX; 10 8.125; 20 0; 0 SEQEND"), 1e-3);
    near(last_decimal("0 CIRCLE; 10 0; 20 0; 40 2.50"), 1e-2);
    near(last_decimal("0 ARC; 10 0; 20 0; 40 20.0000; 50 30.25; 51 90.0"), 20.0 * 0.01 * PI / 180.0);
    near(last_decimal("0 ELLIPSE; 10 0; 20 0; 11 50.0000; 21 0; 40 0.5; 41 0; 42 3.142"), 50.0 * 0.1);
    near(last_decimal("0 SPLINE; 71 3; 11 0.125; 21 0; 11 1; 21 1; 11 2; 21 0"), 1e-3);
    let block = "0 BLOCK; 2 B; 10 0; 20 0; 0 LINE; 8 0; 10 0; 20 0; 11 1.5; 21 1; 0 ENDBLK";
    let drawing = whole(&(section("BLOCKS", block) + &plain("0 INSERT; 2 B; 10 0; 20 0; 41 2; 42 -4; 50 30")));
    near(drawing.curves[0].last_decimal, 0.4);
}

// ---- line types ----

fn with(options: DxfOptions, short: &str) -> Drawing {
    let options = Options { dxf: options, ..Options::default() };
    read(text(short).as_bytes(), Format::Dxf, "stem", &options).unwrap_or_else(|e| panic!("{e}\n{short}"))
}

const LEFT_OUT: &str = "of a line type that draws no edge (--line-types all keeps it)";

#[test]
fn line_types_that_draw_no_edge_are_left_out() {
    let auxiliary = [
        "CENTER",
        "center2",
        "CenterX2",
        "PHANTOM",
        "HIDDEN2",
        "DASHDOT",
        "DASHDOTX2",
        "DIVIDE",
        "BORDER2",
        "ACAD_ISO04W100",
        "ACAD_ISO10W100",
        "ACAD_ISO15W100",
        "ISO12W050",
        "AM_ISO08W050",
        "JIS_08_11",
    ];
    for name in auxiliary {
        let file = plain(&format!("0 CIRCLE; 6 {name}; 10 0; 20 0; 40 9; {SQUARE}"));
        let drawing = whole(&file);
        assert_eq!((drawing.curves.len(), skipped(&drawing)), (4, vec![("CIRCLE", 1, LEFT_OUT)]), "{name}");
        let all = with(DxfOptions { line_types: LineTypes::All, ..DxfOptions::default() }, &file);
        assert_eq!(all.curves.len(), 5, "{name}");
    }
    for name in ["DASHED", "Continuous", "BYLAYER", "DOT", "ACAD_ISO02W100", "ACAD_ISO03W100", "ISO9000"] {
        assert_eq!(drawn(&format!("0 CIRCLE; 6 {name}; 10 0; 20 0; 40 9; {SQUARE}")).curves.len(), 5, "{name}");
    }
}

#[test]
fn line_types_are_known_by_their_patterns_too() {
    let curves = |pattern: &str| {
        let table = format!("0 TABLE; 2 LTYPE; 0 LTYPE; 2 Achse; {pattern}; 0 ENDTAB");
        let entities = plain(&format!("0 CIRCLE; 6 ACHSE; 10 0; 20 0; 40 9; {SQUARE}"));
        whole(&(section("TABLES", &table) + &entities)).curves.len() - 4
    };
    assert_eq!(curves("49 30; 49 -5; 49 5; 49 -5"), 0, "long and short dashes");
    assert_eq!(curves("49 12; 49 -3; 49 0; 49 -3"), 0, "dashes and dots");
    assert_eq!(curves("49 12; 49 -3"), 1, "dashes");
    assert_eq!(curves("49 0; 49 -3"), 1, "dots");
    assert_eq!(curves("49 12; 74 2; 49 -3; 74 0; 49 1"), 1, "letters between the dashes");
    assert_eq!(curves("73 0"), 1, "continuous");
}

#[test]
fn line_types_come_from_layers_and_insertions() {
    let tables = section("TABLES", "0 TABLE; 2 LAYER; 0 LAYER; 2 axes; 70 0; 62 7; 6 CENTER; 0 ENDTAB");
    let block = "0 BLOCK; 2 B; 10 0; 20 0; 0 LINE; 8 0; 10 0; 20 0; 11 1; 21 1; 0 LINE; 8 0; 6 BYBLOCK; 10 1; 20 1; 11 2; 21 1; 0 ENDBLK";
    let file = |insert: &str| {
        let entities = format!("{SQUARE}; 0 INSERT; {insert}; 2 B; 10 0; 20 0");
        whole(&(tables.clone() + &section("BLOCKS", block) + &plain(&entities))).curves.len() - 4
    };
    assert_eq!(file("8 part"), 2);
    assert_eq!(file("8 axes"), 0);
    assert_eq!(file("8 part; 6 HIDDEN"), 1, "the entity by block");
    assert_eq!(file("8 axes; 6 CONTINUOUS"), 1, "the entity by layer 0, which the block is on");
}

#[test]
fn where_nothing_else_is_drawn_all_line_types_are_edges() {
    let drawing = drawn("0 CIRCLE; 6 CENTER; 10 0; 20 0; 40 9; 0 POINT; 10 0; 20 0");
    assert_eq!(drawing.curves.len(), 1);
    assert!(noted(&drawing, "All is drawn in line types for centre, hidden or phantom lines"));
    assert_eq!(skipped(&drawing), []);
}

// ---- hatches beside outlines ----

fn square_path(flags: u8, [x, y]: [f64; 2], side: f64) -> String {
    let (u, v) = (x + side, y + side);
    format!("92 {flags}; 72 0; 73 1; 93 4; 10 {x}; 20 {y}; 10 {u}; 20 {y}; 10 {u}; 20 {v}; 10 {x}; 20 {v}; 97 0;")
}

fn regions(drawing: &Drawing) -> Vec<(String, f64)> {
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    domain.regions().iter().map(|r| (domain.name(r.name).to_owned(), r.area)).collect()
}

const PLATE: &str = "0 LWPOLYLINE; 8 steel; 70 1; 10 0; 20 0; 10 10; 20 0; 10 10; 20 10; 10 0; 20 10";

#[test]
fn a_boundary_of_a_hatch_that_repeats_nothing_is_an_outline_of_its_layer() {
    let hole = hatch(0, &square_path(3, [2.0, 2.0], 3.0));
    let drawing = drawn(&format!("{PLATE}; {hole}"));
    assert_eq!((drawing.curves.len(), drawing.fill), (8, FillRule::EvenOdd));
    assert!(noted(&drawing, "outlines of their layers"));
    near(measure(&drawing), 100.0 - 9.0);
    // The outer loop as a hatch, the hole by a line.
    let hole = "0 CIRCLE; 8 steel; 10 5; 20 5; 40 2";
    near(measure(&drawn(&format!("{hole}; {}", hatch(0, &square_path(3, [0.0, 0.0], 10.0))))), 100.0 - 4.0 * PI);
    // One loop repeats the plate, up to its digits, and one is new.
    let both = hatch(0, &(square_path(3, [0.0004, -0.0003], 10.0) + &square_path(18, [2.0, 2.0], 3.0)));
    near(measure(&drawn(&format!("{PLATE}; {both}"))), 100.0 - 9.0);
}

#[test]
fn a_hatch_on_a_layer_of_its_own_is_a_region() {
    let frame = "0 LWPOLYLINE; 8 frame; 70 1; 10 -5; 20 -5; 10 15; 20 -5; 10 15; 20 15; 10 -5; 20 15";
    let ring = hatch(0, &(square_path(3, [0.0, 0.0], 10.0) + &square_path(18, [2.0, 2.0], 3.0)));
    let drawing = drawn(&format!("{frame}; {ring}"));
    assert!(noted(&drawing, "a region of its own extent"));
    let found = regions(&drawing);
    assert_eq!(found[0].0, "steel");
    near(found[0].1, 91.0);
    near(found.iter().map(|r| r.1).sum(), 400.0);
    assert_eq!(found.len(), 3, "what is left of the frame is drawn, too: {found:?}");
    // It also crosses an outline, and takes what it covers.
    let half = hatch(0, &square_path(3, [10.0, 0.0], 10.0));
    let found = regions(&drawn(&format!("{frame}; {half}")));
    near(found[0].1, 100.0);
    near(found.iter().map(|r| r.1).sum(), 450.0);
    let text = squinch::import::outline::to_json(&drawn(&format!("{frame}; {half}")));
    let again = squinch::import::outline::read(text.as_bytes(), "stem").unwrap();
    assert_eq!(again.fill, FillRule::EvenOddAndShapes);
    near(measure(&again), 450.0);
}

#[test]
fn what_is_hatched_on_a_layer_of_its_own_is_no_hole() {
    // A bush in a bore: by the outlines alone its ring is a hole.
    let circles = [9.0, 4.0, 2.0].map(|r| format!("0 CIRCLE; 8 rim; 10 0; 20 0; 40 {r}")).join("; ");
    let disc = |r: f64| format!("92 1; 93 1; 72 2; 10 0; 20 0; 40 {r}; 50 0; 51 360; 73 1; 97 0;");
    let bush = hatch(0, &(disc(4.0) + &disc(2.0)));
    let found = regions(&drawn(&format!("{circles}; {bush}")));
    assert_eq!(found[0].0, "steel");
    near(found[0].1, 12.0 * PI);
    // On the layer of the outlines, these decide.
    let same = circles.replace("rim", "steel");
    near(measure(&drawn(&format!("{same}; {bush}"))), (81.0 - 16.0 + 4.0) * PI);
}

#[test]
fn a_hatch_names_what_is_not_a_hole_of_it() {
    // The hole lies in the middle, and is no island of the hatch.
    let hole = "0 CIRCLE; 8 rim; 10 5; 20 5; 40 4.9";
    let plate = PLATE.replace("steel", "rim");
    let drawing = drawn(&format!("{plate}; {hole}; {}", hatch(0, &square_path(3, [0.0, 0.0], 10.0))));
    let found = regions(&drawing);
    assert_eq!((found.len(), found[0].0.as_str()), (1, "steel"));
    near(found[0].1, 100.0 - 4.9 * 4.9 * PI);
}

#[test]
fn a_polygon_of_few_corners_in_a_circle_is_an_outline_of_its_own() {
    let polygon = |corners: u32| {
        let corner = |i: u32| {
            let (sin, cos) = (f64::from(i) * 2.0 * PI / f64::from(corners)).sin_cos();
            format!("10 {}; 20 {};", 4.0 * cos, 4.0 * sin)
        };
        let path = format!("92 2; 72 0; 73 1; 93 {corners}; {} 97 0;", (0..corners).map(corner).collect::<String>());
        measure(&drawn(&format!("0 CIRCLE; 8 steel; 10 0; 20 0; 40 4; {}", hatch(0, &path))))
    };
    near(polygon(4), 16.0 * PI - 32.0);
    // As LibreCAD writes small circles.
    near(polygon(7), 16.0 * PI);
}

#[test]
fn a_polygon_with_holes_is_read_as_a_hatch() {
    let polygon =
        hatch(0, &(square_path(2, [0.0, 0.0], 10.0) + &square_path(2, [2.0, 2.0], 3.0))).replace("HATCH", "MPOLYGON");
    near(measure(&drawn(&polygon)), 91.0);
}

#[test]
fn islands_go_by_their_nesting_where_all_paths_are_external() {
    let nested = [(0.0, 10.0), (2.0, 6.0), (4.0, 2.0)].map(|(at, side)| square_path(3, [at, at], side)).concat();
    for (style, area) in [(0, 100.0 - 36.0 + 4.0), (1, 100.0 - 36.0), (2, 100.0)] {
        near(measure(&drawn(&hatch(style, &nested))), area);
    }
}

// ---- curves as they are written ----

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

// ---- what leaves the plane ----

#[test]
fn what_leaves_the_plane_is_named_and_can_be_projected() {
    let stray = "0 LINE; 5 A1; 10 0; 20 0; 30 0; 11 4; 21 0; 31 0.1; 0 LINE; 10 4; 20 0; 11 0; 21 3; 0 LINE; 10 0; 20 3; 11 0; 21 0";
    let drawing = drawn(stray);
    assert_eq!(drawing.curves.len(), 2);
    assert_eq!(drawing.off_plane.len(), 1);
    assert!(drawing.off_plane[0].entity.starts_with("LINE (handle A1"));
    assert_eq!(drawing.off_plane[0].ends, [Point::new(0.0, 0.0), Point::new(4.0, 0.0)]);
    let flatten = DxfOptions { flatten_z: true, ..DxfOptions::default() };
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

// ---- names of regions ----

/// A closed polyline around a square, on a layer.
fn square(layer: &str, x: f64, side: f64) -> String {
    let corners = [(x, 0.0), (x + side, 0.0), (x + side, side), (x, side)].map(|(x, y)| format!("10 {x}; 20 {y}; "));
    format!("0 LWPOLYLINE; 8 {layer}; 90 4; 70 1; {}", corners.concat())
}

fn region_names(entities: &str) -> Vec<String> {
    let domain = drawn(entities).arrange(&ArrangeOptions::default()).unwrap();
    domain.regions().iter().map(|region| domain.name(region.name).to_owned()).collect()
}

#[test]
fn regions_take_the_layer_of_their_outline() {
    let [steel, copper, plain] = [square("STEEL", 0.0, 4.0), square("COPPER", 10.0, 3.0), square("0", 20.0, 2.0)];
    assert_eq!(region_names(&(steel.clone() + &copper + &plain)), ["STEEL", "COPPER", "region"]);
    // Regions of one layer stay apart: the largest is the first.
    assert_eq!(region_names(&(steel.clone() + &square("STEEL", 10.0, 5.0))), ["STEEL1", "STEEL2"]);
    assert_eq!(region_names(&plain), ["region"]);
}

#[test]
fn a_text_that_stands_alone_in_a_region_names_it() {
    let squares = square("PARTS", 0.0, 4.0) + &square("PARTS", 10.0, 4.0);
    let text = |kind: &str, x: f64, said: &str| format!("0 {kind}; 8 NOTES; 10 {x}; 20 2; 40 0.5; 1 {said}; ");
    let named = |texts: &str| region_names(&(squares.clone() + texts));
    assert_eq!(named(&(text("TEXT", 1.0, "Core") + &text("MTEXT", 11.0, "{Coil\\P2}"))), ["Core", "Coil 2"]);
    // Two texts name nothing, nor does a number, nor what stands outside.
    let texts = text("TEXT", 1.0, "Core")
        + &text("TEXT", 2.0, "M8")
        + &text("TEXT", 11.0, "12.5")
        + &text("TEXT", 50.0, "Scale");
    assert_eq!(named(&texts), ["PARTS1", "PARTS2"]);
    assert!(drawn(&(squares + &texts)).skipped.iter().any(|s| s.entity == "TEXT" && s.count == 4));
}
