//! Triangle's `.poly` and `.node` files (Shewchuk): vertices, segments, hole points and region points.
//!
//! A marker is the name of its boundary, as text; 0 and no marker are `boundary`. The attribute of a region point is
//! the name of its region. Vertices without a segment are kept as points. As in Triangle, each bounded face is meshed
//! unless a hole point reaches it ([`FillRule::Regions`]). Without segments the domain is the convex hull, whose lines
//! are named `hull`.

use super::{Certainty, Facts, ImportError, number, numbers, surface, tokens, without_bom};
use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve, DrawnPoint, FillRule, Seed, SeedKind, Skipped};
use crate::geometry::exact::{Orientation, orient};
use crate::geometry::{Point, bounds_of, magnitude, scaled, unit_scale};
use crate::ids::{NameId, Names};
use std::collections::BTreeMap;

/// Name of the boundary whose segments carry marker 0 or none.
const UNMARKED: &str = "boundary";
const FORMAT_HELP: &str = "see https://www.cs.cmu.edu/~quake/triangle.poly.html for the format";

/// The facts of `.poly`.
pub(super) const FACTS: Facts = Facts {
    name: "poly",
    suffixes: &["poly"],
    sign: |bytes| sniff(bytes) == Some(Holds::More) || surface::begins_as_tetgen(bytes),
    certainty: Certainty::Shape,
    read: |bytes, stem, options| match surface::is_tetgen(bytes) {
        true => surface::read_poly(bytes).map(Into::into),
        false => read_poly(bytes, stem, options.nodes.as_deref()).map(Into::into),
    },
};

/// The facts of `.node`.
pub(super) const FACTS_OF_NODE: Facts = Facts {
    name: "node",
    suffixes: &["node"],
    sign: |bytes| sniff(bytes) == Some(Holds::Vertices),
    certainty: Certainty::Shape,
    read: |bytes, stem, _| read_node(bytes, stem).map(Into::into),
};

/// Lines that are not empty, with their numbers. Comments (from `#` to the end of the line) are removed.
struct Rows<'a> {
    rest: &'a [u8],
    line: usize,
}

#[derive(Clone, Copy)]
struct Row<'a> {
    text: &'a [u8],
    line: usize,
}

impl<'a> Rows<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), line: 0 }
    }

    /// The first row.
    fn header(&mut self) -> Result<Row<'a>, ImportError> {
        self.next().ok_or_else(|| ImportError::at(self.line.max(1), "the file is empty", FORMAT_HELP))
    }
}

impl<'a> Iterator for Rows<'a> {
    type Item = Row<'a>;

    fn next(&mut self) -> Option<Row<'a>> {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(self.rest.len());
            let (text, after) = self.rest.split_at(end);
            let newline = if after.starts_with(b"\r\n") { 2 } else { after.len().min(1) };
            self.rest = &after[newline..];
            self.line += 1;
            let text = text.split(|&b| b == b'#').next().unwrap_or_default();
            if text.iter().any(|b| !b.is_ascii_whitespace()) {
                return Some(Row { text, line: self.line });
            }
        }
        None
    }
}

impl<'a> Row<'a> {
    /// The first `N` numbers of the row, and the words after them.
    fn take<const N: usize>(self, what: &str) -> Result<([f64; N], impl Iterator<Item = &'a [u8]>), ImportError> {
        let mut values = [0.0; N];
        let mut rest = tokens(self.text);
        for (i, value) in values.iter_mut().enumerate() {
            let token = rest.next().ok_or_else(|| self.error(format!("{what} needs {N} numbers, but has {i}")))?;
            let wrong = || self.error(format!("{what}: item {} is not a finite number", i + 1));
            *value = number(token).ok_or_else(wrong)?;
        }
        Ok((values, rest))
    }

    /// A row that begins with a count.
    fn take_count(self, what: &str) -> Result<usize, ImportError> {
        let ([count], _) = self.take(&format!("the count of {what}"))?;
        self.count(count, what)
    }

    fn error(self, what: impl Into<String>) -> ImportError {
        ImportError::at(self.line, what, FORMAT_HELP)
    }

    fn count(self, value: f64, what: &str) -> Result<usize, ImportError> {
        // No file that fits in memory has 2³² rows, and ids have 32 bits.
        if value >= 0.0 && value < f64::from(u32::MAX) && value == value.trunc() {
            Ok(value as usize)
        } else {
            Err(self.error(format!("{value} is not a count of {what}")))
        }
    }
}

/// The relation of vertex numbers to positions in the file.
enum Numbering {
    /// Consecutive from this number.
    From(i64),
    Any(BTreeMap<i64, usize>),
}

struct Vertices {
    points: Vec<Point>,
    /// Marker of each vertex, 0 where there is none.
    markers: Vec<i64>,
    numbering: Numbering,
}

impl Vertices {
    fn find(&self, value: f64) -> Option<usize> {
        let number = whole(value)?;
        let index = match &self.numbering {
            Numbering::From(first) => usize::try_from(number.checked_sub(*first)?).ok()?,
            Numbering::Any(places) => *places.get(&number)?,
        };
        (index < self.points.len()).then_some(index)
    }
}

/// The value as an integer, if `f64` holds that integer exactly.
fn whole(value: f64) -> Option<i64> {
    (value == value.trunc() && value.abs() < 9_007_199_254_740_992.0).then_some(value as i64)
}

/// A boundary marker: 0 where there is none or where it is not an integer.
fn as_marker(token: Option<&[u8]>) -> i64 {
    token.and_then(number).and_then(whole).unwrap_or(0)
}

/// The header `count dimension attributes markers`. The last two are optional.
fn vertex_header(row: Row) -> Result<(usize, usize, bool), ImportError> {
    let ([count, dimension], mut rest) = row.take("the vertex header (count, dimension, attributes, markers)")?;
    let count = row.count(count, "vertices")?;
    if dimension != 2.0 {
        return Err(row.error(format!("the dimension is {dimension}, but a planar file has 2")));
    }
    let attributes = row.count(rest.next().and_then(number).unwrap_or(0.0), "attributes")?;
    Ok((count, attributes, rest.next().and_then(number).unwrap_or(0.0) != 0.0))
}

fn read_vertices(rows: &mut Rows, header: Row, notes: &mut Vec<String>) -> Result<Vertices, ImportError> {
    let (count, attributes, marked) = vertex_header(header)?;
    // A row has at least six bytes, so a larger count in the header needs no more memory.
    let room = count.min(rows.rest.len() / 6 + 1);
    let (mut points, mut markers) = (Vec::with_capacity(room), Vec::with_capacity(room));
    let mut given = Vec::with_capacity(room);
    for i in 0..count {
        let row = expect(rows, header, "vertices", i, count)?;
        let ([n, x, y], mut rest) = row.take("a vertex (number, x, y)")?;
        given.push((whole(n).ok_or_else(|| row.error(format!("{n} is not a vertex number")))?, row.line));
        points.push(Point::new(x, y));
        let marker = if marked { rest.nth(attributes) } else { None };
        markers.push(as_marker(marker));
    }
    Ok(Vertices { points, markers, numbering: numbering(&given, notes)? })
}

fn numbering(given: &[(i64, usize)], notes: &mut Vec<String>) -> Result<Numbering, ImportError> {
    let first = given.first().map_or(0, |g| g.0);
    if given.iter().enumerate().all(|(i, g)| g.0.checked_sub(first) == i64::try_from(i).ok()) {
        return Ok(Numbering::From(first));
    }
    notes.push("The vertices are not numbered consecutively; segments refer to the numbers as given.".into());
    let mut places = BTreeMap::new();
    for (i, &(n, line)) in given.iter().enumerate() {
        if places.insert(n, i).is_some() {
            return Err(ImportError::at(line, format!("vertex number {n} is used twice"), FORMAT_HELP));
        }
    }
    Ok(Numbering::Any(places))
}

/// The next row of a section, or an error that names the header whose count is too large.
fn expect<'a>(rows: &mut Rows<'a>, header: Row, what: &str, i: usize, count: usize) -> Result<Row<'a>, ImportError> {
    rows.next().ok_or_else(|| {
        let missing = format!("line {} announces {count} {what}, but the file ends after {i}", header.line);
        ImportError::at(rows.line, missing, "the file may be cut off; correct the count or add the missing lines")
    })
}

/// The names of boundaries by marker.
struct Markers {
    known: BTreeMap<i64, NameId>,
    last: Option<(i64, NameId)>,
}

impl Markers {
    fn name(&mut self, names: &mut Names, marker: i64) -> NameId {
        if let Some((known, id)) = self.last
            && known == marker
        {
            return id;
        }
        let id = *self.known.entry(marker).or_insert_with(|| match marker {
            0 => names.intern(UNMARKED),
            _ => names.intern(&marker.to_string()),
        });
        self.last = Some((marker, id));
        id
    }
}

/// Reads a `.poly` file. `nodes` is the `.node` file beside it, needed where the `.poly` file has 0 vertices.
///
/// # Errors
/// [`ImportError`] with the line where the file breaks its format, and where its `.node` file is needed but not given.
pub fn read_poly(bytes: &[u8], stem: &str, nodes: Option<&[u8]>) -> Result<Drawing, ImportError> {
    let mut drawing = empty("poly", stem);
    let mut rows = Rows::new(bytes);
    let header = rows.header()?;
    let vertices = match (vertex_header(header)?.0, nodes) {
        (0, Some(nodes)) => beside(nodes, &mut drawing.notes)?,
        (0, None) => {
            let help = format!("put {stem}.node beside the .poly file");
            return Err(ImportError::at(header.line, "the vertices are in a .node file of their own", help));
        }
        _ => read_vertices(&mut rows, header, &mut drawing.notes)?,
    };
    let used = read_segments(&mut rows, &vertices, &mut drawing)?;
    read_holes(&mut rows, &mut drawing)?;
    read_regions(&mut rows, &mut drawing)?;
    if let Some(row) = rows.next() {
        drawing
            .notes
            .push(format!("What follows from line {} on belongs to no section and was passed over.", row.line));
    }
    keep_points(&vertices, &used, &mut drawing);
    Ok(drawing)
}

/// Reads a `.node` file: its points in their convex hull.
///
/// # Errors
/// [`ImportError`] with the line where the file breaks its format.
pub fn read_node(bytes: &[u8], stem: &str) -> Result<Drawing, ImportError> {
    let mut drawing = empty("node", stem);
    let mut rows = Rows::new(bytes);
    let header = rows.header()?;
    let vertices = read_vertices(&mut rows, header, &mut drawing.notes)?;
    let used = add_hull(&vertices, &mut drawing);
    keep_points(&vertices, &used, &mut drawing);
    Ok(drawing)
}

fn empty(format: &str, stem: &str) -> Drawing {
    Drawing { format: format.into(), title: stem.into(), fill: FillRule::Regions, ..Drawing::default() }
}

fn beside(nodes: &[u8], notes: &mut Vec<String>) -> Result<Vertices, ImportError> {
    let mut rows = Rows::new(nodes);
    let vertices = rows.header().and_then(|header| read_vertices(&mut rows, header, notes));
    notes.push("The vertices were read from the .node file beside the .poly file.".into());
    vertices.map_err(|e| ImportError { what: format!("in the .node file beside it: {}", e.what), ..e })
}

fn read_segments(rows: &mut Rows, vertices: &Vertices, drawing: &mut Drawing) -> Result<Vec<bool>, ImportError> {
    let header = rows.next().ok_or_else(|| {
        let help = "the file may be cut off; a line '0 0' there says that there are none, and a .node file holds vertices alone";
        ImportError::at(rows.line, "the file ends before the count of the segments", help)
    })?;
    let ([count], mut rest) = header.take("the segment header (count, markers)")?;
    let marked = rest.next().and_then(number).unwrap_or(0.0);
    if marked != 0.0 && marked != 1.0 {
        let what = "expected the segment header (count, then 0 or 1 for markers), found something else";
        return Err(ImportError::at(header.line, what, "does the count of vertices fit the lines that follow it?"));
    }
    let count = header.count(count, "segments")?;
    if count == 0 {
        return Ok(add_hull(vertices, drawing));
    }
    let mut used = vec![false; vertices.points.len()];
    let mut names = Markers { known: BTreeMap::new(), last: None };
    let mut empty = 0;
    drawing.curves.reserve(count.min(rows.rest.len() / 6 + 1));
    for i in 0..count {
        let row = expect(rows, header, "segments", i, count)?;
        let ([n, a, b], mut rest) = row.take("a segment (number, start, end)")?;
        let end = |v: f64| vertices.find(v).ok_or_else(|| row.error(format!("segment {n}: there is no vertex {v}")));
        let (a, b) = (end(a)?, end(b)?);
        if a == b {
            empty += 1;
            continue;
        }
        (used[a], used[b]) = (true, true);
        let marker = if marked == 1.0 { as_marker(rest.next()) } else { 0 };
        let name = names.name(&mut drawing.names, marker);
        let curve =
            Curve::line(vertices.points[a], vertices.points[b]).map_err(|e| row.error(format!("segment {n}: {e}")))?;
        drawing.curves.push(DrawnCurve::new(curve, name, format!("segment {n}")).with_written_ends());
    }
    if empty > 0 {
        let why = "both ends are the same vertex".into();
        drawing.skipped.push(Skipped { entity: "segment".into(), count: empty, why });
    }
    Ok(used)
}

fn read_holes(rows: &mut Rows, drawing: &mut Drawing) -> Result<(), ImportError> {
    let Some(header) = rows.next() else {
        drawing.notes.push("The file ends before the hole points; there are none.".into());
        return Ok(());
    };
    let count = header.take_count("holes")?;
    for i in 0..count {
        let row = expect(rows, header, "holes", i, count)?;
        let ([n, x, y], _) = row.take("a hole point (number, x, y)")?;
        drawing.seeds.push(Seed { at: Point::new(x, y), kind: SeedKind::Hole, entity: format!("hole {n}") });
    }
    Ok(())
}

fn read_regions(rows: &mut Rows, drawing: &mut Drawing) -> Result<(), ImportError> {
    let Some(header) = rows.next() else { return Ok(()) };
    let count = header.take_count("regions")?;
    for i in 0..count {
        let row = expect(rows, header, "regions", i, count)?;
        let ([n, x, y], mut rest) = row.take("a region point (number, x, y, attribute, largest area)")?;
        let attribute = rest.next().and_then(number).unwrap_or(n);
        let name = drawing.names.intern(&attribute.to_string());
        // Triangle reads a negative area as "no limit".
        let kind = SeedKind::Region { name, max_area: rest.next().and_then(number).filter(|&a| a > 0.0) };
        drawing.seeds.push(Seed { at: Point::new(x, y), kind, entity: format!("region {n}") });
    }
    Ok(())
}

fn keep_points(vertices: &Vertices, used: &[bool], drawing: &mut Drawing) {
    let mut numbers: Vec<i64> = Vec::new();
    match &vertices.numbering {
        Numbering::From(first) => numbers.extend((0..).map(|i| first + i).take(used.len())),
        Numbering::Any(places) => {
            numbers.resize(used.len(), 0);
            places.iter().for_each(|(&number, &i)| numbers[i] = number);
        }
    }
    for (i, &at) in vertices.points.iter().enumerate() {
        if used[i] {
            continue;
        }
        let marker = vertices.markers[i];
        let name = (marker != 0).then(|| drawing.names.intern(&marker.to_string()));
        drawing.points.push(DrawnPoint { at, name, entity: format!("vertex {}", numbers[i]) });
    }
}

/// Adds the convex hull of the vertices to the drawing, and tells which vertices are its corners.
fn add_hull(vertices: &Vertices, drawing: &mut Drawing) -> Vec<bool> {
    let mut used = vec![false; vertices.points.len()];
    let hull = convex_hull(&vertices.points);
    if hull.len() < 3 {
        drawing.notes.push("There are no segments, and the vertices span no area.".into());
        return used;
    }
    drawing.notes.push("There are no segments: the domain is the convex hull of the vertices.".into());
    for (i, &a) in hull.iter().enumerate() {
        let b = hull[(i + 1) % hull.len()];
        used[a] = true;
        // The corners of a hull differ and are finite, so a line between them exists.
        if let Ok(curve) = Curve::line(vertices.points[a], vertices.points[b]) {
            drawing.add(curve, "hull", format!("hull edge {}", i + 1));
        }
    }
    used
}

/// The strictly convex corners of the hull, counter-clockwise (Andrew's monotone chain on exact signs).
fn convex_hull(points: &[Point]) -> Vec<usize> {
    let Some(bounds) = bounds_of(points.iter().copied()) else { return Vec::new() };
    let unit = unit_scale(magnitude(bounds));
    let at = |i: usize| scaled(points[i], unit);
    let mut order: Vec<usize> = (0..points.len()).collect();
    // `total_cmp` tells −0 from 0. Adding 0 makes them equal.
    let key = |i: usize| (points[i].x + 0.0, points[i].y + 0.0);
    order.sort_by(|&a, &b| key(a).0.total_cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)).then(a.cmp(&b)));
    order.dedup_by(|a, b| points[*a] == points[*b]);
    let half = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for p in order {
            while let [.., a, b] = chain[..] {
                if orient(at(a), at(b), at(p)) == Orientation::CounterClockwise {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut order.iter().copied());
    hull.extend(half(&mut order.iter().rev().copied()));
    hull
}

/// The kind of a file of Triangle.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Holds {
    Vertices,
    More,
}

/// The kind of a text that begins as Triangle's files do: the first line holds integers, and the second integer, the
/// dimension, is 2. If a later line has the form of a segment header, it is a `.poly`.
fn sniff(bytes: &[u8]) -> Option<Holds> {
    let mut rows = Rows::new(without_bom(bytes));
    let header = rows.next()?;
    let mut head = numbers(header.text);
    let (count, dimension) = (whole(head.next()??)?, head.next()??);
    let rest: Option<Vec<f64>> = head.collect();
    if dimension != 2.0 || count < 0 || rest.is_none_or(|r| r.len() > 2 || r.iter().any(|v| *v != v.trunc())) {
        return None;
    }
    let after = rows.nth(usize::try_from(count).ok()?);
    Some(if after.is_some() || count == 0 { Holds::More } else { Holds::Vertices })
}
