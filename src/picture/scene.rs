//! The three pictures: of a drawing, of a domain, of a mesh.

use super::canvas::{Canvas, Paint};
use super::cells::{CellColours, corners, smallest_angle_deg};
use super::legend::Legend;
use super::palette::{ALARM, FAINT, INK, area_colour};
use super::sheet::Sheet;
use super::used::{distinct, entries, rank};
use super::words::{counted, short};
use super::{MeshColour, PictureOptions};
use crate::domain::{Domain, Drawing, SeedKind};
use crate::geometry::{Rect, bounds_of};
use crate::ids::{LayerId, PointId};
use crate::mesh::Mesh;
use std::collections::BTreeSet;

/// A drawing as found: curves by name, points, seeds.
pub fn picture_of_drawing(drawing: &Drawing, options: &PictureOptions) -> Canvas {
    let (ranks, lines) = if options.layers { by_layer(drawing) } else { by_name(drawing) };
    let kinds = lines.len();
    let legend = Legend { lines, ..Legend::default() }.with_markers(options);
    let caption = [counted(drawing.curves.len(), "curve"), counted(drawing.points.len(), "point")].join(", ");
    let bounds = drawing.bounds().unwrap_or(Rect::ZERO);
    let mut sheet = Sheet::new(bounds, options, &caption, &legend);
    sheet.curves(kinds, ranks.into_iter().zip(drawing.curves.iter().map(|c| &c.curve)));
    sheet.canvas.layer("points", true);
    for p in &drawing.points {
        sheet.dot(p.at, INK);
    }
    for c in &drawing.curves {
        for p in [c.curve.start(), c.curve.end()] {
            sheet.ring(p, 2.2, INK);
        }
    }
    for seed in &drawing.seeds {
        let what = match &seed.kind {
            SeedKind::Hole => "hole",
            SeedKind::Region { name, .. } => drawing.names.text(*name),
        };
        sheet.label(seed.at, what, FAINT, false);
    }
    sheet.finish(options, &legend)
}

/// The colour of each drawn curve by its name, as an index into the names in use.
fn by_name(drawing: &Drawing) -> (Vec<usize>, Vec<String>) {
    let used = distinct(drawing.curves.iter().map(|c| c.name));
    (drawing.curves.iter().map(|c| rank(&used, c.name)).collect(), entries(&used, &drawing.names))
}

/// The same by layer. Curves without a layer come first.
fn by_layer(drawing: &Drawing) -> (Vec<usize>, Vec<String>) {
    let used: Vec<Option<LayerId>> =
        drawing.curves.iter().map(|c| c.layer).collect::<BTreeSet<_>>().into_iter().collect();
    let name =
        |layer: &Option<LayerId>| layer.map_or("no layer", |layer| drawing.layers[layer].name.as_str()).to_owned();
    let ranks = drawing.curves.iter().map(|c| used.partition_point(|layer| *layer < c.layer)).collect();
    (ranks, used.iter().map(name).collect())
}

/// A domain: regions filled, curves by name, the points of P, acute corners with a ring and their angle.
pub fn picture_of_domain(domain: &Domain, options: &PictureOptions) -> Canvas {
    let used = distinct(domain.curves().iter().map(|c| c.name));
    let areas = distinct(domain.regions().iter().map(|r| r.name));
    let legend =
        Legend { lines: entries(&used, domain.names()), areas: entries(&areas, domain.names()), ..Legend::default() }
            .with_markers(options);
    let acute: Vec<PointId> = domain.points().ids().filter(|&p| domain.is_acute(p)).collect();
    let caption = [
        counted(domain.curves().len(), "curve"),
        counted(domain.points().len(), "point"),
        counted(domain.regions().len(), "region"),
        counted(acute.len(), "acute corner"),
    ];
    let mut sheet = Sheet::new(domain.bounds(), options, &caption.join(", "), &legend);
    sheet.canvas.layer("regions", true);
    for (r, region) in domain.regions().enumerate() {
        let outline = sheet.outline(domain, r);
        sheet.canvas.path(outline, Paint::fill(area_colour(rank(&areas, region.name)), 0.8));
    }
    sheet.curves(used.len(), domain.curves().iter().map(|c| (rank(&used, c.name), &c.curve)));
    sheet.canvas.layer("points", true);
    for &p in domain.points().iter() {
        sheet.dot(p, INK);
    }
    sheet.canvas.layer("corners", true);
    for &p in &acute {
        let at = domain.points()[p];
        sheet.ring(at, 6.5, ALARM);
        if let Some(corner) = domain.corner(p) {
            sheet.label(at, &format!("{}°", short(corner.angle_rad.to_degrees())), ALARM, false);
        }
    }
    sheet.finish(options, &legend)
}

/// A mesh: cells by `colour`, thin edges, thick boundary edges by name (along the exact curves if the domain is given),
/// dashed balls.
pub fn picture_of_mesh(mesh: &Mesh, domain: Option<&Domain>, colour: MeshColour, options: &PictureOptions) -> Canvas {
    let used = distinct(mesh.edges.iter().map(|e| e.name));
    let regions = distinct(mesh.regions.iter().copied());
    let mut legend = Legend { lines: entries(&used, &mesh.names), ..Legend::default() }.with_markers(options);
    let cells = CellColours::new(mesh, colour, &regions);
    match colour {
        MeshColour::Region => legend.areas = entries(&regions, &mesh.names),
        MeshColour::Paint if mesh.colours.is_empty() => legend.areas = entries(&regions, &mesh.names),
        // These are the colours of the drawing, which need no legend.
        MeshColour::Paint => {}
        MeshColour::Quality | MeshColour::Size => legend.scale = cells.scale(),
    }
    let worst = mesh.triangles.iter().map(|t| smallest_angle_deg(corners(mesh, t))).reduce(f64::min);
    let mut caption = vec![counted(mesh.triangles.len(), "triangle"), counted(mesh.nodes.len(), "vertex")];
    caption.extend(worst.map(|angle| format!("smallest angle {}°", short(angle))));
    let bounds = bounds_of(mesh.nodes.iter().copied()).unwrap_or(Rect::ZERO);
    let mut sheet = Sheet::new(bounds, options, &caption.join(", "), &legend);
    sheet.cells(mesh, &cells);
    sheet.edges(mesh, &cells);
    sheet.boundary(mesh, domain, &used);
    if options.balls {
        sheet.balls(mesh);
    }
    sheet.finish(options, &legend)
}
