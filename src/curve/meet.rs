//! Meetings of two curves, and of a curve with itself.
//!
//! **Method.** Both curves become trees of smaller and smaller Bézier pieces ([`hull`]). Pairs of pieces are compared
//! from the roots down. A pair is dropped where the boxes, or the strips along either chord, are farther apart than the
//! tolerance. A pair is solved
//! * by Newton's method where both pieces are slender and no direction is in both cones of tangents. Such pieces meet
//!   at most once, since the chord between two meetings would lie in both cones. Apart from that crossing they come
//!   close only at ends;
//! * at the ends of both pieces where both are straight to within a quarter of the tolerance. Their gap is then nearly
//!   linear: if it is within the tolerance anywhere, it is so at an end, or where their chords cross. (Where they cross
//!   at an angle the first case applies, unless one has a bend far narrower than the tolerance.)
//!
//! In every other pair the longer piece is halved. A solution is only a first guess. It is followed along both curves,
//! which distinguishes a meeting from a shared stretch ([`contact`]). Pairs of pieces within a contact that was already
//! followed are dropped. Guesses for two circles, or a line and a circle, come from a closed form instead
//! ([`circles`]).
//!
//! ```text
//!   boxes apart     strips apart     cones apart     straight        else
//!   ┌───┐               ╱╱   ╱╱      q ╲   ╱ p       p ────────        ╭───╮ p
//!   │ p │              ╱╱   ╱╱          ╲ ╱                          ╭─┼───╯
//!   └───┘ ┌───┐     p ╱╱ q ╱╱            ╳           q ────────      ╰─╯ q
//!         │ q │                         ╱ ╲
//!         └───┘
//!   dropped         dropped          Newton          ends            halved
//! ```
//!
//! **Invariant.** Whenever a pair is taken from the stack, every meeting of the curves is in a contact already
//! followed, or within a pair on the stack, or within the pair just taken.
//!
//! **Termination.** Halving ends where pieces are straight or as small as a quarter of the tolerance, which is at least
//! a few units in the last place of the coordinates. For curves that run along each other just outside the tolerance
//! the number of pairs grows like the square root of length/gap, so there is a budget. When it is spent,
//! [`MeetingBudget`] names the place.

mod circles;
mod contact;
mod hull;
#[cfg(test)]
mod tests;

use super::Curve;
use crate::geometry::boxes::distance_to_box;
use crate::geometry::{Point, Vec2};
use contact::{Contacts, Track, foot};
use hull::{HullNode, Hulls, length};

/// How two curves meet.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Meeting {
    /// The place: within the tolerance of the points at t and u, and exactly the end point where the meeting is at an
    /// end.
    pub at: Point,
    /// The parameter on the first curve; exactly 0 or 1 where the contact contains that end.
    pub t: f64,
    /// The parameter on the second curve; likewise.
    pub u: f64,
    /// Whether the curves change sides at this place.
    pub kind: MeetingKind,
    /// The stretch around the meeting over which the curves stay within the tolerance of each other.
    pub contact: Overlap,
}

/// How two curves lie relative to each other at a meeting.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MeetingKind {
    /// The curves change sides, inside both.
    Crossing,
    /// A tangential contact, an end of one inside the other, or common ends.
    Touching,
}

/// A stretch that two curves share within the tolerance: the range of t on the first (ascending), and u at both ends of
/// it (descending where the curves run in opposite directions).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Overlap {
    /// The parameters on the first curve where the stretch begins and ends, ascending.
    pub t: [f64; 2],
    /// The parameters on the second curve at the places of `t[0]` and `t[1]`.
    pub u: [f64; 2],
}

/// Everything that two curves have in common, by ascending t.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Meetings {
    /// The places where the curves meet, by ascending t on the first curve.
    pub points: Vec<Meeting>,
    /// The stretches that the curves share, by ascending t on the first curve.
    pub overlaps: Vec<Overlap>,
}

/// The curves run so near to each other for so long that the search for their meetings is too expensive.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error("the curves run too close to each other near ({}, {}) to tell where they meet; a larger tolerance makes them one", at.x, at.y)]
pub struct MeetingBudget {
    /// Where the search ended.
    pub at: Point,
}

/// The largest number of pairs of pieces that are compared: some 0.1 s of work. Curves that run beside each other at
/// 1e-13 of their size exceed it.
const PAIRS: usize = 1 << 18;
/// The largest number of contacts that are searched, for all pairs together: some 0.5 s of work. Circles a few
/// roundings apart touch in thousands of places.
const LOOKS: usize = 1 << 29;
/// The largest number of control points that are stored, some 40 bytes each. Only curves of a degree above ten reach it
/// before [`PAIRS`].
const CONTROL_POINTS: usize = 1 << 22;

/// Every meeting of two curves with a gap of at most `tolerance`, a length; a few units in the last place of the
/// coordinates are always allowed. Each connected contact is one meeting: two crossings with a lens between them that
/// is no deeper than the tolerance are one touching. A contact that contains an end of a curve is reported at that end.
///
/// # Errors
/// [`MeetingBudget`] where the curves run along each other just outside the tolerance for too long.
pub fn meetings(a: &Curve, b: &Curve, tolerance: f64) -> Result<Meetings, MeetingBudget> {
    // Most pairs are far apart. Twice the tolerance, because arcs whose ends were moved may lie off their control
    // points by one.
    if a.is_clear_of(b, 2.0 * tolerance) {
        return Ok(Meetings::default());
    }
    let mut search = Search::new(a, b, vec![Hulls::of(a), Hulls::of(b)], tolerance, false);
    match circles::guesses(&search.contacts) {
        Some(guesses) => guesses.into_iter().try_for_each(|guess| search.follow(guess))?,
        None => search.run()?,
    }
    Ok(search.finish())
}

/// The meetings of a curve with itself, with t < u: crossings and touchings. The ends of a stretch that it runs along
/// twice are touchings. The common end of a closed curve is no meeting, nor is the place where a loop no wider than the
/// tolerance closes. The curve must have neither cusps nor jumps of its tangent.
///
/// # Errors
/// [`MeetingBudget`] as for [`meetings`].
pub fn self_meetings(a: &Curve, tolerance: f64) -> Result<Vec<Meeting>, MeetingBudget> {
    if !a.as_kind().may_meet_itself() {
        return Ok(Vec::new());
    }
    let mut search = Search::new(a, a, vec![Hulls::of(a)], tolerance, true);
    search.run()?;
    let tolerance = search.contacts.tolerance;
    let Meetings { mut points, overlaps } = search.finish();
    for Overlap { t, u } in overlaps {
        let ends = [(t[0], u[0]), (t[1], u[1])].into_iter().filter(|(t, u)| t < u);
        points.extend(ends.map(|(t, u)| Meeting {
            at: a.point(t),
            t,
            u,
            kind: MeetingKind::Touching,
            contact: Overlap { t: [t; 2], u: [u; 2] },
        }));
    }
    // Where the curve turns back within the tolerance it is near to itself without meeting itself.
    points.retain(|m| !contact::is_near(a, m.t, m.u, tolerance));
    points.sort_by(|p, q| p.t.total_cmp(&q.t).then(p.u.total_cmp(&q.u)));
    Ok(points)
}

struct Search<'c> {
    /// The trees of a and of b; only one where they are the same curve.
    hulls: Vec<Hulls>,
    contacts: Contacts<'c>,
}

impl<'c> Search<'c> {
    fn new(a: &'c Curve, b: &'c Curve, hulls: Vec<Hulls>, tolerance: f64, same: bool) -> Self {
        // De Casteljau's algorithm has an error of up to 2n units of rounding at degree n, and so has a part cut out of
        // a curve. A gap is the distance of two such points. A unit of rounding is half of EPSILON: 4(n + 1) of them is
        // the noise of a gap, and four times that a safe tolerance.
        let most = |value: fn(&Hulls) -> f64| hulls.iter().map(value).fold(0.0, f64::max);
        let noise = 2.0 * (most(|h| h.degree as f64) + 1.0) * f64::EPSILON * most(|h| h.magnitude);
        let track = |curve, hulls: &Hulls| Track::new(curve, hulls.degree, hulls[hulls.root()].size);
        let (on_a, on_b) = (track(a, &hulls[0]), track(b, &hulls[hulls.len() - 1]));
        Self { contacts: Contacts::new(on_a, on_b, tolerance.max(4.0 * noise), noise, same), hulls }
    }

    /// The index of the tree of b.
    fn second(&self) -> usize {
        self.hulls.len() - 1
    }

    fn run(&mut self) -> Result<(), MeetingBudget> {
        let second = self.second();
        let mut stack = vec![[self.hulls[0].root(), self.hulls[second].root()]];
        let (mut compared, mut looks) = (0, 0);
        while let Some([i, j]) = stack.pop() {
            compared += 1;
            looks += self.contacts.followed();
            let kept: usize = self.hulls.iter().map(Hulls::control_points).sum();
            if compared > PAIRS || looks > LOOKS || kept > CONTROL_POINTS {
                return Err(MeetingBudget { at: self.hulls[0][i].bounds.center() });
            }
            if self.contacts.same && i == j {
                // If all legs lie in a half plane, the piece cannot meet itself.
                if self.hulls[0][i].cone.is_none() && !self.is_point(i) {
                    let [left, right] = self.hulls[0].halves(i);
                    stack.extend([[right, right], [left, right], [left, left]]);
                }
                continue;
            }
            if let Some(halve) = self.compare(i, j)? {
                let halves = self.hulls[halve * second].halves([i, j][halve]);
                for half in halves {
                    stack.push(if halve == 0 { [half, j] } else { [i, half] });
                }
            }
        }
        Ok(())
    }

    fn is_point(&self, i: usize) -> bool {
        self.hulls[0][i].size <= 0.25 * self.contacts.tolerance
    }

    /// Solves or drops a pair of pieces, or returns which of the two to halve.
    fn compare(&mut self, i: usize, j: usize) -> Result<Option<usize>, MeetingBudget> {
        let tolerance = self.contacts.tolerance;
        let (p, q) = (&self.hulls[0][i], &self.hulls[self.second()][j]);
        if are_apart(p, q, tolerance) || (self.contacts.same && self.are_joined(p, q)) {
            return Ok(None);
        }
        if p.cone.is_some() && q.cone.is_some() && self.contacts.knows_box(p.t, q.t) {
            return Ok(None);
        }
        // A quarter of the tolerance for the width of each piece, and a quarter for the distance at each of the two
        // ends.
        let straight = [p.is_straight(0.25 * tolerance), q.is_straight(0.25 * tolerance)];
        let mut guesses = Vec::new();
        if p.is_slender() && q.is_slender() && no_common_direction(p, q) {
            self.guess_at_ends(p, q, false, &mut guesses);
            let converged = self.guess_crossing(p, q, &mut guesses);
            if !converged && straight != [true; 2] {
                return Ok(Some(longer(p, q, straight)));
            }
        } else if straight == [true; 2] {
            self.guess_at_ends(p, q, true, &mut guesses);
            self.guess_between_chords(p, q, &mut guesses);
        } else {
            return Ok(Some(longer(p, q, straight)));
        }
        guesses.into_iter().try_for_each(|guess| self.follow(guess))?;
        Ok(None)
    }

    /// Whether two pieces of one curve are consecutive and turn too little to meet anywhere else.
    fn are_joined(&self, p: &HullNode, q: &HullNode) -> bool {
        let closed = |p: &HullNode, q: &HullNode| p.t[0] == 0.0 && q.t[1] == 1.0 && p.hull.first() == q.hull.last();
        if p.t[1] != q.t[0] && !closed(p, q) {
            return false;
        }
        if p.size.max(q.size) <= 0.25 * self.contacts.tolerance {
            return true;
        }
        let (Some(c), Some(d)) = (p.cone, q.cone) else { return false };
        // All legs lie in the open half plane ahead of the mean of the chords: no two points of the joined pieces
        // coincide.
        let ahead = (p.last() - p.first()).normalize() + (q.last() - q.first()).normalize();
        [c.right, c.left, d.right, d.left].iter().all(|leg| leg.dot(ahead) > 0.0)
    }

    /// Guesses at the ends of either piece that lie within the tolerance of the other curve: `all` ends, or only ends
    /// of spans.
    fn guess_at_ends(&self, p: &HullNode, q: &HullNode, all: bool, guesses: &mut Vec<Guess>) {
        let tolerance = self.contacts.tolerance;
        for (piece, other, curve, of_a) in [(p, q, self.contacts.b.curve, true), (q, p, self.contacts.a.curve, false)] {
            for (end, place) in [(0, piece.first()), (1, piece.last())] {
                if !(all || piece.span_end[end]) || !is_beside(place, other, tolerance) {
                    continue;
                }
                let (beside, gap) = foot(curve, place, beside_chord(other, place));
                if gap <= tolerance {
                    let [t, u] = if of_a { [piece.t[end], beside] } else { [beside, piece.t[end]] };
                    guesses.push(Guess::at(t, u));
                }
            }
        }
    }

    /// A guess where the chords of two straight pieces cross, if the curves are within the tolerance there.
    fn guess_between_chords(&self, p: &HullNode, q: &HullNode, guesses: &mut Vec<Guess>) {
        let (pp, qq) = (p.last() - p.first(), q.last() - q.first());
        let (between, area) = (q.first() - p.first(), pp.cross(qq));
        let [along_p, along_q] = [between.cross(qq) / area, between.cross(pp) / area];
        if !((0.0..=1.0).contains(&along_p) && (0.0..=1.0).contains(&along_q)) {
            return;
        }
        let place = p.first() + along_p * pp;
        let (t, _) = foot(self.contacts.a.curve, place, p.t[0] + along_p * (p.t[1] - p.t[0]));
        let (u, gap) =
            foot(self.contacts.b.curve, self.contacts.a.curve.point(t), q.t[0] + along_q * (q.t[1] - q.t[0]));
        if gap <= self.contacts.tolerance {
            guesses.push(Guess::at(t, u));
        }
    }

    /// A guess at the crossing of two slender pieces without a common direction, if there is one. Returns whether
    /// Newton's method converged, so that the answer is certain.
    fn guess_crossing(&self, p: &HullNode, q: &HullNode, guesses: &mut Vec<Guess>) -> bool {
        let (pp, qq) = (p.last() - p.first(), q.last() - q.first());
        let between = q.first() - p.first();
        let area = pp.cross(qq);
        let at = |piece: &HullNode, fraction: f64| piece.t[0] + fraction.clamp(0.0, 1.0) * (piece.t[1] - piece.t[0]);
        let (t, u) = (at(p, between.cross(qq) / area), at(q, between.cross(pp) / area));
        let room = |piece: &HullNode| {
            let width = piece.t[1] - piece.t[0];
            [(piece.t[0] - width).max(0.0), (piece.t[1] + width).min(1.0)]
        };
        let tolerance = self.contacts.tolerance;
        let ([t, u], converged) = self.contacts.root(t, u, [room(p), room(q)]);
        if !converged {
            return false;
        }
        let (a, b) = (self.contacts.a.curve, self.contacts.b.curve);
        let place = a.point(t);
        let (da, db) = (a.derivative(t), b.derivative(u));
        let sine = (da.cross(db) / (length(da) * length(db))).abs();
        // The curves stay within the tolerance of each other over a length of tolerance/sin θ; twice that allows for
        // their curvature.
        let reach = 2.0 * tolerance / sine;
        // A crossing at a joint of two pieces may round to either side of it: both may report it.
        let inside = |piece: &HullNode, t: f64| {
            let slack = (piece.t[1] - piece.t[0]) * (reach / piece.size).min(1.0);
            piece.t[0] - slack <= t && t <= piece.t[1] + slack
        };
        if inside(p, t) && inside(q, u) {
            let is_in = |piece: &HullNode, t: f64| {
                let far = [piece.first(), piece.last()].iter().all(|&end| length(end - place) > reach);
                far && piece.t[0] <= t && t <= piece.t[1]
            };
            let is_clear = is_in(p, t) && is_in(q, u);
            guesses.push(Guess { t, u, root: true, clear: if is_clear { reach } else { 0.0 } });
        }
        true
    }

    fn follow(&mut self, guess: Guess) -> Result<(), MeetingBudget> {
        let Guess { t, u, root, clear } = guess;
        if self.contacts.same && u <= t {
            return Ok(());
        }
        if clear > 0.0 {
            if !self.contacts.knows(t, u) {
                self.contacts.add_clear_crossing(t, u, clear);
            }
            return Ok(());
        }
        self.contacts.add(t, u, root)
    }

    /// The meetings by ascending t. A meeting at the common end of a closed curve is reported once, at the smaller
    /// parameter.
    fn finish(self) -> Meetings {
        let Contacts { mut points, mut overlaps, a, b, tolerance, .. } = self.contacts;
        points.sort_by(|p, q| p.t.total_cmp(&q.t).then(p.u.total_cmp(&q.u)));
        overlaps.sort_by(|p, q| p.t[0].total_cmp(&q.t[0]).then(p.u[0].total_cmp(&q.u[0])));
        let near = |track: &Track, t: f64, other: f64| {
            let seam = t.min(other) == 0.0 && t.max(other) == 1.0 && track.curve.start() == track.curve.end();
            seam || contact::is_near(track.curve, t, other, tolerance)
        };
        let is_one = |at: Point, t: f64, u: f64, other: &Meeting| {
            length(at - other.at) <= tolerance && near(&a, t, other.t) && near(&b, u, other.u)
        };
        let mut kept: Vec<Meeting> = Vec::new();
        for point in points {
            let ends_stretch = |o: &Overlap| (0..2).any(|k| is_one(a.curve.point(o.t[k]), o.t[k], o.u[k], &point));
            if !kept.iter().any(|k| is_one(k.at, k.t, k.u, &point)) && !overlaps.iter().any(ends_stretch) {
                kept.push(point);
            }
        }
        Meetings { points: kept, overlaps }
    }
}

/// A pair of parameters with a gap within the tolerance, from which to follow a contact.
struct Guess {
    t: f64,
    u: f64,
    /// Whether it solves a(t) = b(u) as well as can be.
    root: bool,
    /// If positive: this is a crossing, with no end and no other meeting within this distance.
    clear: f64,
}

impl Guess {
    fn at(t: f64, u: f64) -> Self {
        Self { t, u, root: false, clear: 0.0 }
    }
}

/// Whether the boxes of two pieces, or the strips along their chords, show that they are farther apart than `gap`.
fn are_apart(p: &HullNode, q: &HullNode, gap: f64) -> bool {
    let (r, s) = (p.bounds, q.bounds);
    r.x0 > s.x1 + gap
        || s.x0 > r.x1 + gap
        || r.y0 > s.y1 + gap
        || s.y0 > r.y1 + gap
        || strip_is_clear(p, q, gap)
        || strip_is_clear(q, p, gap)
}

/// Whether the strip along the chord of `p` stays farther than `gap` from `q`.
fn strip_is_clear(p: &HullNode, q: &HullNode, gap: f64) -> bool {
    if p.normal == Vec2::ZERO || q.is_group() {
        return false;
    }
    let distance = |&x: &Point| p.normal.dot(x - p.first());
    let low = q.hull.iter().map(distance).fold(f64::INFINITY, f64::min);
    let high = q.hull.iter().map(distance).fold(f64::NEG_INFINITY, f64::max);
    low > p.spread[1] + gap || high < p.spread[0] - gap
}

fn is_beside(x: Point, piece: &HullNode, gap: f64) -> bool {
    let d = if piece.normal == Vec2::ZERO { 0.0 } else { piece.normal.dot(x - piece.first()) };
    distance_to_box(x, piece.bounds) <= gap && piece.spread[0] - gap <= d && d <= piece.spread[1] + gap
}

/// The parameter of the point nearest to x if the piece were its chord.
fn beside_chord(piece: &HullNode, x: Point) -> f64 {
    let chord = piece.last() - piece.first();
    let fraction = if chord == Vec2::ZERO { 0.5 } else { (x - piece.first()).dot(chord) / chord.hypot2() };
    piece.t[0] + fraction.clamp(0.0, 1.0) * (piece.t[1] - piece.t[0])
}

/// Whether no direction, up to sign, is in the cones of tangents of both pieces.
fn no_common_direction(p: &HullNode, q: &HullNode) -> bool {
    let (Some(c), Some(d)) = (p.cone, q.cone) else { return false };
    let signs = [c.right, c.left].map(|u| [d.right, d.left].map(|v| u.cross(v)));
    let signs = signs.as_flattened();
    signs.iter().all(|&s| s > 0.0) || signs.iter().all(|&s| s < 0.0)
}

/// Which of two pieces to halve: the longer one of those that are not straight yet.
fn longer(p: &HullNode, q: &HullNode, straight: [bool; 2]) -> usize {
    match straight {
        [true, false] => 1,
        [false, true] => 0,
        _ => usize::from(q.size > p.size),
    }
}
