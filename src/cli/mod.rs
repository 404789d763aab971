//! The command line: one file for each verb, shared types, and the exit code.

mod batch;
mod check;
mod convert;
mod draw;
mod files;
mod inspect;
mod mesh;
mod options;
mod output;
mod reduce;
mod replay;
mod say;
mod schema;
mod viewing;
mod writing;

use clap::{Parser, Subcommand};
use files::{Input, Staged};
use squinch::run::Exit;
use squinch::run::case::{self, Case};
use squinch::run::report::FailureReport;
use squinch::run::request::Request;
use std::path::Path;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Provably good triangle meshes of domains with curved boundaries, verified after every run.
#[derive(Parser)]
#[command(
    name = "squinch",
    version = VERSION,
    max_term_width = 110,
    arg_required_else_help = true,
    after_help = EXAMPLES,
    after_long_help = EXIT_CODES
)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
    /// Only errors
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Also every repair and every check
    #[arg(long, short, global = true)]
    verbose: bool,
}

/// Version, commit and features, for bug reports.
const VERSION: &str =
    concat!(env!("CARGO_PKG_VERSION"), " (", env!("SQUINCH_COMMIT"), "; features: ", env!("SQUINCH_FEATURES"), ")");

const EXAMPLES: &str = "\
By job:
  a drawing for viewers
      squinch mesh samples/logo.svg -o logo.glb
  a part for CalculiX
      squinch mesh samples/bracket.dxf -o bracket.inp --order 2 --max-edge 6
  a wing section for SU2
      squinch mesh samples/naca4412.dat -o wing.su2 --far-field 50
  a mesh to look at
      squinch mesh samples/gear.json -o gear.vtu -o gear.png
  what is in a file
      squinch inspect samples/bracket.dxf
  a folder of drawings, one JSON line each
      squinch batch samples/wedges --out-dir meshes --format vtu > meshes.jsonl

squinch VERB -h shows the options of a verb; --help shows all of them, and the exit codes.";

const EXIT_CODES: &str = "\
Exit codes:
  0    done, every guarantee holds
  1    batch: an input ended otherwise
  2    usage
  3    input unreadable
  4    geometry invalid
  5    a requested bound missed, or a budget ran out
  6    output not written
  70   our bug; a case file was written
  130  cancelled";

#[derive(Subcommand)]
enum Verb {
    /// Read, arrange, mesh, verify, write
    Mesh(Box<mesh::Mesh>),
    /// Verify a mesh file, ours or not
    Check(Box<check::Check>),
    /// Many drawings, in parallel, each for itself
    Batch(Box<batch::Batch>),
    /// One mesh format to another, names kept
    Convert(convert::Convert),
    /// The JSON schemas of outlines, reports and batch lines
    Schema(schema::Schema),
    /// What is in a file: curves, names, regions, corners, every repair and flaw with its place
    Inspect(Box<inspect::Inspect>),
    /// A picture of any stage of a file, or of a mesh
    Draw(Box<draw::Draw>),
    /// Repeat a recorded run
    Replay(replay::Replay),
    /// Shrink a recorded run while it ends the same way
    Reduce(reduce::Reduce),
}

/// How much is printed on stderr.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Volume {
    Quiet,
    Normal,
    Verbose,
}

/// What ends a verb early.
enum Halt {
    /// The message was printed already.
    Said(Exit),
    Usage(String),
    Unreadable(String),
    /// The failure of a stage, with the input for pointing into it.
    Failure(Box<FailureReport>, Option<Box<Input>>),
    Unwritable(String),
}

/// Parses the arguments and runs the verb. A panic inside becomes a case file and exit code 70.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return usage(error),
    };
    // Without this handler Ctrl-C would leave temporary files.
    let _ = ctrlc::set_handler(|| {
        files::remove_temporaries();
        say::line("cancelled");
        std::process::exit(Exit::Cancelled as i32);
    });
    let volume = match (cli.quiet, cli.verbose) {
        (true, _) => Volume::Quiet,
        (_, true) => Volume::Verbose,
        _ => Volume::Normal,
    };
    let exit = match case::caught(|| dispatch(cli.verb, volume)) {
        Ok(Ok(exit)) => exit,
        Ok(Err(halt)) => say::halt(halt),
        Err(panic) => {
            files::remove_temporaries();
            say::error(&format!("squinch failed by a bug of its own: {panic}"));
            write_case(&format!("panic: {panic}"), "panic");
            Exit::Bug
        }
    };
    ExitCode::from(exit as u8)
}

fn dispatch(verb: Verb, volume: Volume) -> Result<Exit, Halt> {
    match verb {
        Verb::Mesh(verb) => verb.run(volume),
        Verb::Check(verb) => verb.run(volume),
        Verb::Batch(verb) => verb.run(volume),
        Verb::Convert(verb) => verb.run(volume),
        Verb::Schema(verb) => verb.run(),
        Verb::Inspect(verb) => verb.run(volume),
        Verb::Draw(verb) => verb.run(volume),
        Verb::Replay(verb) => verb.run(volume),
        Verb::Reduce(verb) => verb.run(volume),
    }
}

/// Options and verbs of the contract that this version does not have yet.
const LATER: &[&str] = &["--radius-edge", "--max-volume"];

fn usage(error: clap::Error) -> ExitCode {
    use clap::error::{ContextKind, ContextValue};
    let mut culprits =
        [ContextKind::InvalidArg, ContextKind::InvalidSubcommand].into_iter().filter_map(|k| error.get(k));
    let later = culprits.find_map(|culprit| match culprit {
        ContextValue::String(text) => LATER.iter().find(|later| text.split(['=', ' ']).next() == Some(**later)),
        _ => None,
    });
    match later {
        Some(later) => say::error(&format!("{later} is not in this version")),
        // A closed stdout must not turn --help into a panic.
        None => drop(error.print()),
    }
    ExitCode::from(error.exit_code() as u8)
}

/// The current run. A case file records it if squinch fails by a bug.
static UNDER_WAY: Mutex<Option<Case>> = Mutex::new(None);

/// Records the input and the request, for the case file of a panic.
fn remember(input: &Input, request: &Request) {
    *UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner) = Some(input.case("", request));
}

/// Writes the current run as `squinch-<kind>-<fingerprint>.case` in the working folder, and says so.
fn write_case(outcome: &str, kind: &str) {
    let Some(mut case) = UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner).take() else { return };
    let name = format!("squinch-{kind}-{}.case", case.fingerprint());
    case.outcome = outcome.into();
    let mut staged = Staged::default();
    match staged.add(Path::new(&name), case.to_toml().as_bytes()).and_then(|()| staged.commit()) {
        Ok(()) => say::help(&format!("please send us {name}; `squinch replay {name}` repeats the run")),
        Err(error) => say::error(&format!("the case file could not be written: {error}")),
    }
}

/// Seconds from now on.
fn clock() -> impl Fn() -> f64 {
    let start = Instant::now();
    move || start.elapsed().as_secs_f64()
}
