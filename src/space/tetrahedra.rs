//! The storage of a tetrahedralization, and the two flips of it.
//!
//! ```text
//!            3                 Corners 0 1 2 3 are positive: 3 lies above the triangle 0 1 2. Face i lies opposite corner i; its
//!           ╱│╲                corners, in the order of `FACES[i]`, turn counter-clockwise as seen from corner i. A face is named
//!          ╱ │ ╲               by 4·tetrahedron + i, and its twin is the same triangle seen from the other side.
//!         ╱  │  ╲
//!        0 ──┼── 2             32 bytes a tetrahedron for corners and twins, 4 for the mark of the last cavity, 16 for the facets
//!         ╲  │  ╱              on its faces once there are some.
//!          ╲ │ ╱
//!            1
//! ```

use crate::geometry::exact_space::Weighted;
use crate::ids::{FacetId, Id, IdVec, TetId, VertexId};

/// No tetrahedron, no facet.
const NONE: u32 = u32::MAX;

/// The corners of face i, counter-clockwise as seen from corner i.
pub(super) const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// A face of a tetrahedron: 4·tetrahedron + the corner that it lies opposite.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Face(u32);

impl Face {
    /// The face of a tetrahedron opposite its corner `i`, in 0..4.
    #[inline]
    pub fn of(t: TetId, i: usize) -> Self {
        Self(4 * t.0 + i as u32)
    }

    /// The tetrahedron whose face it is.
    #[inline]
    pub fn tet(self) -> TetId {
        TetId(self.0 / 4)
    }

    /// The corner that it lies opposite, in 0..4.
    #[inline]
    pub fn corner(self) -> usize {
        (self.0 % 4) as usize
    }
}

/// Vertices and tetrahedra. Outside of the hull there is nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct Tetrahedra {
    pub points: IdVec<VertexId, [f64; 3]>,
    /// The weight of each vertex, a squared length.
    pub weights: IdVec<VertexId, f64>,
    corners: Vec<[VertexId; 4]>,
    twins: Vec<[u32; 4]>,
    /// The facet on each face; empty before the first facet.
    facets: Vec<[u32; 4]>,
    free: Vec<TetId>,
    /// Some tetrahedron at each vertex.
    at: IdVec<VertexId, TetId>,
}

impl Tetrahedra {
    /// A vertex at no tetrahedron yet.
    pub fn add_vertex(&mut self, point: [f64; 3], weight: f64) -> VertexId {
        self.weights.push(weight);
        self.at.push(TetId(NONE));
        self.points.push(point)
    }

    /// A vertex' place and weight.
    #[inline]
    pub fn weighted(&self, v: VertexId) -> Weighted {
        (self.points[v], self.weights[v])
    }

    /// A positive tetrahedron without neighbours.
    pub fn add(&mut self, corners: [VertexId; 4]) -> TetId {
        let t = match self.free.pop() {
            Some(t) => t,
            None => {
                self.corners.push([VertexId(NONE); 4]);
                self.twins.push([NONE; 4]);
                if !self.facets.is_empty() {
                    self.facets.push([NONE; 4]);
                }
                TetId::from_index(self.corners.len() - 1)
            }
        };
        self.corners[t.index()] = corners;
        self.twins[t.index()] = [NONE; 4];
        if let Some(facets) = self.facets.get_mut(t.index()) {
            *facets = [NONE; 4];
        }
        corners.into_iter().for_each(|v| self.at[v] = t);
        t
    }

    /// Frees a tetrahedron; whoever is next to it must be told.
    pub fn remove(&mut self, t: TetId) {
        self.corners[t.index()] = [VertexId(NONE); 4];
        self.free.push(t);
    }

    /// Makes two faces twins.
    #[inline]
    pub fn link(&mut self, f: Face, g: Face) {
        self.twins[f.tet().index()][f.corner()] = g.0;
        self.twins[g.tet().index()][g.corner()] = f.0;
    }

    /// Lets a face have this twin, or none, and tells the twin if there is one.
    pub fn link_to(&mut self, f: Face, twin: Option<Face>) {
        match twin {
            Some(g) => self.link(f, g),
            None => self.twins[f.tet().index()][f.corner()] = NONE,
        }
    }

    /// Writes the twin of a face without telling the twin.
    #[inline]
    pub fn set_twin(&mut self, f: Face, g: Face) {
        self.twins[f.tet().index()][f.corner()] = g.0;
    }

    /// The same triangle seen from the other side; `None` on the hull.
    #[inline]
    pub fn twin(&self, f: Face) -> Option<Face> {
        let twin = self.twins[f.tet().index()][f.corner()];
        (twin != NONE).then_some(Face(twin))
    }

    /// The corners of a tetrahedron.
    #[inline]
    pub fn corners(&self, t: TetId) -> [VertexId; 4] {
        self.corners[t.index()]
    }

    /// Whether the tetrahedron stands.
    #[inline]
    pub fn is_alive(&self, t: TetId) -> bool {
        self.corners[t.index()][0].0 != NONE
    }

    /// The corners of a face, counter-clockwise as seen from its tetrahedron.
    #[inline]
    pub fn triangle(&self, f: Face) -> [VertexId; 3] {
        let corners = &self.corners[f.tet().index()];
        FACES[f.corner()].map(|i| corners[i])
    }

    /// The corner that a face lies opposite.
    #[inline]
    pub fn apex(&self, f: Face) -> VertexId {
        self.corners[f.tet().index()][f.corner()]
    }

    /// Which corner of a tetrahedron a vertex is.
    pub fn corner_of(&self, t: TetId, v: VertexId) -> Option<usize> {
        self.corners(t).iter().position(|&c| c == v)
    }

    /// How many tetrahedra there is room for: all ids are below.
    pub fn capacity(&self) -> usize {
        self.corners.len()
    }

    /// The tetrahedra that stand.
    pub fn tets(&self) -> impl Iterator<Item = TetId> + '_ {
        (0..self.corners.len()).map(TetId::from_index).filter(|&t| self.is_alive(t))
    }

    /// The facet on a face.
    pub fn facet(&self, f: Face) -> Option<FacetId> {
        let facet = self.facets.get(f.tet().index()).map_or(NONE, |facets| facets[f.corner()]);
        (facet != NONE).then_some(FacetId(facet))
    }

    /// Lays a facet on a face and its twin.
    pub fn set_facet(&mut self, f: Face, facet: FacetId) {
        self.facets.resize(self.corners.len(), [NONE; 4]);
        for f in [Some(f), self.twin(f)].into_iter().flatten() {
            self.facets[f.tet().index()][f.corner()] = facet.0;
        }
    }

    /// Some tetrahedron at a vertex.
    pub fn at(&self, v: VertexId) -> TetId {
        self.at[v]
    }

    /// All tetrahedra at a vertex, found from face to face.
    pub fn star(&self, v: VertexId) -> Vec<TetId> {
        let mut star = vec![self.at(v)];
        let mut seen: std::collections::BTreeSet<TetId> = star.iter().copied().collect();
        let mut next = 0;
        while let Some(&t) = star.get(next) {
            next += 1;
            let around = (0..4).filter(|&i| self.corners(t)[i] != v).filter_map(|i| self.twin(Face::of(t, i)));
            for beyond in around.map(Face::tet) {
                if seen.insert(beyond) {
                    star.push(beyond);
                }
            }
        }
        star
    }

    /// A tetrahedron with the edge u v; `None` where there is no such edge.
    pub fn tet_at_edge(&self, u: VertexId, v: VertexId) -> Option<TetId> {
        self.star(u).into_iter().find(|&t| self.corner_of(t, v).is_some())
    }

    /// The tetrahedra around the edge u v, counter-clockwise about the direction from u to v, each with its other two
    /// corners: `(t, w, x)` is positive as u v w x, and x is w of the next. Starts at `t`; of an edge on the hull,
    /// only those from `t` onward.
    pub fn around(&self, t: TetId, u: VertexId, v: VertexId) -> Vec<(TetId, VertexId, VertexId)> {
        let mut ring = Vec::new();
        let mut here = t;
        loop {
            let (w, x) = self.beside(here, u, v);
            ring.push((here, w, x));
            // On to the tetrahedron beyond the face u v x, which lies opposite w.
            let across = Face::of(here, self.corner_of(here, w).expect("a corner"));
            match self.twin(across).map(Face::tet) {
                Some(next) if next != t => here = next,
                _ => return ring,
            }
        }
    }

    /// The corners w, x of a tetrahedron at the edge u v for which u v w x is positive.
    fn beside(&self, t: TetId, u: VertexId, v: VertexId) -> (VertexId, VertexId) {
        let c = self.corners(t);
        for [i, j, k, l] in EVEN {
            if c[i] == u && c[j] == v {
                return (c[k], c[l]);
            }
        }
        unreachable!("the tetrahedron has both ends of the edge")
    }

    /// The face of a tetrahedron opposite a corner given by its vertex.
    pub fn face_opposite(&self, t: TetId, v: VertexId) -> Face {
        Face::of(t, self.corner_of(t, v).expect("a corner"))
    }
}

/// The even permutations of four corners: those that keep a tetrahedron positive.
const EVEN: [[usize; 4]; 12] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 0, 3, 2],
    [1, 3, 2, 0],
    [1, 2, 0, 3],
    [2, 0, 1, 3],
    [2, 1, 3, 0],
    [2, 3, 0, 1],
    [3, 0, 2, 1],
    [3, 2, 1, 0],
    [3, 1, 0, 2],
];

impl Tetrahedra {
    /// Two tetrahedra on the triangle a b c become three around the edge p q.
    ///
    /// ```text
    ///         p                        p             p lies above a b c, q below; the edge p q runs through the triangle.
    ///       ╱ │ ╲                    ╱ ┆ ╲
    ///      ╱  │  ╲                  ╱  ┆  ╲          a b c p, b a c q   ─▶   q p a b, q p b c, q p c a
    ///     a ──┼── c      ─▶        a ──┆── c
    ///      ╲  b  ╱                  ╲  b  ╱
    ///       ╲ │ ╱                    ╲ ┆ ╱
    ///         q                        q
    /// ```
    pub fn flip_23(&mut self, f: Face) -> [TetId; 3] {
        let g = self.twin(f).expect("a face within the hull");
        let ([a, b, c], p, q) = (self.triangle(f), self.apex(f), self.apex(g));
        let (above, below) = (f.tet(), g.tet());
        let sides = [(a, b, c), (b, c, a), (c, a, b)].map(|(x, y, far)| {
            (x, y, self.outer(self.face_opposite(above, far)), self.outer(self.face_opposite(below, far)))
        });
        self.remove(below);
        self.remove(above);
        let made = sides.map(|(x, y, ..)| self.add([q, p, x, y]));
        for (k, (_, _, upper, lower)) in sides.into_iter().enumerate() {
            let t = made[k];
            self.join(Face::of(t, 0), upper);
            self.join(Face::of(t, 1), lower);
            // The face q p y of this one is the face q p x of the next.
            self.link(Face::of(t, 2), Face::of(made[(k + 1) % 3], 3));
        }
        made
    }

    /// The three tetrahedra around the edge u v become two on the triangle of the others: [`Self::flip_23`] backwards.
    pub fn flip_32(&mut self, ring: [(TetId, VertexId, VertexId); 3], u: VertexId, v: VertexId) -> [TetId; 2] {
        let sides = ring.map(|(t, ..)| (self.outer(self.face_opposite(t, u)), self.outer(self.face_opposite(t, v))));
        let [a, b, c] = ring.map(|(_, w, _)| w);
        ring.into_iter().for_each(|(t, ..)| self.remove(t));
        // The triangle a b c turns counter-clockwise about the direction from u to v: v lies above it.
        let (upper, lower) = (self.add([a, b, c, v]), self.add([b, a, c, u]));
        self.link(Face::of(upper, 3), Face::of(lower, 3));
        for ((at_v, at_u), (i, j)) in sides.into_iter().zip([(2, 2), (0, 1), (1, 0)]) {
            self.join(Face::of(upper, i), at_v);
            self.join(Face::of(lower, j), at_u);
        }
        [upper, lower]
    }

    /// What lies beyond a face: its twin, and the facet on it.
    fn outer(&self, f: Face) -> (Option<Face>, Option<FacetId>) {
        (self.twin(f), self.facet(f))
    }

    fn join(&mut self, f: Face, (twin, facet): (Option<Face>, Option<FacetId>)) {
        self.link_to(f, twin);
        if let Some(facet) = facet {
            self.set_facet(f, facet);
        }
    }
}

/// Tetrahedra as they were: what flips among them can be taken back to.
pub(super) struct Snapshot(Vec<Kept>);

/// A tetrahedron: its id, corners, twins and facets.
type Kept = (TetId, [VertexId; 4], [u32; 4], [u32; 4]);

impl Tetrahedra {
    /// Keeps some tetrahedra as they are now.
    pub fn snapshot(&self, tets: &[TetId]) -> Snapshot {
        let facets = |t: TetId| self.facets.get(t.index()).copied().unwrap_or([NONE; 4]);
        Snapshot(tets.iter().map(|&t| (t, self.corners(t), self.twins[t.index()], facets(t))).collect())
    }

    /// Puts back what `now` was flipped from.
    pub fn restore(&mut self, snapshot: &Snapshot, now: &[TetId]) {
        now.iter().for_each(|&t| self.remove(t));
        let old: std::collections::BTreeSet<TetId> = snapshot.0.iter().map(|(t, ..)| *t).collect();
        self.free.retain(|t| !old.contains(t));
        for &(t, corners, twins, facets) in &snapshot.0 {
            self.corners[t.index()] = corners;
            self.twins[t.index()] = twins;
            if let Some(place) = self.facets.get_mut(t.index()) {
                *place = facets;
            }
            corners.into_iter().for_each(|v| self.at[v] = t);
            for i in 0..4 {
                if let Some(beyond) = self.twin(Face::of(t, i)) {
                    self.set_twin(beyond, Face::of(t, i));
                }
            }
        }
    }

    /// What is wrong with the links, each in a sentence: for tests and `slow-checks`.
    pub fn flaws(&self) -> Vec<String> {
        let mut flaws = Vec::new();
        for t in self.tets() {
            let [a, b, c, d] = self.corners(t).map(|v| self.points[v]);
            if crate::geometry::exact_space::orient(a, b, c, d) != crate::geometry::exact_space::PlaneSide::Above {
                flaws.push(format!("tetrahedron {t:?} is not positive"));
            }
            for f in (0..4).map(|i| Face::of(t, i)) {
                let Some(g) = self.twin(f) else { continue };
                let same = |mut x: [VertexId; 3], mut y: [VertexId; 3]| {
                    x.sort_unstable();
                    y.sort_unstable();
                    x == y
                };
                if !self.is_alive(g.tet()) || self.twin(g) != Some(f) || !same(self.triangle(f), self.triangle(g)) {
                    flaws.push(format!("{f:?} and its twin {g:?} do not match"));
                } else if self.facet(f) != self.facet(g) {
                    flaws.push(format!("{f:?} and its twin {g:?} lie on different facets"));
                }
            }
        }
        flaws
    }
}
