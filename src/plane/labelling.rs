//! The region of each triangle. Labelling is topological: a triangle takes its region from the side of the curve on
//! which it lies, or from a neighbour with no curve between. Nothing is removed: D(P′) stays whole, and triangles
//! outside have no region.
//!
//! Regions are right whenever every subcurve is an edge and no subcurve is encroached. Then no vertex lies between a
//! subcurve and its chord, since the lens lies in the empty diametral disk; so chords separate the same vertices as the
//! curves. Between two such moments only triangles made since need a region. An older triangle keeps its own: the split
//! point of a subcurve that bulges over it would lie in its circumdisk, and so would have removed it.
//!
//! ```text
//!      p─────q        The subcurve x y of the curve c has the region A on its left, B on its right.
//!     ╱ ╲ t₂╱         t₁ lies on the half-edge x→y, along c: its region is A.
//!    ╱ t₁╲ ╱     A    u lies on y→x, against c: its region is B.
//!   x──c─▶y           t₂ lies on no subcurve. Its neighbour t₁, across no subcurve, has A: so has t₂.
//!    ╲ u ╱       B
//!     ╲ ╱
//!      r
//! ```

use super::insert::Kernel;
use super::subcurves::{Carrier, Subcurves};
use super::triangulation::HalfEdge;
use crate::domain::DomainCurve;
use crate::ids::{CurveId, Id, IdVec, RegionId, TriangleId};

/// Gives regions to triangles.
#[derive(Default)]
pub struct RegionLabeller {
    /// By triangle: its place in `fresh`, counted from 1; 0 for all others, and for all between two calls.
    places: Vec<u32>,
}

impl RegionLabeller {
    /// Gives regions to the triangles in `fresh`, those made since the last call. Leaves those in `fresh` that
    /// still exist, each once.
    pub fn label(
        &mut self,
        delaunay: &mut Kernel,
        subcurves: &Subcurves,
        curves: &IdVec<CurveId, DomainCurve>,
        fresh: &mut Vec<TriangleId>,
    ) {
        self.note(delaunay, fresh);
        let mut known = vec![false; fresh.len()];
        let mut stack: Vec<usize> = Vec::new();
        for i in 0..fresh.len() {
            if let Some(region) = self.region_by_sides(delaunay, subcurves, curves, fresh[i]) {
                delaunay.topology_mut().set_region(fresh[i], region);
                known[i] = true;
                stack.push(i);
            }
        }
        while let Some(i) = stack.pop() {
            let region = delaunay.topology().region(fresh[i]);
            for s in sides_of(fresh[i]) {
                let beyond = delaunay.topology().twin(s).triangle();
                let Some(j) = self.place(beyond) else { continue };
                if !known[j] && bounded_by(delaunay, subcurves, s).is_none() {
                    delaunay.topology_mut().set_region(beyond, region);
                    known[j] = true;
                    stack.push(j);
                }
            }
        }
        fresh.iter().for_each(|t| self.places[t.index()] = 0);
    }

    /// Leaves each triangle of `fresh` that still exists once, in the order of ids, and notes its place.
    fn note(&mut self, delaunay: &Kernel, fresh: &mut Vec<TriangleId>) {
        fresh.sort_unstable();
        fresh.dedup();
        fresh.retain(|&t| delaunay.topology().is_alive(t));
        self.places.resize(delaunay.topology().triangle_capacity(), 0);
        for (i, t) in fresh.iter().enumerate() {
            self.places[t.index()] = i as u32 + 1;
        }
    }

    fn place(&self, t: TriangleId) -> Option<usize> {
        (self.places[t.index()] as usize).checked_sub(1)
    }

    /// The region of a triangle by its half-edges: from a subcurve on one, or from a neighbour that is not fresh.
    fn region_by_sides(
        &self,
        delaunay: &Kernel,
        subcurves: &Subcurves,
        curves: &IdVec<CurveId, DomainCurve>,
        t: TriangleId,
    ) -> Option<Option<RegionId>> {
        let topology = delaunay.topology();
        if topology.is_ghost(t) {
            return Some(None);
        }
        sides_of(t).into_iter().find_map(|s| match bounded_by(delaunay, subcurves, s) {
            Some((curve, along)) => Some(curves[curve].sides[usize::from(!along)]),
            None => {
                let beyond = topology.twin(s).triangle();
                self.place(beyond).is_none().then(|| topology.region(beyond))
            }
        })
    }
}

/// The curve on a half-edge, and whether the half-edge runs along it (`true`) or against it; `None` where there is no
/// curve. A corner arc bounds no region.
fn bounded_by(delaunay: &Kernel, subcurves: &Subcurves, s: HalfEdge) -> Option<(CurveId, bool)> {
    let subcurve = subcurves.get(delaunay.topology().subcurve(s)?);
    let Carrier::Curve(curve) = subcurve.carrier else { return None };
    Some((curve, delaunay.topology().origin(s) == subcurve.ends[0]))
}

/// Every triangle, ghosts included, for the first labelling.
pub fn all_triangles(delaunay: &Kernel) -> Vec<TriangleId> {
    let topology = delaunay.topology();
    (0..topology.triangle_capacity()).map(TriangleId::from_index).filter(|&t| topology.is_alive(t)).collect()
}

fn sides_of(t: TriangleId) -> [HalfEdge; 3] {
    [0, 1, 2].map(|i| t.side_of(i))
}
