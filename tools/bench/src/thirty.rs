//! What 30° takes on folders of drawings: reached everywhere where no angle is sharper than 60°, elsewhere but for what corners excuse.

use crate::run;
use squinch::domain::Domain;
use squinch::plane::gcdr::SHARP_RAD;
use squinch::plane::gcdr::{Choices, Steiner};
use squinch::run::request::{Engine, Request};
use squinch::run::{Exit, Extent, run_drawing};
use squinch::watch::no_clock;
use std::path::PathBuf;

/// Counts of one folder.
#[derive(Default)]
struct Counts {
    meshed: usize,
    without_sharp_corners: usize,
    triangles: usize,
    exempt: usize,
    largest_share: f64,
    /// Neither meshed nor refused for what they are.
    otherwise: Vec<String>,
}

pub fn print(folders: &[String]) -> Result<(), String> {
    println!(
        "| folder | meshed | no angle below 60° | triangles | below 30°, each exempt | largest share | otherwise |"
    );
    println!("|---|---|---|---|---|---|---|");
    for steiner in [Steiner::Center, Steiner::OptimalFree] {
        for folder in folders {
            let mut counts = Counts::default();
            for path in files(folder)? {
                counts.add(&path, steiner);
            }
            println!(
                "| {folder}, {steiner:?} | {} | {} | {} | {} | {:.1} % | {} |",
                counts.meshed,
                counts.without_sharp_corners,
                counts.triangles,
                counts.exempt,
                100.0 * counts.largest_share,
                counts.otherwise.join(", ")
            );
        }
    }
    Ok(())
}

fn files(folder: &str) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{folder}: {e}"))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    Ok(files)
}

impl Counts {
    fn add(&mut self, path: &std::path::Path, steiner: Steiner) {
        let gcdr = Choices { steiner, ..Choices::default() };
        let request =
            Request { engine: Engine::Gcdr, min_angle: 30.0, gcdr, timeout: Some(20.0), ..Request::default() };
        let name = path.display().to_string();
        let Ok(drawing) = run::read(&name) else { return };
        let outcome = run_drawing(&drawing, &request, Extent::Whole(&mut |_| true), &no_clock);
        let (Exit::Done, Some(mesh), Some(domain), Some(verdict)) =
            (outcome.exit, &outcome.mesh, &outcome.domain, &outcome.verdict)
        else {
            if outcome.exit != Exit::Geometry {
                self.otherwise.push(format!("{name} ({:?})", outcome.exit));
            }
            return;
        };
        let exempt: usize = verdict.exempt.iter().map(|e| e.cells.len()).sum();
        let sharp = has_sharp_corner(domain);
        if !sharp && exempt > 0 {
            self.otherwise.push(format!("{name} (excuses without a sharp corner)"));
        }
        self.meshed += 1;
        self.without_sharp_corners += usize::from(!sharp);
        self.triangles += mesh.triangles.len();
        self.exempt += exempt;
        self.largest_share = self.largest_share.max(exempt as f64 / mesh.triangles.len() as f64);
    }
}

fn has_sharp_corner(domain: &Domain) -> bool {
    domain.points().ids().filter_map(|p| domain.corner(p)).any(|corner| corner.angle_rad <= SHARP_RAD)
}
