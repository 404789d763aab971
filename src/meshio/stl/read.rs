//! STL, text or binary. Equal coordinates are one node. Each solid of a text is a region.

use crate::geometry::written::number;
use crate::meshio::draft::{Draft, REGION};
use crate::meshio::{MeshFile, Result, broken, broken_at, lines, text};
use std::collections::BTreeMap;

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut soup = Soup::default();
    // Text begins with `solid`. So do the headers of some binary files, whose length fits their count.
    let count = bytes.get(80..84).map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]));
    match count {
        Some(count) if bytes.len() as u64 == 84 + 50 * u64::from(count) => soup.binary(&bytes[84..]),
        _ if bytes.trim_ascii_start().starts_with(b"solid") => soup.text(bytes)?,
        _ => {
            return Err(broken(
                "this is not STL: it neither begins with 'solid' nor is as long as its count of triangles says",
            ));
        }
    }
    soup.draft.finish()
}

#[derive(Default)]
struct Soup {
    draft: Draft,
    seen: BTreeMap<[u64; 3], usize>,
}

impl Soup {
    fn node(&mut self, place: [f64; 3]) -> usize {
        // Adding 0 turns −0 into 0.
        *self.seen.entry(place.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
            self.draft.nodes.push(place);
            self.draft.nodes.len() - 1
        })
    }

    fn binary(&mut self, facets: &[u8]) {
        for facet in facets.chunks_exact(50) {
            let number = |k: usize| f64::from(f32::from_le_bytes([facet[k], facet[k + 1], facet[k + 2], facet[k + 3]]));
            let corners = [12, 24, 36].map(|k| self.node([number(k), number(k + 4), number(k + 8)]));
            self.draft.triangle(corners.to_vec(), REGION);
        }
    }

    fn text(&mut self, bytes: &[u8]) -> Result<()> {
        let mut name = String::new();
        let mut corners = Vec::new();
        let mut open = false;
        for (n, line) in lines(bytes) {
            let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
            match words.next() {
                Some(b"solid") => {
                    name = text(line.strip_prefix(b"solid").unwrap_or_default().trim_ascii());
                    if name.is_empty() {
                        name = REGION.into();
                    }
                    self.draft.region(&name);
                    open = true;
                }
                Some(b"endsolid") => open = false,
                Some(b"vertex") => {
                    let place: Vec<f64> = words.map_while(number).collect();
                    let &[x, y, z] = place.as_slice() else {
                        return Err(broken_at(n, "a vertex does not have three coordinates"));
                    };
                    corners.push(self.node([x, y, z]));
                }
                Some(b"endfacet") => {
                    if corners.len() != 3 {
                        return Err(broken_at(n, format!("a facet has {} vertices", corners.len())));
                    }
                    self.draft.triangle(std::mem::take(&mut corners), &name);
                }
                _ => {}
            }
        }
        if open { Err(broken("the file ends before endsolid")) } else { Ok(()) }
    }
}
