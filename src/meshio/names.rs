//! Names of groups that a format allows, and the comments in which our writers keep the original names.

use super::groups::Kind;
use super::text;
use std::collections::{BTreeMap, BTreeSet};

/// Names that a format allows: each made `legal`, cut to `longest` bytes, and made unique, regardless of case, by a
/// number at its end.
pub fn legal_names(names: &[&str], longest: usize, legal: impl Fn(&str) -> String) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let cut = |text: &str, longest: usize| {
        let end = (0..=longest.min(text.len())).rev().find(|&end| text.is_char_boundary(end));
        text[..end.unwrap_or(0)].to_owned()
    };
    let mut unique = |name: &&str| {
        let stem = legal(name);
        let mut candidate = cut(&stem, longest);
        let mut n = 1;
        while !taken.insert(candidate.to_lowercase()) {
            n += 1;
            let suffix = format!("_{n}");
            candidate = cut(&stem, longest - suffix.len()) + &suffix;
        }
        candidate
    };
    names.iter().map(&mut unique).collect()
}

/// A comment with the original of a name that the format does not allow. Our readers restore the name from it.
pub fn name_comment(kind: Kind, legal: &str, name: &str) -> String {
    let one_line: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("name {} {legal} = {one_line}", kind.word())
}

/// An identifier for solvers: ASCII letters, digits, `_` and `-`, a letter first.
pub fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '_' | '-') { c } else { '_' };
    let text: String = name.chars().map(plain).collect();
    if text.starts_with(|c: char| c.is_ascii_alphabetic()) { text } else { format!("S_{text}") }
}

/// A word without blanks or control characters.
pub fn word(name: &str) -> String {
    let text: String = name.chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
    if text.is_empty() { "_".into() } else { text }
}

/// A text as the value of an XML attribute. White space that a parser would replace by blanks is written by number.
pub fn xml_attribute(text: &str) -> String {
    let mut value = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => value.push_str("&amp;"),
            '<' => value.push_str("&lt;"),
            '>' => value.push_str("&gt;"),
            '"' => value.push_str("&quot;"),
            '\t' | '\n' | '\r' => value.push_str(&format!("&#{};", u32::from(c))),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => value.push('\u{fffd}'),
            _ => value.push(c),
        }
    }
    value
}

/// What comments of our writers keep: the original names (see [`name_comment`]), and the unit.
#[derive(Default)]
pub struct Comments {
    regions: BTreeMap<String, String>,
    boundaries: BTreeMap<String, String>,
    /// The unit of the coordinates.
    pub unit: Option<String>,
}

impl Comments {
    /// Reads a comment (without its mark), if it is one of ours.
    pub fn read(&mut self, comment: &[u8]) {
        let comment = text(comment);
        let comment = comment.trim_start();
        if let Some(unit) = comment.strip_prefix("unit ") {
            self.unit = Some(unit.to_owned());
            return;
        }
        let Some((names, rest)) = comment
            .strip_prefix("name region ")
            .map(|rest| (&mut self.regions, rest))
            .or_else(|| comment.strip_prefix("name boundary ").map(|rest| (&mut self.boundaries, rest)))
        else {
            return;
        };
        if let Some((legal, name)) = rest.split_once(" = ").or_else(|| rest.strip_suffix(" =").map(|legal| (legal, "")))
        {
            names.insert(legal.to_ascii_lowercase(), name.to_owned());
        }
    }

    /// The original name of a region.
    pub fn region(&self, legal: &str) -> String {
        self.regions.get(&legal.to_ascii_lowercase()).cloned().unwrap_or_else(|| legal.to_owned())
    }

    /// The original name of a boundary.
    pub fn boundary(&self, legal: &str) -> String {
        self.boundaries.get(&legal.to_ascii_lowercase()).cloned().unwrap_or_else(|| legal.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_made_legal_and_told_apart() {
        let names = legal_names(&["a b", "A_B", "7", "", "straße"], 80, identifier);
        assert_eq!(names, ["a_b", "A_B_2", "S_7", "S_", "stra_e"]);
        assert_eq!(legal_names(&["äää", "äää", "ää"], 4, word), ["ää", "ä_2", "ä_3"]);
        assert_eq!(legal_names(&["", " "], 9, word), ["_", "__2"]);
    }
}
