//! Wavefront OBJ: faces and lines. The name is the group (`g`), else the object (`o`). Normals, textures and curves are
//! skipped.

use crate::geometry::written::number;
use crate::meshio::draft::{BOUNDARY, Draft, REGION};
use crate::meshio::names::Comments;
use crate::meshio::{MeshFile, Result, broken_at, lines, text, unsupported};

/// Reads a file.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut draft = Draft::default();
    let mut comments = Comments::default();
    let mut group: Option<String> = None;
    for (n, line) in lines(bytes) {
        if let Some(comment) = line.strip_prefix(b"#") {
            comments.read(comment);
            continue;
        }
        let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        match words.next() {
            Some(b"v") => {
                let mut place = [0.0; 3];
                for x in &mut place {
                    let word = words.next().and_then(number);
                    *x = word.ok_or_else(|| broken_at(n, "a vertex does not have three coordinates"))?;
                }
                draft.nodes.push(place);
            }
            Some(b"g" | b"o") => group = words.next().map(text),
            Some(letter @ (b"f" | b"l")) => {
                let nodes: Vec<usize> = words.map(|word| vertex(word, draft.nodes.len(), n)).collect::<Result<_>>()?;
                let name = group.as_deref();
                match (letter, nodes.len()) {
                    (b"f", 3) => draft.triangle(nodes, &name.map_or(REGION.into(), |name| comments.region(name))),
                    (b"f", sides) => {
                        let what = format!("line {n}: a face has {sides} corners");
                        return Err(unsupported(what, "only triangles can be read"));
                    }
                    _ => {
                        let name = name.map_or(BOUNDARY.into(), |name| comments.boundary(name));
                        nodes.windows(2).for_each(|ends| draft.line(ends.to_vec(), &name));
                    }
                }
            }
            _ => {}
        }
    }
    let mut file = draft.finish()?;
    file.mesh.unit = comments.unit;
    Ok(file)
}

/// The vertex `7`, `7/1/2` or `-1`, which counts back from the last one so far.
fn vertex(word: &[u8], so_far: usize, line: usize) -> Result<usize> {
    let head = text(word.split(|&b| b == b'/').next().unwrap_or_default());
    let found = match head.parse::<i64>() {
        Ok(v @ 1..) => usize::try_from(v - 1).ok(),
        Ok(v @ ..=-1) => usize::try_from(v.unsigned_abs()).ok().and_then(|back| so_far.checked_sub(back)),
        _ => None,
    };
    found.ok_or_else(|| broken_at(line, format!("'{head}' is not a vertex")))
}
