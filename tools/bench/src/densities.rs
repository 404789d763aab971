//! Table 7.1 of Foteinos, Chernikov & Chrisochoides (2010): densities and triangles of experiments 1 and 2 beside both bounds.

use crate::run;
use squinch::domain::{ArrangeOptions, Domain};
use squinch::plane::gcdr::steiner::{Extreme, Random};
use squinch::plane::gcdr::{self, Options, Regions, SteinerStrategy};
use squinch::promise::{Densities, DensityPromise};
use squinch::refine::Until;
use squinch::size::Sizing;
use squinch::verify::densities;
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// Runs a row of experiment 2 is repeated.
const REPEATS: u64 = 100;

/// Triangles that the paper reports for experiment 1, by row.
const PAPER: [usize; 32] = [
    1583, 1814, 2052, 2557, 1571, 1804, 2047, 2546, 1565, 1818, 2047, 2505, 1586, 1799, 2055, 2595, 1540, 1807, 2083,
    2578, 1541, 1811, 2091, 2540, 1615, 1868, 2139, 2628, 1562, 1843, 2118, 2615,
];

/// The largest densities by type, and how many triangles.
struct Observed {
    densities: [f64; 3],
    triangles: usize,
}

pub fn print(path: &str) -> Result<(), String> {
    let domain = run::read(path)?.arrange(&ArrangeOptions::default()).map_err(|e| e.to_string())?;
    println!(
        "| row | δ₂ δ₁ μ | printed D_A D_B D_C | least solution | experiment 1: A B C | triangles (paper) | experiment 2: A B C |"
    );
    println!("|---|---|---|---|---|---|---|");
    let rows = [1.0, 0.9, 0.8].into_iter().flat_map(|delta2| [1.0, 0.9, 0.8].map(|delta1| (delta2, delta1)));
    // δ₂ = δ₁ = 0.8 violates (3.2).
    let rows = rows.filter(|&(delta2, delta1)| delta2 * delta1 * SQRT_2 > 1.0);
    let rows = rows.flat_map(|(delta2, delta1)| [1.0, 0.8, 0.6, 0.4].map(|mu| Regions { delta2, delta1, mu }));
    for (i, regions) in rows.enumerate() {
        let printed = regions.printed_densities(SQRT_2, FRAC_PI_2);
        let least = regions.least_densities(SQRT_2, FRAC_PI_2);
        let least = least.map_or("none".into(), |d| format!("{:.2} {:.2} {:.2}", d.a, d.b, d.c));
        let first = observe(&domain, regions, &mut Extreme)?;
        let mut worst = [0.0f64; 3];
        for seed in 0..REPEATS {
            let observed = observe(&domain, regions, &mut Random::new(seed))?;
            worst.iter_mut().zip(observed.densities).for_each(|(w, d)| *w = w.max(d));
        }
        let bounds = [printed.a, printed.b, printed.c];
        let tell = |densities: [f64; 3]| {
            // Beyond a printed bound is a finding.
            let told =
                densities.iter().zip(bounds).map(|(d, bound)| format!("{d:.2}{}", if *d > bound { "!" } else { "" }));
            told.collect::<Vec<_>>().join(" ")
        };
        println!(
            "| {} | {:.2} {:.2} {:.2} | {:.2} {:.2} {:.2} | {least} | {} | {} ({}) | {} |",
            i + 1,
            regions.delta2,
            regions.delta1,
            regions.mu,
            printed.a,
            printed.b,
            printed.c,
            tell(first.densities),
            first.triangles,
            PAPER[i],
            tell(worst),
        );
    }
    Ok(())
}

fn observe(domain: &Domain, regions: Regions, strategy: &mut dyn SteinerStrategy) -> Result<Observed, String> {
    let angle_min_rad = (0.5 / SQRT_2).asin();
    let options = Options { angle_min_rad, regions, sizing: Sizing::default(), max_vertices: 100_000, record: true };
    let refined = gcdr::refine(domain, &options, strategy, Until::End, &mut |_| true).map_err(|e| e.to_string())?;
    let mesh = refined.mesh.ok_or("no mesh")?;
    let none = Densities { a: f64::MAX, b: f64::MAX, c: f64::MAX };
    let checks = densities(domain, &mesh, &refined.insertions, Some(DensityPromise { bounds: none, proven: false }));
    Ok(Observed {
        densities: checks.map(|check| check.worst.map_or(0.0, |worst| worst.value)),
        triangles: mesh.triangles.len(),
    })
}
