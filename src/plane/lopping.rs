//! Corner lopping (Pav & Walkington 2005, *Delaunay Refinement by Corner Lopping*, Algorithm 1, with the corner arcs of section 6).
//!
//! The engine keeps P′ ⊇ P, the subcurves C′ and D(P′), the whole Delaunay triangulation, and applies the first rule that can be:
//!
//! 1. *splitball*: a vertex lies in the ball B(p) of an acute corner: d(p) shrinks by β, and each curve at p is cut where it leaves
//!    the ball.
//! 2. *splitcurve*: a vertex lies in the open diametral circle of a piece's chord, or the piece is larger than asked.
//! 3. *corner arcs*: a ball whose arcs are due gets them, once they would neither crowd a vertex nor encroach a piece.
//! 4. *splittri*: a triangle has an angle below κ, or is larger than asked: its circumcenter goes in, unless it encroaches a piece,
//!    which is split instead.
//!
//! Where this differs from the printed algorithm, and why:
//!
//! - *Order.* Section 6 looks for room for the arcs whenever a ball is cut; here the cut is made first, rules 1 and 2 run until neither
//!   applies, and only then are the arcs looked at. Every piece is an edge at that moment, so what an arc's vertex would encroach is read
//!   off its cavity. The conditions are those of the corrected section 6: a pseudo midpoint with a vertex nearer than d/2, or that
//!   encroaches a piece shorter than d, shrinks the ball; a longer piece is split.
//! - *Neighbouring arcs.* A vertex on the arc of another ball does not crowd a pseudo midpoint, and an arc piece that it encroaches is
//!   split, however short. Were they to shrink the ball, lfs(p) ≤ C₀·d(p) would fail: with |pq| = lfs₀(p) and both balls at birth, the
//!   two arcs come within (√2−1)·d(p) < d(p)/2 of each other. Nothing is lost: d(p) + d(q) ≤ 2(√2−1)|pq| keeps them at least
//!   (3−2√2)·|pq| apart at all times, and arc pieces shorter than twice that are not encroached.
//! - *Batched shrinking.* d(p) ← β·d(p) is repeated until the ball is clear, and the curves are cut once. The literal rule cuts at every
//!   step, which leaves a shell of vertices a step ([`Shrinking::Literal`]).
//! - *Incident vertices.* Ball points are rounded. Lemma 3 says that only vertices of curves that do not end at p come into B(p); so only
//!   those are looked for.
//! - *Rounded circumcenters.* Each decision (ball, encroachment, cavity) is made on the rounded point. A circumcenter outside its own
//!   cavity would not remove its triangle: it is not inserted, and the triangle is owed.
//!
//! Termination is Corollary 3's for κ below [`guaranteed_angle`]; beyond it the vertex budget ends what does not end by itself. The
//! result says which it was. A piece that coordinates cannot split any more ends the run with its place.

use super::balls::Balls;
use super::carve;
use super::insert::{Cavity, Degenerate, Delaunay, Location};
use super::subcurves::{Carrier, Midpoint, Standing, Subcurves, split_parameter};
use super::triangulation::{GHOST, Side};
use crate::curve::{Curve, End};
use crate::domain::Domain;
use crate::geometry::exact::{CircleSide, in_circle, in_diametral};
use crate::geometry::{self, Point, Vec2};
use crate::ids::{BallId, CurveId, Id, IdVec, PieceId, PointId, TriangleId, VertexId};
use crate::mesh::verify::guaranteed_angle;
use crate::mesh::{self, BallReason, CurveEdge, CurveLink, Mesh};
use crate::refine::{Counters, Progress, Stop, StopReason, WorstFirst};
use crate::size::{SizeField, Sizing};
use std::collections::VecDeque;
use std::f64::consts::{FRAC_PI_3, TAU};

/// What is asked of the engine.
#[derive(Clone, Debug)]
pub struct Options {
    /// κ.
    pub angle_min_rad: f64,
    /// β, ½ ≤ β < 1.
    pub beta: f64,
    pub shrinking: Shrinking,
    pub midpoint: Midpoint,
    /// Largest turning of a corner arc; `None`: no corner arcs.
    pub corner_arcs: Option<f64>,
    pub sizing: Sizing,
    /// Vertices after which no triangle is split any more.
    pub max_vertices: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            angle_min_rad: 20.7f64.to_radians(),
            beta: 0.95,
            shrinking: Shrinking::Batched,
            midpoint: Midpoint::Bisector,
            corner_arcs: Some(FRAC_PI_3),
            sizing: Sizing::default(),
            max_vertices: 5_000_000,
        }
    }
}

/// How a ball shrinks when a vertex comes in.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Shrinking {
    /// By β until it is clear; then the curves are cut.
    #[default]
    Batched,
    /// By β, cutting the curves at every step, as printed.
    Literal,
}

/// A refined mesh, and how it ended.
#[derive(Clone, Debug)]
pub struct Refined {
    /// `None` where the budget ended before the mesh was valid.
    pub mesh: Option<Mesh>,
    pub stop: Stop,
    pub counters: Counters,
}

/// Why a domain cannot be meshed.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("{what} at ({}, {})", at.x, at.y)]
pub struct RefineError {
    pub what: String,
    pub at: Point,
    pub help: String,
}

/// Meshes a domain whose curves turn at most π/3 each. `watch` is told of the progress every few thousand steps; `false` stops.
pub fn refine(
    domain: &Domain,
    options: &Options,
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Refined, RefineError> {
    let mut lopping = Lopping::start(domain, options)?;
    let mut steps = 0u64;
    while lopping.step() {
        steps += 1;
        if steps.is_multiple_of(4096) && !watch(&lopping.progress()) {
            lopping.cancel();
        }
    }
    lopping.finish()
}

/// Where a vertex came from.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Origin {
    Input(PointId),
    OnCurve(CurveId),
    /// On a corner arc of a ball, now or once.
    OnArc(BallId),
    Free,
}

/// A triangle as it was when it was queued: a triangle's id may be another's by now.
type Suspect = (TriangleId, [VertexId; 3]);

/// The engine, held at a step.
pub struct Lopping {
    domain: Domain,
    /// What the domain was multiplied by.
    scale: f64,
    options: Options,
    field: SizeField,
    delaunay: Delaunay,
    origins: IdVec<VertexId, Origin>,
    subcurves: Subcurves,
    balls: Balls,
    /// Balls that a vertex came into.
    intruded: VecDeque<BallId>,
    /// Pieces to be looked at.
    suspects: VecDeque<PieceId>,
    /// Balls whose arcs are due.
    arcs_due: VecDeque<BallId>,
    /// Triangles with an angle below κ, and triangles too large.
    skinny: WorstFirst<Suspect>,
    oversized: WorstFirst<Suspect>,
    /// Triangles made since regions were last given.
    fresh: Vec<TriangleId>,
    carved: bool,
    cavity: Cavity,
    counters: Counters,
    reason: StopReason,
    /// Where something could not be done: below what the coordinates can tell apart.
    too_near: Vec<Point>,
    /// sin² κ.
    sin2_min: f64,
    /// No edge shorter than this is made on purpose: 64 units in the last place of the largest coordinate.
    resolution: f64,
}

/// What a step works on; the first that applies.
enum Rule {
    ShrinkBall(BallId),
    Look(PieceId),
    Carve,
    PlaceArcs(BallId),
    Split(Suspect),
    Rest,
}

// ---- start, step, finish ----
impl Lopping {
    /// P, its balls, and D of both.
    pub fn start(domain: &Domain, options: &Options) -> Result<Self, RefineError> {
        let magnitude = geometry::magnitude(domain.bounds());
        let scale = geometry::unit_scale(magnitude);
        let domain = domain.scaled(scale);
        let field = SizeField::new(&options.sizing.scaled(scale), &domain);
        let balls = Balls::at_birth(&domain, &field);
        let mut beginning = Beginning::new(&domain, balls);
        beginning.cut_curves();
        let delaunay = beginning.triangulate(options.midpoint).map_err(|e| e.scaled(1.0 / scale))?;
        let Beginning { origins, subcurves, balls, .. } = beginning;
        let sin_min = libm::sin(options.angle_min_rad);
        let mut lopping = Self {
            suspects: subcurves.ids().collect(),
            intruded: VecDeque::new(),
            arcs_due: if options.corner_arcs.is_some() { balls.ids().collect() } else { VecDeque::new() },
            skinny: WorstFirst::default(),
            oversized: WorstFirst::default(),
            fresh: Vec::new(),
            carved: false,
            cavity: Cavity::default(),
            counters: Counters::default(),
            reason: StopReason::Done,
            too_near: Vec::new(),
            sin2_min: sin_min * sin_min,
            resolution: 64.0 * f64::EPSILON * magnitude * scale,
            options: options.clone(),
            domain,
            scale,
            field,
            delaunay,
            origins,
            subcurves,
            balls,
        };
        lopping.suspects.iter().for_each(|&p| lopping.subcurves.get_mut(p).queued = true);
        lopping.counters.add("vertices_input", lopping.domain.points().len() as u64);
        lopping.counters.add("vertices_ball", (lopping.origins.len() - lopping.domain.points().len()) as u64);
        Ok(lopping)
    }

    /// Applies the first rule that can be. `false`: none can, or the run is over.
    pub fn step(&mut self) -> bool {
        match self.first_rule() {
            Rule::ShrinkBall(ball) => self.shrink_ball(ball),
            Rule::Look(piece) => self.look_at_piece(piece),
            Rule::Carve => self.carve(),
            Rule::PlaceArcs(ball) => self.place_arcs(ball),
            Rule::Split(suspect) => self.split_triangle(suspect),
            Rule::Rest => return false,
        }
        true
    }

    fn first_rule(&mut self) -> Rule {
        if self.reason == StopReason::Arithmetic || self.origins.len() > self.most_vertices() {
            return Rule::Rest;
        }
        if let Some(ball) = self.intruded.pop_front() {
            return Rule::ShrinkBall(ball);
        }
        if let Some(piece) = self.suspects.pop_front() {
            return Rule::Look(piece);
        }
        if !self.carved || !self.fresh.is_empty() {
            return Rule::Carve;
        }
        if self.reason != StopReason::Done {
            return Rule::Rest;
        }
        if let Some(ball) = self.arcs_due.pop_front() {
            return Rule::PlaceArcs(ball);
        }
        match self.skinny.pop().or_else(|| self.oversized.pop()) {
            Some(suspect) => Rule::Split(suspect),
            None => Rule::Rest,
        }
    }

    /// The budget; once there was a valid mesh, twice as much, so that what is begun can be made valid again.
    fn most_vertices(&self) -> usize {
        self.options.max_vertices.saturating_mul(if self.carved { 2 } else { 1 })
    }

    /// Whether every piece is an edge that nothing encroaches, and every triangle has its region.
    fn is_conforming(&self) -> bool {
        self.carved && self.intruded.is_empty() && self.suspects.is_empty() && self.fresh.is_empty()
    }

    /// Splits no more triangles; what is needed for a valid mesh is still done.
    pub fn cancel(&mut self) {
        if self.reason == StopReason::Done {
            self.reason = StopReason::Cancelled;
        }
    }

    pub fn progress(&self) -> Progress {
        let phase = if self.carved { "refining" } else { "conforming" };
        let queued = self.suspects.len() + self.skinny.len() + self.oversized.len();
        Progress { phase, vertices: self.origins.len(), queued }
    }

    /// The mesh of the kept regions, in the domain's own scale.
    pub fn finish(mut self) -> Result<Refined, RefineError> {
        if self.reason == StopReason::Arithmetic && !self.is_conforming() {
            return Err(self.too_near_error());
        }
        let (owed, mut places) = self.owed();
        places.extend(self.too_near.iter().copied());
        places.iter_mut().for_each(|p| *p = geometry::scaled(*p, 1.0 / self.scale));
        let reason = match self.reason {
            StopReason::Done if !self.is_conforming() => StopReason::VertexBudget,
            reason => reason,
        };
        let mesh = self.is_conforming().then(|| self.mesh().scaled(1.0 / self.scale));
        self.count_kernel();
        Ok(Refined { mesh, stop: Stop { reason, owed, places }, counters: self.counters })
    }

    fn too_near_error(&self) -> RefineError {
        let at = self.too_near.first().copied().unwrap_or_default();
        RefineError {
            what: "features lie nearer to each other than the coordinates can tell apart".to_owned(),
            at: geometry::scaled(at, 1.0 / self.scale),
            help: "move the drawing nearer to the origin, or weld the features with a larger --tolerance".to_owned(),
        }
    }

    /// Pieces and triangles that still miss a bound, and some of their places, the most crowded pieces first.
    fn owed(&mut self) -> (usize, Vec<Point>) {
        const PLACES: usize = 16;
        let mut pieces: Vec<(f64, Point)> = self.suspects.iter().map(|&id| self.length_and_place(id)).collect();
        pieces.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut owed = self.too_near.len() + pieces.len();
        let mut places: Vec<Point> = pieces.into_iter().map(|(_, at)| at).take(PLACES).collect();
        while let Some(suspect) = self.skinny.pop().or_else(|| self.oversized.pop()) {
            if self.is_stale(&suspect) {
                continue;
            }
            owed += 1;
            if places.len() < PLACES {
                places.push(self.delaunay.point(suspect.1[0]));
            }
        }
        (owed, places)
    }

    fn length_and_place(&self, id: PieceId) -> (f64, Point) {
        let [x, y] = self.subcurves.get(id).ends.map(|v| self.delaunay.point(v));
        (x.distance(y), x.midpoint(y))
    }

    fn count_kernel(&mut self) {
        let kernel = self.delaunay.counters();
        self.counters.add("predicates", kernel.orient + kernel.in_circle);
        self.counters.add("exact_fallbacks", kernel.exact_fallbacks);
        self.counters.add("walk_steps", kernel.walk_steps);
        self.counters.add("cavity_triangles", kernel.cavity_triangles);
    }
}

/// The largest turning of corner arcs for which κ is proven, where that is the domain's to prove: `lambda_rad` is the largest lens angle
/// of its curves. Elsewhere π/3, the largest that keeps the angles at the rim of a ball at 60° and more (section 6).
///
/// Arcs are curves: of turning T they have λ = T/2, so arcs of π/3 prove κ only up to 8.594°. Finer ones than a tenth of a radian would
/// crowd the ball with vertices for the sake of the proof; then the angle is reached, not proven.
pub fn arc_turning(kappa_rad: f64, lambda_rad: f64) -> f64 {
    const FINEST: f64 = 0.1;
    if kappa_rad >= guaranteed_angle(lambda_rad) || kappa_rad < guaranteed_angle(FRAC_PI_3 / 2.0) {
        return FRAC_PI_3;
    }
    // The guarantee falls as λ grows: 50 halvings reach the spacing of f64.
    let (mut covered, mut missed) = (0.0, FRAC_PI_3 / 2.0);
    for _ in 0..50 {
        let middle = 0.5 * (covered + missed);
        if kappa_rad < guaranteed_angle(middle) {
            covered = middle;
        } else {
            missed = middle;
        }
    }
    if 2.0 * covered >= FINEST { 2.0 * covered } else { FRAC_PI_3 }
}

// ---- the beginning: P and ball points ----

/// What stands before there is a triangulation.
struct Beginning<'a> {
    domain: &'a Domain,
    balls: Balls,
    points: Vec<Point>,
    origins: IdVec<VertexId, Origin>,
    subcurves: Subcurves,
}

impl<'a> Beginning<'a> {
    fn new(domain: &'a Domain, balls: Balls) -> Self {
        Self {
            domain,
            balls,
            points: domain.points().iter().copied().collect(),
            origins: domain.points().ids().map(Origin::Input).collect(),
            subcurves: Subcurves::default(),
        }
    }

    fn add(&mut self, at: Point, origin: Origin) -> VertexId {
        self.points.push(at);
        self.origins.push(origin)
    }

    /// splitball(p, 1) at every ball: each curve is cut where it leaves the balls of its ends.
    fn cut_curves(&mut self) {
        for (id, curve) in self.domain.curves().enumerate() {
            let carrier = Carrier::Curve(id);
            let [p, q] = curve.ends;
            let (mut t, mut ends) = ([0.0, 1.0], [VertexId(p.0), VertexId(q.0)]);
            for (i, end) in [End::Start, End::Finish].into_iter().enumerate() {
                let Some(ball) = self.balls.of_point(curve.ends[i]) else { continue };
                let radius = self.balls.get(ball).radius;
                // d(p) < lfs₀(p)/2 and the far end is farther than lfs₀(p): every curve at p leaves the ball.
                let Some(leave) = curve.curve.leaves_ball(end, radius, 0.0, 1.0) else { continue };
                let x = self.add(curve.curve.point(leave), Origin::OnCurve(id));
                let (spoke_t, spoke_ends) = match end {
                    End::Start => ([0.0, leave], [ends[0], x]),
                    End::Finish => ([leave, 1.0], [x, ends[1]]),
                };
                let spoke = self.subcurves.add(carrier, spoke_t, spoke_ends, Standing::Spoke(ball));
                self.balls.get_mut(ball).spokes.push(spoke);
                (t[i], ends[i]) = (leave, x);
            }
            self.subcurves.add(carrier, t, ends, Standing::Ordinary);
        }
        self.sort_spokes();
    }

    /// Spokes in the order of the star of their corner.
    fn sort_spokes(&mut self) {
        for id in self.balls.ids() {
            let ball = self.balls.get(id);
            let star = self.domain.star(ball.corner);
            let spoke_of = |curve: CurveId| {
                ball.spokes.iter().copied().find(|&s| self.subcurves.get(s).carrier == Carrier::Curve(curve))
            };
            let spokes = star.iter().filter_map(|at| spoke_of(at.curve)).collect();
            self.balls.get_mut(id).spokes = spokes;
        }
    }

    /// D of what there is. Where all of it lies on one line (a lens, a D), bent pieces are split first.
    fn triangulate(&mut self, midpoint: Midpoint) -> Result<Delaunay, RefineError> {
        match Delaunay::new(self.points.clone()) {
            Ok(delaunay) => return Ok(delaunay),
            Err(Degenerate::Duplicate { first, second }) => return Err(self.coincident(first, second)),
            Err(Degenerate::TooFew | Degenerate::Collinear) => self.split_bent(midpoint),
            Err(Degenerate::OutOfRange { index }) => return Err(self.out_of_range(index)),
        }
        Delaunay::new(self.points.clone()).map_err(|e| match e {
            Degenerate::Duplicate { first, second } => self.coincident(first, second),
            Degenerate::OutOfRange { index } => self.out_of_range(index),
            Degenerate::TooFew | Degenerate::Collinear => RefineError {
                what: "nothing to mesh: everything lies on one line".to_owned(),
                at: self.points.first().copied().unwrap_or_default(),
                help: "draw at least one closed outline".to_owned(),
            },
        })
    }

    fn out_of_range(&self, index: usize) -> RefineError {
        RefineError {
            what: "a coordinate is so small beside the others that exact signs cannot hold it".to_owned(),
            at: self.points[index],
            help: "round it to 0".to_owned(),
        }
    }

    fn split_bent(&mut self, midpoint: Midpoint) {
        let pieces: Vec<PieceId> = self.subcurves.ids().collect();
        for id in pieces {
            let piece = *self.subcurves.get(id);
            let Carrier::Curve(curve) = piece.carrier else { continue };
            let shape = &self.domain.curves()[curve].curve;
            if shape.is_straight() || piece.is_spoke() {
                continue;
            }
            let m = split_parameter(shape, piece.t, None, midpoint);
            let v = self.add(shape.point(m), Origin::OnCurve(curve));
            self.subcurves.retire(id);
            self.subcurves.add(piece.carrier, [piece.t[0], m], [piece.ends[0], v], Standing::Ordinary);
            self.subcurves.add(piece.carrier, [m, piece.t[1]], [v, piece.ends[1]], Standing::Ordinary);
        }
    }

    fn coincident(&self, first: usize, second: usize) -> RefineError {
        let at = self.points[first];
        let describe = |i: usize| match self.origins[VertexId::from_index(i)] {
            Origin::Input(p) => format!("input point {}", p.0),
            Origin::OnCurve(c) => format!("a point of curve {} on the border of its corner's ball", c.0),
            Origin::OnArc(_) | Origin::Free => format!("vertex {i}"),
        };
        RefineError {
            what: format!("{} and {} coincide", describe(first), describe(second)),
            at,
            help: "two curves leave a corner nearer to each other than the coordinates can tell apart: merge them, or move the drawing nearer to the origin"
                .to_owned(),
        }
    }
}

impl RefineError {
    fn scaled(mut self, factor: f64) -> Self {
        self.at = geometry::scaled(self.at, factor);
        self
    }
}

// ---- rule 1: splitball ----
impl Lopping {
    fn shrink_ball(&mut self, id: BallId) {
        let ball = self.balls.get(id);
        if ball.intruder >= ball.radius {
            return;
        }
        let radius = ball.shrunk(self.options.beta, self.options.shrinking == Shrinking::Batched);
        self.cut_ball(id, radius);
        if self.balls.get(id).intruder < radius {
            self.intruded.push_back(id);
        }
    }

    /// splitball: the radius becomes `radius`, and each spoke is cut there.
    fn cut_ball(&mut self, id: BallId, radius: f64) {
        if radius < self.resolution {
            let at = self.balls.get(id).center;
            return self.stop_too_near(at);
        }
        self.withdraw_arcs(id);
        let spokes = std::mem::take(&mut self.balls.get_mut(id).spokes);
        let mut shorter = Vec::with_capacity(spokes.len());
        for spoke in spokes {
            match self.cut_spoke(id, spoke, radius) {
                Some(piece) => shorter.push(piece),
                None => return,
            }
        }
        let ball = self.balls.get_mut(id);
        ball.spokes = shorter;
        ball.radius = radius;
        ball.why = BallReason::Encroached;
        let excused = std::mem::take(&mut ball.excused);
        for suspect in excused {
            self.skinny.push(suspect, 1.0);
        }
        if self.options.corner_arcs.is_some() {
            self.arcs_due.push_back(id);
        }
    }

    /// Cuts a spoke at a smaller radius; the shorter spoke.
    fn cut_spoke(&mut self, ball: BallId, spoke: PieceId, radius: f64) -> Option<PieceId> {
        let piece = *self.subcurves.get(spoke);
        let corner = VertexId(self.balls.get(ball).corner.0);
        let end = if piece.ends[0] == corner { End::Start } else { End::Finish };
        let shape = self.shape(piece.carrier);
        let x = shape.leaves_ball(end, radius, piece.t[0], piece.t[1]).unwrap_or(f64::NAN);
        let [head, tail] = self.split_piece_at(spoke, x, "vertices_ball")?;
        let inner = if end == End::Start { head } else { tail };
        self.subcurves.get_mut(inner).standing = Standing::Spoke(ball);
        Some(inner)
    }

    /// Arcs are taken out of C′; their vertices stay.
    fn withdraw_arcs(&mut self, id: BallId) {
        self.balls.get_mut(id).arcs.clear();
        for piece in std::mem::take(&mut self.balls.get_mut(id).arc_pieces) {
            let Some(side) = self.side_of(piece) else {
                self.subcurves.retire(piece);
                continue;
            };
            if self.delaunay.topology().piece(side) == Some(piece) {
                self.delaunay.topology_mut().set_piece(side, None);
            }
            self.subcurves.retire(piece);
        }
    }
}

// ---- rule 2: splitcurve ----
impl Lopping {
    fn shape(&self, carrier: Carrier) -> &Curve {
        match carrier {
            Carrier::Curve(id) => &self.domain.curves()[id].curve,
            Carrier::Arc(ball, i) => &self.balls.get(ball).arcs[i as usize],
        }
    }

    fn side_of(&self, piece: PieceId) -> Option<Side> {
        let [x, y] = self.subcurves.get(piece).ends;
        self.delaunay.topology().side_between(x, y)
    }

    fn suspect(&mut self, piece: PieceId) {
        let entry = self.subcurves.get_mut(piece);
        if !entry.queued {
            entry.queued = true;
            self.suspects.push_back(piece);
        }
    }

    /// Marks a piece as the edge that it is, or splits it where it is encroached or too large.
    fn look_at_piece(&mut self, id: PieceId) {
        self.subcurves.get_mut(id).queued = false;
        let piece = *self.subcurves.get(id);
        if piece.is_gone() {
            return;
        }
        match self.encroacher(id) {
            Look::Free(side) => {
                self.delaunay.topology_mut().set_piece(side, Some(id));
                if self.is_too_large(id) {
                    self.split_piece(id, None, "vertices_size");
                }
            }
            Look::Encroached(_) if piece.is_spoke() => {
                // The open ball holds no vertex but its corner: only rounding can hide the spoke.
                let at = self.delaunay.point(piece.ends[0]);
                self.stop_too_near(at);
            }
            Look::Encroached(z) => {
                let z = self.delaunay.point(z);
                self.split_piece(id, Some(z), "vertices_encroached");
            }
        }
    }

    fn is_too_large(&self, id: PieceId) -> bool {
        let piece = self.subcurves.get(id);
        let Carrier::Curve(curve) = piece.carrier else { return false };
        let within_budget = self.origins.len() < self.options.max_vertices && self.reason == StopReason::Done;
        let [t0, t1] = piece.t;
        within_budget && !piece.is_spoke() && self.field.edge_too_large(curve, self.shape(piece.carrier), t0, t1)
    }

    /// Whether a vertex lies in the open diametral circle of a piece.
    ///
    /// If the piece is an edge of D, one of the two apexes does if any vertex does. If it is not, look at the quadrilateral of the piece
    /// `x y` and the first edge `a b` that crosses it: y lies not inside the circle of `x a b`, so the angles at a and b sum up to at
    /// least 180°, and the larger is at least 90°; both are 90° only if all four are cocircular: then the edge is flipped.
    fn encroacher(&mut self, id: PieceId) -> Look {
        let piece = *self.subcurves.get(id);
        let [x, y] = piece.ends;
        let (px, py) = (self.delaunay.point(x), self.delaunay.point(y));
        // Each flip gives x one more neighbour on the same circle, so the degree bounds the flips; the rest is a guard.
        for _ in 0..self.origins.len() {
            let Some(side) = self.delaunay.topology().side_between(x, y) else {
                match self.crossing_side(x, py) {
                    Some(crossing) => {
                        if let Some(z) = self.inside_diametral_of(px, py, crossing, piece.is_spoke()) {
                            return Look::Encroached(z);
                        }
                        if !self.flip_to_reach(crossing) {
                            return Look::Encroached(self.delaunay.topology().origin(crossing));
                        }
                        continue;
                    }
                    // A vertex lies on the chord itself.
                    None => return Look::Encroached(self.vertex_on_chord(x, py)),
                }
            };
            if piece.is_spoke() {
                return Look::Free(side);
            }
            let topology = self.delaunay.topology();
            let apexes = [topology.apex(side), topology.apex(topology.twin(side))];
            let inside =
                |&a: &VertexId| a != GHOST && in_diametral(px, py, self.delaunay.point(a)) == CircleSide::Inside;
            return match apexes.into_iter().find(inside) {
                Some(z) => Look::Encroached(z),
                None => Look::Free(side),
            };
        }
        Look::Encroached(y)
    }

    /// The side opposite to x, in the triangle that the segment from x to y enters; `None` where a vertex blocks the way.
    fn crossing_side(&self, x: VertexId, y: Point) -> Option<Side> {
        use geometry::exact::{Orientation, orient};
        let topology = self.delaunay.topology();
        let px = self.delaunay.point(x);
        topology.sides_from(x).find_map(|s| {
            let (a, b) = (topology.target(s), topology.apex(s));
            if a == GHOST || b == GHOST {
                return None;
            }
            let right = orient(px, self.delaunay.point(a), y);
            let left = orient(px, self.delaunay.point(b), y);
            (right == Orientation::CounterClockwise && left == Orientation::Clockwise).then(|| s.next())
        })
    }

    /// The neighbour of x in the direction of y: the segment from x to y passes through it.
    fn vertex_on_chord(&self, x: VertexId, y: Point) -> VertexId {
        use geometry::exact::{Orientation, orient};
        let topology = self.delaunay.topology();
        let px = self.delaunay.point(x);
        let along = |v: VertexId| {
            let a = self.delaunay.point(v);
            orient(px, a, y) == Orientation::Collinear && (a - px).dot(y - px) > 0.0
        };
        let blocking = topology.sides_from(x).map(|s| topology.target(s)).find(|&v| v != GHOST && along(v));
        blocking.unwrap_or(x)
    }

    /// The end of a crossing side that lies inside the diametral circle of `x y`. Spokes are not encroached, only hidden by ties.
    fn inside_diametral_of(&self, x: Point, y: Point, crossing: Side, spoke: bool) -> Option<VertexId> {
        let topology = self.delaunay.topology();
        let inside = |&v: &VertexId| in_diametral(x, y, self.delaunay.point(v)) == CircleSide::Inside;
        [topology.origin(crossing), topology.target(crossing)].into_iter().filter(|_| !spoke).find(inside)
    }

    /// Flips a side between cocircular triangles (both triangulations are Delaunay); `false` where they are not, or a piece lies on it.
    fn flip_to_reach(&mut self, side: Side) -> bool {
        let topology = self.delaunay.topology();
        let far = topology.apex(topology.twin(side));
        if far == GHOST || topology.piece(side).is_some() {
            return false;
        }
        let [a, b, c] = topology.corners(side.triangle()).map(|v| self.delaunay.point(v));
        if in_circle(a, b, c, self.delaunay.point(far)) != CircleSide::On {
            return false;
        }
        let touched = [side.triangle(), topology.twin(side).triangle()];
        self.delaunay.topology_mut().flip(side);
        self.fresh.extend(touched);
        true
    }

    /// splitcurve at the point that the midpoint rule chooses.
    fn split_piece(&mut self, id: PieceId, z: Option<Point>, why: &'static str) {
        let piece = *self.subcurves.get(id);
        let t = split_parameter(self.shape(piece.carrier), piece.t, z, self.options.midpoint);
        self.split_piece_at(id, t, why);
    }

    /// Splits a piece at a parameter: a vertex, two pieces. `None`, and the run is over, where coordinates cannot hold it.
    fn split_piece_at(&mut self, id: PieceId, t: f64, why: &'static str) -> Option<[PieceId; 2]> {
        let piece = *self.subcurves.get(id);
        let at = self.shape(piece.carrier).point(t);
        let [x, y] = piece.ends.map(|v| self.delaunay.point(v));
        let room = at.distance(x).min(at.distance(y));
        if !(piece.t[0] < t && t < piece.t[1]) || room < self.resolution {
            self.stop_too_near(x);
            return None;
        }
        let origin = match piece.carrier {
            Carrier::Curve(curve) => Origin::OnCurve(curve),
            Carrier::Arc(ball, _) => Origin::OnArc(ball),
        };
        let near = self.side_of(id).map_or_else(|| self.triangle_at(piece.ends[0]), Side::triangle);
        self.look_at_cavity(at, near, x)?;
        self.subcurves.retire(id);
        self.disturb(at, Some(id));
        let v = self.act(at, origin, why);
        let standing = Standing::Ordinary;
        let head = self.subcurves.add(piece.carrier, [piece.t[0], t], [piece.ends[0], v], standing);
        let tail = self.subcurves.add(piece.carrier, [t, piece.t[1]], [v, piece.ends[1]], standing);
        self.suspect(head);
        self.suspect(tail);
        if let Carrier::Arc(ball, _) = piece.carrier {
            self.balls.get_mut(ball).arc_pieces.extend([head, tail]);
        }
        self.watch_balls(at, origin);
        Some([head, tail])
    }

    fn triangle_at(&self, v: VertexId) -> TriangleId {
        let topology = self.delaunay.topology();
        topology.sides_from(v).next().expect("every vertex has a side").triangle()
    }

    /// Looks: fills `cavity` for a point; `None`, and the run is over, where the point is a vertex already.
    fn look_at_cavity(&mut self, at: Point, near: TriangleId, place: Point) -> Option<()> {
        let location = self.delaunay.locate(at, near);
        if matches!(location, Location::Vertex(_)) {
            self.stop_too_near(place);
            return None;
        }
        self.delaunay.cavity(at, location, &mut self.cavity);
        Some(())
    }

    /// Requeues every piece that a point is about to hide or encroach; `split`: the piece that it splits.
    fn disturb(&mut self, at: Point, split: Option<PieceId>) {
        for (side, piece) in self.cavity_pieces() {
            let inner = !self.cavity.border.contains(&side);
            if inner || Some(piece) == split {
                self.delaunay.topology_mut().set_piece(side, None);
            }
            if Some(piece) != split && (inner || self.encroaches(at, piece)) {
                self.suspect(piece);
            }
        }
    }

    /// Pieces on the sides of the cavity's triangles, each once, with a side.
    fn cavity_pieces(&self) -> Vec<(Side, PieceId)> {
        let topology = self.delaunay.topology();
        let mut found: Vec<(PieceId, Side)> = Vec::new();
        for &t in &self.cavity.triangles {
            found.extend((0..3).map(|i| t.side_of(i)).filter_map(|s| Some((topology.piece(s)?, s))));
        }
        found.sort_unstable();
        found.dedup_by_key(|&mut (piece, _)| piece);
        found.into_iter().map(|(piece, side)| (side, piece)).collect()
    }

    fn encroaches(&self, at: Point, piece: PieceId) -> bool {
        let [x, y] = self.subcurves.get(piece).ends.map(|v| self.delaunay.point(v));
        in_diametral(x, y, at) == CircleSide::Inside
    }

    /// Acts: inserts a point whose cavity has been looked at, and notes the new triangles.
    fn act(&mut self, at: Point, origin: Origin, why: &'static str) -> VertexId {
        let v = self.delaunay.fill(at, &self.cavity);
        self.origins.push(origin);
        self.counters.add(why, 1);
        let topology = self.delaunay.topology();
        self.fresh.extend(topology.sides_from(v).map(Side::triangle));
        v
    }

    /// A new vertex on a curve may lie in the ball of a corner that the curve does not end at.
    fn watch_balls(&mut self, at: Point, origin: Origin) {
        let Origin::OnCurve(curve) = origin else { return };
        let Some((id, away)) = self.balls.holding(at) else { return };
        let ball = self.balls.get_mut(id);
        if self.domain.curves()[curve].ends.contains(&ball.corner) {
            return;
        }
        ball.intruder = ball.intruder.min(away);
        self.intruded.push_back(id);
    }

    fn stop_too_near(&mut self, at: Point) {
        self.too_near.push(at);
        self.reason = StopReason::Arithmetic;
    }
}

/// What was seen at a piece.
enum Look {
    /// It is this side of D, and nothing encroaches it.
    Free(Side),
    Encroached(VertexId),
}

// ---- carving ----
impl Lopping {
    /// Every piece is an edge: triangles made since the last time get their regions and are judged.
    fn carve(&mut self) {
        if !self.carved {
            self.fresh = carve::all_triangles(&self.delaunay);
            self.carved = true;
        }
        carve::carve(&mut self.delaunay, &self.subcurves, self.domain.curves(), &mut self.fresh);
        for t in std::mem::take(&mut self.fresh) {
            self.judge(t);
        }
    }

    fn corners(&self, t: TriangleId) -> [Point; 3] {
        self.delaunay.topology().corners(t).map(|v| self.delaunay.point(v))
    }

    /// Queues a kept triangle that misses a bound.
    fn judge(&mut self, t: TriangleId) {
        let Some(region) = self.delaunay.topology().region(t) else { return };
        let corners = self.corners(t);
        let suspect = (t, self.delaunay.topology().corners(t));
        let sin2 = sin2_smallest(corners);
        if sin2 < self.sin2_min {
            return self.skinny.push(suspect, 1.0 - sin2 / self.sin2_min);
        }
        let excess = self.field.excess(region, corners);
        if excess > 1.0 {
            // Badness by octaves of excess: 2^32 is as bad as it gets.
            self.oversized.push(suspect, libm::log2(excess) / 32.0);
        }
    }

    fn is_stale(&self, &(t, corners): &Suspect) -> bool {
        let topology = self.delaunay.topology();
        !topology.is_alive(t) || topology.corners(t) != corners
    }
}

/// sin² of the smallest angle of a triangle.
fn sin2_smallest([a, b, c]: [Point; 3]) -> f64 {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let [shortest, l1, l2] = {
        let mut l = [ab.hypot2(), bc.hypot2(), ca.hypot2()];
        l.sort_unstable_by(f64::total_cmp);
        l
    };
    let cross = ab.cross(ca);
    if shortest == 0.0 { 0.0 } else { cross * cross / (l1 * l2) }
}

// ---- rule 3: corner arcs (section 6) ----

/// What was seen where an arc's vertices would go.
enum Room {
    Clear,
    /// The ball must shrink.
    Tight,
    /// This piece must be split first.
    Blocked(PieceId),
}

impl Lopping {
    fn place_arcs(&mut self, id: BallId) {
        let Some(arc_turning) = self.options.corner_arcs else { return };
        if !self.balls.get(id).arcs.is_empty() {
            return;
        }
        let mut radius = self.balls.get(id).radius;
        let born = radius;
        loop {
            let arcs = self.arcs_at(id, radius, arc_turning);
            match self.room_for(id, radius, &arcs) {
                Room::Tight if radius > self.resolution => radius *= self.options.beta,
                Room::Tight => {
                    let at = self.balls.get(id).center;
                    return self.stop_too_near(at);
                }
                Room::Blocked(piece) => {
                    self.arcs_due.push_back(id);
                    return self.split_piece(piece, None, "vertices_encroached");
                }
                Room::Clear if radius < born => return self.cut_ball(id, radius),
                Room::Clear => return self.insert_arcs(id, arcs),
            }
        }
    }

    /// The arcs of the kept sectors of a ball at a radius: for each, the directions of its ends and the number of equal arcs.
    fn arcs_at(&self, id: BallId, radius: f64, arc_turning: f64) -> Vec<Sector> {
        let ball = self.balls.get(id);
        let star = self.domain.star(ball.corner);
        let leaving = |i: usize| -> (VertexId, Vec2) {
            let piece = self.subcurves.get(ball.spokes[i]);
            let (end, rim) = if piece.ends[0].0 == ball.corner.0 {
                (End::Start, piece.ends[1])
            } else {
                (End::Finish, piece.ends[0])
            };
            let shape = self.shape(piece.carrier);
            let [t0, t1] = piece.t;
            let at = match shape.leaves_ball(end, radius, t0, t1) {
                Some(t) if radius < ball.radius => shape.point(t),
                _ => self.delaunay.point(rim),
            };
            (rim, at - ball.center)
        };
        let n = ball.spokes.len();
        let kept = |i: usize| {
            let curve = &self.domain.curves()[star[i].curve];
            curve.sides[usize::from(star[i].end == End::Finish)].is_some()
        };
        (0..n)
            .filter(|&i| kept(i))
            .map(|i| {
                let ((from, u), (to, v)) = (leaving(i), leaving((i + 1) % n));
                let mut sweep = geometry::turn_from(u, v);
                if sweep <= 0.0 {
                    sweep += TAU;
                }
                let count = libm::ceil(sweep / arc_turning * (1.0 - 1e-12)).max(1.0) as u32;
                Sector { from, to, start: libm::atan2(u.y, u.x), sweep, count }
            })
            .collect()
    }

    /// Looks at every pseudo midpoint: is there room?
    fn room_for(&mut self, id: BallId, radius: f64, sectors: &[Sector]) -> Room {
        let center = self.balls.get(id).center;
        let near = self.triangle_at(VertexId(self.balls.get(id).corner.0));
        for at in sectors.iter().flat_map(|s| s.inner_points(center, radius)) {
            let location = self.delaunay.locate(at, near);
            if matches!(location, Location::Vertex(_)) {
                return Room::Tight;
            }
            self.delaunay.cavity(at, location, &mut self.cavity);
            if self.is_crowded(id, radius, at) {
                return Room::Tight;
            }
            for (_, piece) in self.cavity_pieces() {
                match self.room_beside(id, radius, at, piece) {
                    Room::Clear => {}
                    room => return room,
                }
            }
        }
        Room::Clear
    }

    /// Whether a vertex lies nearer to a pseudo midpoint than half the radius, for arcs of π/3; finer arcs have their vertices nearer to
    /// each other and to the spokes, and crowd in proportion (equal arcs turn at least half of what they may, and 2·sin(T/4) > 3T/2π).
    /// A vertex on another ball's arc does not count: the balls keep apart by themselves.
    fn is_crowded(&self, id: BallId, radius: f64, at: Point) -> bool {
        let arc_turning = self.options.corner_arcs.unwrap_or(FRAC_PI_3);
        let nearest = 0.5 * radius * (arc_turning / FRAC_PI_3);
        let topology = self.delaunay.topology();
        let mut neighbours = self.cavity.triangles.iter().flat_map(|&t| topology.corners(t)).filter(|&v| v != GHOST);
        neighbours.any(|v| {
            let apart = matches!(self.origins[v], Origin::OnArc(other) if other != id);
            !apart && self.delaunay.point(v).distance(at) < nearest
        })
    }

    /// Whether a pseudo midpoint leaves a piece alone.
    fn room_beside(&self, id: BallId, radius: f64, at: Point, piece: PieceId) -> Room {
        let entry = self.subcurves.get(piece);
        if entry.standing == Standing::Spoke(id) || !self.encroaches(at, piece) {
            return Room::Clear;
        }
        let [x, y] = entry.ends.map(|v| self.delaunay.point(v));
        let short = x.distance(y) < radius && matches!(entry.carrier, Carrier::Curve(_));
        if entry.is_spoke() || short { Room::Tight } else { Room::Blocked(piece) }
    }

    fn insert_arcs(&mut self, id: BallId, sectors: Vec<Sector>) {
        let (center, radius) = (self.balls.get(id).center, self.balls.get(id).radius);
        for sector in sectors {
            let mut from = sector.from;
            for (i, step) in (0..sector.count).enumerate() {
                let to = if step + 1 == sector.count {
                    sector.to
                } else {
                    let at = sector.inner_point(center, radius, step + 1);
                    let near = self.triangle_at(from);
                    if self.look_at_cavity(at, near, at).is_none() {
                        return;
                    }
                    self.disturb(at, None);
                    self.act(at, Origin::OnArc(id), "vertices_arc")
                };
                let ends = [from, to].map(|v| self.delaunay.point(v));
                let start = sector.start + sector.sweep * i as f64 / f64::from(sector.count);
                let arc = Curve::arc(center, radius, start, sector.sweep / f64::from(sector.count))
                    .expect("a ball's radius is positive")
                    .with_ends(ends[0], ends[1]);
                let ball = self.balls.get_mut(id);
                let carrier = Carrier::Arc(id, ball.arcs.len() as u32);
                ball.arcs.push(arc);
                let piece = self.subcurves.add(carrier, [0.0, 1.0], [from, to], Standing::Ordinary);
                self.balls.get_mut(id).arc_pieces.push(piece);
                self.suspect(piece);
                from = to;
            }
        }
    }
}

/// A kept sector of a ball: from one spoke counter-clockwise to the next.
struct Sector {
    from: VertexId,
    to: VertexId,
    start: f64,
    sweep: f64,
    /// Number of equal arcs.
    count: u32,
}

impl Sector {
    fn inner_point(&self, center: Point, radius: f64, i: u32) -> Point {
        let angle = self.start + self.sweep * f64::from(i) / f64::from(self.count);
        center + Vec2::new(libm::cos(angle), libm::sin(angle)) * radius
    }

    fn inner_points(&self, center: Point, radius: f64) -> impl Iterator<Item = Point> + '_ {
        (1..self.count).map(move |i| self.inner_point(center, radius, i))
    }
}

// ---- rule 4: splittri ----
impl Lopping {
    fn split_triangle(&mut self, suspect: Suspect) {
        if self.is_stale(&suspect) {
            return;
        }
        let (t, _) = suspect;
        let Some(region) = self.delaunay.topology().region(t) else { return };
        let corners = self.corners(t);
        if self.origins.len() >= self.options.max_vertices {
            self.reason = StopReason::VertexBudget;
            return self.skinny.push(suspect, 1.0);
        }
        if self.options.corner_arcs.is_some() && self.balls.holding_all(corners, self.resolution).is_some() {
            return;
        }
        let (center, radius) = circumcircle(corners);
        let too_small = self.field.sizing().min_edge.is_some_and(|h| radius < h);
        if too_small && self.field.excess(region, corners) <= 1.0 {
            return;
        }
        match self.balls.holding(center) {
            Some((ball, _)) if self.options.corner_arcs.is_none() => {
                self.balls.get_mut(ball).excused.push(suspect);
            }
            _ => self.kill(suspect, center),
        }
    }

    /// Inserts a circumcenter, or splits a piece that it encroaches.
    fn kill(&mut self, suspect: Suspect, center: Point) {
        let (t, corners) = suspect;
        let place = self.delaunay.point(corners[0]);
        let location = self.delaunay.locate(center, t);
        let vertex = matches!(location, Location::Vertex(_));
        if !vertex {
            self.delaunay.cavity(center, location, &mut self.cavity);
        }
        if vertex || !self.cavity.triangles.contains(&t) {
            // Rounding took the circumcenter out of the triangle's own circle.
            return self.too_near.push(place);
        }
        let pieces = self.cavity_pieces();
        if let Some(piece) = self.longest_encroached(center, &pieces) {
            self.counters.add("rejected_circumcenters", 1);
            self.split_piece(piece, None, "vertices_rejected_circumcenter");
            if !self.is_stale(&suspect) {
                self.skinny.push(suspect, 0.0);
            }
            return;
        }
        // What is hidden now and was not encroached is a spoke, by rounding; so is a center in a ball whose arcs it does not encroach.
        let hides_spoke = pieces.iter().any(|(side, _)| !self.cavity.border.contains(side));
        if hides_spoke || self.balls.holding(center).is_some() {
            return self.too_near.push(place);
        }
        let v = self.delaunay.fill(center, &self.cavity);
        self.origins.push(Origin::Free);
        self.counters.add("vertices_circumcenter", 1);
        let star: Vec<TriangleId> = self.delaunay.topology().sides_from(v).map(Side::triangle).collect();
        for t in star {
            self.judge(t);
        }
    }

    /// The longest piece, spokes apart, that a point encroaches.
    fn longest_encroached(&self, at: Point, pieces: &[(Side, PieceId)]) -> Option<PieceId> {
        let length = |piece: PieceId| self.length_and_place(piece).0;
        pieces
            .iter()
            .map(|&(_, piece)| piece)
            .filter(|&piece| !self.subcurves.get(piece).is_spoke() && self.encroaches(at, piece))
            .max_by(|&a, &b| length(a).total_cmp(&length(b)).then(b.cmp(&a)))
    }
}

/// Circumcenter and circumradius.
fn circumcircle([a, b, c]: [Point; 3]) -> (Point, f64) {
    let (ab, ac) = (b - a, c - a);
    let (bb, cc) = (ab.hypot2(), ac.hypot2());
    let double = 2.0 * ab.cross(ac);
    let offset = Vec2::new(ac.y * bb - ab.y * cc, ab.x * cc - ac.x * bb) / double;
    (a + offset, offset.hypot())
}

// ---- the mesh ----
impl Lopping {
    /// The kept triangles as plain data.
    fn mesh(&self) -> Mesh {
        let topology = self.delaunay.topology();
        let kept: Vec<TriangleId> = topology.triangles().filter(|&t| topology.region(t).is_some()).collect();
        let mut node_of: IdVec<VertexId, Option<VertexId>> = vec![None; self.origins.len()].into();
        for v in kept.iter().flat_map(|&t| topology.corners(t)) {
            node_of[v] = Some(v);
        }
        let mut mesh = Mesh { names: self.domain.names().clone(), ..Mesh::default() };
        for v in self.origins.ids() {
            if node_of[v].is_some() {
                node_of[v] = Some(mesh.nodes.push(self.delaunay.point(v)));
            }
        }
        for &t in &kept {
            mesh.triangles.push(topology.corners(t).map(|v| node_of[v].expect("corners are nodes")));
            mesh.triangle_regions.push(topology.region(t).expect("only kept triangles"));
        }
        mesh.regions = self.domain.regions().iter().map(|r| r.name).collect();
        mesh.edges = self.curve_edges(&node_of);
        mesh.points = self.domain.points().ids().filter_map(|p| Some((p, node_of[VertexId(p.0)]?))).collect();
        mesh.balls = self
            .balls
            .ids()
            .map(|id| self.balls.get(id))
            .map(|b| mesh::Ball { corner: b.corner, radius: b.radius, why: b.why })
            .collect();
        mesh
    }

    /// Pieces of curves with a kept region on a side, by curve and along it.
    fn curve_edges(&self, node_of: &IdVec<VertexId, Option<VertexId>>) -> Vec<CurveEdge> {
        let mut pieces: Vec<(CurveId, f64, PieceId)> = self
            .subcurves
            .ids()
            .filter_map(|id| match self.subcurves.get(id) {
                piece if piece.is_gone() => None,
                piece => match piece.carrier {
                    Carrier::Curve(curve) => Some((curve, piece.t[0], id)),
                    Carrier::Arc(..) => None,
                },
            })
            .collect();
        pieces.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        pieces
            .into_iter()
            .filter(|&(curve, ..)| self.domain.curves()[curve].sides.iter().any(Option::is_some))
            .map(|(curve, _, id)| {
                let piece = self.subcurves.get(id);
                CurveEdge {
                    nodes: piece.ends.map(|v| node_of[v].expect("an edge of a kept triangle")),
                    name: self.domain.curves()[curve].name,
                    link: Some(CurveLink { curve, t: piece.t }),
                }
            })
            .collect()
    }
}
