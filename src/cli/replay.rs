//! `replay CASE`: repeats a recorded run.

use super::files::{self, Input};
use super::mesh::mesh_with_progress;
use super::{Halt, Volume, clock, remember, say};
use clap::Args;
use squinch::import::Format;
use squinch::run::case::Case;
use squinch::run::{self, Exit, Extent};
use std::path::{Path, PathBuf};

/// Repeat a recorded run
#[derive(Args)]
pub struct Replay {
    /// A case file; - for standard input
    #[arg(value_name = "CASE")]
    case: PathBuf,
    /// Stop after this many steps of the engine, and verify the mesh as it is then
    #[arg(long, value_name = "N")]
    until: Option<u64>,
}

/// Reads a case file: the record, and its input as if read from a file.
pub fn open(path: &Path) -> Result<(Case, Input), Halt> {
    let unreadable = |e: &dyn std::fmt::Display| Halt::Unreadable(format!("{}: {e}", path.display()));
    let bytes = files::read(path).map_err(|e| unreadable(&e))?;
    let text = String::from_utf8(bytes).map_err(|e| unreadable(&e))?;
    let case = Case::from_toml(&text).map_err(|e| unreadable(&e))?;
    let (bytes, nodes) = case.bytes().map_err(|e| unreadable(&e))?;
    let format = match &case.input.format {
        Some(name) => Some(Format::from_name(name).ok_or_else(|| unreadable(&format!("format {name} is not known")))?),
        None => None,
    };
    case.request.validate().map_err(|e| unreadable(&e))?;
    let input = Input { path: case.input.name.clone(), bytes, format, nodes };
    Ok((case, input))
}

/// A note about a case of another version.
pub fn tell_version(case: &Case) {
    let ours = env!("CARGO_PKG_VERSION");
    if case.squinch != ours {
        say::line(&format!("recorded by squinch {}; this is {ours}, with which it may end otherwise", case.squinch));
    }
}

impl Replay {
    /// Repeats the run.
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        let (case, input) = open(&self.case)?;
        remember(&input, &case.request);
        if volume > Volume::Quiet {
            tell_version(&case);
        }
        let outcome = match self.until {
            Some(steps) => run::run(&input.source(), &case.request, Extent::Steps(steps), &clock()),
            None => mesh_with_progress(&input, &case.request, volume),
        };
        if let Some(failure) = &outcome.report.failure {
            say::failure(failure, Some(&input));
        }
        say::summary(&outcome, &[], volume);
        let ending = run::ending(&outcome);
        if self.until.is_none() && ending != case.outcome && volume > Volume::Quiet {
            say::line(&format!("recorded by squinch {}: {}; now: {ending}", case.squinch, case.outcome));
        }
        Ok(outcome.exit)
    }
}
