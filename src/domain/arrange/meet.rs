//! Meetings of edges: nodes on edges, crossings of lines, meetings and contacts of curves. Each becomes a cut of an
//! edge or a link of two nodes.

use super::arrangement::{Arrangement, NodeOrigin};
use super::candidates::{SLOW, too_many_cuts};
use super::error::{ArrangeError, Unarranged};
use crate::curve::{Curve, Meeting, MeetingKind, Meetings, Overlap, meetings};
use crate::geometry::Point;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{Orientation, orient};
use crate::ids::{CurveId, PointId};
use crate::watch::Watch;

/// In the middle of a slow contact two curves are within this part of their widest distance. Straight lines at an angle
/// would be within 1/2 of it.
const BENT: f64 = 0.375;

/// Edges that cross within the tolerance of a common end are cut up to `BEYOND` times as far from it, and no farther
/// than `BEYOND_REACH` of the tolerance.
const BEYOND: f64 = 16.0;
const BEYOND_REACH: f64 = 0.9;

/// A place at which an edge will be cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The edge.
    pub edge: CurveId,
    /// The parameter on it.
    pub t: f64,
    /// The place of that parameter.
    pub at: Point,
    /// The node that both parts will end at.
    pub node: PointId,
}

/// What one round finds: cuts, and nodes that become one.
#[derive(Default, Debug)]
pub(super) struct Found {
    /// In the order in which they were found.
    pub cuts: Vec<Cut>,
    /// Pairs of nodes that become one.
    pub links: Vec<[PointId; 2]>,
}

impl Found {
    /// Whether nothing meets.
    pub fn is_empty(&self) -> bool {
        self.cuts.is_empty() && self.links.is_empty()
    }
}

/// A place on an edge.
#[derive(Clone, Copy, Debug)]
enum Site {
    /// Within the tolerance of one of its ends.
    End(PointId),
    /// At a parameter.
    Inside(f64, Point),
}

/// Makes one node of `node` and a place on an edge: by a link of two nodes, or by a cut.
fn join(found: &mut Found, (edge, site): (CurveId, Site), node: PointId) {
    match site {
        Site::End(end) if end != node => found.links.push([end, node]),
        Site::End(_) => {}
        Site::Inside(t, at) => found.cuts.push(Cut { edge, t, at, node }),
    }
}

impl Arrangement<'_> {
    /// Finds every place where fresh edges and nodes meet others.
    ///
    /// # Errors
    ///
    /// Where there are more than `most` cuts, where meetings are too near to tell apart, and where `watch` ends the
    /// run.
    pub fn meet(&mut self, most: usize, watch: &mut Watch) -> Result<Found, Unarranged> {
        let mut found = Found::default();
        let known = self.nodes.len();
        let grown = self.edges.iter().map(|p| p.bounds.inflate(self.tolerances.weld, self.tolerances.weld));
        let boxes = BoxHierarchy::new(grown);
        self.nodes_on_edges(&boxes, &mut found, watch)?;
        let pairs = self.fresh_pairs(&boxes, watch)?;
        let count = pairs.len();
        for (k, (a, b)) in pairs.into_iter().enumerate() {
            self.progress("meeting", count - k).tell(watch)?;
            if found.cuts.len() > most {
                return Err(too_many_cuts(most, self.edges[a].bounds.center()).into());
            }
            if [a, b].iter().all(|&id| self.edges[id].curve.as_line().is_some()) {
                self.cross_lines(a, b, &mut found);
            } else {
                self.meet_curves(a, b, &mut found)?;
            }
        }
        // New nodes stay fresh: they are searched in the next round, when edges end at them.
        self.nodes.iter_mut().take(known).for_each(|n| n.fresh = false);
        self.edges.iter_mut().for_each(|p| p.fresh = false);
        Ok(found)
    }

    /// Nodes that lie on edges without being their ends: T-junctions, collinear overlaps, drawn points on curves.
    ///
    /// ```text
    ///               │               The node `id` lies within the tolerance of `edge` and is no end of it. t is the
    ///               ● id            parameter nearest to it: the edge is cut at t, and both parts will end at `id`.
    ///   ────────────t─────── edge   Where t lies within the tolerance of an end of the edge, that end and `id` are
    ///                               linked instead.
    /// ```
    fn nodes_on_edges(&self, boxes: &BoxHierarchy, found: &mut Found, watch: &mut Watch) -> Result<(), Unarranged> {
        for (id, edge) in self.nodes_near_edges(boxes, watch)? {
            let at = self.nodes[id].at;
            let (t, distance) = self.edges[edge].curve.nearest(at, 0.0, 1.0);
            if distance <= self.tolerances.weld {
                let site = self.site(edge, t, self.edges[edge].curve.point(t));
                join(found, (edge, site), id);
            }
        }
        Ok(())
    }

    /// The proper crossing of two lines without a common end. Wherever lines meet otherwise, an end of one lies on the
    /// other.
    ///
    /// ```text
    ///    q0 ╲   ╱ p1        orient is exact: q0 and q1 lie on different sides of p0 p1, and p0 and p1 on different
    ///        ╲ ╱            sides of q0 q1. The crossing is p0 + t (p1 − p0) = q0 + u (q1 − q0).
    ///        ╱ ╲
    ///    p0 ╱   ╲ q1
    /// ```
    fn cross_lines(&mut self, a: CurveId, b: CurveId, found: &mut Found) {
        let [p, q] = [a, b].map(|id| &self.edges[id]);
        let (p0, p1, q0, q1) = (p.curve.start(), p.curve.end(), q.curve.start(), q.curve.end());
        let sides = [orient(p0, p1, q0), orient(p0, p1, q1), orient(q0, q1, p0), orient(q0, q1, p1)];
        if sides[0] == sides[1] || sides[2] == sides[3] || sides.contains(&Orientation::Collinear) {
            return;
        }
        let (dp, dq, between) = (p1 - p0, q1 - q0, q0 - p0);
        let det = dp.cross(dq);
        // The signs above are exact: the lines do cross. Where the determinant rounds to 0, the middles serve as the
        // crossing.
        let [t, u] = if det == 0.0 { [0.5, 0.5] } else { [between.cross(dq) / det, between.cross(dp) / det] };
        let (t, u) = (t.clamp(0.0, 1.0), u.clamp(0.0, 1.0));
        self.join_edges((a, t), (b, u), p0.lerp(p1, t), found);
    }

    fn meet_curves(&mut self, a: CurveId, b: CurveId, found: &mut Found) -> Result<(), ArrangeError> {
        let weld = self.tolerances.weld;
        let near = self.meetings_of(a, b, weld)?;
        let p = &self.edges[a];
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
            self.join_edges((a, t), (b, u), at, found);
        }
        if before == [found.cuts.len(), found.links.len()] {
            self.untangle([a, b], found)?;
        }
        Ok(())
    }

    /// Whether two edges touch and part so slowly that the sliver between them would take too many triangles. Then they
    /// become one as long as they are within the tolerance. Straight lines at an angle do not: the wedge would only
    /// begin elsewhere.
    ///
    /// ```text
    ///         t[0]              t[1]
    ///   p ─────╮                 ╭─────       Between t[0] and t[1] the curve p lies within the tolerance of q. It
    ///          ╰───╮         ╭───╯            bends away from q: in the middle the distance is at most BENT times the
    ///              ╰─────────╯                widest one, which is at an end of the contact.
    ///   q ─────────────────────────────
    /// ```
    fn part_slowly(&self, ids: [CurveId; 2], meeting: &Meeting) -> bool {
        let Overlap { t, u } = meeting.contact;
        if meeting.kind == MeetingKind::Crossing || t[0] == t[1] || u[0] == u[1] {
            return false;
        }
        let [p, q] = ids.map(|id| &self.edges[id].curve);
        let ends = t.map(|t| p.point(t));
        if ends[0].distance(ends[1]) <= SLOW * self.tolerances.weld {
            return false;
        }
        let within = |t: f64| q.nearest(p.point(t), u[0].min(u[1]), u[0].max(u[1])).1;
        let widest = t.map(within).into_iter().fold(0.0, f64::max);
        within(0.5 * (t[0] + t[1])) <= BENT * widest
    }

    /// Further crossings of two edges with a common end. Within the tolerance of that end they are one contact, but the
    /// curves may cross once more: they are cut there. Where the crossing itself lies within the tolerance of the end,
    /// both edges begin at the crossing instead. This is tested only for edges that meet nowhere else: edges that
    /// overlap are cut and become one first.
    ///
    /// ```text
    ///    p ╲   ╱ q
    ///       ╲ ╱         p and q leave m, and cross once more at x. Where x is farther from m than the tolerance, they
    ///        x          are cut there. Else the stretches from m to x are left out, and the ends of the rest, at x or
    ///       ╱ ╲         somewhat beyond it, are moved to m.
    ///       ╲ ╱
    ///        m
    /// ```
    fn untangle(&mut self, ids: [CurveId; 2], found: &mut Found) -> Result<(), ArrangeError> {
        let [p, q] = ids.map(|id| &self.edges[id]);
        if !p.ends.iter().any(|end| q.ends.contains(end)) {
            return Ok(());
        }
        let rounding = self.tolerances.rounding;
        for meeting in self.meetings_of(ids[0], ids[1], rounding)?.points {
            let ts = [meeting.t, meeting.u];
            // Circles that were drawn to touch overlap by a few roundings ε. They stay that near to each other over a
            // length of about √ε; a cut there would leave an edge beside which no mesh can be made.
            if self.is_contact(ids, ts, 4.0 * rounding) {
                continue;
            }
            let [on_a, on_b] = [0, 1].map(|k| self.site(ids[k], ts[k], self.edges[ids[k]].curve.point(ts[k])));
            match (on_a, on_b) {
                (Site::End(m), Site::End(n)) if m == n => {
                    let ts = self.beyond(ids, ts, m);
                    for (edge, t) in ids.into_iter().zip(ts).filter(|&(_, t)| 0.0 < t && t < 1.0) {
                        let at = self.edges[edge].curve.point(t);
                        found.cuts.push(Cut { edge, t, at, node: m });
                    }
                }
                _ => self.join_edges((ids[0], ts[0]), (ids[1], ts[1]), meeting.at, found),
            }
        }
        Ok(())
    }

    /// The parameters at which two edges that cross near a node will begin: farther from it than the crossing, up to
    /// the tolerance. When the rest of each edge is moved to the node, it turns a little; if it began at the crossing,
    /// the two would cross again, somewhat nearer. Farther away they have parted.
    fn beyond(&self, ids: [CurveId; 2], ts: [f64; 2], node: PointId) -> [f64; 2] {
        let away = |k: usize, t: f64| self.edges[ids[k]].curve.point(t).distance(self.nodes[node].at);
        let reach = BEYOND_REACH * self.tolerances.weld;
        let times = (reach / away(0, ts[0]).max(away(1, ts[1]))).min(BEYOND);
        let farther = [0, 1].map(|k| {
            let end = if self.edges[ids[k]].ends[0] == node { 0.0 } else { 1.0 };
            end + times * (ts[k] - end)
        });
        let is_near = |k: usize| (0.0..=1.0).contains(&farther[k]) && away(k, farther[k]) <= self.tolerances.weld;
        if times > 1.0 && is_near(0) && is_near(1) { farther } else { ts }
    }

    fn meetings_of(&self, a: CurveId, b: CurveId, tolerance: f64) -> Result<Meetings, ArrangeError> {
        let [p, q] = [a, b].map(|id| &self.edges[id]);
        meetings(&p.curve, &q.curve, tolerance).map_err(|budget| {
            let [p, q] = [p, q].map(|edge| self.entity(edge.source));
            let what = format!("{p} and {q} run so near to each other that their meetings cannot be told apart");
            ArrangeError::near(what, budget.at, "remove one of the two, or raise the tolerance so that they become one")
        })
    }

    /// Whether a meeting of two edges is only their contact at a common end: from that end to the meeting they stay
    /// within `slack` of each other.
    fn is_contact(&self, ids: [CurveId; 2], ts: [f64; 2], slack: f64) -> bool {
        let [p, q] = ids.map(|id| &self.edges[id]);
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

    /// Makes one node of a place on one edge and a place on another.
    fn join_edges(&mut self, a: (CurveId, f64), b: (CurveId, f64), at: Point, found: &mut Found) {
        let site =
            |arrangement: &Self, (id, t): (CurveId, f64)| arrangement.site(id, t, arrangement.edges[id].curve.point(t));
        let (on_a, on_b) = (site(self, a), site(self, b));
        match (on_a, on_b) {
            (Site::End(m), _) => join(found, (b.0, on_b), m),
            (_, Site::End(n)) => join(found, (a.0, on_a), n),
            _ => {
                let node = self.add_node(at, NodeOrigin::Meeting(self.edges[a.0].source));
                join(found, (a.0, on_a), node);
                join(found, (b.0, on_b), node);
            }
        }
    }

    /// A place on an edge: one of its ends if that lies within the tolerance, else the parameter.
    fn site(&self, id: CurveId, t: f64, at: Point) -> Site {
        let edge = &self.edges[id];
        let end = edge.ends.into_iter().min_by(|&m, &n| {
            let [m, n] = [m, n].map(|n| self.nodes[n].at.distance(at));
            m.total_cmp(&n)
        });
        match end {
            Some(end) if self.nodes[end].at.distance(at) <= self.tolerances.weld => Site::End(end),
            _ => Site::Inside(t, at),
        }
    }
}
