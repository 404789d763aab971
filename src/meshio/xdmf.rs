//! XDMF 3 as one text file with its numbers inside. With two grids, for FEniCSx, which reads no mixed grid: `mesh` of
//! triangles with the cell attribute `region`, and `boundaries` of lines with the cell attribute `boundary`. Or with
//! one grid of both kinds of cells and both attributes, 0 for cells of the other kind. Numbers count from 1. Names are
//! `Information` elements (`region:NAME`). Coordinates have all their digits: two for a mesh in the plane, three for
//! one in space. Order 2 is held (Triangle_6, Edge_3).
//!
//! One grid is for meshio 5.3, which reads a domain of one grid only, without `Time`, with names in a form of its own.
//! For order 2 it reads one kind of cells only. VTK 9.7 (`vtkXdmfReader`, also in ParaView) reads both forms, two grids
//! as blocks. `pyvista.read` (0.49) fails on any XDMF without times: use VTU there.
//!
//! Not held: with one grid, the unit (two grids have it as an `Information`); links to curves, balls.

use super::groups::{Groups, Kind};
use super::losses::Losses;
use super::names::xml_attribute;
use super::{Choice, Facts, XdmfGrids, one_file};
use crate::mesh::Mesh;
use std::io::{self, Write};

/// The facts of XDMF.
pub(super) const FACTS: Facts = Facts {
    name: "xdmf",
    suffixes: &["xdmf"],
    first_as_named: true,
    choices: &[Choice::Grids],
    straight_only: None,
    write: Some(|mesh, _, options| one_file(|out| write(mesh, options.xdmf, out))),
    write_solid: None,
    losses,
    reading: None,
};

fn losses(losses: &mut Losses) {
    let single = losses.options.xdmf == XdmfGrids::Single;
    losses.interior_lines();
    losses.tell(
        losses.mesh.order() > 1 && single,
        "order 2 for meshio (5.3), which reads only straight cells in one grid of both kinds; ParaView reads it",
    );
    losses.names_of_points();
    if single {
        losses.unit();
    }
    losses.links();
}

/// Writes the mesh, its triangles and lines in one grid or in two.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
fn write(mesh: &Mesh, grids: XdmfGrids, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>")?;
    let triangles: Vec<Vec<u32>> = mesh
        .triangles
        .enumerate()
        .map(|(t, corners)| {
            corners.iter().chain(mesh.triangle_mids.get(t).into_iter().flatten()).map(|v| v.0).collect()
        })
        .collect();
    let lines: Vec<Vec<u32>> = mesh
        .edges
        .iter()
        .enumerate()
        .map(|(i, edge)| edge.nodes.iter().chain(mesh.edge_mids.get(i)).map(|v| v.0).collect())
        .collect();
    let regions: Vec<usize> = mesh.triangle_regions.iter().map(|&r| groups.region(r) + 1).collect();
    let boundaries: Vec<usize> = mesh.edges.iter().map(|e| groups.boundary(e) + 1).collect();
    let (triangle, line) = if mesh.order() == 1 { (TRIANGLE, LINE) } else { (TRIANGLE_6, LINE_3) };
    match grids {
        XdmfGrids::Double => {
            if let Some(unit) = &mesh.unit {
                writeln!(out, "<Information Name=\"unit\" Value=\"{}\"/>", xml_attribute(unit))?;
            }
            for (kind, number, name) in names(&groups) {
                writeln!(out, "<Information Name=\"{}:{}\" Value=\"{number}\"/>", kind.word(), xml_attribute(name))?;
            }
            write_grid(mesh, "mesh", &[(triangle, triangles)], &[("region", &regions)], "", out)?;
            if !mesh.edges.is_empty() {
                write_grid(mesh, "boundaries", &[(line, lines)], &[("boundary", &boundaries)], "", out)?;
            }
        }
        XdmfGrids::Single => {
            let regions = [regions.clone(), vec![0; lines.len()]].concat();
            let boundaries = [vec![0; triangles.len()], boundaries].concat();
            let cells = [(triangle, triangles), (line, lines)];
            let arrays = [("region", regions.as_slice()), ("boundary", &boundaries)];
            write_grid(mesh, "mesh", &cells, &arrays, &meshio_names(&groups), out)?;
        }
    }
    writeln!(out, "</Domain>\n</Xdmf>")
}

/// Each group: its kind, number and name.
fn names<'g>(groups: &'g Groups) -> impl Iterator<Item = (Kind, usize, &'g str)> {
    let numbered = |kind: Kind, names: &'g [&str]| (1..).zip(names).map(move |(number, name)| (kind, number, *name));
    numbered(Kind::Region, &groups.regions).chain(numbered(Kind::Boundary, &groups.boundaries))
}

/// Names with number and dimension in the form that meshio reads: markup within a text.
fn meshio_names(groups: &Groups) -> String {
    let key = |(kind, number, name): (Kind, usize, &str)| {
        let dimension = if kind == Kind::Region { 2 } else { 1 };
        format!("<map key=\"{}:{}\" dim=\"{dimension}\">{number}</map>", kind.word(), xml_attribute(name))
    };
    let keys: String = names(groups).map(key).collect();
    format!("<Information Name=\"names\" Value=\"\"><![CDATA[<names>{keys}</names>]]></Information>\n")
}

/// A kind of cells: its name, its number of nodes, and the numbers before each of its cells in a mixed list.
type Cell = (&'static str, usize, &'static [u32]);

const TRIANGLE: Cell = ("Triangle", 3, &[4]);
const TRIANGLE_6: Cell = ("Triangle_6", 6, &[36]);
/// A polyline is preceded by its number of nodes, too.
const LINE: Cell = ("Polyline", 2, &[2, 2]);
const LINE_3: Cell = ("Edge_3", 3, &[34]);

fn write_grid(
    mesh: &Mesh,
    grid: &str,
    cells: &[(Cell, Vec<Vec<u32>>)],
    arrays: &[(&str, &[usize])],
    names: &str,
    out: &mut impl Write,
) -> io::Result<()> {
    let count: usize = cells.iter().map(|(_, cells)| cells.len()).sum();
    write!(out, "<Grid Name=\"{grid}\" GridType=\"Uniform\">\n{names}")?;
    write_topology(cells, count, out)?;
    let (axes, dimension) = if mesh.frame.is_some() { ("XYZ", 3) } else { ("XY", 2) };
    writeln!(out, "<Geometry GeometryType=\"{axes}\">")?;
    let points = mesh.nodes.len();
    writeln!(
        out,
        "<DataItem Dimensions=\"{points} {dimension}\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">"
    )?;
    for place in mesh.places() {
        let place: Vec<String> = place[..dimension].iter().map(|x| format!("{x:?}")).collect();
        writeln!(out, "{}", place.join(" "))?;
    }
    writeln!(out, "</DataItem>\n</Geometry>")?;
    for (array, numbers) in arrays {
        writeln!(out, "<Attribute Name=\"{array}\" AttributeType=\"Scalar\" Center=\"Cell\">")?;
        writeln!(out, "<DataItem Dimensions=\"{count} 1\" NumberType=\"Int\" Precision=\"4\" Format=\"XML\">")?;
        numbers.iter().try_for_each(|number| writeln!(out, "{number}"))?;
        writeln!(out, "</DataItem>\n</Attribute>")?;
    }
    writeln!(out, "</Grid>")
}

/// Writes cells of one kind as a table, of several kinds as one list with their kind before each.
fn write_topology(cells: &[(Cell, Vec<Vec<u32>>)], count: usize, out: &mut impl Write) -> io::Result<()> {
    let one = match cells {
        [((name, nodes, _), _)] => Some((name, nodes)),
        _ => None,
    };
    let kind = one.map_or("Mixed", |(name, _)| name);
    let per_element = if kind == LINE.0 { " NodesPerElement=\"2\"" } else { "" };
    writeln!(out, "<Topology TopologyType=\"{kind}\" NumberOfElements=\"{count}\"{per_element}>")?;
    let length: usize = cells.iter().map(|((_, nodes, before), cells)| cells.len() * (nodes + before.len())).sum();
    let dimensions = one.map_or_else(|| length.to_string(), |(_, nodes)| format!("{count} {nodes}"));
    writeln!(out, "<DataItem Dimensions=\"{dimensions}\" NumberType=\"UInt\" Precision=\"8\" Format=\"XML\">")?;
    for ((_, _, before), cells) in cells {
        let before = if one.is_some() { &[] } else { *before };
        for cell in cells {
            let numbers: Vec<String> = before.iter().chain(cell).map(u32::to_string).collect();
            writeln!(out, "{}", numbers.join(" "))?;
        }
    }
    writeln!(out, "</DataItem>\n</Topology>")
}
