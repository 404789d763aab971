//! A lower estimate of the number of vertices of a mesh, before it is made.
//!
//! *Slivers.* Where the face beside an edge of the border is w wide, the edge is no longer than w·(cot κ + tan κ): the
//! apex of its triangle is no farther away than w, both angles at the edge are κ or more, and the apex is not in the
//! edge's diametral circle. If the apex may be in it ([`Circles::Any`]), the edge is no longer than 2w·cot κ. So a
//! sliver of length L takes L/(w·(cot κ + tan κ)) vertices on either side.
//!
//! ```text
//!   ─────────────── apex ●───────────      The angle at the apex is at most 90°. So if one angle at the edge e is
//!                  ╱      ╲     w          κ, the other is at least 90° − κ, and e ≤ w·(cot κ + tan κ).
//!             κ ╱          ╲ 90° − κ
//!   ───────●─────── e ──────●────────
//! ```
//!
//! The shape of the sliver does not matter: a strip with free ends, a thin region in another, a ring. A needle of angle
//! θ takes about 1/θ vertices for every doubling of the distance from the ball of its tip. Exempt are triangles within
//! the initial ball of a corner (without corner arcs within two radii) and, with constrained refinement, all triangles
//! between two curves that meet at a sharp corner. Triangles with a circumradius below `min_edge` are exempt, too
//! (edges up to twice that). Widths are measured along normals at samples, and a stretch counts with its largest width.
//!
//! *Certainty.* If the same curve lies opposite a whole stretch, the width between the samples is known. Corner lopping
//! only ever halves straight lines and arcs of circles, so their parts no longer than ℓ are a power of two in number.
//! Other stretches count half. A curve with slivers on both sides counts with the side that takes more.
//!
//! *Sizes.* The number of triangles in a region is at least its area over that of the largest triangle. The number of
//! edges on a curve is at least its length over the longest edge, its turning over the largest turning of an edge, and
//! √(κ/8E) a unit of length for the curvature κ and the chord error E. There are at most two triangles a vertex. The
//! result is halved, because curvatures are known only at samples. Sizes that vary with the place are left out.
//!
//! Where no stretch is certain, runs take about ten times as many vertices as estimated.

use super::{SizeField, Sizing};
use crate::curve::{Curve, End};
use crate::domain::{Domain, DomainCurve};
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect, Vec2};
use crate::ids::{CurveId, Id, IdVec, PointId};
use crate::watch::{Progress, Stopped, Watch};
use std::f64::consts::SQRT_2;

/// A sliver is at least this many times as long as it is wide: a wider one takes only a few vertices.
const SLENDER: f64 = 16.0;

/// The largest number of samples on one side of a curve. Between curves that part from a common tangent, some 1500
/// reach the resolution of coordinates.
const SAMPLES_MAX: usize = 4096;

/// After this many slivers the widths of the others are taken to be similar.
const SAMPLE: usize = 8192;

/// Without corner arcs, triangles within this many radii of an initial ball are exempt.
const EXCUSED_RADII: f64 = 2.0;

/// A sliver that takes fewer vertices is not examined more closely.
const CHEAP: f64 = 1000.0;

/// Stretches are halved until the widths on them differ by no more than this factor.
const ALIKE: f64 = 1.25;

/// A factor for what samples miss.
const CAUTION: f64 = 0.5;

/// A stretch of a curve with another curve close beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliver {
    /// The point of the curve in the middle of the stretch, by parameter.
    pub at: Point,
    /// The largest width between the two curves, in units of the drawing.
    pub width: f64,
    /// The arc length of the stretch, in units of the drawing.
    pub length: f64,
    /// Whether a region lies between them.
    pub kept: bool,
    curve: CurveId,
    side: usize,
    t: [f64; 2],
}

/// Whether the engine keeps the diametral circles of edges on curves empty.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Circles {
    /// The diametral circles of curve edges have no vertex inside (corner lopping).
    Empty,
    /// The diametral circles of curve edges may have vertices inside (constrained refinement).
    Any,
}

/// The requirements on a mesh that decide how many vertices it takes.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// κ.
    pub angle_min_rad: f64,
    /// The limits on cells.
    pub sizing: &'a Sizing,
    /// What the engine guarantees about the diametral circles of curve edges.
    pub circles: Circles,
    /// Whether sharp corners get corner arcs.
    pub corner_arcs: bool,
    /// Whether curves are split at the bisectors of their chords.
    pub bisected: bool,
}

/// The number of vertices that a mesh takes at least, and where.
#[derive(Clone, Debug, Default)]
pub struct Demand {
    /// The number because of sizes.
    pub by_size: f64,
    /// The number and the place of the region or the curve that takes the most because of sizes.
    pub largest: Option<(f64, Point)>,
    /// The slivers of regions with the number of vertices that each takes, the most expensive first.
    pub slivers: Vec<(f64, Sliver)>,
}

impl Demand {
    /// The demand of a domain whose curves turn by at most π/3.
    ///
    /// # Errors
    /// [`Stopped`] where the watch ends the work.
    pub fn of(domain: &Domain, asked: Asked, watch: &mut Watch) -> Result<Self, Stopped> {
        let mut demand = Self::default();
        demand.add_sizes(domain, &SizeField::new(asked.sizing, domain));
        let radii = if asked.corner_arcs { 1.0 } else { EXCUSED_RADII };
        let survey = Survey::until(domain, radii, watch, |_| false)?;
        let price = Price { survey: &survey, asked };
        let found = survey.found.iter().filter(|sliver| sliver.kept);
        let slivers: Vec<(f64, Sliver)> = found.map(|sliver| (price.vertices(sliver), *sliver)).collect();
        let mut sides: IdVec<CurveId, [f64; 2]> = vec![[0.0; 2]; domain.curves().len()].into();
        slivers.iter().for_each(|(vertices, sliver)| sides[sliver.curve][sliver.side] += vertices);
        let dearer = |sliver: &Sliver| usize::from(sides[sliver.curve][1] > sides[sliver.curve][0]);
        demand.slivers = slivers.into_iter().filter(|(_, sliver)| sliver.side == dearer(sliver)).collect();
        demand.slivers.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(demand)
    }

    /// The number of vertices that the slivers of regions take together.
    pub fn by_slivers(&self) -> f64 {
        self.slivers.iter().map(|(n, _)| n).sum()
    }

    /// The number of vertices that the mesh takes at least.
    pub fn vertices(&self) -> f64 {
        self.by_size.max(self.by_slivers())
    }

    /// The most expensive places, at most 16.
    pub fn places(&self) -> Vec<Point> {
        const PLACES: usize = 16;
        match self.largest {
            Some((_, at)) if self.by_size >= self.by_slivers() => vec![at],
            _ => self.slivers.iter().map(|(_, s)| s.at).take(PLACES).collect(),
        }
    }

    /// The width up to which slivers must be welded so that the others take no more than `budget` vertices.
    pub fn width_over(&self, budget: f64) -> f64 {
        let mut by_width = self.slivers.clone();
        by_width.sort_by(|a, b| b.1.width.total_cmp(&a.1.width));
        let mut left = budget;
        let first = by_width.iter().find(|(n, _)| {
            left -= n;
            left < 0.0
        });
        first.map_or(0.0, |(_, s)| s.width)
    }

    fn add_sizes(&mut self, domain: &Domain, field: &SizeField) {
        let mut most = 0.0;
        for (id, region) in domain.regions().enumerate() {
            most += self.note(0.5 * region.area / field.largest_triangle(id), || {
                let border = domain.curves().iter().find(|c| c.sides.contains(&Some(id)));
                border.map_or(Point::ORIGIN, |c| c.curve.point(0.5))
            });
        }
        let mut on_curves = 0.0;
        for (id, DomainCurve { curve, .. }) in domain.curves().enumerate() {
            on_curves += self.note(edges_on(curve, field.longest_edge(id), field), || curve.point(0.5));
        }
        self.by_size = CAUTION * f64::max(most, on_curves);
    }

    fn note(&mut self, vertices: f64, at: impl Fn() -> Point) -> f64 {
        if vertices > self.largest.map_or(0.0, |(n, _)| n) {
            self.largest = Some((vertices, at()));
        }
        vertices
    }
}

/// The number of edges that a curve takes because of its length, its turning and the chord error.
fn edges_on(curve: &Curve, longest: f64, field: &SizeField) -> f64 {
    let length = curve.length();
    let mut edges = length / longest;
    if curve.is_straight() {
        return edges;
    }
    if let Some(limit) = field.sizing().edge_turning_rad {
        edges = edges.max(curve.turning(0.0, 1.0) / limit);
    }
    if let Some(limit) = field.sizing().chord_error.filter(|&e| curve.chord_error(0.0, 1.0) > e) {
        const SAMPLES: u32 = 8;
        let curvatures = (0..SAMPLES).map(|k| curve.curvature((f64::from(k) + 0.5) / f64::from(SAMPLES)).abs());
        let mean = curvatures.map(|c| (0.125 * c / limit).sqrt()).sum::<f64>() / f64::from(SAMPLES);
        edges = edges.max(length * mean);
    }
    edges
}

impl Sliver {
    /// The number of vertices that one side of it probably takes, in a mesh with angles of κ and more.
    fn vertices(&self, kappa_rad: f64) -> f64 {
        let slope = libm::tan(kappa_rad);
        let longest = self.width * (1.0 / slope + slope);
        CAUTION * (self.length / longest - 1.0).max(0.0)
    }
}

/// The number of vertices that slivers take at least.
struct Price<'a> {
    survey: &'a Survey<'a>,
    asked: Asked<'a>,
}

impl Price<'_> {
    /// The number of vertices on one side of a sliver.
    fn vertices(&self, sliver: &Sliver) -> f64 {
        let rough = CAUTION * (sliver.length / self.longest(sliver.width) - 1.0).max(0.0);
        if rough > 0.0 && self.asked.circles == Circles::Any && self.survey.lies_in_corner(sliver) {
            return 0.0;
        }
        if rough < CHEAP { rough } else { self.on_stretch(sliver, 0) }
    }

    /// The longest edge beside a place of this width.
    fn longest(&self, width: f64) -> f64 {
        let slope = libm::tan(self.asked.angle_min_rad);
        let factor = match self.asked.circles {
            Circles::Empty => 1.0 / slope + slope,
            Circles::Any => 2.0 / slope,
        };
        (factor * width).max(2.0 * self.asked.sizing.min_edge.unwrap_or(0.0))
    }

    /// The number of vertices on a stretch; where its width is not certain, the sum over its halves.
    fn on_stretch(&self, stretch: &Sliver, depth: u32) -> f64 {
        const DEPTH: u32 = 6;
        match self.survey.sure_width(stretch) {
            Some(width) => (stretch.length / self.piece(stretch.curve, self.longest(width)) - 1.0).max(0.0),
            None if depth == DEPTH => CAUTION * (stretch.length / self.longest(stretch.width) - 1.0).max(0.0),
            None => self.survey.halves(stretch).iter().map(|half| self.on_stretch(half, depth + 1)).sum(),
        }
    }

    /// The longest part of a curve that repeated halving makes and that is no longer than `longest`.
    fn piece(&self, id: CurveId, longest: f64) -> f64 {
        let DomainCurve { curve, ends, .. } = &self.survey.domain.curves()[id];
        let bisected = self.asked.circles == Circles::Empty
            && self.asked.bisected
            && self.asked.sizing.min_edge.is_none()
            && curve.is_round()
            && ends.iter().all(|&end| self.survey.ball(end) == 0.0);
        if !bisected {
            return longest;
        }
        // A part that is longer by only rounding is accepted.
        let length = curve.length();
        length / libm::exp2(libm::ceil(libm::log2(length / longest) - 1e-6).max(0.0))
    }
}

/// The slivers of a domain, kept or not, with the number of vertices that each probably takes. The search ends when
/// slivers of width `above` or more take over `most` vertices, or when all slivers so far do and there are so many that
/// the rest are probably similar. Exempt slivers outside of balls count, too: they need not be refined, but they are.
///
/// # Errors
/// [`Stopped`] where the watch ends the work.
pub fn costly_slivers(
    domain: &Domain,
    kappa_rad: f64,
    most: f64,
    above: f64,
    watch: &mut Watch,
) -> Result<Vec<(f64, Sliver)>, Stopped> {
    let taken = |sliver: &Sliver| sliver.vertices(kappa_rad);
    let (mut counted, mut all, mut wide) = (0, 0.0, 0.0);
    let survey = Survey::until(domain, 1.0, watch, |found| {
        let new = || found[counted..].iter();
        all += new().map(taken).sum::<f64>();
        wide += new().filter(|sliver| sliver.width >= above).map(taken).sum::<f64>();
        counted = found.len();
        wide > most || all > most && counted > SAMPLE
    })?;
    Ok(survey.found.into_iter().map(|sliver| (taken(&sliver), sliver)).collect())
}

struct Survey<'a> {
    domain: &'a Domain,
    boxes: BoxHierarchy,
    lfs0: IdVec<PointId, f64>,
    /// At either end a curve is left out within this many radii of the initial ball.
    radii: f64,
    found: Vec<Sliver>,
}

impl<'a> Survey<'a> {
    /// The slivers of a domain beyond `radii` radii around sharp corners, in the order of its curves, until `enough` of
    /// those so far is true. Each sliver is found from both of its sides.
    fn until(
        domain: &'a Domain,
        radii: f64,
        watch: &mut Watch,
        mut enough: impl FnMut(&[Sliver]) -> bool,
    ) -> Result<Self, Stopped> {
        let boxes = BoxHierarchy::new(domain.curves().iter().map(|c| c.curve.bounds()));
        let mut survey = Self { domain, boxes, lfs0: domain.lfs0(), radii, found: Vec::new() };
        for id in domain.curves().ids() {
            let queued = domain.curves().len() - id.index();
            Progress { phase: "estimating", vertices: domain.points().len(), queued }.tell(watch)?;
            for side in [0, 1] {
                survey.look_along(id, side);
            }
            if enough(&survey.found) {
                break;
            }
        }
        Ok(survey)
    }

    /// The width of a stretch if a single curve lies opposite all of it; else `None`. For two straight lines it is the
    /// width in the middle: the number of edges that the mean width allows is a lower bound. For others it is the
    /// largest sampled width and a twentieth more, for the places between samples.
    fn sure_width(&self, stretch: &Sliver) -> Option<f64> {
        const INSIDE: u32 = 16;
        let Sliver { curve, side, t: [t0, t1], length, .. } = *stretch;
        let across = |share: f64| self.across(curve, side, t0 + share * (t1 - t0), length);
        let (opposite, middle) = across(0.5)?;
        let beside = |share: f64| across(share).filter(|&(other, _)| other == opposite).map(|(_, width)| width);
        let (first, last) = (beside(1e-3)?, beside(1.0 - 1e-3)?);
        if [curve, opposite].iter().all(|&id| self.domain.curves()[id].curve.is_straight()) {
            // An edge is a few widths long. Along it the width changes by that length times the slope.
            return Some(middle * (1.0 + 4.0 * (first - last).abs() / length));
        }
        let inside = (1..INSIDE).map(|k| beside(f64::from(k) / f64::from(INSIDE)));
        inside.chain([Some(first), Some(last)]).try_fold(middle, |most, width| Some(most.max(width?))).map(|w| 1.05 * w)
    }

    fn halves(&self, stretch: &Sliver) -> [Sliver; 2] {
        let shape = &self.domain.curves()[stretch.curve].curve;
        let [t0, t1] = stretch.t;
        let middle = 0.5 * (t0 + t1);
        [[t0, middle], [middle, t1]].map(|t| Sliver { t, length: shape.length_of(t[0], t[1]), ..*stretch })
    }

    /// Whether a sliver lies between two curves with a common end.
    fn lies_in_corner(&self, sliver: &Sliver) -> bool {
        let [t0, t1] = sliver.t;
        let across = self.across(sliver.curve, sliver.side, 0.5 * (t0 + t1), sliver.length);
        let ends = |id: CurveId| self.domain.curves()[id].ends;
        across.is_some_and(|(other, _)| ends(other).iter().any(|end| ends(sliver.curve).contains(end)))
    }
}

impl Survey<'_> {
    /// Finds the slivers on one side of a curve, by halving it until the widths on each stretch are similar.
    fn look_along(&mut self, id: CurveId, side: usize) {
        let Some(whole) = self.outside_balls(id) else { return };
        let tips = self.domain.curves()[id].ends.map(|end| self.tip(end));
        let kept = self.domain.curves()[id].sides[side].is_some();
        let shape = &self.domain.curves()[id].curve;
        let mut samples = 0;
        let mut stretches = vec![whole];
        while let Some([t0, t1]) = stretches.pop() {
            let length = shape.length_of(t0, t1);
            samples += 3;
            let widths = [1.0 / 6.0, 0.5, 5.0 / 6.0].map(|f| self.width_at(id, side, t0 + f * (t1 - t0), length));
            let least = widths.into_iter().fold(f64::INFINITY, f64::min);
            let largest = widths.into_iter().fold(0.0, f64::max);
            let at_tip = t0 == whole[0] && length > tips[0] || t1 == whole[1] && length > tips[1];
            if samples > SAMPLES_MAX || length < SLENDER * least && !at_tip {
                continue;
            }
            let middle = 0.5 * (t0 + t1);
            if largest <= ALIKE * least && least < f64::INFINITY {
                let t = [t0, t1];
                self.found.push(Sliver { at: shape.point(middle), width: largest, length, kept, curve: id, side, t });
            } else if t0 < middle && middle < t1 {
                stretches.extend([[t0, middle], [middle, t1]]);
            }
        }
    }

    /// How near to the ball of a sharp corner a stretch is halved although no sliver is visible yet; infinite for other
    /// points.
    fn tip(&self, end: PointId) -> f64 {
        let sharp = self.domain.corner(end).is_some_and(|corner| corner.angle_rad < 1.0 / SLENDER);
        if sharp { EXCUSED_RADII * self.ball(end) } else { f64::INFINITY }
    }

    /// The initial radius of the ball of a point; 0 for a point without a ball.
    fn ball(&self, end: PointId) -> f64 {
        if self.domain.is_acute(end) { (SQRT_2 - 1.0) * self.lfs0[end] } else { 0.0 }
    }

    /// The part of a curve outside of `radii` radii of the initial balls at its ends.
    fn outside_balls(&self, id: CurveId) -> Option<[f64; 2]> {
        let DomainCurve { curve, ends, .. } = &self.domain.curves()[id];
        let leaves = |end: End, radius: f64, whole: f64| match radius > 0.0 {
            true => curve.leaves_ball(end, radius, 0.0, 1.0),
            false => Some(whole),
        };
        let reach = ends.map(|end| self.radii * self.ball(end));
        let part = [leaves(End::Start, reach[0], 0.0)?, leaves(End::Finish, reach[1], 1.0)?];
        (part[0] < part[1]).then_some(part)
    }

    /// The distance to the first other curve along the normal; infinite if there is none within a sixteenth of
    /// `length`.
    fn width_at(&self, id: CurveId, side: usize, t: f64, length: f64) -> f64 {
        self.across(id, side, t, length).map_or(f64::INFINITY, |(_, width)| width)
    }

    /// The first other curve along the normal within a sixteenth of `length`, and its distance.
    ///
    /// ```text
    ///   ──────────────┬──────── other
    ///                 │ width        The normal at t, on the left for `side` 0, on the right for 1.
    ///   ─────────────from────── id
    ///                 t
    /// ```
    fn across(&self, id: CurveId, side: usize, t: f64, length: f64) -> Option<(CurveId, f64)> {
        let shape = &self.domain.curves()[id].curve;
        let from = shape.point(t);
        let along = shape.tangent(t, End::Start);
        let normal = Vec2::new(-along.y, along.x) * if side == 0 { 1.0 } else { -1.0 };
        let mut nearest = length / SLENDER;
        let mut found = None;
        self.boxes.meeting(Rect::from_points(from, from + nearest * normal), |i| {
            let other = CurveId::from_index(i);
            if other != id {
                let shape = &self.domain.curves()[other].curve;
                for t in shape.line_crossings(from, normal, 0.0, 1.0) {
                    let away = (shape.point(t) - from).dot(normal);
                    if 0.0 < away && away <= nearest {
                        (nearest, found) = (away, Some((other, away)));
                    }
                }
            }
            true
        });
        found
    }
}
