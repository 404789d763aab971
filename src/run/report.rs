//! The report: one JSON object a run, schema 1. Fields come in this order and change only by addition.
//!
//! All but `seconds` and `peak_memory_bytes` is the same, byte for byte, for the same input.

mod asked;

pub use asked::RequestReport;

use super::request::Request;
use crate::domain::{Drawing, Repair, Skipped};
use crate::geometry::Point;
use crate::mesh::Mesh;
use crate::mesh::quality::{BoundaryMeasure, Quality, RegionMeasure, boundary_measures, region_measures};
use crate::refine::{Counters, Stop, StopReason};
use crate::verify::{Check, Excuse, Verdict};
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON schema (draft 2020-12) of something that is written as JSON. Numbers that are not finite are written as `null`, so every
/// number may be that.
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

/// The report of one run. What the run did not come to is `null`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Report {
    pub schema: u32,
    pub version: &'static str,
    pub input: InputReport,
    pub request: RequestReport,
    pub mesh: Option<MeshReport>,
    pub quality: Option<Quality>,
    pub promise: Option<PromiseReport>,
    pub stop: Option<StopReport>,
    /// Why there is no mesh, or why it must not be used; absent of a run that came to its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<FailureReport>,
    pub counters: Counters,
    pub seconds: Seconds,
    /// Largest resident memory of the process, where the system tells it.
    pub peak_memory_bytes: Option<u64>,
}

#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct InputReport {
    /// As given on the command line.
    pub path: String,
    pub format: Option<String>,
    pub title: Option<String>,
    pub unit: Option<String>,
    pub unit_from: Option<String>,
    /// How many of each kind.
    pub curves: BTreeMap<&'static str, usize>,
    pub skipped: Vec<Skipped>,
    pub notes: Vec<String>,
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

/// How many curves of each kind a drawing holds.
pub fn kinds(drawing: &Drawing) -> BTreeMap<&'static str, usize> {
    let mut kinds = BTreeMap::new();
    for drawn in &drawing.curves {
        *kinds.entry(drawn.curve.kind()).or_default() += 1;
    }
    kinds
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeshReport {
    pub vertices: usize,
    pub triangles: usize,
    pub tetrahedra: usize,
    pub boundary_edges: usize,
    pub regions: Vec<RegionMeasure>,
    pub boundaries: Vec<BoundaryMeasure>,
    /// Polynomial order of the cells.
    pub order: u8,
    /// Of order 2: curved sides that had to stay straight, or a cell would fold.
    pub straightened: Vec<StraightenedReport>,
}

/// A curved side that is straight in the mesh: the name of its boundary, and its middle.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StraightenedReport {
    pub boundary: String,
    pub at: [f64; 2],
}

impl MeshReport {
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            vertices: mesh.nodes.len(),
            triangles: mesh.triangles.len(),
            tetrahedra: 0,
            boundary_edges: mesh.edges.len(),
            regions: region_measures(mesh),
            boundaries: boundary_measures(mesh),
            order: mesh.order(),
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

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PromiseReport {
    pub kept: bool,
    pub checks: Vec<Check>,
    pub excused: ExcusedReport,
}

#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExcusedReport {
    pub count: usize,
    pub by_corner: Vec<Excuse>,
}

impl PromiseReport {
    pub fn new(verdict: &Verdict) -> Self {
        let count = verdict.excused.iter().map(|e| e.cells.len()).sum();
        let excused = ExcusedReport { count, by_corner: verdict.excused.clone() };
        Self { kept: verdict.kept(), checks: verdict.checks.clone(), excused }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StopReport {
    pub reason: StopReason,
    pub owed: usize,
    pub places: Vec<[f64; 2]>,
    /// The smallest angle that the mesh was refined to, where it is another than was asked for: `--min-angle` with it ends.
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

    pub fn new(stop: &Stop) -> Self {
        let places = stop.places.iter().map(|p| [p.x, p.y]).collect();
        Self { reason: stop.reason, owed: stop.owed, places, angle_deg: stop.angle_deg }
    }

    /// Of a mesh that was refined to a smaller angle than asked for: what it owes is what the judge finds below the angle.
    pub fn owing_angles(mut self, verdict: &Verdict) -> Self {
        if let Some(check) = verdict.checks.iter().find(|check| check.name == "min_angle") {
            self.owed = check.broken;
            self.places = check.worst.iter().map(|worst| worst.at).collect();
        }
        self
    }
}

/// What stood in the way, where, and the way out.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FailureReport {
    pub kind: FailureKind,
    pub what: String,
    pub at: Option<[f64; 2]>,
    /// Further places of the same flaw, as many as `what` lists.
    #[serde(skip_serializing_if = "<[[f64; 2]]>::is_empty")]
    pub also_at: Box<[[f64; 2]]>,
    pub line: Option<u32>,
    pub column: Option<u32>,
    pub help: String,
    /// The end of the stage that a budget cut short: `stop` of the report.
    #[serde(skip)]
    pub stop: Option<Box<StopReport>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FailureKind {
    /// The request does not fit the drawing.
    Request,
    Unreadable,
    Geometry,
    /// The budget or the time ended before there was a valid mesh.
    NoMesh,
    /// Our own fault.
    Bug,
}

impl FailureReport {
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

    pub fn at(self, place: Point) -> Self {
        Self { at: Some([place.x, place.y]), ..self }
    }
}

/// Wall-clock seconds of each stage.
#[derive(Clone, Copy, Debug, Default, Serialize, JsonSchema)]
pub struct Seconds {
    pub read: f64,
    pub arrange: f64,
    pub mesh: f64,
    pub verify: f64,
    pub write: f64,
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
