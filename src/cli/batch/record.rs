//! The record of a batch: written as inputs are done, printed in their order, summed up at the end.
//!
//! The record is a file of JSON lines: the request of all inputs, then a line when an input begins and a line when it
//! is done. Each line is written at once. An input is recorded as done after its files have their final names. So if
//! the program is interrupted, `--resume` meshes the remaining inputs.

use crate::cli::files;
use crate::cli::output::Output;
use crate::cli::writing::Writing;
use crate::cli::{Halt, Volume, say};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use squinch::run::report::{FailureKind, FailureReport, QualityReport};
use squinch::run::request::Request;
use squinch::run::{self, Exit, Outcome};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// The result of one input: a line of the record and of standard output.
#[derive(Serialize, JsonSchema)]
pub struct Line {
    /// The input, as given.
    pub input: String,
    /// The exit code.
    pub exit: u8,
    /// How it ended, in words.
    pub ending: String,
    /// Whether every guarantee holds.
    pub kept: bool,
    /// The mesh files.
    pub outputs: Vec<String>,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Smallest angle of all triangles, in degrees.
    pub min_angle_deg: Option<f64>,
    /// Number of triangles below the requested angle that are exempt.
    pub excused: usize,
    /// Number of repairs.
    pub repairs: usize,
    /// Number of flaws that `--tolerance 0` left.
    pub unhealed: usize,
    /// Number of entities that were left out.
    pub skipped: usize,
    /// Notes about the input.
    pub notes: Vec<String>,
    /// Why there is no mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<FailureReport>,
    /// Seconds.
    pub seconds: f64,
}

impl Line {
    /// The line of a run.
    pub fn of(input: String, outcome: &Outcome) -> Self {
        let report = &outcome.report;
        Self {
            input,
            exit: outcome.exit as u8,
            ending: run::ending(outcome),
            kept: report.promise.as_ref().is_some_and(|p| p.kept),
            outputs: Vec::new(),
            vertices: report.mesh.as_ref().map_or(0, |m| m.vertices),
            triangles: report.mesh.as_ref().map_or(0, |m| m.triangles),
            min_angle_deg: report.quality.as_ref().and_then(QualityReport::in_plane).map(|q| q.min_angle_deg),
            excused: report.promise.as_ref().map_or(0, |p| p.excused.count),
            repairs: report.input.repairs.len(),
            unhealed: report.input.unhealed.len(),
            skipped: report.input.skipped.iter().map(|s| s.count).sum(),
            notes: report.input.notes.clone(),
            failure: report.failure.clone(),
            seconds: 0.0,
        }
    }

    /// The line of an input without a run.
    pub fn failed(input: String, failure: FailureReport) -> Self {
        Self {
            input,
            exit: failure.kind.exit() as u8,
            ending: failure.what.clone(),
            kept: false,
            outputs: Vec::new(),
            vertices: 0,
            triangles: 0,
            min_angle_deg: None,
            excused: 0,
            repairs: 0,
            unhealed: 0,
            skipped: 0,
            notes: Vec::new(),
            failure: Some(failure),
            seconds: 0.0,
        }
    }
}

/// A line of the record, read back.
#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    Head { request: String, formats: Vec<String>, writing: serde_json::Value },
    Begun { begun: String },
    Done { input: String, exit: u8, outputs: Vec<String> },
}

/// An input is not tried again after this number of runs during which the program ended.
const TRIES: usize = 2;

/// The record of a batch.
pub struct Record {
    path: String,
    file: File,
    /// Exit codes of the inputs that an earlier run finished.
    done: BTreeMap<String, u8>,
    /// The inputs that an earlier run began and did not finish, with the number of tries.
    begun: BTreeMap<String, usize>,
}

impl Record {
    /// Opens the record to continue it, or begins a new one.
    pub fn open(
        path: &Path,
        resume: bool,
        request: &Request,
        formats: &[Output],
        writing: &Writing,
    ) -> Result<Self, Halt> {
        let shown = path.display().to_string();
        let request = toml::to_string(request).expect("a request holds only words, numbers and lists of them");
        let writing = serde_json::to_value(writing).expect("options of writing are words, numbers and lists of them");
        let formats: Vec<String> = formats.iter().map(|f| f.name().to_owned()).collect();
        let text = match std::fs::read(path) {
            Ok(bytes) if resume => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if resume && error.kind() != io::ErrorKind::NotFound => {
                return Err(Halt::Unreadable(format!("{shown}: {error}")));
            }
            _ => String::new(),
        };
        let mut entries = text.lines().filter_map(|line| serde_json::from_str(line).ok());
        match entries.next() {
            None => {}
            Some(Entry::Head { request: r, formats: f, writing: w })
                if (&r, &f, &w) == (&request, &formats, &writing) => {}
            Some(_) => {
                let what = format!("{shown} is of a batch with other options: use them again, or another --out-dir");
                return Err(Halt::Usage(what));
            }
        }
        let mut opened = OpenOptions::new();
        opened.create(true).write(true);
        let file = if resume { opened.append(true).open(path) } else { opened.truncate(true).open(path) };
        let file = file.map_err(|e| Halt::Unwritable(format!("{shown}: {e}")))?;
        let mut record = Self { path: shown, file, done: BTreeMap::new(), begun: BTreeMap::new() };
        entries.for_each(|entry| record.recall(entry));
        let begins = if text.is_empty() {
            record.write(&serde_json::json!({ "request": request, "formats": formats, "writing": writing }))
        } else if text.ends_with('\n') {
            Ok(())
        } else {
            // The last line is incomplete.
            record.file.write_all(b"\n")
        };
        begins.map_err(|e| record.unwritable(&e))?;
        Ok(record)
    }

    fn recall(&mut self, entry: Entry) {
        match entry {
            Entry::Head { .. } => {}
            Entry::Begun { begun } => *self.begun.entry(begun).or_default() += 1,
            Entry::Done { input, exit, outputs } => {
                self.begun.remove(&input);
                if outputs.iter().all(|path| Path::new(path).exists()) {
                    self.done.insert(input, exit);
                }
            }
        }
    }

    /// The exit code of an input that an earlier run finished.
    pub fn done(&self, input: &str) -> Option<u8> {
        self.done.get(input).copied()
    }

    fn write(&mut self, line: &impl Serialize) -> io::Result<()> {
        let mut text = serde_json::to_string(line)?;
        text.push('\n');
        self.file.write_all(text.as_bytes())
    }

    fn unwritable(&self, error: &io::Error) -> Halt {
        Halt::Unwritable(format!("{}: {error}", self.path))
    }
}

/// Collects the results of the threads of a batch.
pub struct Desk {
    state: Mutex<State>,
    earlier: usize,
    volume: Volume,
    /// Whether lines are printed. They are for programs; a terminal shows failures instead.
    lines: bool,
    /// Whether failures are shown on a terminal.
    watched: bool,
}

struct State {
    record: Record,
    bar: say::Count,
    /// The next line to print, and the lines after it.
    next: usize,
    waiting: BTreeMap<usize, String>,
    /// Number of inputs with each exit code.
    exits: BTreeMap<u8, usize>,
    /// The first output that could not be written. The batch continues and ends with this error.
    unwritten: Option<Halt>,
}

impl Desk {
    /// For this number of inputs. `earlier` are the exit codes of inputs that were done before.
    pub fn new(record: Record, earlier: &[u8], inputs: usize, volume: Volume) -> Self {
        let mut exits: BTreeMap<u8, usize> = BTreeMap::new();
        earlier.iter().for_each(|&exit| *exits.entry(exit).or_default() += 1);
        let bar = say::Count::new(volume, inputs);
        let state = State { record, bar, next: 0, waiting: BTreeMap::new(), exits, unwritten: None };
        let lines = !io::stdout().is_terminal();
        let watched = !lines || io::stderr().is_terminal();
        Self { state: Mutex::new(state), earlier: earlier.len(), volume, lines, watched }
    }

    fn state(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records that an input begins.
    ///
    /// # Errors
    /// Where the program ended during it more than once: for lack of memory, or by a bug that cannot be caught.
    pub fn begin(&self, input: &str) -> Result<(), FailureReport> {
        let mut state = self.state();
        if state.record.begun.get(input).is_some_and(|&n| n >= TRIES) {
            let what = format!("the program ended {TRIES} times while it worked on this input");
            return Err(FailureReport::new(FailureKind::Bug, what, "mesh it alone, with --max-vertices and --timeout"));
        }
        state.write(&serde_json::json!({ "begun": input }));
        Ok(())
    }

    /// Records the result of the k-th input, and prints it after all before it; on a terminal only failures.
    pub fn end(&self, k: usize, line: &Line) {
        let mut state = self.state();
        let text = serde_json::to_string(line).expect("a line holds only words, numbers and lists of them");
        state.write(line);
        *state.exits.entry(line.exit).or_default() += 1;
        state.bar.one_more();
        if self.watched && line.exit != 0 {
            let help = line.failure.as_ref().map_or("", |failure| &failure.help);
            state.bar.failed(&line.input, &line.ending, help);
        }
        if !self.lines {
            return;
        }
        state.waiting.insert(k, text);
        let next = state.next;
        let mut ready = String::new();
        for turn in next.. {
            let Some(text) = state.waiting.remove(&turn) else { break };
            ready.push_str(&text);
            ready.push('\n');
            state.next = turn + 1;
        }
        if let Err(halt) = files::print(&ready) {
            state.unwritten.get_or_insert(halt);
        }
    }

    /// The summary and the exit code.
    pub fn close(self, start: Instant) -> Result<Exit, Halt> {
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        drop(state.bar);
        if let Some(halt) = state.unwritten {
            return Err(halt);
        }
        let failed: usize = state.exits.iter().filter(|(exit, _)| **exit != 0).map(|(_, n)| n).sum();
        if self.volume > Volume::Quiet {
            say::batch(&state.exits, self.earlier, start.elapsed().as_secs_f64());
        }
        Ok(if failed > 0 { Exit::SomeFailed } else { Exit::Done })
    }
}

impl State {
    fn write(&mut self, line: &impl Serialize) {
        if let Err(error) = self.record.write(line) {
            let halt = self.record.unwritable(&error);
            self.unwritten.get_or_insert(halt);
        }
    }
}
