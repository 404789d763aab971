//! Pictures as text: golden SVG files under `tests/pictures/`. `UPDATE_PICTURES=1 cargo test --test pictures` writes them anew, with a PNG
//! of each under the target directory: look at it before committing.

use squinch::canvas::Canvas;
use squinch::export::picture::{MeshColour, PictureOptions, picture_of_mesh};
use squinch::geometry::{Point, Rect};
use squinch::ids::{CurveId, PointId, RegionId, VertexId};
use squinch::mesh::{Ball, BallReason, CurveEdge, CurveLink, Mesh};
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
