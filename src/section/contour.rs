//! From the points of an element to its contour: in order from the trailing edge over the upper surface to the nose and
//! back below.

use super::crossing::first_crossing;
use super::ends::{base_of, is_edged};
use super::near::{merge_repeated, thin};
use super::order::{cut_surfaces, from_trailing_edge, join, refuse_open, refuse_text};
use crate::geometry::{Point, bounds_of, finest_decimal};
use crate::import::ImportError;
use crate::import::airfoil::{HELP, SAME, Sample};

/// The contour of one element, counter-clockwise from the trailing edge over the upper surface to the nose and back
/// below.
///
/// ```text
///            ╭──────────────────────── first
///     nose ●─┤                         │ base
///            ╰──────────────────────── last
/// ```
#[derive(Clone, Debug)]
pub struct Contour {
    /// The points, from the upper end of the trailing edge to the lower one; equal ends where the trailing edge is
    /// sharp.
    pub points: Vec<Point>,
    /// The points of a blunt trailing edge between the last point and the first, if the file has some.
    pub base: Vec<Point>,
    /// Index of the nose, the point farthest from the trailing edge; never the first or the last.
    pub nose: usize,
    /// First and last line in the file.
    pub lines: [usize; 2],
    /// Whether the file gives the surfaces one after the other (Lednicer), not the contour in one go (Selig).
    pub by_surface: bool,
}

impl Contour {
    /// Puts the points of an element in order and cleans them; every change is added to `notes`. `counts` are the
    /// numbers of points of the surfaces that the file states.
    ///
    /// # Errors
    ///
    /// With a line, where the points are no section: too few, text between them, a part missing, crossing or running
    /// back and forth.
    pub fn trace(samples: &[Sample], counts: Option<[usize; 2]>, notes: &mut Vec<String>) -> Result<Self, ImportError> {
        let lines = [samples[0].line, samples[samples.len() - 1].line];
        let bounds = bounds_of(samples.iter().map(|s| s.at)).unwrap_or_default();
        let wide = bounds.width();
        // Squares and cubes of coordinates and widths must not overflow or underflow.
        let in_range = samples.iter().all(|s| s.at.x.abs().max(s.at.y.abs()) < 1e100) && wide > 1e-100;
        if samples.len() < 4 || !in_range || bounds.height() == 0.0 {
            let what = format!("{} points from line {} on make no section", samples.len(), lines[0]);
            return Err(ImportError::at(lines[0], what, HELP));
        }
        let cut = cut_surfaces(samples, counts, wide);
        refuse_text(samples, cut, wide)?;
        let by_surface = cut.is_some();
        let plain: Vec<Point> = samples.iter().map(|s| s.at).collect();
        let mut points = match cut {
            Some(at) => {
                notes.push("The surfaces are given one after the other and were joined at the nose.".into());
                join(plain[..at].to_vec(), plain[at..].to_vec())
            }
            None => plain,
        };
        refuse_open(&points, wide, lines)?;
        if !by_surface {
            points = from_trailing_edge(points, wide, notes);
        }
        let decimal = finest_decimal(samples.iter().flat_map(|s| [s.at.x, s.at.y]));
        merge_repeated(&mut points, SAME * wide, notes);
        thin(&mut points, decimal, wide, notes);
        if doubled_area(&points) < 0.0 {
            points.reverse();
            notes.push("The points ran clockwise and were turned around.".into());
        }
        let mut contour = Self { points, base: Vec::new(), nose: 0, lines, by_surface };
        contour.untie_tail(decimal, wide, notes);
        contour.take_base(wide);
        contour.close(wide, notes);
        contour.find_nose()?;
        contour.refuse_crossed(samples)?;
        contour.refuse_winding(wide)?;
        Ok(contour)
    }

    /// The upper end of the trailing edge.
    pub fn first(&self) -> Point {
        self.points[0]
    }

    /// The lower end of the trailing edge.
    pub fn last(&self) -> Point {
        self.points[self.points.len() - 1]
    }

    /// The middle of the trailing edge.
    pub fn tail(&self) -> Point {
        self.first().midpoint(self.last())
    }

    /// The nose: the point farthest from the trailing edge.
    pub fn nose_point(&self) -> Point {
        self.points[self.nose]
    }

    /// The chord: the distance from the nose to the middle of the trailing edge.
    pub fn chord(&self) -> f64 {
        (self.tail() - self.nose_point()).hypot()
    }

    /// Applies `f` to all points.
    pub fn map(&mut self, f: impl Fn(Point) -> Point) {
        self.points.iter_mut().chain(&mut self.base).for_each(|p| *p = f(*p));
    }

    /// Whether the trailing edge is one point.
    pub fn is_sharp(&self) -> bool {
        self.base.is_empty() && self.first() == self.last()
    }

    /// Whether the left end has a corner or a base and the right end has neither: then the nose is on the right.
    pub fn has_nose_on_the_right(&self) -> bool {
        let ring: Vec<Point> = self.points.iter().chain(&self.base).copied().collect();
        let mirrored: Vec<Point> = ring.iter().rev().map(|p| Point::new(-p.x, p.y)).collect();
        is_edged(&mirrored) && !is_edged(&ring)
    }

    /// Separates the points of a blunt trailing edge from the surfaces, and lets the contour start at its upper end.
    fn take_base(&mut self, wide: f64) {
        let mut ring = self.points.clone();
        if ring.first() == ring.last() {
            ring.pop();
        }
        let Some([lower, upper]) = base_of(&ring, wide) else { return };
        let n = ring.len();
        ring.rotate_left(upper);
        let surfaces = (lower + n - upper) % n + 1;
        self.base = ring.split_off(surfaces);
        self.points = ring;
    }

    fn find_nose(&mut self) -> Result<(), ImportError> {
        let tail = self.tail();
        let far = |i: usize| (self.points[i] - tail).hypot2();
        let inner = 1..self.points.len().saturating_sub(1);
        self.nose = inner.reduce(|a, b| if far(b) > far(a) { b } else { a }).unwrap_or(0);
        if self.points.len() < 4 || self.nose < 1 || self.chord() == 0.0 || doubled_area(&self.points) == 0.0 {
            return Err(ImportError::at(self.lines[0], "the points enclose no section", HELP));
        }
        Ok(())
    }

    /// Refuses a contour that runs back and forth. The two surfaces of a section cover its width twice, those of a slat
    /// or with a cove a little more.
    fn refuse_winding(&self, wide: f64) -> Result<(), ImportError> {
        const WIDTHS: f64 = 4.0;
        let travel: f64 = self.points.windows(2).map(|w| (w[1].x - w[0].x).abs()).sum();
        if travel <= WIDTHS * wide {
            return Ok(());
        }
        let what = format!(
            "the contour runs back and forth, {:.1} times its width in all, where the surfaces of a section take 2",
            travel / wide
        );
        Err(ImportError::at(self.lines[0], what, "give an outline that is no airfoil as SVG, DXF or JSON"))
    }

    /// Refuses a contour that crosses itself, with the lines.
    fn refuse_crossed(&self, samples: &[Sample]) -> Result<(), ImportError> {
        let ring: Vec<Point> = self.points.iter().chain(&self.base).copied().collect();
        let Some((at, edges)) = first_crossing(&ring) else { return Ok(()) };
        // The ends of an edge that was joined or cut may have no line; then the other edge is named.
        let line_of = |p: Point| samples.iter().find(|s| s.at == p).map(|s| s.line);
        let [a, b] = edges.map(|i| [i, (i + 1) % ring.len()].into_iter().find_map(|k| line_of(ring[k])));
        let line = a.or(b).unwrap_or(self.lines[0]);
        let other = b.unwrap_or(line);
        let what =
            format!("the contour crosses itself at ({}, {}), where line {other} leads: that is no section", at.x, at.y);
        let help = "put the points in order around the section, or one surface after the other, each from the nose";
        Err(ImportError::at(line, what, help))
    }
}

/// Twice the signed area of an open or closed polygon, positive where it is counter-clockwise.
pub fn doubled_area(points: &[Point]) -> f64 {
    let Some(&origin) = points.first() else { return 0.0 };
    points.windows(2).map(|w| (w[0] - origin).cross(w[1] - origin)).sum()
}
