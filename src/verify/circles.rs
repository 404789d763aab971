//! The diametral circles of the edges on curves: nodes that encroach them, and edges that cross.
//!
//! Two segments that cross are the diagonals of a quadrilateral. One of its angles is 90° or more, and that corner lies
//! in the closed diametral circle of the diagonal that faces it. So a test of the nodes in every circle finds every
//! crossing.
//!
//! ```text
//!             v
//!          .´ │ `.        x y and v w cross. The angles of x w y v add up to 360°:
//!        .´   │   `.      one of them, here that at v, is 90° or more.
//!      x ─────┼───── y    So v lies in the closed diametral circle of x y,
//!        `.   │   .´      where it is found, and v w is tested against x y.
//!          `. │ .´
//!             w
//! ```

use super::evidence::{CurvePart, Evidence, place};
use super::tally::Tally;
use super::{Check, Status};
use crate::domain::Domain;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{CircleSide, Orientation, in_diametral, orient};
use crate::geometry::{Point, Rect};
use crate::ids::{Id, VertexId};
use crate::threads;
use std::sync::atomic::{AtomicU32, Ordering};

/// No such node or curve part.
const NONE: u32 = u32::MAX;

/// By curve part: the first node in its open diametral circle, and the first curve part whose edge crosses its edge.
pub struct Circles {
    intruder: Vec<AtomicU32>,
    crossing: Vec<AtomicU32>,
}

impl Circles {
    /// Tests all nodes against all circles, by a hierarchy over their boxes.
    pub fn look(ev: &Evidence, domain: &Domain) -> Self {
        let none = || ev.parts.iter().map(|_| AtomicU32::new(NONE)).collect();
        let circles = Self { intruder: none(), crossing: none() };
        let balls = ball_at_nodes(ev, domain);
        let at_node = PartsAtNodes::new(ev);
        let boxes = BoxHierarchy::new(ev.parts.iter().map(|p| box_of_circle(ev, p)));
        threads::for_each(ev.mesh.nodes.len(), |k| {
            let v = VertexId::from_index(k);
            if ev.within[v] {
                return;
            }
            let at = ev.node(v);
            boxes.meeting(Rect::from_points(at, at), |i| {
                circles.note(ev, &balls, &at_node, i, v);
                true
            });
        });
        circles
    }

    /// Notes whether the node `v` encroaches the curve part `i`, and whether an edge at `v` crosses it. The smallest
    /// ids are kept, so the order of the nodes does not matter.
    fn note(&self, ev: &Evidence, balls: &[(VertexId, f64)], at_node: &PartsAtNodes, i: usize, v: VertexId) {
        let stretch = &ev.parts[i];
        if stretch.nodes.contains(&v) {
            return;
        }
        let [x, y] = stretch.nodes.map(|v| ev.signs[v]);
        let side = in_diametral(x, y, ev.signs[v]);
        if side == CircleSide::Outside {
            return;
        }
        if ev.promise.is_constrained() {
            if side == CircleSide::Inside && orient(x, y, ev.signs[v]) == Orientation::Collinear {
                self.intruder[i].fetch_min(v.0, Ordering::Relaxed);
            }
        } else if side == CircleSide::Inside && !is_on_rim(ev, balls, stretch, v) {
            self.intruder[i].fetch_min(v.0, Ordering::Relaxed);
        }
        for &j in at_node.of(v) {
            let (first, second) = (ends(ev, i), ends(ev, j as usize));
            if part(first, second) && part(second, first) {
                self.crossing[i].fetch_min(j, Ordering::Relaxed);
            }
        }
    }

    /// Reports chords that cross although their curves do not: the triangles beside them overlap.
    pub fn tell_crossings(&self, ev: &Evidence, tally: &mut Tally) {
        if ev.promise.is_constrained() {
            self.tell_nodes_on_chords(ev, tally);
        }
        for (i, other) in self.crossing.iter().enumerate() {
            let other = other.load(Ordering::Relaxed);
            if other != NONE {
                let [first, second] = [i, other as usize].map(|k| ev.tell_edge(ev.parts[k].nodes));
                tally.flaw(|| format!("{first} crosses {second}"));
            }
        }
    }

    /// Reports nodes on a chord: in a constrained mesh only these count as intruders.
    fn tell_nodes_on_chords(&self, ev: &Evidence, tally: &mut Tally) {
        for (part, intruder) in ev.parts.iter().zip(&self.intruder) {
            let intruder = intruder.load(Ordering::Relaxed);
            if intruder != NONE {
                tally.flaw(|| format!("node {intruder} lies on {}", ev.tell_edge(part.nodes)));
            }
        }
    }

    /// No node lies inside the diametral circle of an edge on a curve (Lemma 6). The circle of a spoke lies in its ball
    /// and touches the rim, on which nodes are rounded. So where curves leave a corner close to each other, a neighbour
    /// on the rim does not count. Checked: edges. Worst: the smallest distance of a node from the circle's centre, in
    /// radii, of those that encroach and those across from an edge.
    pub fn empty(&self, ev: &Evidence, domain: &Domain) -> Check {
        let mut tally = Tally::lowest("empty_diametral");
        for (part, intruder) in ev.parts.iter().zip(&self.intruder) {
            tally.count();
            let intruder = intruder.load(Ordering::Relaxed);
            let intruder = (intruder != NONE).then_some(VertexId(intruder));
            for v in apexes(ev, part).chain(intruder) {
                tally.measure(radii_away(ev, part, v), ev.middle(part.nodes));
            }
            if let Some(v) = intruder {
                let name = domain.name(domain.curves()[part.curve].name);
                let (edge, at) = (ev.tell_edge(part.nodes), place(ev.node(v)));
                tally.flaw(|| format!("node {} at {at} lies inside the diametral circle of {edge} of \"{name}\"", v.0));
            }
        }
        tally.finish(Status::Proven)
    }
}

/// The curve parts that end at each node.
struct PartsAtNodes {
    first: Vec<u32>,
    parts: Vec<u32>,
}

impl PartsAtNodes {
    fn new(ev: &Evidence) -> Self {
        let mut first = vec![0u32; ev.mesh.nodes.len() + 1];
        for v in ev.parts.iter().flat_map(|p| p.nodes) {
            first[v.index() + 1] += 1;
        }
        for v in 1..first.len() {
            first[v] += first[v - 1];
        }
        let (mut free, mut parts) = (first.clone(), vec![0; 2 * ev.parts.len()]);
        for (i, part) in ev.parts.iter().enumerate() {
            for v in part.nodes {
                parts[free[v.index()] as usize] = i as u32;
                free[v.index()] += 1;
            }
        }
        Self { first, parts }
    }

    fn of(&self, v: VertexId) -> &[u32] {
        &self.parts[self.first[v.index()] as usize..self.first[v.index() + 1] as usize]
    }
}

fn ends(ev: &Evidence, part: usize) -> [Point; 2] {
    ev.parts[part].nodes.map(|v| ev.signs[v])
}

/// Whether the line through `a b` has `x` and `y` strictly on either side.
fn part([a, b]: [Point; 2], [x, y]: [Point; 2]) -> bool {
    let sides = [orient(a, b, x), orient(a, b, y)];
    sides.contains(&Orientation::Clockwise) && sides.contains(&Orientation::CounterClockwise)
}

fn apexes(ev: &Evidence, part: &CurvePart) -> impl Iterator<Item = VertexId> {
    let edge = part.edge.map(|e| ev.edges.edges()[e]);
    let sides = edge.into_iter().flat_map(|e| [e.left(), e.right()]).flatten();
    sides.map(|s| ev.mesh.triangles[s.triangle][(s.corner + 2) % 3])
}

/// Nodes at corners with a ball, ascending, and the radius.
fn ball_at_nodes(ev: &Evidence, domain: &Domain) -> Vec<(VertexId, f64)> {
    let nodes = ev.nodes_of_points(domain);
    let mut balls: Vec<(VertexId, f64)> =
        ev.mesh.balls.iter().filter_map(|ball| Some((nodes[ball.corner]?, ball.radius))).collect();
    balls.sort_unstable_by_key(|&(v, _)| v);
    balls
}

/// Whether a curve part is a spoke, from a corner to the rim of its ball, and a node lies on that rim too, or outside.
fn is_on_rim(ev: &Evidence, balls: &[(VertexId, f64)], part: &CurvePart, v: VertexId) -> bool {
    let [x, y] = part.nodes;
    [(x, y), (y, x)].into_iter().any(|(corner, end)| {
        let Ok(i) = balls.binary_search_by_key(&corner, |&(v, _)| v) else { return false };
        let (center, inner) = (ev.node(corner), balls[i].1 - ev.rim);
        ev.node(end).distance(center) >= inner
            && ev.node(end).distance(center) <= balls[i].1 + ev.rim
            && ev.node(v).distance(center) >= inner
    })
}

fn radii_away(ev: &Evidence, part: &CurvePart, v: VertexId) -> f64 {
    let [x, y] = part.nodes.map(|v| ev.node(v));
    2.0 * ev.node(v).distance(x.midpoint(y)) / x.distance(y)
}

fn box_of_circle(ev: &Evidence, part: &CurvePart) -> Rect {
    let [x, y] = part.nodes.map(|v| ev.node(v));
    let (center, radius) = (x.midpoint(y), 0.5 * x.distance(y) + ev.rounding);
    Rect::from_center_size(center, (2.0 * radius, 2.0 * radius))
}
