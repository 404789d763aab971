//! DXF, the drawing exchange format of AutoCAD: text and binary, from before R12 to R2018. Curves stay what they are.
//!
//! - *Curves*: LINE, LWPOLYLINE and POLYLINE (bulges become arcs), ARC, CIRCLE, ELLIPSE, SPLINE, the outlines of SOLID, TRACE and
//!   3DFACE and flat meshes, and all of these in blocks, as INSERT draws them. A curve's name is its layer. POINT is a point.
//! - *Regions*: closed outlines are filled by the odd-even rule, so that an outline within an outline is a hole.
//! - *Hatches*: a drawing of nothing but HATCH entities is a picture of filled shapes, whose regions are named after their layers.
//!   Beside other curves a hatch repeats what they draw, rounded or as a polygon: there its boundary is no curve, and its layer
//!   names the region at a point well within it. Where that point is in a hole or outside, the hatch says nothing.
//! - *Left out and counted*: what is not in model space, not visible (layers that are off or frozen, and `Defpoints`), not parallel to the XY
//!   plane, and every entity that is no curve. Heights are dropped.
//! - *Unit*: `$INSUNITS`, else what `$MEASUREMENT` suggests, else none.
//!
//! The format: Autodesk, *DXF Reference*, with the arbitrary axis algorithm of its chapter "Object Coordinate Systems".

mod blocks;
mod entities;
mod hatch;
mod header;
mod pairs;
mod sections;

use super::ImportError;
use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve, FillRule, Seed, SeedKind, Shape};
use crate::geometry::{Point, Vec2};
use blocks::{Fill, Sketch};
use header::Header;
use sections::Sections;

/// Whether the bytes start as a DXF file does.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    pairs::sniff(bytes)
}

/// Reads a drawing; `stem` is its title.
///
/// # Errors
/// With the line and the entity: where the file is no DXF file or is cut short before the end of its entities, where a number of a
/// drawn entity is none or its data contradict each other, and where blocks unfold to more than a million curves.
pub fn read(bytes: &[u8], stem: &str) -> Result<Drawing, ImportError> {
    let mut file = Sections::read(bytes)?;
    let header = Header::read(&file);
    let format = match file.is_binary {
        true => format!("dxf ({}, binary)", header.version),
        false => format!("dxf ({})", header.version),
    };
    let mut drawing =
        Drawing { format, title: stem.into(), notes: std::mem::take(&mut file.notes), ..Drawing::default() };
    header.tell_unit(&mut drawing);
    let fills = Sketch::new(&file, &header, &mut drawing).draw()?;
    add_fills(fills, &mut drawing);
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
