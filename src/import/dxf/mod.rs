//! DXF, the drawing exchange format of AutoCAD: text and binary, from before R12 to R2018. Curves stay what they are.
//!
//! - *Curves*: LINE, LWPOLYLINE and POLYLINE (bulges become arcs), ARC, CIRCLE, ELLIPSE, SPLINE, the outlines of SOLID, TRACE and
//!   3DFACE and flat meshes, and all of these in blocks, as INSERT draws them. A curve's name is its layer. POINT is a point.
//! - *Regions*: closed outlines are filled by the odd-even rule, so that an outline within an outline is a hole.
//! - *Hatches* (and MPOLYGON): a drawing of nothing else is a picture of filled shapes, whose regions are named after their layers.
//!   Beside other curves, a boundary that repeats what they draw, rounded or as a polygon, is no curve: the layer of the hatch names the
//!   region in which it lies. A boundary that repeats nothing is an outline like the others of its layer. A hatch on a layer without
//!   other curves is a region of that name and of its own extent.
//! - *Left out and counted*: what is not in model space, not visible (layers that are off or frozen, and `Defpoints`), not parallel to the XY
//!   plane, and every entity that is no curve. Heights are dropped.
//! - *Unit*: `$INSUNITS`, else what `$MEASUREMENT` suggests, else none.
//!
//! The format: Autodesk, *DXF Reference*, with the arbitrary axis algorithm of its chapter "Object Coordinate Systems".

mod blocks;
mod entities;
mod fills;
mod hatch;
mod header;
mod layers;
mod pairs;
mod sections;

use super::{ImportError, Selection};
use crate::domain::Drawing;
use blocks::Sketch;
use header::Header;
use sections::Sections;

/// Whether the bytes start as a DXF file does.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    pairs::sniff(bytes)
}

/// Reads a drawing, of the layers that `selection` asks for; `stem` is its title.
///
/// # Errors
/// With the line and the entity: where the file is no DXF file or is cut short before the end of its entities, where a number of a
/// drawn entity is none or its data contradict each other, and where blocks unfold to more than a million curves.
pub fn read(bytes: &[u8], stem: &str, selection: &Selection) -> Result<Drawing, ImportError> {
    let mut file = Sections::read(bytes)?;
    let header = Header::read(&file);
    let format = match file.is_binary {
        true => format!("dxf ({}, binary)", header.version),
        false => format!("dxf ({})", header.version),
    };
    let mut drawing =
        Drawing { format, title: stem.into(), notes: std::mem::take(&mut file.notes), ..Drawing::default() };
    header.tell_unit(&mut drawing);
    let fills = Sketch::new(&file, &header, selection, &mut drawing).draw()?;
    fills::add(&fills, &mut drawing);
    Ok(drawing)
}
