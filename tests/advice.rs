//! Whatever the program suggests works when typed: options in messages, helps and notes, examples in the help, commands
//! in the README. Notes about an input appear at the end of a run, in its report, and in the lines of a batch.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const VERBS: [&str; 9] = ["mesh", "check", "batch", "convert", "schema", "inspect", "draw", "replay", "reduce"];

/// A folder of its own for one test.
struct Bench(PathBuf);

impl Bench {
    fn new(name: &str, files: &[(&str, &str)]) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("advice-{name}"));
        let _ = fs::remove_dir_all(&folder); // left by an earlier run, if at all
        fs::create_dir_all(&folder).expect("a folder to work in");
        files.iter().for_each(|(file, text)| fs::write(folder.join(file), text).expect("an input is written"));
        Self(folder)
    }

    fn run<S: AsRef<str>>(&self, arguments: &[S]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_squinch"));
        command.current_dir(&self.0).args(arguments.iter().map(AsRef::as_ref));
        command.env("NO_COLOR", "1").stdin(Stdio::null()).output().expect("squinch starts")
    }

    /// What a run says, all blanks being one, its exit code held to.
    fn said<S: AsRef<str>>(&self, arguments: &[S], exit: i32) -> String {
        let output = self.run(arguments);
        let shown: Vec<&str> = arguments.iter().map(AsRef::as_ref).collect();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(exit), "squinch {}\n{said}", shown.join(" "));
        said.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Runs a line, takes `option` with its value from what is said, types it in the place of what stood there, and
    /// runs that: the line that was typed in the end, and what was said then.
    fn follow(&self, line: &str, exit: i32, option: &str) -> (Vec<String>, String) {
        let arguments = words(line);
        let said = self.said(&arguments, exit);
        let advice = advised(&said, option);
        let mut typed = arguments;
        if let Some(at) = typed.iter().position(|word| word == option) {
            typed.drain(at..at + advice.len());
        }
        typed.extend(advice);
        let then = self.said(&typed, 0);
        (typed, then)
    }

    fn area(&self) -> f64 {
        let text = fs::read_to_string(self.0.join("r.json")).expect("a report");
        let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        report["quality"]["exact_measure"].as_f64().expect("an area")
    }
}

/// The first word of a line as a shell tells them apart, between blanks or quotes, and what follows.
fn word(line: &str) -> (String, &str) {
    let (word, rest) = match line.strip_prefix('\'') {
        Some(quoted) => quoted.split_once('\'').expect("a quote ends"),
        None => line.split_once(' ').unwrap_or((line, "")),
    };
    (word.to_owned(), rest.trim_start())
}

fn words(line: &str) -> Vec<String> {
    let (mut words, mut rest) = (Vec::new(), line);
    while !rest.is_empty() {
        let (next, after) = word(rest);
        words.push(next);
        rest = after;
    }
    words
}

/// An option as a message suggests it, with its value where it takes one: the first of several, as in `--format: vtu,
/// vtk`.
fn advised(said: &str, option: &str) -> Vec<String> {
    let named = |end: &str| said.rfind(&format!("{option}{end}"));
    let at = named(" ").or_else(|| named(":")).unwrap_or_else(|| panic!("{option} is not suggested in: {said}"));
    let (_, rest) = word(&said[at..]);
    let value = word(rest).0.trim_end_matches([',', ';', ':', '.', ')']).to_owned();
    if FLAGS.contains(&option) { vec![option.into()] } else { vec![option.into(), value] }
}

/// Options without a value.
const FLAGS: [&str; 2] = ["--flatten-z", "--plain"];

/// A square of side 10 of which one corner misses closing by 0.03, and a bore.
const GAP: &str = r#"{ "squinch": 1, "curves": [
    { "line": [[0, 0], [10, 0]] }, { "line": [[10, 0], [10, 10]] }, { "line": [[10, 10], [0, 10]] },
    { "line": [[0, 10], [0, 0.03]] }, { "circle": { "center": [5, 5], "radius": 1 } } ] }"#;
/// A square with an open line in it.
const CRACK: &str = r#"{ "squinch": 1, "curves": [
    { "line": [[0, 0], [10, 0]] }, { "line": [[10, 0], [10, 10]] }, { "line": [[10, 10], [0, 10]] },
    { "line": [[0, 10], [0, 0]] }, { "line": [[3, 5], [7, 5]] } ] }"#;
const SQUARE: &str = "4 2 0 0\n1 0 0\n2 10 0\n3 10 10\n4 0 10\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n";

fn rectangle(layer: &str, [x0, y0, x1, y1]: [f64; 4]) -> String {
    format!(
        "0\nLWPOLYLINE\n8\n{layer}\n70\n1\n10\n{x0}\n20\n{y0}\n10\n{x1}\n20\n{y0}\n10\n{x1}\n20\n{y1}\n10\n{x0}\n20\n{y1}\n"
    )
}

fn circle(layer: &str, [x, y, r]: [f64; 3]) -> String {
    format!("0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{r}\n")
}

fn line(layer: &str, kind: &str, [x0, y0, z0]: [f64; 3], [x1, y1, z1]: [f64; 3]) -> String {
    format!("0\nLINE\n8\n{layer}\n6\n{kind}\n10\n{x0}\n20\n{y0}\n30\n{z0}\n11\n{x1}\n21\n{y1}\n31\n{z1}\n")
}

fn dxf(entities: &[String]) -> String {
    format!("0\nSECTION\n2\nENTITIES\n{}0\nENDSEC\n0\nEOF\n", entities.concat())
}

/// Every text in quotes of a source, comments left out but for those that are helps of options.
fn texts(source: &str) -> Vec<String> {
    let (mut texts, mut rest) = (Vec::new(), source);
    while let Some(at) = rest.find(['"', '/', '\'']) {
        rest = &rest[at..];
        if rest.starts_with("//") {
            let end = rest.find('\n').unwrap_or(rest.len());
            if rest.starts_with("///") {
                texts.push(rest[..end].to_owned());
            }
            rest = &rest[end..];
        } else if let Some(body) = rest.strip_prefix('"') {
            let mut escaped = false;
            let end = body.find(|c| {
                let ends = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                ends
            });
            let end = end.expect("a text ends");
            texts.push(body[..end].to_owned());
            rest = &body[end + 1..];
        } else {
            // A quote or a slash as a character, else a lifetime or a division.
            let quoted = ["'\"'", "'\\''", "'/'", "'\\\\'"].iter().find(|quoted| rest.starts_with(**quoted));
            rest = &rest[quoted.map_or(1, |quoted| quoted.len())..];
        }
    }
    texts
}

/// Every `--option` in a text.
fn options_in(text: &str) -> Vec<String> {
    let mut options = Vec::new();
    for (at, _) in text.match_indices("--") {
        let of_a_word = text[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '-');
        let rest = &text[at + 2..];
        let end = rest.find(|c: char| !c.is_ascii_lowercase() && !c.is_ascii_digit() && c != '-').unwrap_or(rest.len());
        if !of_a_word && rest.starts_with(|c: char| c.is_ascii_lowercase()) {
            options.push(format!("--{}", &rest[..end]));
        }
    }
    options
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder of sources").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}

#[test]
fn every_option_named_is_an_option() {
    let bench = Bench::new("named", &[]);
    let mut known: BTreeSet<String> = BTreeSet::new();
    for verb in VERBS {
        let help = String::from_utf8(bench.run(&[verb, "--help"]).stdout).expect("text");
        let listed = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
        known.extend(listed.flat_map(|line| options_in(line).into_iter().take(1)));
    }
    assert!(known.len() > 50, "{known:?}");
    // Options of cargo, what clap adds, and those of which is said that they are not there yet.
    known.extend(["--locked", "--features", "--path", "--version", "--radius-edge", "--max-volume"].map(str::to_owned));
    let src = sources(&Path::new(ROOT).join("src"));
    for path in src.iter().filter(|path| path.extension().is_some_and(|suffix| suffix == "rs")) {
        for text in texts(&fs::read_to_string(path).expect("a source")) {
            let unknown: Vec<String> = options_in(&text).into_iter().filter(|o| !known.contains(o)).collect();
            assert!(unknown.is_empty(), "{}: {unknown:?} in {text:?}", path.display());
        }
    }
}

#[test]
fn outlines_that_miss_closing() {
    let beyond =
        GAP.replace("[10, 0]] }, {", "[12, 0]] }, {").replace("[[10, 0],", "[[10, 0.01],").replace("0.03", "0");
    let bench = Bench::new("closing", &[("gap.json", GAP), ("beyond.json", &beyond), ("crack.json", CRACK)]);
    bench.said(&words("draw gap.json --stage drawing -o gap.svg"), 0);
    bench.said(&words("draw gap.json --stage drawing -o gap.png"), 0);
    let bored = 100.0 - std::f64::consts::PI;
    bench.follow("mesh gap.json -o o.vtu --report r.json", 4, "--close");
    assert!((bench.area() - bored).abs() < 1e-9);
    for choice in ["--loose keep", "--loose drop"] {
        let said = bench.said(&words("mesh gap.json -o o.vtu"), 4);
        assert!(said.contains(choice), "{said}");
        bench.said(&words(&format!("mesh gap.json -o o.vtu --report r.json {choice}")), 0);
        assert!((bench.area() - std::f64::consts::PI).abs() < 1e-9, "{choice}");
    }
    // The lower side goes on beyond the corner, which the right side stops short of.
    bench.follow("mesh beyond.json -o o.vtu --report r.json", 4, "--close");
    assert!((bench.area() - bored).abs() < 1e-9);
    let (_, then) = bench.follow("mesh crack.json -o o.vtu", 0, "--loose");
    assert!(then.contains("they were left out"), "{then}");
    let (typed, _) = bench.follow("mesh crack.json -o o.vtu --loose error", 4, "--loose");
    assert!(typed.ends_with(&words("--loose keep")), "{typed:?}");
}

#[test]
fn what_leaves_the_plane() {
    let side = |a, b| line("0", "CONTINUOUS", a, b);
    let sides = [
        side([0.0, 0.0, 0.0], [10.0, 0.0, 0.0]),
        side([10.0, 0.0, 0.0], [10.0, 10.0, 2.0]),
        side([10.0, 10.0, 0.0], [0.0, 10.0, 0.0]),
        side([0.0, 10.0, 0.0], [0.0, 0.0, 0.0]),
        circle("0", [5.0, 5.0, 1.0]),
    ];
    let bench = Bench::new("plane", &[("tilted.dxf", &dxf(&sides))]);
    bench.follow("mesh tilted.dxf -o o.vtu --report r.json", 4, "--flatten-z");
    assert!((bench.area() - (100.0 - std::f64::consts::PI)).abs() < 1e-9);
}

#[test]
fn layers_that_are_no_part() {
    let part = [rectangle("PART", [0.0, 0.0, 40.0, 30.0]), circle("PART", [20.0, 15.0, 5.0])];
    let framed = dxf(&[&[rectangle("Title frame", [-10.0, -10.0, 50.0, 40.0])][..], &part].concat());
    let disk = [circle("0", [0.0, 0.0, 40.0]), circle("AXES", [0.0, 0.0, 30.0]), circle("0", [30.0, 0.0, 4.0])];
    let centred = dxf(&[&part[..], &[line("AXES", "CENTER", [-5.0, 15.0, 0.0], [45.0, 15.0, 0.0])]].concat());
    let files = [("framed.dxf", &*framed), ("disk.dxf", &dxf(&disk)), ("centred.dxf", &centred)];
    let bench = Bench::new("layers", &files);
    let (typed, then) = bench.follow("mesh framed.dxf -o o.vtu --report r.json", 0, "--skip-layers");
    assert!(typed.ends_with(&["--skip-layers".into(), "Title frame".into()]), "{typed:?}");
    assert!(!then.contains("drawing frame"), "{then}");
    assert!((bench.area() - (1200.0 - 25.0 * std::f64::consts::PI)).abs() < 1e-9);
    let (_, then) = bench.follow("mesh disk.dxf -o o.vtu --report r.json", 0, "--skip-layers");
    assert!(!then.contains("cross"), "{then}");
    assert!((bench.area() - (1600.0 - 16.0) * std::f64::consts::PI).abs() < 1e-9);
    let (_, then) = bench.follow("mesh centred.dxf -o o.vtu", 0, "--line-types");
    assert!(!then.contains("line type") && then.contains("1 line is open"), "{then}");
}

#[test]
fn what_takes_too_much() {
    let slot = |y: f64| {
        let gap = r#"{ "line": [[3, 5], [7, 5]] }"#;
        CRACK.replace(gap, &format!(r#"{gap}, {{ "line": [[3, {y}], [7, {y}]] }}"#))
    };
    let strip = r#"{ "squinch": 1, "curves": [ { "line": [[0, 0], [1, 0]] }, { "line": [[1, 0], [1, 1e-5]] },
        { "line": [[1, 1e-5], [0, 1e-5]] }, { "line": [[0, 1e-5], [0, 0]] } ] }"#;
    let bench = Bench::new("much", &[("slot.json", &slot(5.0001)), ("strip.json", strip), ("square.poly", SQUARE)]);
    bench.follow("mesh slot.json -o o.vtu --max-vertices 2000 --tolerance 0", 5, "--tolerance");
    bench.follow("mesh strip.json -o o.vtu --max-vertices 20000", 5, "--min-angle");
    let said = bench.said(&words("mesh square.poly -o o.vtu --max-edge 0.01 --max-vertices 1000"), 5);
    assert!(said.contains("--max-vertices"), "{said}");
    let said = bench.said(&words("mesh square.poly -o o.vtu --min-edge 2 --max-edge 1"), 2);
    assert!(said.contains("more than --max-edge"), "{said}");
}

#[test]
fn angles_that_cannot_be_had() {
    let bench = Bench::new("angles", &[("crack.json", CRACK)]);
    let said = bench.said(&words("mesh crack.json -o o.vtu --min-angle 40"), 5);
    let angle = advised(&said, "--min-angle")[1].clone();
    bench.said(&["mesh", "crack.json", "-o", "o.vtu", "--min-angle", &angle], 0);
}

#[test]
fn formats_and_what_they_hold() {
    let framed = dxf(&[rectangle("PART", [0.0, 0.0, 4.0, 3.0])]);
    let bench = Bench::new("formats", &[("square.poly", SQUARE), ("drawing.svg", &framed), ("blob", &"z ".repeat(9))]);
    bench.follow("mesh drawing.svg -o o.vtu", 3, "--input-format");
    let said = bench.said(&words("mesh blob -o o.vtu"), 3);
    for format in said.split_once("--input-format: ").expect("advice").1.split(", ") {
        let said = bench.said(&["mesh", "blob", "-o", "o.vtu", "--input-format", format], 3);
        assert!(!said.contains("one of"), "{format}: {said}");
    }
    bench.follow("mesh square.poly -o o.su2 --order 2", 2, "--order");
    let (_, then) = bench.follow("mesh square.poly -o o.obj --lines off -v", 0, "--lines");
    assert!(!then.contains("boundaries: --lines on"), "{then}");
    let said = bench.said(&words("mesh square.poly -o o.foo"), 2);
    for format in said.split_once("--format: ").expect("advice").1.split(", ") {
        let of_solids = ["tetgen", "medit"].contains(&format);
        bench.said(&["mesh", "square.poly", "-o", "o.foo", "--format", format], if of_solids { 2 } else { 0 });
    }
    let (typed, _) = bench.follow("draw square.poly -o o.png --colour layer --stage mesh", 2, "--stage");
    assert!(typed.ends_with(&words("--stage drawing")), "{typed:?}");
    bench.said(&words("mesh square.poly -o o.vtu"), 0);
    bench.follow("draw o.vtu -o o.png --colour layer", 2, "--colour");
}

#[test]
fn strokes_and_tails() {
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40"><rect width="20" height="20"/>
        <path d="M25 5H35V15H25Z" fill="none" stroke="red"/></svg>"#;
    let bench = Bench::new("strokes", &[("mixed.svg", svg)]);
    let (_, then) = bench.follow("mesh mixed.svg -o o.vtu", 0, "--strokes");
    assert!(!then.contains("stroke only") && then.contains("8 lines"), "{then}");
}

/// A wedge-shaped section from its tail around its nose, every coordinate times `scale`, below some lines.
fn section(head: &str, scale: f64) -> String {
    let points = [[1.0, 0.001], [0.5, 0.05], [0.1, 0.04], [0.0, 0.0], [0.1, -0.04], [0.5, -0.05], [1.0, -0.001]];
    head.to_owned() + &points.map(|[x, y]| format!("{} {}\n", x * scale, y * scale)).concat()
}

#[test]
fn what_is_noticed_is_told_in_runs_reports_and_batches() {
    let part = [rectangle("PART", [0.0, 0.0, 40.0, 30.0]), circle("PART", [20.0, 15.0, 5.0])];
    let framed = dxf(&[&[rectangle("FRAME", [-10.0, -10.0, 50.0, 40.0])][..], &part].concat());
    let twice = dxf(&[&part[..], &part].concat());
    let masked = r##"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40"><mask id="m"><circle r="9"/></mask>
        <rect width="20" height="20" mask="url(#m)"/></svg>"##;
    let kinds: [(&str, &str, &str); 8] = [
        ("percent.dat", &section("percent\n", 100.0), "percent"),
        ("header.dat", &section("header\n1 0.12\n", 1.0), "passed over"),
        ("crack.json", CRACK, "1 line is open"),
        ("framed.dxf", &framed, "drawing frame"),
        ("twice.dxf", &twice, "curves are drawn twice"),
        ("masked.svg", masked, "masks are not applied"),
        ("unit.dxf", &dxf(&part), "The file names no unit"),
        ("named.dxf", &dxf(&part), "--skip-layers FRMAE"),
    ];
    let bench = Bench::new("notes", &kinds.map(|(file, text, _)| (file, text)));
    let lines = bench.run(&words("batch . --out-dir out --format vtu --skip-layers FRMAE")).stdout;
    let lines = String::from_utf8(lines).expect("text");
    for (file, _, note) in kinds {
        let line = lines.lines().find(|line| line.contains(file)).unwrap_or_else(|| panic!("{file} in {lines}"));
        let line: serde_json::Value = serde_json::from_str(line).expect("JSON");
        assert!(line["exit"] == 0 && line["notes"].to_string().contains(note), "{line}");
        if note.starts_with("--") {
            continue; // alone, a run refuses it
        }
        let said = bench.said(&["mesh", file, "-o", "o.vtu", "--report", "r.json"], 0);
        let report = fs::read_to_string(bench.0.join("r.json")).expect("a report");
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        assert!(report["input"]["notes"].to_string().contains(note), "{file}: {}", report["input"]["notes"]);
        assert!(said.contains(note), "{file}: {said}");
        let said = bench.said(&["mesh", file, "-o", "o.vtu", "--quiet"], 0);
        assert_eq!(said, "", "{file}");
    }
}

#[test]
fn a_run_tells_a_few_notes_and_all_where_asked_for() {
    // Six layers that cross a disk, each in a place of its own.
    let across = (0..6).map(|k| circle(&format!("L{k}"), [40.0 * f64::from(k), 0.0, 3.0]));
    let around = (0..6).map(|k| circle("0", [40.0 * f64::from(k) + 3.0, 0.0, 3.0]));
    let crossed = dxf(&across.chain(around).collect::<Vec<_>>());
    let bench = Bench::new("few", &[("crossed.dxf", &crossed)]);
    let said = bench.said(&words("mesh crossed.dxf -o o.vtu"), 0);
    assert!(said.matches("note ").count() == 4 && said.contains("notes more (-v lists them)"), "{said}");
    let said = bench.said(&words("mesh crossed.dxf -o o.vtu -v"), 0);
    assert!((0..6).all(|k| said.contains(&format!("layer L{k} cross"))) && !said.contains("notes more"), "{said}");
}

/// Lines of a text that call the program.
fn commands(text: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim);
    lines.filter(|line| line.starts_with("squinch ") && !line.contains("VERB")).map(str::to_owned).collect()
}

/// Runs lines in a shell, in a folder that has the samples, with the program on its path.
#[cfg(unix)]
fn typed(name: &str, lines: &[String]) {
    let bench = Bench::new(name, &[]);
    std::os::unix::fs::symlink(Path::new(ROOT).join("samples"), bench.0.join("samples")).expect("a link");
    let programs = bench.0.join("bin");
    fs::create_dir(&programs).expect("a folder");
    std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_squinch"), programs.join("squinch")).expect("a link");
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap_or_default());
    for line in lines {
        let mut shell = Command::new("sh");
        let output = shell.args(["-c", line]).current_dir(&bench.0).env("PATH", &path).output().expect("a shell");
        assert!(output.status.success(), "{line}\n{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[cfg(unix)]
#[test]
fn examples_of_the_help_run() {
    let bench = Bench::new("helps", &[]);
    let helps = [&["-h"][..], &["mesh", "-h"]].map(|arguments| String::from_utf8(bench.run(arguments).stdout).unwrap());
    let lines = commands(&helps.concat());
    assert!(lines.len() > 8, "{lines:?}");
    typed("examples", &lines);
}

#[cfg(unix)]
#[test]
fn commands_of_the_readme_run_as_printed() {
    let read = |name: &str| fs::read_to_string(Path::new(ROOT).join(name)).expect(name);
    let text = ["README.md", "docs/recipes.md", "docs/algorithms/gcdr.md"].map(read).concat();
    let blocks: Vec<&str> = text.split("```sh\n").skip(1).map(|rest| rest.split("```").next().unwrap_or("")).collect();
    let lines: Vec<&str> = blocks.iter().flat_map(|block| block.lines()).filter(|line| !line.is_empty()).collect();
    for line in &lines {
        let program = line.split(' ').next();
        assert!(matches!(program, Some("squinch" | "cargo" | "cp" | "ccx")), "not tried: {line}");
    }
    let lines = commands(&lines.join("\n"));
    assert!(lines.len() > 20, "{lines:?}");
    typed("readme", &lines);
}
