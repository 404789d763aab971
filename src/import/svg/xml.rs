//! Bytes → text → XML tree, within limits.

use super::ImportError;
use roxmltree::{Document, ParsingOptions};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::io::Read;

/// Largest size of a file after decompression, in bytes.
const UNPACKED_MAX: u64 = 128 << 20;
/// Largest size of all entities of a DOCTYPE after expansion, in bytes.
const ENTITIES_MAX: usize = 64 << 20;
/// Largest number of attributes of one element, and of namespace prefixes of one file. The parser compares each with
/// each.
const ATTRIBUTES_MAX: usize = 4096;
const PREFIXES_MAX: usize = 256;

/// The text of a file, with a note on its encoding where that is not plain UTF-8.
pub(super) fn text(bytes: &[u8]) -> Result<(Cow<'_, str>, Option<String>), ImportError> {
    if bytes.starts_with(b"\x1f\x8b") {
        let text = decoded(unpacked(bytes)?.into())?;
        return Ok((text.0.into_owned().into(), text.1));
    }
    decoded(bytes.into())
}

fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, ImportError> {
    let mut unpacked = Vec::new();
    let mut reader = flate2::read::MultiGzDecoder::new(bytes).take(UNPACKED_MAX + 1);
    reader
        .read_to_end(&mut unpacked)
        .map_err(|e| ImportError::new(format!("the gzip stream is broken: {e}"), "export the drawing again"))?;
    if unpacked.len() as u64 > UNPACKED_MAX {
        let what = format!("the gzip stream unfolds to more than {} MiB", UNPACKED_MAX >> 20);
        return Err(ImportError::new(what, "unpack the file, and split the drawing"));
    }
    Ok(unpacked)
}

fn decoded(bytes: Cow<'_, [u8]>) -> Result<(Cow<'_, str>, Option<String>), ImportError> {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        let word = if bytes[0] == 0xff { u16::from_le_bytes } else { u16::from_be_bytes };
        let words = bytes[2..].chunks_exact(2).map(|pair| word([pair[0], pair[1]]));
        let text: Result<String, _> = char::decode_utf16(words).collect();
        let text = text.map_err(|_| ImportError::new("the UTF-16 text is broken", "save the file as UTF-8"))?;
        return Ok((without_declaration(&text).to_owned().into(), Some("The file is UTF-16.".into())));
    }
    let broken = match std::str::from_utf8(&bytes) {
        Ok(_) => None,
        Err(error) => Some(error.valid_up_to()),
    };
    let Some(broken) = broken else {
        let text = match bytes {
            Cow::Borrowed(bytes) => String::from_utf8_lossy(bytes),
            Cow::Owned(bytes) => String::from_utf8_lossy(&bytes).into_owned().into(),
        };
        return Ok((text, None));
    };
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_ascii_lowercase();
    if ["iso-8859-1", "iso-8859-15", "windows-1252", "us-ascii"].iter().any(|name| head.contains(name)) {
        // The first 256 characters of Unicode are those of ISO 8859-1. Only names and text can have characters beyond
        // ASCII.
        let text: String = bytes.iter().map(|&b| char::from(b)).collect();
        return Ok((text.into(), Some("The file was read as ISO 8859-1, as it says.".into())));
    }
    let line = 1 + bytes[..broken].iter().filter(|&&b| b == b'\n').count();
    Err(ImportError::at(line, "a byte that is not UTF-8", "save the file as UTF-8"))
}

/// The text after `<?xml … ?>`. The declaration may name an encoding that the text no longer has.
fn without_declaration(text: &str) -> &str {
    match text.find("?>").filter(|_| text.starts_with("<?xml")) {
        Some(end) => &text[end + 2..],
        None => text,
    }
}

/// The tree. Entities of the DOCTYPE are expanded within limits. Nothing outside the file is read.
pub(super) fn parse(text: &str) -> Result<Document<'_>, ImportError> {
    check_cost(text)?;
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        // The message of the parser ends with a place of its own.
        let what = error.to_string();
        let what = what.split(" at ").next().unwrap_or_default();
        // The parser gives no place for a file that ends too early. The place is the end.
        let cut_off = matches!(error, roxmltree::Error::UnexpectedEndOfStream | roxmltree::Error::UnclosedRootNode);
        let (line, column) = match cut_off {
            true => Lines::new(text).place(text.len()),
            false => (error.pos().row as usize, error.pos().col as usize),
        };
        let help = "the file is cut off, or is not SVG: export it again";
        ImportError { column: Some(column), ..ImportError::at(line, format!("XML: {what}"), help) }
    })
}

/// Refuses input on which the parser takes time or memory that grows with the square of the file, or faster.
fn check_cost(text: &str) -> Result<(), ImportError> {
    let refuse = |what: &str| Err(ImportError::new(what, "this does not look like a drawing: export it again"));
    if entity_bytes(text) > ENTITIES_MAX {
        return refuse("the entities of the DOCTYPE unfold to more than 64 MiB");
    }
    if text.split(['<', '>']).any(|tag| tag.bytes().filter(|&b| b == b'=').count() > ATTRIBUTES_MAX) {
        return refuse("an element with more than 4096 attributes");
    }
    let name = |rest: &'_ str| rest.find('=').map_or(rest.len(), |end| end.min(64));
    let prefixes: BTreeSet<&[u8]> =
        text.split("xmlns:").skip(1).map(|rest| &rest.as_bytes()[..name(rest)]).take(1 << 20).collect();
    if prefixes.len() > PREFIXES_MAX {
        return refuse("more than 256 namespace prefixes");
    }
    Ok(())
}

/// An upper bound of the size of the expanded entities: each reference expands to the longest of them. The parser
/// allows 255 references within one.
fn entity_bytes(text: &str) -> usize {
    let Some(first) = text.find("<!ENTITY") else { return 0 };
    let last = text.rfind("<!ENTITY").unwrap_or(first);
    let end = text[last..].find('>').map_or(text.len(), |n| last + n);
    let declared = &text[first..end];
    let longest = declared.split("<!ENTITY").map(str::len).max().unwrap_or(0);
    let nested = if declared.contains('&') { 256 } else { 1 };
    let references = text[end..].matches('&').count();
    references.saturating_mul(nested).saturating_mul(longest + declared.matches("<!ENTITY").count())
}

/// The beginnings of lines, by which places are found.
pub(super) struct Lines(Vec<usize>);

impl Lines {
    /// The lines of a text.
    pub fn new(text: &str) -> Self {
        Self(std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect())
    }

    /// Line and byte in the line, both from 1, of a byte of the text.
    pub fn place(&self, byte: usize) -> (usize, usize) {
        let line = self.0.partition_point(|&start| start <= byte);
        (line, byte - self.0[line - 1] + 1)
    }
}
