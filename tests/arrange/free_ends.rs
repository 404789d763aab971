//! Free ends: what explains a gap, which outlines miss closing, what open lines become.

use super::*;

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

#[test]
fn lines_that_stop_short_of_lines_that_go_on_beyond_the_corner() {
    let options = |close| ArrangeOptions { close, ..ArrangeOptions::default() };
    let hole = [Curve::circle(p(5.0, 5.0), 1.0).unwrap()];
    // The right side stops short of the lower one, which is the other end of its own chain; all four sides stop short
    // of each other.
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
    // A wall within an outline that stops short of the other side, and a hook that comes near to its own middle: open
    // lines.
    let plate = polygon(&[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)]);
    let wall = line((4.0, 0.0), (4.0, 5.99));
    let domain = drawing(plate.iter().cloned().chain([wall])).arrange(&options(None)).unwrap();
    assert_eq!(domain.regions().len(), 1);
    let comb = [line((1.0, 1.0), (7.0, 1.0)), line((2.0, 1.01), (2.0, 5.0)), line((3.0, 1.01), (3.0, 5.0))];
    let domain = drawing(plate.into_iter().chain(comb)).arrange(&options(None)).unwrap();
    assert_eq!(domain.regions().len(), 1);
}
