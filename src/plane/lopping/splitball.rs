//! Rule 1, splitball: a ball shrinks, and its spokes are split.
//!
//! ```text
//!              x.       z, a vertex of a curve that does not end at p, lies in B(p), at the distance intruder < d(p).
//!            ╱   `.     d(p) ← β·d(p), until z is outside (Literal: once). Each spoke is split at the new border.
//!          x′  z   `.   p x′ and p y′ are the new spokes; x′ x and y′ y are ordinary subcurves.
//!        ╱   `.     :   The corner arcs are withdrawn; their vertices stay.
//!      ╱      :     :
//!    p ────── y′─── y
//! ```

use super::{Lopping, Shrinking};
use crate::curve::End;
use crate::ids::{BallId, SubcurveId, VertexId};
use crate::mesh::BallReason;
use crate::plane::subcurves::Standing;

impl Lopping {
    /// Shrinks a ball that holds a vertex of a curve not at its corner: until it is clear, or by one step
    /// ([`Shrinking`]).
    pub(super) fn shrink_ball(&mut self, id: BallId) {
        let ball = self.balls.get(id);
        if ball.intruder >= ball.radius {
            return;
        }
        let radius = {
            let rules = &self.options.rules;
            ball.shrunk(rules.beta, rules.ball_shrinking == Shrinking::Batched)
        };
        self.cut_ball(id, radius);
        if self.balls.get(id).intruder < radius {
            self.intruded.push_back(id);
        }
    }

    /// splitball: the radius becomes `radius`, and each spoke is split there. Triangles that the ball exempted are
    /// queued again.
    pub(super) fn cut_ball(&mut self, id: BallId, radius: f64) {
        if radius < self.state.resolution {
            let at = self.balls.get(id).center;
            return self.stop_too_near(at);
        }
        self.withdraw_arcs(id);
        let spokes = std::mem::take(&mut self.balls.get_mut(id).spokes);
        let mut shorter = Vec::with_capacity(spokes.len());
        for spoke in spokes {
            match self.cut_spoke(id, spoke, radius) {
                Some(subcurve) => shorter.push(subcurve),
                None => return,
            }
        }
        let ball = self.balls.get_mut(id);
        ball.spokes = shorter;
        ball.radius = radius;
        ball.why = BallReason::Encroached;
        let exempt = std::mem::take(&mut ball.exempt);
        for candidate in exempt {
            self.state.bad.push_skinny(candidate, 1.0);
        }
        if self.options.corner_arcs.is_some() {
            self.arcs_due.push_back(id);
        }
    }

    /// Splits a spoke at a smaller radius. Returns the shorter spoke; `None` where coordinates cannot hold it.
    fn cut_spoke(&mut self, ball: BallId, spoke: SubcurveId, radius: f64) -> Option<SubcurveId> {
        let subcurve = *self.state.subcurves.get(spoke);
        let corner = VertexId(self.balls.get(ball).corner.0);
        let end = if subcurve.ends[0] == corner { End::Start } else { End::Finish };
        let shape = self.shape(subcurve.carrier);
        let x = shape.leaves_ball(end, radius, subcurve.t[0], subcurve.t[1]).unwrap_or(f64::NAN);
        let [head, tail] = self.split_subcurve_at(spoke, x, "vertices_ball")?;
        let inner = if end == End::Start { head } else { tail };
        self.state.subcurves.get_mut(inner).standing = Standing::Spoke(ball);
        Some(inner)
    }

    /// Takes the arcs of a ball out of C′; their vertices stay.
    fn withdraw_arcs(&mut self, id: BallId) {
        self.balls.get_mut(id).arcs.clear();
        for subcurve in std::mem::take(&mut self.balls.get_mut(id).arc_subcurves) {
            let Some(side) = self.side_of(subcurve) else {
                self.state.subcurves.retire(subcurve);
                continue;
            };
            if self.delaunay.topology().subcurve(side) == Some(subcurve) {
                self.delaunay.topology_mut().set_subcurve(side, None);
            }
            self.state.subcurves.retire(subcurve);
        }
    }
}
