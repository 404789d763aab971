//! Abaqus' and CalculiX's input deck: `*NODE`, `*ELEMENT` of triangles (CPS3, CPE3, CAX3, S3, STRI3 and their likes of 6 nodes)
//! and of lines (T2D2, B21, … and of 3 nodes), the element set as region or boundary; `*SURFACE` of element faces as boundary.
//! Other keywords are passed over.

use super::draft::{BOUNDARY, Draft, REGION};
use super::{MeshFile, NameComments, Result, broken_at, lines, text, unsupported};
use crate::import::number;
use std::collections::BTreeMap;

pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut deck = Deck::default();
    for (n, line) in lines(bytes) {
        if let Some(comment) = line.strip_prefix(b"**") {
            deck.names.hear(comment);
        } else if let Some(keyword) = line.strip_prefix(b"*") {
            deck.keyword(n, &text(keyword))?;
        } else if !line.is_empty() {
            deck.data(n, line)?;
        }
    }
    deck.finish()
}

#[derive(Default)]
enum Section {
    Nodes,
    /// Nodes an element, and its set.
    Triangles(usize, String),
    Lines(usize, String),
    Surface(String),
    #[default]
    Other,
}

#[derive(Default)]
struct Deck {
    draft: Draft,
    names: NameComments,
    section: Section,
    nodes: BTreeMap<u64, usize>,
    /// Place among the triangles of an element's number.
    triangles: BTreeMap<u64, usize>,
    /// Numbers of an element that goes on in the next line.
    begun: Vec<u64>,
}

impl Deck {
    fn keyword(&mut self, n: usize, line: &str) -> Result<()> {
        let mut parts = line.split(',').map(str::trim);
        let keyword = parts.next().unwrap_or_default().to_ascii_uppercase();
        let parameters: BTreeMap<String, &str> =
            parts.filter_map(|p| p.split_once('=')).map(|(k, v)| (k.trim().to_ascii_uppercase(), v.trim())).collect();
        let set = parameters.get("ELSET").map(|set| (*set).to_owned());
        self.section = match keyword.as_str() {
            "NODE" => Section::Nodes,
            "ELEMENT" => {
                let kind = parameters.get("TYPE").copied().unwrap_or_default().to_ascii_uppercase();
                element(&kind, set).ok_or_else(|| {
                    unsupported(format!("line {n}: elements of type '{kind}'"), "only triangles and lines can be read")
                })?
            }
            "SURFACE" => {
                let name = parameters.get("NAME").copied().unwrap_or(BOUNDARY);
                match parameters.get("TYPE").map(|kind| kind.to_ascii_uppercase()).as_deref() {
                    None | Some("ELEMENT") => Section::Surface(self.names.boundary(name)),
                    Some(_) => Section::Other,
                }
            }
            _ => Section::Other,
        };
        self.begun.clear();
        Ok(())
    }

    fn data(&mut self, n: usize, line: &[u8]) -> Result<()> {
        let words: Vec<&[u8]> = line.split(|&b| b == b',').map(<[u8]>::trim_ascii).filter(|w| !w.is_empty()).collect();
        let whole = |word: &&[u8]| -> Result<u64> {
            text(word).parse().map_err(|_| broken_at(n, format!("'{}' is no number of a node or element", text(word))))
        };
        match &self.section {
            Section::Nodes => {
                let tag = words.first().map(whole).transpose()?.unwrap_or(0);
                let value = |k: usize| words.get(k).map_or(Some(0.0), |word| number(word));
                let (Some(x), Some(y), Some(z)) = (value(1), value(2), value(3)) else {
                    return Err(broken_at(n, "a coordinate is no number"));
                };
                if self.nodes.insert(tag, self.draft.nodes.len()).is_some() {
                    return Err(broken_at(n, format!("node {tag} is given twice")));
                }
                self.draft.nodes.push([x, y, z]);
            }
            Section::Triangles(size, _) | Section::Lines(size, _) => {
                let size = *size;
                for word in &words {
                    self.begun.push(whole(word)?);
                }
                if self.begun.len() > size {
                    self.element(n)?;
                }
            }
            Section::Surface(name) => {
                let [element, face] = words.as_slice() else { return Ok(()) };
                let tag = text(element).parse().ok();
                let triangle = tag.and_then(|tag: u64| self.triangles.get(&tag));
                let side = face.strip_prefix(b"S").or(face.strip_prefix(b"s")).and_then(number);
                let corners = triangle.and_then(|&t| self.draft.corners(t));
                let (Some(corners), Some(side @ (1.0 | 2.0 | 3.0))) = (corners, side) else {
                    let what = format!("line {n}: '{}' is no face of a triangle", text(line));
                    return Err(unsupported(what, "surfaces can be read as faces S1 to S3 of elements before them"));
                };
                let side = side as usize - 1;
                let ends = vec![corners[side], corners[(side + 1) % 3]];
                let name = name.clone();
                self.draft.line(ends, &name);
            }
            Section::Other => {}
        }
        Ok(())
    }

    fn element(&mut self, n: usize) -> Result<()> {
        let numbers = std::mem::take(&mut self.begun);
        let find =
            |tag: &u64| self.nodes.get(tag).copied().ok_or_else(|| broken_at(n, format!("there is no node {tag}")));
        let mut nodes: Vec<usize> = numbers[1..].iter().map(find).collect::<Result<_>>()?;
        match &self.section {
            Section::Triangles(size, set) if nodes.len() == *size => {
                let set = self.names.region(set);
                let place = self.triangles.len();
                if self.triangles.insert(numbers[0], place).is_some() {
                    return Err(broken_at(n, format!("element {} is given twice", numbers[0])));
                }
                self.draft.triangle(nodes, &set);
            }
            Section::Lines(size, set) if nodes.len() == *size => {
                // The second of three nodes is the one within.
                if nodes.len() == 3 {
                    nodes.swap(1, 2);
                }
                let set = self.names.boundary(set);
                self.draft.line(nodes, &set);
            }
            _ => return Err(broken_at(n, format!("an element has {} nodes", nodes.len()))),
        }
        Ok(())
    }

    fn finish(self) -> Result<MeshFile> {
        self.draft.finish()
    }
}

/// What elements of a type are, `None` where they are neither triangles nor lines.
fn element(kind: &str, set: Option<String>) -> Option<Section> {
    let region = || set.clone().unwrap_or_else(|| REGION.into());
    let boundary = || set.clone().unwrap_or_else(|| BOUNDARY.into());
    let starts = |words: &[&str]| words.iter().any(|word| kind.starts_with(word));
    if starts(&["CPS3", "CPE3", "CAX3", "S3", "STRI3", "M3D3", "SFM3D3", "DC2D3", "DS3", "R3D3"]) {
        Some(Section::Triangles(3, region()))
    } else if starts(&["CPS6", "CPE6", "CAX6", "S6", "STRI65", "M3D6", "SFM3D6", "DC2D6", "DS6"]) {
        Some(Section::Triangles(6, region()))
    } else if starts(&["T2D2", "T3D2", "B21", "B31", "R2D2"]) {
        Some(Section::Lines(2, boundary()))
    } else if starts(&["T2D3", "T3D3", "B22", "B32"]) {
        Some(Section::Lines(3, boundary()))
    } else {
        None
    }
}
