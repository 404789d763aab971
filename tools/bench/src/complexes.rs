//! Random curved complexes: which end, and what the verifier says of them.

use crate::run::{self, Run};
use squinch::generate;
use squinch::plane::lopping::Options;
use squinch::promise::{arc_turning, guaranteed_angle};
use squinch::verify::Status;
use std::f64::consts::FRAC_PI_3;

pub fn print(n: u64) {
    println!("| τ | κ° | arcs | of | ended and kept | angle proven | angle reached | slowest s | most vertices |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for tau in [0.02, 0.1, 0.2, 0.5, FRAC_PI_3] {
        // A hair below the guarantee, which is strict.
        let kappa = guaranteed_angle(tau) * (1.0 - 1e-9);
        for arcs in [None, Some(arc_turning(kappa, tau)), Some(FRAC_PI_3)] {
            row(n, tau, kappa, arcs);
        }
    }
    for kappa_deg in [20.7f64, 25.0, 30.0] {
        for arcs in [None, Some(FRAC_PI_3)] {
            row(n, 0.5, kappa_deg.to_radians(), arcs);
        }
    }
}

fn row(n: u64, tau: f64, kappa: f64, corner_arcs: Option<f64>) {
    let (mut kept, mut proven, mut reached, mut slowest, mut most) = (0, 0, 0, 0f64, 0);
    let options = Options { corner_arcs, max_vertices: 200_000, ..run::unsized_options(kappa) };
    for seed in 0..n {
        match run::run(&generate::curved_complex(seed), tau, &options) {
            Ok(r) => {
                slowest = slowest.max(r.seconds.refine);
                most = most.max(r.mesh.nodes.len());
                if !r.verdict.kept() || r.stop.unresolved > 0 {
                    complain(seed, &r);
                    continue;
                }
                kept += 1;
                match r.status("min_angle") {
                    Status::Proven => proven += 1,
                    _ => reached += 1,
                }
            }
            Err(e) => eprintln!("seed {seed}: {e}"),
        }
    }
    let arcs = corner_arcs.map_or("off".into(), |turning| format!("{turning:.3}"));
    println!(
        "| {tau:.4} | {:.3} | {arcs} | {n} | {kept} | {proven} | {reached} | {slowest:.2} | {most} |",
        kappa.to_degrees()
    );
}

fn complain(seed: u64, r: &Run) {
    eprintln!("seed {seed}: {:?}, unresolved {}, broken {:?}", r.stop.reason, r.stop.unresolved, r.broken());
    for check in r.verdict.checks.iter().filter(|c| c.status == Status::Broken) {
        eprintln!("    {}: {}", check.name, check.flaws.first().map_or("", |f| f));
    }
}
