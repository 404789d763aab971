//! VTK XML unstructured grids (`.vtu`): triangles, then boundary lines, with regions, boundaries and links back to
//! the curves. Order 2 is held (types 22 and 21).
//!
//! | place | array | holds |
//! |---|---|---|
//! | cells | `colour` UInt8 ×4 | red, green, blue, opacity of a triangle's region, if the drawing has one |
//! | cells | `region` Int32 | region number of a triangle (from 1), 0 of a line |
//! | cells | `boundary` Int32 | boundary number of a line (from 1), 0 of a triangle |
//! | cells | `curve` Int32, `t` 2 × Float64 | a line's curve and the parameters of its ends; −1 and 0 elsewhere |
//! | field | `region:NAME`, `boundary:NAME` Int32 | the numbers that carry the name |
//! | field | `point_id`, `point_node` Int32 | the points of P and their nodes |
//! | field | `ball_corner_point`, `ball_radius`, `ball_why` | protecting balls; why: 0 lfs₀, 1 encroached, 2 size |
//! | field | `unit` UInt8 | the physical unit of a coordinate, as UTF-8 |
//! | field | `frame` 9 × Float64 | of a mesh in a plane in space: the plane's origin and its two unit axes |
//! | points | `plane` 2 × Float64 | of a mesh in a plane in space: every node in the coordinates of the plane |
//! | field | `squinch:KEY` | a stamp: Float64 where the text is a number's, else its UTF-8 bytes as UInt8 |
//!
//! Names are names of arrays, not VTK string arrays. meshio 5.3 refuses a file with an array of type `String` ("Illegal
//! data type"), but both it and VTK list the names of field arrays. Empty arrays are not compressed, also because of
//! meshio.
//!
//! MFEM 4.10 refuses field data before the piece, and lines beside triangles. A plain file has neither. MFEM takes its
//! attributes from the first cell array, whatever its name, if `Scalars` of `CellData` is `material`; otherwise all
//! attributes are 1. So a plain file has the number of the region again, as `material`. Names and boundaries reach MFEM
//! by MSH.
//!
//! The vtkio crate (0.7.0-rc2) is not used, because it keeps a second model of the file in memory and compresses one
//! block after the other. Here each array is made, compressed in parallel blocks and written before the next.

use super::array::{Array, begin, boundary_numbers, write_names, write_stamps};
use crate::geometry::Frame;
use crate::ids::{NameId, RegionId};
use crate::mesh::{BallReason, CurveEdge, Mesh};
use crate::meshio::groups;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Writes a mesh, with stamps (key and value) that say how it was made. The same mesh gives the same bytes.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh has more than 2³¹−1 nodes or corners (numbers are Int32), or lists
/// of different length. Characters that XML cannot hold (control characters but tab and line ends) become U+FFFD in
/// names.
pub fn write(mesh: &Mesh, stamps: &[(String, String)], out: &mut impl Write) -> io::Result<()> {
    check(mesh)?;
    begin(out)?;
    writeln!(out, "<FieldData>")?;
    write_fields(mesh, stamps, &boundary_numbers(mesh.edges.iter().map(|e| e.name)), out)?;
    writeln!(out, "</FieldData>")?;
    write_piece(mesh, false, out)
}

/// Writes a mesh without field data, and so without names. Boundaries are lines if `lines`.
///
/// # Errors
/// As [`write`].
pub fn write_plain(mesh: &Mesh, lines: bool, out: &mut impl Write) -> io::Result<()> {
    check(mesh)?;
    begin(out)?;
    if lines {
        return write_piece(mesh, true, out);
    }
    write_piece(&Mesh { edges: Vec::new(), edge_mids: Vec::new(), ..mesh.clone() }, true, out)
}

/// The piece and the end of the file; `material`: with the regions as MFEM takes them.
fn write_piece(mesh: &Mesh, material: bool, out: &mut impl Write) -> io::Result<()> {
    let cells = mesh.triangles.len() + mesh.edges.len();
    writeln!(out, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\">\n<Points>", mesh.nodes.len())?;
    let points: Vec<f64> = mesh.places().flatten().collect();
    Array::of_f64("Points", 3, points).write(out)?;
    writeln!(out, "</Points>")?;
    if mesh.frame.is_some() {
        writeln!(out, "<PointData>")?;
        Array::of_f64("plane", 2, mesh.nodes.iter().flat_map(|p| [p.x, p.y])).write(out)?;
        writeln!(out, "</PointData>")?;
    }
    writeln!(out, "<Cells>")?;
    write_cells(mesh, out)?;
    writeln!(out, "</Cells>\n<CellData{}>", if material { " Scalars=\"material\"" } else { "" })?;
    if material {
        Array::of_i32("material", region_numbers(mesh)).write(out)?;
    }
    write_cell_data(mesh, &boundary_numbers(mesh.edges.iter().map(|e| e.name)), out)?;
    writeln!(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

fn check(mesh: &Mesh) -> io::Result<()> {
    let corners = 6 * mesh.triangles.len() + 3 * mesh.edges.len();
    if mesh.nodes.len().max(corners) > i32::MAX as usize {
        let what = "the mesh has more corners than VTU's Int32 can number (2^31 - 1)";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    groups::check(mesh)
}

fn write_fields(
    mesh: &Mesh,
    stamps: &[(String, String)],
    boundaries: &BTreeMap<NameId, i32>,
    out: &mut impl Write,
) -> io::Result<()> {
    write_stamps(stamps, mesh.unit.as_deref(), out)?;
    if let Some(Frame { origin, x, y }) = mesh.frame {
        Array::of_f64("frame", 9, [origin, x, y].concat()).write_field(out)?;
    }
    write_names(&mesh.names, &mesh.regions, boundaries, out)?;
    Array::of_i32("point_id", mesh.points.iter().map(|(p, _)| p.0 as i32)).write_field(out)?;
    Array::of_i32("point_node", mesh.points.iter().map(|(_, v)| v.0 as i32)).write_field(out)?;
    Array::of_i32("ball_corner_point", mesh.balls.iter().map(|b| b.corner.0 as i32)).write_field(out)?;
    Array::of_f64("ball_radius", 1, mesh.balls.iter().map(|b| b.radius)).write_field(out)?;
    Array::of_u8("ball_why", mesh.balls.iter().map(|b| why_number(b.why)).collect()).write_field(out)
}

fn why_number(why: BallReason) -> u8 {
    match why {
        BallReason::LocalFeatureSize => 0,
        BallReason::Encroached => 1,
        BallReason::Size => 2,
    }
}

fn write_cells(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let (triangles, lines) = (mesh.triangles.len(), mesh.edges.len());
    // VTK_TRIANGLE is 5, VTK_LINE 3; VTK_QUADRATIC_TRIANGLE 22, VTK_QUADRATIC_EDGE 21.
    let ((triangle, corners), (line, ends)) = if mesh.order() == 1 { ((5, 3), (3, 2)) } else { ((22, 6), (21, 3)) };
    let mids = |t| mesh.triangle_mids.get(t).into_iter().flatten();
    let of_triangles = mesh.triangles.enumerate().flat_map(|(t, corners)| corners.iter().chain(mids(t)));
    let of_lines = mesh.edges.iter().enumerate().flat_map(|(i, e)| e.nodes.iter().chain(mesh.edge_mids.get(i)));
    Array::of_i32("connectivity", of_triangles.chain(of_lines).map(|v| v.0 as i32)).write(out)?;
    let line_offsets = (1..=lines).map(|i| (corners * triangles + ends * i) as i32);
    Array::of_i32("offsets", (1..=triangles).map(|i| (corners * i) as i32).chain(line_offsets)).write(out)?;
    Array::of_u8("types", [vec![triangle; triangles], vec![line; lines]].concat()).write(out)
}

/// For each cell the number of its region, from 1; 0 for lines.
fn region_numbers(mesh: &Mesh) -> impl Iterator<Item = i32> {
    let regions = mesh.triangle_regions.iter().map(|r| r.0 as i32 + 1);
    regions.chain(std::iter::repeat_n(0, mesh.edges.len()))
}

fn write_cell_data(mesh: &Mesh, boundaries: &BTreeMap<NameId, i32>, out: &mut impl Write) -> io::Result<()> {
    let (triangles, lines) = (mesh.triangles.len(), mesh.edges.len());
    let no = |value: i32, cells: usize| std::iter::repeat_n(value, cells);
    Array::of_i32("region", region_numbers(mesh)).write(out)?;
    let number = |e: &CurveEdge| boundaries.get(&e.name).copied().unwrap_or(0);
    Array::of_i32("boundary", no(0, triangles).chain(mesh.edges.iter().map(number))).write(out)?;
    if !mesh.colours.is_empty() {
        let drawn = |region: &RegionId| mesh.colours.get(&mesh.regions[*region]).map_or([0; 4], |colour| colour.0);
        let bytes: Vec<u8> = mesh.triangle_regions.iter().flat_map(drawn).chain(vec![0; 4 * lines]).collect();
        Array::of_u8("colour", bytes).in_tuples(4).write(out)?;
    }
    let curve = |e: &CurveEdge| e.link.map_or(-1, |link| link.curve.0 as i32);
    Array::of_i32("curve", no(-1, triangles).chain(mesh.edges.iter().map(curve))).write(out)?;
    let t = mesh.edges.iter().flat_map(|e| e.link.map_or([0.0; 2], |link| link.t));
    Array::of_f64("t", 2, std::iter::repeat_n(0.0, 2 * triangles).chain(t)).write(out)
}
