//! `inspect` and `draw`.

use super::*;

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
fn inspect_writes_a_drawing_as_an_outline_that_meshes_alike() {
    let bench = Bench::new("inspect-outline");
    let samples = concat!(env!("CARGO_MANIFEST_DIR"), "/samples");
    for name in ["bracket.dxf", "transition.json"] {
        let sample = format!("{samples}/{name}");
        bench.ends(0, &["inspect", &sample, "--outline", "again.json"]);
        let area = |file: &str, report: &str| {
            bench.ends(0, &["mesh", file, "-o", "a.vtu", "--report", report, "--edge-turning", "30"]);
            let text = fs::read_to_string(bench.0.join(report)).unwrap();
            let report: serde_json::Value = serde_json::from_str(&text).unwrap();
            (report["quality"]["exact_measure"].as_f64().unwrap(), report["input"]["curves"].clone())
        };
        assert_eq!(area(&sample, "one.json"), area("again.json", "two.json"), "{name}");
    }
    bench.ends(6, &["inspect", "lens.json", "--outline", "no/such/folder.json"]);
}
