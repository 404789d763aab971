//! `reduce CASE -o OUT`: shrinks a recorded run while it ends the same way.

use super::files::{Input, Staged, unwritable};
use super::{Halt, Volume, replay, say};
use clap::Args;
use squinch::domain::Drawing;
use squinch::import::{Format, outline};
use squinch::run::case;
use squinch::run::reduce::{Reduced, reduce};
use squinch::run::request::Request;
use squinch::run::{self, Exit};
use std::path::{Path, PathBuf};

/// Shrink a recorded run while it ends the same way
#[derive(Args)]
pub struct Reduce {
    /// A case file; - for standard input
    #[arg(value_name = "CASE")]
    case: PathBuf,
    /// Where the smaller case goes, its input as an outline; - for standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Largest number of runs
    #[arg(long, value_name = "N", default_value_t = 2000)]
    runs: usize,
}

impl Reduce {
    /// Reduces the case.
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        let (case, input) = replay::open(&self.case)?;
        if volume > Volume::Quiet {
            replay::tell_version(&case);
        }
        let drawing = case::caught(|| run::read(&input.source(), &case.request)).map_err(|panic| {
            Halt::Unreadable(format!("the reader fails before there is a drawing to reduce: {panic}"))
        })?;
        let drawing = drawing.map_err(|failure| Halt::Failure(Box::new(failure), Some(Box::new(input))))?;
        // The drawing has unit and scale applied.
        let request = Request { unit: None, scale: None, ..case.request.clone() };
        let mut told = 0;
        let reduced = reduce(&drawing, &request, self.runs, &mut |runs, curves| {
            if volume == Volume::Verbose && runs >= 2 * told {
                told = runs;
                say::line(&format!("{runs} runs, {curves} curves"));
            }
        });
        self.write(&reduced, &request)?;
        if volume > Volume::Quiet {
            say::line(&format!(
                "{} of {} curves left after {} runs, each of which ended the same way: {}",
                reduced.drawing.curves.len(),
                drawing.curves.len(),
                reduced.runs,
                reduced.ending
            ));
        }
        Ok(Exit::Done)
    }

    fn write(&self, reduced: &Reduced, request: &Request) -> Result<(), Halt> {
        let input = outline_of(&reduced.drawing);
        let case = input.case(&reduced.ending, request);
        let mut staged = Staged::default();
        staged
            .add(Path::new(&self.output), case.to_toml().as_bytes())
            .and_then(|()| staged.commit())
            .map_err(unwritable)
    }
}

/// A drawing as an input of its own.
fn outline_of(drawing: &Drawing) -> Input {
    let bytes = outline::to_json(drawing).into_bytes();
    Input { path: "reduced.json".into(), bytes, format: Some(Format::Outline), nodes: None }
}
