//! A scene in pixels, written as SVG text or painted as PNG.
//!
//! A [`Frame`] maps the drawing to pixels (y upward becomes y downward). All coordinates after that are pixels, rounded
//! to hundredths, so that the text is short and the same on each machine. The SVG of a very large mesh would have
//! hundreds of megabytes. So a layer with more than `SVG_POINTS_MAX` points is painted once, pixel for pixel, and
//! embedded as an image.

use super::frame::Frame;
use super::glyphs;
use super::path::{Path, Pixel, number, px};
use crate::geometry::Rect;
use base64::Engine;
use std::io;

/// Number of points above which SVG embeds a layer as an image: about 10 bytes each, so 2 MB.
const SVG_POINTS_MAX: usize = 200_000;
/// Largest side of a picture in pixels: 8192² pixels of four bytes are 268 MB.
const SIDE_MAX: f64 = 8192.0;

/// A colour: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Colour(pub u8, pub u8, pub u8);

impl Colour {
    /// From 0xRRGGBB.
    pub const fn hex(rgb: u32) -> Self {
        Self((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
    }

    /// The mix of `self` (t = 0) and `other` (t = 1), component by component.
    pub fn mix(self, other: Self, t: f64) -> Self {
        let lerp = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * t.clamp(0.0, 1.0)).round() as u8;
        Self(lerp(self.0, other.0), lerp(self.1, other.1), lerp(self.2, other.2))
    }

    fn text(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// The style of a line. Widths and dashes are in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub colour: Colour,
    /// Width.
    pub width: f64,
    /// Opacity, from 0 to 1.
    pub opacity: f64,
    /// Lengths of dash and gap.
    pub dash: Option<[f64; 2]>,
}

impl Stroke {
    /// A solid, opaque line.
    pub const fn new(colour: Colour, width: f64) -> Self {
        Self { colour, width, opacity: 1.0, dash: None }
    }

    /// The same with an opacity.
    pub const fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// The same with dashes.
    pub const fn dashed(self, dash: f64, gap: f64) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }
}

/// The paint of an item. A fill is a colour and its opacity (even-odd).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paint {
    /// Colour and opacity of the fill.
    pub fill: Option<(Colour, f64)>,
    /// The line along the outline.
    pub stroke: Option<Stroke>,
}

impl Paint {
    /// A fill without a line.
    pub const fn fill(colour: Colour, opacity: f64) -> Self {
        Self { fill: Some((colour, opacity)), stroke: None }
    }

    /// A line without a fill.
    pub const fn stroke(stroke: Stroke) -> Self {
        Self { fill: None, stroke: Some(stroke) }
    }

    /// The same with a line.
    pub const fn and_stroke(self, stroke: Stroke) -> Self {
        Self { fill: self.fill, stroke: Some(stroke) }
    }
}

/// Which end of a text is at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Clone, Debug, PartialEq)]
enum Item {
    Path { path: Path, paint: Paint },
    Circle { at: Pixel, radius: f64, paint: Paint },
    Text(Label),
}

/// A line of text with its baseline at `at`. Sizes are in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The place.
    pub at: Pixel,
    /// The text.
    pub text: String,
    /// Font size.
    pub size: f64,
    /// Which end of the text is at the place.
    pub anchor: Anchor,
    /// Colour.
    pub colour: Colour,
    /// Whether the text has a white rim, for reading on top of a mesh.
    pub rim: bool,
}

#[derive(Clone, Debug, PartialEq)]
struct Layer {
    id: &'static str,
    /// Whether the layer is clipped to the frame.
    clip: bool,
    /// Whether fills are not smoothed: then neighbours have no hairline between them, and each pixel has one colour.
    crisp: bool,
    items: Vec<Item>,
}

/// A scene: layers, later ones on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    width: f64,
    height: f64,
    frame: Frame,
    layers: Vec<Layer>,
}

impl Canvas {
    /// A white scene of `width` × `height` pixels around a frame.
    pub fn new(width: f64, height: f64, frame: Frame) -> Self {
        let side = |v: f64| v.ceil().clamp(1.0, SIDE_MAX);
        Self { width: side(width), height: side(height), frame, layers: Vec::new() }
    }

    /// The map from the drawing to pixels.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Begins a layer for the items that follow, clipped to the frame if `clip`.
    pub fn layer(&mut self, id: &'static str, clip: bool) {
        self.layers.push(Layer { id, clip, crisp: false, items: Vec::new() });
    }

    /// Begins a layer of adjoining cells, clipped to the frame. It is not smoothed, which would show hairlines.
    pub fn layer_of_cells(&mut self, id: &'static str) {
        self.layers.push(Layer { id, clip: true, crisp: true, items: Vec::new() });
    }

    /// Adds a path to the current layer, unless it is empty.
    pub fn path(&mut self, path: Path, paint: Paint) {
        if !path.is_empty() {
            self.push(Item::Path { path, paint });
        }
    }

    /// Adds a circle to the current layer, with centre and radius in pixels. It is left out where it is far outside of
    /// the canvas, or where the radius is not between 0 and 1e7.
    pub fn circle(&mut self, at: Pixel, radius: f64, paint: Paint) {
        let reach = radius + self.frame.plot().width();
        let near = Rect::new(at.x - reach, at.y - reach, at.x + reach, at.y + reach);
        // The comparisons are false for NaN.
        if radius > 0.0 && radius < 1e7 && near.x0 <= self.width && near.x1 >= 0.0 && near.y0 <= self.height {
            self.push(Item::Circle { at, radius, paint });
        }
    }

    /// Adds a rectangle, in pixels, to the current layer.
    pub fn rect(&mut self, r: Rect, paint: Paint) {
        let mut path = Path::default();
        path.add([px(r.x0, r.y0), px(r.x1, r.y0), px(r.x1, r.y1), px(r.x0, r.y1)], true);
        self.path(path, paint);
    }

    /// Adds a line of text to the current layer.
    pub fn text(&mut self, label: Label) {
        self.push(Item::Text(label));
    }

    fn push(&mut self, item: Item) {
        if self.layers.is_empty() {
            self.layer("scene", false);
        }
        if let Some(layer) = self.layers.last_mut() {
            layer.items.push(item);
        }
    }

    /// The picture as SVG text.
    ///
    /// # Errors
    /// Where a layer that is embedded as an image does not fit into memory or cannot be encoded.
    pub fn svg(&self) -> io::Result<String> {
        let (w, h) = (number(self.width), number(self.height));
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"Helvetica, Arial, sans-serif\" fill-rule=\"evenodd\" stroke-linejoin=\"round\" \
             stroke-linecap=\"round\">\n"
        );
        let r = self.frame.window();
        let [x, y, rw, rh] = [r.x0, r.y0, r.width(), r.height()].map(number);
        let clip =
            format!("<clipPath id=\"plot\"><rect x=\"{x}\" y=\"{y}\" width=\"{rw}\" height=\"{rh}\"/></clipPath>");
        text.push_str(&format!("<defs>{clip}</defs>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"));
        for layer in self.layers.iter().filter(|l| !l.items.is_empty()) {
            let clip = if layer.clip { " clip-path=\"url(#plot)\"" } else { "" };
            let crisp = if layer.crisp { " shape-rendering=\"crispEdges\"" } else { "" };
            text.push_str(&format!("<g id=\"{}\"{clip}{crisp}>\n", layer.id));
            if layer.points() > SVG_POINTS_MAX {
                let png = encode(self.paint([layer], 1.0, None)?)?;
                let data = base64::engine::general_purpose::STANDARD.encode(png);
                text.push_str(&format!(
                    "<image width=\"{w}\" height=\"{h}\" href=\"data:image/png;base64,{data}\"/>\n"
                ));
            } else {
                for item in &layer.items {
                    item.write_svg(&mut text);
                }
            }
            text.push_str("</g>\n");
        }
        text.push_str("</svg>\n");
        Ok(text)
    }

    /// The picture as a PNG file, with `scale` image pixels for each pixel of the scene.
    ///
    /// # Errors
    /// Where the image does not fit into memory or cannot be encoded.
    pub fn png(&self, scale: f64) -> io::Result<Vec<u8>> {
        encode(self.paint(&self.layers, scale, Some(tiny_skia::Color::WHITE))?)
    }

    fn paint<'a>(
        &self,
        layers: impl IntoIterator<Item = &'a Layer>,
        scale: f64,
        ground: Option<tiny_skia::Color>,
    ) -> io::Result<tiny_skia::Pixmap> {
        let scale = scale.clamp(0.01, SIDE_MAX / self.width.max(self.height));
        let side = |v: f64| (v * scale).round().max(1.0) as u32;
        let (w, h) = (side(self.width), side(self.height));
        let too_large = || io::Error::other(format!("a picture of {w} × {h} pixels is too large"));
        let mut map = tiny_skia::Pixmap::new(w, h).ok_or_else(too_large)?;
        if let Some(colour) = ground {
            map.fill(colour);
        }
        let transform = tiny_skia::Transform::from_scale(scale as f32, scale as f32);
        let mut mask = tiny_skia::Mask::new(w, h).ok_or_else(too_large)?;
        let r = self.frame.window();
        let plot = tiny_skia::Rect::from_ltrb(r.x0 as f32, r.y0 as f32, r.x1 as f32, r.y1 as f32);
        if let Some(plot) = plot {
            let path = tiny_skia::PathBuilder::from_rect(plot);
            mask.fill_path(&path, tiny_skia::FillRule::EvenOdd, true, transform);
        }
        for layer in layers {
            let mask = layer.clip.then_some(&mask);
            for item in &layer.items {
                item.paint(&mut map, transform, mask, !layer.crisp);
            }
        }
        Ok(map)
    }
}

fn encode(map: tiny_skia::Pixmap) -> io::Result<Vec<u8>> {
    map.encode_png().map_err(io::Error::other)
}

impl Layer {
    fn points(&self) -> usize {
        let points = |item: &Item| if let Item::Path { path, .. } = item { path.points() } else { 1 };
        self.items.iter().map(points).sum()
    }
}

impl Paint {
    fn attributes(&self) -> String {
        let mut text = match self.fill {
            None => " fill=\"none\"".to_owned(),
            Some((colour, opacity)) if opacity >= 1.0 => format!(" fill=\"{}\"", colour.text()),
            Some((colour, opacity)) => format!(" fill=\"{}\" fill-opacity=\"{}\"", colour.text(), number(opacity)),
        };
        if let Some(s) = self.stroke {
            text.push_str(&format!(" stroke=\"{}\" stroke-width=\"{}\"", s.colour.text(), number(s.width)));
            if s.opacity < 1.0 {
                text.push_str(&format!(" stroke-opacity=\"{}\"", number(s.opacity)));
            }
            if let Some([dash, gap]) = s.dash {
                text.push_str(&format!(" stroke-dasharray=\"{} {}\"", number(dash), number(gap)));
            }
        }
        text
    }

    fn paint(
        &self,
        path: &tiny_skia::Path,
        map: &mut tiny_skia::Pixmap,
        transform: tiny_skia::Transform,
        mask: Option<&tiny_skia::Mask>,
        smooth: bool,
    ) {
        if let Some((colour, opacity)) = self.fill {
            let paint = tiny_skia::Paint { anti_alias: smooth, ..skia_paint(colour, opacity) };
            map.fill_path(path, &paint, tiny_skia::FillRule::EvenOdd, transform, mask);
        }
        if let Some(s) = self.stroke {
            let stroke = tiny_skia::Stroke {
                width: s.width as f32,
                line_cap: tiny_skia::LineCap::Round,
                line_join: tiny_skia::LineJoin::Round,
                dash: s.dash.and_then(|d| tiny_skia::StrokeDash::new(d.map(|v| v as f32).to_vec(), 0.0)),
                ..Default::default()
            };
            map.stroke_path(path, &skia_paint(s.colour, s.opacity), &stroke, transform, mask);
        }
    }
}

fn skia_paint(colour: Colour, opacity: f64) -> tiny_skia::Paint<'static> {
    let mut paint = tiny_skia::Paint::default();
    paint.set_color_rgba8(colour.0, colour.1, colour.2, (opacity.clamp(0.0, 1.0) * 255.0).round() as u8);
    paint
}

impl Item {
    fn write_svg(&self, text: &mut String) {
        match self {
            Self::Path { path, paint } => {
                text.push_str(&format!("<path d=\"{}\"{}/>\n", path.data(), paint.attributes()));
            }
            Self::Circle { at, radius, paint } => {
                let [x, y, r] = [at.x, at.y, *radius].map(number);
                text.push_str(&format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"{}/>\n", paint.attributes()));
            }
            Self::Text(label) => label.write_svg(text),
        }
    }

    fn paint(
        &self,
        map: &mut tiny_skia::Pixmap,
        transform: tiny_skia::Transform,
        mask: Option<&tiny_skia::Mask>,
        smooth: bool,
    ) {
        match self {
            Self::Path { path, paint } => {
                if let Some(path) = path.to_skia() {
                    paint.paint(&path, map, transform, mask, smooth);
                }
            }
            Self::Circle { at, radius, paint } => {
                if let Some(path) = tiny_skia::PathBuilder::from_circle(at.x as f32, at.y as f32, *radius as f32) {
                    paint.paint(&path, map, transform, mask, smooth);
                }
            }
            Self::Text(label) => {
                let Some(path) = label.strokes().to_skia() else { return };
                if label.rim {
                    let rim = Stroke::new(Colour(255, 255, 255), label.size * 0.32).opacity(0.85);
                    Paint::stroke(rim).paint(&path, map, transform, mask, smooth);
                }
                let pen = Stroke::new(label.colour, label.size * glyphs::PEN);
                Paint::stroke(pen).paint(&path, map, transform, mask, smooth);
            }
        }
    }
}

impl Label {
    /// A black text that begins at a place.
    pub fn new(at: Pixel, text: impl Into<String>, size: f64) -> Self {
        Self { at, text: text.into(), size, anchor: Anchor::Start, colour: Colour::hex(0x2b3440), rim: false }
    }

    /// The same with another anchor.
    pub fn anchor(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    /// The same with a colour.
    pub fn colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// The same with a white rim.
    pub fn rim(self) -> Self {
        Self { rim: true, ..self }
    }

    fn write_svg(&self, text: &mut String) {
        let [x, y, size] = [self.at.x, self.at.y, self.size].map(number);
        let anchor = match self.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let mut line = |paint: &str| {
            text.push_str(&format!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{anchor}{paint}>"));
            push_escaped(text, &self.text);
            text.push_str("</text>\n");
        };
        if self.rim {
            // A second text below the first, because not all viewers support `paint-order`.
            line(" fill=\"none\" stroke=\"#fff\" stroke-width=\"3\"");
        }
        line(&format!(" fill=\"{}\"", self.colour.text()));
    }

    /// The text as pen strokes, for painting without fonts.
    fn strokes(&self) -> Path {
        let left = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => text_width(&self.text, self.size) / 2.0,
            Anchor::End => text_width(&self.text, self.size),
        };
        let mut path = Path::default();
        let mut x = self.at.x - left;
        for c in self.text.chars() {
            glyphs::strokes(c, |line| {
                path.add(line.map(|(gx, gy)| px(x + gx * self.size, self.at.y - gy * self.size)), false);
            });
            x += glyphs::advance(c) * self.size;
        }
        path
    }
}

/// Width of a text in pixels: exact in PNG, an estimate in SVG, whose font depends on the viewer.
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().map(glyphs::advance).sum::<f64>() * size
}

/// Appends text as XML character data; characters that XML 1.0 cannot hold become U+FFFD.
fn push_escaped(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(c),
        }
    }
}
