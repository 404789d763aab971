//! Places in a picture, and polylines of them, in hundredths of a pixel.

use std::fmt::Write;

/// Steps per pixel: finer than anything visible at a zoom of ten.
const STEPS: f64 = 100.0;

/// A place in the picture: x to the right, y downward, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// To the right, in pixels.
    pub x: f64,
    /// Downward, in pixels.
    pub y: f64,
}

/// A place in the picture.
pub const fn px(x: f64, y: f64) -> Pixel {
    Pixel { x, y }
}

/// Polylines and polygons that share one paint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// In hundredths of a pixel.
    points: Vec<[i32; 2]>,
    /// The end of each run in `points`, and whether it is closed.
    runs: Vec<(usize, bool)>,
}

impl Path {
    /// Adds a polyline, or a polygon if `closed`. Points equal to the one before are dropped.
    pub fn add(&mut self, line: impl IntoIterator<Item = Pixel>, closed: bool) {
        let first = self.points.len();
        for p in line {
            let p = [steps(p.x), steps(p.y)];
            if self.points.len() == first || self.points.last() != Some(&p) {
                self.points.push(p);
            }
        }
        if self.points.len() < first + 2 {
            self.points.truncate(first);
        } else {
            self.runs.push((self.points.len(), closed));
        }
    }

    /// How many points there are.
    pub fn points(&self) -> usize {
        self.points.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    fn runs(&self) -> impl Iterator<Item = (&[[i32; 2]], bool)> {
        let mut start = 0;
        self.runs.iter().map(move |&(end, closed)| {
            let run = &self.points[start..end];
            start = end;
            (run, closed)
        })
    }

    /// SVG path data, relative after the first point. They are sums of integers, so errors do not accumulate.
    pub fn data(&self) -> String {
        let mut text = String::with_capacity(self.points.len() * 10);
        let mut at = [0, 0];
        for (run, closed) in self.runs() {
            for (i, p) in run.iter().enumerate() {
                text.push_str(match i {
                    0 => "m",
                    1 => "l",
                    _ => " ",
                });
                push_steps(&mut text, p[0] - at[0]);
                if p[1] >= at[1] {
                    text.push(' ');
                }
                push_steps(&mut text, p[1] - at[1]);
                at = *p;
            }
            if closed {
                text.push('z');
                at = run[0];
            }
        }
        text
    }

    /// The path for painting.
    pub fn to_skia(&self) -> Option<tiny_skia::Path> {
        let mut builder = tiny_skia::PathBuilder::with_capacity(self.points.len() + self.runs.len(), self.points.len());
        for (run, closed) in self.runs() {
            for (i, p) in run.iter().enumerate() {
                let [x, y] = p.map(|v| (f64::from(v) / STEPS) as f32);
                if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
            }
            if closed {
                builder.close();
            }
        }
        builder.finish()
    }
}

/// A length in hundredths of a pixel, within ±10⁷ pixels, which fits i32.
fn steps(v: f64) -> i32 {
    (v.clamp(-1e7, 1e7) * STEPS).round() as i32
}

/// Writes hundredths as the shortest decimal: "3", "-.5", "12.25".
fn push_steps(text: &mut String, v: i32) {
    if v < 0 {
        text.push('-');
    }
    let (whole, part) = (v.unsigned_abs() / 100, v.unsigned_abs() % 100);
    let written = match (whole, part) {
        (_, 0) => write!(text, "{whole}"),
        (0, _) if part % 10 == 0 => write!(text, ".{}", part / 10),
        (0, _) => write!(text, ".{part:02}"),
        _ if part % 10 == 0 => write!(text, "{whole}.{}", part / 10),
        _ => write!(text, "{whole}.{part:02}"),
    };
    debug_assert!(written.is_ok(), "writing to a String");
}

/// A length in pixels, to hundredths, as SVG has it.
pub fn number(v: f64) -> String {
    let mut text = String::new();
    push_steps(&mut text, steps(v));
    text
}
