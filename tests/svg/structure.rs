//! Structure: `use`, `switch`, budgets, what is not drawn.

use super::*;

#[test]
fn use_shows_what_it_refers_to() {
    let drawing = svg(
        r##"<use xlink:href="#r" x="10"/><use href="#r" transform="translate(20)" y="5"/><use href="#s" width="50" height="50"/>
        <defs><rect id="r" width="2" height="1"/></defs>
        <symbol id="s" viewBox="0 0 10 10"><circle id="c" cx="5" cy="5" r="5"/></symbol>"##,
    );
    let boxes: Vec<_> = drawing.curves.iter().map(|c| c.curve.bounds()).collect();
    assert_eq!((boxes[0].x0, boxes[0].y0), (10.0, 100.0));
    assert_eq!((boxes[4].x0, boxes[4].y0), (20.0, 95.0));
    let Curve::Arc(arc) = &drawing.curves[8].curve else { panic!() };
    assert_eq!((arc.center, arc.radius), (Point::new(25.0, 75.0), 25.0));
    assert_eq!(names(&drawing), ["r", "r", "c"]);
    assert_eq!(drawing.shapes.iter().next().unwrap().entity, "rect \"r\" (line 3, shown by use (line 2))");
    assert!(drawing.curves[1].entity.ends_with("), curve 2"));
}

#[test]
fn a_use_inherits_to_what_it_shows_and_names_it() {
    let drawing = svg(
        r##"<defs><g id="g"><rect width="2" height="1"/><rect id="own" fill="red" width="1" height="1"/></g></defs>
        <use id="left" href="#g" fill="blue"/>"##,
    );
    assert_eq!(names(&drawing), ["left", "own"]);
}

#[test]
fn use_that_refers_to_itself_ends() {
    for inside in [
        r##"<g id="a"><use href="#a"/><rect width="1" height="1"/></g>"##,
        r##"<g id="a"><use href="#b"/><rect width="1" height="1"/></g><defs><g id="b"><use href="#a"/></g></defs>"##,
        r##"<defs><g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g></defs><use href="#a"/>"##,
        r##"<use id="u" href="#u"/>"##,
    ] {
        let drawing = svg(inside);
        assert!(left_out(&drawing).iter().any(|s| s.ends_with("use: it refers to itself")), "{:?}", drawing.skipped);
    }
    let nothing = svg(r##"<use href="#x"/><use href="other.svg#x"/><use/>"##);
    assert_eq!(left_out(&nothing), ["2 use: it refers to nothing", "1 use: it refers to another file"]);
}

#[test]
fn use_upon_use_has_a_budget() {
    let mut text = String::from(r#"<g id="g0"><rect width="1" height="1"/></g>"#);
    for k in 1..40 {
        text += &format!(r##"<g id="g{k}"><use href="#g{0}"/><use href="#g{0}"/></g>"##, k - 1);
    }
    let error = refused(&format!("{OPEN}<defs>{text}</defs><use href=\"#g39\"/></svg>"));
    assert!(error.what.contains("more than 1000000"), "{error}");
}

#[test]
fn switch_takes_the_first_child_for_us() {
    let drawing =
        svg(r#"<switch><foreignObject requiredExtensions="http://x"/><g systemLanguage="de"><circle r="1"/></g>
        <g systemLanguage="fr, en-GB"><rect width="1" height="1"/></g><g><circle r="2"/></g></switch>"#);
    assert_eq!(drawing.curves.len(), 4);
    assert!(drawing.skipped.is_empty());
}

#[test]
fn what_is_not_drawn_is_counted_or_hidden() {
    let drawing = svg(r##"<defs><rect width="1" height="1"/></defs><g display="none"><rect width="1" height="1"/></g>
        <rect style="opacity:0" width="1" height="1"/><g visibility="hidden"><rect width="1" height="1"/>
        <rect visibility="visible" id="seen" width="1" height="1"/></g><text>A</text><image/><foreignObject/>
        <clipPath id="c"><rect x="5" width="1" height="1"/></clipPath><rect id="clipped" clip-path="url(#c)" width="1" height="1"/>
        <rect fill="none" width="1" height="1"/><wedge/><marker><rect width="1" height="1"/></marker>
        <path id="m" marker-end="url(#x)" d="M0 0h1v1z"/><pattern id="p"/><rect id="f" mask="url(#x)" filter="url(#x)" fill="url(#p)" width="1" height="1"/>
        <rect id="a" width="1" height="1"><animate/></rect>"##);
    assert_eq!(names(&drawing), ["seen", "m", "f", "a"]);
    assert_eq!(drawing.notes, ["Elements with a mask: 1; masks are not applied: all of these elements is read."]);
    assert_eq!(
        left_out(&drawing),
        [
            "1 g: display is none",
            "1 rect: opacity is 0",
            "1 rect: visibility is hidden",
            "1 text: text has no outlines here; convert it to paths",
            "1 image: a raster image has no curves",
            "1 foreignObject: it is not SVG",
            "1 rect: neither filled nor stroked",
            "1 unknown element: it is not an element that SVG draws",
            "1 path: markers are not drawn",
            "1 rect: masks are not applied",
            "1 rect: filters are not applied",
            "1 rect: patterns are not drawn; the outline is filled whole",
            "1 rect: cut away by a clip path or a viewport"
        ]
    );
}
