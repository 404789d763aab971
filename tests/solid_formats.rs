//! What the writers of tetrahedral meshes write. The files stay in the tests' directory, for readers of others.

use squinch::ids::{FacetId, NameId, PointId, RegionId, SegmentId, VertexId};
use squinch::mesh::solid::{FacetTriangle, SegmentEdge, SolidMesh};
use squinch::meshio::{Format, encode_solid};
use std::io;
use std::path::Path;

/// Two tetrahedra of two regions, a named facet between them, and a named segment.
fn pair() -> SolidMesh {
    let mut mesh = SolidMesh {
        nodes: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1, 0.2, -1.0 / 3.0]].into(),
        weights: vec![0.0, 1e-9, 0.0, 2e-9, 0.0].into(),
        tetrahedra: [[0, 1, 2, 3], [0, 2, 1, 4]].iter().map(|t| t.map(VertexId)).collect(),
        tetrahedron_regions: vec![RegionId(0), RegionId(1)].into(),
        points: (0..5).map(|i| (PointId(i), VertexId(i))).collect(),
        unit: Some("mm".into()),
        ..SolidMesh::default()
    };
    let name = |mesh: &mut SolidMesh, text: &str| -> NameId { mesh.names.intern(text) };
    for text in ["upper \"half\"", "lower half"] {
        let id = name(&mut mesh, text);
        mesh.regions.push(id);
    }
    let triangles =
        [[0, 1, 2], [1, 2, 3], [0, 3, 2], [0, 1, 3], [1, 4, 2], [0, 2, 4], [0, 4, 1]].map(|t| t.map(VertexId));
    for (f, nodes) in triangles.into_iter().enumerate() {
        let name = name(
            &mut mesh,
            if f == 0 {
                "between: both"
            } else if f < 4 {
                "above"
            } else {
                "below"
            },
        );
        mesh.triangles.push(FacetTriangle { nodes, name, facet: Some(FacetId(f as u32)) });
    }
    let ridge = name(&mut mesh, "ridge");
    for (s, (nodes, name)) in [([0, 1], Some(ridge)), ([1, 2], None)].into_iter().enumerate() {
        mesh.edges.push(SegmentEdge { nodes: nodes.map(VertexId), name, segment: Some(SegmentId(s as u32)) });
    }
    mesh
}

/// The files that a format has of the pair, kept as files, as text.
fn written(name: &str, format: Format) -> Vec<String> {
    written_with(name, format, &[])
}

fn written_with(name: &str, format: Format, stamps: &[(String, String)]) -> Vec<String> {
    let mesh = pair();
    let files = encode_solid(&mesh, stamps, format).expect("the mesh is sound");
    assert_eq!(files, encode_solid(&mesh, stamps, format).expect("the mesh is sound"));
    let mut broken = mesh;
    broken.tetrahedra.push([VertexId(9); 4]);
    let error = encode_solid(&broken, stamps, format).expect_err("an id leads nowhere");
    assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
    for (suffix, bytes) in format.suffixes().iter().zip(&files) {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.{suffix}"));
        std::fs::write(path, bytes).expect("the folder is there");
    }
    files.iter().map(|bytes| String::from_utf8_lossy(bytes).into_owned()).collect()
}

#[test]
fn vtu_names_what_it_holds() {
    let stamps = [("engine".to_owned(), "none".to_owned())];
    let text = written_with("pair", Format::Vtu, &stamps).remove(0);
    assert!(text.contains("NumberOfPoints=\"5\" NumberOfCells=\"11\""));
    for name in ["region:upper &quot;half&quot;", "boundary:ridge", "weight", "facet", "segment", "squinch:engine"] {
        assert!(text.contains(&format!("Name=\"{name}\"")), "{name} in {text}");
    }
}

#[test]
fn msh_groups_every_cell() {
    let text = written("pair22", Format::Msh22).remove(0);
    assert!(text.contains("$PhysicalNames\n6\n1 6 \"ridge\"\n2 3 \"between: both\"\n"), "{text}");
    // The edge without a name is in no group, and so not there.
    assert!(text.contains("$Elements\n10\n1 1 2 6 6 1 2\n2 2 2 3 3 1 2 3\n"), "{text}");
    assert!(text.contains("\n10 4 2 2 2 1 3 2 5\n$EndElements\n"), "{text}");
    assert!(written("pair", Format::Msh)[0].starts_with("$MeshFormat\n4.1 1 8\n"));
}

#[test]
fn tetgen_has_four_files() {
    let files = written("pair", Format::Tetgen);
    let node = &files[0];
    assert!(node.starts_with("5 3 0 1\n1 0.0 0.0 0.0 1\n") && node.ends_with("# name boundary 4 = ridge\n"), "{node}");
    let ele = &files[1];
    assert!(ele.starts_with("2 4 1\n1 1 2 3 4 1\n2 1 3 2 5 2\n"), "{ele}");
    let face = &files[2];
    assert!(face.starts_with("7 1\n1 1 2 3 1\n2 2 3 4 2\n"), "{face}");
    let edge = &files[3];
    assert!(edge.starts_with("2 1\n1 1 2 4\n2 2 3 0\n"), "{edge}");
}

#[test]
fn medit_refers_to_groups() {
    let text = written("pair", Format::Medit).remove(0);
    assert!(text.contains("\nTetrahedra\n2\n1 2 3 4 1\n1 3 2 5 2\n\nTriangles\n7\n1 2 3 1\n"), "{text}");
    assert!(text.ends_with("\nEdges\n2\n1 2 4\n2 3 0\n\nEnd\n"), "{text}");
}

#[test]
fn inp_has_surfaces() {
    let text = written("pair", Format::Inp).remove(0);
    assert!(text.contains("*ELEMENT, TYPE=C3D4, ELSET=lower_half\n2, 1, 3, 2, 5\n"), "{text}");
    // Behind the facet between both is what lies below: its face of corners 1, 2 and 3.
    assert!(text.contains("*SURFACE, NAME=between__both, TYPE=ELEMENT\n2, S1\n*NSET"), "{text}");
    assert!(text.contains("*SURFACE, NAME=above, TYPE=ELEMENT\n1, S3\n1, S4\n1, S2\n"), "{text}");
    assert!(text.ends_with("*NSET, NSET=ridge\n1, 2\n"), "{text}");
}

#[test]
fn su2_marks_the_rim() {
    let text = written("pair", Format::Su2).remove(0);
    assert!(text.starts_with("NDIME= 3\nNELEM= 2\n10 0 1 2 3 0\n10 0 2 1 4 1\nNPOIN= 5\n"), "{text}");
    // As seen from outside; what lies between two regions is in no marker.
    assert!(text.contains("NMARK= 2\nMARKER_TAG= above\nMARKER_ELEMS= 3\n5 1 2 3\n5 0 3 2\n5 0 1 3\n"), "{text}");
}

#[test]
fn other_formats_refuse_tetrahedra_and_name_those_that_hold_them() {
    for format in Format::ALL.into_iter().filter(|format| !format.holds_solids()) {
        let error = encode_solid(&pair(), &[], format).expect_err("it holds none");
        assert_eq!(error.kind(), io::ErrorKind::Unsupported);
        assert!(error.to_string().contains("vtu"), "{error}");
    }
}
