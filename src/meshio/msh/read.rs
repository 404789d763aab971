//! Gmsh's MSH 2.2 and 4.1, as text or binary of either byte order. The names are those of physical groups; a cell in
//! several groups has the first. Nodes are sorted by their numbers.

use crate::geometry::written::number;
use crate::meshio::draft::{BOUNDARY, Draft, REGION};
use crate::meshio::{MeshFile, Result, broken, text, unsupported};
use std::collections::BTreeMap;

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut reader =
        Reader { words: Words { bytes, at: 0, binary: false, big_endian: false }, version: 0, ..Reader::default() };
    while let Some(section) = reader.words.section() {
        match section.as_str() {
            "MeshFormat" => reader.format()?,
            _ if reader.version == 0 => return Err(broken("the file does not begin with $MeshFormat")),
            "PhysicalNames" => reader.names()?,
            "Entities" if reader.version == 4 => reader.entities()?,
            "Nodes" if reader.version == 4 => reader.nodes_4()?,
            "Nodes" => reader.nodes_2(false)?,
            "ParametricNodes" => reader.nodes_2(true)?,
            "Elements" if reader.version == 4 => reader.elements_4()?,
            "Elements" => reader.elements_2()?,
            _ => {}
        }
        reader.words.end(&section)?;
    }
    if reader.version == 0 {
        return Err(broken("there is no $MeshFormat"));
    }
    reader.finish()
}

/// Reads numbers, as text between blanks or as bytes.
#[derive(Default)]
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    binary: bool,
    big_endian: bool,
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

    /// The name of the next section.
    fn section(&mut self) -> Option<String> {
        while !self.rest().is_empty() {
            if let Some(name) = self.line().strip_prefix(b"$") {
                return Some(text(name));
            }
        }
        None
    }

    /// Moves past the end of a section.
    fn end(&mut self, section: &str) -> Result<()> {
        let mark = format!("$End{section}");
        let found = self.rest().windows(mark.len()).position(|w| w == mark.as_bytes());
        let from = found.ok_or_else(|| broken(format!("the file ends before {mark}")))?;
        self.at += from + mark.len();
        Ok(())
    }

    fn word(&mut self) -> Result<&'a [u8]> {
        let rest = self.rest();
        let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        self.at += start + length;
        if length == 0 { Err(broken("the file ends within a section")) } else { Ok(&rest[start..start + length]) }
    }

    fn packed<const N: usize>(&mut self) -> Result<[u8; N]> {
        let bytes = self.rest().first_chunk::<N>().ok_or_else(|| broken("the file ends within a section"))?;
        self.at += N;
        let mut bytes = *bytes;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn whole(&mut self) -> Result<i64> {
        let word = self.word()?;
        let value = std::str::from_utf8(word).ok().and_then(|t| t.parse().ok());
        value.ok_or_else(|| broken(format!("'{}' is not a whole number", text(word))))
    }

    fn int(&mut self) -> Result<i64> {
        if self.binary { Ok(i64::from(i32::from_le_bytes(self.packed()?))) } else { self.whole() }
    }

    /// A `size_t`.
    fn size(&mut self) -> Result<u64> {
        let value = if self.binary { i64::from_le_bytes(self.packed()?) } else { self.whole()? };
        u64::try_from(value).map_err(|_| broken(format!("{value} is not a count")))
    }

    /// A count of things that take at least one byte each.
    fn count(&mut self, value: u64) -> Result<usize> {
        let most = self.rest().len();
        usize::try_from(value)
            .ok()
            .filter(|&n| n <= most)
            .ok_or_else(|| broken(format!("the file is too short for a count of {value}")))
    }

    fn double(&mut self) -> Result<f64> {
        if self.binary {
            return Ok(f64::from_le_bytes(self.packed()?));
        }
        let word = self.word()?;
        number(word).ok_or_else(|| broken(format!("'{}' is not a number", text(word))))
    }
}

#[derive(Default)]
struct Reader<'a> {
    words: Words<'a>,
    version: u8,
    /// Names of physical groups by dimension and number.
    names: BTreeMap<(i64, i64), String>,
    /// The first physical group of each curve and surface, by dimension and number.
    groups: BTreeMap<(i64, i64), i64>,
    nodes: BTreeMap<u64, [f64; 3]>,
    /// Type, dimension and group, node numbers.
    cells: Vec<(bool, i64, Vec<u64>)>,
    vertices: usize,
}

impl Reader<'_> {
    fn format(&mut self) -> Result<()> {
        let line = text(self.words.line());
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let &[version, kind, size] = words.as_slice() else { return Err(broken(format!("the format is '{line}'"))) };
        self.version = match version {
            "4.1" => 4,
            "2" | "2.0" | "2.1" | "2.2" => 2,
            _ => return Err(unsupported(format!("this is MSH {version}"), "save it as MSH 4.1 or 2.2")),
        };
        if size != "8" {
            return Err(unsupported(format!("numbers have {size} bytes"), "save it on a machine of 64 bits"));
        }
        self.words.binary = kind == "1";
        if self.words.binary && self.words.int()? != 1 {
            self.words.big_endian = true;
        }
        Ok(())
    }

    fn names(&mut self) -> Result<()> {
        let count = text(self.words.line());
        let count: usize = count.parse().map_err(|_| broken(format!("'{count}' is not a count of names")))?;
        for _ in 0..count {
            let line = text(self.words.line());
            let mut parts = line.splitn(3, ' ');
            let mut next = || parts.next().and_then(|word| word.parse().ok());
            let (dimension, tag) = (next(), next());
            let name = parts.next().map(str::trim).and_then(|name| name.strip_prefix('"')?.strip_suffix('"'));
            let (Some(dimension), Some(tag), Some(name)) = (dimension, tag, name) else {
                return Err(broken(format!("'{line}' is not a physical name")));
            };
            self.names.insert((dimension, tag), name.to_owned());
        }
        Ok(())
    }

    fn entities(&mut self) -> Result<()> {
        let counts = [self.words.size()?, self.words.size()?, self.words.size()?, self.words.size()?];
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..self.words.count(count)? {
                let tag = self.words.int()?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    self.words.double()?;
                }
                let groups = self.words.size()?;
                for i in 0..self.words.count(groups)? {
                    let group = self.words.int()?;
                    if i == 0 {
                        self.groups.insert((dimension, tag), group);
                    }
                }
                let bounds = if dimension == 0 { 0 } else { self.words.size()? };
                for _ in 0..self.words.count(bounds)? {
                    self.words.int()?;
                }
            }
        }
        Ok(())
    }

    fn place(&mut self) -> Result<[f64; 3]> {
        Ok([self.words.double()?, self.words.double()?, self.words.double()?])
    }

    fn node(&mut self, tag: u64, place: [f64; 3]) -> Result<()> {
        match self.nodes.insert(tag, place) {
            Some(_) => Err(broken(format!("node {tag} is given twice"))),
            None => Ok(()),
        }
    }

    fn nodes_4(&mut self) -> Result<()> {
        let blocks = self.words.size()?;
        for _ in 0..3 {
            self.words.size()?;
        }
        for _ in 0..self.words.count(blocks)? {
            let (dimension, _) = (self.words.int()?, self.words.int()?);
            let parametric = self.words.int()? != 0;
            let count = self.words.size()?;
            let count = self.words.count(count)?;
            let tags: Vec<u64> = (0..count).map(|_| self.words.size()).collect::<Result<_>>()?;
            for tag in tags {
                let place = self.place()?;
                self.node(tag, place)?;
                for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                    self.words.double()?;
                }
            }
        }
        Ok(())
    }

    /// The nodes of 2.2. Parametric nodes also hold the entity on which they lie, and their parameters there: one on a
    /// curve, two on a surface.
    fn nodes_2(&mut self, parametric: bool) -> Result<()> {
        let count = self.count_2()?;
        for _ in 0..count {
            let tag = self.words.int()?;
            let place = self.place()?;
            self.node(u64::try_from(tag).map_err(|_| broken(format!("{tag} is not a number of a node")))?, place)?;
            if parametric {
                let (dimension, _) = (self.words.int()?, self.words.int()?);
                for _ in 0..if matches!(dimension, 1 | 2) { dimension } else { 0 } {
                    self.words.double()?;
                }
            }
        }
        Ok(())
    }

    /// A count of 2.2, which is text on a line of its own, also in binary.
    fn count_2(&mut self) -> Result<usize> {
        let line = text(self.words.line());
        let count = line.parse().map_err(|_| broken(format!("'{line}' is not a count")))?;
        self.words.count(count)
    }

    fn elements_4(&mut self) -> Result<()> {
        let blocks = self.words.size()?;
        for _ in 0..3 {
            self.words.size()?;
        }
        for _ in 0..self.words.count(blocks)? {
            let (dimension, entity, kind) = (self.words.int()?, self.words.int()?, self.words.int()?);
            let count = self.words.size()?;
            let group = self.groups.get(&(dimension, entity)).copied().unwrap_or(0);
            for _ in 0..self.words.count(count)? {
                self.words.size()?;
                let nodes = (0..nodes_of(kind)?).map(|_| self.words.size()).collect::<Result<_>>()?;
                self.cell(kind, group, nodes);
            }
        }
        Ok(())
    }

    fn elements_2(&mut self) -> Result<()> {
        let count = self.count_2()?;
        let mut read = 0;
        while read < count {
            // In binary, elements of one type share a header. In text, each has its own, with its number first.
            let first = if self.words.binary { None } else { Some(self.words.int()?) };
            let kind = self.words.int()?;
            let follow = if first.is_none() { self.words.int()? } else { 1 };
            let tags = self.words.int()?;
            let follow = self.words.count(u64::try_from(follow).unwrap_or(0))?;
            let tags = self.words.count(u64::try_from(tags).unwrap_or(0))?;
            if follow == 0 {
                return Err(broken("a block of elements is empty"));
            }
            for _ in 0..follow {
                if first.is_none() {
                    self.words.int()?;
                }
                let mut group = 0;
                for i in 0..tags {
                    let tag = self.words.int()?;
                    group = if i == 0 { tag } else { group };
                }
                let node = |n: i64| u64::try_from(n).map_err(|_| broken(format!("{n} is not a number of a node")));
                let nodes = (0..nodes_of(kind)?).map(|_| node(self.words.int()?)).collect::<Result<_>>()?;
                self.cell(kind, group, nodes);
            }
            read += follow;
        }
        Ok(())
    }

    fn cell(&mut self, kind: i64, group: i64, nodes: Vec<u64>) {
        match kind {
            15 => self.vertices += 1,
            _ => self.cells.push((matches!(kind, 2 | 9), group.saturating_abs(), nodes)),
        }
    }

    fn finish(self) -> Result<MeshFile> {
        let mut draft = Draft::default();
        draft.vertices = self.vertices;
        let mut place = BTreeMap::new();
        for (tag, p) in self.nodes {
            place.insert(tag, draft.nodes.len());
            draft.nodes.push(p);
        }
        let name = |dimension: i64, group: i64, none: &str| match (group, self.names.get(&(dimension, group))) {
            (0, _) => none.to_owned(),
            (_, Some(name)) => name.clone(),
            (number, None) => number.to_string(),
        };
        // Regions are sorted by number, whatever the order of cells.
        for (&(_, group), _) in self.names.range((2, i64::MIN)..(3, i64::MIN)) {
            draft.region(&name(2, group, REGION));
        }
        for (triangle, group, nodes) in self.cells {
            let find = |tag: &u64| place.get(tag).copied().ok_or_else(|| broken(format!("there is no node {tag}")));
            let nodes = nodes.iter().map(find).collect::<Result<_>>()?;
            if triangle {
                draft.triangle(nodes, &name(2, group, REGION));
            } else {
                draft.line(nodes, &name(1, group, BOUNDARY));
            }
        }
        draft.finish()
    }
}

/// The number of nodes of an element type.
fn nodes_of(kind: i64) -> Result<usize> {
    let name = match kind {
        1 => return Ok(2),
        2 | 8 => return Ok(3),
        9 => return Ok(6),
        15 => return Ok(1),
        3 | 10 | 16 => "a quadrilateral",
        4 | 11 => "a tetrahedron",
        _ => "of a kind that is not read",
    };
    Err(unsupported(
        format!("an element is {name} (Gmsh type {kind})"),
        "only triangles and lines of order 1 or 2 can be read",
    ))
}
