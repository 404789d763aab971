//! Meshes of order 2: on the curves, valid, and nearer to the true area.

use squinch::geometry::Point;
use squinch::ids::VertexId;
use squinch::import::Format;
use squinch::mesh::{Mesh, quality};
use squinch::run::request::{Order, Request};
use squinch::run::{self, Exit, Extent, Outcome, Source};
use squinch::verify::Status;
use squinch::watch::no_clock;

/// A run of an outline to order 2.
fn meshed(outline: &str, request: Request) -> Outcome {
    let source = Source {
        path: "test.json",
        bytes: outline.as_bytes(),
        format: Some(Format::Outline),
        nodes: None,
        of_many: false,
    };
    let outcome = run::run(&source, &request, Extent::Whole(&mut |_| true), &no_clock);
    assert_eq!(outcome.exit, Exit::Done, "{:?}", outcome.report.promise);
    outcome
}

fn second() -> Request {
    Request { order: Order::Second, ..Request::default() }
}

fn status(outcome: &Outcome, name: &str) -> Status {
    outcome.verdict.as_ref().unwrap().checks.iter().find(|c| c.name == name).unwrap().status
}

fn sample(name: &str) -> String {
    std::fs::read_to_string(format!("{}/samples/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

#[test]
fn the_area_of_curved_samples_is_a_hundred_times_nearer() {
    let disk = r#"{"squinch": 1, "curves": [{"circle": {"center": [3, 4], "radius": 5}}]}"#.to_owned();
    let oval = r#"{"squinch": 1, "curves": [{"ellipse": {"center": [1e3, 0], "u": [3, 1], "v": [-1, 2]}}]}"#.to_owned();
    let blob =
        r#"{"squinch": 1, "curves": [{"closed_spline": [[0, 0], [4, -1], [6, 2], [3, 5], [-1, 3]]}]}"#.to_owned();
    for outline in [disk, oval, blob, sample("plate.json")] {
        let error = |request| {
            let quality = meshed(&outline, request).report.quality.unwrap();
            let quality = quality.in_plane().unwrap();
            (quality.measure - quality.exact_measure.unwrap()).abs()
        };
        let (first, second) = (error(Request::default()), error(second()));
        assert!(second < first / 100.0, "{first} at order 1, {second} at order 2");
    }
}

#[test]
fn every_cell_is_valid_and_every_edge_has_one_node() {
    let outcome = meshed(&sample("plate.json"), second());
    let mesh = outcome.mesh.as_ref().unwrap();
    assert_eq!(status(&outcome, "jacobian"), Status::Proven);
    assert_eq!(mesh.order(), 2);
    assert!(outcome.report.mesh.as_ref().unwrap().straightened.is_empty());
    // Every edge is a side of two cells, but those of the border of one.
    let used: std::collections::BTreeSet<VertexId> = mesh.triangle_mids.iter().flatten().copied().collect();
    let border = 2 * used.len() - 3 * mesh.triangles.len();
    assert!(0 < border && border <= mesh.edges.len());
    assert_eq!(mesh.edge_mids.len(), mesh.edges.len());
    assert!(mesh.edge_mids.iter().all(|v| used.contains(v)));
}

#[test]
fn a_cell_between_tangent_curves_has_its_curved_side_straightened() {
    // y = x⁴ on y = 0: a parabola from the corner through any two points of the curve that are not far apart dips below
    // the line.
    let outline = r#"{"squinch": 1, "curves": [
        {"name": "quartic", "bezier": [[0, 0], [0.25, 0], [0.5, 0], [0.75, 0], [1, 1]]},
        {"name": "floor", "line": [[0, 0], [1, 0]]},
        {"name": "wall", "line": [[1, 0], [1, 1]]}]}"#;
    let outcome = meshed(outline, second());
    let straightened = &outcome.report.mesh.as_ref().unwrap().straightened;
    let [only] = straightened.as_slice() else { panic!("{straightened:?}") };
    assert_eq!(only.boundary, "quartic");
    assert!(Point::new(only.at[0], only.at[1]).to_vec2().hypot() < 0.5);
    assert_eq!(status(&outcome, "jacobian"), Status::Proven);
    assert_eq!(status(&outcome, "on_curve"), Status::Proven);
}

/// The checks that break after a change of the mesh.
fn verified_after(outcome: &Outcome, change: impl FnOnce(&mut Mesh)) -> Vec<&'static str> {
    let mut mesh = outcome.mesh.clone().unwrap();
    change(&mut mesh);
    let plan = run::Plan::without_domain(&Request::default());
    run::broken(&plan.verify(outcome.domain.as_ref(), &mesh))
}

#[test]
fn the_verifier_finds_a_folded_cell_a_stray_node_and_a_torn_edge() {
    let outcome = meshed(r#"{"squinch": 1, "curves": [{"circle": {"center": [0, 0], "radius": 1}}]}"#, second());
    assert_eq!(verified_after(&outcome, |_| {}), [""; 0]);
    // The node of an inner edge moved to a corner: the cell has no angle there.
    let folded = verified_after(&outcome, |mesh| {
        let t =
            mesh.triangles.ids().find(|&t| mesh.triangle_mids[t].iter().all(|v| !mesh.edge_mids.contains(v))).unwrap();
        let corner = mesh.nodes[mesh.triangles[t][0]];
        let mid = mesh.triangle_mids[t][0];
        mesh.nodes[mid] = corner;
    });
    assert_eq!(folded, ["jacobian"]);
    // A node on the rim pushed off it.
    let stray = verified_after(&outcome, |mesh| {
        let mid = mesh.edge_mids[0];
        mesh.nodes[mid] = (mesh.nodes[mid].to_vec2() * 1.001).to_point();
    });
    assert_eq!(stray, ["on_curve"]);
    let torn = verified_after(&outcome, |mesh| {
        let edge = mesh.triangles.ids().find(|&t| mesh.triangle_mids[t].iter().all(|v| !mesh.edge_mids.contains(v)));
        let t = edge.unwrap();
        let twin = mesh.nodes.push(mesh.nodes[mesh.triangle_mids[t][0]]);
        mesh.triangle_mids[t][0] = twin;
    });
    assert_eq!(torn, ["jacobian"]);
    let short = verified_after(&outcome, |mesh| mesh.edge_mids.truncate(1));
    assert_eq!(short, ["manifold"]);
}

#[test]
fn cells_of_order_two_cover_what_their_sides_enclose() {
    let outcome = meshed(r#"{"squinch": 1, "curves": [{"circle": {"center": [0, 0], "radius": 1}}]}"#, second());
    let mesh = outcome.mesh.as_ref().unwrap();
    let cells: f64 = mesh.triangles.ids().map(|t| quality::cell_area(mesh, t)).sum();
    // Simpson's rule is exact for Green's integrand along a parabola, which is of degree 3.
    let sides = mesh.edges.iter().zip(&mesh.edge_mids).map(|(edge, &mid)| {
        let [a, b] = edge.nodes.map(|v| mesh.nodes[v].to_vec2());
        let m = mesh.nodes[mid].to_vec2();
        let (start, middle, end) = (-3.0 * a + 4.0 * m - b, b - a, a - 4.0 * m + 3.0 * b);
        0.5 * (a.cross(start) + 4.0 * m.cross(middle) + b.cross(end)) / 6.0
    });
    let rim: f64 = sides.sum();
    approx::assert_relative_eq!(cells, rim.abs(), max_relative = 1e-12);
}
