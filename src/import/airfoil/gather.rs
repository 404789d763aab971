//! Finds the lines of coordinates in a file.
//!
//! ```text
//!    Selig: one run around the section         Lednicer: counts, then one surface after the other
//!
//!    NACA 4412           title                 NACA 4412            title
//!    1.000   0.001       trailing edge          61.   61.           counts of the two surfaces
//!    0.950   0.015       upper surface          0.000  0.000        nose
//!    0.000   0.000       nose                   1.000  0.001        upper surface, to the trailing edge
//!    0.950  -0.002       lower surface                              blank line
//!    1.000  -0.001       trailing edge          0.000  0.000        nose
//!                                               1.000 -0.001        lower surface, to the trailing edge
//!    `999. 999.` separates elements in both.
//! ```

use super::HELP;
use super::rows::{Dress, Numbers, Row, decode, lines};
use crate::geometry::Point;
use crate::import::ImportError;

/// Whether two neighbouring lines hold numbers.
pub fn has_coordinates(bytes: &[u8]) -> bool {
    let text = decode(bytes, &mut Vec::new());
    let rows: Vec<Row> = lines(&text).iter().map(|line| Row::of(line, &mut Dress::default())).collect();
    first_data(&rows).is_some()
}

/// The first of two neighbouring lines of numbers.
pub fn first_data(rows: &[Row]) -> Option<usize> {
    let mut last: Option<usize> = None;
    for (i, row) in rows.iter().enumerate() {
        match row {
            Row::Blank | Row::Dotted => {}
            Row::Point { words: false, .. } => match last {
                Some(first) => return Some(first),
                None => last = Some(i),
            },
            Row::Point { .. } | Row::Half | Row::Lost | Row::Comment | Row::Text => last = None,
        }
    }
    None
}

const LOST: &str = "the line lies amid coordinates, but does not hold two numbers";
const MEND: &str = "correct the line, or remove it";

/// Refuses a file whose first or second point is not a number.
pub fn refuse_lost_start(rows: &[Row], start: usize) -> Result<(), ImportError> {
    match rows[..start].iter().rposition(|row| *row == Row::Lost) {
        Some(lost) => Err(ImportError::at(lost + 1, LOST, MEND)),
        None => Ok(()),
    }
}

/// Skips the four-number line of MSES and XFOIL, counts, and names of two numbers. Returns the new start, and
/// Lednicer's counts.
pub fn skip_special(rows: &[Row], mut start: usize, notes: &mut Vec<String>) -> (usize, Option<[usize; 2]>) {
    let mut counts = None;
    // At most three such lines: a name of numbers, a box and counts.
    for _ in 0..3 {
        let Some(numbers) = rows[start].numbers() else { break };
        let Some(next) = (start + 1..rows.len()).find(|&i| rows[i].numbers().is_some()) else { break };
        let Some(after) = rows[next].numbers() else { break };
        if numbers.count >= 4 && after.count < 4 {
            notes.push("The line of four numbers (MSES, XFOIL) was passed over.".into());
        } else if let Some(found) = as_counts(numbers, &rows[next..]) {
            counts = Some(found);
        } else {
            break;
        }
        start = next;
    }
    (start, counts)
}

/// Two integers that fit the points after them as counts, or that lie far from them.
pub fn as_counts(numbers: Numbers, after: &[Row]) -> Option<[usize; 2]> {
    let count = |v: f64| (v == v.trunc() && (2.0..1e9).contains(&v)).then_some(v as usize);
    let counts = [count(numbers.first[0])?, count(numbers.first[1])?];
    let points = after.iter().filter_map(|row| row.point()).take_while(|p| !is_separator(*p));
    let (n, widest) = points.fold((0, 0.0_f64), |(n, widest), p| (n + 1, widest.max(p.x.abs())));
    (numbers.count == 2 && (counts[0] + counts[1] == n || numbers.first[0] > 2.0 * widest)).then_some(counts)
}

/// Whether a point is `999. 999.`, the separator of elements.
pub fn is_separator(p: Point) -> bool {
    p.x == p.y && (999.0..1000.0).contains(&p.x)
}

/// The numbers of a line of coordinates.
#[derive(Clone, Copy)]
pub struct Gathered {
    /// The numbers of the line.
    pub numbers: Numbers,
    /// The line, from 1.
    pub line: usize,
    /// The line of text before it.
    pub text_before: Option<usize>,
    /// Whether a blank or text line stands before it.
    pub gap_before: bool,
}

/// The lines of coordinates, element by element.
pub fn gather(rows: &[Row], start: usize, notes: &mut Vec<String>) -> Result<Vec<Vec<Gathered>>, ImportError> {
    let mut elements: Vec<Vec<Gathered>> = vec![Vec::new()];
    let (mut gap, mut text) = (false, None);
    // Number of points of the element before the last line of text.
    let mut before_text: Option<usize> = None;
    let (mut words_behind, mut text_lines, mut dotted) = (false, Vec::new(), Vec::new());
    let is_point = |i: usize| rows.get(i).is_some_and(|row| row.numbers().is_some());
    for (i, row) in rows.iter().enumerate().skip(start) {
        let here = elements.len() - 1;
        let beside_point = i > start && is_point(i - 1);
        match *row {
            Row::Blank => gap = true,
            Row::Dotted => dotted.push(i + 1),
            Row::Point { words: false, .. } if row.point().is_some_and(is_separator) => {
                elements.push(Vec::new());
                (gap, text, before_text) = (false, None, None);
            }
            Row::Point { numbers, words } if !words || beside_point => {
                words_behind |= words;
                let is_first = elements[here].is_empty();
                let gap_before = std::mem::take(&mut gap) && !is_first;
                let text_before = text.take().filter(|_| !is_first);
                elements[here].push(Gathered { numbers, line: i + 1, text_before, gap_before });
            }
            Row::Lost => return Err(ImportError::at(i + 1, LOST, MEND)),
            Row::Half if beside_point && is_point(i + 1) => return Err(ImportError::at(i + 1, LOST, MEND)),
            Row::Comment => {
                gap = true;
                text_lines.push(i + 1);
            }
            Row::Point { .. } | Row::Half | Row::Text => {
                drop_numbers_in_text(&mut elements[here], before_text);
                (gap, text, before_text) = (true, Some(i + 1), Some(elements[here].len()));
                text_lines.push(i + 1);
            }
        }
    }
    if let Some(last) = elements.last_mut() {
        drop_numbers_in_text(last, before_text);
    }
    if !text_lines.is_empty() {
        notes.push(format!("Lines of text among or behind the coordinates, passed over: {}.", few(&text_lines)));
    }
    if !dotted.is_empty() {
        notes.push(format!("Lines that leave the ordinate out, passed over: {}.", few(&dotted)));
    }
    if words_behind {
        notes.push("Words behind the numbers of a line were passed over.".into());
    }
    elements.retain(|e| !e.is_empty());
    if elements.is_empty() { Err(ImportError::new("no coordinates were found", HELP)) } else { Ok(elements) }
}

/// The first numbers of a list, and the count of the rest: "12, 40 and 7 more".
pub fn few(lines: &[usize]) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<String> = lines.iter().take(SHOWN).map(usize::to_string).collect();
    let more = lines.len().saturating_sub(SHOWN);
    if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
}

/// Removes numbers within text: fewer than three points after a line of text.
pub fn drop_numbers_in_text(element: &mut Vec<Gathered>, before_text: Option<usize>) {
    if let Some(cut) = before_text.filter(|&cut| cut > 0 && element.len() - cut < 3) {
        element.truncate(cut);
    }
}

/// Notes numbers in the header without coordinates after them.
pub fn tell_numbers_before(header: &[Row], notes: &mut Vec<String>) {
    let alone = |i: &usize| header[*i].numbers().is_some_and(|n| n.count == 2);
    let lines: Vec<usize> = (0..header.len()).filter(alone).map(|i| i + 1).collect();
    // A name may be two numbers.
    if lines.iter().any(|&line| line > 1) {
        notes.push(format!("Numbers before the coordinates, passed over: line {}.", few(&lines)));
    }
}
