//! C′: the subcurves. Each has a carrier (a curve of the domain, or a corner arc), a range of its parameter, and two
//! vertices.
//!
//! Subcurves are never moved or reused: a split retires one and adds two. A *spoke* is the subcurve of a curve inside
//! the ball B(p) of its end point p. While the ball stands it is neither tested nor split (Lemma 3: only curves that do
//! not end at p come near p).

use crate::curve::Curve;
use crate::geometry::Point;
use crate::ids::{BallId, CurveId, FanId, IdVec, SubcurveId, VertexId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The curve that a subcurve is a part of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Carrier {
    /// A curve of the domain.
    Curve(CurveId),
    /// Arc number `.1` on the border of a ball (section 6).
    Arc(BallId, u32),
}

/// Whether a subcurve is in C′, and how it is treated.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Standing {
    /// In C′, tested and split.
    Ordinary,
    /// In C′, inside a ball: a spoke of corner lopping.
    Spoke(BallId),
    /// In C′, from a sharp corner to the radius of its fan: a spoke of constrained refinement.
    OfFan(FanId),
    /// Split or withdrawn.
    Gone,
}

/// A part of a curve between two vertices.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Subcurve {
    /// The curve that it is a part of.
    pub carrier: Carrier,
    /// The parameters of its ends on the carrier, ascending, within 0..1.
    pub t: [f64; 2],
    /// The vertices at these parameters.
    pub ends: [VertexId; 2],
    /// Whether it is in C′, and how it is treated.
    pub standing: Standing,
    /// Whether it waits in the queue.
    pub queued: bool,
}

impl Subcurve {
    /// Whether it has been split or withdrawn.
    pub fn is_gone(&self) -> bool {
        self.standing == Standing::Gone
    }

    /// Whether it is a spoke, of a ball or of a fan.
    pub fn is_spoke(&self) -> bool {
        matches!(self.standing, Standing::Spoke(_) | Standing::OfFan(_))
    }
}

/// Which point splits a curve that a vertex encroaches.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Midpoint {
    /// Where the curve crosses the perpendicular bisector of its chord.
    // η and μ of Corollaries 1 and 2.
    #[default]
    Bisector,
    /// Where it crosses the bisector of the angle that the chord subtends at the encroaching vertex.
    // ∠xzy at the encroaching vertex z (section 6).
    Angle,
}

/// All subcurves, in C′ or gone, by id.
#[derive(Default)]
pub struct Subcurves {
    subcurves: IdVec<SubcurveId, Subcurve>,
}

impl Subcurves {
    /// Adds the part of `carrier` between the parameters `t`, whose vertices are `ends`.
    pub fn add(&mut self, carrier: Carrier, t: [f64; 2], ends: [VertexId; 2], standing: Standing) -> SubcurveId {
        self.subcurves.push(Subcurve { carrier, t, ends, standing, queued: false })
    }

    /// A subcurve, in C′ or gone.
    pub fn get(&self, id: SubcurveId) -> &Subcurve {
        &self.subcurves[id]
    }

    /// A subcurve, to be changed.
    pub fn get_mut(&mut self, id: SubcurveId) -> &mut Subcurve {
        &mut self.subcurves[id]
    }

    /// All ids ever given, ascending.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = SubcurveId> + use<> {
        self.subcurves.ids()
    }

    /// Takes a subcurve out of C′.
    pub fn retire(&mut self, id: SubcurveId) {
        self.subcurves[id].standing = Standing::Gone;
    }
}

/// The parameter at which the part `t` of a curve is split; `z` is the vertex that encroaches it, where there is one.
///
/// ```text
///          .-─p─-.                  .-──p-.           x = curve.point(t[0]), y = curve.point(t[1])
///       .´    │    `.            .´      ╲  `.        The curve is split at p, where it crosses
///     .´      │      `.        .´         │   `.      the perpendicular bisector of the chord x y,
///   x ────────┼──────── y    x ───────────╲───── y    or the bisector of the angle x z y.
///             │                           │
///     bisector rule           angle rule   z
/// ```
pub fn split_parameter(curve: &Curve, t: [f64; 2], z: Option<Point>, rule: Midpoint) -> f64 {
    let by_bisector = || curve.bisector_crossing(t[0], t[1]);
    match (rule, z) {
        (Midpoint::Angle, Some(z)) => angle_crossing(curve, t, z).unwrap_or_else(by_bisector),
        _ => by_bisector(),
    }
}

/// Where the curve crosses the line that bisects ∠xzy. It is the line, not the ray, since z may lie between chord and
/// curve. `None` where there is no crossing, or where it is nearer to an end than a sixteenth of the chord: Assumption
/// 1 excludes that for any useful η.
fn angle_crossing(curve: &Curve, t: [f64; 2], z: Point) -> Option<f64> {
    let (x, y) = (curve.point(t[0]), curve.point(t[1]));
    let (zx, zy) = (x - z, y - z);
    let (lx, ly) = (zx.hypot(), zy.hypot());
    if lx == 0.0 || ly == 0.0 {
        return None;
    }
    let bisector = zx / lx + zy / ly;
    if bisector.hypot2() == 0.0 {
        return None;
    }
    let least = x.distance(y) / 16.0;
    curve.line_crossings(z, bisector, t[0], t[1]).into_iter().find(|&s| {
        let p = curve.point(s);
        p.distance(x) > least && p.distance(y) > least
    })
}
