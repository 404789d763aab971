//! The arrangement: nodes, and the edges of drawn curves that run between them, on their way to a domain.
//!
//! ```text
//!   as drawn                 edges a, b, c and nodes ●
//!
//!   p ──────────────         ●── a ──●══ b ══●── c ──●     An edge is a part of one drawn curve, its `source`: a and b
//!           ─────────── q                                  are parts of p, c is a part of q. q runs along b as well:
//!                                                          it is listed in `merged` of b.
//! ```

use super::frame::Tolerances;
use super::repair::{Repair, RepairKind};
use crate::curve::{Curve, End};
use crate::domain::Drawing;
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, IdVec, PointId, SeenId, ShapeId};
use crate::watch::Progress;
use std::collections::BTreeMap;

/// Why there is a node or a cut. Where nodes are welded, the earlier variant is kept: a drawn place before a computed
/// one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum NodeOrigin {
    /// An end or a break of a drawn curve.
    Curve(u32),
    /// A drawn point.
    Point(u32),
    /// Computed: where the drawn curve is met.
    Meeting(u32),
}

impl NodeOrigin {
    /// Whether the place was computed, and not drawn.
    pub fn is_computed(self) -> bool {
        matches!(self, NodeOrigin::Meeting(_))
    }

    /// The entity of `drawing` that the node is part of, as messages call it.
    pub fn text(self, drawing: &Drawing) -> &str {
        match self {
            NodeOrigin::Curve(i) | NodeOrigin::Meeting(i) => &drawing.curves[i as usize].entity,
            NodeOrigin::Point(i) => &drawing.points[i as usize].entity,
        }
    }
}

/// A vertex of the domain in the making.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Its place, in the unit frame.
    pub at: Point,
    /// Why it is there.
    pub origin: NodeOrigin,
    /// Not yet looked at for meetings.
    pub fresh: bool,
}

/// A curve, and between which parameters of a drawn one it runs.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// The geometry, which may have been moved within the tolerance.
    pub curve: Curve,
    /// The two parameters.
    pub range: [f64; 2],
}

impl Part {
    /// The whole of a drawn curve.
    pub fn whole(curve: &Curve) -> Self {
        Self { curve: curve.clone(), range: [0.0, 1.0] }
    }

    /// The part between two parameters of this one, `t0 < t1`.
    pub fn between(&self, t0: f64, t1: f64) -> Self {
        let [r0, r1] = self.range;
        let along = |t: f64| if t == 1.0 { r1 } else { r0 + t * (r1 - r0) };
        Self { curve: self.curve.part(t0, t1), range: [along(t0), along(t1)] }
    }

    /// The parts between cuts: ascending parameters strictly inside this one.
    pub fn split(self, cuts: &[f64]) -> Vec<Self> {
        if cuts.is_empty() {
            return vec![self];
        }
        let starts = [0.0].into_iter().chain(cuts.iter().copied());
        starts.zip(cuts.iter().copied().chain([1.0])).map(|(t0, t1)| self.between(t0, t1)).collect()
    }
}

/// A part of a drawn curve between two nodes.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    /// Its geometry, from the first of its nodes to the second.
    pub curve: Curve,
    /// The nodes at its start and end.
    pub ends: [PointId; 2],
    /// The box around `curve`.
    pub bounds: Rect,
    /// The drawn curve.
    pub source: u32,
    /// Between which of its parameters.
    pub range: [f64; 2],
    /// Further drawn curves that run along the whole edge, and whether they run against it.
    pub merged: Vec<(u32, bool)>,
    /// The shapes that are visible on its left and right. Set once hidden stretches are left out.
    pub paint: Option<[Option<SeenId>; 2]>,
    /// Not yet looked at for meetings.
    pub fresh: bool,
}

impl Edge {
    /// A fresh edge along a part of the drawn curve `source`.
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

    /// Whether its curve is a line segment.
    pub fn is_line(&self) -> bool {
        matches!(self.curve, Curve::Line(_))
    }

    /// The node at one of its ends.
    pub fn end(&self, end: End) -> PointId {
        match end {
            End::Start => self.ends[0],
            End::Finish => self.ends[1],
        }
    }
}

/// Nodes and edges of which a domain is made, with the repairs so far.
pub(super) struct Arrangement<'a> {
    /// The drawing, in the unit frame.
    pub drawing: &'a Drawing,
    /// Its lengths below which features become one.
    pub tolerances: Tolerances,
    /// The nodes.
    pub nodes: IdVec<PointId, Node>,
    /// The edges, each between two of the nodes.
    pub edges: IdVec<CurveId, Edge>,
    /// What was repaired so far.
    pub repairs: Vec<Repair>,
    /// Loops of a drawn curve that became lines: the curve, the place and the width. They are listed as repairs where
    /// some of the curve is left.
    pub loops: Vec<(u32, Point, f64)>,
    /// The ends of the drawn curves, as they were drawn; `None` of curves of no length.
    pub drawn_ends: Vec<Option<[PointId; 2]>>,
    /// The drawn points.
    pub drawn_points: Vec<PointId>,
    /// What the paint of edges refers to.
    pub seen: Seen,
}

/// The lists of shapes that are visible on faces, the topmost first; each list is stored once.
#[derive(Default)]
pub(super) struct Seen {
    /// By id.
    pub lists: IdVec<SeenId, Vec<ShapeId>>,
    known: BTreeMap<Vec<ShapeId>, SeenId>,
}

impl Seen {
    /// The id of a list, which is recorded if it is new; `None` of an empty one.
    pub fn id(&mut self, list: Vec<ShapeId>) -> Option<SeenId> {
        if list.is_empty() {
            return None;
        }
        if let Some(&known) = self.known.get(&list) {
            return Some(known);
        }
        let id = self.lists.push(list.clone());
        self.known.insert(list, id);
        Some(id)
    }

    /// The topmost of a list.
    pub fn top(&self, id: SeenId) -> ShapeId {
        self.lists[id][0]
    }
}

/// Whether a curve is an arc whose ends lie at different distances from its center. Only parts of it are arcs of
/// circles, and the parts on the two sides of a cut lie on different circles.
pub(super) fn is_spiral(curve: &Curve) -> bool {
    matches!(curve, Curve::Arc(arc) if arc.is_spiral())
}

impl<'a> Arrangement<'a> {
    /// Without nodes and edges.
    pub fn empty(drawing: &'a Drawing, tolerances: Tolerances) -> Self {
        Self {
            drawing,
            tolerances,
            nodes: IdVec::new(),
            edges: IdVec::new(),
            repairs: Vec::new(),
            loops: Vec::new(),
            drawn_ends: Vec::new(),
            drawn_points: Vec::new(),
            seen: Seen::default(),
        }
    }

    /// The progress of a phase with `queued` steps left.
    pub fn progress(&self, phase: &'static str, queued: usize) -> Progress {
        Progress { phase, vertices: self.nodes.len(), queued }
    }

    /// Adds a fresh node.
    pub fn add_node(&mut self, at: Point, origin: NodeOrigin) -> PointId {
        self.nodes.push(Node { at, origin, fresh: true })
    }

    /// What a drawn curve is called.
    pub fn entity(&self, source: u32) -> &'a str {
        &self.drawing.curves[source as usize].entity
    }

    /// What the drawn curve of an edge is called.
    pub fn text_of(&self, id: CurveId) -> &str {
        &self.drawing.curves[self.edges[id].source as usize].entity
    }

    /// The drawn curves that run along an edge, and whether each runs against it.
    pub fn drawn_along(&self, id: CurveId) -> impl Iterator<Item = (u32, bool)> + use<'_> {
        let edge = &self.edges[id];
        [(edge.source, false)].into_iter().chain(edge.merged.iter().copied())
    }

    /// Adds a repair to the list.
    pub fn repair(&mut self, kind: RepairKind, at: Point, size: f64, what: String) {
        self.repairs.push(Repair { kind, at: [at.x, at.y], size, what });
    }

    /// Drops nodes at which no edge ends and nothing was drawn; the order stays.
    pub fn renumber(&mut self) {
        let mut used: IdVec<PointId, bool> = vec![false; self.nodes.len()].into();
        let ends = self.edges.iter().flat_map(|p| p.ends);
        let drawn = self.drawn_ends.iter().flatten().flatten().copied().chain(self.drawn_points.iter().copied());
        ends.chain(drawn).for_each(|id| used[id] = true);
        let mut nodes: IdVec<PointId, Node> = IdVec::new();
        let renamed: IdVec<PointId, PointId> =
            (self.nodes.enumerate()).map(|(id, &node)| if used[id] { nodes.push(node) } else { id }).collect();
        self.nodes = nodes;
        self.edges.iter_mut().flat_map(|p| &mut p.ends).for_each(|end| *end = renamed[*end]);
        self.drawn_ends.iter_mut().flatten().flatten().for_each(|end| *end = renamed[*end]);
        self.drawn_points.iter_mut().for_each(|node| *node = renamed[*node]);
    }
}
