//! What an entity draws, or why it draws nothing.

use super::sections::Record;
use crate::curve::{Curve, CurveError};
use crate::geometry::{Point, Vec2};
use crate::import::ImportError;
use kurbo::Affine;
use std::collections::BTreeSet;

/// Why a text draws nothing.
pub(super) const NO_OUTLINE: &str = "glyphs of a font, no outline";
pub(super) const TILTED: &str = "not parallel to the XY plane";
pub(super) const DEGENERATE: &str = "of no extent";

/// Why an entity becomes no curve.
#[derive(Debug)]
pub(super) enum Refusal {
    /// It is left out and counted, for this reason.
    Skip(&'static str),
    /// Nothing is left of it.
    Degenerate,
    /// The file is wrong here.
    Broken(ImportError),
}

impl From<ImportError> for Refusal {
    fn from(error: ImportError) -> Self {
        Self::Broken(error)
    }
}

/// What an entity draws.
#[derive(Debug)]
pub(super) enum Figure<'a> {
    /// `parts` names what each curve is where there are several: "segment".
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
    /// A filled area within closed outlines, by the odd-even rule.
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

/// How an entity lies to the XY plane.
#[derive(Clone, Copy, Debug)]
pub(super) enum Level {
    /// Parallel to it, at this height.
    At(f64),
    /// It leaves the plane; what it draws is its image on it.
    Leaves,
}

/// A block to be drawn, once or in rows and columns.
#[derive(Debug)]
pub(super) struct Insert<'a> {
    pub block: &'a [u8],
    /// Of the block, its base point at the origin, to where its first instance is drawn.
    pub map: Affine,
    /// Height of the insertion point, and what a height in the block counts.
    pub z: f64,
    pub z_scale: f64,
    pub columns: i64,
    pub rows: i64,
    /// From a column to the next, and from a row to the next.
    pub steps: [Vec2; 2],
}

pub(super) fn single(curve: Curve, level: Level, last_decimal: f64) -> Figure<'static> {
    Figure::Curves { curves: vec![curve], level, parts: "", last_decimal }
}

/// A curve that its entity describes in full: nothing to draw where it has no extent, an error where its data
/// contradict each other.
pub(super) fn built(record: &Record, curve: Result<Curve, CurveError>) -> Result<Curve, Refusal> {
    curve.map_err(|error| match error {
        CurveError::Radius { .. } | CurveError::Sweep { .. } => Refusal::Degenerate,
        other => Refusal::Broken(record.broken(other)),
    })
}

/// What is noticed about entities of a drawing, each told once.
#[derive(Debug, Default)]
pub(super) struct Notices(BTreeSet<&'static str>);

impl Notices {
    pub fn add(&mut self, sentence: &'static str) {
        self.0.insert(sentence);
    }

    pub fn into_notes(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(str::to_owned)
    }
}
