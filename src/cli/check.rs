//! `check MESH`: verifies a mesh file, ours or not.

use super::files::{Input, Staged, unwritable};
use super::options::{Options, Resolved};
use super::{Halt, Volume, clock, remember, say};
use clap::Args;
use squinch::domain::Domain;
use squinch::mesh::quality::Quality;
use squinch::meshio::{self, Format, MeshFile};
use squinch::run::report::{FailureKind, FailureReport, MeshReport, PromiseReport, QualityReport, Report};
use squinch::run::request::Request;
use squinch::run::{self, Exit, Plan};
use squinch::verify::Status;
use std::path::{Path, PathBuf};

/// Verify a mesh file, ours or not
#[derive(Args)]
pub struct Check {
    /// A mesh file: .vtu, .vtk, .msh, .su2, .inp, .obj, .stl, .ele; - for standard input
    #[arg(value_name = "MESH")]
    mesh: PathBuf,
    /// The drawing of the mesh; without it, checks that need the curves are n/a
    #[arg(long, value_name = "IN")]
    against: Option<PathBuf>,
    /// The report as JSON; - for standard output
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    /// The bounds that are checked. A mesh of ours holds those of its run, which apply where none is given here
    #[command(flatten)]
    options: Options,
}

/// The mesh format of an input: by its suffix, or by its content.
fn mesh_format(input: &Input) -> Option<Format> {
    Format::to_read(Path::new(&input.path)).or_else(|| Format::sniff(&input.bytes))
}

/// Whether an input is a mesh by its suffix, or without one by its content.
pub fn is_mesh(input: &Input) -> bool {
    let path = Path::new(&input.path);
    let by_content = || Format::sniff(&input.bytes).is_some_and(|format| format != Format::Obj);
    input.format.is_none() && (Format::to_read(path).is_some() || path.extension().is_none() && by_content())
}

/// Reads the mesh of an input.
pub fn read(input: &Input) -> Result<MeshFile, Halt> {
    let path = Path::new(&input.path);
    let Some(format) = mesh_format(input) else {
        return Err(Halt::Unreadable(format!(
            "{}: not a mesh file of a format that can be read (`squinch mesh` makes one of a drawing)",
            input.path
        )));
    };
    let beside = format.reading().map_or(&[][..], |reading| reading.beside);
    let beside: Vec<_> = beside.iter().map(|suffix| std::fs::read(path.with_extension(suffix)).ok()).collect();
    meshio::read(&input.bytes, format, &beside).map_err(|error| {
        let failure = FailureReport::new(FailureKind::Unreadable, error.what, error.help);
        Halt::Failure(Box::new(failure), Some(Box::new(input.clone())))
    })
}

/// The key under which our mesh files hold the options of their run, in the form of a `--config` file.
pub const REQUEST_STAMP: &str = "request";

/// The note about a mesh whose links are missing or wrong.
const BY_PLACE: &str = "The mesh does not say, or says wrongly, on which curves its edges lie: the verifier went by the places of its nodes.";

impl Check {
    /// Verifies the mesh and prints the verdict.
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        let input = Input::open(&self.mesh, None)?;
        let MeshFile { mesh, stamps, notes } = read(&input)?;
        let path = input.path;
        let stamped = stamps.iter().find(|(key, _)| key == REQUEST_STAMP).map(|(_, text)| text.as_str());
        let Resolved { request, input_format } = self.options.resolve_over(stamped.unwrap_or(""))?;
        let mut report = Report::new(&path, &request);
        let against = match &self.against {
            Some(drawing) => Some(against(&Input::open(drawing, input_format)?, &request, &mut report)?),
            None => None,
        };
        let (domain, plan) = against.map_or_else(|| (None, Plan::without_domain(&request)), |(d, p)| (Some(d), p));
        let (verdict, untied) = plan.verify_file(domain.as_ref(), &mesh);
        report.input.notes.extend(notes);
        report.input.notes.extend(untied.is_some().then(|| BY_PLACE.to_owned()));
        let mesh = untied.unwrap_or(mesh);
        report.mesh = Some(MeshReport::new(&mesh));
        let quality = Quality::of(domain.as_ref(), &mesh, verdict.exempt_cells());
        report.quality = Some(QualityReport::Plane(quality));
        report.promise = Some(PromiseReport::new(&verdict));
        if let Some(path) = &self.report {
            let mut staged = Staged::default();
            staged.add(path, report.to_json().as_bytes()).and_then(|()| staged.commit()).map_err(unwritable)?;
        }
        if volume > Volume::Quiet {
            let ink = say::Ink::stderr();
            say::line(&format!("{} {path}: {}", ink.bold("squinch"), say::guarantees(&verdict, ink)));
            report.input.notes.iter().for_each(|note| say::line(&format!("    {} {note}", ink.dim("note:"))));
            let shown = verdict.checks.iter().filter(|c| volume == Volume::Verbose || c.status != Status::NotAsked);
            shown.flat_map(|check| say::check_lines(check, ink)).for_each(|text| say::line(&text));
        }
        Ok(if verdict.kept() { Exit::Done } else { Exit::Missed })
    }
}

/// The domain of the mesh, and the plan for it.
fn against(input: &Input, request: &Request, report: &mut Report) -> Result<(Domain, Plan), Halt> {
    remember(input, request);
    let clock = clock();
    let watch = &mut run::timer(request, &clock);
    let mut stages = || {
        let drawing = run::read(&input.source(), request)?;
        let arranged = run::arrange(&drawing, request, watch)?;
        let (domain, plan) = Plan::new(&drawing, &arranged, request, watch)?;
        report.input.describe(&drawing);
        report.input.repairs = arranged.repairs().to_vec();
        report.request.note_use(&drawing, &arranged, plan.tau_rad, plan.sizing());
        Ok((domain, plan))
    };
    stages().map_err(|failure| Halt::Failure(Box::new(failure), Some(Box::new(input.clone()))))
}
