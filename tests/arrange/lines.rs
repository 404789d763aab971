//! Straight lines: crossings, overlaps, contours drawn twice, gaps.

use super::*;

#[test]
fn a_square_is_one_region_with_four_corners() {
    let domain = regions(&drawing(square(0.0, 0.0, 1.0)));
    assert_eq!((domain.points().len(), domain.curves().len()), (4, 4));
    assert_eq!(areas(&domain), [1.0]);
    assert_eq!(domain.name(domain.regions().iter().next().unwrap().name), "region");
    assert!(domain.repairs().is_empty());
    assert!(domain.curves().iter().all(|c| c.sides[0].is_some() && c.sides[1].is_none()));
    assert!(domain.points().ids().all(|p| domain.star(p).len() == 2 && !domain.is_acute(p)));
    assert_eq!(domain.lfs().as_slice(), [1.0; 4]);
    assert_eq!(domain.lfs0().as_slice(), [1.0; 4]);
}

#[test]
fn crossing_lines_are_split_and_an_hourglass_has_two_halves() {
    let domain = regions(&drawing(polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)])));
    assert_eq!((domain.points().len(), domain.curves().len()), (5, 6));
    close(&areas(&domain), &[1.0, 1.0]);
    assert_eq!(repairs(&domain, RepairKind::Split), 2);
    // Its halves go around opposite ways: both rules keep both.
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        close(&areas(&filled(&drawing(polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)])), rule)), &[1.0, 1.0]);
    }
}

#[test]
fn fill_rules_tell_a_ring_from_a_disk() {
    let mut same_way = square(0.0, 0.0, 4.0);
    same_way.extend(square(1.0, 1.0, 1.0));
    let ring = drawing(same_way.clone());
    close(&areas(&filled(&ring, FillRule::EvenOdd)), &[15.0]);
    close(&areas(&filled(&ring, FillRule::NonZero)), &[15.0, 1.0]);
    close(&areas(&regions(&ring)), &[15.0, 1.0]);
    let mut against = square(0.0, 0.0, 4.0);
    against.extend(square(1.0, 1.0, 1.0).iter().map(Curve::reversed));
    close(&areas(&filled(&drawing(against), FillRule::NonZero)), &[15.0]);
}

#[test]
fn overlapping_squares_count_every_stretch_as_often_as_it_was_drawn() {
    // Two squares side by side, with the common side drawn twice.
    let mut pair = square(0.0, 0.0, 1.0);
    pair.extend(square(1.0, 0.0, 1.0));
    let domain = filled(&drawing(pair.clone()), FillRule::EvenOdd);
    close(&areas(&domain), &[1.0, 1.0]);
    assert_eq!((domain.curves().len(), repairs(&domain, RepairKind::Duplicate)), (7, 1));
    assert_eq!(domain.notes(), [""; 0]);
    // All of it drawn twice.
    pair.extend(pair.clone());
    close(&areas(&filled(&drawing(pair), FillRule::EvenOdd)), &[1.0, 1.0]);
    // A notch drawn as a square of its own, on a stretch of the outline.
    let mut notched = square(0.0, 0.0, 4.0);
    notched.extend(square(1.0, 0.0, 1.0));
    close(&areas(&filled(&drawing(notched), FillRule::EvenOdd)), &[15.0]);
}

#[test]
fn contours_drawn_twice_count_once() {
    let plate = || square(0.0, 0.0, 4.0);
    let hole = || vec![circle(1.0, 1.0, 0.5)];
    let turned = || square(0.0, 0.0, 4.0).iter().map(Curve::reversed).collect::<Vec<_>>();
    let area = 16.0 - 0.25 * PI;
    for (curves, copies) in [
        ([plate(), hole(), plate(), hole()], "5 curves are"),
        ([plate(), plate(), hole(), turned()], "8 curves are"),
        ([plate(), hole(), hole(), hole()], "2 curves are"),
        ([plate(), hole(), vec![line((0.0, 0.0), (4.0, 0.0))], vec![]], "1 curve is"),
        ([plate(), hole(), vec![line((1.0, 0.0), (3.0, 0.0))], vec![]], "1 curve is"),
    ] {
        let domain = filled(&drawing(curves.concat()), FillRule::EvenOdd);
        close(&areas(&domain), &[area]);
        assert!(domain.notes().iter().any(|note| note.starts_with(copies)), "{:?}", domain.notes());
    }
}

#[test]
fn collinear_overlaps_become_one_stretch() {
    let mut curves = square(0.0, 0.0, 3.0);
    curves.push(line((1.0, 0.0), (2.0, 0.0)));
    curves.push(line((2.5, 0.0), (-1.0, 0.0)));
    let domain = regions(&drawing(curves));
    close(&areas(&domain), &[9.0]);
    // The bottom side in 0, 1, 2, 2.5, 3 and a stub to −1.
    assert_eq!(domain.curves().len(), 3 + 4 + 1);
    assert!(repairs(&domain, RepairKind::Overlap) >= 3);
}

#[test]
fn ends_on_curves_split_them_and_open_curves_stay_as_constraints() {
    let mut curves = square(0.0, 0.0, 2.0);
    curves.push(line((0.0, 1.0), (1.5, 1.0)));
    curves.push(line((5.0, 5.0), (6.0, 5.0)));
    for rule in [FillRule::Regions, FillRule::EvenOdd, FillRule::NonZero] {
        let domain = filled(&drawing(curves.clone()), rule);
        close(&areas(&domain), &[4.0]);
        let stub = domain.curves().iter().find(|c| c.source == 4).unwrap();
        assert!(stub.sides[0].is_some() && stub.sides[0] == stub.sides[1]);
        let away = domain.curves().iter().find(|c| c.source == 5).unwrap();
        assert_eq!(away.sides, [None, None]);
    }
}

#[test]
fn loose_lines_that_see_each_other_lie_in_the_face_around_them() {
    // At some level each of the two lies to the left of the other.
    let (bend, low, left) = ((0.521, 0.124), (0.757, -0.831), (-0.378, -0.066));
    let mut curves = square(-1.0, -1.0, 2.0);
    curves.extend([line((0.513, -0.242), (0.401, 0.081)), line(bend, left), line(low, bend)]);
    close(&areas(&regions(&drawing(curves))), &[4.0]);
}

#[test]
fn a_chord_divides_whatever_the_fill_rule() {
    let mut curves = square(0.0, 0.0, 2.0);
    curves.push(line((0.0, 0.0), (2.0, 2.0)));
    curves.push(line((-1.0, 1.0), (3.0, 1.0)));
    for rule in [FillRule::Regions, FillRule::EvenOdd, FillRule::NonZero] {
        let domain = filled(&drawing(curves.clone()), rule);
        close(&areas(&domain), &[1.5, 1.5, 0.5, 0.5]);
    }
}

#[test]
fn lines_that_enclose_only_by_crossing_are_filled() {
    let hash = [((0.0, 1.0), (3.0, 1.0)), ((0.0, 2.0), (3.0, 2.0)), ((1.0, 0.0), (1.0, 3.0)), ((2.0, 0.0), (2.0, 3.0))];
    for rule in [FillRule::Regions, FillRule::EvenOdd, FillRule::NonZero] {
        close(&areas(&filled(&drawing(hash.map(|(a, b)| line(a, b))), rule)), &[1.0]);
    }
}

#[test]
fn gaps_are_welded_or_closed_and_said() {
    let open = |gap: f64| {
        drawing([
            line((0.0, 0.0), (1.0, 0.0)),
            line((1.0, 0.0), (1.0, 1.0)),
            line((1.0, 1.0), (0.0, 1.0)),
            line((0.0, 1.0), (gap, 0.0)),
        ])
    };
    let welded = regions(&open(1e-10));
    assert_eq!((repairs(&welded, RepairKind::Weld), repairs(&welded, RepairKind::GapClosed)), (1, 0));
    assert_eq!(welded.repairs()[0].size, 1e-10);
    let closed = drawing(open(1e-7).curves.into_iter().map(|c| c.curve));
    // The end lies on the first side: it is a corner there, and no gap is left.
    let domain = regions(&closed);
    assert_eq!(repairs(&domain, RepairKind::Split), 1);

    let apart = |gap: f64| {
        drawing([
            line((0.0, 0.0), (1.0, 0.0)),
            line((1.0, 0.0), (1.0, 1.0)),
            line((1.0, 1.0), (0.0, 1.0)),
            line((0.0, 1.0), (0.0, gap)),
        ])
    };
    let domain = regions(&apart(1e-7));
    assert_eq!(repairs(&domain, RepairKind::GapClosed), 1);
    assert_eq!(domain.points().len(), 4);
    let strict = ArrangeOptions { tolerance: Some(0.0), ..Default::default() };
    for (refused, way_out) in [
        (apart(1e-7).arrange(&strict), "--close 1.1e-7"),
        (apart(1e-3).arrange(&ArrangeOptions::default()), "--close 0.0011"),
    ] {
        let error: ArrangeError = refused.unwrap_err();
        assert!(error.what.contains("an outline misses closing"), "{error}");
        assert!(error.at.distance(p(0.0, 0.0)) < 1e-2 && error.help.contains(way_out), "{error:?}");
    }
}
