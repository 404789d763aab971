//! The contract of the command line, kept by the program itself: exit codes, files, reports.

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

#[test]
fn no_output_is_the_input_or_another_output() {
    let bench = Bench::new("named-twice");
    for [option, file] in [["--report", "square.poly"], ["--case", "square.vtu"], ["-o", "square.vtu"]] {
        bench.ends(2, &["mesh", "square.poly", "-o", "square.vtu", option, file]);
    }
    assert_eq!(bench.text("square.poly"), SQUARE);
    assert!(bench.made().is_empty());
}

#[test]
fn help_answers() {
    let bench = Bench::new("help");
    let help = printed(&bench.ends(0, &["--help"]));
    for word in ["mesh", "check", "convert", "inspect", "draw", "replay", "reduce", "Exit codes", "130"] {
        assert!(help.contains(word), "{word}\n{help}");
    }
    for verb in ["mesh", "check", "batch", "convert", "schema", "inspect", "draw", "replay", "reduce"] {
        assert!(printed(&bench.ends(0, &[verb, "--help"])).contains("Usage: squinch"), "{verb}");
    }
    let mesh = printed(&bench.ends(0, &["mesh", "--help"]));
    for option in [
        "--engine",
        "--min-angle",
        "--max-turning",
        "--beta",
        "--ball-shrinking",
        "--midpoint",
        "--max-area",
        "--max-edge",
        "--min-edge",
        "--chord-error",
        "--edge-turning",
        "--grade",
        "--size-of",
        "--order",
        "--tolerance",
        "--fill-rule",
        "--keep",
        "--unit",
        "--scale",
        "--corner-arcs",
        "--max-vertices",
        "--timeout",
        "--report",
        "--case",
        "--trailing-edge",
        "--far-field",
        "--incidence",
        "--config",
        "--threads",
        "--quiet",
        "--input-format",
        "--format",
    ] {
        assert!(mesh.contains(option), "{option}");
    }
}

/// A meshing of the square with more options.
fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["mesh", "square.poly", "-o", "a.vtu"], more].concat()
}

#[test]
fn wrong_usage_is_2_and_leaves_nothing() {
    let bench = Bench::new("usage");
    fs::write(bench.0.join("word.toml"), "beta = 'much'\n").unwrap();
    fs::write(bench.0.join("key.toml"), "beto = 0.9\n").unwrap();
    let inputs = bench.made();
    let wrong: Vec<Vec<&str>> = vec![
        vec![],
        vec!["mash"],
        vec!["mesh"],
        vec!["mesh", "square.poly"],
        vec!["mesh", "square.poly", "-o", "a.unknown"],
        vec!["mesh", "square.poly", "-o", "-"],
        vec!["mesh", "square.poly", "-o", "-", "--format", "vtu", "--report", "-"],
        vec!["mesh", "square.poly", "-o", "a.vtu", "-o", "b.svg", "--format", "vtu"],
        vec!["draw", "square.poly", "-o", "a.vtu"],
        vec!["draw", "square.poly", "-o", "a.svg", "--view", "1,1,0,0"],
        with(&["--min-angle", "60"]),
        with(&["--min-angle", "some"]),
        with(&["--max-turning", "1.1"]),
        with(&["--beta", "1"]),
        with(&["--max-area", "0"]),
        with(&["--chord-error", "0%"]),
        with(&["--size-of", "0.1"]),
        with(&["--unit", "cubit"]),
        with(&["--input-format", "dwg"]),
        with(&["--config", "missing.toml"]),
        with(&["--config", "word.toml"]),
        with(&["--config", "key.toml"]),
        with(&["--threads", "0"]),
        with(&["--quiet", "--verbose"]),
    ];
    for arguments in wrong {
        let output = bench.ends(2, &arguments);
        assert!(!output.stderr.is_empty() && output.stdout.is_empty(), "{arguments:?}");
    }
    assert_eq!(bench.made(), inputs);
}

#[test]
fn what_comes_later_is_refused_by_name() {
    let bench = Bench::new("later");
    for option in ["--radius-edge=2", "--max-volume=1"] {
        let output = bench.ends(2, &["mesh", "square.poly", "-o", "a.vtu", option]);
        assert!(said(&output).contains("not in this version"), "{option}: {}", said(&output));
    }
    assert!(bench.made().is_empty());
}

#[test]
fn a_picture_is_meshed_in_the_unit_asked_for() {
    let bench = Bench::new("picture");
    let square = r#"<svg viewBox="0 0 72 72"><rect width="72" height="72"/><line x2="72" y2="72" stroke="red"/></svg>"#;
    fs::write(bench.0.join("square.svg"), square).unwrap();
    bench.ends(
        0,
        &["mesh", "square.svg", "-o", "a.vtu", "--report", "a.json", "--dpi=72", "--unit=mm", "--strokes=lines"],
    );
    let report: serde_json::Value = serde_json::from_str(&fs::read_to_string(bench.0.join("a.json")).unwrap()).unwrap();
    let area = report["quality"]["exact_measure"].as_f64().unwrap();
    assert!((area - 25.4 * 25.4).abs() < 1e-9, "{area}");
    assert_eq!((report["request"]["dpi"].as_f64(), report["request"]["strokes"].as_str()), (Some(72.0), Some("lines")));
    let names: Vec<_> = report["mesh"]["boundaries"].as_array().unwrap().iter().map(|b| b["name"].clone()).collect();
    assert_eq!(names, ["background", "red"]);
}

#[test]
fn an_unreadable_input_is_3_with_its_line() {
    let bench = Bench::new("unreadable");
    fs::write(bench.0.join("cut.poly"), "4 2 0 0\n1 0 0\n2 x 0\n").unwrap();
    fs::write(bench.0.join("broken.vtu"), "<VTKFile").unwrap();
    fs::write(bench.0.join("broken.case"), "squinch = 1").unwrap();
    fs::write(bench.0.join("nothing"), "").unwrap();
    let inputs = bench.made();
    for verb in ["mesh", "draw"] {
        bench.ends(3, &[verb, "missing.poly", "-o", "a.svg"]);
        bench.ends(3, &[verb, "nothing", "-o", "a.svg"]);
        let output = bench.ends(3, &[verb, "cut.poly", "-o", "a.svg"]);
        assert!(said(&output).contains("cut.poly:3"), "{}", said(&output));
    }
    bench.ends(3, &["inspect", "cut.poly"]);
    bench.ends(3, &["check", "missing.vtu"]);
    bench.ends(3, &["check", "broken.vtu"]);
    bench.ends(3, &["replay", "missing.case"]);
    bench.ends(3, &["replay", "broken.case"]);
    bench.ends(3, &["reduce", "broken.case", "-o", "b.case"]);
    assert_eq!(bench.made(), inputs);

    bench.ends(3, &["mesh", "cut.poly", "-o", "a.vtu", "--report", "r.json"]);
    let report = bench.report("r.json");
    assert_eq!(report["failure"]["kind"], "unreadable");
    assert_eq!(report["failure"]["line"], 3);
    assert!(report["mesh"].is_null() && !bench.has("a.vtu"));
}

#[test]
fn geometry_that_encloses_nothing_is_4() {
    let bench = Bench::new("geometry");
    let output = bench.ends(4, &["mesh", "open.json", "-o", "a.vtu", "--report", "r.json"]);
    assert!(said(&output).contains("help:"), "{}", said(&output));
    let report = bench.report("r.json");
    assert_eq!(report["failure"]["kind"], "geometry");
    assert_eq!(report["input"]["curves"]["line"], 2);
    assert_eq!(bench.made(), ["r.json"]);
    let output = bench.ends(4, &["inspect", "open.json", "--json"]);
    let findings: serde_json::Value = serde_json::from_str(&printed(&output)).expect("JSON");
    assert_eq!(findings["flaws"].as_array().map(Vec::len), Some(1));
    bench.ends(0, &["draw", "open.json", "--stage", "drawing", "-o", "a.svg"]);
}

#[test]
fn a_mesh_is_written_judged_and_reported() {
    let bench = Bench::new("mesh");
    let output =
        bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "-o", "a.svg", "-o", "a.png", "--report", "r.json"]);
    for word in ["vertices", "angles", "kept", "a.vtu"] {
        assert!(said(&output).contains(word), "{word}\n{}", said(&output));
    }
    assert!(output.stdout.is_empty());
    assert_eq!(bench.made(), ["a.png", "a.svg", "a.vtu", "r.json"]);
    let report = bench.report("r.json");
    assert_eq!(report["promise"]["kept"], true);
    assert_eq!(report["stop"]["reason"], "done");
    assert_eq!(report["input"]["format"], "outline");
    assert_eq!(report["request"]["length_unit"], "mm");
    assert_eq!(report["request"]["tau_rad"], 0.5);
    let quality = &report["quality"];
    assert!(quality["min_unexcused_angle_deg"].as_f64() >= Some(20.7), "{quality}");
    assert_eq!(quality["angle_histogram"].as_array().map(Vec::len), Some(180));
    let names = |list: &serde_json::Value| -> Vec<String> {
        list.as_array().unwrap().iter().map(|b| b["name"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(names(&report["mesh"]["boundaries"]), ["below", "above"]);
    let checks = report["promise"]["checks"].as_array().unwrap();
    assert_eq!(checks.len(), 17);
    assert!(checks.iter().all(|c| c["status"] != "broken"));
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let bench = Bench::new("same");
    for (name, threads) in [("a", "1"), ("b", "2")] {
        let (mesh, report, case) = (format!("{name}.vtu"), format!("{name}.json"), format!("{name}.case"));
        let files = ["-o", &mesh, "--report", &report, "--case", &case, "--threads", threads];
        bench.ends(0, &[&["mesh", "lens.json", "--max-area", "0.01"][..], &files[..]].concat());
    }
    assert_eq!(fs::read(bench.0.join("a.vtu")).unwrap(), fs::read(bench.0.join("b.vtu")).unwrap());
    assert_eq!(bench.text("a.case"), bench.text("b.case"));
    let timeless = |file: &str| {
        let mut report = bench.report(file);
        let fields = report.as_object_mut().unwrap();
        assert!(fields.remove("seconds").is_some() && fields.remove("peak_memory_bytes").is_some());
        serde_json::to_string(&report).unwrap()
    };
    assert_eq!(timeless("a.json"), timeless("b.json"));
}

#[test]
fn an_output_that_cannot_be_written_is_6_and_nothing_is_left() {
    let bench = Bench::new("unwritable");
    fs::create_dir(bench.0.join("folder.vtu")).unwrap();
    let inputs = bench.made();
    bench.ends(6, &["mesh", "square.poly", "-o", "a.vtu", "-o", "missing/a.vtu"]);
    bench.ends(6, &["mesh", "square.poly", "-o", "a.vtu", "-o", "folder.vtu"]);
    bench.ends(6, &["mesh", "square.poly", "-o", "a.vtu", "--report", "missing/r.json"]);
    bench.ends(6, &["draw", "square.poly", "-o", "missing/a.svg"]);
    assert_eq!(bench.made(), inputs);
}

#[test]
fn an_old_file_stays_where_the_new_one_fails() {
    let bench = Bench::new("old");
    fs::write(bench.0.join("a.vtu"), "old").unwrap();
    bench.ends(4, &["mesh", "open.json", "-o", "a.vtu"]);
    bench.ends(6, &["mesh", "square.poly", "-o", "a.vtu", "-o", "missing/b.vtu"]);
    assert_eq!(bench.text("a.vtu"), "old");
    bench.ends(0, &["mesh", "square.poly", "-o", "a.vtu"]);
    assert_ne!(bench.text("a.vtu"), "old");
}

#[test]
fn a_missed_bound_and_an_ended_budget_are_5() {
    let bench = Bench::new("missed");
    let output = bench.ends(
        5,
        &["mesh", "square.poly", "-o", "a.vtu", "--max-area", "0.006", "--max-vertices", "50", "--report", "r.json"],
    );
    assert!(said(&output).contains("budget"), "{}", said(&output));
    let report = bench.report("r.json");
    assert_eq!(report["stop"]["reason"], "vertex budget");
    assert_eq!(report["promise"]["kept"], false);
    assert!(report["stop"]["owed"].as_u64() > Some(0));
    assert!(bench.has("a.vtu"), "the mesh is written all the same");
}

#[test]
fn standard_input_and_output_carry_files() {
    let bench = Bench::new("pipes");
    let mut child = bench
        .command(&["mesh", "-", "--input-format", "poly", "-o", "-", "--format", "vtu", "--quiet"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("squinch starts");
    child.stdin.take().expect("a pipe").write_all(SQUARE.as_bytes()).expect("the input is taken");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(output.stderr.is_empty(), "--quiet: {}", said(&output));
    bench.ends(0, &["mesh", "square.poly", "-o", "a.vtu"]);
    assert_eq!(printed(&output), bench.text("a.vtu"));
}

#[test]
fn standard_input_tells_its_format_by_its_content() {
    let bench = Bench::new("sniff");
    let fed = |arguments: &[&str], bytes: &[u8]| {
        let mut child = bench.command(arguments).stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a start");
        child.stdin.take().expect("a pipe").write_all(bytes).expect("the input is taken");
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", said(&output));
    };
    for (drawing, format) in [(SQUARE, "poly"), (LENS, "outline")] {
        fed(&["mesh", "-", "-o", "a.vtu", "--report", "r.json"], drawing.as_bytes());
        assert_eq!(bench.report("r.json")["input"]["format"], format);
        fed(&["draw", "-", "--stage", "drawing", "-o", "a.svg"], drawing.as_bytes());
    }
    let mesh = fs::read(bench.0.join("a.vtu")).unwrap();
    fed(&["check", "-"], &mesh);
    fed(&["draw", "-", "-o", "mesh.svg"], &mesh);
    assert_ne!(bench.text("mesh.svg"), bench.text("a.svg"));
    // Nothing at all has no format.
    let output = bench.ends(3, &["mesh", "-", "-o", "b.vtu"]);
    assert!(said(&output).contains("--input-format"), "{}", said(&output));
}

#[test]
fn what_a_file_holds_does_not_steer_the_terminal() {
    let bench = Bench::new("control");
    let named = LENS.replace("below", "be\\u001b[2Jlow");
    fs::write(bench.0.join("named.json"), &named).unwrap();
    fs::write(bench.0.join("cut.poly"), format!("4 2 0 0\n1 0 \x1b[31m{}\n", "x".repeat(1 << 22))).unwrap();
    fs::write(bench.0.join("cut.dat"), "na\x1b]0;me\n1 0\n0.5 \x1b[2J\n0 0\n0.5 -0.1\n1 0\n").unwrap();
    let outputs = [
        bench.ends(0, &["inspect", "named.json"]),
        bench.ends(0, &["mesh", "named.json", "-o", "a.vtu", "-v"]),
        bench.ends(2, &["mesh", "named.json", "-o", "a.vtu", "--size-of", "wing=1"]),
        bench.ends(3, &["mesh", "cut.poly", "-o", "a.vtu"]),
        bench.ends(3, &["mesh", "cut.dat", "-o", "a.vtu"]),
    ];
    for output in &outputs {
        let text = said(output) + &printed(output);
        assert!(!text.contains('\x1b') && text.len() < 20_000, "{} bytes: {:.2000}", text.len(), text);
    }
    assert!(printed(&outputs[0]).contains("be\\u{1b}[2Jlow"), "{}", printed(&outputs[0]));
    // Data keep their names as they are.
    let json: serde_json::Value =
        serde_json::from_str(&printed(&bench.ends(0, &["inspect", "named.json", "--json"]))).expect("JSON");
    assert_eq!(json["boundaries"][0]["name"], "be\u{1b}[2Jlow");
}

#[test]
fn an_option_below_its_bound_is_answered_by_the_bound() {
    let bench = Bench::new("negative");
    for [option, value, why] in [
        ["--min-angle", "-1", "an angle from 0"],
        ["--tolerance", "-1", "not negative"],
        ["--max-area", "-1e-3", "a positive number"],
        ["--chord-error", "-0.5", "a positive length"],
        ["--far-field", "-2", "1 chord or more"],
    ] {
        let output = bench.ends(2, &with(&[option, value]));
        assert!(said(&output).contains(why), "{option} {value}: {}", said(&output));
    }
}

#[test]
fn an_option_that_has_no_use_is_told() {
    let bench = Bench::new("unused");
    let output = bench.ends(0, &with(&["--far-field", "5", "--incidence", "-3", "--report", "r.json"]));
    assert!(said(&output).contains("--far-field, --incidence: only for airfoils"), "{}", said(&output));
    let notes = bench.report("r.json")["input"]["notes"].to_string();
    assert!(notes.contains("--far-field, --incidence"), "{notes}");
    assert!(!said(&bench.ends(0, &with(&[]))).contains("airfoils"));
}

#[test]
fn triangles_left_alone_for_their_size_are_no_corners() {
    let bench = Bench::new("min-edge");
    // Two lines a hair apart make small angles that --min-edge leaves alone.
    let thin = "8 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n5 0.4 0.5\n6 0.6 0.5\n7 0.45 0.503\n8 0.55 0.503\n\
                6 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 5 6\n6 7 8\n0\n";
    fs::write(bench.0.join("thin.poly"), thin).unwrap();
    let output = bench.ends(0, &["mesh", "thin.poly", "-o", "a.vtu", "--min-edge", "0.3", "--edge-turning", "off"]);
    assert!(said(&output).contains("left alone for --min-edge"), "{}", said(&output));
    assert!(!said(&output).contains("sharp corner"), "{}", said(&output));
}

#[test]
fn why_nothing_is_meshed_fits_the_drawing() {
    let bench = Bench::new("nothing");
    let help = |drawing: &str, more: &[&str]| {
        fs::write(bench.0.join("x.json"), drawing).unwrap();
        said(&bench.ends(4, &[&["mesh", "x.json", "-o", "a.vtu"][..], more].concat()))
    };
    let circle = r#"{ "name": "rim", "circle": { "center": [0, 0], "radius": 1 } }"#;
    let twice = format!(r#"{{ "squinch": 1, "fill": "evenodd", "curves": [{circle}, {circle}] }}"#);
    fs::write(bench.0.join("x.json"), twice).unwrap();
    let text = said(&bench.ends(0, &["mesh", "x.json", "-o", "a.vtu"]));
    assert!(text.contains("1 curve is drawn twice"), "{text}");
    let hole = format!(r#"{{ "squinch": 1, "curves": [{circle}], "seeds": [{{ "at": [0, 0], "hole": true }}] }}"#);
    let text = help(&hole, &["--fill-rule", "regions"]);
    assert!(text.contains("remove hole points") && !text.contains("`regions`"), "{text}");
    let open = |x: f64| {
        format!(r#"{{ "squinch": 1, "curves": [{{ "name": "a", "polyline": [[0, 0], [1, 0], [1, 1], [0, {x}]] }}] }}"#)
    };
    assert!(help(&open(0.8), &[]).contains("close the outline by another curve"));
    assert!(help(&open(0.01), &[]).contains("--close 0.011 joins these ends"));
}

#[test]
fn a_case_of_another_version_is_remarked() {
    let bench = Bench::new("version");
    bench.ends(0, &["mesh", "square.poly", "-o", "a.vtu", "--case", "a.case"]);
    assert!(!said(&bench.ends(0, &["replay", "a.case"])).contains("recorded by"));
    let version = format!("squinch = \"{}\"", env!("CARGO_PKG_VERSION"));
    let older = bench.text("a.case").replace(&version, "squinch = \"0.0.7\"");
    fs::write(bench.0.join("b.case"), older).unwrap();
    assert!(said(&bench.ends(0, &["replay", "b.case"])).contains("recorded by squinch 0.0.7"));
    let output = bench.ends(5, &["replay", "a.case", "--until", "0"]);
    assert!(said(&output).contains("--until") && !said(&output).contains("--timeout"), "{}", said(&output));
}

#[test]
fn a_closed_pipe_is_no_panic() {
    let bench = Bench::new("closed");
    for arguments in
        [&["mesh", "square.poly", "-o", "-", "--format", "svg"][..], &["inspect", "square.poly"], &["--help"]]
    {
        let mut child =
            bench.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("squinch starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert!(matches!(output.status.code(), Some(0 | 6)), "{arguments:?}: {:?}", output.status);
        assert!(!said(&output).contains("panic"), "{}", said(&output));
    }
    assert!(bench.made().is_empty(), "no case file");
}

#[test]
fn the_command_line_wins_over_the_config_file() {
    let bench = Bench::new("config");
    fs::write(
        bench.0.join("c.toml"),
        "min-angle = 12\nmax-turning = 'auto'\nbeta = 0.5\ncorner-arcs = 'off'\nsize-of = ['below=0.2']\n",
    )
    .unwrap();
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "--config", "c.toml", "--beta", "0.8", "--report", "r.json"]);
    let request = &bench.report("r.json")["request"];
    assert_eq!(request["angle_min_deg"], 12.0);
    assert_eq!(request["beta"], 0.8);
    assert_eq!(request["max_turning"], "auto");
    assert_eq!(request["corner_arcs"], false);
    assert_eq!(request["size_of"]["below"], 0.2);
    assert!(request["tau_rad"].as_f64() > Some(0.5), "12° is proven on arcs beyond τ = 0.5: {request}");
}

#[test]
fn a_size_for_a_name_that_is_not_there_lists_those_that_are() {
    let bench = Bench::new("names");
    let output = bench.ends(2, &["mesh", "lens.json", "-o", "a.vtu", "--size-of", "wing=0.1"]);
    assert!(said(&output).contains("wing") && said(&output).contains("below"), "{}", said(&output));
}

#[test]
fn unit_and_scale_reach_the_mesh() {
    let bench = Bench::new("unit");
    let area = |more: &[&str]| {
        bench.ends(0, &[&["mesh", "lens.json", "-o", "a.vtu", "--report", "r.json"][..], more].concat());
        let report = bench.report("r.json");
        (report["quality"]["exact_measure"].as_f64().expect("an area"), report["input"]["unit"].clone())
    };
    let (own, unit) = area(&[]);
    assert_eq!(unit, "mm");
    let (metres, unit) = area(&["--unit", "m"]);
    assert_eq!(unit, "m");
    assert!((metres / own - 1e-6).abs() < 1e-15, "{metres} {own}");
    let (scaled, _) = area(&["--scale", "4"]);
    assert!((scaled / own - 16.0).abs() < 1e-9);
}

#[test]
fn a_mesh_of_ours_is_checked_by_what_it_was_asked_for() {
    let bench = Bench::new("check");
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "--min-angle", "15", "--max-edge", "0.5"]);
    bench.ends(0, &["check", "a.vtu"]);
    let output = bench.ends(0, &["check", "a.vtu", "--against", "lens.json", "--report", "r.json"]);
    assert!(said(&output).contains("kept"), "{}", said(&output));
    let report = bench.report("r.json");
    assert_eq!(report["request"]["angle_min_deg"], 15.0);
    assert_eq!(report["request"]["max_edge"], 0.5);
    let asked = |name: &str| {
        let checks = report["promise"]["checks"].as_array().unwrap();
        checks.iter().find(|c| c["name"] == name).map(|c| c["status"] != "n/a")
    };
    assert_eq!(asked("on_curve"), Some(true));
    assert_eq!(asked("size"), Some(true));
    bench.ends(5, &["check", "a.vtu", "--against", "lens.json", "--max-edge", "0.01"]);
    bench.ends(5, &["check", "a.vtu", "--against", "square.poly"]);
    bench.ends(4, &["check", "a.vtu", "--against", "open.json"]);
}

/// What other programs do to a mesh of ours.
fn rewritten(mesh: &Mesh) -> Vec<(&'static str, Mesh)> {
    let numbered = |mesh: &Mesh| {
        let mut nameless = Mesh { names: Default::default(), ..mesh.clone() };
        let numbers: Vec<NameId> =
            mesh.names.iter().enumerate().map(|(i, _)| nameless.names.intern(&(i + 1).to_string())).collect();
        let number = |name: NameId| numbers[mesh.names.iter().position(|(id, _)| id == name).expect("a name")];
        nameless.regions.iter_mut().for_each(|name| *name = number(*name));
        nameless.edges.iter_mut().for_each(|edge| edge.name = number(edge.name));
        nameless
    };
    let permuted = |mesh: &Mesh| {
        let n = mesh.nodes.len() as u32;
        let place = |v: VertexId| VertexId(n - 1 - v.0);
        let mut turned = mesh.clone();
        turned.nodes = mesh.nodes.iter().rev().copied().collect::<IdVec<_, Point>>();
        turned.triangles.iter_mut().for_each(|t| *t = t.map(place));
        turned.edges.iter_mut().for_each(|e| e.nodes = e.nodes.map(place));
        turned
    };
    let mut half = mesh.clone();
    half.edges.iter_mut().step_by(3).for_each(|edge| edge.link = None);
    let fewer = Mesh { edges: mesh.edges.iter().copied().step_by(2).collect(), ..mesh.clone() };
    let bare = Mesh { edges: Vec::new(), ..numbered(mesh).untied() };
    vec![
        ("names lost", numbered(mesh)),
        ("fields lost", numbered(mesh).untied()),
        ("links half kept", half),
        ("half the lines", fewer),
        ("triangles only", bare),
        ("nodes renumbered, points and balls not", permuted(mesh)),
        ("nodes renumbered, all else lost", permuted(&numbered(mesh).untied())),
    ]
}

fn read_vtu(bytes: &[u8]) -> Result<meshio::MeshFile, meshio::MeshError> {
    meshio::read(bytes, meshio::Format::Vtu, &[])
}

fn write_mesh(bench: &Bench, file: &str, mesh: &Mesh) {
    let bytes =
        meshio::encode(mesh, &[], meshio::Format::Vtu, &meshio::WriteOptions::default()).expect("the lists fit");
    fs::write(bench.0.join(file), bytes.concat()).expect("a mesh is written");
}

#[test]
fn a_mesh_that_another_program_rewrote_is_judged_by_where_its_nodes_lie() {
    let bench = Bench::new("rewritten");
    let plate = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/plate.json");
    fs::copy(plate, bench.0.join("plate.json")).expect("a sample");
    for (drawing, edge) in [("lens.json", "0.3"), ("square.poly", "0.3"), ("plate.json", "2")] {
        bench.ends(0, &["mesh", drawing, "-o", "a.vtu", "--max-edge", edge]);
        let ours = read_vtu(&fs::read(bench.0.join("a.vtu")).unwrap()).expect("our own mesh").mesh;
        for (what, mesh) in rewritten(&ours) {
            write_mesh(&bench, "b.vtu", &mesh);
            let check = ["check", "b.vtu", "--against", drawing, "--report", "r.json"];
            let output = bench.ends(0, &check);
            assert!(said(&output).contains("note:"), "{what}: {}", said(&output));
            let status = |name: &str| {
                let checks = bench.report("r.json")["promise"]["checks"].as_array().cloned().unwrap();
                checks.iter().find(|c| c["name"] == name).expect(name)["status"].clone()
            };
            for name in ["conforming", "on_curve", "curve_chain", "area"] {
                assert_eq!(status(name), "proven", "{drawing}, {what}: {name}");
            }
            let nameless = ["names lost", "fields lost", "triangles only", "nodes renumbered, all else lost"];
            // The square's only region is called as every region without a name is.
            let asked = if nameless.contains(&what) && drawing != "square.poly" { "n/a" } else { "proven" };
            assert!(drawing == "square.poly" || status("names") == asked, "{drawing}, {what}: {}", status("names"));

            let mut moved = mesh.clone();
            let rim = mesh.nodes.ids().find(|&v| is_on_rim(&mesh, v)).expect("a node on the rim");
            moved.nodes[rim] += Vec2::new(1e-4, 1.3e-4);
            write_mesh(&bench, "b.vtu", &moved);
            let output = bench.ends(5, &check);
            assert!(said(&output).contains("conforming"), "{what}: {}", said(&output));
        }
    }
}

/// Whether a node has an edge with one triangle.
fn is_on_rim(mesh: &Mesh, v: VertexId) -> bool {
    let beside: Vec<_> = mesh.triangles.iter().filter(|t| t.contains(&v)).collect();
    let neighbours = beside.iter().flat_map(|t| t.iter()).filter(|&&u| u != v);
    neighbours.clone().any(|u| neighbours.clone().filter(|&w| w == u).count() == 1)
}

#[test]
fn a_rewritten_mesh_with_wrong_names_is_broken() {
    let bench = Bench::new("misnamed");
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "--max-edge", "0.2"]);
    let ours = read_vtu(&fs::read(bench.0.join("a.vtu")).unwrap()).expect("our own mesh").mesh;
    let mut swapped = ours.clone().untied();
    let other = swapped.names.find("above").expect("a boundary");
    swapped.edges[0].name = other;
    let mut stray = ours.clone().untied();
    let inner = stray.nodes.ids().find(|&v| !is_on_rim(&stray, v)).expect("a node inside");
    let beside = *stray.triangles.iter().find(|t| t.contains(&inner)).expect("a triangle");
    let nodes = [inner, *beside.iter().find(|&&v| v != inner).expect("a neighbour")];
    stray.edges.push(squinch::mesh::CurveEdge { nodes, name: other, link: None });
    for (mesh, culprit) in [(swapped, "is of \"above\", its curve of \"below\""), (stray, "lies on no curve")] {
        write_mesh(&bench, "b.vtu", &mesh);
        let output = bench.ends(5, &["check", "b.vtu", "--against", "lens.json"]);
        assert!(said(&output).contains("broken: names") && said(&output).contains(culprit), "{}", said(&output));
    }
}

#[test]
fn inspect_tells_what_is_there() {
    let bench = Bench::new("inspect");
    let findings: serde_json::Value =
        serde_json::from_str(&printed(&bench.ends(0, &["inspect", "lens.json", "--json"]))).expect("JSON");
    assert_eq!(findings["curves"]["arc"], 2);
    assert_eq!(findings["unit"], "mm");
    assert_eq!(findings["domain"]["acute_corners"], 2);
    let angle = findings["domain"]["smallest_angle"]["angle_deg"].as_f64().expect("an angle");
    assert!((angle - 8.0 * 0.236_f64.atan().to_degrees() / 2.0).abs() < 1e-6, "{angle}");
    assert!(findings["flaws"].as_array().unwrap().is_empty());
    let text = printed(&bench.ends(0, &["inspect", "lens.json"]));
    for word in ["2 arcs", "below", "acute", "mm"] {
        assert!(text.contains(word), "{word}\n{text}");
    }
}

#[test]
fn every_stage_can_be_drawn() {
    let bench = Bench::new("draw");
    let mut pictures = std::collections::BTreeSet::new();
    for stage in ["drawing", "domain", "subcurves", "triangulation", "refined", "mesh"] {
        let file = format!("{stage}.svg");
        bench.ends(0, &["draw", "lens.json", "--stage", stage, "--max-area", "0.01", "-o", &file]);
        let svg = bench.text(&file);
        assert!(svg.starts_with("<svg") || svg.starts_with("<?xml"), "{stage}");
        assert!(pictures.insert(svg), "{stage} looks like another stage");
    }
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu"]);
    for colour in ["quality", "region", "size"] {
        let options = ["--colour", colour, "--view", "-0.5,-0.5,0.5,0.5", "--width", "300", "-o", "a.png"];
        bench.ends(0, &[&["draw", "a.vtu"][..], &options[..]].concat());
        assert!(fs::read(bench.0.join("a.png")).unwrap().starts_with(b"\x89PNG"));
    }
}

#[test]
fn convert_keeps_names_and_says_what_it_loses() {
    let bench = Bench::new("convert");
    bench.ends(
        0,
        &[
            "mesh",
            "lens.json",
            "-o",
            "a.vtu",
            "-o",
            "a.msh",
            "-o",
            "a.ele",
            "-o",
            "b.msh",
            "--format",
            "vtu,msh,triangle,msh22",
        ],
    );
    assert_eq!(bench.made(), ["a.ele", "a.msh", "a.node", "a.poly", "a.vtu", "b.msh"]);
    assert!(bench.text("b.msh").starts_with("$MeshFormat\n2.2 0 8"));
    bench.ends(0, &["check", "a.ele"]);
    // Through formats and back: SU2 is the one that tells.
    let output = bench.ends(0, &["convert", "a.vtu", "a.su2"]);
    assert!(said(&output).contains("not kept by su2: links to curves"), "{}", said(&output));
    for (from, to) in
        [("a.ele", "c.inp"), ("c.inp", "c.vtk"), ("c.vtk", "c.obj"), ("c.obj", "c.msh"), ("c.msh", "c.su2")]
    {
        bench.ends(0, &["convert", from, to]);
    }
    let sorted = |file: &str| {
        let mut lines: Vec<String> =
            bench.text(file).lines().filter(|l| l.starts_with("MARKER")).map(String::from).collect();
        lines.sort();
        lines
    };
    assert_eq!(sorted("a.su2"), sorted("c.su2"));
    assert_eq!(printed(&bench.ends(0, &["convert", "a.vtu", "-", "--format", "su2", "--quiet"])), bench.text("a.su2"));
    let made = bench.made();
    // Several files cannot go to standard output; nothing may be written over what is read, files beside it included.
    for wrong in
        [&["convert", "a.vtu", "-", "--format", "triangle"], &["mesh", "square.poly", "-o", "square.ele"] as &[&str]]
    {
        bench.ends(2, wrong);
    }
    bench.ends(2, &["convert", "a.vtu", "a.what"]);
    bench.ends(3, &["convert", "missing.msh", "x.vtu"]);
    bench.ends(3, &["convert", "lens.json", "x.vtu"]);
    assert_eq!(bench.made(), made);
    assert_eq!(bench.text("square.poly"), SQUARE);
}

#[test]
fn a_case_is_replayed_and_reduced() {
    let bench = Bench::new("case");
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "--case", "a.case", "--min-angle", "18"]);
    let case = bench.text("a.case");
    assert!(case.contains("min-angle = 18") && case.contains("outcome = \"done\""), "{case}");
    bench.ends(0, &["replay", "a.case"]);
    bench.run(&["replay", "a.case", "--until", "3"]);

    // A square beside strokes, with a size for a name that nothing bears: one curve is enough to say so.
    let mut curves: Vec<String> =
        (0..7).map(|i| format!(r#"{{ "name": "stroke", "line": [[{i}, 5], [{i}.5, 6]] }}"#)).collect();
    curves.extend(
        [(0, 0, 1, 0), (1, 0, 1, 1), (1, 1, 0, 1), (0, 1, 0, 0)]
            .map(|(a, b, c, d)| format!(r#"{{ "name": "rim", "line": [[{a}, {b}], [{c}, {d}]] }}"#)),
    );
    fs::write(bench.0.join("many.json"), format!(r#"{{ "squinch": 1, "curves": [{}] }}"#, curves.join(","))).unwrap();
    bench.ends(
        5,
        &["mesh", "many.json", "-o", "b.vtu", "--max-vertices", "20", "--max-area", "1e-4", "--case", "b.case"],
    );
    bench.ends(0, &["reduce", "b.case", "-o", "c.case"]);
    bench.ends(5, &["replay", "c.case"]);
    let left = bench.text("c.case").matches("rim").count();
    assert!(!bench.text("c.case").contains("stroke\", \"line"), "{}", bench.text("c.case"));
    assert!(left >= 4, "the square itself must stay: {}", bench.text("c.case"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_is_130_and_leaves_nothing() {
    let bench = Bench::new("interrupt");
    let child = bench
        .command(&["mesh", "square.poly", "-o", "a.vtu", "--max-area", "1e-9", "--max-vertices", "4000000000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("squinch starts");
    // The handler is set before the work begins, and the work lasts for minutes.
    std::thread::sleep(std::time::Duration::from_millis(700));
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is there");
    assert!(killed.success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    assert!(bench.made().is_empty(), "{:?}", bench.made());
}

/// The status of a check in a report.
fn status_of<'a>(report: &'a serde_json::Value, check: &str) -> &'a str {
    let checks = report["promise"]["checks"].as_array().expect("checks");
    checks.iter().find(|c| c["name"] == check).expect("the check")["status"].as_str().expect("a status")
}

#[test]
fn sizes_by_place_come_as_an_expression_or_from_a_file() {
    let bench = Bench::new("sizes");
    let triangles = |size: &[&str]| {
        let line = [&["mesh", "square.poly", "-o", "a.vtu", "--report", "a.json"], size].concat();
        bench.ends(0, &line);
        let report = bench.report("a.json");
        assert_eq!(status_of(&report, "size"), "proven");
        report["mesh"]["triangles"].as_u64().expect("a count")
    };
    let expression = triangles(&["--size", "0.02 + 0.1*hypot(x, y)"]);
    fs::write(bench.0.join("sizes.txt"), "# one fine corner\n0 0 0.02\n").expect("written");
    let file = triangles(&["--size", "sizes.txt", "--grade", "0.1"]);
    assert!(expression > 200 && expression.abs_diff(file) < expression / 5, "{expression} and {file}");
    // A mesh of ours says what it was asked for, sizes of a file included, and is held to it.
    bench.ends(0, &["check", "a.vtu", "--against", "square.poly"]);
    let output = bench.ends(2, &["mesh", "square.poly", "-o", "b.vtu", "--size", "x +"]);
    assert!(said(&output).contains("a value is missing at the end of 'x +'"), "{}", said(&output));
    let output = bench.ends(2, &["mesh", "square.poly", "-o", "b.vtu", "--size", "x"]);
    assert!(said(&output).contains("no positive length"), "{}", said(&output));
    assert!(!bench.has("b.vtu"));
}

/// A polygon of so many corners all over the unit square: its sides cross about n²/4.6 times.
fn scribble(n: usize) -> String {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    let corners: Vec<[f64; 2]> = (0..n).map(|_| [next(), next()]).collect();
    serde_json::json!({ "squinch": 1, "curves": [{ "polygon": corners }] }).to_string()
}

#[test]
fn the_time_ends_arranging_too() {
    let bench = Bench::new("timeout-arrange");
    fs::write(bench.0.join("scribble.json"), scribble(4000)).unwrap();
    let timed = ["scribble.json", "--timeout", "0.2"];
    let ended = bench.ends(5, &[&["mesh"], &timed[..], &["-o", "a.vtu", "--report", "r.json"]].concat());
    assert!(said(&ended).contains("--timeout"), "{}", said(&ended));
    let report = bench.report("r.json");
    assert_eq!(report["stop"]["reason"], "timeout");
    assert_eq!(report["failure"]["kind"], "no_mesh");
    assert!(!bench.has("a.vtu"));
    bench.ends(5, &[&["inspect"], &timed[..]].concat());
    bench.ends(5, &[&["draw"], &timed[..], &["-o", "a.svg"]].concat());
}

#[test]
fn a_mesh_that_is_there_when_the_time_ends_is_judged_and_written() {
    let bench = Bench::new("timeout-refine");
    bench.ends(
        5,
        &with(&["--max-area", "1e-9", "--max-vertices", "4000000000", "--timeout", "0.5", "--report", "r.json"]),
    );
    let report = bench.report("r.json");
    assert_eq!(report["stop"]["reason"], "timeout");
    assert!(report["stop"]["owed"].as_u64() > Some(0));
    let broken = report["promise"]["checks"].as_array().unwrap().iter().filter(|check| check["status"] == "broken");
    assert_eq!(broken.map(|check| &check["name"]).collect::<Vec<_>>(), ["size"]);
    assert!(bench.has("a.vtu"));
}

#[test]
fn more_pieces_than_vertices_are_refused_before_they_are_made() {
    let bench = Bench::new("pieces");
    for turning in ["1e-9", "1e-300"] {
        bench.ends(5, &["mesh", "lens.json", "-o", "a.vtu", "--max-turning", turning, "--report", "r.json"]);
        let report = bench.report("r.json");
        assert_eq!(report["stop"]["reason"], "vertex budget");
        assert!(report["stop"]["owed"].as_u64() > Some(900_000_000));
        assert!(
            report["failure"]["at"].is_array() && report["failure"]["help"].as_str().unwrap().contains("--max-turning")
        );
    }
    // What the budget allows is cut.
    bench.ends(5, &["mesh", "lens.json", "-o", "a.vtu", "--max-turning", "1e-3", "--max-vertices", "500"]);
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "--max-turning", "1e-2"]);
}

/// The lines of a batch, the seconds taken out.
fn lines_of(output: &Output) -> Vec<serde_json::Value> {
    let text = String::from_utf8_lossy(&output.stdout);
    let line = |line| {
        let mut value: serde_json::Value = serde_json::from_str(line).expect("a line is JSON");
        value.as_object_mut().expect("an object").remove("seconds");
        value
    };
    text.lines().map(line).collect()
}

#[test]
fn a_batch_goes_on_after_errors_and_tells_one_line_an_input_in_their_order() {
    let bench = Bench::new("batch");
    fs::create_dir_all(bench.0.join("in/deep")).expect("folders");
    for (file, text) in [
        ("in/b.json", LENS),
        ("in/a.poly", SQUARE),
        ("in/b.poly", SQUARE),
        ("in/deep/c.json", OPEN),
        ("in/read.me", "no"),
    ] {
        fs::write(bench.0.join(file), text).expect("written");
    }
    let batch = ["batch", "in", "missing.svg", "--out-dir", "out", "--format", "vtu,su2", "--reports"];
    let output = bench.ends(1, &[&batch[..], &["--threads", "2"]].concat());
    let lines = lines_of(&output);
    let told = |key: &str| lines.iter().map(|l| l[key].clone()).collect::<Vec<_>>();
    assert_eq!(told("input"), ["in/a.poly", "in/b.json", "in/b.poly", "in/deep/c.json", "missing.svg"]);
    assert_eq!(told("exit"), [0, 0, 0, 4, 3]);
    assert_eq!(told("kept"), [true, true, true, false, false]);
    assert!(said(&output).contains("3  done, every promise kept (0)"), "{}", said(&output));
    // Two inputs of one name keep their suffixes.
    for made in ["a.vtu", "a.su2", "a.report.json", "b.json.vtu", "b.poly.su2", "deep/c.report.json"] {
        assert!(bench.has(&format!("out/{made}")), "{made}");
    }
    assert!(!bench.has("out/deep/c.vtu"));
    // One thread tells the same, and the record holds the lines.
    let again = bench.ends(1, &[&batch[..], &["--threads", "1"]].concat());
    assert_eq!(lines_of(&again), lines);
    let record = bench.text("out/batch.jsonl");
    let recorded = |input: &str| record.lines().filter(|l| l.contains(&format!("\"input\":\"{input}\""))).count();
    assert!(["in/a.poly", "in/deep/c.json", "missing.svg"].iter().all(|input| recorded(input) == 1), "{record}");
}

#[test]
fn a_batch_that_was_killed_is_resumed_with_nothing_lost_or_done_twice() {
    let bench = Bench::new("resume");
    fn batch<'a>(more: &[&'a str]) -> Vec<&'a str> {
        [&["batch", "square.poly", "lens.json", "open.json", "--out-dir", "out", "--format", "vtu"], more].concat()
    }
    bench.ends(1, &batch(&["--threads", "1"]));
    // As a kill leaves it: the lens was begun, the line of the square is there, the next one is cut short.
    let record = bench.text("out/batch.jsonl");
    let kept: Vec<&str> = record.lines().take(4).collect();
    assert!(kept[3].contains("\"begun\":\"lens.json\""), "{record}");
    fs::write(bench.0.join("out/batch.jsonl"), kept.join("\n") + "\n{\"input\":\"lens").expect("written");
    let output = bench.ends(1, &batch(&["--resume"]));
    let inputs: Vec<_> = lines_of(&output).iter().map(|l| l["input"].clone()).collect();
    assert_eq!(inputs, ["lens.json", "open.json"]);
    assert!(said(&output).contains("3 inputs, 1 of them earlier"), "{}", said(&output));
    // All is done; an output that is gone is made again.
    assert!(lines_of(&bench.ends(1, &batch(&["--resume"]))).is_empty());
    fs::remove_file(bench.0.join("out/square.vtu")).expect("removed");
    assert_eq!(lines_of(&bench.ends(1, &batch(&["--resume"]))).len(), 1);
    // Other options are another batch.
    let output = bench.ends(2, &batch(&["--resume", "--max-area", "0.1"]));
    assert!(said(&output).contains("other options"), "{}", said(&output));
    // An input at which the program died twice is not begun a third time.
    let begun = "{\"begun\":\"lens.json\"}\n".repeat(2);
    let head = record.lines().next().expect("a head");
    fs::write(bench.0.join("out/batch.jsonl"), format!("{head}\n{begun}")).expect("written");
    let lines = lines_of(&bench.ends(1, &batch(&["--resume"])));
    assert_eq!((lines[1]["exit"].as_u64(), lines[0]["exit"].as_u64()), (Some(70), Some(0)));
}

#[test]
fn the_shards_of_a_batch_are_the_whole() {
    let bench = Bench::new("shards");
    let mut inputs = Vec::new();
    for part in ["1/2", "2/2"] {
        let arguments = ["batch", "square.poly", "lens.json", "--out-dir", "out", "--format", "vtu", "--shard", part];
        inputs.extend(lines_of(&bench.ends(0, &arguments)).iter().map(|l| l["input"].as_str().unwrap().to_owned()));
    }
    assert_eq!(inputs, ["square.poly", "lens.json"]);
    assert!(bench.has("out/batch-1-of-2.jsonl") && bench.has("out/batch-2-of-2.jsonl"));
    bench.ends(2, &["batch", "square.poly", "--out-dir", "out", "--format", "vtu", "--shard", "3/2"]);
}

/// Two disks that touch, a shelf that passes their contact by two millionths, and a box around all.
const CONTACT: &str = r#"{ "squinch": 1, "fill": "regions", "curves": [
    { "name": "left", "arc": { "from": [0, 0], "to": [-10, 0], "bulge": 1 } },
    { "name": "left", "arc": { "from": [-10, 0], "to": [0, 0], "bulge": 1 } },
    { "name": "right", "arc": { "from": [0, 0], "to": [10, 0], "bulge": 1 } },
    { "name": "right", "arc": { "from": [10, 0], "to": [0, 0], "bulge": 1 } },
    { "name": "shelf", "line": [[-20, 2e-6], [20, 2e-6]] },
    { "name": "box", "line": [[-20, -20], [20, -20]] }, { "name": "box", "line": [[20, -20], [20, 20]] },
    { "name": "box", "line": [[20, 20], [-20, 20]] }, { "name": "box", "line": [[-20, 20], [-20, -20]] } ] }"#;

#[test]
fn slivers_that_nobody_drew_on_purpose_are_welded_and_itemised() {
    let bench = Bench::new("slivers");
    // Exact work is refused: to weld it would move its areas.
    fs::write(bench.0.join("exact.json"), CONTACT).unwrap();
    let output = bench.ends(4, &["mesh", "exact.json", "-o", "exact.vtu"]);
    assert!(said(&output).contains("--tolerance"), "{}", said(&output));
    let sketch = CONTACT.replace(r#""squinch": 1,"#, r#""squinch": 1, "sketch": true,"#);
    fs::write(bench.0.join("contact.json"), sketch).unwrap();
    let output = bench.ends(0, &["mesh", "contact.json", "-o", "a.vtu", "--report", "r.json"]);
    assert!(said(&output).contains("1 tolerance raised"), "{}", said(&output));
    let report = bench.report("r.json");
    let raised = &report["input"]["repairs"][0];
    assert_eq!(raised["kind"], "tolerance_raised");
    assert_eq!(raised["size"], report["request"]["tolerance"]);
    assert!(report["mesh"]["vertices"].as_u64() < Some(2000), "{}", report["mesh"]["vertices"]);
    bench.ends(0, &["check", "a.vtu", "--against", "contact.json"]);
    // A tolerance that was asked for is kept.
    bench.ends(0, &["inspect", "contact.json", "--tolerance", "1e-9", "--json"]);
    let asked = ["--tolerance", "1e-9", "--max-vertices", "5000", "--report", "r.json"];
    bench.ends(5, &[&["mesh", "contact.json", "-o", "b.vtu"], &asked[..]].concat());
    let report = bench.report("r.json");
    assert!(report["input"]["repairs"].as_array().unwrap().iter().all(|r| r["kind"] != "tolerance_raised"));
    assert_eq!(report["request"]["tolerance"], 1e-9);
}

#[test]
fn walls_of_cells_that_were_computed_twice_become_one() {
    let bench = Bench::new("cells");
    let line = |[a, b]: [[f64; 2]; 2]| format!(r#"{{ "line": [{a:?}, {b:?}] }}"#);
    let cell = |[x, y]: [f64; 2], [w, h]: [f64; 2]| {
        let corners = [[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
        [0, 1, 2, 3].map(|i| line([corners[i], corners[(i + 1) % 4]])).join(",")
    };
    // The upper cells overlap by 4e-7 of their height of 10, 2e-9 of all.
    let cells =
        [cell([0.0, -20.0], [70.0, 20.0]), cell([20.0, 0.0], [10.0, 10.0]), cell([20.0, 9.9999996], [10.0, 10.0])];
    let table = format!(r#"{{ "squinch": 1, "fill": "regions", "curves": [{}] }}"#, cells.join(","));
    fs::write(bench.0.join("table.json"), table).unwrap();
    let output = bench.ends(0, &["mesh", "table.json", "-o", "a.vtu", "--report", "r.json"]);
    assert!(said(&output).contains("1 tolerance raised"), "{}", said(&output));
    let report = bench.report("r.json");
    assert!(report["mesh"]["vertices"].as_u64() < Some(200), "{}", report["mesh"]["vertices"]);
    assert_eq!(report["mesh"]["regions"].as_array().unwrap().len(), 3);
}

#[test]
fn overlaps_of_shapes_become_regions_where_asked_for() {
    let bench = Bench::new("overlap");
    let picture = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 6">
        <rect id="low" width="6" height="4"/><rect id="top" x="4" y="2" width="5" height="4"/></svg>"#;
    fs::write(bench.0.join("boxes.svg"), picture).unwrap();
    let regions = |more: &[&str]| -> Vec<(String, f64)> {
        bench.ends(0, &[&["mesh", "boxes.svg", "-o", "a.vtu", "--report", "r.json"], more].concat());
        bench.ends(0, &["check", "a.vtu", "--against", "boxes.svg"]);
        let of = |r: &serde_json::Value| (r["name"].as_str().unwrap().to_owned(), r["measure"].as_f64().unwrap());
        bench.report("r.json")["mesh"]["regions"].as_array().unwrap().iter().map(of).collect()
    };
    let near = |found: Vec<(String, f64)>, wanted: &[(&str, f64)]| {
        assert_eq!(found.len(), wanted.len(), "{found:?}");
        let same = |(f, w): (&(String, f64), &(&str, f64))| f.0 == w.0 && (f.1 - w.1).abs() < 1e-9;
        assert!(found.iter().zip(wanted).all(same), "{found:?}");
    };
    near(regions(&[]), &[("low", 20.0), ("top", 20.0)]);
    near(regions(&["--overlap", "fragment"]), &[("low", 20.0), ("top", 16.0), ("top+low", 4.0)]);
}

#[test]
fn what_a_format_does_not_hold_is_said_of_a_run_that_tells_all() {
    let bench = Bench::new("losses");
    let outputs = ["mesh", "lens.json", "-o", "a.vtu", "-o", "a.png", "-o", "a.su2"];
    assert!(!said(&bench.ends(0, &outputs)).contains("not kept"));
    let output = bench.ends(0, &[&outputs[..], &["-v"]].concat());
    let lost: Vec<_> = said(&output).lines().filter(|l| l.contains("not kept")).map(str::to_owned).collect();
    let wanted = ["the unit: coordinates stay as they are", "links to curves and protecting balls"];
    assert_eq!(lost, wanted.map(|what| format!("  not kept by su2: {what}")));
    assert!(said(&bench.ends(0, &["mesh", "lens.json", "-o", "a.su2", "--quiet"])).is_empty());
}

/// A plate with a near-miss of every kind, each below the default tolerances (5e-9, and 5e-6 for ends that meet nothing): and a notch
/// drawn twice, which is no miss.
const NEAR_MISSES: &str = r#"{ "squinch": 1, "curves": [
    { "name": "rim", "line": [[0, 0], [4, 0]] }, { "name": "rim", "line": [[4, 0], [4, 3]] },
    { "name": "rim", "line": [[4, 3], [0, 3]] }, { "name": "rim", "line": [[0, 3], [0, 0]] },
    { "name": "window", "line": [[1, 1], [2, 1]] }, { "name": "window", "line": [[2.000001, 1], [2, 2]] },
    { "name": "window", "line": [[2, 2], [1, 1]] },
    { "name": "rib", "line": [[3, 2e-9], [3, 3]] },
    { "name": "twice", "line": [[3.2, 1], [3.8, 1]] }, { "name": "twice", "line": [[3.2, 1.000000001], [3.8, 1.000000001]] },
    { "name": "along", "line": [[3.2, 2], [3.6, 2]] }, { "name": "along", "line": [[3.4, 2.000000001], [3.8, 2.000000001]] },
    { "name": "speck", "line": [[0.5, 2.5], [0.500000001, 2.5]] },
    { "name": "pinhole", "arc": { "center": [0.5, 2], "radius": 1e-9, "start_deg": 0, "sweep_deg": 360 } },
    { "name": "notch", "line": [[0.2, 0.2], [0.4, 0.2]] }, { "name": "notch", "line": [[0.2, 0.2], [0.4, 0.2]] } ] }"#;

/// Kind and place of each, to six digits.
fn places_of(repairs: &serde_json::Value) -> Vec<String> {
    let place = |at: &serde_json::Value| format!("{:.6} {:.6}", at[0].as_f64().unwrap(), at[1].as_f64().unwrap());
    let list = repairs.as_array().expect("a list").iter();
    let mut places: Vec<_> = list.map(|r| format!("{} {}", r["kind"].as_str().unwrap(), place(&r["at"]))).collect();
    places.sort();
    places
}

#[test]
fn a_tolerance_of_0_heals_nothing_and_reports_what_it_leaves() {
    let bench = Bench::new("unhealed");
    fs::write(bench.0.join("near.json"), NEAR_MISSES).unwrap();
    let missed = [
        "collapsed 0.500000 2.000000",
        "duplicate 3.500000 1.000000",
        "gap_closed 2.000001 1.000000",
        "overlap 3.500000 2.000000",
        "split 3.000000 0.000000",
        "split 3.400000 2.000000",
        "split 3.600000 2.000000",
        "weld 0.500000 2.500000",
        "weld 3.200000 1.000000",
        "weld 3.800000 1.000000",
        "zero_length 0.500000 2.500000",
    ];
    let inspect = |more: &[&str]| -> serde_json::Value {
        let output = bench.ends(0, &[&["inspect", "near.json", "--json"], more].concat());
        serde_json::from_str(&printed(&output)).expect("inspect prints JSON")
    };
    // The triangle that misses closing would be refused.
    let unhealed = ["--tolerance", "0", "--loose", "keep"];
    let left = inspect(&unhealed);
    assert_eq!(places_of(&left["unhealed"]), missed);
    assert_eq!(places_of(&left["repairs"]), ["duplicate 0.300000 0.200000", "split 3.000000 3.000000"]);
    let gap = left["unhealed"].as_array().unwrap().iter().find(|r| r["kind"] == "gap_closed").unwrap();
    assert!((gap["size"].as_f64().unwrap() - 1e-6).abs() < 1e-12, "{gap}");
    // By default all of it is healed, and nothing left.
    let healed = inspect(&[]);
    assert_eq!(places_of(&healed["unhealed"]), [""; 0]);
    let mut all: Vec<_> = missed.iter().map(|&m| m.to_owned()).chain(places_of(&left["repairs"])).collect();
    all.sort();
    assert_eq!(places_of(&healed["repairs"]), all);
    // Pictures show both.
    for stage in ["drawing", "domain"] {
        bench.ends(0, &[&["draw", "near.json", "--stage", stage, "-o", "x.svg"][..], &unhealed].concat());
        let picture = bench.text("x.svg");
        assert!(picture.contains("id=\"repairs\"") && picture.contains(">left as it is: 1 gap closed<"), "{stage}");
        assert!(picture.contains(">1 duplicate dropped<") && picture.contains(">1 split<"), "{stage}");
    }
    // A run reports the same, and says so; where it comes to no mesh too.
    let run = ["mesh", "near.json", "-o", "a.vtu", "--min-edge", "0.1", "--report", "r.json"];
    let output = bench.ends(0, &[&run[..], &unhealed].concat());
    assert!(said(&output).contains("unhealed  by default there would be 3 welds, 1 gap closed"), "{}", said(&output));
    assert_eq!(places_of(&bench.report("r.json")["input"]["unhealed"]), missed);
    let triangle = r#"{ "squinch": 1, "curves": [ { "name": "a", "line": [[0, 0], [1, 0]] },
        { "name": "a", "line": [[1, 0], [0, 1]] }, { "name": "a", "line": [[0, 1], [-1e-7, 1e-7]] } ] }"#;
    fs::write(bench.0.join("ajar.json"), triangle).unwrap();
    let output = bench.ends(4, &["mesh", "ajar.json", "-o", "b.vtu", "--tolerance", "0", "--report", "r.json"]);
    assert!(said(&output).contains("unhealed  by default there would be 1 gap closed"), "{}", said(&output));
    assert_eq!(places_of(&bench.report("r.json")["input"]["unhealed"]), ["gap_closed -0.000000 0.000000"]);
}

/// A square that was traced twice, a hair apart, with numbers of so many digits.
fn traced_twice(digits: usize) -> String {
    let corner = |x: f64, y: f64| format!("{x:.digits$},{y:.digits$}");
    let off = 1.0 / 30000.0;
    let square = |a: f64, b: f64| format!("M{} L{} L{} L{} Z", corner(a, a), corner(b, a), corner(b, b), corner(a, b));
    let third = 1.0 / 3.0;
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><path id="a" d="{}"/><path id="b" d="{}"/></svg>"#,
        square(third, 90.0 + third),
        square(third + off, 90.0 + third - off)
    )
}

#[test]
fn hair_gaps_of_a_sketch_are_welded_and_those_of_exact_work_are_not() {
    let bench = Bench::new("sketch");
    fs::write(bench.0.join("sketch.svg"), traced_twice(6)).unwrap();
    let output = bench.ends(0, &["mesh", "sketch.svg", "-o", "a.vtu", "--report", "r.json"]);
    assert!(said(&output).contains("1 tolerance raised"), "{}", said(&output));
    assert!(bench.report("r.json")["mesh"]["triangles"].as_u64() < Some(200));
    bench.ends(0, &["check", "a.vtu", "--against", "sketch.svg"]);
    // Fragments of slivers are gone in the coarser domain, and those that stay are the same by their names.
    let corner = r#"<rect id="c" x="-5" y="-5" width="50" height="50"/></svg>"#;
    fs::write(bench.0.join("overlap.svg"), traced_twice(6).replace("</svg>", corner)).unwrap();
    bench.ends(0, &["mesh", "overlap.svg", "-o", "o.vtu", "--overlap", "fragment", "--report", "r.json"]);
    let report = bench.report("r.json");
    assert_eq!(report["input"]["repairs"][0]["kind"], "tolerance_raised");
    let regions = report["mesh"]["regions"].as_array().unwrap().iter();
    assert_eq!(regions.map(|r| r["name"].as_str().unwrap()).collect::<Vec<_>>(), ["c", "c+b+a", "b+a"]);
    fs::write(bench.0.join("exact.svg"), traced_twice(15)).unwrap();
    let output = bench.ends(5, &["mesh", "exact.svg", "-o", "b.vtu", "--max-vertices", "100000"]);
    assert!(!said(&output).contains("raised"), "{}", said(&output));
}

#[test]
fn a_drawing_of_slivers_is_not_welded_away() {
    let bench = Bench::new("film");
    let side = |[[a, b], [c, d]]: [[f64; 2]; 2]| format!(r#"{{ "name": "film", "line": [[{a}, {b}], [{c}, {d}]] }}"#);
    let h = 5e-7;
    let sides = [[[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [1.0, h]], [[1.0, h], [0.0, h]], [[0.0, h], [0.0, 0.0]]];
    let film = format!(r#"{{ "squinch": 1, "curves": [{}] }}"#, sides.map(side).join(","));
    fs::write(bench.0.join("film.json"), film).unwrap();
    let output = bench.ends(0, &["inspect", "film.json"]);
    assert!(!said(&output).contains("raised"), "{}", said(&output));
}

#[test]
fn what_the_budget_cannot_hold_is_refused_before_it_is_tried() {
    let bench = Bench::new("demand");
    let refused = |arguments: &[&str], option: &str| {
        bench.ends(5, &[&["mesh"], arguments, &["-o", "a.vtu", "--report", "r.json"]].concat());
        let report = bench.report("r.json");
        assert_eq!(report["stop"]["reason"], "vertex budget");
        assert!(!report["stop"]["places"].as_array().unwrap().is_empty());
        assert!(report["failure"]["help"].as_str().unwrap().contains(option), "{}", report["failure"]["help"]);
        assert!(report["seconds"]["mesh"].as_f64() < Some(1.0) && !bench.has("a.vtu"));
    };
    refused(&["square.poly", "--max-area", "1e-12"], "--max-vertices");
    refused(&["square.poly", "--max-edge", "1e-7"], "--max-vertices");
    refused(&["lens.json", "--chord-error", "1e-18"], "--max-vertices");
    refused(&["lens.json", "--edge-turning", "1e-7"], "--max-vertices");
    // A corner of 0.0006° in a box, between sides that are long beyond its ball.
    let wedge = "7 2 0 0\n1 0 0\n2 1 0\n3 1 1e-5\n4 -1 -1\n5 2 -1\n6 2 1\n7 -1 1\n\
                 7 0\n1 1 2\n2 2 3\n3 3 1\n4 4 5\n5 5 6\n6 6 7\n7 7 4\n0\n";
    fs::write(bench.0.join("wedge.poly"), wedge).unwrap();
    refused(&["wedge.poly", "--max-vertices", "2000"], "--min-edge");
    bench.ends(0, &["mesh", "wedge.poly", "--max-vertices", "2000", "--min-edge", "0.01", "-o", "b.vtu"]);
}

#[test]
fn the_version_tells_commit_and_features() {
    let version = printed(&Bench::new("version").ends(0, &["--version"]));
    let rest = version.strip_prefix(concat!("squinch ", env!("CARGO_PKG_VERSION"), " (")).expect("name and version");
    let (commit, features) = rest.split_once("; features: ").expect("two parts");
    assert!(commit == "unknown commit" || commit.bytes().all(|b| b.is_ascii_hexdigit()), "{version}");
    assert_eq!(features, format!("{})\n", if cfg!(feature = "cad") { "cad" } else { "none" }));
}

#[test]
fn short_help_is_for_jobs_and_long_help_for_all() {
    let bench = Bench::new("short-help");
    for verb in ["mesh", "batch"] {
        let [short, long] = ["-h", "--help"].map(|help| printed(&bench.ends(0, &[verb, help])));
        for option in ["--delta2", "--ball-shrinking", "--steiner"] {
            assert!(long.contains(option) && !short.contains(option), "{option}");
        }
        for option in ["--min-angle", "--max-edge", "--engine", "--order", "--plain", "--format"] {
            assert!(short.contains(option), "{option}\n{short}");
        }
    }
    assert!(printed(&bench.ends(0, &["-h"])).contains("By job:"));
    assert!(!printed(&bench.ends(0, &["-h"])).contains("130"), "exit codes are in the long help");
}

/// Every format is in the lists that people read, on the command line and in the README.
#[test]
fn help_lists_every_format() {
    let bench = Bench::new("help-formats");
    let help = |verb| printed(&bench.ends(0, &[verb, "--help"])).split_whitespace().collect::<Vec<_>>().join(" ");
    let [mesh, convert, check] = ["mesh", "convert", "check"].map(help);
    let all = meshio::Format::ALL.map(|f| f.name()).into_iter().chain(picture::Format::ALL.map(|f| f.name()));
    let refused = said(&bench.ends(2, &["mesh", "square.poly", "-o", "square.vtu", "--format", "none"]));
    for name in all {
        assert!(refused.contains(name), "{name} is not offered: {refused}");
    }
    for format in meshio::Format::ALL {
        let main = format.suffixes()[0];
        assert!(mesh.contains(&format!(".{main}")), "{main} is not among the outputs of `squinch mesh`");
        if let Some(reading) = format.reading() {
            let suffix = format!(".{}", reading.suffix);
            assert!(convert.contains(&suffix) && check.contains(&suffix), "{suffix} is not among the meshes read");
        }
    }
    for format in picture::Format::ALL {
        assert!(mesh.contains(&format!(".{}", format.name())), "{format:?} is not among the outputs");
    }
    let names = import::Format::ALL.map(|f| f.name()).join(", ");
    assert!(mesh.contains(&names), "--input-format names {names}");
    for format in import::Format::ALL {
        let suffix = format!(".{}", format.suffixes()[0]);
        assert!(mesh.contains(&suffix), "{suffix} is not among the drawings of `squinch mesh`");
    }
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).expect("a README");
    let bullet = |word: &str| {
        let from = readme.split_once(&format!("- **{word}**")).expect(word).1;
        from.split("\n- **").next().unwrap_or(from).to_lowercase()
    };
    let (reads, writes) = (bullet("Reads"), bullet("Writes"));
    import::Format::ALL.iter().for_each(|f| assert!(reads.contains(f.name()), "{f:?} is not in the README"));
    meshio::Format::ALL.iter().for_each(|f| assert!(writes.contains(f.name()), "{f:?} is not in the README"));
}

/// The commands that a help text shows.
fn shown_in(help: &str) -> Vec<Vec<String>> {
    let commands = help.lines().filter_map(|line| line.split_once("  squinch "));
    commands.map(|(_, command)| command.split(['>', '|']).next().unwrap_or(command)).map(words).collect()
}

fn words(command: &str) -> Vec<String> {
    command.split_whitespace().map(|word| word.trim_matches('\'').to_owned()).collect()
}

#[test]
fn commands_of_the_help_work_when_typed() {
    let bench = Bench::new("help-commands");
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples");
    let mut run = 0;
    for help in [printed(&bench.ends(0, &["-h"])), printed(&bench.ends(0, &["mesh", "-h"]))] {
        for command in shown_in(&help) {
            // Into a folder of the test, from the samples that the text names from the root.
            let placed = command.iter().map(|word| match word.strip_prefix("samples") {
                Some(rest) => format!("{}{rest}", samples.display()),
                None => word.clone(),
            });
            let placed: Vec<String> = placed.collect();
            let placed: Vec<&str> = placed.iter().map(String::as_str).collect();
            let code = bench.run(&placed).status.code();
            assert_eq!(code, Some(0), "{command:?}");
            run += 1;
        }
    }
    assert!(run >= 10, "{run} commands");
}

#[test]
fn outputs_are_checked_before_meshing() {
    let bench = Bench::new("outputs-first");
    // An input that would take long, or fail otherwise: it is not even read.
    fs::write(bench.0.join("broken.json"), "{").expect("written");
    fs::create_dir(bench.0.join("folder.vtu")).expect("a folder");
    for (code, outputs) in [
        (6, vec!["-o", "nowhere/x.vtu"]),
        (6, vec!["-o", "folder.vtu"]),
        (6, vec!["-o", "x.vtu", "--report", "nowhere/x.json"]),
        (6, vec!["-o", "x.vtu", "--case", "nowhere/x.case"]),
        (2, vec!["-o", "x.unknown"]),
        (2, vec!["-o", "x"]),
        (2, vec!["-o", "x.su2", "--order", "2"]),
    ] {
        let output = bench.ends(code, &[&["mesh", "broken.json"], outputs.as_slice()].concat());
        assert!(!said(&output).contains("broken.json"), "{}", said(&output));
    }
    bench.ends(6, &["convert", "nothing.vtu", "nowhere/x.msh"]);
    bench.ends(2, &["convert", "nothing.vtu", "x.unknown"]);
    bench.ends(6, &["draw", "broken.json", "-o", "nowhere/x.png"]);
    bench.ends(2, &["batch", "square.poly", "--out-dir", "out", "--format", "vtu,su2", "--order", "2"]);
    bench.ends(6, &["batch", "square.poly", "--out-dir", "square.poly/out", "--format", "vtu"]);
    if cfg!(target_os = "linux") {
        let output = bench.ends(6, &["mesh", "broken.json", "-o", "/proc/x.vtu"]);
        assert!(said(&output).contains("/proc/x.vtu"), "{}", said(&output));
    }
    assert_eq!(bench.made(), ["broken.json", "folder.vtu"]);
}

#[test]
fn a_batch_resumes_only_as_it_wrote() {
    let bench = Bench::new("resumed-writing");
    let batch = ["batch", "square.poly", "--out-dir", "out", "--format", "vtu"];
    bench.ends(0, &[&batch[..], &["--plain"]].concat());
    assert!(!bench.text("out/square.vtu").contains("FieldData"));
    bench.ends(0, &[&batch[..], &["--plain", "--resume"]].concat());
    bench.ends(2, &[&batch[..], &["--resume"]].concat());
}

#[test]
fn options_of_writing_reach_mesh_and_convert() {
    let bench = Bench::new("writing");
    bench.ends(0, &["mesh", "lens.json", "-o", "lens.vtk", "--format", "vtk-text", "--lines", "on"]);
    assert!(bench.text("lens.vtk").contains("\nASCII\n") && bench.text("lens.vtk").contains("\n2 "));
    bench.ends(0, &["convert", "lens.vtk", "lens.vtu", "--plain"]);
    assert!(!bench.text("lens.vtu").contains("FieldData"));
    bench.ends(0, &["convert", "lens.vtk", "lens.xdmf", "--xdmf", "single"]);
    assert!(bench.text("lens.xdmf").contains("\"Mixed\""));
    bench.ends(0, &["mesh", "lens.json", "-o", "lens.obj", "--lines", "off"]);
    assert!(!bench.text("lens.obj").contains("\nl "));
    // An OBJ calls its materials by their file; standard output has none.
    assert!(bench.text("lens.obj").contains("\nmtllib lens.mtl\n") && bench.text("lens.mtl").contains("newmtl "));
    let output = bench.ends(0, &["convert", "lens.vtk", "-", "--format", "obj"]);
    assert!(printed(&output).contains("\nf ") && !printed(&output).contains("mtl"));
    assert!(said(&output).contains("colours: "), "{}", said(&output));
    bench.ends(2, &["mesh", "lens.json", "-o", "a.obj", "--report", "a.mtl"]);
    bench.ends(0, &["convert", "lens.obj", "again.vtu"]);
    for verb in [&["mesh", "lens.json", "-o", "l.png"][..], &["convert", "lens.vtk", "l.png"]] {
        let output = bench.ends(2, &[verb, &["--colour", "layer"]].concat());
        assert!(said(&output).contains("--colour region"), "{}", said(&output));
    }
    // Pictures of runs as of `draw`.
    bench.ends(0, &["mesh", "lens.json", "-o", "all.svg"]);
    bench.ends(0, &["mesh", "lens.json", "-o", "part.svg", "--view", "-0.5,-0.2,0.5,0.2", "--colour", "region"]);
    assert!(bench.text("all.svg") != bench.text("part.svg"));
    bench.ends(2, &["mesh", "lens.json", "-o", "part.svg", "--view", "1,1,0,0"]);
    let output =
        bench.ends(0, &["mesh", "lens.json", "-o", "lens.msh", "--plain", "--xdmf", "single", "--lines", "on"]);
    for told in ["--plain: only for VTU", "--xdmf: only for XDMF", "--lines: only for glTF"] {
        assert!(said(&output).contains(told), "{}", said(&output));
    }
    assert!(!said(&bench.ends(0, &["mesh", "lens.json", "-o", "lens.vtu", "--plain"])).contains("only for"));
}

#[test]
#[cfg(target_os = "linux")]
fn on_a_terminal_a_batch_shows_what_failed_and_no_lines() {
    let bench = Bench::new("terminal");
    let program = env!("CARGO_BIN_EXE_squinch");
    let batch = format!("{program} batch square.poly open.json none.json --out-dir out --format vtu");
    // util-linux' `script` gives the command a terminal.
    let mut script = Command::new("script");
    script.current_dir(&bench.0).args(["-qec", &batch, "/dev/null"]).env("NO_COLOR", "1").stdin(Stdio::null());
    let Ok(output) = script.output() else { return };
    let shown = printed(&output);
    assert!(!shown.contains("\"exit\""), "{shown}");
    assert!(shown.contains("error: open.json: ") && shown.contains("help: "), "{shown}");
    assert!(shown.contains("error: none.json: No such file"), "{shown}");
    assert!(!shown.contains("error: square.poly"), "{shown}");
    // Piped, it is the other way round.
    let output = bench.ends(1, &["batch", "square.poly", "open.json", "--out-dir", "out", "--format", "vtu"]);
    assert_eq!(lines_of(&output).len(), 2);
    assert!(!said(&output).contains("error"), "{}", said(&output));
}
