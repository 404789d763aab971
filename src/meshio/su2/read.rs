//! SU2's native mesh, in two dimensions, of one zone. Markers are the boundaries. The triangles are one region.

use crate::geometry::written::number;
use crate::meshio::draft::{Draft, REGION};
use crate::meshio::names::Comments;
use crate::meshio::{MeshFile, Result, broken_at, lines, text, unsupported};

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut file = File::default();
    for (n, line) in lines(bytes) {
        let comment = line.iter().position(|&b| b == b'%').unwrap_or(line.len());
        if let Some(comment) = line.get(comment + 1..) {
            file.comments.read(comment);
        }
        let line = line[..comment].trim_ascii();
        if let Some(equals) = line.iter().position(|&b| b == b'=') {
            file.assignment(n, &text(line[..equals].trim_ascii()), &text(line[equals + 1..].trim_ascii()))?;
        } else if !line.is_empty() && file.left > 0 {
            // SEND_RECV and other keys between the sections are skipped.
            file.left -= 1;
            file.row(n, line)?;
        }
    }
    if file.left > 0 {
        return Err(broken_at(lines(bytes).count(), format!("the file ends {} lines too early", file.left)));
    }
    file.draft.finish()
}

#[derive(Clone, Copy, Default)]
enum Section {
    #[default]
    None,
    Elements,
    Points,
    Marker,
}

/// The file so far.
#[derive(Default)]
struct File {
    draft: Draft,
    comments: Comments,
    /// The tag of the current marker.
    marker: String,
    section: Section,
    /// Number of rows of the section that are still to come.
    left: usize,
}

impl File {
    /// `KEY= value`.
    fn assignment(&mut self, n: usize, key: &str, value: &str) -> Result<()> {
        let count = || value.split_ascii_whitespace().next().and_then(|v| v.parse::<usize>().ok());
        let counted = || count().ok_or_else(|| broken_at(n, format!("{key} is '{value}'")));
        let counts = matches!(key, "NELEM" | "NPOIN" | "NMARK" | "MARKER_TAG" | "MARKER_ELEMS");
        if counts && self.left > 0 {
            return Err(broken_at(n, format!("{key} comes {} lines too early", self.left)));
        }
        match key {
            "NDIME" if count() != Some(2) => {
                return Err(unsupported(format!("the mesh has {value} dimensions"), "only meshes of 2 can be read"));
            }
            "NZONE" if count() != Some(1) => {
                return Err(unsupported(format!("the file has {value} zones"), "save each zone in a file"));
            }
            "NELEM" => (self.section, self.left) = (Section::Elements, counted()?),
            "NPOIN" => (self.section, self.left) = (Section::Points, counted()?),
            "MARKER_TAG" => value.clone_into(&mut self.marker),
            "MARKER_ELEMS" => (self.section, self.left) = (Section::Marker, counted()?),
            _ => {}
        }
        Ok(())
    }

    /// A point or an element.
    fn row(&mut self, n: usize, line: &[u8]) -> Result<()> {
        let words: Vec<f64> = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).map_while(number).collect();
        let nodes = |k: usize| -> Result<Vec<usize>> {
            let whole = |v: &f64| (*v >= 0.0 && v.fract() == 0.0 && *v < 4e9).then_some(*v as usize);
            let nodes: Option<Vec<usize>> = words.get(1..=k).and_then(|words| words.iter().map(whole).collect());
            nodes.ok_or_else(|| broken_at(n, format!("an element does not have {k} nodes")))
        };
        let kind = words.first().copied();
        match self.section {
            Section::Points => match words.as_slice() {
                [x, y, ..] => self.draft.nodes.push([*x, *y, 0.0]),
                _ => return Err(broken_at(n, "a point does not have two coordinates")),
            },
            Section::Elements if kind == Some(5.0) => self.draft.triangle(nodes(3)?, REGION),
            Section::Marker if kind == Some(3.0) => self.draft.line(nodes(2)?, &self.comments.boundary(&self.marker)),
            Section::Marker if kind == Some(1.0) => self.draft.vertices += 1,
            Section::Elements | Section::Marker | Section::None => {
                let what = format!("line {n}: an element of type {}", kind.map_or("?".into(), |k| k.to_string()));
                return Err(unsupported(what, "only triangles (5) and lines (3) can be read"));
            }
        }
        Ok(())
    }
}
