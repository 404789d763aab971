//! From bytes to a judged mesh: read → arrange → split to turning → refine → verify. Each stage can be had alone.

mod angles;
mod budget;
mod healing;

use crate::domain::{
    ArrangeError, Domain, DomainCurve, Drawing, DrawnCurve, Region, Repair, SizeRequest, Target, Unarranged, Unmatched,
};
use crate::geometry::{Point, metres};
use crate::ids::{Id, PointId, VertexId};
use crate::import::{self, AirfoilOptions, DxfOptions, Format, ImportError, Selection, SvgOptions};
use crate::mesh::elevate::elevate;
use crate::mesh::quality::Quality;
use crate::mesh::{Insertion, Mesh};
use crate::plane;
use crate::plane::gcdr;
use crate::plane::gcdr::parameters::radius_edge_of;
use crate::plane::gcdr::steiner::{self, Disks, SteinerStrategy};
use crate::plane::lopping::demand::{Circles, Demand};
use crate::plane::lopping::{self, Lopping, RefineError, Refined, Shrinking};
use crate::promise::{Promise, arc_turning};
use crate::refine::{Stop, StopReason};
use crate::report::{FailureKind, FailureReport, MeshReport, PromiseReport, Report, StopReport};
use crate::request::{
    BallShrinking, Engine, LineTypes, Midpoint, Order, Request, SizeOf, SnapTo, Steiner, Strokes, TrailingEdge,
};
use crate::size::{ByPlace, Given, SAMPLE_GRADE, Sizing, Source as SizeSource};
use crate::verify::{self, Check, Status, Verdict, verify};
use crate::watch::{Progress, Stopped, Watch};
use healing::Healing;
use kurbo::Affine;
use std::collections::BTreeSet;
use std::path::Path;
use std::time::{Duration, Instant};

/// What is read: the bytes of a file, and how to read them.
#[derive(Clone, Debug)]
pub struct Source<'a> {
    /// As given; its suffix tells the format where none is given, its stem is the title where the file has none.
    pub path: &'a str,
    pub bytes: &'a [u8],
    pub format: Option<Format>,
    /// The `.node` file beside a `.poly` file, where there is one.
    pub nodes: Option<&'a [u8]>,
    /// Whether it is one of many inputs that share a request: names of the request that it does not have are noted then, and no error.
    pub of_many: bool,
}

/// How a run ended, as an exit code (contract of the command line).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Every promise kept.
    Done = 0,
    /// Of a batch: any input ended otherwise.
    SomeFailed = 1,
    Usage = 2,
    Unreadable = 3,
    Geometry = 4,
    /// A requested bound is missed outside the excused places, or a budget ran out.
    Missed = 5,
    Unwritable = 6,
    /// Our own fault.
    Bug = 70,
    Cancelled = 130,
}

impl FailureKind {
    pub fn exit(self) -> Exit {
        match self {
            Self::Request => Exit::Usage,
            Self::Unreadable => Exit::Unreadable,
            Self::Geometry => Exit::Geometry,
            Self::NoMesh => Exit::Missed,
            Self::Bug => Exit::Bug,
        }
    }
}

/// What came of a run: as much of it as there is.
#[derive(Debug)]
pub struct Outcome {
    pub exit: Exit,
    pub report: Report,
    /// The domain, its curves cut to τ.
    pub domain: Option<Domain>,
    pub mesh: Option<Mesh>,
    pub verdict: Option<Verdict>,
}

/// How far a run goes.
pub enum Extent<'a> {
    /// To its end, as long as the watch says to go on and the time asked for lasts.
    Whole(&'a mut Watch<'a>),
    /// So many steps of the engine, whatever the time.
    Steps(u64),
}

/// Reads, arranges, refines and judges.
pub fn run(source: &Source, request: &Request, extent: Extent) -> Outcome {
    let mut outcome = Outcome::begun(source.path, request);
    let start = Instant::now();
    let drawing = read(source, request);
    outcome.report.seconds.read = start.elapsed().as_secs_f64();
    match drawing {
        Ok(drawing) => outcome.go_on(&drawing, request, extent, start),
        Err(failure) => outcome.fail(failure),
    }
    outcome.report.seconds.total = start.elapsed().as_secs_f64();
    outcome
}

/// The run from a drawing on.
pub fn run_drawing(drawing: &Drawing, request: &Request, extent: Extent) -> Outcome {
    let mut outcome = Outcome::begun(&drawing.title, request);
    outcome.go_on(drawing, request, extent, Instant::now());
    outcome
}

impl Outcome {
    fn begun(path: &str, request: &Request) -> Self {
        Self { exit: Exit::Done, report: Report::new(path, request), domain: None, mesh: None, verdict: None }
    }

    fn fail(&mut self, failure: FailureReport) {
        self.exit = failure.kind.exit();
        self.report.stop = self.report.stop.take().or_else(|| failure.stop.as_deref().cloned());
        self.report.failure = Some(failure);
    }

    fn go_on(&mut self, drawing: &Drawing, request: &Request, extent: Extent, begun: Instant) {
        let mut timer = timer_from(begun, request);
        let ended = match extent {
            Extent::Whole(watch) => self.stages(drawing, request, &mut |p| watch(p) && timer(p), None),
            Extent::Steps(steps) => self.stages(drawing, request, &mut |_| true, Some(steps)),
        };
        if let Err(failure) = ended {
            self.fail(failure);
        }
    }

    fn stages(
        &mut self,
        drawing: &Drawing,
        request: &Request,
        watch: &mut Watch,
        steps: Option<u64>,
    ) -> Result<(), FailureReport> {
        self.report.input.describe(drawing);
        let mut clock = Clock::start();
        let more = if steps.is_none() { "--timeout" } else { "--until" };
        let mut healing = Healing::new(drawing, request);
        let arranged = healing.arrange(watch);
        self.report.input.unhealed = unhealed(drawing, request, &mut self.report.input.notes, watch);
        let mut arranged = arranged?;
        let read = self.report.input.notes.len();
        let (domain, plan, refined) = loop {
            self.report.input.repairs = arranged.repairs().to_vec();
            self.report.input.notes.splice(read.., arranged.notes().iter().cloned());
            check_named_regions(&arranged, request)?;
            let (domain, plan) = Plan::new(drawing, &arranged, request, watch)?;
            self.report.request.note_use(drawing, &arranged, &plan);
            self.report.seconds.arrange += clock.lap();
            plan.afford(&domain, &healing, watch)?;
            let refined = match steps {
                None => plan.refine(&domain, watch),
                Some(steps) => plan.refine_steps(&domain, steps),
            };
            self.report.seconds.mesh += clock.lap();
            let coarser = match &refined {
                Err(failure) if failure.kind == FailureKind::Geometry => healing.retreat(failure, watch)?,
                Ok(refined) if refined.stop.reason == StopReason::Arithmetic => {
                    healing.retreat(&no_mesh(&refined.stop, more), watch)?
                }
                _ => None,
            };
            match coarser {
                Some(coarser) => arranged = coarser,
                None => break (domain, plan, refined?),
            }
        };
        let refined = plan.leave_crowded(refined, &domain, watch)?;
        let Refined { mesh, stop, counters, insertions, .. } = refined;
        self.report.stop = Some(StopReport::new(&stop));
        self.report.counters = counters;
        let mut mesh = mesh.ok_or_else(|| no_mesh(&stop, more))?;
        mesh.unit = drawing.unit.as_ref().map(|(unit, _)| unit.clone());
        mesh.frame = drawing.frame;
        let name_of = |&(point, node): &(PointId, VertexId)| Some((node, *domain.point_names().get(&point)?));
        mesh.named_nodes = mesh.points.iter().filter_map(name_of).collect();
        mesh.named_nodes.sort_unstable();
        let straightened = match request.order {
            Order::First => Vec::new(),
            Order::Second => elevate(&mut mesh, &domain),
        };
        self.report.seconds.mesh += clock.lap();

        // Whatever the time: a mesh that nobody judged is worth nothing, and the judge's work is bounded by its size.
        let mut verdict = plan.judge(Some(&domain), &mesh);
        verdict.checks.extend(plan.densities(&domain, &mesh, &insertions));
        if stop.angle_deg.is_some() {
            self.report.stop = Some(StopReport::new(&stop).owing_angles(&verdict));
        }
        self.report.mesh = Some(MeshReport::new(&mesh).with_straightened(&mesh, &straightened));
        self.report.quality = Some(Quality::of(Some(&domain), &mesh, verdict.exempt_cells()));
        self.report.promise = Some(PromiseReport::new(&verdict));
        self.report.seconds.verify = clock.lap();
        self.exit = exit_of(&verdict, stop.reason);
        if self.exit == Exit::Bug {
            let what = format!("the mesh breaks what no request can excuse: {}", broken(&verdict).join(", "));
            self.report.failure = Some(FailureReport::new(FailureKind::Bug, what, "please send us the case file"));
        }
        (self.domain, self.mesh, self.verdict) = (Some(domain), Some(mesh), Some(verdict));
        Ok(())
    }
}

/// Laps of a wall clock.
struct Clock(Instant);

impl Clock {
    fn start() -> Self {
        Self(Instant::now())
    }

    /// Seconds since the start or the last lap.
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        std::mem::replace(&mut self.0, now).elapsed().as_secs_f64()
    }
}

/// A watch that says stop when the request's time, which begins now, is over.
pub fn timer(request: &Request) -> impl FnMut(&Progress) -> bool + use<> {
    timer_from(Instant::now(), request)
}

fn timer_from(begun: Instant, request: &Request) -> impl FnMut(&Progress) -> bool + use<> {
    let limit = request.timeout.map(|s| Duration::try_from_secs_f64(s).unwrap_or(Duration::MAX));
    move |_| limit.is_none_or(|limit| begun.elapsed() < limit)
}

/// Names of the broken checks.
pub fn broken(verdict: &Verdict) -> Vec<&'static str> {
    verdict.checks.iter().filter(|c| c.status == Status::Broken).map(|c| c.name).collect()
}

/// How many things failed in all checks.
fn flaws(verdict: &Verdict) -> usize {
    verdict.checks.iter().map(|c| c.broken).sum()
}

/// Checks of bounds that were asked for; the rest holds of every mesh that we make.
const REQUESTED: &[&str] = &[
    "min_angle",
    "max_angle",
    "chord_error",
    "edge_turning",
    "size",
    "radius_edge",
    "density_a",
    "density_b",
    "density_c",
];
/// What refinement brings about last: owed where a budget ended it.
const REFINED: &[&str] = &["empty_diametral", "ball_radius", "lfs_ratio"];

fn exit_of(verdict: &Verdict, reason: StopReason) -> Exit {
    let done = reason == StopReason::Done;
    let excusable = |name: &str| REQUESTED.contains(&name) || !done && REFINED.contains(&name);
    let broken = broken(verdict);
    if broken.iter().any(|name| !excusable(name)) {
        Exit::Bug
    } else if broken.is_empty() && done {
        Exit::Done
    } else {
        Exit::Missed
    }
}

// ---- the stages ----

/// Bytes → drawing, in the unit asked for.
pub fn read(source: &Source, request: &Request) -> Result<Drawing, FailureReport> {
    let path = Path::new(source.path);
    let format = source.format.map_or_else(|| import::tell_format(path, source.bytes), Ok)?;
    let stem = path.file_stem().map_or("", |s| s.to_str().unwrap_or(""));
    let options = import::Options {
        airfoil: AirfoilOptions {
            trailing_edge: match request.trailing_edge {
                TrailingEdge::Keep => import::TrailingEdge::Keep,
                TrailingEdge::Sharp => import::TrailingEdge::Sharp,
                TrailingEdge::Blunt => import::TrailingEdge::Blunt,
                TrailingEdge::Round => import::TrailingEdge::Round,
            },
            far_field: request.far_field,
            incidence_deg: request.incidence,
            chord: request.chord,
        },
        nodes: source.nodes.map(<[u8]>::to_vec),
        svg: SvgOptions {
            strokes: match request.strokes {
                Strokes::Auto => import::Strokes::Auto,
                Strokes::Lines => import::Strokes::Lines,
                Strokes::Area => import::Strokes::Area,
                Strokes::Ignore => import::Strokes::Ignore,
            },
            dpi: request.dpi,
        },
        face: request.face.clone(),
        dxf: DxfOptions {
            line_types: match request.line_types {
                LineTypes::Edges => import::LineTypes::Edges,
                LineTypes::All => import::LineTypes::All,
            },
            flatten_z: request.flatten_z.is_on(),
        },
        selection: Selection { only: request.layers.clone(), skip: request.skip_layers.clone() },
    };
    let mut drawing = import::read(source.bytes, format, stem, &options)?;
    drawing.notes.extend(unused_options(format, request));
    drawing.notes.extend(unused_face(format, request));
    tell_unmatched(&mut drawing, source.of_many)?;
    let mut drawing = in_units(drawing, request)?;
    give_names(&mut drawing, request, source.of_many)?;
    Ok(drawing)
}

/// Names that the request gives. What is not there is an error, or a note where the request is that of many inputs.
fn give_names(drawing: &mut Drawing, request: &Request, of_many: bool) -> Result<(), FailureReport> {
    drawing.name_each(request.names.rule());
    for name in &request.name {
        match drawing.give_name(name) {
            Ok(what) => drawing.notes.extend(what),
            Err(why) if of_many => drawing.notes.push(format!("--name {name}: {why}")),
            Err(why) => {
                let help = "--name NAME=x,y names the nearest curve; squinch inspect lists what the drawing has";
                return Err(FailureReport::new(FailureKind::Request, format!("--name {name}: {why}"), help));
            }
        }
    }
    Ok(())
}

/// Refuses the name of a region at a place that is in none.
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

/// Says which options a drawing of this format has no use for.
fn unused_options(format: Format, request: &Request) -> Option<String> {
    let default = Request::default();
    let of_airfoils = [
        ("--trailing-edge", request.trailing_edge != default.trailing_edge),
        ("--far-field", request.far_field != default.far_field),
        ("--incidence", request.incidence != default.incidence),
        ("--chord", request.chord.is_some()),
    ];
    let given: Vec<&str> = of_airfoils.into_iter().filter(|(_, given)| *given).map(|(option, _)| option).collect();
    let unused = format != Format::Airfoil && !given.is_empty();
    unused.then(|| format!("{}: only for airfoils, and not used here", given.join(", ")))
}

/// Says that a drawing of this format has no faces to choose from.
fn unused_face(format: Format, request: &Request) -> Option<String> {
    (format != Format::Step && request.face.is_some()).then(|| "--face: only for solids, and not used here".into())
}

/// Names of layers that the file does not have: an error, or a note where the request is that of many inputs.
fn tell_unmatched(drawing: &mut Drawing, of_many: bool) -> Result<(), FailureReport> {
    let Some(Unmatched { asked, near }) = drawing.unmatched.first() else { return Ok(()) };
    let what = |asked: &str| format!("{asked}: no layer has this name");
    if !of_many {
        let help = match near.is_empty() {
            true => "the file has no layers".to_owned(),
            false => format!("layers: {}", near.join(", ")),
        };
        return Err(FailureReport::new(FailureKind::Request, what(asked), help));
    }
    let notes: Vec<String> = drawing.unmatched.iter().map(|unmatched| what(&unmatched.asked)).collect();
    drawing.notes.extend(notes);
    Ok(())
}

impl From<ImportError> for FailureReport {
    fn from(error: ImportError) -> Self {
        let ImportError { what, line, column, help } = error;
        let [line, column] = [line, column].map(|number| number.and_then(|n| u32::try_from(n).ok()));
        Self { line, column, ..Self::new(FailureKind::Unreadable, what, help) }
    }
}

/// The drawing in the unit and scale of the request. A drawing whose unit has no fixed length takes the name of the unit asked for.
fn in_units(mut drawing: Drawing, request: &Request) -> Result<Drawing, FailureReport> {
    let mut factor = request.scale.unwrap_or(1.0);
    if let Some(unit) = &request.unit {
        let wanted = metres(unit).ok_or_else(|| {
            let what = format!("--unit {unit}: no unit of length that is known here");
            FailureReport::new(
                FailureKind::Request,
                what,
                "nm, um, mm, cm, dm, m, km, in, ft, yd, mi, pt, pc or px, or a number of them as in '0.5 mm'",
            )
        })?;
        if let Some(own) = drawing.unit.as_ref().and_then(|(own, _)| metres(own)) {
            factor *= own / wanted;
        }
        drawing.unit = Some((unit.clone(), "--unit".into()));
    }
    Ok(if factor == 1.0 { drawing } else { scaled(drawing, factor) })
}

/// A drawing with every length times a factor.
fn scaled(mut drawing: Drawing, factor: f64) -> Drawing {
    let point = |p: Point| Point::new(p.x * factor, p.y * factor);
    if let Some(frame) = &mut drawing.frame {
        frame.origin = frame.origin.map(|x| x * factor);
    }
    for face in &mut drawing.faces {
        face.area = face.area.map(|area| area * factor * factor);
    }
    for DrawnCurve { curve, last_decimal, .. } in &mut drawing.curves {
        *curve = curve.transformed(Affine::scale(factor));
        *last_decimal *= factor;
    }
    for drawn in &mut drawing.points {
        drawn.at = point(drawn.at);
    }
    for entity in &mut drawing.off_plane {
        entity.ends = entity.ends.map(point);
    }
    for label in &mut drawing.labels {
        label.at = point(label.at);
    }
    for seed in &mut drawing.seeds {
        seed.at = point(seed.at);
        if let crate::domain::SeedKind::Region { max_area: Some(area), .. } = &mut seed.kind {
            *area *= factor * factor;
        }
    }
    for size in &mut drawing.sizes {
        match size {
            SizeRequest::Boundary { edge, .. }
            | SizeRequest::Region { edge, .. }
            | SizeRequest::Everywhere { edge } => {
                *edge *= factor;
            }
            SizeRequest::Near { from, to, edge, .. } => {
                (*from, *to) = (point(*from), point(*to));
                *edge *= factor;
            }
        }
    }
    drawing
}

/// Drawing → domain, as long as `watch` says to go on, within the request's tolerance or the one that `Healing` takes.
pub fn arrange(drawing: &Drawing, request: &Request, watch: &mut Watch) -> Result<Domain, FailureReport> {
    Healing::new(drawing, request).arrange(watch)
}

/// Where the request says to heal nothing: what the default tolerance would have mended. A note where that cannot be told.
pub fn unhealed(drawing: &Drawing, request: &Request, notes: &mut Vec<String>, watch: &mut Watch) -> Vec<Repair> {
    if request.tolerance != Some(0.0) {
        return Vec::new();
    }
    drawing.unhealed(watch).unwrap_or_else(|why| {
        notes.push(format!("--tolerance 0: it cannot be told what the default would heal: {why}"));
        Vec::new()
    })
}

impl From<ArrangeError> for FailureReport {
    fn from(error: ArrangeError) -> Self {
        let also_at = error.also_at.iter().map(|at| [at.x, at.y]).collect();
        Self { also_at, ..Self::new(FailureKind::Geometry, error.what, error.help).at(error.at) }
    }
}

impl From<Unarranged> for FailureReport {
    fn from(why: Unarranged) -> Self {
        match why {
            Unarranged::Invalid(error) => error.into(),
            Unarranged::Stopped(stopped) => stopped.into(),
        }
    }
}

impl From<Stopped> for FailureReport {
    fn from(Stopped: Stopped) -> Self {
        let stop = Stop { reason: StopReason::Cancelled, owed: 0, places: Vec::new(), angle_deg: None };
        no_mesh(&stop, "--timeout")
    }
}

impl From<RefineError> for FailureReport {
    fn from(error: RefineError) -> Self {
        Self::new(FailureKind::Geometry, error.what, error.help).at(error.at)
    }
}

/// Why a refinement that stopped has no mesh to show; `more` is the option that lets it run longer.
pub fn no_mesh(stop: &Stop, more: &str) -> FailureReport {
    let (what, help) = match stop.reason {
        StopReason::VertexBudget => {
            ("the vertex budget ended before there was a valid mesh", "give more by --max-vertices".into())
        }
        StopReason::Cancelled => ("the run was stopped before there was a valid mesh", format!("give more by {more}")),
        StopReason::Done | StopReason::Arithmetic | StopReason::NoProgress => (
            "features are nearer to each other than the coordinates can tell apart",
            "move the drawing nearer to the origin, or weld by a larger --tolerance".into(),
        ),
    };
    let mut failure = FailureReport::new(FailureKind::NoMesh, what, help);
    failure.stop = Some(Box::new(StopReport::new(stop)));
    match stop.places.first() {
        Some(&place) => failure.at(place),
        None => failure,
    }
}

/// A request made ready for one domain: what the engine is asked, and what the judge holds it to.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Largest turning of a curve before it is refined.
    pub tau_rad: f64,
    options: lopping::Options,
    /// Where that engine refines.
    gcdr: Option<Gcdr>,
}

/// What is asked of the engine for generalized constrained Delaunay refinement.
#[derive(Clone, Debug)]
struct Gcdr {
    options: gcdr::Options,
    steiner: Steiner,
    snap: Option<SnapTo>,
    seed: u64,
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
                record: request.densities.is_on(),
            },
            steiner: request.steiner,
            snap: request.snap.clone(),
            seed: request.seed,
        })
    }

    /// Holds δ₂, δ₁ and μ to (3.1)–(3.3). Corners below 60° have no interval: their segments are split on shells.
    fn check(&self, domain: &Domain) -> Result<(), FailureReport> {
        let rho = radius_edge_of(self.options.angle_min_rad);
        self.options.regions.check(rho, gcdr::least_angle(domain)).map_err(|violation| {
            let help = "give more by --delta2, --delta1 or --mu, or a smaller --min-angle";
            FailureReport::new(FailureKind::Request, violation.to_string(), help)
        })
    }

    fn strategy(&self) -> Box<dyn SteinerStrategy> {
        let angle = self.options.angle_min_rad;
        match self.steiner {
            Steiner::Center => Box::new(steiner::Center),
            Steiner::Offcenter => Box::new(steiner::OffCenter::new(angle, false)),
            Steiner::Optimal => Box::new(steiner::Optimal::new(angle, false)),
            Steiner::Extreme => Box::new(steiner::Extreme),
            Steiner::Random => Box::new(steiner::Random::new(self.seed)),
            Steiner::Size => Box::new(steiner::BySize),
            Steiner::Snap => match &self.snap {
                Some(SnapTo::Pitch(pitch)) => Box::new(steiner::Grid { pitch: *pitch }),
                Some(SnapTo::Places(places)) => {
                    Box::new(steiner::Places::new(places.iter().map(|&[x, y]| Point::new(x, y))))
                }
                // No request passes its check so.
                None => Box::new(steiner::Center),
            },
            Steiner::OffcenterFree => Box::new(steiner::OffCenter::new(angle, true)),
            Steiner::OptimalFree => Box::new(steiner::Optimal::new(angle, true)),
        }
    }

    fn promise(&self, foreign: bool) -> Promise {
        self.options.promise(self.steiner.is_free(), foreign)
    }

    /// As many steps as there are or are asked for, as long as the watch says to go on.
    fn refine(&self, domain: &Domain, steps: Option<u64>, watch: &mut Watch) -> Result<Refined, FailureReport> {
        let mut strategy = self.strategy();
        Ok(gcdr::refine(domain, &self.options, &mut *strategy, steps, watch)?)
    }
}

impl Plan {
    /// The domain, its curves cut to τ, and what is asked of it: corner arcs as fine as its guarantee needs.
    ///
    /// # Errors
    /// A `--size-of` whose name the domain does not know, more pieces than the vertex budget, or a watch that says stop.
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

    /// Of a mesh whose drawing is not known: a share of its diagonal cannot be told, and any name may be of a boundary or a region.
    pub fn without_domain(request: &Request) -> Self {
        let mut sizing = plain_sizing(request, None);
        for SizeOf { name, edge } in &request.size_of {
            sizing.sources.push(SizeSource::Boundary { name: name.clone(), edge: *edge });
            sizing.sources.push(SizeSource::Region { name: name.clone(), edge: *edge });
        }
        let options = engine_options(request, sizing);
        let gcdr = Gcdr::asked(request, &options);
        Self { tau_rad: request.tau_rad([]), options, gcdr }
    }

    pub fn sizing(&self) -> &Sizing {
        &self.options.sizing
    }

    fn demand(&self, domain: &Domain, watch: &mut Watch) -> Result<Demand, Stopped> {
        let circles = if self.gcdr.is_some() { Circles::Any } else { Circles::Empty };
        Demand::of(domain, &self.options, circles, watch)
    }

    /// Refines a domain whose curves turn at most τ to the angle asked for, as far as that goes.
    fn refine_once(&self, domain: &Domain, watch: &mut Watch) -> Result<Refined, FailureReport> {
        if let Some(gcdr) = &self.gcdr {
            return gcdr.refine(domain, None, watch);
        }
        Ok(lopping::refine(domain, &self.options, watch)?)
    }

    /// [`Plan::refine`], stopped as soon as every piece of a curve is an edge: the triangulation from which it refines.
    pub fn conform(&self, domain: &Domain, watch: &mut Watch) -> Result<Refined, FailureReport> {
        if let Some(gcdr) = &self.gcdr {
            return gcdr.refine(domain, Some(0), watch);
        }
        let mut lopping = Lopping::start(domain, &self.options)?;
        while lopping.progress().phase == "conforming" && watch(&lopping.progress()) && lopping.step() {}
        lopping.cancel();
        Ok(lopping.finish()?)
    }

    /// The first `steps` steps of [`Plan::refine`].
    pub fn refine_steps(&self, domain: &Domain, steps: u64) -> Result<Refined, FailureReport> {
        if let Some(gcdr) = &self.gcdr {
            return gcdr.refine(domain, Some(steps), &mut |_| true);
        }
        let mut lopping = Lopping::start(domain, &self.options)?;
        let mut left = steps;
        while left > 0 && lopping.step() {
            left -= 1;
        }
        if left == 0 {
            lopping.cancel();
        }
        Ok(lopping.finish()?)
    }

    fn promise(&self, foreign: bool) -> Promise {
        match &self.gcdr {
            Some(gcdr) => gcdr.promise(foreign),
            None => self.options.promise(foreign),
        }
    }

    /// Holds the densities that a run recorded to their bounds; none where it did not.
    pub fn densities(&self, domain: &Domain, mesh: &Mesh, insertions: &[Insertion]) -> Vec<Check> {
        let Some(gcdr) = self.gcdr.as_ref().filter(|gcdr| gcdr.options.record) else { return Vec::new() };
        let promise = gcdr.options.density_promise(domain).filter(|_| gcdr.strategy().disks() == Disks::Alike);
        verify::densities(domain, mesh, insertions, promise).into()
    }

    /// Holds a mesh of ours to what was asked, by its links to the domain's curves.
    pub fn judge(&self, domain: Option<&Domain>, mesh: &Mesh) -> Verdict {
        verify(domain, mesh, &self.promise(false))
    }

    /// Holds a mesh from a file to what was asked. Other programs drop or renumber what ties a mesh to its curves: where that does not hold,
    /// the mesh is judged by where its nodes lie, if it stands better so. Returns that mesh, without its ties, beside the verdict.
    pub fn judge_file(&self, domain: Option<&Domain>, mesh: &Mesh) -> (Verdict, Option<Mesh>) {
        let by_links = self.judge(domain, mesh);
        if domain.is_none() || by_links.kept() {
            return (by_links, None);
        }
        let untied = mesh.clone().untied();
        let by_place = verify(domain, &untied, &self.promise(true));
        if flaws(&by_place) < flaws(&by_links) { (by_place, Some(untied)) } else { (by_links, None) }
    }
}

/// A domain with its curves cut to τ, where that takes no more vertices than the mesh may have.
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
        let owed = needed - max_vertices;
        let stop = Stop { reason: StopReason::VertexBudget, owed, places, angle_deg: None };
        let failure = no_mesh(&stop, "--max-vertices");
        FailureReport {
            what: format!("pieces that turn at most {tau_rad:e} take {needed} vertices or more"),
            help: "let them turn more by --max-turning, or give more by --max-vertices".into(),
            ..failure
        }
    })
}

fn engine_options(request: &Request, sizing: Sizing) -> lopping::Options {
    lopping::Options {
        angle_min_rad: request.angle_min_rad(),
        beta: request.beta,
        shrinking: match request.ball_shrinking {
            BallShrinking::Batched => Shrinking::Batched,
            BallShrinking::Literal => Shrinking::Literal,
        },
        midpoint: match request.midpoint {
            Midpoint::Bisector => plane::Midpoint::Bisector,
            Midpoint::Angle => plane::Midpoint::Angle,
        },
        corner_arcs: request.corner_arcs.is_on().then_some(std::f64::consts::FRAC_PI_3),
        sizing,
        max_vertices: request.max_vertices,
    }
}

/// Sizes that the request asks for everywhere. `diagonal` is that of the drawing.
fn plain_sizing(request: &Request, diagonal: Option<f64>) -> Sizing {
    Sizing {
        max_area: request.max_area,
        max_edge: request.max_edge,
        min_edge: request.min_edge,
        chord_error: request.chord_error.and_then(|e| e.length(diagonal)),
        edge_turning_rad: request.edge_turning.deg().map(f64::to_radians),
        grade: request.grade,
        sources: Vec::new(),
        by_place: match &request.size {
            Some(Given::Expression(expression)) => Some(ByPlace { expression: expression.clone(), scale: 1.0 }),
            Some(Given::Samples(_)) | None => None,
        },
    }
}

/// The samples of `--size`, which grow by `--grade`.
fn samples(request: &Request) -> Vec<SizeSource> {
    let Some(Given::Samples(samples)) = &request.size else { return Vec::new() };
    let grade = request.grade.unwrap_or(SAMPLE_GRADE);
    let near =
        |&[x, y, edge]: &[f64; 3]| SizeSource::Near { from: Point::new(x, y), to: Point::new(x, y), edge, grade };
    samples.iter().map(near).collect()
}

/// Sizes of the request and of the drawing.
fn sizing(drawing: &Drawing, domain: &Domain, request: &Request) -> Result<Sizing, FailureReport> {
    let diagonal = drawing.bounds().map(|b| libm::hypot(b.width(), b.height()));
    let plain = plain_sizing(request, diagonal);
    let mut sizing = plain.with_requests(&drawing.sizes, |name| drawing.names.text(name).to_owned());
    sizing.sources.extend(samples(request));
    let undefined = request.size.as_ref().and_then(|size| size.undefined_at(domain.points().iter().copied()));
    if let Some(at) = undefined {
        let what = format!(
            "--size {} is no positive length",
            request.size.as_ref().map_or(String::new(), ToString::to_string)
        );
        let help = "an expression must be positive all over the drawing: max(h, …) keeps it so";
        return Err(FailureReport::new(FailureKind::Request, what, help).at(at));
    }
    let boundaries: BTreeSet<&str> = domain.curves().iter().map(|c| domain.name(c.name)).collect();
    // A region that is called so after the layer of its outline only has the size of that outline, not one of its own.
    let is_own = |region: &&Region| region.is_named || !boundaries.contains(domain.name(region.name));
    let regions: BTreeSet<&str> = domain.regions().iter().filter(is_own).map(|r| domain.name(r.name)).collect();
    for SizeOf { name, edge } in &request.size_of {
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

/// How a run ended, in words that do not depend on coordinates: what a reduced case must keep.
pub fn ending(outcome: &Outcome) -> String {
    if let Some(failure) = &outcome.report.failure {
        let kind = match failure.kind {
            FailureKind::Request => "request",
            FailureKind::Unreadable => "unreadable",
            FailureKind::Geometry => "geometry",
            FailureKind::NoMesh => "no mesh",
            FailureKind::Bug => "bug",
        };
        return format!("{kind}: {}", without_numbers(&failure.what));
    }
    let broken = outcome.verdict.as_ref().map(broken).unwrap_or_default();
    match outcome.report.stop.as_ref().map(|s| s.reason) {
        Some(StopReason::Done) | None if broken.is_empty() => "done".into(),
        Some(StopReason::Done) | None => format!("missed: {}", broken.join(", ")),
        Some(StopReason::VertexBudget) => "stopped: vertex budget".into(),
        Some(StopReason::Cancelled) => "stopped: timeout".into(),
        Some(StopReason::Arithmetic) => "stopped: arithmetic".into(),
        Some(StopReason::NoProgress) => "stopped: no progress".into(),
    }
}

/// `#` for every number of a text.
fn without_numbers(text: &str) -> String {
    let of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | 'e' | 'E');
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let sign = rest[..start].ends_with(['-', '+']);
        plain.push_str(&rest[..start - usize::from(sign)]);
        plain.push('#');
        let end = rest[start..].find(|c| !of_number(c)).map_or(rest.len(), |n| start + n);
        rest = &rest[end..];
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_forget_numbers() {
        assert_eq!(without_numbers("line 12 meets arc 7 at -1.5e-3, twice"), "line # meets arc # at #, twice");
        assert_eq!(without_numbers("no number"), "no number");
        assert_eq!(without_numbers("3"), "#");
    }
}
