//! Hard drawings whose area is known by formula, meshed and verified; each also at other scales and places.

use squinch::generate::known::{self, Known, Near};
use squinch::geometry::{Vec2, scaled};
use squinch::mesh::Mesh;
use squinch::refine::StopReason;
use squinch::run::report::FailureKind;
use squinch::run::request::Request;
use squinch::run::{Exit, Extent, Outcome, run_drawing};
use squinch::watch::no_clock;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

/// What a drawing is put through; each alone.
#[derive(Clone, Copy, Debug)]
enum Stress {
    Plain,
    Scaled(f64),
    Moved(f64),
}

const STRESSES: [Stress; 6] = [
    Stress::Plain,
    Stress::Scaled(1_099_511_627_776.0), // 2⁴⁰
    Stress::Scaled(1.0 / 1_099_511_627_776.0),
    Stress::Scaled(1e6),
    Stress::Scaled(1e-6),
    Stress::Moved(1e7),
];

impl Stress {
    fn apply(self, known: &Known) -> Known {
        match self {
            Self::Plain => known.clone(),
            Self::Scaled(factor) => known.clone().scaled(factor),
            Self::Moved(by) => known.clone().moved(Vec2::new(by, -by)),
        }
    }

    /// The power of two of a scale that is one.
    fn power_of_two(self) -> Option<f64> {
        match self {
            Self::Scaled(factor) if factor.to_bits() << 12 == 0 => Some(factor),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Ending {
    /// Verified, and the area is right.
    Right,
    /// Verified, with the area changed by no more than the itemised repairs may: the tolerance along the border.
    Healed,
    /// Stopped by the announced estimate, or by the vertex budget.
    Refused,
    /// Refused for its geometry, with the place.
    Invalid,
    Wrong,
}

/// Family, which one of it, and the drawing: the many small ones, or the `large` ones.
fn families(large: bool) -> Vec<(&'static str, String, Known)> {
    let mut all = Vec::new();
    let mut add = |family, detail: &dyn std::fmt::Display, known| all.push((family, detail.to_string(), known));
    if large {
        add("circles", &1000, known::crossing_circles(1, 1000));
        add("rings", &300, known::rings(1, 300));
        add("holes", &"100²", known::plate_with_holes(1, 100));
        add("sections", &100_000, known::section(100_000));
        return all;
    }
    for seed in 0..10 {
        add("circles", &10, known::crossing_circles(seed, 10));
        add("circles", &60, known::crossing_circles(100 + seed, 60));
        add("rings", &(10 + 5 * seed), known::rings(seed, 10 + 5 * seed as usize));
        add("spirals", &(5 + 5 * seed), known::spiral(5 + 5 * seed as usize, 0.3 + 0.1 * seed as f64));
    }
    for (family, near) in ["lens", "gap", "inside", "concentric", "squares", "arcs"].into_iter().zip(Near::ALL) {
        for exponent in 3..=12 {
            for sign in [1.0, -1.0] {
                let separation = sign * 10f64.powi(-exponent);
                let detail = format!("{separation:e}");
                add(family, &detail, known::nearly(near, separation, 0.7 * f64::from(exponent)));
            }
        }
    }
    add("holes", &"20²", known::plate_with_holes(1, 20));
    add("sections", &1000, known::section(1000));
    all
}

/// Prints how many of each family come out how, of the small drawings or the large ones.
pub fn print(large: bool) {
    // Enough for all but slivers, which are to be refused.
    let request = Request { max_vertices: if large { 3_000_000 } else { 100_000 }, ..Request::default() };
    let mut table: BTreeMap<(&str, Ending), usize> = BTreeMap::new();
    let (mut slowest, mut twins, mut unlike) = ((0.0, String::new()), 0, 0);
    for (family, detail, known) in families(large) {
        let mut plain: Option<Mesh> = None;
        for stress in STRESSES {
            let stressed = stress.apply(&known);
            let start = Instant::now();
            let outcome = run_drawing(&stressed.drawing, &request, Extent::Whole(&mut |_| true), &no_clock);
            let seconds = start.elapsed().as_secs_f64();
            if seconds > slowest.0 {
                slowest = (seconds, format!("{family} {detail} {stress:?}"));
            }
            let (ending, what) = ending_of(&stressed, &outcome);
            *table.entry((family, ending)).or_default() += 1;
            if ending >= Ending::Invalid {
                println!("{ending:?}: {family} {detail} {stress:?}, area {}: {what}", stressed.area);
            }
            if let (Some(factor), Some(plain)) = (stress.power_of_two(), &plain) {
                twins += 1;
                let alike = outcome.mesh.as_ref().is_some_and(|mesh| are_twins(plain, mesh, factor));
                if !alike {
                    unlike += 1;
                    println!("Unlike: {family} {detail} {stress:?}");
                }
            }
            if let Stress::Plain = stress {
                plain = outcome.mesh;
            }
        }
    }
    println!("| family | right | healed | refused | invalid | wrong |\n|---|---|---|---|---|---|");
    let families: BTreeSet<&str> = table.keys().map(|(family, _)| *family).collect();
    let count = |family, ending| table.get(&(family, ending)).copied().unwrap_or(0);
    let endings = [Ending::Right, Ending::Healed, Ending::Refused, Ending::Invalid, Ending::Wrong];
    for family in families {
        println!("| {family} | {} |", endings.map(|ending| count(family, ending).to_string()).join(" | "));
    }
    println!("meshes at 2^±40 that are not the plain one, bit for bit: {unlike} of {twins}");
    println!("slowest: {:.1} s, {}", slowest.0, slowest.1);
}

fn ending_of(known: &Known, outcome: &Outcome) -> (Ending, String) {
    if let Some(failure) = &outcome.report.failure {
        let budget = failure.stop.as_ref().is_some_and(|stop| stop.reason == StopReason::VertexBudget);
        let ending = match failure.kind {
            FailureKind::NoMesh if budget => Ending::Refused,
            FailureKind::Geometry => Ending::Invalid,
            _ => Ending::Wrong,
        };
        return (ending, failure.what.clone());
    }
    let quality = outcome.report.quality.as_ref().and_then(|quality| quality.in_plane()).expect("a mesh is measured");
    let measure = quality.exact_measure.unwrap_or(f64::NAN);
    let error = (measure - known.area).abs();
    let domain = outcome.domain.as_ref().expect("a mesh has a domain");
    let what = format!("{measure}, off by {:.1e} of it; {:?}", error / known.area, outcome.exit);
    let healed = 2.0 * domain.tolerance() * known.perimeter;
    let ending = match outcome.exit {
        Exit::Done if error <= known.slack() * known.area => Ending::Right,
        Exit::Done if !domain.repairs().is_empty() && error <= healed => Ending::Healed,
        Exit::Missed if outcome.report.stop.as_ref().is_some_and(|s| s.reason == StopReason::VertexBudget) => {
            Ending::Refused
        }
        _ => Ending::Wrong,
    };
    (ending, what)
}

/// Whether the second mesh is the first one times a factor, bit for bit.
fn are_twins(mesh: &Mesh, other: &Mesh, factor: f64) -> bool {
    let nodes = mesh.nodes.iter().map(|p| scaled(*p, factor));
    mesh.triangles == other.triangles && nodes.eq(other.nodes.iter().copied())
}
