//! Arcs, ellipses, Bézier curves and splines, alone and beside each other.

use super::*;

#[test]
fn a_circle_is_split_and_its_area_is_exact() {
    let domain = regions(&drawing([circle(3.0, 4.0, 2.0)]));
    close(&areas(&domain), &[4.0 * PI]);
    assert_eq!((domain.points().len(), domain.curves().len()), (2, 2));
    assert!(domain.repairs().is_empty());
    let split = domain.split_to_turning(0.5);
    assert_eq!(split.flaws(), [""; 0]);
    assert!(split.curves().iter().all(|c| c.curve.turning(0.0, 1.0) <= 0.5 + 1e-12));
    assert_eq!(split.curves().len(), 14);
    close(&areas(&split), &[4.0 * PI]);
}

#[test]
fn crossing_circles_make_three_faces() {
    let domain = regions(&drawing([circle(0.0, 0.0, 1.0), circle(1.0, 0.0, 1.0)]));
    let lens = TAU / 3.0 - 3f64.sqrt() / 2.0;
    close(&areas(&domain), &[PI - lens, PI - lens, lens]);
    let ring = filled(&drawing([circle(0.0, 0.0, 1.0), circle(1.0, 0.0, 1.0)]), FillRule::EvenOdd);
    close(&areas(&ring), &[PI - lens, PI - lens]);
    assert_eq!(areas(&filled(&drawing([circle(0.0, 0.0, 1.0), circle(1.0, 0.0, 1.0)]), FillRule::NonZero)).len(), 3);
}

#[test]
fn tangent_circles_share_one_point() {
    for (x, inner) in [(2.0, PI), (0.5, 0.25 * PI)] {
        let small = if x == 2.0 { 1.0 } else { 0.5 };
        let domain = regions(&drawing([circle(0.0, 0.0, 1.0), circle(x, 0.0, small)]));
        let outer = if x == 2.0 { PI } else { 0.75 * PI };
        close(&areas(&domain), &[outer, inner]);
        let touching: Vec<_> = domain.points().ids().filter(|&q| domain.star(q).len() == 4).collect();
        assert_eq!(touching.len(), 1);
        assert!(domain.points()[touching[0]].distance(p(1.0, 0.0)) < 1e-9);
        assert!(domain.is_acute(touching[0]) && domain.corner(touching[0]).unwrap().angle_rad < 1e-6);
    }
}

#[test]
fn many_curves_that_leave_at_zero_angle_are_ordered_as_they_lie() {
    // Circles of several sizes, and a line, all tangent at the origin.
    let mut curves = vec![line((-9.0, 0.0), (9.0, 0.0))];
    for r in [1.0, 0.5, 0.25, 3.0] {
        curves.extend([circle(0.0, r, r), circle(0.0, -r, r)]);
    }
    let domain = regions(&drawing(curves));
    let rings = [9.0 - 1.0, 1.0 - 0.25, 0.25 - 0.0625, 0.0625];
    let wanted: Vec<f64> = rings.iter().flat_map(|a| [a * PI, a * PI]).collect();
    close(&areas(&domain), &wanted);
    let most = domain.points().ids().max_by_key(|&q| domain.star(q).len()).unwrap();
    assert_eq!(domain.star(most).len(), 18);
}

#[test]
fn arcs_on_one_circle_overlap_into_one() {
    let arc = |start: f64, sweep: f64| Curve::arc(p(1.0, 2.0), 1.5, start, sweep).unwrap();
    let domain = regions(&drawing([arc(0.0, 4.0), arc(3.0, 4.0), arc(1.0, -0.5)]));
    close(&areas(&domain), &[2.25 * PI]);
    assert!(repairs(&domain, RepairKind::Overlap) >= 2);
    let twice = regions(&drawing([circle(0.0, 0.0, 1.0), circle(0.0, 0.0, 1.0)]));
    close(&areas(&twice), &[PI]);
    assert_eq!(twice.curves().len(), 2);
}

#[test]
fn a_lens_of_two_arcs_shares_both_ends() {
    let (a, b) = (p(0.0, 0.0), p(1.0, 0.0));
    let bulge = libm::tan(PI / 12.0);
    let lens = drawing([Curve::bulge(a, b, bulge).unwrap(), Curve::bulge(b, a, bulge).unwrap()]);
    let domain = regions(&lens);
    assert_eq!((domain.points().len(), domain.curves().len()), (2, 2));
    close(&areas(&domain), &[PI / 3.0 - 3f64.sqrt() / 2.0]);
    assert!(domain.points().ids().all(|q| (domain.corner(q).unwrap().angle_rad - PI / 3.0).abs() < 1e-12));
}

#[test]
fn a_plate_with_holes_and_rings_five_deep() {
    let mut curves = square(-10.0, -10.0, 20.0);
    curves.extend((0..5).map(|i| circle(-4.0, 0.0, 5.0 - f64::from(i))));
    curves.push(circle(5.0, 5.0, 2.0));
    curves.push(Curve::ellipse(p(5.0, -5.0), Vec2::new(3.0, 0.0), Vec2::new(0.0, 1.0), 0.0, TAU).unwrap());
    let domain = filled(&drawing(curves.clone()), FillRule::EvenOdd);
    close(&areas(&domain), &[400.0 - (25.0 + 4.0 + 3.0) * PI, 7.0 * PI, 3.0 * PI]);
    close(
        &areas(&regions(&drawing(curves))),
        &[400.0 - 32.0 * PI, 9.0 * PI, 7.0 * PI, 5.0 * PI, 4.0 * PI, 3.0 * PI, 3.0 * PI, PI],
    );
}

#[test]
fn a_spiral_inside_a_disk_is_a_constraint() {
    let points: Vec<Point> =
        (0..40).map(|i| Point::ORIGIN + Vec2::from_angle(f64::from(i) * 0.4) * (0.02 * f64::from(i + 1))).collect();
    let spiral = Curve::natural_spline(&points).unwrap();
    let domain = filled(&drawing([circle(0.0, 0.0, 1.0), spiral]), FillRule::EvenOdd);
    close(&areas(&domain), &[PI]);
    let inside = domain.curves().iter().filter(|c| c.source == 1);
    assert!(inside.clone().count() > 0 && inside.clone().all(|c| c.sides[0].is_some() && c.sides[0] == c.sides[1]));
}

#[test]
fn a_bezier_that_crosses_itself_is_split_into_a_loop() {
    let alpha = Curve::bezier(vec![p(0.0, 0.0), p(4.0, 3.0), p(-3.0, 3.0), p(1.0, 0.0)]).unwrap();
    let domain = regions(&drawing([alpha]));
    assert_eq!(domain.regions().len(), 1);
    assert_eq!(repairs(&domain, RepairKind::SelfSplit), 1);
    assert_eq!(domain.points().ids().filter(|&q| domain.star(q).len() == 4).count(), 1);
}

#[test]
fn closed_splines_are_regions() {
    let points: Vec<Point> = (0..12)
        .map(|i| p(2.0, 1.0) + Vec2::from_angle(f64::from(i) * TAU / 12.0) * (1.0 + 0.3 * f64::from(i % 2)))
        .collect();
    let star = Curve::periodic_spline(&points).unwrap();
    let area = star.signed_area(p(2.0, 1.0));
    let domain = regions(&drawing([star]));
    close(&areas(&domain), &[area]);
    assert!(domain.repairs().is_empty(), "{:?}", domain.repairs());
}

#[test]
fn a_cusp_becomes_a_corner() {
    // A cubic with a cusp at t = ½, closed by a line.
    let cusp = Curve::bezier(vec![p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0), p(1.0, 0.0)]).unwrap();
    let domain = regions(&drawing([cusp, line((1.0, 0.0), (0.0, 0.0))]));
    assert_eq!(repairs(&domain, RepairKind::Corner), 1);
    assert!(domain.points().iter().any(|q| q.distance(p(0.5, 0.75)) < 1e-9));
    assert!(domain.points().ids().any(|q| domain.corner(q).is_some_and(|c| c.angle_rad < 1e-6)));
}

#[test]
fn nearly_closed_arcs_close_without_losing_their_shape() {
    let arc = Curve::arc(p(0.0, 0.0), 1.0, 0.0, TAU - 1e-8).unwrap();
    let domain = regions(&drawing([arc]));
    assert!((domain.area() - PI).abs() < 1e-6);
    assert_eq!(repairs(&domain, RepairKind::GapClosed), 1);
    for c in domain.curves().iter() {
        assert!(c.curve.bounds().width() < 2.1, "{c:?}");
    }
}

#[test]
fn a_spline_that_touches_a_circle_at_its_joint_leaves_it_to_the_right_side() {
    let joints = [
        (0.0, 2.0),
        (-0.9238795325112867, 2.38268343236509),
        (0.28762989084145224, 1.3080142301490465),
        (-3.999, -4.0),
    ];
    let spline = Curve::periodic_spline(&joints.map(|(x, y)| p(x, y))).unwrap();
    let domain = regions(&drawing([circle(0.0, 2.0, 1.0), spline]));
    let (faces, wanted) = euler(&domain);
    assert_eq!(faces, wanted);
}

#[test]
fn a_loop_that_became_a_line_does_not_fold_back() {
    let beside = (-2.750000000000259, -2.750000000000966);
    let joints = [(-2.75, -2.75), beside, (-2.75, -0.25), (beside.0 + 1e-3, beside.1)];
    let mut drawing = drawing([Curve::periodic_spline(&joints.map(|(x, y)| p(x, y))).unwrap()]);
    drawing.points.push(DrawnPoint { at: p(joints[3].0, joints[3].1), name: None, entity: "point".into() });
    let options = ArrangeOptions { tolerance: Some(0.0), fill: Some(FillRule::Regions), ..Default::default() };
    let domain = drawing.arrange(&options).unwrap();
    assert_eq!(domain.flaws(), [""; 0]);
    assert_eq!(repairs(&domain, RepairKind::Collapsed), 1);
}

#[test]
fn circles_that_were_pulled_open_cross_where_they_are_drawn() {
    let whole = circle(0.0, -1.5, 2.5);
    let pulled = whole.with_ends(whole.start() + Vec2::new(3.5e-6, 3.5e-6), whole.end());
    let beside = pulled.transformed(kurbo::Affine::translate((1e-3, 7.5e-10)));
    let found = regions(&drawing([whole, pulled, beside]));
    assert!(found.flaws().is_empty(), "{:?}", found.flaws());
    let total: f64 = areas(&found).iter().sum();
    assert!((total - (PI * 6.25 + 5.0 * 1e-3)).abs() < 1e-4, "{total}");
}

#[test]
fn ellipses_that_were_pulled_open_cross_where_they_are_drawn() {
    let (sin, cos) = libm::sincos(PI / 12.0);
    let (u, v) = (Vec2::new(4.0 * cos, 4.0 * sin), Vec2::new(-0.004 * sin, 0.004 * cos));
    let around = Curve::ellipse(p(-4.0, -4.0), u, v, -2.0 * PI / 3.0, -2.0 * PI / 3.0).unwrap();
    let pulled = around.with_ends(around.start() + Vec2::new(1.9e-6, 5e-7), around.end());
    let closed: Vec<Curve> =
        [around, pulled].into_iter().flat_map(|arc| [Curve::line(arc.end(), arc.start()).unwrap(), arc]).collect();
    let domain = regions(&drawing(closed));
    let (faces, wanted) = euler(&domain);
    assert_eq!(faces, wanted);
}

#[test]
fn a_handle_a_last_digit_from_its_end_makes_a_corner_not_a_hook() {
    // The curve leaves its start downwards and turns upwards at once.
    let start = p(92.0981, 265.88936);
    let hooked = Curve::bezier(vec![start, p(92.098101, 265.88935), p(267.4106, 495.76961), p(267.4106, 494.79561)]);
    let curves = [
        hooked.unwrap(),
        line((267.4106, 494.79561), (444.69, 265.88936)),
        line((444.69, 265.88936), (start.x, start.y)),
    ];
    let area: f64 = curves.iter().map(|c| c.signed_area(start)).sum();
    let domain = regions(&drawing(curves));
    assert!((domain.area() - area.abs()).abs() < 1e-9 * area.abs());
    assert_eq!(repairs(&domain, RepairKind::Corner), 1, "{:?}", domain.repairs());
    assert!(domain.curves().iter().all(|c| c.curve.turning(0.0, 1.0) < 2.7));
}

#[test]
fn curves_that_part_slowly_are_one_within_a_tolerance_that_was_asked_for() {
    // A disk on a line: within 1e-4 of each other for 14 thousandths on either side.
    let mut curves = square(-2.0, -3.0, 4.0);
    curves.extend([line((-2.0, 0.0), (2.0, 0.0)), circle(0.0, 0.5, 0.5)]);
    let drawing = drawing(curves);
    let whole = regions(&drawing);
    assert_eq!(repairs(&whole, RepairKind::Overlap), 0);
    let options = ArrangeOptions { tolerance: Some(1e-4), fill: Some(FillRule::Regions), ..ArrangeOptions::default() };
    let zipped = drawing.arrange(&options).unwrap();
    assert_eq!(zipped.flaws(), [""; 0]);
    assert!(repairs(&zipped, RepairKind::Overlap) > 0, "{:?}", zipped.repairs());
    assert!((zipped.area() - whole.area()).abs() < 1e-5, "{} {}", zipped.area(), whole.area());
    let corners = |domain: &Domain| {
        let at_contact = |&q: &squinch::ids::PointId| domain.points()[q].distance(Point::ORIGIN) < 0.1;
        domain
            .points()
            .ids()
            .filter(at_contact)
            .filter_map(|q| domain.corner(q))
            .map(|c| c.angle_rad)
            .fold(PI, f64::min)
    };
    assert!(corners(&whole) < 1e-9 && corners(&zipped) > 1e-2, "{} {}", corners(&whole), corners(&zipped));
}

/// Corner nodes as drawing programs write them: two cubics joined where neither has a handle.
#[test]
fn corners_between_curves_without_handles_are_corners() {
    let cubic = |q: [(f64, f64); 4]| Curve::bezier(q.map(|(x, y)| p(x, y)).to_vec()).unwrap();
    let outline = [
        cubic([(66.495, 18.376), (66.495, 18.376), (61.377, 41.67), (59.613, 58.435)]),
        cubic([(59.613, 58.435), (57.849, 75.2), (56.613, 104.317), (56.613, 104.317)]),
        cubic([(56.613, 104.317), (56.613, 104.317), (71.436, 115.258), (92.436, 128.67)]),
        line((92.436, 128.67), (66.495, 18.376)),
    ];
    for exponent in [-300, -30, 0, 30, 300] {
        let scale = 2f64.powi(exponent);
        let domain = regions(&drawing(outline.iter().map(|curve| curve.scaled(scale))));
        assert_eq!((domain.points().len(), domain.curves().len(), domain.regions().len()), (4, 4, 1));
    }
    // A needle: both sides leave the tip in the same direction, where the angle is 0.
    let needle = [
        cubic([(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (2.0, 1.0)]),
        line((2.0, 1.0), (2.0, -1.0)),
        cubic([(2.0, -1.0), (1.0, 0.0), (0.0, 0.0), (0.0, 0.0)]),
    ];
    let domain = regions(&drawing(needle));
    assert_eq!((domain.points().len(), domain.curves().len(), domain.regions().len()), (3, 3, 1));
}

/// A map traced three times: two long curves that part slowly, and beside them a short one that ends before they do.
#[test]
fn curves_that_part_slowly_are_ordered_beside_a_short_one() {
    let crest = |q: [(f64, f64); 7]| {
        let cubic = |q: &[(f64, f64)]| Curve::bezier(q.iter().map(|&(x, y)| p(x, y)).collect()).unwrap();
        [cubic(&q[..4]), cubic(&q[3..]), line(q[6], q[0])]
    };
    let traces = [
        [(0.0, 3.82395), (0.61997, 1.83070), (3.91641, 0.0), (6.88973, 0.0), (9.36961, 0.0), (11.70933, 2.45457)],
        [(0.0, 3.82395), (0.61997, 1.83070), (3.91739, 0.0), (6.88973, 0.0), (9.36961, 0.0), (11.71030, 2.45457)],
        [(0.00292, 3.82395), (0.62289, 1.83070), (3.91933, 0.0), (6.89265, 0.0), (9.37253, 0.0), (11.71322, 2.45457)],
    ];
    let lasts = [(12.4529, 5.83568), (12.4529, 5.83666), (12.45582, 5.83568)];
    let mut curves = square(-300.0, -230.0, 463.0);
    for (trace, last) in traces.into_iter().zip(lasts) {
        let [a, b, c, d, e, f] = trace;
        curves.extend(crest([a, b, c, d, e, f, last]));
    }
    let domain = regions(&drawing(curves));
    assert!(domain.regions().len() >= 4, "{:?}", areas(&domain));
}

/// Beside the tip of a leaf, where its two sides lie within one rounding of each other.
#[test]
fn a_speck_beside_the_tip_of_a_leaf_lies_outside_of_it() {
    let side = |x: f64| Curve::bezier(vec![p(1.0, 0.0), p(1.0, 0.5), p(x, 1.0)]).unwrap();
    for [first, second] in [[0.99, 1.01], [1.01, 0.99]] {
        let leaf = [side(first), side(second), line((first, 1.0), (second, 1.0))];
        let speck = square(1.5, 0.0, 1e-7);
        let domain = regions(&drawing(leaf.into_iter().chain(speck)));
        let outside = domain.curves().iter().filter(|c| c.sides.contains(&None)).count();
        assert_eq!((domain.regions().len(), outside), (2, 7));
    }
}

/// A line and a curve that is straight but for its beginning, where a circle of 1e-10 lies over both.
#[test]
fn a_circle_that_was_pulled_open_keeps_its_area_above_another() {
    let below = circle(-0.25, -3.5, 1.0);
    let pulled = below.with_ends(p(0.75000193, -3.5000005), below.end());
    let closing = Curve::line(pulled.end(), pulled.start()).unwrap();
    let ray = vec![line((1.75, -4.0), (-4.0, -4.0)), line((-4.0, -4.0), (1.75, -4.0))];
    let drawing = painted([("below", true, vec![below]), ("pulled", false, vec![pulled, closing]), ("ray", true, ray)]);
    let area = |fragments| {
        let options = ArrangeOptions { tolerance: Some(0.0), fragments, ..Default::default() };
        let domain = drawing.arrange(&options).unwrap();
        assert_eq!(domain.flaws(), [""; 0]);
        areas_by_name(&domain).iter().filter(|(name, _)| name.starts_with("pulled")).map(|(_, area)| area).sum::<f64>()
    };
    assert!((area(false) - area(true)).abs() < 1e-12, "{} {}", area(false), area(true));
}

#[test]
fn a_speck_on_the_tip_of_a_sliver_is_named_by_its_own_shape() {
    let [tip, far] = [(2.5, -1.25), (-3.999, -4.0)];
    let (from, to) = (-0.75 * PI, -0.75 * PI - 4.4505895925855405);
    let arc = Curve::arc(p(tip.0, tip.1), 1e-10, from, to - from).unwrap();
    let chord = Curve::line(arc.end(), arc.start()).unwrap();
    let bent = Curve::bezier(vec![p(tip.0, tip.1), arc.start(), p(far.0, far.1)]).unwrap();
    let drawing = painted([("speck", true, vec![arc, chord]), ("sliver", false, vec![bent, line(far, tip)])]);
    let domain = drawing.arrange(&ArrangeOptions { tolerance: Some(0.0), ..Default::default() }).unwrap();
    assert_eq!(domain.flaws(), [""; 0]);
    assert_eq!(domain.regions().len(), 2);
}

#[test]
fn a_hole_of_arcs_that_overlap_in_part_is_a_hole() {
    let arc = |from: f64, to: f64| Curve::arc(p(4.0, 3.0), 1.0, from, to - from).unwrap();
    let plate = polygon(&[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)]);
    for (first, second) in [((0.0, 3.5), (2.6, TAU)), ((0.0, PI), (PI - 1e-5, TAU + 1e-5))] {
        let hole = [arc(first.0, first.1), arc(second.0, second.1)];
        let domain = filled(&drawing(plate.iter().cloned().chain(hole)), FillRule::EvenOdd);
        assert_eq!(domain.regions().len(), 1);
        let area = domain.regions().iter().next().unwrap().area;
        assert!((area - (48.0 - PI)).abs() < 1e-9, "{area}");
    }
    // A hole of lines, each of which runs on along the next one's end for a while.
    let sides = [
        line((3.0, 2.0), (5.0, 2.0)),
        line((5.0, 2.0), (5.0, 4.0)),
        line((5.0, 4.0), (3.0, 4.0)),
        line((3.0, 4.0), (3.0, 2.8)),
        line((3.0, 3.2), (3.0, 2.0)),
    ];
    let domain = filled(&drawing(plate.into_iter().chain(sides)), FillRule::EvenOdd);
    let area = domain.regions().iter().map(|region| region.area).sum::<f64>();
    assert!((area - 44.0).abs() < 1e-9, "{area}");
}

#[test]
fn rings_a_hair_apart_hold_every_guarantee() {
    for hair in [1e-9, 1e-10, 1e-11] {
        let rings = drawing([circle(-3.0, -1.75, 1.0), circle(-3.0, -1.75, 1.0 + hair)]);
        let options = ArrangeOptions { tolerance: Some(0.0), fill: Some(FillRule::Regions), ..Default::default() };
        let domain = rings.arrange(&options).unwrap();
        assert_eq!(domain.flaws(), [""; 0], "{hair:e}");
        assert_eq!(domain.regions().len(), 2, "{hair:e}");
    }
}
