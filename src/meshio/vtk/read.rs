//! Legacy VTK (`.vtk`), text or binary: unstructured grids of versions up to 4 (`CELLS` with sizes) and of 5.1
//! (`OFFSETS`, `CONNECTIVITY`, also with meshio's number types). Groups are read as in VTU: from the first of
//! [`FOREIGN`] among the integer cell arrays, with our own names from field arrays.

use crate::geometry::written::number;
use crate::meshio::draft::{BOUNDARY, Draft, FOREIGN, REGION};
use crate::meshio::{MeshFile, Result, broken, text, unsupported};
use std::collections::BTreeMap;

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut words = Words { bytes, at: 0, binary: false };
    if !words.line().starts_with(b"# vtk DataFile") {
        return Err(broken("the file does not begin with '# vtk DataFile'"));
    }
    words.line();
    words.binary = match text(words.line()).to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        other => return Err(broken(format!("the file is neither ASCII nor BINARY but '{other}'"))),
    };
    let mut grid = Grid::default();
    while let Some(line) = words.keyword() {
        grid.section(&line, &mut words)?;
    }
    grid.finish()
}

struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    binary: bool,
}

impl<'a> Words<'a> {
    fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    fn line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let end = rest.iter().position(|&b| b == b'\n').map_or(rest.len(), |n| n + 1);
        self.at += end;
        rest[..end].trim_ascii()
    }

    /// The words of the next line that is not empty.
    fn keyword(&mut self) -> Option<Vec<String>> {
        while !self.rest().is_empty() {
            let line = self.line();
            if !line.is_empty() {
                return Some(text(line).split_ascii_whitespace().map(str::to_owned).collect());
            }
        }
        None
    }

    /// `count` numbers of a VTK type.
    fn numbers(&mut self, count: usize, kind: &str) -> Result<Vec<f64>> {
        let short = || broken(format!("the file ends within an array of {count} {kind}"));
        let size = match kind {
            "char" | "unsigned_char" | "signed_char" | "vtktypeint8" | "vtktypeuint8" => 1,
            "short" | "unsigned_short" | "vtktypeint16" | "vtktypeuint16" => 2,
            "int" | "unsigned_int" | "float" | "vtktypeint32" | "vtktypeuint32" => 4,
            "long" | "unsigned_long" | "double" | "vtktypeint64" | "vtktypeuint64" | "vtkidtype" => 8,
            _ => return Err(unsupported(format!("an array is of '{kind}'"), "save it with plain numbers")),
        };
        if !self.binary {
            // A number takes at least two bytes with its blank.
            if count > self.rest().len() {
                return Err(short());
            }
            return (0..count).map(|_| self.word().ok_or_else(short)).collect();
        }
        let bytes = count.checked_mul(size).and_then(|n| self.rest().get(..n)).ok_or_else(short)?;
        self.at += bytes.len();
        let value = |word: &[u8]| {
            let bits = word.iter().fold(0_u64, |bits, &b| bits << 8 | u64::from(b));
            let unused = 64 - 8 * size as u32;
            match kind {
                "float" => f64::from(f32::from_bits(bits as u32)),
                "double" => f64::from_bits(bits),
                _ if kind.starts_with("unsigned") || kind.starts_with("vtktypeuint") => bits as f64,
                _ => (((bits << unused) as i64) >> unused) as f64,
            }
        };
        Ok(bytes.chunks_exact(size).map(value).collect())
    }

    fn word(&mut self) -> Option<f64> {
        let rest = self.rest();
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        self.at += start + length;
        number(&rest[start..start + length])
    }
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Of {
    #[default]
    All,
    Points,
    Cells,
}

#[derive(Default)]
struct Grid {
    points: Vec<f64>,
    /// The nodes of all cells, one cell after the other, and the end of each cell.
    corners: Vec<f64>,
    ends: Vec<f64>,
    types: Vec<f64>,
    data: BTreeMap<String, Vec<f64>>,
    /// Fields of the whole data set: names, components, values.
    fields: Vec<(String, usize, Vec<f64>)>,
    of: Of,
    cells: usize,
}

impl Grid {
    fn section(&mut self, line: &[String], words: &mut Words) -> Result<()> {
        let count = |i: usize| -> Result<usize> {
            let count = line.get(i).and_then(|word| word.parse().ok());
            count.ok_or_else(|| broken(format!("'{}' has no count", line.join(" "))))
        };
        let kind = |i: usize| line.get(i).map(|word| word.to_ascii_lowercase()).unwrap_or_default();
        match line[0].to_ascii_uppercase().as_str() {
            "DATASET" if kind(1) != "unstructured_grid" => {
                return Err(unsupported(format!("the file holds {}", kind(1)), "save it as UNSTRUCTURED_GRID"));
            }
            "POINTS" => self.points = words.numbers(count(1)?.saturating_mul(3), &kind(2))?,
            "CELLS" => self.cells(count(1)?, count(2)?, words)?,
            "CELL_TYPES" => self.types = words.numbers(count(1)?, "int")?,
            "POINT_DATA" => self.of = Of::Points,
            "CELL_DATA" => (self.of, self.cells) = (Of::Cells, count(1)?),
            "FIELD" => {
                for _ in 0..count(2)? {
                    let line = words.keyword().ok_or_else(|| broken("the file ends within a field"))?;
                    let [name, components, tuples, kind] = line.as_slice() else {
                        return Err(broken(format!("'{}' is not a field array", line.join(" "))));
                    };
                    let sizes = [components, tuples].map(|word| word.parse::<usize>().unwrap_or(usize::MAX));
                    let values = words.numbers(sizes[0].saturating_mul(sizes[1]), &kind.to_ascii_lowercase())?;
                    self.keep(decoded(name), sizes[0], values);
                }
            }
            "SCALARS" if self.of == Of::Cells => {
                let components = if line.len() > 3 { count(3)? } else { 1 };
                words.line(); // LOOKUP_TABLE
                let values = words.numbers(self.cells.saturating_mul(components), &kind(2))?;
                self.keep(decoded(&line[1]), components, values);
            }
            _ => {}
        }
        Ok(())
    }

    fn keep(&mut self, name: String, components: usize, values: Vec<f64>) {
        match self.of {
            Of::All => self.fields.push((name, components, values)),
            Of::Cells => drop(self.data.insert(name, values)),
            Of::Points => {}
        }
    }

    fn cells(&mut self, count: usize, size: usize, words: &mut Words) -> Result<()> {
        let before = words.at;
        let next = words.keyword();
        if let Some([word, kind]) = next.as_deref()
            && word.eq_ignore_ascii_case("OFFSETS")
        {
            // Version 5.1 has one offset more than cells.
            let offsets = words.numbers(count, &kind.to_ascii_lowercase())?;
            self.ends = offsets.get(1..).unwrap_or_default().to_vec();
            let line = words.keyword().unwrap_or_default();
            let kind = line.get(1).map(|kind| kind.to_ascii_lowercase()).unwrap_or_default();
            self.corners = words.numbers(size, &kind)?;
            return Ok(());
        }
        words.at = before;
        let list = words.numbers(size, "int")?;
        let mut at = 0;
        for _ in 0..count {
            let corners = list.get(at).filter(|n| **n >= 0.0).map(|n| *n as usize);
            let corners = corners.and_then(|n| list.get(at + 1..at.checked_add(n)?.checked_add(1)?));
            let corners = corners.ok_or_else(|| broken("the list of cells is too short"))?;
            at += corners.len() + 1;
            self.corners.extend(corners);
            self.ends.push(self.corners.len() as f64);
        }
        Ok(())
    }

    fn finish(self) -> Result<MeshFile> {
        if self.types.len() != self.ends.len() {
            return Err(broken(format!("there are {} types for {} cells", self.types.len(), self.ends.len())));
        }
        let mut draft = Draft::default();
        draft.nodes = self.points.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        let regions = FOREIGN.into_iter().find_map(|name| self.data.get(name));
        let boundaries = self.data.get("boundary").or(regions);
        let names = |prefix: &str| -> BTreeMap<i64, String> {
            let named = |(name, components, values): &(String, usize, Vec<f64>)| {
                let number = *values.first().filter(|_| *components == 1)?;
                Some((number as i64, name.strip_prefix(prefix)?.to_owned()))
            };
            self.fields.iter().filter_map(named).collect()
        };
        let (region_names, boundary_names) = (names("region:"), names("boundary:"));
        let name = |names: &BTreeMap<i64, String>, values: Option<&Vec<f64>>, cell: usize, none: &str| {
            let number = values.and_then(|values| values.get(cell)).map(|v| *v as i64);
            number.map_or(none.to_owned(), |n| names.get(&n).cloned().unwrap_or_else(|| n.to_string()))
        };
        for name in region_names.values() {
            draft.region(name);
        }
        let mut from = 0;
        for (cell, (&kind, &end)) in self.types.iter().zip(&self.ends).enumerate() {
            let corners = (end >= 0.0).then(|| self.corners.get(from..end as usize)).flatten();
            let corners = corners.ok_or_else(|| broken(format!("cell {cell} has no corners")))?;
            from = end as usize;
            let nodes =
                nodes(corners).ok_or_else(|| broken(format!("cell {cell} has a corner that is not a point")))?;
            match (kind as i64, nodes.len()) {
                (5, 3) | (22, 6) => draft.triangle(nodes, &name(&region_names, regions, cell, REGION)),
                (3, 2) | (21, 3) => draft.line(nodes, &name(&boundary_names, boundaries, cell, BOUNDARY)),
                (1 | 2, _) => draft.vertices += 1,
                (kind, n) => {
                    let what = format!("cell {cell} is of VTK type {kind} with {n} nodes");
                    return Err(unsupported(what, "only triangles and lines of order 1 or 2 can be read"));
                }
            }
        }
        // Our own text has the edges of a boundary in its field.
        for (name, components, values) in &self.fields {
            let Some(name) = name.strip_prefix("boundary:").filter(|_| matches!(components, 2 | 3)) else { continue };
            for edge in values.chunks_exact(*components) {
                let edge = nodes(edge)
                    .ok_or_else(|| broken(format!("an edge of '{name}' ends at a number that is not a point")))?;
                draft.line(edge, name);
            }
        }
        draft.finish()
    }
}

/// Numbers of points, if all are valid.
fn nodes(numbers: &[f64]) -> Option<Vec<usize>> {
    numbers.iter().map(|v| (*v >= 0.0 && v.fract() == 0.0).then_some(*v as usize)).collect()
}

/// A name with `%20` and similar escapes decoded.
fn decoded(name: &str) -> String {
    let mut bytes = Vec::with_capacity(name.len());
    let mut rest = name.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let code = after.get(..2).filter(|_| first == b'%').and_then(|hex| std::str::from_utf8(hex).ok());
        match code.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    text(&bytes)
}
