//! STEP (ISO 10303-21): one planar face of a solid, read where the feature `cad` is on.

#[cfg(feature = "cad")]
mod entity;
#[cfg(feature = "cad")]
mod read;
#[cfg(feature = "cad")]
mod space;
#[cfg(feature = "cad")]
mod units;

/// Entities may stand for others (surface curves, trimmed curves, units); a file may nest them in a ring.
#[cfg(feature = "cad")]
const MOST_NESTING: usize = 8;
/// Faces, and warnings of the parser, that notes list; `inspect` lists all faces.
#[cfg(feature = "cad")]
const MOST_LISTED: usize = 8;

#[cfg(feature = "cad")]
pub use read::{faces, read};

use super::{Certainty, Facts, without_bom};

/// The facts of STEP.
pub(super) const FACTS: Facts = Facts {
    name: "step",
    suffixes: &["step", "stp"],
    sign: |bytes| without_bom(bytes).trim_ascii_start().starts_with(b"ISO-10303-21"),
    certainty: Certainty::Mark,
    #[cfg(feature = "cad")]
    read: |bytes, stem, options| read(bytes, stem, options.face.as_deref()).map(Into::into),
    #[cfg(not(feature = "cad"))]
    read: |_, _, _| {
        let help = "build one that has: cargo install --locked --path . --features cad";
        Err(super::ImportError::new("this build has no STEP reader", help))
    },
};
