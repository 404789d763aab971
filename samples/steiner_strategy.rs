//! A strategy of one's own: of the places that the selection disk leaves, the one nearest to a sensor, so that sensors come to lie on
//! vertices without a bound being lost.
//!
//! `cargo run --example steiner_strategy`

use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Drawing};
use squinch::geometry::Point;
use squinch::plane::gcdr::steiner::Skinny;
use squinch::plane::gcdr::{Options, Regions, SteinerStrategy, refine};
use squinch::refine::Until;
use squinch::size::Sizing;
use squinch::verify::verify;

struct NearSensors(Vec<Point>);

impl SteinerStrategy for NearSensors {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        // What lies outside the disk, the engine moves to its border.
        let away = |p: &Point| p.distance(triangle.center);
        self.0
            .iter()
            .copied()
            .filter(|p| away(p) <= triangle.reach)
            .min_by(|p, q| away(p).total_cmp(&away(q)))
            .unwrap_or(triangle.center)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut drawing = Drawing::default();
    for (i, half) in [0.5, 0.47].into_iter().enumerate() {
        let corners = [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| Point::new(x, y));
        for k in 0..4 {
            drawing.add(Curve::line(corners[k], corners[(k + 1) % 4])?, "wall", format!("square {i}, side {k}"));
        }
    }
    let domain = drawing.arrange(&ArrangeOptions::default())?.split_to_turning(0.5);
    let sensors: Vec<Point> = (0..60).map(|k| Point::new(-0.485 + 0.016 * f64::from(k), 0.485)).collect();
    let sizing = Sizing { max_edge: Some(0.02), ..Sizing::default() };
    // At 20° the disk has up to 0.31 of the circumradius.
    let regions = Regions { delta2: 0.69, delta1: 1.0, mu: 1.0 };
    let options = Options { angle_min_rad: 20f64.to_radians(), regions, sizing, max_vertices: 100_000, record: false };
    let refined = refine(&domain, &options, &mut NearSensors(sensors.clone()), Until::End, &mut |_progress| true)?;
    let mesh = refined.mesh.ok_or("a budget ended before there was a mesh")?;
    let verdict = verify(Some(&domain), &mesh, &options.promise(false, false));
    let met = sensors.iter().filter(|&s| mesh.nodes.iter().any(|n| n == s)).count();
    println!(
        "{} triangles, {met} of {} sensors on vertices, every guarantee holds: {}",
        mesh.triangles.len(),
        sensors.len(),
        verdict.kept()
    );
    Ok(())
}
