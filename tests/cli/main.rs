//! The contract of the command line, kept by the program itself: exit codes, files, reports.

mod batch;
mod budget;
mod cases;
mod checking;
mod drawing;
mod files;
mod healing;
mod meshing;
mod usage;

use squinch::geometry::{Point, Vec2};
use squinch::ids::{IdVec, NameId, VertexId};
use squinch::import;
use squinch::mesh::Mesh;
use squinch::{meshio, picture};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const SQUARE: &str = "4 2 0 1\n1 0 0 7\n2 1 0 7\n3 1 1 7\n4 0 1 7\n4 1\n1 1 2 1\n2 2 3 2\n3 3 4 3\n4 4 1 4\n0\n";

/// Two arcs that meet at 53° twice.
const LENS: &str = r#"{ "squinch": 1, "unit": "mm", "curves": [
    { "name": "below", "arc": { "from": [-1, 0], "to": [1, 0], "bulge": 0.236 } },
    { "name": "above", "arc": { "from": [1, 0], "to": [-1, 0], "bulge": 0.236 } } ] }"#;

/// Two strokes that enclose nothing.
const OPEN: &str = r#"{ "squinch": 1, "curves": [
    { "name": "a", "line": [[0, 0], [1, 0]] }, { "name": "b", "line": [[5, 5], [6, 7]] } ] }"#;

/// A folder of its own for one test, with the inputs in it.
struct Bench(PathBuf);

impl Bench {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{name}"));
        let _ = fs::remove_dir_all(&folder); // left by an earlier run, if at all
        fs::create_dir_all(&folder).expect("a folder to work in");
        for (file, text) in [("square.poly", SQUARE), ("lens.json", LENS), ("open.json", OPEN)] {
            fs::write(folder.join(file), text).expect("an input is written");
        }
        Self(folder)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_squinch"));
        command.current_dir(&self.0).args(arguments).env("NO_COLOR", "1").stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("squinch starts")
    }

    /// Runs, and holds the exit code to the contract.
    fn ends(&self, code: i32, arguments: &[&str]) -> Output {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}\n{}", said(&output));
        output
    }

    fn text(&self, file: &str) -> String {
        fs::read_to_string(self.0.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
    }

    fn report(&self, file: &str) -> serde_json::Value {
        serde_json::from_str(&self.text(file)).expect("a report is JSON")
    }

    fn has(&self, file: &str) -> bool {
        self.0.join(file).exists()
    }

    /// Names of all files, the inputs left out.
    fn made(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("the folder is readable");
        let names = entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned());
        let mut names: Vec<_> =
            names.filter(|n| !["square.poly", "lens.json", "open.json"].contains(&n.as_str())).collect();
        names.sort();
        names
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// A meshing of the square with more options.
fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["mesh", "square.poly", "-o", "a.vtu"], more].concat()
}
