//! Places where polygons cross themselves, by exact signs.

use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Rect, bounds_of, magnitude, scaled, unit_scale};

/// The first place where a ring crosses itself, and the two edges there; edge `i` leads from point `i` to the next.
pub fn first_crossing(ring: &[Point]) -> Option<(Point, [usize; 2])> {
    let unit = unit_scale(magnitude(bounds_of(ring.iter().copied())?));
    let points: Vec<Point> = ring.iter().map(|&p| scaled(p, unit)).collect();
    let n = points.len();
    let ends = |i: usize| (points[i], points[(i + 1) % n]);
    let hierarchy = BoxHierarchy::new((0..n).map(|i| Rect::from_points(ends(i).0, ends(i).1)));
    (0..n).find_map(|i| {
        let (a, b) = ends(i);
        let mut crossed = None;
        hierarchy.meeting(Rect::from_points(a, b), |j| {
            let (c, d) = ends(j);
            if j > i && cross(a, b, c, d) {
                crossed = Some(j);
            }
            crossed.is_none()
        });
        let j = crossed?;
        Some((place(ring[i], ring[(i + 1) % n], ring[j], ring[(j + 1) % n]), [i, j]))
    })
}

/// A place where the surfaces of a contour meet before its trailing edge.
pub struct Meeting {
    /// The place.
    pub at: Point,
    /// The edge of the upper surface that meets, by its first point.
    pub upper: usize,
    /// The edge of the lower surface that meets, by its first point.
    pub lower: usize,
    /// The largest distance from `at` of the points behind it.
    pub reach: f64,
}

/// The foremost meeting of the edges near the two ends of a contour of the width `wide`. `closed`: its ends are one
/// point, at which edges may meet.
pub fn meeting_at_tail(points: &[Point], closed: bool, wide: f64) -> Option<Meeting> {
    // With coordinates of three decimals, surfaces may touch over two hundredths of the chord.
    let near = 0.02 * wide;
    // The largest number of edges that are examined on either surface.
    const EDGES: usize = 400;
    let n = points.len();
    if n < 6 {
        return None;
    }
    let (first, last) = (points[0], points[n - 1]);
    let most = EDGES.min((n - 1) / 2);
    let uppers = (0..most).take_while(|&i| (points[i] - first).hypot() <= near).count();
    let lowers = (0..most).take_while(|&k| (points[n - 1 - k] - last).hypot() <= near).count();
    let edge = |i: usize| (points[i], points[i + 1]);
    let is_joint = |i: usize, j: usize| closed && i == 0 && j == n - 2;
    let meet = |i: usize, j: usize| {
        let ((a, b), (c, d)) = (edge(i), edge(j));
        !is_joint(i, j) && touch(a, b, c, d)
    };
    (0..uppers).rev().find_map(|i| {
        let j = (n - 1 - lowers..n - 1).find(|&j| meet(i, j))?;
        let ((a, b), (c, d)) = (edge(i), edge(j));
        let at = place(a, b, c, d);
        let behind = points[..=i].iter().chain(&points[j + 1..]);
        let reach = behind.map(|p| (*p - at).hypot()).fold(0.0, f64::max);
        Some(Meeting { at, upper: i, lower: j, reach })
    })
}

/// The sides of a segment on which the ends of another one lie.
fn sides(p: Point, q: Point, r: Point, s: Point) -> [Orientation; 2] {
    [orient(p, q, r), orient(p, q, s)]
}

/// Whether two segments cross inside both.
fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let opposite = |sides: [Orientation; 2]| {
        matches!(
            sides,
            [Orientation::Clockwise, Orientation::CounterClockwise]
                | [Orientation::CounterClockwise, Orientation::Clockwise]
        )
    };
    opposite(sides(a, b, c, d)) && opposite(sides(c, d, a, b))
}

/// Whether two segments have a point in common.
fn touch(a: Point, b: Point, c: Point, d: Point) -> bool {
    let apart = |sides: [Orientation; 2]| sides[0] == sides[1] && sides[0] != Orientation::Collinear;
    let (first, second) = (Rect::from_points(a, b), Rect::from_points(c, d));
    let boxes = first.x0 <= second.x1 && second.x0 <= first.x1 && first.y0 <= second.y1 && second.y0 <= first.y1;
    boxes && !apart(sides(a, b, c, d)) && !apart(sides(c, d, a, b))
}

/// A common place of two segments; for parallel segments an end that lies on the other.
fn place(a: Point, b: Point, c: Point, d: Point) -> Point {
    let (u, v) = (b - a, d - c);
    let across = u.cross(v);
    if across == 0.0 {
        let on_second = (b - c).dot(v);
        return if (0.0..=v.hypot2()).contains(&on_second) { b } else { c };
    }
    let t = ((c - a).cross(v) / across).clamp(0.0, 1.0);
    a.lerp(b, t)
}
