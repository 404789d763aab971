//! The largest smallest angle: what is done where the one asked for may be beyond what a drawing allows.
//!
//! Above 30° no engine is proven to end, and up to what angle it does depends on the drawing: some reach 36°, some not
//! 33°. Beyond, the engine makes as many bad triangles as it removes, and what it leaves is worse than what a smaller
//! angle would have given. So:
//!
//! - Up to [`USUAL_DEG`], where most runs end, the engine runs as it is asked to. It stops by itself where angles do
//!   not get larger any more ([`Headway`](crate::refine::Headway)); then the next smaller whole degree is tried, and so
//!   on.
//! - Beyond it, the engine runs at [`USUAL_DEG`] first. What that takes, N vertices, is the measure: the angle asked
//!   for gets [`MORE`]·N. So the whole costs less than 3·N, whatever the angle, and where it ends within that it gives
//!   the mesh that it always gave.
//!
//! *The best mesh* is that of the largest angle that ended. The state in which the hopeless run had its smallest angle
//! largest is no better: it held half a degree more, but sizes, which come after angles, were not met in it; and
//! nothing could be typed that gives it again without the detour.

use super::Plan;
use crate::domain::Domain;
use crate::plane::lopping::Refined;
use crate::refine::{StopReason, Until};
use crate::run::report::FailureReport;
use crate::watch::{Stopped, Watch};

/// Up to this angle the engine is asked at once.
const USUAL_DEG: f64 = 34.0;

/// Up to this angle refinement always ends in practice.
const SURE_DEG: f64 = 30.0;

/// Vertices that an angle beyond [`USUAL_DEG`] may take, those of [`USUAL_DEG`] being 1.
const MORE: f64 = 1.9;

impl Plan {
    /// Refines a domain whose curves turn at most τ: to the angle asked for, or to the largest of which the run ends.
    /// Then the reason to stop is [`StopReason::NoProgress`], and the angle stands beside it.
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

    /// The angle asked for, within a few times the vertices that the usual one took; else the mesh of that.
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

    /// The mesh of the largest whole degree below `hopeless` of which the run ends; of none, as `refined` ended.
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

    /// What ended where coordinates cannot hold a finer mesh, at an angle that may be the reason: the mesh of one that
    /// ends, where there is one.
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

    /// An angle of which the slivers take no more vertices than there are, by some margin.
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
    /// Notes the angle that it was refined to, where no smaller one is noted.
    fn held_to(mut self, angle_deg: f64) -> Self {
        self.stop.angle_deg.get_or_insert(angle_deg);
        self
    }
}
