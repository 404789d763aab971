//! SPLINE entities and spline edges of hatches, also where the file departs from the format.

use super::figure::{Figure, Notices, Refusal, built, single};
use super::plane::flat;
use super::sections::Record;
use crate::curve::Curve;
use crate::geometry::{Point, Vec2};
use crate::import::ImportError;

/// Largest degree of a spline; CAD systems stop at 25. Memory grows with the degree of each span, so it stays
/// proportional to the file.
const MAX_DEGREE: i64 = 30;
/// Largest step backward in the knots where the entity gives no tolerance (group 42).
const KNOT_TOLERANCE: f64 = 1e-7;
/// Largest tolerance that the entity may give, as a part of the range of the knots. A larger one would move the curve.
const LARGEST_KNOT_TOLERANCE: f64 = 1e-6;

/// The data of a SPLINE, or of a spline edge of a hatch.
pub(super) struct SplineData {
    /// The degree.
    pub degree: i64,
    /// The knots.
    pub knots: Vec<f64>,
    /// Tolerance of knots, group 42.
    pub knot_tolerance: f64,
    /// The control points.
    pub control: Vec<Point>,
    /// The weights, empty where there are none.
    pub weights: Vec<f64>,
    /// The fit points.
    pub fit: Vec<Point>,
    /// Directions at start and end, of curves through fit points.
    pub tangents: [Option<Vec2>; 2],
    /// Whether the curve is closed.
    pub closed: bool,
}

/// A SPLINE.
pub(super) fn spline(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let (control, fit) = (record.points(10)?, record.points(11)?);
    let level = flat(if control.is_empty() { &fit } else { &control });
    let data = SplineData {
        degree: record.integer(71, 3)?,
        knots: record.reals(40)?,
        knot_tolerance: record.real(42, KNOT_TOLERANCE)?,
        control: plain(&control),
        weights: record.reals(41)?,
        fit: plain(&fit),
        tangents: tangents(record)?,
        closed: record.integer(70, 0)? & 1 != 0,
    };
    let codes = if control.is_empty() { [11, 21] } else { [10, 20] };
    Ok(single(data.curve(record, notices)?, level, record.last_decimal(&codes)))
}

fn plain(points: &[[f64; 3]]) -> Vec<Point> {
    points.iter().map(|p| Point::new(p[0], p[1])).collect()
}

/// The directions at both ends, groups 12 and 13, where they are given.
fn tangents(record: &Record) -> Result<[Option<Vec2>; 2], ImportError> {
    let tangent = |code| {
        let given = record.optional_point(code)?.map(|[x, y, _]| Vec2::new(x, y));
        Ok::<_, ImportError>(given.filter(|t| t.x != 0.0 || t.y != 0.0))
    };
    Ok([tangent(12)?, tangent(13)?])
}

impl SplineData {
    /// The data of an edge of a hatch, which has group codes of its own.
    pub fn of_edge(edge: &Record) -> Result<Self, ImportError> {
        Ok(Self {
            degree: edge.integer(94, 3)?,
            knots: edge.reals(40)?,
            knot_tolerance: KNOT_TOLERANCE,
            control: plain(&edge.points(10)?),
            weights: edge.reals(42)?,
            fit: plain(&edge.points(11)?),
            tangents: tangents(edge)?,
            closed: edge.integer(74, 0)? != 0,
        })
    }

    /// The curve of the data.
    pub fn curve(mut self, record: &Record, notices: &mut Notices) -> Result<Curve, Refusal> {
        if self.control.is_empty() {
            return self.through_fit_points(record, notices);
        }
        if !(1..=MAX_DEGREE).contains(&self.degree) {
            return Err(record.broken(format!("a spline of degree {}, not 1 to {MAX_DEGREE}", self.degree)).into());
        }
        self.order_knots(notices);
        // A common factor of all weights, also −1, does not change the curve.
        if self.weights.iter().all(|w| *w < 0.0) {
            self.weights.iter_mut().for_each(|w| *w = -*w);
        }
        let degree = self.degree as usize;
        let (knots, control, weights) = self.unwrapped(degree, notices);
        let curve = Curve::nurbs(degree, &knots, &control, Some(&weights[..]).filter(|w| !w.is_empty()));
        built(record, curve)
    }

    /// Makes equal the knots that step backward within the tolerance.
    fn order_knots(&mut self, notices: &mut Notices) {
        let range = |pick: fn(f64, f64) -> f64| self.knots.iter().copied().reduce(pick).unwrap_or(0.0);
        let most = LARGEST_KNOT_TOLERANCE * (range(f64::max) - range(f64::min));
        let tolerance = self.knot_tolerance.min(most);
        for i in 1..self.knots.len() {
            let back = self.knots[i - 1] - self.knots[i];
            if back > 0.0 && back <= tolerance {
                notices.add("Knots of splines that lie out of order within their tolerance (group 42) were made one.");
                self.knots[i] = self.knots[i - 1];
            }
        }
    }

    fn through_fit_points(self, record: &Record, notices: &mut Notices) -> Result<Curve, Refusal> {
        notices.add(
            "Splines that have fit points only are drawn as cubic splines through them: by chord length, with their end tangents where they \
             are given, else natural; or periodic ones.",
        );
        let mut distinct = self.fit.clone();
        distinct.dedup();
        match distinct.len() {
            0 => Err(record.broken("a spline without points").into()),
            1 => Err(Refusal::Degenerate),
            _ if self.closed => built(record, Curve::periodic_spline(&self.fit)),
            _ => built(record, Curve::fitted_spline(&self.fit, self.tangents)),
        }
    }

    /// Knots, control points and weights, with one knot for each control point, for each degree and one more.
    ///
    /// Some writers give one period only of a periodic spline: a knot more than control points. It is continued by its
    /// period, each knot with the control point of the period before.
    fn unwrapped(self, degree: usize, notices: &mut Notices) -> (Vec<f64>, Vec<Point>, Vec<f64>) {
        let Self { mut knots, mut control, mut weights, closed, .. } = self;
        let n = control.len();
        if knots.is_empty() && n > degree {
            notices.add("Splines without knots are drawn with uniform ones.");
            knots = (0..=n + degree).map(|i| (i.max(degree) - degree).min(n - degree) as f64).collect();
        } else if closed && knots.len() == n + 1 && degree < n {
            let period = knots[n] - knots[0];
            let before: Vec<f64> = knots[n - degree..n].iter().map(|k| k - period).collect();
            let after: Vec<f64> = knots[1..=degree].iter().map(|k| k + period).collect();
            knots = [before, knots, after].concat();
            control.extend_from_within(..degree);
            if weights.len() == n {
                weights.extend_from_within(..degree);
            }
        }
        (knots, control, weights)
    }
}
