//! Time per triangle of both planar engines on one input, at the same angle: refinement alone, the best of some runs in turn.

use crate::run;
use squinch::domain::{ArrangeOptions, Domain};
use squinch::mesh::Mesh;
use squinch::plane::gcdr::steiner::Center;
use squinch::plane::gcdr::{self, Regions};
use squinch::plane::lopping;
use squinch::refine::Until;
use squinch::size::Sizing;
use std::time::Instant;

/// Runs of each engine.
const RUNS: usize = 15;

const ANGLE_DEG: f64 = 20.7;

pub fn print(paths: &[String]) -> Result<(), String> {
    println!(
        "| input | area limit | lopping: triangles | ms | GCDR, centres: triangles | ms | µs a triangle, GCDR over lopping |"
    );
    println!("|---|---|---|---|---|---|---|");
    for path in paths {
        let domain =
            run::read(path)?.arrange(&ArrangeOptions::default()).map_err(|e| e.to_string())?.split_to_turning(0.5);
        let area: f64 = domain.regions().iter().map(|r| r.area).sum();
        for max_area in [None, Some(area / 2e4)] {
            let sizing = Sizing { max_area, ..Sizing::default() };
            let (mut of_lopping, mut of_gcdr) = (Best::default(), Best::default());
            for _ in 0..RUNS {
                of_lopping.time(|| lopped(&domain, &sizing))?;
                of_gcdr.time(|| refined(&domain, &sizing))?;
            }
            let ratio = of_gcdr.ms / of_gcdr.triangles as f64 / (of_lopping.ms / of_lopping.triangles as f64);
            println!(
                "| {path} | {} | {} | {:.2} | {} | {:.2} | {ratio:.2} |",
                max_area.map_or("none".into(), |a| format!("{a:.3e}")),
                of_lopping.triangles,
                of_lopping.ms,
                of_gcdr.triangles,
                of_gcdr.ms
            );
        }
    }
    Ok(())
}

/// The fastest run so far.
struct Best {
    triangles: usize,
    ms: f64,
}

impl Default for Best {
    fn default() -> Self {
        Self { triangles: 0, ms: f64::INFINITY }
    }
}

impl Best {
    fn time(&mut self, mesh: impl FnOnce() -> Result<Mesh, String>) -> Result<(), String> {
        let start = Instant::now();
        self.triangles = mesh()?.triangles.len();
        self.ms = self.ms.min(start.elapsed().as_secs_f64() * 1e3);
        Ok(())
    }
}

fn lopped(domain: &Domain, sizing: &Sizing) -> Result<Mesh, String> {
    let angle_min_rad = ANGLE_DEG.to_radians();
    let options = lopping::Options { angle_min_rad, sizing: sizing.clone(), ..lopping::Options::default() };
    let refined = lopping::refine(domain, &options, Until::End, &mut |_| true).map_err(|e| e.to_string())?;
    refined.mesh.ok_or_else(|| format!("{:?}", refined.stop.reason))
}

fn refined(domain: &Domain, sizing: &Sizing) -> Result<Mesh, String> {
    let options = gcdr::Options {
        angle_min_rad: ANGLE_DEG.to_radians(),
        regions: Regions::CENTERS,
        sizing: sizing.clone(),
        max_vertices: 5_000_000,
        record: false,
    };
    let refined = gcdr::refine(domain, &options, &mut Center, Until::End, &mut |_| true).map_err(|e| e.to_string())?;
    refined.mesh.ok_or_else(|| format!("{:?}", refined.stop.reason))
}
