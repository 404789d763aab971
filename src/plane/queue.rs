//! The refinement queue of both engines: triangles that miss a bound, in the order in which they are refined.
//!
//! ```text
//!   push_skinny(badness)   ──▶ skinny,    worst first ──┐
//!                                                       ├──▶ next(vertices): skinny ones first
//!   push_oversized(excess) ──▶ oversized, worst first ──┘
//! ```

use super::insert::Kernel;
use super::triangulation::Triangulation;
use crate::geometry::Point;
use crate::ids::{TriangleId, VertexId};
use crate::refine::{Headway, Patience, WorstFirst};
use std::f64::consts::PI;

/// A triangle and its corners when it was queued: the id may belong to another triangle since.
pub(super) type Candidate = (TriangleId, [VertexId; 3]);

/// Whether a queued triangle has been removed since.
pub(super) fn is_stale(topology: &Triangulation, &(t, corners): &Candidate) -> bool {
    !topology.is_alive(t) || topology.corners(t) != corners
}

/// Up to this angle refinement always ends in practice, and only the budget limits it. Radians.
const SURE_RAD: f64 = PI / 6.0;

/// Once no angle is smaller than this, the detail of the drawing itself is resolved. It is the κ that ends in practice,
/// in radians.
pub(super) const DETAIL_RAD: f64 = 0.3613;

/// The patience beyond [`SURE_RAD`] where the smallest angle comes first: `badness` is that of [`DETAIL_RAD`]. Of some
/// 90 drawings that end at 34°, none needs more than 3.3 times its vertices for the next progress.
pub(super) fn by_angle(badness: f64) -> Patience {
    Patience { growth: 8.0, mild: badness, relapse: 0.0 }
}

/// The patience where the shortest edge or smallest circle comes first; `octave` is the badness of an octave of length.
/// A refinement that does not end makes ever shorter edges.
pub(super) fn by_length(octave: f64) -> Patience {
    Patience { growth: 4.0, mild: 1.0, relapse: 3.0 * octave }
}

/// Triangles that miss a bound, and whether their refinement makes progress.
#[derive(Default)]
pub(super) struct RefinementQueue {
    skinny: WorstFirst<Candidate>,
    oversized: WorstFirst<Candidate>,
    headway: Option<Headway>,
    stuck: bool,
}

impl RefinementQueue {
    /// The empty queue for a smallest angle (radians), with the patience for it.
    pub(super) fn new(angle_min_rad: f64, patience: Patience) -> Self {
        let headway = (angle_min_rad > SURE_RAD + 1e-9).then(|| Headway::new(patience));
        Self { headway, ..Self::default() }
    }

    /// Queues a triangle with an angle below κ; `badness` from 0 (mild) to 1 (worst).
    pub(super) fn push_skinny(&mut self, candidate: Candidate, badness: f64) {
        self.skinny.push(candidate, badness);
    }

    /// Queues a triangle that is `excess` times its largest permitted size. Badness grows by octaves, to 1 at 2^32.
    pub(super) fn push_oversized(&mut self, candidate: Candidate, excess: f64) {
        self.oversized.push(candidate, libm::log2(excess) / 32.0);
    }

    /// Removes the next triangle; `vertices`: how many the mesh has now.
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

    /// Whether there is no progress any more: refinement is given up.
    pub(super) fn is_stuck(&self) -> bool {
        self.stuck
    }

    fn pop(&mut self) -> Option<Candidate> {
        self.skinny.pop().or_else(|| self.oversized.pop())
    }

    /// Number of queued triangles, stale ones included.
    pub(super) fn len(&self) -> usize {
        self.skinny.len() + self.oversized.len()
    }

    /// Empties the queue. Returns how many of its triangles still exist, and a corner of each of the first `most` of
    /// them.
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
