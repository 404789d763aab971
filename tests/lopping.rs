//! The corner-lopping engine, held to its guarantees by the verifier.

mod plane_drawings;

use plane_drawings::{assert_kept, boxed, domain_of, drawing_of, status, wedge};
use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Domain, Drawing, FillRule};
use squinch::generate::curved_complex;
use squinch::geometry::Point;
use squinch::ids::PointId;
use squinch::mesh::{BallReason, Mesh, quality};
use squinch::plane::Midpoint;
use squinch::plane::gcdr::{self, Steiner};
use squinch::plane::lopping::{self, Options, Refined, Rules, Shrinking};
use squinch::promise::{arc_turning, guaranteed_angle};
use squinch::refine::{StopReason, Until};
use squinch::run::request::{Engine, Request};
use squinch::run::{self, Exit, Extent, Outcome, Source};
use squinch::size::Sizing;
use squinch::size::estimate::{Asked, Circles, Demand};
use squinch::size::{Limits, SizeOf};
use squinch::verify::{Status, Verdict, verify};
use squinch::watch::{Progress, no_clock};
use std::f64::consts::FRAC_PI_3;

fn refine(domain: &Domain, options: &Options) -> Refined {
    lopping::refine(domain, options, Until::End, &mut |_| true).expect("a domain that coordinates can hold")
}

/// Refines and verifies; every check must hold.
fn kept(drawing: &Drawing, tau_rad: f64, options: &Options) -> (Mesh, Verdict) {
    let domain = domain_of(drawing, tau_rad);
    let refined = refine(&domain, options);
    assert_eq!(refined.stop.reason, StopReason::Done);
    let mesh = refined.mesh.expect("a run that is done has a mesh");
    let verdict = verify(Some(&domain), &mesh, &options.promise(false));
    assert_kept(&verdict);
    (mesh, verdict)
}

fn largest_angle_deg(mesh: &Mesh) -> f64 {
    let angles = mesh.triangles.ids().map(|t| quality::angle_range(mesh.corners(t)).1);
    angles.fold(0.0, f64::max).to_degrees()
}

#[test]
fn random_complexes_keep_the_angle_that_is_proven() {
    for tau in [0.1, 0.5, FRAC_PI_3] {
        let kappa = guaranteed_angle(tau) * (1.0 - 1e-9);
        for arcs in [None, Some(arc_turning(kappa, tau))] {
            let options = Options { angle_min_rad: kappa, corner_arcs: arcs, ..Options::default() };
            // 156 and 187: circles that touch from inside, drawn a few roundings deep in each other.
            for seed in (0..12).chain([156, 187]) {
                let (_, verdict) = kept(&curved_complex(seed), tau, &options);
                assert_eq!(status(&verdict, "min_angle"), Status::Proven, "seed {seed}, τ {tau}, arcs {arcs:?}");
            }
        }
    }
}

#[test]
fn random_complexes_reach_thirty_degrees() {
    for angle_deg in [20.7f64, 25.0, 30.0] {
        for arcs in [None, Some(FRAC_PI_3)] {
            let options = Options { angle_min_rad: angle_deg.to_radians(), corner_arcs: arcs, ..Options::default() };
            for seed in 100..112 {
                let (_, verdict) = kept(&curved_complex(seed), 0.5, &options);
                assert_eq!(status(&verdict, "min_angle"), Status::Reached, "seed {seed}");
            }
        }
    }
}

#[test]
fn every_midpoint_rule_beta_and_shrinking_holds_its_guarantee() {
    for midpoint in [Midpoint::Bisector, Midpoint::Angle] {
        for ball_shrinking in [Shrinking::Batched, Shrinking::Literal] {
            for beta in [0.5, 0.8, 0.95] {
                for corner_arcs in [None, Some(FRAC_PI_3)] {
                    let options =
                        Options { rules: Rules { midpoint, ball_shrinking, beta }, corner_arcs, ..Options::default() };
                    for seed in 200..204 {
                        kept(&curved_complex(seed), 0.5, &options);
                    }
                }
            }
        }
    }
}

/// A corner with a line close by, so that its ball has to shrink.
fn crowded_corner() -> Drawing {
    let mut curves = boxed(2.0);
    curves.extend([(0.0, 0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.3, 0.0), (-0.2, -0.9, -0.2, 0.9, 0.0)]);
    drawing_of(&curves)
}

#[test]
fn literal_shrinking_leaves_a_shell_a_step_and_batched_one() {
    let rules = |ball_shrinking| Rules { ball_shrinking, ..Rules::default() };
    let with = |shrinking| Options { rules: rules(shrinking), corner_arcs: None, ..Options::default() };
    let (literal, _) = kept(&crowded_corner(), 0.5, &with(Shrinking::Literal));
    let (batched, _) = kept(&crowded_corner(), 0.5, &with(Shrinking::Batched));
    assert!(batched.balls.iter().any(|b| b.why == BallReason::Encroached), "{:?}", batched.balls);
    assert!(literal.nodes.len() > batched.nodes.len(), "{} and {}", literal.nodes.len(), batched.nodes.len());
}

#[test]
fn a_zero_angle_costs_vertices_but_ends() {
    // Two circles of radius 1 and ½ that touch from inside: two curves at (1, 0) with one tangent.
    let mut drawing = Drawing { fill: FillRule::Regions, ..Drawing::default() };
    let touch = Point::new(1.0, 0.0);
    for (x, r) in [(0.0, 1.0), (0.5, 0.5)] {
        let circle = Curve::circle(Point::new(x, 0.0), r).expect("a circle").with_ends(touch, touch);
        drawing.add(circle, "circle", "circle");
    }
    for corner_arcs in [None, Some(FRAC_PI_3)] {
        let (mesh, verdict) = kept(&drawing, 0.5, &Options { corner_arcs, ..Options::default() });
        assert!((50..400).contains(&mesh.nodes.len()), "{} nodes", mesh.nodes.len());
        assert!(!verdict.exempt.is_empty());
    }
}

#[test]
fn corner_arcs_keep_large_angles_away() {
    let options = |corner_arcs| Options { corner_arcs, ..Options::default() };
    let (without, _) = kept(&wedge(0.1, [1.0, 1.0]), 0.5, &options(None));
    let (with, verdict) = kept(&wedge(0.1, [1.0, 1.0]), 0.5, &options(Some(FRAC_PI_3)));
    assert_eq!(status(&verdict, "max_angle"), Status::Reached);
    assert!(largest_angle_deg(&without) > 170.0 && largest_angle_deg(&with) <= 180.0 - 2.0 * 20.7);
}

#[test]
fn two_points_are_enough_of_a_beginning() {
    // A lens, a D and a disk: all points of P on one line.
    let lens = drawing_of(&[(0.0, 0.0, 1.0, 0.0, 0.1), (1.0, 0.0, 0.0, 0.0, 0.1)]);
    let half_disk = drawing_of(&[(0.0, 0.0, 1.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0)]);
    let disk = drawing_of(&[(0.0, 0.0, 1.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0, 1.0)]);
    for drawing in [lens, half_disk, disk] {
        kept(&drawing, FRAC_PI_3, &Options { angle_min_rad: 0.03, ..Options::default() });
        kept(&drawing, FRAC_PI_3, &Options::default());
    }
}

#[test]
fn powers_of_two_change_nothing_but_the_scale() {
    for seed in 0..6 {
        let domain = domain_of(&curved_complex(seed), 0.5);
        let mesh = refine(&domain, &Options::default()).mesh.expect("a mesh");
        for factor in [2f64.powi(40), 2f64.powi(-40), 2f64.powi(300)] {
            let scaled = refine(&domain.scaled(factor), &Options::default()).mesh.expect("a mesh");
            assert!(scaled == mesh.clone().scaled(factor), "seed {seed}, factor {factor}");
        }
    }
}

#[test]
fn a_turned_and_mirrored_drawing_holds_its_guarantee() {
    let drawing = curved_complex(5);
    for map in [kurbo::Affine::rotate(0.7), kurbo::Affine::FLIP_Y, kurbo::Affine::translate((1e6, -1e6))] {
        let mut image = drawing.clone();
        for drawn in &mut image.curves {
            drawn.curve = drawn.curve.transformed(map);
        }
        image.points.iter_mut().for_each(|p| p.at = map * p.at);
        kept(&image, 0.5, &Options::default());
    }
}

#[test]
fn sizes_are_obeyed_and_cap_the_balls() {
    let sizings = [
        Sizing { max_edge: Some(0.05), ..Sizing::default() },
        Sizing { max_area: Some(0.002), ..Sizing::default() },
        Sizing { edge_turning_rad: Some(0.05), ..Sizing::default() },
        Sizing { chord_error: Some(1e-4), ..Sizing::default() },
    ];
    let mut curves = boxed(2.0);
    curves.extend([(0.0, 0.0, 1.0, 0.0, 0.3), (0.0, 0.0, 1.0, 0.5, 0.3)]);
    for sizing in sizings {
        let options = Options { sizing: sizing.clone(), ..Options::default() };
        let (mesh, _) = kept(&drawing_of(&curves), 0.5, &options);
        assert!(mesh.balls.iter().any(|b| b.why == BallReason::Size), "{sizing:?}: {:?}", mesh.balls);
    }
}

#[test]
fn a_budget_ends_with_a_valid_mesh_and_says_what_is_unresolved() {
    let options = Options {
        sizing: Sizing { max_area: Some(1e-5), ..Sizing::default() },
        max_vertices: 500,
        ..Options::default()
    };
    let domain = domain_of(&wedge(10.0, [1.0, 1.0]), 0.5);
    let refined = refine(&domain, &options);
    assert_eq!(refined.stop.reason, StopReason::VertexBudget);
    assert!(refined.stop.unresolved > 0 && !refined.stop.places.is_empty());
    let verdict = verify(Some(&domain), &refined.mesh.expect("it was valid before"), &options.promise(false));
    let broken: Vec<_> = verdict.checks.iter().filter(|c| c.status == Status::Broken).map(|c| c.name).collect();
    assert!(broken.iter().all(|name| ["size", "min_angle", "max_angle"].contains(name)), "{broken:?}");
}

#[test]
fn a_budget_too_small_for_the_curves_has_places_but_no_mesh() {
    let options = Options { max_vertices: 40, ..Options::default() };
    let mut curves = boxed(2.0);
    curves.extend([(-1.0, 0.0, 1.0, 0.0, 0.0), (-0.9, 1e-3, 0.9, 1e-3, 0.0)]);
    let refined = refine(&domain_of(&drawing_of(&curves), 0.5), &options);
    assert_eq!(refined.stop.reason, StopReason::VertexBudget);
    assert!(refined.mesh.is_none() && refined.stop.unresolved > 0 && !refined.stop.places.is_empty());
}

#[test]
fn a_watcher_can_stop_the_run() {
    let options = Options { sizing: Sizing { max_area: Some(1e-5), ..Sizing::default() }, ..Options::default() };
    let mut told = 0;
    let mut watch = |progress: &Progress| {
        told += 1;
        progress.phase == "conforming"
    };
    let refined = lopping::refine(&domain_of(&wedge(10.0, [1.0, 1.0]), 0.5), &options, Until::End, &mut watch)
        .expect("no arithmetic limit");
    assert_eq!(refined.stop.reason, StopReason::Cancelled);
    assert!(told == 1 && refined.mesh.is_some() && refined.stop.unresolved > 0);
}

#[test]
fn features_nearer_than_the_arithmetic_are_an_error_with_a_place() {
    // Nanometres apart, kilometres away: 1e-9 at 1e6 is less than a hundred units in the last place.
    let far = 1e6;
    let mut drawing = drawing_of(&[]);
    let corner = [(0.0, 0.0), (1.0, 0.0), (1.0, 1e-9), (0.0, 1e-9)].map(|(x, y)| Point::new(far + x, far + y));
    for i in 0..4 {
        let side = Curve::line(corner[i], corner[(i + 1) % 4]).expect("a line");
        drawing.add(side, "edge", format!("side {i}"));
    }
    let exact = ArrangeOptions { tolerance: Some(0.0), ..ArrangeOptions::default() };
    let domain = match drawing.arrange(&exact) {
        Ok(domain) => domain.split_to_turning(0.5),
        Err(error) => return assert!(!error.help.is_empty() && (error.at.x - far).abs() < 2.0, "{error:?}"),
    };
    let ended = lopping::refine(&domain, &Options::default(), Until::End, &mut |_| true);
    let error = ended.expect_err("such a strip needs 1e9 triangles of less than the resolution");
    assert!(!error.help.is_empty() && (error.at.x - far).abs() < 2.0, "{error:?}");
}

#[test]
fn balls_answer_to_acute_corners_only() {
    let mesh = kept(&wedge(45.0, [1.0, 1.0]), 0.5, &Options::default()).0;
    let corners: Vec<PointId> = mesh.balls.iter().map(|b| b.corner).collect();
    assert_eq!(corners.len(), 1, "{corners:?}");
}

fn asked(options: &Options, circles: Circles) -> Asked<'_> {
    Asked {
        angle_min_rad: options.angle_min_rad,
        sizing: &options.sizing,
        circles,
        corner_arcs: options.corner_arcs.is_some(),
        bisected: options.rules.midpoint == Midpoint::Bisector,
    }
}

/// What is told before a run, and what the run takes.
fn told_and_taken(drawing: &Drawing, options: &Options) -> (f64, f64) {
    let domain = domain_of(drawing, 0.5);
    let told = Demand::of(&domain, asked(options, Circles::Empty), &mut |_| true).expect("nobody says stop").vertices();
    (told, refine(&domain, options).mesh.expect("a mesh").nodes.len() as f64)
}

#[test]
fn slivers_take_at_least_what_is_told() {
    let strip = |gap: f64| {
        let mut curves = boxed(2.0);
        curves.extend([(-1.0, 0.0, 1.0, 0.0, 0.3), (-0.9, gap, 0.9, gap, 0.3)]);
        drawing_of(&curves)
    };
    let ring = |gap: f64| {
        let (r, s) = (1.0, 1.0 + gap);
        drawing_of(&[(-r, 0.0, r, 0.0, 1.0), (r, 0.0, -r, 0.0, 1.0), (-s, 0.0, s, 0.0, 1.0), (s, 0.0, -s, 0.0, 1.0)])
    };
    for drawing in [wedge(0.1, [1.0, 1.0]), wedge(0.01, [1.0, 1.0]), ring(1e-3), ring(1e-4), strip(1e-3), strip(1e-4)] {
        for min_edge in [None, Some(1e-2)] {
            let options = Options { sizing: Sizing { min_edge, ..Sizing::default() }, ..Options::default() };
            let (told, taken) = told_and_taken(&drawing, &options);
            assert!(told <= taken, "{told} told, {taken} taken");
            assert!(min_edge.is_some() || taken <= 40.0 * told, "{told} told, {taken} taken");
        }
    }
}

#[test]
fn sizes_take_at_least_what_is_told() {
    let mut curves = boxed(2.0);
    curves.extend([(0.0, 0.0, 1.0, 0.0, 0.3), (0.0, 0.0, 1.0, 0.5, 0.3)]);
    for sizing in [
        Sizing { max_edge: Some(0.02), ..Sizing::default() },
        Sizing { max_area: Some(0.001), ..Sizing::default() },
        Sizing { edge_turning_rad: Some(0.001), ..Sizing::default() },
        Sizing { chord_error: Some(1e-8), ..Sizing::default() },
    ] {
        let options = Options { sizing, ..Options::default() };
        let (told, taken) = told_and_taken(&drawing_of(&curves), &options);
        assert!(told <= taken && taken <= 12.0 * told, "{told} told, {taken} taken: {:?}", options.sizing);
    }
}

#[test]
fn the_complexes_of_the_bench_take_at_least_what_is_told() {
    for seed in 0..24 {
        let (told, taken) = told_and_taken(&curved_complex(seed), &Options::default());
        assert!(told <= taken, "seed {seed}: {told} told, {taken} taken");
    }
}

/// A rectangle from the origin.
fn strip(length: f64, width: f64) -> Drawing {
    let (l, w) = (length, width);
    drawing_of(&[(0.0, 0.0, l, 0.0, 0.0), (l, 0.0, l, w, 0.0), (l, w, 0.0, w, 0.0), (0.0, w, 0.0, 0.0, 0.0)])
}

/// What is told of slivers before a run that keeps diametral circles empty, or not.
fn told(drawing: &Drawing, circles: Circles) -> f64 {
    let demand = Demand::of(&domain_of(drawing, 0.5), asked(&Options::default(), circles), &mut |_| true);
    demand.expect("nobody says stop").vertices()
}

#[test]
fn each_kind_of_sliver_is_told_to_within_a_few_times() {
    let needle = |w: f64| drawing_of(&[(0.0, 0.0, 1.0, 0.0, 0.0), (1.0, 0.0, 1.0, w, 0.0), (1.0, w, 0.0, 0.0, 0.0)]);
    let spindle = |w: f64| drawing_of(&[(0.0, 0.0, 1.0, 0.0, 0.0), (1.0, 0.0, 0.5, w, 0.0), (0.5, w, 0.0, 0.0, 0.0)]);
    let ring = |w: f64| {
        let half = |r: f64| [(-r, 0.0, r, 0.0, 1.0), (r, 0.0, -r, 0.0, 1.0)];
        drawing_of(&[half(1.0), half(1.0 - w)].concat())
    };
    let free_ends = |w: f64| {
        let mut curves = boxed(2.0);
        curves.extend([(0.0, 0.0, 1.0, 0.0, 0.0), (0.0, w, 1.0, w, 0.0)]);
        drawing_of(&curves)
    };
    // Along polylines it is sure in parts what lies beside them.
    let polylines = |w: f64| {
        let sides = (0..10).flat_map(|i| {
            let x = f64::from(i) / 10.0;
            [(x, 0.0, x + 0.1, 0.0, 0.0), (x + 0.05, w, x + 0.15, w, 0.0)]
        });
        drawing_of(&boxed(2.0).into_iter().chain(sides).collect::<Vec<_>>())
    };
    for width in [1e-4, 5e-5] {
        for (name, drawing, most) in [
            ("strip", strip(1.0, width), 1.01),
            ("needle", needle(width), 4.0),
            ("spindle", spindle(width), 4.0),
            ("ring", ring(width), 5.0),
            ("free ends", free_ends(width), 5.0),
            ("polylines", polylines(width), 8.0),
        ] {
            let (told, taken) = told_and_taken(&drawing, &Options::default());
            assert!(told <= taken && taken <= most * told, "{name} {width}: {told} told, {taken} taken");
        }
        let constrained = told(&needle(width), Circles::Any);
        assert!(constrained == 0.0, "shells cross a needle in a few steps, not in {constrained}");
    }
    // Pieces are halves of halves: 2²⁰ fit into a strip of 2e-7, half as thin takes twice as many.
    for (width, most) in [(1e-6, 1.1e6), (2e-7, 4.2e6)] {
        let told = told(&strip(1.0, width), Circles::Empty);
        assert!(told < most && told > 0.4 * most, "{width}: {told}");
    }
    assert!(told(&strip(1.0, 1e-7), Circles::Empty) > 5e6);
    assert!(told(&ring(1e-7), Circles::Any) > 5e6);
}

fn run(drawing: &str, request: &Request) -> Outcome {
    let source = Source { path: "a.json", bytes: drawing.as_bytes(), format: None, nodes: None, of_many: false };
    run::run(&source, request, Extent::Whole(&mut |_| true), &no_clock)
}

#[test]
fn a_strip_too_thin_is_refused_with_an_angle_that_ends() {
    let drawing = r#"{"squinch": 1, "curves": [{"polygon": [[0, 0], [1, 0], [1, 1e-5], [0, 1e-5]]}]}"#;
    let few = Request { max_vertices: 50_000, tolerance: Some(0.0), ..Request::default() };
    let refused = run(drawing, &few);
    let failure = refused.report.failure.expect("it takes more than a hundred thousand");
    assert_eq!((refused.exit, refused.mesh.is_some()), (Exit::Missed, false));
    assert_eq!(refused.report.stop.expect("an estimate").reason, StopReason::VertexBudget);
    assert!(failure.at.is_some() && failure.help.contains("--min-angle 3,"), "{}", failure.help);
    assert_eq!(run(drawing, &Request { min_angle: 3.0, ..few }).exit, Exit::Done);
}

/// An L with a bore.
const BRACKET: &str = r#"{"squinch": 1, "curves": [
    {"polygon": [[0, 0], [6, 0], [6, 1], [1, 1], [1, 4], [0, 4]]},
    {"circle": {"center": [0.5, 0.5], "radius": 0.2}}]}"#;

#[test]
fn an_angle_beyond_reach_ends_with_the_mesh_of_one_that_ends() {
    for (engine, steiner) in [
        (Engine::Lop, Steiner::Center),
        (Engine::Gcdr, Steiner::Center),
        (Engine::Gcdr, Steiner::Offcenter),
        (Engine::Gcdr, Steiner::OptimalFree),
    ] {
        let gcdr = || gcdr::Choices { steiner, ..gcdr::Choices::default() };
        let asked = |min_angle: f64| Request { min_angle, engine, gcdr: gcdr(), ..Request::default() };
        let usual = run(BRACKET, &asked(34.0));
        assert_eq!(usual.exit, Exit::Done, "{engine:?} {steiner:?}");
        for angle in [45.0, 59.0] {
            let hopeless = run(BRACKET, &asked(angle));
            assert_eq!(hopeless.exit, Exit::Missed);
            let stop = hopeless.report.stop.expect("it ended");
            assert_eq!((stop.reason, stop.angle_deg), (StopReason::NoProgress, Some(34.0)));
            assert!(stop.unresolved > 0 && !stop.places.is_empty());
            assert!(
                hopeless.report.quality.expect("of a mesh").in_plane().expect("in the plane").min_unexcused_angle_deg
                    >= 34.0
            );
            assert_eq!(hopeless.mesh, usual.mesh, "{engine:?} {steiner:?} {angle}");
        }
    }
    // What ends beyond the usual gives its own mesh.
    let gcdr = gcdr::Choices { steiner: Steiner::OptimalFree, ..gcdr::Choices::default() };
    let more = Request { min_angle: 35.0, engine: Engine::Gcdr, gcdr, ..Request::default() };
    let more = run(BRACKET, &more);
    assert_eq!((more.exit, more.report.stop.expect("it ended").angle_deg), (Exit::Done, None));
}

#[test]
fn a_run_that_gets_nowhere_ends_by_itself() {
    // Beyond what the engine reaches; without a budget it would go on for ever.
    let options = Options { angle_min_rad: 44f64.to_radians(), max_vertices: 1_000_000, ..Options::default() };
    let refined = refine(&domain_of(&drawing_of(&boxed(1.0)), 0.5), &options);
    assert_eq!(refined.stop.reason, StopReason::Done, "four right angles are a mesh of 45°");
    let mut curves = boxed(1.0);
    curves.extend([(-0.3, 0.1, 0.7, 0.2, 0.0), (-0.5, -0.5, 0.4, -0.6, 0.3)]);
    let refined = refine(&domain_of(&drawing_of(&curves), 0.5), &options);
    assert_eq!(refined.stop.reason, StopReason::NoProgress);
    assert!(
        refined.vertices < 200_000 && refined.mesh.is_some() && refined.stop.unresolved > 0,
        "{}",
        refined.vertices
    );
}

#[test]
fn the_size_of_a_region_is_graded_outside_of_it() {
    let drawing = r#"{"squinch": 1, "fill": "regions", "curves": [
        {"name": "rim", "polygon": [[-4, -4], [4, -4], [4, 4], [-4, 4]]},
        {"name": "seam", "polygon": [[-1, -1], [1, -1], [1, 1], [-1, 1]]}],
        "seeds": [{"region": "core", "at": [0, 0]}, {"region": "plate", "at": [3, 3]}]}"#;
    for engine in [Engine::Lop, Engine::Gcdr] {
        let limits = Limits { size_of: vec![SizeOf { name: "core".into(), edge: 0.2 }], ..Limits::default() };
        let sized = Request { limits, engine, ..Request::default() };
        let alone = run(drawing, &sized);
        let graded = run(drawing, &Request { limits: Limits { grade: Some(0.1), ..sized.limits }, ..sized });
        assert_eq!((alone.exit, graded.exit), (Exit::Done, Exit::Done), "{:?}", graded.report.failure);
        let longest_at = |outcome: &Outcome, least: f64, most: f64| {
            let mesh = outcome.mesh.as_ref().expect("a mesh");
            let edges = mesh.triangles.ids().flat_map(|t| {
                let [a, b, c] = mesh.corners(t);
                [(a, b), (b, c), (c, a)]
            });
            let away = |p: Point| p.x.abs().max(p.y.abs()) - 1.0;
            let near = edges.filter(|&(a, b)| (least..most).contains(&away(a.midpoint(b))));
            near.map(|(a, b)| a.distance(b)).fold(0.0, f64::max)
        };
        assert!(longest_at(&graded, -1.0, -0.1) <= 0.2);
        for (least, most) in [(0.0, 0.5), (0.5, 1.0), (1.0, 2.0), (2.0, 3.0)] {
            let longest = longest_at(&graded, least, most);
            // The limit holds at the middle of a triangle, which lies as far away as corners beyond the sides.
            assert!(longest <= 0.2 + 0.1 * (1.42 * most + longest), "{longest} in {least} to {most}");
        }
        let far = |outcome: &Outcome| longest_at(outcome, 1.0, 3.0);
        assert!(far(&graded) > 0.3 && far(&alone) > 1.5 * far(&graded), "{} {}", far(&alone), far(&graded));
    }
}
