//! Pictures as text: golden SVG files under `tests/pictures/`. `UPDATE_PICTURES=1 cargo test --test pictures` writes
//! them anew, with a PNG of each under the target directory: look at it before committing.

use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Drawing, Repair, RepairKind, Seed, SeedKind};
use squinch::geometry::{Point, Rect};
use squinch::ids::{CurveId, PointId, RegionId, VertexId};
use squinch::mesh::{Ball, BallReason, CurveEdge, CurveLink, Mesh};
use squinch::picture::{Canvas, MeshColour, PictureOptions, picture_of_domain, picture_of_drawing, picture_of_mesh};
use std::path::Path;

fn keep(name: &str, canvas: &Canvas) {
    let svg = canvas.svg().expect("a small picture");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(format!("{name}.svg"));
    if std::env::var_os("UPDATE_PICTURES").is_some() {
        std::fs::write(&path, &svg).expect("written");
        let png = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
        std::fs::write(png, canvas.png(1.0).expect("painted")).expect("written");
    }
    let golden = std::fs::read_to_string(&path).expect("golden file");
    assert!(golden == svg, "{name}.svg has changed: look at it, then UPDATE_PICTURES=1");
}

/// A ring of `around` × `rings` quadrilaterals cut in two, wavy inside, in two regions; scaled and moved.
fn ring(around: u32, rings: u32, scale: f64, offset: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=rings {
        for j in 0..around {
            let (s, turn) = (f64::from(i) / f64::from(rings), f64::from(j) / f64::from(around));
            let wave = if i == 0 || i == rings { 0.0 } else { 0.02 * libm::sin(7.0 * turn * 6.3 + 3.0 * f64::from(i)) };
            let angle = std::f64::consts::TAU * (turn + 0.5 * f64::from(i % 2) / f64::from(around));
            let radius = 0.3 + 0.7 * s * (0.6 + 0.4 * s) + wave;
            let at = Point::new(radius * libm::cos(angle) * 1.5 + offset, radius * libm::sin(angle) + offset);
            mesh.nodes.push(Point::new(at.x * scale, at.y * scale));
        }
    }
    let regions = ["steel", "air & <water>"].map(|name| mesh.names.intern(name));
    for name in regions {
        mesh.regions.push(name);
    }
    let names = ["hole", "interface", "outside"].map(|name| mesh.names.intern(name));
    let node = |i: u32, j: u32| VertexId(i * around + j % around);
    for i in 0..rings {
        for j in 0..around {
            let [a, b, c, d] = [node(i, j), node(i, j + 1), node(i + 1, j + 1), node(i + 1, j)];
            let two = if i % 2 == 0 { [[a, d, b], [b, d, c]] } else { [[a, d, c], [a, c, b]] };
            for t in two {
                mesh.triangles.push(t);
                mesh.triangle_regions.push(RegionId(u32::from(i >= rings / 2)));
            }
        }
    }
    for (k, i) in [0, rings / 2, rings].into_iter().enumerate() {
        for j in 0..around {
            let t = [f64::from(j) / f64::from(around), f64::from(j + 1) / f64::from(around)];
            let link = CurveLink { curve: CurveId(k as u32), t };
            mesh.edges.push(CurveEdge { nodes: [node(i, j), node(i, j + 1)], name: names[k], link: Some(link) });
        }
    }
    mesh.points = vec![(PointId(0), node(rings, 0)), (PointId(1), node(0, around / 2))];
    mesh.balls = vec![
        Ball { corner: PointId(0), radius: 0.2 * scale, why: BallReason::LocalFeatureSize },
        Ball { corner: PointId(1), radius: 0.1 * scale, why: BallReason::Size },
    ];
    mesh
}

#[test]
fn mesh_by_quality_with_balls_and_marks() {
    let marks = vec![(Point::new(0.5, 0.6), "sliver: 0.3°".to_owned())];
    let options = PictureOptions { marks, title: "ring".into(), ..PictureOptions::default() };
    keep("mesh-quality", &picture_of_mesh(&ring(24, 6, 1.0, 0.0), None, MeshColour::Quality, &options));
}

#[test]
fn mesh_by_region_zoomed_far_from_the_origin() {
    // At 1e7 times its size from the origin: the picture must show the mesh, not its rounding.
    let view = Some(Rect::new(1e4 - 1.5e-3, 1e4 - 0.2e-3, 1e4 - 0.2e-3, 1e4 + 1.0e-3));
    let options = PictureOptions { width_px: 600, view, ..PictureOptions::default() };
    keep("mesh-region-zoom", &picture_of_mesh(&ring(24, 6, 1e-3, 1e7), None, MeshColour::Region, &options));
}

#[test]
fn mesh_by_size() {
    let options = PictureOptions { balls: false, ..PictureOptions::default() };
    keep("mesh-size", &picture_of_mesh(&ring(36, 10, 1e7, 0.0), None, MeshColour::Size, &options));
}

/// A rectangle with a round bore, a curve across and a spike: two regions, one of them with a hole, and an acute
/// corner.
fn drawing(scale: f64) -> Drawing {
    let at = |x: f64, y: f64| Point::new(x * scale, y * scale);
    let mut drawing = Drawing::default();
    let corners = [at(0.0, 0.0), at(6.0, 0.0), at(6.0, 3.0), at(0.0, 3.0)];
    for (i, name) in ["floor", "outlet", "lid", "inlet"].into_iter().enumerate() {
        drawing.add(Curve::line(corners[i], corners[(i + 1) % 4]).expect("a line"), name, "outline");
    }
    drawing.add(Curve::circle(at(4.5, 1.4), 0.8 * scale).expect("a circle"), "bore", "bore");
    let across = vec![at(2.5, 0.0), at(4.5, 1.2), at(0.5, 1.8), at(2.0, 3.0)];
    drawing.add(Curve::bezier(across).expect("a cubic"), "a & <b>", "across");
    let closed = [at(0.5, 0.6), at(1.3, 0.5), at(1.4, 1.2), at(0.7, 1.3)];
    drawing.add(Curve::periodic_spline(&closed).expect("a closed spline"), "pocket", "pocket");
    drawing.add(Curve::line(at(6.0, 3.0), at(5.2, 2.6)).expect("a line"), "spike", "spike");
    let hole = Seed { at: at(4.5, 1.4), kind: SeedKind::Hole, entity: "bore".into() };
    drawing.seeds.push(hole);
    for (x, name) in [(0.2, "water"), (5.8, "oil")] {
        let name = drawing.names.intern(name);
        let kind = SeedKind::Region { name, max_area: None };
        drawing.seeds.push(Seed { at: at(x, 0.2), kind, entity: "seed".into() });
    }
    drawing.fill = squinch::domain::FillRule::Regions;
    drawing
}

#[test]
fn drawing_as_found() {
    let options = PictureOptions { width_px: 800, title: "as found".into(), ..PictureOptions::default() };
    keep("drawing", &picture_of_drawing(&drawing(1.0), &options));
}

#[test]
fn domain_with_regions_and_acute_corners_looks_the_same_at_every_scale() {
    let options = PictureOptions { width_px: 800, ..PictureOptions::default() };
    for scale in [1.0, libm::ldexp(1.0, -20), libm::ldexp(1.0, 24)] {
        let domain = drawing(scale).arrange(&ArrangeOptions::default()).expect("a domain");
        keep("domain", &picture_of_domain(&domain, &options));
    }
}

#[test]
fn empty_and_hostile_input_make_pictures() {
    let picture = picture_of_drawing(&Drawing::default(), &PictureOptions::default());
    assert!(picture.svg().expect("text").starts_with("<svg"));
    let mut mesh = ring(5, 2, 1.0, 0.0);
    mesh.nodes[VertexId(3)] = Point::new(f64::NAN, 1.0);
    mesh.nodes[VertexId(4)] = Point::new(1e300, -1e300);
    mesh.triangles[squinch::ids::TriangleId(0)][1] = VertexId(999);
    mesh.balls[0].radius = f64::INFINITY;
    let views = [None, Some(Rect::new(0.0, 0.0, 0.0, 0.0)), Some(Rect::new(0.0, 0.0, 1e-300, 1e300))];
    for (view, width_px) in views.into_iter().zip([0, 300, 1_000_000]) {
        let options = PictureOptions { width_px, view, ..PictureOptions::default() };
        for colour in [MeshColour::Quality, MeshColour::Region, MeshColour::Size] {
            let canvas = picture_of_mesh(&mesh, None, colour, &options);
            assert!(!canvas.svg().expect("text").contains("NaN"));
            assert!(canvas.png(0.1).expect("painted").len() > 100);
        }
    }
}

#[test]
fn a_layer_too_large_for_text_becomes_an_image() {
    let mesh = ring(300, 250, 1.0, 0.0);
    let options = PictureOptions { width_px: 200, ..PictureOptions::default() };
    let svg = picture_of_mesh(&mesh, None, MeshColour::Quality, &options).svg().expect("text");
    assert!(svg.contains("data:image/png;base64,") && svg.len() < 1_000_000, "{} bytes", svg.len());
}

#[test]
fn every_kind_of_repair_has_a_marker_and_a_crowd_has_one_with_its_number() {
    let kinds = [
        RepairKind::ToleranceRaised,
        RepairKind::Weld,
        RepairKind::GapClosed,
        RepairKind::Split,
        RepairKind::SelfSplit,
        RepairKind::Corner,
        RepairKind::Duplicate,
        RepairKind::Overlap,
        RepairKind::ZeroLength,
        RepairKind::Collapsed,
        RepairKind::Seed,
    ];
    let repair = |kind, x: f64, y: f64| Repair { kind, at: [x, y], size: 0.0, what: String::new() };
    let row = |y: f64| (0..).map(f64::from).zip(kinds).map(move |(x, kind)| repair(kind, 0.4 + 0.5 * x, y)).collect();
    let mut repairs: Vec<Repair> = row(0.3);
    repairs.extend((0..20_000).map(|k| repair(RepairKind::Split, 3.0 + 1e-6 * f64::from(k), 1.0)));
    repairs.push(repair(RepairKind::Weld, 3.005, 1.0));
    let options = PictureOptions { width_px: 800, repairs, unhealed: row(2.5), ..PictureOptions::default() };
    let picture = picture_of_drawing(&drawing(1.0), &options);
    keep("repairs", &picture);
    // 23 places in sight: one marker each, and one number.
    let svg = picture.svg().expect("a small picture");
    let layer = svg.split("id=\"repairs\"").nth(1).and_then(|rest| rest.split("</g>").next()).expect("a layer");
    assert_eq!(layer.matches("<path").count(), 2 * 23);
    assert_eq!(svg.matches(">×20001<").count(), 2, "a number on its rim");
}

#[test]
fn many_repairs_do_not_drown_a_drawing() {
    let repair = |k: u32| {
        let at = [6.0 * f64::from(k % 200) / 200.0, 3.0 * f64::from(k / 200) / 100.0];
        Repair { kind: RepairKind::Split, at, size: 0.0, what: String::new() }
    };
    let options = PictureOptions { repairs: (0..20_000).map(repair).collect(), ..PictureOptions::default() };
    let svg = picture_of_drawing(&drawing(1.0), &options).svg().expect("a small picture");
    let layer = svg.split("id=\"repairs\"").nth(1).and_then(|rest| rest.split("</g>").next()).expect("a layer");
    let markers = layer.matches("<path").count() / 2;
    assert!((50..=250).contains(&markers), "{markers}");
    assert!(svg.contains("20\u{202f}000 splits"), "the legend has them all");
}

#[test]
fn what_is_said_of_a_mark_is_short_and_within_the_picture() {
    let at = Point::new(2.0, 1.0);
    let marks = vec![(at, "an outline misses closing: ".repeat(9)), (Point::new(0.0, 0.0), String::new())];
    let mut square = Drawing::default();
    square.add(Curve::line(Point::new(0.0, 0.0), at).expect("a line"), "side", "line 1");
    let svg = picture_of_drawing(&square, &PictureOptions { marks, ..PictureOptions::default() }).svg().expect("text");
    let crosses = svg.matches("stroke=\"#d6002a\"").count();
    assert_eq!(crosses, 2, "one for each place");
    let said: Vec<&str> = svg.lines().filter(|line| line.contains("misses")).collect();
    assert_eq!(said.len(), 2, "words and their rim: {said:?}");
    let words = said[1].split(['<', '>']).nth(2).expect("words");
    assert!(words.chars().count() <= 60 && words.ends_with('…'), "{words}");
    let x: f64 = said[1].split('"').nth(1).and_then(|x| x.parse().ok()).expect("a place");
    assert!(x > 0.0 && x + 13.6 * 0.5 * 60.0 < 1200.0, "{x}");
}
