//! How large a cell may be, and where: limits on edges, areas, chord error and turning; per name; near sources; graded.
//!
//! A [`Sizing`] is what is asked; [`SizeField`] is the same, resolved against a domain, and answers at a place. Engine and judge ask
//! the same field, so that what was asked is what is checked.

use crate::curve::Curve;
use crate::domain::{Domain, SizeRequest};
use crate::geometry::{self, Point, boxes::BoxHierarchy};
use crate::ids::{CurveId, IdVec, RegionId};

/// What is asked of cell sizes, in the drawing's units. `None` and empty: no limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sizing {
    pub max_area: Option<f64>,
    pub max_edge: Option<f64>,
    /// Triangles with a circumradius below this are not refined for their angles.
    pub min_edge: Option<f64>,
    /// Largest distance from a mesh edge to its curve.
    pub chord_error: Option<f64>,
    /// Largest turning of the curve along a mesh edge.
    pub edge_turning_rad: Option<f64>,
    /// Growth of a named boundary's limit, a unit of distance away from it; `None`: the limit acts on the boundary alone.
    pub grade: Option<f64>,
    pub sources: Vec<Source>,
}

/// Where a size is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Edges on the boundary of this name.
    Boundary { name: String, edge: f64 },
    /// Edges in the region of this name.
    Region { name: String, edge: f64 },
    /// Cells near a segment, growing by `grade` a unit of distance.
    Near { from: Point, to: Point, edge: f64, grade: f64 },
}

impl Sizing {
    /// Adds the wishes that came with a drawing.
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

    /// All lengths times a power of two (areas by its square): exact.
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
        }
    }
}

/// Sizes resolved against a domain: the limits at a place.
pub struct SizeField {
    sizing: Sizing,
    curve_edges: IdVec<CurveId, f64>,
    region_edges: IdVec<RegionId, f64>,
    region_areas: IdVec<RegionId, f64>,
    near: Vec<(Curve, f64, f64)>,
    /// Named boundaries whose limit grows into the domain, with their boxes.
    graded: Vec<(Curve, f64)>,
    boxes: BoxHierarchy,
    steepest: f64,
}

impl SizeField {
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
        let near: Vec<(Curve, f64, f64)> = sizing
            .sources
            .iter()
            .filter_map(|s| match *s {
                Source::Near { from, to, edge, grade } => Some((Curve::line(from, to).ok()?, edge, grade)),
                _ => None,
            })
            .collect();
        let graded: Vec<(Curve, f64)> = match sizing.grade {
            Some(_) => domain
                .curves()
                .enumerate()
                .filter(|&(id, _)| curve_edges[id] < everywhere)
                .map(|(id, c)| (c.curve.clone(), curve_edges[id]))
                .collect(),
            None => Vec::new(),
        };
        let steepest = near.iter().map(|&(_, _, g)| g).chain(sizing.grade).fold(0.0, f64::max);
        Self {
            region_edges: domain.regions().iter().map(|r| named_region(domain.name(r.name))).collect(),
            region_areas: domain
                .regions()
                .iter()
                .map(|r| r.max_area.unwrap_or(f64::INFINITY).min(everywhere_area))
                .collect(),
            boxes: BoxHierarchy::new(graded.iter().map(|(c, _)| c.bounds())),
            sizing: sizing.clone(),
            curve_edges,
            near,
            graded,
            steepest,
        }
    }

    pub fn sizing(&self) -> &Sizing {
        &self.sizing
    }

    /// Largest growth of the limit a unit of distance.
    pub fn steepest(&self) -> f64 {
        self.steepest
    }

    /// Whether the limit depends on the place.
    pub fn limits_by_place(&self) -> bool {
        !self.near.is_empty() || !self.graded.is_empty()
    }

    /// Longest edge allowed at a place because of sources nearby; infinite where nothing is asked.
    pub fn limit_at(&self, at: Point) -> f64 {
        let from_segments = self
            .near
            .iter()
            .map(|(segment, edge, grade)| edge + grade * segment.nearest(at, 0.0, 1.0).1)
            .fold(f64::INFINITY, f64::min);
        let Some(grade) = self.sizing.grade else { return from_segments };
        let limit_of = |i: usize| {
            let (curve, edge) = &self.graded[i];
            edge + grade * curve.nearest(at, 0.0, 1.0).1
        };
        // An item's limit is at least `grade` times its distance: a search by limit prunes boxes by distance · grade.
        let reach = if grade > 0.0 { from_segments / grade } else { f64::INFINITY };
        let nearest = self.boxes.nearest(at, reach, |i, _| if grade > 0.0 { limit_of(i) / grade } else { limit_of(i) });
        nearest.map_or(from_segments, |(i, _)| limit_of(i).min(from_segments))
    }

    /// Longest edge allowed on a curve at a place.
    pub fn edge_on(&self, curve: CurveId, at: Point) -> f64 {
        self.curve_edges[curve].min(self.limit_at(at))
    }

    /// Longest edge allowed in a region at a place.
    pub fn edge_in(&self, region: RegionId, at: Point) -> f64 {
        self.region_edges[region].min(self.limit_at(at))
    }

    /// Largest area allowed in a region.
    pub fn area_in(&self, region: RegionId) -> f64 {
        self.region_areas[region]
    }

    /// How many times a triangle is over its limits (1 and below: within them): by its longest edge and its area.
    pub fn excess(&self, region: RegionId, corners: [Point; 3]) -> f64 {
        let [a, b, c] = corners;
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt();
        let area = 0.5 * (b - a).cross(c - a);
        let centroid = a + ((b - a) + (c - a)) / 3.0;
        let by_edge = longest / self.edge_in(region, centroid);
        by_edge.max((area / self.area_in(region)).sqrt())
    }

    /// Whether a part of a curve is longer, turns more, or strays farther from its chord than a mesh edge may.
    pub fn edge_too_large(&self, curve: CurveId, shape: &Curve, t0: f64, t1: f64) -> bool {
        let (x, y) = (shape.point(t0), shape.point(t1));
        x.distance(y) > self.edge_on(curve, x.midpoint(y)) || self.edge_too_bent(shape, t0, t1)
    }

    /// Whether a part of a curve turns more, or strays farther from its chord than a mesh edge may.
    pub fn edge_too_bent(&self, shape: &Curve, t0: f64, t1: f64) -> bool {
        if shape.is_straight() {
            return false;
        }
        self.sizing.edge_turning_rad.is_some_and(|limit| shape.turning(t0, t1) > limit)
            || self.sizing.chord_error.is_some_and(|limit| shape.chord_error(t0, t1) > limit)
    }
}
