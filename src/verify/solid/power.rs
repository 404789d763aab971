//! The exact power test: whether a point with a weight lies within the sphere that is orthogonal to four others.
//!
//! ```text
//!   Π(e) = det | a − e   |a − e|² − (w_a − w_e) |        of a positive tetrahedron a b c d: negative where e lies within the
//!              | b − e   |b − e|² − (w_b − w_e) |        orthogonal sphere of a b c d, that is |e − m|² − w_e < R²
//!              | c − e   |c − e|² − (w_c − w_e) |
//!              | d − e   |d − e|² − (w_d − w_e) |
//! ```
//!
//! The last column is |p|² − w_p − (|e|² − w_e) less 2e·(p − e), a combination of the others: the determinant is the
//! same. A filter decides most signs; the rest are whole numbers, since a finite `f64` is one times a power of two. No
//! range is excluded: [`Int`] is as long as the numbers ask for.

use crate::geometry::space::{dot, minus};
use std::cmp::Ordering;

/// A point and its weight.
pub type Weighted = ([f64; 3], f64);

/// The sign of Π(e): `Less` where `e` lies within the orthogonal sphere of the positive tetrahedron `a b c d`, `Equal`
/// where it is orthogonal as well. Reversed for a negative tetrahedron. Coordinates and weights must be finite.
pub fn power_side(tetrahedron: [Weighted; 4], e: Weighted) -> Ordering {
    filtered(&tetrahedron, e).unwrap_or_else(|| exact(&tetrahedron, e))
}

/// The sign where plain arithmetic can tell it.
///
/// With ε = 2⁻⁵³, relative to the same sum of absolute values: a difference errs by ε, a minor of two columns by 4ε, one
/// of three by 8ε, the last column by 6ε (three squares of differences and two sums: 5ε, the weights one more), the
/// product of both by 15ε, the sum of four by 17ε. Terms in ε² and the rounding of the bound itself are within the 20ε
/// that it has.
fn filtered(tetrahedron: &[Weighted; 4], (e, w): Weighted) -> Option<Ordering> {
    let [a, b, c, d] = tetrahedron.map(|(p, _)| minus(p, e));
    let lift = |p: [f64; 3], v: f64| {
        let square = dot(p, p);
        (square - (v - w), square + (v - w).abs())
    };
    let [(_, wa), (_, wb), (_, wc), (_, wd)] = *tetrahedron;
    let lifts = [lift(a, wa), lift(b, wb), lift(c, wc), lift(d, wd)];
    let minors = [minor(b, c, d), minor(a, c, d), minor(a, b, d), minor(a, b, c)];
    let term = |i: usize| lifts[i].0 * minors[i].0;
    let det = (term(3) - term(2)) + (term(1) - term(0));
    let sum: f64 = (0..4).map(|i| lifts[i].1 * minors[i].1).sum();
    // Products of coordinates up to 1 that underflow err by less than 1e-300 in all.
    let bound = 20.0 * (f64::EPSILON / 2.0) * sum + 1e-290;
    if det > bound {
        Some(Ordering::Greater)
    } else if -det > bound {
        Some(Ordering::Less)
    } else {
        None
    }
}

/// A determinant of three rows, and the same sum with absolute values.
#[inline]
fn minor(u: [f64; 3], v: [f64; 3], w: [f64; 3]) -> (f64, f64) {
    let part = |k: usize, i: usize, j: usize| {
        let (left, right) = (v[i] * w[j], v[j] * w[i]);
        (u[k] * (left - right), u[k].abs() * (left.abs() + right.abs()))
    };
    let [x, y, z] = [part(0, 1, 2), part(1, 2, 0), part(2, 0, 1)];
    (x.0 + y.0 + z.0, x.1 + y.1 + z.1)
}

/// The sign in whole numbers. Coordinates are multiples of 2^u, lifts of 2^s with s ≤ 2u that divides the weights, too.
#[cold]
fn exact(tetrahedron: &[Weighted; 4], e: Weighted) -> Ordering {
    let points = || tetrahedron.iter().chain(std::iter::once(&e));
    let (u, high) = range(points().flat_map(|(p, _)| *p)).unwrap_or((0, 1));
    let (weight_low, weight_high) = range(points().map(|(_, w)| *w)).unwrap_or((2 * u, 2 * u + 1));
    let s = (2 * u).min(weight_low);
    // Differences and lifts in bits, sums included; the determinant has 24 products of three of those and one of these.
    let difference = high - u + 1;
    let lift = (2 * (high - u + 1) + 2 + 2 * u - s).max(weight_high - s + 1) + 1;
    let bits = 3 * difference + lift + 5 + 1;
    let frame = Frame { tetrahedron, e, u, s };
    match bits {
        ..=128 => frame.sign::<2>(),
        129..=256 => frame.sign::<4>(),
        257..=384 => frame.sign::<6>(),
        385..=576 => frame.sign::<9>(),
        577..=1024 => frame.sign::<16>(),
        1025..=2048 => frame.sign::<32>(),
        // Two f64 differ by a factor of 2^2098 at most: 5 of them and some bits.
        _ => frame.sign::<192>(),
    }
}

/// Exponents such that every number is a multiple of 2^low and less than 2^high in size; `None` where all are 0.
fn range(numbers: impl Iterator<Item = f64>) -> Option<(i32, i32)> {
    let exponents = numbers.filter(|&x| x != 0.0).map(|x| {
        let (mantissa, exponent) = parts(x);
        (exponent, exponent + 64 - mantissa.leading_zeros() as i32)
    });
    exponents.reduce(|(low, high), (l, h)| (low.min(l), high.max(h)))
}

/// An odd whole number m and an exponent e with |x| = m·2^e, for x other than 0.
fn parts(x: f64) -> (u64, i32) {
    let bits = x.to_bits();
    let (field, fraction) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1));
    let (mantissa, exponent) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    let zeros = mantissa.trailing_zeros();
    (mantissa >> zeros, exponent + zeros as i32)
}

/// The test and the units of its whole numbers.
struct Frame<'t> {
    tetrahedron: &'t [Weighted; 4],
    e: Weighted,
    u: i32,
    s: i32,
}

impl Frame<'_> {
    fn sign<const N: usize>(&self) -> Ordering {
        let rows = self.tetrahedron.map(|(p, w)| {
            let d = [0, 1, 2].map(|k| Int::<N>::of(p[k], self.u).less(Int::of(self.e.0[k], self.u)));
            let square = d[0].times(d[0]).plus(d[1].times(d[1])).plus(d[2].times(d[2]));
            let weight = Int::of(w, self.s).less(Int::of(self.e.1, self.s));
            (d, square.shifted((2 * self.u - self.s) as usize).less(weight))
        });
        let [(a, la), (b, lb), (c, lc), (d, ld)] = rows;
        let minor = |u: [Int<N>; 3], v: [Int<N>; 3], w: [Int<N>; 3]| {
            let part = |k: usize, i: usize, j: usize| u[k].times(v[i].times(w[j]).less(v[j].times(w[i])));
            part(0, 1, 2).plus(part(1, 2, 0)).plus(part(2, 0, 1))
        };
        let last = ld.times(minor(a, b, c)).less(lc.times(minor(a, b, d)));
        let first = lb.times(minor(a, c, d)).less(la.times(minor(b, c, d)));
        last.plus(first).sign()
    }
}

/// A whole number of 64·N bits in two's complement, the lowest word first. Arithmetic is modulo 2^(64 N): a result that
/// fits is right whatever was cut before.
#[derive(Clone, Copy)]
struct Int<const N: usize>([u64; N]);

impl<const N: usize> Int<N> {
    /// `x` in units of 2^unit, of which it must be a multiple.
    fn of(x: f64, unit: i32) -> Self {
        let mut words = [0; N];
        if x == 0.0 {
            return Self(words);
        }
        let (mantissa, exponent) = parts(x);
        words[0] = mantissa;
        let size = Self(words).shifted((exponent - unit) as usize);
        if x < 0.0 { Self([0; N]).less(size) } else { size }
    }

    #[inline]
    fn plus(mut self, other: Self) -> Self {
        let mut carry = false;
        for (word, more) in self.0.iter_mut().zip(other.0) {
            let (sum, over) = word.overflowing_add(more);
            let (sum, again) = sum.overflowing_add(u64::from(carry));
            (*word, carry) = (sum, over || again);
        }
        self
    }

    #[inline]
    fn less(mut self, other: Self) -> Self {
        let mut borrow = false;
        for (word, less) in self.0.iter_mut().zip(other.0) {
            let (rest, under) = word.overflowing_sub(less);
            let (rest, again) = rest.overflowing_sub(u64::from(borrow));
            (*word, borrow) = (rest, under || again);
        }
        self
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let mut product = [0u64; N];
        for i in 0..N {
            let mut carry = 0u128;
            for j in 0..N - i {
                // At most (2^64 − 1)² + 2·(2^64 − 1) = 2^128 − 1.
                carry += u128::from(self.0[i]) * u128::from(other.0[j]) + u128::from(product[i + j]);
                product[i + j] = carry as u64;
                carry >>= 64;
            }
        }
        Self(product)
    }

    fn shifted(self, bits: usize) -> Self {
        let (words, bits) = (bits / 64, bits % 64);
        Self(std::array::from_fn(|i| {
            let word = |back: usize| i.checked_sub(back).map_or(0, |i| self.0[i]);
            if bits == 0 { word(words) } else { word(words) << bits | word(words + 1) >> (64 - bits) }
        }))
    }

    fn sign(self) -> Ordering {
        if (self.0[N - 1] as i64) < 0 {
            Ordering::Less
        } else if self.0.iter().all(|&word| word == 0) {
            Ordering::Equal
        } else {
            Ordering::Greater
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rng::Rng;

    /// Π(e) by cofactors, with the last column as it is defined, in whole numbers.
    fn whole(points: [[i128; 3]; 5], weights: [i128; 5]) -> Ordering {
        let [.., e] = points;
        let lift = |i: usize| points[i].iter().map(|x| x * x).sum::<i128>() - weights[i];
        let row = |i: usize| [points[i][0] - e[0], points[i][1] - e[1], points[i][2] - e[2], lift(i) - lift(4)];
        fn det(rows: &[Vec<i128>]) -> i128 {
            if rows.len() == 1 {
                return rows[0][0];
            }
            (0..rows.len())
                .map(|k| {
                    let rest: Vec<Vec<i128>> =
                        rows.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, row)| row[1..].to_vec()).collect();
                    let sign = if k % 2 == 0 { 1 } else { -1 };
                    sign * rows[k][0] * det(&rest)
                })
                .sum()
        }
        det(&(0..4).map(|i| row(i).to_vec()).collect::<Vec<_>>()).cmp(&0)
    }

    #[test]
    fn a_sphere_has_an_inside() {
        let corner = |x, y, z| ([x, y, z], 0.0);
        let positive = [corner(0., 0., 0.), corner(1., 0., 0.), corner(0., 1., 0.), corner(0., 0., 1.)];
        assert_eq!(power_side(positive, corner(0.5, 0.5, 0.5)), Ordering::Less);
        assert_eq!(power_side(positive, corner(1., 1., 1.)), Ordering::Equal);
        assert_eq!(power_side(positive, corner(1., 1., 1.5)), Ordering::Greater);
        // A heavier point lies deeper; the sphere of a heavier tetrahedron is smaller.
        assert_eq!(power_side(positive, ([1., 1., 1.], 1e-300)), Ordering::Less);
        assert_eq!(power_side(positive.map(|(p, _)| (p, 1e-300)), corner(1., 1., 1.)), Ordering::Greater);
        let heavy_origin = [([0.; 3], 5e-324), positive[1], positive[2], positive[3]];
        assert_eq!(power_side(heavy_origin, corner(1., 1., 1.)), Ordering::Less);
    }

    #[test]
    fn signs_agree_with_whole_numbers_at_every_length() {
        let mut rng = Rng::new(7);
        let (mut ties, mut close) = (0, 0);
        for i in 0..40_000 {
            let size = [2, 3, 5, 1 << 10, 1 << 20][i % 5];
            let mut below = |n: usize| rng.below(n) as i128;
            let points: [[i128; 3]; 5] = std::array::from_fn(|_| std::array::from_fn(|_| below(size)));
            let weights: [i128; 5] = std::array::from_fn(|_| if i % 2 == 0 { below(size) } else { 0 });
            let expected = whole(points, weights);
            ties += usize::from(expected == Ordering::Equal);
            // Powers of two change no sign; a far offset only makes the numbers long.
            for (unit, offset) in [(1.0, 0), (libm::ldexp(1.0, -30), 0), (1.0, 1_i128 << 32)] {
                let at = |i: usize| (points[i].map(|x| (x + offset) as f64 * unit), weights[i] as f64 * unit * unit);
                let tetrahedron = [at(0), at(1), at(2), at(3)];
                assert_eq!(power_side(tetrahedron, at(4)), expected, "{points:?} {weights:?}");
                assert_eq!(exact(&tetrahedron, at(4)), expected);
                close += usize::from(filtered(&tetrahedron, at(4)).is_none());
            }
        }
        assert!(ties > 4000 && close > ties, "{ties} ties, {close} past the filter");
    }
}
