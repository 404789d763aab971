//! Style sheets, selectors, paint, names, layers, colours.

use super::*;

#[test]
fn style_sheets_cascade_by_specificity() {
    let drawing = svg(r#"<style>
        /* a { comment } */ @font-face { font-family: x; src: url("a;b{") } @media print { rect { fill: red } }
        * { fill: #010101 } rect { fill: #020202 } .a, .b { fill: #030303 } rect.a { fill: #040404 }
        #x { fill: #050505 } g > .c { fill: #060606 } g .d { fill: #070707 } g > .d.late { fill: #080808 }
        .e { fill: #090909 !important } [width] { fill: red } .f { fill: nonsense }
        </style>
        <circle r="1"/><rect width="1" height="1"/><rect class="z b" width="1" height="1"/><rect class="a" width="1" height="1"/>
        <g><rect class="c" width="1" height="1"/><a><rect class="c" width="1" height="1"/><rect class="d late" width="1" height="1"/></a></g>
        <rect class="e" style="fill:#0a0a0a" width="1" height="1"/><rect fill="red" class="f" style="fill: #0A0A0A ;" width="1" height="1"/>
        <rect class="f" fill="red" width="1" height="1"/><g><path id="" class="x" style="fill:none" d="M0 0h1v1z"/></g>"#);
    let wanted = ["#010101", "red", "red", "#040404", "#060606", "red", "#070707", "#090909", "#0a0a0a", "red"];
    assert_eq!(names(&drawing), wanted);
    assert!(!drawing.notes.iter().any(|note| note.contains("style sheet")), "{:?}", drawing.notes);
    let unread = svg("<style>g:has(a), b { fill: red } @supports (fill: red) { a { fill: red } }</style>").notes;
    assert_eq!(unread, ["2 selectors or at-rules of the style sheet are of kinds that are not read."]);
    let ids = svg(r#"<style>#x { fill: none } .y { fill-rule: evenodd }</style><rect id="x" width="1" height="1"/>
        <g class="y"><rect id="even" width="1" height="1"/><rect id="odd" fill-rule="nonzero" width="1" height="1"/></g>"#);
    assert_eq!(names(&ids), ["even", "odd"]);
    assert_eq!(ids.shapes.iter().map(|s| s.even_odd).collect::<Vec<_>>(), [true, false]);
}

#[test]
fn matching_selectors_has_a_budget() {
    let rules = "z g { fill: red }".repeat(300);
    let (open, close) = ("<g>".repeat(3000), "</g>".repeat(3000));
    let error = refused(&format!("<svg><style>{rules}</style>{open}{close}</svg>"));
    assert!(error.what.contains("too many rules"), "{error}");
}

#[test]
fn paint_is_inherited_and_named() {
    let drawing = svg(
        r##"<g fill="RED" color="#ABC"><circle r="1"/><circle r="1" fill="rgb(0,128,255)"/><circle r="1" fill="currentColor"/>
        <circle r="1" fill="inherit"/><circle r="1" fill="transparent"/><circle r="1" fill-opacity="0" stroke="blue"/>
        <circle r="1" fill="url(#none)"/><circle r="1" fill="url(#none) lime"/><circle r="1" fill="url(#grad)"/></g>
        <linearGradient id="grad"><stop/></linearGradient><circle r="1" fill="hsl(120, 100%, 50%)"/>"##,
    );
    assert_eq!(names(&drawing), ["red", "#0080ff", "#aabbcc", "red", "#00ff00", "grad", "#00ff00"]);
    assert_eq!(
        left_out(&drawing),
        ["2 circle: neither filled nor stroked", "1 circle: stroke only; --strokes lines keeps them"]
    );
}

#[test]
fn layers_name_before_ids_and_ids_before_colours() {
    let drawing =
        svg(r#"<g inkscape:groupmode="layer" inkscape:label="Hull &amp; deck" id="layer1"><circle r="1" id="c"/>
        <g id="g"><circle r="1"/></g></g><g id="g2"><g><circle r="1"/><circle r="1" id="own"/></g></g>
        <g inkscape:label="no layer"><circle r="1" fill="navy"/></g>"#);
    assert_eq!(names(&drawing), ["Hull & deck", "Hull & deck", "g2", "own", "navy"]);
    let boundaries: Vec<_> = drawing.curves.iter().map(|c| drawing.names.text(c.name)).collect();
    assert_eq!(boundaries, names(&drawing));
}

fn chosen(inside: &str, only: &[&str], skip: &[&str]) -> Drawing {
    let globs = |texts: &[&str]| texts.iter().map(|text| text.parse().unwrap()).collect();
    let selection = Selection { layers: globs(only), skip_layers: globs(skip) };
    let text = format!("{OPEN}{inside}</svg>");
    read(text.as_bytes(), Format::Svg, "stem", &Options { selection, ..Options::default() }).unwrap()
}

#[test]
fn layers_and_ids_choose_what_is_read() {
    let inside = r##"<g inkscape:groupmode="layer" inkscape:label="Part"><g id="plate"><rect id="r1" width="9" height="9"/></g></g>
        <g inkscape:groupmode="layer" inkscape:label="Frame 1"><rect id="r2" width="90" height="90"/></g>"##;
    let count = |only: &[&str], skip: &[&str]| chosen(inside, only, skip).shapes.len();
    assert_eq!(count(&[], &[]), 2);
    assert_eq!(count(&["Part"], &[]), 1);
    assert_eq!(count(&["plate"], &[]), 1, "a group around it");
    assert_eq!(count(&["r?"], &["Frame*"]), 1);
    assert_eq!(left_out(&chosen(inside, &[], &["r*"])), ["2 rect: not of the layers that were asked for"]);
    let missed = chosen(inside, &[], &["Frmae 1"]).unmatched;
    assert_eq!((missed[0].asked.as_str(), missed[0].near[0].as_str()), ("--skip-layers Frmae 1", "Frame 1"));
    let layers = svg(inside).layers;
    let listed: Vec<_> = layers.iter().map(|layer| (layer.name.as_str(), layer.line_types[""])).collect();
    assert_eq!(listed, [("Part", 1), ("Frame 1", 1)]);
}

#[test]
fn curves_know_the_last_decimal_of_their_numbers() {
    let unit = |inside: &str| stroked(inside, Strokes::Lines).curves[0].last_decimal;
    let line = |d: &str| unit(&format!(r#"<path fill="none" stroke="red" d="{d}"/>"#));
    near(line("M0 0H80V.05"), 0.01);
    near(line("M0 0h8.125v-2.5"), 0.001);
    near(line("M0 0H80V60"), 0.0);
    near(unit(r#"<g transform="scale(10)"><polyline fill="none" stroke="red" points="0 0 1 2.5"/></g>"#), 1.0);
}

#[test]
fn style_sheets_select_by_attribute_place_and_medium() {
    let drawing = svg(
        r#"<style>:root { --c: none } rect[data-k="x"] { display: none } rect:nth-child(4) { fill: none } .v { fill: var(--c) }
        .w { fill: var(--none, red) } @media print { #a { display: none } } @media screen and (prefers-color-scheme: dark) { * { fill: none } }
        @media screen { #c { display: none } }</style>
        <rect id="h" data-k="x" width="1" height="1"/><rect id="a" width="1" height="1"/><rect id="n" width="1" height="1"/>
        <rect id="v" class="v" width="1" height="1"/><rect class="w" width="1" height="1"/><rect id="c" width="1" height="1"/>"#,
    );
    assert_eq!(names(&drawing), ["a", "red"]);
    assert_eq!(drawing.notes, Vec::<String>::new());
}

#[test]
fn regions_know_the_colours_of_their_shapes() {
    let drawing = svg(
        r##"<linearGradient id="fade"><stop offset="0" stop-color="#000"/><stop offset="1" stop-color="#fff"/></linearGradient>
        <linearGradient id="again" xmlns:x="http://www.w3.org/1999/xlink" x:href="#fade"/><linearGradient id="empty"/>
        <rect id="a" width="5" height="5" fill="#ff8000"/><rect id="b" x="10" width="5" height="5" fill="url(#again)"/>
        <g opacity=".5"><rect id="c" x="20" width="5" height="5" fill="lime" fill-opacity="50%"/></g>
        <rect id="gone" width="9" height="9" fill="url(#empty)"/>"##,
    );
    assert_eq!(names(&drawing), ["a", "b", "c"], "a gradient without stops paints nothing");
    let colours: Vec<[u8; 4]> = drawing.colours.values().map(|colour| colour.0).collect();
    assert_eq!(colours, [[255, 128, 0, 255], [128, 128, 128, 255], [0, 255, 0, 64]]);
}

#[test]
fn colours_reach_gltf_and_vtu() {
    let drawing = svg(r##"<rect id="a" width="5" height="5" fill="#ff8000" fill-opacity=".5"/>"##);
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap().split_to_turning(0.5);
    let mesh = refine(&domain, &lopping::Options::default(), Until::End, &mut |_| true).unwrap().mesh.unwrap();
    let written = |format| encode(&mesh, &[], format, &WriteOptions::default()).unwrap().concat();
    let text = written(meshio::Format::Gltf);
    let document: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let material = document["materials"].as_array().unwrap().iter().find(|m| m["name"] == "a").unwrap();
    let factor = &material["pbrMetallicRoughness"]["baseColorFactor"];
    // Linear light: 128 of 255 in sRGB is 0.2159.
    let wanted = [1.0, 0.2159, 0.0, 0.502];
    wanted
        .iter()
        .enumerate()
        .for_each(|(k, part)| assert!((factor[k].as_f64().unwrap_or(0.0) - part).abs() < 1e-3, "{factor}"));
    assert_eq!(material["alphaMode"], "BLEND");
    assert!(String::from_utf8_lossy(&written(meshio::Format::Vtu)).contains(r#"Name="colour" NumberOfComponents="4""#));
}

#[test]
fn several_colours_of_one_name_are_told() {
    let layer = |inside: &str| format!(r#"<g inkscape:groupmode="layer" inkscape:label="skin">{inside}</g>"#);
    let drawing =
        svg(&layer(r#"<rect width="5" height="5" fill="red"/><rect x="20" width="9" height="9" fill="blue"/>"#));
    let colours: Vec<[u8; 4]> = drawing.colours.values().map(|colour| colour.0).collect();
    assert_eq!(colours, [[0, 0, 255, 255]], "of most of the area");
    assert!(
        drawing.notes.iter().any(|note| note.contains("several colours: 1, the first 'skin'")),
        "{:?}",
        drawing.notes
    );
    let one = svg(&layer(r#"<rect width="5" height="5" fill="red"/><rect x="20" width="9" height="9" fill="red"/>"#));
    assert_eq!(one.notes, [""; 0]);
}

#[test]
fn values_that_are_not_read_are_told() {
    let drawing = svg(r#"<circle id="c" cx="50" cy="50" style="r: calc(10px + 2px)"/>
        <rect width="9" height="9" style="fill: var(--none)"/><rect width="9" height="9" style="fill: var(--none, red)"/>"#);
    let told: Vec<&String> = drawing.notes.iter().filter(|note| note.starts_with("Values of style")).collect();
    assert_eq!(told.len(), 1, "{:?}", drawing.notes);
    assert!(told[0].contains(": 2, the first 'r: calc(10px + 2px)' of circle \"c\" (line 2)"), "{told:?}");
}
