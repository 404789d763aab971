//! The planes of entities relative to the XY plane of the drawing.

use super::figure::{Level, Refusal, TILTED};
use super::sections::Record;
use crate::curve::Curve;
use crate::geometry::Point;
use kurbo::Affine;

/// Largest ratio of height to extent of a flat entity: rounding of a file with six decimals.
pub(super) const FLAT: f64 = 1e-6;

/// The plane of an entity that has an extrusion direction.
#[derive(Clone, Copy)]
pub(super) enum Plane {
    /// Parallel to the XY plane, seen from above or from below.
    Above,
    Below,
    /// Any other, by its axes and normal, unit vectors.
    Tilted([[f64; 3]; 3]),
}

impl Plane {
    /// The plane of an entity.
    pub fn of(record: &Record) -> Result<Self, Refusal> {
        let normal = record.optional_point(210)?.unwrap_or([0.0, 0.0, 1.0]);
        let [x, y, z] = normal;
        if x.abs().max(y.abs()) <= FLAT * z.abs() {
            return Ok(if z < 0.0 { Self::Below } else { Self::Above });
        }
        if z.abs() <= FLAT * x.abs().max(y.abs()) {
            // An area seen from its side has no extent.
            return Err(Refusal::Skip(TILTED));
        }
        /// A normal nearer than this to the z axis takes its x axis from the y axis (arbitrary axis algorithm).
        const NEAR_Z: f64 = 1.0 / 64.0;
        let n = unit(normal);
        let up = if n[0].abs() < NEAR_Z && n[1].abs() < NEAR_Z { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let across = unit(cross(up, n));
        Ok(Self::Tilted([across, cross(n, across), n]))
    }

    /// The plane of an entity that must be parallel to the XY plane.
    pub fn parallel(record: &Record) -> Result<Self, Refusal> {
        match Self::of(record)? {
            Self::Tilted(_) => Err(Refusal::Skip(TILTED)),
            plane => Ok(plane),
        }
    }

    /// From the coordinates of the entity to those of the drawing, by the arbitrary axis algorithm. If the normal is
    /// along z, the x axis of the entity is that of the drawing or its opposite. `z` is the height in the coordinates
    /// of the plane.
    pub fn affine(self, z: f64) -> Affine {
        match self {
            Self::Above => Affine::IDENTITY,
            Self::Below => Affine::scale_non_uniform(-1.0, 1.0),
            Self::Tilted([u, v, n]) => Affine::new([u[0], u[1], v[0], v[1], z * n[0], z * n[1]]),
        }
    }

    /// A curve of the entity in the drawing.
    pub fn place(self, curve: Curve, z: f64) -> Curve {
        match self {
            Self::Above => curve,
            Self::Below | Self::Tilted(_) => curve.transformed(self.affine(z)),
        }
    }

    /// The height in the drawing of a height in the plane.
    pub fn height(self, z: f64) -> f64 {
        if matches!(self, Self::Below) { -z } else { z }
    }

    /// The level of an entity at a height in the plane.
    pub fn level(self, z: f64) -> Level {
        match self {
            Self::Above | Self::Below => Level::At(self.height(z)),
            Self::Tilted(_) => Level::Leaves,
        }
    }

    /// The unit normal.
    pub fn normal(self) -> [f64; 3] {
        match self {
            Self::Above => [0.0, 0.0, 1.0],
            Self::Below => [0.0, 0.0, -1.0],
            Self::Tilted([_, _, n]) => n,
        }
    }
}

/// The cross product.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along a vector that is not zero.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let most = v.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let v = v.map(|x| x / most);
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// The level of points of an entity without a plane.
pub(super) fn flat(points: &[[f64; 3]]) -> Level {
    let spread = |axis: usize| {
        let values = points.iter().map(|p| p[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    if spread(2) > FLAT * spread(0).max(spread(1)) {
        return Level::Leaves;
    }
    Level::At(points.first().map_or(0.0, |p| p[2]))
}

/// The same for an entity that must be parallel to the XY plane, with its points in it.
pub(super) fn parallel(points: &[[f64; 3]]) -> Result<(Vec<Point>, Level), Refusal> {
    match flat(points) {
        Level::Leaves => Err(Refusal::Skip(TILTED)),
        level @ Level::At(_) => Ok((points.iter().map(|p| Point::new(p[0], p[1])).collect(), level)),
    }
}
