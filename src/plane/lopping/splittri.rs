//! Rule 4, splittri: which triangles miss a bound, and the circumcenters that remove them.
//!
//! ```text
//!         q
//!       ╱   ╲                                                            ╱ `.
//!     ╱  ·c   ╲               x ────── m ────── y                      ╱ ·c  :
//!   a ───────── b              `.      ·c     .´                     p ──────
//!                                 ` - ~ ~ - ´
//!   c encroaches nothing:     c encroaches x y: c is rejected,     c lies in B(p): the triangle is exempt,
//!   c is inserted             x y is split at m                    until B(p) shrinks
//! ```

use super::{Candidate, Lopping, VertexOrigin, queue};
use crate::geometry::Point;
use crate::geometry::triangle::circumcircle;
use crate::ids::{SubcurveId, TriangleId};
use crate::plane::insert::{self, Location};
use crate::plane::labelling;
use crate::plane::refinement::Flaw;
use crate::plane::triangulation::HalfEdge;
use crate::refine::StopReason;

impl Lopping {
    /// Gives regions to triangles made since the last call, and queues those that miss a bound. Every subcurve must be
    /// an edge.
    pub(super) fn label(&mut self) {
        if !self.labelled {
            self.fresh = labelling::all_triangles(&self.delaunay);
            self.labelled = true;
        }
        self.state.labeller.label(
            &mut self.delaunay,
            &self.state.subcurves,
            self.state.domain.curves(),
            &mut self.fresh,
        );
        for t in std::mem::take(&mut self.fresh) {
            self.assess(t);
        }
    }

    fn corners(&self, t: TriangleId) -> [Point; 3] {
        self.delaunay.topology().corners(t).map(|v| self.delaunay.point(v))
    }

    /// Queues a kept triangle that misses a bound.
    fn assess(&mut self, t: TriangleId) {
        let Some(region) = self.delaunay.topology().region(t) else { return };
        let corners = self.corners(t);
        let candidate = (t, self.delaunay.topology().corners(t));
        match self.state.flaw(region, corners) {
            Some(Flaw::Skinny(sin2)) => self.state.bad.push_skinny(candidate, 1.0 - sin2 / self.state.sin2_min),
            Some(Flaw::Oversized(excess)) => self.state.bad.push_oversized(candidate, excess),
            None => {}
        }
    }

    /// Whether a queued triangle has been removed since.
    pub(super) fn is_stale(&self, candidate: &Candidate) -> bool {
        queue::is_stale(self.delaunay.topology(), candidate)
    }
}

impl Lopping {
    /// Rule 4 at a queued triangle, if it still exists. Nothing is done where it is exempt: with corner arcs, if it
    /// lies wholly in one ball; without, if its circumcenter lies in a ball; and where its circumradius is below
    /// `min_edge`.
    pub(super) fn split_triangle(&mut self, candidate: Candidate) {
        if self.is_stale(&candidate) {
            return;
        }
        let (t, _) = candidate;
        let Some(region) = self.delaunay.topology().region(t) else { return };
        let corners = self.corners(t);
        if self.origins.len() >= self.options.max_vertices {
            self.state.reason = StopReason::VertexBudget;
            return self.state.bad.push_skinny(candidate, 1.0);
        }
        if self.state.bad.is_stuck() {
            self.state.reason = StopReason::NoProgress;
            return self.state.bad.push_skinny(candidate, 1.0);
        }
        if self.options.corner_arcs.is_some() && self.balls.holding_all(corners, self.state.resolution).is_some() {
            return;
        }
        let (center, radius) = circumcircle(corners);
        let too_small = self.state.field.sizing().min_edge.is_some_and(|h| radius < h);
        if too_small && self.state.field.excess(region, corners) <= 1.0 {
            return;
        }
        match self.balls.holding(center) {
            // A ball exempts from the angle, not from size limits: it was capped for those.
            Some(_) if self.options.corner_arcs.is_none() && self.state.field.excess(region, corners) <= 1.0 => {
                self.exempt(candidate, center);
            }
            _ => self.remove_triangle(candidate, center),
        }
    }

    /// Notes a triangle whose circumcenter lies in a ball: it is queued again when the ball shrinks.
    fn exempt(&mut self, candidate: Candidate, center: Point) {
        if let Some((ball, _)) = self.balls.holding(center) {
            self.balls.get_mut(ball).exempt.push(candidate);
        }
    }

    /// Removes a triangle: inserts its circumcenter, or splits the longest subcurve that the circumcenter encroaches.
    fn remove_triangle(&mut self, candidate: Candidate, center: Point) {
        let (t, corners) = candidate;
        let place = self.delaunay.point(corners[0]);
        if !insert::in_range(center) {
            return self.state.too_near.push(place);
        }
        let location = self.delaunay.locate(center, t);
        let vertex = matches!(location, Location::Vertex(_));
        if !vertex {
            self.delaunay.cavity(center, location, &mut self.state.cavity);
        }
        if vertex || !self.state.cavity.triangles.contains(&t) {
            // By rounding the circumcenter lies outside the circle of its own triangle.
            return self.state.too_near.push(place);
        }
        let subcurves = self.cavity_subcurves();
        if let Some(subcurve) = self.longest_encroached(center, &subcurves) {
            self.state.counters.add("rejected_circumcenters", 1);
            self.split_subcurve(subcurve, None, "vertices_rejected_circumcenter");
            if !self.is_stale(&candidate) {
                self.state.bad.push_skinny(candidate, 0.0);
            }
            return;
        }
        // A subcurve inside the cavity that is not encroached is a spoke, by rounding. A center in a ball whose arcs it
        // does not encroach is there by rounding, too.
        let border = self.sorted_border();
        let hides_spoke = subcurves.iter().any(|(side, _)| border.binary_search(side).is_err());
        let in_ball = self.balls.holding(center).is_some();
        if in_ball && self.options.corner_arcs.is_none() {
            return self.exempt(candidate, center);
        }
        if hides_spoke || in_ball {
            return self.state.too_near.push(place);
        }
        let v = self.delaunay.fill(center, &self.state.cavity);
        self.origins.push(VertexOrigin::Free);
        self.state.counters.add("vertices_circumcenter", 1);
        let star: Vec<TriangleId> = self.delaunay.topology().sides_from(v).map(HalfEdge::triangle).collect();
        for t in star {
            self.assess(t);
        }
    }

    /// The longest subcurve, spokes apart, that a point encroaches.
    fn longest_encroached(&self, at: Point, subcurves: &[(HalfEdge, SubcurveId)]) -> Option<SubcurveId> {
        let length = |subcurve: SubcurveId| self.length_and_place(subcurve).0;
        subcurves
            .iter()
            .map(|&(_, subcurve)| subcurve)
            .filter(|&subcurve| !self.state.subcurves.get(subcurve).is_spoke() && self.encroaches(at, subcurve))
            .max_by(|&a, &b| length(a).total_cmp(&length(b)).then(b.cmp(&a)))
    }
}
