//! Triangles by their corners.

use super::{Point, Vec2};

/// The circumcenter and the circumradius of a triangle; not finite where the corners are collinear.
///
/// ```text
///               ● c
///              ╱ ╲        The center m = a + offset is equally far from a, b and c. It lies on the bisectors of ab and
///             ╱ m ╲       ac, so offset·ab = ½ ab² and offset·ac = ½ ac².
///            ╱  ·  ╲
///         a ●───────● b
/// ```
pub fn circumcircle([a, b, c]: [Point; 3]) -> (Point, f64) {
    let (ab, ac) = (b - a, c - a);
    let (bb, cc) = (ab.hypot2(), ac.hypot2());
    let double = 2.0 * ab.cross(ac);
    let offset = Vec2::new(ac.y * bb - ab.y * cc, ab.x * cc - ac.x * bb) / double;
    (a + offset, offset.hypot())
}

/// The squared sine of the smallest angle of a triangle, which is opposite its shortest edge; 0 where two corners
/// coincide.
pub fn sin2_smallest([a, b, c]: [Point; 3]) -> f64 {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let [shortest, l1, l2] = {
        let mut l = [ab.hypot2(), bc.hypot2(), ca.hypot2()];
        l.sort_unstable_by(f64::total_cmp);
        l
    };
    let cross = ab.cross(ca);
    if shortest == 0.0 { 0.0 } else { cross * cross / (l1 * l2) }
}
