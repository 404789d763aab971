//! The largest size of a cell at each place: limits on edges, areas, chord error and turning, by name, near sources,
//! graded.
//!
//! A [`Sizing`] holds the limits. A [`SizeField`] is the same, resolved for a domain, and gives the limit at a place.
//! Engine and verifier use the same field, so the verifier checks exactly what was asked for.
//!
//! ```text
//!   limit ▲
//!         │ ╲          ╱               Each source sets the limit `edge` where it lies. The limit grows by `grade` a
//!         │  ╲  ╱╲    ╱                unit of distance away from it. At every place the smallest of these limits
//!         │   ╲╱  ╲  ╱                 holds.
//!         │        ╲╱ edge
//!         └────────────────▶ place
//! ```

pub mod estimate;
mod expression;
mod given;
mod limits;

pub use expression::Expression;
pub use given::{Given, SAMPLE_GRADE, rows_of};
pub use limits::{ChordError, EdgeTurning, Limits, SizeOf};

use crate::curve::{Curve, End};
use crate::domain::{Domain, Incident, SizeRequest};
use crate::geometry::{self, Point, boxes::BoxHierarchy};
use crate::ids::{CurveId, IdVec, PointId, RegionId};

/// The limits on cells, in the drawing's units. `None` and empty: no limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sizing {
    /// Largest area of a triangle.
    pub max_area: Option<f64>,
    /// Largest length of an edge.
    pub max_edge: Option<f64>,
    /// Triangles with a circumradius below this are not refined for their angles.
    pub min_edge: Option<f64>,
    /// Largest distance from a mesh edge to its curve.
    pub chord_error: Option<f64>,
    /// Largest turning of the curve along a mesh edge, in radians.
    pub edge_turning_rad: Option<f64>,
    /// Growth of the limit of a named boundary or region, a unit of distance away from it; `None`: the limit holds only
    /// there.
    pub grade: Option<f64>,
    /// Limits of named boundaries, of named regions and around places.
    pub sources: Vec<Source>,
    /// An expression for the longest edge at a place.
    pub by_place: Option<ByPlace>,
}

/// An expression whose coordinates are those of the field divided by `scale`.
#[derive(Clone, Debug, PartialEq)]
pub struct ByPlace {
    /// The longest edge as a function of the place; a value that is not positive sets no limit there.
    pub expression: Expression,
    /// Units of the field in one unit of the expression, for coordinates and values alike; a power of two.
    pub scale: f64,
}

impl ByPlace {
    /// The limit at a place; infinite where the expression has no positive value.
    fn at(&self, p: Point) -> f64 {
        let value = self.scale * self.expression.at(geometry::scaled(p, 1.0 / self.scale));
        if value > 0.0 { value } else { f64::INFINITY }
    }
}

/// A limit with the place where it holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Edges on the boundary of this name.
    Boundary {
        /// The name of the boundary.
        name: String,
        /// The largest length of an edge on it.
        edge: f64,
    },
    /// Edges in the region of this name.
    Region {
        /// The name of the region.
        name: String,
        /// The largest length of an edge in it.
        edge: f64,
    },
    /// Cells near a segment, growing by `grade` a unit of distance.
    Near {
        /// The start of the segment.
        from: Point,
        /// The end of the segment; equal to `from` for a single place.
        to: Point,
        /// The largest length of an edge on the segment.
        edge: f64,
        /// The growth of that limit a unit of distance from the segment; 0: it holds everywhere.
        grade: f64,
    },
}

impl Sizing {
    /// Adds the size requests that came with a drawing.
    pub fn with_requests(mut self, requests: &[SizeRequest], name_of: impl Fn(crate::ids::NameId) -> String) -> Self {
        for request in requests {
            match *request {
                SizeRequest::Boundary { name, edge } => {
                    self.sources.push(Source::Boundary { name: name_of(name), edge });
                }
                SizeRequest::Region { name, edge } => self.sources.push(Source::Region { name: name_of(name), edge }),
                SizeRequest::Near { from, to, edge, grade } => {
                    self.sources.push(Source::Near { from, to, edge, grade });
                }
                SizeRequest::Everywhere { edge } => {
                    self.max_edge = Some(self.max_edge.map_or(edge, |e| e.min(edge)));
                }
            }
        }
        self
    }

    /// All lengths times a power of two (areas times its square): exact.
    pub fn scaled(&self, factor: f64) -> Self {
        let length = |v: Option<f64>| v.map(|v| v * factor);
        let source = |s: &Source| match s.clone() {
            Source::Boundary { name, edge } => Source::Boundary { name, edge: edge * factor },
            Source::Region { name, edge } => Source::Region { name, edge: edge * factor },
            Source::Near { from, to, edge, grade } => Source::Near {
                from: geometry::scaled(from, factor),
                to: geometry::scaled(to, factor),
                edge: edge * factor,
                grade,
            },
        };
        Self {
            max_area: self.max_area.map(|a| a * factor * factor),
            max_edge: length(self.max_edge),
            min_edge: length(self.min_edge),
            chord_error: length(self.chord_error),
            edge_turning_rad: self.edge_turning_rad,
            grade: self.grade,
            sources: self.sources.iter().map(source).collect(),
            by_place: self.by_place.clone().map(|b| ByPlace { scale: b.scale * factor, ..b }),
        }
    }
}

/// Sizes resolved for a domain: the limits at a place.
pub struct SizeField {
    sizing: Sizing,
    curve_edges: IdVec<CurveId, f64>,
    region_edges: IdVec<RegionId, f64>,
    region_areas: IdVec<RegionId, f64>,
    /// The limits that grow with the distance; `boxes` are those of their carriers.
    growing: Vec<Growing>,
    boxes: BoxHierarchy,
    /// The smallest of the limits that hold everywhere, because they do not grow.
    flat: f64,
    /// The smallest and the largest growth of a limit, a unit of distance.
    grades: (f64, f64),
}

/// A limit that is `edge` on a carrier, and grows by `grade` a unit of distance from it.
struct Growing {
    carrier: Carrier,
    edge: f64,
    grade: f64,
}

enum Carrier {
    Segment(Point, Point),
    Curve(Curve),
}

impl Growing {
    fn bounds(&self) -> geometry::Rect {
        match &self.carrier {
            Carrier::Segment(a, b) => geometry::Rect::from_points(*a, *b),
            Carrier::Curve(curve) => curve.bounds(),
        }
    }

    fn at(&self, p: Point) -> f64 {
        let away = match &self.carrier {
            Carrier::Segment(a, b) => distance_to_segment(p, *a, *b),
            Carrier::Curve(curve) => curve.nearest(p, 0.0, 1.0).1,
        };
        self.edge + self.grade * away
    }
}

fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (ab, ap) = (b - a, p - a);
    let share = if ab.hypot2() > 0.0 { (ap.dot(ab) / ab.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
    (ap - share * ab).hypot()
}

impl SizeField {
    /// Resolves limits for a domain: names become curves and regions.
    pub fn new(sizing: &Sizing, domain: &Domain) -> Self {
        let everywhere = sizing.max_edge.unwrap_or(f64::INFINITY);
        let named_curve = |name: &str| {
            sizing.sources.iter().fold(everywhere, |limit, s| match s {
                Source::Boundary { name: n, edge } if n == name => limit.min(*edge),
                _ => limit,
            })
        };
        let named_region = |name: &str| {
            sizing.sources.iter().fold(everywhere, |limit, s| match s {
                Source::Region { name: n, edge } if n == name => limit.min(*edge),
                _ => limit,
            })
        };
        let curve_edges: IdVec<CurveId, f64> =
            domain.curves().iter().map(|c| named_curve(domain.name(c.name))).collect();
        let everywhere_area = sizing.max_area.unwrap_or(f64::INFINITY);
        let near = sizing.sources.iter().filter_map(|s| match *s {
            Source::Near { from, to, edge, grade } => {
                Some(Growing { carrier: Carrier::Segment(from, to), edge, grade })
            }
            Source::Boundary { .. } | Source::Region { .. } => None,
        });
        let region_edges: IdVec<RegionId, f64> =
            domain.regions().iter().map(|r| named_region(domain.name(r.name))).collect();
        // Outside a region, the distance from it is that from its border. Inside, the growing limit is larger than the
        // region's own.
        let graded = domain.curves().enumerate().filter_map(|(id, c)| {
            let beside = c.sides.iter().flatten().map(|&region| region_edges[region]);
            let edge = beside.fold(curve_edges[id], f64::min);
            let carrier = Carrier::Curve(c.curve.clone());
            (edge < everywhere).then_some(Growing { carrier, edge, grade: sizing.grade? })
        });
        let (growing, flat): (Vec<Growing>, Vec<Growing>) = near.chain(graded).partition(|g| g.grade > 0.0);
        let grades = growing.iter().map(|g| g.grade);
        Self {
            region_edges,
            region_areas: domain
                .regions()
                .iter()
                .map(|r| r.max_area.unwrap_or(f64::INFINITY).min(everywhere_area))
                .collect(),
            boxes: BoxHierarchy::new(growing.iter().map(Growing::bounds)),
            flat: flat.iter().map(|g| g.edge).fold(f64::INFINITY, f64::min),
            grades: (grades.clone().fold(f64::INFINITY, f64::min), grades.fold(0.0, f64::max)),
            sizing: sizing.clone(),
            curve_edges,
            growing,
        }
    }

    /// The limits that the field was made of.
    pub fn sizing(&self) -> &Sizing {
        &self.sizing
    }

    /// Whether the limit depends on the place.
    pub fn limits_by_place(&self) -> bool {
        !self.growing.is_empty() || self.flat.is_finite() || self.sizing.by_place.is_some()
    }

    /// Longest edge allowed at a place because of sources nearby; infinite where there is no limit.
    pub fn limit_at(&self, at: Point) -> f64 {
        let by_place = self.sizing.by_place.as_ref().map_or(f64::INFINITY, |b| b.at(at));
        let limit = self.flat.min(by_place);
        if self.growing.is_empty() {
            return limit;
        }
        // A limit divided by the smallest grade is at least the distance, so the search can skip boxes by distance.
        let least = self.grades.0;
        let nearest = self.boxes.nearest(at, limit / least, |i, _| self.growing[i].at(at) / least);
        nearest.map_or(limit, |(i, _)| self.growing[i].at(at).min(limit))
    }

    /// Longest edge allowed on a curve at a place.
    pub fn edge_on(&self, curve: CurveId, at: Point) -> f64 {
        self.curve_edges[curve].min(self.limit_at(at))
    }

    /// Longest edge allowed in a region at a place.
    pub fn edge_in(&self, region: RegionId, at: Point) -> f64 {
        self.region_edges[region].min(self.limit_at(at))
    }

    /// Longest edge allowed anywhere on a curve.
    pub fn longest_edge(&self, curve: CurveId) -> f64 {
        self.curve_edges[curve].min(self.flat)
    }

    /// Largest area of a triangle allowed anywhere in a region, by the area limit and by the edges of an equilateral
    /// triangle.
    pub fn largest_triangle(&self, region: RegionId) -> f64 {
        let edge = self.region_edges[region].min(self.flat);
        self.region_areas[region].min(0.25 * 3f64.sqrt() * edge * edge)
    }

    /// Largest area allowed in a region.
    pub fn area_in(&self, region: RegionId) -> f64 {
        self.region_areas[region]
    }

    /// The target length of an edge in a region at a place: the longest allowed, or that of the largest equilateral
    /// triangle.
    pub fn length_in(&self, region: RegionId, at: Point) -> f64 {
        self.edge_in(region, at).min((self.area_in(region) * 4.0 / 3f64.sqrt()).sqrt())
    }

    /// The ratio of a triangle to its limits, by its longest edge and its area; at most 1: within them.
    pub fn excess(&self, region: RegionId, corners: [Point; 3]) -> f64 {
        let [a, b, c] = corners;
        let longest2 = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        let area = 0.5 * (b - a).cross(c - a);
        let centroid = a + ((b - a) + (c - a)) / 3.0;
        let edge = self.edge_in(region, centroid);
        (longest2 / (edge * edge)).max(area / self.area_in(region)).sqrt()
    }

    /// The largest radius of a ball at a corner, up to `most`, with which cells meet the limits although nothing inside
    /// it is ever refined.
    ///
    /// Its spokes are mesh edges: each must meet the limits on turning and chord error. A curve that is smooth at its
    /// end becomes straighter as it shortens, so the search ends; 200 steps are a factor of 1e-19.
    pub fn largest_ball(&self, domain: &Domain, corner: PointId, most: f64) -> f64 {
        let mut radius = most.min(self.largest_fan(domain, corner));
        for _ in 0..200 {
            let too_bent = domain.star(corner).iter().any(|&at| self.spoke_too_bent(domain, at, radius));
            if !too_bent && !self.fan_too_large(domain.points()[corner], radius) {
                break;
            }
            radius *= 0.8;
        }
        radius
    }

    /// Whether an expression forbids fans of this radius around a corner. It is sampled, since its variation is
    /// unknown.
    fn fan_too_large(&self, at: Point, radius: f64) -> bool {
        let Some(by_place) = &self.sizing.by_place else { return false };
        let ring = (0..16).map(|k| geometry::direction(f64::from(k) * std::f64::consts::FRAC_PI_8));
        let samples = ring.flat_map(|d| [at + radius * d, at + 2.0 * radius * d]);
        samples.chain([at]).any(|p| 2.0 * radius > by_place.at(p))
    }

    /// The largest radius d of a ball whose triangles meet the limits. A triangle with its circumcenter in B(p) has a
    /// circumradius below d(p), because p does not lie inside its circumcircle. So its edges are below 2d, its area is
    /// below (3√3/4)·d² < 1.3·d², and its corners lie within 2d of p.
    fn largest_fan(&self, domain: &Domain, corner: PointId) -> f64 {
        let at = domain.points()[corner];
        let steepest = self.grades.1;
        let mut radius = f64::INFINITY;
        for incident in domain.star(corner) {
            radius = radius.min(self.edge_on(incident.curve, at) / (1.0 + steepest));
            for region in domain.curves()[incident.curve].sides.into_iter().flatten() {
                radius = radius.min(self.edge_in(region, at) / (2.0 * (1.0 + steepest)));
                radius = radius.min((self.area_in(region) / 1.3).sqrt());
            }
        }
        radius
    }

    fn spoke_too_bent(&self, domain: &Domain, at: Incident, radius: f64) -> bool {
        let curve = &domain.curves()[at.curve].curve;
        if curve.is_straight() {
            return false;
        }
        match (at.end, curve.leaves_ball(at.end, radius, 0.0, 1.0)) {
            (End::Start, Some(t)) => self.edge_too_bent(curve, 0.0, t),
            (End::Finish, Some(t)) => self.edge_too_bent(curve, t, 1.0),
            (_, None) => true,
        }
    }

    /// Whether a part of a curve is longer, turns more, or is farther from its chord than a mesh edge may be.
    pub fn edge_too_large(&self, curve: CurveId, shape: &Curve, t0: f64, t1: f64) -> bool {
        let (x, y) = (shape.point(t0), shape.point(t1));
        x.distance(y) > self.edge_on(curve, x.midpoint(y)) || self.edge_too_bent(shape, t0, t1)
    }

    /// Whether a part of a curve turns more, or is farther from its chord than a mesh edge may be.
    pub fn edge_too_bent(&self, shape: &Curve, t0: f64, t1: f64) -> bool {
        if shape.is_straight() {
            return false;
        }
        self.sizing.edge_turning_rad.is_some_and(|limit| shape.turning(t0, t1) > limit)
            || self.sizing.chord_error.is_some_and(|limit| shape.chord_error(t0, t1) > limit)
    }
}
