//! Wavefront OBJ, with its materials.

mod read;
mod write;

use super::losses::Losses;
use super::{Choice, Facts, Reading, WriteOptions, begins, file};

/// The facts of OBJ.
pub(super) const FACTS: Facts = Facts {
    name: "obj",
    suffixes: &["obj", "mtl"],
    first_as_named: true,
    choices: &[Choice::Lines],
    straight_only: None,
    write: Some(|mesh, _, options| {
        let (lines, stem) = (has_lines(options), options.stem.as_deref());
        let mut files = vec![file(|out| write::write(mesh, lines, stem, out))?];
        if stem.is_some() {
            files.push(file(|out| write::write_materials(mesh, lines, out))?);
        }
        Ok(files)
    }),
    write_solid: None,
    losses,
    reading: Some(Reading {
        suffix: "obj",
        beside: &[],
        begins: |start| begins(start, &["v ", "mtllib", "#"]),
        read: |bytes, _| read::read(bytes),
    }),
};

fn has_lines(options: &WriteOptions) -> bool {
    options.lines.unwrap_or(true)
}

fn losses(losses: &mut Losses) {
    let options = losses.options;
    let bare = "colours: OBJ has them in a .mtl file beside it, which standard output has no place for";
    losses.tell(options.stem.is_none(), bare);
    losses.interior_lines();
    losses.lines(has_lines(options));
    losses.names_of_points();
    losses.order_2();
    losses.links();
}
