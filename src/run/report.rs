//! The report: one JSON object a run, schema 1. Fields come in this order and change only by addition.
//!
//! All fields except `seconds` and `peak_memory_bytes` are the same, byte for byte, for the same input.

mod asked;

pub use asked::RequestReport;

use super::request::Request;
use crate::domain::{Drawing, Repair, Skipped};
use crate::geometry::Place;
use crate::mesh::Mesh;
use crate::mesh::quality::{BoundaryMeasure, Quality, RegionMeasure, boundary_measures, region_measures};
use crate::mesh::solid::SolidMesh;
use crate::mesh::solid::quality::{self as solid_quality, FacetMeasure, SolidQuality};
use crate::refine::{Counters, Stop, StopReason};
use crate::solid::{Solid, Surfaces};
use crate::verify::solid::WEIGHT_BOUND;
use crate::verify::{Check, Exemption, Verdict};
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON schema (draft 2020-12) of a type that is written as JSON. Numbers that are not finite are written as
/// `null`, so each number may be `null`.
pub fn schema_of<T: JsonSchema>() -> serde_json::Value {
    let unbounded = |schema: &mut Schema| {
        if schema.get("type").is_some_and(|kind| kind == "number") {
            schema.insert("type".into(), serde_json::json!(["number", "null"]));
        }
    };
    let settings = SchemaSettings::draft2020_12().for_serialize().with_transform(RecursiveTransform(unbounded));
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

/// Version of the report's schema.
pub const SCHEMA: u32 = 1;

/// The report of one run. Parts that the run did not reach are `null`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Report {
    /// Version of the schema: 1.
    pub schema: u32,
    /// Version of squinch that wrote the report.
    pub version: &'static str,
    /// What was read, and what was repaired in it.
    pub input: InputReport,
    /// Every option as used.
    pub request: RequestReport,
    /// Size and parts of the mesh.
    pub mesh: Option<MeshReport>,
    /// Angles, sizes and other measures of the mesh.
    pub quality: Option<QualityReport>,
    /// The verifier's checks of the mesh.
    pub promise: Option<PromiseReport>,
    /// Why refinement ended, and what is unresolved.
    pub stop: Option<StopReport>,
    /// Why there is no mesh, or why it must not be used; absent where the run came to its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<FailureReport>,
    /// Counts of the engine's steps, by name.
    pub counters: Counters,
    /// Wall-clock seconds of each stage.
    pub seconds: Seconds,
    /// Largest resident memory of the process, where the system tells it.
    pub peak_memory_bytes: Option<u64>,
}

/// The input of a run, as read.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct InputReport {
    /// As given on the command line.
    pub path: String,
    /// Name of the format.
    pub format: Option<String>,
    /// Title that the file gives, else its name without suffix.
    pub title: Option<String>,
    /// Unit of lengths: the file's, or the one asked for by `--unit`. `null` where neither is known.
    pub unit: Option<String>,
    /// Where the unit was read from.
    pub unit_from: Option<String>,
    /// How many of each kind; of a solid its points, segments and facets.
    pub curves: BTreeMap<&'static str, usize>,
    /// Entities that were left out, by kind and reason.
    pub skipped: Vec<Skipped>,
    /// Sentences on quirks of the file and liberties taken in reading it.
    pub notes: Vec<String>,
    /// Flaws of the drawing that were healed.
    pub repairs: Vec<Repair>,
    /// Where nothing is to be healed (`tolerance` 0): what the default would have mended, as `repairs` would list it.
    pub unhealed: Vec<Repair>,
}

impl InputReport {
    /// Notes what was read.
    pub fn describe(&mut self, drawing: &Drawing) {
        self.format = Some(drawing.format.clone());
        self.title = Some(drawing.title.clone());
        (self.unit, self.unit_from) = drawing.unit.clone().unzip();
        self.curves = kinds(drawing);
        self.skipped.clone_from(&drawing.skipped);
        self.notes.clone_from(&drawing.notes);
    }
}

impl InputReport {
    /// Notes the surfaces that were read.
    pub fn describe_surfaces(&mut self, surfaces: &Surfaces, title: &str) {
        self.format = Some(surfaces.format.clone());
        self.title = Some(title.to_owned());
        self.unit.clone_from(&surfaces.unit);
        self.curves = [("polygon", surfaces.facets.iter().map(|facet| facet.polygons.len()).sum())].into();
        self.notes.clone_from(&surfaces.notes);
    }

    /// Notes the solid that was made of them.
    pub fn describe_solid(&mut self, solid: &Solid) {
        let counts =
            [("facet", solid.facets().len()), ("point", solid.points().len()), ("segment", solid.segments().len())];
        self.curves = counts.into();
        self.notes = solid.repairs().to_vec();
    }
}

/// How many curves of each kind a drawing holds.
pub fn kinds(drawing: &Drawing) -> BTreeMap<&'static str, usize> {
    let mut kinds = BTreeMap::new();
    for drawn in &drawing.curves {
        *kinds.entry(drawn.curve.kind()).or_default() += 1;
    }
    kinds
}

/// The mesh in numbers.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeshReport {
    /// Number of nodes, those within edges (order 2) included.
    pub vertices: usize,
    /// Number of triangles; of a solid, those on its facets.
    pub triangles: usize,
    /// Number of tetrahedra: 0 in the plane.
    pub tetrahedra: usize,
    /// Number of edges on curves of the domain, interfaces and lines within regions included; of a solid, those on its
    /// segments.
    pub boundary_edges: usize,
    /// Measures of each region.
    pub regions: Vec<RegionMeasure>,
    /// Measures of each boundary, by name; of a solid, of its named segments.
    pub boundaries: Vec<BoundaryMeasure>,
    /// Of a solid: the triangles on its facets, by name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facets: Option<Vec<FacetMeasure>>,
    /// Of a solid: the weights of the nodes, which certify that the mesh is constrained Delaunay.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<WeightReport>,
    /// Polynomial order of the cells.
    pub order: u8,
    /// Of order 2: curved sides that had to stay straight, or a cell would fold.
    pub straightened: Vec<StraightenedReport>,
}

/// The weights of a solid's mesh.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WeightReport {
    /// The largest weight of a node, in parts of the squared distance to its nearest node.
    pub largest_relative: f64,
    /// The bound on that, which the check `weights` verifies.
    pub bound: f64,
}

/// Measures of a mesh, in the plane or in space.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum QualityReport {
    /// Of triangles in a plane.
    Plane(Quality),
    /// Of tetrahedra.
    Space(SolidQuality),
}

impl QualityReport {
    /// The measures of a mesh in a plane; `None` of tetrahedra.
    pub fn in_plane(&self) -> Option<&Quality> {
        match self {
            Self::Plane(quality) => Some(quality),
            Self::Space(_) => None,
        }
    }

    /// Area or volume of the domain as it was given, where that is known.
    pub fn exact_measure(&self) -> Option<f64> {
        match self {
            Self::Plane(quality) => quality.exact_measure,
            Self::Space(quality) => quality.exact_measure,
        }
    }
}

/// A curved side that is straight in the mesh: the name of its boundary, and its middle.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StraightenedReport {
    /// Name of the boundary.
    pub boundary: String,
    /// Middle of the side, x and y.
    pub at: [f64; 2],
}

impl MeshReport {
    /// The numbers of a mesh, without straightened sides.
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            vertices: mesh.nodes.len(),
            triangles: mesh.triangles.len(),
            tetrahedra: 0,
            boundary_edges: mesh.edges.len(),
            regions: region_measures(mesh),
            boundaries: boundary_measures(mesh),
            facets: None,
            weights: None,
            order: mesh.order(),
            straightened: Vec::new(),
        }
    }

    /// The numbers of a tetrahedral mesh.
    pub fn of_solid(mesh: &SolidMesh) -> Self {
        let largest = solid_quality::largest_relative_weight(mesh);
        Self {
            vertices: mesh.nodes.len(),
            triangles: mesh.triangles.len(),
            tetrahedra: mesh.tetrahedra.len(),
            boundary_edges: mesh.edges.len(),
            regions: solid_quality::region_measures(mesh),
            boundaries: solid_quality::segment_measures(mesh),
            facets: Some(solid_quality::facet_measures(mesh)),
            weights: largest.map(|largest_relative| WeightReport { largest_relative, bound: WEIGHT_BOUND }),
            order: 1,
            straightened: Vec::new(),
        }
    }

    /// With the straightened sides, as places in `Mesh::edges`.
    pub fn with_straightened(mut self, mesh: &Mesh, sides: &[usize]) -> Self {
        let tell = |&side: &usize| {
            let at = mesh.nodes[mesh.edge_mids[side]];
            StraightenedReport { boundary: mesh.names.text(mesh.edges[side].name).to_owned(), at: [at.x, at.y] }
        };
        self.straightened = sides.iter().map(tell).collect();
        self
    }
}

/// What the verifier found.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PromiseReport {
    /// Whether no check is broken.
    pub kept: bool,
    /// Every check, with its counts and the worst value met.
    pub checks: Vec<Check>,
    /// Triangles that sharp corners exempt from the angle bound.
    pub excused: ExcusedReport,
}

/// The exempt triangles, by corner.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExcusedReport {
    /// Number of exempt triangles.
    pub count: usize,
    /// Each corner with its exempt triangles.
    pub by_corner: Vec<Exemption>,
}

impl PromiseReport {
    /// The verifier's verdict, as the report tells it.
    pub fn new(verdict: &Verdict) -> Self {
        let count = verdict.exempt.iter().map(|e| e.cells.len()).sum();
        let excused = ExcusedReport { count, by_corner: verdict.exempt.clone() };
        Self { kept: verdict.kept(), checks: verdict.checks.clone(), excused }
    }
}

/// The end of refinement.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StopReport {
    /// Why it ended.
    pub reason: StopReason,
    /// Number of cells that still miss a bound.
    #[serde(rename = "owed")]
    pub unresolved: usize,
    /// Some of the places where a bound is missed.
    pub places: Vec<Place>,
    /// The smallest angle that the mesh was refined to, where it is another than was asked for: `--min-angle` with it
    /// ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
}

impl StopReport {
    /// Says that it was the time asked for that was over.
    pub(super) fn time_out(&mut self) {
        if self.reason == StopReason::Cancelled {
            self.reason = StopReason::TimedOut;
        }
    }

    /// The end of a refinement, as the report tells it.
    pub fn new(stop: &Stop) -> Self {
        let places = stop.places.iter().map(|&p| p.into()).collect();
        Self { reason: stop.reason, unresolved: stop.unresolved, places, angle_deg: stop.angle_deg }
    }

    /// Of a mesh that was refined to a smaller angle than requested: its unresolved cells are those that the verifier
    /// finds below the requested angle.
    pub fn with_unresolved_angles(mut self, verdict: &Verdict) -> Self {
        if let Some(check) = verdict.checks.iter().find(|check| check.name == "min_angle") {
            self.unresolved = check.broken;
            self.places = check.worst.iter().map(|worst| worst.at).collect();
        }
        self
    }
}

/// What prevented the mesh, where, and the way out.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FailureReport {
    /// The kind of failure, from which the exit code follows.
    pub kind: FailureKind,
    /// What is wrong, in a sentence without full stop.
    pub what: String,
    /// Where in the drawing or in space; `null` where it is at no one place.
    pub at: Option<Place>,
    /// Further places of the same flaw, as many as `what` lists.
    #[serde(skip_serializing_if = "<[Place]>::is_empty")]
    pub also_at: Box<[Place]>,
    /// Line of the file, from 1; `null` where it is at no one line.
    pub line: Option<u32>,
    /// Byte in the line, from 1; `null` where it is not known.
    pub column: Option<u32>,
    /// What the user can do.
    pub help: String,
    /// The end of the stage that a budget cut short: `stop` of the report.
    #[serde(skip)]
    pub stop: Option<Box<StopReport>>,
}

/// Kinds of failures; each has an exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FailureKind {
    /// The request does not fit the drawing.
    Request,
    /// The input is damaged or of no known format.
    Unreadable,
    /// The drawing has no valid arrangement, or features that coordinates cannot tell apart.
    Geometry,
    /// The budget or the time ended before there was a valid mesh.
    NoMesh,
    /// A bug of squinch.
    Bug,
}

impl FailureReport {
    /// A failure at no place and no line.
    pub fn new(kind: FailureKind, what: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            kind,
            what: what.into(),
            at: None,
            also_at: Box::default(),
            line: None,
            column: None,
            help: help.into(),
            stop: None,
        }
    }

    /// The failure at a place.
    pub fn at(self, place: impl Into<Place>) -> Self {
        Self { at: Some(place.into()), ..self }
    }
}

/// Wall-clock seconds of each stage.
#[derive(Clone, Copy, Debug, Default, Serialize, JsonSchema)]
pub struct Seconds {
    /// Reading the input.
    pub read: f64,
    /// Arranging and healing the drawing, and cutting its curves to τ.
    pub arrange: f64,
    /// Refining, with the estimate before it and the nodes of order 2.
    pub mesh: f64,
    /// Verifying and measuring the mesh.
    pub verify: f64,
    /// Writing the outputs; 0 where there were none.
    pub write: f64,
    /// The whole run with writing; 0 where no file was read.
    pub total: f64,
}

impl Report {
    /// The report of a run that has not begun.
    pub fn new(path: &str, request: &Request) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            input: InputReport { path: path.into(), ..InputReport::default() },
            request: RequestReport::new(request),
            mesh: None,
            quality: None,
            promise: None,
            stop: None,
            failure: None,
            counters: Counters::default(),
            seconds: Seconds::default(),
            peak_memory_bytes: None,
        }
    }

    /// The JSON text, indented, with a line end. Numbers that are not finite become `null`.
    pub fn to_json(&self) -> String {
        let mut text =
            serde_json::to_string_pretty(self).expect("a report holds only strings, numbers and lists of them");
        text.push('\n');
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fields_come_in_the_contracts_order() {
        let report = Report::new("wing.dat", &Request::default());
        let value: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
        let keys = |value: &serde_json::Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!(
            keys(&value),
            [
                "schema",
                "version",
                "input",
                "request",
                "mesh",
                "quality",
                "promise",
                "stop",
                "counters",
                "seconds",
                "peak_memory_bytes"
            ]
        );
        assert_eq!(keys(&value["seconds"]), ["read", "arrange", "mesh", "verify", "write", "total"]);
        assert_eq!(value["schema"], 1);
        assert_eq!(value["input"]["path"], "wing.dat");
        assert_eq!(value["request"]["engine"], "lop");
        assert_eq!(value["request"]["edge_turning_deg"], 15.0);
        assert_eq!(value["request"]["fill_rule"], "auto");
    }
}
