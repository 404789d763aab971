//! Drawings that cross, nearly touch, nearly coincide, and lie at awkward scales and places: their areas come out as
//! the formulas say.

use squinch::domain::{ArrangeOptions, Domain, Drawing};
use squinch::generate::known::{self, Known, Near};
use squinch::geometry::Vec2;
use squinch::run::request::Request;
use squinch::run::{Exit, Extent, run_drawing};
use squinch::watch::no_clock;

fn arranged(drawing: &Drawing) -> Domain {
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(domain.flaws(), [""; 0]);
    domain
}

/// The area within its slack, or within what the itemised repairs may change: the tolerance along the border.
fn is_right(known: &Known, what: &str) {
    let domain = arranged(&known.drawing);
    let error = (domain.area() - known.area).abs();
    let healed = if domain.repairs().is_empty() { 0.0 } else { 2.0 * domain.tolerance() * known.perimeter };
    assert!(error <= (known.slack() * known.area).max(healed), "{what}: {} instead of {}", domain.area(), known.area);
}

/// One of each family, small.
fn families() -> Vec<(&'static str, Known)> {
    vec![
        ("circles", known::crossing_circles(3, 12)),
        ("holes", known::plate_with_holes(5, 4)),
        ("rings", known::rings(7, 8)),
        ("spiral", known::spiral(9, 0.7)),
        ("section", known::section(300)),
    ]
}

#[test]
fn areas_are_right_at_every_scale_and_place() {
    for (name, known) in families() {
        is_right(&known, name);
        for factor in [2f64.powi(40), 2f64.powi(-40), 1e6, 1e-6] {
            is_right(&known.clone().scaled(factor), &format!("{name} × {factor:e}"));
        }
        is_right(&known.moved(Vec2::new(1e7, -1e7)), &format!("{name} at 1e7"));
    }
}

#[test]
fn shapes_that_nearly_touch_or_coincide_have_their_area() {
    for near in Near::ALL {
        for exponent in 3..=12 {
            let separation = 10f64.powi(-exponent);
            for sign in [1.0, -1.0] {
                let turn_rad = 0.3 * f64::from(exponent);
                is_right(
                    &known::nearly(near, sign * separation, turn_rad),
                    &format!("{near:?} {:e}", sign * separation),
                );
            }
        }
    }
}

#[test]
fn lenses_between_arcs_have_their_area_far_from_the_origin() {
    for turn in 0..12 {
        for separation in [1e-5, 1e-6, -1e-6] {
            let known = known::nearly(Near::Arcs, separation, 0.7 * f64::from(turn)).moved(Vec2::new(1e7, -1e7));
            is_right(&known, &format!("{separation:e} turned by {turn}"));
        }
    }
}

#[test]
fn powers_of_two_change_no_bit_of_a_mesh() {
    let request = Request { max_vertices: 20_000, ..Request::default() };
    for (name, known) in families() {
        let run = |known: &Known| run_drawing(&known.drawing, &request, Extent::Whole(&mut |_| true), &no_clock);
        let plain = run(&known);
        assert_eq!(plain.exit, Exit::Done, "{name}: {:?}", plain.report.failure);
        let factor = 2f64.powi(-40);
        let small = run(&known.clone().scaled(factor));
        let [plain, small] = [plain, small].map(|outcome| outcome.mesh.expect("a run that is done has a mesh"));
        assert_eq!(plain.triangles, small.triangles, "{name}");
        let moved = plain.nodes.iter().map(|p| squinch::geometry::scaled(*p, factor));
        assert!(moved.eq(small.nodes.iter().copied()), "{name}");
    }
}
