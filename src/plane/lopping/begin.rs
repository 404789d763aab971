//! The start: P, the points where curves leave the balls of their ends (splitball(p, 1)), and the Delaunay
//! triangulation of both.

use super::balls::Balls;
use super::{RefineError, VertexOrigin};
use crate::curve::End;
use crate::domain::Domain;
use crate::geometry::Point;
use crate::ids::{CurveId, Id, IdVec, SubcurveId, VertexId};
use crate::plane::insert::{Degenerate, Kernel};
use crate::plane::subcurves::{Carrier, Midpoint, Standing, Subcurves, split_parameter};

/// The state before there is a triangulation.
pub(super) struct Beginning<'a> {
    /// The domain in the unit frame.
    pub(super) domain: &'a Domain,
    /// The balls, of their first radius.
    pub(super) balls: Balls,
    points: Vec<Point>,
    /// The source of every vertex so far.
    pub(super) origins: IdVec<VertexId, VertexOrigin>,
    /// C′.
    pub(super) subcurves: Subcurves,
}

impl<'a> Beginning<'a> {
    /// The points of a domain as vertices 0, 1, …, and no subcurves.
    pub(super) fn new(domain: &'a Domain, balls: Balls) -> Self {
        Self {
            domain,
            balls,
            points: domain.points().iter().copied().collect(),
            origins: domain.points().ids().map(VertexOrigin::Input).collect(),
            subcurves: Subcurves::default(),
        }
    }

    fn add(&mut self, at: Point, origin: VertexOrigin) -> VertexId {
        self.points.push(at);
        self.origins.push(origin)
    }

    /// splitball(p, 1) at every ball: each curve is split where it leaves the balls of its ends.
    pub(super) fn cut_curves(&mut self) {
        for (id, curve) in self.domain.curves().enumerate() {
            let carrier = Carrier::Curve(id);
            let [p, q] = curve.ends;
            let (mut t, mut ends) = ([0.0, 1.0], [VertexId(p.0), VertexId(q.0)]);
            for (i, end) in [End::Start, End::Finish].into_iter().enumerate() {
                let Some(ball) = self.balls.of_point(curve.ends[i]) else { continue };
                let radius = self.balls.get(ball).radius;
                // d(p) < lfs₀(p)/2, and the other end is no nearer than lfs₀(p): every curve at p leaves the ball.
                let Some(leave) = curve.curve.leaves_ball(end, radius, 0.0, 1.0) else { continue };
                let x = self.add(curve.curve.point(leave), VertexOrigin::OnCurve(id));
                let (spoke_t, spoke_ends) = match end {
                    End::Start => ([0.0, leave], [ends[0], x]),
                    End::Finish => ([leave, 1.0], [x, ends[1]]),
                };
                let spoke = self.subcurves.add(carrier, spoke_t, spoke_ends, Standing::Spoke(ball));
                self.balls.get_mut(ball).spokes.push(spoke);
                (t[i], ends[i]) = (leave, x);
            }
            self.subcurves.add(carrier, t, ends, Standing::Ordinary);
        }
        self.sort_spokes();
    }

    /// Sorts the spokes of each ball in the order of the star of its corner.
    fn sort_spokes(&mut self) {
        for id in self.balls.ids() {
            let ball = self.balls.get(id);
            let star = self.domain.star(ball.corner);
            // Spokes were added in ascending order of their curves, and no curve has both ends at one point.
            let curve_of = |&s: &SubcurveId| match self.subcurves.get(s).carrier {
                Carrier::Curve(curve) => curve,
                Carrier::Arc(..) => unreachable!("no arc is a spoke"),
            };
            let spoke_of =
                |curve: CurveId| ball.spokes.binary_search_by_key(&curve, curve_of).ok().map(|i| ball.spokes[i]);
            let spokes = star.iter().filter_map(|at| spoke_of(at.curve)).collect();
            self.balls.get_mut(id).spokes = spokes;
        }
    }

    /// The Delaunay triangulation of the points so far. Where all lie on one line (a lens, a half disk), curved
    /// subcurves are split first.
    ///
    /// # Errors
    /// Where the points have no triangulation.
    pub(super) fn triangulate(&mut self, midpoint: Midpoint) -> Result<Kernel, RefineError> {
        match Kernel::new(self.points.clone()) {
            Err(Degenerate::TooFew | Degenerate::Collinear) => self.split_bent(midpoint),
            done => return done.map_err(|why| self.refuse(&why)),
        }
        Kernel::new(self.points.clone()).map_err(|why| self.refuse(&why))
    }

    fn refuse(&self, why: &Degenerate) -> RefineError {
        match *why {
            Degenerate::Duplicate { first, second } => self.coincident(first, second),
            _ => RefineError::degenerate(why, &self.points),
        }
    }

    fn split_bent(&mut self, midpoint: Midpoint) {
        let subcurves: Vec<SubcurveId> = self.subcurves.ids().collect();
        for id in subcurves {
            let subcurve = *self.subcurves.get(id);
            let Carrier::Curve(curve) = subcurve.carrier else { continue };
            let shape = &self.domain.curves()[curve].curve;
            if shape.is_straight() || subcurve.is_spoke() {
                continue;
            }
            let m = split_parameter(shape, subcurve.t, None, midpoint);
            let v = self.add(shape.point(m), VertexOrigin::OnCurve(curve));
            self.subcurves.retire(id);
            self.subcurves.add(subcurve.carrier, [subcurve.t[0], m], [subcurve.ends[0], v], Standing::Ordinary);
            self.subcurves.add(subcurve.carrier, [m, subcurve.t[1]], [v, subcurve.ends[1]], Standing::Ordinary);
        }
    }

    fn coincident(&self, first: usize, second: usize) -> RefineError {
        let at = self.points[first];
        let describe = |i: usize| match self.origins[VertexId::from_index(i)] {
            VertexOrigin::Input(p) => format!("input point {}", p.0),
            VertexOrigin::OnCurve(c) => format!("a point of curve {} on the border of its corner's ball", c.0),
            VertexOrigin::OnArc(_) | VertexOrigin::Free => format!("vertex {i}"),
        };
        RefineError {
            what: format!("{} and {} coincide", describe(first), describe(second)),
            at,
            help: "two curves leave a corner nearer to each other than the coordinates can tell apart: merge them, or move the drawing nearer to the origin"
                .to_owned(),
        }
    }
}
