//! Points of types B and C: segments that are encroached or too large, and where they are split.
//!
//! ```text
//!           . - ~ ~ - .         Type B: no vertex but free ones in the circle is visible from x y.
//!        .´      u      `.      The free ones, here u, are deleted; x y is split in its middle part |s|(1 − δ₁).
//!      x ──┤░░░░░░░░░░░├── y    Type C: a vertex w that is not free is visible. It stays, the free ones are
//!        `.      w      .´      deleted, and x y is split in its middle part |s|(1 − μ).
//!           ` - ~ ~ - ´
//! ```

use super::chords::{Hull, curve_of, shape_of, shell_between};
use super::steiner::Encroached;
use super::{Gcdr, VertexSource};
use crate::curve::End;
use crate::geometry::exact::{CircleSide, in_diametral};
use crate::geometry::{Point, Vec2, scaled};
use crate::ids::{FanId, SubcurveId, TriangleId, VertexId};
use crate::mesh::InsertionKind;
use crate::plane::insert::{self, Location};
use crate::plane::subcurves::{Standing, Subcurve};
use crate::plane::triangulation::HalfEdge;
use crate::refine::StopReason;

/// Vertices in the diametral circle of a subcurve.
#[derive(Default)]
struct Encroachers {
    /// Free vertices from which the subcurve is visible.
    free: Vec<VertexId>,
    /// All vertices that are not free, visible or not.
    others: Vec<VertexId>,
    /// Whether the subcurve is visible from one of `others`: its split point is of type C.
    type_c: bool,
}

impl Gcdr<'_> {
    /// The coordinates of the ends of a subcurve.
    pub(super) fn ends_of(&self, subcurve: &Subcurve) -> [Point; 2] {
        subcurve.ends.map(|v| self.mesh.point(v))
    }

    /// Tests a subcurve from the queue: splits it where it is larger than permitted.
    pub(super) fn look_at_subcurve(&mut self, id: SubcurveId) {
        self.state.subcurves.get_mut(id).queued = false;
        let subcurve = *self.state.subcurves.get(id);
        if subcurve.is_gone() || self.is_spent() {
            return;
        }
        let [t0, t1] = subcurve.t;
        if self.state.field.edge_too_large(curve_of(&subcurve), shape_of(&self.state.domain, &subcurve), t0, t1) {
            self.split_segment(id, None, "vertices_size");
        }
    }

    /// Lines 7–14 of Algorithm 2: deletes the free vertices in the diametral circle and inserts a point of type B or C.
    /// A spoke is split together with its whole fan. `latest` is the parent of a point of type B, and `why` names the
    /// counter. `false` where coordinates cannot hold the point.
    pub(super) fn split_segment(&mut self, id: SubcurveId, latest: Option<VertexId>, why: &'static str) -> bool {
        let subcurve = *self.state.subcurves.get(id);
        if let Standing::OfFan(fan) = subcurve.standing {
            return self.cut_fan(fan, why);
        }
        let Encroachers { free, others, type_c } = self.encroachers(id);
        let t = match shell_between(&self.state.domain, &self.sharp, &subcurve, self.ends_of(&subcurve)) {
            Some((end, radius)) => shape_of(&self.state.domain, &subcurve).leaves_ball(end, radius, 0.0, 1.0),
            None => self.choose(&subcurve, type_c),
        };
        let Some(v) = self.split_at(id, t.unwrap_or(f64::NAN), free, why) else { return false };
        if self.options.record {
            let (kind, parent) =
                if type_c { (InsertionKind::C, self.nearest_seen(v, others)) } else { (InsertionKind::B, latest) };
            self.record(v, kind, parent);
        }
        true
    }

    /// The parameter of the strategy's point: on the curve above the place that the strategy chooses on the chord.
    fn choose(&mut self, subcurve: &Subcurve, type_c: bool) -> Option<f64> {
        let shape = shape_of(&self.state.domain, subcurve);
        let [t0, t1] = subcurve.t;
        let size = if type_c { self.options.regions.mu } else { self.options.regions.delta1 };
        let interval = [0.5 * size, 1.0 - 0.5 * size];
        let [x, y] = self.ends_of(subcurve);
        let ends = [x, y].map(|p| scaled(p, 1.0 / self.state.scale));
        let share = self.strategy.on_segment(&Encroached { ends, interval, type_c });
        let share = if share >= interval[0] { share.min(interval[1]) } else { interval[0] };
        if share == 0.5 {
            return Some(shape.bisector_crossing(t0, t1));
        }
        if shape.is_straight() {
            return Some(t0 + share * (t1 - t0));
        }
        let normal = Vec2::new(x.y - y.y, y.x - x.x);
        let found = shape.line_crossings(x.lerp(y, share), normal, t0, t1);
        Some(found.first().copied().unwrap_or_else(|| shape.bisector_crossing(t0, t1)))
    }

    /// The nearest of some vertices that is visible from `v`: Rule 4 of Definition 2.5.
    fn nearest_seen(&self, v: VertexId, vertices: Vec<VertexId>) -> Option<VertexId> {
        let away = |w: &VertexId| self.mesh.point(*w).distance_squared(self.mesh.point(v));
        let seen = vertices.into_iter().filter(|&w| self.mesh.see_each_other(v, w));
        seen.min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    fn encroachers(&mut self, id: SubcurveId) -> Encroachers {
        let mut found = Encroachers::default();
        let Some(side) = self.side_of(id) else { return found };
        for side in [side, self.mesh.topology().twin(side)] {
            // If the apex lies outside the circle, so do all vertices on its side from which the segment is visible.
            if !self.mesh.has_apex_in_half_circle(side) {
                continue;
            }
            found.type_c = found.type_c || !self.is_free(self.mesh.topology().apex(side));
            if self.free == 0 && !self.options.record {
                continue;
            }
            let inside = self.mesh.in_half_circle(side);
            for v in inside {
                if !self.is_free(v) {
                    found.type_c = found.type_c || self.mesh.sees(v, side);
                    found.others.push(v);
                } else if self.mesh.sees(v, side) {
                    found.free.push(v);
                }
            }
        }
        found
    }

    fn is_free(&self, v: VertexId) -> bool {
        self.origins[v] == VertexSource::Free
    }

    /// Deletes free vertices; some may be listed twice.
    fn delete(&mut self, mut vertices: Vec<VertexId>) {
        vertices.sort_unstable();
        vertices.dedup();
        self.alive -= vertices.len();
        self.free -= vertices.len();
        self.state.counters.add("vertices_deleted", vertices.len() as u64);
        vertices.into_iter().for_each(|v| self.mesh.remove(v));
    }

    fn side_of(&self, id: SubcurveId) -> Option<HalfEdge> {
        let [x, y] = self.state.subcurves.get(id).ends;
        // A corner has as many neighbours as it has curves, the other end a few: the search starts there.
        let topology = self.mesh.topology();
        match self.origins[x] {
            VertexSource::Input(_) => topology.side_between(y, x).map(|s| topology.twin(s)),
            _ => topology.side_between(x, y),
        }
    }

    /// Cuts all curves of a fan at half its radius. Where their chords between there and the old radius might cross,
    /// they are cut at more distances in between.
    ///
    /// ```text
    ///                  x      |px| = |py| is the old radius, |px₁| = |py₁| the new one, half of it.
    ///              x₂-´ :     From there to the old radius the spokes are cut in 1, 2, 4, … equal steps,
    ///          x₁-´ :    :    here 2: |px₂| = |py₂|. The number is the least for which the hulls of
    ///      .-´   :   :   :    x₁x₂ and x₂x are apart from those of y₁y₂ and y₂y.
    ///   p────────y₁──y₂──y
    /// ```
    fn cut_fan(&mut self, id: FanId, why: &'static str) -> bool {
        let fan = &self.fans[id];
        let (corner, radius) = (VertexId(fan.corner.0), 0.5 * fan.radius);
        let spokes = fan.spokes.clone();
        let cuts = self.shells(corner, radius, &spokes);
        let free = spokes.iter().flat_map(|&spoke| self.encroachers(spoke).free).collect();
        let Some(parts) = self.split_together(&cuts, free, why) else { return false };
        self.fans[id].radius = radius;
        self.fans[id].spokes.clear();
        for parts in parts {
            let ends_there = |&&part: &&SubcurveId| self.state.subcurves.get(part).ends.contains(&corner);
            let inner = *parts.iter().find(ends_there).expect("the first or the last part");
            self.state.subcurves.get_mut(inner).standing = Standing::OfFan(id);
            self.fans[id].spokes.push(inner);
        }
        true
    }

    /// The ascending parameters at which each spoke is cut, from `radius` outward: so many shells that the hulls of
    /// neighbours are apart.
    fn shells(&self, corner: VertexId, radius: f64, spokes: &[SubcurveId]) -> Vec<(SubcurveId, Vec<f64>)> {
        const SHELLS_MOST: u32 = 64;
        let center = self.mesh.point(corner);
        let mut around = spokes.to_vec();
        let away = |id: &SubcurveId| {
            let subcurve = self.state.subcurves.get(*id);
            self.mesh.point(subcurve.ends[usize::from(subcurve.ends[0] == corner)]) - center
        };
        around.sort_by(|a, b| away(a).atan2().total_cmp(&away(b).atan2()).then(a.cmp(b)));
        let mut shells = 1;
        loop {
            let radii: Vec<f64> = (0..shells).map(|k| radius * (1.0 + f64::from(k) / f64::from(shells))).collect();
            let cuts: Vec<(SubcurveId, Vec<f64>)> =
                around.iter().map(|&id| (id, self.leaves(id, corner, &radii))).collect();
            let hulls: Vec<Vec<Hull>> = cuts.iter().map(|(id, ts)| self.hulls_outside(*id, corner, ts)).collect();
            let neighbours =
                hulls.iter().zip(hulls.iter().cycle().skip(1)).take(if hulls.len() > 1 { hulls.len() } else { 0 });
            let apart = |(a, b): (&Vec<Hull>, &Vec<Hull>)| {
                a.iter().all(|h| b.iter().all(|k| h.is_apart(k, self.state.resolution)))
            };
            if shells >= SHELLS_MOST || neighbours.into_iter().all(apart) {
                return cuts;
            }
            shells *= 2;
        }
    }

    /// Ascending parameters at which a spoke leaves the circles of ascending `radii` around its corner; NaN where it
    /// does not.
    fn leaves(&self, spoke: SubcurveId, corner: VertexId, radii: &[f64]) -> Vec<f64> {
        let subcurve = self.state.subcurves.get(spoke);
        let end = if subcurve.ends[0] == corner { End::Start } else { End::Finish };
        let shape = shape_of(&self.state.domain, subcurve);
        let leave = |&r: &f64| shape.leaves_ball(end, r, 0.0, 1.0).unwrap_or(f64::NAN);
        let mut ts: Vec<f64> = radii.iter().map(leave).collect();
        if end == End::Finish {
            ts.reverse();
        }
        ts
    }

    /// The hulls of the parts of a spoke, cut at `ts`, that do not end at its corner.
    fn hulls_outside(&self, spoke: SubcurveId, corner: VertexId, ts: &[f64]) -> Vec<Hull> {
        let subcurve = self.state.subcurves.get(spoke);
        let bounds: Vec<f64> =
            if subcurve.ends[0] == corner { [ts, &subcurve.t[1..]].concat() } else { [&subcurve.t[..1], ts].concat() };
        bounds.windows(2).map(|t| Hull::of(&self.state.domain, subcurve, [t[0], t[1]])).collect()
    }

    /// Splits a subcurve at a parameter, after it has deleted the `free` vertices that encroach it. Returns the new
    /// vertex; `None` where coordinates cannot hold it.
    fn split_at(&mut self, id: SubcurveId, t: f64, free: Vec<VertexId>, why: &'static str) -> Option<VertexId> {
        let subcurve = *self.state.subcurves.get(id);
        if !self.has_room(&subcurve, &[t]) {
            self.state.too_near.push(self.mesh.point(subcurve.ends[0]));
            return None;
        }
        self.delete(free);
        let at = shape_of(&self.state.domain, &subcurve).point(t);
        let side = self.side_of(id).expect("a subcurve is a side");
        if !self.mesh.can_part(side, at) {
            let parts = self.split_together(&[(id, vec![t])], Vec::new(), why)?;
            return Some(self.state.subcurves.get(parts[0][0]).ends[1]);
        }
        let v = self.add_on(&subcurve, why);
        self.state.subcurves.retire(id);
        let parts = self.add_parts(&subcurve, &[(t, v)]);
        self.mesh.part(side, at, [parts[0], parts[1]]);
        parts.into_iter().for_each(|part| self.state.enqueue(part));
        // Regions stay: what lies to the left or right of the subcurve lies on the same side of its parts.
        self.settle(false);
        Some(v)
    }

    /// Splits subcurves at ascending parameters, all at once: if those of a fan were split one after the other, chords
    /// might cross in between. The `free` vertices that encroach are deleted first. `None` where coordinates cannot
    /// hold a point: its place is unresolved. If that is found half-way, the run ends.
    fn split_together(
        &mut self,
        cuts: &[(SubcurveId, Vec<f64>)],
        free: Vec<VertexId>,
        why: &'static str,
    ) -> Option<Vec<Vec<SubcurveId>>> {
        for (id, ts) in cuts {
            let subcurve = *self.state.subcurves.get(*id);
            if !self.has_room(&subcurve, ts) {
                self.state.too_near.push(self.mesh.point(subcurve.ends[0]));
                return None;
            }
        }
        self.delete(free);
        for (id, _) in cuts {
            let side = self.side_of(*id).expect("a subcurve is a side");
            self.mesh.release(side);
        }
        let mut all = Vec::with_capacity(cuts.len());
        for (id, ts) in cuts {
            let subcurve = *self.state.subcurves.get(*id);
            self.state.subcurves.retire(*id);
            let mut at = Vec::with_capacity(ts.len());
            for &t in ts {
                at.push((t, self.insert_on(&subcurve, t, why)?));
            }
            all.push(self.add_parts(&subcurve, &at));
        }
        for &part in all.iter().flatten() {
            let [a, b] = self.state.subcurves.get(part).ends;
            if self.mesh.join(a, b, part).is_err() {
                self.stop_too_near(self.mesh.point(a));
                return None;
            }
            self.state.enqueue(part);
        }
        self.settle(true);
        Some(all)
    }

    /// The parts of a subcurve between vertices at ascending parameters.
    fn add_parts(&mut self, subcurve: &Subcurve, at: &[(f64, VertexId)]) -> Vec<SubcurveId> {
        let mut from = (subcurve.t[0], subcurve.ends[0]);
        let mut add = |to: (f64, VertexId)| {
            let from = std::mem::replace(&mut from, to);
            self.state.subcurves.add(subcurve.carrier, [from.0, to.0], [from.1, to.1], Standing::Ordinary)
        };
        at.iter().copied().chain([(subcurve.t[1], subcurve.ends[1])]).map(&mut add).collect()
    }

    /// Whether a subcurve can be split at ascending parameters: its points differ from each other and from the ends by
    /// the resolution, and lie in the diametral circle.
    fn has_room(&self, subcurve: &Subcurve, ts: &[f64]) -> bool {
        let [x, y] = self.ends_of(subcurve);
        let shape = shape_of(&self.state.domain, subcurve);
        let mut last = (subcurve.t[0], x);
        let mut follows = |t: f64, at: Point| {
            let before = std::mem::replace(&mut last, (t, at));
            before.0 < t && before.1.distance(at) >= self.state.resolution
        };
        ts.iter()
            .map(|&t| (t, shape.point(t)))
            .all(|(t, at)| follows(t, at) && insert::in_range(at) && in_diametral(x, y, at) == CircleSide::Inside)
            && follows(subcurve.t[1], y)
    }

    /// Inserts the point of a subcurve at a parameter. The subcurve must not lie on an edge any more.
    fn insert_on(&mut self, subcurve: &Subcurve, t: f64, why: &'static str) -> Option<VertexId> {
        let at = shape_of(&self.state.domain, subcurve).point(t);
        let near = self.mesh.topology().sides_from(subcurve.ends[1]).next().map_or(TriangleId(0), HalfEdge::triangle);
        let location = self.mesh.kernel().locate(at, near);
        if matches!(location, Location::Vertex(_)) {
            self.stop_too_near(at);
            return None;
        }
        self.mesh.cavity(at, location, &mut self.state.cavity);
        self.mesh.fill(at, &self.state.cavity);
        Some(self.add_on(subcurve, why))
    }

    /// Notes a vertex on a subcurve, whose number is the next one.
    fn add_on(&mut self, subcurve: &Subcurve, why: &'static str) -> VertexId {
        self.alive += 1;
        self.state.counters.add(why, 1);
        self.origins.push(VertexSource::OnCurve(curve_of(subcurve)))
    }

    /// Ends the run: coordinates cannot separate points at a place.
    pub(super) fn stop_too_near(&mut self, at: Point) {
        self.state.too_near.push(at);
        self.state.reason = StopReason::Arithmetic;
    }
}
