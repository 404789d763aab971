//! Writers: Mesh → files. One file a format; a writer says what its format cannot hold.

mod colours;
pub mod gltf;
mod groups;
pub mod inp;
pub mod msh;
pub mod obj;
pub mod picture;
pub mod stl;
pub mod su2;
pub mod triangle;
pub mod vtk;
pub mod vtu;
pub mod xdmf;

use crate::domain::Domain;
use crate::geometry::Rect;
use crate::mesh::Mesh;
use picture::{MeshColour, PictureOptions, picture_of_mesh};
use std::io;
use std::path::Path;

/// A format that a mesh can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// VTK XML unstructured grid: all that a mesh holds.
    Vtu,
    /// Legacy VTK, binary.
    Vtk,
    /// Legacy VTK as text, for readers that know no other (MFEM, deal.II, Gmsh).
    VtkText,
    /// Gmsh 4.1, binary.
    Msh,
    /// Gmsh 2.2, text.
    Msh22,
    /// SU2, of two dimensions.
    Su2,
    /// Abaqus and CalculiX.
    Inp,
    /// XDMF 3, text.
    Xdmf,
    /// Triangle's `.node`, `.ele` and `.poly`.
    Triangle,
    /// glTF 2.0, binary.
    Glb,
    /// glTF 2.0, text.
    Gltf,
    /// Wavefront, with its materials.
    Obj,
    /// STL, text.
    Stl,
    /// A picture as text: holds no mesh.
    Svg,
    /// A picture in pixels: holds no mesh.
    Png,
}

impl Format {
    pub const ALL: [Self; 15] = [
        Self::Vtu,
        Self::Vtk,
        Self::VtkText,
        Self::Msh,
        Self::Msh22,
        Self::Su2,
        Self::Inp,
        Self::Xdmf,
        Self::Triangle,
        Self::Glb,
        Self::Gltf,
        Self::Obj,
        Self::Stl,
        Self::Svg,
        Self::Png,
    ];

    /// The name by which a user asks for the format.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Vtu => "vtu",
            Self::Vtk => "vtk",
            Self::VtkText => "vtk-text",
            Self::Msh => "msh",
            Self::Msh22 => "msh22",
            Self::Su2 => "su2",
            Self::Inp => "inp",
            Self::Xdmf => "xdmf",
            Self::Triangle => "triangle",
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Svg => "svg",
            Self::Png => "png",
        }
    }

    /// Suffixes of the files that one output consists of: of most formats one, in the order of [`encode`].
    pub const fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Vtu => &["vtu"],
            Self::Vtk | Self::VtkText => &["vtk"],
            Self::Msh | Self::Msh22 => &["msh"],
            Self::Su2 => &["su2"],
            Self::Inp => &["inp"],
            Self::Xdmf => &["xdmf"],
            Self::Triangle => &["node", "ele", "poly"],
            Self::Glb => &["glb"],
            Self::Gltf => &["gltf"],
            Self::Obj => &["obj", "mtl"],
            Self::Stl => &["stl"],
            Self::Svg => &["svg"],
            Self::Png => &["png"],
        }
    }

    /// The format of this name, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name().eq_ignore_ascii_case(name))
    }

    /// Whether the format is a picture, which holds no mesh.
    pub const fn is_picture(self) -> bool {
        matches!(self, Self::Svg | Self::Png)
    }

    /// Whether cells of this order can be written at all; where they are written as straight ones, [`Format::losses`] says so.
    ///
    /// # Errors
    /// `Unsupported`, with the way out.
    pub fn holds_order(self, order: u8) -> io::Result<()> {
        if order > 1 && self == Self::Su2 {
            return unsupported("SU2 has straight cells only: mesh with --order 1");
        }
        Ok(())
    }

    /// What of this mesh the format does not hold, or holds as something else, written so: a phrase each, for people.
    pub fn losses(self, mesh: &Mesh, options: &WriteOptions) -> Vec<&'static str> {
        use Format::{Glb, Gltf, Inp, Msh, Msh22, Obj, Stl, Su2, Triangle, Vtk, VtkText, Vtu};
        if self.is_picture() {
            return vec!["the mesh: a picture shows it"];
        }
        let mut losses = Vec::new();
        let mut lost = |where_so: bool, what| {
            if where_so {
                losses.push(what);
            }
        };
        let plain = options.plain && self == Vtu;
        lost(plain, "names, the unit, how the mesh was made: --plain leaves all field data out");
        lost(mesh.regions.len() > 1 && self == Su2, "regions: SU2 has one zone");
        let bare = self == Obj && options.stem.is_none();
        lost(bare, "colours: OBJ has them in a .mtl file beside it, which standard output has no place for");
        lost(!mesh.edges.is_empty() && self == Stl, "boundaries: STL has triangles only");
        let inside = !options.interior_lines && groups::interior(mesh).any(|inside| inside);
        lost(inside && !matches!(self, Stl | Su2), "boundaries within the domain: left out by --interior-lines off");
        let lineless = !mesh.edges.is_empty() && !options.has_lines(self);
        lost(lineless && matches!(self, Glb | Gltf | Obj | Vtu), "boundaries: --lines on writes them");
        lost(lineless && self == VtkText, "boundaries as cells: they are field data; --lines on makes them lines");
        lost(mesh.regions.len() > 1 && self == Su2, "names of interfaces: SU2's markers are at the rim");
        lost(
            mesh.frame.is_some() && self == Inp,
            "surfaces of boundaries: these are shells, only node sets are written",
        );
        lost(
            mesh.order() > 1 && mesh.frame.is_none() && self == Inp,
            "order 2 for meshio (5.3), which knows no CPS6; CalculiX and Abaqus read it",
        );
        lost(
            mesh.order() > 1 && options.xdmf == XdmfGrids::Single && self == Format::Xdmf,
            "order 2 for meshio (5.3), which reads only straight cells in one grid of both kinds; ParaView reads it",
        );
        lost(
            mesh.frame.is_some() && matches!(self, Su2 | Triangle),
            "the plane in space: coordinates are the plane's own",
        );
        lost(!mesh.named_nodes.is_empty() && !matches!(self, Msh | Msh22), "names of points");
        let straight = matches!(self, Glb | Gltf | Obj | Stl);
        lost(mesh.order() > 1 && straight, "order 2: each triangle is written as four straight ones");
        let unitless = matches!(self, Vtk | VtkText | Msh | Msh22 | Su2 | Triangle | Stl);
        let unitless = unitless || (self == Format::Xdmf && options.xdmf == XdmfGrids::Single);
        lost(mesh.unit.is_some() && unitless, "the unit: coordinates stay as they are");
        lost(matches!(self, Glb | Gltf), "digits: coordinates are float32 about the middle of the mesh");
        let linked = !mesh.balls.is_empty() || mesh.edges.iter().any(|e| e.link.is_some());
        lost(linked && !matches!(self, Vtu), "links to curves and protecting balls");
        losses
    }
}

/// How XDMF holds triangles and lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum XdmfGrids {
    /// One grid of both kinds of cells, as meshio and ParaView take them.
    Single,
    /// A grid of triangles and one of lines, as FEniCSx takes them.
    #[default]
    Double,
}

/// How a mesh is written where a format, or a reader of it, leaves a choice.
#[derive(Clone, Debug, PartialEq)]
pub struct WriteOptions {
    /// VTU without field data, and so without names.
    pub plain: bool,
    /// Whether boundaries with triangles on both sides are written: interfaces, and lines within a region.
    pub interior_lines: bool,
    /// Whether the boundaries are written as lines, in formats that have readers who go wrong beside lines: glTF, OBJ, text VTK and
    /// plain VTU. `None`: in the first two.
    pub lines: Option<bool>,
    pub xdmf: XdmfGrids,
    /// What triangles of a picture are coloured by.
    pub colour: MeshColour,
    /// The window that a picture shows; `None`: all of the mesh.
    pub view: Option<Rect>,
    /// The name without suffix by which the files of one output speak of each other: OBJ's of its `.mtl`. `None`: an output that is a
    /// stream, and its first file alone.
    pub stem: Option<String>,
}

impl WriteOptions {
    /// Whether a format has the boundaries as lines.
    fn has_lines(&self, format: Format) -> bool {
        match format {
            Format::Glb | Format::Gltf | Format::Obj => self.lines.unwrap_or(true),
            Format::VtkText => self.lines.unwrap_or(false),
            Format::Vtu if self.plain => self.lines.unwrap_or(false),
            Format::Stl => false,
            Format::Vtu
            | Format::Vtk
            | Format::Msh
            | Format::Msh22
            | Format::Su2
            | Format::Inp
            | Format::Xdmf
            | Format::Triangle
            | Format::Svg
            | Format::Png => true,
        }
    }
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            plain: false,
            interior_lines: true,
            lines: None,
            xdmf: XdmfGrids::Double,
            colour: MeshColour::Quality,
            view: None,
            stem: Some("mesh".into()),
        }
    }
}

/// The format that a path's suffix asks for.
pub fn format_of(path: &Path) -> Option<Format> {
    let suffix = path.extension()?.to_str()?;
    Format::ALL.into_iter().find(|f| f.suffixes().iter().any(|s| s.eq_ignore_ascii_case(suffix)))
}

/// A mesh in a format: the bytes of each file of [`Format::suffixes`], of an OBJ without a stem those of the first. Pictures have the exact curves where the domain is given.
/// `stamps` (key and value) say how the mesh was made, where the format has a place for them (VTU).
///
/// # Errors
/// `Unsupported` where the format cannot hold such a mesh at all; `InvalidInput` where the mesh's lists do not fit together or it
/// is too large for the format.
pub fn encode(
    mesh: &Mesh,
    domain: Option<&Domain>,
    stamps: &[(String, String)],
    format: Format,
    options: &WriteOptions,
) -> io::Result<Vec<Vec<u8>>> {
    format.holds_order(mesh.order())?;
    let picture = || {
        let shown = PictureOptions { view: options.view, ..PictureOptions::default() };
        picture_of_mesh(mesh, domain, options.colour, &shown)
    };
    let rim;
    let mesh = if options.interior_lines || format.is_picture() {
        mesh
    } else {
        groups::check(mesh)?;
        rim = groups::without_interior(mesh);
        &rim
    };
    let lines = options.has_lines(format);
    let mut out = Vec::new();
    match format {
        Format::Vtu if options.plain => vtu::write_plain(mesh, lines, &mut out)?,
        Format::Vtu => vtu::write(mesh, stamps, &mut out)?,
        Format::Vtk => vtk::write(mesh, &mut out)?,
        Format::VtkText => vtk::write_text(mesh, lines, &mut out)?,
        Format::Msh => msh::write_41(mesh, &mut out)?,
        Format::Msh22 => msh::write_22(mesh, &mut out)?,
        Format::Su2 => su2::write(mesh, &mut out)?,
        Format::Inp => inp::write(mesh, &mut out)?,
        Format::Xdmf => xdmf::write(mesh, options.xdmf, &mut out)?,
        Format::Glb => gltf::write_glb(mesh, lines, &mut out)?,
        Format::Gltf => gltf::write_gltf(mesh, lines, &mut out)?,
        Format::Obj => {
            obj::write(mesh, lines, options.stem.as_deref(), &mut out)?;
            if options.stem.is_some() {
                let mut materials = Vec::new();
                obj::write_materials(mesh, lines, &mut materials)?;
                return Ok(vec![out, materials]);
            }
        }
        Format::Stl => stl::write(mesh, &mut out)?,
        Format::Svg => out = picture().svg()?.into_bytes(),
        Format::Png => out = picture().png(1.0)?,
        Format::Triangle => {
            let (mut elements, mut segments) = (Vec::new(), Vec::new());
            triangle::write_nodes(mesh, &mut out)?;
            triangle::write_elements(mesh, &mut elements)?;
            triangle::write_segments(mesh, &mut segments)?;
            return Ok(vec![out, elements, segments]);
        }
    }
    Ok(vec![out])
}

fn unsupported<T>(what: &str) -> io::Result<T> {
    Err(io::Error::new(io::ErrorKind::Unsupported, what))
}
