//! What cuts: clip paths, viewports, basic shapes.

use super::*;

/// Regions by name with their areas, of a file with this inside.
#[track_caller]
fn seen_as(inside: &str, wanted: &[(&str, f64)]) {
    regions_are(&svg(inside), false, wanted);
}

#[test]
fn clip_paths_cut_shapes() {
    let disc = r#"<clipPath id="k"><circle cx="50" cy="50" r="30"/></clipPath>"#;
    seen_as(&format!(r#"{disc}<rect id="r" width="100" height="100" clip-path="url(#k)"/>"#), &[("r", 900.0 * PI)]);
    // Half of it over another shape.
    seen_as(
        &format!(
            r#"{disc}<rect id="low" width="100" height="100"/><rect id="r" width="50" height="100" clip-path="url(#k)"/>"#
        ),
        &[("low", 1e4 - 450.0 * PI), ("r", 450.0 * PI)],
    );
    // By groups, one within the other.
    let two = r#"<clipPath id="a"><rect width="50" height="50"/></clipPath><clipPath id="b"><rect x="40" y="40" width="50" height="50"/></clipPath>"#;
    seen_as(
        &format!(
            r#"{two}<g clip-path="url(#a)"><g clip-path="url(#b)"><rect id="r" width="100" height="100"/></g></g>"#
        ),
        &[("r", 100.0)],
    );
    // By a clip path that is cut itself, and by one whose child is.
    let of_path = r#"<clipPath id="b" clip-path="url(#a)"><rect x="40" y="40" width="50" height="50"/></clipPath>"#;
    let of_child = r#"<clipPath id="b"><rect x="40" y="40" width="50" height="50" clip-path="url(#a)"/><rect width="7" height="1"/></clipPath>"#;
    let show = |b: &str| {
        format!(
            r#"<clipPath id="a"><rect width="50" height="50"/></clipPath>{b}<rect id="r" width="99" height="99" clip-path="url(#b)"/>"#
        )
    };
    seen_as(&show(of_path), &[("r", 100.0)]);
    seen_as(&show(of_child), &[("r", 107.0)]);
    // Units of the box; rules; use; a union.
    seen_as(
        r##"<clipPath id="k" clipPathUnits="objectBoundingBox"><circle cx=".5" cy=".5" r=".5"/></clipPath>
        <rect id="r" x="10" y="10" width="40" height="20" clip-path="url(#k)"/>"##,
        &[("r", 200.0 * PI)],
    );
    let frame = |rule: &str| {
        format!(
            r##"<clipPath id="k"><path clip-rule="{rule}" d="M0 0H40V40H0ZM10 10H30V30H10Z"/></clipPath><rect id="r" width="90" height="90" clip-path="url(#k)"/>"##
        )
    };
    seen_as(&frame("evenodd"), &[("r", 1200.0)]);
    seen_as(&frame("nonzero"), &[("r", 1600.0)]);
    seen_as(
        r##"<rect id="s" x="5" y="5" width="10" height="10" display="none"/><path id="t" d="M0 0H10V10H0Z" visibility="hidden"/>
        <clipPath id="k"><use href="#t" x="20" visibility="visible"/><path d="M0 0H10V10H0Z"/><path d="M5 0H15V10H5Z"/></clipPath>
        <rect id="r" width="90" height="90" clip-path="url(#k)"/>"##,
        &[("r", 150.0)],
    );
}

#[test]
fn the_boundary_of_a_cut_is_named_after_what_it_cuts() {
    let inside = r#"<clipPath id="k"><circle cx="50" cy="50" r="30"/></clipPath><rect id="low" width="100" height="100"/>
        <rect id="r" width="100" height="100" clip-path="url(#k)"/>"#;
    let domain = svg(inside).arrange(&ArrangeOptions::default()).unwrap();
    let arcs: Vec<_> =
        domain.curves().iter().filter(|c| c.curve.kind() == "arc").map(|c| domain.name(c.name)).collect();
    assert!(!arcs.is_empty() && arcs.iter().all(|name| *name == "r"), "{arcs:?}");
}

#[test]
fn a_clip_around_all_of_a_shape_costs_nothing() {
    let drawing = svg(
        r#"<clipPath id="k"><path d="M0 0H100V100H0Z"/></clipPath><g clip-path="url(#k)"><circle cx="9" cy="9" r="3"/></g>"#,
    );
    assert_eq!((drawing.clips.len(), drawing.curves.len()), (0, 1));
    let away = svg(
        r#"<clipPath id="k"><path d="M0 0H10V10H0Z"/></clipPath><rect width="1" height="1"/><circle cx="50" cy="9" r="3" clip-path="url(#k)"/>"#,
    );
    assert_eq!(left_out(&away), ["1 circle: cut away by a clip path or a viewport"]);
}

#[test]
fn viewports_hide_what_reaches_beyond_them() {
    seen_as(
        r#"<svg x="10" y="10" width="30" height="30"><rect id="r" width="100" height="100"/></svg>"#,
        &[("r", 900.0)],
    );
    seen_as(
        r#"<svg x="10" y="10" width="30" height="30" overflow="visible"><rect id="r" width="50" height="50"/></svg>"#,
        &[("r", 2500.0)],
    );
    seen_as(
        r##"<symbol id="s" viewBox="0 0 10 10"><circle cx="10" cy="10" r="5"/></symbol><use href="#s" id="u" width="20" height="20"/>"##,
        &[("u", 25.0 * PI)],
    );
    let page = |overflow: &str| {
        let rect = r#"<rect id="r" x="-10" width="30" height="30"/>"#;
        file(&format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" overflow="{overflow}">{rect}</svg>"#
        ))
    };
    regions_are(&page("hidden"), false, &[("r", 600.0)]);
    regions_are(&page("visible"), false, &[("r", 900.0)]);
    assert!(page("visible").notes[0].contains("overflow=\"hidden\""));
    let outside = svg(r#"<rect x="200" width="5" height="5"/><rect id="r" width="5" height="5"/>"#);
    assert_eq!(left_out(&outside), ["1 rect: wholly outside of the page"]);
}

#[test]
fn basic_shapes_cut() {
    let cut = |shape: &str, area: f64| {
        seen_as(
            &format!(r#"<rect id="r" x="10" y="10" width="40" height="20" style="clip-path: {shape}"/>"#),
            &[("r", area)],
        );
    };
    cut("inset(5px)", 300.0);
    cut("inset(1px 2px 3px 4px)", 34.0 * 16.0);
    cut("circle(10px at 50% 50%)", 100.0 * PI);
    cut("circle()", 100.0 * PI);
    cut("ellipse(25% 25%)", 50.0 * PI);
    cut("polygon(0 0, 100% 0, 0 100%)", 400.0);
    cut("path('M0 0H10V10H0Z')", 100.0);
    cut("circle(10px at 20px 20px) view-box", 100.0 * PI);
    let unread = svg(r#"<rect width="1" height="1" clip-path="blob(3)"/>"#);
    assert_eq!(left_out(&unread), ["1 rect: its clip path is of a kind that is not read; nothing is cut"]);
}

#[test]
fn clips_cut_centre_lines_exactly() {
    let inside = r#"<clipPath id="k"><circle cx="50" cy="50" r="30"/></clipPath><g fill="none" stroke="red"><rect id="a" x="40" y="40"
        width="10" height="10" clip-path="url(#k)"/><path id="b" d="M0 50H100" clip-path="url(#k)"/></g>"#;
    let drawing = svg(inside);
    assert_eq!(drawing.fill, FillRule::Regions);
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    let b = domain.curves().iter().filter(|c| domain.name(c.name) == "b").map(|c| c.curve.bounds());
    let b = b.reduce(|a, b| a.union(b)).unwrap();
    near_all(&[b.x0, b.x1], &[20.0, 80.0]);
    assert!(domain.curves().iter().all(|c| c.curve.kind() == "line"), "nothing is left of the clip itself");
}

#[test]
fn fragments_are_cut_too() {
    let inside = r#"<clipPath id="k"><rect width="20" height="100"/></clipPath><rect id="a" width="30" height="30"/>
        <rect id="b" x="10" width="30" height="30" clip-path="url(#k)"/>"#;
    regions_are(&svg(inside), true, &[("a", 600.0), ("b+a", 300.0)]);
}

#[test]
fn clip_paths_that_refer_to_themselves_end() {
    let drawing = svg(r#"<clipPath id="a"><rect width="5" height="5" clip-path="url(#b)"/></clipPath>
        <clipPath id="b"><rect width="5" height="5" clip-path="url(#a)"/></clipPath><rect id="r" width="9" height="9" clip-path="url(#a)"/>
        <rect x="20" width="1" height="1" clip-path="url(#none)"/>"#);
    assert_eq!(drawing.notes.len(), 2, "{:?}", drawing.notes);
    assert_eq!(names(&drawing).last(), Some(&"black"));
}

#[test]
fn a_clip_that_leaves_nothing_is_named() {
    let error = |inside: &str| svg(inside).arrange(&ArrangeOptions::default()).expect_err("nothing is left");
    let apart = error(
        r#"<clipPath id="k"><rect x="50" width="9" height="9"/></clipPath><rect width="9" height="9" clip-path="url(#k)"/>"#,
    );
    assert!(apart.help.contains(r#"the first by clipPath "k" (line 2)"#), "{apart}: {}", apart.help);
    // Boxes meet, outlines do not.
    let corner = error(
        r#"<clipPath id="k"><path d="M0 0L9 0L0 9z"/></clipPath><path id="p" d="M9 9L9 1L1 9z" transform="translate(2 2)" clip-path="url(#k)"/>"#,
    );
    assert!(corner.what.contains(r#"path "p""#) && corner.what.contains("a clip path"), "{corner}");
}

#[test]
fn clips_round_trip_as_outlines() {
    let drawing = svg(r#"<clipPath id="inner"><circle cx="50" cy="50" r="30"/></clipPath>
        <clipPath id="outer" clip-path="url(#inner)"><rect x="40" y="10" width="50" height="80"/><path clip-rule="evenodd" d="M20 20h15v15h-15z"/></clipPath>
        <g clip-path="url(#outer)"><rect id="a" x="10" y="10" width="80" height="80"/><circle id="b" cx="60" cy="50" r="15"/></g>
        <rect id="c" width="5" height="5"/>"#);
    assert!(drawing.clips.len() >= 2);
    let text = squinch::import::outline::to_json(&drawing);
    let again =
        read(text.as_bytes(), Format::Outline, "stem", &Options::default()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!((&again.clips, &again.shapes, &again.curves), (&drawing.clips, &drawing.shapes, &drawing.curves));
    assert_eq!(squinch::import::outline::to_json(&again), text);
    let [wanted, found] = [&drawing, &again].map(|d| d.arrange(&ArrangeOptions::default()).expect("a domain").area());
    assert_eq!(wanted.to_bits(), found.to_bits());
}
