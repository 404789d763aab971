//! The verifier of tetrahedral meshes: (Solid, SolidMesh) → Verdict. It imports no kernel.
//!
//! What the single checks say adds up. Every tetrahedron is positive (*orientation*), every face has one on either side at
//! most (*manifold*), and where there is one on one side only, or another region on the other, there is a facet
//! (*volume*). So the number of tetrahedra that cover a place is the same on both sides of each face but of those at which
//! the mesh ends; these are the triangles of facets, which cover each place of their facet once, and none outside of it
//! or in its holes (*facets*). Going in from infinity, that number is 0 outside, and 1 after the first facet: the
//! tetrahedra tile the solid. Volumes say the same once more (*volume*). Facets end in chains of edges (*segments*).
//! The tiling is constrained Delaunay with the weights of the mesh (*constrained_delaunay*), which are so small that they
//! stand for rounding alone (*weights*).
//!
//! Signs are exact: orientation by `robust` on coordinates scaled to unit magnitude, powers by `power.rs`. What is
//! measured is plain `f64`, and its tolerance is derived where it stands.

mod cells;
mod evidence;
mod faces;
mod facets;
mod grouped;
mod names;
mod power;
#[cfg(test)]
mod tests;
mod volume;

pub use cells::WEIGHT_BOUND;

use super::tally::Tally;
use super::{Check, Status, Verdict};
use crate::mesh::solid::SolidMesh;
use crate::solid::Solid;
use crate::threads;
use evidence::Evidence;

/// Names of the checks, in the contract's order.
const NAMES: [&str; 8] =
    ["orientation", "manifold", "facets", "segments", "constrained_delaunay", "volume", "weights", "names"];

/// Verifies a mesh against the solid that it is to fill. `None` for a mesh whose solid is unknown, and a mesh that does not
/// say what its triangles and edges lie on: checks that need to know are n/a.
///
/// The checks come in the contract's order, each once, `n/a` included. A mesh whose ids lead nowhere or whose numbers are
/// not finite has `manifold` broken, with the culprits, and everything else `n/a`.
pub fn verify_solid(solid: Option<&Solid>, mesh: &SolidMesh) -> Verdict {
    let unreadable = evidence::unreadable(solid, mesh);
    if !unreadable.is_empty() {
        return verdict_of_unreadable(unreadable);
    }
    let evidence = Evidence::gather(solid, mesh);
    let ((walk, orientation), weights) =
        threads::join(|| (cells::walk(&evidence), cells::orientation(&evidence)), || cells::weights(&evidence));
    let [facets, segments, volume, names] = match solid.filter(|_| !evidence.foreign) {
        Some(solid) => {
            let ((facets, planes), segments) =
                threads::join(|| facets::facets(&evidence, solid, &walk.walls), || facets::segments(&evidence, solid));
            let volume = volume::volume(&evidence, solid, &walk.walls, &planes, walk.bare);
            [facets, segments, volume, names::names(&evidence, solid)]
        }
        None => ["facets", "segments", "volume", "names"].map(Check::not_asked),
    };
    let constrained_delaunay = walk.constrained_delaunay;
    let checks = vec![orientation, walk.manifold, facets, segments, constrained_delaunay, volume, weights, names];
    Verdict { checks, exempt: Vec::new() }
}

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
