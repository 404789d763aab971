//! Corner lopping (Pav & Walkington 2005, *Delaunay Refinement by Corner Lopping*, Algorithm 1, with the corner arcs of
//! section 6).
//!
//! The engine keeps P′ ⊇ P, the subcurves C′ and D(P′), the whole Delaunay triangulation. A step applies the first of
//! these rules whose condition holds:
//!
//! 1. *splitball*: a vertex lies in the ball B(p) of an acute corner. d(p) shrinks by β, and each curve at p is split
//!    where it leaves the ball.
//! 2. *splitcurve*: a vertex lies in the open diametral circle of a subcurve's chord, or the subcurve is larger than
//!    permitted. The subcurve is split.
//! 3. *corner arcs*: the arcs of a ball are due, that is, not inserted since the ball was made or last shrank. They
//!    are inserted once they are neither too near to a vertex nor encroach a subcurve.
//! 4. *splittri*: a triangle has an angle below κ, or is larger than permitted. Its circumcenter is inserted, unless it
//!    encroaches a subcurve, which is split instead.
//!
//! Where this differs from the printed algorithm, and why:
//!
//! - *Order.* Section 6 tests the room for the arcs whenever a ball shrinks. Here the ball shrinks first, rules 1 and 2
//!   run until neither applies, and only then the arcs are tested. Every subcurve is an edge then, so the cavity of a
//!   vertex of an arc contains all that it would encroach. The conditions are those of the corrected section 6. The
//!   ball shrinks where a vertex is nearer to a pseudo midpoint than d/2, or where the midpoint encroaches a subcurve
//!   shorter than d; a longer subcurve is split.
//! - *Neighbouring arcs.* A vertex on the arc of another ball does not count as too near to a pseudo midpoint. A
//!   subcurve of an arc that a pseudo midpoint encroaches is split, however short. If they shrank the ball, lfs(p) ≤
//!   C₀·d(p) would fail: with |pq| = lfs₀(p) and both balls of their first radius, the two arcs come within (√2−1)·d(p)
//!   < d(p)/2 of each other. The proof holds all the same: since d(p) + d(q) ≤ 2(√2−1)|pq|, the arcs are always at
//!   least (3−2√2)·|pq| apart, and subcurves of arcs shorter than twice that are not encroached.
//! - *Batched shrinking.* d(p) ← β·d(p) is repeated until no vertex lies in the ball, and the curves are split once.
//!   The literal rule splits at every step, which leaves a shell of vertices for each ([`Shrinking::Literal`]).
//! - *Incident vertices.* Points on the border of a ball are rounded. By Lemma 3 only vertices of curves that do not
//!   end at p can lie in B(p). So only those are tested.
//! - *Rounded circumcenters.* Each decision (ball, encroachment, cavity) is made on the rounded point. A circumcenter
//!   whose cavity lacks its triangle would not remove it. It is not inserted, and the triangle is unresolved.
//!
//! It terminates by Corollary 3 for κ below [`guaranteed_angle`](crate::promise::guaranteed_angle). Above that the
//! vertex budget ends a run that does not end by itself. The result says which it was. If coordinates can no longer
//! split a subcurve, the run ends with its place.

mod balls;
mod begin;
mod corner_arcs;
mod splitball;
mod splitcurve;
pub(super) mod splittri;

use super::extraction::Extraction;
use super::insert::Kernel;
use super::queue::{self, Candidate, DETAIL_RAD};
pub use super::refined::{RefineError, Refined};
use super::refinement::Refinement;
use super::subcurves::Midpoint;
use crate::domain::Domain;
use crate::geometry::Point;
use crate::ids::{BallId, CurveId, IdVec, PointId, SubcurveId, TriangleId, VertexId};
use crate::mesh::{Ball, Mesh};
use crate::options::OutOfBounds;
use crate::promise::{EnginePromise, LoppingPromise, Promise};
use crate::refine::{CONFORMING, Engine, StopReason, Until, drive};
use crate::size::Sizing;
use crate::watch::{Progress, Watch};
use balls::Balls;
use begin::Beginning;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_3;

/// The options of the engine.
#[derive(Clone, Debug)]
pub struct Options {
    /// κ, the smallest angle asked for, in radians.
    pub angle_min_rad: f64,
    /// The choices that the algorithm leaves open: β, shrinking and midpoints.
    pub rules: Rules,
    /// Largest turning of a corner arc, in radians; `None`: no corner arcs.
    pub corner_arcs: Option<f64>,
    /// The limits on edges and areas.
    pub sizing: Sizing,
    /// Vertices after which no triangle is split any more.
    pub max_vertices: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            angle_min_rad: 20.7f64.to_radians(),
            rules: Rules::default(),
            corner_arcs: Some(FRAC_PI_3),
            sizing: Sizing::default(),
            max_vertices: 5_000_000,
        }
    }
}

impl Options {
    /// What the verifier checks a mesh for that was made by these options; `foreign`: it comes from elsewhere, without
    /// links to curves.
    pub fn promise(&self, foreign: bool) -> Promise {
        let lopping = LoppingPromise {
            beta: self.rules.beta,
            arc_turning_rad: self.corner_arcs,
            midpoint_bisector: self.rules.midpoint == Midpoint::Bisector,
        };
        Promise {
            angle_min_rad: (self.angle_min_rad > 0.0).then_some(self.angle_min_rad),
            sizing: self.sizing.clone(),
            engine: EnginePromise::Lopping(lopping),
            foreign,
        }
    }
}

/// What the paper leaves to choose.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default)]
pub struct Rules {
    /// Factor by which a protecting ball shrinks, from 0.5 to below 1.
    #[schemars(extend("group" = "engine", "value" = "B", "rare" = true))]
    pub beta: f64,
    /// Shrink until the ball is clear, or insert at every step as printed in the paper.
    #[schemars(extend("group" = "engine", "value" = "HOW", "rare" = true))]
    pub ball_shrinking: Shrinking,
    /// Where a curve is split.
    #[schemars(extend("group" = "engine", "value" = "RULE", "rare" = true))]
    pub midpoint: Midpoint,
}

impl Default for Rules {
    fn default() -> Self {
        // The paper's own β: balls stay large.
        Self { beta: 0.95, ball_shrinking: Shrinking::Batched, midpoint: Midpoint::Bisector }
    }
}

impl Rules {
    /// The first rule that is out of its bounds.
    ///
    /// # Errors
    /// With the option and its value.
    pub fn check(&self) -> Result<(), OutOfBounds> {
        let holds = (0.5..1.0).contains(&self.beta);
        OutOfBounds::unless(holds, "beta", &self.beta, "a factor from 0.5 to below 1 is needed")
    }
}

/// How a ball shrinks when a vertex lies in it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Shrinking {
    /// Shrink until the ball is clear, then insert once.
    #[default]
    Batched,
    /// Insert a shell for every step, as printed in the paper.
    Literal,
}

/// Meshes a domain whose curves turn at most π/3 each, until `watch` says to stop. What is needed for a valid mesh is
/// still done then.
///
/// # Errors
/// Where coordinates cannot tell features apart.
pub fn refine(domain: &Domain, options: &Options, until: Until, watch: &mut Watch) -> Result<Refined, RefineError> {
    drive(Lopping::start(domain, options)?, until, watch)
}

/// The source of a vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
enum VertexOrigin {
    Input(PointId),
    OnCurve(CurveId),
    /// On a corner arc of a ball, present or withdrawn.
    OnArc(BallId),
    Free,
}

/// The engine between two steps.
pub struct Lopping {
    state: Refinement,
    options: Options,
    delaunay: Kernel,
    origins: IdVec<VertexId, VertexOrigin>,
    balls: Balls,
    /// Balls in which a vertex lies.
    intruded: VecDeque<BallId>,
    /// Balls whose arcs are due: not inserted since the ball was made or last shrank.
    arcs_due: VecDeque<BallId>,
    /// Triangles made since the last labelling.
    fresh: Vec<TriangleId>,
    labelled: bool,
}

/// The rule that a step applies: the first that can be applied.
enum Rule {
    ShrinkBall(BallId),
    Look(SubcurveId),
    Label,
    PlaceArcs(BallId),
    Split(Candidate),
    Rest,
}

impl Lopping {
    /// P, its balls, and the Delaunay triangulation of P and the points on the balls.
    ///
    /// # Errors
    /// Where the points have no triangulation: two of them coincide, all lie on one line, or a coordinate is out of the
    /// range of exact signs.
    pub fn start(domain: &Domain, options: &Options) -> Result<Self, RefineError> {
        let [sin_min, sin_detail] = [options.angle_min_rad, DETAIL_RAD].map(libm::sin);
        let patience = queue::by_angle(1.0 - sin_detail * sin_detail / (sin_min * sin_min));
        let mut state = Refinement::new(domain, &options.sizing, options.angle_min_rad, patience);
        let mut beginning = Beginning::new(&state.domain, Balls::at_birth(&state.domain, &state.field));
        beginning.cut_curves();
        let delaunay = beginning.triangulate(options.rules.midpoint).map_err(|e| e.scaled(1.0 / state.scale))?;
        let Beginning { origins, subcurves, balls, .. } = beginning;
        state.subcurves = subcurves;
        state.subcurves.ids().collect::<Vec<_>>().into_iter().for_each(|subcurve| state.enqueue(subcurve));
        let input = state.domain.points().len();
        state.counters.add("vertices_input", input as u64);
        state.counters.add("vertices_ball", (origins.len() - input) as u64);
        Ok(Self {
            state,
            intruded: VecDeque::new(),
            arcs_due: if options.corner_arcs.is_some() { balls.ids().collect() } else { VecDeque::new() },
            fresh: Vec::new(),
            labelled: false,
            options: options.clone(),
            delaunay,
            origins,
            balls,
        })
    }

    fn first_rule(&mut self) -> Rule {
        // A run that is stopped before there was a valid mesh has none to restore.
        let stuck =
            self.state.reason == StopReason::Arithmetic || self.state.reason == StopReason::Cancelled && !self.labelled;
        if stuck || self.origins.len() > self.most_vertices() {
            return Rule::Rest;
        }
        if let Some(ball) = self.intruded.pop_front() {
            return Rule::ShrinkBall(ball);
        }
        if let Some(subcurve) = self.state.queue.pop() {
            return Rule::Look(subcurve);
        }
        if !self.labelled || !self.fresh.is_empty() {
            return Rule::Label;
        }
        if self.state.reason != StopReason::Done {
            return Rule::Rest;
        }
        if let Some(ball) = self.arcs_due.pop_front() {
            return Rule::PlaceArcs(ball);
        }
        match self.state.bad.next(self.origins.len()) {
            Some(candidate) => Rule::Split(candidate),
            None => Rule::Rest,
        }
    }

    /// The vertex budget. Once there was a valid mesh it is twice as much, so that a step under way can end in a valid
    /// mesh.
    fn most_vertices(&self) -> usize {
        self.options.max_vertices.saturating_mul(if self.labelled { 2 } else { 1 })
    }

    /// Whether every subcurve is an edge that nothing encroaches, and every triangle has its region.
    fn is_conforming(&self) -> bool {
        self.labelled && self.intruded.is_empty() && self.state.queue.is_empty() && self.fresh.is_empty()
    }

    fn mesh(&self) -> Mesh {
        let extraction =
            Extraction { domain: &self.state.domain, delaunay: &self.delaunay, subcurves: &self.state.subcurves };
        let balls = self.balls.ids().map(|id| self.balls.get(id));
        let balls = balls.map(|b| Ball { corner: b.corner, radius: b.radius, why: b.why }).collect();
        Mesh { balls, ..extraction.mesh() }
    }

    /// The number of subcurves and triangles that still miss a bound, and some of their places: shortest subcurves
    /// first.
    fn unresolved(&mut self) -> (usize, Vec<Point>) {
        const PLACES: usize = 16;
        let mut subcurves: Vec<(f64, Point)> = self.state.queue.iter().map(|&id| self.length_and_place(id)).collect();
        subcurves.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut unresolved = subcurves.len();
        let mut places: Vec<Point> = subcurves.into_iter().map(|(_, at)| at).take(PLACES).collect();
        let (triangles, more) = self.state.bad.unresolved(&self.delaunay, PLACES - places.len());
        unresolved += triangles;
        places.extend(more);
        (unresolved, places)
    }

    fn length_and_place(&self, id: SubcurveId) -> (f64, Point) {
        let [x, y] = self.state.subcurves.get(id).ends.map(|v| self.delaunay.point(v));
        (x.distance(y), x.midpoint(y))
    }
}

impl Engine for Lopping {
    type Outcome = Result<Refined, RefineError>;

    /// Applies the first rule whose condition holds. `false`: none holds, or the run is over.
    fn step(&mut self) -> bool {
        match self.first_rule() {
            Rule::ShrinkBall(ball) => self.shrink_ball(ball),
            Rule::Look(subcurve) => self.look_at_subcurve(subcurve),
            Rule::Label => self.label(),
            Rule::PlaceArcs(ball) => self.place_arcs(ball),
            Rule::Split(candidate) => self.split_triangle(candidate),
            Rule::Rest => return false,
        }
        true
    }

    /// Ends the refinement of triangles. What is needed for a valid mesh is still done.
    fn cancel(&mut self) {
        self.state.cancel();
    }

    fn progress(&self) -> Progress {
        let phase = if self.labelled { "refining" } else { CONFORMING };
        let queued = self.state.queue.len() + self.state.bad.len();
        Progress { phase, vertices: self.origins.len(), queued }
    }

    /// The mesh of the kept regions, in the domain's own scale.
    fn finish(mut self) -> Self::Outcome {
        if self.state.reason == StopReason::Arithmetic && !self.is_conforming() {
            return Err(self.state.too_near_error());
        }
        let (unresolved, places) = self.unresolved();
        let reason = match self.state.reason {
            StopReason::Done if !self.is_conforming() => StopReason::VertexBudget,
            reason => reason,
        };
        let mesh = self.is_conforming().then(|| self.mesh().scaled(1.0 / self.state.scale));
        let kernel = self.delaunay.counters();
        self.state.counters.add("walk_steps", kernel.walk_steps);
        self.state.count_kernel(kernel);
        let stop = self.state.stop(reason, unresolved, places);
        let vertices = self.origins.len();
        Ok(Refined { mesh, vertices, stop, counters: self.state.counters, insertions: Vec::new() })
    }
}
