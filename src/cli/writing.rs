//! The options of writing, shared by the verbs that write meshes.

use super::output::{Output, stem};
use super::viewing::{Colour, window};
use super::{Halt, Volume, say};
use clap::Args;
use serde::Serialize;
use squinch::domain::Domain;
use squinch::geometry::Rect;
use squinch::mesh::Mesh;
use squinch::meshio::{self, Choice, WriteOptions, XdmfGrids};
use squinch::options::Switch;
use squinch::picture::{MeshColour, PictureOptions, picture_of_mesh};
use squinch::run::Outcome;
use std::io;
use std::path::Path;

/// Choices of writing, where a format or a reader of it leaves one.
#[derive(Args, Clone, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Writing {
    /// Boundaries with triangles on both sides: interfaces, and lines within a region
    #[arg(long, value_enum, default_value_t = Switch::On, value_name = "on|off", help_heading = "Formats")]
    interior_lines: Switch,
    /// Boundaries as lines in .glb, .gltf, .obj, vtk-text and plain VTU [default: on; off in the last two]
    #[arg(long, value_enum, value_name = "on|off", help_heading = "Formats")]
    lines: Option<Switch>,
    /// VTU without field data, and so without names, for readers that refuse it
    #[arg(long, help_heading = "Formats")]
    plain: bool,
    /// XDMF with triangles and lines in one grid (meshio, ParaView) or in two (FEniCSx)
    #[arg(long, value_enum, default_value_t = XdmfGrids::Double, value_name = "single|double", help_heading = "Formats")]
    xdmf: XdmfGrids,
    /// What the triangles of a picture are coloured by
    #[arg(long, value_enum, default_value_t = Colour::Quality, value_name = "BY", help_heading = "Pictures")]
    colour: Colour,
    /// The window that a picture shows, in the units of the mesh [default: all of it]
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = window, allow_hyphen_values = true, help_heading = "Pictures")]
    #[serde(serialize_with = "corners")]
    view: Option<Rect>,
}

/// A window in the form in which it is given.
fn corners<S: serde::Serializer>(view: &Option<Rect>, serializer: S) -> Result<S::Ok, S::Error> {
    view.map(|r| [r.x0, r.y0, r.x1, r.y1]).serialize(serializer)
}

impl Writing {
    /// Refuses `--colour layer`, which meshes do not have, before there is a mesh.
    pub fn check(&self) -> Result<(), Halt> {
        match self.colour {
            Colour::Layer => Err(Halt::Usage(
                "--colour layer: only for drawings, with draw --stage drawing; a mesh has --colour region".into(),
            )),
            Colour::Quality | Colour::Region | Colour::Paint | Colour::Size => Ok(()),
        }
    }

    /// The options of one output.
    fn options(&self, path: &Path) -> WriteOptions {
        WriteOptions {
            plain: self.plain,
            interior_lines: self.interior_lines.is_on(),
            lines: self.lines.map(Switch::is_on),
            xdmf: self.xdmf,
            stem: stem(path),
        }
    }

    /// The colouring and the options of a picture.
    fn picture(&self) -> (MeshColour, PictureOptions) {
        (self.colour.of_mesh(), PictureOptions { view: self.view, ..PictureOptions::default() })
    }

    /// What an output does not hold of this mesh.
    pub fn losses(&self, output: Output, mesh: &Mesh, path: &Path) -> Vec<&'static str> {
        match output {
            Output::Mesh(format) => format.losses(mesh, &self.options(path)),
            Output::Picture(_) => vec!["the mesh: a picture shows it"],
        }
    }

    /// The bytes of each file of an output; `None` where the run has no mesh.
    pub fn encode_outcome(
        &self,
        output: Output,
        outcome: &Outcome,
        stamps: &[(String, String)],
        path: &Path,
    ) -> Option<io::Result<Vec<Vec<u8>>>> {
        if let Some(mesh) = &outcome.mesh {
            return Some(self.encode(output, mesh, outcome.domain.as_ref(), stamps, path));
        }
        let mesh = outcome.solid.as_ref()?;
        Some(match output {
            Output::Mesh(format) => meshio::encode_solid(mesh, stamps, format),
            Output::Picture(_) => Err(io::Error::new(
                io::ErrorKind::Unsupported,
                "pictures of solids are not in this version: say -o part.vtu",
            )),
        })
    }

    /// The bytes of each file of an output. Pictures show the exact curves if the domain is given.
    pub fn encode(
        &self,
        output: Output,
        mesh: &Mesh,
        domain: Option<&Domain>,
        stamps: &[(String, String)],
        path: &Path,
    ) -> io::Result<Vec<Vec<u8>>> {
        match output {
            Output::Mesh(format) => meshio::encode(mesh, stamps, format, &self.options(path)),
            Output::Picture(format) => {
                let (colour, options) = self.picture();
                Ok(vec![format.encode(&picture_of_mesh(mesh, domain, colour, &options))?])
            }
        }
    }

    /// Reports options that no output uses.
    pub fn tell_unused(&self, outputs: &[Output], volume: Volume) {
        let leaves = |choice| outputs.iter().any(|output| matches!(output, Output::Mesh(f) if f.leaves(choice)));
        let pictures = outputs.iter().any(|output| matches!(output, Output::Picture(_)));
        let unused = [
            (self.plain && !leaves(Choice::Plain), "--plain: only for VTU"),
            (
                self.lines.is_some() && !leaves(Choice::Lines) && !(self.plain && leaves(Choice::PlainLines)),
                "--lines: only for glTF, OBJ, vtk-text and plain VTU",
            ),
            (self.xdmf == XdmfGrids::Single && !leaves(Choice::Grids), "--xdmf: only for XDMF"),
            (self.colour != Colour::Quality && !pictures, "--colour: only for pictures"),
            (self.view.is_some() && !pictures, "--view: only for pictures"),
        ];
        if volume > Volume::Quiet {
            unused.iter().filter(|(unused, _)| *unused).for_each(|(_, what)| say::line(&format!("  {what}")));
        }
    }
}
