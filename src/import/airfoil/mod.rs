//! Coordinates of airfoil sections: Selig, Lednicer and MSES/XFOIL files.
//!
//! These files were typed by hand for sixty years. Understood are: any number of header lines or none, names that are
//! numbers, the four-number line of MSES and XFOIL, Lednicer's line of two counts (also where it is wrong), numbers of
//! a header that are no point, `999. 999.` between elements, blank or text lines between surfaces, commas, tabs,
//! decimal commas, typographic minus signs, columns that run together, Fortran exponents, a column that counts the
//! points, tables of one abscissa and two ordinates, further columns, Latin-1, percent of chord, and text behind the
//! data. What was met is told in notes. Refused is a point that is no number. Coordinates are kept as they are, percent
//! apart.
//!
//! `rows.rs` tells what a line is, `gather.rs` where the coordinates are, `columns.rs` which columns they are, and
//! `table.rs` makes elements of them. What a section is made of is the part of `section/`.

mod columns;
mod gather;
mod rows;
mod table;

use super::{Certainty, Facts, Found, ImportError, without_bom};
use crate::geometry::Point;

/// Part of the chord below which two points are one: files carry five or six decimals, so nearer is rounding.
pub(crate) const SAME: f64 = 1e-6;
pub(crate) const HELP: &str = "expected lines of two numbers, x and y, around the section (Selig) or one surface after the other (Lednicer), or of \
                               three, x with the ordinates of both surfaces";

pub(super) const FACTS: Facts = Facts {
    name: "airfoil",
    suffixes: &["dat", "txt"],
    sign: |bytes| gather::has_coordinates(without_bom(bytes)),
    certainty: Certainty::Numbers,
    read: |bytes, stem, _| Ok(Found::Section(read(bytes, stem)?)),
};

/// A coordinate pair and where it stood.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) at: Point,
    /// From 1.
    pub(crate) line: usize,
    /// The line of text that stands before it, where that is no comment.
    pub(crate) text_before: Option<usize>,
    /// A blank or text line stands before it.
    pub(crate) gap_before: bool,
}

/// The sections of a file as points: one element or more, none without points.
#[derive(Clone, Debug)]
pub struct Coordinates {
    pub(crate) title: String,
    /// Lednicer's counts of the two surfaces, where they fit the points.
    pub(crate) counts: Option<[usize; 2]>,
    /// The points of every element, in the order of the file.
    pub(crate) elements: Vec<Vec<Sample>>,
    /// What was met, one sentence each.
    pub(crate) notes: Vec<String>,
}

/// Reads an airfoil file; `stem` is its title where it gives none.
///
/// # Errors
/// With the line where a number is missing; without one where there are no coordinates.
pub fn read(bytes: &[u8], stem: &str) -> Result<Coordinates, ImportError> {
    let mut notes = Vec::new();
    let (title, counts, elements) = table::scan(bytes, &mut notes)?;
    Ok(Coordinates { title: title.unwrap_or_else(|| stem.to_owned()), counts, elements, notes })
}
