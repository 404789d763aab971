//! Free ends: which of them are joined, which outlines miss closing, and which lines are plainly open.
//!
//! A *free end* is a node at which a single piece ends; its *chain* leads from there to the next free end or branch.
//!
//! ```text
//!   a ───────────────── b     b and c are each other's nearest free ends. They are joined at their corner where the last decimal of the file
//!   │                   c     explains the gap, or within `close`. Else, where chains would close into a ring in this way and every gap is
//!   │                   │     short beside the chains at it, the outline was meant to be closed, and the drawing is refused (`rings`).
//!   └───────────────────┘     All other free ends are those of plainly open lines.
//! ```

use super::cut::{Network, Piece, extent};
use super::{ArrangeError, Loose, RepairKind};
use crate::curve::End;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect, Vec2, scaled};
use crate::ids::{CurveId, Forest, Id, IdVec, PointId};
use std::collections::{BTreeMap, BTreeSet};

/// A gap is narrower than this part of the chains beside it: else it is no gap, but the length of a stub.
const NARROW: f64 = 0.5;

/// Lines make a corner where the sine of the angle between them is larger.
const SQUARE: f64 = 0.1;

/// The corner that two lines make lies within so many gaps of their ends.
const FARTHER: f64 = 2.0;

/// An end stops short of a line of its own chain where the way along the chain is so many times as long as the gap.
const AROUND: f64 = 4.0;

/// Places that a note lists.
const LISTED: usize = 3;

/// What ends freely.
#[derive(Clone, Copy)]
pub(super) enum Owner {
    Node(PointId),
    /// An entity that was left out because it leaves the plane: its place in the drawing's list, and which of its ends.
    OffPlane(usize, usize),
}

pub(super) struct FreeEnd {
    pub at: Point,
    /// Unit vector along the line that ends there.
    direction: Vec2,
    pub owner: Owner,
    /// The length of its chain, as the boxes around its pieces tell it.
    pub chain: f64,
    /// The unit of the last decimal in which it is written; 0: exact.
    last_decimal: f64,
}

/// Two free ends that may have been meant as one.
#[derive(Clone, Copy)]
pub(super) struct Gap {
    pub ends: [usize; 2],
    pub width: f64,
}

/// A free end that stops short of the inside of an open line: had it reached the line, they might bound something.
///
/// ```text
///   ─────────────┬─────       the line goes on beyond the corner
///                · gap
///                │
/// ```
#[derive(Clone, Copy)]
pub(super) struct Short {
    pub end: usize,
    pub onto: CurveId,
    /// The nearest point of the line, and its parameter.
    pub at: Point,
    pub t: f64,
    pub width: f64,
}

/// Where two free ends are joined: at the corner that their lines make a little farther on, so that neither turns; where they hardly make
/// one, at the first.
///
/// ```text
///      a ────── · corner
///               │
///               b
/// ```
fn meeting_place([a, b]: [&FreeEnd; 2], width: f64) -> Point {
    let sine = a.direction.cross(b.direction);
    if sine.abs() < SQUARE {
        return a.at;
    }
    let corner = a.at + a.direction * ((b.at - a.at).cross(b.direction) / sine);
    let is_near = [a, b].iter().all(|end| end.at.distance(corner) <= FARTHER * width);
    if is_near { corner } else { a.at }
}

/// Of each end in `among`, the nearest other one nearer than `bound` allows.
pub(super) fn nearest_ends(ends: &[FreeEnd], among: &[usize], bound: impl Fn(usize) -> f64) -> Vec<Gap> {
    let boxes = BoxHierarchy::new(among.iter().map(|&i| Rect::from_points(ends[i].at, ends[i].at)));
    let nearest = |&i: &usize| {
        let away = |k: usize, _| if among[k] == i { f64::INFINITY } else { ends[i].at.distance(ends[among[k]].at) };
        // The bound itself still counts: a gap as wide as the tolerance is closed.
        let (k, width) = boxes.nearest(ends[i].at, bound(i).next_up(), away)?;
        Some(Gap { ends: [i, among[k]], width })
    };
    among.iter().filter_map(nearest).collect()
}

/// Pieces at each node, for walks along them.
struct Joints(IdVec<PointId, Vec<CurveId>>);

impl Joints {
    fn new(network: &Network) -> Self {
        let mut at: IdVec<PointId, Vec<CurveId>> = vec![Vec::new(); network.nodes.len()].into();
        for (id, piece) in network.pieces.enumerate() {
            piece.ends.into_iter().for_each(|end| at[end].push(id));
        }
        Self(at)
    }

    fn is_free(&self, node: PointId) -> bool {
        self.0[node].len() == 1
    }

    fn degree(&self, node: PointId) -> usize {
        self.0[node].len()
    }
}

/// The other end of a piece.
fn far_end(piece: &Piece, from: PointId) -> PointId {
    if piece.ends[0] == from { piece.ends[1] } else { piece.ends[0] }
}

impl Network<'_> {
    /// Joins free ends that are each other's nearest, within the gaps that the tolerances allow; whether there were any.
    ///
    /// **Termination.** Every round but the last joins two ends or more.
    pub fn join_free_ends(&mut self) -> bool {
        let ends = self.free_ends();
        let mut left: Vec<usize> = (0..ends.len()).collect();
        let mut joined = false;
        loop {
            let gaps = self.gaps_to_join(&ends, &left);
            if gaps.is_empty() {
                return self.reach_open_lines(&ends, &left) || joined;
            }
            let gone: BTreeSet<usize> = gaps.iter().flat_map(|gap| gap.ends).collect();
            left.retain(|i| !gone.contains(i));
            gaps.iter().for_each(|gap| self.join(&ends, gap));
            joined = true;
        }
    }

    fn gaps_to_join(&self, ends: &[FreeEnd], left: &[usize]) -> Vec<Gap> {
        let tolerances = &self.tolerances;
        let bound = tolerances.gap.max(tolerances.written).max(tolerances.close);
        if bound == 0.0 {
            return Vec::new();
        }
        let nearest = nearest_ends(ends, left, |_| bound);
        let mut partner: Vec<Option<usize>> = vec![None; ends.len()];
        nearest.iter().for_each(|gap| partner[gap.ends[0]] = Some(gap.ends[1]));
        let is_gap = |gap: &Gap| {
            let [i, j] = gap.ends;
            let is_mutual = i < j && partner[j] == Some(i);
            let units = gap.ends.map(|end| ends[end].last_decimal).into_iter().filter(|&unit| unit > 0.0);
            let written = 2.0 * units.reduce(f64::min).unwrap_or(0.0) + tolerances.rounding;
            let reach = tolerances.gap.max(written.min(tolerances.written)).max(tolerances.close);
            // What is no longer than the gap beside it would be folded onto itself.
            is_mutual && gap.width <= reach && gap.width < NARROW * ends[i].chain.min(ends[j].chain)
        };
        nearest.into_iter().filter(is_gap).collect()
    }

    /// Moves ends that stop short of open lines onto them, as far as was asked for; whether there were any.
    fn reach_open_lines(&mut self, ends: &[FreeEnd], left: &[usize]) -> bool {
        let close = self.tolerances.close;
        let mut shorts = if close > 0.0 { self.shorts(ends, left, |_| close.next_up()) } else { Vec::new() };
        shorts.retain(|short| short.width < NARROW * ends[short.end].chain);
        for short in &shorts {
            let Owner::Node(node) = ends[short.end].owner else { continue };
            let [a, b] = [self.nodes[node].origin.text(self.drawing), self.text_of(short.onto)];
            let what = format!("a gap between the end of {a} and {b} was closed");
            self.repair(RepairKind::GapClosed, short.at, short.width, what);
            (self.nodes[node].at, self.nodes[node].fresh) = (short.at, true);
        }
        !shorts.is_empty()
    }

    /// Of each end in `among`, the nearest line whose inside is nearer than `bound` allows; of its own chain, a line farther on. Only where
    /// neither is connected with anything closed: lines that stop short of each other within a grid take nothing from what it bounds.
    pub(super) fn shorts(&self, ends: &[FreeEnd], among: &[usize], bound: impl Fn(usize) -> f64) -> Vec<Short> {
        let open = self.pieces_of_trees();
        let boxes = BoxHierarchy::new(open.iter().map(|&id| self.pieces[id].bounds));
        let joints = Joints::new(self);
        let short = |&i: &usize| {
            let Owner::Node(node) = ends[i].owner else { return None };
            open.binary_search(&joints.0[node][0]).ok()?;
            let along: BTreeMap<CurveId, f64> = self.chain(node, &joints).into_iter().collect();
            let p = ends[i].at;
            let foot = |k: usize| self.pieces[open[k]].curve.nearest(p, 0.0, 1.0);
            let away = |k: usize, _| {
                let (t, width) = foot(k);
                let is_apart = along.get(&open[k]).is_none_or(|&way| way > AROUND * width);
                if 0.0 < t && t < 1.0 && is_apart { width } else { f64::INFINITY }
            };
            let (k, width) = boxes.nearest(p, bound(i), away)?;
            let (t, _) = foot(k);
            Some(Short { end: i, onto: open[k], at: self.pieces[open[k]].curve.point(t), t, width })
        };
        among.iter().filter_map(short).collect()
    }

    /// Moves both ends of a gap to where they meet, which becomes the place of the first.
    fn join(&mut self, ends: &[FreeEnd], gap: &Gap) {
        let [Owner::Node(kept), Owner::Node(moved)] = gap.ends.map(|end| ends[end].owner) else { return };
        let [a, b] = [kept, moved].map(|node| self.nodes[node].origin.text(self.drawing));
        let what = format!("a gap between the ends of {a} and {b} was closed");
        let at = meeting_place(gap.ends.map(|end| &ends[end]), gap.width);
        self.repair(RepairKind::GapClosed, at, gap.width, what);
        let origin = self.nodes[kept].origin;
        for node in [kept, moved] {
            (self.nodes[node].at, self.nodes[node].origin, self.nodes[node].fresh) = (at, origin, true);
        }
    }

    /// Nodes at which a single piece ends, ascending.
    pub(super) fn free_ends(&self) -> Vec<FreeEnd> {
        let joints = Joints::new(self);
        let free = self.nodes.ids().filter(|&node| joints.is_free(node));
        free.map(|node| self.free_end(node, &joints)).collect()
    }

    fn free_end(&self, node: PointId, joints: &Joints) -> FreeEnd {
        let (last, before) = *self.chain(node, joints).last().expect("a free end has a piece");
        let chain = before + extent(self.pieces[last].bounds);
        let piece = &self.pieces[joints.0[node][0]];
        let end = if piece.ends[0] == node { End::Start } else { End::Finish };
        let direction = piece.curve.direction_at(end);
        let last_decimal = self.drawing.curves[piece.source as usize].last_decimal;
        FreeEnd { at: self.nodes[node].at, direction, owner: Owner::Node(node), chain, last_decimal }
    }

    /// The pieces from a free end to the next free end or branch, each with the length of those before it, as the boxes around them tell it.
    fn chain(&self, node: PointId, joints: &Joints) -> Vec<(CurveId, f64)> {
        let (mut here, mut along, mut before) = (node, joints.0[node][0], 0.0);
        let mut chain = vec![(along, before)];
        loop {
            here = far_end(&self.pieces[along], here);
            before += extent(self.pieces[along].bounds);
            match joints.0[here][..] {
                [a, b] if a != b => along = if a == along { b } else { a },
                _ => return chain,
            }
            chain.push((along, before));
        }
    }

    /// Refuses outlines that miss closing, and leaves out or tells of what is open, as `loose` says; what is to be told.
    ///
    /// # Errors
    /// With the ends, the gaps, and the option that closes them.
    pub fn settle_loose_ends(&mut self, loose: Loose) -> Result<Vec<String>, ArrangeError> {
        let mut ends = self.free_ends();
        if ends.is_empty() {
            return Ok(Vec::new());
        }
        let own = ends.len();
        ends.extend(self.off_plane_ends());
        if matches!(loose, Loose::Auto | Loose::Error)
            && let Some(missed) = self.missed_rings(&ends)
        {
            return Err(missed);
        }
        let open = self.open_pieces();
        let told = self.tell_open(&ends[..own], &open, loose);
        match loose {
            Loose::Error => Err(self.open_refused(&ends[..own])),
            Loose::Auto | Loose::Keep => Ok(vec![told]),
            Loose::Drop => {
                let pieces = std::mem::take(&mut self.pieces);
                self.pieces = pieces.enumerate().filter(|(id, _)| !open.contains(id)).map(|(_, p)| p.clone()).collect();
                self.renumber();
                Ok(vec![told])
            }
        }
    }

    /// The ends of entities that were left out because they leave the plane: what they would have closed is no open line.
    fn off_plane_ends(&self) -> impl Iterator<Item = FreeEnd> {
        self.drawing.off_plane.iter().enumerate().flat_map(|(k, entity)| {
            let chain = entity.ends[0].distance(entity.ends[1]);
            let direction = (entity.ends[1] - entity.ends[0]) / chain;
            [0, 1].map(|end| {
                let owner = Owner::OffPlane(k, end);
                FreeEnd { at: entity.ends[end], direction, owner, chain, last_decimal: 0.0 }
            })
        })
    }

    /// Pieces that are connected with nothing closed, ascending.
    fn pieces_of_trees(&self) -> Vec<CurveId> {
        let mut parts = Forest::new(self.nodes.len());
        let mut closed = Vec::new();
        for piece in self.pieces.iter() {
            let [a, b] = piece.ends.map(Id::index);
            if parts.root(a) == parts.root(b) {
                closed.push(a);
            }
            parts.join(a, b);
        }
        let closed: BTreeSet<usize> = closed.into_iter().map(|node| parts.root(node)).collect();
        let mut is_tree = |&id: &CurveId| !closed.contains(&parts.root(self.pieces[id].ends[0].index()));
        self.pieces.ids().filter(|id| is_tree(id)).collect()
    }

    /// Pieces that lead to free ends and bound nothing.
    fn open_pieces(&self) -> BTreeSet<CurveId> {
        let joints = Joints::new(self);
        let mut degree: IdVec<PointId, usize> = self.nodes.ids().map(|node| joints.degree(node)).collect();
        let mut free: Vec<PointId> = self.nodes.ids().filter(|&node| joints.is_free(node)).collect();
        let mut open = BTreeSet::new();
        while let Some(node) = free.pop() {
            let Some(&piece) = joints.0[node].iter().find(|piece| !open.contains(*piece)) else { continue };
            open.insert(piece);
            let beyond = far_end(&self.pieces[piece], node);
            degree[beyond] -= 1;
            if degree[beyond] == 1 {
                free.push(beyond);
            }
        }
        open
    }

    /// How many lines are open, how long they are, and where.
    fn tell_open(&self, ends: &[FreeEnd], open: &BTreeSet<CurveId>, loose: Loose) -> String {
        let drawn: BTreeSet<u32> = open.iter().map(|&id| self.pieces[id].source).collect();
        let length: f64 = open.iter().map(|&id| self.pieces[id].curve.length()).sum();
        let listed = ends.iter().take(LISTED).map(|end| self.place(end)).collect::<Vec<_>>().join(", ");
        let more = if ends.len() > LISTED { ", …" } else { "" };
        let lines = if drawn.len() == 1 { "1 line is open".into() } else { format!("{} lines are open", drawn.len()) };
        let fate = match loose {
            Loose::Drop => "were left out",
            Loose::Auto | Loose::Keep | Loose::Error => {
                "are mesh edges where they lie in a region (--loose drop leaves them out)"
            }
        };
        let length = self.tolerances.told(length);
        format!("{lines}: {length} in all, which bounds nothing, with ends at {listed}{more}; they {fate}.")
    }

    /// The entity of an end and its place in the drawing.
    pub(super) fn place(&self, end: &FreeEnd) -> String {
        let Point { x, y } = scaled(end.at, self.tolerances.unit);
        format!("({x}, {y}) of {}", self.entity_of(end))
    }

    pub(super) fn entity_of(&self, end: &FreeEnd) -> &str {
        match end.owner {
            Owner::Node(node) => self.nodes[node].origin.text(self.drawing),
            Owner::OffPlane(k, _) => &self.drawing.off_plane[k].entity,
        }
    }

    /// The entity of a piece.
    pub(super) fn text_of(&self, id: CurveId) -> &str {
        &self.drawing.curves[self.pieces[id].source as usize].entity
    }

    fn open_refused(&self, ends: &[FreeEnd]) -> ArrangeError {
        let first = &ends[0];
        let others = ends[1..].iter().map(|end| end.at.distance(first.at)).reduce(f64::min);
        let nearest = others.map_or_else(String::new, |gap| {
            format!("; the nearest other free end is {} away", self.tolerances.told(gap))
        });
        let what = format!("{} ends freely{nearest}", self.entity_of(first));
        ArrangeError::new(what, first.at, "close the outline, or mesh with open lines by --loose keep")
    }
}
