//! The figure of an entity, or the reason why it has none.

use super::sections::Record;
use crate::curve::{Curve, CurveError};
use crate::geometry::{Point, Vec2};
use crate::import::ImportError;
use kurbo::Affine;
use std::collections::BTreeSet;

/// Why a text has no curves.
pub(super) const NO_OUTLINE: &str = "glyphs of a font, no outline";
/// Why an entity in another plane is left out.
pub(super) const TILTED: &str = "not parallel to the XY plane";
/// Why an entity without extent is left out.
pub(super) const DEGENERATE: &str = "of no extent";

/// Why an entity does not become a curve.
#[derive(Debug)]
pub(super) enum Refusal {
    /// It is left out and counted, for this reason.
    Skip(&'static str),
    /// It has no extent.
    Degenerate,
    /// The file is wrong at this place.
    Broken(ImportError),
}

impl From<ImportError> for Refusal {
    fn from(error: ImportError) -> Self {
        Self::Broken(error)
    }
}

/// The figure of an entity.
#[derive(Debug)]
pub(super) enum Figure<'a> {
    /// Curves. `parts` names each of several curves: "segment".
    Curves {
        curves: Vec<Curve>,
        level: Level,
        parts: &'static str,
        /// See [`DrawnCurve::last_decimal`](crate::domain::DrawnCurve::last_decimal).
        last_decimal: f64,
    },
    Point {
        at: Point,
        z: f64,
    },
    /// A filled area between closed outlines, by the even-odd rule.
    Fill {
        loops: Vec<Vec<Curve>>,
        last_decimal: f64,
    },
    /// A text, as the file encodes it.
    Text {
        at: Point,
        bytes: Vec<u8>,
    },
    Insert(Insert<'a>),
}

/// The position of an entity relative to the XY plane.
#[derive(Clone, Copy, Debug)]
pub(super) enum Level {
    /// Parallel to it, at this height.
    At(f64),
    /// It leaves the plane. Its curves are its projection.
    Leaves,
}

/// An insertion of a block, once or in rows and columns.
#[derive(Debug)]
pub(super) struct Insert<'a> {
    /// The name of the block, as the file encodes it.
    pub block: &'a [u8],
    /// From the block, its base point at the origin, to its first instance.
    pub map: Affine,
    /// Height of the insertion point.
    pub z: f64,
    /// Factor from a height in the block to one in the drawing.
    pub z_scale: f64,
    /// Number of columns.
    pub columns: i64,
    /// Number of rows.
    pub rows: i64,
    /// The steps from a column to the next, and from a row to the next.
    pub steps: [Vec2; 2],
}

/// A figure of one curve.
pub(super) fn single(curve: Curve, level: Level, last_decimal: f64) -> Figure<'static> {
    Figure::Curves { curves: vec![curve], level, parts: "", last_decimal }
}

/// A curve that its entity defines completely. It is left out where it has no extent. Data that contradict each other
/// are an error.
pub(super) fn built(record: &Record, curve: Result<Curve, CurveError>) -> Result<Curve, Refusal> {
    curve.map_err(|error| match error {
        CurveError::Radius { .. } | CurveError::Sweep { .. } => Refusal::Degenerate,
        other => Refusal::Broken(record.broken(other)),
    })
}

/// Facts about the entities of a drawing, each reported once.
#[derive(Debug, Default)]
pub(super) struct Notices(BTreeSet<&'static str>);

impl Notices {
    /// Adds a fact, as one sentence.
    pub fn add(&mut self, sentence: &'static str) {
        self.0.insert(sentence);
    }

    /// The facts as notes.
    pub fn into_notes(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(str::to_owned)
    }
}
