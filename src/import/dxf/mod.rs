//! DXF, the drawing exchange format of AutoCAD: text and binary, from before R12 to R2018. Curves stay what they are.
//!
//! - *Curves*: LINE, LWPOLYLINE and POLYLINE (bulges become arcs), MLINE, ARC, CIRCLE, ELLIPSE, SPLINE, the outlines of
//!   SOLID, TRACE and 3DFACE and flat meshes, and all of these in blocks, as INSERT draws them. A curve's name is its
//!   layer. POINT is a point.
//! - *Regions*: closed outlines are filled by the odd-even rule, so that an outline within an outline is a hole.
//! - *Hatches* (and MPOLYGON): a drawing of nothing else is a picture of filled shapes, whose regions are named after
//!   their layers. Beside other curves, a boundary that repeats what they draw, rounded or as a polygon, is no curve:
//!   the layer of the hatch names the region in which it lies. A boundary that repeats nothing is an outline like the
//!   others of its layer. A hatch on a layer without other curves is a region of that name and of its own extent.
//! - *Left out and counted*: what is not in model space, not visible (layers that are off or frozen, and `Defpoints`),
//!   not on a layer that is asked for, not of a line type for edges, not parallel to the XY plane, and every entity
//!   that is no curve. Heights are dropped.
//! - *Unit*: `$INSUNITS`, else what `$MEASUREMENT` suggests, else none.
//!
//! The format: Autodesk, *DXF Reference*, with the arbitrary axis algorithm of its chapter "Object Coordinate Systems".

mod arc;
mod blocks;
mod entities;
mod figure;
mod fills;
mod hatch;
mod header;
mod layers;
mod mline;
mod pairs;
mod plane;
mod polyline;
mod sections;
mod spline;
mod text;

use super::{Certainty, Facts, ImportError, Selection};
use crate::domain::Drawing;
use crate::options::Switch;
use blocks::Sketch;
use header::Header;
use schemars::JsonSchema;
use sections::Sections;
use serde::{Deserialize, Serialize};

pub(super) const FACTS: Facts = Facts {
    name: "dxf",
    suffixes: &["dxf"],
    sign: pairs::sniff,
    certainty: Certainty::Mark,
    read: |bytes, stem, options| read(bytes, stem, &options.dxf, &options.selection).map(Into::into),
};

/// Which line types are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LineTypes {
    /// Not those that drafting standards use for what is no edge, as centre lines; where nothing else is drawn, all.
    #[default]
    Edges,
    /// All that are drawn.
    All,
}

/// How a drawing is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default)]
pub struct DxfOptions {
    /// DXF: edges leaves out what is drawn in line types for centre, hidden and phantom lines, unless nothing else is
    /// drawn.
    #[schemars(extend("group" = "input", "value" = "WHICH"))]
    pub line_types: LineTypes,
    /// DXF: what leaves the XY plane is projected onto it; else it is left out.
    #[schemars(extend("group" = "input", "value" = "on|off", "switch" = true))]
    pub flatten_z: Switch,
}

impl Default for DxfOptions {
    fn default() -> Self {
        Self { line_types: LineTypes::Edges, flatten_z: Switch::Off }
    }
}

/// Reads a drawing, of the layers that `selection` asks for; `stem` is its title.
///
/// # Errors
/// With the line and the entity: where the file is no DXF file or is cut short before the end of its entities, where a
/// number of a drawn entity is none or its data contradict each other, and where blocks unfold to more than a million
/// curves.
pub fn read(bytes: &[u8], stem: &str, options: &DxfOptions, selection: &Selection) -> Result<Drawing, ImportError> {
    let file = Sections::read(bytes)?;
    let header = Header::read(&file);
    let mut drawing = read_sections(&file, &header, stem, options, selection)?;
    let left_out = drawing.skipped.iter().any(|skipped| skipped.why == layers::AUXILIARY);
    if drawing.curves.is_empty() && left_out {
        let options = DxfOptions { line_types: LineTypes::All, ..*options };
        drawing = read_sections(&file, &header, stem, &options, selection)?;
        let note = "All is drawn in line types for centre, hidden or phantom lines, which were read as edges.";
        drawing.notes.push(note.into());
    }
    Ok(drawing)
}

fn read_sections(
    file: &Sections,
    header: &Header,
    stem: &str,
    options: &DxfOptions,
    selection: &Selection,
) -> Result<Drawing, ImportError> {
    let format = match file.is_binary {
        true => format!("dxf ({}, binary)", header.version),
        false => format!("dxf ({})", header.version),
    };
    let mut drawing = Drawing { format, title: stem.into(), notes: file.notes.clone(), ..Drawing::default() };
    header.tell_unit(&mut drawing);
    let fills = Sketch::new(file, header, options, selection, &mut drawing).draw()?;
    fills::add(&fills, &mut drawing);
    Ok(drawing)
}
