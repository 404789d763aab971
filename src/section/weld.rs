//! Points too near to each other, gaps that are rounding, and loops behind the place where the surfaces meet.

use super::SHARP;
use super::contour::Contour;
use super::crossing::{Meeting, meeting_at_tail};
use crate::geometry::{Point, Vec2};
use std::f64::consts::FRAC_1_SQRT_2;

impl Contour {
    /// Leaves out the loop behind the place where the surfaces meet before the trailing edge, if it is smaller than a thousandth of the chord;
    /// of surfaces that touch there only the points, to the last decimal, so that the trailing edge stays where it is.
    ///
    /// ```text
    ///  upper ────╲  ╱╲            ────╲
    ///             ╳   ╲    ─▶          ╳  tail
    ///  lower ────╱  ╲ ╱           ────╱
    /// ```
    pub fn untie_tail(&mut self, decimal: f64, wide: f64, notes: &mut Vec<String>) {
        const LOOP: f64 = 1e-3;
        let ends_in_a_point = (self.first() - self.last()).hypot() < SHARP * wide;
        let meeting = meeting_at_tail(&self.points, ends_in_a_point, wide);
        let Some(Meeting { at, upper, lower, reach }) = meeting else { return };
        if ends_in_a_point && self.thickness_behind(upper, lower) <= decimal {
            let touching = self.leave_out_behind(upper, lower);
            if touching > 0 {
                let place = format!("near ({}, {})", at.x, at.y);
                notes.push(format!(
                    "The surfaces touch {place}, before the trailing edge: {touching} points there were left out."
                ));
            }
            return;
        }
        if reach < LOOP * wide && lower > upper + 2 {
            let kept = self.points[upper + 1..=lower].iter().copied();
            self.points = [at].into_iter().chain(kept).chain([at]).collect();
            notes.push(format!(
                "The surfaces cross at ({}, {}), before the trailing edge: the loop of {reach:.1e} behind was left out.",
                at.x, at.y
            ));
        }
    }

    /// Leaves out the points behind the edges `upper` and `lower`, but for the two ends, and says how many those are.
    pub fn leave_out_behind(&mut self, upper: usize, lower: usize) -> usize {
        let n = self.points.len();
        let mut kept = vec![self.points[0]];
        kept.extend(&self.points[upper + 1..=lower]);
        kept.push(self.points[n - 1]);
        // Fewer are no section.
        if kept.len() < 4 {
            return 0;
        }
        self.nose = self.nose.saturating_sub(upper);
        self.points = kept;
        n - self.points.len()
    }

    /// How far the surfaces lie apart behind points `upper` and `lower`, at most: upright, at their points.
    fn thickness_behind(&self, upper: usize, lower: usize) -> f64 {
        let (above, below) = (&self.points[..=upper], &self.points[lower..]);
        let height = |side: &[Point], x: f64| {
            let span = side.windows(2).find(|w| (w[0].x - x) * (w[1].x - x) <= 0.0 && w[0].x != w[1].x)?;
            Some(span[0].y + (span[1].y - span[0].y) * (x - span[0].x) / (span[1].x - span[0].x))
        };
        let apart = |side: &[Point], p: &Point| height(side, p.x).map_or(0.0, |y| (y - p.y).abs());
        let over = above.iter().map(|p| apart(below, p)).fold(0.0, f64::max);
        below.iter().map(|p| apart(above, p)).fold(over, f64::max)
    }

    /// Closes a gap that is rounding, and one that a missing last point leaves.
    pub fn close(&mut self, wide: f64, notes: &mut Vec<String>) {
        if !self.base.is_empty() || self.first() == self.last() {
            return;
        }
        let (first, last) = (self.first(), self.last());
        let gap = first - last;
        let n = self.points.len();
        if gap.hypot() < SHARP * wide {
            let tail = self.tail();
            (self.points[0], self.points[n - 1]) = (tail, tail);
            notes.push(format!("The trailing edge had a gap of {:.1e} and was closed.", gap.hypot()));
            return;
        }
        // The closing edge lies along the chord and goes on as a surface does (turning less than 45°): the point there is missing,
        // the end is not blunt.
        let goes_on = |along: Vec2, next: Vec2| {
            gap.x.abs() > gap.y.abs() && along.dot(next) > FRAC_1_SQRT_2 * along.hypot() * next.hypot()
        };
        if goes_on(last - self.points[n - 2], gap) {
            self.points.push(first);
        } else if goes_on(gap, self.points[1] - first) {
            self.points.insert(0, last);
        } else {
            return;
        }
        notes.push("The contour stops short of the trailing edge and was closed with its other end.".into());
    }
}

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

/// Leaves out points between neighbours nearer than 2e-4 of the chord that lie on the line between them to half a unit of the last decimal,
/// or to 1e-8 of the chord: they carry no direction. A contour keeps some ten thousand points then.
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
