//! Texts: what they say without the codes of their format, and where they stand. Glyphs have no outlines here; a text
//! may name a region.

use super::figure::{Figure, NO_OUTLINE, Refusal};
use super::sections::Record;
use crate::geometry::Point;

/// Longer texts are notes, and no names.
const LONGEST: usize = 64;

/// The codes of a special character after `%%`.
const SPECIAL: [(char, &str); 3] = [('c', "Ø"), ('d', "°"), ('p', "±")];

/// A TEXT or MTEXT; not decoded yet, nor rid of its codes.
pub(super) fn text(record: &Record) -> Result<Figure<'static>, Refusal> {
    let aligned = record.kind == "TEXT" && (record.integer(72, 0)? != 0 || record.integer(73, 0)? != 0);
    let anchor = if aligned { record.optional_point(11)? } else { None };
    let anchor = if anchor.is_some() { anchor } else { record.optional_point(10)? };
    // A text draws nothing: one without a place is no reason to refuse a drawing.
    let [x, y, _] = anchor.ok_or(Refusal::Skip(NO_OUTLINE))?;
    let parts = record.pairs.iter().filter(|pair| pair.code == 3 || pair.code == 1).map(|pair| pair.text());
    Ok(Figure::Text { at: Point::new(x, y), bytes: parts.collect::<Vec<_>>().concat() })
}

/// What a text says, in one line; `None` of what is no name: an empty text, a long one, or one without a letter, as a
/// dimension has.
pub(super) fn name(text: &str) -> Option<String> {
    let plain = plain(text).split_whitespace().collect::<Vec<_>>().join(" ");
    // A diameter is written with a letter that is none here.
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
                // A line, a column, or a space that does not break.
                Some('P' | 'N' | 'X' | '~') => plain.push(' '),
                // Under, over and through lines, on and off.
                Some('L' | 'l' | 'O' | 'o' | 'K' | 'k') | None => {}
                Some('S') => {
                    plain.extend(rest.by_ref().take_while(|&c| c != ';').map(|c| if c == '^' { '/' } else { c }))
                }
                // A height, a font, a colour, …: up to the semicolon.
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
