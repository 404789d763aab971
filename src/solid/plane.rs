//! Planes through points, to the last bits.

use super::exact::{Place, collinear};
use crate::geometry::Frame;
use crate::geometry::space::{cross, dot, length, minus, plus, times, unit};

/// A plane: a point of it, and the unit vector at right angles to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub origin: Place,
    pub normal: Place,
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_virtual = sum - a;
    (sum, (a - (sum - b_virtual)) + (b - b_virtual))
}

/// Dekker's product, without fused multiply-add.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let split = |v: f64| {
        let c = 134_217_729.0 * v; // 2^27 + 1
        let high = c - (c - v);
        (high, v - high)
    };
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (product, al * bl - (((product - ah * bh) - al * bh) - ah * bl))
}

impl Plane {
    /// How far a place lies in front of the plane, computed with twice the digits of `f64`.
    pub(super) fn height(&self, p: Place) -> f64 {
        let (mut high, mut low) = (0.0, 0.0);
        for ((x, origin), normal) in p.into_iter().zip(self.origin).zip(self.normal) {
            let (difference, error) = two_sum(x, -origin);
            let (product, rest) = two_product(difference, normal);
            let (sum, lost) = two_sum(high, product);
            high = sum;
            low += lost + rest + error * normal;
        }
        high + low
    }

    /// The greatest distance of some places.
    pub(super) fn worst(&self, places: &[Place]) -> f64 {
        places.iter().map(|&p| self.height(p).abs()).fold(0.0, f64::max)
    }

    /// The coordinate axis along which the plane is seen best, the sign telling whether its front is seen.
    pub(super) fn axis(&self) -> (usize, bool) {
        let axis = (0..3).fold(0, |best, k| if self.normal[k].abs() > self.normal[best].abs() { k } else { best });
        (axis, self.normal[axis] > 0.0)
    }

    /// The plane by least squares of heights over `places`, near the plane `self`, through all of `fixed` (of more than
    /// two of them: by least squares of `fixed` alone).
    pub(super) fn fitted(self, places: &[Place], fixed: &[Place]) -> Option<Self> {
        let mut plane = self;
        let places = if fixed.len() > 2 { fixed } else { places };
        // The heights are small against the extent: the second round is for planes that begin far off.
        for _ in 0..3 {
            let origin = match fixed {
                [] => mean(places),
                [first, ..] if fixed.len() <= 2 => *first,
                _ => mean(fixed),
            };
            let toward = if let [a, b] = fixed { minus(*b, *a) } else { [0.0; 3] };
            let start = match fixed {
                // The line through both is in the plane.
                [a, b] => {
                    let along = unit(minus(*b, *a))?;
                    minus(plane.normal, times(along, dot(along, plane.normal)))
                }
                _ => plane.normal,
            };
            let frame = Frame::of_plane(origin, start, toward)?;
            let here = Plane { origin, normal: frame.normal() };
            let (a, b, c) = slopes(&here, &frame, places, fixed.len())?;
            let normal = minus(here.normal, plus(times(frame.x, a), times(frame.y, b)));
            plane = Plane { origin: plus(origin, times(here.normal, c)), normal: unit(normal)? };
        }
        Some(plane)
    }
}

fn mean(places: &[Place]) -> Place {
    let sum = places.iter().fold([0.0; 3], |sum, &p| plus(sum, p));
    times(sum, 1.0 / places.len().max(1) as f64)
}

/// The slopes along x and y and the offset of heights over places; with one point held, no offset, with two, no slope
/// along x.
fn slopes(plane: &Plane, frame: &Frame, places: &[Place], held: usize) -> Option<(f64, f64, f64)> {
    let (mut uu, mut uv, mut vv, mut uh, mut vh, mut h0, mut u0, mut v0) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for &p in places {
        let (at, h) = (frame.flat(p), plane.height(p));
        (uu, uv, vv) = (uu + at.x * at.x, uv + at.x * at.y, vv + at.y * at.y);
        (uh, vh) = (uh + at.x * h, vh + at.y * h);
        (h0, u0, v0) = (h0 + h, u0 + at.x, v0 + at.y);
    }
    let n = places.len() as f64;
    let (free, turning) = (held != 1 && held != 2, held != 2);
    if free {
        // About the mean, slopes and offset are independent.
        (uu, uv, vv) = (uu - u0 * u0 / n, uv - u0 * v0 / n, vv - v0 * v0 / n);
        (uh, vh) = (uh - u0 * h0 / n, vh - v0 * h0 / n);
    }
    let (a, b) = if turning {
        let det = uu * vv - uv * uv;
        ((uh * vv - vh * uv) / det, (vh * uu - uh * uv) / det)
    } else {
        (0.0, vh / vv)
    };
    let c = if free { (h0 - a * u0 - b * v0) / n } else { 0.0 };
    (a.is_finite() && b.is_finite() && c.is_finite()).then_some((a, b, c))
}

/// Three of some places, far apart and not on one line, by their positions; `None` where there are none such.
pub(super) fn three_far(places: &[Place]) -> Option<[usize; 3]> {
    let first = places.first()?;
    let far = |from: Place| {
        (0..places.len()).max_by(|&i, &j| {
            let d = |k: usize| length(minus(places[k], from));
            d(i).total_cmp(&d(j)).then(j.cmp(&i))
        })
    };
    let a = far(*first)?;
    let b = far(places[a])?;
    let along = minus(places[b], places[a]);
    let from_line = |k: usize| length(cross(along, minus(places[k], places[a])));
    let c = (0..places.len()).max_by(|&i, &j| from_line(i).total_cmp(&from_line(j)).then(j.cmp(&i)))?;
    if !collinear([places[a], places[b], places[c]]) {
        return Some([a, b, c]);
    }
    let c = (0..places.len()).find(|&k| !collinear([places[a], places[b], places[k]]))?;
    Some([a, b, c])
}

/// The plane through three places.
pub(super) fn through([a, b, c]: [Place; 3]) -> Option<Plane> {
    Some(Plane { origin: a, normal: unit(cross(minus(b, a), minus(c, a)))? })
}
