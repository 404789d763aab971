//! Legacy VTK: written in binary or as text, read from both.

mod read;
mod write;

use super::losses::Losses;
use super::{Choice, Facts, Reading, WriteOptions, begins, one_file};

/// The facts of binary VTK.
pub(super) const FACTS: Facts = Facts {
    name: "vtk",
    suffixes: &["vtk"],
    first_as_named: true,
    choices: &[],
    straight_only: None,
    write: Some(|mesh, _, _| one_file(|out| write::write(mesh, out))),
    write_solid: None,
    losses: |losses| {
        losses.interior_lines();
        losses_of_both(losses);
    },
    reading: Some(Reading {
        suffix: "vtk",
        beside: &[],
        begins: |start| begins(start, &["# vtk"]),
        read: |bytes, _| read::read(bytes),
    }),
};

/// The facts of VTK as text.
pub(super) const FACTS_OF_TEXT: Facts = Facts {
    name: "vtk-text",
    choices: &[Choice::Lines],
    write: Some(|mesh, _, options| one_file(|out| write::write_text(mesh, has_lines(options), out))),
    write_solid: None,
    losses: |losses| {
        losses.interior_lines();
        let lineless = !losses.mesh.edges.is_empty() && !has_lines(losses.options);
        losses.tell(lineless, "boundaries as cells: they are field data; --lines on makes them lines");
        losses_of_both(losses);
    },
    ..FACTS
};

/// Whether the text has the boundaries as lines.
fn has_lines(options: &WriteOptions) -> bool {
    options.lines.unwrap_or(false)
}

fn losses_of_both(losses: &mut Losses) {
    losses.names_of_points();
    losses.unit();
    losses.links();
}
