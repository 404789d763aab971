//! `check MESH`: the judge's verdict on a mesh file.

use super::files::{self, Input, Staged, unwritable};
use super::options::{Options, Resolved};
use super::{Halt, Volume, remember, say};
use clap::Args;
use squinch::import::vtu;
use squinch::mesh::quality::Quality;
use squinch::mesh::verify::{Promise, Status};
use squinch::pipeline::{self, Exit};
use squinch::report::{FailureKind, FailureReport, MeshReport, PromiseReport, Report};
use std::path::PathBuf;

#[derive(Args)]
pub struct Check {
    /// A mesh file: .vtu; - for standard input
    #[arg(value_name = "MESH")]
    mesh: PathBuf,
    /// The drawing that the mesh is of: without it, checks that need the curves are n/a
    #[arg(long, value_name = "IN")]
    against: Option<PathBuf>,
    /// The report as JSON; - for standard output
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    #[command(flatten)]
    options: Options,
}

impl Check {
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        let Resolved { request, input_format } = self.options.resolve()?;
        let path = self.mesh.display().to_string();
        let bytes = files::read(&self.mesh).map_err(|e| Halt::Unreadable(format!("{path}: {e}")))?;
        let mesh = vtu::read(&bytes).map_err(|error| {
            let file = Input { path: path.clone(), bytes: bytes.clone(), format: None, nodes: None };
            Halt::Failure(Box::new(error.into()), Some(Box::new(file)))
        })?;
        let mut report = Report::new(&path, &request);
        let (domain, plan) = match &self.against {
            None => (None, pipeline::Plan::without_domain(&request)),
            Some(drawing) => {
                let input = Input::open(drawing, input_format)?;
                remember(&input, &request);
                let located = |failure| Halt::Failure(Box::new(failure), Some(Box::new(input.clone())));
                let drawing = pipeline::read(&input.source(), &request).map_err(located)?;
                let arranged = pipeline::arrange(&drawing, &request).map_err(located)?;
                report.input.describe(&drawing);
                report.input.repairs = arranged.repairs().to_vec();
                let plan = pipeline::Plan::new(&drawing, &arranged, &request).map_err(located)?;
                (Some(arranged.split_to_turning(plan.tau_rad)), plan)
            }
        };
        let verdict = plan.judge_foreign(domain.as_ref(), &mesh);
        report.input.path = path;
        report.request.tau_rad = domain.is_some().then_some(plan.tau_rad);
        report.mesh = Some(MeshReport::new(&mesh));
        report.quality = Some(Quality::of(domain.as_ref(), &mesh, &verdict));
        report.promise = Some(PromiseReport::new(&verdict));
        self.write(&report)?;
        if volume > Volume::Quiet {
            let ink = say::Ink::stderr();
            say::line(&format!("{}: {}", report.input.path, say::promise(&verdict, ink)));
            let shown = verdict.checks.iter().filter(|c| volume == Volume::Verbose || c.status != Status::NotAsked);
            shown.flat_map(|check| say::check_lines(check, ink)).for_each(|text| say::line(&text));
        }
        Ok(if verdict.kept() { Exit::Done } else { Exit::Missed })
    }
}
