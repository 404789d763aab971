//! The named groups of a mesh, numbered for files.

use crate::ids::{Id, NameId, RegionId, TriangleId, VertexId};
use crate::mesh::{CurveEdge, Mesh};
use std::collections::BTreeMap;
use std::io;

/// The kind of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Region,
    Boundary,
}

impl Kind {
    /// The word that files use for it.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Region => "region",
            Self::Boundary => "boundary",
        }
    }
}

/// Regions and boundaries by name, each kind numbered from 0 in the order of first use. Regions with one name are one
/// group.
pub struct Groups<'m> {
    mesh: &'m Mesh,
    /// Names of regions.
    pub regions: Vec<&'m str>,
    /// Names of boundaries.
    pub boundaries: Vec<&'m str>,
    /// Names of nodes.
    pub points: Vec<&'m str>,
    region_of: Vec<usize>,
    boundary_of: BTreeMap<NameId, usize>,
    point_of: BTreeMap<NameId, usize>,
}

impl<'m> Groups<'m> {
    /// # Errors
    /// `InvalidInput` where the lists of the mesh do not fit together. Writers rely on this check.
    pub fn of(mesh: &'m Mesh) -> io::Result<Self> {
        check(mesh)?;
        let mut numbers = BTreeMap::new();
        let mut regions = Vec::new();
        let region_of = mesh.regions.iter().map(|&name| number(&mut numbers, &mut regions, mesh, name)).collect();
        let (mut boundary_of, mut boundaries) = (BTreeMap::new(), Vec::new());
        for edge in &mesh.edges {
            number(&mut boundary_of, &mut boundaries, mesh, edge.name);
        }
        let (mut point_of, mut points) = (BTreeMap::new(), Vec::new());
        for &(_, name) in &mesh.named_nodes {
            number(&mut point_of, &mut points, mesh, name);
        }
        Ok(Self { mesh, regions, boundaries, points, region_of, boundary_of, point_of })
    }

    /// The group of a region.
    pub fn region(&self, region: RegionId) -> usize {
        self.region_of[region.index()]
    }

    /// The group of an edge.
    pub fn boundary(&self, edge: &CurveEdge) -> usize {
        self.boundary_of[&edge.name]
    }

    /// The group of a named node.
    pub fn point(&self, name: NameId) -> usize {
        self.point_of[&name]
    }

    /// The triangles of every group of regions, in the mesh's order.
    pub fn triangles(&self) -> Vec<Vec<TriangleId>> {
        let mut triangles = vec![Vec::new(); self.regions.len()];
        for (t, &region) in self.mesh.triangle_regions.enumerate() {
            triangles[self.region(region)].push(t);
        }
        triangles
    }

    /// The edges of every boundary, as indices of [`Mesh::edges`], in the order of the mesh.
    pub fn edges(&self) -> Vec<Vec<usize>> {
        let mut edges = vec![Vec::new(); self.boundaries.len()];
        for (i, edge) in self.mesh.edges.iter().enumerate() {
            edges[self.boundary(edge)].push(i);
        }
        edges
    }
}

fn number<'m>(numbers: &mut BTreeMap<NameId, usize>, texts: &mut Vec<&'m str>, mesh: &'m Mesh, name: NameId) -> usize {
    *numbers.entry(name).or_insert_with(|| {
        texts.push(mesh.names.text(name));
        texts.len() - 1
    })
}

/// Checks that the lists of a mesh fit together: one region for each triangle, each id within its list, mid nodes for
/// all or for none.
pub fn check(mesh: &Mesh) -> io::Result<()> {
    let names = mesh.names.iter().count();
    let node = |v: &VertexId| v.index() < mesh.nodes.len();
    let mids = |n: usize, of: usize| n == if mesh.order() == 1 { 0 } else { of };
    let right = mesh.triangle_regions.len() == mesh.triangles.len()
        && mesh.triangle_regions.iter().all(|r| r.index() < mesh.regions.len())
        && mesh.regions.iter().all(|n| n.index() < names)
        && mesh.edges.iter().all(|e| e.name.index() < names && e.nodes.iter().all(node))
        && mesh.triangles.iter().chain(mesh.triangle_mids.iter()).flatten().all(node)
        && mids(mesh.triangle_mids.len(), mesh.triangles.len())
        && mids(mesh.edge_mids.len(), mesh.edges.len())
        && mesh.edge_mids.iter().all(node)
        && mesh.named_nodes.iter().all(|(v, name)| node(v) && name.index() < names);
    if right {
        return Ok(());
    }
    Err(io::Error::new(io::ErrorKind::InvalidInput, "the lists of the mesh do not fit together"))
}

/// A triangle as straight ones: itself, or for order 2 the four between its corners and mid nodes.
pub fn straight_triangles(mesh: &Mesh, t: TriangleId) -> impl Iterator<Item = [VertexId; 3]> {
    let [a, b, c] = mesh.triangles[t];
    let four = mesh.triangle_mids.get(t).map(|&[ab, bc, ca]| [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    let one = if four.is_none() { Some([a, b, c]) } else { None };
    one.into_iter().chain(four.into_iter().flatten())
}

/// An edge as straight ones: itself, or for order 2 its halves.
pub fn straight_edges(mesh: &Mesh, edge: usize) -> impl Iterator<Item = [VertexId; 2]> {
    let [a, b] = mesh.edges[edge].nodes;
    let halves = mesh.edge_mids.get(edge).map(|&m| [[a, m], [m, b]]);
    let one = if halves.is_none() { Some([a, b]) } else { None };
    one.into_iter().chain(halves.into_iter().flatten())
}

/// For each side of a triangle, keyed by its ends as [`undirected`] gives them: the triangles that have it, and the
/// number of the side in each (0 is between corners 0 and 1).
pub fn sides(mesh: &Mesh) -> BTreeMap<[VertexId; 2], Vec<(TriangleId, usize)>> {
    let mut sides: BTreeMap<[VertexId; 2], Vec<(TriangleId, usize)>> = BTreeMap::new();
    for (t, &corners) in mesh.triangles.enumerate() {
        for side in 0..3 {
            sides.entry(undirected([corners[side], corners[(side + 1) % 3]])).or_default().push((t, side));
        }
    }
    sides
}

/// For each edge of the mesh, whether triangles lie on both its sides. The lists must fit together ([`check`]).
pub fn interior(mesh: &Mesh) -> impl Iterator<Item = bool> {
    let sides = sides(mesh);
    mesh.edges.iter().map(move |edge| sides.get(&undirected(edge.nodes)).is_some_and(|there| there.len() > 1))
}

/// The mesh without the edges that have triangles on both sides.
pub fn without_interior(mesh: &Mesh) -> Mesh {
    let kept: Vec<usize> = interior(mesh).enumerate().filter(|(_, inside)| !inside).map(|(i, _)| i).collect();
    let edges = kept.iter().map(|&i| mesh.edges[i]).collect();
    let edge_mids = kept.iter().filter_map(|&i| mesh.edge_mids.get(i).copied()).collect();
    Mesh { edges, edge_mids, ..mesh.clone() }
}

/// The ends of an edge, smaller id first.
pub fn undirected([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}
