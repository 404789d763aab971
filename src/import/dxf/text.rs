//! Texts: their content without format codes, and their place. Glyphs have no outlines. A text may name a region.

use super::figure::{Figure, NO_OUTLINE, Refusal};
use super::sections::Record;
use crate::geometry::Point;

/// A longer text is a note, not a name.
const LONGEST: usize = 64;

/// The codes of a special character after `%%`.
const SPECIAL: [(char, &str); 3] = [('c', "Ø"), ('d', "°"), ('p', "±")];

/// A TEXT or MTEXT, not decoded yet.
pub(super) fn text(record: &Record) -> Result<Figure<'static>, Refusal> {
    let aligned = record.kind == "TEXT" && (record.integer(72, 0)? != 0 || record.integer(73, 0)? != 0);
    let anchor = if aligned { record.optional_point(11)? } else { None };
    let anchor = if anchor.is_some() { anchor } else { record.optional_point(10)? };
    // A text draws nothing, so a text without a place is not an error.
    let [x, y, _] = anchor.ok_or(Refusal::Skip(NO_OUTLINE))?;
    let parts = record.pairs.iter().filter(|pair| pair.code == 3 || pair.code == 1).map(|pair| pair.text());
    Ok(Figure::Text { at: Point::new(x, y), bytes: parts.collect::<Vec<_>>().concat() })
}

/// The content of a text in one line; `None` where it is not a name: empty, long, or without a letter, as in a
/// dimension.
pub(super) fn name(text: &str) -> Option<String> {
    let plain = plain(text).split_whitespace().collect::<Vec<_>>().join(" ");
    // The sign for a diameter is a letter of Unicode, but does not make a name.
    let is_name = plain.chars().any(|c| c.is_alphabetic() && c != 'Ø') && plain.chars().count() <= LONGEST;
    is_name.then_some(plain)
}

/// A text without the codes of MTEXT (`{\fArial;…}`, `\P`, `\H2.5x;`) and TEXT (`%%u`).
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        match c {
            '{' | '}' => {}
            '\\' => match rest.next() {
                Some(escaped @ ('\\' | '{' | '}')) => plain.push(escaped),
                // A line break, a column break, or a non-breaking space.
                Some('P' | 'N' | 'X' | '~') => plain.push(' '),
                // Underline, overline and strike-through, on and off.
                Some('L' | 'l' | 'O' | 'o' | 'K' | 'k') | None => {}
                Some('S') => {
                    plain.extend(rest.by_ref().take_while(|&c| c != ';').map(|c| if c == '^' { '/' } else { c }))
                }
                // A height, a font, a colour and so on, up to the semicolon.
                Some(_) => rest.by_ref().take_while(|&c| c != ';').for_each(drop),
            },
            '%' if rest.as_str().starts_with('%') => {
                rest.next();
                let code = rest.next().map(|c| c.to_ascii_lowercase());
                plain.push_str(SPECIAL.iter().find(|(c, _)| Some(*c) == code).map_or("", |(_, text)| text));
            }
            '\t' | '\n' | '\r' => plain.push(' '),
            c => plain.push(c),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_no_part_of_a_name() {
        for (text, said) in [
            ("STEEL", "STEEL"),
            ("{\\fArial|b0|i0;\\H2.5x;ROOM\\P12}", "ROOM 12"),
            ("%%uCore%%u", "Core"),
            ("Rod %%c12", "Rod Ø12"),
            ("a\\{b\\}\\\\c", "a{b}\\c"),
            ("\\LUnder\\l line", "Under line"),
        ] {
            assert_eq!(name(text).as_deref(), Some(said), "{text}");
        }
        for none in ["", " \\P ", "12.5", "%%c12", "{\\H3;}", &"long ".repeat(20)] {
            assert_eq!(name(none), None, "{none}");
        }
    }
}
