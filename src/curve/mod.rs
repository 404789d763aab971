//! One curve and its queries: an exact line, arc, ellipse, Bézier, spline or clothoid, never flattened.
//!
//! Every kind has the parameter range t ∈ [0, 1], and `point(0)` and `point(1)` are *exactly* its end points: a curve
//! of a domain interpolates its vertices bit for bit ([`Curve::with_ends`]). Queries about a part of a curve take a
//! range `t0..t1` with `t0 < t1`.
//!
//! Pav & Walkington 2005 need three things of a curve: its *turning* (total variation of the tangent, Definition 4), a
//! point where it crosses the perpendicular bisector of its chord (Corollaries 1 and 2), and the place where it leaves
//! a ball around its end point (splitball).

mod arc;
mod bernstein;
mod bezier;
mod clothoid;
mod ellipse;
mod enclosure;
mod kind;
mod line;
mod meet;
mod polygon;
mod quadrature;
mod span;
mod spans;
mod spline;
mod sweep;
mod turning;
mod weights;
mod weld;

pub use enclosure::Cone;
pub use meet::{Meeting, MeetingBudget, MeetingKind, Meetings, Overlap, meetings, self_meetings};

use crate::geometry::{Point, Rect, Vec2, bounds_of};
use kind::Kind;
use std::f64::consts::{PI, TAU};

/// One end of a curve.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum End {
    /// The end at t = 0.
    Start,
    /// The end at t = 1.
    Finish,
}

/// What breaks a curve's regularity: the curve is split there, and the point becomes an input corner.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Break {
    /// The curve parameter of the break, strictly between 0 and 1.
    pub t: f64,
    /// What breaks the regularity there.
    pub kind: BreakKind,
    /// The angle between the tangents before and after, in (0, π].
    pub turn_rad: f64,
}

/// The ways in which a curve fails to be regular at a point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum BreakKind {
    /// The derivative vanishes and the tangent reverses.
    Cusp,
    /// The tangent jumps (a knot of full multiplicity).
    TangentJump,
}

/// A curve over t ∈ [0, 1].
#[derive(Clone, PartialEq, Debug)]
pub enum Curve {
    /// A straight segment.
    Line(Line),
    /// A circular arc, up to a full circle.
    Arc(CircularArc),
    /// An elliptic arc, up to a full ellipse.
    Ellipse(Box<EllipticArc>),
    /// A Bézier curve, polynomial or rational.
    Bezier(Box<Bezier>),
    /// A B-spline or NURBS.
    Spline(Box<Spline>),
    /// A clothoid (Euler spiral).
    Clothoid(Box<Clothoid>),
}

/// A straight segment; its length may be zero.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Line {
    /// The start point.
    pub start: Point,
    /// The end point.
    pub end: Point,
}

/// Part of a circle, at most once around; counter-clockwise where `sweep_rad` > 0.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CircularArc {
    /// The centre of the circle.
    pub center: Point,
    /// The radius of the circle, positive.
    pub radius: f64,
    /// The angle of the start point from the x axis, counter-clockwise, in radians.
    pub start_rad: f64,
    /// The angle from start to end in radians, within ±2π and not zero; negative where the arc runs clockwise.
    pub sweep_rad: f64,
    /// The exact ends; equal for a full circle.
    pub ends: [Point; 2],
}

/// Part of an ellipse: center + cos θ · u + sin θ · v, for conjugate half axes u, v (need not be perpendicular).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct EllipticArc {
    /// The centre of the ellipse.
    pub center: Point,
    /// The half axis at θ = 0, from the centre.
    pub u: Vec2,
    /// The half axis at θ = π/2, from the centre; not parallel to `u`.
    pub v: Vec2,
    /// The parameter angle θ of the start, in radians: not a polar angle where u and v differ in length.
    pub start_rad: f64,
    /// The range of θ from start to end in radians, within ±2π and not zero; θ falls where it is negative.
    pub sweep_rad: f64,
    /// The exact start and end; equal for a full ellipse.
    pub ends: [Point; 2],
}

/// A Bézier curve of any degree ≥ 1, rational where it has weights (all positive).
#[derive(Clone, PartialEq, Debug)]
pub struct Bezier {
    /// The control points, one more than the degree; the first and the last are the ends.
    pub points: Vec<Point>,
    /// One positive weight a control point, in their order; `None` of a polynomial curve.
    pub weights: Option<Vec<f64>>,
}

/// A B-spline or NURBS, kept as its exact Bézier spans between distinct knots.
#[derive(Clone, PartialEq, Debug)]
pub struct Spline {
    /// Distinct knots mapped to 0..1: `spans.len() + 1` of them, strictly ascending.
    pub knots: Vec<f64>,
    /// The Bézier curves in order: `spans[i]` covers `knots[i]..knots[i + 1]`, and each ends at the start of the next.
    pub spans: Vec<Bezier>,
}

/// A clothoid, or Euler spiral: its curvature is a linear function of arc length.
#[derive(Clone, PartialEq, Debug)]
pub struct Clothoid {
    heading_rad: f64,
    curvatures: [f64; 2],
    length: f64,
    /// A spline that equals it up to rounding; its ends are the clothoid's.
    chain: Spline,
}

/// Why a curve cannot be built.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum CurveError {
    /// A coordinate, angle, weight or other number is infinite or not a number.
    #[error("a coordinate is not a finite number")]
    NotFinite,
    /// The number of control points, knots or weights does not fit the kind of curve.
    #[error("{what} needs {needs}, but has {has}")]
    Count {
        /// The kind of curve, for the message.
        what: &'static str,
        /// The number or condition that is required, in words.
        needs: String,
        /// The number that is given.
        has: usize,
    },
    /// A knot is smaller than its predecessor.
    #[error("knots must ascend; knot {index} is below the one before it")]
    Knots {
        /// The place, from 0, of the knot that is smaller than its predecessor.
        index: usize,
    },
    /// A weight is zero or negative.
    #[error("weight {index} is not positive")]
    Weight {
        /// The place, from 0, of the first weight that is not positive.
        index: usize,
    },
    /// The radius is zero, negative or infinite, or an ellipse has parallel half axes.
    #[error("the radius {radius} is not positive")]
    Radius {
        /// The refused radius; of an ellipse, of the circle of equal area.
        radius: f64,
    },
    /// The sweep of an arc is zero or beyond ±2π, or a clothoid of constant curvature turns more than once around.
    #[error("the sweep {sweep_rad} (radians) is zero or more than once around")]
    Sweep {
        /// The refused sweep, in radians.
        sweep_rad: f64,
    },
    /// The length of a clothoid is zero or negative.
    #[error("the length {length} is not positive")]
    Length {
        /// The refused length.
        length: f64,
    },
    /// A clothoid turns too often.
    #[error("the curve turns {turns} times around, and {most} is the most; shorter ones can follow each other")]
    Turns {
        /// How many times around the clothoid would turn.
        turns: f64,
        /// The largest number of turns allowed.
        most: f64,
    },
}

/// The length of a vector, without overflow or underflow.
pub(crate) fn length(v: Vec2) -> f64 {
    libm::hypot(v.x, v.y)
}

/// The unit vector in the direction of `v`; (1, 0) where `v` has no direction.
fn unit(v: Vec2) -> Vec2 {
    // Scaled first, so that neither tiny nor huge vectors underflow or overflow.
    let scaled = v * crate::geometry::unit_scale(v.x.abs().max(v.y.abs()));
    let len = length(scaled);
    if len > 0.0 && len.is_finite() { scaled / len } else { Vec2::new(1.0, 0.0) }
}

fn check_finite(values: impl IntoIterator<Item = f64>) -> Result<(), CurveError> {
    if values.into_iter().all(f64::is_finite) { Ok(()) } else { Err(CurveError::NotFinite) }
}

fn check_points(points: &[Point]) -> Result<(), CurveError> {
    check_finite(points.iter().flat_map(|p| [p.x, p.y]))
}

// ---- constructors: each checks finiteness and shape, and returns CurveError ----
impl Curve {
    /// A segment. It may have zero length, as readers may find such ones.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a coordinate is not finite.
    pub fn line(start: Point, end: Point) -> Result<Self, CurveError> {
        check_points(&[start, end])?;
        Ok(Curve::Line(Line { start, end }))
    }
    /// A full circle, counter-clockwise from its rightmost point.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number is not finite, [`CurveError::Radius`] where the radius is not positive.
    pub fn circle(center: Point, radius: f64) -> Result<Self, CurveError> {
        Self::arc(center, radius, 0.0, TAU)
    }
    /// An arc from the angle `start_rad` over `sweep_rad` (at most 2π either way; negative: clockwise).
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number or an end point is not finite, [`CurveError::Radius`] where the radius
    /// is not positive, [`CurveError::Sweep`] where the sweep is zero or more than once around.
    pub fn arc(center: Point, radius: f64, start_rad: f64, sweep_rad: f64) -> Result<Self, CurveError> {
        CircularArc::new(center, radius, start_rad, sweep_rad).map(Curve::Arc)
    }
    /// The arc from `start` to `end` whose bulge is tan(sweep/4) (DXF); counter-clockwise where positive; a line
    /// where 0.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number or the centre is not finite, [`CurveError::Radius`] where the radius is
    /// zero or infinite in `f64`.
    pub fn bulge(start: Point, end: Point, bulge: f64) -> Result<Self, CurveError> {
        check_finite([bulge])?;
        if bulge == 0.0 || start == end {
            return Self::line(start, end);
        }
        CircularArc::over_chord(start, end, 4.0 * libm::atan(bulge)).map(Curve::Arc)
    }
    /// The arc through three points; a line where they are collinear in this order, the circle with the diameter
    /// `start`–`through` where start and end are the same.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number or the centre is not finite; [`CurveError::Radius`] where the points
    /// lie on a line with `through` outside of the segment from `start` to `end`, or where all three are the same.
    pub fn arc_through(start: Point, through: Point, end: Point) -> Result<Self, CurveError> {
        check_points(&[start, through, end])?;
        if start == end {
            let to_start = (start - through) * 0.5;
            let angle = libm::atan2(to_start.y, to_start.x);
            let mut circle = CircularArc::new(through + to_start, length(to_start), angle, TAU)?;
            circle.ends = [start, start];
            return Ok(Curve::Arc(circle));
        }
        // The turn at `through`, between the chords before and after it, is half the sweep (inscribed angle).
        let turn = crate::geometry::turn_from(through - start, end - through);
        if turn == 0.0 {
            return Self::line(start, end);
        }
        if turn == PI {
            return Err(CurveError::Radius { radius: f64::INFINITY });
        }
        CircularArc::over_chord(start, end, 2.0 * turn).map(Curve::Arc)
    }
    /// Part of the ellipse center + cos θ · u + sin θ · v; u and v must not be parallel.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number or an end point is not finite, [`CurveError::Radius`] where u and v are
    /// parallel, [`CurveError::Sweep`] where the sweep is zero or more than once around.
    pub fn ellipse(center: Point, u: Vec2, v: Vec2, start_rad: f64, sweep_rad: f64) -> Result<Self, CurveError> {
        EllipticArc::new(center, u, v, start_rad, sweep_rad).map(|e| Curve::Ellipse(Box::new(e)))
    }
    /// A Bézier curve of degree `points.len() − 1`, from 1 to 300.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a coordinate is not finite, [`CurveError::Count`] where the degree is not from 1
    /// to 300.
    pub fn bezier(points: Vec<Point>) -> Result<Self, CurveError> {
        Bezier::new(points, None).map(|b| Curve::Bezier(Box::new(b)))
    }
    /// A rational Bézier curve; all weights positive. With equal weights the result is a polynomial Bézier curve. Where
    /// weights differ by more than 64 times, the parameter is changed, or the result is a NURBS of several spans: the
    /// same curve up to rounding.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number is not finite, [`CurveError::Count`] where the degree is not from 1 to
    /// 300 or there is not one weight a control point, [`CurveError::Weight`] where a weight is not positive.
    pub fn rational_bezier(points: Vec<Point>, weights: Vec<f64>) -> Result<Self, CurveError> {
        Bezier::new(points, Some(weights)).map(weights::evened)
    }
    /// B-spline or NURBS with the full knot vector (points.len() + degree + 1 knots); unclamped and periodic vectors
    /// are allowed. Weights far apart are evened as in [`Curve::rational_bezier`].
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number is not finite, [`CurveError::Knots`] where the knots descend,
    /// [`CurveError::Weight`] where a weight is not positive; [`CurveError::Count`] where the numbers of knots, points
    /// and weights do not fit the degree, an inner knot is repeated so often that the curve has a gap, or the domain of
    /// the knots has no length.
    pub fn nurbs(degree: usize, knots: &[f64], points: &[Point], weights: Option<&[f64]>) -> Result<Self, CurveError> {
        Spline::from_knots(degree, knots, points, weights).map(|s| Curve::Spline(Box::new(s)))
    }
    /// The clothoid (Euler spiral) of a given length from a start point. `heading_rad` is the direction at the start,
    /// counter-clockwise from the x axis. The curvature changes linearly from the first to the second of `curvatures`;
    /// each is 1/radius, positive where the curve turns left. Equal curvatures give an arc, at most once around, zeros
    /// a line, both still of this kind. Points are accurate to three roundings of the length and the coordinates.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number is not finite, [`CurveError::Length`] where the length is not positive,
    /// [`CurveError::Turns`] where the curve turns more than 100 times around, [`CurveError::Sweep`] where equal
    /// curvatures go around more than once.
    pub fn clothoid(start: Point, heading_rad: f64, curvatures: [f64; 2], length: f64) -> Result<Self, CurveError> {
        Clothoid::new(start, heading_rad, curvatures, length, None).map(|c| Curve::Clothoid(Box::new(c)))
    }
    /// The natural cubic spline through ≥ 2 points (centripetal parameters; exact repeats are skipped).
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a coordinate is not finite, [`CurveError::Count`] where fewer than two points
    /// are distinct.
    pub fn natural_spline(points: &[Point]) -> Result<Self, CurveError> {
        Spline::natural(points).map(|s| Curve::Spline(Box::new(s)))
    }
    /// The cubic spline through ≥ 2 points, parameters by chord length, with the given directions at start and end;
    /// natural at an end that has none. Points of no distance from the one before are skipped.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a number is not finite, [`CurveError::Count`] where fewer than two points are
    /// left without repeats.
    pub fn fitted_spline(points: &[Point], tangents: [Option<Vec2>; 2]) -> Result<Self, CurveError> {
        Spline::fitted(points, tangents).map(|s| Curve::Spline(Box::new(s)))
    }
    /// The closed C² cubic spline through ≥ 3 points (the first is not repeated; exact repeats are skipped).
    ///
    /// # Errors
    /// [`CurveError::NotFinite`] where a coordinate is not finite, [`CurveError::Count`] where fewer than three points
    /// are left without repeats.
    pub fn periodic_spline(points: &[Point]) -> Result<Self, CurveError> {
        Spline::periodic(points).map(|s| Curve::Spline(Box::new(s)))
    }
}

// ---- queries ----
impl Curve {
    /// The only match over the kinds for queries: everything else calls the trait.
    fn as_kind(&self) -> &dyn Kind {
        match self {
            Curve::Line(line) => line,
            Curve::Arc(arc) => arc,
            Curve::Ellipse(arc) => &**arc,
            Curve::Bezier(bezier) => &**bezier,
            Curve::Spline(spline) => &**spline,
            Curve::Clothoid(clothoid) => &**clothoid,
        }
    }
    /// The segment, where it is one by kind (a Bézier that is straight is not: [`Curve::is_straight`]).
    pub fn as_line(&self) -> Option<&Line> {
        if let Curve::Line(line) = self { Some(line) } else { None }
    }
    /// The circular arc, where it is one by kind.
    pub fn as_arc(&self) -> Option<&CircularArc> {
        if let Curve::Arc(arc) = self { Some(arc) } else { None }
    }
    /// Whether its curvature is constant and its parameter proportional to arc length: a line or a circular arc.
    pub fn is_round(&self) -> bool {
        self.as_kind().is_round()
    }
    /// The number of points that it stores; a line, an arc or an ellipse counts as one.
    pub fn control_count(&self) -> usize {
        self.as_kind().control_count()
    }
    /// 0, the parameters at which one formula ends and the next begins (the knots of a spline), and 1.
    pub fn knots(&self) -> Vec<f64> {
        self.as_kind().knots()
    }
    /// The usual name of the kind: "line", "arc", "ellipse", "bezier", "rational bezier", "spline", "nurbs",
    /// "clothoid".
    pub fn kind(&self) -> &'static str {
        self.as_kind().name()
    }
    /// The exact start: `point(0)`.
    pub fn start(&self) -> Point {
        self.as_kind().ends()[0]
    }
    /// The exact end: `point(1)`.
    pub fn end(&self) -> Point {
        self.as_kind().ends()[1]
    }
    /// The point at t; exactly the start for t ≤ 0, the end for t ≥ 1.
    pub fn point(&self, t: f64) -> Point {
        self.as_kind().point(t)
    }
    /// The derivative of the point by t.
    pub fn derivative(&self, t: f64) -> Vec2 {
        self.as_kind().derivative(t)
    }
    /// The second derivative of the point by t.
    pub fn second_derivative(&self, t: f64) -> Vec2 {
        self.as_kind().second_derivative(t)
    }
    /// Unit tangent in the direction of travel; where the derivative vanishes, the limit from after (`End::Start`) or
    /// before (`End::Finish`) t. At a break the two differ.
    pub fn tangent(&self, t: f64, side: End) -> Vec2 {
        self.as_kind().tangent(t, side)
    }
    /// Unit direction in which the curve leaves its end point *into the curve*.
    pub fn direction_at(&self, end: End) -> Vec2 {
        match end {
            End::Start => self.tangent(0.0, End::Start),
            End::Finish => -self.tangent(1.0, End::Finish),
        }
    }
    /// Signed curvature at t (positive: turns left); 0 where the derivative vanishes.
    pub fn curvature(&self, t: f64) -> f64 {
        let (d, dd) = (self.derivative(t), self.second_derivative(t));
        let speed = length(d);
        if speed == 0.0 { 0.0 } else { (d / speed).cross(dd / speed) / speed }
    }
    /// Whether the curve runs along its chord without turning back, up to rounding of its control points.
    pub fn is_straight(&self) -> bool {
        self.as_kind().is_straight()
    }
    /// A tight box, up to rounding of `point`.
    pub fn bounds(&self) -> Rect {
        self.bounds_of(0.0, 1.0)
    }
    /// A tight box around t0..t1, up to rounding of `point`.
    pub fn bounds_of(&self, t0: f64, t1: f64) -> Rect {
        let extremes = self.as_kind().extremes(t0, t1);
        let ends = Rect::from_points(self.point(t0), self.point(t1));
        bounds_of(extremes.into_iter().map(|t| self.point(t))).map_or(ends, |inner| inner.union(ends))
    }
    /// The arc length of the whole curve.
    pub fn length(&self) -> f64 {
        self.length_of(0.0, 1.0)
    }
    /// The arc length of the part t0..t1.
    pub fn length_of(&self, t0: f64, t1: f64) -> f64 {
        self.as_kind().length_of(t0, t1)
    }
    /// Parameter and distance of the nearest point of the part t0..t1 (global, not a local minimum).
    pub fn nearest(&self, p: Point, t0: f64, t1: f64) -> (f64, f64) {
        let t = self.as_kind().nearest(p, t0, t1);
        (t, length(self.point(t) - p))
    }
    /// ½∮(x dy − y dx) along the curve relative to `origin`: summed over a closed loop, the enclosed area.
    pub fn signed_area(&self, origin: Point) -> f64 {
        let chord = self.end() - self.start();
        let triangle = 0.5 * (self.start() - origin).cross(chord);
        triangle + self.as_kind().area_over_chord()
    }
    /// Turning: the integral of |dθ| of the tangent angle over t0..t1, jumps included.
    pub fn turning(&self, t0: f64, t1: f64) -> f64 {
        self.as_kind().turning(t0, t1)
    }
    /// Cusps and tangent jumps strictly inside, ascending.
    pub fn breaks(&self) -> Vec<Break> {
        self.as_kind().breaks()
    }
    /// Where the curvature changes sign, strictly inside, ascending; breaks are not among them.
    pub fn inflections(&self) -> Vec<f64> {
        self.as_kind().inflections()
    }
    /// Ascending parameters strictly inside at which to cut the curve so that every part turns by at most `tau`
    /// (radians). The parts have (nearly) equal turning and are as few as possible; an excess of 1e-12 of `tau` counts
    /// as none. Breaks are always cut. There are at most 10⁸ parts between two breaks: call [`Curve::parts_of_turning`]
    /// first.
    pub fn cuts_of_turning(&self, tau: f64) -> Vec<f64> {
        self.as_kind().cuts_of_turning(tau)
    }
    /// The number of parts of turning at most `tau` for a curve without breaks; `usize::MAX` where it does not fit.
    pub fn parts_of_turning(&self, tau: f64) -> usize {
        turning::parts_of_turning(self.turning(0.0, 1.0), tau) as usize
    }
    /// The lens angle λ: an upper bound of π − ∠xzy over the points z of the part with chord xy. It is exact for lines
    /// and circular arcs: half the turning.
    ///
    /// ```text
    ///             z ●───╮       λ is the largest angle by which the way x → z → y turns at z. The part lies in the
    ///         ╭─────╯   ╰─╮     lens of the points with ∠xzy ≥ π − λ.
    ///       x ●── chord ──● y
    /// ```
    pub fn lens_angle(&self, t0: f64, t1: f64) -> f64 {
        self.as_kind().lens_angle(t0, t1)
    }
    /// The largest distance of the part from its chord, taken as a segment.
    pub fn chord_error(&self, t0: f64, t1: f64) -> f64 {
        self.as_kind().chord_error(t0, t1)
    }
    /// The parameter where the part crosses the perpendicular bisector of its chord. For a turning of at most π/3 there
    /// is exactly one crossing; beyond, this is one of them. Where the chord is a point, the middle parameter.
    pub fn bisector_crossing(&self, t0: f64, t1: f64) -> f64 {
        self.as_kind().bisector_crossing(t0, t1)
    }
    /// The parameters where the part crosses the line through `a` along `direction` from one side to the other,
    /// strictly inside, ascending.
    pub fn line_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        self.as_kind().line_crossings(a, direction, t0, t1)
    }
    /// The parameter where the part, followed from its end `end` (t0 or t1), first reaches the distance `radius` from
    /// that end; `None` where it stays nearer.
    pub fn leaves_ball(&self, end: End, radius: f64, t0: f64, t1: f64) -> Option<f64> {
        self.as_kind().leaves_ball(end, radius, t0, t1)
    }
}

// ---- makers of other curves ----
impl Curve {
    /// The part t0..t1 as a curve of its own, of the same kind; its ends are exactly `point(t0)` and `point(t1)`.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        self.as_kind().part(t0, t1, [self.point(t0), self.point(t1)])
    }
    /// The same curve followed the other way: its point at t is this one's at 1 − t.
    pub fn reversed(&self) -> Self {
        self.as_kind().reversed()
    }
    /// The same curve with exactly this end, if the end equals its own up to rounding and its kind computes the end
    /// from other numbers; else `None`.
    pub(crate) fn with_rounded_end(&self, end: Point) -> Option<Self> {
        self.as_kind().with_rounded_end(end)
    }
    /// The curve moved by the similarity that takes its ends to `start` and `end` (exactly those bits). Meant for small
    /// moves, as in welding. A closed curve is translated. Where the similarity would move other points much farther
    /// than the ends (a curve that nearly closes), and where a curve closes or opens, the moves of the ends are spread
    /// along the curve instead. A clothoid then becomes its spline.
    pub fn with_ends(&self, start: Point, end: Point) -> Self {
        weld::with_ends(self, start, end)
    }
    /// All coordinates times a power of two: exact.
    pub fn scaled(&self, factor: f64) -> Self {
        self.as_kind().scaled(factor)
    }
    /// The image under a non-degenerate affine map, exact in kind. Under a map that is no similarity a circle becomes
    /// an ellipse. A clothoid has no such image and becomes the spline that equals it up to rounding.
    pub fn transformed(&self, map: kurbo::Affine) -> Self {
        self.as_kind().transformed(map)
    }
}
