//! Abaqus' and CalculiX's input deck of tetrahedra C3D4, to be included in a deck (`*INCLUDE`).
//!
//! Each name of regions is an `ELSET`. Each name of facets is an `NSET` and a `SURFACE` of element faces, of an interface
//! those behind the facet; each name of segments is an `NSET`. Names and numbers are made legal as in the plane, and a
//! comment keeps what a name was. Not held: the unit (a comment says it), the weights, links to the solid.

use super::write::{LONGEST_NAME, number};
use crate::ids::{Id, TetId, VertexId};
use crate::mesh::solid::SolidMesh;
use crate::meshio::groups::Kind;
use crate::meshio::names::{identifier, legal_names, name_comment};
use crate::meshio::solid_groups::{FACES, Groups, by_group, tetrahedra_at};
use std::collections::BTreeSet;
use std::io::{self, Write};

/// The face opposite each corner, as the format numbers them: S1 has the corners 1 2 3, S2 1 4 2, S3 2 4 3, S4 3 4 1.
const SURFACES: [usize; 4] = [3, 4, 2, 1];

/// Writes a mesh.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let regions = legal_names(&groups.regions.texts, LONGEST_NAME, identifier);
    let boundaries = legal_names(&groups.boundaries.texts, LONGEST_NAME, identifier);
    writeln!(out, "** tetrahedra by squinch")?;
    if let Some(unit) = &mesh.unit {
        writeln!(out, "** unit {}", unit.replace(char::is_control, " "))?;
    }
    for (kind, legal, names) in
        [(Kind::Region, &regions, &groups.regions), (Kind::Boundary, &boundaries, &groups.boundaries)]
    {
        for (legal, name) in legal.iter().zip(&names.texts).filter(|(legal, name)| legal != *name) {
            writeln!(out, "** {}", name_comment(kind, legal, name))?;
        }
    }
    writeln!(out, "*NODE")?;
    for (i, place) in mesh.nodes.iter().enumerate() {
        let [x, y, z] = place.map(number);
        writeln!(out, "{}, {x}, {y}, {z}", i + 1)?;
    }
    let cells = by_group(regions.len(), mesh.tetrahedra.ids().map(|t| Some(groups.region(mesh, t))));
    for (cells, name) in cells.iter().zip(&regions).filter(|(cells, _)| !cells.is_empty()) {
        writeln!(out, "*ELEMENT, TYPE=C3D4, ELSET={name}")?;
        for &t in cells {
            let [a, b, c, d] = mesh.tetrahedra.as_slice()[t].map(|v| v.0 + 1);
            writeln!(out, "{}, {a}, {b}, {c}, {d}", t + 1)?;
        }
    }
    write_boundaries(mesh, &groups, &boundaries, out)
}

fn write_boundaries(mesh: &SolidMesh, groups: &Groups, names: &[String], out: &mut impl Write) -> io::Result<()> {
    let of_triangle = mesh.triangles.iter().map(|t| Some(groups.boundaries.number(t.name)));
    let of_edge = mesh.edges.iter().map(|e| e.name.map(|name| groups.boundaries.number(name)));
    let (triangles, edges) = (by_group(names.len(), of_triangle), by_group(names.len(), of_edge));
    let tetrahedra = tetrahedra_at(mesh);
    for (name, (triangles, edges)) in names.iter().zip(triangles.iter().zip(&edges)) {
        let corners = triangles.iter().flat_map(|&i| mesh.triangles[i].nodes);
        let nodes: BTreeSet<VertexId> = corners.chain(edges.iter().flat_map(|&i| mesh.edges[i].nodes)).collect();
        writeln!(out, "*NSET, NSET={name}")?;
        let nodes: Vec<String> = nodes.iter().map(|v| (v.index() + 1).to_string()).collect();
        for line in nodes.chunks(16) {
            writeln!(out, "{}", line.join(", "))?;
        }
        let faces: Vec<(TetId, usize)> =
            triangles.iter().filter_map(|&i| behind(mesh, mesh.triangles[i].nodes, &tetrahedra[i])).collect();
        if !faces.is_empty() {
            writeln!(out, "*SURFACE, NAME={name}, TYPE=ELEMENT")?;
            for (t, corner) in faces {
                writeln!(out, "{}, S{}", t.index() + 1, SURFACES[corner])?;
            }
        }
    }
    Ok(())
}

/// The tetrahedron behind a facet triangle, from which its front faces away; else the one in front.
fn behind(mesh: &SolidMesh, nodes: [VertexId; 3], tetrahedra: &[(TetId, usize)]) -> Option<(TetId, usize)> {
    let faces_away = |&&(t, corner): &&(TetId, usize)| {
        let outward = FACES[corner].map(|i| mesh.tetrahedra[t][i]);
        (0..3).any(|k| outward == [nodes[k], nodes[(k + 1) % 3], nodes[(k + 2) % 3]])
    };
    tetrahedra.iter().find(faces_away).or(tetrahedra.first()).copied()
}
