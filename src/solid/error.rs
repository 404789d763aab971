//! Why there is no solid.

/// What cannot be repaired, where, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} at ({}, {}, {})", at[0], at[1], at[2])]
pub struct SolidError {
    /// What is wrong, with the entities.
    pub what: String,
    /// The first place of the flaw, in the coordinates of the file.
    pub at: [f64; 3],
    /// Further places of the same flaw, as many as are listed.
    pub also_at: Vec<[f64; 3]>,
    /// What the user can do.
    pub help: String,
}

impl SolidError {
    pub(super) fn new(what: impl Into<String>, at: [f64; 3], help: impl Into<String>) -> Self {
        Self { what: what.into(), at, also_at: Vec::new(), help: help.into() }
    }

    /// With further places of the same flaw.
    pub(super) fn also_at(self, also_at: impl IntoIterator<Item = [f64; 3]>) -> Self {
        Self { also_at: also_at.into_iter().collect(), ..self }
    }
}
