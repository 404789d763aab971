//! One entity → its curves, in the coordinates of the drawing or of the block around it.

use super::arc::{arc, ellipse};
use super::figure::{Figure, Insert, NO_OUTLINE, Notices, Refusal, built, single};
use super::hatch;
use super::mline::mline;
use super::plane::{Plane, flat};
use super::polyline::{face, light_polyline, polyline};
use super::sections::Record;
use super::spline::spline;
use super::text;
use crate::curve::Curve;
use crate::geometry::{Point, Vec2};
use kurbo::Affine;

/// The figure of the entity that begins with `record`. `followers` are its vertices.
pub(super) fn figure<'a>(
    record: &Record<'a>,
    followers: &[Record],
    notices: &mut Notices,
) -> Result<Figure<'a>, Refusal> {
    match record.kind.as_str() {
        "LINE" | "3DLINE" => line(record),
        "CIRCLE" | "ARC" => arc(record, notices),
        "ELLIPSE" => ellipse(record, notices),
        "LWPOLYLINE" => light_polyline(record, notices),
        "POLYLINE" => polyline(record, followers, notices),
        "MLINE" => mline(record, notices),
        "SPLINE" | "HELIX" => spline(record, notices),
        "SOLID" | "TRACE" | "3DFACE" => face(record),
        "POINT" => {
            let [x, y, z] = record.point(10)?;
            Ok(Figure::Point { at: Point::new(x, y), z })
        }
        "HATCH" | "MPOLYGON" => {
            let plane = Plane::parallel(record)?;
            let placed = |outline: Vec<Curve>| outline.into_iter().map(|curve| plane.place(curve, 0.0)).collect();
            let loops = hatch::outlines(record, notices)?.into_iter().map(placed).collect();
            Ok(Figure::Fill { loops, last_decimal: record.last_decimal(&[10, 20, 11, 21]) })
        }
        "TEXT" | "MTEXT" => text::text(record),
        "INSERT" => insert(record),
        kind => {
            if kind == "WIPEOUT" {
                notices.add("What wipeouts cover (WIPEOUT) is read as if they were not there.");
            }
            Err(Refusal::Skip(why_not(kind)))
        }
    }
}

fn why_not(kind: &str) -> &'static str {
    match kind {
        "ATTRIB" | "ATTDEF" | "RTEXT" | "ARCALIGNEDTEXT" | "SHAPE" => NO_OUTLINE,
        "DIMENSION"
        | "ARC_DIMENSION"
        | "LARGE_RADIAL_DIMENSION"
        | "LEADER"
        | "MULTILEADER"
        | "MLEADER"
        | "TOLERANCE"
        | "ACAD_TABLE" => "an annotation",
        "RAY" | "XLINE" => "a construction line without end",
        "REGION" | "3DSOLID" | "BODY" | "SURFACE" | "PLANESURFACE" | "EXTRUDEDSURFACE" | "LOFTEDSURFACE"
        | "REVOLVEDSURFACE" | "SWEPTSURFACE" | "NURBSURFACE" => "an ACIS body (explode it into curves)",
        "IMAGE" | "WIPEOUT" | "OLEFRAME" | "OLE2FRAME" | "PDFUNDERLAY" | "DWFUNDERLAY" | "DGNUNDERLAY" => "an image",
        "VIEWPORT" => "a view",
        "MESH" => "a surface in space",
        _ => "an entity of a kind that is not read",
    }
}

fn line(record: &Record) -> Result<Figure<'static>, Refusal> {
    let ends = [record.point(10)?, record.point(11)?];
    let [a, b] = ends.map(|p| Point::new(p[0], p[1]));
    Ok(single(built(record, Curve::line(a, b))?, flat(&ends), record.last_decimal(&[10, 20, 11, 21])))
}

fn insert<'a>(record: &Record<'a>) -> Result<Figure<'a>, Refusal> {
    let plane = Plane::parallel(record)?;
    let [x, y, z] = record.point(10)?;
    let scale = [record.real(41, 1.0)?, record.real(42, 1.0)?];
    if scale.contains(&0.0) {
        return Err(Refusal::Skip("a block drawn with the scale 0"));
    }
    let turn = turn(record.real(50, 0.0)?);
    let map = plane.affine(0.0) * Affine::translate((x, y)) * turn * Affine::scale_non_uniform(scale[0], scale[1]);
    // Rows and columns run along the rotated axes. They are not scaled.
    let step = |v: Vec2| {
        let [a, b, c, d, _, _] = (plane.affine(0.0) * turn).as_coeffs();
        Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
    };
    let steps = [step(Vec2::new(record.real(44, 0.0)?, 0.0)), step(Vec2::new(0.0, record.real(45, 0.0)?))];
    Ok(Figure::Insert(Insert {
        block: record.text(2).unwrap_or_default(),
        map,
        z: plane.height(z),
        z_scale: plane.height(record.real(43, 1.0)?),
        columns: record.integer(70, 1)?.max(1),
        rows: record.integer(71, 1)?.max(1),
        steps,
    }))
}

/// A rotation, exact in quarter turns.
fn turn(degrees: f64) -> Affine {
    let (sin, cos) = match degrees.rem_euclid(360.0) {
        0.0 | 360.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => libm::sincos(other.to_radians()),
    };
    Affine::new([cos, sin, -sin, cos, 0.0, 0.0])
}
