//! STL: written as text, read from text or binary.

mod read;
mod write;

use super::losses::Losses;
use super::{Facts, Reading, begins, one_file};

/// The facts of STL.
pub(super) const FACTS: Facts = Facts {
    name: "stl",
    suffixes: &["stl"],
    first_as_named: true,
    choices: &[],
    straight_only: None,
    write: Some(|mesh, _, _| one_file(|out| write::write(mesh, out))),
    write_solid: None,
    losses,
    reading: Some(Reading {
        suffix: "stl",
        beside: &[],
        begins: |start| begins(start, &["solid"]),
        read: |bytes, _| read::read(bytes),
    }),
};

fn losses(losses: &mut Losses) {
    losses.tell(!losses.mesh.edges.is_empty(), "boundaries: STL has triangles only");
    losses.names_of_points();
    losses.order_2();
    losses.unit();
    losses.links();
}
