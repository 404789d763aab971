//! Constrained triangles of points and edges in a plane: a sweep, flips to Delaunay, flips for the edges.
//!
//! The result depends on places alone, not on the order or the sense in which edges come: two copies of one polygon
//! have the same triangles.

use crate::geometry::Point;
use crate::geometry::exact::{CircleSide, Orientation, in_circle, orient, strictly_between};
use std::collections::VecDeque;

/// No triangle: beyond the hull.
pub(super) const NONE: u32 = u32::MAX;

/// What lies across an edge of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Across {
    /// The triangle there, or [`NONE`].
    pub triangle: u32,
    /// Whether the edge is one that was asked for.
    pub fixed: bool,
}

/// Triangles of a plane, counter-clockwise; across edge `i` is what lies opposite corner `i`.
pub(super) struct Flat {
    pub corners: Vec<[u32; 3]>,
    pub across: Vec<[Across; 3]>,
}

/// Why there are no triangles.
#[derive(Debug, PartialEq)]
pub(super) enum Unflat {
    /// Two points have one place.
    Equal(u32, u32),
    /// All points lie on one line.
    Collinear,
    /// An edge crosses another.
    Crossing([u32; 2], [u32; 2]),
}

/// Triangles over the convex hull of all points, in which every edge is a chain of edges.
///
/// # Errors
/// [`Unflat`] where points are equal or on one line, or edges cross.
pub(super) fn triangulate(points: &[Point], edges: &[[u32; 2]]) -> Result<Flat, Unflat> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let key = |i: u32| (points[i as usize].x + 0.0, points[i as usize].y + 0.0);
    order.sort_by(|&a, &b| key(a).0.total_cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)).then(a.cmp(&b)));
    if let Some(pair) = order.windows(2).find(|pair| points[pair[0] as usize] == points[pair[1] as usize]) {
        return Err(Unflat::Equal(pair[0], pair[1]));
    }
    let mut rank = vec![0u32; points.len()];
    order.iter().enumerate().for_each(|(i, &p)| rank[p as usize] = i as u32);
    let mut sorted: Vec<[u32; 2]> = edges.iter().map(|e| sorted_pair(e.map(|p| rank[p as usize]))).collect();
    sorted.retain(|[a, b]| a != b);
    sorted.sort_unstable();
    sorted.dedup();
    let mut work = Work::sweep(order.iter().map(|&p| points[p as usize]).collect())?;
    work.make_delaunay();
    let named = |e: [u32; 2]| e.map(|i| order[i as usize]);
    for edge in sorted {
        work.insert(edge).map_err(|other| Unflat::Crossing(named(edge), named(other)))?;
    }
    work.flat.corners.iter_mut().for_each(|t| *t = t.map(|i| order[i as usize]));
    Ok(work.flat)
}

fn sorted_pair([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

struct Work {
    points: Vec<Point>,
    flat: Flat,
    /// A triangle at each point.
    at: Vec<u32>,
}

impl Work {
    /// Triangles of points that are sorted by x, then y.
    ///
    /// ```text
    ///   b ◀──── a        each further point p lies beyond the hull, and sees the edges a→b that have it on their
    ///    ╲     ╱         right: each makes a triangle with p
    ///     ╲   ╱
    ///      p
    /// ```
    fn sweep(points: Vec<Point>) -> Result<Self, Unflat> {
        let turn = |a: usize, b: usize, c: usize| orient(points[a], points[b], points[c]);
        let n = points.len();
        let first = (2..n).find(|&k| turn(0, 1, k) != Orientation::Collinear).ok_or(Unflat::Collinear)?;
        let (mut next, mut before) = (vec![0; n], vec![0; n]);
        let mut corners: Vec<[u32; 3]> = Vec::with_capacity(2 * n);
        // The first points lie on one line; the next one sees all of them.
        let left = turn(0, 1, first) == Orientation::CounterClockwise;
        let mut hull: Vec<usize> = (0..=first).collect();
        if !left {
            hull.reverse();
        }
        for k in 1..first {
            let (a, b) = if left { (k - 1, k) } else { (k, k - 1) };
            corners.push([a as u32, b as u32, first as u32]);
        }
        for (i, &a) in hull.iter().enumerate() {
            let b = hull[(i + 1) % hull.len()];
            (next[a], before[b]) = (b, a);
        }
        for p in first + 1..n {
            let q = p - 1;
            let (mut after, mut ahead) = (q, q);
            while turn(after, next[after], p) == Orientation::Clockwise {
                corners.push([next[after] as u32, after as u32, p as u32]);
                after = next[after];
            }
            while turn(before[ahead], ahead, p) == Orientation::Clockwise {
                corners.push([ahead as u32, before[ahead] as u32, p as u32]);
                ahead = before[ahead];
            }
            (next[ahead], before[p], next[p], before[after]) = (p, ahead, after, p);
        }
        let (across, at) = (neighbours(&corners), triangle_at(&corners, n));
        Ok(Self { points, flat: Flat { corners, across }, at })
    }

    fn turn(&self, a: u32, b: u32, c: u32) -> Orientation {
        orient(self.points[a as usize], self.points[b as usize], self.points[c as usize])
    }

    /// The corners of the two triangles at edge `i` of triangle `t`, which is not on the hull: p, x, y of the one and
    /// q, y, x of the other.
    fn quad(&self, t: u32, i: usize) -> ([u32; 4], u32, usize) {
        let corners = self.flat.corners[t as usize];
        let u = self.flat.across[t as usize][i].triangle;
        let (p, x, y) = (corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]);
        let others = self.flat.corners[u as usize];
        let j = (0..3).find(|&j| others[(j + 1) % 3] == y && others[(j + 2) % 3] == x).unwrap_or(0);
        ([p, x, y, others[j]], u, j)
    }

    /// ```text
    ///      p            p
    ///     ╱ ╲          ╱│╲
    ///    x───y   ──▶  x │ y      t = p x q, u = q y p
    ///     ╲ ╱          ╲│╱
    ///      q            q
    /// ```
    fn flip(&mut self, t: u32, i: usize) {
        let ([p, x, y, q], u, j) = self.quad(t, i);
        let (of_t, of_u) = (self.flat.across[t as usize], self.flat.across[u as usize]);
        let (yp, px) = (of_t[(i + 1) % 3], of_t[(i + 2) % 3]);
        let (xq, qy) = (of_u[(j + 1) % 3], of_u[(j + 2) % 3]);
        self.flat.corners[t as usize] = [p, x, q];
        self.flat.corners[u as usize] = [q, y, p];
        self.flat.across[t as usize] = [xq, Across { triangle: u, fixed: false }, px];
        self.flat.across[u as usize] = [yp, Across { triangle: t, fixed: false }, qy];
        for (outer, from, to) in [(xq, u, t), (yp, t, u)] {
            if outer.triangle != NONE {
                let back = &mut self.flat.across[outer.triangle as usize];
                back.iter_mut().filter(|a| a.triangle == from).for_each(|a| a.triangle = to);
            }
        }
        for (point, triangle) in [(p, t), (x, t), (q, u), (y, u)] {
            self.at[point as usize] = triangle;
        }
    }

    fn make_delaunay(&mut self) {
        let mut queue: VecDeque<u32> = (0..self.flat.corners.len() as u32).collect();
        let mut waiting = vec![true; queue.len()];
        while let Some(t) = queue.pop_front() {
            waiting[t as usize] = false;
            for i in 0..3 {
                if self.flat.across[t as usize][i].triangle == NONE {
                    continue;
                }
                let ([p, x, y, q], u, _) = self.quad(t, i);
                let [a, b, c, d] = [p, x, y, q].map(|k| self.points[k as usize]);
                if in_circle(a, b, c, d) == CircleSide::Inside {
                    self.flip(t, i);
                    for again in [t, u] {
                        if !waiting[again as usize] {
                            waiting[again as usize] = true;
                            queue.push_back(again);
                        }
                    }
                    break;
                }
            }
        }
    }

    /// The triangles at a point, in no particular order, each with the place of the point in it.
    fn around(&self, a: u32) -> Vec<(u32, usize)> {
        let place = |t: u32| self.flat.corners[t as usize].iter().position(|&v| v == a).unwrap_or(0);
        let first = self.at[a as usize];
        let mut found = vec![(first, place(first))];
        for step in [1, 2] {
            let (mut t, mut i) = (first, place(first));
            loop {
                t = self.flat.across[t as usize][(i + step) % 3].triangle;
                if t == NONE || t == first {
                    break;
                }
                i = place(t);
                found.push((t, i));
            }
            if t == first {
                break;
            }
        }
        found
    }

    /// The triangle that has the edge `a b`, and the place of the corner opposite.
    fn find(&self, a: u32, b: u32) -> Option<(u32, usize)> {
        self.around(a).into_iter().find_map(|(t, i)| {
            let corners = self.flat.corners[t as usize];
            let j = (0..3).find(|&j| corners[j] == b)?;
            Some((t, 3 - i - j))
        })
    }

    fn fix(&mut self, a: u32, b: u32) {
        let Some((t, i)) = self.find(a, b) else { return };
        self.flat.across[t as usize][i].fixed = true;
        if self.flat.across[t as usize][i].triangle != NONE {
            let (_, u, j) = self.quad(t, i);
            self.flat.across[u as usize][j].fixed = true;
        }
    }

    /// Makes the edge from `a` to `b` a chain of edges, or tells a fixed edge that it crosses.
    fn insert(&mut self, [mut a, b]: [u32; 2]) -> Result<(), [u32; 2]> {
        while a != b {
            let (crossed, end) = self.crossed(a, b)?;
            self.uncross(crossed, a, end);
            self.fix(a, end);
            a = end;
        }
        Ok(())
    }

    /// The edges crossed on the way from `a` toward `b` up to the first point on it, and that point.
    fn crossed(&self, a: u32, b: u32) -> Result<(Vec<[u32; 2]>, u32), [u32; 2]> {
        let mut crossed = Vec::new();
        let Some((mut t, mut i)) = self.start(a, b, &mut crossed) else {
            return Ok((Vec::new(), crossed.first().map_or(b, |e| e[0])));
        };
        loop {
            let ([_, x, y, q], u, j) = self.quad(t, i);
            if self.flat.across[t as usize][i].fixed {
                return Err([x, y]);
            }
            crossed.push([x, y]);
            if q == b {
                return Ok((crossed, b));
            }
            // x lies on the right of a→b and y on its left. Leave u = q y x by q x, opposite y, where q is on the left,
            // else by q y, opposite x.
            i = match self.turn(a, b, q) {
                Orientation::Collinear => return Ok((crossed, q)),
                Orientation::CounterClockwise => (j + 1) % 3,
                Orientation::Clockwise => (j + 2) % 3,
            };
            t = u;
        }
    }

    /// The triangle at `a` that the way to `b` leaves by the edge opposite `a`; `None` where the way begins along an
    /// edge, whose other end `on` then tells.
    fn start(&self, a: u32, b: u32, on: &mut Vec<[u32; 2]>) -> Option<(u32, usize)> {
        let at = |i: u32| self.points[i as usize];
        let mut found = None;
        for (t, i) in self.around(a) {
            let corners = self.flat.corners[t as usize];
            let (x, y) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            for end in [x, y] {
                let between = end == b
                    || (self.turn(a, b, end) == Orientation::Collinear && strictly_between(at(a), at(end), at(b)));
                if between {
                    on.push([end, end]);
                    return None;
                }
            }
            if self.turn(a, b, x) == Orientation::Clockwise && self.turn(a, b, y) == Orientation::CounterClockwise {
                found = Some((t, i));
            }
        }
        found
    }

    /// Flips the edges that cross `a b` until none does (Sloan 1993).
    fn uncross(&mut self, crossed: Vec<[u32; 2]>, a: u32, b: u32) {
        let mut queue: VecDeque<[u32; 2]> = crossed.into();
        // Every edge is flipped a bounded number of times; the limit is far beyond any and only ends a fault of ours.
        let mut steps = 64 + 16 * queue.len() * queue.len();
        while let Some([x, y]) = queue.pop_front() {
            let Some((t, i)) = self.find(x, y) else { continue };
            let ([p, x, y, q], _, _) = self.quad(t, i);
            let convex =
                self.turn(p, q, x) == Orientation::Clockwise && self.turn(p, q, y) == Orientation::CounterClockwise;
            steps -= 1;
            assert!(steps > 0, "the flips for an edge do not end");
            if !convex {
                queue.push_back([x, y]);
                continue;
            }
            self.flip(t, i);
            let apart =
                |s: Orientation, t: Orientation| s != t && s != Orientation::Collinear && t != Orientation::Collinear;
            if ![a, b].contains(&p) && ![a, b].contains(&q) && apart(self.turn(a, b, p), self.turn(a, b, q)) {
                queue.push_back([p, q]);
            }
        }
    }
}

fn neighbours(corners: &[[u32; 3]]) -> Vec<[Across; 3]> {
    let mut sides: Vec<([u32; 2], u32, usize)> = Vec::with_capacity(3 * corners.len());
    for (t, corners) in corners.iter().enumerate() {
        sides.extend((0..3).map(|i| (sorted_pair([corners[(i + 1) % 3], corners[(i + 2) % 3]]), t as u32, i)));
    }
    sides.sort_unstable();
    let mut across = vec![[Across { triangle: NONE, fixed: false }; 3]; corners.len()];
    for pair in sides.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, t, i), (_, u, j)] = *pair {
            across[t as usize][i].triangle = u;
            across[u as usize][j].triangle = t;
        }
    }
    across
}

fn triangle_at(corners: &[[u32; 3]], points: usize) -> Vec<u32> {
    let mut at = vec![NONE; points];
    for (t, corners) in corners.iter().enumerate() {
        corners.iter().for_each(|&v| at[v as usize] = t as u32);
    }
    at
}

impl Flat {
    /// By triangle, whether it can be reached from the seeds without crossing a fixed edge; `from_outside` begins at the
    /// hull as well.
    pub(super) fn reached(&self, seeds: &[u32], from_outside: bool) -> Vec<bool> {
        let mut reached = vec![false; self.corners.len()];
        let mut stack: Vec<u32> = seeds.to_vec();
        if from_outside {
            let open = |t: &usize| self.across[*t].iter().any(|a| a.triangle == NONE && !a.fixed);
            stack.extend((0..self.corners.len()).filter(open).map(|t| t as u32));
        }
        while let Some(t) = stack.pop() {
            if !std::mem::replace(&mut reached[t as usize], true) {
                let free = self.across[t as usize].iter().filter(|a| !a.fixed && a.triangle != NONE);
                stack.extend(free.map(|a| a.triangle).filter(|&u| !reached[u as usize]));
            }
        }
        reached
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rng::Rng;

    fn doubled_area(points: &[Point], t: [u32; 3]) -> f64 {
        let [a, b, c] = t.map(|i| points[i as usize]);
        (b - a).cross(c - a)
    }

    #[test]
    fn a_grid_with_edges_across_it_is_covered_once_and_holds_its_edges() {
        let n = 9;
        let points: Vec<Point> = (0..n * n).map(|i| Point::new(f64::from(i % n), f64::from(i / n))).collect();
        let id = |x: i32, y: i32| (x + n * y) as u32;
        let edges = [
            [id(0, 0), id(8, 7)],
            [id(0, 1), id(7, 8)],
            [id(0, 8), id(0, 0)],
            [id(8, 0), id(1, 0)],
            [id(2, 5), id(2, 8)],
        ];
        let flat = triangulate(&points, &edges).unwrap();
        let areas: Vec<f64> = flat.corners.iter().map(|&t| doubled_area(&points, t)).collect();
        assert!(areas.iter().all(|&a| a > 0.0));
        assert_eq!(areas.iter().sum::<f64>(), 128.0);
        let has = |a: u32, b: u32| flat.corners.iter().any(|t| t.contains(&a) && t.contains(&b));
        assert!(has(id(0, 0), id(8, 7)));
        // These edges pass through points of the grid, which split them.
        assert!(has(id(0, 1), id(1, 2)) && has(id(6, 7), id(7, 8)));
        assert!(has(id(0, 4), id(0, 5)) && has(id(2, 6), id(2, 7)));
    }

    #[test]
    fn crossing_edges_are_told() {
        let points = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let crossing = triangulate(&points, &[[0, 1], [2, 3]]);
        assert!(matches!(crossing, Err(Unflat::Crossing(..))));
        assert!(matches!(triangulate(&points[..2], &[]), Err(Unflat::Collinear)));
    }

    #[test]
    fn star_polygons_of_random_points_have_the_area_of_the_polygon() {
        let mut rng = Rng::new(7);
        for n in 3..60u32 {
            let points: Vec<Point> = (0..n)
                .map(|i| {
                    let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
                    (crate::geometry::direction(angle) * (0.2 + rng.between(0.0, 1.0))).to_point()
                })
                .collect();
            let edges: Vec<[u32; 2]> = (0..n).map(|i| [i, (i + 1) % n]).collect();
            let flat = triangulate(&points, &edges).unwrap();
            let outside = flat.reached(&[], true);
            let inside = flat.corners.iter().zip(&outside).filter(|(_, out)| !**out);
            let area: f64 = inside.map(|(t, _)| doubled_area(&points, *t)).sum();
            let exact: f64 =
                edges.iter().map(|e| points[e[0] as usize].to_vec2().cross(points[e[1] as usize].to_vec2())).sum();
            approx::assert_relative_eq!(area, exact, epsilon = 1e-12);
        }
    }
}
