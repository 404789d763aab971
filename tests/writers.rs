//! Every format of meshes, from the list of formats itself: a new one is written, read back, and held to what its
//! `losses` say. What is not told as lost comes back.

mod strip;

use squinch::geometry::Frame;
use squinch::ids::VertexId;
use squinch::mesh::Mesh;
use squinch::meshio::{Format, MeshFile, WriteOptions, XdmfGrids, encode};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Stdio};
use strip::{ODD, PLAIN, around, around_with, counts, read_back, second_order, shape, strip};

/// Whether a format reports the loss of this.
fn loses(format: Format, mesh: &Mesh, what: &str) -> bool {
    format.losses(mesh, &WriteOptions::default()).iter().any(|loss| loss.starts_with(what))
}

/// The formats of meshes in a plane.
fn planar() -> impl Iterator<Item = Format> {
    Format::ALL.into_iter().filter(|format| format.holds_planes())
}

/// The strip with the edges of its rim only.
fn rim(mesh: &Mesh, names: [&str; 5]) -> Mesh {
    let edges = mesh.edges.iter().filter(|e| mesh.names.text(e.name) != names[4]).copied().collect();
    Mesh { edges, ..mesh.clone() }
}

/// Names with their numbers of cells, as a format that tells names apart by fewer letters has them.
fn spelt(format: Format, names: BTreeMap<String, usize>) -> BTreeMap<String, usize> {
    if !matches!(format, Format::Msh | Format::Msh22) {
        return names;
    }
    // Without regard to case `Wand` and `wand` are one: the second is told apart.
    let apart = |name: &str| {
        if names.contains_key("Wand") && name == "wand" { "wand_2".into() } else { name.replace('"', "'") }
    };
    names.iter().map(|(name, &n)| (apart(name), n)).collect()
}

#[test]
fn what_is_not_told_as_lost_comes_back() {
    for names in [PLAIN, ODD] {
        let mesh = strip(5, names);
        for format in read_back() {
            let MeshFile { mesh: back, notes, .. } = around(&mesh, format);
            assert_eq!(notes, [""; 0], "{format:?}");
            let kept = match format {
                _ if loses(format, &mesh, "boundaries:") => Mesh { edges: Vec::new(), ..mesh.clone() },
                _ if loses(format, &mesh, "names of interfaces") => rim(&mesh, names),
                _ => mesh.clone(),
            };
            let (mut regions, boundaries) = counts(&kept);
            if loses(format, &mesh, "regions") {
                regions = [("region".to_owned(), mesh.triangles.len())].into();
            }
            assert_eq!(counts(&back), (spelt(format, regions), spelt(format, boundaries)), "{format:?}");
            assert_eq!(shape(&back), shape(&kept), "{format:?}");
            if format != Format::Stl {
                assert_eq!(back.nodes, mesh.nodes, "{format:?} keeps the order of nodes");
            }
            assert_eq!(back.unit.is_none(), loses(format, &mesh, "the unit"), "{format:?}: {:?}", back.unit);
        }
    }
}

#[test]
fn second_order_comes_back_is_cut_or_is_refused() {
    let mesh = second_order(strip(4, PLAIN));
    for format in planar() {
        let written = encode(&mesh, &[], format, &WriteOptions::default());
        if let Err(refused) = written {
            assert_eq!(refused.kind(), ErrorKind::Unsupported, "{format:?}");
            assert!(refused.to_string().contains("--order 1"), "{format:?}: {refused}");
            assert!(format.holds_order(2).is_err());
            continue;
        }
        assert!(format.holds_order(2).is_ok(), "{format:?}");
        if format.reading().is_none() {
            continue;
        }
        let back = around(&mesh, format).mesh;
        if loses(format, &mesh, "order 2: each") {
            assert_eq!(back.triangles.len(), 4 * mesh.triangles.len(), "{format:?}");
            let halves = if loses(format, &mesh, "boundaries:") { 0 } else { 2 * mesh.edges.len() };
            assert_eq!(back.edges.len(), halves, "{format:?}");
        } else {
            assert_eq!(back.order(), 2, "{format:?}");
            assert_eq!((counts(&back), shape(&back)), (counts(&mesh), shape(&mesh)), "{format:?}");
        }
    }
}

#[test]
fn a_mesh_in_space_comes_back_where_it_was_or_is_told_to_be_flat() {
    let frame = Frame { origin: [3.0, -1.0, 2.0], x: [0.0, 1.0, 0.0], y: [0.0, 0.0, 1.0] };
    let mesh = Mesh { frame: Some(frame), ..strip(3, PLAIN) };
    for format in read_back() {
        let back = around(&mesh, format).mesh;
        if loses(format, &mesh, "the plane in space") {
            assert_eq!(back.nodes, mesh.nodes, "{format:?}: the plane's own coordinates");
            continue;
        }
        let near = |p: [f64; 3]| mesh.places().any(|q| (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9));
        assert!(back.places().all(near), "{format:?}");
        assert_eq!(counts(&back).0, counts(&mesh).0, "{format:?}");
    }
}

#[test]
fn the_same_mesh_gives_the_same_bytes() {
    let plain = WriteOptions::default;
    let ways = [
        plain(),
        WriteOptions { plain: true, ..plain() },
        WriteOptions { lines: Some(true), ..plain() },
        WriteOptions { lines: Some(false), interior_lines: false, ..plain() },
        WriteOptions { xdmf: XdmfGrids::Single, stem: None, ..plain() },
    ];
    let stamps = [("made".to_owned(), "by hand".to_owned())];
    for make in [|| strip(4, ODD), || second_order(strip(4, ODD))] {
        for (format, options) in planar().flat_map(|format| ways.iter().map(move |way| (format, way))) {
            let write = || encode(&make(), &stamps, format, options).map_err(|error| error.to_string());
            assert_eq!(write(), write(), "{format:?}, {options:?}");
        }
    }
}

#[test]
fn empty_meshes_are_whole_files_or_refused() {
    for format in planar() {
        match encode(&Mesh::default(), &[], format, &WriteOptions::default()) {
            Err(refused) => assert_eq!(refused.kind(), ErrorKind::Unsupported, "{format:?}"),
            Ok(_) if format.reading().is_none() => {}
            Ok(_) => assert!(around(&Mesh::default(), format).mesh.triangles.is_empty(), "{format:?}"),
        }
    }
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let right = strip(2, PLAIN);
    let wrong = [
        Mesh { triangle_regions: Vec::new().into(), ..right.clone() },
        Mesh { regions: Vec::new().into(), ..right.clone() },
        Mesh { nodes: Vec::new().into(), ..right.clone() },
        Mesh { edge_mids: vec![VertexId(0)], ..right.clone() },
    ];
    for format in planar() {
        for mesh in &wrong {
            let error = encode(mesh, &[], format, &WriteOptions::default()).expect_err("no mesh");
            assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput, "{format:?}");
        }
    }
}

#[test]
fn boundaries_within_can_be_left_out_of_every_format() {
    for (mesh, first) in [(strip(3, PLAIN), true), (second_order(strip(3, PLAIN)), false)] {
        let rim = WriteOptions { interior_lines: false, ..WriteOptions::default() };
        for format in read_back().filter(|f| first || f.holds_order(2).is_ok()) {
            let (mut wanted, back) = (counts(&around(&mesh, format).mesh), around_with(&mesh, format, &rim).mesh);
            wanted.1.remove("interface");
            assert_eq!(counts(&back), wanted, "{format:?}");
            let told = format.losses(&mesh, &rim).iter().any(|loss| loss.contains("--interior-lines off"));
            // Where there are none anyway, nothing is left out.
            let none = loses(format, &mesh, "boundaries:") || loses(format, &mesh, "names of interfaces");
            assert_eq!(told, !none, "{format:?}");
        }
    }
}

#[test]
fn a_path_that_cannot_be_written_is_6_and_leaves_nothing() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("writers-unwritable");
    let _ = std::fs::remove_dir_all(&folder); // left by an earlier run, if at all
    std::fs::create_dir_all(&folder).expect("a folder to work in");
    for format in planar() {
        let to = format!("missing/a.{}", format.suffixes()[0]);
        let input = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/wedges/wedge_20.poly");
        let output = Command::new(env!("CARGO_BIN_EXE_squinch"))
            .current_dir(&folder)
            .args(["mesh", input, "-o", &to, "--format", format.name()])
            .stdin(Stdio::null())
            .output()
            .expect("squinch starts");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(6), "{format:?}: {said}");
        assert!(said.contains("missing"), "{format:?}: the place is not named: {said}");
    }
    assert_eq!(std::fs::read_dir(&folder).expect("the folder").count(), 0, "something was left");
}
