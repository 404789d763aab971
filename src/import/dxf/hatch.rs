//! The boundary of a HATCH: paths of polylines, or of lines, arcs, elliptic arcs and splines.
//!
//! ```text
//!    91 ── number of paths
//!    92 ── path: its flags                      edge types (72), each with its own groups:
//!    │     polyline: 10 20 42 of each vertex      1  line       10 20 to 11 21
//!    │     else: 93, then edges                   2  arc        10 20 center, 40 radius, 50 51 angles, 73 sense
//!    │       72 ── edge ● ── 72 ── edge ● ──      3  ellipse    10 20 center, 11 21 major axis, 40 ratio, 50 51, 73
//!    92 ── next path …                            4  spline     94 degree, 40 knots, 10 20 42 control points
//!    75 ── hatch style
//!
//!    Clockwise edges (73 = 0) measure their angles clockwise. Edges are joined into loops; a line closes each gap.
//! ```

use super::arc::sweep;
use super::figure::{Notices, Refusal};
use super::pairs::Pair;
use super::polyline::{bulged_vertices, segments};
use super::sections::Record;
use super::spline::SplineData;
use crate::curve::{Curve, CurveError};
use crate::geometry::{Point, Rect, Vec2, direction};
use crate::import::ImportError;
use std::f64::consts::TAU;

/// Bits of group 92: the use of a path.
mod flag {
    /// An outer boundary.
    pub const EXTERNAL: i64 = 1;
    /// The path is a polyline.
    pub const POLYLINE: i64 = 2;
    /// A box around text.
    pub const TEXT_BOX: i64 = 8;
    /// The outermost boundary.
    pub const OUTERMOST: i64 = 16;
}

/// Largest product of paths and pairs for which loops are compared with each other to find their nesting. The flags
/// give the nesting, too, but many writers set all paths to external, or none. Flags of larger hatches are used.
const COMPARED: usize = 1 << 22;

/// A path with the pairs of its description.
struct Path<'r, 'a> {
    flags: i64,
    pairs: &'r [Pair<'a>],
}

/// The closed outlines of the hatch. It lies between them by the even-odd rule.
pub(super) fn outlines(record: &Record, notices: &mut Notices) -> Result<Vec<Vec<Curve>>, Refusal> {
    let mut paths = paths(record)?;
    if paths.iter().any(|p| p.flags & flag::TEXT_BOX != 0) {
        notices.add("Boxes that keep hatches clear of text were left out.");
        paths.retain(|p| p.flags & flag::TEXT_BOX == 0);
    }
    // Style of islands: 0 hatches every other area, 1 stops at the second, 2 ignores islands.
    let (most, counted) = match record.integer(75, 0)? {
        1 => (1, flag::EXTERNAL | flag::OUTERMOST),
        2 => (0, flag::EXTERNAL),
        _ => (usize::MAX, 0),
    };
    let pairs = paths.iter().map(|path| path.pairs.len()).sum();
    let is_small = paths.len().saturating_mul(pairs) <= COMPARED;
    if !is_small && paths.iter().any(|p| p.flags & counted != 0) {
        paths.retain(|p| p.flags & counted != 0);
    }
    let mut loops: Vec<Vec<Curve>> = Vec::new();
    for path in &paths {
        // An MPOLYGON has polylines only.
        if path.flags & flag::POLYLINE != 0 || record.kind == "MPOLYGON" {
            let vertices = bulged_vertices(record, &mut path.pairs.iter().copied())?;
            loops.push(segments(record, &vertices, true)?);
        } else {
            loops.extend(closed(edges(record, path.pairs, notices)?, notices));
        }
    }
    loops.retain(|outline| !outline.is_empty());
    if is_small && most < loops.len() {
        retain_depth(&mut loops, most);
    }
    if loops.is_empty() { Err(Refusal::Skip("of no boundary")) } else { Ok(loops) }
}

/// Removes the loops inside of more than `most` other loops.
fn retain_depth(loops: &mut Vec<Vec<Curve>>, most: usize) {
    let bounds: Vec<Rect> = loops
        .iter()
        .map(|outline| outline.iter().map(Curve::bounds).reduce(|a, b| a.union(b)).unwrap_or_default())
        .collect();
    let depth = |i: usize| {
        let at = loops[i][0].point(0.5037);
        let others = (0..loops.len()).filter(|&j| j != i && bounds[j].contains(at));
        others.filter(|&j| is_within(&loops[j], at)).count()
    };
    let depths: Vec<usize> = (0..loops.len()).map(depth).collect();
    let mut depths = depths.into_iter();
    loops.retain(|_| depths.next().is_some_and(|depth| depth <= most));
}

/// Whether a point lies inside of a closed outline, by the first of a few lines through the point that meets no joint.
fn is_within(outline: &[Curve], at: Point) -> bool {
    const ANGLES_RAD: [f64; 4] = [0.0, 0.37, 1.13, 2.41];
    for angle in ANGLES_RAD {
        let along = direction(angle);
        let places = |curve: &Curve| {
            let crossings = curve.line_crossings(at, along, 0.0, 1.0).into_iter();
            crossings.map(|t| (curve.point(t) - at).dot(along)).collect::<Vec<_>>()
        };
        let places: Vec<f64> = outline.iter().flat_map(places).collect();
        if places.len().is_multiple_of(2) {
            return places.iter().filter(|&&x| x > 0.0).count() % 2 == 1;
        }
    }
    false
}

/// The paths. Each ends where the next one's flags begin, the last where the hatch style begins.
fn paths<'r, 'a>(record: &'r Record<'a>) -> Result<Vec<Path<'r, 'a>>, ImportError> {
    let start = record.pairs.iter().position(|p| p.code == 91).unwrap_or(record.pairs.len());
    let within = &record.pairs[start..];
    let end = within.iter().position(|p| matches!(p.code, 75 | 76)).unwrap_or(within.len());
    let starts: Vec<usize> = (0..end).filter(|&i| within[i].code == 92).collect();
    let ends = starts.iter().skip(1).copied().chain([end]);
    let path = |(&start, end): (&usize, usize)| {
        Ok(Path { flags: record.integer_of(&within[start])?, pairs: &within[start + 1..end] })
    };
    starts.iter().zip(ends).map(path).collect()
}

/// The edges of a path. Each ends where the type of the next one, group 72, begins.
fn edges(record: &Record, pairs: &[Pair], notices: &mut Notices) -> Result<Vec<Curve>, Refusal> {
    let starts: Vec<usize> = (0..pairs.len()).filter(|&i| pairs[i].code == 72).collect();
    let ends = starts.iter().skip(1).copied().chain([pairs.len()]);
    let handle = record.find(5);
    let mut curves = Vec::new();
    for (&start, end) in starts.iter().zip(ends) {
        let edge = record.part(handle, &pairs[start + 1..end]);
        let curve = match record.integer_of(&pairs[start])? {
            1 => Curve::line(at(&edge, 10)?, at(&edge, 11)?),
            2 => arc(&edge, notices)?,
            3 => ellipse(&edge, notices)?,
            4 => {
                curves.push(SplineData::of_edge(&edge)?.curve(record, notices)?);
                continue;
            }
            other => return Err(record.broken(format!("a boundary edge of type {other}")).into()),
        };
        match curve {
            Ok(curve) => curves.push(curve),
            // An arc without extent leaves no gap.
            Err(CurveError::Radius { .. } | CurveError::Sweep { .. }) => {}
            Err(error) => return Err(record.broken(error).into()),
        }
    }
    Ok(curves)
}

fn at(edge: &Record, code: i32) -> Result<Point, ImportError> {
    let [x, y, _] = edge.point(code)?;
    Ok(Point::new(x, y))
}

/// Start and sweep in degrees. Clockwise edges have their angles measured clockwise.
fn angles(edge: &Record, notices: &mut Notices) -> Result<(f64, f64), ImportError> {
    let (from, to) = (edge.required(50)?, edge.required(51)?);
    let sweep = sweep(from, to, 360.0, edge.last_decimal(&[50, 51]), notices);
    Ok(if edge.integer(73, 1)? == 0 { (-from, -sweep) } else { (from, sweep) })
}

fn arc(edge: &Record, notices: &mut Notices) -> Result<Result<Curve, CurveError>, ImportError> {
    let (start, sweep) = angles(edge, notices)?;
    Ok(Curve::arc(at(edge, 10)?, edge.required(40)?, start.to_radians(), sweep.to_radians()))
}

/// The angles are those of the rays to the ends. Those of an ELLIPSE are parameters.
fn ellipse(edge: &Record, notices: &mut Notices) -> Result<Result<Curve, CurveError>, ImportError> {
    let (major, ratio) = (at(edge, 11)?.to_vec2(), edge.required(40)?);
    let (start, sweep) = angles(edge, notices)?;
    let parameter = |degrees: f64| {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        libm::atan2(sin, cos * ratio.abs())
    };
    let from = parameter(start);
    let turn = if sweep.abs() == 360.0 {
        TAU.copysign(sweep)
    } else {
        let way = sweep.signum();
        way * (way * (parameter(start + sweep) - from)).rem_euclid(TAU)
    };
    let minor = Vec2::new(-major.y, major.x) * ratio;
    Ok(Curve::ellipse(at(edge, 10)?, major, minor, from, turn))
}

/// A wider gap in a boundary, as a part of its size, is closed by a line. The arrangement heals gaps up to the same
/// part of the whole drawing.
const GAP: f64 = 1e-6;

/// The loops of a path. Edges are reversed so that each follows the one before, and a line closes each gap.
///
/// ```text
///    edges as found:  a ──▶ b    c ◀── b'   c' ──▶ a'          b, b' etc. are one place, up to `gap`
///    loop:            a ──▶ b ─▶ b' ──▶ c ─▶ c' ──▶ a' ─▶ a    ─▶ line in a gap wider than `gap`
/// ```
fn closed(edges: Vec<Curve>, notices: &mut Notices) -> Vec<Vec<Curve>> {
    let bounds = edges.iter().map(|e| Rect::from_points(e.start(), e.end())).reduce(|a, b| a.union(b));
    let gap = GAP * bounds.map_or(0.0, |b| b.width().max(b.height()));
    let apart = |a: Point, b: Point| (a - b).hypot() > gap;
    let mut loops: Vec<Vec<Curve>> = Vec::new();
    let mut following: Vec<Curve> = Vec::new();
    let mut bridge = |following: &mut Vec<Curve>, from: Point, to: Point| {
        if apart(from, to)
            && let Ok(line) = Curve::line(from, to)
        {
            notices.add("Gaps in the boundaries of hatches were closed by lines.");
            following.push(line);
        }
    };
    // Start and end of the current loop.
    let mut open: Option<[Point; 2]> = None;
    let mut edges = edges.into_iter().peekable();
    while let Some(edge) = edges.next() {
        let turned = match (open, edges.peek()) {
            (Some([_, end]), _) => (edge.start() - end).hypot() > (edge.end() - end).hypot(),
            (None, Some(next)) => {
                let reach = |p: Point| (next.start() - p).hypot().min((next.end() - p).hypot());
                reach(edge.start()) < reach(edge.end())
            }
            (None, None) => false,
        };
        let edge = if turned { edge.reversed() } else { edge };
        let start = open.map_or(edge.start(), |[start, end]| {
            bridge(&mut following, end, edge.start());
            start
        });
        let end = edge.end();
        following.push(edge);
        open = apart(start, end).then_some([start, end]);
        if open.is_none() {
            loops.push(std::mem::take(&mut following));
        }
    }
    if let Some([start, end]) = open {
        bridge(&mut following, end, start);
        loops.push(following);
    }
    loops
}
