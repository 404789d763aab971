//! `batch IN… --out-dir D --format F`: many inputs, in parallel, independent of each other.

mod record;

use super::files::{Input, Staged};
use super::mesh::stamps;
use super::options::{Options, Resolved};
use super::output::Output;
use super::writing::Writing;
use super::{Halt, Volume, clock};
use clap::Args;
pub use record::Line;
use record::{Desk, Record};
use squinch::import;
use squinch::run::case;
use squinch::run::report::{FailureKind, FailureReport};
use squinch::run::request::Request;
use squinch::run::{self, Exit, Extent, Outcome, Source};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Many drawings, in parallel, each for itself
#[derive(Args)]
pub struct Batch {
    /// Drawings, or folders of drawings
    #[arg(value_name = "IN", required = true)]
    inputs: Vec<PathBuf>,
    /// Where the meshes go, and batch.jsonl, the record of what is done
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    out_dir: PathBuf,
    /// Formats of the outputs
    #[arg(long, value_parser = Output::named, value_name = "F[,F]", value_delimiter = ',', required = true, help_heading = "Output")]
    format: Vec<Output>,
    /// Also the report of every input, as NAME.report.json
    #[arg(long, help_heading = "Output")]
    reports: bool,
    /// Leaves out the inputs that an earlier run with the same options recorded as done
    #[arg(long, help_heading = "Batch")]
    resume: bool,
    /// Only every N-th input, from the I-th on: for N machines
    #[arg(long, value_name = "I/N", value_parser = shard, help_heading = "Batch")]
    shard: Option<Shard>,
    #[command(flatten)]
    writing: Writing,
    #[command(flatten)]
    options: Options,
}

/// The I-th of N parts, from 1.
#[derive(Clone, Copy)]
struct Shard {
    part: usize,
    of: usize,
}

fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match parts {
        Some((part, of)) if 1 <= part && part <= of => Ok(Shard { part, of }),
        _ => Err("I/N with 1 ≤ I ≤ N is expected, as in 2/8".into()),
    }
}

/// One input, and the name of its outputs below the folder of outputs, without suffix.
struct Job {
    input: PathBuf,
    name: PathBuf,
    /// The number of the face, if each face of a solid is meshed.
    face: Option<u64>,
}

impl Job {
    /// The input as it is displayed and recorded.
    fn shown(&self) -> String {
        let face = self.face.map_or_else(String::new, |face| format!("#{face}"));
        format!("{}{face}", self.input.display())
    }

    /// The request for it.
    fn request(&self, request: &Request) -> Request {
        let given = request.face.clone().filter(|face| face != EVERY_FACE);
        Request { face: self.face.map(|face| face.to_string()).or(given), ..request.clone() }
    }

    /// One job for each planar face of a solid; the job itself where there are none, or where the file cannot be read.
    fn by_faces(self, request: &Request, format: Option<import::Format>) -> Vec<Self> {
        let read = || {
            let drawing = run::read(&open(&self, format).ok()?.source(), &self.request(request)).ok()?;
            Some(drawing.faces)
        };
        // A file that cannot be read is reported by its own job.
        let faces = case::caught(read).ok().flatten().unwrap_or_default();
        if faces.is_empty() {
            return vec![self];
        }
        let named = |id: u64| PathBuf::from(format!("{}-face{id}", self.name.display()));
        faces.iter().map(|f| Job { input: self.input.clone(), name: named(f.id), face: Some(f.id) }).collect()
    }
}

/// The value of `--face` that meshes each planar face of a solid.
const EVERY_FACE: &str = "all";

/// Stack of a thread in bytes, as the main thread has on most systems.
const STACK: usize = 8 << 20;

impl Batch {
    /// Runs the batch.
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        let start = Instant::now();
        self.writing.check()?;
        let Resolved { request, input_format } = self.options.resolve()?;
        self.format.iter().try_for_each(|format| format.hold_order(&request))?;
        self.writing.tell_unused(&self.format, volume);
        let mut jobs = jobs(&self.inputs)?;
        if request.face.as_deref() == Some(EVERY_FACE) {
            jobs = jobs.into_iter().flat_map(|job| job.by_faces(&request, input_format)).collect();
        }
        let file = match self.shard {
            None => "batch.jsonl".to_owned(),
            Some(Shard { part, of }) => {
                jobs = jobs.into_iter().skip(part - 1).step_by(of).collect();
                format!("batch-{part}-of-{of}.jsonl")
            }
        };
        fs::create_dir_all(&self.out_dir).map_err(|e| unwritable(&self.out_dir, &e))?;
        let record = Record::open(&self.out_dir.join(file), self.resume, &request, &self.format, &self.writing)?;
        let earlier: Vec<u8> = jobs.iter().filter_map(|job| record.done(&job.shown())).collect();
        jobs.retain(|job| record.done(&job.shown()).is_none());
        let desk = Desk::new(record, &earlier, jobs.len(), volume);
        let next = AtomicUsize::new(0);
        let work = || {
            // Each thread takes the next input. Threads of their own, not tasks of the pool: a waiting task may take up
            // another one, and its time with it.
            while let Some((k, job)) = Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, jobs.get(k)?)))
            {
                let line = match desk.begin(&job.shown()) {
                    Ok(()) => self.one(job, &job.request(&request), input_format),
                    Err(failure) => Line::failed(job.shown(), failure),
                };
                desk.end(k, &line);
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..squinch::threads::count().min(jobs.len()) {
                let spawned = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work);
                spawned.expect("the system has room for a thread");
            }
        });
        desk.close(start)
    }

    /// Reads, meshes and writes one input. A failure does not end the batch.
    fn one(&self, job: &Job, request: &Request, format: Option<import::Format>) -> Line {
        let start = Instant::now();
        let line = match case::caught(|| self.mesh(job, request, format)) {
            Ok(Ok(line)) => line,
            Ok(Err(failure)) => Line::failed(job.shown(), failure),
            Err(panic) => {
                let what = format!("squinch failed by a bug of its own: {panic}");
                self.keep_case(job, request, format, &format!("panic: {panic}"));
                let help = "please send us the case file beside the outputs";
                Line::failed(job.shown(), FailureReport::new(FailureKind::Bug, what, help))
            }
        };
        Line { seconds: start.elapsed().as_secs_f64(), ..line }
    }

    fn mesh(&self, job: &Job, request: &Request, format: Option<import::Format>) -> Result<Line, FailureReport> {
        let input = open(job, format)?;
        let outcome =
            run::run(&Source { of_many: true, ..input.source() }, request, Extent::Whole(&mut |_| true), &clock());
        if outcome.exit == Exit::Bug {
            self.keep_case(job, request, format, &run::ending(&outcome));
        }
        let written = self.write(job, request, &outcome);
        let line = Line::of(job.shown(), &outcome);
        Ok(match written {
            Ok(outputs) => Line { outputs, ..line },
            Err(error) => Line { exit: Exit::Unwritable as u8, ending: format!("not written: {error}"), ..line },
        })
    }

    /// Writes each format and, if asked for, the report. Returns the names of the mesh files.
    fn write(&self, job: &Job, request: &Request, outcome: &Outcome) -> io::Result<Vec<String>> {
        let (mut staged, mut names) = (Staged::default(), Vec::new());
        let path = |suffix: &str| {
            let mut name = job.name.clone().into_os_string();
            name.push(".");
            name.push(suffix);
            self.out_dir.join(name)
        };
        if let Some(folder) = path("x").parent() {
            fs::create_dir_all(folder)?;
        }
        if outcome.exit != Exit::Bug {
            for &format in &self.format {
                let stamps = stamps(outcome, request);
                let first = path(format.suffixes()[0]);
                let Some(encoded) = self.writing.encode_outcome(format, outcome, &stamps, &first) else { continue };
                for (suffix, bytes) in format.suffixes().iter().zip(encoded?) {
                    staged.add(&path(suffix), &bytes)?;
                    names.push(path(suffix).display().to_string());
                }
            }
        }
        if self.reports {
            staged.add(&path("report.json"), outcome.report.to_json().as_bytes())?;
        }
        staged.commit()?;
        Ok(names)
    }

    /// Writes a case file beside the outputs, for a run that failed by our bug.
    fn keep_case(&self, job: &Job, request: &Request, format: Option<import::Format>, outcome: &str) {
        let Ok(input) = open(job, format) else { return };
        let mut path = self.out_dir.join(&job.name).into_os_string();
        path.push(".case");
        let mut staged = Staged::default();
        let bytes = input.case(outcome, request).to_toml();
        // The record tells of the failure. A missing case file is not reported.
        let _ = staged.add(Path::new(&path), bytes.as_bytes()).and_then(|()| staged.commit());
    }
}

fn open(job: &Job, format: Option<import::Format>) -> Result<Input, FailureReport> {
    Input::open(&job.input, format).map_err(|halt| match halt {
        Halt::Unreadable(what) => {
            FailureReport::new(FailureKind::Unreadable, what, "check the file name and the permission to read it")
        }
        _ => FailureReport::new(
            FailureKind::Unreadable,
            "the file cannot be read",
            "check the file name and the permission to read it",
        ),
    })
}

fn unwritable(path: &Path, error: &io::Error) -> Halt {
    Halt::Unwritable(format!("{}: {error}", path.display()))
}

/// The inputs in the order given, with folders expanded in the order of names. The outputs of an input are named after
/// the file without its suffix, below the folders that led to it; with the suffix where two names would be equal.
fn jobs(inputs: &[PathBuf]) -> Result<Vec<Job>, Halt> {
    let mut files: Vec<(PathBuf, PathBuf)> = Vec::new();
    for input in inputs {
        if input.is_dir() {
            let found = drawings_in(input).map_err(|e| Halt::Unreadable(format!("{}: {e}", input.display())))?;
            files.extend(found.into_iter().map(|below| (input.join(&below), below)));
        } else {
            let name = input.file_name().map_or_else(|| input.clone(), PathBuf::from);
            files.push((input.clone(), name));
        }
    }
    let mut uses: BTreeMap<PathBuf, usize> = BTreeMap::new();
    files.iter().for_each(|(_, below)| *uses.entry(below.with_extension("")).or_default() += 1);
    let mut taken: BTreeMap<PathBuf, usize> = BTreeMap::new();
    let named = files.into_iter().map(|(input, below)| {
        let bare = below.with_extension("");
        let name = if uses[&bare] == 1 { bare } else { below };
        let count = taken.entry(name.clone()).or_default();
        *count += 1;
        let name = if *count == 1 { name } else { PathBuf::from(format!("{}-{count}", name.display())) };
        Job { input, name, face: None }
    });
    Ok(named.collect())
}

/// Largest nesting of folders that are searched.
const DEPTH: usize = 32;

/// The drawings in a folder and in folders within it, by their paths below it, in the order of names.
fn drawings_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut waiting = vec![PathBuf::new()];
    while let Some(below) = waiting.pop() {
        for entry in fs::read_dir(folder.join(&below))? {
            let entry = entry?;
            let path = below.join(entry.file_name());
            if entry.file_type()?.is_dir() && path.components().count() < DEPTH {
                waiting.push(path);
            } else if is_drawing(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Whether a file of a folder is taken for a drawing, by its suffix. Texts are not, as most of them describe other
/// files; nor are vertices, which belong to a `.poly`.
fn is_drawing(path: &Path) -> bool {
    let is_text = path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("txt"));
    import::format_of(path).is_some_and(|format| format != import::Format::Node) && !is_text
}
