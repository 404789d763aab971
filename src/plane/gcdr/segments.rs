//! Points of types B and C: segments that are encroached or too large, and where they are split.

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
    /// Free ones that see the subcurve.
    free: Vec<VertexId>,
    /// All that are not free, seen or not.
    others: Vec<VertexId>,
    /// Whether any of those sees it.
    type_c: bool,
}

impl Gcdr<'_> {
    pub(super) fn ends_of(&self, subcurve: &Subcurve) -> [Point; 2] {
        subcurve.ends.map(|v| self.mesh.point(v))
    }

    /// Splits a subcurve that is larger than asked.
    pub(super) fn look_at_piece(&mut self, id: SubcurveId) {
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

    /// Lines 7–14 of Algorithm 2: free vertices in the diametral circle go, and a point of type B or C comes. A spoke
    /// takes its whole fan with it. `latest` is the parent where no vertex crowds the segment. `false` where
    /// coordinates cannot hold it.
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

    /// The parameter that the strategy chooses: the place on the curve above its place on the chord.
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

    /// Rule 4 of Definition 2.5.
    fn nearest_seen(&self, v: VertexId, vertices: Vec<VertexId>) -> Option<VertexId> {
        let away = |w: &VertexId| self.mesh.point(*w).distance_squared(self.mesh.point(v));
        let seen = vertices.into_iter().filter(|&w| self.mesh.see_each_other(v, w));
        seen.min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    fn encroachers(&mut self, id: SubcurveId) -> Encroachers {
        let mut found = Encroachers::default();
        let Some(side) = self.side_of(id) else { return found };
        for side in [side, self.mesh.topology().twin(side)] {
            // The apex sees the segment, and if it lies outside the circle, so does whatever else sees it from there.
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

    /// Deletes free vertices, some of which may be given twice.
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
        // A corner may have as many neighbours as there are curves at it; the other end has a handful.
        let topology = self.mesh.topology();
        match self.origins[x] {
            VertexSource::Input(_) => topology.side_between(y, x).map(|s| topology.twin(s)),
            _ => topology.side_between(x, y),
        }
    }

    /// Cuts all curves of a fan at half its radius, and where their chords between there and the old radius might come
    /// to cross, at more distances in between.
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

    /// Parameters, ascending, at which spokes are cut from `radius` on outward: so many shells that the hulls of
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

    /// Ascending parameters at which a spoke leaves the circles of ascending radii around its corner; NaN where it does
    /// not.
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

    /// The hulls of the parts of a spoke that do not end at its corner.
    fn hulls_outside(&self, spoke: SubcurveId, corner: VertexId, ts: &[f64]) -> Vec<Hull> {
        let subcurve = self.state.subcurves.get(spoke);
        let bounds: Vec<f64> =
            if subcurve.ends[0] == corner { [ts, &subcurve.t[1..]].concat() } else { [&subcurve.t[..1], ts].concat() };
        bounds.windows(2).map(|t| Hull::of(&self.state.domain, subcurve, [t[0], t[1]])).collect()
    }

    /// Splits a subcurve at a parameter, after the deletion of `free` vertices that encroach it. `None` where coordinates
    /// cannot hold it.
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
        // What lies to the left and right of a subcurve lies there of its parts.
        self.settle(false);
        Some(v)
    }

    /// Splits pieces at ascending parameters, all at once: between two of a fan chords may cross. `free` vertices,
    /// those that encroach, are deleted first. `None` where coordinates cannot hold it: the place is unresolved; if that
    /// shows only half-way, the run is over.
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

    /// Whether points of a subcurve can part it: coordinates tell them from each other and from the ends, and they lie in
    /// the diametral circle.
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

    /// Inserts the point of a subcurve at a parameter; the subcurve lies on no side any more.
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

    /// Counts a vertex on a subcurve, the next of all.
    fn add_on(&mut self, subcurve: &Subcurve, why: &'static str) -> VertexId {
        self.alive += 1;
        self.state.counters.add(why, 1);
        self.origins.push(VertexSource::OnCurve(curve_of(subcurve)))
    }

    pub(super) fn stop_too_near(&mut self, at: Point) {
        self.state.too_near.push(at);
        self.state.reason = StopReason::Arithmetic;
    }
}
