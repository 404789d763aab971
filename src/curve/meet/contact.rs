//! From a first guess to a meeting: the contact is followed both ways, classified as a meeting or a shared stretch, and
//! its exact place is computed.
//!
//! The pairs (t, u) with a gap of at most the tolerance form connected *contacts*. Each contact is one meeting: a
//! crossing if the curves leave it on opposite sides, else a touching. So a lens between two crossings that is no
//! deeper than the tolerance is one touching, and a deeper lens has two crossings, whatever their distance. Two curves
//! of low degree that agree on a stretch agree until a span of one of them ends. So a contact is an overlap between the
//! outermost span ends that it contains, if those are apart; else it snaps to the end that it contains.
//!
//! ```text
//!      before      at     after            before      at     after           Walks from the guess `at` go along a in
//!   a ──╮ :        :        : ╭──       a ──╮ :        :        :             both senses, with the feet u on b, as
//!       ╰─:────────●────────:─╯             ╰─:──╮     :        :             long as the gap is within the tolerance.
//!   b ────:────────:────────:─────      b ────:──╰─────●─────╮──:────         `before` and `after` are just beyond.
//!                                             :        :     ╰──:── a         Left: a leaves on one side, a touching.
//!          touching                            crossing                       Right: a crossing.
//! ```

use super::hull::length;
use super::{Meeting, MeetingBudget, MeetingKind, Overlap};
use crate::curve::{Curve, End};
use crate::geometry::{Point, Vec2};

/// Newton's method doubles the correct digits each step. The fallback, bisection, needs at most as many steps as a
/// double has bits.
const NEWTON_STEPS: usize = 53;
/// The least number of steps of a walk on a span, for each degree of the curves. Up to degree eight, a span then has at
/// least as many samples as two curves of the degree can have crossings (Bézout).
const SAMPLES_PER_DEGREE: f64 = 8.0;

/// One of the two curves, with what the walks need.
pub(super) struct Track<'c> {
    /// The curve.
    pub curve: &'c Curve,
    /// Ends of spans: 0, the inner knots, 1.
    pub knots: Vec<f64>,
    /// The highest degree of its spans.
    pub degree: usize,
    /// The longer side of its box.
    pub size: f64,
}

impl<'c> Track<'c> {
    /// A curve with the highest degree of its spans and the longer side of its box.
    pub fn new(curve: &'c Curve, degree: usize, size: f64) -> Self {
        Self { curve, knots: curve.knots(), degree, size }
    }

    /// The width of the span at t, as a range of the parameter.
    fn span(&self, t: f64) -> f64 {
        let above = self.knots.partition_point(|&k| k <= t).clamp(1, self.knots.len() - 1);
        self.knots[above] - self.knots[above - 1]
    }

    /// The change of parameter at t, in either sense, that moves the curve's point by about `distance`.
    fn step_of(&self, t: f64, distance: f64) -> f64 {
        let (velocity, bend) = (length(self.curve.derivative(t)), length(self.curve.second_derivative(t)));
        // A curve may have speed 0 at single parameters: the lower limit is a sixteenth of its least mean speed.
        let speed = velocity.max(self.size / 16.0);
        let steady = if speed > distance { distance / speed } else { 1.0 };
        // At a repeated control point it moves by the square of the step: |γ′| h + |γ″| h²/2 = distance.
        let start = 0.5 * (velocity + (velocity * velocity + 2.0 * bend * distance).sqrt());
        if start * steady >= distance {
            return steady.min(distance / start);
        }
        let slow = if start > distance { distance / start } else { 1.0 };
        let here = self.curve.point(t);
        let stays = |s: f64| length(self.curve.point(s.clamp(0.0, 1.0)) - here) <= 2.0 * distance;
        if [-slow, -0.5 * slow, 0.5 * slow, slow].into_iter().all(|step| stays(t + step)) { slow } else { steady }
    }

    fn inner_knots(&self) -> &[f64] {
        &self.knots[1..self.knots.len() - 1]
    }
}

/// How a walk along a contact ends.
#[derive(Clone, Copy)]
enum Stop {
    /// One of the curves ends here.
    End,
    /// The gap exceeds the tolerance here.
    Away([f64; 2]),
}

/// The classification of a contact.
enum Finding {
    Point(Meeting),
    Stretch(Overlap),
    /// No meeting: the common end of a closed curve, or a curve near to itself only because its points are neighbours.
    Nothing,
}

/// Every contact found so far.
pub(super) struct Contacts<'c> {
    /// The first curve, with parameter t.
    pub a: Track<'c>,
    /// The second curve, with parameter u.
    pub b: Track<'c>,
    /// The largest gap of a meeting.
    pub tolerance: f64,
    /// The gap up to which a contact is followed: the tolerance plus noise. Where curves part slowly, noise around the
    /// tolerance would otherwise break the contact into many, each a meeting.
    held: f64,
    /// Whether a and b are one curve that may meet itself.
    pub same: bool,
    /// The walks along contacts: pairs (t, u) with ascending t.
    walks: Vec<Vec<[f64; 2]>>,
    /// By walk: its range of t.
    reaches: Vec<[f64; 2]>,
    /// The meetings so far.
    pub points: Vec<Meeting>,
    /// The shared stretches so far.
    pub overlaps: Vec<Overlap>,
}

impl<'c> Contacts<'c> {
    /// No contacts yet. `noise` is the rounding error of a gap.
    pub fn new(a: Track<'c>, b: Track<'c>, tolerance: f64, noise: f64, same: bool) -> Self {
        let (walks, reaches, points, overlaps) = Default::default();
        Self { a, b, tolerance, held: tolerance + 2.0 * noise, same, walks, reaches, points, overlaps }
    }

    /// Records a crossing that has no end and no other meeting within `reach` of it, without a walk.
    pub fn add_clear_crossing(&mut self, t: f64, u: f64, reach: f64) {
        let (dt, du) = (self.a.step_of(t, reach), self.b.step_of(u, reach));
        self.keep(vec![[t - dt, u - du], [t + dt, u + du]]);
        let at = self.a.curve.point(t).midpoint(self.b.curve.point(u));
        let contact = Overlap { t: [t; 2], u: [u; 2] };
        self.points.push(Meeting { at, t, u, kind: MeetingKind::Crossing, contact });
    }

    /// Follows the contact through (t, u), whose gap must be within the tolerance, and records its meeting or stretch.
    /// `root` says that (t, u) solves a(t) = b(u) up to rounding.
    ///
    /// # Errors
    ///
    /// [`MeetingBudget`] where a walk takes too many steps.
    pub fn add(&mut self, t: f64, u: f64, root: bool) -> Result<(), MeetingBudget> {
        if self.knows(t, u) {
            return Ok(());
        }
        let (mut walk, before) = self.walk([t, u], -1.0)?;
        walk.reverse();
        walk.push([t, u]);
        let (onward, after) = self.walk([t, u], 1.0)?;
        walk.extend(onward);
        match self.what_is(&walk, [t, u], root, before, after) {
            Finding::Point(meeting) => self.points.push(meeting),
            Finding::Stretch(overlap) => self.overlaps.push(overlap),
            Finding::Nothing => {}
        }
        if let Stop::Away(outside) = before {
            walk.insert(0, outside);
        }
        if let Stop::Away(outside) = after {
            walk.push(outside);
        }
        self.keep(walk);
        Ok(())
    }

    fn keep(&mut self, walk: Vec<[f64; 2]>) {
        self.reaches.push([walk[0][0], walk[walk.len() - 1][0]]);
        self.walks.push(walk);
    }

    /// The number of contacts followed so far: the cost of [`Contacts::knows`].
    pub fn followed(&self) -> usize {
        self.walks.len()
    }

    /// Whether (t, u) lies in a contact that was already followed.
    pub fn knows(&self, t: f64, u: f64) -> bool {
        self.knows_box([t; 2], [u; 2])
    }

    /// Whether a pair of ranges lies within a contact that was already followed, next to its walk.
    pub fn knows_box(&self, t: [f64; 2], u: [f64; 2]) -> bool {
        if self.walks.is_empty() {
            return false;
        }
        let dt = self.a.step_of(0.5 * (t[0] + t[1]), 2.0 * self.tolerance);
        let du = self.b.step_of(0.5 * (u[0] + u[1]), 2.0 * self.tolerance);
        self.reaches.iter().zip(&self.walks).any(|(reach, walk)| {
            if t[0] < reach[0] - dt || t[1] > reach[1] + dt {
                return false;
            }
            let (first, last) = (walk[0], walk[walk.len() - 1]);
            let (low, high) = (first[1].min(last[1]) - du, first[1].max(last[1]) + du);
            if u[0] < low || u[1] > high {
                return false;
            }
            // The part of the walk over t, and one more step at either side.
            let from = walk.partition_point(|w| w[0] < t[0]).saturating_sub(1);
            let to = (walk.partition_point(|w| w[0] <= t[1]) + 1).min(walk.len());
            let part = &walk[from.min(to - 1)..to];
            let least = part.iter().map(|w| w[1]).fold(f64::INFINITY, f64::min) - du;
            let most = part.iter().map(|w| w[1]).fold(f64::NEG_INFINITY, f64::max) + du;
            u[0] <= most && least <= u[1]
        })
    }

    /// Follows the contact from a pair, with t falling (`sense` −1) or rising (+1). Returns the pairs after the first,
    /// and how the walk ends.
    fn walk(&self, from: [f64; 2], sense: f64) -> Result<(Vec<[f64; 2]>, Stop), MeetingBudget> {
        let (a, b) = (self.a.curve, self.b.curve);
        let goal = if sense > 0.0 { 1.0 } else { 0.0 };
        let first_step = (0.25 * self.a.step_of(from[0], self.tolerance)).max(f64::EPSILON);
        let samples = SAMPLES_PER_DEGREE * self.a.degree.max(self.b.degree) as f64;
        let spans = self.a.knots.len() + self.b.knots.len();
        // Steps that double or quarter are some 60 each; the others are full, at most two a sample on all spans. The
        // budget is twice that.
        let budget = 2 * (120 + 2 * spans * samples as usize);
        let (mut passed, mut here, mut step) = (Vec::new(), from, first_step);
        for _ in 0..budget {
            let [t, u] = here;
            if t == goal {
                return Ok((passed, Stop::End));
            }
            let (velocity, other) = (a.derivative(t), b.derivative(u));
            let ratio = if other == Vec2::ZERO { 0.0 } else { velocity.dot(other) / other.hypot2() };
            step = step.min(self.a.span(t) / samples);
            let room = 0.5 * self.b.span(u) / samples;
            if ratio.abs() * step > room {
                // The step is limited by the distance that b covers within the room; its speed at u would not do, since
                // it may be 0 there.
                let reach = [u - room, u + room].map(|v| length(b.point(v) - b.point(u)));
                step = step.min(reach[0].max(reach[1]) / length(velocity)).max(first_step);
            }
            let next = (t + sense * step).clamp(0.0, 1.0);
            let p = a.point(next);
            let (foot, gap) = foot(b, p, u + (ratio * (next - t)).clamp(-room, room));
            let jumps = (foot - u).abs() > self.b.span(u).max(self.b.span(foot)) / samples;
            let beside = self.same && foot - next <= (from[1] - from[0]) / samples;
            let at_end = is_end(foot);
            if gap <= self.held && !at_end && !jumps && !beside {
                here = [next, foot];
                passed.push(here);
                step *= 2.0;
                continue;
            }
            if at_end
                && !jumps
                && let Some(end) = self.end_of_b_between(foot, t, next)
            {
                if end != here {
                    passed.push(end);
                }
                return Ok((passed, Stop::End));
            }
            // The border of the contact is needed to a small part of its length only, to recognise the contact later.
            // But a gap far beyond the tolerance may come from a wrong foot in a sharp bend.
            let is_border = gap <= 2.0 * self.held && !jumps && step <= (t - from[0]).abs() / 256.0;
            if is_border || step <= first_step {
                return Ok((passed, Stop::Away([next, foot])));
            }
            step *= 0.25;
        }
        Err(MeetingBudget { at: a.point(here[0]) })
    }

    /// The pair at the end `e` of b (0 or 1), if that end lies beside a between two parameters.
    fn end_of_b_between(&self, e: f64, t: f64, next: f64) -> Option<[f64; 2]> {
        let (beside, gap) = foot(self.a.curve, self.b.curve.point(e), t);
        // By distance, not by parameter: near a repeated control point a curve stays within the tolerance over a long
        // range.
        let between = beside.clamp(t.min(next), t.max(next));
        (gap <= self.tolerance && is_near(self.a.curve, beside, between, self.tolerance)).then_some([between, e])
    }

    fn what_is(&self, walk: &[[f64; 2]], at: [f64; 2], root: bool, before: Stop, after: Stop) -> Finding {
        let mut ends = self.ends_in(walk, at, before, after);
        let held = !ends.is_empty();
        if matches!((before, after), (Stop::Away(_), _) | (_, Stop::Away(_))) {
            ends.extend(self.knots_in(walk));
        }
        ends.sort_by(|p, q| p[0].total_cmp(&q[0]));
        if let (Some(&from), Some(&to)) = (ends.first(), ends.last())
            && self.is_long(walk, from, to)
        {
            let (from, to) = (self.snapped(from, &ends), self.snapped(to, &ends));
            return Finding::Stretch(Overlap { t: [from[0], to[0]], u: [from[1], to[1]] });
        }
        if held {
            return self.meeting_at_end(walk, &ends);
        }
        let (Stop::Away(before), Stop::Away(after)) = (before, after) else { return Finding::Nothing };
        Finding::Point(self.meeting_inside(walk, at, root, before, after))
    }

    /// The ends of the curves in the contact, as pairs.
    fn ends_in(&self, walk: &[[f64; 2]], at: [f64; 2], before: Stop, after: Stop) -> Vec<[f64; 2]> {
        let (first, last) = (walk[0], walk[walk.len() - 1]);
        let mut ends = Vec::new();
        if let Stop::End = before {
            ends.push(first);
        }
        if let Stop::End = after {
            ends.push(last);
        }
        // A walk along a may miss an end of b where the curves cross steeply. Where they cross at the angle θ, b stays
        // within the tolerance over tolerance/sin θ, and the walk covers the part cos θ of it; the rest is tan(θ/2) ≤ 1
        // times the tolerance. Also, the walk stops at an end of b although an end of a may be as near.
        let (a, b) = (self.a.curve, self.b.curve);
        let is_near = |curve: &Curve, x: f64, e: f64| is_near(curve, x, e, 2.0 * self.tolerance);
        for e in [0.0, 1.0] {
            let steps = [first, at, last];
            if !ends.iter().any(|w| w[1] == e)
                && let Some(w) = steps.iter().find(|w| is_near(b, w[1], e))
            {
                ends.extend(self.beside(a, b.point(e), w[0]).map(|t| [t, e]));
            }
            if !ends.iter().any(|w| w[0] == e)
                && let Some(w) = steps.iter().find(|w| is_near(a, w[0], e))
            {
                ends.extend(self.beside(b, a.point(e), w[1]).map(|u| [e, u]));
            }
        }
        ends
    }

    /// The parameter of the foot of a place on a curve, if it is within the tolerance.
    fn beside(&self, curve: &Curve, place: Point, guess: f64) -> Option<f64> {
        let (x, gap) = foot(curve, place, guess);
        (gap <= self.tolerance).then_some(x)
    }

    /// The knots of either curve inside the contact, as pairs: a shared stretch may end at a knot. Only knots with a
    /// gap far below the tolerance count; otherwise a shallow crossing of short spans would be taken for a shared
    /// stretch.
    fn knots_in(&self, walk: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let (a, b) = (self.a.curve, self.b.curve);
        let (first, last) = (walk[0], walk[walk.len() - 1]);
        let close = 0.125 * self.tolerance; // An eighth: the outermost parts of a crossing's contact do not count.
        let mut knots = Vec::new();
        for &k in self.a.inner_knots().iter().filter(|&&k| first[0] < k && k < last[0]) {
            let beside = walk[walk.partition_point(|w| w[0] < k).min(walk.len() - 1)];
            let (u, gap) = foot(b, a.point(k), beside[1]);
            if gap <= close {
                knots.push([k, u]);
            }
        }
        let (low, high) = (first[1].min(last[1]), first[1].max(last[1]));
        for &k in self.b.inner_knots().iter().filter(|&&k| low < k && k < high) {
            let beside = walk.iter().min_by(|p, q| (p[1] - k).abs().total_cmp(&(q[1] - k).abs()));
            let (t, gap) = foot(a, b.point(k), beside.map_or(first[0], |w| w[0]));
            if gap <= close && first[0] < t && t < last[0] {
                knots.push([t, k]);
            }
        }
        knots
    }

    /// A pair at an end of a stretch, moved to ends of curves among `ends` if they lie within the tolerance of it.
    fn snapped(&self, pair: [f64; 2], ends: &[[f64; 2]]) -> [f64; 2] {
        let (a, b) = (self.a.curve, self.b.curve);
        let t = ends.iter().map(|w| w[0]).find(|&e| is_end(e) && is_near(a, pair[0], e, self.tolerance));
        let u = ends.iter().map(|w| w[1]).find(|&e| is_end(e) && is_near(b, pair[1], e, self.tolerance));
        let snapped = [t.unwrap_or(pair[0]), u.unwrap_or(pair[1])];
        if self.gap(snapped) <= self.tolerance { snapped } else { pair }
    }

    /// Whether the walk goes farther than the tolerance from its start between two pairs.
    fn is_long(&self, walk: &[[f64; 2]], from: [f64; 2], to: [f64; 2]) -> bool {
        let a = self.a.curve;
        let start = a.point(from[0]);
        let inside = walk.iter().map(|w| w[0]).filter(|&t| from[0] < t && t < to[0]);
        from[0] < to[0]
            && from[1] != to[1]
            && inside.chain([to[0]]).any(|t| length(a.point(t) - start) > self.tolerance)
    }

    /// The meeting of a contact that is no longer than the tolerance and contains the given ends.
    fn meeting_at_end(&self, walk: &[[f64; 2]], ends: &[[f64; 2]]) -> Finding {
        let Some(&first) = ends.iter().find(|w| is_end(w[0])).or(ends.first()) else { return Finding::Nothing };
        let [t, u] = self.snapped(first, ends);
        let (a, b) = (self.a.curve, self.b.curve);
        if self.same && (t == 0.0 && u == 1.0 || u <= t || is_near(a, t, u, self.tolerance)) {
            // The seam of a closed curve, or a curve that slows down towards its end: its points are only neighbours.
            return Finding::Nothing;
        }
        // The place is that of the end, exactly.
        let at = if is_end(t) { a.point(t) } else { b.point(u) };
        Finding::Point(Meeting { at, t, u, kind: MeetingKind::Touching, contact: whole(walk) })
    }

    /// The meeting of a contact inside both curves. `before` and `after` are the first pairs outside.
    fn meeting_inside(
        &self,
        walk: &[[f64; 2]],
        at: [f64; 2],
        root: bool,
        before: [f64; 2],
        after: [f64; 2],
    ) -> Meeting {
        let side = |[t, u]: [f64; 2]| {
            let b = self.b.curve;
            tangent(b, u).cross(self.a.curve.point(t) - b.point(u))
        };
        let crosses = side(before) * side(after) < 0.0;
        let place = if crosses {
            if root { Some(at) } else { self.change_of_sign(before, after, side) }
        } else {
            let (first, last) = (walk[0], walk[walk.len() - 1]);
            let parallel = |[t, u]: [f64; 2]| tangent(self.a.curve, t).cross(tangent(self.b.curve, u));
            self.change_of_sign(first, last, parallel)
        };
        let [t, u] = place.filter(|&w| self.gap(w) <= self.tolerance).unwrap_or_else(|| self.closest(walk));
        let kind = if crosses { MeetingKind::Crossing } else { MeetingKind::Touching };
        let at = self.a.curve.point(t).midpoint(self.b.curve.point(u));
        Meeting { at, t, u, kind, contact: whole(walk) }
    }

    fn gap(&self, [t, u]: [f64; 2]) -> f64 {
        length(self.a.curve.point(t) - self.b.curve.point(u))
    }

    fn closest(&self, walk: &[[f64; 2]]) -> [f64; 2] {
        let best = walk.iter().min_by(|p, q| self.gap(**p).total_cmp(&self.gap(**q)));
        best.copied().unwrap_or_default()
    }

    /// Bisects between two pairs of a walk to the place where `value` changes sign; `None` where it does not.
    fn change_of_sign(
        &self,
        mut low: [f64; 2],
        mut high: [f64; 2],
        value: impl Fn([f64; 2]) -> f64,
    ) -> Option<[f64; 2]> {
        let (at_low, at_high) = (value(low), value(high));
        if at_low == 0.0 || at_high == 0.0 || (at_low > 0.0) == (at_high > 0.0) {
            return None;
        }
        for _ in 0..NEWTON_STEPS {
            let t = 0.5 * (low[0] + high[0]);
            if t <= low[0] || t >= high[0] {
                break;
            }
            let (u, _) = foot(self.b.curve, self.a.curve.point(t), 0.5 * (low[1] + high[1]));
            let at_middle = value([t, u]);
            if at_middle == 0.0 {
                return Some([t, u]);
            }
            if (at_middle > 0.0) == (at_low > 0.0) {
                low = [t, u];
            } else {
                high = [t, u];
            }
        }
        Some(low)
    }

    /// Newton's method for a(t) = b(u), limited to two ranges `within`. Returns the pair, and whether the gap fell to a
    /// quarter of the tolerance.
    pub fn root(&self, mut t: f64, mut u: f64, within: [[f64; 2]; 2]) -> ([f64; 2], bool) {
        let (a, b) = (self.a.curve, self.b.curve);
        let mut gap = a.point(t) - b.point(u);
        for _ in 0..NEWTON_STEPS {
            let (da, db) = (a.derivative(t), b.derivative(u));
            let area = da.cross(db);
            if area == 0.0 {
                break;
            }
            let next_t = (t - gap.cross(db) / area).clamp(within[0][0], within[0][1]);
            let next_u = (u - gap.cross(da) / area).clamp(within[1][0], within[1][1]);
            let next = a.point(next_t) - b.point(next_u);
            // Near the solution only rounding changes the gap.
            if next.hypot2() >= gap.hypot2() && length(gap) <= 0.25 * self.tolerance {
                break;
            }
            if next_t == t && next_u == u {
                break;
            }
            (t, u, gap) = (next_t, next_u, next);
        }
        ([t, u], length(gap) <= 0.25 * self.tolerance)
    }
}

/// The stretch that a walk covers.
fn whole(walk: &[[f64; 2]]) -> Overlap {
    let (first, last) = (walk[0], walk[walk.len() - 1]);
    Overlap { t: [first[0], last[0]], u: [first[1], last[1]] }
}

fn is_end(x: f64) -> bool {
    x == 0.0 || x == 1.0
}

/// Whether the points at two parameters and halfway between are within `distance` of each other. The ends of a closed
/// curve are not.
pub(super) fn is_near(curve: &Curve, x: f64, y: f64, distance: f64) -> bool {
    let from = curve.point(x);
    length(curve.point(y) - from) <= distance && length(curve.point(0.5 * (x + y)) - from) <= distance
}

/// The unit tangent at t.
fn tangent(curve: &Curve, t: f64) -> Vec2 {
    let derivative = curve.derivative(t);
    let speed = length(derivative);
    if speed > 0.0 {
        return derivative / speed;
    }
    curve.tangent(t, if t < 1.0 { End::Start } else { End::Finish })
}

/// The parameter near `guess` at which the curve is closest to p (a local minimum, or an end), and the distance there.
pub(super) fn foot(curve: &Curve, p: Point, guess: f64) -> (f64, f64) {
    let mut u = guess.clamp(0.0, 1.0);
    if curve.derivative(u) == Vec2::ZERO {
        u = u.clamp(INWARD, 1.0 - INWARD);
    }
    let mut away = curve.point(u) - p;
    for _ in 0..NEWTON_STEPS {
        let velocity = curve.derivative(u);
        let bent = velocity.hypot2() + away.dot(curve.second_derivative(u));
        // Beyond the center of curvature Newton's method would ascend; a Gauss–Newton step descends.
        let slope_change = if bent > 0.25 * velocity.hypot2() { bent } else { velocity.hypot2() };
        if slope_change == 0.0 {
            break;
        }
        let mut step = -away.dot(velocity) / slope_change;
        let mut moved = false;
        // A step that does not descend is quartered, at most four times: what remains is rounding.
        for _ in 0..4 {
            let next = (u + step).clamp(0.0, 1.0);
            if next == u {
                break;
            }
            let next_away = curve.point(next) - p;
            if next_away.hypot2() < away.hypot2() {
                (u, away, moved) = (next, next_away, true);
                break;
            }
            step *= 0.25;
        }
        if !moved {
            break;
        }
    }
    (u, length(away))
}

/// Where the derivative is 0 at an end (a repeated control point), the search starts this far inside.
const INWARD: f64 = 1.0 / 4096.0;
