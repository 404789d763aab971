//! DXF, the drawing exchange format of AutoCAD: text and binary, from before R12 to R2018. Curves stay what they are.
//!
//! - *Curves*: LINE, LWPOLYLINE and POLYLINE (bulges become arcs), ARC, CIRCLE, ELLIPSE, SPLINE, the outlines of SOLID, TRACE and
//!   3DFACE and flat meshes, and all of these in blocks, as INSERT draws them. A curve's name is its layer. POINT is a point.
//! - *Regions*: closed outlines are filled by the odd-even rule, so that an outline within an outline is a hole.
//! - *Hatches* (and MPOLYGON): a drawing of nothing else is a picture of filled shapes, whose regions are named after their layers.
//!   Beside other curves, a boundary that repeats what they draw, rounded or as a polygon, is no curve: the layer of the hatch names the
//!   region in which it lies. A boundary that repeats nothing is an outline like the others of its layer. A hatch on a layer without
//!   other curves is a region of that name and of its own extent.
//! - *Left out and counted*: what is not in model space, not visible (layers that are off or frozen, and `Defpoints`), not on a layer that is
//!   asked for, not of a line type for edges, not parallel to the XY plane, and every entity that is no curve. Heights are dropped.
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
mod spline;

use super::{ImportError, Selection};
use crate::domain::Drawing;
use blocks::Sketch;
use header::Header;
use sections::Sections;

/// Whether the bytes start as a DXF file does.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    pairs::sniff(bytes)
}

/// Which line types are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineTypes {
    /// Not those that drafting standards use for what is no edge, as centre lines; where nothing else is drawn, all.
    #[default]
    Edges,
    All,
}

/// How a drawing is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DxfOptions {
    pub line_types: LineTypes,
    /// What leaves the XY plane is projected onto it; else it is left out.
    pub flatten_z: bool,
}

/// Reads a drawing, of the layers that `selection` asks for; `stem` is its title.
///
/// # Errors
/// With the line and the entity: where the file is no DXF file or is cut short before the end of its entities, where a number of a
/// drawn entity is none or its data contradict each other, and where blocks unfold to more than a million curves.
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

/// Hatches as shapes where nothing else is drawn, else as names of regions.
fn add_fills(fills: Vec<Fill>, drawing: &mut Drawing) {
    if fills.is_empty() {
        return;
    }
    if drawing.curves.is_empty() {
        drawing.fill = FillRule::Shapes;
        for Fill { name, outlines, entity } in fills {
            let shape = drawing.shapes.push(Shape::new(name, true, entity.clone()));
            let curves = outlines
                .into_iter()
                .map(|curve| DrawnCurve { shape: Some(shape), ..DrawnCurve::new(curve, name, entity.clone()) });
            drawing.curves.extend(curves);
        }
        return;
    }
    drawing.notes.push(
        "Hatches name the regions that they lie in; what is inside is said by the other outlines, which they repeat."
            .into(),
    );
    for Fill { name, outlines, entity } in fills {
        if let Some(at) = inner_point(&outlines) {
            drawing.seeds.push(Seed { at, kind: SeedKind::Region { name, max_area: None }, entity });
        }
    }
}

/// A point within closed outlines by the odd-even rule: the middle of the longest stretch inside, on a few lines across.
fn inner_point(outlines: &[Curve]) -> Option<Point> {
    /// Heights of the lines, shares of the whole that no drawing has its corners at.
    const LINES: [f64; 5] = [0.5037, 0.2963, 0.7193, 0.1043, 0.8989];
    let bounds = outlines.iter().map(Curve::bounds).reduce(|a, b| a.union(b))?;
    let mut best: Option<(f64, Point)> = None;
    for share in LINES {
        let y = bounds.y0 + share * bounds.height();
        let from = Point::new(bounds.x0, y);
        let places = |curve: &Curve| {
            curve
                .line_crossings(from, Vec2::new(1.0, 0.0), 0.0, 1.0)
                .into_iter()
                .map(|t| curve.point(t).x)
                .collect::<Vec<_>>()
        };
        let mut crossings: Vec<f64> = outlines.iter().flat_map(places).collect();
        crossings.sort_by(f64::total_cmp);
        // A line that passes through a joint may miss it, and cannot tell inside from outside.
        if crossings.len().is_multiple_of(2) {
            for stretch in crossings.chunks_exact(2) {
                let width = stretch[1] - stretch[0];
                if best.is_none_or(|(widest, _)| width > widest) {
                    best = Some((width, Point::new(0.5 * (stretch[0] + stretch[1]), y)));
                }
            }
        }
    }
    best.map(|(_, at)| at)
}
