//! Drawings as people make them, arranged: what is kept, what is mended, what is refused.

use squinch::curve::Curve;
use squinch::domain::{
    ArrangeError, ArrangeOptions, Domain, Drawing, DrawnPoint, FillRule, Layer, Loose, OffPlane, RepairKind, Seed,
    SeedKind, Shape,
};
use squinch::geometry::{Point, Vec2};
use squinch::ids::{CurveId, Id};
use std::f64::consts::{PI, TAU};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn line(a: (f64, f64), b: (f64, f64)) -> Curve {
    Curve::line(p(a.0, a.1), p(b.0, b.1)).unwrap()
}

fn drawing(curves: impl IntoIterator<Item = Curve>) -> Drawing {
    let mut drawing = Drawing::default();
    for (i, curve) in curves.into_iter().enumerate() {
        drawing.add(curve, "wall", format!("curve {}", i + 1));
    }
    drawing
}

fn polygon(points: &[(f64, f64)]) -> Vec<Curve> {
    (0..points.len()).map(|i| line(points[i], points[(i + 1) % points.len()])).collect()
}

fn square(x: f64, y: f64, side: f64) -> Vec<Curve> {
    polygon(&[(x, y), (x + side, y), (x + side, y + side), (x, y + side)])
}

fn circle(x: f64, y: f64, r: f64) -> Curve {
    Curve::circle(p(x, y), r).unwrap()
}

/// The domain by a fill rule, after asking it for flaws.
fn filled(drawing: &Drawing, fill: FillRule) -> Domain {
    let domain = drawing.arrange(&ArrangeOptions { fill: Some(fill), ..Default::default() }).unwrap();
    assert_eq!(domain.flaws(), [""; 0]);
    domain
}

fn regions(drawing: &Drawing) -> Domain {
    filled(drawing, FillRule::Regions)
}

fn areas(domain: &Domain) -> Vec<f64> {
    domain.regions().iter().map(|r| r.area).collect()
}

fn close(found: &[f64], wanted: &[f64]) {
    assert_eq!(found.len(), wanted.len(), "{found:?} instead of {wanted:?}");
    for (f, w) in found.iter().zip(wanted) {
        assert!((f - w).abs() <= 1e-12 * w, "{found:?} instead of {wanted:?}");
    }
}

fn repairs(domain: &Domain, kind: RepairKind) -> usize {
    domain.repairs().iter().filter(|r| r.kind == kind).count()
}

/// Everything but coordinates.
fn topology(domain: &Domain) -> impl PartialEq + std::fmt::Debug + use<> {
    let curves: Vec<_> = domain.curves().iter().map(|c| (c.ends, c.sides, c.name, c.source)).collect();
    let stars: Vec<_> = domain.points().ids().map(|p| domain.star(p).to_vec()).collect();
    (curves, stars)
}

// ---- lines ----

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

// ---- free ends ----

/// The sides of a rectangle, each shorter by a gap at its end, around a closed bore.
fn plate_with_gaps(gap: f64) -> Drawing {
    let mut curves = vec![
        line((0.0, 0.0), (80.0 - gap, 0.0)),
        line((80.0, 0.0), (80.0, 60.0 - gap)),
        line((80.0, 60.0), (gap, 60.0)),
        line((0.0, 60.0), (0.0, gap)),
    ];
    curves.push(circle(40.0, 30.0, 10.0));
    drawing(curves)
}

#[test]
fn the_last_decimal_explains_a_gap() {
    let mut plate = plate_with_gaps(0.01);
    let whole = 4800.0 - 100.0 * PI;
    for (last_decimal, joined) in [(0.01, 4), (0.005, 4), (0.004, 0), (0.0, 0)] {
        plate.curves.iter_mut().for_each(|drawn| drawn.last_decimal = last_decimal);
        match plate.arrange(&ArrangeOptions { fill: Some(FillRule::EvenOdd), ..Default::default() }) {
            Ok(domain) => {
                assert_eq!(repairs(&domain, RepairKind::GapClosed), joined, "{last_decimal}");
                // Ends meet at the corner that their lines make, so that no side turns.
                close(&areas(&domain), &[whole]);
            }
            Err(error) => assert!(joined == 0 && error.what.contains("misses closing"), "{last_decimal}: {error}"),
        }
    }
    // Never more than a thousandth of the diagonal.
    let mut coarse = plate_with_gaps(0.2);
    coarse.curves.iter_mut().for_each(|drawn| drawn.last_decimal = 0.1);
    assert!(coarse.arrange(&ArrangeOptions::default()).unwrap_err().what.contains("misses closing"));
}

#[test]
fn an_outline_that_misses_closing_is_refused_and_the_way_out_works() {
    let plate = plate_with_gaps(0.05);
    let even_odd = ArrangeOptions { fill: Some(FillRule::EvenOdd), ..Default::default() };
    let error = plate.arrange(&even_odd).unwrap_err();
    assert!(error.what.contains("0.05 apart") && error.help.contains("--close 0.051"), "{error:?}");
    let closed = plate.arrange(&ArrangeOptions { close: Some(0.051), ..even_odd.clone() }).unwrap();
    close(&areas(&closed), &[4800.0 - 100.0 * PI]);
    for (loose, curves) in [(Loose::Keep, 6), (Loose::Drop, 2)] {
        let domain = plate.arrange(&ArrangeOptions { loose, ..even_odd.clone() }).unwrap();
        close(&areas(&domain), &[100.0 * PI]);
        assert_eq!(domain.curves().len(), curves, "the bore has two halves");
        assert!(domain.notes()[0].starts_with("4 lines are open: 279.8 in all"), "{:?}", domain.notes());
    }
}

#[test]
fn closing_welds_nothing_else() {
    // A slot as wide as the gap, which a tolerance of that would weld.
    let mut plate = plate_with_gaps(0.05);
    polygon(&[(20.0, 5.0), (30.0, 5.0), (30.0, 5.05), (20.0, 5.05)])
        .into_iter()
        .for_each(|c| plate.add(c, "slot", "slot"));
    let options = ArrangeOptions { fill: Some(FillRule::EvenOdd), close: Some(0.06), ..Default::default() };
    close(&areas(&plate.arrange(&options).unwrap()), &[4800.0 - 100.0 * PI - 0.5]);
}

#[test]
fn plainly_open_lines_are_told_and_kept() {
    let mut curves = square(0.0, 0.0, 10.0);
    // A centre line that goes beyond the outline, and hatching: parallel lines with ends near to each other.
    curves.push(line((-2.0, 5.0), (12.0, 5.0)));
    curves.extend((0..10).map(|k| line((1.0, 6.0 + 0.1 * f64::from(k)), (9.0, 6.0 + 0.1 * f64::from(k)))));
    let open = drawing(curves);
    let domain = filled(&open, FillRule::EvenOdd);
    close(&areas(&domain), &[50.0, 50.0]);
    assert!(domain.notes()[0].starts_with("11 lines are open: 84 in all"), "{:?}", domain.notes());
    let strict = ArrangeOptions { loose: Loose::Error, ..Default::default() };
    assert!(open.arrange(&strict).unwrap_err().what.contains("ends freely"));
    assert!(drawing(square(0.0, 0.0, 1.0)).arrange(&strict).is_ok());
}

#[test]
fn a_gap_is_found_where_a_wall_touches_the_outline() {
    // A wall closes a part of it, and the rest would pass for two open lines.
    let mut curves = plate_with_gaps(0.05).curves.into_iter().map(|c| c.curve).collect::<Vec<_>>();
    curves[0] = line((0.0, 0.0), (80.0, 0.0));
    curves[1] = line((80.0, 0.0), (80.0, 60.0));
    curves[2] = line((80.0, 60.0), (0.0, 60.0));
    curves.push(line((60.0, 0.0), (60.0, 60.0)));
    let error = drawing(curves).arrange(&ArrangeOptions::default()).unwrap_err();
    assert!(error.what.contains("an outline misses closing") && error.at.distance(p(0.0, 0.0)) < 0.1, "{error}");
}

#[test]
fn what_leaves_the_plane_is_named_as_the_cause_of_a_gap() {
    let mut curves = square(0.0, 0.0, 10.0);
    curves.pop();
    let mut plate = drawing(curves);
    plate.add(circle(5.0, 5.0, 1.0), "bore", "bore");
    plate.off_plane.push(OffPlane { entity: "LINE (handle 30)".into(), ends: [p(0.0, 10.0), p(0.0, 0.0)] });
    let error = plate.arrange(&ArrangeOptions::default()).unwrap_err();
    assert!(
        error.what.contains("LINE (handle 30) leaves the plane") && error.help.contains("--flatten-z"),
        "{error:?}"
    );
}

#[test]
fn what_encloses_nothing_is_refused_with_a_place() {
    let there_and_back = polygon(&[(1.0, 1.0), (3.0, 1.0), (2.0, 1.0)]);
    for curves in [there_and_back, vec![line((0.0, 0.0), (1.0, 1.0))]] {
        let error = drawing(curves).arrange(&ArrangeOptions::default()).unwrap_err();
        assert!(error.what.contains("nothing to mesh"), "{error}");
    }
    let error = Drawing::default().arrange(&ArrangeOptions::default()).unwrap_err();
    assert!(error.what.contains("no curves"), "{error}");
}

#[test]
fn lines_of_no_length_are_dropped_and_said() {
    let mut curves = square(0.0, 0.0, 1.0);
    curves.push(line((0.5, 0.5), (0.5, 0.5)));
    curves.push(line((0.0, 0.0), (1e-12, 0.0)));
    let domain = regions(&drawing(curves));
    assert_eq!((domain.curves().len(), repairs(&domain, RepairKind::ZeroLength)), (4, 2));
}

// ---- seeds, points, names ----

fn seed(x: f64, y: f64, kind: SeedKind) -> Seed {
    Seed { at: p(x, y), kind, entity: format!("seed at {x} {y}") }
}

#[test]
fn seeds_cut_holes_and_name_regions() {
    let mut rings = drawing((0..5).flat_map(|i| square(f64::from(i), f64::from(i), 20.0 - 2.0 * f64::from(i))));
    let steel = rings.names.intern("steel");
    let limit = Some(0.5);
    rings.seeds = vec![
        seed(0.5, 0.5, SeedKind::Region { name: steel, max_area: limit }),
        seed(10.0, 10.0, SeedKind::Region { name: steel, max_area: limit }),
        seed(1.5, 1.5, SeedKind::Hole),
        seed(50.0, 0.0, SeedKind::Hole),
        seed(1.5, 18.5, SeedKind::Hole),
    ];
    let domain = regions(&rings);
    assert_eq!(repairs(&domain, RepairKind::Seed), 2);
    let names: Vec<&str> = domain.regions().iter().map(|r| domain.name(r.name)).collect();
    assert_eq!(names, ["steel", "region1", "region2"]);
    close(&areas(&domain), &[400.0 - 324.0 + 144.0, 256.0 - 196.0, 196.0 - 144.0]);
    assert_eq!(domain.regions().iter().next().unwrap().max_area, limit);
    let region = |x: f64| domain.locate_region(p(x, 10.0)).map(|r| domain.name(domain.regions()[r].name));
    assert_eq!(
        [0.5, 1.5, 2.5, 3.5, 4.5].map(region),
        [Some("steel"), None, Some("region1"), Some("region2"), Some("steel")]
    );
    assert_eq!(region(-1.0), None);
}

#[test]
fn drawn_points_are_kept_and_split_what_they_lie_on() {
    let mut drawn = drawing(square(0.0, 0.0, 2.0));
    let name = drawn.names.intern("probe");
    for (x, y) in [(1.0, 1.0), (1.0, 0.0), (2.0, 2.0), (9.0, 9.0)] {
        drawn.points.push(DrawnPoint { at: p(x, y), name: Some(name), entity: format!("point {x} {y}") });
    }
    let domain = regions(&drawn);
    assert_eq!((domain.points().len(), domain.curves().len()), (7, 5));
    assert_eq!(domain.point_names().len(), 4);
    assert!(domain.point_names().keys().any(|&q| domain.points()[q] == p(1.0, 0.0) && domain.star(q).len() == 2));
}

#[test]
fn keep_all_adds_a_box_and_keeps_every_face() {
    let mut drawn = drawing([circle(0.0, 0.0, 1.0), circle(0.0, 0.0, 0.5)]);
    drawn.seeds.push(seed(0.0, 0.0, SeedKind::Hole));
    let domain = drawn.arrange(&ArrangeOptions { keep_all: true, ..Default::default() }).unwrap();
    assert_eq!(domain.flaws(), [""; 0]);
    let side = 2.0 + 2.0 * 8f64.sqrt();
    close(&areas(&domain), &[side * side - PI, 0.75 * PI, 0.25 * PI]);
    assert_eq!(domain.curves().iter().filter(|c| domain.name(c.name) == "box").count(), 4);
}

// ---- curves ----

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
    let area = star.green(p(2.0, 1.0));
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
    assert!((domain.measure() - PI).abs() < 1e-6);
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
    let area: f64 = curves.iter().map(|c| c.green(start)).sum();
    let domain = regions(&drawing(curves));
    assert!((domain.measure() - area.abs()).abs() < 1e-9 * area.abs());
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
    assert!((zipped.measure() - whole.measure()).abs() < 1e-5, "{} {}", zipped.measure(), whole.measure());
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

// ---- coarse tolerances ----

/// Closed outlines of every kind around (50, 50), `width` across where they are narrowest, with their areas.
fn outlines(width: f64) -> Vec<(&'static str, Vec<Curve>, f64)> {
    let (r, o) = (width / 2.0, 50.0);
    let around = |turn: f64, r: f64| p(o, o) + Vec2::from_angle(turn) * r;
    let spline =
        Curve::periodic_spline(&(0..8).map(|i| around(f64::from(i) * TAU / 8.0, r)).collect::<Vec<_>>()).unwrap();
    let ellipse = |start: f64| Curve::ellipse(p(o, o), Vec2::new(3.0 * r, 0.0), Vec2::new(0.0, r), start, TAU).unwrap();
    let tear = Curve::bezier(vec![p(o - r, o), p(o + 4.0 * r, o - 4.0 * r), p(o + 4.0 * r, o + 4.0 * r), p(o - r, o)])
        .unwrap();
    let (west, east) = (around(PI, r), around(0.0, r));
    let halves = [Curve::bulge(west, east, 1.0).unwrap(), Curve::bulge(east, west, 1.0).unwrap()];
    let (low, high) = (around(PI, width), around(0.0, width));
    let cap = vec![Curve::line(low, high).unwrap(), Curve::bulge(high, low, 1.0).unwrap()];
    let (spline_area, tear_area) = (spline.green(p(o, o)), tear.green(p(o, o)));
    vec![
        ("circle", vec![circle(o, o, r)], PI * r * r),
        ("ellipse", vec![ellipse(0.0)], 3.0 * PI * r * r),
        ("ellipse from its flat side", vec![ellipse(PI / 2.0)], 3.0 * PI * r * r),
        ("bezier", vec![tear], tear_area),
        ("spline", vec![spline], spline_area),
        ("arcs", halves.to_vec(), PI * r * r),
        ("arc and line", cap, PI * width * width / 2.0),
        ("square", square(o - r, o - r, width), width * width),
    ]
}

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

// ---- hubs ----

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

/// Points less curves plus faces, the unbounded one included, against one more than the connected parts.
fn euler(domain: &Domain) -> (usize, usize) {
    let mut root: Vec<usize> = (0..domain.points().len()).collect();
    let find = |root: &Vec<usize>, mut i: usize| {
        while root[i] != i {
            i = root[i];
        }
        i
    };
    let mut parts = domain.points().len();
    for curve in domain.curves().iter() {
        let [a, b] = curve.ends.map(|end| find(&root, end.index()));
        parts -= usize::from(a != b);
        root[a] = b;
    }
    (domain.points().len() + domain.regions().len() + 1, 1 + parts + domain.curves().len())
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

// ---- laws ----

/// A drawing with something of everything, scaled and moved.
fn mixture(factor: f64, offset: f64) -> Drawing {
    let mut curves = square(-4.0, -4.0, 8.0);
    curves.extend([circle(0.0, 0.0, 2.0), circle(1.0, 0.0, 1.0), circle(-3.0, -3.0, 0.5)]);
    curves.push(line((-5.0, 1.0), (5.0, 1.5)));
    curves.push(Curve::bezier(vec![p(-4.0, -4.0), p(0.0, 3.0), p(1.0, -6.0), p(3.0, 2.0)]).unwrap());
    curves.push(Curve::ellipse(p(2.0, 2.0), Vec2::new(1.5, 0.5), Vec2::new(-0.2, 0.7), 0.0, TAU).unwrap());
    let moved = |c: Curve| c.transformed(kurbo::Affine::translate((offset, offset)));
    drawing(curves.into_iter().map(|c| if offset == 0.0 { c } else { moved(c) }).map(|c| c.scaled(factor)))
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
fn arranging_is_repeatable_and_turning_splits_keep_every_promise() {
    let domain = regions(&mixture(1.0, 0.0));
    assert_eq!(topology(&domain), topology(&regions(&mixture(1.0, 0.0))));
    for tau in [0.1, 0.5, PI / 3.0] {
        let split = domain.split_to_turning(tau);
        assert_eq!(split.flaws(), [""; 0]);
        assert!(split.curves().iter().all(|c| c.curve.turning(0.0, 1.0) <= tau * (1.0 + 1e-9)));
        close(&areas(&split), &areas(&domain));
    }
}

// ---- oracles ----

/// A fixed sequence of numbers in 0..1.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    }
}

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

/// A heap of curves of every kind, on top of each other; on a grid, so that ends and tangents coincide, where asked.
fn heap(seed: u64, grid: bool) -> Vec<Curve> {
    let mut number = numbers(seed * 7919 + 13);
    let mut up_to = move |size: f64| {
        let x = number() * size;
        if grid { (x * 8.0).round() / 8.0 } else { x }
    };
    let mut curves = Vec::new();
    for k in 0..6 + seed % 14 {
        let mut places = |n: usize| -> Vec<Point> { (0..n).map(|_| p(up_to(2.0), up_to(2.0))).collect() };
        let at = places(1)[0];
        let curve = match (k + seed) % 7 {
            0 => Curve::line(at, places(1)[0]),
            1 => Curve::circle(at, 0.125 + up_to(0.8)),
            2 => Curve::arc(at, 0.125 + up_to(0.8), up_to(6.0), 0.3 + up_to(5.0)),
            3 => {
                let (u, v) = (Vec2::new(0.2 + up_to(0.5), up_to(0.3)), Vec2::new(-up_to(0.1), 0.1 + up_to(0.5)));
                Curve::ellipse(at, u, v, 0.0, TAU)
            }
            4 => Curve::bezier(places(4)),
            5 => Curve::natural_spline(&places(7)),
            _ => Curve::periodic_spline(&places(5)),
        };
        let Ok(curve) = curve else { continue };
        if k % 5 == 4 {
            curves.push(curve.part(0.2, 0.7));
        }
        curves.push(curve);
    }
    curves
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
fn a_coarse_tolerance_keeps_every_promise() {
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

// ---- files ----

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

/// Shapes in the order in which they are painted: name, rule and outlines.
fn painted<const N: usize>(shapes: [(&str, bool, Vec<Curve>); N]) -> Drawing {
    let mut drawing = Drawing { fill: FillRule::Shapes, ..Drawing::default() };
    for (name, even_odd, curves) in shapes {
        let name = drawing.names.intern(name);
        let shape = drawing.shapes.push(Shape::new(name, even_odd, "path"));
        for curve in curves {
            drawing.add(curve, "ink", "curve");
            drawing.curves.last_mut().unwrap().shape = Some(shape);
        }
    }
    drawing
}

fn areas_by_name(domain: &Domain) -> Vec<(&str, f64)> {
    domain.regions().iter().map(|r| (domain.name(r.name), r.area)).collect()
}

#[test]
fn the_topmost_shape_names_a_face() {
    let (low, high) = (square(0.0, 0.0, 4.0), square(2.0, 2.0, 4.0));
    let over =
        painted([("low", false, low.clone()), ("high", false, high.clone())]).arrange(&Default::default()).unwrap();
    assert_eq!(areas_by_name(&over), [("low", 12.0), ("high", 16.0)]);
    let under = painted([("high", false, high), ("low", false, low)]).arrange(&Default::default()).unwrap();
    assert_eq!(areas_by_name(&under), [("high", 12.0), ("low", 16.0)]);
}

#[test]
fn every_shape_has_its_own_rule() {
    // Two squares one in the other, the same way round: a ring by one rule, full by the other.
    let pair = |x: f64| [square(x, 0.0, 4.0), square(x + 1.0, 1.0, 2.0)].concat();
    let drawn = painted([("ring", true, pair(0.0)), ("full", false, pair(10.0))]);
    let domain = drawn.arrange(&Default::default()).unwrap();
    assert_eq!(areas_by_name(&domain), [("ring", 12.0), ("full", 16.0)]);
    assert_eq!(domain.flaws(), [""; 0]);
}

#[test]
fn shapes_that_share_or_repeat_an_outline_stay_apart() {
    // Side by side with a common edge, the same square twice, and one shape that runs there and back: nothing enclosed.
    let there_and_back = vec![line((8.0, 0.0), (9.0, 0.0)), line((9.0, 0.0), (8.0, 0.0))];
    let drawn = painted([
        ("left", false, square(0.0, 0.0, 1.0)),
        ("right", true, square(1.0, 0.0, 1.0)),
        ("again", true, square(1.0, 0.0, 1.0)),
        ("nothing", false, there_and_back),
    ]);
    let domain = drawn.arrange(&Default::default()).unwrap();
    assert_eq!(areas_by_name(&domain), [("left", 1.0), ("again", 1.0)]);
}

#[test]
fn every_bounded_face_of_a_picture_is_a_region_on_request() {
    let ring = painted([("ring", true, [square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0)].concat())]);
    assert_eq!(areas_by_name(&regions(&ring)), [("ring", 12.0), ("region", 4.0)]);
    // A region of the picture that is called like ours keeps its name to itself.
    let ring = painted([("region", true, [square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0)].concat())]);
    assert_eq!(areas_by_name(&regions(&ring)), [("region", 12.0), ("region1", 4.0)]);
}

fn hidden(domain: &Domain) -> usize {
    domain.repairs().iter().filter(|r| r.kind == RepairKind::Hidden).count()
}

#[test]
fn what_later_shapes_cover_leaves_no_trace() {
    // A square half beneath a disc, and another wholly.
    let disc = || vec![circle(4.0, 2.0, 1.0)];
    let low = || square(0.0, 0.0, 4.0);
    let shapes = [("low", false, low()), ("lost", false, square(3.75, 1.75, 0.5)), ("disc", false, disc())];
    let domain = painted(shapes).arrange(&Default::default()).unwrap();
    let [(low_name, low_area), (disc_name, disc_area)] = areas_by_name(&domain)[..] else { panic!("two regions") };
    assert_eq!([low_name, disc_name], ["low", "disc"]);
    assert!((low_area - (16.0 - PI / 2.0)).abs() < 1e-12 && (disc_area - PI).abs() < 1e-12);
    assert!(domain.curves().iter().all(|c| c.sides[0] != c.sides[1]), "a curve with one region on both sides");
    // Four corners, two places where the disc begins to cover a side, and the place where the disc begins.
    assert_eq!((domain.points().len(), domain.curves().len(), hidden(&domain)), (7, 8, 5));
    assert_eq!(domain.flaws(), [""; 0]);
    // As fragments they all stay.
    let fragments = ArrangeOptions { fragments: true, ..Default::default() };
    let shapes = [("low", false, low()), ("disc", false, disc())];
    let domain = painted(shapes).arrange(&fragments).unwrap();
    assert_eq!((domain.regions().len(), hidden(&domain)), (3, 0));
}

#[test]
fn what_hidden_curves_split_is_whole_again() {
    // A fan of triangles, the tips of which a disc covers: the disc is split where the ten sides meet it, one of them where it begins.
    let triangle = |k: i32| {
        let at = |angle: f64| (3.0 * libm::cos(angle), 3.0 * libm::sin(angle));
        let (from, to) = (at(f64::from(k)), at(f64::from(k) + 0.5));
        ("fan", false, vec![line((0.0, 0.0), from), line(from, to), line(to, (0.0, 0.0))])
    };
    let disc = ("disc", false, vec![circle(0.0, 0.0, 1.0)]);
    let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(triangle);
    let domain = painted([a, b, c, d, e, disc]).arrange(&Default::default()).unwrap();
    assert_eq!(domain.curves().iter().filter(|c| matches!(c.curve, Curve::Arc(_))).count(), 10);
    assert_eq!(domain.flaws(), [""; 0]);
    // A bar beneath a square, and a lid on both: nothing splits its sides.
    let bar = |x: f64, y: f64, w: f64, h: f64| {
        let [a, b, c, d] = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)];
        vec![line(a, b), line(b, c), line(c, d), line(d, a)]
    };
    let below = ("below", false, bar(-4.0, -0.5, 8.0, 1.0));
    let lid = ("lid", false, bar(-5.0, -2.0, 10.0, 4.0));
    let domain =
        painted([below, ("square", false, square(-1.0, -1.0, 2.0)), lid]).arrange(&Default::default()).unwrap();
    assert_eq!((domain.points().len(), domain.curves().len(), domain.regions().len()), (4, 4, 1));
}

#[test]
fn strokes_over_shapes_are_seen() {
    let mut drawing = painted([("low", false, square(0.0, 0.0, 4.0))]);
    drawing.add(line((1.0, 1.0), (3.0, 3.0)), "stroke", "line");
    let domain = drawing.arrange(&Default::default()).unwrap();
    assert_eq!((domain.curves().len(), hidden(&domain)), (5, 0));
}

#[test]
fn shapes_nested_deep_are_painted_in_turn() {
    let rings = 500;
    let mut drawing = Drawing { fill: FillRule::Shapes, ..Drawing::default() };
    for k in 0..rings {
        let name = drawing.names.intern(&format!("ring {k}"));
        let shape = drawing.shapes.push(Shape::new(name, false, "circle"));
        drawing.add(circle(0.0, 0.0, f64::from(rings - k)), "ink", "circle");
        drawing.curves.last_mut().unwrap().shape = Some(shape);
    }
    let domain = drawing.arrange(&Default::default()).unwrap();
    assert_eq!(domain.regions().len(), 500);
    let ring = |k: i32| PI * f64::from(2 * (rings - k) - 1);
    let wanted: Vec<f64> = (0..rings).map(ring).collect();
    assert!(areas(&domain).iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-6));
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
fn lines_that_stop_short_of_lines_that_go_on_beyond_the_corner() {
    let options = |close| ArrangeOptions { close, ..ArrangeOptions::default() };
    let hole = [Curve::circle(p(5.0, 5.0), 1.0).unwrap()];
    // The right side stops short of the lower one, which is the other end of its own chain; all four sides stop short of each other.
    let own = [
        line((0.0, 0.0), (12.0, 0.0)),
        line((10.0, 0.01), (10.0, 8.0)),
        line((10.0, 8.0), (0.0, 8.0)),
        line((0.0, 8.0), (0.0, 0.0)),
    ];
    let pinwheel = [
        line((0.01, 0.0), (12.0, 0.0)),
        line((10.0, 0.01), (10.0, 10.0)),
        line((9.99, 8.0), (-2.0, 8.0)),
        line((0.0, 7.99), (0.0, -2.0)),
    ];
    for outline in [own, pinwheel] {
        let drawn = drawing(outline.into_iter().chain(hole.clone()));
        let missed = drawn.arrange(&options(None)).unwrap_err();
        assert!(missed.what.contains("stops 0.01 short of") && missed.help.contains("--close 0.011"), "{missed:?}");
        let domain = drawn.arrange(&options(Some(0.011))).unwrap();
        let area = domain.regions().iter().map(|region| region.area).sum::<f64>();
        assert!((area - (80.0 - PI)).abs() < 1e-9, "{area}");
    }
    // Two ends that stop short of one line, with a strip between: parallel lines.
    let bulged = |half: f64, y: f64| Curve::bulge(p(4.0 - half, y), p(4.0 + half, y), 0.3).unwrap();
    let plate = polygon(&[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)]);
    let domain =
        drawing(plate.into_iter().chain([bulged(1.0, 3.0), bulged(0.9, 3.001)])).arrange(&options(None)).unwrap();
    assert_eq!(domain.regions().len(), 1);
    // A wall within an outline that stops short of the other side, and a hook that comes near to its own middle: open lines.
    let plate = polygon(&[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)]);
    let wall = line((4.0, 0.0), (4.0, 5.99));
    let domain = drawing(plate.iter().cloned().chain([wall])).arrange(&options(None)).unwrap();
    assert_eq!(domain.regions().len(), 1);
    let comb = [line((1.0, 1.0), (7.0, 1.0)), line((2.0, 1.01), (2.0, 5.0)), line((3.0, 1.01), (3.0, 5.0))];
    let domain = drawing(plate.into_iter().chain(comb)).arrange(&options(None)).unwrap();
    assert_eq!(domain.regions().len(), 1);
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

// ---- auxiliary linework ----

/// Curves on layers, by name.
fn layered(layers: &[(&str, Vec<Curve>)]) -> Drawing {
    let mut drawing = Drawing::default();
    for (name, curves) in layers {
        let line_types = [("CONTINUOUS".to_owned(), curves.len())].into();
        let layer = Some(drawing.layers.push(Layer { name: (*name).into(), line_types }));
        for curve in curves {
            drawing.add(curve.clone(), name, format!("curve on {name}"));
            drawing.curves.last_mut().unwrap().layer = layer;
        }
    }
    drawing
}

fn notes_of(layers: &[(&str, Vec<Curve>)]) -> String {
    filled(&layered(layers), FillRule::EvenOdd).notes().join("\n")
}

#[test]
fn a_frame_around_a_part_is_told() {
    let part = ("PART", square(2.0, 2.0, 6.0));
    let holes = ("HOLES", vec![circle(4.0, 4.0, 0.5), circle(6.0, 6.0, 0.5)]);
    let sheet = ("A4", square(0.0, 0.0, 10.0));
    let double = ("A4", [square(0.0, 0.0, 10.0), square(1.0, 1.0, 8.0)].concat());
    for frame in [sheet.clone(), double] {
        let notes = notes_of(&[frame, part.clone(), holes.clone()]);
        assert!(notes.contains("Layer A4") && notes.contains("--skip-layers A4"), "{notes}");
    }
    // A box of the title block holds nothing.
    let titled = ("A4", [square(0.0, 0.0, 10.0), square(8.5, 0.2, 1.0)].concat());
    let notes = notes_of(&[titled, part.clone(), holes.clone()]);
    assert!(notes.contains("--skip-layers A4"), "{notes}");
    // A plate with holes is no frame, unless it is called one; nor is what holds nothing.
    assert_eq!(notes_of(&[sheet.clone(), part.clone()]), "");
    assert_eq!(notes_of(&[part.clone(), holes.clone()]), "");
    assert!(notes_of(&[("Title frame", square(0.0, 0.0, 10.0)), part]).contains("--skip-layers 'Title frame'"));
}

#[test]
fn outlines_that_cross_those_of_another_layer_are_told() {
    let disk =
        ("0", vec![circle(0.0, 0.0, 10.0), circle(6.0, 0.0, 1.0), circle(-6.0, 0.0, 1.0), circle(0.0, 6.0, 1.0)]);
    let bolts = ("CENTER", vec![circle(0.0, 0.0, 6.0)]);
    let notes = notes_of(&[disk.clone(), bolts]);
    assert!(notes.contains("layer CENTER cross those of layer 0") && notes.contains("5 places more"), "{notes}");
    assert!(notes.contains("--skip-layers CENTER"), "{notes}");
    // On one layer with its holes, too; but not holes that run into each other.
    let notes = notes_of(&[("0", [disk.1.clone(), vec![circle(0.0, 0.0, 6.0)]].concat())]);
    assert!(notes.contains("curve on 0 crosses 3 circles of its layer") && notes.contains("--skip-layers"), "{notes}");
    let row = (0..6).map(|i| circle(f64::from(i), 0.0, 0.8)).collect();
    assert_eq!(notes_of(&[("0", row)]), "");
    // What only touches, shares a wall, or is open, crosses nothing.
    let beside = ("SIDE", vec![circle(12.0, 0.0, 2.0)]);
    assert_eq!(notes_of(&[disk, beside]), "");
    assert_eq!(notes_of(&[("A", square(0.0, 0.0, 2.0)), ("B", square(2.0, 0.0, 2.0))]), "");
    let open = notes_of(&[("A", square(0.0, 0.0, 2.0)), ("B", vec![line((-1.0, 1.0), (3.0, 1.0))])]);
    assert!(!open.contains("cross"), "{open}");
}

#[test]
fn rings_a_hair_apart_keep_every_promise() {
    for hair in [1e-9, 1e-10, 1e-11] {
        let rings = drawing([circle(-3.0, -1.75, 1.0), circle(-3.0, -1.75, 1.0 + hair)]);
        let options = ArrangeOptions { tolerance: Some(0.0), fill: Some(FillRule::Regions), ..Default::default() };
        let domain = rings.arrange(&options).unwrap();
        assert_eq!(domain.flaws(), [""; 0], "{hair:e}");
        assert_eq!(domain.regions().len(), 2, "{hair:e}");
    }
}
