//! Exact signs in space. Each is decided by a filter, inlined, and by expansions where the filter cannot tell. As in the
//! plane, coordinates are expected within about 2^±180.

use super::expansion::Expansion;
use robust::Coord3D;

/// How a point lies to the plane of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum PlaneSide {
    /// On the side from which the triangle turns clockwise.
    Below,
    /// In the plane.
    On,
    /// On the side from which the triangle turns counter-clockwise.
    Above,
}

impl PlaneSide {
    fn of(det: f64) -> Self {
        match det {
            det if det > 0.0 => Self::Above,
            det if det < 0.0 => Self::Below,
            _ => Self::On,
        }
    }
}

/// How a weighted point lies to the sphere orthogonal to four others.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SphereSide {
    /// Its power is below its weight: the four points are no regular tetrahedron with it there.
    Inside,
    /// Its power is its weight.
    On,
    /// Its power is above its weight.
    Outside,
}

/// A point and its weight, a squared length.
pub type Weighted = ([f64; 3], f64);

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Where `d` lies to the plane of the triangle a b c. A tetrahedron a b c d is *positive* where it lies above.
#[inline]
pub fn orient(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> PlaneSide {
    let [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = [minus(a, d), minus(b, d), minus(c, d)];
    let (bxcy, cxby, cxay, axcy, axby, bxay) = (bx * cy, cx * by, cx * ay, ax * cy, ax * by, bx * ay);
    let det = az * (bxcy - cxby) + bz * (cxay - axcy) + cz * (axby - bxay);
    let permanent = (bxcy.abs() + cxby.abs()) * az.abs()
        + (cxay.abs() + axcy.abs()) * bz.abs()
        + (axby.abs() + bxay.abs()) * cz.abs();
    // Shewchuk's o3derrboundA = (7 + 56ε)ε with ε = 2^-53.
    if det.abs() > 7.771_561_172_376_103e-16 * permanent { PlaneSide::of(-det) } else { orient_exact(a, b, c, d) }
}

#[cold]
fn orient_exact(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> PlaneSide {
    let coord = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
    PlaneSide::of(-robust::orient3d(coord(a), coord(b), coord(c), coord(d)))
}

/// The power test: where `e` lies to the orthogonal sphere of a positive tetrahedron a b c d.
#[inline]
pub fn in_sphere(a: Weighted, b: Weighted, c: Weighted, d: Weighted, e: Weighted) -> SphereSide {
    let row = |p: Weighted| {
        let [x, y, z] = minus(p.0, e.0);
        let (square, weight) = (x * x + y * y + z * z, p.1 - e.1);
        ([x, y, z], square - weight, square + weight.abs())
    };
    let [(a_, al, am), (b_, bl, bm), (c_, cl, cm), (d_, dl, dm)] = [row(a), row(b), row(c), row(d)];
    // The minors of x and y, with the sum of their terms' magnitudes.
    let minor = |p: [f64; 3], q: [f64; 3]| {
        let (l, r) = (p[0] * q[1], q[0] * p[1]);
        (l - r, l.abs() + r.abs())
    };
    let [(ab, abm), (bc, bcm), (cd, cdm), (da, dam), (ac, acm), (bd, bdm)] =
        [minor(a_, b_), minor(b_, c_), minor(c_, d_), minor(d_, a_), minor(a_, c_), minor(b_, d_)];
    let [az, bz, cz, dz] = [a_[2], b_[2], c_[2], d_[2]];
    let [azm, bzm, czm, dzm] = [az.abs(), bz.abs(), cz.abs(), dz.abs()];
    let abc = az * bc - bz * ac + cz * ab;
    let bcd = bz * cd - cz * bd + dz * bc;
    let cda = cz * da + dz * ac + az * cd;
    let dab = dz * ab + az * bd + bz * da;
    let det = (dl * abc - cl * dab) + (bl * cda - al * bcd);
    let permanent = (czm * dam + dzm * acm + azm * cdm) * bm
        + (bzm * cdm + czm * bdm + dzm * bcm) * am
        + (azm * bcm + bzm * acm + czm * abm) * dm
        + (dzm * abm + azm * bdm + bzm * dam) * cm;
    // Shewchuk's isperrboundA is (16 + 224ε)ε; the weights add two roundings to each lift: (18 + …)ε, and some for
    // comfort.
    match det {
        det if det.abs() <= 2.7e-15 * permanent => in_sphere_exact(a, b, c, d, e),
        det if det < 0.0 => SphereSide::Inside,
        _ => SphereSide::Outside,
    }
}

#[cold]
fn in_sphere_exact(a: Weighted, b: Weighted, c: Weighted, d: Weighted, e: Weighted) -> SphereSide {
    let p = [a, b, c, d, e];
    let [x, y, z] = [0, 1, 2].map(|k| p.map(|(at, _)| at[k]));
    let two = |i: usize, j: usize| Expansion::product(x[i], y[j]).minus(&Expansion::product(x[j], y[i]));
    let three =
        |i: usize, j: usize, k: usize| two(j, k).times(z[i]).minus(&two(i, k).times(z[j])).plus(&two(i, j).times(z[k]));
    // The determinant with rows (x, y, z, 1) of four points, by its last column.
    let four =
        |[i, j, k, l]: [usize; 4]| three(i, j, k).minus(&three(i, j, l)).plus(&three(i, k, l)).minus(&three(j, k, l));
    let lifted = |of: usize, others: [usize; 4]| {
        let minor = four(others);
        let squares = [x[of], y[of], z[of]].map(|c| minor.times(c).times(c));
        squares.iter().fold(minor.times(-p[of].1), |sum, square| sum.plus(square))
    };
    // Rows (x, y, z, x² + y² + z² − w, 1), by their fourth column.
    let even = lifted(0, [1, 2, 3, 4]).plus(&lifted(2, [0, 1, 3, 4])).plus(&lifted(4, [0, 1, 2, 3]));
    let odd = lifted(1, [0, 2, 3, 4]).plus(&lifted(3, [0, 1, 2, 4]));
    match odd.minus(&even).sign() {
        det if det < 0.0 => SphereSide::Inside,
        det if det > 0.0 => SphereSide::Outside,
        _ => SphereSide::On,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rng::Rng;

    fn whole(rng: &mut Rng, range: usize) -> f64 {
        rng.below(range) as f64 - (range / 2) as f64
    }

    /// The sign of the power test in whole numbers.
    fn by_whole_numbers(p: [Weighted; 5]) -> i128 {
        let rows: Vec<[i128; 4]> = p[..4]
            .iter()
            .map(|(at, w)| {
                let [x, y, z] = [0, 1, 2].map(|k| (at[k] - p[4].0[k]) as i128);
                [x, y, z, x * x + y * y + z * z - (w - p[4].1) as i128]
            })
            .collect();
        fn det(rows: &[[i128; 4]], columns: &[usize]) -> i128 {
            let Some((first, rest)) = rows.split_first() else { return 1 };
            let minor = |k: usize| columns.iter().copied().filter(|&c| c != columns[k]).collect::<Vec<_>>();
            (0..columns.len())
                .map(|k| (if k % 2 == 0 { 1 } else { -1 }) * first[columns[k]] * det(rest, &minor(k)))
                .sum()
        }
        det(&rows, &[0, 1, 2, 3]).signum()
    }

    #[test]
    fn the_power_test_is_that_of_whole_numbers() {
        let mut rng = Rng::new(3);
        let (mut ties, mut tested) = (0, 0);
        for round in 0..20_000 {
            let range = if round % 2 == 0 { 4 } else { 1 << 20 };
            let mut p: [Weighted; 5] = std::array::from_fn(|_| {
                ([0; 3].map(|_| whole(&mut rng, range)), if round % 3 == 0 { 0.0 } else { whole(&mut rng, 3) })
            });
            match orient(p[0].0, p[1].0, p[2].0, p[3].0) {
                PlaneSide::On => continue,
                PlaneSide::Below => p.swap(0, 1),
                PlaneSide::Above => (),
            }
            let exact = by_whole_numbers(p);
            let [a, b, c, d, e] = p;
            let expected = [SphereSide::Outside, SphereSide::On, SphereSide::Inside][(1 - exact) as usize];
            assert_eq!(in_sphere(a, b, c, d, e), expected, "{p:?} {exact}");
            assert_eq!(in_sphere_exact(a, b, c, d, e), expected, "{p:?}");
            ties += usize::from(exact == 0);
            tested += 1;
        }
        assert!(tested > 10_000 && ties > 100, "{tested} {ties}");
    }

    #[test]
    fn the_center_is_inside_and_a_far_point_outside() {
        let p = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(orient(p[0], p[1], p[2], p[3]), PlaneSide::Above);
        let [a, b, c, d] = p.map(|at| (at, 0.0));
        assert_eq!(in_sphere(a, b, c, d, ([0.5; 3], 0.0)), SphereSide::Inside);
        assert_eq!(in_sphere(a, b, c, d, ([1.0; 3], 0.0)), SphereSide::On);
        assert_eq!(in_sphere(a, b, c, d, ([1.0; 3], 0.1)), SphereSide::Inside);
        assert_eq!(in_sphere(a, b, c, d, ([2.0; 3], 0.0)), SphereSide::Outside);
    }
}
