//! Point location among the curves of a domain: the nearest curve and its visible side, and the crossings of an
//! axis-parallel line.

use super::{Domain, Incident};
use crate::curve::{Curve, End};
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Rect, Vec2, turn_from};
use crate::ids::{CurveId, Id, PointId, RegionId};
use std::f64::consts::{PI, TAU};

/// A side of a curve, in the direction of its parameter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    /// Its index in `DomainCurve::sides`.
    pub fn index(self) -> usize {
        match self {
            Side::Left => 0,
            Side::Right => 1,
        }
    }

    /// The opposite side.
    pub fn other(self) -> Self {
        match self {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        }
    }
}

/// A side of a curve that is visible from a point: no curve lies between.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct VisibleSide {
    /// The curve.
    pub curve: CurveId,
    /// The side that faces the point.
    pub side: Side,
    /// The distance from the point to the curve.
    pub distance: f64,
}

/// The direction of an axis-parallel line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Axis {
    Horizontal,
    Vertical,
}

/// Where an axis-parallel line crosses a curve.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Hit {
    /// The coordinate along the line.
    pub along: f64,
    /// The curve that is crossed.
    pub curve: CurveId,
    /// The side of the curve on which the line lies before the crossing, at smaller coordinates.
    pub before: Side,
}

/// Locates points, in about O(log n) each.
pub struct Locator<'a> {
    domain: &'a Domain,
    boxes: BoxHierarchy,
}

impl<'a> Locator<'a> {
    /// Builds the search structure, in O(n log n).
    pub(super) fn new(domain: &'a Domain) -> Self {
        Self { domain, boxes: BoxHierarchy::new(domain.curves.iter().map(|c| c.curve.bounds())) }
    }

    /// The kept region that contains `p`; `None` outside all regions. For a point on a curve: the region on one of its
    /// sides.
    pub fn region(&self, p: Point) -> Option<RegionId> {
        let sight = self.sight(p)?;
        self.domain.curves[sight.curve].sides[sight.side.index()]
    }

    /// The nearest curve and the side of it that faces `p`.
    pub(super) fn sight(&self, p: Point) -> Option<VisibleSide> {
        let distance = |i: usize, _| self.curve(i).nearest(p, 0.0, 1.0).1;
        let (item, distance) = self.boxes.nearest(p, f64::INFINITY, distance)?;
        let (curve, side) = self.facing(CurveId::from_index(item), p, distance);
        Some(VisibleSide { curve, side, distance })
    }

    fn curve(&self, i: usize) -> &'a Curve {
        &self.domain.curves[CurveId::from_index(i)].curve
    }

    /// The side of the nearest curve that faces `p`. Where the nearest point is an end, the curve and side that border
    /// the sector with `p`.
    ///
    /// ```text
    ///           · p                     · p
    ///           :                      :                 Left: the foot lies inside `near`, and p on its left side.
    ///   ──────foot──────▶ near        ●──────▶ a         Right: the foot is the corner. The sector that holds p lies
    ///                          corner ╲                  on the left of a, counter-clockwise up to b.
    ///                                  ╲ b
    /// ```
    fn facing(&self, id: CurveId, p: Point, distance: f64) -> (CurveId, Side) {
        let domain = self.domain;
        let near = &domain.curves[id];
        let (t, _) = near.curve.nearest(p, 0.0, 1.0);
        let foot = near.curve.point(t);
        for end in near.ends {
            let corner = domain.points[end];
            // When the foot is this near to an end (an angle of 1e-6 at p), every curve there leaves at about 90° or
            // more from the direction of p. So the sector that holds p is at least about 180° wide, and is found
            // safely.
            if corner.distance(foot) <= 1e-6 * distance {
                return sector(domain, end, p - corner);
            }
        }
        (id, side_of(&near.curve, t, foot, p))
    }

    /// The crossings of an axis-parallel line with all curves, ascending, at the coordinates in `range`. `None` means
    /// that another line must be tried: the line passes within `margin` of an end of a curve, runs nearly along a
    /// curve, or has two crossings that are too near to each other to be ordered.
    ///
    /// ```text
    ///             ╱ a
    ///   ─────────●──────────────▶ along      a rises to the right: before the crossing, the line lies on the left side
    ///           ╱                            of a.
    /// ```
    pub(super) fn hits(&self, axis: Axis, level: f64, range: [f64; 2], margin: f64) -> Option<Vec<Hit>> {
        let strip = match axis {
            Axis::Horizontal => Rect::new(range[0], level, range[1], level),
            Axis::Vertical => Rect::new(level, range[0], level, range[1]),
        };
        let (mut hits, mut clear) = (Vec::new(), true);
        self.boxes.meeting(strip, |i| {
            let id = CurveId::from_index(i);
            let curve = self.curve(i);
            clear &= [curve.start(), curve.end()].iter().all(|&p| (across(axis, p) - level).abs() > margin);
            clear = clear && crossings(curve, axis, level, |along, before| hits.push(Hit { along, curve: id, before }));
            clear
        });
        hits.retain(|hit| range[0] <= hit.along && hit.along <= range[1]);
        hits.sort_by(|a, b| a.along.total_cmp(&b.along).then(a.curve.cmp(&b.curve)));
        let told = hits.windows(2).all(|pair| pair[1].along - pair[0].along > margin);
        (clear && told).then_some(hits)
    }
}

fn across(axis: Axis, p: Point) -> f64 {
    match axis {
        Axis::Horizontal => p.y,
        Axis::Vertical => p.x,
    }
}

/// Calls `each` with every crossing of the curve; returns `false` where the curve runs nearly along the line.
fn crossings(curve: &Curve, axis: Axis, level: f64, mut each: impl FnMut(f64, Side)) -> bool {
    let mut report = |p: Point, tangent: Vec2| {
        let (along, rise) = match axis {
            Axis::Horizontal => (p.x, tangent.y),
            Axis::Vertical => (p.y, -tangent.x),
        };
        each(along, if rise > 0.0 { Side::Left } else { Side::Right });
        // Below a slope of 1e-6 rounded arithmetic cannot distinguish a crossing from a contact.
        rise.abs() > 1e-6 * tangent.hypot()
    };
    if let Some(line) = curve.as_line() {
        let (a, b) = (across(axis, line.start), across(axis, line.end));
        let t = (level - a) / (b - a);
        // Both ends keep clear of the level, so the crossing is certain, however flat the line.
        if (a < level) != (b < level) {
            report(line.start.lerp(line.end, t), line.end - line.start);
        }
        return true;
    }
    let (through, direction) = match axis {
        Axis::Horizontal => (Point::new(curve.start().x, level), Vec2::new(1.0, 0.0)),
        Axis::Vertical => (Point::new(level, curve.start().y), Vec2::new(0.0, 1.0)),
    };
    let ts = curve.line_crossings(through, direction, 0.0, 1.0);
    ts.into_iter().all(|t| report(curve.point(t), curve.tangent(t, End::Start)))
}

fn side_of(curve: &Curve, t: f64, foot: Point, p: Point) -> Side {
    let left = match curve.as_line() {
        Some(line) => orient(line.start, line.end, p) == Orientation::CounterClockwise,
        None => curve.tangent(t, End::Start).cross(p - foot) > 0.0,
    };
    if left { Side::Left } else { Side::Right }
}

/// The curve and side that border the sector in the direction `towards` at a point of P.
fn sector(domain: &Domain, at: PointId, towards: Vec2) -> (CurveId, Side) {
    let star = domain.star(at);
    let directions: Vec<Vec2> = star.iter().map(|i| domain.curves[i.curve].curve.direction_at(i.end)).collect();
    let mut best: (f64, Incident) = (f64::NEG_INFINITY, star[0]);
    for (k, &from) in star.iter().enumerate() {
        let gap = gap_after(&directions, k);
        let off = ccw(directions[k], towards);
        let holds = if off < gap { gap } else { gap - TAU };
        if holds > best.0 {
            best = (holds, from);
        }
    }
    (best.1.curve, left_of(best.1))
}

/// The side of the curve that lies counter-clockwise of it around the point.
pub(super) fn left_of(incident: Incident) -> Side {
    match incident.end {
        End::Start => Side::Left,
        End::Finish => Side::Right,
    }
}

/// Tangents that differ by less than this (rad) do not decide the order of a star: the curves themselves do.
pub(super) const TANGENTS_TELL: f64 = 1e-3;

/// The angle, in [0, 2π], of the sector between curve `k` of a star and the next one. `directions` are those in which
/// all curves of the star leave.
///
/// The directions of curves that are nearly tangent may be in the opposite order. The angle then computes to just below
/// a full turn, and is taken as 0 if another curve leaves in another direction. If none does, either result is
/// consistent.
pub(super) fn gap_after(directions: &[Vec2], k: usize) -> f64 {
    let n = directions.len();
    let (from, to) = (directions[k], directions[(k + 1) % n]);
    let gap = ccw(from, to);
    // In a group of tied curves each may be tied only to its neighbours, so the group may span several times the limit.
    let tied = TANGENTS_TELL * n.min(16) as f64;
    let elsewhere = |&other: &Vec2| turn_from(from, other).abs() > tied && turn_from(to, other).abs() > tied;
    match n {
        1 => TAU,
        _ if gap > TAU - 1e-6 => 0.0,
        _ if gap > TAU - tied && directions.iter().any(elsewhere) => 0.0,
        _ => gap,
    }
}

/// Angle from `u` counter-clockwise to `v`, in [0, 2π).
fn ccw(u: Vec2, v: Vec2) -> f64 {
    let turn = turn_from(u, v);
    if turn < 0.0 { (turn + TAU).min(TAU - f64::EPSILON * PI) } else { turn }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sectors_of_a_star_close_the_circle_whatever_nearly_equal_tangents_say() {
        let towards = |angle: f64| Vec2::new(libm::cos(angle), libm::sin(angle));
        let gaps = |angles: &[f64]| -> Vec<f64> {
            let directions: Vec<Vec2> = angles.iter().map(|&angle| towards(angle)).collect();
            (0..angles.len()).map(|k| gap_after(&directions, k)).collect()
        };
        // The second curve lies left of the first, though it leaves a little to the right of it.
        let reversed = gaps(&[0.0, -1e-4, 3.0]);
        assert_eq!(reversed[0], 0.0);
        assert!((reversed.iter().sum::<f64>() - TAU).abs() < 1e-3);
        // Sharp corners with nothing else around keep their sectors.
        for sharp in [&[0.0, 1e-4][..], &[0.0, 1e-4, 2e-4]] {
            assert!((gaps(sharp).iter().sum::<f64>() - TAU).abs() < 1e-9);
        }
        assert_eq!(gaps(&[1.0]), [TAU]);
    }
}
