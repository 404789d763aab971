//! The triangulation with coordinates: bulk construction, location, cavities and their filling.
//!
//! Insertion is that of Bowyer (1981) and Watson (1981), in two steps. [`Kernel::cavity`] finds the triangles that a
//! point would replace, and changes nothing. [`Kernel::fill`] replaces them. All signs are exact, so a cavity is always
//! a disk without inner vertices. Its triangles form a tree by adjacency. A walk around that tree needs no marks and
//! meets the border in counter-clockwise order.
//!
//! **Serial order.** [`Kernel::new`] inserts in rounds that grow eightfold, each along a Hilbert curve
//! (`geometry::order`); later insertions follow the order of the calls. The triangulation, ids included, depends on the
//! points and that order alone: of cocircular points the first diagonal stays. [`Kernel::cavity`] needs only `&self`
//! and a [`Cavity`] of the caller. So the cavities of many points can be found in parallel, and disjoint ones filled
//! later in the serial order.

use super::triangulation::{GHOST, HalfEdge, Net, Record, Triangulation, after, before};
use crate::geometry::exact::{self, CircleSide, Orientation};
use crate::geometry::{Point, order};
use crate::ids::{Id, IdVec, TriangleId, VertexId};
use std::sync::atomic::{AtomicU64, Ordering};

/// Why points have no Delaunay triangulation here.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
pub enum Degenerate {
    /// There are fewer than three points.
    #[error("fewer than three points span no triangle")]
    TooFew,
    /// All points lie on one line.
    #[error("all points lie on one line")]
    Collinear,
    /// Two points have the same coordinates.
    #[error("points {first} and {second} have the same coordinates")]
    Duplicate {
        /// The index of one of the points, the smaller one.
        first: usize,
        /// The index of the other point.
        second: usize,
    },
    /// A coordinate is not a number, infinite, or beyond 2^±180, where exact signs would overflow.
    #[error("point {index} has a coordinate that is no number within 2^±180")]
    OutOfRange {
        /// The index of the first such point.
        index: usize,
    },
}

/// Where a point lies.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Location {
    /// At the coordinates of a vertex.
    Vertex(VertexId),
    /// On an edge, between its ends; either of its two half-edges.
    HalfEdge(HalfEdge),
    /// Inside a finite triangle, or outside the hull, in the open half-plane of a ghost triangle.
    Triangle(TriangleId),
}

/// The triangles that a point would replace. The caller keeps it and uses it again, which saves allocations.
#[derive(Clone, Default, Debug)]
pub struct Cavity {
    /// The triangles, each after one that it shares an edge with.
    pub triangles: Vec<TriangleId>,
    /// The half-edges of those triangles whose twins lie outside, counter-clockwise around the cavity.
    pub border: Vec<HalfEdge>,
    /// Half-edges into triangles that are still to be tested: twins of half-edges of the cavity.
    open: Vec<HalfEdge>,
}

/// How much work was done.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Counters {
    /// Orientation signs that were evaluated.
    pub orient: u64,
    /// In-circle signs that were evaluated.
    pub in_circle: u64,
    /// Signs that the static filter did not decide.
    pub exact_fallbacks: u64,
    /// Triangles visited to locate points.
    pub walk_steps: u64,
    /// Triangles in all cavities that were collected.
    pub cavity_triangles: u64,
}

/// Counters that `&self` may add to: sums, so they do not depend on the order of threads.
#[derive(Default)]
struct Ledger {
    orient: AtomicU64,
    in_circle: AtomicU64,
    exact_fallbacks: AtomicU64,
    walk_steps: AtomicU64,
    cavity_triangles: AtomicU64,
}

impl Ledger {
    fn add(&self, work: &Counters) {
        for (sum, more) in [
            (&self.orient, work.orient),
            (&self.in_circle, work.in_circle),
            (&self.exact_fallbacks, work.exact_fallbacks),
            (&self.walk_steps, work.walk_steps),
            (&self.cavity_triangles, work.cavity_triangles),
        ] {
            if more > 0 {
                sum.fetch_add(more, Ordering::Relaxed);
            }
        }
    }
}

/// A read-only walk over a net and its points, which counts its work.
pub(super) struct Walk<'a> {
    net: &'a Net,
    points: &'a [Point],
    work: Counters,
}

impl<'a> Walk<'a> {
    fn new(net: &'a Net, points: &'a [Point]) -> Self {
        Self { net, points, work: Counters::default() }
    }

    #[inline]
    fn point(&self, v: VertexId) -> Point {
        self.points[v.index()]
    }

    /// The orientation of a b c, counted.
    #[inline]
    pub(super) fn orient(&mut self, a: Point, b: Point, c: Point) -> Orientation {
        self.work.orient += 1;
        exact::orient_filtered(a, b, c).unwrap_or_else(|| {
            self.work.exact_fallbacks += 1;
            exact::orient_adaptive(a, b, c)
        })
    }

    /// Where d lies to the circle of the counter-clockwise triangle a b c, counted.
    #[inline(always)]
    pub(super) fn in_circle(&mut self, a: Point, b: Point, c: Point, d: Point) -> CircleSide {
        self.work.in_circle += 1;
        exact::in_circle_filtered(a, b, c, d).unwrap_or_else(|| {
            self.work.exact_fallbacks += 1;
            exact::in_circle_adaptive(a, b, c, d)
        })
    }

    /// Whether `p` lies inside the circle of a triangle, or, for a ghost, beyond its edge of the hull: then the
    /// triangle belongs to the cavity of `p`.
    #[inline]
    fn conflicts(&mut self, corners: [VertexId; 3], p: Point) -> bool {
        // The number of GHOST is beyond all points.
        let [Some(&a), Some(&b), Some(&c)] = corners.map(|v| self.points.get(v.index())) else {
            return self.ghost_conflicts(corners, p);
        };
        self.in_circle(a, b, c, p) == CircleSide::Inside
    }

    #[cold]
    fn ghost_conflicts(&mut self, corners: [VertexId; 3], p: Point) -> bool {
        let [a, b] = hull_side(corners).map(|v| self.point(v));
        match self.orient(a, b, p) {
            Orientation::CounterClockwise => true,
            Orientation::Collinear => exact::strictly_between(a, p, b),
            Orientation::Clockwise => false,
        }
    }

    /// The visibility walk (Devillers, Pion & Teillaud 2002). It never tests the half-edge by which it entered a
    /// triangle. It ends in any Delaunay triangulation. In another one it might run in a circle; then every triangle is
    /// tested.
    ///
    /// ```text
    ///           c               p lies strictly to the left of the entry a→b, whose triangle is t.
    ///         ╱   ╲             If p lies to the right of b→c, the walk crosses it: c→b is the next entry.
    ///       ╱   t   ╲      p    Else if p lies to the right of c→a, it crosses that: a→c is the next entry.
    ///     ╱           ╲         Else t holds p.
    ///   a ────entry───▶ b
    /// ```
    fn locate(&mut self, p: Point, near: TriangleId) -> Location {
        let mut entry = match self.look_from(p, self.finite_near(near)) {
            Ok(location) => return location,
            Err(entry) => entry,
        };
        let (t, i) = entry.split();
        let corners = self.net.record(t).corners;
        // p lies strictly to the left of the entry a→b.
        let (mut a, mut b) = (self.point(corners[i]), self.point(corners[after(i)]));
        for _ in 0..=self.net.len() {
            self.work.walk_steps += 1;
            let (t, i) = entry.split();
            let record = self.net.record(t);
            let apex = record.corners[before(i)];
            let Some(&c) = self.points.get(apex.index()) else { return Location::Triangle(t) };
            let bc = self.orient(b, c, p);
            if bc == Orientation::Clockwise {
                (a, entry) = (c, record.twins[after(i)]);
                continue;
            }
            let ca = self.orient(c, a, p);
            if ca == Orientation::Clockwise {
                (b, entry) = (c, record.twins[before(i)]);
                continue;
            }
            return match (bc == Orientation::Collinear, ca == Orientation::Collinear) {
                (true, true) => Location::Vertex(apex),
                (true, false) => Location::HalfEdge(t.side_of(after(i))),
                (false, true) => Location::HalfEdge(t.side_of(before(i))),
                (false, false) => Location::Triangle(t),
            };
        }
        self.locate_by_scan(p)
    }

    /// Where `p` lies in a finite triangle; else the twin of a half-edge that has `p` on its right.
    fn look_from(&mut self, p: Point, t: TriangleId) -> Result<Location, HalfEdge> {
        self.work.walk_steps += 1;
        let record = *self.net.record(t);
        let corners = record.corners.map(|v| self.point(v));
        let mut on = [false; 3];
        for i in 0..3 {
            match self.orient(corners[i], corners[after(i)], p) {
                Orientation::Clockwise => return Err(record.twins[i]),
                Orientation::Collinear => on[i] = true,
                Orientation::CounterClockwise => {}
            }
        }
        // On two half-edges: at the corner where the second of them starts.
        Ok(match (0..3).find(|&i| on[i] && on[before(i)]) {
            Some(i) => Location::Vertex(record.corners[i]),
            None => on.iter().position(|&on| on).map_or(Location::Triangle(t), |i| Location::HalfEdge(t.side_of(i))),
        })
    }

    /// The finite triangle `near`, or its finite neighbour where it is a ghost, or where it was removed the first
    /// triangle that still exists.
    fn finite_near(&self, near: TriangleId) -> TriangleId {
        let t = if self.net.is_alive(near) {
            near
        } else {
            (0..self.net.len())
                .map(TriangleId::from_index)
                .find(|&t| self.net.is_alive(t))
                .expect("some triangle lives")
        };
        let record = self.net.record(t);
        match record.corners.iter().position(|&v| v == GHOST) {
            Some(i) => record.twins[after(i)].triangle(),
            None => t,
        }
    }

    fn locate_by_scan(&mut self, p: Point) -> Location {
        for t in (0..self.net.len()).map(TriangleId::from_index).filter(|&t| self.net.is_alive(t)) {
            let corners = self.net.record(t).corners;
            if !corners.contains(&GHOST) {
                if let Ok(location) = self.look_from(p, t) {
                    return location;
                }
            } else if self.orient_hull(corners, p) == Orientation::CounterClockwise {
                return Location::Triangle(t);
            }
        }
        unreachable!("triangles and ghosts cover the plane")
    }

    fn orient_hull(&mut self, corners: [VertexId; 3], p: Point) -> Orientation {
        let [a, b] = hull_side(corners).map(|v| self.point(v));
        self.orient(a, b, p)
    }

    /// Collects the cavity of `p` from `start`, one of its triangles: depth first around the tree that they form, and
    /// never across a `closed` half-edge.
    pub(super) fn collect(
        &mut self,
        p: Point,
        start: TriangleId,
        closed: impl Fn(HalfEdge) -> bool,
        cavity: &mut Cavity,
    ) {
        let Cavity { triangles, border, open } = cavity;
        triangles.clear();
        border.clear();
        open.clear();
        triangles.push(start);
        let [first, second, third] = self.net.record(start).twins;
        open.extend([third, second]);
        let mut entry = first;
        loop {
            let (t, i) = entry.split();
            let Record { corners, twins } = *self.net.record(t);
            if !closed(entry) && self.conflicts(corners, p) {
                triangles.push(t);
                open.push(twins[before(i)]);
                entry = twins[after(i)];
                continue;
            }
            border.push(twins[i]);
            match open.pop() {
                Some(next) => entry = next,
                None => break,
            }
        }
        self.work.cavity_triangles += triangles.len() as u64;
    }
}

/// The finite corners of a ghost triangle, in its own order: infinity lies to their left, the hull to their right.
#[inline]
pub(super) fn hull_side([a, b, c]: [VertexId; 3]) -> [VertexId; 2] {
    if a == GHOST {
        [b, c]
    } else if b == GHOST {
        [c, a]
    } else {
        [a, b]
    }
}

/// The Delaunay triangulation of a set of points that can be added and removed.
pub struct Kernel {
    /// Coordinates, of removed vertices too.
    pub(super) points: IdVec<VertexId, Point>,
    /// The triangles, with their labels.
    pub(super) topology: Triangulation,
    ledger: Ledger,
}

impl Kernel {
    /// The Delaunay triangulation of points, in any unit; vertex i is `points[i]`. Takes expected time O(n log n), most
    /// of it linear.
    ///
    /// # Errors
    /// Where there are fewer than three points, all lie on one line, two have the same coordinates, or a coordinate is
    /// not a number within 2^±180.
    pub fn new(points: Vec<Point>) -> Result<Self, Degenerate> {
        if points.len() < 3 {
            return Err(Degenerate::TooFew);
        }
        if let Some(index) = points.iter().position(|&p| !in_range(p)) {
            return Err(Degenerate::OutOfRange { index });
        }
        // Vertices are numbered along the curve while inserting, so that neighbours in the plane are neighbours in
        // memory.
        let curve = order::hilbert(&points);
        let along: Vec<Point> = curve.iter().map(|&i| points[i as usize]).collect();
        let (mut net, work) = match triangulate(&along) {
            Ok(done) => done,
            Err(Degenerate::Duplicate { first, second }) => {
                let (a, b) = (curve[first] as usize, curve[second] as usize);
                return Err(Degenerate::Duplicate { first: a.min(b), second: a.max(b) });
            }
            Err(other) => return Err(other),
        };
        drop(along);
        net.rename(&curve);
        drop(curve);
        let topology = Triangulation::unlabelled(net, points.len());
        let ledger = Ledger::default();
        ledger.add(&work);
        Ok(Self { points: points.into(), topology, ledger })
    }

    /// Coordinates of all vertices, removed ones included.
    pub fn points(&self) -> &IdVec<VertexId, Point> {
        &self.points
    }

    /// The coordinates of a vertex.
    #[inline]
    pub fn point(&self, v: VertexId) -> Point {
        self.points[v]
    }

    /// The triangles, with their labels.
    pub fn topology(&self) -> &Triangulation {
        &self.topology
    }

    /// For labels, and for flips between cocircular points. After any other flip the triangulation is no longer
    /// Delaunay.
    pub fn topology_mut(&mut self) -> &mut Triangulation {
        &mut self.topology
    }

    /// Evaluates signs by a [`Walk`] and adds its work to the counters.
    pub(super) fn in_sight<T>(&self, look: impl FnOnce(&mut Walk) -> T) -> T {
        let mut sight = Walk::new(self.topology.net(), self.points.as_slice());
        let seen = look(&mut sight);
        self.ledger.add(&sight.work);
        seen
    }

    /// Where a point lies. The walk starts at `near` (any id is valid). It takes time in proportion to the triangles on
    /// the way.
    pub fn locate(&self, p: Point, near: TriangleId) -> Location {
        self.in_sight(|sight| sight.locate(p, near))
    }

    /// Looks: finds all triangles whose open circumdisk holds `p`, given where `p` lies. The disk of a ghost triangle
    /// is the open half-plane beyond its edge of the hull, together with the points between the ends of that edge.
    /// Cocircular triangles stay outside. Empty where `p` is a vertex. The coordinates of `p` must be numbers within
    /// 2^±180, as those of all vertices.
    ///
    /// ```text
    ///         d                      d          cavity: the three triangles whose circles hold p
    ///      .´╱ ╲`.                .´ │ `.       border: a→b, b→c, c→d, d→e, e→a: two more than triangles
    ///   e   ╱ p ╲   c    ─▶    e─────p─────c    fill:   a triangle on each of them: (a, b, p), (b, c, p), …
    ///    ╲ ╱     ╲ ╱            ╲  ╱   ╲  ╱
    ///     a───────b              a───────b
    /// ```
    ///
    /// # Panics
    /// Where a coordinate of `p` is beyond that range.
    pub fn cavity(&self, p: Point, at: Location, cavity: &mut Cavity) {
        self.cavity_within(|_| false, p, at, cavity);
    }

    /// [`Kernel::cavity`], but not across half-edges that are walls.
    pub(super) fn cavity_within(
        &self,
        is_wall: impl Fn(HalfEdge) -> bool,
        p: Point,
        at: Location,
        cavity: &mut Cavity,
    ) {
        // Beyond that range signs contradict each other, and the walk around the cavity need not end.
        assert!(in_range(p), "{p:?} is beyond exact signs");
        let start = match at {
            Location::Vertex(_) => {
                cavity.triangles.clear();
                cavity.border.clear();
                return;
            }
            Location::HalfEdge(s) => s.triangle(),
            Location::Triangle(t) => t,
        };
        self.in_sight(|sight| sight.collect(p, start, is_wall, cavity));
    }

    /// Acts: replaces the cavity of `p` by the triangles that join `p` to its border. Returns the new vertex. The
    /// figure is at [`Kernel::cavity`].
    ///
    /// Border half-edges keep their subcurves. Each new triangle takes the region of the removed triangle on its border
    /// half-edge. The triangle on `border[i]` is `(origin, target, p)` and takes the id of `triangles[i]`; the last two
    /// have other ids. The cavity must be that of this very `p`, with nothing changed since it was found.
    pub fn fill(&mut self, p: Point, cavity: &Cavity) -> VertexId {
        let v = self.points.push(p);
        self.topology.star(v, &cavity.triangles, &cavity.border);
        self.check_slowly();
        v
    }

    /// With feature `slow-checks`: checks the whole triangulation after each change, so that the change at fault is the
    /// one reported.
    pub(super) fn check_slowly(&self) {
        if cfg!(feature = "slow-checks") {
            assert_eq!(self.flaws(), Vec::<String>::new());
        }
    }

    /// The work done so far.
    pub fn counters(&self) -> Counters {
        let read = |sum: &AtomicU64| sum.load(Ordering::Relaxed);
        Counters {
            orient: read(&self.ledger.orient),
            in_circle: read(&self.ledger.in_circle),
            exact_fallbacks: read(&self.ledger.exact_fallbacks),
            walk_steps: read(&self.ledger.walk_steps),
            cavity_triangles: read(&self.ledger.cavity_triangles),
        }
    }

    /// The flaws, each with its place: of the structure, of orientations, of the convexity of the hull, and edges that
    /// are not locally Delaunay. All signs are exact. Empty where there are none. Takes linear time.
    pub fn flaws(&self) -> Vec<String> {
        let mut flaws = self.topology.flaws();
        if !flaws.is_empty() {
            return flaws;
        }
        let topology = &self.topology;
        let alive = || (0..topology.triangle_capacity()).map(TriangleId::from_index).filter(|&t| topology.is_alive(t));
        if let Some(v) = alive().flat_map(|t| topology.corners(t)).find(|&v| v != GHOST && self.points.get(v).is_none())
        {
            return vec![format!("vertex {} has no coordinates", v.0)];
        }
        let at = |v: VertexId| self.point(v);
        for t in topology.triangles() {
            let [a, b, c] = topology.corners(t);
            if exact::orient(at(a), at(b), at(c)) != Orientation::CounterClockwise {
                flaws.push(format!("triangle {} ({} {} {}) is not counter-clockwise", t.0, a.0, b.0, c.0));
                continue;
            }
            for s in (0..3).map(|i| t.side_of(i)) {
                let d = topology.apex(topology.twin(s));
                if d != GHOST && exact::in_circle(at(a), at(b), at(c), at(d)) == CircleSide::Inside {
                    flaws.push(format!("triangle {} ({} {} {}) has vertex {} in its circle", t.0, a.0, b.0, c.0, d.0));
                }
            }
        }
        for s in topology.sides_from(GHOST) {
            // s = GHOST→b, in the triangle (GHOST, b, c): the hull runs a, b, c clockwise.
            let a = topology.apex(topology.twin(s));
            let (b, c) = (topology.target(s), topology.apex(s));
            if exact::orient(at(a), at(b), at(c)) == Orientation::CounterClockwise {
                flaws.push(format!("the hull is dented at vertex {}", b.0));
            }
        }
        flaws
    }
}

/// Whether exact signs are possible at a point: polynomials of degree 4 in numbers whose bits lie within 2^±232 stay
/// within 2^±1022.
pub fn in_range(p: Point) -> bool {
    const LEAST: f64 = f64::from_bits((1023 - 180) << 52); // 2^-180
    const MOST: f64 = f64::from_bits((1023 + 180) << 52); // 2^180
    [p.x, p.y].iter().all(|v| *v == 0.0 || (LEAST..=MOST).contains(&v.abs()))
}

/// The Delaunay triangulation of points that are numbered along a Hilbert curve.
fn triangulate(points: &[Point]) -> Result<(Net, Counters), Degenerate> {
    let mut order = order::rounds(points.len());
    let (a, b) = (order[0], order[1]);
    let at = |v: u32| points[v as usize];
    let spans = |c: &u32| exact::orient(at(a), at(b), at(*c)) != Orientation::Collinear;
    let Some(third) = order.iter().position(spans) else { return Err(on_a_line(points)) };
    order.swap(2, third);
    let c = order[2];
    let first = match exact::orient(at(a), at(b), at(c)) {
        Orientation::CounterClockwise => [a, b, c],
        Orientation::Clockwise | Orientation::Collinear => [b, a, c],
    };
    let mut net = Net::of_triangle(first.map(VertexId), points.len());
    let mut work = Counters::default();
    let (mut near, mut cavity) = (TriangleId(0), Cavity::default());
    for &v in &order[3..] {
        let p = at(v);
        let mut sight = Walk { net: &net, points, work };
        let start = match sight.locate(p, near) {
            Location::Vertex(w) => return Err(Degenerate::Duplicate { first: w.index(), second: v as usize }),
            Location::HalfEdge(s) => s.triangle(),
            Location::Triangle(t) => t,
        };
        sight.collect(p, start, |_| false, &mut cavity);
        work = sight.work;
        net.star(VertexId(v), &cavity.triangles, &cavity.border);
        near = cavity.triangles[0];
    }
    Ok((net, work))
}

/// The error for points that are all collinear with the first two: where two points are equal, any third is collinear
/// with them.
fn on_a_line(points: &[Point]) -> Degenerate {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let key = |i: usize| points[i];
    order.sort_unstable_by(|&i, &j| key(i).x.total_cmp(&key(j).x).then(key(i).y.total_cmp(&key(j).y)).then(i.cmp(&j)));
    let twins = order.windows(2).find(|pair| points[pair[0]] == points[pair[1]]);
    twins.map_or(Degenerate::Collinear, |pair| Degenerate::Duplicate { first: pair[0], second: pair[1] })
}
