//! Every writer, read back: names with their numbers of cells, coordinates bit for bit where the format has the digits,
//! order 2; and no bytes do harm to any reader.

use proptest::prelude::*;
use squinch::geometry::{Frame, Point};
use squinch::ids::{Colour, Id, NameId, RegionId, VertexId};
use squinch::import;
use squinch::mesh::{CurveEdge, Mesh};
use squinch::meshio::{Format, MeshFile, WriteOptions, XdmfGrids, encode, read};
use std::collections::BTreeMap;

/// Three regions (two of one name) in a strip of n × 2 squares, its rim and the line between the rows named; far from
/// the origin, with endless digits.
fn strip(n: u32, names: [&str; 5]) -> Mesh {
    let mut mesh = Mesh { unit: Some("mm".into()), ..Mesh::default() };
    for i in 0..=n {
        for j in 0..=2 {
            mesh.nodes.push(Point::new(1e5 + f64::from(i) / 3.0, f64::from(j) / 7.0 - 12.0));
        }
    }
    let [lower, upper, bottom, top, between] = names.map(|name| mesh.names.intern(name));
    mesh.regions = vec![lower, upper, lower].into();
    let node = |i: u32, j: u32| VertexId(3 * i + j);
    for i in 0..n {
        for j in 0..2 {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                mesh.triangles.push(triangle);
                mesh.triangle_regions.push(RegionId(if j == 1 {
                    1
                } else if i == 0 {
                    2
                } else {
                    0
                }));
            }
        }
        for (j, name) in [(0, bottom), (1, between), (2, top)] {
            mesh.edges.push(CurveEdge { nodes: [node(i, j), node(i + 1, j)], name, link: None });
        }
    }
    for i in [0, n] {
        for j in 0..2 {
            mesh.edges.push(CurveEdge { nodes: [node(i, j), node(i, j + 1)], name: bottom, link: None });
        }
    }
    mesh
}

/// The same with a node within every edge, a little off its middle.
fn second_order(mut mesh: Mesh) -> Mesh {
    let mut mids: BTreeMap<[VertexId; 2], VertexId> = BTreeMap::new();
    let mut nodes = mesh.nodes.clone();
    let mut mid = |a: VertexId, b: VertexId| {
        *mids.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let p = nodes[a].midpoint(nodes[b]);
            nodes.push(Point::new(p.x, p.y + 0.01))
        })
    };
    mesh.triangle_mids = mesh.triangles.iter().map(|&[a, b, c]| [mid(a, b), mid(b, c), mid(c, a)]).collect();
    mesh.edge_mids = mesh.edges.iter().map(|e| mid(e.nodes[0], e.nodes[1])).collect();
    mesh.nodes = nodes;
    mesh
}

const PLAIN: [&str; 5] = ["steel", "air", "wall", "inlet", "interface"];
const ODD: [&str; 5] = ["Stahl & \"Luft\" 37%", "7", "Wand", "wand", "über der Mitte"];

/// Names with their numbers of cells: of regions, of boundaries.
type Counts = (BTreeMap<String, usize>, BTreeMap<String, usize>);

fn counts(mesh: &Mesh) -> Counts {
    let mut counts = Counts::default();
    let text = |name: NameId| mesh.names.text(name).to_owned();
    for &region in mesh.triangle_regions.iter() {
        *counts.0.entry(text(mesh.regions[region])).or_default() += 1;
    }
    for edge in &mesh.edges {
        *counts.1.entry(text(edge.name)).or_default() += 1;
    }
    counts
}

/// The nodes of a cell, as the bits of their coordinates.
type CellPlaces = Vec<[u64; 3]>;

/// The corners of all triangles and the ends of all edges, as places, sorted: the same whatever the order of cells.
fn shape(mesh: &Mesh) -> (Vec<CellPlaces>, Vec<CellPlaces>) {
    let places: Vec<[u64; 3]> = mesh.places().map(|p| p.map(|x| (x + 0.0).to_bits())).collect();
    let at = |v: &VertexId| places[v.index()];
    let mids = |t| mesh.triangle_mids.get(t).into_iter().flatten();
    let mut triangles: Vec<Vec<_>> =
        mesh.triangles.enumerate().map(|(t, corners)| corners.iter().chain(mids(t)).map(at).collect()).collect();
    let mut edges: Vec<Vec<_>> = Vec::new();
    for (i, edge) in mesh.edges.iter().enumerate() {
        let mut ends: Vec<_> = edge.nodes.iter().map(at).collect();
        ends.sort_unstable();
        edges.push(ends.into_iter().chain(mesh.edge_mids.get(i).map(at)).collect());
    }
    triangles.iter_mut().for_each(|t| turned_first(t));
    triangles.sort_unstable();
    edges.sort_unstable();
    (triangles, edges)
}

/// A triangle from its smallest corner on, mid nodes along.
fn turned_first(triangle: &mut [[u64; 3]]) {
    let first = (0..3).min_by_key(|&k| triangle[k]).expect("three corners");
    triangle[..3].rotate_left(first);
    if triangle.len() == 6 {
        triangle[3..].rotate_left(first);
    }
}

/// Writes and reads back.
fn around(mesh: &Mesh, format: Format) -> MeshFile {
    around_with(mesh, format, &WriteOptions::default())
}

fn around_with(mesh: &Mesh, format: Format, options: &WriteOptions) -> MeshFile {
    let files = encode(mesh, &[], format, options).unwrap_or_else(|e| panic!("{format:?}: {e}"));
    let of = |suffix: &str| {
        let place = format.suffixes().iter().position(|s| *s == suffix);
        place.and_then(|i| files.get(i).cloned())
    };
    let reading = format.reading().expect("a format that is read");
    let main = of(reading.suffix).expect("the main file");
    let beside: Vec<_> = reading.beside.iter().map(|suffix| of(suffix)).collect();
    read(&main, format, &beside).unwrap_or_else(|e| panic!("{format:?}: {e}"))
}

/// The formats that are read, too: whatever is written of them comes back.
fn read_back() -> impl Iterator<Item = Format> {
    Format::ALL.into_iter().filter(|format| format.reading().is_some())
}

#[test]
fn names_and_places_come_back() {
    for names in [PLAIN, ODD] {
        let mesh = strip(5, names);
        for format in read_back() {
            let MeshFile { mesh: back, notes, .. } = around(&mesh, format);
            assert_eq!(notes, [""; 0], "{format:?}");
            let (mut regions, mut boundaries) = counts(&mesh);
            let (triangles, mut edges) = shape(&mesh);
            if format == Format::Su2 {
                regions = [("region".to_owned(), mesh.triangles.len())].into();
                boundaries.remove(names[4]);
                let rim = Mesh {
                    edges: mesh.edges.iter().filter(|e| mesh.names.text(e.name) != names[4]).copied().collect(),
                    ..mesh.clone()
                };
                edges = shape(&rim).1;
            }
            if format == Format::Stl {
                boundaries.clear();
                edges.clear();
            }
            if matches!(format, Format::Msh | Format::Msh22) {
                regions = regions.into_iter().map(|(name, n)| (name.replace('"', "'"), n)).collect();
                // Without regard to case these two are one: the second is told apart.
                if names == ODD {
                    let n = boundaries.remove("wand").expect("the name");
                    boundaries.insert("wand_2".into(), n);
                }
            }
            assert_eq!(counts(&back), (regions, boundaries), "{format:?}");
            assert_eq!(shape(&back), (triangles, edges), "{format:?}");
            if !matches!(format, Format::Stl) {
                assert_eq!(back.nodes, mesh.nodes, "{format:?} keeps the order of nodes");
            }
        }
    }
}

#[test]
fn second_order_comes_back() {
    let mesh = second_order(strip(4, PLAIN));
    for format in [Format::Vtu, Format::Vtk, Format::VtkText, Format::Msh, Format::Msh22, Format::Inp, Format::Triangle]
    {
        let back = around(&mesh, format).mesh;
        assert_eq!(back.order(), 2);
        assert_eq!((counts(&back), shape(&back)), (counts(&mesh), shape(&mesh)), "{format:?}");
    }
    for format in [Format::Obj, Format::Stl] {
        let back = around(&mesh, format).mesh;
        assert_eq!(back.triangles.len(), 4 * mesh.triangles.len(), "{format:?}");
        let halves = if format == Format::Obj { 2 * mesh.edges.len() } else { 0 };
        assert_eq!(back.edges.len(), halves, "{format:?}");
        assert!(format.losses(&mesh, &WriteOptions::default()).iter().any(|loss| loss.starts_with("order 2")));
    }
    let refused = encode(&mesh, &[], Format::Su2, &WriteOptions::default()).expect_err("SU2 is straight");
    assert_eq!(refused.kind(), std::io::ErrorKind::Unsupported);
}

#[test]
fn a_mesh_in_space_comes_back_where_it_was() {
    let frame = Frame { origin: [3.0, -1.0, 2.0], x: [0.0, 1.0, 0.0], y: [0.0, 0.0, 1.0] };
    let mesh = Mesh { frame: Some(frame), ..strip(3, PLAIN) };
    for format in [Format::Vtu, Format::Vtk, Format::VtkText, Format::Msh, Format::Msh22, Format::Inp, Format::Obj] {
        let back = around(&mesh, format).mesh;
        let places = back.places().zip(mesh.places());
        let far = places.map(|(p, q)| (0..3).map(|k| (p[k] - q[k]).abs()).fold(0.0, f64::max)).fold(0.0, f64::max);
        assert!(far < 1e-9, "{format:?}: {far}");
        assert_eq!(counts(&back).0, counts(&mesh).0, "{format:?}");
    }
}

#[test]
fn su2_has_each_rim_edge_in_one_marker() {
    // An edge of the rim that has no name, one named twice.
    let mut mesh = strip(3, PLAIN);
    mesh.edges.remove(0);
    mesh.edges.push(mesh.edges[1]);
    let back = around(&mesh, Format::Su2).mesh;
    let expected: BTreeMap<String, usize> = [("wall".into(), 6), ("inlet".into(), 3), ("boundary".into(), 1)].into();
    assert_eq!(counts(&back).1, expected);
}

#[test]
fn empty_meshes_are_whole_files_or_refused() {
    for format in read_back() {
        assert!(around(&Mesh::default(), format).mesh.triangles.is_empty(), "{format:?}");
    }
    for format in [Format::Glb, Format::Gltf] {
        assert_eq!(
            encode(&Mesh::default(), &[], format, &WriteOptions::default()).expect_err("none").kind(),
            std::io::ErrorKind::Unsupported
        );
    }
}

#[test]
fn named_nodes_are_physical_points_of_gmsh_and_said_to_be_lost_elsewhere() {
    let mut mesh = strip(2, PLAIN);
    let [tip, sensor] = ["tip", "sensor"].map(|name| mesh.names.intern(name));
    // Inside a region, on a boundary, and two of one name.
    mesh.named_nodes = vec![(VertexId(0), tip), (VertexId(4), sensor), (VertexId(8), tip)];
    let text =
        String::from_utf8(encode(&mesh, &[], Format::Msh22, &WriteOptions::default()).expect("written").remove(0))
            .expect("text");
    // Two regions and three boundaries come before.
    assert!(text.contains("0 6 \"tip\"") && text.contains("0 7 \"sensor\""), "{text}");
    let points: Vec<&str> = text.lines().filter(|line| line.split(' ').nth(1) == Some("15")).collect();
    let last = mesh.edges.len() + mesh.triangles.len();
    let wanted =
        [(1, 6, 1), (2, 7, 5), (3, 6, 9)].map(|(k, tag, node)| format!("{} 15 2 {tag} {tag} {node}", last + k));
    assert_eq!(points, wanted);
    for format in [Format::Msh, Format::Msh22] {
        let back = around(&mesh, format).mesh;
        assert_eq!((shape(&back), back.nodes.len()), (shape(&mesh), mesh.nodes.len()), "{format:?}");
    }
    for format in read_back() {
        let told = format.losses(&mesh, &WriteOptions::default()).contains(&"names of points");
        assert_eq!(told, !matches!(format, Format::Msh | Format::Msh22), "{format:?}");
    }
    mesh.named_nodes = vec![(VertexId(999), tip)];
    assert!(encode(&mesh, &[], Format::Msh, &WriteOptions::default()).is_err());
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
    for format in Format::ALL {
        for mesh in &wrong {
            let error = encode(mesh, &[], format, &WriteOptions::default()).expect_err("no mesh");
            assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput, "{format:?}");
        }
    }
}

#[test]
fn gltf_has_a_node_and_a_mesh_for_every_name() {
    for (mesh, parts) in [(strip(5, ODD), [1, 1]), (second_order(strip(5, ODD)), [4, 2])] {
        for format in [Format::Glb, Format::Gltf] {
            let file = encode(&mesh, &[], format, &WriteOptions::default()).expect("written").remove(0);
            let document = gltf::Gltf::from_slice(&file).expect("valid glTF");
            let blob = document.blob.clone().unwrap_or_else(|| {
                use base64::Engine;
                let gltf::buffer::Source::Uri(uri) = document.buffers().next().expect("a buffer").source() else {
                    panic!()
                };
                let data = uri.split_once(";base64,").expect("a data URI").1;
                base64::engine::general_purpose::STANDARD.decode(data).expect("base64")
            });
            let root = document.default_scene().expect("a scene").nodes().next().expect("a node");
            let (shift, rotation, scale) = root.transform().decomposed();
            assert_eq!((rotation, scale), ([0.0, 0.0, 0.0, 1.0], [0.001; 3]), "millimetres, y up");
            let centre = shift.map(|part| f64::from(part) / f64::from(scale[0]));
            let mut found = Counts::default();
            for child in root.children() {
                assert_eq!(child.transform().decomposed(), ([0.0; 3], [0.0, 0.0, 0.0, 1.0], [1.0; 3]));
                let shape = child.mesh().expect("a mesh");
                assert_eq!(shape.primitives().len(), 1);
                let primitive = shape.primitives().next().expect("a primitive");
                let reader = primitive.reader(|_| Some(&blob));
                let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
                let positions: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
                assert!(indices.iter().all(|&i| (i as usize) < positions.len()));
                for (p, q) in positions.iter().zip(mesh.places()) {
                    // About 1e5 a float32 alone is only good to 4e-3.
                    (0..3).for_each(|k| assert!((centre[k] + f64::from(p[k]) - q[k]).abs() < 1e-7));
                }
                let extras: serde_json::Value =
                    serde_json::from_str(primitive.extras().as_ref().expect("extras").get()).expect("JSON");
                let (kind, corners, part) = match primitive.mode() {
                    gltf::mesh::Mode::Triangles => ("region", 3, 0),
                    gltf::mesh::Mode::Lines => ("boundary", 2, 1),
                    other => panic!("{other:?}"),
                };
                let name = extras[kind].as_str().expect("a name").to_owned();
                assert_eq!([child.name(), shape.name()], [Some(name.as_str()); 2]);
                let cells = indices.len() / corners / parts[part];
                if part == 0 {
                    assert_eq!(primitive.material().name(), Some(name.as_str()));
                    found.0.insert(name, cells);
                } else {
                    found.1.insert(name, cells);
                }
            }
            assert_eq!(found, counts(&mesh));
        }
    }
}

#[test]
fn gltf_in_space_stands_where_it_was() {
    let axes = ([0.0, 0.6, 0.8], [1.0, 0.0, 0.0]);
    let frame = Frame { origin: [3000.0, -20000.0, 70000.0], x: axes.0, y: axes.1 };
    let mesh = Mesh { frame: Some(frame), ..strip(2, PLAIN) };
    let file = encode(&mesh, &[], Format::Glb, &WriteOptions::default()).expect("written").remove(0);
    let document = gltf::Gltf::from_slice(&file).expect("valid glTF");
    let root = document.default_scene().expect("a scene").nodes().next().expect("a node");
    let ([tx, ty, tz], _, [scale, ..]) = root.transform().decomposed();
    let primitive = document.meshes().next().and_then(|mesh| mesh.primitives().next()).expect("a primitive");
    let positions = primitive.reader(|_| document.blob.as_deref()).read_positions().expect("positions");
    for ([px, py, pz], [x, y, z]) in positions.zip(mesh.places()) {
        // The root turns (x, y, z) to (x, z, −y), then shifts.
        let at = [px * scale + tx, pz * scale + ty, -py * scale + tz].map(f64::from);
        [x, z, -y].into_iter().zip(at).for_each(|(wanted, found)| assert!((0.001 * wanted - found).abs() < 5e-5));
    }
}

#[test]
fn obj_has_a_material_for_every_region() {
    let mut mesh = strip(2, ODD);
    let region = mesh.regions[RegionId(0)];
    mesh.colours.insert(region, Colour([255, 0, 51, 102]));
    let files = encode(&mesh, &[], Format::Obj, &WriteOptions::default()).expect("written");
    let [obj, mtl] = [&files[0], &files[1]].map(|file| String::from_utf8(file.clone()).expect("text"));
    let words = |text: &str, first: &str| -> Vec<String> {
        text.lines().filter_map(|line| line.strip_prefix(first)).map(str::to_owned).collect()
    };
    assert_eq!(words(&obj, "mtllib "), ["mesh.mtl"]);
    let (used, made) = (words(&obj, "usemtl "), words(&mtl, "newmtl "));
    assert_eq!(made.len(), counts(&mesh).0.len() + 1, "and one of lines");
    assert!(used.iter().all(|name| made.contains(name)), "{used:?} {made:?}");
    assert_eq!(words(&obj, "g ")[..2], made[..2], "materials are called as the groups");
    assert_eq!((&words(&mtl, "Kd ")[0][..], &words(&mtl, "d ")[0][..]), ("1.000000 0.000000 0.200000", "0.400000"));
    let bare = WriteOptions { stem: None, ..WriteOptions::default() };
    let files = encode(&mesh, &[], Format::Obj, &bare).expect("written");
    assert_eq!(files.len(), 1);
    assert!(!String::from_utf8_lossy(&files[0]).contains("mtl "));
    assert!(Format::Obj.losses(&mesh, &bare).iter().any(|loss| loss.starts_with("colours")));
}

#[test]
fn colours_come_back_from_vtu() {
    let mut mesh = strip(2, PLAIN);
    let region = mesh.regions[RegionId(0)];
    mesh.colours.insert(region, Colour([1, 2, 3, 4]));
    let back = around(&mesh, Format::Vtu).mesh;
    let named: Vec<_> = back.colours.iter().map(|(&name, colour)| (back.names.text(name), colour.0)).collect();
    assert_eq!(named, [(PLAIN[0], [1, 2, 3, 4])]);
}

#[test]
fn inp_names_are_legal_and_faces_are_right() {
    let file = encode(&strip(2, ODD), &[], Format::Inp, &WriteOptions::default()).expect("written").remove(0);
    let text = String::from_utf8(file).expect("text");
    for line in [
        "*ELEMENT, TYPE=CPS3, ELSET=S_7",
        "*NSET, NSET=Wand",
        "*NSET, NSET=wand_2",
        "*SURFACE, NAME=Wand, TYPE=ELEMENT",
    ] {
        assert!(text.lines().any(|l| l == line), "{line}\n{text}");
    }
    assert!(text.lines().any(|l| l == "** name region S_7 = 7"), "{text}");
    assert!(text.lines().filter(|l| l.starts_with('*') && !l.starts_with("**")).all(str::is_ascii));
}

/// A mesh that is given as a drawing is refused with what can be done with it: a mesh that is read here by other verbs,
/// one that is not by another program.
#[test]
fn a_mesh_is_no_drawing() {
    let refused = |name: &str, bytes: &[u8]| import::tell_format(name.as_ref(), bytes).expect_err("no drawing").help;
    for format in Format::ALL {
        let way = if format.reading().is_some() { "verifies meshes" } else { "Gmsh or meshio" };
        let suffix = format.reading().map_or(format.suffixes()[0], |reading| reading.suffix);
        assert!(refused(&format!("mesh.{suffix}"), b"").contains(way), ".{suffix} is not in import/foreign.rs");
        let file = encode(&strip(2, PLAIN), &[], format, &WriteOptions::default()).expect("written").remove(0);
        if let Some(told) = Format::sniff(&file) {
            assert_eq!(told.reading().map(|reading| reading.suffix), Some(suffix), "{format:?}");
            assert!(
                refused("mesh", &file).contains("verifies meshes"),
                "{format:?} is not among the signs of import/foreign.rs"
            );
        }
    }
}

// ---- for readers of others ----

/// The text of a mesh in a format.
fn text_of(mesh: &Mesh, format: Format, options: &WriteOptions) -> String {
    String::from_utf8(encode(mesh, &[], format, options).expect("written").remove(0)).expect("text")
}

#[test]
fn the_names_of_vtk_stand_behind_its_cell_types() {
    let binary = encode(&strip(2, PLAIN), &[], Format::Vtk, &WriteOptions::default()).expect("written").remove(0);
    let text = text_of(&strip(2, PLAIN), Format::VtkText, &WriteOptions::default());
    for bytes in [binary.as_slice(), text.as_bytes()] {
        let place = |word: &str| bytes.windows(word.len()).position(|w| w == word.as_bytes()).expect(word);
        let order =
            ["# vtk DataFile Version 3.0\n", "POINTS", "CELLS", "CELL_TYPES", "FIELD", "region:steel", "CELL_DATA"];
        assert!(order.map(place).is_sorted());
    }
    // MFEM takes the array behind CELL_DATA, of no other name; deal.II needs its own.
    assert!(text.contains("\nASCII\n") && text.contains("\nSCALARS MaterialID int 1\n"));
    let cells = 8;
    assert!(
        text.contains(&format!("\nCELL_DATA {cells}\nSCALARS material int 1\nLOOKUP_TABLE default\n1\n")),
        "{text}"
    );
}

#[test]
fn text_vtk_has_lines_where_asked_for() {
    for mesh in [strip(3, ODD), second_order(strip(3, ODD))] {
        let lines = WriteOptions { lines: Some(true), ..WriteOptions::default() };
        for (options, cells) in [(WriteOptions::default(), 12), (lines, 12 + mesh.edges.len())] {
            assert!(text_of(&mesh, Format::VtkText, &options).contains(&format!("\nCELL_TYPES {cells}\n")));
            let back = around_with(&mesh, Format::VtkText, &options).mesh;
            assert_eq!((counts(&back), shape(&back)), (counts(&mesh), shape(&mesh)));
        }
    }
}

#[test]
fn a_plain_vtu_has_no_field_data() {
    let mesh = strip(3, PLAIN);
    let plain = WriteOptions { plain: true, ..WriteOptions::default() };
    let text = text_of(&mesh, Format::Vtu, &plain);
    assert!(!text.contains("FieldData") && text.contains("<UnstructuredGrid>\n<Piece "), "{text}");
    let back = around_with(&mesh, Format::Vtu, &plain).mesh;
    assert_eq!((shape(&back).0, back.edges.len()), (shape(&mesh).0, 0));
    assert!(Format::Vtu.losses(&mesh, &plain).iter().any(|loss| loss.starts_with("names")));
    assert!(Format::Vtu.losses(&mesh, &plain).iter().any(|loss| loss.starts_with("boundaries")));
    // MFEM takes its attributes from the first array of the cells, where the name of the scalars says so.
    assert!(text.contains("<CellData Scalars=\"material\">\n<DataArray type=\"Int32\" Name=\"material\""), "{text}");
    let lines = WriteOptions { lines: Some(true), ..plain };
    assert_eq!(shape(&around_with(&mesh, Format::Vtu, &lines).mesh), shape(&mesh));
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
            assert_eq!(told, !matches!(format, Format::Stl | Format::Su2), "{format:?}");
        }
    }
}

#[test]
fn pictures_of_space_can_do_without_lines() {
    let mesh = strip(3, PLAIN);
    let none = WriteOptions { lines: Some(false), ..WriteOptions::default() };
    let back = around_with(&mesh, Format::Obj, &none).mesh;
    assert_eq!((back.edges.len(), shape(&back).0), (0, shape(&mesh).0));
    for format in [Format::Glb, Format::Gltf] {
        let file = encode(&mesh, &[], format, &none).expect("written").remove(0);
        let document = gltf::Gltf::from_slice(&file).expect("valid glTF");
        let primitives: Vec<_> = document.meshes().flat_map(|mesh| mesh.primitives()).collect();
        assert_eq!(primitives.len(), 2);
        assert!(primitives.iter().all(|p| p.mode() == gltf::mesh::Mode::Triangles));
        assert!(format.losses(&mesh, &none).iter().any(|loss| loss.starts_with("boundaries")));
    }
}

#[test]
fn markers_of_su2_can_stand_in_a_configuration() {
    let names = ["all", "all", "outer wall (T=20 °C)", "outer_wall__T_20_°C_", "interface"];
    let text = text_of(&strip(2, names), Format::Su2, &WriteOptions::default());
    let tags: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("MARKER_TAG= ")).collect();
    assert_eq!(tags, ["outer_wall__T_20_°C_", "outer_wall__T_20_°C__2"]);
    let names = ["all", "all", "{a}:b,c;d=e%f\\g", "None", "interface"];
    let text = text_of(&strip(2, names), Format::Su2, &WriteOptions::default());
    let tags: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("MARKER_TAG= ")).collect();
    assert_eq!(tags, ["_a__b_c_d_e_f_g", "None_"]);
    let back = around(&strip(2, names), Format::Su2).mesh;
    assert_eq!(counts(&back).1.keys().map(String::as_str).collect::<Vec<_>>(), ["None", names[2]]);
}

#[test]
fn xdmf_has_one_grid_or_two() {
    for (mesh, length) in [(strip(2, ODD), 8 * 4 + 10 * 4), (second_order(strip(2, ODD)), 8 * 7 + 10 * 4)] {
        let single = WriteOptions { xdmf: XdmfGrids::Single, ..WriteOptions::default() };
        let [one, two] = [single, WriteOptions::default()].map(|options| text_of(&mesh, Format::Xdmf, &options));
        let document = roxmltree::Document::parse(&two).expect("XML");
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("Grid")).count(), 2);
        let document = roxmltree::Document::parse(&one).expect("XML");
        let domain = document.root_element().first_element_child().expect("a domain");
        // meshio takes a domain of one grid and nothing else.
        let children: Vec<_> = domain.children().filter(roxmltree::Node::is_element).collect();
        assert_eq!(children.len(), 1);
        let topology = children[0].children().find(|node| node.has_tag_name("Topology")).expect("a topology");
        assert_eq!(topology.attribute("TopologyType"), Some("Mixed"));
        assert_eq!(topology.attribute("NumberOfElements"), Some("18"));
        let numbers = topology.first_element_child().and_then(|item| item.text()).expect("numbers");
        assert_eq!(numbers.split_ascii_whitespace().count(), length);
        let arrays: Vec<_> = children[0].children().filter(|node| node.has_tag_name("Attribute")).collect();
        let of = |k: usize| arrays[k].first_element_child().and_then(|item| item.text()).expect("numbers");
        let numbers = |k: usize| of(k).split_ascii_whitespace().map(|n| n.parse().unwrap()).collect::<Vec<u32>>();
        assert_eq!((numbers(0).len(), numbers(1).len()), (18, 18));
        assert!(numbers(0)[..8].iter().all(|&n| n > 0) && numbers(0)[8..].iter().all(|&n| n == 0));
        assert!(numbers(1)[..8].iter().all(|&n| n == 0) && numbers(1)[8..].iter().all(|&n| n > 0));
        let names = children[0].children().find(|node| node.has_tag_name("Information")).and_then(|n| n.text());
        let names =
            roxmltree::Document::parse(names.expect("names")).expect("XML within").root_element().children().count();
        assert_eq!(names, 5);
    }
}

#[test]
fn what_a_reader_of_a_format_lacks_is_said() {
    let mesh = second_order(strip(2, PLAIN));
    let told = |format: Format, options: &WriteOptions| {
        format.losses(&mesh, options).iter().any(|loss| loss.starts_with("order 2 for meshio"))
    };
    assert!(told(Format::Inp, &WriteOptions::default()));
    assert!(told(Format::Xdmf, &WriteOptions { xdmf: XdmfGrids::Single, ..WriteOptions::default() }));
    assert!(!told(Format::Xdmf, &WriteOptions::default()));
}

// ---- other writers ----

/// A square of two triangles with its lower side, by hand, in each format's other forms.
fn foreign() -> Vec<(&'static str, Format, Vec<u8>)> {
    let msh22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"low side\"\n2 1 \"all\"\n$EndPhysicalNames\n\
        $Nodes\n4\n1 0 0 0\n2 1 0 0\n5 1 1 0\n9 0 1 0\n$EndNodes\n$Elements\n4\n1 15 2 0 1 1\n2 1 2 7 1 1 2\n3 2 2 1 1 1 2 5\n4 2 2 1 1 1 5 9\n$EndElements\n";
    let msh41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"low side\"\n2 1 \"all\"\n$EndPhysicalNames\n\
        $Entities\n1 1 1 0\n1 0 0 0 0\n3 0 0 0 1 0 0 1 7 2 1 -1\n4 0 0 0 1 1 0 1 1 1 3\n$EndEntities\n\
        $Nodes\n1 4 1 9\n2 4 0 4\n1\n2\n5\n9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n\
        $Elements\n3 4 1 4\n0 1 15 1\n1 1\n1 3 1 1\n2 1 2\n2 4 2 2\n3 1 2 5\n4 1 5 9\n$EndElements\n";
    let mut binary = b"$MeshFormat\n2.2 1 8\n\x01\0\0\0\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"low side\"\n2 1 \"all\"\n$EndPhysicalNames\n$Nodes\n4\n".to_vec();
    for (tag, x, y) in [(1_i32, 0.0_f64, 0.0_f64), (2, 1.0, 0.0), (5, 1.0, 1.0), (9, 0.0, 1.0)] {
        binary.extend(tag.to_le_bytes());
        binary.extend([x, y, 0.0].into_iter().flat_map(f64::to_le_bytes));
    }
    binary.extend(b"\n$EndNodes\n$Elements\n4\n");
    let elements: [i32; 34] =
        [15, 1, 2, 1, 0, 1, 1, 1, 1, 2, 2, 7, 3, 1, 2, 2, 2, 2, 3, 1, 4, 1, 2, 5, 4, 1, 4, 1, 5, 9, 0, 0, 0, 0];
    binary.extend(elements[..30].iter().flat_map(|i| i.to_le_bytes()));
    binary.extend(b"\n$EndElements\n");
    let vtk4 = "# vtk DataFile Version 4.2\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0\n0 1 0\n\
        CELLS 4 13\n1 0\n2 0 1\n3 0 1 2\n3 0 2 3\nCELL_TYPES 4\n1\n3\n5\n5\nFIELD FieldData 2\nboundary:low%20side 1 1 int\n7\nregion:all 1 1 int\n1\n\
        CELL_DATA 4\nSCALARS region int 1\nLOOKUP_TABLE default\n0\n7\n1\n1\n";
    let vtk5 = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 1 1 0\n0 1 0\n\
        CELLS 5 9\nOFFSETS vtktypeint64\n0 1 3 6 9\nCONNECTIVITY vtktypeint64\n0 0 1\n0 1 2 0 2 3\nCELL_TYPES 4\n1\n3\n5\n5\n\
        FIELD FieldData 2\nboundary:low%20side 1 1 int\n7\nregion:all 1 1 int\n1\nCELL_DATA 4\nFIELD FieldData 1\nregion 1 4 int\n0 7 1 1\n";
    let inp = "*Heading\nsquare\n*Node\n1, 0., 0.\n2, 1., 0., 0.\n5, 1, 1, 0\n9, 0, 1\n*Element, type=T3D2, elset=low side\n7, 1, 2\n\
        *ELEMENT, TYPE=CPE3, ELSET=all\n1, 1, 2,\n5\n2, 1, 5, 9\n*Step\n*End Step\n";
    let parametric = msh22.replace(
        "$Nodes\n4\n1 0 0 0\n2 1 0 0\n5 1 1 0\n9 0 1 0\n$EndNodes",
        "$ParametricNodes\n4\n1 0 0 0 0 1\n2 1 0 0 1 3 0.5\n5 1 1 0 2 4 1 1\n9 0 1 0 2 4 0 1\n$EndParametricNodes",
    );
    // Of meshio 5.3.5, without its names, which it does not write.
    let meshio =
        vtk5.replace("vtktypeint64\n0 1 3", "vtktypeint32\n0 1 3").replace("region 1 4 int", "region 1 4 vtktypeint32");
    let gmsh = "*Heading\n x.inp\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n5, 1, 1, 0\n9, 0, 1, 0\n******* E L E M E N T S *************\n\
        *ELEMENT, type=T3D2, ELSET=Line1\n7, 1, 2\n*ELEMENT, type=CPS3, ELSET=Surface2\n1, 1, 2, 5\n\
        *ELEMENT, type=CPS3, ELSET=Surface3\n2, 1, 5, 9\n*ELSET,ELSET=low side\n7, \n*ELSET,ELSET=all\n1, 2, \n";
    let generated = "*NODE\n1, 0, 0\n2, 1, 0\n5, 1, 1\n9, 0, 1\n*ELEMENT, type=T3D2, ELSET=Eedges\n7, 1, 2\n\
        *ELEMENT, TYPE=S3\n10, 1, 2, 5\n20, 1, 5, 9\n*ELSET, ELSET=everything, GENERATE\n1, 99\n\
        *ELSET, ELSET=all, GENERATE\n10, 20, 10\n*ELSET, ELSET=low side\nEedges\n";
    let su2 = "% by hand\nNDIME=2\nNPOIN= 4 4\n0. 0. 0\n1. 0. 1\n1. 1. 2\n0. 1. 3\nNELEM= 2\n5\t0\t1\t2\t0\n5 0 2 3 1\n\
        NMARK= 1\nMARKER_TAG= low side\nMARKER_ELEMS= 1\n3 0 1\n";
    let obj = "# by hand\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no all\nf 1//1 2//1 3//1\nf -4 -2 -1\n# name boundary l = low side\ng l\nl 1 2\n";
    vec![
        ("MSH 2.2", Format::Msh, msh22.into()),
        ("MSH 4.1", Format::Msh, msh41.into()),
        ("binary MSH 2.2", Format::Msh, binary),
        ("VTK 4.2", Format::Vtk, vtk4.into()),
        ("parametric MSH 2.2", Format::Msh, parametric.into()),
        ("VTK 5.1", Format::Vtk, vtk5.into()),
        ("VTK 5.1 of meshio", Format::Vtk, meshio.into()),
        ("INP", Format::Inp, inp.into()),
        ("INP of Gmsh", Format::Inp, gmsh.into()),
        ("INP with ranges and sets of sets", Format::Inp, generated.into()),
        ("SU2", Format::Su2, su2.into()),
        ("OBJ", Format::Obj, obj.into()),
    ]
}

#[test]
fn other_writers_forms_are_read() {
    for (what, format, bytes) in foreign() {
        assert_eq!(Format::sniff(&bytes), Some(format), "{what}");
        let MeshFile { mesh, notes, .. } = read(&bytes, format, &[]).unwrap_or_else(|e| panic!("{what}: {e}"));
        let all = if format == Format::Su2 { "region" } else { "all" };
        let expected = ([(all.to_owned(), 2)].into(), [("low side".to_owned(), 1)].into());
        assert_eq!(counts(&mesh), expected, "{what}");
        assert_eq!(mesh.nodes[VertexId(2)], Point::new(1.0, 1.0), "{what}");
        assert_eq!(mesh.triangles.as_slice()[1], [0, 2, 3].map(VertexId), "{what}");
        assert!(notes.len() < 2, "{what}");
    }
}

#[test]
fn element_sets_name_what_no_entity_names() {
    let deck = |sets: &str| {
        let text = format!(
            "*NODE\n1, 0, 0\n2, 1, 0\n5, 1, 1\n9, 0, 1\n*ELEMENT, TYPE=CPS3, ELSET=Surface1\n1, 1, 2, 5\n\
             *ELEMENT, TYPE=CPS3, ELSET=steel\n2, 1, 5, 9\n{sets}"
        );
        read(text.as_bytes(), Format::Inp, &[])
    };
    let regions = |sets: &str| {
        let file = deck(sets).expect("a deck");
        (counts(&file.mesh).0.into_keys().collect::<Vec<_>>(), file.notes.len())
    };
    assert_eq!(regions(""), (vec!["Surface1".into(), "steel".into()], 0));
    assert_eq!(regions("*ELSET, ELSET=a\n1, 2\n"), (vec!["a".into(), "steel".into()], 0));
    // The smallest of several, and that is said.
    assert_eq!(regions("*ELSET, ELSET=a\n1, 2\n*ELSET, ELSET=b\n1\n"), (vec!["b".into(), "steel".into()], 1));
    let again = format!("*ELSET, ELSET=a, GENERATE\n{}", "1, 2\n".repeat(5000));
    assert!(deck(&again).expect_err("no end").what.contains("again and again"));
}

#[test]
fn what_cannot_be_read_is_said() {
    let quad = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 3 0 1 1 1 1\n$EndElements\n";
    for (bytes, format, what) in [
        (quad, Format::Msh, "an element is a quadrilateral (Gmsh type 3)"),
        ("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", Format::Msh, "this is MSH 4.0"),
        ("NDIME= 3\n", Format::Su2, "the mesh has 3 dimensions"),
        ("NDIME= 2\nNELEM= 7\n5 0 1 2\n", Format::Su2, "line 4: the file ends 6 lines too early"),
        ("*ELEMENT, TYPE=C3D4\n", Format::Inp, "line 1: elements of type 'C3D4'"),
        ("v 0 0 0\nf 1 1 1 1\n", Format::Obj, "line 2: a face has 4 corners"),
        ("v 0 0 0\nf 1 2 3\n", Format::Obj, "a cell has the node 1, but there are 1"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n", Format::Obj, "the mesh is not flat: node 3 lies"),
        ("1 3 0\n1 1 2 3\n", Format::Triangle, "there is no .node file beside the .ele file"),
        ("hello", Format::Stl, "this is not STL"),
    ] {
        let error = read(bytes.as_bytes(), format, &[]).expect_err(what);
        assert!(error.what.starts_with(what), "{} is not {what}", error.what);
        assert!(!error.help.is_empty());
    }
}

/// A format, a file of it, and the files beside that.
type Input = (Format, Vec<u8>, Vec<Option<Vec<u8>>>);

/// Files of all readers: ours, of both orders, and others'.
fn files() -> Vec<Input> {
    let mut files: Vec<_> = foreign().into_iter().map(|(_, format, bytes)| (format, bytes, Vec::new())).collect();
    for mesh in [strip(2, ODD), second_order(strip(2, PLAIN))] {
        for format in read_back() {
            let Ok(mut written) = encode(&mesh, &[], format, &WriteOptions::default()) else { continue };
            if format == Format::Triangle {
                let [nodes, elements, segments] = <[_; 3]>::try_from(written).expect("three files");
                // Each of the three in turn is the one to be changed: the first argument.
                files.push((format, elements, vec![Some(nodes), Some(segments)]));
            } else {
                files.push((format, written.remove(0), Vec::new()));
            }
        }
    }
    files
}

/// Whatever is read can be verified, drawn and written.
fn sound(mesh: &Mesh) {
    for format in [Format::Vtk, Format::Inp] {
        encode(mesh, &[], format, &WriteOptions::default()).expect("the lists fit");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_are_an_error_or_a_mesh(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..8),
        cut in prop::option::of(any::<prop::sample::Index>()),
        beside in any::<bool>(),
    ) {
        let mut files = files();
        let which = which.index(files.len());
        let (format, mut bytes, mut more) = files.swap_remove(which);
        if beside && let Some(Some(other)) = more.first_mut() {
            std::mem::swap(&mut bytes, other);
        }
        for (place, byte, digit) in changes {
            let n = bytes.len();
            bytes[place.index(n)] = if digit { b'0' + byte % 10 } else { byte };
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        if beside && let Some(Some(other)) = more.first_mut() {
            std::mem::swap(&mut bytes, other);
        }
        if let Ok(file) = read(&bytes, format, &more) {
            sound(&file.mesh);
        }
    }

    #[test]
    fn any_bytes_are_an_error_or_a_mesh(
        format in prop::sample::select(read_back().collect::<Vec<_>>()),
        bytes in prop::collection::vec(any::<u8>(), 0..400),
        text in "[ -~\n]{0,200}",
    ) {
        for bytes in [bytes.as_slice(), text.as_bytes()] {
            let _ = Format::sniff(bytes);
            if let Ok(file) = read(bytes, format, &[Some(bytes.to_vec()), Some(bytes.to_vec())]) {
                sound(&file.mesh);
            }
        }
    }
}
