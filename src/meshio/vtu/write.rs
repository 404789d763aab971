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

use crate::geometry::Frame;
use crate::ids::{Id, NameId, RegionId};
use crate::mesh::{BallReason, CurveEdge, Mesh};
use crate::meshio::groups;
use crate::meshio::names::xml_attribute;
use crate::threads;
use base64::Engine;
use flate2::{Compress, Compression, FlushCompress, Status};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Bytes of a block before compression: a multiple of each word size, large enough to compress well, small enough to
/// share among threads.
const BLOCK: usize = 1 << 17;

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
    write_fields(mesh, stamps, &boundary_numbers(mesh), out)?;
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

fn begin(out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
         compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>"
    )
}

/// Writes the piece and the end of the file; if `material`, with the regions in the form that MFEM reads.
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
    write_cell_data(mesh, &boundary_numbers(mesh), out)?;
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

/// Boundary names, numbered from 1 in the order of first use. A reader restores this order.
fn boundary_numbers(mesh: &Mesh) -> BTreeMap<NameId, i32> {
    let mut numbers = BTreeMap::new();
    for edge in &mesh.edges {
        let next = numbers.len() as i32 + 1;
        numbers.entry(edge.name).or_insert(next);
    }
    numbers
}

fn write_fields(
    mesh: &Mesh,
    stamps: &[(String, String)],
    boundaries: &BTreeMap<NameId, i32>,
    out: &mut impl Write,
) -> io::Result<()> {
    for (key, value) in stamps {
        let name = format!("squinch:{key}");
        match value.parse::<f64>() {
            Ok(number) if number.to_string() == *value => Array::of_f64(&name, 1, [number]),
            _ => Array::of_u8(&name, value.as_bytes().to_vec()),
        }
        .write_field(out)?;
    }
    if let Some(unit) = &mesh.unit {
        Array::of_u8("unit", unit.as_bytes().to_vec()).write_field(out)?;
    }
    if let Some(Frame { origin, x, y }) = mesh.frame {
        Array::of_f64("frame", 9, [origin, x, y].concat()).write_field(out)?;
    }
    // In the order of first use, so that the file does not depend on the order of the table of names.
    let mut numbers: BTreeMap<NameId, Vec<i32>> = BTreeMap::new();
    for (region, &name) in mesh.regions.enumerate() {
        numbers.entry(name).or_default().push(region.index() as i32 + 1);
    }
    for name in mesh.regions.iter() {
        let Some(numbers) = numbers.remove(name) else { continue };
        Array::of_i32(&format!("region:{}", mesh.names.text(*name)), numbers).write_field(out)?;
    }
    let mut by_number: Vec<(i32, NameId)> = boundaries.iter().map(|(&name, &number)| (number, name)).collect();
    by_number.sort_unstable();
    for (number, name) in by_number {
        Array::of_i32(&format!("boundary:{}", mesh.names.text(name)), [number]).write_field(out)?;
    }
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
        Array { components: 4, ..Array::of_u8("colour", bytes) }.write(out)?;
    }
    let curve = |e: &CurveEdge| e.link.map_or(-1, |link| link.curve.0 as i32);
    Array::of_i32("curve", no(-1, triangles).chain(mesh.edges.iter().map(curve))).write(out)?;
    let t = mesh.edges.iter().flat_map(|e| e.link.map_or([0.0; 2], |link| link.t));
    Array::of_f64("t", 2, std::iter::repeat_n(0.0, 2 * triangles).chain(t)).write(out)
}

/// One `DataArray`, its values as little-endian bytes.
struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    values: usize,
    bytes: Vec<u8>,
}

impl<'a> Array<'a> {
    fn of_i32(name: &'a str, values: impl IntoIterator<Item = i32>) -> Self {
        let bytes: Vec<u8> = values.into_iter().flat_map(i32::to_le_bytes).collect();
        Self { name, kind: "Int32", components: 1, values: bytes.len() / 4, bytes }
    }

    fn of_f64(name: &'a str, components: usize, values: impl IntoIterator<Item = f64>) -> Self {
        let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
        Self { name, kind: "Float64", components, values: bytes.len() / 8, bytes }
    }

    fn of_u8(name: &'a str, bytes: Vec<u8>) -> Self {
        Self { name, kind: "UInt8", components: 1, values: bytes.len(), bytes }
    }

    /// Writes a field array with its number of tuples, which VTK needs. An empty list is left out. An empty text is
    /// kept.
    fn write_field(&self, out: &mut impl Write) -> io::Result<()> {
        if self.values == 0 && !self.name.starts_with("squinch:") {
            return Ok(());
        }
        self.write_with(&format!(" NumberOfTuples=\"{}\"", self.values / self.components), out)
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        self.write_with("", out)
    }

    fn write_with(&self, more: &str, out: &mut impl Write) -> io::Result<()> {
        let name = xml_attribute(self.name);
        let components =
            if self.components == 1 { String::new() } else { format!(" NumberOfComponents=\"{}\"", self.components) };
        let format = if self.bytes.is_empty() { "ascii" } else { "binary" };
        writeln!(out, "<DataArray type=\"{}\" Name=\"{name}\"{components}{more} format=\"{format}\">", self.kind)?;
        if !self.bytes.is_empty() {
            write_compressed(&self.bytes, out)?;
        }
        writeln!(out, "\n</DataArray>")
    }
}

/// Header (number of blocks, block size, size of a last partial block, compressed sizes) and blocks, each as base64.
fn write_compressed(bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    let blocks: Vec<&[u8]> = bytes.chunks(BLOCK).collect();
    let blocks: Vec<Vec<u8>> =
        threads::map(&blocks, |block| compressed(block)).into_iter().collect::<io::Result<_>>()?;
    let mut header = vec![blocks.len() as u64, BLOCK as u64, (bytes.len() % BLOCK) as u64];
    header.extend(blocks.iter().map(|b| b.len() as u64));
    let header: Vec<u8> = header.into_iter().flat_map(u64::to_le_bytes).collect();
    let base64 = &base64::engine::general_purpose::STANDARD;
    out.write_all(base64.encode(header).as_bytes())?;
    out.write_all(base64.encode(blocks.concat()).as_bytes())
}

thread_local! {
    /// One compressor for each thread, because creating one clears a third of a megabyte.
    static DEFLATE: RefCell<Compress> = RefCell::new(Compress::new(Compression::fast(), true));
}

/// A block as a zlib stream.
fn compressed(block: &[u8]) -> io::Result<Vec<u8>> {
    DEFLATE.with_borrow_mut(|deflate| {
        deflate.reset();
        let mut out = Vec::with_capacity(BLOCK / 4);
        loop {
            let done = deflate.total_in() as usize;
            match deflate.compress_vec(&block[done..], &mut out, FlushCompress::Finish)? {
                Status::StreamEnd => return Ok(out),
                Status::Ok | Status::BufError => out.reserve(BLOCK / 4),
            }
        }
    })
}
