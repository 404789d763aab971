//! Strokes: as centre lines, and what they cover.

use super::*;

#[test]
fn centre_lines_where_nothing_is_filled() {
    let lines = r#"<g fill="none" stroke="blue"><circle r="3"/><path d="M0 0L5 5"/></g><line x2="4" stroke="red"/><path d="M1 1L2 2" stroke="red"/>"#;
    let drawing = svg(lines);
    assert_eq!(drawing.fill, FillRule::Regions);
    assert!(drawing.shapes.is_empty());
    assert_eq!(kinds(&drawing), ["arc", "line", "line", "line"]);
    assert_eq!(drawing.names.text(drawing.curves[0].name), "blue");
    assert!(stroked(lines, Strokes::Ignore).curves.is_empty());

    let both = format!(r#"{lines}<rect width="5" height="5" stroke="red"/>"#);
    let drawing = svg(&both);
    assert_eq!((drawing.fill, drawing.curves.len()), (FillRule::Shapes, 4));
    let left = ["1 circle", "2 path", "1 line"].map(|what| format!("{what}: stroke only; --strokes lines keeps them"));
    assert_eq!(left_out(&drawing), left);
    let drawing = stroked(&both, Strokes::Lines);
    assert_eq!((drawing.fill, drawing.curves.len()), (FillRule::Shapes, 8));
    assert_eq!(drawing.curves.iter().filter(|c| c.shape.is_none()).count(), 4);
    assert_eq!(stroked(&both, Strokes::Ignore).curves.len(), 4);
}

#[test]
fn invisible_strokes_are_none() {
    let drawing =
        svg(r#"<g fill="none" stroke="red"><circle r="1" stroke-width="0"/><circle r="1" stroke-opacity="0"/>
        <circle r="1" stroke="none"/></g>"#);
    assert_eq!(left_out(&drawing), ["3 circle: neither filled nor stroked"]);
}

#[test]
fn the_error_of_an_empty_drawing_says_what_was_left_out() {
    let drawing = svg("<text>A</text>");
    let error = drawing.arrange(&ArrangeOptions::default()).unwrap_err();
    assert!(error.help.contains("1 text (text has no outlines here"), "{error:?}");
}

#[test]
fn a_rectangle_over_the_page_is_a_background() {
    let page = r##"<rect width="100" height="100" fill="#fff"/>"##;
    let line = r#"<path id="part" d="M10 10H90V90H10Z" fill="none" stroke="red"/>"#;
    let drawing = svg(&format!("{page}{line}"));
    assert_eq!((drawing.fill, drawing.curves.len(), drawing.shapes.len()), (FillRule::Regions, 4, 0));
    assert_eq!(
        left_out(&drawing),
        ["1 rect: a background over the whole page, beneath outlines that are only stroked"]
    );
    assert_eq!(names(&svg(&format!(r#"{page}<rect id="a" width="5" height="5"/>{line}"#))), ["background", "a"]);
    assert_eq!(names(&svg(&format!(r#"<g id="sky">{page}</g><rect id="a" width="5" height="5"/>"#))), ["sky", "a"]);
    assert_eq!(names(&svg(page)), ["background"]);
    let upper = svg(&format!(r#"<rect id="a" width="5" height="5"/>{page}"#));
    assert_eq!(names(&upper), ["a", "#ffffff"], "under everything");
}

/// The area that the strokes of a file cover.
fn covered(inside: &str) -> f64 {
    let drawing = stroked(inside, Strokes::Area);
    regions(&drawing, false).iter().map(|region| region.1).sum()
}

#[test]
fn strokes_cover_what_pen_caps_and_joins_draw() {
    let line =
        |attributes: &str| covered(&format!(r#"<path d="M10 50H30" stroke="red" stroke-width="4" {attributes}/>"#));
    near(line(""), 80.0);
    near(line(r#"stroke-linecap="square""#), 96.0);
    near(line(r#"stroke-linecap="round""#), 80.0 + 4.0 * PI);
    near(line(r#"stroke-dasharray="5 3""#), 56.0);
    near(line(r#"stroke-dasharray="5 3" stroke-dashoffset="5""#), 44.0);
    near(line(r#"stroke-dasharray="2 3 4""#), 4.0 * (2.0 + 4.0 + 3.0 + 2.0));
    let square = |attributes: &str| {
        covered(&format!(
            r#"<rect x="20" y="20" width="20" height="20" fill="none" stroke="red" stroke-width="2" {attributes}/>"#
        ))
    };
    near(square(""), 22.0 * 22.0 - 18.0 * 18.0);
    near(square(r#"stroke-linejoin="round""#), 160.0 - (4.0 - PI));
    near(square(r#"stroke-linejoin="bevel""#), 160.0 - 2.0);
    near(square(r#"stroke-miterlimit="1.4""#), 160.0 - 2.0);
    near(square(r#"transform="scale(.5)""#), 40.0);
    near(square(r#"transform="scale(.5)" vector-effect="non-scaling-stroke""#), 12.0 * 12.0 - 8.0 * 8.0);
    near(covered(r#"<circle cx="50" cy="50" r="10" fill="none" stroke="red" stroke-width="4"/>"#), PI * (144.0 - 64.0));
    near(covered(r#"<path d="M40 50A10 10 0 0 1 60 50" fill="none" stroke="red" stroke-width="4"/>"#), PI * 40.0);
    // An open outline that ends where it began has caps, a closed one a join.
    let corner = |close: &str| {
        covered(&format!(r#"<path d="M20 20H40V40H20V20{close}" fill="none" stroke="red" stroke-width="2"/>"#))
    };
    near(corner("Z"), 160.0);
    near(corner(""), 159.0);
}

#[test]
fn a_stroke_lies_over_its_fill() {
    let inside = r#"<rect x="20" y="20" width="20" height="20" fill="navy" stroke="red" stroke-width="2"/>"#;
    let drawing = stroked(inside, Strokes::Area);
    regions_are(&drawing, false, &[("navy", 324.0), ("red", 160.0)]);
    assert_eq!(drawing.notes, Vec::<String>::new());
}

#[test]
fn offsets_of_beziers_are_near_and_say_so() {
    // A quarter of a circle, as editors draw it: off the true one by 3e-4 of the radius.
    let curve = r#"<path d="M60 50C60 55.5228 55.5228 60 50 60" fill="none" stroke="red" stroke-width="2"/>"#;
    let area = covered(curve);
    assert!((area - 10.0 * PI).abs() < 0.02, "{area}");
    let notes = stroked(curve, Strokes::Area).notes;
    assert_eq!(
        notes,
        ["Outlines of strokes along curves that are neither lines nor arcs lie within 2.00e-4 of the true ones."]
    );
}
