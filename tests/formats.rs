//! Every writer, read back: names with their numbers of cells, coordinates bit for bit where the format has the digits, order 2;
//! and no bytes do harm to any reader.

use proptest::prelude::*;
use squinch::export::{Format, encode};
use squinch::geometry::{Frame, Point};
use squinch::ids::{Id, NameId, RegionId, VertexId};
use squinch::import::mesh::{self as reader, MeshFile, read};
use squinch::mesh::{CurveEdge, Mesh};
use std::collections::BTreeMap;

/// Three regions (two of one name) in a strip of n × 2 squares, its rim and the line between the rows named; far from the origin, with
/// endless digits.
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

fn reader_of(format: Format) -> Option<reader::Format> {
    let of = |suffix: &&str| reader::Format::ALL.into_iter().find(|f| f.suffix() == *suffix);
    format.suffixes().iter().find_map(of)
}

/// Writes and reads back.
fn around(mesh: &Mesh, format: Format) -> MeshFile {
    let files = encode(mesh, None, &[], format).unwrap_or_else(|e| panic!("{format:?}: {e}"));
    let of = |suffix: &str| {
        let place = format.suffixes().iter().position(|s| *s == suffix);
        place.and_then(|i| files.get(i).cloned())
    };
    let reader = reader_of(format).expect("a format that is read");
    let main = of(reader.suffix()).expect("the main file");
    let beside: Vec<_> = reader.beside().iter().map(|suffix| of(suffix)).collect();
    read(&main, reader, &beside).unwrap_or_else(|e| panic!("{format:?}: {e}"))
}

const READ_BACK: [Format; 9] = [
    Format::Vtu,
    Format::Vtk,
    Format::Msh,
    Format::Msh22,
    Format::Su2,
    Format::Inp,
    Format::Triangle,
    Format::Obj,
    Format::Stl,
];

#[test]
fn names_and_places_come_back() {
    for names in [PLAIN, ODD] {
        let mesh = strip(5, names);
        for format in READ_BACK {
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
    for format in [Format::Vtu, Format::Vtk, Format::Msh, Format::Msh22, Format::Inp, Format::Triangle] {
        let back = around(&mesh, format).mesh;
        assert_eq!(back.order(), 2);
        assert_eq!((counts(&back), shape(&back)), (counts(&mesh), shape(&mesh)), "{format:?}");
    }
    for format in [Format::Obj, Format::Stl] {
        let back = around(&mesh, format).mesh;
        assert_eq!(back.triangles.len(), 4 * mesh.triangles.len(), "{format:?}");
        let halves = if format == Format::Obj { 2 * mesh.edges.len() } else { 0 };
        assert_eq!(back.edges.len(), halves, "{format:?}");
        assert!(format.losses(&mesh).iter().any(|loss| loss.starts_with("order 2")));
    }
    let refused = encode(&mesh, None, &[], Format::Su2).expect_err("SU2 is straight");
    assert_eq!(refused.kind(), std::io::ErrorKind::Unsupported);
}

#[test]
fn a_mesh_in_space_comes_back_where_it_was() {
    let frame = Frame { origin: [3.0, -1.0, 2.0], x: [0.0, 1.0, 0.0], y: [0.0, 0.0, 1.0] };
    let mesh = Mesh { frame: Some(frame), ..strip(3, PLAIN) };
    for format in [Format::Vtu, Format::Vtk, Format::Msh, Format::Msh22, Format::Inp, Format::Obj] {
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
    for format in READ_BACK {
        assert!(around(&Mesh::default(), format).mesh.triangles.is_empty(), "{format:?}");
    }
    for format in [Format::Glb, Format::Gltf] {
        assert_eq!(
            encode(&Mesh::default(), None, &[], format).expect_err("none").kind(),
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
    let text = String::from_utf8(encode(&mesh, None, &[], Format::Msh22).expect("written").remove(0)).expect("text");
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
    for format in READ_BACK {
        let told = format.losses(&mesh).contains(&"names of points");
        assert_eq!(told, !matches!(format, Format::Msh | Format::Msh22), "{format:?}");
    }
    mesh.named_nodes = vec![(VertexId(999), tip)];
    assert!(encode(&mesh, None, &[], Format::Msh).is_err());
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
    for format in Format::ALL.into_iter().filter(|f| !matches!(f, Format::Svg | Format::Png)) {
        for mesh in &wrong {
            let error = encode(mesh, None, &[], format).expect_err("no mesh");
            assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput, "{format:?}");
        }
    }
}

#[test]
fn gltf_has_a_primitive_for_every_name() {
    for (mesh, parts) in [(strip(5, ODD), [1, 1]), (second_order(strip(5, ODD)), [4, 2])] {
        for format in [Format::Glb, Format::Gltf] {
            let file = encode(&mesh, None, &[], format).expect("written").remove(0);
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
            let (_, rotation, scale) = root.transform().decomposed();
            assert_eq!((rotation, scale), ([0.0, 0.0, 0.0, 1.0], [0.001; 3]), "millimetres, y up");
            let child = root.children().next().expect("the mesh");
            let (centre, ..) = child.transform().decomposed();
            let shape = child.mesh().expect("a mesh");
            let mut found = Counts::default();
            for primitive in shape.primitives() {
                let reader = primitive.reader(|_| Some(&blob));
                let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
                let positions: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
                assert!(indices.iter().all(|&i| (i as usize) < positions.len()));
                for (p, q) in positions.iter().zip(mesh.places()) {
                    // About 1e5 a float32 alone is only good to 4e-3.
                    (0..3).for_each(|k| assert!((f64::from(centre[k]) + f64::from(p[k]) - q[k]).abs() < 1e-7));
                }
                let extras: serde_json::Value =
                    serde_json::from_str(primitive.extras().as_ref().expect("extras").get()).expect("JSON");
                let (kind, corners, part) = match primitive.mode() {
                    gltf::mesh::Mode::Triangles => ("region", 3, 0),
                    gltf::mesh::Mode::Lines => ("boundary", 2, 1),
                    other => panic!("{other:?}"),
                };
                let name = extras[kind].as_str().expect("a name").to_owned();
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
fn inp_names_are_legal_and_faces_are_right() {
    let file = encode(&strip(2, ODD), None, &[], Format::Inp).expect("written").remove(0);
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

// ---- other writers ----

/// A square of two triangles with its lower side, by hand, in each format's other forms.
fn foreign() -> Vec<(&'static str, reader::Format, Vec<u8>)> {
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
    let su2 = "% by hand\nNDIME=2\nNPOIN= 4 4\n0. 0. 0\n1. 0. 1\n1. 1. 2\n0. 1. 3\nNELEM= 2\n5\t0\t1\t2\t0\n5 0 2 3 1\n\
        NMARK= 1\nMARKER_TAG= low side\nMARKER_ELEMS= 1\n3 0 1\n";
    let obj = "# by hand\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no all\nf 1//1 2//1 3//1\nf -4 -2 -1\n# name boundary l = low side\ng l\nl 1 2\n";
    vec![
        ("MSH 2.2", reader::Format::Msh, msh22.into()),
        ("MSH 4.1", reader::Format::Msh, msh41.into()),
        ("binary MSH 2.2", reader::Format::Msh, binary),
        ("VTK 4.2", reader::Format::Vtk, vtk4.into()),
        ("VTK 5.1", reader::Format::Vtk, vtk5.into()),
        ("INP", reader::Format::Inp, inp.into()),
        ("SU2", reader::Format::Su2, su2.into()),
        ("OBJ", reader::Format::Obj, obj.into()),
    ]
}

#[test]
fn other_writers_forms_are_read() {
    for (what, format, bytes) in foreign() {
        assert_eq!(reader::Format::sniff(&bytes), Some(format), "{what}");
        let MeshFile { mesh, notes, .. } = read(&bytes, format, &[]).unwrap_or_else(|e| panic!("{what}: {e}"));
        let all = if format == reader::Format::Su2 { "region" } else { "all" };
        let expected = ([(all.to_owned(), 2)].into(), [("low side".to_owned(), 1)].into());
        assert_eq!(counts(&mesh), expected, "{what}");
        assert_eq!(mesh.nodes[VertexId(2)], Point::new(1.0, 1.0), "{what}");
        assert_eq!(mesh.triangles.as_slice()[1], [0, 2, 3].map(VertexId), "{what}");
        assert!(notes.len() < 2, "{what}");
    }
}

#[test]
fn what_cannot_be_read_is_said() {
    let quad = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 3 0 1 1 1 1\n$EndElements\n";
    for (bytes, format, what) in [
        (quad, reader::Format::Msh, "an element is a quadrilateral (Gmsh type 3)"),
        ("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", reader::Format::Msh, "this is MSH 4.0"),
        ("NDIME= 3\n", reader::Format::Su2, "the mesh has 3 dimensions"),
        ("NDIME= 2\nNELEM= 7\n5 0 1 2\n", reader::Format::Su2, "line 4: the file ends 6 lines too early"),
        ("*ELEMENT, TYPE=C3D4\n", reader::Format::Inp, "line 1: elements of type 'C3D4'"),
        ("v 0 0 0\nf 1 1 1 1\n", reader::Format::Obj, "line 2: a face has 4 corners"),
        ("v 0 0 0\nf 1 2 3\n", reader::Format::Obj, "a cell has the node 1, but there are 1"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
            reader::Format::Obj,
            "the mesh is not flat: node 3 lies",
        ),
        ("1 3 0\n1 1 2 3\n", reader::Format::Triangle, "there is no .node file beside the .ele file"),
        ("hello", reader::Format::Stl, "this is no STL"),
    ] {
        let error = read(bytes.as_bytes(), format, &[]).expect_err(what);
        assert!(error.what.starts_with(what), "{} is not {what}", error.what);
        assert!(!error.help.is_empty());
    }
}

/// A format, a file of it, and the files beside that.
type Input = (reader::Format, Vec<u8>, Vec<Option<Vec<u8>>>);

/// Files of all readers: ours, of both orders, and others'.
fn files() -> Vec<Input> {
    let mut files: Vec<_> = foreign().into_iter().map(|(_, format, bytes)| (format, bytes, Vec::new())).collect();
    for mesh in [strip(2, ODD), second_order(strip(2, PLAIN))] {
        for format in READ_BACK {
            let Ok(mut written) = encode(&mesh, None, &[], format) else { continue };
            let reader = reader_of(format).expect("a format that is read");
            if format == Format::Triangle {
                let [nodes, elements, segments] = <[_; 3]>::try_from(written).expect("three files");
                // Each of the three in turn is the one to be changed: the first argument.
                files.push((reader, elements, vec![Some(nodes), Some(segments)]));
            } else {
                files.push((reader, written.remove(0), Vec::new()));
            }
        }
    }
    files
}

/// Whatever is read can be judged, drawn and written.
fn sound(mesh: &Mesh) {
    for format in [Format::Vtk, Format::Inp] {
        encode(mesh, None, &[], format).expect("the lists fit");
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
        format in prop::sample::select(reader::Format::ALL.to_vec()),
        bytes in prop::collection::vec(any::<u8>(), 0..400),
        text in "[ -~\n]{0,200}",
    ) {
        for bytes in [bytes.as_slice(), text.as_bytes()] {
            let _ = reader::Format::sniff(bytes);
            if let Ok(file) = read(bytes, format, &[Some(bytes.to_vec()), Some(bytes.to_vec())]) {
                sound(&file.mesh);
            }
        }
    }
}
