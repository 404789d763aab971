//! Rule 3, corner arcs (section 6): pseudo-input on the border of a ball, placed once there is room for it.
//!
//! ```text
//!             to             A kept sector of B(p), from one spoke counter-clockwise to the next, gets
//!           ╱    `.          count = ⌈sweep/arc_turning⌉ equal arcs; here 2, with one pseudo midpoint m.
//!         ╱        m         A vertex nearer to m than d/2 (arcs of π/3): the ball shrinks (Tight).
//!       ╱           :        m encroaches a subcurve shorter than d:      the ball shrinks (Tight).
//!     p ──────────── from    m encroaches a longer one:                   it is split first (Blocked).
//! ```

use super::{Lopping, VertexOrigin};
use crate::curve::{Curve, End};
use crate::geometry::{self, Point, Vec2};
use crate::ids::{BallId, SubcurveId, VertexId};
use crate::plane::insert::{self, Location};
use crate::plane::subcurves::{Carrier, Standing};
use crate::plane::triangulation::GHOST;
use std::f64::consts::{FRAC_PI_3, TAU};

/// Whether the vertices of arcs have room.
enum Room {
    Clear,
    /// The ball must shrink.
    Tight,
    /// A vertex of an arc would encroach this subcurve, which must be split first.
    Blocked(SubcurveId),
}

impl Lopping {
    /// Rule 3 at a ball whose arcs are due: shrinks the ball, splits a subcurve, or inserts the arcs.
    pub(super) fn place_arcs(&mut self, id: BallId) {
        let Some(arc_turning) = self.options.corner_arcs else { return };
        if !self.balls.get(id).arcs.is_empty() {
            return;
        }
        let mut radius = self.balls.get(id).radius;
        let born = radius;
        loop {
            let arcs = self.arcs_at(id, radius, arc_turning);
            match self.room_for(id, radius, &arcs) {
                Room::Tight if radius > self.state.resolution => radius *= self.options.rules.beta,
                Room::Tight => {
                    let at = self.balls.get(id).center;
                    return self.stop_too_near(at);
                }
                Room::Blocked(subcurve) => {
                    self.arcs_due.push_back(id);
                    return self.split_subcurve(subcurve, None, "vertices_encroached");
                }
                Room::Clear if radius < born => return self.cut_ball(id, radius),
                Room::Clear => return self.insert_arcs(id, arcs),
            }
        }
    }

    /// The kept sectors of a ball, if it had a radius: for each the directions of its ends and the number of equal
    /// arcs.
    fn arcs_at(&self, id: BallId, radius: f64, arc_turning: f64) -> Vec<Sector> {
        let ball = self.balls.get(id);
        let star = self.state.domain.star(ball.corner);
        let leaving = |i: usize| -> (VertexId, Vec2) {
            let subcurve = self.state.subcurves.get(ball.spokes[i]);
            let (end, rim) = if subcurve.ends[0].0 == ball.corner.0 {
                (End::Start, subcurve.ends[1])
            } else {
                (End::Finish, subcurve.ends[0])
            };
            let shape = self.shape(subcurve.carrier);
            let [t0, t1] = subcurve.t;
            let at = match shape.leaves_ball(end, radius, t0, t1) {
                Some(t) if radius < ball.radius => shape.point(t),
                _ => self.delaunay.point(rim),
            };
            (rim, at - ball.center)
        };
        let n = ball.spokes.len();
        let kept = |i: usize| {
            let curve = &self.state.domain.curves()[star[i].curve];
            curve.sides[usize::from(star[i].end == End::Finish)].is_some()
        };
        (0..n)
            .filter(|&i| kept(i))
            .map(|i| {
                let ((from, u), (to, v)) = (leaving(i), leaving((i + 1) % n));
                let mut sweep = geometry::turn_from(u, v);
                if sweep <= 0.0 {
                    sweep += TAU;
                }
                let count = libm::ceil(sweep / arc_turning * (1.0 - 1e-12)).max(1.0) as u32;
                Sector { from, to, start: libm::atan2(u.y, u.x), sweep, count }
            })
            .collect()
    }

    /// Tests every pseudo midpoint for room.
    fn room_for(&mut self, id: BallId, radius: f64, sectors: &[Sector]) -> Room {
        let center = self.balls.get(id).center;
        let near = self.triangle_at(VertexId(self.balls.get(id).corner.0));
        for at in sectors.iter().flat_map(|s| s.inner_points(center, radius)) {
            if !insert::in_range(at) {
                return Room::Tight;
            }
            let location = self.delaunay.locate(at, near);
            if matches!(location, Location::Vertex(_)) {
                return Room::Tight;
            }
            self.delaunay.cavity(at, location, &mut self.state.cavity);
            if self.is_crowded(id, radius, at) {
                return Room::Tight;
            }
            for (_, subcurve) in self.cavity_subcurves() {
                match self.room_beside(id, radius, at, subcurve) {
                    Room::Clear => {}
                    room => return room,
                }
            }
        }
        Room::Clear
    }

    /// Whether a vertex lies nearer to a pseudo midpoint than half the radius, for arcs of π/3. Finer arcs have their
    /// vertices nearer to each other and to the spokes, so the distance shrinks in proportion: equal arcs turn at least
    /// half of what they may, and 2·sin(T/4) > 3T/2π. A vertex on the arc of another ball does not count, since the
    /// balls are apart already.
    fn is_crowded(&self, id: BallId, radius: f64, at: Point) -> bool {
        let arc_turning = self.options.corner_arcs.unwrap_or(FRAC_PI_3);
        let nearest = 0.5 * radius * (arc_turning / FRAC_PI_3);
        let topology = self.delaunay.topology();
        let mut neighbours =
            self.state.cavity.triangles.iter().flat_map(|&t| topology.corners(t)).filter(|&v| v != GHOST);
        neighbours.any(|v| {
            let apart = matches!(self.origins[v], VertexOrigin::OnArc(other) if other != id);
            !apart && self.delaunay.point(v).distance(at) < nearest
        })
    }

    /// Whether a pseudo midpoint encroaches a subcurve, and what follows.
    fn room_beside(&self, id: BallId, radius: f64, at: Point, subcurve: SubcurveId) -> Room {
        let entry = self.state.subcurves.get(subcurve);
        if entry.standing == Standing::Spoke(id) || !self.encroaches(at, subcurve) {
            return Room::Clear;
        }
        // A curve lies within half its chord times tan(λ/2) of the chord. With that, lfs(p) ≤ 1.5·d(p) where the
        // subcurve is short.
        let [x, y] = entry.ends.map(|v| self.delaunay.point(v));
        let lens = self.shape(entry.carrier).lens_angle(entry.t[0], entry.t[1]);
        let reach = x.distance(y) * (1.0 + libm::tan(0.5 * lens));
        let short = reach < radius && matches!(entry.carrier, Carrier::Curve(_));
        if entry.is_spoke() || short { Room::Tight } else { Room::Blocked(subcurve) }
    }

    /// Inserts the pseudo midpoints of all sectors and adds the arcs between them to C′.
    fn insert_arcs(&mut self, id: BallId, sectors: Vec<Sector>) {
        let (center, radius) = (self.balls.get(id).center, self.balls.get(id).radius);
        for sector in sectors {
            let mut from = sector.from;
            for (i, step) in (0..sector.count).enumerate() {
                let to = if step + 1 == sector.count {
                    sector.to
                } else {
                    let at = sector.inner_point(center, radius, step + 1);
                    let near = self.triangle_at(from);
                    if self.look_at_cavity(at, near, at).is_none() {
                        return;
                    }
                    self.disturb(at, None);
                    self.act(at, VertexOrigin::OnArc(id), "vertices_arc")
                };
                let ends = [from, to].map(|v| self.delaunay.point(v));
                let start = sector.start + sector.sweep * i as f64 / f64::from(sector.count);
                let arc = Curve::arc(center, radius, start, sector.sweep / f64::from(sector.count))
                    .expect("a ball's radius is positive")
                    .with_ends(ends[0], ends[1]);
                let ball = self.balls.get_mut(id);
                let carrier = Carrier::Arc(id, ball.arcs.len() as u32);
                ball.arcs.push(arc);
                let subcurve = self.state.subcurves.add(carrier, [0.0, 1.0], [from, to], Standing::Ordinary);
                self.balls.get_mut(id).arc_subcurves.push(subcurve);
                self.state.enqueue(subcurve);
                from = to;
            }
        }
    }
}

/// A kept sector of a ball, from one spoke counter-clockwise to the next; directions in radians.
struct Sector {
    /// The end of the first spoke.
    from: VertexId,
    /// The end of the next spoke.
    to: VertexId,
    /// Direction of `from` from the corner.
    start: f64,
    /// Angle from `from` to `to`, counter-clockwise, above 0.
    sweep: f64,
    /// Number of equal arcs.
    count: u32,
}

impl Sector {
    /// The place where arc `i` begins, on the border of the ball.
    fn inner_point(&self, center: Point, radius: f64, i: u32) -> Point {
        let angle = self.start + self.sweep * f64::from(i) / f64::from(self.count);
        center + Vec2::new(libm::cos(angle), libm::sin(angle)) * radius
    }

    /// The pseudo midpoints.
    fn inner_points(&self, center: Point, radius: f64) -> impl Iterator<Item = Point> + '_ {
        (1..self.count).map(move |i| self.inner_point(center, radius, i))
    }
}
