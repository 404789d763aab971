//! Adaptive Gauss–Legendre quadrature.

use kurbo::common::GAUSS_LEGENDRE_COEFFS_16;

/// The integral of a function over a..b; each part is accurate to rounding relative to `scale`, the size of the result.
pub(super) fn integral(f: impl Fn(f64) -> f64, a: f64, b: f64, scale: f64) -> f64 {
    /// The budget of parts: halving 50 times towards each of some dozens of kinks.
    const BUDGET: usize = 1 << 12;
    let rule = |a: f64, b: f64| {
        let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
        half * GAUSS_LEGENDRE_COEFFS_16.iter().map(|(weight, at)| weight * f(mid + half * at)).sum::<f64>()
    };
    // The rounding error of 16 additions.
    let noise = 16.0 * f64::EPSILON * scale.abs();
    let mut stack = vec![(a, b, rule(a, b))];
    let mut sum = 0.0;
    for step in 0.. {
        let Some((a, b, whole)) = stack.pop() else { break };
        let mid = 0.5 * (a + b);
        let (left, right) = (rule(a, mid), rule(mid, b));
        let error = (left + right - whole).abs();
        let settled = error <= noise || error.is_nan() || step >= BUDGET || mid <= a || mid >= b;
        if settled {
            sum += left + right;
        } else {
            stack.push((mid, b, right));
            stack.push((a, mid, left));
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::integral;

    #[test]
    fn smooth_and_kinked_functions_are_integrated_to_rounding() {
        assert!((integral(libm::exp, 0.0, 1.0, 1.0) - (std::f64::consts::E - 1.0)).abs() < 1e-15);
        assert!((integral(|t| (t - 0.3).abs(), 0.0, 1.0, 1.0) - 0.29).abs() < 1e-13);
        assert!((integral(f64::sqrt, 0.0, 1.0, 1.0) - 2.0 / 3.0).abs() < 1e-13);
    }
}
