//! `mesh IN -o OUT`: reads, arranges, meshes, verifies, writes.

use super::check::REQUEST_STAMP;
use super::files::{Input, Staged, unwritable};
use super::options::{Options, Resolved};
use super::{Halt, Volume, remember, say, write_case};
use clap::Args;
use squinch::export::{self, Format};
use squinch::mesh;
use squinch::pipeline::{self, Exit, Extent, Outcome};
use squinch::refine::Progress;
use squinch::request::Request;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Args)]
pub struct Mesh {
    /// A drawing: airfoil .dat, .poly, .node, outline .json, .step; - for standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where the mesh goes: .vtu, .svg or .png; - for standard output; may be repeated
    #[arg(short, long, value_name = "OUT", required = true, help_heading = "Output")]
    output: Vec<PathBuf>,
    /// Formats of the outputs, in their order, where the suffix is not to tell
    #[arg(long, value_parser = mesh_format, value_name = "FORMAT", value_delimiter = ',', help_heading = "Output")]
    format: Vec<Format>,
    /// The report as JSON; - for standard output
    #[arg(long, value_name = "FILE.json", help_heading = "Output")]
    report: Option<PathBuf>,
    /// The run itself, to be repeated by `replay`
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    case: Option<PathBuf>,
    #[command(flatten)]
    options: Options,
}

impl Mesh {
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        let outputs = self.outputs()?;
        self.each_file_once()?;
        let Resolved { request, input_format } = self.options.resolve()?;
        let input = Input::open(&self.input, input_format)?;
        remember(&input, &request);
        let mut outcome = mesh_with_progress(&input, &request, volume);
        let written = self.write(&outputs, &input, &request, &mut outcome);
        if let Some(failure) = &outcome.report.failure {
            say::failure(failure, Some(&input));
        }
        let wrote = written?;
        say::summary(&outcome, &wrote, volume);
        if outcome.exit == Exit::Bug {
            write_case(&pipeline::ending(&outcome), "broken");
        }
        Ok(outcome.exit)
    }

    /// No output may be the input, or another output.
    fn each_file_once(&self) -> Result<(), Halt> {
        let whole =
            |path: &PathBuf| std::fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or(path.clone());
        let files = [&self.input].into_iter().chain(&self.output).chain(&self.report).chain(&self.case);
        let mut seen: Vec<PathBuf> = Vec::new();
        for path in files.filter(|path| path.as_os_str() != "-" && !path.starts_with("/dev")) {
            let path = whole(path);
            if seen.contains(&path) {
                return Err(Halt::Usage(format!(
                    "{} is named twice: each file is read or written once",
                    path.display()
                )));
            }
            seen.push(path);
        }
        Ok(())
    }

    /// Every output with its format.
    fn outputs(&self) -> Result<Vec<(&Path, Format)>, Halt> {
        let to_stdout =
            self.output.iter().chain(&self.report).chain(&self.case).filter(|p| p.as_os_str() == "-").count();
        if to_stdout > 1 {
            return Err(Halt::Usage("only one output can go to standard output".into()));
        }
        if !self.format.is_empty() && self.format.len() != self.output.len() {
            let (formats, outputs) = (self.format.len(), self.output.len());
            return Err(Halt::Usage(format!("--format names {formats} formats for {outputs} outputs")));
        }
        let of = |(i, path): (usize, &'_ PathBuf)| self.format.get(i).copied().or_else(|| export::format_of(path));
        let known = self.output.iter().enumerate().map(|(i, path)| match of((i, path)) {
            Some(format) => Ok((path.as_path(), format)),
            None => Err(Halt::Usage(format!("-o {}: say its format by --format: vtu, svg or png", path.display()))),
        });
        known.collect()
    }

    /// Writes what there is to write; the names of the mesh files.
    fn write(
        &self,
        outputs: &[(&Path, Format)],
        input: &Input,
        request: &Request,
        outcome: &mut Outcome,
    ) -> Result<Vec<String>, Halt> {
        let start = Instant::now();
        let mut staged = Staged::default();
        let mut wrote = Vec::new();
        // A mesh that broke down in our hands must not reach a solver.
        if let (Some(mesh), false) = (&outcome.mesh, outcome.exit == Exit::Bug) {
            for (path, format) in outputs {
                let bytes = encode(mesh, outcome, request, *format).map_err(unwritable)?;
                staged.add(path, &bytes).map_err(unwritable)?;
                wrote.push(path.display().to_string());
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
            let case = input.case(&pipeline::ending(outcome), request);
            staged.add(path, case.to_toml().as_bytes()).map_err(unwritable)?;
        }
        staged.commit().map_err(unwritable)?;
        Ok(wrote)
    }
}

/// The pipeline under a progress line.
pub fn mesh_with_progress(input: &Input, request: &Request, volume: Volume) -> Outcome {
    let mut bar = say::Bar::new(volume);
    let mut watch = |progress: &Progress| {
        bar.tell(progress);
        true
    };
    pipeline::run(&input.source(), request, Extent::Whole(&mut watch))
}

/// A mesh as the bytes of a file, stamped with what it was asked for.
fn encode(mesh: &mesh::Mesh, outcome: &Outcome, request: &Request, format: Format) -> io::Result<Vec<u8>> {
    let request = toml::to_string(request).expect("a request holds only words, numbers and lists of them");
    let stamps =
        [("program".to_owned(), format!("squinch {}", env!("CARGO_PKG_VERSION"))), (REQUEST_STAMP.to_owned(), request)];
    let mut bytes = Vec::new();
    export::write_mesh(mesh, outcome.domain.as_ref(), &stamps, format, &mut bytes)?;
    Ok(bytes)
}

fn mesh_format(name: &str) -> Result<Format, String> {
    Format::named(name).ok_or_else(|| format!("one of {}", Format::ALL.map(Format::name).join(", ")))
}

/// Largest resident memory of this process, where the system tells it.
fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}
