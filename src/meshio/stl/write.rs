//! STL as text: one `solid` for each region. Unlike the binary form, text has names and all digits of a coordinate.
//! Cells of order 2 are written as four straight ones.
//!
//! Not held: boundaries, shared nodes (readers join equal coordinates), order 2, the unit, links to curves, balls.

use crate::ids::Id;
use crate::mesh::Mesh;
use crate::meshio::groups::{Groups, straight_triangles};
use std::io::{self, Write};

/// Writes the triangles.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the lists of the mesh do not fit together.
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let places: Vec<[f64; 3]> = mesh.places().collect();
    if groups.regions.is_empty() {
        return writeln!(out, "solid\nendsolid");
    }
    for (triangles, name) in groups.triangles().iter().zip(&groups.regions) {
        let name = name.replace(char::is_control, " ");
        writeln!(out, "solid {name}")?;
        for corners in triangles.iter().flat_map(|&t| straight_triangles(mesh, t)) {
            let corners = corners.map(|v| places[v.index()]);
            let [x, y, z] = normal(corners);
            writeln!(out, " facet normal {x:?} {y:?} {z:?}\n  outer loop")?;
            for [x, y, z] in corners {
                writeln!(out, "   vertex {x:?} {y:?} {z:?}")?;
            }
            writeln!(out, "  endloop\n endfacet")?;
        }
        writeln!(out, "endsolid {name}")?;
    }
    Ok(())
}

/// The unit normal by the right-hand rule, or zero. Zero tells readers to compute it from the corners.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let [u, v]: [[f64; 3]; 2] = [b, c].map(|p| std::array::from_fn(|k| p[k] - a[k]));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length.is_normal() { n.map(|x| x / length) } else { [0.0; 3] }
}
