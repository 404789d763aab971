//! Bytes → drawing or surfaces, with the format, scale and names of the request.

use super::report::{FailureKind, FailureReport};
use super::request::{Engine, Request};
use crate::domain::{Drawing, DrawnCurve, SizeRequest, Unmatched};
use crate::geometry::{Point, metres};
use crate::import::{self, Format, Found, SvgOptions};
use crate::options::Group;
use crate::section;
use crate::solid::Surfaces;
use kurbo::Affine;
use std::borrow::Cow;
use std::path::Path;

/// The input: the bytes of a file, and how to read them.
#[derive(Clone, Debug)]
pub struct Source<'a> {
    /// The path as given. Its suffix gives the format if none is given; its stem is the title if the file has none.
    pub path: &'a str,
    /// The whole content of the file.
    pub bytes: &'a [u8],
    /// Format of the file; `None`: by its name, else by its content.
    pub format: Option<Format>,
    /// The `.node` file beside a `.poly` file, where there is one.
    pub nodes: Option<&'a [u8]>,
    /// Whether this is one of many inputs with the same request. Then names of the request that the input does not have
    /// are noted, and are not errors.
    pub of_many: bool,
}

/// What is meshed.
pub(super) enum Input<'a> {
    /// Curves in the plane.
    Drawing(Box<Cow<'a, Drawing>>),
    /// Polygons in space, and a title.
    Surfaces(Box<Surfaces>, String),
}

/// Bytes → drawing or surfaces.
///
/// # Errors
/// Those of [`read`].
pub(super) fn read_any(source: &Source, request: &Request) -> Result<Input<'static>, FailureReport> {
    let (found, format, stem) = found(source, request)?;
    match found {
        Found::Surfaces(mut surfaces) => {
            surfaces.notes.extend(unused_options(format, request));
            Ok(Input::Surfaces(surfaces, stem))
        }
        Found::Drawing(_) | Found::Section(_) => {
            Ok(Input::Drawing(Box::new(Cow::Owned(drawing_of(found, format, source, request)?))))
        }
    }
}

/// Bytes → drawing, in the unit asked for.
///
/// # Errors
/// Where the format is unknown, the file breaks it, or the request names a unit, layer or place that does not exist.
/// Where the file holds a solid.
pub fn read(source: &Source, request: &Request) -> Result<Drawing, FailureReport> {
    let (found, format, _) = found(source, request)?;
    drawing_of(found, format, source, request)
}

/// What a file holds, its format and its name without suffix.
fn found(source: &Source, request: &Request) -> Result<(Found, Format, String), FailureReport> {
    let path = Path::new(source.path);
    let format = source.format.map_or_else(|| import::tell_format(path, source.bytes), Ok)?;
    let stem = path.file_stem().map_or("", |s| s.to_str().unwrap_or(""));
    let options = import::Options {
        nodes: source.nodes.map(<[u8]>::to_vec),
        svg: SvgOptions { strokes: request.strokes, dpi: request.dpi },
        face: request.face.clone(),
        dxf: request.dxf,
        selection: request.selection.clone(),
    };
    Ok((import::read(source.bytes, format, stem, &options)?, format, stem.to_owned()))
}

fn drawing_of(found: Found, format: Format, source: &Source, request: &Request) -> Result<Drawing, FailureReport> {
    let mut drawing = section::drawn(found, &request.airfoil)?;
    drawing.notes.extend(unused_options(format, request));
    tell_unmatched(&mut drawing, source.of_many)?;
    let mut drawing = in_units(drawing, request)?;
    give_names(&mut drawing, request, source.of_many)?;
    Ok(drawing)
}

/// Gives the names of the request. A name without a place is an error, or a note if the request is for many inputs.
fn give_names(drawing: &mut Drawing, request: &Request, of_many: bool) -> Result<(), FailureReport> {
    drawing.name_each(request.names);
    for name in &request.name {
        match drawing.give_name(name) {
            Ok(what) => drawing.notes.extend(what),
            Err(why) if of_many => drawing.notes.push(format!("--name {name}: {why}")),
            Err(why) => {
                let help = "--name NAME=x,y names the nearest curve; squinch inspect lists what the drawing has";
                return Err(FailureReport::new(FailureKind::Request, format!("--name {name}: {why}"), help));
            }
        }
    }
    Ok(())
}

/// Lists the given options that the run does not use: those of other formats, and of the other engine.
fn unused_options(format: Format, request: &Request) -> Vec<String> {
    let usual = Request::default();
    let written = |request: &Request| toml::Table::try_from(request).expect("options are words, numbers and lists");
    let given = |group| {
        let (asked, usual) = (written(request), written(&usual));
        let of_group = Request::options().iter().filter(|option| option.group == group);
        let changed = of_group.filter(|option| asked.get(&option.key) != usual.get(&option.key));
        changed.map(|option| format!("--{}", option.key)).collect::<Vec<_>>().join(", ")
    };
    let unused = [
        (Group::Airfoils, format != Format::Airfoil && request.airfoil != usual.airfoil, "only for airfoils"),
        (Group::Solids, format != Format::Step && request.face != usual.face, "only for solids"),
        (Group::Gcdr, request.engine != Engine::Gcdr && request.gcdr != usual.gcdr, "only for --engine gcdr"),
    ];
    let unused = unused.into_iter().filter(|(_, unused, _)| *unused);
    unused.map(|(group, _, why)| format!("{}: {why}, and not used here", given(group))).collect()
}

/// Reports names of layers that the file does not have, as an error, or as a note if the request is for many inputs.
fn tell_unmatched(drawing: &mut Drawing, of_many: bool) -> Result<(), FailureReport> {
    let Some(Unmatched { asked, near }) = drawing.unmatched.first() else { return Ok(()) };
    let what = |asked: &str| format!("{asked}: no layer has this name");
    if !of_many {
        let help = match near.is_empty() {
            true => "the file has no layers".to_owned(),
            false => format!("layers: {}", near.join(", ")),
        };
        return Err(FailureReport::new(FailureKind::Request, what(asked), help));
    }
    let notes: Vec<String> = drawing.unmatched.iter().map(|unmatched| what(&unmatched.asked)).collect();
    drawing.notes.extend(notes);
    Ok(())
}

/// The drawing in the unit and scale of the request. If the unit of the drawing has no fixed length, only the name of
/// the unit changes.
fn in_units(mut drawing: Drawing, request: &Request) -> Result<Drawing, FailureReport> {
    let mut factor = request.scale.unwrap_or(1.0);
    if let Some(unit) = &request.unit {
        let wanted = metres(unit).ok_or_else(|| {
            let what = format!("--unit {unit}: not a unit of length that is known");
            FailureReport::new(
                FailureKind::Request,
                what,
                "nm, um, mm, cm, dm, m, km, in, ft, yd, mi, pt, pc or px, or a number of them as in '0.5 mm'",
            )
        })?;
        if let Some(own) = drawing.unit.as_ref().and_then(|(own, _)| metres(own)) {
            factor *= own / wanted;
        }
        drawing.unit = Some((unit.clone(), "--unit".into()));
    }
    Ok(if factor == 1.0 { drawing } else { scaled(drawing, factor) })
}

/// A drawing with every length times a factor.
fn scaled(mut drawing: Drawing, factor: f64) -> Drawing {
    let point = |p: Point| Point::new(p.x * factor, p.y * factor);
    if let Some(frame) = &mut drawing.frame {
        frame.origin = frame.origin.map(|x| x * factor);
    }
    for face in &mut drawing.faces {
        face.area = face.area.map(|area| area * factor * factor);
    }
    for DrawnCurve { curve, last_decimal, .. } in &mut drawing.curves {
        *curve = curve.transformed(Affine::scale(factor));
        *last_decimal *= factor;
    }
    for drawn in &mut drawing.points {
        drawn.at = point(drawn.at);
    }
    for entity in &mut drawing.off_plane {
        entity.ends = entity.ends.map(point);
    }
    for label in &mut drawing.labels {
        label.at = point(label.at);
    }
    for seed in &mut drawing.seeds {
        seed.at = point(seed.at);
        if let crate::domain::SeedKind::Region { max_area: Some(area), .. } = &mut seed.kind {
            *area *= factor * factor;
        }
    }
    for size in &mut drawing.sizes {
        match size {
            SizeRequest::Boundary { edge, .. }
            | SizeRequest::Region { edge, .. }
            | SizeRequest::Everywhere { edge } => {
                *edge *= factor;
            }
            SizeRequest::Near { from, to, edge, .. } => {
                (*from, *to) = (point(*from), point(*to));
                *edge *= factor;
            }
        }
    }
    drawing
}
