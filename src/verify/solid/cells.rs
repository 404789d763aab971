//! Tetrahedra and their faces: orientation, manifold, constrained Delaunay, and what lies on either side of each facet
//! triangle.

use super::evidence::{Evidence, distance, place};
use super::faces::{FACES, Face, Faces, Side, ascending};
use super::grouped::Grouped;
use super::power::{Weighted, power_side};
use crate::geometry::space::{cross, dot, minus, plus, times};
use crate::ids::{Id, IdVec, TetId, VertexId};
use crate::threads;
use crate::verify::tally::Tally;
use crate::verify::{Check, Status};
use std::cmp::Ordering;

/// Every tetrahedron is positive, exactly: its last corner lies where the right-hand normal of the others points. Worst:
/// the smallest signed volume.
pub fn orientation(ev: &Evidence) -> Check {
    let mut tally = Tally::lowest("orientation");
    for (t, &turn) in ev.turns.enumerate() {
        tally.count();
        let corners = ev.corners(t);
        tally.measure(signed_volume(corners), corners[0]);
        match turn {
            Ordering::Greater => {}
            Ordering::Equal => tally.flaw(|| format!("{} is flat", ev.tell(t))),
            Ordering::Less => tally.flaw(|| format!("{} is inverted", ev.tell(t))),
        }
    }
    tally.finish(Status::Proven)
}

/// The volume of a tetrahedron, negative where it is inverted.
pub fn signed_volume([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    dot(cross(minus(b, a), minus(c, a)), minus(d, a)) / 6.0
}

/// What lies at a facet triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wall {
    /// The tetrahedron on the side from which the triangle is seen counter-clockwise.
    pub front: Option<TetId>,
    /// The tetrahedron on the other side.
    pub back: Option<TetId>,
    /// How many facet triangles have the same nodes, this one included.
    pub copies: usize,
}

/// What a walk through all faces finds.
pub struct FaceChecks {
    pub manifold: Check,
    pub constrained_delaunay: Check,
    /// For each facet triangle of the mesh what lies there.
    pub walls: Vec<Wall>,
    /// Faces that end a region and are on no facet.
    pub bare: Tally,
}

/// What one task finds.
struct Found {
    manifold: Tally,
    delaunay: Tally,
    bare: Tally,
    walls: Vec<(u32, Wall)>,
}

impl Found {
    fn none() -> Self {
        Self {
            manifold: Tally::highest("manifold"),
            delaunay: Tally::highest("constrained_delaunay"),
            bare: Tally::highest("volume"),
            walls: Vec::new(),
        }
    }
}

/// Walks through all faces.
///
/// *manifold*: a face has at most two tetrahedra, on opposite sides, exactly; every node has a tetrahedron. Checked:
/// faces and nodes.
///
/// *constrained_delaunay*: across every face on no facet, the far corner is not within the sphere that is orthogonal to
/// the tetrahedron with the mesh's weights. This local test is enough: the difference of two neighbouring powers is
/// linear and 0 on their common plane, so along a sight line from a tetrahedron to a node the power of the node falls
/// from one tetrahedron to the next, down to the node's own weight. Without weights n/a, and the worst depth is told: how
/// far within the sphere, in radii. Checked: faces.
pub fn walk(ev: &Evidence) -> FaceChecks {
    let faces = Faces::new(ev.mesh);
    let results = threads::map(&faces.tasks(), |task| {
        let mut found = Found::none();
        faces.visit(task.clone(), |face| look(ev, face, &mut found));
        found
    });
    let mut all = Found::none();
    let mut walls = vec![Wall::default(); ev.mesh.triangles.len()];
    for found in results {
        all.manifold.append(found.manifold);
        all.delaunay.append(found.delaunay);
        all.bare.append(found.bare);
        found.walls.into_iter().for_each(|(i, wall)| walls[i as usize] = wall);
    }
    idle_nodes(ev, &mut all.manifold);
    let mut constrained_delaunay = all.delaunay.finish(Status::Proven);
    if ev.mesh.weights.is_empty() {
        constrained_delaunay.status = Status::NotAsked;
    }
    FaceChecks { manifold: all.manifold.finish(Status::Proven), constrained_delaunay, walls, bare: all.bare }
}

fn look(ev: &Evidence, face: &Face, found: &mut Found) {
    let mut wall = Wall { copies: face.triangles.len(), ..Wall::default() };
    match *face.sides {
        [] => {}
        [one] => {
            found.manifold.count();
            *side_of(&mut wall, is_above(ev, one)) = Some(one.tetrahedron);
            if face.triangles.is_empty() {
                found.bare.flaw(|| format!("{} ends the mesh, but is on no facet", ev.tell_triangle(face.nodes)));
            }
        }
        [one, two] => {
            found.manifold.count();
            let above = [one, two].map(|side| is_above(ev, side));
            *side_of(&mut wall, above[0]) = Some(one.tetrahedron);
            *side_of(&mut wall, above[1]) = Some(two.tetrahedron);
            match above {
                [Some(a), Some(b)] if a == b => found.manifold.flaw(|| same_side(ev, face)),
                _ if face.triangles.is_empty() => {
                    same_region(ev, face, one, two, &mut found.bare);
                    delaunay(ev, one, two, &mut found.delaunay);
                }
                _ => {}
            }
        }
        [..] => {
            found.manifold.count();
            let n = face.sides.len();
            found.manifold.flaw(|| format!("{} has {n} tetrahedra", ev.tell_triangle(face.nodes)));
        }
    }
    for &i in face.triangles {
        let even = ascending(ev.mesh.triangles[i as usize].nodes).1;
        let (front, back) = if even { (wall.front, wall.back) } else { (wall.back, wall.front) };
        found.walls.push((i, Wall { front, back, ..wall }));
    }
}

/// The side of a face of ascending nodes; a flat tetrahedron counts as behind.
fn side_of(wall: &mut Wall, above: Option<bool>) -> &mut Option<TetId> {
    if above == Some(true) { &mut wall.front } else { &mut wall.back }
}

/// Whether a tetrahedron lies on the side from which the ascending nodes of its face are seen counter-clockwise; `None` of
/// a flat one. Exact: its orientation is.
fn is_above(ev: &Evidence, side: Side) -> Option<bool> {
    let corners = ev.mesh.tetrahedra[side.tetrahedron];
    let outward_ascends = ascending(FACES[side.corner].map(|i| corners[i])).1;
    match ev.turns[side.tetrahedron] {
        Ordering::Greater => Some(!outward_ascends),
        Ordering::Less => Some(outward_ascends),
        Ordering::Equal => None,
    }
}

fn same_side(ev: &Evidence, face: &Face) -> String {
    let [one, two] = [0, 1].map(|i| ev.tell(face.sides[i].tetrahedron));
    format!("{one} and {two} lie on the same side of {}", ev.tell_triangle(face.nodes))
}

fn same_region(ev: &Evidence, face: &Face, one: Side, two: Side, tally: &mut Tally) {
    let [a, b] = [one, two].map(|side| ev.mesh.tetrahedron_regions[side.tetrahedron]);
    if a != b {
        tally.flaw(|| format!("{} parts two regions, but is on no facet", ev.tell_triangle(face.nodes)));
    }
}

fn delaunay(ev: &Evidence, one: Side, two: Side, tally: &mut Tally) {
    tally.count();
    let far = ev.mesh.tetrahedra[two.tetrahedron][two.corner];
    let weighted =
        |v: VertexId| -> Weighted { (ev.signs[v], ev.mesh.weights.get(v).map_or(0.0, |w| w * ev.weight_scale)) };
    let tetrahedron = ev.mesh.tetrahedra[one.tetrahedron].map(weighted);
    // Within: negative for a positive tetrahedron. A flat one has no sphere, and is told elsewhere.
    let within = match ev.turns[one.tetrahedron] {
        Ordering::Greater => Ordering::Less,
        Ordering::Less => Ordering::Greater,
        Ordering::Equal => return,
    };
    if power_side(tetrahedron, weighted(far)) != within {
        return;
    }
    // The test is the same from either side; the depth is not.
    for (near, other) in [(one, two), (two, one)] {
        let far = ev.node(ev.mesh.tetrahedra[other.tetrahedron][other.corner]);
        tally.measure(depth(ev.corners(near.tetrahedron), far), far);
    }
    if !ev.mesh.weights.is_empty() {
        tally.flaw(|| {
            let [one, two] = [one, two].map(|side| ev.tell(side.tetrahedron));
            format!("node {} of {two} is within the sphere of {one}", far.0)
        });
    }
}

/// How far a place is within the sphere of a tetrahedron, in radii; rounded, negative outside.
fn depth([a, b, c, d]: [[f64; 3]; 4], at: [f64; 3]) -> f64 {
    let [u, v, w] = [b, c, d].map(|p| minus(p, a));
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let sum = plus(plus(times(vw, dot(u, u)), times(wu, dot(v, v))), times(uv, dot(w, w)));
    let centre = times(sum, 0.5 / dot(u, vw));
    1.0 - distance(minus(at, a), centre) / distance(centre, [0.0; 3])
}

fn idle_nodes(ev: &Evidence, tally: &mut Tally) {
    let mut used: IdVec<VertexId, bool> = vec![false; ev.mesh.nodes.len()].into();
    ev.mesh.tetrahedra.iter().flatten().for_each(|&v| used[v] = true);
    for (v, _) in used.enumerate().filter(|(_, used)| !**used) {
        tally.count();
        tally.flaw(|| format!("node {} at {} belongs to no tetrahedron", v.0, place(ev.node(v))));
    }
}

/// Every weight is at least 0 and at most [`WEIGHT_BOUND`] of the squared distance to the nearest node along the edges of
/// the mesh. Worst: the largest share.
///
/// Edges are enough where nothing hides the nearest node u of v: for any other node x, with |xv| ≥ |uv|, the power of x in
/// the ball over vu is (x−v)·(x−u) ≥ |xu|²/2, more than such a weight, so vu is an edge of the regular triangulation. A
/// nearer node behind a facet is no neighbour of v's tetrahedra, and no test across a face asks for it.
pub fn weights(ev: &Evidence) -> Check {
    if ev.mesh.weights.is_empty() {
        return Check::not_asked("weights");
    }
    let mut nearest: IdVec<VertexId, f64> = vec![f64::INFINITY; ev.mesh.nodes.len()].into();
    for t in ev.mesh.tetrahedra.iter() {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let away = minus(ev.node(t[i]), ev.node(t[j]));
            for v in [t[i], t[j]] {
                nearest[v] = nearest[v].min(dot(away, away));
            }
        }
    }
    let mut tally = Tally::highest("weights");
    for (v, &weight) in ev.mesh.weights.enumerate() {
        tally.count();
        let share = weight / nearest[v];
        if share.is_finite() {
            tally.measure(share, ev.node(v));
        }
        // The squared distance errs by five roundings at most.
        let bound = WEIGHT_BOUND * (1.0 + 8.0 * f64::EPSILON) * nearest[v];
        if !(0.0..=bound).contains(&weight) {
            tally.flaw(|| format!("node {} has weight {weight}, {share} of the squared distance to the nearest", v.0));
        }
    }
    tally.finish(Status::Proven)
}

/// The largest share of the squared distance to the nearest node that a weight may have.
pub const WEIGHT_BOUND: f64 = 1e-6;

/// No tetrahedron has its four nodes on one facet. Adds to *facets*; `on` lists the facets of each node, ascending.
pub fn within_facets(ev: &Evidence, on: &Grouped, tally: &mut Tally) {
    for (t, nodes) in ev.mesh.tetrahedra.enumerate() {
        let [a, b, c, d] = nodes.map(|v| on.of_group(v.index()));
        if a.is_empty() || b.is_empty() || c.is_empty() || d.is_empty() {
            continue;
        }
        let has = |list: &[u32], f: &u32| list.binary_search(f).is_ok();
        if let Some(&f) = a.iter().find(|f| has(b, f) && has(c, f) && has(d, f)) {
            tally
                .flaw(|| format!("{} has its four nodes on {}", ev.tell(t), ev.tell_facet(Id::from_index(f as usize))));
        }
    }
}
