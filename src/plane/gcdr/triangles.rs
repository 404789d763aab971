//! Points of type A: which triangles miss a bound, which of them a corner exempts, and how the others are removed.
//!
//! ```text
//!           b                        b     x                           ╱
//!        .´ │                     .´ │     ┃                         a
//!     .´  t │                  .´  t │     ┃ s                     ╱ │`.
//!   d    ·┄┄┼┄┄┄┄ p          d    ·┄┄┼┄┄┄┄┄╋┄┄┄ p                ╱   │  `.
//!     `.    │                  `.    │     ┃                   q     │ t  c
//!        `. │                     `. │     ┃                     ╲   │  .´
//!           a                        a     y                       ╲ │.´
//!                                                                    b ╲
//!   p is visible from t:     s occludes p:                 a b, the shortest edge of t, lies across
//!   p is inserted            p is rejected, s is split     the sharp corner q, |qa| = |qb|: t is exempt
//! ```

use super::parameters::radius_edge_of;
use super::steiner::{Disks, Order, Skinny};
use super::{Candidate, Gcdr, VertexSource, queue};
use crate::geometry::triangle::{circumcircle, sin2_smallest};
use crate::geometry::{Point, scaled};
use crate::ids::{CurveId, RegionId, SubcurveId, TriangleId, VertexId};
use crate::mesh::InsertionKind;
use crate::plane::constrained::Look;
use crate::plane::insert::{self, Location};
use crate::plane::queue::DETAIL_RAD;
use crate::plane::refinement::Flaw;
use crate::plane::triangulation::{GHOST, HalfEdge};
use crate::refine::{Patience, StopReason};

/// The badness of an octave of length: 2^-40 has badness 1.
const OCTAVE: f64 = 1.0 / 40.0;

/// The patience for a strategy's order of triangles.
pub(super) fn patience(order: Order, angle_min_rad: f64) -> Patience {
    match order {
        Order::SmallestAngle => queue::by_angle(1.0 - libm::sin(DETAIL_RAD) / libm::sin(angle_min_rad)),
        Order::ShortestEdge | Order::SmallestCircle => queue::by_length(OCTAVE),
    }
}

impl Gcdr<'_> {
    /// The coordinates of the corners of a triangle.
    pub(super) fn corners(&self, t: TriangleId) -> [Point; 3] {
        self.mesh.topology().corners(t).map(|v| self.mesh.point(v))
    }

    /// Assesses the triangles made since the last call. `label`: gives them regions first, since a chord has changed.
    pub(super) fn settle(&mut self, label: bool) {
        let mut touched = std::mem::take(&mut self.touched);
        self.mesh.take_touched(&mut touched);
        if label {
            let kernel = self.mesh.kernel_mut();
            self.state.labeller.label(kernel, &self.state.subcurves, self.state.domain.curves(), &mut touched);
        } else {
            touched.sort_unstable();
            touched.dedup();
            touched.retain(|&t| self.mesh.topology().is_alive(t));
        }
        touched.drain(..).for_each(|t| self.assess(t));
        self.touched = touched;
    }

    /// Queues a kept triangle that misses a bound.
    pub(super) fn assess(&mut self, t: TriangleId) {
        let Some(region) = self.mesh.topology().region(t) else { return };
        let corners = self.corners(t);
        let candidate = (t, self.mesh.topology().corners(t));
        match self.state.flaw(region, corners) {
            Some(Flaw::Skinny(sin2)) => self.push_skinny(candidate, corners, sin2),
            Some(Flaw::Oversized(excess)) => self.state.bad.push_oversized(candidate, excess),
            None => {}
        }
    }

    fn push_skinny(&mut self, candidate: Candidate, corners: [Point; 3], sin2: f64) {
        // Lengths in octaves below the unit of the unit frame.
        let octaves = |length: f64| -libm::log2(length) * OCTAVE;
        let badness = match self.strategy.order() {
            _ if self.unavoidable_split(candidate.0).is_some() => 1.0,
            // By the sine: its square would put mild cases too near to each other.
            Order::SmallestAngle => 1.0 - (sin2 / self.state.sin2_min).sqrt(),
            Order::ShortestEdge => octaves((0..3).map(|i| edge2(corners, i)).fold(f64::INFINITY, f64::min).sqrt()),
            Order::SmallestCircle => octaves(circumcircle(corners).1),
        };
        self.state.bad.push_skinny(candidate, badness);
    }

    fn is_stale(&self, candidate: &Candidate) -> bool {
        queue::is_stale(self.mesh.topology(), candidate)
    }

    /// Refines a queued triangle, if it still exists and is not exempt: chooses a point and inserts it, or splits a
    /// segment.
    pub(super) fn split_triangle(&mut self, candidate: Candidate) {
        if self.is_stale(&candidate) {
            return;
        }
        let (t, vertices) = candidate;
        let Some(region) = self.mesh.topology().region(t) else { return };
        let corners = self.corners(t);
        let oversized = self.state.field.excess(region, corners) > 1.0;
        let skinny = sin2_smallest(corners) < self.state.sin2_min;
        let (center, radius) = circumcircle(corners);
        let too_small = self.state.field.sizing().min_edge.is_some_and(|h| radius < h);
        if !oversized && (too_small || skinny && self.is_exempt(vertices)) {
            return;
        }
        if self.is_spent() {
            self.state.reason = StopReason::VertexBudget;
            return self.state.bad.push_skinny(candidate, 1.0);
        }
        if self.state.bad.is_stuck() {
            self.state.reason = StopReason::NoProgress;
            return self.state.bad.push_skinny(candidate, 1.0);
        }
        let parent = skinny.then(|| self.latest_of_shortest(vertices));
        if skinny && let Some(subcurve) = self.unavoidable_split(t) {
            return self.encroach(candidate, subcurve, parent);
        }
        let p = self.choose_in_disk(t, region, (center, radius), skinny);
        self.remove_triangle(candidate, p, parent);
    }

    /// The segment of a triangle that must be split in any case: it subtends so wide an angle at a vertex that is never
    /// deleted that the triangle on it stays skinny. An early split avoids free vertices that would be deleted later.
    /// Its point is of type C, for which the proof needs no rejected point.
    fn unavoidable_split(&self, t: TriangleId) -> Option<SubcurveId> {
        let topology = self.mesh.topology();
        let widest = 1.0 - 2.0 * self.state.sin2_min;
        let stays = |s: &HalfEdge| self.origins[topology.apex(*s)] != VertexSource::Free;
        let is_wide = |s: &HalfEdge| {
            let [u, v] = [topology.origin(*s), topology.target(*s)]
                .map(|end| self.mesh.point(end) - self.mesh.point(topology.apex(*s)));
            -u.dot(v) > widest * u.hypot() * v.hypot()
        };
        let sides = [0, 1, 2].map(|i| t.side_of(i)).into_iter();
        let seen = sides.filter_map(|s| topology.subcurve(s).map(|subcurve| (s, subcurve)));
        seen.filter(|(s, _)| stays(s) && is_wide(s)).map(|(_, subcurve)| subcurve).next()
    }

    /// The vertices of a triangle, the ends of its shortest edge first.
    fn shortest_edge_first(&self, [a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
        let length = |e: &[VertexId; 3]| self.mesh.point(e[0]).distance_squared(self.mesh.point(e[1]));
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        turns.into_iter().min_by(|e, f| length(e).total_cmp(&length(f))).expect("three edges")
    }

    /// The later one of the ends of the shortest edge: Rules 2 and 3 of Definition 2.5. Ids ascend in the order of
    /// insertion.
    fn latest_of_shortest(&self, vertices: [VertexId; 3]) -> VertexId {
        let [a, b, _] = self.shortest_edge_first(vertices);
        a.max(b)
    }

    /// Whether the shortest edge of a triangle lies across a sharp corner, with its ends equally far from it: its small
    /// angle is that of the input.
    fn is_exempt(&self, vertices: [VertexId; 3]) -> bool {
        let shortest = self.shortest_edge_first(vertices);
        let [u, v] = [shortest[0], shortest[1]].map(|v| self.origins[v]);
        if u == v || [u, v].contains(&VertexSource::Free) {
            return false;
        }
        let [a, b, c] = shortest.map(|v| self.curves_at(v));
        self.state.domain.corner_between([&a, &b, &c], [0, 1].map(|i| self.mesh.point(shortest[i]))).is_some()
    }

    fn curves_at(&self, v: VertexId) -> Vec<CurveId> {
        match self.origins[v] {
            VertexSource::Input(p) => self.state.domain.star(p).iter().map(|i| i.curve).collect(),
            VertexSource::OnCurve(curve) => vec![curve],
            VertexSource::Free => Vec::new(),
        }
    }

    /// The point of F_A, moved into the disk unless the strategy is free.
    fn choose_in_disk(&mut self, t: TriangleId, region: RegionId, circle: (Point, f64), skinny: bool) -> Point {
        let (center, radius) = circle;
        let reach = self.reach(t, radius);
        let has_choice = if self.strategy.is_free() { skinny } else { reach > 0.0 };
        if !has_choice {
            return center;
        }
        let topology = self.mesh.topology();
        let down = |p: Point| scaled(p, 1.0 / self.state.scale);
        let corners = self.corners(t);
        let first = (0..3).min_by(|&i, &j| edge2(corners, i).total_cmp(&edge2(corners, j))).expect("three sides");
        let sides = [0, 1, 2].map(|i| t.side_of((first + i) % 3));
        let across = sides.map(|s| {
            let apex = topology.apex(topology.twin(s));
            (topology.subcurve(s).is_none() && apex != GHOST).then(|| down(self.mesh.point(apex)))
        });
        let skinny = Skinny {
            corners: sides.map(|s| down(self.mesh.point(topology.origin(s)))),
            across,
            center: down(center),
            radius: radius / self.state.scale,
            reach: reach / self.state.scale,
            size: self.state.field.length_in(region, center) / self.state.scale,
        };
        let p = scaled(self.strategy.in_disk(&skinny), self.state.scale);
        let away = p.distance(center);
        if self.strategy.is_free() && away.is_finite() || away <= reach {
            p
        } else if away.is_finite() {
            center + (p - center) * (reach / away)
        } else {
            center
        }
    }

    /// The radius of a triangle's selection disk. A triangle that is only too large has no edge shorter than r/ρ̄: both
    /// kinds of disks are equal for it.
    fn reach(&self, t: TriangleId, radius: f64) -> f64 {
        let spared = match self.strategy.disks() {
            Disks::Alike => radius,
            Disks::ByShape => {
                let corners = self.corners(t);
                let shortest = (0..3).map(|i| edge2(corners, i)).fold(f64::INFINITY, f64::min).sqrt();
                radius.min(radius_edge_of(self.options.angle_min_rad) * shortest)
            }
        };
        radius - self.options.regions.delta2 * spared
    }

    /// Removes a triangle: inserts `p`, or splits the nearest segment that occludes `p` from the triangle.
    fn remove_triangle(&mut self, candidate: Candidate, p: Point, parent: Option<VertexId>) {
        let (t, vertices) = candidate;
        let place = self.mesh.point(vertices[0]);
        if !insert::in_range(p) {
            return self.state.too_near.push(place);
        }
        let location = match self.mesh.look_from(t, p) {
            Some(Look::Blocked(side)) => return self.reject(candidate, side, parent),
            Some(Look::Seen(Location::HalfEdge(side))) if self.mesh.topology().subcurve(side).is_some() => {
                return self.reject(candidate, side, parent);
            }
            Some(Look::Seen(location)) => location,
            None => return self.state.too_near.push(place),
        };
        self.mesh.cavity(p, location, &mut self.state.cavity);
        if !self.state.cavity.triangles.contains(&t) {
            // By rounding the point lies outside the triangle's circle, or on a vertex.
            return self.state.too_near.push(place);
        }
        let v = self.mesh.fill(p, &self.state.cavity);
        self.origins.push(VertexSource::Free);
        self.alive += 1;
        self.free += 1;
        self.state.counters.add("vertices_free", 1);
        if self.options.record {
            self.record(v, InsertionKind::A, parent);
        }
        self.settle(false);
    }

    /// Rejects the chosen point and splits the segment on `side` (Definition 2.1).
    fn reject(&mut self, candidate: Candidate, side: HalfEdge, parent: Option<VertexId>) {
        let Some(subcurve) = self.mesh.topology().subcurve(side) else { return };
        self.state.counters.add("rejected", 1);
        self.encroach(candidate, subcurve, parent);
    }

    /// Splits a segment that a triangle encroaches, and assesses the triangle again if it still exists.
    fn encroach(&mut self, candidate: Candidate, subcurve: SubcurveId, parent: Option<VertexId>) {
        if self.split_segment(subcurve, parent, "vertices_segment") && !self.is_stale(&candidate) {
            self.assess(candidate.0);
        }
    }
}

/// Squared length of side i of a triangle.
fn edge2(corners: [Point; 3], i: usize) -> f64 {
    corners[i].distance_squared(corners[(i + 1) % 3])
}
