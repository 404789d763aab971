//! Local feature size: how far apart the features of a domain are, at any place.

use super::Domain;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, PointId};

/// The points and curves of a domain, for many queries of the local feature size.
pub struct Features<'a> {
    domain: &'a Domain,
    /// The boxes of the curves, then those of the points.
    boxes: BoxHierarchy,
}

impl<'a> Features<'a> {
    /// Builds the search structure, in O(n log n).
    pub(super) fn new(domain: &'a Domain) -> Self {
        let curves = domain.curves().iter().map(|c| c.curve.bounds());
        let points = domain.points().iter().map(|&p| Rect::from_points(p, p));
        Self { domain, boxes: BoxHierarchy::new(curves.chain(points)) }
    }

    /// lfs(p): the radius of the smallest disk around p that meets two features without a common point of P (Ruppert
    /// 1995; Definition 2.2 of Foteinos, Chernikov & Chrisochoides 2010); infinite where there are no two such
    /// features.
    ///
    /// ```text
    ///      ────── e ─────●────── f ──────        e and f are the nearest features at p, but they have a point in
    ///              p                             common. The first feature that has no common point with a nearer one
    ///      ────────────── g ─────────────        is g: lfs(p) = |p g|.
    /// ```
    pub fn lfs(&self, p: Point) -> f64 {
        let Some(bounds) = self.boxes.boxes().iter().copied().reduce(|a, b| a.union(b)) else { return f64::INFINITY };
        let whole = p.distance(bounds.center()) + bounds.width() + bounds.height();
        let mut radius = self.boxes.nearest(p, f64::INFINITY, |i, _| self.distance(i, p)).map_or(whole, |(_, d)| d);
        // At a vertex of the domain the nearest distance is 0.
        radius = radius.max(1e-9 * whole);
        loop {
            radius *= 2.0;
            if let Some(lfs) = self.second_apart(p, radius) {
                return lfs;
            }
            if radius > whole {
                return f64::INFINITY;
            }
        }
    }

    /// lfs(p) if it is at most `radius`: the distance of the first feature, in the order of distance, that has no point
    /// in common with some nearer one.
    fn second_apart(&self, p: Point, radius: f64) -> Option<f64> {
        let mut near = Vec::new();
        self.boxes.meeting(Rect::from_points(p, p).inflate(radius, radius), |i| {
            near.push((self.distance(i, p), i));
            true
        });
        near.retain(|&(d, _)| d <= radius);
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let apart = |i: usize, j: usize| !self.points(i).iter().any(|v| self.points(j).contains(v));
        (1..near.len()).find(|&j| near[..j].iter().any(|&(_, i)| apart(i, near[j].1))).map(|j| near[j].0)
    }

    fn distance(&self, i: usize, p: Point) -> f64 {
        match i.checked_sub(self.domain.curves().len()) {
            None => self.domain.curves()[CurveId::from_index(i)].curve.nearest(p, 0.0, 1.0).1,
            Some(i) => p.distance(self.domain.points()[PointId::from_index(i)]),
        }
    }

    /// The points of P that a feature contains.
    fn points(&self, i: usize) -> [PointId; 2] {
        match i.checked_sub(self.domain.curves().len()) {
            None => self.domain.curves()[CurveId::from_index(i)].ends,
            Some(i) => [PointId::from_index(i); 2],
        }
    }
}
