//! Transforms, viewports, units and the page.

use super::*;

#[test]
fn a_circle_stays_an_arc_under_similarities_only() {
    let drawing = svg(r#"<g transform="translate(50,50) rotate(30) scale(-2,2)"><circle r="3"/></g>
        <circle transform="skewX(30)" r="3"/><circle transform="matrix(2 0 0 3 0 0)" r="3"/>"#);
    assert_eq!(kinds(&drawing), ["arc", "ellipse", "ellipse"]);
    let found: Vec<f64> = areas(&drawing).iter().map(|a| a.abs()).collect();
    near_all(&found, &[36.0 * PI, 9.0 * PI, 54.0 * PI]);
}

#[test]
fn transforms_nest_and_a_quarter_turn_is_exact() {
    let drawing =
        svg(r#"<g transform="translate(10 20)"><rect transform="rotate(90, 5 5),scale(2)" width="4" height="1"/></g>"#);
    let bounds = drawing.bounds().unwrap();
    // In the group's units the rectangle is 8 × 2, turned about (5, 5): x 8..10, y 0..8.
    assert_eq!((bounds.x0, bounds.x1, bounds.y0, bounds.y1), (18.0, 20.0, 72.0, 80.0));
    let css = svg(r#"<rect style="transform: translate(10px, 20px) rotate(90deg)" width="4" height="1"/>"#);
    let bounds = css.bounds().unwrap();
    assert_eq!((bounds.x0, bounds.x1, bounds.y0, bounds.y1), (9.0, 10.0, 76.0, 80.0));
    let unread = svg(r#"<rect transform="turn(3)" width="4" height="1"/>"#);
    assert_eq!(unread.notes, ["rect (line 2): the transform 'turn(3)' cannot be read."]);
    let gone = svg(r#"<g transform="scale(1 0)"><rect width="4" height="1"/></g>"#);
    assert_eq!(left_out(&gone), ["1 g: its transform leaves no extent"]);
}

#[test]
fn a_nested_viewport_fits_its_view_box() {
    let inner = |attributes: &str| {
        let drawing = svg(&format!(
            r#"<svg x="10" y="20" width="40" height="20" viewBox="5 5 10 10" {attributes}><rect x="5" y="5" width="10" height="10"/></svg>"#
        ));
        let b = drawing.bounds().unwrap();
        [b.x0, 100.0 - b.y1, b.width(), b.height()]
    };
    assert_eq!(inner(""), [20.0, 20.0, 20.0, 20.0]);
    assert_eq!(inner(r#"preserveAspectRatio="xMinYMid""#), [10.0, 20.0, 20.0, 20.0]);
    assert_eq!(inner(r#"preserveAspectRatio="xMaxYMax meet""#), [30.0, 20.0, 20.0, 20.0]);
    assert_eq!(inner(r#"preserveAspectRatio="xMidYMax slice""#), [10.0, 0.0, 40.0, 40.0]);
    assert_eq!(inner(r#"preserveAspectRatio="none""#), [10.0, 20.0, 40.0, 20.0]);
    let empty = svg(
        r#"<svg width="0"><rect width="1" height="1"/></svg><svg viewBox="0 0 0 1"><rect width="1" height="1"/></svg>"#,
    );
    assert_eq!(left_out(&empty), ["2 svg: its viewport has no extent"]);
}

#[test]
fn transforms_turn_about_their_origin() {
    // The box around the drawing, as seen: from the upper left corner, y downward.
    let seen = |inside: &str| {
        let b = svg(inside).bounds().unwrap();
        [b.x0, 100.0 - b.y1, b.x1, 100.0 - b.y0]
    };
    let rect = |attributes: &str| seen(&format!(r#"<rect x="10" y="20" width="40" height="20" {attributes}/>"#));
    near_all(&rect(r#"transform="rotate(90)" transform-origin="10 20""#), &[-10.0, 20.0, 10.0, 60.0]);
    near_all(&rect(r#"style="transform: scale(.5); transform-origin: 10px 20px""#), &[10.0, 20.0, 30.0, 30.0]);
    near_all(&rect(r#"style="transform: scale(2); transform-origin: right bottom""#), &[-80.0, -60.0, 0.0, -20.0]);
    near_all(
        &rect(r#"style="transform: scale(2); transform-box: fill-box; transform-origin: 50% 50%""#),
        &[-10.0, 10.0, 70.0, 50.0],
    );
    near_all(&rect(r#"style="translate: 5px 10%; scale: 2""#), &[25.0, 50.0, 105.0, 90.0]);
    near_all(&rect(r#"style="rotate: 90deg; transform-origin: 10px 20px""#), &[-10.0, 20.0, 10.0, 60.0]);
    near_all(&rect(r#"style="rotate: .5turn; transform: translateX(1in)""#), &[-146.0, -40.0, -106.0, -20.0]);
    let turned = rect(r#"style="transform: rotate(100grad)""#);
    near_all(&turned, &rect(r#"transform="rotate(90)""#));
    near_all(&turned, &rect(r#"style="transform: rotate(1.5707963267948966rad)""#));
    near_all(&rect(r#"style="transform: translate(10%, -5%) scaleY(2)""#), &[20.0, 35.0, 60.0, 75.0]);
    near_all(&rect(r#"style="transform: skew(45deg)""#), &[30.0, 20.0, 90.0, 40.0]);
    // A group turns about the middle of all that is in it.
    let group = r#"<g style="transform: scale(2); transform-box: fill-box; transform-origin: center"><rect width="4" height="2"/><g
        transform="translate(6 0)"><rect width="4" height="2"/></g></g>"#;
    near_all(&seen(group), &[-5.0, -1.0, 15.0, 3.0]);
}

#[test]
fn geometry_comes_from_style_sheets_too() {
    let drawing =
        svg(r#"<style>circle { r: 3px; cx: 10% } rect { width: 4Q; height: 1mm; rx: 0 } ellipse { rx: 2px; ry: 2px }
        path { d: path("M0 0H7V7H0Z") }</style><circle r="1"/><rect rx="1"/><ellipse/><path/>"#);
    let found: Vec<f64> = areas(&drawing).into_iter().map(f64::abs).collect();
    near_all(&found, &[9.0 * PI, (96.0_f64 / 25.4).powi(2), 4.0 * PI, 49.0]);
    let Curve::Arc(arc) = &drawing.curves[0].curve else { panic!() };
    near(arc.center.x, 10.0);
}

#[test]
fn lengths_have_units_and_shares() {
    let drawing = svg(r#"<rect x="10%" y="50%" width="1in" height="12pt"/><circle cx="2em" cy="1pc" r="50%"/>
        <rect width="10mm" height="1cm"/>"#);
    let boxes: Vec<_> = [0, 4, 5].map(|k| drawing.curves[k].curve.bounds()).into();
    assert_eq!((boxes[0].x0, boxes[0].x1, boxes[0].y0), (10.0, 106.0, 50.0));
    let Curve::Arc(arc) = &drawing.curves[4].curve else { panic!() };
    near(arc.radius, 50.0);
    assert_eq!(arc.center, Point::new(32.0, 84.0));
    near(boxes[2].x1, 960.0 / 25.4);
}

fn unit_of(attributes: &str, dpi: f64) -> (String, f64) {
    let text = format!("<svg {attributes}><rect y='1' width='1' height='1'/></svg>");
    let drawing = attempt(&text, SvgOptions { dpi, ..SvgOptions::default() }).unwrap();
    let (unit, _) = drawing.unit.clone().unwrap();
    let metres = squinch::geometry::metres(&unit).unwrap_or_else(|| panic!("{unit}"));
    (unit, metres)
}

#[test]
fn a_user_unit_is_what_width_height_and_view_box_make_it() {
    let (unit, _) = unit_of("width='210mm' height='297mm' viewBox='0 0 210 297'", 96.0);
    assert_eq!(unit, "mm");
    let (unit, metres) = unit_of("width='10cm' viewBox='0 0 250 250'", 96.0);
    assert_eq!(unit, "0.04 cm");
    near(metres, 0.0004);
    assert_eq!(unit_of("width='2in' height='1in' viewBox='0 0 2 2'", 96.0).0, "0.5 in"); // the smaller fits
    assert_eq!(
        unit_of("width='2in' height='1in' viewBox='0 0 2 2' preserveAspectRatio='xMidYMid slice'", 96.0).0,
        "in"
    );
    assert_eq!(unit_of("width='72pt' viewBox='0 0 72 72'", 96.0).0, "pt");
    for plain in ["", "width='10' height='10'", "width='100%' viewBox='0 0 9 9'", "width='9px' viewBox='0 0 9 9'"] {
        let (unit, metres) = unit_of(plain, 96.0);
        assert_eq!(unit, "px");
        near(metres, 0.0254 / 96.0);
        near(unit_of(plain, 72.0).1, 0.0254 / 72.0);
    }
    near(unit_of("width='210mm' viewBox='0 0 210 297'", 72.0).1, 0.001);
}

#[test]
fn up_is_the_mirror_image_in_the_view_box() {
    let lower = |attributes: &str| {
        let drawing = file(&format!("<svg {attributes}><rect y='1' width='1' height='1'/></svg>"));
        drawing.bounds().unwrap().y0
    };
    assert_eq!(lower("viewBox='0 0 10 20'"), 18.0);
    assert_eq!(lower("viewBox='-5 -10 10 20'"), -2.0);
    assert_eq!(lower("viewBox='0 5 10 20'"), 28.0);
    assert_eq!(lower("height='40'"), 38.0);
    assert_eq!(lower("height='1in'"), 94.0);
    assert_eq!(lower("height='50%'"), -2.0);
    assert_eq!(lower(""), -2.0);
}
