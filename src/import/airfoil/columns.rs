//! Which columns of a table are coordinates.

use super::gather::Gathered;
use super::rows::COLUMNS;
use super::{HELP, Sample};
use crate::geometry::Point;
use crate::import::ImportError;

/// Which columns of a table are coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Columns {
    /// Abscissa and ordinate, of a contour or of one surface after the other.
    Pair(usize, usize),
    /// One abscissa with the ordinates of both surfaces.
    Shared { x: usize, upper: usize, lower: usize },
    /// Abscissa and ordinate of each surface, side by side.
    Beside { upper: [usize; 2], lower: [usize; 2] },
}

impl Columns {
    /// The columns of a table, from its numbers.
    pub fn of(elements: &[Vec<Gathered>], notes: &mut Vec<String>) -> Result<Self, ImportError> {
        let rows: Vec<&Gathered> = elements.iter().flatten().collect();
        let count = rows.iter().map(|row| row.numbers.count).min().unwrap_or(0);
        let widest = rows.iter().map(|row| row.numbers.count).max().unwrap_or(0);
        let skipped = usize::from(count > 2 && is_index(&rows));
        if skipped > 0 {
            notes.push("The first column counts the points and was passed over.".into());
        }
        let columns = (count - skipped).min(COLUMNS - skipped);
        let (x, y) = (skipped, skipped + 1);
        let column = |k: usize| rows.iter().map(move |row| row.numbers.first[k]);
        let runs = |k: usize| elements.len() == 1 && rows.len() >= 4 && is_monotone(column(k));
        let found = if columns >= 4 && runs(x) && runs(x + 2) && spans_alike(column(x), column(x + 2)) {
            Self::Beside { upper: [x, y], lower: [x + 2, y + 2] }
        } else if columns >= 3 && runs(x) && !is_constant(column(y)) && !is_constant(column(y + 1)) {
            refuse_not_around(&rows, x)?;
            Self::Shared { x, upper: y, lower: y + 1 }
        } else if columns >= 3 && is_constant(column(y)) && !is_constant(column(y + 1)) {
            Self::Pair(x, y + 1)
        } else {
            Self::Pair(x, y)
        };
        notes.extend(found.note(skipped, widest));
        Ok(found)
    }

    fn note(self, skipped: usize, count: usize) -> Option<String> {
        match self {
            Self::Beside { .. } => {
                Some("The surfaces stand side by side: x and y of the one, x and y of the other.".into())
            }
            Self::Shared { .. } => Some("The lines hold an abscissa and the ordinates of both surfaces.".into()),
            Self::Pair(x, y) if y > x + 1 => Some(format!(
                "The section lies in the plane of columns {} and {}; column {y} is constant.",
                x + 1,
                y + 1
            )),
            Self::Pair(..) if count > skipped + 2 => {
                Some("What follows the first two numbers of a line was passed over.".into())
            }
            Self::Pair(..) => None,
        }
    }

    /// The points of each element.
    pub fn elements(self, gathered: &[Vec<Gathered>]) -> Result<Vec<Vec<Sample>>, ImportError> {
        Ok(match self {
            Self::Pair(x, y) => {
                gathered.iter().map(|rows| rows.iter().map(|row| row.sample([x, y])).collect()).collect()
            }
            Self::Shared { x, upper, lower } => vec![around(&gathered[0], [x, upper], [x, lower])],
            Self::Beside { upper, lower } => vec![around(&gathered[0], upper, lower)],
        })
    }
}

impl Gathered {
    fn sample(&self, [x, y]: [usize; 2]) -> Sample {
        let at = Point::new(self.numbers.first[x], self.numbers.first[y]);
        Sample { at, line: self.line, text_before: self.text_before, gap_before: self.gap_before }
    }
}

/// Two surfaces that stand side by side, as one after the other.
fn around(rows: &[Gathered], upper: [usize; 2], lower: [usize; 2]) -> Vec<Sample> {
    let plain = |columns: [usize; 2]| {
        rows.iter().map(move |row| Sample { text_before: None, gap_before: false, ..row.sample(columns) })
    };
    let second = plain(lower).enumerate().map(|(i, sample)| Sample { gap_before: i == 0, ..sample });
    plain(upper).chain(second).collect()
}

/// Whether the first column counts the points, from 0 or 1 in each surface or element, and the second is an abscissa.
/// In a table with the ordinates of both surfaces, the second and third column are equal at its ends.
fn is_index(rows: &[&Gathered]) -> bool {
    let first = |i: usize| rows[i].numbers.first;
    let starts = |v: f64| v == 0.0 || v == 1.0;
    let counts = (1..rows.len()).all(|i| first(i)[0] == first(i - 1)[0] + 1.0 || starts(first(i)[0]));
    let apart = |i: usize| (first(i)[1] - first(i)[2]).abs();
    let widest = (0..rows.len()).map(apart).fold(0.0, f64::max);
    let meets_at_ends = apart(0).max(apart(rows.len() - 1)) < 0.25 * widest;
    let is_table = meets_at_ends && !is_monotone((0..rows.len()).map(|i| first(i)[1]));
    starts(first(0)[0])
        && counts
        && !(is_table && is_monotone((0..rows.len()).map(|i| first(i)[0])) && crosses_once(rows))
}

/// Whether the numbers after the first keep their order. The ordinates of an upper and a lower surface do.
fn crosses_once(rows: &[&Gathered]) -> bool {
    let above = |row: &&&Gathered| row.numbers.first[1] > row.numbers.first[2];
    let below = |row: &&&Gathered| row.numbers.first[1] < row.numbers.first[2];
    !(rows.iter().any(|row| above(&row)) && rows.iter().any(|row| below(&row)))
}

fn is_monotone(values: impl Iterator<Item = f64> + Clone) -> bool {
    let steps = || values.clone().zip(values.clone().skip(1));
    steps().all(|(a, b)| b > a) || steps().all(|(a, b)| b < a)
}

fn is_constant(mut values: impl Iterator<Item = f64>) -> bool {
    let first = values.next();
    values.all(|v| Some(v) == first)
}

/// Whether two columns cover the same range, to a twentieth.
fn spans_alike(a: impl Iterator<Item = f64>, b: impl Iterator<Item = f64>) -> bool {
    let span = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (a, b) = (span(&mut { a }), span(&mut { b }));
    let slack = 0.05 * (a.1 - a.0).max(b.1 - b.0);
    slack > 0.0 && (a.0 - b.0).abs() <= slack && (a.1 - b.1).abs() <= slack
}

/// Refuses columns that are not ordinates of two surfaces: those lie on both sides of the nose near it. Camber and
/// thickness, or other tables, do not.
fn refuse_not_around(rows: &[&Gathered], x: usize) -> Result<(), ImportError> {
    let ordinates = |i: usize| (rows[i].numbers.first[x + 1], rows[i].numbers.first[x + 2]);
    let around = |end: usize, beside: usize| {
        let middle = 0.5 * (ordinates(end).0 + ordinates(end).1);
        let (a, b) = ordinates(beside);
        (a - middle) * (b - middle) < 0.0
    };
    let n = rows.len();
    if around(0, 1) || around(n - 1, n - 2) {
        return Ok(());
    }
    let what = "the columns are not ordinates of an upper and a lower surface: both run to the same side of the nose";
    Err(ImportError::at(rows[1].line, what, HELP))
}
