//! Polylines, the outlines of faces, and the edges of meshes.
//!
//! ```text
//!          . - ~ - .           A vertex b starts the segment to the next vertex c. The bulge of b gives the arc:
//!        ´     |h    `         bulge = tan(sweep / 4) = h / (½ |bc|), with h the height of the arc above its chord.
//!     b ●──────┴──────● c      0: a line, ±1: a half circle. Positive is counter-clockwise from b to c.
//!                              The arc of this figure is clockwise, so its bulge is negative.
//! ```

use super::figure::{Figure, Level, Notices, Refusal, built};
use super::pairs::Pair;
use super::plane::{Plane, flat, parallel};
use super::sections::{Record, finest};
use crate::curve::Curve;
use crate::geometry::Point;
use crate::import::ImportError;
use std::collections::BTreeSet;

/// A smaller bulge leaves the chord by less than the rounding of its ends.
const STRAIGHT_BULGE: f64 = 1e-15;
/// A larger bulge is a full turn up to rounding. Its chord cannot say where.
const FULL_BULGE: f64 = 1e8;
const WIDE: &str = "Polylines of some width are drawn as their centre lines.";

/// Bits of group 70 of a POLYLINE and of its VERTEX entities.
mod flag {
    /// The polyline is closed.
    pub const CLOSED: i64 = 1;
    /// The polyline is a curve in space.
    pub const IN_SPACE: i64 = 8;
    /// The polyline is a mesh of M by N vertices.
    pub const GRID: i64 = 16;
    /// The mesh is closed along N.
    pub const CLOSED_ALONG_N: i64 = 32;
    /// The polyline is a mesh of faces.
    pub const POLYFACE: i64 = 64;
    /// The vertex is of the frame of a spline.
    pub const FRAME: i64 = 16;
    /// The vertex is a face.
    pub const FACE: i64 = 128;
    /// The vertex has coordinates.
    pub const COORDINATES: i64 = 64;
}

/// A vertex of a polyline, with the bulge of the segment that it starts.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    /// Its place.
    pub at: Point,
    /// The tangent of a quarter of the angle by which the segment turns; 0 for a line.
    pub bulge: f64,
}

/// The segments of a polyline: lines, or arcs where they have a bulge. A closing segment between equal ends is left
/// out.
pub(super) fn segments(record: &Record, vertices: &[Vertex], closed: bool) -> Result<Vec<Curve>, Refusal> {
    let after = vertices.iter().skip(1).chain(vertices.first().filter(|_| closed));
    let last = vertices.len().saturating_sub(1);
    let pairs = vertices.iter().zip(after).enumerate();
    let segment = |(i, (from, to)): (usize, (&Vertex, &Vertex))| {
        let bulge = if from.bulge.abs() < STRAIGHT_BULGE { 0.0 } else { from.bulge };
        let refused = |why: &dyn std::fmt::Display| {
            Refusal::Broken(record.broken(format!("segment {} with the bulge {bulge}: {why}", i + 1)))
        };
        if bulge.abs() > FULL_BULGE {
            return Err(refused(&"more than a full turn can have"));
        }
        Curve::bulge(from.at, to.at, bulge).map_err(|error| refused(&error))
    };
    pairs.filter(|(i, (from, to))| *i < last || from.at != to.at).map(segment).collect()
}

fn chain(record: &Record, vertices: &[Vertex], closed: bool) -> Result<Vec<Curve>, Refusal> {
    let curves = segments(record, vertices, closed)?;
    if curves.is_empty() { Err(Refusal::Degenerate) } else { Ok(curves) }
}

/// An LWPOLYLINE.
pub(super) fn light_polyline(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let plane = Plane::of(record)?;
    let z = record.real(38, 0.0)?;
    let vertices = bulged_vertices(record, &mut record.pairs.iter().copied())?;
    let widths = [40, 41, 43].map(|code| record.reals(code));
    for width in widths.into_iter().collect::<Result<Vec<_>, _>>()?.concat() {
        if width != 0.0 {
            notices.add(WIDE);
        }
    }
    let closed = record.integer(70, 0)? & 1 != 0;
    let curves = chain(record, &vertices, closed)?.into_iter().map(|c| plane.place(c, z)).collect();
    let last_decimal = record.last_decimal(&[10, 20]);
    Ok(Figure::Curves { curves, level: plane.level(z), parts: "segment", last_decimal })
}

/// Vertices from groups 10 and 20, with bulges from group 42.
pub(super) fn bulged_vertices<'a>(
    record: &Record,
    pairs: &mut dyn Iterator<Item = Pair<'a>>,
) -> Result<Vec<Vertex>, ImportError> {
    let mut vertices: Vec<Vertex> = Vec::new();
    for pair in pairs {
        match (pair.code, vertices.last_mut()) {
            (10, _) => vertices.push(Vertex { at: Point::new(record.real_of(&pair)?, f64::NAN), bulge: 0.0 }),
            (20, Some(vertex)) => vertex.at.y = record.real_of(&pair)?,
            (42, Some(vertex)) => vertex.bulge = record.real_of(&pair)?,
            _ => {}
        }
    }
    match vertices.iter().position(|v| v.at.y.is_nan()) {
        Some(i) => Err(record.broken(format!("vertex {} has no y, group 20", i + 1))),
        None => Ok(vertices),
    }
}

/// A POLYLINE.
pub(super) fn polyline(
    record: &Record,
    followers: &[Record],
    notices: &mut Notices,
) -> Result<Figure<'static>, Refusal> {
    let flags = record.integer(70, 0)?;
    if flags & flag::POLYFACE != 0 {
        return polyface(record, followers);
    }
    let mut vertices = Vec::new();
    let mut points = Vec::new();
    for vertex in followers {
        // Where a spline runs near the vertices, those of its frame are not part of the line.
        if vertex.integer(70, 0)? & flag::FRAME == 0 {
            let at = vertex.point(10)?;
            points.push(at);
            vertices.push(Vertex { at: Point::new(at[0], at[1]), bulge: vertex.real(42, 0.0)? });
            if vertex.real(40, 0.0)? != 0.0 || vertex.real(41, 0.0)? != 0.0 {
                notices.add(WIDE);
            }
        }
    }
    let last_decimal = finest(followers.iter().map(|vertex| vertex.last_decimal(&[10, 20])));
    if flags & flag::GRID != 0 {
        return grid(record, flags, &points, last_decimal);
    }
    let closed = flags & flag::CLOSED != 0;
    if flags & flag::IN_SPACE != 0 {
        vertices.iter_mut().for_each(|v| v.bulge = 0.0);
        let (curves, level) = (chain(record, &vertices, closed)?, flat(&points));
        return Ok(Figure::Curves { curves, level, parts: "segment", last_decimal });
    }
    let plane = Plane::of(record)?;
    let z = record.real(30, 0.0)?;
    let curves = chain(record, &vertices, closed)?.into_iter().map(|c| plane.place(c, z)).collect();
    Ok(Figure::Curves { curves, level: plane.level(z), parts: "segment", last_decimal })
}

/// The outline of a triangle or quadrangle.
pub(super) fn face(record: &Record) -> Result<Figure<'static>, Refusal> {
    let corners = [record.point(10)?, record.point(11)?, record.point(12)?];
    let fourth = record.optional_point(13)?.unwrap_or(corners[2]);
    let [a, b, c] = corners;
    // The corners of a 3DFACE go around. Those of SOLID and TRACE go across.
    let in_space = record.kind == "3DFACE";
    let around = if in_space { [a, b, c, fourth] } else { [a, b, fourth, c] };
    let plane = if in_space { Plane::Above } else { Plane::parallel(record)? };
    let (mut around, level) = parallel(&around)?;
    around.dedup();
    let vertices: Vec<Vertex> = around.into_iter().map(|at| Vertex { at, bulge: 0.0 }).collect();
    if vertices.len() < 3 {
        return Err(Refusal::Degenerate);
    }
    let curves = segments(record, &vertices, true)?.into_iter().map(|c| plane.place(c, 0.0)).collect();
    let level = match level {
        Level::At(z) => plane.level(z),
        Level::Leaves => Level::Leaves,
    };
    let last_decimal = record.last_decimal(&[10, 20, 11, 21, 12, 22, 13, 23]);
    Ok(Figure::Curves { curves, level, parts: "edge", last_decimal })
}

/// The lines between numbered vertices, each drawn once.
fn edges(
    record: &Record,
    points: &[Point],
    pairs: impl Iterator<Item = (usize, usize)>,
) -> Result<Vec<Curve>, Refusal> {
    let mut drawn = BTreeSet::new();
    let mut curves = Vec::new();
    for (a, b) in pairs {
        if points[a] != points[b] && drawn.insert((a.min(b), a.max(b))) {
            curves.push(built(record, Curve::line(points[a], points[b]))?);
        }
    }
    if curves.is_empty() { Err(Refusal::Degenerate) } else { Ok(curves) }
}

/// The lines of a mesh of M by N vertices, closed along M or N by its flags.
fn grid(record: &Record, flags: i64, points: &[[f64; 3]], last_decimal: f64) -> Result<Figure<'static>, Refusal> {
    let (points, level) = parallel(points)?;
    let sizes = if record.integer(75, 0)? == 0 { [71, 72] } else { [73, 74] };
    let [m, n] = [record.integer(sizes[0], 0)?, record.integer(sizes[1], 0)?];
    let (m, n) = (usize::try_from(m).unwrap_or(0), usize::try_from(n).unwrap_or(0));
    if m.checked_mul(n) != Some(points.len()) {
        return Err(record.broken(format!("a mesh of {m} by {n} with {} vertices", points.len())).into());
    }
    let (along_m, along_n) = (flags & flag::CLOSED != 0, flags & flag::CLOSED_ALONG_N != 0);
    let pairs = (0..m).flat_map(|i| (0..n).map(move |j| (i, j))).flat_map(|(i, j)| {
        let down = (i + 1 < m || along_m).then_some((i * n + j, (i + 1) % m * n + j));
        let right = (j + 1 < n || along_n).then_some((i * n + j, i * n + (j + 1) % n));
        down.into_iter().chain(right)
    });
    Ok(Figure::Curves { curves: edges(record, &points, pairs)?, level, parts: "edge", last_decimal })
}

/// The edges of a mesh of faces, each with the numbers of up to four vertices. A negative number starts an invisible
/// edge.
fn polyface(record: &Record, followers: &[Record]) -> Result<Figure<'static>, Refusal> {
    let mut points = Vec::new();
    let mut pairs: Vec<(i64, i64)> = Vec::new();
    for vertex in followers {
        let flags = vertex.integer(70, 0)?;
        if flags & flag::COORDINATES != 0 {
            points.push(vertex.point(10)?);
        } else if flags & flag::FACE != 0 {
            let corners = [71, 72, 73, 74].map(|code| vertex.integer(code, 0));
            let corners: Vec<i64> = corners.into_iter().collect::<Result<_, _>>()?;
            let corners: Vec<i64> = corners.into_iter().filter(|&c| c != 0).collect();
            let after = corners.iter().cycle().skip(1);
            pairs.extend(corners.iter().zip(after).filter(|(a, _)| **a > 0).map(|(a, b)| (*a, b.saturating_abs())));
        }
    }
    let count = points.len() as i64;
    if let Some((a, b)) = pairs.iter().find(|(a, b)| *a > count || *b > count) {
        return Err(record.broken(format!("an edge from vertex {a} to {b} of {count}")).into());
    }
    let (points, level) = parallel(&points)?;
    let pairs = pairs.into_iter().map(|(a, b)| (a as usize - 1, b as usize - 1));
    let last_decimal = finest(followers.iter().map(|vertex| vertex.last_decimal(&[10, 20])));
    Ok(Figure::Curves { curves: edges(record, &points, pairs)?, level, parts: "edge", last_decimal })
}
