//! The network: drawn curves cut into pieces at their breaks and self-meetings, and the places where pieces meet.

use super::{ArrangeError, Drawing, Repair, RepairKind, Tolerances};
use crate::curve::meet::{self, MeetingKind};
use crate::curve::{BreakKind, Curve};
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, IdVec, PointId};

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

/// A part of a drawn curve.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub curve: Curve,
    pub ends: [PointId; 2],
    pub bounds: Rect,
    /// The drawn curve.
    pub source: u32,
    /// Further drawn curves that run along the whole piece, and whether they run against it.
    pub merged: Vec<(u32, bool)>,
    /// The whole of the drawn curve.
    pub whole: bool,
    /// Not yet looked at for meetings.
    pub fresh: bool,
}

impl Piece {
    pub fn new(curve: Curve, ends: [PointId; 2], source: u32, whole: bool) -> Self {
        Self { bounds: curve.bounds(), curve, ends, source, merged: Vec::new(), whole, fresh: true }
    }
}

/// Nodes and pieces on their way to a domain.
pub(super) struct Network<'a> {
    pub drawing: &'a Drawing,
    pub tolerances: Tolerances,
    pub nodes: IdVec<PointId, Node>,
    pub pieces: IdVec<CurveId, Piece>,
    pub repairs: Vec<Repair>,
    /// The ends of the drawn curves, as they were drawn; `None` of curves of no length.
    pub drawn_ends: Vec<Option<[PointId; 2]>>,
    /// The drawn points.
    pub drawn_points: Vec<PointId>,
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
    pub fn new(drawing: &'a Drawing, tolerances: Tolerances) -> Result<Self, ArrangeError> {
        let mut network = Network {
            drawing,
            tolerances,
            nodes: IdVec::new(),
            pieces: IdVec::new(),
            repairs: Vec::new(),
            drawn_ends: Vec::new(),
            drawn_points: Vec::new(),
        };
        for source in 0..drawing.curves.len() {
            let ends = network.add_curve(source as u32)?;
            network.drawn_ends.push(ends);
        }
        for (i, point) in drawing.points.iter().enumerate() {
            let id = network.add_node(point.at, Origin::Point(i as u32));
            network.drawn_points.push(id);
        }
        Ok(network)
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
        if extent(curve.bounds()) <= self.tolerances.weld {
            let what = format!("{} has no length and was dropped", self.entity(source));
            self.repair(RepairKind::ZeroLength, curve.start(), extent(curve.bounds()), what);
            return Ok(None);
        }
        let cuts = self.own_cuts(source, curve)?;
        let first = self.add_node(curve.start(), Origin::Curve(source));
        let last = if curve.start() == curve.end() { first } else { self.add_node(curve.end(), Origin::Curve(source)) };
        let (mut from, mut t0) = (first, 0.0);
        for &(t1, origin) in &cuts {
            let part = curve.part(t0, t1);
            let to = self.add_node(part.end(), origin);
            self.pieces.push(Piece::new(part, [from, to], source, false));
            (from, t0) = (to, t1);
        }
        let part = if cuts.is_empty() { curve.clone() } else { curve.part(t0, 1.0) };
        self.pieces.push(Piece::new(part, [from, last], source, cuts.is_empty()));
        Ok(Some([first, last]))
    }

    /// Where a drawn curve is cut on its own account: breaks, self-meetings, and once more where a part would be closed.
    fn own_cuts(&mut self, source: u32, curve: &Curve) -> Result<Vec<(f64, Origin)>, ArrangeError> {
        if matches!(curve, Curve::Line(_)) {
            return Ok(Vec::new());
        }
        let mut cuts = Vec::new();
        for at_break in curve.breaks() {
            let kind = match at_break.kind {
                BreakKind::Cusp => "a cusp",
                BreakKind::TangentJump => "a tangent jump",
            };
            let degrees = at_break.turn_rad.to_degrees();
            let what = format!("{} of {degrees:.3}° in {} became a corner", kind, self.entity(source));
            self.repair(RepairKind::Corner, curve.point(at_break.t), 0.0, what);
            cuts.push((at_break.t, Origin::Curve(source)));
        }
        for [t, u] in self.self_cuts(source, curve)? {
            let what = format!("{} meets itself and was split there", self.entity(source));
            self.repair(RepairKind::SelfSplit, curve.point(t), 0.0, what);
            cuts.extend([t, u].map(|t| (t, Origin::Meeting(source))));
        }
        cuts.retain(|&(t, _)| 0.0 < t && t < 1.0);
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        cuts.dedup_by_key(|cut| cut.0);
        Ok(self.open_up(source, curve, cuts))
    }

    /// Pairs of parameters at which a curve meets itself, its closing point apart.
    fn self_cuts(&self, source: u32, curve: &Curve) -> Result<Vec<[f64; 2]>, ArrangeError> {
        if matches!(curve, Curve::Arc(_) | Curve::Ellipse(_)) {
            return Ok(Vec::new());
        }
        let found = meet::self_meetings(curve, self.tolerances.weld).map_err(|_| ArrangeError {
            what: format!("{} meets itself at more places than can be told apart", self.entity(source)),
            at: curve.start(),
            help: "simplify the curve, or raise the tolerance".into(),
        })?;
        let mut pairs: Vec<[f64; 2]> = found.points.iter().map(|m| [m.t, m.u]).collect();
        pairs.extend(found.overlaps.iter().flat_map(|o| [[o.t[0], o.u[0]], [o.t[1], o.u[1]]]));
        let weld = self.tolerances.weld;
        let is_end = |t: f64, end: Point| curve.point(t).distance(end) <= weld;
        pairs.retain(|&[t, u]| {
            let closing = t.min(u) <= 0.0 && t.max(u) >= 1.0;
            let ends = is_end(t.min(u), curve.start()) && is_end(t.max(u), curve.end());
            let nearly = ends
                && extent(curve.bounds_of(0.0, t.min(u).max(f64::EPSILON))) <= weld
                && extent(curve.bounds_of(t.max(u).min(1.0 - f64::EPSILON), 1.0)) <= weld;
            !closing && !nearly
        });
        Ok(pairs)
    }

    /// Adds a cut in the middle of every part whose ends are one point.
    fn open_up(&self, source: u32, curve: &Curve, cuts: Vec<(f64, Origin)>) -> Vec<(f64, Origin)> {
        let weld = self.tolerances.weld;
        let mut open = Vec::with_capacity(cuts.len() + 1);
        let mut t0 = 0.0;
        for (t1, origin) in cuts.into_iter().map(|(t, o)| (t, Some(o))).chain([(1.0, None)]) {
            let closed = curve.point(t0).distance(curve.point(t1)) <= weld && extent(curve.bounds_of(t0, t1)) > weld;
            if closed {
                open.push(((t0 + t1) / 2.0, Origin::Curve(source)));
            }
            open.extend(origin.map(|o| (t1, o)));
            t0 = t1;
        }
        open
    }
}

// ---- where pieces meet ----
impl Network<'_> {
    /// Every place where fresh pieces and nodes meet others.
    pub fn meet(&mut self) -> Result<Found, ArrangeError> {
        let mut found = Found::default();
        let grown = self.pieces.iter().map(|p| p.bounds.inflate(self.tolerances.weld, self.tolerances.weld));
        let boxes = BoxHierarchy::new(grown);
        self.nodes_on_pieces(&boxes, &mut found);
        let mut pairs = Vec::new();
        boxes.pairs(|i, j| {
            let (a, b) = (CurveId::from_index(i), CurveId::from_index(j));
            if self.pieces[a].fresh || self.pieces[b].fresh {
                pairs.push((a, b));
            }
        });
        for (a, b) in pairs {
            match (&self.pieces[a].curve, &self.pieces[b].curve) {
                (Curve::Line(_), Curve::Line(_)) => self.cross_lines(a, b, &mut found),
                _ => self.meet_curves(a, b, &mut found)?,
            }
        }
        self.nodes.iter_mut().for_each(|n| n.fresh = false);
        self.pieces.iter_mut().for_each(|p| p.fresh = false);
        Ok(found)
    }

    /// Nodes that lie on pieces without being their ends: T-junctions, collinear overlaps, drawn points on curves.
    fn nodes_on_pieces(&mut self, boxes: &BoxHierarchy, found: &mut Found) {
        let mut near = Vec::new();
        for (id, node) in self.nodes.enumerate() {
            boxes.meeting(Rect::from_points(node.at, node.at), |i| {
                let piece = CurveId::from_index(i);
                if (node.fresh || self.pieces[piece].fresh) && !self.pieces[piece].ends.contains(&id) {
                    near.push((id, piece));
                }
                true
            });
        }
        near.sort_unstable();
        for (id, piece) in near {
            let at = self.nodes[id].at;
            let (t, distance) = self.pieces[piece].curve.nearest(at, 0.0, 1.0);
            if distance <= self.tolerances.weld {
                let site = self.site(piece, t, self.pieces[piece].curve.point(t));
                join(found, (piece, site), id);
            }
        }
    }

    /// The proper crossing of two lines. All other ways in which lines meet have an end of one on the other.
    fn cross_lines(&mut self, a: CurveId, b: CurveId, found: &mut Found) {
        let [p, q] = [a, b].map(|id| &self.pieces[id]);
        if p.ends.iter().any(|end| q.ends.contains(end)) {
            return;
        }
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
        let [p, q] = [a, b].map(|id| &self.pieces[id]);
        let meetings = meet::meetings(&p.curve, &q.curve, self.tolerances.weld).map_err(|_| ArrangeError {
            what: format!(
                "{} and {} run so near to each other that their meetings cannot be told apart",
                self.entity(p.source),
                self.entity(q.source)
            ),
            at: p.bounds.intersect(q.bounds).center(),
            help: "remove one of the two, or raise the tolerance so that they become one".into(),
        })?;
        let mut places: Vec<(Point, [f64; 2])> = Vec::new();
        for meeting in &meetings.points {
            if !self.is_contact([a, b], [meeting.t, meeting.u], meeting.kind) {
                places.push((meeting.at, [meeting.t, meeting.u]));
            }
        }
        for overlap in &meetings.overlaps {
            for k in 0..2 {
                places.push((p.curve.point(overlap.t[k]), [overlap.t[k], overlap.u[k]]));
            }
        }
        for (at, [t, u]) in places {
            self.join_pieces((a, t), (b, u), at, found);
        }
        Ok(())
    }

    /// Whether a meeting of two pieces is nothing but their contact at a common end: curves that share a tangent there stay within
    /// the tolerance of each other for a while. A true crossing further on is one all the same, unless it drowns in rounding.
    fn is_contact(&self, ids: [CurveId; 2], ts: [f64; 2], kind: MeetingKind) -> bool {
        let [p, q] = ids.map(|id| &self.pieces[id]);
        let slack = match kind {
            MeetingKind::Crossing => self.tolerances.rounding,
            _ => self.tolerances.weld,
        };
        let shared = (0..2).flat_map(|i| (0..2).map(move |j| (i, j))).filter(|&(i, j)| p.ends[i] == q.ends[j]);
        let within = |t: f64, end: usize, curve: &Curve, other: &Curve| {
            let end = end as f64;
            // Halfway and next to the meeting: contact fades slowest there.
            [0.5, 0.75].iter().all(|&f| other.nearest(curve.point(end + f * (t - end)), 0.0, 1.0).1 <= slack)
        };
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
