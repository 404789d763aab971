//! One entity → its curves, in the coordinates of the drawing or of the block that it stands in.

use super::hatch;
use super::sections::{Record, finest};
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
/// A bulge whose arc leaves its chord by no more than the rounding of its ends.
const STRAIGHT_BULGE: f64 = 1e-15;
/// A bulge whose arc is a full turn, up to rounding: it has no chord that could say where.
const FULL_BULGE: f64 = 1e8;
/// The highest degree of a spline; curves of CAD systems end at 25. Each span costs the degree, so memory stays a share of the file.
const MAX_DEGREE: i64 = 30;

const TILTED: &str = "not parallel to the XY plane";
const DEGENERATE: &str = "of no extent";

/// Why an entity becomes no curve.
#[derive(Debug)]
pub(super) enum Refusal {
    /// It is left out and counted, for this reason.
    Skip(&'static str),
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
        z: f64,
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
    Insert(Insert<'a>),
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
        "CIRCLE" | "ARC" => arc(record),
        "ELLIPSE" => ellipse(record),
        "LWPOLYLINE" => light_polyline(record, notices),
        "POLYLINE" => polyline(record, followers, notices),
        "SPLINE" | "HELIX" => spline(record, notices),
        "SOLID" | "TRACE" | "3DFACE" => face(record),
        "POINT" => {
            let [x, y, z] = record.point(10)?;
            Ok(Figure::Point { at: Point::new(x, y), z })
        }
        "HATCH" | "MPOLYGON" => {
            let map = Plane::of(record)?.map();
            let placed = |outline: Vec<Curve>| outline.into_iter().map(|curve| map.place(curve)).collect();
            let loops = hatch::outlines(record, notices)?.into_iter().map(placed).collect();
            Ok(Figure::Fill { loops, last_decimal: record.last_decimal(&[10, 20, 11, 21]) })
        }
        "INSERT" => insert(record),
        kind => Err(Refusal::Skip(why_not(kind))),
    }
}

fn why_not(kind: &str) -> &'static str {
    match kind {
        "TEXT" | "MTEXT" | "ATTRIB" | "ATTDEF" | "RTEXT" | "ARCALIGNEDTEXT" | "SHAPE" => "glyphs of a font, no outline",
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
        "MLINE" => "a multiline (explode it into lines)",
        _ => "no entity that is read here",
    }
}

// ---- planes ----

/// The plane of an entity that has an extrusion direction: parallel to the XY plane, seen from above or from below.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Plane {
    Above,
    Below,
}

impl Plane {
    fn of(record: &Record) -> Result<Self, Refusal> {
        let [x, y, z] = record.optional_point(210)?.unwrap_or([0.0, 0.0, 1.0]);
        if x.abs().max(y.abs()) > FLAT * z.abs() {
            return Err(Refusal::Skip(TILTED));
        }
        Ok(if z < 0.0 { Self::Below } else { Self::Above })
    }

    /// From coordinates of the entity to those of the drawing: the arbitrary axis algorithm for a normal along z, by which the x axis
    /// of the entity is that of the drawing, or its opposite.
    fn map(self) -> Map {
        Map { mirrored: self == Self::Below }
    }
}

/// The change of coordinates of a [`Plane`].
#[derive(Clone, Copy)]
struct Map {
    mirrored: bool,
}

impl Map {
    fn affine(self) -> Affine {
        Affine::scale_non_uniform(if self.mirrored { -1.0 } else { 1.0 }, 1.0)
    }

    fn place(self, curve: Curve) -> Curve {
        if self.mirrored { curve.transformed(self.affine()) } else { curve }
    }

    fn height(self, z: f64) -> f64 {
        if self.mirrored { -z } else { z }
    }
}

/// Points of the drawing as points of the plane, with their height.
fn flat(points: &[[f64; 3]]) -> Result<(Vec<Point>, f64), Refusal> {
    let range = |axis: usize| {
        let values = points.iter().map(|p| p[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let spread = |axis: usize| {
        let (low, high) = range(axis);
        high - low
    };
    if spread(2) > FLAT * spread(0).max(spread(1)) {
        return Err(Refusal::Skip(TILTED));
    }
    Ok((points.iter().map(|p| Point::new(p[0], p[1])).collect(), points.first().map_or(0.0, |p| p[2])))
}

/// A curve that its entity describes in full: nothing to draw where it has no extent, an error where its data contradict each other.
fn built(record: &Record, curve: Result<Curve, CurveError>) -> Result<Curve, Refusal> {
    curve.map_err(|error| match error {
        CurveError::Radius { .. } | CurveError::Sweep { .. } => Refusal::Skip(DEGENERATE),
        other => Refusal::Broken(record.broken(other)),
    })
}

fn single(curve: Curve, z: f64, last_decimal: f64) -> Figure<'static> {
    Figure::Curves { curves: vec![curve], z, parts: "", last_decimal }
}

// ---- lines, circles, ellipses ----

fn line(record: &Record) -> Result<Figure<'static>, Refusal> {
    let (ends, z) = flat(&[record.point(10)?, record.point(11)?])?;
    Ok(single(built(record, Curve::line(ends[0], ends[1]))?, z, record.last_decimal(&[10, 20, 11, 21])))
}

/// A way counter-clockwise from one angle to another, as a positive part of a full turn; all of it where they are the same.
pub(super) fn sweep(from: f64, to: f64, turn: f64) -> f64 {
    let sweep = (to - from).rem_euclid(turn);
    let is_whole = sweep > turn * (1.0 - CLOSING) || sweep == 0.0 || (to - from).abs() >= turn * (1.0 - CLOSING);
    if is_whole { turn } else { sweep }
}

fn arc(record: &Record) -> Result<Figure<'static>, Refusal> {
    let map = Plane::of(record)?.map();
    let [x, y, z] = record.point(10)?;
    let (center, radius) = (Point::new(x, y), record.required(40)?);
    let curve = if record.kind == "CIRCLE" {
        Curve::circle(center, radius)
    } else {
        let (from, to) = (record.required(50)?, record.required(51)?);
        Curve::arc(center, radius, from.to_radians(), sweep(from, to, 360.0).to_radians())
    };
    // The ends lie at the angles as they were rounded.
    let angle = radius * record.last_decimal(&[50, 51]).to_radians();
    let last_decimal = record.last_decimal(&[10, 20, 40]).max(angle);
    Ok(single(map.place(built(record, curve)?), map.height(z), last_decimal))
}

/// Center and axis of an ellipse are coordinates of the drawing; its extrusion direction says where the minor axis points.
fn ellipse(record: &Record) -> Result<Figure<'static>, Refusal> {
    let plane = Plane::of(record)?;
    let ([x, y, z], [ux, uy, uz]) = (record.point(10)?, record.point(11)?);
    let major = Vec2::new(ux, uy);
    if uz.abs() > FLAT * ux.abs().max(uy.abs()) {
        return Err(Refusal::Skip(TILTED));
    }
    let ratio = if plane == Plane::Below { -record.required(40)? } else { record.required(40)? };
    let minor = Vec2::new(-major.y, major.x) * ratio;
    let (from, to) = (record.real(41, 0.0)?, record.real(42, TAU)?);
    let curve = Curve::ellipse(Point::new(x, y), major, minor, from, sweep(from, to, TAU));
    let rounded = record.last_decimal(&[40]).max(record.last_decimal(&[41, 42]));
    let last_decimal = record.last_decimal(&[10, 20, 11, 21]).max(major.hypot() * rounded);
    Ok(single(built(record, curve)?, z, last_decimal))
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
    if curves.is_empty() { Err(Refusal::Skip(DEGENERATE)) } else { Ok(curves) }
}

const WIDE: &str = "Polylines of some width are drawn as their centre lines.";

fn light_polyline(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let map = Plane::of(record)?.map();
    let vertices = bulged_vertices(record, &mut record.pairs.iter().copied())?;
    let widths = [40, 41, 43].map(|code| record.reals(code));
    for width in widths.into_iter().collect::<Result<Vec<_>, _>>()?.concat() {
        if width != 0.0 {
            notices.add(WIDE);
        }
    }
    let closed = record.integer(70, 0)? & 1 != 0;
    let curves = chain(record, &vertices, closed)?.into_iter().map(|c| map.place(c)).collect();
    let last_decimal = record.last_decimal(&[10, 20]);
    Ok(Figure::Curves { curves, z: map.height(record.real(38, 0.0)?), parts: "segment", last_decimal })
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
        let (_, z) = flat(&points)?;
        vertices.iter_mut().for_each(|v| v.bulge = 0.0);
        return Ok(Figure::Curves { curves: chain(record, &vertices, closed)?, z, parts: "segment", last_decimal });
    }
    let map = Plane::of(record)?.map();
    let z = map.height(record.real(30, 0.0)?);
    let curves = chain(record, &vertices, closed)?.into_iter().map(|c| map.place(c)).collect();
    Ok(Figure::Curves { curves, z, parts: "segment", last_decimal })
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
    let map = if in_space { Map { mirrored: false } } else { Plane::of(record)?.map() };
    let (mut around, z) = flat(&around)?;
    around.dedup();
    let vertices: Vec<Vertex> = around.into_iter().map(|at| Vertex { at, bulge: 0.0 }).collect();
    if vertices.len() < 3 {
        return Err(Refusal::Skip(DEGENERATE));
    }
    let curves = segments(record, &vertices, true)?.into_iter().map(|c| map.place(c)).collect();
    let last_decimal = record.last_decimal(&[10, 20, 11, 21, 12, 22, 13, 23]);
    Ok(Figure::Curves { curves, z: map.height(z), parts: "edge", last_decimal })
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
    if curves.is_empty() { Err(Refusal::Skip(DEGENERATE)) } else { Ok(curves) }
}

/// A mesh of M by N vertices, closed along M or N where its flags say so.
fn grid(record: &Record, flags: i64, points: &[[f64; 3]], last_decimal: f64) -> Result<Figure<'static>, Refusal> {
    let (points, z) = flat(points)?;
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
    Ok(Figure::Curves { curves: edges(record, &points, pairs)?, z, parts: "edge", last_decimal })
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
    let (points, z) = flat(&points)?;
    let pairs = pairs.into_iter().map(|(a, b)| (a as usize - 1, b as usize - 1));
    let last_decimal = finest(followers.iter().map(|vertex| vertex.last_decimal(&[10, 20])));
    Ok(Figure::Curves { curves: edges(record, &points, pairs)?, z, parts: "edge", last_decimal })
}

// ---- splines ----

/// What a spline is drawn from, of a SPLINE entity or of an edge of a hatch.
pub(super) struct SplineData {
    pub degree: i64,
    pub knots: Vec<f64>,
    pub control: Vec<Point>,
    pub weights: Vec<f64>,
    pub fit: Vec<Point>,
    pub closed: bool,
}

fn spline(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let (control, fit) = (record.points(10)?, record.points(11)?);
    let (used, z) = flat(if control.is_empty() { &fit } else { &control })?;
    let plain = |points: &[[f64; 3]]| points.iter().map(|p| Point::new(p[0], p[1])).collect();
    let data = SplineData {
        degree: record.integer(71, 3)?,
        knots: record.reals(40)?,
        control: if control.is_empty() { Vec::new() } else { used },
        weights: record.reals(41)?,
        fit: plain(&fit),
        closed: record.integer(70, 0)? & 1 != 0,
    };
    if record.find(12).or(record.find(13)).is_some() && data.control.is_empty() {
        notices.add("End tangents of splines through fit points were not used.");
    }
    let codes = if data.control.is_empty() { [11, 21] } else { [10, 20] };
    Ok(single(data.curve(record, notices)?, z, record.last_decimal(&codes)))
}

impl SplineData {
    pub fn curve(self, record: &Record, notices: &mut Notices) -> Result<Curve, Refusal> {
        if self.control.is_empty() {
            return self.through_fit_points(record, notices);
        }
        if !(1..=MAX_DEGREE).contains(&self.degree) {
            return Err(record.broken(format!("a spline of degree {}, not 1 to {MAX_DEGREE}", self.degree)).into());
        }
        let degree = self.degree as usize;
        let (knots, control, weights) = self.unwrapped(degree, notices);
        let curve = Curve::nurbs(degree, &knots, &control, Some(&weights[..]).filter(|w| !w.is_empty()));
        built(record, curve)
    }

    fn through_fit_points(self, record: &Record, notices: &mut Notices) -> Result<Curve, Refusal> {
        notices.add(
            "Splines that have fit points only are drawn as natural cubic splines through them, or periodic ones.",
        );
        let mut distinct = self.fit.clone();
        distinct.dedup();
        match distinct.len() {
            0 => Err(record.broken("a spline without points").into()),
            1 => Err(Refusal::Skip(DEGENERATE)),
            _ if self.closed => built(record, Curve::periodic_spline(&self.fit)),
            _ => built(record, Curve::natural_spline(&self.fit)),
        }
    }

    /// Knots, control points and weights with as many knots as there are control points, degree and one together.
    ///
    /// Of a periodic spline some writers give one period only: a knot more than control points. It goes on by its period, each knot
    /// with the control point of the period before.
    fn unwrapped(self, degree: usize, notices: &mut Notices) -> (Vec<f64>, Vec<Point>, Vec<f64>) {
        let Self { mut knots, mut control, mut weights, closed, .. } = self;
        let n = control.len();
        if knots.is_empty() && n > degree {
            notices.add("Splines without knots are drawn with uniform ones.");
            knots = (0..=n + degree).map(|i| (i.max(degree) - degree).min(n - degree) as f64).collect();
        } else if closed && knots.len() == n + 1 && degree < n {
            let period = knots[n] - knots[0];
            let before: Vec<f64> = knots[n - degree..n].iter().map(|k| k - period).collect();
            let after: Vec<f64> = knots[1..=degree].iter().map(|k| k + period).collect();
            knots = [before, knots, after].concat();
            control.extend_from_within(..degree);
            if weights.len() == n {
                weights.extend_from_within(..degree);
            }
        }
        (knots, control, weights)
    }
}

// ---- blocks ----

fn insert<'a>(record: &Record<'a>) -> Result<Figure<'a>, Refusal> {
    let plane = Plane::of(record)?.map();
    let [x, y, z] = record.point(10)?;
    let scale = [record.real(41, 1.0)?, record.real(42, 1.0)?];
    if scale.contains(&0.0) {
        return Err(Refusal::Skip("a block drawn with the scale 0"));
    }
    let turn = turn(record.real(50, 0.0)?);
    let map = plane.affine() * Affine::translate((x, y)) * turn * Affine::scale_non_uniform(scale[0], scale[1]);
    // Rows and columns run along the turned axes, and are not scaled.
    let step = |v: Vec2| {
        let [a, b, c, d, _, _] = (plane.affine() * turn).as_coeffs();
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
