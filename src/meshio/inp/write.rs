//! Abaqus' and CalculiX's input deck: the mesh and its sets, to be included in a deck (`*INCLUDE`).
//!
//! A mesh in the plane has elements CPS3 or CPS6, plane stress. For plane strain or a body of revolution change the
//! type to CPE or CAX. A mesh in space has shells S3 or S6. Each region is an `ELSET`. Each boundary is an `NSET` (with
//! mid nodes) and, in the plane, a `SURFACE` of element faces S1 to S3 (S1 is between corners 1 and 2); for an
//! interface, of the faces on the left of its curve. Set names are ASCII letters, digits, `_` and `-`, begin with a
//! letter, have at most 80 characters and differ not only in case. A comment keeps the original name.
//!
//! CalculiX reads the first 20 characters of a number, so a number has at most 20. They hold all digits of `f64`,
//! except for numbers below 1e-3 and with large exponents, which keep 13 or more.
//!
//! meshio 5.3 knows no CPS6; CalculiX and Abaqus do.
//!
//! Not held: links to curves, balls; the surfaces of shells.

use crate::ids::{Id, TriangleId, VertexId};
use crate::mesh::Mesh;
use crate::meshio::groups::{Groups, Kind, sides, undirected};
use crate::meshio::names::{identifier, legal_names, name_comment};
use std::collections::BTreeSet;
use std::io::{self, Write};

pub const LONGEST_NAME: usize = 80;
const LONGEST_NUMBER: usize = 20;

/// Writes the deck.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the lists of the mesh do not fit together.
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let regions = legal_names(&groups.regions, LONGEST_NAME, identifier);
    let boundaries = legal_names(&groups.boundaries, LONGEST_NAME, identifier);
    writeln!(out, "** triangles by squinch")?;
    if let Some(unit) = &mesh.unit {
        writeln!(out, "** unit {}", unit.replace(char::is_control, " "))?;
    }
    for (kind, legal, names) in
        [(Kind::Region, &regions, &groups.regions), (Kind::Boundary, &boundaries, &groups.boundaries)]
    {
        for (legal, name) in legal.iter().zip(names).filter(|(legal, name)| legal != *name) {
            writeln!(out, "** {}", name_comment(kind, legal, name))?;
        }
    }
    writeln!(out, "*NODE")?;
    for (i, place) in mesh.places().enumerate() {
        let [x, y, z] = place.map(number);
        writeln!(out, "{}, {x}, {y}, {z}", i + 1)?;
    }
    write_elements(mesh, &groups, &regions, out)?;
    write_boundaries(mesh, &groups, &boundaries, out)
}

fn write_elements(mesh: &Mesh, groups: &Groups, names: &[String], out: &mut impl Write) -> io::Result<()> {
    let kind = match (mesh.frame.is_some(), mesh.order()) {
        (false, 1) => "CPS3",
        (false, _) => "CPS6",
        (true, 1) => "S3",
        (true, _) => "S6",
    };
    for (triangles, name) in groups.triangles().iter().zip(names).filter(|(triangles, _)| !triangles.is_empty()) {
        writeln!(out, "*ELEMENT, TYPE={kind}, ELSET={name}")?;
        for &t in triangles {
            write!(out, "{}", t.index() + 1)?;
            for v in mesh.triangles[t].iter().chain(mesh.triangle_mids.get(t).into_iter().flatten()) {
                write!(out, ", {}", v.index() + 1)?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

fn write_boundaries(mesh: &Mesh, groups: &Groups, names: &[String], out: &mut impl Write) -> io::Result<()> {
    let sides = sides(mesh);
    for (edges, name) in groups.edges().iter().zip(names) {
        let ends = edges.iter().flat_map(|&i| mesh.edges[i].nodes.into_iter().chain(mesh.edge_mids.get(i).copied()));
        let nodes: BTreeSet<VertexId> = ends.collect();
        writeln!(out, "*NSET, NSET={name}")?;
        let nodes: Vec<String> = nodes.iter().map(|v| (v.index() + 1).to_string()).collect();
        for line in nodes.chunks(16) {
            writeln!(out, "{}", line.join(", "))?;
        }
        let face = |&i: &usize| -> Option<(TriangleId, usize)> {
            let [a, b] = mesh.edges[i].nodes;
            let there = sides.get(&undirected([a, b]))?;
            let left = there.iter().find(|&&(t, side)| mesh.triangles[t][side] == a);
            left.or(there.first()).copied()
        };
        let faces: Vec<_> = edges.iter().filter_map(face).collect();
        if mesh.frame.is_none() && !faces.is_empty() {
            writeln!(out, "*SURFACE, NAME={name}, TYPE=ELEMENT")?;
            for (t, side) in faces {
                writeln!(out, "{}, S{}", t.index() + 1, side + 1)?;
            }
        }
    }
    Ok(())
}

/// A number in at most [`LONGEST_NUMBER`] characters: exact where it fits, else rounded to as many digits as do.
pub fn number(v: f64) -> String {
    let exact = format!("{v:?}");
    if exact.len() <= LONGEST_NUMBER {
        return exact;
    }
    let digits = (0..=16).rev().map(|digits| format!("{v:.digits$e}"));
    digits.into_iter().find(|text| text.len() <= LONGEST_NUMBER).unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_fit_their_field() {
        for v in [0.1, -1.0 / 3.0, 1e-300 / 3.0, -1e300 / 3.0, 123456.78901234567, -1e7 / 3.0, 1e22, -0.0, 1e-5 / 3.0] {
            let text = number(v);
            assert!(text.len() <= LONGEST_NUMBER, "{text}");
            let back: f64 = text.parse().expect("a number");
            assert!((back - v).abs() <= 1e-12 * v.abs(), "{v:?} {text}");
        }
        assert_eq!(number(-1.0 / 3.0), "-0.3333333333333333");
    }
}
