//! Gmsh's MSH: written as 4.1 or 2.2, read from both.

mod read;
mod solid;
mod write;

use super::losses::Losses;
use super::{Facts, Reading, begins, one_file};

/// The facts of MSH 4.1.
pub(super) const FACTS: Facts = Facts {
    name: "msh",
    suffixes: &["msh"],
    first_as_named: true,
    choices: &[],
    straight_only: None,
    write: Some(|mesh, _, _| one_file(|out| write::write_41(mesh, out))),
    write_solid: Some(|mesh, _| one_file(|out| solid::write_41(mesh, out))),
    losses,
    reading: Some(Reading {
        suffix: "msh",
        beside: &[],
        begins: |start| begins(start, &["$MeshFormat", "$Comments"]),
        read: |bytes, _| read::read(bytes),
    }),
};

/// The facts of MSH 2.2.
pub(super) const FACTS_OF_22: Facts = Facts {
    name: "msh22",
    write: Some(|mesh, _, _| one_file(|out| write::write_22(mesh, out))),
    write_solid: Some(|mesh, _| one_file(|out| solid::write_22(mesh, out))),
    ..FACTS
};

fn losses(losses: &mut Losses) {
    losses.interior_lines();
    losses.unit();
    losses.links();
}
