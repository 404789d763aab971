//! The colours of a mesh's triangles.

use super::MeshColour;
use super::canvas::Colour;
use super::legend::Scale;
use super::palette::{QUALITY, SIZE, along, area_colour};
use super::used::rank;
use super::words::short;
use crate::geometry::{Point, turn_from};
use crate::ids::{NameId, TriangleId, VertexId};
use crate::mesh::Mesh;

/// The colour class of each triangle. There are few classes, so one path holds all triangles of a colour.
pub struct CellColours<'a> {
    mesh: &'a Mesh,
    colour: MeshColour,
    regions: &'a [NameId],
    /// Logarithms of the smallest and the largest root of an area.
    sizes: [f64; 2],
}

/// A colour painted over white.
fn on_white([r, g, b, a]: [u8; 4]) -> Colour {
    let over = |part: u8| ((u32::from(part) * u32::from(a) + 255 * (255 - u32::from(a)) + 127) / 255) as u8;
    Colour(over(r), over(g), over(b))
}

/// Number of shades of a colour scale. More cannot be distinguished.
const SHADES: usize = 60;

impl<'a> CellColours<'a> {
    /// Colours of the triangles of a mesh.
    pub fn new(mesh: &'a Mesh, colour: MeshColour, regions: &'a [NameId]) -> Self {
        let mut sizes = [f64::INFINITY, f64::NEG_INFINITY];
        if colour == MeshColour::Size {
            for size in mesh.triangles.iter().map(|t| log_size(corners(mesh, t))).filter(|s| s.is_finite()) {
                sizes = [sizes[0].min(size), sizes[1].max(size)];
            }
        }
        Self { mesh, colour, regions, sizes }
    }

    /// The colour class of a triangle.
    pub fn class(&self, t: TriangleId) -> usize {
        let abc = corners(self.mesh, &self.mesh.triangles[t]);
        let shade = |fraction: f64| ((fraction * SHADES as f64) as usize).min(SHADES - 1);
        match self.colour {
            MeshColour::Quality => shade(smallest_angle_deg(abc) / 60.0),
            MeshColour::Size => shade((log_size(abc) - self.sizes[0]) / (self.sizes[1] - self.sizes[0]).max(1e-12)),
            MeshColour::Region | MeshColour::Paint => {
                let region = self.mesh.triangle_regions.get(t).and_then(|&r| self.mesh.regions.get(r));
                region.map_or(0, |&name| rank(self.regions, name))
            }
        }
    }

    /// The colour of a class.
    pub fn paint(&self, class: usize) -> Colour {
        let middle = (class as f64 + 0.5) / SHADES as f64;
        match self.colour {
            MeshColour::Quality => along(&QUALITY, middle * 60.0),
            MeshColour::Size => along(&SIZE, middle),
            MeshColour::Region => area_colour(class),
            MeshColour::Paint => {
                let drawn = self.regions.get(class).and_then(|name| self.mesh.colours.get(name));
                drawn.map_or_else(|| area_colour(class), |drawn| on_white(drawn.0))
            }
        }
    }

    /// Whether dark lines are invisible on the colour. Scales are chosen so that they are visible; colours of a drawing
    /// are arbitrary.
    pub fn is_dark(&self, class: usize) -> bool {
        let Colour(r, g, b) = self.paint(class);
        // Luma by Rec. 709, from 0 to 255.
        self.colour == MeshColour::Paint && 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b) < 90.0
    }

    /// The scale of the legend: its histogram, and the text of its ends and ticks.
    pub fn scale(&self) -> Option<Scale> {
        let mut counts = vec![0; SHADES];
        for t in self.mesh.triangles.ids() {
            counts[self.class(t)] += 1;
        }
        let ticks = match self.colour {
            MeshColour::Quality => [0, 10, 20, 30, 40, 50, 60].map(|d| (f64::from(d) / 60.0, format!("{d}°"))).to_vec(),
            MeshColour::Size if self.sizes[0] < self.sizes[1] => [0.0, 0.25, 0.5, 0.75, 1.0]
                .map(|f| (f, short(libm::exp(self.sizes[0] + f * (self.sizes[1] - self.sizes[0])))))
                .to_vec(),
            MeshColour::Size if self.sizes[0].is_finite() => vec![(0.0, short(libm::exp(self.sizes[0])))],
            MeshColour::Size | MeshColour::Region | MeshColour::Paint => return None,
        };
        let title =
            if self.colour == MeshColour::Quality { "smallest angle of a triangle" } else { "√area of a triangle" };
        let shades = (0..SHADES).map(|class| self.paint(class)).collect();
        Some(Scale { title, counts, shades, ticks })
    }
}

/// The corners of a triangle.
pub fn corners(mesh: &Mesh, triangle: &[VertexId; 3]) -> [Point; 3] {
    triangle.map(|v| mesh.nodes.get(v).copied().unwrap_or(Point::new(f64::NAN, f64::NAN)))
}

/// The smallest angle; 0 for a triangle without angles.
pub fn smallest_angle_deg([a, b, c]: [Point; 3]) -> f64 {
    let angle = |p: Point, q: Point, r: Point| turn_from(q - p, r - p).abs().to_degrees();
    let least = angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b));
    if least.is_finite() { least } else { 0.0 }
}

fn log_size([a, b, c]: [Point; 3]) -> f64 {
    0.5 * libm::log(0.5 * (b - a).cross(c - a).abs())
}
