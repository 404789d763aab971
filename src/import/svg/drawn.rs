//! From painted elements to the drawing: which are shapes, which are lines, and the notes about them.

use super::super::ImportError;
use super::clip::{CutterId, Left, OnPage};
use super::{Element, MASK, Reader, Strokes, bounds_of_all};
use crate::domain::{Drawing, DrawnCurve, FillRule, Shape, Skipped};
use crate::ids::{ClipId, Colour, NameId};
use std::collections::{BTreeMap, BTreeSet};

/// The reason why an element is counted but not drawn.
const CUT_AWAY: &str = "cut away by a clip path or a viewport";

impl Reader<'_> {
    /// The shapes, and the centre lines as asked for.
    pub(super) fn drawn(mut self) -> Result<Drawing, ImportError> {
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
        let (mut beyond, mut cut_away) = (0, None);
        // The area painted in each colour, by name.
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
            let clip = match self.left_of(bounds, element.cut_by, element.filled, name)? {
                Left::In(clip) => clip,
                Left::Nothing(by) => {
                    cut_away.get_or_insert(by);
                    self.skip(element.tag, CUT_AWAY);
                    continue;
                }
            };
            if let Some(colour) = element.colour.filter(|_| element.filled) {
                let curves = element.subpaths.iter().flat_map(|s| &s.curves);
                *areas.entry((name, colour)).or_default() +=
                    curves.map(|c| c.signed_area(bounds.center())).sum::<f64>().abs();
            }
            beyond += usize::from(on_page == OnPage::Beyond);
            if element.filled { self.add_shape(element, name, clip) } else { self.add_lines(element, name, clip) }
        }
        self.give_colours(&areas);
        if let (Some(by), true) = (cut_away, self.drawing.curves.is_empty()) {
            self.tell_all_cut_away(by);
        }
        self.tell(beyond);
        self.drawing.unmatched = self.chooser.unmatched();
        Ok(self.drawing)
    }

    /// Gives each name the colour that covers most of its area.
    fn give_colours(&mut self, areas: &BTreeMap<(NameId, Colour), f64>) {
        let mut several: BTreeSet<NameId> = BTreeSet::new();
        for (&(name, colour), area) in areas {
            let most = self.drawing.colours.get(&name).and_then(|most| areas.get(&(name, *most)));
            several.extend(most.map(|_| name));
            if most.is_none_or(|most| area > most) {
                self.drawing.colours.insert(name, colour);
            }
        }
        if let Some(&first) = several.first() {
            let (count, first) = (several.len(), self.drawing.names.text(first));
            let note = format!(
                "Names painted in several colours: {count}, the first '{first}'; outputs give each the colour of most of its area."
            );
            self.drawing.notes.push(note);
        }
    }

    /// Reports the clip that left nothing of the first element, where nothing is left of the whole file.
    fn tell_all_cut_away(&mut self, by: CutterId) {
        let why = format!("{CUT_AWAY}, the first by {}", self.cutters.entity(by));
        let cut = self.drawing.skipped.iter_mut().filter(|skipped| skipped.why == CUT_AWAY);
        cut.for_each(|skipped| skipped.why = why.clone());
    }

    /// Adds notes and counts about what differs from the file. `beyond` shapes reach beyond the page.
    fn tell(&mut self, beyond: usize) {
        if beyond > 0 {
            let done = match self.cutters.page_cuts() {
                true => "cut at its edge, as the outermost svg element says",
                false => "kept whole (overflow=\"hidden\" on the outermost svg element cuts them at its edge)",
            };
            self.drawing.notes.push(format!("Filled shapes that reach beyond the page: {beyond}; {done}."));
        }
        let masks = self.drawing.skipped.iter().filter(|s| s.why == MASK).map(|s| s.count).sum::<usize>();
        if masks > 0 {
            let note = format!("Elements with a mask: {masks}; masks are not applied: all of these elements is read.");
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
        if let Some(first) = &self.first_unread {
            let note = format!(
                "Values of style with functions that calculate, or variables without value: {}, the first {first}; they are not \
                 read, as if they were not given.",
                self.unread_values
            );
            self.drawing.notes.push(note);
        }
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
