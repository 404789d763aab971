//! Exact signs in space: on which side of a plane, on which line.

use crate::geometry::Point;
use crate::geometry::exact::{Orientation, orient};
use robust::Coord3D;

/// A place in space.
pub(super) type Place = [f64; 3];

/// Where a point lies to the plane of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Side {
    /// On the side from which the triangle is seen counter-clockwise.
    Front,
    /// Exactly in the plane.
    On,
    /// On the other side.
    Back,
}

fn coord(p: Place) -> Coord3D<f64> {
    Coord3D { x: p[0], y: p[1], z: p[2] }
}

/// Where `d` lies to the plane of the triangle `a b c`.
pub(super) fn side(a: Place, b: Place, c: Place, d: Place) -> Side {
    // Positive where `d` lies below the triangle.
    let det = robust::orient3d(coord(a), coord(b), coord(c), coord(d));
    if det < 0.0 {
        Side::Front
    } else if det > 0.0 {
        Side::Back
    } else {
        Side::On
    }
}

/// The point as seen along a coordinate axis, the axis pointing at the eye.
pub(super) fn along(axis: usize, p: Place) -> Point {
    Point::new(p[(axis + 1) % 3], p[(axis + 2) % 3])
}

/// The orientation of a triangle as seen along a coordinate axis.
pub(super) fn turn(axis: usize, [a, b, c]: [Place; 3]) -> Orientation {
    orient(along(axis, a), along(axis, b), along(axis, c))
}

/// Whether three points lie on one line, or two of them are equal.
pub(super) fn collinear(abc: [Place; 3]) -> bool {
    (0..3).all(|axis| turn(axis, abc) == Orientation::Collinear)
}

/// Whether `p` lies on the line segment `a b` and is none of its ends.
pub(super) fn within_segment(a: Place, b: Place, p: Place) -> bool {
    // One coordinate in which the ends differ puts points of the line in order.
    let Some(k) = (0..3).find(|&k| a[k] != b[k]) else { return false };
    let between = (a[k] < p[k] && p[k] < b[k]) || (b[k] < p[k] && p[k] < a[k]);
    between && collinear([a, b, p])
}

/// The coordinate axis along which a triangle is seen largest, of those along which it is seen at all; `None` where its
/// points lie on one line.
pub(super) fn axis_of(abc: [Place; 3]) -> Option<usize> {
    use crate::geometry::space::{cross, minus};
    let normal = cross(minus(abc[1], abc[0]), minus(abc[2], abc[0]));
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| normal[j].abs().total_cmp(&normal[i].abs()));
    axes.into_iter().find(|&axis| turn(axis, abc) != Orientation::Collinear)
}

/// Whether `p`, in the plane of a triangle, lies in the triangle or on its border, as seen along `axis`.
pub(super) fn in_triangle(axis: usize, [a, b, c]: [Place; 3], p: Place) -> bool {
    let turns = [turn(axis, [a, b, p]), turn(axis, [b, c, p]), turn(axis, [c, a, p])];
    !(turns.contains(&Orientation::Clockwise) && turns.contains(&Orientation::CounterClockwise))
}
