//! SU2's native mesh, in two dimensions.
//!
//! Each edge with a triangle on one side only is in exactly one marker: that of its boundary, or `boundary` where the
//! mesh has no name for it. Edges between two kept regions are in none, because a marker of SU2 is a border of the
//! flow. Order 2 is refused: SU2 has straight cells only.
//!
//! A configuration must be able to name each marker. SU2 splits values at blanks and `( ) { } : ,`, and lines at `=`
//! and `;`; it begins a comment at `%`, continues a line after `\` and reads `NONE` as no marker. These characters
//! become `_` in tags (`NONE` becomes `NONE_`). Tags differ not only in case. A comment keeps the original name.
//!
//! Not held: regions (SU2 has one zone), the names of interfaces, the unit, the plane in space, links to curves, balls.

use crate::ids::VertexId;
use crate::mesh::Mesh;
use crate::meshio::groups::{Groups, Kind, sides, undirected};
use crate::meshio::names::{legal_names, name_comment, word};
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Name of edges on the border for which the mesh has no name.
const UNNAMED: &str = "boundary";

/// Writes the mesh.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the lists of the mesh do not fit together.
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "NDIME= 2\nNELEM= {}", mesh.triangles.len())?;
    for (i, [a, b, c]) in mesh.triangles.iter().enumerate() {
        writeln!(out, "5 {} {} {} {i}", a.0, b.0, c.0)?;
    }
    writeln!(out, "NPOIN= {}", mesh.nodes.len())?;
    for (i, p) in mesh.nodes.iter().enumerate() {
        writeln!(out, "{:?} {:?} {i}", p.x, p.y)?;
    }
    let markers = markers(mesh, &groups);
    let names: Vec<&str> = markers.iter().map(|(name, _)| *name).collect();
    let legal = legal_names(&names, usize::MAX, tag);
    writeln!(out, "NMARK= {}", markers.len())?;
    for ((name, edges), legal) in markers.iter().zip(&legal) {
        if legal != name {
            writeln!(out, "% {}", name_comment(Kind::Boundary, legal, name))?;
        }
        writeln!(out, "MARKER_TAG= {legal}\nMARKER_ELEMS= {}", edges.len())?;
        for [a, b] in edges {
            writeln!(out, "3 {} {}", a.0, b.0)?;
        }
    }
    Ok(())
}

/// A name as a marker's tag that a configuration can hold.
pub fn tag(name: &str) -> String {
    let cut = |c: char| matches!(c, '(' | ')' | '{' | '}' | ':' | ',' | '=' | ';' | '%' | '\\' | '|');
    let tag = word(name).replace(cut, "_");
    if tag.eq_ignore_ascii_case("NONE") { format!("{tag}_") } else { tag }
}

/// The edges on the border by boundary, each in the direction of its triangle: the domain is on the left.
fn markers<'m>(mesh: &Mesh, groups: &Groups<'m>) -> Vec<(&'m str, Vec<[VertexId; 2]>)> {
    let mut rim: BTreeMap<[VertexId; 2], [VertexId; 2]> = BTreeMap::new();
    for (edge, triangles) in sides(mesh) {
        if let [(t, side)] = triangles[..] {
            rim.insert(edge, [mesh.triangles[t][side], mesh.triangles[t][(side + 1) % 3]]);
        }
    }
    let mut markers: Vec<(&str, Vec<_>)> = groups.boundaries.iter().map(|name| (*name, Vec::new())).collect();
    for edge in &mesh.edges {
        if let Some(directed) = rim.remove(&undirected(edge.nodes)) {
            markers[groups.boundary(edge)].1.push(directed);
        }
    }
    if !rim.is_empty() {
        let unnamed = rim.into_values();
        match markers.iter_mut().find(|(name, _)| *name == UNNAMED) {
            Some((_, edges)) => edges.extend(unnamed),
            None => markers.push((UNNAMED, unnamed.collect())),
        }
    }
    markers.retain(|(_, edges)| !edges.is_empty());
    markers
}
