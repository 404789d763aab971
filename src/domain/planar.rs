//! The planar domain: a piecewise regular curve complex (PRCC, Pav & Walkington 2005, Definition 1) with regions and
//! names.
//!
//! Guarantees: the ends of every curve are points of P, bit for bit. Curves meet at most in common end points. No point
//! of P lies inside a curve. No curve is closed, has zero length, or has a cusp or a tangent jump inside. Every curve
//! has the kept region on either side, if there is one.

use super::Repair;
use super::features::Features;
use super::locate::Locator;
use crate::curve::{Curve, End};
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect, bounds_of, scaled, turn_from};
use crate::ids::{Colour, CurveId, Id, IdVec, NameId, Names, PointId, RegionId};
use crate::watch::{Progress, Stopped, Watch};
use std::f64::consts::FRAC_PI_2;

/// A planar domain. [`super::Drawing::arrange`] is its only constructor.
#[derive(Clone, Debug)]
pub struct Domain {
    /// The points P.
    pub(super) points: IdVec<PointId, Point>,
    /// The curves C, each between two points of P.
    pub(super) curves: IdVec<CurveId, DomainCurve>,
    /// The regions that are meshed.
    pub(super) regions: IdVec<RegionId, Region>,
    /// The texts of all names.
    pub(super) names: Names,
    /// Colours of regions, by name.
    pub(super) colours: std::collections::BTreeMap<NameId, Colour>,
    /// Name of a point, where the drawing gave one.
    pub(super) point_names: std::collections::BTreeMap<PointId, NameId>,
    /// What was repaired in the drawing.
    pub(super) repairs: Vec<Repair>,
    /// Notes of the arrangement on the drawing as a whole, one sentence each.
    pub(super) notes: Vec<String>,
    /// The tolerance that was used: the ends of a curve may have been moved by up to this much.
    pub(super) tolerance: f64,
    /// The curves at each point, counter-clockwise by the direction in which they leave; where directions are equal, by
    /// how the curves lie a little farther away.
    pub(super) stars: IdVec<PointId, Vec<Incident>>,
}

/// A curve of the domain, from one point of P to another.
#[derive(Clone, Debug, PartialEq)]
pub struct DomainCurve {
    /// The geometry, in units of the drawing; its parameter runs from 0 to 1.
    pub curve: Curve,
    /// The points of P at the start and the end of the curve.
    pub ends: [PointId; 2],
    /// The kept region on the left and on the right of the curve; `None`: outside.
    pub sides: [Option<RegionId>; 2],
    /// The name of the boundary that the curve belongs to.
    pub name: NameId,
    /// The index of the drawn curve that it is a part of (the first, where several overlapped).
    pub source: u32,
}

/// A curve at a point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Incident {
    /// A curve that ends at the point.
    pub curve: CurveId,
    /// Which end of the curve lies at the point.
    pub end: End,
}

/// A face of the arrangement that is meshed.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The name of the region; several regions may have the same one.
    pub name: NameId,
    /// Whether the drawing or the user gave the name. If not, it is the layer of its outline, or `region`, with a
    /// number.
    pub is_named: bool,
    /// The exact area, by Green's theorem over the curves themselves.
    pub area: f64,
    /// The largest area of a triangle, in the square of the drawing's unit; `None`: no limit of its own.
    pub max_area: Option<f64>,
}

/// The smallest angle between two curves at a point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Corner {
    /// The angle between the tangents, in radians, from 0 to π.
    pub angle_rad: f64,
    /// The two curves that enclose the angle, neighbours in the star of the point.
    pub between: [CurveId; 2],
}

impl Domain {
    /// The points P: the ends of the curves, and the drawn points.
    pub fn points(&self) -> &IdVec<PointId, Point> {
        &self.points
    }
    /// The curves between points of P; two of them meet only in common ends.
    pub fn curves(&self) -> &IdVec<CurveId, DomainCurve> {
        &self.curves
    }
    /// The faces that are meshed.
    pub fn regions(&self) -> &IdVec<RegionId, Region> {
        &self.regions
    }
    /// The colours of regions, by name, where the drawing has some.
    pub fn colours(&self) -> &std::collections::BTreeMap<NameId, Colour> {
        &self.colours
    }
    /// The names of boundaries, regions and points, by id.
    pub fn names(&self) -> &Names {
        &self.names
    }
    /// The text of a name of this domain.
    pub fn name(&self, id: NameId) -> &str {
        self.names.text(id)
    }
    /// The names of points, where the drawing gave one; other points have no entry.
    pub fn point_names(&self) -> &std::collections::BTreeMap<PointId, NameId> {
        &self.point_names
    }
    /// What was repaired in the drawing, with places.
    pub fn repairs(&self) -> &[Repair] {
        &self.repairs
    }
    /// Notes of the arrangement on the drawing as a whole, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
    /// The tolerance that was used, in units of the drawing.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }
    /// Puts a repair of the drawing as a whole before the others.
    pub(crate) fn itemise_first(&mut self, repair: Repair) {
        self.repairs.insert(0, repair);
    }
    /// Curves at a point, counter-clockwise.
    pub fn star(&self, p: PointId) -> &[Incident] {
        &self.stars[p]
    }
    /// The box around all curves and points.
    pub fn bounds(&self) -> Rect {
        let curves = self.curves.iter().map(|c| c.curve.bounds());
        let points = bounds_of(self.points.iter().copied());
        curves.chain(points).reduce(|a, b| a.union(b)).unwrap_or_default()
    }

    /// The smallest angle between the tangents of neighbours at p (all curves count, whether they border a region or
    /// not); `None` with fewer than two curves.
    pub fn corner(&self, p: PointId) -> Option<Corner> {
        let star = self.star(p);
        let direction = |i: Incident| self.curves[i.curve].curve.direction_at(i.end);
        let neighbours = star.iter().zip(star.iter().cycle().skip(1)).take(if star.len() < 2 { 0 } else { star.len() });
        let corners = neighbours.map(|(&a, &b)| Corner {
            angle_rad: turn_from(direction(a), direction(b)).abs(),
            between: [a.curve, b.curve],
        });
        corners.min_by(|a, b| a.angle_rad.total_cmp(&b.angle_rad))
    }

    /// Whether the tangents of two curves at p enclose less than 90° (0 included). 90° up to rounding is not acute.
    pub fn is_acute(&self, p: PointId) -> bool {
        self.corner(p).is_some_and(|corner| corner.angle_rad < FRAC_PI_2 - self.angle_rounding(p))
    }

    /// The sharp corner of the drawing across which two places of a triangle lie, if there is one. The two places lie
    /// on two curves that end at the corner, at equal distances from it, and less than 60° apart as seen from it. No
    /// mesh can avoid that angle. If one of them is the other end of its curve, the third place must lie on one of the
    /// two curves. `curves[i]` are the curves at the i-th place of the triangle; `places` are the first two.
    ///
    /// ```text
    ///              ╱ places[0]      u and v lead from the corner to the two places: |u| = |v| up to a thousandth, and
    ///          u ╱                  the angle between them is below 60°. A triangle of the two places and a third one
    ///   corner ●                    beyond them is narrow because the corner is.
    ///          v ╲
    ///              ╲ places[1]
    /// ```
    pub fn corner_between(&self, curves: [&[CurveId]; 3], places: [Point; 2]) -> Option<PointId> {
        // Places that were cut at one distance differ by rounding. Where they differ by more than a thousandth, the
        // triangle has a longer side that can be split.
        const EQUAL: f64 = 1e-3;
        let narrow = |corner: PointId| {
            let [u, v] = places.map(|place| place - self.points[corner]);
            let (a, b) = (u.hypot(), v.hypot());
            // 60° up to rounding is no small angle.
            (a - b).abs() <= EQUAL * a.min(b) && u.dot(v) > (0.5 + 1e-8) * a * b
        };
        let ends = |c: CurveId| self.curves[c].ends;
        let is_end = |i: usize, c: CurveId| ends(c).iter().any(|&p| self.points[p] == places[i]);
        let between = |c: CurveId, d: CurveId| {
            !(is_end(0, c) || is_end(1, d)) || curves[2].contains(&c) || curves[2].contains(&d)
        };
        let meets = |p: PointId, c: CurveId| curves[1].iter().any(|&d| d != c && ends(d).contains(&p) && between(c, d));
        curves[0].iter().flat_map(|&c| ends(c).map(|p| (c, p))).find(|&(c, p)| narrow(p) && meets(p, c)).map(|(_, p)| p)
    }

    /// By how much rounded coordinates can change a right angle at p: four units in the last place of the coordinates,
    /// over the shortest chord at p.
    fn angle_rounding(&self, p: PointId) -> f64 {
        let at = self.points[p];
        let ends = self.star(p).iter().flat_map(|i| self.curves[i.curve].ends).map(|end| self.points[end]);
        let chord = ends.map(|end| at.distance(end)).filter(|&d| d > 0.0).fold(f64::INFINITY, f64::min);
        4.0 * f64::EPSILON * (at.x.abs().max(at.y.abs()) / chord + 1.0)
    }

    /// lfs₀ at every point of P: the distance to the nearest other point (infinite for a single point).
    pub fn lfs0(&self) -> IdVec<PointId, f64> {
        let boxes = BoxHierarchy::new(self.points.iter().map(|&p| Rect::from_points(p, p)));
        let points = self.points.as_slice();
        let nearest = |(id, &p): (PointId, &Point)| {
            let away = |i: usize, _| if i == id.index() { f64::INFINITY } else { p.distance(points[i]) };
            boxes.nearest(p, f64::INFINITY, away).map_or(f64::INFINITY, |(_, d)| d)
        };
        self.points.enumerate().map(nearest).collect()
    }

    /// lfs at every point of P: the distance to the nearest feature that does not contain it.
    pub fn lfs(&self) -> IdVec<PointId, f64> {
        let boxes = BoxHierarchy::new(self.curves.iter().map(|c| c.curve.bounds()));
        let mut lfs = self.lfs0();
        for (id, &p) in self.points.enumerate() {
            let away = |i: usize, _| {
                let curve = &self.curves[CurveId::from_index(i)];
                if curve.ends.contains(&id) { f64::INFINITY } else { curve.curve.nearest(p, 0.0, 1.0).1 }
            };
            if let Some((_, d)) = boxes.nearest(p, lfs[id], away) {
                lfs[id] = d;
            }
        }
        lfs
    }

    /// A search structure for many queries of the local feature size.
    pub fn features(&self) -> Features<'_> {
        Features::new(self)
    }

    /// The domain with every curve cut into parts that turn by at most `tau` (≤ π/3, in radians). The cuts become
    /// points of P.
    pub fn split_to_turning(&self, tau: f64) -> Domain {
        self.split_to_turning_watched(tau, &mut |_| true).unwrap_or_else(|Stopped| unreachable!("nobody says stop"))
    }

    /// [`Domain::split_to_turning`], as long as `watch` says to go on. The watch receives the number of points before
    /// any is made: a tiny `tau` may take more than the memory holds.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn split_to_turning_watched(&self, tau: f64, watch: &mut Watch) -> Result<Domain, Stopped> {
        let mut told = Progress { phase: "cutting", vertices: self.points.len(), queued: self.curves.len() };
        for whole in self.curves.iter() {
            told.vertices = told.vertices.saturating_add(whole.curve.parts_of_turning(tau) - 1);
            told.tell(watch)?;
        }
        let mut split = Domain { curves: IdVec::new(), stars: IdVec::new(), ..self.clone() };
        // By curve: its first and its last part.
        let mut parts: IdVec<CurveId, [CurveId; 2]> = IdVec::with_capacity(self.curves.len());
        let mut middles = Vec::new();
        for whole in self.curves.iter() {
            let cuts = whole.curve.cuts_of_turning(tau);
            let first = CurveId::from_index(split.curves.len());
            let (mut from, mut t0) = (whole.ends[0], 0.0);
            told.queued -= 1;
            for &t1 in &cuts {
                told.tell(watch)?;
                let curve = whole.curve.part(t0, t1);
                let to = split.points.push(curve.end());
                let id = split.curves.push(DomainCurve { curve, ends: [from, to], ..whole.clone() });
                middles.push(vec![
                    Incident { curve: id, end: End::Finish },
                    Incident { curve: CurveId::from_index(id.index() + 1), end: End::Start },
                ]);
                (from, t0) = (to, t1);
            }
            let curve = if cuts.is_empty() { whole.curve.clone() } else { whole.curve.part(t0, 1.0) };
            let last = split.curves.push(DomainCurve { curve, ends: [from, whole.ends[1]], ..whole.clone() });
            parts.push([first, last]);
        }
        let renamed = |i: &Incident| match i.end {
            End::Start => Incident { curve: parts[i.curve][0], end: i.end },
            End::Finish => Incident { curve: parts[i.curve][1], end: i.end },
        };
        split.stars = self.stars.iter().map(|star| star.iter().map(renamed).collect()).chain(middles).collect();
        Ok(split)
    }

    /// The domain with all coordinates, areas, tolerances and repairs multiplied by a power of two: exact.
    pub fn scaled(&self, factor: f64) -> Domain {
        let mut domain = self.clone();
        domain.points.iter_mut().for_each(|p| *p = scaled(*p, factor));
        domain.curves.iter_mut().for_each(|c| c.curve = c.curve.scaled(factor));
        for region in domain.regions.iter_mut() {
            region.area *= factor * factor;
            region.max_area = region.max_area.map(|a| a * factor * factor);
        }
        domain.repairs.iter_mut().for_each(|r| r.scale(factor));
        domain.tolerance *= factor;
        domain
    }

    /// The exact area of all kept regions.
    pub fn area(&self) -> f64 {
        self.regions.iter().map(|r| r.area).sum()
    }

    /// A search structure for many queries of the region at a point.
    pub fn locator(&self) -> Locator<'_> {
        Locator::new(self)
    }

    /// The kept region that contains `p`. Builds the search structure each time: for many points use one
    /// [`Domain::locator`].
    pub fn locate_region(&self, p: Point) -> Option<RegionId> {
        self.locator().region(p)
    }
}
