//! Coarse tolerances: what is wider keeps its shape, what fits within is itemised.

use super::*;

fn in_a_plate(outline: &[Curve]) -> Drawing {
    drawing(square(0.0, 0.0, 100.0).into_iter().chain(outline.iter().cloned()))
}

#[test]
fn what_is_wider_than_the_tolerance_keeps_its_shape() {
    let tolerance = 0.25;
    for ratio in [1.05, 1.2, 1.42, 1.6, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 16.0, 25.0, 50.0] {
        for (kind, outline, area) in outlines(ratio * tolerance) {
            let options = ArrangeOptions {
                tolerance: Some(tolerance),
                fill: Some(FillRule::Regions),
                ..ArrangeOptions::default()
            };
            let domain = in_a_plate(&outline).arrange(&options).unwrap();
            assert_eq!(domain.flaws(), [""; 0], "{kind} {ratio}");
            let found = areas(&domain);
            assert_eq!(found.len(), 2, "{kind} {ratio} {:?}", domain.repairs());
            assert!((found[1] - area).abs() <= 1e-9 * area, "{kind} {ratio}: {} instead of {area}", found[1]);
            // A closed curve may be told to meet itself where it was closed; nothing else happens to it.
            let other = domain.repairs().iter().filter(|r| r.kind != RepairKind::SelfSplit).count();
            assert_eq!(other, 0, "{kind} {ratio} {:?}", domain.repairs());
        }
    }
}

#[test]
fn what_fits_within_the_tolerance_is_itemised_with_place_and_size() {
    let tolerance = 2.0;
    for ratio in [0.05, 0.3, 0.5, 0.7, 0.8, 0.9, 0.99] {
        for (kind, outline, area) in outlines(ratio * tolerance) {
            let options = ArrangeOptions {
                tolerance: Some(tolerance),
                fill: Some(FillRule::Regions),
                ..ArrangeOptions::default()
            };
            let domain = in_a_plate(&outline).arrange(&options).unwrap();
            assert_eq!(domain.flaws(), [""; 0], "{kind} {ratio}");
            let told =
                domain.repairs().iter().filter(|r| p(r.at[0], r.at[1]).distance(p(50.0, 50.0)) < 4.0 * tolerance);
            let lost = [RepairKind::Collapsed, RepairKind::ZeroLength, RepairKind::Overlap, RepairKind::Duplicate];
            let told = told.filter(|r| lost.contains(&r.kind) && r.size > 0.0).count();
            // A loop that is left all the same is no smaller than it was.
            let kept = areas(&domain).get(1).is_some_and(|a| *a > 0.5 * area);
            assert!(kept || told > 0, "{kind} {ratio} {:?}", domain.repairs());
        }
    }
}

#[test]
fn a_ring_of_lines_shorter_than_the_tolerance_is_thinned_not_lost() {
    for ratio in [3.0, 5.0, 10.0, 40.0] {
        let n = 400;
        let around = |i: i32| {
            (50.0 + ratio * libm::cos(TAU * f64::from(i) / 400.0), 50.0 + ratio * libm::sin(TAU * f64::from(i) / 400.0))
        };
        let ring = polygon(&(0..n).map(around).collect::<Vec<_>>());
        let options =
            ArrangeOptions { tolerance: Some(2.0), fill: Some(FillRule::Regions), ..ArrangeOptions::default() };
        let domain = in_a_plate(&ring).arrange(&options).unwrap();
        assert_eq!(domain.flaws(), [""; 0]);
        let found = areas(&domain);
        assert_eq!(found.len(), 2, "{ratio}");
        let hole = found.iter().fold(f64::INFINITY, |a, b| a.min(*b)).min(PI * ratio * ratio);
        // A step of two tolerances cuts a chord of this depth at most.
        let depth = ratio - (ratio * ratio - 4.0).sqrt();
        assert!(hole >= PI * (ratio - depth) * (ratio - depth) * 0.5, "{ratio}: {hole}");
    }
}

#[test]
fn a_stub_shorter_than_a_gap_is_not_folded() {
    let mut curves = square(0.0, 0.0, 1.0);
    curves.extend([
        line((0.5, 0.5), (0.5 + 3e-7, 0.5)),
        line((0.2, 0.5), (0.2, 0.5 + 2e-7)),
        line((0.2, 0.5), (0.2 + 1e-7, 0.5)),
    ]);
    let domain = regions(&drawing(curves));
    assert_eq!((domain.curves().len(), domain.points().len()), (7, 9));
    assert!(domain.repairs().is_empty(), "{:?}", domain.repairs());
}

#[test]
fn a_point_far_from_all_curves_is_refused_at_its_place() {
    let mut drawn = drawing(square(0.0, 0.0, 1.0));
    drawn.points.push(DrawnPoint { at: p(0.0, 1e15), name: None, entity: "point 7".into() });
    let error = drawn.arrange(&ArrangeOptions::default()).unwrap_err();
    assert!(error.what.contains("point 7") && error.at == p(0.0, 1e15), "{error}");
}
