//! `verify` and `convert`: meshes of ours, and what other programs make of them.

use super::*;

#[test]
fn a_mesh_of_ours_is_checked_by_what_it_was_asked_for() {
    let bench = Bench::new("check");
    bench.ends(0, &["mesh", "lens.json", "-o", "a.vtu", "--min-angle", "15", "--max-edge", "0.5"]);
    bench.ends(0, &["check", "a.vtu"]);
    let output = bench.ends(0, &["check", "a.vtu", "--against", "lens.json", "--report", "r.json"]);
    assert!(said(&output).contains("every guarantee holds"), "{}", said(&output));
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
fn a_mesh_that_another_program_rewrote_is_verified_by_where_its_nodes_lie() {
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
