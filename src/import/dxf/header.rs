//! The header: version, unit, and encoding of names.

use super::pairs::{Pair, shown};
use super::sections::Sections;
use crate::domain::Drawing;
use encoding_rs::Encoding;

/// The units of `$INSUNITS`, by number.
const UNITS: [&str; 25] = [
    "", "in", "ft", "mi", "mm", "cm", "m", "km", "uin", "mil", "yd", "angstrom", "nm", "um", "dm", "dam", "hm", "Gm",
    "au", "ly", "parsec", "us-ft", "us-in", "us-yd", "us-mi",
];

/// The header of a file.
pub(super) struct Header {
    /// "AC1015", or "no version".
    pub version: String,
    encoding: &'static Encoding,
    insunits: Option<i64>,
    measurement: Option<i64>,
}

impl Header {
    /// Reads the header.
    pub fn read(file: &Sections) -> Self {
        let text = |name: &str| file.header.get(name.as_bytes()).map(|pair| shown(pair.text()));
        let whole = |name: &str| file.header.get(name.as_bytes()).and_then(Pair::integer);
        Self {
            version: text("$ACADVER").filter(|v| !v.is_empty()).unwrap_or_else(|| "no version".into()),
            encoding: encoding(&text("$DWGCODEPAGE").unwrap_or_default()),
            insunits: whole("$INSUNITS"),
            measurement: whole("$MEASUREMENT"),
        }
    }

    /// A name as text. Files from R2007 on are UTF-8, and so are many older ones, whatever their code page.
    pub fn name(&self, bytes: &[u8]) -> String {
        let text = match std::str::from_utf8(bytes) {
            Ok(text) => text.into(),
            Err(_) => self.encoding.decode_without_bom_handling(bytes).0,
        };
        unescaped(&text)
    }

    /// Sets the unit of the drawing, with a note where the file gives none.
    pub fn tell_unit(&self, drawing: &mut Drawing) {
        let by_number = |n: i64| usize::try_from(n).ok().and_then(|n| UNITS.get(n)).filter(|unit| !unit.is_empty());
        if let Some((n, unit)) = self.insunits.and_then(|n| Some((n, by_number(n)?))) {
            drawing.unit = Some((unit.to_string(), format!("$INSUNITS = {n}")));
            return;
        }
        let (unit, system) = match self.measurement {
            Some(0) => ("in", "imperial"),
            Some(1) => ("mm", "metric"),
            _ => {
                let note = "The file names no unit ($INSUNITS): lengths are in drawing units, most often mm.";
                drawing.notes.push(note.into());
                return;
            }
        };
        let from = format!("$MEASUREMENT = {}, {system}", self.measurement.unwrap_or_default());
        drawing.notes.push(format!("The file names no unit ($INSUNITS); {from}: taken as {unit}."));
        drawing.unit = Some((unit.into(), from));
    }
}

/// The encoding of a code page of `$DWGCODEPAGE`.
fn encoding(code_page: &str) -> &'static Encoding {
    let number: String = code_page.chars().filter(char::is_ascii_digit).collect();
    match number.as_str() {
        "932" => encoding_rs::SHIFT_JIS,
        "936" => encoding_rs::GBK,
        "949" => encoding_rs::EUC_KR,
        "950" => encoding_rs::BIG5,
        "866" => encoding_rs::IBM866,
        number => Encoding::for_label(format!("windows-{number}").as_bytes()).unwrap_or(encoding_rs::WINDOWS_1252),
    }
}

/// `\U+00E4` as ä.
fn unescaped(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find("\\U+") {
        let digits = rest.get(start + 3..start + 7);
        let letter = digits.and_then(|d| u32::from_str_radix(d, 16).ok()).and_then(char::from_u32);
        let end = if letter.is_some() { start + 7 } else { start + 3 };
        plain.push_str(&rest[..start]);
        match letter {
            Some(letter) => plain.push(letter),
            None => plain.push_str("\\U+"),
        }
        rest = &rest[end..];
    }
    plain + rest
}
