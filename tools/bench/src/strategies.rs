//! Triangles, least angle and time of every Steiner strategy at several angles, on one input.

use crate::run;
use squinch::domain::ArrangeOptions;
use squinch::mesh::quality::angle_range;
use squinch::plane::gcdr::parameters::radius_edge_of;
use squinch::plane::gcdr::steiner::{Center, Extreme, OffCenter, Optimal, Random};
use squinch::plane::gcdr::{self, Options, Regions, SteinerStrategy};
use squinch::refine::{StopReason, Until};
use squinch::size::Sizing;
use std::time::Instant;

const ANGLES_DEG: [f64; 5] = [20.7, 25.0, 30.0, 33.0, 34.0];

pub fn print(path: &str) -> Result<(), String> {
    let domain = run::read(path)?.arrange(&ArrangeOptions::default()).map_err(|e| e.to_string())?.split_to_turning(0.5);
    println!("{path}: triangles / least° of all / ms");
    println!("| strategy |{}", ANGLES_DEG.map(|a| format!(" {a}° |")).concat());
    println!("|---|{}", ANGLES_DEG.map(|_| "---|").concat());
    for name in ["center", "offcenter", "optimal", "extreme", "random", "offcenter-free", "optimal-free"] {
        let mut row = format!("| {name} |");
        for degrees in ANGLES_DEG {
            let angle_min_rad = degrees.to_radians();
            let free = name.ends_with("-free");
            let mut strategy: Box<dyn SteinerStrategy> = match name {
                "center" => Box::new(Center),
                "offcenter" | "offcenter-free" => Box::new(OffCenter::new(angle_min_rad, free)),
                "optimal" | "optimal-free" => Box::new(Optimal::new(angle_min_rad, free)),
                "extreme" => Box::new(Extreme),
                _ => Box::new(Random::new(0)),
            };
            let regions = Regions::widest_disks(radius_edge_of(angle_min_rad));
            let regions = if free || name == "center" { Regions::CENTERS } else { regions };
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
