//! Legacy VTK (`.vtk`, version 3.0, binary, big-endian): triangles, then boundary lines.
//!
//! Cell arrays `region` and `boundary` number the groups from 1, 0 of cells of the other kind. Field arrays `region:NAME` and
//! `boundary:NAME` hold the number that bears the name; blanks, `%` and control characters of names are written `%20` as VTK
//! itself does. Order 2 is held (types 22 and 21).
//!
//! Not held: the unit, links to curves, balls: use VTU for those.

use super::groups::{Groups, Kind};
use crate::mesh::Mesh;
use std::io::{self, Write};

/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together or are longer than 2³¹−1.
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let (triangles, lines) = (mesh.triangles.len(), mesh.edges.len());
    let (per_triangle, per_line) = if mesh.order() == 1 { (3, 2) } else { (6, 3) };
    let size = triangles * (per_triangle + 1) + lines * (per_line + 1);
    if size.max(mesh.nodes.len()) > i32::MAX as usize {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "legacy VTK numbers no more than 2^31 - 1 corners"));
    }
    writeln!(out, "# vtk DataFile Version 3.0\ntriangles by squinch\nBINARY\nDATASET UNSTRUCTURED_GRID")?;
    write_names(&groups, out)?;
    writeln!(out, "POINTS {} double", mesh.nodes.len())?;
    let coordinates: Vec<u8> = mesh.places().flatten().flat_map(f64::to_be_bytes).collect();
    out.write_all(&coordinates)?;
    writeln!(out, "\nCELLS {} {size}", triangles + lines)?;
    let mut cells = Vec::with_capacity(size);
    for (t, corners) in mesh.triangles.enumerate() {
        cells.push(per_triangle as u32);
        cells.extend(corners.iter().chain(mesh.triangle_mids.get(t).into_iter().flatten()).map(|v| v.0));
    }
    for (i, edge) in mesh.edges.iter().enumerate() {
        cells.push(per_line as u32);
        cells.extend(edge.nodes.iter().chain(mesh.edge_mids.get(i)).map(|v| v.0));
    }
    write_words(cells, out)?;
    writeln!(out, "CELL_TYPES {}", triangles + lines)?;
    let (triangle, line) = if mesh.order() == 1 { (5, 3) } else { (22, 21) };
    write_words([vec![triangle; triangles], vec![line; lines]].concat(), out)?;
    write_cell_data(mesh, &groups, out)
}

/// The names with their numbers, as fields of the whole data set.
fn write_names(groups: &Groups, out: &mut impl Write) -> io::Result<()> {
    let count = groups.regions.len() + groups.boundaries.len();
    if count > 0 {
        writeln!(out, "FIELD FieldData {count}")?;
    }
    for (kind, names) in [(Kind::Region, &groups.regions), (Kind::Boundary, &groups.boundaries)] {
        for (number, name) in (1..).zip(names) {
            writeln!(out, "{}:{} 1 1 int", kind.word(), encoded(name))?;
            write_words(vec![number], out)?;
        }
    }
    Ok(())
}

/// A name as a word: what would end it is written by its bytes.
fn encoded(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        if c.is_whitespace() || c.is_control() || matches!(c, '%' | '"') {
            c.encode_utf8(&mut [0; 4]).bytes().for_each(|byte| text.push_str(&format!("%{byte:02X}")));
        } else {
            text.push(c);
        }
    }
    text
}

fn write_cell_data(mesh: &Mesh, groups: &Groups, out: &mut impl Write) -> io::Result<()> {
    let (triangles, lines) = (mesh.triangles.len(), mesh.edges.len());
    let regions = mesh.triangle_regions.iter().map(|&r| groups.region(r) as u32 + 1);
    let boundaries = mesh.edges.iter().map(|e| groups.boundary(e) as u32 + 1);
    writeln!(out, "CELL_DATA {}\nFIELD FieldData 2\nregion 1 {} int", triangles + lines, triangles + lines)?;
    write_words(regions.chain(std::iter::repeat_n(0, lines)).collect(), out)?;
    writeln!(out, "boundary 1 {} int", triangles + lines)?;
    write_words(std::iter::repeat_n(0, triangles).chain(boundaries).collect(), out)
}

fn write_words(words: Vec<u32>, out: &mut impl Write) -> io::Result<()> {
    let bytes: Vec<u8> = words.into_iter().flat_map(u32::to_be_bytes).collect();
    out.write_all(&bytes)?;
    writeln!(out)
}
