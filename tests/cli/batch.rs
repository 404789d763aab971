//! `batch`: one line an input, shards, resuming.

use super::*;

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
    assert!(said(&output).contains("3  done, every guarantee holds (0)"), "{}", said(&output));
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
    assert!(said(&output).contains("3 inputs, 1 of them in an earlier run"), "{}", said(&output));
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
