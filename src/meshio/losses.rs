//! What formats cannot hold: phrases that several formats share, each reported if it is true of the mesh.

use super::{WriteOptions, groups};
use crate::mesh::Mesh;

/// The losses of a mesh that is about to be written.
pub struct Losses<'m> {
    /// The mesh.
    pub mesh: &'m Mesh,
    /// The options of writing.
    pub options: &'m WriteOptions,
    told: Vec<&'static str>,
}

impl<'m> Losses<'m> {
    /// No losses yet.
    pub fn new(mesh: &'m Mesh, options: &'m WriteOptions) -> Self {
        Self { mesh, options, told: Vec::new() }
    }

    /// The losses found.
    pub fn told(self) -> Vec<&'static str> {
        self.told
    }

    /// Adds a loss, if `is_so`.
    pub fn tell(&mut self, is_so: bool, what: &'static str) {
        if is_so {
            self.told.push(what);
        }
    }

    /// For formats with boundaries within the domain: those that [`WriteOptions::interior_lines`] leaves out.
    pub fn interior_lines(&mut self) {
        let inside = !self.options.interior_lines && groups::interior(self.mesh).any(|inside| inside);
        self.tell(inside, "boundaries within the domain: left out by --interior-lines off");
    }

    /// For formats that write lines on request.
    pub fn lines(&mut self, are_written: bool) {
        self.tell(!self.mesh.edges.is_empty() && !are_written, "boundaries: --lines on writes them");
    }

    /// For formats without coordinates in space.
    pub fn plane(&mut self) {
        self.tell(self.mesh.frame.is_some(), "the plane in space: coordinates are the plane's own");
    }

    /// For formats without named nodes.
    pub fn names_of_points(&mut self) {
        self.tell(!self.mesh.named_nodes.is_empty(), "names of points");
    }

    /// For formats of straight cells into which cells of order 2 are divided.
    pub fn order_2(&mut self) {
        self.tell(self.mesh.order() > 1, "order 2: each triangle is written as four straight ones");
    }

    /// For formats without a unit.
    pub fn unit(&mut self) {
        self.tell(self.mesh.unit.is_some(), "the unit: coordinates stay as they are");
    }

    /// For all formats but our own.
    pub fn links(&mut self) {
        let linked = !self.mesh.balls.is_empty() || self.mesh.edges.iter().any(|e| e.link.is_some());
        self.tell(linked, "links to curves and protecting balls");
    }
}
