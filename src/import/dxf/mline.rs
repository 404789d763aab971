//! MLINE: parallel lines along a polyline. The entity gives the distance of each line from each vertex along the miter.

use super::figure::{Figure, Notices, Refusal};
use super::plane::flat;
use super::polyline::{Vertex, segments};
use super::sections::Record;
use crate::curve::Curve;
use crate::geometry::{Point, Vec2};

/// Bit of group 71: closed.
const CLOSED: i64 = 2;

/// A vertex, with the direction of its miter and the offset of each line along it.
struct Corner {
    at: Point,
    miter: Vec2,
    offsets: Vec<f64>,
}

/// The lines of an MLINE.
pub(super) fn mline(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let corners = corners(record)?;
    let lines = corners.iter().map(|corner| corner.offsets.len()).min().unwrap_or(0);
    let closed = record.integer(71, 0)? & CLOSED != 0;
    let mut curves: Vec<Curve> = Vec::new();
    for line in 0..lines {
        let vertex = |corner: &Corner| Vertex { at: corner.at + corner.miter * corner.offsets[line], bulge: 0.0 };
        let vertices: Vec<Vertex> = corners.iter().map(vertex).collect();
        curves.extend(segments(record, &vertices, closed)?);
    }
    if curves.is_empty() {
        return Err(Refusal::Degenerate);
    }
    if !closed {
        notices.add("Multilines are drawn as their parallel lines, without caps at their ends.");
    }
    let level = flat(&record.points(11)?);
    Ok(Figure::Curves { curves, level, parts: "segment", last_decimal: record.last_decimal(&[11, 21]) })
}

/// Reads vertices (groups 11 and 21) and miters (13 and 23). For each line a count follows (group 74), then as many
/// numbers (group 41): its offset, the start of the line, and the breaks of the line.
fn corners(record: &Record) -> Result<Vec<Corner>, Refusal> {
    const BROKEN: i64 = 2;
    let mut corners: Vec<Corner> = Vec::new();
    let mut starts_line = false;
    for pair in &record.pairs {
        if pair.code == 11 {
            let at = Point::new(record.real_of(pair)?, 0.0);
            corners.push(Corner { at, miter: Vec2::ZERO, offsets: Vec::new() });
        }
        let Some(corner) = corners.last_mut() else { continue };
        match pair.code {
            21 => corner.at.y = record.real_of(pair)?,
            13 => corner.miter.x = record.real_of(pair)?,
            23 => corner.miter.y = record.real_of(pair)?,
            74 if record.integer_of(pair)? > BROKEN => return Err(Refusal::Skip("a multiline that is broken off")),
            74 => starts_line = true,
            41 if starts_line => {
                corner.offsets.push(record.real_of(pair)?);
                starts_line = false;
            }
            _ => {}
        }
    }
    Ok(corners)
}
