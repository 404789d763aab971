//! Classifies the lines of a coordinate file.

use crate::geometry::Point;
use crate::geometry::written::number;
use std::borrow::Cow;

/// The text of a file, with a note where it is not UTF-8.
pub fn decode<'a>(bytes: &'a [u8], notes: &mut Vec<String>) -> Cow<'a, str> {
    match std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => {
            notes.push("The text is not UTF-8 and was read as Latin-1.".into());
            Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect())
        }
    }
}

/// A text with each run of blanks and tabs as one blank.
pub fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Lines ended by LF, CR LF or CR.
pub fn lines(text: &str) -> Vec<&str> {
    if text.contains('\n') { text.lines().collect() } else { text.split('\r').collect() }
}

/// Number of columns that are read: an index and two pairs.
pub const COLUMNS: usize = 5;

/// The first numbers of a line, and how many there are.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Numbers {
    /// The first numbers.
    pub first: [f64; COLUMNS],
    /// Number of numbers in the line.
    pub count: usize,
}

/// The kind of a line.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Row {
    Blank,
    /// Two numbers or more. `words`: text follows them.
    Point {
        numbers: Numbers,
        words: bool,
    },
    /// A number, then other text.
    Half,
    /// Words that programs write for a missing number: `nan`, `inf`, `****`.
    Lost,
    /// A number and dots. Some tables print dots in place of an ordinate.
    Dotted,
    Comment,
    Text,
}

/// Unusual forms of numbers that a file has.
#[derive(Default)]
pub struct Dress {
    decimal_commas: bool,
    run_together: bool,
    minus_signs: bool,
}

impl Dress {
    /// Notes these forms.
    pub fn tell(&self, notes: &mut Vec<String>) {
        let said = [
            (self.decimal_commas, "Commas were read as decimal points."),
            (self.run_together, "Columns that run together were cut before their signs."),
            (self.minus_signs, "Typographic minus signs and dashes were read as minus."),
        ];
        notes.extend(said.into_iter().filter(|(met, _)| *met).map(|(_, note)| note.to_owned()));
    }
}

impl Row {
    /// Classifies a line.
    pub fn of(line: &str, dress: &mut Dress) -> Self {
        // Minus sign, en dash, and the non-breaking hyphens.
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

    /// The numbers of a line of coordinates.
    pub fn numbers(self) -> Option<Numbers> {
        match self {
            Self::Point { numbers, words: false } => Some(numbers),
            Self::Point { .. } | Self::Blank | Self::Half | Self::Lost | Self::Dotted | Self::Comment | Self::Text => {
                None
            }
        }
    }

    /// The first two numbers of a line of coordinates.
    pub fn point(self) -> Option<Point> {
        self.numbers().map(|n| Point::new(n.first[0], n.first[1]))
    }
}

/// The fields of a line that were read so far.
#[derive(Default)]
struct Taken {
    first: [f64; COLUMNS],
    count: usize,
    /// Number of words for missing numbers among the first two fields.
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

/// The numbers of columns that run together: `0.500000-0.041000`. Fortran writes a point in each number.
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

/// Whether a word is one that C, Fortran or spreadsheets write for a missing number.
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

/// Whether the commas of a line are decimal points: there are two fields or more, no point, and a comma between digits.
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
