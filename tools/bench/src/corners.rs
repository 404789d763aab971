//! Sharp straight corners: triangles, and the least angle outside the exempt ones.

use crate::run;
use squinch::plane::lopping::Options;
use std::f64::consts::FRAC_PI_3;

pub fn print(dir: &str) {
    let mut paths: Vec<String> = std::fs::read_dir(dir)
        .expect("a folder of .poly files")
        .filter_map(|e| Some(e.ok()?.path().to_str()?.to_owned()))
        .filter(|p| {
            let name = p.rsplit('/').next().unwrap_or(p);
            name.ends_with(".poly") && ["wedge", "thin", "fan", "circles_"].iter().any(|s| name.starts_with(s))
        })
        .collect();
    paths.sort();
    println!("| file | arcs | triangles | least° not exempt | least° | largest° | exempt | kept |");
    println!("|---|---|---|---|---|---|---|---|");
    for path in paths {
        for corner_arcs in [None, Some(FRAC_PI_3)] {
            let name = path.rsplit('/').next().unwrap_or(&path);
            let arcs = if corner_arcs.is_some() { "on" } else { "off" };
            let options = Options { corner_arcs, ..run::unsized_options(20.7f64.to_radians()) };
            match run::read(&path).and_then(|d| run::run(&d, 0.5, &options)) {
                Ok(r) => println!(
                    "| {name} | {arcs} | {} | {:.2} | {:.3} | {:.1} | {} | {} |",
                    r.mesh.triangles.len(),
                    r.quality.min_unexcused_angle_deg,
                    r.quality.min_angle_deg,
                    r.quality.max_angle_deg,
                    r.exempt(),
                    if r.verdict.kept() { "yes".into() } else { format!("no: {:?}", r.broken()) },
                ),
                Err(e) => println!("| {name} | {arcs} | {e} |"),
            }
        }
    }
}
