//! Text: lines with their numbers, and how many digits the numbers of a file have.

use crate::geometry::written::{number, tokens};
use crate::import::ImportError;
use crate::solid::Digits;

/// Lines that hold something, with their numbers; comments (`#` to the end of the line) are cut off.
pub(super) struct Rows<'a> {
    rest: &'a [u8],
    /// The line read last, from 1.
    pub line: usize,
    /// Where the format is explained, for errors.
    help: &'static str,
}

/// A line that holds something.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    /// Its text, without comment.
    pub text: &'a [u8],
    /// Its number, from 1.
    pub line: usize,
    help: &'static str,
}

impl<'a> Rows<'a> {
    pub(super) fn new(bytes: &'a [u8], help: &'static str) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), line: 0, help }
    }

    /// How many bytes are left.
    pub(super) fn left(&self) -> usize {
        self.rest.len()
    }

    /// The first row.
    pub(super) fn header(&mut self) -> Result<Row<'a>, ImportError> {
        self.next().ok_or_else(|| ImportError::at(self.line.max(1), "the file is empty", self.help))
    }

    /// Row `i` of `count` that `header` promises.
    pub(super) fn expect(&mut self, header: Row, what: &str, i: usize, count: usize) -> Result<Row<'a>, ImportError> {
        self.next().ok_or_else(|| {
            let promised = format!("line {} promises {count} {what}, but the file ends after {i}", header.line);
            ImportError::at(self.line, promised, "the file may be cut off; mend the count or add the missing lines")
        })
    }
}

impl<'a> Iterator for Rows<'a> {
    type Item = Row<'a>;

    fn next(&mut self) -> Option<Row<'a>> {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(self.rest.len());
            let (text, after) = self.rest.split_at(end);
            let newline = if after.starts_with(b"\r\n") { 2 } else { after.len().min(1) };
            self.rest = &after[newline..];
            self.line += 1;
            let text = text.split(|&b| b == b'#').next().unwrap_or_default();
            if text.iter().any(|b| !b.is_ascii_whitespace()) {
                return Some(Row { text, line: self.line, help: self.help });
            }
        }
        None
    }
}

impl<'a> Row<'a> {
    /// The first `N` numbers of the row, and the tokens after them.
    pub(super) fn take<const N: usize>(
        self,
        what: &str,
    ) -> Result<([f64; N], impl Iterator<Item = &'a [u8]> + use<'a, N>), ImportError> {
        let mut values = [0.0; N];
        let mut rest = tokens(self.text);
        for (i, value) in values.iter_mut().enumerate() {
            let token = rest.next().ok_or_else(|| self.error(format!("{what} needs {N} numbers, but has {i}")))?;
            *value = self.number(token, i, what)?;
        }
        Ok((values, rest))
    }

    /// The token as a finite number; it is item `i` of `what`.
    pub(super) fn number(self, token: &[u8], i: usize, what: &str) -> Result<f64, ImportError> {
        number(token).ok_or_else(|| self.error(format!("{what}: item {} is not a finite number", i + 1)))
    }

    /// The value as a count.
    pub(super) fn count(self, value: f64, what: &str) -> Result<usize, ImportError> {
        // No file that fits in memory holds 2^32 rows, and ids have 32 bits.
        if value >= 0.0 && value < f64::from(u32::MAX) && value == value.trunc() {
            Ok(value as usize)
        } else {
            Err(self.error(format!("{value} is no count of {what}")))
        }
    }

    /// What is wrong with this line.
    pub(super) fn error(self, what: impl Into<String>) -> ImportError {
        ImportError::at(self.line, what, self.help)
    }
}

/// The value as an integer, where it is one that f64 holds exactly.
pub(super) fn whole(value: f64) -> Option<i64> {
    (value == value.trunc() && value.abs() < 9_007_199_254_740_992.0).then_some(value as i64)
}

/// A double as text has 15 digits and more; what has fewer was rounded on the way.
const DIGITS_OF_DOUBLE: usize = 15;

/// From as many digits on, the format may be one of a fixed number of significant digits, as `%g` is; shorter numbers
/// were written by hand and mean what they say.
const DIGITS_OF_FLOAT: usize = 6;

/// How exactly the numbers of a text are written.
#[derive(Default)]
pub(super) struct Written {
    /// The most significant digits that a number has.
    digits: usize,
    /// The power of ten of the finest decimal.
    finest: i32,
    /// The largest number.
    largest: f64,
}

impl Written {
    /// Takes note of a coordinate as it is written.
    pub(super) fn note(&mut self, token: &[u8], value: f64) {
        self.largest = self.largest.max(value.abs());
        let (mut decimals, mut digits, mut trailing, mut point) = (0, 0, 0, false);
        let mut parts = token.split(|b| matches!(b, b'e' | b'E' | b'd' | b'D'));
        for &b in parts.next().unwrap_or_default() {
            match b {
                b'.' => point = true,
                b'0'..=b'9' => {
                    decimals += i32::from(point);
                    digits += usize::from(digits > 0 || b != b'0');
                    trailing = if b == b'0' && !point { trailing + 1 } else { 0 };
                }
                _ => {}
            }
        }
        let exponent = parts.next().and_then(number).and_then(whole).unwrap_or(0).clamp(-400, 400) as i32;
        self.digits = self.digits.max(digits.saturating_sub(trailing));
        // A number written whole, or as a zero, says nothing of decimals.
        if digits > 0 && (value != value.trunc() || decimals > exponent) {
            self.finest = self.finest.min(exponent - decimals);
        }
    }

    /// What was found.
    pub(super) fn digits(&self) -> Digits {
        if self.digits >= DIGITS_OF_DOUBLE {
            return Digits::Double;
        }
        if self.finest >= 0 || self.largest == 0.0 {
            return Digits::Text(0.0);
        }
        // Of a number with a limited count of digits, the large numbers end earlier than the small ones.
        let leading = libm::floor(libm::log10(self.largest)) as i32;
        let of_largest = leading + 1 - self.digits as i32;
        let unit = if self.digits >= DIGITS_OF_FLOAT { self.finest.max(of_largest) } else { self.finest };
        Digits::Text(libm::pow(10.0, f64::from(unit)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits(text: &str) -> Digits {
        let mut written = Written::default();
        for token in text.split(' ') {
            written.note(token.as_bytes(), number(token.as_bytes()).unwrap());
        }
        written.digits()
    }

    #[test]
    fn the_last_decimal_is_that_of_the_largest_number() {
        assert_eq!(digits("0 4 -100"), Digits::Text(0.0));
        assert_eq!(digits("0.5 1.25"), Digits::Text(0.01));
        assert_eq!(digits("0.5 100"), Digits::Text(0.1));
        assert_eq!(digits("0.162273 -0.5 -1.40397e-007"), Digits::Text(1e-6));
        assert_eq!(digits("12.500000 0.000001"), Digits::Text(1e-6));
        assert_eq!(digits("0.1 0.30000000000000004"), Digits::Double);
    }
}
