//! Hidden stretches: parts of the outlines of a picture's shapes that later shapes occlude. Such a stretch bounds
//! nothing, and the faces on its two sides become one.
//!
//! ```text
//!   ╭──────────╮                ╭──────────╮           B is painted over A. On both sides of the stretch h the topmost
//!   │ A    ╭───┼─────╮          │ A    ╭───┴─────╮     shape is B: h is hidden and left out. Across each other stretch
//!   │      │   h  B  │    ▶     │      │      B  │     the topmost shape changes: it stays.
//!   ╰──────┼─h─╯     │          ╰──────┤         │
//!          ╰─────────╯                 ╰─────────╯
//! ```
//!
//! Stretches that a clip cuts away are left out, too, and so is the outline of a clip, except where it bounds a clipped
//! shape.
//!
//! A curve that was split only where hidden stretches met it is made whole again, as one part of the drawn curve. The
//! fragments had been moved by up to a tolerance, so the arrangement is settled once more after that.

use super::arrangement::{Arrangement, Edge, Part, is_spiral};
use super::faces::Faces;
use super::paint::{lines_in_clips, painters};
use super::repair::{Cells, RepairKind};
use super::trace::DirectedEdge;
use crate::curve::End;
use crate::domain::locate::Side;
use crate::geometry::extent;
use crate::ids::{CurveId, IdVec, NameId, PointId, SeenId};
use std::collections::BTreeSet;

/// There is a corner at a node where the directions before and after it differ by more than this (the sine of the
/// angle).
const STRAIGHT_ON: f64 = 0.01;

impl Arrangement<'_> {
    /// Leaves out the hidden stretches, and notes on the other edges which shapes are visible beside them. Returns
    /// whether anything changed. `faces` are those of the settled arrangement. With `all`, the borders of all shapes
    /// are kept, not only those of the topmost.
    pub fn drop_hidden(&mut self, faces: &Faces, all: bool) -> bool {
        let (seen, painters) = painters(self, faces, all);
        let beside = |id: CurveId, side| faces.face(DirectedEdge { curve: id, side }).and_then(|face| painters[face]);
        let sides = |id: CurveId| [Side::Left, Side::Right].map(|side| beside(id, side));
        let lines = lines_in_clips(self, faces);
        let is_clipped = !self.drawing.clips.is_empty();
        let is_hidden = |id: CurveId| {
            let [left, right] = sides(id);
            left == right && (left.is_some() || is_clipped) && !lines[id]
        };
        let (hidden, left): (Vec<CurveId>, Vec<CurveId>) = self.edges.ids().partition(|&id| is_hidden(id));
        if hidden.is_empty() && !is_clipped {
            return false;
        }
        self.seen = seen;
        let paint: Vec<_> = left.iter().map(|&id| sides(id)).collect();
        self.itemise_hidden(&hidden, &painters, faces);
        let painted = |(&id, paint)| Edge { paint: Some(paint), ..self.edges[id].clone() };
        let edges: Vec<Edge> = left.iter().zip(paint).map(painted).collect();
        // The ends of hidden outlines are no longer nodes.
        self.drawn_ends.iter_mut().for_each(|ends| *ends = None);
        self.rejoin(edges.into());
        self.renumber();
        self.forget_splits();
        true
    }

    /// Lists a repair for every drawn curve that is hidden in part.
    fn itemise_hidden(&mut self, hidden: &[CurveId], painters: &[Option<SeenId>], faces: &Faces) {
        let mut known = BTreeSet::new();
        for &id in hidden {
            let edge = &self.edges[id];
            // Stretches outside of a clip, and the clip's own outline, were not meant to be visible: they are not
            // listed.
            let over = faces.face(DirectedEdge { curve: id, side: Side::Left }).and_then(|face| painters[face]);
            let Some(over) = over.filter(|_| !self.is_of_clip(edge.source) && known.insert(edge.source)) else {
                continue;
            };
            let over = &self.drawing.shapes[self.seen.top(over)].entity;
            let what = format!("{} runs beneath {over} and was left out there", self.entity(edge.source));
            let at = edge.curve.point(0.5);
            self.repair(RepairKind::Hidden, at, 0.0, what);
        }
    }

    /// Whether a drawn curve is part of the outline of a clip.
    fn is_of_clip(&self, source: u32) -> bool {
        let shape = self.drawing.curves[source as usize].shape;
        shape.is_some_and(|shape| self.drawing.shapes[shape].part_of.is_some())
    }

    /// The name of the boundary along an edge: the drawn curve's name or, for the outline of a clip, that of the shape
    /// it clips.
    pub fn boundary_name(&self, edge: &Edge) -> NameId {
        let drawn = self.drawing.curves[edge.source as usize].name;
        let cut = edge.paint.into_iter().flatten().flatten().map(|seen| self.seen.top(seen)).max();
        match cut {
            Some(shape) if self.is_of_clip(edge.source) => self.drawing.shapes[shape].name,
            Some(_) | None => drawn,
        }
    }

    /// Rebuilds the edges from those that are left. Runs of edges that only hidden stretches had separated become one.
    ///
    /// ```text
    ///   ●──── a ────●──── b ────●            ●───────── ab ─────────●   h is left out. a and b are parts of one drawn
    ///               │ h               ▶                                 curve, without a corner between them: they
    ///                                                                   become one.
    /// ```
    fn rejoin(&mut self, left: IdVec<CurveId, Edge>) {
        let mut at_node: IdVec<PointId, Vec<CurveId>> = vec![Vec::new(); self.nodes.len()].into();
        left.enumerate().for_each(|(id, edge)| edge.ends.into_iter().for_each(|end| at_node[end].push(id)));
        // A drawn point stays a node.
        self.drawn_points.iter().for_each(|&node| at_node[node].clear());
        let next = |id: CurveId| match at_node[left[id].ends[1]][..] {
            [a, b] if a != b => Some(if a == id { b } else { a }).filter(|&next| self.goes_on(&left[id], &left[next])),
            _ => None,
        };
        let follows: IdVec<CurveId, Option<CurveId>> = left.ids().map(next).collect();
        let mut is_first: IdVec<CurveId, bool> = vec![true; left.len()].into();
        follows.iter().flatten().for_each(|&id| is_first[id] = false);
        self.edges = IdVec::new();
        for first in left.ids().filter(|&id| is_first[id]) {
            let mut run = vec![first];
            while let Some(next) = follows[run[run.len() - 1]] {
                // A closed run would have no ends: it is placed before it closes.
                if left[next].ends[1] == left[run[0]].ends[0] {
                    self.place_run(&run, &left);
                    run.clear();
                }
                run.push(next);
            }
            self.place_run(&run, &left);
        }
    }

    /// Whether `next` continues `edge`: along the same drawn curve, without a corner, between the same shapes.
    fn goes_on(&self, edge: &Edge, next: &Edge) -> bool {
        let [from, to] = [edge.range[1], next.range[0]];
        if edge.source != next.source || edge.paint != next.paint || edge.ends[1] != next.ends[0] || from > to {
            return false;
        }
        let source = &self.drawing.curves[edge.source as usize].curve;
        if is_spiral(source) {
            return false;
        }
        let (before, after) = (source.tangent(from, End::Finish), source.tangent(to, End::Start));
        let turns =
            before.cross(after).abs() > STRAIGHT_ON * before.hypot() * after.hypot() || before.dot(after) <= 0.0;
        !turns && (from == to || extent(source.bounds_of(from, to)) <= 2.0 * self.tolerances.weld)
    }

    fn place_run(&mut self, run: &[CurveId], left: &IdVec<CurveId, Edge>) {
        let (first, last) = (&left[run[0]], &left[run[run.len() - 1]]);
        if run.len() == 1 {
            self.edges.push(first.clone());
            return;
        }
        let range = [first.range[0], last.range[1]];
        let curve = self.drawing.curves[first.source as usize].curve.part(range[0], range[1]);
        let mut whole = Edge::new(Part { curve, range }, [first.ends[0], last.ends[1]], first.source);
        let merged: BTreeSet<(u32, bool)> = run.iter().flat_map(|&id| left[id].merged.iter().copied()).collect();
        whole.merged.extend(merged);
        whole.paint = first.paint;
        self.place_part(whole);
    }

    /// Drops splits from the list of repairs at places where there is no node any more.
    pub fn forget_splits(&mut self) {
        let cells = Cells::wider_than(self.tolerances.weld);
        let nodes: BTreeSet<[i64; 2]> = self.nodes.iter().map(|node| cells.of([node.at.x, node.at.y])).collect();
        let is_node = |at: [f64; 2]| cells.around(at).any(|cell| nodes.contains(&cell));
        self.repairs.retain(|repair| repair.kind != RepairKind::Split || is_node(repair.at));
    }
}
