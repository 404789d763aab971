//! Healing: the choice of the tolerance, if the request gives none.
//!
//! **The rule.** A drawing is welded within 1e-9 of its diagonal. If it was drawn hastily, traced twice or rounded, it
//! then has hair gaps. A mesh with good angles needs about l/w triangles along a gap of length l and width w. So,
//! without a given tolerance:
//!
//! - A *sketch* ([`Drawing::sketch`]: SVG artwork, by the digits of its numbers) is welded within the least of 1e-6,
//!   1e-5 and 1e-4 of its diagonal at which slivers take few vertices, if they would take many at 1e-9. Its areas may
//!   change by a thousandth.
//! - Any other drawing is welded within 1e-6 if the slivers narrower than that would take tens of thousands of vertices
//!   and areas change by at most 1e-8. So exact drawings stay exact, or the estimate refuses them.
//! - With `--min-edge H` nothing finer than H needs to be meshed. Then any drawing is a sketch, up to a tolerance of
//!   H/3. (A loop survives if it is longer than three tolerances.)
//! - If features are nearer to each other than coordinates can distinguish, the run is repeated with the next coarser
//!   one of these tolerances, under the same bound on areas. A sketch that cannot be arranged is repeated likewise. Any
//!   other drawing is refused then: without an arrangement there are no areas to compare with.
//!
//! ```text
//!     tolerance, in parts of the diagonal:      1e-9        1e-6      1e-5      1e-4      H/3
//!     a sketch                                   ●──────────▶●────────▶●────────▶●┄┄┄┄┄┄┄▶●   areas change ≤ 1e-3
//!     any other drawing                          ●──────────▶●                                areas change ≤ 1e-8
//!
//!     ▶ taken if slivers take too many vertices, or if an engine cannot distinguish features    ┄ with --min-edge H
//! ```
//!
//! A raised tolerance is the first repair of the list ([`RepairKind::ToleranceRaised`]).

use super::report::{FailureKind, FailureReport};
use super::request::{Keep, Overlap, Request};
use crate::domain::{ArrangeOptions, Domain, Drawing, Repair, RepairKind, Unarranged};
use crate::geometry::Point;
use crate::size::estimate::{Sliver, costly_slivers};
use crate::watch::{Stopped, Watch};
use std::collections::BTreeMap;

/// Tolerances of sketches, as parts of the diagonal.
const SKETCH: [f64; 3] = [1e-6, 1e-5, 1e-4];

/// The tolerance of other drawings.
const EXACT: f64 = 1e-6;

/// Largest estimated number of vertices at slivers of a sketch, and an addition for each curve. Runs take about fifty
/// times as many.
const SKETCH_VERTICES: [f64; 2] = [500.0, 0.125];

/// The same for other drawings.
const EXACT_VERTICES: [f64; 2] = [50_000.0, 0.0];

/// Largest change of the areas of a sketch by welding, in sum, as a part of its area. A sketch that would lose more
/// consists of slivers.
const SKETCH_AREA: f64 = 1e-3;

/// The same for other drawings. Common walls of cells that were computed twice differ by about 1e-9 of the area.
const EXACT_AREA: f64 = 1e-8;

/// A coarser tolerance is taken only if it reduces the vertices at slivers to this part.
const WORTH: f64 = 0.5;

/// Slivers are counted up to this multiple of the number that is enough.
const COUNTED: f64 = 64.0;

/// Finds the tolerance at which a drawing becomes a domain.
pub struct Healing<'a> {
    /// The drawing.
    pub drawing: &'a Drawing,
    /// The request.
    pub request: &'a Request,
    /// Coarser tolerances that may be tried, in order.
    left: Vec<f64>,
    /// The last one taken; 0 before.
    taken: f64,
    /// Areas of the kept regions, by name, at the finest tolerance that gave a domain.
    areas: Option<Areas>,
}

/// Areas by name. Numbers of fragments differ between domains, so names are used instead of ids.
type Areas = BTreeMap<String, f64>;

/// The reason for a coarser tolerance.
struct Why {
    at: Point,
    what: String,
}

/// A domain, and the least number of vertices at its slivers; infinite if they are too many to count.
struct Candidate {
    domain: Domain,
    vertices: f64,
}

impl<'a> Healing<'a> {
    /// All tolerances that may be tried for a drawing.
    pub fn new(drawing: &'a Drawing, request: &'a Request) -> Self {
        let diagonal = drawing.bounds().map_or(0.0, |b| libm::hypot(b.width(), b.height()));
        let simplified = request.limits.min_edge.map(|edge| edge / 3.0);
        let parts = if drawing.sketch { &SKETCH[..] } else { &[EXACT] };
        let mut left: Vec<f64> = parts.iter().map(|part| part * diagonal).chain(simplified).collect();
        left.retain(|&t| 0.0 < t && t < diagonal / 4.0 && request.tolerance.is_none());
        left.sort_by(f64::total_cmp);
        Self { drawing, request, left, taken: 0.0, areas: None }
    }

    fn is_sketch(&self) -> bool {
        self.drawing.sketch || self.request.limits.min_edge.is_some()
    }

    /// The drawing at the tolerance of the request, or at the finest one that is good enough.
    ///
    /// # Errors
    /// Where no tolerance gives a domain: the error of the finest one. Where there is nothing to mesh, or the watch
    /// says stop.
    pub fn arrange(&mut self, watch: &mut Watch) -> Result<Domain, FailureReport> {
        let domain = match self.arrange_within(self.request.tolerance, watch) {
            Ok(domain) if domain.regions().is_empty() => return Err(no_region()),
            Ok(domain) => domain,
            Err(Unarranged::Invalid(error)) if error.near && self.is_sketch() => {
                let why = Why { at: error.at, what: error.what.clone() };
                return self.coarser(None, &why, watch)?.ok_or_else(|| error.into());
            }
            Err(why) => return Err(why.into()),
        };
        if self.left.is_empty() {
            return Ok(domain);
        }
        self.areas = Some(areas(&domain));
        let slivers = self.slivers(&domain, self.left[0], watch)?;
        let finest = self.candidate(domain, &slivers);
        let Some((_, dearest)) = slivers.iter().max_by(|a, b| a.0.total_cmp(&b.0)).filter(|_| !self.will_do(&finest))
        else {
            return Ok(finest.domain);
        };
        // Slivers wider than a tolerance stay. The first tolerance to try is the finest one at which few vertices stay,
        // or so many that no coarser one is worth it. The rest follows.
        let stay = |within: f64| slivers.iter().filter(|(_, s)| s.width >= within).map(|(n, _)| n).sum::<f64>();
        let few = self.left.last().map_or(0.0, |&coarsest| stay(coarsest) / WORTH).max(self.enough(&finest.domain));
        let (mut first, mut last): (Vec<f64>, Vec<f64>) = self.left.iter().partition(|&&within| stay(within) <= few);
        last.reverse();
        first.extend(last);
        self.left = first;
        let what = format!("slivers between curves would take {:.1e} vertices or more", sum(&slivers));
        let why = Why { at: dearest.at, what };
        Ok(self.coarser(Some(finest), &why, watch)?.expect("there was one to begin with"))
    }

    /// The drawing at the next coarser tolerance, after an engine failed with `failure`; `None` where there is none
    /// left.
    ///
    /// # Errors
    /// Where the watch says stop.
    pub fn retreat(&mut self, failure: &FailureReport, watch: &mut Watch) -> Result<Option<Domain>, FailureReport> {
        let [x, y] = failure.at.and_then(|at| at.in_plane()).unwrap_or_default();
        self.left.retain(|&tolerance| tolerance != self.taken);
        self.coarser(None, &Why { at: Point::new(x, y), what: failure.what.clone() }, watch)
    }

    /// The drawing at a tolerance that the request does not ask for; `None` where that leaves nothing to mesh.
    ///
    /// # Errors
    /// Where the watch says stop.
    pub fn welded(&self, tolerance: f64, watch: &mut Watch) -> Result<Option<Domain>, Stopped> {
        match self.arrange_within(Some(tolerance), watch) {
            Ok(domain) => Ok(Some(domain).filter(|domain| !domain.regions().is_empty())),
            Err(Unarranged::Invalid(_)) => Ok(None),
            Err(Unarranged::Stopped(stopped)) => Err(stopped),
        }
    }

    /// The first domain, at increasing tolerances, whose slivers take few enough vertices; else the one with the
    /// fewest.
    fn coarser(
        &mut self,
        mut best: Option<Candidate>,
        why: &Why,
        watch: &mut Watch,
    ) -> Result<Option<Domain>, FailureReport> {
        for tolerance in self.left.clone() {
            if best.is_some() && tolerance < self.taken {
                // A finer tolerance leaves more slivers than the best one so far.
                break;
            }
            let mut domain = match self.arrange_within(Some(tolerance), watch) {
                Ok(domain) if self.is_alike(&domain) => domain,
                Ok(_) | Err(Unarranged::Invalid(_)) => continue,
                Err(stopped) => return Err(stopped.into()),
            };
            domain.itemise_first(why.repair(tolerance));
            let slivers = self.slivers(&domain, 0.0, watch)?;
            let candidate = self.candidate(domain, &slivers);
            if self.will_do(&candidate) {
                self.taken = tolerance;
                return Ok(Some(candidate.domain));
            }
            if best.as_ref().is_none_or(|best| candidate.vertices <= WORTH * best.vertices) {
                self.taken = tolerance;
                best = Some(candidate);
            }
        }
        Ok(best.map(|best| best.domain))
    }

    fn candidate(&self, domain: Domain, slivers: &[(f64, Sliver)]) -> Candidate {
        let vertices = sum(slivers);
        let counted = vertices <= COUNTED * self.enough(&domain);
        Candidate { domain, vertices: if counted { vertices } else { f64::INFINITY } }
    }

    fn will_do(&self, candidate: &Candidate) -> bool {
        candidate.vertices <= self.enough(&candidate.domain)
    }

    fn enough(&self, domain: &Domain) -> f64 {
        let [few, per_curve] = if self.is_sketch() { SKETCH_VERTICES } else { EXACT_VERTICES };
        few + per_curve * domain.curves().len() as f64
    }

    /// The slivers of a domain: all of them, or more than are counted. Those that stay when welding within `above` are
    /// also counted up to that number, so that the effect of welding is known.
    fn slivers(&self, domain: &Domain, above: f64, watch: &mut Watch) -> Result<Vec<(f64, Sliver)>, Stopped> {
        costly_slivers(domain, self.request.angle_min_rad(), COUNTED * self.enough(domain), above, watch)
    }

    /// Whether the areas of the regions are those at the finest tolerance, within the bound.
    fn is_alike(&self, domain: &Domain) -> bool {
        let Some(finest) = &self.areas else { return !domain.regions().is_empty() };
        let part = if self.is_sketch() { SKETCH_AREA } else { EXACT_AREA };
        let mut moved = areas(domain);
        finest.iter().for_each(|(name, area)| *moved.entry(name.clone()).or_default() -= area);
        moved.values().map(|change| change.abs()).sum::<f64>() <= part * finest.values().sum::<f64>()
    }

    fn arrange_within(&self, tolerance: Option<f64>, watch: &mut Watch) -> Result<Domain, Unarranged> {
        let options = ArrangeOptions {
            tolerance,
            fill: self.request.fill_rule.rule(),
            keep_all: self.request.keep == Keep::All,
            fragments: self.request.overlap == Overlap::Fragment,
            close: self.request.close,
            loose: self.request.loose,
            raised: self.request.tolerance.is_none(),
        };
        self.drawing.arrange_watched(&options, watch)
    }
}

fn sum(slivers: &[(f64, Sliver)]) -> f64 {
    slivers.iter().map(|(vertices, _)| vertices).sum()
}

fn areas(domain: &Domain) -> Areas {
    let mut areas = Areas::new();
    let mut unnamed = 0;
    for region in domain.regions().iter() {
        // Regions without a name are matched by size: the largest is the first.
        let name = if region.is_named {
            domain.name(region.name).to_owned()
        } else {
            unnamed += 1;
            format!("\u{0}{unnamed}")
        };
        *areas.entry(name).or_default() += region.area;
    }
    areas
}

impl Why {
    fn repair(&self, tolerance: f64) -> Repair {
        Repair {
            kind: RepairKind::ToleranceRaised,
            at: [self.at.x, self.at.y],
            size: tolerance,
            what: format!("{}: all was welded within {tolerance:.2e}", self.what),
        }
    }
}

fn no_region() -> FailureReport {
    let help = "close the outline, name another --fill-rule, or mesh everything by --keep all";
    FailureReport::new(FailureKind::Geometry, "nothing to mesh: the curves enclose no kept region", help)
}
