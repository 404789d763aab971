//! The judge: (Domain, Mesh, Promise) → Verdict. It shares with the kernels only what lies below them, and believes nothing.

use super::Mesh;
use crate::domain::Domain;
use crate::size::Sizing;

/// What a mesh is held to.
#[derive(Clone, Debug)]
pub struct Promise {
    /// κ, the smallest angle asked for; `None`: not asked.
    pub angle_min_rad: Option<f64>,
    /// τ of the split.
    pub tau_rad: f64,
    pub beta: f64,
    /// Whether corner arcs were on: which excuse holds, and C₀.
    pub corner_arcs: bool,
    /// Largest turning of a corner arc (for what is proven).
    pub arc_turning_rad: f64,
    /// The bisector rule (whose η, μ are known), or the angle rule (η ≥ √2).
    pub midpoint_bisector: bool,
    pub sizing: Sizing,
    /// A mesh from elsewhere: no links to curves, balls taken as (√2−1)·lfs₀.
    pub foreign: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    Proven,
    Reached,
    Broken,
    #[serde(rename = "n/a")]
    NotAsked,
}

/// One check of the verdict.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Check {
    pub name: &'static str,
    pub status: Status,
    /// How many things were checked, and how many failed.
    pub checked: usize,
    pub broken: usize,
    /// The worst value met, and where.
    pub worst: Option<Worst>,
    /// Sentences with culprits, for people; the first few.
    #[serde(skip)]
    pub flaws: Vec<String>,
}

#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct Worst {
    pub value: f64,
    pub at: [f64; 2],
}

/// Triangles below the angle that a corner excuses.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Excuse {
    pub at: [f64; 2],
    pub radius: f64,
    pub why: &'static str,
    pub cells: Vec<u32>,
}

/// The judge's verdict: `promise` of the report.
#[derive(Clone, Debug)]
pub struct Verdict {
    pub checks: Vec<Check>,
    pub excused: Vec<Excuse>,
}

impl Verdict {
    /// No check is broken.
    pub fn kept(&self) -> bool {
        self.checks.iter().all(|c| c.status != Status::Broken)
    }
}

/// Judges a mesh against the domain (already τ-split) and a promise. `None` for a mesh whose curves are unknown: checks that need them are n/a.
pub fn verify(_domain: Option<&Domain>, _mesh: &Mesh, _promise: &Promise) -> Verdict {
    todo!()
}
