//! Points that are too near to each other, and points that lie on the line between their neighbours.

use crate::geometry::{Point, Vec2};

/// Merges neighbours at most `tolerance` apart. The first of each group is kept, at the end of the list the last.
pub fn merge_repeated(points: &mut Vec<Point>, tolerance: f64, notes: &mut Vec<String>) {
    let before = points.len();
    let last = points[before - 1];
    points.dedup_by(|b, a| (*b - *a).hypot() <= tolerance);
    let n = points.len();
    if n > 1 {
        points[n - 1] = last;
    }
    if n < before {
        notes.push(format!("Repeated points that became one with their neighbours: {}.", before - n));
    }
}

/// Leaves out points between neighbours nearer than 2e-4 of the chord if they lie on the line between them, to within
/// half a unit of the last decimal or 1e-8 of the chord: they define no direction. A contour then keeps at most some
/// ten thousand points.
pub fn thin(points: &mut Vec<Point>, decimal: f64, wide: f64, notes: &mut Vec<String>) {
    let (reach, slack) = (2e-4 * wide, (0.5 * decimal).max(1e-8 * wide));
    let before = points.len();
    let mut kept: Vec<Point> = Vec::with_capacity(before);
    kept.push(points[0]);
    let mut sector = Sector::new(slack);
    for w in points.windows(2).skip(1) {
        let [candidate, next] = [w[0], w[1]];
        let from = kept[kept.len() - 1];
        sector.narrow(candidate - from);
        // The candidate is left out if a line to the next point passes it and all earlier ones within the slack.
        if (next - from).hypot() > reach || !sector.allows(next - from) {
            kept.push(candidate);
            sector = Sector::new(slack);
        }
    }
    kept.push(points[before - 1]);
    if kept.len() < before {
        notes.push(format!(
            "Points within {slack:.1e} of the lines between near neighbours, left out: {}.",
            before - kept.len()
        ));
        *points = kept;
    }
}

/// The directions in which a line from a point passes all points left out within a distance `slack`.
///
/// ```text
///                      ╱ high
///               ·   ╱
///   from ●━━━━━━━━━━━━━━━● next       Every point · left out narrows the sector between low and high: by it the line
///               ·   ╲                 passes within `slack`. `next` is allowed if its direction lies in the sector.
///                      ╲ low
/// ```
struct Sector {
    slack: f64,
    /// The first direction, and the angles low and high from it between which others may lie, in radians.
    about: Option<(Vec2, f64, f64)>,
}

impl Sector {
    fn new(slack: f64) -> Self {
        Self { slack, about: None }
    }

    fn narrow(&mut self, to: Vec2) {
        let distance = to.hypot();
        // A point within the slack allows every direction.
        if distance <= self.slack {
            return;
        }
        let half = libm::asin(self.slack / distance);
        let (about, low, high) = self.about.unwrap_or((to, f64::NEG_INFINITY, f64::INFINITY));
        let turned = libm::atan2(about.cross(to), about.dot(to));
        self.about = Some((about, low.max(turned - half), high.min(turned + half)));
    }

    fn allows(&self, to: Vec2) -> bool {
        let Some((about, low, high)) = self.about else { return true };
        let turned = libm::atan2(about.cross(to), about.dot(to));
        (low..=high).contains(&turned)
    }
}
