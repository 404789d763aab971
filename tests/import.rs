//! What the readers take, what they make of it, and how they refuse.

use proptest::prelude::*;
use squinch::curve::{Curve, End};
use squinch::domain::{Drawing, DrawnCurve, FillRule, SeedKind, SizeRequest};
use squinch::geometry::Point;
use squinch::import::{AirfoilOptions, Format, ImportError, Options, TrailingEdge, format_of, outline, read};
use std::path::{Path, PathBuf};

fn section_only() -> Options {
    airfoil(TrailingEdge::Keep, 0.0, 0.0)
}

fn airfoil(trailing_edge: TrailingEdge, far_field: f64, incidence_deg: f64) -> Options {
    Options { airfoil: AirfoilOptions { trailing_edge, far_field, incidence_deg, chord: None }, ..Options::default() }
}

fn dat(text: &str) -> Drawing {
    read(text.as_bytes(), Format::Airfoil, "stem", &section_only()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn refused(text: &str, format: Format) -> ImportError {
    match read(text.as_bytes(), format, "stem", &section_only()) {
        Err(error) => error,
        Ok(drawing) => panic!("read {} curves from {text}", drawing.curves.len()),
    }
}

fn curves<'a>(drawing: &'a Drawing, name: &str) -> Vec<&'a Curve> {
    let id = drawing.names.find(name);
    drawing.curves.iter().filter(|c| Some(c.name) == id).map(|c| &c.curve).collect()
}

fn one<'a>(drawing: &'a Drawing, name: &str) -> &'a Curve {
    let found = curves(drawing, name);
    assert_eq!(found.len(), 1, "{name}");
    found[0]
}

fn distance(a: Point, b: Point) -> f64 {
    (a - b).hypot2().sqrt()
}

fn noted(drawing: &Drawing, part: &str) -> bool {
    drawing.notes.iter().any(|n| n.contains(part))
}

/// Upper and lower surface from the nose, a cambered section of 12 % with a gap of 0.2 % of the chord.
fn surfaces() -> [Vec<(f64, f64)>; 2] {
    let xs = [0.0, 0.0125, 0.05, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.95, 1.0];
    let half = [0.0, 0.02, 0.036, 0.05, 0.0595, 0.06, 0.055, 0.046, 0.034, 0.019, 0.009, 0.001];
    let camber = |x: f64| 0.0625 * x * (1.0 - x);
    [1.0, -1.0].map(|side| (0..xs.len()).map(|i| (xs[i], camber(xs[i]) + side * half[i])).collect())
}

fn contour() -> Vec<(f64, f64)> {
    let [upper, lower] = surfaces();
    upper.into_iter().rev().chain(lower.into_iter().skip(1)).collect()
}

fn lines(points: &[(f64, f64)]) -> String {
    points.iter().map(|(x, y)| format!(" {x:.6}  {y:.6}\n")).collect()
}

fn selig() -> Drawing {
    dat(&format!("Test section\n{}", lines(&contour())))
}

/// The same file in another dress gives the same curves, bit for bit.
#[track_caller]
fn same_as_selig(text: &str) -> Drawing {
    let drawing = dat(text);
    let plain = selig();
    let shapes = |d: &Drawing| d.curves.iter().map(|c| c.curve.clone()).collect::<Vec<_>>();
    assert_eq!(shapes(&drawing), shapes(&plain), "{text}\n{:?}", drawing.notes);
    drawing
}

// ---- airfoils: the plain case ----

#[test]
fn a_section_is_smooth_surfaces_through_its_points() {
    let drawing = selig();
    assert_eq!((drawing.title.as_str(), drawing.format.as_str()), ("Test section", "airfoil (Selig)"));
    assert!(drawing.notes.is_empty(), "{:?}", drawing.notes);
    let (upper, lower, te) = (one(&drawing, "upper"), one(&drawing, "lower"), one(&drawing, "te"));
    // Counter-clockwise and closed bit for bit.
    assert_eq!((upper.start(), upper.end()), (Point::new(1.0, 0.001), Point::ORIGIN));
    assert_eq!((lower.start(), lower.end()), (upper.end(), te.start()));
    assert_eq!(te.end(), upper.start());
    let area: f64 = drawing.curves.iter().map(|c| c.curve.green(Point::ORIGIN)).sum();
    let polygon: f64 = contour().windows(2).map(|w| 0.5 * (w[0].0 * w[1].1 - w[1].0 * w[0].1)).sum();
    assert!(area > polygon && area < 1.03 * polygon, "{area} {polygon}");
    // No corner at the nose.
    let (before, after) = (upper.tangent(1.0, End::Finish), lower.tangent(0.0, End::Start));
    assert!(before.cross(after).abs() < 1e-9 && before.dot(after) > 0.0);
    for (i, surface) in surfaces().iter().enumerate() {
        for &(x, y) in surface {
            let p = Point::new(format!("{x:.6}").parse().unwrap(), format!("{y:.6}").parse().unwrap());
            let curve = [upper, lower][i];
            assert!(curve.nearest(p, 0.0, 1.0).1 < 1e-12);
        }
    }
    let region = drawing.names.find("section").unwrap();
    assert_eq!(drawing.seeds[0].kind, SeedKind::Region { name: region, max_area: None });
}

// ---- airfoils: dress ----

#[test]
fn lednicer_with_counts() {
    let [upper, lower] = surfaces();
    let text = format!("Name\n 12. 12.\n\n{}\n{}", lines(&upper), lines(&lower));
    let drawing = same_as_selig(&text);
    assert_eq!(drawing.format, "airfoil (Lednicer)");
    // Counts without blank lines, and blank lines without counts.
    same_as_selig(&format!("Name\n12 12\n{}{}", lines(&upper), lines(&lower)));
    same_as_selig(&format!("Name\n{}\n{}", lines(&upper), lines(&lower)));
    same_as_selig(&format!("Name\nUpper\n{}Lower\n{}", lines(&upper), lines(&lower)));
}

#[test]
fn either_surface_may_come_first() {
    let [upper, lower] = surfaces();
    same_as_selig(&format!("Name\n 12. 12.\n\n{}\n{}", lines(&lower), lines(&upper)));
    let mut reversed = contour();
    reversed.reverse();
    let drawing = same_as_selig(&format!("Name\n{}", lines(&reversed)));
    assert!(noted(&drawing, "clockwise"));
}

#[test]
fn a_contour_may_start_at_the_nose() {
    let [upper, lower] = surfaces();
    // Surface after surface with nothing between.
    same_as_selig(&format!("Name\n{}{}", lines(&upper), lines(&lower)));
    // Once around from the nose, over the blunt end and back, closed and open.
    let mut ring = upper.clone();
    ring.extend(lower.iter().rev());
    let drawing = same_as_selig(&format!("Name\n{}", lines(&ring)));
    assert!(noted(&drawing, "does not start at the trailing edge"), "{:?}", drawing.notes);
    ring.pop();
    same_as_selig(&format!("Name\n{}", lines(&ring)));
}

#[test]
fn separators_numbers_and_line_ends() {
    let plain = format!("Name\n{}", lines(&contour()));
    same_as_selig(&plain.replace('\n', "\r\n"));
    same_as_selig(&plain.replace('\n', "\r"));
    same_as_selig(&plain.replace("  ", "\t"));
    same_as_selig(&plain.replace("  ", ", "));
    same_as_selig(&plain.replace("  ", ";"));
    same_as_selig(&plain.replace("0.", "."));
    same_as_selig(&plain.replace("0.0", "00.0").replace("1.000000", "0.1D+01"));
    same_as_selig(&format!("\u{feff}{plain}"));
    let drawing = same_as_selig(&plain.replace('.', ","));
    assert!(noted(&drawing, "decimal points"));
    let third = lines(&contour()).replace('\n', "  0.0\n");
    let drawing = same_as_selig(&format!("Name\n{third}"));
    assert!(noted(&drawing, "first two numbers"));
    let spaced = lines(&contour()).replace('\n', "\n\n");
    same_as_selig(&format!("Name\n{spaced}"));
}

#[test]
fn headers() {
    let data = lines(&contour());
    assert_eq!(same_as_selig(&data).title, "stem");
    assert_eq!(same_as_selig(&format!("#\n# A  B\tC\n# more 1 2\n\n{data}")).title, "A B C");
    assert_eq!(same_as_selig(&format!("2412\n{data}")).title, "2412");
    assert_eq!(same_as_selig(&format!("20-32C AIRFOIL\n{data}")).title, "20-32C AIRFOIL");
    assert!(noted(&same_as_selig(&format!("63 215\n{data}")), "counts 63 and 215"));
    assert!(noted(&same_as_selig(&format!("Name\n10 10\n{data}")), "counts 10 and 10"));
    let boxed = same_as_selig(&format!("Name\n -2.0 3.0 -2.5 3.5\n{data}"));
    assert!(noted(&boxed, "four numbers") && boxed.title == "Name");
    let latin = [b"Pr\xfcfprofil\n".as_slice(), data.as_bytes()].concat();
    let drawing = read(&latin, Format::Airfoil, "stem", &section_only()).unwrap();
    assert_eq!(drawing.title, "Prüfprofil");
    assert!(noted(&drawing, "Latin-1"));
}

#[test]
fn text_behind_the_data() {
    let data = lines(&contour());
    let text = format!("Name\n{data}\nA section of 9.0 %\n400,000 and more.\n1 2\nhttp://example.org\n");
    let drawing = same_as_selig(&text);
    assert!(noted(&drawing, "Lines of text among or behind"));
}

#[test]
fn repeated_points_are_merged_and_counted() {
    let data = lines(&contour()).replace(" 0.500000  0.070625\n", " 0.500000  0.070625\n 0.500000  0.070625\n");
    let drawing = same_as_selig(&format!("Name\n{data}"));
    assert!(noted(&drawing, "Repeated points that became one with their neighbours: 1."), "{:?}", drawing.notes);
}

#[test]
fn percent_of_chord() {
    let hundred: Vec<_> = contour().into_iter().map(|(x, y)| (100.0 * x, 100.0 * y)).collect();
    let drawing = dat(&format!("Name\n{}", lines(&hundred)));
    assert!(noted(&drawing, "percent"));
    for (a, b) in drawing.curves.iter().zip(&selig().curves) {
        for t in [0.0, 0.3, 1.0] {
            assert!(distance(a.curve.point(t), b.curve.point(t)) < 1e-6);
        }
    }
}

#[test]
fn other_chords_are_kept() {
    let long: Vec<_> = contour().into_iter().map(|(x, y)| (2500.0 * x + 1e4, 2500.0 * y)).collect();
    let drawing = dat(&format!("Name\n{}", lines(&long)));
    assert_eq!(one(&drawing, "upper").start(), Point::new(12500.0, 2.5));
    assert!(drawing.unit.is_none() && noted(&drawing, "chord is 2500"));
}

fn exact(points: impl Iterator<Item = (f64, f64)>) -> String {
    points.map(|(x, y)| format!("{x:e} {y:e}\n")).collect()
}

#[test]
fn every_scale_gives_the_same_bits() {
    let full = airfoil(TrailingEdge::Round, 20.0, 0.0);
    let read_at = |scale: f64| {
        let text = exact(contour().into_iter().map(|(x, y)| (scale * x, scale * y)));
        read(text.as_bytes(), Format::Airfoil, "s", &full).unwrap()
    };
    let unit = read_at(1.0);
    for exponent in [-20, -3, 23] {
        let scale = 2f64.powi(exponent);
        let drawing = read_at(scale);
        let shapes = |d: &Drawing, f: f64| d.curves.iter().map(|c| c.curve.scaled(f)).collect::<Vec<_>>();
        assert_eq!(shapes(&drawing, 1.0), shapes(&unit, scale));
        let edges = |d: &Drawing| {
            d.sizes
                .iter()
                .map(|s| match *s {
                    SizeRequest::Boundary { edge, .. } | SizeRequest::Near { edge, .. } => edge,
                    _ => f64::NAN,
                })
                .collect::<Vec<_>>()
        };
        let scaled: Vec<f64> = edges(&unit).into_iter().map(|edge| edge * scale).collect();
        assert_eq!(edges(&drawing), scaled);
    }
}

#[test]
fn far_from_the_origin_the_section_is_the_same_up_to_rounding() {
    let offset = 1e7;
    let text = exact(contour().into_iter().map(|(x, y)| (x + offset, y - offset)));
    let (far, near) = (dat(&text), selig());
    assert_eq!(far.curves.len(), near.curves.len());
    for (a, b) in far.curves.iter().zip(&near.curves) {
        for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let moved = a.curve.point(t) - squinch::geometry::Vec2::new(offset, -offset);
            // Coordinates near 1e7 are multiples of 2e-9; the header's six decimals add half a millionth.
            assert!(distance(moved, b.curve.point(t)) < 2e-6, "{moved:?}");
        }
    }
}

// ---- airfoils: trailing edges ----

fn with_gap(gap: f64) -> String {
    let mut points = contour();
    let n = points.len();
    (points[0].1, points[n - 1].1) = (gap, 0.0);
    points.iter().map(|(x, y)| format!("{x:.6} {y:e}\n")).collect()
}

#[test]
fn gaps_of_rounding_are_closed() {
    for gap in [6e-16, 1e-6, 9e-6] {
        let drawing = dat(&with_gap(gap));
        assert!(curves(&drawing, "te").is_empty() && noted(&drawing, "was closed"));
        assert_eq!(one(&drawing, "upper").start(), one(&drawing, "lower").end());
    }
    assert!(!noted(&dat(&with_gap(0.0)), "was closed"));
    assert_eq!(one(&dat(&with_gap(1e-4)), "te").length(), 1e-4);
}

#[test]
fn a_missing_last_point_is_no_blunt_edge() {
    let mut points = contour();
    points[0].1 = 0.0;
    points.pop();
    let drawing = dat(&lines(&points));
    assert!(curves(&drawing, "te").is_empty() && noted(&drawing, "stops short"), "{:?}", drawing.notes);
    assert_eq!(one(&drawing, "lower").end(), Point::new(1.0, 0.0));
}

#[test]
fn a_thick_back_is_no_missing_point() {
    // The lower surface turns up at its end, as on flat-back wind turbine sections.
    let text = "1 .1\n.75 .14\n.5 .15\n.25 .13\n.05 .06\n0 0\n.05 -.06\n.25 -.13\n.5 -.15\n.75 -.14\n.95 -.13\n.98 -.122\n\
                .995 -.11\n1 -.1\n";
    assert_eq!(one(&dat(text), "te").length(), 0.2);
}

#[test]
fn a_contour_that_was_cut_short_is_refused_where_it_stops() {
    let points = contour();
    let nose = points.len() / 2;
    for kept in [5, nose, nose + 1, nose + 4, points.len() - 4] {
        let error = refused(&format!("Name\n{}", lines(&points[..kept])), Format::Airfoil);
        assert_eq!(error.line, Some(kept + 1), "{kept}: {error}");
        assert!(error.what.contains("missing") && error.help.contains("complete the file"), "{error}");
    }
    // Lednicer's lower surface, cut short.
    let [upper, lower] = surfaces();
    let text = format!("Name\n{}\n{}", lines(&upper), lines(&lower[..8]));
    assert!(refused(&text, Format::Airfoil).what.contains("missing"));
    // Four corners without the closing one are whole: every edge is long.
    assert_eq!(curves(&dat("1 0\n.5 .05\n0 0\n.5 -.05\n"), "te").len(), 0);
    // A flat side that is meant is said by its end.
    assert!(!curves(&dat(&format!("{}{}", lines(&points[..=nose]), lines(&points[..1]))), "upper").is_empty());
}

#[test]
fn a_blunt_edge_is_sized_for_three_edges() {
    let drawing = selig();
    let te = drawing.names.find("te").unwrap();
    let edges: Vec<f64> = drawing
        .sizes
        .iter()
        .filter_map(|s| match s {
            SizeRequest::Boundary { name, edge } if *name == te => Some(*edge),
            _ => None,
        })
        .collect();
    assert_eq!(edges, [one(&drawing, "te").length() / 3.0]);
}

#[test]
fn text_amid_the_data_is_told_by_its_lines() {
    let points = contour();
    let text = format!("Name\n{}lower\n{}the end\n", lines(&points[..=11]), lines(&points[11..]));
    assert!(noted(&dat(&text), "passed over: 14, "), "{:?}", dat(&text).notes);
}

#[test]
fn tables_with_dots_and_parentheses_are_read() {
    let points = contour();
    let (first, last) = (points[0], points[points.len() - 1]);
    let inner = lines(&points[1..points.len() - 1]);
    let [(x0, y0), (x1, y1)] = [first, last];
    let text = format!("Table\n{x0:.9} ({y0:.9})\n{:.4} ......\n{inner}{x1:.9} ({y1:.9})\n", points[1].0);
    let drawing = dat(&text);
    assert!(noted(&drawing, "leave the ordinate out, passed over: 3."), "{:?}", drawing.notes);
    assert_eq!(one(&drawing, "upper").start(), one(&selig(), "upper").start());
}

#[test]
fn a_blunt_edge_may_be_drawn_in_the_file() {
    let mut points = contour();
    points.insert(0, (1.0, 0.0));
    points.push((1.0, 0.0));
    let drawing = dat(&lines(&points));
    assert_eq!(curves(&drawing, "te").len(), 2);
    assert_eq!(one(&drawing, "upper"), one(&selig(), "upper"));
}

#[test]
fn trailing_edge_options() {
    let (blunt, sharp) = (lines(&contour()), with_gap(0.0));
    let with = |text: &str, edge| read(text.as_bytes(), Format::Airfoil, "stem", &airfoil(edge, 0.0, 0.0)).unwrap();
    let sharpened = with(&blunt, TrailingEdge::Sharp);
    assert!(curves(&sharpened, "te").is_empty());
    assert_eq!(one(&sharpened, "upper").start(), Point::new(1.0, 0.0));
    assert_eq!(one(&sharpened, "lower").end(), Point::new(1.0, 0.0));
    assert_eq!(with(&sharp, TrailingEdge::Sharp).curves, dat(&sharp).curves);
    assert_eq!(with(&blunt, TrailingEdge::Blunt).curves, dat(&blunt).curves);
    let cut = with(&sharp, TrailingEdge::Blunt);
    let te = one(&cut, "te");
    assert!((te.start().x - 0.99).abs() < 1e-12 && (te.end().x - 0.99).abs() < 1e-12 && te.end().y > te.start().y);
    for text in [&blunt, &sharp] {
        let round = with(text, TrailingEdge::Round);
        let te = one(&round, "te");
        assert_eq!((te.start(), te.end()), (one(&round, "lower").end(), one(&round, "upper").start()));
        let half = 0.5 * distance(te.start(), te.end());
        assert!((te.length() - std::f64::consts::PI * half).abs() < 1e-12);
        assert!((te.point(0.5).x - (te.start().x + half)).abs() < 1e-6, "bulges downstream");
    }
}

#[test]
fn surfaces_that_a_spline_would_cross_get_a_tamer_curve() {
    // A thin section with one abrupt step: the spline overshoots through the other surface, the points do not.
    let text = "step\n1 0\n.55 .001\n.5 .001\n.49 .1\n.4 .1\n.1 .06\n0 0\n.1 -.001\n.4 -.001\n.5 -.0005\n.55 0\n1 0\n";
    let drawing = dat(text);
    assert!(noted(&drawing, "would cross"), "{:?}", drawing.notes);
    // Neither surface passes the other anywhere.
    let (upper, lower) = (one(&drawing, "upper"), one(&drawing, "lower"));
    for i in 1..400 {
        let p = upper.point(f64::from(i) / 400.0);
        let below = lower.nearest(p, 0.0, 1.0);
        let q = lower.point(below.0);
        assert!(
            (p - q).dot(squinch::geometry::Vec2::new(-lower.derivative(below.0).y, lower.derivative(below.0).x))
                >= -1e-12
        );
    }
}

// ---- airfoils: far field, incidence, elements ----

#[test]
fn the_far_field_is_a_circle_around_mid_chord() {
    let drawing =
        read(lines(&contour()).as_bytes(), Format::Airfoil, "s", &airfoil(TrailingEdge::Keep, 20.0, 0.0)).unwrap();
    let Curve::Arc(circle) = one(&drawing, "farfield") else { panic!("no circle") };
    assert!(distance(circle.center, Point::new(0.5, 0.0)) < 1e-12 && (circle.radius - 20.0).abs() < 1e-12);
    assert_eq!(drawing.fill, FillRule::EvenOdd);
    let fluid = drawing.names.find("fluid").unwrap();
    assert_eq!(drawing.seeds.len(), 1);
    assert_eq!(drawing.seeds[0].kind, SeedKind::Region { name: fluid, max_area: None });
    // The size that its sources ask for, integrated: as many triangles as a mesh with edges of 0.7 to 1 times it would have.
    let triangles = triangles_asked_for(&drawing, circle.center, circle.radius);
    assert!((4000.0..12000.0).contains(&triangles), "{triangles}");
}

/// The integral of 1 / (√3/4 h²) over the disk, in rings whose width follows the distance from the chord.
fn triangles_asked_for(drawing: &Drawing, center: Point, radius: f64) -> f64 {
    let size = |p: Point| {
        let near = |r: &SizeRequest| match *r {
            SizeRequest::Near { from, to, edge, grade } => {
                let along = to - from;
                let t =
                    if along.hypot2() > 0.0 { ((p - from).dot(along) / along.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
                edge + grade * distance(p, from + t * along)
            }
            _ => f64::INFINITY,
        };
        drawing.sizes.iter().map(near).fold(2.5, f64::min)
    };
    let (rings, sectors) = (400, 360);
    let mut sum = 0.0;
    for i in 0..rings {
        // Squares bunch the rings where the mesh is fine.
        let (r0, r1) = (radius * (f64::from(i) / 400.0).powi(2), radius * (f64::from(i + 1) / 400.0).powi(2));
        let ring = std::f64::consts::PI * (r1 * r1 - r0 * r0) / f64::from(sectors);
        for k in 0..sectors {
            let angle = f64::from(k).to_radians();
            let p = center + 0.5 * (r0 + r1) * squinch::geometry::Vec2::from_angle(angle);
            sum += ring / (0.433 * size(p) * size(p));
        }
    }
    sum
}

#[test]
fn incidence_lifts_the_nose_and_keeps_the_quarter_chord() {
    let level = selig();
    let up = read(lines(&contour()).as_bytes(), Format::Airfoil, "s", &airfoil(TrailingEdge::Keep, 0.0, 10.0)).unwrap();
    let (nose, tail) = (one(&up, "upper").end(), one(&up, "te").point(0.5));
    assert!(nose.y > 0.0 && tail.y < 0.0);
    assert!(distance(nose.lerp(tail, 0.25), Point::new(0.25, 0.0)) < 1e-12);
    assert!(((nose.y - tail.y) / (tail.x - nose.x) - 10.0_f64.to_radians().tan()).abs() < 1e-12);
    for (a, b) in up.curves.iter().zip(&level.curves) {
        assert!((a.curve.length() - b.curve.length()).abs() < 1e-9);
    }
}

#[test]
fn elements_are_numbered() {
    let flap: Vec<_> = contour().into_iter().map(|(x, y)| (1.05 + 0.3 * x, -0.05 + 0.3 * y - 0.1 * x)).collect();
    let (a, b) = (lines(&contour()), lines(&flap));
    for between in ["999. 999.\n", "999.0  999.0\n", "\n"] {
        let text = format!("Two elements\n{a}{between}{b}");
        let drawing = dat(&text);
        assert_eq!(one(&drawing, "upper1"), one(&selig(), "upper"));
        assert_eq!(one(&drawing, "upper2").start(), Point::new(1.35, -0.1497));
        assert_eq!(drawing.seeds.len(), 2);
        assert_eq!(curves(&drawing, "te2").len(), 1);
    }
}

// ---- airfoils: refusals ----

#[test]
fn refusals_of_airfoils_have_a_line_and_a_way_out() {
    let data = lines(&contour());
    let broken = refused(&format!("Name\n{}", data.replace("0.070625", "0.07ABC25")), Format::Airfoil);
    assert_eq!(broken.line, Some(7), "{broken}");
    assert!(broken.to_string().starts_with("line 7: ") && !broken.help.is_empty());
    refused("", Format::Airfoil);
    refused("just text\nand more\n", Format::Airfoil);
    refused("flat\n1 0\n.5 0\n0 0\n.5 0\n1 0\n", Format::Airfoil);
    refused("999 999\n999 999\n", Format::Airfoil);
    refused("point\n1 0\n1 0\n1 0\n1 0\n1 0\n", Format::Airfoil);
    refused("nan\nnan nan\ninf 1\n", Format::Airfoil);
    let near = airfoil(TrailingEdge::Keep, 0.3, 0.0);
    assert!(read(data.as_bytes(), Format::Airfoil, "s", &near).is_err());
    for wrong in [airfoil(TrailingEdge::Keep, -1.0, 0.0), airfoil(TrailingEdge::Keep, f64::NAN, 0.0)] {
        assert!(read(data.as_bytes(), Format::Airfoil, "s", &wrong).is_err());
    }
    assert!(read(data.as_bytes(), Format::Airfoil, "s", &airfoil(TrailingEdge::Keep, 0.0, f64::INFINITY)).is_err());
}

// ---- Triangle's files ----

fn poly(text: &str) -> Drawing {
    read(text.as_bytes(), Format::Poly, "stem", &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

const SQUARE: &str = "# a square in a square
8 2 1 1  # attributes and markers
0 0 0 7.5 1
1 4 0 7.5 1

2 4 4 7.5 1
3 0 4 7.5 1
4 1 1 7.5 0
5 2 1 7.5 0
6 2 2 7.5 0
7 3 3 7.5 9
7 1
0 0 1 5
1 1 2 5
2 2 3 -2
3 3 0 0
4 4 5 0
5 5 6 0
6 6 4 0
1
0 1.5 1.2
2
0 0.5 0.5 3 0.25
1 3.5 3.5 2.5 -1
";

#[test]
fn a_poly_file_keeps_markers_holes_regions_and_lone_vertices() {
    let drawing = poly(SQUARE);
    assert_eq!(drawing.fill, FillRule::Regions);
    let counts: Vec<usize> = ["5", "-2", "boundary"].iter().map(|n| curves(&drawing, n).len()).collect();
    assert_eq!(counts, [2, 1, 4]);
    assert_eq!((drawing.points.len(), drawing.points[0].at), (1, Point::new(3.0, 3.0)));
    assert_eq!(drawing.points[0].name, drawing.names.find("9"));
    assert_eq!(drawing.points[0].entity, "vertex 7");
    assert_eq!(drawing.seeds[0].kind, SeedKind::Hole);
    let region = |name| drawing.names.find(name).unwrap();
    assert_eq!(drawing.seeds[1].kind, SeedKind::Region { name: region("3"), max_area: Some(0.25) });
    assert_eq!(drawing.seeds[2].kind, SeedKind::Region { name: region("2.5"), max_area: None });
    assert_eq!(drawing.curves[4].entity, "segment 4");
    assert!(drawing.notes.is_empty() && drawing.skipped.is_empty());
}

#[test]
fn vertex_numbers_start_anywhere_and_may_jump() {
    let one_based = poly("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n");
    let jumping = poly("3 2\n10 0 0\n-5 1,0\n7 0 1\n3\n1 10 -5\n2 -5 7\n3 7 10\n");
    let ends = |d: &Drawing| d.curves.iter().map(|c| (c.curve.start(), c.curve.end())).collect::<Vec<_>>();
    assert_eq!(ends(&one_based), ends(&jumping));
    assert!(noted(&jumping, "not numbered consecutively") && noted(&jumping, "ends before the hole"));
    let twice = refused("3 2\n1 0 0\n1 1 0\n7 0 1\n0\n0\n", Format::Poly);
    assert_eq!(twice.line, Some(3));
}

#[test]
fn segments_between_a_vertex_and_itself_are_counted() {
    let drawing = poly("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n4 0\n1 1 2\n2 2 2\n3 2 3\n4 3 1\n0\n");
    assert_eq!((drawing.curves.len(), drawing.skipped[0].count), (3, 1));
}

#[test]
fn without_segments_the_domain_is_the_convex_hull() {
    let nodes = "6 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 2 2\n6 2 0\n";
    let from_node = read(nodes.as_bytes(), Format::Node, "stem", &Options::default()).unwrap();
    let from_poly = poly(&format!("{nodes}0 0\n0\n"));
    for drawing in [&from_node, &from_poly] {
        assert_eq!(curves(drawing, "hull").len(), 4);
        // Inside, and on an edge of the hull: kept as points.
        assert_eq!(
            drawing.points.iter().map(|p| p.at).collect::<Vec<_>>(),
            [Point::new(2.0, 2.0), Point::new(2.0, 0.0)]
        );
        assert!(noted(drawing, "convex hull"));
    }
    let line = read(b"3 2\n1 0 0\n2 1 1\n3 2 2\n", Format::Node, "s", &Options::default()).unwrap();
    assert!(line.curves.is_empty() && line.points.len() == 3 && noted(&line, "span no area"));
    // At the ends of the number range, where products overflow.
    let wide = "4 2\n1 -1e300 0\n2 1e300 0\n3 0 1e300\n4 0 1e299\n";
    assert_eq!(read(wide.as_bytes(), Format::Node, "s", &Options::default()).unwrap().curves.len(), 3);
}

#[test]
fn a_poly_file_that_ends_before_its_segments_is_refused_there() {
    let cut = "3 2 0 0\n1 0 0\n2 4 0\n3 4 4\n";
    let error = read(cut.as_bytes(), Format::Poly, "stem", &Options::default()).unwrap_err();
    assert_eq!((error.what.as_str(), error.line), ("the file ends before the count of the segments", Some(4)));
}

#[test]
fn the_hull_holds_every_point() {
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Few values, so that many points coincide or line up.
        (state >> 60) as f64
    };
    for n in [3, 10, 60] {
        let points: Vec<Point> = (0..n).map(|_| Point::new(random(), random())).collect();
        let rows: String = points.iter().enumerate().map(|(i, p)| format!("{i} {} {}\n", p.x, p.y)).collect();
        let drawing = read(format!("{n} 2\n{rows}").as_bytes(), Format::Node, "s", &Options::default()).unwrap();
        for c in &drawing.curves {
            let (a, b) = (c.curve.start(), c.curve.end());
            assert!(points.iter().all(|&p| (b - a).cross(p - a) >= 0.0));
        }
        assert_eq!(drawing.curves.last().map(|c| c.curve.end()), drawing.curves.first().map(|c| c.curve.start()));
    }
}

#[test]
fn vertices_may_lie_in_a_node_file_beside() {
    let text = b"0 2 0 0\n3 1\n1 1 2 4\n2 2 3 4\n3 3 1 4\n0\n";
    let alone = read(text, Format::Poly, "part", &Options::default()).unwrap_err();
    assert!(alone.line == Some(1) && alone.help.contains("part.node"));
    let nodes = |n: &str| Options { nodes: Some(n.as_bytes().to_vec()), ..Options::default() };
    let drawing = read(text, Format::Poly, "part", &nodes("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n")).unwrap();
    assert_eq!(curves(&drawing, "4").len(), 3);
    let broken = read(text, Format::Poly, "part", &nodes("3 2 0 0\n1 0 0\n2 x 0\n")).unwrap_err();
    assert!(broken.to_string().starts_with("line 3: in the .node file"), "{broken}");
}

#[test]
fn refusals_of_poly_files_have_a_line() {
    for (line, text) in [
        (1, "3 3 0 0\n"),
        (1, "-3 2 0 0\n"),
        (1, "2.5 2 0 0\n"),
        (1, "x 2 0 0\n"),
        (3, "3 2 0 0\n1 0 0\n2 1\n"),
        (2, "3 2 0 0\n1 0 nan\n"),
        (2, "3 2 0 0\n1 0 1e999\n"),
        (3, "3 2 0 0\n1 0 0\n2 1 0\n"),
        (2, "4000000000 2 0 0\n1 0 0\n"),
        (6, "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n1 0\n1 1 4\n"),
        (6, "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n1 0\n1 1 1.5\n"),
        (4, "2 2 0 0\n1 0 0\n2 1 0\n3 7.5 1\n1 0\n1 1 2\n"),
        (7, "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n0\n1\n1 0\n"),
    ] {
        let error = refused(text, Format::Poly);
        assert_eq!(error.line, Some(line), "{error}\n{text}");
        assert!(!error.help.is_empty());
    }
    assert_eq!(refused("# nothing\n", Format::Poly).line, Some(1));
}

// ---- outlines ----

fn json(text: &str) -> Drawing {
    read(text.as_bytes(), Format::Outline, "stem", &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

const EVERYTHING: &str = r#"{
  "$schema": "outline.schema.json", "squinch": 1, "title": "all", "unit": "mm", "unit_from": "by hand", "fill": "nonzero",
  "names": ["second", "first"],
  "curves": [
    { "name": "first", "line": [[0, 0.1], [1, 0]] },
    { "polyline": [[0, 0], [1, 0], [1, 1]], "entity": "steps" },
    { "name": "second", "polygon": [[0, 0], [1, 0], [1, 1]] },
    { "name": "a", "arc": { "center": [1, 2], "radius": 3, "start_deg": 30, "sweep_deg": -100 } },
    { "name": "a", "arc": { "center": [1, 2], "radius": 3, "start_rad": 0.1, "sweep_rad": 0.7 } },
    { "name": "a", "arc": { "from": [0, 0], "through": [1, 1], "to": [2, 0.5] } },
    { "name": "a", "arc": { "from": [0, 0], "to": [2, 0.5], "bulge": -0.3 } },
    { "name": "a", "arc": { "center": [1, 0], "radius": 1, "start_deg": 180, "sweep_deg": 360, "ends": [[0, 0], [0, 0]] } },
    { "name": "c", "circle": { "center": [0.1, 0.2], "radius": 0.3 } },
    { "name": "e", "ellipse": { "center": [0, 0], "radii": [2, 1], "rotation_deg": 33 } },
    { "name": "e", "ellipse": { "center": [0, 0], "u": [1, 0.1], "v": [0.3, 1], "start_rad": 0.1, "sweep_rad": 2 } },
    { "name": "b", "bezier": [[0, 0], [1, 2], [3, 1], [4, 0], [5, 5]] },
    { "name": "b", "rational_bezier": { "points": [[1, 0], [1, 1], [0, 1]], "weights": [1, 0.7, 1] } },
    { "name": "n", "nurbs": { "degree": 2, "knots": [0, 0, 0, 0.3, 1, 1, 1], "points": [[0, 0], [1, 1], [2, 0], [3, 1]] } },
    { "name": "n", "nurbs": { "degree": 1, "knots": [0, 0, 1, 2, 2], "points": [[0, 0], [1, 1], [2, 0]], "weights": [1, 2, 1] } },
    { "name": "s", "spline": [[0, 0], [1, 0.7], [2, 0], [3, 0.1]] },
    { "name": "s", "closed_spline": [[0, 0], [1, 0.1], [1.1, 1], [0.2, 1]] },
    { "name": "k", "clothoid": { "from": [1, 0.5], "heading_deg": 30, "curvature": [0, -0.7], "length": 2 } },
    { "name": "k", "clothoid": { "from": [1, 0.5], "heading_rad": 2.5, "curvature": [-3, 2], "length": 3.1 } }
  ],
  "points": [{ "at": [0.5, 0.5] }, { "at": [0.25, 0.5], "name": "probe", "entity": "p" }],
  "seeds": [{ "at": [0.1, 0.1], "hole": true }, { "at": [0.2, 0.1], "region": "steel", "max_area": 0.3, "entity": "r" }],
  "sizes": [{ "edge": 0.5 }, { "edge": 0.1, "boundary": "a" }, { "edge": 0.2, "region": "steel" },
            { "edge": 0.05, "near": [[0, 0], [1, 0]], "grade": 0.3 }],
  "skipped": [{ "entity": "TEXT", "count": 3, "why": "no curve" }],
  "notes": ["made by \"hand\""]
}"#;

#[track_caller]
fn round_trips(drawing: &Drawing) {
    let text = outline::to_json(drawing);
    let again = json(&text);
    // An outline tells last decimals by its numbers, and has neither layers nor handles.
    let told = |drawing: &Drawing| -> Vec<DrawnCurve> {
        let plain = |drawn: &DrawnCurve| DrawnCurve { layer: None, handle: None, last_decimal: 0.0, ..drawn.clone() };
        drawing.curves.iter().map(plain).collect()
    };
    assert_eq!(told(&again), told(drawing));
    assert_eq!(again.points, drawing.points);
    assert_eq!(again.seeds, drawing.seeds);
    assert_eq!(again.sizes, drawing.sizes);
    assert_eq!(again.skipped, drawing.skipped);
    assert_eq!(again.names, drawing.names);
    assert_eq!((again.fill, &again.unit, &again.notes), (drawing.fill, &drawing.unit, &drawing.notes));
    assert_eq!((&again.title, &again.format), (&drawing.title, &drawing.format));
    // Equal numbers may differ in the sign of zero; equal text does not.
    assert_eq!(outline::to_json(&again), text);
}

#[test]
fn an_outline_holds_every_kind_and_round_trips() {
    let drawing = json(EVERYTHING);
    assert_eq!(drawing.curves.len(), 22);
    assert_eq!(drawing.names.iter().map(|(_, n)| n).take(3).collect::<Vec<_>>(), ["second", "first", "boundary"]);
    assert_eq!(drawing.curves[2].entity, "steps, edge 1");
    assert_eq!((drawing.sizes.len(), drawing.seeds.len(), drawing.points.len()), (4, 2, 2));
    round_trips(&drawing);
}

#[test]
fn welded_cut_and_turned_curves_round_trip_too() {
    let mut drawing = json(EVERYTHING);
    let third = 1.0 / 3.0;
    for c in &mut drawing.curves {
        let part = c.curve.part(0.1, 0.7 * third + 0.3);
        c.curve = part.with_ends(part.start() + squinch::geometry::Vec2::new(1e-9, -1e-9), part.end());
    }
    round_trips(&drawing);
    for c in &mut drawing.curves {
        c.curve = c.curve.reversed().transformed(kurbo::Affine::rotate(third) * kurbo::Affine::scale(1e-7));
    }
    round_trips(&drawing);
}

#[test]
fn refusals_of_outlines_say_where() {
    let curve =
        |body: &str| format!("{{ \"squinch\": 1, \"curves\": [\n{{ \"line\": [[0, 0], [1, 1]] }},\n{body}\n] }}");
    for (line, part, text) in [
        (3, "curves[1]", curve(r#"{ "circle": { "center": [0, 0], "radius": -1 } }"#)),
        (3, "curves[1]: invalid length 1", curve(r#"{ "line": [[0], [1, 1]] }"#)),
        (3, "unknown field `colour`", curve(r#"{ "line": [[0, 0], [1, 1]], "colour": 3 }"#)),
        (3, "holds 0 curves", curve(r#"{ "name": "x" }"#)),
        (3, "holds 2 curves", curve(r#"{ "line": [[0, 0], [1, 1]], "bezier": [[0, 0], [1, 1]] }"#)),
        (3, "missing field `radius`", curve(r#"{ "circle": { "center": [0, 0] } }"#)),
        (3, "an arc is given by", curve(r#"{ "arc": { "center": [0, 0], "radius": 1 } }"#)),
        (3, "an arc is given by", curve(r#"{ "arc": { "from": [0, 0], "to": [1, 0] } }"#)),
        (
            3,
            "`start_deg` and `sweep_deg`",
            curve(r#"{ "arc": { "center": [0, 0], "radius": 1, "start_deg": 1, "sweep_rad": 1 } }"#),
        ),
        (
            3,
            "where the angles put them",
            curve(
                r#"{ "arc": { "center": [0, 0], "radius": 1, "start_deg": 0, "sweep_deg": 90, "ends": [[1, 0], [0, 2]] } }"#,
            ),
        ),
        (3, "an ellipse is given by", curve(r#"{ "ellipse": { "center": [0, 0], "u": [1, 0] } }"#)),
        (
            3,
            "ascending from 0 to 1",
            curve(r#"{ "piecewise_bezier": { "knots": [0, 2], "spans": [{ "points": [[0, 0], [1, 1]] }] } }"#),
        ),
        (
            3,
            "spans[1] does not start",
            curve(
                r#"{ "piecewise_bezier": { "knots": [0, 0.5, 1],
                 "spans": [{ "points": [[0, 0], [1, 1]] }, { "points": [[0, 0], [1, 1]] }] } }"#,
            )
            .replace("\n   ", " "),
        ),
        (3, "degree 301 is above", curve(r#"{ "nurbs": { "degree": 301, "knots": [0, 1], "points": [[0, 0]] } }"#)),
        (3, "curves[1]", curve(r#"{ "nurbs": { "degree": 2, "knots": [0, 1], "points": [[0, 0]] } }"#)),
        (3, "number out of range", curve(r#"{ "line": [[0, 0], [1e999, 1]] }"#)),
        (3, "1 points make no polyline", curve(r#"{ "polyline": [[0, 0]] }"#)),
        (1, "missing field `squinch`", "{}".into()),
        (1, "unknown field `curvs`", r#"{ "squinch": 1, "curvs": [] }"#.into()),
        (2, "seeds[0]: needs `region`", "{ \"squinch\": 1, \"seeds\": [\n{ \"at\": [0, 0] } ] }".into()),
        (
            2,
            "seeds[0]: `max_area`",
            "{ \"squinch\": 1, \"seeds\": [\n{ \"at\": [0, 0], \"region\": \"a\", \"max_area\": 0 } ] }".into(),
        ),
        (1, "sizes[0]: `edge` must be positive", r#"{ "squinch": 1, "sizes": [{ "edge": 0 }] }"#.into()),
        (
            1,
            "sizes[0]: `near` needs `grade`",
            r#"{ "squinch": 1, "sizes": [{ "edge": 1, "near": [[0, 0], [1, 1]] }] }"#.into(),
        ),
        (1, "EOF", r#"{ "squinch": 1, "curves": ["#.into()),
    ] {
        let error = refused(&text, Format::Outline);
        assert!(error.what.contains(part), "{error}\n{text}");
        assert_eq!(error.line, Some(line), "{error}\n{text}");
        assert!(error.column.is_some() && !error.what.contains(" at line "));
    }
    assert!(refused(r#"{ "squinch": 2 }"#, Format::Outline).what.contains("version 2"));
}

#[test]
fn the_schema_knows_every_key_that_is_read_and_written() {
    let schema: serde_json::Value = serde_json::from_str(outline::SCHEMA).unwrap();
    let written: serde_json::Value = serde_json::from_str(&outline::to_json(&json(EVERYTHING))).unwrap();
    for key in written.as_object().unwrap().keys() {
        assert!(schema["properties"].get(key).is_some(), "{key}");
    }
    // What serde says it expects is what the schema offers.
    for (place, probe) in [
        ("/properties", r#"{ "?": 1 }"#),
        ("/$defs/curve/properties", r#"{ "curves": [{ "?": 1 }] }"#),
        ("/$defs/arc/properties", r#"{ "curves": [{ "arc": { "?": 1 } }] }"#),
        ("/$defs/ellipse/properties", r#"{ "curves": [{ "ellipse": { "?": 1 } }] }"#),
        ("/$defs/seed/properties", r#"{ "seeds": [{ "?": 1 }] }"#),
        ("/$defs/size/properties", r#"{ "sizes": [{ "?": 1 }] }"#),
        ("/$defs/namedPoint/properties", r#"{ "points": [{ "?": 1 }] }"#),
    ] {
        let said = refused(probe, Format::Outline).what;
        let mut expected: Vec<&str> = said.split('`').skip(3).step_by(2).collect();
        let mut offered: Vec<&str> =
            schema.pointer(place).unwrap().as_object().unwrap().keys().map(String::as_str).collect();
        expected.sort_unstable();
        offered.sort_unstable();
        assert_eq!(expected, offered, "{said}");
    }
}

// ---- formats ----

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

// ---- samples and the shared cases ----

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
    let found: f64 = drawing.curves.iter().map(|c| c.curve.green(Point::ORIGIN)).sum();
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
            // Once around turns by π and the trailing edge's angles; concave parts and rounded corners (2.25 π of a flat back) add to
            // that, oscillations many times as much.
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

// ---- STEP ----

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

// ---- any bytes ----

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

fn seeds() -> Vec<Vec<u8>> {
    let [upper, lower] = surfaces();
    vec![
        format!("Name\n{}", lines(&contour())).into_bytes(),
        format!("Name\n12 12\n\n{}\n{}999 999\n{}", lines(&upper), lines(&lower), lines(&contour())).into_bytes(),
        SQUARE.as_bytes().to_vec(),
        EVERYTHING.as_bytes().to_vec(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn truncated_and_mutilated_files_never_panic(
        which in 0..4usize,
        cut in 0.0..1.0f64,
        edits in prop::collection::vec((0.0..1.0f64, prop::sample::select(&b"0179.-+eE,; \n\t#{}[]\"x\xff\x00"[..])), 0..6),
    ) {
        let mut bytes = seeds().swap_remove(which);
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
