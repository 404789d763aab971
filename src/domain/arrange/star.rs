//! Stars: the curves at every point, counter-clockwise. The order is topological: where tangents do not tell, it is read off a circle.

use super::ArrangeError;
use crate::curve::{Curve, End};
use crate::domain::{DomainCurve, Incident};
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Vec2, turn_from};
use crate::ids::{CurveId, IdVec, PointId};
use std::cmp::Ordering;

/// Tangents that differ by less than this (rad) are not trusted to tell the order: moving the ends of curves together by a tolerance
/// of 1e-9 of the drawing turns the tangents of a curve a thousandth as long by 1e-6.
const TANGENTS_TELL: f64 = 1e-6;

/// Circles that are tried around a point, each half the one before.
const CIRCLES: usize = 24;

/// The star of every point.
pub(super) fn stars(
    points: &IdVec<PointId, Point>,
    curves: &IdVec<CurveId, DomainCurve>,
) -> Result<IdVec<PointId, Vec<Incident>>, ArrangeError> {
    let mut stars: IdVec<PointId, Vec<Incident>> = vec![Vec::new(); points.len()].into();
    for (id, curve) in curves.enumerate() {
        stars[curve.ends[0]].push(Incident { curve: id, end: End::Start });
        stars[curve.ends[1]].push(Incident { curve: id, end: End::Finish });
    }
    for (star, &at) in stars.iter_mut().zip(points.iter()) {
        if star.len() > 1 {
            order(at, star, curves)?;
        }
    }
    Ok(stars)
}

/// Sorts a star counter-clockwise.
fn order(at: Point, star: &mut Vec<Incident>, curves: &IdVec<CurveId, DomainCurve>) -> Result<(), ArrangeError> {
    let curve = |i: &Incident| &curves[i.curve].curve;
    if star.iter().all(|i| matches!(curve(i), Curve::Line(_))) {
        sort_around(at, star, |i| far_end(curve(i), i.end));
        return Ok(());
    }
    let direction = |i: &Incident| curve(i).direction_at(i.end);
    let mut by_angle: Vec<(Vec2, Incident)> = star.iter().map(|i| (direction(i), *i)).collect();
    by_angle.sort_by(|a, b| angle(a.0).total_cmp(&angle(b.0)).then(a.1.curve.cmp(&b.1.curve)));
    let following = by_angle.iter().cycle().skip(1);
    if by_angle.iter().zip(following).all(|(a, b)| turn_from(a.0, b.0).abs() > TANGENTS_TELL) {
        *star = by_angle.into_iter().map(|(_, i)| i).collect();
        return Ok(());
    }
    order_on_circle(at, star, curves)
}

/// Sorts a star by where its curves first leave a circle around the point. Curves that meet nowhere inside leave it in the order in
/// which they lie around the point, whatever its radius: the largest circle that all of them reach tells them apart best.
fn order_on_circle(at: Point, star: &mut [Incident], curves: &IdVec<CurveId, DomainCurve>) -> Result<(), ArrangeError> {
    let reach = |i: &Incident| {
        let curve = &curves[i.curve].curve;
        (1..=8)
            .map(|k| curve.point(k as f64 / 8.0).distance(at))
            .chain([curve.point(0.0).distance(at)])
            .fold(0.0, f64::max)
    };
    // Half as far as the curve with the shortest reach: two curves that share both ends are widest apart about there.
    let mut radius = star.iter().map(reach).fold(f64::INFINITY, f64::min) / 2.0;
    for _ in 0..CIRCLES {
        let exits: Option<Vec<(Incident, Point)>> = star.iter().map(|i| Some((*i, exit(curves, i, radius)?))).collect();
        if let Some(exits) = exits.filter(|exits| are_apart(at, radius, exits)) {
            let exit_of = |i: &Incident| exits.iter().find(|e| e.0 == *i).map_or(at, |e| e.1);
            sort_around(at, star, exit_of);
            return Ok(());
        }
        radius /= 2.0;
    }
    Err(undecided(at, star, curves))
}

fn undecided(at: Point, star: &[Incident], curves: &IdVec<CurveId, DomainCurve>) -> ArrangeError {
    let kinds: Vec<_> = star.iter().map(|i| curves[i.curve].curve.kind()).collect();
    ArrangeError {
        what: format!("curves ({}) touch so closely that their order around a point cannot be told", kinds.join(", ")),
        at,
        help: "raise the tolerance so that they become one, or remove all but one of them".into(),
    }
}

fn exit(curves: &IdVec<CurveId, DomainCurve>, i: &Incident, radius: f64) -> Option<Point> {
    let curve = &curves[i.curve].curve;
    curve.leaves_ball(i.end, radius, 0.0, 1.0).map(|t| curve.point(t))
}

/// Whether rounding cannot have swapped two exits: neighbours on the circle are 64 units in the last place apart.
fn are_apart(at: Point, radius: f64, exits: &[(Incident, Point)]) -> bool {
    let noise = 64.0 * f64::EPSILON * at.x.abs().max(at.y.abs()).max(radius);
    let mut angles: Vec<(f64, Point)> = exits.iter().map(|&(_, p)| (angle(p - at), p)).collect();
    angles.sort_by(|a, b| a.0.total_cmp(&b.0));
    let following = angles.iter().cycle().skip(1);
    angles.iter().zip(following).all(|(a, b)| a.1.distance(b.1) > noise)
}

fn angle(v: Vec2) -> f64 {
    libm::atan2(v.y, v.x)
}

fn far_end(curve: &Curve, end: End) -> Point {
    match end {
        End::Start => curve.end(),
        End::Finish => curve.start(),
    }
}

/// Sorts a star counter-clockwise by one point on each of its curves: half planes, then exact orientations.
fn sort_around(at: Point, star: &mut [Incident], point: impl Fn(&Incident) -> Point) {
    let below = |p: Point| (p.y, p.x) < (at.y, at.x);
    star.sort_by(|a, b| {
        let (p, q) = (point(a), point(b));
        below(p).cmp(&below(q)).then_with(|| match orient(at, p, q) {
            Orientation::CounterClockwise => Ordering::Less,
            Orientation::Clockwise => Ordering::Greater,
            Orientation::Collinear => a.curve.cmp(&b.curve),
        })
    });
}
