//! Removal of a vertex.
//!
//! Edges at the vertex are flipped, ear by ear, until three are left; on the hull, until the rest of its star lies
//! outside the new hull. Then the vertex is removed, and flips (Lawson 1977) make the hole Delaunay. Every step is a
//! plane triangulation, whatever points are cocircular.

use super::insert::Kernel;
use super::triangulation::{GHOST, HalfEdge};
use crate::geometry::exact::{CircleSide, Orientation};
use crate::ids::{TriangleId, VertexId};

impl Kernel {
    /// Deletes a vertex of any degree, inside or on the hull. The triangulation is then that of the other points, and
    /// the id is unused.
    ///
    /// Subcurves on the edges of the vertex are lost. A new triangle has the region of a removed one next to it: where
    /// a lost subcurve separated two regions, the caller must label again. Returns `false`, and changes nothing, where
    /// the vertex was removed before or the other points lie on one line.
    pub fn remove(&mut self, v: VertexId) -> bool {
        if v == GHOST || self.carries_the_plane(v) {
            return false;
        }
        let mut diagonals = self.clip_ears(v);
        if self.topology.sides_from(v).any(|s| self.topology.target(s) == GHOST) {
            self.topology.move_to_infinity(v);
        } else {
            self.topology.merge_star(v);
        }
        self.make_delaunay(&mut diagonals);
        self.check_slowly();
        true
    }

    /// Whether no triangle would be left without `v`, or `v` has none: every edge of the link has a ghost across, and
    /// the link is straight.
    fn carries_the_plane(&self, v: VertexId) -> bool {
        let topology = &self.topology;
        let mut spokes = topology.sides_from(v).filter(|s| !topology.is_ghost(s.triangle())).peekable();
        let Some(&first) = spokes.peek() else { return true };
        let (a, b) = (self.point(topology.target(first)), self.point(topology.apex(first)));
        spokes.all(|s| {
            topology.is_ghost(topology.twin(s.next()).triangle())
                && self.in_sight(|sight| sight.orient(a, b, self.point(topology.apex(s)))) == Orientation::Collinear
        })
    }

    /// Flips edges of `v`, as long as any may be flipped, in time linear in the degree. Returns the new diagonals.
    ///
    /// The link is star-shaped around `v`. A neighbour w between the neighbours u and x is an ear where u w x turns
    /// left and v is not strictly inside u w x. Inside the hull a link of four or more vertices has an ear: any
    /// triangulation of the link has two, and v lies inside at most one of them.
    ///
    /// ```text
    ///         w                  w                  w        w is an ear: v w is flipped to u x.
    ///      .´ │ `.            .´   `.            .´   `.     y is the next ear: v y is flipped to x z.
    ///   x     │     u  ─▶  x───────────u  ─▶  x───────────u  v has degree 3: merge_star makes x z u of
    ///    ╲ `-.v.-´ ╱        ╲ `-.v.-´ ╱        ╲ `.      ╱   its three triangles.
    ///     ╲ ╱   ╲ ╱          ╲ ╱   ╲ ╱          ╲   `.  ╱
    ///      y─────z            y─────z            y─────z
    /// ```
    pub(super) fn clip_ears(&mut self, v: VertexId) -> Vec<HalfEdge> {
        let mut diagonals = Vec::new();
        let mut left = self.topology.sides_from(v).count();
        let inside = self.topology.sides_from(v).all(|s| self.topology.target(s) != GHOST);
        let Some(mut s) = self.topology.sides_from(v).next() else { return diagonals };
        let mut refused = 0;
        while refused < left && !(inside && left == 3) {
            if self.is_ear(v, s, inside) {
                let (t, u) = (s.triangle(), self.topology.twin(s).triangle());
                self.topology.flip(s);
                diagonals.push(t.side_of(2));
                left -= 1;
                refused = 0;
                // The other triangle is (x, v, u) now. Its half-edge 1 ends at u, which is tested again.
                s = u.side_of(1);
            } else {
                refused += 1;
                s = self.topology.twin(s.prev());
            }
        }
        diagonals
    }

    /// Whether the neighbour at which the half-edge `s` of `v` ends is an ear. `inside`: `v` lies inside the hull.
    fn is_ear(&self, v: VertexId, s: HalfEdge, inside: bool) -> bool {
        let topology = &self.topology;
        let (before, here, after) = (topology.apex(topology.twin(s)), topology.target(s), topology.apex(s));
        if [before, here, after].contains(&GHOST) {
            return false;
        }
        let [u, w, x] = [before, here, after].map(|v| self.point(v));
        self.in_sight(|sight| {
            sight.orient(u, w, x) == Orientation::CounterClockwise
                && (!inside || sight.orient(u, x, self.point(v)) != Orientation::Clockwise)
        })
    }

    /// Flips edges that are not locally Delaunay, beginning with those on the stack. With exact signs each flip lowers
    /// the lifted surface, so no edge is made twice (Lawson 1977).
    fn make_delaunay(&mut self, stack: &mut Vec<HalfEdge>) {
        while let Some(s) = stack.pop() {
            if !self.is_locally_delaunay(s) {
                let (t, u) = (s.triangle(), self.topology.twin(s).triangle());
                self.topology.flip(s);
                let outer = |t: TriangleId| [t.side_of(0), t.side_of(1)];
                stack.extend(outer(t).into_iter().chain(outer(u)));
            }
        }
    }

    /// Whether the apex across a half-edge does not lie inside the circle of its triangle; true for ghosts.
    pub(super) fn is_locally_delaunay(&self, s: HalfEdge) -> bool {
        let topology = &self.topology;
        let (corners, across) = (topology.corners(s.triangle()), topology.apex(topology.twin(s)));
        if corners.contains(&GHOST) || across == GHOST {
            return true;
        }
        let [a, b, c] = corners.map(|v| self.point(v));
        self.in_sight(|sight| sight.in_circle(a, b, c, self.point(across))) != CircleSide::Inside
    }
}
