//! Many lines around a point, and maps of them.

use super::*;

#[test]
fn spokes_that_lie_on_each_other_become_one() {
    let n = 50;
    let spoke = |k: i32, r: f64| {
        let turn = TAU * f64::from(k) / f64::from(n);
        line((0.0, 0.0), (r * libm::cos(turn), r * libm::sin(turn)))
    };
    let domain = drawing((0..n).flat_map(|k| [spoke(k, 2.0), spoke(k, 1.0).reversed()]).chain(square(-3.0, -3.0, 6.0)));
    let domain = regions(&domain);
    assert_eq!(domain.curves().len(), 2 * n as usize + 4);
    assert_eq!(repairs(&domain, RepairKind::Overlap), n as usize);
}

#[test]
fn every_map_obeys_euler_and_no_two_lines_of_it_cross() {
    for seed in 0..12 {
        let mut number = numbers(seed + 100);
        let mut places: Vec<(f64, f64)> = (0..60).map(|_| (number(), number())).collect();
        // Two hubs, one of them on a line.
        places.extend([(0.5, 0.5), (0.25, 0.75)]);
        let mut curves = square(-1.0, -1.0, 3.0);
        curves.extend((0..60).map(|i| line(places[i], places[60 + i % 2])));
        curves.extend((0..40).map(|i| line(places[i], places[i + 20])));
        let lines = regions(&drawing(curves));
        let (left, right) = euler(&lines);
        assert_eq!(left, right, "lines, seed {seed}");
        let ends: Vec<_> = lines.curves().iter().map(|c| (c.curve.start(), c.curve.end(), c.ends)).collect();
        // What rounding leaves of a line's end on another is no crossing.
        let side = |a: Point, b: Point, q: Point| Some((b - a).cross(q - a)).filter(|s| s.abs() > 1e-14).unwrap_or(0.0);
        for (i, &(a, b, ab)) in ends.iter().enumerate() {
            for &(c, d, cd) in ends[i + 1..].iter().filter(|o| !o.2.iter().any(|e| ab.contains(e))) {
                let parted = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
                assert!(!parted, "{ab:?} and {cd:?} cross, seed {seed}");
            }
        }
        let (left, right) = euler(&regions(&drawing(heap(seed, seed % 2 == 0))));
        assert_eq!(left, right, "heap, seed {seed}");
    }
}
