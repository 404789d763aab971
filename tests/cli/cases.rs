//! Cases: replayed and reduced.

use super::*;

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
