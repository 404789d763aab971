//! δ₂, δ₁ and μ, the sizes of the selection regions, and the bounds that are proven for them.

use crate::promise::{Densities, DensityPromise};
use std::f64::consts::FRAC_PI_2;

/// The sizes of the selection regions (Definitions 3.1–3.3); 1: the region is its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regions {
    /// Type A points lie within r(1−δ₂) of the circumcenter, or, where [disks are by
    /// shape](super::steiner::Disks::ByShape), within r − δ₂ρ̄l.
    pub delta2: f64,
    /// Type B points lie in the middle part of length |s|(1−δ₁).
    pub delta1: f64,
    /// Type C points lie in the middle part of length |s|(1−μ).
    pub mu: f64,
}

/// An inequality that parameters violate.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("({number}) {inequality} is violated: {name} = {value}, and {least} is the least")]
pub struct Violation {
    /// As in the paper.
    pub number: &'static str,
    /// The inequality in symbols.
    pub inequality: &'static str,
    /// The symbol of the parameter: δ₂, δ₁ or μ.
    pub name: &'static str,
    /// The value that was given.
    pub value: f64,
    /// The smallest value that satisfies the inequality, at most 1.
    pub least: f64,
}

/// ρ̄ of an angle in radians: the smallest angle of a triangle with radius-edge ratio ρ is arcsin 1/(2ρ).
pub fn radius_edge_of(angle_rad: f64) -> f64 {
    0.5 / libm::sin(angle_rad)
}

impl Regions {
    /// All regions are their centres: with equal disks Chew's second algorithm (1993).
    pub const CENTERS: Self = Self { delta2: 1.0, delta1: 1.0, mu: 1.0 };

    /// The largest disks for points in triangles that ρ̄ allows (3.1); midpoints on segments.
    pub fn widest_disks(rho: f64) -> Self {
        Self { delta2: (1.0 / rho).min(1.0), ..Self::CENTERS }
    }

    /// Whether (3.1)–(3.3) hold; `angle_rad` is the smallest input angle of 60° or more. Above 30°, where ρ̄ < 1, only
    /// centres satisfy them.
    ///
    /// # Errors
    /// The first inequality that is violated.
    pub fn check(&self, rho: f64, angle_rad: f64) -> Result<(), Violation> {
        // The bounds are computed from rounded angles.
        const ROUNDING: f64 = 1e-9;
        let cos = libm::cos(angle_rad.min(FRAC_PI_2));
        let bounds = [
            ("3.1", "1/ρ̄ ≤ δ₂ ≤ 1", "δ₂", self.delta2, 1.0 / rho),
            ("3.2", "1/(ρ̄δ₂) ≤ δ₁ ≤ 1", "δ₁", self.delta1, 1.0 / (rho * self.delta2)),
            ("3.3", "2cos α_min ≤ μ ≤ 1", "μ", self.mu, 2.0 * cos),
        ];
        for (number, inequality, name, value, least) in bounds {
            let least = least.min(1.0);
            if !(value >= least - ROUNDING && value <= 1.0 && value > 0.0) {
                return Err(Violation { number, inequality, name, value, least });
            }
        }
        Ok(())
    }

    /// C₁ … C₄ of Theorem 4.6 and B₁, B₃, B₄ of Lemma 5.4.
    fn constants(&self, rho: f64, angle_rad: f64) -> ([f64; 4], [f64; 3]) {
        let Self { delta2, delta1, mu } = *self;
        let cos = libm::cos(angle_rad.min(FRAC_PI_2)).max(0.0);
        // At 90° and more the case does not arise; a rounded cosine of 90° is 6e-17.
        let c4 = if cos < 1e-15 { f64::INFINITY } else { mu / (2.0 * cos) };
        let c3 = rho * delta1 * (2.0 * delta2 - delta2 * delta2).sqrt();
        let b3 = (1.0 + ((2.0 - delta2) / delta2).sqrt() - delta1) / delta1;
        ([rho * delta2, 0.5 * delta1 * 3f64.sqrt(), c3, c4], [(2.0 - delta2) / delta2, b3, (2.0 - mu) / mu])
    }

    /// The input angle (radians) above which refinement of segments is proven to terminate, and with equal disks to be
    /// well graded; `None` where it is not.
    ///
    /// It is where (5.11)–(5.19) have a solution. The proof of Theorem 4.6 has C₂ = δ₁cos κ before it sets κ = 30°.
    /// With that, centres are proven up to 26.57°, which is the angle of Shewchuk (2002) for Chew's algorithm.
    pub fn proven_above(&self, angle_min_rad: f64) -> Option<f64> {
        let ([c1, _, c3, _], _) = self.constants(radius_edge_of(angle_min_rad), FRAC_PI_2);
        let c2 = self.delta1 * libm::cos(angle_min_rad);
        (c1 > 1.0 && c1 * c2 > 1.0 && c3 > 1.0).then(|| libm::acos(0.5 * self.mu))
    }

    /// The bounds on densities: the least solution where there is one; else those that (5.23) prints, which are not
    /// proven.
    pub fn density_promise(&self, rho: f64, angle_rad: f64) -> DensityPromise {
        let least = self.least_densities(rho, angle_rad);
        DensityPromise {
            bounds: least.unwrap_or_else(|| self.printed_densities(rho, angle_rad)),
            proven: least.is_some(),
        }
    }

    /// D_A, D_B, D_C as (5.23) prints them. They are no solution of (5.11)–(5.19): see [`Regions::least_densities`].
    pub fn printed_densities(&self, rho: f64, angle_rad: f64) -> Densities {
        let ([c1, c2, c3, c4], [b1, b3, b4]) = self.constants(rho, angle_rad);
        // B·C/(C−1) as B/(1−1/C): right for C = ∞, too.
        let own = |b: f64, c: f64| if c > 1.0 { b / (1.0 - 1.0 / c) } else { f64::INFINITY };
        let (of1, of3, of4) = (own(b1, c1), own(b3, c3), own(b4, c4));
        Densities {
            a: of1.max(of3 / c1 + b1).max(of4 / c1 + b1),
            b: of3.max(of1 / c2 + b3).max(of4 / c3 + b3),
            c: of4.max(of3 / c4 + b4).max(b4),
        }
    }

    /// The least solution of (5.11)–(5.19). `None` where there is none: one exists exactly where C₁C₂ > 1, C₃ > 1 and
    /// C₄ > 1.
    ///
    /// *Corrected*: (5.12) demands D_A ≥ B₁ + D_B/C₁, which the printed (5.23) violates. Each inequality bounds one
    /// density from below by an increasing function of another. So repeated substitution, beginning with 1, converges
    /// to the least solution.
    pub fn least_densities(&self, rho: f64, angle_rad: f64) -> Option<Densities> {
        let ([c1, c2, c3, c4], [b1, b3, b4]) = self.constants(rho, angle_rad);
        if !(c1 > 1.0 && c1 * c2 > 1.0 && c3 > 1.0 && c4 > 1.0) {
            return None;
        }
        // Each round multiplies the error by 1/(C₁C₂), 1/C₃ or 1/C₄. Near 1 that takes long, and a small error does no
        // harm.
        let mut d = Densities { a: 1.0, b: 1.0, c: 1.0 };
        for _ in 0..100_000 {
            let next = Densities {
                a: b1 + d.a.max(d.b).max(d.c) / c1,
                b: (b3 + d.a / c2).max(b3 + d.b.max(d.c) / c3),
                c: b4.max(b4 + d.b.max(d.c) / c4),
            };
            if next == d {
                break;
            }
            d = next;
        }
        Some(d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use std::f64::consts::{FRAC_PI_3, SQRT_2};

    #[test]
    fn the_papers_table_is_reproduced() {
        // δ₂, δ₁, μ and D_A, D_B, D_C of Table 7.1; and the least solution of (5.11)–(5.19), by a program of its own.
        let rows = [
            (1.0, 1.0, 1.0, [3.41, 4.94, 1.00], Some([9.30, 11.74, 1.00])),
            (1.0, 1.0, 0.8, [3.41, 4.94, 1.50], Some([9.30, 11.74, 1.50])),
            (1.0, 1.0, 0.6, [3.41, 4.94, 2.33], Some([9.30, 11.74, 2.33])),
            (1.0, 1.0, 0.4, [3.83, 4.94, 4.00], Some([9.30, 11.74, 4.00])),
            (1.0, 0.9, 1.0, [5.03, 5.70, 1.00], Some([20.09, 27.00, 1.00])),
            (1.0, 0.9, 0.8, [5.03, 5.70, 1.50], Some([20.09, 27.00, 1.50])),
            (1.0, 0.9, 0.6, [5.03, 5.70, 2.33], Some([20.09, 27.00, 2.33])),
            (1.0, 0.9, 0.4, [5.03, 5.70, 4.00], Some([20.09, 27.00, 4.00])),
            (1.0, 0.8, 1.0, [10.13, 12.92, 1.00], None),
            (1.0, 0.8, 0.8, [10.13, 12.92, 1.50], None),
            (1.0, 0.8, 0.6, [10.13, 12.92, 2.33], None),
            (1.0, 0.8, 0.4, [10.13, 12.92, 4.00], None),
            (0.9, 1.0, 1.0, [5.70, 7.69, 1.00], Some([22.53, 27.13, 1.00])),
            (0.9, 1.0, 0.8, [5.70, 7.69, 1.50], Some([22.53, 27.13, 1.50])),
            (0.9, 1.0, 0.6, [5.70, 7.69, 2.33], Some([22.53, 27.13, 2.33])),
            (0.9, 1.0, 0.4, [5.70, 7.69, 4.00], Some([22.53, 27.13, 4.00])),
            (0.9, 0.9, 1.0, [6.22, 8.66, 1.00], None),
            (0.9, 0.9, 0.8, [6.22, 8.66, 1.50], None),
            (0.9, 0.9, 0.6, [6.22, 8.66, 2.33], None),
            (0.9, 0.9, 0.4, [6.22, 8.66, 4.00], None),
            (0.9, 0.8, 1.0, [12.70, 14.61, 1.00], None),
            (0.9, 0.8, 0.8, [12.70, 14.61, 1.50], None),
            (0.9, 0.8, 0.6, [12.70, 14.61, 2.33], None),
            (0.9, 0.8, 0.4, [12.70, 14.61, 4.00], None),
            (0.8, 1.0, 1.0, [12.92, 16.14, 1.00], None),
            (0.8, 1.0, 0.8, [12.92, 16.14, 1.50], None),
            (0.8, 1.0, 0.6, [12.92, 16.14, 2.33], None),
            (0.8, 1.0, 0.4, [12.92, 16.14, 4.00], None),
            (0.8, 0.9, 1.0, [12.92, 18.05, 1.00], None),
            (0.8, 0.9, 0.8, [12.92, 18.05, 1.50], None),
            (0.8, 0.9, 0.6, [12.92, 18.05, 2.33], None),
            (0.8, 0.9, 0.4, [12.92, 18.05, 4.00], None),
        ];
        for (delta2, delta1, mu, printed, least) in rows {
            let regions = Regions { delta2, delta1, mu };
            let two_decimals = |d: Densities, told: [f64; 3]| {
                for (d, told) in [d.a, d.b, d.c].into_iter().zip(told) {
                    assert_abs_diff_eq!(d, told, epsilon = 5e-3 + 1e-9);
                }
            };
            two_decimals(regions.printed_densities(SQRT_2, FRAC_PI_2), printed);
            let found = regions.least_densities(SQRT_2, FRAC_PI_2);
            assert_eq!(found.is_some(), least.is_some(), "{regions:?}");
            found.into_iter().zip(least).for_each(|(d, told)| two_decimals(d, told));
            let promise = regions.density_promise(SQRT_2, FRAC_PI_2);
            assert_eq!((promise.proven, promise.bounds.a >= printed[0] - 5e-3), (least.is_some(), true));
        }
        assert_eq!(Regions::CENTERS.least_densities(1.0, FRAC_PI_2), None, "at 30°");
    }

    #[test]
    fn centres_are_proven_up_to_shewchuks_angle() {
        assert!(Regions::CENTERS.proven_above(26.56f64.to_radians()).is_some());
        assert!(Regions::CENTERS.proven_above(26.57f64.to_radians()).is_none());
        let above = Regions::CENTERS.proven_above(20.7f64.to_radians()).unwrap();
        assert_abs_diff_eq!(above, FRAC_PI_3, epsilon = 1e-12);
    }

    #[test]
    fn a_violated_inequality_is_named() {
        let number = |regions: Regions, rho, angle| regions.check(rho, angle).map_err(|v| v.number);
        assert_eq!(number(Regions::CENTERS, SQRT_2, FRAC_PI_2), Ok(()));
        assert_eq!(number(Regions::CENTERS, 1.0, FRAC_PI_3), Ok(()));
        assert_eq!(number(Regions { delta2: 0.7, ..Regions::CENTERS }, SQRT_2, FRAC_PI_2), Err("3.1"));
        assert_eq!(number(Regions { delta2: 0.8, delta1: 0.8, mu: 1.0 }, SQRT_2, FRAC_PI_2), Err("3.2"));
        assert_eq!(number(Regions { mu: 0.9, ..Regions::CENTERS }, SQRT_2, FRAC_PI_3), Err("3.3"));
        assert_eq!(number(Regions { delta2: f64::NAN, ..Regions::CENTERS }, SQRT_2, FRAC_PI_2), Err("3.1"));
        assert_eq!(number(Regions { mu: 0.0, ..Regions::CENTERS }, SQRT_2, FRAC_PI_2), Err("3.3"));
        let told = Regions { delta2: 0.7, ..Regions::CENTERS }.check(SQRT_2, FRAC_PI_2).unwrap_err().to_string();
        assert!(told.starts_with("(3.1) 1/ρ̄ ≤ δ₂ ≤ 1 is violated: δ₂ = 0.7, and 0.70710678"), "{told}");
    }
}
