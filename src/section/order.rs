//! The order of points around the section: from the trailing edge over the upper surface to the nose and back below.

use super::SHARP;
use super::ends::aftmost;
use crate::geometry::{Point, bounds_of};
use crate::import::ImportError;
use crate::import::airfoil::{SAME, Sample};

/// The index at which the second surface starts in a file that gives one after the other: by the counts in the file, by
/// a blank line between, or by the jump from one to the next. `None` for a contour in one go.
pub fn cut_surfaces(samples: &[Sample], counts: Option<[usize; 2]>, wide: f64) -> Option<usize> {
    let spans = |part: &[Sample]| match part {
        [first, .., last] => (first.at.x - last.at.x).abs() > 0.5 * wide,
        _ => false,
    };
    let both = |at: &usize| samples.split_at_checked(*at).is_some_and(|(a, b)| spans(a) && spans(b));
    let by_count = counts.map(|[upper, _]| upper).filter(both);
    let mut gaps = (1..samples.len()).filter(|&i| samples[i].gap_before);
    let by_gap = || gaps.next().filter(|_| gaps.next().is_none()).filter(both);
    let mut jumps = (1..samples.len()).filter(|&i| (samples[i].at.x - samples[i - 1].at.x).abs() > 0.5 * wide);
    let by_jump = || jumps.next().filter(|_| jumps.next().is_none()).filter(both);
    let found = by_count.or_else(by_gap).or_else(by_jump)?;
    // A contour in one go with a gap at the nose runs forth and back. Two surfaces run in the same direction.
    let (a, b) = samples.split_at(found);
    let downstream = |part: &[Sample]| part[part.len() - 1].at.x > part[0].at.x;
    (downstream(a) == downstream(b)).then_some(found)
}

/// Refuses a line of text within a surface: it stands in the place of a point. Between two surfaces it is a heading.
pub fn refuse_text(samples: &[Sample], cut: Option<usize>, wide: f64) -> Result<(), ImportError> {
    let is_heading = |i: usize| {
        let turns = |k: usize| {
            let (before, after) = (samples[k].at.x - samples[k - 1].at.x, samples[k + 1].at.x - samples[k].at.x);
            before * after <= 0.0
        };
        // At the nose x changes its direction, at a point beside the heading.
        let at_nose = (i.max(3) - 2..(i + 2).min(samples.len() - 1)).any(turns);
        cut == Some(i) || at_nose || (samples[i].at.x - samples[i - 1].at.x).abs() > 0.5 * wide
    };
    for (i, sample) in samples.iter().enumerate().skip(1) {
        if let Some(line) = sample.text_before.filter(|_| !is_heading(i)) {
            let what = "the line lies amid coordinates of a surface, but does not hold two numbers";
            return Err(ImportError::at(line, what, "mend the line, or remove it; a # before it makes it a comment"));
        }
    }
    Ok(())
}

/// Joins two surfaces that run in the same direction to one contour from the trailing edge to the nose and back.
///
/// ```text
///   nose ●── a ──▶          ╭── a ◀──      The contour runs against a to the nose, and then along b. If both surfaces
///        ●── b ──▶    ▶     ●              have the nose, it is kept once.
///                           ╰── b ──▶
/// ```
pub fn join(mut a: Vec<Point>, mut b: Vec<Point>) -> Vec<Point> {
    if a[a.len() - 1].x > a[0].x {
        a.reverse();
    } else {
        b.reverse();
    }
    // Both surfaces may contain the nose.
    if a.last() == b.first() {
        a.pop();
    }
    a.extend(b);
    a
}

/// The longest edge along the chord, in chords, that closes a contour silently.
const CLOSING: f64 = 0.05;

/// Refuses a contour with a missing part, as in a truncated file. The edge from its last point to its first then lies
/// along the chord (an upright edge is a blunt trailing edge, however thick). It is longer than a twentieth of the
/// chord and than twice either neighbouring edge.
pub fn refuse_open(points: &[Point], wide: f64, lines: [usize; 2]) -> Result<(), ImportError> {
    let [first, second, .., before, last] = points else { return Ok(()) };
    let gap = *first - *last;
    let beside = (*second - *first).hypot().max((*last - *before).hypot());
    if gap.x.abs() <= gap.y.abs() || gap.hypot() <= (CLOSING * wide).max(2.0 * beside) {
        return Ok(());
    }
    let what = format!(
        "the contour stops at ({}, {}), {:.0} % of its width from where it starts on line {}: a part of the section is missing",
        last.x,
        last.y,
        100.0 * gap.hypot() / wide,
        lines[0]
    );
    let help = "complete the file; if the section ends in a straight line there, repeat its first point at the end";
    Err(ImportError::at(lines[1], what, help))
}

/// Rotates a contour in one go so that it starts at the trailing edge.
pub fn from_trailing_edge(mut points: Vec<Point>, wide: f64, notes: &mut Vec<String>) -> Vec<Point> {
    let Some(bounds) = bounds_of(points.iter().copied()) else { return points };
    let aft = bounds.x1 - 0.25 * wide;
    let (first, last) = (points[0], points[points.len() - 1]);
    if first.x > aft && last.x > aft {
        return points;
    }
    notes.push("The contour does not start at the trailing edge and was turned to do so.".into());
    if (first - last).hypot() < SAME * wide {
        points.pop();
    }
    let n = points.len();
    let tail = aftmost(&points);
    // A blunt end is an upright edge at the aftmost point. Its ends become the ends of the contour.
    let upright = |i: usize, j: usize| {
        let edge = points[j % n] - points[i % n];
        edge.y.abs() > 2.0 * edge.x.abs() && (SHARP * wide..0.2 * wide).contains(&edge.hypot())
    };
    if upright(tail, tail + 1) {
        points.rotate_left((tail + 1) % n);
    } else if upright(tail + n - 1, tail) {
        points.rotate_left(tail);
    } else {
        points.rotate_left(tail);
        points.push(points[0]);
    }
    points
}
