//! What the verifier of solids finds out for itself before it checks anything.

use super::grouped::Grouped;
use crate::geometry::space::{length, minus, plus, times};
use crate::geometry::unit_scale;
use crate::ids::{FacetId, Id, IdVec, NameId, PointId, TetId, VertexId};
use crate::mesh::solid::SolidMesh;
use crate::solid::Solid;
use robust::Coord3D;
use std::cmp::Ordering;

/// How far a node may lie from its facet's plane or its segment's line by rounding, in units of the largest coordinate:
/// a Steiner point is computed from points of the input in a few steps and then rounded. 64 units in the last place.
const NODE_ROUNDING: f64 = 64.0 * f64::EPSILON;

pub struct Evidence<'a> {
    pub solid: Option<&'a Solid>,
    pub mesh: &'a SolidMesh,
    /// The nodes times a power of two, for exact signs.
    pub signs: IdVec<VertexId, [f64; 3]>,
    /// The square of that power.
    pub weight_scale: f64,
    /// How each tetrahedron turns: `Greater` where it is positive, exactly.
    pub turns: IdVec<TetId, Ordering>,
    /// The distance that [`NODE_ROUNDING`] allows.
    pub reach: f64,
    /// The node of each point of the solid.
    pub node_of: IdVec<PointId, Option<VertexId>>,
    /// Places in `mesh.triangles`, by facet.
    pub triangles_of: Grouped,
    /// Places in `mesh.edges`, by segment.
    pub edges_of: Grouped,
    /// Whether no triangle and no edge says what it lies on, as in a mesh of others.
    pub foreign: bool,
}

impl<'a> Evidence<'a> {
    /// Looks at a mesh without `unreadable` flaws.
    pub fn gather(solid: Option<&'a Solid>, mesh: &'a SolidMesh) -> Self {
        let points = || solid.into_iter().flat_map(|s| s.points().iter()).chain(mesh.nodes.iter());
        let magnitude = points().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        let scale = unit_scale(magnitude);
        let signs: IdVec<VertexId, _> = mesh.nodes.iter().map(|&p| times(p, scale)).collect();
        let turns = mesh.tetrahedra.iter().map(|t| turn(t.map(|v| signs[v]))).collect();
        let mut node_of: IdVec<PointId, _> = vec![None; solid.map_or(0, |s| s.points().len())].into();
        if solid.is_some() {
            mesh.points.iter().for_each(|&(p, v)| node_of[p] = Some(v));
        }
        let (facets, segments) = solid.map_or((0, 0), |s| (s.facets().len(), s.segments().len()));
        Self {
            solid,
            mesh,
            signs,
            weight_scale: scale * scale,
            turns,
            reach: NODE_ROUNDING * magnitude,
            node_of,
            triangles_of: Grouped::by(facets, mesh.triangles.iter().map(|t| t.facet.map(Id::index))),
            edges_of: Grouped::by(segments, mesh.edges.iter().map(|e| e.segment.map(Id::index))),
            foreign: mesh.points.is_empty()
                && mesh.triangles.iter().all(|t| t.facet.is_none())
                && mesh.edges.iter().all(|e| e.segment.is_none()),
        }
    }

    #[inline]
    pub fn node(&self, v: VertexId) -> [f64; 3] {
        self.mesh.nodes[v]
    }

    pub fn corners(&self, t: TetId) -> [[f64; 3]; 4] {
        self.mesh.tetrahedra[t].map(|v| self.node(v))
    }

    pub fn triangle(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.mesh.triangles[triangle as usize].nodes.map(|v| self.node(v))
    }

    pub fn region_name(&self, t: TetId) -> NameId {
        self.mesh.regions[self.mesh.tetrahedron_regions[t]]
    }

    /// "tetrahedron 7 (0 1 2 3) at (x, y, z)".
    pub fn tell(&self, t: TetId) -> String {
        format!("tetrahedron {} ({}) at {}", t.0, ids(&self.mesh.tetrahedra[t]), place(middle(&self.corners(t))))
    }

    /// "triangle (0 1 2) at (x, y, z)".
    pub fn tell_triangle(&self, nodes: [VertexId; 3]) -> String {
        format!("triangle ({}) at {}", ids(&nodes), place(middle(&nodes.map(|v| self.node(v)))))
    }

    /// "edge 3–4 at (x, y, z)".
    pub fn tell_edge(&self, nodes: [VertexId; 2]) -> String {
        format!("edge {}–{} at {}", nodes[0].0, nodes[1].0, place(middle(&nodes.map(|v| self.node(v)))))
    }

    /// "facet 3 (entity)".
    pub fn tell_facet(&self, f: FacetId) -> String {
        match self.solid.map(|s| s.facets()[f].entity.as_str()).filter(|entity| !entity.is_empty()) {
            Some(entity) => format!("facet {} ({entity})", f.0),
            None => format!("facet {}", f.0),
        }
    }
}

fn ids(nodes: &[VertexId]) -> String {
    nodes.iter().map(|v| v.0.to_string()).collect::<Vec<_>>().join(" ")
}

/// A place for people.
pub fn place([x, y, z]: [f64; 3]) -> String {
    format!("({x}, {y}, {z})")
}

/// The mean of some points.
pub fn middle(points: &[[f64; 3]]) -> [f64; 3] {
    let share = 1.0 / points.len().max(1) as f64;
    points.iter().fold([0.0; 3], |sum, &p| plus(sum, times(p, share)))
}

/// How a tetrahedron of scaled points turns: `Greater` where the right-hand normal of `a b c` points to `d`.
pub fn turn([a, b, c, d]: [[f64; 3]; 4]) -> Ordering {
    let coord = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
    // `robust` counts the other orientation as positive. Of finite points the determinant is a number.
    robust::orient3d(coord(b), coord(a), coord(c), coord(d)).partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    length(minus(a, b))
}

/// Flaws that keep the other checks from being made: ids that lead nowhere, lists that do not fit together, numbers that
/// are none.
pub fn unreadable(solid: Option<&Solid>, mesh: &SolidMesh) -> Vec<String> {
    let mut flaws = Vec::new();
    let (cells, nodes) = (mesh.tetrahedra.len(), mesh.nodes.len());
    // Sides of tetrahedra and facet triangles are numbered together in 32 bits.
    if cells.saturating_mul(4).saturating_add(mesh.triangles.len()) >= u32::MAX as usize {
        flaws.push(format!("{cells} tetrahedra are more than the verifier can number"));
    }
    for (what, found, right) in [
        ("regions of tetrahedra", mesh.tetrahedron_regions.len(), cells),
        ("weights", mesh.weights.len(), if mesh.weights.is_empty() { 0 } else { nodes }),
    ] {
        if found != right {
            flaws.push(format!("there are {found} {what} instead of {right}"));
        }
    }
    let names = mesh.names.iter().count();
    let (points, segments, facets) = solid
        .map_or((usize::MAX, usize::MAX, usize::MAX), |s| (s.points().len(), s.segments().len(), s.facets().len()));
    let is_node = |v: &VertexId| v.index() < nodes;
    let mut tell = |bad: bool, what: &str, i: usize| {
        if bad {
            flaws.push(format!("{what} {i} has an id that leads nowhere, or a number that is none"));
        }
    };
    for (i, p) in mesh.nodes.iter().enumerate() {
        tell(!p.iter().all(|x| x.is_finite()), "node", i);
    }
    for (i, w) in mesh.weights.iter().enumerate() {
        tell(!w.is_finite(), "weight", i);
    }
    for (i, t) in mesh.tetrahedra.iter().enumerate() {
        tell(!t.iter().all(is_node), "tetrahedron", i);
    }
    for (i, r) in mesh.tetrahedron_regions.iter().enumerate() {
        tell(r.index() >= mesh.regions.len(), "the region of tetrahedron", i);
    }
    for (i, name) in mesh.regions.iter().enumerate() {
        tell(name.index() >= names, "region", i);
    }
    for (i, t) in mesh.triangles.iter().enumerate() {
        let right = t.nodes.iter().all(is_node) && t.name.index() < names && t.facet.is_none_or(|f| f.index() < facets);
        tell(!right, "triangle", i);
    }
    for (i, e) in mesh.edges.iter().enumerate() {
        let named = e.name.is_none_or(|name| name.index() < names);
        let right = e.nodes.iter().all(is_node) && named && e.segment.is_none_or(|s| s.index() < segments);
        tell(!right, "edge", i);
    }
    for (i, (p, v)) in mesh.points.iter().enumerate() {
        tell(p.index() >= points || !is_node(v), "the link to a point", i);
    }
    flaws
}
