//! The guarantees of a domain, checked one by one. The check is independent: it shares no step with the arrangement.

use super::locate::{Axis, Hit, Locator, TANGENTS_TELL, gap_after, left_of};
use super::{Domain, Incident};
use crate::curve::{Curve, End, meetings, self_meetings};
use crate::geometry::boxes::{BoxHierarchy, Labels};
use crate::geometry::exact::orient;
use crate::geometry::{Rect, Vec2, magnitude};
use crate::ids::{CurveId, Id, IdVec, PointId, RegionId};
use std::f64::consts::TAU;

/// The number of horizontal lines tried through a component until one keeps clear of ends and tangents.
const LINES: usize = 64;

impl Domain {
    /// Every violated guarantee, one sentence each with the curves and points at fault; empty for a valid domain.
    pub fn flaws(&self) -> Vec<String> {
        let mut flaws = Vec::new();
        self.check_ends(&mut flaws);
        if !flaws.is_empty() {
            // All other checks assume that curves end at their points.
            return flaws;
        }
        self.check_regularity(&mut flaws);
        self.check_stars(&mut flaws);
        self.check_points(&mut flaws);
        self.check_meetings(&mut flaws);
        self.check_sides(&mut flaws);
        self.check_plane(&mut flaws);
        self.check_areas(&mut flaws);
        self.check_levels(&mut flaws);
        flaws
    }

    /// Four units in the last place of the largest coordinate.
    fn rounding(&self) -> f64 {
        4.0 * f64::EPSILON * magnitude(self.bounds())
    }

    fn check_ends(&self, flaws: &mut Vec<String>) {
        if self.stars.len() != self.points.len() {
            flaws.push(format!("{} points have {} stars", self.points.len(), self.stars.len()));
        }
        for (id, p) in self.points.enumerate().filter(|(_, p)| !p.is_finite()) {
            flaws.push(format!("{id:?} is not finite: {p:?}"));
        }
        for (id, curve) in self.curves.enumerate() {
            let known = curve.ends.iter().all(|&end| self.points.get(end).is_some());
            if !known {
                flaws.push(format!("{id:?} ends at an unknown point"));
            } else if curve.ends.map(|end| self.points[end]) != [curve.curve.start(), curve.curve.end()] {
                flaws.push(format!("{id:?} does not end at its points {:?}, bit for bit", curve.ends));
            }
            if curve.ends[0] == curve.ends[1] {
                flaws.push(format!("{id:?} is closed at {:?}", curve.ends[0]));
            }
            if curve.sides.iter().flatten().any(|&r| self.regions.get(r).is_none()) {
                flaws.push(format!("{id:?} borders an unknown region"));
            }
        }
    }

    fn check_regularity(&self, flaws: &mut Vec<String>) {
        let rounding = self.rounding();
        for (id, curve) in self.curves.enumerate() {
            for at_break in curve.curve.breaks() {
                flaws.push(format!("{id:?} has a {:?} at t = {}", at_break.kind, at_break.t));
            }
            match self_meetings(&curve.curve, rounding) {
                Ok(found) if found.is_empty() => {}
                Ok(found) => flaws.push(format!("{id:?} meets itself at {:?}", found[0])),
                Err(_) => flaws.push(format!("{id:?}: its meetings with itself cannot be told")),
            }
        }
    }

    fn check_stars(&self, flaws: &mut Vec<String>) {
        let mut seen = vec![[0; 2]; self.curves.len()];
        for (p, star) in self.stars.enumerate() {
            for incident in star {
                let (end, k) = match incident.end {
                    End::Start => (self.curves[incident.curve].ends[0], 0),
                    End::Finish => (self.curves[incident.curve].ends[1], 1),
                };
                seen[incident.curve.index()][k] += 1;
                if end != p {
                    flaws.push(format!("the star of {p:?} holds {incident:?}, which lies at {end:?}"));
                }
            }
            if star.len() > 1 && !self.goes_round_once(star) {
                flaws.push(format!("the star of {p:?} is not in counter-clockwise order"));
            }
        }
        for (i, _) in seen.iter().enumerate().filter(|(_, n)| **n != [1, 1]) {
            flaws.push(format!("{:?} is not once in the star of either end", CurveId::from_index(i)));
        }
    }

    fn goes_round_once(&self, star: &[Incident]) -> bool {
        let directions: Vec<Vec2> = star.iter().map(|i| self.curves[i.curve].curve.direction_at(i.end)).collect();
        let total: f64 = (0..star.len()).map(|k| gap_after(&directions, k)).sum();
        // If all tangents are equal the angles add up to 0, not to a full turn. Each angle may be wrong by what
        // `gap_after` rounds to 0.
        let slack = 2.0 * TANGENTS_TELL * star.len() as f64;
        (total - TAU).abs() < slack || total < slack
    }

    fn check_points(&self, flaws: &mut Vec<String>) {
        let least = self.rounding() / 4.0;
        let boxes = BoxHierarchy::new(self.curves.iter().map(|c| c.curve.bounds().inflate(least, least)));
        for (id, &p) in self.points.enumerate() {
            boxes.meeting(Rect::from_points(p, p), |i| {
                let curve = &self.curves[CurveId::from_index(i)];
                if !curve.ends.contains(&id) && curve.curve.nearest(p, 0.0, 1.0).1 <= least {
                    flaws.push(format!("{id:?} lies on {:?}", CurveId::from_index(i)));
                }
                true
            });
        }
        for (id, d) in self.lfs0().enumerate().filter(|(_, d)| **d <= least) {
            flaws.push(format!("{id:?} is {d:e} from another point"));
        }
    }

    fn check_meetings(&self, flaws: &mut Vec<String>) {
        let rounding = self.rounding();
        let boxes = BoxHierarchy::new(self.curves.iter().map(|c| c.curve.bounds()));
        let mut pairs = Vec::new();
        // Lines with a common end do not cross. That no other end lies on them is checked with the points.
        let labels = |i: usize| match &self.curves[CurveId::from_index(i)] {
            line if line.curve.as_line().is_some() => line.ends.map(|end| Some(end.0)),
            _ => Labels::default(),
        };
        boxes.pairs(labels, |i, j| pairs.push([i, j].map(CurveId::from_index)));
        pairs.sort_unstable();
        for ids in pairs {
            let [p, q] = ids.map(|id| &self.curves[id].curve);
            if let (Some(p), Some(q)) = (p.as_line(), q.as_line()) {
                let parted = orient(p.start, p.end, q.start) == orient(p.start, p.end, q.end)
                    || orient(q.start, q.end, p.start) == orient(q.start, q.end, p.end);
                if !parted {
                    flaws.push(format!("{:?} and {:?} cross", ids[0], ids[1]));
                }
                continue;
            }
            match meetings(p, q, rounding) {
                Err(_) => flaws.push(format!("{ids:?}: their meetings cannot be told")),
                Ok(found) => {
                    for meeting in found.points.iter().filter(|m| !self.at_common_end(ids, [m.t, m.u], rounding)) {
                        flaws.push(format!("{:?} and {:?} meet at {:?}", ids[0], ids[1], meeting.at));
                    }
                    for overlap in found.overlaps.iter().filter(|o| {
                        !self.at_common_end(ids, [o.t[0], o.u[0]], rounding)
                            || !self.at_common_end(ids, [o.t[1], o.u[1]], rounding)
                    }) {
                        flaws.push(format!("{:?} and {:?} overlap over {:?}", ids[0], ids[1], overlap.t));
                    }
                }
            }
        }
    }

    /// Whether a meeting is the contact at a common end: from that end to the meeting the curves lie within rounding of
    /// each other.
    fn at_common_end(&self, ids: [CurveId; 2], ts: [f64; 2], rounding: f64) -> bool {
        let [p, q] = ids.map(|id| &self.curves[id]);
        // The arrangement lets curves that touch overlap by this much.
        let rounding = 16.0 * rounding;
        (0..2).flat_map(|i| (0..2).map(move |j| (i, j))).filter(|&(i, j)| p.ends[i] == q.ends[j]).any(|(i, j)| {
            let near = |t: f64, end: usize, from: &Curve, to: &Curve| {
                (1..4).all(|k| {
                    let at = from.point(t + k as f64 / 4.0 * (end as f64 - t));
                    at.distance(self.points[p.ends[i]]) <= rounding || to.nearest(at, 0.0, 1.0).1 <= rounding
                })
            };
            near(ts[0], i, &p.curve, &q.curve) && near(ts[1], j, &q.curve, &p.curve)
        })
    }

    /// Between neighbours in a star lies one face, so both have the same region there.
    fn check_sides(&self, flaws: &mut Vec<String>) {
        for (p, star) in self.stars.enumerate() {
            for (k, &a) in star.iter().enumerate() {
                let b = star[(k + 1) % star.len()];
                let after = self.curves[a.curve].sides[left_of(a).index()];
                let before = self.curves[b.curve].sides[left_of(b).other().index()];
                if after != before {
                    flaws.push(format!("at {p:?}, {:?} and {:?} do not agree on the region between", a.curve, b.curve));
                }
            }
        }
    }

    /// Euler's formula: a map is plane if points − curves + face cycles = 2 for every component.
    fn check_plane(&self, flaws: &mut Vec<String>) {
        let used: Vec<PointId> = self.stars.enumerate().filter(|(_, s)| !s.is_empty()).map(|(p, _)| p).collect();
        let components = self.first_curves().len();
        let (points, curves, cycles) = (used.len() as i64, self.curves.len() as i64, self.cycle_count() as i64);
        if points - curves + cycles != 2 * components as i64 {
            flaws.push(format!(
                "no plane map: {points} points, {curves} curves and {cycles} face cycles in {components} components"
            ));
        }
    }

    fn cycle_count(&self) -> usize {
        // By directed edge (curve and side): the next one along the same face. It is the one before the twin in the
        // star of the twin's tail.
        let mut next = vec![usize::MAX; 2 * self.curves.len()];
        for star in self.stars.iter() {
            for (k, &i) in star.iter().enumerate() {
                let before = star[(k + star.len() - 1) % star.len()];
                let arriving = 2 * i.curve.index() + left_of(i).other().index();
                next[arriving] = 2 * before.curve.index() + left_of(before).index();
            }
        }
        let mut seen = vec![false; next.len()];
        let mut count = 0;
        for first in 0..next.len() {
            let mut at = first;
            count += usize::from(!seen[first]);
            while !seen[at] {
                seen[at] = true;
                at = next[at];
            }
        }
        count
    }

    /// The first curve of every connected component.
    fn first_curves(&self) -> Vec<CurveId> {
        let mut seen: IdVec<PointId, bool> = vec![false; self.points.len()].into();
        let mut first = Vec::new();
        for (id, curve) in self.curves.enumerate().filter(|(_, c)| c.ends[0] != c.ends[1]) {
            if seen[curve.ends[0]] {
                continue;
            }
            first.push(id);
            let mut stack = vec![curve.ends[0]];
            seen[curve.ends[0]] = true;
            while let Some(p) = stack.pop() {
                for end in self.star(p).iter().flat_map(|i| self.curves[i.curve].ends) {
                    if !std::mem::replace(&mut seen[end], true) {
                        stack.push(end);
                    }
                }
            }
        }
        first
    }

    /// The area of every region equals the signed area of the curves on its border.
    fn check_areas(&self, flaws: &mut Vec<String>) {
        let (origin, rounding) = (self.bounds().center(), self.rounding());
        let mut enclosed: IdVec<RegionId, f64> = vec![0.0; self.regions.len()].into();
        // A relative error of 1e-12 for each integral, plus the effect of rounded coordinates along the border.
        let mut slack = 0.0;
        for curve in self.curves.iter().filter(|c| c.sides[0] != c.sides[1]) {
            let (area, bounds) = (curve.curve.signed_area(origin), curve.curve.bounds());
            slack += 1e-12 * area.abs() + rounding * (bounds.width() + bounds.height());
            curve.sides[0].iter().for_each(|&left| enclosed[left] += area);
            curve.sides[1].iter().for_each(|&right| enclosed[right] -= area);
        }
        for (id, region) in self.regions.enumerate() {
            if (enclosed[id] - region.area).abs() > slack {
                flaws.push(format!("{id:?} says area {}, but its curves enclose {}", region.area, enclosed[id]));
            }
        }
    }

    /// On an axis-parallel line through every component, neighbouring crossings must have the same region between them.
    /// Lines through large components cross the whole drawing, and must end in the unbounded face. For small components
    /// a line through their surroundings is enough.
    ///
    /// ```text
    ///        ╭─ A ──────────────╮         The crossings are 1, 2, 3 and 4. After 1 and before 2 lies the same region,
    ///        │      ╭ B ╮       │         so does after 2 and before 3, and after 3 and before 4. Before 1 and after 4
    ///   ─────1──────2───3───────4─────    is outside.
    ///        │      ╰───╯       │
    ///        ╰──────────────────╯
    /// ```
    fn check_levels(&self, flaws: &mut Vec<String>) {
        let (locator, rounding) = (Locator::new(self), self.rounding());
        let whole = self.bounds();
        for id in self.first_curves() {
            let bounds = self.curves[id].curve.bounds();
            let upright = bounds.height() > bounds.width();
            let (axis, [low, high], [from, to]) = match upright {
                true => (Axis::Horizontal, [bounds.y0, bounds.y1], [bounds.x0, bounds.x1]),
                false => (Axis::Vertical, [bounds.x0, bounds.x1], [bounds.y0, bounds.y1]),
            };
            let is_small = 64.0 * (high - low) < whole.width().max(whole.height());
            let reach = if is_small { 8.0 * (high - low) } else { f64::INFINITY };
            // An irrational spread other than that of the arrangement: √2 − 1.
            let mut levels = (1..=LINES).map(|k| low + (high - low) * (k as f64 * (2f64.sqrt() - 1.0)).fract());
            let hits = levels.find_map(|level| locator.hits(axis, level, [from - reach, to + reach], rounding));
            if let Some(hits) = hits {
                self.check_level(&hits, !is_small, flaws);
            }
        }
    }

    fn check_level(&self, hits: &[Hit], right_through: bool, flaws: &mut Vec<String>) {
        let before = |hit: &Hit| self.curves[hit.curve].sides[hit.before.index()];
        let after = |hit: &Hit| self.curves[hit.curve].sides[hit.before.other().index()];
        for pair in hits.windows(2).filter(|pair| after(&pair[0]) != before(&pair[1])) {
            flaws.push(format!(
                "{:?} and {:?} face each other, but do not agree on the region between",
                pair[0].curve, pair[1].curve
            ));
        }
        if !right_through {
            return;
        }
        let outermost = [hits.first().map(|h| (h, before(h))), hits.last().map(|h| (h, after(h)))];
        for (hit, region) in outermost.into_iter().flatten() {
            if let Some(region) = region {
                flaws.push(format!("{:?} has the unbounded face on the side of {region:?}", hit.curve));
            }
        }
    }
}
