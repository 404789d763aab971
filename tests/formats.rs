//! What single formats of meshes have of their own. What holds of all of them is in `readers.rs` and `writers.rs`.

mod strip;

use squinch::geometry::Frame;
use squinch::ids::{Colour, RegionId, VertexId};
use squinch::mesh::Mesh;
use squinch::meshio::{Format, WriteOptions, XdmfGrids, encode};
use std::collections::BTreeMap;
use strip::{Counts, ODD, PLAIN, around, around_with, counts, read_back, second_order, shape, strip};

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
