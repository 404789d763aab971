//! `mesh`: what is written, verified and reported, and how it ends.

use super::*;

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
fn a_mesh_is_written_verified_and_reported() {
    let bench = Bench::new("mesh");
    let output =
        bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "-o", "a.svg", "-o", "a.png", "--report", "r.json"]);
    for word in ["vertices", "angles", "every guarantee holds", "a.vtu"] {
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
fn triangles_left_alone_for_their_size_are_no_corners() {
    let bench = Bench::new("min-edge");
    // Two lines a hair apart make small angles that --min-edge leaves alone.
    let thin = "8 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n5 0.4 0.5\n6 0.6 0.5\n7 0.45 0.503\n8 0.55 0.503\n\
                6 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 5 6\n6 7 8\n0\n";
    fs::write(bench.0.join("thin.poly"), thin).unwrap();
    let output = bench.ends(0, &["mesh", "thin.poly", "-o", "a.vtu", "--min-edge", "0.3", "--edge-turning", "off"]);
    assert!(said(&output).contains("not refined because of --min-edge"), "{}", said(&output));
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
    assert!(said(&output).contains("not a positive length"), "{}", said(&output));
    assert!(!bench.has("b.vtu"));
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
