//! Moves a curve's ends a little, so that it ends at its vertices bit for bit.

use super::{Curve, length};
use crate::geometry::{Point, Vec2};

/// The largest factor by which a similarity may move a curve's points farther than its ends. Three quarters of a circle
/// are at most 2.8 radii across, twice their chord, and the chord changes by up to twice the move of the ends. So three
/// quarters of a circle are still moved as a circle.
const AMPLIFICATION_MAX: f64 = 4.0;

/// The rotation and scaling that map one chord to another: `factor` is a complex number.
pub(super) struct Similarity {
    from: Point,
    to: Point,
    factor: Vec2,
}

impl Similarity {
    /// Maps the point `from` to `to`, and the vector `chord` to `wanted`.
    fn new(from: Point, to: Point, chord: Vec2, wanted: Vec2) -> Self {
        let factor = Vec2::new(chord.dot(wanted), chord.cross(wanted)) / chord.dot(chord);
        Self { from, to, factor }
    }

    /// The image of a vector.
    pub(super) fn vector(&self, v: Vec2) -> Vec2 {
        let factor = self.factor;
        Vec2::new(factor.x * v.x - factor.y * v.y, factor.y * v.x + factor.x * v.y)
    }

    /// The image of a point.
    pub(super) fn point(&self, p: Point) -> Point {
        self.to + self.vector(p - self.from)
    }

    /// The factor of lengths.
    pub(super) fn scale(&self) -> f64 {
        length(self.factor)
    }

    /// The angle of rotation, in radians, counter-clockwise.
    pub(super) fn turn_rad(&self) -> f64 {
        libm::atan2(self.factor.y, self.factor.x)
    }
}

/// The move at t, interpolated between those of the two ends.
pub(super) fn spread_to(moves: [Vec2; 2], t: f64) -> Vec2 {
    if moves[0] == moves[1] { moves[0] } else { moves[0] * (1.0 - t) + moves[1] * t }
}

/// See [`Curve::with_ends`].
///
/// ```text
///        ╭───╮              ╭───╮        By a similarity, if that moves no point much farther than the ends.
///       ╱     ╲            ╱     ╲       Otherwise the moves of the ends are spread along the curve, by its
///      a       b    ▶     a′      ╲      parameter.
///                                  b′
/// ```
pub(super) fn with_ends(curve: &Curve, start: Point, end: Point) -> Curve {
    let moves = [start - curve.start(), end - curve.end()];
    if moves == [Vec2::ZERO; 2] {
        return curve.clone();
    }
    let chord = curve.end() - curve.start();
    let farthest = length(moves[0]).max(length(moves[1]));
    let extent = curve.bounds();
    let across = length(Vec2::new(extent.width(), extent.height()));
    let amplified = length(moves[1] - moves[0]) * across > AMPLIFICATION_MAX * farthest * length(chord);
    if chord == Vec2::ZERO || end == start || amplified {
        curve.as_kind().spread(moves, [start, end])
    } else {
        let map = Similarity::new(curve.start(), start, chord, end - start);
        curve.as_kind().moved(&map, [start, end])
    }
}
