//! Welding: nodes within the tolerance become one, pieces are cut and moved to end at their nodes, repeated pieces become one.

use super::cut::{Cut, Found, Network, Node, Origin, Piece, extent};
use super::{ArrangeError, RepairKind, Unarranged};
use crate::curve::Curve;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, IdVec, PointId};
use crate::watch::Watch;

/// Rounds of meeting and welding. Each round moves what it welds by a tolerance at most, which seldom makes a new meeting; a drawing
/// that needs more rounds is one whose features lie as near to each other as its tolerance.
const ROUNDS: usize = 16;

/// A piece this many tolerances long has no shape of its own: each of its ends may have moved by two.
const SHAPELESS: f64 = 8.0;

impl Network<'_> {
    /// Meets and welds until nothing meets but at common ends.
    pub fn settle(&mut self, watch: &mut Watch) -> Result<(), Unarranged> {
        self.weld(Found::default());
        let mut at = Point::ORIGIN;
        for _ in 0..ROUNDS {
            let found = self.meet(watch)?;
            if found.is_empty() {
                return Ok(());
            }
            at = found.cuts.first().map_or_else(|| self.nodes[found.links[0][0]].at, |cut| cut.at);
            self.weld(found);
        }
        Err(ArrangeError {
            what: format!("curves run so near to each other that {ROUNDS} rounds of welding did not part them"),
            at,
            help: "raise the tolerance above the distance of the features there, or remove one of them".into(),
        }
        .into())
    }

    /// Closes gaps between ends that meet nothing else, up to the gap tolerance; whether there were any.
    pub fn close_gaps(&mut self) -> bool {
        let free = self.free_ends();
        let at: Vec<Point> = free.iter().map(|&n| self.nodes[n].at).collect();
        let boxes = BoxHierarchy::new(at.iter().map(|&p| Rect::from_points(p, p)));
        let nearest = |i: usize| {
            let away = |j: usize, _| if i == j { f64::INFINITY } else { at[i].distance(at[j]) };
            // The bound itself still counts: a gap as wide as the tolerance is closed.
            boxes.nearest(at[i], self.tolerances.gap.next_up(), away)
        };
        let partners: Vec<_> = (0..free.len()).map(nearest).collect();
        let mutual = |i: usize| partners[i].filter(|&(j, _)| i < j && partners[j].is_some_and(|(k, _)| k == i));
        let gaps: Vec<_> = (0..free.len()).filter_map(|i| mutual(i).map(|(j, d)| (free[i], free[j], d))).collect();
        for &(kept, moved, distance) in &gaps {
            let [a, b] = [kept, moved].map(|n| self.nodes[n].origin.text(self.drawing));
            let what = format!("a gap between the ends of {a} and {b} was closed");
            let at = self.nodes[kept].at;
            self.repair(RepairKind::GapClosed, at, distance, what);
            self.nodes[moved].at = at;
            self.nodes[moved].origin = self.nodes[kept].origin;
        }
        !gaps.is_empty()
    }

    /// Nodes at which a single piece ends, ascending.
    pub fn free_ends(&self) -> Vec<PointId> {
        let mut degree: IdVec<PointId, usize> = vec![0; self.nodes.len()].into();
        self.pieces.iter().flat_map(|p| p.ends).for_each(|end| degree[end] += 1);
        degree.enumerate().filter(|&(_, &d)| d == 1).map(|(id, _)| id).collect()
    }

    /// One round: clusters the nodes, cuts the pieces, moves their ends to the clusters, and drops what is repeated or of no length.
    fn weld(&mut self, found: Found) {
        let cuts = self.cuts_by_piece(found.cuts);
        let clusters = self.clusters(&found.links, &cuts);
        self.replace_nodes(&clusters);
        self.rebuild(&clusters, cuts);
        self.merge_repeated();
    }

    /// Cuts sorted along each piece; ascending by piece.
    fn cuts_by_piece(&self, mut cuts: Vec<Cut>) -> Vec<Cut> {
        cuts.sort_by(|a, b| a.piece.cmp(&b.piece).then(a.t.total_cmp(&b.t)).then(a.node.cmp(&b.node)));
        cuts
    }

    /// The node that stands for each node.
    fn clusters(&self, links: &[[PointId; 2]], cuts: &[Cut]) -> IdVec<PointId, PointId> {
        let mut forest = Forest::new(self.nodes.len());
        links.iter().for_each(|&[a, b]| forest.join(a, b));
        for pair in cuts.windows(2) {
            // Cuts next to each other on one piece and in space are one, lest a piece falls between them.
            if pair[0].piece == pair[1].piece && pair[0].at.distance(pair[1].at) <= self.tolerances.weld {
                forest.join(pair[0].node, pair[1].node);
            }
        }
        let order = self.by_rank();
        self.join_near(&order, &mut forest);
        // The first by rank in each cluster stands for it.
        let mut standing: IdVec<PointId, Option<PointId>> = vec![None; self.nodes.len()].into();
        for &id in &order {
            standing[forest.root(id)].get_or_insert(id);
        }
        self.nodes.ids().map(|id| standing[forest.root(id)].unwrap_or(id)).collect()
    }

    /// Drawn nodes first, then computed ones, each in order.
    fn by_rank(&self) -> Vec<PointId> {
        let mut order: Vec<PointId> = self.nodes.ids().collect();
        order.sort_by_key(|&id| (self.nodes[id].origin.is_computed(), id));
        order
    }

    /// Joins every node to the nearest leader within the tolerance; a node that finds none becomes a leader. So no cluster is wider
    /// than two tolerances, however close its neighbours stand.
    fn join_near(&self, order: &[PointId], forest: &mut Forest) {
        let weld = self.tolerances.weld;
        let boxes = BoxHierarchy::new(self.nodes.iter().map(|n| Rect::from_points(n.at, n.at)));
        let mut leads: IdVec<PointId, bool> = vec![false; self.nodes.len()].into();
        for &id in order {
            let at = self.nodes[id].at;
            let mut nearest: Option<(f64, PointId)> = None;
            boxes.meeting(Rect::from_points(at, at).inflate(weld, weld), |i| {
                let other = PointId::from_index(i);
                let candidate = (at.distance(self.nodes[other].at), other);
                if leads[other] && candidate.0 <= weld && nearest.is_none_or(|n| candidate < n) {
                    nearest = Some(candidate);
                }
                true
            });
            match nearest {
                Some((_, leader)) => forest.join(id, leader),
                None => leads[id] = true,
            }
        }
    }

    /// Itemises drawn ends that move.
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

    /// Cuts the pieces and moves their ends; renumbers the nodes that are left.
    fn rebuild(&mut self, clusters: &IdVec<PointId, PointId>, cuts: Vec<Cut>) {
        let pieces = std::mem::take(&mut self.pieces);
        let mut rest = cuts.as_slice();
        for (id, mut piece) in pieces.enumerate().map(|(id, p)| (id, p.clone())) {
            let mine = rest.iter().take_while(|cut| cut.piece == id).count();
            let (cuts, others) = rest.split_at(mine);
            rest = others;
            piece.ends = piece.ends.map(|end| clusters[end]);
            self.cut_piece(piece, cuts, clusters);
        }
        self.renumber();
    }

    /// The parts of a piece between its cuts.
    fn cut_piece(&mut self, piece: Piece, cuts: &[Cut], clusters: &IdVec<PointId, PointId>) {
        let inner: Vec<(Cut, PointId)> = cuts.iter().map(|cut| (*cut, clusters[cut.node])).collect();
        if inner.is_empty() {
            return self.place_part(piece);
        }
        self.itemise_splits(&piece, &inner);
        let (mut t0, mut from) = (0.0, piece.ends[0]);
        for (t1, to) in inner.iter().map(|(cut, node)| (cut.t, *node)).chain([(1.0, piece.ends[1])]) {
            if t0 < t1 {
                let mut part = Piece::new(piece.curve.part(t0, t1), [from, to], piece.source, false);
                part.merged.clone_from(&piece.merged);
                self.place_part(part);
            }
            (t0, from) = (t1, to);
        }
    }

    fn itemise_splits(&mut self, piece: &Piece, inner: &[(Cut, PointId)]) {
        let mut last = piece.ends[0];
        for &(cut, node) in inner {
            if node != last && node != piece.ends[1] {
                let kept = self.nodes[node];
                let what = match kept.origin {
                    Origin::Point(_) => {
                        format!("{} was split at {}", self.entity(piece.source), kept.origin.text(self.drawing))
                    }
                    _ => format!("{} was split where it meets another curve", self.entity(piece.source)),
                };
                self.repair(RepairKind::Split, kept.at, cut.at.distance(kept.at), what);
            }
            last = node;
        }
    }

    /// Moves the ends of a part to its nodes; drops it where nothing is left, and halves it first where that would bend it out of shape.
    fn place_part(&mut self, part: Piece) {
        let weld = self.tolerances.weld;
        let [from, to] = part.ends.map(|end| self.nodes[end].at);
        let size = extent(part.bounds);
        if part.ends[0] == part.ends[1] && size <= SHAPELESS / 2.0 * weld {
            if part.whole {
                let what = format!("{} has no length and was dropped", self.entity(part.source));
                self.repair(RepairKind::ZeroLength, from, size, what);
            }
            return;
        }
        let (start, end) = (part.curve.start(), part.curve.end());
        if start == from && end == to && from != to {
            self.pieces.push(part);
            return;
        }
        let chord = start.distance(end);
        let moved = start.distance(from).max(end.distance(to));
        // A similarity that moves the ends of a chord by `moved` moves what lies off it by `moved · size / chord`.
        let bends = 4.0 * chord < size && moved * size > weld * chord;
        if part.ends[0] == part.ends[1] || bends {
            let middle = self.add_node(part.curve.point(0.5), Origin::Meeting(part.source));
            for (t0, t1, ends) in [(0.0, 0.5, [part.ends[0], middle]), (0.5, 1.0, [middle, part.ends[1]])] {
                let mut half = Piece::new(part.curve.part(t0, t1), ends, part.source, false);
                half.merged.clone_from(&part.merged);
                self.move_ends(half);
            }
        } else {
            self.move_ends(part);
        }
    }

    fn move_ends(&mut self, mut part: Piece) {
        let [from, to] = part.ends.map(|end| self.nodes[end].at);
        let tiny = extent(part.bounds) <= SHAPELESS * self.tolerances.weld;
        part.curve = match Curve::line(from, to) {
            Ok(chord) if tiny => chord,
            _ => part.curve.with_ends(from, to),
        };
        part.bounds = part.curve.bounds();
        part.fresh = true;
        self.pieces.push(part);
    }

    /// Drops nodes that nothing ends at; the order stays.
    fn renumber(&mut self) {
        let mut used: IdVec<PointId, bool> = vec![false; self.nodes.len()].into();
        let ends = self.pieces.iter().flat_map(|p| p.ends);
        let drawn = self.drawn_ends.iter().flatten().flatten().copied().chain(self.drawn_points.iter().copied());
        ends.chain(drawn).for_each(|id| used[id] = true);
        let mut nodes: IdVec<PointId, Node> = IdVec::new();
        let renamed: IdVec<PointId, PointId> =
            (self.nodes.enumerate()).map(|(id, &node)| if used[id] { nodes.push(node) } else { id }).collect();
        self.nodes = nodes;
        self.pieces.iter_mut().flat_map(|p| &mut p.ends).for_each(|end| *end = renamed[*end]);
        self.drawn_ends.iter_mut().flatten().flatten().for_each(|end| *end = renamed[*end]);
        self.drawn_points.iter_mut().for_each(|node| *node = renamed[*node]);
    }

    /// Pieces between the same nodes that coincide become one, the first; it remembers which drawn curves ran along it.
    fn merge_repeated(&mut self) {
        let mut order: Vec<([PointId; 2], CurveId)> = Vec::with_capacity(self.pieces.len());
        order.extend(self.pieces.enumerate().map(|(id, p)| ([p.ends[0].min(p.ends[1]), p.ends[0].max(p.ends[1])], id)));
        order.sort_unstable();
        let mut dropped: IdVec<CurveId, bool> = vec![false; self.pieces.len()].into();
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            for (i, &(_, first)) in group.iter().enumerate() {
                for &(_, second) in &group[i + 1..] {
                    if !dropped[first] && !dropped[second] && self.coincide(first, second) {
                        dropped[second] = true;
                        self.absorb(first, second);
                    }
                }
            }
        }
        let pieces = std::mem::take(&mut self.pieces);
        self.pieces = pieces.enumerate().filter(|&(id, _)| !dropped[id]).map(|(_, p)| p.clone()).collect();
    }

    /// Whether two pieces between the same nodes are the same up to the tolerance. They do not cross in between, or will be split
    /// there, so a few samples tell.
    fn coincide(&self, a: CurveId, b: CurveId) -> bool {
        let [p, q] = [a, b].map(|id| &self.pieces[id].curve);
        if matches!((p, q), (Curve::Line(_), Curve::Line(_))) {
            return true;
        }
        // Each of the two was moved by up to one tolerance at either end.
        let slack = 4.0 * self.tolerances.weld;
        let on = |p: &Curve, q: &Curve| (1..8).all(|k| q.nearest(p.point(k as f64 / 8.0), 0.0, 1.0).1 <= slack);
        on(p, q) && on(q, p)
    }

    fn absorb(&mut self, kept: CurveId, dropped: CurveId) {
        let gone = self.pieces[dropped].clone();
        let against = gone.ends[0] != self.pieces[kept].ends[0];
        let (first, second) = (self.entity(self.pieces[kept].source), self.entity(gone.source));
        let (kind, what) = match gone.whole && self.pieces[kept].whole {
            true => (RepairKind::Duplicate, format!("{second} repeats {first} and was dropped")),
            false => (RepairKind::Overlap, format!("{second} overlaps {first}; the common stretch became one")),
        };
        self.repair(kind, gone.curve.point(0.5), 0.0, what);
        let piece = &mut self.pieces[kept];
        piece.merged.push((gone.source, against));
        piece.merged.extend(gone.merged.iter().map(|&(source, reversed)| (source, reversed != against)));
    }
}

/// Sets of nodes, joined.
struct Forest {
    parent: IdVec<PointId, PointId>,
}

impl Forest {
    fn new(n: usize) -> Self {
        Self { parent: (0..n).map(PointId::from_index).collect() }
    }

    fn root(&mut self, mut id: PointId) -> PointId {
        while self.parent[id] != id {
            self.parent[id] = self.parent[self.parent[id]];
            id = self.parent[id];
        }
        id
    }

    fn join(&mut self, a: PointId, b: PointId) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high] = low;
    }
}
