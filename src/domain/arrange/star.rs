//! Stars: the curves at every point, counter-clockwise. Where tangents do not decide the order, it is read off a circle
//! around the point.

use super::error::{ArrangeError, Unarranged};
use crate::curve::{Curve, End};
use crate::domain::locate::TANGENTS_TELL;
use crate::domain::{DomainCurve, Incident};
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Vec2, turn_from};
use crate::ids::{CurveId, Id, IdVec, PointId};
use crate::watch::{Progress, Watch};
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::ops::Range;

/// The number of circles that are tried around a point, each with half the radius of the one before.
const CIRCLES: usize = 24;

/// The star of every point: its curves, counter-clockwise.
///
/// # Errors
///
/// Where curves run so near to each other that rounding hides their order, and where `watch` ends the run.
pub(super) fn stars(
    points: &IdVec<PointId, Point>,
    curves: &IdVec<CurveId, DomainCurve>,
    watch: &mut Watch,
) -> Result<IdVec<PointId, Vec<Incident>>, Unarranged> {
    let mut stars: IdVec<PointId, Vec<Incident>> = vec![Vec::new(); points.len()].into();
    for (id, curve) in curves.enumerate() {
        stars[curve.ends[0]].push(Incident { curve: id, end: End::Start });
        stars[curve.ends[1]].push(Incident { curve: id, end: End::Finish });
    }
    for (star, (id, &at)) in stars.iter_mut().zip(points.enumerate()) {
        Progress { phase: "ordering", vertices: points.len(), queued: points.len() - id.index() }.tell(watch)?;
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
    let mut leaving: Vec<(Vec2, Incident)> = star.iter().map(|i| (curve(i).direction_at(i.end), *i)).collect();
    leaving.sort_by(|a, b| angle(a.0).total_cmp(&angle(b.0)).then(a.1.curve.cmp(&b.1.curve)));
    // Two curves that leave at an angle θ may bend towards each other and cross at once, at a depth of θ²/κ. At 1e-3
    // that is more than rounding (1e-14) for radii of curvature down to 1e-8.
    let are_tied = |a: &(Vec2, Incident), b: &(Vec2, Incident)| turn_from(a.0, b.0).abs() <= TANGENTS_TELL;
    // Begin between two that are not tied, so that no group of tied ones is split between beginning and end.
    let n = leaving.len();
    let begin = (0..n).find(|&k| !are_tied(&leaving[(k + n - 1) % n], &leaving[k])).unwrap_or(0);
    leaving.rotate_left(begin);
    star.clear();
    for group in leaving.chunk_by(are_tied) {
        let mut tied: Vec<Incident> = group.iter().map(|g| g.1).collect();
        if tied.len() > 1 {
            order_tied(at, group[0].0, &mut tied, curves)?;
        }
        star.extend(tied);
    }
    Ok(())
}

/// Sorts curves that leave in one direction, from right to left. One circle may separate only some of them: beside a
/// short curve no circle is large enough for two long ones. The curves that it leaves together are separated by circles
/// of their own.
fn order_tied(
    at: Point,
    ahead: Vec2,
    tied: &mut [Incident],
    curves: &IdVec<CurveId, DomainCurve>,
) -> Result<(), ArrangeError> {
    let mut rest = Vec::from([Range { start: 0, end: tied.len() }]);
    while let Some(range) = rest.pop() {
        let start = range.start;
        let together = part(at, ahead, &mut tied[range], curves)?;
        rest.extend(together.into_iter().map(|run| start + run.start..start + run.end));
    }
    Ok(())
}

/// Sorts curves by where they first leave a circle around the point. Returns the runs of neighbours that the circle
/// does not separate. Curves that meet nowhere inside the circle and stay in the half plane ahead leave it in the order
/// in which they lie, whatever its radius. The largest circle that all of them leave separates them best.
///
/// ```text
///    ╭───c────b────a───╮      a, b and c leave the point `at` in the direction `ahead`, here upwards. On the circle of
///    │    ╲   │   ╱    │      `radius` they are apart: their exits, from right to left, are a, b, c.
///    │     ╲  │  ╱     │
///    │      ╰╮│╭╯      │
///    │        │        │
///    ╰────── at ───────╯
/// ```
fn part(
    at: Point,
    ahead: Vec2,
    tied: &mut [Incident],
    curves: &IdVec<CurveId, DomainCurve>,
) -> Result<Vec<Range<usize>>, ArrangeError> {
    let reach = |i: &Incident| {
        let curve = &curves[i.curve].curve;
        (0..=8).map(|k| curve.point(f64::from(k) / 8.0).distance(at)).fold(0.0, f64::max)
    };
    // Half the shortest reach: two curves that share both ends are about widest apart there.
    let mut radius = tied.iter().map(reach).fold(f64::INFINITY, f64::min) / 2.0;
    for _ in 0..CIRCLES {
        let exits: Option<Vec<Point>> = tied.iter().map(|i| exit(at, ahead, curves, i, radius)).collect();
        if let Some(exits) = exits {
            let mut around: Vec<(Point, Incident)> = exits.into_iter().zip(tied.iter().copied()).collect();
            around.sort_by(|a, b| turn_from(b.0 - at, a.0 - at).total_cmp(&0.0).then(a.1.curve.cmp(&b.1.curve)));
            // Rounding cannot swap neighbours that are more than 16 units in the last place apart. Nearer neighbours
            // are not separated.
            let noise = 16.0 * f64::EPSILON * at.x.abs().max(at.y.abs()).max(radius);
            let mut from = 0;
            let runs = around.chunk_by(|a, b| a.0.distance(b.0) <= noise).map(|run| {
                from += run.len();
                from - run.len()..from
            });
            let runs: Vec<Range<usize>> = runs.collect();
            if runs.len() > 1 {
                tied.iter_mut().zip(around).for_each(|(place, (_, incident))| *place = incident);
                return Ok(runs.into_iter().filter(|run| run.len() > 1).collect());
            }
        }
        radius /= 2.0;
    }
    Err(undecided(at, tied, curves))
}

/// Where a curve first leaves the circle. `None` where it does not, or where it may have left the half plane ahead
/// before.
fn exit(at: Point, ahead: Vec2, curves: &IdVec<CurveId, DomainCurve>, i: &Incident, radius: f64) -> Option<Point> {
    let curve = &curves[i.curve].curve;
    let t = curve.leaves_ball(i.end, radius, 0.0, 1.0)?;
    let turning = match i.end {
        End::Start => curve.turning(0.0, t),
        End::Finish => curve.turning(t, 1.0),
    };
    let point = curve.point(t);
    // A turning below 2π/5 is well below the π/2 of the half plane's border.
    (turning < 0.4 * PI && ahead.dot(point - at) > 0.0).then_some(point)
}

fn undecided(at: Point, star: &[Incident], curves: &IdVec<CurveId, DomainCurve>) -> ArrangeError {
    let kinds: Vec<_> = star.iter().map(|i| curves[i.curve].curve.kind()).collect();
    ArrangeError::near(
        format!("curves ({}) touch so closely that their order around a point cannot be told", kinds.join(", ")),
        at,
        "raise the tolerance so that they become one, or remove all but one of them",
    )
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
