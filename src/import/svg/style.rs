//! How an element is painted: presentation attributes under style sheets under `style`, and what is inherited (SVG 2, chapter 6).
//!
//! Of CSS as much as drawings use: selectors of types, classes, ids and `*`, joined by descent, in lists, by specificity, with
//! `!important`. Rules are found by what they ask of the element itself; matching goes up the tree once for each, and has a budget.

use super::ImportError;
use roxmltree::{Document, Node};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::str::FromStr;
use svgtypes::{Color, Paint, PaintFallback};

/// Elements compared with parts of selectors, in one file.
const MATCHING_MAX: u64 = 20_000_000;

macro_rules! properties {
    ($($property:ident $name:literal),* $(,)?) => {
        /// A property that a reader of outlines needs.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Property { $($property),* }
        const PROPERTIES: &[(&str, Property)] = &[$(($name, Property::$property)),*];
    };
}
properties! {
    Fill "fill", FillRule "fill-rule", FillOpacity "fill-opacity", Stroke "stroke", StrokeWidth "stroke-width",
    StrokeOpacity "stroke-opacity", Opacity "opacity", Display "display", Visibility "visibility", Color "color",
    Transform "transform", ClipPath "clip-path", Mask "mask", Filter "filter", Marker "marker",
    MarkerStart "marker-start", MarkerMid "marker-mid", MarkerEnd "marker-end",
}

fn property(name: &str) -> Option<Property> {
    PROPERTIES.iter().find(|(n, _)| *n == name).map(|(_, property)| *property)
}

/// What one element declares itself.
#[derive(Clone, Debug)]
pub(super) struct Declared<'a>([Option<&'a str>; PROPERTIES.len()]);

impl<'a> Declared<'a> {
    pub fn get(&self, property: Property) -> Option<&'a str> {
        self.0[property as usize]
    }

    fn set(&mut self, property: Property, value: &'a str) {
        // A value that cannot be read is no declaration: the one below it holds.
        let valid = match property {
            Property::Fill | Property::Stroke => paint(value).is_some() || value == "inherit",
            Property::FillRule => matches!(value, "nonzero" | "evenodd" | "inherit"),
            _ => true,
        };
        if valid {
            self.0[property as usize] = Some(value);
        }
    }

    /// Whether the element is shown at less than nothing: a share of 0.
    pub fn is_transparent(&self, property: Property) -> bool {
        self.get(property).is_some_and(is_zero)
    }
}

fn is_zero(share: &str) -> bool {
    share.trim_end_matches('%').trim().parse::<f64>().is_ok_and(|share| share <= 0.0)
}

struct Declaration<'a> {
    property: Property,
    value: &'a str,
    important: bool,
}

/// The declarations of a block; what is not known here is passed over.
fn declarations(block: &str) -> impl Iterator<Item = Declaration<'_>> {
    pieces(block, b';').filter_map(|piece| {
        let (name, value) = piece.split_once(':')?;
        let property = property(name.trim())?;
        let value = value.trim();
        let plain = value.strip_suffix("important").map(str::trim_end).and_then(|v| v.strip_suffix('!'));
        let (value, important) = plain.map_or((value, false), |v| (v.trim_end(), true));
        (!value.is_empty()).then_some(Declaration { property, value, important })
    })
}

/// The pieces of a text between separators that stand outside strings and brackets.
fn pieces(text: &str, separator: u8) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        let end = find_outside(text, &[separator]);
        rest = end.map(|end| &text[end + 1..]);
        Some(&text[..end.unwrap_or(text.len())])
    })
}

/// The first of some ASCII bytes that stands outside strings and round brackets.
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

// ---- selectors ----

/// A type, ids and classes that one element must have.
#[derive(Debug, Default)]
struct Compound<'a> {
    tag: Option<&'a str>,
    ids: Vec<&'a str>,
    classes: Vec<&'a str>,
}

impl Compound<'_> {
    fn matches(&self, node: Node) -> bool {
        self.tag.is_none_or(|tag| node.tag_name().name() == tag)
            && self.ids.iter().all(|id| node.attribute("id") == Some(id))
            && self.classes.iter().all(|class| {
                node.attribute("class").is_some_and(|list| list.split_ascii_whitespace().any(|c| c == *class))
            })
    }
}

/// Compounds from the element upward: the outer list has any distance between its members, the inner one goes from child to parent.
#[derive(Debug)]
struct Selector<'a> {
    chains: Vec<Vec<Compound<'a>>>,
    /// Ids, classes, types.
    specificity: [usize; 3],
}

impl<'a> Selector<'a> {
    /// `None` of a selector with more than types, classes, ids and descent in it.
    fn parse(text: &'a str) -> Option<Self> {
        let mut chains = vec![Vec::new()];
        let mut specificity = [0; 3];
        let mut rest = text.trim();
        loop {
            let end = rest.find(|c: char| c.is_ascii_whitespace() || c == '>').unwrap_or(rest.len());
            let compound = Compound::parse(&rest[..end])?;
            specificity[0] += compound.ids.len();
            specificity[1] += compound.classes.len();
            specificity[2] += usize::from(compound.tag.is_some());
            chains.last_mut()?.push(compound);
            rest = rest[end..].trim_start();
            if rest.is_empty() {
                break;
            }
            match rest.strip_prefix('>') {
                Some(child) => rest = child.trim_start(),
                None => chains.push(Vec::new()),
            }
        }
        chains.reverse();
        chains.iter_mut().for_each(|chain| chain.reverse());
        Some(Self { chains, specificity })
    }

    /// The nearest ancestor that matches is the best for what stands left of it, so nothing is tried twice.
    fn matches(&self, node: Node, spent: &Cell<u64>) -> bool {
        let mut at = Some(node);
        for (k, chain) in self.chains.iter().enumerate() {
            loop {
                let Some(from) = at.filter(|_| spent.get() <= MATCHING_MAX) else { return false };
                if let Some(top) = top_of(chain, from, spent) {
                    at = top.parent_element();
                    break;
                }
                if k == 0 {
                    return false;
                }
                at = from.parent_element();
            }
        }
        true
    }
}

/// The topmost element of a chain from child to parent that begins at `from`.
fn top_of<'n, 'i>(chain: &[Compound], from: Node<'n, 'i>, spent: &Cell<u64>) -> Option<Node<'n, 'i>> {
    let mut at = from;
    for (k, compound) in chain.iter().enumerate() {
        spent.set(spent.get() + 1);
        if k > 0 {
            at = at.parent_element()?;
        }
        if !compound.matches(at) {
            return None;
        }
    }
    Some(at)
}

impl<'a> Compound<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let word = |text: &'a str| {
            let end = text.find(['.', '#']).unwrap_or(text.len());
            let (word, rest) = text.split_at(end);
            let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_') || !c.is_ascii();
            (!word.is_empty() && word.chars().all(plain)).then_some((word, rest))
        };
        let mut compound = Self::default();
        let mut rest = text;
        if let Some(after) = rest.strip_prefix('*') {
            rest = after;
        } else if !rest.starts_with(['.', '#']) {
            let (tag, after) = word(rest)?;
            (compound.tag, rest) = (Some(tag), after);
        }
        while !rest.is_empty() {
            let list = if rest.starts_with('.') { &mut compound.classes } else { &mut compound.ids };
            let (name, after) = word(rest.strip_prefix(['.', '#'])?)?;
            list.push(name);
            rest = after;
        }
        Some(compound)
    }
}

// ---- sheets ----

/// One thing that a selector asks of the element itself: an id where it asks for any, else a class, else the type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key<'a> {
    Id(&'a str),
    Class(&'a str),
    Tag(&'a str),
    Any,
}

impl<'a> Selector<'a> {
    fn key(&self) -> Key<'a> {
        let subject = &self.chains[0][0];
        let id = subject.ids.first().map(|id| Key::Id(id));
        let class = subject.classes.first().map(|class| Key::Class(class));
        id.or(class).or(subject.tag.map(Key::Tag)).unwrap_or(Key::Any)
    }
}

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

/// Rules in the order in which they win: the last wins.
pub(super) struct Sheet<'a> {
    rules: Vec<(Selector<'a>, usize)>,
    by_key: BTreeMap<Key<'a>, Vec<usize>>,
    blocks: Vec<Vec<Declaration<'a>>>,
    /// Selectors and at-rules that are not read here.
    pub unread: usize,
    spent: Cell<u64>,
}

impl<'a> Sheet<'a> {
    pub fn parse(text: &'a str) -> Self {
        let (rules, blocks, by_key) = (Vec::new(), Vec::new(), BTreeMap::new());
        let mut sheet = Self { rules, by_key, blocks, unread: 0, spent: Cell::new(0) };
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            rest = if rest.starts_with('@') { sheet.skip_at_rule(rest) } else { sheet.add_rules(rest) }.trim_start();
        }
        sheet.rules.sort_by_key(|(selector, _)| selector.specificity);
        for (k, (selector, _)) in sheet.rules.iter().enumerate() {
            sheet.by_key.entry(selector.key()).or_default().push(k);
        }
        sheet
    }

    /// What comes behind an at-rule, which ends with a semicolon or with its block.
    fn skip_at_rule(&mut self, text: &'a str) -> &'a str {
        self.unread += usize::from(!text.starts_with("@charset") && !text.starts_with("@font-face"));
        let Some(open) = find_outside(text, b";{") else { return "" };
        let mut depth = usize::from(text.as_bytes()[open] == b'{');
        let mut rest = &text[open + 1..];
        while depth > 0 {
            let Some(next) = find_outside(rest, b"{}") else { return "" };
            if rest.as_bytes()[next] == b'{' {
                depth += 1
            } else {
                depth -= 1
            }
            rest = &rest[next + 1..];
        }
        rest
    }

    /// Takes the rules of one block, and returns what comes behind it.
    fn add_rules(&mut self, text: &'a str) -> &'a str {
        let Some(open) = find_outside(text, b"{") else { return "" };
        let body = &text[open + 1..];
        let close = find_outside(body, b"}").unwrap_or(body.len());
        let block: Vec<_> = declarations(&body[..close]).collect();
        if !block.is_empty() {
            for selector in text[..open].split(',') {
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
        let mut matching: Vec<usize> = rules.filter(|&rule| self.rules[rule].0.matches(node, &self.spent)).collect();
        matching.sort_unstable();
        matching.dedup();
        matching
    }

    /// What an element declares: attributes, then rules, then its `style`; what is important, again in this order.
    ///
    /// # Errors
    /// Where rules times elements come to more than a drawing can need.
    pub fn declared(&self, node: Node<'a, 'a>) -> Result<Declared<'a>, ImportError> {
        let mut declared = Declared([None; PROPERTIES.len()]);
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            if let Some(property) = property(attribute.name()) {
                declared.set(property, attribute.value().trim());
            }
        }
        let matching = self.matching(node);
        if self.spent.get() > MATCHING_MAX {
            let help = "set the style of the elements themselves: editors export this as presentation attributes";
            return Err(ImportError::new("the style sheet has too many rules for so many elements", help));
        }
        let own: Vec<_> = declarations(node.attribute("style").unwrap_or("")).collect();
        let blocks: Vec<&Vec<Declaration>> =
            matching.iter().map(|&rule| &self.blocks[self.rules[rule].1]).chain(std::iter::once(&own)).collect();
        for important in [false, true] {
            for declaration in blocks.iter().flat_map(|block| block.iter()).filter(|d| d.important == important) {
                declared.set(declaration.property, declaration.value);
            }
        }
        Ok(declared)
    }
}

// ---- what is inherited ----

/// The inherited properties of an element.
#[derive(Clone, Debug)]
pub(super) struct Style<'a> {
    fill: &'a str,
    pub even_odd: bool,
    fill_shows: bool,
    stroke: &'a str,
    stroke_shows: bool,
    stroke_width: bool,
    pub visible: bool,
    color: &'a str,
}

impl Default for Style<'_> {
    fn default() -> Self {
        Self {
            fill: "black",
            even_odd: false,
            fill_shows: true,
            stroke: "none",
            stroke_shows: true,
            stroke_width: true,
            visible: true,
            color: "black",
        }
    }
}

/// How an element is filled or stroked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Painted<'a> {
    No,
    /// By a colour, written `#rrggbb` or as its word.
    Colour(String),
    /// By the gradient or pattern of this id, or else so.
    Server(&'a str, Option<String>),
}

impl<'a> Style<'a> {
    /// The style of an element in this one.
    pub fn of(&self, declared: &Declared<'a>) -> Self {
        let mut style = self.clone();
        let given = |property| declared.get(property).filter(|value| *value != "inherit");
        let shows = |property, inherited: bool| given(property).map_or(inherited, |share| !is_zero(share));
        style.fill = given(Property::Fill).unwrap_or(self.fill);
        style.stroke = given(Property::Stroke).unwrap_or(self.stroke);
        style.color = given(Property::Color).unwrap_or(self.color);
        style.even_odd = given(Property::FillRule).map_or(self.even_odd, |rule| rule == "evenodd");
        style.visible = given(Property::Visibility).map_or(self.visible, |v| v == "visible");
        style.fill_shows = shows(Property::FillOpacity, self.fill_shows);
        style.stroke_shows = shows(Property::StrokeOpacity, self.stroke_shows);
        style.stroke_width = given(Property::StrokeWidth).map_or(self.stroke_width, |width| {
            svgtypes::Length::from_str(width).map_or(self.stroke_width, |length| length.number > 0.0)
        });
        style
    }

    pub fn fill(&self) -> Painted<'a> {
        if self.fill_shows { self.painted(self.fill) } else { Painted::No }
    }

    pub fn stroke(&self) -> Painted<'a> {
        if self.stroke_shows && self.stroke_width { self.painted(self.stroke) } else { Painted::No }
    }

    fn painted(&self, value: &'a str) -> Painted<'a> {
        let current = || colour(self.color, Color::from_str(self.color).unwrap_or(Color::black()));
        match paint(value) {
            None | Some(Paint::None | Paint::Inherit | Paint::ContextFill | Paint::ContextStroke) => Painted::No,
            Some(Paint::CurrentColor) => current().map_or(Painted::No, Painted::Colour),
            Some(Paint::Color(c)) => colour(value, c).map_or(Painted::No, Painted::Colour),
            Some(Paint::FuncIRI(id, fallback)) => {
                let fallback = fallback.and_then(|fallback| match fallback {
                    PaintFallback::None => None,
                    PaintFallback::CurrentColor => current(),
                    PaintFallback::Color(c) => colour("", c),
                });
                Painted::Server(id, fallback)
            }
        }
    }
}

/// A paint, without the ICC colour that may stand behind it.
fn paint(value: &str) -> Option<Paint<'_>> {
    let value = value.split(" icc-color(").next().unwrap_or(value).trim();
    if value.eq_ignore_ascii_case("currentcolor") {
        return Some(Paint::CurrentColor);
    }
    Paint::from_str(value).ok()
}

/// The name of a colour: its word where it was given as one, else `#rrggbb`; `None` of one that cannot be seen.
fn colour(text: &str, color: Color) -> Option<String> {
    let word = text.trim();
    if color.alpha == 0 {
        None
    } else if !word.is_empty() && word.bytes().all(|b| b.is_ascii_alphabetic()) {
        Some(word.to_ascii_lowercase())
    } else {
        Some(format!("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue))
    }
}
