//! Airfoil sections as people and programs write them, and files that are none.

use squinch::curve::Curve;
use squinch::domain::Drawing;
use squinch::geometry::Point;
use squinch::import::{self, Format, ImportError, tell_format};
use squinch::section;
use std::path::Path;

fn read(bytes: &[u8], format: Format, stem: &str, options: &section::Options) -> Result<Drawing, ImportError> {
    section::drawn(import::read(bytes, format, stem, &import::Options::default())?, options)
}

fn options() -> section::Options {
    section::Options { far_field: 0.0, ..section::Options::default() }
}

fn tried(text: &str) -> Result<Drawing, ImportError> {
    read(text.as_bytes(), Format::Airfoil, "stem", &options())
}

#[track_caller]
fn dat(text: &str) -> Drawing {
    tried(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[track_caller]
fn refused(text: &str) -> ImportError {
    match tried(text) {
        Err(error) => error,
        Ok(drawing) => panic!("read {} curves, {:?}, from {text}", drawing.curves.len(), drawing.notes),
    }
}

fn curves<'a>(drawing: &'a Drawing, name: &str) -> Vec<&'a Curve> {
    let id = drawing.names.find(name);
    drawing.curves.iter().filter(|c| Some(c.name) == id).map(|c| &c.curve).collect()
}

fn length(drawing: &Drawing, name: &str) -> f64 {
    curves(drawing, name).iter().map(|c| c.length()).sum()
}

fn area(drawing: &Drawing) -> f64 {
    drawing.curves.iter().map(|c| c.curve.signed_area(Point::ORIGIN)).sum()
}

#[track_caller]
fn noted(drawing: &Drawing, part: &str) {
    assert!(drawing.notes.iter().any(|n| n.contains(part)), "{part}: {:?}", drawing.notes);
}

#[track_caller]
fn near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a}, not {b}");
}

/// A cambered section of `n` points a side and a trailing edge of height `gap`, from its upper end over the nose to its
/// lower end.
fn section(n: usize, gap: f64) -> Vec<(f64, f64)> {
    let half = |x: f64| {
        0.6 * (0.2969 * x.sqrt() - 0.126 * x - 0.3516 * x * x + 0.2843 * x.powi(3) - 0.1036 * x.powi(4)) + 0.5 * gap * x
    };
    let at = |k: usize| 0.5 * (1.0 - (std::f64::consts::PI * k as f64 / n as f64).cos());
    let camber = |x: f64| 0.08 * x * (1.0 - x);
    let upper = (0..=n).rev().map(|k| (at(k), camber(at(k)) + half(at(k))));
    upper.chain((1..=n).map(|k| (at(k), camber(at(k)) - half(at(k))))).collect()
}

fn lines(points: &[(f64, f64)]) -> String {
    points.iter().map(|(x, y)| format!("{x:.6} {y:.6}\n")).collect()
}

fn closed(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.push(points[0]);
    points
}

#[test]
fn a_closed_flatback_of_any_thickness_keeps_its_edge_and_corners() {
    for gap in [0.002, 0.02, 0.04, 0.06, 0.1, 0.175, 0.3] {
        let open = dat(&lines(&section(40, gap)));
        near(length(&open, "te"), gap, 1e-9);
        let same = |text: String| {
            let drawing = dat(&text);
            near(length(&drawing, "te"), gap, 1e-9);
            near(area(&drawing), area(&open), 1e-12);
        };
        let points = section(40, gap);
        same(lines(&closed(points.clone())));
        // Closed at the lower corner, drawn by several points, started amid the base, at the nose, and clockwise.
        let lower = *points.last().unwrap();
        same(lines(&[&[lower], &points[..]].concat()));
        let base: Vec<_> = [0.2, 0.5, 0.7].map(|s| (1.0, -0.5 * gap + s * gap)).into();
        same(lines(&[&points[..], &base].concat()));
        same(lines(&closed([&base[1..], &points[..], &base[..1]].concat())));
        let mut turned = [&points[..], &base].concat();
        turned.rotate_left(40);
        same(lines(&closed(turned.clone())));
        turned.reverse();
        same(lines(&turned));
    }
}

#[test]
fn round_ends_and_circles_have_no_trailing_edge() {
    for n in [12, 24, 40, 400] {
        let circle: Vec<_> = (0..=n)
            .map(|k| {
                let (s, c) = (std::f64::consts::TAU * f64::from(k) / f64::from(n)).sin_cos();
                (0.5 + 0.5 * c, 0.5 * s)
            })
            .collect();
        assert!(curves(&dat(&lines(&circle)), "te").is_empty(), "{n}");
    }
    // A flatback whose end is a half circle of few edges.
    for n in [2, 3, 4, 5, 8] {
        let points = section(40, 0.1);
        let round = (1..n).map(|k| {
            let (s, c) = (std::f64::consts::PI * (f64::from(k) / f64::from(n) - 0.5)).sin_cos();
            (1.0 + 0.05 * c, 0.05 * s)
        });
        let drawing = dat(&lines(&closed(points.into_iter().chain(round).collect())));
        assert!(curves(&drawing, "te").is_empty(), "{n}");
    }
}

#[test]
fn numbers_of_a_header_are_no_points() {
    let plain = dat(&lines(&section(30, 0.0)));
    let blunt = dat(&lines(&section(30, 0.1)));
    for header in
        ["1.0 0.12", "1.0 0.02", "0.9 0.12", "0.25 0.0", "0.25 0", "0.0 0.0", "0.5 0.3", "100 12", "12.5 30.2", "61 61"]
    {
        for (gap, known) in [(0.0, &plain), (0.1, &blunt)] {
            for title in ["", "Name\n"] {
                if header == "1.0 0.02" && gap > 0.0 {
                    continue; // a point of the base, as far as anybody can tell
                }
                let drawing = dat(&format!("{title}{header}\n{}", lines(&section(30, gap))));
                assert_eq!(area(&drawing), area(known), "{title}{header}, {gap}: {:?}", drawing.notes);
                noted(&drawing, "passed over");
            }
        }
    }
    // Before surface after surface, and alone before lines of text.
    let points = section(30, 0.0);
    let surfaces =
        format!("{}\n{}", lines(&points[..=30].iter().rev().copied().collect::<Vec<_>>()), lines(&points[30..]));
    noted(&dat(&format!("Name\n0.25 0.0\n{surfaces}")), "0.25 and 0 on line 2");
    noted(&dat(&format!("Name\n0.25 0.0\n! x y\n{}", lines(&points))), "line 2");
}

#[test]
fn columns_may_run_together_count_points_or_share_the_abscissa() {
    let points = section(30, 0.01);
    let known = dat(&lines(&points));
    let below: Vec<_> = points.iter().map(|&(x, y)| (x, y - 0.5)).collect();
    let together: String = below.iter().map(|(x, y)| format!("{x:.6}{y:.6}\n")).collect();
    let drawing = dat(&format!("Name\n{together}"));
    near(area(&drawing), area(&known), 2e-5); // the decimals are rounded elsewhere
    noted(&drawing, "run together");
    let counted: String = points.iter().enumerate().map(|(i, (x, y))| format!("{} {x:.6} {y:.6}\n", i + 1)).collect();
    let drawing = dat(&counted);
    assert_eq!(area(&drawing), area(&known));
    noted(&drawing, "counts the points");
    // From the nose, either surface counted for itself.
    let surface = |points: Vec<(f64, f64)>| -> String {
        points.iter().enumerate().map(|(i, (x, y))| format!("{} {x:.6} {y:.6} 0.0\n", i + 1)).collect()
    };
    let upper: Vec<_> = points[..=30].iter().rev().copied().collect();
    assert_eq!(area(&dat(&(surface(upper.clone()) + &surface(points[30..].to_vec())))), area(&known));
    let beside = |f: &dyn Fn((f64, f64), (f64, f64)) -> String| -> String {
        upper.iter().zip(&points[30..]).map(|(&a, &b)| f(a, b)).collect()
    };
    for text in [
        beside(&|a, b| format!("{:.6} {:.6} {:.6}\n", a.0, a.1, b.1)),
        beside(&|a, b| format!("{:.6} {:.6} {:.6}\n", a.0, b.1, a.1)),
        beside(&|a, b| format!("{:.6} {:.6} {:.6} {:.6}\n", a.0, a.1, b.0, b.1)),
    ] {
        let drawing = dat(&format!("x yu yl\n{text}"));
        assert_eq!(area(&drawing), area(&known), "{:?}", drawing.notes);
    }
    // Camber and thickness are no surfaces.
    let table: String = (0..=20)
        .map(|k| f64::from(k) / 20.0)
        .map(|x| format!("{x} {} {}\n", x * (1.0 - x), 0.3 * x * (1.0 - x)))
        .collect();
    assert_eq!(refused(&table).line, Some(2));
    // A section in the plane of x and z.
    let upright: String = points.iter().map(|(x, y)| format!("{x:.6} 0.0 {y:.6}\n")).collect();
    assert_eq!(area(&dat(&upright)), area(&known));
    let minus = lines(&points).replace('-', "\u{2212}");
    let drawing = dat(&minus);
    assert_eq!(area(&drawing), area(&known));
    noted(&drawing, "minus");
}

#[test]
fn only_a_chord_of_a_hundred_is_percent() {
    let scaled = |chord: f64| lines(&section(30, 0.0).iter().map(|(x, y)| (chord * x, chord * y)).collect::<Vec<_>>());
    let unit = area(&dat(&scaled(1.0)));
    for chord in [75.0, 90.0, 95.0, 110.0, 120.0, 200.0] {
        near(area(&dat(&scaled(chord))), chord * chord * unit, 1e-5);
    }
    let percent = dat(&scaled(100.0));
    near(area(&percent), unit, 1e-5);
    noted(&percent, "percent");
    near(area(&dat(&format!("rib 7, mm\n{}", scaled(100.0)))), 1e4 * unit, 1e-5);
    // Scaled to a chord, whatever the file's.
    for text in [scaled(1.0), scaled(90.0), scaled(100.0)] {
        let options = section::Options { chord: Some(250.0), ..options() };
        let drawing = read(text.as_bytes(), Format::Airfoil, "s", &options).unwrap();
        near(area(&drawing), 250.0 * 250.0 * unit, 1e-4);
        assert!(drawing.unit.is_none());
        noted(&drawing, "to one of 250");
    }
}

#[test]
fn a_point_that_is_no_number_is_an_error_at_its_line() {
    let points = section(30, 0.0);
    for k in [0, 1, 20, 30, 45, 60] {
        for lost in ["nan nan", "0.5 NaN", "-nan(ind) 0.1", "inf 0.1", "0.5 1e999", "****** ******", "#N/A 0.1"] {
            let mut rows: Vec<String> = lines(&points).lines().map(str::to_owned).collect();
            rows[k] = lost.into();
            let error = refused(&format!("Name\n{}\n", rows.join("\n")));
            assert_eq!(error.line, Some(k + 2), "{lost}: {error}");
            assert!(!error.help.is_empty());
        }
    }
    for lost in ["here a point was", "0.5 x", "x 0.5"] {
        let mut rows: Vec<String> = lines(&points).lines().map(str::to_owned).collect();
        rows[10] = lost.into();
        assert_eq!(refused(&format!("Name\n{}\n", rows.join("\n"))).line, Some(12), "{lost}");
        rows[10] = format!("# {lost}");
        noted(&dat(&format!("Name\n{}\n", rows.join("\n"))), "passed over: 12");
    }
}

#[test]
fn a_section_that_crosses_itself_is_refused_at_a_crossing() {
    let mut points = section(30, 0.0);
    points.swap(10, 40);
    let error = refused(&lines(&points));
    assert!(error.line.is_some() && error.what.contains("crosses itself at ("), "{error}");
    // A tail that is crossed by 2 % of the chord is no rounding.
    let mut points = section(30, 0.0);
    let n = points.len();
    (points[0].1, points[n - 1].1) = (-0.02, 0.02);
    refused(&lines(&points));
}

#[test]
fn what_little_loop_lies_behind_the_tail_is_left_out() {
    let whole = area(&dat(&lines(&section(60, 0.0))));
    let mut points = section(60, 0.0);
    let n = points.len();
    (points[0].1, points[n - 1].1) = (-1e-4, 1e-4);
    let drawing = dat(&lines(&points));
    near(area(&drawing), whole, 1e-4);
    noted(&drawing, "surfaces cross at (");
    assert!(curves(&drawing, "te").is_empty());
    // Three decimals: the surfaces touch before the tail, which stays where it is.
    let text: String = section(60, 0.0).iter().map(|(x, y)| format!("{x:.3} {y:.3}\n")).collect();
    let drawing = dat(&text);
    near(area(&drawing), whole, 2e-3);
    noted(&drawing, "surfaces touch");
    assert_eq!(curves(&drawing, "upper")[0].start(), Point::new(1.0, 0.0));
}

#[test]
fn a_nose_on_the_right_is_mirrored_with_the_names_right() {
    for gap in [0.0, 0.01, 0.1] {
        let points = section(40, gap);
        let known = dat(&lines(&points));
        let mirrored: Vec<_> = points.iter().map(|(x, y)| (1.0 - x, *y)).collect();
        let reversed: Vec<_> = mirrored.iter().rev().copied().collect();
        for text in [lines(&mirrored), lines(&reversed), lines(&closed(mirrored.clone()))] {
            let drawing = dat(&text);
            noted(&drawing, "nose was on the right");
            near(area(&drawing), area(&known), 1e-12);
            for name in ["upper", "lower"] {
                near(length(&drawing, name), length(&known, name), 1e-9);
            }
        }
    }
}

#[test]
fn points_nearer_than_their_decimals_are_thinned() {
    let dense: String = section(50_000, 0.0).iter().map(|(x, y)| format!("{x:.8} {y:.8}\n")).collect();
    let drawing = dat(&dense);
    noted(&drawing, "left out");
    near(area(&drawing), area(&dat(&lines(&section(400, 0.0)))), 1e-5);
    let spans = |name| match curves(&drawing, name)[0] {
        Curve::Spline(spline) => spline.spans.len(),
        _ => 1,
    };
    assert!(spans("upper") + spans("lower") < 20_000);
    // A hundred points a side are all kept.
    assert!(dat(&lines(&section(100, 0.0))).notes.iter().all(|n| !n.contains("left out")));
}

// ---- files that are no sections ----

const FOREIGN: &[(&str, &str, &[u8])] = &[
    ("PNG", "png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"),
    ("JPEG", "jpg", b"\xff\xd8\xff\xe0\0\x10JFIF"),
    ("GIF", "gif", b"GIF89a\x01\0\x01\0"),
    ("TIFF", "tif", b"II*\0\x08\0\0\0"),
    ("WebP", "webp", b"RIFF\x24\0\0\0WEBPVP8 "),
    ("PDF", "pdf", b"%PDF-1.4\n1 0 obj\n"),
    ("PostScript", "eps", b"%!PS-Adobe-3.0 EPSF-3.0\n0 0 moveto\n1 1 lineto\n"),
    ("ZIP", "zip", b"PK\x03\x04\x14\0\0\0"),
    ("7z", "7z", b"7z\xbc\xaf\x27\x1c\0\x04"),
    ("gzip", "dat", b"\x1f\x8b\x08\0\0\0\0\0"),
    ("DWG", "dwg", b"AC1032\0\0\0\0\x06\x01"),
    ("PLY", "ply", b"ply\nformat ascii 1.0\nelement vertex 3\nend_header\n0 0 0\n1 0 0\n0 1 0\n"),
    ("OBJ", "obj", b"# cube\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    (
        "MEDIT",
        "mesh",
        b"MeshVersionFormatted 2\nDimension 2\nVertices\n3\n0 0 1\n1 0 1\n0 1 1\nTriangles\n1\n1 2 3 0\nEnd\n",
    ),
    ("VTK", "vtk", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0\n1 0 0\n0 1 0\n"),
    ("Gmsh", "msh", b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"),
    ("SU2", "su2", b"% a mesh\nNDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n0 0 0\n1 0 1\n0 1 2\n"),
    ("deck", "inp", b"** a deck\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n"),
    ("HTML", "html", b"<!DOCTYPE html>\n<html><body><pre>\n1 0\n0.5 0.1\n0 0\n0.5 -0.1\n1 0\n</pre></body></html>\n"),
    ("G-code", "nc", b"%\nO1000\nN10 G21 G90\nN20 G0 X0 Y0\nN30 G1 X10 Y5\nM30\n%\n"),
    ("Gerber", "gbr", b"G04 top*\n%FSLAX24Y24*%\n%MOIN*%\n%ADD10C,0.01*%\nX0Y0D02*\nX100Y100D01*\nM02*\n"),
];

#[test]
fn files_of_other_formats_are_refused_by_name() {
    for &(name, suffix, bytes) in FOREIGN {
        let by_name = tell_format(Path::new(&format!("part.{suffix}")), bytes);
        let by_name = by_name.and_then(|format| read(bytes, format, "part", &options()).map(|_| format));
        // Under a suffix of ours, or told to be a section, as well.
        let told = read(bytes, Format::Airfoil, "part", &options()).map(|_| Format::Airfoil);
        let unnamed = tell_format(Path::new("-"), bytes).and_then(|f| read(bytes, f, "part", &options()).map(|_| f));
        for result in [by_name, told, unnamed] {
            let Err(error) = result else { panic!("{name} was read") };
            assert!(error.what.contains(name) || name == "gzip" && error.what.contains("svg"), "{name}: {error}");
            assert!(!error.help.is_empty());
        }
    }
    // By the suffix alone, where the content says nothing.
    let error = tell_format(Path::new("a.inp"), b"1 0\n0.5 0.1\n0 0\n0.5 -0.1\n1 0\n").unwrap_err();
    assert!(error.help.contains("squinch check"), "{error:?}");
    // What has another reader is sent there.
    let svg = b"<svg xmlns='http://www.w3.org/2000/svg'><circle r='1'/></svg>";
    assert!(read(svg, Format::Airfoil, "a", &options()).unwrap_err().help.contains("--input-format svg"));
    assert_eq!(tell_format(Path::new("a.xml"), svg), Ok(Format::Svg));
}

#[test]
fn sections_may_be_named_like_other_formats() {
    let data = lines(&section(20, 0.0));
    for name in ["OFF", "solid wing", "ply", "% wing", "# wing", "BM 12", "AC1 wing", "Line 3", "* wing", "G1 section"]
    {
        let text = format!("{name}\n{data}");
        assert_eq!(area(&dat(&text)), area(&dat(&data)), "{name}");
        assert_eq!(Format::sniff(text.as_bytes()), Some(Format::Airfoil), "{name}");
    }
}

#[test]
fn outlines_that_run_back_and_forth_are_no_sections() {
    // A star of many points, and a wave that closes.
    let star: Vec<_> = (0..=80)
        .map(|k| {
            let (s, c) = (std::f64::consts::TAU * f64::from(k) / 80.0).sin_cos();
            let r = if k % 2 == 0 { 1.0 } else { 0.4 };
            (r * c, r * s)
        })
        .collect();
    assert!(refused(&lines(&star)).what.contains("back and forth"));
}
