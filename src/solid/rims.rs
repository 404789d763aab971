//! Groups of triangles → facets with rims, segments and inner points.

use super::complex::{Complex, Use, edge};
use super::error::SolidError;
use super::plane::three_far;
use super::{Facet, Segment};
use crate::ids::{FacetId, Id, IdVec, PointId, SegmentId};
use std::collections::BTreeMap;

/// Facets and segments of a complex.
pub(super) struct Made {
    pub facets: IdVec<FacetId, Facet>,
    pub segments: IdVec<SegmentId, Segment>,
}

/// Makes a facet of each group of triangles, in the order of their first triangles.
///
/// # Errors
/// [`SolidError`] where triangles of one facet lie on each other.
pub(super) fn make_facets(complex: &Complex) -> Result<Made, SolidError> {
    let mut of_group: BTreeMap<u32, usize> = BTreeMap::new();
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for (t, triangle) in complex.triangles.iter().enumerate() {
        let at = *of_group.entry(triangle.group).or_insert(groups.len());
        if at == groups.len() {
            groups.push(Vec::new());
        }
        groups[at].push(t as u32);
    }
    let segments = find_segments(complex);
    let mut facets = IdVec::with_capacity(groups.len());
    for group in &groups {
        facets.push(facet(complex, group, &segments)?);
    }
    let name = |ends: &[u32; 2]| complex.required.get(ends).copied().flatten();
    let segment = |ends: &[u32; 2]| Segment { ends: ends.map(PointId), name: name(ends) };
    Ok(Made { facets, segments: segments.keys().map(segment).collect() })
}

/// Every edge that is a segment: asked for, or not between two triangles of one group alone.
fn find_segments(complex: &Complex) -> BTreeMap<[u32; 2], SegmentId> {
    let group = |u: &Use| complex.triangles[u.triangle as usize].group;
    let uses = complex.uses();
    let plain = |chunk: &&[Use]| matches!(chunk, [a, b] if group(a) == group(b) && a.forward != b.forward);
    let of_triangles = uses.chunk_by(|a, b| a.ends == b.ends).filter(|chunk| !plain(chunk)).map(|chunk| chunk[0].ends);
    let mut all: Vec<[u32; 2]> = of_triangles.chain(complex.required.keys().copied()).collect();
    all.sort_unstable();
    all.dedup();
    all.into_iter().zip(0..).map(|(ends, i)| (ends, SegmentId(i))).collect()
}

fn facet(complex: &Complex, group: &[u32], segments: &BTreeMap<[u32; 2], SegmentId>) -> Result<Facet, SolidError> {
    let first = &complex.triangles[group[0] as usize];
    let sides = Sides::of(complex, group)?;
    let rims = sides.rims();
    let mut own: Vec<SegmentId> = sides.next.iter().filter_map(|s| segments.get(&edge(s.0, s.1)).copied()).collect();
    own.sort_unstable();
    own.dedup();
    let mut points: Vec<u32> = group.iter().flat_map(|&t| complex.triangles[t as usize].corners).collect();
    points.sort_unstable();
    points.dedup();
    let mut on_segments: Vec<u32> =
        sides.next.iter().filter(|s| segments.contains_key(&edge(s.0, s.1))).flat_map(|s| [s.0, s.1]).collect();
    on_segments.sort_unstable();
    on_segments.dedup();
    let inner = points.iter().filter(|p| on_segments.binary_search(p).is_err());
    let entity = &complex.found.facets[first.facet as usize].entity;
    let mut of_facets: Vec<u32> = group.iter().map(|&t| complex.triangles[t as usize].facet).collect();
    of_facets.sort_unstable();
    of_facets.dedup();
    Ok(Facet {
        inner_points: inner.map(|&p| PointId(p)).collect(),
        rims,
        segments: own,
        plane: plane_of(complex, group, &points),
        triangles: group.iter().map(|&t| complex.triangles[t as usize].corners.map(PointId)).collect(),
        winding: first.winding,
        name: complex.found.facets[first.facet as usize].name,
        entity: match of_facets.len() {
            1 => entity.clone(),
            n => format!("{entity} and {} more", n - 1),
        },
    })
}

/// Three of the points, far apart, in the sense of the largest triangle.
fn plane_of(complex: &Complex, group: &[u32], points: &[u32]) -> [PointId; 3] {
    use crate::geometry::space::{cross, dot, minus};
    let normal = |[a, b, c]: [[f64; 3]; 3]| cross(minus(b, a), minus(c, a));
    let places: Vec<[f64; 3]> = points.iter().map(|&p| complex.points[p as usize]).collect();
    let of_triangle = |&t: &u32| normal(complex.corners(t));
    let sense = group.iter().map(of_triangle).reduce(|a, b| if dot(b, b) > dot(a, a) { b } else { a });
    let [a, b, c] = three_far(&places).unwrap_or([0, 1, 2]);
    let turned = sense.is_some_and(|sense| dot(normal([places[a], places[b], places[c]]), sense) < 0.0);
    let three = if turned { [a, c, b] } else { [a, b, c] };
    three.map(|i| PointId::from_index(points[i] as usize))
}

/// The directed edges of the triangles of one facet.
struct Sides {
    /// From, to, and the third corner, sorted.
    next: Vec<(u32, u32, u32)>,
}

impl Sides {
    fn of(complex: &Complex, group: &[u32]) -> Result<Self, SolidError> {
        let mut next = Vec::with_capacity(3 * group.len());
        for &t in group {
            let [a, b, c] = complex.triangles[t as usize].corners;
            next.extend([(a, b, c), (b, c, a), (c, a, b)]);
        }
        next.sort_unstable();
        match next.windows(2).find(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1)) {
            None => Ok(Self { next }),
            Some(pair) => {
                let what = format!("{}: two of its triangles lie on each other", complex.entity(group[0]));
                let help = "take one of them out of the file";
                Err(SolidError::new(what, complex.place_of(pair[0].0), help))
            }
        }
    }

    fn third(&self, a: u32, b: u32) -> Option<u32> {
        let at = self.next.partition_point(|s| (s.0, s.1) < (a, b));
        self.next.get(at).filter(|s| (s.0, s.1) == (a, b)).map(|s| s.2)
    }

    /// The closed rims, in the order of their least edges.
    fn rims(&self) -> Vec<Vec<PointId>> {
        let is_rim = |s: &(u32, u32, u32)| self.third(s.1, s.0).is_none();
        let mut done: BTreeMap<(u32, u32), bool> =
            self.next.iter().filter(|s| is_rim(s)).map(|s| ((s.0, s.1), false)).collect();
        let starts: Vec<(u32, u32)> = done.keys().copied().collect();
        let mut rims = Vec::new();
        for start in starts {
            let (mut a, mut b) = start;
            let mut rim = Vec::new();
            while let Some(done) = done.get_mut(&(a, b)).filter(|done| !**done) {
                *done = true;
                rim.push(PointId(a));
                (a, b) = (b, self.after(a, b));
            }
            if !rim.is_empty() {
                rims.push(rim);
            }
        }
        rims
    }

    /// The end of the rim edge that follows the rim edge `a b`: around `b`, within the facet.
    ///
    /// ```text
    ///        c ─── d         the triangles at b, from a b c on, until one has no neighbour: there the rim goes on
    ///       ╱ ╲   ╱ ╲
    ///      ╱   ╲ ╱   ╲
    ///     a ──▶ b ──▶ ?
    /// ```
    fn after(&self, a: u32, b: u32) -> u32 {
        let mut c = self.third(a, b).unwrap_or(a);
        // The edge b→c of the triangle a b c; across it is the triangle c b d.
        while let Some(d) = self.third(c, b) {
            c = d;
        }
        c
    }
}
