//! Style sheets (CSS Syntax, Cascade and Media Queries, as far as drawings use them): rules by specificity,
//! `!important`, `@media`.
//!
//! Rules are indexed by what they require of the element itself. Only these are matched in full, and matching has a
//! budget.

use super::super::ImportError;
use super::selector::{self, Key, Matcher, Selector};
use super::style::{Declared, Property, property};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;

/// Largest nesting of at-rules.
const NESTING_MAX: usize = 8;

/// A known property, or a custom one (`--name`).
#[derive(Clone, Copy)]
enum Name<'a> {
    Known(Property),
    Custom(&'a str),
}

struct Declaration<'a> {
    property: Name<'a>,
    value: &'a str,
    important: bool,
}

/// The declarations of a block. Unknown properties are skipped.
fn declarations(block: &str) -> impl Iterator<Item = Declaration<'_>> {
    pieces(block, b';').filter_map(|piece| {
        let (name, value) = piece.split_once(':')?;
        let name = name.trim();
        let custom = || name.starts_with("--").then_some(Name::Custom(name));
        let property = property(name).map(Name::Known).or_else(custom)?;
        let value = value.trim();
        let plain = value.strip_suffix("important").map(str::trim_end).and_then(|v| v.strip_suffix('!'));
        let (value, important) = plain.map_or((value, false), |v| (v.trim_end(), true));
        (!value.is_empty()).then_some(Declaration { property, value, important })
    })
}

/// The pieces of a text between separators outside of strings and brackets.
fn pieces(text: &str, separator: u8) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        let end = find_outside(text, &[separator]);
        rest = end.map(|end| &text[end + 1..]);
        Some(&text[..end.unwrap_or(text.len())])
    })
}

/// The first of some ASCII bytes outside of strings and round brackets.
fn find_outside(text: &str, wanted: &[u8]) -> Option<usize> {
    let (mut quote, mut depth) = (None, 0_usize);
    for (i, b) in text.bytes().enumerate() {
        match (quote, b) {
            (Some(q), _) if q == b => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(b),
            (None, b) if depth == 0 && wanted.contains(&b) => return Some(i),
            (None, b'(') => depth += 1,
            (None, b')') => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    None
}

// ---- sheets ----

/// The text of all `<style>` elements, without comments.
pub(super) fn sheet_text(document: &Document) -> String {
    let mut plain = String::new();
    let sheets = document.descendants().filter(|n| n.is_element() && n.tag_name().name() == "style");
    for sheet in sheets.filter(|n| n.attribute("type").is_none_or(|t| t.trim() == "text/css" || t.is_empty())) {
        for text in sheet.children().filter_map(|n| n.text()) {
            let mut rest = text;
            while let Some(start) = rest.find("/*") {
                plain.push_str(&rest[..start]);
                rest = rest[start + 2..].find("*/").map_or("", |end| &rest[start + 2 + end + 2..]);
            }
            plain.push_str(rest);
        }
        plain.push('\n');
    }
    plain.replace("<!--", " ").replace("-->", " ")
}

/// The rules of a style sheet, in the order in which they win: the last wins.
pub(super) struct Sheet<'a> {
    rules: Vec<(Selector<'a>, usize)>,
    by_key: BTreeMap<Key<'a>, Vec<usize>>,
    blocks: Vec<Vec<Declaration<'a>>>,
    /// Number of selectors and at-rules that are not read.
    pub unread: usize,
    matcher: Matcher,
}

impl<'a> Sheet<'a> {
    /// Reads the rules of a sheet.
    pub fn parse(text: &'a str, document: &Document) -> Self {
        let (rules, blocks, by_key) = (Vec::new(), Vec::new(), BTreeMap::new());
        let mut sheet = Self { rules, by_key, blocks, unread: 0, matcher: Matcher::default() };
        sheet.add(text, 0);
        sheet.rules.sort_by_key(|(selector, _)| selector.specificity);
        for (k, (selector, _)) in sheet.rules.iter().enumerate() {
            sheet.by_key.entry(selector.key()).or_default().push(k);
        }
        if !sheet.rules.is_empty() {
            sheet.matcher = Matcher::new(document);
        }
        sheet
    }

    /// Adds the rules of a sheet, or of the block of an at-rule.
    fn add(&mut self, text: &'a str, nesting: usize) {
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            rest = if rest.starts_with('@') { self.at_rule(rest, nesting) } else { self.add_rules(rest) }.trim_start();
        }
    }

    /// Adds the rules of an at-rule that applies, and returns the text after it. An at-rule ends with a semicolon or
    /// with its block.
    fn at_rule(&mut self, text: &'a str, nesting: usize) -> &'a str {
        let Some(open) = find_outside(text, b";{") else { return "" };
        let (head, rest) = (&text[1..open], &text[open + 1..]);
        let (name, condition) = head.split_at(head.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(head.len()));
        let (block, rest) = match text.as_bytes()[open] {
            b'{' => block_of(rest),
            _ => ("", rest),
        };
        let applies = match name.to_ascii_lowercase().as_str() {
            "media" => media_applies(condition),
            "charset" | "namespace" => Some(false),
            // These define names on which no outline depends.
            "font" | "keyframes" | "page" => Some(false),
            _ => None,
        };
        match applies {
            Some(true) if nesting < NESTING_MAX => self.add(block, nesting + 1),
            Some(false) => {}
            Some(true) | None => self.unread += 1,
        }
        rest
    }

    /// Adds the rules of one block, and returns the text after it.
    fn add_rules(&mut self, text: &'a str) -> &'a str {
        let Some(open) = find_outside(text, b"{") else { return "" };
        let body = &text[open + 1..];
        let close = find_outside(body, b"}").unwrap_or(body.len());
        let block: Vec<_> = declarations(&body[..close]).collect();
        if !block.is_empty() {
            for selector in selector::list(&text[..open]) {
                match Selector::parse(selector) {
                    Some(selector) => self.rules.push((selector, self.blocks.len())),
                    None => self.unread += 1,
                }
            }
            self.blocks.push(block);
        }
        body.get(close + 1..).unwrap_or("")
    }

    /// The rules for an element, in the order in which they win.
    fn matching(&self, node: Node<'a, 'a>) -> Vec<usize> {
        let id = node.attribute("id").map(Key::Id);
        let classes = node.attribute("class").unwrap_or("").split_ascii_whitespace().map(Key::Class);
        let keys = [Key::Any, Key::Tag(node.tag_name().name())].into_iter().chain(id).chain(classes);
        let rules = keys.filter_map(|key| self.by_key.get(&key)).flatten().copied();
        let mut matching: Vec<usize> = rules.filter(|&rule| self.matcher.matches(&self.rules[rule].0, node)).collect();
        matching.sort_unstable();
        matching.dedup();
        matching
    }

    /// The declarations of an element: attributes, then rules, then its `style`, then the important ones in the same
    /// order.
    ///
    /// # Errors
    /// Where rules times elements exceed the matching budget.
    pub fn declared(&self, node: Node<'a, 'a>) -> Result<Declared<'a>, ImportError> {
        let mut declared = Declared::of_attributes(node);
        let matching = self.matching(node);
        if self.matcher.is_exhausted() {
            let help = "set the style of the elements themselves: editors export this as presentation attributes";
            return Err(ImportError::new("the style sheet has too many rules for so many elements", help));
        }
        let own: Vec<_> = declarations(node.attribute("style").unwrap_or("")).collect();
        let blocks: Vec<&Vec<Declaration>> =
            matching.iter().map(|&rule| &self.blocks[self.rules[rule].1]).chain(std::iter::once(&own)).collect();
        for important in [false, true] {
            for declaration in blocks.iter().flat_map(|block| block.iter()).filter(|d| d.important == important) {
                match declaration.property {
                    Name::Known(property) => declared.set(property, declaration.value),
                    Name::Custom(name) => declared.set_custom(name, declaration.value),
                }
            }
        }
        Ok(declared)
    }
}

/// The block that begins behind its opening brace, and what comes behind the block.
fn block_of(text: &str) -> (&str, &str) {
    let (mut depth, mut at) = (1_usize, 0);
    while let Some(next) = find_outside(&text[at..], b"{}") {
        let brace = at + next;
        depth = if text.as_bytes()[brace] == b'{' { depth + 1 } else { depth - 1 };
        at = brace + 1;
        if depth == 0 {
            return (&text[..brace], &text[at..]);
        }
    }
    (text, "")
}

/// Whether a light screen meets a list of media queries; `None` where that depends on more than is known here.
fn media_applies(list: &str) -> Option<bool> {
    let queries: Vec<Option<bool>> = selector::list(list).map(query_applies).collect();
    match queries.contains(&Some(true)) {
        true => Some(true),
        false => queries.iter().all(Option::is_some).then_some(false),
    }
}

fn query_applies(query: &str) -> Option<bool> {
    let query = query.trim().to_ascii_lowercase();
    let (negated, query) = match query.strip_prefix("not ") {
        Some(rest) => (true, rest.trim_start()),
        None => (false, query.strip_prefix("only ").unwrap_or(&query).trim_start()),
    };
    let mut met = Some(true);
    for term in query.split(" and ").map(str::trim) {
        let term = match term {
            "" | "all" | "screen" => Some(true),
            "print" | "speech" | "tty" | "tv" | "projection" | "handheld" | "braille" | "embossed" | "aural" => {
                Some(false)
            }
            feature => match feature.replace(' ', "").as_str() {
                "(prefers-color-scheme:light)" => Some(true),
                "(prefers-color-scheme:dark)" => Some(false),
                _ => None,
            },
        };
        met = match (met, term) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) => Some(true),
            (None, _) | (_, None) => None,
        };
    }
    met.map(|met| met != negated)
}
