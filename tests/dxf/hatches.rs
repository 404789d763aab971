//! Hatches: pictures of shapes, and names for regions of outlines.

use super::*;

#[test]
fn a_drawing_of_hatches_is_a_picture_of_shapes() {
    let square = "92 7; 72 0; 73 1; 93 4; 10 -4; 20 -4; 10 4; 20 -4; 10 4; 20 4; 10 -4; 20 4; 97 0;";
    let drawing = drawn(&hatch(0, &format!("{square} 92 16; {}", DISC)));
    assert_eq!(drawing.fill, FillRule::Shapes);
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    assert_eq!(domain.regions().len(), 1);
    assert_eq!(domain.name(domain.regions().iter().next().unwrap().name), "steel");
    near(domain.area(), 64.0 - PI);
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
    // An elliptic arc by angles: the quarter from the major axis to the ray of 45°, closed by two lines through the
    // center.
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
    near(domain.area(), 7.0 * PI);
}

fn square_path(flags: u8, [x, y]: [f64; 2], side: f64) -> String {
    let (u, v) = (x + side, y + side);
    format!("92 {flags}; 72 0; 73 1; 93 4; 10 {x}; 20 {y}; 10 {u}; 20 {y}; 10 {u}; 20 {v}; 10 {x}; 20 {v}; 97 0;")
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
