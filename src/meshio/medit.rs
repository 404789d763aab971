//! Medit's `.mesh` as text (Gmsh, MMG, FreeFEM, TetGen).
//!
//! The number of a region's name is the reference of its tetrahedra, the number of the name of a facet or segment that of
//! its triangles and edges, 0 without a name. A comment keeps the name of every number. Not held: the unit, the weights,
//! links to the solid.

use crate::ids::VertexId;
use crate::mesh::solid::SolidMesh;
use crate::meshio::groups::Kind;
use crate::meshio::solid_groups::Groups;
use crate::meshio::{Facts, one_file};
use std::io::{self, Write};

/// The facts of Medit's text.
pub(super) const FACTS: Facts = Facts {
    name: "medit",
    suffixes: &["mesh"],
    first_as_named: true,
    choices: &[],
    straight_only: None,
    write: None,
    write_solid: Some(|mesh, _| one_file(|out| write(mesh, out))),
    losses: |_| {},
    reading: None,
};

/// Writes a mesh.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "MeshVersionFormatted 2\n")?;
    groups.regions.write_comments(Kind::Region, out)?;
    groups.boundaries.write_comments(Kind::Boundary, out)?;
    writeln!(out, "Dimension 3\n\nVertices\n{}", mesh.nodes.len())?;
    for [x, y, z] in mesh.nodes.iter() {
        writeln!(out, "{x:?} {y:?} {z:?} 0")?;
    }
    let number = |name| groups.boundaries.number(name) + 1;
    let tetrahedra = mesh.tetrahedra.enumerate().map(|(t, nodes)| (*nodes, groups.region(mesh, t) + 1));
    cells("Tetrahedra", tetrahedra, out)?;
    cells("Triangles", mesh.triangles.iter().map(|t| (t.nodes, number(t.name))), out)?;
    cells("Edges", mesh.edges.iter().map(|e| (e.nodes, e.name.map_or(0, number))), out)?;
    writeln!(out, "\nEnd")
}

fn cells<const N: usize>(
    word: &str,
    cells: impl ExactSizeIterator<Item = ([VertexId; N], usize)>,
    out: &mut impl Write,
) -> io::Result<()> {
    if cells.len() == 0 {
        return Ok(());
    }
    writeln!(out, "\n{word}\n{}", cells.len())?;
    for (nodes, reference) in cells {
        nodes.iter().try_for_each(|v| write!(out, "{} ", v.0 + 1))?;
        writeln!(out, "{reference}")?;
    }
    Ok(())
}
