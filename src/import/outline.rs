//! Our own curves as JSON: every kind of curve exactly, names, points, seeds and sizes. [`SCHEMA`] describes it to editors.
//!
//! ```
//! let text = r#"{ "squinch": 1, "unit": "mm", "curves": [
//!     { "name": "rim", "circle": { "center": [0, 0], "radius": 2 } },
//!     { "name": "hole", "arc": { "from": [-1, 0], "to": [1, 0], "bulge": 1 } },
//!     { "name": "hole", "line": [[1, 0], [-1, 0]] } ] }"#;
//! let drawing = squinch::import::outline::read(text.as_bytes(), "plate")?;
//! assert_eq!(drawing.curves.len(), 3);
//! // What is written reads back the same, to the last bit.
//! let again = squinch::import::outline::to_json(&drawing);
//! assert_eq!(squinch::import::outline::read(again.as_bytes(), "plate")?.curves, drawing.curves);
//! # Ok::<(), squinch::import::ImportError>(())
//! ```

use super::{Certainty, Facts, ImportError, without_bom};
use crate::curve::{Bezier, CircularArc, Curve, CurveError, EllipticArc, Spline};
use crate::domain::{Clip, Drawing, DrawnCurve, DrawnPoint, FillRule, Seed, SeedKind, Shape, SizeRequest, Skipped};
use crate::geometry::{Point, Vec2};
use crate::ids::{ClipId, Names, ShapeId};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error as _, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;
use std::fmt::{self, Display};
use std::marker::PhantomData;

/// The published JSON Schema of the format.
pub const SCHEMA: &str = include_str!("outline.schema.json");

/// The version of the format that is read and written.
const VERSION: u32 = 1;
/// Evaluation costs the square of the degree; this is where `Curve::bezier` ends too.
const MAX_DEGREE: usize = 300;
/// How far the stated ends of an arc may lie from where its angles put them, in its size: rounding of a file with six decimals.
const END_SLACK: f64 = 1e-5;
const HELP: &str = "`squinch schema outline` prints what the format holds";

type Pair = [f64; 2];

pub(super) const FACTS: Facts = Facts {
    name: "outline",
    suffixes: &["json"],
    sign: |bytes| without_bom(bytes).trim_ascii_start().starts_with(b"{"),
    certainty: Certainty::Mark,
    read: |bytes, stem, _| read(bytes, stem).map(Into::into),
};

// ---- reading ----

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(rename = "$schema")]
    _schema: Option<String>,
    squinch: u32,
    title: Option<String>,
    format: Option<String>,
    unit: Option<String>,
    unit_from: Option<String>,
    fill: Option<Fill>,
    #[serde(default)]
    sketch: bool,
    names: Option<Vec<String>>,
    #[serde(default, deserialize_with = "shapes")]
    shapes: Vec<ShapeForm>,
    #[serde(default)]
    clips: Vec<ClipForm>,
    #[serde(default, deserialize_with = "curves")]
    curves: Vec<CurveEntry>,
    #[serde(default, deserialize_with = "points")]
    points: Vec<PointForm>,
    #[serde(default, deserialize_with = "seeds")]
    seeds: Vec<SeedForm>,
    #[serde(default, deserialize_with = "sizes")]
    sizes: Vec<SizeEntry>,
    #[serde(default, deserialize_with = "skipped")]
    skipped: Vec<SkippedForm>,
    notes: Option<Vec<String>>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
enum Fill {
    NonZero,
    EvenOdd,
    Regions,
    Shapes,
    #[serde(rename = "evenodd+shapes")]
    EvenOddAndShapes,
}

/// A filled shape; curves name it by its place in the list.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ShapeForm {
    name: String,
    #[serde(default)]
    even_odd: bool,
    clip: Option<u32>,
    part_of: Option<u32>,
    entity: Option<String>,
}

/// What shapes and curves are cut by; shapes say which clip they are a part of.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClipForm {
    within: Option<u32>,
}

/// Clips whose parts are cut by clips whose parts are cut: as deep as drawings may nest them.
const CLIP_DEPTH_MAX: usize = 64;

/// One curve: exactly one of the kinds, and what it is called.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CurveForm {
    name: Option<String>,
    entity: Option<String>,
    shape: Option<u32>,
    clip: Option<u32>,
    line: Option<[Pair; 2]>,
    polyline: Option<Vec<Pair>>,
    polygon: Option<Vec<Pair>>,
    arc: Option<ArcForm>,
    circle: Option<CircleForm>,
    ellipse: Option<EllipseForm>,
    bezier: Option<Vec<Pair>>,
    rational_bezier: Option<RationalForm>,
    nurbs: Option<NurbsForm>,
    spline: Option<Vec<Pair>>,
    closed_spline: Option<Vec<Pair>>,
    piecewise_bezier: Option<PiecewiseForm>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CircleForm {
    center: Pair,
    radius: f64,
}

/// By center and angles, by three points, or by bulge.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ArcForm {
    center: Option<Pair>,
    radius: Option<f64>,
    start_deg: Option<f64>,
    sweep_deg: Option<f64>,
    start_rad: Option<f64>,
    sweep_rad: Option<f64>,
    ends: Option<[Pair; 2]>,
    from: Option<Pair>,
    through: Option<Pair>,
    to: Option<Pair>,
    bulge: Option<f64>,
}

/// By conjugate half axes, or by radii and a rotation.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EllipseForm {
    center: Pair,
    u: Option<Pair>,
    v: Option<Pair>,
    radii: Option<Pair>,
    rotation_deg: Option<f64>,
    start_deg: Option<f64>,
    sweep_deg: Option<f64>,
    start_rad: Option<f64>,
    sweep_rad: Option<f64>,
    ends: Option<[Pair; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RationalForm {
    points: Vec<Pair>,
    weights: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NurbsForm {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<Pair>,
    weights: Option<Vec<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PiecewiseForm {
    knots: Vec<f64>,
    spans: Vec<SpanForm>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpanForm {
    points: Vec<Pair>,
    weights: Option<Vec<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PointForm {
    at: Pair,
    name: Option<String>,
    entity: Option<String>,
}

/// A hole where `hole` is true, else the region of a name.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SeedForm {
    at: Pair,
    #[serde(default)]
    hole: bool,
    region: Option<String>,
    max_area: Option<f64>,
    entity: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SizeForm {
    edge: f64,
    boundary: Option<String>,
    region: Option<String>,
    near: Option<[Pair; 2]>,
    grade: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SkippedForm {
    entity: String,
    count: usize,
    why: String,
}

/// The curves that an entry stands for: several of a polyline.
struct CurveEntry {
    name: Option<String>,
    entity: Option<String>,
    shape: Option<u32>,
    clip: Option<u32>,
    curves: Vec<Curve>,
}

/// A size whose name is still text.
enum SizeEntry {
    Boundary(String, f64),
    Region(String, f64),
    Near(Point, Point, f64, f64),
    Everywhere(f64),
}

/// What an entry of a list is read as: a form that is then checked, while the reader still stands at its place.
trait Entry: Sized {
    type Form: for<'de> Deserialize<'de>;
    fn from_form(form: Self::Form) -> Result<Self, String>;
}

impl Entry for CurveEntry {
    type Form = CurveForm;
    fn from_form(form: CurveForm) -> Result<Self, String> {
        let (name, entity, shape, clip) = (form.name.clone(), form.entity.clone(), form.shape, form.clip);
        Ok(Self { name, entity, shape, clip, curves: form.curves()? })
    }
}

impl Entry for PointForm {
    type Form = Self;
    fn from_form(form: Self) -> Result<Self, String> {
        Ok(form)
    }
}

impl Entry for ShapeForm {
    type Form = Self;
    fn from_form(form: Self) -> Result<Self, String> {
        Ok(form)
    }
}

impl Entry for SkippedForm {
    type Form = Self;
    fn from_form(form: Self) -> Result<Self, String> {
        Ok(form)
    }
}

impl Entry for SeedForm {
    type Form = Self;
    fn from_form(form: Self) -> Result<Self, String> {
        match (form.hole, &form.region, form.max_area) {
            (true, None, None) => Ok(form),
            (true, ..) => Err("a hole has neither a region nor an area".into()),
            (false, None, _) => Err("needs `region` with a name, or `\"hole\": true`".into()),
            (false, Some(_), Some(area)) if area.is_nan() || area <= 0.0 => Err("`max_area` must be positive".into()),
            (false, Some(_), _) => Ok(form),
        }
    }
}

impl Entry for SizeEntry {
    type Form = SizeForm;
    fn from_form(form: SizeForm) -> Result<Self, String> {
        if !(form.edge > 0.0 && form.grade.unwrap_or(0.0) >= 0.0) {
            return Err("`edge` must be positive and `grade` not negative".into());
        }
        match (form.boundary, form.region, form.near, form.grade) {
            (Some(name), None, None, None) => Ok(Self::Boundary(name, form.edge)),
            (None, Some(name), None, None) => Ok(Self::Region(name, form.edge)),
            (None, None, Some([a, b]), Some(grade)) => Ok(Self::Near(point(a), point(b), form.edge, grade)),
            (None, None, Some(_), None) => Err("`near` needs `grade`".into()),
            (None, None, None, None) => Ok(Self::Everywhere(form.edge)),
            _ => Err("holds more than one of `boundary`, `region` and `near` (with `grade`)".into()),
        }
    }
}

/// An entry read and checked inside the map it stands in, so that the error knows its line.
struct Checked<E>(E);

impl<'de, E: Entry> Deserialize<'de> for Checked<E> {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        struct InMap<E>(PhantomData<E>);
        impl<'de, E: Entry> Visitor<'de> for InMap<E> {
            type Value = Checked<E>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let form = E::Form::deserialize(MapAccessDeserializer::new(map))?;
                E::from_form(form).map(Checked).map_err(A::Error::custom)
            }
        }
        reader.deserialize_map(InMap(PhantomData))
    }
}

/// A list whose errors say which entry they are about: `curves[3]: …`.
fn list<'de, D: Deserializer<'de>, E: Entry>(name: &'static str, reader: D) -> Result<Vec<E>, D::Error> {
    struct Indexed<E>(&'static str, PhantomData<E>);
    impl<'de, E: Entry> Visitor<'de> for Indexed<E> {
        type Value = Vec<E>;
        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            write!(f, "a list of {}", self.0)
        }
        fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Vec<E>, A::Error> {
            let mut entries = Vec::new();
            loop {
                let here = |e: A::Error| A::Error::custom(format!("{}[{}]: {e}", self.0, entries.len()));
                match seq.next_element::<Checked<E>>().map_err(here)? {
                    Some(Checked(entry)) => entries.push(entry),
                    None => return Ok(entries),
                }
            }
        }
    }
    reader.deserialize_seq(Indexed(name, PhantomData))
}

fn curves<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<CurveEntry>, D::Error> {
    list("curves", reader)
}
fn points<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<PointForm>, D::Error> {
    list("points", reader)
}
fn seeds<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<SeedForm>, D::Error> {
    list("seeds", reader)
}
fn sizes<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<SizeEntry>, D::Error> {
    list("sizes", reader)
}
fn shapes<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<ShapeForm>, D::Error> {
    list("shapes", reader)
}
fn skipped<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<SkippedForm>, D::Error> {
    list("skipped", reader)
}

/// Reads an outline. Indices in messages count from 0, as in JSON paths.
///
/// # Errors
/// With line, column and the entry where the text is no JSON, lacks or does not know a key, or a curve cannot be built.
pub fn read(bytes: &[u8], stem: &str) -> Result<Drawing, ImportError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let file: File = serde_json::from_slice(bytes).map_err(located)?;
    if file.squinch != VERSION {
        let what = format!("version {} of the outline format is not known", file.squinch);
        return Err(ImportError::new(what, format!("this program reads version {VERSION}")));
    }
    let shapes = file.shapes.len();
    let unknown = file.curves.iter().position(|c| c.shape.is_some_and(|k| k as usize >= shapes));
    match unknown {
        Some(i) => {
            Err(ImportError::new(format!("{} is of a shape that `shapes` does not list", curve_entity(i)), HELP))
        }
        None => {
            file.check_clips()?;
            Ok(file.drawing(stem))
        }
    }
}

fn located(error: serde_json::Error) -> ImportError {
    let (line, column) = (error.line(), error.column());
    let text = error.to_string();
    let what = text.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&text).to_owned();
    let known = |n: usize| (n > 0).then_some(n);
    ImportError { what, line: known(line), column: known(column), help: HELP.into() }
}

impl File {
    /// Refuses clips that are not listed, that lie within later ones, or whose parts a later one cuts: only so does each have an end.
    fn check_clips(&self) -> Result<(), ImportError> {
        let refuse = |what: String| Err(ImportError::new(what, HELP));
        let count = self.clips.len();
        let unknown = |clip: Option<u32>| clip.is_some_and(|clip| clip as usize >= count);
        if let Some(i) = self.shapes.iter().position(|s| unknown(s.clip) || unknown(s.part_of)) {
            return refuse(format!("{} is of a clip that `clips` does not list", shape_entity(i)));
        }
        if let Some(i) = self.curves.iter().position(|c| unknown(c.clip)) {
            return refuse(format!("{} is of a clip that `clips` does not list", curve_entity(i)));
        }
        let mut parts: Vec<Vec<u32>> = vec![Vec::new(); count];
        for shape in &self.shapes {
            if let (Some(of), Some(clip)) = (shape.part_of, shape.clip) {
                parts[of as usize].push(clip);
            }
        }
        let mut depth = vec![0_usize; count];
        for (i, clip) in self.clips.iter().enumerate() {
            if clip.within.iter().chain(&parts[i]).any(|&other| other as usize >= i) {
                return refuse(format!("clip {i} is cut by itself or by a later one"));
            }
            let within = clip.within.map_or(0, |other| depth[other as usize]);
            depth[i] = parts[i].iter().map(|&other| 1 + depth[other as usize]).fold(within, usize::max);
            if depth[i] > CLIP_DEPTH_MAX {
                return refuse(format!("clip {i} is cut by clips nested more than {CLIP_DEPTH_MAX} deep"));
            }
        }
        Ok(())
    }

    fn drawing(self, stem: &str) -> Drawing {
        let mut d = Drawing {
            format: self.format.unwrap_or_else(|| "outline".into()),
            title: self.title.unwrap_or_else(|| stem.to_owned()),
            fill: match self.fill {
                Some(Fill::NonZero) => FillRule::NonZero,
                Some(Fill::Regions) => FillRule::Regions,
                Some(Fill::Shapes) => FillRule::Shapes,
                Some(Fill::EvenOddAndShapes) => FillRule::EvenOddAndShapes,
                Some(Fill::EvenOdd) | None => FillRule::EvenOdd,
            },
            sketch: self.sketch,
            unit: self.unit.map(|unit| (unit, self.unit_from.unwrap_or_else(|| "outline".into()))),
            notes: self.notes.unwrap_or_default(),
            ..Drawing::default()
        };
        for name in self.names.iter().flatten() {
            d.names.intern(name);
        }
        d.clips = self.clips.into_iter().map(|clip| Clip { within: clip.within.map(ClipId) }).collect();
        for (i, shape) in self.shapes.into_iter().enumerate() {
            let name = d.names.intern(&shape.name);
            let entity = shape.entity.unwrap_or_else(|| shape_entity(i));
            let (clip, part_of) = (shape.clip.map(ClipId), shape.part_of.map(ClipId));
            d.shapes.push(Shape { clip, part_of, ..Shape::new(name, shape.even_odd, entity) });
        }
        for (i, entry) in self.curves.into_iter().enumerate() {
            let name = d.names.intern(entry.name.as_deref().unwrap_or(UNNAMED));
            let whole = entry.entity.unwrap_or_else(|| curve_entity(i));
            let several = entry.curves.len() > 1;
            for (k, curve) in entry.curves.into_iter().enumerate() {
                let entity = if several { format!("{whole}, edge {k}") } else { whole.clone() };
                let drawn = DrawnCurve::new(curve, name, entity).with_written_ends();
                let (shape, clip) = (entry.shape.map(ShapeId), entry.clip.map(ClipId));
                d.curves.push(DrawnCurve { shape, clip, ..drawn });
            }
        }
        for (i, p) in self.points.into_iter().enumerate() {
            let name = p.name.map(|name| d.names.intern(&name));
            d.points.push(DrawnPoint { at: point(p.at), name, entity: p.entity.unwrap_or_else(|| point_entity(i)) });
        }
        for (i, s) in self.seeds.into_iter().enumerate() {
            let kind = match s.region {
                Some(region) => SeedKind::Region { name: d.names.intern(&region), max_area: s.max_area },
                None => SeedKind::Hole,
            };
            d.seeds.push(Seed { at: point(s.at), kind, entity: s.entity.unwrap_or_else(|| seed_entity(i)) });
        }
        d.sizes = self.sizes.into_iter().map(|s| s.request(&mut d.names)).collect();
        d.skipped =
            self.skipped.into_iter().map(|s| Skipped { entity: s.entity, count: s.count, why: s.why }).collect();
        d
    }
}

/// Name of the boundary whose curves have none.
const UNNAMED: &str = "boundary";

fn curve_entity(i: usize) -> String {
    format!("curve {i}")
}
fn shape_entity(i: usize) -> String {
    format!("shape {i}")
}
fn point_entity(i: usize) -> String {
    format!("point {i}")
}
fn seed_entity(i: usize) -> String {
    format!("seed {i}")
}

impl SizeEntry {
    fn request(self, names: &mut Names) -> SizeRequest {
        match self {
            Self::Boundary(name, edge) => SizeRequest::Boundary { name: names.intern(&name), edge },
            Self::Region(name, edge) => SizeRequest::Region { name: names.intern(&name), edge },
            Self::Near(from, to, edge, grade) => SizeRequest::Near { from, to, edge, grade },
            Self::Everywhere(edge) => SizeRequest::Everywhere { edge },
        }
    }
}

fn point(p: Pair) -> Point {
    Point::new(p[0], p[1])
}

fn all(points: &[Pair]) -> Vec<Point> {
    points.iter().copied().map(point).collect()
}

fn said(error: impl Display) -> String {
    error.to_string()
}

impl CurveForm {
    fn curves(self) -> Result<Vec<Curve>, String> {
        let mut kinds: Vec<Result<Vec<Curve>, String>> = Vec::new();
        let mut one = |curve: Result<Curve, String>| kinds.push(curve.map(|c| vec![c]));
        if let Some([a, b]) = self.line {
            one(Curve::line(point(a), point(b)).map_err(said));
        }
        if let Some(arc) = self.arc {
            one(arc.curve());
        }
        if let Some(circle) = self.circle {
            one(Curve::circle(point(circle.center), circle.radius).map_err(said));
        }
        if let Some(ellipse) = self.ellipse {
            one(ellipse.curve());
        }
        if let Some(points) = self.bezier {
            one(bezier(&points, None));
        }
        if let Some(form) = self.rational_bezier {
            one(bezier(&form.points, Some(form.weights)));
        }
        if let Some(form) = self.nurbs {
            one(form.curve());
        }
        if let Some(points) = self.spline {
            one(Curve::natural_spline(&all(&points)).map_err(said));
        }
        if let Some(points) = self.closed_spline {
            one(Curve::periodic_spline(&all(&points)).map_err(said));
        }
        if let Some(form) = self.piecewise_bezier {
            one(form.curve());
        }
        if let Some(points) = self.polyline {
            kinds.push(polyline(&all(&points), false));
        }
        if let Some(points) = self.polygon {
            kinds.push(polyline(&all(&points), true));
        }
        if kinds.len() != 1 {
            return Err(format!("holds {} curves, but each entry needs one: `line`, `arc`, `spline`, …", kinds.len()));
        }
        kinds.swap_remove(0)
    }
}

fn polyline(points: &[Point], closed: bool) -> Result<Vec<Curve>, String> {
    if points.len() < 2 + usize::from(closed) {
        return Err(format!("{} points make no polyline", points.len()));
    }
    let closing = closed.then(|| [points[points.len() - 1], points[0]]);
    let edges = points.windows(2).map(|w| [w[0], w[1]]).chain(closing);
    edges.map(|[a, b]| Curve::line(a, b).map_err(said)).collect()
}

/// A Bézier span. Weights are kept as they are, so that what was written reads back the same, unless they are all equal (and say
/// nothing), so far from 1 that products of them would leave the range, or so far apart that `Curve::rational_bezier` evens them.
fn bezier(points: &[Pair], weights: Option<Vec<f64>>) -> Result<Curve, String> {
    let Some(weights) = weights else { return Curve::bezier(all(points)).map_err(said) };
    match Curve::rational_bezier(all(points), weights.clone()).map_err(said)? {
        Curve::Bezier(made) if is_tame(&weights) && made.weights.as_ref().is_some_and(|w| is_multiple(w, &weights)) => {
            Ok(Curve::Bezier(Box::new(Bezier { weights: Some(weights), ..*made })))
        }
        made => Ok(made),
    }
}

fn is_tame(weights: &[f64]) -> bool {
    weights.iter().all(|w| (1e-30..1e30).contains(w))
}

/// Whether some weights are others times a power of two.
fn is_multiple(weights: &[f64], others: &[f64]) -> bool {
    weights.iter().zip(others).all(|(w, v)| w * others[0] == v * weights[0])
}

/// Start and sweep in radians, from whichever unit is given; `None` where neither is.
fn angles(deg: [Option<f64>; 2], rad: [Option<f64>; 2]) -> Result<Option<[f64; 2]>, String> {
    match (deg, rad) {
        ([None, None], [None, None]) => Ok(None),
        ([Some(start), Some(sweep)], [None, None]) => Ok(Some([start.to_radians(), sweep.to_radians()])),
        ([None, None], [Some(start), Some(sweep)]) => Ok(Some([start, sweep])),
        _ => Err("needs `start_deg` and `sweep_deg`, or `start_rad` and `sweep_rad`".into()),
    }
}

impl ArcForm {
    fn curve(self) -> Result<Curve, String> {
        let angles = angles([self.start_deg, self.sweep_deg], [self.start_rad, self.sweep_rad])?;
        let by_center = (self.center, self.radius, angles, self.ends);
        match (by_center, (self.from, self.through, self.to, self.bulge)) {
            ((Some(center), Some(radius), Some(a), ends), (None, None, None, None)) => {
                let arc = Curve::arc(point(center), radius, a[0], a[1]).map_err(said)?;
                match ends {
                    None => Ok(arc),
                    Some(ends) => with_stated_ends(arc, ends),
                }
            }
            ((None, None, None, None), (Some(from), Some(through), Some(to), None)) => {
                Curve::arc_through(point(from), point(through), point(to)).map_err(said)
            }
            ((None, None, None, None), (Some(from), None, Some(to), Some(bulge))) => {
                Curve::bulge(point(from), point(to), bulge).map_err(said)
            }
            _ => Err(
                "an arc is given by `center`, `radius` and angles; by `from`, `through`, `to`; or by `from`, `to`, \
                      `bulge`"
                    .into(),
            ),
        }
    }
}

/// The arc with the ends that the file states; they must be its own up to rounding, and equal where it closes.
fn with_stated_ends(arc: Curve, ends: [Pair; 2]) -> Result<Curve, String> {
    let ends = ends.map(point);
    let (size, sweep_rad) = match &arc {
        Curve::Arc(a) => (a.radius + a.center.to_vec2().hypot(), a.sweep_rad),
        Curve::Ellipse(e) => (e.u.hypot() + e.v.hypot() + e.center.to_vec2().hypot(), e.sweep_rad),
        _ => return Err("only arcs have `ends`".into()),
    };
    let near = |p: Point, q: Point| (p - q).hypot() <= END_SLACK * size;
    if !(near(ends[0], arc.start()) && near(ends[1], arc.end())) {
        return Err("`ends` do not lie where the angles put them".into());
    }
    if sweep_rad.abs() >= TAU && ends[0] != ends[1] {
        return Err("a full turn needs equal `ends`".into());
    }
    Ok(match arc {
        Curve::Arc(a) => Curve::Arc(CircularArc { ends, ..a }),
        Curve::Ellipse(e) => Curve::Ellipse(Box::new(EllipticArc { ends, ..*e })),
        other => other,
    })
}

impl EllipseForm {
    fn curve(self) -> Result<Curve, String> {
        let turn = angles([self.start_deg, self.sweep_deg], [self.start_rad, self.sweep_rad])?.unwrap_or([0.0, TAU]);
        let (u, v) = match (self.u, self.v, self.radii) {
            (Some(u), Some(v), None) if self.rotation_deg.is_none() => (point(u).to_vec2(), point(v).to_vec2()),
            (None, None, Some([a, b])) => {
                let (sin, cos) = libm::sincos(self.rotation_deg.unwrap_or(0.0).to_radians());
                (Vec2::new(a * cos, a * sin), Vec2::new(-b * sin, b * cos))
            }
            _ => return Err("an ellipse is given by half axes `u` and `v`, or by `radii` and `rotation_deg`".into()),
        };
        let center = point(self.center);
        let arc = Curve::ellipse(center, u, v, turn[0], turn[1]).map_err(said)?;
        match self.ends {
            None => Ok(arc),
            Some(ends) => with_stated_ends(arc, ends),
        }
    }
}

impl NurbsForm {
    fn curve(self) -> Result<Curve, String> {
        if self.degree > MAX_DEGREE {
            return Err(format!("degree {} is above the limit of {MAX_DEGREE}", self.degree));
        }
        Curve::nurbs(self.degree, &self.knots, &all(&self.points), self.weights.as_deref()).map_err(said)
    }
}

impl PiecewiseForm {
    fn curve(self) -> Result<Curve, String> {
        let knots = self.knots;
        let ascending = knots.windows(2).all(|w| w[0] < w[1]);
        if knots.len() != self.spans.len() + 1
            || !ascending
            || knots.first() != Some(&0.0)
            || knots.last() != Some(&1.0)
        {
            return Err("needs one knot more than spans, ascending from 0 to 1".into());
        }
        let (mut starts, mut spans) = (Vec::new(), Vec::<Bezier>::new());
        for (i, form) in self.spans.into_iter().enumerate() {
            let next = match bezier(&form.points, form.weights).map_err(|e| format!("spans[{i}]: {e}"))? {
                Curve::Bezier(span) => vec![*span],
                Curve::Spline(evened) => evened.spans,
                other => return Err(format!("spans[{i}]: is no Bézier curve but a {}", other.kind())),
            };
            if spans.last().is_some_and(|before| before.points.last() != next[0].points.first()) {
                return Err(format!("spans[{i}] does not start where the span before it ends"));
            }
            let step = (knots[i + 1] - knots[i]) / next.len() as f64;
            starts.extend((0..next.len()).map(|k| knots[i] + k as f64 * step));
            spans.extend(next);
        }
        if spans.is_empty() {
            return Err("needs a span".into());
        }
        let knots = starts.into_iter().chain([1.0]).collect();
        Ok(Curve::Spline(Box::new(Spline { knots, spans })))
    }
}

// ---- writing ----

/// The drawing as outline text, one entry a line. Reading it gives the same drawing, bit for bit.
pub fn to_json(drawing: &Drawing) -> String {
    let mut head = Map::new();
    head.insert("squinch".into(), json!(VERSION));
    head.insert("title".into(), json!(drawing.title));
    head.insert("format".into(), json!(drawing.format));
    if let Some((unit, from)) = &drawing.unit {
        head.insert("unit".into(), json!(unit));
        head.insert("unit_from".into(), json!(from));
    }
    head.insert("fill".into(), json!(fill_word(drawing.fill)));
    if drawing.sketch {
        head.insert("sketch".into(), json!(true));
    }
    head.insert("names".into(), drawing.names.iter().map(|(_, text)| json!(text)).collect());
    let mut text = String::from("{\n");
    for (key, value) in &head {
        text.push_str(&format!("  {}: {value},\n", json!(key)));
    }
    let names = &drawing.names;
    push_list(&mut text, "shapes", drawing.shapes.iter().enumerate().map(|(i, s)| shape_value(i, s, names)));
    push_list(
        &mut text,
        "clips",
        drawing.clips.iter().map(|c| c.within.map_or(json!({}), |within| json!({ "within": within }))),
    );
    push_list(&mut text, "curves", drawing.curves.iter().enumerate().map(|(i, c)| curve_value(i, c, names)));
    push_list(&mut text, "points", drawing.points.iter().enumerate().map(|(i, p)| point_value(i, p, names)));
    push_list(&mut text, "seeds", drawing.seeds.iter().enumerate().map(|(i, s)| seed_value(i, s, names)));
    push_list(&mut text, "sizes", drawing.sizes.iter().map(|s| size_value(s, names)));
    push_list(&mut text, "skipped", drawing.skipped.iter().map(|s| json!(s)));
    push_list(&mut text, "notes", drawing.notes.iter().map(|n| json!(n)));
    // The last list's comma.
    text.truncate(text.trim_end().trim_end_matches(',').len());
    text.push_str("\n}\n");
    text
}

fn push_list(text: &mut String, key: &str, entries: impl ExactSizeIterator<Item = Value>) {
    if entries.len() == 0 {
        return;
    }
    let lines: Vec<String> = entries.map(|entry| format!("    {entry}")).collect();
    text.push_str(&format!("  \"{key}\": [\n{}\n  ],\n", lines.join(",\n")));
}

fn fill_word(fill: FillRule) -> &'static str {
    match fill {
        FillRule::NonZero => "nonzero",
        FillRule::EvenOdd => "evenodd",
        FillRule::Regions => "regions",
        FillRule::Shapes => "shapes",
        FillRule::EvenOddAndShapes => "evenodd+shapes",
    }
}

fn pair(p: Point) -> Value {
    json!([p.x, p.y])
}

fn pairs(points: &[Point]) -> Value {
    points.iter().map(|&p| pair(p)).collect()
}

fn with_entity(mut value: Value, entity: &str, default: &str) -> Value {
    if entity != default {
        value["entity"] = json!(entity);
    }
    value
}

fn shape_value(i: usize, shape: &Shape, names: &Names) -> Value {
    let mut value = json!({ "name": names.text(shape.name), "even_odd": shape.even_odd });
    for (key, clip) in [("clip", shape.clip), ("part_of", shape.part_of)] {
        clip.into_iter().for_each(|clip| value[key] = json!(clip));
    }
    with_entity(value, &shape.entity, &shape_entity(i))
}

fn curve_value(i: usize, drawn: &DrawnCurve, names: &Names) -> Value {
    let (kind, form) = kind_value(&drawn.curve);
    let mut value = json!({ "name": names.text(drawn.name), kind: form });
    if let Some(shape) = drawn.shape {
        value["shape"] = json!(shape);
    }
    if let Some(clip) = drawn.clip {
        value["clip"] = json!(clip);
    }
    with_entity(value, &drawn.entity, &curve_entity(i))
}

/// The kind and its value: the plain form where reading that gives the same curve, else the one that spells everything out.
fn kind_value(curve: &Curve) -> (&'static str, Value) {
    let same = |plain: Result<Curve, CurveError>| plain.as_ref() == Ok(curve);
    match curve {
        Curve::Line(l) => ("line", json!([pair(l.start), pair(l.end)])),
        Curve::Arc(a) if same(Curve::circle(a.center, a.radius)) => {
            ("circle", json!({ "center": pair(a.center), "radius": a.radius }))
        }
        Curve::Arc(a) => {
            let mut arc = json!({ "center": pair(a.center), "radius": a.radius,
                                  "start_rad": a.start_rad, "sweep_rad": a.sweep_rad });
            if !same(Curve::arc(a.center, a.radius, a.start_rad, a.sweep_rad)) {
                arc["ends"] = pairs(&a.ends);
            }
            ("arc", arc)
        }
        Curve::Ellipse(e) => {
            let mut ellipse = json!({ "center": pair(e.center), "u": [e.u.x, e.u.y], "v": [e.v.x, e.v.y],
                                      "start_rad": e.start_rad, "sweep_rad": e.sweep_rad });
            if !same(Curve::ellipse(e.center, e.u, e.v, e.start_rad, e.sweep_rad)) {
                ellipse["ends"] = pairs(&e.ends);
            }
            ("ellipse", ellipse)
        }
        Curve::Bezier(b) => match &b.weights {
            None => ("bezier", pairs(&b.points)),
            Some(weights) => ("rational_bezier", json!({ "points": pairs(&b.points), "weights": weights })),
        },
        Curve::Spline(s) => {
            let spans: Vec<Value> = s.spans.iter().map(span_value).collect();
            ("piecewise_bezier", json!({ "knots": s.knots, "spans": spans }))
        }
    }
}

fn span_value(span: &Bezier) -> Value {
    let mut value = json!({ "points": pairs(&span.points) });
    if let Some(weights) = &span.weights {
        value["weights"] = json!(weights);
    }
    value
}

fn point_value(i: usize, drawn: &DrawnPoint, names: &Names) -> Value {
    let mut value = json!({ "at": pair(drawn.at) });
    if let Some(name) = drawn.name {
        value["name"] = json!(names.text(name));
    }
    with_entity(value, &drawn.entity, &point_entity(i))
}

fn seed_value(i: usize, seed: &Seed, names: &Names) -> Value {
    let mut value = json!({ "at": pair(seed.at) });
    match seed.kind {
        SeedKind::Hole => value["hole"] = json!(true),
        SeedKind::Region { name, max_area } => {
            value["region"] = json!(names.text(name));
            if let Some(area) = max_area {
                value["max_area"] = json!(area);
            }
        }
    }
    with_entity(value, &seed.entity, &seed_entity(i))
}

fn size_value(size: &SizeRequest, names: &Names) -> Value {
    match *size {
        SizeRequest::Boundary { name, edge } => json!({ "boundary": names.text(name), "edge": edge }),
        SizeRequest::Region { name, edge } => json!({ "region": names.text(name), "edge": edge }),
        SizeRequest::Near { from, to, edge, grade } => {
            json!({ "near": [pair(from), pair(to)], "edge": edge, "grade": grade })
        }
        SizeRequest::Everywhere { edge } => json!({ "edge": edge }),
    }
}
