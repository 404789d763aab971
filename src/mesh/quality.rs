//! Angles, areas and lengths of a mesh.

use super::Mesh;
use super::verify::Verdict;
use crate::domain::Domain;
use crate::geometry::{Point, Vec2};
use crate::ids::{Id, TriangleId};
use serde::{Serialize, Serializer};

/// What a mesh measures; angles in degrees, the rest in the drawing's units. Angles of a mesh without triangles: the
/// smallest is 180, the largest 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quality {
    pub min_angle_deg: f64,
    pub max_angle_deg: f64,
    /// The smallest angle of the triangles that no corner excuses.
    pub min_unexcused_angle_deg: f64,
    /// How many angles (three a triangle) lie in each whole degree.
    #[serde(serialize_with = "as_sequence")]
    pub angle_histogram: [u64; 180],
    /// Area of the triangles.
    pub measure: f64,
    /// Area of the kept regions as the curves themselves enclose it, where the domain is known.
    pub exact_measure: Option<f64>,
    /// Largest distance of a curve from its mesh edge, where links are known.
    pub max_chord_error: Option<f64>,
}

fn as_sequence<S: Serializer>(histogram: &[u64; 180], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(histogram)
}

/// Cells and area of one region name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionMeasure {
    pub name: String,
    pub cells: usize,
    pub measure: f64,
}

/// Mesh edges and their length on one boundary name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoundaryMeasure {
    pub name: String,
    pub edges: usize,
    pub length: f64,
}

impl Quality {
    /// Measures a mesh; `verdict` says which triangles are excused.
    pub fn of(domain: Option<&Domain>, mesh: &Mesh, verdict: &Verdict) -> Self {
        let mut excused = vec![false; mesh.triangles.len()];
        for &cell in verdict.excused.iter().flat_map(|e| &e.cells) {
            excused[TriangleId(cell).index()] = true;
        }
        let mut quality = Self {
            min_angle_deg: 180.0,
            max_angle_deg: 0.0,
            min_unexcused_angle_deg: 180.0,
            angle_histogram: [0; 180],
            measure: 0.0,
            exact_measure: domain.map(Domain::measure),
            max_chord_error: domain.and_then(|d| max_chord_error(d, mesh)),
        };
        for t in mesh.triangles.ids() {
            let corners = mesh.corners(t);
            quality.measure += area(corners);
            quality.add_angles(angle_range(corners), excused[t.index()]);
        }
        quality
    }

    fn add_angles(&mut self, (least, most): (f64, f64), excused: bool) {
        let (least, most) = (least.to_degrees(), most.to_degrees());
        self.min_angle_deg = self.min_angle_deg.min(least);
        self.max_angle_deg = self.max_angle_deg.max(most);
        if !excused {
            self.min_unexcused_angle_deg = self.min_unexcused_angle_deg.min(least);
        }
        for angle in [least, 180.0 - least - most, most] {
            self.angle_histogram[(angle as usize).min(179)] += 1;
        }
    }
}

/// The curves' largest distance from their mesh edges; `None` without a linked edge.
fn max_chord_error(domain: &Domain, mesh: &Mesh) -> Option<f64> {
    let links = mesh.edges.iter().filter_map(|e| e.link);
    links
        .filter_map(|link| {
            let curve = &domain.curves().get(link.curve)?.curve;
            (0.0 <= link.t[0] && link.t[0] < link.t[1] && link.t[1] <= 1.0)
                .then(|| curve.chord_error(link.t[0], link.t[1]))
        })
        .reduce(f64::max)
}

/// Cells and area by region name, in the order of the mesh's regions.
pub fn region_measures(mesh: &Mesh) -> Vec<RegionMeasure> {
    let mut by_name: Vec<Option<RegionMeasure>> = vec![None; mesh.names.iter().count()];
    for name in mesh.regions.iter() {
        let text = mesh.names.text(*name).to_owned();
        by_name[name.index()].get_or_insert(RegionMeasure { name: text, cells: 0, measure: 0.0 });
    }
    for (t, region) in mesh.triangle_regions.enumerate() {
        if let Some(entry) = &mut by_name[mesh.regions[*region].index()] {
            entry.cells += 1;
            entry.measure += area(mesh.corners(t));
        }
    }
    mesh.regions.iter().filter_map(|name| by_name[name.index()].take()).collect()
}

/// Mesh edges and length by boundary name, in the order of the names.
pub fn boundary_measures(mesh: &Mesh) -> Vec<BoundaryMeasure> {
    let mut by_name: Vec<BoundaryMeasure> =
        mesh.names.iter().map(|(_, text)| BoundaryMeasure { name: text.to_owned(), edges: 0, length: 0.0 }).collect();
    for edge in &mesh.edges {
        let entry = &mut by_name[edge.name.index()];
        entry.edges += 1;
        entry.length += mesh.nodes[edge.nodes[0]].distance(mesh.nodes[edge.nodes[1]]);
    }
    by_name.retain(|b| b.edges > 0);
    by_name
}

/// Signed area of a triangle: positive where it runs counter-clockwise.
pub fn area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * (b - a).cross(c - a)
}

/// The smallest and the largest angle of a triangle, in radians; both negative where it runs clockwise.
pub fn angle_range([a, b, c]: [Point; 3]) -> (f64, f64) {
    // cot of each angle is its dot product over the cross product that all three share.
    let cross = (b - a).cross(c - a);
    let dots = dots([a, b, c]);
    let most = dots[0].max(dots[1]).max(dots[2]);
    let least = dots[0].min(dots[1]).min(dots[2]);
    (libm::atan2(cross, most), libm::atan2(cross, least))
}

fn dots([a, b, c]: [Point; 3]) -> [f64; 3] {
    let (ab, bc, ca): (Vec2, Vec2, Vec2) = (b - a, c - b, a - c);
    [-ab.dot(ca), -bc.dot(ab), -ca.dot(bc)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

    #[test]
    fn angles_and_area_of_half_an_equilateral_triangle_at_any_scale_and_offset() {
        for scale in [1e-6, 1.0, 1e7] {
            for offset in [0.0, 1e3 * scale] {
                let corner = |x: f64, y: f64| Point::new(offset + scale * x, offset + scale * y);
                let t = [corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 3.0f64.sqrt())];
                let (least, most) = angle_range(t);
                approx::assert_abs_diff_eq!(least, FRAC_PI_6, epsilon = 1e-12);
                approx::assert_abs_diff_eq!(most, FRAC_PI_2, epsilon = 1e-12);
                approx::assert_relative_eq!(area(t), 0.5 * 3.0f64.sqrt() * scale * scale, max_relative = 1e-12);
                assert!(angle_range([t[0], t[2], t[1]]).0 < 0.0);
            }
        }
    }
}
