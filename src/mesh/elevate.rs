//! Order 2: a node within every edge, on the true curve where the edge lies on one, and every cell valid.
//!
//! A cell is valid where its Jacobian determinant is positive throughout ([`quality::is_valid`] proves it by Bézier
//! bounds). The node of a curved side lies where the curve crosses the bisector of its chord, which keeps the map even.
//! If a cell is not valid with it, other places on the curve are tried. If none makes it valid, as in the cell between
//! two tangent curves, a side is straightened and listed. A straightened side stays straight, and a cell with straight
//! sides is valid: so the search ends.
//!
//! ```text
//!             b       The curved side a b has its chord ┆ and its node m on the curve:
//!           ╱ ┆`.     1. where the curve crosses the bisector of the chord,
//!         m₂  ┆  m    2. else at the parameter share 0.5, 0.45, 0.55, …,
//!       ╱     ┆  :    3. else at the midpoint of the chord: the side is straightened.
//!     c ──m₁──a.´
//! ```

use super::{Mesh, quality};
use crate::curve::Curve;
use crate::domain::Domain;
use crate::geometry::Point;
use crate::ids::{Id, IdVec, TriangleId, VertexId};

/// The places tried after the bisector, as shares of the parameter range from one end to the other: the middle first.
const PLACES: [f64; 7] = [0.5, 0.45, 0.55, 0.4, 0.6, 0.33, 0.67];

/// An edge of the mesh, with the node within it.
struct Edge {
    ends: [VertexId; 2],
    mid: VertexId,
    /// The cells beside it.
    cells: [Option<TriangleId>; 2],
    /// The place in `Mesh::edges`, for an edge on a curve that is not straight.
    curved: Option<usize>,
}

/// Elevates a mesh from order 1 to order 2. Returns the curved edges (places in `Mesh::edges`) that had to be
/// straightened, ascending.
///
/// The edges of the mesh must be linked to the curves of `domain`, and its cells run counter-clockwise.
pub fn elevate(mesh: &mut Mesh, domain: &Domain) -> Vec<usize> {
    let edges = edges(mesh, domain);
    let mut sides: IdVec<TriangleId, [u32; 3]> = vec![[0; 3]; mesh.triangles.len()].into();
    mesh.triangle_mids = vec![[VertexId(0); 3]; mesh.triangles.len()].into();
    mesh.edge_mids = vec![VertexId(0); mesh.edges.len()];
    for (e, edge) in edges.iter().enumerate() {
        let [a, b] = edge.ends.map(|v| mesh.nodes[v]);
        mesh.nodes.push(a.midpoint(b));
        for &t in edge.cells.iter().flatten() {
            let side = side_of(mesh.triangles[t], edge.ends);
            sides[t][side] = e as u32;
            mesh.triangle_mids[t][side] = edge.mid;
        }
    }
    for (i, edge) in listed(mesh, &edges) {
        mesh.edge_mids[i] = edges[edge].mid;
    }
    let mut elevation = Elevation { mesh, domain, edges, sides };
    elevation.bend();
    elevation.straighten_where_needed()
}

/// The side of a triangle that has these ends: side `i` runs from corner `i` to the next.
fn side_of(corners: [VertexId; 3], ends: [VertexId; 2]) -> usize {
    (0..3).find(|&i| ends.contains(&corners[i]) && ends.contains(&corners[(i + 1) % 3])).unwrap_or(0)
}

fn ascending([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

/// Every edge once, ascending by its ends; nodes within edges are numbered in that order, after the corners.
fn edges(mesh: &Mesh, domain: &Domain) -> Vec<Edge> {
    let mut sides: Vec<([VertexId; 2], TriangleId)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (t, corners) in mesh.triangles.enumerate() {
        sides.extend((0..3).map(|i| (ascending([corners[i], corners[(i + 1) % 3]]), t)));
    }
    sides.sort_unstable();
    let corners = mesh.nodes.len();
    let beside = |run: &[([VertexId; 2], TriangleId)]| [Some(run[0].1), run.get(1).map(|r| r.1)];
    let runs = sides.chunk_by(|a, b| a.0 == b.0).enumerate();
    let mut edges: Vec<Edge> = runs
        .map(|(k, run)| {
            let mid = VertexId::from_index(corners + k);
            Edge { ends: run[0].0, mid, cells: beside(run), curved: None }
        })
        .collect();
    for (i, edge) in listed(mesh, &edges) {
        let curve = mesh.edges[i].link.map(|link| &domain.curves()[link.curve].curve);
        edges[edge].curved = curve.filter(|c| !c.is_straight()).map(|_| i);
    }
    edges
}

/// The edges listed in the mesh, by place in `Mesh::edges`, with their places among all edges.
fn listed(mesh: &Mesh, edges: &[Edge]) -> Vec<(usize, usize)> {
    let place = |ends| edges.binary_search_by_key(&ascending(ends), |e: &Edge| e.ends).ok();
    mesh.edges.iter().enumerate().filter_map(|(i, e)| Some((i, place(e.nodes)?))).collect()
}

struct Elevation<'a> {
    mesh: &'a mut Mesh,
    domain: &'a Domain,
    edges: Vec<Edge>,
    /// The edges of each cell, by place.
    sides: IdVec<TriangleId, [u32; 3]>,
}

impl Elevation<'_> {
    /// The curve of a curved edge and the parameters of its ends; `None` where the edge is not curved.
    fn stretch(&self, edge: usize) -> Option<(&Curve, [f64; 2])> {
        let link = self.mesh.edges[self.edges[edge].curved?].link?;
        Some((&self.domain.curves()[link.curve].curve, link.t))
    }

    /// Moves the node of every curved edge to the crossing of its curve with the bisector of its chord.
    fn bend(&mut self) {
        for edge in 0..self.edges.len() {
            if let Some((curve, [t0, t1])) = self.stretch(edge) {
                let at = curve.point(curve.bisector_crossing(t0, t1));
                self.put(edge, at);
            }
        }
    }

    fn put(&mut self, edge: usize, at: Point) {
        self.mesh.nodes[self.edges[edge].mid] = at;
    }

    fn is_valid(&self, t: TriangleId) -> bool {
        quality::is_valid(self.mesh, t)
    }

    fn straighten_where_needed(&mut self) -> Vec<usize> {
        let mut straightened = Vec::new();
        let curved = |e: &&Edge| e.curved.is_some();
        let mut candidates: Vec<TriangleId> =
            self.edges.iter().filter(curved).flat_map(|e| e.cells).flatten().filter(|&t| !self.is_valid(t)).collect();
        candidates.sort_unstable_by(|a, b| b.cmp(a));
        candidates.dedup();
        while let Some(t) = candidates.pop() {
            if self.is_valid(t) || self.move_a_node(t) {
                continue;
            }
            let Some(edge) = self.edge_to_straighten(t) else { continue };
            let [a, b] = self.edges[edge].ends.map(|v| self.mesh.nodes[v]);
            self.put(edge, a.midpoint(b));
            straightened.extend(self.edges[edge].curved.take());
            candidates.extend(self.edges[edge].cells.iter().flatten());
        }
        straightened.sort_unstable();
        straightened
    }

    fn curved_sides(&self, t: TriangleId) -> impl Iterator<Item = usize> {
        self.sides[t].into_iter().map(|e| e as usize).filter(|&e| self.edges[e].curved.is_some())
    }

    /// Moves the node of one curved side along its curve until the cells on both sides are valid. `false`, and nothing
    /// moved, where there is no such place.
    fn move_a_node(&mut self, t: TriangleId) -> bool {
        let sides: Vec<usize> = self.curved_sides(t).collect();
        for edge in sides {
            let before = self.mesh.nodes[self.edges[edge].mid];
            let Some((curve, [t0, t1])) = self.stretch(edge) else { continue };
            let places = PLACES.map(|share| curve.point(t0 + share * (t1 - t0)));
            for at in places {
                self.put(edge, at);
                if self.edges[edge].cells.iter().flatten().all(|&t| self.is_valid(t)) {
                    return true;
                }
            }
            self.put(edge, before);
        }
        false
    }

    /// The curved side of a cell to straighten: the flattest one that makes the cell valid once it is straight; where
    /// none does, the most bent one.
    fn edge_to_straighten(&mut self, t: TriangleId) -> Option<usize> {
        let mut sides: Vec<(f64, usize)> = self.curved_sides(t).map(|e| (self.sagitta(e), e)).collect();
        sides.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &(_, edge) in &sides {
            let before = self.mesh.nodes[self.edges[edge].mid];
            let [a, b] = self.edges[edge].ends.map(|v| self.mesh.nodes[v]);
            self.put(edge, a.midpoint(b));
            let mended = self.is_valid(t);
            self.put(edge, before);
            if mended {
                return Some(edge);
            }
        }
        sides.last().map(|&(_, edge)| edge)
    }

    fn sagitta(&self, edge: usize) -> f64 {
        let Edge { ends: [a, b], mid, .. } = self.edges[edge];
        self.mesh.nodes[mid].distance(self.mesh.nodes[a].midpoint(self.mesh.nodes[b]))
    }
}
