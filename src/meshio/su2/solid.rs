//! SU2's native mesh, in three dimensions.
//!
//! Every facet triangle that has a tetrahedron on one side only is in the marker of its name, as seen from outside.
//! Triangles between two regions are in none: to SU2 a marker is a border of the flow. Tags are made legal as in the
//! plane, and a comment keeps what a name was. Not held: regions (SU2 has one zone), the names of interfaces and
//! segments, the unit, the weights, links to the solid.

use super::write::tag;
use crate::mesh::solid::SolidMesh;
use crate::meshio::groups::Kind;
use crate::meshio::names::{legal_names, name_comment};
use crate::meshio::solid_groups::{FACES, Groups, by_group, tetrahedra_at};
use std::io::{self, Write};

/// Writes a mesh.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "NDIME= 3\nNELEM= {}", mesh.tetrahedra.len())?;
    for (i, t) in mesh.tetrahedra.iter().enumerate() {
        let [a, b, c, d] = t.map(|v| v.0);
        writeln!(out, "10 {a} {b} {c} {d} {i}")?;
    }
    writeln!(out, "NPOIN= {}", mesh.nodes.len())?;
    for (i, [x, y, z]) in mesh.nodes.iter().enumerate() {
        writeln!(out, "{x:?} {y:?} {z:?} {i}")?;
    }
    let tetrahedra = tetrahedra_at(mesh);
    let of_triangle = mesh.triangles.iter().zip(&tetrahedra);
    let of_triangle = of_triangle.map(|(t, at)| (at.len() == 1).then(|| groups.facets.number(t.name)));
    let markers = by_group(groups.facets.texts.len(), of_triangle);
    let legal = legal_names(&groups.facets.texts, usize::MAX, tag);
    let named = markers.iter().zip(groups.facets.texts.iter().zip(&legal)).filter(|(list, _)| !list.is_empty());
    let named: Vec<_> = named.collect();
    writeln!(out, "NMARK= {}", named.len())?;
    for (triangles, (name, legal)) in named {
        if legal != name {
            writeln!(out, "% {}", name_comment(Kind::Boundary, legal, name))?;
        }
        writeln!(out, "MARKER_TAG= {legal}\nMARKER_ELEMS= {}", triangles.len())?;
        for &i in triangles {
            let (t, corner) = tetrahedra[i][0];
            let [a, b, c] = FACES[corner].map(|k| mesh.tetrahedra[t][k].0);
            writeln!(out, "5 {a} {b} {c}")?;
        }
    }
    Ok(())
}
