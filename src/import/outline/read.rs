//! Reading outlines. Each entry is checked while the reader is at its place, so that errors have a line.

use super::curves::{CurveForm, Pair, point};
use super::{VERSION, curve_entity, point_entity, seed_entity, shape_entity};
use crate::curve::Curve;
use crate::domain::{Clip, Drawing, DrawnCurve, DrawnPoint, FillRule, Seed, SeedKind, Shape, SizeRequest, Skipped};
use crate::geometry::Point;
use crate::ids::{ClipId, Names, ShapeId};
use crate::import::ImportError;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error as _, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::marker::PhantomData;

const HELP: &str = "`squinch schema outline` prints what the format holds";
/// Name of the boundary of curves without a name.
const UNNAMED: &str = "boundary";

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

/// A filled shape. Curves refer to it by its index.
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

/// A clip of shapes and curves. Shapes say of which clip they are a part.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClipForm {
    within: Option<u32>,
}

/// Largest nesting of clips whose parts are cut by other clips.
const CLIP_DEPTH_MAX: usize = 64;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PointForm {
    at: Pair,
    name: Option<String>,
    entity: Option<String>,
}

/// A hole if `hole` is true, else the region of a name.
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

/// The curves of an entry; a polyline has several.
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

/// The form in which an entry is read, and its check.
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

/// An entry that is read and checked inside the map around it, so that an error has its line.
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

/// A list whose errors name the entry: `curves[3]: …`.
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
/// With line, column and entry: where the text is not JSON, a key is missing or unknown, or a curve cannot be built.
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
    /// Refuses clips that are not listed, that lie within a later one, or whose parts a later one cuts. So there are no
    /// cycles.
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
