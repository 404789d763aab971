//! Facets become triangles of the tetrahedralization, by flips (Shewchuk 2003): no vertex is added.
//!
//! ```text
//!      side view                                  A facet F, its segments recovered. Tetrahedra that F's plane cuts within F are flipped away:
//!      above F                                    the lifted vertices above F rise, in time, with their height h above the plane,
//!        ╲    ╱╲    ╱           ╲    ╱  ╲    ╱
//!    ──●──╲──╱──╲──╱──●──  ─▶ ──●──●────●──●──       lift(v) + time · max(0, h(v)),
//!          ╲╱    ╲╱
//!      below F                                    and each face that stops being locally regular is flipped when it does.
//! ```
//!
//! The creased lifting is convex, so for large times its lower hull folds along F's plane: no tetrahedron is cut by it
//! any more. Tetrahedra that F does not cut stay as they are.
//!
//! Which vertices lie on F is known from the complex; a vertex of F is *on* its plane whatever rounding did to its
//! coordinates. All other signs are exact.

use super::Fault;
use super::tetrahedra::{Face, Tetrahedra};
use crate::geometry::exact_space::{PlaneSide, orient};
use crate::geometry::space::{cross, dot, minus, times};
use crate::ids::{FacetId, IdVec, PointId, SegmentId, TetId, VertexId};
use crate::solid::{Facet, Solid};
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// The triangles on facets: by their corners in ascending order, the facet and the corners counter-clockwise as seen from
/// its front.
pub(super) type FacetTriangles = BTreeMap<[VertexId; 3], (FacetId, [VertexId; 3])>;

/// Brings all facets of a solid into a tetrahedralization that has its segments as chains of edges.
pub(super) fn recover(
    net: &mut Tetrahedra,
    solid: &Solid,
    vertex_of: &IdVec<PointId, VertexId>,
    chains: &IdVec<SegmentId, Vec<VertexId>>,
    mut go_on: impl FnMut() -> Result<(), Fault>,
) -> Result<FacetTriangles, Fault> {
    let mut triangles = FacetTriangles::new();
    for (id, facet) in solid.facets().enumerate() {
        go_on()?;
        let plane = Plane::of(net, facet, vertex_of, chains, solid);
        for [u, v, w] in plane.recover(net).ok_or(Fault::Stuck { facet: id, at: plane.points[0] })? {
            triangles.insert(sorted([u, v, w]), (id, [u, v, w]));
            let f = net.face_of(u, v, w).expect("a triangle that was just found");
            net.set_facet(f, id);
        }
    }
    Ok(triangles)
}

/// A facet while it is brought in.
struct Plane {
    /// Three points of the facet, counter-clockwise as seen from its front.
    points: [[f64; 3]; 3],
    /// A unit normal, towards the front.
    normal: [f64; 3],
    /// The vertices on the facet.
    vertices: BTreeSet<VertexId>,
    /// Its subsegments, the smaller id first.
    barriers: BTreeSet<[VertexId; 2]>,
    /// The same from vertex to vertex, with the facet on the left; those inside in both directions.
    directed: Vec<[VertexId; 2]>,
}

/// What lies on a facet: the triangles that are there, and the tetrahedra that the facet cuts.
#[derive(Default)]
struct Section {
    triangles: BTreeSet<[VertexId; 3]>,
    cut: BTreeSet<TetId>,
}

impl Plane {
    fn of(
        net: &Tetrahedra,
        facet: &Facet,
        vertex_of: &IdVec<PointId, VertexId>,
        chains: &IdVec<SegmentId, Vec<VertexId>>,
        solid: &Solid,
    ) -> Self {
        let points = facet.plane.map(|p| net.points[vertex_of[p]]);
        let normal = cross(minus(points[1], points[0]), minus(points[2], points[0]));
        let normal = times(normal, 1.0 / libm::sqrt(dot(normal, normal)));
        let rim: BTreeSet<[PointId; 2]> = facet
            .rims
            .iter()
            .flat_map(|rim| rim.iter().zip(rim.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]))
            .collect();
        let mut directed = Vec::new();
        for &segment in &facet.segments {
            let [a, b] = solid.segments()[segment].ends;
            let ways = [rim.contains(&[a, b]), rim.contains(&[b, a])];
            let inside = ways == [false, false];
            for edge in chains[segment].windows(2).map(|edge| [edge[0], edge[1]]) {
                directed.extend((ways[0] || inside).then_some(edge));
                directed.extend((ways[1] || inside).then_some([edge[1], edge[0]]));
            }
        }
        let inner = facet.inner_points.iter().map(|&p| vertex_of[p]);
        let vertices = directed.iter().flatten().copied().chain(inner).collect();
        let barriers = directed.iter().map(|&[u, v]| [u.min(v), u.max(v)]).collect();
        Self { points, normal, vertices, barriers, directed }
    }

    /// The triangles of the facet, once tetrahedra that it cuts are flipped away; `None` where flips do not manage.
    fn recover(&self, net: &mut Tetrahedra) -> Option<BTreeSet<[VertexId; 3]>> {
        let section = self.section(net)?;
        if section.cut.is_empty() {
            return Some(section.triangles);
        }
        Flips::of(self, section.cut).run(net)?;
        let section = self.section(net)?;
        section.cut.is_empty().then_some(section.triangles)
    }

    fn side(&self, net: &Tetrahedra, v: VertexId) -> PlaneSide {
        if self.vertices.contains(&v) {
            return PlaneSide::On;
        }
        let [a, b, c] = self.points;
        orient(a, b, c, net.points[v])
    }

    /// The height of a vertex above the plane, 0 of those on the facet and below.
    fn rise(&self, net: &Tetrahedra, v: VertexId) -> f64 {
        match self.side(net, v) {
            PlaneSide::Above => dot(minus(net.points[v], self.points[0]), self.normal).max(0.0),
            PlaneSide::On | PlaneSide::Below => 0.0,
        }
    }

    /// Walks over the facet from its segments, from edge to edge in the plane.
    ///
    /// ```text
    ///             x above         Around the edge u v, counter-clockwise about the direction from u to v, sides go from below to above
    ///            ╱                on its left. There lies a triangle u v w, w on F, or a tetrahedron u v w x that F cuts.
    ///     u v ⊙ ── ── F
    ///            ╲
    ///             w below
    /// ```
    fn section(&self, net: &Tetrahedra) -> Option<Section> {
        let mut section = Section::default();
        let mut seen = BTreeSet::new();
        let mut edges = self.directed.clone();
        while let Some([u, v]) = edges.pop() {
            if !seen.insert([u, v]) {
                continue;
            }
            let ring = net.around(net.tet_at_edge(u, v)?, u, v);
            let sides: Vec<PlaneSide> = ring.iter().map(|&(_, w, _)| self.side(net, w)).collect();
            let n = ring.len();
            let (i, ons) = (0..n).filter(|&i| sides[i] == PlaneSide::Below).find_map(|i| {
                let ons = (1..n).take_while(|k| sides[(i + k) % n] == PlaneSide::On).count();
                (sides[(i + ons + 1) % n] == PlaneSide::Above).then_some((i, ons))
            })?;
            match ons {
                0 => self.flood(net, ring[i].0, &mut section.cut, &mut edges),
                1 => {
                    let w = ring[(i + 1) % n].1;
                    if !self.vertices.contains(&w) {
                        return None;
                    }
                    section.triangles.insert(rotated([u, v, w]));
                    edges.extend([[w, v], [u, w]].into_iter().filter(|&[a, b]| !self.is_barrier(a, b)));
                }
                // A tetrahedron with four vertices on the facet.
                _ => return None,
            }
        }
        Some(section)
    }

    /// The tetrahedra that the facet cuts, from one of them over their faces; edges in the plane that they have are
    /// left to look beyond.
    fn flood(&self, net: &Tetrahedra, start: TetId, cut: &mut BTreeSet<TetId>, edges: &mut Vec<[VertexId; 2]>) {
        let mut stack = vec![start];
        while let Some(t) = stack.pop() {
            if !cut.insert(t) {
                continue;
            }
            let corners = net.corners(t);
            let sides = corners.map(|v| self.side(net, v));
            for i in 0..4 {
                let others = || (0..4).filter(|&j| j != i);
                let has = |side| others().any(|j| sides[j] == side);
                if has(PlaneSide::Above) && has(PlaneSide::Below) {
                    stack.extend(net.twin(Face::of(t, i)).map(Face::tet).filter(|t| !cut.contains(t)));
                }
                for j in (0..i).filter(|&j| sides[i] == PlaneSide::On && sides[j] == PlaneSide::On) {
                    let (u, v) = (corners[i], corners[j]);
                    let within = self.vertices.contains(&u) && self.vertices.contains(&v);
                    if within && !self.is_barrier(u, v) {
                        edges.extend([[u, v], [v, u]]);
                    }
                }
            }
        }
    }

    fn is_barrier(&self, u: VertexId, v: VertexId) -> bool {
        self.barriers.contains(&[u.min(v), u.max(v)])
    }
}

/// A face that stops being locally regular at some time.
#[derive(PartialEq)]
struct Event {
    time: f64,
    /// Events at one time come in the order in which they were found.
    order: u32,
    face: Face,
    /// The corners of the face, and the apexes on both sides.
    vertices: [VertexId; 5],
}

impl Eq for Event {}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Event {
    /// The earliest is the greatest: a heap gives the greatest first.
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.time.total_cmp(&self.time).then(other.order.cmp(&self.order))
    }
}

/// The flips that bring a facet in.
struct Flips<'a> {
    plane: &'a Plane,
    /// The tetrahedra that the facet cut, or what they became.
    region: BTreeSet<TetId>,
    events: BinaryHeap<Event>,
    found: u32,
}

impl<'a> Flips<'a> {
    fn of(plane: &'a Plane, region: BTreeSet<TetId>) -> Self {
        Self { plane, region, events: BinaryHeap::new(), found: 0 }
    }

    /// Flips until the facet cuts no tetrahedron; `None`, with all as it was, where that does not come about.
    fn run(mut self, net: &mut Tetrahedra) -> Option<()> {
        let before: Vec<TetId> = self.region.iter().copied().collect();
        let snapshot = net.snapshot(&before);
        loop {
            let region: Vec<TetId> = self.region.iter().copied().collect();
            if !region.iter().any(|&t| self.is_cut(net, t)) {
                return Some(());
            }
            region.into_iter().for_each(|t| self.find_events(net, t));
            let mut flips = 0;
            while let Some(event) = self.events.pop() {
                flips += usize::from(self.happen(net, &event));
            }
            // Rounding may have taken near events in the wrong order: a face that could not be flipped is tried again
            // after others were.
            if flips == 0 {
                net.restore(&snapshot, &self.region.iter().copied().collect::<Vec<_>>());
                return None;
            }
        }
    }

    fn is_cut(&self, net: &Tetrahedra, t: TetId) -> bool {
        let sides = net.corners(t).map(|v| self.plane.side(net, v));
        sides.contains(&PlaneSide::Above) && sides.contains(&PlaneSide::Below)
    }

    /// Finds when the faces of a tetrahedron stop being locally regular.
    fn find_events(&mut self, net: &Tetrahedra, t: TetId) {
        for f in (0..4).map(|i| Face::of(t, i)) {
            let Some(g) = net.twin(f).filter(|g| self.region.contains(&g.tet())) else { continue };
            if net.facet(f).is_some() {
                continue;
            }
            let [a, b, c] = net.triangle(f);
            let vertices = [a, b, c, net.apex(f), net.apex(g)];
            if let Some(time) = self.time(net, vertices) {
                self.found += 1;
                self.events.push(Event { time, order: self.found, face: f, vertices });
            }
        }
    }

    /// When the face a b c, with p above and q below it, stops being locally regular: the time at which q lies on the
    /// lifted hyperplane of the others. `None`: never.
    fn time(&self, net: &Tetrahedra, vertices: [VertexId; 5]) -> Option<f64> {
        let sides = vertices.map(|v| self.plane.side(net, v));
        if !sides.contains(&PlaneSide::Above) || !sides.contains(&PlaneSide::Below) {
            return None;
        }
        let q = vertices[4];
        let rows: [[f64; 3]; 4] = std::array::from_fn(|i| minus(net.points[vertices[i]], net.points[q]));
        let minor = |i: usize, j: usize, k: usize| dot(rows[i], cross(rows[j], rows[k]));
        // The cofactors of the fourth column, with the sign that makes q above the hyperplane positive.
        let cofactors = [-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)];
        let lift: [f64; 4] = std::array::from_fn(|i| dot(rows[i], rows[i]) - net.weights[vertices[i]] + net.weights[q]);
        let low = self.plane.rise(net, q);
        let rise: [f64; 4] = std::array::from_fn(|i| self.plane.rise(net, vertices[i]) - low);
        let sum = |column: [f64; 4]| cofactors.iter().zip(column).map(|(c, x)| c * x).sum::<f64>();
        let (regular, change) = (sum(lift), sum(rise));
        (change < 0.0).then(|| (regular / -change).max(0.0))
    }

    /// Flips a face, or the edge of it that stands in the way; `false` where that cannot be.
    fn happen(&mut self, net: &mut Tetrahedra, event: &Event) -> bool {
        let f = event.face;
        let [a, b, c, p, q] = event.vertices;
        if !self.region.contains(&f.tet()) || net.triangle(f) != [a, b, c] || net.apex(f) != p {
            return false;
        }
        let Some(g) = net.twin(f).filter(|&g| net.apex(g) == q) else { return false };
        let place = |v: VertexId| net.points[v];
        let edges = [(a, b), (b, c), (c, a)];
        let sides = edges.map(|(x, y)| orient(place(q), place(p), place(x), place(y)));
        let blocking: Vec<usize> = (0..3).filter(|&k| sides[k] != PlaneSide::Above).collect();
        match blocking[..] {
            [] => {
                self.replace(net, &[f.tet(), g.tet()], |net| net.flip_23(f).to_vec());
                true
            }
            [k] => self.flip_edge(net, f, edges[k], sides[k]),
            _ => false,
        }
    }

    /// Flips the edge x y that keeps p q from going through the face: with three tetrahedra around it, or with four where
    /// x, y, p and q lie in one plane.
    fn flip_edge(&mut self, net: &mut Tetrahedra, f: Face, (x, y): (VertexId, VertexId), side: PlaneSide) -> bool {
        let ring = net.around(f.tet(), x, y);
        let inner =
            ring.iter().all(|(t, w, _)| self.region.contains(t) && net.facet(net.face_opposite(*t, *w)).is_none());
        let closed = ring.last().map(|&(_, _, last)| last) == ring.first().map(|&(_, first, _)| first);
        if !inner || !closed {
            return false;
        }
        let tets: Vec<TetId> = ring.iter().map(|&(t, ..)| t).collect();
        match (side, <[_; 3]>::try_from(ring)) {
            (PlaneSide::Below, Ok(ring)) => {
                let place = |v: VertexId| net.points[v];
                let [r, s, t] = ring.map(|(_, w, _)| place(w));
                let between = [(x, PlaneSide::Below), (y, PlaneSide::Above)];
                if between.iter().any(|&(v, side)| orient(r, s, t, place(v)) != side) {
                    return false;
                }
                self.replace(net, &tets, |net| net.flip_32(ring, x, y).to_vec());
                true
            }
            (PlaneSide::On, Err(ring)) if ring.len() == 4 => {
                self.replace(net, &tets, |net| flip_44(net, f, (x, y), &tets));
                true
            }
            _ => false,
        }
    }

    /// Lets a flip replace some tetrahedra, and looks at the faces of the new ones.
    fn replace(&mut self, net: &mut Tetrahedra, old: &[TetId], flip: impl FnOnce(&mut Tetrahedra) -> Vec<TetId>) {
        old.iter().for_each(|t| {
            self.region.remove(t);
        });
        let new = flip(net);
        self.region.extend(new.iter().copied());
        new.into_iter().for_each(|t| self.find_events(net, t));
    }
}

/// Four tetrahedra around the edge x y become four around p q, which crosses it: a flip that makes a flat tetrahedron
/// x y p q for a moment, and one that takes it away.
fn flip_44(net: &mut Tetrahedra, f: Face, (x, y): (VertexId, VertexId), ring: &[TetId]) -> Vec<TetId> {
    let made = net.flip_23(f);
    let flat = made.into_iter().find(|&t| net.corner_of(t, x).is_some() && net.corner_of(t, y).is_some());
    let around = net.around(flat.expect("a tetrahedron on x y"), x, y);
    let three: [_; 3] = around.try_into().expect("the flat one and two that were there");
    let others = three.map(|(t, ..)| t);
    let last = net.flip_32(three, x, y);
    let mut all: Vec<TetId> = made.into_iter().chain(ring.iter().copied()).filter(|t| !others.contains(t)).collect();
    all.extend(last);
    all.retain(|&t| net.is_alive(t));
    all.sort_unstable();
    all.dedup();
    all
}

impl Tetrahedra {
    /// A face with three given corners.
    pub(super) fn face_of(&self, u: VertexId, v: VertexId, w: VertexId) -> Option<Face> {
        let ring = self.around(self.tet_at_edge(u, v)?, u, v);
        // The face u v w of the tetrahedron u v w x lies opposite x.
        ring.into_iter().find(|&(_, at, _)| at == w).map(|(t, _, x)| self.face_opposite(t, x))
    }
}

pub(super) fn sorted(mut triangle: [VertexId; 3]) -> [VertexId; 3] {
    triangle.sort_unstable();
    triangle
}

/// The same triangle, its smallest corner first.
fn rotated([a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
    match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    }
}
