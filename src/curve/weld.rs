//! Moving a curve's ends a little, so that it meets its vertices bit for bit.

use super::{Bezier, CircularArc, Curve, EllipticArc, Line, length};
use crate::geometry::{Point, Vec2};

/// How much farther than its ends a similarity may move a curve's points. Three quarters of a circle are 2.8 radii across at most,
/// twice their chord, and the chord changes by up to twice the ends' move: so that much of a circle still is moved as a circle.
const AMPLIFICATION_MAX: f64 = 4.0;

/// See [`Curve::with_ends`].
pub(super) fn with_ends(curve: &Curve, start: Point, end: Point) -> Curve {
    let moves = [start - curve.start(), end - curve.end()];
    if moves == [Vec2::ZERO; 2] {
        return curve.clone();
    }
    let chord = curve.end() - curve.start();
    let farthest = length(moves[0]).max(length(moves[1]));
    let extent = curve.bounds();
    let across = length(Vec2::new(extent.width(), extent.height()));
    let amplified = length(moves[1] - moves[0]) * across > AMPLIFICATION_MAX * farthest * length(chord);
    let mut moved = if chord == Vec2::ZERO || end == start || amplified {
        spread(curve, moves)
    } else {
        similar(curve, start, end - start)
    };
    set_ends(&mut moved, start, end);
    moved
}

/// The image under the similarity that takes the start to `start` and the chord to `wanted`; the last bits of the ends aside.
fn similar(curve: &Curve, start: Point, wanted: Vec2) -> Curve {
    let (from, chord) = (curve.start(), curve.end() - curve.start());
    let factor = Vec2::new(chord.dot(wanted), chord.cross(wanted)) / chord.dot(chord);
    let vector = |v: Vec2| Vec2::new(factor.x * v.x - factor.y * v.y, factor.y * v.x + factor.x * v.y);
    let point = |p: Point| start + vector(p - from);
    match curve {
        Curve::Line(l) => Curve::Line(*l),
        Curve::Arc(a) => Curve::Arc(CircularArc {
            center: point(a.center),
            radius: a.radius * length(factor),
            start_rad: a.start_rad + libm::atan2(factor.y, factor.x),
            ..*a
        }),
        Curve::Ellipse(e) => {
            let (center, u, v) = (point(e.center), vector(e.u), vector(e.v));
            Curve::Ellipse(Box::new(EllipticArc { center, u, v, ..**e }))
        }
        Curve::Bezier(b) => Curve::Bezier(Box::new(b.mapped(point))),
        Curve::Spline(s) => Curve::Spline(Box::new(s.mapped(point))),
    }
}

/// The moves of the two ends spread along the curve, linearly by the parameter (of a rational one: by the control points): no point
/// moves farther than the ends. An arc moves by their mean, and [`Curve::point`] spreads the rest.
fn spread(curve: &Curve, moves: [Vec2; 2]) -> Curve {
    let at = |t: f64| if moves[0] == moves[1] { moves[0] } else { moves[0] * (1.0 - t) + moves[1] * t };
    let bezier = |b: &Bezier, t0: f64, t1: f64| {
        let mut moved = b.clone();
        let last = moved.degree();
        for (i, p) in moved.points.iter_mut().enumerate() {
            // Neighbours share the joint's move to the last bit.
            let t = if i == last { t1 } else { t0 + (t1 - t0) * (i as f64 / last as f64) };
            *p += at(t);
        }
        moved
    };
    match curve {
        Curve::Line(l) => Curve::Line(*l),
        Curve::Arc(a) => Curve::Arc(CircularArc { center: a.center + at(0.5), ..*a }),
        Curve::Ellipse(e) => Curve::Ellipse(Box::new(EllipticArc { center: e.center + at(0.5), ..**e })),
        Curve::Bezier(b) => Curve::Bezier(Box::new(bezier(b, 0.0, 1.0))),
        Curve::Spline(s) => {
            let mut moved = (**s).clone();
            for (span, knots) in moved.spans.iter_mut().zip(s.knots.windows(2)) {
                *span = bezier(span, knots[0], knots[1]);
            }
            Curve::Spline(Box::new(moved))
        }
    }
}

fn set_ends(curve: &mut Curve, start: Point, end: Point) {
    match curve {
        Curve::Line(l) => *l = Line { start, end },
        Curve::Arc(a) => a.ends = [start, end],
        Curve::Ellipse(e) => e.ends = [start, end],
        Curve::Bezier(b) => set_control_ends(std::slice::from_mut(&mut **b), start, end),
        Curve::Spline(s) => set_control_ends(&mut s.spans, start, end),
    }
}

fn set_control_ends(spans: &mut [Bezier], start: Point, end: Point) {
    if let Some(first) = spans.first_mut().and_then(|span| span.points.first_mut()) {
        *first = start;
    }
    if let Some(last) = spans.last_mut().and_then(|span| span.points.last_mut()) {
        *last = end;
    }
}
