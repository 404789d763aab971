//! One suite of laws for every kind of curve, at every size and offset.

use kurbo::{Point, Vec2};
use squinch::curve::Curve;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

#[test]
fn smoke() {
    let s = std::f64::consts::FRAC_1_SQRT_2;
    let nurbs = Curve::nurbs(
        2,
        &[0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.],
        &[p(1., 0.), p(1., 1.), p(0., 1.), p(-1., 1.), p(-1., 0.), p(-1., -1.), p(0., -1.), p(1., -1.), p(1., 0.)],
        Some(&[1., s, 1., s, 1., s, 1., s, 1.]),
    )
    .unwrap();
    for i in 0..100 {
        let q = nurbs.point(f64::from(i) / 99.0);
        assert!((q.to_vec2().hypot() - 1.0).abs() < 4e-16);
    }
    assert!((nurbs.green(Point::ZERO) - std::f64::consts::PI).abs() < 1e-14, "{}", nurbs.green(Point::ZERO));
    let e = Curve::ellipse(p(0., 0.), Vec2::new(2., 0.), Vec2::new(0., 1.), 0.0, 6.0).unwrap();
    let (t, d) = e.nearest(p(0.1, 0.9), 0.0, 1.0);
    println!("{t} {d}");
    let q = Curve::natural_spline(&[p(0., 0.), p(1., 1.), p(2., 0.), p(3., 1.)]).unwrap();
    println!("{:?} {:?}", q.bounds(), q.nearest(p(1.5, 1.0), 0.0, 1.0));
    let part = q.part(0.2, 0.7);
    assert_eq!(part.start(), q.point(0.2));
    println!("{:?}", (part.point(0.5), q.point(0.45)));
    println!("{:?}", Curve::arc_through(p(0., 0.), p(1., 1e-9), p(2., 0.)).unwrap().point(0.5));
}
