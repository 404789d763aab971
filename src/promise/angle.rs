//! The smallest angles for which corner lopping is proven to terminate.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, SQRT_2};

/// The guarantee of the angle rule on straight input, arcsin ¼ = 14.4775° in radians.
///
/// Where z encroaches xy, the rule splits xy at p, with |xp| : |py| = a : b, a = |xz| ≤ b = |yz|. With |xy| = 2
/// Stewart's theorem gives |pz|²/|xp|² = (b/a)·((a+b)² − 4)/4, and a² + b² ≤ 4 (z is in the circle) bounds that by b²/2
/// ≤ 2: η = √2, approached as a → 0; with ζ = √2, arcsin(1/(2ζη)) = arcsin ¼. No η of the rule is known on curves, so
/// nothing is proven there.
pub const ANGLE_RULE_GUARANTEE_RAD: f64 = 0.252_680_255_142_078_65;

/// The κ (radians) below which corner lopping with the bisector rule is proven to terminate where no curve has a lens
/// angle above `lambda_rad` (Pav & Walkington 2005, Corollary 3, with λ for τ; 0 ≤ λ ≤ π/3). 20.705° for straight
/// input.
///
/// κ < arcsin(1/(2√2μ)) ∧ arcsin(1/(2ζη)) with t = tan(λ/2), η = (1+t)/(1−t), μ = 1/(1−t). Lemma 2's ζ is *corrected*:
/// the lens' arc has central angle 2λ (the proof has λ), so ζ = √2·sin λ/(sin λ + cos λ − 1), which is √2/(1−t) and so
/// well defined at λ = 0. (Counterexample to the printed ζ: the chord (±1, 0), the curve bent at (0, tan(λ/2)), and p =
/// (0, 1).)
///
/// Beyond λ = π/2 nothing is guaranteed: 0.
pub fn guaranteed_angle(lambda_rad: f64) -> f64 {
    if lambda_rad.is_nan() || lambda_rad >= FRAC_PI_2 {
        return 0.0;
    }
    let t = libm::tan(0.5 * lambda_rad);
    let (eta, mu, zeta) = ((1.0 + t) / (1.0 - t), 1.0 / (1.0 - t), SQRT_2 / (1.0 - t));
    libm::asin(1.0 / (2.0 * SQRT_2 * mu)).min(libm::asin(1.0 / (2.0 * zeta * eta)))
}

/// The largest turning (radians) of corner arcs for which κ is proven, if κ is proven on the curves of the domain at
/// all; `lambda_rad` is their largest lens angle. Else π/3, the largest for which the angles at the rim of a ball are
/// 60° and more (section 6).
///
/// Arcs are curves: of turning T they have λ = T/2, so arcs of π/3 prove κ only up to 8.594°. Arcs of less than a tenth
/// of a radian would insert many vertices around the ball only for the proof. Then π/3 is taken, and the angle is
/// reached, not proven.
pub fn arc_turning(kappa_rad: f64, lambda_rad: f64) -> f64 {
    const FINEST: f64 = 0.1;
    if kappa_rad >= guaranteed_angle(lambda_rad) || kappa_rad < guaranteed_angle(FRAC_PI_3 / 2.0) {
        return FRAC_PI_3;
    }
    // The guarantee falls as λ grows: 50 halvings reach the spacing of f64.
    let (mut covered, mut missed) = (0.0, FRAC_PI_3 / 2.0);
    for _ in 0..50 {
        let middle = 0.5 * (covered + missed);
        if kappa_rad < guaranteed_angle(middle) {
            covered = middle;
        } else {
            missed = middle;
        }
    }
    if 2.0 * covered >= FINEST { 2.0 * covered } else { FRAC_PI_3 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use std::f64::consts::PI;

    #[test]
    fn guarantees_are_those_of_the_corrected_theory() {
        // τ, degrees guaranteed for any curve (λ = τ), and for circular arcs (λ = τ/2).
        let table = [
            (0.0, 20.705, 20.705),
            (0.02, 20.065, 20.382),
            (0.1, 17.689, 19.141),
            (0.2, 15.074, 17.689),
            (0.5, 8.985, 13.893),
            (PI / 3.0, 2.295, 8.594),
        ];
        for (tau, any, arcs) in table {
            // The table has three decimals.
            approx::assert_abs_diff_eq!(guaranteed_angle(tau).to_degrees(), any, epsilon = 5e-4);
            approx::assert_abs_diff_eq!(guaranteed_angle(0.5 * tau).to_degrees(), arcs, epsilon = 5e-4);
        }
    }

    #[test]
    fn the_short_form_of_zeta_is_the_printed_one_with_twice_the_angle() {
        for lambda in [0.02, 0.1, 0.5, PI / 3.0] {
            let zeta = SQRT_2 * libm::sin(lambda) / (libm::sin(lambda) + libm::cos(lambda) - 1.0);
            approx::assert_relative_eq!(zeta, SQRT_2 / (1.0 - libm::tan(0.5 * lambda)), max_relative = 1e-12);
        }
        assert_eq!(guaranteed_angle(2.0), 0.0);
    }

    #[test]
    fn the_angle_rule_on_a_segment_has_eta_of_at_most_root_two_and_nearly_attains_it() {
        let (x, y) = (Point::new(-1.0, 0.0), Point::new(1.0, 0.0));
        let mut largest: f64 = 0.0;
        for i in 1..400 {
            for j in 1..400 {
                // Denser towards the circle and the end y, where the ratio is largest.
                let (u, v) = (f64::from(i) / 400.0, f64::from(j) / 400.0);
                let (r, phi) = (1.0 - u * u * u, PI * v * v);
                let z = Point::new(r * libm::cos(phi), r * libm::sin(phi));
                let (a, b) = (z.distance(x), z.distance(y));
                let p = x.lerp(y, a / (a + b));
                if (x - z).dot(y - z) < 0.0 {
                    largest = largest.max(p.distance(z) / (1.0 - p.x.abs()));
                }
            }
        }
        // The nearest z lies 2e-5 from y, so that 1 − |p.x| keeps eleven digits.
        assert!(largest < SQRT_2 + 1e-9 && largest > 1.4, "{largest}");
        approx::assert_abs_diff_eq!(ANGLE_RULE_GUARANTEE_RAD, libm::asin(0.25), epsilon = 1e-15);
    }
}
