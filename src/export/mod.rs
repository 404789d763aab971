//! Writers: Mesh → files. One file a format; a writer says what its format cannot hold.

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
    /// Wavefront.
    Obj,
    /// STL, text.
    Stl,
    /// A picture as text: holds no mesh.
    Svg,
    /// A picture in pixels: holds no mesh.
    Png,
}

impl Format {
    pub const ALL: [Self; 14] = [
        Self::Vtu,
        Self::Vtk,
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
            Self::Vtk => &["vtk"],
            Self::Msh | Self::Msh22 => &["msh"],
            Self::Su2 => &["su2"],
            Self::Inp => &["inp"],
            Self::Xdmf => &["xdmf"],
            Self::Triangle => &["node", "ele", "poly"],
            Self::Glb => &["glb"],
            Self::Gltf => &["gltf"],
            Self::Obj => &["obj"],
            Self::Stl => &["stl"],
            Self::Svg => &["svg"],
            Self::Png => &["png"],
        }
    }

    /// The format of this name, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name().eq_ignore_ascii_case(name))
    }

    /// What of this mesh the format does not hold, or holds as something else: a phrase each, for people.
    pub fn losses(self, mesh: &Mesh) -> Vec<&'static str> {
        use Format::{Glb, Gltf, Inp, Msh, Msh22, Obj, Png, Stl, Su2, Svg, Triangle, Vtk, Vtu};
        if matches!(self, Svg | Png) {
            return vec!["the mesh: a picture shows it"];
        }
        let mut losses = Vec::new();
        let mut lost = |where_so: bool, what| {
            if where_so {
                losses.push(what);
            }
        };
        lost(mesh.regions.len() > 1 && self == Su2, "regions: SU2 has one zone");
        lost(!mesh.edges.is_empty() && self == Stl, "boundaries: STL has triangles only");
        lost(mesh.regions.len() > 1 && self == Su2, "names of interfaces: SU2's markers are at the rim");
        lost(
            mesh.frame.is_some() && self == Inp,
            "surfaces of boundaries: these are shells, only node sets are written",
        );
        lost(
            mesh.frame.is_some() && matches!(self, Su2 | Triangle),
            "the plane in space: coordinates are the plane's own",
        );
        lost(!mesh.named_nodes.is_empty() && !matches!(self, Msh | Msh22), "names of points");
        let straight = matches!(self, Glb | Gltf | Obj | Stl);
        lost(mesh.order() > 1 && straight, "order 2: each triangle is written as four straight ones");
        let unitless = matches!(self, Vtk | Msh | Msh22 | Su2 | Triangle | Stl);
        lost(mesh.unit.is_some() && unitless, "the unit: coordinates stay as they are");
        lost(matches!(self, Glb | Gltf), "digits: coordinates are float32 about the middle of the mesh");
        let linked = !mesh.balls.is_empty() || mesh.edges.iter().any(|e| e.link.is_some());
        lost(linked && !matches!(self, Vtu), "links to curves and protecting balls");
        losses
    }
}

/// The format that a path's suffix asks for.
pub fn format_of(path: &Path) -> Option<Format> {
    let suffix = path.extension()?.to_str()?;
    Format::ALL.into_iter().find(|f| f.suffixes().iter().any(|s| s.eq_ignore_ascii_case(suffix)))
}

/// A mesh in a format: the bytes of each file of [`Format::suffixes`]. Pictures show quality, with the exact curves where the
/// domain is given. `stamps` (key and value) say how the mesh was made, where the format has a place for them (VTU).
///
/// # Errors
/// `Unsupported` where the format cannot hold such a mesh at all; `InvalidInput` where the mesh's lists do not fit together or it
/// is too large for the format.
pub fn encode(
    mesh: &Mesh,
    domain: Option<&Domain>,
    stamps: &[(String, String)],
    format: Format,
) -> io::Result<Vec<Vec<u8>>> {
    let picture = || picture_of_mesh(mesh, domain, MeshColour::Quality, &PictureOptions::default());
    let mut out = Vec::new();
    match format {
        Format::Vtu => vtu::write(mesh, stamps, &mut out)?,
        Format::Vtk => vtk::write(mesh, &mut out)?,
        Format::Msh => msh::write_41(mesh, &mut out)?,
        Format::Msh22 => msh::write_22(mesh, &mut out)?,
        Format::Su2 => su2::write(mesh, &mut out)?,
        Format::Inp => inp::write(mesh, &mut out)?,
        Format::Xdmf => xdmf::write(mesh, &mut out)?,
        Format::Glb => gltf::write_glb(mesh, &mut out)?,
        Format::Gltf => gltf::write_gltf(mesh, &mut out)?,
        Format::Obj => obj::write(mesh, &mut out)?,
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
