//! Triangles that miss a bound, in the order in which both engines refine them: skinny ones, worst first; then those
//! that are too large.

use super::insert::Kernel;
use super::triangulation::Triangulation;
use crate::geometry::Point;
use crate::ids::{TriangleId, VertexId};
use crate::refine::{Headway, Patience, WorstFirst};
use std::f64::consts::PI;

/// A triangle as it was when it was queued: a triangle's id may be another's by now.
pub(super) type Candidate = (TriangleId, [VertexId; 3]);

pub(super) fn is_stale(topology: &Triangulation, &(t, corners): &Candidate) -> bool {
    !topology.is_alive(t) || topology.corners(t) != corners
}

/// Up to this angle refinement always ends in practice, and is left to its budget.
const SURE_RAD: f64 = PI / 6.0;

/// What the drawing's own detail costs is spent when no angle is smaller than this, κ in practice.
pub(super) const DETAIL_RAD: f64 = 0.3613;

/// How long angles may take to get larger, at angles beyond [`SURE_RAD`], where the smallest comes first: `badness` is
/// that of [`DETAIL_RAD`]. Of some 90 drawings that end at 34°, none needs more than 3.3 times its vertices to get on.
pub(super) fn by_angle(badness: f64) -> Patience {
    Patience { growth: 8.0, mild: badness, relapse: 0.0 }
}

/// The same where what is shortest comes first, by badness of so much an octave: what does not end makes ever shorter
/// edges.
pub(super) fn by_length(octave: f64) -> Patience {
    Patience { growth: 4.0, mild: 1.0, relapse: 3.0 * octave }
}

#[derive(Default)]
pub(super) struct RefinementQueue {
    skinny: WorstFirst<Candidate>,
    oversized: WorstFirst<Candidate>,
    headway: Option<Headway>,
    stuck: bool,
}

impl RefinementQueue {
    /// A queue for a smallest angle, and how long that may take.
    pub(super) fn new(angle_min_rad: f64, patience: Patience) -> Self {
        let headway = (angle_min_rad > SURE_RAD + 1e-9).then(|| Headway::new(patience));
        Self { headway, ..Self::default() }
    }

    pub(super) fn push_skinny(&mut self, candidate: Candidate, badness: f64) {
        self.skinny.push(candidate, badness);
    }

    /// `excess`: how many times it is over its limits. Badness by octaves: 2^32 is as bad as it gets.
    pub(super) fn push_oversized(&mut self, candidate: Candidate, excess: f64) {
        self.oversized.push(candidate, libm::log2(excess) / 32.0);
    }

    /// The next triangle of a mesh with so many vertices.
    pub(super) fn next(&mut self, vertices: usize) -> Option<Candidate> {
        let skinny = self.skinny.pop();
        if let Some(headway) = &mut self.headway {
            match skinny {
                Some(_) => self.stuck = !headway.goes_on(self.skinny.badness(), vertices),
                None => headway.rest(vertices),
            }
        }
        skinny.or_else(|| self.oversized.pop())
    }

    /// Whether angles do not get larger any more.
    pub(super) fn is_stuck(&self) -> bool {
        self.stuck
    }

    fn pop(&mut self) -> Option<Candidate> {
        self.skinny.pop().or_else(|| self.oversized.pop())
    }

    pub(super) fn len(&self) -> usize {
        self.skinny.len() + self.oversized.len()
    }

    /// Empties the queue: how many still stand, and the places of at most some of them.
    pub(super) fn unresolved(&mut self, delaunay: &Kernel, most: usize) -> (usize, Vec<Point>) {
        let (mut unresolved, mut places) = (0, Vec::new());
        while let Some(candidate) = self.pop() {
            if is_stale(delaunay.topology(), &candidate) {
                continue;
            }
            unresolved += 1;
            if places.len() < most {
                places.push(delaunay.point(candidate.1[0]));
            }
        }
        (unresolved, places)
    }
}
