//! The Fig. 4 experiment: several curves that meet at zero tangent angle, τ = 0.5, κ = arcsin(1/2√2).

use crate::run;
use squinch::plane::Midpoint;
use squinch::plane::lopping::{Options, Rules, Shrinking};

pub fn print() {
    let drawing = run::read("samples/tangent_curves.json").expect("the sample is there");
    let kappa = (0.5 / 2f64.sqrt()).asin();
    println!("τ = 0.5, κ = {:.3}°, no limit on edge turning", kappa.to_degrees());
    println!("| β | midpoint | shrinking | arcs | vertices | of first | smallest° | largest° | exempt % | kept |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut first = None;
    for shrinking in [Shrinking::Literal, Shrinking::Batched] {
        for arcs in [None, Some(std::f64::consts::FRAC_PI_3)] {
            for midpoint in [Midpoint::Bisector, Midpoint::Angle] {
                for beta in [0.95, 0.5] {
                    let options = Options {
                        rules: Rules { beta, ball_shrinking: shrinking, midpoint },
                        corner_arcs: arcs,
                        ..run::unsized_options(kappa)
                    };
                    match run::run(&drawing, 0.5, &options) {
                        Ok(r) => {
                            let n = r.mesh.nodes.len();
                            let ratio = n as f64 / *first.get_or_insert(n) as f64;
                            println!(
                                "| {beta} | {midpoint:?} | {shrinking:?} | {} | {n} | {ratio:.3} | {:.3} | {:.1} | {:.1} | {} |",
                                if arcs.is_some() { "on" } else { "off" },
                                r.quality.min_angle_deg,
                                r.quality.max_angle_deg,
                                100.0 * r.exempt() as f64 / r.mesh.triangles.len() as f64,
                                if r.verdict.kept() { "yes".into() } else { format!("no: {:?}", r.broken()) },
                            );
                        }
                        Err(e) => println!("| {beta} | {midpoint:?} | {shrinking:?} | {} | {e} |", arcs.is_some()),
                    }
                }
            }
        }
    }
}
