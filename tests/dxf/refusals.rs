//! What is refused, and where.

use super::*;

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
