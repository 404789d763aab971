//! The group codes and values of a DXF file, text or binary.

use crate::import::{ImportError, number};
use std::fmt;

/// The first bytes of a binary file. Some files were sent as text and have lost the CR.
const SENTINELS: [&[u8]; 2] = [b"AutoCAD Binary DXF\r\n\x1a\0", b"AutoCAD Binary DXF\n\x1a\0"];
const DAMAGED: &str = "the file is damaged here, or is not a DXF file: export it again";

/// A place in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Of a text file, from 1.
    Line(usize),
    /// Of a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

impl Place {
    /// An error at this place.
    pub fn error(self, what: impl fmt::Display, help: &str) -> ImportError {
        match self {
            Self::Line(line) => ImportError::at(line, what.to_string(), help),
            Self::Byte(byte) => ImportError::new(format!("byte {byte}: {what}"), help),
        }
    }
}

/// The value of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value<'a> {
    Text(&'a [u8]),
    Real(f64),
    Integer(i64),
}

/// A group code with its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair<'a> {
    /// The group code.
    pub code: i32,
    /// The value.
    pub value: Value<'a>,
    /// The place of the value in a text file, of the code in a binary one.
    pub place: Place,
}

impl<'a> Pair<'a> {
    /// The value as text without the blanks around it; empty for a number of a binary file.
    pub fn text(&self) -> &'a [u8] {
        match self.value {
            Value::Text(text) => text.trim_ascii(),
            Value::Real(_) | Value::Integer(_) => b"",
        }
    }

    /// Whether this is group 0 with the given word.
    pub fn starts(&self, word: &str) -> bool {
        self.code == 0 && self.text().eq_ignore_ascii_case(word.as_bytes())
    }

    /// The value as a finite number.
    pub fn real(&self) -> Option<f64> {
        match self.value {
            Value::Text(text) => number(text.trim_ascii()),
            Value::Real(real) => Some(real).filter(|r| r.is_finite()),
            Value::Integer(integer) => Some(integer as f64),
        }
    }

    /// The unit of the last decimal of a text: 0.001 for `80.000`. It is 0 for whole numbers and for numbers of a
    /// binary file. A single zero after the point does not count, because some writers always add one.
    pub fn last_decimal(&self) -> f64 {
        let Value::Text(text) = self.value else { return 0.0 };
        let text = text.trim_ascii();
        let end = text.iter().position(|b| matches!(b, b'e' | b'E' | b'd' | b'D'));
        let (digits, exponent) = text.split_at(end.unwrap_or(text.len()));
        let decimals = digits.iter().position(|&b| b == b'.').map_or(&[][..], |point| &digits[point + 1..]);
        if matches!(decimals, [] | [b'0']) {
            return 0.0;
        }
        let exponent = exponent.get(1..).and_then(number).unwrap_or(0.0);
        let places = decimals.len() as f64 - exponent;
        if places > 0.0 { libm::pow(10.0, -places) } else { 0.0 }
    }

    /// The value as a whole number.
    pub fn integer(&self) -> Option<i64> {
        match self.value {
            Value::Integer(integer) => Some(integer),
            // Some writers add a point to whole numbers.
            _ => self.real().filter(|r| *r == r.trunc() && r.abs() < 9e15).map(|r| r as i64),
        }
    }
}

impl fmt::Display for Pair<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.value {
            Value::Text(text) => write!(f, "\"{}\"", shown(text.trim_ascii())),
            Value::Real(real) => write!(f, "{real}"),
            Value::Integer(integer) => write!(f, "{integer}"),
        }
    }
}

/// A text of the file, cut to the length of a message.
pub(super) fn shown(text: &[u8]) -> String {
    const MOST: usize = 40;
    let text = String::from_utf8_lossy(&text[..text.len().min(4 * MOST)]);
    let mut short: String = text.chars().take(MOST).map(|c| if c.is_control() { '·' } else { c }).collect();
    if text.chars().count() > MOST {
        short.push('…');
    }
    short
}

/// Whether these are the first bytes of a DXF file: the binary sentinel, or a section after comments.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    /// No file begins with more comments.
    const COMMENTS: usize = 1000;
    let Ok(mut pairs) = Pairs::new(bytes) else { return false };
    if pairs.is_binary() {
        return true;
    }
    for _ in 0..COMMENTS {
        match pairs.next() {
            Ok(Some(pair)) if pair.code == 999 => {}
            Ok(Some(pair)) => return pair.starts("SECTION"),
            _ => return false,
        }
    }
    false
}

/// The pairs of a file, in order.
pub(super) struct Pairs<'a> {
    rest: &'a [u8],
    form: Form,
}

enum Form {
    /// Lines end with this byte. `line` lines were read.
    Text { newline: u8, line: usize },
    /// Codes have one byte (up to R12) or two. `read` bytes were read.
    Binary { wide: bool, read: usize },
}

impl<'a> Pairs<'a> {
    /// The pairs of a file.
    pub fn new(bytes: &'a [u8]) -> Result<Self, ImportError> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if text.trim_ascii().is_empty() {
            return Err(ImportError::new("the file is empty", "export it again"));
        }
        for sentinel in SENTINELS {
            if let Some(rest) = bytes.strip_prefix(sentinel) {
                // The first group is 0 SECTION, or 999, a comment. Only with codes of two bytes the second byte is 0 or
                // 3.
                let wide = rest.len() > 1 && (rest[1] == 0 || rest[..2] == 999u16.to_le_bytes());
                return Ok(Self { rest, form: Form::Binary { wide, read: sentinel.len() } });
            }
        }
        let newline = if text.contains(&b'\n') { b'\n' } else { b'\r' };
        let blank = text.len() - text.trim_ascii_start().len();
        let (skipped, rest) = text.split_at(text[..blank].iter().rposition(|&b| b == newline).map_or(0, |i| i + 1));
        let line = skipped.iter().filter(|&&b| b == newline).count();
        Ok(Self { rest, form: Form::Text { newline, line } })
    }

    /// Whether the file is binary.
    pub fn is_binary(&self) -> bool {
        matches!(self.form, Form::Binary { .. })
    }

    /// The place of the next pair.
    pub fn place(&self) -> Place {
        match self.form {
            Form::Text { line, .. } => Place::Line(line + 1),
            Form::Binary { read, .. } => Place::Byte(read),
        }
    }

    /// The next pair; `None` at the end of the file, also if that is within a pair.
    pub fn next(&mut self) -> Result<Option<Pair<'a>>, ImportError> {
        match self.form {
            Form::Text { .. } => self.next_text(),
            Form::Binary { wide, .. } => self.next_binary(wide),
        }
    }

    fn next_text(&mut self) -> Result<Option<Pair<'a>>, ImportError> {
        if self.rest.iter().all(u8::is_ascii_whitespace) {
            return Ok(None);
        }
        let code_place = self.place();
        let Some(code) = self.line() else { return Ok(None) };
        let place = self.place();
        let code = std::str::from_utf8(code.trim_ascii()).ok().and_then(|t| t.parse().ok()).ok_or_else(|| {
            code_place.error(format!("expected a group code, a whole number, found \"{}\"", shown(code)), DAMAGED)
        })?;
        Ok(self.line().map(|text| Pair { code, value: Value::Text(text), place }))
    }

    /// The next line, without its end.
    fn line(&mut self) -> Option<&'a [u8]> {
        let Form::Text { newline, line } = &mut self.form else { return None };
        if self.rest.is_empty() {
            return None;
        }
        *line += 1;
        let end = self.rest.iter().position(|b| b == newline);
        let text = &self.rest[..end.unwrap_or(self.rest.len())];
        self.rest = end.map_or(&[], |end| &self.rest[end + 1..]);
        Some(text)
    }

    fn next_binary(&mut self, wide: bool) -> Result<Option<Pair<'a>>, ImportError> {
        let place = self.place();
        let Some(code) = self.code(wide) else { return Ok(None) };
        let value = match Kind::of(code) {
            Some(Kind::Text) => self.rest.iter().position(|&b| b == 0).and_then(|n| {
                let text = self.bytes(n)?;
                self.bytes(1)?;
                Some(Value::Text(text))
            }),
            Some(Kind::Chunk) => self.array::<1>().and_then(|[n]| self.bytes(n.into())).map(|_| Value::Text(b"")),
            Some(Kind::Real) => self.array().map(|b| Value::Real(f64::from_le_bytes(b))),
            Some(Kind::Integer8) => self.array().map(|b| Value::Integer(i8::from_le_bytes(b).into())),
            Some(Kind::Integer16) => self.array().map(|b| Value::Integer(i16::from_le_bytes(b).into())),
            Some(Kind::Integer32) => self.array().map(|b| Value::Integer(i32::from_le_bytes(b).into())),
            Some(Kind::Integer64) => self.array().map(|b| Value::Integer(i64::from_le_bytes(b))),
            None => return Err(place.error(format!("{code} is not a group code"), DAMAGED)),
        };
        Ok(value.map(|value| Pair { code, value, place }))
    }

    fn code(&mut self, wide: bool) -> Option<i32> {
        if wide {
            return self.array().map(|b| i16::from_le_bytes(b).into());
        }
        match self.array::<1>()? {
            // The extended data of R12, from 1000 on.
            [255] => self.array().map(|b| i16::from_le_bytes(b).into()),
            [code] => Some(code.into()),
        }
    }

    fn bytes(&mut self, n: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(n)?;
        self.rest = rest;
        if let Form::Binary { read, .. } = &mut self.form {
            *read += n;
        }
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.bytes(N)?.try_into().ok()
    }
}

/// How a binary file stores the value of a group.
enum Kind {
    /// Ends with a zero byte.
    Text,
    /// Length in a byte, then as many bytes.
    Chunk,
    Real,
    Integer8,
    Integer16,
    Integer32,
    Integer64,
}

impl Kind {
    /// The table "Group code value types" of the DXF reference.
    fn of(code: i32) -> Option<Self> {
        Some(match code {
            0..=9 | 100..=105 | 300..=309 | 320..=369 | 390..=399 | 410..=419 | 430..=439 | 470..=481 | 999 => {
                Self::Text
            }
            1000..=1003 | 1005..=1009 => Self::Text,
            310..=319 | 1004 => Self::Chunk,
            10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => Self::Real,
            290..=299 => Self::Integer8,
            60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => Self::Integer16,
            90..=99 | 420..=429 | 440..=459 | 1071 => Self::Integer32,
            160..=169 => Self::Integer64,
            _ => return None,
        })
    }
}
