//! Triangles, least angle and time of every Steiner strategy but those of given places, at several angles, on one input.

use crate::run;
use squinch::domain::ArrangeOptions;
use squinch::mesh::quality::angle_range;
use squinch::plane::gcdr::{self, Choices, Options, Steiner};
use squinch::refine::{StopReason, Until};
use squinch::size::Sizing;
use std::time::Instant;

const ANGLES_DEG: [f64; 5] = [20.7, 25.0, 30.0, 33.0, 34.0];

pub fn print(path: &str) -> Result<(), String> {
    let domain = run::read(path)?.arrange(&ArrangeOptions::default()).map_err(|e| e.to_string())?.split_to_turning(0.5);
    println!("{path}: triangles / least° of all / ms");
    println!("| strategy |{}", ANGLES_DEG.map(|a| format!(" {a}° |")).concat());
    println!("|---|{}", ANGLES_DEG.map(|_| "---|").concat());
    for steiner in Steiner::ALL.into_iter().filter(|&steiner| steiner != Steiner::Snap) {
        let choices = Choices { steiner, ..Choices::default() };
        let mut row = format!("| {steiner:?} |");
        for degrees in ANGLES_DEG {
            let angle_min_rad = degrees.to_radians();
            let (mut strategy, regions) = (choices.strategy(angle_min_rad), choices.regions(angle_min_rad));
            let options =
                Options { angle_min_rad, regions, sizing: Sizing::default(), max_vertices: 200_000, record: false };
            let start = Instant::now();
            let refined = gcdr::refine(&domain, &options, &mut *strategy, Until::End, &mut |_| true)
                .map_err(|e| e.to_string())?;
            let ms = start.elapsed().as_secs_f64() * 1e3;
            row += &match (refined.mesh, refined.stop.reason) {
                (Some(mesh), StopReason::Done) => {
                    let least =
                        mesh.triangles.ids().map(|t| angle_range(mesh.corners(t)).0).fold(f64::INFINITY, f64::min);
                    format!(" {} / {:.2} / {ms:.0} |", mesh.triangles.len(), least.to_degrees())
                }
                (_, reason) => format!(" {reason:?} |"),
            };
        }
        println!("{row}");
    }
    Ok(())
}
