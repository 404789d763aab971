//! Storage and topology of a triangulation of the whole plane: ids only, never a coordinate.
//!
//! Every triangle has three half-edges. Half-edge `3t + i` runs from corner i to corner i+1 of triangle t,
//! counter-clockwise. Its twin runs the other way in the neighbour. *Ghost* triangles cover the outside of the hull.
//! They share the one vertex [`GHOST`] at infinity, so every half-edge has a twin and the topology is that of a sphere.
//!
//! ```text
//!         c          s = a→b, in triangle t, with the apex c                    2           half-edge i of t is
//!       ╱   ╲        twin(s) = b→a, in the neighbour, with the apex d          ╱ ╲          number 3t + i, from
//!     ╱   t   ╲      next(s) = b→c, prev(s) = c→a                         3t+2╱ t ╲3t+1     corner i to i+1
//!   a ────s───▶ b                                                            ╱     ╲
//!     ╲       ╱      counter-clockwise around a: a→d, a→b, a→c;             0───────1
//!       ╲   ╱        the one after s is twin(prev(s))                          3t
//!         d
//! ```
//!
//! A triangle takes 24 bytes for corners and twins and 16 for subcurves and region, a vertex 4: together 84 bytes a
//! vertex. There is room for 7·10⁸ vertices.

use crate::ids::{Id, RegionId, SubcurveId, TriangleId, VertexId};

/// The vertex at infinity.
pub const GHOST: VertexId = VertexId(u32::MAX);

/// Stands for "no half-edge", "no subcurve", "no region".
const NONE: u32 = u32::MAX;

/// A half-edge: number `3·triangle + i`, directed from corner i to corner i+1 of the triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct HalfEdge(pub u32);

impl HalfEdge {
    /// Half-edge `i` of a triangle, from corner i to corner i+1; `i` in 0..3.
    #[inline]
    pub fn of(t: TriangleId, i: usize) -> Self {
        Self(3 * t.0 + i as u32)
    }

    /// The triangle on the left, which this half-edge bounds.
    #[inline]
    pub fn triangle(self) -> TriangleId {
        TriangleId(self.0 / 3)
    }

    /// The next half-edge of the same triangle, counter-clockwise.
    #[inline]
    pub fn next(self) -> Self {
        let (t, i) = self.split();
        Self::of(t, after(i))
    }

    /// The half-edge before this one in the same triangle.
    #[inline]
    pub fn prev(self) -> Self {
        let (t, i) = self.split();
        Self::of(t, before(i))
    }

    /// The triangle, and which of its half-edges this is, in 0..3.
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
    /// Half-edge `i` of this triangle, from corner i to corner i+1; `i` in 0..3.
    #[inline]
    pub fn side_of(self, i: usize) -> HalfEdge {
        HalfEdge::of(self, i)
    }
}

/// A triangle: its corners and the twins of its half-edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    /// Counter-clockwise; half-edge i starts at corner i.
    pub corners: [VertexId; 3],
    /// The twin of each half-edge.
    pub twins: [HalfEdge; 3],
}

/// A record on the free list.
const DEAD: Record = Record { corners: [GHOST; 3], twins: [HalfEdge(NONE); 3] };

/// A half-edge a→b on the border of a cavity, and its twin outside.
struct Rim {
    a: VertexId,
    b: VertexId,
    outer: HalfEdge,
}

/// Triangles and their neighbours without labels: all that bulk insertion changes.
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

    /// Corners and twins of a triangle, removed or not.
    #[inline]
    pub fn record(&self, t: TriangleId) -> &Record {
        &self.records[t.index()]
    }

    /// Number of triangles, ghosts and removed ones included: every id is below it.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// The half-edge that runs the other way, in the neighbour.
    pub fn twin(&self, s: HalfEdge) -> HalfEdge {
        let (t, i) = s.split();
        self.record(t).twins[i]
    }

    /// Whether the id belongs to a triangle now.
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

    /// Replaces a cavity (a disk of triangles without inner vertices) by the star of `apex`.
    ///
    /// The triangle on `border[k]` = a→b becomes `(a, b, apex)`. It takes the id of `triangles[k]`; the last two take
    /// the ids returned. The figure is at [`Kernel::cavity`](super::insert::Kernel::cavity).
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

/// A triangulation of the plane and a vertex at infinity, which together are a sphere. Its labels: the subcurve that
/// lies on a half-edge, the region of a triangle.
pub struct Triangulation {
    net: Net,
    /// The subcurve on each half-edge of a triangle, the same on both twins; NONE for no subcurve.
    subcurves: Vec<[u32; 3]>,
    /// The region of each triangle; NONE for no region.
    regions: Vec<u32>,
    /// One half-edge that starts at each vertex, that of [`GHOST`] first: see [`place_of`]. NONE for a removed one.
    anchors: Vec<HalfEdge>,
    /// Subcurve and region at each border half-edge while a cavity is filled.
    labels: Vec<(u32, u32)>,
}

/// Place of a vertex among the anchors: the number of [`GHOST`], the largest of all, wraps around to 0.
#[inline]
fn place_of(v: VertexId) -> usize {
    v.0.wrapping_add(1) as usize
}

fn label<I: Id>(value: u32) -> Option<I> {
    (value != NONE).then(|| I::from_index(value as usize))
}

impl Triangulation {
    /// The triangulation of a net over vertices `0..vertices`, without subcurves and regions.
    pub(super) fn unlabelled(net: Net, vertices: usize) -> Self {
        let (subcurves, regions) = (vec![[NONE; 3]; net.len()], vec![NONE; net.len()]);
        let mut anchors = vec![HalfEdge(NONE); vertices + 1];
        for (t, record) in net.records.iter().enumerate() {
            for (i, &corner) in record.corners.iter().enumerate() {
                anchors[place_of(corner)] = HalfEdge::of(TriangleId::from_index(t), i);
            }
        }
        Self { net, subcurves, regions, anchors, labels: Vec::new() }
    }

    /// The triangles without their labels.
    pub(super) fn net(&self) -> &Net {
        &self.net
    }

    /// The corners of a triangle, counter-clockwise; one is [`GHOST`] in a ghost triangle.
    #[inline]
    pub fn corners(&self, t: TriangleId) -> [VertexId; 3] {
        self.net.record(t).corners
    }

    /// The vertex at which a half-edge starts; its triangle lies on its left.
    #[inline]
    pub fn origin(&self, s: HalfEdge) -> VertexId {
        let (t, i) = s.split();
        self.corners(t)[i]
    }

    /// The vertex at which a half-edge ends.
    #[inline]
    pub fn target(&self, s: HalfEdge) -> VertexId {
        self.origin(s.next())
    }

    /// The corner opposite a half-edge in its triangle.
    #[inline]
    pub fn apex(&self, s: HalfEdge) -> VertexId {
        self.origin(s.prev())
    }

    /// The half-edge between the same vertices that runs the other way, in the neighbour.
    #[inline]
    pub fn twin(&self, s: HalfEdge) -> HalfEdge {
        self.net.twin(s)
    }

    /// Whether an id belongs to a triangle now, finite or ghost. The ids of removed triangles are used again.
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

    /// The half-edges that start at a vertex, counter-clockwise, those of ghost triangles included; none for a
    /// removed vertex. Those of [`GHOST`] end at the vertices of the hull, in clockwise order around it.
    pub fn sides_from(&self, v: VertexId) -> impl Iterator<Item = HalfEdge> {
        let first = self.anchors.get(place_of(v)).copied().filter(|&s| s != HalfEdge(NONE));
        std::iter::successors(first, move |s| Some(self.twin(s.prev())).filter(|&s| Some(s) != first))
    }

    /// The half-edge from `a` to `b`, if there is one. Takes time in proportion to the number of neighbours of `a`.
    pub fn side_between(&self, a: VertexId, b: VertexId) -> Option<HalfEdge> {
        self.sides_from(a).find(|&s| self.target(s) == b)
    }

    /// The subcurve that lies on a half-edge.
    #[inline]
    pub fn subcurve(&self, s: HalfEdge) -> Option<SubcurveId> {
        label(self.subcurve_label(s))
    }

    /// Sets the subcurve on a half-edge and its twin, or removes it.
    pub fn set_subcurve(&mut self, s: HalfEdge, subcurve: Option<SubcurveId>) {
        for s in [s, self.twin(s)] {
            self.set_subcurve_label(s, subcurve.map_or(NONE, |p| p.0));
        }
    }

    /// The region of a triangle; `None` outside all regions, and before one was given.
    #[inline]
    pub fn region(&self, t: TriangleId) -> Option<RegionId> {
        label(self.regions[t.index()])
    }

    /// Sets the region of a triangle, or removes it.
    pub fn set_region(&mut self, t: TriangleId, region: Option<RegionId>) {
        self.regions[t.index()] = region.map_or(NONE, |r| r.0);
    }

    /// Replaces the diagonal a→b of the quadrilateral `a d b c` by the other one.
    ///
    /// The new diagonal is half-edge 2 of both triangles. The four outer half-edges keep their subcurves, both ids keep
    /// their regions, and a subcurve on the old diagonal is lost. The caller ensures that the quadrilateral is convex.
    ///
    /// ```text
    ///          c                        c
    ///       .´   `.                  .´ │ `.
    ///     .´   t   `.              .´   │   `.      t = (a, b, c)  becomes  (d, b, c)
    ///   a ─────s────▶ b    ─▶    a   u  │  t   b    u = (b, a, d)  becomes  (c, a, d)
    ///     `.   u   .´              `.   │   .´
    ///       `.   .´                  `. │ .´
    ///          d                        d
    /// ```
    pub fn flip(&mut self, s: HalfEdge) {
        let n = self.twin(s);
        let (t, u) = (s.triangle(), n.triangle());
        let (a, b, c, d) = (self.origin(s), self.origin(n), self.apex(s), self.apex(n));
        let outer = [n.prev(), s.next(), s.prev(), n.next()].map(|side| (self.twin(side), self.subcurve_label(side)));
        let fresh = [HalfEdge::of(t, 0), HalfEdge::of(t, 1), HalfEdge::of(u, 0), HalfEdge::of(u, 1)];
        self.net.records[t.index()].corners = [d, b, c];
        self.net.records[u.index()].corners = [c, a, d];
        for (side, (twin, subcurve)) in fresh.into_iter().zip(outer) {
            self.net.join(side, twin);
            self.set_subcurve_label(side, subcurve);
        }
        self.net.join(HalfEdge::of(t, 2), HalfEdge::of(u, 2));
        self.subcurves[t.index()][2] = NONE;
        self.subcurves[u.index()][2] = NONE;
        fresh.into_iter().for_each(|s| self.anchor(s));
    }

    /// Makes a half-edge the anchor of the vertex at which it starts.
    fn anchor(&mut self, s: HalfEdge) {
        let v = self.origin(s);
        self.anchors[place_of(v)] = s;
    }

    fn subcurve_label(&self, s: HalfEdge) -> u32 {
        let (t, i) = s.split();
        self.subcurves[t.index()][i]
    }

    fn set_subcurve_label(&mut self, s: HalfEdge, subcurve: u32) {
        let (t, i) = s.split();
        self.subcurves[t.index()][i] = subcurve;
    }

    /// Replaces a cavity by the star of `apex`, whose number follows those of all vertices so far. Border half-edges
    /// keep their subcurves. Each new triangle takes the region of the removed triangle on its border half-edge. The
    /// new triangles have the ids of the cavity's and the two returned.
    pub(super) fn star(&mut self, apex: VertexId, triangles: &[TriangleId], border: &[HalfEdge]) -> [TriangleId; 2] {
        let mut labels = std::mem::take(&mut self.labels);
        labels.clear();
        labels.extend(border.iter().map(|&s| (self.subcurve_label(s), self.regions[s.triangle().index()])));
        let last = self.net.star(apex, triangles, border);
        self.subcurves.resize(self.net.len(), [NONE; 3]);
        self.regions.resize(self.net.len(), NONE);
        for (&t, &(subcurve, region)) in triangles.iter().chain(&last).zip(&labels) {
            self.subcurves[t.index()] = [subcurve, NONE, NONE];
            self.regions[t.index()] = region;
            self.anchor(HalfEdge::of(t, 0));
        }
        self.anchors.push(HalfEdge::of(triangles[0], 2));
        self.labels = labels;
        last
    }

    /// Removes a vertex of degree 3: one triangle replaces the three around it, with the id and region of the first.
    pub(super) fn merge_star(&mut self, v: VertexId) {
        let spokes: Vec<HalfEdge> = self.sides_from(v).collect();
        assert_eq!(spokes.len(), 3, "only a vertex of degree 3 leaves a triangle");
        let t = spokes[0].triangle();
        let rim: Vec<_> = spokes.iter().map(|s| s.next()).collect();
        let outer = [0, 1, 2].map(|i| (self.origin(rim[i]), self.twin(rim[i]), self.subcurve_label(rim[i])));
        for (i, (corner, twin, subcurve)) in outer.into_iter().enumerate() {
            self.net.records[t.index()].corners[i] = corner;
            self.net.join(HalfEdge::of(t, i), twin);
            self.subcurves[t.index()][i] = subcurve;
            self.anchors[place_of(corner)] = HalfEdge::of(t, i);
        }
        self.release(spokes[1].triangle());
        self.release(spokes[2].triangle());
        self.anchors[place_of(v)] = HalfEdge(NONE);
    }

    /// Removes a vertex of the hull by moving it to infinity: the finite triangles around it become ghosts without
    /// region, and its two ghosts are removed.
    ///
    /// ```text
    ///              v                 v → ∞: the three triangles around v become the ghosts at the new edges of
    ///           .´╱ ╲`.              the hull, r₁r₂, r₂r₃ and r₃rₘ; the two ghosts of v, at r₁v and v rₘ, are
    ///        .´  ╱   ╲  `.           removed. The link is convex: clip_ears has cut off all ears.
    ///     .´   r₂─────r₃   `.
    ///   r₁───´             `───rₘ
    /// ```
    pub(super) fn move_to_infinity(&mut self, v: VertexId) {
        let spokes: Vec<HalfEdge> = self.sides_from(v).collect();
        let ghost = spokes.iter().position(|&s| self.target(s) == GHOST).expect("a vertex of the hull has a ghost");
        // Counter-clockwise around v: v→r₁, …, v→rₘ (before), v→GHOST (after). The ghosts on either side of v→GHOST
        // collapse.
        let (before, after) = (spokes[(ghost + spokes.len() - 1) % spokes.len()], spokes[ghost]);
        for (inner, outer) in [(before, before.next()), (after.prev(), after.next())] {
            let (inner, subcurve) = (self.twin(inner), self.subcurve_label(outer));
            self.net.join(inner, self.twin(outer));
            self.set_subcurve_label(inner, subcurve);
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
        self.subcurves[t.index()] = [NONE; 3];
        self.regions[t.index()] = NONE;
    }

    /// The flaws of the structure, each with its place: half-edges and twins that do not match, subcurves that differ
    /// on twins, stars that do not close, an Euler number other than that of a sphere. Empty where there are none.
    /// Takes linear time.
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
        if self.subcurves.len() != self.net.len() || self.regions.len() != self.net.len() {
            flaws.push(format!(
                "{} triangles, {} subcurve labels, {} regions",
                self.net.len(),
                self.subcurves.len(),
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
        assert_flaw(|t| t.subcurves[0][0] = 5, "SubcurveId(5)");
        assert_flaw(|t| t.regions.truncate(2), "2 regions");
        assert_flaw(|t| t.anchors[2] = HalfEdge(NONE), "vertex 1 is a corner of 4 triangles but has no side");
        assert_flaw(|t| t.anchors[2] = t.anchors[3], "vertex 1 has side");
        assert_flaw(|t| t.anchors[4] = HalfEdge(NONE - 2), "vertex 3 has side");
    }

    #[test]
    fn two_spheres_or_a_pinched_star_are_no_triangulation() {
        // The same wheel once more, over the same vertices: every half-edge is sound, no star is whole.
        let twice = |t: &mut Triangulation| {
            let shift = t.net.len() as u32;
            let copy: Vec<Record> = t.net.records.clone();
            t.net
                .records
                .extend(copy.into_iter().map(|r| Record { twins: r.twins.map(|s| HalfEdge(s.0 + 3 * shift)), ..r }));
            t.subcurves.resize(t.net.len(), [NONE; 3]);
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
            t.set_subcurve(side, Some(SubcurveId(i as u32)));
        }
        t.set_subcurve(s, Some(SubcurveId(77)));
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
