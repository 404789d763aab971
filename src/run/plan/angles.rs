//! The largest attainable minimum angle: what a run does if the requested angle may be more than a drawing allows.
//!
//! Above 30° no engine is proven to end, and the largest angle at which it ends depends on the drawing: 36° for some,
//! less than 33° for others. Above that angle the engine makes as many bad triangles as it removes, and the mesh is
//! worse than one for a smaller angle. So:
//!
//! - Up to [`USUAL_DEG`], where most runs terminate, the engine runs at the requested angle. It stops when the smallest
//!   angle no longer increases ([`Headway`](crate::refine::Headway)). Then the next smaller whole degree is tried, and
//!   so on.
//! - Above it, the engine first runs at [`USUAL_DEG`] and takes N vertices. The requested angle then gets a budget of
//!   [`MORE`]·N. So the whole costs less than 3·N for any angle. A run that ends within the budget gives the same mesh
//!   as without it.
//!
//! *The best mesh* is that of the largest angle at which the engine terminated. The alternative, the state of the
//! failed run with the largest smallest angle, is not better: its angle was half a degree larger, but it did not meet
//! sizes, which are refined after angles. And no command would give that state directly.

use super::Plan;
use crate::domain::Domain;
use crate::plane::lopping::Refined;
use crate::refine::{StopReason, Until};
use crate::run::report::FailureReport;
use crate::watch::{Stopped, Watch};

/// Up to this angle the engine runs at the requested angle at once.
const USUAL_DEG: f64 = 34.0;

/// Up to this angle refinement always ends in practice.
const SURE_DEG: f64 = 30.0;

/// Budget of a larger angle, in parts of the vertices at [`USUAL_DEG`].
const MORE: f64 = 1.9;

impl Plan {
    /// Refines a domain whose curves turn at most τ, to the requested angle or to the largest at which the run ends. In
    /// the second case the reason to stop is [`StopReason::NoProgress`], with the angle.
    ///
    /// # Errors
    /// Where coordinates cannot tell features apart, or the watch says stop before there is a mesh.
    pub fn refine(&self, domain: &Domain, watch: &mut Watch) -> Result<Refined, FailureReport> {
        let asked = self.angle_deg();
        if asked <= USUAL_DEG {
            let refined = self.drive(domain, Until::End, watch)?;
            return match refined.stop.reason {
                StopReason::NoProgress => self.refine_below(asked, refined, domain, watch),
                _ => Ok(refined),
            };
        }
        let usual = self.at_angle(USUAL_DEG).refine(domain, watch)?;
        if usual.stop.reason != StopReason::Done {
            return Ok(usual.held_to(USUAL_DEG));
        }
        self.refine_beyond(usual, domain, watch)
    }

    /// The mesh at the requested angle, if it takes at most [`MORE`] times the vertices of `usual`; else `usual`.
    fn refine_beyond(&self, usual: Refined, domain: &Domain, watch: &mut Watch) -> Result<Refined, FailureReport> {
        let most = self.options.max_vertices;
        let bound = (MORE * usual.vertices as f64) as usize;
        let reason = match self.with_budget(most.min(bound)).drive(domain, Until::End, watch) {
            Ok(refined) if refined.stop.reason == StopReason::Done => return Ok(refined),
            Ok(refined) if refined.stop.reason == StopReason::Cancelled => StopReason::Cancelled,
            Ok(refined) if refined.stop.reason == StopReason::VertexBudget && most <= bound => StopReason::VertexBudget,
            Ok(_) | Err(_) => StopReason::NoProgress,
        };
        let mut best = usual.held_to(USUAL_DEG);
        best.stop.reason = reason;
        Ok(best)
    }

    /// The mesh at the largest whole degree below `hopeless` at which the run ends; else `refined`.
    fn refine_below(
        &self,
        hopeless: f64,
        refined: Refined,
        domain: &Domain,
        watch: &mut Watch,
    ) -> Result<Refined, FailureReport> {
        let mut angle = hopeless.ceil() - 1.0;
        while angle >= SURE_DEG {
            match self.at_angle(angle).drive(domain, Until::End, watch) {
                Ok(mut lower) if lower.stop.reason == StopReason::Done => {
                    lower.stop.reason = StopReason::NoProgress;
                    return Ok(lower.held_to(angle));
                }
                Ok(lower) if lower.stop.reason == StopReason::Cancelled => return Ok(lower.held_to(angle)),
                Ok(_) | Err(_) => angle -= 1.0,
            }
        }
        Ok(refined)
    }

    /// After a run that stopped because coordinates cannot hold a finer mesh: the mesh at a smaller angle, if the angle
    /// may be the reason and a smaller one ends.
    ///
    /// # Errors
    /// As [`Plan::refine`].
    pub fn leave_crowded(
        &self,
        refined: Refined,
        domain: &Domain,
        watch: &mut Watch,
    ) -> Result<Refined, FailureReport> {
        match refined.stop.reason {
            StopReason::Arithmetic => self.refine_below(self.angle_deg().min(USUAL_DEG), refined, domain, watch),
            _ => Ok(refined),
        }
    }

    /// An angle at which the slivers take clearly no more vertices than the budget.
    ///
    /// # Errors
    /// Where the watch says stop.
    pub(super) fn affordable_angle(&self, domain: &Domain, watch: &mut Watch) -> Result<Option<f64>, Stopped> {
        const MARGIN: f64 = 3.0;
        for angle in [15.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.5].into_iter().filter(|&angle| angle < self.angle_deg()) {
            let vertices = self.at_angle(angle).demand(domain, watch)?.vertices();
            if MARGIN * vertices <= self.options.max_vertices as f64 {
                return Ok(Some(angle));
            }
        }
        Ok(None)
    }

    fn angle_deg(&self) -> f64 {
        self.options.angle_min_rad.to_degrees()
    }

    fn at_angle(&self, angle_deg: f64) -> Self {
        let mut plan = self.clone();
        plan.options.angle_min_rad = angle_deg.to_radians();
        if let Some(gcdr) = &mut plan.gcdr {
            gcdr.options.angle_min_rad = angle_deg.to_radians();
        }
        plan
    }

    fn with_budget(&self, max_vertices: usize) -> Self {
        let mut plan = self.clone();
        plan.options.max_vertices = max_vertices;
        if let Some(gcdr) = &mut plan.gcdr {
            gcdr.options.max_vertices = max_vertices;
        }
        plan
    }
}

impl Refined {
    /// Records the angle of the refinement, unless a smaller one is recorded.
    fn held_to(mut self, angle_deg: f64) -> Self {
        self.stop.angle_deg.get_or_insert(angle_deg);
        self
    }
}
