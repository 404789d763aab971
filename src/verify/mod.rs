//! The verifier: (Domain, Mesh, Promise) → Verdict. It shares with the kernels only what lies below them, and
//! derives everything again.
//!
//! It evaluates the links between nodes and curves again, measures balls against the domain, and counts edges from the
//! triangles. Together the checks prove that the triangles tile the domain:
//!
//! ```text
//!   orientation, manifold, conforming, curve_chain ──▶ cover count of a point = winding number of the chords
//!   no chords cross, no node on a chord            ──▶ that number is 0 or 1: the triangles tile the region
//!   delaunay, empty_diametral                      ──▶ the tiling is Delaunay as a whole
//! ```
//!
//! Every triangle runs counter-clockwise (*orientation*). Every edge has at most one triangle on either side
//! (*manifold*). The edges at which a region ends are exactly the chords of its curves, each once and with the region
//! on the right side (*conforming*, *curve_chain*). So the number of triangles of a region that cover a point is the
//! winding number of the chords around it. No two chords cross (*conforming*) and none has a node on it
//! (*empty_diametral*), so that number is 0 or 1: the triangles tile the region, without overlap. With locally Delaunay
//! edges (*delaunay*) and empty diametral circles at the rim, the tiling is Delaunay as a whole. For a constrained
//! tiling *conforming* checks that no chords cross and no node lies on one; it is Delaunay except
//! across chords (*constrained_delaunay*).
//!
//! **Proven or reached.** A check of the output is `proven` where it holds, since it was made on this very output. The
//! angle bounds are `proven` only where theory covers κ ([`crate::promise::guaranteed_angle`]), so that every
//! input of that turning meets them; else `reached`.
//!
//! Signs come from [`crate::geometry::exact`] on coordinates scaled to unit magnitude. Measures are plain `f64`, each
//! with a tolerance derived where it is used.

mod angles;
mod balls;
mod circles;
mod curves;
mod densities;
mod edges;
mod elevation;
mod evidence;
mod measures;
pub mod solid;
mod tally;
mod topology;

pub use densities::densities;

use crate::domain::Domain;
use crate::geometry::Place;
use crate::ids::TriangleId;
use crate::mesh::Mesh;
use crate::promise::Promise;
use crate::threads;
use circles::Circles;
use evidence::Evidence;
use tally::Tally;

/// The outcome of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The check holds, and follows from the theory for this input or was made on this very output.
    Proven,
    /// The check holds for this mesh; no theorem says that it had to.
    Reached,
    /// The check fails.
    Broken,
    /// The check was not made: it does not apply to the mesh, was not asked for, or needs curves that are not known.
    #[serde(rename = "n/a")]
    NotAsked,
}

/// One check of the verdict.
#[derive(Clone, Debug, serde::Serialize, schemars::JsonSchema)]
pub struct Check {
    /// The name of the check, as in the contract.
    pub name: &'static str,
    /// The outcome.
    pub status: Status,
    /// How many things were checked.
    pub checked: usize,
    /// How many of them failed.
    pub broken: usize,
    /// How many things the check does not apply to, for a reason that the report states elsewhere (balls that a size
    /// limit capped).
    #[serde(skip_serializing_if = "is_zero")]
    pub exempt: usize,
    /// The worst value met, and where.
    pub worst: Option<Worst>,
    /// The first few flaws, as sentences with their places.
    #[serde(skip)]
    pub flaws: Vec<String>,
}

/// The worst value that a check met.
#[derive(Clone, Copy, Debug, serde::Serialize, schemars::JsonSchema)]
pub struct Worst {
    /// The value, in the unit of the check: degrees for angles of triangles, radians for turning, units of the drawing
    /// for lengths, their square for areas, else a ratio.
    pub value: f64,
    /// The place where it was met, in the coordinates of the drawing or the solid.
    pub at: Place,
}

/// Triangles below the angle asked for that are exempt, and the reason.
#[derive(Clone, Debug, serde::Serialize, schemars::JsonSchema)]
#[schemars(rename = "Excuse")]
pub struct Exemption {
    /// The corner, [x, y]; where `why` is `min_edge`, the centroid of the first triangle.
    pub at: [f64; 2],
    /// The radius of the corner's ball, or the largest distance from the corner to a node of the triangles; where `why`
    /// is `min_edge`, that limit. In units of the drawing.
    pub radius: f64,
    /// The reason, as the report spells it: that of the corner's ball, `input_angle`, or `min_edge`.
    pub why: &'static str,
    /// The ids of the triangles, ascending.
    pub cells: Vec<u32>,
}

/// The verdict: `promise` in the report.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The checks, each once, in a fixed order.
    pub checks: Vec<Check>,
    /// The triangles that are exempt from the smallest angle, by corner; empty where there are none.
    pub exempt: Vec<Exemption>,
}

impl Verdict {
    /// Whether no check is broken.
    pub fn kept(&self) -> bool {
        self.checks.iter().all(|c| c.status != Status::Broken)
    }

    /// The triangles that a corner exempts.
    pub fn exempt_cells(&self) -> impl Iterator<Item = TriangleId> {
        self.exempt.iter().flat_map(|exemption| &exemption.cells).map(|&cell| TriangleId(cell))
    }
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

/// Verifies a mesh against the domain (already τ-split) and the guarantees of `promise`. `None` for a mesh whose curves
/// are unknown: checks that need them are n/a.
///
/// The checks come in a fixed order, each once, `n/a` included; *constrained_delaunay* and *radius_edge* only
/// where they are guaranteed. A mesh with ids that do not exist or coordinates that are not finite has `manifold`
/// broken, with the flaws, and everything else `n/a`.
pub fn verify(domain: Option<&Domain>, mesh: &Mesh, promise: &Promise) -> Verdict {
    let mut unreadable = evidence::unreadable(domain, mesh);
    unreadable.extend(elevation::unreadable(mesh));
    if !unreadable.is_empty() {
        return verdict_of_unreadable(unreadable);
    }
    let evidence = Evidence::gather(domain, mesh, promise);
    let known =
        |check: fn(&Evidence, &Domain) -> Check, name| domain.map_or(Check::not_asked(name), |d| check(&evidence, d));
    // Checks share only the evidence, so the expensive ones run in parallel.
    let (circles, delaunay) =
        threads::join(|| domain.map(|d| (d, Circles::look(&evidence, d))), || angles::delaunay(&evidence));
    let constrained = promise.is_constrained();
    let (conforming, empty_diametral) = match circles {
        Some((domain, circles)) if constrained => {
            (topology::conforming(&evidence, domain, &circles), Check::not_asked("empty_diametral"))
        }
        Some((domain, circles)) => {
            threads::join(|| topology::conforming(&evidence, domain, &circles), || circles.empty(&evidence, domain))
        }
        None => (Check::not_asked("conforming"), Check::not_asked("empty_diametral")),
    };
    let ((on_curve, curve_chain), (chord_error, edge_turning)) = threads::join(
        || (known(curves::on_curve, "on_curve"), known(curves::curve_chain, "curve_chain")),
        || (known(curves::chord_error, "chord_error"), known(curves::edge_turning, "edge_turning")),
    );
    let (ball_radius, lfs_ratio, balls) = match domain.filter(|_| !constrained) {
        Some(domain) => balls::check(&evidence, domain),
        None => (Check::not_asked("ball_radius"), Check::not_asked("lfs_ratio"), Vec::new()),
    };
    let ((min_angle, exempt), (max_angle, size)) = threads::join(
        || angles::min_angle(&evidence, &balls),
        || (angles::max_angle(&evidence), measures::size(&evidence)),
    );
    let radius_edge = constrained.then(|| angles::radius_edge(&evidence, &exempt));
    let (delaunay, constrained_delaunay) =
        if constrained { (Check::not_asked("delaunay"), Some(delaunay)) } else { (delaunay, None) };
    let mut checks = vec![
        topology::orientation(&evidence),
        topology::manifold(&evidence),
        conforming,
        on_curve,
        curve_chain,
        empty_diametral,
        delaunay,
        min_angle,
        max_angle,
        ball_radius,
        lfs_ratio,
        chord_error,
        edge_turning,
        size,
        known(measures::area, "area"),
        known(measures::names, "names"),
        elevation::jacobian(&evidence),
    ];
    checks.extend(constrained_delaunay.into_iter().chain(radius_edge));
    Verdict { checks, exempt }
}

/// Names of the checks, in the order of the report.
const NAMES: [&str; 17] = [
    "orientation",
    "manifold",
    "conforming",
    "on_curve",
    "curve_chain",
    "empty_diametral",
    "delaunay",
    "min_angle",
    "max_angle",
    "ball_radius",
    "lfs_ratio",
    "chord_error",
    "edge_turning",
    "size",
    "area",
    "names",
    "jacobian",
];

fn verdict_of_unreadable(flaws: Vec<String>) -> Verdict {
    let mut manifold = Tally::highest("manifold");
    for flaw in flaws {
        manifold.count();
        manifold.flaw(|| flaw);
    }
    let mut checks: Vec<Check> = NAMES.map(Check::not_asked).into();
    checks[1] = manifold.finish(Status::Broken);
    Verdict { checks, exempt: Vec::new() }
}
