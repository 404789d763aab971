//! Every reader, of drawings and of meshes, from the lists of formats themselves: whole files are read and known by
//! their content; files that are empty, cut, changed, repeated or of another format are errors with their place and a
//! way out, or read; and no bytes do harm.

mod strip;

use proptest::prelude::*;
use squinch::domain::Drawing;
use squinch::geometry::Point;
use squinch::ids::VertexId;
use squinch::import::{self, ImportError};
use squinch::mesh::Mesh;
use squinch::meshio::{self, MeshError, MeshFile, WriteOptions, encode};
use squinch::run::request::Request;
use squinch::run::{Exit, Extent, Source, run};
use squinch::section;
use squinch::solid::Surfaces;
use squinch::watch::no_clock;
use std::path::Path;
use std::time::{Duration, Instant};
use strip::{ODD, PLAIN, counts, read_back, second_order, strip};

/// Far more than any of these files takes, on a slow machine and without optimisation.
const PATIENCE: Duration = Duration::from_secs(20);

/// What `work` gives, if it does not take for ever.
fn soon<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    assert!(start.elapsed() < PATIENCE, "{what} took {:?}", start.elapsed());
    result
}

// ---- drawings ----

/// How much a file holds, and the notes on it.
#[derive(Debug)]
struct Content {
    curves: usize,
    points: usize,
    notes: Vec<String>,
}

impl From<Drawing> for Content {
    fn from(drawing: Drawing) -> Self {
        Self { curves: drawing.curves.len(), points: drawing.points.len(), notes: drawing.notes }
    }
}

/// Reads a drawing, or surfaces: each facet counts as a curve.
fn read(bytes: &[u8], format: import::Format) -> Result<Content, ImportError> {
    soon(format.name(), || match import::read(bytes, format, "stem", &import::Options::default())? {
        import::Found::Surfaces(surfaces) => {
            let Surfaces { facets, points, notes, .. } = *surfaces;
            Ok(Content { curves: facets.len(), points: points.len(), notes })
        }
        found => section::drawn(found, &section::Options::default()).map(Into::into),
    })
}

/// A tetrahedron as triangles of an STL file.
const STL: &str = "solid corner
facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet
facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet
facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet
facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet
endsolid corner
";
/// The same as an OFF file, and as TetGen's.
const OFF: &str = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const SMESH: &str = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n4 0\n3 1 3 2\n3 1 2 4\n3 1 4 3\n3 2 3 4\n0\n0\n";

/// Whole files of a format, with their names. The compiler asks a new format for its own.
fn drawings(format: import::Format) -> Vec<(&'static str, Vec<u8>)> {
    let samples = |names: &[&'static str]| -> Vec<(&'static str, Vec<u8>)> {
        names
            .iter()
            .map(|&name| (name, std::fs::read(format!("samples/{name}")).expect("the sample is there")))
            .collect()
    };
    match format {
        import::Format::Airfoil => samples(&["naca4412.dat", "two_element.dat"]),
        import::Format::Poly => samples(&["wedges/wedge_5.poly"]),
        import::Format::Node => vec![("square.node", b"4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n".to_vec())],
        import::Format::Outline => samples(&["plate.json", "gear.json", "tangent_curves.json"]),
        import::Format::Dxf => samples(&["bracket.dxf"]),
        import::Format::Svg => samples(&["logo.svg"]),
        // A file without a face: those of tests/cad.rs are read with the feature `cad` alone.
        import::Format::Step => {
            vec![("part.step", b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n".to_vec())]
        }
        import::Format::Smesh => vec![("corner.smesh", SMESH.into())],
        import::Format::Off => vec![("corner.off", OFF.into())],
        import::Format::Stl => vec![("corner.stl", STL.into())],
    }
}

fn all_drawings() -> impl Iterator<Item = (import::Format, &'static str, Vec<u8>)> {
    import::Format::ALL
        .into_iter()
        .flat_map(|format| drawings(format).into_iter().map(move |(name, bytes)| (format, name, bytes)))
}

/// An error says what is wrong, and what can be done.
#[track_caller]
fn speaks(what: &str, help: &str, of: &str) {
    assert!(!what.is_empty() && !help.is_empty(), "{of}: {what:?}, {help:?}");
}

#[test]
fn whole_files_are_read_and_known_by_suffix_and_content() {
    for format in import::Format::ALL {
        assert!(!drawings(format).is_empty(), "{format:?} has no sample");
        assert!(!format.suffixes().is_empty(), "{format:?} has no suffix");
        for suffix in format.suffixes() {
            assert_eq!(import::format_of(Path::new(&format!("x.{suffix}"))), Some(format), "{suffix}");
        }
    }
    for (format, name, bytes) in all_drawings() {
        assert_eq!(import::format_of(Path::new(name)), Some(format), "{name}: by its suffix");
        // Rows of numbers: a .smesh without its suffix is taken for the .poly that it nearly is.
        let by_content = if format == import::Format::Smesh { import::Format::Poly } else { format };
        assert_eq!(import::Format::sniff(&bytes), Some(by_content), "{name}: by its content");
        match read(&bytes, format) {
            Ok(drawing) => assert!(drawing.curves + drawing.points > 2, "{name}"),
            Err(error) if format == import::Format::Step => speaks(&error.what, &error.help, name),
            Err(error) => panic!("{name}: {error}"),
        }
    }
}

#[test]
fn a_drawing_cut_anywhere_is_an_error_with_its_line_or_says_so() {
    for (format, name, bytes) in all_drawings().filter(|(format, ..)| *format != import::Format::Step) {
        for part in 0..25 {
            let what = format!("{name} cut at {part}/25");
            match (format, read(&bytes[..bytes.len() * part / 25], format)) {
                // Points of a section may end anywhere.
                (import::Format::Airfoil, Ok(_)) => {}
                // So may a .poly file, between its sections; it is said.
                (import::Format::Poly, Ok(drawing)) => {
                    assert!(drawing.notes.iter().any(|note| note.contains("ends before")), "{:?}", drawing.notes);
                }
                // An STL file may end after any triangle; it is said.
                (import::Format::Stl, Ok(content)) => {
                    assert!(content.notes.iter().any(|note| note.contains("cut off")), "{what}: {:?}", content.notes);
                }
                // The list of regions, the last one, may be missing.
                (import::Format::Smesh, Ok(_)) => assert_eq!(part, 24),
                // The last number of the last row loses digits.
                (import::Format::Node, Ok(drawing)) => assert_eq!(drawing.points, 4, "{what}"),
                (_, Ok(drawing)) => panic!("{what} is a drawing of {} curves", drawing.curves),
                (_, Err(error)) => {
                    // Of next to nothing there is no place to name.
                    assert!(error.line.is_some() || part < 4, "{what}: {error}");
                    speaks(&error.what, &error.help, &what);
                }
            }
        }
    }
}

#[test]
fn a_drawing_under_a_wrong_suffix_is_a_mesh_or_a_refusal() {
    let airfoil = section::Options { far_field: 2.0, ..section::Options::default() };
    let request = Request { max_vertices: 2000, timeout: Some(10.0), airfoil, ..Request::default() };
    for (format, name, bytes) in all_drawings() {
        for wrong in import::Format::ALL.into_iter().filter(|&wrong| wrong != format) {
            let what = format!("{name} as {}", wrong.name());
            let source = Source { path: name, bytes: &bytes, format: Some(wrong), nodes: None, of_many: false };
            let outcome = soon(&what, || run(&source, &request, Extent::Whole(&mut |_| true), &no_clock));
            assert_ne!(outcome.exit, Exit::Bug, "{what}: {:?}", outcome.report.failure);
            match &outcome.report.failure {
                None => assert!(outcome.mesh.is_some() || outcome.solid.is_some(), "{what}"),
                Some(failure) => speaks(&failure.what, &failure.help, &what),
            }
        }
    }
}

/// A file over and over: as long as a hundred of them, or a megabyte where it is small.
fn repeated(bytes: &[u8]) -> Vec<u8> {
    bytes.repeat((1_000_000 / bytes.len().max(1)).clamp(100, 20_000))
}

#[test]
fn a_drawing_over_and_over_is_read_or_refused_soon() {
    for (format, name, bytes) in all_drawings() {
        if let Err(error) = read(&repeated(&bytes), format) {
            speaks(&error.what, &error.help, name);
        }
    }
}

#[test]
fn other_files_are_refused_by_every_reader() {
    let noise: Vec<u8> = (0..3000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let others: [(&str, &[u8]); 8] = [
        ("nothing", b""),
        ("blanks", b" \r\n\t\n \n"),
        ("noise", &noise),
        ("zeros", &[0; 3000]),
        ("a PNG", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\x02\0\0\0\x90wS\xde"),
        ("a PDF", b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n1 0 obj\n<< /Type /Catalog >>\nendobj\n"),
        ("a ZIP", b"PK\x03\x04\x14\0\0\0\x08\0\0\0!\0"),
        ("a DWG", b"AC1032\0\0\0\0\x06\x01\0\x80\0\0\0"),
    ];
    for (what, bytes) in others {
        for format in import::Format::ALL {
            let error = read(bytes, format).expect_err(&format!("{what} is no {}", format.name()));
            speaks(&error.what, &error.help, what);
        }
        for format in meshio::Format::ALL {
            if let Err(error) = soon(what, || meshio::read(bytes, format, &[])) {
                speaks(&error.what, &error.help, what);
            }
        }
    }
}

// ---- meshes ----

/// A mesh that is given as a drawing is refused with what can be done with it: a mesh that is read here by other verbs,
/// one that is not by another program.
#[test]
fn a_mesh_is_no_drawing() {
    let refused = |name: &str, bytes: &[u8]| import::tell_format(name.as_ref(), bytes).expect_err("no drawing").help;
    for format in meshio::Format::ALL.into_iter().filter(|format| format.holds_planes()) {
        // Triangles of an STL file bound a solid, for all that is known.
        if format == meshio::Format::Stl {
            continue;
        }
        let way = if format.reading().is_some() { "verifies meshes" } else { "Gmsh or meshio" };
        let suffix = format.reading().map_or(format.suffixes()[0], |reading| reading.suffix);
        assert!(refused(&format!("mesh.{suffix}"), b"").contains(way), ".{suffix} is not in import/foreign.rs");
        let file = encode(&strip(2, PLAIN), &[], format, &WriteOptions::default()).expect("written").remove(0);
        if let Some(told) = meshio::Format::sniff(&file) {
            assert_eq!(told.reading().map(|reading| reading.suffix), Some(suffix), "{format:?}");
            assert!(
                refused("mesh", &file).contains("verifies meshes"),
                "{format:?} is not among the signs of import/foreign.rs"
            );
        }
    }
}

// ---- other writers ----

/// A square of two triangles with its lower side, by hand, in each format's other forms.
fn foreign() -> Vec<(&'static str, meshio::Format, Vec<u8>)> {
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
        ("MSH 2.2", meshio::Format::Msh, msh22.into()),
        ("MSH 4.1", meshio::Format::Msh, msh41.into()),
        ("binary MSH 2.2", meshio::Format::Msh, binary),
        ("VTK 4.2", meshio::Format::Vtk, vtk4.into()),
        ("parametric MSH 2.2", meshio::Format::Msh, parametric.into()),
        ("VTK 5.1", meshio::Format::Vtk, vtk5.into()),
        ("VTK 5.1 of meshio", meshio::Format::Vtk, meshio.into()),
        ("INP", meshio::Format::Inp, inp.into()),
        ("INP of Gmsh", meshio::Format::Inp, gmsh.into()),
        ("INP with ranges and sets of sets", meshio::Format::Inp, generated.into()),
        ("SU2", meshio::Format::Su2, su2.into()),
        ("OBJ", meshio::Format::Obj, obj.into()),
    ]
}

#[test]
fn other_writers_forms_are_read() {
    for (what, format, bytes) in foreign() {
        assert_eq!(meshio::Format::sniff(&bytes), Some(format), "{what}");
        let MeshFile { mesh, notes, .. } = meshio::read(&bytes, format, &[]).unwrap_or_else(|e| panic!("{what}: {e}"));
        let all = if format == meshio::Format::Su2 { "region" } else { "all" };
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
        meshio::read(text.as_bytes(), meshio::Format::Inp, &[])
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
        (quad, meshio::Format::Msh, "an element is a quadrilateral (Gmsh type 3)"),
        ("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", meshio::Format::Msh, "this is MSH 4.0"),
        ("NDIME= 3\n", meshio::Format::Su2, "the mesh has 3 dimensions"),
        ("NDIME= 2\nNELEM= 7\n5 0 1 2\n", meshio::Format::Su2, "line 4: the file ends 6 lines too early"),
        ("*ELEMENT, TYPE=C3D4\n", meshio::Format::Inp, "line 1: elements of type 'C3D4'"),
        ("v 0 0 0\nf 1 1 1 1\n", meshio::Format::Obj, "line 2: a face has 4 corners"),
        ("v 0 0 0\nf 1 2 3\n", meshio::Format::Obj, "a cell has the node 1, but there are 1"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n",
            meshio::Format::Obj,
            "the mesh is not flat: node 3 lies",
        ),
        ("1 3 0\n1 1 2 3\n", meshio::Format::Triangle, "there is no .node file beside the .ele file"),
        ("hello", meshio::Format::Stl, "this is not STL"),
    ] {
        let error = meshio::read(bytes.as_bytes(), format, &[]).expect_err(what);
        assert!(error.what.starts_with(what), "{} is not {what}", error.what);
        assert!(!error.help.is_empty());
    }
}

/// A format, a file of it, and the files beside that.
type Input = (meshio::Format, Vec<u8>, Vec<Option<Vec<u8>>>);

/// Files of all readers: ours, of both orders, and others'.
fn files() -> Vec<Input> {
    let mut files: Vec<_> = foreign().into_iter().map(|(_, format, bytes)| (format, bytes, Vec::new())).collect();
    for mesh in [strip(2, ODD), second_order(strip(2, PLAIN))] {
        for format in read_back() {
            let Ok(mut written) = encode(&mesh, &[], format, &WriteOptions::default()) else { continue };
            if format == meshio::Format::Triangle {
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

/// The file of an input, read with those beside it.
fn read_mesh((format, bytes, beside): &Input) -> Result<MeshFile, MeshError> {
    soon(format.name(), || meshio::read(bytes, *format, beside))
}

#[test]
fn meshes_are_known_by_suffix_and_content() {
    let suffix = |format: meshio::Format| format.reading().map(|reading| reading.suffix);
    for format in read_back() {
        let of = |name: &str| meshio::Format::to_read(Path::new(name)).and_then(suffix);
        let own = suffix(format).expect("it is read");
        assert_eq!(of(&format!("x.{own}")), Some(own), "{format:?}");
        assert_eq!(of(&format!("x.{}", own.to_uppercase())), Some(own), "{format:?}");
        assert!(files().iter().any(|(of, ..)| *of == format), "{format:?} has no file");
    }
    for input in files() {
        read_mesh(&input).unwrap_or_else(|e| panic!("{:?}: {e}", input.0));
        // Of Triangle's files, which hold numbers alone, nothing is known by content.
        if let Some(told) = meshio::Format::sniff(&input.1) {
            assert_eq!(suffix(told), suffix(input.0), "{:?}", input.0);
        } else {
            assert_eq!(input.0, meshio::Format::Triangle);
        }
    }
}

#[test]
fn a_mesh_cut_anywhere_is_less_of_a_mesh_or_an_error() {
    for (format, bytes, beside) in files() {
        let whole = read_mesh(&(format, bytes.clone(), beside.clone())).expect("a mesh").mesh;
        for part in 0..25 {
            let cut = bytes[..bytes.len() * part / 25].to_vec();
            match read_mesh(&(format, cut, beside.clone())) {
                Ok(file) => assert!(file.mesh.triangles.len() <= whole.triangles.len(), "{format:?}"),
                Err(error) => speaks(&error.what, &error.help, format.name()),
            }
        }
    }
}

#[test]
fn a_mesh_over_and_over_or_as_another_format_is_read_or_refused_soon() {
    for (format, bytes, beside) in files() {
        let mut inputs = vec![(format, repeated(&bytes), beside.clone())];
        inputs.extend(read_back().filter(|&wrong| wrong != format).map(|wrong| (wrong, bytes.clone(), beside.clone())));
        for input in inputs {
            match read_mesh(&input) {
                Ok(file) => sound(&file.mesh),
                Err(error) => speaks(&error.what, &error.help, &format!("{format:?} as {:?}", input.0)),
            }
        }
    }
}

/// Whatever is read can be verified, drawn and written.
fn sound(mesh: &Mesh) {
    for format in [meshio::Format::Vtk, meshio::Format::Inp] {
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
        if let Ok(file) = meshio::read(&bytes, format, &more) {
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
            let _ = meshio::Format::sniff(bytes);
            if let Ok(file) = meshio::read(bytes, format, &[Some(bytes.to_vec()), Some(bytes.to_vec())]) {
                sound(&file.mesh);
            }
        }
    }
}
