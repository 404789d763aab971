//! The densities of recorded insertions, checked against their bounds.

use super::tally::Tally;
use super::{Check, Status};
use crate::domain::Domain;
use crate::geometry::Point;
use crate::ids::{Id, VertexId};
use crate::mesh::{Insertion, InsertionKind, Mesh};
use crate::promise::DensityPromise;
use std::collections::BTreeMap;

/// *density_a*, *density_b*, *density_c*: D(p) = lfs(p)/R(p) is at most the bound for its type. lfs is measured again
/// on the domain. R(p) is the recorded one, or the length of the shortest edge from the vertex to an older one in the
/// mesh, if that is less. Worst: the largest density. `n/a` where there is no finite bound.
pub fn densities(
    domain: &Domain,
    mesh: &Mesh,
    insertions: &[Insertion],
    promise: Option<DensityPromise>,
) -> [Check; 3] {
    let features = domain.features();
    let nearest = nearest_older(mesh, insertions);
    [InsertionKind::A, InsertionKind::B, InsertionKind::C].map(|kind| {
        let (name, bound) = match (kind, promise.map(|p| p.bounds)) {
            (InsertionKind::A, bounds) => ("density_a", bounds.map(|b| b.a)),
            (InsertionKind::B, bounds) => ("density_b", bounds.map(|b| b.b)),
            (InsertionKind::C, bounds) => ("density_c", bounds.map(|b| b.c)),
        };
        let Some((bound, promise)) = bound.filter(|b| b.is_finite()).zip(promise) else {
            return Check::not_asked(name);
        };
        let mut tally = Tally::highest(name);
        for (insertion, nearest) in insertions.iter().zip(&nearest).filter(|(i, _)| i.kind == kind) {
            tally.count();
            let at = insertion.at;
            let density = features.lfs(at) / insertion.radius.min(*nearest);
            tally.measure(density, at);
            // Lengths are rounded.
            if density > bound * (1.0 + 1e-9) {
                tally.flaw(|| format!("the vertex at ({}, {}) has a density of {density}", at.x, at.y));
            }
        }
        tally.finish(if promise.proven { Status::Proven } else { Status::Reached })
    })
}

/// For each inserted vertex the length of the shortest edge to an older one, infinite where it has none.
fn nearest_older(mesh: &Mesh, insertions: &[Insertion]) -> Vec<f64> {
    let bits = |p: Point| [p.x.to_bits(), p.y.to_bits()];
    // Of two insertions at one place the later one counts: the first vertex was deleted.
    let ages: BTreeMap<[u64; 2], usize> = insertions.iter().enumerate().map(|(age, i)| (bits(i.at), age)).collect();
    let age_of = |v: VertexId| ages.get(&bits(mesh.nodes[v])).copied();
    let ages: Vec<Option<usize>> = mesh.nodes.ids().map(age_of).collect();
    let mut nearest = vec![f64::INFINITY; insertions.len()];
    for &[a, b, c] in mesh.triangles.iter() {
        for [v, w] in [[a, b], [b, c], [c, a]] {
            // A vertex without an age was there from the start.
            if let Some(age) = ages[v.index()].max(ages[w.index()]) {
                nearest[age] = nearest[age].min(mesh.nodes[v].distance(mesh.nodes[w]));
            }
        }
    }
    nearest
}
