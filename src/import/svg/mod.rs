//! SVG. Filled elements become shapes in the order of painting, with exact curves. Strokes become centre lines if asked
//! for.
//!
//! Coordinates are user units of the outermost `svg` element, with y turned upward: y → 2·min-y + height − y in its
//! view box, or in its height, or y → −y without both. [`Drawing::unit`] is the size of a user unit.
//!
//! Names: the Inkscape layer, else the id of the element or of the nearest group around it (a `use` gives its id to the
//! element that it shows), else the colour. A path is drawn up to the first error in its data, as SVG requires. Clip
//! paths and viewports cut elements. The page cuts them only if the file says so, but elements wholly outside of it are
//! left out. Counted but not applied: masks, filters, markers, patterns. Counted but not read: text, images, invisible
//! elements. Strokes have no width unless their area is asked for.

mod basic_shape;
mod clip;
mod css;
mod digits;
mod drawn;
mod path;
mod selector;
mod shape;
mod stroke;
mod style;
mod transform;
mod units;
mod walk;
mod xml;

use super::selection::{Chooser, Selection};
use super::{Certainty, Facts, ImportError, without_bom};
use crate::curve::Curve;
use crate::domain::{Drawing, Skipped};
use crate::geometry::Rect;
use crate::ids::{Colour, LayerId};
use clip::{CutterId, Cutters};
use css::Sheet;
use kurbo::Affine;
use path::Subpath;
use roxmltree::Node;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::rc::Rc;
use units::Page;
use walk::Context;
use xml::Lines;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// The reason why a masked element is counted.
const MASK: &str = "masks are not applied";
/// The name of an unnamed rectangle over the whole page.
const BACKGROUND: &str = "background";
/// Largest distance of such a rectangle from the page, as a part of the page's diagonal. Programs round.
const BACKGROUND_SLACK: f64 = 1e-3;

/// The facts of SVG.
pub(super) const FACTS: Facts = Facts {
    name: "svg",
    suffixes: &["svg", "svgz"],
    sign: |bytes| sniff(without_bom(bytes)),
    certainty: Certainty::Mark,
    read: |bytes, stem, options| read(bytes, stem, &options.svg, &options.selection).map(Into::into),
};

/// What becomes of strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Strokes {
    /// Centre lines where nothing is filled; else elements that are only stroked are left out.
    #[default]
    Auto,
    /// Elements that are stroked and not filled become centre lines.
    Lines,
    /// The area of a stroke is filled, as another shape above the fill.
    Area,
    /// Left out.
    Ignore,
}

/// How SVG is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SvgOptions {
    /// What becomes of strokes: centre lines, areas or nothing.
    pub strokes: Strokes,
    /// Pixels to an inch.
    pub dpi: f64,
}

impl Default for SvgOptions {
    fn default() -> Self {
        Self { strokes: Strokes::Auto, dpi: units::CSS_DPI }
    }
}

/// Reads an SVG file, or a compressed one (`.svgz`). `selection` names elements and the groups around them, by id or by
/// the label that Inkscape gives to a layer.
///
/// # Errors
/// Where the text is not XML or not SVG, a number is too large, or the file expands beyond its limits. Where nothing is
/// left of the file and the data of an element are in error: the first such place.
pub fn read(bytes: &[u8], stem: &str, options: &SvgOptions, selection: &Selection) -> Result<Drawing, ImportError> {
    let (text, encoding) = xml::text(bytes)?;
    let document = xml::parse(&text)?;
    let root = document.root_element();
    if local_name(root) != Some("svg") {
        let what = format!("the outermost element is '{}', not 'svg'", root.tag_name().name());
        return Err(ImportError::at(Lines::new(&text).place(root.range().start).0, what, "this is not an SVG drawing"));
    }
    let css = css::sheet_text(&document);
    let sheet = Sheet::parse(&css, &document);
    let page = Page::new(root, options.dpi);
    let mut reader = Reader::new(&text, &sheet, selection, options.strokes);
    reader.cutters.set_page(root, page.frame, page.upward);
    reader.drawing.notes.extend(encoding.into_iter().chain(page.notes));
    if sheet.unread > 0 {
        let note = format!("{} selectors or at-rules of the style sheet are of kinds that are not read.", sheet.unread);
        reader.drawing.notes.push(note);
    }
    reader.index(root);
    reader.walk(root, Context::of(page.viewport, page.upward))?;
    let broken = reader.broken.take();
    let mut drawing = reader.drawn()?;
    if let Some(error) = broken.filter(|_| drawing.curves.is_empty()) {
        return Err(error);
    }
    let title = root.children().find(|n| local_name(*n) == Some("title")).and_then(|n| n.text());
    drawing.title = title.map(str::trim).filter(|t| !t.is_empty()).unwrap_or(stem).to_owned();
    drawing.format = "svg".into();
    drawing.unit = Some(page.unit);
    drawing.sketch = digits::is_sketch(&text);
    Ok(drawing)
}

/// Whether these may be the first bytes of an SVG file: XML with an `svg` element, or compressed data.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    let is_xml = bytes.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'<');
    bytes.starts_with(b"\x1f\x8b") || is_xml && bytes.windows(4).any(|w| w == b"<svg" || w == b":svg")
}

/// The name of an SVG element, also where the file does not declare the namespace.
fn local_name<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    let name = node.tag_name();
    (node.is_element() && name.namespace().is_none_or(|n| n == SVG)).then(|| name.name())
}

/// An element with its outline in the drawing's coordinates.
struct Element {
    subpaths: Vec<Subpath>,
    tag: &'static str,
    filled: bool,
    even_odd: bool,
    name: String,
    layer: Option<LayerId>,
    cut_by: Option<CutterId>,
    colour: Option<Colour>,
    /// Whether it is a rectangle over the whole page, below all others.
    is_background: bool,
    entity: String,
    /// The unit of the last decimal of its coordinates, in the drawing's units.
    last_decimal: f64,
}

/// How something is painted.
#[derive(Clone, Debug, Default)]
struct Painting {
    /// The colour, or the id of the paint server.
    name: String,
    /// Red, green, blue and opacity; the mean of a gradient; `None` of a pattern.
    mean: Option<[f64; 4]>,
}

/// An outline with its paint, in the drawing's coordinates.
struct Drawn {
    subpaths: Vec<Subpath>,
    filled: bool,
    /// Whether the paint is that of a stroke.
    is_stroke: bool,
    paint: Painting,
    entity: String,
    last_decimal: f64,
}

struct Reader<'a> {
    text: &'a str,
    lines: Lines,
    sheet: &'a Sheet<'a>,
    chooser: Chooser<'a>,
    strokes: Strokes,
    /// Largest distance of a stroke's outline from the exact one.
    offset_error: f64,
    /// Elements by id, sorted. The first element of an id counts.
    ids: Vec<(&'a str, Node<'a, 'a>)>,
    elements: Vec<Element>,
    layers: BTreeMap<&'a str, LayerId>,
    cutters: Cutters,
    drawing: Drawing,
    /// Number of elements and curves that `use` has shown so far.
    expanded: usize,
    /// Number of commands of zero length.
    empty_commands: usize,
    /// Number of style values of unsupported kinds, and the first of them.
    unread_values: usize,
    first_unread: Option<String>,
    /// The first element with an error in its data.
    broken: Option<ImportError>,
    stack: Vec<(Node<'a, 'a>, Rc<Context<'a>>)>,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str, sheet: &'a Sheet<'a>, selection: &'a Selection, strokes: Strokes) -> Self {
        Self {
            text,
            lines: Lines::new(text),
            sheet,
            chooser: Chooser::new(selection, true),
            strokes,
            offset_error: 0.0,
            ids: Vec::new(),
            elements: Vec::new(),
            layers: BTreeMap::new(),
            cutters: Cutters::default(),
            drawing: Drawing::default(),
            expanded: 0,
            empty_commands: 0,
            unread_values: 0,
            first_unread: None,
            broken: None,
            stack: Vec::new(),
        }
    }

    fn index(&mut self, root: Node<'a, 'a>) {
        self.ids = root.descendants().filter_map(|n| Some((n.attribute("id")?, n))).collect();
        self.ids.sort_by_key(|(id, _)| *id);
        self.ids.dedup_by_key(|(id, _)| *id);
        root.descendants().flat_map(names).for_each(|name| self.chooser.learn(name));
    }

    fn by_id(&self, id: &str) -> Option<Node<'a, 'a>> {
        self.ids.binary_search_by_key(&id, |(id, _)| id).ok().map(|at| self.ids[at].1)
    }

    fn line(&self, node: Node) -> usize {
        self.lines.place(node.range().start).0
    }

    /// Counts an element as left out. `tag` is a word of SVG.
    fn skip(&mut self, tag: &str, why: &str) {
        match self.drawing.skipped.iter_mut().find(|s| s.entity == tag && s.why == why) {
            Some(skipped) => skipped.count += 1,
            None => self.drawing.skipped.push(Skipped { entity: tag.into(), count: 1, why: why.into() }),
        }
    }
}

/// The box around subpaths; `None` where there are none.
fn bounds_of_all(subpaths: &[Subpath]) -> Option<Rect> {
    subpaths.iter().flat_map(|s| &s.curves).map(|c| c.bounds()).reduce(|a, b| a.union(b))
}

/// Path data, as an attribute or as the `path("…")` of a style sheet.
fn path_data(text: &str) -> &str {
    let inner = text.strip_prefix("path(").and_then(|rest| rest.trim_end().strip_suffix(')'));
    match inner {
        Some(quoted) => quoted.trim().trim_matches(['"', '\'']),
        None if text == "none" => "",
        None => text,
    }
}

impl Subpath {
    /// The subpath under a map.
    pub fn transformed(self, map: Affine) -> Self {
        Self { curves: self.curves.iter().map(|curve: &Curve| curve.transformed(map)).collect(), ..self }
    }
}

/// The names by which an element is selected or left out.
fn names<'a>(node: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    let given = [node.attribute("id"), node.attribute((INKSCAPE, "label"))];
    given.into_iter().flatten().filter(|name| !name.trim().is_empty())
}

/// The name of an element, if SVG has it.
fn known_tag(tag: &str) -> &'static str {
    const TAGS: &[&str] = &[
        "svg", "g", "a", "use", "symbol", "switch", "path", "rect", "circle", "ellipse", "line", "polyline", "polygon",
    ];
    TAGS.iter().find(|known| **known == tag).unwrap_or(&"unknown element")
}

/// `path "wing"`.
fn label(tag: &str, node: Node) -> String {
    match node.attribute("id") {
        Some(id) => format!("{} \"{}\"", cut(tag), cut(id)),
        None => cut(tag).to_owned(),
    }
}

/// A text from the file, cut to the length of a message.
fn cut(text: &str) -> &str {
    text.char_indices().nth(60).map_or(text, |(end, _)| &text[..end])
}
