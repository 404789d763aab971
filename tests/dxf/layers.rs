//! Layers, line types, handles and last decimals: what of a file is read.

use super::*;

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

fn chosen(short: &str, only: &[&str], skip: &[&str]) -> Drawing {
    let globs = |texts: &[&str]| texts.iter().map(|text| text.parse().unwrap()).collect();
    let selection = Selection { layers: globs(only), skip_layers: globs(skip) };
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
