//! Time, vertices and interrupts: what ends a run early.

use super::*;

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
fn a_mesh_that_is_there_when_the_time_ends_is_verified_and_written() {
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
