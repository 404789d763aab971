//! Files that are not drawings. They are recognised by their first bytes, else by their suffix, and refused by name
//! with a remedy. The bytes of a format are listed only if no drawing begins with them.

use super::{ImportError, number};
use std::path::Path;

/// What can be done with a file of a kind.
#[derive(Clone, Copy)]
enum Way {
    /// A mesh in a format that squinch reads.
    Mesh,
    /// A mesh in a format that squinch does not read.
    OtherMesh,
    /// A raster image.
    Pixels,
    /// Curves that another program saves as SVG.
    Page,
    /// Curves that a CAD system saves as DXF.
    Cad,
    Archive,
    /// Toolpaths of a machine.
    Machine,
    Other,
}

impl Way {
    fn help(self) -> &'static str {
        match self {
            Self::Mesh => {
                "`squinch check` verifies meshes and `squinch convert` rewrites them; to make a mesh, give the drawing"
            }
            Self::OtherMesh => {
                "convert it with Gmsh or meshio to .msh or .vtu for `squinch check` and `squinch convert`; to make a mesh, give the drawing"
            }
            Self::Pixels => "trace it first: Inkscape (Path > Trace Bitmap) or potrace make an SVG of it",
            Self::Page => "save it as SVG: Inkscape, or `pdftocairo -svg` for PDF, does that",
            Self::Cad => {
                "save it as DXF in the program that made it; LibreDWG's `dwg2dxf` and the ODA File Converter read DWG"
            }
            Self::Archive => "unpack it, and give the drawing that is in it",
            Self::Machine => "give the drawing that the paths were made from, as DXF or SVG",
            Self::Other => "give a drawing: SVG, DXF, airfoil coordinates, .poly, or an outline in JSON",
        }
    }
}

/// How a format is recognised by its content.
enum Sign {
    /// These bytes at these offsets.
    Bytes(&'static [(usize, &'static [u8])]),
    /// The first line that is not blank begins with this, in any case.
    Start(&'static str),
    /// A line of the head begins with this, in any case.
    Line(&'static str),
    Test(fn(&Head) -> bool),
}

const SIGNS: &[(&str, Way, Sign)] = &[
    ("a PNG image", Way::Pixels, Sign::Bytes(&[(0, b"\x89PNG")])),
    ("a JPEG image", Way::Pixels, Sign::Bytes(&[(0, b"\xff\xd8\xff")])),
    ("a GIF image", Way::Pixels, Sign::Bytes(&[(0, b"GIF8"), (5, b"a")])),
    ("a TIFF image", Way::Pixels, Sign::Bytes(&[(0, b"II*\0")])),
    ("a TIFF image", Way::Pixels, Sign::Bytes(&[(0, b"MM\0*")])),
    ("a WebP image", Way::Pixels, Sign::Bytes(&[(0, b"RIFF"), (8, b"WEBP")])),
    ("a BMP image", Way::Pixels, Sign::Bytes(&[(0, b"BM"), (6, b"\0\0\0\0")])),
    ("a HEIC or AVIF image, or a film", Way::Pixels, Sign::Bytes(&[(4, b"ftyp")])),
    ("a Photoshop image", Way::Pixels, Sign::Bytes(&[(0, b"8BPS")])),
    ("a GIMP image", Way::Pixels, Sign::Bytes(&[(0, b"gimp xcf")])),
    ("a PDF document", Way::Page, Sign::Bytes(&[(0, b"%PDF-")])),
    ("a PostScript file (EPS, AI)", Way::Page, Sign::Bytes(&[(0, b"%!PS")])),
    ("a PostScript file (EPS, AI)", Way::Page, Sign::Bytes(&[(0, b"\xc5\xd0\xd3\xc6")])),
    ("a CorelDRAW drawing", Way::Page, Sign::Bytes(&[(0, b"RIFF"), (8, b"CDR")])),
    ("an EMF image", Way::Page, Sign::Bytes(&[(40, b" EMF")])),
    ("a WMF image", Way::Page, Sign::Bytes(&[(0, b"\xd7\xcd\xc6\x9a")])),
    ("an Xfig drawing", Way::Page, Sign::Bytes(&[(0, b"#FIG ")])),
    ("an AutoCAD drawing (DWG)", Way::Cad, Sign::Bytes(&[(0, b"AC1"), (6, b"\0")])),
    ("a DWF drawing", Way::Cad, Sign::Bytes(&[(0, b"(DWF V")])),
    ("a Rhino model (3DM)", Way::Cad, Sign::Bytes(&[(0, b"3D Geometry File Format")])),
    ("an IGES model", Way::Cad, Sign::Bytes(&[(72, b"S      1")])),
    ("a ZIP archive", Way::Archive, Sign::Bytes(&[(0, b"PK\x03\x04")])),
    ("a ZIP archive", Way::Archive, Sign::Bytes(&[(0, b"PK\x05\x06")])),
    ("a 7z archive", Way::Archive, Sign::Bytes(&[(0, b"7z\xbc\xaf\x27\x1c")])),
    ("a RAR archive", Way::Archive, Sign::Bytes(&[(0, b"Rar!\x1a\x07")])),
    ("an xz archive", Way::Archive, Sign::Bytes(&[(0, b"\xfd7zXZ\0")])),
    ("a bzip2 archive", Way::Archive, Sign::Bytes(&[(0, b"BZh"), (4, b"1AY&SY")])),
    ("a Zstandard archive", Way::Archive, Sign::Bytes(&[(0, b"\x28\xb5\x2f\xfd")])),
    ("an old Office document", Way::Other, Sign::Bytes(&[(0, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")])),
    ("an HDF5 file (CGNS, MED)", Way::OtherMesh, Sign::Bytes(&[(0, b"\x89HDF\r\n\x1a\n")])),
    ("a NetCDF file (Exodus)", Way::OtherMesh, Sign::Bytes(&[(0, b"CDF\x01")])),
    ("a NetCDF file (Exodus)", Way::OtherMesh, Sign::Bytes(&[(0, b"CDF\x02")])),
    ("a glTF model", Way::OtherMesh, Sign::Bytes(&[(0, b"glTF")])),
    ("an OBJ surface", Way::Mesh, Sign::Test(is_obj)),
    ("a PLY surface", Way::OtherMesh, Sign::Test(|head| head.starts("ply") && head.has_line("format "))),
    ("a VTK file", Way::Mesh, Sign::Start("# vtk DataFile")),
    ("a VTK file (XML)", Way::Mesh, Sign::Test(|head| head.starts("<") && head.text.contains("<VTKFile"))),
    ("a Gmsh mesh", Way::Mesh, Sign::Line("$MeshFormat")),
    ("a Gmsh script", Way::OtherMesh, Sign::Test(is_geo)),
    (
        "an SU2 mesh",
        Way::Mesh,
        Sign::Test(|head| ["NDIME", "NELEM", "NPOIN", "NZONE"].iter().any(|key| head.has_key(key))),
    ),
    ("a MEDIT mesh", Way::OtherMesh, Sign::Line("MeshVersionFormatted")),
    ("a Netgen mesh", Way::OtherMesh, Sign::Start("mesh3d")),
    ("a finite element deck (Abaqus, CalculiX)", Way::Mesh, Sign::Test(is_inp)),
    ("a Nastran deck", Way::OtherMesh, Sign::Line("BEGIN BULK")),
    ("a UNV mesh", Way::OtherMesh, Sign::Test(is_unv)),
    (
        "a page of HTML",
        Way::Other,
        Sign::Test(|head| !head.is_svg && (head.starts("<!doctype html") || head.starts("<html"))),
    ),
    (
        "an XML document that is not SVG",
        Way::Other,
        Sign::Test(|head| !head.is_svg && (head.starts("<?xml") || head.starts("<!"))),
    ),
    ("a Gerber file", Way::Machine, Sign::Test(|head| head.has_line("%FS") && head.text.contains("*%"))),
    (
        "an Excellon drill file",
        Way::Machine,
        Sign::Test(|head| head.starts("M48") && head.text.lines().nth(1).is_some()),
    ),
    ("G-code", Way::Machine, Sign::Test(is_gcode)),
    ("a plotter file (HPGL)", Way::Machine, Sign::Test(|head| head.text.contains("PU") && head.text.contains(";PD"))),
];

/// Suffixes, for files whose content was not recognised.
const SUFFIXES: &[(&[&str], &str, Way)] = &[
    (&["png", "jpg", "jpeg", "gif", "tif", "tiff", "webp", "bmp", "heic"], "a raster image", Way::Pixels),
    (&["pdf", "ps", "eps", "ai", "cdr", "emf", "wmf", "fig", "odg", "vsd", "vsdx"], "a document", Way::Page),
    (
        &["dwg", "dwf", "iges", "igs", "3dm", "sldprt", "sldasm", "ipt", "f3d", "fcstd", "x_t", "x_b", "sat"],
        "a CAD file",
        Way::Cad,
    ),
    (&["zip", "7z", "rar", "tar", "gz", "tgz", "xz", "bz2", "zst"], "an archive", Way::Archive),
    (&["vtu", "vtk", "msh", "su2", "inp", "obj", "ele"], "a mesh by its suffix", Way::Mesh),
    (
        &[
            "ply", "mesh", "meshb", "vol", "unv", "bdf", "nas", "cgns", "med", "e", "exo", "xdmf", "glb", "gltf",
            "geo", "3mf", "amf", "wrl", "x3d",
        ],
        "a mesh or a model by its suffix",
        Way::OtherMesh,
    ),
    (&["gcode", "nc", "ngc", "tap", "cnc", "gbr", "ger", "drl", "plt", "hpgl"], "a file for a machine", Way::Machine),
    (
        &["html", "htm", "xml", "doc", "docx", "xls", "xlsx", "md", "py", "tex"],
        "not a drawing by its suffix",
        Way::Other,
    ),
];

/// The refusal of a file by its first bytes, if they are of another kind.
pub(super) fn by_content(bytes: &[u8]) -> Option<ImportError> {
    let head = Head::of(bytes);
    let (what, way, _) = SIGNS.iter().find(|(_, _, sign)| match sign {
        Sign::Bytes(parts) => parts.iter().all(|(at, part)| bytes.get(*at..at + part.len()) == Some(*part)),
        Sign::Start(word) => head.starts(word),
        Sign::Line(word) => head.has_line(word),
        Sign::Test(test) => test(&head),
    })?;
    Some(ImportError::new(format!("this is {what}, not a drawing"), way.help()))
}

/// The refusal of a file by its suffix, if it is of another kind.
pub(super) fn by_suffix(path: &Path) -> Option<ImportError> {
    let suffix = path.extension()?.to_str()?.to_ascii_lowercase();
    let (_, what, way) = SUFFIXES.iter().find(|(suffixes, _, _)| suffixes.contains(&suffix.as_str()))?;
    Some(ImportError::new(format!("a .{suffix} file is {what}, not a drawing"), way.help()))
}

/// The start of a file.
struct Head {
    /// Its first lines, as far as they are text, without leading blanks.
    text: String,
    is_svg: bool,
}

impl Head {
    fn of(bytes: &[u8]) -> Self {
        // Decks and meshes may begin with comments, which are seldom longer.
        const LENGTH: usize = 4096;
        let plain = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        let text = String::from_utf8_lossy(&plain[..plain.len().min(LENGTH)]).replace('\r', "\n");
        Self { text, is_svg: super::svg::sniff(plain) }
    }

    fn starts(&self, word: &str) -> bool {
        starts(&self.text, word)
    }

    fn has_line(&self, word: &str) -> bool {
        self.text.lines().any(|line| starts(line.trim_start(), word))
    }

    /// Whether a line assigns to a key, as `NDIME= 2` does.
    fn has_key(&self, key: &str) -> bool {
        self.text.lines().any(|line| line.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('=')))
    }

    fn fields(&self) -> impl Iterator<Item = Vec<&str>> {
        self.text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>()).filter(|fields| !fields.is_empty())
    }
}

fn starts(text: &str, word: &str) -> bool {
    text.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word))
}

fn is_number(field: &str) -> bool {
    number(field.as_bytes()).is_some()
}

fn is_obj(head: &Head) -> bool {
    let vertices =
        |fields: &Vec<&str>| fields[0] == "v" && fields.len() >= 4 && fields[1..4].iter().all(|f| is_number(f));
    head.fields().filter(vertices).count() >= 3 && !head.starts("solid")
}

fn is_geo(head: &Head) -> bool {
    ["Point(", "Point (", "Line(", "Line ("].iter().any(|word| head.has_line(word)) && head.text.contains('{')
}

/// Whether a line begins with a keyword of a deck. Comments have two stars.
fn is_inp(head: &Head) -> bool {
    ["*NODE", "*HEADING", "*ELEMENT", "*PART", "*PREPRINT"].iter().any(|word| head.has_line(word))
}

fn is_unv(head: &Head) -> bool {
    let mut lines = head.fields();
    let is_dataset =
        |fields: Vec<&str>| matches!(fields[..], ["151" | "164" | "2411" | "2420" | "2412" | "15" | "781"]);
    lines.next().is_some_and(|fields| fields == ["-1"]) && lines.next().is_some_and(is_dataset)
}

/// Whether two of the first fifty lines hold motions, each after at most a block number.
fn is_gcode(head: &Head) -> bool {
    let is_word = |word: &str, letter: char| {
        word.strip_prefix(letter).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    let is_motion = |fields: &Vec<&str>| is_word(fields[usize::from(fields.len() > 1 && is_word(fields[0], 'N'))], 'G');
    head.fields().take(50).filter(is_motion).count() >= 2
}
