//! The run of a solid: surfaces → solid → constrained Delaunay tetrahedra → verified mesh.

use super::exit::{broken, exit_of, no_mesh};
use super::report::{FailureKind, FailureReport, MeshReport, PromiseReport, QualityReport, RequestReport};
use super::request::Request;
use super::{Exit, Laps, Outcome};
use crate::ids::SegmentId;
use crate::mesh::solid::quality::SolidQuality;
use crate::refine::{Stop, StopReason};
use crate::run::report::StopReport;
use crate::solid::{Solid, SolidError, Surfaces};
use crate::space::{self, Fault};
use crate::verify::solid::verify_solid;
use crate::watch::{Clock, Progress, Stopped, Watch};

/// How many places of a flaw are listed.
const LISTED: usize = 8;

impl Outcome {
    /// Runs the stages of a solid.
    pub(super) fn solid_stages(
        &mut self,
        surfaces: &Surfaces,
        request: &Request,
        watch: &mut Watch,
        clock: &Clock,
    ) -> Result<(), FailureReport> {
        let mut laps = Laps { clock, last: clock() };
        self.report.request = RequestReport::of_solid(request, surfaces.unit.as_deref());
        let solid = surfaces.assemble(&request.solid)?;
        self.report.input.describe_solid(&solid);
        self.report.seconds.arrange = laps.lap();
        let progress = Progress { phase: "tetrahedralizing", vertices: solid.points().len(), queued: 0 };
        progress.tell(watch)?;
        let mesh = match solid.points().len() > request.max_vertices {
            true => Err(Fault::VertexBudget { max_vertices: request.max_vertices }),
            false => space::constrained(&solid, request.max_vertices, &mut || watch(&progress)),
        };
        let mesh = mesh.map_err(|fault| failure_of(fault, &solid))?;
        self.report.seconds.mesh = laps.lap();
        let verdict = verify_solid(Some(&solid), &mesh);
        self.report.stop = Some(StopReport::new(&stop(StopReason::Done)));
        self.report.counters.add("vertices_input", solid.points().len() as u64);
        self.report.counters.add("vertices_segment", (mesh.nodes.len().saturating_sub(solid.points().len())) as u64);
        self.report.mesh = Some(MeshReport::of_solid(&mesh));
        self.report.quality = Some(QualityReport::Space(SolidQuality::of(&mesh, solid.volume())));
        self.report.promise = Some(PromiseReport::new(&verdict));
        self.report.seconds.verify = laps.lap();
        self.exit = exit_of(&verdict, StopReason::Done);
        if self.exit == Exit::Bug {
            let what =
                format!("the mesh breaks guarantees that hold whatever the request: {}", broken(&verdict).join(", "));
            self.report.failure = Some(FailureReport::new(FailureKind::Bug, what, "please send us the case file"));
        }
        (self.solid, self.verdict) = (Some(mesh), Some(verdict));
        Ok(())
    }
}

fn stop(reason: StopReason) -> Stop {
    Stop { reason, unresolved: 0, places: Vec::new(), angle_deg: None }
}

impl From<SolidError> for FailureReport {
    fn from(error: SolidError) -> Self {
        let also_at = error.also_at.iter().map(|&at| at.into()).collect();
        Self { also_at, ..Self::new(FailureKind::Geometry, error.what, error.help).at(error.at) }
    }
}

/// Why the kernel has no mesh of a solid.
fn failure_of(fault: Fault, solid: &Solid) -> FailureReport {
    const NEARER: &str = "features are nearer to each other than the coordinates can tell apart";
    let geometry = |what: String, help: &str| FailureReport::new(FailureKind::Geometry, what, help);
    let ends = |s: SegmentId| solid.segments()[s].ends.map(|p| solid.points()[p]);
    let closer = "move the solid nearer to the origin, or take the small feature out";
    match fault {
        Fault::Twice { point } => geometry(format!("{NEARER}: two points"), closer).at(solid.points()[point]),
        Fault::TooNear { segment, at } => {
            let [a, b] = ends(segment).map(shown);
            geometry(format!("{NEARER}: the segment from {a} to {b} and a vertex"), closer).at(at)
        }
        Fault::Stuck { facet, at } => {
            let entity = &solid.facets()[facet].entity;
            let what = format!("{entity} does not become a union of triangles: a limit of this version, or {NEARER}");
            geometry(what, closer).at(at)
        }
        Fault::Outside { at } => {
            let what = "a hole point or region point lies in no bounded cell".to_owned();
            geometry(what, "move the point well within a cell, or close the facets around it").at(at)
        }
        Fault::Empty => nothing_bounded(solid),
        Fault::VertexBudget { .. } => no_mesh(&stop(StopReason::VertexBudget), "--max-vertices"),
        Fault::Cancelled => Stopped.into(),
    }
}

/// The facets bound no cell: with the edges at which the surface is open.
fn nothing_bounded(solid: &Solid) -> FailureReport {
    let mut facets_at = vec![0; solid.segments().len()];
    for facet in solid.facets().iter() {
        facet.segments.iter().for_each(|s| facets_at[s.0 as usize] += 1);
    }
    let rims: Vec<SegmentId> = solid.segments().ids().filter(|s| facets_at[s.0 as usize] == 1).collect();
    let help = "close the surface: facets that meet must share their points, and hole points must not reach all cells";
    let middle = |s: SegmentId| {
        let [a, b] = solid.segments()[s].ends.map(|p| solid.points()[p]);
        [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))
    };
    let Some(&first) = rims.first() else {
        return FailureReport::new(FailureKind::Geometry, "no bounded cell is material", help);
    };
    let edges = if rims.len() == 1 { "edge" } else { "edges" };
    let what = format!("the facets bound nothing: the surface is open along {} {edges}", rims.len());
    let also_at = rims.iter().skip(1).take(LISTED).map(|&s| middle(s).into()).collect();
    FailureReport { also_at, ..FailureReport::new(FailureKind::Geometry, what, help).at(middle(first)) }
}

fn shown([x, y, z]: [f64; 3]) -> String {
    format!("({x}, {y}, {z})")
}
