//! How coarsely a drawing is welded where nobody said: the tolerances that are tried, and the one that is taken.
//!
//! **The rule.** A drawing is welded within 1e-9 of its diagonal. Drawn hastily, traced twice or rounded, it has hair
//! gaps then, and a mesh with good angles takes as many triangles along a gap as it is longer than wide. So, unless a
//! tolerance was given:
//!
//! - A *sketch* ([`Drawing::sketch`]: an SVG picture whose numbers have the digits of a picture) is welded within the
//!   least of 1e-6, 1e-5 and 1e-4 of its diagonal that leaves slivers of few vertices, where those of the finer weld
//!   would take many; its area may change by a thousandth.
//! - Any other drawing is welded within 1e-6 where the slivers narrower than that would take tens of thousands of
//!   vertices, and its area changes by no more than 1e-8 of it: exact work stays exact, or is refused by the estimate.
//! - `--min-edge H` says that nothing finer than H needs to be meshed: any drawing is a sketch of a third of it (a loop
//!   is safe from three tolerances on).
//! - What cannot be meshed because its features lie nearer to each other than the coordinates can tell apart is tried
//!   again within the next coarser one of these tolerances, under the same limit to its area; a sketch that cannot be
//!   arranged is, too. Exact work is refused instead: of what was never arranged nobody knows what welding changes.
//!
//! That it was done is the first repair of the list ([`RepairKind::ToleranceRaised`]), with the tolerance taken.

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

/// Estimated vertices of slivers that a sketch may have, and more for each of its curves. Runs take some fifty times as
/// many.
const SKETCH_VERTICES: [f64; 2] = [500.0, 0.125];

/// The same of other drawings.
const EXACT_VERTICES: [f64; 2] = [50_000.0, 0.0];

/// Part of the whole area by which welding may change the regions of a sketch in sum: what loses more consists of
/// slivers.
const SKETCH_AREA: f64 = 1e-3;

/// The same of other drawings: cells whose common walls were computed twice miss each other by some 1e-9 of it.
const EXACT_AREA: f64 = 1e-8;

/// A coarser tolerance must lessen the vertices of slivers to this part to be worth it.
const WORTH: f64 = 0.5;

/// Slivers are counted up to so many times what will do.
const COUNTED: f64 = 64.0;

/// A drawing on its way to a domain within the right tolerance.
pub struct Healing<'a> {
    pub drawing: &'a Drawing,
    pub request: &'a Request,
    /// Coarser tolerances that may be taken, in the order in which they are tried.
    left: Vec<f64>,
    /// The one that was taken last; 0 before.
    taken: f64,
    /// Areas of the kept regions, by name, within the finest tolerance that was arranged.
    areas: Option<Areas>,
}

/// By the name itself: those of fragments are numbered as each domain comes upon them.
type Areas = BTreeMap<String, f64>;

/// What asks for a coarser tolerance.
struct Why {
    at: Point,
    what: String,
}

/// A domain, and the vertices that its slivers take at least; infinite where they are too many to be counted.
struct Candidate {
    domain: Domain,
    vertices: f64,
}

impl<'a> Healing<'a> {
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

    /// The drawing within the request's tolerance, or the finest that will do.
    ///
    /// # Errors
    /// Where no tolerance gives a domain: of the finest. Where there is nothing to mesh, or the watch says stop.
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
        // Slivers wider than a tolerance stay. First comes the finest one that leaves few, or that no coarser one is
        // worth it; then those.
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

    /// The drawing within another tolerance, the next coarser one first, after `failure` of the engine; `None` where
    /// there is none left.
    ///
    /// # Errors
    /// Where the watch says stop.
    pub fn retreat(&mut self, failure: &FailureReport, watch: &mut Watch) -> Result<Option<Domain>, FailureReport> {
        let [x, y] = failure.at.unwrap_or_default();
        self.left.retain(|&tolerance| tolerance != self.taken);
        self.coarser(None, &Why { at: Point::new(x, y), what: failure.what.clone() }, watch)
    }

    /// The drawing within a tolerance that nobody asked for yet; `None` where that leaves nothing to mesh.
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

    /// The first domain, within coarser and coarser tolerances, of which the slivers will do; or else the one with the
    /// least of them.
    fn coarser(
        &mut self,
        mut best: Option<Candidate>,
        why: &Why,
        watch: &mut Watch,
    ) -> Result<Option<Domain>, FailureReport> {
        for tolerance in self.left.clone() {
            if best.is_some() && tolerance < self.taken {
                // What is finer than the best so far leaves more.
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

    /// All of them, or more than can be counted; of those that welding within `above` leaves also so many that it is
    /// known what welding does.
    fn slivers(&self, domain: &Domain, above: f64, watch: &mut Watch) -> Result<Vec<(f64, Sliver)>, Stopped> {
        costly_slivers(domain, self.request.angle_min_rad(), COUNTED * self.enough(domain), above, watch)
    }

    /// Whether the regions of a domain are what they are within the finest tolerance.
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
        // Regions without a name are told from each other by their size only: the largest is the first.
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
