//! Protecting balls around acute corners: B(p), open, of radius d(p) (Pav & Walkington 2005, section 3).
//!
//! At birth d(p) = (√2−1)·lfs₀(p), capped so that what lies inside, which is never refined, meets the size limits. A ball then only
//! shrinks, by β, when a vertex of a curve that does not end at p comes in. The closed balls never meet.

use crate::curve::{Curve, End};
use crate::domain::{Domain, Incident};
use crate::geometry::{Point, Rect, boxes::BoxHierarchy};
use crate::ids::{BallId, IdVec, PieceId, PointId, TriangleId, VertexId};
use crate::mesh::BallReason;
use crate::size::SizeField;

/// A ball that stands.
#[derive(Clone, Debug)]
pub struct Ball {
    pub corner: PointId,
    pub center: Point,
    pub radius: f64,
    pub why: BallReason,
    /// The spoke of each incident curve, counter-clockwise as in the domain's star.
    pub spokes: Vec<PieceId>,
    /// Distance of the nearest vertex that came in since the last shrinking.
    pub intruder: f64,
    /// Corner arcs as placed; empty while they wait to be placed.
    pub arcs: Vec<Curve>,
    /// Live pieces of those arcs.
    pub arc_pieces: Vec<PieceId>,
    /// Triangles that this ball excused when they were last looked at (their circumcenters lay in it).
    pub excused: Vec<(TriangleId, [VertexId; 3])>,
}

/// All balls, and who has one.
pub struct Balls {
    balls: IdVec<BallId, Ball>,
    of_point: IdVec<PointId, Option<BallId>>,
    /// Boxes of the balls at birth: radii only shrink.
    index: BoxHierarchy,
}

impl Balls {
    /// Balls at every acute corner of a domain.
    pub fn at_birth(domain: &Domain, field: &SizeField) -> Self {
        let lfs0 = domain.lfs0();
        let mut balls = IdVec::new();
        let mut of_point = IdVec::with_capacity(domain.points().len());
        for (p, &center) in domain.points().enumerate() {
            let acute = domain.is_acute(p);
            let ball = acute.then(|| {
                let (radius, why) = radius_at_birth(domain, field, p, lfs0[p]);
                balls.push(Ball {
                    corner: p,
                    center,
                    radius,
                    why,
                    spokes: Vec::new(),
                    intruder: f64::INFINITY,
                    arcs: Vec::new(),
                    arc_pieces: Vec::new(),
                    excused: Vec::new(),
                })
            });
            of_point.push(ball);
        }
        let index = BoxHierarchy::new(balls.iter().map(box_of));
        Self { balls, of_point, index }
    }

    pub fn of_point(&self, p: PointId) -> Option<BallId> {
        self.of_point[p]
    }

    pub fn get(&self, id: BallId) -> &Ball {
        &self.balls[id]
    }

    pub fn get_mut(&mut self, id: BallId) -> &mut Ball {
        &mut self.balls[id]
    }

    pub fn ids(&self) -> impl DoubleEndedIterator<Item = BallId> + use<> {
        self.balls.ids()
    }

    /// The ball that holds a place, and the place's distance from its corner. The balls are disjoint: there is at most one.
    pub fn holding(&self, at: Point) -> Option<(BallId, f64)> {
        let mut held = None;
        self.index.meeting(Rect::from_points(at, at), |i| {
            let id = BallId(i as u32);
            let away = at.distance(self.balls[id].center);
            if away < self.balls[id].radius {
                held = Some((id, away));
            }
            held.is_none()
        });
        held
    }

    /// The ball that wholly holds the corners of a triangle, border included up to the rounding of points on it.
    pub fn holding_all(&self, corners: [Point; 3], rounding: f64) -> Option<BallId> {
        let mut held = None;
        self.index.meeting(Rect::from_points(corners[0], corners[0]).inflate(rounding, rounding), |i| {
            let id = BallId(i as u32);
            let ball = &self.balls[id];
            let reach = ball.radius + rounding;
            if corners.iter().all(|c| c.distance(ball.center) <= reach) {
                held = Some(id);
            }
            held.is_none()
        });
        held
    }
}

fn box_of(ball: &Ball) -> Rect {
    // Points on the border are rounded: a box a hair larger holds them.
    let r = ball.radius * (1.0 + 1e-9);
    let c = ball.center;
    Rect::new(c.x - r, c.y - r, c.x + r, c.y + r)
}

/// d(p) at birth, and what decided it.
fn radius_at_birth(domain: &Domain, field: &SizeField, p: PointId, lfs0: f64) -> (f64, BallReason) {
    let by_features = (std::f64::consts::SQRT_2 - 1.0) * lfs0;
    let mut radius = by_features.min(radius_by_size(domain, field, p));
    // Spokes are mesh edges: shorten them until each turns little enough and lies near enough to its curve. A curve that is smooth at
    // its end straightens as it shortens, so this ends; 200 steps are a factor of 1e-19.
    for _ in 0..200 {
        let bent = domain.star(p).iter().any(|&at| spoke_too_bent(domain, field, at, radius));
        if !bent {
            break;
        }
        radius *= 0.8;
    }
    (radius, if radius < by_features { BallReason::Size } else { BallReason::LocalFeatureSize })
}

/// The largest radius whose triangles meet the size limits. A triangle with its circumcenter in B(p) has a circumradius below d(p),
/// for p lies not inside its circumcircle: edges below 2d, area below (3√3/4)·d² < 1.3·d², corners within 2d of p.
fn radius_by_size(domain: &Domain, field: &SizeField, p: PointId) -> f64 {
    let at = domain.points()[p];
    let mut radius = f64::INFINITY;
    for &Incident { curve, .. } in domain.star(p) {
        let curve_id = curve;
        radius = radius.min(field.edge_on(curve_id, at) / (1.0 + field.steepest()));
        for region in domain.curves()[curve_id].sides.into_iter().flatten() {
            radius = radius.min(field.edge_in(region, at) / (2.0 * (1.0 + field.steepest())));
            radius = radius.min((field.area_in(region) / 1.3).sqrt());
        }
    }
    radius
}

fn spoke_too_bent(domain: &Domain, field: &SizeField, at: Incident, radius: f64) -> bool {
    let curve = &domain.curves()[at.curve].curve;
    if curve.is_straight() {
        return false;
    }
    match (at.end, curve.leaves_ball(at.end, radius, 0.0, 1.0)) {
        (End::Start, Some(t)) => field.edge_too_bent(curve, 0.0, t),
        (End::Finish, Some(t)) => field.edge_too_bent(curve, t, 1.0),
        (_, None) => true,
    }
}

impl Ball {
    /// The radius at the next step of shrinking by `beta`, or, `batched`, at the first step that is clear of every vertex that came in.
    pub fn shrunk(&self, beta: f64, batched: bool) -> f64 {
        let mut radius = self.radius * beta;
        while batched && self.intruder < radius {
            radius *= beta;
        }
        radius
    }
}
