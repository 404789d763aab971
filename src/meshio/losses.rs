//! What formats do not hold: the phrases that several share, each told where it is true of the mesh.

use super::{WriteOptions, groups};
use crate::mesh::Mesh;

/// What is told of a mesh as it is about to be written.
pub struct Losses<'m> {
    pub mesh: &'m Mesh,
    pub options: &'m WriteOptions,
    told: Vec<&'static str>,
}

impl<'m> Losses<'m> {
    pub fn new(mesh: &'m Mesh, options: &'m WriteOptions) -> Self {
        Self { mesh, options, told: Vec::new() }
    }

    pub fn told(self) -> Vec<&'static str> {
        self.told
    }

    /// Tells a loss where it is one.
    pub fn tell(&mut self, is_so: bool, what: &'static str) {
        if is_so {
            self.told.push(what);
        }
    }

    /// Of every format that has boundaries within the domain: what [`WriteOptions::interior_lines`] leaves out.
    pub fn interior_lines(&mut self) {
        let inside = !self.options.interior_lines && groups::interior(self.mesh).any(|inside| inside);
        self.tell(inside, "boundaries within the domain: left out by --interior-lines off");
    }

    /// Of formats without lines unless asked for.
    pub fn lines(&mut self, are_written: bool) {
        self.tell(!self.mesh.edges.is_empty() && !are_written, "boundaries: --lines on writes them");
    }

    pub fn plane(&mut self) {
        self.tell(self.mesh.frame.is_some(), "the plane in space: coordinates are the plane's own");
    }

    pub fn names_of_points(&mut self) {
        self.tell(!self.mesh.named_nodes.is_empty(), "names of points");
    }

    /// Of formats of straight cells into which cells of order 2 are cut.
    pub fn order_2(&mut self) {
        self.tell(self.mesh.order() > 1, "order 2: each triangle is written as four straight ones");
    }

    pub fn unit(&mut self) {
        self.tell(self.mesh.unit.is_some(), "the unit: coordinates stay as they are");
    }

    /// Of every format but our own.
    pub fn links(&mut self) {
        let linked = !self.mesh.balls.is_empty() || self.mesh.edges.iter().any(|e| e.link.is_some());
        self.tell(linked, "links to curves and protecting balls");
    }
}
