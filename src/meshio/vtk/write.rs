//! Legacy VTK (`.vtk`, version 3.0): triangles, then boundary lines; binary (big-endian) or as text.
//!
//! Cell arrays `region` and `boundary` number the groups from 1; cells of the other kind have 0. Field arrays
//! `region:NAME` and `boundary:NAME` hold the number of the name. Blanks, `%` and control characters of names are
//! written as `%20`, as VTK does. Order 2 is held (types 22 and 21).
//!
//! The fields follow `CELL_TYPES`. Before `POINTS`, Gmsh (4.15) and FreeFEM (4.11) refuse the file and meshio (5.3)
//! loses the names. As data of cells they would need a value for each cell.
//!
//! MFEM (4.10), deal.II (9.4) and Gmsh read text only. MFEM also refuses lines beside triangles, so text has none
//! unless asked for. Then a field array `boundary:NAME` is a list of edges, each of the nodes at its ends (for order 2,
//! also of the one within). MFEM takes its attributes from the array `material`, which must be the first. deal.II takes
//! material ids, and with lines boundary ids, from `MaterialID`. Both arrays hold the number of the region; numbers of
//! boundaries follow those of regions. Gmsh and FreeFEM read the cells, but no array of them.
//!
//! Not held: the unit, links to curves, balls: use VTU for those. deal.II has no cells of order 2.

use crate::ids::VertexId;
use crate::mesh::Mesh;
use crate::meshio::groups::{Groups, Kind};
use std::io::{self, Write};

/// Writes binary VTK.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together or are longer than 2³¹−1.
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let mut file = File { mesh, groups: Groups::of(mesh)?, lines: mesh.edges.len(), text: false, out };
    file.grid()?;
    file.names()?;
    file.cell_data("FIELD FieldData 2", &[Array::Region, Array::Boundary])
}

/// Writes text, with boundaries as lines if `lines`, else as field arrays.
///
/// # Errors
/// As [`write`].
pub fn write_text(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
    let lines = if lines { mesh.edges.len() } else { 0 };
    let mut file = File { mesh, groups: Groups::of(mesh)?, lines, text: true, out };
    file.grid()?;
    file.names()?;
    file.cell_data("", &[Array::Group("material"), Array::Group("MaterialID"), Array::Region, Array::Boundary])
}

/// An array with a number for every cell.
#[derive(Clone, Copy)]
enum Array {
    Region,
    Boundary,
    /// An array of this name with the number of the region or, after those, of the boundary.
    Group(&'static str),
}

struct File<'a, W> {
    mesh: &'a Mesh,
    groups: Groups<'a>,
    /// Number of edges that are cells: all or none.
    lines: usize,
    text: bool,
    out: &'a mut W,
}

impl<W: Write> File<'_, W> {
    fn grid(&mut self) -> io::Result<()> {
        let (mesh, lines, triangles) = (self.mesh, self.lines, self.mesh.triangles.len());
        let (per_triangle, per_line) = if mesh.order() == 1 { (3, 2) } else { (6, 3) };
        let size = triangles * (per_triangle + 1) + lines * (per_line + 1);
        if size.max(mesh.nodes.len()) > i32::MAX as usize {
            return Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                "legacy VTK numbers no more than 2^31 - 1 corners",
            ));
        }
        let form = if self.text { "ASCII" } else { "BINARY" };
        writeln!(self.out, "# vtk DataFile Version 3.0\ntriangles by squinch\n{form}\nDATASET UNSTRUCTURED_GRID")?;
        writeln!(self.out, "POINTS {} double", mesh.nodes.len())?;
        self.places()?;
        writeln!(self.out, "CELLS {} {size}", triangles + lines)?;
        for (t, corners) in mesh.triangles.enumerate() {
            let mids = mesh.triangle_mids.get(t).into_iter().flatten();
            self.words(std::iter::once(per_triangle as u32).chain(corners.iter().chain(mids).map(|v| v.0)))?;
        }
        for edge in 0..lines {
            self.words(std::iter::once(per_line as u32).chain(nodes_of_edge(mesh, edge).map(|v| v.0)))?;
        }
        self.end()?;
        writeln!(self.out, "CELL_TYPES {}", triangles + lines)?;
        let (triangle, line) = if mesh.order() == 1 { (5, 3) } else { (22, 21) };
        self.column(std::iter::repeat_n(triangle, triangles).chain(std::iter::repeat_n(line, lines)))
    }

    fn places(&mut self) -> io::Result<()> {
        for [x, y, z] in self.mesh.places() {
            match self.text {
                true => writeln!(self.out, "{x:?} {y:?} {z:?}")?,
                false => [x, y, z].into_iter().try_for_each(|v| self.out.write_all(&v.to_be_bytes()))?,
            }
        }
        self.end()
    }

    /// Writes the names as fields of the data set, with their numbers, or with their edges where edges are not cells.
    fn names(&mut self) -> io::Result<()> {
        let (regions, boundaries) = (self.groups.regions.clone(), self.groups.boundaries.clone());
        if regions.len() + boundaries.len() > 0 {
            writeln!(self.out, "FIELD FieldData {}", regions.len() + boundaries.len())?;
        }
        for (number, name) in (1..).zip(regions) {
            self.name(Kind::Region, name, number)?;
        }
        if self.lines == self.mesh.edges.len() {
            return (1..).zip(boundaries).try_for_each(|(number, name)| self.name(Kind::Boundary, name, number));
        }
        let nodes = if self.mesh.order() == 1 { 2 } else { 3 };
        for (edges, name) in self.groups.edges().iter().zip(boundaries) {
            writeln!(self.out, "{}:{} {nodes} {} int", Kind::Boundary.word(), encoded(name), edges.len())?;
            for &edge in edges {
                self.words(nodes_of_edge(self.mesh, edge).map(|v| v.0))?;
            }
            self.end()?;
        }
        Ok(())
    }

    fn name(&mut self, kind: Kind, name: &str, number: u32) -> io::Result<()> {
        writeln!(self.out, "{}:{} 1 1 int", kind.word(), encoded(name))?;
        self.column(std::iter::once(number))
    }

    /// Writes arrays of the cells: in one field if it has a header, else each by itself.
    fn cell_data(&mut self, field: &str, arrays: &[Array]) -> io::Result<()> {
        let (mesh, lines) = (self.mesh, self.lines);
        let cells = mesh.triangles.len() + lines;
        writeln!(self.out, "CELL_DATA {cells}")?;
        if !field.is_empty() {
            writeln!(self.out, "{field}")?;
        }
        let regions: Vec<u32> = mesh.triangle_regions.iter().map(|&r| self.groups.region(r) as u32 + 1).collect();
        let boundaries: Vec<u32> = mesh.edges[..lines].iter().map(|e| self.groups.boundary(e) as u32 + 1).collect();
        let above = self.groups.regions.len() as u32;
        for &array in arrays {
            let (name, numbers) = match array {
                Array::Region => ("region", [regions.clone(), vec![0; lines]]),
                Array::Boundary => ("boundary", [vec![0; regions.len()], boundaries.clone()]),
                Array::Group(name) => (name, [regions.clone(), boundaries.iter().map(|b| b + above).collect()]),
            };
            match field.is_empty() {
                true => writeln!(self.out, "SCALARS {name} int 1\nLOOKUP_TABLE default")?,
                false => writeln!(self.out, "{name} 1 {cells} int")?,
            }
            self.column(numbers.into_iter().flatten())?;
        }
        Ok(())
    }

    /// Writes numbers that belong together; in text, on one line.
    fn words(&mut self, mut words: impl Iterator<Item = u32>) -> io::Result<()> {
        if !self.text {
            return words.try_for_each(|word| self.out.write_all(&word.to_be_bytes()));
        }
        let words: Vec<String> = words.map(|word| word.to_string()).collect();
        writeln!(self.out, "{}", words.join(" "))
    }

    /// Writes an array of single numbers.
    fn column(&mut self, mut words: impl Iterator<Item = u32>) -> io::Result<()> {
        words.try_for_each(|word| self.words(std::iter::once(word)))?;
        self.end()
    }

    /// Ends an array. Binary data are followed by a line end.
    fn end(&mut self) -> io::Result<()> {
        if self.text { Ok(()) } else { writeln!(self.out) }
    }
}

fn nodes_of_edge(mesh: &Mesh, edge: usize) -> impl Iterator<Item = VertexId> {
    mesh.edges[edge].nodes.into_iter().chain(mesh.edge_mids.get(edge).copied())
}

/// A name as a word. Characters that would end it are written by their bytes.
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
