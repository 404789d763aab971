//! Files and streams: standard input and output, old files, closed pipes.

use super::*;

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
