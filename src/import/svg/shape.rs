//! Shapes: the outline, paint, name and layer of an element.

use super::super::ImportError;
use super::path::{HUGE, Outline, Subpath};
use super::style::{self, Declared, Painted, Property};
use super::units::{Axis, Viewport};
use super::walk::{Context, USE_DEPTH_MAX};
use super::{
    BACKGROUND, BACKGROUND_SLACK, Drawn, Element, Painting, Reader, Strokes, bounds_of_all, known_tag, label,
    local_name, path_data, stroke,
};
use crate::domain::Layer;
use crate::geometry::{Point, Vec2};
use crate::ids::{Colour, Id, LayerId};
use kurbo::Affine;
use roxmltree::Node;

impl<'a> Reader<'a> {
    /// Draws an element that has an outline, or counts why it does not.
    pub(super) fn shape(
        &mut self,
        node: Node<'a, 'a>,
        tag: &'a str,
        context: &Context<'a>,
        declared: &Declared<'a>,
    ) -> Result<(), ImportError> {
        let known = known_tag(tag);
        let Some(outline) = self.outline(node, tag, declared, context.viewport)? else {
            self.skip(known, "it is not an element that SVG draws");
            return Ok(());
        };
        if !context.style.visible {
            self.skip(known, "visibility is hidden");
            return Ok(());
        }
        if !self.chooser.allows(context.choice) {
            self.skip(known, "not of the layers that were asked for");
            return Ok(());
        }
        let markers = [Property::Marker, Property::MarkerStart, Property::MarkerMid, Property::MarkerEnd];
        if markers.into_iter().any(|m| declared.get(m).is_some_and(|value| value != "none")) {
            self.skip(known, "markers are not drawn");
        }
        if let Some(number) = outline.huge {
            return Err(self.refused(node, tag, number));
        }
        let what = label(tag, node);
        let shown = context.shown_by.as_ref().map_or(String::new(), |s| format!(", shown by use (line {})", s.line));
        let entity = format!("{what} (line {}{shown})", self.line(node));
        if let Some((at, why)) = &outline.broken {
            self.note_broken(node, known, &entity, *at, why);
        }
        self.empty_commands += outline.empty;
        if outline.subpaths.is_empty() {
            if outline.broken.is_none() {
                self.skip(known, "it has no extent");
            }
            return Ok(());
        }
        if context.shown_by.is_some() {
            self.expand(outline.subpaths.iter().map(|s| s.curves.len()).sum())?;
        }
        self.paint(known, outline, entity, context, declared)
    }

    /// Draws the fill of an element, and its stroke as a line or as an area.
    fn paint(
        &mut self,
        known: &'static str,
        outline: Outline,
        entity: String,
        context: &Context<'a>,
        declared: &Declared<'a>,
    ) -> Result<(), ImportError> {
        let fill = self.painting(known, context.style.fill());
        let stroke = self.painting(known, context.style.stroke());
        // An outline on one line encloses no area.
        let filled = fill.is_some() && outline.subpaths.iter().any(|s| !s.is_flat());
        let covered = match stroke.clone().filter(|_| self.strokes == Strokes::Area) {
            Some(name) => Some((name, self.covered(&outline.subpaths, context, declared, &entity)?)),
            None => None,
        };
        if !filled && stroke.is_none() {
            self.skip(known, if fill.is_some() { "its fill has no extent" } else { "neither filled nor stroked" });
            return Ok(());
        }
        if filled || covered.is_none() {
            let paint = if filled { fill } else { stroke }.unwrap_or_default();
            let subpaths = outline.subpaths.into_iter().map(|s| s.transformed(context.map)).collect();
            let last_decimal = outline.last_decimal * libm::sqrt(context.map.determinant().abs());
            let entity = entity.clone();
            self.add_element(
                known,
                context,
                Drawn { subpaths, filled, is_stroke: !filled, paint, entity, last_decimal },
            );
        }
        if let Some((paint, subpaths)) = covered {
            let entity = format!("the stroke of {entity}");
            let stroke = Drawn { subpaths, filled: true, is_stroke: true, paint, entity, last_decimal: 0.0 };
            self.add_element(known, context, stroke);
        }
        Ok(())
    }

    /// The area of an element's stroke, in the drawing's coordinates.
    fn covered(
        &mut self,
        subpaths: &[Subpath],
        context: &Context<'a>,
        declared: &Declared<'a>,
        entity: &str,
    ) -> Result<Vec<Subpath>, ImportError> {
        let pen = context.style.pen(context.viewport);
        // Where no transform acts on the stroke, the outline is mapped first.
        let is_fixed = declared.given(Property::VectorEffect) == Some("non-scaling-stroke");
        let (before, after) = if is_fixed { (context.map, Affine::IDENTITY) } else { (Affine::IDENTITY, context.map) };
        let drawn: Vec<Subpath> = subpaths.iter().map(|s| s.clone().transformed(before)).collect();
        let covered = pen.cover(&drawn);
        if covered.is_solid {
            self.drawing.notes.push(format!("{entity}: its dashes are too many, and its stroke was drawn solid."));
        }
        if covered.is_inexact {
            let error = stroke::OFFSET_ERROR * pen.width * libm::sqrt(after.determinant().abs());
            self.offset_error = self.offset_error.max(error);
        }
        self.expand(covered.outlines.iter().map(|s| s.curves.len()).sum())?;
        Ok(covered.outlines.into_iter().map(|s| s.transformed(after)).collect())
    }

    /// Adds a painted outline.
    fn add_element(&mut self, tag: &'static str, context: &Context<'a>, drawn: Drawn) {
        let Drawn { subpaths, filled, is_stroke, paint, entity, last_decimal } = drawn;
        let is_background = filled && !self.elements.iter().any(|e| e.filled) && self.covers_page(&subpaths);
        let name = match context.layer.or(context.id) {
            Some(given) => given.to_owned(),
            None if is_background => BACKGROUND.to_owned(),
            None => paint.name,
        };
        let opacity = if is_stroke { context.style.stroke_opacity } else { context.style.fill_opacity };
        let colour = paint.mean.map(|[r, g, b, a]| {
            Colour([r, g, b, a * opacity * context.opacity].map(|part| libm::round(255.0 * part) as u8))
        });
        let even_odd = context.style.even_odd && !is_stroke;
        let layer = context.layer.map(|name| self.layer(name));
        let cut_by = context.cut_by;
        let element = Element {
            subpaths,
            tag,
            filled,
            even_odd,
            name,
            layer,
            cut_by,
            colour,
            is_background,
            entity,
            last_decimal,
        };
        self.elements.push(element);
    }

    /// Whether an outline is a rectangle over the whole page.
    fn covers_page(&self, subpaths: &[Subpath]) -> bool {
        let ([subpath], Some(page)) = (subpaths, self.cutters.page_bounds()) else { return false };
        let Some(bounds) = bounds_of_all(subpaths) else { return false };
        let slack = BACKGROUND_SLACK * libm::hypot(page.width(), page.height());
        let is_box = subpath.curves.iter().all(|c| {
            let along = c.end() - c.start();
            c.is_straight() && (along.x == 0.0 || along.y == 0.0)
        });
        is_box && bounds.inflate(slack, slack).union(page) == bounds.inflate(slack, slack)
    }

    /// The layer of this name, with one more element.
    fn layer(&mut self, name: &'a str) -> LayerId {
        let next = LayerId::from_index(self.drawing.layers.len());
        let id = *self.layers.entry(name).or_insert(next);
        if id == next {
            self.drawing.layers.push(Layer { name: name.to_owned(), ..Layer::default() });
        }
        *self.drawing.layers[id].line_types.entry(String::new()).or_default() += 1;
        id
    }

    /// Notes an error in the data of a path, polyline or polygon, and counts the data after it as left out.
    fn note_broken(&mut self, node: Node, tag: &'static str, entity: &str, at: Option<usize>, why: &str) {
        let place = self.data_place(node, tag, at);
        let shown = place.map_or(String::new(), |(line, column)| format!(" at line {line}, column {column}"));
        self.drawing.notes.push(format!("{entity}: drawn up to the error in its data{shown}: {why}."));
        self.skip(tag, "in part: what follows an error in its data");
        if self.broken.is_none() {
            let (line, column) = place.unwrap_or_else(|| self.lines.place(node.range().start));
            let what = format!("{entity} has an error in its data, and nothing before it can be drawn: {why}");
            let help = "correct the data, or save the drawing again with the program that made it";
            self.broken = Some(ImportError { column: Some(column), ..ImportError::at(line, what, help) });
        }
    }

    /// A paint, if it is visible.
    fn painting(&mut self, tag: &'static str, painted: Painted<'a>) -> Option<Painting> {
        let plain = |name: String| Painting { mean: style::rgba(&name), name };
        match painted {
            Painted::No => None,
            Painted::Colour(name) => Some(plain(name)),
            Painted::Server(id, fallback) => match self.by_id(id).and_then(|server| local_name(server)) {
                None => fallback.map(plain),
                Some("linearGradient" | "radialGradient") => {
                    let mean = self.mean_of_stops(id)?;
                    Some(Painting { name: id.to_owned(), mean: Some(mean) })
                }
                Some(kind) => {
                    if kind == "pattern" {
                        self.skip(tag, "patterns are not drawn; the outline is filled whole");
                    }
                    Some(Painting { name: id.to_owned(), mean: None })
                }
            },
        }
    }

    /// The mean colour of a gradient along its stops. Without stops of its own the gradient has those that it refers
    /// to. Without any stop it paints nothing.
    fn mean_of_stops(&self, id: &'a str) -> Option<[f64; 4]> {
        let is_stop = |node: &Node| local_name(*node) == Some("stop");
        let mut chain = std::iter::successors(self.by_id(id), |gradient| self.target(*gradient)).take(USE_DEPTH_MAX);
        let holder = chain.find(|gradient| gradient.children().any(|child| is_stop(&child)))?;
        let mut stops: Vec<(f64, [f64; 4])> = Vec::new();
        for stop in holder.children().filter(is_stop) {
            let declared = self.sheet.declared(stop).ok()?;
            let mut colour = declared.given(Property::StopColor).and_then(style::rgba).unwrap_or([0.0, 0.0, 0.0, 1.0]);
            colour[3] *= declared.opacity(Property::StopOpacity);
            let offset = stop.attribute("offset").and_then(style::share).unwrap_or(0.0);
            let before = stops.last().map_or(0.0, |last| last.0);
            stops.push((offset.max(before), colour));
        }
        let (first, last) = (*stops.first()?, *stops.last()?);
        // The first and the last colour extend to the ends.
        let whole: Vec<_> = [(0.0, first.1)].into_iter().chain(stops).chain([(1.0, last.1)]).collect();
        let mut mean = [0.0; 4];
        for pair in whole.windows(2) {
            let width = 0.5 * (pair[1].0 - pair[0].0);
            (0..4).for_each(|k| mean[k] += width * (pair[0].1[k] + pair[1].1[k]));
        }
        Some(mean.map(|part: f64| part.clamp(0.0, 1.0)))
    }

    /// Line and column of an error in the data of a path, if known.
    fn data_place(&self, node: Node, tag: &str, at: Option<usize>) -> Option<(usize, usize)> {
        let name = if tag == "path" { "d" } else { "points" };
        let attribute = node.attribute_node(name)?;
        let raw = &self.text[attribute.range_value()];
        // Where the file writes characters as entities, columns are unknown. The beginning of the data is given
        // instead.
        let plain = raw.chars().count() == attribute.value().chars().count();
        let offset = match at {
            Some(at) if plain => raw.char_indices().nth(at).map_or(raw.len(), |(byte, _)| byte),
            None if plain => raw.len(),
            _ => 0,
        };
        Some(self.lines.place(attribute.range_value().start + offset))
    }

    /// The outline of an element in its own coordinates; `None` where the element is not a shape.
    pub(super) fn outline(
        &self,
        node: Node<'a, 'a>,
        tag: &str,
        declared: &Declared<'a>,
        viewport: Viewport,
    ) -> Result<Option<Outline>, ImportError> {
        let mut huge = None;
        let mut length = |text: Option<&str>, axis| -> Option<f64> {
            let value = viewport.length(text?, axis)?;
            huge = huge.or((value.abs() > HUGE).then_some(value));
            Some(value)
        };
        let mut pair = |x: Option<&str>, y: Option<&str>| {
            Point::new(length(x, Axis::X).unwrap_or(0.0), length(y, Axis::Y).unwrap_or(0.0))
        };
        let given = |property| declared.given(property);
        let corner = |name| node.attribute(name);
        let outline = match tag {
            "path" => Outline::of_path(path_data(given(Property::D).unwrap_or(""))),
            "polyline" | "polygon" => Outline::of_points(node.attribute("points").unwrap_or(""), tag == "polygon"),
            "line" => Outline::of_line(pair(corner("x1"), corner("y1")), pair(corner("x2"), corner("y2"))),
            "rect" => {
                let at = pair(given(Property::X), given(Property::Y));
                let size = pair(given(Property::Width), given(Property::Height)).to_vec2();
                // If one radius is given, it counts for both. A negative one counts as not given.
                let radius = |value: Option<f64>| value.filter(|r| *r >= 0.0);
                let rx = radius(length(given(Property::Rx), Axis::X));
                let ry = radius(length(given(Property::Ry), Axis::Y));
                Outline::of_rect(at, size, Vec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)))
            }
            "circle" => {
                let center = pair(given(Property::Cx), given(Property::Cy));
                let radius = length(given(Property::R), Axis::Both).unwrap_or(0.0);
                Outline::of_ellipse(center, Vec2::new(radius, radius))
            }
            "ellipse" => {
                let center = pair(given(Property::Cx), given(Property::Cy));
                let (rx, ry) = (length(given(Property::Rx), Axis::X), length(given(Property::Ry), Axis::Y));
                Outline::of_ellipse(center, Vec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0)))
            }
            _ => return Ok(None),
        };
        match huge {
            Some(number) => Err(self.refused(node, tag, number)),
            None => Ok(Some(outline)),
        }
    }
}
