//! The shape of a section's right end: a corner, a base or round.

use super::SHARP;
use crate::geometry::{Point, bounds_of};
use std::f64::consts::PI;

/// The turning at point `i` of a ring, in radians; 0 at repeated points.
fn turning(ring: &[Point], i: usize) -> f64 {
    let n = ring.len();
    let (a, b, c) = (ring[(i + n - 1) % n], ring[i % n], ring[(i + 1) % n]);
    let (before, after) = (b - a, c - b);
    libm::atan2(before.cross(after), before.dot(after))
}

/// The index of the point with the largest x, the first of several.
pub fn aftmost(ring: &[Point]) -> usize {
    (0..ring.len()).reduce(|a, b| if ring[b].x > ring[a].x { b } else { a }).unwrap_or(0)
}

/// The blunt trailing edge of a counter-clockwise ring, as the indices of its lower and its upper end.
///
/// It is the straight run of upright edges at the aftmost point between two corners. If the surfaces meet at an angle
/// ω, the turning at both ends together is 180° − ω. A round end distributes this turning over its points, and no two
/// neighbours have most of it.
///
/// ```text
///   ────────┐ upper
///           │ base
///   ────────┘ lower
/// ```
pub fn base_of(ring: &[Point], wide: f64) -> Option<[usize; 2]> {
    // Half circles of three edges turn by 60° and 60°, squared ends by 90° and 90°: the bound lies between.
    const BOTH: f64 = 130.0 / 180.0 * PI;
    const EACH: f64 = 40.0 / 180.0 * PI;
    const STRAIGHT: f64 = 10.0 / 180.0 * PI;
    let n = ring.len();
    if n < 6 {
        return None;
    }
    let upright = |i: usize| {
        let edge = ring[(i + 1) % n] - ring[i % n];
        edge.y > edge.x.abs()
    };
    let goes_on = |i: usize| turning(ring, i % n).abs() < STRAIGHT;
    let tail = aftmost(ring);
    let start = [tail, tail + n - 1].into_iter().find(|&i| upright(i))?;
    let (mut lower, mut upper) = (start, start + 1);
    while upper - lower < n - 3 && upright(lower + n - 1) && goes_on(lower) {
        lower += n - 1;
        upper += n;
    }
    while upper - lower < n - 3 && upright(upper) && goes_on(upper) {
        upper += 1;
    }
    let (from, to) = (ring[lower % n], ring[upper % n]);
    let along = to - from;
    // If the run is not straight, the end is round.
    let is_straight = (lower..upper).all(|i| along.cross(ring[i % n] - from).abs() <= 0.02 * along.hypot2());
    let turned = [turning(ring, lower % n), turning(ring, upper % n)];
    let is_base = is_straight
        && (SHARP * wide..0.5 * wide).contains(&along.hypot())
        && turned[0] + turned[1] >= BOTH
        && turned.iter().all(|&t| t >= EACH);
    is_base.then_some([lower % n, upper % n])
}

/// Whether a counter-clockwise ring has a corner or a base at its right end.
pub fn is_edged(ring: &[Point]) -> bool {
    // At a nose with few points the turning is up to some 110°.
    const CORNER: f64 = 120.0 / 180.0 * PI;
    let mut ring = ring.to_vec();
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let wide = bounds_of(ring.iter().copied()).map_or(0.0, |b| b.width());
    ring.len() >= 3 && (turning(&ring, aftmost(&ring)) >= CORNER || base_of(&ring, wide).is_some())
}
