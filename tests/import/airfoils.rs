//! Airfoils: contours in every dress, trailing edges, far fields, elements, refusals.

use super::*;

fn distance(a: Point, b: Point) -> f64 {
    (a - b).hypot2().sqrt()
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
    let area: f64 = drawing.curves.iter().map(|c| c.curve.signed_area(Point::ORIGIN)).sum();
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
    // The size that its sources ask for, integrated: as many triangles as a mesh with edges of 0.7 to 1 times it would
    // have.
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
