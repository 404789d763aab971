//! Turning, the total variation of the tangent angle (Pav & Walkington 2005, Definition 4); breaks of a curve; cuts of
//! it into parts of limited turning.
//!
//! The tangent of a Bézier curve has the direction of its hodograph. The hodograph is cut where it vanishes, and at
//! inflections (sign changes of its cross product with its derivative), into stretches: along each the tangent turns
//! one way only and stays within a half plane. The angle between the tangents at the two ends of a stretch is its
//! turning, without ambiguity.
//!
//! ```text
//!    ╭───╮                 From p to i the tangent turns right, from i to q left. i is an inflection: the curve has
//!   p│   │i   │q           two stretches here. (Where a stretch turns by π or more, it is cut further, into half
//!        │    │            planes.)
//!        ╰────╯
//! ```

use super::bernstein::{self, SignChange, crossing};
use super::span::Span;
use super::{Break, BreakKind, length, unit};
use crate::geometry::{Vec2, turn_from};

/// The relative excess of a part's turning over the limit that counts as rounding: three times that of a sum of a
/// thousand stretches.
const COUNT_SLACK: f64 = 1e-12;
/// The largest number of parts that one curve is cut into: more than a mesh in memory can have edges.
const PARTS_MAX: f64 = 1e8;
/// A knot where the tangent turns by less than this is no corner, although the turn counts as turning. Parts of splines
/// carry the rounding of the curves that they were cut from, which may have been much larger.
const CORNER_RAD: f64 = 1e-9;
/// The budget of parts in the search for half planes: some dozens of cusps, each approached by 48 halvings from both
/// sides.
const PIECE_BUDGET: usize = 1 << 13;

/// Part of a curve along which the tangent turns one way, by less than π.
struct Stretch {
    t0: f64,
    t1: f64,
    hodograph: Vec<Vec2>,
    /// The hodograph at both ends, or its limits there: tangent directions, not of unit length.
    from: Vec2,
    to: Vec2,
    /// Signed: positive to the left.
    angle_rad: f64,
    /// Angles below this are rounding.
    noise_rad: f64,
    /// The jump of the tangent (unsigned) where the stretch begins, and whether that breaks the curve.
    jump_rad: f64,
    breaks: Option<BreakKind>,
}

/// A part of a hodograph, over lo..hi of the parameter of its span.
struct HodographPart {
    lo: f64,
    hi: f64,
    hodograph: Vec<Vec2>,
}

/// See [`Curve::turning`](super::Curve::turning): in radians, with the jumps at inner knots.
pub(super) fn turning(spans: &[Span]) -> f64 {
    stretches(spans).iter().map(|s| s.angle_rad.abs() + s.jump_rad).sum()
}

/// See [`Curve::breaks`](super::Curve::breaks).
pub(super) fn breaks(spans: &[Span]) -> Vec<Break> {
    let of = |s: &Stretch| s.breaks.map(|kind| Break { t: s.t0, kind, turn_rad: s.jump_rad });
    stretches(spans).iter().filter_map(of).collect()
}

/// See [`Curve::inflections`](super::Curve::inflections).
pub(super) fn inflections(spans: &[Span]) -> Vec<f64> {
    let mut found = Vec::new();
    let mut before: Option<bool> = None;
    for stretch in stretches(spans) {
        if stretch.breaks.is_some() {
            before = None;
        }
        if stretch.angle_rad.abs() <= stretch.noise_rad {
            continue;
        }
        let left = stretch.angle_rad > 0.0;
        if before.is_some_and(|b| b != left) {
            found.push(stretch.t0);
        }
        before = Some(left);
    }
    found
}

/// See [`Curve::cuts_of_turning`](super::Curve::cuts_of_turning).
pub(super) fn cuts_of_turning(spans: &[Span], tau: f64) -> Vec<f64> {
    let all = stretches(spans);
    let mut cuts = Vec::new();
    let mut start = 0;
    for end in 1..=all.len() {
        if end < all.len() && all[end].breaks.is_none() {
            continue;
        }
        if start > 0 {
            cuts.push(all[start].t0);
        }
        cut_run(&all[start..end], tau, &mut cuts);
        start = end;
    }
    cuts.retain(|t| *t > 0.0 && *t < 1.0);
    cuts.dedup();
    cuts
}

/// The number of parts of turning at most `tau` that a turning of `total` takes; at least 1.
pub(super) fn parts_of_turning(total: f64, tau: f64) -> f64 {
    libm::ceil(total / tau * (1.0 - COUNT_SLACK)).max(1.0)
}

/// The turnings, from the start of a run, at which a run of turning `total` is cut.
pub(super) fn shares(total: f64, tau: f64) -> impl Iterator<Item = f64> {
    let parts = parts_of_turning(total, tau).min(PARTS_MAX);
    (1..parts as u32).map(move |k| total * (f64::from(k) / parts))
}

/// Cuts a run of stretches without a break inside into parts of equal turning.
///
/// ```text
///   run       ├── 0.9 ──┤────── 1.5 ──────┤── 0.6 ──┤      Three stretches with their turnings (rad), 3.0 in total. τ
///   shares    0          1.0         2.0           3.0     = 1.05 takes three parts of 1.0 each: both cuts lie in the
///                         ▲           ▲                    second stretch, where it has turned by 0.1 and by 1.1.
/// ```
fn cut_run(run: &[Stretch], tau: f64, cuts: &mut Vec<f64>) {
    // The jump at the start of the run is the break before it, if any.
    let jump = |i: usize| if i == 0 { 0.0 } else { run[i].jump_rad };
    let total: f64 = run.iter().enumerate().map(|(i, s)| jump(i) + s.angle_rad.abs()).sum();
    let (mut i, mut before) = (0, 0.0);
    for share in shares(total, tau) {
        while i + 1 < run.len() && share > before + jump(i) + run[i].angle_rad.abs() {
            before += jump(i) + run[i].angle_rad.abs();
            i += 1;
        }
        cuts.push(run[i].at_turning(share - before - jump(i)));
    }
}

impl Stretch {
    /// The parameter at which the tangent has turned by `turned` from the start of the stretch.
    fn at_turning(&self, turned: f64) -> f64 {
        let angle = self.angle_rad.abs();
        if turned <= 0.0 {
            return self.t0;
        }
        if turned >= angle {
            return self.t1;
        }
        let (sin, cos) = libm::sincos(turned.copysign(self.angle_rad));
        let from = unit(self.from);
        let wanted = Vec2::new(cos * from.x - sin * from.y, sin * from.x + cos * from.y);
        let past: Vec<f64> = self.hodograph.iter().map(|d| wanted.cross(*d)).collect();
        let change = SignChange { lo: 0.0, hi: 1.0, rising: self.angle_rad > 0.0 };
        let s = crossing(|s| bernstein::value(&past, s), &change);
        self.t0 + s * (self.t1 - self.t0)
    }
}

/// The stretches of a chain of spans, in order. A part of constant position has none.
fn stretches(spans: &[Span]) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    // When a curve is cut or moved, its rounding has the magnitude of its far end, even where it passes the origin.
    let noise = spans.iter().map(|span| span.bezier.hodograph_noise()).fold(0.0, f64::max);
    for span in spans {
        for (k, piece) in one_way_pieces(span.hodograph(), noise).into_iter().enumerate() {
            let Some((from, to)) = end_directions(&piece.hodograph, noise) else { continue };
            let noise_rad = noise / length(from) + noise / length(to);
            let mut stretch = Stretch {
                t0: span.t(piece.lo),
                t1: span.t(piece.hi),
                from,
                to,
                angle_rad: turn_from(from, to),
                // Control points of spans, parts and welded curves carry a few roundings each.
                noise_rad: 8.0 * noise_rad,
                jump_rad: 0.0,
                breaks: None,
                hodograph: piece.hodograph,
            };
            if let Some(before) = all.last_mut() {
                join(before, &mut stretch, k == 0, noise);
            }
            all.push(stretch);
        }
    }
    all
}

/// Measures the jump of the tangent between two neighbours, at a knot or where the hodograph vanishes.
fn join(before: &mut Stretch, after: &mut Stretch, at_knot: bool, noise: f64) {
    let vanishes = |d: Option<&Vec2>| d.is_some_and(|d| length(*d) <= noise);
    let vanished = vanishes(before.hodograph.last()) && vanishes(after.hodograph.first());
    before.t1 = after.t0;
    if !vanished && !at_knot {
        return;
    }
    after.jump_rad = turn_from(before.to, after.from).abs();
    // At a zero of the derivative an analytic tangent either continues or reverses, so π/2 separates the two cases.
    if vanished && after.jump_rad > std::f64::consts::FRAC_PI_2 {
        after.breaks = Some(BreakKind::Cusp);
    } else if after.jump_rad > (before.noise_rad + after.noise_rad).max(CORNER_RAD) {
        after.breaks = Some(if vanished && !at_knot { BreakKind::Cusp } else { BreakKind::TangentJump });
    }
}

/// The first and the last coefficient above noise: the limits of the tangent at both ends.
fn end_directions(hodograph: &[Vec2], noise: f64) -> Option<(Vec2, Vec2)> {
    let mut sure = hodograph.iter().filter(|d| length(**d) > noise);
    let from = *sure.next()?;
    Some((from, sure.next_back().copied().unwrap_or(from)))
}

/// The parts of [`half_plane_pieces`], cut further at inflections.
fn one_way_pieces(hodograph: Vec<Vec2>, noise: f64) -> Vec<HodographPart> {
    let mut pieces = Vec::new();
    for piece in half_plane_pieces(hodograph, noise) {
        let h = &piece.hodograph;
        let degree = h.len() - 1;
        if degree < 2 {
            // A linear hodograph has the constant cross product h₀ × h₁ with its derivative.
            pieces.push(piece);
            continue;
        }
        // H × H′/m = A × B for the polynomials A of the first m coefficients and B of the last m.
        let bend = bernstein::product(&h[..degree], &h[1..], |a, b| a.cross(b));
        let largest = bernstein::longest(h);
        let lost = 2.0 * noise * largest + 8.0 * f64::EPSILON * largest * largest * bend.len() as f64;
        let slope = bernstein::derivative(h);
        let exact = |s: f64| bernstein::value(h, s).cross(bernstein::value(&slope, s));
        let mut cuts: Vec<f64> =
            bernstein::sign_changes(&bend, lost).iter().map(|change| crossing(exact, change)).collect();
        cuts.retain(|s| *s > 0.0 && *s < 1.0);
        cuts.dedup();
        let at = |s: f64| piece.lo + s * (piece.hi - piece.lo);
        let starts: Vec<f64> = std::iter::once(0.0).chain(cuts.iter().copied()).collect();
        for (k, from) in starts.iter().enumerate() {
            let to = cuts.get(k).copied().unwrap_or(1.0);
            let hi = if to == 1.0 { piece.hi } else { at(to) };
            pieces.push(HodographPart { lo: at(*from), hi, hodograph: bernstein::restricted(h, *from, to) });
        }
    }
    pieces
}

/// Parts of a hodograph, each within an open half plane. Where the hodograph vanishes it is cut, and the end
/// coefficients there are exactly zero.
///
/// ```text
///     h₁ ●────────● h₂         The coefficients h₀ … h₃ lie in an open half plane, on one side of a line through 0.
///       ╱          ╲           The hodograph lies in their hull: its direction, the tangent, turns by less than π.
///   h₀ ●            ● h₃
///   ───────── 0 ─────────
/// ```
fn half_plane_pieces(hodograph: Vec<Vec2>, noise: f64) -> Vec<HodographPart> {
    let (pieces, mut zeros) = try_half_planes(&hodograph, 0.0, 1.0, noise);
    zeros.extend(
        pieces.windows(2).filter(|pair| pair[0].hi == pair[1].lo && vanish_between(pair, noise)).map(|p| p[0].hi),
    );
    if zeros.is_empty() {
        return pieces;
    }
    // Small parts near a zero have inaccurate directions. So the hodograph is cut again, at the zeros first.
    let mut bounds = vec![0.0];
    bounds.extend(zeros.into_iter().map(|s| zero_near(&hodograph, s)).filter(|s| *s > 0.0 && *s < 1.0));
    bounds.push(1.0);
    bounds.sort_by(f64::total_cmp);
    bounds.dedup();
    let mut pieces = Vec::new();
    for pair in bounds.windows(2) {
        let mut part = bernstein::restricted(&hodograph, pair[0], pair[1]);
        let last = part.len() - 1;
        if pair[0] > 0.0 {
            part[0] = Vec2::ZERO;
        }
        if pair[1] < 1.0 {
            part[last] = Vec2::ZERO;
        }
        pieces.extend(try_half_planes(&part, pair[0], pair[1], noise).0);
    }
    pieces
}

/// Whether the hodograph vanishes where two parts meet.
fn vanish_between(pair: &[HodographPart], noise: f64) -> bool {
    let vanishes = |d: Option<&Vec2>| d.is_some_and(|d| length(*d) <= noise);
    vanishes(pair[0].hodograph.last()) && vanishes(pair[1].hodograph.first())
}

/// Halves until each part lies in a half plane or is below noise. Returns the parts, and the middles of the gaps
/// inside.
fn try_half_planes(hodograph: &[Vec2], lo: f64, hi: f64, noise: f64) -> (Vec<HodographPart>, Vec<f64>) {
    /// A part that is in no half plane after so many halvings is one where the hodograph vanishes up to rounding.
    const DEPTH: u32 = 48;
    let mut pieces: Vec<HodographPart> = Vec::new();
    let mut gaps: Vec<(f64, f64)> = Vec::new();
    let mut stack = vec![(lo, hi, 0, hodograph.to_vec())];
    for _ in 0..PIECE_BUDGET {
        let Some((a, b, depth, part)) = stack.pop() else { break };
        let moves = part.iter().any(|d| length(*d) > noise);
        if moves && in_half_plane(&part, noise) {
            pieces.push(HodographPart { lo: a, hi: b, hodograph: part });
        } else if moves && depth < DEPTH {
            let mid = 0.5 * (a + b);
            let (left, right) = bernstein::split(&part, 0.5);
            stack.push((mid, b, depth + 1, right));
            stack.push((a, mid, depth + 1, left));
        } else {
            match gaps.last_mut() {
                Some(gap) if gap.1 == a => gap.1 = b,
                _ => gaps.push((a, b)),
            }
        }
    }
    let inner = gaps.into_iter().filter(|gap| gap.0 > lo && gap.1 < hi).map(|gap| 0.5 * (gap.0 + gap.1)).collect();
    (pieces, inner)
}

/// Whether all coefficients above noise lie in one half plane, farther than noise from its border.
fn in_half_plane(hodograph: &[Vec2], noise: f64) -> bool {
    let sure = || hodograph.iter().filter(|d| length(**d) > noise);
    let axis = unit(sure().fold(Vec2::ZERO, |sum, d| sum + unit(*d)));
    sure().all(|d| axis.dot(*d) > noise)
}

/// The minimum of |H| near s, by Gauss–Newton steps as long as they descend.
fn zero_near(hodograph: &[Vec2], s: f64) -> f64 {
    /// Quadratic convergence from a bracket of some 1e-8 needs two.
    const STEPS: usize = 8;
    let slope = bernstein::derivative(hodograph);
    let (mut best, mut size) = (s, length(bernstein::value(hodograph, s)));
    for _ in 0..STEPS {
        let (h, d) = (bernstein::value(hodograph, best), bernstein::value(&slope, best));
        let next = best - h.dot(d) / d.dot(d);
        let there = length(bernstein::value(hodograph, next));
        let nearer = there < size && (0.0..=1.0).contains(&next);
        if !nearer {
            break;
        }
        (best, size) = (next, there);
    }
    best
}
