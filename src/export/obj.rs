//! Wavefront OBJ: a group `g` of faces for every region and one of lines `l` for every boundary. Group names are words without
//! blanks; a comment keeps what a name was. Coordinates have all their digits. Cells of order 2 are written as straight ones
//! between all their nodes: four a triangle, two an edge.
//!
//! VTK's reader sets groups on the wrong cells beside lines: they can be left out (`lines` false).
//!
//! Not held: order 2, the unit (a comment says it), links to curves, balls.

use super::groups::{Groups, Kind, legal_names, name_comment, straight_edges, straight_triangles, word};
use crate::ids::VertexId;
use crate::mesh::Mesh;
use std::io::{self, Write};

/// Writes the mesh, its boundaries as lines where asked for.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "# triangles by squinch")?;
    if let Some(unit) = &mesh.unit {
        writeln!(out, "# unit {}", unit.replace(char::is_control, " "))?;
    }
    for [x, y, z] in mesh.places() {
        writeln!(out, "v {x:?} {y:?} {z:?}")?;
    }
    let regions = legal_names(&groups.regions, usize::MAX, word);
    for (i, triangles) in groups.triangles().iter().enumerate() {
        begin(Kind::Region, &regions[i], groups.regions[i], out)?;
        for &t in triangles {
            straight_triangles(mesh, t).try_for_each(|corners| element('f', &corners, out))?;
        }
    }
    if !lines {
        return Ok(());
    }
    let boundaries = legal_names(&groups.boundaries, usize::MAX, word);
    for (i, edges) in groups.edges().iter().enumerate() {
        begin(Kind::Boundary, &boundaries[i], groups.boundaries[i], out)?;
        for &edge in edges {
            straight_edges(mesh, edge).try_for_each(|ends| element('l', &ends, out))?;
        }
    }
    Ok(())
}

fn begin(kind: Kind, legal: &str, name: &str, out: &mut impl Write) -> io::Result<()> {
    if legal != name {
        writeln!(out, "# {}", name_comment(kind, legal, name))?;
    }
    writeln!(out, "g {legal}")
}

fn element(letter: char, nodes: &[VertexId], out: &mut impl Write) -> io::Result<()> {
    write!(out, "{letter}")?;
    nodes.iter().try_for_each(|v| write!(out, " {}", v.0 + 1))?;
    writeln!(out)
}
