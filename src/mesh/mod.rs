//! The mesh as plain data, from either engine or a file: nodes, cells, regions, boundaries, links to curves, and the
//! balls that exempt cells.

pub mod elevate;
pub mod quality;
pub mod solid;

use crate::geometry::{Frame, Point};
use crate::ids::{Colour, CurveId, IdVec, NameId, Names, PointId, RegionId, TriangleId, VertexId};

/// A triangle mesh in the plane, with names and links back to the domain where they are known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners first; then, in a mesh of order 2, the nodes within edges.
    pub nodes: IdVec<VertexId, Point>,
    /// Corners of each triangle, counter-clockwise.
    pub triangles: IdVec<TriangleId, [VertexId; 3]>,
    /// Region of each triangle (index into `regions`).
    pub triangle_regions: IdVec<TriangleId, RegionId>,
    /// Name of each region.
    pub regions: IdVec<RegionId, NameId>,
    /// Every mesh edge that lies on a curve, along the curve's direction, grouped by curve and in order along it where
    /// links are known.
    pub edges: Vec<CurveEdge>,
    /// The texts of all names that regions, edges, colours and nodes refer to.
    pub names: Names,
    /// The colours of regions, by name, where the drawing has some.
    pub colours: std::collections::BTreeMap<NameId, Colour>,
    /// The points of P that are nodes, each with its node; sorted by point.
    pub points: Vec<(PointId, VertexId)>,
    /// Nodes that have a name of their own, by node.
    pub named_nodes: Vec<(VertexId, NameId)>,
    /// Protecting balls that were set around acute corners.
    pub balls: Vec<Ball>,
    /// Order 2: the node within each side of each triangle, between its corners 0 and 1, 1 and 2, 2 and 0. Order 1:
    /// empty.
    pub triangle_mids: IdVec<TriangleId, [VertexId; 3]>,
    /// Order 2: the node within each of `edges`. Order 1: empty.
    pub edge_mids: Vec<VertexId>,
    /// The physical unit of a coordinate, where known.
    pub unit: Option<String>,
    /// Where the plane of the mesh lies in space; `None`: x and y as they are, z = 0.
    pub frame: Option<Frame>,
}

/// A mesh edge on a curve of the domain, or on a named boundary of a foreign mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveEdge {
    /// The end nodes, in the direction of the curve where it is linked.
    pub nodes: [VertexId; 2],
    /// The name of the boundary.
    pub name: NameId,
    /// Curve and parameters of the two nodes, where known: always in a mesh of ours, never in a foreign one.
    pub link: Option<CurveLink>,
}

/// The part of a curve of the domain that a mesh edge approximates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveLink {
    /// The curve in the domain.
    pub curve: CurveId,
    /// The curve parameters of the edge's two nodes, in their order and within 0..1; the engines write them ascending.
    pub t: [f64; 2],
}

/// A ball B(p) around an acute corner (Pav & Walkington 2005, section 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The point of P that is the centre of the ball.
    pub corner: PointId,
    /// The radius d(p), in units of the mesh.
    pub radius: f64,
    /// What set the radius.
    pub why: BallReason,
}

/// How far a vertex on the border of a ball may lie from it by rounding, in units of the largest coordinate: it is a
/// point of a curve, evaluated at a parameter that was itself found by iteration. 64 units in the last place.
pub const RIM_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What set a ball's radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BallReason {
    /// (√2−1)·lfs₀, untouched.
    LocalFeatureSize,
    /// Shrunk by β because a vertex lay in the ball.
    Encroached,
    /// Capped from the start so that its spokes and fans meet the size limits. Exempt from the lfs check.
    Size,
}

/// The insertion of a vertex, as constrained refinement records it for the check of densities (Foteinos, Chernikov &
/// Chrisochoides 2010, section 2).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Insertion {
    /// The type of the insertion.
    pub kind: InsertionKind,
    /// The place of the vertex.
    pub at: Point,
    /// R(p): the distance to the nearest visible vertex right after the insertion (Definition 2.4).
    pub radius: f64,
    /// p̂, the parent (Definition 2.5); `None` where the vertex was inserted for a size limit.
    pub parent: Option<Point>,
}

/// The type of an inserted vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum InsertionKind {
    /// Inside a triangle.
    A,
    /// On a segment.
    B,
    /// On a segment in whose diametral circle there is a visible vertex of the input or of another segment.
    C,
}

impl Mesh {
    /// Polynomial order of the cells: 1 or 2.
    pub fn order(&self) -> u8 {
        if self.triangle_mids.is_empty() { 1 } else { 2 }
    }

    /// Every node in space.
    pub fn places(&self) -> impl ExactSizeIterator<Item = [f64; 3]> {
        self.nodes.iter().map(|&p| self.frame.map_or([p.x, p.y, 0.0], |frame| frame.place(p)))
    }

    /// The corners of a triangle.
    pub fn corners(&self, t: TriangleId) -> [Point; 3] {
        self.triangles[t].map(|v| self.nodes[v])
    }

    /// The triangles of the region of this name; none where there is no such region.
    pub fn triangles_of(&self, region: &str) -> impl Iterator<Item = TriangleId> {
        let name = self.names.find(region);
        let is_of = move |t: &TriangleId| name == Some(self.regions[self.triangle_regions[*t]]);
        self.triangles.ids().filter(is_of)
    }

    /// The edges on the boundary of this name; none where there is no such boundary.
    pub fn edges_of(&self, boundary: &str) -> impl Iterator<Item = &CurveEdge> {
        let name = self.names.find(boundary);
        self.edges.iter().filter(move |edge| name == Some(edge.name))
    }

    /// The mesh without its ties to a domain: links, points and balls.
    pub fn untied(mut self) -> Self {
        self.edges.iter_mut().for_each(|edge| edge.link = None);
        self.points.clear();
        self.balls.clear();
        self
    }

    /// The mesh with all coordinates and radii multiplied by `factor`, a power of two: exact.
    pub fn scaled(mut self, factor: f64) -> Self {
        for p in self.nodes.iter_mut() {
            *p = crate::geometry::scaled(*p, factor);
        }
        for ball in &mut self.balls {
            ball.radius *= factor;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::Id;

    /// Two triangles side by side: `plate` and `rib`, which share a side named `seam`.
    ///
    /// ```text
    ///   3 ─────── 2
    ///   │ rib   ╱ │     `rim` is around both; no edge is of the name of a region, nor the other way around.
    ///   │  seam   │
    ///   │ ╱ plate │
    ///   0 ─────── 1
    /// ```
    fn two_triangles() -> Mesh {
        let mut mesh = Mesh::default();
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            mesh.nodes.push(Point::new(x, y));
        }
        let [plate, rib, rim, seam] = ["plate", "rib", "rim", "seam"].map(|name| mesh.names.intern(name));
        for (name, corners) in [(plate, [0, 1, 2]), (rib, [0, 2, 3])] {
            let region = mesh.regions.push(name);
            mesh.triangles.push(corners.map(VertexId));
            mesh.triangle_regions.push(region);
        }
        for (name, nodes) in [(rim, [0, 1]), (rim, [1, 2]), (rim, [2, 3]), (rim, [3, 0]), (seam, [0, 2])] {
            mesh.edges.push(CurveEdge { nodes: nodes.map(VertexId), name, link: None });
        }
        mesh
    }

    #[test]
    fn triangles_are_found_by_the_name_of_their_region() {
        let mut mesh = two_triangles();
        let of = |mesh: &Mesh, name: &str| mesh.triangles_of(name).map(Id::index).collect::<Vec<_>>();
        assert_eq!((of(&mesh, "plate"), of(&mesh, "rib")), (vec![0], vec![1]));
        for absent in ["", "Plate", "seam", "nowhere"] {
            assert!(of(&mesh, absent).is_empty(), "{absent:?} is no region");
        }
        // By name, regions of one name are one.
        let again = mesh.regions.push(mesh.regions[RegionId(0)]);
        mesh.triangle_regions[TriangleId(1)] = again;
        assert_eq!((of(&mesh, "plate"), of(&mesh, "rib")), (vec![0, 1], vec![]));
        assert!(of(&Mesh::default(), "plate").is_empty());
    }

    #[test]
    fn edges_are_found_by_the_name_of_their_boundary() {
        let mesh = two_triangles();
        let of = |name: &str| mesh.edges_of(name).map(|edge| edge.nodes.map(Id::index)).collect::<Vec<_>>();
        assert_eq!(of("rim"), [[0, 1], [1, 2], [2, 3], [3, 0]], "in their order");
        assert_eq!(of("seam"), [[0, 2]]);
        for absent in ["", "Rim", "plate", "nowhere"] {
            assert!(of(absent).is_empty(), "{absent:?} is no boundary");
        }
    }
}
