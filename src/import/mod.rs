//! Readers: files → [`Drawing`]. One file a format; nothing is welded, split or dropped here, that is
//! [`Drawing::arrange`]'s part. Every quirk that a reader met and every liberty that it took is a sentence in [`Drawing::notes`].

pub mod airfoil;
pub mod dxf;
mod foreign;
pub mod outline;
pub mod poly;
mod selection;
#[cfg(feature = "cad")]
pub mod step;
pub mod svg;

pub use airfoil::{AirfoilOptions, TrailingEdge};
pub use dxf::{DxfOptions, LineTypes};
pub use selection::{Glob, Selection};
pub use svg::{Strokes, SvgOptions};

use crate::domain::Drawing;
use crate::geometry::written::{number, numbers, tokens};
use std::path::Path;

/// Why a file cannot be read, where, and the way out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{what}", place(.line, .column))]
pub struct ImportError {
    /// What is wrong, with the entity.
    pub what: String,
    /// Line in the file, from 1.
    pub line: Option<usize>,
    /// Byte in the line, from 1.
    pub column: Option<usize>,
    /// What the user can do.
    pub help: String,
}

fn place(line: &Option<usize>, column: &Option<usize>) -> String {
    match (line, column) {
        (Some(line), Some(column)) => format!("line {line}, column {column}: "),
        (Some(line), None) => format!("line {line}: "),
        _ => String::new(),
    }
}

impl ImportError {
    fn new(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { what: what.into(), line: None, column: None, help: help.into() }
    }

    fn at(line: usize, what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { line: Some(line), ..Self::new(what, help) }
    }
}

/// A format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Airfoil coordinates: Selig, Lednicer, MSES/XFOIL blade files.
    Airfoil,
    /// Triangle's planar straight-line graph.
    Poly,
    /// Triangle's vertices alone.
    Node,
    /// Our own curves, as JSON.
    Outline,
    /// Drawings of CAD systems.
    Dxf,
    /// Scalable Vector Graphics, plain or compressed.
    Svg,
    /// STEP (ISO 10303-21): one planar face of a solid. Read where the feature `cad` is on.
    Step,
}

impl Format {
    pub const ALL: [Self; 7] = [Self::Airfoil, Self::Poly, Self::Node, Self::Outline, Self::Dxf, Self::Svg, Self::Step];

    /// The name by which a user asks for the format.
    pub fn name(self) -> &'static str {
        match self {
            Self::Airfoil => "airfoil",
            Self::Poly => "poly",
            Self::Node => "node",
            Self::Outline => "outline",
            Self::Dxf => "dxf",
            Self::Svg => "svg",
            Self::Step => "step",
        }
    }

    /// The format of this name, as [`Format::name`] gives it.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }

    /// A guess from the first bytes, for files whose suffix says nothing.
    ///
    /// STEP says so, JSON starts with a brace, DXF with its sentinel or a section, XML and gzip each in their own way. Triangle's first line
    /// holds whole numbers of which the second, the dimension, is 2; with one line of
    /// that shape more, the segment header, it is a `.poly`. Anything else that has lines of two numbers may be an airfoil.
    pub fn sniff(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Self::by_its_mark(bytes).or_else(|| poly::sniff(text)).or_else(|| airfoil::sniff(text).then_some(Self::Airfoil))
    }

    /// A format that says in its first bytes what it is.
    fn by_its_mark(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if text.trim_ascii_start().starts_with(b"ISO-10303-21") {
            return Some(Self::Step);
        }
        if text.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{') {
            return Some(Self::Outline);
        }
        if dxf::sniff(bytes) {
            return Some(Self::Dxf);
        }
        svg::sniff(text).then_some(Self::Svg)
    }
}

/// The format that a file's suffix names; `None` where it names none.
pub fn format_of(path: &Path) -> Option<Format> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "dat" | "txt" => Some(Format::Airfoil),
        "poly" => Some(Format::Poly),
        "node" => Some(Format::Node),
        "json" => Some(Format::Outline),
        "dxf" => Some(Format::Dxf),
        "svg" | "svgz" => Some(Format::Svg),
        "step" | "stp" => Some(Format::Step),
        _ => None,
    }
}

/// What a reader may be told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    pub airfoil: AirfoilOptions,
    /// The `.node` file beside a `.poly` file that holds no vertices of its own.
    pub nodes: Option<Vec<u8>>,
    pub svg: SvgOptions,
    /// The face of a solid: its number or name, or `largest`; `None`: the largest.
    pub face: Option<String>,
    pub dxf: DxfOptions,
    /// Of formats that have layers.
    pub selection: Selection,
}

/// The format of a file: as its suffix says, else as its content does.
///
/// # Errors
/// Where neither tells, and where it is another kind of file: that, by name, and what can be done with it.
pub fn tell_format(path: &Path, bytes: &[u8]) -> Result<Format, ImportError> {
    if let Some(format) = format_of(path).or_else(|| Format::by_its_mark(bytes)) {
        return Ok(format);
    }
    if let Some(foreign) = foreign::by_content(bytes).or_else(|| foreign::by_suffix(path)) {
        return Err(foreign);
    }
    Format::sniff(bytes).ok_or_else(|| {
        let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
        let help = format!("say which by --input-format: {}", names.join(", "));
        ImportError::new("the format cannot be told from name or content", help)
    })
}

/// Refuses a file that is not of the format as which it is to be read, but of one that says so.
fn refuse_other(bytes: &[u8], format: Format) -> Result<(), ImportError> {
    let marked = Format::by_its_mark(bytes);
    match marked {
        None => foreign::by_content(bytes).map_or(Ok(()), Err),
        Some(own) if own == format => Ok(()),
        Some(Format::Svg) if bytes.starts_with(b"\x1f\x8b") => {
            let help =
                "unpack it; a compressed drawing is read as SVG alone, by the suffix .svgz or --input-format svg";
            Err(ImportError::new("this is a gzip archive, and no drawing", help))
        }
        Some(other) => {
            let help = format!("say --input-format {}, or give the file the suffix of what it is", other.name());
            Err(ImportError::new(
                format!("read as {}, but the content is that of {}", format.name(), other.name()),
                help,
            ))
        }
    }
}

/// Reads a drawing. `stem` (the file's name without its suffix) is the title where the file gives none.
///
/// # Errors
/// [`ImportError`] with the line where the file breaks its format. Never panics, and takes memory in proportion to `bytes`.
pub fn read(bytes: &[u8], format: Format, stem: &str, options: &Options) -> Result<Drawing, ImportError> {
    refuse_other(bytes, format)?;
    match format {
        Format::Airfoil => airfoil::read(bytes, stem, &options.airfoil),
        Format::Poly => poly::read_poly(bytes, stem, options.nodes.as_deref()),
        Format::Node => poly::read_node(bytes, stem),
        Format::Outline => outline::read(bytes, stem),
        Format::Dxf => dxf::read(bytes, stem, &options.dxf, &options.selection),
        Format::Svg => svg::read(bytes, stem, &options.svg, &options.selection),
        #[cfg(feature = "cad")]
        Format::Step => step::read(bytes, stem, options.face.as_deref()),
        #[cfg(not(feature = "cad"))]
        Format::Step => {
            let help = "build one that has: cargo install --locked --path . --features cad";
            Err(ImportError::new("this build has no STEP reader", help))
        }
    }
}
