//! Orientation, manifoldness, and whether the mesh conforms to the domain.

use super::circles::Circles;
use super::edges::Edge;
use super::evidence::{CurvePart, Evidence, is_kept, place};
use super::tally::Tally;
use super::{Check, Status};
use crate::domain::Domain;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Rect, bounds_of};
use crate::ids::{Id, PointId, VertexId};
use crate::mesh::quality;

/// Every triangle runs counter-clockwise, by exact signs. Worst: the smallest signed area.
pub fn orientation(ev: &Evidence) -> Check {
    let mut tally = Tally::lowest("orientation");
    for (t, corners) in ev.mesh.triangles.enumerate() {
        tally.count();
        tally.measure(quality::area(ev.mesh.corners(t)), ev.node(corners[0]));
        let [a, b, c] = corners.map(|v| ev.signs[v]);
        match orient(a, b, c) {
            Orientation::CounterClockwise => {}
            Orientation::Clockwise => tally.flaw(|| format!("{} runs clockwise", ev.tell(t))),
            Orientation::Collinear => tally.flaw(|| format!("{} has no area", ev.tell(t))),
        }
    }
    tally.finish(Status::Proven)
}

/// Every edge has at most one triangle on either side, and no triangle has a node twice. Regions may touch in a node.
/// Checked: edges.
pub fn manifold(ev: &Evidence) -> Check {
    let mut tally = Tally::highest("manifold");
    ev.edges.edges().iter().for_each(|_| tally.count());
    for &t in &ev.edges.collapsed {
        tally.flaw(|| format!("{} names a node twice", ev.tell(t)));
    }
    for side in &ev.edges.surplus {
        let corners = ev.mesh.triangles[side.triangle];
        let nodes = [corners[side.corner], corners[(side.corner + 1) % 3]];
        let what = "lies on a side where another triangle lies already";
        tally.flaw(|| format!("{} {what}: {}", ev.tell(side.triangle), ev.tell_edge(nodes)));
    }
    tally.finish(Status::Proven)
}

/// The edges at which a region ends are exactly the chords of the curves, each with its regions on the right sides, and
/// no two chords cross. Every point of P in a kept region is a node. In a mesh of ours every node has a triangle. A
/// hanging node is found as well: it leaves an edge that ends a region on no curve. Checked: chords, other edges that
/// end a region, and points.
///
/// ```text
///        A
///   ● ──────▶ ● ──────▶ ●     asked: A and B, the regions on the left and right of the curve;
///        B                    has: those of the triangles at each of its chords. Both must be equal.
/// ```
pub fn conforming(ev: &Evidence, domain: &Domain, circles: &Circles) -> Check {
    let mut tally = Tally::highest("conforming");
    let mut on_curve = vec![false; ev.edges.edges().len()];
    for part in &ev.parts {
        chord(ev, domain, part, &mut on_curve, &mut tally);
    }
    for (edge, _) in ev.edges.edges().iter().zip(&on_curve).filter(|(_, on_curve)| !**on_curve) {
        if ends_a_region(ev, edge) {
            tally.count();
            tally.flaw(|| format!("{} ends a region, but lies on no curve", ev.tell_edge(edge.nodes)));
        }
    }
    circles.tell_crossings(ev, &mut tally);
    missing_points(ev, domain, &mut tally);
    if !ev.promise.foreign {
        idle_nodes(ev, &mut tally);
    }
    tally.finish(Status::Proven)
}

fn chord(ev: &Evidence, domain: &Domain, part: &CurvePart, on_curve: &mut [bool], tally: &mut Tally) {
    tally.count();
    let Some(place) = part.edge else {
        return tally
            .flaw(|| format!("curve {} asks for {}, which no triangle has", part.curve.0, ev.tell_edge(part.nodes)));
    };
    if std::mem::replace(&mut on_curve[place], true) {
        return tally.flaw(|| format!("{} lies on two curves", ev.tell_edge(part.nodes)));
    }
    let asked = domain.curves()[part.curve].sides.map(|r| r.map(|r| ev.classes.of_domain[r]));
    let has = sides(ev, &ev.edges.edges()[place], part.nodes);
    if asked != has {
        let name = |class: Option<u32>| class.map_or("nothing", |c| ev.classes.names[c as usize].as_str());
        tally.flaw(|| {
            let ([left, right], [to_left, to_right]) = (has.map(name), asked.map(name));
            let edge = ev.tell_edge(part.nodes);
            format!(
                "{edge} has {left} on its left and {right} on its right; curve {} has {to_left} and {to_right}",
                part.curve.0
            )
        });
    }
}

/// Classes on the left and right of an edge, in the direction from `nodes[0]` to `nodes[1]`.
fn sides(ev: &Evidence, edge: &Edge, nodes: [VertexId; 2]) -> [Option<u32>; 2] {
    let [left, right] = [edge.left(), edge.right()].map(|side| side.map(|s| ev.class(s.triangle)));
    if nodes == edge.nodes { [left, right] } else { [right, left] }
}

/// Whether an edge has different classes on its two sides, or a triangle on one side only.
pub fn ends_a_region(ev: &Evidence, edge: &Edge) -> bool {
    let [left, right] = sides(ev, edge, edge.nodes);
    left != right
}

/// Reports points that must be nodes but are none: ends of kept curves, and points without curves that a triangle
/// covers.
fn missing_points(ev: &Evidence, domain: &Domain, tally: &mut Tally) {
    let node = ev.nodes_of_points(domain);
    let mut lone = Vec::new();
    for (p, &at) in domain.points().enumerate() {
        tally.count();
        let kept = domain.star(p).iter().any(|i| is_kept(domain.curves()[i.curve].sides));
        if node[p].is_none() && kept {
            tally.flaw(|| format!("point {} at {} is no node", p.0, place(at)));
        } else if node[p].is_none() && domain.star(p).is_empty() {
            lone.push(p);
        }
    }
    // A lone point may be a node of a foreign mesh although it is not listed.
    let covered = |p: PointId, corners: [Point; 3]| {
        let at = domain.points()[p];
        covers(corners, at)
            && !(ev.promise.foreign && corners.iter().any(|c| c.distance(at) <= domain.tolerance() + ev.rounding))
    };
    for p in covered_by_a_triangle(ev, domain, &lone, covered) {
        tally.flaw(|| format!("point {} at {} lies in a region, but is no node", p.0, place(domain.points()[p])));
    }
}

fn covered_by_a_triangle(
    ev: &Evidence,
    domain: &Domain,
    points: &[PointId],
    covers: impl Fn(PointId, [Point; 3]) -> bool,
) -> Vec<PointId> {
    let hierarchy =
        BoxHierarchy::new(points.iter().map(|&p| Rect::from_points(domain.points()[p], domain.points()[p])));
    let mut covered = vec![false; points.len()];
    for t in ev.mesh.triangles.ids().take(if points.is_empty() { 0 } else { usize::MAX }) {
        let corners = ev.mesh.corners(t);
        if let Some(around) = bounds_of(corners) {
            hierarchy.meeting(around, |i| {
                covered[i] |= covers(points[i], corners);
                true
            });
        }
    }
    points.iter().zip(covered).filter(|(_, covered)| *covered).map(|(&p, _)| p).collect()
}

/// Whether a point lies in a triangle, its border included.
fn covers([a, b, c]: [Point; 3], p: Point) -> bool {
    [(a, b), (b, c), (c, a)].iter().all(|&(x, y)| orient(x, y, p) != Orientation::Clockwise)
}

fn idle_nodes(ev: &Evidence, tally: &mut Tally) {
    let mut used = vec![false; ev.mesh.nodes.len()];
    let cells = ev.mesh.triangles.iter().chain(ev.mesh.triangle_mids.iter());
    cells.flatten().for_each(|v| used[v.index()] = true);
    for v in ev.mesh.nodes.ids().filter(|v| !used[v.index()]) {
        tally.count();
        tally.flaw(|| format!("node {} at {} belongs to no triangle", v.0, place(ev.node(v))));
    }
}
