//! Regions that contain a curve, directly from its control points: a cone from an end, and the strip along its chord.
//!
//! ```text
//!                ╱ left
//!              ╱   ╭───╮         A cone has its apex at an end of the curve, and contains the whole curve between its
//!            ╱ ╭───╯   ╰──       two bounds `left` and `right`.
//!     apex ●───╯
//!            ╲
//!              ╲ right
//! ```

use super::{Curve, End, length};
use crate::geometry::{Point, Vec2};

/// The relative error of a distance from a chord, for each control point.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Directions from `right` counter-clockwise to `left`, over less than π.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cone {
    /// The clockwise bound of the cone, of any length.
    pub right: Vec2,
    /// The counter-clockwise bound of the cone, of any length; less than π to the left of `right`.
    pub left: Vec2,
}

impl Curve {
    /// A cone with its apex at an end that contains the curve, up to rounding; `None` where the control points give
    /// none that is narrower than a half plane.
    pub fn cone_from(&self, end: End) -> Option<Cone> {
        let (apex, other) = match end {
            End::Start => (self.start(), self.end()),
            End::Finish => (self.end(), self.start()),
        };
        let mut cone = Cone::along(other - apex)?;
        self.as_kind().widens(&mut cone, end).then_some(cone)
    }

    /// Whether the strip along the chord of either curve shows that the two are farther apart than `gap`.
    ///
    /// ```text
    ///   ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ high       The strip along the chord of `other` contains its control points, between low
    ///        ╭───────╮                 and high. The control points of `self` lie between least and most. Here most <
    ///     ●──╯       ╰──● other        low − gap: the curves are apart.
    ///   ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ low
    ///   ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ most
    ///     ●───╮     ╭───● self
    ///         ╰─────╯
    /// ```
    pub(super) fn is_clear_of(&self, other: &Self, gap: f64) -> bool {
        self.is_beside_strip_of(other, gap) || other.is_beside_strip_of(self, gap)
    }

    fn is_beside_strip_of(&self, other: &Self, gap: f64) -> bool {
        let (origin, chord) = (other.start(), other.end() - other.start());
        if chord == Vec2::ZERO {
            return false;
        }
        let normal = Vec2::new(-chord.y, chord.x) / length(chord);
        let (mut count, mut largest) = (0.0, 0.0f64);
        let mut spread = |curve: &Self| {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            let has_hull = curve.as_kind().each_of_hull(&mut |p| {
                let d = normal.dot(p - origin);
                (low, high) = (low.min(d), high.max(d));
                (count, largest) = (count + 1.0, largest.max(p.x.abs()).max(p.y.abs()));
            });
            has_hull.then_some([low, high])
        };
        let (Some([low, high]), Some([least, most])) = (spread(other), spread(self)) else { return false };
        let gap = gap + ROUNDING * count * largest;
        least > high + gap || most < low - gap
    }
}

impl Cone {
    /// The cone of one direction; `None` where that is zero.
    pub(super) fn along(axis: Vec2) -> Option<Self> {
        (axis != Vec2::ZERO).then_some(Self { right: axis, left: axis })
    }

    /// Widens the cone to contain the direction `v`. Returns whether `v` points ahead along `axis`.
    pub(super) fn widen(&mut self, v: Vec2, axis: Vec2) -> bool {
        if self.right.cross(v) < 0.0 {
            self.right = v;
        }
        if self.left.cross(v) > 0.0 {
            self.left = v;
        }
        axis.dot(v) > 0.0
    }

    /// Widens the cone to contain points other than the apex. Returns whether all of them lie ahead along `axis`.
    pub(super) fn widen_to(&mut self, points: &[Point], apex: Point, axis: Vec2) -> bool {
        points.iter().filter(|&&point| point != apex).all(|&point| self.widen(point - apex, axis))
    }

    fn holds(&self, v: Vec2) -> bool {
        let is_between = self.right.cross(v) >= 0.0 && v.cross(self.left) >= 0.0;
        // Both products are 0 straight behind a cone of one direction, too.
        is_between && (self.right.dot(v) > 0.0 || self.left.dot(v) > 0.0)
    }

    /// Whether every two directions of the two cones differ by an angle with at least this sine.
    pub fn is_apart_from(&self, other: &Self, sine: f64) -> bool {
        let (mine, theirs) = ([self.right, self.left], [other.right, other.left]);
        let is_near = |a: Vec2, b: Vec2| {
            let cross = a.cross(b);
            a.dot(b) > 0.0 && cross * cross < sine * sine * a.hypot2() * b.hypot2()
        };
        !mine.iter().any(|&a| other.holds(a) || theirs.iter().any(|&b| is_near(a, b)))
            && !theirs.iter().any(|&b| self.holds(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::direction;
    use std::f64::consts::PI;

    #[test]
    fn cones_are_apart_by_the_least_angle_between_them() {
        let cone = |right: f64, left: f64| Cone { right: 3.0 * direction(right), left: direction(left) };
        let sine = 0.0625;
        for turn in [0.0, 1.0, 2.5, 4.0, 6.0] {
            let one = cone(turn, turn + 1.0);
            for (from, to, apart) in [
                (1.1, 2.0, true),
                (1.05, 2.0, false),
                (0.2, 0.4, false),
                (-1.0, 2.0, false),
                (-1.0, -0.1, true),
                (2.0, 4.0, true),
                (3.0, 3.0, true),
                (-0.5, 0.5, false),
            ] {
                let other = cone(turn + from, turn + to);
                assert_eq!(one.is_apart_from(&other, sine), apart, "{turn} {from} {to}");
                assert_eq!(other.is_apart_from(&one, sine), apart, "{turn} {from} {to}");
            }
        }
        let [line, back] = [cone(0.0, 0.0), cone(PI, PI)];
        assert!(line.is_apart_from(&back, sine) && !line.is_apart_from(&line, sine));
    }
}
