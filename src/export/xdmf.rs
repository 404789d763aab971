//! XDMF 3 as one text file, its numbers inside: grid `mesh` of triangles with the cell attribute `region`, grid `boundaries` of
//! lines with the cell attribute `boundary`, numbered from 1. Two grids, as FEniCSx reads them: it takes no mixed one. The names
//! of the numbers are `Information` elements (`region:NAME`). Coordinates have all their digits: two of a mesh in the plane, three
//! of one in space. Order 2 is held (Triangle_6, Edge_3).
//!
//! Not held: the unit is an `Information` only; links to curves, balls.

use super::groups::{Groups, Kind};
use super::vtu::attribute;
use crate::mesh::Mesh;
use std::io::{self, Write};

/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    writeln!(out, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>")?;
    if let Some(unit) = &mesh.unit {
        writeln!(out, "<Information Name=\"unit\" Value=\"{}\"/>", attribute(unit))?;
    }
    for (kind, names) in [(Kind::Region, &groups.regions), (Kind::Boundary, &groups.boundaries)] {
        for (i, name) in names.iter().enumerate() {
            writeln!(out, "<Information Name=\"{}:{}\" Value=\"{}\"/>", kind.word(), attribute(name), i + 1)?;
        }
    }
    let (triangle, line) =
        if mesh.order() == 1 { (("Triangle", 3), ("Polyline", 2)) } else { (("Triangle_6", 6), ("Edge_3", 3)) };
    let mut triangles = mesh.triangles.enumerate().map(|(t, corners)| {
        corners.iter().chain(mesh.triangle_mids.get(t).into_iter().flatten()).map(|v| v.0).collect::<Vec<_>>()
    });
    let mut regions = mesh.triangle_regions.iter().map(|&r| groups.region(r) + 1);
    write_grid(mesh, ("mesh", "region"), triangle, &mut triangles, &mut regions, out)?;
    if !mesh.edges.is_empty() {
        let nodes = |(i, e): (usize, &crate::mesh::CurveEdge)| {
            e.nodes.iter().chain(mesh.edge_mids.get(i)).map(|v| v.0).collect::<Vec<_>>()
        };
        let mut lines = mesh.edges.iter().enumerate().map(nodes);
        let mut boundaries = mesh.edges.iter().map(|e| groups.boundary(e) + 1);
        write_grid(mesh, ("boundaries", "boundary"), line, &mut lines, &mut boundaries, out)?;
    }
    writeln!(out, "</Domain>\n</Xdmf>")
}

fn write_grid(
    mesh: &Mesh,
    (grid, array): (&str, &str),
    (topology, nodes): (&str, usize),
    cells: &mut dyn ExactSizeIterator<Item = Vec<u32>>,
    numbers: &mut dyn Iterator<Item = usize>,
    out: &mut impl Write,
) -> io::Result<()> {
    let count = cells.len();
    let per_element = if topology == "Polyline" { " NodesPerElement=\"2\"" } else { "" };
    writeln!(out, "<Grid Name=\"{grid}\" GridType=\"Uniform\">")?;
    writeln!(out, "<Topology TopologyType=\"{topology}\" NumberOfElements=\"{count}\"{per_element}>")?;
    writeln!(out, "<DataItem Dimensions=\"{count} {nodes}\" NumberType=\"UInt\" Precision=\"8\" Format=\"XML\">")?;
    for cell in cells {
        let nodes: Vec<String> = cell.iter().map(u32::to_string).collect();
        writeln!(out, "{}", nodes.join(" "))?;
    }
    let (axes, dimension) = if mesh.frame.is_some() { ("XYZ", 3) } else { ("XY", 2) };
    writeln!(out, "</DataItem>\n</Topology>\n<Geometry GeometryType=\"{axes}\">")?;
    let points = mesh.nodes.len();
    writeln!(
        out,
        "<DataItem Dimensions=\"{points} {dimension}\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">"
    )?;
    for place in mesh.places() {
        let place: Vec<String> = place[..dimension].iter().map(|x| format!("{x:?}")).collect();
        writeln!(out, "{}", place.join(" "))?;
    }
    writeln!(out, "</DataItem>\n</Geometry>\n<Attribute Name=\"{array}\" AttributeType=\"Scalar\" Center=\"Cell\">")?;
    writeln!(out, "<DataItem Dimensions=\"{count} 1\" NumberType=\"Int\" Precision=\"4\" Format=\"XML\">")?;
    for number in numbers {
        writeln!(out, "{number}")?;
    }
    writeln!(out, "</DataItem>\n</Attribute>\n</Grid>")
}
