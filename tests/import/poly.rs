//! Triangle's files: `.poly` and `.node`.

use super::*;

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
