//! The Delaunay property, the angles of the triangles, and which small ones are exempt.

use super::balls::SoundBall;
use super::evidence::Evidence;
use super::tally::Tally;
use super::{Check, Exemption, Status};
use crate::domain::Domain;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{CircleSide, in_circle};
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, PointId, TriangleId, VertexId};
use crate::mesh::quality::angle_range;
use crate::promise::{ANGLE_RULE_GUARANTEE_RAD, ConstrainedPromise, EnginePromise, LoppingPromise, guaranteed_angle};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// Whether theory covers κ for this domain: a bound that holds is then proven, else reached.
fn status_of_angle_bound(ev: &Evidence, kappa: f64) -> Status {
    // Theory covers neither a mesh from elsewhere nor triangles that are not refined because of their size.
    let ours = ev.domain.filter(|_| !ev.promise.foreign && ev.promise.sizing.min_edge.is_none());
    let proven = match &ev.promise.engine {
        EnginePromise::Lopping(lopping) => ours.is_some_and(|domain| kappa < covered(lopping, domain)),
        EnginePromise::Constrained(constrained) => ours.is_some_and(|domain| is_covered(constrained, domain)),
    };
    if proven { Status::Proven } else { Status::Reached }
}

/// The κ (radians) below which corner lopping is proven on a domain.
fn covered(lopping: &LoppingPromise, domain: &Domain) -> f64 {
    let lens = domain.curves().iter().map(|c| c.curve.lens_angle(0.0, 1.0)).fold(0.0, f64::max);
    let arcs = lopping.arc_turning_rad.filter(|_| domain.points().ids().any(|p| domain.is_acute(p)));
    // A circular arc's lens angle is half its turning.
    let lens = lens.max(0.5 * arcs.unwrap_or(0.0));
    match lopping.midpoint_bisector {
        true => guaranteed_angle(lens),
        false if lens == 0.0 => ANGLE_RULE_GUARANTEE_RAD,
        false => 0.0,
    }
}

/// Whether constrained refinement proves its angle on a domain: it has only segments, and all their angles are above
/// the bound.
fn is_covered(constrained: &ConstrainedPromise, domain: &Domain) -> bool {
    let Some(least) = constrained.proven_above_rad else { return false };
    let corners = domain.points().ids().filter_map(|p| domain.corner(p));
    domain.curves().iter().all(|c| c.curve.is_straight())
        // An angle equal to the bound but for rounding is not above it.
        && corners.map(|corner| corner.angle_rad).all(|angle| angle > least + 1e-9)
}

/// At every edge with two triangles the corner `across` lies not inside the circle of the triangle of `apex`, by exact
/// signs. Where the mesh is constrained Delaunay, edges on curves are exempt. Checked: edges with two triangles. Worst:
/// the largest sum of the two angles that face an edge, in degrees (180 where all four corners lie on a circle).
///
/// ```text
///         apex
///       .´ α  `.        facing: α + β, in degrees
///     .´        `.      < 180: across lies outside the circle of x y apex
///   x ──────────── y    = 180: all four lie on one circle
///     `.        .´      > 180: it lies inside, and the edge is flawed
///       `. β  .´
///        across
/// ```
pub fn delaunay(ev: &Evidence) -> Check {
    let constrained = ev.promise.is_constrained();
    let mut tally = Tally::highest(if constrained { "constrained_delaunay" } else { "delaunay" });
    let mut on_curve = vec![false; if constrained { ev.edges.edges().len() } else { 0 }];
    if constrained {
        ev.parts.iter().filter_map(|part| part.edge).for_each(|edge| on_curve[edge] = true);
    }
    for (i, edge) in ev.edges.edges().iter().enumerate() {
        let (Some(left), Some(right)) = (edge.left(), edge.right()) else { continue };
        if constrained && on_curve[i] {
            tally.exempt();
            continue;
        }
        tally.count();
        let apex = ev.mesh.triangles[left.triangle][(left.corner + 2) % 3];
        let across = ev.mesh.triangles[right.triangle][(right.corner + 2) % 3];
        let at = ev.node(edge.nodes[0]);
        tally.measure(facing(edge.nodes.map(|v| ev.node(v)), ev.node(apex), ev.node(across)), at);
        let [x, y] = edge.nodes.map(|v| ev.signs[v]);
        if in_circle(x, y, ev.signs[apex], ev.signs[across]) == CircleSide::Inside {
            tally.flaw(|| {
                format!(
                    "node {} lies inside the circle of {} across {}",
                    across.0,
                    ev.tell(left.triangle),
                    ev.tell_edge(edge.nodes)
                )
            });
        }
    }
    tally.finish(Status::Proven)
}

/// Sum of the angles at `a` and `b` that face the edge `x y` from its left and right, in degrees.
fn facing([x, y]: [Point; 2], a: Point, b: Point) -> f64 {
    let (at_a, at_b) = (((x - a).cross(y - a), (x - a).dot(y - a)), ((y - b).cross(x - b), (y - b).dot(x - b)));
    // The angle of a product of complex numbers is the sum of their angles, here within 0..2π.
    let (sin, cos) = (at_a.0 * at_b.1 + at_a.1 * at_b.0, at_a.1 * at_b.1 - at_a.0 * at_b.0);
    let angle = libm::atan2(sin, cos).to_degrees();
    if angle < -90.0 { angle + 360.0 } else { angle }
}

/// Engine and verifier compute an angle by different formulas, each with an error of a few ε times at most 1/κ.
/// Radians.
const ANGLE: f64 = 1e-12;

/// If κ is asked for: every triangle has all angles ≥ κ, or a corner exempts it (Lemma 6; with corner arcs: all three
/// of its nodes lie in one ball). Worst: the smallest angle of a triangle that is not exempt, in degrees. Also returns
/// the exemptions, by ball.
///
/// ```text
///             x.                                          a
///           ╱   `.                                      ╱ │`.
///         ╱   ·c  :                                   q   │ t c
///       ╱  t     :                                      ╲ │.´
///     p ──────── y                                        b
///
///   Corner lopping: the circumcenter c of t      Constrained refinement: the shortest edge a b of t
///   lies in B(p); with corner arcs: all          lies across the sharp corner q, |qa| = |qb|
///   corners of t lie in B(p)
/// ```
pub fn min_angle(ev: &Evidence, balls: &[SoundBall]) -> (Check, Vec<Exemption>) {
    let Some(kappa) = ev.promise.angle_min_rad else { return (Check::not_asked("min_angle"), Vec::new()) };
    let mut tally = Tally::lowest("min_angle");
    let corners = Corners::new(ev, balls);
    let across = ev.domain.filter(|_| ev.promise.is_constrained()).map(|domain| AcrossCorners::new(ev, domain));
    let mut input_angles: BTreeMap<PointId, Vec<u32>> = BTreeMap::new();
    let mut cells: Vec<Vec<u32>> = vec![Vec::new(); balls.len()];
    let mut too_small = Vec::new();
    for t in ev.mesh.triangles.ids() {
        tally.count();
        let (least, _) = angle_range(ev.mesh.corners(t));
        if least < kappa - ANGLE {
            if let Some(ball) = corners.exemption(t) {
                cells[ball].push(t.0);
                continue;
            }
            if let Some(corner) = across.as_ref().and_then(|across| across.exemption(t)) {
                input_angles.entry(corner).or_default().push(t.0);
                continue;
            }
            if is_below_min_edge(ev, t) {
                too_small.push(t);
                continue;
            }
            tally.flaw(|| format!("{} has an angle of {}°", ev.tell(t), least.to_degrees()));
        }
        tally.measure(least.to_degrees(), ev.node(ev.mesh.triangles[t][0]));
    }
    let by_ball = balls.iter().zip(cells).filter(|(_, cells)| !cells.is_empty());
    let mut exempt: Vec<Exemption> = by_ball
        .map(|(b, cells)| Exemption { at: [b.center.x, b.center.y], radius: b.radius, why: b.why, cells })
        .collect();
    exempt.extend(across.iter().flat_map(|across| across.exemptions(&input_angles)));
    exempt.extend(exemption_of_min_edge(ev, &too_small));
    (tally.finish(status_of_angle_bound(ev, kappa)), exempt)
}

/// If κ is asked for: the radius-edge ratio of every triangle that is not exempt is at most that of κ, 1/(2 sin κ).
/// Worst: the largest.
pub fn radius_edge(ev: &Evidence, exempt: &[Exemption]) -> Check {
    let Some(kappa) = ev.promise.angle_min_rad else { return Check::not_asked("radius_edge") };
    let mut tally = Tally::highest("radius_edge");
    let mut is_exempt = vec![false; ev.mesh.triangles.len()];
    exempt.iter().flat_map(|e| &e.cells).for_each(|&t| is_exempt[TriangleId(t).index()] = true);
    let limit = 0.5 / libm::sin(kappa - ANGLE);
    for t in ev.mesh.triangles.ids().filter(|t| !is_exempt[t.index()]) {
        tally.count();
        let ratio = 0.5 / libm::sin(angle_range(ev.mesh.corners(t)).0);
        tally.measure(ratio, ev.centroid(t));
        if ratio > limit {
            tally.flaw(|| format!("{} has a radius-edge ratio of {ratio}", ev.tell(t)));
        }
    }
    tally.finish(status_of_angle_bound(ev, kappa))
}

/// Sharp corners of the domain, and which nodes lie on the curves that meet there.
struct AcrossCorners<'a> {
    ev: &'a Evidence<'a>,
    domain: &'a Domain,
    /// Curves at each node, ascending.
    at_nodes: Vec<(VertexId, CurveId)>,
}

impl<'a> AcrossCorners<'a> {
    fn new(ev: &'a Evidence<'a>, domain: &'a Domain) -> Self {
        let mut at_nodes: Vec<_> = ev.parts.iter().flat_map(|p| p.nodes.map(|v| (v, p.curve))).collect();
        at_nodes.sort_unstable();
        at_nodes.dedup();
        Self { ev, domain, at_nodes }
    }

    fn curves(&self, v: VertexId) -> Vec<CurveId> {
        let first = self.at_nodes.partition_point(|&(w, _)| w < v);
        self.at_nodes[first..].iter().take_while(|&&(w, _)| w == v).map(|&(_, curve)| curve).collect()
    }

    /// The sharp corner that exempts a triangle: its shortest edge lies across it, with ends equally far from it. So
    /// its smallest angle is that of the drawing.
    fn exemption(&self, t: TriangleId) -> Option<PointId> {
        let [a, b, c] = self.ev.mesh.triangles[t];
        let length = |e: &[VertexId; 3]| self.ev.node(e[0]).distance(self.ev.node(e[1]));
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        // Of edges that are equal but for rounding the engine may have chosen any.
        let least = turns.iter().map(length).fold(f64::INFINITY, f64::min) * (1.0 + 1e-9);
        turns.into_iter().filter(|turn| length(turn) <= least).find_map(|turn| {
            let [a, b, c] = turn.map(|v| self.curves(v));
            self.domain.corner_between([&a, &b, &c], [0, 1].map(|i| self.ev.node(turn[i])))
        })
    }

    fn exemptions(&self, cells: &BTreeMap<PointId, Vec<u32>>) -> Vec<Exemption> {
        let exemption = |(&corner, cells): (&PointId, &Vec<u32>)| {
            let at = self.domain.points()[corner];
            let nodes = cells.iter().flat_map(|&t| self.ev.mesh.corners(TriangleId(t)));
            let radius = nodes.map(|p| p.distance(at)).fold(0.0, f64::max);
            Exemption { at: [at.x, at.y], radius, why: "input_angle", cells: cells.clone() }
        };
        cells.iter().map(exemption).collect()
    }
}

/// Whether a triangle is not refined for its angles because its circumradius is below `min_edge`, as the user asked.
fn is_below_min_edge(ev: &Evidence, t: TriangleId) -> bool {
    let limit = ev.promise.sizing.min_edge.unwrap_or(0.0);
    Circle::around(ev.mesh.corners(t)).is_some_and(|c| c.radius <= limit)
}

fn exemption_of_min_edge(ev: &Evidence, too_small: &[TriangleId]) -> Option<Exemption> {
    let at = ev.centroid(*too_small.first()?);
    let radius = ev.promise.sizing.min_edge?;
    Some(Exemption { at: [at.x, at.y], radius, why: "min_edge", cells: too_small.iter().map(|t| t.0).collect() })
}

/// With corner arcs: no angle of any triangle, exempt or not, is above max(180° − 2κ, 90°) (section 6). Worst in
/// degrees.
pub fn max_angle(ev: &Evidence) -> Check {
    let Some(kappa) = ev.promise.angle_min_rad.filter(|_| ev.promise.has_corner_arcs()) else {
        return Check::not_asked("max_angle");
    };
    let mut tally = Tally::highest("max_angle");
    let limit = (PI - 2.0 * kappa).max(FRAC_PI_2) + ANGLE;
    for t in ev.mesh.triangles.ids() {
        let corners = ev.mesh.corners(t);
        let (_, most) = angle_range(corners);
        // Nodes that are each rounded by `rounding` turn an edge of length l by 2·rounding/l. At a cusp that is
        // decisive.
        let slack = || 2.0 * ev.rounding / shortest_edge(corners);
        if most > limit && is_below_min_edge(ev, t) {
            tally.exempt();
            continue;
        }
        tally.count();
        tally.measure(most.to_degrees(), ev.node(ev.mesh.triangles[t][0]));
        if most > limit && most > limit + slack() {
            tally.flaw(|| format!("{} has an angle of {}°", ev.tell(t), most.to_degrees()));
        }
    }
    tally.finish(status_of_angle_bound(ev, kappa))
}

fn shortest_edge([a, b, c]: [Point; 3]) -> f64 {
    a.distance(b).min(b.distance(c)).min(c.distance(a))
}

/// The balls, with a search by place.
struct Corners<'a> {
    ev: &'a Evidence<'a>,
    balls: &'a [SoundBall],
    hierarchy: BoxHierarchy,
}

/// Engine and verifier each round a circumcenter. 1e-9 of the radius is above both errors for angles down to 1e-6; a
/// thinner triangle adds the error of its own circle.
const CENTER: f64 = 1e-9;

impl<'a> Corners<'a> {
    fn new(ev: &'a Evidence<'a>, balls: &'a [SoundBall]) -> Self {
        let boxes = balls.iter().map(|b| {
            let side = 2.0 * (b.radius * (1.0 + CENTER) + ev.rim);
            Rect::from_center_size(b.center, (side, side))
        });
        Self { ev, balls, hierarchy: BoxHierarchy::new(boxes) }
    }

    /// The ball that exempts a triangle.
    fn exemption(&self, t: TriangleId) -> Option<usize> {
        let corners = self.ev.mesh.corners(t);
        if self.ev.promise.has_corner_arcs() { self.holding(&corners) } else { self.over(Circle::around(corners)?) }
    }

    /// The ball in which all corners lie, up to the rounding of nodes that were placed on its rim.
    fn holding(&self, corners: &[Point; 3]) -> Option<usize> {
        // 1e-12 as for the radius itself, and the rounding of points on the rim.
        let reach = |ball: &SoundBall| ball.radius * (1.0 + 1e-12) + self.ev.rim;
        self.find(Rect::from_points(corners[0], corners[0]), |ball| {
            corners.iter().all(|c| c.distance(ball.center) <= reach(ball))
        })
    }

    /// The open ball in which the centre of a circle lies, up to rounding.
    fn over(&self, circle: Circle) -> Option<usize> {
        let at = circle.center;
        self.find(Rect::from_points(at, at).inflate(circle.error, circle.error), |ball| {
            at.distance(ball.center) < ball.radius * (1.0 + CENTER) + circle.error
        })
    }

    fn find(&self, near: Rect, holds: impl Fn(&SoundBall) -> bool) -> Option<usize> {
        let mut found = None;
        self.hierarchy.meeting(near, |i| {
            if holds(&self.balls[i]) {
                found = Some(i);
            }
            found.is_none()
        });
        found
    }
}

/// A triangle's circumcircle, and how far rounding may have moved its centre.
struct Circle {
    center: Point,
    radius: f64,
    error: f64,
}

impl Circle {
    /// `None` where the corners lie on a line.
    fn around([a, b, c]: [Point; 3]) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let (uu, vv, cross) = (u.hypot2(), v.hypot2(), u.cross(v));
        let to_center = crate::geometry::Vec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / (2.0 * cross);
        let radius = to_center.hypot();
        let (least, _) = angle_range([a, b, c]);
        // The cross product of edges that meet at an angle θ has a relative error of a few ε/sin θ, and the centre one
        // of as much of the radius.
        let error = 16.0 * f64::EPSILON * radius / libm::sin(least).abs();
        (radius.is_finite() && error.is_finite()).then_some(Self { center: a + to_center, radius, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_passes_through_its_triangle_wherever_it_lies() {
        for (scale, offset) in [(1.0, 0.0), (1e-6, 1.0), (1e7, -1e9)] {
            let at = |x: f64, y: f64| Point::new(offset + scale * x, offset + scale * y);
            let corners = [at(0.0, 0.0), at(1.0, 0.0), at(0.3, 0.01)];
            let circle = Circle::around(corners).unwrap();
            for c in corners {
                approx::assert_relative_eq!(c.distance(circle.center), circle.radius, max_relative = 1e-8);
            }
        }
        assert!(Circle::around([Point::ZERO, Point::new(1.0, 1.0), Point::new(2.0, 2.0)]).is_none());
    }
}
