//! Free ends, and the gaps between them and to open lines.
//!
//! ```text
//!   ●───── e₁ ─────●───── e₂ ─────┬─────      A free end is a node at which a single edge ends. Its chain leads along
//!                                 │           edges of nodes of degree 2 to the next free end or branch: here e₁, e₂.
//! ```

use super::arrangement::{Arrangement, Edge};
use crate::curve::End;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect, Vec2, extent, scaled};
use crate::ids::{CurveId, Forest, Id, IdVec, PointId};
use std::collections::{BTreeMap, BTreeSet};

/// An end stops short of a line of its own chain only where the way along the chain is more than this many times as
/// long as the gap.
const AROUND: f64 = 4.0;

/// What a free end belongs to.
#[derive(Clone, Copy)]
pub(super) enum Owner {
    Node(PointId),
    /// An entity that was left out because it leaves the plane: its place in the drawing's list, and which of its ends.
    OffPlane(usize, usize),
}

/// Where a single line ends.
pub(super) struct FreeEnd {
    /// Its place.
    pub at: Point,
    /// Unit vector along the line that ends there.
    pub direction: Vec2,
    /// What it is the end of.
    pub owner: Owner,
    /// The length of its chain: the sum of the diagonals of the boxes around its edges.
    pub chain: f64,
    /// The unit of the last decimal with which the file writes it; 0: exact.
    pub last_decimal: f64,
}

/// Two free ends that may have been meant to be one.
#[derive(Clone, Copy)]
pub(super) struct Gap {
    /// Their indices in the list of free ends.
    pub ends: [usize; 2],
    /// Their distance.
    pub width: f64,
}

/// A free end that stops short of the inside of an open line. If it reached the line, the two might bound something.
///
/// ```text
///   ───────────at──────── onto      The line `onto` goes on beyond `at`, the foot of the free end.
///              ·  width
///              │
///              │ end
/// ```
#[derive(Clone, Copy)]
pub(super) struct Short {
    /// Its index in the list of free ends.
    pub end: usize,
    /// The line.
    pub onto: CurveId,
    /// The nearest point of the line.
    pub at: Point,
    /// Its parameter on the line.
    pub t: f64,
    /// Its distance from the end.
    pub width: f64,
}

/// The gap from each end in `among` to the nearest other one, where it is no wider than `bound` of the end. `among`
/// holds indices in `ends`.
pub(super) fn nearest_ends(ends: &[FreeEnd], among: &[usize], bound: impl Fn(usize) -> f64) -> Vec<Gap> {
    let boxes = BoxHierarchy::new(among.iter().map(|&i| Rect::from_points(ends[i].at, ends[i].at)));
    let nearest = |&i: &usize| {
        let away = |k: usize, _| if among[k] == i { f64::INFINITY } else { ends[i].at.distance(ends[among[k]].at) };
        // The bound itself is included: a gap as wide as the tolerance is closed.
        let (k, width) = boxes.nearest(ends[i].at, bound(i).next_up(), away)?;
        Some(Gap { ends: [i, among[k]], width })
    };
    among.iter().filter_map(nearest).collect()
}

/// The edges at each node, for walks along them.
pub(super) struct Joints(pub IdVec<PointId, Vec<CurveId>>);

impl Joints {
    /// The joints of all edges of an arrangement; a closed edge is listed twice at its node.
    pub fn new(arrangement: &Arrangement) -> Self {
        let mut at: IdVec<PointId, Vec<CurveId>> = vec![Vec::new(); arrangement.nodes.len()].into();
        for (id, edge) in arrangement.edges.enumerate() {
            edge.ends.into_iter().for_each(|end| at[end].push(id));
        }
        Self(at)
    }

    /// Whether a single edge ends at the node.
    pub fn is_free(&self, node: PointId) -> bool {
        self.0[node].len() == 1
    }

    /// How many edges end at the node.
    pub fn degree(&self, node: PointId) -> usize {
        self.0[node].len()
    }
}

/// The end of an edge that is not `from`.
pub(super) fn far_end(edge: &Edge, from: PointId) -> PointId {
    if edge.ends[0] == from { edge.ends[1] } else { edge.ends[0] }
}

impl Arrangement<'_> {
    /// The free ends of the arrangement, by ascending node.
    pub fn free_ends(&self) -> Vec<FreeEnd> {
        let joints = Joints::new(self);
        let free = self.nodes.ids().filter(|&node| joints.is_free(node));
        free.map(|node| self.free_end(node, &joints)).collect()
    }

    fn free_end(&self, node: PointId, joints: &Joints) -> FreeEnd {
        let (last, before) = *self.chain(node, joints).last().expect("a free end has an edge");
        let chain = before + extent(self.edges[last].bounds);
        let edge = &self.edges[joints.0[node][0]];
        let end = if edge.ends[0] == node { End::Start } else { End::Finish };
        let direction = edge.curve.direction_at(end);
        let last_decimal = self.drawing.curves[edge.source as usize].last_decimal;
        FreeEnd { at: self.nodes[node].at, direction, owner: Owner::Node(node), chain, last_decimal }
    }

    /// The edges from a free end to the next free end or branch, each with the length of those before it, measured by
    /// the diagonals of their boxes.
    fn chain(&self, node: PointId, joints: &Joints) -> Vec<(CurveId, f64)> {
        let (mut here, mut along, mut before) = (node, joints.0[node][0], 0.0);
        let mut chain = vec![(along, before)];
        loop {
            here = far_end(&self.edges[along], here);
            before += extent(self.edges[along].bounds);
            match joints.0[here][..] {
                [a, b] if a != b => along = if a == along { b } else { a },
                _ => return chain,
            }
            chain.push((along, before));
        }
    }

    /// The ends of entities that were left out because they leave the plane: an outline that they would close is no
    /// open line.
    pub fn off_plane_ends(&self) -> impl Iterator<Item = FreeEnd> {
        self.drawing.off_plane.iter().enumerate().flat_map(|(k, entity)| {
            let chain = entity.ends[0].distance(entity.ends[1]);
            let direction = (entity.ends[1] - entity.ends[0]) / chain;
            [0, 1].map(|end| {
                let owner = Owner::OffPlane(k, end);
                FreeEnd { at: entity.ends[end], direction, owner, chain, last_decimal: 0.0 }
            })
        })
    }

    /// For each end in `among`, the nearest line whose inside is nearer than `bound` of the end. A line of the end's
    /// own chain counts only if it is farther along the chain. Neither the end nor the line may be connected with a
    /// closed outline: lines within a grid that stop short of each other change nothing about what the grid bounds.
    pub fn shorts(&self, ends: &[FreeEnd], among: &[usize], bound: impl Fn(usize) -> f64) -> Vec<Short> {
        let open = self.edges_of_trees();
        let boxes = BoxHierarchy::new(open.iter().map(|&id| self.edges[id].bounds));
        let joints = Joints::new(self);
        let short = |&i: &usize| {
            let Owner::Node(node) = ends[i].owner else { return None };
            open.binary_search(&joints.0[node][0]).ok()?;
            let along: BTreeMap<CurveId, f64> = self.chain(node, &joints).into_iter().collect();
            let p = ends[i].at;
            let foot = |k: usize| self.edges[open[k]].curve.nearest(p, 0.0, 1.0);
            let away = |k: usize, _| {
                let (t, width) = foot(k);
                let is_apart = along.get(&open[k]).is_none_or(|&way| way > AROUND * width);
                if 0.0 < t && t < 1.0 && is_apart { width } else { f64::INFINITY }
            };
            let (k, width) = boxes.nearest(p, bound(i), away)?;
            let (t, _) = foot(k);
            Some(Short { end: i, onto: open[k], at: self.edges[open[k]].curve.point(t), t, width })
        };
        among.iter().filter_map(short).collect()
    }

    /// Edges whose component is a tree, ascending.
    fn edges_of_trees(&self) -> Vec<CurveId> {
        let mut parts = Forest::new(self.nodes.len());
        let mut closed = Vec::new();
        for edge in self.edges.iter() {
            let [a, b] = edge.ends.map(Id::index);
            if parts.root(a) == parts.root(b) {
                closed.push(a);
            }
            parts.join(a, b);
        }
        let closed: BTreeSet<usize> = closed.into_iter().map(|node| parts.root(node)).collect();
        let mut is_tree = |&id: &CurveId| !closed.contains(&parts.root(self.edges[id].ends[0].index()));
        self.edges.ids().filter(|id| is_tree(id)).collect()
    }

    /// The place of an end in the drawing's units, with its entity: for messages.
    pub fn place(&self, end: &FreeEnd) -> String {
        let Point { x, y } = scaled(end.at, self.tolerances.unit);
        format!("({x}, {y}) of {}", self.entity_of(end))
    }

    /// The entity that ends there.
    pub fn entity_of(&self, end: &FreeEnd) -> &str {
        match end.owner {
            Owner::Node(node) => self.nodes[node].origin.text(self.drawing),
            Owner::OffPlane(k, _) => &self.drawing.off_plane[k].entity,
        }
    }
}
