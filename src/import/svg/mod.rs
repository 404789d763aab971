//! SVG: what is filled becomes shapes in the order of painting, as exact curves; centre lines of strokes where they are wanted.
//!
//! Coordinates are the user units of the outermost `svg` element, with y turned upward: the mirror image in its view box
//! (y → 2·min-y + height − y), without one in its height, without either about y = 0. [`Drawing::unit`] says what a user unit is.
//!
//! Names: the Inkscape layer, else the id of the element or of the nearest group around it (a `use` gives its id to what it shows),
//! else the colour. A path is drawn up to the first error in its data, as SVG asks. Clip paths and viewports cut what they hold, the page only
//! where it says so; what lies wholly outside of it is left out. Not applied, but counted: masks, filters, markers, patterns; not read, but counted: text, images, whatever
//! is hidden. Strokes have no width unless
//! what they cover is asked for.

mod clip;
mod css;
mod digits;
mod path;
mod selector;
mod shape;
mod stroke;
mod style;
mod transform;
mod units;
mod xml;

use super::ImportError;
use super::selection::{Choice, Chooser, Selection};
use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve, FillRule, Shape, Skipped};
use crate::geometry::{Point, Rect};
use crate::ids::{ClipId, Colour, LayerId, NameId};
use clip::{CutterId, Cutters, Left, OnPage, Placed};
use css::Sheet;
use kurbo::{Affine, Size};
use path::{HUGE, Subpath};
use roxmltree::{Node, NodeId};
use std::collections::BTreeMap;
use std::rc::Rc;
use style::{Declared, Property, Style};
use units::{Axis, Page, Viewport};
use xml::Lines;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// Elements and curves that `use` may show over again in one file.
const EXPANSION_MAX: usize = 1_000_000;
/// How deep `use` may show `use`.
const USE_DEPTH_MAX: usize = 64;
/// How deep `use` is followed for the box around an element.
const OWN_BOX_DEPTH_MAX: usize = 16;
/// Why a masked element is counted.
const MASK: &str = "masks are not applied";
/// The name of a rectangle over the whole page that has none.
const BACKGROUND: &str = "background";
/// How far such a rectangle may stay inside the page, as a part of its diagonal: programs round.
const BACKGROUND_SLACK: f64 = 1e-3;
/// A map that squeezes one direction by more than this leaves nothing to see.
const SQUEEZE_MIN: f64 = 1e-12;

/// What becomes of strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strokes {
    /// Centre lines where nothing is filled; else what is only stroked is left out.
    #[default]
    Auto,
    /// What is stroked and not filled is kept as centre lines.
    Lines,
    /// What they cover is filled, as by another shape over the fill.
    Area,
    /// Left out.
    Ignore,
}

/// How a drawing is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SvgOptions {
    pub strokes: Strokes,
    /// Pixels to an inch.
    pub dpi: f64,
}

impl Default for SvgOptions {
    fn default() -> Self {
        Self { strokes: Strokes::Auto, dpi: units::CSS_DPI }
    }
}

/// Reads an SVG file, or a compressed one (`.svgz`). The names of which `selection` speaks are those of an element and of all groups
/// around it: ids, and labels as Inkscape gives them to layers.
///
/// # Errors
/// Where the text is no XML or no SVG, a number is too large for any drawing, or the file unfolds beyond its bounds; where nothing is left
/// of it and the data of an element are in error: the first such place.
pub fn read(bytes: &[u8], stem: &str, options: &SvgOptions, selection: &Selection) -> Result<Drawing, ImportError> {
    let (text, encoding) = xml::text(bytes)?;
    let document = xml::parse(&text)?;
    let root = document.root_element();
    if local_name(root) != Some("svg") {
        let what = format!("the outermost element is '{}', not 'svg'", root.tag_name().name());
        return Err(ImportError::at(Lines::new(&text).place(root.range().start).0, what, "this is no SVG drawing"));
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

/// Whether these may be the first bytes of an SVG file: XML that comes to an `svg` element, or anything compressed.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    let is_xml = bytes.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'<');
    bytes.starts_with(b"\x1f\x8b") || is_xml && bytes.windows(4).any(|w| w == b"<svg" || w == b":svg")
}

/// The name of an SVG element; files that forget the namespace are read too.
fn local_name<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    let name = node.tag_name();
    (node.is_element() && name.namespace().is_none_or(|n| n == SVG)).then(|| name.name())
}

/// What an element inherits.
#[derive(Clone)]
struct Context<'a> {
    style: Style<'a>,
    /// To the drawing.
    map: Affine,
    viewport: Viewport,
    cut_by: Option<CutterId>,
    /// Of all groups around it, and its own.
    opacity: f64,
    layer: Option<&'a str>,
    /// The id of the nearest group around.
    id: Option<&'a str>,
    /// The id that a `use` gives to the element that it shows.
    alias: Option<&'a str>,
    shown_by: Option<Rc<Shown>>,
    /// What the names of the element and of all around it say.
    choice: Choice,
    /// Width and height that a `use` gives to a symbol.
    given_size: [Option<&'a str>; 2],
}

impl Context<'_> {
    fn of(viewport: Viewport, map: Affine) -> Self {
        Self {
            style: Style::default(),
            map,
            viewport,
            cut_by: None,
            opacity: 1.0,
            layer: None,
            id: None,
            alias: None,
            shown_by: None,
            choice: Choice::default(),
            given_size: [None; 2],
        }
    }
}

/// A `use` and those that show it.
struct Shown {
    target: NodeId,
    line: usize,
    depth: usize,
    by: Option<Rc<Shown>>,
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
    /// A rectangle over the whole page, under everything.
    is_background: bool,
    entity: String,
    /// The unit of the last decimal of its coordinates, in the drawing's.
    last_decimal: f64,
}

/// How something is painted.
#[derive(Clone, Debug, Default)]
struct Painting {
    /// Its colour, or the id of what paints.
    name: String,
    /// Red, green, blue, opacity, of a gradient the mean; unknown of patterns.
    mean: Option<[f64; 4]>,
}

/// An outline with its paint, in the drawing's coordinates.
struct Drawn {
    subpaths: Vec<Subpath>,
    filled: bool,
    /// Whether its paint is that of a stroke.
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
    /// The largest distance of a stroke's outline from the true one.
    offset_error: f64,
    /// Elements by id, sorted; of several with one id the first counts.
    ids: Vec<(&'a str, Node<'a, 'a>)>,
    elements: Vec<Element>,
    layers: BTreeMap<&'a str, LayerId>,
    cutters: Cutters,
    drawing: Drawing,
    /// Elements and curves shown by `use` so far.
    expanded: usize,
    /// Commands of no length.
    empty_commands: usize,
    /// The first element whose data are in error.
    broken: Option<ImportError>,
    stack: Vec<(Node<'a, 'a>, Rc<Context<'a>>)>,
}

/// Elements that are drawn only through others, or not at all.
const NOT_DRAWN: &[&str] = &[
    "defs",
    "symbol",
    "clipPath",
    "mask",
    "pattern",
    "marker",
    "filter",
    "linearGradient",
    "radialGradient",
    "title",
    "desc",
    "metadata",
    "style",
    "script",
    "view",
    "cursor",
    "color-profile",
    "font",
    "font-face",
    "meshgradient",
    "hatch",
    "solidColor",
];

/// Elements that are left out, and why.
const LEFT_OUT: &[(&str, &str)] = &[
    ("text", "text has no outlines here; convert it to paths"),
    ("image", "a raster image has no curves"),
    ("foreignObject", "it is no SVG"),
    ("animate", "animations are not played"),
    ("animateColor", "animations are not played"),
    ("animateMotion", "animations are not played"),
    ("animateTransform", "animations are not played"),
    ("set", "animations are not played"),
];

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

    // ---- the walk ----

    /// Visits what is drawn, in the order of painting. Not by recursion: groups nest as deep as they like.
    fn walk(&mut self, root: Node<'a, 'a>, context: Context<'a>) -> Result<(), ImportError> {
        self.stack.push((root, Rc::new(context)));
        while let Some((node, context)) = self.stack.pop() {
            if context.shown_by.is_some() {
                self.expand(1)?;
            }
            self.visit(node, &context)?;
        }
        Ok(())
    }

    fn expand(&mut self, by: usize) -> Result<(), ImportError> {
        self.expanded += by;
        if self.expanded <= EXPANSION_MAX {
            return Ok(());
        }
        let what =
            format!("use elements, clip paths and strokes come to more than {EXPANSION_MAX} elements and curves");
        Err(ImportError::new(what, "draw less of it, or in several files"))
    }

    fn visit(&mut self, node: Node<'a, 'a>, around: &Rc<Context<'a>>) -> Result<(), ImportError> {
        let Some(tag) = local_name(node) else { return Ok(()) };
        let shown = around.shown_by.as_ref().is_some_and(|s| s.target == node.id());
        if NOT_DRAWN.contains(&tag) && !(shown && tag == "symbol") {
            return Ok(());
        }
        if let Some((known, why)) = LEFT_OUT.iter().find(|(known, _)| *known == tag) {
            self.skip(known, why);
            return Ok(());
        }
        let (style, declared) = around.style.of(self.sheet.declared(node)?);
        let context = Context { style, ..(**around).clone() };
        let Some(context) = self.enter(node, tag, context, &declared)? else { return Ok(()) };
        match tag {
            "svg" | "symbol" => {
                if let Some(context) = self.viewport(node, tag, context, &declared) {
                    self.push_children(node, context);
                }
            }
            "g" | "a" => self.push_children(node, context),
            "switch" => match node.children().find(|child| local_name(*child).is_some() && is_for_us(*child)) {
                Some(child) => self.stack.push((child, Rc::new(context))),
                None => self.skip("switch", "no child is for this reader"),
            },
            "use" => self.show(node, context, &declared),
            _ => self.shape(node, tag, &context, &declared)?,
        }
        Ok(())
    }

    /// Pushes children so that the first is visited next.
    fn push_children(&mut self, node: Node<'a, 'a>, context: Context<'a>) {
        let context = Rc::new(context);
        let begin = self.stack.len();
        self.stack.extend(node.children().filter(Node::is_element).map(|child| (child, context.clone())));
        self.stack[begin..].reverse();
    }

    /// The context inside an element; `None` where it is not shown.
    fn enter(
        &mut self,
        node: Node<'a, 'a>,
        tag: &'a str,
        mut context: Context<'a>,
        declared: &Declared<'a>,
    ) -> Result<Option<Context<'a>>, ImportError> {
        let known = known_tag(tag);
        if declared.given(Property::Display) == Some("none") {
            self.skip(known, "display is none");
            return Ok(None);
        }
        context.opacity *= declared.opacity(Property::Opacity);
        if declared.opacity(Property::Opacity) == 0.0 {
            self.skip(known, "opacity is 0");
            return Ok(None);
        }
        for (property, why) in [(Property::Mask, MASK), (Property::Filter, "filters are not applied")] {
            if declared.given(property).is_some_and(|value| value != "none") {
                self.skip(known, why);
            }
        }
        let own = if transform::asks_for_own_box(declared) { self.own_box(node, context.viewport)? } else { None };
        match transform::of(declared, context.viewport, own) {
            Ok(map) => context.map *= map,
            Err(text) => {
                let line = self.line(node);
                self.drawing.notes.push(format!("{tag} (line {line}): the transform '{}' cannot be read.", cut(text)));
            }
        }
        self.check_map(node, tag, context.map)?;
        if is_flat(context.map) {
            self.skip(known, "its transform leaves no extent");
            return Ok(None);
        }
        if let Some(value) = declared.given(Property::ClipPath) {
            let placed = Placed { map: context.map, viewport: context.viewport };
            context.cut_by = self.clipped(node, value, placed, context.cut_by)?;
        }
        context.choice = self.chooser.choice(context.choice, names(node));
        let own = node.attribute((INKSCAPE, "label")).filter(|label| !label.trim().is_empty());
        if node.attribute((INKSCAPE, "groupmode")) == Some("layer") {
            context.layer = own.or(context.layer);
        }
        let is_root = node.parent().is_some_and(|parent| parent.is_root());
        if !is_root {
            let id = node.attribute("id").filter(|id| !id.trim().is_empty());
            context.id = context.alias.take().or(id).or(context.id);
        }
        Ok(Some(context))
    }

    fn check_map(&self, node: Node, tag: &str, map: Affine) -> Result<(), ImportError> {
        match map.as_coeffs().into_iter().find(|c| c.is_nan() || c.abs() > HUGE) {
            Some(c) => Err(self.refused(node, tag, c)),
            None => Ok(()),
        }
    }

    fn refused(&self, node: Node, tag: &str, number: f64) -> ImportError {
        let (line, column) = self.lines.place(node.range().start);
        let what = format!("{} has a coordinate of {number:e}", label(tag, node));
        ImportError {
            column: Some(column),
            ..ImportError::at(line, what, "correct the number, or take the element out")
        }
    }

    /// The context inside an `svg` or a `symbol`: its view box fitted to its viewport, which hides what reaches beyond it. The outermost
    /// is its own measure.
    fn viewport(
        &mut self,
        node: Node<'a, 'a>,
        tag: &str,
        mut context: Context<'a>,
        declared: &Declared<'a>,
    ) -> Option<Context<'a>> {
        let given = std::mem::take(&mut context.given_size);
        if node.parent().is_some_and(|parent| parent.is_root()) {
            return Some(context);
        }
        let Some((bounds, map, viewport)) = nested_viewport(node, declared, given, context.viewport) else {
            self.skip(known_tag(tag), "its viewport has no extent");
            return None;
        };
        if !matches!(declared.given(Property::Overflow), Some("visible" | "auto")) {
            context.cut_by = Some(self.viewport_cutter(node, tag, bounds, context.map, context.cut_by));
        }
        context.map *= map;
        context.viewport = viewport;
        Some(context)
    }

    /// The element that a `use` refers to.
    fn target(&self, node: Node<'a, 'a>) -> Option<Node<'a, 'a>> {
        self.by_id(href(node).strip_prefix('#')?)
    }

    /// By how much a `use` moves what it shows.
    fn shift(&self, declared: &Declared<'a>, viewport: Viewport) -> Affine {
        let at = |property, axis| declared.given(property).and_then(|t| viewport.length(t, axis)).unwrap_or(0.0);
        Affine::translate((at(Property::X, Axis::X), at(Property::Y, Axis::Y)))
    }

    /// Pushes what a `use` refers to.
    fn show(&mut self, node: Node<'a, 'a>, mut context: Context<'a>, declared: &Declared<'a>) {
        if !href(node).starts_with('#') {
            let why = if href(node).is_empty() { "it refers to nothing" } else { "it refers to another file" };
            return self.skip("use", why);
        }
        let Some(target) = self.target(node) else { return self.skip("use", "it refers to nothing") };
        let around = std::iter::successors(context.shown_by.as_deref(), |s| s.by.as_deref());
        let depth = context.shown_by.as_ref().map_or(0, |s| s.depth);
        if target.range().contains(&node.range().start) || around.into_iter().any(|s| s.target == target.id()) {
            return self.skip("use", "it refers to itself");
        }
        if depth == USE_DEPTH_MAX {
            return self.skip("use", "it is nested too deep");
        }
        context.map *= self.shift(declared, context.viewport);
        context.given_size = given_size(target, declared);
        context.alias = node.attribute("id").filter(|id| !id.trim().is_empty());
        let line = self.line(node);
        let by = context.shown_by.take();
        context.shown_by = Some(Rc::new(Shown { target: target.id(), line, depth: depth + 1, by }));
        self.stack.push((target, Rc::new(context)));
    }

    /// The box around the outlines of an element and of all in it, in its own coordinates; `None` where there are none.
    fn own_box(&mut self, node: Node<'a, 'a>, viewport: Viewport) -> Result<Option<Rect>, ImportError> {
        let mut found: Option<Rect> = None;
        let mut stack = vec![(node, Affine::IDENTITY, viewport, [None; 2], 0)];
        while let Some((at, mut map, mut viewport, given, depth)) = stack.pop() {
            self.expand(1)?;
            let Some(tag) = local_name(at).filter(|tag| !NOT_DRAWN.contains(tag) || *tag == "symbol") else { continue };
            let (_, declared) = Style::default().of(self.sheet.declared(at)?);
            if declared.given(Property::Display) == Some("none") {
                continue;
            }
            if at != node {
                map *= transform::of(&declared, viewport, None).unwrap_or_default();
            }
            if matches!(tag, "svg" | "symbol") {
                let Some((_, inner, within)) = nested_viewport(at, &declared, given, viewport) else { continue };
                (map, viewport) = (map * inner, within);
            }
            if tag == "use" {
                let map = map * self.shift(&declared, viewport);
                let target = self.target(at).filter(|_| depth < OWN_BOX_DEPTH_MAX);
                stack.extend(target.map(|target| (target, map, viewport, given_size(target, &declared), depth + 1)));
                continue;
            }
            let Some(outline) = self.outline(at, tag, &declared, viewport)? else {
                let children = at.children().filter(Node::is_element);
                stack.extend(children.map(|child| (child, map, viewport, [None; 2], depth)));
                continue;
            };
            let curves = outline.subpaths.iter().flat_map(|s| &s.curves);
            let bounds = curves.map(|curve| curve.transformed(map).bounds()).reduce(|a, b| a.union(b));
            found = bounds.into_iter().chain(found).reduce(|a, b| a.union(b));
        }
        Ok(found)
    }

    // ---- the drawing ----

    /// Shapes, and centre lines as asked for.
    fn drawn(mut self) -> Result<Drawing, ImportError> {
        let strokes = self.strokes;
        let mut elements = std::mem::take(&mut self.elements);
        let is_shape = |e: &Element| e.filled && !e.is_background;
        let has_lines = elements.iter().any(|e| !e.filled);
        let keep_lines = match strokes {
            Strokes::Auto => !elements.iter().any(is_shape),
            Strokes::Lines => true,
            Strokes::Area | Strokes::Ignore => false,
        };
        if strokes == Strokes::Auto && keep_lines && has_lines {
            for background in elements.iter().filter(|e| e.filled) {
                self.skip(background.tag, "a background over the whole page, beneath outlines that are only stroked");
            }
            elements.retain(|e| !e.filled);
        }
        self.drawing.fill = if elements.iter().any(|e| e.filled) { FillRule::Shapes } else { FillRule::Regions };
        let lies = |e: &Element| bounds_of_all(&e.subpaths).map(|bounds| self.cutters.on_page(bounds));
        let any_on_page = elements.iter().any(|e| e.filled && lies(e).is_some_and(|lies| lies != OnPage::Outside));
        let mut beyond = 0;
        // What is painted in each colour, by name.
        let mut areas: BTreeMap<(NameId, Colour), f64> = BTreeMap::new();
        for element in elements {
            if !element.filled && !keep_lines {
                self.skip(element.tag, "stroke only; --strokes lines keeps them");
                continue;
            }
            let Some(bounds) = bounds_of_all(&element.subpaths) else { continue };
            let on_page = if element.filled { self.cutters.on_page(bounds) } else { OnPage::Within };
            if on_page == OnPage::Outside && any_on_page {
                self.skip(element.tag, "wholly outside of the page");
                continue;
            }
            let name = self.drawing.names.intern(&element.name);
            let Left::In(clip) = self.left_of(bounds, element.cut_by, element.filled, name)? else {
                self.skip(element.tag, "cut away by a clip path or a viewport");
                continue;
            };
            if let Some(colour) = element.colour.filter(|_| element.filled) {
                let curves = element.subpaths.iter().flat_map(|s| &s.curves);
                *areas.entry((name, colour)).or_default() +=
                    curves.map(|c| c.green(bounds.center())).sum::<f64>().abs();
            }
            beyond += usize::from(on_page == OnPage::Beyond);
            if element.filled { self.add_shape(element, name, clip) } else { self.add_lines(element, name, clip) }
        }
        for (&(name, colour), area) in &areas {
            let most = self.drawing.colours.get(&name).and_then(|most| areas.get(&(name, *most)));
            if most.is_none_or(|most| area > most) {
                self.drawing.colours.insert(name, colour);
            }
        }
        if beyond > 0 {
            let done = match self.cutters.page_cuts() {
                true => "cut at its edge, as the outermost svg element says",
                false => "kept whole (overflow=\"hidden\" on the outermost svg element cuts them at its edge)",
            };
            self.drawing.notes.push(format!("Filled shapes that reach beyond the page: {beyond}; {done}."));
        }
        let masks = self.drawing.skipped.iter().filter(|s| s.why == MASK).map(|s| s.count).sum::<usize>();
        if masks > 0 {
            let note = format!("Elements with a mask: {masks}; masks are not applied, and what they hide is there.");
            self.drawing.notes.push(note);
        }
        if self.offset_error > 0.0 {
            let note = format!(
                "Outlines of strokes along curves that are neither lines nor arcs lie within {:.2e} of the true ones.",
                self.offset_error
            );
            self.drawing.notes.push(note);
        }
        if self.empty_commands > 0 {
            let (count, why) = (self.empty_commands, "of no length");
            self.drawing.skipped.push(Skipped { entity: "path command".into(), count, why: why.into() });
        }
        self.drawing.unmatched = self.chooser.unmatched();
        Ok(self.drawing)
    }

    fn add_shape(&mut self, element: Element, name: NameId, clip: Option<ClipId>) {
        let Element { subpaths, even_odd, layer, entity, last_decimal, .. } = element;
        let shape = Shape { clip, ..Shape::new(name, even_odd, entity.clone()) };
        let shape = self.drawing.shapes.push(shape);
        let curves = subpaths.into_iter().flat_map(|subpath| {
            let closing = subpath.closing();
            subpath.curves.into_iter().chain(closing)
        });
        for (curve, k) in curves.zip(1..) {
            let plain = DrawnCurve::new(curve, name, format!("{entity}, curve {k}"));
            self.drawing.curves.push(DrawnCurve { shape: Some(shape), layer, last_decimal, ..plain });
        }
    }

    fn add_lines(&mut self, element: Element, name: NameId, clip: Option<ClipId>) {
        let Element { subpaths, layer, entity, last_decimal, .. } = element;
        for (curve, k) in subpaths.into_iter().flat_map(|subpath| subpath.curves).zip(1..) {
            let plain = DrawnCurve::new(curve, name, format!("{entity}, curve {k}"));
            self.drawing.curves.push(DrawnCurve { clip, layer, last_decimal, ..plain });
        }
    }
}

/// The box around subpaths; `None` of none.
fn bounds_of_all(subpaths: &[Subpath]) -> Option<Rect> {
    subpaths.iter().flat_map(|s| &s.curves).map(|c| c.bounds()).reduce(|a, b| a.union(b))
}

/// What a `use` refers to, as written.
fn href<'a>(node: Node<'a, '_>) -> &'a str {
    node.attribute("href").or_else(|| node.attribute((XLINK, "href"))).unwrap_or("").trim()
}

/// The width and height that a `use` gives to what it shows.
fn given_size<'a>(target: Node, declared: &Declared<'a>) -> [Option<&'a str>; 2] {
    match local_name(target) {
        Some("svg" | "symbol") => [declared.given(Property::Width), declared.given(Property::Height)],
        Some(_) | None => [None; 2],
    }
}

/// The viewport of an `svg` or a `symbol` inside another: its box, the map from its own coordinates to those around it, and what lengths
/// are parts of there; `None` of one without extent.
fn nested_viewport<'a>(
    node: Node,
    declared: &Declared<'a>,
    given: [Option<&'a str>; 2],
    around: Viewport,
) -> Option<(Rect, Affine, Viewport)> {
    let read = |text: Option<&str>, axis| text.and_then(|text| around.length(text, axis));
    let side = |k: usize, property, axis, whole| {
        read(given[k], axis).or_else(|| read(declared.given(property), axis)).unwrap_or(whole)
    };
    let width = side(0, Property::Width, Axis::X, around.size.width);
    let height = side(1, Property::Height, Axis::Y, around.size.height);
    let at = |property, axis| read(declared.given(property), axis).unwrap_or(0.0);
    let origin = Point::new(at(Property::X, Axis::X), at(Property::Y, Axis::Y));
    let size = Size::new(width, height);
    let view = units::view_box(node);
    if !(width > 0.0 && height > 0.0) || view == Some(None) {
        return None;
    }
    let bounds = Rect::from_origin_size(origin, size);
    let shifted = Affine::translate(origin.to_vec2());
    Some(match view.flatten() {
        Some(view) => {
            let inner = Viewport { size: Size::new(view.w, view.h), ..around };
            (bounds, shifted * units::fit(node, view, size), inner)
        }
        None => (bounds, shifted, Viewport { size, ..around }),
    })
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
    pub fn transformed(self, map: Affine) -> Self {
        Self { curves: self.curves.iter().map(|curve: &Curve| curve.transformed(map)).collect(), ..self }
    }
}

/// The names by which an element is asked for or left out.
fn names<'a>(node: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    let given = [node.attribute("id"), node.attribute((INKSCAPE, "label"))];
    given.into_iter().flatten().filter(|name| !name.trim().is_empty())
}

/// Whether a child of a switch is for a reader that has no extensions and reads English.
fn is_for_us(node: Node) -> bool {
    let english = |list: &str| list.split(',').any(|language| language.trim().to_ascii_lowercase().starts_with("en"));
    node.attribute("requiredExtensions").is_none() && node.attribute("systemLanguage").is_none_or(english)
}

fn is_flat(map: Affine) -> bool {
    let [a, b, c, d, ..] = map.as_coeffs();
    let size = a * a + b * b + c * c + d * d;
    map.determinant().abs() <= SQUEEZE_MIN * size
}

/// The element's word, where it is one of SVG.
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

/// As much of a text of the file as a message should hold.
fn cut(text: &str) -> &str {
    text.char_indices().nth(60).map_or(text, |(end, _)| &text[..end])
}
