//! How coarsely a drawing is welded where nobody said: the tolerances that are tried, and the one that is taken.
//!
//! **The rule.** A drawing is welded within 1e-9 of its diagonal. Drawn hastily, traced twice or rounded, it has hair gaps then, and a mesh
//! with good angles takes as many triangles along a gap as it is longer than wide. So, unless a tolerance was given:
//!
//! - A *sketch* ([`Drawing::sketch`]: an SVG picture whose numbers have the digits of a picture) is welded within the least of 1e-6,
//!   1e-5 and 1e-4 of its diagonal that leaves slivers of few vertices, where those of the finer weld would take many; its area may change
//!   by a thousandth.
//! - Any other drawing is welded within 1e-6 where the slivers narrower than that would take tens of thousands of vertices, and its area
//!   changes by no more than a billionth: exact work stays exact, or is refused by the estimate.
//! - `--min-edge H` says that nothing finer than H needs to be meshed: any drawing is a sketch of a third of it (a loop is safe from three
//!   tolerances on).
//! - What cannot be arranged or meshed because its features lie nearer to each other than the coordinates can tell apart is tried again
//!   within the next coarser one of these tolerances.
//!
//! That it was done is the first repair of the list ([`RepairKind::ToleranceRaised`]), with the tolerance taken.

use crate::domain::{ArrangeOptions, Domain, Drawing, Repair, RepairKind, Unarranged};
use crate::geometry::Point;
use crate::plane::lopping::demand::{Sliver, slivers};
use crate::report::{FailureKind, FailureReport};
use crate::request::{Keep, Request};
use crate::watch::Watch;

/// Tolerances of sketches, as parts of the diagonal.
const SKETCH: [f64; 3] = [1e-6, 1e-5, 1e-4];

/// The tolerance of other drawings.
const EXACT: f64 = 1e-6;

/// Estimated vertices of slivers that a sketch may have, and more for each of its curves. Runs take some fifty times as many.
const SKETCH_VERTICES: [f64; 2] = [500.0, 0.125];

/// The same of other drawings.
const EXACT_VERTICES: [f64; 2] = [50_000.0, 0.0];

/// Part of the area by which welding may change a sketch: what loses more consists of slivers.
const SKETCH_AREA: f64 = 1e-3;

/// The same of other drawings.
const EXACT_AREA: f64 = 1e-9;

/// A drawing on its way to a domain within the right tolerance.
pub struct Healing<'a> {
    drawing: &'a Drawing,
    request: &'a Request,
    /// Coarser tolerances that may be taken, ascending.
    left: Vec<f64>,
    vertices: [f64; 2],
    area: f64,
    /// Area of the kept regions within the finest tolerance that was arranged.
    measure: Option<f64>,
    /// Why the tolerance must be raised.
    why: Option<Why>,
}

/// What asks for a coarser tolerance.
struct Why {
    at: Point,
    what: String,
}

impl<'a> Healing<'a> {
    pub fn new(drawing: &'a Drawing, request: &'a Request) -> Self {
        let diagonal = drawing.bounds().map_or(0.0, |b| libm::hypot(b.width(), b.height()));
        let simplified = request.min_edge.map(|edge| edge / 3.0);
        let sketch = drawing.sketch || simplified.is_some();
        let parts = if drawing.sketch { &SKETCH[..] } else { &[EXACT] };
        let mut left: Vec<f64> = parts.iter().map(|part| part * diagonal).chain(simplified).collect();
        left.retain(|&t| 0.0 < t && t < diagonal / 4.0 && request.tolerance.is_none());
        left.sort_by(f64::total_cmp);
        let (vertices, area) = match sketch {
            true => (SKETCH_VERTICES, SKETCH_AREA),
            false => (EXACT_VERTICES, EXACT_AREA),
        };
        Self { drawing, request, left, vertices, area, measure: None, why: None }
    }

    /// The drawing within the request's tolerance, or the finest that will do.
    ///
    /// # Errors
    /// Where no tolerance gives a domain: of the finest. Where there is nothing to mesh, or the watch says stop.
    pub fn arrange(&mut self, watch: &mut Watch) -> Result<Domain, FailureReport> {
        match self.arrange_within(self.request.tolerance, watch) {
            Ok(domain) if domain.regions().is_empty() => Err(no_region()),
            Ok(domain) => {
                self.measure = Some(domain.measure());
                self.coarsen(&domain, watch)?;
                if self.why.is_none() {
                    return Ok(domain);
                }
                Ok(self.raised(watch)?.unwrap_or(domain))
            }
            Err(Unarranged::Invalid(error)) if error.near => {
                self.why = Some(Why { at: error.at, what: error.what.clone() });
                self.raised(watch)?.ok_or_else(|| error.into())
            }
            Err(why) => Err(why.into()),
        }
    }

    /// The drawing within the next coarser tolerance, after `failure` of the engine; `None` where there is none.
    ///
    /// # Errors
    /// Where the watch says stop.
    pub fn retreat(&mut self, failure: &FailureReport, watch: &mut Watch) -> Result<Option<Domain>, FailureReport> {
        if failure.kind != FailureKind::Geometry {
            return Ok(None);
        }
        let [x, y] = failure.at.unwrap_or_default();
        self.why = Some(Why { at: Point::new(x, y), what: failure.what.clone() });
        self.raised(watch)
    }

    /// Leaves out the tolerances that would leave too many slivers, where one is called for at all.
    fn coarsen(&mut self, domain: &Domain, watch: &mut Watch) -> Result<(), FailureReport> {
        let Some(&coarsest) = self.left.last() else { return Ok(()) };
        let narrow: Vec<(f64, Sliver)> = slivers(domain, watch)?
            .into_iter()
            .filter(|s| s.width < coarsest)
            .map(|s| (s.vertices(self.request.angle_min_rad(), 0.0), s))
            .collect();
        let enough = self.vertices[0] + self.vertices[1] * domain.curves().len() as f64;
        let taken = |within: f64| narrow.iter().filter(|(_, s)| s.width >= within).map(|(n, _)| n).sum::<f64>();
        let vertices = taken(0.0);
        if vertices <= enough {
            return Ok(());
        }
        let least = self.left.iter().position(|&t| taken(t) <= enough).unwrap_or(self.left.len() - 1);
        self.left.drain(..least);
        let dearest = narrow.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let what = format!("slivers narrower than {coarsest:.2e} would take {vertices:.1e} vertices or more");
        self.why = dearest.map(|(_, s)| Why { at: s.at, what });
        Ok(())
    }

    /// The drawing within the finest tolerance left that can be arranged and changes the area by little.
    fn raised(&mut self, watch: &mut Watch) -> Result<Option<Domain>, FailureReport> {
        while !self.left.is_empty() {
            let tolerance = self.left.remove(0);
            match self.arrange_within(Some(tolerance), watch) {
                Ok(mut domain) if self.is_alike(&domain) => {
                    domain.itemise_first(self.repair(tolerance));
                    return Ok(Some(domain));
                }
                Ok(_) | Err(Unarranged::Invalid(_)) => {}
                Err(stopped) => return Err(stopped.into()),
            }
        }
        Ok(None)
    }

    fn is_alike(&self, domain: &Domain) -> bool {
        let measure = domain.measure();
        measure > 0.0 && self.measure.is_none_or(|of_finest| (measure - of_finest).abs() <= self.area * of_finest)
    }

    fn repair(&self, tolerance: f64) -> Repair {
        let why = self.why.as_ref().expect("no tolerance is raised without a reason");
        Repair {
            kind: RepairKind::ToleranceRaised,
            at: [why.at.x, why.at.y],
            size: tolerance,
            what: format!("{}: all was welded within {tolerance:.2e}", why.what),
        }
    }

    fn arrange_within(&self, tolerance: Option<f64>, watch: &mut Watch) -> Result<Domain, Unarranged> {
        let options =
            ArrangeOptions { tolerance, fill: self.request.fill_rule.rule(), keep_all: self.request.keep == Keep::All };
        self.drawing.arrange_watched(&options, watch)
    }
}

fn no_region() -> FailureReport {
    let help = "close the outline, name another --fill-rule, or mesh everything by --keep all";
    FailureReport::new(FailureKind::Geometry, "nothing to mesh: the curves enclose no kept region", help)
}
