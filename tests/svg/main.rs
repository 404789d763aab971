//! What the SVG reader takes, what it makes of it, and how it refuses.

mod clips;
mod files;
mod overlaps;
mod shapes;
mod strokes;
mod structure;
mod style;
mod transforms;

use proptest::prelude::*;
use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Drawing, FillRule};
use squinch::geometry::Point;
use squinch::import::{self, Format, ImportError, Options, Selection, Strokes, SvgOptions, format_of};
use squinch::meshio::{self, WriteOptions, encode};
use squinch::plane::lopping::{self, refine};
use squinch::refine::Until;
use squinch::section;
use std::f64::consts::PI;
use std::io::Write;
use std::path::Path;

fn read(bytes: &[u8], format: Format, stem: &str, options: &Options) -> Result<Drawing, ImportError> {
    section::drawn(import::read(bytes, format, stem, options)?, &section::Options::default())
}

const OPEN: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
 xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" viewBox="0 0 100 100">"#;

fn attempt(text: &str, svg: SvgOptions) -> Result<Drawing, ImportError> {
    read(text.as_bytes(), Format::Svg, "stem", &Options { svg, ..Options::default() })
}

fn file(text: &str) -> Drawing {
    attempt(text, SvgOptions::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// A file of 100 × 100 user units around this.
fn svg(inside: &str) -> Drawing {
    file(&format!("{OPEN}{inside}</svg>"))
}

fn stroked(inside: &str, strokes: Strokes) -> Drawing {
    let text = format!("{OPEN}{inside}</svg>");
    attempt(&text, SvgOptions { strokes, ..SvgOptions::default() }).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn refused(text: &str) -> ImportError {
    match attempt(text, SvgOptions::default()) {
        Err(error) => error,
        Ok(drawing) => panic!("read {} curves from {text}", drawing.curves.len()),
    }
}

fn kinds(drawing: &Drawing) -> Vec<&'static str> {
    drawing.curves.iter().map(|c| c.curve.kind()).collect()
}

/// The area that the curves of every shape go around, counter-clockwise positive.
fn areas(drawing: &Drawing) -> Vec<f64> {
    let of = |shape| {
        let curves = drawing.curves.iter().filter(|c| c.shape == Some(shape));
        curves.map(|c| c.curve.signed_area(Point::ORIGIN)).sum()
    };
    drawing.shapes.ids().map(of).collect()
}

fn names(drawing: &Drawing) -> Vec<&str> {
    drawing.shapes.iter().map(|s| drawing.names.text(s.name)).collect()
}

fn left_out(drawing: &Drawing) -> Vec<String> {
    drawing.skipped.iter().map(|s| format!("{} {}: {}", s.count, s.entity, s.why)).collect()
}

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-11 * (1.0 + b.abs()), "{a} is not {b}");
}

#[track_caller]
fn near_all(found: &[f64], wanted: &[f64]) {
    assert_eq!(found.len(), wanted.len(), "{found:?} is not {wanted:?}");
    found.iter().zip(wanted).for_each(|(a, b)| near(*a, *b));
}

#[track_caller]
fn ends(curve: &Curve, start: (f64, f64), end: (f64, f64)) {
    for (found, wanted) in [(curve.start(), start), (curve.end(), end)] {
        assert!(found.distance(Point::new(wanted.0, wanted.1)) < 1e-12, "{found} is not {wanted:?}");
    }
}

/// Every shape's curves run end to end, bit for bit.
#[track_caller]
fn closed(drawing: &Drawing) {
    for shape in drawing.shapes.ids() {
        let curves: Vec<&Curve> = drawing.curves.iter().filter(|c| c.shape == Some(shape)).map(|c| &c.curve).collect();
        let mut start = None;
        for curve in curves {
            let begin = *start.get_or_insert(curve.start());
            if curve.end() == begin {
                start = None;
            }
        }
        assert_eq!(start, None, "{} is open", drawing.shapes[shape].entity);
    }
}

fn path(d: &str) -> Drawing {
    let drawing = svg(&format!(r#"<path d="{d}"/>"#));
    closed(&drawing);
    drawing
}

/// Regions by name with their areas, of shapes that overlap.
fn regions(drawing: &Drawing, fragments: bool) -> Vec<(String, f64)> {
    let options = ArrangeOptions { fragments, ..ArrangeOptions::default() };
    let domain = drawing.arrange(&options).expect("a domain");
    domain.regions().iter().map(|r| (domain.name(r.name).to_owned(), r.area)).collect()
}

#[track_caller]
fn regions_are(drawing: &Drawing, fragments: bool, wanted: &[(&str, f64)]) {
    let found = regions(drawing, fragments);
    assert_eq!(found.iter().map(|r| r.0.as_str()).collect::<Vec<_>>(), wanted.iter().map(|r| r.0).collect::<Vec<_>>());
    near_all(&found.iter().map(|r| r.1).collect::<Vec<_>>(), &wanted.iter().map(|r| r.1).collect::<Vec<_>>());
}
