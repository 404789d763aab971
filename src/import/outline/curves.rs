//! The kinds of curves of an outline, and the curves that they describe.

use crate::curve::{Bezier, CircularArc, Curve, EllipticArc, Spline};
use crate::geometry::{Point, Vec2};
use serde::Deserialize;
use std::f64::consts::TAU;
use std::fmt::Display;

/// Largest degree, that of `Curve::bezier`: evaluation costs the square of the degree.
const MAX_DEGREE: usize = 300;
/// Largest distance of the given ends of an arc from those of its angles, in parts of its size: rounding of a file with
/// six decimals.
const END_SLACK: f64 = 1e-5;

/// x and y.
pub(super) type Pair = [f64; 2];

/// An entry of the list of curves.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CurveForm {
    /// The name of its boundary.
    pub(super) name: Option<String>,
    /// Its name in messages.
    pub(super) entity: Option<String>,
    /// The shape of whose outline it is a part.
    pub(super) shape: Option<u32>,
    /// The clip that cuts it.
    pub(super) clip: Option<u32>,
    line: Option<[Pair; 2]>,
    polyline: Option<Vec<Pair>>,
    polygon: Option<Vec<Pair>>,
    arc: Option<ArcForm>,
    circle: Option<CircleForm>,
    ellipse: Option<EllipseForm>,
    bezier: Option<Vec<Pair>>,
    rational_bezier: Option<RationalForm>,
    nurbs: Option<NurbsForm>,
    spline: Option<Vec<Pair>>,
    closed_spline: Option<Vec<Pair>>,
    piecewise_bezier: Option<PiecewiseForm>,
    clothoid: Option<ClothoidForm>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CircleForm {
    center: Pair,
    radius: f64,
}

/// By center and angles, by three points, or by bulge.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ArcForm {
    center: Option<Pair>,
    radius: Option<f64>,
    start_deg: Option<f64>,
    sweep_deg: Option<f64>,
    start_rad: Option<f64>,
    sweep_rad: Option<f64>,
    ends: Option<[Pair; 2]>,
    from: Option<Pair>,
    through: Option<Pair>,
    to: Option<Pair>,
    bulge: Option<f64>,
}

/// By conjugate half axes, or by radii and a rotation.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EllipseForm {
    center: Pair,
    u: Option<Pair>,
    v: Option<Pair>,
    radii: Option<Pair>,
    rotation_deg: Option<f64>,
    start_deg: Option<f64>,
    sweep_deg: Option<f64>,
    start_rad: Option<f64>,
    sweep_rad: Option<f64>,
    ends: Option<[Pair; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RationalForm {
    points: Vec<Pair>,
    weights: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NurbsForm {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<Pair>,
    weights: Option<Vec<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PiecewiseForm {
    knots: Vec<f64>,
    spans: Vec<SpanForm>,
}

/// By its start and its curvature.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClothoidForm {
    from: Pair,
    heading_deg: Option<f64>,
    heading_rad: Option<f64>,
    curvature: Pair,
    length: f64,
    to: Option<Pair>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpanForm {
    points: Vec<Pair>,
    weights: Option<Vec<f64>>,
}

/// A pair as a point.
pub(super) fn point(p: Pair) -> Point {
    Point::new(p[0], p[1])
}

fn all(points: &[Pair]) -> Vec<Point> {
    points.iter().copied().map(point).collect()
}

fn said(error: impl Display) -> String {
    error.to_string()
}

impl CurveForm {
    /// The curves of an entry.
    pub(super) fn curves(self) -> Result<Vec<Curve>, String> {
        let mut kinds: Vec<Result<Vec<Curve>, String>> = Vec::new();
        let mut one = |curve: Result<Curve, String>| kinds.push(curve.map(|c| vec![c]));
        if let Some([a, b]) = self.line {
            one(Curve::line(point(a), point(b)).map_err(said));
        }
        if let Some(arc) = self.arc {
            one(arc.curve());
        }
        if let Some(circle) = self.circle {
            one(Curve::circle(point(circle.center), circle.radius).map_err(said));
        }
        if let Some(ellipse) = self.ellipse {
            one(ellipse.curve());
        }
        if let Some(points) = self.bezier {
            one(bezier(&points, None));
        }
        if let Some(form) = self.rational_bezier {
            one(bezier(&form.points, Some(form.weights)));
        }
        if let Some(form) = self.nurbs {
            one(form.curve());
        }
        if let Some(points) = self.spline {
            one(Curve::natural_spline(&all(&points)).map_err(said));
        }
        if let Some(points) = self.closed_spline {
            one(Curve::periodic_spline(&all(&points)).map_err(said));
        }
        if let Some(form) = self.piecewise_bezier {
            one(form.curve());
        }
        if let Some(form) = self.clothoid {
            one(form.curve());
        }
        if let Some(points) = self.polyline {
            kinds.push(polyline(&all(&points), false));
        }
        if let Some(points) = self.polygon {
            kinds.push(polyline(&all(&points), true));
        }
        if kinds.len() != 1 {
            return Err(format!("holds {} curves, but each entry needs one: `line`, `arc`, `spline`, …", kinds.len()));
        }
        kinds.swap_remove(0)
    }
}

fn polyline(points: &[Point], closed: bool) -> Result<Vec<Curve>, String> {
    let (kind, least) = if closed { ("polygon", 3) } else { ("polyline", 2) };
    if points.len() < least {
        return Err(format!("a {kind} needs {least} points, this one has {}", points.len()));
    }
    let closing = closed.then(|| [points[points.len() - 1], points[0]]);
    let edges = points.windows(2).map(|w| [w[0], w[1]]).chain(closing);
    edges.map(|[a, b]| Curve::line(a, b).map_err(said)).collect()
}

/// A Bézier span. Weights are kept, so that the file reads back the same, with three exceptions: they are all equal;
/// their products would leave the range; they are so unequal that `Curve::rational_bezier` changes them.
fn bezier(points: &[Pair], weights: Option<Vec<f64>>) -> Result<Curve, String> {
    let Some(weights) = weights else { return Curve::bezier(all(points)).map_err(said) };
    match Curve::rational_bezier(all(points), weights.clone()).map_err(said)? {
        Curve::Bezier(made) if is_tame(&weights) && made.weights.as_ref().is_some_and(|w| is_multiple(w, &weights)) => {
            Ok(Curve::Bezier(Box::new(Bezier { weights: Some(weights), ..*made })))
        }
        made => Ok(made),
    }
}

fn is_tame(weights: &[f64]) -> bool {
    weights.iter().all(|w| (1e-30..1e30).contains(w))
}

/// Whether some weights are a power of two times others.
fn is_multiple(weights: &[f64], others: &[f64]) -> bool {
    weights.iter().zip(others).all(|(w, v)| w * others[0] == v * weights[0])
}

/// Start and sweep in radians, from the unit that is given; `None` where there is none.
fn angles(deg: [Option<f64>; 2], rad: [Option<f64>; 2]) -> Result<Option<[f64; 2]>, String> {
    match (deg, rad) {
        ([None, None], [None, None]) => Ok(None),
        ([Some(start), Some(sweep)], [None, None]) => Ok(Some([start.to_radians(), sweep.to_radians()])),
        ([None, None], [Some(start), Some(sweep)]) => Ok(Some([start, sweep])),
        _ => Err("needs `start_deg` and `sweep_deg`, or `start_rad` and `sweep_rad`".into()),
    }
}

impl ArcForm {
    fn curve(self) -> Result<Curve, String> {
        let angles = angles([self.start_deg, self.sweep_deg], [self.start_rad, self.sweep_rad])?;
        let by_center = (self.center, self.radius, angles, self.ends);
        match (by_center, (self.from, self.through, self.to, self.bulge)) {
            ((Some(center), Some(radius), Some(a), ends), (None, None, None, None)) => {
                let arc = Curve::arc(point(center), radius, a[0], a[1]).map_err(said)?;
                match ends {
                    None => Ok(arc),
                    Some(ends) => with_stated_ends(arc, ends),
                }
            }
            ((None, None, None, None), (Some(from), Some(through), Some(to), None)) => {
                Curve::arc_through(point(from), point(through), point(to)).map_err(said)
            }
            ((None, None, None, None), (Some(from), None, Some(to), Some(bulge))) => {
                Curve::bulge(point(from), point(to), bulge).map_err(said)
            }
            _ => Err(
                "an arc is given by `center`, `radius` and angles; by `from`, `through`, `to`; or by `from`, `to`, \
                      `bulge`"
                    .into(),
            ),
        }
    }
}

/// The arc with the ends that the file gives. They must equal its own up to rounding, and each other where it is
/// closed.
fn with_stated_ends(arc: Curve, ends: [Pair; 2]) -> Result<Curve, String> {
    let (own, ends) = ([arc.start(), arc.end()], ends.map(point));
    let check = |size: f64, sweep_rad: f64| {
        let near = |k: usize| (ends[k] - own[k]).hypot() <= END_SLACK * size;
        if !(near(0) && near(1)) {
            return Err("`ends` do not lie where the angles put them");
        }
        if sweep_rad.abs() >= TAU && ends[0] != ends[1] {
            return Err("a full turn needs equal `ends`");
        }
        Ok(())
    };
    match arc {
        Curve::Arc(a) => {
            check(a.radius + a.center.to_vec2().hypot(), a.sweep_rad)?;
            Ok(Curve::Arc(CircularArc { ends, ..a }))
        }
        Curve::Ellipse(e) => {
            check(e.u.hypot() + e.v.hypot() + e.center.to_vec2().hypot(), e.sweep_rad)?;
            Ok(Curve::Ellipse(Box::new(EllipticArc { ends, ..*e })))
        }
        Curve::Line(_) | Curve::Bezier(_) | Curve::Spline(_) | Curve::Clothoid(_) => {
            Err("only arcs have `ends`".into())
        }
    }
}

impl EllipseForm {
    fn curve(self) -> Result<Curve, String> {
        let turn = angles([self.start_deg, self.sweep_deg], [self.start_rad, self.sweep_rad])?.unwrap_or([0.0, TAU]);
        let (u, v) = match (self.u, self.v, self.radii) {
            (Some(u), Some(v), None) if self.rotation_deg.is_none() => (point(u).to_vec2(), point(v).to_vec2()),
            (None, None, Some([a, b])) => {
                let (sin, cos) = libm::sincos(self.rotation_deg.unwrap_or(0.0).to_radians());
                (Vec2::new(a * cos, a * sin), Vec2::new(-b * sin, b * cos))
            }
            _ => return Err("an ellipse is given by half axes `u` and `v`, or by `radii` and `rotation_deg`".into()),
        };
        let center = point(self.center);
        let arc = Curve::ellipse(center, u, v, turn[0], turn[1]).map_err(said)?;
        match self.ends {
            None => Ok(arc),
            Some(ends) => with_stated_ends(arc, ends),
        }
    }
}

impl ClothoidForm {
    fn curve(self) -> Result<Curve, String> {
        let heading_rad = match (self.heading_deg, self.heading_rad) {
            (Some(deg), None) => deg.to_radians(),
            (None, Some(rad)) => rad,
            (None, None) | (Some(_), Some(_)) => return Err("needs `heading_deg` or `heading_rad`".into()),
        };
        let made = Curve::clothoid(point(self.from), heading_rad, self.curvature, self.length).map_err(said)?;
        let Some(to) = self.to.map(point) else { return Ok(made) };
        let size = self.length + made.start().to_vec2().hypot();
        if to.distance(made.end()) > END_SLACK * size || !to.is_finite() {
            return Err("`to` does not lie where the curvatures put it".into());
        }
        // The given end is kept if it equals the computed one up to rounding. A difference in the decimals of the file
        // is removed by a rotation and a scaling.
        Ok(made.with_rounded_end(to).unwrap_or_else(|| made.with_ends(made.start(), to)))
    }
}

impl NurbsForm {
    fn curve(self) -> Result<Curve, String> {
        if self.degree > MAX_DEGREE {
            return Err(format!("degree {} is above the limit of {MAX_DEGREE}", self.degree));
        }
        Curve::nurbs(self.degree, &self.knots, &all(&self.points), self.weights.as_deref()).map_err(said)
    }
}

impl PiecewiseForm {
    fn curve(self) -> Result<Curve, String> {
        let knots = self.knots;
        let ascending = knots.windows(2).all(|w| w[0] < w[1]);
        if knots.len() != self.spans.len() + 1
            || !ascending
            || knots.first() != Some(&0.0)
            || knots.last() != Some(&1.0)
        {
            return Err("needs one knot more than spans, ascending from 0 to 1".into());
        }
        let (mut starts, mut spans) = (Vec::new(), Vec::<Bezier>::new());
        for (i, form) in self.spans.into_iter().enumerate() {
            let next = match bezier(&form.points, form.weights).map_err(|e| format!("spans[{i}]: {e}"))? {
                Curve::Bezier(span) => vec![*span],
                Curve::Spline(evened) => evened.spans,
                other => return Err(format!("spans[{i}]: is not a Bézier curve but a {}", other.kind())),
            };
            if spans.last().is_some_and(|before| before.points.last() != next[0].points.first()) {
                return Err(format!("spans[{i}] does not start where the span before it ends"));
            }
            let step = (knots[i + 1] - knots[i]) / next.len() as f64;
            starts.extend((0..next.len()).map(|k| knots[i] + k as f64 * step));
            spans.extend(next);
        }
        if spans.is_empty() {
            return Err("needs a span".into());
        }
        let knots = starts.into_iter().chain([1.0]).collect();
        Ok(Curve::Spline(Box::new(Spline { knots, spans })))
    }
}
