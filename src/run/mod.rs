//! From bytes to a verified mesh, each stage a function of its own.
//!
//! ```text
//!   drawing:  read ─▶ arrange ─▶ split to turning ─▶ refine ─▶ verify
//!   solid:    read ─▶ assemble ─▶ tetrahedralize ────────────▶ verify      `solid.rs`
//! ```

pub mod case;
mod exit;
mod healing;
mod plan;
pub mod reduce;
pub mod report;
pub mod request;
mod solid;
mod source;

pub use exit::{Exit, broken, ending, no_mesh};
pub use plan::Plan;
pub use source::{Source, read};

use crate::domain::{Domain, Drawing, Repair, Target};
use crate::ids::{PointId, VertexId};
use crate::mesh::Mesh;
use crate::mesh::elevate::elevate;
use crate::mesh::quality::Quality;
use crate::mesh::solid::SolidMesh;
use crate::plane::lopping::Refined;
use crate::refine::{StopReason, Until};
use crate::verify::Verdict;
use crate::watch::{Clock, Progress, Watch};
use exit::exit_of;
use healing::Healing;
use report::{FailureKind, FailureReport, MeshReport, PromiseReport, QualityReport, Report, StopReport};
use request::{Order, Request};
use source::Input;
use std::borrow::Cow;

/// The result of a run, as far as it came.
#[derive(Debug)]
pub struct Outcome {
    /// How the run ended, as an exit code.
    pub exit: Exit,
    /// The report, complete but for the time of writing and the memory.
    pub report: Report,
    /// The domain, with its curves cut to τ.
    pub domain: Option<Domain>,
    /// The mesh. It is valid, but may be unfinished. `None` where the run ended before there was one.
    pub mesh: Option<Mesh>,
    /// The mesh of tetrahedra, where the input bounds a solid.
    pub solid: Option<SolidMesh>,
    /// The verifier's checks of the mesh; `None` where there is no mesh.
    pub verdict: Option<Verdict>,
}

/// How far a run goes.
pub enum Extent<'a> {
    /// To its end, as long as the watch allows and the time lasts.
    Whole(&'a mut Watch<'a>),
    /// This number of steps of the engine, without a time limit.
    Steps(u64),
}

/// Reads, arranges, refines and verifies. `clock` gives the seconds of the report, and the end of the time asked for.
pub fn run(source: &Source, request: &Request, extent: Extent, clock: &Clock) -> Outcome {
    let mut outcome = Outcome::begun(source.path, request);
    let begun = clock();
    let input = source::read_any(source, request);
    outcome.report.seconds.read = clock() - begun;
    match input {
        Ok(input) => outcome.go_on(&input, request, extent, Timer { clock, begun, request }),
        Err(failure) => outcome.fail(failure),
    }
    outcome.report.seconds.total = clock() - begun;
    outcome
}

/// The same, from a drawing on.
pub fn run_drawing(drawing: &Drawing, request: &Request, extent: Extent, clock: &Clock) -> Outcome {
    let mut outcome = Outcome::begun(&drawing.title, request);
    let timer = Timer { clock, begun: clock(), request };
    outcome.go_on(&Input::Drawing(Box::new(Cow::Borrowed(drawing))), request, extent, timer);
    outcome
}

impl Outcome {
    fn begun(path: &str, request: &Request) -> Self {
        let report = Report::new(path, request);
        Self { exit: Exit::Done, report, domain: None, mesh: None, solid: None, verdict: None }
    }

    fn fail(&mut self, failure: FailureReport) {
        self.exit = failure.kind.exit();
        self.report.stop = self.report.stop.take().or_else(|| failure.stop.as_deref().cloned());
        self.report.failure = Some(failure);
    }

    fn go_on(&mut self, input: &Input, request: &Request, extent: Extent, timer: Timer) {
        let mut timed_out = false;
        let ended = match extent {
            Extent::Whole(watch) => {
                let mut in_time = |progress: &Progress| {
                    let goes_on = watch(progress);
                    timed_out |= goes_on && timer.is_over();
                    goes_on && !timed_out
                };
                self.either(input, request, &mut in_time, None, timer.clock)
            }
            Extent::Steps(steps) => self.either(input, request, &mut |_| true, Some(steps), timer.clock),
        };
        if let Err(failure) = ended {
            self.fail(failure);
        }
        if timed_out {
            let of_failure = self.report.failure.as_mut().and_then(|failure| failure.stop.as_deref_mut());
            self.report.stop.iter_mut().chain(of_failure).for_each(StopReport::time_out);
        }
    }

    /// Runs the stages of a drawing or those of a solid, which has no steps.
    fn either(
        &mut self,
        input: &Input,
        request: &Request,
        watch: &mut Watch,
        steps: Option<u64>,
        clock: &Clock,
    ) -> Result<(), FailureReport> {
        match input {
            Input::Drawing(drawing) => self.stages(drawing, request, watch, steps, clock),
            Input::Surfaces(surfaces, title) => {
                self.report.input.describe_surfaces(surfaces, title);
                self.solid_stages(surfaces, request, watch, clock)
            }
        }
    }

    fn stages(
        &mut self,
        drawing: &Drawing,
        request: &Request,
        watch: &mut Watch,
        steps: Option<u64>,
        clock: &Clock,
    ) -> Result<(), FailureReport> {
        self.report.input.describe(drawing);
        let mut laps = Laps { clock, last: clock() };
        let mut healing = Healing::new(drawing, request);
        let arranged = healing.arrange(watch);
        self.report.input.unhealed = unhealed(drawing, request, &mut self.report.input.notes, watch);
        let (domain, plan, refined) = self.mesh_healed(arranged?, &mut healing, &mut laps, steps, watch)?;
        let refined = plan.leave_crowded(refined, &domain, watch)?;
        let Refined { mesh, stop, counters, insertions, .. } = refined;
        self.report.stop = Some(StopReport::new(&stop));
        self.report.counters = counters;
        let mut mesh = mesh.ok_or_else(|| no_mesh(&stop, more_of(steps)))?;
        dress(&mut mesh, drawing, &domain);
        let straightened = match request.order {
            Order::First => Vec::new(),
            Order::Second => elevate(&mut mesh, &domain),
        };
        self.report.seconds.mesh += laps.lap();

        // The mesh is verified even after the time limit. An unverified mesh is useless, and the time for it is bounded
        // by its size.
        let mut verdict = plan.verify(Some(&domain), &mesh);
        verdict.checks.extend(plan.densities(&domain, &mesh, &insertions));
        if stop.angle_deg.is_some() {
            self.report.stop = Some(StopReport::new(&stop).with_unresolved_angles(&verdict));
        }
        self.report.mesh = Some(MeshReport::new(&mesh).with_straightened(&mesh, &straightened));
        let quality = Quality::of(Some(&domain), &mesh, verdict.exempt_cells());
        self.report.quality = Some(QualityReport::Plane(quality));
        self.report.promise = Some(PromiseReport::new(&verdict));
        self.report.seconds.verify = laps.lap();
        self.exit = exit_of(&verdict, stop.reason);
        if self.exit == Exit::Bug {
            let what =
                format!("the mesh breaks guarantees that hold whatever the request: {}", broken(&verdict).join(", "));
            self.report.failure = Some(FailureReport::new(FailureKind::Bug, what, "please send us the case file"));
        }
        (self.domain, self.mesh, self.verdict) = (Some(domain), Some(mesh), Some(verdict));
        Ok(())
    }

    /// Refines a domain. Where coordinates cannot distinguish its features, healing gives the domain at a coarser
    /// tolerance, as long as it has one left. Returns the domain with its curves cut to τ, and the plan.
    fn mesh_healed(
        &mut self,
        mut arranged: Domain,
        healing: &mut Healing,
        laps: &mut Laps,
        steps: Option<u64>,
        watch: &mut Watch,
    ) -> Result<(Domain, Plan, Refined), FailureReport> {
        let (drawing, request) = (healing.drawing, healing.request);
        let read = self.report.input.notes.len();
        loop {
            self.report.input.repairs = arranged.repairs().to_vec();
            self.report.input.notes.splice(read.., arranged.notes().iter().cloned());
            check_named_regions(&arranged, request)?;
            let (domain, plan) = Plan::new(drawing, &arranged, request, watch)?;
            self.report.request.note_use(drawing, &arranged, plan.tau_rad, plan.sizing());
            self.report.seconds.arrange += laps.lap();
            plan.afford(&domain, healing, watch)?;
            let refined = match steps {
                None => plan.refine(&domain, watch),
                Some(steps) => plan.drive(&domain, Until::Steps(steps), watch),
            };
            self.report.seconds.mesh += laps.lap();
            let coarser = match &refined {
                Err(failure) if failure.kind == FailureKind::Geometry => healing.retreat(failure, watch)?,
                Ok(refined) if refined.stop.reason == StopReason::Arithmetic => {
                    healing.retreat(&no_mesh(&refined.stop, more_of(steps)), watch)?
                }
                _ => None,
            };
            match coarser {
                Some(coarser) => arranged = coarser,
                None => return Ok((domain, plan, refined?)),
            }
        }
    }
}

/// The option that lets a run go on longer.
fn more_of(steps: Option<u64>) -> &'static str {
    if steps.is_none() { "--timeout" } else { "--until" }
}

/// Sets the unit, the plane and the named nodes of a mesh from its drawing.
fn dress(mesh: &mut Mesh, drawing: &Drawing, domain: &Domain) {
    mesh.unit = drawing.unit.as_ref().map(|(unit, _)| unit.clone());
    mesh.frame = drawing.frame;
    let name_of = |&(point, node): &(PointId, VertexId)| Some((node, *domain.point_names().get(&point)?));
    mesh.named_nodes = mesh.points.iter().filter_map(name_of).collect();
    mesh.named_nodes.sort_unstable();
}

/// Laps of a clock.
struct Laps<'a> {
    clock: &'a Clock<'a>,
    last: f64,
}

impl Laps<'_> {
    /// Seconds since the start or the last lap.
    fn lap(&mut self) -> f64 {
        let now = (self.clock)();
        now - std::mem::replace(&mut self.last, now)
    }
}

/// The time limit of a request.
struct Timer<'a> {
    clock: &'a Clock<'a>,
    begun: f64,
    request: &'a Request,
}

impl Timer<'_> {
    fn is_over(&self) -> bool {
        self.request.timeout.is_some_and(|limit| (self.clock)() - self.begun >= limit)
    }
}

/// A watch that says stop when the time limit of the request is over. It begins now.
pub fn timer<'a>(request: &'a Request, clock: &'a Clock) -> impl FnMut(&Progress) -> bool + 'a {
    let timer = Timer { clock, begun: clock(), request };
    move |_| !timer.is_over()
}

/// Drawing → domain, at the request's tolerance or at the one that `Healing` takes, as long as `watch` allows.
///
/// # Errors
/// Where the drawing has no valid arrangement: with the place and the way out. Where the watch says stop.
pub fn arrange(drawing: &Drawing, request: &Request, watch: &mut Watch) -> Result<Domain, FailureReport> {
    Healing::new(drawing, request).arrange(watch)
}

/// With `--tolerance 0`: the repairs that the default tolerance would have made. A note where these cannot be computed.
pub fn unhealed(drawing: &Drawing, request: &Request, notes: &mut Vec<String>, watch: &mut Watch) -> Vec<Repair> {
    if request.tolerance != Some(0.0) {
        return Vec::new();
    }
    drawing.unhealed(watch).unwrap_or_else(|why| {
        notes.push(format!("--tolerance 0: it cannot be told what the default would heal: {why}"));
        Vec::new()
    })
}

/// Refuses a name for a region at a place outside of all regions.
fn check_named_regions(domain: &Domain, request: &Request) -> Result<(), FailureReport> {
    let is_there = |name: &str| domain.regions().iter().any(|region| domain.name(region.name) == name);
    for name in &request.name {
        if let Target::Region(at) = name.target
            && !is_there(&name.name)
        {
            let help = "name a place well within a region: squinch draw shows them";
            return Err(
                FailureReport::new(FailureKind::Request, format!("--name {name}: no region is there"), help).at(at)
            );
        }
    }
    Ok(())
}
