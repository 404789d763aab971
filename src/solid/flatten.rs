//! Triangles of one plane become one facet: exactly coplanar ones always, and those that the digits of the file explain.
//!
//! ```text
//!     ┌────┬────┐          all vertices of a region lie within T of one plane; then each is moved
//!     │   ╱│   ╱│          onto its plane, or onto the line or the point that two or three planes
//!     │  ╱ │  ╱ │   ──▶    share, by at most T
//!     │ ╱  │ ╱  │
//!     └────┴────┘
//! ```

use super::complex::{Complex, Use, counted, shown};
use super::exact::{Place, Side, side, turn};
use super::plane::{Plane, three_far, through};
use crate::geometry::exact::Orientation;
use crate::geometry::space::{dot, length, minus, plus, times};
use crate::ids::Forest;
use std::collections::{BTreeMap, VecDeque};

/// What counts as rounding, in units in the last place of the largest coordinate: four, as in the tolerance.
const ROUNDING: f64 = 4.0 * f64::EPSILON / 2.0;

/// A plane is fitted anew for a point that misses it by no more than this many tolerances: a plane through few points
/// is not known better far from them.
const NEAR_MISS: f64 = 64.0;

/// What was flattened.
pub(super) struct Flattened {
    /// The points before they were moved.
    before: Vec<Place>,
    /// The groups before triangles were merged that are not exactly coplanar.
    exact: Vec<u32>,
    regions: usize,
    triangles: usize,
    largest: f64,
    at: u32,
}

impl Flattened {
    /// Whether a point was moved.
    pub(super) fn is_moved(&self, complex: &Complex) -> bool {
        self.before != complex.points
    }

    /// Moves the points back, and takes apart what is not exactly coplanar.
    pub(super) fn undo(self, complex: &mut Complex) {
        complex.points = self.before;
        complex.triangles.iter_mut().zip(self.exact).for_each(|(t, group)| t.group = group);
    }

    /// Notes what was done.
    pub(super) fn tell(&self, complex: &mut Complex) {
        if self.regions > 0 {
            let (n, of) = (counted(self.regions, "facet"), counted(self.triangles, "triangle"));
            let at = shown(complex.place(self.before[self.at as usize]));
            let moved = self.largest * complex.unscale;
            let moved =
                if moved > 0.0 { format!("; points moved by up to {moved:.3e}, at {at}") } else { String::new() };
            complex.repairs.push(format!("{n} made flat of {of} that rounding holds apart{moved}."));
        }
    }
}

/// Gives triangles of one plane, and of one name, one group; moves points onto their planes.
pub(super) fn flatten(complex: &mut Complex) -> Flattened {
    let uses = complex.uses();
    let edges = mergeable(complex, &uses);
    merge_exact(complex, &edges);
    let exact: Vec<u32> = complex.triangles.iter().map(|t| t.group).collect();
    let before = complex.points.clone();
    let regions = if complex.tolerance > 0.0 { grow(complex, &edges) } else { Vec::new() };
    let mut flattened = Flattened { before, exact, regions: 0, triangles: 0, largest: 0.0, at: 0 };
    settle(complex, regions, &mut flattened);
    flattened
}

/// Pairs of triangles, and their opposite corners, that may become one facet: at an edge of no other triangle, not
/// asked for, of one name, winding and orientation.
fn mergeable(complex: &Complex, uses: &[Use]) -> Vec<[Use; 2]> {
    let name = |u: &Use| complex.facet(u.triangle).name;
    let winding = |u: &Use| complex.triangles[u.triangle as usize].winding;
    let pair = |chunk: &[Use]| match *chunk {
        [a, b] if a.forward != b.forward && name(&a) == name(&b) && winding(&a) == winding(&b) => {
            (!complex.required.contains_key(&a.ends)).then_some([a, b])
        }
        _ => None,
    };
    uses.chunk_by(|a, b| a.ends == b.ends).filter_map(pair).collect()
}

fn merge_exact(complex: &mut Complex, edges: &[[Use; 2]]) {
    let mut forest = Forest::new(complex.near.len());
    for [a, b] in edges {
        let groups = [a, b].map(|u| complex.triangles[u.triangle as usize].group as usize);
        if groups[0] != groups[1] && groups.iter().all(|&g| !complex.near[g]) && is_exact(complex, a, b) {
            forest.join(groups[0], groups[1]);
        }
    }
    complex.triangles.iter_mut().for_each(|t| t.group = forest.root(t.group as usize) as u32);
}

/// Whether two triangles at an edge are exactly coplanar, and lie side by side.
fn is_exact(complex: &Complex, a: &Use, b: &Use) -> bool {
    let [p, q, r] = complex.corners(a.triangle);
    let far = complex.corners(b.triangle)[usize::from(b.opposite)];
    side(p, q, r, far) == Side::On
        && super::exact::axis_of([p, q, r])
            .is_some_and(|axis| turn(axis, [p, q, r]) == turn(axis, complex.corners(b.triangle)))
}

/// A group of exactly coplanar triangles, to be merged with others.
struct Piece {
    triangles: Vec<u32>,
    points: Vec<u32>,
}

/// A facet to be: its triangles, points and plane.
struct Region {
    pieces: Vec<usize>,
    triangles: Vec<u32>,
    points: Vec<u32>,
    plane: Plane,
    /// Whether its points lie in one plane exactly.
    exact: bool,
}

fn places(complex: &Complex, points: &[u32]) -> Vec<Place> {
    points.iter().map(|&p| complex.points[p as usize]).collect()
}

fn pieces(complex: &Complex) -> (Vec<Piece>, Vec<usize>) {
    let mut of_group = BTreeMap::new();
    let mut pieces: Vec<Piece> = Vec::new();
    let mut piece_of = Vec::with_capacity(complex.triangles.len());
    for (t, triangle) in complex.triangles.iter().enumerate() {
        let at = *of_group.entry(triangle.group).or_insert(pieces.len());
        if at == pieces.len() {
            pieces.push(Piece { triangles: Vec::new(), points: Vec::new() });
        }
        pieces[at].triangles.push(t as u32);
        pieces[at].points.extend(triangle.corners);
        piece_of.push(at);
    }
    for piece in &mut pieces {
        piece.points.sort_unstable();
        piece.points.dedup();
    }
    (pieces, piece_of)
}

/// The least height of the best triangle of a piece: how well its plane is known.
fn breadth(complex: &Complex, piece: &Piece) -> f64 {
    use crate::geometry::space::cross;
    let height = |&t: &u32| {
        let [a, b, c] = complex.corners(t);
        let longest = [minus(b, a), minus(c, b), minus(a, c)].map(length).into_iter().fold(0.0, f64::max);
        length(cross(minus(b, a), minus(c, a))) / longest
    };
    piece.triangles.iter().map(height).fold(0.0, f64::max)
}

/// Grows regions over pieces within the tolerance of one plane, from the broadest pieces on.
fn grow(complex: &Complex, edges: &[[Use; 2]]) -> Vec<Region> {
    let (pieces, piece_of) = pieces(complex);
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); pieces.len()];
    for [a, b] in edges {
        let [a, b] = [a, b].map(|u| piece_of[u.triangle as usize]);
        if a != b {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
    }
    let mut order: Vec<(f64, usize)> = pieces.iter().map(|p| breadth(complex, p)).zip(0..).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut taken = vec![false; pieces.len()];
    let mut regions = Vec::new();
    for (_, seed) in order {
        if !std::mem::replace(&mut taken[seed], true) {
            regions.extend(grow_from(complex, seed, &pieces, &neighbours, &mut taken));
        }
    }
    regions
}

fn grow_from(
    complex: &Complex,
    seed: usize,
    pieces: &[Piece],
    neighbours: &[Vec<usize>],
    taken: &mut [bool],
) -> Option<Region> {
    let piece = &pieces[seed];
    let at = places(complex, &piece.points);
    let plane = facing(complex, through(three_far(&at)?.map(|i| at[i]))?, &piece.triangles);
    let near = complex.near[complex.triangles[piece.triangles[0] as usize].group as usize];
    let plane = if near { plane.fitted(&at, &[])? } else { plane };
    let mut region = Region {
        pieces: vec![seed],
        triangles: piece.triangles.clone(),
        points: piece.points.clone(),
        plane,
        exact: !near,
    };
    let mut queue: VecDeque<usize> = neighbours[seed].iter().copied().collect();
    while let Some(next) = queue.pop_front() {
        if taken[next] || !region.takes(complex, &pieces[next]) {
            continue;
        }
        taken[next] = true;
        region.pieces.push(next);
        region.exact = false;
        region.triangles.extend(&pieces[next].triangles);
        queue.extend(neighbours[next].iter().copied().filter(|&n| !taken[n]));
    }
    region.points.sort_unstable();
    region.points.dedup();
    Some(region)
}

/// The plane with the side in front from which the triangles are seen counter-clockwise.
fn facing(complex: &Complex, plane: Plane, triangles: &[u32]) -> Plane {
    let (axis, front) = plane.axis();
    let seen = turn(axis, complex.corners(triangles[0])) == Orientation::CounterClockwise;
    if seen == front { plane } else { Plane { normal: times(plane.normal, -1.0), ..plane } }
}

/// Whether all triangles are seen counter-clockwise from the front of a plane.
fn all_face(complex: &Complex, plane: &Plane, triangles: &[u32]) -> bool {
    let (axis, front) = plane.axis();
    let wanted = if front { Orientation::CounterClockwise } else { Orientation::Clockwise };
    triangles.iter().all(|&t| turn(axis, complex.corners(t)) == wanted)
}

impl Region {
    /// Takes the points of a piece in, if all then lie within the tolerance of one plane.
    fn takes(&mut self, complex: &Complex, piece: &Piece) -> bool {
        let at = places(complex, &piece.points);
        let worst = self.plane.worst(&at);
        if !all_face(complex, &self.plane, &piece.triangles) {
            return false;
        }
        if worst > complex.tolerance {
            if worst > NEAR_MISS * complex.tolerance {
                return false;
            }
            let mut all = places(complex, &self.points);
            all.extend(&at);
            match self.plane.fitted(&all, &[]) {
                Some(plane) if plane.worst(&all) <= complex.tolerance => self.plane = plane,
                _ => return false,
            }
        }
        self.points.extend(&piece.points);
        true
    }
}

/// Moves points onto the planes of the regions, and takes those apart that do not hold.
fn settle(complex: &mut Complex, mut regions: Vec<Region>, flattened: &mut Flattened) {
    regions.retain(|r| r.points.len() > 3);
    // Each round takes a region apart or is the last.
    while !regions.iter().all(|r| r.exact) {
        complex.points.clone_from(&flattened.before);
        fit_and_move(complex, &mut regions);
        let holds = |r: &Region| {
            let flat = r.plane.worst(&places(complex, &r.points)) <= ROUNDING.max(if r.exact { 0.0 } else { ROUNDING });
            r.exact || (flat && all_face(complex, &r.plane, &r.triangles))
        };
        let held: Vec<bool> = regions.iter().map(holds).collect();
        if held.iter().all(|&h| h) {
            break;
        }
        let mut held = held.into_iter();
        regions.retain(|_| held.next() == Some(true));
        complex.points.clone_from(&flattened.before);
    }
    for region in regions.iter().filter(|r| !r.exact) {
        let group = complex.new_group(true);
        region.triangles.iter().for_each(|&t| complex.triangles[t as usize].group = group);
        flattened.regions += 1;
        flattened.triangles += region.triangles.len();
    }
    for (p, (after, before)) in complex.points.iter().zip(&flattened.before).enumerate() {
        let moved = length(minus(*after, *before));
        if moved > flattened.largest {
            (flattened.largest, flattened.at) = (moved, p as u32);
        }
    }
}

/// Fits planes, through the points that stay, and moves the others onto them; a point stays that lies on more than
/// three planes, or would move farther than the tolerance.
fn fit_and_move(complex: &mut Complex, regions: &mut [Region]) {
    let before = complex.points.clone();
    let mut planes_of: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (r, region) in regions.iter().enumerate() {
        region.points.iter().for_each(|&p| planes_of.entry(p).or_default().push(r));
    }
    // What lies on exact planes alone has no reason to move.
    planes_of.retain(|_, of| of.iter().any(|&r| !regions[r].exact));
    let mut stays: Vec<bool> = vec![false; before.len()];
    planes_of.iter().filter(|(_, of)| of.len() > 3).for_each(|(&p, _)| stays[p as usize] = true);
    // Points that would move too far stay in the next round; few rounds are ever needed, and what then does not hold
    // is taken apart.
    for _ in 0..4 {
        for region in regions.iter_mut().filter(|r| !r.exact) {
            let fixed: Vec<u32> = region.points.iter().copied().filter(|&p| stays[p as usize]).collect();
            let at = |points: &[u32]| points.iter().map(|&p| before[p as usize]).collect::<Vec<_>>();
            if let Some(plane) = region.plane.fitted(&at(&region.points), &at(&fixed)) {
                region.plane = plane;
            }
        }
        let mut all_moved = true;
        for (&p, of) in &planes_of {
            let here = before[p as usize];
            let planes: Vec<Plane> = of.iter().map(|&r| regions[r].plane).collect();
            let there = if stays[p as usize] { here } else { onto(here, &planes) };
            if length(minus(there, here)) > complex.tolerance {
                (stays[p as usize], all_moved) = (true, false);
            }
            complex.points[p as usize] = there;
        }
        if all_moved {
            return;
        }
    }
}

/// The place on all of some planes that is nearest, as far as their normals tell the planes apart.
fn onto(here: Place, planes: &[Plane]) -> Place {
    let mut place = here;
    // The second round takes away what rounding left.
    for _ in 0..2 {
        let mut axes: Vec<Place> = Vec::new();
        let mut motion = [0.0; 3];
        for plane in planes {
            let along = |motion: Place, axis: &Place| minus(motion, times(*axis, dot(motion, *axis)));
            let free = axes.iter().fold(plane.normal, along);
            let reach = length(free);
            // Planes that are nearly parallel have no line in common that is near: the first one counts.
            if reach < 1e-3 {
                continue;
            }
            let missing = plane.height(place) + dot(motion, plane.normal);
            motion = minus(motion, times(free, missing / (reach * reach)));
            axes.push(times(free, 1.0 / reach));
        }
        place = plus(place, motion);
    }
    place
}
