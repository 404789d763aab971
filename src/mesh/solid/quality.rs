//! Radii, dihedral angles and volumes of a tetrahedral mesh.

use super::SolidMesh;
use crate::geometry::space::{cross, dot, length, minus, plus, times};
use crate::ids::{Id, NameId, TetId};
use crate::mesh::quality::{BoundaryMeasure, RegionMeasure};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

/// Measures of a tetrahedral mesh; angles in degrees, the rest in the solid's units. Without tetrahedra the smallest
/// angle is 180 and the largest 0.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SolidQuality {
    /// The largest ratio of a tetrahedron's circumradius to its shortest edge; not finite for a flat tetrahedron.
    pub max_radius_edge: f64,
    /// The smallest dihedral angle, in degrees.
    pub min_dihedral_deg: f64,
    /// The largest dihedral angle, in degrees.
    pub max_dihedral_deg: f64,
    /// How many dihedral angles (six a tetrahedron) lie in each whole degree.
    #[serde(serialize_with = "as_sequence")]
    #[schemars(with = "Vec<u64>")]
    pub dihedral_histogram: [u64; 180],
    /// Volume of the tetrahedra.
    pub measure: f64,
    /// Volume that the surfaces of the solid enclose, where their orientation tells it.
    pub exact_measure: Option<f64>,
}

/// Mesh triangles and their area on the facets of one name.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FacetMeasure {
    /// The name of the facets.
    pub name: String,
    /// The number of mesh triangles on them.
    pub cells: usize,
    /// The area of these triangles, in square units of the solid.
    pub area: f64,
}

fn as_sequence<S: Serializer>(histogram: &[u64; 180], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(histogram)
}

impl SolidQuality {
    /// Measures a mesh.
    pub fn of(mesh: &SolidMesh, exact_measure: Option<f64>) -> Self {
        let mut quality = Self {
            max_radius_edge: 0.0,
            min_dihedral_deg: 180.0,
            max_dihedral_deg: 0.0,
            dihedral_histogram: [0; 180],
            measure: 0.0,
            exact_measure,
        };
        for t in mesh.tetrahedra.ids() {
            let corners = mesh.corners(t);
            quality.measure += volume(corners);
            quality.max_radius_edge = quality.max_radius_edge.max(radius_edge(corners));
            for angle in dihedral_angles(corners).map(f64::to_degrees) {
                quality.min_dihedral_deg = quality.min_dihedral_deg.min(angle);
                quality.max_dihedral_deg = quality.max_dihedral_deg.max(angle);
                quality.dihedral_histogram[(angle as usize).min(179)] += 1;
            }
        }
        quality
    }
}

impl SolidMesh {
    /// The places of a tetrahedron's corners.
    pub fn corners(&self, t: TetId) -> [[f64; 3]; 4] {
        self.tetrahedra[t].map(|v| self.nodes[v])
    }
}

/// Signed volume of a tetrahedron: positive where `d` lies on the side of the triangle a b c from which it runs clockwise.
pub fn volume([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    dot(minus(d, a), cross(minus(b, a), minus(c, a))) / 6.0
}

/// The pairs of corners that edges join, each with the other two.
const EDGES: [[usize; 4]; 6] = [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [2, 3, 0, 1], [3, 1, 0, 2], [1, 2, 0, 3]];

/// Circumradius over the shortest edge.
pub fn radius_edge(corners: [[f64; 3]; 4]) -> f64 {
    let [a, b, c, d] = corners;
    let [u, v, w] = [minus(b, a), minus(c, a), minus(d, a)];
    let sum = plus(plus(times(cross(v, w), dot(u, u)), times(cross(w, u), dot(v, v))), times(cross(u, v), dot(w, w)));
    let radius = length(sum) / (2.0 * dot(u, cross(v, w)).abs());
    let shortest =
        EDGES.map(|[i, j, ..]| length(minus(corners[i], corners[j]))).into_iter().fold(f64::INFINITY, f64::min);
    radius / shortest
}

/// The angles between the two faces at each edge.
pub fn dihedral_angles(corners: [[f64; 3]; 4]) -> [f64; 6] {
    EDGES.map(|edge| {
        let [a, b, c, d] = edge.map(|i| corners[i]);
        let along = minus(b, a);
        let [p, q] = [c, d].map(|x| cross(along, minus(x, a)));
        libm::atan2(length(cross(p, q)), dot(p, q))
    })
}

/// Cells and volume by region name, in the order of the mesh's regions.
pub fn region_measures(mesh: &SolidMesh) -> Vec<RegionMeasure> {
    let mut by_name: Vec<Option<RegionMeasure>> = vec![None; mesh.names.iter().count()];
    for name in mesh.regions.iter() {
        let text = mesh.names.text(*name).to_owned();
        by_name[name.index()].get_or_insert(RegionMeasure { name: text, cells: 0, measure: 0.0 });
    }
    for (t, region) in mesh.tetrahedron_regions.enumerate() {
        if let Some(entry) = &mut by_name[mesh.regions[*region].index()] {
            entry.cells += 1;
            entry.measure += volume(mesh.corners(t));
        }
    }
    mesh.regions.iter().filter_map(|name| by_name[name.index()].take()).collect()
}

/// Triangles and area by name of facets, in the order of the names.
pub fn facet_measures(mesh: &SolidMesh) -> Vec<FacetMeasure> {
    let entry = |(_, name): (NameId, &str)| FacetMeasure { name: name.to_owned(), cells: 0, area: 0.0 };
    let mut by_name: Vec<FacetMeasure> = mesh.names.iter().map(entry).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.nodes.map(|v| mesh.nodes[v]);
        let entry = &mut by_name[triangle.name.index()];
        entry.cells += 1;
        entry.area += 0.5 * length(cross(minus(b, a), minus(c, a)));
    }
    by_name.retain(|facet| facet.cells > 0);
    by_name
}

/// Edges and length by name of segments, in the order of the names; segments without a name are left out.
pub fn segment_measures(mesh: &SolidMesh) -> Vec<BoundaryMeasure> {
    let entry = |(_, name): (NameId, &str)| BoundaryMeasure { name: name.to_owned(), edges: 0, length: 0.0 };
    let mut by_name: Vec<BoundaryMeasure> = mesh.names.iter().map(entry).collect();
    for edge in &mesh.edges {
        if let Some(name) = edge.name {
            let [a, b] = edge.nodes.map(|v| mesh.nodes[v]);
            let entry = &mut by_name[name.index()];
            entry.edges += 1;
            entry.length += length(minus(b, a));
        }
    }
    by_name.retain(|segment| segment.edges > 0);
    by_name
}

/// The largest weight of a node in parts of the squared distance to its nearest node; `None` without weights.
pub fn largest_relative_weight(mesh: &SolidMesh) -> Option<f64> {
    let mut nearest = vec![f64::INFINITY; mesh.nodes.len()];
    for corners in mesh.tetrahedra.iter() {
        for [i, j, ..] in EDGES {
            let between = minus(mesh.nodes[corners[i]], mesh.nodes[corners[j]]);
            for v in [corners[i], corners[j]] {
                nearest[v.index()] = nearest[v.index()].min(dot(between, between));
            }
        }
    }
    (!mesh.weights.is_empty())
        .then(|| mesh.weights.enumerate().map(|(v, weight)| weight / nearest[v.index()]).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNER: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn the_corner_of_a_cube_has_the_measures_of_the_textbook() {
        assert_eq!(volume(CORNER), 1.0 / 6.0);
        assert!((radius_edge(CORNER) - 0.75f64.sqrt()).abs() < 1e-15);
        let mut angles = dihedral_angles(CORNER).map(f64::to_degrees);
        angles.sort_by(f64::total_cmp);
        let other = (1.0 / 3.0f64.sqrt()).acos().to_degrees();
        for (angle, wanted) in angles.into_iter().zip([other, other, other, 90.0, 90.0, 90.0]) {
            assert!((angle - wanted).abs() < 1e-12, "{angle} {wanted}");
        }
    }

    #[test]
    fn a_flat_tetrahedron_has_an_endless_ratio() {
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(!radius_edge(flat).is_finite());
    }
}
