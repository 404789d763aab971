//! SU2's native mesh, in two dimensions, of one zone. Markers are the boundaries; the triangles are one region.

use crate::geometry::written::number;
use crate::meshio::draft::{Draft, REGION};
use crate::meshio::names::NameComments;
use crate::meshio::{MeshFile, Result, broken_at, lines, text, unsupported};

pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut draft = Draft::default();
    let mut names = NameComments::default();
    let mut marker = String::new();
    let mut section = Section::None;
    let mut left = 0_usize;
    for (n, line) in lines(bytes) {
        let comment = line.iter().position(|&b| b == b'%').unwrap_or(line.len());
        if let Some(comment) = line.get(comment + 1..) {
            names.hear(comment);
        }
        let line = line[..comment].trim_ascii();
        if line.is_empty() {
            continue;
        }
        if let Some(equals) = line.iter().position(|&b| b == b'=') {
            let (key, value) = (text(line[..equals].trim_ascii()), text(line[equals + 1..].trim_ascii()));
            let count = || value.split_ascii_whitespace().next().and_then(|v| v.parse::<usize>().ok());
            let counted = || count().ok_or_else(|| broken_at(n, format!("{key} is '{value}'")));
            let counts = matches!(key.as_str(), "NELEM" | "NPOIN" | "NMARK" | "MARKER_TAG" | "MARKER_ELEMS");
            if counts && left > 0 {
                return Err(broken_at(n, format!("{key} comes {left} lines too early")));
            }
            match key.as_str() {
                "NDIME" if count() != Some(2) => {
                    return Err(unsupported(
                        format!("the mesh has {value} dimensions"),
                        "only meshes of 2 can be read",
                    ));
                }
                "NZONE" if count() != Some(1) => {
                    return Err(unsupported(format!("the file has {value} zones"), "save each zone in a file"));
                }
                "NELEM" => (section, left) = (Section::Elements, counted()?),
                "NPOIN" => (section, left) = (Section::Points, counted()?),
                "MARKER_TAG" => marker = value,
                "MARKER_ELEMS" => (section, left) = (Section::Marker, counted()?),
                _ => {}
            }
            continue;
        }
        // SEND_RECV and whatever else stands between the sections.
        if left == 0 {
            continue;
        }
        left -= 1;
        let words: Vec<f64> = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).map_while(number).collect();
        let nodes = |k: usize| -> Result<Vec<usize>> {
            let whole = |v: &f64| (*v >= 0.0 && v.fract() == 0.0 && *v < 4e9).then_some(*v as usize);
            let nodes: Option<Vec<usize>> = words.get(1..=k).and_then(|words| words.iter().map(whole).collect());
            nodes.ok_or_else(|| broken_at(n, format!("an element has not {k} nodes")))
        };
        let kind = words.first().copied();
        match section {
            Section::Points => match words.as_slice() {
                [x, y, ..] => draft.nodes.push([*x, *y, 0.0]),
                _ => return Err(broken_at(n, "a point has not two coordinates")),
            },
            Section::Elements if kind == Some(5.0) => draft.triangle(nodes(3)?, REGION),
            Section::Marker if kind == Some(3.0) => draft.line(nodes(2)?, &names.boundary(&marker)),
            Section::Marker if kind == Some(1.0) => draft.vertices += 1,
            _ => {
                let what = format!("line {n}: an element of type {}", kind.map_or("?".into(), |k| k.to_string()));
                return Err(unsupported(what, "only triangles (5) and lines (3) can be read"));
            }
        }
    }
    if left > 0 {
        return Err(broken_at(lines(bytes).count(), format!("the file ends {left} lines too early")));
    }
    draft.finish()
}

#[derive(Clone, Copy)]
enum Section {
    None,
    Elements,
    Points,
    Marker,
}
