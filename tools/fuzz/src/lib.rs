//! What the fuzz targets ask of squinch: no panic, no endless work, and no result that its own checks deny. See README.md beside.

pub mod sketch;

use sketch::Sketch;
use squinch::domain::{ArrangeOptions, Domain, Drawing, FillRule, Loose, Naming, Unarranged};
use squinch::geometry::{magnitude, scaled};
use squinch::import::{DxfOptions, Format, LineTypes, Strokes};
use squinch::meshio;
use squinch::options::Switch;
use squinch::run::request::{Keep, Request};
use squinch::run::{self, Exit, Extent, Outcome, Plan, Source};
use squinch::section::{self, TrailingEdge};
use squinch::watch::{Progress, no_clock};
use std::collections::BTreeMap;

/// Questions to the watch before a run is told to stop: by count, so that a find does not depend on the machine.
const STEPS: usize = 20_000;
/// A drawing with more curves than this takes too long for a fuzzer to learn from.
const CURVES: usize = 60;
/// Vertices that a mesh may have.
const VERTICES: usize = 3000;

/// A watch that says stop after [`STEPS`] questions.
fn budget() -> impl FnMut(&Progress) -> bool {
    let mut left = STEPS;
    move |_| {
        left = left.saturating_sub(1);
        left > 0
    }
}

/// A file, and how it is read and arranged: as its last byte says, where it is one that no text ends with (0x80 and above); else by default.
/// So a drawing is its own seed, and a seed with a byte more asks for something else.
fn file_and_request(bytes: &[u8]) -> (&[u8], Request) {
    let (file, choice) = match bytes.split_last() {
        Some((&last, file)) if last >= 0x80 => (file, last),
        _ => (bytes, 0),
    };
    let chosen = |bit: u8| choice & (1 << bit) != 0;
    let request = Request {
        max_vertices: VERTICES,
        airfoil: section::Options {
            far_field: if chosen(0) { 0.0 } else { 2.0 },
            trailing_edge: if chosen(1) { TrailingEdge::Sharp } else { TrailingEdge::Keep },
            chord: chosen(2).then_some(3.0),
            ..section::Options::default()
        },
        strokes: if chosen(0) { Strokes::Area } else { Strokes::Auto },
        dxf: DxfOptions {
            flatten_z: if chosen(1) { Switch::On } else { Switch::Off },
            line_types: if chosen(2) { LineTypes::All } else { LineTypes::Edges },
        },
        names: if chosen(3) { Naming::Outline } else { Naming::Layer },
        close: chosen(4).then_some(0.01),
        loose: if chosen(5) { Loose::Drop } else { Loose::Auto },
        keep: if chosen(6) { Keep::All } else { Keep::Inside },
        ..Request::default()
    };
    (file, request)
}

/// Reads bytes as each of some formats: a drawing or an error, whatever they are.
pub fn read(bytes: &[u8], formats: &[Format]) {
    let (bytes, request) = file_and_request(bytes);
    for &format in formats {
        let source = Source { path: "fuzz", bytes, format: Some(format), nodes: None, of_many: false };
        match run::read(&source, &request) {
            Ok(drawing) => {
                assert!(drawing.curves.iter().all(|c| c.curve.start().is_finite() && c.curve.end().is_finite()))
            }
            Err(error) => assert!(!error.what.is_empty() && !error.help.is_empty(), "{error:?}"),
        }
    }
}

/// Reads bytes as a mesh file: of the format that they look like, else as the two that no first bytes tell. A byte 0xff parts a `.ele` file
/// from the files beside it.
pub fn read_mesh(bytes: &[u8]) {
    let guessed = meshio::Format::sniff(bytes);
    for format in guessed.map_or(vec![meshio::Format::Stl, meshio::Format::Triangle], |format| vec![format]) {
        let several = format.reading().is_some_and(|reading| !reading.beside.is_empty());
        let mut files = bytes.split(|&b| b == 0xff && several);
        let main = files.next().unwrap_or_default();
        let beside: Vec<_> = files.map(|file| Some(file.to_vec())).collect();
        match meshio::read(main, format, &beside) {
            Ok(file) => {
                // Whatever is read can be verified.
                Plan::without_domain(&Request::default()).verify_file(None, &file.mesh);
            }
            Err(error) => assert!(!error.what.is_empty() && !error.help.is_empty(), "{error:?}"),
        }
    }
}

/// Arranges a sketch: the domain keeps its promises, has as many faces as Euler counts, and is the same at another power of two.
pub fn arrange(sketch: &Sketch) {
    let (drawing, options) = (&sketch.drawing, &sketch.arrange_options());
    let arranged = drawing.arrange_watched(options, &mut budget());
    let other = at_scale(drawing, SCALE).arrange_watched(
        &ArrangeOptions { tolerance: options.tolerance.map(|t| t * SCALE), ..options.clone() },
        &mut budget(),
    );
    match (arranged, other) {
        (Ok(domain), Ok(other)) => {
            assert_eq!(domain.flaws(), [""; 0]);
            // Faces of shapes are regions by name.
            let all_kept = options.keep_all || options.fill == Some(FillRule::Regions) && drawing.seeds.is_empty();
            if all_kept && drawing.shapes.is_empty() {
                check_faces(&domain);
            }
            if options.fill == Some(FillRule::Shapes) && !options.keep_all && drawing.seeds.is_empty() {
                check_paint(drawing, options, &domain);
            }
            assert_eq!(domain.curves().as_slice(), other.scaled(1.0 / SCALE).curves().as_slice(), "at another scale");
        }
        (Err(Unarranged::Invalid(error)), Err(Unarranged::Invalid(_))) => {
            assert!(!error.what.is_empty() && !error.help.is_empty() && error.at.is_finite(), "{error:?}");
        }
        (Err(Unarranged::Stopped(_)), Err(Unarranged::Stopped(_))) => {}
        (one, other) => panic!("{:?} at one scale, {:?} at another", one.err(), other.err()),
    }
}

/// A power of two that leaves every number of a sketch exact.
const SCALE: f64 = 1024.0 * 1024.0;

fn at_scale(drawing: &Drawing, factor: f64) -> Drawing {
    let mut other = drawing.clone();
    other.curves.iter_mut().for_each(|c| c.curve = c.curve.scaled(factor));
    other.points.iter_mut().for_each(|p| p.at = scaled(p.at, factor));
    other.seeds.iter_mut().for_each(|s| s.at = scaled(s.at, factor));
    other
}

/// What is seen of each shape has the area of its fragments, by the topmost, and nothing hidden is left in it.
fn check_paint(drawing: &Drawing, options: &ArrangeOptions, domain: &Domain) {
    let Ok(fragments) = drawing.arrange_watched(&ArrangeOptions { fragments: true, ..options.clone() }, &mut budget())
    else {
        return;
    };
    let seen = |domain: &Domain| {
        let mut areas: BTreeMap<String, f64> = BTreeMap::new();
        for region in domain.regions().iter() {
            let topmost = domain.name(region.name).split('+').next().unwrap_or_default();
            *areas.entry(topmost.to_owned()).or_default() += region.area;
        }
        areas
    };
    let lengths = fragments.curves().iter().map(|c| c.curve.length() + 1.0).sum::<f64>();
    let slack = 8.0 * lengths * fragments.tolerance();
    let mut apart = seen(&fragments);
    seen(domain).into_iter().for_each(|(name, area)| *apart.entry(name).or_default() -= area);
    assert!(apart.values().all(|change| change.abs() <= slack), "{apart:?} beyond {slack:e}");
    let hidden = domain.curves().iter().find(|c| c.sides[0].is_some() && c.sides[0] == c.sides[1]);
    assert!(hidden.is_none(), "{hidden:?} is hidden");
}

/// Euler: where every bounded face is kept, there are curves − points + components of them.
fn check_faces(domain: &Domain) {
    let mut component: Vec<usize> = (0..domain.points().len()).collect();
    let root = |component: &[usize], mut p: usize| {
        while component[p] != p {
            p = component[p];
        }
        p
    };
    let mut components = component.len();
    for curve in domain.curves().iter() {
        let [a, b] = curve.ends.map(|end| root(&component, end.0 as usize));
        if a != b {
            component[a] = b;
            components -= 1;
        }
    }
    let faces = domain.curves().len() + components - domain.points().len();
    assert_eq!(domain.regions().len(), faces, "faces by Euler's formula");
}

/// Meshes a sketch, within a budget: the run ends without a fault of ours, and a mesh covers the area that the curves enclose.
pub fn mesh(sketch: &Sketch) {
    let request = sketch.request(VERTICES);
    let outcome = run::run_drawing(&sketch.drawing, &request, Extent::Whole(&mut budget()), &no_clock);
    check_outcome(&outcome, &request);
}

/// Reads, arranges, meshes and verifies bytes, of the format that they look like.
pub fn mesh_file(bytes: &[u8]) {
    let (bytes, request) = file_and_request(bytes);
    let Some(format) = Format::sniff(bytes) else { return };
    let source = Source { path: "fuzz", bytes, format: Some(format), nodes: None, of_many: false };
    if run::read(&source, &request).is_ok_and(|drawing| drawing.curves.len() <= CURVES) {
        let outcome = run::run(&source, &request, Extent::Whole(&mut budget()), &no_clock);
        check_outcome(&outcome, &request);
    }
}

fn check_outcome(outcome: &Outcome, request: &Request) {
    assert_ne!(outcome.exit, Exit::Bug, "{:?}", outcome.report.failure);
    if let Some(failure) = &outcome.report.failure {
        assert!(!failure.what.is_empty() && !failure.help.is_empty(), "{failure:?}");
    }
    let (Some(domain), Some(mesh)) = (&outcome.domain, &outcome.mesh) else {
        assert_ne!(outcome.exit, Exit::Done, "done, but no mesh");
        return;
    };
    // Faces that shapes, seeds or texts name are one region where the name is the same.
    if request.keep == Keep::All && domain.regions().iter().all(|region| !region.is_named) {
        check_faces(domain);
    }
    // Area of the triangles between corners, and of what lies between a curve and its mesh edge on the sides that are kept.
    let mut area = 0.0;
    for t in mesh.triangles.ids() {
        let [a, b, c] = mesh.corners(t);
        area += 0.5 * (b - a).cross(c - a);
    }
    let (mut gross, mut border) = (area, 0.0);
    for edge in &mesh.edges {
        let Some(link) = edge.link else { continue };
        let curve = &domain.curves()[link.curve];
        let kept = |side: usize| f64::from(u8::from(curve.sides[side].is_some()));
        let part = curve.curve.part(link.t[0], link.t[1]);
        let between = part.signed_area(part.start());
        area += (kept(0) - kept(1)) * between;
        gross += between.abs();
        border += part.start().distance(part.end());
    }
    let rounding = 16.0 * f64::EPSILON * magnitude(domain.bounds()) * border;
    assert!((area - domain.area()).abs() <= 1e-9 * gross + rounding, "area {area} instead of {}", domain.area());
}
