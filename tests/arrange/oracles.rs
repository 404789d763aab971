//! Compared with what slower means tell: all pairs, rays, grids of points; heaps of curves that keep every promise.

use super::*;

#[test]
fn random_segments_cross_as_often_as_all_pairs_tell() {
    let mut number = numbers(7);
    let mut segments = Vec::new();
    for _ in 0..150 {
        let (x, y) = (number(), number());
        segments.push(((x, y), (x + 0.3 * (number() - 0.5), y + 0.3 * (number() - 0.5))));
    }
    let cross =
        |a: (f64, f64), b: (f64, f64), c: (f64, f64)| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0) > 0.0;
    let mut crossings = 0;
    for (i, &(a, b)) in segments.iter().enumerate() {
        for &(c, d) in &segments[i + 1..] {
            crossings += usize::from(cross(a, b, c) != cross(a, b, d) && cross(c, d, a) != cross(c, d, b));
        }
    }
    let domain = regions(&drawing(segments.iter().map(|&(a, b)| line(a, b))));
    assert_eq!(domain.points().len(), 2 * segments.len() + crossings);
    assert_eq!(domain.curves().len(), segments.len() + 2 * crossings);
}

#[test]
fn winding_numbers_agree_with_counting_along_a_ray() {
    let mut number = numbers(3);
    let loops: Vec<Vec<(f64, f64)>> = (0..6).map(|_| (0..7).map(|_| (number(), number())).collect()).collect();
    let drawn = drawing(loops.iter().flat_map(|l| polygon(l)));
    let winding = |x: f64, y: f64| {
        let mut total = 0;
        for points in &loops {
            for (i, a) in points.iter().enumerate() {
                let b = points[(i + 1) % points.len()];
                let left = (b.0 - a.0) * (y - a.1) - (b.1 - a.1) * (x - a.0) > 0.0;
                total += i32::from(a.1 <= y && b.1 > y && left) - i32::from(a.1 > y && b.1 <= y && !left);
            }
        }
        total
    };
    let (even, nonzero) = (filled(&drawn, FillRule::EvenOdd), filled(&drawn, FillRule::NonZero));
    let (even, nonzero) = (even.locator(), nonzero.locator());
    for _ in 0..2000 {
        let (x, y) = (1.2 * number() - 0.1, 1.2 * number() - 0.1);
        let w = winding(x, y);
        assert_eq!(even.region(p(x, y)).is_some(), w % 2 != 0, "at {x} {y}");
        assert_eq!(nonzero.region(p(x, y)).is_some(), w != 0, "at {x} {y}");
    }
}

#[test]
fn feature_sizes_agree_with_all_pairs() {
    let domain = regions(&mixture(1.0, 0.0)).split_to_turning(1.0);
    let (lfs, lfs0) = (domain.lfs(), domain.lfs0());
    for (id, &q) in domain.points().enumerate() {
        let others = domain.points().enumerate().filter(|&(o, _)| o != id).map(|(_, o)| o.distance(q));
        let nearest = others.fold(f64::INFINITY, f64::min);
        assert_eq!(lfs0[id], nearest);
        let apart = domain.curves().iter().filter(|c| !c.ends.contains(&id));
        let nearest = apart.map(|c| c.curve.nearest(q, 0.0, 1.0).1).fold(nearest, f64::min);
        assert_eq!(lfs[id], nearest);
    }
}

#[test]
fn regions_of_a_mixture_are_what_a_grid_of_points_counts() {
    let domain = regions(&mixture(1.0, 0.0));
    let locator = domain.locator();
    let n = 200;
    let mut counted = vec![0.0; domain.regions().len()];
    for i in 0..n * n {
        let at = |k: usize| -4.0 + 8.0 * (k as f64 + 0.5) / n as f64;
        if let Some(region) = locator.region(p(at(i % n), at(i / n))) {
            counted[region.index()] += 64.0 / (n * n) as f64;
        }
    }
    for (counted, area) in counted.iter().zip(areas(&domain)) {
        // A border cell is 0.04 wide: regions with borders of a few lengths are off by a few hundredths.
        assert!((counted - area).abs() < 0.15, "{counted} {area}");
    }
    assert!(domain.curves().ids().all(|c| c < CurveId(1000)));
}

#[test]
fn heaps_of_curves_of_every_kind_have_no_flaw() {
    for seed in 0..16 {
        let domain = regions(&drawing(heap(seed, seed % 2 == 0)));
        assert_eq!(domain.split_to_turning(0.5).flaws(), [""; 0], "seed {seed}");
    }
}

#[test]
fn heaps_far_from_the_origin_turned_or_drawn_nearly_twice_have_no_flaw() {
    for seed in 0..8 {
        let far = kurbo::Affine::translate((1e7, 3e7)) * kurbo::Affine::rotate(0.3);
        regions(&drawing(heap(seed, seed % 2 == 0).iter().map(|c| c.transformed(far))));
        // A copy of every curve a tolerance away.
        let beside = kurbo::Affine::translate((2e-9, 1e-9));
        regions(&drawing(heap(seed, false).iter().take(5).flat_map(|c| [c.clone(), c.transformed(beside)])));
    }
}

#[test]
fn a_coarse_tolerance_holds_its_guarantee() {
    for seed in 0..12 {
        for tolerance in [0.0, 1e-3, 0.02] {
            let options = ArrangeOptions {
                tolerance: Some(tolerance),
                fill: Some(FillRule::Regions),
                ..ArrangeOptions::default()
            };
            let domain = drawing(heap(seed, seed % 3 == 0)).arrange(&options).unwrap();
            assert_eq!(domain.flaws(), [""; 0], "seed {seed}, tolerance {tolerance}");
        }
    }
}

#[test]
fn splines_with_hairpins_about_as_wide_as_the_tolerance_have_no_flaw() {
    let mut number = numbers(77);
    for seed in 0..120 {
        let mut place = || p((40.0 * number() - 20.0).round() / 4.0, (40.0 * number() - 20.0).round() / 4.0);
        let [a, b, c] = [place(), if seed % 3 == 0 { p(0.0, 0.0) } else { place() }, place()];
        if a == b || b == c || a == c {
            continue;
        }
        let Ok(spline) = Curve::natural_spline(&[a, b, b + Vec2::new(1e-3, 0.0), c, a]) else { continue };
        let mut drawing = drawing([spline, Curve::line(a, c).unwrap()]);
        drawing.points.push(DrawnPoint { at: c + Vec2::new(1e-3, 0.0), name: None, entity: "point".into() });
        for tolerance in [Some(0.0), None, Some(1e-6), Some(1e-3)] {
            let options = ArrangeOptions { tolerance, fill: Some(FillRule::Regions), ..ArrangeOptions::default() };
            let domain = drawing.arrange(&options).unwrap_or_else(|e| panic!("{seed} {tolerance:?}: {e}"));
            assert_eq!(domain.flaws(), [""; 0], "seed {seed}, tolerance {tolerance:?}");
        }
    }
}

/// Each round of welding such a bundle would find more meetings than the one before, by the millions.
#[test]
fn a_bundle_of_curves_within_the_tolerance_is_refused_with_the_way_out() {
    let mut number = numbers(5);
    let mut place = |x: f64, y: f64| p(x + 0.02 * number(), y + 0.02 * number());
    let mut stroke =
        || Curve::bezier(vec![place(0.0, 0.0), place(0.3, 0.5), place(0.7, 0.5), place(1.0, 0.0)]).unwrap();
    let strokes: Vec<Curve> = (0..120).map(|_| stroke()).collect();
    let options = ArrangeOptions { tolerance: Some(0.005), ..ArrangeOptions::default() };
    let error = drawing(strokes).arrange(&options).unwrap_err();
    assert!(error.near && error.help.contains("bundles"), "{error}; {}", error.help);
}

/// Points, segments and holes of a `.poly` file, as plainly as a test needs.
fn read_poly(text: &str) -> Option<Drawing> {
    let lines = text.lines().map(|l| l.split('#').next().unwrap_or("").trim()).filter(|l| !l.is_empty());
    let mut rows =
        lines.map(|l| l.split_whitespace().map(|w| w.parse::<f64>().unwrap_or(f64::NAN)).collect::<Vec<_>>());
    let count = rows.next()?[0] as usize;
    let points: Vec<Vec<f64>> = rows.by_ref().take(count).collect();
    let first = points.first()?[0] as usize;
    let count = rows.next()?[0] as usize;
    let mut drawing = Drawing { fill: FillRule::Regions, ..Default::default() };
    for row in rows.by_ref().take(count) {
        let at = |k: usize| points.get((row[k] as usize).wrapping_sub(first)).map(|q| p(q[1], q[2]));
        drawing.add(Curve::line(at(1)?, at(2)?).ok()?, "wall", format!("segment {}", row[0]));
    }
    let holes = rows.next().map_or(0, |r| r[0] as usize);
    for row in rows.take(holes) {
        drawing.seeds.push(seed(row[1], row[2], SeedKind::Hole));
    }
    Some(drawing)
}

#[test]
fn every_poly_file_at_hand_is_arranged_without_a_flaw() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["poly", "plsg"] {
        // Beside the project, or beside the folder of its worktrees; the test passes without.
        let paths = ["../shared/cases", "../../shared/cases"].map(|shared| root.join(shared).join(folder));
        let Some(entries) = paths.iter().find_map(|path| std::fs::read_dir(path).ok()) else { continue };
        let mut files: Vec<_> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
        files.retain(|f| f.extension().is_some_and(|e| e == "poly"));
        files.sort();
        for file in files {
            let drawing = read_poly(&std::fs::read_to_string(&file).unwrap()).expect("a .poly file");
            match drawing.arrange(&ArrangeOptions::default()) {
                Ok(domain) => assert_eq!(domain.flaws(), [""; 0], "{}", file.display()),
                Err(error) => assert!(error.what.contains("nothing to mesh"), "{}: {error}", file.display()),
            }
        }
    }
}
