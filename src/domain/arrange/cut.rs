//! The network: drawn curves cut into pieces at their breaks and self-meetings, and the places where pieces meet.

use super::fill::Seen;
use super::{ArrangeError, Drawing, Repair, RepairKind, Tolerances, Unarranged};
use crate::curve::{BreakKind, Curve, End, Meeting, MeetingKind, Meetings, Overlap, meetings, self_meetings};
use crate::geometry::boxes::{BoxHierarchy, Labels};
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, IdVec, PointId, SeenId};
use crate::watch::{Progress, Watch};
use std::f64::consts::TAU;

/// Cuts of one round that are kept at most, two a crossing: some gigabytes with the pieces that they make.
pub(super) const CUTS_MAX: usize = 1 << 24;

/// After the first round pieces meet where they were moved to, seldom twice on a piece. Where it is so often in the mean, whole bundles of
/// curves lie within the tolerance of each other, and each round finds more of them.
pub(super) const CROWDED: usize = 32;

/// Pairs of curves, or of a node and a curve, that are kept at most while it is looked for where they meet: half a gigabyte.
const PAIRS_MAX: usize = 1 << 26;

/// Curves part slowly where they stay within the tolerance of each other for so many tolerances; those that part at an angle with a sine of one
/// over this do not.
const SLOW: f64 = 16.0;

/// In the middle of such a contact they are within this part of their widest distance: less than straight lines would be.
const BENT: f64 = 0.375;

/// Pieces that cross within the tolerance of a common end begin up to so many times as far from it, and no farther than this part of the tolerance.
const BEYOND: f64 = 16.0;
const BEYOND_REACH: f64 = 0.9;

/// A hook turns at least so far within this part of the tolerance: a disc that is wider than the tolerance has none.
const HOOK_RAD: f64 = 0.05;
const HOOK: f64 = 0.0625;

/// A Bézier curve has no hooks where its speed along the chord is at least this part of its greatest: it bends no sharper than some
/// millionth of its size then.
const PACE: f64 = 1e-3;

/// What a node or a cut is there for. Earlier ones win where nodes are welded: what was drawn is the truth.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Origin {
    /// An end or a break of a drawn curve.
    Curve(u32),
    /// A drawn point.
    Point(u32),
    /// Computed: where the drawn curve is met.
    Meeting(u32),
}

impl Origin {
    /// Drawn nodes first, curves and points alike.
    pub fn is_computed(self) -> bool {
        matches!(self, Origin::Meeting(_))
    }

    pub fn text(self, drawing: &Drawing) -> &str {
        match self {
            Origin::Curve(i) | Origin::Meeting(i) => &drawing.curves[i as usize].entity,
            Origin::Point(i) => &drawing.points[i as usize].entity,
        }
    }
}

/// A vertex to be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub at: Point,
    pub origin: Origin,
    /// Not yet looked at for meetings.
    pub fresh: bool,
}

/// A curve, and between which parameters of a drawn one it runs.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub curve: Curve,
    pub range: [f64; 2],
}

impl Part {
    fn whole(curve: &Curve) -> Self {
        Self { curve: curve.clone(), range: [0.0, 1.0] }
    }

    fn between(&self, t0: f64, t1: f64) -> Self {
        let [r0, r1] = self.range;
        let along = |t: f64| if t == 1.0 { r1 } else { r0 + t * (r1 - r0) };
        Self { curve: self.curve.part(t0, t1), range: [along(t0), along(t1)] }
    }

    /// The parts between ascending parameters inside it.
    fn split(self, cuts: &[f64]) -> Vec<Self> {
        if cuts.is_empty() {
            return vec![self];
        }
        let starts = [0.0].into_iter().chain(cuts.iter().copied());
        starts.zip(cuts.iter().copied().chain([1.0])).map(|(t0, t1)| self.between(t0, t1)).collect()
    }
}

/// A part of a drawn curve, on its way between two nodes.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub curve: Curve,
    pub ends: [PointId; 2],
    pub bounds: Rect,
    /// The drawn curve.
    pub source: u32,
    /// Between which of its parameters.
    pub range: [f64; 2],
    /// Further drawn curves that run along the whole piece, and whether they run against it.
    pub merged: Vec<(u32, bool)>,
    /// What is seen on its left and right, once hidden stretches are left out.
    pub paint: Option<[Option<SeenId>; 2]>,
    /// Not yet looked at for meetings.
    pub fresh: bool,
}

impl Piece {
    pub fn new(Part { curve, range }: Part, ends: [PointId; 2], source: u32) -> Self {
        Self { bounds: curve.bounds(), curve, ends, source, range, merged: Vec::new(), paint: None, fresh: true }
    }

    /// The part between two parameters, from node to node.
    pub fn between(&self, t0: f64, t1: f64, ends: [PointId; 2]) -> Self {
        let part = Part { curve: self.curve.clone(), range: self.range }.between(t0, t1);
        Self { merged: self.merged.clone(), paint: self.paint, ..Self::new(part, ends, self.source) }
    }

    /// Whether it is the whole of the drawn curve.
    pub fn is_whole(&self) -> bool {
        self.range == [0.0, 1.0]
    }

    fn is_line(&self) -> bool {
        matches!(self.curve, Curve::Line(_))
    }

    fn end(&self, end: End) -> PointId {
        match end {
            End::Start => self.ends[0],
            End::Finish => self.ends[1],
        }
    }
}

/// Nodes at which many lines end. That a spoke's far end lies on another spoke is asked of its neighbours by angle only.
struct Hubs {
    spokes: IdVec<PointId, Vec<CurveId>>,
    /// Hubs to which a line runs from a node.
    of_node: IdVec<PointId, Labels>,
}

/// Circles that cross at a smaller angle (its sine) are compared in full: they stay within the tolerance of each other for long.
const SLANT: f64 = 1e-3;

/// Fewer lines around a node are compared each with each.
const HUB: usize = 16;

impl Hubs {
    fn new(network: &Network) -> Self {
        let mut spokes: IdVec<PointId, Vec<CurveId>> = vec![Vec::new(); network.nodes.len()].into();
        let lines = || network.pieces.enumerate().filter(|(_, piece)| piece.is_line());
        lines().for_each(|(id, line)| line.ends.into_iter().for_each(|end| spokes[end].push(id)));
        let mut hubs = Self { spokes, of_node: vec![Labels::default(); network.nodes.len()].into() };
        for (_, line) in lines() {
            for (node, hub) in [(line.ends[0], line.ends[1]), (line.ends[1], line.ends[0])] {
                let free = hubs.of_node[node].iter().position(Option::is_none);
                if let (true, Some(free)) = (hubs.is_hub(hub), free) {
                    hubs.of_node[node][free] = Some(hub.0);
                }
            }
        }
        hubs
    }

    fn is_hub(&self, node: PointId) -> bool {
        self.spokes[node].len() >= HUB
    }

    /// The hubs at which a line ends.
    fn of_piece(&self, piece: &Piece) -> Labels {
        if piece.is_line() { piece.ends.map(|end| self.is_hub(end).then_some(end.0)) } else { Labels::default() }
    }

    /// Calls `ask` with the far ends of spokes that may lie on other spokes of their hub, and these.
    fn spokes_on_spokes(
        &self,
        network: &Network,
        ask: &mut impl FnMut(PointId, CurveId) -> Result<(), Unarranged>,
    ) -> Result<(), Unarranged> {
        for hub in self.spokes.ids().filter(|&hub| self.is_hub(hub)) {
            let far = |id: CurveId| network.pieces[id].ends.into_iter().find(|&end| end != hub).unwrap_or(hub);
            let arm = |id: CurveId| network.nodes[far(id)].at - network.nodes[hub].at;
            let mut around: Vec<(f64, CurveId)> =
                self.spokes[hub].iter().map(|&id| (libm::atan2(arm(id).y, arm(id).x), id)).collect();
            around.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let n = around.len();
            for (k, &(angle, id)) in around.iter().enumerate() {
                // Half a circle's chord at least as long as the tolerance; 1e-12 is more than rounding does to an angle.
                let reach = (2.0 * network.tolerances.weld / arm(id).hypot()).min(4.0) + 1e-12;
                let off = |other: f64| (other - angle).abs().min(TAU - (other - angle).abs());
                let beside = |step: usize| (1..n).map(move |i| (k + i * step) % n);
                for way in [1, n - 1] {
                    beside(way)
                        .map(|i| around[i])
                        .take_while(|other| off(other.0) <= reach)
                        .try_for_each(|other| ask(far(id), other.1))?;
                }
            }
        }
        Ok(())
    }
}

/// Nodes and pieces on their way to a domain.
pub(super) struct Network<'a> {
    pub drawing: &'a Drawing,
    pub tolerances: Tolerances,
    pub nodes: IdVec<PointId, Node>,
    pub pieces: IdVec<CurveId, Piece>,
    pub repairs: Vec<Repair>,
    /// Loops of a drawn curve that became lines: the curve, the place and the width. Itemised where some of the curve is left.
    pub loops: Vec<(u32, Point, f64)>,
    /// The ends of the drawn curves, as they were drawn; `None` of curves of no length.
    pub drawn_ends: Vec<Option<[PointId; 2]>>,
    /// The drawn points.
    pub drawn_points: Vec<PointId>,
    /// What the paint of pieces refers to.
    pub seen: Seen,
}

/// A place at which a piece is to be cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub piece: CurveId,
    pub t: f64,
    pub at: Point,
    pub node: PointId,
}

/// Where pieces meet: cuts, and nodes that are one.
#[derive(Default, Debug)]
pub(super) struct Found {
    pub cuts: Vec<Cut>,
    pub links: Vec<[PointId; 2]>,
}

impl Found {
    pub fn is_empty(&self) -> bool {
        self.cuts.is_empty() && self.links.is_empty()
    }
}

/// The length of a box's diagonal.
pub(super) fn extent(bounds: Rect) -> f64 {
    bounds.size().to_vec2().hypot()
}

impl<'a> Network<'a> {
    /// The pieces of a drawing, cut at breaks and self-meetings, not yet met with each other.
    pub fn new(drawing: &'a Drawing, tolerances: Tolerances, watch: &mut Watch) -> Result<Self, Unarranged> {
        let mut network = Network {
            drawing,
            tolerances,
            nodes: IdVec::new(),
            pieces: IdVec::new(),
            repairs: Vec::new(),
            loops: Vec::new(),
            drawn_ends: Vec::new(),
            drawn_points: Vec::new(),
            seen: Seen::default(),
        };
        for source in 0..drawing.curves.len() {
            network.progress("cutting", drawing.curves.len() - source).tell(watch)?;
            let ends = network.add_curve(source as u32)?;
            network.drawn_ends.push(ends);
        }
        for (i, point) in drawing.points.iter().enumerate() {
            let id = network.add_node(point.at, Origin::Point(i as u32));
            network.drawn_points.push(id);
        }
        Ok(network)
    }

    fn progress(&self, phase: &'static str, queued: usize) -> Progress {
        Progress { phase, vertices: self.nodes.len(), queued }
    }

    pub fn add_node(&mut self, at: Point, origin: Origin) -> PointId {
        self.nodes.push(Node { at, origin, fresh: true })
    }

    pub fn entity(&self, source: u32) -> &'a str {
        &self.drawing.curves[source as usize].entity
    }

    pub fn repair(&mut self, kind: RepairKind, at: Point, size: f64, what: String) {
        self.repairs.push(Repair { kind, at: [at.x, at.y], size, what });
    }

    fn add_curve(&mut self, source: u32) -> Result<Option<[PointId; 2]>, ArrangeError> {
        let curve = &self.drawing.curves[source as usize].curve;
        let (size, weld) = (extent(curve.bounds()), self.tolerances.weld);
        if size == 0.0 {
            let what = format!("{} has no length and was dropped", self.entity(source));
            self.repair(RepairKind::ZeroLength, curve.start(), size, what);
            return Ok(None);
        }
        if size <= weld {
            // Too small for a shape of its own. Whether it is lost is told by its ends: a chain of short curves may be a long one.
            let [from, to] = [curve.start(), curve.end()].map(|at| self.add_node(at, Origin::Curve(source)));
            self.pieces.push(Piece::new(Part::whole(curve), [from, to], source));
            return Ok(Some([from, to]));
        }
        let first = self.add_node(curve.start(), Origin::Curve(source));
        let last = if curve.start() == curve.end() { first } else { self.add_node(curve.end(), Origin::Curve(source)) };
        let parts = self.own_parts(source, curve)?;
        let count = parts.len();
        let mut from = first;
        for (k, (part, origin)) in parts.into_iter().enumerate() {
            let to = if k + 1 == count { last } else { self.add_node(part.curve.end(), origin) };
            self.pieces.push(Piece::new(part, [from, to], source));
            from = to;
        }
        Ok(Some([first, last]))
    }

    /// The parts of a drawn curve when cut on its own account: at breaks, at self-meetings, and once more where a part would be closed.
    /// Each with what its end is there for.
    fn own_parts(&mut self, source: u32, curve: &Curve) -> Result<Vec<(Part, Origin)>, ArrangeError> {
        if matches!(curve, Curve::Line(_)) {
            return Ok(vec![(Part::whole(curve), Origin::Curve(source))]);
        }
        let mut parts = Vec::new();
        for regular in self.parts_between_breaks(source, curve) {
            let mut cuts = self.self_cuts(source, &regular.curve)?;
            cuts.retain(|&t| 0.0 < t && t < 1.0);
            cuts.sort_by(f64::total_cmp);
            cuts.dedup();
            let regular = regular.split(&cuts);
            let last = regular.len() - 1;
            for (k, part) in regular.into_iter().enumerate() {
                let origin = if k < last { Origin::Meeting(source) } else { Origin::Curve(source) };
                self.open_up(part, origin, source, &mut parts);
            }
        }
        Ok(parts)
    }

    fn parts_between_breaks(&mut self, source: u32, curve: &Curve) -> Vec<Part> {
        let breaks = curve.breaks();
        for at_break in &breaks {
            let kind = match at_break.kind {
                BreakKind::Cusp => "cusp",
                BreakKind::TangentJump => "tangent jump",
            };
            let degrees = at_break.turn_rad.to_degrees();
            let what = format!("a {kind} of {degrees:.3}° in {} became a corner", self.entity(source));
            self.repair(RepairKind::Corner, curve.point(at_break.t), 0.0, what);
        }
        let cuts: Vec<f64> = breaks.iter().map(|b| b.t).filter(|&t| 0.0 < t && t < 1.0).collect();
        let parts = Part::whole(curve).split(&cuts);
        parts.into_iter().flat_map(|part| self.parts_between_hooks(source, part)).collect()
    }

    /// A regular part, cut around the hooks in it: bends far narrower than the tolerance, as handles a last digit away from their ends make
    /// them. What is between the cuts is too short to stay: the hook becomes a corner, or the end that it is at.
    fn parts_between_hooks(&mut self, source: u32, regular: Part) -> Vec<Part> {
        let part = &regular.curve;
        if is_evenly_paced(part) {
            return vec![regular];
        }
        let mut steps = vec![0.0];
        steps.extend(part.cuts_of_turning(HOOK_RAD));
        steps.push(1.0);
        let narrow = |t0: f64, t1: f64, limit: f64| extent(part.bounds_of(t0, t1)) <= limit * self.tolerances.weld;
        let hooked: Vec<bool> = steps.windows(2).map(|step| narrow(step[0], step[1], HOOK / 4.0)).collect();
        let mut hooks = Vec::new();
        let mut k = 0;
        for run in hooked.chunk_by(|a, b| a == b) {
            let [t0, t1] = [steps[k], steps[k + run.len()]];
            if run[0] && narrow(t0, t1, HOOK) && part.turning(t0, t1) >= HOOK_RAD {
                hooks.push([t0, t1]);
            }
            k += run.len();
        }
        for &[t0, t1] in &hooks {
            let (size, degrees) = (extent(part.bounds_of(t0, t1)), part.turning(t0, t1).to_degrees());
            let what = format!(
                "a bend of {degrees:.0}° in {}, narrower than the tolerance, became a corner",
                self.entity(source)
            );
            self.repair(RepairKind::Corner, part.point(t0), size, what);
        }
        let mut cuts = hooks.concat();
        cuts.retain(|&t| 0.0 < t && t < 1.0);
        regular.split(&cuts)
    }

    /// The parameters at which a regular part meets itself. Within the tolerance a loop is nothing but the curve's nearness to itself, but it
    /// may cross itself there: asked only of parts that meet themselves nowhere else.
    fn self_cuts(&mut self, source: u32, part: &Curve) -> Result<Vec<f64>, ArrangeError> {
        let mut found = self.self_meetings_of(source, part, self.tolerances.weld)?;
        if found.is_empty() {
            found = self.self_meetings_of(source, part, self.tolerances.rounding)?;
        }
        for meeting in &found {
            let what = format!("{} meets itself and was split there", self.entity(source));
            self.repair(RepairKind::SelfSplit, meeting.at, 0.0, what);
        }
        Ok(found.iter().flat_map(|m| [m.t, m.u]).collect())
    }

    fn self_meetings_of(&self, source: u32, part: &Curve, tolerance: f64) -> Result<Vec<Meeting>, ArrangeError> {
        self_meetings(part, tolerance).map_err(|budget| {
            let what = format!("{} runs so near to itself that its meetings cannot be told apart", self.entity(source));
            ArrangeError::near(what, budget.at, "simplify the curve, or raise the tolerance")
        })
    }

    /// Adds a part, halved where its ends are one point, and where only its halves are arcs of circles.
    fn open_up(&self, part: Part, origin: Origin, source: u32, parts: &mut Vec<(Part, Origin)>) {
        let weld = self.tolerances.weld;
        let is_closed = part.curve.start().distance(part.curve.end()) <= weld && extent(part.curve.bounds()) > weld;
        if is_closed || is_spiral(&part.curve) {
            parts.push((part.between(0.0, 0.5), Origin::Curve(source)));
            parts.push((part.between(0.5, 1.0), origin));
        } else {
            parts.push((part, origin));
        }
    }
}

// ---- where pieces meet ----
impl Network<'_> {
    /// Every place where fresh pieces and nodes meet others, as long as there are no more cuts than `most`.
    pub fn meet(&mut self, most: usize, watch: &mut Watch) -> Result<Found, Unarranged> {
        let mut found = Found::default();
        let known = self.nodes.len();
        let grown = self.pieces.iter().map(|p| p.bounds.inflate(self.tolerances.weld, self.tolerances.weld));
        let boxes = BoxHierarchy::new(grown);
        self.nodes_on_pieces(&boxes, &mut found, watch)?;
        let mut pairs = self.fresh_pairs(&boxes, watch)?;
        pairs.sort_unstable();
        let count = pairs.len();
        for (k, (a, b)) in pairs.into_iter().enumerate() {
            self.progress("meeting", count - k).tell(watch)?;
            if found.cuts.len() > most {
                return Err(too_many_cuts(most, self.pieces[a].bounds.center()).into());
            }
            match (&self.pieces[a].curve, &self.pieces[b].curve) {
                (Curve::Line(_), Curve::Line(_)) => self.cross_lines(a, b, &mut found),
                _ => self.meet_curves(a, b, &mut found)?,
            }
        }
        // New nodes are looked at in the next round, when pieces end at them.
        self.nodes.iter_mut().take(known).for_each(|n| n.fresh = false);
        self.pieces.iter_mut().for_each(|p| p.fresh = false);
        Ok(found)
    }

    /// Pairs of pieces that may cross and were not both looked at before.
    fn fresh_pairs(&self, boxes: &BoxHierarchy, watch: &mut Watch) -> Result<Vec<(CurveId, CurveId)>, Unarranged> {
        let mut pairs = Vec::new();
        let fresh: Vec<CurveId> = self.pieces.ids().filter(|&id| self.pieces[id].fresh).collect();
        let mut ask = |a: CurveId, b: CurveId| {
            if !self.are_circles_apart(a, b) && !self.part_at_once(a, b) {
                pairs.push((a, b));
            }
            self.keep_on(pairs.len(), self.pieces[a].bounds.center(), watch)
        };
        let labels = |i: usize| self.crossing_labels(CurveId::from_index(i));
        if fresh.len() == self.pieces.len() {
            boxes.try_pairs(labels, |i, j| ask(CurveId::from_index(i), CurveId::from_index(j)))?;
            return Ok(pairs);
        }
        let of_fresh = BoxHierarchy::new(fresh.iter().map(|&id| boxes.boxes()[id.index()]));
        of_fresh.try_pairs_with(
            |i| self.crossing_labels(fresh[i]),
            boxes,
            labels,
            |i, j| {
                let (a, b) = (fresh[i], CurveId::from_index(j));
                // Of two fresh ones each finds the other.
                if a < b || (b < a && !self.pieces[b].fresh) { ask(a.min(b), a.max(b)) } else { Ok(()) }
            },
        )?;
        Ok(pairs)
    }

    /// Asks the watch now and then while pairs are found, and refuses more than can be kept.
    fn keep_on(&self, pairs: usize, at: Point, watch: &mut Watch) -> Result<(), Unarranged> {
        if pairs > PAIRS_MAX {
            return Err(too_many_cuts(CUTS_MAX, at).into());
        }
        if pairs.is_multiple_of(1024) { Ok(self.progress("meeting", pairs).tell(watch)?) } else { Ok(()) }
    }

    /// Whether two pieces with a common end part there at an angle for good: they meet nowhere else.
    fn part_at_once(&self, a: CurveId, b: CurveId) -> bool {
        let [first, second] = [a, b].map(|id| &self.pieces[id]);
        let ends = [End::Start, End::Finish];
        let common = ends.iter().find_map(|&i| {
            let j = ends.iter().find(|&&j| first.end(i) == second.end(j))?;
            Some((first.curve.cone_from(i)?, second.curve.cone_from(*j)?))
        });
        common.is_some_and(|(cone, other)| cone.is_apart_from(&other, 1.0 / SLOW))
    }

    /// Whether a place is for certain no part of an arc, told by its circle.
    fn is_off_circle(&self, at: Point, piece: &Piece) -> bool {
        let Curve::Arc(arc) = &piece.curve else { return false };
        let from = at.distance(arc.center);
        (from - arc.radius).abs() > self.off_circle(from + arc.radius)
    }

    /// How far a point of an arc, computed from numbers of a magnitude, may lie off its circle, and a tolerance more. Moved ends are spread
    /// along an arc: its points lie off its circle by two tolerances at most.
    fn off_circle(&self, magnitude: f64) -> f64 {
        8.0 * self.tolerances.weld.max(f64::EPSILON * magnitude)
    }

    /// Whether two arcs meet nowhere, or nowhere but at their one common end, told by their circles: rings in each other and fans of arcs
    /// have as many pairs of boxes that meet as there are pairs.
    fn are_circles_apart(&self, a: CurveId, b: CurveId) -> bool {
        let [first, second] = [a, b].map(|id| &self.pieces[id]);
        let (Curve::Arc(p), Curve::Arc(q)) = (&first.curve, &second.curve) else { return false };
        let between = p.center.distance(q.center);
        let slack = self.off_circle(between + p.radius + q.radius);
        if between > p.radius + q.radius + slack || between < (p.radius - q.radius).abs() - slack {
            return true;
        }
        let mut shared = first.ends.into_iter().filter(|end| second.ends.contains(end));
        let (Some(hub), None) = (shared.next(), shared.next()) else { return false };
        let at = self.nodes[hub].at;
        let sine = (p.center - at).cross(q.center - at).abs() / (p.radius * q.radius);
        // Circles that cross at an angle cross once more, as far behind the line of their centers.
        let along = (q.center - p.center) / between;
        let other = p.center + 2.0 * along.dot(at - p.center) * along - (at - p.center);
        let reach = slack / SLANT;
        sine >= SLANT
            && at.distance(other) > 2.0 * reach
            && [first, second].iter().any(|piece| piece.curve.nearest(other, 0.0, 1.0).1 > reach)
    }

    /// Lines with a common end do not cross.
    fn crossing_labels(&self, id: CurveId) -> Labels {
        match &self.pieces[id] {
            line if line.is_line() => line.ends.map(|end| Some(end.0)),
            _ => Labels::default(),
        }
    }

    /// Nodes that lie on pieces without being their ends: T-junctions, collinear overlaps, drawn points on curves.
    fn nodes_on_pieces(
        &mut self,
        boxes: &BoxHierarchy,
        found: &mut Found,
        watch: &mut Watch,
    ) -> Result<(), Unarranged> {
        let hubs = Hubs::new(self);
        let nodes = BoxHierarchy::new(self.nodes.iter().map(|n| Rect::from_points(n.at, n.at)));
        let mut near = Vec::new();
        let mut ask = |id: PointId, i: CurveId| {
            let (node, piece) = (&self.nodes[id], &self.pieces[i]);
            if (node.fresh || piece.fresh) && !piece.ends.contains(&id) && !self.is_off_circle(node.at, piece) {
                near.push((id, i));
            }
            self.keep_on(near.len(), node.at, watch)
        };
        nodes.try_pairs_with(
            |i| hubs.of_node[PointId::from_index(i)],
            boxes,
            |i| hubs.of_piece(&self.pieces[CurveId::from_index(i)]),
            |i, j| ask(PointId::from_index(i), CurveId::from_index(j)),
        )?;
        hubs.spokes_on_spokes(self, &mut ask)?;
        near.sort_unstable();
        near.dedup();
        for (id, piece) in near {
            let at = self.nodes[id].at;
            let (t, distance) = self.pieces[piece].curve.nearest(at, 0.0, 1.0);
            if distance <= self.tolerances.weld {
                let site = self.site(piece, t, self.pieces[piece].curve.point(t));
                join(found, (piece, site), id);
            }
        }
        Ok(())
    }

    /// The proper crossing of two lines without a common end. All other ways in which lines meet have an end of one on the other.
    fn cross_lines(&mut self, a: CurveId, b: CurveId, found: &mut Found) {
        let [p, q] = [a, b].map(|id| &self.pieces[id]);
        let (p0, p1, q0, q1) = (p.curve.start(), p.curve.end(), q.curve.start(), q.curve.end());
        let sides = [orient(p0, p1, q0), orient(p0, p1, q1), orient(q0, q1, p0), orient(q0, q1, p1)];
        if sides[0] == sides[1] || sides[2] == sides[3] || sides.contains(&Orientation::Collinear) {
            return;
        }
        let (dp, dq, between) = (p1 - p0, q1 - q0, q0 - p0);
        let det = dp.cross(dq);
        // The signs above are exact: the lines do cross. Where rounding leaves nothing of the determinant, the middles will do.
        let [t, u] = if det == 0.0 { [0.5, 0.5] } else { [between.cross(dq) / det, between.cross(dp) / det] };
        let (t, u) = (t.clamp(0.0, 1.0), u.clamp(0.0, 1.0));
        self.join_pieces((a, t), (b, u), p0.lerp(p1, t), found);
    }

    fn meet_curves(&mut self, a: CurveId, b: CurveId, found: &mut Found) -> Result<(), ArrangeError> {
        let weld = self.tolerances.weld;
        let near = self.meetings_of(a, b, weld)?;
        let p = &self.pieces[a];
        let mut places: Vec<(Point, [f64; 2])> = Vec::new();
        let (zipped, points): (Vec<&Meeting>, Vec<&Meeting>) =
            near.points.iter().partition(|meeting| self.tolerances.zip && self.part_slowly([a, b], meeting));
        for meeting in points.into_iter().filter(|m| !self.is_contact([a, b], [m.t, m.u], weld)) {
            places.push((meeting.at, [meeting.t, meeting.u]));
        }
        for overlap in near.overlaps.iter().chain(zipped.into_iter().map(|meeting| &meeting.contact)) {
            places.extend((0..2).map(|k| (p.curve.point(overlap.t[k]), [overlap.t[k], overlap.u[k]])));
        }
        let before = [found.cuts.len(), found.links.len()];
        for (at, [t, u]) in places {
            self.join_pieces((a, t), (b, u), at, found);
        }
        if before == [found.cuts.len(), found.links.len()] {
            self.untangle([a, b], found)?;
        }
        Ok(())
    }

    /// Whether two pieces touch and part so slowly that what is between them, as long as that is within the tolerance, would take more
    /// triangles than it is worth: they are one there. Straight lines at an angle are not made one, the wedge would only begin elsewhere.
    fn part_slowly(&self, ids: [CurveId; 2], meeting: &Meeting) -> bool {
        let Overlap { t, u } = meeting.contact;
        if meeting.kind == MeetingKind::Crossing || t[0] == t[1] || u[0] == u[1] {
            return false;
        }
        let [p, q] = ids.map(|id| &self.pieces[id].curve);
        let ends = t.map(|t| p.point(t));
        if ends[0].distance(ends[1]) <= SLOW * self.tolerances.weld {
            return false;
        }
        let within = |t: f64| q.nearest(p.point(t), u[0].min(u[1]), u[0].max(u[1])).1;
        let widest = t.map(within).into_iter().fold(0.0, f64::max);
        within(0.5 * (t[0] + t[1])) <= BENT * widest
    }

    /// Further meetings of two pieces with a common end. Within the tolerance of it all is one contact, but the curves may cross there
    /// once more: they are cut there. Where even that is within the tolerance of the end, both begin at the crossing instead. Asked
    /// only of pieces that meet nowhere else: those that repeat each other are cut and become one first.
    fn untangle(&mut self, ids: [CurveId; 2], found: &mut Found) -> Result<(), ArrangeError> {
        let [p, q] = ids.map(|id| &self.pieces[id]);
        if !p.ends.iter().any(|end| q.ends.contains(end)) {
            return Ok(());
        }
        let rounding = self.tolerances.rounding;
        for meeting in self.meetings_of(ids[0], ids[1], rounding)?.points {
            let ts = [meeting.t, meeting.u];
            // Circles that were drawn to touch come out a few roundings deep in each other; a cut there, where they stay that near to each
            // other for the square root of it, would leave an edge that nothing can be meshed beside.
            if self.is_contact(ids, ts, 4.0 * rounding) {
                continue;
            }
            let [on_a, on_b] = [0, 1].map(|k| self.site(ids[k], ts[k], self.pieces[ids[k]].curve.point(ts[k])));
            match (on_a, on_b) {
                (Site::End(m), Site::End(n)) if m == n => {
                    let ts = self.beyond(ids, ts, m);
                    for (piece, t) in ids.into_iter().zip(ts).filter(|&(_, t)| 0.0 < t && t < 1.0) {
                        let at = self.pieces[piece].curve.point(t);
                        found.cuts.push(Cut { piece, t, at, node: m });
                    }
                }
                _ => self.join_pieces((ids[0], ts[0]), (ids[1], ts[1]), meeting.at, found),
            }
        }
        Ok(())
    }

    /// Where two pieces that cross near a node are to begin: farther from it than where they cross, as far as the tolerance goes. What is left of
    /// them turns a little as it is moved to the node, and so would cross again, somewhat nearer; farther away they have parted.
    fn beyond(&self, ids: [CurveId; 2], ts: [f64; 2], node: PointId) -> [f64; 2] {
        let away = |k: usize, t: f64| self.pieces[ids[k]].curve.point(t).distance(self.nodes[node].at);
        let reach = BEYOND_REACH * self.tolerances.weld;
        let times = (reach / away(0, ts[0]).max(away(1, ts[1]))).min(BEYOND);
        let farther = [0, 1].map(|k| {
            let end = if self.pieces[ids[k]].ends[0] == node { 0.0 } else { 1.0 };
            end + times * (ts[k] - end)
        });
        let is_near = |k: usize| (0.0..=1.0).contains(&farther[k]) && away(k, farther[k]) <= self.tolerances.weld;
        if times > 1.0 && is_near(0) && is_near(1) { farther } else { ts }
    }

    fn meetings_of(&self, a: CurveId, b: CurveId, tolerance: f64) -> Result<Meetings, ArrangeError> {
        let [p, q] = [a, b].map(|id| &self.pieces[id]);
        meetings(&p.curve, &q.curve, tolerance).map_err(|budget| {
            let [p, q] = [p, q].map(|piece| self.entity(piece.source));
            let what = format!("{p} and {q} run so near to each other that their meetings cannot be told apart");
            ArrangeError::near(what, budget.at, "remove one of the two, or raise the tolerance so that they become one")
        })
    }

    /// Whether a meeting of two pieces is nothing but their contact at a common end: from there to the meeting they stay within `slack`
    /// of each other.
    fn is_contact(&self, ids: [CurveId; 2], ts: [f64; 2], slack: f64) -> bool {
        let [p, q] = ids.map(|id| &self.pieces[id]);
        let within = |t: f64, end: usize, curve: &Curve, other: &Curve| {
            let end = end as f64;
            t == end
                || [0.25, 0.5, 0.75]
                    .iter()
                    .all(|&f| other.nearest(curve.point(end + f * (t - end)), 0.0, 1.0).1 <= slack)
        };
        let shared = (0..2).flat_map(|i| (0..2).map(move |j| (i, j))).filter(|&(i, j)| p.ends[i] == q.ends[j]);
        shared.into_iter().any(|(i, j)| within(ts[0], i, &p.curve, &q.curve) && within(ts[1], j, &q.curve, &p.curve))
    }

    /// Makes one node of a place on one piece and a place on another.
    fn join_pieces(&mut self, a: (CurveId, f64), b: (CurveId, f64), at: Point, found: &mut Found) {
        let site = |network: &Self, (id, t): (CurveId, f64)| network.site(id, t, network.pieces[id].curve.point(t));
        let (on_a, on_b) = (site(self, a), site(self, b));
        match (on_a, on_b) {
            (Site::End(m), _) => join(found, (b.0, on_b), m),
            (_, Site::End(n)) => join(found, (a.0, on_a), n),
            _ => {
                let node = self.add_node(at, Origin::Meeting(self.pieces[a.0].source));
                join(found, (a.0, on_a), node);
                join(found, (b.0, on_b), node);
            }
        }
    }

    /// A place on a piece: one of its ends, where it is that near.
    fn site(&self, id: CurveId, t: f64, at: Point) -> Site {
        let piece = &self.pieces[id];
        let end = piece.ends.into_iter().min_by(|&m, &n| {
            let [m, n] = [m, n].map(|n| self.nodes[n].at.distance(at));
            m.total_cmp(&n)
        });
        match end {
            Some(end) if self.nodes[end].at.distance(at) <= self.tolerances.weld => Site::End(end),
            _ => Site::Inside(t, at),
        }
    }
}

/// Whether a curve is an arc that winds off its circle: only parts of it are arcs of circles, and those on both sides of a cut are of
/// different ones.
pub(super) fn is_spiral(curve: &Curve) -> bool {
    matches!(curve, Curve::Arc(arc) if arc.is_spiral())
}

/// Whether the speed of a curve varies so little that no bend in it can be a hook.
fn is_evenly_paced(curve: &Curve) -> bool {
    match curve {
        Curve::Line(_) | Curve::Arc(_) | Curve::Clothoid(_) => true,
        Curve::Bezier(bezier) if bezier.weights.is_none() => {
            let legs = || bezier.points.windows(2).map(|leg| leg[1] - leg[0]);
            let chord = curve.end() - curve.start();
            let fastest = legs().map(|leg| leg.hypot()).fold(0.0, f64::max);
            legs().all(|leg| leg.dot(chord) > PACE * fastest * chord.hypot())
        }
        Curve::Bezier(_) | Curve::Ellipse(_) | Curve::Spline(_) => false,
    }
}

fn too_many_cuts(most: usize, at: Point) -> ArrangeError {
    let what = format!("the curves meet in more than {} places", most / 2);
    let help = match most {
        CUTS_MAX => "such a drawing is noise: leave out the curves that cross most of the others there",
        _ => "bundles of curves lie within the tolerance of each other: lower it, or leave out all but one of each",
    };
    ArrangeError::near(what, at, help)
}

#[derive(Clone, Copy, Debug)]
enum Site {
    End(PointId),
    Inside(f64, Point),
}

fn join(found: &mut Found, (piece, site): (CurveId, Site), node: PointId) {
    match site {
        Site::End(end) if end != node => found.links.push([end, node]),
        Site::End(_) => {}
        Site::Inside(t, at) => found.cuts.push(Cut { piece, t, at, node }),
    }
}
