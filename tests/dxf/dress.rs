//! Dress: headers, line ends, binary files, names.

use super::*;

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
