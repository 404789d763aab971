//! Facets and segments that meet elsewhere than in points and segments of both: exact.

use super::boxes::{Hierarchy, Space};
use super::complex::{Complex, shown};
use super::error::SolidError;
use super::exact::{Place, Side, along, axis_of, in_triangle, side, turn, within_segment};
use crate::geometry::exact::{Orientation, orient};

/// At most this many pairs are listed.
const LISTED: usize = 20;

/// A triangle or a dangling segment, by the points that it has.
#[derive(Clone, Copy)]
struct Cell {
    ids: [u32; 3],
    /// 3 of a triangle, 2 of a segment.
    len: usize,
    /// The triangle that it is, or the order of the required edge.
    from: u32,
}

/// Two cells that cross, and a place near where they do.
pub(super) struct Crossing {
    what: String,
    at: Place,
}

/// Every pair of cells that meet elsewhere than in what they share: the first ones, and how many there are.
pub(super) fn crossings(complex: &Complex) -> (Vec<Crossing>, usize) {
    let cells = cells(complex);
    let places = |cell: &Cell| cell.ids[..cell.len].iter().map(|&p| complex.points[p as usize]).collect::<Vec<_>>();
    let hierarchy = Hierarchy::new(cells.iter().map(|c| Space::around(places(c))));
    let (mut near, mut found, mut count) = (Vec::new(), Vec::new(), 0);
    for (i, a) in cells.iter().enumerate() {
        hierarchy.meeting(Space::around(places(a)), &mut near);
        for &j in near.iter().filter(|&&j| j as usize > i) {
            let b = &cells[j as usize];
            if let Some(at) = meet(complex, a, b) {
                count += 1;
                if found.len() < LISTED {
                    let what = format!("{} and {}", name(complex, a), name(complex, b));
                    found.push(Crossing { what, at: complex.place(at) });
                }
            }
        }
    }
    (found, count)
}

/// Refuses a complex in which cells cross.
pub(super) fn refuse(found: &[Crossing], count: usize) -> Result<(), SolidError> {
    let Some(first) = found.first() else { return Ok(()) };
    let others: Vec<String> = found[1..].iter().map(|c| format!("{} at {}", c.what, shown(c.at))).collect();
    let more = match (count, others.len()) {
        (1, _) => String::new(),
        (_, listed) if listed + 1 < count => format!(" ({count} pairs cross; also {}, …)", others.join("; ")),
        _ => format!(" ({count} pairs cross; also {})", others.join("; ")),
    };
    let what = format!("{} cross{more}, the first", first.what);
    let help =
        "facets may meet in points and edges that both have: unite or cut the bodies in the program that made the file";
    Err(SolidError::new(what, first.at, help).also_at(found[1..].iter().map(|c| c.at)))
}

fn cells(complex: &Complex) -> Vec<Cell> {
    let mut cells: Vec<Cell> = (0..complex.triangles.len() as u32)
        .map(|t| Cell { ids: complex.triangles[t as usize].corners, len: 3, from: t })
        .collect();
    let uses = complex.uses();
    let is_side = |e: &[u32; 2]| uses.binary_search_by(|u| u.ends.cmp(e)).is_ok();
    let dangling = complex.required.keys().zip(0..).filter(|(e, _)| !is_side(e));
    cells.extend(dangling.map(|(&[a, b], from)| Cell { ids: [a, b, b], len: 2, from }));
    cells
}

fn name(complex: &Complex, cell: &Cell) -> String {
    match cell.len {
        3 => complex.entity(cell.from).to_owned(),
        _ => format!(
            "the segment from {} to {}",
            shown(complex.place_of(cell.ids[0])),
            shown(complex.place_of(cell.ids[1]))
        ),
    }
}

/// A place where two cells meet besides what they share.
fn meet(complex: &Complex, a: &Cell, b: &Cell) -> Option<Place> {
    match (a.len, b.len) {
        (3, 3) => triangles_meet(complex, a, b),
        (3, _) => edge_meets(complex, [b.ids[0], b.ids[1]], a),
        (_, 3) => edge_meets(complex, [a.ids[0], a.ids[1]], b),
        _ => segments_meet(complex, [a.ids[0], a.ids[1]], [b.ids[0], b.ids[1]]),
    }
}

fn triangles_meet(complex: &Complex, a: &Cell, b: &Cell) -> Option<Place> {
    let at = |p: u32| complex.points[p as usize];
    let shared = a.ids.iter().filter(|p| b.ids.contains(p)).count();
    let (s, t) = (&complex.triangles[a.from as usize], &complex.triangles[b.from as usize]);
    // Triangles of one facet of the file lie side by side: they were made so.
    if s.facet == t.facet || shared == 3 {
        return None;
    }
    let edges = |of: &Cell| [[of.ids[0], of.ids[1]], [of.ids[1], of.ids[2]], [of.ids[2], of.ids[0]]];
    if shared == 2 {
        let apex = |of: &Cell, other: &Cell| of.ids.iter().copied().find(|p| !other.ids.contains(p));
        let (p, q) = (apex(a, b)?, apex(b, a)?);
        let corners = a.ids.map(at);
        let axis = axis_of(corners)?;
        // Folded onto each other: in one plane, with the apexes on one side of the edge.
        let [x, y] = edges(a).into_iter().find(|e| !e.contains(&p))?.map(at);
        let same = turn(axis, [x, y, at(p)]) == turn(axis, [x, y, at(q)]);
        return (same && side(corners[0], corners[1], corners[2], at(q)) == Side::On).then(|| at(q));
    }
    // Of a triangle that shares a corner, the edge opposite meets the other if anything does.
    let free = |e: &[u32; 2], other: &Cell| shared == 0 || !e.iter().any(|p| other.ids.contains(p));
    let of_a = edges(a).into_iter().filter(|e| free(e, b)).find_map(|e| segment_meets(complex, e, b));
    of_a.or_else(|| edges(b).into_iter().filter(|e| free(e, a)).find_map(|e| segment_meets(complex, e, a)))
}

/// Where a dangling segment meets a triangle besides in points that both have.
fn edge_meets(complex: &Complex, [p, q]: [u32; 2], triangle: &Cell) -> Option<Place> {
    let shares = |p: &u32| triangle.ids.contains(p);
    match (shares(&p), shares(&q)) {
        (false, false) => segment_meets(complex, [p, q], triangle),
        (true, true) => None,
        (one, _) => {
            // From a corner on, the segment leaves the triangle unless it runs in its plane.
            let (corner, end) = if one { (p, q) } else { (q, p) };
            let [a, b, c] = triangle.ids.map(|p| complex.points[p as usize]);
            let tip = complex.points[end as usize];
            if side(a, b, c, tip) != Side::On {
                return None;
            }
            let axis = axis_of([a, b, c])?;
            let opposite: Vec<Place> =
                triangle.ids.iter().filter(|&&p| p != corner).map(|&p| complex.points[p as usize]).collect();
            let from = complex.points[corner as usize];
            let crosses = flat_segments_meet(axis, [from, tip], [opposite[0], opposite[1]]);
            (crosses || in_triangle(axis, [a, b, c], tip)).then_some(tip)
        }
    }
}

/// Where a segment meets a triangle, borders included.
fn segment_meets(complex: &Complex, segment: [u32; 2], triangle: &Cell) -> Option<Place> {
    let [p, q] = segment.map(|p| complex.points[p as usize]);
    let [a, b, c] = triangle.ids.map(|p| complex.points[p as usize]);
    let (of_p, of_q) = (side(a, b, c, p), side(a, b, c, q));
    match (of_p, of_q) {
        (Side::On, Side::On) => {
            let axis = axis_of([a, b, c])?;
            let inside = [p, q].into_iter().find(|&e| in_triangle(axis, [a, b, c], e));
            let sides = [[a, b], [b, c], [c, a]];
            inside.or_else(|| sides.into_iter().find(|&s| flat_segments_meet(axis, [p, q], s)).map(|_| p))
        }
        _ if of_p == of_q => None,
        _ => {
            let sides = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
            let through = !(sides.contains(&Side::Front) && sides.contains(&Side::Back));
            through.then(|| on_plane([p, q], [a, b, c]))
        }
    }
}

/// The place where a segment passes through a plane, to within rounding.
fn on_plane([p, q]: [Place; 2], abc: [Place; 3]) -> Place {
    use crate::geometry::space::{minus, plus, times};
    let Some(plane) = super::plane::through(abc) else { return p };
    let (hp, hq) = (plane.height(p), plane.height(q));
    let along = hp / (hp - hq);
    if along.is_finite() { plus(p, times(minus(q, p), along.clamp(0.0, 1.0))) } else { p }
}

/// Whether two segments of one plane meet, ends included, as seen along an axis.
fn flat_segments_meet(axis: usize, [p, q]: [Place; 2], [a, b]: [Place; 2]) -> bool {
    let [p, q, a, b] = [p, q, a, b].map(|x| along(axis, x));
    let apart = |s: Orientation, t: Orientation| s == t && s != Orientation::Collinear;
    let (of_a, of_b, of_p, of_q) = (orient(p, q, a), orient(p, q, b), orient(a, b, p), orient(a, b, q));
    if [of_a, of_b, of_p, of_q].iter().all(|&o| o == Orientation::Collinear) {
        let overlap = |p: f64, q: f64, a: f64, b: f64| p.min(q) <= a.max(b) && a.min(b) <= p.max(q);
        return overlap(p.x, q.x, a.x, b.x) && overlap(p.y, q.y, a.y, b.y);
    }
    !apart(of_a, of_b) && !apart(of_p, of_q)
}

/// Where two dangling segments meet besides in an end that both have.
fn segments_meet(complex: &Complex, s: [u32; 2], t: [u32; 2]) -> Option<Place> {
    let ([p, q], [a, b]) = (s.map(|p| complex.points[p as usize]), t.map(|p| complex.points[p as usize]));
    if let Some(&common) = s.iter().find(|p| t.contains(p)) {
        let far = |of: [u32; 2]| complex.points[(if of[0] == common { of[1] } else { of[0] }) as usize];
        let (from, x, y) = (complex.points[common as usize], far(s), far(t));
        let within = within_segment(from, x, y) || within_segment(from, y, x);
        return within.then_some(from);
    }
    if side(p, q, a, b) != Side::On {
        return None;
    }
    // In one plane: seen along the axis that shows it largest, they meet or do not.
    let axis = axis_of([p, q, a]).or_else(|| axis_of([p, q, b]));
    match axis {
        Some(axis) => flat_segments_meet(axis, [p, q], [a, b]).then_some(p),
        None => [a, b].into_iter().find(|&e| e == p || e == q || within_segment(p, q, e)),
    }
}
