//! C′: the subcurves. Each knows its carrier (a curve of the domain, or a corner arc), its parameters and its two
//! vertices.
//!
//! Pieces are never moved or reused: a split retires one and adds two. A *spoke* is the subcurve of a curve inside the
//! ball of its end point; it is never tested, split or attacked while the ball stands (Lemma 3: only curves that do not
//! meet p come near it).

use crate::curve::Curve;
use crate::geometry::Point;
use crate::ids::{BallId, CurveId, FanId, IdVec, SubcurveId, VertexId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a subcurve is a part of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Carrier {
    /// A curve of the domain.
    Curve(CurveId),
    /// Arc number `.1` on the border of a ball (section 6).
    Arc(BallId, u32),
}

/// What has become of a subcurve.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Standing {
    /// In C′ and to be tested.
    Ordinary,
    /// In C′, inside a ball.
    Spoke(BallId),
    /// In C′, from a sharp corner to where its fan is cut.
    OfFan(FanId),
    /// Split or withdrawn.
    Gone,
}

/// A subcurve.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Subcurve {
    pub carrier: Carrier,
    pub t: [f64; 2],
    pub ends: [VertexId; 2],
    pub standing: Standing,
    /// Whether it waits to be looked at.
    pub queued: bool,
}

impl Subcurve {
    pub fn is_gone(&self) -> bool {
        self.standing == Standing::Gone
    }

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
    /// Where it crosses the bisector of the angle under which the encroaching vertex sees the chord.
    // ∠xzy at the encroaching vertex z (section 6).
    Angle,
}

/// The pieces, dead and alive.
#[derive(Default)]
pub struct Subcurves {
    pieces: IdVec<SubcurveId, Subcurve>,
}

impl Subcurves {
    pub fn add(&mut self, carrier: Carrier, t: [f64; 2], ends: [VertexId; 2], standing: Standing) -> SubcurveId {
        self.pieces.push(Subcurve { carrier, t, ends, standing, queued: false })
    }

    pub fn get(&self, id: SubcurveId) -> &Subcurve {
        &self.pieces[id]
    }

    pub fn get_mut(&mut self, id: SubcurveId) -> &mut Subcurve {
        &mut self.pieces[id]
    }

    pub fn ids(&self) -> impl DoubleEndedIterator<Item = SubcurveId> + use<> {
        self.pieces.ids()
    }

    pub fn retire(&mut self, id: SubcurveId) {
        self.pieces[id].standing = Standing::Gone;
    }
}

/// The parameter at which a part of a curve is split; `z` is the vertex that encroaches it, where there is one.
pub fn split_parameter(curve: &Curve, t: [f64; 2], z: Option<Point>, rule: Midpoint) -> f64 {
    let by_bisector = || curve.bisector_crossing(t[0], t[1]);
    match (rule, z) {
        (Midpoint::Angle, Some(z)) => angle_crossing(curve, t, z).unwrap_or_else(by_bisector),
        _ => by_bisector(),
    }
}

/// Where the curve crosses the line (not the ray: z may lie between chord and curve) that bisects ∠xzy; `None` where it
/// misses, or would cut off less than a sixteenth of the chord, which Assumption 1 forbids for any useful η.
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
