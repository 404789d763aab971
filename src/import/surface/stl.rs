//! STL, text and binary. The name of a solid names its facets. A binary file is known by its length, 84 bytes and 50 a
//! triangle: many of them begin with the word `solid`.

use super::text::{Row, Rows, Written};
use crate::geometry::written::tokens;
use crate::ids::NameId;
use crate::import::ImportError;
use crate::solid::{Digits, FoundFacet, Material, Surfaces};

const HELP: &str = "see https://en.wikipedia.org/wiki/STL_(file_format) for the format";

/// Bytes before the first triangle of a binary file, and of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Whether the length is that of a binary file with triangles, or the first rows are `solid` and `facet`.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    let has_facet = || {
        let second = Rows::new(bytes, HELP).nth(1).and_then(|row| tokens(row.text).next());
        second.is_some_and(|word| word.eq_ignore_ascii_case(b"facet"))
    };
    is_binary(bytes) && bytes.len() > HEADER || begins_with_solid(bytes) && has_facet()
}

fn begins_with_solid(bytes: &[u8]) -> bool {
    let first = Rows::new(bytes, HELP).next().and_then(|row| tokens(row.text).next());
    first.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

fn announced(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?) as usize)
}

fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|n| n.checked_mul(TRIANGLE).and_then(|n| n.checked_add(HEADER)) == Some(bytes.len()))
}

/// Reads an STL file.
pub(super) fn read(bytes: &[u8]) -> Result<Surfaces, ImportError> {
    if is_binary(bytes) {
        return read_binary(bytes);
    }
    if begins_with_solid(bytes) {
        return read_text(bytes);
    }
    match announced(bytes) {
        Some(n) => {
            let whole = bytes.len().saturating_sub(HEADER) / TRIANGLE;
            let what = format!("the header announces {n} triangles, but the file has the length of {whole}");
            Err(ImportError::new(what, "the file may be cut off, or is no STL file"))
        }
        None => Err(ImportError::new("this is no STL file: neither text that begins with solid, nor binary", HELP)),
    }
}

fn empty(format: &str) -> Surfaces {
    Surfaces { format: format.into(), material: Material::Winding, ..Surfaces::default() }
}

fn push(surfaces: &mut Surfaces, corners: [[f64; 3]; 3], name: Option<NameId>, entity: String) {
    let first = surfaces.points.len() as u32;
    surfaces.points.extend(corners);
    let polygons = vec![vec![first, first + 1, first + 2]];
    surfaces.facets.push(FoundFacet { polygons, name, entity, ..FoundFacet::default() });
}

fn read_binary(bytes: &[u8]) -> Result<Surfaces, ImportError> {
    let mut surfaces = empty("STL (binary)");
    surfaces.digits = Digits::Single;
    for (i, triangle) in bytes[HEADER..].chunks_exact(TRIANGLE).enumerate() {
        // A normal first, twelve bytes, which the corners tell better.
        let number = |k: usize| {
            let at = 12 + 4 * k;
            let bits = [triangle[at], triangle[at + 1], triangle[at + 2], triangle[at + 3]];
            f64::from(f32::from_le_bytes(bits))
        };
        let corners: [[f64; 3]; 3] = std::array::from_fn(|c| std::array::from_fn(|k| number(3 * c + k)));
        if corners.iter().flatten().any(|x| !x.is_finite()) {
            let what = format!("triangle {}: a coordinate is not a finite number", i + 1);
            return Err(ImportError::new(what, "write the file anew from the program that made it"));
        }
        push(&mut surfaces, corners, None, format!("triangle {}", i + 1));
    }
    Ok(surfaces)
}

/// The rest of a line after its first word.
fn rest_of(row: Row) -> String {
    let text = String::from_utf8_lossy(row.text);
    text.trim().split_once(char::is_whitespace).map_or("", |(_, rest)| rest).trim().to_owned()
}

fn read_text(bytes: &[u8]) -> Result<Surfaces, ImportError> {
    let mut surfaces = empty("STL (text)");
    let mut written = Written::default();
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut solid: Option<(Option<NameId>, String, usize)> = None;
    let mut rows = Rows::new(bytes, HELP);
    for row in rows.by_ref() {
        let word = tokens(row.text).next().unwrap_or_default().to_ascii_lowercase();
        match word.as_slice() {
            b"solid" => {
                let text = rest_of(row);
                let name = (!text.is_empty()).then(|| surfaces.names.intern(&text));
                solid = Some((name, if text.is_empty() { text } else { format!(" of solid {text}") }, 0));
            }
            b"vertex" => {
                let mut at = [0.0; 3];
                let mut items = tokens(row.text).skip(1);
                for (i, x) in at.iter_mut().enumerate() {
                    let token =
                        items.next().ok_or_else(|| row.error(format!("a vertex needs 3 numbers, but has {i}")))?;
                    *x = row.number(token, i, "a vertex")?;
                    written.note(token, *x);
                }
                corners.push(at);
            }
            b"endloop" => {
                let Some((name, of_solid, count)) = &mut solid else {
                    return Err(row.error("a triangle outside of a solid"));
                };
                *count += 1;
                let [a, b, c] = corners[..] else {
                    return Err(row.error(format!("triangle {count}{of_solid} has {} vertices", corners.len())));
                };
                let entity = format!("triangle {count}{of_solid}");
                push(&mut surfaces, [a, b, c], *name, entity);
                corners.clear();
            }
            b"facet" | b"outer" | b"endfacet" => {}
            b"endsolid" => solid = None,
            _ => {
                let shown = String::from_utf8_lossy(&word[..word.len().min(20)]).into_owned();
                return Err(row.error(format!("expected solid, facet, vertex or an end of these, found {shown}")));
            }
        }
    }
    if !corners.is_empty() {
        let what = "the file ends within a triangle";
        return Err(ImportError::at(rows.line, what, "the file may be cut off"));
    }
    if solid.is_some() {
        surfaces.notes.push("The last solid has no end; the file may be cut off.".into());
    }
    surfaces.digits = written.digits();
    Ok(surfaces)
}
