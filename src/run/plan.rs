//! A request prepared for one domain: sizes, turning, the engine with its options, and the bounds for the verifier.

mod angles;
mod budget;

use super::exit::no_mesh;
use super::report::{FailureKind, FailureReport};
use super::request::{Engine, Request};
use crate::domain::{Domain, DomainCurve, Drawing, Region};
use crate::ids::Id;
use crate::mesh::{Insertion, Mesh};
use crate::plane::gcdr::parameters::radius_edge_of;
use crate::plane::gcdr::steiner::Disks;
use crate::plane::lopping::{self, RefineError, Refined};
use crate::plane::{Midpoint, gcdr};
use crate::promise::{Promise, arc_turning};
use crate::refine::{Stop, StopReason, Until};
use crate::size::estimate::{Asked, Circles, Demand};
use crate::size::{SizeOf, Sizing, Source as SizeSource};
use crate::verify::{self, Check, Verdict, verify};
use crate::watch::{Progress, Stopped, Watch};
use std::collections::BTreeSet;

/// A request prepared for one domain: the options of the engine, and the bounds for the verifier.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Largest turning of a curve when refinement starts.
    pub tau_rad: f64,
    options: lopping::Options,
    /// The options of constrained refinement, if that is the engine.
    gcdr: Option<Gcdr>,
}

/// The options of generalized constrained Delaunay refinement.
#[derive(Clone, Debug)]
struct Gcdr {
    options: gcdr::Options,
    choices: gcdr::Choices,
}

impl Gcdr {
    /// `None` where the request names another engine.
    fn asked(request: &Request, options: &lopping::Options) -> Option<Self> {
        (request.engine == Engine::Gcdr).then(|| Self {
            options: gcdr::Options {
                angle_min_rad: options.angle_min_rad,
                regions: request.regions(),
                sizing: options.sizing.clone(),
                max_vertices: options.max_vertices,
                record: request.gcdr.densities.is_on(),
            },
            choices: request.gcdr.clone(),
        })
    }

    /// Checks δ₂, δ₁ and μ against (3.1)–(3.3). Segments at corners below 60° are split on shells and have no interval.
    fn check(&self, domain: &Domain) -> Result<(), FailureReport> {
        let rho = radius_edge_of(self.options.angle_min_rad);
        self.options.regions.check(rho, gcdr::least_angle(domain)).map_err(|violation| {
            let help = "use larger --delta2, --delta1 or --mu, or a smaller --min-angle";
            FailureReport::new(FailureKind::Request, violation.to_string(), help)
        })
    }

    fn promise(&self, foreign: bool) -> Promise {
        self.options.promise(self.choices.steiner.is_free(), foreign)
    }

    fn refine(&self, domain: &Domain, until: Until, watch: &mut Watch) -> Result<Refined, RefineError> {
        let mut strategy = self.choices.strategy(self.options.angle_min_rad);
        gcdr::refine(domain, &self.options, &mut *strategy, until, watch)
    }
}

impl Plan {
    /// The domain with its curves cut to τ, and the plan for it. Corner arcs are as fine as the guarantee needs.
    ///
    /// # Errors
    /// A `--size-of` with a name that the domain does not have, more pieces than the vertex budget, or a watch that
    /// says stop.
    pub fn new(
        drawing: &Drawing,
        domain: &Domain,
        request: &Request,
        watch: &mut Watch,
    ) -> Result<(Domain, Self), FailureReport> {
        let mut options = engine_options(request, sizing(drawing, domain, request)?);
        let tau_rad = request.tau_rad(domain.curves().iter().map(|c| &c.curve));
        let domain = split_to_turning(domain, tau_rad, request.max_vertices, watch)?;
        let mut lens = 0.0f64;
        for (id, curve) in domain.curves().enumerate() {
            let queued = domain.curves().len() - id.index();
            Progress { phase: "measuring", vertices: domain.points().len(), queued }.tell(watch)?;
            lens = lens.max(curve.curve.lens_angle(0.0, 1.0));
        }
        let turning_rad = arc_turning(options.angle_min_rad, lens);
        options.corner_arcs = request.corner_arcs.is_on().then_some(turning_rad);
        let gcdr = Gcdr::asked(request, &options);
        gcdr.iter().try_for_each(|gcdr| gcdr.check(&domain))?;
        Ok((domain, Self { tau_rad, options, gcdr }))
    }

    /// The plan for a mesh without a drawing. Sizes in percent of the diagonal are unknown, and a name may be of a
    /// boundary or of a region.
    pub fn without_domain(request: &Request) -> Self {
        let mut sizing = request.limits.sizing(None);
        for SizeOf { name, edge } in &request.limits.size_of {
            sizing.sources.push(SizeSource::Boundary { name: name.clone(), edge: *edge });
            sizing.sources.push(SizeSource::Region { name: name.clone(), edge: *edge });
        }
        let options = engine_options(request, sizing);
        let gcdr = Gcdr::asked(request, &options);
        Self { tau_rad: request.tau_rad([]), options, gcdr }
    }

    /// The sizes asked for, by the request and by the drawing, as the engine and the verifier use them.
    pub fn sizing(&self) -> &Sizing {
        &self.options.sizing
    }

    fn demand(&self, domain: &Domain, watch: &mut Watch) -> Result<Demand, Stopped> {
        let circles = if self.gcdr.is_some() { Circles::Any } else { Circles::Empty };
        let asked = Asked {
            angle_min_rad: self.options.angle_min_rad,
            sizing: &self.options.sizing,
            circles,
            corner_arcs: self.options.corner_arcs.is_some(),
            bisected: self.options.rules.midpoint == Midpoint::Bisector,
        };
        Demand::of(domain, asked, watch)
    }

    /// Drives the engine on a domain whose curves turn at most τ, to the angle asked for.
    ///
    /// # Errors
    /// Where coordinates cannot tell features apart.
    pub fn drive(&self, domain: &Domain, until: Until, watch: &mut Watch) -> Result<Refined, FailureReport> {
        Ok(match &self.gcdr {
            Some(gcdr) => gcdr.refine(domain, until, watch),
            None => lopping::refine(domain, &self.options, until, watch),
        }?)
    }

    fn promise(&self, foreign: bool) -> Promise {
        match &self.gcdr {
            Some(gcdr) => gcdr.promise(foreign),
            None => self.options.promise(foreign),
        }
    }

    /// Checks the recorded densities of a run against their bounds; empty where none were recorded.
    pub fn densities(&self, domain: &Domain, mesh: &Mesh, insertions: &[Insertion]) -> Vec<Check> {
        let Some(gcdr) = self.gcdr.as_ref().filter(|gcdr| gcdr.options.record) else { return Vec::new() };
        let disks = gcdr.choices.strategy(gcdr.options.angle_min_rad).disks();
        let promise = gcdr.options.density_promise(domain).filter(|_| disks == Disks::Alike);
        verify::densities(domain, mesh, insertions, promise).into()
    }

    /// Verifies a mesh of ours, by its links to the curves of the domain.
    pub fn verify(&self, domain: Option<&Domain>, mesh: &Mesh) -> Verdict {
        verify(domain, mesh, &self.promise(false))
    }

    /// Verifies a mesh from a file. Other programs drop or renumber the links of a mesh to its curves. If the checks
    /// fail by links, the mesh is verified by the places of its nodes, and that verdict is taken if it is better. Then
    /// the mesh without links is returned beside the verdict.
    pub fn verify_file(&self, domain: Option<&Domain>, mesh: &Mesh) -> (Verdict, Option<Mesh>) {
        let by_links = self.verify(domain, mesh);
        if domain.is_none() || by_links.kept() {
            return (by_links, None);
        }
        let untied = mesh.clone().untied();
        let by_place = verify(domain, &untied, &self.promise(true));
        if flaws(&by_place) < flaws(&by_links) { (by_place, Some(untied)) } else { (by_links, None) }
    }
}

/// A domain with its curves cut to τ, if that takes no more vertices than the budget.
fn split_to_turning(
    domain: &Domain,
    tau_rad: f64,
    max_vertices: usize,
    watch: &mut Watch,
) -> Result<Domain, FailureReport> {
    let mut needed = 0;
    let split = domain.split_to_turning_watched(tau_rad, &mut |progress| {
        needed = progress.vertices;
        needed <= max_vertices && watch(progress)
    });
    split.map_err(|stopped| {
        if needed <= max_vertices {
            return stopped.into();
        }
        let turning = |c: &DomainCurve| c.curve.turning(0.0, 1.0);
        let most = domain.curves().iter().max_by(|a, b| turning(a).total_cmp(&turning(b)));
        let places = most.map(|c| c.curve.point(0.5)).into_iter().collect();
        let unresolved = needed - max_vertices;
        let stop = Stop { reason: StopReason::VertexBudget, unresolved, places, angle_deg: None };
        let failure = no_mesh(&stop, "--max-vertices");
        FailureReport {
            what: format!("pieces that turn at most {tau_rad:e} take {needed} vertices or more"),
            help: "let them turn more by --max-turning, or allow more by --max-vertices".into(),
            ..failure
        }
    })
}

fn engine_options(request: &Request, sizing: Sizing) -> lopping::Options {
    lopping::Options {
        angle_min_rad: request.angle_min_rad(),
        rules: request.rules,
        corner_arcs: request.corner_arcs.is_on().then_some(std::f64::consts::FRAC_PI_3),
        sizing,
        max_vertices: request.max_vertices,
    }
}

/// The sizes of the request and of the drawing.
fn sizing(drawing: &Drawing, domain: &Domain, request: &Request) -> Result<Sizing, FailureReport> {
    let diagonal = drawing.bounds().map(|b| libm::hypot(b.width(), b.height()));
    let plain = request.limits.sizing(diagonal);
    let mut sizing = plain.with_requests(&drawing.sizes, |name| drawing.names.text(name).to_owned());
    sizing.sources.extend(request.limits.samples());
    let undefined = request.limits.size.as_ref().and_then(|size| size.undefined_at(domain.points().iter().copied()));
    if let Some(at) = undefined {
        let what = format!(
            "--size {} is not a positive length",
            request.limits.size.as_ref().map_or(String::new(), ToString::to_string)
        );
        let help = "an expression must be positive all over the drawing: max(h, …) keeps it so";
        return Err(FailureReport::new(FailureKind::Request, what, help).at(at));
    }
    let boundaries: BTreeSet<&str> = domain.curves().iter().map(|c| domain.name(c.name)).collect();
    // A region that has its name only from the layer of its outline has no size of its own. The size is that of the
    // outline.
    let is_own = |region: &&Region| region.is_named || !boundaries.contains(domain.name(region.name));
    let regions: BTreeSet<&str> = domain.regions().iter().filter(is_own).map(|r| domain.name(r.name)).collect();
    for SizeOf { name, edge } in &request.limits.size_of {
        let (boundary, region) = (boundaries.contains(name.as_str()), regions.contains(name.as_str()));
        if boundary {
            sizing.sources.push(SizeSource::Boundary { name: name.clone(), edge: *edge });
        }
        if region {
            sizing.sources.push(SizeSource::Region { name: name.clone(), edge: *edge });
        }
        if !boundary && !region {
            let list = |names: &BTreeSet<&str>| names.iter().copied().collect::<Vec<_>>().join(", ");
            let help = format!("boundaries: {}; regions: {}", list(&boundaries), list(&regions));
            let what = format!("--size-of {name}={edge}: nothing has this name");
            return Err(FailureReport::new(FailureKind::Request, what, help));
        }
    }
    Ok(sizing)
}

/// How many things failed in all checks.
fn flaws(verdict: &Verdict) -> usize {
    verdict.checks.iter().map(|c| c.broken).sum()
}
