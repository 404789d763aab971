//! Airfoil sections: Selig, Lednicer and MSES/XFOIL coordinate files.
//!
//! These files were typed by hand for sixty years. Understood are: any number of header lines or none, names that are numbers, the
//! four-number line of MSES and XFOIL, Lednicer's line of two counts (also where it is wrong), `999. 999.` between elements, blank or text
//! lines between surfaces, either surface first, a start at the nose, commas, tabs, decimal commas, Fortran exponents, further
//! columns, Latin-1, percent of chord, repeated points, a closing point repeated or missing, and text behind the data. What was met
//! is told in [`Drawing::notes`]. Coordinates are kept as they are, percent apart; x points downstream.
//!
//! **Curves.** One cubic spline (natural, centripetal) runs through the whole contour from the trailing edge over the nose and back,
//! so the nose is smooth and only the trailing edge is a corner. It is cut at the nose, the point farthest from the trailing edge, into `upper` and
//! `lower`; a blunt trailing edge is `te`. Where the spline would cross itself, as it may through few or uneven points, a tamer
//! interpolant takes its place: a C¹ cubic that stays monotone wherever the points are (Fritsch & Butland 1984), then
//! straight lines. Of several elements the names carry the number of the element: `upper1`, `lower1`, `te1`, `upper2`, ….
//!
//! **Far field.** A circle `farfield` around mid-chord, the region `fluid` between, and sizes for an Euler mesh: fine at nose and trailing
//! edge, along the chord and in the wake, coarse far away. Without one (0 chords) the region is the section itself: `section`,
//! or `section1`, `section2`, ….

use super::{ImportError, number};
use crate::curve::{Bezier, Curve, Spline};
use crate::domain::{Drawing, FillRule, Seed, SeedKind, SizeRequest};
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, Rect, Vec2, bounds_of, magnitude, scaled, unit_scale};
use std::borrow::Cow;
use std::f64::consts::FRAC_1_SQRT_2;

/// Part of the chord below which two points are one: files carry five or six decimals, so nearer is rounding.
const SAME: f64 = 1e-6;
/// Part of the chord below which a trailing edge is sharp: ten units in the sixth decimal.
const SHARP: f64 = 1e-5;
/// Where a sharp trailing edge is cut off for `blunt` and `round`, in chords.
const TRUNCATION: f64 = 0.99;
const HELP: &str =
    "expected lines of two numbers, x and y, around the section (Selig) or one surface after the other (Lednicer)";

/// What becomes of the trailing edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TrailingEdge {
    /// As in the file; gaps below 1e-5 chords are rounding and closed.
    #[default]
    Keep,
    /// Ends in a point: a gap is closed by shearing both surfaces to its middle, not at all at the nose and fully at the trailing edge.
    Sharp,
    /// Ends in a straight `te`: a sharp section is cut off at 99 % chord.
    Blunt,
    /// Ends in a half circle `te`: a sharp section is cut off at 99 % chord.
    Round,
}

/// How an airfoil is set up.
#[derive(Clone, Debug, PartialEq)]
pub struct AirfoilOptions {
    pub trailing_edge: TrailingEdge,
    /// Radius of the far field in chords; 0: the section itself is the domain.
    pub far_field: f64,
    /// Turns the section nose up about its quarter chord, in degrees; the flow stays along +x.
    pub incidence_deg: f64,
}

impl Default for AirfoilOptions {
    fn default() -> Self {
        // 20 chords is the text-book floor for the far field of a section.
        Self { trailing_edge: TrailingEdge::Keep, far_field: 20.0, incidence_deg: 0.0 }
    }
}

/// Reads an airfoil file.
pub fn read(bytes: &[u8], stem: &str, options: &AirfoilOptions) -> Result<Drawing, ImportError> {
    check(options)?;
    let mut notes = Vec::new();
    let text = decode(bytes, &mut notes);
    let table = Table::scan(&text, &mut notes)?;
    let mut contours = Vec::with_capacity(table.elements.len());
    for (i, element) in table.elements.iter().enumerate() {
        let label = if table.elements.len() > 1 { format!("Element {}: ", i + 1) } else { String::new() };
        let mut said = Vec::new();
        contours.push(Contour::trace(element, table.counts, &mut said)?);
        notes.extend(said.into_iter().map(|note| format!("{label}{note}")));
    }
    let format = format!("airfoil ({})", if contours.iter().any(|c| c.by_surface) { "Lednicer" } else { "Selig" });
    let title = table.title.unwrap_or_else(|| stem.to_owned());
    let mut drawing = Drawing { format, title, notes, fill: FillRule::EvenOdd, ..Drawing::default() };
    draw(contours, options, &mut drawing)?;
    Ok(drawing)
}

fn check(options: &AirfoilOptions) -> Result<(), ImportError> {
    if !(options.far_field >= 0.0 && options.far_field.is_finite()) {
        let help = "give a radius in chords, or 0 for the section itself";
        return Err(ImportError::new(format!("the far field of {} chords is no size", options.far_field), help));
    }
    if !options.incidence_deg.is_finite() {
        return Err(ImportError::new("the incidence is not a number", "give degrees, nose up"));
    }
    Ok(())
}

// ---- the file's lines ----

fn decode<'a>(bytes: &'a [u8], notes: &mut Vec<String>) -> Cow<'a, str> {
    match std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => {
            notes.push("The text is not UTF-8 and was read as Latin-1.".into());
            Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect())
        }
    }
}

/// What a line of the file is.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Row {
    Blank,
    /// Two numbers or more: the first two, how many there are, and whether words follow them.
    Point {
        at: Point,
        columns: usize,
        words: bool,
    },
    /// A number, then something else.
    Half,
    /// A number and dots: tables that leave an ordinate out print them in its place.
    Dotted,
    Text,
}

impl Row {
    fn of(line: &str, decimal_commas: &mut bool) -> Self {
        // Tables put computed ordinates in parentheses.
        let plain = |field| str::trim_matches(field, ['(', ')', ' ', '\r', '\n']);
        let mut fields = line.split([' ', '\t', ';']).map(plain).filter(|f| !f.is_empty()).peekable();
        if fields.peek().is_none() {
            return Self::Blank;
        }
        let is_dotted = fields.clone().nth(1).is_some_and(|f| f.len() > 1 && f.bytes().all(|b| b == b'.'));
        let decimal = is_decimal_comma(fields.clone());
        let mut values: [Option<f64>; 4] = [None; 4];
        let mut columns = 0;
        let mut words = false;
        let mut take = |token: &str| match number(token.as_bytes()) {
            Some(value) if !words => {
                if let Some(slot) = values.get_mut(columns) {
                    *slot = Some(value);
                }
                columns += 1;
            }
            _ => words = true,
        };
        if decimal {
            fields.for_each(|f| take(&f.replace(',', ".")));
        } else {
            fields.flat_map(|f| f.split(',')).filter(|f| !f.is_empty()).for_each(&mut take);
        }
        match (values[0], values[1]) {
            (Some(x), Some(y)) => {
                *decimal_commas |= decimal;
                Self::Point { at: Point::new(x, y), columns, words }
            }
            (Some(_), None) if is_dotted => Self::Dotted,
            (Some(_), None) => Self::Half,
            _ => Self::Text,
        }
    }

    fn point(self) -> Option<Point> {
        match self {
            Self::Point { at, words: false, .. } => Some(at),
            _ => None,
        }
    }
}

/// Whether the commas of a line stand for decimal points: two fields or more, no point, and a comma between digits.
fn is_decimal_comma<'a>(fields: impl Iterator<Item = &'a str>) -> bool {
    let (mut n, mut inside) = (0, false);
    for field in fields {
        if field.contains('.') || field.starts_with(',') || field.ends_with(',') || field.matches(',').count() > 1 {
            return false;
        }
        inside |= field.contains(',');
        n += 1;
    }
    n >= 2 && inside
}

/// A coordinate pair and where it stood.
#[derive(Clone, Copy, Debug)]
struct Sample {
    at: Point,
    line: usize,
    /// A blank or text line stands before it.
    gap_before: bool,
}

/// The file as a title and elements of points.
struct Table {
    title: Option<String>,
    /// Lednicer's counts of the two surfaces, where they fit the points.
    counts: Option<[usize; 2]>,
    elements: Vec<Vec<Sample>>,
}

impl Table {
    fn scan(text: &str, notes: &mut Vec<String>) -> Result<Self, ImportError> {
        let mut decimal_commas = false;
        let lines: Vec<&str> = lines(text);
        let rows: Vec<Row> = lines.iter().map(|line| Row::of(line, &mut decimal_commas)).collect();
        if decimal_commas {
            notes.push("Commas were read as decimal points.".into());
        }
        let start = first_data(&rows).ok_or_else(|| ImportError::new("no coordinates were found", HELP))?;
        let (start, announced) = skip_special(&rows, start, notes);
        let mut elements = gather(&rows, start, notes)?;
        unscale_percent(&mut elements, notes);
        let counts = announced.and_then(|counts| {
            let fits = elements.len() == 1 && counts[0].checked_add(counts[1]) == Some(elements[0].len());
            if !fits {
                notes.push(format!(
                    "The counts {} and {} do not fit the points and were passed over.",
                    counts[0], counts[1]
                ));
            }
            fits.then_some(counts)
        });
        if counts.is_none() && elements.len() == 1 {
            elements = split_loops(elements.swap_remove(0), notes);
        }
        let title = lines[..start].iter().map(|l| l.trim_matches(|c: char| c.is_whitespace() || c == '#'));
        let title = title.zip(&rows).find(|(l, row)| !l.is_empty() && row.point().is_none()).map(|(l, _)| one_line(l));
        if start == 0 {
            notes.push("There is no name line.".into());
        }
        Ok(Self { title, counts, elements })
    }
}

/// Runs of blanks and tabs as one blank each.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Lines ended by LF, CR LF or CR.
fn lines(text: &str) -> Vec<&str> {
    if text.contains('\n') { text.lines().collect() } else { text.split('\r').collect() }
}

/// The first of two neighbouring lines of numbers.
fn first_data(rows: &[Row]) -> Option<usize> {
    let mut last: Option<usize> = None;
    for (i, row) in rows.iter().enumerate() {
        match row {
            Row::Blank | Row::Dotted => {}
            _ if row.point().is_none() => last = None,
            _ => match last {
                Some(first) => return Some(first),
                None => last = Some(i),
            },
        }
    }
    None
}

/// Steps over the four-number line of MSES and XFOIL, over counts and over names of two numbers; gives Lednicer's counts.
fn skip_special(rows: &[Row], mut start: usize, notes: &mut Vec<String>) -> (usize, Option<[usize; 2]>) {
    let mut counts = None;
    // A name of numbers, a box and counts: three such lines at most.
    for _ in 0..3 {
        let Row::Point { at, columns, words: false } = rows[start] else { break };
        let Some(next) = (start + 1..rows.len()).find(|&i| rows[i].point().is_some()) else { break };
        let Row::Point { columns: columns_after, .. } = rows[next] else { break };
        if columns >= 4 && columns_after < 4 {
            notes.push("The line of four numbers (MSES, XFOIL) was passed over.".into());
        } else if let Some(found) = as_counts(at, &rows[next..]) {
            counts = Some(found);
        } else {
            break;
        }
        start = next;
    }
    (start, counts)
}

/// Two whole numbers that fit the points after them as counts, or that lie far off them.
fn as_counts(at: Point, after: &[Row]) -> Option<[usize; 2]> {
    let count = |v: f64| (v == v.trunc() && (2.0..1e9).contains(&v)).then_some(v as usize);
    let counts = [count(at.x)?, count(at.y)?];
    let points = after.iter().filter_map(|row| row.point()).take_while(|p| !is_separator(*p));
    let (n, widest) = points.fold((0, 0.0_f64), |(n, widest), p| (n + 1, widest.max(p.x.abs())));
    (counts[0] + counts[1] == n || at.x > 2.0 * widest).then_some(counts)
}

/// `999. 999.`, the line between elements.
fn is_separator(p: Point) -> bool {
    p.x == p.y && (999.0..1000.0).contains(&p.x)
}

fn gather(rows: &[Row], start: usize, notes: &mut Vec<String>) -> Result<Vec<Vec<Sample>>, ImportError> {
    let mut elements: Vec<Vec<Sample>> = vec![Vec::new()];
    let mut gap = false;
    // Points of the current element before the last line of text.
    let mut before_text: Option<usize> = None;
    let (mut extra_columns, mut text_lines, mut dotted) = (false, Vec::new(), Vec::new());
    for (i, row) in rows.iter().enumerate().skip(start) {
        let here = elements.len() - 1;
        let beside_point = i > start && rows[i - 1].point().is_some();
        match *row {
            Row::Blank => gap = true,
            Row::Dotted => dotted.push(i + 1),
            Row::Point { at, words: false, .. } if is_separator(at) => {
                elements.push(Vec::new());
                (gap, before_text) = (false, None);
            }
            Row::Point { at, columns, words } if !words || beside_point => {
                extra_columns |= columns > 2 || words;
                let gap_before = std::mem::take(&mut gap) && !elements[here].is_empty();
                elements[here].push(Sample { at, line: i + 1, gap_before });
            }
            Row::Half if beside_point && rows.get(i + 1).is_some_and(|r| r.point().is_some()) => {
                let help = "mend the line, or remove it";
                return Err(ImportError::at(
                    i + 1,
                    "the line lies amid coordinates, but does not hold two numbers",
                    help,
                ));
            }
            _ => {
                drop_numbers_in_text(&mut elements[here], before_text);
                (gap, before_text) = (true, Some(elements[here].len()));
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
    if extra_columns {
        notes.push("What follows the first two numbers of a line was passed over.".into());
    }
    elements.retain(|e| !e.is_empty());
    if elements.is_empty() { Err(ImportError::new("no coordinates were found", HELP)) } else { Ok(elements) }
}

/// "12, 40 and 7 more".
fn few(lines: &[usize]) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<String> = lines.iter().take(SHOWN).map(usize::to_string).collect();
    let more = lines.len().saturating_sub(SHOWN);
    if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
}

/// Fewer than three points behind a line of text make no surface: they are numbers in the text.
fn drop_numbers_in_text(element: &mut Vec<Sample>, before_text: Option<usize>) {
    if let Some(cut) = before_text.filter(|&cut| cut > 0 && element.len() - cut < 3) {
        element.truncate(cut);
    }
}

/// Sections that span 50 to 150 are in percent of chord.
fn unscale_percent(elements: &mut [Vec<Sample>], notes: &mut Vec<String>) {
    let Some(bounds) = bounds_of(elements.iter().flatten().map(|s| s.at)) else { return };
    if !(50.0..=150.0).contains(&bounds.width()) {
        return;
    }
    notes.push("Coordinates are in percent of chord and were divided by 100.".into());
    for sample in elements.iter_mut().flatten() {
        sample.at = Point::new(sample.at.x / 100.0, sample.at.y / 100.0);
    }
}

/// Several whole contours with blank or text lines between, but without `999.` lines, are several elements.
fn split_loops(samples: Vec<Sample>, notes: &mut Vec<String>) -> Vec<Vec<Sample>> {
    let parts: Vec<&[Sample]> = samples.chunk_by(|_, b| !b.gap_before).collect();
    if parts.len() < 2 || !parts.iter().all(|part| part.len() >= 5 && is_loop(part)) {
        return vec![samples];
    }
    notes.push(format!("{} contours with blank lines between are as many elements.", parts.len()));
    parts.into_iter().map(<[Sample]>::to_vec).collect()
}

/// Whether a run of points comes back to where it began, to a quarter of its width: a surface alone does not.
fn is_loop(samples: &[Sample]) -> bool {
    let [first, .., last] = samples else { return false };
    (first.at.x - last.at.x).abs() < 0.25 * width(samples.iter().map(|s| s.at))
}

fn width(points: impl Iterator<Item = Point>) -> f64 {
    bounds_of(points).map_or(0.0, |b| b.width())
}

// ---- a contour in order ----

/// The contour of one element, counter-clockwise from the trailing edge over the upper surface to the nose and back below.
#[derive(Clone, Debug)]
struct Contour {
    points: Vec<Point>,
    /// Points of the trailing edge between the last point and the first, where the file has some.
    base: Vec<Point>,
    /// Index of the nose, the point farthest from the trailing edge; never the first or the last.
    nose: usize,
    /// First and last line in the file.
    lines: [usize; 2],
    by_surface: bool,
}

impl Contour {
    fn trace(samples: &[Sample], counts: Option<[usize; 2]>, notes: &mut Vec<String>) -> Result<Self, ImportError> {
        let lines = [samples[0].line, samples[samples.len() - 1].line];
        let wide = width(samples.iter().map(|s| s.at));
        let tall = bounds_of(samples.iter().map(|s| s.at)).map_or(0.0, |b| b.height());
        // Squares and cubes of coordinates and widths must stay within the range of numbers.
        let in_range = samples.iter().all(|s| s.at.x.abs().max(s.at.y.abs()) < 1e100) && wide > 1e-100;
        if samples.len() < 4 || !in_range || tall == 0.0 {
            let what = format!("{} points from line {} on make no section", samples.len(), lines[0]);
            return Err(ImportError::at(lines[0], what, HELP));
        }
        let surfaces = cut_surfaces(samples, counts, wide);
        let by_surface = surfaces.is_some();
        let mut points = match surfaces {
            Some((a, b)) => {
                notes.push("The surfaces are given one after the other and were joined at the nose.".into());
                join(a, b)
            }
            None => {
                let points: Vec<Point> = samples.iter().map(|s| s.at).collect();
                refuse_open(&points, wide, lines)?;
                from_trailing_edge(points, wide, notes)
            }
        };
        if by_surface {
            refuse_open(&points, wide, lines)?;
        }
        merge_repeated(&mut points, SAME * wide, notes);
        if doubled_area(&points) < 0.0 {
            points.reverse();
            notes.push("The points ran clockwise and were turned around.".into());
        }
        let mut contour = Self { points, base: Vec::new(), nose: 0, lines, by_surface };
        contour.take_base(wide);
        contour.close(wide, notes);
        contour.find_nose()?;
        Ok(contour)
    }

    fn first(&self) -> Point {
        self.points[0]
    }

    fn last(&self) -> Point {
        self.points[self.points.len() - 1]
    }

    /// Middle of the trailing edge.
    fn tail(&self) -> Point {
        self.first().midpoint(self.last())
    }

    fn nose_point(&self) -> Point {
        self.points[self.nose]
    }

    fn chord(&self) -> f64 {
        (self.tail() - self.nose_point()).hypot()
    }

    /// Moves points that lie on the blunt end from the ends of the contour to the base: an upright first or last edge behind a corner.
    fn take_base(&mut self, wide: f64) {
        let upright = |a: Point, b: Point, c: Point| {
            let (ab, bc) = (b - a, c - b);
            // More than 60° of turning, a twentieth of the chord at most, steeper than 45°.
            ab.dot(bc) < 0.5 * ab.hypot() * bc.hypot()
                && (SHARP * wide..0.05 * wide).contains(&ab.hypot())
                && ab.y.abs() > ab.x.abs()
        };
        if self.points.len() < 7 {
            return;
        }
        let n = self.points.len();
        let (p, mut base) = (&self.points, Vec::new());
        let at_start = upright(p[0], p[1], p[2]);
        let at_end = upright(p[n - 1], p[n - 2], p[n - 3]);
        if at_end {
            base.push(p[n - 1]);
        }
        if at_start && !(at_end && p[0] == p[n - 1]) {
            base.push(p[0]);
        }
        self.points.truncate(n - usize::from(at_end));
        self.points.drain(..usize::from(at_start));
        self.base = base;
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

    fn map(&mut self, f: impl Fn(Point) -> Point) {
        self.points.iter_mut().chain(&mut self.base).for_each(|p| *p = f(*p));
    }

    fn is_sharp(&self) -> bool {
        self.base.is_empty() && self.first() == self.last()
    }

    /// Closes a blunt end by shearing either surface to its middle, in proportion to the way from the nose.
    fn sharpen(&mut self) {
        let (tail, nose, n) = (self.tail(), self.nose_point(), self.points.len());
        let chord = tail - nose;
        let (from_first, from_last) = (tail - self.first(), tail - self.last());
        for (i, p) in self.points.iter_mut().enumerate() {
            let part = ((*p - nose).dot(chord) / chord.hypot2()).clamp(0.0, 1.0);
            *p += part * if i <= self.nose { from_first } else { from_last };
        }
        (self.points[0], self.points[n - 1]) = (tail, tail);
        self.base.clear();
    }
}

/// The two surfaces of a file that gives one after the other: by its counts, by a blank line between, or by the jump from one to the next.
fn cut_surfaces(samples: &[Sample], counts: Option<[usize; 2]>, wide: f64) -> Option<(Vec<Point>, Vec<Point>)> {
    let spans = |part: &[Sample]| match part {
        [first, .., last] => (first.at.x - last.at.x).abs() > 0.5 * wide,
        _ => false,
    };
    let points = |part: &[Sample]| part.iter().map(|s| s.at).collect::<Vec<Point>>();
    let both = |at: usize| {
        let (a, b) = samples.split_at_checked(at)?;
        (spans(a) && spans(b)).then(|| (points(a), points(b)))
    };
    let by_count = counts.and_then(|[upper, _]| both(upper));
    let mut gaps = (1..samples.len()).filter(|&i| samples[i].gap_before);
    let by_gap = || gaps.next().filter(|_| gaps.next().is_none()).and_then(both);
    let mut jumps = (1..samples.len()).filter(|&i| (samples[i].at.x - samples[i - 1].at.x).abs() > 0.5 * wide);
    let by_jump = || jumps.next().filter(|_| jumps.next().is_none()).and_then(both);
    let found = by_count.or_else(by_gap).or_else(by_jump)?;
    // A contour from the trailing edge and back that merely has a gap at the nose runs forth and back: no two surfaces from the nose.
    let (a, b) = (&found.0, &found.1);
    let downstream = |part: &[Point]| part[part.len() - 1].x > part[0].x;
    (downstream(a) == downstream(b)).then_some(found)
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
    let tail = (0..n).reduce(|a, b| if points[b].x > points[a].x { b } else { a }).unwrap_or(0);
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

/// Twice the enclosed area, positive counter-clockwise.
fn doubled_area(points: &[Point]) -> f64 {
    let Some(&origin) = points.first() else { return 0.0 };
    points.windows(2).map(|w| (w[0] - origin).cross(w[1] - origin)).sum()
}

// ---- curves ----

/// The curves of one element.
struct Section {
    upper: Curve,
    lower: Curve,
    te: Vec<Curve>,
    nose: Point,
    /// Middle of the trailing edge.
    tail: Point,
    chord: f64,
    lines: [usize; 2],
}

impl Section {
    fn build(contour: &Contour, edge: TrailingEdge, notes: &mut Vec<String>) -> Result<Self, ImportError> {
        let failed = |e: crate::curve::CurveError| ImportError::at(contour.lines[0], e.to_string(), HELP);
        let whole = interpolate(contour, notes).map_err(failed)?;
        let at_nose = parameter_of_point(&whole, contour.nose, contour.points.len());
        let cut_off = contour.is_sharp() && matches!(edge, TrailingEdge::Blunt | TrailingEdge::Round);
        let (from, to) = if cut_off { truncation(contour, &whole, at_nose)? } else { (0.0, 1.0) };
        if cut_off {
            notes.push("The sharp trailing edge was cut off at 99 % chord.".into());
        }
        let (upper, lower) = (whole.part(from, at_nose), whole.part(at_nose, to));
        let (first, last) = (upper.start(), lower.end());
        let te = trailing_edge(first, last, contour, edge).map_err(failed)?;
        let (tail, nose) = (first.midpoint(last), contour.nose_point());
        Ok(Self { upper, lower, te, nose, tail, chord: contour.chord(), lines: contour.lines })
    }
}

/// The curves that close the contour from its last point to its first.
fn trailing_edge(
    first: Point,
    last: Point,
    contour: &Contour,
    edge: TrailingEdge,
) -> Result<Vec<Curve>, crate::curve::CurveError> {
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

/// Parameters at which the upper and the lower surface pass 99 % chord.
fn truncation(contour: &Contour, whole: &Curve, at_nose: f64) -> Result<(f64, f64), ImportError> {
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

/// The parameter of data point `i` of `n`: the splines have a knot at every point.
fn parameter_of_point(whole: &Curve, i: usize, n: usize) -> f64 {
    match whole {
        Curve::Spline(spline) if spline.knots.len() == n => spline.knots[i],
        _ => i as f64 / (n - 1) as f64,
    }
}

/// One curve through all points: the smoothest that does not cross itself.
fn interpolate(contour: &Contour, notes: &mut Vec<String>) -> Result<Curve, crate::curve::CurveError> {
    let spline = Curve::natural_spline(&contour.points)?;
    let Some(at) = crossing(&spline, &contour.base) else { return Ok(spline) };
    let place = format!("near ({:.4}, {:.4})", at.x, at.y);
    let tame = monotone_cubic(&contour.points);
    if crossing(&tame, &contour.base).is_none() {
        notes.push(format!(
            "A C2 spline would cross itself {place}; a monotone C1 cubic goes through the points instead."
        ));
        return Ok(tame);
    }
    let straight = piecewise_linear(&contour.points);
    if let Some(at) = crossing(&straight, &contour.base) {
        notes.push(format!("The contour crosses itself near ({:.4}, {:.4}).", at.x, at.y));
        return Ok(spline);
    }
    notes.push(format!("Smooth surfaces would cross {place}; straight lines join the points instead."));
    Ok(straight)
}

/// Centripetal knots over 0..1: steps in proportion to the square root of the distance.
fn centripetal_knots(points: &[Point]) -> Vec<f64> {
    let mut knots = vec![0.0];
    let mut sum = 0.0;
    for w in points.windows(2) {
        sum += (w[1] - w[0]).hypot().sqrt();
        knots.push(sum);
    }
    knots.iter_mut().for_each(|k| *k /= sum);
    knots
}

fn piecewise_linear(points: &[Point]) -> Curve {
    let spans = points.windows(2).map(|w| Bezier { points: w.to_vec(), weights: None }).collect();
    Curve::Spline(Box::new(Spline { knots: centripetal_knots(points), spans }))
}

/// The C¹ cubic through the points whose coordinates are monotone wherever the points' are (Fritsch & Butland 1984, weights by Brodlie).
fn monotone_cubic(points: &[Point]) -> Curve {
    let knots = centripetal_knots(points);
    let step = |i: usize| knots[i + 1] - knots[i];
    let slope = |i: usize| (points[i + 1] - points[i]) / step(i);
    let n = points.len();
    let tangent = |i: usize| match i {
        0 => slope(0),
        i if i == n - 1 => slope(n - 2),
        i => {
            let (before, after) = (slope(i - 1), slope(i));
            let (h, k) = (step(i - 1), step(i));
            let mean = |a: f64, b: f64| match a * b > 0.0 {
                true => 3.0 * (h + k) / ((h + 2.0 * k) / b + (2.0 * h + k) / a),
                false => 0.0,
            };
            Vec2::new(mean(before.x, after.x), mean(before.y, after.y))
        }
    };
    let span = |i: usize| {
        let (a, b, third) = (points[i], points[i + 1], step(i) / 3.0);
        Bezier { points: vec![a, a + third * tangent(i), b - third * tangent(i + 1), b], weights: None }
    };
    let spans = (0..n - 1).map(span).collect();
    Curve::Spline(Box::new(Spline { knots, spans }))
}

/// Where the closed contour of a spline and a base crosses itself: found on chords, eight a span, by exact signs.
fn crossing(spline: &Curve, base: &[Point]) -> Option<Point> {
    let chords = outline(spline, base);
    let bounds = bounds_of(chords.iter().copied())?;
    let unit = unit_scale(magnitude(bounds));
    let ring: Vec<Point> = chords.iter().map(|&p| scaled(p, unit)).collect();
    let n = ring.len();
    let ends = |i: usize| (ring[i], ring[(i + 1) % n]);
    let hierarchy = BoxHierarchy::new((0..n).map(|i| Rect::from_points(ends(i).0, ends(i).1)));
    (0..n)
        .find(|&i| {
            let (a, b) = ends(i);
            let mut crossed = false;
            hierarchy.meeting(Rect::from_points(a, b), |j| {
                let (c, d) = ends(j);
                crossed = j > i && cross(a, b, c, d);
                !crossed
            });
            crossed
        })
        .map(|i| chords[i])
}

/// Whether two segments cross in their insides.
fn cross(a: Point, b: Point, c: Point, d: Point) -> bool {
    let opposite = |p: Point, q: Point, r: Point, s: Point| {
        matches!(
            (orient(p, q, r), orient(p, q, s)),
            (Orientation::Clockwise, Orientation::CounterClockwise)
                | (Orientation::CounterClockwise, Orientation::Clockwise)
        )
    };
    opposite(a, b, c, d) && opposite(c, d, a, b)
}

/// The contour as a ring of points, eight a span (enough to see a crossing of cubics through points that themselves do not cross).
fn outline(spline: &Curve, base: &[Point]) -> Vec<Point> {
    const CHORDS: usize = 8;
    let mut ring = Vec::new();
    if let Curve::Spline(s) = spline {
        for w in s.knots.windows(2) {
            let at = |k: usize| w[0] + (w[1] - w[0]) * k as f64 / CHORDS as f64;
            ring.extend((0..CHORDS).map(|k| spline.point(at(k))));
        }
    }
    ring.push(spline.end());
    ring.extend(base);
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}

// ---- the drawing ----

fn draw(mut contours: Vec<Contour>, options: &AirfoilOptions, drawing: &mut Drawing) -> Result<(), ImportError> {
    if options.trailing_edge == TrailingEdge::Sharp {
        for contour in contours.iter_mut().filter(|c| !c.is_sharp()) {
            contour.sharpen();
            drawing.notes.push("The blunt trailing edge was sheared to a point.".into());
        }
    }
    rotate(&mut contours, options.incidence_deg);
    let mut sections = Vec::with_capacity(contours.len());
    for contour in &contours {
        sections.push(Section::build(contour, options.trailing_edge, &mut drawing.notes)?);
    }
    let (nose, tail) = reference_chord(&contours);
    let chord = (tail - nose).hypot();
    // Files are written for a chord of 1, give or take a flap.
    if (0.8..1.5).contains(&chord) {
        drawing.unit = Some(("chord".into(), "airfoil coordinates".into()));
    } else {
        drawing.notes.push(format!("The chord is {chord} in the file's units, which were kept."));
    }
    for (i, section) in sections.iter().enumerate() {
        add_section(section, &suffix(i, sections.len()), drawing);
    }
    if options.far_field > 0.0 {
        add_far_field(&sections, nose.midpoint(tail), options.far_field * chord, chord, drawing)
    } else {
        (0..sections.len()).for_each(|i| seed_section(&sections[i], &suffix(i, sections.len()), drawing));
        Ok(())
    }
}

/// What tells the names of an element from another's: nothing where there is one.
fn suffix(i: usize, n: usize) -> String {
    if n > 1 { (i + 1).to_string() } else { String::new() }
}

/// The foremost nose and the aftmost trailing edge.
fn reference_chord(contours: &[Contour]) -> (Point, Point) {
    let noses = contours.iter().map(Contour::nose_point).reduce(|a, b| if b.x < a.x { b } else { a });
    let tails = contours.iter().map(Contour::tail).reduce(|a, b| if b.x > a.x { b } else { a });
    (noses.unwrap_or_default(), tails.unwrap_or_default())
}

fn rotate(contours: &mut [Contour], incidence_deg: f64) {
    if incidence_deg == 0.0 {
        return;
    }
    let (nose, tail) = reference_chord(contours);
    let pivot = nose.lerp(tail, 0.25);
    let (sin, cos) = libm::sincos(incidence_deg.to_radians());
    let turned = |p: Point| {
        let v = p - pivot;
        pivot + Vec2::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin)
    };
    contours.iter_mut().for_each(|c| c.map(turned));
}

fn add_section(section: &Section, suffix: &str, drawing: &mut Drawing) {
    let from = format!("lines {} to {}", section.lines[0], section.lines[1]);
    drawing.add(section.upper.clone(), &format!("upper{suffix}"), from.clone());
    drawing.add(section.lower.clone(), &format!("lower{suffix}"), from.clone());
    for edge in &section.te {
        drawing.add(edge.clone(), &format!("te{suffix}"), format!("trailing edge, {from}"));
    }
    let surface = 0.015 * section.chord;
    for surface_name in ["upper", "lower"] {
        let name = drawing.names.intern(&format!("{surface_name}{suffix}"));
        drawing.sizes.push(SizeRequest::Boundary { name, edge: surface });
    }
    // A flow turns around a blunt end: three edges are the least that show it.
    let blunt: f64 = section.te.iter().map(Curve::length).sum();
    if blunt > 0.0 {
        let name = drawing.names.intern(&format!("te{suffix}"));
        drawing.sizes.push(SizeRequest::Boundary { name, edge: blunt / 3.0 });
    }
    // Grades were chosen for some ten thousand triangles around one section within 20 chords.
    for end in [section.nose, section.tail] {
        drawing.sizes.push(SizeRequest::Near { from: end, to: end, edge: 0.005 * section.chord, grade: 0.2 });
    }
}

fn seed_section(section: &Section, suffix: &str, drawing: &mut Drawing) {
    let Some(at) = inside(section) else {
        drawing.notes.push("No point inside the section was found to name its region by.".into());
        return;
    };
    let name = drawing.names.intern(&format!("section{suffix}"));
    let entity = format!("section{suffix}");
    drawing.seeds.push(Seed { at, kind: SeedKind::Region { name, max_area: None }, entity });
}

/// A point inside the section: midway between its surfaces, where a line across the chord meets them, tried from mid-chord on.
fn inside(section: &Section) -> Option<Point> {
    let chord = section.tail - section.nose;
    let across = Vec2::new(-chord.y, chord.x);
    [0.5, 0.4, 0.3, 0.25, 0.2, 0.6, 0.1, 0.05].into_iter().find_map(|part| {
        let at = section.nose + part * chord;
        let meet = |c: &Curve| c.line_crossings(at, across, 0.0, 1.0).iter().map(|&t| c.point(t)).collect::<Vec<_>>();
        match (&meet(&section.upper)[..], &meet(&section.lower)[..]) {
            (&[above], &[below]) if above != below => Some(above.midpoint(below)),
            _ => None,
        }
    })
}

fn add_far_field(
    sections: &[Section],
    center: Point,
    radius: f64,
    chord: f64,
    drawing: &mut Drawing,
) -> Result<(), ImportError> {
    let bounds = drawing.bounds().unwrap_or(Rect::ZERO);
    let corners = [(bounds.x0, bounds.y0), (bounds.x0, bounds.y1), (bounds.x1, bounds.y0), (bounds.x1, bounds.y1)];
    let reach = corners.into_iter().map(|c| (Point::from(c) - center).hypot()).fold(0.0, f64::max);
    if reach >= radius {
        let what = format!("a far field of {} chords does not go around the section", radius / chord);
        return Err(ImportError::new(what, "give 1 chord or more, or 0 for the section itself"));
    }
    let circle = Curve::circle(center, radius).map_err(|e| ImportError::new(e.to_string(), HELP))?;
    drawing.add(circle, "farfield", "far field");
    // Between the top of the section's box and the top of the circle.
    let at = Point::new(center.x, 0.5 * (bounds.y1 + center.y + radius));
    let name = drawing.names.intern("fluid");
    drawing.seeds.push(Seed { at, kind: SeedKind::Region { name, max_area: None }, entity: "fluid".into() });
    for s in sections {
        let along = SizeRequest::Near { from: s.nose, to: s.tail, edge: 0.015 * s.chord, grade: 0.15 };
        drawing.sizes.push(along);
    }
    let wake = sections.iter().map(|s| s.tail).reduce(|a, b| if b.x > a.x { b } else { a }).unwrap_or(center);
    let length = (2.5 * chord).min(0.9 * (center.x + radius - wake.x));
    let end = wake + Vec2::new(length, 0.0);
    drawing.sizes.push(SizeRequest::Near { from: wake, to: end, edge: 0.05 * chord, grade: 0.15 });
    let name = drawing.names.intern("farfield");
    drawing.sizes.push(SizeRequest::Boundary { name, edge: (2.5 * chord).min(0.5 * radius) });
    Ok(())
}
