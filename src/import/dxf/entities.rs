//! One entity → its curves, in the coordinates of the drawing or of the block that it stands in.

use super::hatch;
use super::mline::mline;
use super::sections::{Record, finest};
use super::spline::spline;
use super::text;
use crate::curve::{Curve, CurveError};
use crate::geometry::{Point, Vec2};
use crate::import::ImportError;
use kurbo::Affine;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Height over extent below which an entity is flat: rounding of a file with six decimals.
const FLAT: f64 = 1e-6;
/// The share of a turn that may be missing of a full one: 2π with six decimals.
const CLOSING: f64 = 1e-7;
/// And the most that may be missing where the angles have few digits.
const LARGEST_CLOSING: f64 = 1e-3;
/// A bulge whose arc leaves its chord by no more than the rounding of its ends.
const STRAIGHT_BULGE: f64 = 1e-15;
/// A bulge whose arc is a full turn, up to rounding: it has no chord that could say where.
const FULL_BULGE: f64 = 1e8;

/// Why a text draws nothing.
pub(super) const NO_OUTLINE: &str = "glyphs of a font, no outline";
pub(super) const TILTED: &str = "not parallel to the XY plane";
pub(super) const DEGENERATE: &str = "of no extent";

/// Why an entity becomes no curve.
#[derive(Debug)]
pub(super) enum Refusal {
    /// It is left out and counted, for this reason.
    Skip(&'static str),
    /// Nothing is left of it.
    Degenerate,
    /// The file is wrong here.
    Broken(ImportError),
}

impl From<ImportError> for Refusal {
    fn from(error: ImportError) -> Self {
        Self::Broken(error)
    }
}

/// What an entity draws.
#[derive(Debug)]
pub(super) enum Figure<'a> {
    /// `parts` names what each curve is where there are several: "segment".
    Curves {
        curves: Vec<Curve>,
        level: Level,
        parts: &'static str,
        /// See [`DrawnCurve::last_decimal`](crate::domain::DrawnCurve::last_decimal).
        last_decimal: f64,
    },
    Point {
        at: Point,
        z: f64,
    },
    /// A filled area within closed outlines, by the odd-even rule.
    Fill {
        loops: Vec<Vec<Curve>>,
        last_decimal: f64,
    },
    /// A text, as the file encodes it.
    Text {
        at: Point,
        bytes: Vec<u8>,
    },
    Insert(Insert<'a>),
}

/// How an entity lies to the XY plane.
#[derive(Clone, Copy, Debug)]
pub(super) enum Level {
    /// Parallel to it, at this height.
    At(f64),
    /// It leaves the plane; what it draws is its image on it.
    Leaves,
}

/// A block to be drawn, once or in rows and columns.
#[derive(Debug)]
pub(super) struct Insert<'a> {
    pub block: &'a [u8],
    /// Of the block, its base point at the origin, to where its first instance is drawn.
    pub map: Affine,
    /// Height of the insertion point, and what a height in the block counts.
    pub z: f64,
    pub z_scale: f64,
    pub columns: i64,
    pub rows: i64,
    /// From a column to the next, and from a row to the next.
    pub steps: [Vec2; 2],
}

/// What is noticed about entities of a drawing, each told once.
#[derive(Debug, Default)]
pub(super) struct Notices(BTreeSet<&'static str>);

impl Notices {
    pub fn add(&mut self, sentence: &'static str) {
        self.0.insert(sentence);
    }

    pub fn into_notes(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(str::to_owned)
    }
}

/// What the entity that starts with `record` draws; `followers` are its vertices.
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
        "IMAGE" | "WIPEOUT" | "OLEFRAME" | "OLE2FRAME" | "PDFUNDERLAY" | "DWFUNDERLAY" | "DGNUNDERLAY" => "a picture",
        "VIEWPORT" => "a view",
        "MESH" => "a surface in space",
        _ => "no entity that is read here",
    }
}

// ---- planes ----

/// The plane of an entity that has an extrusion direction.
#[derive(Clone, Copy)]
enum Plane {
    /// Parallel to the XY plane, seen from above or from below.
    Above,
    Below,
    /// Any other, by its axes and normal, unit vectors.
    Tilted([[f64; 3]; 3]),
}

impl Plane {
    fn of(record: &Record) -> Result<Self, Refusal> {
        let normal = record.optional_point(210)?.unwrap_or([0.0, 0.0, 1.0]);
        let [x, y, z] = normal;
        if x.abs().max(y.abs()) <= FLAT * z.abs() {
            return Ok(if z < 0.0 { Self::Below } else { Self::Above });
        }
        if z.abs() <= FLAT * x.abs().max(y.abs()) {
            // Seen from its side, nothing of an area is left.
            return Err(Refusal::Skip(TILTED));
        }
        /// A normal nearer to the z axis than this has its x axis by the y axis (arbitrary axis algorithm).
        const NEAR_Z: f64 = 1.0 / 64.0;
        let n = unit(normal);
        let up = if n[0].abs() < NEAR_Z && n[1].abs() < NEAR_Z { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let across = unit(cross(up, n));
        Ok(Self::Tilted([across, cross(n, across), n]))
    }

    /// The plane of an entity that is only read where it is parallel to the XY plane.
    fn parallel(record: &Record) -> Result<Self, Refusal> {
        match Self::of(record)? {
            Self::Tilted(_) => Err(Refusal::Skip(TILTED)),
            plane => Ok(plane),
        }
    }

    /// From coordinates of the entity to those of the drawing: the arbitrary axis algorithm, by which the x axis of an entity whose normal
    /// is along z is that of the drawing, or its opposite. `z` is the height in the plane's own coordinates.
    fn affine(self, z: f64) -> Affine {
        match self {
            Self::Above => Affine::IDENTITY,
            Self::Below => Affine::scale_non_uniform(-1.0, 1.0),
            Self::Tilted([u, v, n]) => Affine::new([u[0], u[1], v[0], v[1], z * n[0], z * n[1]]),
        }
    }

    fn place(self, curve: Curve, z: f64) -> Curve {
        match self {
            Self::Above => curve,
            Self::Below | Self::Tilted(_) => curve.transformed(self.affine(z)),
        }
    }

    fn height(self, z: f64) -> f64 {
        if matches!(self, Self::Below) { -z } else { z }
    }

    fn level(self, z: f64) -> Level {
        match self {
            Self::Above | Self::Below => Level::At(self.height(z)),
            Self::Tilted(_) => Level::Leaves,
        }
    }

    fn normal(self) -> [f64; 3] {
        match self {
            Self::Above => [0.0, 0.0, 1.0],
            Self::Below => [0.0, 0.0, -1.0],
            Self::Tilted([_, _, n]) => n,
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along one that is not zero.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let most = v.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let v = v.map(|x| x / most);
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// How points of an entity that has no plane lie.
pub(super) fn flat(points: &[[f64; 3]]) -> Level {
    let spread = |axis: usize| {
        let values = points.iter().map(|p| p[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    if spread(2) > FLAT * spread(0).max(spread(1)) {
        return Level::Leaves;
    }
    Level::At(points.first().map_or(0.0, |p| p[2]))
}

/// The same, of an entity that is only read where it is parallel to the XY plane; its points in it.
fn parallel(points: &[[f64; 3]]) -> Result<(Vec<Point>, Level), Refusal> {
    match flat(points) {
        Level::Leaves => Err(Refusal::Skip(TILTED)),
        level @ Level::At(_) => Ok((points.iter().map(|p| Point::new(p[0], p[1])).collect(), level)),
    }
}

/// A curve that its entity describes in full: nothing to draw where it has no extent, an error where its data contradict each other.
pub(super) fn built(record: &Record, curve: Result<Curve, CurveError>) -> Result<Curve, Refusal> {
    curve.map_err(|error| match error {
        CurveError::Radius { .. } | CurveError::Sweep { .. } => Refusal::Degenerate,
        other => Refusal::Broken(record.broken(other)),
    })
}

pub(super) fn single(curve: Curve, level: Level, last_decimal: f64) -> Figure<'static> {
    Figure::Curves { curves: vec![curve], level, parts: "", last_decimal }
}

// ---- lines, circles, ellipses ----

fn line(record: &Record) -> Result<Figure<'static>, Refusal> {
    let ends = [record.point(10)?, record.point(11)?];
    let [a, b] = ends.map(|p| Point::new(p[0], p[1]));
    Ok(single(built(record, Curve::line(a, b))?, flat(&ends), record.last_decimal(&[10, 20, 11, 21])))
}

/// A way counter-clockwise from one angle to another, as a positive part of a full turn; all of it where they are the same, or where
/// what is missing of it is within two units of the last decimal in which they are written.
pub(super) fn sweep(from: f64, to: f64, turn: f64, last_decimal: f64, notices: &mut Notices) -> f64 {
    let sweep = (to - from).rem_euclid(turn);
    let is_whole = |missing: f64| sweep > turn - missing || sweep == 0.0 || (to - from).abs() >= turn - missing;
    if is_whole(CLOSING * turn) {
        return turn;
    }
    if is_whole((2.0 * last_decimal).min(LARGEST_CLOSING * turn)) {
        notices.add("Arcs that miss a full turn by no more than their last decimal can tell are full.");
        return turn;
    }
    sweep
}

fn arc(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let plane = Plane::of(record)?;
    let [x, y, z] = record.point(10)?;
    let (center, radius) = (Point::new(x, y), record.required(40)?);
    let curve = if record.kind == "CIRCLE" {
        Curve::circle(center, radius)
    } else {
        let (from, to) = (record.required(50)?, record.required(51)?);
        let sweep = sweep(from, to, 360.0, record.last_decimal(&[50, 51]), notices);
        Curve::arc(center, radius, from.to_radians(), sweep.to_radians())
    };
    // The ends lie at the angles as they were rounded.
    let angle = radius * record.last_decimal(&[50, 51]).to_radians();
    let last_decimal = record.last_decimal(&[10, 20, 40]).max(angle);
    Ok(single(plane.place(built(record, curve)?, z), plane.level(z), last_decimal))
}

/// Center and axis of an ellipse are coordinates of the drawing; its extrusion direction says where the minor axis points.
fn ellipse(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let plane = Plane::of(record)?;
    let ([x, y, z], axis) = (record.point(10)?, record.point(11)?);
    let major = Vec2::new(axis[0], axis[1]);
    let leaves = axis[2].abs() > FLAT * axis[0].abs().max(axis[1].abs());
    let [ux, uy, _] = cross(plane.normal(), if leaves { axis } else { [axis[0], axis[1], 0.0] });
    let minor = Vec2::new(ux, uy) * record.required(40)?;
    let (from, to) = (record.real(41, 0.0)?, record.real(42, TAU)?);
    let sweep = sweep(from, to, TAU, record.last_decimal(&[41, 42]), notices);
    let curve = Curve::ellipse(Point::new(x, y), major, minor, from, sweep);
    let level = match plane.level(z) {
        Level::At(_) if !leaves => Level::At(z),
        Level::At(_) | Level::Leaves => Level::Leaves,
    };
    let rounded = record.last_decimal(&[40]).max(record.last_decimal(&[41, 42]));
    let last_decimal = record.last_decimal(&[10, 20, 11, 21]).max(major.hypot() * rounded);
    Ok(single(built(record, curve)?, level, last_decimal))
}

// ---- polylines ----

/// A vertex of a polyline, with the bulge of the segment that it starts.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub at: Point,
    pub bulge: f64,
}

/// The segments of a polyline, arcs where they have a bulge. The closing one is left out where its ends are the same.
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

const WIDE: &str = "Polylines of some width are drawn as their centre lines.";

fn light_polyline(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
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

/// Vertices of groups 10 and 20, with bulges of group 42.
pub(super) fn bulged_vertices<'a>(
    record: &Record,
    pairs: &mut dyn Iterator<Item = super::pairs::Pair<'a>>,
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

/// Bits of group 70 of a POLYLINE and of its VERTEX entities.
mod flag {
    pub const CLOSED: i64 = 1;
    pub const IN_SPACE: i64 = 8;
    pub const GRID: i64 = 16;
    pub const CLOSED_ALONG_N: i64 = 32;
    pub const POLYFACE: i64 = 64;
    pub const FRAME: i64 = 16;
    pub const FACE: i64 = 128;
    pub const COORDINATES: i64 = 64;
}

fn polyline(record: &Record, followers: &[Record], notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let flags = record.integer(70, 0)?;
    if flags & flag::POLYFACE != 0 {
        return polyface(record, followers);
    }
    let mut vertices = Vec::new();
    let mut points = Vec::new();
    for vertex in followers {
        // Where a spline was put through the vertices, those drawn by the user are its frame, and no part of the line.
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

// ---- faces ----

/// The outline of a triangle or quadrangle.
fn face(record: &Record) -> Result<Figure<'static>, Refusal> {
    let corners = [record.point(10)?, record.point(11)?, record.point(12)?];
    let fourth = record.optional_point(13)?.unwrap_or(corners[2]);
    let [a, b, c] = corners;
    // The corners of a 3DFACE go around; those of the older two go across.
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

/// Lines between vertices by their numbers, each drawn once.
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

/// A mesh of M by N vertices, closed along M or N where its flags say so.
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

/// A mesh of faces, each by the numbers of up to four vertices; a negative number starts an edge that is not shown.
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

// ---- blocks ----

fn insert<'a>(record: &Record<'a>) -> Result<Figure<'a>, Refusal> {
    let plane = Plane::parallel(record)?;
    let [x, y, z] = record.point(10)?;
    let scale = [record.real(41, 1.0)?, record.real(42, 1.0)?];
    if scale.contains(&0.0) {
        return Err(Refusal::Skip("a block drawn with the scale 0"));
    }
    let turn = turn(record.real(50, 0.0)?);
    let map = plane.affine(0.0) * Affine::translate((x, y)) * turn * Affine::scale_non_uniform(scale[0], scale[1]);
    // Rows and columns run along the turned axes, and are not scaled.
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
