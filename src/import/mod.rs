//! Readers: files → [`Drawing`], coordinates of airfoil sections, or [`Surfaces`] that bound a solid. Each format has a file or a folder with its
//! `Facts`; the list of formats below is the only one. A reader does not weld, split or drop anything;
//! [`Drawing::arrange`] and [`Surfaces::assemble`] do. A reader adds one sentence to [`Drawing::notes`] for each oddity of the file and for each
//! guess.

pub mod airfoil;
pub mod dxf;
mod foreign;
pub mod outline;
pub mod poly;
mod selection;
pub mod step;
mod surface;
pub mod svg;

pub use dxf::{DxfOptions, LineTypes};
pub use selection::{Glob, Selection};
pub use svg::{Strokes, SvgOptions};

use crate::domain::Drawing;
use crate::formats::formats;
use crate::geometry::written::{number, numbers, tokens};
use crate::solid::Surfaces;
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
    /// An error without a place.
    pub(crate) fn new(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { what: what.into(), line: None, column: None, help: help.into() }
    }

    /// An error at a line.
    pub(crate) fn at(line: usize, what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { line: Some(line), ..Self::new(what, help) }
    }
}

formats! {
    /// A format of drawings or of surfaces in space.
    pub enum Format: Facts {
        /// Airfoil coordinates: Selig, Lednicer, MSES/XFOIL blade files.
        Airfoil = airfoil::FACTS,
        /// Triangle's planar straight-line graph, or TetGen's complex in space.
        Poly = poly::FACTS,
        /// Triangle's vertices alone.
        Node = poly::FACTS_OF_NODE,
        /// Our own curves, as JSON.
        Outline = outline::FACTS,
        /// Drawings of CAD systems.
        Dxf = dxf::FACTS,
        /// Scalable Vector Graphics, plain or compressed.
        Svg = svg::FACTS,
        /// STEP (ISO 10303-21): one planar face of a solid. Read where the feature `cad` is on.
        Step = step::FACTS,
        /// TetGen's complex in space, facets of one polygon each.
        Smesh = surface::FACTS_OF_SMESH,
        /// Polygons of Geomview.
        Off = surface::FACTS_OF_OFF,
        /// Triangles of stereolithography, text or binary.
        Stl = surface::FACTS_OF_STL,
    }
}

/// The facts of a format.
struct Facts {
    /// The name by which a user asks for the format.
    name: &'static str,
    /// Suffixes of its files, the usual one first.
    suffixes: &'static [&'static str],
    /// Whether first bytes are those of this format, and how reliably they identify it.
    sign: fn(&[u8]) -> bool,
    certainty: Certainty,
    /// Reads a file. The text is the file name without suffix, the title where the file gives none.
    read: fn(&[u8], &str, &Options) -> Result<Found, ImportError>,
}

/// How reliably first bytes identify a format.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Certainty {
    /// No file of another kind begins so: JSON begins with a brace, DXF with its sentinel or a section, XML and gzip in
    /// their own ways. A file with a mark is refused under a wrong suffix. Marks are tested before files are refused as
    /// not drawings.
    Mark,
    /// They have the shape of this format. A mark of another format has precedence.
    Shape,
    /// They hold lines of numbers, as many files do. They count if nothing above does.
    Numbers,
}

impl Format {
    /// The name by which a user asks for the format.
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// Suffixes of its files, the usual one first.
    pub const fn suffixes(self) -> &'static [&'static str] {
        self.facts().suffixes
    }

    /// The format of this name, as [`Format::name`] gives it.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }

    /// The format of first bytes, for files whose suffix tells nothing: by a mark, else by a shape, else by lines of
    /// numbers.
    pub fn sniff(bytes: &[u8]) -> Option<Self> {
        [Certainty::Mark, Certainty::Shape, Certainty::Numbers].into_iter().find_map(|by| Self::told(bytes, by))
    }

    fn told(bytes: &[u8], by: Certainty) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.facts().certainty == by && (f.facts().sign)(bytes))
    }
}

fn without_bom(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The format that a file's suffix names; `None` where it names none.
pub fn format_of(path: &Path) -> Option<Format> {
    let suffix = path.extension()?.to_str()?;
    Format::ALL.into_iter().find(|f| f.suffixes().iter().any(|s| s.eq_ignore_ascii_case(suffix)))
}

/// The content of a file.
#[derive(Clone, Debug)]
pub enum Found {
    /// The curves, points, names and sizes of the file.
    Drawing(Box<Drawing>),
    /// Coordinates of sections. [`crate::section`] makes a drawing of them.
    Section(airfoil::Coordinates),
    /// Polygons in space, which [`Surfaces::assemble`] makes a solid of.
    Surfaces(Box<Surfaces>),
}

impl From<Surfaces> for Found {
    fn from(surfaces: Surfaces) -> Self {
        Self::Surfaces(Box::new(surfaces))
    }
}

impl From<Drawing> for Found {
    fn from(drawing: Drawing) -> Self {
        Self::Drawing(Box::new(drawing))
    }
}

/// Options of readers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The `.node` file beside a `.poly` file that holds no vertices of its own.
    pub nodes: Option<Vec<u8>>,
    /// For SVG files: the treatment of strokes, and pixels to an inch.
    pub svg: SvgOptions,
    /// The face of a solid: its number or name, or `largest`; `None`: the largest.
    pub face: Option<String>,
    /// For DXF files: the treatment of line types and of heights.
    pub dxf: DxfOptions,
    /// For formats with layers: which are read.
    pub selection: Selection,
}

/// The format of a file: by its suffix, else by its content.
///
/// # Errors
/// Where neither tells. Where it is a file of another kind: its name, and what can be done with it.
pub fn tell_format(path: &Path, bytes: &[u8]) -> Result<Format, ImportError> {
    if let Some(format) = format_of(path).or_else(|| Format::told(bytes, Certainty::Mark)) {
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

/// Refuses a file that is read as one format but has the mark of another.
fn refuse_other(bytes: &[u8], format: Format) -> Result<(), ImportError> {
    let marked = Format::told(bytes, Certainty::Mark);
    match marked {
        None => foreign::by_content(bytes).map_or(Ok(()), Err),
        Some(own) if own == format => Ok(()),
        Some(Format::Svg) if bytes.starts_with(b"\x1f\x8b") => {
            let help =
                "unpack it; a compressed drawing is read as SVG alone, by the suffix .svgz or --input-format svg";
            Err(ImportError::new("this is a gzip archive, not a drawing", help))
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

/// Reads a file. `stem` (its name without suffix) is the title where the file gives none.
///
/// # Errors
/// [`ImportError`] with the line where the file breaks its format. Never panics, and takes memory in proportion to
/// `bytes`.
pub fn read(bytes: &[u8], format: Format, stem: &str, options: &Options) -> Result<Found, ImportError> {
    refuse_other(bytes, format)?;
    (format.facts().read)(bytes, stem, options)
}
