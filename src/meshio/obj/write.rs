//! Wavefront OBJ: a group `g` of faces for each region and one of lines `l` for each boundary. Group names are words
//! without blanks; a comment keeps the original name. Coordinates have all their digits. Cells of order 2 are written
//! as straight ones between all their nodes: four for a triangle, two for an edge.
//!
//! A `.mtl` file beside it has a material for each region, under the name of its group: the colour of the drawing, in
//! sRGB, and its opacity, else a colour of a palette. Lines have a material, too.
//!
//! VTK's reader assigns groups to wrong cells in files with lines, so lines can be left out (`lines` false).
//!
//! Not held: order 2, links to curves, balls.

use crate::ids::VertexId;
use crate::mesh::Mesh;
use crate::meshio::colours;
use crate::meshio::groups::{Groups, Kind, straight_edges, straight_triangles};
use crate::meshio::names::{legal_names, name_comment, word};
use std::io::{self, Write};

/// The material of lines, unless a region has this name.
const INK: &str = "boundary";

/// Writes the mesh, with its boundaries as lines if `lines`. `stem` is the name of the file of materials without
/// suffix; `None` where there is none.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write(mesh: &Mesh, lines: bool, stem: Option<&str>, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let materials = materials(&groups);
    writeln!(out, "# triangles by squinch")?;
    if let Some(stem) = stem {
        writeln!(out, "mtllib {stem}.mtl")?;
    }
    let paint = |material: usize, out: &mut dyn Write| match stem {
        Some(_) => writeln!(out, "usemtl {}", materials[material]),
        None => Ok(()),
    };
    if let Some(unit) = &mesh.unit {
        writeln!(out, "# unit {}", unit.replace(char::is_control, " "))?;
    }
    for [x, y, z] in mesh.places() {
        writeln!(out, "v {x:?} {y:?} {z:?}")?;
    }
    for (i, triangles) in groups.triangles().iter().enumerate() {
        begin(Kind::Region, &materials[i], groups.regions[i], out)?;
        paint(i, out)?;
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
        paint(groups.regions.len(), out)?;
        for &edge in edges {
            straight_edges(mesh, edge).try_for_each(|ends| element('l', &ends, out))?;
        }
    }
    Ok(())
}

/// Writes the materials to which [`write`] refers.
///
/// # Errors
/// As [`write`].
pub fn write_materials(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let materials = materials(&groups);
    writeln!(out, "# materials by squinch: colours in sRGB")?;
    for (i, name) in groups.regions.iter().enumerate() {
        if materials[i] != *name {
            writeln!(out, "# {}", name_comment(Kind::Region, &materials[i], name))?;
        }
        material(&materials[i], colours::srgb(mesh, name, i), out)?;
    }
    match lines && !mesh.edges.is_empty() {
        true => material(&materials[groups.regions.len()], [0.15, 0.15, 0.15, 1.0], out),
        false => Ok(()),
    }
}

/// Names of materials: those of the groups of regions, then that of lines.
fn materials(groups: &Groups) -> Vec<String> {
    let names: Vec<&str> = groups.regions.iter().copied().chain([INK]).collect();
    legal_names(&names, usize::MAX, word)
}

/// A surface without gloss: `illum 1`.
fn material(name: &str, [r, g, b, opacity]: [f64; 4], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "\nnewmtl {name}\nKa 0 0 0\nKd {r:.6} {g:.6} {b:.6}\nKs 0 0 0\nNs 1\nd {opacity:.6}\nillum 1")
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
