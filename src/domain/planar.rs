//! The planar domain: a piecewise regular curve complex (PRCC, Pav & Walkington 2005, Definition 1) with regions and names.
//!
//! Promised: the ends of every curve are points of P, bit for bit; curves meet at most in common end points; no point of P lies inside
//! a curve; no curve is closed, has a cusp or a tangent jump inside, or zero length; every curve knows the kept region on either side.

use super::Repair;
use crate::curve::{Curve, End};
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, IdVec, NameId, Names, PointId, RegionId};

/// A planar domain. Made by [`super::Drawing::arrange`] only.
#[derive(Clone, Debug)]
pub struct Domain {
    pub(super) points: IdVec<PointId, Point>,
    pub(super) curves: IdVec<CurveId, DomainCurve>,
    pub(super) regions: IdVec<RegionId, Region>,
    pub(super) names: Names,
    /// Name of a point, where the drawing gave one.
    pub(super) point_names: std::collections::BTreeMap<PointId, NameId>,
    pub(super) repairs: Vec<Repair>,
    /// The welding distance that was used: how far a curve may have been moved at its ends.
    pub(super) tolerance: f64,
    /// Curves incident to each point, counter-clockwise by the direction in which they leave (ties: as they lie a little way off).
    pub(super) stars: IdVec<PointId, Vec<Incident>>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct DomainCurve {
    pub curve: Curve,
    pub ends: [PointId; 2],
    /// The kept region on the left and on the right of the curve; `None`: outside.
    pub sides: [Option<RegionId>; 2],
    pub name: NameId,
    /// The drawn curve that it is a part of (the first, where several overlapped).
    pub source: u32,
}

/// A curve at a point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Incident {
    pub curve: CurveId,
    /// Which end of the curve lies at the point.
    pub end: End,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    pub name: NameId,
    /// Exact area, by Green over the curves themselves.
    pub area: f64,
    pub max_area: Option<f64>,
}

/// The smallest angle between two curves at a point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Corner {
    pub angle_rad: f64,
    pub between: [CurveId; 2],
}

impl Domain {
    pub fn points(&self) -> &IdVec<PointId, Point> {
        &self.points
    }
    pub fn curves(&self) -> &IdVec<CurveId, DomainCurve> {
        &self.curves
    }
    pub fn regions(&self) -> &IdVec<RegionId, Region> {
        &self.regions
    }
    pub fn names(&self) -> &Names {
        &self.names
    }
    pub fn name(&self, id: NameId) -> &str {
        self.names.text(id)
    }
    pub fn point_names(&self) -> &std::collections::BTreeMap<PointId, NameId> {
        &self.point_names
    }
    pub fn repairs(&self) -> &[Repair] {
        &self.repairs
    }
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }
    /// Curves at a point, counter-clockwise.
    pub fn star(&self, p: PointId) -> &[Incident] {
        &self.stars[p]
    }
    pub fn bounds(&self) -> Rect {
        todo!()
    }
    /// The smallest angle by tangents between neighbours at p (all curves count, kept or not); `None` with fewer than two curves.
    pub fn corner(&self, _p: PointId) -> Option<Corner> {
        todo!()
    }
    /// Whether two curves meet at p at less than 90° by tangents (zero included; 90° up to rounding is no acute corner).
    pub fn is_acute(&self, _p: PointId) -> bool {
        todo!()
    }
    /// lfs₀ at every point of P: the distance to the nearest other point (infinite of a single point).
    pub fn lfs0(&self) -> IdVec<PointId, f64> {
        todo!()
    }
    /// lfs at every point of P: the distance to the nearest feature that does not contain it.
    pub fn lfs(&self) -> IdVec<PointId, f64> {
        todo!()
    }
    /// The complex with every curve cut until it turns at most `tau` (≤ π/3); the cuts become points of P.
    pub fn split_to_turning(&self, _tau: f64) -> Domain {
        todo!()
    }
    /// All coordinates (areas, tolerances, repairs) times a power of two: exact.
    pub fn scaled(&self, _factor: f64) -> Domain {
        todo!()
    }
    /// The exact area of all kept regions.
    pub fn measure(&self) -> f64 {
        self.regions.iter().map(|r| r.area).sum()
    }
    /// Every broken promise, with culprits and a sentence each. Empty of a right domain.
    pub fn flaws(&self) -> Vec<String> {
        todo!()
    }
}
