//! VTK XML unstructured grids: our own format, which holds all that a mesh has.

pub(super) mod array;
mod read;
mod solid;
mod unpack;
mod write;
mod xml;

use super::losses::Losses;
use super::{Choice, Facts, Reading, WriteOptions, one_file};

/// The facts of VTU.
pub(super) const FACTS: Facts = Facts {
    name: "vtu",
    suffixes: &["vtu"],
    first_as_named: true,
    choices: &[Choice::Plain, Choice::PlainLines],
    straight_only: None,
    write: Some(|mesh, stamps, options| {
        one_file(|out| match options.plain {
            true => write::write_plain(mesh, has_lines(options), out),
            false => write::write(mesh, stamps, out),
        })
    }),
    write_solid: Some(|mesh, stamps| one_file(|out| solid::write(mesh, stamps, out))),
    losses,
    reading: Some(Reading {
        suffix: "vtu",
        beside: &[],
        // An XML declaration and a comment may come first.
        begins: |start| {
            let head = &start[..start.len().min(1024)];
            start.starts_with(b"<") && head.windows(8).any(|word| word == b"<VTKFile")
        },
        read: |bytes, _| read::read(bytes),
    }),
};

fn has_lines(options: &WriteOptions) -> bool {
    !options.plain || options.lines.unwrap_or(false)
}

fn losses(losses: &mut Losses) {
    let options = losses.options;
    losses.tell(options.plain, "names, the unit, how the mesh was made: --plain leaves all field data out");
    losses.interior_lines();
    losses.lines(has_lines(options));
    losses.names_of_points();
}
