//! The XML of a `.vtu`: its arrays, and where their bytes are. Nothing is unpacked here.

use crate::meshio::{Result, broken, unsupported};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// A section of arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    Field,
    Points,
    PointData,
    Cells,
    CellData,
    Other,
}

impl Section {
    /// The section that an element of this name begins.
    fn begun_by(name: &[u8]) -> Option<Self> {
        match name {
            b"FieldData" => Some(Self::Field),
            b"Points" => Some(Self::Points),
            b"PointData" => Some(Self::PointData),
            b"Cells" => Some(Self::Cells),
            b"CellData" => Some(Self::CellData),
            _ => None,
        }
    }
}

/// A number's kind, and its size in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Int(usize),
    UInt(usize),
    Float(usize),
    /// Strings and other kinds, which are not unpacked.
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

    /// The size of a number; `None` where the kind is not numeric.
    pub fn size(self) -> Option<usize> {
        match self {
            Self::Int(n) | Self::UInt(n) | Self::Float(n) => Some(n),
            Self::Other => None,
        }
    }
}

/// Where the bytes of an array are.
#[derive(Clone, Copy, Debug)]
pub enum Place<'a> {
    Ascii(&'a [u8]),
    Inline(&'a [u8]),
    Appended(u64),
}

/// An array, not unpacked.
#[derive(Clone, Debug)]
pub struct Array<'a> {
    /// Its section.
    pub section: Section,
    /// Its name.
    pub name: String,
    /// The kind of its numbers.
    pub kind: Kind,
    /// The place of its bytes.
    pub place: Place<'a>,
}

/// The encoding of appended data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Raw,
    Base64,
}

/// The content of the XML, not unpacked.
#[derive(Debug)]
pub struct File<'a> {
    /// Whether data are compressed by zlib.
    pub zlib: bool,
    /// Whether words are big-endian.
    pub big_endian: bool,
    /// Bytes of a header word.
    pub header_bytes: usize,
    /// Number of points.
    pub points: u64,
    /// Number of cells.
    pub cells: u64,
    /// The arrays.
    pub arrays: Vec<Array<'a>>,
    /// The appended data, from the byte after `_`.
    pub appended: Option<(Encoding, &'a [u8])>,
}

impl<'a> File<'a> {
    /// Parses a file.
    pub fn parse(bytes: &'a [u8]) -> Result<Self> {
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
                    // An element inside an array does not end the section: VTK puts `InformationKey` there.
                    if Section::begun_by(end.local_name().as_ref()).is_some() {
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
                b"DataArray" => {
                    let from = position(&reader);
                    let text = if empty { &bytes[0..0] } else { text_after(bytes, from) };
                    file.arrays.extend(array(&start, section, text)?);
                }
                b"AppendedData" => {
                    file.appended = Some(appended(&start, bytes.get(position(&reader)..).unwrap_or_default())?);
                    // What follows may be raw bytes. Nothing after it is needed.
                    ended = true;
                    break;
                }
                _ => {}
            }
            if let Some(begun) = Section::begun_by(name.as_ref()) {
                section = if empty { Section::Other } else { begun };
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

    /// The array of this name in a section. The array of points may have any name.
    pub fn array(&self, section: Section, name: &str) -> Option<&Array<'a>> {
        self.arrays.iter().find(|a| a.section == section && (a.name == name || section == Section::Points))
    }
}

/// The content of `AppendedData`. `rest` is what follows its tag.
fn appended<'a>(start: &BytesStart, rest: &'a [u8]) -> Result<(Encoding, &'a [u8])> {
    let encoding = match attribute(start, "encoding")?.as_deref() {
        Some("base64") => Encoding::Base64,
        Some("raw") | None => Encoding::Raw,
        Some(other) => return Err(broken(format!("appended data are encoded as '{other}'"))),
    };
    let first = rest.iter().position(|&b| b == b'_').ok_or_else(|| broken("appended data do not begin with '_'"))?;
    Ok((encoding, &rest[first + 1..]))
}

fn position(reader: &Reader<&[u8]>) -> usize {
    usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX)
}

/// The character data from a position to the next tag.
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
            // VTK writes names unescaped, so text that is not an entity is kept.
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
