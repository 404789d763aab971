//! Random PSLGs, refined by GCDR: which end, and verify.

use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Drawing, FillRule};
use squinch::geometry::Point;
use squinch::geometry::exact::{Orientation, orient};
use squinch::geometry::rng::Rng;
use squinch::plane::gcdr::steiner::{Center, Extreme, Optimal, Random};
use squinch::plane::gcdr::{self, Options, Regions, SteinerStrategy};
use squinch::refine::{StopReason, Until};
use squinch::size::Sizing;
use squinch::verify::verify;

/// A bound for every strategy in turn: proven, at the brink, and beyond what is proven.
const TURNS: [(f64, &str); 4] = [(20.7, "center"), (20.7, "random"), (20.7, "extreme"), (30.0, "optimal-free")];

/// `n` seeds from one on.
pub fn print(n: u64, from: u64) {
    println!("| angles | PSLGs | ended and kept | otherwise | triangles |");
    println!("|---|---|---|---|---|");
    for (what, least_deg) in [("60° and more", 60.0), ("any", 0.0)] {
        let (mut kept, mut triangles, mut otherwise) = (0, 0, Vec::new());
        for seed in from..from + n {
            let (degrees, strategy) = TURNS[(seed % TURNS.len() as u64) as usize];
            let run = || refined(&random(seed, least_deg), degrees, strategy, seed);
            match std::panic::catch_unwind(run).unwrap_or_else(|_| Err("a panic".into())) {
                Ok(count) => {
                    kept += 1;
                    triangles += count;
                }
                Err(what) => otherwise.push(format!("seed {seed}: {what}")),
            }
        }
        println!("| {what} | {n} | {kept} | {} | {triangles} |", otherwise.len());
        otherwise.iter().take(10).for_each(|o| println!("{o}"));
    }
}

fn refined(drawing: &Drawing, degrees: f64, strategy: &str, seed: u64) -> Result<usize, String> {
    let domain = drawing.arrange(&ArrangeOptions::default()).map_err(|e| e.to_string())?;
    let angle_min_rad = degrees.to_radians();
    let regions = match strategy {
        "random" | "extreme" => Regions { delta2: 0.85, delta1: 0.9, mu: 1.0 },
        _ => Regions::CENTERS,
    };
    let mut strategy: Box<dyn SteinerStrategy> = match strategy {
        "center" => Box::new(Center),
        "random" => Box::new(Random::new(seed)),
        "extreme" => Box::new(Extreme),
        _ => Box::new(Optimal::new(angle_min_rad, true)),
    };
    let options = Options { angle_min_rad, regions, sizing: Sizing::default(), max_vertices: 200_000, record: false };
    let refined =
        gcdr::refine(&domain, &options, &mut *strategy, Until::End, &mut |_| true).map_err(|e| e.to_string())?;
    let mesh = refined.mesh.ok_or("no mesh")?;
    if refined.stop.reason != StopReason::Done || refined.stop.unresolved > 0 {
        return Err(format!("{:?}, {} unresolved", refined.stop.reason, refined.stop.unresolved));
    }
    let verdict = verify(Some(&domain), &mesh, &options.promise(strategy.is_free(), false));
    if verdict.kept() { Ok(mesh.triangles.len()) } else { Err("broken".into()) }
}

/// Up to thirty segments between up to thirty points in a box, of which no two cross, or meet at less than an angle.
fn random(seed: u64, least_deg: f64) -> Drawing {
    let mut rng = Rng::new(seed);
    let n = 3 + rng.below(28);
    let mut points: Vec<Point> = (0..n).map(|_| Point::new(rng.between(-0.9, 0.9), rng.between(-0.9, 0.9))).collect();
    points.extend([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Point::new(x, y)));
    let mut segments: Vec<[usize; 2]> = (0..4).map(|k| [n + k, n + (k + 1) % 4]).collect();
    for _ in 0..2 * n {
        let new = [rng.below(n), rng.below(n)];
        if new[0] != new[1] && segments.iter().all(|&old| agree(&points, old, new, least_deg)) {
            segments.push(new);
        }
    }
    let mut drawing = Drawing { fill: FillRule::Regions, ..Drawing::default() };
    for (i, [a, b]) in segments.into_iter().enumerate() {
        let line = Curve::line(points[a], points[b]).expect("two points");
        drawing.add(line, "edge", format!("segment {i}"));
    }
    drawing
}

fn agree(points: &[Point], old: [usize; 2], new: [usize; 2], least_deg: f64) -> bool {
    let part = |[a, b]: [usize; 2], [c, d]: [usize; 2]| {
        let side = |v: usize| orient(points[a], points[b], points[v]);
        side(c) != side(d) && side(c) != Orientation::Collinear && side(d) != Orientation::Collinear
    };
    let Some(&shared) = old.iter().find(|v| new.contains(v)) else { return !(part(old, new) && part(new, old)) };
    let away = |s: [usize; 2]| points[s[usize::from(s[0] == shared)]] - points[shared];
    let (u, v) = (away(old), away(new));
    let angle = u.cross(v).atan2(u.dot(v)).abs().to_degrees();
    angle > least_deg.max(1e-6)
}
