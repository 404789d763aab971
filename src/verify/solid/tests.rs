//! Sound meshes are kept, and each broken one breaks what it should and nothing else.

use super::verify_solid;
use crate::ids::{FacetId, Id, IdVec, Names, PointId, RegionId, SegmentId, TetId, VertexId};
use crate::mesh::solid::{FacetTriangle, SegmentEdge, SolidMesh};
use crate::solid::{Facet, Material, RegionSeed, Segment, Solid};
use crate::verify::{Status, Verdict};

/// Corner `i` of the unit cube has the coordinates i & 1, i >> 1 & 1, i >> 2.
const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const NAMES: [&str; 6] = ["bottom", "top", "front", "rear", "left", "right"];
/// The inner one last, its corners 1, 2, 4 and 7.
const FIVE: [[u32; 4]; 5] = [[0, 1, 2, 4], [3, 2, 1, 7], [5, 4, 7, 1], [6, 7, 4, 2], [1, 2, 4, 7]];

fn corner(i: u32) -> [f64; 3] {
    [i & 1, i >> 1 & 1, i >> 2].map(f64::from)
}

/// A cube whose facets are squares, as a TetGen file has it, or with winding numbers.
fn cube(winding: bool) -> Solid {
    let mut names = Names::default();
    let mut segments: IdVec<SegmentId, Segment> = IdVec::new();
    let ends = |i: usize, k: usize| {
        let (a, b) = (FACES[i][k], FACES[i][(k + 1) % 4]);
        [a.min(b), a.max(b)].map(PointId)
    };
    for (i, k) in (0..6).flat_map(|i| (0..4).map(move |k| (i, k))) {
        if segments.iter().all(|s| s.ends != ends(i, k)) {
            segments.push(Segment { ends: ends(i, k), name: None });
        }
    }
    let facet = |(i, name): (usize, &str)| {
        let rim = FACES[i].map(PointId);
        let [a, b, c, d] = rim;
        Facet {
            rims: vec![rim.to_vec()],
            segments: segments.enumerate().filter(|(_, s)| (0..4).any(|k| ends(i, k) == s.ends)).map(|s| s.0).collect(),
            inner_points: Vec::new(),
            plane: [a, b, c],
            triangles: vec![[a, b, c], [a, c, d]],
            winding: 1,
            name: Some(names.intern(name)),
            entity: format!("square {i}"),
        }
    };
    let facets = NAMES.into_iter().enumerate().map(facet).collect();
    let seed = RegionSeed { at: [0.5; 3], name: names.intern("body") };
    let cells = Material::Cells { holes: vec![[2.0; 3]], regions: vec![seed] };
    let material = if winding { Material::Winding } else { cells };
    let points = (0..8).map(corner).collect();
    Solid { points, segments, facets, names, material, unit: None, repairs: Vec::new() }
}

/// The mesh of these tetrahedra: facet triangles are the faces on each square.
fn mesh(solid: &Solid, tetrahedra: &[[u32; 4]]) -> SolidMesh {
    let mut mesh = SolidMesh {
        nodes: solid.points.iter().copied().collect(),
        tetrahedra: tetrahedra.iter().map(|t| t.map(VertexId)).collect(),
        tetrahedron_regions: tetrahedra.iter().map(|_| RegionId(0)).collect(),
        names: solid.names.clone(),
        points: (0..8).map(|i| (PointId(i), VertexId(i))).collect(),
        ..SolidMesh::default()
    };
    let body = mesh.names.intern("body");
    mesh.regions.push(body);
    // The inner tetrahedron of five is a little heavier than what is around it.
    mesh.weights = heavy(&[1, 2, 4, 7]);
    for (f, square) in FACES.iter().enumerate() {
        let faces = tetrahedra.iter().flat_map(|t| super::faces::FACES.map(|face| face.map(|i| t[i])));
        for nodes in faces.filter(|face| face.iter().all(|v| square.contains(v))) {
            add_triangle(&mut mesh, f as u32, nodes);
        }
    }
    for (s, segment) in solid.segments.enumerate() {
        let nodes = segment.ends.map(|p| VertexId(p.0));
        mesh.edges.push(SegmentEdge { nodes, name: None, segment: Some(s) });
    }
    mesh
}

/// Weights of the corners: small ones of some, none of the others.
fn heavy(corners: &[u32]) -> IdVec<VertexId, f64> {
    (0..8).map(|i| if corners.contains(&i) { 1e-9 } else { 0.0 }).collect()
}

fn add_triangle(mesh: &mut SolidMesh, facet: u32, nodes: [u32; 3]) {
    let name = mesh.names.intern(NAMES[facet as usize]);
    mesh.triangles.push(FacetTriangle { nodes: nodes.map(VertexId), name, facet: Some(FacetId(facet)) });
}

/// Six around the diagonal from corner 0 to corner 7.
fn six() -> Vec<[u32; 4]> {
    [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]].iter().map(|&[a, b]| [0, a, b, 7]).collect()
}

fn broken(verdict: &Verdict) -> Vec<&'static str> {
    verdict.checks.iter().filter(|c| c.status == Status::Broken).map(|c| c.name).collect()
}

/// The cube of five tetrahedra, broken, and what of it the verifier finds broken.
fn broken_by(change: impl FnOnce(&mut SolidMesh)) -> Vec<&'static str> {
    let solid = cube(false);
    let mut mesh = mesh(&solid, &FIVE);
    change(&mut mesh);
    let verdict = verify_solid(Some(&solid), &mesh);
    // Every broken check names a culprit.
    assert!(verdict.checks.iter().all(|c| (c.broken == 0) == c.flaws.is_empty()), "{verdict:?}");
    broken(&verdict)
}

#[test]
fn sound_meshes_are_kept() {
    for winding in [false, true] {
        let solid = cube(winding);
        for cells in [FIVE.to_vec(), six()] {
            let mut mesh = mesh(&solid, &cells);
            if cells.len() == 6 {
                mesh.weights = heavy(&[0, 7]);
            }
            let verdict = verify_solid(Some(&solid), &mesh);
            assert!(verdict.checks.iter().all(|c| c.status == Status::Proven && c.checked > 0), "{verdict:?}");
        }
    }
}

#[test]
fn a_turned_cube_is_kept() {
    let (sin, cos) = (libm::sin(0.7), libm::cos(0.7));
    let turned = |[x, y, z]: [f64; 3]| [cos * x - sin * y, sin * x + cos * y, z].map(|c| 1e5 * c + 3e6);
    let mut solid = cube(true);
    solid.points = solid.points.iter().map(|&p| turned(p)).collect();
    let mut mesh = mesh(&solid, &FIVE);
    mesh.weights.iter_mut().for_each(|w| *w *= 1e10);
    let verdict = verify_solid(Some(&solid), &mesh);
    assert_eq!(broken(&verdict), [""; 0], "{verdict:?}");
}

#[test]
fn a_mesh_without_solid_or_links_or_weights_is_checked_as_far_as_it_goes() {
    let solid = cube(false);
    let mut mesh = mesh(&solid, &FIVE);
    mesh.weights = IdVec::new();
    let status = |verdict: &Verdict, name: &str| verdict.checks.iter().find(|c| c.name == name).unwrap().status;
    let verdict = verify_solid(None, &mesh);
    for (name, right) in [("orientation", Status::Proven), ("volume", Status::NotAsked), ("weights", Status::NotAsked)]
    {
        assert_eq!(status(&verdict, name), right);
    }
    assert!(verdict.kept());
    // Corner 0 is moved into the sphere: told, but nothing without weights asks for it.
    mesh.nodes[VertexId(0)] = [0.25; 3];
    let verdict = verify_solid(None, &mesh);
    let check = verdict.checks.iter().find(|c| c.name == "constrained_delaunay").unwrap();
    assert_eq!(check.status, Status::NotAsked);
    // Deeper still is corner 7 within the sphere of corner 0 and the three between: (t, t, t) with t = 13/8.
    let depth = 1.0 - 0.625 / 1.375;
    assert!((check.worst.unwrap().value - depth).abs() < 1e-12 && check.worst.unwrap().at == [1.0; 3], "{check:?}");
    mesh.points.clear();
    mesh.triangles.iter_mut().for_each(|t| t.facet = None);
    mesh.edges.iter_mut().for_each(|e| e.segment = None);
    assert!(verify_solid(Some(&solid), &mesh).kept());
}

#[test]
fn what_is_inverted_or_flat_breaks_orientation() {
    assert_eq!(broken_by(|mesh| mesh.tetrahedra[TetId(4)].swap(0, 1)), ["orientation"]);
}

#[test]
fn a_face_with_three_tetrahedra_breaks_manifold() {
    // A copy of the inner one: its faces have three each, and the volume counts it again.
    let twice = |mesh: &mut SolidMesh| {
        mesh.tetrahedra.push([1, 2, 4, 7].map(VertexId));
        mesh.tetrahedron_regions.push(RegionId(0));
    };
    assert_eq!(broken_by(twice), ["manifold", "volume"]);
    let idle = |mesh: &mut SolidMesh| {
        mesh.nodes.push([0.5; 3]);
        mesh.weights.push(0.0);
    };
    assert_eq!(broken_by(idle), ["manifold"]);
}

#[test]
fn facets_are_covered_once() {
    assert_eq!(broken_by(|mesh| mesh.triangles.push(mesh.triangles[0])), ["facets"]);
    // The face of a tetrahedron that no facet triangle is on ends the mesh.
    assert_eq!(broken_by(|mesh| mesh.triangles.truncate(11)), ["facets", "volume"]);
    assert_eq!(broken_by(|mesh| mesh.triangles[3].nodes.swap(0, 1)), ["facets"]);
    // On no facet.
    assert_eq!(broken_by(|mesh| mesh.triangles[0].facet = None), ["facets"]);
}

#[test]
fn facets_are_flat() {
    // The middle of the top, 1e-9 too high: the facet gets four triangles, and one more tetrahedron is cut in two.
    let solid = cube(false);
    let lift = |height: f64| {
        let mut cells = FIVE.to_vec();
        for t in [[5, 4, 7, 1], [6, 7, 4, 2]] {
            cells.retain(|u| *u != t);
        }
        // Corners 4 and 7 are the diagonal of the top: 8 divides it.
        cells.retain(|t| *t != [1, 2, 4, 7]);
        cells.extend([[1, 2, 4, 8], [1, 2, 8, 7], [5, 4, 8, 1], [5, 8, 7, 1], [6, 7, 8, 2], [6, 8, 4, 2]]);
        let mut with_middle = mesh(&solid, &cells);
        with_middle.nodes.push([0.5, 0.5, 1.0 + height]);
        with_middle.weights.push(0.0);
        for nodes in [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]] {
            add_triangle(&mut with_middle, 1, nodes);
        }
        // Weights that make the four around the new node regular are not the point here.
        with_middle.weights = IdVec::new();
        let verdict = verify_solid(Some(&solid), &with_middle);
        (broken(&verdict), verdict)
    };
    let (flat, verdict) = lift(0.0);
    assert_eq!(flat, [""; 0], "{verdict:?}");
    assert_eq!(lift(1e-15).0, [""; 0]);
    let (high, verdict) = lift(1e-9);
    assert_eq!(high, ["facets", "volume"], "{verdict:?}");
}

#[test]
fn four_nodes_on_a_facet_are_no_tetrahedron() {
    // A corner of the top is one unit in the last place too high, and a sliver turns the diagonal of the top.
    let mut solid = cube(false);
    solid.points[PointId(5)][2] = 1.0f64.next_up();
    let mut sliver = mesh(&solid, &FIVE);
    sliver.tetrahedra.push([6, 4, 7, 5].map(VertexId));
    sliver.tetrahedron_regions.push(RegionId(0));
    sliver.triangles.retain(|t| t.facet != Some(FacetId(1)));
    add_triangle(&mut sliver, 1, [4, 5, 6]);
    add_triangle(&mut sliver, 1, [5, 7, 6]);
    sliver.weights = IdVec::new();
    let verdict = verify_solid(Some(&solid), &sliver);
    assert_eq!(broken(&verdict), ["facets"], "{verdict:?}");
    assert!(verdict.checks[2].flaws.iter().all(|flaw| flaw.contains("four nodes")), "{verdict:?}");
}

#[test]
fn segments_are_chains() {
    assert_eq!(broken_by(|mesh| mesh.edges[0].nodes.reverse()), ["segments"]);
    assert_eq!(broken_by(|mesh| mesh.edges[0].segment = None), ["facets", "segments"]);
    // A diagonal of the cube, which no tetrahedron has.
    let stray = SegmentEdge { nodes: [0, 7].map(VertexId), name: None, segment: None };
    assert_eq!(broken_by(|mesh| mesh.edges.push(stray)), ["segments"]);
    assert_eq!(broken_by(|mesh| mesh.points[3].1 = VertexId(4)), ["segments"]);
}

#[test]
fn a_flip_breaks_constrained_delaunay() {
    // Six tetrahedra share the diagonal of the cube; heavy corners of the inner one of five ask for those five.
    let solid = cube(false);
    let mut mesh = mesh(&solid, &six());
    mesh.weights = heavy(&[1, 2, 4]);
    let verdict = verify_solid(Some(&solid), &mesh);
    assert_eq!(broken(&verdict), ["constrained_delaunay"], "{verdict:?}");
}

#[test]
fn a_hole_in_the_mesh_breaks_volume() {
    let without = |mesh: &mut SolidMesh| {
        mesh.tetrahedra = FIVE[..4].iter().map(|t| t.map(VertexId)).collect();
        mesh.tetrahedron_regions = vec![RegionId(0); 4].into();
    };
    assert_eq!(broken_by(without), ["volume"]);
    // Two regions and no facet between them.
    let parted = |mesh: &mut SolidMesh| {
        let body = mesh.regions[RegionId(0)];
        let other = mesh.regions.push(body);
        mesh.tetrahedron_regions[TetId(0)] = other;
    };
    assert_eq!(broken_by(parted), ["volume"]);
    // Material where the input has a hole, or outside of its surfaces.
    let mut solid = cube(false);
    solid.material = Material::Cells { holes: vec![[0.5; 3]], regions: Vec::new() };
    assert_eq!(broken(&verify_solid(Some(&solid), &mesh(&solid, &FIVE))), ["volume"]);
    let mut solid = cube(true);
    solid.facets.iter_mut().for_each(|f| f.winding = -1);
    assert_eq!(broken(&verify_solid(Some(&solid), &mesh(&solid, &FIVE))), ["volume"]);
}

#[test]
fn weights_are_small() {
    assert_eq!(broken_by(|mesh| mesh.weights.iter_mut().for_each(|w| *w *= 2e3)), ["weights"]);
    assert_eq!(broken_by(|mesh| mesh.weights.iter_mut().for_each(|w| *w -= 1e-12)), ["weights"]);
}

#[test]
fn names_are_kept() {
    let top = |mesh: &mut SolidMesh| mesh.triangles[0].name = mesh.names.intern("top");
    assert_eq!(broken_by(top), ["names"]);
    let region = |mesh: &mut SolidMesh| mesh.regions[RegionId(0)] = mesh.names.intern("soul");
    assert_eq!(broken_by(region), ["names"]);
    let edge = |mesh: &mut SolidMesh| mesh.edges[0].name = Some(mesh.names.intern("edge"));
    assert_eq!(broken_by(edge), ["names"]);
}

#[test]
fn garbage_is_told_first() {
    let far = VertexId(99);
    type Spoil = Box<dyn Fn(&mut SolidMesh)>;
    let garbage: [Spoil; 12] = [
        Box::new(move |mesh| mesh.tetrahedra[TetId(0)][2] = far),
        Box::new(|mesh| mesh.tetrahedron_regions[TetId(0)] = RegionId(5)),
        Box::new(|mesh| mesh.tetrahedron_regions = IdVec::new()),
        Box::new(|mesh| mesh.regions[RegionId(0)] = crate::ids::NameId(77)),
        Box::new(move |mesh| mesh.triangles[0].nodes[0] = far),
        Box::new(|mesh| mesh.triangles[0].facet = Some(FacetId(6))),
        Box::new(move |mesh| mesh.edges[0].nodes[1] = far),
        Box::new(|mesh| mesh.edges[0].segment = Some(SegmentId(12))),
        Box::new(move |mesh| mesh.points[0].1 = far),
        Box::new(|mesh| mesh.points[0].0 = PointId(8)),
        Box::new(|mesh| mesh.weights.resize(9, 0.0)),
        Box::new(|mesh| mesh.nodes[VertexId(0)][1] = f64::NAN),
    ];
    for change in garbage {
        assert_eq!(broken_by(change), ["manifold"]);
    }
    assert!(verify_solid(None, &SolidMesh::default()).kept());
    // Corners that are one node, and a facet triangle of one node, are no reason to stop.
    let collapsed = |mesh: &mut SolidMesh| {
        mesh.tetrahedra[TetId(0)] = [VertexId(3); 4];
        mesh.triangles[0].nodes = [VertexId(2); 3];
    };
    assert!(broken_by(collapsed).contains(&"orientation"));
    assert_eq!(FacetId(3).index(), 3);
}
