//! Abaqus' and CalculiX's input deck.

mod read;
mod solid;
mod write;

use super::losses::Losses;
use super::{Facts, Reading, begins, one_file};

/// The facts of the input deck.
pub(super) const FACTS: Facts = Facts {
    name: "inp",
    suffixes: &["inp"],
    first_as_named: true,
    choices: &[],
    straight_only: None,
    write: Some(|mesh, _, _| one_file(|out| write::write(mesh, out))),
    write_solid: Some(|mesh, _| one_file(|out| solid::write(mesh, out))),
    losses,
    reading: Some(Reading {
        suffix: "inp",
        beside: &[],
        begins: |start| begins(start, &["*"]),
        read: |bytes, _| read::read(bytes),
    }),
};

fn losses(losses: &mut Losses) {
    let (mesh, in_space) = (losses.mesh, losses.mesh.frame.is_some());
    losses.interior_lines();
    losses.tell(in_space, "surfaces of boundaries: these are shells, only node sets are written");
    losses.tell(
        mesh.order() > 1 && !in_space,
        "order 2 for meshio (5.3), which knows no CPS6; CalculiX and Abaqus read it",
    );
    losses.names_of_points();
    losses.links();
}
