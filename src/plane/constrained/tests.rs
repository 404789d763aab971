//! Random points in general position with random segments that do not cross, against slow oracles: the triangulation
//! built anew, and a test of every segment for every line of sight.

use super::*;
use crate::geometry::Vec2;
use crate::geometry::rng::Rng;
use crate::ids::Id;
use std::collections::BTreeSet;

/// Points, and segments between them of which no two cross.
struct Scene {
    points: Vec<Point>,
    segments: Vec<[usize; 2]>,
}

impl Scene {
    fn random(seed: u64, points: usize, segments: usize) -> Self {
        let mut rng = Rng::new(seed);
        let points: Vec<Point> =
            (0..points).map(|_| Point::new(rng.between(0.0, 1.0), rng.between(0.0, 1.0))).collect();
        let mut scene = Self { points, segments: Vec::new() };
        for _ in 0..segments {
            let [a, b] = [0, 1].map(|_| rng.below(scene.points.len()));
            let ends = [scene.points[a], scene.points[b]];
            if a != b && !scene.segments.contains(&[a, b]) && !scene.segments.contains(&[b, a]) && !scene.hides(ends) {
                scene.segments.push([a, b]);
            }
        }
        scene
    }

    /// Whether any segment crosses the line between two places.
    fn hides(&self, line: [Point; 2]) -> bool {
        self.segments.iter().any(|s| cross(line, s.map(|v| self.points[v])))
    }

    fn build(&self) -> Constrained {
        let mut built = Constrained::new(self.points.clone()).unwrap();
        for (i, &[a, b]) in self.segments.iter().enumerate() {
            built.join(VertexId::from_index(a), VertexId::from_index(b), SubcurveId::from_index(i)).unwrap();
        }
        built
    }

    /// Whether any place of a segment is visible from a point. Between two neighbouring rays to ends of segments all
    /// places are visible or none.
    fn sees(&self, from: Point, [x, y]: [Point; 2]) -> bool {
        let share = |p: Point| (x - from).cross(p - from) / ((x - from).cross(p - from) - (y - from).cross(p - from));
        let rays = self.segments.iter().flatten().map(|&v| share(self.points[v]));
        let mut shares: Vec<f64> = rays.filter(|f| (0.0..=1.0).contains(f)).chain([0.0, 1.0]).collect();
        shares.sort_by(f64::total_cmp);
        let stretches = shares.windows(2).filter(|w| w[1] - w[0] > 1e-12);
        let middles = stretches.map(|w| x.lerp(y, 0.5 * (w[0] + w[1])));
        middles.into_iter().any(|at| !self.hides([from, from.lerp(at, 1.0 - 1e-9)]))
    }
}

/// Whether two segments cross between their ends.
fn cross([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let part = |a, b, c, d| {
        let sides = [orient(a, b, c), orient(a, b, d)];
        sides.contains(&Orientation::Clockwise) && sides.contains(&Orientation::CounterClockwise)
    };
    part(a, b, c, d) && part(c, d, a, b)
}

/// The finite triangles, by coordinates, each from its least corner on.
fn triangles(built: &Constrained) -> Vec<[(u64, u64); 3]> {
    let key = |v: VertexId| (built.point(v).x.to_bits(), built.point(v).y.to_bits());
    let mut all: Vec<_> = built
        .topology()
        .triangles()
        .map(|t| {
            let mut corners = built.topology().corners(t).map(key);
            let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
            corners.rotate_left(least);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

fn scenes() -> impl Iterator<Item = (u64, Scene)> {
    (0..60).map(|seed| (seed, Scene::random(seed, 8 + seed as usize, seed as usize)))
}

#[test]
fn no_triangle_sees_a_vertex_in_its_circle() {
    for (seed, scene) in scenes() {
        let built = scene.build();
        assert_eq!(built.flaws(), Vec::<String>::new(), "seed {seed}");
        for t in built.topology().triangles() {
            let [a, b, c] = built.topology().corners(t).map(|v| built.point(v));
            let inner = [(1.0, 1.0), (1.0, 30.0), (30.0, 1.0), (0.03, 0.03)]
                .map(|(u, v)| a + ((b - a) * u + (c - a) * v) / (1.0 + u + v));
            for &p in &scene.points {
                let seen = in_circle(a, b, c, p) == CircleSide::Inside && inner.iter().any(|&q| !scene.hides([q, p]));
                assert!(!seen, "seed {seed}: triangle {} sees {p:?}", t.0);
            }
        }
    }
}

#[test]
fn whatever_the_way_there_the_triangulation_is_the_same() {
    for (seed, scene) in scenes() {
        let whole = triangles(&scene.build());
        let mut backwards = Constrained::new(scene.points.clone()).unwrap();
        for (i, &[a, b]) in scene.segments.iter().enumerate().rev() {
            backwards.join(VertexId::from_index(b), VertexId::from_index(a), SubcurveId::from_index(i)).unwrap();
        }
        assert_eq!(triangles(&backwards), whole, "seed {seed}: joined in another order");
        // Points at which no segment ends are removed and inserted again.
        let used: BTreeSet<usize> = scene.segments.iter().flatten().copied().collect();
        let mut cavity = Cavity::default();
        for v in (0..scene.points.len()).filter(|v| !used.contains(v)) {
            let v = VertexId::from_index(v);
            if backwards.topology().sides_from(v).any(|s| backwards.topology().target(s) == GHOST) {
                continue;
            }
            backwards.remove(v);
            assert_eq!(backwards.flaws(), Vec::<String>::new(), "seed {seed}: {v:?} removed");
            let p = backwards.point(v);
            let at = backwards.kernel().locate(p, TriangleId(0));
            backwards.cavity(p, at, &mut cavity);
            backwards.fill(p, &cavity);
            assert_eq!(triangles(&backwards), whole, "seed {seed}: {v:?} removed and inserted");
        }
        // Without the released segments the triangulation is that built without them.
        let (gone, kept) = scene.segments.split_at(scene.segments.len() / 2);
        let left = Scene { points: scene.points.clone(), segments: kept.to_vec() };
        let mut released = scene.build();
        for &[a, b] in gone {
            let side = released.topology().side_between(VertexId::from_index(a), VertexId::from_index(b)).unwrap();
            released.release(side);
        }
        assert_eq!(triangles(&released), triangles(&left.build()), "seed {seed}: released");
    }
}

/// The places lie on a segment and beside it, on the hull and inside it.
#[test]
fn a_parted_segment_leaves_what_is_built_with_its_parts() {
    let (mut parted, mut on_hull) = (0, 0);
    for (seed, mut scene) in scenes() {
        let first = scene.points.len();
        scene.points.extend([(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)].map(|(x, y)| Point::new(x, y)));
        scene.segments.extend([0, 1, 2, 3].map(|k| [first + k, first + (k + 1) % 4]));
        let mut rng = Rng::new(seed);
        for (i, &[a, b]) in scene.segments.iter().enumerate() {
            let [x, y] = [scene.points[a], scene.points[b]];
            let bulge = if rng.below(2) == 0 { 0.0 } else { rng.between(-0.2, 0.2) };
            let p = x.lerp(y, rng.between(0.3, 0.7)) + bulge * Vec2::new(y.y - x.y, x.x - y.x);
            let mut built = scene.build();
            let side = built.topology().side_between(VertexId::from_index(a), VertexId::from_index(b)).unwrap();
            if !built.can_part(side, p) {
                continue;
            }
            let subcurves = [i, scene.segments.len()].map(SubcurveId::from_index);
            let v = built.part(side, p, subcurves);
            assert_eq!(built.flaws(), Vec::<String>::new(), "seed {seed}: segment {a} {b} at {p:?}");
            let mut with = Scene { points: scene.points.clone(), segments: scene.segments.clone() };
            with.points.push(p);
            with.segments[i] = [a, v.index()];
            with.segments.push([v.index(), b]);
            assert_eq!(triangles(&built), triangles(&with.build()), "seed {seed}: segment {a} {b} at {p:?}");
            for (end, subcurve) in [a, b].into_iter().zip(subcurves) {
                let part = built.topology().side_between(v, VertexId::from_index(end)).unwrap();
                assert_eq!(built.topology().subcurve(part), Some(subcurve));
            }
            parted += 1;
            on_hull += usize::from(a >= first);
        }
    }
    assert!(parted > 500 && on_hull > 100, "{parted} parted, {on_hull} on the hull");
}

#[test]
fn a_removed_vertex_of_any_degree_leaves_what_is_built_without_it() {
    for degree in [3, 4, 5, 8, 40] {
        // A ring around the vertex, no four points on a circle;
        let mut rng = Rng::new(degree);
        let mut points: Vec<Point> = (0..degree)
            .map(|k| {
                let angle = std::f64::consts::TAU * k as f64 / degree as f64;
                Point::ORIGIN + crate::geometry::direction(angle) * rng.between(1.0, 1.01)
            })
            .collect();
        points.extend([Point::new(-9.0, -7.0), Point::new(8.0, -6.0), Point::new(1.0, 11.0)]);
        let segments = (0..degree as usize).map(|k| [k, (k + 1) % degree as usize]).collect();
        let without = Scene { points: points.clone(), segments };
        points.push(Point::new(1e-3, 2e-3));
        let with = Scene { points, segments: without.segments.clone() };
        let mut built = with.build();
        let center = VertexId::from_index(with.points.len() - 1);
        assert_eq!(built.topology().sides_from(center).count(), degree as usize);
        built.remove(center);
        assert_eq!(triangles(&built), triangles(&without.build()), "degree {degree}");
    }
}

#[test]
fn a_segment_that_is_blocked_changes_nothing() {
    let at = |x: f64, y: f64| Point::new(x, y);
    let points = vec![at(0.0, 0.0), at(4.0, 0.0), at(2.0, 0.0), at(3.0, -1.0), at(3.0, 1.0), at(1.0, 3.0)];
    let mut built = Constrained::new(points).unwrap();
    let [a, b, on, below, above, _] = [0, 1, 2, 3, 4, 5].map(VertexId);
    built.join(below, above, SubcurveId(7)).unwrap();
    let before = triangles(&built);
    assert_eq!(built.join(a, b, SubcurveId(8)), Err(Obstacle::Vertex(on)));
    assert_eq!(built.join(on, b, SubcurveId(8)), Err(Obstacle::Subcurve(SubcurveId(7))));
    assert_eq!(triangles(&built), before);
}

#[test]
fn sight_agrees_with_every_segment_asked() {
    let (mut seen, mut hidden) = (0, 0);
    for (seed, scene) in scenes() {
        let mut built = scene.build();
        for &[a, b] in &scene.segments {
            let side = built.topology().side_between(VertexId::from_index(a), VertexId::from_index(b)).unwrap();
            let [x, y] = [scene.points[a], scene.points[b]];
            let mut in_circle = Vec::new();
            for (v, &p) in scene.points.iter().enumerate().filter(|&(v, _)| v != a && v != b) {
                let left = orient(x, y, p) == Orientation::CounterClockwise;
                let side = if left { side } else { built.topology().twin(side) };
                let sees = scene.sees(p, [x, y]);
                let v = VertexId::from_index(v);
                assert_eq!(built.sees(v, side), sees, "seed {seed}: {v:?}, segment {a} {b}");
                assert_eq!(built.makes_out(v, side), sees, "seed {seed}: {v:?}, segment {a} {b}");
                *if sees { &mut seen } else { &mut hidden } += 1;
                if sees && in_diametral(x, y, p) == CircleSide::Inside {
                    in_circle.push(v);
                }
            }
            let found: [Vec<VertexId>; 2] = [side, built.topology().twin(side)].map(|s| {
                let inside = built.in_half_circle(s);
                inside.into_iter().filter(|&v| built.sees(v, s)).collect()
            });
            let mut found = found.concat();
            found.sort_unstable();
            assert_eq!(found, in_circle, "seed {seed}: segment {a} {b}");
        }
    }
    assert!(seen > 1000 && hidden > 1000, "{seen} seen, {hidden} hidden");
}

#[test]
fn a_line_of_sight_ends_at_the_nearest_segment() {
    let (mut free, mut blocked) = (0, 0);
    for (seed, scene) in scenes() {
        let built = scene.build();
        let mut rng = Rng::new(1000 + seed);
        for t in built.topology().triangles() {
            let [a, b, c] = built.topology().corners(t).map(|v| built.point(v));
            let from = a + ((b - a) + (c - a)) / 3.0;
            let to = Point::new(rng.between(0.2, 0.8), rng.between(0.2, 0.8));
            let share = |s: &[usize; 2]| {
                let [x, y] = s.map(|v| scene.points[v]);
                (x - from).cross(y - x) / (to - from).cross(y - x)
            };
            let crossing = scene.segments.iter().filter(|s| cross([from, to], s.map(|v| scene.points[v])));
            let nearest = crossing.min_by(|r, s| share(r).total_cmp(&share(s)));
            match (built.look_from(t, to), nearest) {
                (None, _) => {}
                (Some(Look::Blocked(s)), Some(nearest)) => {
                    let ends = [built.topology().origin(s).index(), built.topology().target(s).index()];
                    assert!(
                        ends == *nearest || [ends[1], ends[0]] == *nearest,
                        "seed {seed}: {ends:?} for {nearest:?}"
                    );
                    blocked += 1;
                }
                (Some(Look::Seen(at)), None) => {
                    let Location::Triangle(u) = at else { panic!("seed {seed}: {to:?} at {at:?}") };
                    assert_eq!(at, built.kernel().locate(to, u), "seed {seed}");
                    free += 1;
                }
                (look, nearest) => panic!("seed {seed}: {look:?}, but {nearest:?} is the nearest"),
            }
        }
    }
    assert!(free > 300 && blocked > 300, "{free} free, {blocked} blocked");
}
