//! `convert MESH OUT`: one mesh format to another, names kept.

use super::files::{self, Input, Staged, unwritable};
use super::output::Output;
use super::writing::Writing;
use super::{Halt, Volume, check, say};
use clap::Args;
use squinch::run::Exit;
use std::path::PathBuf;

/// One mesh format to another, names kept
#[derive(Args)]
pub struct Convert {
    /// A mesh file: .vtu, .vtk, .msh, .su2, .inp, .obj, .stl, .ele; - for standard input
    #[arg(value_name = "MESH")]
    mesh: PathBuf,
    /// Where the mesh goes; - for standard output
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// The format of the output, where its suffix gives none
    #[arg(long, value_parser = Output::named, value_name = "FORMAT")]
    format: Option<Output>,
    #[command(flatten)]
    writing: Writing,
}

impl Convert {
    /// Converts the mesh.
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        self.writing.check()?;
        let format = Output::of(&self.output, self.format)?;
        let outputs = format.files(&self.output);
        files::each_once([self.mesh.clone()].into_iter().chain(outputs.clone()))?;
        files::can_be_written(&outputs)?;
        self.writing.tell_unused(&[format], volume);
        let input = Input::open(&self.mesh, None)?;
        let file = check::read(&input)?;
        let encoded = self.writing.encode(format, &file.mesh, None, &file.stamps, &self.output);
        let encoded = encoded.map_err(|e| Halt::Unwritable(format!("{}: {e}", self.output.display())))?;
        let mut staged = Staged::default();
        outputs.iter().zip(&encoded).try_for_each(|(path, bytes)| staged.add(path, bytes)).map_err(unwritable)?;
        staged.commit().map_err(unwritable)?;
        if volume > Volume::Quiet {
            file.notes.iter().for_each(|note| say::line(&format!("  {}: {note}", input.path)));
            say::losses(format, &self.writing.losses(format, &file.mesh, &self.output));
        }
        Ok(Exit::Done)
    }
}
