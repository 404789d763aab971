//! One run from a drawing to a verdict, with the seconds of each stage.

use squinch::domain::{ArrangeOptions, Domain, Drawing};
use squinch::import::{self, Format};
use squinch::mesh::{Mesh, quality};
use squinch::plane::lopping::{self, Options};
use squinch::refine::{Counters, Stop, Until};
use squinch::section;
use squinch::size::Sizing;
use squinch::verify::{self, Status, Verdict};
use std::time::Instant;

/// What a run made.
pub struct Run {
    pub domain: Domain,
    pub mesh: Mesh,
    pub stop: Stop,
    pub counters: Counters,
    pub verdict: Verdict,
    pub quality: quality::Quality,
    pub seconds: Seconds,
}

/// Seconds by stage.
#[derive(Default, Clone, Copy)]
pub struct Seconds {
    pub arrange: f64,
    pub refine: f64,
    pub verify: f64,
}

/// Reads a drawing of a known format.
pub fn read(path: &str) -> Result<Drawing, String> {
    let bytes = std::fs::read(path).map_err(|e| format!("{path}: {e}"))?;
    let format = import::format_of(path.as_ref()).unwrap_or(Format::Outline);
    let found = import::read(&bytes, format, path, &import::Options::default());
    found.and_then(|found| section::drawn(found, &section::Options::default())).map_err(|e| format!("{path}: {e}"))
}

/// Meshes and verifies a drawing.
pub fn run(drawing: &Drawing, tau_rad: f64, options: &Options) -> Result<Run, String> {
    let mut seconds = Seconds::default();
    let start = Instant::now();
    let domain = drawing.arrange(&ArrangeOptions::default()).map_err(|e| e.to_string())?.split_to_turning(tau_rad);
    seconds.arrange = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let refined = lopping::refine(&domain, options, Until::End, &mut |_| true).map_err(|e| e.to_string())?;
    seconds.refine = start.elapsed().as_secs_f64();
    let mesh = refined.mesh.ok_or_else(|| format!("no mesh: {:?}", refined.stop.reason))?;
    let start = Instant::now();
    let verdict = verify::verify(Some(&domain), &mesh, &options.promise(false));
    seconds.verify = start.elapsed().as_secs_f64();
    let quality = quality::Quality::of(Some(&domain), &mesh, verdict.exempt_cells());
    Ok(Run { domain, mesh, stop: refined.stop, counters: refined.counters, verdict, quality, seconds })
}

impl Run {
    /// The status of one check.
    pub fn status(&self, name: &str) -> Status {
        self.verdict.checks.iter().find(|c| c.name == name).map_or(Status::NotAsked, |c| c.status)
    }

    /// Names of the broken checks.
    pub fn broken(&self) -> Vec<&'static str> {
        self.verdict.checks.iter().filter(|c| c.status == Status::Broken).map(|c| c.name).collect()
    }

    pub fn exempt(&self) -> usize {
        self.verdict.exempt.iter().map(|e| e.cells.len()).sum()
    }
}

/// Options with no size asked for.
pub fn unsized_options(angle_min_rad: f64) -> Options {
    Options { angle_min_rad, sizing: Sizing::default(), max_vertices: 1_000_000, ..Options::default() }
}
