//! Points too near to each other, and those that lie on the line between their neighbours.

use crate::geometry::{Point, Vec2};

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

/// Leaves out points between neighbours nearer than 2e-4 of the chord that lie on the line between them to half a unit
/// of the last decimal, or to 1e-8 of the chord: they carry no direction. A contour keeps some ten thousand points
/// then.
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
        // The candidate is left out if the next point can be reached past it.
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

/// The directions in which a line from a point passes within a distance of all the points left out.
struct Sector {
    slack: f64,
    /// The first direction, and how far others may turn from it, in radians.
    about: Option<(Vec2, f64, f64)>,
}

impl Sector {
    fn new(slack: f64) -> Self {
        Self { slack, about: None }
    }

    fn narrow(&mut self, to: Vec2) {
        let distance = to.hypot();
        // From within the slack every direction will do.
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
