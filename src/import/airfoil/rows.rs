//! Lines of a coordinate file → elements of points: what a line is, which of its columns are coordinates, and which lines are none.

use super::super::{ImportError, number};
use super::{HELP, SAME};
use crate::geometry::{Point, Vec2, bounds_of};
use std::borrow::Cow;

/// A coordinate pair and where it stood.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub at: Point,
    pub line: usize,
    /// The line of text that stands before it, where that is no comment.
    pub text_before: Option<usize>,
    /// A blank or text line stands before it.
    pub gap_before: bool,
}

/// The file as a title and elements of points.
pub(super) struct Table {
    pub title: Option<String>,
    /// Lednicer's counts of the two surfaces, where they fit the points.
    pub counts: Option<[usize; 2]>,
    pub elements: Vec<Vec<Sample>>,
}

impl Table {
    pub fn scan(bytes: &[u8], notes: &mut Vec<String>) -> Result<Self, ImportError> {
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
        let title =
            title.zip(&rows).find(|(l, row)| !l.is_empty() && row.numbers().is_none()).map(|(l, _)| one_line(l));
        if start == 0 {
            notes.push("There is no name line.".into());
        }
        Ok(Self { title, counts, elements })
    }
}

fn decode<'a>(bytes: &'a [u8], notes: &mut Vec<String>) -> Cow<'a, str> {
    match std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => {
            notes.push("The text is not UTF-8 and was read as Latin-1.".into());
            Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect())
        }
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

// ---- a line ----

/// Numbers of a line that are looked at: an index and two pairs.
const COLUMNS: usize = 5;

/// The first numbers of a line, and how many there are.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Numbers {
    first: [f64; COLUMNS],
    count: usize,
}

/// What a line of the file is.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Row {
    Blank,
    /// Two numbers or more, and whether words follow them.
    Point {
        numbers: Numbers,
        words: bool,
    },
    /// A number, then something else.
    Half,
    /// Words that programs write where a number is missing, for one number or more: `nan`, `inf`, `****`.
    Lost,
    /// A number and dots: tables that leave an ordinate out print them in its place.
    Dotted,
    Comment,
    Text,
}

/// How numbers are written that no computer writes by itself, where a file has any such.
#[derive(Default)]
struct Dress {
    decimal_commas: bool,
    run_together: bool,
    minus_signs: bool,
}

impl Dress {
    fn tell(&self, notes: &mut Vec<String>) {
        let said = [
            (self.decimal_commas, "Commas were read as decimal points."),
            (self.run_together, "Columns that run together were cut before their signs."),
            (self.minus_signs, "Typographic minus signs and dashes were read as minus."),
        ];
        notes.extend(said.into_iter().filter(|(met, _)| *met).map(|(_, note)| note.to_owned()));
    }
}

impl Row {
    fn of(line: &str, dress: &mut Dress) -> Self {
        // Minus sign, en dash, and the hyphens that do not break.
        const MINUS: [char; 4] = ['\u{2212}', '\u{2013}', '\u{2010}', '\u{2011}'];
        let minus = line.contains(MINUS);
        let line = if minus { Cow::Owned(line.replace(MINUS, "-")) } else { Cow::Borrowed(line) };
        // Tables put computed ordinates in parentheses.
        let plain = |field| str::trim_matches(field, ['(', ')']);
        let is_blank = |c: char| c.is_whitespace() || c == ';';
        let fields = line.split(is_blank).map(plain).filter(|f| !f.is_empty());
        let Some(first) = fields.clone().next() else { return Self::Blank };
        if ["#", "!", "%", "//"].iter().any(|mark| first.starts_with(mark)) && !is_lost(first) {
            return Self::Comment;
        }
        let is_dotted = fields.clone().nth(1).is_some_and(|f| f.len() > 1 && f.bytes().all(|b| b == b'.'));
        let decimal = is_decimal_comma(fields.clone());
        let mut taken = Taken::default();
        if decimal {
            fields.for_each(|f| taken.field(&f.replace(',', ".")));
        } else {
            fields.flat_map(|f| f.split(',')).filter(|f| !f.is_empty()).for_each(|f| taken.field(f));
        }
        let row = taken.row();
        if let Self::Point { .. } = row {
            dress.decimal_commas |= decimal;
            dress.run_together |= taken.run_together;
            dress.minus_signs |= minus;
        }
        if is_dotted && row == Self::Half { Self::Dotted } else { row }
    }

    fn numbers(self) -> Option<Numbers> {
        match self {
            Self::Point { numbers, words: false } => Some(numbers),
            Self::Point { .. } | Self::Blank | Self::Half | Self::Lost | Self::Dotted | Self::Comment | Self::Text => {
                None
            }
        }
    }

    fn point(self) -> Option<Point> {
        self.numbers().map(|n| Point::new(n.first[0], n.first[1]))
    }
}

/// The fields of a line as far as they were read.
#[derive(Default)]
struct Taken {
    first: [f64; COLUMNS],
    count: usize,
    /// Of the first two fields those that stand for a missing number.
    lost: usize,
    words: bool,
    run_together: bool,
}

impl Taken {
    fn field(&mut self, field: &str) {
        if let Some(value) = number(field.as_bytes()).filter(|_| !self.words) {
            self.number(value);
        } else if let Some(values) = apart(field).filter(|_| !self.words) {
            self.run_together = true;
            values.into_iter().for_each(|value| self.number(value));
        } else if self.count + self.lost < 2 && is_lost(field) {
            self.lost += 1;
        } else {
            self.words = true;
        }
    }

    fn number(&mut self, value: f64) {
        if let Some(slot) = self.first.get_mut(self.count) {
            *slot = value;
        }
        self.count += 1;
    }

    fn row(&self) -> Row {
        match (self.lost, self.count) {
            (1.., _) if self.lost + self.count >= 2 && !self.words => Row::Lost,
            (0, 2..) => Row::Point { numbers: Numbers { first: self.first, count: self.count }, words: self.words },
            (_, 1..) => Row::Half,
            (_, 0) => Row::Text,
        }
    }
}

/// The numbers of columns that run together: `0.500000-0.041000`. Fortran writes a point in each.
fn apart(field: &str) -> Option<Vec<f64>> {
    let bytes = field.as_bytes();
    let is_cut = |&i: &usize| matches!(bytes[i], b'-' | b'+') && matches!(bytes[i - 1], b'0'..=b'9' | b'.');
    let mut from = 0;
    let mut values = Vec::new();
    for to in (1..bytes.len()).filter(is_cut).chain([bytes.len()]) {
        let part = &bytes[from..to];
        values.push(number(part).filter(|_| part.contains(&b'.'))?);
        from = to;
    }
    (values.len() > 1).then_some(values)
}

/// What C, Fortran and spreadsheets write where there is no number.
fn is_lost(field: &str) -> bool {
    let word = field.trim_start_matches(['+', '-']).to_ascii_lowercase();
    let words =
        ["nan", "nanq", "nans", "inf", "infinity", "#n/a", "n/a", "#value!", "#num!", "#div/0!", "null", "none"];
    let is_number_too_large = || word.starts_with(|c: char| c.is_ascii_digit()) && word.parse::<f64>().is_ok();
    words.contains(&word.as_str())
        || word.starts_with("nan(")
        || word.starts_with("1.#")
        || word.len() > 2 && word.bytes().all(|b| b == b'*')
        || is_number_too_large()
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

// ---- where the coordinates are ----

/// Whether there are two neighbouring lines of numbers.
pub(super) fn has_coordinates(bytes: &[u8]) -> bool {
    let text = decode(bytes, &mut Vec::new());
    let rows: Vec<Row> = lines(&text).iter().map(|line| Row::of(line, &mut Dress::default())).collect();
    first_data(&rows).is_some()
}

/// The first of two neighbouring lines of numbers.
fn first_data(rows: &[Row]) -> Option<usize> {
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
const MEND: &str = "mend the line, or remove it";

/// A point that is no number may be the first of all, or the first but one.
fn refuse_lost_start(rows: &[Row], start: usize) -> Result<(), ImportError> {
    match rows[..start].iter().rposition(|row| *row == Row::Lost) {
        Some(lost) => Err(ImportError::at(lost + 1, LOST, MEND)),
        None => Ok(()),
    }
}

/// Steps over the four-number line of MSES and XFOIL, over counts and over names of two numbers; gives Lednicer's counts.
fn skip_special(rows: &[Row], mut start: usize, notes: &mut Vec<String>) -> (usize, Option<[usize; 2]>) {
    let mut counts = None;
    // A name of numbers, a box and counts: three such lines at most.
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

/// Two whole numbers that fit the points after them as counts, or that lie far off them.
fn as_counts(numbers: Numbers, after: &[Row]) -> Option<[usize; 2]> {
    let count = |v: f64| (v == v.trunc() && (2.0..1e9).contains(&v)).then_some(v as usize);
    let counts = [count(numbers.first[0])?, count(numbers.first[1])?];
    let points = after.iter().filter_map(|row| row.point()).take_while(|p| !is_separator(*p));
    let (n, widest) = points.fold((0, 0.0_f64), |(n, widest), p| (n + 1, widest.max(p.x.abs())));
    (numbers.count == 2 && (counts[0] + counts[1] == n || numbers.first[0] > 2.0 * widest)).then_some(counts)
}

fn fitting(counts: [usize; 2], elements: &[Vec<Sample>], notes: &mut Vec<String>) -> Option<[usize; 2]> {
    let fits = elements.len() == 1 && counts[0].checked_add(counts[1]) == Some(elements[0].len());
    if !fits {
        notes.push(format!("The counts {} and {} do not fit the points and were passed over.", counts[0], counts[1]));
    }
    fits.then_some(counts)
}

/// `999. 999.`, the line between elements.
fn is_separator(p: Point) -> bool {
    p.x == p.y && (999.0..1000.0).contains(&p.x)
}

/// The numbers of a line of coordinates.
#[derive(Clone, Copy)]
struct Gathered {
    numbers: Numbers,
    line: usize,
    text_before: Option<usize>,
    gap_before: bool,
}

/// The lines of coordinates, element by element.
fn gather(rows: &[Row], start: usize, notes: &mut Vec<String>) -> Result<Vec<Vec<Gathered>>, ImportError> {
    let mut elements: Vec<Vec<Gathered>> = vec![Vec::new()];
    let (mut gap, mut text) = (false, None);
    // Points of the current element before the last line of text.
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

/// "12, 40 and 7 more".
fn few(lines: &[usize]) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<String> = lines.iter().take(SHOWN).map(usize::to_string).collect();
    let more = lines.len().saturating_sub(SHOWN);
    if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
}

/// Fewer than three points behind a line of text make no surface: they are numbers in the text.
fn drop_numbers_in_text(element: &mut Vec<Gathered>, before_text: Option<usize>) {
    if let Some(cut) = before_text.filter(|&cut| cut > 0 && element.len() - cut < 3) {
        element.truncate(cut);
    }
}

/// Numbers among the header that no run of coordinates follows.
fn tell_numbers_before(header: &[Row], notes: &mut Vec<String>) {
    let alone = |i: &usize| header[*i].numbers().is_some_and(|n| n.count == 2);
    let lines: Vec<usize> = (0..header.len()).filter(alone).map(|i| i + 1).collect();
    // A name may be two numbers.
    if lines.iter().any(|&line| line > 1) {
        notes.push(format!("Numbers before the coordinates, passed over: line {}.", few(&lines)));
    }
}

// ---- columns ----

/// Which columns of a table are coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Columns {
    /// Abscissa and ordinate, of a contour or of surface after surface.
    Pair(usize, usize),
    /// One abscissa, with the ordinates of both surfaces.
    Shared { x: usize, upper: usize, lower: usize },
    /// Abscissa and ordinate of either surface side by side.
    Beside { upper: [usize; 2], lower: [usize; 2] },
}

impl Columns {
    fn of(elements: &[Vec<Gathered>], notes: &mut Vec<String>) -> Result<Self, ImportError> {
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

    fn elements(self, gathered: &[Vec<Gathered>]) -> Result<Vec<Vec<Sample>>, ImportError> {
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

/// Two surfaces given side by side, as one after the other.
fn around(rows: &[Gathered], upper: [usize; 2], lower: [usize; 2]) -> Vec<Sample> {
    let plain = |columns: [usize; 2]| {
        rows.iter().map(move |row| Sample { text_before: None, gap_before: false, ..row.sample(columns) })
    };
    let second = plain(lower).enumerate().map(|(i, sample)| Sample { gap_before: i == 0, ..sample });
    plain(upper).chain(second).collect()
}

/// Whether the first column counts from 0 or 1, anew for every surface or element, and the second is an abscissa: of a table with the
/// ordinates of both surfaces the two after the first are alike at its ends.
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

/// Whether the numbers after the first never change which of them is the larger: those of an upper and a lower surface do not.
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

/// Whether two columns cover the same range to a twentieth.
fn spans_alike(a: impl Iterator<Item = f64>, b: impl Iterator<Item = f64>) -> bool {
    let span = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (a, b) = (span(&mut { a }), span(&mut { b }));
    let slack = 0.05 * (a.1 - a.0).max(b.1 - b.0);
    slack > 0.0 && (a.0 - b.0).abs() <= slack && (a.1 - b.1).abs() <= slack
}

/// Ordinates of two surfaces lie on either side of the nose beside it. Of camber and thickness, or of another table, they do not.
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
    let what = "the columns are no ordinates of an upper and a lower surface: both run to the same side of the nose";
    Err(ImportError::at(rows[1].line, what, HELP))
}

// ---- numbers that are no point ----

/// Drops numbers of a header (chord and thickness, a reference point) from the head of the points.
fn skip_numbers_of_header(samples: &mut Vec<Sample>, notes: &mut Vec<String>) {
    // A header of more than two such lines has a word in it.
    for _ in 0..2 {
        if !starts_beside(samples) {
            return;
        }
        let Sample { at, line, .. } = samples.remove(0);
        let place = format!("{} and {} on line {line}", at.x, at.y);
        notes.push(format!("The numbers {place} are no point of the section and were passed over."));
        if let Some(first) = samples.first_mut() {
            (first.gap_before, first.text_before) = (false, None);
        }
    }
}

/// Whether the first point is none: the section is whole without it, and worse with it.
///
/// ```text
///      header ·            p₁ … pₙ close without p₀, or nearly, and p₀ lies inside, or upright beside p₁;
///         \                or p₀ lies far off; or p₀ → p₁ runs against p₁ → p₂ for a twentieth of the width
///   ───────p₁             
///   ───────pₙ
/// ```
fn starts_beside(samples: &[Sample]) -> bool {
    // The fewest points of which the rest is still told to be a section.
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
    // A base runs from the last point to the first, not past either and back.
    let opposite = |a: Vec2, b: Vec2| a.dot(b) < -0.9 * a.hypot() * b.hypot();
    let folds = step.x.abs() <= 1e-3 * step.y.abs()
        && with > 0.02 * wide
        && (opposite(p0 - p1, last - p1) || opposite(p0 - last, p1 - last));
    closes || closes_better || is_far || turns_back || folds
}

// ---- units, elements ----

/// Sections about as wide as 100 are in percent of chord, unless the header speaks of a unit of length.
fn unscale_percent(elements: &mut [Vec<Sample>], header: &[&str], notes: &mut Vec<String>) {
    // The nose of a cambered section, a rotor blade's tab and an end that was cut off lie that far from the ends of the chord.
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

/// Several whole contours with blank or text lines between, but without `999.` lines, are several elements.
fn split_loops(samples: Vec<Sample>, notes: &mut Vec<String>) -> Vec<Vec<Sample>> {
    let parts: Vec<&[Sample]> = samples.chunk_by(|_, b| !b.gap_before).collect();
    if parts.len() < 2 || !parts.iter().all(|part| part.len() >= 5 && is_loop(part)) {
        return vec![samples];
    }
    notes.push(format!("{} contours with blank lines between are as many elements.", parts.len()));
    let first_of = |part: &[Sample]| Sample { text_before: None, gap_before: false, ..part[0] };
    parts.into_iter().map(|part| [&[first_of(part)], &part[1..]].concat()).collect()
}

/// Whether a run of points comes back to where it began, to a quarter of its width: a surface alone does not.
fn is_loop(samples: &[Sample]) -> bool {
    let [first, .., last] = samples else { return false };
    let wide = bounds_of(samples.iter().map(|s| s.at)).map_or(0.0, |b| b.width());
    (first.at.x - last.at.x).abs() < 0.25 * wide
}
