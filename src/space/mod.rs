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
use segments::Segments;
use tetrahedra::Tetrahedra;

/// A vertex' weight is at most this part of the squared distance to the nearest vertex in the finished mesh.
const WEIGHT_BOUND: f64 = 1e-6;

/// The same when weights are chosen: vertices that are inserted later may be three times nearer.
const WEIGHT: f64 = 1e-7;

/// How often weights are chosen at most, each time a quarter as large.
const ROUNDS: i32 = 8;

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
        let mut ask = |vertices: usize| match vertices > max_vertices.saturating_add(FAR) {
            true => Err(Fault::VertexBudget { max_vertices }),
            false if go_on() => Ok(()),
            false => Err(Fault::Cancelled),
        };
        let (mut kernel, segments) = weighted(solid, factor, &mut ask)?;
        let (vertex_of, chains) = segments.chains();
        let triangles = facets::recover(&mut kernel.net, solid, &vertex_of, &chains, || ask(0))?;
        if cfg!(feature = "slow-checks") {
            assert_eq!(kernel.net.flaws(), [""; 0]);
        }
        Self { solid, factor, kernel, vertex_of, chains, triangles }.mesh()
    }
}

/// The regular tetrahedralization of a solid's points and of those that make its segments chains of edges, with weights
/// within their bound.
///
/// Without weights first: that tells how near the vertices come. Then again with weights, which may lack some edges and
/// get some more vertices, until the weights are small enough for all.
fn weighted<'a>(
    solid: &'a Solid,
    factor: f64,
    ask: &mut dyn FnMut(usize) -> Result<(), Fault>,
) -> Result<(Kernel, Segments<'a>), Fault> {
    let points: Vec<[f64; 3]> = solid.points().iter().map(|p| p.map(|x| x * factor)).collect();
    let (mut kernel, vertex_of) = insert_all(&points, &vec![0.0; points.len()], ask)?;
    let mut segments = Segments::new(solid, vertex_of);
    segments.recover(&mut kernel, 0.0, ask)?;
    for round in 0..ROUNDS {
        let nearest = nearest_squared(&kernel.net);
        let is_small = |v: VertexId| kernel.net.weights[v] <= WEIGHT_BOUND * nearest[v.index()];
        if round > 0 && kernel.net.points.ids().skip(FAR).all(is_small) {
            break;
        }
        let scale = WEIGHT * libm::ldexp(1.0, -2 * round);
        let weights: Vec<f64> = nearest.iter().enumerate().skip(FAR).map(|(v, d2)| scale * d2 * share(v)).collect();
        let (again, vertex_of) = insert_all(&kernel.net.points.as_slice()[FAR..], &weights, ask)?;
        segments.renumber(|v| vertex_of[PointId::from_index(v.index() - FAR)]);
        kernel = again;
        segments.recover(&mut kernel, scale, ask)?;
    }
    Ok((kernel, segments))
}

/// The regular tetrahedralization of points within a far tetrahedron, and the vertex of each point.
fn insert_all(
    points: &[[f64; 3]],
    weights: &[f64],
    ask: &mut dyn FnMut(usize) -> Result<(), Fault>,
) -> Result<(Kernel, IdVec<PointId, VertexId>), Fault> {
    let along = order_space::hilbert(points);
    let order: Vec<u32> = order::rounds(points.len()).into_iter().map(|i| along[i as usize]).collect();
    let mut kernel = Kernel::new(far_tetrahedron(points));
    let mut vertex_of: IdVec<PointId, VertexId> = vec![VertexId(0); points.len()].into();
    for (k, &i) in order.iter().enumerate() {
        if k % 1024 == 0 {
            ask(k)?;
        }
        match kernel.insert(points[i as usize], weights[i as usize]) {
            Ok(v) => vertex_of[PointId(i)] = v,
            Err(Refusal::Taken(_) | Refusal::Hidden | Refusal::Outside) => {
                return Err(Fault::Twice { point: PointId(i) });
            }
        }
    }
    Ok((kernel, vertex_of))
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
fn nearest_squared(net: &Tetrahedra) -> Vec<f64> {
    let mut nearest = vec![f64::INFINITY; net.points.len()];
    for t in net.tets() {
        let corners = net.corners(t);
        for [i, j] in [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] {
            let (u, v) = (corners[i], corners[j]);
            let between = minus(net.points[u], net.points[v]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::{Assembly, FoundFacet, Surfaces};

    /// Schönhardt's polyhedron: a prism over a triangle, its top turned so far that the sides' inner diagonals nearly meet.
    fn schoenhardt(turn_deg: f64) -> Solid {
        let corner = |i: u32, turn: f64, z: f64| {
            let angle = (120.0 * f64::from(i) + turn).to_radians();
            [libm::cos(angle), libm::sin(angle), z]
        };
        let bottom = (0..3).map(|i| corner(i, 0.0, 0.0));
        let points = bottom.chain((0..3).map(|i| corner(i, turn_deg, 1.0))).collect();
        let sides = (0..3).flat_map(|i| {
            let j = (i + 1) % 3;
            [vec![i, j, 3 + i], vec![j, 3 + j, 3 + i]]
        });
        let facets = sides.chain([vec![0, 2, 1], vec![3, 4, 5]]);
        let facets = facets.map(|polygon| FoundFacet { polygons: vec![polygon], ..FoundFacet::default() }).collect();
        Surfaces { points, facets, ..Surfaces::default() }.assemble(&Assembly::default()).expect("a valid solid")
    }

    #[test]
    fn weights_are_small_beside_the_distances_in_the_finished_mesh() {
        for turn_deg in [10.0, 30.0, -30.0, -50.0, -59.0, -59.9] {
            let mesh = constrained(&schoenhardt(turn_deg), 1000, &mut || true).expect("a mesh");
            assert_eq!(mesh.nodes.len() > 6, turn_deg < 0.0, "{turn_deg}: {} nodes", mesh.nodes.len());
            for (v, &weight) in mesh.weights.enumerate() {
                let to_v = |u: VertexId| minus(mesh.nodes[u], mesh.nodes[v]);
                let distances = mesh.nodes.ids().filter(|&u| u != v).map(|u| dot(to_v(u), to_v(u)));
                let nearest = distances.fold(f64::INFINITY, f64::min);
                assert!((0.0..=WEIGHT_BOUND * nearest).contains(&weight), "{turn_deg}: {weight} of {nearest}");
            }
        }
    }
}
