//! Coordinates of airfoil sections: Selig, Lednicer and MSES/XFOIL files.
//!
//! Such files have been typed by hand for sixty years. The reader accepts: any number of header lines; names that are
//! numbers; the four-number line of MSES and XFOIL; Lednicer's line of two counts, also if it is wrong; numbers in a
//! header that are not a point; `999. 999.` between elements; blank or text lines between surfaces; commas, tabs,
//! decimal commas, typographic minus signs; columns that run together; Fortran exponents; a column that counts the
//! points; tables of one abscissa and two ordinates; further columns; Latin-1; percent of chord; and text after the
//! data. Notes list what was found. A point that is not a number is refused. Coordinates are not changed, except that
//! percent of chord is divided by 100.
//!
//! `rows.rs` classifies lines, `gather.rs` finds the coordinates, `columns.rs` finds their columns, and `table.rs`
//! makes elements of them. The module `section` makes a drawing of the elements.

mod columns;
mod gather;
mod rows;
mod table;

use super::{Certainty, Facts, Found, ImportError, without_bom};
use crate::geometry::Point;

/// Points nearer than this part of the chord are one point: files have five or six decimals, so the difference is
/// rounding.
pub(crate) const SAME: f64 = 1e-6;
/// The help of messages about missing coordinates.
pub(crate) const HELP: &str = "expected lines of two numbers, x and y, around the section (Selig) or one surface after the other (Lednicer), or of \
                               three, x with the ordinates of both surfaces";

/// The facts of airfoil files.
pub(super) const FACTS: Facts = Facts {
    name: "airfoil",
    suffixes: &["dat", "txt"],
    sign: |bytes| gather::has_coordinates(without_bom(bytes)),
    certainty: Certainty::Numbers,
    read: |bytes, stem, _| Ok(Found::Section(read(bytes, stem)?)),
};

/// A coordinate pair with its place in the file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// The point.
    pub(crate) at: Point,
    /// Line in the file, from 1.
    pub(crate) line: usize,
    /// The line of text before it, unless that is a comment.
    pub(crate) text_before: Option<usize>,
    /// Whether a blank or text line stands before it.
    pub(crate) gap_before: bool,
}

/// The elements of a file as points. Each has at least one point.
#[derive(Clone, Debug)]
pub struct Coordinates {
    /// The title.
    pub(crate) title: String,
    /// Lednicer's counts of the two surfaces, where they fit the points.
    pub(crate) counts: Option<[usize; 2]>,
    /// The points of every element, in the order of the file.
    pub(crate) elements: Vec<Vec<Sample>>,
    /// Notes about the file, one sentence each.
    pub(crate) notes: Vec<String>,
}

/// Reads an airfoil file. `stem` is the title where the file gives none.
///
/// # Errors
/// With the line where a number is missing; without one where there are no coordinates.
pub fn read(bytes: &[u8], stem: &str) -> Result<Coordinates, ImportError> {
    let mut notes = Vec::new();
    let (title, counts, elements) = table::scan(bytes, &mut notes)?;
    Ok(Coordinates { title: title.unwrap_or_else(|| stem.to_owned()), counts, elements, notes })
}
