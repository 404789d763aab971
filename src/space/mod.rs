//! The kernel in space: a solid becomes a constrained regular tetrahedralization (Shewchuk & Si 2014, section 3).
//!
//! ```text
//!   points ─▶ weighted Delaunay ─▶ segments: chains of edges ─▶ facets: triangles ─▶ regions ─▶ SolidMesh
//!             `insert`             `segments`                   `facets`             `regions`   `extraction`
//! ```
//!
//! Coordinates are those of the solid times a power of two. Every sign is exact, and of one geometry: the rounded
//! coordinates. What lies on which segment and facet is known from the complex. Tiny weights break the ties that rounding
//! hides, so that no tetrahedron has its four vertices on one facet (`theory.md`).

mod extraction;
mod facets;
mod insert;
mod regions;
mod segments;
mod tetrahedra;

use crate::geometry::exact_space::{PlaneSide, orient};
use crate::geometry::rng::Rng;
use crate::geometry::space::{dot, minus};
use crate::geometry::{order, order_space, unit_scale};
use crate::ids::{FacetId, Id, IdVec, PointId, SegmentId, VertexId};
use crate::mesh::solid::SolidMesh;
use crate::solid::Solid;
use facets::FacetTriangles;
use insert::{Kernel, Refusal};

/// A vertex' weight is at most this part of the squared distance to the nearest vertex, when it is inserted. Vertices that
/// are inserted later may be seven times nearer before the bound of 1e-6 on the finished mesh is reached.
const WEIGHT: f64 = 1e-7;

/// The vertices of the far tetrahedron.
const FAR: usize = 4;

/// Why a solid has no constrained Delaunay mesh here.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// Two points are equal.
    Twice {
        /// The second of them.
        point: PointId,
    },
    /// A segment would have to be split at a place that coordinates cannot tell from a vertex that is there.
    TooNear {
        /// The segment.
        segment: SegmentId,
        /// The place.
        at: [f64; 3],
    },
    /// A facet does not become a union of triangles: the complex is not valid there, or nearer to degenerate than the
    /// arithmetic can tell.
    Stuck {
        /// The facet.
        facet: FacetId,
        /// One of its points.
        at: [f64; 3],
    },
    /// A hole point or a region point lies in no tetrahedron of the inside.
    Outside {
        /// The point.
        at: [f64; 3],
    },
    /// No bounded cell is material.
    Empty,
    /// More vertices would be needed than allowed.
    VertexBudget {
        /// The number of vertices allowed.
        max_vertices: usize,
    },
    /// The caller asked to stop.
    Cancelled,
}

/// The constrained regular tetrahedralization of a solid, as a mesh of what is material. `go_on` is asked between steps.
///
/// # Errors
///
/// What stands in the way, with its place in the coordinates of the solid.
pub fn constrained(solid: &Solid, max_vertices: usize, go_on: &mut dyn FnMut() -> bool) -> Result<SolidMesh, Fault> {
    let factor = unit_scale(solid.points().iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs())));
    Complex::build(solid, factor, max_vertices, go_on).map_err(|fault| fault.scaled(1.0 / factor))
}

impl Fault {
    fn scaled(self, factor: f64) -> Self {
        let scaled = |at: [f64; 3]| at.map(|x| x * factor);
        match self {
            Self::TooNear { segment, at } => Self::TooNear { segment, at: scaled(at) },
            Self::Stuck { facet, at } => Self::Stuck { facet, at: scaled(at) },
            Self::Outside { at } => Self::Outside { at: scaled(at) },
            Self::Twice { .. } | Self::Empty | Self::VertexBudget { .. } | Self::Cancelled => self,
        }
    }
}

/// A tetrahedralization that has all segments and facets of a solid.
struct Complex<'a> {
    solid: &'a Solid,
    /// The power of two that the solid's coordinates are multiplied by.
    factor: f64,
    kernel: Kernel,
    vertex_of: IdVec<PointId, VertexId>,
    chains: IdVec<SegmentId, Vec<VertexId>>,
    triangles: FacetTriangles,
}

impl<'a> Complex<'a> {
    fn build(
        solid: &'a Solid,
        factor: f64,
        max_vertices: usize,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<SolidMesh, Fault> {
        let mut ask = || if go_on() { Ok(()) } else { Err(Fault::Cancelled) };
        let (mut kernel, vertex_of) = delaunay(solid, factor, &mut ask)?;
        let segments = segments::Segments::new(solid, &vertex_of);
        let chains = segments.recover(&mut kernel, |vertices| match vertices >= max_vertices.saturating_add(FAR) {
            true => Err(Fault::VertexBudget { max_vertices }),
            false => ask(),
        })?;
        let triangles = facets::recover(&mut kernel.net, solid, &vertex_of, &chains, &mut ask)?;
        Self { solid, factor, kernel, vertex_of, chains, triangles }.mesh()
    }
}

/// The weighted Delaunay tetrahedralization of the points of a solid, within a far tetrahedron, and the vertex of each
/// point.
fn delaunay(
    solid: &Solid,
    factor: f64,
    ask: &mut dyn FnMut() -> Result<(), Fault>,
) -> Result<(Kernel, IdVec<PointId, VertexId>), Fault> {
    let points: Vec<[f64; 3]> = solid.points().iter().map(|p| p.map(|x| x * factor)).collect();
    let along = order_space::hilbert(&points);
    let order: Vec<u32> = order::rounds(points.len()).into_iter().map(|i| along[i as usize]).collect();
    let mut weights = vec![0.0; points.len()];
    // First without weights, for the distances to the nearest vertices.
    let plain = insert_all(&points, &order, &weights, ask)?;
    for (v, d2) in nearest_squared(&plain).into_iter().enumerate().skip(FAR) {
        weights[order[v - FAR] as usize] = WEIGHT * d2 * share(v);
    }
    let kernel = if solid.facets().is_empty() { plain } else { insert_all(&points, &order, &weights, ask)? };
    let mut vertex_of: IdVec<PointId, VertexId> = vec![VertexId(0); points.len()].into();
    order.iter().enumerate().for_each(|(i, &p)| vertex_of[PointId(p)] = VertexId::from_index(i + FAR));
    Ok((kernel, vertex_of))
}

fn insert_all(
    points: &[[f64; 3]],
    order: &[u32],
    weights: &[f64],
    ask: &mut dyn FnMut() -> Result<(), Fault>,
) -> Result<Kernel, Fault> {
    let mut kernel = Kernel::new(far_tetrahedron(points));
    for (k, &i) in order.iter().enumerate() {
        if k % 1024 == 0 {
            ask()?;
        }
        match kernel.insert(points[i as usize], weights[i as usize]) {
            Ok(_) => (),
            Err(Refusal::Taken(_) | Refusal::Hidden | Refusal::Outside) => {
                return Err(Fault::Twice { point: PointId(i) });
            }
        }
    }
    Ok(kernel)
}

/// A positive tetrahedron around all points, its sphere of contact ten times as wide as theirs.
fn far_tetrahedron(points: &[[f64; 3]]) -> [[f64; 3]; 4] {
    let least = |k: usize| points.iter().fold(f64::INFINITY, |m, p| m.min(p[k]));
    let largest = |k: usize| points.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p[k]));
    let (low, high) = ([0, 1, 2].map(least), [0, 1, 2].map(largest));
    let middle = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
    let width = [0, 1, 2].map(|k| high[k] - low[k]).into_iter().fold(0.0, f64::max);
    // Corners of a cube, every other one: a plane through three passes the middle at 1/√3 of the half side.
    let half = 32.0 * width;
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let mut far = corners.map(|c: [f64; 3]| [0, 1, 2].map(|k| middle[k] + half * c[k]));
    if orient(far[0], far[1], far[2], far[3]) == PlaneSide::Below {
        far.swap(0, 1);
    }
    far
}

/// By vertex: the squared distance to the nearest other. In a Delaunay tetrahedralization they share an edge.
fn nearest_squared(kernel: &Kernel) -> Vec<f64> {
    let mut nearest = vec![f64::INFINITY; kernel.net.points.len()];
    for t in kernel.net.tets() {
        let corners = kernel.net.corners(t);
        for [i, j] in [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] {
            let (u, v) = (corners[i], corners[j]);
            let between = minus(kernel.net.points[u], kernel.net.points[v]);
            let d2 = dot(between, between);
            nearest[u.index()] = nearest[u.index()].min(d2);
            nearest[v.index()] = nearest[v.index()].min(d2);
        }
    }
    nearest
}

/// A number in 0..1 that depends on a vertex' id alone.
fn share(vertex: usize) -> f64 {
    Rng::new(vertex as u64).between(0.0, 1.0)
}
