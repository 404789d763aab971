//! A small mesh of three regions with named boundaries, and how meshes are compared with what is read back of them.
#![allow(dead_code)] // each test binary takes its part

use squinch::geometry::Point;
use squinch::ids::{Id, NameId, RegionId, VertexId};
use squinch::mesh::{CurveEdge, Mesh};
use squinch::meshio::{Format, MeshFile, WriteOptions, encode, read};
use std::collections::BTreeMap;

/// Three regions (two of one name) in a strip of n × 2 squares, its rim and the line between the rows named; far from
/// the origin, with endless digits.
pub fn strip(n: u32, names: [&str; 5]) -> Mesh {
    let mut mesh = Mesh { unit: Some("mm".into()), ..Mesh::default() };
    for i in 0..=n {
        for j in 0..=2 {
            mesh.nodes.push(Point::new(1e5 + f64::from(i) / 3.0, f64::from(j) / 7.0 - 12.0));
        }
    }
    let [lower, upper, bottom, top, between] = names.map(|name| mesh.names.intern(name));
    mesh.regions = vec![lower, upper, lower].into();
    let node = |i: u32, j: u32| VertexId(3 * i + j);
    for i in 0..n {
        for j in 0..2 {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                mesh.triangles.push(triangle);
                mesh.triangle_regions.push(RegionId(if j == 1 {
                    1
                } else if i == 0 {
                    2
                } else {
                    0
                }));
            }
        }
        for (j, name) in [(0, bottom), (1, between), (2, top)] {
            mesh.edges.push(CurveEdge { nodes: [node(i, j), node(i + 1, j)], name, link: None });
        }
    }
    for i in [0, n] {
        for j in 0..2 {
            mesh.edges.push(CurveEdge { nodes: [node(i, j), node(i, j + 1)], name: bottom, link: None });
        }
    }
    mesh
}

/// The same with a node within every edge, a little off its middle.
pub fn second_order(mut mesh: Mesh) -> Mesh {
    let mut mids: BTreeMap<[VertexId; 2], VertexId> = BTreeMap::new();
    let mut nodes = mesh.nodes.clone();
    let mut mid = |a: VertexId, b: VertexId| {
        *mids.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let p = nodes[a].midpoint(nodes[b]);
            nodes.push(Point::new(p.x, p.y + 0.01))
        })
    };
    mesh.triangle_mids = mesh.triangles.iter().map(|&[a, b, c]| [mid(a, b), mid(b, c), mid(c, a)]).collect();
    mesh.edge_mids = mesh.edges.iter().map(|e| mid(e.nodes[0], e.nodes[1])).collect();
    mesh.nodes = nodes;
    mesh
}

pub const PLAIN: [&str; 5] = ["steel", "air", "wall", "inlet", "interface"];
pub const ODD: [&str; 5] = ["Stahl & \"Luft\" 37%", "7", "Wand", "wand", "über der Mitte"];

/// Names with their numbers of cells: of regions, of boundaries.
pub type Counts = (BTreeMap<String, usize>, BTreeMap<String, usize>);

pub fn counts(mesh: &Mesh) -> Counts {
    let mut counts = Counts::default();
    let text = |name: NameId| mesh.names.text(name).to_owned();
    for &region in mesh.triangle_regions.iter() {
        *counts.0.entry(text(mesh.regions[region])).or_default() += 1;
    }
    for edge in &mesh.edges {
        *counts.1.entry(text(edge.name)).or_default() += 1;
    }
    counts
}

/// The nodes of a cell, as the bits of their coordinates.
pub type CellPlaces = Vec<[u64; 3]>;

/// The corners of all triangles and the ends of all edges, as places, sorted: the same whatever the order of cells.
pub fn shape(mesh: &Mesh) -> (Vec<CellPlaces>, Vec<CellPlaces>) {
    let places: Vec<[u64; 3]> = mesh.places().map(|p| p.map(|x| (x + 0.0).to_bits())).collect();
    let at = |v: &VertexId| places[v.index()];
    let mids = |t| mesh.triangle_mids.get(t).into_iter().flatten();
    let mut triangles: Vec<Vec<_>> =
        mesh.triangles.enumerate().map(|(t, corners)| corners.iter().chain(mids(t)).map(at).collect()).collect();
    let mut edges: Vec<Vec<_>> = Vec::new();
    for (i, edge) in mesh.edges.iter().enumerate() {
        let mut ends: Vec<_> = edge.nodes.iter().map(at).collect();
        ends.sort_unstable();
        edges.push(ends.into_iter().chain(mesh.edge_mids.get(i).map(at)).collect());
    }
    triangles.iter_mut().for_each(|t| turned_first(t));
    triangles.sort_unstable();
    edges.sort_unstable();
    (triangles, edges)
}

/// A triangle from its smallest corner on, mid nodes along.
fn turned_first(triangle: &mut [[u64; 3]]) {
    let first = (0..3).min_by_key(|&k| triangle[k]).expect("three corners");
    triangle[..3].rotate_left(first);
    if triangle.len() == 6 {
        triangle[3..].rotate_left(first);
    }
}

/// Writes and reads back.
pub fn around(mesh: &Mesh, format: Format) -> MeshFile {
    around_with(mesh, format, &WriteOptions::default())
}

pub fn around_with(mesh: &Mesh, format: Format, options: &WriteOptions) -> MeshFile {
    let files = encode(mesh, &[], format, options).unwrap_or_else(|e| panic!("{format:?}: {e}"));
    let of = |suffix: &str| {
        let place = format.suffixes().iter().position(|s| *s == suffix);
        place.and_then(|i| files.get(i).cloned())
    };
    let reading = format.reading().expect("a format that is read");
    let main = of(reading.suffix).expect("the main file");
    let beside: Vec<_> = reading.beside.iter().map(|suffix| of(suffix)).collect();
    read(&main, format, &beside).unwrap_or_else(|e| panic!("{format:?}: {e}"))
}

/// The formats that are read, too: whatever is written of them comes back.
pub fn read_back() -> impl Iterator<Item = Format> {
    Format::ALL.into_iter().filter(|format| format.reading().is_some())
}
