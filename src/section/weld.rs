//! Gaps that are rounding, and loops behind the place where the surfaces meet.

use super::SHARP;
use super::contour::Contour;
use super::crossing::{Meeting, meeting_at_tail};
use crate::geometry::{Point, Vec2};
use std::f64::consts::FRAC_1_SQRT_2;

impl Contour {
    /// Leaves out the loop behind a crossing of the surfaces before the trailing edge, if it is smaller than a
    /// thousandth of the chord. Where the surfaces only touch, to the last decimal, leaves out the points there, and
    /// the trailing edge stays in place.
    ///
    /// ```text
    ///  upper ────╲  ╱╲            ────╲
    ///             ╳   │     ▶          ● at, the new tail
    ///  lower ────╱  ╲╱            ────╱
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

    /// Leaves out the points behind the edges `upper` and `lower`, except for the two ends. Returns how many.
    pub fn leave_out_behind(&mut self, upper: usize, lower: usize) -> usize {
        let n = self.points.len();
        let mut kept = vec![self.points[0]];
        kept.extend(&self.points[upper + 1..=lower]);
        kept.push(self.points[n - 1]);
        // Fewer points are no section.
        if kept.len() < 4 {
            return 0;
        }
        self.nose = self.nose.saturating_sub(upper);
        self.points = kept;
        n - self.points.len()
    }

    /// The largest vertical distance of the surfaces behind points `upper` and `lower`, measured at their points.
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

    /// Closes a gap that is rounding, and a gap where the last point is missing.
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
        // If the closing edge lies along the chord and continues a surface (turning by less than 45°), a point is
        // missing there, and the end is not blunt.
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
