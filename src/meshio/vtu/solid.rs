//! VTK XML unstructured grids (`.vtu`) of tetrahedra, then triangles on facets, then lines on segments.
//!
//! | place | array | holds |
//! |---|---|---|
//! | cells | `region` Int32 | region number of a tetrahedron (from 1), 0 of other cells |
//! | cells | `boundary` Int32 | number of the name (from 1) of a triangle's facet or a line's segment, 0 without |
//! | cells | `facet` Int32, `segment` Int32 | the facet of a triangle, the segment of a line; −1 elsewhere |
//! | points | `weight` Float64 | the certificate of the mesh, where it has one |
//! | field | `region:NAME`, `boundary:NAME` Int32 | the numbers that carry the name |
//! | field | `point_id`, `point_node` Int32 | the points of the solid and their nodes |
//! | field | `unit` UInt8 | the physical unit of a coordinate, as UTF-8 |
//! | field | `squinch:KEY` | a stamp: Float64 where the text is a number's, else its UTF-8 bytes as UInt8 |

use super::array::{Array, begin, boundary_numbers, write_names, write_stamps};
use crate::ids::NameId;
use crate::mesh::solid::SolidMesh;
use crate::meshio::solid_groups as groups;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::iter::repeat_n;

/// Writes a mesh, with stamps (key and value) that say how it was made. The same mesh gives the same bytes.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh has more than 2³¹−1 nodes or corners, or lists that do not fit together.
pub fn write(mesh: &SolidMesh, stamps: &[(String, String)], out: &mut impl Write) -> io::Result<()> {
    groups::check(mesh)?;
    let facets = mesh.triangles.iter().map(|t| t.name);
    let boundaries = boundary_numbers(facets.chain(mesh.edges.iter().filter_map(|e| e.name)));
    begin(out)?;
    writeln!(out, "<FieldData>")?;
    write_stamps(stamps, mesh.unit.as_deref(), out)?;
    write_names(&mesh.names, &mesh.regions, &boundaries, out)?;
    Array::of_i32("point_id", mesh.points.iter().map(|(p, _)| p.0 as i32)).write_field(out)?;
    Array::of_i32("point_node", mesh.points.iter().map(|(_, v)| v.0 as i32)).write_field(out)?;
    let cells = mesh.tetrahedra.len() + mesh.triangles.len() + mesh.edges.len();
    writeln!(out, "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\">", mesh.nodes.len())?;
    writeln!(out, "<Points>")?;
    Array::of_f64("Points", 3, mesh.nodes.iter().flatten().copied()).write(out)?;
    writeln!(out, "</Points>")?;
    if !mesh.weights.is_empty() {
        writeln!(out, "<PointData>")?;
        Array::of_f64("weight", 1, mesh.weights.iter().copied()).write(out)?;
        writeln!(out, "</PointData>")?;
    }
    writeln!(out, "<Cells>")?;
    write_cells(mesh, out)?;
    writeln!(out, "</Cells>\n<CellData>")?;
    write_cell_data(mesh, &boundaries, out)?;
    writeln!(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

fn write_cells(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let (tetrahedra, triangles, lines) = (mesh.tetrahedra.len(), mesh.triangles.len(), mesh.edges.len());
    let faces = mesh.triangles.iter().flat_map(|t| &t.nodes);
    let ends = mesh.edges.iter().flat_map(|e| &e.nodes);
    let nodes = mesh.tetrahedra.iter().flatten().chain(faces).chain(ends);
    Array::of_i32("connectivity", nodes.map(|v| v.0 as i32)).write(out)?;
    let sizes = repeat_n(4, tetrahedra).chain(repeat_n(3, triangles)).chain(repeat_n(2, lines));
    let offsets = sizes.scan(0, |end, size| {
        *end += size;
        Some(*end)
    });
    Array::of_i32("offsets", offsets).write(out)?;
    // VTK_TETRA is 10, VTK_TRIANGLE 5, VTK_LINE 3.
    Array::of_u8("types", [vec![10; tetrahedra], vec![5; triangles], vec![3; lines]].concat()).write(out)
}

fn write_cell_data(mesh: &SolidMesh, boundaries: &BTreeMap<NameId, i32>, out: &mut impl Write) -> io::Result<()> {
    let (tetrahedra, triangles, lines) = (mesh.tetrahedra.len(), mesh.triangles.len(), mesh.edges.len());
    let regions = mesh.tetrahedron_regions.iter().map(|r| r.0 as i32 + 1);
    Array::of_i32("region", regions.chain(repeat_n(0, triangles + lines))).write(out)?;
    let number = |name: Option<NameId>| name.and_then(|name| boundaries.get(&name)).copied().unwrap_or(0);
    let names = mesh.triangles.iter().map(|t| Some(t.name)).chain(mesh.edges.iter().map(|e| e.name));
    Array::of_i32("boundary", repeat_n(0, tetrahedra).chain(names.map(number))).write(out)?;
    let facet = mesh.triangles.iter().map(|t| t.facet.map_or(-1, |f| f.0 as i32));
    Array::of_i32("facet", repeat_n(-1, tetrahedra).chain(facet).chain(repeat_n(-1, lines))).write(out)?;
    let segment = mesh.edges.iter().map(|e| e.segment.map_or(-1, |s| s.0 as i32));
    Array::of_i32("segment", repeat_n(-1, tetrahedra + triangles).chain(segment)).write(out)
}
