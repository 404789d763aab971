//! Shapes of a picture: the topmost names a face, and what later ones cover leaves no trace.

use super::*;

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
    // A fan of triangles, the tips of which a disc covers: the disc is split where the ten sides meet it, one of them
    // where it begins.
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
