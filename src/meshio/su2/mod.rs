//! SU2's native mesh, in two dimensions.

mod read;
mod solid;
mod write;

use super::losses::Losses;
use super::{Facts, Reading, begins, one_file};

/// The facts of SU2.
pub(super) const FACTS: Facts = Facts {
    name: "su2",
    suffixes: &["su2"],
    first_as_named: true,
    choices: &[],
    straight_only: Some("SU2 has straight cells only: mesh with --order 1"),
    write: Some(|mesh, _, _| one_file(|out| write::write(mesh, out))),
    write_solid: Some(|mesh, _| one_file(|out| solid::write(mesh, out))),
    losses,
    reading: Some(Reading {
        suffix: "su2",
        beside: &[],
        begins: |start| begins(start, &["NDIME", "NZONE", "%"]),
        read: |bytes, _| read::read(bytes),
    }),
};

fn losses(losses: &mut Losses) {
    let several = losses.mesh.regions.len() > 1;
    losses.tell(several, "regions: SU2 has one zone");
    losses.tell(several, "names of interfaces: SU2's markers are at the rim");
    losses.plane();
    losses.names_of_points();
    losses.unit();
    losses.links();
}
