//! Points that lie on edges and in triangles of others split them; triangles that stand there twice become one.

use super::boxes::{Hierarchy, Space};
use super::complex::{Complex, Triangle, counted, edge, shown};
use super::exact::{Place, Side, along, axis_of, in_triangle, side, turn, within_segment};
use super::triangulate::triangulate;
use crate::geometry::exact::Orientation;
use crate::geometry::space::{dot, minus};
use std::collections::BTreeMap;

/// Splits triangles and required edges at the points that lie exactly on them.
pub(super) fn at_points(complex: &mut Complex) {
    let mut first = None;
    let of_triangles = on_triangles(complex);
    let of_edges = on_edges(complex);
    let mut points: Vec<u32> = of_triangles.iter().chain(of_edges.iter()).map(|&(_, p)| p).collect();
    points.sort_unstable();
    points.dedup();
    if let Some(&p) = points.first() {
        first = Some(shown(complex.place_of(p)));
    }
    split_triangles(complex, &of_triangles);
    split_edges(complex, &of_edges);
    if let Some(first) = first {
        let n = counted(points.len(), "point");
        complex
            .repairs
            .push(format!("{n} on an edge or in a facet without being part of it split it, the first at {first}."));
    }
}

fn used_points(complex: &Complex) -> Vec<u32> {
    (0..complex.points.len() as u32).filter(|&p| complex.used[p as usize]).collect()
}

/// Triangles with a point on them that is none of their corners, sorted.
fn on_triangles(complex: &Complex) -> Vec<(u32, u32)> {
    let boxes = (0..complex.triangles.len() as u32).map(|t| Space::around(complex.corners(t)));
    let hierarchy = Hierarchy::new(boxes);
    let (mut near, mut found) = (Vec::new(), Vec::new());
    for p in used_points(complex) {
        let at = complex.points[p as usize];
        hierarchy.meeting(Space::around([at]), &mut near);
        for &t in &near {
            let corners = complex.corners(t);
            let apart = !complex.triangles[t as usize].corners.contains(&p);
            if apart && side(corners[0], corners[1], corners[2], at) == Side::On {
                found.extend(axis_of(corners).filter(|&axis| in_triangle(axis, corners, at)).map(|_| (t, p)));
            }
        }
    }
    found.sort_unstable();
    found
}

/// Required edges, by their order, with a point within them, sorted.
fn on_edges(complex: &Complex) -> Vec<(u32, u32)> {
    let edges: Vec<[Place; 2]> = complex.required.keys().map(|e| e.map(|p| complex.points[p as usize])).collect();
    let hierarchy = Hierarchy::new(edges.iter().map(|&e| Space::around(e)));
    let (mut near, mut found) = (Vec::new(), Vec::new());
    if edges.is_empty() {
        return found;
    }
    for p in used_points(complex) {
        let at = complex.points[p as usize];
        hierarchy.meeting(Space::around([at]), &mut near);
        found.extend(
            near.iter().filter(|&&e| within_segment(edges[e as usize][0], edges[e as usize][1], at)).map(|&e| (e, p)),
        );
    }
    found.sort_unstable();
    found
}

fn split_triangles(complex: &mut Complex, on: &[(u32, u32)]) {
    if on.is_empty() {
        return;
    }
    let mut on = on.chunk_by(|a, b| a.0 == b.0).peekable();
    let mut triangles = Vec::with_capacity(complex.triangles.len());
    for (t, &triangle) in complex.triangles.iter().enumerate() {
        match on.next_if(|chunk| chunk[0].0 == t as u32) {
            None => triangles.push(triangle),
            Some(chunk) => {
                let ids: Vec<u32> = triangle.corners.into_iter().chain(chunk.iter().map(|&(_, p)| p)).collect();
                triangles.extend(parts(complex, triangle, &ids));
            }
        }
    }
    complex.triangles = triangles;
}

/// The triangles that a triangle is split to by points on it; `ids` are its corners, then these points.
fn parts(complex: &Complex, triangle: Triangle, ids: &[u32]) -> Vec<Triangle> {
    let corners = triangle.corners.map(|p| complex.points[p as usize]);
    let Some(axis) = axis_of(corners) else { return vec![triangle] };
    let points: Vec<_> = ids.iter().map(|&p| along(axis, complex.points[p as usize])).collect();
    // The points lie in the triangle exactly, none in the place of another: nothing to refuse.
    let Ok(flat) = triangulate(&points, &[[0, 1], [1, 2], [2, 0]]) else { return vec![triangle] };
    let turned = turn(axis, corners) == Orientation::Clockwise;
    let named = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| ids[i as usize]);
        Triangle { corners: if turned { [a, c, b] } else { [a, b, c] }, ..triangle }
    };
    flat.corners.iter().map(named).collect()
}

fn split_edges(complex: &mut Complex, on: &[(u32, u32)]) {
    if on.is_empty() {
        return;
    }
    let all: Vec<_> = std::mem::take(&mut complex.required).into_iter().collect();
    let mut on = on.chunk_by(|a, b| a.0 == b.0).peekable();
    for (e, ([a, b], name)) in all.into_iter().enumerate() {
        let mut chain = vec![a, b];
        if let Some(chunk) = on.next_if(|chunk| chunk[0].0 == e as u32) {
            let [from, to] = [a, b].map(|p| complex.points[p as usize]);
            let along = |p: u32| dot(minus(complex.points[p as usize], from), minus(to, from));
            chain.splice(1..1, chunk.iter().map(|&(_, p)| p));
            let last = chain.len() - 1;
            chain[1..last].sort_by(|&p, &q| along(p).total_cmp(&along(q)).then(p.cmp(&q)));
        }
        for pair in chain.windows(2) {
            complex.required.entry(edge(pair[0], pair[1])).or_insert(name);
        }
    }
}

/// Makes one of triangles that have the same corners, their windings summed.
pub(super) fn join_doubled(complex: &mut Complex) {
    let mut first_of: BTreeMap<[u32; 3], usize> = BTreeMap::new();
    let mut kept: Vec<Triangle> = Vec::with_capacity(complex.triangles.len());
    let (mut count, mut first, mut renamed) = (0, None, 0);
    for (t, triangle) in complex.triangles.iter().enumerate() {
        let mut key = triangle.corners;
        key.sort_unstable();
        let at = *first_of.entry(key).or_insert(kept.len());
        if at == kept.len() {
            kept.push(*triangle);
            continue;
        }
        let name = |facet: u32| complex.found.facets[facet as usize].name;
        renamed += usize::from(name(kept[at].facet) != name(triangle.facet));
        kept[at].winding +=
            if same_sense(kept[at].corners, triangle.corners) { triangle.winding } else { -triangle.winding };
        count += 1;
        first.get_or_insert_with(|| format!("{} at {}", complex.entity(t as u32), shown(complex.place_of(key[0]))));
    }
    complex.triangles = kept;
    if let Some(first) = first {
        let n = counted(count, "triangle");
        complex.repairs.push(format!("{n} with the corners of another became one with it, the first {first}."));
    }
    if renamed > 0 {
        complex
            .repairs
            .push(format!("{} of these had another name; that of the first was kept.", counted(renamed, "triangle")));
    }
}

/// Whether two triangles of the same corners have them in the same circular order.
fn same_sense(a: [u32; 3], b: [u32; 3]) -> bool {
    (0..3).any(|i| (0..3).all(|k| a[k] == b[(k + i) % 3]))
}
