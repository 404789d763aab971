//! The constrained Delaunay triangulation: an edge with a subcurve is constrained. Insertions, flips and removals
//! keep it, and it blocks visibility.
//!
//! A triangulation is constrained Delaunay if no vertex inside the circle of a triangle is visible from its inside
//! (Chew 1989; Lee & Lin 1986). That holds exactly when every edge without a subcurve is locally Delaunay. Storage and
//! exact signs are those of [`Kernel`]. Cavities end at constrained edges, and flips do not change them. Every
//! operation notes the triangles that it makes, so that the engine can assess them.

use super::insert::{Cavity, Degenerate, Kernel, Location, hull_side};
use super::triangulation::{GHOST, HalfEdge, Triangulation};
use crate::geometry::Point;
use crate::geometry::exact::{CircleSide, Orientation, in_circle, in_diametral, orient};
use crate::ids::{Id, SubcurveId, TriangleId, VertexId};
use std::collections::VecDeque;

/// The first thing on a straight line: its end, or a constrained edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Look {
    /// The end of the line is visible; it may lie on a subcurve.
    Seen(Location),
    /// A constrained edge blocks the line: its half-edge with the start of the line on the left.
    Blocked(HalfEdge),
}

/// Why two vertices cannot be joined.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Obstacle {
    /// A vertex on the segment between them.
    Vertex(VertexId),
    /// A subcurve that crosses the segment between them.
    Subcurve(SubcurveId),
}

/// The constrained Delaunay triangulation of points and constrained edges.
pub struct Constrained {
    delaunay: Kernel,
    /// Triangles made since they were last taken; some may have been removed since, some are listed twice.
    touched: Vec<TriangleId>,
    /// The triangles met by the current search; kept to reuse its memory.
    search: Search,
}

/// A set of triangles that is cleared in constant time, and the half-edges at its rim that are still to be crossed.
#[derive(Default)]
struct Search {
    /// The round in which each triangle was added last.
    rounds: Vec<u32>,
    round: u32,
    open: Vec<HalfEdge>,
}

impl Search {
    fn clear(&mut self, capacity: usize) {
        if self.round == u32::MAX {
            *self = Self::default();
        }
        self.round += 1;
        self.rounds.resize(capacity.max(self.rounds.len()), 0);
    }

    /// Adds a triangle; `true` where it was not in the set.
    fn insert(&mut self, t: TriangleId) -> bool {
        std::mem::replace(&mut self.rounds[t.index()], self.round) != self.round
    }
}

impl Constrained {
    /// The triangulation of points, with no constrained edges.
    ///
    /// # Errors
    /// As [`Kernel::new`].
    pub fn new(points: Vec<Point>) -> Result<Self, Degenerate> {
        Ok(Self { delaunay: Kernel::new(points)?, touched: Vec::new(), search: Search::default() })
    }

    /// The triangles, with their subcurves and regions.
    pub fn topology(&self) -> &Triangulation {
        self.delaunay.topology()
    }

    /// Points, location and counters. Its triangulation is constrained Delaunay only.
    pub fn kernel(&self) -> &Kernel {
        &self.delaunay
    }

    /// For regions of triangles; [`Constrained::join`] sets subcurves.
    pub(super) fn kernel_mut(&mut self) -> &mut Kernel {
        &mut self.delaunay
    }

    /// The coordinates of a vertex.
    #[inline]
    pub fn point(&self, v: VertexId) -> Point {
        self.delaunay.point(v)
    }

    /// Moves the triangles made since the last call to the end of a list, each as often as it was made.
    pub fn take_touched(&mut self, list: &mut Vec<TriangleId>) {
        list.append(&mut self.touched);
    }

    fn is_subcurve(&self, s: HalfEdge) -> bool {
        self.topology().subcurve(s).is_some()
    }

    // ---- insertion ----

    /// Looks: finds the triangles that have `p` inside their circle and visible from their inside, given where `p`
    /// lies. Empty where `p` is a vertex.
    ///
    /// ```text
    ///         d          a d is constrained: the cavity of p is (d, a, b) and (b, c, d).
    ///      .´┃ ╲`.       (d, e, a) is kept although its circle holds p: p is not visible
    ///   e   ┃ p ╲   c    from its inside.
    ///    ╲ ┃     ╲ ╱
    ///     a───────b
    /// ```
    pub fn cavity(&self, p: Point, at: Location, cavity: &mut Cavity) {
        self.delaunay.cavity_within(|s| self.is_subcurve(s), p, at, cavity);
    }

    /// Acts: replaces the cavity of `p` by the triangles that join `p` to its border. `p` must not lie on a constrained
    /// edge.
    pub fn fill(&mut self, p: Point, cavity: &Cavity) -> VertexId {
        let v = self.star(p, &cavity.triangles, &cavity.border);
        self.check_slowly();
        v
    }

    fn star(&mut self, p: Point, triangles: &[TriangleId], border: &[HalfEdge]) -> VertexId {
        let v = self.delaunay.points.push(p);
        let last = self.delaunay.topology.star(v, triangles, border);
        self.touched.extend(triangles.iter().chain(&last));
        v
    }

    // ---- constrained edges ----

    /// Makes the segment between two vertices a constrained edge with a subcurve.
    ///
    /// Edges p q that cross the segment are flipped until none does (Sloan 1993). Then the new edges c d are flipped
    /// until the triangulation is constrained Delaunay again.
    ///
    /// # Errors
    /// The first vertex on the segment, or the first subcurve that crosses it; nothing is changed then.
    ///
    /// ```text
    ///        p─────r                      p─────r          p q, p s, r s cross a b. If its two triangles are strictly
    ///     .´ │╲    │ `.                .´ .-´     `.       convex, one is flipped to its diagonal c d: a s, a r, a b.
    ///  a┄┄┄┄┄│┄┄╲┄┄│┄┄┄┄┄b    ─▶    a─────────────────b    Else, or if c d still crosses a b, it goes to the end.
    ///     `. │    ╲│ .´                `. `-.     .´
    ///        q─────s                      q─────s
    /// ```
    pub fn join(&mut self, a: VertexId, b: VertexId, subcurve: SubcurveId) -> Result<HalfEdge, Obstacle> {
        let mut crossing: VecDeque<[VertexId; 2]> = self.crossings(a, b)?.into();
        let mut diagonals = Vec::new();
        while let Some([p, q]) = crossing.pop_front() {
            let s = self.topology().side_between(p, q).expect("what crosses the segment is a side until it is flipped");
            if !self.is_flippable(s) {
                crossing.push_back([p, q]);
                continue;
            }
            let (c, d) = (self.topology().apex(s), self.topology().apex(self.topology().twin(s)));
            self.flip(s);
            if self.crosses([a, b], [c, d]) {
                crossing.push_back([c, d]);
            } else {
                diagonals.push([c, d]);
            }
        }
        let side = self.topology().side_between(a, b).expect("nothing crosses it any more");
        self.delaunay.topology.set_subcurve(side, Some(subcurve));
        let mut stack = diagonals.into_iter().filter_map(|[c, d]| self.topology().side_between(c, d)).collect();
        self.restore(&mut stack);
        self.check_slowly();
        Ok(self.topology().side_between(a, b).expect("a subcurve is never flipped"))
    }

    /// Whether a point on or beside an edge may split the two triangles at the edge into four: it lies strictly to the
    /// left of their other four half-edges, and where one triangle is a ghost, the hull stays convex.
    pub fn can_part(&self, s: HalfEdge, p: Point) -> bool {
        let topology = self.topology();
        let keeps_hull = |side: HalfEdge| {
            let turn = |t: TriangleId| {
                let [a, b] = hull_side(topology.corners(t)).map(|v| self.point(v));
                orient(a, b, p)
            };
            turn(side.triangle()) != Orientation::Clockwise
                && turn(topology.twin(side).triangle()) != Orientation::CounterClockwise
        };
        self.rim(s).into_iter().all(|side| match [topology.origin(side), topology.target(side)].contains(&GHOST) {
            true => keeps_hull(side),
            false => self.to_left(side, p) == Orientation::CounterClockwise,
        })
    }

    /// Inserts a point that [can](Constrained::can_part) split the two triangles at a constrained edge x y. Two
    /// subcurves replace the one of the edge; the first ends at the origin x of the half-edge. The result is that of
    /// [`Constrained::release`], insertion and [`Constrained::join`], which work for any point.
    ///
    /// ```text
    ///          c                        c
    ///       .´   `.                  .´ │ `.        p, on s or beside it, is joined to the rim x d, d y, y c, c x;
    ///     .´       `.              .´   │   `.      p x carries subcurves[0], p y carries subcurves[1].
    ///   x ──s──p────▶ y    ─▶    x ─────p───── y    Then edges are flipped until all is constrained Delaunay.
    ///     `.       .´              `.   │   .´
    ///       `.   .´                  `. │ .´
    ///          d                        d
    /// ```
    pub fn part(&mut self, s: HalfEdge, p: Point, subcurves: [SubcurveId; 2]) -> VertexId {
        let topology = self.topology();
        let (n, rim) = (topology.twin(s), self.rim(s));
        let ends = [topology.origin(s), topology.target(s)];
        let v = self.star(p, &[s.triangle(), n.triangle()], &rim);
        for (end, subcurve) in ends.into_iter().zip(subcurves) {
            let side = self.topology().side_between(v, end).expect("both ends are on the rim");
            self.delaunay.topology.set_subcurve(side, Some(subcurve));
        }
        let mut stack = self.topology().sides_from(v).flat_map(|spoke| [spoke, spoke.next()]).collect();
        self.restore(&mut stack);
        self.check_slowly();
        v
    }

    /// The other four half-edges of the two triangles at an edge, counter-clockwise.
    fn rim(&self, s: HalfEdge) -> [HalfEdge; 4] {
        let n = self.topology().twin(s);
        [s.next(), s.prev(), n.next(), n.prev()]
    }

    /// Removes the subcurve from an edge; the triangulation is constrained Delaunay again.
    pub fn release(&mut self, s: HalfEdge) {
        self.touched.extend([s.triangle(), self.topology().twin(s).triangle()]);
        self.delaunay.topology.set_subcurve(s, None);
        self.restore(&mut vec![s]);
        self.check_slowly();
    }

    /// The edges that the segment from `a` to `b` crosses, in order.
    fn crossings(&self, a: VertexId, b: VertexId) -> Result<Vec<[VertexId; 2]>, Obstacle> {
        let topology = self.topology();
        let (from, to) = (self.point(a), self.point(b));
        let mut entry = None;
        for s in topology.sides_from(a) {
            let (right, left) = (topology.target(s), topology.apex(s));
            if right == b {
                return Ok(Vec::new());
            }
            if right == GHOST {
                continue;
            }
            let right_of = orient(from, to, self.point(right));
            if right_of == Orientation::Collinear && (self.point(right) - from).dot(to - from) > 0.0 {
                return Err(Obstacle::Vertex(right));
            }
            let enters = left != GHOST
                && right_of == Orientation::Clockwise
                && orient(from, to, self.point(left)) == Orientation::CounterClockwise;
            if enters {
                entry = Some(s.next());
            }
        }
        // a and b are vertices of one triangulation of the hull, which is convex: the segment enters a triangle at a.
        let mut s = entry.expect("the segment enters a triangle at its start");
        let mut crossed = Vec::new();
        loop {
            if let Some(subcurve) = topology.subcurve(s) {
                return Err(Obstacle::Subcurve(subcurve));
            }
            crossed.push([topology.origin(s), topology.target(s)]);
            let beyond = topology.twin(s);
            let apex = topology.apex(beyond);
            if apex == b {
                return Ok(crossed);
            }
            s = match orient(from, to, self.point(apex)) {
                Orientation::CounterClockwise => beyond.next(),
                Orientation::Clockwise => beyond.prev(),
                Orientation::Collinear => return Err(Obstacle::Vertex(apex)),
            };
        }
    }

    /// Whether the two triangles at an edge form a strictly convex quadrilateral.
    fn is_flippable(&self, s: HalfEdge) -> bool {
        let topology = self.topology();
        let n = topology.twin(s);
        let [a, b, c, d] =
            [topology.origin(s), topology.target(s), topology.apex(s), topology.apex(n)].map(|v| self.point(v));
        orient(d, b, c) == Orientation::CounterClockwise && orient(c, a, d) == Orientation::CounterClockwise
    }

    /// Whether `c d` crosses `a b` between their ends.
    fn crosses(&self, [a, b]: [VertexId; 2], [c, d]: [VertexId; 2]) -> bool {
        if c == a || c == b || d == a || d == b {
            return false;
        }
        let [a, b, c, d] = [a, b, c, d].map(|v| self.point(v));
        orient(a, b, c) != orient(a, b, d)
    }

    fn flip(&mut self, s: HalfEdge) {
        self.touched.extend([s.triangle(), self.topology().twin(s).triangle()]);
        self.delaunay.topology.flip(s);
    }

    /// Flips edges without a subcurve that are not locally Delaunay, beginning with those on the stack (Lawson 1977).
    fn restore(&mut self, stack: &mut Vec<HalfEdge>) {
        while let Some(s) = stack.pop() {
            if self.is_subcurve(s) || self.delaunay.is_locally_delaunay(s) {
                continue;
            }
            let (t, u) = (s.triangle(), self.topology().twin(s).triangle());
            self.flip(s);
            stack.extend([t, u].into_iter().flat_map(|t| [t.side_of(0), t.side_of(1)]));
        }
    }

    // ---- removal ----

    /// Deletes a vertex of any degree, inside the hull and not the end of a subcurve.
    ///
    /// # Panics
    /// Where the vertex was removed before, lies on the hull, or the end of a subcurve.
    pub fn remove(&mut self, v: VertexId) {
        let star: Vec<HalfEdge> = self.topology().sides_from(v).collect();
        let bound = star.iter().any(|&s| self.topology().target(s) == GHOST || self.is_subcurve(s));
        assert!(!star.is_empty() && !bound, "only free vertices go");
        self.touched.extend(star.into_iter().map(HalfEdge::triangle));
        let mut diagonals = self.delaunay.clip_ears(v);
        self.delaunay.topology.merge_star(v);
        self.restore(&mut diagonals);
        self.check_slowly();
    }

    // ---- visibility ----

    /// Follows the straight line from a place in a triangle to `p`, up to the first constrained edge. The place is the
    /// centroid; where the triangle is so thin that rounding moves the centroid out of it, it is the middle of an edge
    /// or a corner. `None` where rounding leaves no start.
    ///
    /// ```text
    ///       b───────x         The line from the centroid ● of t to p is followed from triangle to
    ///     .´ ╲     ╱┃         triangle. It crosses b a and a x; the constrained edge x y blocks it.
    ///   c  ●┄┄╲┄┄┄╱┄┃┄┄┄┄p
    ///     `. t ╲ ╱  ┃
    ///        `──a───y
    /// ```
    pub fn look_from(&self, t: TriangleId, p: Point) -> Option<Look> {
        let topology = self.topology();
        let sides = [0, 1, 2].map(|i| t.side_of(i));
        if sides.iter().all(|&s| self.to_left(s, p) != Orientation::Clockwise) {
            return Some(Look::Seen(self.place_in(t, p)));
        }
        let [a, b, c] = topology.corners(t).map(|v| self.point(v));
        let middle = a + ((b - a) + (c - a)) / 3.0;
        let leaves = |from: Point, s: HalfEdge| {
            self.to_left(s, p) == Orientation::Clockwise
                && orient(from, p, self.point(topology.origin(s))) != Orientation::CounterClockwise
                && orient(from, p, self.point(topology.target(s))) == Orientation::CounterClockwise
        };
        let starts = [middle, a.midpoint(b), b.midpoint(c), c.midpoint(a), a, b, c];
        let line = |from: Point| sides.into_iter().find(|&s| leaves(from, s)).map(|s| (from, s));
        let (from, mut s) = starts.into_iter().find_map(line)?;
        // A straight line meets every triangle at most once.
        loop {
            if self.is_subcurve(s) {
                return Some(Look::Blocked(s));
            }
            let beyond = topology.twin(s);
            let apex = topology.apex(beyond);
            if apex == GHOST {
                return Some(Look::Seen(Location::Triangle(beyond.triangle())));
            }
            // A line through a vertex passes to the right of it.
            s = match orient(from, p, self.point(apex)) {
                Orientation::CounterClockwise => beyond.next(),
                Orientation::Clockwise | Orientation::Collinear => beyond.prev(),
            };
            if self.to_left(s, p) != Orientation::Clockwise {
                return Some(Look::Seen(self.place_in(beyond.triangle(), p)));
            }
        }
    }

    fn to_left(&self, s: HalfEdge, p: Point) -> Orientation {
        orient(self.point(self.topology().origin(s)), self.point(self.topology().target(s)), p)
    }

    /// Where a point lies that is in a finite triangle.
    fn place_in(&self, t: TriangleId, p: Point) -> Location {
        if let Some(&v) = self.topology().corners(t).iter().find(|&&v| self.point(v) == p) {
            return Location::Vertex(v);
        }
        let on = [0, 1, 2].map(|i| t.side_of(i)).into_iter().find(|&s| self.to_left(s, p) == Orientation::Collinear);
        on.map_or(Location::Triangle(t), Location::HalfEdge)
    }

    /// Whether two vertices are visible to each other: neither a subcurve nor a vertex lies between them.
    pub fn see_each_other(&self, a: VertexId, b: VertexId) -> bool {
        self.crossings(a, b).is_ok()
    }

    /// Whether any place between the ends of a half-edge is visible from a vertex to its left.
    pub fn sees(&self, v: VertexId, side: HalfEdge) -> bool {
        let [x, y] = [self.topology().origin(side), self.topology().target(side)].map(|v| self.point(v));
        let below = x + (y - x) * share_along(self.point(v), [x, y]).clamp(0.01, 0.99);
        self.glimpses(v, below, side) || self.makes_out(v, side)
    }

    /// Whether the ray from a vertex towards a place meets `side` before any subcurve, and no vertex on the way: then
    /// `side` is visible. It tests one line, where [`Constrained::makes_out`] tests all.
    fn glimpses(&self, v: VertexId, toward: Point, side: HalfEdge) -> bool {
        let topology = self.topology();
        let from = self.point(v);
        let is = |w: VertexId, wanted: Orientation| w != GHOST && orient(from, toward, self.point(w)) == wanted;
        let leaves = |s: &HalfEdge| {
            is(topology.origin(*s), Orientation::Clockwise) && is(topology.target(*s), Orientation::CounterClockwise)
        };
        let mut exit = topology.sides_from(v).map(HalfEdge::next).find(leaves);
        while let Some(s) = exit.filter(|&s| s != side && !self.is_subcurve(s)) {
            let beyond = topology.twin(s);
            exit = [beyond.next(), beyond.prev()].into_iter().find(leaves);
        }
        exit == Some(side)
    }

    /// [`Constrained::sees`], decided by all lines from the vertex.
    ///
    /// Triangular expansion: the cone of lines from `v` to `side` is followed from triangle to triangle. Each edge that
    /// it passes narrows it, and a constrained edge ends it.
    ///
    /// ```text
    ///             left──.           The cone from v between right and left passes the edge s, with apex beyond.
    ///          .´  │     `-.        If apex lies to the left of v→right, the cone passes right→apex,
    ///       .´     │        apex      from right to apex, or to left where apex lies beyond it.
    ///     v        s      .´        If apex lies to the right of v→left, the cone passes apex→left,
    ///       `.     │    .´            from apex to left, or from right where apex lies before it.
    ///          `.  │  .´
    ///             right
    /// ```
    fn makes_out(&self, v: VertexId, side: HalfEdge) -> bool {
        let topology = self.topology();
        let from = self.point(v);
        let turns_left = |a: VertexId, b: VertexId| orient(from, self.point(a), self.point(b));
        let (x, y) = (topology.origin(side), topology.target(side));
        let mut cones: Vec<(HalfEdge, VertexId, VertexId)> = Vec::new();
        for spoke in topology.sides_from(v) {
            let (a, b) = (topology.target(spoke), topology.apex(spoke));
            if a == GHOST || b == GHOST {
                continue;
            }
            let x_within =
                turns_left(a, x) != Orientation::Clockwise && turns_left(x, b) == Orientation::CounterClockwise;
            let y_within =
                turns_left(a, y) == Orientation::CounterClockwise && turns_left(y, b) != Orientation::Clockwise;
            let a_within =
                turns_left(x, a) != Orientation::Clockwise && turns_left(a, y) == Orientation::CounterClockwise;
            if x_within || y_within || a_within {
                cones.push((spoke.next(), if x_within { x } else { a }, if y_within { y } else { b }));
            }
        }
        while let Some((s, right, left)) = cones.pop() {
            if s == side {
                return true;
            }
            if self.is_subcurve(s) {
                continue;
            }
            let beyond = topology.twin(s);
            let apex = topology.apex(beyond);
            if apex == GHOST {
                continue;
            }
            if turns_left(right, apex) == Orientation::CounterClockwise {
                let narrowed = if turns_left(apex, left) == Orientation::CounterClockwise { apex } else { left };
                cones.push((beyond.next(), right, narrowed));
            }
            if turns_left(apex, left) == Orientation::CounterClockwise {
                let narrowed = if turns_left(right, apex) == Orientation::CounterClockwise { apex } else { right };
                cones.push((beyond.prev(), narrowed, left));
            }
        }
        false
    }

    /// Whether the apex of the triangle of a half-edge lies inside the diametral circle of the half-edge. If not, no
    /// vertex to the left from which the half-edge is visible lies inside.
    pub fn has_apex_in_half_circle(&self, side: HalfEdge) -> bool {
        let topology = self.topology();
        let [x, y] = [topology.origin(side), topology.target(side)].map(|v| self.point(v));
        let apex = topology.apex(side);
        apex != GHOST && in_diametral(x, y, self.point(apex)) == CircleSide::Inside
    }

    /// The vertices inside the diametral circle of a half-edge and to its left that may be visible from it: all that
    /// are, and some others. Ascending.
    ///
    /// The search goes through triangles that are connected within the half circle, and never across constrained edges.
    ///
    /// ```text
    ///         . - ~ ~ ~ - .       u and w lie inside, and triangles within the half circle connect
    ///      .´   w           `.    them to x y: both are found. The constrained edge a b occludes w,
    ///     : a━━━━━━━━━━b u   :    which `sees` decides.
    ///     x ─────side──────▶ y
    /// ```
    pub fn in_half_circle(&mut self, side: HalfEdge) -> Vec<VertexId> {
        if !self.has_apex_in_half_circle(side) {
            return Vec::new();
        }
        let mut search = std::mem::take(&mut self.search);
        search.clear(self.topology().triangle_capacity());
        let found = self.search_half_circle(side, &mut search);
        self.search = search;
        found
    }

    /// [`Constrained::in_half_circle`], where the apex lies inside.
    fn search_half_circle(&self, side: HalfEdge, search: &mut Search) -> Vec<VertexId> {
        let topology = self.topology();
        let [x, y] = [topology.origin(side), topology.target(side)].map(|v| self.point(v));
        let inside = |v: VertexId| in_diametral(x, y, self.point(v)) == CircleSide::Inside;
        let left = |v: VertexId| orient(x, y, self.point(v)) == Orientation::CounterClockwise;
        // The rounded distance only limits the search; whether a vertex lies inside is decided exactly.
        let (center, reach2) = (x.midpoint(y), 0.25 * x.distance_squared(y) * (1.0 + 1e-9));
        let mut found = vec![topology.apex(side)];
        search.insert(side.triangle());
        search.open.extend([side.next(), side.prev()]);
        while let Some(s) = search.open.pop() {
            let beyond = topology.twin(s);
            if self.is_subcurve(s) || topology.is_ghost(beyond.triangle()) {
                continue;
            }
            // A line of sight crosses only edges with an end to the left.
            let ends = [topology.origin(s), topology.target(s)];
            let near = comes_near(ends.map(|v| self.point(v)), center, reach2);
            if near && ends.into_iter().any(left) && search.insert(beyond.triangle()) {
                search.open.extend([beyond.next(), beyond.prev()]);
                // Its other corners were tested before.
                found.extend(Some(topology.apex(beyond)).filter(|&v| inside(v) && left(v)));
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    // ---- checks ----

    /// With feature `slow-checks`: checks the whole triangulation after each change, so that the change at fault is the
    /// one reported.
    fn check_slowly(&self) {
        if cfg!(feature = "slow-checks") {
            assert_eq!(self.flaws(), Vec::<String>::new());
        }
    }

    /// The flaws, each with its place: of the structure, of orientations, and edges without a subcurve that are not
    /// locally Delaunay. All signs are exact. Empty where there are none. Takes linear time.
    pub fn flaws(&self) -> Vec<String> {
        let topology = self.topology();
        let mut flaws = topology.flaws();
        if !flaws.is_empty() {
            return flaws;
        }
        for t in topology.triangles() {
            let [a, b, c] = topology.corners(t).map(|v| self.point(v));
            if orient(a, b, c) != Orientation::CounterClockwise {
                flaws.push(format!("triangle {} is not counter-clockwise", t.0));
                continue;
            }
            for s in [0, 1, 2].map(|i| t.side_of(i)).into_iter().filter(|&s| !self.is_subcurve(s)) {
                let d = topology.apex(topology.twin(s));
                if d != GHOST && in_circle(a, b, c, self.point(d)) == CircleSide::Inside {
                    flaws.push(format!("triangle {} sees vertex {} in its circle", t.0, d.0));
                }
            }
        }
        flaws
    }
}

/// Whether a segment comes within a squared distance of a place.
fn comes_near([a, b]: [Point; 2], p: Point, reach2: f64) -> bool {
    let (ab, ap, bp) = (b - a, p - a, p - b);
    let is_beside = ab.dot(ap) > 0.0 && ab.dot(bp) < 0.0;
    let across = ab.cross(ap);
    ap.hypot2() < reach2 || bp.hypot2() < reach2 || is_beside && across * across < reach2 * ab.hypot2()
}

/// The share of the way along a segment at which a place lies beside it.
fn share_along(p: Point, [a, b]: [Point; 2]) -> f64 {
    let (ab, ap) = (b - a, p - a);
    if ab.hypot2() > 0.0 { ap.dot(ab) / ab.hypot2() } else { 0.0 }
}

#[cfg(test)]
mod tests;
