//! Drawings on which both planar engines are tested, and how their verdicts are read.

use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Domain, Drawing, FillRule};
use squinch::geometry::Point;
use squinch::verify::{Status, Verdict};

pub fn domain_of(drawing: &Drawing, tau_rad: f64) -> Domain {
    drawing.arrange(&ArrangeOptions::default()).expect("a sound drawing").split_to_turning(tau_rad)
}

/// A drawing of lines and bulged lines (x0, y0, x1, y1, bulge), every bounded face a region.
pub fn drawing_of(curves: &[(f64, f64, f64, f64, f64)]) -> Drawing {
    let mut drawing = Drawing { fill: FillRule::Regions, ..Drawing::default() };
    for (i, &(x0, y0, x1, y1, bulge)) in curves.iter().enumerate() {
        let curve = Curve::bulge(Point::new(x0, y0), Point::new(x1, y1), bulge).expect("a sound curve");
        drawing.add(curve, "edge", format!("curve {i}"));
    }
    drawing
}

pub fn boxed(half: f64) -> Vec<(f64, f64, f64, f64, f64)> {
    let h = half;
    vec![(-h, -h, h, -h, 0.0), (h, -h, h, h, 0.0), (h, h, -h, h, 0.0), (-h, h, -h, -h, 0.0)]
}

/// Two segments at an angle in a box.
pub fn wedge(angle_deg: f64, lengths: [f64; 2]) -> Drawing {
    let (s, c) = angle_deg.to_radians().sin_cos();
    let mut curves = boxed(2.0);
    curves.extend([(0.0, 0.0, lengths[0], 0.0, 0.0), (0.0, 0.0, lengths[1] * c, lengths[1] * s, 0.0)]);
    drawing_of(&curves)
}

pub fn assert_kept(verdict: &Verdict) {
    let broken: Vec<_> = verdict.checks.iter().filter(|c| c.status == Status::Broken).collect();
    assert!(broken.is_empty(), "{broken:#?}");
}

pub fn status(verdict: &Verdict, name: &str) -> Status {
    verdict.checks.iter().find(|c| c.name == name).expect("a check of this name").status
}
