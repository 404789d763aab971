//! What both engines hold while they refine: the domain in the unit frame, its subcurves, the triangles that miss a
//! bound, and how it ends.

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

pub(super) struct Refinement {
    pub domain: Domain,
    /// What the domain was multiplied by, so that its coordinates are of unit magnitude.
    pub scale: f64,
    pub field: SizeField,
    /// No edge shorter than this is made on purpose: as far as rounding moves a point of a curve, twice over.
    pub resolution: f64,
    pub subcurves: Subcurves,
    /// Pieces to be looked at, the latest first: its place is still in the cache.
    pub queue: Vec<SubcurveId>,
    /// Triangles with an angle below κ, and triangles too large.
    pub bad: RefinementQueue,
    pub labeller: RegionLabeller,
    pub cavity: Cavity,
    pub counters: Counters,
    pub reason: StopReason,
    /// Where something could not be done: below what the coordinates can tell apart.
    pub too_near: Vec<Point>,
    /// sin² κ.
    pub sin2_min: f64,
}

/// What is wrong with a triangle.
pub(super) enum Flaw {
    /// An angle below κ: sin² of its smallest.
    Skinny(f64),
    /// So many times over its limits.
    Oversized(f64),
}

impl Refinement {
    /// The domain in the unit frame, none of its curves cut yet.
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

    /// Queues a subcurve, once.
    pub fn enqueue(&mut self, subcurve: SubcurveId) {
        let entry = self.subcurves.get_mut(subcurve);
        if !entry.queued {
            entry.queued = true;
            self.queue.push(subcurve);
        }
    }

    /// Which bound a triangle of a region misses; its angles first.
    pub fn flaw(&self, region: RegionId, corners: [Point; 3]) -> Option<Flaw> {
        let sin2 = sin2_smallest(corners);
        if sin2 < self.sin2_min {
            return Some(Flaw::Skinny(sin2));
        }
        let excess = self.field.excess(region, corners);
        (excess > 1.0).then_some(Flaw::Oversized(excess))
    }

    pub fn cancel(&mut self) {
        if self.reason == StopReason::Done {
            self.reason = StopReason::Cancelled;
        }
    }

    /// How it ended, with so much unresolved at `places`, and where coordinates could not tell points apart, in the domain's
    /// own scale.
    pub fn stop(&self, reason: StopReason, unresolved: usize, places: Vec<Point>) -> Stop {
        let places = places.iter().chain(&self.too_near).map(|&p| geometry::scaled(p, 1.0 / self.scale)).collect();
        Stop { reason, unresolved: unresolved + self.too_near.len(), places, angle_deg: None }
    }

    pub fn too_near_error(&self) -> RefineError {
        RefineError::too_near(self.too_near.first().copied().unwrap_or_default()).scaled(1.0 / self.scale)
    }

    pub fn count_kernel(&mut self, kernel: insert::Counters) {
        self.counters.add("predicates", kernel.orient + kernel.in_circle);
        self.counters.add("exact_fallbacks", kernel.exact_fallbacks);
        self.counters.add("cavity_triangles", kernel.cavity_triangles);
    }
}
