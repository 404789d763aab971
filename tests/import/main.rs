//! What the readers take, what they make of it, and how they refuse.

mod airfoils;
mod files;
mod outlines;
mod poly;

use proptest::prelude::*;
use squinch::curve::{Curve, End};
use squinch::domain::{Drawing, DrawnCurve, FillRule, SeedKind, SizeRequest};
use squinch::geometry::Point;
use squinch::import::{self, Format, ImportError, format_of, outline};
use squinch::section::{self, TrailingEdge};
use std::path::{Path, PathBuf};

/// How a file is read, and a section drawn.
#[derive(Default)]
struct Options {
    airfoil: section::Options,
    nodes: Option<Vec<u8>>,
}

fn read(bytes: &[u8], format: Format, stem: &str, options: &Options) -> Result<Drawing, ImportError> {
    let told = import::Options { nodes: options.nodes.clone(), ..import::Options::default() };
    section::drawn(import::read(bytes, format, stem, &told)?, &options.airfoil)
}

fn section_only() -> Options {
    airfoil(TrailingEdge::Keep, 0.0, 0.0)
}

fn airfoil(trailing_edge: TrailingEdge, far_field: f64, incidence_deg: f64) -> Options {
    Options { airfoil: section::Options { trailing_edge, far_field, incidence_deg, chord: None }, ..Options::default() }
}

fn dat(text: &str) -> Drawing {
    read(text.as_bytes(), Format::Airfoil, "stem", &section_only()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn refused(text: &str, format: Format) -> ImportError {
    match read(text.as_bytes(), format, "stem", &section_only()) {
        Err(error) => error,
        Ok(drawing) => panic!("read {} curves from {text}", drawing.curves.len()),
    }
}

fn curves<'a>(drawing: &'a Drawing, name: &str) -> Vec<&'a Curve> {
    let id = drawing.names.find(name);
    drawing.curves.iter().filter(|c| Some(c.name) == id).map(|c| &c.curve).collect()
}

fn one<'a>(drawing: &'a Drawing, name: &str) -> &'a Curve {
    let found = curves(drawing, name);
    assert_eq!(found.len(), 1, "{name}");
    found[0]
}

fn noted(drawing: &Drawing, part: &str) -> bool {
    drawing.notes.iter().any(|n| n.contains(part))
}

/// Upper and lower surface from the nose, a cambered section of 12 % with a gap of 0.2 % of the chord.
fn surfaces() -> [Vec<(f64, f64)>; 2] {
    let xs = [0.0, 0.0125, 0.05, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.95, 1.0];
    let half = [0.0, 0.02, 0.036, 0.05, 0.0595, 0.06, 0.055, 0.046, 0.034, 0.019, 0.009, 0.001];
    let camber = |x: f64| 0.0625 * x * (1.0 - x);
    [1.0, -1.0].map(|side| (0..xs.len()).map(|i| (xs[i], camber(xs[i]) + side * half[i])).collect())
}

fn contour() -> Vec<(f64, f64)> {
    let [upper, lower] = surfaces();
    upper.into_iter().rev().chain(lower.into_iter().skip(1)).collect()
}

fn lines(points: &[(f64, f64)]) -> String {
    points.iter().map(|(x, y)| format!(" {x:.6}  {y:.6}\n")).collect()
}

fn poly(text: &str) -> Drawing {
    read(text.as_bytes(), Format::Poly, "stem", &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

const SQUARE: &str = "# a square in a square
8 2 1 1  # attributes and markers
0 0 0 7.5 1
1 4 0 7.5 1

2 4 4 7.5 1
3 0 4 7.5 1
4 1 1 7.5 0
5 2 1 7.5 0
6 2 2 7.5 0
7 3 3 7.5 9
7 1
0 0 1 5
1 1 2 5
2 2 3 -2
3 3 0 0
4 4 5 0
5 5 6 0
6 6 4 0
1
0 1.5 1.2
2
0 0.5 0.5 3 0.25
1 3.5 3.5 2.5 -1
";

fn json(text: &str) -> Drawing {
    read(text.as_bytes(), Format::Outline, "stem", &Options::default()).unwrap_or_else(|e| panic!("{e}"))
}

const EVERYTHING: &str = r#"{
  "$schema": "outline.schema.json", "squinch": 1, "title": "all", "unit": "mm", "unit_from": "by hand", "fill": "nonzero",
  "names": ["second", "first"],
  "curves": [
    { "name": "first", "line": [[0, 0.1], [1, 0]] },
    { "polyline": [[0, 0], [1, 0], [1, 1]], "entity": "steps" },
    { "name": "second", "polygon": [[0, 0], [1, 0], [1, 1]] },
    { "name": "a", "arc": { "center": [1, 2], "radius": 3, "start_deg": 30, "sweep_deg": -100 } },
    { "name": "a", "arc": { "center": [1, 2], "radius": 3, "start_rad": 0.1, "sweep_rad": 0.7 } },
    { "name": "a", "arc": { "from": [0, 0], "through": [1, 1], "to": [2, 0.5] } },
    { "name": "a", "arc": { "from": [0, 0], "to": [2, 0.5], "bulge": -0.3 } },
    { "name": "a", "arc": { "center": [1, 0], "radius": 1, "start_deg": 180, "sweep_deg": 360, "ends": [[0, 0], [0, 0]] } },
    { "name": "c", "circle": { "center": [0.1, 0.2], "radius": 0.3 } },
    { "name": "e", "ellipse": { "center": [0, 0], "radii": [2, 1], "rotation_deg": 33 } },
    { "name": "e", "ellipse": { "center": [0, 0], "u": [1, 0.1], "v": [0.3, 1], "start_rad": 0.1, "sweep_rad": 2 } },
    { "name": "b", "bezier": [[0, 0], [1, 2], [3, 1], [4, 0], [5, 5]] },
    { "name": "b", "rational_bezier": { "points": [[1, 0], [1, 1], [0, 1]], "weights": [1, 0.7, 1] } },
    { "name": "n", "nurbs": { "degree": 2, "knots": [0, 0, 0, 0.3, 1, 1, 1], "points": [[0, 0], [1, 1], [2, 0], [3, 1]] } },
    { "name": "n", "nurbs": { "degree": 1, "knots": [0, 0, 1, 2, 2], "points": [[0, 0], [1, 1], [2, 0]], "weights": [1, 2, 1] } },
    { "name": "s", "spline": [[0, 0], [1, 0.7], [2, 0], [3, 0.1]] },
    { "name": "s", "closed_spline": [[0, 0], [1, 0.1], [1.1, 1], [0.2, 1]] },
    { "name": "k", "clothoid": { "from": [1, 0.5], "heading_deg": 30, "curvature": [0, -0.7], "length": 2 } },
    { "name": "k", "clothoid": { "from": [1, 0.5], "heading_rad": 2.5, "curvature": [-3, 2], "length": 3.1 } }
  ],
  "points": [{ "at": [0.5, 0.5] }, { "at": [0.25, 0.5], "name": "probe", "entity": "p" }],
  "seeds": [{ "at": [0.1, 0.1], "hole": true }, { "at": [0.2, 0.1], "region": "steel", "max_area": 0.3, "entity": "r" }],
  "sizes": [{ "edge": 0.5 }, { "edge": 0.1, "boundary": "a" }, { "edge": 0.2, "region": "steel" },
            { "edge": 0.05, "near": [[0, 0], [1, 0]], "grade": 0.3 }],
  "skipped": [{ "entity": "TEXT", "count": 3, "why": "no curve" }],
  "notes": ["made by \"hand\""]
}"#;

#[track_caller]
fn round_trips(drawing: &Drawing) {
    let text = outline::to_json(drawing);
    let again = json(&text);
    // An outline tells last decimals by its numbers, and has neither layers nor handles.
    let told = |drawing: &Drawing| -> Vec<DrawnCurve> {
        let plain = |drawn: &DrawnCurve| DrawnCurve { layer: None, handle: None, last_decimal: 0.0, ..drawn.clone() };
        drawing.curves.iter().map(plain).collect()
    };
    assert_eq!(told(&again), told(drawing));
    assert_eq!(again.points, drawing.points);
    assert_eq!(again.seeds, drawing.seeds);
    assert_eq!(again.sizes, drawing.sizes);
    assert_eq!(again.skipped, drawing.skipped);
    assert_eq!(again.names, drawing.names);
    assert_eq!((again.fill, &again.unit, &again.notes), (drawing.fill, &drawing.unit, &drawing.notes));
    assert_eq!((&again.title, &again.format), (&drawing.title, &drawing.format));
    // Equal numbers may differ in the sign of zero; equal text does not.
    assert_eq!(outline::to_json(&again), text);
}

fn seeds() -> Vec<Vec<u8>> {
    let [upper, lower] = surfaces();
    vec![
        format!("Name\n{}", lines(&contour())).into_bytes(),
        format!("Name\n12 12\n\n{}\n{}999 999\n{}", lines(&upper), lines(&lower), lines(&contour())).into_bytes(),
        SQUARE.as_bytes().to_vec(),
        EVERYTHING.as_bytes().to_vec(),
    ]
}
