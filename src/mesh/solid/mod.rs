//! The tetrahedral mesh: plain data, whoever made it.

pub mod quality;

use crate::ids::{FacetId, IdVec, NameId, Names, PointId, RegionId, SegmentId, TetId, VertexId};

/// A tetrahedral mesh, with names and links back to the solid where they are known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidMesh {
    /// The nodes.
    pub nodes: IdVec<VertexId, [f64; 3]>,
    /// The weight of each node: the certificate of the constrained regular triangulation. Empty where unknown.
    pub weights: IdVec<VertexId, f64>,
    /// Corners of each tetrahedron: `d` lies on the side of a b c from which they turn clockwise (a b c d positive as
    /// VTK has it: the normal of a b c by the right-hand rule points to d).
    pub tetrahedra: IdVec<TetId, [VertexId; 4]>,
    /// Region of each tetrahedron (index into `regions`).
    pub tetrahedron_regions: IdVec<TetId, RegionId>,
    /// Name of each region.
    pub regions: IdVec<RegionId, NameId>,
    /// Every mesh triangle that lies on a facet, grouped by facet.
    pub triangles: Vec<FacetTriangle>,
    /// Every mesh edge that lies on a segment, grouped by segment and in order along it.
    pub edges: Vec<SegmentEdge>,
    /// For each node that is a point of the solid: which (sorted by point).
    pub points: Vec<(PointId, VertexId)>,
    /// The texts of all names.
    pub names: Names,
    /// The physical unit of a coordinate, where known.
    pub unit: Option<String>,
}

/// A mesh triangle on a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetTriangle {
    /// The corners, counter-clockwise as seen from the front of the facet.
    pub nodes: [VertexId; 3],
    /// The name of the facet.
    pub name: NameId,
    /// The facet of the solid, where known.
    pub facet: Option<FacetId>,
}

/// A mesh edge on a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentEdge {
    /// The ends, in the direction of the segment where it is linked.
    pub nodes: [VertexId; 2],
    /// The name of the segment, where it has one.
    pub name: Option<NameId>,
    /// The segment of the solid, where known.
    pub segment: Option<SegmentId>,
}
