//! Generalized constrained Delaunay refinement, GCDR (Foteinos, Chernikov & Chrisochoides 2010, Algorithm 2).
//!
//! The engine keeps a constrained Delaunay triangulation of vertices and segments. As long as a triangle is skinny, a
//! point p of its selection disk is chosen (type A). If a segment occludes p from the triangle, p is rejected. Let s be
//! the nearest such segment. The free vertices in the diametral circle of s that are visible from s are deleted, and s
//! is split within its selection interval: by a point of type C if another vertex in its diametral circle is visible
//! from s, else of type B. If no segment occludes p, p is inserted. A [`SteinerStrategy`] chooses the points.
//!
//! ```text
//!   t skinny ──▶ p chosen in its disk ──┬─ p visible from t ─────▶ p is inserted                     (type A)
//!                                       └─ s occludes p ─────────▶ free vertices near s are deleted,
//!                                                                  s is split                  (type B or C)
//! ```
//!
//! *What is proven.* It terminates on segments that meet at 60° and more, for angles up to 30° and points within their
//! regions (Theorem 6.1). Good grading is proven where C₁C₂ > 1, up to 26.57° for centres
//! ([`Regions::least_densities`]); above, it is observed. Off-centres and locally optimal points have larger
//! [disks](steiner::Disks::ByShape) with the same bounds on insertion radii. Their termination is proven to the same
//! angle, their grading is observed. Above 30°, with a [free](SteinerStrategy::is_free) strategy, on curves and at
//! sharper corners, termination is observed, and the budget ends a run that does not end.
//!
//! What the paper leaves open, and how it is done here:
//!
//! - *Curves.* A segment is the chord of a subcurve. Its split point is taken on the curve, above the place chosen on
//!   the chord. At the start `chords` splits curves until their chords are a valid PSLG, and stay one whatever is split
//!   later. To split a subcurve, its chord is removed from the triangulation, the point is inserted and the two new
//!   chords are joined; regions are labelled again there.
//! - *Corners sharper than 60°.* Segments that end there are split on concentric shells (Ruppert 1995), at distances
//!   from the corner that are round binary numbers. A triangle is exempt if its shortest edge lies across the corner,
//!   from one curve to the other, with ends equally far from the corner: its small angle is that of the input. Curves
//!   that leave a sharp corner are split together, for the reason given in `chords`.
//! - *Order.* Algorithm 2 leaves open which triangle comes first. First come segments that subtend more than 180° − 2κ
//!   at a vertex that will not be deleted. They must be split in any case, and a late split would delete vertices that
//!   were inserted beside them. Then comes the order of the strategy.
//! - *Rounding.* Decisions are made on the rounded point. A point that would not remove its triangle is not inserted,
//!   and the triangle is unresolved.
//!
//! *Which engine.* Of 180 drawings (outlines, maps, DXF, SVG) at 20.7° with free optimal points, this engine ends on
//! all on which corner lopping ends, and on all but one with fewer triangles: a fourth to a half of them by folder, in
//! the geometric mean. That holds for straight and curved input, with and without sharp corners. So the choice does not
//! depend on the drawing but on what is asked of the mesh, and there is no engine `auto`. Corner lopping proves its
//! angle on more input, bounds the largest angle, and makes a whole Delaunay triangulation with empty diametral
//! circles. This engine makes fewer triangles, and larger angles.

mod choices;
mod chords;
pub mod parameters;
mod segments;
pub mod steiner;
mod triangles;

use super::constrained::Constrained;
use super::extraction::Extraction;
use super::labelling;
use super::queue::{self, Candidate};
use super::refined::{RefineError, Refined};
use super::refinement::Refinement;
use crate::domain::Domain;
use crate::geometry::{self, Point};
use crate::ids::{CurveId, FanId, Id, IdVec, PointId, SubcurveId, TriangleId, VertexId};
use crate::mesh::{Insertion, InsertionKind};
use crate::promise::{ConstrainedPromise, DensityPromise, EnginePromise, Promise};
use crate::refine::{Counters, Engine, Stop, StopReason, Until, drive};
use crate::size::Sizing;
use crate::watch::{Progress, Watch};
pub use choices::{Choices, SnapTo, Steiner};
use chords::Beginning;
use parameters::radius_edge_of;
pub use parameters::{Regions, Violation};
use std::f64::consts::FRAC_PI_3;
pub use steiner::SteinerStrategy;

/// The options of the engine.
#[derive(Clone, Debug)]
pub struct Options {
    /// κ, the smallest angle asked for, in radians; ρ̄ = 1/(2 sin κ).
    pub angle_min_rad: f64,
    /// The sizes of the selection regions: δ₂, δ₁ and μ.
    pub regions: Regions,
    /// The limits on edges and areas.
    pub sizing: Sizing,
    /// Vertices after which nothing is split any more.
    pub max_vertices: usize,
    /// Whether every insertion is recorded, for densities.
    pub record: bool,
}

/// Corners up to this angle (radians) are sharp: less than 60°, by more than rounding.
pub const SHARP_RAD: f64 = FRAC_PI_3 - 1e-8;

impl Options {
    /// What the verifier checks a mesh for that was made by these options and a strategy that is `free` or not;
    /// `foreign`: it comes from elsewhere, without links to curves.
    pub fn promise(&self, free: bool, foreign: bool) -> Promise {
        let proven = self.regions.proven_above(self.angle_min_rad);
        Promise {
            angle_min_rad: (self.angle_min_rad > 0.0).then_some(self.angle_min_rad),
            sizing: self.sizing.clone(),
            engine: EnginePromise::Constrained(ConstrainedPromise { proven_above_rad: proven.filter(|_| !free) }),
            foreign,
        }
    }
}

/// The smallest angle of the domain that is not sharp: 60° or more, in radians; π where there is none.
pub fn least_angle(domain: &Domain) -> f64 {
    let angles = domain.points().ids().filter_map(|p| domain.corner(p)).map(|corner| corner.angle_rad);
    angles.filter(|&a| a > SHARP_RAD).fold(std::f64::consts::PI, f64::min)
}

/// The source of a vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
enum VertexSource {
    Input(PointId),
    OnCurve(CurveId),
    Free,
}

/// A fan: the subcurves from a sharp corner to one distance from it, which are split together.
///
/// ```text
///                x        p x and p y are the spokes of the fan of the corner p, at its radius |px| = |py|.
///              ╱  :       Cut at half the radius, p x₁ and p y₁ are the new spokes.
///           x₁     :      x₁x and y₁y are ordinary; where their chords might cross, they are cut once more.
///         ╱   :     :
///       ╱      :     :
///     p ────── y₁─── y
/// ```
struct Fan {
    corner: PointId,
    radius: f64,
    spokes: Vec<SubcurveId>,
}

/// The engine between two steps.
pub struct Gcdr<'s> {
    state: Refinement,
    options: Options,
    mesh: Constrained,
    origins: IdVec<VertexId, VertexSource>,
    /// Number of vertices that were not deleted.
    alive: usize,
    /// Number of free vertices among them.
    free: usize,
    fans: IdVec<FanId, Fan>,
    /// Whether curves meet at less than 60°.
    sharp: IdVec<PointId, bool>,
    strategy: &'s mut dyn SteinerStrategy,
    /// Triangles to be assessed; empty between steps, kept to reuse its memory.
    touched: Vec<TriangleId>,
    insertions: Vec<Insertion>,
}

/// Meshes a domain whose curves turn at most π/3 each, until `watch` says to stop.
///
/// # Errors
/// Where coordinates cannot tell features apart.
pub fn refine(
    domain: &Domain,
    options: &Options,
    strategy: &mut dyn SteinerStrategy,
    until: Until,
    watch: &mut Watch,
) -> Result<Refined, RefineError> {
    match Gcdr::start(domain, options, strategy, watch)? {
        Start::Ready(gcdr) => drive(*gcdr, until, watch),
        Start::Ended(refined) => Ok(*refined),
    }
}

impl Options {
    /// The bounds on the densities of a mesh of `domain`, for a strategy with [`Disks::Alike`](steiner::Disks::Alike)
    /// that is not free. `None` on curves, at angles below 60°, and where sizes are asked for, since those insert
    /// vertices of their own.
    pub fn density_promise(&self, domain: &Domain) -> Option<DensityPromise> {
        let straight = domain.curves().iter().all(|c| c.curve.is_straight());
        let sharp = |p: PointId| domain.corner(p).is_some_and(|corner| corner.angle_rad <= SHARP_RAD);
        // Along straight segments nothing turns.
        let unsized_but_for_turning =
            self.sizing == Sizing { edge_turning_rad: self.sizing.edge_turning_rad, ..Sizing::default() };
        let bounded =
            straight && unsized_but_for_turning && self.angle_min_rad > 0.0 && !domain.points().ids().any(sharp);
        bounded.then(|| self.regions.density_promise(radius_edge_of(self.angle_min_rad), least_angle(domain)))
    }
}

/// The result of the start.
pub enum Start<'s> {
    /// There is a triangulation to refine.
    Ready(Box<Gcdr<'s>>),
    /// The watch stopped the run, or the budget was used up, before there was a triangulation.
    Ended(Box<Refined>),
}

impl<'s> Gcdr<'s> {
    /// The constrained Delaunay triangulation of chords, with regions.
    ///
    /// # Errors
    /// As [`refine`].
    pub fn start(
        domain: &Domain,
        options: &Options,
        strategy: &'s mut dyn SteinerStrategy,
        watch: &mut Watch,
    ) -> Result<Start<'s>, RefineError> {
        let patience = triangles::patience(strategy.order(), options.angle_min_rad);
        let mut state = Refinement::new(domain, &options.sizing, options.angle_min_rad, patience);
        let is_sharp = |p: PointId| state.domain.corner(p).is_some_and(|corner| corner.angle_rad <= SHARP_RAD);
        let sharp: IdVec<PointId, bool> = state.domain.points().ids().map(is_sharp).collect();
        let mut beginning = Beginning::new(&state.domain, &sharp, state.resolution);
        beginning.cut_curves(&state.field);
        let stopped = beginning.part_hulls(options.max_vertices, watch).is_err();
        if stopped || beginning.points.len() > options.max_vertices {
            let reason = if stopped { StopReason::Cancelled } else { StopReason::VertexBudget };
            let stop = Stop { reason, unresolved: 1, places: Vec::new(), angle_deg: None };
            return Ok(Start::Ended(Box::new(Refined {
                mesh: None,
                vertices: beginning.points.len(),
                stop,
                counters: Counters::default(),
                insertions: Vec::new(),
            })));
        }
        let mesh = triangulated(&beginning).map_err(|e| e.scaled(1.0 / state.scale))?;
        let Beginning { origins, subcurves, fans, .. } = beginning;
        state.subcurves = subcurves;
        let mut gcdr = Self {
            state,
            touched: Vec::new(),
            alive: origins.len(),
            free: 0,
            options: options.clone(),
            insertions: Vec::new(),
            mesh,
            origins,
            fans,
            sharp,
            strategy,
        };
        let Self { state, mesh, origins, .. } = &mut gcdr;
        let input = state.domain.points().len();
        state.counters.add("vertices_input", input as u64);
        state.counters.add("vertices_chord", (origins.len() - input) as u64);
        let live: Vec<SubcurveId> =
            state.subcurves.ids().rev().filter(|&id| !state.subcurves.get(id).is_gone()).collect();
        live.into_iter().for_each(|id| state.enqueue(id));
        mesh.take_touched(&mut Vec::new());
        let mut all = labelling::all_triangles(mesh.kernel());
        state.labeller.label(mesh.kernel_mut(), &state.subcurves, state.domain.curves(), &mut all);
        all.into_iter().for_each(|t| gcdr.assess(t));
        Ok(Start::Ready(Box::new(gcdr)))
    }

    /// Records an insertion. In a constrained Delaunay triangulation the nearest visible vertex is a neighbour.
    fn record(&mut self, v: VertexId, kind: InsertionKind, parent: Option<VertexId>) {
        let topology = self.mesh.topology();
        let at = self.mesh.point(v);
        let away = topology.sides_from(v).map(|s| topology.target(s)).filter(|&w| w != super::triangulation::GHOST);
        let radius = away.map(|w| at.distance(self.mesh.point(w))).fold(f64::INFINITY, f64::min);
        self.insertions.push(Insertion { kind, at, radius, parent: parent.map(|p| self.mesh.point(p)) });
    }

    /// Whether the budget is used up: by vertices, or by four times as many insertions, where most are deleted again.
    fn is_spent(&self) -> bool {
        let most = self.options.max_vertices;
        self.alive >= most || self.origins.len() >= most.saturating_mul(4)
    }

    fn is_side(&self, id: SubcurveId) -> bool {
        let [x, y] = self.state.subcurves.get(id).ends;
        let topology = self.mesh.topology();
        topology.side_between(y, x).is_some_and(|s| topology.subcurve(s) == Some(id))
    }
}

impl Engine for Gcdr<'_> {
    type Outcome = Result<Refined, RefineError>;

    /// Splits the first of these: a subcurve that is too large, the first skinny triangle, the largest triangle.
    /// `false`: there is none, or the run is over.
    fn step(&mut self) -> bool {
        if self.state.reason == StopReason::Done
            && let Some(subcurve) = self.state.queue.pop()
        {
            self.look_at_subcurve(subcurve);
            return true;
        }
        if self.state.reason != StopReason::Done {
            return false;
        }
        match self.state.bad.next(self.alive) {
            Some(candidate) => self.split_triangle(candidate),
            None => return false,
        }
        true
    }

    fn cancel(&mut self) {
        self.state.cancel();
    }

    fn progress(&self) -> Progress {
        let queued = self.state.queue.len() + self.state.bad.len();
        Progress { phase: "refining", vertices: self.alive, queued }
    }

    /// The mesh of the kept regions, in the domain's own scale.
    ///
    /// # Errors
    /// Where coordinates ended a split half-way.
    fn finish(mut self) -> Self::Outcome {
        if self.state.subcurves.ids().any(|id| !self.state.subcurves.get(id).is_gone() && !self.is_side(id)) {
            return Err(self.state.too_near_error());
        }
        const PLACES: usize = 16;
        let (unresolved, places) = self.state.bad.unresolved(self.mesh.kernel(), PLACES);
        let extraction =
            Extraction { domain: &self.state.domain, delaunay: self.mesh.kernel(), subcurves: &self.state.subcurves };
        let mesh = Some(extraction.mesh().scaled(1.0 / self.state.scale));
        let down = |p: Point| geometry::scaled(p, 1.0 / self.state.scale);
        let unscaled = |i: &Insertion| Insertion {
            at: down(i.at),
            radius: i.radius / self.state.scale,
            parent: i.parent.map(down),
            ..*i
        };
        let insertions = self.insertions.iter().map(unscaled).collect();
        self.state.count_kernel(self.mesh.kernel().counters());
        let stop = self.state.stop(self.state.reason, unresolved, places);
        Ok(Refined { mesh, vertices: self.alive, stop, counters: self.state.counters, insertions })
    }
}

/// The constrained Delaunay triangulation of all chords.
fn triangulated(beginning: &Beginning) -> Result<Constrained, RefineError> {
    let at = |i: usize| beginning.points[i];
    let mut mesh =
        Constrained::new(beginning.points.clone()).map_err(|why| RefineError::degenerate(&why, &beginning.points))?;
    for id in beginning.subcurves.ids() {
        let subcurve = beginning.subcurves.get(id);
        if subcurve.is_gone() {
            continue;
        }
        let [a, b] = subcurve.ends;
        mesh.join(a, b, id).map_err(|_| RefineError::too_near(at(a.index())))?;
    }
    Ok(mesh)
}
