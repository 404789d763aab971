//! Files: formats, encodings, bombs, errors, any bytes.

use super::*;

#[test]
fn suffix_content_and_title() {
    assert_eq!(format_of(Path::new("a.SVG")), Some(Format::Svg));
    assert_eq!(format_of(Path::new("a.svgz")), Some(Format::Svg));
    assert_eq!(Format::sniff(b"\xef\xbb\xbf<?xml version='1.0'?>\n<!-- x --><svg/>"), Some(Format::Svg));
    assert_eq!(Format::sniff(b"<?xml version='1.0'?><s:svg xmlns:s='http://www.w3.org/2000/svg'/>"), Some(Format::Svg));
    assert_ne!(Format::sniff(b"<VTKFile/>"), Some(Format::Svg));
    assert_eq!(svg("<title> A wing </title>").title, "A wing");
    assert_eq!(svg("").title, "stem");
    let prefixed = file("<s:svg xmlns:s='http://www.w3.org/2000/svg'><s:circle r='1'/><circle r='1'/></s:svg>");
    assert_eq!(prefixed.curves.len(), 2);
}

#[test]
fn compressed_files_and_other_encodings() {
    let text = format!("{OPEN}<circle id='ö' r='1'/></svg>");
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gz.write_all(text.as_bytes()).unwrap();
    let gz = gz.finish().unwrap();
    assert_eq!(Format::sniff(&gz), Some(Format::Svg));
    let of = |bytes: &[u8]| read(bytes, Format::Svg, "stem", &Options::default());
    assert_eq!(names(&of(&gz).unwrap()), ["ö"]);
    let broken = of(&gz[..gz.len() - 9]).unwrap_err();
    assert!(broken.what.starts_with("the gzip stream is broken"), "{broken}");
    let wide: Vec<u8> = format!("\u{feff}<?xml version='1.0' encoding='UTF-16'?>{text}")
        .encode_utf16()
        .flat_map(u16::to_be_bytes)
        .collect();
    assert_eq!(names(&of(&wide).unwrap()), ["ö"]);
    let mut latin = b"<?xml version='1.0' encoding='ISO-8859-1'?><svg><circle id='\xf6' r='1'/></svg>".to_vec();
    assert_eq!(names(&of(&latin).unwrap()), ["ö"]);
    latin.drain(20..42);
    let error = of(b"<svg>\n\xf6</svg>").unwrap_err();
    assert_eq!((error.line, error.what.as_str()), (Some(2), "a byte that is not UTF-8"));
}

#[test]
fn a_gzip_bomb_is_refused() {
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    let blanks = vec![b' '; 1 << 20];
    (0..130).for_each(|_| gz.write_all(&blanks).unwrap());
    let error = read(&gz.finish().unwrap(), Format::Svg, "stem", &Options::default()).unwrap_err();
    assert!(error.what.contains("more than 128 MiB"), "{error}");
}

#[test]
fn entities_unfold_within_bounds() {
    let drawing = file("<!DOCTYPE svg [<!ENTITY d 'M0 0h1v1z'>]><svg><path d='&d;'/></svg>");
    assert_eq!(drawing.curves.len(), 3);
    let mut laughs = String::from("<!DOCTYPE svg [<!ENTITY l0 'ha ha ha ha ha ha'>");
    for k in 1..10 {
        laughs += &format!("<!ENTITY l{k} '{}'>", format!("&l{};", k - 1).repeat(10));
    }
    refused(&format!("{laughs}]><svg><desc>&l9;</desc></svg>"));
    let long = format!(
        "<!DOCTYPE svg [<!ENTITY l '{}'>]><svg><desc>{}</desc></svg>",
        "x".repeat(100_000),
        "&l;".repeat(100_000)
    );
    assert!(refused(&long).what.contains("unfold"));
}

#[test]
fn errors_say_where() {
    let error = refused("<svg>\n <g>\n </svg>");
    assert_eq!((error.line, error.column.is_some()), (Some(3), true), "{error}");
    assert_eq!(refused("<svg>\n  <rect").line, Some(2));
    assert!(refused("").what.contains("XML"));
    assert!(refused("<drawing>\n</drawing>").what.contains("'drawing', not 'svg'"));
    assert!(refused("<html>\n</html>").what.contains("page of HTML"));
    assert!(refused(&format!("{OPEN}<circle r='1e31'/></svg>")).what.contains("circle has a coordinate of 1e31"));
    assert!(refused(&format!("{OPEN}<path id='p' d='M0 0L1e200 0 5 5z'/></svg>")).what.contains("path \"p\""));
    assert!(refused(&format!("{OPEN}<polygon points='0 0 1e200 0 5 5'/></svg>")).what.contains("1e200"));
    assert!(refused(&format!("{OPEN}<g transform='scale(1e40)'/></svg>")).what.contains("1e40"));
}

#[test]
fn nesting_has_no_depth() {
    let n = 100_000;
    let drawing = svg(&format!("{}<circle r='1'/>{}", "<g>".repeat(n), "</g>".repeat(n)));
    assert_eq!(drawing.curves.len(), 1);
    let style = "<style>g g g g g g z g, b a{fill:red}</style>";
    let drawing = svg(&format!("{style}{}<circle r='1'/>{}", "<g>".repeat(3000), "</g>".repeat(3000)));
    assert_eq!(drawing.curves.len(), 1);
}

const SNIPPETS: &[&str] = &[
    r##"<?xml version="1.0"?><!DOCTYPE svg [<!ENTITY e "M1 1h5v5z">]><svg viewBox="0 0 9 9" width="9mm"><style>g > .a, * #b{fill:red}</style>
    <g class="a" transform="rotate(30 1 2) skewX(3)"><path d="&e;M0 0A3 4 5 0 1 7 8 9 9 0 0 0 1 1C1 2 3 4 5 6S1 2 3 4Q1 2 3 4T5 6H3V2Z"/></g>
    <defs><symbol id="s" viewBox="0 0 1 1"><rect rx="1" width="50%" height="2em"/></symbol></defs><use href="#s" x="3" width="4"/></svg>"##,
    r##"<svg xmlns="http://www.w3.org/2000/svg"><svg x="1" width="5" viewBox="0 0 2 2" preserveAspectRatio="xMinYMax slice"><ellipse rx="3" ry="2"/>
    <polygon points="1,2 3,4 5,9" style="fill:url(#x) red;fill-rule:evenodd"/></svg><switch><line x2="5" stroke="blue"/></switch></svg>"##,
];

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = read(&bytes, Format::Svg, "stem", &Options::default());
    }

    #[test]
    fn broken_files_are_read_or_refused(
        which in 0..SNIPPETS.len(),
        edits in proptest::collection::vec((any::<prop::sample::Index>(), "[ -~]{0,6}", 0..8_usize), 0..6),
    ) {
        let mut text = SNIPPETS[which].to_owned();
        for (at, new, gone) in edits {
            let at = at.index(text.len());
            text.replace_range(at..(at + gone).min(text.len()), &new);
        }
        if let Ok(drawing) = attempt(&text, SvgOptions::default()) {
            closed(&drawing);
            for drawn in &drawing.curves {
                prop_assert!(drawn.curve.bounds().is_finite(), "{drawn:?}");
            }
        }
    }
}
