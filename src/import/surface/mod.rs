//! Readers of surfaces in space: bytes → [`crate::solid::Surfaces`].

mod off;
mod stl;
mod tetgen;
mod text;

use super::{Certainty, Facts};
pub(super) use tetgen::{begins_as_tetgen, in_space as is_tetgen, read_poly};

/// The facts of TetGen's `.smesh`.
pub(super) const FACTS_OF_SMESH: Facts = Facts {
    name: "smesh",
    suffixes: &["smesh"],
    // Rows of numbers: only the suffix tells it from a `.poly`.
    sign: |_| false,
    certainty: Certainty::Numbers,
    read: |bytes, _, _| tetgen::read_smesh(bytes).map(Into::into),
};

/// The facts of OFF.
pub(super) const FACTS_OF_OFF: Facts = Facts {
    name: "off",
    suffixes: &["off"],
    sign: off::sniff,
    certainty: Certainty::Mark,
    read: |bytes, _, _| off::read(bytes).map(Into::into),
};

/// The facts of STL.
pub(super) const FACTS_OF_STL: Facts = Facts {
    name: "stl",
    suffixes: &["stl"],
    sign: stl::sniff,
    certainty: Certainty::Mark,
    read: |bytes, _, _| stl::read(bytes).map(Into::into),
};
