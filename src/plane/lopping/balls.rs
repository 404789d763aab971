//! Protecting balls around acute corners: B(p), open, of radius d(p) (Pav & Walkington 2005, section 3).
//!
//! At birth d(p) = (√2−1)·lfs₀(p), capped so that what lies inside, which is never refined, meets the size limits. A
//! ball then only shrinks, by β, when a vertex of a curve that does not end at p comes in. The closed balls never meet.

use crate::curve::Curve;
use crate::domain::Domain;
use crate::geometry::{Point, Rect, boxes::BoxHierarchy};
use crate::ids::{BallId, IdVec, PointId, SubcurveId, TriangleId, VertexId};
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
    pub spokes: Vec<SubcurveId>,
    /// Distance of the nearest vertex that came in since the last shrinking.
    pub intruder: f64,
    /// Corner arcs as placed; empty while they wait to be placed.
    pub arcs: Vec<Curve>,
    /// Live pieces of those arcs.
    pub arc_pieces: Vec<SubcurveId>,
    /// Triangles that this ball exempt when they were last looked at (their circumcenters lay in it).
    pub exempt: Vec<(TriangleId, [VertexId; 3])>,
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
                let by_features = (std::f64::consts::SQRT_2 - 1.0) * lfs0[p];
                let radius = field.largest_ball(domain, p, by_features);
                let why = if radius < by_features { BallReason::Size } else { BallReason::LocalFeatureSize };
                balls.push(Ball {
                    corner: p,
                    center,
                    radius,
                    why,
                    spokes: Vec::new(),
                    intruder: f64::INFINITY,
                    arcs: Vec::new(),
                    arc_pieces: Vec::new(),
                    exempt: Vec::new(),
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

    /// The ball that holds a place, and the place's distance from its corner. The balls are disjoint: there is at most
    /// one.
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

impl Ball {
    /// The radius at the next step of shrinking by `beta`, or, `batched`, at the first step that is clear of every
    /// vertex that came in.
    pub fn shrunk(&self, beta: f64, batched: bool) -> f64 {
        let mut radius = self.radius * beta;
        while batched && self.intruder < radius {
            radius *= beta;
        }
        radius
    }
}
