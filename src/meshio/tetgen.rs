//! TetGen's files: `.node`, `.ele`, `.face`, `.edge`, numbered from 1.
//!
//! The number of a region's name is the attribute of its tetrahedra; the number of the name of a facet or segment is the
//! marker of its triangles, edges and nodes (the first of a node counts), 0 without a name. A comment keeps the name of
//! every number. Not held: the unit, the weights, links to the solid.

use crate::ids::{Id, IdVec, NameId, VertexId};
use crate::mesh::solid::SolidMesh;
use crate::meshio::groups::Kind;
use crate::meshio::solid_groups::Groups;
use crate::meshio::{Facts, file};
use std::io::{self, Write};

/// The facts of TetGen's files.
pub(super) const FACTS: Facts = Facts {
    name: "tetgen",
    suffixes: &["node", "ele", "face", "edge"],
    first_as_named: false,
    choices: &[],
    straight_only: None,
    write: None,
    write_solid: Some(|mesh, _| {
        Ok(vec![
            file(|out| write_nodes(mesh, out))?,
            file(|out| write_elements(mesh, out))?,
            file(|out| write_faces(mesh, out))?,
            file(|out| write_edges(mesh, out))?,
        ])
    }),
    losses: |_| {},
    reading: None,
};

/// Writes the nodes.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write_nodes(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let mut markers: IdVec<VertexId, usize> = vec![0; mesh.nodes.len()].into();
    let mut mark = |nodes: &[VertexId], name: Option<NameId>| {
        let Some(name) = name else { return };
        for &v in nodes.iter() {
            if markers[v] == 0 {
                markers[v] = groups.boundaries.number(name) + 1;
            }
        }
    };
    mesh.triangles.iter().for_each(|t| mark(&t.nodes, Some(t.name)));
    mesh.edges.iter().for_each(|e| mark(&e.nodes, e.name));
    writeln!(out, "{} 3 0 1", mesh.nodes.len())?;
    for (i, ([x, y, z], marker)) in mesh.nodes.iter().zip(markers.iter()).enumerate() {
        writeln!(out, "{} {x:?} {y:?} {z:?} {marker}", i + 1)?;
    }
    groups.boundaries.write_comments(Kind::Boundary, out)
}

/// Writes the tetrahedra.
///
/// # Errors
/// As [`write_nodes`].
pub fn write_elements(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "{} 4 1", mesh.tetrahedra.len())?;
    for (t, corners) in mesh.tetrahedra.enumerate() {
        let [a, b, c, d] = corners.map(|v| v.0 + 1);
        writeln!(out, "{} {a} {b} {c} {d} {}", t.index() + 1, groups.region(mesh, t) + 1)?;
    }
    groups.regions.write_comments(Kind::Region, out)
}

/// Writes the triangles on facets.
///
/// # Errors
/// As [`write_nodes`].
pub fn write_faces(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "{} 1", mesh.triangles.len())?;
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = triangle.nodes.map(|v| v.0 + 1);
        writeln!(out, "{} {a} {b} {c} {}", i + 1, groups.boundaries.number(triangle.name) + 1)?;
    }
    groups.boundaries.write_comments(Kind::Boundary, out)
}

/// Writes the edges on segments.
///
/// # Errors
/// As [`write_nodes`].
pub fn write_edges(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "{} 1", mesh.edges.len())?;
    for (i, edge) in mesh.edges.iter().enumerate() {
        let [a, b] = edge.nodes.map(|v| v.0 + 1);
        writeln!(out, "{} {a} {b} {}", i + 1, edge.name.map_or(0, |name| groups.boundaries.number(name) + 1))?;
    }
    groups.boundaries.write_comments(Kind::Boundary, out)
}
