//! A complex in the making: triangles on welded points, and the edges that must become segments.

use super::exact::Place;
use super::{FoundFacet, Surfaces};
use crate::geometry::space::times;
use crate::ids::NameId;
use std::collections::BTreeMap;

/// A complex in the making. Its coordinates are those of the file times a power of two, so that the largest is between
/// ½ and 1.
pub(super) struct Complex<'a> {
    /// What the file holds.
    pub found: &'a Surfaces,
    /// What brings a coordinate back to that of the file.
    pub unscale: f64,
    /// How far a point may lie from the plane of its facet, scaled as the points are.
    pub tolerance: f64,
    pub points: Vec<Place>,
    /// Whether a point belongs to anything.
    pub used: Vec<bool>,
    pub triangles: Vec<Triangle>,
    /// By group of triangles: whether it is a polygon whose points are not in one plane exactly.
    pub near: Vec<bool>,
    /// Edges that must be segments: those inside of facets, and dangling ones.
    pub required: BTreeMap<[u32; 2], Option<NameId>>,
    pub repairs: Vec<String>,
}

/// A triangle of the complex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub corners: [u32; 3],
    /// Its facet in the file.
    pub facet: u32,
    /// Its group: triangles of one facet to be.
    pub group: u32,
    /// How often it stands in the file with this orientation less how often with the other.
    pub winding: i32,
}

/// An edge of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Use {
    /// The ends, the lesser first.
    pub ends: [u32; 2],
    pub triangle: u32,
    /// The place of the corner opposite.
    pub opposite: u8,
    /// Whether the triangle has the edge from the lesser end to the greater.
    pub forward: bool,
}

/// The ends of an edge, the lesser first.
pub(super) fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Complex<'_> {
    /// A place in the coordinates of the file.
    pub fn place(&self, p: Place) -> Place {
        times(p, self.unscale)
    }

    /// The place of a point in the coordinates of the file.
    pub fn place_of(&self, point: u32) -> Place {
        self.place(self.points[point as usize])
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [Place; 3] {
        self.triangles[triangle as usize].corners.map(|p| self.points[p as usize])
    }

    /// The facet of the file that a triangle is of.
    pub fn facet(&self, triangle: u32) -> &FoundFacet {
        &self.found.facets[self.triangles[triangle as usize].facet as usize]
    }

    /// How messages refer to a triangle.
    pub fn entity(&self, triangle: u32) -> &str {
        &self.facet(triangle).entity
    }

    /// Every edge of every triangle, sorted: the uses of an edge stand side by side.
    pub fn uses(&self) -> Vec<Use> {
        let mut uses = Vec::with_capacity(3 * self.triangles.len());
        for (t, triangle) in self.triangles.iter().enumerate() {
            for i in 0..3 {
                let (a, b) = (triangle.corners[(i + 1) % 3], triangle.corners[(i + 2) % 3]);
                uses.push(Use { ends: edge(a, b), triangle: t as u32, opposite: i as u8, forward: a < b });
            }
        }
        uses.sort_unstable();
        uses
    }

    /// A new group of triangles; `near` where its points are not in one plane exactly.
    pub fn new_group(&mut self, near: bool) -> u32 {
        self.near.push(near);
        (self.near.len() - 1) as u32
    }
}

/// A place as messages write it.
pub(super) fn shown(at: Place) -> String {
    format!("({}, {}, {})", at[0], at[1], at[2])
}

/// "1 triangle", "3 triangles".
pub(super) fn counted(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}
