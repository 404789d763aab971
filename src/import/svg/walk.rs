//! The traversal of the elements in the order of painting: inheritance, `use`, viewports, boxes.

use super::super::ImportError;
use super::super::selection::Choice;
use super::clip::{CutterId, Placed};
use super::path::HUGE;
use super::style::{Declared, Property, Style};
use super::units::{self, Axis, Viewport};
use super::{INKSCAPE, MASK, Reader, XLINK, cut, known_tag, label, local_name, names, transform};
use crate::geometry::{Point, Rect};
use kurbo::{Affine, Size};
use roxmltree::{Node, NodeId};
use std::rc::Rc;

/// Largest number of elements and curves that `use` may repeat in one file.
const EXPANSION_MAX: usize = 1_000_000;
/// Largest nesting of `use` in `use`.
pub(super) const USE_DEPTH_MAX: usize = 64;
/// Largest nesting of `use` when the box around an element is computed.
const OWN_BOX_DEPTH_MAX: usize = 16;

/// The state that an element inherits.
#[derive(Clone)]
pub(super) struct Context<'a> {
    /// Inherited properties.
    pub style: Style<'a>,
    /// From the element's coordinates to the drawing's.
    pub map: Affine,
    /// The viewport around it.
    pub viewport: Viewport,
    /// The cutter around it.
    pub cut_by: Option<CutterId>,
    /// The product of the opacities of all groups around it and of its own.
    pub opacity: f64,
    /// The Inkscape layer around it.
    pub layer: Option<&'a str>,
    /// The id of the nearest group around it.
    pub id: Option<&'a str>,
    /// The id that a `use` gives to the element that it shows.
    alias: Option<&'a str>,
    /// The `use` elements that show it.
    pub shown_by: Option<Rc<Shown>>,
    /// What the selection says about the names of the element and of the groups around it.
    pub choice: Choice,
    /// Width and height that a `use` gives to a symbol.
    given_size: [Option<&'a str>; 2],
}

impl Context<'_> {
    /// The state of the outermost element.
    pub fn of(viewport: Viewport, map: Affine) -> Self {
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

/// A `use`, with the `use` elements that show it.
pub(super) struct Shown {
    target: NodeId,
    /// The line of the `use`.
    pub line: usize,
    depth: usize,
    by: Option<Rc<Shown>>,
}

/// Elements that are drawn only by reference, or not at all.
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
    ("foreignObject", "it is not SVG"),
    ("animate", "animations are not played"),
    ("animateColor", "animations are not played"),
    ("animateMotion", "animations are not played"),
    ("animateTransform", "animations are not played"),
    ("set", "animations are not played"),
];

impl<'a> Reader<'a> {
    /// Visits elements in the order of painting. Without recursion, because groups may nest to any depth.
    pub(super) fn walk(&mut self, root: Node<'a, 'a>, context: Context<'a>) -> Result<(), ImportError> {
        self.stack.push((root, Rc::new(context)));
        while let Some((node, context)) = self.stack.pop() {
            if context.shown_by.is_some() {
                self.expand(1)?;
            }
            self.visit(node, &context)?;
        }
        Ok(())
    }

    /// Counts elements and curves that `use`, clips and strokes add, up to the limit.
    pub(super) fn expand(&mut self, by: usize) -> Result<(), ImportError> {
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
        let (style, declared) = self.style_of(node, &around.style)?;
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

    /// The style of an element inside one of another style, and its declarations. Unsupported values are counted.
    pub(super) fn style_of(
        &mut self,
        node: Node<'a, 'a>,
        around: &Style<'a>,
    ) -> Result<(Style<'a>, Declared<'a>), ImportError> {
        let (style, declared) = around.of(self.sheet.declared(node)?);
        self.unread_values += declared.unread.len();
        if let (None, Some((property, value))) = (&self.first_unread, declared.unread.first()) {
            let what = label(node.tag_name().name(), node);
            self.first_unread = Some(format!("'{property}: {}' of {what} (line {})", cut(value), self.line(node)));
        }
        Ok((style, declared))
    }

    /// Pushes children so that the first is visited next.
    fn push_children(&mut self, node: Node<'a, 'a>, context: Context<'a>) {
        let context = Rc::new(context);
        let begin = self.stack.len();
        self.stack.extend(node.children().filter(Node::is_element).map(|child| (child, context.clone())));
        self.stack[begin..].reverse();
    }

    /// The state inside an element; `None` where the element is not shown.
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
        if transform::is_flat(context.map) {
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

    /// Refuses a map with numbers that are too large.
    pub(super) fn check_map(&self, node: Node, tag: &str, map: Affine) -> Result<(), ImportError> {
        match map.as_coeffs().into_iter().find(|c| c.is_nan() || c.abs() > HUGE) {
            Some(c) => Err(self.refused(node, tag, c)),
            None => Ok(()),
        }
    }

    /// The refusal of a number that is too large.
    pub(super) fn refused(&self, node: Node, tag: &str, number: f64) -> ImportError {
        let (line, column) = self.lines.place(node.range().start);
        let what = format!("{} has a coordinate of {number:e}", label(tag, node));
        ImportError {
            column: Some(column),
            ..ImportError::at(line, what, "correct the number, or take the element out")
        }
    }

    /// The state inside an `svg` or a `symbol`: its view box is fitted to its viewport, which cuts what reaches beyond
    /// it. The outermost `svg` has its own size.
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
    pub(super) fn target(&self, node: Node<'a, 'a>) -> Option<Node<'a, 'a>> {
        self.by_id(href(node).strip_prefix('#')?)
    }

    /// The translation that a `use` applies.
    pub(super) fn shift(&self, declared: &Declared<'a>, viewport: Viewport) -> Affine {
        let at = |property, axis| declared.given(property).and_then(|t| viewport.length(t, axis)).unwrap_or(0.0);
        Affine::translate((at(Property::X, Axis::X), at(Property::Y, Axis::Y)))
    }

    /// Pushes the element that a `use` refers to.
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

    /// The box around the outlines of an element and its children, in the element's coordinates; `None` where there are
    /// none.
    pub(super) fn own_box(&mut self, node: Node<'a, 'a>, viewport: Viewport) -> Result<Option<Rect>, ImportError> {
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
}

/// The reference of a `use`, as written.
fn href<'a>(node: Node<'a, '_>) -> &'a str {
    node.attribute("href").or_else(|| node.attribute((XLINK, "href"))).unwrap_or("").trim()
}

/// The width and height that a `use` gives to the element that it shows.
fn given_size<'a>(target: Node, declared: &Declared<'a>) -> [Option<&'a str>; 2] {
    match local_name(target) {
        Some("svg" | "symbol") => [declared.given(Property::Width), declared.given(Property::Height)],
        Some(_) | None => [None; 2],
    }
}

/// The viewport of an `svg` or a `symbol` inside another: its box, the map from its coordinates to those around it, and
/// the viewport for lengths inside; `None` where it has no extent.
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

/// Whether a child of a `switch` suits a reader without extensions that reads English.
fn is_for_us(node: Node) -> bool {
    let english = |list: &str| list.split(',').any(|language| language.trim().to_ascii_lowercase().starts_with("en"));
    node.attribute("requiredExtensions").is_none() && node.attribute("systemLanguage").is_none_or(english)
}
