//! Files: formats by name and content, the samples and the shared cases, any bytes.

use super::*;

#[test]
fn formats_by_suffix_name_and_content() {
    let of = |name: &str| format_of(Path::new(name));
    assert_eq!(of("a/b.DAT"), Some(Format::Airfoil));
    assert_eq!(
        (of("b.txt"), of("b.poly"), of("b.node")),
        (Some(Format::Airfoil), Some(Format::Poly), Some(Format::Node))
    );
    assert_eq!((of("b.json"), of("b.xyz"), of("dat")), (Some(Format::Outline), None, None));
    for format in Format::ALL {
        assert_eq!(Format::from_name(format.name()), Some(format));
    }
    assert_eq!(Format::sniff(SQUARE.as_bytes()), Some(Format::Poly));
    assert_eq!(Format::sniff(b"2 2\n1 0 0\n2 1 1\n"), Some(Format::Node));
    assert_eq!(Format::sniff(EVERYTHING.as_bytes()), Some(Format::Outline));
    assert_eq!(Format::sniff(format!("Name\n{}", lines(&contour())).as_bytes()), Some(Format::Airfoil));
    assert_eq!((Format::sniff(b""), Format::sniff(b"hello\nworld")), (None, None));
}

fn files(folder: &Path, suffix: &str) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut found: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    found.retain(|p| p.extension().is_some_and(|s| s == suffix));
    found.sort();
    found
}

fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples")
}

/// The collection of cases that some machines hold beside the repository.
fn shared(kind: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let place = |up: &str| root.join(up).join("shared/cases").join(kind);
    if place("..").is_dir() { place("..") } else { place("../..") }
}

fn read_file(path: &Path, options: &Options) -> Result<Drawing, ImportError> {
    let stem = path.file_stem().unwrap().to_str().unwrap();
    read(&std::fs::read(path).unwrap(), format_of(path).unwrap(), stem, options)
}

#[test]
fn samples_read_without_a_note() {
    for name in ["naca4412.dat", "two_element.dat", "tangent_curves.json", "plate.json", "transition.json"] {
        let path = samples().join(name);
        let drawing = read_file(&path, &Options::default()).unwrap();
        assert!(drawing.notes.is_empty() && drawing.skipped.is_empty(), "{name}: {:?}", drawing.notes);
        round_trips(&drawing);
    }
    let wedges = files(&samples().join("wedges"), "poly");
    assert_eq!(wedges.len(), 8);
    for path in wedges {
        let drawing = read_file(&path, &Options::default()).unwrap();
        let (a, b) = (&curves(&drawing, "2")[0], &curves(&drawing, "2")[1]);
        let angle = a.direction_at(End::Start).cross(b.direction_at(End::Start)).asin().to_degrees();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        assert!((angle - stem.trim_start_matches("wedge_").parse::<f64>().unwrap()).abs() < 1e-9);
    }
}

#[test]
fn the_sample_section_is_naca_4412() {
    let drawing = read_file(&samples().join("naca4412.dat"), &section_only()).unwrap();
    assert_eq!(drawing.title, "NACA 4412");
    // The thickness is set off square to the camber line on both sides, so the area is its integral along that line.
    let half = |x: f64| 0.6 * (0.2969 * x.sqrt() - x * (0.126 + x * (0.3516 - x * (0.2843 - x * 0.1015))));
    let slope = |x: f64| if x < 0.4 { 0.5 * (0.4 - x) } else { 0.08 / 0.36 * (0.4 - x) };
    let strip = |i: i32| {
        let x = (f64::from(i) + 0.5) * 1e-4;
        2.0 * half(x) * (1.0 + slope(x) * slope(x)).sqrt() * 1e-4
    };
    let area: f64 = (0..10_000).map(strip).sum();
    let found: f64 = drawing.curves.iter().map(|c| c.curve.signed_area(Point::ORIGIN)).sum();
    assert!((found - area).abs() < 1e-5, "{found} {area}");
}

#[test]
fn the_shared_airfoils_read_with_every_trailing_edge() {
    for path in files(&shared("airfoil"), "dat") {
        let name = path.file_name().unwrap().to_str().unwrap();
        for edge in [TrailingEdge::Keep, TrailingEdge::Sharp, TrailingEdge::Blunt, TrailingEdge::Round] {
            let result = read_file(&path, &airfoil(edge, 20.0, 4.0));
            if name.contains("wrong_format") {
                assert_eq!(result.unwrap_err().line, Some(32));
                continue;
            }
            let drawing = result.unwrap_or_else(|e| panic!("{name}: {e}"));
            let first = if drawing.names.find("upper1").is_some() { "1" } else { "" };
            let (upper, lower) = (one(&drawing, &format!("upper{first}")), one(&drawing, &format!("lower{first}")));
            assert_eq!(upper.end(), lower.start(), "{name}");
            assert!(upper.tangent(1.0, End::Finish).cross(lower.tangent(0.0, End::Start)).abs() < 1e-6, "{name}");
            let te = curves(&drawing, &format!("te{first}"));
            assert!(te.is_empty() == (upper.start() == lower.end()), "{name}");
            assert!(edge != TrailingEdge::Sharp || te.is_empty(), "{name}");
            assert!(matches!(edge, TrailingEdge::Keep | TrailingEdge::Sharp) || !te.is_empty(), "{name}");
            // Once around turns by π and the trailing edge's angles; concave parts and rounded corners (2.25 π of a
            // flat back) add to that, oscillations many times as much.
            let turning = upper.turning(0.0, 1.0) + lower.turning(0.0, 1.0);
            assert!(turning < 2.4 * std::f64::consts::PI, "{name}: {turning}");
        }
    }
}

#[test]
fn the_shared_graphs_read() {
    for kind in ["poly", "plsg"] {
        for path in files(&shared(kind), "poly") {
            let text = std::fs::read_to_string(&path).unwrap();
            let header = text.lines().find(|l| !l.starts_with('#')).unwrap();
            let count: usize = header.split_whitespace().next().unwrap().parse().unwrap();
            let drawing = read_file(&path, &Options::default()).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            assert!(drawing.curves.len() + drawing.points.len() > 0);
            assert!(drawing.points.len() <= count);
        }
    }
}

#[test]
#[cfg(not(feature = "cad"))]
fn a_build_without_the_step_reader_says_how_to_get_one() {
    assert_eq!(format_of(Path::new("part.stp")), Some(Format::Step));
    assert_eq!(Format::sniff(b"\xef\xbb\xbf ISO-10303-21;\nHEADER;"), Some(Format::Step));
    let error = read(b"ISO-10303-21;", Format::Step, "part", &Options::default()).expect_err("no reader");
    assert_eq!(
        (error.what.as_str(), error.help.as_str()),
        ("this build has no STEP reader", "build one that has: cargo install --locked --path . --features cad")
    );
}

fn reads_or_refuses(bytes: &[u8]) {
    for format in Format::ALL {
        for edge in [TrailingEdge::Keep, TrailingEdge::Sharp, TrailingEdge::Blunt, TrailingEdge::Round] {
            let options = Options { nodes: Some(bytes.to_vec()), ..airfoil(edge, 20.0, 3.0) };
            match read(bytes, format, "any", &options) {
                Ok(drawing) => assert!(drawing.bounds().is_none_or(|b| b.area().is_finite() || b.width() > 1e150)),
                Err(error) => assert!(!error.what.is_empty() && !error.help.is_empty()),
            }
            if format != Format::Airfoil {
                break;
            }
        }
    }
    let _ = Format::sniff(bytes);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn truncated_and_mutilated_files_never_panic(
        which in any::<prop::sample::Index>(),
        cut in 0.0..1.0f64,
        edits in prop::collection::vec((0.0..1.0f64, prop::sample::select(&b"0179.-+eE,; \n\t#{}[]\"x\xff\x00"[..])), 0..6),
    ) {
        let mut bytes = which.get(&seeds()).clone();
        for (at, byte) in edits {
            let at = (at * bytes.len() as f64) as usize;
            bytes[at] = byte;
        }
        let whole = cut < 0.5;
        if !whole {
            bytes.truncate((cut * bytes.len() as f64) as usize);
        }
        reads_or_refuses(&bytes);
    }

    #[test]
    fn garbage_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        reads_or_refuses(&bytes);
    }

    #[test]
    fn points_anywhere_never_panic(
        points in prop::collection::vec((-4..5i32, -4..5i32), 0..12),
        scale in prop::sample::select(&[1.0, 1e-30, 1e30, 1e-160, 1e90, 1e160, 1e300][..]),
    ) {
        let text: String = points.iter().map(|(x, y)| format!("{} {}\n", f64::from(*x) * scale, f64::from(*y) * scale)).collect();
        reads_or_refuses(text.as_bytes());
    }
}
