//! Points of an element → its contour in order: from the trailing edge over the upper surface to the nose and back below.

use super::super::ImportError;
use super::crossing::{Meeting, first_crossing, meeting_at_tail};
use super::rows::Sample;
use super::{HELP, SAME, SHARP};
use crate::geometry::{Point, Vec2, bounds_of, finest_decimal};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The contour of one element, counter-clockwise from the trailing edge over the upper surface to the nose and back below.
#[derive(Clone, Debug)]
pub(super) struct Contour {
    pub points: Vec<Point>,
    /// Points of the trailing edge between the last point and the first, where the file has some.
    pub base: Vec<Point>,
    /// Index of the nose, the point farthest from the trailing edge; never the first or the last.
    pub nose: usize,
    /// First and last line in the file.
    pub lines: [usize; 2],
    pub by_surface: bool,
}

impl Contour {
    pub fn trace(samples: &[Sample], counts: Option<[usize; 2]>, notes: &mut Vec<String>) -> Result<Self, ImportError> {
        let lines = [samples[0].line, samples[samples.len() - 1].line];
        let bounds = bounds_of(samples.iter().map(|s| s.at)).unwrap_or_default();
        let wide = bounds.width();
        // Squares and cubes of coordinates and widths must stay within the range of numbers.
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

    pub fn first(&self) -> Point {
        self.points[0]
    }

    pub fn last(&self) -> Point {
        self.points[self.points.len() - 1]
    }

    /// Middle of the trailing edge.
    pub fn tail(&self) -> Point {
        self.first().midpoint(self.last())
    }

    pub fn nose_point(&self) -> Point {
        self.points[self.nose]
    }

    pub fn chord(&self) -> f64 {
        (self.tail() - self.nose_point()).hypot()
    }

    pub fn map(&mut self, f: impl Fn(Point) -> Point) {
        self.points.iter_mut().chain(&mut self.base).for_each(|p| *p = f(*p));
    }

    pub fn is_sharp(&self) -> bool {
        self.base.is_empty() && self.first() == self.last()
    }

    /// Whether the left end has a corner or a base and the right one has neither: the nose is the one without.
    pub fn has_nose_on_the_right(&self) -> bool {
        let ring: Vec<Point> = self.points.iter().chain(&self.base).copied().collect();
        let mirrored: Vec<Point> = ring.iter().rev().map(|p| Point::new(-p.x, p.y)).collect();
        is_edged(&mirrored) && !is_edged(&ring)
    }

    /// Closes a blunt end by shearing either surface to its middle, in proportion to the way from the nose.
    ///
    /// Where the surfaces run nearer to each other than the end is high, they would cross: the points from there on are left out.
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

    /// Leaves out the loop behind the place where the surfaces meet before the trailing edge, if it is smaller than a thousandth of the chord;
    /// of surfaces that touch there only the points, to the last decimal, so that the trailing edge stays where it is.
    ///
    /// ```text
    ///  upper ────╲  ╱╲            ────╲
    ///             ╳   ╲    ─▶          ╳  tail
    ///  lower ────╱  ╲ ╱           ────╱
    /// ```
    fn untie_tail(&mut self, decimal: f64, wide: f64, notes: &mut Vec<String>) {
        const LOOP: f64 = 1e-3;
        let ends_in_a_point = (self.first() - self.last()).hypot() < SHARP * wide;
        let meeting = meeting_at_tail(&self.points, ends_in_a_point, wide);
        let Some(Meeting { at, upper, lower, reach }) = meeting else { return };
        if ends_in_a_point && self.thickness_behind(upper, lower) <= decimal {
            let touching = self.leave_out_behind(upper, lower);
            if touching > 0 {
                let place = format!("near ({}, {})", at.x, at.y);
                notes.push(format!(
                    "The surfaces touch {place}, before the trailing edge: {touching} points there were left out."
                ));
            }
            return;
        }
        if reach < LOOP * wide && lower > upper + 2 {
            let kept = self.points[upper + 1..=lower].iter().copied();
            self.points = [at].into_iter().chain(kept).chain([at]).collect();
            notes.push(format!(
                "The surfaces cross at ({}, {}), before the trailing edge: the loop of {reach:.1e} behind was left out.",
                at.x, at.y
            ));
        }
    }

    /// Leaves out the points behind the edges `upper` and `lower`, but for the two ends, and says how many those are.
    fn leave_out_behind(&mut self, upper: usize, lower: usize) -> usize {
        let n = self.points.len();
        let mut kept = vec![self.points[0]];
        kept.extend(&self.points[upper + 1..=lower]);
        kept.push(self.points[n - 1]);
        // Fewer are no section.
        if kept.len() < 4 {
            return 0;
        }
        self.nose = self.nose.saturating_sub(upper);
        self.points = kept;
        n - self.points.len()
    }

    /// How far the surfaces lie apart behind points `upper` and `lower`, at most: upright, at their points.
    fn thickness_behind(&self, upper: usize, lower: usize) -> f64 {
        let (above, below) = (&self.points[..=upper], &self.points[lower..]);
        let height = |side: &[Point], x: f64| {
            let span = side.windows(2).find(|w| (w[0].x - x) * (w[1].x - x) <= 0.0 && w[0].x != w[1].x)?;
            Some(span[0].y + (span[1].y - span[0].y) * (x - span[0].x) / (span[1].x - span[0].x))
        };
        let apart = |side: &[Point], p: &Point| height(side, p.x).map_or(0.0, |y| (y - p.y).abs());
        let over = above.iter().map(|p| apart(below, p)).fold(0.0, f64::max);
        below.iter().map(|p| apart(above, p)).fold(over, f64::max)
    }

    /// Takes a blunt trailing edge that the points draw out of the surfaces, and starts the contour at its upper end.
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

    /// Closes a gap that is rounding, and one that a missing last point leaves.
    fn close(&mut self, wide: f64, notes: &mut Vec<String>) {
        if !self.base.is_empty() || self.first() == self.last() {
            return;
        }
        let (first, last) = (self.first(), self.last());
        let gap = first - last;
        let n = self.points.len();
        if gap.hypot() < SHARP * wide {
            let tail = self.tail();
            (self.points[0], self.points[n - 1]) = (tail, tail);
            notes.push(format!("The trailing edge had a gap of {:.1e} and was closed.", gap.hypot()));
            return;
        }
        // The closing edge lies along the chord and goes on as a surface does (turning less than 45°): the point there is missing,
        // the end is not blunt.
        let goes_on = |along: Vec2, next: Vec2| {
            gap.x.abs() > gap.y.abs() && along.dot(next) > FRAC_1_SQRT_2 * along.hypot() * next.hypot()
        };
        if goes_on(last - self.points[n - 2], gap) {
            self.points.push(first);
        } else if goes_on(gap, self.points[1] - first) {
            self.points.insert(0, last);
        } else {
            return;
        }
        notes.push("The contour stops short of the trailing edge and was closed with its other end.".into());
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

    /// Refuses what runs to and fro: the surfaces of a section take its width twice, of a slat or with a cove a little more.
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

    /// Refuses what crosses itself, by its lines.
    fn refuse_crossed(&self, samples: &[Sample]) -> Result<(), ImportError> {
        let ring: Vec<Point> = self.points.iter().chain(&self.base).copied().collect();
        let Some((at, edges)) = first_crossing(&ring) else { return Ok(()) };
        // An edge that was joined or cut has ends of no line; the other one tells.
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

// ---- ends ----

/// Turning at point `i` of a ring, in radians; 0 at repeated points.
fn turning(ring: &[Point], i: usize) -> f64 {
    let n = ring.len();
    let (a, b, c) = (ring[(i + n - 1) % n], ring[i % n], ring[(i + 1) % n]);
    let (before, after) = (b - a, c - b);
    libm::atan2(before.cross(after), before.dot(after))
}

fn aftmost(ring: &[Point]) -> usize {
    (0..ring.len()).reduce(|a, b| if ring[b].x > ring[a].x { b } else { a }).unwrap_or(0)
}

/// The blunt trailing edge of a counter-clockwise ring, as the indices of its lower and its upper end.
///
/// It is the straight run of upright edges at the aftmost point between two corners. Surfaces that meet at an angle ω leave 180° − ω of
/// turning to its ends; a round end spends that on its points one after the other, and no two of them, an edge apart, have most of it.
///
/// ```text
///   ────────┐ upper
///           │ base
///   ────────┘ lower
/// ```
fn base_of(ring: &[Point], wide: f64) -> Option<[usize; 2]> {
    // Half circles by three edges turn 60° and 60°, squared ends 90° and 90°: the bound lies between.
    const BOTH: f64 = 130.0 / 180.0 * PI;
    const EACH: f64 = 40.0 / 180.0 * PI;
    const STRAIGHT: f64 = 10.0 / 180.0 * PI;
    let n = ring.len();
    if n < 6 {
        return None;
    }
    let upright = |i: usize| {
        let edge = ring[(i + 1) % n] - ring[i % n];
        edge.y > edge.x.abs()
    };
    let goes_on = |i: usize| turning(ring, i % n).abs() < STRAIGHT;
    let tail = aftmost(ring);
    let start = [tail, tail + n - 1].into_iter().find(|&i| upright(i))?;
    let (mut lower, mut upper) = (start, start + 1);
    while upper - lower < n - 3 && upright(lower + n - 1) && goes_on(lower) {
        lower += n - 1;
        upper += n;
    }
    while upper - lower < n - 3 && upright(upper) && goes_on(upper) {
        upper += 1;
    }
    let (from, to) = (ring[lower % n], ring[upper % n]);
    let along = to - from;
    // A base that is no straight line is a round end.
    let is_straight = (lower..upper).all(|i| along.cross(ring[i % n] - from).abs() <= 0.02 * along.hypot2());
    let turned = [turning(ring, lower % n), turning(ring, upper % n)];
    let is_base = is_straight
        && (SHARP * wide..0.5 * wide).contains(&along.hypot())
        && turned[0] + turned[1] >= BOTH
        && turned.iter().all(|&t| t >= EACH);
    is_base.then_some([lower % n, upper % n])
}

/// Whether a counter-clockwise ring ends at its right in a corner or in a base.
fn is_edged(ring: &[Point]) -> bool {
    // Of a nose with few points the foremost turns by up to some 110°.
    const CORNER: f64 = 120.0 / 180.0 * PI;
    let mut ring = ring.to_vec();
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let wide = bounds_of(ring.iter().copied()).map_or(0.0, |b| b.width());
    ring.len() >= 3 && (turning(&ring, aftmost(&ring)) >= CORNER || base_of(&ring, wide).is_some())
}

// ---- order ----

/// Where the second surface starts in a file that gives one after the other: by its counts, by a blank line between, or by the jump from
/// one to the next.
fn cut_surfaces(samples: &[Sample], counts: Option<[usize; 2]>, wide: f64) -> Option<usize> {
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
    // A contour from the trailing edge and back that merely has a gap at the nose runs forth and back: no two surfaces from the nose.
    let (a, b) = samples.split_at(found);
    let downstream = |part: &[Sample]| part[part.len() - 1].at.x > part[0].at.x;
    (downstream(a) == downstream(b)).then_some(found)
}

/// Refuses a line of text that stands amid a surface: it holds the place of a point. Between two surfaces it is a heading.
fn refuse_text(samples: &[Sample], cut: Option<usize>, wide: f64) -> Result<(), ImportError> {
    let is_heading = |i: usize| {
        let turns = |k: usize| {
            let (before, after) = (samples[k].at.x - samples[k - 1].at.x, samples[k + 1].at.x - samples[k].at.x);
            before * after <= 0.0
        };
        // At the nose the abscissa turns around, at a point beside the heading.
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

/// Two surfaces that run the same way as one contour from the trailing edge to the nose and back.
fn join(mut a: Vec<Point>, mut b: Vec<Point>) -> Vec<Point> {
    if a[a.len() - 1].x > a[0].x {
        a.reverse();
    } else {
        b.reverse();
    }
    // The nose ends the one and starts the other.
    if a.last() == b.first() {
        a.pop();
    }
    a.extend(b);
    a
}

/// Longest edge along the chord, in chords, that closes a contour without being told.
const CLOSING: f64 = 0.05;

/// Refuses a contour of which a part is missing, as of a file that was cut short: the edge from its last point to its first lies along the
/// chord (an upright one is a blunt trailing edge, however thick) and is longer than a twentieth of it and than twice either edge beside it.
fn refuse_open(points: &[Point], wide: f64, lines: [usize; 2]) -> Result<(), ImportError> {
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

/// A contour in one go, made to start at the trailing edge.
fn from_trailing_edge(mut points: Vec<Point>, wide: f64, notes: &mut Vec<String>) -> Vec<Point> {
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
    // A blunt end is an upright edge at the aftmost point; its ends become the ends of the contour.
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

// ---- points too near ----

fn merge_repeated(points: &mut Vec<Point>, tolerance: f64, notes: &mut Vec<String>) {
    let before = points.len();
    let last = points[before - 1];
    points.dedup_by(|b, a| (*b - *a).hypot() <= tolerance);
    let n = points.len();
    if n > 1 {
        points[n - 1] = last;
    }
    if n < before {
        notes.push(format!("Repeated points that became one with their neighbours: {}.", before - n));
    }
}

/// Leaves out points between neighbours nearer than 2e-4 of the chord that lie on the line between them to half a unit of the last decimal,
/// or to 1e-8 of the chord: they carry no direction. A contour keeps some ten thousand points then.
fn thin(points: &mut Vec<Point>, decimal: f64, wide: f64, notes: &mut Vec<String>) {
    let (reach, slack) = (2e-4 * wide, (0.5 * decimal).max(1e-8 * wide));
    let before = points.len();
    let mut kept: Vec<Point> = Vec::with_capacity(before);
    kept.push(points[0]);
    let mut sector = Sector::new(slack);
    for w in points.windows(2).skip(1) {
        let [candidate, next] = [w[0], w[1]];
        let from = kept[kept.len() - 1];
        sector.narrow(candidate - from);
        // The candidate is left out if the next point can be reached past it.
        if (next - from).hypot() > reach || !sector.allows(next - from) {
            kept.push(candidate);
            sector = Sector::new(slack);
        }
    }
    kept.push(points[before - 1]);
    if kept.len() < before {
        notes.push(format!(
            "Points within {slack:.1e} of the lines between near neighbours, left out: {}.",
            before - kept.len()
        ));
        *points = kept;
    }
}

/// The directions in which a line from a point passes within a distance of all the points left out.
struct Sector {
    slack: f64,
    /// The first direction, and how far others may turn from it, in radians.
    about: Option<(Vec2, f64, f64)>,
}

impl Sector {
    fn new(slack: f64) -> Self {
        Self { slack, about: None }
    }

    fn narrow(&mut self, to: Vec2) {
        let distance = to.hypot();
        // From within the slack every direction will do.
        if distance <= self.slack {
            return;
        }
        let half = libm::asin(self.slack / distance);
        let (about, low, high) = self.about.unwrap_or((to, f64::NEG_INFINITY, f64::INFINITY));
        let turned = libm::atan2(about.cross(to), about.dot(to));
        self.about = Some((about, low.max(turned - half), high.min(turned + half)));
    }

    fn allows(&self, to: Vec2) -> bool {
        let Some((about, low, high)) = self.about else { return true };
        let turned = libm::atan2(about.cross(to), about.dot(to));
        (low..=high).contains(&turned)
    }
}

/// Twice the enclosed area, positive counter-clockwise.
pub(super) fn doubled_area(points: &[Point]) -> f64 {
    let Some(&origin) = points.first() else { return 0.0 };
    points.windows(2).map(|w| (w[0] - origin).cross(w[1] - origin)).sum()
}
