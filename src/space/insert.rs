//! Insertion of vertices: look first (`cavity`), then act (`fill`).
//!
//! ```text
//!    ┌─────┬─────┐        ┌───────────┐        ┌───────────┐      The cavity: tetrahedra in whose orthogonal sphere p lies,
//!    │╲  ╱ │ ╲  ╱│        │           │        │╲    │   ╱ │      strictly. Each face f of its border becomes a tetrahedron
//!    │ ╲╱ p├──╲╱─┤   ─▶   │    p   f  │   ─▶   │  ╲  p  ╱  │      with p above it.
//!    │ ╱╲  │  ╱╲ │        │           │        │  ╱  │  ╲  │
//!    └─────┴─────┘        └───────────┘        └───────────┘
//! ```
//!
//! Strict signs suffice for validity: across a border face f the powers of p are Ψ < 0 ≤ Ψ′, their difference is linear,
//! zero on the plane of f and positive beyond it, so p lies strictly on the cavity's side of f. No new tetrahedron is
//! flat or inverted, however many points lie in a plane or on a sphere (`theory.md`, section 3).

use super::tetrahedra::{FACES, Face, Tetrahedra};
use crate::geometry::exact_space::{PlaneSide, SphereSide, in_sphere, orient};
use crate::ids::{Id, TetId, VertexId};

/// A tetrahedralization that grows by vertices.
pub(super) struct Kernel {
    pub net: Tetrahedra,
    /// By tetrahedron: twice the number of the cavity that last asked for it, and one more where it is in conflict.
    marks: Vec<u32>,
    cavities: u32,
    /// The tetrahedra of the cavity that was looked at last.
    cavity: Vec<TetId>,
    /// The faces of its border, as the cavity's tetrahedra have them.
    border: Vec<Face>,
    /// Where the next walk starts.
    last: TetId,
    /// Turns the order in which a walk tries faces: a walk through tetrahedra that are not Delaunay could go round.
    turn: u32,
}

/// Why a point makes no vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Refusal {
    /// A vertex has the same coordinates.
    Taken(VertexId),
    /// It lies outside of the hull.
    Outside,
    /// Its weight is so small beside the others' that it is in no orthogonal sphere.
    Hidden,
}

impl Kernel {
    /// One positive tetrahedron: all points to come lie strictly in it.
    pub fn new(far: [[f64; 3]; 4]) -> Self {
        let mut net = Tetrahedra::default();
        let corners = far.map(|p| net.add_vertex(p, 0.0));
        let last = net.add(corners);
        Self { net, marks: Vec::new(), cavities: 0, cavity: Vec::new(), border: Vec::new(), last, turn: 0 }
    }

    /// Lets the next walk start at a vertex.
    pub fn start_at(&mut self, v: VertexId) {
        self.last = self.net.at(v);
    }

    /// Inserts a point with a weight.
    pub fn insert(&mut self, p: [f64; 3], weight: f64) -> Result<VertexId, Refusal> {
        self.cavity(p, weight)?;
        Ok(self.fill(p, weight))
    }

    /// Finds the tetrahedra that must make room for a point, and changes nothing.
    pub fn cavity(&mut self, p: [f64; 3], weight: f64) -> Result<&[TetId], Refusal> {
        let start = self.locate(p)?;
        self.cavity.clear();
        self.border.clear();
        self.marks.resize(self.net.capacity(), 0);
        self.cavities += 1;
        if !self.conflicts(start, p, weight) {
            let same = self.net.corners(start).into_iter().find(|&v| self.net.points[v] == p);
            return Err(same.map_or(Refusal::Hidden, Refusal::Taken));
        }
        self.cavity.push(start);
        let mut next = 0;
        while let Some(&t) = self.cavity.get(next) {
            next += 1;
            for f in [0, 1, 2, 3].map(|i| Face::of(t, i)) {
                match self.net.twin(f).map(Face::tet) {
                    Some(beyond) if self.is_known(beyond) => {
                        if !self.is_in_cavity(beyond) {
                            self.border.push(f);
                        }
                    }
                    Some(beyond) if self.conflicts(beyond, p, weight) => self.cavity.push(beyond),
                    _ => self.border.push(f),
                }
            }
        }
        Ok(&self.cavity)
    }

    /// Fills the cavity that was looked at last with the star of the point.
    pub fn fill(&mut self, p: [f64; 3], weight: f64) -> VertexId {
        let v = self.net.add_vertex(p, weight);
        let border = std::mem::take(&mut self.border);
        for &f in &border {
            let [a, b, c] = self.net.triangle(f);
            let (outer, facet) = (self.net.twin(f), self.net.facet(f));
            let t = self.net.add([a, b, c, v]);
            self.net.link_to(Face::of(t, 3), outer);
            if let Some(facet) = facet {
                self.net.set_facet(Face::of(t, 3), facet);
            }
            // The way to the new tetrahedron, for `link_star`.
            self.net.set_twin(f, Face::of(t, 3));
        }
        self.marks.resize(self.net.capacity(), 0);
        border.iter().for_each(|&f| self.link_star(f));
        self.last = self.net.twin(border[0]).expect("the way to a new tetrahedron").tet();
        for i in 0..self.cavity.len() {
            self.net.remove(self.cavity[i]);
            // The mark of a dead tetrahedron would be that of the one that gets its id.
            self.marks[self.cavity[i].index()] = 0;
        }
        self.border = border;
        v
    }

    /// Links the new tetrahedron on a border face with the next ones around its three edges.
    fn link_star(&mut self, border: Face) {
        let new = self.net.twin(border).expect("the way to a new tetrahedron").tet();
        for i in 0..3 {
            if self.net.twin(Face::of(new, i)).is_some() {
                continue;
            }
            let corners = self.net.corners(new);
            let edge = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
            let beyond = self.next_around(border, edge);
            let far = self.net.corners(beyond)[..3].iter().position(|v| !edge.contains(v)).expect("a third corner");
            self.net.link(Face::of(new, i), Face::of(beyond, far));
        }
    }

    /// The new tetrahedron on the next border face around an edge, through the cavity.
    fn next_around(&self, border: Face, edge: [VertexId; 2]) -> TetId {
        let mut face = border;
        loop {
            // The other face of the tetrahedron at the edge lies opposite the corner of the face that is not on it.
            let t = face.tet();
            let corners = self.net.corners(t);
            let other =
                FACES[face.corner()].into_iter().find(|&i| !edge.contains(&corners[i])).expect("a third corner");
            let twin = self.net.twin(Face::of(t, other)).expect("a tetrahedron of the cavity or a new one");
            if !self.is_in_cavity(twin.tet()) {
                return twin.tet();
            }
            face = twin;
        }
    }

    fn is_known(&self, t: TetId) -> bool {
        self.marks[t.index()] / 2 == self.cavities
    }

    fn is_in_cavity(&self, t: TetId) -> bool {
        self.marks[t.index()] == 2 * self.cavities + 1
    }

    /// Whether a tetrahedron must make room, which is noted.
    fn conflicts(&mut self, t: TetId, p: [f64; 3], weight: f64) -> bool {
        let [a, b, c, d] = self.net.corners(t).map(|v| self.net.weighted(v));
        let conflicts = in_sphere(a, b, c, d, (p, weight)) == SphereSide::Inside;
        self.marks[t.index()] = 2 * self.cavities + u32::from(conflicts);
        conflicts
    }

    /// The tetrahedron that a point lies in, or on whose border.
    pub fn locate(&mut self, p: [f64; 3]) -> Result<TetId, Refusal> {
        let mut t = if self.net.is_alive(self.last) { self.last } else { self.net.at(VertexId(0)) };
        let mut from = None;
        loop {
            self.turn = self.turn.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let first = (self.turn >> 24) as usize;
            let out = (0..4).map(|k| Face::of(t, (first + k) % 4)).find(|&f| Some(f) != from && self.is_below(f, p));
            let Some(f) = out else { break };
            let twin = self.net.twin(f).ok_or(Refusal::Outside)?;
            (t, from) = (twin.tet(), Some(twin));
        }
        self.last = t;
        Ok(t)
    }

    fn is_below(&self, f: Face, p: [f64; 3]) -> bool {
        let [a, b, c] = self.net.triangle(f).map(|v| self.net.points[v]);
        orient(a, b, c, p) == PlaneSide::Below
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rng::Rng;

    const FAR: [[f64; 3]; 4] = [[-9.0, -9.0, -9.0], [60.0, -9.0, -9.0], [-9.0, 60.0, -9.0], [-9.0, -9.0, 60.0]];

    /// No vertex lies in an orthogonal sphere, by comparing all with all.
    fn assert_regular(net: &Tetrahedra) {
        assert_eq!(net.flaws(), [""; 0]);
        for t in net.tets() {
            let [a, b, c, d] = net.corners(t).map(|v| net.weighted(v));
            let inside = |v: &VertexId| in_sphere(a, b, c, d, net.weighted(*v)) == SphereSide::Inside;
            assert_eq!(net.points.ids().find(inside), None, "{t:?}");
        }
    }

    #[test]
    fn random_and_gridded_points_become_a_regular_tetrahedralization() {
        let mut rng = Rng::new(5);
        let random: Vec<[f64; 3]> = (0..300).map(|_| [0; 3].map(|_| rng.between(0.0, 1.0))).collect();
        let grid: Vec<[f64; 3]> = (0..216).map(|i| [i % 6, i / 6 % 6, i / 36].map(|k| f64::from(k) / 8.0)).collect();
        for points in [&random, &grid] {
            for scale in [0.0, 1e-6] {
                let mut kernel = Kernel::new(FAR);
                for &p in points {
                    let weight = scale * rng.between(0.0, 1e-3);
                    kernel.insert(p, weight).expect("a new vertex");
                }
                assert_regular(&kernel.net);
                assert_eq!(kernel.net.points.len(), points.len() + 4);
            }
        }
    }

    #[test]
    fn a_point_that_is_there_or_outside_is_refused() {
        let mut kernel = Kernel::new(FAR);
        let v = kernel.insert([0.5; 3], 0.0).unwrap();
        assert_eq!(kernel.insert([0.5; 3], 0.0), Err(Refusal::Taken(v)));
        assert_eq!(kernel.insert([90.0; 3], 0.0), Err(Refusal::Outside));
        assert_regular(&kernel.net);
    }

    #[test]
    fn flips_there_and_back_leave_valid_links() {
        let mut rng = Rng::new(11);
        let mut kernel = Kernel::new(FAR);
        for _ in 0..60 {
            kernel.insert([0; 3].map(|_| rng.between(0.0, 1.0)), 0.0).unwrap();
        }
        let mut flipped = 0;
        for t in kernel.net.tets().collect::<Vec<_>>() {
            let Some((f, g)) = (0..4).map(|i| Face::of(t, i)).find_map(|f| Some((f, kernel.net.twin(f)?))) else {
                continue;
            };
            let ([a, b, c], p, q) = (kernel.net.triangle(f), kernel.net.apex(f), kernel.net.apex(g));
            let place = |v| kernel.net.points[v];
            let pierced = [(a, b), (b, c), (c, a)]
                .iter()
                .all(|&(x, y)| orient(place(q), place(p), place(x), place(y)) == PlaneSide::Above);
            if !kernel.net.is_alive(t) || !pierced {
                continue;
            }
            let made = kernel.net.flip_23(f);
            assert_eq!(kernel.net.flaws(), [""; 0]);
            let ring: [_; 3] = kernel.net.around(made[0], q, p).try_into().unwrap();
            kernel.net.flip_32(ring, q, p);
            assert_eq!(kernel.net.flaws(), [""; 0]);
            flipped += 1;
        }
        assert!(flipped > 20, "{flipped}");
        assert_regular(&kernel.net);
    }
}
