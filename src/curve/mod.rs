//! One curve and its questions: an exact line, arc, Bézier or spline, never flattened.
//!
//! Every kind runs over t ∈ [0, 1], and `point(0)` and `point(1)` are *exactly* its end points: a curve of a domain interpolates its
//! vertices bit for bit ([`Curve::with_ends`]). Questions about a part of a curve take a range `t0..t1` with `t0 < t1`.
//!
//! Pav & Walkington 2005 ask of a curve its *turning* (total variation of the tangent, Definition 4), a point where it crosses the
//! perpendicular bisector of its chord (Corollaries 1 and 2), and where it leaves a ball around its end point (splitball).

mod arc;
mod bernstein;
mod bezier;
mod ellipse;
mod enclosure;
mod line;
mod meet;
mod quadrature;
mod spans;
mod spline;
mod turning;
mod weights;
mod weld;

pub use enclosure::Cone;
pub use meet::{Meeting, MeetingBudget, MeetingKind, Meetings, Overlap, meetings, self_meetings};

use crate::geometry::{Point, Rect, Vec2, bounds_of};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

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
    #[error("the sweep {sweep_rad} (radians) is zero or more than once around")]
    Sweep { sweep_rad: f64 },
}

pub(crate) fn length(v: Vec2) -> f64 {
    libm::hypot(v.x, v.y)
}

/// `v` made one unit long; where it has no direction, (1, 0).
fn unit(v: Vec2) -> Vec2 {
    // Scaled first, so that neither tiny nor huge vectors leave the range.
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
    /// A segment; one of zero length is a curve too (a reader may find it).
    pub fn line(start: Point, end: Point) -> Result<Self, CurveError> {
        check_points(&[start, end])?;
        Ok(Curve::Line(Line { start, end }))
    }
    /// A full circle, counter-clockwise from its rightmost point.
    pub fn circle(center: Point, radius: f64) -> Result<Self, CurveError> {
        Self::arc(center, radius, 0.0, TAU)
    }
    /// An arc from the angle `start_rad` over `sweep_rad` (at most 2π either way; negative: clockwise).
    pub fn arc(center: Point, radius: f64, start_rad: f64, sweep_rad: f64) -> Result<Self, CurveError> {
        CircularArc::new(center, radius, start_rad, sweep_rad).map(Curve::Arc)
    }
    /// The arc from `start` to `end` whose bulge is tan(sweep/4) (DXF); counter-clockwise where positive; a line where 0.
    pub fn bulge(start: Point, end: Point, bulge: f64) -> Result<Self, CurveError> {
        check_finite([bulge])?;
        if bulge == 0.0 || start == end {
            return Self::line(start, end);
        }
        CircularArc::over_chord(start, end, 4.0 * libm::atan(bulge)).map(Curve::Arc)
    }
    /// The arc through three points; a line where they are collinear in this order, the circle with the diameter `start`–`through`
    /// where start and end are the same.
    pub fn arc_through(start: Point, through: Point, end: Point) -> Result<Self, CurveError> {
        check_points(&[start, through, end])?;
        if start == end {
            let to_start = (start - through) * 0.5;
            let angle = libm::atan2(to_start.y, to_start.x);
            let mut circle = CircularArc::new(through + to_start, length(to_start), angle, TAU)?;
            circle.ends = [start, start];
            return Ok(Curve::Arc(circle));
        }
        // The angle between the chord and its tangents is the turn at any point of the arc, and half the sweep.
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
    pub fn ellipse(center: Point, u: Vec2, v: Vec2, start_rad: f64, sweep_rad: f64) -> Result<Self, CurveError> {
        EllipticArc::new(center, u, v, start_rad, sweep_rad).map(|e| Curve::Ellipse(Box::new(e)))
    }
    /// A Bézier curve of degree `points.len() − 1`, from 1 to 300.
    pub fn bezier(points: Vec<Point>) -> Result<Self, CurveError> {
        Bezier::new(points, None).map(|b| Curve::Bezier(Box::new(b)))
    }
    /// A rational Bézier curve; all weights positive. Equal weights make it a plain one; weights more than 64 times apart another pace
    /// of the parameter, or a NURBS of several spans, which is the same curve up to rounding.
    pub fn rational_bezier(points: Vec<Point>, weights: Vec<f64>) -> Result<Self, CurveError> {
        Bezier::new(points, Some(weights)).map(weights::evened)
    }
    /// B-spline or NURBS with the full knot vector (points.len() + degree + 1 knots); unclamped and periodic vectors are allowed. Weights
    /// far apart are evened as in [`Curve::rational_bezier`].
    pub fn nurbs(degree: usize, knots: &[f64], points: &[Point], weights: Option<&[f64]>) -> Result<Self, CurveError> {
        Spline::from_knots(degree, knots, points, weights).map(|s| Curve::Spline(Box::new(s)))
    }
    /// The natural cubic spline through ≥ 2 points (centripetal parameters; exact repeats are skipped).
    pub fn natural_spline(points: &[Point]) -> Result<Self, CurveError> {
        Spline::natural(points).map(|s| Curve::Spline(Box::new(s)))
    }
    /// The cubic spline through ≥ 2 points, parameters by chord length, with the given directions at start and end; natural at an end
    /// that has none. Points of no distance from the one before are skipped.
    pub fn fitted_spline(points: &[Point], tangents: [Option<Vec2>; 2]) -> Result<Self, CurveError> {
        Spline::fitted(points, tangents).map(|s| Curve::Spline(Box::new(s)))
    }
    /// The closed C² cubic spline through ≥ 3 points (the first is not repeated; exact repeats are skipped).
    pub fn periodic_spline(points: &[Point]) -> Result<Self, CurveError> {
        Spline::periodic(points).map(|s| Curve::Spline(Box::new(s)))
    }
}

// ---- questions ----
impl Curve {
    /// The field's name of the kind: "line", "arc", "ellipse", "bezier", "rational bezier", "spline", "nurbs".
    pub fn kind(&self) -> &'static str {
        match self {
            Curve::Line(_) => "line",
            Curve::Arc(_) => "arc",
            Curve::Ellipse(_) => "ellipse",
            Curve::Bezier(b) if b.weights.is_none() => "bezier",
            Curve::Bezier(_) => "rational bezier",
            Curve::Spline(s) if s.spans.iter().all(|span| span.weights.is_none()) => "spline",
            Curve::Spline(_) => "nurbs",
        }
    }
    pub fn start(&self) -> Point {
        match self {
            Curve::Line(l) => l.start,
            Curve::Arc(a) => a.ends[0],
            Curve::Ellipse(e) => e.ends[0],
            Curve::Bezier(b) => b.points[0],
            Curve::Spline(s) => s.spans[0].points[0],
        }
    }
    pub fn end(&self) -> Point {
        match self {
            Curve::Line(l) => l.end,
            Curve::Arc(a) => a.ends[1],
            Curve::Ellipse(e) => e.ends[1],
            Curve::Bezier(b) => b.point(1.0),
            Curve::Spline(s) => s.point(1.0),
        }
    }
    pub fn point(&self, t: f64) -> Point {
        if t <= 0.0 {
            return self.start();
        }
        if t >= 1.0 {
            return self.end();
        }
        match self {
            Curve::Line(l) => l.point(t),
            Curve::Arc(a) => a.point(t),
            Curve::Ellipse(e) => e.point(t),
            Curve::Bezier(b) => b.point(t),
            Curve::Spline(s) => s.point(t),
        }
    }
    pub fn derivative(&self, t: f64) -> Vec2 {
        match self {
            Curve::Line(l) => l.chord(),
            Curve::Arc(a) => a.derivative(t),
            Curve::Ellipse(e) => e.derivative(t),
            Curve::Bezier(b) => b.derivative(t),
            Curve::Spline(s) => {
                let (i, u) = s.locate(t, End::Start);
                s.spans[i].derivative(u) / s.step(i)
            }
        }
    }
    pub fn second_derivative(&self, t: f64) -> Vec2 {
        match self {
            Curve::Line(_) => Vec2::ZERO,
            Curve::Arc(a) => a.second_derivative(t),
            Curve::Ellipse(e) => e.second_derivative(t),
            Curve::Bezier(b) => b.second_derivative(t),
            Curve::Spline(s) => {
                let (i, u) = s.locate(t, End::Start);
                s.spans[i].second_derivative(u) / s.step(i) / s.step(i)
            }
        }
    }
    /// Unit tangent in the direction of travel; where the derivative vanishes, the limit from after (`End::Start`) or before
    /// (`End::Finish`) t. At a break the two differ.
    pub fn tangent(&self, t: f64, side: End) -> Vec2 {
        match self {
            Curve::Line(l) => unit(l.chord()),
            Curve::Arc(a) => a.tangent(t),
            Curve::Ellipse(e) => unit(e.derivative(t)),
            Curve::Bezier(b) => b.tangent(t, side),
            Curve::Spline(s) => {
                let (i, u) = s.locate(t, side);
                s.spans[i].tangent(u, side)
            }
        }
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
    /// Whether the curve is its chord, followed without turning back, up to rounding of its control points.
    pub fn is_straight(&self) -> bool {
        match self {
            Curve::Line(_) => true,
            Curve::Arc(_) | Curve::Ellipse(_) => false,
            Curve::Bezier(b) => b.is_straight(b.hodograph_noise()),
            Curve::Spline(_) => spans::is_straight(self),
        }
    }
    /// A tight box, up to rounding of `point`.
    pub fn bounds(&self) -> Rect {
        self.bounds_of(0.0, 1.0)
    }
    /// A tight box around t0..t1, up to rounding of `point`.
    pub fn bounds_of(&self, t0: f64, t1: f64) -> Rect {
        let extremes = match self {
            Curve::Line(_) => Vec::new(),
            Curve::Arc(a) => arc::passages(a.start_rad, a.sweep_rad, 0.0, FRAC_PI_2, t0, t1),
            Curve::Ellipse(e) => e.extremes(t0, t1),
            Curve::Bezier(_) | Curve::Spline(_) => spans::extremes(self, t0, t1),
        };
        let ends = Rect::from_points(self.point(t0), self.point(t1));
        bounds_of(extremes.into_iter().map(|t| self.point(t))).map_or(ends, |inner| inner.union(ends))
    }
    pub fn length(&self) -> f64 {
        self.length_of(0.0, 1.0)
    }
    pub fn length_of(&self, t0: f64, t1: f64) -> f64 {
        match self {
            Curve::Line(l) => length(l.chord()) * (t1 - t0),
            Curve::Arc(a) => a.radius * (a.sweep_rad * (t1 - t0)).abs(),
            Curve::Ellipse(e) => {
                let scale = (length(e.u) + length(e.v)) * (e.sweep_rad * (t1 - t0)).abs();
                quadrature::integral(|t| length(e.derivative(t)), t0, t1, scale)
            }
            Curve::Bezier(_) | Curve::Spline(_) => spans::length_of(self, t0, t1),
        }
    }
    /// Parameter and distance of the nearest point of the part t0..t1 (global, not a local minimum).
    pub fn nearest(&self, p: Point, t0: f64, t1: f64) -> (f64, f64) {
        let t = match self {
            Curve::Line(l) => l.nearest(p, t0, t1),
            Curve::Arc(a) => {
                let inside = a.normals_through(p, t0, t1).into_iter().map(|t| self.polished_foot(p, t, t0, t1));
                let candidates: Vec<f64> = inside.chain([t0, t1]).collect();
                self.nearest_of(p, &candidates)
            }
            _ => spans::nearest(self, p, t0, t1),
        };
        (t, length(self.point(t) - p))
    }
    /// ½∮(x dy − y dx) along the curve relative to `origin`: summed over a closed loop, the enclosed area.
    pub fn green(&self, origin: Point) -> f64 {
        let chord = self.end() - self.start();
        let triangle = 0.5 * (self.start() - origin).cross(chord);
        triangle
            + match self {
                Curve::Line(_) => 0.0,
                Curve::Arc(a) => 0.5 * a.radius * a.radius * arc::angle_minus_sine(a.sweep_rad),
                Curve::Ellipse(e) => 0.5 * e.u.cross(e.v) * arc::angle_minus_sine(e.sweep_rad),
                Curve::Bezier(b) => b.segment_area(),
                Curve::Spline(s) => {
                    let start = self.start();
                    let above = |span: &Bezier| {
                        let (a, b) = (span.points[0], span.points[span.degree()]);
                        0.5 * (a - start).cross(b - a) + span.segment_area()
                    };
                    s.spans.iter().map(above).sum()
                }
            }
    }
    /// Turning: the integral of |dθ| of the tangent angle over t0..t1, jumps included.
    pub fn turning(&self, t0: f64, t1: f64) -> f64 {
        turning::turning(self, t0, t1)
    }
    /// Cusps and tangent jumps strictly inside, ascending.
    pub fn breaks(&self) -> Vec<Break> {
        turning::breaks(self)
    }
    /// Where the curvature changes sign, strictly inside, ascending; breaks are not among them.
    pub fn inflections(&self) -> Vec<f64> {
        turning::inflections(self)
    }
    /// Ascending parameters strictly inside at which the curve is to be cut so that every part turns at most `tau`; parts of
    /// (nearly) equal turning, as few as possible (an excess of 1e-12 of `tau` counts as none). Breaks are always cut; never more than
    /// 10⁸ parts between two of them: ask [`Curve::parts_of_turning`] first.
    pub fn cuts_of_turning(&self, tau: f64) -> Vec<f64> {
        turning::cuts_of_turning(self, tau)
    }
    /// How many parts of at most `tau` a curve without breaks turns enough for; `usize::MAX` where no number holds them.
    pub fn parts_of_turning(&self, tau: f64) -> usize {
        turning::parts_of_turning(self.turning(0.0, 1.0), tau) as usize
    }
    /// λ ≥ max over z of π − ∠xzy for the part with chord xy (equality for lines and circular arcs: half the turning).
    pub fn lens_angle(&self, t0: f64, t1: f64) -> f64 {
        match self {
            Curve::Line(_) => 0.0,
            Curve::Arc(a) => 0.5 * (a.sweep_rad * (t1 - t0)).abs(),
            _ => {
                // The stationary points are known to rounding, and the angle is flat there: the excess covers both.
                let measured = spans::lens_angle(self, t0, t1) * (1.0 + 1e-12) + 64.0 * f64::EPSILON;
                measured.min(self.turning(t0, t1)).min(PI)
            }
        }
    }
    /// Largest distance of the part from its chord (the segment).
    pub fn chord_error(&self, t0: f64, t1: f64) -> f64 {
        match self {
            Curve::Line(_) => 0.0,
            Curve::Arc(a) => {
                let quarter = libm::sin(0.25 * a.sweep_rad * (t1 - t0));
                2.0 * a.radius * quarter * quarter
            }
            _ => spans::chord_error(self, t0, t1),
        }
    }
    /// Where the part crosses the perpendicular bisector of its chord (turning ≤ π/3: exactly one crossing; beyond, one of them; the
    /// middle parameter where the chord is a point).
    pub fn bisector_crossing(&self, t0: f64, t1: f64) -> f64 {
        match self {
            Curve::Line(_) | Curve::Arc(_) => 0.5 * (t0 + t1),
            _ => spans::bisector_crossing(self, t0, t1),
        }
    }
    /// Where the part crosses the line through `a` along `direction` from one side to the other, strictly inside, ascending.
    pub fn line_crossings(&self, a: Point, direction: Vec2, t0: f64, t1: f64) -> Vec<f64> {
        match self {
            Curve::Line(l) => l.line_crossings(a, direction, t0, t1),
            Curve::Arc(arc) => {
                let polished = |t: f64| {
                    let step = (self.point(t) - a).cross(direction) / arc.derivative(t).cross(direction);
                    Some(t - step).filter(|s| *s > t0 && *s < t1).unwrap_or(t)
                };
                arc.line_crossings(a, direction, t0, t1).into_iter().map(polished).collect()
            }
            Curve::Bezier(bezier) if bezier.is_beside_line(a, direction) => Vec::new(),
            _ => spans::line_crossings(self, a, direction, t0, t1),
        }
    }
    /// Where the part, followed from its end `end` (t0 or t1), first reaches the distance `radius` from that end point.
    pub fn leaves_ball(&self, end: End, radius: f64, t0: f64, t1: f64) -> Option<f64> {
        match self {
            Curve::Line(l) => l.leaves_ball(end, radius, t0, t1),
            Curve::Arc(a) => a.leaves_ball(end, radius, t0, t1),
            _ => spans::leaves_ball(self, end, radius, t0, t1),
        }
    }
}

// ---- makers of other curves ----
impl Curve {
    /// The part t0..t1 as a curve of its own, of the same kind; its ends are exactly `point(t0)` and `point(t1)`.
    pub fn part(&self, t0: f64, t1: f64) -> Self {
        let ends = [self.point(t0), self.point(t1)];
        match self {
            Curve::Line(_) => Curve::Line(Line { start: ends[0], end: ends[1] }),
            Curve::Arc(a) => Curve::Arc(a.part(t0, t1, ends)),
            Curve::Ellipse(e) => Curve::Ellipse(Box::new(e.part(t0, t1, ends))),
            Curve::Bezier(b) => Curve::Bezier(Box::new(b.part(t0, t1, ends))),
            Curve::Spline(s) => Curve::Spline(Box::new(s.part(t0, t1, ends))),
        }
    }
    /// The same curve followed the other way: its point at t is this one's at 1 − t.
    pub fn reversed(&self) -> Self {
        let turned = |ends: [Point; 2]| [ends[1], ends[0]];
        match self {
            Curve::Line(l) => Curve::Line(Line { start: l.end, end: l.start }),
            Curve::Arc(a) => Curve::Arc(CircularArc {
                start_rad: a.start_rad + a.sweep_rad,
                sweep_rad: -a.sweep_rad,
                ends: turned(a.ends),
                ..*a
            }),
            Curve::Ellipse(e) => Curve::Ellipse(Box::new(EllipticArc {
                start_rad: e.angle(1.0),
                sweep_rad: -e.sweep_rad,
                ends: turned(e.ends),
                ..**e
            })),
            Curve::Bezier(b) => Curve::Bezier(Box::new(b.reversed())),
            Curve::Spline(s) => Curve::Spline(Box::new(s.reversed())),
        }
    }
    /// The curve moved by the similarity that takes its ends to `start` and `end` (exactly those bits). For a small move: welding.
    /// A closed curve is translated. Where the similarity would move other points much farther than the ends (a curve that nearly
    /// closes), and where a curve closes or opens, the moves of the ends are spread along the curve instead.
    pub fn with_ends(&self, start: Point, end: Point) -> Self {
        weld::with_ends(self, start, end)
    }
    /// All coordinates times a power of two: exact.
    pub fn scaled(&self, factor: f64) -> Self {
        let scale = |p: Point| crate::geometry::scaled(p, factor);
        match self {
            Curve::Line(l) => Curve::Line(Line { start: scale(l.start), end: scale(l.end) }),
            Curve::Arc(a) => Curve::Arc(CircularArc {
                center: scale(a.center),
                radius: a.radius * factor,
                ends: a.ends.map(scale),
                ..*a
            }),
            Curve::Ellipse(e) => Curve::Ellipse(Box::new(EllipticArc {
                center: scale(e.center),
                u: e.u * factor,
                v: e.v * factor,
                ends: e.ends.map(scale),
                ..**e
            })),
            Curve::Bezier(b) => Curve::Bezier(Box::new(b.mapped(scale))),
            Curve::Spline(s) => Curve::Spline(Box::new(s.mapped(scale))),
        }
    }
    /// Any non-degenerate affine image, exact in kind (a circle under a skew becomes an ellipse).
    pub fn transformed(&self, map: kurbo::Affine) -> Self {
        let [a, b, c, d, _, _] = map.as_coeffs();
        let (x_axis, y_axis) = (Vec2::new(a, b), Vec2::new(c, d));
        let vector = |v: Vec2| x_axis * v.x + y_axis * v.y;
        let ellipse = |e: EllipticArc| {
            let ends = e.ends.map(|p| map * p);
            let (center, u, v) = (map * e.center, vector(e.u), vector(e.v));
            Curve::Ellipse(Box::new(EllipticArc { center, u, v, ends, ..e }))
        };
        match self {
            Curve::Line(l) => Curve::Line(Line { start: map * l.start, end: map * l.end }),
            Curve::Arc(arc) => arc.transformed(map).map_or_else(|| ellipse(arc.as_ellipse()), Curve::Arc),
            Curve::Ellipse(e) => ellipse(**e),
            Curve::Bezier(bezier) => Curve::Bezier(Box::new(bezier.mapped(|p| map * p))),
            Curve::Spline(s) => Curve::Spline(Box::new(s.mapped(|p| map * p))),
        }
    }
}

impl Curve {
    /// One Newton step from a parameter near the foot of the perpendicular from p, where it comes nearer.
    fn polished_foot(&self, p: Point, t: f64, t0: f64, t1: f64) -> f64 {
        let (offset, d, dd) = (self.point(t) - p, self.derivative(t), self.second_derivative(t));
        let step = offset.dot(d) / (d.dot(d) + offset.dot(dd));
        let stepped = (t - step).clamp(t0, t1);
        if length(self.point(stepped) - p) < length(offset) { stepped } else { t }
    }

    /// The first of some parameters whose point is nearest.
    fn nearest_of(&self, p: Point, candidates: &[f64]) -> f64 {
        let mut best = (f64::INFINITY, candidates[0]);
        for t in candidates {
            let distance = length(self.point(*t) - p);
            if distance < best.0 {
                best = (distance, *t);
            }
        }
        best.1
    }
}
