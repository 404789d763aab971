//! Readers of mesh files, ours or not: files → [`Mesh`], with the names that the format has.
//!
//! Triangles and lines are read, straight ones or of second order (all of one kind), in a plane. Vertices as cells are left out and
//! counted; any other cell is an error. Nothing is believed: every count is held against the bytes at hand.

mod draft;
mod inp;
mod msh;
mod obj;
mod stl;
mod su2;
mod triangle;
mod vtk;
pub mod vtu;

use crate::mesh::Mesh;
use std::collections::BTreeMap;
use std::path::Path;

/// A mesh as read, with what was said of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    pub mesh: Mesh,
    /// Keys and values that our writer was given; empty of a foreign file.
    pub stamps: Vec<(String, String)>,
    /// What was left out, one sentence each.
    pub notes: Vec<String>,
}

/// Why a file holds no mesh that can be read, and what can be done.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct MeshError {
    pub what: String,
    pub help: String,
}

type Result<T> = std::result::Result<T, MeshError>;

fn broken(what: impl Into<String>) -> MeshError {
    MeshError { what: what.into(), help: "the file is damaged or of another format: write it anew".into() }
}

fn broken_at(line: usize, what: impl std::fmt::Display) -> MeshError {
    broken(format!("line {line}: {what}"))
}

fn unsupported(what: impl Into<String>, help: &str) -> MeshError {
    MeshError { what: what.into(), help: help.into() }
}

/// A format of mesh files that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// VTK XML unstructured grid.
    Vtu,
    /// Legacy VTK, text or binary.
    Vtk,
    /// Gmsh 2.2 or 4.1, text or binary.
    Msh,
    /// SU2, of two dimensions.
    Su2,
    /// Abaqus and CalculiX.
    Inp,
    /// Wavefront.
    Obj,
    /// STL, text or binary.
    Stl,
    /// Triangle's `.ele`, with its `.node` and, if there is one, `.poly` beside it.
    Triangle,
}

impl Format {
    pub const ALL: [Self; 8] =
        [Self::Vtu, Self::Vtk, Self::Msh, Self::Su2, Self::Inp, Self::Obj, Self::Stl, Self::Triangle];

    /// The suffix of its files.
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Vtu => "vtu",
            Self::Vtk => "vtk",
            Self::Msh => "msh",
            Self::Su2 => "su2",
            Self::Inp => "inp",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Triangle => "ele",
        }
    }

    /// Suffixes of files that are read beside the file itself.
    pub const fn beside(self) -> &'static [&'static str] {
        match self {
            Self::Triangle => &["node", "poly"],
            _ => &[],
        }
    }

    /// A guess from the first bytes, for standard input and strange suffixes.
    pub fn sniff(bytes: &[u8]) -> Option<Self> {
        let start = bytes.trim_ascii_start();
        // An XML declaration and a comment may come first.
        if start.starts_with(b"<") {
            let head = &start[..start.len().min(1024)];
            return head.windows(8).any(|word| word == b"<VTKFile").then_some(Self::Vtu);
        }
        let begins = |word: &str| start.get(..word.len()).is_some_and(|s| s.eq_ignore_ascii_case(word.as_bytes()));
        let words: [(&str, Self); 11] = [
            ("# vtk", Self::Vtk),
            ("$MeshFormat", Self::Msh),
            ("$Comments", Self::Msh),
            ("NDIME", Self::Su2),
            ("NZONE", Self::Su2),
            ("%", Self::Su2),
            ("*", Self::Inp),
            ("solid", Self::Stl),
            ("v ", Self::Obj),
            ("mtllib", Self::Obj),
            ("#", Self::Obj),
        ];
        words.into_iter().find(|(word, _)| begins(word)).map(|(_, format)| format)
    }
}

/// The format that a file's suffix names; `None` where it names none.
pub fn format_of(path: &Path) -> Option<Format> {
    let suffix = path.extension()?.to_str()?;
    Format::ALL.into_iter().find(|f| f.suffix().eq_ignore_ascii_case(suffix))
}

/// Reads a mesh; `beside` are the files of [`Format::beside`], in its order, as far as there are any.
///
/// # Errors
/// [`MeshError`] with the place where the file breaks its format, or what in it cannot be read. Never panics, and takes memory in
/// proportion to the bytes.
pub fn read(bytes: &[u8], format: Format, beside: &[Option<Vec<u8>>]) -> Result<MeshFile> {
    match format {
        Format::Vtu => vtu::read(bytes),
        Format::Vtk => vtk::read(bytes),
        Format::Msh => msh::read(bytes),
        Format::Su2 => su2::read(bytes),
        Format::Inp => inp::read(bytes),
        Format::Obj => obj::read(bytes),
        Format::Stl => stl::read(bytes),
        Format::Triangle => {
            let [nodes, segments] = [0, 1].map(|i| beside.get(i).and_then(Option::as_deref));
            triangle::read(bytes, nodes, segments)
        }
    }
}

/// Lines of a text with their numbers from 1.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    bytes.split(|&b| b == b'\n').enumerate().map(|(i, line)| (i + 1, line.trim_ascii()))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// What a comment of our writers says of a name that its format could not bear: see `name_comment` in `export/groups.rs`.
#[derive(Default)]
struct NameComments {
    regions: BTreeMap<String, String>,
    boundaries: BTreeMap<String, String>,
}

impl NameComments {
    /// Takes in a comment (its mark left out), if it is one of a name.
    fn hear(&mut self, comment: &[u8]) {
        let comment = text(comment);
        let comment = comment.trim_start();
        let Some((names, rest)) = comment
            .strip_prefix("name region ")
            .map(|rest| (&mut self.regions, rest))
            .or_else(|| comment.strip_prefix("name boundary ").map(|rest| (&mut self.boundaries, rest)))
        else {
            return;
        };
        if let Some((legal, name)) = rest.split_once(" = ").or_else(|| rest.strip_suffix(" =").map(|legal| (legal, "")))
        {
            names.insert(legal.to_ascii_lowercase(), name.to_owned());
        }
    }

    fn region(&self, legal: &str) -> String {
        self.regions.get(&legal.to_ascii_lowercase()).cloned().unwrap_or_else(|| legal.to_owned())
    }

    fn boundary(&self, legal: &str) -> String {
        self.boundaries.get(&legal.to_ascii_lowercase()).cloned().unwrap_or_else(|| legal.to_owned())
    }
}
