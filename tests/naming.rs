//! Names given by hand, and names of outlines and entities.

use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Drawing, DrawnCurve, FillRule, NameBy, Naming};
use squinch::geometry::Point;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

/// A plate of four lines and two bores, on two layers, with handles from 2F on.
fn plate() -> Drawing {
    let mut drawing = Drawing { fill: FillRule::EvenOdd, ..Drawing::default() };
    let corners = [p(0.0, 0.0), p(10.0, 0.0), p(10.0, 5.0), p(0.0, 5.0)];
    let sides = (0..4).map(|k| Curve::line(corners[k], corners[(k + 1) % 4]).unwrap());
    let bores = [2.5, 7.5].map(|x| Curve::circle(p(x, 2.5), 1.0).unwrap());
    let named = sides.map(|c| (c, "EDGE")).chain(bores.into_iter().map(|c| (c, "HOLES")));
    for (handle, (curve, layer)) in (0x2f..).zip(named) {
        let name = drawing.names.intern(layer);
        let entity = format!("LINE (handle {handle:X})");
        drawing.curves.push(DrawnCurve { handle: Some(handle), ..DrawnCurve::new(curve, name, entity) });
    }
    drawing
}

fn boundaries(drawing: &Drawing) -> Vec<&str> {
    drawing.curves.iter().map(|drawn| drawing.names.text(drawn.name)).collect()
}

fn given(text: &str) -> NameBy {
    text.parse().unwrap()
}

#[test]
fn the_curve_nearest_to_a_place_is_named() {
    let mut drawing = plate();
    let told = drawing.give_name(&given("LOAD=9.8,2.5")).unwrap().unwrap();
    assert!(told.starts_with("LOAD names LINE (handle 30), 0.2 away"), "{told}");
    assert_eq!(boundaries(&drawing), ["EDGE", "LOAD", "EDGE", "EDGE", "HOLES", "HOLES"]);
    let told = drawing.give_name(&given("CORNER=0,0")).unwrap().unwrap();
    assert!(told.contains("is as near"), "{told}");
}

#[test]
fn an_entity_is_named_by_its_handle() {
    let mut drawing = plate();
    drawing.give_name(&given("BORE=handle:33")).unwrap();
    assert_eq!(boundaries(&drawing)[4..], ["BORE", "HOLES"]);
    let why = drawing.give_name(&given("BORE=handle:99")).unwrap_err();
    assert!(why.contains("no curve has this handle") && why.contains("2F"), "{why}");
}

#[test]
fn the_region_at_a_place_is_named_whatever_the_file_says() {
    let mut drawing = plate();
    drawing.give_name(&given("STEEL=in:5,2.5")).unwrap();
    drawing.give_name(&given("CORE=in:5,2.5")).unwrap();
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    let names: Vec<&str> = domain.regions().iter().map(|region| domain.name(region.name)).collect();
    assert_eq!(names, ["CORE"], "the last that is said");
}

#[test]
fn outlines_and_entities_have_names_of_their_own() {
    let mut drawing = plate();
    drawing.curves.push(DrawnCurve::new(
        Curve::line(p(20.0, 0.0), p(30.0, 0.0)).unwrap(),
        drawing.curves[0].name,
        "open",
    ));
    drawing.name_each(Naming::Outline);
    assert_eq!(boundaries(&drawing), ["EDGE-1", "EDGE-1", "EDGE-1", "EDGE-1", "HOLES-1", "HOLES-2", "EDGE"]);
    let mut drawing = plate();
    drawing.name_each(Naming::Entity);
    assert_eq!(boundaries(&drawing)[..2], ["EDGE-2F", "EDGE-30"]);
}

#[test]
fn what_is_no_name_is_refused() {
    for wrong in ["LOAD", "=1,2", "A=1", "A=in:1", "A=handle:XY", "A=1,nan"] {
        assert!(wrong.parse::<NameBy>().is_err(), "{wrong}");
    }
    for right in ["a=b=1.5,-2", "CORE=in:0,0", "LOAD=handle:2F"] {
        assert_eq!(given(right).to_string(), right);
    }
}
