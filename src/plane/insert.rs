//! Points joined to topology: bulk construction, locating, cavities (looking) and filling (acting).
//!
//! Insertion is that of Bowyer (1981) and Watson (1981), in two steps: [`Kernel::cavity`] looks at what a point would
//! replace and changes nothing, [`Kernel::fill`] replaces it. All signs are exact, so a cavity is always a disk
//! without inner vertices: its triangles hang together as a tree, and a walk around that tree needs no marks and meets
//! the border in counter-clockwise order.
//!
//! **Serial order.** [`Kernel::new`] inserts in rounds that grow eightfold, each along a Hilbert curve
//! (`geometry::order`); afterwards the order is that of the calls. The triangulation, ids included, is a function of
//! the points and that order alone: cocircular points keep the diagonal that was there first. Looking needs only
//! `&self` and the caller's own [`Cavity`], so that cavities of many points can be looked at in parallel and those that
//! do not touch filled in the serial order later.

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
    /// Between the ends of a side; which of the two twins is not promised.
    HalfEdge(HalfEdge),
    /// Inside a finite triangle, or outside the hull, in the open half-plane of a ghost triangle.
    Triangle(TriangleId),
}

/// What a point would replace: kept by the caller and used again, so that looking allocates nothing.
#[derive(Clone, Default, Debug)]
pub struct Cavity {
    /// The triangles, each after one it shares a side with.
    pub triangles: Vec<TriangleId>,
    /// Sides of those triangles whose twins lie outside, counter-clockwise around the cavity.
    pub border: Vec<HalfEdge>,
    /// Sides of triangles still to be looked at, the twins of the cavity's own.
    open: Vec<HalfEdge>,
}

/// How much work was done.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Counters {
    /// Orientation signs that were evaluated.
    pub orient: u64,
    /// In-circle signs that were evaluated.
    pub in_circle: u64,
    /// Signs that the static filter could not tell.
    pub exact_fallbacks: u64,
    /// Triangles that were visited to locate points.
    pub walk_steps: u64,
    /// Triangles in all cavities that were collected.
    pub cavity_triangles: u64,
}

/// Counters that looking may add to: sums, hence the same whatever thread adds first.
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

/// Signs at the vertices of a net, counted.
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

    #[inline]
    pub(super) fn orient(&mut self, a: Point, b: Point, c: Point) -> Orientation {
        self.work.orient += 1;
        exact::orient_filtered(a, b, c).unwrap_or_else(|| {
            self.work.exact_fallbacks += 1;
            exact::orient_adaptive(a, b, c)
        })
    }

    #[inline(always)]
    pub(super) fn in_circle(&mut self, a: Point, b: Point, c: Point, d: Point) -> CircleSide {
        self.work.in_circle += 1;
        exact::in_circle_filtered(a, b, c, d).unwrap_or_else(|| {
            self.work.exact_fallbacks += 1;
            exact::in_circle_adaptive(a, b, c, d)
        })
    }

    /// Whether a triangle must make room for `p`.
    #[inline]
    fn conflicts(&mut self, corners: [VertexId; 3], p: Point) -> bool {
        // The ghost's number is beyond all points.
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

    /// The visibility walk (Devillers, Pion & Teillaud 2002), which never looks back across the side it came by. It
    /// ends in any Delaunay triangulation; should another one lead it in a circle, every triangle is asked.
    fn locate(&mut self, p: Point, near: TriangleId) -> Location {
        let mut entry = match self.look_from(p, self.finite_near(near)) {
            Ok(location) => return location,
            Err(entry) => entry,
        };
        let (t, i) = entry.split();
        let corners = self.net.record(t).corners;
        // Of the entry a→b, `p` lies strictly left.
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

    /// Where `p` lies in a finite triangle, or the far side of one that separates it from `p`.
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
        // On two sides: at the corner that the second of them starts from.
        Ok(match (0..3).find(|&i| on[i] && on[before(i)]) {
            Some(i) => Location::Vertex(record.corners[i]),
            None => on.iter().position(|&on| on).map_or(Location::Triangle(t), |i| Location::HalfEdge(t.side_of(i))),
        })
    }

    /// A finite triangle at `near`, or the first of all.
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

    /// Collects the triangles that make room for `p`, from one of them, depth first around the tree that they form,
    /// never across a side that is `closed`.
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

/// The finite corners of a ghost triangle, in its own order: infinity lies on their left, the hull on their right.
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

/// The Delaunay triangulation of a growing and shrinking set of points.
pub struct Kernel {
    pub(super) points: IdVec<VertexId, Point>,
    pub(super) topology: Triangulation,
    ledger: Ledger,
}

impl Kernel {
    /// The Delaunay triangulation of some points, in any unit; vertex i is `points[i]`. Expected time O(n log n), most
    /// of it linear.
    ///
    /// # Errors
    /// Where there are fewer than three points, all lie on one line, two have the same coordinates, or a
    /// coordinate is not a number within 2^±180.
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

    /// Coordinates of all vertices, dead ones included.
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

    /// For labels, and for flips between cocircular points; other flips void what this type promises.
    pub fn topology_mut(&mut self) -> &mut Triangulation {
        &mut self.topology
    }

    pub(super) fn in_sight<T>(&self, look: impl FnOnce(&mut Walk) -> T) -> T {
        let mut sight = Walk::new(self.topology.net(), self.points.as_slice());
        let seen = look(&mut sight);
        self.ledger.add(&sight.work);
        seen
    }

    /// Where a point lies. The walk starts at `near` (any id will do) and takes time in proportion to the triangles on
    /// the way.
    pub fn locate(&self, p: Point, near: TriangleId) -> Location {
        self.in_sight(|sight| sight.locate(p, near))
    }

    /// Looks: all triangles whose open circumdisk holds `p`, given where `p` lies. A ghost triangle's disk is the open
    /// half-plane beyond its hull side, with that side's inner points. Cocircular triangles stay outside. Empty where
    /// `p` is a vertex.
    /// The coordinates of `p` must be numbers within 2^±180, as those of all vertices.
    pub fn cavity(&self, p: Point, at: Location, cavity: &mut Cavity) {
        self.cavity_within(|_| false, p, at, cavity);
    }

    /// [`Kernel::cavity`], which ends at walls.
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

    /// Acts: replaces the cavity of `p` by the triangles that join `p` to its border, and returns the new vertex.
    ///
    /// Border sides keep their pieces; each new triangle has the region of the cavity's triangle that its border side
    /// belonged to. The triangle on `border[i]` is `(origin, target, p)` and takes the id of `triangles[i]`; the last
    /// two have other ids. The cavity must be the one looked at for this very `p`, with nothing changed since.
    pub fn fill(&mut self, p: Point, cavity: &Cavity) -> VertexId {
        let v = self.points.push(p);
        self.topology.star(v, &cavity.triangles, &cavity.border);
        self.check_slowly();
        v
    }

    /// With feature `slow-checks`: the first change that spoils something is the one reported.
    pub(super) fn check_slowly(&self) {
        if cfg!(feature = "slow-checks") {
            assert_eq!(self.flaws(), Vec::<String>::new());
        }
    }

    /// Work done so far.
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

    /// What is wrong, with culprits: structure, orientation, convexity of the hull, and sides with a vertex inside the
    /// circle of the triangle across them. All signs exact. Empty when all is well. Takes linear time.
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
            // Around infinity, s = GHOST→b, its triangle (GHOST, b, c): the hull runs a, b, c clockwise.
            let a = topology.apex(topology.twin(s));
            let (b, c) = (topology.target(s), topology.apex(s));
            if exact::orient(at(a), at(b), at(c)) == Orientation::CounterClockwise {
                flaws.push(format!("the hull is dented at vertex {}", b.0));
            }
        }
        flaws
    }
}

/// Whether exact signs can take a point: degree 4 in numbers whose bits lie within 2^±232 stays within 2^±1022.
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

/// What to say of points that seem to lie on one line: two equal ones make any third collinear.
fn on_a_line(points: &[Point]) -> Degenerate {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let key = |i: usize| points[i];
    order.sort_unstable_by(|&i, &j| key(i).x.total_cmp(&key(j).x).then(key(i).y.total_cmp(&key(j).y)).then(i.cmp(&j)));
    let twins = order.windows(2).find(|pair| points[pair[0]] == points[pair[1]]);
    twins.map_or(Degenerate::Collinear, |pair| Degenerate::Duplicate { first: pair[0], second: pair[1] })
}
