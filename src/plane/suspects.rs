//! Triangles that miss a bound, in the order in which both engines refine them: skinny ones, worst first; then those that are too large.

use super::insert::Delaunay;
use super::triangulation::Triangulation;
use crate::geometry::Point;
use crate::ids::{TriangleId, VertexId};
use crate::refine::WorstFirst;

/// A triangle as it was when it was queued: a triangle's id may be another's by now.
pub(super) type Suspect = (TriangleId, [VertexId; 3]);

pub(super) fn is_stale(topology: &Triangulation, &(t, corners): &Suspect) -> bool {
    !topology.is_alive(t) || topology.corners(t) != corners
}

#[derive(Default)]
pub(super) struct Suspects {
    skinny: WorstFirst<Suspect>,
    oversized: WorstFirst<Suspect>,
}

impl Suspects {
    pub(super) fn push_skinny(&mut self, suspect: Suspect, badness: f64) {
        self.skinny.push(suspect, badness);
    }

    /// `excess`: how many times it is over its limits. Badness by octaves: 2^32 is as bad as it gets.
    pub(super) fn push_oversized(&mut self, suspect: Suspect, excess: f64) {
        self.oversized.push(suspect, libm::log2(excess) / 32.0);
    }

    pub(super) fn pop(&mut self) -> Option<Suspect> {
        self.skinny.pop().or_else(|| self.oversized.pop())
    }

    pub(super) fn len(&self) -> usize {
        self.skinny.len() + self.oversized.len()
    }

    /// Empties the queue: how many still stand, and the places of at most some of them.
    pub(super) fn owed(&mut self, delaunay: &Delaunay, most: usize) -> (usize, Vec<Point>) {
        let (mut owed, mut places) = (0, Vec::new());
        while let Some(suspect) = self.pop() {
            if is_stale(delaunay.topology(), &suspect) {
                continue;
            }
            owed += 1;
            if places.len() < most {
                places.push(delaunay.point(suspect.1[0]));
            }
        }
        (owed, places)
    }
}
