//! Exact signs: the only way in which a kernel reads coordinates.
//!
//! Each sign is decided by a static filter, inlined, or where that is not sufficient by Shewchuk's adaptive expansions
//! (crate `robust`). Coordinates must lie within about 2^±180 ([`super::unit_scale`] scales any drawing to that): the
//! expansions have no guard against overflow.
//!
//! ```text
//!          c ●                  d ●                      ● p
//!           ╱ ╲             ╭──────╮                   ╱   ╲
//!          ╱   ╲          a ●      ● c              x ●─────● y
//!       a ●─────● b         ╰──●───╯
//!                              b
//!     orient: c left of       in_circle: d inside, on,      in_diametral: the angle at p is more than 90° inside the
//!     the line a → b          or outside the circle abc     circle with the diameter xy, less outside
//! ```

use super::Point;
use robust::Coord;

/// The orientation of three points.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Orientation {
    /// The third point lies to the right of the line from the first to the second.
    Clockwise,
    /// The points lie on one line, or two of them are equal.
    Collinear,
    /// The third point lies to the left of the line from the first to the second.
    CounterClockwise,
}

/// The position of a point relative to a circle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CircleSide {
    /// Strictly inside the circle.
    Inside,
    /// Exactly on the circle.
    On,
    /// Strictly outside the circle.
    Outside,
}

fn coord(p: Point) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

/// The orientation of the triangle `a b c`.
#[inline]
pub fn orient(a: Point, b: Point, c: Point) -> Orientation {
    orient_filtered(a, b, c).unwrap_or_else(|| orient_adaptive(a, b, c))
}

/// The orientation of the triangle `a b c`; `None` where the static filter does not decide.
#[inline]
pub fn orient_filtered(a: Point, b: Point, c: Point) -> Option<Orientation> {
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let det = left - right;
    // Shewchuk's ccwerrboundA = (3 + 16ε)ε with ε = 2^-53.
    let bound = 3.330_669_073_875_472e-16 * (left.abs() + right.abs());
    if det > bound {
        Some(Orientation::CounterClockwise)
    } else if -det > bound {
        Some(Orientation::Clockwise)
    } else if bound == 0.0 {
        // Both products have a factor 0, and a difference is 0 only for equal numbers: the common case of axis-parallel
        // points.
        Some(Orientation::Collinear)
    } else {
        None
    }
}

/// The orientation of the triangle `a b c` by expansions, where [`orient_filtered`] does not decide.
#[cold]
pub fn orient_adaptive(a: Point, b: Point, c: Point) -> Orientation {
    let det = robust::orient2d(coord(a), coord(b), coord(c));
    if det > 0.0 {
        Orientation::CounterClockwise
    } else if det < 0.0 {
        Orientation::Clockwise
    } else {
        Orientation::Collinear
    }
}

/// Whether `p`, collinear with `a` and `b`, lies strictly between them.
#[inline]
pub fn strictly_between(a: Point, p: Point, b: Point) -> bool {
    let (a, p, b) = ((a.x, a.y), (p.x, p.y), (b.x, b.y));
    (a < p && p < b) || (b < p && p < a)
}

/// The position of `d` relative to the circle through the counter-clockwise triangle `a b c`.
#[inline]
pub fn in_circle(a: Point, b: Point, c: Point, d: Point) -> CircleSide {
    in_circle_filtered(a, b, c, d).unwrap_or_else(|| in_circle_adaptive(a, b, c, d))
}

/// [`in_circle`]; `None` where the static filter does not decide.
#[inline]
pub fn in_circle_filtered(a: Point, b: Point, c: Point, d: Point) -> Option<CircleSide> {
    let (adx, ady) = (a.x - d.x, a.y - d.y);
    let (bdx, bdy) = (b.x - d.x, b.y - d.y);
    let (cdx, cdy) = (c.x - d.x, c.y - d.y);
    let (bdxcdy, cdxbdy) = (bdx * cdy, cdx * bdy);
    let (cdxady, adxcdy) = (cdx * ady, adx * cdy);
    let (adxbdy, bdxady) = (adx * bdy, bdx * ady);
    let alift = adx * adx + ady * ady;
    let blift = bdx * bdx + bdy * bdy;
    let clift = cdx * cdx + cdy * cdy;
    let det = alift * (bdxcdy - cdxbdy) + blift * (cdxady - adxcdy) + clift * (adxbdy - bdxady);
    let permanent = (bdxcdy.abs() + cdxbdy.abs()) * alift
        + (cdxady.abs() + adxcdy.abs()) * blift
        + (adxbdy.abs() + bdxady.abs()) * clift;
    // Shewchuk's iccerrboundA = (10 + 96ε)ε with ε = 2^-53.
    let bound = 1.110_223_024_625_157_7e-15 * permanent;
    if det > bound {
        Some(CircleSide::Inside)
    } else if -det > bound {
        Some(CircleSide::Outside)
    } else {
        None
    }
}

/// [`in_circle`] in short whole numbers or by expansions, where [`in_circle_filtered`] does not decide.
#[cold]
pub fn in_circle_adaptive(a: Point, b: Point, c: Point, d: Point) -> CircleSide {
    let det = in_circle_short(a, b, c, d).unwrap_or_else(|| robust::incircle(coord(a), coord(b), coord(c), coord(d)));
    if det > 0.0 {
        CircleSide::Inside
    } else if det < 0.0 {
        CircleSide::Outside
    } else {
        CircleSide::On
    }
}

/// The in-circle determinant, exact, if the points lie on a common coarse grid, as cocircular points of drawings
/// usually do; else `None`.
///
/// Let all differences be exact, whole multiples of one u, and at most 2^12 u. Then a sum of two products is at most
/// 2^25 u², and the three terms together are at most 3·2^50 u⁴. So every number is a multiple of its unit, less than
/// 2^53 of them, and nothing is rounded. On a square grid this takes less than half the time for the whole
/// triangulation.
fn in_circle_short(a: Point, b: Point, c: Point, d: Point) -> Option<f64> {
    let pairs = [(a.x, d.x), (a.y, d.y), (b.x, d.x), (b.y, d.y), (c.x, d.x), (c.y, d.y)];
    let v = pairs.map(|(from, to)| from - to);
    let largest = v.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    // With 2^e the leading bit of the largest, u = 2^(e − 11). When 1.5·2^52·u is added, numbers are rounded to
    // multiples of u.
    let leading = f64::from_bits(largest.to_bits() & (0x7ff << 52));
    let anchor = 1.5 * (1u64 << 41) as f64 * leading;
    let coarse = v.iter().all(|&v| (v + anchor) - anchor == v);
    let exact = pairs.iter().all(|&(from, to)| two_sum(from, -to).1 == 0.0);
    (coarse && exact).then(|| {
        let [ax, ay, bx, by, cx, cy] = v;
        (ax * ax + ay * ay) * (bx * cy - cx * by)
            + (bx * bx + by * by) * (cx * ay - ax * cy)
            + (cx * cx + cy * cy) * (ax * by - bx * ay)
    })
}

/// The position of `p` relative to the diametral circle of the segment `x y`: the sign of (x − p)·(y − p), exact.
#[inline]
pub fn in_diametral(x: Point, y: Point, p: Point) -> CircleSide {
    let a = (x.x - p.x) * (y.x - p.x);
    let b = (x.y - p.y) * (y.y - p.y);
    let dot = a + b;
    // Each difference and product has a relative error of ε, and the sum one more: as for ccwerrboundA.
    let dot = if dot.abs() > 3.330_669_073_875_472e-16 * (a.abs() + b.abs()) { dot } else { exact_dot(x, y, p) };
    if dot < 0.0 {
        CircleSide::Inside
    } else if dot > 0.0 {
        CircleSide::Outside
    } else {
        CircleSide::On
    }
}

/// A number with the sign of (x − p)·(y − p), by an exact expansion of the eight products.
fn exact_dot(x: Point, y: Point, p: Point) -> f64 {
    let mut sum = Expansion::default();
    for (x, y, p) in [(x.x, y.x, p.x), (x.y, y.y, p.y)] {
        for (a, b) in [(x, y), (-x, p), (-p, y), (p, p)] {
            let (high, low) = two_product(a, b);
            sum.add(low);
            sum.add(high);
        }
    }
    sum.sign_bearer()
}

/// A nonoverlapping expansion of at most sixteen components, smallest first.
#[derive(Default)]
struct Expansion {
    parts: [f64; 16],
    len: usize,
}

impl Expansion {
    /// Shewchuk's Grow-Expansion with zero elimination.
    fn add(&mut self, value: f64) {
        let (mut carry, mut len) = (value, 0);
        for i in 0..self.len {
            let (high, low) = two_sum(carry, self.parts[i]);
            if low != 0.0 {
                self.parts[len] = low;
                len += 1;
            }
            carry = high;
        }
        if carry != 0.0 {
            self.parts[len] = carry;
            len += 1;
        }
        self.len = len;
    }

    /// The largest component, which has the sign of the sum.
    fn sign_bearer(&self) -> f64 {
        if self.len == 0 { 0.0 } else { self.parts[self.len - 1] }
    }
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_virtual = sum - a;
    let a_virtual = sum - b_virtual;
    (sum, (a - a_virtual) + (b - b_virtual))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_lies_on_the_diametral_circle_whatever_the_offset() {
        // 2^-20 and 1e7 can be added to 1 and taken away again without rounding.
        for offset in [0.0, 1.0, 1e7, 0.000_000_953_674_316_406_25] {
            let (x, y) = (Point::new(offset, 0.0), Point::new(offset, 2.0));
            let p = Point::new(offset + 1.0, 1.0);
            assert_eq!(p.x - offset, 1.0);
            assert_eq!(in_diametral(x, y, p), CircleSide::On);
        }
    }

    #[test]
    fn one_ulp_decides_the_diametral_side() {
        let (x, y) = (Point::new(0.1, 0.7), Point::new(0.1, 0.7 + 0.25));
        let on = Point::new(0.1, 0.8);
        assert_eq!(in_diametral(x, y, on), CircleSide::Inside);
        let (x, y) = (Point::new(-1.0, 0.0), Point::new(1.0, 0.0));
        assert_eq!(in_diametral(x, y, Point::new(0.0, 1.0)), CircleSide::On);
        assert_eq!(in_diametral(x, y, Point::new(0.0, 1.0f64.next_down())), CircleSide::Inside);
        assert_eq!(in_diametral(x, y, Point::new(0.0, 1.0f64.next_up())), CircleSide::Outside);
    }

    #[test]
    fn in_circle_agrees_with_whole_numbers_at_any_length() {
        let mut state = 1u64;
        let mut below = |bound: i64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as i64 % bound
        };
        let (mut on, mut short) = (0, 0);
        for i in 0..60_000 {
            // From small grids, rich in cocircular points, across the longest that the short way takes, to long
            // numbers.
            let size = 1i64 << [2, 3, 11, 12, 13, 14, 26][i % 7];
            let unit = [1.0, 1024.0, 9.313225746154785e-10][i % 3]; // powers of two: 0, 10, -30
            let offset = [0, 1 << 40][i % 2];
            let [a, b, c, d] = [0; 4].map(|_| (below(size), below(size)));
            let at = |(x, y): (i64, i64)| Point::new((offset + x) as f64 * unit, (offset + y) as f64 * unit);
            let row = |p: (i64, i64)| {
                let (x, y) = (i128::from(p.0 - d.0), i128::from(p.1 - d.1));
                (x, y, x * x + y * y)
            };
            let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) = (row(a), row(b), row(c));
            let det = az * (bx * cy - cx * by) + bz * (cx * ay - ax * cy) + cz * (ax * by - bx * ay);
            let expected = [CircleSide::Outside, CircleSide::On, CircleSide::Inside][(det.signum() + 1) as usize];
            assert_eq!(in_circle(at(a), at(b), at(c), at(d)), expected, "{a:?} {b:?} {c:?} {d:?}");
            assert_eq!(in_circle_adaptive(at(a), at(b), at(c), at(d)), expected);
            if let Some(value) = in_circle_short(at(a), at(b), at(c), at(d)) {
                assert_eq!(value, det as f64 * unit * unit * unit * unit);
                short += 1;
            }
            on += usize::from(det == 0);
        }
        assert!(on > 4_000 && (30_000..50_000).contains(&short), "{on} cocircular, {short} short");
    }

    #[test]
    fn signs_of_small_integers_agree_with_integer_arithmetic() {
        let grid: Vec<(i64, i64)> = (-2..=2).flat_map(|x| (-2..=2).map(move |y| (x, y))).collect();
        let point = |(x, y): (i64, i64)| Point::new(x as f64 * 0.1, y as f64 * 0.1);
        for &x in &grid {
            for &y in &grid {
                for &p in &grid {
                    let (x, y, p) = (point(x), point(y), point(p));
                    let exact = exact_dot(x, y, p);
                    let side = in_diametral(x, y, p);
                    assert_eq!(side == CircleSide::Inside, exact < 0.0);
                    assert_eq!(side == CircleSide::On, exact == 0.0);
                }
            }
        }
    }
}
