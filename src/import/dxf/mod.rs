//! DXF, the drawing exchange format of AutoCAD: text and binary, from before R12 to R2018. Curves stay what they are.
//!
//! - *Curves*: LINE, LWPOLYLINE and POLYLINE (bulges become arcs), MLINE, ARC, CIRCLE, ELLIPSE, SPLINE, the outlines of
//!   SOLID, TRACE and 3DFACE and flat meshes, and all of these in blocks, as INSERT draws them. A curve's name is its
//!   layer. POINT is a point.
//! - *Regions*: closed outlines are filled by the odd-even rule, so that an outline within an outline is a hole.
//! - *Hatches* (and MPOLYGON): where nothing else is drawn, hatches are filled shapes, whose regions are named after
//!   their layers. Otherwise, a hatch whose boundary repeats other curves, rounded or as a polygon, adds no curve: its
//!   layer names the region in which it lies. A boundary that repeats no curve is an outline of its layer. A hatch on a
//!   layer without other curves is a region of its own, named after the layer.
//! - *Left out and counted*: entities outside of model space, on layers that are off or frozen, on `Defpoints`, on
//!   layers that are not selected, with line types that draw no edges, not parallel to the XY plane, and all that are
//!   no curves. Heights are dropped.
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

/// The facts of DXF.
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
    /// Not those that drafting standards use for lines that are no edges, as centre lines. Where nothing else is drawn,
    /// all.
    #[default]
    Edges,
    /// All that are drawn.
    All,
}

/// How DXF is read.
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

/// Reads the layers of a drawing that `selection` selects. `stem` is its title.
///
/// # Errors
/// With the line and the entity: where the file is not DXF or ends before its entities do, where a number of a drawn
/// entity is invalid or its data contradict each other, and where blocks expand to more than a million curves.
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
