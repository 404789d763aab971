//! The planar kernel against an oracle in whole numbers, on points with and without degeneracies.

use proptest::prelude::*;
use squinch::geometry::Point;
use squinch::ids::{Id, RegionId, SubcurveId, TriangleId, VertexId};
use squinch::plane::insert::{Cavity, Degenerate, Kernel, Location};
use squinch::plane::triangulation::{GHOST, HalfEdge, Triangulation};
use std::collections::BTreeSet;

type Whole = (i64, i64);

/// How whole numbers become coordinates: times a power of two after adding an offset, always exactly.
#[derive(Clone, Copy, Debug)]
struct Frame {
    offset: i64,
    exponent: i32,
}

const PLAIN: Frame = Frame { offset: 0, exponent: 0 };

/// Plain, an offset of 10⁴ to 10⁹ times the size, sizes of 1e-6 and 1e7, and neighbours one unit in the last place
/// apart.
const FRAMES: [Frame; 5] = [
    PLAIN,
    Frame { offset: 10_000_000_000, exponent: 0 },
    Frame { offset: 0, exponent: -40 },
    Frame { offset: 0, exponent: 13 },
    Frame { offset: 1 << 52, exponent: -52 },
];

impl Frame {
    fn place(self, (x, y): Whole) -> Point {
        let at = |v: i64| (self.offset + v) as f64 * 2f64.powi(self.exponent);
        Point::new(at(x), at(y))
    }

    fn place_all(self, points: &[Whole]) -> Vec<Point> {
        points.iter().map(|&p| self.place(p)).collect()
    }
}

/// A fixed sequence of whole numbers below `bound`.
struct Rng(u64);

impl Rng {
    fn below(&mut self, bound: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as i64) % bound
    }
}

fn distinct(points: impl IntoIterator<Item = Whole>) -> Vec<Whole> {
    let mut seen = BTreeSet::new();
    points.into_iter().filter(|&p| seen.insert(p)).collect()
}

fn random(n: usize, size: i64, seed: u64) -> Vec<Whole> {
    let mut rng = Rng(seed);
    distinct((0..n).map(|_| (rng.below(size), rng.below(size))))
}

fn grid(n: i64) -> Vec<Whole> {
    (0..n).flat_map(|x| (0..n).map(move |y| (x, y))).collect()
}

fn clusters() -> Vec<Whole> {
    let mut rng = Rng(5);
    distinct((0..300).map(|i| {
        let (cx, cy) = [(0, 0), (1 << 19, 77), (3000, 1 << 19)][i % 3];
        (cx + rng.below(40), cy + rng.below(40))
    }))
}

fn line_and_one() -> Vec<Whole> {
    (0..60).map(|i| (3 * ((i * 37) % 60), 5 * ((i * 37) % 60))).chain([(7, 3)]).collect()
}

/// All on the circle of radius 1105 around the origin: every pair of whole legs of that hypotenuse, with the centre or
/// without.
fn on_a_circle(centre: bool) -> Vec<Whole> {
    let r = 1105i64;
    let legs = (-r..=r).flat_map(|x| {
        let y = ((r * r - x * x) as f64).sqrt().round() as i64;
        [(x, y), (x, -y)].into_iter().filter(move |&(x, y)| x * x + y * y == r * r)
    });
    distinct(legs.chain(centre.then_some((0, 0))))
}

fn all_sets() -> Vec<(&'static str, Vec<Whole>)> {
    vec![
        ("triangle", vec![(0, 0), (5, 1), (2, 7)]),
        ("random", random(250, 1 << 20, 1)),
        ("dense", random(250, 24, 2)),
        ("grid", grid(14)),
        ("clusters", clusters()),
        ("line and one", line_and_one()),
        ("circle", on_a_circle(false)),
        ("circle and centre", on_a_circle(true)),
        ("two lines", (0..40).flat_map(|i| [(i, 0), (i, 1)]).collect()),
    ]
}

fn doubled_area(a: Whole, b: Whole, c: Whole) -> i128 {
    let (ux, uy) = (i128::from(b.0 - a.0), i128::from(b.1 - a.1));
    let (vx, vy) = (i128::from(c.0 - a.0), i128::from(c.1 - a.1));
    ux * vy - uy * vx
}

/// Positive where `d` lies inside the circle of the counter-clockwise triangle `a b c`.
fn in_circle(a: Whole, b: Whole, c: Whole, d: Whole) -> i128 {
    let row = |p: Whole| {
        let (x, y) = (i128::from(p.0 - d.0), i128::from(p.1 - d.1));
        (x, y, x * x + y * y)
    };
    let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) = (row(a), row(b), row(c));
    az * (bx * cy - cx * by) + bz * (cx * ay - ax * cy) + cz * (ax * by - bx * ay)
}

/// Doubled area of the convex hull and number of points on its border (Andrew's monotone chain).
fn hull(points: &[Whole]) -> (i128, usize) {
    let mut sorted = points.to_vec();
    sorted.sort_unstable();
    let mut chain: Vec<Whole> = Vec::new();
    for half in [sorted.clone(), sorted.iter().rev().copied().collect()] {
        let base = chain.len();
        for p in half {
            while chain.len() >= base + 2 && doubled_area(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
    }
    let sides: Vec<_> = (0..chain.len()).map(|i| (chain[i], chain[(i + 1) % chain.len()])).collect();
    let area = sides.iter().map(|&(a, b)| doubled_area(sorted[0], a, b)).sum();
    let on_border = points.iter().filter(|&&p| sides.iter().any(|&(a, b)| doubled_area(a, b, p) == 0)).count();
    (area, on_border)
}

/// Every finite triangle as sorted vertex numbers.
fn triangles(d: &Kernel) -> BTreeSet<[u32; 3]> {
    let topology = d.topology();
    let sorted = |t| {
        let mut corners = topology.corners(t).map(|v| v.0);
        corners.sort_unstable();
        corners
    };
    topology.triangles().map(sorted).collect()
}

/// Proves in whole numbers that `d` is a Delaunay triangulation of those `points` that are `here`: empty circles, all
/// points used, the hull filled exactly, Euler's number of triangles.
fn prove(name: &str, d: &Kernel, points: &[Whole], here: impl Fn(usize) -> bool) {
    assert_eq!(d.flaws(), Vec::<String>::new(), "{name}");
    let living: Vec<usize> = (0..points.len()).filter(|&i| here(i)).collect();
    let (mut area, mut used, mut count) = (0, BTreeSet::new(), 0);
    for t in d.topology().triangles() {
        let corners = d.topology().corners(t).map(Id::index);
        let [a, b, c] = corners.map(|i| points[i]);
        assert!(doubled_area(a, b, c) > 0, "{name}: {corners:?} is not counter-clockwise");
        for &i in &living {
            assert!(in_circle(a, b, c, points[i]) <= 0, "{name}: the circle of {corners:?} holds {i}");
        }
        area += doubled_area(a, b, c);
        used.extend(corners);
        count += 1;
    }
    let (whole, on_border) = hull(&living.iter().map(|&i| points[i]).collect::<Vec<_>>());
    assert_eq!(area, whole, "{name}: the triangles fill the hull");
    assert_eq!(used.into_iter().collect::<Vec<_>>(), living, "{name}: every vertex is used");
    assert_eq!(count, 2 * living.len() - 2 - on_border, "{name}: Euler's number");
}

fn prove_all(name: &str, d: &Kernel, points: &[Whole]) {
    assert_eq!(d.points().len(), points.len());
    prove(name, d, points, |_| true);
}

fn insert(d: &mut Kernel, p: Point, near: TriangleId, cavity: &mut Cavity) -> VertexId {
    let at = d.locate(p, near);
    assert!(!matches!(at, Location::Vertex(_)), "{p:?} is there already");
    d.cavity(p, at, cavity);
    d.fill(p, cavity)
}

/// Inserts the points one by one after the first three that span a triangle; vertex i is not point i, so the order is
/// returned.
fn one_by_one(points: &[Whole], frame: Frame) -> (Kernel, Vec<Whole>) {
    let third = (2..points.len()).find(|&i| doubled_area(points[0], points[1], points[i]) != 0).unwrap();
    let mut order = points.to_vec();
    order.swap(2, third);
    let mut d = Kernel::new(frame.place_all(&order[..3])).unwrap();
    let mut cavity = Cavity::default();
    for &p in &order[3..] {
        insert(&mut d, frame.place(p), TriangleId(0), &mut cavity);
    }
    (d, order)
}

#[test]
fn bulk_construction_is_delaunay() {
    for (name, points) in all_sets() {
        for frame in FRAMES {
            prove_all(name, &Kernel::new(frame.place_all(&points)).unwrap(), &points);
        }
    }
}

#[test]
fn insertion_one_by_one_is_delaunay_and_equals_bulk_where_no_four_points_are_cocircular() {
    for (name, points) in all_sets() {
        for frame in FRAMES {
            let (d, order) = one_by_one(&points, frame);
            prove_all(name, &d, &order);
            if name == "random" {
                assert_eq!(triangles(&d), triangles(&Kernel::new(frame.place_all(&order)).unwrap()));
            }
        }
    }
}

#[test]
fn the_same_points_give_the_same_ids() {
    for (_, points) in all_sets() {
        let [one, two] = [0, 1].map(|_| Kernel::new(PLAIN.place_all(&points)).unwrap());
        let ids = |d: &Kernel| d.topology().triangles().map(|t| (t, d.topology().corners(t))).collect::<Vec<_>>();
        assert_eq!(ids(&one), ids(&two));
        assert_eq!(one.counters(), two.counters());
        // Scaling by a power of two changes no bit of any mantissa.
        let scaled = Kernel::new(Frame { offset: 0, exponent: -40 }.place_all(&points)).unwrap();
        assert_eq!(ids(&one), ids(&scaled));
    }
}

#[test]
fn removing_vertices_of_any_degree_equals_never_having_had_them() {
    for (name, points) in all_sets() {
        for (frame, stride) in FRAMES.into_iter().zip([1, 3, 7, 11, 13]) {
            let mut d = Kernel::new(frame.place_all(&points)).unwrap();
            let mut here = vec![true; points.len()];
            let mut victims: Vec<usize> = (0..points.len()).collect();
            let n = victims.len();
            victims.sort_by_key(|&i| (i * stride * 7919) % n);
            for (step, &victim) in victims.iter().enumerate() {
                let rest = || here.iter().enumerate().filter(|&(i, &h)| h && i != victim).map(|(i, _)| points[i]);
                let (a, b) = (rest().next(), rest().nth(1));
                let spans = a.zip(b).is_some_and(|(a, b)| rest().any(|c| doubled_area(a, b, c) != 0));
                assert_eq!(d.remove(VertexId(victim as u32)), spans, "{name}: {victim} at step {step}");
                here[victim] &= !spans;
                if step % 40 == 0 || step + 6 > n {
                    prove(name, &d, &points, |i| here[i]);
                }
                if !spans {
                    break;
                }
            }
            // What is left takes the lost points again.
            let lost: Vec<usize> = (0..n).filter(|&i| !here[i]).take(20).collect();
            let (mut cavity, mut everything) = (Cavity::default(), points.clone());
            for &i in &lost {
                insert(&mut d, frame.place(points[i]), TriangleId(0), &mut cavity);
                everything.push(points[i]);
            }
            prove(name, &d, &everything, |i| i >= n || here[i]);
        }
    }
}

#[test]
fn removing_the_hub_of_a_wheel_leaves_its_rim() {
    let points: Vec<Whole> = on_a_circle(true);
    let mut d = Kernel::new(PLAIN.place_all(&points)).unwrap();
    let hub = VertexId(points.iter().position(|&p| p == (0, 0)).unwrap() as u32);
    assert_eq!(d.topology().sides_from(hub).count(), points.len() - 1);
    assert!(d.remove(hub));
    assert_eq!(d.topology().sides_from(hub).count(), 0);
    prove("rim", &d, &points, |i| i != hub.index());
    assert!(!d.remove(hub), "dead already");
}

#[test]
fn a_triangle_keeps_its_corners() {
    let points = [(0, 0), (4, 0), (0, 4)];
    let mut d = Kernel::new(PLAIN.place_all(&points)).unwrap();
    assert!((0..3).all(|v| !d.remove(VertexId(v))));
    assert!(!d.remove(GHOST));
    prove_all("triangle", &d, &points);
}

#[test]
fn locate_tells_vertices_sides_triangles_and_the_outside_apart() {
    let points = grid(6);
    let d = Kernel::new(PLAIN.place_all(&points)).unwrap();
    let topology = d.topology();
    for near in (0..topology.triangle_capacity()).map(TriangleId::from_index).step_by(7) {
        for (i, &p) in points.iter().enumerate() {
            assert_eq!(d.locate(PLAIN.place(p), near), Location::Vertex(VertexId(i as u32)));
            let between = Point::new(p.0 as f64 + 0.5, p.1 as f64);
            match d.locate(between, near) {
                Location::HalfEdge(s) => {
                    let mut ends = [topology.origin(s), topology.target(s)].map(|v| d.point(v));
                    ends.sort_by(|a, b| a.x.total_cmp(&b.x));
                    assert_eq!(ends, [PLAIN.place(p), PLAIN.place((p.0 + 1, p.1))]);
                }
                Location::Triangle(t) => {
                    assert!(p.0 == 5 && topology.is_ghost(t), "{between:?} is beyond the last column")
                }
                Location::Vertex(v) => panic!("{between:?} is not vertex {v:?}"),
            }
            let within = Point::new(p.0 as f64 + 0.25, p.1 as f64 + 0.4);
            let Location::Triangle(t) = d.locate(within, near) else { panic!("{within:?} lies inside") };
            assert_eq!(topology.is_ghost(t), p.0 == 5 || p.1 == 5);
        }
    }
    // An id that was never given is as good as any.
    assert_eq!(d.locate(Point::new(2.0, 2.0), TriangleId(9999)), Location::Vertex(VertexId(14)));
}

#[test]
fn looking_changes_nothing_and_finds_just_the_triangles_in_conflict() {
    let points = random(120, 40, 9);
    let d = Kernel::new(PLAIN.place_all(&points)).unwrap();
    let before = triangles(&d);
    let mut cavity = Cavity::default();
    for p in random(200, 60, 10).into_iter().map(|(x, y)| (x - 10, y - 10)) {
        let at = d.locate(PLAIN.place(p), TriangleId(0));
        d.cavity(PLAIN.place(p), at, &mut cavity);
        if matches!(at, Location::Vertex(_)) {
            assert!(cavity.triangles.is_empty() && cavity.border.is_empty());
            continue;
        }
        let found: BTreeSet<_> = cavity.triangles.iter().copied().filter(|&t| !d.topology().is_ghost(t)).collect();
        let scan = d.topology().triangles().filter(|&t| {
            let [a, b, c] = d.topology().corners(t).map(|v| points[v.index()]);
            in_circle(a, b, c, p) > 0
        });
        assert_eq!(found, scan.collect());
        assert_eq!(cavity.border.len(), cavity.triangles.len() + 2);
        for (i, &s) in cavity.border.iter().enumerate() {
            let after = cavity.border[(i + 1) % cavity.border.len()];
            assert_eq!(d.topology().target(s), d.topology().origin(after), "the border is one loop");
            assert!(cavity.triangles.contains(&s.triangle()));
            assert!(!cavity.triangles.contains(&d.topology().twin(s).triangle()));
        }
    }
    assert_eq!(triangles(&d), before);
}

/// Labels of a side by its ends, so that they can be followed through changes of ids.
fn subcurves(t: &Triangulation) -> BTreeSet<(u32, u32, u32)> {
    let sides = t.triangles().flat_map(|t| (0..3).map(move |i| t.side_of(i)));
    sides.filter_map(|s| t.subcurve(s).map(|subcurve| (t.origin(s).0, t.target(s).0, subcurve.0))).collect()
}

#[test]
fn filling_carries_pieces_and_regions() {
    // A square of two regions, parted by the line x = 4 that is a chain of subcurves.
    let points: Vec<Whole> = distinct(grid(9).into_iter().filter(|p| p.0 == 4 || p.0 % 4 == 0 || p.1 % 4 == 0));
    let mut d = Kernel::new(PLAIN.place_all(&points)).unwrap();
    let on_line = |d: &Kernel, v: VertexId| d.point(v).x == 4.0;
    let all: Vec<TriangleId> = d.topology().triangles().collect();
    for t in all {
        let right = d.topology().corners(t).iter().any(|&v| d.point(v).x > 4.0);
        d.topology_mut().set_region(t, Some(RegionId(u32::from(right))));
        for s in (0..3).map(|i| t.side_of(i)) {
            let (a, b) = (d.topology().origin(s), d.topology().target(s));
            if on_line(&d, a) && on_line(&d, b) {
                let subcurve = SubcurveId(d.point(a).y.min(d.point(b).y) as u32);
                d.topology_mut().set_subcurve(s, Some(subcurve));
            }
        }
    }
    let before = subcurves(d.topology());
    assert_eq!(before.len(), 16, "eight subcurves, each from both sides");
    let mut cavity = Cavity::default();
    // Points far enough from the line to leave it alone: no cavity crosses it.
    for p in [(2.1, 2.3), (6.2, 2.1), (1.9, 6.2), (6.3, 5.7), (2.0, 2.0), (1.5, 0.0)] {
        insert(&mut d, Point::new(p.0, p.1), TriangleId(3), &mut cavity);
        assert_eq!(d.flaws(), Vec::<String>::new());
        assert_eq!(subcurves(d.topology()), before);
    }
    for t in d.topology().triangles() {
        let right = d.topology().corners(t).iter().any(|&v| d.point(v).x > 4.0);
        assert_eq!(d.topology().region(t), Some(RegionId(u32::from(right))));
    }
    let ghosts = d.topology().sides_from(GHOST).map(HalfEdge::triangle);
    assert!(ghosts.into_iter().all(|t| d.topology().region(t).is_none()));
    // Removal keeps the subcurves of other sides too.
    let last = d.points().len() as u32 - 1;
    for v in last - 5..=last {
        assert!(d.remove(VertexId(v)));
        assert_eq!(subcurves(d.topology()), before);
        assert_eq!(d.flaws(), Vec::<String>::new());
    }
    let s = d.topology().triangles().map(|t| t.side_of(0)).find(|&s| d.topology().subcurve(s).is_some());
    if let Some(s) = s {
        d.topology_mut().set_subcurve(s, None);
        assert_eq!(subcurves(d.topology()).len(), before.len() - 2, "a subcurve goes from both twins");
    }
}

#[test]
fn flips_between_cocircular_points_are_no_flaw_and_others_are_found() {
    let mut d = Kernel::new(PLAIN.place_all(&[(0, 0), (2, 0), (2, 2), (0, 2)])).unwrap();
    let diagonal = |d: &Kernel| {
        let finite: Vec<_> = d.topology().triangles().collect();
        let twin = |s| d.topology().twin(s).triangle();
        (0..3).map(|i| finite[0].side_of(i)).find(|&s| twin(s) == finite[1]).unwrap()
    };
    let before = triangles(&d);
    let s = diagonal(&d);
    d.topology_mut().flip(s);
    assert_eq!(d.flaws(), Vec::<String>::new());
    assert_ne!(triangles(&d), before);
    let s = diagonal(&d);
    d.topology_mut().flip(s);
    assert_eq!(triangles(&d), before);

    let mut d = Kernel::new(PLAIN.place_all(&[(0, 0), (5, -1), (10, 0), (5, 1)])).unwrap();
    let s = diagonal(&d);
    d.topology_mut().flip(s);
    assert!(d.flaws().iter().any(|flaw| flaw.contains("in its circle")), "{:?}", d.flaws());
    // A flip that dents the hull and turns a triangle over.
    let mut d = Kernel::new(PLAIN.place_all(&[(0, 0), (9, 0), (0, 9)])).unwrap();
    let t = d.topology().triangles().next().unwrap();
    d.topology_mut().flip(t.side_of(0));
    assert!(!d.flaws().is_empty());
}

#[test]
fn a_walk_through_a_triangulation_spoilt_by_flips_still_ends() {
    let points = random(200, 1000, 4);
    let mut d = Kernel::new(PLAIN.place_all(&points)).unwrap();
    let mut rng = Rng(8);
    let n = d.topology().triangle_capacity() as i64;
    let mut flips = 0;
    while flips < 300 {
        let s = HalfEdge(rng.below(3 * n) as u32);
        let topology = d.topology();
        let corners = [topology.origin(s), topology.target(s), topology.apex(s), topology.apex(topology.twin(s))];
        if corners.contains(&GHOST) {
            continue;
        }
        let [a, b, c, e] = corners.map(|v| points[v.index()]);
        if doubled_area(e, b, c) > 0 && doubled_area(c, a, e) > 0 {
            d.topology_mut().flip(s);
            flips += 1;
        }
    }
    assert_eq!(d.topology().flaws(), Vec::<String>::new());
    for (i, &p) in points.iter().enumerate() {
        assert_eq!(d.locate(PLAIN.place(p), TriangleId(0)), Location::Vertex(VertexId(i as u32)));
    }
}

#[test]
fn points_without_a_triangulation_are_told_why() {
    let new = |points: &[Whole]| Kernel::new(PLAIN.place_all(points)).err();
    assert_eq!(new(&[]), Some(Degenerate::TooFew));
    assert_eq!(new(&[(0, 0), (1, 1)]), Some(Degenerate::TooFew));
    assert_eq!(new(&[(0, 0), (1, 1), (2, 2), (7, 7)]), Some(Degenerate::Collinear));
    assert_eq!(new(&[(0, 0), (1, 1), (2, 2), (1, 1)]), Some(Degenerate::Duplicate { first: 1, second: 3 }));
    assert_eq!(new(&[(3, 3); 9]), Some(Degenerate::Duplicate { first: 0, second: 1 }));
    let mut points = random(400, 1 << 20, 3);
    points[311] = points[17];
    assert_eq!(new(&points), Some(Degenerate::Duplicate { first: 17, second: 311 }));
    for bad in [f64::NAN, f64::INFINITY, 1e300, -1e-200] {
        let points = vec![Point::new(0.0, 1.0), Point::new(bad, 0.0), Point::new(1.0, 0.0)];
        assert_eq!(Kernel::new(points).err(), Some(Degenerate::OutOfRange { index: 1 }));
    }
}

#[test]
fn counters_tell_the_work_and_static_filters_settle_random_points() {
    let points = random(3000, 1 << 26, 12);
    let d = Kernel::new(PLAIN.place_all(&points)).unwrap();
    let work = d.counters();
    let n = points.len() as u64;
    // Peers need 9 in-circle tests a point in random order; a point lies in 4 to 6 circles; a walk along the curve is
    // short.
    assert!((5 * n..14 * n).contains(&work.in_circle), "{work:?}");
    assert!((3 * n..6 * n).contains(&work.cavity_triangles), "{work:?}");
    assert!(work.walk_steps < 10 * n && work.orient < 20 * n, "{work:?}");
    assert!(work.exact_fallbacks < n / 100, "{work:?}");
    let before = work.orient;
    d.locate(Point::new(5.0, 5.0), TriangleId(0));
    assert!(d.counters().orient > before);
    let grid = Kernel::new(PLAIN.place_all(&grid(20))).unwrap();
    assert!(grid.counters().exact_fallbacks > 0, "cocircular points are beyond the filter");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_whole_points_in_any_frame(
        raw in prop::collection::vec((0i64..12, 0i64..12), 3..60),
        frame in prop::sample::select(&FRAMES[..]),
        victims in prop::collection::vec(any::<prop::sample::Index>(), 0..30),
    ) {
        let points = distinct(raw);
        let Ok(mut d) = Kernel::new(frame.place_all(&points)) else {
            let flat = points.len() < 3 || points.iter().all(|&p| doubled_area(points[0], points[1], p) == 0);
            prop_assert!(flat);
            return Ok(());
        };
        prove_all("bulk", &d, &points);
        let (one, order) = one_by_one(&points, frame);
        prove_all("one by one", &one, &order);
        let mut here = vec![true; points.len()];
        for victim in victims {
            let i = victim.index(points.len());
            if here[i] && d.remove(VertexId(i as u32)) {
                here[i] = false;
                prove("removed", &d, &points, |i| here[i]);
            }
        }
    }
}
