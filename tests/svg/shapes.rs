//! Shapes and path data.

use super::*;

#[test]
fn a_circle_is_an_arc_and_lies_upward() {
    let drawing = svg(r#"<circle cx="30" cy="20" r="10"/>"#);
    assert_eq!(drawing.format, "svg");
    let Curve::Arc(arc) = &drawing.curves[0].curve else { panic!("{:?}", drawing.curves) };
    assert_eq!((arc.center, arc.radius), (Point::new(30.0, 80.0), 10.0));
    assert_eq!(drawing.fill, FillRule::Shapes);
    near(areas(&drawing)[0].abs(), 100.0 * PI);
}

#[test]
fn an_ellipse_is_exact() {
    let drawing = svg(r#"<ellipse cx="30" cy="20" rx="10" ry="5"/><ellipse rx="4" cx="9" cy="9" ry="4"/>"#);
    assert_eq!(kinds(&drawing), ["ellipse", "arc"]);
    near(areas(&drawing)[0].abs(), 50.0 * PI);
}

#[test]
fn rectangles_are_lines_and_arcs() {
    let drawing = svg(r#"<rect x="10" y="10" width="20" height="10"/>
        <rect x="10" y="30" width="20" height="10" rx="2"/>
        <rect x="10" y="50" width="20" height="10" rx="2" ry="4"/>
        <rect x="10" y="70" width="20" height="10" rx="90" ry="90"/>
        <rect x="40" y="70" width="10" height="10" ry="90"/>"#);
    closed(&drawing);
    let rounded = 200.0 - (4.0 - PI) * 8.0;
    let circle = 25.0 * PI;
    let found: Vec<f64> = areas(&drawing).iter().map(|a| a.abs()).collect();
    near_all(&found, &[200.0, 200.0 - (4.0 - PI) * 4.0, rounded, 50.0 * PI, circle]);
    let round = ["line", "arc", "line", "arc", "line", "arc", "line", "arc"];
    assert_eq!(kinds(&drawing)[..12], [["line"; 4].as_slice(), &round].concat());
    assert_eq!(kinds(&drawing)[12..20], round.map(|k| if k == "arc" { "ellipse" } else { k }));
    // No edge is left where the corners meet.
    assert_eq!(kinds(&drawing)[20..], ["ellipse", "ellipse", "ellipse", "ellipse", "arc", "arc", "arc", "arc"]);
    ends(&drawing.curves[0].curve, (10.0, 90.0), (30.0, 90.0));
}

#[test]
fn lines_polylines_and_polygons() {
    let drawing = svg(r#"<polygon points="10,10 20,10 20,20"/><polyline points="30 10 40 10 40 20"/>
        <line x1="0" y1="0" x2="9" y2="9" stroke="red"/>"#);
    assert_eq!(kinds(&drawing), ["line"; 6]);
    closed(&drawing);
    near_all(&areas(&drawing), &[-50.0, -50.0]);
    assert_eq!(left_out(&drawing), ["1 line: stroke only; --strokes lines keeps them"]);
    let odd = svg(r#"<polygon id="p" points="10,10 20,10 20,20 7"/>"#);
    near_all(&areas(&odd), &[-50.0]);
    assert!(odd.notes[0].starts_with("polygon \"p\" (line 2): drawn up to the error in its data at line 2, column"));
}

/// The path and the same path in other commands are the same curves.
#[track_caller]
fn same(a: &str, b: &str) {
    let curves = |d: &str| path(d).curves.into_iter().map(|c| c.curve).collect::<Vec<_>>();
    assert_eq!(curves(a), curves(b));
}

#[test]
fn every_command_absolute_and_relative() {
    same("M10 10H20V20L10 20Z", "m10 10h10v10l-10 0z");
    same("M10 10 20 10 20 20z", "M10,10L20,10L20,20L10,10");
    same("m10 10 10 0 0 10z", "M10 10L20 10 20 20z");
    same("M1 1C2 5 6 5 7 1z", "m1 1c1 4 5 4 6 0z");
    same("M1 1C2 5 6 5 7 1S12 -3 13 1z", "M1 1C2 5 6 5 7 1C8 -3 12 -3 13 1z");
    same("M1 1S6 5 7 1z", "M1 1C1 1 6 5 7 1z");
    same("M1 1Q4 5 7 1T13 1z", "M1 1Q4 5 7 1Q10 -3 13 1z");
    same("M1 1T7 1L4 5z", "M1 1Q1 1 7 1L4 5z");
    same("M1 1Q4 5 7 1S12 9 13 1z", "M1 1Q4 5 7 1C7 1 12 9 13 1z");
    same("M1 1a5 5 0 0110 0z", "M1 1A5 5 0 0 1 11 1z");
    // After a closed subpath the next begins where that began.
    same("M10 10h5v5zh-5v-5z", "M10 10h5v5zM10 10h-5v-5z");
    assert_eq!(
        kinds(&path("M1 1C2 5 6 5 7 1Q9 9 8 8A3 3 0 0 0 9 9A3 4 0 0 0 1 1")),
        ["bezier", "bezier", "arc", "ellipse"]
    );
}

#[test]
fn open_subpaths_are_closed_as_painting_does() {
    let drawing = path("M10 10H20V20M40 40h10v10");
    near_all(&areas(&drawing), &[-100.0]);
    assert_eq!(drawing.curves.len(), 6);
    assert!(drawing.curves.iter().all(|c| c.shape == drawing.curves[0].shape));
}

#[test]
fn arcs_take_the_side_and_the_share_that_the_flags_say() {
    // Of a circle of radius 10 over a chord of 10: the small segment, and the rest of the circle.
    let small = 100.0 * (PI / 6.0) - 25.0 * 3_f64.sqrt();
    let large = 100.0 * PI - small;
    for (flags, area) in [("0 1", -small), ("0 0", small), ("1 1", -large), ("1 0", large)] {
        near_all(&areas(&path(&format!("M50 50A10 10 0 {flags} 60 50z"))), &[area]);
        // The same on an ellipse twice as wide, turned by a quarter.
        let drawing = path(&format!("M50 50A10 20 90 {flags} 70 50z"));
        near_all(&areas(&drawing), &[2.0 * area]);
        let curve = &drawing.curves[0].curve;
        ends(curve, (50.0, 50.0), (70.0, 50.0));
        assert_eq!(curve.kind(), "ellipse");
    }
    // Radii that are too small grow until they reach; of no radius comes a line.
    near_all(&areas(&path("M50 50A1 1 0 0 1 60 50z")), &[-12.5 * PI]);
    near_all(&areas(&path("M50 50A1 2 0 0 0 60 50z")), &[25.0 * PI]);
    assert_eq!(kinds(&path("M50 50A0 2 0 0 0 60 50v9z")), ["line"; 3]);
    near_all(&areas(&path("M50 50A-10 10 0 0 1 60 50z")), &[-small]);
    // A whole circle of two halves.
    near_all(&areas(&path("M40 50a10 10 0 1 0 20 0a10 10 0 1 0 -20 0")), &[100.0 * PI]);
}

#[test]
fn the_ends_of_arcs_meet_their_neighbours_bit_for_bit() {
    closed(&path("M0.1 0.2A3 5 33 0 1 7.7 1.3A2 2 0 1 0 5.5 3.3Q1 2 0.4 9.9z"));
    let turned = svg(
        r#"<g transform="rotate(33) scale(1 1.7) skewX(12)"><path d="M0.1 0.2A3 5 33 0 1 7.7 1.3A2 2 0 1 0 5.5 3.3z"/></g>"#,
    );
    closed(&turned);
}

#[test]
fn a_path_is_drawn_up_to_its_error() {
    let drawing = svg("<path id='p'\n d='M10 10H20V20L30'/>");
    near_all(&areas(&drawing), &[-50.0]);
    let note = &drawing.notes[0];
    assert!(note.starts_with("path \"p\" (line 2): drawn up to the error in its data at line 3, column 20"), "{note}");
    near_all(&areas(&svg("<path d='M10 10H20V20A1 1 0 2 0 9 9'/>")), &[-50.0]);
    assert_eq!(left_out(&drawing), ["1 path: in part: what follows an error in its data"]);
    // Of others there is something to draw.
    let other = svg("<path d='L10 10H20V20'/><rect width='1' height='1'/>");
    assert!(other.curves.len() == 4 && other.notes.len() == 1);
}

#[test]
fn a_drawing_of_nothing_but_errors_is_refused_at_the_first() {
    let error =
        refused("<svg xmlns='http://www.w3.org/2000/svg'>\n <path id='p' d='M0 0\n L 5,x 7'/><path d='z'/></svg>");
    assert_eq!((error.line, error.column), (Some(3), Some(6)), "{error:?}");
    assert!(error.what.starts_with("path \"p\" (line 2) has an error in its data"), "{error:?}");
}

#[test]
fn nothing_is_made_of_nothing() {
    let drawing =
        svg(r#"<rect width="0" height="5"/><circle r="0"/><ellipse rx="1" ry="-1"/><path d=""/><path d="M5 5"/>
        <path d="M5 5L5 5C5 5 5 5 5 5H10V10H10z"/><polygon points="1 1"/><line x1="3" x2="3"/>"#);
    assert_eq!(drawing.curves.len(), 3);
    assert_eq!(
        left_out(&drawing),
        [
            "1 rect: it has no extent",
            "1 circle: it has no extent",
            "1 ellipse: it has no extent",
            "2 path: it has no extent",
            "1 polygon: it has no extent",
            "1 line: it has no extent",
            "7 path command: of no length"
        ]
    );
}
