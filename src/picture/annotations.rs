//! Marks on a picture and the text below it: markers of repairs, and the legend.

use super::PictureOptions;
use super::canvas::{Anchor, Canvas, Colour, Label, Paint, Stroke, text_width};
use super::legend::{Legend, Scale};
use super::markers::{Mended, markers};
use super::palette::{FAINT, INK, area_colour, line_stroke};
use super::path::{Path, Pixel, px};
use super::sheet::Sheet;
use super::words::clipped;
use crate::geometry::Rect;

/// Half a marker's height, in pixels at a width of 1200.
const RADIUS: f64 = 8.0;
/// Names shown before "and n more".
const LEGEND_NAMES_MAX: usize = 36;

/// Characters of a name in a legend.
const NAME_MAX: usize = 40;
/// An entry of the legend: a swatch and its text.
struct Chip {
    at: Pixel,
    text: String,
    swatch: Swatch,
}

enum Swatch {
    Marker(Mended),
    Line(usize),
    Area(Colour),
    None,
}

impl Sheet {
    /// Marks each repair within the window.
    pub fn repairs(&mut self, options: &PictureOptions) {
        let radius = self.pen(RADIUS);
        let markers = markers(self.canvas.frame(), options, 3.0 * radius);
        if markers.is_empty() {
            return;
        }
        self.canvas.layer("repairs", true);
        for marker in &markers {
            self.marker(marker.mended, self.pixel(marker.at), radius);
        }
        for marker in markers.iter().filter(|marker| marker.count > 1) {
            self.label(marker.at, &format!("×{}", marker.count), marker.mended.colour(), false);
        }
    }

    /// Draws a marker on a white rim, which makes it visible on lines of any colour. It is dashed where nothing was
    /// repaired.
    pub fn marker(&mut self, mended: Mended, at: Pixel, radius: f64) {
        let (shape, closed) = mended.shape(at, radius);
        let mut outline = Path::default();
        outline.add(shape, closed);
        let (rim, pen) =
            (Stroke::new(Colour::hex(0xffffff), self.pen(4.2)), Stroke::new(mended.colour(), self.pen(1.9)));
        let pen = if mended.left { pen.dashed(self.pen(3.2), self.pen(1.6)) } else { pen };
        self.canvas.path(outline.clone(), Paint::stroke(rim));
        self.canvas.path(outline, Paint::stroke(pen));
    }
}

impl Sheet {
    /// The top of the legend, in pixels.
    pub fn legend_top(&self) -> f64 {
        self.canvas.frame().plot().y1 + self.margin
    }

    /// The height of the legend, in pixels.
    pub fn legend_height(&self, legend: &Legend) -> f64 {
        let scale = if legend.scale.is_some() { self.type_px * 5.4 } else { 0.0 };
        let chips = self.chips(legend).last().map_or(0.0, |c| c.at.y - self.legend_top() + self.type_px * 0.4);
        chips.max(self.type_px * 1.4) + scale
    }

    /// Caption, then markers, areas and lines. Each row is filled from the left.
    fn chips(&self, legend: &Legend) -> Vec<Chip> {
        let swatches = (0..).zip(&legend.areas).map(|(i, name)| (Swatch::Area(area_colour(i)), name));
        let lines = (0..).zip(&legend.lines).map(|(i, name)| (Swatch::Line(i), name));
        let all = legend.areas.len() + legend.lines.len();
        let mut wanted: Vec<(Swatch, String)> = vec![(Swatch::None, self.caption.clone())];
        wanted.extend(legend.markers.iter().map(|(mended, text)| (Swatch::Marker(*mended), text.clone())));
        if legend.crowded {
            wanted.push((Swatch::None, "×n: n beside each other, marked by the rarest".into()));
        }
        wanted.extend(swatches.chain(lines).take(LEGEND_NAMES_MAX).map(|(s, name)| (s, clipped(name, NAME_MAX))));
        if all > LEGEND_NAMES_MAX {
            wanted.push((Swatch::None, format!("and {} more", all - LEGEND_NAMES_MAX)));
        }
        let mut chips: Vec<Chip> = Vec::new();
        let mut at = px(self.margin, self.legend_top() + self.type_px);
        for (swatch, text) in wanted {
            let room = if matches!(swatch, Swatch::None) { 0.0 } else { self.type_px * 2.0 };
            let width = room + text_width(&text, self.type_px) + self.type_px * 1.6;
            if at.x > self.margin && (at.x + width > self.width - self.margin || chips.len() == 1) {
                at = px(self.margin, at.y + self.type_px * 1.6);
            }
            chips.push(Chip { at, text, swatch });
            at.x += width;
        }
        chips
    }

    /// Adds marks, frame, caption and legend, and returns the canvas.
    pub fn finish(mut self, options: &PictureOptions, legend: &Legend) -> Canvas {
        self.repairs(options);
        self.marks(&options.marks);
        self.canvas.layer("legend", false);
        let chips = self.chips(legend);
        let below = chips.last().map_or(self.legend_top(), |c| c.at.y) + self.type_px * 1.2;
        for Chip { at, text, swatch } in chips {
            let (w, mid) = (self.type_px * 1.5, at.y - self.type_px * 0.36);
            let room = match swatch {
                Swatch::None => 0.0,
                Swatch::Marker(mended) => {
                    self.marker(mended, px(at.x + 0.5 * w, mid), self.type_px * 0.5);
                    self.type_px * 2.0
                }
                Swatch::Line(class) => {
                    let mut path = Path::default();
                    path.add([px(at.x, mid), px(at.x + w, mid)], false);
                    self.canvas.path(path, Paint::stroke(line_stroke(class, self.pen(3.0))));
                    self.type_px * 2.0
                }
                Swatch::Area(colour) => {
                    let half = self.type_px * 0.45;
                    let paint = Paint::fill(colour, 1.0).and_stroke(Stroke::new(FAINT, self.pen(0.7)));
                    self.canvas.rect(Rect::new(at.x, mid - half, at.x + w, mid + half), paint);
                    self.type_px * 2.0
                }
            };
            self.canvas.text(Label::new(px(at.x + room, at.y), text, self.type_px));
        }
        if let Some(scale) = &legend.scale {
            self.scale(scale, below);
        }
        self.canvas
    }

    /// A histogram whose bars have the colours of the scale.
    fn scale(&mut self, scale: &Scale, top: f64) {
        let (left, size) = (self.margin.round(), self.type_px * 0.8);
        let (floor, tall) = ((top + self.type_px * 2.2).round(), self.type_px * 1.9);
        let most = scale.counts.iter().copied().max().unwrap_or(0).max(1) as f64;
        // Whole pixels, because smoothing would draw a seam between two shades.
        let step = (self.width * 0.42 / scale.counts.len().max(1) as f64).floor().max(1.0);
        let length = step * scale.counts.len() as f64;
        for (i, (&count, &shade)) in scale.counts.iter().zip(&scale.shades).enumerate() {
            let x = left + i as f64 * step;
            self.canvas.rect(Rect::new(x, floor, x + step, floor + self.type_px * 0.5), Paint::fill(shade, 1.0));
            if count > 0 {
                // At least a pixel and a half, so that a single triangle is visible.
                let bar = (tall * count as f64 / most).max(1.5);
                let ink = shade.mix(INK, 0.15);
                self.canvas.rect(Rect::new(x, floor - bar, x + step * 0.85, floor), Paint::fill(ink, 1.0));
            }
        }
        for (at, text) in &scale.ticks {
            let place = px(left + at * length, floor + self.type_px * 0.5 + size * 1.15);
            let anchor = if *at == 0.0 { Anchor::Start } else { Anchor::Middle };
            self.canvas.text(Label::new(place, text.clone(), size).anchor(anchor).colour(FAINT));
        }
        let place = px(left + length + self.type_px * 1.6, floor + self.type_px * 0.4);
        self.canvas.text(Label::new(place, scale.title, size).colour(FAINT));
    }
}
