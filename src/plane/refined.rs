//! The result of a refinement by either engine, and the errors that prevent one.

use super::insert::Degenerate;
use crate::geometry::{self, Point};
use crate::mesh::{Insertion, Mesh};
use crate::refine::{Counters, Stop};

/// A refined mesh, and how the refinement ended.
#[derive(Clone, Debug)]
pub struct Refined {
    /// `None` where the budget ended before the mesh was valid.
    pub mesh: Option<Mesh>,
    /// Number of vertices of the triangulation, inside kept regions or not.
    pub vertices: usize,
    /// Why refinement ended, and what is unresolved.
    pub stop: Stop,
    /// Amounts of work, by name.
    pub counters: Counters,
    /// The insertions in order, where the engine was asked to record them.
    pub insertions: Vec<Insertion>,
}

/// Why a domain cannot be meshed.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("{what} at ({}, {})", at.x, at.y)]
pub struct RefineError {
    /// What is wrong.
    pub what: String,
    /// The place, in the domain's coordinates.
    pub at: Point,
    /// What the user can do.
    pub help: String,
}

impl RefineError {
    /// The error that features are too near to each other at a place.
    pub(super) fn too_near(at: Point) -> Self {
        Self {
            what: "features lie nearer to each other than the coordinates can tell apart".to_owned(),
            at,
            help: "move the drawing nearer to the origin, or weld the features with a larger --tolerance".to_owned(),
        }
    }

    /// The error with its place multiplied by a power of two.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.at = geometry::scaled(self.at, factor);
        self
    }

    /// The error for points that have no triangulation.
    pub(super) fn degenerate(why: &Degenerate, points: &[Point]) -> Self {
        match *why {
            Degenerate::Duplicate { first, .. } => Self::too_near(points[first]),
            Degenerate::OutOfRange { index } => Self {
                what: "a coordinate is so small beside the others that exact signs cannot hold it".to_owned(),
                at: points[index],
                help: "round it to 0".to_owned(),
            },
            Degenerate::TooFew | Degenerate::Collinear => Self {
                what: "nothing to mesh: everything lies on one line".to_owned(),
                at: points.first().copied().unwrap_or_default(),
                help: "draw at least one closed outline".to_owned(),
            },
        }
    }
}
