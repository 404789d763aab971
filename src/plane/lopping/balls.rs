//! Protecting balls around acute corners: B(p), open, of radius d(p) (Pav & Walkington 2005, section 3).
//!
//! At first d(p) = (√2−1)·lfs₀(p). It is capped so that the triangles inside, which are never refined, meet the size
//! limits. From then on a ball only shrinks, by β, when a vertex of a curve that does not end at p lies in it. The
//! closed balls never meet.
//!
//! ```text
//!             ╱ x `.
//!           ╱       :     x, y: where the curves leave B(p), at the distance d(p) from p
//!         ╱   B(p)   :    p x, p y: the spokes, counter-clockwise as in the star of p
//!       p ────────── y    pxy has the angle of the drawing: it is exempt
//! ```

use crate::curve::Curve;
use crate::domain::Domain;
use crate::geometry::{Point, Rect, boxes::BoxHierarchy};
use crate::ids::{BallId, IdVec, PointId, SubcurveId, TriangleId, VertexId};
use crate::mesh::BallReason;
use crate::size::SizeField;

/// A protecting ball.
#[derive(Clone, Debug)]
pub struct Ball {
    /// The corner p.
    pub corner: PointId,
    /// The place of p.
    pub center: Point,
    /// d(p), in the unit frame.
    pub radius: f64,
    /// What set the radius.
    pub why: BallReason,
    /// The spoke of each incident curve, counter-clockwise as in the domain's star.
    pub spokes: Vec<SubcurveId>,
    /// Distance from p to the nearest vertex of a curve that does not end at p; only those inside are noted.
    pub intruder: f64,
    /// Corner arcs as placed; empty while they are due.
    pub arcs: Vec<Curve>,
    /// The subcurves of those arcs in C′.
    pub arc_subcurves: Vec<SubcurveId>,
    /// Triangles that this ball exempted when they were last tested: their circumcenters lay in it.
    pub exempt: Vec<(TriangleId, [VertexId; 3])>,
}

/// All balls, by id and by point.
pub struct Balls {
    balls: IdVec<BallId, Ball>,
    of_point: IdVec<PointId, Option<BallId>>,
    /// Boxes of the balls at first: radii only shrink.
    index: BoxHierarchy,
}

impl Balls {
    /// A ball at every acute corner of a domain, of its first radius.
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
                    arc_subcurves: Vec::new(),
                    exempt: Vec::new(),
                })
            });
            of_point.push(ball);
        }
        let index = BoxHierarchy::new(balls.iter().map(box_of));
        Self { balls, of_point, index }
    }

    /// The ball of a point, if it has one.
    pub fn of_point(&self, p: PointId) -> Option<BallId> {
        self.of_point[p]
    }

    /// A ball.
    pub fn get(&self, id: BallId) -> &Ball {
        &self.balls[id]
    }

    /// A ball, to be changed.
    pub fn get_mut(&mut self, id: BallId) -> &mut Ball {
        &mut self.balls[id]
    }

    /// All ids, ascending by corner.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = BallId> + use<> {
        self.balls.ids()
    }

    /// The open ball in which a place lies, and the distance of the place from the corner. The balls are disjoint, so
    /// there is at most one.
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

    /// The ball in which all three corners of a triangle lie. Its border is included, up to `rounding` of the points on
    /// it.
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
    // Points on the border are rounded: a slightly larger box holds them.
    let r = ball.radius * (1.0 + 1e-9);
    let c = ball.center;
    Rect::new(c.x - r, c.y - r, c.x + r, c.y + r)
}

impl Ball {
    /// The radius after one step of shrinking by `beta`; `batched`: after the first step at which no vertex lies
    /// inside.
    pub fn shrunk(&self, beta: f64, batched: bool) -> f64 {
        let mut radius = self.radius * beta;
        while batched && self.intruder < radius {
            radius *= beta;
        }
        radius
    }
}
