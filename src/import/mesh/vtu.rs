//! VTK XML unstructured grids (`.vtu`) → Mesh, whoever wrote them: ASCII, inline or appended (base64 or raw), with
//! zlib or without.
//!
//! Read are triangles (types 5 and 22) and lines (types 3 and 21) in a plane; vertices (types 1 and 2) are left out and counted,
//! any other cell is an error. What our writer adds is read back bit for bit. In a
//! foreign file, regions and boundaries are the values of the first of the cell arrays [`FOREIGN`] that it has, named
//! by their numbers. A mesh in a plane in space is read into the coordinates of that plane, which our writer tells.
//!
//! Nothing is believed: every count is held against the bytes at hand, and all arrays together may grow to no more
//! than `GROWTH` times the file plus `ALLOWANCE`.

use super::draft::plane;
use super::{MeshError, MeshFile, Result, broken, unsupported};
use crate::geometry::space::{dot, length, minus};
use crate::geometry::{Frame, Point};
use crate::ids::{Colour, CurveId, PointId, RegionId, VertexId};
use crate::mesh::{Ball, BallReason, CurveEdge, CurveLink};
use base64::Engine;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Read;

/// Cell arrays by which other programs tell groups of cells apart: ours, Gmsh's by meshio, Medit's, a common word.
pub const FOREIGN: [&str; 5] = ["region", "gmsh:physical", "medit:ref", "CellEntityIds", "material"];
/// Our own meshes grow about fivefold when they are unpacked; a thousandfold (the most that zlib can do) is an attack.
const GROWTH: usize = 32;
/// Small files of constant arrays may grow by more: 64 MB hurt nobody.
const ALLOWANCE: usize = 64 << 20;

/// Reads a mesh of triangles from the bytes of a `.vtu` file.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let file = File::parse(bytes)?;
    let mut unpacker = Unpacker { file: &file, left: bytes.len().saturating_mul(GROWTH).saturating_add(ALLOWANCE) };
    let mut builder = Builder::default();
    builder.nodes(&mut unpacker)?;
    builder.cells(&mut unpacker)?;
    builder.fields(&mut unpacker)?;
    Ok(builder.file)
}

// ---- the XML: which arrays there are, and where their bytes stand ----

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    Field,
    Points,
    PointData,
    Cells,
    CellData,
    Other,
}

/// A number's kind, and its size in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Int(usize),
    UInt(usize),
    Float(usize),
    /// Strings and whatever else: never unpacked.
    Other,
}

impl Kind {
    fn of(text: &str) -> Self {
        match text {
            "Int8" => Self::Int(1),
            "Int16" => Self::Int(2),
            "Int32" => Self::Int(4),
            "Int64" => Self::Int(8),
            "UInt8" => Self::UInt(1),
            "UInt16" => Self::UInt(2),
            "UInt32" => Self::UInt(4),
            "UInt64" => Self::UInt(8),
            "Float32" => Self::Float(4),
            "Float64" => Self::Float(8),
            _ => Self::Other,
        }
    }

    fn size(self) -> Option<usize> {
        match self {
            Self::Int(n) | Self::UInt(n) | Self::Float(n) => Some(n),
            Self::Other => None,
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Place<'a> {
    Ascii(&'a [u8]),
    Inline(&'a [u8]),
    Appended(u64),
}

#[derive(Clone, Debug)]
struct Array<'a> {
    section: Section,
    name: String,
    kind: Kind,
    place: Place<'a>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Raw,
    Base64,
}

/// What the XML says, nothing unpacked yet.
#[derive(Debug)]
struct File<'a> {
    zlib: bool,
    big_endian: bool,
    header_bytes: usize,
    points: u64,
    cells: u64,
    arrays: Vec<Array<'a>>,
    appended: Option<(Encoding, &'a [u8])>,
}

impl<'a> File<'a> {
    fn parse(bytes: &'a [u8]) -> Result<Self> {
        let mut file = Self {
            zlib: false,
            big_endian: false,
            header_bytes: 4,
            points: 0,
            cells: 0,
            arrays: Vec::new(),
            appended: None,
        };
        let mut reader = Reader::from_reader(bytes);
        let (mut section, mut seen_root, mut pieces, mut ended) = (Section::Other, false, 0, false);
        loop {
            let event =
                reader.read_event().map_err(|e| broken(format!("not XML at byte {}: {e}", reader.error_position())))?;
            let (start, empty) = match event {
                Event::Eof => break,
                Event::Start(start) => (start, false),
                Event::Empty(start) => (start, true),
                Event::End(end) => {
                    // Not so after elements inside an array: VTK puts `InformationKey` there.
                    if is_section(end.local_name().as_ref()) {
                        section = Section::Other;
                    }
                    ended |= end.local_name().as_ref() == b"VTKFile";
                    continue;
                }
                _ => continue,
            };
            let name = start.local_name();
            match name.as_ref() {
                b"VTKFile" => {
                    file.root(&start)?;
                    seen_root = true;
                }
                b"Piece" => {
                    pieces += 1;
                    file.points = count(&start, "NumberOfPoints")?;
                    file.cells = count(&start, "NumberOfCells")?;
                }
                b"FieldData" => section = Section::Field,
                b"Points" => section = Section::Points,
                b"Cells" => section = Section::Cells,
                b"CellData" => section = Section::CellData,
                b"PointData" => section = Section::PointData,
                b"DataArray" => {
                    let from = position(&reader);
                    let text = if empty { &bytes[0..0] } else { text_after(bytes, from) };
                    file.arrays.extend(array(&start, section, text)?);
                }
                b"AppendedData" => {
                    let encoding = match attribute(&start, "encoding")?.as_deref() {
                        Some("base64") => Encoding::Base64,
                        Some("raw") | None => Encoding::Raw,
                        Some(other) => return Err(broken(format!("appended data are encoded as '{other}'"))),
                    };
                    let rest = bytes.get(position(&reader)..).unwrap_or_default();
                    let Some(first) = rest.iter().position(|&b| b == b'_') else {
                        return Err(broken("appended data do not begin with '_'"));
                    };
                    file.appended = Some((encoding, &rest[first + 1..]));
                    // What follows may be raw bytes, and nothing after it is of interest.
                    ended = true;
                    break;
                }
                _ => {}
            }
            if empty && is_section(name.as_ref()) {
                section = Section::Other;
            }
        }
        match (seen_root, pieces) {
            (false, _) => Err(broken("there is no VTKFile element")),
            (true, 1) if ended => Ok(file),
            (true, 1) => Err(broken("the file ends before its last element")),
            (true, 0) => Err(broken("there is no Piece of an unstructured grid")),
            (true, n) => Err(unsupported(format!("the grid has {n} pieces"), "merge the pieces into one first")),
        }
    }

    fn root(&mut self, start: &BytesStart) -> Result<()> {
        if let Some(grid) = attribute(start, "type")?.filter(|t| t != "UnstructuredGrid") {
            return Err(unsupported(format!("the file holds a {grid}"), "save it as an UnstructuredGrid (.vtu)"));
        }
        self.zlib = match attribute(start, "compressor")?.as_deref() {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                return Err(unsupported(
                    format!("the file is compressed by {other}"),
                    "save it with zlib or uncompressed",
                ));
            }
        };
        self.big_endian = attribute(start, "byte_order")?.as_deref() == Some("BigEndian");
        self.header_bytes = if attribute(start, "header_type")?.as_deref() == Some("UInt64") { 8 } else { 4 };
        Ok(())
    }

    fn array(&self, section: Section, name: &str) -> Option<&Array<'a>> {
        self.arrays.iter().find(|a| a.section == section && (a.name == name || section == Section::Points))
    }
}

fn is_section(name: &[u8]) -> bool {
    matches!(name, b"FieldData" | b"Points" | b"PointData" | b"Cells" | b"CellData")
}

fn position(reader: &Reader<&[u8]>) -> usize {
    usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX)
}

/// The character data from a place to the next tag.
fn text_after(bytes: &[u8], from: usize) -> &[u8] {
    let rest = bytes.get(from..).unwrap_or_default();
    let end = rest.iter().position(|&b| b == b'<').unwrap_or(rest.len());
    &rest[..end]
}

fn attribute(start: &BytesStart, key: &str) -> Result<Option<String>> {
    for attribute in start.attributes() {
        let attribute = attribute.map_err(|e| broken(format!("an attribute cannot be read: {e}")))?;
        if attribute.key.as_ref() == key.as_bytes() {
            let text = std::str::from_utf8(&attribute.value).map_err(|_| broken("an attribute is not UTF-8"))?;
            // VTK itself writes names unescaped: what is no entity stands for itself.
            return Ok(Some(quick_xml::escape::unescape(text).map_or_else(|_| text.to_owned(), |t| t.into_owned())));
        }
    }
    Ok(None)
}

fn count(start: &BytesStart, key: &str) -> Result<u64> {
    let text = attribute(start, key)?.ok_or_else(|| broken(format!("the piece does not say its {key}")))?;
    text.trim().parse().map_err(|_| broken(format!("{key} is '{text}'")))
}

fn array<'a>(start: &BytesStart, section: Section, text: &'a [u8]) -> Result<Option<Array<'a>>> {
    if section == Section::Other {
        return Ok(None);
    }
    let name = attribute(start, "Name")?.unwrap_or_default();
    let kind = Kind::of(&attribute(start, "type")?.unwrap_or_default());
    let place = match attribute(start, "format")?.as_deref() {
        None | Some("ascii") => Place::Ascii(text),
        Some("binary") => Place::Inline(text),
        Some("appended") => {
            let offset = attribute(start, "offset")?.and_then(|text| text.trim().parse().ok());
            Place::Appended(offset.ok_or_else(|| broken(format!("the appended array '{name}' has no offset")))?)
        }
        Some(other) => return Err(broken(format!("array '{name}' has the format '{other}'"))),
    };
    Ok(Some(Array { section, name, kind, place }))
}

// ---- the bytes: base64, zlib, words ----

/// Unpacks arrays until its allowance is used up.
struct Unpacker<'f, 'a> {
    file: &'f File<'a>,
    left: usize,
}

/// Bytes as they stand, or behind base64.
struct Source<'a> {
    encoding: Encoding,
    rest: &'a [u8],
}

impl Source<'_> {
    /// The next segment of `n` bytes. In base64 every segment begins with a group of its own.
    fn segment(&mut self, n: usize) -> Option<Vec<u8>> {
        match self.encoding {
            Encoding::Raw => {
                let (segment, rest) = self.rest.split_at_checked(n)?;
                self.rest = rest;
                Some(segment.to_vec())
            }
            Encoding::Base64 => {
                let (mut bytes, used) = self.decode(n)?;
                self.rest = &self.rest[used..];
                bytes.truncate(n);
                Some(bytes)
            }
        }
    }

    /// The first `n` bytes of the next segment, which stays to be read; and whether the segment ends with them.
    fn peek(&self, n: usize) -> Option<(Vec<u8>, bool)> {
        match self.encoding {
            Encoding::Raw => Some((self.rest.get(..n)?.to_vec(), false)),
            Encoding::Base64 => {
                let (mut bytes, used) = self.decode(n)?;
                let ends = self.rest[..used].last() == Some(&b'=');
                bytes.truncate(n);
                Some((bytes, ends))
            }
        }
    }

    /// At least `n` bytes from whole groups of four characters, and how many characters they took, white space
    /// included.
    fn decode(&self, n: usize) -> Option<(Vec<u8>, usize)> {
        let wanted = n.div_ceil(3).checked_mul(4).filter(|&w| w <= self.rest.len())?;
        let mut characters = Vec::with_capacity(wanted);
        let mut used = 0;
        while characters.len() < wanted {
            let c = *self.rest.get(used)?;
            used += 1;
            if !c.is_ascii_whitespace() {
                characters.push(c);
            }
        }
        let bytes = ANY_PADDING.decode(characters).ok().filter(|bytes| bytes.len() >= n)?;
        Some((bytes, used))
    }
}

/// Some writers leave the padding away or leave bits in it.
const ANY_PADDING: base64::engine::GeneralPurpose = base64::engine::GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    base64::engine::GeneralPurposeConfig::new()
        .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

impl Unpacker<'_, '_> {
    /// The values of an array as numbers (integers up to 2⁵³ exactly, and nothing here counts further); at most
    /// `most` of them.
    fn numbers(&mut self, array: &Array, most: u64) -> Result<Vec<f64>> {
        let size = array.kind.size().ok_or_else(|| broken(format!("array '{}' does not hold numbers", array.name)))?;
        if let Place::Ascii(text) = array.place {
            self.left = self.left.saturating_sub(text.len());
            let text = std::str::from_utf8(text).map_err(|_| broken(format!("array '{}' is not text", array.name)))?;
            let number =
                |word: &str| word.parse().map_err(|_| broken(format!("array '{}' holds '{word}'", array.name)));
            return text
                .split_ascii_whitespace()
                .take(usize::try_from(most).unwrap_or(usize::MAX))
                .map(number)
                .collect();
        }
        let most_bytes = usize::try_from(most).unwrap_or(usize::MAX).saturating_mul(size).min(self.left);
        let bytes = self.bytes(array, most_bytes)?;
        Ok(bytes.chunks_exact(size).map(|word| number(array.kind, word, self.file.big_endian)).collect())
    }

    /// As [`Self::numbers`], of integers in `lowest..=i32::MAX`.
    fn integers(&mut self, array: &Array, most: u64, lowest: i32) -> Result<Vec<i32>> {
        let integer = |v: f64| {
            let right = v >= f64::from(lowest) && v <= f64::from(i32::MAX) && v.fract() == 0.0;
            right.then_some(v as i32).ok_or_else(|| broken(format!("array '{}' holds {v}", array.name)))
        };
        self.numbers(array, most)?.into_iter().map(integer).collect()
    }

    fn bytes(&mut self, array: &Array, most: usize) -> Result<Vec<u8>> {
        let mut source = match (array.place, self.file.appended) {
            (Place::Ascii(text), _) => Source { encoding: Encoding::Raw, rest: text },
            (Place::Inline(text), _) => Source { encoding: Encoding::Base64, rest: text },
            (Place::Appended(offset), Some((encoding, data))) => {
                let rest = usize::try_from(offset).ok().and_then(|offset| data.get(offset..));
                let rest = rest.ok_or_else(|| broken(format!("array '{}' lies beyond the end", array.name)))?;
                Source { encoding, rest }
            }
            (Place::Appended(_), None) => return Err(broken("there are no appended data")),
        };
        let packed = source.rest.len();
        let unpacked = if self.file.zlib { self.inflated(&mut source, most) } else { self.plain(&mut source, most) };
        let unpacked =
            unpacked.ok_or_else(|| broken(format!("array '{}' is cut short, too long or garbled", array.name)))?;
        // What was read counts too: many arrays may share one stretch of appended data.
        self.left = self.left.saturating_sub(unpacked.len()).saturating_sub(packed - source.rest.len());
        Ok(unpacked)
    }

    fn word(&self, bytes: &[u8]) -> Option<usize> {
        usize::try_from(number(Kind::UInt(bytes.len()), bytes, self.file.big_endian) as u64).ok()
    }

    /// Number of bytes, bytes: one segment, or (some writers) two.
    fn plain(&self, source: &mut Source, most: usize) -> Option<Vec<u8>> {
        let header = self.file.header_bytes;
        let (length, apart) = source.peek(header)?;
        let length = self.word(&length).filter(|&n| n <= most)?;
        if apart {
            source.segment(header)?;
            return source.segment(length);
        }
        let mut bytes = source.segment(header.checked_add(length)?)?;
        bytes.drain(..header);
        Some(bytes)
    }

    /// Number of blocks, their size, that of a last partial one, compressed sizes; then, a segment of its own, the
    /// blocks.
    fn inflated(&self, source: &mut Source, most: usize) -> Option<Vec<u8>> {
        let word = self.file.header_bytes;
        let blocks = self.word(&source.peek(word)?.0)?;
        let header = source.segment(blocks.checked_add(3)?.checked_mul(word)?)?;
        let words: Vec<usize> = header.chunks_exact(word).map(|w| self.word(w)).collect::<Option<_>>()?;
        let (size, last, sizes) = (words[1], words[2], &words[3..]);
        let unpacked = |i: usize| if i + 1 == blocks && last > 0 { last } else { size };
        (0..blocks).try_fold(0_usize, |sum, i| sum.checked_add(unpacked(i))).filter(|&all| all <= most)?;
        let packed = source.segment(sizes.iter().try_fold(0_usize, |sum, &n| sum.checked_add(n))?)?;
        let (mut bytes, mut from) = (Vec::new(), 0);
        for (i, &n) in sizes.iter().enumerate() {
            let end = bytes.len() + unpacked(i);
            let block = packed.get(from..from + n)?;
            // One byte more than there should be: so that the end, with its checksum, is read too.
            let most = (unpacked(i) as u64).saturating_add(1);
            flate2::read::ZlibDecoder::new(block).take(most).read_to_end(&mut bytes).ok()?;
            if bytes.len() != end {
                return None;
            }
            from += n;
        }
        Some(bytes)
    }
}

fn number(kind: Kind, word: &[u8], big_endian: bool) -> f64 {
    let mut bits = 0_u64;
    for (i, &byte) in word.iter().enumerate() {
        let place = if big_endian { word.len() - 1 - i } else { i };
        bits |= u64::from(byte) << (8 * place);
    }
    match kind {
        Kind::Float(4) => f64::from(f32::from_bits(bits as u32)),
        Kind::Float(_) => f64::from_bits(bits),
        Kind::Int(n) => {
            let unused = 64 - 8 * n as u32;
            (((bits << unused) as i64) >> unused) as f64
        }
        Kind::UInt(_) | Kind::Other => bits as f64,
    }
}

// ---- the mesh ----

#[derive(Default)]
struct Builder {
    file: MeshFile,
}

/// Numbers of regions or boundaries, and their names.
struct Groups {
    /// Where no array tells the groups apart, all cells are in one of this name.
    only: &'static str,
    names: BTreeMap<i32, String>,
}

impl Groups {
    fn read(unpacker: &mut Unpacker, prefix: &str, only: &'static str) -> Result<Self> {
        let mut names = BTreeMap::new();
        let file = unpacker.file;
        for array in file.arrays.iter().filter(|a| a.section == Section::Field) {
            if let Some(name) = array.name.strip_prefix(prefix) {
                for number in unpacker.integers(array, file.cells.saturating_add(file.points), i32::MIN)? {
                    names.entry(number).or_insert_with(|| name.to_owned());
                }
            }
        }
        Ok(Self { only, names })
    }

    fn name(&self, number: Option<i32>) -> String {
        match number {
            None => self.only.to_owned(),
            Some(n) => self.names.get(&n).cloned().unwrap_or_else(|| n.to_string()),
        }
    }
}

/// What the cell arrays say of every cell.
struct CellData {
    region: Option<Vec<i32>>,
    boundary: Option<Vec<i32>>,
    curve: Option<Vec<i32>>,
    t: Option<Vec<f64>>,
    /// Four bytes a cell.
    colour: Option<Vec<f64>>,
}

impl CellData {
    fn read(unpacker: &mut Unpacker) -> Result<Self> {
        let file = unpacker.file;
        let counts =
            |name| matches!(file.array(Section::CellData, name)?.kind, Kind::Int(_) | Kind::UInt(_)).then_some(name);
        let groups = FOREIGN.into_iter().find_map(counts);
        let region = groups.map(|name| Self::integers(unpacker, name)).transpose()?.flatten();
        // Others number lines and triangles in one array.
        let boundary = Self::integers(unpacker, "boundary")?.or_else(|| region.clone());
        let curve = Self::integers(unpacker, "curve")?;
        let t = match unpacker.file.array(Section::CellData, "t") {
            Some(array) if curve.is_some() => Some(unpacker.numbers(array, unpacker.file.cells.saturating_mul(2))?),
            _ => None,
        };
        if let Some(t) = t.iter().flatten().find(|t| !(0.0..=1.0).contains(*t)) {
            return Err(broken(format!("array 't' holds {t}, which is no parameter of a curve (0 to 1)")));
        }
        let colour = unpacker.file.array(Section::CellData, "colour").filter(|array| array.kind == Kind::UInt(1));
        let most = unpacker.file.cells.saturating_mul(4);
        let colour = colour.map(|array| unpacker.numbers(array, most)).transpose()?;
        let colour = colour.filter(|values| values.len() as u64 == most);
        Ok(Self { region, boundary, curve, t, colour })
    }

    /// The colour of a cell, where it has one.
    fn colour(&self, cell: usize) -> Option<Colour> {
        let bytes = self.colour.as_ref()?.get(4 * cell..4 * cell + 4)?;
        let colour = std::array::from_fn(|k| bytes[k] as u8);
        (colour != [0; 4]).then_some(Colour(colour))
    }

    fn integers(unpacker: &mut Unpacker, name: &str) -> Result<Option<Vec<i32>>> {
        let Some(array) = unpacker.file.array(Section::CellData, name) else { return Ok(None) };
        let values = unpacker.integers(array, unpacker.file.cells, i32::MIN)?;
        if values.len() as u64 != unpacker.file.cells {
            return Err(broken(format!(
                "array '{name}' has {} values for {} cells",
                values.len(),
                unpacker.file.cells
            )));
        }
        Ok(Some(values))
    }

    fn link(&self, cell: usize) -> Option<CurveLink> {
        let curve = u32::try_from(*self.curve.as_ref()?.get(cell)?).ok()?;
        let t = self.t.as_ref()?.get(2 * cell..2 * cell + 2)?;
        Some(CurveLink { curve: CurveId(curve), t: [t[0], t[1]] })
    }
}

fn at(values: &Option<Vec<i32>>, cell: usize) -> Option<i32> {
    values.as_ref().and_then(|v| v.get(cell).copied())
}

impl Builder {
    fn nodes(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        let points = unpacker.file.points;
        if points == 0 {
            return Ok(());
        }
        let array = unpacker.file.array(Section::Points, "").ok_or_else(|| broken("there are no points"))?;
        let values = unpacker.numbers(array, points.saturating_mul(3))?;
        if values.len() as u64 != points.saturating_mul(3) {
            return Err(broken(format!("there are {} coordinates for {points} points", values.len())));
        }
        let places: Vec<[f64; 3]> = values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        if let Some((i, [x, y, z])) = places.iter().enumerate().find(|(_, p)| p.iter().any(|v| !v.is_finite())) {
            return Err(broken(format!("point {i} is at ({x}, {y}, {z})")));
        }
        match frame(unpacker)? {
            Some(frame) => {
                self.file.mesh.nodes = in_plane(unpacker, &places, &frame)?.into();
                self.file.mesh.frame = Some(frame);
            }
            None => (self.file.mesh.nodes, self.file.mesh.frame) = plane(&places)?,
        }
        Ok(())
    }

    fn cells(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        let file = unpacker.file;
        let part = |name| file.array(Section::Cells, name).ok_or_else(|| broken(format!("the cells have no {name}")));
        if file.cells == 0 {
            return Ok(());
        }
        let types = unpacker.integers(part("types")?, file.cells, 0)?;
        let offsets = unpacker.integers(part("offsets")?, file.cells, 0)?;
        if types.len() as u64 != file.cells || offsets.len() != types.len() {
            return Err(broken(format!(
                "{} types and {} offsets for {} cells",
                types.len(),
                offsets.len(),
                file.cells
            )));
        }
        let corners = offsets.last().map_or(0, |&n| n as u64);
        let connectivity = unpacker.integers(part("connectivity")?, corners, 0)?;
        let data = CellData::read(unpacker)?;
        let regions = Groups::read(unpacker, "region:", "region")?;
        let boundaries = Groups::read(unpacker, "boundary:", "boundary")?;
        let ids = self.regions(&types, &data, &regions);
        let (mut from, mut vertices) = (0, 0);
        for (cell, (&kind, &to)) in types.iter().zip(&offsets).enumerate() {
            let to = to as usize;
            let nodes = connectivity.get(from..to).ok_or_else(|| broken(format!("cell {cell} has no corners")))?;
            from = to;
            if let Some(node) = nodes.iter().find(|&&n| n as usize >= self.file.mesh.nodes.len()) {
                return Err(broken(format!("cell {cell} has a corner {node} that is no point")));
            }
            match (kind, nodes) {
                (5, &[a, b, c]) | (22, &[a, b, c, ..]) if nodes.len() == if kind == 5 { 3 } else { 6 } => {
                    self.file.mesh.triangles.push([a, b, c].map(|n| VertexId(n as u32)));
                    if let &[ab, bc, ca] = &nodes[3..] {
                        self.file.mesh.triangle_mids.push([ab, bc, ca].map(|n| VertexId(n as u32)));
                    }
                    let region = ids.get(&at(&data.region, cell)).copied();
                    let region = region.unwrap_or(RegionId(0));
                    self.file.mesh.triangle_regions.push(region);
                    if let Some(colour) = data.colour(cell) {
                        let name = self.file.mesh.regions[region];
                        self.file.mesh.colours.entry(name).or_insert(colour);
                    }
                }
                (3, &[a, b]) | (21, &[a, b, _]) => {
                    let name = self.file.mesh.names.intern(&boundaries.name(at(&data.boundary, cell)));
                    let ends = [a, b].map(|n| VertexId(n as u32));
                    self.file.mesh.edge_mids.extend(nodes.get(2).map(|&n| VertexId(n as u32)));
                    self.file.mesh.edges.push(CurveEdge { nodes: ends, name, link: data.link(cell) });
                }
                (1 | 2, _) => vertices += 1,
                _ => return Err(refused(cell, kind, nodes.len())),
            }
        }
        let mesh = &self.file.mesh;
        let mids = |n: usize, of: usize| n == if mesh.order() == 1 { 0 } else { of };
        if !mids(mesh.triangle_mids.len(), mesh.triangles.len()) || !mids(mesh.edge_mids.len(), mesh.edges.len()) {
            return Err(unsupported("cells of first and second order are mixed", "save the mesh in one order"));
        }
        if vertices > 0 {
            self.file.notes.push(format!("{vertices} vertex cells are left out"));
        }
        Ok(())
    }

    /// A region for every number that is named or that a triangle has, ascending; names of regions come before those
    /// of boundaries.
    fn regions(&mut self, types: &[i32], data: &CellData, groups: &Groups) -> BTreeMap<Option<i32>, RegionId> {
        let used = types
            .iter()
            .enumerate()
            .filter(|&(_, &kind)| matches!(kind, 5 | 22))
            .map(|(cell, _)| at(&data.region, cell));
        let numbers: BTreeSet<Option<i32>> = used.chain(groups.names.keys().map(|&n| Some(n))).collect();
        let mesh = &mut self.file.mesh;
        numbers.into_iter().map(|n| (n, mesh.regions.push(mesh.names.intern(&groups.name(n))))).collect()
    }

    fn fields(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        let file = unpacker.file;
        let nodes = self.file.mesh.nodes.len() as u64;
        let field = |name: &str| file.array(Section::Field, name);
        if let (Some(ids), Some(at)) = (field("point_id"), field("point_node")) {
            let (ids, at) = (unpacker.integers(ids, nodes, 0)?, unpacker.integers(at, nodes, 0)?);
            if ids.len() != at.len() || at.iter().any(|&n| n as u64 >= nodes) {
                return Err(broken("point_id and point_node do not fit the points"));
            }
            self.file.mesh.points =
                ids.iter().zip(&at).map(|(&p, &v)| (PointId(p as u32), VertexId(v as u32))).collect();
        }
        let balls = [field("ball_corner_point"), field("ball_radius"), field("ball_why")];
        if let [Some(corner), Some(radius), Some(why)] = balls {
            let (corner, why) = (unpacker.integers(corner, nodes, 0)?, unpacker.integers(why, nodes, 0)?);
            let radius = unpacker.numbers(radius, nodes)?;
            if corner.len() != radius.len() || why.len() != radius.len() {
                return Err(broken("the ball arrays differ in length"));
            }
            if let Some(radius) = radius.iter().find(|r| !r.is_finite()) {
                return Err(broken(format!("a ball has the radius {radius}")));
            }
            for ((&corner, &radius), &why) in corner.iter().zip(&radius).zip(&why) {
                let corner = PointId(corner as u32);
                self.file.mesh.balls.push(Ball { corner, radius, why: ball_reason(why)? });
            }
        }
        if let Some(array) = field("unit").filter(|array| array.kind == Kind::UInt(1)) {
            let bytes: Vec<u8> = unpacker.numbers(array, 64)?.iter().map(|&b| b as u8).collect();
            self.file.mesh.unit = Some(String::from_utf8_lossy(&bytes).into_owned());
        }
        self.stamps(unpacker)
    }

    fn stamps(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        // Longer texts are no stamps of ours.
        const MOST: u64 = 1 << 20;
        for array in unpacker.file.arrays.iter().filter(|a| a.section == Section::Field) {
            let Some(key) = array.name.strip_prefix("squinch:") else { continue };
            let values = unpacker.numbers(array, MOST)?;
            let value = match (array.kind, values.as_slice()) {
                (Kind::Float(_), [number]) => number.to_string(),
                (Kind::UInt(1), text) => {
                    String::from_utf8_lossy(&text.iter().map(|&b| b as u8).collect::<Vec<_>>()).into()
                }
                _ => return Err(broken(format!("the stamp '{key}' is neither a number nor a text"))),
            };
            self.file.stamps.push((key.to_owned(), value));
        }
        Ok(())
    }
}

/// The frame of the plane that the mesh lies in, where our writer says so.
fn frame(unpacker: &mut Unpacker) -> Result<Option<Frame>> {
    let Some(array) = unpacker.file.array(Section::Field, "frame") else { return Ok(None) };
    let values = unpacker.numbers(array, 9)?;
    let [o0, o1, o2, x0, x1, x2, y0, y1, y2] = values[..] else {
        return Err(broken(format!("the frame has {} numbers, not 9", values.len())));
    };
    let frame = Frame { origin: [o0, o1, o2], x: [x0, x1, x2], y: [y0, y1, y2] };
    // Orthonormal up to rounding; NaN is not.
    let near = |value: f64, wanted: f64| (value - wanted).abs() <= 1e-12;
    let [xx, yy, xy] = [dot(frame.x, frame.x), dot(frame.y, frame.y), dot(frame.x, frame.y)];
    let right = frame.origin.iter().all(|v| v.is_finite()) && near(xx, 1.0) && near(yy, 1.0) && near(xy, 0.0);
    if right { Ok(Some(frame)) } else { Err(broken("the axes of the frame are not orthonormal")) }
}

/// The points in the coordinates of a plane: those that the file gives, where they are of these very points, else the points laid
/// into the plane.
fn in_plane(unpacker: &mut Unpacker, places: &[[f64; 3]], frame: &Frame) -> Result<Vec<Point>> {
    if let Some(array) = unpacker.file.array(Section::PointData, "plane") {
        let values = unpacker.numbers(array, 2 * places.len() as u64)?;
        let told: Vec<Point> = values.chunks_exact(2).map(|p| Point::new(p[0], p[1])).collect();
        if told.iter().map(|p| frame.place(*p)).eq(places.iter().copied()) {
            return Ok(told);
        }
    }
    let reach = places.iter().map(|p| length(minus(*p, frame.origin))).fold(0.0, f64::max);
    let off = places.iter().enumerate().find(|(_, p)| frame.height(**p).abs() > 1e-9 * reach); // rounding, generously
    if let Some((i, p)) = off {
        let what = format!("the mesh is not flat: point {i} lies {} off the plane of its frame", frame.height(*p));
        return Err(unsupported(what, "only meshes in a plane can be read"));
    }
    Ok(places.iter().map(|p| frame.flat(*p)).collect())
}

fn ball_reason(why: i32) -> Result<BallReason> {
    match why {
        0 => Ok(BallReason::LocalFeatureSize),
        1 => Ok(BallReason::Encroached),
        2 => Ok(BallReason::Size),
        other => Err(broken(format!("ball_why holds {other}"))),
    }
}

fn refused(cell: usize, kind: i32, corners: usize) -> MeshError {
    let name = match kind {
        3 | 5 | 21 | 22 => return broken(format!("cell {cell} of type {kind} has {corners} corners")),
        4 => "a polyline",
        6 => "a triangle strip",
        7 => "a polygon",
        8 | 9 => "a quadrilateral",
        10 => "a tetrahedron",
        _ => "of a kind that is not read",
    };
    unsupported(
        format!("cell {cell} is {name} (VTK type {kind})"),
        "only triangles and lines of order 1 or 2 can be read",
    )
}
