//! Sections of airfoils: from the coordinates in a file to the drawing that was asked for.
//!
//! `order.rs` puts the points of an element in order, `near.rs` merges points that are too near, `weld.rs` closes gaps
//! and removes loops, `ends.rs` classifies the right end; the result is a contour (`contour.rs`). `curves.rs` makes
//! curves through it, with the trailing edge of `trailing_edge.rs`. `crossing.rs` finds where they cross, and
//! `far_field.rs` adds the circle around. [`Drawing::notes`] lists what was done.
//!
//! Accepted are either surface first, a start at the nose, a nose on the right, repeated points, points nearer than
//! their decimals resolve, and a closing point repeated or missing. Refused are text in the place of a point, a contour
//! with a missing part, and one that crosses itself. In the result x points downstream.
//!
//! **Curves.** One cubic spline (natural, centripetal) runs through the whole contour from the trailing edge over the
//! nose and back, so the nose is smooth and only the trailing edge is a corner. It is cut at the nose, the point
//! farthest from the trailing edge, into `upper` and `lower`; a blunt trailing edge is `te`. Through few or uneven
//! points the spline may cross itself. Then another interpolant replaces it: a C¹ cubic that is monotone wherever the
//! points are (Fritsch & Butland 1984), or straight lines. With several elements the names end in the number of the
//! element: `upper1`, `lower1`, `te1`, `upper2`, ….
//!
//! **Far field.** A circle `farfield` around mid-chord, the region `fluid` between, and sizes for an Euler mesh: fine
//! at nose and trailing edge, along the chord and in the wake, coarse far away. Without one (0 chords) the region is
//! the section itself: `section`, or `section1`, `section2`, ….

mod contour;
mod crossing;
mod curves;
mod ends;
mod far_field;
mod near;
mod order;
mod trailing_edge;
mod weld;

use crate::curve::Curve;
use crate::domain::{Drawing, FillRule, Seed, SeedKind, SizeRequest};
use crate::geometry::{Point, Vec2, bounds_of};
use crate::import::airfoil::{Coordinates, Sample};
use crate::import::{Found, ImportError};
use crate::options::OutOfBounds;
use contour::Contour;
use curves::{Section, inside};
use far_field::add_far_field;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The part of the chord below which a trailing edge is sharp: ten units in the sixth decimal.
const SHARP: f64 = 1e-5;

/// What becomes of the trailing edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TrailingEdge {
    /// As in the file; gaps below 1e-5 chords are rounding and closed.
    #[default]
    Keep,
    /// Ends in a point: a gap is closed by shearing both surfaces to its middle, not at all at the nose and fully at
    /// the trailing edge.
    Sharp,
    /// Ends in a straight `te`: a sharp section is cut off at 99 % chord.
    Blunt,
    /// Ends in a half circle `te`: a sharp section is cut off at 99 % chord.
    Round,
}

/// How an airfoil is set up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default)]
pub struct Options {
    /// Trailing edge of an airfoil.
    #[schemars(extend("group" = "airfoils", "value" = "HOW"))]
    pub trailing_edge: TrailingEdge,
    /// Radius of the far field in chords; 0 meshes the section itself.
    #[schemars(extend("group" = "airfoils", "value" = "R", "report" = "far_field_chords"))]
    pub far_field: f64,
    /// Angle of incidence in degrees, nose up.
    // About the quarter chord; the flow stays along +x.
    #[schemars(extend("group" = "airfoils", "value" = "DEG", "report" = "incidence_deg"))]
    #[serde(rename = "incidence")]
    pub incidence_deg: f64,
    /// Chord that the section is scaled to, about the origin of its coordinates.
    #[schemars(extend("group" = "airfoils", "value" = "C"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chord: Option<f64>,
}

impl Options {
    /// The first option that is out of its bounds.
    ///
    /// # Errors
    /// With the option and its value.
    pub fn check(&self) -> Result<(), OutOfBounds> {
        OutOfBounds::unless_positive(&[("chord", self.chord)])?;
        let is_radius = self.far_field == 0.0 || self.far_field.is_finite() && self.far_field >= 1.0;
        let why = "1 chord or more, or 0 to mesh the section itself";
        OutOfBounds::unless(is_radius, "far-field", &self.far_field, why)?;
        let is_angle = (-180.0..=180.0).contains(&self.incidence_deg);
        OutOfBounds::unless(is_angle, "incidence", &self.incidence_deg, "degrees from -180 to 180 are needed")
    }
}

impl Default for Options {
    fn default() -> Self {
        // 20 chords is the textbook minimum for the far field of a section.
        Self { trailing_edge: TrailingEdge::Keep, far_field: 20.0, incidence_deg: 0.0, chord: None }
    }
}

/// The drawing of what was found in a file: a drawing unchanged, sections drawn with the options.
///
/// # Errors
/// As [`draw`].
pub fn drawn(found: Found, options: &Options) -> Result<Drawing, ImportError> {
    match found {
        Found::Drawing(drawing) => Ok(*drawing),
        Found::Section(coordinates) => draw(coordinates, options),
        Found::Surfaces(surfaces) => {
            let what = format!("{}: this is a solid, not a drawing", surfaces.format);
            Err(ImportError::new(what, "`squinch mesh` makes a tetrahedral mesh of it"))
        }
    }
}

/// Draws the sections whose coordinates a file holds.
///
/// # Errors
/// With the line where the contour stops or crosses itself; without a line where an option is out of bounds.
pub fn draw(mut coordinates: Coordinates, options: &Options) -> Result<Drawing, ImportError> {
    options.check().map_err(|e| ImportError::new(e.to_string(), "give what is within the bounds"))?;
    let mut notes = std::mem::take(&mut coordinates.notes);
    let mut traced = trace(&coordinates)?;
    let widest = traced.contours.iter().reduce(|a, b| if b.chord() > a.chord() { b } else { a });
    if widest.is_some_and(Contour::has_nose_on_the_right) {
        mirror(&mut coordinates.elements);
        notes.push(
            "The nose was on the right: the section was mirrored, left for right, so that x points downstream.".into(),
        );
        traced = trace(&coordinates)?;
    }
    notes.extend(traced.notes);
    let by_surface = traced.contours.iter().any(|c| c.by_surface);
    let format = format!("airfoil ({})", if by_surface { "Lednicer" } else { "Selig" });
    let mut drawing =
        Drawing { format, title: coordinates.title, notes, fill: FillRule::EvenOdd, ..Drawing::default() };
    draw_contours(traced.contours, options, &mut drawing)?;
    Ok(drawing)
}

struct Traced {
    contours: Vec<Contour>,
    notes: Vec<String>,
}

fn trace(coordinates: &Coordinates) -> Result<Traced, ImportError> {
    let mut traced = Traced { contours: Vec::with_capacity(coordinates.elements.len()), notes: Vec::new() };
    for (i, element) in coordinates.elements.iter().enumerate() {
        let label = if coordinates.elements.len() > 1 { format!("Element {}: ", i + 1) } else { String::new() };
        let mut said = Vec::new();
        traced.contours.push(Contour::trace(element, coordinates.counts, &mut said)?);
        traced.notes.extend(said.into_iter().map(|note| format!("{label}{note}")));
    }
    Ok(traced)
}

/// Mirrors all elements left for right, in place.
fn mirror(elements: &mut [Vec<Sample>]) {
    let Some(bounds) = bounds_of(elements.iter().flatten().map(|s| s.at)) else { return };
    for sample in elements.iter_mut().flatten() {
        sample.at.x = bounds.x0 + bounds.x1 - sample.at.x;
    }
}

fn draw_contours(mut contours: Vec<Contour>, options: &Options, drawing: &mut Drawing) -> Result<(), ImportError> {
    if options.trailing_edge == TrailingEdge::Sharp {
        for contour in contours.iter_mut().filter(|c| !c.is_sharp()) {
            contour.sharpen(&mut drawing.notes);
        }
    }
    if let Some(chord) = options.chord {
        scale(&mut contours, chord, &mut drawing.notes);
    }
    rotate(&mut contours, options.incidence_deg);
    let mut sections = Vec::with_capacity(contours.len());
    for contour in &contours {
        sections.push(Section::build(contour, options.trailing_edge, &mut drawing.notes)?);
    }
    let (nose, tail) = reference_chord(&contours);
    let chord = (tail - nose).hypot();
    // Files are written for a chord of 1, give or take a flap.
    if options.chord.is_none() && (0.8..1.5).contains(&chord) {
        drawing.unit = Some(("chord".into(), "airfoil coordinates".into()));
    } else if options.chord.is_none() {
        drawing.notes.push(format!("The chord is {chord} in the file's units, which were kept."));
    }
    for (i, section) in sections.iter().enumerate() {
        add_section(section, &suffix(i, sections.len()), drawing);
    }
    if options.far_field > 0.0 {
        add_far_field(&sections, nose.midpoint(tail), options.far_field * chord, chord, drawing)
    } else {
        (0..sections.len()).for_each(|i| seed_section(&sections[i], &suffix(i, sections.len()), drawing));
        Ok(())
    }
}

/// The suffix of the names of an element: its number, or nothing where there is only one.
fn suffix(i: usize, n: usize) -> String {
    if n > 1 { (i + 1).to_string() } else { String::new() }
}

/// The foremost nose and the aftmost tail of all elements.
fn reference_chord(contours: &[Contour]) -> (Point, Point) {
    let noses = contours.iter().map(Contour::nose_point).reduce(|a, b| if b.x < a.x { b } else { a });
    let tails = contours.iter().map(Contour::tail).reduce(|a, b| if b.x > a.x { b } else { a });
    (noses.unwrap_or_default(), tails.unwrap_or_default())
}

/// Scales all contours about the origin to a given chord.
fn scale(contours: &mut [Contour], chord: f64, notes: &mut Vec<String>) {
    let (nose, tail) = reference_chord(contours);
    let own = (tail - nose).hypot();
    let factor = chord / own;
    contours.iter_mut().for_each(|c| c.map(|p| Point::new(factor * p.x, factor * p.y)));
    notes.push(format!("The section was scaled from a chord of {own} to one of {chord}."));
}

fn rotate(contours: &mut [Contour], incidence_deg: f64) {
    if incidence_deg == 0.0 {
        return;
    }
    let (nose, tail) = reference_chord(contours);
    let pivot = nose.lerp(tail, 0.25);
    let (sin, cos) = libm::sincos(incidence_deg.to_radians());
    let turned = |p: Point| {
        let v = p - pivot;
        pivot + Vec2::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin)
    };
    contours.iter_mut().for_each(|c| c.map(turned));
}

fn add_section(section: &Section, suffix: &str, drawing: &mut Drawing) {
    let from = format!("lines {} to {}", section.lines[0], section.lines[1]);
    drawing.add(section.upper.clone(), &format!("upper{suffix}"), from.clone());
    drawing.add(section.lower.clone(), &format!("lower{suffix}"), from.clone());
    for edge in &section.te {
        drawing.add(edge.clone(), &format!("te{suffix}"), format!("trailing edge, {from}"));
    }
    let surface = 0.015 * section.chord;
    for surface_name in ["upper", "lower"] {
        let name = drawing.names.intern(&format!("{surface_name}{suffix}"));
        drawing.sizes.push(SizeRequest::Boundary { name, edge: surface });
    }
    // The flow turns around a blunt end: at least three edges are needed to resolve it.
    let blunt: f64 = section.te.iter().map(Curve::length).sum();
    if blunt > 0.0 {
        let name = drawing.names.intern(&format!("te{suffix}"));
        drawing.sizes.push(SizeRequest::Boundary { name, edge: blunt / 3.0 });
    }
    // The grades give some ten thousand triangles around one section within 20 chords.
    for end in [section.nose, section.tail] {
        drawing.sizes.push(SizeRequest::Near { from: end, to: end, edge: 0.005 * section.chord, grade: 0.2 });
    }
}

fn seed_section(section: &Section, suffix: &str, drawing: &mut Drawing) {
    let Some(at) = inside(section) else {
        drawing.notes.push("No point inside the section was found to name its region by.".into());
        return;
    };
    let name = drawing.names.intern(&format!("section{suffix}"));
    let entity = format!("section{suffix}");
    drawing.seeds.push(Seed { at, kind: SeedKind::Region { name, max_area: None }, entity });
}
