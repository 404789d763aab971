//! VTK XML unstructured grids (`.vtu`) of any program → Mesh: ASCII, inline or appended data (base64 or raw), with zlib
//! or without.
//!
//! Read are triangles (types 5 and 22) and lines (types 3 and 21) in a plane. Point cells (types 1 and 2) are left out
//! and counted; any other cell is an error. Files of our writer are read back bit for bit. In other files, regions and
//! boundaries are the values of the first array of [`FOREIGN`] among the cell arrays, and their numbers are their
//! names. A mesh in a plane in space is read into the coordinates of that plane, which our writer stores.

use super::unpack::Unpacker;
use super::xml::{File, Kind, Section};
use crate::geometry::space::{dot, length, minus};
use crate::geometry::{Frame, Point};
use crate::ids::{Colour, CurveId, PointId, RegionId, VertexId};
use crate::mesh::{Ball, BallReason, CurveEdge, CurveLink};
use crate::meshio::draft::{FOREIGN, plane};
use crate::meshio::{MeshError, MeshFile, Result, broken, unsupported};
use std::collections::{BTreeMap, BTreeSet};

/// Reads a mesh of triangles from the bytes of a `.vtu` file.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let file = File::parse(bytes)?;
    let mut unpacker = Unpacker::new(&file, bytes.len());
    let mut builder = Builder::default();
    builder.nodes(&mut unpacker)?;
    builder.cells(&mut unpacker)?;
    builder.fields(&mut unpacker)?;
    Ok(builder.file)
}

#[derive(Default)]
struct Builder {
    file: MeshFile,
}

/// Numbers of regions or boundaries, and their names.
struct Groups {
    /// The name of the only group, where no array distinguishes groups.
    only: &'static str,
    names: BTreeMap<i32, String>,
}

impl Groups {
    fn read(unpacker: &mut Unpacker, prefix: &str, only: &'static str) -> Result<Self> {
        let mut names = BTreeMap::new();
        let file = unpacker.file;
        for array in file.arrays.iter().filter(|a| a.section == Section::Field) {
            if let Some(name) = array.name.strip_prefix(prefix) {
                for number in unpacker.integers(array, file.cells.saturating_add(file.points), i32::MIN)? {
                    names.entry(number).or_insert_with(|| name.to_owned());
                }
            }
        }
        Ok(Self { only, names })
    }

    fn name(&self, number: Option<i32>) -> String {
        match number {
            None => self.only.to_owned(),
            Some(n) => self.names.get(&n).cloned().unwrap_or_else(|| n.to_string()),
        }
    }
}

/// The cell arrays.
struct CellData {
    region: Option<Vec<i32>>,
    boundary: Option<Vec<i32>>,
    curve: Option<Vec<i32>>,
    t: Option<Vec<f64>>,
    /// Four bytes a cell.
    colour: Option<Vec<f64>>,
}

impl CellData {
    fn read(unpacker: &mut Unpacker) -> Result<Self> {
        let file = unpacker.file;
        let counts =
            |name| matches!(file.array(Section::CellData, name)?.kind, Kind::Int(_) | Kind::UInt(_)).then_some(name);
        let groups = FOREIGN.into_iter().find_map(counts);
        let region = groups.map(|name| Self::integers(unpacker, name)).transpose()?.flatten();
        // Other programs number lines and triangles in one array.
        let boundary = Self::integers(unpacker, "boundary")?.or_else(|| region.clone());
        let curve = Self::integers(unpacker, "curve")?;
        let t = match unpacker.file.array(Section::CellData, "t") {
            Some(array) if curve.is_some() => Some(unpacker.numbers(array, unpacker.file.cells.saturating_mul(2))?),
            _ => None,
        };
        if let Some(t) = t.iter().flatten().find(|t| !(0.0..=1.0).contains(*t)) {
            return Err(broken(format!("array 't' holds {t}, which is not a parameter of a curve (0 to 1)")));
        }
        let colour = unpacker.file.array(Section::CellData, "colour").filter(|array| array.kind == Kind::UInt(1));
        let most = unpacker.file.cells.saturating_mul(4);
        let colour = colour.map(|array| unpacker.numbers(array, most)).transpose()?;
        let colour = colour.filter(|values| values.len() as u64 == most);
        Ok(Self { region, boundary, curve, t, colour })
    }

    /// The colour of a cell, where it has one.
    fn colour(&self, cell: usize) -> Option<Colour> {
        let bytes = self.colour.as_ref()?.get(4 * cell..4 * cell + 4)?;
        let colour = std::array::from_fn(|k| bytes[k] as u8);
        (colour != [0; 4]).then_some(Colour(colour))
    }

    fn integers(unpacker: &mut Unpacker, name: &str) -> Result<Option<Vec<i32>>> {
        let Some(array) = unpacker.file.array(Section::CellData, name) else { return Ok(None) };
        let values = unpacker.integers(array, unpacker.file.cells, i32::MIN)?;
        if values.len() as u64 != unpacker.file.cells {
            return Err(broken(format!(
                "array '{name}' has {} values for {} cells",
                values.len(),
                unpacker.file.cells
            )));
        }
        Ok(Some(values))
    }

    fn link(&self, cell: usize) -> Option<CurveLink> {
        let curve = u32::try_from(*self.curve.as_ref()?.get(cell)?).ok()?;
        let t = self.t.as_ref()?.get(2 * cell..2 * cell + 2)?;
        Some(CurveLink { curve: CurveId(curve), t: [t[0], t[1]] })
    }
}

fn at(values: &Option<Vec<i32>>, cell: usize) -> Option<i32> {
    values.as_ref().and_then(|v| v.get(cell).copied())
}

impl Builder {
    fn nodes(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        let points = unpacker.file.points;
        if points == 0 {
            return Ok(());
        }
        let array = unpacker.file.array(Section::Points, "").ok_or_else(|| broken("there are no points"))?;
        let values = unpacker.numbers(array, points.saturating_mul(3))?;
        if values.len() as u64 != points.saturating_mul(3) {
            return Err(broken(format!("there are {} coordinates for {points} points", values.len())));
        }
        let places: Vec<[f64; 3]> = values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        if let Some((i, [x, y, z])) = places.iter().enumerate().find(|(_, p)| p.iter().any(|v| !v.is_finite())) {
            return Err(broken(format!("point {i} is at ({x}, {y}, {z})")));
        }
        match frame(unpacker)? {
            Some(frame) => {
                self.file.mesh.nodes = in_plane(unpacker, &places, &frame)?.into();
                self.file.mesh.frame = Some(frame);
            }
            None => (self.file.mesh.nodes, self.file.mesh.frame) = plane(&places)?,
        }
        Ok(())
    }

    fn cells(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        let file = unpacker.file;
        let part = |name| file.array(Section::Cells, name).ok_or_else(|| broken(format!("the cells have no {name}")));
        if file.cells == 0 {
            return Ok(());
        }
        let types = unpacker.integers(part("types")?, file.cells, 0)?;
        let offsets = unpacker.integers(part("offsets")?, file.cells, 0)?;
        if types.len() as u64 != file.cells || offsets.len() != types.len() {
            return Err(broken(format!(
                "{} types and {} offsets for {} cells",
                types.len(),
                offsets.len(),
                file.cells
            )));
        }
        let corners = offsets.last().map_or(0, |&n| n as u64);
        let connectivity = unpacker.integers(part("connectivity")?, corners, 0)?;
        let data = CellData::read(unpacker)?;
        let regions = Groups::read(unpacker, "region:", "region")?;
        let boundaries = Groups::read(unpacker, "boundary:", "boundary")?;
        let ids = self.regions(&types, &data, &regions);
        let (mut from, mut vertices) = (0, 0);
        for (cell, (&kind, &to)) in types.iter().zip(&offsets).enumerate() {
            let to = to as usize;
            let nodes = connectivity.get(from..to).ok_or_else(|| broken(format!("cell {cell} has no corners")))?;
            from = to;
            if let Some(node) = nodes.iter().find(|&&n| n as usize >= self.file.mesh.nodes.len()) {
                return Err(broken(format!("cell {cell} has a corner {node} that is not a point")));
            }
            match (kind, nodes) {
                (5, &[a, b, c]) | (22, &[a, b, c, ..]) if nodes.len() == if kind == 5 { 3 } else { 6 } => {
                    let region = ids.get(&at(&data.region, cell)).copied().unwrap_or(RegionId(0));
                    self.triangle([a, b, c], &nodes[3..], region, data.colour(cell));
                }
                (3, &[a, b]) | (21, &[a, b, _]) => {
                    let name = boundaries.name(at(&data.boundary, cell));
                    self.line([a, b], nodes.get(2), &name, data.link(cell));
                }
                (1 | 2, _) => vertices += 1,
                _ => return Err(refused(cell, kind, nodes.len())),
            }
        }
        let mesh = &self.file.mesh;
        let mids = |n: usize, of: usize| n == if mesh.order() == 1 { 0 } else { of };
        if !mids(mesh.triangle_mids.len(), mesh.triangles.len()) || !mids(mesh.edge_mids.len(), mesh.edges.len()) {
            return Err(unsupported("cells of first and second order are mixed", "save the mesh in one order"));
        }
        if vertices > 0 {
            self.file.notes.push(format!("{vertices} vertex cells are left out"));
        }
        Ok(())
    }

    /// Adds a triangle, for order 2 with the nodes within its sides.
    fn triangle(&mut self, corners: [i32; 3], mids: &[i32], region: RegionId, colour: Option<Colour>) {
        let (mesh, id) = (&mut self.file.mesh, |n: i32| VertexId(n as u32));
        mesh.triangles.push(corners.map(id));
        if let &[ab, bc, ca] = mids {
            mesh.triangle_mids.push([ab, bc, ca].map(id));
        }
        mesh.triangle_regions.push(region);
        if let Some(colour) = colour {
            mesh.colours.entry(mesh.regions[region]).or_insert(colour);
        }
    }

    /// Adds a line, for order 2 with the node within.
    fn line(&mut self, ends: [i32; 2], mid: Option<&i32>, name: &str, link: Option<CurveLink>) {
        let (mesh, id) = (&mut self.file.mesh, |n: i32| VertexId(n as u32));
        let name = mesh.names.intern(name);
        mesh.edge_mids.extend(mid.map(|&n| id(n)));
        mesh.edges.push(CurveEdge { nodes: ends.map(id), name, link });
    }

    /// A region for each number that is named or that a triangle has, ascending. Names of regions come before those of
    /// boundaries.
    fn regions(&mut self, types: &[i32], data: &CellData, groups: &Groups) -> BTreeMap<Option<i32>, RegionId> {
        let used = types
            .iter()
            .enumerate()
            .filter(|&(_, &kind)| matches!(kind, 5 | 22))
            .map(|(cell, _)| at(&data.region, cell));
        let numbers: BTreeSet<Option<i32>> = used.chain(groups.names.keys().map(|&n| Some(n))).collect();
        let mesh = &mut self.file.mesh;
        numbers.into_iter().map(|n| (n, mesh.regions.push(mesh.names.intern(&groups.name(n))))).collect()
    }

    fn fields(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        let file = unpacker.file;
        let nodes = self.file.mesh.nodes.len() as u64;
        let field = |name: &str| file.array(Section::Field, name);
        if let (Some(ids), Some(at)) = (field("point_id"), field("point_node")) {
            let (ids, at) = (unpacker.integers(ids, nodes, 0)?, unpacker.integers(at, nodes, 0)?);
            if ids.len() != at.len() || at.iter().any(|&n| n as u64 >= nodes) {
                return Err(broken("point_id and point_node do not fit the points"));
            }
            self.file.mesh.points =
                ids.iter().zip(&at).map(|(&p, &v)| (PointId(p as u32), VertexId(v as u32))).collect();
        }
        let balls = [field("ball_corner_point"), field("ball_radius"), field("ball_why")];
        if let [Some(corner), Some(radius), Some(why)] = balls {
            let (corner, why) = (unpacker.integers(corner, nodes, 0)?, unpacker.integers(why, nodes, 0)?);
            let radius = unpacker.numbers(radius, nodes)?;
            if corner.len() != radius.len() || why.len() != radius.len() {
                return Err(broken("the ball arrays differ in length"));
            }
            if let Some(radius) = radius.iter().find(|r| !r.is_finite()) {
                return Err(broken(format!("a ball has the radius {radius}")));
            }
            for ((&corner, &radius), &why) in corner.iter().zip(&radius).zip(&why) {
                let corner = PointId(corner as u32);
                self.file.mesh.balls.push(Ball { corner, radius, why: ball_reason(why)? });
            }
        }
        if let Some(array) = field("unit").filter(|array| array.kind == Kind::UInt(1)) {
            let bytes: Vec<u8> = unpacker.numbers(array, 64)?.iter().map(|&b| b as u8).collect();
            self.file.mesh.unit = Some(String::from_utf8_lossy(&bytes).into_owned());
        }
        self.stamps(unpacker)
    }

    fn stamps(&mut self, unpacker: &mut Unpacker) -> Result<()> {
        // A longer text is not a stamp of ours.
        const MOST: u64 = 1 << 20;
        for array in unpacker.file.arrays.iter().filter(|a| a.section == Section::Field) {
            let Some(key) = array.name.strip_prefix("squinch:") else { continue };
            let values = unpacker.numbers(array, MOST)?;
            let value = match (array.kind, values.as_slice()) {
                (Kind::Float(_), [number]) => number.to_string(),
                (Kind::UInt(1), text) => {
                    String::from_utf8_lossy(&text.iter().map(|&b| b as u8).collect::<Vec<_>>()).into()
                }
                _ => return Err(broken(format!("the stamp '{key}' is neither a number nor a text"))),
            };
            self.file.stamps.push((key.to_owned(), value));
        }
        Ok(())
    }
}

/// The frame of the plane of the mesh, where our writer stored one.
fn frame(unpacker: &mut Unpacker) -> Result<Option<Frame>> {
    let Some(array) = unpacker.file.array(Section::Field, "frame") else { return Ok(None) };
    let values = unpacker.numbers(array, 9)?;
    let [o0, o1, o2, x0, x1, x2, y0, y1, y2] = values[..] else {
        return Err(broken(format!("the frame has {} numbers, not 9", values.len())));
    };
    let frame = Frame { origin: [o0, o1, o2], x: [x0, x1, x2], y: [y0, y1, y2] };
    // Orthonormal up to rounding. NaN is refused, too.
    let near = |value: f64, wanted: f64| (value - wanted).abs() <= 1e-12;
    let [xx, yy, xy] = [dot(frame.x, frame.x), dot(frame.y, frame.y), dot(frame.x, frame.y)];
    let right = frame.origin.iter().all(|v| v.is_finite()) && near(xx, 1.0) && near(yy, 1.0) && near(xy, 0.0);
    if right { Ok(Some(frame)) } else { Err(broken("the axes of the frame are not orthonormal")) }
}

/// The points in the coordinates of a plane: those of the file if they belong to these points, else the projections of
/// the points.
fn in_plane(unpacker: &mut Unpacker, places: &[[f64; 3]], frame: &Frame) -> Result<Vec<Point>> {
    if let Some(array) = unpacker.file.array(Section::PointData, "plane") {
        let values = unpacker.numbers(array, 2 * places.len() as u64)?;
        let told: Vec<Point> = values.chunks_exact(2).map(|p| Point::new(p[0], p[1])).collect();
        if told.iter().map(|p| frame.place(*p)).eq(places.iter().copied()) {
            return Ok(told);
        }
    }
    let reach = places.iter().map(|p| length(minus(*p, frame.origin))).fold(0.0, f64::max);
    let off = places.iter().enumerate().find(|(_, p)| frame.height(**p).abs() > 1e-9 * reach); // rounding, generously
    if let Some((i, p)) = off {
        let what = format!("the mesh is not flat: point {i} lies {} off the plane of its frame", frame.height(*p));
        return Err(unsupported(what, "only meshes in a plane can be read"));
    }
    Ok(places.iter().map(|p| frame.flat(*p)).collect())
}

fn ball_reason(why: i32) -> Result<BallReason> {
    match why {
        0 => Ok(BallReason::LocalFeatureSize),
        1 => Ok(BallReason::Encroached),
        2 => Ok(BallReason::Size),
        other => Err(broken(format!("ball_why holds {other}"))),
    }
}

fn refused(cell: usize, kind: i32, corners: usize) -> MeshError {
    let name = match kind {
        3 | 5 | 21 | 22 => return broken(format!("cell {cell} of type {kind} has {corners} corners")),
        4 => "a polyline",
        6 => "a triangle strip",
        7 => "a polygon",
        8 | 9 => "a quadrilateral",
        10 => "a tetrahedron",
        _ => "of a kind that is not read",
    };
    unsupported(
        format!("cell {cell} is {name} (VTK type {kind})"),
        "only triangles and lines of order 1 or 2 can be read",
    )
}
