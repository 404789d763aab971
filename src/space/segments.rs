//! Segments become chains of edges (Rule 1 of Shewchuk & Si 2014, as far as a constrained Delaunay mesh needs it): a
//! subsegment that is no edge is split.
//!
//! ```text
//!        b                     a: the apex of an acute angle between segments. Its subsegments are split where spheres about a cross
//!       ╱                      them whose radii are powers of two, others in the middle: vertices at one distance from a do not
//!    ──●── shell 2^k           encroach on each other's subsegments, so that splitting ends at any angle.
//!     ╱ ╲
//!    a───●───── c
//! ```
//!
//! An edge of the tetrahedralization has an orthogonal sphere that no other vertex reaches: all signs are strict. That is
//! what the CDT theorem asks of a segment, and less than an empty diametral ball.

use super::Fault;
use super::insert::{Kernel, Refusal};
use crate::geometry::space::{dot, length, minus, plus, times};
use crate::ids::{IdVec, PointId, SegmentId, TetId, VertexId};
use crate::solid::Solid;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// A part of a segment between two vertices next to each other on it.
#[derive(Clone, Copy, Debug)]
struct Subsegment {
    segment: SegmentId,
    ends: [VertexId; 2],
    /// Where its ends lie along the segment, in 0..1.
    t: [f64; 2],
}

impl Subsegment {
    /// By segment, and along it.
    fn along(&self, other: &Self) -> Ordering {
        self.segment.cmp(&other.segment).then(self.t[0].total_cmp(&other.t[0]))
    }
}

/// The segments of a solid on their way into a tetrahedralization.
pub(super) struct Segments<'a> {
    solid: &'a Solid,
    /// The vertex of each point.
    vertex_of: IdVec<PointId, VertexId>,
    /// Points at which two segments meet at an acute angle.
    is_apex: IdVec<PointId, bool>,
    /// Subsegments that are edges, by their ends, the smaller id first.
    edges: BTreeMap<[VertexId; 2], Subsegment>,
    missing: Vec<Subsegment>,
}

impl<'a> Segments<'a> {
    /// All segments, none of them looked for yet.
    pub fn new(solid: &'a Solid, vertex_of: IdVec<PointId, VertexId>) -> Self {
        let missing = solid.segments().enumerate().map(|(segment, s)| {
            let ends = s.ends.map(|p| vertex_of[p]);
            Subsegment { segment, ends, t: [0.0, 1.0] }
        });
        let missing = missing.rev().collect();
        Self { solid, vertex_of, is_apex: apexes(solid), edges: BTreeMap::new(), missing }
    }

    /// Splits segments until each is a chain of edges. New vertices get at most this part of the squared distance to the
    /// nearest as their weights. `ask` is told the number of vertices before each split.
    pub fn recover(
        &mut self,
        kernel: &mut Kernel,
        scale: f64,
        ask: &mut dyn FnMut(usize) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        while let Some(sub) = self.missing.pop() {
            let [u, v] = sub.ends;
            if kernel.net.tet_at_edge(u, v).is_some() {
                self.edges.insert(sorted(sub.ends), sub);
            } else {
                ask(kernel.net.points.len() + 1)?;
                self.split(kernel, sub, scale)?;
            }
        }
        Ok(())
    }

    /// Lets all vertices have other ids, of a tetrahedralization in which no subsegment was looked for yet.
    pub fn renumber(&mut self, new_of: impl Fn(VertexId) -> VertexId) {
        self.vertex_of.iter_mut().for_each(|v| *v = new_of(*v));
        let parts = std::mem::take(&mut self.edges).into_values();
        self.missing.extend(parts.map(|sub| Subsegment { ends: sub.ends.map(&new_of), ..sub }));
        self.missing.sort_unstable_by(|a, b| b.along(a));
    }

    fn split(&mut self, kernel: &mut Kernel, sub: Subsegment, scale: f64) -> Result<(), Fault> {
        let t = self.split_parameter(kernel, &sub);
        let [from, to] = self.solid.segments()[sub.segment].ends.map(|p| kernel.net.points[self.vertex_of[p]]);
        let p = plus(from, times(minus(to, from), t));
        let too_near = |_: Refusal| Fault::TooNear { segment: sub.segment, at: p };
        kernel.start_at(sub.ends[0]);
        let d2 = nearest(kernel, p).map_err(too_near)?;
        let weight = scale * d2 * super::share(kernel.net.points.len());
        let cavity = kernel.cavity(p, weight).map_err(too_near)?.to_vec();
        let touched = self.edges_of(kernel, &cavity);
        let v = kernel.fill(p, weight);
        for edge in touched {
            if kernel.net.tet_at_edge(edge[0], edge[1]).is_none() {
                self.missing.extend(self.edges.remove(&edge));
            }
        }
        let [u, w] = sub.ends;
        self.missing.push(Subsegment { ends: [v, w], t: [t, sub.t[1]], ..sub });
        self.missing.push(Subsegment { ends: [u, v], t: [sub.t[0], t], ..sub });
        Ok(())
    }

    /// The subsegments that are edges of some tetrahedra.
    fn edges_of(&self, kernel: &Kernel, tets: &[TetId]) -> Vec<[VertexId; 2]> {
        let mut edges = Vec::new();
        for &t in tets {
            let c = kernel.net.corners(t);
            let pairs = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]].map(|[i, j]| sorted([c[i], c[j]]));
            edges.extend(pairs.into_iter().filter(|pair| self.edges.contains_key(pair)));
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Where along its segment a subsegment is split: on a shell around an apex, or in the middle.
    fn split_parameter(&self, kernel: &Kernel, sub: &Subsegment) -> f64 {
        let [t0, t1] = sub.t;
        let ends = self.solid.segments()[sub.segment].ends;
        let apex = [t0 == 0.0 && self.is_apex[ends[0]], t1 == 1.0 && self.is_apex[ends[1]]];
        let whole = {
            let [a, b] = ends.map(|p| kernel.net.points[self.vertex_of[p]]);
            length(minus(b, a))
        };
        let shell = shell((t1 - t0) * whole) / whole;
        match apex {
            [true, false] => t0 + shell,
            [false, true] => t1 - shell,
            _ => 0.5 * (t0 + t1),
        }
    }

    /// The vertex of each point, and the chain of each segment from end to end.
    pub fn chains(self) -> (IdVec<PointId, VertexId>, IdVec<SegmentId, Vec<VertexId>>) {
        let mut parts: Vec<Subsegment> = self.edges.into_values().collect();
        parts.sort_unstable_by(Subsegment::along);
        let mut chains: IdVec<SegmentId, Vec<VertexId>> = vec![Vec::new(); self.solid.segments().len()].into();
        for part in parts {
            let chain = &mut chains[part.segment];
            if chain.is_empty() {
                chain.push(part.ends[0]);
            }
            chain.push(part.ends[1]);
        }
        (self.vertex_of, chains)
    }
}

/// The squared distance from a point to the nearest vertex: one of the corners of its cavity without weight.
fn nearest(kernel: &mut Kernel, p: [f64; 3]) -> Result<f64, Refusal> {
    let cavity = kernel.cavity(p, 0.0)?.to_vec();
    let corners = cavity.into_iter().flat_map(|t| kernel.net.corners(t));
    Ok(corners.map(|v| minus(kernel.net.points[v], p)).map(|d| dot(d, d)).fold(f64::INFINITY, f64::min))
}

/// The power of two that is between a third and two thirds of a length.
fn shell(length: f64) -> f64 {
    let (mantissa, exponent) = libm::frexp(length);
    // The length is mantissa · 2^exponent, the mantissa in [½, 1): a half of it in [¼, ½), a quarter below ¾.
    libm::ldexp(1.0, exponent - if mantissa < 0.75 { 2 } else { 1 })
}

fn sorted([u, v]: [VertexId; 2]) -> [VertexId; 2] {
    [u.min(v), u.max(v)]
}

/// The points at which two segments meet at less than 90°.
fn apexes(solid: &Solid) -> IdVec<PointId, bool> {
    let mut directions: IdVec<PointId, Vec<[f64; 3]>> = vec![Vec::new(); solid.points().len()].into();
    for segment in solid.segments().iter() {
        let [a, b] = segment.ends;
        let along = minus(solid.points()[b], solid.points()[a]);
        directions[a].push(along);
        directions[b].push(times(along, -1.0));
    }
    let acute = |d: &Vec<[f64; 3]>| d.iter().enumerate().any(|(i, &u)| d[..i].iter().any(|&v| dot(u, v) > 0.0));
    directions.iter().map(acute).collect::<Vec<_>>().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_is_a_power_of_two_in_the_middle_third() {
        for k in 0..400 {
            let length = 0.01 * libm::pow(1.05, f64::from(k));
            let shell = shell(length);
            assert_eq!(libm::frexp(shell).0, 0.5);
            assert!(shell >= length / 3.0 && shell <= length * 2.0 / 3.0, "{shell} of {length}");
        }
    }
}
