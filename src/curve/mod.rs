//! One curve and its questions: an exact line, arc, Bézier or spline, never flattened.
//!
//! Every kind runs over t ∈ [0, 1], and `point(0)` and `point(1)` are *exactly* its end points: a curve of a domain interpolates its
//! vertices bit for bit ([`Curve::with_ends`]). Questions about a part of a curve take a range `t0..t1` with `t0 < t1`.
//!
//! Pav & Walkington 2005 ask of a curve its *turning* (total variation of the tangent, Definition 4), a point where it crosses the
//! perpendicular bisector of its chord (Corollaries 1 and 2), and where it leaves a ball around its end point (splitball).

mod meet;

pub use meet::{Meeting, MeetingBudget, MeetingKind, Meetings, Overlap, meetings, self_meetings};

use crate::geometry::{Point, Rect, Vec2};

/// One end of a curve.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum End {
    Start,
    Finish,
}

/// What breaks a curve's regularity: the curve is split there, and the point becomes an input corner.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Break {
    pub t: f64,
    pub kind: BreakKind,
    /// How far the tangent turns at the point, in (0, π].
    pub turn_rad: f64,
}

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
    Line(Line),
    Arc(CircularArc),
    Ellipse(Box<EllipticArc>),
    Bezier(Box<Bezier>),
    Spline(Box<Spline>),
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Line {
    pub start: Point,
    pub end: Point,
}

/// Part of a circle, at most once around; counter-clockwise where `sweep_rad` > 0.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CircularArc {
    pub center: Point,
    pub radius: f64,
    pub start_rad: f64,
    pub sweep_rad: f64,
    /// The exact ends; equal for a full circle.
    pub ends: [Point; 2],
}

/// Part of an ellipse: center + cos θ · u + sin θ · v, for conjugate half axes u, v (need not be perpendicular).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct EllipticArc {
    pub center: Point,
    pub u: Vec2,
    pub v: Vec2,
    pub start_rad: f64,
    pub sweep_rad: f64,
    pub ends: [Point; 2],
}

/// A Bézier curve of any degree ≥ 1, rational where it has weights (all positive).
#[derive(Clone, PartialEq, Debug)]
pub struct Bezier {
    pub points: Vec<Point>,
    pub weights: Option<Vec<f64>>,
}

/// A B-spline or NURBS, kept as its exact Bézier spans between distinct knots.
#[derive(Clone, PartialEq, Debug)]
pub struct Spline {
    /// Distinct knots mapped to 0..1: `spans.len() + 1` of them, strictly ascending.
    pub knots: Vec<f64>,
    pub spans: Vec<Bezier>,
}

/// Why a curve cannot be built.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum CurveError {
    #[error("a coordinate is not a finite number")]
    NotFinite,
    #[error("{what} needs {needs}, but has {has}")]
    Count { what: &'static str, needs: String, has: usize },
    #[error("knots must ascend; knot {index} is below the one before it")]
    Knots { index: usize },
    #[error("weight {index} is not positive")]
    Weight { index: usize },
    #[error("the radius {radius} is not positive")]
    Radius { radius: f64 },
}

// ---- constructors: each checks finiteness and shape, and returns CurveError ----
impl Curve {
    pub fn line(_start: Point, _end: Point) -> Result<Self, CurveError> {
        todo!()
    }
    pub fn circle(_center: Point, _radius: f64) -> Result<Self, CurveError> {
        todo!()
    }
    pub fn arc(_center: Point, _radius: f64, _start_rad: f64, _sweep_rad: f64) -> Result<Self, CurveError> {
        todo!()
    }
    /// The arc from `start` to `end` whose bulge is tan(sweep/4) (DXF); counter-clockwise where positive; a line where 0.
    pub fn bulge(_start: Point, _end: Point, _bulge: f64) -> Result<Self, CurveError> {
        todo!()
    }
    pub fn arc_through(_start: Point, _through: Point, _end: Point) -> Result<Self, CurveError> {
        todo!()
    }
    pub fn ellipse(_center: Point, _u: Vec2, _v: Vec2, _start_rad: f64, _sweep_rad: f64) -> Result<Self, CurveError> {
        todo!()
    }
    pub fn bezier(_points: Vec<Point>) -> Result<Self, CurveError> {
        todo!()
    }
    pub fn rational_bezier(_points: Vec<Point>, _weights: Vec<f64>) -> Result<Self, CurveError> {
        todo!()
    }
    /// B-spline or NURBS with the full knot vector (points.len() + degree + 1 knots); unclamped and periodic vectors are allowed.
    pub fn nurbs(
        _degree: usize,
        _knots: &[f64],
        _points: &[Point],
        _weights: Option<&[f64]>,
    ) -> Result<Self, CurveError> {
        todo!()
    }
    /// The natural cubic spline through ≥ 2 points (centripetal parameters unless chosen otherwise).
    pub fn natural_spline(_points: &[Point]) -> Result<Self, CurveError> {
        todo!()
    }
    /// The closed C² cubic spline through ≥ 3 points (the first is not repeated).
    pub fn periodic_spline(_points: &[Point]) -> Result<Self, CurveError> {
        todo!()
    }
}

// ---- questions ----
impl Curve {
    /// The field's name of the kind: "line", "arc", "ellipse", "bezier", "rational bezier", "spline", "nurbs".
    pub fn kind(&self) -> &'static str {
        todo!()
    }
    pub fn start(&self) -> Point {
        todo!()
    }
    pub fn end(&self) -> Point {
        todo!()
    }
    pub fn point(&self, _t: f64) -> Point {
        todo!()
    }
    pub fn derivative(&self, _t: f64) -> Vec2 {
        todo!()
    }
    pub fn second_derivative(&self, _t: f64) -> Vec2 {
        todo!()
    }
    /// Unit tangent in the direction of travel; where the derivative vanishes, the limit from after (`End::Start`) or before
    /// (`End::Finish`) t. At a break the two differ.
    pub fn tangent(&self, _t: f64, _side: End) -> Vec2 {
        todo!()
    }
    /// Unit direction in which the curve leaves its end point *into the curve*.
    pub fn direction_at(&self, _end: End) -> Vec2 {
        todo!()
    }
    /// Signed curvature at t (positive: turns left).
    pub fn curvature(&self, _t: f64) -> f64 {
        todo!()
    }
    pub fn is_straight(&self) -> bool {
        todo!()
    }
    /// A tight box.
    pub fn bounds(&self) -> Rect {
        todo!()
    }
    pub fn bounds_of(&self, _t0: f64, _t1: f64) -> Rect {
        todo!()
    }
    pub fn length(&self) -> f64 {
        todo!()
    }
    pub fn length_of(&self, _t0: f64, _t1: f64) -> f64 {
        todo!()
    }
    /// Parameter and distance of the nearest point of the part t0..t1 (global, not a local minimum).
    pub fn nearest(&self, _p: Point, _t0: f64, _t1: f64) -> (f64, f64) {
        todo!()
    }
    /// ½∮(x dy − y dx) along the curve relative to `origin`: summed over a closed loop, the enclosed area.
    pub fn green(&self, _origin: Point) -> f64 {
        todo!()
    }
    /// Turning: the integral of |dθ| of the tangent angle over t0..t1, jumps included.
    pub fn turning(&self, _t0: f64, _t1: f64) -> f64 {
        todo!()
    }
    /// Cusps and tangent jumps strictly inside, ascending.
    pub fn breaks(&self) -> Vec<Break> {
        todo!()
    }
    /// Where the curvature changes sign, strictly inside, ascending.
    pub fn inflections(&self) -> Vec<f64> {
        todo!()
    }
    /// Ascending parameters strictly inside at which the curve is to be cut so that every part turns at most `tau`; parts of
    /// (nearly) equal turning, as few as possible.
    pub fn cuts_of_turning(&self, _tau: f64) -> Vec<f64> {
        todo!()
    }
    /// λ ≥ max over z of π − ∠xzy for the part with chord xy (equality for lines and circular arcs: half the turning).
    pub fn lens_angle(&self, _t0: f64, _t1: f64) -> f64 {
        todo!()
    }
    /// Largest distance of the part from its chord.
    pub fn chord_error(&self, _t0: f64, _t1: f64) -> f64 {
        todo!()
    }
    /// Where the part crosses the perpendicular bisector of its chord (turning ≤ π/3: exactly one crossing).
    pub fn bisector_crossing(&self, _t0: f64, _t1: f64) -> f64 {
        todo!()
    }
    /// Where the part crosses the line through `a` along `direction`, ascending.
    pub fn line_crossings(&self, _a: Point, _direction: Vec2, _t0: f64, _t1: f64) -> Vec<f64> {
        todo!()
    }
    /// Where the part, followed from its end `end` (t0 or t1), first reaches the distance `radius` from that end point.
    pub fn leaves_ball(&self, _end: End, _radius: f64, _t0: f64, _t1: f64) -> Option<f64> {
        todo!()
    }
}

// ---- makers of other curves ----
impl Curve {
    /// The part t0..t1 as a curve of its own, of the same kind; its ends are exactly `point(t0)` and `point(t1)`.
    pub fn part(&self, _t0: f64, _t1: f64) -> Self {
        todo!()
    }
    pub fn reversed(&self) -> Self {
        todo!()
    }
    /// The curve moved by the similarity that takes its ends to `start` and `end` (exactly those bits). For a small move: welding.
    /// A closed curve is translated, and both ends must be equal.
    pub fn with_ends(&self, _start: Point, _end: Point) -> Self {
        todo!()
    }
    /// All coordinates times a power of two: exact.
    pub fn scaled(&self, _factor: f64) -> Self {
        todo!()
    }
    /// Any non-degenerate affine image, exact in kind (a circle under a skew becomes an ellipse).
    pub fn transformed(&self, _map: kurbo::Affine) -> Self {
        todo!()
    }
}
