//! Angles, areas and lengths of a mesh.

use super::Mesh;
use crate::domain::Domain;
use crate::geometry::{Point, Vec2};
use crate::ids::{Id, TriangleId, VertexId};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

/// Measures of a mesh; angles in degrees, the rest in the drawing's units. Without triangles the smallest angle is 180
/// and the largest 0.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Quality {
    /// The smallest angle of all triangles, in degrees, between their corners.
    pub min_angle_deg: f64,
    /// The largest angle of all triangles, in degrees, between their corners.
    pub max_angle_deg: f64,
    /// The smallest angle of the triangles that are not exempt, in degrees.
    pub min_unexcused_angle_deg: f64,
    /// How many angles (three a triangle) lie in each whole degree.
    #[serde(serialize_with = "as_sequence")]
    #[schemars(with = "Vec<u64>")]
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
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct RegionMeasure {
    /// The name that one or several regions bear.
    pub name: String,
    /// The number of triangles in all regions of this name.
    pub cells: usize,
    /// The area of these triangles, in square units of the drawing.
    pub measure: f64,
}

/// Mesh edges and their length on one boundary name.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BoundaryMeasure {
    /// The name of the boundary.
    pub name: String,
    /// The number of mesh edges on the boundary.
    pub edges: usize,
    /// The length of these edges, in units of the drawing; of order 2, along the curve, extrapolated.
    pub length: f64,
}

impl Quality {
    /// Measures a mesh; `exempt` are the triangles that a corner exempts.
    pub fn of(domain: Option<&Domain>, mesh: &Mesh, exempt: impl IntoIterator<Item = TriangleId>) -> Self {
        let mut excused = vec![false; mesh.triangles.len()];
        exempt.into_iter().for_each(|cell| excused[cell.index()] = true);
        let mut quality = Self {
            min_angle_deg: 180.0,
            max_angle_deg: 0.0,
            min_unexcused_angle_deg: 180.0,
            angle_histogram: [0; 180],
            measure: 0.0,
            exact_measure: domain.map(Domain::area),
            max_chord_error: domain.and_then(|d| max_chord_error(d, mesh)),
        };
        for t in mesh.triangles.ids() {
            let corners = mesh.corners(t);
            quality.measure += cell_area(mesh, t);
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
            entry.measure += cell_area(mesh, t);
        }
    }
    mesh.regions.iter().filter_map(|name| by_name[name.index()].take()).collect()
}

/// Mesh edges and length by boundary name, in the order of the names.
pub fn boundary_measures(mesh: &Mesh) -> Vec<BoundaryMeasure> {
    let mut by_name: Vec<BoundaryMeasure> =
        mesh.names.iter().map(|(_, text)| BoundaryMeasure { name: text.to_owned(), edges: 0, length: 0.0 }).collect();
    for (i, edge) in mesh.edges.iter().enumerate() {
        let entry = &mut by_name[edge.name.index()];
        entry.edges += 1;
        let [a, b] = edge.nodes.map(|v| mesh.nodes[v]);
        let chord = a.distance(b);
        // Order 2: two chords have a quarter of the error of one, so the length is extrapolated.
        entry.length += mesh.edge_mids.get(i).map_or(chord, |&m| {
            let m = mesh.nodes[m];
            (4.0 * (a.distance(m) + m.distance(b)) - chord) / 3.0
        });
    }
    by_name.retain(|b| b.edges > 0);
    by_name
}

/// Signed area of a triangle: positive where it runs counter-clockwise.
pub fn area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * (b - a).cross(c - a)
}

/// Signed area of a cell. In order 2 a side is a parabola through its three nodes: between it and the chord lie two
/// thirds of the parallelogram around it.
pub fn cell_area(mesh: &Mesh, t: TriangleId) -> f64 {
    let corners = mesh.corners(t);
    let bulge = |mids: &[VertexId; 3]| -> f64 {
        let bulge = |i: usize| (mesh.nodes[mids[i]] - corners[i]).cross(corners[(i + 1) % 3] - corners[i]);
        (0..3).map(bulge).sum()
    };
    area(corners) + mesh.triangle_mids.get(t).map_or(0.0, |mids| bulge(mids) * 2.0 / 3.0)
}

/// Whether the Jacobian determinant of a cell is positive throughout. It is proven by bounds, never by samples, so a
/// doubtful cell counts as not valid. Order 1: whether the cell runs counter-clockwise.
pub fn is_valid(mesh: &Mesh, t: TriangleId) -> bool {
    let corners = mesh.corners(t);
    match mesh.triangle_mids.get(t) {
        None => area(corners) > 0.0,
        Some(mids) => Jacobian::new(corners, mids.map(|v| mesh.nodes[v])).is_positive(),
    }
}

/// The Jacobian determinant of a cell of order 2, as a polynomial of degree 2 in Bézier form over the triangle.
struct Jacobian {
    /// At the corners: its values there.
    at: [f64; 3],
    /// Within the sides 0–1, 1–2, 2–0.
    within: [f64; 3],
    /// A bound on the rounding of a coefficient.
    noise: f64,
}

/// Barycentric coordinates.
type Place = [f64; 3];

impl Jacobian {
    fn new(corners: [Point; 3], mids: [Point; 3]) -> Self {
        let p = corners.map(|c| c - corners[0]);
        let m = mids.map(|m| m - corners[0]);
        // Control points of the sides as parabolas.
        let control = |i: usize| 2.0 * m[i] - 0.5 * (p[i] + p[(i + 1) % 3]);
        let (e01, e12, e20) = (control(0), control(1), control(2));
        // Derivatives towards corner 1 and towards corner 2, at each corner: both are linear.
        let (u, v) = ([e01 - p[0], p[1] - e01, e12 - e20], [e20 - p[0], e12 - e01, p[2] - e20]);
        let product = |i: usize, j: usize| 2.0 * (u[i].cross(v[j]) + u[j].cross(v[i]));
        let largest = u.iter().chain(&v).map(|w| w.hypot2()).fold(0.0, f64::max);
        Self {
            at: [product(0, 0), product(1, 1), product(2, 2)],
            within: [product(0, 1), product(1, 2), product(2, 0)],
            noise: 64.0 * f64::EPSILON * largest,
        }
    }

    /// The polar form. Where `a` and `b` are the same it is the value there; where they are two corners of a part of
    /// the triangle it is a coefficient over that part.
    fn polar(&self, a: Place, b: Place) -> f64 {
        let diagonal: f64 = (0..3).map(|i| self.at[i] * a[i] * b[i]).sum();
        let mixed = |i: usize, j: usize| self.within[i] * (a[i] * b[j] + a[j] * b[i]);
        diagonal + mixed(0, 1) + mixed(1, 2) + mixed(2, 0)
    }

    /// Cuts the triangle into four parts, again and again, until all coefficients of each part are positive, or a value
    /// is not.
    ///
    /// ```text
    ///           c         Over the part a b c: polar(a, a), polar(b, b), polar(c, c) are values at corners,
    ///         ╱   ╲       polar(a, b), polar(b, c), polar(c, a) coefficients within the sides.
    ///      ca ─── bc      All positive: the polynomial is positive on the part.
    ///      ╱ ╲   ╱ ╲
    ///     a ── ab ── b
    /// ```
    fn is_positive(&self) -> bool {
        /// Each cut brings coefficients four times nearer to values. After six cuts a coefficient that is not positive
        /// means a value too near to zero to be of use.
        const CUTS: u32 = 6;
        let mut parts = vec![([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], CUTS)];
        while let Some(([a, b, c], cuts)) = parts.pop() {
            let positive = |a: Place, b: Place| self.polar(a, b) > self.noise;
            if !(positive(a, a) && positive(b, b) && positive(c, c)) {
                return false;
            }
            if positive(a, b) && positive(b, c) && positive(c, a) {
                continue;
            }
            if cuts == 0 {
                return false;
            }
            let middle = |a: Place, b: Place| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            parts.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(|part| (part, cuts - 1)));
        }
        true
    }
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

    /// The value by the definition, from the derivatives of the six shape functions.
    fn jacobian_at(corners: [Point; 3], mids: [Point; 3], [l0, l1, l2]: [f64; 3]) -> f64 {
        let d = [4.0 * l0 - 1.0, 4.0 * l1 - 1.0, 4.0 * l2 - 1.0];
        let derivative = |towards: usize| {
            let along = |i: usize| {
                if i == towards {
                    1.0
                } else if i == 0 {
                    -1.0
                } else {
                    0.0
                }
            };
            let l = [l0, l1, l2];
            let corner = (0..3).map(|i| corners[i].to_vec2() * d[i] * along(i));
            let mid = (0..3).map(|i| {
                let j = (i + 1) % 3;
                mids[i].to_vec2() * 4.0 * (along(i) * l[j] + l[i] * along(j))
            });
            corner.chain(mid).fold(Vec2::ZERO, |sum, v| sum + v)
        };
        derivative(1).cross(derivative(2))
    }

    #[test]
    fn the_jacobians_bezier_form_has_the_values_of_its_definition_and_its_sign_is_told() {
        let mut state = 1u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64 - 0.5
        };
        let (mut valid, mut folded) = (0, 0);
        for _ in 0..2000 {
            let corners = [Point::new(0.0, 0.0), Point::new(1.0, 0.1), Point::new(0.3, 0.9)];
            let mids = [0, 1, 2]
                .map(|i: usize| corners[i].midpoint(corners[(i + 1) % 3]) + 0.5 * Vec2::new(number(), number()));
            let jacobian = Jacobian::new(corners, mids);
            let places =
                (0..=40).flat_map(|i| (0..=40 - i).map(move |j| [i, j, 40 - i - j].map(|k| f64::from(k) / 40.0)));
            let mut least = f64::INFINITY;
            for place in places {
                let value = jacobian_at(corners, mids, place);
                approx::assert_abs_diff_eq!(jacobian.polar(place, place), value, epsilon = 1e-12);
                least = least.min(value);
            }
            if jacobian.is_positive() {
                valid += 1;
                assert!(least > 0.0);
            } else {
                folded += 1;
                assert!(least < 0.01, "refused, but its least sample is {least}");
            }
        }
        assert!(valid > 200 && folded > 200, "{valid} valid, {folded} folded");
    }

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
