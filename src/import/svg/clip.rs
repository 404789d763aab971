//! Everything that cuts elements: clip paths, viewports, basic shapes of CSS, and the page (CSS Masking 1, SVG 2
//! section 14.4, CSS Shapes 1).
//!
//! ```text
//!   clip path A, itself cut by B           What is left of an element in A lies in one part of A and in B:
//!    ┌────────────┐
//!    │ part 1 ┌───┼────────┐                Cutter A { parts: [part 1, part 2], within: Some(B) }
//!    │   ▓▓▓▓▓│▓▓▓│        │                Cutter B { parts: […],              within: None }
//!    │   ▓▓▓▓▓│▓▓▓│   B    │
//!    └────────┼───┘        │                A viewport (`svg`, `symbol`) is a cutter of one part, its box.
//!             └────────────┘
//! ```

use super::super::ImportError;
use super::basic_shape::basic_outline;
use super::path::{Outline, Subpath};
use super::style::{Property, Style};
use super::units::Viewport;
use super::{Reader, cut, known_tag, label, local_name, transform};
use crate::domain::{Clip, DrawnCurve, Shape};
use crate::geometry::{Point, Rect, Vec2};
use crate::ids::{ClipId, NameId};
use kurbo::Affine;
use roxmltree::{Node, NodeId};

/// A region that cuts elements: the union of its parts, within another cutter.
pub(super) struct Cutter {
    within: Option<CutterId>,
    parts: Vec<Part>,
    /// The box around the region; `None` where the region is empty.
    bounds: Option<Rect>,
    /// Whether the region equals its box.
    is_box: bool,
    /// Its name in messages.
    entity: String,
}

/// The index of a cutter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct CutterId(usize);

/// A part of a cutter, in the drawing's coordinates.
struct Part {
    subpaths: Vec<Subpath>,
    even_odd: bool,
    cut_by: Option<CutterId>,
    entity: String,
}

/// The key by which a clip path is made once: the number of its element, the map, and the cutter that contains it.
type Key = (usize, [u64; 6], Option<CutterId>);

/// What cutting leaves of an element.
pub(super) enum Left {
    /// Nothing, because of this cutter.
    Nothing(CutterId),
    /// All of it, or the part in a clip.
    In(Option<ClipId>),
}

/// The cutters of a file.
#[derive(Default)]
pub(super) struct Cutters {
    all: Vec<Cutter>,
    known: std::collections::BTreeMap<Key, CutterId>,
    /// Cutters that are clips of the drawing already, by the clip that contains them.
    drawn: std::collections::BTreeMap<(CutterId, Option<ClipId>), ClipId>,
    /// The clip paths that are being read. A clip path may refer to others.
    open: Vec<NodeId>,
    page: Option<Page>,
}

/// The page of artwork. A drawing of lines only has no page edge.
#[derive(Clone, Copy)]
struct Page {
    cutter: CutterId,
    /// Whether the file says that the page cuts elements at its edge.
    cuts: bool,
}

/// The place of an element relative to the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OnPage {
    Within,
    Beyond,
    Outside,
}

/// Largest depth of clip paths that clip paths cut.
const DEPTH_MAX: usize = 16;
/// An element that exceeds a clip by less than this part of the clip's diagonal is not cut: both have the same number,
/// rounded differently.
const ROUNDING: f64 = 1e-9;
/// The same for the page: a part too small to be seen.
const BLEED: f64 = 1e-3;

/// The place of an element: the map from its coordinates to the drawing's, and its viewport.
#[derive(Clone, Copy)]
pub(super) struct Placed {
    /// From the coordinates of the element to the drawing's.
    pub map: Affine,
    /// The viewport that its lengths refer to.
    pub viewport: Viewport,
}

impl Part {
    fn bounds(&self) -> Option<Rect> {
        self.subpaths.iter().flat_map(|s| &s.curves).map(|c| c.bounds()).reduce(|a, b| a.union(b))
    }

    /// Whether the part is an axis-parallel rectangle.
    fn is_box(&self) -> bool {
        let (Some(bounds), [subpath]) = (self.bounds(), &self.subpaths[..]) else { return false };
        let curves = subpath
            .curves
            .iter()
            .chain(subpath.closing().as_ref())
            .map(|c| (c.is_straight(), c.start()))
            .collect::<Vec<_>>();
        let in_corner = |p: Point| (p.x == bounds.x0 || p.x == bounds.x1) && (p.y == bounds.y0 || p.y == bounds.y1);
        curves.len() == 4
            && curves.iter().all(|(straight, start)| *straight && in_corner(*start))
            && (0..4).all(|k| curves[k].1 != curves[(k + 2) % 4].1 && curves[k].1 != curves[(k + 1) % 4].1)
            && self.cut_by.is_none()
    }
}

/// A rectangle in coordinates that `map` takes to the drawing's.
fn box_part(bounds: Rect, map: Affine, entity: String) -> Part {
    let outline = Outline::of_rect(bounds.origin(), bounds.size().to_vec2(), Vec2::ZERO);
    let subpaths = outline.subpaths.into_iter().map(|s| s.transformed(map)).collect();
    Part { subpaths, even_odd: false, cut_by: None, entity }
}

fn diagonal(bounds: Rect) -> f64 {
    libm::hypot(bounds.width(), bounds.height())
}

impl Cutters {
    fn add(&mut self, entity: String, parts: Vec<Part>, within: Option<CutterId>) -> CutterId {
        let parts: Vec<Part> = parts.into_iter().filter(|part| !part.subpaths.is_empty()).collect();
        let bounds = parts.iter().filter_map(Part::bounds).reduce(|a, b| a.union(b));
        let is_box = parts.len() == 1 && parts[0].is_box();
        // A cutter that contains this one cuts nothing from it.
        let mut within = within;
        while let (Some(outer), Some(bounds)) = (within, bounds) {
            if !self.covers(outer, bounds, ROUNDING) {
                break;
            }
            within = self.all[outer.0].within;
        }
        self.all.push(Cutter { within, parts, bounds, is_box, entity });
        CutterId(self.all.len() - 1)
    }

    fn covers(&self, cutter: CutterId, bounds: Rect, slack: f64) -> bool {
        let Cutter { bounds: Some(own), is_box: true, .. } = self.all[cutter.0] else { return false };
        let slack = slack * diagonal(own);
        own.inflate(slack, slack).union(bounds) == own.inflate(slack, slack)
    }

    /// Whether a cutter alone leaves nothing within these bounds.
    fn misses(&self, cutter: CutterId, bounds: Rect) -> bool {
        let apart =
            |own: Rect| bounds.x0 >= own.x1 || own.x0 >= bounds.x1 || bounds.y0 >= own.y1 || own.y0 >= bounds.y1;
        self.all[cutter.0].bounds.is_none_or(apart)
    }

    /// Sets the page, where the outermost element gives its size.
    pub fn set_page(&mut self, root: Node, frame: Option<Rect>, map: Affine) {
        let Some(frame) = frame else { return };
        let hides = |word: &str| matches!(word.trim(), "hidden" | "clip" | "scroll");
        let in_style = root.attribute("style").unwrap_or("").split(';').filter_map(|d| d.split_once(':'));
        let cuts = root.attribute("overflow").is_some_and(hides)
            || in_style.into_iter().any(|(name, value)| name.trim() == "overflow" && hides(value));
        let cutter = self.add("the page".into(), vec![box_part(frame, map, "the page".into())], None);
        self.page = Some(Page { cutter, cuts });
    }

    /// The page in the drawing's coordinates.
    pub fn page_bounds(&self) -> Option<Rect> {
        self.page.and_then(|page| self.all[page.cutter.0].bounds)
    }

    /// How these bounds lie relative to the page; within it where there is no page.
    pub fn on_page(&self, bounds: Rect) -> OnPage {
        match self.page {
            Some(page) if self.misses(page.cutter, bounds) => OnPage::Outside,
            Some(page) if !self.covers(page.cutter, bounds, BLEED) => OnPage::Beyond,
            Some(_) | None => OnPage::Within,
        }
    }

    /// The name of a cutter in messages.
    pub fn entity(&self, cutter: CutterId) -> &str {
        &self.all[cutter.0].entity
    }

    /// Whether the page cuts elements at its edge.
    pub fn page_cuts(&self) -> bool {
        self.page.is_some_and(|page| page.cuts)
    }
}

impl<'a> Reader<'a> {
    // ---- cutters of elements ----

    /// The cutter of the viewport of a nested `svg` or `symbol`.
    pub(super) fn viewport_cutter(
        &mut self,
        node: Node,
        tag: &str,
        bounds: Rect,
        map: Affine,
        within: Option<CutterId>,
    ) -> CutterId {
        let entity = format!("the viewport of {} (line {})", label(tag, node), self.line(node));
        self.cutters.add(entity.clone(), vec![box_part(bounds, map, entity)], within)
    }

    /// The cutter that the property `clip-path` of an element names, within the cutter that contains the element.
    pub(super) fn clipped(
        &mut self,
        node: Node<'a, 'a>,
        value: &'a str,
        placed: Placed,
        within: Option<CutterId>,
    ) -> Result<Option<CutterId>, ImportError> {
        if value == "none" {
            return Ok(within);
        }
        if let Some(id) = url(value) {
            let target = self.by_id(id).filter(|target| local_name(*target) == Some("clipPath"));
            return match target.filter(|target| !self.cutters.open.contains(&target.id())) {
                Some(target) if self.cutters.open.len() < DEPTH_MAX => {
                    self.clip_path(target, node, placed, within).map(Some)
                }
                Some(_) | None => {
                    let line = self.line(node);
                    let note = format!(
                        "line {line}: the clip path '{}' refers to nothing or to itself; nothing is cut.",
                        cut(id)
                    );
                    self.drawing.notes.push(note);
                    Ok(within)
                }
            };
        }
        self.basic_shape(node, value, placed, within)
    }

    /// The cutter of a `clipPath` that `node` refers to.
    fn clip_path(
        &mut self,
        target: Node<'a, 'a>,
        node: Node<'a, 'a>,
        placed: Placed,
        within: Option<CutterId>,
    ) -> Result<CutterId, ImportError> {
        let Placed { mut map, mut viewport } = placed;
        let entity = format!("{} (line {})", label("clipPath", target), self.line(target));
        if target.attribute("clipPathUnits") == Some("objectBoundingBox") {
            let Some(own) = self.own_box(node, viewport)?.filter(|own| own.width() > 0.0 && own.height() > 0.0) else {
                return Ok(self.cutters.add(entity, Vec::new(), within));
            };
            map =
                map * Affine::translate(own.origin().to_vec2()) * Affine::scale_non_uniform(own.width(), own.height());
            viewport.size = kurbo::Size::new(1.0, 1.0);
        }
        let key = (target.id().get_usize(), map.as_coeffs().map(f64::to_bits), within);
        if let Some(known) = self.cutters.known.get(&key) {
            return Ok(*known);
        }
        self.cutters.open.push(target.id());
        let style = self.style_around(target)?;
        let (style, declared) = self.style_of(target, &style)?;
        map *= transform::of(&declared, viewport, None).unwrap_or_default();
        let placed = Placed { map, viewport };
        let outer = match declared.given(Property::ClipPath) {
            Some(value) => self.clipped(target, value, placed, within)?,
            None => within,
        };
        let mut parts = Vec::new();
        for child in target.children().filter(Node::is_element) {
            self.expand(1)?;
            self.add_part(child, &style, placed, None, &mut parts)?;
        }
        self.cutters.open.pop();
        let id = self.cutters.add(entity, parts, outer);
        self.cutters.known.insert(key, id);
        Ok(id)
    }

    /// The style that an element inherits.
    fn style_around(&self, node: Node<'a, 'a>) -> Result<Style<'a>, ImportError> {
        let mut above: Vec<Node> = node.ancestors().skip(1).filter(Node::is_element).collect();
        above.reverse();
        above.into_iter().try_fold(Style::default(), |style, node| Ok(style.of(self.sheet.declared(node)?).0))
    }

    /// Adds the shape of a child of a clip path: its own, or that of a `use`.
    fn add_part(
        &mut self,
        child: Node<'a, 'a>,
        style: &Style<'a>,
        placed: Placed,
        within: Option<CutterId>,
        parts: &mut Vec<Part>,
    ) -> Result<(), ImportError> {
        let Some(tag) = local_name(child) else { return Ok(()) };
        let (style, declared) = self.style_of(child, style)?;
        if declared.given(Property::Display) == Some("none") {
            return Ok(());
        }
        let own = if transform::asks_for_own_box(&declared) { self.own_box(child, placed.viewport)? } else { None };
        let map = placed.map * transform::of(&declared, placed.viewport, own).unwrap_or_default();
        self.check_map(child, tag, map)?;
        if transform::is_flat(map) {
            return Ok(());
        }
        let placed = Placed { map, ..placed };
        let cut_by = match declared.given(Property::ClipPath) {
            Some(value) => self.clipped(child, value, placed, within)?,
            None => within,
        };
        if tag == "text" {
            self.skip("text", "text has no outlines here, and cuts nothing as a clip path");
            return Ok(());
        }
        if tag == "use" {
            let target = self.target(child).filter(|target| !matches!(local_name(*target), Some("use")));
            let Some(target) = target else { return Ok(()) };
            let shift = self.shift(&declared, placed.viewport);
            return self.add_part(target, &style, Placed { map: map * shift, ..placed }, cut_by, parts);
        }
        let Some(outline) = self.outline(child, tag, &declared, placed.viewport)? else { return Ok(()) };
        if !style.visible {
            return Ok(());
        }
        if let Some(number) = outline.huge {
            return Err(self.refused(child, tag, number));
        }
        self.expand(outline.subpaths.iter().map(|s| s.curves.len()).sum())?;
        let entity = format!("{} (line {}), a clip path", label(tag, child), self.line(child));
        let subpaths = outline.subpaths.into_iter().filter(|s| !s.is_flat()).map(|s| s.transformed(map)).collect();
        parts.push(Part { subpaths, even_odd: style.clip_even_odd, cut_by, entity });
        Ok(())
    }

    /// The cutter of a basic shape of CSS.
    fn basic_shape(
        &mut self,
        node: Node<'a, 'a>,
        value: &'a str,
        placed: Placed,
        within: Option<CutterId>,
    ) -> Result<Option<CutterId>, ImportError> {
        let (shape, reference) = match value.rfind(')') {
            Some(end) => (&value[..=end], value[end + 1..].trim()),
            None => ("", value),
        };
        let entity = format!("the clip path of {} (line {})", label(node.tag_name().name(), node), self.line(node));
        let about = match reference {
            "view-box" => Some(Rect::from_origin_size((0.0, 0.0), placed.viewport.size)),
            _ => self.own_box(node, placed.viewport)?,
        };
        let Some(about) = about else { return Ok(Some(self.cutters.add(entity, Vec::new(), within))) };
        let outline = match shape {
            "" => known_box(reference)
                .then(|| (Outline::of_rect(about.origin(), about.size().to_vec2(), Vec2::ZERO), false)),
            _ => basic_outline(shape, about, placed.viewport),
        };
        let Some((outline, even_odd)) = outline else {
            self.skip(known_tag(node.tag_name().name()), "its clip path is of a kind that is not read; nothing is cut");
            return Ok(within);
        };
        let subpaths = outline.subpaths.into_iter().map(|s| s.transformed(placed.map)).collect();
        let part = Part { subpaths, even_odd, cut_by: None, entity: entity.clone() };
        Ok(Some(self.cutters.add(entity, vec![part], within)))
    }

    // ---- cutting ----

    /// What a cutter and all that contain it leave within these bounds. The page counts too, if `is_painted`.
    ///
    /// # Errors
    /// Where clips within clips come to more curves than a drawing can need.
    pub(super) fn left_of(
        &mut self,
        bounds: Rect,
        cutter: Option<CutterId>,
        is_painted: bool,
        name: NameId,
    ) -> Result<Left, ImportError> {
        let mut links = Vec::new();
        for link in std::iter::successors(cutter, |link| self.cutters.all[link.0].within) {
            if self.cutters.misses(link, bounds) {
                return Ok(Left::Nothing(link));
            }
            if !self.cutters.covers(link, bounds, ROUNDING) {
                links.push(link);
            }
        }
        if is_painted && self.cutters.page_cuts() && self.cutters.on_page(bounds) == OnPage::Beyond {
            links.extend(self.cutters.page.map(|page| page.cutter));
        }
        let drawn = |within, link| self.drawn_clip(link, within, name).map(Some);
        links.into_iter().rev().try_fold(None, drawn).map(Left::In)
    }

    /// A cutter as a clip of the drawing.
    fn drawn_clip(&mut self, cutter: CutterId, within: Option<ClipId>, name: NameId) -> Result<ClipId, ImportError> {
        if let Some(&drawn) = self.cutters.drawn.get(&(cutter, within)) {
            return Ok(drawn);
        }
        let parts = std::mem::take(&mut self.cutters.all[cutter.0].parts);
        // A clip is drawn once in each clip that contains it.
        self.expand(parts.iter().flat_map(|part| &part.subpaths).map(|s| s.curves.len()).sum())?;
        // The clips that cut its parts come first in the list.
        let mut left_of_part = |part: &Part| match part.bounds() {
            Some(bounds) => self.left_of(bounds, part.cut_by, false, name),
            None => Ok(Left::Nothing(cutter)),
        };
        let left: Vec<Left> = parts.iter().map(&mut left_of_part).collect::<Result<_, _>>()?;
        let id = self.drawing.clips.push(Clip { within });
        for (part, left) in parts.iter().zip(left) {
            let Left::In(clip) = left else { continue };
            let shape = Shape { clip, part_of: Some(id), ..Shape::new(name, part.even_odd, part.entity.clone()) };
            let shape = self.drawing.shapes.push(shape);
            for curve in part.subpaths.iter().flat_map(|s| s.curves.iter().cloned().chain(s.closing())) {
                let plain = DrawnCurve::new(curve, name, part.entity.clone());
                self.drawing.curves.push(DrawnCurve { shape: Some(shape), ..plain });
            }
        }
        self.cutters.all[cutter.0].parts = parts;
        self.cutters.drawn.insert((cutter, within), id);
        Ok(id)
    }
}

/// The id that `url(#id)` refers to.
fn url(value: &str) -> Option<&str> {
    let inner = value.strip_prefix("url(")?;
    let inner = inner[..inner.find(')')?].trim().trim_matches(['"', '\'']);
    inner.strip_prefix('#')
}

fn known_box(word: &str) -> bool {
    matches!(word, "fill-box" | "stroke-box" | "view-box" | "border-box" | "padding-box" | "content-box" | "margin-box")
}
