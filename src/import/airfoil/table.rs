//! The file as a title and elements of points: headers, units and gaps.

use super::columns::Columns;
use super::gather::{first_data, gather, refuse_lost_start, skip_special, tell_numbers_before};
use super::rows::{Dress, Row, decode, lines, one_line};
use super::{HELP, SAME, Sample};
use crate::geometry::{Point, Vec2, bounds_of};
use crate::import::ImportError;

/// The title, Lednicer's counts where they fit the points, and the points of each element.
type Scanned = (Option<String>, Option<[usize; 2]>, Vec<Vec<Sample>>);

/// Reads the parts of a file, and notes what it met.
pub fn scan(bytes: &[u8], notes: &mut Vec<String>) -> Result<Scanned, ImportError> {
    let text = decode(bytes, notes);
    let lines: Vec<&str> = lines(&text);
    let mut dress = Dress::default();
    let rows: Vec<Row> = lines.iter().map(|line| Row::of(line, &mut dress)).collect();
    dress.tell(notes);
    let first = first_data(&rows).ok_or_else(|| ImportError::new("no coordinates were found", HELP))?;
    refuse_lost_start(&rows, first)?;
    tell_numbers_before(&rows[..first], notes);
    let (start, announced) = skip_special(&rows, first, notes);
    let gathered = gather(&rows, start, notes)?;
    let columns = Columns::of(&gathered, notes)?;
    let mut elements = columns.elements(&gathered)?;
    skip_numbers_of_header(&mut elements[0], notes);
    let counts = announced.and_then(|counts| fitting(counts, &elements, notes));
    if counts.is_none() && elements.len() == 1 {
        elements = split_loops(elements.swap_remove(0), notes);
    }
    let header = &lines[..start];
    unscale_percent(&mut elements, header, notes);
    let title = header.iter().map(|l| l.trim_matches(|c: char| c.is_whitespace() || c == '#'));
    let title = title.zip(&rows).find(|(l, row)| !l.is_empty() && row.numbers().is_none()).map(|(l, _)| one_line(l));
    if start == 0 {
        notes.push("There is no name line.".into());
    }
    Ok((title, counts, elements))
}

fn fitting(counts: [usize; 2], elements: &[Vec<Sample>], notes: &mut Vec<String>) -> Option<[usize; 2]> {
    let fits = elements.len() == 1 && counts[0].checked_add(counts[1]) == Some(elements[0].len());
    if !fits {
        notes.push(format!("The counts {} and {} do not fit the points and were passed over.", counts[0], counts[1]));
    }
    fits.then_some(counts)
}

// ---- numbers that are not a point ----

/// Removes numbers of a header (chord and thickness, a reference point) from the beginning of the points.
fn skip_numbers_of_header(samples: &mut Vec<Sample>, notes: &mut Vec<String>) {
    // A header with more than two such lines contains a word.
    for _ in 0..2 {
        if !starts_beside(samples) {
            return;
        }
        let Sample { at, line, .. } = samples.remove(0);
        let place = format!("{} and {} on line {line}", at.x, at.y);
        notes.push(format!("The numbers {place} are not a point of the section and were passed over."));
        if let Some(first) = samples.first_mut() {
            (first.gap_before, first.text_before) = (false, None);
        }
    }
}

/// Whether the first point is not of the section: the section is complete without it, and worse with it.
///
/// ```text
///      header ·            p₁ … pₙ close without p₀, or nearly, and p₀ lies inside, or upright beside p₁;
///         \                or p₀ lies far off; or p₀ → p₁ runs against p₁ → p₂ for a twentieth of the width
///   ───────p₁
///   ───────pₙ
/// ```
fn starts_beside(samples: &[Sample]) -> bool {
    // Least number of points by which a section is recognised.
    const FEWEST: usize = 8;
    let [p0, p1, p2, .., last] = samples else { return false };
    let (p0, p1, p2, last) = (p0.at, p1.at, p2.at, last.at);
    let Some(rest) = bounds_of(samples[1..].iter().map(|s| s.at)).filter(|_| samples.len() >= FEWEST) else {
        return false;
    };
    let wide = rest.width();
    let step = p1 - p0;
    if step.hypot() <= SAME * wide {
        return false;
    }
    let (with, without) = ((p0 - last).hypot(), (p1 - last).hypot());
    let is_inside = (rest.x0..=rest.x1).contains(&p0.x);
    let is_upright = step.y.abs() > step.x.abs();
    let closes = without <= SAME * wide && with > SAME * wide && (step.hypot() > 2.0 * (p2 - p1).hypot() || is_inside);
    let closes_better = without < 0.4 * with && with > 0.02 * wide && (is_inside || is_upright);
    let is_far = p0.x < rest.x0 - 0.3 * wide
        || p0.x > rest.x1 + 0.3 * wide
        || p0.y < rest.y0 - 0.5 * wide
        || p0.y > rest.y1 + 0.5 * wide;
    let turns_back = step.x * (p2.x - p1.x) < 0.0 && step.x.abs() > 0.05 * wide;
    // A base runs from the last point to the first, and does not run back past either.
    let opposite = |a: Vec2, b: Vec2| a.dot(b) < -0.9 * a.hypot() * b.hypot();
    let folds = step.x.abs() <= 1e-3 * step.y.abs()
        && with > 0.02 * wide
        && (opposite(p0 - p1, last - p1) || opposite(p0 - last, p1 - last));
    closes || closes_better || is_far || turns_back || folds
}

// ---- units, elements ----

/// Divides by 100 if a section is about 100 wide, unless the header names a unit of length.
fn unscale_percent(elements: &mut [Vec<Sample>], header: &[&str], notes: &mut Vec<String>) {
    // The nose of a cambered section, the tab of a rotor blade and a cut end lie up to this far from the ends of the
    // chord.
    const PERCENT: std::ops::RangeInclusive<f64> = 98.5..=101.5;
    const UNITS: [&str; 8] = ["mm", "cm", "millimetre", "millimetres", "millimeter", "millimeters", "inch", "inches"];
    let Some(bounds) = bounds_of(elements.iter().flatten().map(|s| s.at)) else { return };
    let mut words = header.iter().flat_map(|line| line.split(|c: char| !c.is_alphabetic()));
    if !PERCENT.contains(&bounds.width()) || words.any(|word| UNITS.contains(&word.to_lowercase().as_str())) {
        return;
    }
    notes.push("Coordinates are in percent of chord and were divided by 100.".into());
    for sample in elements.iter_mut().flatten() {
        sample.at = Point::new(sample.at.x / 100.0, sample.at.y / 100.0);
    }
}

/// Splits contours at blank or text lines into elements, where there are no `999.` lines.
fn split_loops(samples: Vec<Sample>, notes: &mut Vec<String>) -> Vec<Vec<Sample>> {
    let parts: Vec<&[Sample]> = samples.chunk_by(|_, b| !b.gap_before).collect();
    if parts.len() < 2 || !parts.iter().all(|part| part.len() >= 5 && is_loop(part)) {
        return vec![samples];
    }
    notes.push(format!("{} contours with blank lines between are as many elements.", parts.len()));
    let first_of = |part: &[Sample]| Sample { text_before: None, gap_before: false, ..part[0] };
    parts.into_iter().map(|part| [&[first_of(part)], &part[1..]].concat()).collect()
}

/// Whether a run of points returns to its beginning, to a quarter of its width. A single surface does not.
fn is_loop(samples: &[Sample]) -> bool {
    let [first, .., last] = samples else { return false };
    let wide = bounds_of(samples.iter().map(|s| s.at)).map_or(0.0, |b| b.width());
    (first.at.x - last.at.x).abs() < 0.25 * wide
}
