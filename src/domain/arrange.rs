//! Drawing → Domain: weld, meet, split, drop, trace, name. The only door to a [`Domain`].

use super::{Domain, Drawing, FillRule};
use crate::geometry::Point;

/// How a drawing is arranged.
#[derive(Clone, Debug, PartialEq)]
pub struct ArrangeOptions {
    /// Ends nearer than this are one vertex; `None`: 1e-9 of the diagonal, and ends that meet nothing else up to 1e-6 of it. 0 heals nothing.
    pub tolerance: Option<f64>,
    /// `None`: the drawing's own rule.
    pub fill: Option<FillRule>,
    /// `keep all`: an axis-parallel box named `box` is added and every bounded face kept.
    pub keep_all: bool,
}

impl Default for ArrangeOptions {
    fn default() -> Self {
        Self { tolerance: None, fill: None, keep_all: false }
    }
}

/// Something that was mended on the way in, with its place and size (a length; 0 where nothing moved).
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Repair {
    pub kind: RepairKind,
    pub at: [f64; 2],
    pub size: f64,
    /// One sentence with the entities.
    pub what: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RepairKind {
    /// Ends within the tolerance became one vertex.
    Weld,
    /// An open gap was closed to the nearest free end.
    GapClosed,
    /// A curve was split where another crosses, touches or ends on it.
    Split,
    /// A curve met itself and was split there.
    SelfSplit,
    /// A cusp or tangent jump became a corner.
    Corner,
    /// A curve that another repeats was dropped.
    Duplicate,
    /// Overlapping stretches became one.
    Overlap,
    /// A curve of no length was dropped.
    ZeroLength,
    /// A hole or region point that lies in no bounded face, or a second one in the same face.
    Seed,
}

/// What cannot be repaired, where, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} at ({}, {})", at.x, at.y)]
pub struct ArrangeError {
    /// What is wrong, with the entities.
    pub what: String,
    pub at: Point,
    /// What the user can do.
    pub help: String,
}

impl Drawing {
    /// The domain that the drawing describes.
    pub fn arrange(&self, _options: &ArrangeOptions) -> Result<Domain, ArrangeError> {
        todo!()
    }
}
