//! The whole run of solids: surfaces in space → a verified mesh of tetrahedra, or an error with place and way out.

use squinch::geometry::Place;
use squinch::mesh::solid::SolidMesh;
use squinch::run::report::FailureKind;
use squinch::run::request::Request;
use squinch::run::{Exit, Extent, Outcome, Source, run};
use squinch::solid::{Assembly, Flatten, NonPlanar};
use squinch::watch::no_clock;
use std::fmt::Write;

/// A run of a text under a file name.
fn run_of(path: &str, text: &str, request: &Request) -> Outcome {
    let source = Source { path, bytes: text.as_bytes(), format: None, nodes: None, of_many: false };
    run(&source, request, Extent::Whole(&mut |_| true), &no_clock)
}

/// The mesh of a run that holds all guarantees, and its volume.
fn meshed(path: &str, text: &str) -> (SolidMesh, f64) {
    let outcome = run_of(path, text, &Request::default());
    assert_eq!(outcome.exit, Exit::Done, "{path}: {:?} {:?}", outcome.report.failure, outcome.verdict);
    let measure = |regions: &[squinch::mesh::quality::RegionMeasure]| regions.iter().map(|r| r.measure).sum();
    let volume = measure(&outcome.report.mesh.expect("a mesh").regions);
    (outcome.solid.expect("a mesh"), volume)
}

/// A box from 0 to `to` as polygons of an OFF file; `turned` moves each point.
fn off_box(to: [f64; 3], turned: impl Fn([f64; 3]) -> [f64; 3]) -> String {
    let mut text = "OFF\n8 6 0\n".to_owned();
    for i in 0..8 {
        let corner = [0, 1, 2].map(|k| if i >> k & 1 == 1 { to[k] } else { 0.0 });
        let [x, y, z] = turned(corner);
        writeln!(text, "{x:?} {y:?} {z:?}").expect("strings grow");
    }
    for face in ["0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2", "1 3 7 5"] {
        writeln!(text, "4 {face}").expect("strings grow");
    }
    text
}

/// Turned about two axes, so that no plane is exact any more.
fn turned([x, y, z]: [f64; 3]) -> [f64; 3] {
    let ((s, c), (t, d)) = (f64::sin_cos(0.7), f64::sin_cos(0.4));
    let (x, y) = (c * x - s * y, s * x + c * y);
    [x, d * y - t * z, t * y + d * z]
}

/// Schönhardt's polyhedron: no tetrahedra of its own corners fill it.
fn schoenhardt() -> String {
    let mut text = "OFF\n6 8 0\n".to_owned();
    for (z, turn) in [(0.0, 0.0), (1.0, 30.0f64)] {
        for k in 0..3 {
            let angle = (turn + 120.0 * f64::from(k)).to_radians();
            writeln!(text, "{:?} {:?} {z:?}", angle.cos(), angle.sin()).expect("strings grow");
        }
    }
    text += "3 0 2 1\n3 3 4 5\n";
    for k in 0..3 {
        let (a, b, c, d) = (k, (k + 1) % 3, k + 3, (k + 1) % 3 + 3);
        // The diagonal that runs inward.
        writeln!(text, "3 {a} {b} {d}\n3 {a} {d} {c}").expect("strings grow");
    }
    text
}

#[test]
fn a_box_has_its_volume_straight_and_turned() {
    for (text, tolerance) in [(off_box([2.0, 3.0, 5.0], |p| p), 0.0), (off_box([2.0, 3.0, 5.0], turned), 1e-12)] {
        let (mesh, volume) = meshed("box.off", &text);
        assert!((volume - 30.0).abs() <= 30.0 * tolerance + 1e-14, "{volume}");
        assert_eq!(mesh.nodes.len(), 8);
        assert_eq!(mesh.triangles.len(), 12);
        assert_eq!(mesh.edges.len(), 12);
    }
}

#[test]
fn schoenhardts_polyhedron_is_filled() {
    let (mesh, _) = meshed("schoenhardt.off", &schoenhardt());
    assert!(mesh.nodes.len() > 6, "it needs a point of ours");
}

#[test]
fn scaling_by_a_power_of_two_gives_the_same_ids() {
    let factor = 2f64.powi(-40);
    let scaled = |p: [f64; 3]| turned(p).map(|x| x * factor);
    let [plain, small] = [off_box([2.0, 3.0, 5.0], turned), off_box([2.0, 3.0, 5.0], scaled)].map(|text| {
        let (mesh, _) = meshed("box.off", &text);
        (mesh.tetrahedra, mesh.triangles)
    });
    assert_eq!(plain, small);
}

/// TetGen's file of a box with an inner wall at x = 1; two regions, or a region and a hole.
fn two_rooms(hole: bool) -> String {
    let mut text = "12 3 0 0\n".to_owned();
    for i in 0..12 {
        let (x, y, z) = (i / 4, i % 4 / 2, i % 2);
        writeln!(text, "{i} {x} {y} {z}").expect("strings grow");
    }
    text += "11 1\n";
    for wall in [0, 4, 8] {
        writeln!(text, "1 0 {wall}\n4 {} {} {} {}", wall, wall + 1, wall + 3, wall + 2).expect("strings grow");
    }
    for (a, b, marker) in [(0, 1, 7), (1, 3, 7), (3, 2, 7), (2, 0, 7)] {
        for room in [0, 4] {
            let [a, b] = [a + room, b + room];
            writeln!(text, "1 0 {marker}\n4 {a} {b} {} {}", b + 4, a + 4).expect("strings grow");
        }
    }
    text += if hole {
        "1\n1 1.5 0.5 0.5\n1\n1 0.5 0.5 0.5 3 -1\n"
    } else {
        "0\n2\n1 0.5 0.5 0.5 3 -1\n2 1.5 0.5 0.5 4 -1\n"
    };
    text
}

#[test]
fn regions_holes_and_markers_of_tetgens_files_are_honoured() {
    let (mesh, volume) = meshed("rooms.poly", &two_rooms(false));
    assert!((volume - 2.0).abs() < 1e-14, "{volume}");
    let names = |mesh: &SolidMesh| -> Vec<String> {
        mesh.regions.iter().map(|&name| mesh.names.text(name).to_owned()).collect()
    };
    assert_eq!(names(&mesh), ["3", "4"]);
    assert!(mesh.triangles.iter().any(|t| mesh.names.text(t.name) == "7"));
    let (mesh, volume) = meshed("rooms.poly", &two_rooms(true));
    assert!((volume - 1.0).abs() < 1e-14, "{volume}");
    assert_eq!(names(&mesh), ["3"]);
}

#[test]
fn an_open_surface_is_refused_with_the_places_of_its_rim() {
    let whole = off_box([1.0; 3], |p| p);
    let open = whole.replace("8 6 0", "8 5 0").replace("4 1 3 7 5\n", "");
    let outcome = run_of("open.off", &open, &Request::default());
    let failure = outcome.report.failure.expect("it is open");
    assert_eq!((outcome.exit, failure.kind), (Exit::Geometry, FailureKind::Geometry));
    assert!(failure.what.contains("open") && !failure.help.is_empty(), "{failure:?}");
    assert!(matches!(failure.at, Some(Place::Space([1.0, ..]))), "{:?}", failure.at);
}

#[test]
fn facets_that_cross_are_refused_with_both_names() {
    let mut points = String::new();
    let mut faces = String::new();
    for (n, shift) in [0.0, 0.5].into_iter().enumerate() {
        let text = off_box([1.0; 3], |p| p.map(|x| x + shift));
        let rows: Vec<&str> = text.lines().skip(2).collect();
        rows[..8].iter().for_each(|row| points += &format!("{row}\n"));
        for face in &rows[8..] {
            let corners = face.split(' ').skip(1).map(|c| (c.parse::<usize>().unwrap() + 8 * n).to_string());
            faces += &format!("4 {}\n", corners.collect::<Vec<_>>().join(" "));
        }
    }
    let outcome = run_of("crossing.off", &format!("OFF\n16 12 0\n{points}{faces}"), &Request::default());
    let failure = outcome.report.failure.expect("they cross");
    assert_eq!(outcome.exit, Exit::Geometry);
    assert!(failure.what.contains("face") && failure.what.contains("cross"), "{}", failure.what);
}

#[test]
fn a_polygon_that_is_not_planar_is_refused_or_cut_or_made_flat() {
    let bent = off_box([1.0; 3], |[x, y, z]| [x, y, if x + y + z == 3.0 { 1.01 } else { z }]);
    let with = |solid: Assembly| run_of("bent.off", &bent, &Request { solid, ..Request::default() });
    let refused = with(Assembly::default());
    assert_eq!(refused.exit, Exit::Geometry);
    let failure = refused.report.failure.expect("it is not planar");
    assert!(failure.help.contains("--nonplanar triangles"), "{}", failure.help);
    let cut = with(Assembly { nonplanar: NonPlanar::Triangles, ..Assembly::default() });
    assert_eq!(cut.exit, Exit::Done, "{:?}", cut.report.failure);
    let flat = with(Assembly { flatten: Flatten::Within(0.02), ..Assembly::default() });
    assert_eq!(flat.exit, Exit::Done, "{:?}", flat.report.failure);
}

#[test]
fn a_budget_below_the_points_ends_before_the_kernel() {
    let request = Request { max_vertices: 4, ..Request::default() };
    let outcome = run_of("box.off", &off_box([1.0; 3], |p| p), &request);
    assert_eq!(outcome.exit, Exit::Missed);
    assert!(outcome.report.failure.expect("a failure").help.contains("--max-vertices"));
}

#[test]
fn a_cancelled_run_has_no_mesh() {
    let text = off_box([1.0; 3], |p| p);
    let source = Source { path: "box.off", bytes: text.as_bytes(), format: None, nodes: None, of_many: false };
    let outcome = run(&source, &Request::default(), Extent::Whole(&mut |_| false), &no_clock);
    assert!(outcome.solid.is_none() && outcome.report.failure.is_some());
}
