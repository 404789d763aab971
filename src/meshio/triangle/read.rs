//! Triangle's `.ele` with the `.node` beside it, and the `.poly` for its segments if there is one. The first attribute
//! of a triangle is its region, the marker of a segment its boundary.

use crate::geometry::written::number;
use crate::meshio::draft::{BOUNDARY, Draft, REGION};
use crate::meshio::names::Comments;
use crate::meshio::{MeshFile, Result, broken, broken_at, lines, text, unsupported};
use std::collections::BTreeMap;

/// Reads the files.
pub fn read(elements: &[u8], nodes: Option<&[u8]>, segments: Option<&[u8]>) -> Result<MeshFile> {
    let nodes =
        nodes.ok_or_else(|| unsupported("there is no .node file beside the .ele file", "put both in one folder"))?;
    let mut draft = Draft::default();
    let mut comments = Comments::default();
    for file in [elements, nodes].into_iter().chain(segments) {
        lines(file).filter_map(|(_, line)| line.strip_prefix(b"#")).for_each(|comment| comments.read(comment));
    }
    let mut rows = Rows::of(nodes);
    let header = rows.next("the header of .node")?;
    let mut place = BTreeMap::new();
    for _ in 0..rows.count(&header, 0)? {
        let row = rows.next("a vertex")?;
        let [tag, x, y] = row.take("a vertex")?;
        place.insert(tag as i64, draft.nodes.len());
        draft.nodes.push([x, y, 0.0]);
    }
    let find = |row: &Row, tag: f64| {
        place.get(&(tag as i64)).copied().ok_or_else(|| broken_at(row.line, format!("there is no vertex {tag}")))
    };
    let mut rows = Rows::of(elements);
    let header = rows.next("the header of .ele")?;
    let corners = rows.count(&header, 1)?;
    if corners != 3 && corners != 6 {
        return Err(broken_at(header.line, format!("triangles have {corners} nodes, not 3 or 6")));
    }
    for _ in 0..rows.count(&header, 0)? {
        let row = rows.next("a triangle")?;
        let tags = row.numbers.get(1..=corners).ok_or_else(|| broken_at(row.line, "a triangle lacks nodes"))?;
        let mut nodes: Vec<usize> = tags.iter().map(|&tag| find(&row, tag)).collect::<Result<_>>()?;
        if corners == 6 {
            // The nodes opposite corners 0, 1 and 2 are between 1 and 2, 2 and 0, 0 and 1.
            nodes[3..].rotate_right(1);
        }
        let region = row.numbers.get(corners + 1).map_or(REGION.into(), |r| comments.region(&r.to_string()));
        draft.triangle(nodes, &region);
    }
    if let Some(segments) = segments {
        let mut rows = Rows::of(segments);
        let header = rows.next("the header of .poly")?;
        for _ in 0..rows.count(&header, 0)? {
            rows.next("a vertex")?;
        }
        let header = rows.next("the count of segments")?;
        for _ in 0..rows.count(&header, 0)? {
            let row = rows.next("a segment")?;
            let [_, a, b] = row.take("a segment")?;
            let marker = row.numbers.get(3).copied().unwrap_or(0.0);
            let name = if marker == 0.0 { BOUNDARY.into() } else { comments.boundary(&marker.to_string()) };
            draft.line(vec![find(&row, a)?, find(&row, b)?], &name);
        }
    }
    draft.finish()
}

struct Row {
    line: usize,
    numbers: Vec<f64>,
}

impl Row {
    fn take<const N: usize>(&self, what: &str) -> Result<[f64; N]> {
        self.numbers.first_chunk().copied().ok_or_else(|| broken_at(self.line, format!("{what} needs {N} numbers")))
    }
}

/// Lines that are not empty, without comments.
struct Rows<'a> {
    lines: Box<dyn Iterator<Item = (usize, &'a [u8])> + 'a>,
    bytes: usize,
}

impl<'a> Rows<'a> {
    fn of(bytes: &'a [u8]) -> Self {
        let cut =
            |(n, line): (usize, &'a [u8])| (n, line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii());
        Self { lines: Box::new(lines(bytes).map(cut).filter(|(_, line)| !line.is_empty())), bytes: bytes.len() }
    }

    fn next(&mut self, what: &str) -> Result<Row> {
        let (line, words) = self.lines.next().ok_or_else(|| broken(format!("the file ends before {what}")))?;
        let words = words.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        let value = |word| number(word).ok_or_else(|| broken_at(line, format!("'{}' is not a number", text(word))));
        Ok(Row { line, numbers: words.map(value).collect::<Result<_>>()? })
    }

    /// A count in a header. A row takes at least two bytes.
    fn count(&self, header: &Row, at: usize) -> Result<usize> {
        let value =
            header.numbers.get(at).copied().filter(|v| v.fract() == 0.0 && *v >= 0.0 && *v <= self.bytes as f64);
        value
            .map(|v| v as usize)
            .ok_or_else(|| broken_at(header.line, "the count is larger than the file has room for"))
    }
}
