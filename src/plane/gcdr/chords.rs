//! The start: subcurves whose chords are a valid PSLG, and stay one however the subcurves are split.
//!
//! The parts of a subcurve, and their chords, stay within its convex hull. A subcurve of lens angle λ lies in its lens.
//! The lens is convex and lies in the rhombus on the chord with angles 2λ at the ends. So curved subcurves are split
//! until no two rhombi meet but in a common end. They are split at the bisector, or, on curves that end at a sharp
//! corner, on [shells](shell_between) around it: then edges across a cusp have ends equally far from it, and may stay.
//! Two curves that share an end at a sharp corner may lie in each other's hulls however short they are. There all
//! curves are cut at one distance from the corner, and from then on together ([`Fan`]): equal distances keep their
//! order.
//!
//! ```text
//!              h             The subcurve x y lies in its lens, and that in the rhombus x h′ y h,
//!         .-´  ┆  `-.        with the angle λ between its sides and the chord, on both sides of it.
//!      .-´.─~~~~~~~─.`-.     The rhombi of two subcurves are apart if a line separates them.
//!     x ───────┼─────── y    Of two that share the end x, they are apart if the chords turn by
//!      `-.     ┆     .-´     more than the sum of both λ at x.
//!         `-.  ┆  .-´
//!              h′
//! ```

use super::{Fan, VertexSource};
use crate::curve::{Curve, End};
use crate::domain::Domain;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect, bounds_of, turn_from};
use crate::ids::{CurveId, FanId, Id, IdVec, PointId, SubcurveId, VertexId};
use crate::plane::subcurves::{Carrier, Standing, Subcurve, Subcurves};
use crate::size::SizeField;
use crate::watch::{Progress, Stopped, Watch};

/// The state before there is a triangulation.
pub(super) struct Beginning<'a> {
    domain: &'a Domain,
    /// By point: whether curves meet there at less than 60°.
    sharp: &'a IdVec<PointId, bool>,
    /// Coordinates of the vertices so far; first those of the points of the domain.
    pub(super) points: Vec<Point>,
    /// The source of every vertex.
    pub(super) origins: IdVec<VertexId, VertexSource>,
    /// C′.
    pub(super) subcurves: Subcurves,
    /// The fans at sharp corners.
    pub(super) fans: IdVec<FanId, Fan>,
    /// Lengths below this cannot be distinguished.
    resolution: f64,
}

/// A subcurve by its chord and lens angle: the rhombus that holds it.
pub(super) struct Hull {
    subcurve: Option<SubcurveId>,
    ends: [Point; 2],
    /// λ, in radians; 0 where it is straight.
    lambda: f64,
}

impl<'a> Beginning<'a> {
    /// The points of a domain as vertices 0, 1, …, and no subcurves. `resolution`: lengths below it cannot be
    /// distinguished.
    pub(super) fn new(domain: &'a Domain, sharp: &'a IdVec<PointId, bool>, resolution: f64) -> Self {
        Self {
            domain,
            sharp,
            points: domain.points().iter().copied().collect(),
            origins: domain.points().ids().map(VertexSource::Input).collect(),
            subcurves: Subcurves::default(),
            fans: IdVec::new(),
            resolution,
        }
    }

    fn add(&mut self, at: Point, origin: VertexSource) -> VertexId {
        self.points.push(at);
        self.origins.push(origin)
    }

    /// Cuts every curve at the fans of its ends: a spoke at each fan, and one ordinary subcurve.
    pub(super) fn cut_curves(&mut self, field: &SizeField) {
        let fan_of = self.place_fans(field);
        for (id, curve) in self.domain.curves().enumerate() {
            let carrier = Carrier::Curve(id);
            let (mut t, mut ends) = ([0.0, 1.0], curve.ends.map(|p| VertexId(p.0)));
            for (i, end) in [End::Start, End::Finish].into_iter().enumerate() {
                let Some(fan) = fan_of[curve.ends[i]] else { continue };
                let Some(leave) = curve.curve.leaves_ball(end, self.fans[fan].radius, 0.0, 1.0) else { continue };
                let x = self.add(curve.curve.point(leave), VertexSource::OnCurve(id));
                let (spoke_t, spoke_ends) = match end {
                    End::Start => ([0.0, leave], [ends[0], x]),
                    End::Finish => ([leave, 1.0], [x, ends[1]]),
                };
                let spoke = self.subcurves.add(carrier, spoke_t, spoke_ends, Standing::OfFan(fan));
                self.fans[fan].spokes.push(spoke);
                (t[i], ends[i]) = (leave, x);
            }
            self.subcurves.add(carrier, t, ends, Standing::Ordinary);
        }
    }

    /// Places a fan at every sharp corner at which a bent curve ends. Its radius is a power of two and at most
    /// lfs(p)/3, so that two fans never meet and no other feature lies in one.
    fn place_fans(&mut self, field: &SizeField) -> IdVec<PointId, Option<FanId>> {
        let bent = |p: PointId| self.domain.star(p).iter().any(|i| !self.domain.curves()[i.curve].curve.is_straight());
        let wanted: Vec<PointId> = self.domain.points().ids().filter(|&p| self.sharp[p] && bent(p)).collect();
        let mut fan_of: IdVec<PointId, Option<FanId>> = vec![None; self.domain.points().len()].into();
        if wanted.is_empty() {
            return fan_of;
        }
        let lfs = self.domain.lfs();
        for p in wanted {
            let most = field.largest_ball(self.domain, p, lfs[p] / 3.0);
            let radius = libm::ldexp(1.0, libm::ilogb(most));
            fan_of[p] = Some(self.fans.push(Fan { corner: p, radius, spokes: Vec::new() }));
        }
        fan_of
    }

    /// Splits bent subcurves until the hulls of any two are apart, or the budget is used up.
    ///
    /// # Errors
    /// Where the watch says to stop.
    pub(super) fn part_hulls(&mut self, max_vertices: usize, watch: &mut Watch) -> Result<(), Stopped> {
        let mut dirty: Vec<SubcurveId> = self.subcurves.ids().collect();
        while !dirty.is_empty() && self.points.len() <= max_vertices {
            Progress { phase: "conforming", vertices: self.points.len(), queued: dirty.len() }.tell(watch)?;
            let met = self.meeting(&dirty);
            dirty.clear();
            for id in met {
                dirty.extend(self.split(id).into_iter().flatten());
            }
        }
        Ok(())
    }

    /// Bent subcurves whose hull meets another, where one of the two is among `dirty`; ascending.
    fn meeting(&self, dirty: &[SubcurveId]) -> Vec<SubcurveId> {
        let live = self.subcurves.ids().filter(|&id| !self.subcurves.get(id).is_gone());
        let mut hulls: Vec<Hull> = live.map(|id| self.hull(id)).collect();
        if hulls.iter().all(|h| h.lambda == 0.0) {
            return Vec::new();
        }
        let lone = self.domain.points().ids().filter(|&p| self.domain.star(p).is_empty());
        hulls.extend(lone.map(|p| {
            let at = self.domain.points()[p];
            Hull { subcurve: None, ends: [at, at], lambda: 0.0 }
        }));
        let boxes = BoxHierarchy::new(hulls.iter().map(|h| h.bounds(self.resolution)));
        let place =
            |id: SubcurveId| hulls.binary_search_by_key(&(id.index()), |h| h.subcurve.map_or(usize::MAX, Id::index));
        let mut met = Vec::new();
        for &id in dirty {
            let Ok(i) = place(id) else { continue };
            boxes.meeting(hulls[i].bounds(self.resolution), |j| {
                if i != j && (hulls[i].lambda > 0.0 || hulls[j].lambda > 0.0) && !self.are_apart(&hulls[i], &hulls[j]) {
                    let bent = |h: &&Hull| h.lambda > 0.0 && !h.is_noise(self.resolution);
                    met.extend([&hulls[i], &hulls[j]].into_iter().filter(bent).filter_map(|h| h.subcurve));
                }
                true
            });
        }
        met.sort_unstable();
        met.dedup();
        met
    }

    fn hull(&self, id: SubcurveId) -> Hull {
        let subcurve = self.subcurves.get(id);
        Hull { subcurve: Some(id), ..Hull::of(self.domain, subcurve, subcurve.t) }
    }

    /// Whether two hulls meet at most in a common end of their subcurves.
    fn are_apart(&self, a: &Hull, b: &Hull) -> bool {
        let [Some(first), Some(second)] = [a.subcurve, b.subcurve].map(|id| id.map(|id| self.subcurves.get(id))) else {
            return a.is_apart(b, self.resolution);
        };
        // Whether the chords of two that are noise cross is found when they are joined.
        if self.share_a_fan(first, second) || a.is_noise(self.resolution) && b.is_noise(self.resolution) {
            return true;
        }
        let common = |v: &VertexId| second.ends.contains(v);
        let mut shared = first.ends.into_iter().filter(common).peekable();
        if shared.peek().is_none() {
            return a.is_apart(b, self.resolution);
        }
        shared.all(|x| {
            let away = |subcurve: &Subcurve| {
                let other = subcurve.ends[usize::from(subcurve.ends[0] == x)];
                self.points[other.index()] - self.points[x.index()]
            };
            // Directions of rounded points differ by more than rounding above a millionth of a radian.
            turn_from(away(first), away(second)).abs() > a.lambda + b.lambda + 1e-6
        })
    }

    /// Whether one is a spoke and the other lies on a curve of the same corner: spokes keep their order, and the other
    /// subcurves lie outside the fan.
    fn share_a_fan(&self, first: &Subcurve, second: &Subcurve) -> bool {
        let meets = |spoke: &Subcurve, other: &Subcurve| {
            let Standing::OfFan(fan) = spoke.standing else { return false };
            let corner = self.fans[fan].corner;
            matches!(other.carrier, Carrier::Curve(c) if self.domain.curves()[c].ends.contains(&corner))
        };
        meets(first, second) || meets(second, first)
    }

    /// Splits a bent subcurve on a shell around a sharp corner, or at its bisector. `None` for a spoke, and where
    /// coordinates cannot hold the point: then joining reports it.
    fn split(&mut self, id: SubcurveId) -> Option<[SubcurveId; 2]> {
        let subcurve = *self.subcurves.get(id);
        let shape = shape_of(self.domain, &subcurve);
        let ends = subcurve.ends.map(|v| self.points[v.index()]);
        let on_shell = shell_between(self.domain, self.sharp, &subcurve, ends)
            .and_then(|(end, radius)| shape.leaves_ball(end, radius, 0.0, 1.0));
        let t = on_shell.unwrap_or_else(|| shape.bisector_crossing(subcurve.t[0], subcurve.t[1]));
        let at = shape.point(t);
        let room = subcurve.ends.map(|v| at.distance(self.points[v.index()]));
        if subcurve.is_spoke() || room[0].min(room[1]) < self.resolution || !(subcurve.t[0] < t && t < subcurve.t[1]) {
            return None;
        }
        let origin = match subcurve.carrier {
            Carrier::Curve(curve) => VertexSource::OnCurve(curve),
            Carrier::Arc(..) => unreachable!("there are no arcs here"),
        };
        let v = self.add(at, origin);
        self.subcurves.retire(id);
        let mut part = |t, ends| self.subcurves.add(subcurve.carrier, t, ends, Standing::Ordinary);
        Some([part([subcurve.t[0], t], [subcurve.ends[0], v]), part([t, subcurve.t[1]], [v, subcurve.ends[1]])])
    }
}

/// The curve that a subcurve is a part of.
pub(super) fn shape_of<'a>(domain: &'a Domain, subcurve: &Subcurve) -> &'a Curve {
    &domain.curves()[curve_of(subcurve)].curve
}

/// The id of the curve that a subcurve is a part of.
pub(super) fn curve_of(subcurve: &Subcurve) -> CurveId {
    match subcurve.carrier {
        Carrier::Curve(curve) => curve,
        Carrier::Arc(..) => unreachable!("this engine makes no arcs"),
    }
}

/// The shell on which a subcurve is split, if its curve ends at a sharp corner: the end, and the distance from it. The
/// distance is the roundest binary number in the middle third. Next to the corner it is a power of two (Ruppert's
/// concentric shells). So the two curves of a narrow corner are split at the same distances. `None` where the subcurve
/// does not run away from the corner: far − near is at most half its chord.
///
/// ```text
///   p ●───────── x ─────┤░░░░░│░░░░░├───── y        near = |px|, far = |py|, third = (far − near)/3
///                near          radius       far     radius: the multiple of the largest power of two in the
///                                                   middle third: the same for both curves of a narrow corner
/// ```
pub(super) fn shell_between(
    domain: &Domain,
    sharp: &IdVec<PointId, bool>,
    subcurve: &Subcurve,
    [x, y]: [Point; 2],
) -> Option<(End, f64)> {
    let curve = &domain.curves()[curve_of(subcurve)];
    let middle = x.midpoint(y);
    let corners = [(End::Start, curve.ends[0]), (End::Finish, curve.ends[1])].into_iter().filter(|&(_, p)| sharp[p]);
    let away = |p: PointId| middle.distance(domain.points()[p]);
    let (end, corner) = corners.min_by(|a, b| away(a.1).total_cmp(&away(b.1)))?;
    let at = domain.points()[corner];
    let (near, far) = (at.distance(x).min(at.distance(y)), at.distance(x).max(at.distance(y)));
    let chord = x.distance(y);
    let third = (far - near) / 3.0;
    (far - near > 0.5 * chord).then(|| (end, roundest_between(near + third, far - third)))
}

/// The number between two positive ones that is a multiple of the largest power of two.
fn roundest_between(low: f64, high: f64) -> f64 {
    let mut exponent = libm::ilogb(high);
    // A step no longer than the interval has a multiple in the interval.
    loop {
        let step = libm::ldexp(1.0, exponent);
        let multiple = (high / step).floor() * step;
        if multiple >= low || step < 0.25 * (high - low) || high <= low {
            return multiple;
        }
        exponent -= 1;
    }
}

impl Hull {
    /// The hull of the part `t` of the curve of a subcurve.
    pub(super) fn of(domain: &Domain, subcurve: &Subcurve, t: [f64; 2]) -> Self {
        let shape = shape_of(domain, subcurve);
        let lambda = if shape.is_straight() { 0.0 } else { shape.lens_angle(t[0], t[1]) };
        Self { subcurve: None, ends: t.map(|t| shape.point(t)), lambda }
    }

    /// Whether the subcurve is so short that its shape is mostly rounding: splits would not end.
    fn is_noise(&self, resolution: f64) -> bool {
        self.ends[0].distance(self.ends[1]) < 4096.0 * resolution
    }

    /// The corners x, h′, y, h of the rhombus; of a straight subcurve, of its chord.
    fn corners(&self) -> [Point; 4] {
        let [x, y] = self.ends;
        let half = 0.5 * (y - x);
        let height = libm::tan(self.lambda);
        let normal = crate::geometry::Vec2::new(-half.y, half.x) * height;
        let middle = x.midpoint(y);
        [x, middle - normal, y, middle + normal]
    }

    fn bounds(&self, slack: f64) -> Rect {
        bounds_of(self.corners()).unwrap_or_default().inflate(slack, slack)
    }

    /// Whether a line parallel to a side or the chord of one separates the two rhombi, with `slack` between them.
    pub(super) fn is_apart(&self, other: &Self, slack: f64) -> bool {
        let (p, q) = (self.corners(), other.corners());
        let sides = [p, q].into_iter().flat_map(|r| [r[1] - r[0], r[2] - r[1], r[2] - r[0]]);
        let mut normals = sides.filter(|s| s.hypot2() > 0.0).map(|s| crate::geometry::Vec2::new(-s.y, s.x) / s.hypot());
        normals.any(|n| {
            let range = |r: &[Point; 4]| {
                let along = r.map(|c| c.to_vec2().dot(n));
                along.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
            };
            let ((p0, p1), (q0, q1)) = (range(&p), range(&q));
            p1 + slack < q0 || q1 + slack < p0
        })
    }
}
