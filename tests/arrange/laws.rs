//! Laws: scaling, moving, repeating.

use super::*;

/// Everything but coordinates.
fn topology(domain: &Domain) -> impl PartialEq + std::fmt::Debug + use<> {
    let curves: Vec<_> = domain.curves().iter().map(|c| (c.ends, c.sides, c.name, c.source)).collect();
    let stars: Vec<_> = domain.points().ids().map(|p| domain.star(p).to_vec()).collect();
    (curves, stars)
}

#[test]
fn scaling_by_a_power_of_two_changes_no_bit() {
    let plain = regions(&mixture(1.0, 0.0));
    assert!(plain.regions().len() > 6);
    for exponent in [-40, 40, 3] {
        let factor = libm::ldexp(1.0, exponent);
        let scaled = regions(&mixture(factor, 0.0));
        assert_eq!(topology(&scaled), topology(&plain));
        for (a, b) in scaled.points().iter().zip(plain.points().iter()) {
            assert_eq!(*a, p(b.x * factor, b.y * factor));
        }
        assert!(scaled.regions().iter().zip(plain.regions().iter()).all(|(a, b)| a.area == b.area * factor * factor));
        assert!(
            scaled.repairs().iter().zip(plain.repairs()).all(|(a, b)| a.kind == b.kind && a.size == b.size * factor)
        );
    }
}

#[test]
fn far_from_the_origin_the_faces_are_the_same() {
    let plain = regions(&mixture(1.0, 0.0));
    let far = regions(&mixture(1.0, 1e7));
    assert_eq!((far.curves().len(), far.points().len()), (plain.curves().len(), plain.points().len()));
    for (a, b) in areas(&far).iter().zip(areas(&plain)) {
        // Coordinates of 1e7 have units of 2e-9 in the last place.
        assert!((a - b).abs() < 1e-6, "{:?} {:?}", areas(&far), areas(&plain));
    }
}

#[test]
fn arranging_is_repeatable_and_turning_splits_hold_every_guarantee() {
    let domain = regions(&mixture(1.0, 0.0));
    assert_eq!(topology(&domain), topology(&regions(&mixture(1.0, 0.0))));
    for tau in [0.1, 0.5, PI / 3.0] {
        let split = domain.split_to_turning(tau);
        assert_eq!(split.flaws(), [""; 0]);
        assert!(split.curves().iter().all(|c| c.curve.turning(0.0, 1.0) <= tau * (1.0 + 1e-9)));
        close(&areas(&split), &areas(&domain));
    }
}
