//! Draws curves, cells, edges, balls, points and labels. Pens scale with the width of the picture.
//!
//! Only pictures flatten curves, to a tenth of a pixel.

use super::PictureOptions;
use super::canvas::{Canvas, Colour, Label, Paint, Stroke, text_width};
use super::cells::{CellColours, corners};
use super::frame::Frame;
use super::legend::Legend;
use super::palette::{ALARM, BALL, CHALK, INK, line_stroke};
use super::path::{Path, Pixel, px};
use super::used::rank;
use super::words::clipped;
use crate::curve::{Curve, End};
use crate::domain::Domain;
use crate::geometry::{Point, Rect, Vec2};
use crate::ids::{CurveId, NameId, PointId, RegionId, VertexId};
use crate::mesh::{BallReason, Mesh};
use std::collections::BTreeMap;

/// Largest number of characters of a label beside a mark.
const MARK_MAX: usize = 60;

/// A picture while it is drawn: the canvas, the pens, and the places of labels.
pub struct Sheet {
    /// The canvas.
    pub canvas: Canvas,
    /// The caption.
    pub caption: String,
    /// Font size in pixels, from the width of the picture.
    pub type_px: f64,
    /// Width in pixels.
    pub width: f64,
    /// Margin in pixels.
    pub margin: f64,
    /// The boxes of the labels so far.
    pub labels: Vec<Rect>,
}

impl Sheet {
    /// An empty sheet for these bounds.
    pub fn new(bounds: Rect, options: &PictureOptions, caption: &str, legend: &Legend) -> Self {
        let width = f64::from(options.width_px.clamp(120, 8192));
        // At the default width of 1200: a font of 16 px, a margin of 36 px.
        let (type_px, margin) = ((width / 75.0).clamp(9.0, 22.0), width * 0.03);
        let view = options.view.unwrap_or(bounds);
        let frame = Frame::new(view, px(margin, margin), width - 2.0 * margin, width);
        let frame = if options.view.is_none() { frame.with_rim(margin * 0.9) } else { frame };
        let caption =
            if options.title.is_empty() { caption.to_owned() } else { format!("{}: {caption}", options.title) };
        let mut sheet =
            Self { canvas: Canvas::new(width, width, frame), caption, type_px, width, margin, labels: Vec::new() };
        let height = sheet.legend_top() + sheet.legend_height(legend) + margin * 0.8;
        sheet.canvas = Canvas::new(width, height, frame);
        sheet
    }

    /// A place of the drawing in pixels.
    pub fn pixel(&self, p: Point) -> Pixel {
        self.canvas.frame().pixel(p)
    }

    /// A width that is given for a picture 1200 px wide, scaled to this one.
    pub fn pen(&self, at_1200: f64) -> f64 {
        at_1200 * (self.width / 1200.0).clamp(0.5, 2.0)
    }

    // -- curves --

    /// Draws curves, each with the class of its colour.
    pub fn curves<'a>(&mut self, classes: usize, curves: impl Iterator<Item = (usize, &'a Curve)>) {
        let mut paths = vec![Path::default(); classes];
        for (class, curve) in curves {
            let line = self.flatten(curve, 0.0, 1.0);
            self.canvas.frame().add_line(&mut paths[class], &line);
        }
        self.boundary_paths(paths);
    }

    fn boundary_paths(&mut self, paths: Vec<Path>) {
        self.canvas.layer("boundary", true);
        let width = self.pen(2.4);
        for (class, path) in paths.into_iter().enumerate() {
            self.canvas.path(path, Paint::stroke(line_stroke(class, width)));
        }
    }

    /// A part of a curve as a polyline within about a tenth of a pixel, by bisection, with at most 4097 places.
    fn flatten(&self, curve: &Curve, t0: f64, t1: f64) -> Vec<Pixel> {
        let at = |t: f64| self.pixel(curve.point(t));
        if curve.as_line().is_some() {
            return vec![at(t0), at(t1)];
        }
        // It begins with eight parts, because a wave whose middle lies on the chord looks flat.
        let first: Vec<(f64, Pixel)> =
            (0..=8).map(|i| t0 + (t1 - t0) * f64::from(i) / 8.0).map(|t| (t, at(t))).collect();
        let mut line = vec![first[0].1];
        for ends in first.windows(2) {
            let mut from = ends[0];
            let mut ahead = vec![ends[1]];
            while let Some(&to) = ahead.last() {
                let t = 0.5 * (from.0 + to.0);
                let middle = at(t);
                let bent = deviation(from.1, to.1, middle) > 0.1;
                // Nine bisections of 8 parts give 4096 pieces.
                if bent && ahead.len() <= 9 {
                    ahead.push((t, middle));
                } else {
                    line.push(to.1);
                    from = to;
                    ahead.pop();
                }
            }
        }
        line
    }

    /// The outline of a region: its curves chained into closed contours. Any chaining fills the same area by even-odd.
    pub fn outline(&self, domain: &Domain, region: RegionId) -> Path {
        let mut leaving: BTreeMap<PointId, Vec<(CurveId, End)>> = BTreeMap::new();
        for (id, curve) in domain.curves().enumerate() {
            match curve.sides.map(|side| side == Some(region)) {
                [true, false] => leaving.entry(curve.ends[0]).or_default().push((id, End::Start)),
                [false, true] => leaving.entry(curve.ends[1]).or_default().push((id, End::Finish)),
                [true, true] | [false, false] => {}
            }
        }
        let mut path = Path::default();
        let starts: Vec<PointId> = leaving.keys().copied().collect();
        for start in starts {
            let mut contour = Vec::new();
            let mut at = start;
            while let Some((id, from)) = leaving.get_mut(&at).and_then(Vec::pop) {
                let curve = &domain.curves()[id];
                let mut line = self.flatten(&curve.curve, 0.0, 1.0);
                at = curve.ends[1];
                if from == End::Finish {
                    line.reverse();
                    at = curve.ends[0];
                }
                contour.extend(line);
            }
            self.canvas.frame().add_polygon(&mut path, &contour);
        }
        path
    }

    // -- meshes --

    /// Draws the triangles.
    pub fn cells(&mut self, mesh: &Mesh, colours: &CellColours) {
        let mut paths: BTreeMap<usize, Path> = BTreeMap::new();
        for (t, triangle) in mesh.triangles.enumerate() {
            let abc = corners(mesh, triangle).map(|p| self.pixel(p));
            if self.canvas.frame().sees(&abc) {
                self.canvas.frame().add_polygon(paths.entry(colours.class(t)).or_default(), &abc);
            }
        }
        self.canvas.layer_of_cells("cells");
        for (class, path) in paths {
            self.canvas.path(path, Paint::fill(colours.paint(class), 1.0));
        }
    }

    /// Draws each edge once: light where all cells around it are dark, and fainter as cells get small. Otherwise a mesh
    /// of very small cells would be black.
    pub fn edges(&mut self, mesh: &Mesh, colours: &CellColours) {
        let mut edges: Vec<([VertexId; 2], bool)> = Vec::with_capacity(mesh.triangles.len() * 3);
        for (t, &[a, b, c]) in mesh.triangles.enumerate() {
            let seen = corners(mesh, &[a, b, c]).map(|p| self.pixel(p));
            if self.canvas.frame().sees(&seen) {
                let is_dark = colours.is_dark(colours.class(t));
                edges.extend([[a, b], [b, c], [c, a]].map(|[u, v]| (if u < v { [u, v] } else { [v, u] }, is_dark)));
            }
        }
        // Of the two cells at an edge the light one comes first.
        edges.sort_unstable();
        edges.dedup_by_key(|(edge, _)| *edge);
        let mut classes: [[Path; 2]; 3] = Default::default();
        for ([u, v], is_dark) in edges {
            let [a, b] = [u, v].map(|n| self.pixel(corners(mesh, &[n, n, n])[0]));
            let length = libm::hypot(a.x - b.x, a.y - b.y);
            let class = match length / self.pen(1.0) {
                l if l >= 12.0 => 0,
                l if l >= 5.0 => 1,
                l if l >= 2.0 => 2,
                _ => continue,
            };
            self.canvas.frame().add_line(&mut classes[class][usize::from(is_dark)], &[a, b]);
        }
        self.canvas.layer("edges", true);
        for (paths, (width, opacity)) in classes.into_iter().zip([(0.8, 0.75), (0.55, 0.6), (0.35, 0.4)]) {
            for (path, (ink, share)) in paths.into_iter().zip([(INK, 1.0), (CHALK, 0.7)]) {
                let stroke = Stroke::new(ink, self.pen(width)).opacity(share * opacity);
                self.canvas.path(path, Paint::stroke(stroke));
            }
        }
    }

    /// Draws the boundary edges, along the exact curves if the domain is given.
    pub fn boundary(&mut self, mesh: &Mesh, domain: Option<&Domain>, used: &[NameId]) {
        let mut paths = vec![Path::default(); used.len()];
        for edge in &mesh.edges {
            let ends = edge.nodes.map(|v| self.pixel(corners(mesh, &[v, v, v])[0]));
            let linked = edge.link.and_then(|link| Some((domain?.curves().get(link.curve)?, link.t)));
            let line = match linked {
                Some((curve, t)) if self.near(ends) => self.flatten(&curve.curve, t[0], t[1]),
                _ => ends.to_vec(),
            };
            self.canvas.frame().add_line(&mut paths[rank(used, edge.name)], &line);
        }
        self.boundary_paths(paths);
    }

    /// Whether an edge is long enough to show its curve, and in the window. A curved edge may bulge by less than its
    /// length.
    fn near(&self, [a, b]: [Pixel; 2]) -> bool {
        let l = libm::hypot(a.x - b.x, a.y - b.y);
        l > 1.0 && self.canvas.frame().sees(&[a, b, px(a.x - l, a.y - l), px(a.x + l, a.y + l)])
    }

    /// Draws the balls.
    pub fn balls(&mut self, mesh: &Mesh) {
        self.canvas.layer("balls", true);
        let nodes: BTreeMap<PointId, Point> =
            mesh.points.iter().filter_map(|&(p, v)| Some((p, *mesh.nodes.get(v)?))).collect();
        for ball in &mesh.balls {
            let Some(&corner) = nodes.get(&ball.corner) else { continue };
            let (at, radius) = (self.pixel(corner), ball.radius * self.canvas.frame().scale());
            // A smaller circle would be a blot.
            if radius < 1.5 {
                continue;
            }
            let opacity = if ball.why == BallReason::Size { 0.6 } else { 1.0 };
            let stroke = Stroke::new(BALL, self.pen(1.5)).opacity(opacity).dashed(self.pen(5.0), self.pen(4.5));
            self.canvas.circle(at, radius, Paint::fill(BALL, 0.06).and_stroke(stroke));
        }
    }

    // -- points and labels --

    /// A dot at a place.
    pub fn dot(&mut self, p: Point, colour: Colour) {
        let (at, radius) = (self.pixel(p), self.pen(2.6));
        if self.canvas.frame().sees(&[at]) {
            self.canvas.circle(at, radius, Paint::fill(colour, 1.0));
        }
    }

    /// A ring around a place.
    pub fn ring(&mut self, p: Point, radius: f64, colour: Colour) {
        let (at, radius, width) = (self.pixel(p), self.pen(radius), self.pen(1.3));
        if self.canvas.frame().sees(&[at]) {
            self.canvas.circle(at, radius, Paint::stroke(Stroke::new(colour, width)));
        }
    }

    /// A label beside a place, on the first of four sides where it covers no other label and is inside of the picture.
    /// If there is no such side, the label is left out, unless it is `always` drawn.
    pub fn label(&mut self, p: Point, text: &str, colour: Colour, always: bool) {
        let at = self.pixel(p);
        if text.is_empty() || !self.canvas.frame().sees(&[at]) {
            return;
        }
        let size = self.type_px * 0.85;
        // A cross with its rim extends farther than a dot.
        let [beside, above] = if always { [12.0, 11.0] } else { [9.0, 7.0] };
        let (dx, up, down, width) =
            (self.pen(beside), self.pen(above), self.pen(above) + 0.7 * size, text_width(text, size));
        let sheet = Rect::new(0.0, 0.0, self.width, self.legend_top());
        let boxes = [(dx, -up), (-dx - width, -up), (dx, down), (-dx - width, down)]
            .map(|(x, y)| Rect::new(at.x + x, at.y + y - 0.75 * size, at.x + x + width, at.y + y + 0.25 * size));
        let free =
            |b: &&Rect| b.union(sheet) == sheet && self.labels.iter().all(|other| other.intersect(**b).area() == 0.0);
        let beyond = |b: Rect| Vec2::new((b.x1 - sheet.x1).max(0.0).min(b.x0), (b.y0 - sheet.y0).min(0.0));
        let moved_in = |b: Rect| b - beyond(b);
        let Some(room) = boxes.iter().find(free).copied().or(always.then(|| moved_in(boxes[0]))) else { return };
        self.labels.push(room);
        self.canvas.text(Label::new(px(room.x0, room.y1 - 0.25 * size), text, size).colour(colour).rim());
    }

    /// Draws crosses with labels.
    pub fn marks(&mut self, marks: &[(Point, String)]) {
        self.canvas.layer("marks", true);
        let arm = self.pen(7.0);
        // No label may cover a cross.
        for (p, _) in marks {
            let (at, side) = (self.pixel(*p), 2.0 * arm);
            self.labels.push(Rect::from_center_size((at.x, at.y), (side, side)));
        }
        for (p, text) in marks {
            let at = self.pixel(*p);
            let mut cross = Path::default();
            for (dx, dy) in [(arm, arm), (arm, -arm)] {
                cross.add([px(at.x - dx, at.y - dy), px(at.x + dx, at.y + dy)], false);
            }
            if self.canvas.frame().sees(&[at]) {
                let (rim, pen) = (Stroke::new(Colour::hex(0xffffff), self.pen(5.0)), Stroke::new(ALARM, self.pen(2.4)));
                self.canvas.path(cross.clone(), Paint::stroke(rim));
                self.canvas.path(cross, Paint::stroke(pen));
                self.label(*p, &clipped(text, MARK_MAX), ALARM, true);
            }
        }
    }
}

/// Distance of `p` from the line ab, or from a where a and b coincide.
fn deviation(a: Pixel, b: Pixel, p: Pixel) -> f64 {
    let (ab, ap) = ((b.x - a.x, b.y - a.y), (p.x - a.x, p.y - a.y));
    let length = libm::hypot(ab.0, ab.1);
    if length < 0.01 { libm::hypot(ap.0, ap.1) } else { (ab.0 * ap.1 - ab.1 * ap.0).abs() / length }
}
