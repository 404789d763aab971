//! Mesh files: [`Mesh`] → files, and files, ours or not, → [`Mesh`], with the names that the format has.
//!
//! A format is a file, or a folder with `write.rs` and `read.rs`. Its `Facts` hold all that differs between formats.
//! The list of formats below is the only one: the enum, names and suffixes, writers, readers and losses are made from
//! it.
//!
//! A writer writes all that its format can hold; [`Format::losses`] lists the rest. Readers read triangles and lines in
//! a plane, straight ones or of second order (all of one kind). Point cells are left out and counted; any other cell is
//! an error. Input is untrusted: readers check every count against the bytes at hand.

mod colours;
mod draft;
mod gltf;
mod groups;
mod inp;
mod losses;
mod medit;
mod msh;
mod names;
mod obj;
mod solid_groups;
mod stl;
mod su2;
mod tetgen;
mod triangle;
mod vtk;
mod vtu;
mod xdmf;

use crate::formats::formats;
use crate::mesh::Mesh;
use crate::mesh::solid::SolidMesh;
use losses::Losses;
use serde::Serialize;
use std::io;
use std::path::Path;

formats! {
    /// A format of mesh files.
    pub enum Format: Facts {
        /// VTK XML unstructured grid: all that a mesh holds.
        Vtu = vtu::FACTS,
        /// Legacy VTK, written in binary.
        Vtk = vtk::FACTS,
        /// Legacy VTK as text, for readers that know no other (MFEM, deal.II, Gmsh).
        VtkText = vtk::FACTS_OF_TEXT,
        /// Gmsh, written as 4.1 in binary.
        Msh = msh::FACTS,
        /// Gmsh 2.2, text.
        Msh22 = msh::FACTS_OF_22,
        /// SU2.
        Su2 = su2::FACTS,
        /// Abaqus and CalculiX.
        Inp = inp::FACTS,
        /// XDMF 3, text.
        Xdmf = xdmf::FACTS,
        /// Triangle's `.node`, `.ele` and `.poly`.
        Triangle = triangle::FACTS,
        /// TetGen's `.node`, `.ele`, `.face` and `.edge`: tetrahedra only.
        Tetgen = tetgen::FACTS,
        /// Medit's `.mesh`, text: tetrahedra only.
        Medit = medit::FACTS,
        /// glTF 2.0, binary.
        Glb = gltf::FACTS_OF_GLB,
        /// glTF 2.0, text.
        Gltf = gltf::FACTS,
        /// Wavefront, with its materials.
        Obj = obj::FACTS,
        /// STL, written as text.
        Stl = stl::FACTS,
    }
}

/// The bytes of each file of an output.
type Files = Vec<Vec<u8>>;
/// Keys and values about how a mesh was made.
type Stamps = [(String, String)];
/// A writer of meshes in a plane: the bytes of each file.
type Writer = fn(&Mesh, &Stamps, &WriteOptions) -> io::Result<Files>;
/// A writer of tetrahedral meshes.
type SolidWriter = fn(&SolidMesh, &Stamps) -> io::Result<Files>;
/// The files beside the one that is read, if there are any.
type Beside = [Option<Vec<u8>>];

/// The facts of a format.
struct Facts {
    /// The name by which a user asks for the format.
    name: &'static str,
    /// Suffixes of the files of one output, in the order of [`encode`].
    suffixes: &'static [&'static str],
    /// Whether the first file has the user's name and the others stand beside it, where the output has a name.
    /// Otherwise each file has its own suffix.
    first_as_named: bool,
    /// The choices that the format leaves.
    choices: &'static [Choice],
    /// For a format with straight cells only: the way out for order 2.
    straight_only: Option<&'static str>,
    /// Writes a mesh in a plane; `None`: the format holds tetrahedra only.
    write: Option<Writer>,
    /// Writes a mesh of tetrahedra; `None`: the format holds none.
    write_solid: Option<SolidWriter>,
    /// Reports what the format does not hold of a mesh, in the order for people.
    losses: fn(&mut Losses),
    /// How the format is read; `None`: it is only written.
    reading: Option<Reading>,
}

/// How a format is read.
pub struct Reading {
    /// The suffix of the file that is read.
    pub suffix: &'static str,
    /// Suffixes of files that are read beside it.
    pub beside: &'static [&'static str],
    /// Whether the first bytes, without blanks, are those of this format.
    begins: fn(&[u8]) -> bool,
    /// Reads the file, with the files beside it.
    read: fn(&[u8], &Beside) -> Result<MeshFile>,
}

/// A choice of [`WriteOptions`] that some formats leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// [`WriteOptions::plain`].
    Plain,
    /// [`WriteOptions::lines`].
    Lines,
    /// The same, for what [`WriteOptions::plain`] writes.
    PlainLines,
    /// [`WriteOptions::xdmf`].
    Grids,
}

impl Format {
    /// The name by which a user asks for the format.
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// Suffixes of the files that one output consists of: of most formats one, in the order of [`encode`].
    pub const fn suffixes(self) -> &'static [&'static str] {
        self.facts().suffixes
    }

    /// Whether the first file of an output has the user's name, with any suffix, and the others stand beside it, where
    /// the output has a name ([`WriteOptions::stem`]). Otherwise each file has its own suffix.
    pub const fn first_as_named(self) -> bool {
        self.facts().first_as_named
    }

    /// Whether the format holds triangles in a plane ([`encode`]).
    pub fn holds_planes(self) -> bool {
        self.facts().write.is_some()
    }

    /// Whether the format holds tetrahedra ([`encode_solid`]).
    pub fn holds_solids(self) -> bool {
        self.facts().write_solid.is_some()
    }

    /// Whether the format leaves a choice.
    pub fn leaves(self, choice: Choice) -> bool {
        self.facts().choices.contains(&choice)
    }

    /// How the format is read; `None`: it is only written.
    pub fn reading(self) -> Option<&'static Reading> {
        self.facts().reading.as_ref()
    }

    /// The format of this name, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name().eq_ignore_ascii_case(name))
    }

    /// The format in which a path with this suffix is written.
    pub fn to_write(path: &Path) -> Option<Self> {
        let suffix = path.extension()?.to_str()?;
        Self::ALL.into_iter().find(|f| f.suffixes().iter().any(|s| s.eq_ignore_ascii_case(suffix)))
    }

    /// The format as which a path with this suffix is read; `None` where there is none.
    pub fn to_read(path: &Path) -> Option<Self> {
        let suffix = path.extension()?.to_str()?;
        Self::ALL.into_iter().find(|f| f.reading().is_some_and(|r| r.suffix.eq_ignore_ascii_case(suffix)))
    }

    /// The format of first bytes, for standard input and unknown suffixes.
    pub fn sniff(bytes: &[u8]) -> Option<Self> {
        let start = bytes.trim_ascii_start();
        Self::ALL.into_iter().find(|f| f.reading().is_some_and(|r| (r.begins)(start)))
    }

    /// Whether cells of this order can be written. [`Format::losses`] tells whether they are written as straight ones.
    ///
    /// # Errors
    /// `Unsupported`, with the way out.
    pub fn holds_order(self, order: u8) -> io::Result<()> {
        match self.facts().straight_only.filter(|_| order > 1) {
            Some(what) => Err(io::Error::new(io::ErrorKind::Unsupported, what)),
            None => Ok(()),
        }
    }

    /// What the format does not hold of this mesh, or holds as something else: a phrase each, for people.
    pub fn losses(self, mesh: &Mesh, options: &WriteOptions) -> Vec<&'static str> {
        let mut losses = Losses::new(mesh, options);
        (self.facts().losses)(&mut losses);
        losses.told()
    }
}

// ---- writing ----

/// How XDMF holds triangles and lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum XdmfGrids {
    /// One grid of both kinds of cells, for meshio and ParaView.
    Single,
    /// A grid of triangles and one of lines, for FEniCSx.
    #[default]
    Double,
}

/// Choices of writing, where a format or a reader of it leaves one.
#[derive(Clone, Debug, PartialEq)]
pub struct WriteOptions {
    /// VTU without field data, and so without names.
    pub plain: bool,
    /// Whether boundaries with triangles on both sides are written: interfaces, and lines within a region.
    pub interior_lines: bool,
    /// Whether boundaries are written as lines, in formats with readers that misread files with lines: glTF, OBJ, text
    /// VTK and plain VTU. `None`: in the first two.
    pub lines: Option<bool>,
    /// Whether XDMF holds triangles and lines in one grid or in two.
    pub xdmf: XdmfGrids,
    /// The name without suffix by which the files of one output refer to each other: OBJ's to its `.mtl`. `None`: the
    /// output is a stream and has its first file only.
    pub stem: Option<String>,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self { plain: false, interior_lines: true, lines: None, xdmf: XdmfGrids::Double, stem: Some("mesh".into()) }
    }
}

/// A mesh in a format: the bytes of each file of [`Format::suffixes`], for an OBJ without a stem those of the first.
/// `stamps` (key and value) tell how the mesh was made, in formats with a place for them (VTU). The same mesh gives the
/// same bytes.
///
/// # Errors
/// `Unsupported` where the format cannot hold such a mesh; `InvalidInput` where the lists of the mesh do not fit
/// together or it is too large for the format.
pub fn encode(
    mesh: &Mesh,
    stamps: &[(String, String)],
    format: Format,
    options: &WriteOptions,
) -> io::Result<Vec<Vec<u8>>> {
    format.holds_order(mesh.order())?;
    let write = format.facts().write.ok_or_else(|| {
        let what = format!("{} holds tetrahedra only: give a solid", format.name());
        io::Error::new(io::ErrorKind::Unsupported, what)
    })?;
    if options.interior_lines {
        return write(mesh, stamps, options);
    }
    groups::check(mesh)?;
    write(&groups::without_interior(mesh), stamps, options)
}

/// A mesh of tetrahedra in a format, as [`encode`] gives it.
///
/// # Errors
/// `Unsupported` where the format cannot hold tetrahedra; `InvalidInput` where the lists of the mesh do not fit
/// together or it is too large for the format.
pub fn encode_solid(mesh: &SolidMesh, stamps: &[(String, String)], format: Format) -> io::Result<Vec<Vec<u8>>> {
    let write = format.facts().write_solid.ok_or_else(|| {
        let holding: Vec<_> = Format::ALL.into_iter().filter(|f| f.holds_solids()).map(Format::name).collect();
        let what = format!("{} holds no tetrahedra: say --format {}", format.name(), holding.join(", "));
        io::Error::new(io::ErrorKind::Unsupported, what)
    })?;
    write(mesh, stamps)
}

/// An output of one file.
fn one_file(write: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> io::Result<Files> {
    Ok(vec![file(write)?])
}

fn file(write: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write(&mut bytes)?;
    Ok(bytes)
}

// ---- reading ----

/// A mesh as read, with stamps and notes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// The mesh, with the names that the file has.
    pub mesh: Mesh,
    /// Keys and values that our writer added; empty for a file of another program.
    pub stamps: Vec<(String, String)>,
    /// Notes about what was left out, one sentence each.
    pub notes: Vec<String>,
}

/// Why a file holds no mesh that can be read, and what can be done.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct MeshError {
    /// What is wrong, with the place in the file where there is one.
    pub what: String,
    /// What the user can do.
    pub help: String,
}

type Result<T> = std::result::Result<T, MeshError>;

/// Reads a mesh. `beside` are the files of [`Reading::beside`], in its order.
///
/// # Errors
/// [`MeshError`] with the place where the file breaks its format, or with what cannot be read, or that the format is
/// only written. Never panics, and takes memory in proportion to the bytes.
pub fn read(bytes: &[u8], format: Format, beside: &[Option<Vec<u8>>]) -> Result<MeshFile> {
    match format.reading() {
        Some(reading) => (reading.read)(bytes, beside),
        None => Err(unsupported(format!("{} is only written", format.name()), "give the mesh in another format")),
    }
}

fn broken(what: impl Into<String>) -> MeshError {
    MeshError { what: what.into(), help: "the file is damaged or of another format: write it anew".into() }
}

fn broken_at(line: usize, what: impl std::fmt::Display) -> MeshError {
    broken(format!("line {line}: {what}"))
}

fn unsupported(what: impl Into<String>, help: &str) -> MeshError {
    MeshError { what: what.into(), help: help.into() }
}

/// Whether a file starts with one of these words, in any case.
fn begins(start: &[u8], words: &[&str]) -> bool {
    words.iter().any(|word| start.get(..word.len()).is_some_and(|s| s.eq_ignore_ascii_case(word.as_bytes())))
}

/// Lines of a text with their numbers from 1.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    bytes.split(|&b| b == b'\n').enumerate().map(|(i, line)| (i + 1, line.trim_ascii()))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
