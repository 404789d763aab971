//! Whether every facet is a union of faces of the mesh, and every segment a chain of its edges.

use super::cells::{Wall, within_facets};
use super::evidence::{Evidence, distance, place, turn};
use super::grouped::Grouped;
use crate::geometry::space::{cross, dot, length, minus, times, unit};
use crate::ids::{FacetId, Id, IdVec, PointId, SegmentId, TetId, VertexId};
use crate::solid::{Facet, Solid};
use crate::verify::tally::Tally;
use crate::verify::{Check, Status};
use std::cmp::Ordering;

/// What the checks of facets found out about each facet.
pub struct Planes {
    /// How far a node may lie from the facet's plane: as far as the facet's own points do, and rounding.
    pub reach: IdVec<FacetId, f64>,
}

/// Every facet is a union of triangles of the mesh that are faces of tetrahedra, each place once.
///
/// The triangles of a facet all face the way it does, and the edges that they do not share are its rims: so each place of
/// the facet is covered once, by the winding number of its rims, and no hole is. Their areas add up to the facet's as the
/// input has it, which is the same once more by numbers. Segments within the facet are edges of its triangles, nodes lie
/// on its plane, and no tetrahedron has all four nodes on one facet. Checked: facets and their triangles. Worst: the
/// largest distance of a node from its facet's plane.
pub fn facets(ev: &Evidence, solid: &Solid, walls: &[Wall]) -> (Check, Planes) {
    let mut tally = Tally::highest("facets");
    let mut reach = IdVec::with_capacity(solid.facets().len());
    for (i, (triangle, wall)) in ev.mesh.triangles.iter().zip(walls).enumerate() {
        tally.count();
        let tell = |what: String| format!("{} {what}", ev.tell_triangle(ev.mesh.triangles[i].nodes));
        if triangle.facet.is_none() {
            tally.flaw(|| tell("is on no facet of the solid".into()));
        }
        if wall.copies > 1 {
            tally.flaw(|| tell(format!("is listed {} times", wall.copies)));
        } else if wall.front.is_none() && wall.back.is_none() {
            tally.flaw(|| tell("is no face of a tetrahedron".into()));
        }
    }
    for (f, facet) in solid.facets().enumerate() {
        tally.count();
        let plane = Plane::of(solid, facet, ev.reach);
        reach.push(plane.reach);
        if !ev.triangles_of.of_group(f.index()).is_empty() {
            one_facet(ev, f, facet, &plane, &mut tally);
        }
    }
    absent(ev, solid, &mut tally);
    within_facets(ev, &facets_of_nodes(ev), &mut tally);
    (tally.finish(Status::Proven), Planes { reach })
}

/// The plane of a facet.
struct Plane {
    origin: [f64; 3],
    normal: [f64; 3],
    reach: f64,
}

impl Plane {
    fn of(solid: &Solid, facet: &Facet, rounding: f64) -> Self {
        let [a, b, c] = facet.plane.map(|p| solid.points()[p]);
        // Three points in a row make no plane: then every height is 0, and the facet's triangles have no front.
        let normal = unit(cross(minus(b, a), minus(c, a))).unwrap_or_default();
        let plane = Self { origin: a, normal, reach: rounding };
        let points = facet.rims.iter().flatten().chain(facet.triangles.iter().flatten()).chain(&facet.inner_points);
        let off = points.map(|&p| plane.height(solid.points()[p]).abs()).fold(0.0, f64::max);
        Self { reach: off + rounding, ..plane }
    }

    fn height(&self, at: [f64; 3]) -> f64 {
        dot(minus(at, self.origin), self.normal)
    }
}

/// A facet without a triangle lies in a hole: no tetrahedron covers the middle of any of its parts.
fn absent(ev: &Evidence, solid: &Solid, tally: &mut Tally) {
    let middle = |t: &[PointId; 3]| {
        let [a, b, c] = t.map(|p| solid.points()[p]);
        [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0)
    };
    let without = solid.facets().enumerate().filter(|(f, _)| ev.triangles_of.of_group(f.index()).is_empty());
    let parts = without.flat_map(|(f, facet)| facet.triangles.iter().map(move |t| (f, middle(t))));
    let mut missing: Vec<FacetId> = covered(ev, parts.collect()).into_iter().map(|(f, _)| f).collect();
    missing.dedup();
    for f in missing {
        tally.flaw(|| format!("{} has no triangle, and lies in a region", ev.tell_facet(f)));
    }
}

fn one_facet(ev: &Evidence, f: FacetId, facet: &Facet, plane: &Plane, tally: &mut Tally) {
    let triangles = ev.triangles_of.of_group(f.index());
    for &i in triangles {
        on_plane(ev, f, i, plane, tally);
    }
    area(ev, f, facet, triangles, plane, tally);
    rims(ev, f, facet, triangles, tally);
}

fn on_plane(ev: &Evidence, f: FacetId, triangle: u32, plane: &Plane, tally: &mut Tally) {
    let nodes = ev.mesh.triangles[triangle as usize].nodes;
    let corners = nodes.map(|v| ev.node(v));
    let heights = corners.map(|p| plane.height(p).abs());
    for (height, at) in heights.into_iter().zip(corners) {
        tally.measure(height, at);
    }
    if let Some(i) = (0..3).find(|&i| heights[i] > plane.reach) {
        let (height, v) = (heights[i], nodes[i].0);
        return tally.flaw(|| {
            let triangle = ev.tell_triangle(nodes);
            format!(
                "node {v} of {triangle} lies {height} off the plane of {}, more than {}",
                ev.tell_facet(f),
                plane.reach
            )
        });
    }
    let [a, b, c] = corners;
    let (u, v) = (minus(b, a), minus(c, a));
    // Nodes that may move by the reach move the area by that times the triangle's sides.
    if dot(cross(u, v), plane.normal) < -plane.reach * (length(u) + length(v)) {
        tally.flaw(|| format!("{} faces the wrong way for {}", ev.tell_triangle(nodes), ev.tell_facet(f)));
    }
}

/// Area of a triangle, and the length of its sides.
fn area_and_rim([a, b, c]: [[f64; 3]; 3]) -> (f64, f64) {
    let area = length(cross(minus(b, a), minus(c, a))) / 2.0;
    (area, distance(a, b) + distance(b, c) + distance(c, a))
}

fn area(ev: &Evidence, f: FacetId, facet: &Facet, triangles: &[u32], plane: &Plane, tally: &mut Tally) {
    let sum = |parts: &mut dyn Iterator<Item = [[f64; 3]; 3]>| {
        parts.map(area_and_rim).fold((0.0, 0.0), |(area, rim), (a, r)| (area + a, rim + r))
    };
    let points = |p: PointId| ev.solid.map_or([0.0; 3], |s| s.points()[p]);
    let (right, right_rims) = sum(&mut facet.triangles.iter().map(|t| t.map(points)));
    let (has, rims) = sum(&mut triangles.iter().map(|&i| ev.triangle(i)));
    // A node that is moved by the reach changes the area of each triangle by at most that times its sides; the rounding
    // of the sums is far below, one in the last place of the area for each triangle.
    let terms = (triangles.len() + facet.triangles.len()) as f64;
    let bound = plane.reach * (rims + right_rims) + terms * f64::EPSILON * right;
    if (has - right).abs() > bound {
        tally.flaw(|| {
            let facet = ev.tell_facet(f);
            format!("the triangles of {facet} have the area {has} instead of {right}, off by more than {bound}")
        });
    }
}

/// The edges of a facet's triangles, taken with their directions, add up to the chains of its rims.
fn rims(ev: &Evidence, f: FacetId, facet: &Facet, triangles: &[u32], tally: &mut Tally) {
    let corners = triangles.iter().map(|&i| ev.mesh.triangles[i as usize].nodes);
    let mut edges: Vec<(VertexId, VertexId, i32)> =
        corners.flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]).map(|(a, b)| undirected(a, b, 1)).collect();
    let mut own: Vec<(VertexId, VertexId)> = edges.iter().map(|e| (e.0, e.1)).collect();
    own.sort_unstable();
    own.dedup();
    let mut by_ends: Vec<(PointId, PointId, SegmentId)> = Vec::new();
    for &s in &facet.segments {
        let [a, b] = ev.solid.map_or([PointId(0); 2], |solid| solid.segments()[s].ends);
        by_ends.extend([(a, b, s), (b, a, s)]);
        for nodes in walk(ev, s) {
            let (low, high, _) = undirected(nodes[0], nodes[1], 0);
            if own.binary_search(&(low, high)).is_err() {
                let (edge, facet) = (ev.tell_edge(nodes), ev.tell_facet(f));
                tally.flaw(|| format!("{edge} of segment {} is no edge of the triangles of {facet}", s.0));
            }
        }
    }
    by_ends.sort_unstable();
    for rim in &facet.rims {
        for (&from, &to) in rim.iter().zip(rim.iter().cycle().skip(1)) {
            let i = by_ends.partition_point(|&(a, b, _)| (a, b) < (from, to));
            let Some(&(_, _, s)) = by_ends.get(i).filter(|e| (e.0, e.1) == (from, to)) else {
                tally.flaw(|| format!("{} has no segment from point {} to point {}", ev.tell_facet(f), from.0, to.0));
                continue;
            };
            let along = ev.solid.is_some_and(|solid| solid.segments()[s].ends[0] == from);
            let against = if along { -1 } else { 1 };
            edges.extend(walk(ev, s).map(|[a, b]| undirected(a, b, against)));
        }
    }
    edges.sort_unstable();
    for same in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let sum: i32 = same.iter().map(|e| e.2).sum();
        if sum != 0 {
            let what = if same.len() == 1 { "is only on one side of" } else { "does not fit the rims of" };
            tally.flaw(|| format!("{} {what} {}", ev.tell_edge([same[0].0, same[0].1]), ev.tell_facet(f)));
        }
    }
}

/// An edge with the smaller id first, and a sign that tells its direction.
fn undirected(a: VertexId, b: VertexId, sign: i32) -> (VertexId, VertexId, i32) {
    if a <= b { (a, b, sign) } else { (b, a, -sign) }
}

/// The mesh edges of a segment, in the mesh's order.
fn chain<'e>(ev: &'e Evidence, s: SegmentId) -> impl Iterator<Item = [VertexId; 2]> + use<'e> {
    ev.edges_of.of_group(s.index()).iter().map(|&i| ev.mesh.edges[i as usize].nodes)
}

/// The mesh edges of a segment, each in the direction in which it goes on from the one before, whatever its own.
fn walk<'e>(ev: &'e Evidence, s: SegmentId) -> impl Iterator<Item = [VertexId; 2]> + use<'e> {
    let mut at = ev.solid.and_then(|solid| ev.node_of[solid.segments()[s].ends[0]]);
    chain(ev, s).map(move |[a, b]| {
        let nodes = if Some(b) == at { [b, a] } else { [a, b] };
        at = Some(nodes[1]);
        nodes
    })
}

/// The facets that each node lies on, as the mesh's triangles say.
fn facets_of_nodes(ev: &Evidence) -> Grouped {
    let triangles = ev.mesh.triangles.iter().filter_map(|t| Some((t.facet?.0, t.nodes)));
    let mut pairs: Vec<(u32, u32)> = triangles.flat_map(|(f, nodes)| nodes.map(|v| (v.0, f))).collect();
    pairs.sort_unstable();
    pairs.dedup();
    Grouped::of(ev.mesh.nodes.len(), || pairs.iter().map(|&(v, f)| (v as usize, f)))
}

/// Every point of the solid is a node, and every segment a chain of edges of tetrahedra from its one end to the other,
/// its nodes on the segment and in order. Checked: points, segments, and edges that say that they lie on one. Worst: the
/// largest distance of a node from its segment.
pub fn segments(ev: &Evidence, solid: &Solid) -> Check {
    let mut tally = Tally::highest("segments");
    points(ev, solid, &mut tally);
    for (edge, is_there) in ev.mesh.edges.iter().zip(edges_of_tetrahedra(ev)) {
        tally.count();
        if edge.segment.is_none() {
            tally.flaw(|| format!("{} is on no segment of the solid", ev.tell_edge(edge.nodes)));
        } else if !is_there {
            tally.flaw(|| format!("{} is no edge of a tetrahedron", ev.tell_edge(edge.nodes)));
        }
    }
    let mut absent = Vec::new();
    for (s, segment) in solid.segments().enumerate() {
        tally.count();
        if chain(ev, s).next().is_none() {
            let [a, b] = segment.ends.map(|p| solid.points()[p]);
            absent.push((s, [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))));
            continue;
        }
        if let Some(what) = broken_chain(ev, s, segment.ends) {
            tally.flaw(|| format!("segment {} from {} {what}", s.0, place(solid.points()[segment.ends[0]])));
            continue;
        }
        on_line(ev, s, segment.ends.map(|p| solid.points()[p]), &mut tally);
    }
    for (s, at) in covered(ev, absent) {
        tally.flaw(|| format!("segment {} has no edge, and lies in a region at {}", s.0, place(at)));
    }
    tally.finish(Status::Proven)
}

fn broken_chain(ev: &Evidence, s: SegmentId, ends: [PointId; 2]) -> Option<String> {
    // A point without a node is told as such.
    let [from, to] = ends.map(|p| ev.node_of[p]);
    let mut at = from?;
    to?;
    for [a, b] in chain(ev, s) {
        if a != at {
            return Some(format!("has no edge that goes on from node {}", at.0));
        }
        at = b;
    }
    (Some(at) != to).then(|| format!("ends at node {}", at.0))
}

fn on_line(ev: &Evidence, s: SegmentId, [p, q]: [[f64; 3]; 2], tally: &mut Tally) {
    let Some(direction) = unit(minus(q, p)) else { return };
    let mut before = 0.0;
    for [_, v] in chain(ev, s) {
        let at = ev.node(v);
        let along = dot(minus(at, p), direction);
        let off = distance(minus(at, p), times(direction, along));
        tally.measure(off, at);
        if off > ev.reach {
            tally.flaw(|| format!("node {} lies {off} off segment {}, more than {}", v.0, s.0, ev.reach));
        }
        if along <= before {
            tally.flaw(|| format!("node {} at {} goes back along segment {}", v.0, place(at), s.0));
        }
        before = along;
    }
}

/// For each edge of the mesh's list whether a tetrahedron has it.
fn edges_of_tetrahedra(ev: &Evidence) -> Vec<bool> {
    let mut ends: IdVec<VertexId, bool> = vec![false; ev.mesh.nodes.len()].into();
    let mut edges: Vec<(VertexId, VertexId, usize)> = Vec::with_capacity(ev.mesh.edges.len());
    for (i, edge) in ev.mesh.edges.iter().enumerate() {
        let [a, b] = edge.nodes;
        edges.push((a.min(b), a.max(b), i));
        edge.nodes.iter().for_each(|&v| ends[v] = true);
    }
    edges.sort_unstable();
    let mut found = vec![false; edges.len()];
    for t in ev.mesh.tetrahedra.iter() {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let (low, high) = (t[i].min(t[j]), t[i].max(t[j]));
            if ends[low] && ends[high] {
                let first = edges.partition_point(|e| (e.0, e.1) < (low, high));
                let same = edges[first..].iter().take_while(|e| (e.0, e.1) == (low, high));
                same.for_each(|e| found[e.2] = true);
            }
        }
    }
    found
}

/// Every point is a node, at its very place, unless it lies in a hole: then no tetrahedron covers it.
fn points(ev: &Evidence, solid: &Solid, tally: &mut Tally) {
    let mut lone = Vec::new();
    for (p, &at) in solid.points().enumerate() {
        tally.count();
        match ev.node_of[p] {
            None => lone.push((p, at)),
            Some(v) if ev.node(v) != at => {
                let there = place(ev.node(v));
                tally.flaw(|| format!("point {} at {} is node {} at {there}", p.0, place(at), v.0));
            }
            Some(_) => {}
        }
    }
    for (p, at) in covered(ev, lone) {
        tally.flaw(|| format!("point {} at {} lies in a region, but is no node", p.0, place(at)));
    }
}

/// Those of some places that lie in a tetrahedron, its faces included.
pub fn covered<T>(ev: &Evidence, places: Vec<(T, [f64; 3])>) -> Vec<(T, [f64; 3])> {
    let within = cells_of(ev, &places.iter().map(|(_, at)| *at).collect::<Vec<_>>());
    places.into_iter().zip(within).filter(|(_, cell)| cell.is_some()).map(|(place, _)| place).collect()
}

/// The first tetrahedron that covers each of some places. Places are taken by x, so that each tetrahedron is held against
/// those of its own range alone.
pub fn cells_of(ev: &Evidence, places: &[[f64; 3]]) -> Vec<Option<TetId>> {
    let mut found = vec![None; places.len()];
    if places.is_empty() {
        return found;
    }
    let scale = libm::sqrt(ev.weight_scale);
    let mut by_x: Vec<([f64; 3], usize)> = places.iter().map(|&at| times(at, scale)).zip(0..).collect();
    by_x.sort_unstable_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    for (t, nodes) in ev.mesh.tetrahedra.enumerate() {
        let corners = nodes.map(|v| ev.signs[v]);
        let low: [f64; 3] = std::array::from_fn(|k| corners.iter().fold(f64::INFINITY, |m, p| m.min(p[k])));
        let high: [f64; 3] = std::array::from_fn(|k| corners.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p[k])));
        let first = by_x.partition_point(|(at, _)| at[0] < low[0]);
        for &(at, i) in by_x[first..].iter().take_while(|(at, _)| at[0] <= high[0]) {
            let in_box = (1..3).all(|k| low[k] <= at[k] && at[k] <= high[k]);
            if found[i].is_none() && in_box && covers(corners, at) {
                found[i] = Some(t);
            }
        }
    }
    found
}

fn covers(corners: [[f64; 3]; 4], at: [f64; 3]) -> bool {
    let turns = (0..4).map(|i| {
        let mut moved = corners;
        moved[i] = at;
        turn(moved)
    });
    let (mut positive, mut negative) = (false, false);
    for turn in turns {
        positive |= turn == Ordering::Greater;
        negative |= turn == Ordering::Less;
    }
    positive != negative
}
