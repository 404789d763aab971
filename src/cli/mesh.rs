//! `mesh IN -o OUT`: reads, arranges, meshes, verifies, writes.

use super::check::REQUEST_STAMP;
use super::files::{self, Input, Staged, unwritable};
use super::options::{Options, Resolved};
use super::output::Output;
use super::writing::Writing;
use super::{Halt, Volume, clock, remember, say, write_case};
use clap::Args;
use squinch::domain::RepairKind;
use squinch::run::request::Request;
use squinch::run::{self, Exit, Extent, Outcome};
use squinch::watch::Progress;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

const EXAMPLES: &str = "\
By job:
  finer at some names
      squinch mesh samples/plate.json -o plate.vtu --max-edge 2 --size-of slot=0.5 --grade 0.3
  true curves, order 2
      squinch mesh samples/bracket.dxf -o bracket.msh --order 2
  larger angles
      squinch mesh samples/gear.json -o gear.vtu --engine gcdr --min-angle 30
  the tetrahedra of a part
      squinch mesh samples/bracket.stl -o bracket.vtu
  a corner in a picture
      squinch mesh samples/plate.json -o plate.png --view 0,0,20,20 --colour size
  MFEM, deal.II
      squinch mesh samples/plate.json -o plate.msh --format msh22 --interior-lines off

--help shows every option, those of the engines too.";

/// Read, arrange, mesh, verify, write
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Mesh {
    /// A drawing: .svg, .dxf, .step, airfoil .dat, .poly, .node, outline .json; or the surface of a solid: .stl, .off,
    /// .smesh, .poly in space; - for standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where the mesh goes: .vtu, .vtk, .msh, .su2, .inp, .xdmf, .node/.ele/.poly, .glb, .gltf, .obj, .stl; tetrahedra:
    /// .vtu, .msh, .su2, .inp, .mesh; a picture: .svg, .png; - for standard output; may be repeated
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Output")]
    output: Vec<PathBuf>,
    /// Formats of the outputs, in their order, where the suffix gives none (msh22 is Gmsh 2.2; vtk-text is VTK as text;
    /// triangle is .node/.ele/.poly)
    #[arg(long, value_parser = Output::named, value_name = "FORMAT", value_delimiter = ',', help_heading = "Output")]
    format: Vec<Output>,
    /// The report as JSON; - for standard output
    #[arg(long, value_name = "FILE.json", help_heading = "Output")]
    report: Option<PathBuf>,
    /// The run itself, to be repeated by `replay`
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    case: Option<PathBuf>,
    #[command(flatten)]
    writing: Writing,
    #[command(flatten)]
    options: Options,
}

impl Mesh {
    /// Runs the verb.
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        self.writing.check()?;
        let outputs = self.outputs()?;
        let files = outputs.iter().flat_map(|(path, format)| format.files(path));
        let files: Vec<PathBuf> = self.report.iter().chain(&self.case).cloned().chain(files).collect();
        files::each_once([self.input.clone()].into_iter().chain(files.clone()))?;
        let Resolved { request, input_format } = self.options.resolve()?;
        outputs.iter().try_for_each(|(_, format)| format.hold_order(&request))?;
        files::can_be_written(&files)?;
        let formats: Vec<Output> = outputs.iter().map(|(_, format)| *format).collect();
        self.writing.tell_unused(&formats, volume);
        let input = Input::open(&self.input, input_format)?;
        remember(&input, &request);
        let mut outcome = mesh_with_progress(&input, &request, volume);
        let written = self.write(&outputs, &input, &request, &mut outcome);
        if let Some(failure) = &outcome.report.failure {
            say::failure(failure, Some(&input));
            say::remarks(&outcome.report.input, volume);
        }
        let wrote = written?;
        say::summary(&outcome, &wrote, volume);
        if let (Some(mesh), false, Volume::Verbose) = (&outcome.mesh, wrote.is_empty(), volume) {
            // A picture never holds a mesh, so nothing is reported for it.
            let files = outputs.iter().filter(|(_, format)| matches!(format, Output::Mesh(_)));
            files.for_each(|(path, format)| say::losses(*format, &self.writing.losses(*format, mesh, path)));
        }
        if outcome.exit == Exit::Bug {
            write_case(&run::ending(&outcome), "broken");
        }
        Ok(outcome.exit)
    }

    /// Every output with its format.
    fn outputs(&self) -> Result<Vec<(&Path, Output)>, Halt> {
        let to_stdout =
            self.output.iter().chain(&self.report).chain(&self.case).filter(|p| p.as_os_str() == "-").count();
        if to_stdout > 1 {
            return Err(Halt::Usage("only one output can go to standard output".into()));
        }
        if !self.format.is_empty() && self.format.len() != self.output.len() {
            let (formats, outputs) = (self.format.len(), self.output.len());
            return Err(Halt::Usage(format!("--format names {formats} formats for {outputs} outputs")));
        }
        let formats = self.output.iter().enumerate().map(|(i, path)| {
            let format = Output::of(path, self.format.get(i).copied())?;
            Ok((path.as_path(), format))
        });
        formats.collect()
    }

    /// Writes the outputs, and returns the names of the mesh files.
    fn write(
        &self,
        outputs: &[(&Path, Output)],
        input: &Input,
        request: &Request,
        outcome: &mut Outcome,
    ) -> Result<Vec<String>, Halt> {
        let start = Instant::now();
        let mut staged = Staged::default();
        let mut wrote = Vec::new();
        // A mesh with a broken guarantee of ours must not reach a solver.
        if outcome.exit != Exit::Bug {
            for (path, format) in outputs {
                let stamps = stamps(outcome, request);
                let Some(encoded) = self.writing.encode_outcome(*format, outcome, &stamps, path) else { continue };
                let encoded = encoded.map_err(|error| unencoded(path, &error))?;
                for (file, bytes) in format.files(path).iter().zip(encoded) {
                    staged.add(file, &bytes).map_err(unwritable)?;
                    wrote.push(file.display().to_string());
                }
            }
        }
        let seconds = &mut outcome.report.seconds;
        seconds.write = start.elapsed().as_secs_f64();
        seconds.total += seconds.write;
        outcome.report.peak_memory_bytes = peak_memory_bytes();
        if let Some(path) = &self.report {
            staged.add(path, outcome.report.to_json().as_bytes()).map_err(unwritable)?;
        }
        if let Some(path) = &self.case {
            let case = input.case(&run::ending(outcome), request);
            staged.add(path, case.to_toml().as_bytes()).map_err(unwritable)?;
        }
        staged.commit().map_err(unwritable)?;
        Ok(wrote)
    }
}

/// The error of a format that cannot hold a mesh, or of writing.
fn unencoded(path: &Path, error: &io::Error) -> Halt {
    let what = format!("{}: {error}", path.display());
    if error.kind() == io::ErrorKind::Unsupported { Halt::Usage(what) } else { Halt::Unwritable(what) }
}

/// A run with a progress line.
pub fn mesh_with_progress(input: &Input, request: &Request, volume: Volume) -> Outcome {
    let mut bar = say::Bar::new(volume);
    let mut watch = |progress: &Progress| {
        bar.tell(progress);
        true
    };
    run::run(&input.source(), request, Extent::Whole(&mut watch), &clock())
}

/// The stamps of a mesh file: its request, with the tolerance if that was raised.
pub fn stamps(outcome: &Outcome, request: &Request) -> [(String, String); 2] {
    let raised = outcome.report.input.repairs.first().filter(|repair| repair.kind == RepairKind::ToleranceRaised);
    let tolerance = raised.map(|repair| repair.size).or(request.tolerance);
    let request = toml::to_string(&Request { tolerance, ..request.clone() })
        .expect("a request holds only words, numbers and lists of them");
    [("program".to_owned(), format!("squinch {}", env!("CARGO_PKG_VERSION"))), (REQUEST_STAMP.to_owned(), request)]
}

/// Largest resident memory of this process, where the system tells it.
fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}
