//! Slivers, hair gaps and near misses: what is welded, what is left, and how it is told.

use super::*;

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

/// A plate with a near-miss of every kind, each below the default tolerances (5e-9, and 5e-6 for ends that meet
/// nothing): and a notch drawn twice, which is no miss.
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
