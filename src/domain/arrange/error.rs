//! Why there is no domain.

use crate::geometry::{Point, scaled};
use crate::watch::Stopped;

/// A flaw that cannot be repaired, its place, and a remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} at ({}, {})", at.x, at.y)]
pub struct ArrangeError {
    /// What is wrong, with the entities.
    pub what: String,
    /// The first place of the flaw, in the drawing's coordinates.
    pub at: Point,
    /// Further places of the same flaw, as many as `what` lists.
    pub also_at: Vec<Point>,
    /// What the user can do.
    pub help: String,
    /// Whether the reason is that features lie too near to each other. Then a coarser tolerance may make them one.
    pub near: bool,
}

/// Why there is no domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unarranged {
    /// The drawing has a flaw that cannot be repaired.
    #[error(transparent)]
    Invalid(#[from] ArrangeError),
    /// The `watch` function ended the run.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl Unarranged {
    /// The same with its places times a factor.
    pub(super) fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Invalid(error) => {
                let also_at = error.also_at.iter().map(|at| scaled(*at, factor)).collect();
                ArrangeError { at: scaled(error.at, factor), also_at, ..error }.into()
            }
            Self::Stopped(_) => self,
        }
    }
}

impl ArrangeError {
    /// A flaw at one place.
    pub(super) fn new(what: impl Into<String>, at: Point, help: impl Into<String>) -> Self {
        Self { what: what.into(), at, also_at: Vec::new(), help: help.into(), near: false }
    }

    /// A flaw at one place where features lie too near to each other.
    pub(super) fn near(what: impl Into<String>, at: Point, help: impl Into<String>) -> Self {
        Self { near: true, ..Self::new(what, at, help) }
    }
}
