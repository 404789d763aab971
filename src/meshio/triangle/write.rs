//! Triangle's files (Shewchuk): `.node` vertices, `.ele` triangles, `.poly` segments, numbered from 1.
//!
//! The number of a region is the attribute of its triangles. The number of a boundary is the marker of its segments and
//! nodes (the first boundary of a node counts); other nodes have 0. A comment keeps the name of each number. Order 2 is
//! held: 6 nodes for a triangle, the last three opposite the corners in turn.
//!
//! Not held: the plane in space, the unit, the mid nodes of segments (those of triangles are), links to curves, balls.

use crate::ids::Id;
use crate::mesh::Mesh;
use crate::meshio::groups::{Groups, Kind};
use crate::meshio::names::name_comment;
use std::io::{self, Write};

/// Writes the vertices.
pub fn write_nodes(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let mut markers = vec![0; mesh.nodes.len()];
    for (i, edge) in mesh.edges.iter().enumerate() {
        for v in edge.nodes.iter().chain(mesh.edge_mids.get(i)) {
            if markers[v.index()] == 0 {
                markers[v.index()] = groups.boundary(edge) + 1;
            }
        }
    }
    writeln!(out, "{} 2 0 1", mesh.nodes.len())?;
    for (i, (p, marker)) in mesh.nodes.iter().zip(markers).enumerate() {
        writeln!(out, "{} {:?} {:?} {marker}", i + 1, p.x, p.y)?;
    }
    write_names(Kind::Boundary, &groups.boundaries, out)
}

/// Writes the triangles.
pub fn write_elements(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "{} {} 1", mesh.triangles.len(), if mesh.order() == 1 { 3 } else { 6 })?;
    for (t, corners) in mesh.triangles.enumerate() {
        write!(out, "{}", t.index() + 1)?;
        let opposite = mesh.triangle_mids.get(t).map(|&[ab, bc, ca]| [bc, ca, ab]);
        for v in corners.iter().chain(opposite.iter().flatten()) {
            write!(out, " {}", v.index() + 1)?;
        }
        writeln!(out, " {}", groups.region(mesh.triangle_regions[t]) + 1)?;
    }
    write_names(Kind::Region, &groups.regions, out)
}

/// Writes the segments; vertices are in the `.node` file.
pub fn write_segments(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "0 2 0 1\n{} 1", mesh.edges.len())?;
    for (i, edge) in mesh.edges.iter().enumerate() {
        let [a, b] = edge.nodes.map(|v| v.index() + 1);
        writeln!(out, "{} {a} {b} {}", i + 1, groups.boundary(edge) + 1)?;
    }
    writeln!(out, "0")?;
    write_names(Kind::Boundary, &groups.boundaries, out)
}

fn write_names(kind: Kind, names: &[&str], out: &mut impl Write) -> io::Result<()> {
    names
        .iter()
        .enumerate()
        .try_for_each(|(i, name)| writeln!(out, "# {}", name_comment(kind, &(i + 1).to_string(), name)))
}
