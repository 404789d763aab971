//! Polynomials in Bernstein form over [0, 1]: values, products, subdivision, and sign changes by Descartes' rule.
//!
//! The number of sign variations of the coefficients is an upper bound of the number of roots in (0, 1), and has the
//! same parity (variation diminishing; Lane & Riesenfeld 1981). So halving until each part has at most one variation
//! isolates every sign change, for any degree.
//!
//! ```text
//!   c₀ ●             ● c₃       The polynomial crosses 0 at most as often as its control polygon c₀ … c₃. The signs +
//!       ╲           ╱           − − + have two variations: no root or two. Halved at ½, the coefficients of the left
//!   ─────╲─────────╱───── 0     part go from + to − once, those of the right part from − to + once: one root each.
//!         ●───────●
//!        c₁       c₂
//! ```

use crate::geometry::Vec2;
use std::borrow::Cow;
use std::ops::{Add, Mul, Sub};

/// Rows of Pascal's triangle that are stored.
const ROWS: usize = 48;
/// The largest number of coefficients that are evaluated on the stack.
const SMALL: usize = 16;
/// The budget of parts in a search for sign changes: 50 halvings for each of some dozens of roots.
const PIECE_BUDGET: usize = 1 << 13;

static PASCAL: [[f64; ROWS]; ROWS] = pascal();

const fn pascal() -> [[f64; ROWS]; ROWS] {
    let mut rows = [[0.0; ROWS]; ROWS];
    let mut n = 0;
    while n < ROWS {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
}

/// The binomial coefficients of n, times `scale`.
fn binomials(n: usize, scale: f64) -> Vec<f64> {
    let mut row = vec![scale; n + 1];
    for k in 1..=n / 2 {
        row[k] = row[k - 1] * (n + 1 - k) as f64 / k as f64;
        row[n - k] = row[k];
    }
    row
}

/// The types of coefficients: numbers, vectors, homogeneous points.
pub(super) trait Coefficient: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {}
impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>> Coefficient for T {}

/// a + t (b − a), exact at t = 0 and t = 1.
fn lerp<T: Coefficient>(a: T, b: T, t: f64) -> T {
    a * (1.0 - t) + b * t
}

/// The value at t of the polynomial with `count` ≥ 1 coefficients: by de Casteljau's algorithm, or in linear time where
/// there are many.
pub(super) fn value_by<T: Coefficient>(count: usize, coefficient: impl Fn(usize) -> T, t: f64) -> T {
    if count <= SMALL {
        let mut b = [coefficient(0); SMALL];
        for (i, slot) in b.iter_mut().enumerate().take(count).skip(1) {
            *slot = coefficient(i);
        }
        collapse(&mut b[..count], t)
    } else {
        mean_from_mode(count - 1, coefficient, t)
    }
}

/// The value at t as the mean of the coefficients, weighted by the Bernstein polynomials of degree n. The weights
/// follow from their ratios, in both directions from the greatest one. So they are at most 1, and each is accurate to
/// 3n roundings, as in de Casteljau's algorithm, in n steps instead of n²/2.
fn mean_from_mode<T: Coefficient>(n: usize, coefficient: impl Fn(usize) -> T, t: f64) -> T {
    let mode = (((n + 1) as f64 * t) as usize).min(n);
    let (mut sum, mut total) = (coefficient(mode), 1.0);
    let mut weight = 1.0;
    for k in (0..mode).rev() {
        weight *= (k + 1) as f64 * (1.0 - t) / ((n - k) as f64 * t);
        (sum, total) = (sum + coefficient(k) * weight, total + weight);
    }
    weight = 1.0;
    for k in mode + 1..=n {
        weight *= (n + 1 - k) as f64 * t / (k as f64 * (1.0 - t));
        (sum, total) = (sum + coefficient(k) * weight, total + weight);
    }
    sum * (1.0 / total)
}

/// The value at t of the polynomial with coefficients `c`.
pub(super) fn value<T: Coefficient>(c: &[T], t: f64) -> T {
    value_by(c.len(), |i| c[i], t)
}

fn collapse<T: Coefficient>(b: &mut [T], t: f64) -> T {
    for last in (1..b.len()).rev() {
        for i in 0..last {
            b[i] = lerp(b[i], b[i + 1], t);
        }
    }
    b[0]
}

/// The coefficients over 0..t and over t..1.
pub(super) fn split<T: Coefficient>(c: &[T], t: f64) -> (Vec<T>, Vec<T>) {
    let mut right = c.to_vec();
    let mut left = Vec::with_capacity(c.len());
    for last in (0..c.len()).rev() {
        left.push(right[0]);
        for i in 0..last {
            right[i] = lerp(right[i], right[i + 1], t);
        }
    }
    (left, right)
}

/// The coefficients over t0..t1.
pub(super) fn restricted<T: Coefficient>(c: &[T], t0: f64, t1: f64) -> Vec<T> {
    let head = if t1 < 1.0 { split(c, t1).0 } else { c.to_vec() };
    if t0 > 0.0 { split(&head, t0 / t1.min(1.0)).1 } else { head }
}

/// The coefficients of the derivative (for a constant: one zero).
pub(super) fn derivative<T: Coefficient>(c: &[T]) -> Vec<T> {
    let degree = (c.len() - 1) as f64;
    if c.len() == 1 {
        return vec![c[0] * 0.0];
    }
    c.windows(2).map(|pair| (pair[1] - pair[0]) * degree).collect()
}

/// The product of two polynomials, where `times` multiplies coefficients (a plain, dot or cross product).
pub(super) fn product<A: Copy, B: Copy, C: Coefficient>(a: &[A], b: &[B], times: impl Fn(A, B) -> C) -> Vec<C> {
    let (n, m) = (a.len() - 1, b.len() - 1);
    if n + m >= ROWS {
        return long_product(a, b, times);
    }
    let (row_a, row_b, row) = (&PASCAL[n], &PASCAL[m], &PASCAL[n + m]);
    (0..=n + m)
        .map(|k| {
            let first = k.saturating_sub(m);
            let term = |i: usize| times(a[i], b[k - i]) * (row_a[i] * row_b[k - i] / row[k]);
            (first + 1..=k.min(n)).fold(term(first), |sum, i| sum + term(i))
        })
        .collect()
}

/// [`product`] for high degrees, where the binomial coefficients are large: they are scaled by powers of two to a
/// middle size, and the sums are built in parallel.
fn long_product<A: Copy, B: Copy, C: Coefficient>(a: &[A], b: &[B], times: impl Fn(A, B) -> C) -> Vec<C> {
    let (n, m) = (a.len() - 1, b.len() - 1);
    let [scale_a, scale_b] = [n, m].map(|n| libm::exp2(-((n / 2) as f64)));
    let (row_a, row_b) = (binomials(n, scale_a), binomials(m, scale_b));
    let term = |i: usize, j: usize| times(a[i], b[j]) * (row_a[i] * row_b[j]);
    let mut sums: Vec<C> = (0..=m).map(|j| term(0, j)).collect();
    for i in 1..=n {
        for (j, sum) in sums[i..].iter_mut().enumerate() {
            *sum = *sum + term(i, j);
        }
        sums.push(term(i, m));
    }
    sums.into_iter().zip(binomials(n + m, scale_a * scale_b)).map(|(sum, row)| sum * (1.0 / row)).collect()
}

/// Divides by t a polynomial that vanishes at 0.
pub(super) fn over_t(c: &[f64]) -> Vec<f64> {
    let n = c.len() - 1;
    (1..=n).map(|i| c[i] * n as f64 / i as f64).collect()
}

/// Divides by 1 − t a polynomial that vanishes at 1.
pub(super) fn over_one_minus_t(c: &[f64]) -> Vec<f64> {
    let n = c.len() - 1;
    (0..n).map(|i| c[i] * n as f64 / (n - i) as f64).collect()
}

/// The largest absolute value of the coefficients.
pub(super) fn largest(c: &[f64]) -> f64 {
    c.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// The largest length of the coefficients.
pub(super) fn longest(c: &[Vec2]) -> f64 {
    c.iter().fold(0.0, |m, v| m.max(super::length(*v)))
}

/// An interval over which a function changes sign once (or an odd number of times).
#[derive(Clone, Copy, Debug)]
pub(super) struct SignChange {
    /// The start of the interval.
    pub lo: f64,
    /// The end of the interval; may equal `lo`.
    pub hi: f64,
    /// Whether the sign changes from negative to positive.
    pub rising: bool,
}

/// The signs of the coefficients above `noise`: whether the first and the last are positive, and the number of
/// variations. `None` where all are noise.
pub(super) fn variations(c: &[f64], noise: f64) -> Option<(bool, bool, usize)> {
    let mut signs = c.iter().filter(|v| v.abs() > noise).map(|v| *v > 0.0);
    let first = signs.next()?;
    let mut last = first;
    let mut count = 0;
    for sign in signs {
        count += usize::from(sign != last);
        last = sign;
    }
    Some((first, last, count))
}

/// Intervals in which the polynomial changes sign in [0, 1], ascending. Values within `noise` of zero have no sign. A
/// double root is no change.
pub(super) fn sign_changes(c: &[f64], noise: f64) -> Vec<SignChange> {
    /// After this many halvings there is no number between the ends of a part.
    const DEPTH: u32 = 52;
    let mut found = Vec::new();
    let mut before: Option<(bool, f64)> = None;
    let mut stack: Vec<(f64, f64, u32, Vec<f64>)> = Vec::new();
    let mut current = Some((0.0, 1.0, 0, Cow::Borrowed(c)));
    for _ in 0..PIECE_BUDGET {
        let Some((lo, hi, depth, piece)) =
            current.take().or_else(|| stack.pop().map(|p| (p.0, p.1, p.2, Cow::Owned(p.3))))
        else {
            break;
        };
        let Some((first, last, count)) = variations(&piece, noise) else { continue };
        if count > 1 && depth < DEPTH {
            let mid = 0.5 * (lo + hi);
            let (left, right) = split(&piece, 0.5);
            stack.push((mid, hi, depth + 1, right));
            stack.push((lo, mid, depth + 1, left));
            continue;
        }
        if let Some((sign, end)) = before.filter(|b| b.0 != first) {
            found.push(SignChange { lo: end, hi: lo, rising: !sign });
        }
        if first != last {
            found.push(SignChange { lo, hi, rising: last });
        }
        before = Some((last, hi));
    }
    found
}

/// The parameters at which the polynomial changes sign inside (0, 1), ascending.
pub(super) fn roots(c: &[f64], noise: f64) -> Vec<f64> {
    let mut found: Vec<f64> = sign_changes(c, noise).iter().map(|change| crossing(|t| value(c, t), change)).collect();
    found.retain(|t| *t > 0.0 && *t < 1.0);
    found.dedup();
    found
}

/// The root of `f` in an interval over which it changes sign, by Chandrupatla's method (1997): bisection, with inverse
/// quadratic interpolation where that is safe.
pub(super) fn crossing(f: impl Fn(f64) -> f64, change: &SignChange) -> f64 {
    /// Bisection alone needs 1075 − 52 halvings at worst to reach the last bit next to zero; 200 reach 1e-60.
    const BUDGET: usize = 200;
    let SignChange { lo, hi, rising } = *change;
    let sign = if rising { 1.0 } else { -1.0 };
    let (mut a, mut b) = (lo, hi);
    let (mut fa, mut fb) = (sign * f(a), sign * f(b));
    if hi <= lo {
        return lo;
    }
    // The signs inside the interval are given by `change`, even where the value at an end is 0 or below rounding
    // (another root lies there).
    match (fa < 0.0, fb > 0.0) {
        (true, true) => {}
        (true, false) => fb = -fa,
        (false, true) => fa = -fb,
        // Both values are lost: the value between them replaces them, so that the steps are the same at every scale.
        (false, false) => {
            fb = f(0.5 * (a + b)).abs().max(f64::MIN_POSITIVE);
            fa = -fb;
        }
    }
    let mut step = 0.5;
    for _ in 0..BUDGET {
        let x = a + step * (b - a);
        let fx = sign * f(x);
        let (c, fc);
        if (fx > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (x, fx);
        let (best, f_best) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        // One unit in the last place of the parameter.
        let least = f64::EPSILON * best.abs() / (b - a).abs();
        if f_best == 0.0 || least > 0.5 || a == b || fx.is_nan() {
            return best;
        }
        let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        step = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
        step = if step.is_finite() { step.clamp(least, 1.0 - least) } else { 0.5 };
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of ∏ (t − r).
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        roots.iter().fold(vec![1.0], |p, r| product(&p, &[-r, 1.0 - r], |a, b| a * b))
    }

    #[test]
    fn roots_are_found_at_every_degree() {
        for wanted in [vec![0.5], vec![0.1, 0.2], vec![0.25, 0.5, 0.75], vec![0.1, 0.100001, 0.9, 0.95, 0.99]] {
            let found = roots(&with_roots(&wanted), 0.0);
            assert_eq!(found.len(), wanted.len(), "{found:?}");
            for (f, w) in found.iter().zip(&wanted) {
                assert!((f - w).abs() < 1e-9, "{f} {w}");
            }
        }
        assert!(roots(&with_roots(&[0.3, 0.3]), 1e-14).is_empty());
        let triple = roots(&with_roots(&[0.3, 0.3, 0.3]), 1e-15);
        assert!(triple.len() == 1 && (triple[0] - 0.3).abs() < 1e-4, "{triple:?}");
        assert!(roots(&with_roots(&[-0.5, 1.5]), 0.0).is_empty());
        assert!(roots(&[0.0; 5], 0.0).is_empty() && roots(&[f64::NAN; 5], 0.0).is_empty());
    }

    #[test]
    fn values_of_high_degree_are_those_of_de_casteljau() {
        for n in [16, 47, 300] {
            // Coefficients over thirty orders of magnitude, of both signs.
            let c: Vec<f64> = (0..=n).map(|k| libm::sin(7.0 * k as f64) * libm::exp10((k * 37 % 31) as f64)).collect();
            let size: Vec<f64> = c.iter().map(|v| v.abs()).collect();
            for t in [0.0, 1e-300, 1e-9, 0.1, 0.5, 0.7, 1.0 - 1e-9, 1.0 - f64::EPSILON / 2.0, 1.0] {
                let slow = collapse(&mut c.clone(), t);
                // Both are right to so many roundings of the terms that they add up.
                let slack = 4.0 * n as f64 * f64::EPSILON * collapse(&mut size.clone(), t);
                assert!((value(&c, t) - slow).abs() <= slack, "degree {n} at {t}");
            }
            assert_eq!([value(&c, 0.0), value(&c, 1.0)], [c[0], c[n]]);
        }
    }

    #[test]
    fn products_of_any_degree_have_the_values_of_their_factors() {
        for (n, m) in [(1, 50), (40, 9), (300, 299), (600, 600)] {
            let coefficients =
                |n: usize, pace: f64| (0..=n).map(|k| libm::sin(pace * k as f64) + 1.5).collect::<Vec<_>>();
            let (a, b) = (coefficients(n, 1.3), coefficients(m, 2.9));
            let ab = product(&a, &b, |x, y| x * y);
            assert_eq!(ab.len(), n + m + 1);
            for t in [0.0, 0.01, 0.37, 0.5, 0.99, 1.0] {
                let [whole, parts] = [value(&ab, t), value(&a, t) * value(&b, t)];
                assert!((whole - parts).abs() <= 1e-12 * parts, "{n} × {m} at {t}: {whole} and {parts}");
            }
        }
    }

    #[test]
    fn products_values_and_parts_agree() {
        let (a, b) = ([1.0, -2.0, 3.0, 0.5], [2.0, 1.0, -1.0]);
        let ab = product(&a, &b, |x, y| x * y);
        let part = restricted(&ab, 0.2, 0.7);
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            assert!((value(&ab, t) - value(&a, t) * value(&b, t)).abs() < 1e-14);
            assert!((value(&part, t) - value(&ab, 0.2 + 0.5 * t)).abs() < 1e-14);
        }
        assert_eq!(binomials(60, 0.5)[30].round(), 59_132_290_782_430_712.0);
    }
}
