//! The state that both engines share: the domain in the unit frame, its subcurves, the triangles that miss a bound, and
//! the reason to stop.

use super::insert::{self, Cavity};
use super::labelling::RegionLabeller;
use super::queue::RefinementQueue;
use super::refined::RefineError;
use super::subcurves::Subcurves;
use crate::domain::Domain;
use crate::geometry::triangle::sin2_smallest;
use crate::geometry::{self, Point};
use crate::ids::{RegionId, SubcurveId};
use crate::mesh::RIM_ROUNDING;
use crate::refine::{Counters, Patience, Stop, StopReason};
use crate::size::{SizeField, Sizing};

/// The state of a refinement, apart from the triangulation.
pub(super) struct Refinement {
    /// The domain in the unit frame.
    pub domain: Domain,
    /// The factor of the unit frame, a power of two: the domain was multiplied by it, so that its coordinates are of
    /// unit magnitude.
    pub scale: f64,
    /// The size limits, in the unit frame.
    pub field: SizeField,
    /// No split makes an edge shorter than this, a bound on how far rounding moves a point of a curve. In the unit
    /// frame.
    pub resolution: f64,
    /// C′.
    pub subcurves: Subcurves,
    /// Subcurves to be tested. The last one is taken first, since its surroundings are still in the cache.
    pub queue: Vec<SubcurveId>,
    /// The refinement queue: triangles with an angle below κ, and triangles too large.
    pub bad: RefinementQueue,
    /// Gives regions to new triangles.
    pub labeller: RegionLabeller,
    /// The cavity of the point under test; kept to reuse its memory.
    pub cavity: Cavity,
    /// Amounts of work, by name.
    pub counters: Counters,
    /// Why refinement stops; `Done` as long as it goes on.
    pub reason: StopReason,
    /// Places where a step was not possible, because coordinates cannot separate its points.
    pub too_near: Vec<Point>,
    /// sin² κ.
    pub sin2_min: f64,
}

/// The bound that a triangle misses.
pub(super) enum Flaw {
    /// An angle below κ: sin² of its smallest.
    Skinny(f64),
    /// Its size over the largest size permitted, above 1.
    Oversized(f64),
}

impl Refinement {
    /// The domain in the unit frame, with no subcurves so far. `angle_min_rad` is κ.
    pub fn new(domain: &Domain, sizing: &Sizing, angle_min_rad: f64, patience: Patience) -> Self {
        let magnitude = geometry::magnitude(domain.bounds());
        let scale = geometry::unit_scale(magnitude);
        let domain = domain.scaled(scale);
        let sin_min = libm::sin(angle_min_rad);
        Self {
            field: SizeField::new(&sizing.scaled(scale), &domain),
            domain,
            scale,
            resolution: RIM_ROUNDING * magnitude * scale,
            subcurves: Subcurves::default(),
            queue: Vec::new(),
            bad: RefinementQueue::new(angle_min_rad, patience),
            labeller: RegionLabeller::default(),
            cavity: Cavity::default(),
            counters: Counters::default(),
            reason: StopReason::Done,
            too_near: Vec::new(),
            sin2_min: sin_min * sin_min,
        }
    }

    /// Queues a subcurve that is not queued already.
    pub fn enqueue(&mut self, subcurve: SubcurveId) {
        let entry = self.subcurves.get_mut(subcurve);
        if !entry.queued {
            entry.queued = true;
            self.queue.push(subcurve);
        }
    }

    /// The bound that a triangle of a region misses, the angle first; `None` where it meets all.
    pub fn flaw(&self, region: RegionId, corners: [Point; 3]) -> Option<Flaw> {
        let sin2 = sin2_smallest(corners);
        if sin2 < self.sin2_min {
            return Some(Flaw::Skinny(sin2));
        }
        let excess = self.field.excess(region, corners);
        (excess > 1.0).then_some(Flaw::Oversized(excess))
    }

    /// Stops the refinement of triangles, unless there is a reason already.
    pub fn cancel(&mut self) {
        if self.reason == StopReason::Done {
            self.reason = StopReason::Cancelled;
        }
    }

    /// The end of the refinement for a reason, in the domain's own scale: what is `unresolved`, with some `places`, and
    /// the places of [`too_near`](Self::too_near).
    pub fn stop(&self, reason: StopReason, unresolved: usize, places: Vec<Point>) -> Stop {
        let places = places.iter().chain(&self.too_near).map(|&p| geometry::scaled(p, 1.0 / self.scale)).collect();
        Stop { reason, unresolved: unresolved + self.too_near.len(), places, angle_deg: None }
    }

    /// The error of a run that ended because coordinates cannot separate points, with the first such place.
    pub fn too_near_error(&self) -> RefineError {
        RefineError::too_near(self.too_near.first().copied().unwrap_or_default()).scaled(1.0 / self.scale)
    }

    /// Adds the kernel's counters to those of the run.
    pub fn count_kernel(&mut self, kernel: insert::Counters) {
        self.counters.add("predicates", kernel.orient + kernel.in_circle);
        self.counters.add("exact_fallbacks", kernel.exact_fallbacks);
        self.counters.add("cavity_triangles", kernel.cavity_triangles);
    }
}
