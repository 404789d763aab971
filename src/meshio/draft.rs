//! A mesh while it is read. Cells are added one by one and checked at the end.
//!
//! ```text
//!    Nodes of second-order cells, in our order, which is also VTK's and Gmsh's:
//!
//!            2                      triangle: corners 0 1 2, then 3 within side 01, 4 within 12, 5 within 20
//!           ╱ ╲                     line:     ends 0 1, then 2 within
//!          5   4
//!         ╱     ╲                   Readers reorder the nodes of other formats. In our numbers these have:
//!        0───3───1    0───2───1     Abaqus' lines 0 2 1, Triangle's triangles 0 1 2 4 5 3
//! ```

use super::{MeshFile, Result, broken, unsupported};
use crate::geometry::{Frame, Point};
use crate::ids::{Id, IdVec, NameId, Names, RegionId, VertexId};
use crate::mesh::{CurveEdge, Mesh};
use std::collections::BTreeMap;

/// Name of regions and of boundaries where the file has none.
pub const REGION: &str = "region";
/// Name of boundaries where the file has none.
pub const BOUNDARY: &str = "boundary";
/// Cell arrays by which programs distinguish groups of cells: ours, Gmsh's by meshio, Medit's, and two common names.
pub const FOREIGN: [&str; 5] = ["region", "gmsh:physical", "medit:ref", "CellEntityIds", "material"];

/// A mesh while it is read.
#[derive(Default)]
pub struct Draft {
    /// The nodes.
    pub nodes: Vec<[f64; 3]>,
    triangles: Vec<(Vec<usize>, RegionId)>,
    edges: Vec<(Vec<usize>, NameId)>,
    names: Names,
    regions: IdVec<RegionId, NameId>,
    region_of: BTreeMap<NameId, RegionId>,
    /// Number of cells that are points.
    pub vertices: usize,
}

impl Draft {
    /// The region of this name, added if it is new.
    pub fn region(&mut self, name: &str) -> RegionId {
        let name = self.names.intern(name);
        *self.region_of.entry(name).or_insert_with(|| self.regions.push(name))
    }

    /// Adds a triangle: 3 corners, then none or 3 nodes within its sides, in the order of [`Mesh::triangle_mids`].
    pub fn triangle(&mut self, nodes: Vec<usize>, region: &str) {
        let region = self.region(region);
        self.triangles.push((nodes, region));
    }

    /// Adds a line: 2 ends, then none or 1 node within.
    pub fn line(&mut self, nodes: Vec<usize>, name: &str) {
        let name = self.names.intern(name);
        self.edges.push((nodes, name));
    }

    /// The mesh, after all checks.
    pub fn finish(mut self) -> Result<MeshFile> {
        self.check()?;
        let order = if self.triangles.iter().any(|(nodes, _)| nodes.len() == 6) { 2 } else { 1 };
        if order == 2 {
            self.find_mids()?;
            self.corners_first();
        }
        let (nodes, frame) = plane(&self.nodes)?;
        let id = |&n: &usize| VertexId::from_index(n);
        let mut mesh = Mesh { nodes, frame, regions: self.regions, names: self.names, ..Mesh::default() };
        for (nodes, region) in &self.triangles {
            mesh.triangles.push([0, 1, 2].map(|k| id(&nodes[k])));
            mesh.triangle_regions.push(*region);
            if order == 2 {
                mesh.triangle_mids.push([3, 4, 5].map(|k| id(&nodes[k])));
            }
        }
        for (nodes, name) in &self.edges {
            mesh.edges.push(CurveEdge { nodes: [0, 1].map(|k| id(&nodes[k])), name: *name, link: None });
            mesh.edge_mids.extend(nodes.get(2).map(id));
        }
        let mut notes = Vec::new();
        if self.vertices > 0 {
            notes.push(format!("{} vertex cells are left out", self.vertices));
        }
        Ok(MeshFile { mesh, stamps: Vec::new(), notes })
    }

    fn check(&self) -> Result<()> {
        if let Some((i, p)) = self.nodes.iter().enumerate().find(|(_, p)| p.iter().any(|v| !v.is_finite())) {
            return Err(broken(format!("node {i} is at ({}, {}, {})", p[0], p[1], p[2])));
        }
        if u32::try_from(self.nodes.len().max(self.triangles.len())).is_err() {
            return Err(unsupported("the mesh has more than 2^32 nodes or triangles", "cut it in parts"));
        }
        let cells = self.triangles.iter().map(|(nodes, _)| nodes).chain(self.edges.iter().map(|(nodes, _)| nodes));
        if let Some(node) = cells.flatten().find(|&&n| n >= self.nodes.len()) {
            return Err(broken(format!("a cell has the node {node}, but there are {}", self.nodes.len())));
        }
        let kinds = |n: usize| self.triangles.iter().any(|(nodes, _)| nodes.len() == n);
        if kinds(3) && (kinds(6) || self.edges.iter().any(|(nodes, _)| nodes.len() == 3)) {
            return Err(unsupported("cells of first and second order are mixed", "save the mesh in one order"));
        }
        Ok(())
    }

    /// A line of order 2 without a mid node (some formats have none) takes it from the triangle beside it.
    fn find_mids(&mut self) -> Result<()> {
        if self.edges.iter().all(|(nodes, _)| nodes.len() == 3) {
            return Ok(());
        }
        let mut mids = BTreeMap::new();
        for (nodes, _) in &self.triangles {
            for side in 0..3 {
                let (a, b) = (nodes[side], nodes[(side + 1) % 3]);
                mids.insert((a.min(b), a.max(b)), nodes[3 + side]);
            }
        }
        for (nodes, _) in self.edges.iter_mut().filter(|(nodes, _)| nodes.len() == 2) {
            let mid = mids.get(&(nodes[0].min(nodes[1]), nodes[0].max(nodes[1])));
            nodes.push(*mid.ok_or_else(|| broken("a straight line is not a side of a triangle of second order"))?);
        }
        Ok(())
    }

    /// Renumbers the nodes so that nodes within sides come last. Otherwise their order is kept.
    fn corners_first(&mut self) {
        let mut corner = vec![false; self.nodes.len()];
        let mut mid = vec![false; self.nodes.len()];
        let cells =
            self.triangles.iter().map(|(nodes, _)| (nodes, 3)).chain(self.edges.iter().map(|(nodes, _)| (nodes, 2)));
        for (nodes, corners) in cells {
            nodes[..corners].iter().for_each(|&n| corner[n] = true);
            nodes[corners..].iter().for_each(|&n| mid[n] = true);
        }
        let late = |n: &usize| mid[*n] && !corner[*n];
        let (last, first): (Vec<usize>, Vec<usize>) = (0..self.nodes.len()).partition(late);
        let order: Vec<usize> = first.into_iter().chain(last).collect();
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| place[old] = new);
        self.nodes = order.iter().map(|&old| self.nodes[old]).collect();
        let cells =
            self.triangles.iter_mut().map(|(nodes, _)| nodes).chain(self.edges.iter_mut().map(|(nodes, _)| nodes));
        cells.flatten().for_each(|n| *n = place[*n]);
    }
}

/// Largest distance of a node from the plane, in parts of the mesh's extent: the rounding of 32-bit numbers.
const FLATNESS: f64 = 1e-6;

/// The nodes in their plane, and the frame of the plane if it is not z = 0.
pub fn plane(places: &[[f64; 3]]) -> Result<(IdVec<VertexId, Point>, Option<Frame>)> {
    let z = places.first().map_or(0.0, |p| p[2]);
    if places.iter().all(|p| p[2] == z) {
        let frame = (z != 0.0).then_some(Frame { origin: [0.0, 0.0, z], x: [1.0, 0.0, 0.0], y: [0.0, 1.0, 0.0] });
        return Ok((places.iter().map(|p| Point::new(p[0], p[1])).collect(), frame));
    }
    let origin = places[0];
    let from = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| p[k] - origin[k]) };
    let (mut far, mut x) = (0.0, [0.0; 3]);
    for d in places.iter().map(from) {
        if norm(d) > far {
            (far, x) = (norm(d), d);
        }
    }
    x = x.map(|v| v / far);
    let across = |d: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| d[k] - dot(d, x) * x[k]) };
    let (mut wide, mut y) = (0.0, [0.0; 3]);
    for d in places.iter().map(from).map(across) {
        if norm(d) > wide {
            (wide, y) = (norm(d), d);
        }
    }
    if wide <= FLATNESS * far {
        return Err(unsupported("all nodes are on one line", "only meshes in a plane can be read"));
    }
    y = across(y.map(|v| v / wide));
    y = y.map(|v| v / norm(y));
    let mut nodes = IdVec::with_capacity(places.len());
    for (i, p) in places.iter().enumerate() {
        let d = from(p);
        let off: [f64; 3] = std::array::from_fn(|k| d[k] - dot(d, x) * x[k] - dot(d, y) * y[k]);
        // NaN where coordinates are too large to be squared.
        if norm(off).is_nan() || norm(off) > FLATNESS * far {
            let what = format!("the mesh is not flat: node {i} lies {:.3e} off the plane of the others", norm(off));
            return Err(unsupported(what, "only meshes in a plane can be read"));
        }
        nodes.push(Point::new(dot(d, x), dot(d, y)));
    }
    Ok((nodes, Some(Frame { origin, x, y })))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}
