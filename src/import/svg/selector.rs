//! Selectors (Selectors Level 4, as far as still artwork needs them): types, ids, classes, attributes, positions among
//! siblings, `:not`, `:is`, `:where`, and all four combinators.

use roxmltree::{Document, Node};
use std::cell::Cell;
use std::collections::BTreeMap;

/// Largest number of comparisons of an element with a part of a selector, in one file.
pub(super) const MATCHING_MAX: u64 = 20_000_000;
/// Largest number of compounds of a selector, and of selectors within it. Longer ones are not read.
const COMPOUNDS_MAX: usize = 64;
const NESTING_MAX: usize = 4;

/// The relation of a compound to the one on its right.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Combinator {
    Descendant,
    Child,
    Next,
    Later,
}

#[derive(Debug)]
enum Test<'a> {
    Present,
    Equals(&'a str),
    Word(&'a str),
    Dash(&'a str),
    Prefix(&'a str),
    Suffix(&'a str),
    Substring(&'a str),
}

/// The siblings at positions a·n + b, counted from the first or the last, all or those of the same type.
#[derive(Debug)]
struct Nth {
    a: i64,
    b: i64,
    from_last: bool,
    of_type: bool,
}

#[derive(Debug)]
enum Simple<'a> {
    Id(&'a str),
    Class(&'a str),
    Attribute {
        name: &'a str,
        test: Test<'a>,
        any_case: bool,
    },
    Nth(Nth),
    Root,
    Empty,
    /// Any of these selectors, or none of them.
    Any {
        selectors: Vec<Selector<'a>>,
        wanted: bool,
    },
    /// States that still artwork never has.
    Never,
}

/// The conditions on one element.
#[derive(Debug, Default)]
struct Compound<'a> {
    tag: Option<&'a str>,
    simple: Vec<Simple<'a>>,
}

/// A selector, from its subject leftward.
#[derive(Debug)]
pub(super) struct Selector<'a> {
    subject: Compound<'a>,
    /// The compounds to the left, each with its relation to the one on its right.
    left: Vec<(Combinator, Compound<'a>)>,
    /// The numbers of ids; of classes, attributes and pseudo-classes; of types.
    pub specificity: [usize; 3],
}

/// The condition on the element by which a rule is indexed: an id if there is one, else a class, else the type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Key<'a> {
    Id(&'a str),
    Class(&'a str),
    Tag(&'a str),
    Any,
}

/// The state of matching: positions of elements among their siblings, and the number of comparisons so far.
#[derive(Default)]
pub(super) struct Matcher {
    /// For each element, from 1: its position among all siblings and among those of its type, each from the first and
    /// from the last.
    places: Vec<[[u32; 2]; 2]>,
    spent: Cell<u64>,
}

impl Matcher {
    /// The positions of the elements of a document.
    pub fn new(document: &Document) -> Self {
        let mut matcher = Self::default();
        for parent in document.descendants().filter(Node::has_children) {
            matcher.place_children(parent);
        }
        matcher
    }

    fn place_children(&mut self, parent: Node) {
        let children: Vec<Node> = parent.children().filter(Node::is_element).collect();
        let mut of_type: BTreeMap<&str, u32> = BTreeMap::new();
        let mut place_of_type = Vec::with_capacity(children.len());
        for child in &children {
            let count = of_type.entry(child.tag_name().name()).or_default();
            *count += 1;
            place_of_type.push(*count);
        }
        for (k, child) in children.iter().enumerate() {
            let index = child.id().get_usize();
            if self.places.len() <= index {
                self.places.resize(index + 1, [[1; 2]; 2]);
            }
            let backward = |count: u32, place: u32| count + 1 - place;
            let (place, typed) = (k as u32 + 1, place_of_type[k]);
            self.places[index] = [
                [place, backward(children.len() as u32, place)],
                [typed, backward(of_type[child.tag_name().name()], typed)],
            ];
        }
    }

    /// Whether the number of comparisons has reached its limit.
    pub fn is_exhausted(&self) -> bool {
        self.spent.get() > MATCHING_MAX
    }

    /// Whether a selector selects an element; `false` after too many comparisons.
    pub fn matches(&self, selector: &Selector, node: Node) -> bool {
        self.fits(&selector.subject, node) && self.fits_left(&selector.left, node)
    }

    /// Whether elements to the left of `node` meet the compounds. The recursion is as deep as the selector has
    /// compounds.
    fn fits_left(&self, left: &[(Combinator, Compound)], node: Node) -> bool {
        let Some(((combinator, compound), rest)) = left.split_first() else { return true };
        let holds = |at: Node| self.fits(compound, at) && self.fits_left(rest, at);
        match combinator {
            Combinator::Child => node.parent_element().is_some_and(holds),
            Combinator::Next => node.prev_sibling_element().is_some_and(holds),
            Combinator::Descendant => std::iter::successors(node.parent_element(), Node::parent_element)
                .any(|at| !self.is_exhausted() && holds(at)),
            Combinator::Later => std::iter::successors(node.prev_sibling_element(), Node::prev_sibling_element)
                .any(|at| !self.is_exhausted() && holds(at)),
        }
    }

    fn fits(&self, compound: &Compound, node: Node) -> bool {
        self.spent.set(self.spent.get() + 1);
        !self.is_exhausted()
            && compound.tag.is_none_or(|tag| node.tag_name().name() == tag)
            && compound.simple.iter().all(|simple| self.fits_simple(simple, node))
    }

    fn fits_simple(&self, simple: &Simple, node: Node) -> bool {
        match simple {
            Simple::Id(id) => node.attribute("id") == Some(id),
            Simple::Class(class) => words(node.attribute("class").unwrap_or("")).any(|word| word == *class),
            Simple::Attribute { name, test, any_case } => {
                let attribute = node.attributes().find(|a| a.name() == *name && a.namespace().is_none());
                attribute.is_some_and(|attribute| test.holds(attribute.value(), *any_case))
            }
            Simple::Nth(nth) => {
                let place = self.places.get(node.id().get_usize()).copied().unwrap_or([[1; 2]; 2]);
                nth.counts(place[usize::from(nth.of_type)][usize::from(nth.from_last)])
            }
            Simple::Root => node.parent().is_some_and(|parent| parent.is_root()),
            Simple::Empty => node.children().all(|child| !child.is_element() && !child.is_text()),
            Simple::Any { selectors, wanted } => selectors.iter().any(|s| self.matches(s, node)) == *wanted,
            Simple::Never => false,
        }
    }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split_ascii_whitespace()
}

impl Test<'_> {
    fn holds(&self, value: &str, any_case: bool) -> bool {
        let text = match self {
            Test::Present => return true,
            Test::Equals(text) | Test::Word(text) | Test::Dash(text) => text,
            Test::Prefix(text) | Test::Suffix(text) | Test::Substring(text) => text,
        };
        if any_case {
            let [value, text] = [value, text].map(str::to_ascii_lowercase);
            return self.compares(&value, &text);
        }
        self.compares(value, text)
    }

    fn compares(&self, value: &str, text: &str) -> bool {
        match self {
            Test::Present => true,
            Test::Equals(_) => value == text,
            Test::Word(_) => words(value).any(|word| word == text),
            Test::Dash(_) => value.strip_prefix(text).is_some_and(|rest| rest.is_empty() || rest.starts_with('-')),
            Test::Prefix(_) => !text.is_empty() && value.starts_with(text),
            Test::Suffix(_) => !text.is_empty() && value.ends_with(text),
            Test::Substring(_) => !text.is_empty() && value.contains(text),
        }
    }
}

impl Nth {
    /// Whether a position, from 1, is a·n + b for an integer n ≥ 0.
    fn counts(&self, place: u32) -> bool {
        let beyond = i64::from(place) - self.b;
        if self.a == 0 { beyond == 0 } else { beyond % self.a == 0 && beyond / self.a >= 0 }
    }

    /// `odd`, `even`, `3`, `2n+1`, `-n + 3`.
    fn parse(text: &str, from_last: bool, of_type: bool) -> Option<Self> {
        let plain: String = text.chars().filter(|c| !c.is_ascii_whitespace()).collect::<String>().to_ascii_lowercase();
        let whole = |text: &str| text.parse::<i64>().ok().filter(|n| n.abs() < 1 << 40);
        let (a, b) = match plain.as_str() {
            "odd" => (2, 1),
            "even" => (2, 0),
            other => match other.split_once('n') {
                None => (0, whole(other)?),
                Some((a, b)) => {
                    let a = match a {
                        "" | "+" => 1,
                        "-" => -1,
                        number => whole(number)?,
                    };
                    (a, if b.is_empty() { 0 } else { whole(b)? })
                }
            },
        };
        Some(Self { a, b, from_last, of_type })
    }
}

// ---- reading ----

/// The selectors of a list: the pieces between commas outside of brackets and strings.
pub(super) fn list(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        let (mut depth, mut quote) = (0_usize, None);
        let end = text.bytes().position(|b| {
            match (quote, b) {
                (Some(q), _) if q == b => quote = None,
                (Some(_), _) => {}
                (None, b'"' | b'\'') => quote = Some(b),
                (None, b'(' | b'[') => depth += 1,
                (None, b')' | b']') => depth = depth.saturating_sub(1),
                (None, _) => return b == b',' && depth == 0,
            }
            false
        });
        rest = end.map(|end| &text[end + 1..]);
        Some(&text[..end.unwrap_or(text.len())])
    })
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '-' | '_') || !c.is_ascii()
}

/// The first word of a text, and the rest.
fn word(text: &str) -> Option<(&str, &str)> {
    let end = text.find(|c| !is_word(c)).unwrap_or(text.len());
    (end > 0).then(|| text.split_at(end))
}

/// The text between an open bracket before `text` and the one that closes it, and the rest.
fn bracketed(text: &str, close: u8) -> Option<(&str, &str)> {
    let (mut depth, mut quote) = (0_usize, None);
    for (i, b) in text.bytes().enumerate() {
        match (quote, b) {
            (Some(q), _) if q == b => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(b),
            (None, b) if b == close && depth == 0 => return Some((&text[..i], &text[i + 1..])),
            (None, b'(' | b'[') => depth += 1,
            (None, b')' | b']') => depth = depth.saturating_sub(1),
            (None, _) => {}
        }
    }
    None
}

impl<'a> Selector<'a> {
    /// Reads a selector; `None` where it has unsupported parts.
    pub fn parse(text: &'a str) -> Option<Self> {
        Self::parse_within(text, 0)
    }

    fn parse_within(text: &'a str, nesting: usize) -> Option<Self> {
        let mut specificity = [0; 3];
        let mut left = Vec::new();
        let (mut subject, mut rest) = Compound::parse(text.trim(), &mut specificity, nesting)?;
        loop {
            let after = rest.trim_start();
            if after.is_empty() {
                break;
            }
            let (combinator, next) = match after.as_bytes()[0] {
                b'>' => (Combinator::Child, &after[1..]),
                b'+' => (Combinator::Next, &after[1..]),
                b'~' => (Combinator::Later, &after[1..]),
                _ if after.len() < rest.len() => (Combinator::Descendant, after),
                _ => return None,
            };
            let (compound, next) = Compound::parse(next.trim_start(), &mut specificity, nesting)?;
            left.push((combinator, std::mem::replace(&mut subject, compound)));
            rest = next;
        }
        left.reverse();
        (left.len() < COMPOUNDS_MAX).then_some(Self { subject, left, specificity })
    }

    /// The condition by which the rule is indexed.
    pub fn key(&self) -> Key<'a> {
        let named = |of: fn(&Simple<'a>) -> Option<Key<'a>>| self.subject.simple.iter().find_map(of);
        let id = named(|simple| if let Simple::Id(id) = simple { Some(Key::Id(id)) } else { None });
        let class = || named(|simple| if let Simple::Class(class) = simple { Some(Key::Class(class)) } else { None });
        id.or_else(class).or(self.subject.tag.map(Key::Tag)).unwrap_or(Key::Any)
    }
}

impl<'a> Compound<'a> {
    /// The first compound of a text, and the rest.
    fn parse(text: &'a str, specificity: &mut [usize; 3], nesting: usize) -> Option<(Self, &'a str)> {
        let mut compound = Self::default();
        let mut rest = text;
        if let Some(after) = rest.strip_prefix('*') {
            rest = after;
        } else if let Some((tag, after)) = word(rest) {
            (compound.tag, rest) = (Some(tag), after);
            specificity[2] += 1;
        }
        while let Some(first) = rest.bytes().next() {
            // Empty where a letter of several bytes follows a star or a bracket.
            let inner = rest.get(1..).unwrap_or_default();
            let (simple, after) = match first {
                b'#' => word(inner).map(|(id, after)| (Simple::Id(id), after))?,
                b'.' => word(inner).map(|(class, after)| (Simple::Class(class), after))?,
                b'[' => bracketed(inner, b']').and_then(|(text, after)| Some((attribute(text)?, after)))?,
                b':' => pseudo(inner, specificity, nesting)?,
                _ => break,
            };
            match simple {
                Simple::Id(_) => specificity[0] += 1,
                Simple::Any { .. } => {}
                Simple::Class(_) | Simple::Attribute { .. } | Simple::Nth(_) => specificity[1] += 1,
                Simple::Root | Simple::Empty | Simple::Never => specificity[1] += 1,
            }
            compound.simple.push(simple);
            rest = after;
        }
        (rest.len() < text.len()).then_some((compound, rest))
    }
}

/// The condition in square brackets: `name`, `name="value"`, `name^=value i`.
fn attribute(text: &str) -> Option<Simple<'_>> {
    let (name, rest) = word(text.trim())?;
    let rest = rest.trim_start();
    if rest.is_empty() {
        return Some(Simple::Attribute { name, test: Test::Present, any_case: false });
    }
    let (operator, rest) = rest.split_at(rest.find('=')? + 1);
    let rest = rest.trim();
    let (value, flag) = match rest.bytes().next()? {
        quote @ (b'"' | b'\'') => rest[1..].split_once(char::from(quote))?,
        _ => rest.split_at(rest.find(|c: char| c.is_ascii_whitespace()).unwrap_or(rest.len())),
    };
    let any_case = match flag.trim() {
        "" | "s" | "S" => false,
        "i" | "I" => true,
        _ => return None,
    };
    let test = match operator {
        "=" => Test::Equals(value),
        "~=" => Test::Word(value),
        "|=" => Test::Dash(value),
        "^=" => Test::Prefix(value),
        "$=" => Test::Suffix(value),
        "*=" => Test::Substring(value),
        _ => return None,
    };
    Some(Simple::Attribute { name, test, any_case })
}

/// A pseudo-class after its colon, and the rest.
fn pseudo<'a>(text: &'a str, specificity: &mut [usize; 3], nesting: usize) -> Option<(Simple<'a>, &'a str)> {
    if let Some(text) = text.strip_prefix(':') {
        // A pseudo-element is not an element of the file.
        let (_, rest) = word(text)?;
        return Some((Simple::Never, rest));
    }
    let (name, rest) = word(text)?;
    let name = name.to_ascii_lowercase();
    if let Some(inner) = rest.strip_prefix('(') {
        let (inner, rest) = bracketed(inner, b')')?;
        let nth = |from_last, of_type| Nth::parse(inner, from_last, of_type).map(Simple::Nth);
        let simple = match name.as_str() {
            "nth-child" => nth(false, false)?,
            "nth-last-child" => nth(true, false)?,
            "nth-of-type" => nth(false, true)?,
            "nth-last-of-type" => nth(true, true)?,
            "not" | "is" | "where" | "matches" if nesting < NESTING_MAX => {
                let selectors: Vec<Selector> =
                    list(inner).map(|s| Selector::parse_within(s, nesting + 1)).collect::<Option<_>>()?;
                let counted = selectors.iter().map(|s| s.specificity).max().filter(|_| name != "where");
                counted.into_iter().for_each(|counted| (0..3).for_each(|k| specificity[k] += counted[k]));
                Simple::Any { selectors, wanted: name != "not" }
            }
            _ => return None,
        };
        return Some((simple, rest));
    }
    let place = |b, from_last, of_type| Simple::Nth(Nth { a: 0, b, from_last, of_type });
    let simple = match name.as_str() {
        "first-child" => place(1, false, false),
        "last-child" => place(1, true, false),
        "first-of-type" => place(1, false, true),
        "last-of-type" => place(1, true, true),
        "only-child" | "only-of-type" => {
            let of_type = name == "only-of-type";
            // Both the first and the last: an element that is neither "not first" nor "not last".
            let ends = [false, true].map(|from_last| Selector {
                subject: Compound { tag: None, simple: vec![not_first(from_last, of_type)] },
                left: Vec::new(),
                specificity: [0; 3],
            });
            specificity[1] += 1;
            Simple::Any { selectors: ends.into(), wanted: false }
        }
        "root" => Simple::Root,
        "empty" => Simple::Empty,
        "hover" | "active" | "focus" | "focus-within" | "focus-visible" | "visited" | "target" | "checked"
        | "before" | "after" | "first-line" | "first-letter" => Simple::Never,
        _ => return None,
    };
    Some((simple, rest))
}

/// The second or a later one from one end of the siblings.
fn not_first(from_last: bool, of_type: bool) -> Simple<'static> {
    Simple::Nth(Nth { a: 1, b: 2, from_last, of_type })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ids of the elements that a selector selects.
    fn selected(text: &str) -> String {
        let xml = r#"<svg id="s"><g id="a" class="x y" lang="en-GB"><p id="b" k="One two"/><q id="c"/><p id="d" k="one-2"/></g><g id="e"/></svg>"#;
        let document = Document::parse(xml).unwrap();
        let matcher = Matcher::new(&document);
        let selector = Selector::parse(text).unwrap_or_else(|| panic!("{text}"));
        let hits = document.descendants().filter(|n| n.is_element() && matcher.matches(&selector, *n));
        hits.filter_map(|n| n.attribute("id")).collect()
    }

    #[test]
    fn selectors_select() {
        for (selector, ids) in [
            ("g", "ae"),
            ("*", "sabcde"),
            ("g.x.y#a", "a"),
            ("g > p", "bd"),
            ("svg p", "bd"),
            ("q + p", "d"),
            ("p~p", "d"),
            ("[k]", "bd"),
            ("p[k='One two']", "b"),
            ("[k~=two]", "b"),
            ("[lang|=en]", "a"),
            ("[k^=\"one\" i]", "bd"),
            ("[k$='2']", "d"),
            ("[k*=ne]", "bd"),
            (":first-child", "sab"),
            ("p:last-child", "d"),
            ("p:nth-child(2n + 1)", "bd"),
            (":nth-child(even)", "ce"),
            ("p:nth-of-type(2)", "d"),
            ("p:nth-last-of-type(2)", "b"),
            (":nth-child(-n+1)", "sab"),
            ("q:only-of-type", "c"),
            (":root", "s"),
            ("g:empty", "e"),
            ("p:not([k^=One], .z)", "d"),
            (":is(q, #d)", "cd"),
            ("p:hover", ""),
            ("svg > g > p + q ~ p", "d"),
        ] {
            assert_eq!(selected(selector), ids, "{selector}");
        }
        for unread in ["a::b c(", "p:nth-child(x)", "[=", "p>", ".", "a|b", ":has(p)", "*é", "[k]é", "[=é"] {
            assert!(Selector::parse(unread).is_none(), "{unread}");
        }
        assert_eq!(Selector::parse("g#a:not(.x) > p:first-child").unwrap().specificity, [1, 2, 2]);
    }
}
