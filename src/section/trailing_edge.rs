//! The trailing edge: sharpened as points, cut off or closed as curves.
//!
//! ```text
//!    keep               sharp              blunt              round
//!   ────── first       ──────╲            ──────┐            ──────╮
//!         │ te                ● tail            │ te               │ te
//!   ────── last        ──────╱            ──────┘            ──────╯
//! ```

use super::TrailingEdge;
use super::contour::Contour;
use super::crossing::{Meeting, meeting_at_tail};
use crate::curve::{Curve, CurveError};
use crate::geometry::{Point, Vec2};
use crate::import::ImportError;

/// The place where a sharp trailing edge is cut off for `blunt` and `round`, in chords from the nose.
const TRUNCATION: f64 = 0.99;

impl Contour {
    /// Closes a blunt end by shearing both surfaces to its middle, in proportion to the distance from the nose along
    /// the chord.
    ///
    /// Where the surfaces are nearer to each other than the end is high, they would cross. The points behind that place
    /// are left out.
    pub fn sharpen(&mut self, notes: &mut Vec<String>) {
        let (tail, nose, n) = (self.tail(), self.nose_point(), self.points.len());
        let chord = tail - nose;
        let (from_first, from_last) = (tail - self.first(), tail - self.last());
        for (i, p) in self.points.iter_mut().enumerate() {
            let part = ((*p - nose).dot(chord) / chord.hypot2()).clamp(0.0, 1.0);
            *p += part * if i <= self.nose { from_first } else { from_last };
        }
        (self.points[0], self.points[n - 1]) = (tail, tail);
        self.base.clear();
        notes.push("The blunt trailing edge was sheared to a point.".into());
        if let Some(Meeting { upper, lower, .. }) = meeting_at_tail(&self.points, true, chord.hypot())
            && (upper + 1..=lower).contains(&self.nose)
        {
            let out = self.leave_out_behind(upper, lower);
            notes.push(format!("Points near the trailing edge where the surfaces would cross, left out: {out}."));
        }
    }
}

/// The curves that close the contour from its last point to its first; none where they are equal.
pub fn trailing_edge(
    first: Point,
    last: Point,
    contour: &Contour,
    edge: TrailingEdge,
) -> Result<Vec<Curve>, CurveError> {
    if first == last {
        return Ok(Vec::new());
    }
    if edge == TrailingEdge::Round {
        // The bulge of a half circle is tan(π/4) = 1.
        return Ok(vec![Curve::bulge(last, first, 1.0)?]);
    }
    let corners: Vec<Point> = [last].into_iter().chain(contour.base.iter().copied()).chain([first]).collect();
    corners.windows(2).map(|w| Curve::line(w[0], w[1])).collect()
}

/// The parameters at which the upper and the lower surface pass 99 % chord.
///
/// # Errors
///
/// Where a surface does not pass it.
pub fn truncation(contour: &Contour, whole: &Curve, at_nose: f64) -> Result<(f64, f64), ImportError> {
    let chord = contour.tail() - contour.nose_point();
    let at = contour.nose_point() + TRUNCATION * chord;
    let across = Vec2::new(-chord.y, chord.x);
    let upper = whole.line_crossings(at, across, 0.0, at_nose).first().copied();
    let lower = whole.line_crossings(at, across, at_nose, 1.0).last().copied();
    match (upper, lower) {
        (Some(upper), Some(lower)) if upper > 0.0 && upper < at_nose && lower > at_nose && lower < 1.0 => {
            Ok((upper, lower))
        }
        _ => {
            let what = "the surfaces do not both pass 99 % chord, so the trailing edge cannot be cut off there";
            Err(ImportError::at(contour.lines[0], what, "keep the trailing edge as it is"))
        }
    }
}
