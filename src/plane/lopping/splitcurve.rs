//! Rule 2, splitcurve: which vertex encroaches a subcurve, and where the subcurve is split.

use super::{Lopping, VertexOrigin};
use crate::curve::Curve;
use crate::geometry::Point;
use crate::geometry::exact::{CircleSide, Orientation, in_circle, in_diametral, orient};
use crate::ids::{SubcurveId, TriangleId, VertexId};
use crate::plane::insert::{self, Location};
use crate::plane::subcurves::{Carrier, Standing, split_parameter};
use crate::plane::triangulation::{GHOST, HalfEdge};
use crate::refine::StopReason;

impl Lopping {
    /// The curve of a carrier, whole.
    pub(super) fn shape(&self, carrier: Carrier) -> &Curve {
        match carrier {
            Carrier::Curve(id) => &self.state.domain.curves()[id].curve,
            Carrier::Arc(ball, i) => &self.balls.get(ball).arcs[i as usize],
        }
    }

    /// The half-edge from the first end of a subcurve to the last; `None` where they are not joined.
    pub(super) fn side_of(&self, subcurve: SubcurveId) -> Option<HalfEdge> {
        // A corner has as many neighbours as it has curves, the other end of a spoke a few: the search starts there.
        let subcurve = self.state.subcurves.get(subcurve);
        let [x, y] = subcurve.ends;
        if subcurve.is_spoke() && matches!(self.origins[x], VertexOrigin::Input(_)) {
            return self.delaunay.topology().side_between(y, x).map(|s| self.delaunay.topology().twin(s));
        }
        self.delaunay.topology().side_between(x, y)
    }

    /// Tests a subcurve: marks its edge where nothing encroaches it, and splits it where it is encroached or too large.
    pub(super) fn look_at_subcurve(&mut self, id: SubcurveId) {
        self.state.subcurves.get_mut(id).queued = false;
        let subcurve = *self.state.subcurves.get(id);
        if subcurve.is_gone() {
            return;
        }
        match self.encroacher(id) {
            Look::Free(side) => {
                self.delaunay.topology_mut().set_subcurve(side, Some(id));
                if self.is_too_large(id) {
                    self.split_subcurve(id, None, "vertices_size");
                }
            }
            Look::Encroached(_) if subcurve.is_spoke() => {
                // The open ball holds no vertex but its corner, so the spoke is an edge but for rounding.
                let at = self.delaunay.point(subcurve.ends[0]);
                self.stop_too_near(at);
            }
            Look::Encroached(z) => {
                let z = self.delaunay.point(z);
                self.split_subcurve(id, Some(z), "vertices_encroached");
            }
        }
    }

    fn is_too_large(&self, id: SubcurveId) -> bool {
        let subcurve = self.state.subcurves.get(id);
        let Carrier::Curve(curve) = subcurve.carrier else { return false };
        let within_budget = self.origins.len() < self.options.max_vertices && self.state.reason == StopReason::Done;
        let [t0, t1] = subcurve.t;
        within_budget
            && !subcurve.is_spoke()
            && self.state.field.edge_too_large(curve, self.shape(subcurve.carrier), t0, t1)
    }

    /// Tests whether a vertex lies in the open diametral circle of a subcurve x y.
    ///
    /// If x y is an edge of D, one of its two apexes lies inside if any vertex does. If it is not, let a b be the first
    /// edge that crosses it. y does not lie inside the circle of `x a b`, so the angles at a and b sum up to at least
    /// 180°, and the larger is at least 90°. Both are 90° only if all four are cocircular; then a b is flipped.
    ///
    /// ```text
    ///        . - ~ - .     z lies in the open diametral          b        x y is no edge: a b crosses it.
    ///      .´    z    `.   circle of x y: it encroaches        ╱ │ ╲      ∠xay + ∠ybx ≥ 180°: a or b lies in
    ///     x ─────────── y  the subcurve.                     ╱   │   ╲    the circle of x y, or all four are
    ///      `.         .´                                   x ┄┄┄┄┼┄┄┄┄ y  cocircular, and a b is flipped.
    ///        ` - ~ - ´                                       ╲   │   ╱
    ///                                                          ╲ │ ╱
    ///                                                            a
    /// ```
    fn encroacher(&mut self, id: SubcurveId) -> Look {
        let subcurve = *self.state.subcurves.get(id);
        let [x, y] = subcurve.ends;
        let (px, py) = (self.delaunay.point(x), self.delaunay.point(y));
        // Each flip gives x one more neighbour on the same circle, so the number of vertices bounds the flips.
        for _ in 0..self.origins.len() {
            let Some(side) = self.side_of(id) else {
                match self.crossing_side(x, py) {
                    Some(crossing) => {
                        if let Some(z) = self.inside_diametral_of(px, py, crossing, subcurve.is_spoke()) {
                            return Look::Encroached(z);
                        }
                        if !self.flip_to_reach(crossing) {
                            return Look::Encroached(self.delaunay.topology().origin(crossing));
                        }
                        continue;
                    }
                    // A vertex lies on the chord itself.
                    None => return Look::Encroached(self.vertex_on_chord(x, py)),
                }
            };
            if subcurve.is_spoke() {
                return Look::Free(side);
            }
            let topology = self.delaunay.topology();
            let apexes = [topology.apex(side), topology.apex(topology.twin(side))];
            let inside =
                |&a: &VertexId| a != GHOST && in_diametral(px, py, self.delaunay.point(a)) == CircleSide::Inside;
            return match apexes.into_iter().find(inside) {
                Some(z) => Look::Encroached(z),
                None => Look::Free(side),
            };
        }
        Look::Encroached(y)
    }

    /// The half-edge a→b opposite x, in the triangle that the segment from x to y enters; `None` where the segment
    /// passes through a neighbour of x.
    fn crossing_side(&self, x: VertexId, y: Point) -> Option<HalfEdge> {
        let topology = self.delaunay.topology();
        let px = self.delaunay.point(x);
        topology.sides_from(x).find_map(|s| {
            let (a, b) = (topology.target(s), topology.apex(s));
            if a == GHOST || b == GHOST {
                return None;
            }
            let right = orient(px, self.delaunay.point(a), y);
            let left = orient(px, self.delaunay.point(b), y);
            (right == Orientation::CounterClockwise && left == Orientation::Clockwise).then(|| s.next())
        })
    }

    /// The neighbour of x in the direction of y: the segment from x to y passes through it.
    fn vertex_on_chord(&self, x: VertexId, y: Point) -> VertexId {
        let topology = self.delaunay.topology();
        let px = self.delaunay.point(x);
        let along = |v: VertexId| {
            let a = self.delaunay.point(v);
            orient(px, a, y) == Orientation::Collinear && (a - px).dot(y - px) > 0.0
        };
        let blocking = topology.sides_from(x).map(|s| topology.target(s)).find(|&v| v != GHOST && along(v));
        blocking.unwrap_or(x)
    }

    /// The end of a crossing half-edge that lies inside the diametral circle of `x y`. A spoke is never encroached; it
    /// may only be the other diagonal of cocircular points.
    fn inside_diametral_of(&self, x: Point, y: Point, crossing: HalfEdge, spoke: bool) -> Option<VertexId> {
        let topology = self.delaunay.topology();
        let inside = |&v: &VertexId| in_diametral(x, y, self.delaunay.point(v)) == CircleSide::Inside;
        [topology.origin(crossing), topology.target(crossing)].into_iter().filter(|_| !spoke).find(inside)
    }

    /// Flips an edge between cocircular triangles: the triangulation stays Delaunay. `false`, and no change, where they
    /// are not cocircular or a subcurve lies on the edge.
    fn flip_to_reach(&mut self, side: HalfEdge) -> bool {
        let topology = self.delaunay.topology();
        let far = topology.apex(topology.twin(side));
        if far == GHOST || topology.subcurve(side).is_some() {
            return false;
        }
        let [a, b, c] = topology.corners(side.triangle()).map(|v| self.delaunay.point(v));
        if in_circle(a, b, c, self.delaunay.point(far)) != CircleSide::On {
            return false;
        }
        let touched = [side.triangle(), topology.twin(side).triangle()];
        self.delaunay.topology_mut().flip(side);
        self.fresh.extend(touched);
        true
    }

    /// splitcurve: splits a subcurve at the point that the midpoint rule gives. `z` is the vertex that encroaches it,
    /// if one does; `why` names the counter.
    pub(super) fn split_subcurve(&mut self, id: SubcurveId, z: Option<Point>, why: &'static str) {
        let subcurve = *self.state.subcurves.get(id);
        let t = split_parameter(self.shape(subcurve.carrier), subcurve.t, z, self.options.rules.midpoint);
        self.split_subcurve_at(id, t, why);
    }

    /// Splits a subcurve at a parameter into two. Returns them in order. `None`, and the run ends, where coordinates
    /// cannot hold the vertex.
    pub(super) fn split_subcurve_at(&mut self, id: SubcurveId, t: f64, why: &'static str) -> Option<[SubcurveId; 2]> {
        let subcurve = *self.state.subcurves.get(id);
        let at = self.shape(subcurve.carrier).point(t);
        let [x, y] = subcurve.ends.map(|v| self.delaunay.point(v));
        let room = at.distance(x).min(at.distance(y));
        if !(subcurve.t[0] < t && t < subcurve.t[1]) || room < self.state.resolution {
            self.stop_too_near(x);
            return None;
        }
        let origin = match subcurve.carrier {
            Carrier::Curve(curve) => VertexOrigin::OnCurve(curve),
            Carrier::Arc(ball, _) => VertexOrigin::OnArc(ball),
        };
        let side = self.side_of(id);
        let near = side.map_or_else(|| self.triangle_at(subcurve.ends[0]), HalfEdge::triangle);
        self.look_at_cavity(at, near, x)?;
        if let Some(side) = side {
            self.delaunay.topology_mut().set_subcurve(side, None);
        }
        self.state.subcurves.retire(id);
        self.disturb(at, Some(id));
        let v = self.act(at, origin, why);
        let standing = Standing::Ordinary;
        let head = self.state.subcurves.add(subcurve.carrier, [subcurve.t[0], t], [subcurve.ends[0], v], standing);
        let tail = self.state.subcurves.add(subcurve.carrier, [t, subcurve.t[1]], [v, subcurve.ends[1]], standing);
        self.state.enqueue(head);
        self.state.enqueue(tail);
        if let Carrier::Arc(ball, _) = subcurve.carrier {
            self.balls.get_mut(ball).arc_subcurves.extend([head, tail]);
        }
        self.watch_balls(at, origin);
        Some([head, tail])
    }

    /// A triangle with this corner.
    pub(super) fn triangle_at(&self, v: VertexId) -> TriangleId {
        let topology = self.delaunay.topology();
        topology.sides_from(v).next().expect("every vertex has a side").triangle()
    }

    /// Looks: finds the cavity of a point. `None`, and the run ends at `place`, where the point is a vertex already or
    /// out of range.
    pub(super) fn look_at_cavity(&mut self, at: Point, near: TriangleId, place: Point) -> Option<()> {
        if !insert::in_range(at) {
            self.stop_too_near(place);
            return None;
        }
        let location = self.delaunay.locate(at, near);
        if matches!(location, Location::Vertex(_)) {
            self.stop_too_near(place);
            return None;
        }
        self.delaunay.cavity(at, location, &mut self.state.cavity);
        Some(())
    }

    /// Queues every subcurve that the point of the cavity encroaches, or that is no edge any more once the cavity is
    /// filled. `split`: the subcurve that the point splits.
    pub(super) fn disturb(&mut self, at: Point, split: Option<SubcurveId>) {
        let border = self.sorted_border();
        for (side, subcurve) in self.cavity_subcurves() {
            let inner = border.binary_search(&side).is_err();
            if inner {
                self.delaunay.topology_mut().set_subcurve(side, None);
            }
            if Some(subcurve) != split && (inner || self.encroaches(at, subcurve)) {
                self.state.enqueue(subcurve);
            }
        }
    }

    /// The cavity's border, sorted for binary search: among points on one circle it has as many edges as there are
    /// points, and as many subcurves.
    pub(super) fn sorted_border(&self) -> Vec<HalfEdge> {
        let mut border = self.state.cavity.border.clone();
        border.sort_unstable();
        border
    }

    /// The subcurves on edges of the cavity's triangles, each once, with a half-edge.
    pub(super) fn cavity_subcurves(&self) -> Vec<(HalfEdge, SubcurveId)> {
        let topology = self.delaunay.topology();
        let mut found: Vec<(SubcurveId, HalfEdge)> = Vec::new();
        for &t in &self.state.cavity.triangles {
            found.extend((0..3).map(|i| t.side_of(i)).filter_map(|s| Some((topology.subcurve(s)?, s))));
        }
        found.sort_unstable();
        found.dedup_by_key(|&mut (subcurve, _)| subcurve);
        found.into_iter().map(|(subcurve, side)| (side, subcurve)).collect()
    }

    /// Whether a point lies in the open diametral circle of the chord of a subcurve.
    pub(super) fn encroaches(&self, at: Point, subcurve: SubcurveId) -> bool {
        let [x, y] = self.state.subcurves.get(subcurve).ends.map(|v| self.delaunay.point(v));
        in_diametral(x, y, at) == CircleSide::Inside
    }

    /// Acts: inserts a point whose cavity has been found, and notes the new triangles. `why` names the counter.
    pub(super) fn act(&mut self, at: Point, origin: VertexOrigin, why: &'static str) -> VertexId {
        let v = self.delaunay.fill(at, &self.state.cavity);
        self.origins.push(origin);
        self.state.counters.add(why, 1);
        let topology = self.delaunay.topology();
        self.fresh.extend(topology.sides_from(v).map(HalfEdge::triangle));
        v
    }

    /// Notes a new vertex that lies in a ball, if it is on a curve that does not end at the ball's corner.
    fn watch_balls(&mut self, at: Point, origin: VertexOrigin) {
        let VertexOrigin::OnCurve(curve) = origin else { return };
        let Some((id, away)) = self.balls.holding(at) else { return };
        let ball = self.balls.get_mut(id);
        if self.state.domain.curves()[curve].ends.contains(&ball.corner) {
            return;
        }
        ball.intruder = ball.intruder.min(away);
        self.intruded.push_back(id);
    }

    /// Ends the run: coordinates cannot separate points at a place.
    pub(super) fn stop_too_near(&mut self, at: Point) {
        self.state.too_near.push(at);
        self.state.reason = StopReason::Arithmetic;
    }
}

/// The result of a test of a subcurve.
enum Look {
    /// It is this edge of D, and nothing encroaches it.
    Free(HalfEdge),
    Encroached(VertexId),
}
