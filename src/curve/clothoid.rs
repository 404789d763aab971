//! The clothoid, or Euler spiral: the curve whose curvature is linear in its arc length. It joins lines and circles in
//! rails, roads, turbine blades and wings.
//!
//! ```text
//!                              κ₁      t is the share of the length L; the curvature is κ(t) = κ₀ + (κ₁ − κ₀)t, so
//!                          _-  ●
//!                       .´   .´        the heading is  θ(t) = θ₀ + L(κ₀t + (κ₁ − κ₀)t²/2), and
//!            κ₀      _-´  _-´          the point is    P(t) = P₀ + L ∫₀ᵗ (cos θ, sin θ).
//!   P₀ ●────────---´  _-´
//!       θ₀                             Every piece turns by a third of a radian at most: a Bézier of degree 11.
//! ```
//!
//! It is no rational curve: the integral is Fresnel's. It is stored with a chain of Bézier pieces, made once. Each
//! piece has the clothoid's point and first five derivatives at both ends (two-point Hermite interpolation); the joints
//! are computed by Gauss–Legendre quadrature. The error of a piece is at most |P⁽¹²⁾|/12! · 2⁻¹², which is below
//! rounding. So [`Kind::inner_point`] is that of the chain, and all queries by span are accurate to rounding. Heading,
//! curvature, turning, inflection and length have closed forms.

use super::kind::Kind;
use super::span::Span;
use super::weld::Similarity;
use super::{Bezier, Break, Clothoid, Curve, CurveError, End, Spline, check_finite, check_points, length, turning};
use crate::geometry::{Point, Vec2, scaled};
use kurbo::common::GAUSS_LEGENDRE_COEFFS_8;
use std::f64::consts::{PI, TAU};

/// The degree of the pieces: six conditions at either end.
const DEGREE: usize = 11;
/// The number of derivatives at each end that a piece shares with the clothoid, including the point itself.
const CONDITIONS: usize = 6;
/// The largest turning of a piece, computed with the largest curvature of the clothoid.
const PIECE_TURN: f64 = 0.35;
/// The largest change of curvature along a piece, times its length: near an inflection this dominates.
const PIECE_CHANGE: f64 = 0.05;
/// The largest number of turns of a clothoid: it limits the number of pieces and the rounding of the heading.
const TURNS_MAX: f64 = 100.0;
/// The largest number of pieces, which `TURNS_MAX` allows.
const PIECES_MAX: f64 = 4096.0;
/// A curvature at an end of a part below this share of the largest is rounding, and taken as 0.
const NO_CURVATURE: f64 = 4.0 * f64::EPSILON;

/// The relative rounding error of an end, after some hundred moves and turns.
const ROUNDED_END: f64 = 512.0 * f64::EPSILON;

/// `v` turned by 90° to the left.
fn left(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// The unit vector `u`, turned by the angle from the x axis to the unit vector `by`.
fn turned(u: Vec2, by: Vec2) -> Vec2 {
    Vec2::new(by.x * u.x - by.y * u.y, by.y * u.x + by.x * u.y)
}

fn unit_at(angle_rad: f64) -> Vec2 {
    let (sin, cos) = libm::sincos(angle_rad);
    Vec2::new(cos, sin)
}

/// A clothoid of length 1 that starts at the origin along the x axis.
#[derive(Clone, Copy)]
struct Shape {
    /// The curvature at the start, and its change up to the end.
    start: f64,
    change: f64,
}

impl Shape {
    fn curvature(&self, t: f64) -> f64 {
        self.start + self.change * t
    }

    /// The signed turn over t0..t1, positive to the left.
    fn turn(&self, t0: f64, t1: f64) -> f64 {
        (t1 - t0) * (self.start + 0.5 * self.change * (t0 + t1))
    }

    fn tangent(&self, t: f64) -> Vec2 {
        unit_at(self.turn(0.0, t))
    }

    /// The largest absolute curvature.
    fn largest(&self) -> f64 {
        self.start.abs().max((self.start + self.change).abs())
    }

    /// Where the curvature changes sign, strictly inside.
    fn inflection(&self) -> Option<f64> {
        let end = self.start + self.change;
        (self.start * end.signum() < 0.0 && end != 0.0).then_some(-self.start / self.change)
    }

    /// The unsigned turning over t0..t1.
    fn turning(&self, t0: f64, t1: f64) -> f64 {
        match self.inflection() {
            Some(t) if t0 < t && t < t1 => self.turn(t0, t).abs() + self.turn(t, t1).abs(),
            Some(_) | None => self.turn(t0, t1).abs(),
        }
    }

    /// The parameter at which it has turned by `turned` ≥ 0 from the start.
    ///
    /// ```text
    ///   κ ▲       ╱
    ///     │     ╱         Without an inflection |κ₀|t ± |κ′|t²/2 = turned; the root without cancellation.
    ///   ──│───*─────▶ t   Behind the inflection *, at t*, the turning since then is |κ′|(t − t*)²/2.
    ///     │ ╱
    /// ```
    fn at_turning(&self, turned: f64) -> f64 {
        if let Some(inflection) = self.inflection() {
            let since = turned - self.turn(0.0, inflection).abs();
            if since >= 0.0 {
                return (inflection + (2.0 * since / self.change.abs()).sqrt()).min(1.0);
            }
        }
        let (start, change) = (self.start.abs(), self.change * 1f64.copysign(self.start));
        let change = if self.start == 0.0 { self.change.abs() } else { change };
        let root = (start * start + 2.0 * change * turned).max(0.0).sqrt();
        if start + root > 0.0 { (2.0 * turned / (start + root)).min(1.0) } else { 0.0 }
    }

    /// The number of pieces that equal it up to rounding.
    fn piece_count(&self) -> usize {
        let by_turn = self.largest() / PIECE_TURN;
        let by_change = (self.change.abs() / PIECE_CHANGE).sqrt();
        libm::ceil(by_turn.max(by_change)).clamp(1.0, PIECES_MAX) as usize
    }

    /// ∫ (cos θ, sin θ) over t0..t1, at most a piece.
    fn run(&self, t0: f64, t1: f64) -> Vec2 {
        let (middle, half) = (0.5 * (t0 + t1), 0.5 * (t1 - t0));
        let at = |&(weight, at): &(f64, f64)| self.tangent(middle + half * at) * weight;
        GAUSS_LEGENDRE_COEFFS_8.iter().map(at).fold(Vec2::ZERO, |sum, v| sum + v) * half
    }

    /// The control points of a piece next to its end at t, relative to that end. If `step` is the length of the piece,
    /// these are the first six; if `step` is minus that length, the last six, beginning with the last.
    ///
    /// The derivatives of the tangent E are E′ = iκE and, by Leibniz's rule, E⁽ᵐ⁺¹⁾ = i(κE⁽ᵐ⁾ + mκ′E⁽ᵐ⁻¹⁾).
    fn controls(&self, t: f64, step: f64) -> [Vec2; CONDITIONS] {
        let (curvature, change) = (self.curvature(t) * step, self.change * step * step);
        // E and its derivatives by the parameter of the piece.
        let mut slopes = [self.tangent(t); CONDITIONS - 1];
        for m in 0..CONDITIONS - 2 {
            let before = if m == 0 { Vec2::ZERO } else { slopes[m - 1] * (m as f64 * change) };
            slopes[m + 1] = left(slopes[m] * curvature + before);
        }
        let mut controls = [Vec2::ZERO; CONDITIONS];
        for (j, control) in controls.iter_mut().enumerate() {
            // C(j, m)/C(11, m)/m! = j(j − 1)…/(11 · 10 … · m!), by m.
            let mut share = 1.0;
            for (m, slope) in slopes.iter().enumerate().take(j) {
                share *= (j - m) as f64 / ((DEGREE - m) as f64 * (m + 1) as f64);
                *control += *slope * (share * step);
            }
        }
        controls
    }
}

impl Clothoid {
    /// See [`Curve::clothoid`]. With `end`, it ends exactly there, which must be its own end up to rounding.
    pub(super) fn new(
        start: Point,
        heading_rad: f64,
        curvatures: [f64; 2],
        length: f64,
        end: Option<Point>,
    ) -> Result<Self, CurveError> {
        check_points(&[start])?;
        check_points(end.as_slice())?;
        check_finite([heading_rad, curvatures[0], curvatures[1], length])?;
        if length <= 0.0 {
            return Err(CurveError::Length { length });
        }
        let shape = shape_of(curvatures, length);
        let turns = shape.turning(0.0, 1.0) / TAU;
        if curvatures[0] == curvatures[1] && turns != 0.0 {
            // A circle is followed at most once around.
            super::sweep::checked_sweep(turns * TAU)?;
        }
        // Not-a-number counts as too many turns.
        if turns.is_nan() || turns > TURNS_MAX {
            return Err(CurveError::Turns { turns, most: TURNS_MAX });
        }
        let made = Self::made(start, heading_rad, curvatures, length, end);
        made.chain.spans.iter().try_for_each(|piece| check_points(&piece.points))?;
        Ok(made)
    }

    /// The clothoid with its chain. Without `end` it ends at the computed place. The difference of `end` from that, a
    /// few roundings, is spread along it.
    fn made(start: Point, heading_rad: f64, curvatures: [f64; 2], length: f64, end: Option<Point>) -> Self {
        let shape = shape_of(curvatures, length);
        let count = shape.piece_count();
        let heading = unit_at(heading_rad);
        let knots: Vec<f64> = (0..=count).map(|k| k as f64 / count as f64).collect();
        let joints = joints_of(&shape, &knots);
        let run = turned(joints[count], heading) * length;
        let end = end.unwrap_or(start + run);
        let drift = (end - start) - run;
        let step = 1.0 / count as f64;
        let place = |at: Vec2, t: f64| start + (turned(at, heading) * length + drift * t);
        let mut spans = Vec::with_capacity(count);
        let mut from = shape.controls(0.0, step);
        for k in 0..count {
            let (t0, t1) = (knots[k], knots[k + 1]);
            let to = shape.controls(t1, -step);
            let first = (0..CONDITIONS).map(|j| place(joints[k] + from[j], t0 + j as f64 / DEGREE as f64 * step));
            let last =
                (0..CONDITIONS).rev().map(|j| place(joints[k + 1] + to[j], t1 - j as f64 / DEGREE as f64 * step));
            spans.push(Bezier { points: first.chain(last).collect(), weights: None });
            from = shape.controls(t1, step);
        }
        super::bezier::set_ends(&mut spans, [start, end]);
        Clothoid { heading_rad, curvatures, length, chain: Spline { knots, spans } }
    }

    /// The direction at the start, in radians counter-clockwise from the x axis.
    pub fn heading_rad(&self) -> f64 {
        self.heading_rad
    }

    /// The curvatures at start and end; positive where it turns left.
    pub fn curvatures(&self) -> [f64; 2] {
        self.curvatures
    }

    /// The arc length.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The Bézier pieces that equal it up to rounding.
    pub fn pieces(&self) -> &Spline {
        &self.chain
    }

    fn shape(&self) -> Shape {
        shape_of(self.curvatures, self.length)
    }

    fn tangent_at(&self, t: f64) -> Vec2 {
        turned(self.shape().tangent(t), unit_at(self.heading_rad))
    }

    /// The curvature at t; 0 where it is below rounding.
    fn curvature_at(&self, t: f64) -> f64 {
        let [start, end] = self.curvatures;
        let there = start * (1.0 - t) + end * t;
        if there.abs() <= NO_CURVATURE * start.abs().max(end.abs()) { 0.0 } else { there }
    }
}

fn shape_of([start, end]: [f64; 2], length: f64) -> Shape {
    Shape { start: start * length, change: (end - start) * length }
}

/// The points of the shape at the knots. The sums are compensated, so that the rounding errors of many pieces do not
/// add up.
fn joints_of(shape: &Shape, knots: &[f64]) -> Vec<Vec2> {
    let (mut sum, mut lost) = (Vec2::ZERO, Vec2::ZERO);
    let mut joints = vec![sum];
    for pair in knots.windows(2) {
        let run = shape.run(pair[0], pair[1]) + lost;
        let next = sum + run;
        // Kahan's compensation.
        lost = run - (next - sum);
        sum = next;
        joints.push(sum);
    }
    joints
}

fn boxed(clothoid: Clothoid) -> Curve {
    Curve::Clothoid(Box::new(clothoid))
}

impl Kind for Clothoid {
    fn name(&self) -> &'static str {
        "clothoid"
    }
    fn ends(&self) -> [Point; 2] {
        self.chain.ends()
    }
    fn inner_point(&self, t: f64) -> Point {
        self.chain.inner_point(t)
    }
    fn derivative(&self, t: f64) -> Vec2 {
        self.tangent_at(t) * self.length
    }
    fn second_derivative(&self, t: f64) -> Vec2 {
        left(self.tangent_at(t)) * (self.length * self.shape().curvature(t))
    }
    fn spans(&self, t0: f64, t1: f64) -> Vec<Span<'_>> {
        self.chain.spans(t0, t1)
    }
    fn control_count(&self) -> usize {
        self.chain.control_count()
    }
    /// The osculating circles are nested, so it does not cross itself (Kneser). Where its curvature hardly changes, it
    /// may come back to within a tolerance.
    fn may_meet_itself(&self) -> bool {
        self.turning(0.0, 1.0) > PI
    }
    fn part(&self, t0: f64, t1: f64, ends: [Point; 2]) -> Curve {
        let heading_rad = self.heading_rad + self.shape().turn(0.0, t0);
        let curvatures = [self.curvature_at(t0), self.curvature_at(t1)];
        boxed(Self::made(ends[0], heading_rad, curvatures, self.length * (t1 - t0), Some(ends[1])))
    }
    fn reversed(&self) -> Curve {
        let ([start, end], [first, last]) = (self.ends(), self.curvatures);
        let heading_rad = self.heading_rad + self.shape().turn(0.0, 1.0) + PI;
        boxed(Self::made(end, heading_rad, [0.0 - last, 0.0 - first], self.length, Some(start)))
    }
    fn scaled(&self, factor: f64) -> Curve {
        let [start, end] = self.ends().map(|p| scaled(p, factor));
        boxed(Self::made(start, self.heading_rad, self.curvatures.map(|k| k / factor), self.length * factor, Some(end)))
    }
    /// A clothoid where the map is a similarity. Any other image is the spline of the mapped pieces.
    fn transformed(&self, map: kurbo::Affine) -> Curve {
        let Some(similarity) = super::arc::similarity_of(map) else { return self.chain.transformed(map) };
        let [start, end] = self.ends().map(|p| map * p);
        let heading_rad = similarity.turn_rad + self.heading_rad * similarity.hand;
        let curvatures = self.curvatures.map(|k| k * similarity.hand / similarity.scale);
        boxed(Self::made(start, heading_rad, curvatures, self.length * similarity.scale, Some(end)))
    }
    fn moved(&self, map: &Similarity, ends: [Point; 2]) -> Curve {
        let (heading_rad, scale) = (self.heading_rad + map.turn_rad(), map.scale());
        boxed(Self::made(ends[0], heading_rad, self.curvatures.map(|k| k / scale), self.length * scale, Some(ends[1])))
    }
    /// The result is no clothoid, but the spline of the moved pieces.
    fn spread(&self, moves: [Vec2; 2], ends: [Point; 2]) -> Curve {
        self.chain.spread(moves, ends)
    }
    /// Points are sums along the curve, which may be much longer than its extent.
    fn reach(&self) -> f64 {
        self.length
    }
    /// Its own end is accurate to the rounding of a curve that was moved and turned before.
    fn with_rounded_end(&self, end: Point) -> Option<Curve> {
        let [start, own] = self.chain.ends();
        let rounding = ROUNDED_END * (length(start.to_vec2()) + length(end.to_vec2()) + self.length);
        let is_own = length(end - own) <= rounding;
        is_own.then(|| boxed(Self::made(start, self.heading_rad, self.curvatures, self.length, Some(end))))
    }
    fn knots(&self) -> Vec<f64> {
        self.chain.knots.clone()
    }

    fn tangent(&self, t: f64, _side: End) -> Vec2 {
        self.tangent_at(t)
    }
    fn length_of(&self, t0: f64, t1: f64) -> f64 {
        self.length * (t1 - t0)
    }
    fn turning(&self, t0: f64, t1: f64) -> f64 {
        self.shape().turning(t0, t1)
    }
    fn breaks(&self) -> Vec<Break> {
        Vec::new()
    }
    fn inflections(&self) -> Vec<f64> {
        self.shape().inflection().into_iter().collect()
    }
    fn cuts_of_turning(&self, tau: f64) -> Vec<f64> {
        let shape = self.shape();
        turning::shares(shape.turning(0.0, 1.0), tau).map(|share| shape.at_turning(share)).collect()
    }
}
