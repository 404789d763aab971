//! Triangle's files (Shewchuk): `.node`, `.ele` and `.poly`.

mod read;
mod write;

use super::losses::Losses;
use super::{Facts, Reading, file};

/// The facts of Triangle's files.
pub(super) const FACTS: Facts = Facts {
    name: "triangle",
    suffixes: &["node", "ele", "poly"],
    first_as_named: false,
    choices: &[],
    straight_only: None,
    write: Some(|mesh, _, _| {
        Ok(vec![
            file(|out| write::write_nodes(mesh, out))?,
            file(|out| write::write_elements(mesh, out))?,
            file(|out| write::write_segments(mesh, out))?,
        ])
    }),
    write_solid: None,
    losses,
    reading: Some(Reading {
        suffix: "ele",
        beside: &["node", "poly"],
        // The files hold rows of numbers, as many others do.
        begins: |_| false,
        read: |bytes, beside| {
            let [nodes, segments] = [0, 1].map(|i| beside.get(i).and_then(Option::as_deref));
            read::read(bytes, nodes, segments)
        },
    }),
};

fn losses(losses: &mut Losses) {
    losses.interior_lines();
    losses.plane();
    losses.names_of_points();
    losses.unit();
    losses.links();
}
