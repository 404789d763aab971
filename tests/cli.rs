//! The contract of the command line, kept by the program itself: exit codes, files, reports.

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
fn help_and_version_answer() {
    let bench = Bench::new("help");
    assert_eq!(printed(&bench.ends(0, &["--version"])), format!("squinch {}\n", env!("CARGO_PKG_VERSION")));
    let help = printed(&bench.ends(0, &["--help"]));
    for word in ["mesh", "check", "inspect", "draw", "replay", "reduce", "Exit codes", "130"] {
        assert!(help.contains(word), "{word}\n{help}");
    }
    for verb in ["mesh", "check", "inspect", "draw", "replay", "reduce"] {
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
        vec!["mesh", "-", "-o", "a.vtu"],
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
    for option in ["--size=field.txt", "--engine=gcdr", "--order=2", "--seed=1"] {
        let output = bench.ends(2, &["mesh", "square.poly", "-o", "a.vtu", option]);
        assert!(said(&output).contains("not in this version"), "{option}: {}", said(&output));
    }
    for verb in ["convert", "batch"] {
        assert!(said(&bench.ends(2, &[verb, "square.poly"])).contains("not in this version"), "{verb}");
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
    assert_eq!(names, ["black", "red"]);
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
        &["mesh", "square.poly", "-o", "a.vtu", "--max-area", "1e-6", "--max-vertices", "50", "--report", "r.json"],
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
        .command(&["mesh", "square.poly", "-o", "a.vtu", "--max-area", "1e-9"])
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
