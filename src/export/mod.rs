//! Writers: Mesh → files. One file a format; a writer says what its format cannot hold.

pub mod picture;
pub mod vtu;

use crate::domain::Domain;
use crate::mesh::Mesh;
use picture::{MeshColour, PictureOptions, picture_of_mesh};
use std::io::{self, Write};
use std::path::Path;

/// A format that a mesh can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// VTK XML unstructured grid: all that a mesh holds.
    Vtu,
    /// A picture as text: holds no mesh.
    Svg,
    /// A picture in pixels: holds no mesh.
    Png,
}

impl Format {
    pub const ALL: [Self; 3] = [Self::Vtu, Self::Svg, Self::Png];

    /// The name and suffix: "vtu", "svg", "png".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Vtu => "vtu",
            Self::Svg => "svg",
            Self::Png => "png",
        }
    }

    /// The format of this name, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name().eq_ignore_ascii_case(name))
    }
}

/// The format that a path's suffix asks for.
pub fn format_of(path: &Path) -> Option<Format> {
    Format::named(path.extension()?.to_str()?)
}

/// Writes a mesh in a format. Pictures show quality, with the exact curves where the domain is given.
pub fn write_mesh(
    mesh: &Mesh,
    domain: Option<&Domain>,
    stamps: &[(String, String)],
    format: Format,
    out: &mut impl Write,
) -> io::Result<()> {
    let picture = || picture_of_mesh(mesh, domain, MeshColour::Quality, &PictureOptions::default());
    match format {
        Format::Vtu => vtu::write(mesh, stamps, out),
        Format::Svg => out.write_all(picture().svg()?.as_bytes()),
        Format::Png => out.write_all(&picture().png(1.0)?),
    }
}
