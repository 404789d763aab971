//! A lower bound on the vertices that a request takes, before an engine starts, and a remedy where they are too many.

use super::{Plan, no_mesh};
use crate::domain::Domain;
use crate::refine::{Stop, StopReason};
use crate::run::healing::Healing;
use crate::run::report::FailureReport;
use crate::watch::Watch;

/// Tolerances to try against expensive slivers, as multiples of their estimated width. The estimate is at most the true
/// width.
const WELDS: [f64; 4] = [2.0, 4.0, 8.0, 16.0];

impl Plan {
    /// Refuses a request that takes more vertices than the budget.
    ///
    /// # Errors
    /// With the most expensive places and a remedy. Also where the watch says stop.
    pub fn afford(&self, domain: &Domain, healing: &Healing, watch: &mut Watch) -> Result<(), FailureReport> {
        let demand = self.demand(domain, watch)?;
        let (vertices, budget) = (demand.vertices(), self.options.max_vertices as f64);
        if vertices <= budget {
            return Ok(());
        }
        let unresolved = (vertices - budget) as usize;
        let stop = Stop { reason: StopReason::VertexBudget, unresolved, places: demand.places(), angle_deg: None };
        let (why, help) = if demand.by_size >= demand.by_slivers() {
            ("the sizes asked for", "ask for larger sizes, or allow more by --max-vertices".to_owned())
        } else {
            ("slivers between curves", self.out_of_slivers(domain, demand.width_over(budget), healing, watch)?)
        };
        let what = format!("{why} take {vertices:.3e} vertices or more");
        Err(FailureReport { what, help, ..no_mesh(&stop, "--max-vertices") })
    }

    /// The finest tolerance at which slivers take few enough vertices, else an angle at which they do.
    fn out_of_slivers(
        &self,
        domain: &Domain,
        width: f64,
        healing: &Healing,
        watch: &mut Watch,
    ) -> Result<String, FailureReport> {
        let budget = self.options.max_vertices as f64;
        let mut way = None;
        for within in WELDS.map(|times| rounded(times * width)) {
            let Some(welded) = healing.welded(within, watch)? else { continue };
            let welded = welded.split_to_turning_watched(self.tau_rad, watch)?;
            if self.demand(&welded, watch)?.vertices() <= budget {
                way = Some(format!("weld what is nearer than {within:?} by --tolerance {within:?}, "));
                break;
            }
        }
        let way = match way {
            Some(way) => way,
            None => self
                .affordable_angle(domain, watch)?
                .map_or_else(String::new, |angle| format!("ask for a smaller angle by --min-angle {angle}, ")),
        };
        Ok(format!(
            "curves run that near to each other: {way}leave edges below a length by --min-edge, or allow more by --max-vertices"
        ))
    }
}

/// A length rounded to two digits.
fn rounded(length: f64) -> f64 {
    format!("{length:.1e}").parse().unwrap_or(length)
}
