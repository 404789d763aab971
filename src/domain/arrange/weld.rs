//! Welding: nodes within the tolerance become one, edges are cut and moved to end at their nodes, repeated edges become
//! one.

use super::arrangement::{Arrangement, Edge, NodeOrigin};
use super::candidates::CUTS_MAX;
use super::error::{ArrangeError, Unarranged};
use super::meet::{Cut, Found};
use super::repair::{Cells, RepairKind};
use crate::curve::{Curve, End};
use crate::geometry::{Point, Vec2, extent};
use crate::ids::{CurveId, Forest, Id, IdVec, PointId};
use crate::watch::Watch;
use std::collections::BTreeMap;

/// Rounds of meeting and welding. Each round moves what it welds by at most a tolerance, which seldom makes a new
/// meeting. In a drawing that needs more rounds, features lie as near to each other as its tolerance.
const ROUNDS: usize = 48;

/// After the first round edges meet only because they were moved, seldom twice on one edge. If the mean is this many
/// cuts an edge, whole bundles of curves lie within the tolerance of each other, and each round finds more of them.
const CROWDED: usize = 32;

impl Arrangement<'_> {
    /// Meets and welds until edges meet only at common ends.
    ///
    /// **Invariant.** After every round each edge ends at the places of its two nodes, bit for bit. The nodes of all
    /// drawn ends and drawn points are recorded. Every drawn curve that had a size either runs along some edges (as
    /// source or as merged), or its loss is listed at the end. On success the last round found nothing: a node lies
    /// within the tolerance of an edge only where it is its end, and two edges meet only at common ends.
    ///
    /// **Termination.** A round does one of two things to the nodes. It makes one node of two, so there are fewer. Or
    /// it cuts an edge more than a tolerance from its ends; as long as edges do not move, the length of the drawing
    /// bounds the number of such cuts. Edges that move, by up to a tolerance, may have new meetings, so this is no
    /// proof: the rounds have a budget, and when it is spent the result is an error with the place.
    ///
    /// # Errors
    ///
    /// Where the rounds do not suffice, where edges meet too often or too near to tell, and where `watch` ends the run.
    pub fn settle(&mut self, watch: &mut Watch) -> Result<(), Unarranged> {
        self.weld(Found::default());
        let mut at = Point::ORIGIN;
        for round in 0..ROUNDS {
            let most = if round == 0 { CUTS_MAX } else { CUTS_MAX.min(CROWDED * self.edges.len().max(CROWDED)) };
            let found = self.meet(most, watch)?;
            if found.is_empty() {
                return Ok(());
            }
            at = found.cuts.first().map_or_else(|| self.nodes[found.links[0][0]].at, |cut| cut.at);
            self.weld(found);
        }
        let what = format!("curves run so near to each other that {ROUNDS} rounds of welding did not part them");
        let help = "raise the tolerance above the distance of the features there, or remove one of them";
        Err(ArrangeError::near(what, at, help).into())
    }

    /// One round: clusters the nodes, cuts the edges, moves their ends to the clusters, and drops edges that are
    /// repeated or have no length.
    ///
    /// ```text
    ///   p ────── a  b ────── q          p ─────╲ ╱───── q    a and b lie within the tolerance of each other, and so
    ///                             ▶             a            does r. They become one node, the one that was drawn
    ///  r₀ ────────────────── r₁        r₀ ─────╱ ╲───── r₁   first. r is cut there, and the ends of all edges are
    ///                                                        moved to it.
    /// ```
    fn weld(&mut self, found: Found) {
        let cuts = self.cuts_by_edge(found.cuts);
        let clusters = self.clusters(&found.links, &cuts);
        self.replace_nodes(&clusters);
        self.rebuild(&clusters, cuts);
        self.merge_repeated();
    }

    /// Cuts sorted along each edge; ascending by edge.
    fn cuts_by_edge(&self, mut cuts: Vec<Cut>) -> Vec<Cut> {
        cuts.sort_by(|a, b| a.edge.cmp(&b.edge).then(a.t.total_cmp(&b.t)).then(a.node.cmp(&b.node)));
        cuts
    }

    /// By node: the node of its cluster that is kept.
    fn clusters(&self, links: &[[PointId; 2]], cuts: &[Cut]) -> IdVec<PointId, PointId> {
        let mut forest = Forest::new(self.nodes.len());
        links.iter().for_each(|&[a, b]| forest.join(a.index(), b.index()));
        for pair in cuts.windows(2) {
            // Neighbouring cuts on an edge that are also near in the plane become one, so that no tiny edge is left
            // between them.
            if pair[0].edge == pair[1].edge && pair[0].at.distance(pair[1].at) <= self.tolerances.weld {
                forest.join(pair[0].node.index(), pair[1].node.index());
            }
        }
        let order = self.by_rank();
        self.join_near(&order, &mut forest);
        // The first by rank in each cluster is kept.
        let mut standing: Vec<Option<PointId>> = vec![None; self.nodes.len()];
        for &id in &order {
            standing[forest.root(id.index())].get_or_insert(id);
        }
        self.nodes.ids().map(|id| standing[forest.root(id.index())].unwrap_or(id)).collect()
    }

    /// Drawn nodes first, then computed ones, each in order.
    fn by_rank(&self) -> Vec<PointId> {
        let mut order: Vec<PointId> = self.nodes.ids().collect();
        order.sort_by_key(|&id| (self.nodes[id].origin.is_computed(), id));
        order
    }

    /// Joins every node to the nearest leader within the tolerance. A node without such a leader becomes one. So no
    /// cluster is wider than two tolerances, however near its neighbours are.
    ///
    /// ```text
    ///       ╭───────╮ ╭───────╮       Leaders ● are more than `weld` apart, so a square cell as wide as `weld` holds
    ///       │ ∘ ● ∘ │ │   ●  ∘│       at most four. Nodes ∘ join the nearest leader; a chain of near nodes makes
    ///       ╰───────╯ ╰───────╯       several clusters.
    /// ```
    fn join_near(&self, order: &[PointId], forest: &mut Forest) {
        let weld = self.tolerances.weld;
        // The leaders by square cells as wide as the tolerance. A cell holds at most four, however many nodes lie
        // there.
        let mut leaders: BTreeMap<[i64; 2], Vec<PointId>> = BTreeMap::new();
        let cells = Cells::as_wide_as(weld);
        for &id in order {
            let at = self.nodes[id].at;
            let [i, j] = cells.of([at.x, at.y]);
            let near = (i - 1..=i + 1).flat_map(|i| leaders.range([i, j - 1]..=[i, j + 1])).flat_map(|(_, ids)| ids);
            let candidates = near.map(|&other| (at.distance(self.nodes[other].at), other)).filter(|c| c.0 <= weld);
            match candidates.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) {
                Some((_, leader)) => forest.join(id.index(), leader.index()),
                None => leaders.entry([i, j]).or_default().push(id),
            }
        }
    }

    /// Lists drawn ends that move, and replaces the nodes of drawn ends and points by those of their clusters.
    fn replace_nodes(&mut self, clusters: &IdVec<PointId, PointId>) {
        for id in self.nodes.ids() {
            let (node, kept) = (self.nodes[id], self.nodes[clusters[id]]);
            let distance = node.at.distance(kept.at);
            if distance > 0.0 && !node.origin.is_computed() {
                let [a, b] = [kept, node].map(|n| n.origin.text(self.drawing));
                self.repair(RepairKind::Weld, kept.at, distance, format!("ends of {a} and {b} were welded"));
            }
        }
        self.drawn_ends.iter_mut().flatten().flatten().for_each(|end| *end = clusters[*end]);
        self.drawn_points.iter_mut().for_each(|node| *node = clusters[*node]);
    }

    /// Cuts the edges, moves their ends, and renumbers the nodes that are left.
    fn rebuild(&mut self, clusters: &IdVec<PointId, PointId>, cuts: Vec<Cut>) {
        let edges = std::mem::take(&mut self.edges);
        let mut rest = cuts.as_slice();
        for (id, mut edge) in edges.enumerate().map(|(id, p)| (id, p.clone())) {
            let mine = rest.iter().take_while(|cut| cut.edge == id).count();
            let (cuts, others) = rest.split_at(mine);
            rest = others;
            edge.ends = edge.ends.map(|end| clusters[end]);
            self.cut_edge(edge, cuts, clusters);
        }
        self.renumber();
    }

    /// Places the parts of an edge between its cuts.
    fn cut_edge(&mut self, edge: Edge, cuts: &[Cut], clusters: &IdVec<PointId, PointId>) {
        let inner: Vec<(Cut, PointId)> = cuts.iter().map(|cut| (*cut, clusters[cut.node])).collect();
        if inner.is_empty() {
            return self.place_part(edge);
        }
        self.itemise_splits(&edge, &inner);
        let (mut t0, mut from) = (0.0, edge.ends[0]);
        for (t1, to) in inner.iter().map(|(cut, node)| (cut.t, *node)).chain([(1.0, edge.ends[1])]) {
            if t0 < t1 {
                self.place_part(edge.between(t0, t1, [from, to]));
            }
            (t0, from) = (t1, to);
        }
    }

    fn itemise_splits(&mut self, edge: &Edge, inner: &[(Cut, PointId)]) {
        let mut last = edge.ends[0];
        for &(cut, node) in inner {
            if node != last && node != edge.ends[1] {
                let kept = self.nodes[node];
                let what = match kept.origin {
                    NodeOrigin::Point(_) => {
                        format!("{} was split at {}", self.entity(edge.source), kept.origin.text(self.drawing))
                    }
                    _ => format!("{} was split where it meets another curve", self.entity(edge.source)),
                };
                self.repair(RepairKind::Split, kept.at, cut.at.distance(kept.at), what);
            }
            last = node;
        }
    }

    /// Adds a part as an edge, with its ends moved to its nodes. Drops it where nothing is left. Halves it first where
    /// the move would distort it.
    ///
    /// ```text
    ///           ╭────╮                 A part whose chord ab is short beside its size: to move a or b by `moved` turns
    ///           │    │                 and stretches the whole loop, by moved · size / chord. Halved at m, each half
    ///           │    m                 has a long chord, and is hardly distorted.
    ///           a b──╯
    /// ```
    pub fn place_part(&mut self, part: Edge) {
        let weld = self.tolerances.weld;
        let [from, to] = part.ends.map(|end| self.nodes[end].at);
        let size = extent(part.bounds);
        if part.ends[0] == part.ends[1] && size <= weld {
            if part.is_whole() {
                self.itemise_lost(&part, from, size);
            }
            return;
        }
        let (start, end) = (part.curve.start(), part.curve.end());
        if start == from && end == to && from != to {
            self.edges.push(part);
            return;
        }
        let chord = start.distance(end);
        let moved = start.distance(from).max(end.distance(to));
        // A similarity that moves the ends of a chord by `moved` moves points off the chord by up to `moved · size /
        // chord`.
        let bends = 4.0 * chord < size && moved * size > weld * chord;
        if part.ends[0] == part.ends[1] || bends {
            let middle = self.add_node(part.curve.point(0.5), NodeOrigin::Meeting(part.source));
            for (t0, t1, ends) in [(0.0, 0.5, [part.ends[0], middle]), (0.5, 1.0, [middle, part.ends[1]])] {
                self.move_ends(part.between(t0, t1, ends));
            }
        } else {
            self.move_ends(part);
        }
    }

    /// Lists that a whole drawn curve became one point.
    fn itemise_lost(&mut self, part: &Edge, at: Point, size: f64) {
        let closed = part.curve.start().distance(part.curve.end()) < size / 2.0;
        let kind = if closed { RepairKind::Collapsed } else { RepairKind::ZeroLength };
        let what = format!("{} is no longer than the tolerance and was dropped", self.entity(part.source));
        self.repair(kind, at, size, what);
        self.drawn_ends[part.source as usize] = None;
    }

    fn move_ends(&mut self, mut part: Edge) {
        let [from, to] = part.ends.map(|end| self.nodes[end].at);
        // A part that fits within the tolerance becomes its chord. Every other part keeps its shape, however coarse the
        // tolerance.
        let shapeless = extent(part.bounds) <= self.tolerances.weld;
        part.curve = match Curve::line(from, to) {
            Ok(chord) if shapeless => chord,
            _ => part.curve.with_ends(from, to),
        };
        part.bounds = part.curve.bounds();
        part.fresh = true;
        self.edges.push(part);
    }

    /// Makes one edge of those that coincide between the same nodes: the first, which lists the drawn curves of the
    /// others.
    fn merge_repeated(&mut self) {
        let mut order: Vec<([PointId; 2], CurveId)> = Vec::with_capacity(self.edges.len());
        order.extend(self.edges.enumerate().map(|(id, p)| ([p.ends[0].min(p.ends[1]), p.ends[0].max(p.ends[1])], id)));
        order.sort_unstable();
        let mut dropped: IdVec<CurveId, bool> = vec![false; self.edges.len()].into();
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            let mut rest: Vec<CurveId> = group.iter().map(|g| g.1).collect();
            while let Some((&first, others)) = rest.split_first() {
                let mut apart = Vec::new();
                for &second in others {
                    match self.gap_of_coincident(first, second) {
                        Some(gap) => {
                            dropped[second] = true;
                            self.absorb(first, second, gap);
                        }
                        None => apart.push(second),
                    }
                }
                rest = apart;
            }
        }
        let edges = std::mem::take(&mut self.edges);
        self.edges = edges.enumerate().filter(|&(id, _)| !dropped[id]).map(|(_, p)| p.clone()).collect();
    }

    /// The widest gap between two edges with the same ends if they coincide: if neither is farther than the tolerance
    /// from the other, and the face between them is nowhere wider. They do not cross in between, or will be split
    /// there, so a few samples suffice.
    fn gap_of_coincident(&self, a: CurveId, b: CurveId) -> Option<f64> {
        let [p, q] = [a, b].map(|id| &self.edges[id].curve);
        if matches!((p, q), (Curve::Line(_), Curve::Line(_))) {
            return Some(0.0);
        }
        let weld = self.tolerances.weld;
        let mut widest: f64 = 0.0;
        for (from, to) in [(p, q), (q, p)] {
            for k in 1..SAMPLES {
                let gap = gap_across(from, k as f64 / SAMPLES as f64, to);
                widest = widest.max(gap);
                if widest > weld {
                    return None;
                }
            }
        }
        Some(widest)
    }

    fn absorb(&mut self, kept: CurveId, dropped: CurveId, gap: f64) {
        let gone = self.edges[dropped].clone();
        let against = gone.ends[0] != self.edges[kept].ends[0];
        let (first, second) = (self.entity(self.edges[kept].source), self.entity(gone.source));
        let at = gone.curve.point(0.5);
        if gone.source == self.edges[kept].source {
            self.loops.push((gone.source, at, gap));
            self.straighten(kept);
        } else if gone.is_whole() && self.edges[kept].is_whole() {
            self.repair(RepairKind::Duplicate, at, gap, format!("{second} repeats {first} and was dropped"));
        } else {
            let what = format!("{second} overlaps {first}; the common stretch became one");
            self.repair(RepairKind::Overlap, at, gap, what);
        }
        let edge = &mut self.edges[kept];
        edge.merged.push((gone.source, against));
        edge.merged.extend(gone.merged.iter().map(|&(source, reversed)| (source, reversed != against)));
    }

    /// Makes an edge straight that is one side of a collapsed loop, where it was cut beside the loop's tip and folds
    /// back.
    fn straighten(&mut self, id: CurveId) {
        let edge = &mut self.edges[id];
        if !edge.curve.breaks().is_empty()
            && let Ok(chord) = Curve::line(edge.curve.start(), edge.curve.end())
        {
            (edge.bounds, edge.curve, edge.fresh) = (chord.bounds(), chord, true);
        }
    }

    /// Lists drawn curves of which nothing is left although they had a size, and loops of others that became lines.
    pub fn itemise_collapsed(&mut self) {
        let mut left = vec![false; self.drawing.curves.len()];
        for edge in self.edges.iter() {
            left[edge.source as usize] = true;
            edge.merged.iter().for_each(|&(source, _)| left[source as usize] = true);
        }
        for source in (0..left.len()).filter(|&i| !left[i]) {
            let Some([node, _]) = self.drawn_ends[source].take() else { continue };
            let size = extent(self.drawing.curves[source].curve.bounds());
            let what = format!("{} is no wider than the tolerance and became one point", self.entity(source as u32));
            self.repair(RepairKind::Collapsed, self.nodes[node].at, size, what);
        }
        for (source, at, gap) in std::mem::take(&mut self.loops).into_iter().filter(|l| left[l.0 as usize]) {
            let what = format!("a loop of {} no wider than the tolerance became one line", self.entity(source));
            self.repair(RepairKind::Collapsed, at, gap, what);
        }
    }
}

/// Whether two edges coincide is tested at this many even steps of the parameter.
const SAMPLES: usize = 8;

/// The width of the face between two curves, along the normal of the first at `t`. Where that normal misses the second
/// curve, the distance to it. (The distance alone is not enough: around a small disk every point is near the ends, but
/// the opposite side is not.)
///
/// ```text
///     ╭───── from ──at───────╮
///   ──●              │ gap   ●──
///     ╰───────── to ─┴───────╯
/// ```
fn gap_across(from: &Curve, t: f64, to: &Curve) -> f64 {
    let at = from.point(t);
    let tangent = from.tangent(t, End::Start);
    let across = to.line_crossings(at, Vec2::new(-tangent.y, tangent.x), 0.0, 1.0);
    let widths = across.into_iter().map(|u| to.point(u).distance(at));
    widths.reduce(f64::min).unwrap_or_else(|| to.nearest(at, 0.0, 1.0).1)
}
