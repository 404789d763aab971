//! Candidates for meetings: pairs of edges, and pairs of a node and an edge. Their boxes meet, and no quick test shows
//! that they are apart.

use super::arrangement::{Arrangement, Edge};
use super::error::{ArrangeError, Unarranged};
use crate::curve::{Curve, End};
use crate::geometry::boxes::{BoxHierarchy, Labels};
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, IdVec, PointId};
use crate::watch::Watch;
use std::f64::consts::TAU;

/// The largest number of pairs that are stored while meetings are searched for: half a gigabyte.
const PAIRS_MAX: usize = 1 << 26;

/// The largest number of cuts of one round, two a crossing: some gigabytes with the edges that they make.
pub(super) const CUTS_MAX: usize = 1 << 24;

/// Curves separate slowly where they stay within the tolerance of each other over a length of this many tolerances.
/// Curves that part at an angle with a sine of one over this do not.
pub(super) const SLOW: f64 = 16.0;

/// Circles that cross at an angle with a smaller sine are compared in full: they stay within the tolerance of each
/// other over a long stretch.
const SLANT: f64 = 1e-3;

/// Around a node with fewer lines each is compared with each.
const HUB: usize = 16;

/// Nodes at which many lines, their spokes, end. Whether the far end of a spoke lies on another spoke is tested for its
/// neighbours by angle only.
///
/// ```text
///             ╱ other              The far end of the spoke `id` can lie within the tolerance w of another spoke only
///           ╱                      where the angle between the two is small: |other − angle| ≤ 2w / |arm(id)|.
///   hub ●───────────● far(id)
///           ╲
/// ```
struct Hubs {
    spokes: IdVec<PointId, Vec<CurveId>>,
    /// By node: the hubs from which a line runs to it.
    of_node: IdVec<PointId, Labels>,
}

impl Hubs {
    fn new(arrangement: &Arrangement) -> Self {
        let mut spokes: IdVec<PointId, Vec<CurveId>> = vec![Vec::new(); arrangement.nodes.len()].into();
        let lines = || arrangement.edges.enumerate().filter(|(_, edge)| edge.is_line());
        lines().for_each(|(id, line)| line.ends.into_iter().for_each(|end| spokes[end].push(id)));
        let mut hubs = Self { spokes, of_node: vec![Labels::default(); arrangement.nodes.len()].into() };
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
    fn of_edge(&self, edge: &Edge) -> Labels {
        if edge.is_line() { edge.ends.map(|end| self.is_hub(end).then_some(end.0)) } else { Labels::default() }
    }

    /// Calls `ask` with each far end of a spoke and each other spoke of the same hub that it may lie on.
    fn spokes_on_spokes(
        &self,
        arrangement: &Arrangement,
        ask: &mut impl FnMut(PointId, CurveId) -> Result<(), Unarranged>,
    ) -> Result<(), Unarranged> {
        for hub in self.spokes.ids().filter(|&hub| self.is_hub(hub)) {
            let far = |id: CurveId| arrangement.edges[id].ends.into_iter().find(|&end| end != hub).unwrap_or(hub);
            let arm = |id: CurveId| arrangement.nodes[far(id)].at - arrangement.nodes[hub].at;
            let mut around: Vec<(f64, CurveId)> =
                self.spokes[hub].iter().map(|&id| (libm::atan2(arm(id).y, arm(id).x), id)).collect();
            around.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let n = around.len();
            for (k, &(angle, id)) in around.iter().enumerate() {
                // Up to a right angle sin θ ≥ θ/2, so θ ≤ 2w/|arm|. 1e-12 is more than the rounding error of an angle.
                let reach = (2.0 * arrangement.tolerances.weld / arm(id).hypot()).min(4.0) + 1e-12;
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

impl Arrangement<'_> {
    /// Pairs of edges that may cross and of which at least one is fresh, in order. `boxes` are those of the edges.
    pub fn fresh_pairs(&self, boxes: &BoxHierarchy, watch: &mut Watch) -> Result<Vec<(CurveId, CurveId)>, Unarranged> {
        let mut pairs = Vec::new();
        let fresh: Vec<CurveId> = self.edges.ids().filter(|&id| self.edges[id].fresh).collect();
        let mut ask = |a: CurveId, b: CurveId| {
            if !self.are_circles_apart(a, b) && !self.part_at_once(a, b) {
                pairs.push((a, b));
            }
            self.keep_on(pairs.len(), self.edges[a].bounds.center(), watch)
        };
        let labels = |i: usize| self.crossing_labels(CurveId::from_index(i));
        if fresh.len() == self.edges.len() {
            boxes.try_pairs(labels, |i, j| ask(CurveId::from_index(i), CurveId::from_index(j)))?;
            pairs.sort_unstable();
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
                if a < b || (b < a && !self.edges[b].fresh) { ask(a.min(b), a.max(b)) } else { Ok(()) }
            },
        )?;
        pairs.sort_unstable();
        Ok(pairs)
    }

    /// Nodes with the edges that they may lie on without being their ends, each pair once, in order.
    pub fn nodes_near_edges(
        &self,
        boxes: &BoxHierarchy,
        watch: &mut Watch,
    ) -> Result<Vec<(PointId, CurveId)>, Unarranged> {
        let hubs = Hubs::new(self);
        let nodes = BoxHierarchy::new(self.nodes.iter().map(|n| Rect::from_points(n.at, n.at)));
        let mut near = Vec::new();
        let mut ask = |id: PointId, i: CurveId| {
            let (node, edge) = (&self.nodes[id], &self.edges[i]);
            if (node.fresh || edge.fresh) && !edge.ends.contains(&id) && !self.is_off_circle(node.at, edge) {
                near.push((id, i));
            }
            self.keep_on(near.len(), node.at, watch)
        };
        nodes.try_pairs_with(
            |i| hubs.of_node[PointId::from_index(i)],
            boxes,
            |i| hubs.of_edge(&self.edges[CurveId::from_index(i)]),
            |i, j| ask(PointId::from_index(i), CurveId::from_index(j)),
        )?;
        hubs.spokes_on_spokes(self, &mut ask)?;
        near.sort_unstable();
        near.dedup();
        Ok(near)
    }

    /// Reports progress every 1024 pairs, and refuses more pairs than can be stored.
    fn keep_on(&self, pairs: usize, at: Point, watch: &mut Watch) -> Result<(), Unarranged> {
        if pairs > PAIRS_MAX {
            return Err(too_many_cuts(CUTS_MAX, at).into());
        }
        if pairs.is_multiple_of(1024) { Ok(self.progress("meeting", pairs).tell(watch)?) } else { Ok(()) }
    }

    /// Whether two edges with a common end part there at an angle and stay apart: then they meet nowhere else.
    fn part_at_once(&self, a: CurveId, b: CurveId) -> bool {
        let [first, second] = [a, b].map(|id| &self.edges[id]);
        let ends = [End::Start, End::Finish];
        let common = ends.iter().find_map(|&i| {
            let j = ends.iter().find(|&&j| first.end(i) == second.end(j))?;
            Some((first.curve.cone_from(i)?, second.curve.cone_from(*j)?))
        });
        common.is_some_and(|(cone, other)| cone.is_apart_from(&other, 1.0 / SLOW))
    }

    /// Whether a place certainly does not lie on an arc, because it lies off the arc's circle.
    fn is_off_circle(&self, at: Point, edge: &Edge) -> bool {
        let Curve::Arc(arc) = &edge.curve else { return false };
        let from = at.distance(arc.center);
        (from - arc.radius).abs() > self.off_circle(from + arc.radius)
    }

    /// The largest distance of a computed point of an arc from its circle, plus a tolerance. `magnitude` is that of the
    /// numbers it is computed from. When ends are moved, the arc is deformed along its length: its points lie off its
    /// circle by two tolerances at most.
    fn off_circle(&self, magnitude: f64) -> f64 {
        8.0 * self.tolerances.weld.max(f64::EPSILON * magnitude)
    }

    /// Whether two arcs do not meet, or only at their one common end, because of how their circles p and q lie. In
    /// nested rings and fans of arcs nearly all pairs of boxes meet, so this test saves most of the work.
    ///
    /// ```text
    ///         at ●              The circles p and q cross at the common end `at`, and once more at `other`, its mirror
    ///   p ·──────┼──────· q     image in the line of their centers. Where one of the arcs does not pass `other`, they
    ///      other ●              meet only at `at`.
    /// ```
    fn are_circles_apart(&self, a: CurveId, b: CurveId) -> bool {
        let [first, second] = [a, b].map(|id| &self.edges[id]);
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
        // The mirror image of `at` in the line of the centers.
        let along = (q.center - p.center) / between;
        let other = p.center + 2.0 * along.dot(at - p.center) * along - (at - p.center);
        let reach = slack / SLANT;
        sine >= SLANT
            && at.distance(other) > 2.0 * reach
            && [first, second].iter().any(|edge| edge.curve.nearest(other, 0.0, 1.0).1 > reach)
    }

    /// Labels by which the box search skips pairs: lines with a common end do not cross.
    fn crossing_labels(&self, id: CurveId) -> Labels {
        match &self.edges[id] {
            line if line.is_line() => line.ends.map(|end| Some(end.0)),
            _ => Labels::default(),
        }
    }
}

/// The error of a drawing whose curves meet more than `most / 2` times.
pub(super) fn too_many_cuts(most: usize, at: Point) -> ArrangeError {
    let what = format!("the curves meet in more than {} places", most / 2);
    let help = match most {
        CUTS_MAX => "such a drawing is noise: leave out the curves that cross most of the others there",
        _ => "bundles of curves lie within the tolerance of each other: lower it, or leave out all but one of each",
    };
    ArrangeError::near(what, at, help)
}
