//! The verifier passes sound meshes, and each of its checks finds the mesh that was broken for it.
//!
//! The meshes are made here: curves cut where told, nodes added where told, and every triangle whose circle is empty
//! taken.

use squinch::curve::Curve;
use squinch::domain::{ArrangeOptions, Domain, Drawing, DrawnPoint, FillRule, Seed, SeedKind};
use squinch::geometry::exact::{CircleSide, Orientation, in_circle, in_diametral, orient};
use squinch::geometry::{Point, Vec2};
use squinch::ids::{CurveId, NameId, PointId, RegionId, TriangleId, VertexId};
use squinch::mesh::quality::{Quality, boundary_measures, region_measures};
use squinch::mesh::{Ball, BallReason, CurveEdge, CurveLink, Mesh};
use squinch::promise::{EnginePromise, LoppingPromise, Promise};
use squinch::size::{Sizing, Source};
use squinch::verify::{Check, Status, Verdict, verify};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, SQRT_2};

/// Where a drawing lies: every coordinate is `offset + scale · x`.
#[derive(Clone, Copy)]
struct Place {
    scale: f64,
    offset: f64,
}

const HERE: Place = Place { scale: 1.0, offset: 0.0 };

impl Place {
    fn at(self, x: f64, y: f64) -> Point {
        Point::new(self.offset + self.scale * x, self.offset + self.scale * y)
    }
}

#[derive(Clone)]
struct Scene {
    domain: Domain,
    mesh: Mesh,
    promise: Promise,
}

impl Scene {
    fn verified(&self) -> Verdict {
        verify(Some(&self.domain), &self.mesh, &self.promise)
    }

    fn lopping(&mut self) -> &mut LoppingPromise {
        match &mut self.promise.engine {
            EnginePromise::Lopping(lopping) => lopping,
            EnginePromise::Constrained(_) => panic!("no scene is constrained"),
        }
    }
}

fn promise(angle_min_deg: f64) -> Promise {
    let lopping = LoppingPromise { beta: 0.95, arc_turning_rad: Some(FRAC_PI_3), midpoint_bisector: true };
    Promise {
        angle_min_rad: Some(angle_min_deg.to_radians()),
        sizing: Sizing::default(),
        engine: EnginePromise::Lopping(lopping),
        foreign: false,
    }
}

/// A square plate with half a disk on its right side: regions `plate` and `cap`, boundaries `wall`, `rim` and `seam`.
/// No acute corner.
fn keyhole(place: Place) -> Scene {
    keyhole_with(place, &[], &[])
}

fn keyhole_with(place: Place, inside: &[(f64, f64)], lone: &[(f64, f64)]) -> Scene {
    let mut drawing = Drawing { fill: FillRule::Regions, ..Drawing::default() };
    let at = |(x, y)| place.at(x, y);
    for (from, to) in [((0.0, 0.0), (1.0, 0.0)), ((1.0, 1.0), (0.0, 1.0)), ((0.0, 1.0), (0.0, 0.0))] {
        drawing.add(Curve::line(at(from), at(to)).unwrap(), "wall", "");
    }
    drawing.add(Curve::line(at((1.0, 0.0)), at((1.0, 1.0))).unwrap(), "seam", "");
    let half = Curve::arc(at((1.0, 0.5)), 0.5 * place.scale, -FRAC_PI_2, PI).unwrap();
    drawing.add(half.with_ends(at((1.0, 0.0)), at((1.0, 1.0))), "rim", "");
    for (name, seed) in [("plate", (0.4, 0.5)), ("cap", (1.2, 0.5))] {
        let name = drawing.names.intern(name);
        let kind = SeedKind::Region { name, max_area: None };
        drawing.seeds.push(Seed { at: at(seed), kind, entity: String::new() });
    }
    for &p in lone {
        drawing.points.push(DrawnPoint { at: at(p), name: None, entity: String::new() });
    }
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap().split_to_turning(0.5);
    let cuts = |name: &str| if name == "seam" { vec![0.5] } else { vec![] };
    let inside: Vec<Point> = inside.iter().map(|&p| at(p)).collect();
    let mesh = triangulated(&domain, cuts, &inside);
    Scene { domain, mesh, promise: promise(20.7) }
}

const WEDGE_RAD: f64 = 0.3;

/// Two spokes and an arc: the corner at the origin is 0.3 rad, less than κ, and has a ball; the other two are right
/// angles.
fn wedge(place: Place) -> Scene {
    let mut drawing = Drawing::default();
    let (apex, radius) = (place.at(0.0, 0.0), 4.0 * place.scale);
    let ends = [place.at(4.0, 0.0), place.at(4.0 * WEDGE_RAD.cos(), 4.0 * WEDGE_RAD.sin())];
    drawing.add(Curve::line(apex, ends[0]).unwrap(), "below", "");
    drawing.add(Curve::arc(apex, radius, 0.0, WEDGE_RAD).unwrap().with_ends(ends[0], ends[1]), "bow", "");
    drawing.add(Curve::line(apex, ends[1]).unwrap(), "above", "");
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap().split_to_turning(0.5);
    // The ball's radius is (√2−1) of the distance to the ends of the spokes; then shells a third farther out each.
    let d = SQRT_2 - 1.0;
    let cuts =
        |name: &str| if name == "bow" { vec![] } else { vec![d, d * d.powf(-1.0 / 3.0), d * d.powf(-2.0 / 3.0)] };
    let mut mesh = triangulated(&domain, cuts, &[]);
    let corner = domain.points().ids().find(|&p| domain.points()[p] == apex).unwrap();
    mesh.balls.push(Ball { corner, radius: d * domain.lfs0()[corner], why: BallReason::LocalFeatureSize });
    Scene { domain, mesh, promise: promise(20.7) }
}

/// The Delaunay triangles of the curves' ends, their cuts and the points inside, as far as they lie in a region. O(n⁴).
fn triangulated(domain: &Domain, cuts: impl Fn(&str) -> Vec<f64>, inside: &[Point]) -> Mesh {
    let mut mesh = Mesh { names: domain.names().clone(), ..Mesh::default() };
    mesh.regions = domain.regions().iter().map(|r| r.name).collect();
    for (p, &at) in domain.points().enumerate() {
        // A lone point is left to the test.
        if !domain.star(p).is_empty() {
            let v = mesh.nodes.push(at);
            mesh.points.push((p, v));
        }
    }
    let node: BTreeMap<PointId, VertexId> = mesh.points.iter().copied().collect();
    for (id, curve) in domain.curves().enumerate() {
        let mut last = (0.0, node[&curve.ends[0]]);
        for t in cuts(domain.name(curve.name)).into_iter().chain([1.0]) {
            let v = if t == 1.0 { node[&curve.ends[1]] } else { mesh.nodes.push(curve.curve.point(t)) };
            let link = Some(CurveLink { curve: id, t: [last.0, t] });
            mesh.edges.push(CurveEdge { nodes: [last.1, v], name: curve.name, link });
            last = (t, v);
        }
    }
    for &p in inside {
        mesh.nodes.push(p);
    }
    for triangle in delaunay(mesh.nodes.as_slice()) {
        if let Some(region) = region_of(domain, &mesh, triangle) {
            mesh.triangles.push(triangle);
            mesh.triangle_regions.push(region);
        }
    }
    mesh
}

/// Triangles with an empty circle; of four and more points on one circle, the first triangles that do not cross.
fn delaunay(points: &[Point]) -> Vec<[VertexId; 3]> {
    let n = points.len();
    let mut taken: Vec<[usize; 3]> = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                let t = match orient(points[a], points[b], points[c]) {
                    Orientation::CounterClockwise => [a, b, c],
                    Orientation::Clockwise => [a, c, b],
                    Orientation::Collinear => continue,
                };
                let [x, y, z] = t.map(|i| points[i]);
                let empty = points.iter().all(|&p| in_circle(x, y, z, p) != CircleSide::Inside);
                if empty && !taken.iter().any(|u| crossing(points, t, *u)) {
                    taken.push(t);
                }
            }
        }
    }
    taken.iter().map(|t| t.map(|i| VertexId(i as u32))).collect()
}

fn crossing(points: &[Point], t: [usize; 3], u: [usize; 3]) -> bool {
    let apart = |a, b, x, y| {
        let sides = [orient(a, b, x), orient(a, b, y)];
        sides.contains(&Orientation::Clockwise) && sides.contains(&Orientation::CounterClockwise)
    };
    (0..3).any(|i| {
        (0..3).any(|j| {
            let [a, b, x, y] = [t[i], t[(i + 1) % 3], u[j], u[(j + 1) % 3]].map(|k| points[k]);
            apart(a, b, x, y) && apart(x, y, a, b)
        })
    })
}

/// The region on this side of a chord where the triangle has one (three rounded nodes of one line span a sliver that no
/// winding number can place), else the one that winds around it.
fn region_of(domain: &Domain, mesh: &Mesh, triangle: [VertexId; 3]) -> Option<RegionId> {
    for edge in &mesh.edges {
        let sides = domain.curves()[edge.link.unwrap().curve].sides;
        for i in 0..3 {
            let (from, to) = (triangle[i], triangle[(i + 1) % 3]);
            if edge.nodes == [from, to] || edge.nodes == [to, from] {
                return sides[usize::from(edge.nodes == [to, from])];
            }
        }
    }
    let [a, b, c] = triangle.map(|v| mesh.nodes[v]);
    let centroid = a + ((b - a) + (c - a)) / 3.0;
    domain.regions().ids().find(|&r| surrounds(domain, mesh, r, centroid))
}

/// Whether the chords of a region wind around a point.
fn surrounds(domain: &Domain, mesh: &Mesh, region: RegionId, p: Point) -> bool {
    let mut winding = 0;
    for edge in &mesh.edges {
        let [left, right] = domain.curves()[edge.link.unwrap().curve].sides.map(|s| s == Some(region));
        let [a, b] = edge.nodes.map(|v| mesh.nodes[v]);
        let upward = i32::from(a.y <= p.y && p.y < b.y && orient(a, b, p) == Orientation::CounterClockwise);
        let downward = i32::from(b.y <= p.y && p.y < a.y && orient(a, b, p) == Orientation::Clockwise);
        winding += (upward - downward) * (i32::from(left) - i32::from(right));
    }
    winding != 0
}

fn check<'a>(verdict: &'a Verdict, name: &str) -> &'a Check {
    verdict.checks.iter().find(|c| c.name == name).unwrap()
}

fn broken(verdict: &Verdict) -> Vec<&'static str> {
    verdict.checks.iter().filter(|c| c.status == Status::Broken).map(|c| c.name).collect()
}

fn told(verdict: &Verdict) -> Vec<String> {
    verdict.checks.iter().flat_map(|c| c.flaws.iter().map(|f| format!("{}: {f}", c.name))).collect()
}

/// Breaks a sound scene: exactly the named checks must be broken, the first of them telling `culprit`.
#[track_caller]
fn breaks(mut scene: Scene, names: &[&str], culprit: &str, damage: impl FnOnce(&mut Scene)) {
    assert_eq!(told(&scene.verified()), [""; 0], "the scene was not sound");
    damage(&mut scene);
    let verdict = scene.verified();
    let mut expected = names.to_vec();
    let order = |name: &&str| verdict.checks.iter().position(|c| c.name == *name);
    expected.sort_by_key(order);
    assert_eq!(broken(&verdict), expected, "{:#?}", told(&verdict));
    let first = check(&verdict, names[0]);
    assert!(first.flaws.iter().any(|f| f.contains(culprit)), "{:#?}", first.flaws);
    assert!(first.broken >= first.flaws.len() && first.broken > 0 && !verdict.kept());
}

fn name(scene: &Scene, text: &str) -> NameId {
    scene.mesh.names.find(text).unwrap()
}

/// Listed edges on a boundary.
fn edges_of(scene: &Scene, boundary: &str) -> Vec<usize> {
    let name = name(scene, boundary);
    (0..scene.mesh.edges.len()).filter(|&i| scene.mesh.edges[i].name == name).collect()
}

fn node_at(scene: &Scene, x: f64, y: f64) -> VertexId {
    scene.mesh.nodes.ids().find(|&v| scene.mesh.nodes[v].distance(Point::new(x, y)) < 1e-9).unwrap()
}

fn triangle_at(scene: &Scene, x: f64, y: f64) -> TriangleId {
    let p = Point::new(x, y);
    let holds = |t: &TriangleId| {
        let [a, b, c] = scene.mesh.corners(*t);
        [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| orient(u, v, p) == Orientation::CounterClockwise)
    };
    scene.mesh.triangles.ids().find(holds).unwrap()
}

fn point_at(scene: &Scene, x: f64, y: f64) -> PointId {
    scene.domain.points().ids().find(|&p| scene.domain.points()[p].distance(Point::new(x, y)) < 1e-9).unwrap()
}

fn without_triangle(mesh: &mut Mesh, gone: TriangleId) {
    let keep = |t: &TriangleId| *t != gone;
    let triangles = mesh.triangles.ids().filter(keep).map(|t| mesh.triangles[t]).collect();
    mesh.triangle_regions = mesh.triangles.ids().filter(keep).map(|t| mesh.triangle_regions[t]).collect();
    mesh.triangles = triangles;
}

// ---- sound meshes ----

#[test]
fn sound_meshes_pass_at_every_size_and_place() {
    let places = [1.0, 1e-6, 1e7, 1e-30, 1e30].map(|scale| Place { scale, offset: 0.0 });
    let offsets = [(1.0, 1e7), (1e-6, -3e-2), (1e7, 1e14)].map(|(scale, offset)| Place { scale, offset });
    for place in places.into_iter().chain(offsets) {
        for scene in [keyhole(place), wedge(place)] {
            let verdict = scene.verified();
            assert_eq!(told(&verdict), [""; 0]);
            assert!(verdict.kept());
            let asked = verdict.checks.iter().filter(|c| c.status != Status::NotAsked);
            assert!(asked.clone().all(|c| c.checked > 0 || c.name.contains("ball") || c.name == "lfs_ratio"));
            assert_eq!(asked.count(), 13);
        }
    }
}

#[test]
fn the_checks_come_in_the_contract_s_order() {
    let names: Vec<&str> = keyhole(HERE).verified().checks.iter().map(|c| c.name).collect();
    let contract = "orientation, manifold, conforming, on_curve, curve_chain, empty_diametral, delaunay, min_angle, \
                    max_angle, ball_radius, lfs_ratio, chord_error, edge_turning, size, area, names, jacobian";
    assert_eq!(names.join(", "), contract);
}

#[test]
fn an_angle_is_proven_only_below_the_guarantee_of_the_turning() {
    let status = |scene: &Scene| check(&scene.verified(), "min_angle").status;
    // The rim's arcs turn π/7: λ = π/14, for which 14.6° are guaranteed.
    let mut scene = keyhole(HERE);
    assert_eq!(status(&scene), Status::Reached);
    scene.promise.angle_min_rad = Some(14f64.to_radians());
    assert_eq!(status(&scene), Status::Proven);
    scene.lopping().midpoint_bisector = false;
    assert_eq!(status(&scene), Status::Reached);
    // The wedge has an acute corner and so arcs of π/3: 8.594°, below that of its bow.
    let mut scene = wedge(HERE);
    scene.promise.angle_min_rad = Some(8.6f64.to_radians());
    assert_eq!(status(&scene), Status::Reached);
    scene.promise.angle_min_rad = Some(8.5f64.to_radians());
    assert_eq!(status(&scene), Status::Proven);
    scene.promise.foreign = true;
    assert_eq!(status(&scene), Status::Reached);
}

#[test]
fn a_small_angle_at_an_acute_corner_is_exempt_and_told_by_corner() {
    for arcs in [true, false] {
        let mut scene = wedge(HERE);
        scene.lopping().arc_turning_rad = arcs.then_some(FRAC_PI_3);
        let verdict = scene.verified();
        assert_eq!(told(&verdict), [""; 0]);
        let [exemption] = verdict.exempt.as_slice() else { panic!("{:?}", verdict.exempt) };
        assert_eq!((exemption.at, exemption.why), ([0.0, 0.0], "local_feature_size"));
        assert_eq!(exemption.cells, [triangle_at(&scene, 1.0, 0.1).0]);
        let asked = if arcs { Status::Reached } else { Status::NotAsked };
        assert_eq!(check(&verdict, "max_angle").status, asked);
        let quality = Quality::of(Some(&scene.domain), &scene.mesh, verdict.exempt_cells());
        assert!(quality.min_angle_deg < 20.7 && quality.min_unexcused_angle_deg > 20.7);
    }
}

#[test]
fn a_mesh_without_links_is_verified_by_where_its_nodes_lie() {
    for mut scene in [keyhole(HERE), wedge(HERE), keyhole(Place { scale: 1e-6, offset: 1e-3 })] {
        scene.promise.foreign = true;
        scene.mesh.edges.iter_mut().for_each(|e| e.link = None);
        scene.mesh.edges.reverse();
        scene.mesh.points.clear();
        scene.mesh.balls.clear();
        let verdict = scene.verified();
        assert_eq!(told(&verdict), [""; 0]);
        assert_eq!(check(&verdict, "ball_radius").status, Status::NotAsked);
        assert_eq!(check(&verdict, "curve_chain").status, Status::Proven);
        // A format without names.
        scene.mesh.edges.clear();
        let all = scene.mesh.names.intern("all");
        scene.mesh.regions = vec![all].into();
        scene.mesh.triangle_regions.iter_mut().for_each(|r| *r = RegionId(0));
        let verdict = scene.verified();
        assert_eq!(check(&verdict, "names").status, Status::NotAsked);
        assert_eq!(check(&verdict, "area").status, Status::Proven);
        // A node that left its curve.
        let rim = scene.domain.curves().iter().find(|c| !c.curve.is_straight()).unwrap().ends[0];
        let moved = scene.mesh.nodes.ids().find(|&v| scene.mesh.nodes[v] == scene.domain.points()[rim]).unwrap();
        let size = scene.domain.bounds().width();
        scene.mesh.nodes[moved] += Vec2::new(0.01, -0.01) * size;
        assert!(broken(&scene.verified()).contains(&"on_curve"));
    }
}

#[test]
fn without_a_domain_only_the_triangles_are_verified() {
    let scene = keyhole(HERE);
    let verdict = verify(None, &scene.mesh, &scene.promise);
    let asked: Vec<&str> = verdict.checks.iter().filter(|c| c.status != Status::NotAsked).map(|c| c.name).collect();
    assert_eq!(asked, ["orientation", "manifold", "delaunay", "min_angle", "max_angle"]);
    assert!(verdict.kept());
}

#[test]
fn qualities_are_those_of_the_shape() {
    let scene = keyhole(HERE);
    let verdict = scene.verified();
    let quality = Quality::of(Some(&scene.domain), &scene.mesh, verdict.exempt_cells());
    let step = PI / 7.0;
    approx::assert_relative_eq!(quality.measure, 1.0 + 7.0 * 0.125 * step.sin(), max_relative = 1e-12);
    approx::assert_relative_eq!(quality.exact_measure.unwrap(), 1.0 + PI / 8.0, max_relative = 1e-12);
    let sagitta = 0.5 * (1.0 - (0.5 * step).cos());
    approx::assert_relative_eq!(quality.max_chord_error.unwrap(), sagitta, max_relative = 1e-9);
    approx::assert_relative_eq!(quality.min_angle_deg, step.to_degrees(), max_relative = 1e-9);
    assert_eq!(quality.angle_histogram.iter().sum::<u64>() as usize, 3 * scene.mesh.triangles.len());
    let regions = region_measures(&scene.mesh);
    assert_eq!(regions.iter().map(|r| r.cells).sum::<usize>(), scene.mesh.triangles.len());
    let plate = regions.iter().find(|r| r.name == "plate").unwrap();
    approx::assert_relative_eq!(plate.measure, 1.0, max_relative = 1e-12);
    let boundaries = boundary_measures(&scene.mesh);
    let wall = boundaries.iter().find(|b| b.name == "wall").unwrap();
    assert_eq!((wall.edges, wall.length), (3, 3.0));
    assert_eq!(boundaries.iter().map(|b| b.edges).sum::<usize>(), 3 + 2 + 7);
}

// ---- broken on purpose ----

#[test]
fn orientation_finds_a_flipped_triangle() {
    // Its sides run like its neighbours', its angles and its area are negative; beside the seam it is on the wrong
    // side.
    breaks(keyhole(HERE), &["orientation", "manifold", "conforming", "min_angle", "area"], "triangle", |s| {
        let t = triangle_at(s, 0.1, 0.5);
        s.mesh.triangles[t].swap(0, 1);
    });
}

#[test]
fn manifold_finds_a_repeated_triangle_and_a_collapsed_one() {
    breaks(keyhole(HERE), &["manifold", "area"], "lies already", |s| {
        let t = triangle_at(s, 1.4, 0.51);
        let (corners, region) = (s.mesh.triangles[t], s.mesh.triangle_regions[t]);
        s.mesh.triangles.push(corners);
        s.mesh.triangle_regions.push(region);
    });
    breaks(keyhole(HERE), &["manifold", "orientation", "conforming", "min_angle"], "names a node twice", |s| {
        s.mesh.triangles.push([VertexId(0), VertexId(0), VertexId(1)]);
        s.mesh.triangle_regions.push(RegionId(0));
    });
}

#[test]
fn conforming_finds_a_hole_a_hanging_node_and_an_idle_one() {
    breaks(keyhole(HERE), &["conforming", "area"], "lies on no curve", |s| {
        let t = triangle_at(s, 0.1, 0.5);
        without_triangle(&mut s.mesh, t);
    });
    // The middle of an edge inside the plate becomes a node of one of its two triangles only.
    let hanging = &["conforming", "empty_diametral", "min_angle"];
    breaks(keyhole_with(HERE, &[(0.5, 0.5)], &[]), hanging, "lies on no curve", |s| {
        let t = triangle_at(s, 0.1, 0.5);
        let (a, b) = (node_at(s, 0.0, 1.0), node_at(s, 0.0, 0.0));
        let c = node_at(s, 0.5, 0.5);
        let middle = s.mesh.nodes.push(Point::new(0.25, 0.25));
        let region = s.mesh.triangle_regions[t];
        s.mesh.triangles[t] = [a, b, middle];
        s.mesh.triangles.push([a, middle, c]);
        s.mesh.triangle_regions.push(region);
    });
    breaks(keyhole(HERE), &["conforming"], "belongs to no triangle", |s| {
        s.mesh.nodes.push(Point::new(-5.0, 0.0));
    });
}

#[test]
fn conforming_finds_chords_that_cross() {
    let mut scene = keyhole(HERE);
    let first = scene.mesh.edges[edges_of(&scene, "rim")[3]].nodes[0];
    scene.mesh.nodes[first] = Point::new(0.7, 0.3);
    let verdict = scene.verified();
    let crossings = check(&verdict, "conforming").flaws.iter().filter(|f| f.contains(" crosses ")).count();
    assert_eq!(crossings, 2, "{:?}", told(&verdict));
}

#[test]
fn conforming_finds_a_wrong_region_and_a_missing_point() {
    breaks(keyhole(HERE), &["conforming", "area"], "has cap on its", |s| {
        let t = triangle_at(s, 0.1, 0.5);
        s.mesh.triangle_regions[t] = s.mesh.triangle_regions[triangle_at(s, 1.4, 0.51)];
    });
    // A point that the drawing wants kept, within a triangle; then as a node.
    let missing = keyhole_with(HERE, &[], &[(0.5, 0.5)]);
    let verdict = missing.verified();
    assert_eq!(broken(&verdict), ["conforming"], "{:?}", told(&verdict));
    assert!(told(&verdict)[0].contains("(0.5, 0.5) lies in a region"));
    let mut kept = keyhole_with(HERE, &[(0.5, 0.5)], &[(0.5, 0.5)]);
    kept.mesh.points.push((point_at(&kept, 0.5, 0.5), node_at(&kept, 0.5, 0.5)));
    assert_eq!(told(&kept.verified()), [""; 0]);
    // Outside every region it is nobody's business.
    assert_eq!(told(&keyhole_with(HERE, &[], &[(-1.0, 0.6)]).verified()), [""; 0]);
}

#[test]
fn on_curve_finds_a_node_that_left_its_curve_or_its_point() {
    breaks(keyhole(HERE), &["on_curve"], "from curve", |s| {
        let v = node_at(s, 1.0, 0.5);
        s.mesh.nodes[v].x += 1e-6;
    });
    breaks(keyhole(HERE), &["on_curve"], "is not point", |s| {
        let v = node_at(s, 1.0, 0.0);
        s.mesh.nodes[v].x = s.mesh.nodes[v].x.next_up();
    });
    // An edge without a place on its curve is a gap in the chain and no end of a region that the domain knows.
    breaks(keyhole(HERE), &["on_curve", "conforming", "curve_chain"], "no place on a curve", |s| {
        let i = edges_of(s, "rim")[3];
        s.mesh.edges[i].link = None;
    });
}

#[test]
fn curve_chain_finds_a_swapped_order_and_a_gap() {
    breaks(keyhole(HERE), &["curve_chain"], "the chain of curve", |s| {
        let [i, j] = edges_of(s, "seam")[..] else { panic!() };
        s.mesh.edges.swap(i, j);
    });
    breaks(keyhole(HERE), &["curve_chain"], "two groups", |s| {
        let i = edges_of(s, "seam")[1];
        let edge = s.mesh.edges.remove(i);
        let last = s.mesh.edges.len();
        let place = if i == last { 0 } else { last };
        s.mesh.edges.insert(place, edge);
    });
    breaks(keyhole(HERE), &["curve_chain", "conforming"], "has no edges", |s| {
        let i = edges_of(s, "wall")[0];
        s.mesh.edges.remove(i);
    });
}

#[test]
fn empty_diametral_finds_a_node_beside_the_edge_and_one_far_in_the_list() {
    let scene = keyhole_with(HERE, &[(0.5, 0.2)], &[]);
    let verdict = scene.verified();
    assert_eq!(broken(&verdict), ["empty_diametral"], "{:?}", told(&verdict));
    let worst = check(&verdict, "empty_diametral").worst.unwrap();
    approx::assert_relative_eq!(worst.value, 0.4, max_relative = 1e-12);
    assert_eq!(worst.at, [0.5, 0.0]);
    // A node that no triangle has, below the wall: no apex tells of it.
    breaks(keyhole(HERE), &["empty_diametral", "conforming"], "(0.5, -0.25)", |s| {
        s.mesh.nodes.push(Point::new(0.5, -0.25));
    });
    // On the circle is not inside; one ulp is.
    breaks(keyhole(HERE), &["conforming"], "", |s| {
        s.mesh.nodes.push(Point::new(0.5, -0.5));
    });
    breaks(keyhole(HERE), &["empty_diametral", "conforming"], "", |s| {
        s.mesh.nodes.push(Point::new(0.5, (-0.5f64).next_up()));
    });
}

#[test]
fn empty_diametral_agrees_with_a_scan_of_all_nodes_and_edges() {
    let mut state = 1u64;
    let mut number = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    for _ in 0..50 {
        let mut scene = keyhole(HERE);
        for _ in 0..3 {
            scene.mesh.nodes.push(Point::new(3.0 * number() - 1.0, 3.0 * number() - 1.0));
        }
        let mesh = &scene.mesh;
        let inside = |e: &CurveEdge, v: &Point| in_diametral(mesh.nodes[e.nodes[0]], mesh.nodes[e.nodes[1]], *v);
        let has_intruder = |e: &&CurveEdge| mesh.nodes.iter().any(|v| inside(e, v) == CircleSide::Inside);
        let scan = mesh.edges.iter().filter(has_intruder).count();
        assert_eq!(check(&scene.verified(), "empty_diametral").broken, scan);
    }
}

#[test]
fn delaunay_finds_a_flipped_edge() {
    breaks(keyhole_with(HERE, &[(0.55, 0.5)], &[]), &["delaunay"], "lies inside the circle", |s| {
        s.promise.angle_min_rad = None;
        let inner = node_at(s, 0.55, 0.5);
        let [a, b] = [node_at(s, 1.0, 0.0), node_at(s, 1.0, 0.5)];
        let corner = node_at(s, 0.0, 0.0);
        // The edge a–inner faces b and the far corner; it becomes b–corner.
        let first =
            s.mesh.triangles.ids().find(|&t| [a, inner, b].iter().all(|v| s.mesh.triangles[t].contains(v))).unwrap();
        let second = s
            .mesh
            .triangles
            .ids()
            .find(|&t| [a, inner, corner].iter().all(|v| s.mesh.triangles[t].contains(v)))
            .unwrap();
        s.mesh.triangles[first] = [corner, a, b];
        s.mesh.triangles[second] = [corner, b, inner];
    });
}

#[test]
fn min_angle_finds_a_small_angle_that_no_ball_exempts() {
    breaks(keyhole(HERE), &["min_angle"], "has an angle of 25.", |s| {
        s.promise.angle_min_rad = Some(26f64.to_radians())
    });
    breaks(wedge(HERE), &["min_angle"], "has an angle of 17.", |s| s.mesh.balls.clear());
    breaks(wedge(HERE), &["min_angle"], "has an angle of 17.", |s| {
        s.lopping().arc_turning_rad = None;
        s.mesh.balls.clear();
    });
    // A ball exempts only what is in it: outside the corner the angles are above 35°.
    breaks(wedge(HERE), &["min_angle"], "has an angle of 4", |s| {
        s.lopping().arc_turning_rad = None;
        s.promise.angle_min_rad = Some(50f64.to_radians());
    });
}

#[test]
fn small_triangles_that_the_user_wants_left_alone_are_told_apart() {
    let mut scene = wedge(HERE);
    scene.mesh.balls.clear();
    scene.promise.sizing.min_edge = Some(1.0);
    let verdict = scene.verified();
    assert_eq!(told(&verdict), [""; 0]);
    assert_eq!(verdict.exempt[0].why, "min_edge");
    scene.promise.sizing.min_edge = Some(0.5);
    assert_eq!(broken(&scene.verified()), ["min_angle"]);
}

#[test]
fn max_angle_finds_an_obtuse_triangle_even_in_a_ball() {
    // A node near the rim of the ball: exempt, but flat. It is in the circles of the spokes and has a node beyond the
    // rim in its own.
    breaks(wedge(HERE), &["max_angle", "delaunay", "empty_diametral"], "has an angle of 17", |s| {
        let t = triangle_at(s, 1.0, 0.1);
        let [a, b, c] = s.mesh.triangles[t];
        let d = SQRT_2 * 4.0 - 4.0;
        let inner =
            s.mesh.nodes.push(Point::new(0.98 * d * (0.5 * WEDGE_RAD).cos(), 0.98 * d * (0.5 * WEDGE_RAD).sin()));
        s.mesh.triangles[t] = [a, b, inner];
        for corners in [[b, c, inner], [c, a, inner]] {
            s.mesh.triangles.push(corners);
            s.mesh.triangle_regions.push(RegionId(0));
        }
    });
}

#[test]
fn ball_radius_finds_balls_in_the_wrong_place_too_large_or_overlapping() {
    breaks(keyhole(HERE), &["ball_radius"], "not acute", |s| {
        let corner = point_at(s, 0.0, 0.0);
        s.mesh.balls.push(Ball { corner, radius: SQRT_2 - 1.0, why: BallReason::LocalFeatureSize });
    });
    // A ball that fails exempts nothing, so the corner's small angle comes to light.
    let with_exemption = &["ball_radius", "min_angle"];
    breaks(wedge(HERE), with_exemption, "is larger than", |s| s.mesh.balls[0].radius *= 1.0 + 1e-9);
    breaks(wedge(HERE), with_exemption, "meets the ball", |s| s.mesh.balls.push(s.mesh.balls[0]));
    breaks(wedge(HERE), &["ball_radius", "lfs_ratio", "min_angle"], "is none", |s| s.mesh.balls[0].radius = f64::NAN);
}

#[test]
fn lfs_ratio_finds_a_ball_that_is_too_small_unless_a_size_limit_capped_it() {
    let shrink = |s: &mut Scene| s.mesh.balls[0].radius *= 0.99;
    breaks(wedge(HERE), &["lfs_ratio", "min_angle"], "is too small", shrink);
    breaks(wedge(HERE), &["lfs_ratio", "min_angle"], "no size asked for that", |s| {
        // Asked for, but straight spokes do not turn.
        s.promise.sizing.edge_turning_rad = Some(1.0);
        shrink(s);
        s.mesh.balls[0].why = BallReason::Size;
    });
    let mut scene = wedge(HERE);
    shrink(&mut scene);
    scene.mesh.balls[0].why = BallReason::Size;
    scene.promise.sizing.max_edge = Some(2.0 * scene.mesh.balls[0].radius);
    let verdict = scene.verified();
    assert_eq!(check(&verdict, "lfs_ratio").status, Status::Proven);
    assert_eq!((check(&verdict, "lfs_ratio").checked, check(&verdict, "lfs_ratio").exempt), (0, 1));
    // β = ½ allows down to lfs/3 with arcs.
    let mut scene = wedge(HERE);
    scene.mesh.balls[0].radius *= 0.9;
    scene.mesh.balls[0].why = BallReason::Encroached;
    scene.lopping().beta = 0.5;
    assert_eq!(check(&scene.verified(), "lfs_ratio").status, Status::Proven);
    scene.lopping().arc_turning_rad = None;
    assert_eq!(check(&scene.verified(), "lfs_ratio").status, Status::Broken);
}

#[test]
fn chord_error_and_edge_turning_are_held_to_their_limits() {
    let (sagitta, step) = (0.5 * (1.0 - (PI / 14.0).cos()), PI / 7.0);
    let mut scene = keyhole(HERE);
    scene.promise.sizing.chord_error = Some(sagitta * 1.000001);
    scene.promise.sizing.edge_turning_rad = Some(step);
    let verdict = scene.verified();
    assert_eq!(told(&verdict), [""; 0]);
    approx::assert_relative_eq!(check(&verdict, "chord_error").worst.unwrap().value, sagitta, max_relative = 1e-9);
    approx::assert_relative_eq!(check(&verdict, "edge_turning").worst.unwrap().value, step, max_relative = 1e-9);
    breaks(keyhole(HERE), &["chord_error"], "lies 0.01", |s| s.promise.sizing.chord_error = Some(0.999 * sagitta));
    breaks(keyhole(HERE), &["edge_turning"], "turns 0.44", |s| s.promise.sizing.edge_turning_rad = Some(0.999 * step));
}

#[test]
fn size_holds_each_limit_where_it_was_asked() {
    let source = |source: Source| move |s: &mut Scene| s.promise.sizing.sources.push(source);
    let near = |edge| Source::Near { from: Point::new(0.0, 0.0), to: Point::new(0.0, 1.0), edge, grade: 0.5 };
    breaks(keyhole(HERE), &["size"], "times as large", |s| s.promise.sizing.max_edge = Some(1.0));
    breaks(keyhole(HERE), &["size"], "times as large", |s| s.promise.sizing.max_area = Some(0.3));
    breaks(keyhole(HERE), &["size"], "times as long", source(Source::Boundary { name: "wall".into(), edge: 0.9 }));
    breaks(keyhole(HERE), &["size"], "times as large", source(Source::Region { name: "plate".into(), edge: 0.9 }));
    breaks(keyhole(HERE), &["size"], "times as large", source(near(0.5)));
    let mut scene = keyhole(HERE);
    scene.promise.sizing.max_area = Some(0.5);
    // The longest edge of the plate is √5/2, of the cap ½.
    scene.promise.sizing.sources = vec![
        Source::Boundary { name: "wall".into(), edge: 1.0 },
        Source::Region { name: "cap".into(), edge: 0.5 + 1e-9 },
        near(1.0),
    ];
    let verdict = scene.verified();
    assert_eq!(told(&verdict), [""; 0]);
    assert_eq!(check(&verdict, "size").status, Status::Proven);
}

#[test]
fn area_finds_triangles_that_lie_twice_miss_or_are_of_another_region() {
    // Where everything else holds the areas cannot differ, so others always tell too.
    let plate = "\"plate\" covers";
    breaks(keyhole(HERE), &["area", "manifold"], plate, |s| {
        let t = triangle_at(s, 0.1, 0.5);
        let (corners, region) = (s.mesh.triangles[t], s.mesh.triangle_regions[t]);
        s.mesh.triangles.push(corners);
        s.mesh.triangle_regions.push(region);
    });
    breaks(keyhole(HERE), &["area", "conforming"], plate, |s| {
        let t = triangle_at(s, 0.1, 0.5);
        without_triangle(&mut s.mesh, t);
    });
    breaks(keyhole(HERE), &["area", "conforming"], plate, |s| {
        let t = triangle_at(s, 0.1, 0.5);
        s.mesh.triangle_regions[t] = s.mesh.triangle_regions[triangle_at(s, 1.4, 0.51)];
    });
}

#[test]
fn names_finds_a_wrong_name_on_an_edge_and_a_missing_one() {
    breaks(keyhole(HERE), &["names"], "its curve of \"rim\"", |s| {
        let i = edges_of(s, "rim")[0];
        s.mesh.edges[i].name = name(s, "wall");
    });
    breaks(keyhole(HERE), &["names"], "no edge is of the boundary \"seam\"", |s| {
        for i in edges_of(s, "seam") {
            s.mesh.edges[i].name = name(s, "wall");
        }
    });
    // A region of another name is another region.
    breaks(keyhole(HERE), &["names", "conforming", "area"], "no triangle is of the region \"cap\"", |s| {
        let cap = name(s, "cap");
        let other = s.mesh.names.intern("hat");
        s.mesh.regions.iter_mut().filter(|n| **n == cap).for_each(|n| *n = other);
    });
}

#[test]
fn ids_that_lead_nowhere_and_numbers_that_are_none_are_told_not_followed() {
    let damages: [fn(&mut Mesh); 8] = [
        |m| m.nodes[VertexId(0)].x = f64::NAN,
        |m| m.triangles[TriangleId(0)][1] = VertexId(99),
        |m| m.triangle_regions[TriangleId(0)] = RegionId(9),
        |m| {
            m.triangles.push([VertexId(0), VertexId(1), VertexId(2)]);
        },
        |m| m.edges[0].link.as_mut().unwrap().curve = CurveId(99),
        |m| m.edges[0].name = NameId(99),
        |m| m.points[0].0 = PointId(99),
        |m| m.balls.push(Ball { corner: PointId(99), radius: 1.0, why: BallReason::Size }),
    ];
    for damage in damages {
        let mut scene = keyhole(HERE);
        damage(&mut scene.mesh);
        let verdict = scene.verified();
        assert_eq!(broken(&verdict), ["manifold"]);
        assert!(verdict.checks.iter().all(|c| c.name == "manifold" || c.status == Status::NotAsked));
    }
    // Parameters beyond the curve, or that are no numbers, are no place on it.
    for t in [f64::NAN, -1.0, 2.0, f64::INFINITY] {
        let mut scene = keyhole(HERE);
        scene.mesh.edges[0].link.as_mut().unwrap().t[1] = t;
        assert!(broken(&scene.verified()).contains(&"on_curve"));
    }
}

#[test]
fn an_empty_mesh_of_a_domain_breaks_what_the_domain_asks_for() {
    let mut scene = keyhole(HERE);
    scene.mesh = Mesh::default();
    assert_eq!(broken(&scene.verified()), ["conforming", "curve_chain", "area", "names"]);
}
