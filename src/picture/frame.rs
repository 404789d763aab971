//! The map from the drawing to pixels, and the removal of what is far outside.

use super::path::{Path, Pixel, px};
use crate::geometry::{Point, Rect};

/// The map from the drawing to pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The visible part, in the drawing's units.
    view: Rect,
    /// Pixels for each unit.
    scale: f64,
    /// The box of the view in pixels.
    plot: Rect,
    /// How far strokes, balls and dots may extend beyond the box, in pixels; 0 for a window of a larger drawing.
    rim: f64,
}

impl Frame {
    /// Fits `view` into a box of `width` pixels and at most `height_max`, with its upper left corner at `corner`. A
    /// narrower view is centred.
    pub fn new(view: Rect, corner: Pixel, width: f64, height_max: f64) -> Self {
        let (w, h) = (view.width().abs(), view.height().abs());
        let side = w.max(h);
        // A single point has a box of its own magnitude, or of one unit at the origin.
        let side = if side > 0.0 && side.is_finite() { side } else { view.x0.abs().max(view.y0.abs()).max(1.0) };
        // A flat view gets 1/50 of its length, so that a straight line has room for its stroke.
        let (w, h) = (w.clamp(side / 50.0, side), h.clamp(side / 50.0, side));
        let centre = view.center();
        let scale = (width / w).min(height_max / h);
        let plot = Rect::new(corner.x, corner.y, corner.x + width, corner.y + h * scale);
        // If the view is narrower than the box, more of the plane is visible on both sides.
        let half = (width / scale / 2.0, h / 2.0);
        let view = Rect::new(centre.x - half.0, centre.y - half.1, centre.x + half.0, centre.y + half.1);
        Self { view, scale, plot, rim: 0.0 }
    }

    /// The frame with a rim of this many pixels around its box, for strokes.
    pub fn with_rim(self, rim: f64) -> Self {
        Self { rim, ..self }
    }

    /// The box of the view in pixels.
    pub fn plot(&self) -> Rect {
        self.plot
    }

    /// The box with its rim. Layers are clipped to it.
    pub fn window(&self) -> Rect {
        self.plot.inflate(self.rim, self.rim)
    }

    /// Pixels for each unit of the drawing.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A place of the drawing in pixels.
    pub fn pixel(&self, p: Point) -> Pixel {
        px(self.plot.x0 + (p.x - self.view.x0) * self.scale, self.plot.y1 - (p.y - self.view.y0) * self.scale)
    }

    /// The box enlarged by its own size. Nothing outside of it is visible, with strokes and dashes.
    fn reach(&self) -> Rect {
        let rim = self.plot.width().max(self.plot.height());
        self.plot.inflate(rim, rim)
    }

    /// Adds a polyline without the stretches far outside of the box.
    pub fn add_line(&self, path: &mut Path, line: &[Pixel]) {
        let reach = self.reach();
        let mut run: Vec<Pixel> = Vec::new();
        for ab in line.windows(2) {
            match clip_segment(ab[0], ab[1], reach) {
                Some((a, b)) => {
                    if run.last() != Some(&a) {
                        path.add(run.drain(..), false);
                        run.push(a);
                    }
                    run.push(b);
                }
                None => path.add(run.drain(..), false),
            }
        }
        path.add(run, false);
    }

    /// Adds a polygon, clipped far outside of the box.
    pub fn add_polygon(&self, path: &mut Path, corners: &[Pixel]) {
        let reach = self.reach();
        if corners.iter().all(|&p| inside(p, reach)) {
            path.add(corners.iter().copied(), true);
        } else {
            path.add(clip_polygon(corners, reach), true);
        }
    }

    /// Whether the box around some places meets the box of the view.
    pub fn sees(&self, places: &[Pixel]) -> bool {
        let range = |f: fn(&Pixel) -> f64| {
            places.iter().map(f).fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
        };
        let ((x0, x1), (y0, y1)) = (range(|p| p.x), range(|p| p.y));
        x1 >= self.plot.x0 && x0 <= self.plot.x1 && y1 >= self.plot.y0 && y0 <= self.plot.y1
    }
}

fn inside(p: Pixel, r: Rect) -> bool {
    p.x >= r.x0 && p.x <= r.x1 && p.y >= r.y0 && p.y <= r.y1
}

/// The part of a segment inside a box (Liang & Barsky 1984).
fn clip_segment(a: Pixel, b: Pixel, r: Rect) -> Option<(Pixel, Pixel)> {
    if inside(a, r) && inside(b, r) {
        return Some((a, b));
    }
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    for (step, room) in [(-dx, a.x - r.x0), (dx, r.x1 - a.x), (-dy, a.y - r.y0), (dy, r.y1 - a.y)] {
        if step == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if step < 0.0 {
            t0 = t0.max(room / step);
        } else {
            t1 = t1.min(room / step);
        }
    }
    // The comparison is false for NaN, which leaves such an end out.
    (t0 <= t1).then(|| {
        let at = |t: f64| px(a.x + dx * t, a.y + dy * t);
        (if t0 > 0.0 { at(t0) } else { a }, if t1 < 1.0 { at(t1) } else { b })
    })
}

/// The part of a polygon inside a box (Sutherland & Hodgman 1974).
fn clip_polygon(corners: &[Pixel], r: Rect) -> Vec<Pixel> {
    let sides: [&dyn Fn(Pixel) -> f64; 4] = [&|p| p.x - r.x0, &|p| r.x1 - p.x, &|p| p.y - r.y0, &|p| r.y1 - p.y];
    let mut polygon: Vec<Pixel> = corners.iter().copied().filter(|p| p.x.is_finite() && p.y.is_finite()).collect();
    for room in sides {
        let Some(&last) = polygon.last() else { break };
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        let mut a = last;
        for &b in &polygon {
            let (da, db) = (room(a), room(b));
            if (da < 0.0) != (db < 0.0) {
                let t = da / (da - db);
                kept.push(px(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t));
            }
            if db >= 0.0 {
                kept.push(b);
            }
            a = b;
        }
        polygon = kept;
    }
    polygon
}
