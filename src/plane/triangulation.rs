//! Storage and topology of a triangulation of the whole plane: ids only, never a coordinate.
//!
//! Every triangle has three *sides*; side `3t + i` runs from corner i to corner i+1 of triangle t, counter-clockwise,
//! and knows its twin in the neighbour. The outside of the hull is covered by *ghost* triangles, which share the one
//! vertex [`GHOST`] at infinity, so that every side has a twin and the topology is that of a sphere.
//!
//! ```text
//!            c                 side s  = a→b in triangle t, its apex c
//!           / \                twin(s) = b→a in the neighbour, apex d
//!          / t \               next(s) = b→c, prev(s) = c→a
//!         a --s→ b             around a, counter-clockwise: a→d, a→b, a→c: the one after s is twin(prev(s))
//!          \   /
//!            d
//! ```
//!
//! 24 bytes a triangle for corners and twins, 16 for pieces and region, 4 a vertex: 84 bytes a vertex. Room for 7·10⁸
//! vertices.

use crate::ids::{Id, RegionId, SubcurveId, TriangleId, VertexId};

/// The vertex at infinity.
pub const GHOST: VertexId = VertexId(u32::MAX);

/// What stands for "no side", "no subcurve", "no region".
const NONE: u32 = u32::MAX;

/// A directed side of a triangle: `3·triangle + i`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct HalfEdge(pub u32);

impl HalfEdge {
    /// HalfEdge `i` of a triangle, from corner i to corner i+1; `i` in 0..3.
    #[inline]
    pub fn of(t: TriangleId, i: usize) -> Self {
        Self(3 * t.0 + i as u32)
    }

    /// The triangle that this side bounds; it lies on the left.
    #[inline]
    pub fn triangle(self) -> TriangleId {
        TriangleId(self.0 / 3)
    }

    /// The next side of the same triangle, counter-clockwise.
    #[inline]
    pub fn next(self) -> Self {
        let (t, i) = self.split();
        Self::of(t, after(i))
    }

    /// The side before this one in the same triangle.
    #[inline]
    pub fn prev(self) -> Self {
        let (t, i) = self.split();
        Self::of(t, before(i))
    }

    /// The triangle, and which of its sides this is, in 0..3.
    #[inline]
    pub(super) fn split(self) -> (TriangleId, usize) {
        (TriangleId(self.0 / 3), (self.0 % 3) as usize)
    }
}

/// The place after `i` of 0, 1, 2.
#[inline]
pub(super) fn after(i: usize) -> usize {
    if i == 2 { 0 } else { i + 1 }
}

/// The place before `i` of 0, 1, 2.
#[inline]
pub(super) fn before(i: usize) -> usize {
    if i == 0 { 2 } else { i - 1 }
}

impl TriangleId {
    /// HalfEdge `i` of this triangle, from corner i to corner i+1; `i` in 0..3.
    #[inline]
    pub fn side_of(self, i: usize) -> HalfEdge {
        HalfEdge::of(self, i)
    }
}

/// Corners of a triangle, counter-clockwise, and the twins of its three sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    pub corners: [VertexId; 3],
    pub twins: [HalfEdge; 3],
}

/// A record on the free list.
const DEAD: Record = Record { corners: [GHOST; 3], twins: [HalfEdge(NONE); 3] };

/// A side of a cavity as its filling needs it: its two ends and the side on the far side of it.
struct Rim {
    a: VertexId,
    b: VertexId,
    outer: HalfEdge,
}

/// Triangles and their neighbours, bare of labels: all that bulk insertion touches.
#[derive(Default)]
pub(super) struct Net {
    records: Vec<Record>,
    free: Vec<TriangleId>,
    /// The border and the new triangles while a cavity is filled.
    rim: Vec<Rim>,
    ids: Vec<TriangleId>,
}

impl Net {
    /// The sphere made of the counter-clockwise triangle `a b c` and its three ghosts, with room for `vertices`
    /// vertices.
    pub fn of_triangle([a, b, c]: [VertexId; 3], vertices: usize) -> Self {
        let side = |t, i| HalfEdge::of(TriangleId(t), i);
        let mut records = Vec::with_capacity(2 * vertices);
        records.extend([
            Record { corners: [a, b, c], twins: [side(1, 0), side(2, 0), side(3, 0)] },
            Record { corners: [b, a, GHOST], twins: [side(0, 0), side(3, 2), side(2, 1)] },
            Record { corners: [c, b, GHOST], twins: [side(0, 1), side(1, 2), side(3, 1)] },
            Record { corners: [a, c, GHOST], twins: [side(0, 2), side(2, 2), side(1, 1)] },
        ]);
        Self { records, ..Self::default() }
    }

    #[inline]
    pub fn record(&self, t: TriangleId) -> &Record {
        &self.records[t.index()]
    }

    pub fn len(&self) -> usize {
        self.records.len()
    }

    pub fn twin(&self, s: HalfEdge) -> HalfEdge {
        let (t, i) = s.split();
        self.record(t).twins[i]
    }

    pub fn is_alive(&self, t: TriangleId) -> bool {
        self.records.get(t.index()).is_some_and(|r| r.twins[0] != HalfEdge(NONE))
    }

    /// Makes `s` and `outer` twins.
    #[inline]
    fn join(&mut self, s: HalfEdge, outer: HalfEdge) {
        for (s, twin) in [(s, outer), (outer, s)] {
            let (t, i) = s.split();
            self.records[t.index()].twins[i] = twin;
        }
    }

    fn take(&mut self) -> TriangleId {
        self.free.pop().unwrap_or_else(|| {
            self.records.push(DEAD);
            TriangleId::from_index(self.records.len() - 1)
        })
    }

    fn release(&mut self, t: TriangleId) {
        self.records[t.index()] = DEAD;
        self.free.push(t);
    }

    /// Replaces a cavity (a disk of triangles without inner vertices) by the star of `apex`. The triangle on
    /// `border[i]` becomes `(origin, target, apex)`; it takes the id of `triangles[i]`, and the last two take the ids
    /// returned.
    pub fn star(&mut self, apex: VertexId, triangles: &[TriangleId], border: &[HalfEdge]) -> [TriangleId; 2] {
        assert_eq!(border.len(), triangles.len() + 2, "a cavity is a disk without inner vertices");
        let last = [self.take(), self.take()];
        let (mut rim, mut ids) = (std::mem::take(&mut self.rim), std::mem::take(&mut self.ids));
        rim.clear();
        rim.extend(border.iter().map(|s| {
            let (t, i) = s.split();
            let Record { corners, twins } = self.record(t);
            Rim { a: corners[i], b: corners[after(i)], outer: twins[i] }
        }));
        ids.clear();
        ids.extend_from_slice(triangles);
        ids.extend(last);
        let mut previous = last[1];
        for (k, (&Rim { a, b, outer }, &here)) in rim.iter().zip(&ids).enumerate() {
            let next = *ids.get(k + 1).unwrap_or(&ids[0]);
            let twins = [outer, HalfEdge::of(next, 2), HalfEdge::of(previous, 1)];
            self.records[here.index()] = Record { corners: [a, b, apex], twins };
            let (across, i) = outer.split();
            self.records[across.index()].twins[i] = HalfEdge::of(here, 0);
            previous = here;
        }
        (self.rim, self.ids) = (rim, ids);
        last
    }

    /// Gives every corner the name that `names` has for it.
    pub fn rename(&mut self, names: &[u32]) {
        for corner in self.records.iter_mut().flat_map(|r| &mut r.corners) {
            if *corner != GHOST {
                *corner = VertexId(names[corner.index()]);
            }
        }
    }
}

/// A triangulation of the sphere that the plane becomes with a vertex at infinity, with labels: the subcurve of a curve
/// that lies on a side, the region that a triangle belongs to.
pub struct Triangulation {
    net: Net,
    /// The subcurve on each side of a triangle, the same on both twins; NONE for no subcurve.
    pieces: Vec<[u32; 3]>,
    /// NONE for no region.
    regions: Vec<u32>,
    /// An outgoing side of each vertex, that of [`GHOST`] in front: see [`place_of`]. NONE for a dead vertex.
    anchors: Vec<HalfEdge>,
    /// Subcurve and region of each border side while a cavity is filled.
    labels: Vec<(u32, u32)>,
}

/// Place of a vertex among the anchors: the ghost's number, the largest, wraps around to 0.
#[inline]
fn place_of(v: VertexId) -> usize {
    v.0.wrapping_add(1) as usize
}

fn label<I: Id>(value: u32) -> Option<I> {
    (value != NONE).then(|| I::from_index(value as usize))
}

impl Triangulation {
    /// A triangulation without pieces and regions, over vertices `0..vertices`.
    pub(super) fn unlabelled(net: Net, vertices: usize) -> Self {
        let (pieces, regions) = (vec![[NONE; 3]; net.len()], vec![NONE; net.len()]);
        let mut anchors = vec![HalfEdge(NONE); vertices + 1];
        for (t, record) in net.records.iter().enumerate() {
            for (i, &corner) in record.corners.iter().enumerate() {
                anchors[place_of(corner)] = HalfEdge::of(TriangleId::from_index(t), i);
            }
        }
        Self { net, pieces, regions, anchors, labels: Vec::new() }
    }

    pub(super) fn net(&self) -> &Net {
        &self.net
    }

    /// The corners of a triangle, counter-clockwise; one is [`GHOST`] in a ghost triangle.
    #[inline]
    pub fn corners(&self, t: TriangleId) -> [VertexId; 3] {
        self.net.record(t).corners
    }

    /// The vertex at which a side starts; the triangle lies on the left of the side.
    #[inline]
    pub fn origin(&self, s: HalfEdge) -> VertexId {
        let (t, i) = s.split();
        self.corners(t)[i]
    }

    /// The vertex at which a side ends.
    #[inline]
    pub fn target(&self, s: HalfEdge) -> VertexId {
        self.origin(s.next())
    }

    /// The corner opposite a side of its triangle.
    #[inline]
    pub fn apex(&self, s: HalfEdge) -> VertexId {
        self.origin(s.prev())
    }

    /// The same side, the other way round, in the neighbouring triangle.
    #[inline]
    pub fn twin(&self, s: HalfEdge) -> HalfEdge {
        self.net.twin(s)
    }

    /// Whether an id belongs to a triangle now, finite or ghost; ids of lost triangles are used again.
    #[inline]
    pub fn is_alive(&self, t: TriangleId) -> bool {
        self.net.is_alive(t)
    }

    /// Whether a triangle has the vertex at infinity.
    #[inline]
    pub fn is_ghost(&self, t: TriangleId) -> bool {
        self.corners(t).contains(&GHOST)
    }

    /// The finite triangles in ascending order of their ids.
    pub fn triangles(&self) -> impl Iterator<Item = TriangleId> {
        (0..self.net.len()).map(TriangleId::from_index).filter(|&t| self.is_alive(t) && !self.is_ghost(t))
    }

    /// Every triangle's id is below this.
    pub fn triangle_capacity(&self) -> usize {
        self.net.len()
    }

    /// The outgoing sides of a vertex, counter-clockwise, those of ghost triangles included; none of a dead vertex.
    /// Those of [`GHOST`] lead to the hull's vertices, clockwise as seen from within.
    pub fn sides_from(&self, v: VertexId) -> impl Iterator<Item = HalfEdge> {
        let first = self.anchors.get(place_of(v)).copied().filter(|&s| s != HalfEdge(NONE));
        std::iter::successors(first, move |s| Some(self.twin(s.prev())).filter(|&s| Some(s) != first))
    }

    /// The side from `a` to `b`, if they are joined. Takes time in proportion to the number of neighbours of `a`.
    pub fn side_between(&self, a: VertexId, b: VertexId) -> Option<HalfEdge> {
        self.sides_from(a).find(|&s| self.target(s) == b)
    }

    /// The subcurve of a curve that lies on a side.
    #[inline]
    pub fn subcurve(&self, s: HalfEdge) -> Option<SubcurveId> {
        label(self.piece_label(s))
    }

    /// Lays a subcurve on a side and its twin, or takes it away.
    pub fn set_piece(&mut self, s: HalfEdge, subcurve: Option<SubcurveId>) {
        for s in [s, self.twin(s)] {
            self.set_piece_label(s, subcurve.map_or(NONE, |p| p.0));
        }
    }

    /// The region of a triangle; `None` outside all regions, and before one was given.
    #[inline]
    pub fn region(&self, t: TriangleId) -> Option<RegionId> {
        label(self.regions[t.index()])
    }

    /// Gives a triangle a region, or takes it away.
    pub fn set_region(&mut self, t: TriangleId, region: Option<RegionId>) {
        self.regions[t.index()] = region.map_or(NONE, |r| r.0);
    }

    /// Replaces side a→b of the quadrilateral `a d b c` by the other diagonal.
    ///
    /// The triangle of `s` becomes `(d, b, c)`, that of its twin `(c, a, d)`: the new diagonal is side 2 of both. The
    /// four outer sides keep their pieces, a subcurve on the old diagonal is lost, and the two ids keep their regions.
    /// That the quadrilateral is convex is the caller's to know.
    pub fn flip(&mut self, s: HalfEdge) {
        let n = self.twin(s);
        let (t, u) = (s.triangle(), n.triangle());
        let (a, b, c, d) = (self.origin(s), self.origin(n), self.apex(s), self.apex(n));
        let outer = [n.prev(), s.next(), s.prev(), n.next()].map(|side| (self.twin(side), self.piece_label(side)));
        let fresh = [HalfEdge::of(t, 0), HalfEdge::of(t, 1), HalfEdge::of(u, 0), HalfEdge::of(u, 1)];
        self.net.records[t.index()].corners = [d, b, c];
        self.net.records[u.index()].corners = [c, a, d];
        for (side, (twin, subcurve)) in fresh.into_iter().zip(outer) {
            self.net.join(side, twin);
            self.set_piece_label(side, subcurve);
        }
        self.net.join(HalfEdge::of(t, 2), HalfEdge::of(u, 2));
        self.pieces[t.index()][2] = NONE;
        self.pieces[u.index()][2] = NONE;
        fresh.into_iter().for_each(|s| self.anchor(s));
    }

    /// Remembers a side for the vertex that it starts from.
    fn anchor(&mut self, s: HalfEdge) {
        let v = self.origin(s);
        self.anchors[place_of(v)] = s;
    }

    fn piece_label(&self, s: HalfEdge) -> u32 {
        let (t, i) = s.split();
        self.pieces[t.index()][i]
    }

    fn set_piece_label(&mut self, s: HalfEdge, subcurve: u32) {
        let (t, i) = s.split();
        self.pieces[t.index()][i] = subcurve;
    }

    /// Replaces a cavity by the star of a new vertex, the next after all there are. Border sides keep their pieces;
    /// each new triangle has the region of the cavity's triangle on its border side. The new triangles are those of the
    /// cavity, and the two returned.
    pub(super) fn star(&mut self, apex: VertexId, triangles: &[TriangleId], border: &[HalfEdge]) -> [TriangleId; 2] {
        let mut labels = std::mem::take(&mut self.labels);
        labels.clear();
        labels.extend(border.iter().map(|&s| (self.piece_label(s), self.regions[s.triangle().index()])));
        let last = self.net.star(apex, triangles, border);
        self.pieces.resize(self.net.len(), [NONE; 3]);
        self.regions.resize(self.net.len(), NONE);
        for (&t, &(subcurve, region)) in triangles.iter().chain(&last).zip(&labels) {
            self.pieces[t.index()] = [subcurve, NONE, NONE];
            self.regions[t.index()] = region;
            self.anchor(HalfEdge::of(t, 0));
        }
        self.anchors.push(HalfEdge::of(triangles[0], 2));
        self.labels = labels;
        last
    }

    /// Replaces the three triangles around a vertex of degree 3 by one, which keeps the id and region of the first.
    pub(super) fn merge_star(&mut self, v: VertexId) {
        let spokes: Vec<HalfEdge> = self.sides_from(v).collect();
        assert_eq!(spokes.len(), 3, "only a vertex of degree 3 leaves a triangle");
        let t = spokes[0].triangle();
        let rim: Vec<_> = spokes.iter().map(|s| s.next()).collect();
        let outer = [0, 1, 2].map(|i| (self.origin(rim[i]), self.twin(rim[i]), self.piece_label(rim[i])));
        for (i, (corner, twin, subcurve)) in outer.into_iter().enumerate() {
            self.net.records[t.index()].corners[i] = corner;
            self.net.join(HalfEdge::of(t, i), twin);
            self.pieces[t.index()][i] = subcurve;
            self.anchors[place_of(corner)] = HalfEdge::of(t, i);
        }
        self.release(spokes[1].triangle());
        self.release(spokes[2].triangle());
        self.anchors[place_of(v)] = HalfEdge(NONE);
    }

    /// Moves a vertex of the hull to infinity: the finite triangles around it become ghosts without region, its two
    /// ghosts vanish.
    pub(super) fn move_to_infinity(&mut self, v: VertexId) {
        let spokes: Vec<HalfEdge> = self.sides_from(v).collect();
        let ghost = spokes.iter().position(|&s| self.target(s) == GHOST).expect("a vertex of the hull has a ghost");
        // Counter-clockwise around v: v→r₁, …, v→rₘ (before), v→GHOST (after). The ghosts on either side of v→GHOST
        // collapse.
        let (before, after) = (spokes[(ghost + spokes.len() - 1) % spokes.len()], spokes[ghost]);
        for (inner, outer) in [(before, before.next()), (after.prev(), after.next())] {
            let (inner, subcurve) = (self.twin(inner), self.piece_label(outer));
            self.net.join(inner, self.twin(outer));
            self.set_piece_label(inner, subcurve);
        }
        for &s in spokes.iter().filter(|&&s| s != before && s != after) {
            let (t, i) = s.split();
            self.net.records[t.index()].corners[i] = GHOST;
            self.regions[t.index()] = NONE;
            [s, s.next(), s.prev()].into_iter().for_each(|s| self.anchor(s));
        }
        self.release(before.triangle());
        self.release(after.triangle());
        self.anchors[place_of(v)] = HalfEdge(NONE);
    }

    fn release(&mut self, t: TriangleId) {
        self.net.release(t);
        self.pieces[t.index()] = [NONE; 3];
        self.regions[t.index()] = NONE;
    }

    /// What is wrong with the structure, with culprits: sides and twins that do not match, pieces that differ on twins,
    /// stars that do not close, an Euler number other than a sphere's. Empty when all is well. Takes linear time.
    pub fn flaws(&self) -> Vec<String> {
        let mut flaws = self.side_flaws();
        // A walk around a vertex ends only where twins are sound.
        if flaws.is_empty() {
            flaws = self.star_flaws();
        }
        flaws
    }

    fn side_flaws(&self) -> Vec<String> {
        let mut flaws = Vec::new();
        let dead = (0..self.net.len()).filter(|&t| !self.is_alive(TriangleId::from_index(t))).count();
        if dead != self.net.free.len() {
            flaws.push(format!("{dead} dead triangles, but {} on the free list", self.net.free.len()));
        }
        if self.pieces.len() != self.net.len() || self.regions.len() != self.net.len() {
            flaws.push(format!(
                "{} triangles, {} subcurve labels, {} regions",
                self.net.len(),
                self.pieces.len(),
                self.regions.len()
            ));
            return flaws;
        }
        for t in (0..self.net.len()).map(TriangleId::from_index).filter(|&t| self.is_alive(t)) {
            let [a, b, c] = self.corners(t);
            if a == b || b == c || c == a {
                flaws.push(format!("triangle {} has a corner twice: {a:?} {b:?} {c:?}", t.0));
            }
            if let Some(v) = [a, b, c].into_iter().find(|&v| place_of(v) >= self.anchors.len()) {
                flaws.push(format!("triangle {} has the unknown corner {}", t.0, v.0));
            }
            flaws.extend((0..3).filter_map(|i| self.side_flaw(HalfEdge::of(t, i))));
        }
        flaws
    }

    fn side_flaw(&self, s: HalfEdge) -> Option<String> {
        let n = self.twin(s);
        if !self.is_alive(n.triangle()) {
            return Some(format!("side {} has its twin {} in a dead triangle", s.0, n.0));
        }
        if self.twin(n) != s {
            return Some(format!("side {} has twin {}, whose twin is {}", s.0, n.0, self.twin(n).0));
        }
        if self.origin(s) != self.target(n) {
            return Some(format!("side {} starts at {}, its twin ends at {}", s.0, self.origin(s).0, self.target(n).0));
        }
        let (here, there) = (self.subcurve(s), self.subcurve(n));
        (here != there).then(|| format!("side {} has {here:?}, its twin {} has {there:?}", s.0, n.0))
    }

    fn star_flaws(&self) -> Vec<String> {
        let mut flaws = Vec::new();
        let mut degree = vec![0usize; self.anchors.len()];
        let alive = || (0..self.net.len()).map(TriangleId::from_index).filter(|&t| self.is_alive(t));
        alive().flat_map(|t| self.corners(t)).for_each(|v| degree[place_of(v)] += 1);
        for (place, &degree) in degree.iter().enumerate() {
            let v = VertexId((place as u32).wrapping_sub(1));
            if degree > 0 && self.anchors[place] == HalfEdge(NONE) {
                flaws.push(format!("vertex {} is a corner of {degree} triangles but has no side", v.0));
                continue;
            }
            let s = self.anchors[place];
            if degree > 0 && (!self.is_alive(s.triangle()) || self.origin(s) != v) {
                flaws.push(format!("vertex {} has side {}, which does not start there", v.0, s.0));
                continue;
            }
            let star = if degree > 0 { self.sides_from(v).count() } else { 0 };
            if star != degree {
                flaws.push(format!("vertex {} is a corner of {degree} triangles, {star} of them in its star", v.0));
            }
        }
        let vertices = degree.iter().filter(|&&d| d > 0).count();
        let triangles = alive().count();
        if triangles + 4 != 2 * vertices {
            flaws.push(format!("{vertices} vertices (with infinity), {triangles} triangles: not a sphere"));
        }
        flaws
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle with a vertex in its middle: three finite triangles, three ghosts.
    fn wheel() -> Triangulation {
        let mut net = Net::of_triangle([0, 1, 2].map(VertexId), 4);
        net.star(VertexId(3), &[TriangleId(0)], &[0, 1, 2].map(HalfEdge));
        Triangulation::unlabelled(net, 4)
    }

    fn assert_flaw(spoil: impl FnOnce(&mut Triangulation), words: &str) {
        let mut t = wheel();
        assert_eq!(t.flaws(), Vec::<String>::new());
        spoil(&mut t);
        let flaws = t.flaws();
        assert!(flaws.iter().any(|flaw| flaw.contains(words)), "{words:?} is not among {flaws:?}");
    }

    #[test]
    fn planted_damage_is_named() {
        assert_flaw(|t| t.net.records[0].twins[1] = HalfEdge(0), "whose twin is");
        assert_flaw(|t| t.net.records[2].corners[0] = VertexId(1), "has a corner twice");
        assert_flaw(|t| t.net.records[2].corners[0] = VertexId(17), "unknown corner 17");
        assert_flaw(|t| t.net.records[1].corners.swap(0, 1), "its twin ends at");
        assert_flaw(|t| t.net.records[3] = DEAD, "in a dead triangle");
        assert_flaw(|t| t.net.records[3] = DEAD, "1 dead triangles, but 0 on the free list");
        assert_flaw(|t| t.pieces[0][0] = 5, "SubcurveId(5)");
        assert_flaw(|t| t.regions.truncate(2), "2 regions");
        assert_flaw(|t| t.anchors[2] = HalfEdge(NONE), "vertex 1 is a corner of 4 triangles but has no side");
        assert_flaw(|t| t.anchors[2] = t.anchors[3], "vertex 1 has side");
        assert_flaw(|t| t.anchors[4] = HalfEdge(NONE - 2), "vertex 3 has side");
    }

    #[test]
    fn two_spheres_or_a_pinched_star_are_no_triangulation() {
        // The same wheel once more, over the same vertices: every side is sound, no star is whole.
        let twice = |t: &mut Triangulation| {
            let shift = t.net.len() as u32;
            let copy: Vec<Record> = t.net.records.clone();
            t.net
                .records
                .extend(copy.into_iter().map(|r| Record { twins: r.twins.map(|s| HalfEdge(s.0 + 3 * shift)), ..r }));
            t.pieces.resize(t.net.len(), [NONE; 3]);
            t.regions.resize(t.net.len(), NONE);
        };
        assert_flaw(twice, "6 triangles, 3 of them in its star");
        assert_flaw(twice, "not a sphere");
    }

    #[test]
    fn sides_turn_counter_clockwise_and_know_their_ends() {
        let t = wheel();
        let around: Vec<u32> = t.sides_from(VertexId(3)).map(|s| t.target(s).0).collect();
        let first = around.iter().position(|&v| v == 0).unwrap();
        assert_eq!([0, 1, 2].map(|i| around[(first + i) % 3]), [0, 1, 2]);
        let hull: Vec<u32> = t.sides_from(GHOST).map(|s| t.target(s).0).collect();
        let first = hull.iter().position(|&v| v == 0).unwrap();
        assert_eq!([0, 1, 2].map(|i| hull[(first + i) % 3]), [0, 2, 1], "clockwise as seen from within");
        for s in (0..t.triangle_capacity()).flat_map(|k| (0..3).map(move |i| TriangleId::from_index(k).side_of(i))) {
            assert_eq!(s.next().next(), s.prev());
            assert_eq!(s.next().prev(), s);
            assert_eq!((t.origin(s), t.target(s)), (t.target(t.twin(s)), t.origin(t.twin(s))));
            assert_eq!(t.side_between(t.origin(s), t.target(s)), Some(s));
        }
        assert_eq!(t.side_between(VertexId(3), GHOST), None);
        assert_eq!(t.triangles().count(), 3);
        assert_eq!(t.sides_from(VertexId(99)).count(), 0);
    }

    #[test]
    fn a_flip_carries_the_labels_of_the_outer_sides() {
        let mut t = wheel();
        let s = t.side_between(VertexId(3), VertexId(1)).unwrap();
        let outer = [(0, 1), (1, 2), (2, 3), (3, 0)].map(|(a, b)| (VertexId(a), VertexId(b)));
        for (i, &(a, b)) in outer.iter().enumerate() {
            let side = t.side_between(a, b).unwrap();
            t.set_piece(side, Some(SubcurveId(i as u32)));
        }
        t.set_piece(s, Some(SubcurveId(77)));
        t.flip(s);
        assert_eq!(t.flaws(), Vec::<String>::new());
        assert_eq!(t.side_between(VertexId(3), VertexId(1)), None);
        let diagonal = t.side_between(VertexId(0), VertexId(2)).unwrap();
        assert_eq!(t.subcurve(diagonal), None);
        for (i, &(a, b)) in outer.iter().enumerate() {
            assert_eq!(t.subcurve(t.side_between(a, b).unwrap()), Some(SubcurveId(i as u32)));
            assert_eq!(t.subcurve(t.side_between(b, a).unwrap()), Some(SubcurveId(i as u32)));
        }
    }
}
