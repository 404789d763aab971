//! Cuts of each drawn curve alone: at breaks, around hooks (bends far narrower than the tolerance), where it meets
//! itself, and once where it is closed.
//!
//! ```text
//!          cusp                 hook               self-meeting           closed
//!           │                    ╭╮                  ╲  ╱               ╭───●───╮
//!      ╲    ●    ╱         ──────●╯──────             ●╳●               │       │
//!       ╲__╱ ╲__╱                                    ╱  ╲               ╰───●───╯
//! ```

use super::arrangement::{Arrangement, Edge, NodeOrigin, Part, is_spiral};
use super::error::{ArrangeError, Unarranged};
use super::frame::Tolerances;
use super::repair::RepairKind;
use crate::curve::{BreakKind, Curve, Meeting, self_meetings};
use crate::domain::Drawing;
use crate::geometry::extent;
use crate::ids::PointId;
use crate::watch::Watch;

/// A hook turns at least by this angle within this part of the tolerance. A disk wider than the tolerance has no hook.
const HOOK_RAD: f64 = 0.05;
const HOOK: f64 = 0.0625;

/// A Bézier curve has no hooks where its speed along the chord is at least this part of its greatest speed: its radius
/// of curvature is then no smaller than some millionth of its size.
const PACE: f64 = 1e-3;

/// The edges of a drawing, cut at breaks and self-meetings, not yet met with each other.
pub(super) fn cut_drawing<'a>(
    drawing: &'a Drawing,
    tolerances: Tolerances,
    watch: &mut Watch,
) -> Result<Arrangement<'a>, Unarranged> {
    let mut arrangement = Arrangement::empty(drawing, tolerances);
    for source in 0..drawing.curves.len() {
        arrangement.progress("cutting", drawing.curves.len() - source).tell(watch)?;
        let ends = arrangement.add_curve(source as u32)?;
        arrangement.drawn_ends.push(ends);
    }
    for (i, point) in drawing.points.iter().enumerate() {
        let id = arrangement.add_node(point.at, NodeOrigin::Point(i as u32));
        arrangement.drawn_points.push(id);
    }
    Ok(arrangement)
}

impl Arrangement<'_> {
    fn add_curve(&mut self, source: u32) -> Result<Option<[PointId; 2]>, ArrangeError> {
        let curve = &self.drawing.curves[source as usize].curve;
        let (size, weld) = (extent(curve.bounds()), self.tolerances.weld);
        if size == 0.0 {
            let what = format!("{} has no length and was dropped", self.entity(source));
            self.repair(RepairKind::ZeroLength, curve.start(), size, what);
            return Ok(None);
        }
        if size <= weld {
            // Too small to have a shape. Its ends decide whether it is lost: a chain of short curves may be long.
            let [from, to] = [curve.start(), curve.end()].map(|at| self.add_node(at, NodeOrigin::Curve(source)));
            self.edges.push(Edge::new(Part::whole(curve), [from, to], source));
            return Ok(Some([from, to]));
        }
        let first = self.add_node(curve.start(), NodeOrigin::Curve(source));
        let last =
            if curve.start() == curve.end() { first } else { self.add_node(curve.end(), NodeOrigin::Curve(source)) };
        let parts = self.own_parts(source, curve)?;
        let count = parts.len();
        let mut from = first;
        for (k, (part, origin)) in parts.into_iter().enumerate() {
            let to = if k + 1 == count { last } else { self.add_node(part.curve.end(), origin) };
            self.edges.push(Edge::new(part, [from, to], source));
            from = to;
        }
        Ok(Some([first, last]))
    }

    /// The parts of a drawn curve between its own cuts: breaks, self-meetings, and one more where a part would be
    /// closed. Each comes with the origin of the node at its end.
    fn own_parts(&mut self, source: u32, curve: &Curve) -> Result<Vec<(Part, NodeOrigin)>, ArrangeError> {
        if matches!(curve, Curve::Line(_)) {
            return Ok(vec![(Part::whole(curve), NodeOrigin::Curve(source))]);
        }
        let mut parts = Vec::new();
        for regular in self.parts_between_breaks(source, curve) {
            let mut cuts = self.self_cuts(source, &regular.curve)?;
            cuts.retain(|&t| 0.0 < t && t < 1.0);
            cuts.sort_by(f64::total_cmp);
            cuts.dedup();
            let regular = regular.split(&cuts);
            let last = regular.len() - 1;
            for (k, part) in regular.into_iter().enumerate() {
                let origin = if k < last { NodeOrigin::Meeting(source) } else { NodeOrigin::Curve(source) };
                self.open_up(part, origin, source, &mut parts);
            }
        }
        Ok(parts)
    }

    fn parts_between_breaks(&mut self, source: u32, curve: &Curve) -> Vec<Part> {
        let breaks = curve.breaks();
        for at_break in &breaks {
            let kind = match at_break.kind {
                BreakKind::Cusp => "cusp",
                BreakKind::TangentJump => "tangent jump",
            };
            let degrees = at_break.turn_rad.to_degrees();
            let what = format!("a {kind} of {degrees:.3}° in {} became a corner", self.entity(source));
            self.repair(RepairKind::Corner, curve.point(at_break.t), 0.0, what);
        }
        let cuts: Vec<f64> = breaks.iter().map(|b| b.t).filter(|&t| 0.0 < t && t < 1.0).collect();
        let parts = Part::whole(curve).split(&cuts);
        parts.into_iter().flat_map(|part| self.parts_between_hooks(source, part)).collect()
    }

    /// A regular part, cut around its hooks: bends far narrower than the tolerance. They come from control points that
    /// differ from an end in the last digit. The stretch between the two cuts is too short to stay: the hook becomes a
    /// corner, or joins the end beside it.
    fn parts_between_hooks(&mut self, source: u32, regular: Part) -> Vec<Part> {
        let part = &regular.curve;
        if is_evenly_paced(part) {
            return vec![regular];
        }
        let mut steps = vec![0.0];
        steps.extend(part.cuts_of_turning(HOOK_RAD));
        steps.push(1.0);
        let narrow = |t0: f64, t1: f64, limit: f64| extent(part.bounds_of(t0, t1)) <= limit * self.tolerances.weld;
        let hooked: Vec<bool> = steps.windows(2).map(|step| narrow(step[0], step[1], HOOK / 4.0)).collect();
        let mut hooks = Vec::new();
        let mut k = 0;
        for run in hooked.chunk_by(|a, b| a == b) {
            let [t0, t1] = [steps[k], steps[k + run.len()]];
            if run[0] && narrow(t0, t1, HOOK) && part.turning(t0, t1) >= HOOK_RAD {
                hooks.push([t0, t1]);
            }
            k += run.len();
        }
        for &[t0, t1] in &hooks {
            let (size, degrees) = (extent(part.bounds_of(t0, t1)), part.turning(t0, t1).to_degrees());
            let what = format!(
                "a bend of {degrees:.0}° in {}, narrower than the tolerance, became a corner",
                self.entity(source)
            );
            self.repair(RepairKind::Corner, part.point(t0), size, what);
        }
        let mut cuts = hooks.concat();
        cuts.retain(|&t| 0.0 < t && t < 1.0);
        regular.split(&cuts)
    }

    /// The parameters at which a regular part meets itself. A loop narrower than the tolerance is no meeting within the
    /// tolerance, although the part may cross itself there. So a part without meetings is searched once more, within
    /// the rounding.
    fn self_cuts(&mut self, source: u32, part: &Curve) -> Result<Vec<f64>, ArrangeError> {
        let mut found = self.self_meetings_of(source, part, self.tolerances.weld)?;
        if found.is_empty() {
            found = self.self_meetings_of(source, part, self.tolerances.rounding)?;
        }
        for meeting in &found {
            let what = format!("{} meets itself and was split there", self.entity(source));
            self.repair(RepairKind::SelfSplit, meeting.at, 0.0, what);
        }
        Ok(found.iter().flat_map(|m| [m.t, m.u]).collect())
    }

    fn self_meetings_of(&self, source: u32, part: &Curve, tolerance: f64) -> Result<Vec<Meeting>, ArrangeError> {
        self_meetings(part, tolerance).map_err(|budget| {
            let what = format!("{} runs so near to itself that its meetings cannot be told apart", self.entity(source));
            ArrangeError::near(what, budget.at, "simplify the curve, or raise the tolerance")
        })
    }

    /// Adds a part. It is halved where its ends are one point, and where it is a spiral: only its halves are arcs of
    /// circles.
    fn open_up(&self, part: Part, origin: NodeOrigin, source: u32, parts: &mut Vec<(Part, NodeOrigin)>) {
        let weld = self.tolerances.weld;
        let is_closed = part.curve.start().distance(part.curve.end()) <= weld && extent(part.curve.bounds()) > weld;
        if is_closed || is_spiral(&part.curve) {
            parts.push((part.between(0.0, 0.5), NodeOrigin::Curve(source)));
            parts.push((part.between(0.5, 1.0), origin));
        } else {
            parts.push((part, origin));
        }
    }
}

/// Whether the speed of a curve varies so little that it has no hook.
fn is_evenly_paced(curve: &Curve) -> bool {
    match curve {
        Curve::Line(_) | Curve::Arc(_) | Curve::Clothoid(_) => true,
        Curve::Bezier(bezier) if bezier.weights.is_none() => {
            let legs = || bezier.points.windows(2).map(|leg| leg[1] - leg[0]);
            let chord = curve.end() - curve.start();
            let fastest = legs().map(|leg| leg.hypot()).fold(0.0, f64::max);
            legs().all(|leg| leg.dot(chord) > PACE * fastest * chord.hypot())
        }
        Curve::Bezier(_) | Curve::Ellipse(_) | Curve::Spline(_) => false,
    }
}
