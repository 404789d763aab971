use super::*;
use crate::curve::End;
use crate::geometry::Rect;
use std::f64::consts::{PI, TAU};

/// A fixed sequence of numbers in −1..1.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn points(next: &mut impl FnMut() -> f64, n: usize) -> Vec<Point> {
    (0..n).map(|_| Point::new(next(), next())).collect()
}

const KINDS: usize = 8;

/// A random curve in about the square −1..1.
fn some_curve(kind: usize, next: &mut impl FnMut() -> f64) -> Curve {
    let curve = match kind {
        0 => Curve::line(Point::new(next(), next()), Point::new(next(), next())),
        1 => Curve::arc(Point::new(next(), next()), 0.1 + next().abs(), PI * next(), TAU * next()),
        2 => {
            let (u, v) = (Vec2::new(next(), next()), Vec2::new(next(), next()));
            Curve::ellipse(Point::new(next(), next()), u, v, PI * next(), TAU * next())
        }
        3 => Curve::bezier(points(next, 3)),
        4 => Curve::bezier(points(next, 4)),
        5 => Curve::bezier(points(next, 7)),
        6 => Curve::rational_bezier(points(next, 4), (0..4).map(|_| 1.5 + next()).collect()),
        _ => Curve::natural_spline(&points(next, 5)),
    };
    curve.unwrap()
}

fn count_of(found: &Meetings, kind: MeetingKind) -> usize {
    found.points.iter().filter(|p| p.kind == kind).count()
}

/// Meetings, with what holds of every answer.
fn checked(a: &Curve, b: &Curve, tolerance: f64) -> Meetings {
    let found = meetings(a, b, tolerance).unwrap();
    let bounds = a.bounds().union(b.bounds());
    // Control points may be several times as large as the box; nearest points are polished to a few units of rounding.
    let allowed = tolerance.max(512.0 * f64::EPSILON * crate::geometry::magnitude(bounds));
    for p in &found.points {
        assert!((0.0..=1.0).contains(&p.t) && (0.0..=1.0).contains(&p.u), "{p:?}");
        assert!(length(a.point(p.t) - p.at) <= allowed, "{p:?}");
        assert!(length(b.point(p.u) - p.at) <= allowed, "{p:?}");
        for (t, end) in [(p.t, a.start()), (1.0 - p.t, a.end()), (p.u, b.start()), (1.0 - p.u, b.end())] {
            assert!(t == 0.0 || length(end - p.at) > allowed || a.start() == a.end() || b.start() == b.end(), "{p:?}");
        }
    }
    assert!(found.points.is_sorted_by(|p, q| p.t <= q.t));
    for o in &found.overlaps {
        assert!(o.t[0] < o.t[1]);
        for k in 0..=32 {
            let p = a.point(o.t[0] + f64::from(k) / 32.0 * (o.t[1] - o.t[0]));
            let (low, high) = (o.u[0].min(o.u[1]), o.u[0].max(o.u[1]));
            assert!(b.nearest(p, low, high).1 <= allowed, "{o:?} at {p:?}");
        }
    }
    found
}

/// Crossings of two polylines of n legs.
fn polyline_crossings(a: &Curve, b: &Curve, n: usize) -> usize {
    let sampled = |c: &Curve| (0..=n).map(|k| c.point(k as f64 / n as f64)).collect::<Vec<_>>();
    let (a, b) = (sampled(a), sampled(b));
    let side = |p: Point, q: Point, x: Point| (q - p).cross(x - p) > 0.0;
    let mut count = 0;
    for leg in a.windows(2) {
        let (p, q) = (leg[0], leg[1]);
        let near = Rect::from_points(p, q);
        for other in b.windows(2) {
            let (r, s) = (other[0], other[1]);
            let apart = r.x.max(s.x) < near.x0 || r.x.min(s.x) > near.x1 || r.y.max(s.y) < near.y0;
            if !apart && side(p, q, r) != side(p, q, s) && side(r, s, p) != side(r, s, q) {
                count += 1;
            }
        }
    }
    count
}

/// Sine of the angle between the curves at a meeting.
fn sine_at(a: &Curve, b: &Curve, p: &Meeting) -> f64 {
    let (da, db) = (a.derivative(p.t), b.derivative(p.u));
    (da.cross(db) / (length(da) * length(db))).abs()
}

#[test]
fn crossings_agree_with_polylines() {
    let mut next = numbers(1);
    let (mut compared, mut crossed) = (0, 0);
    for kind_a in 0..KINDS {
        for kind_b in 0..KINDS {
            for _ in 0..8 {
                let (a, b) = (some_curve(kind_a, &mut next), some_curve(kind_b, &mut next));
                let found = checked(&a, &b, 1e-9);
                // Near a tangential contact or an end, the polyline may err.
                if found.points.iter().any(|p| p.kind == MeetingKind::Touching || sine_at(&a, &b, p) < 0.05) {
                    continue;
                }
                let (coarse, fine) = (polyline_crossings(&a, &b, 300), polyline_crossings(&a, &b, 503));
                if coarse == fine {
                    assert_eq!(found.points.len(), fine, "{a:?} {b:?} {found:?}");
                    compared += 1;
                    crossed += fine;
                }
            }
        }
    }
    assert!(compared > 400 && crossed > 400, "{compared} {crossed}");
}

#[test]
fn cubics_cross_where_another_library_finds_them() {
    let cubic = |p: &[Point]| {
        let [from, ctrl1, ctrl2, to] = [p[0], p[1], p[2], p[3]].map(|p| lyon_geom::point(p.x, p.y));
        lyon_geom::CubicBezierSegment { from, ctrl1, ctrl2, to }
    };
    let mut next = numbers(29);
    for _ in 0..300 {
        let (p, q) = (points(&mut next, 4), points(&mut next, 4));
        let theirs = cubic(&p).cubic_intersections_t(&cubic(&q));
        let found = checked(&Curve::bezier(p).unwrap(), &Curve::bezier(q).unwrap(), 1e-12);
        assert_eq!(found.points.len(), theirs.len());
        // Theirs are not polished: dependent on the angle, good to about 1e-6.
        for meeting in &found.points {
            assert!(theirs.iter().any(|&(t, u)| (t - meeting.t).abs() + (u - meeting.u).abs() < 1e-4), "{meeting:?}");
        }
    }
}

#[test]
fn meetings_are_the_same_at_every_scale_and_place() {
    let mut next = numbers(2);
    let base: Vec<(Curve, Curve)> =
        (0..40).map(|k| (some_curve(k % KINDS, &mut next), some_curve((k / KINDS + 2) % KINDS, &mut next))).collect();
    for (a, b) in &base {
        let plain = checked(a, b, 1e-9);
        for (scale, offset) in [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e7), (1e-6, 10.0), (1e6, 1e13)] {
            let map = kurbo::Affine::translate((offset, -0.7 * offset)) * kurbo::Affine::scale(scale);
            // Seven digits of sixteen go to the offset.
            let tolerance = 1e-7 * scale;
            let moved = checked(&a.transformed(map), &b.transformed(map), tolerance);
            assert_eq!(plain.points.len(), moved.points.len(), "{scale} {offset}: {a:?} {b:?}");
            for (p, q) in plain.points.iter().zip(&moved.points) {
                assert_eq!(p.kind, q.kind);
                assert!(length(map * p.at - q.at) <= 100.0 * tolerance, "{p:?} {q:?}");
            }
        }
    }
}

#[test]
fn swapping_the_curves_swaps_the_parameters() {
    let mut next = numbers(3);
    for k in 0..64 {
        let (a, b) = (some_curve(k % KINDS, &mut next), some_curve(k / KINDS, &mut next));
        let (ab, ba) = (checked(&a, &b, 1e-9), checked(&b, &a, 1e-9));
        assert_eq!(ab.points.len(), ba.points.len());
        for p in &ab.points {
            let twin = |q: &&Meeting| (q.u - p.t).abs() < 1e-7 && (q.t - p.u).abs() < 1e-7 && q.kind == p.kind;
            assert_eq!(ba.points.iter().filter(twin).count(), 1, "{p:?} {ba:?}");
        }
    }
}

fn circle(x: f64, y: f64, r: f64) -> Curve {
    Curve::circle(Point::new(x, y), r).unwrap()
}

fn turned(curve: &Curve, angle: f64) -> Curve {
    curve.transformed(kurbo::Affine::rotate(angle))
}

/// A circle as an ellipse, for the general method.
fn round_ellipse(x: f64, y: f64, r: f64) -> Curve {
    Curve::ellipse(Point::new(x, y), Vec2::new(r, 0.0), Vec2::new(0.0, r), 0.3, TAU).unwrap()
}

#[test]
fn circles_touch_once_outside_and_inside() {
    for angle in [0.0, 0.7, 2.0, 4.0] {
        for x in [3.0, 1.0] {
            // Radii 1 and 2: outside at distance 3, inside at 1. Seams away from the contact.
            let (a, b) = (turned(&circle(0.0, 0.0, 2.0), 1.0), turned(&circle(x, 0.0, 1.0), angle));
            let b2 = turned(&round_ellipse(x, 0.0, 1.0), angle);
            for b in [b, b2] {
                for tolerance in [0.0, 1e-12, 1e-9, 1e-6] {
                    let found = checked(&a, &b, tolerance);
                    assert_eq!(found.points.len(), 1, "{angle} {x} {tolerance} {found:?}");
                    assert_eq!(found.points[0].kind, MeetingKind::Touching);
                    let place = Point::new(2.0 * libm::cos(angle), 2.0 * libm::sin(angle));
                    assert!(length(found.points[0].at - place) < 1e-3 * tolerance.max(1e-6).sqrt(), "{found:?}");
                }
            }
        }
    }
}

#[test]
fn nearly_tangent_circles_are_decided_by_the_depth() {
    let tolerance = 2e-9;
    for e in 3..=12 {
        let depth = libm::pow(10.0, -f64::from(e));
        let deep = depth > tolerance;
        for make in [circle, round_ellipse] {
            let a = turned(&circle(0.0, 0.0, 1.0), 1.0);
            let found = checked(&a, &make(2.0 - depth, 0.0, 1.0), tolerance);
            let expected = if deep { (2, 0) } else { (0, 1) };
            let counts = (count_of(&found, MeetingKind::Crossing), count_of(&found, MeetingKind::Touching));
            assert_eq!(counts, expected, "{depth} {found:?}");
            let apart = make(2.0 + depth, 0.0, 1.0);
            assert_eq!(checked(&a, &apart, tolerance).points.len(), usize::from(!deep), "{depth}");
        }
    }
}

/// `b` moved so that its point at u is `depth` to the left of a's point at t, with parallel tangents.
fn laid_on(a: &Curve, t: f64, b: &Curve, u: f64, depth: f64) -> Curve {
    let (da, db) = (a.derivative(t), b.derivative(u));
    let angle = libm::atan2(db.cross(da), db.dot(da));
    let turned = turned(b, angle);
    let target = a.point(t) + Vec2::new(-da.y, da.x) * (depth / length(da));
    turned.transformed(kurbo::Affine::translate(target - turned.point(u)))
}

#[test]
fn tangent_pairs_of_all_kinds_are_decided_by_the_depth() {
    let tolerance = 2e-9;
    let mut next = numbers(12);
    let mut seen = [0; 3];
    for k in 0..20 * KINDS * KINDS {
        let (a, b) = (some_curve(k % KINDS, &mut next), some_curve(k / KINDS % KINDS, &mut next));
        let (t, u) = (0.5 + 0.3 * next(), 0.5 + 0.3 * next());
        let depth = libm::pow(10.0, -3.0 - (k % 10) as f64) * next().signum();
        let b = laid_on(&a, t, &b, u, depth);
        let bending = b.curvature(u) - a.curvature(t);
        // The quadratic part of the gap is to govern it up to both crossings, inside both curves.
        let half = (2.0 * (depth / bending).abs()).sqrt();
        let room = 0.05 * length(a.derivative(t)).min(length(b.derivative(u)));
        let bound = 0.2 / (1.0 + a.curvature(t).abs() + b.curvature(u).abs());
        let bending_at = |along: f64| {
            let (dt, du) = (along / length(a.derivative(t)), along / length(b.derivative(u)));
            b.curvature(u + du) - a.curvature(t + dt)
        };
        let changes = [-4.0, -2.0, 2.0, 4.0].iter().any(|k| (bending_at(k * half) / bending - 1.0).abs() > 0.3);
        if bending.abs() < 0.1 || 4.0 * half > room.min(bound) || changes {
            continue;
        }
        let expected = match (depth.abs() > tolerance, depth * bending < 0.0) {
            (false, _) => vec![MeetingKind::Touching],
            (true, true) => vec![MeetingKind::Crossing; 2],
            (true, false) => vec![],
        };
        let found = checked(&a, &b, tolerance);
        let place = a.point(t);
        let near = |p: &&Meeting| length(p.at - place) < 2.0 * half && (p.t - t).abs().max((p.u - u).abs()) < 0.1;
        let kinds: Vec<MeetingKind> = found.points.iter().filter(near).map(|p| p.kind).collect();
        assert_eq!(kinds, expected, "{k} {depth} {bending} {half} {found:?}\n{a:?}\n{b:?} {t} {u}");
        seen[expected.len()] += 1;
    }
    assert!(seen.iter().all(|&n| n > 10), "{seen:?}");
}

#[test]
fn a_bend_narrower_than_the_tolerance_hides_no_crossing() {
    let at = |x: f64, y: f64| Point::new(x, y);
    let hooked =
        Curve::bezier(vec![at(2786.0, 4676.0), at(2839.0, 4688.0), at(3032.0, 4963.0), at(3032.0, 4964.0)]).unwrap();
    let other = Curve::bezier(vec![at(3026.0, 4945.0), at(3026.0, 4945.0), at(3027.07, 4964.63), at(3028.42, 4991.15)])
        .unwrap();
    for tolerance in [1e-9, 1e-2, 0.3, 0.42, 1.0] {
        assert_eq!(count_of(&checked(&hooked, &other, tolerance), MeetingKind::Crossing), 1, "{tolerance}");
    }
}

fn parabola() -> Curve {
    // y = x² over −1..1
    Curve::bezier(vec![Point::new(-1.0, 1.0), Point::new(0.0, -1.0), Point::new(1.0, 1.0)]).unwrap()
}

fn cubic_flex() -> Curve {
    // y = x³ over −1..1
    let third = 1.0 / 3.0;
    Curve::bezier(vec![Point::new(-1.0, -1.0), Point::new(-third, 1.0), Point::new(third, -1.0), Point::new(1.0, 1.0)])
        .unwrap()
}

#[test]
fn a_parabola_touches_its_tangent_once() {
    for angle in [0.0, 0.4, 1.3] {
        for tolerance in [0.0, 1e-12, 1e-9, 1e-6] {
            let line = Curve::line(Point::new(-2.0, 0.0), Point::new(1.7, 0.0)).unwrap();
            let found = checked(&turned(&parabola(), angle), &turned(&line, angle), tolerance);
            assert_eq!(found.points.len(), 1, "{found:?}");
            assert_eq!(found.points[0].kind, MeetingKind::Touching);
            assert!(length(found.points[0].at.to_vec2()) < 1e-9, "{found:?}");
        }
    }
}

#[test]
fn a_cubic_crosses_its_tangent_of_inflection_once() {
    for angle in [0.0, 0.4, 1.3] {
        for tolerance in [0.0, 1e-12, 1e-9, 1e-6] {
            let line = Curve::line(Point::new(-2.0, 0.0), Point::new(1.7, 0.0)).unwrap();
            let found = checked(&turned(&cubic_flex(), angle), &turned(&line, angle), tolerance);
            assert_eq!(found.points.len(), 1, "{angle} {tolerance} {found:?}");
            assert_eq!(found.points[0].kind, MeetingKind::Crossing);
            // The cube root of the rounding.
            assert!(length(found.points[0].at.to_vec2()) < 1e-4, "{found:?}");
        }
    }
}

#[test]
fn a_line_tangent_to_a_cubic_at_a_random_place_touches_it() {
    let mut next = numbers(4);
    for k in 0..60 {
        let cubic = some_curve(4 + k % 4, &mut next);
        let t = 0.1 + 0.4 * (1.0 + next());
        // Near an inflection, the tangent crosses nearby as well.
        if cubic.curvature(t).abs() < 0.1 {
            continue;
        }
        let (place, along) = (cubic.point(t), cubic.derivative(t));
        let line = Curve::line(place - 0.31 * along, place + 0.47 * along).unwrap();
        for tolerance in [0.0, 1e-9] {
            let found = checked(&cubic, &line, tolerance);
            let here: Vec<&Meeting> = found.points.iter().filter(|p| (p.t - t).abs() < 1e-4).collect();
            assert_eq!(here.len(), 1, "{k} {t} {found:?}");
            assert_eq!(here[0].kind, MeetingKind::Touching, "{k} {t} {found:?}");
        }
    }
}

#[test]
fn lines_meet_as_lines_do() {
    let line = |x0: f64, y0: f64, x1: f64, y1: f64| Curve::line(Point::new(x0, y0), Point::new(x1, y1)).unwrap();
    let a = line(0.0, 0.0, 4.0, 0.0);
    let cross = checked(&a, &line(1.0, -1.0, 1.0, 3.0), 1e-9);
    assert_eq!((cross.points[0].t, cross.points[0].u, cross.points[0].kind), (0.25, 0.25, MeetingKind::Crossing));
    // A T-junction with a gap and with a spur, both below the tolerance.
    for y in [-9e-10, 0.0, 9e-10] {
        let tee = checked(&a, &line(1.0, y, 1.0, 3.0), 1e-9);
        assert_eq!(tee.points.len(), 1);
        assert_eq!((tee.points[0].u, tee.points[0].kind), (0.0, MeetingKind::Touching));
        assert!((tee.points[0].t - 0.25).abs() < 1e-9);
        assert_eq!(tee.points[0].at, Point::new(1.0, y));
    }
    assert!(checked(&a, &line(1.0, 1.1e-9, 1.0, 3.0), 1e-9).points.is_empty());
    assert_eq!(checked(&a, &line(1.0, -3e-9, 1.0, 3.0), 1e-9).points[0].kind, MeetingKind::Crossing);
    // Common ends, at an angle and in line.
    for b in [line(4.0, 0.0, 5.0, 1.0), line(4.0, 0.0, 5.0, 0.0), line(4.0 + 5e-10, 5e-10, 5.0, 0.0)] {
        let corner = checked(&a, &b, 1e-9);
        assert_eq!((corner.points.len(), corner.overlaps.len()), (1, 0));
        assert_eq!((corner.points[0].t, corner.points[0].u), (1.0, 0.0));
    }
    // A shallow crossing.
    let shallow = checked(&a, &line(0.0, -1e-6, 4.0, 1e-6), 1e-9);
    assert_eq!(count_of(&shallow, MeetingKind::Crossing), 1);
    assert!((shallow.points[0].t - 0.5).abs() < 1e-9);
    // Parallel, far apart or not there at all.
    assert_eq!(checked(&a, &line(0.0, 2e-9, 4.0, 2e-9), 1e-9), Meetings::default());
    assert_eq!(checked(&a, &line(5.0, 0.0, 6.0, 0.0), 1e-9), Meetings::default());
}

#[test]
fn collinear_lines_share_what_they_share() {
    let line = |x0: f64, x1: f64| {
        let at = |x: f64| Point::new(1.0 + 3.0 * x, 2.0 - x);
        Curve::line(at(x0), at(x1)).unwrap()
    };
    for (b, t, u) in [
        (line(1.0, 3.0), [0.5, 1.0], [0.0, 0.5]),
        (line(3.0, 1.0), [0.5, 1.0], [1.0, 0.5]),
        (line(0.5, 1.5), [0.25, 0.75], [0.0, 1.0]),
        (line(3.0, -1.0), [0.0, 1.0], [0.75, 0.25]),
        (line(0.0, 2.0), [0.0, 1.0], [0.0, 1.0]),
    ] {
        let found = checked(&line(0.0, 2.0), &b, 1e-9);
        assert!(found.points.is_empty(), "{found:?}");
        assert_eq!(found.overlaps.len(), 1);
        let o = found.overlaps[0];
        for (x, y) in o.t.iter().zip(t).chain(o.u.iter().zip(u)) {
            assert!((x - y).abs() < 1e-12, "{o:?}");
        }
    }
}

#[test]
fn arcs_of_one_circle_share_up_to_two_stretches() {
    let arc = |from: f64, sweep: f64| Curve::arc(Point::new(3.0, -2.0), 1.5, from, sweep).unwrap();
    let found = checked(&arc(0.0, 2.0), &arc(1.0, 2.0), 1e-9);
    assert_eq!((found.points.len(), found.overlaps.len()), (0, 1));
    assert!((found.overlaps[0].t[0] - 0.5).abs() < 1e-12 && found.overlaps[0].t[1] == 1.0);
    assert!(found.overlaps[0].u[0] == 0.0 && (found.overlaps[0].u[1] - 0.5).abs() < 1e-12);
    let two = checked(&arc(0.0, 5.0), &arc(4.0, 5.0), 1e-9);
    assert_eq!((two.points.len(), two.overlaps.len()), (0, 2), "{two:?}");
    let against = checked(&arc(0.0, 5.0), &arc(9.0, -5.0), 1e-9);
    assert_eq!(against.overlaps.len(), 2);
    assert!(against.overlaps.iter().all(|o| o.u[0] > o.u[1]));
    // Two full circles with different seams.
    let full = checked(&arc(0.0, TAU), &arc(1.0, TAU), 1e-9);
    assert_eq!((full.points.len(), full.overlaps.len()), (0, 2), "{full:?}");
    let same = checked(&arc(0.0, TAU), &arc(0.0, TAU), 1e-9);
    assert_eq!((same.points.len(), same.overlaps.len()), (0, 1), "{same:?}");
    assert_eq!((same.overlaps[0].t, same.overlaps[0].u), ([0.0, 1.0], [0.0, 1.0]));
    // End to end they touch at both ends.
    let ring = checked(&arc(0.0, PI), &arc(PI, PI), 1e-9);
    assert_eq!((ring.points.len(), ring.overlaps.len()), (2, 0));
}

#[test]
fn a_part_of_a_curve_overlaps_the_whole() {
    let mut next = numbers(5);
    for kind in 1..KINDS {
        for (t0, t1) in [(0.0, 1.0), (0.2, 0.7), (0.0, 0.3), (0.6, 1.0)] {
            for tolerance in [0.0, 1e-9] {
                let whole = some_curve(kind, &mut next);
                let part = if t0 == 0.0 && t1 == 1.0 { whole.clone() } else { whole.part(t0, t1) };
                for (part, reversed) in [(part.clone(), false), (part.reversed(), true)] {
                    let found = checked(&whole, &part, tolerance);
                    assert_eq!(found.overlaps.len(), 1, "{kind} {t0} {t1} {tolerance} {whole:?} {found:?}");
                    let Overlap { t, u } = found.overlaps[0];
                    assert!((t[0] - t0).abs() < 1e-6 && (t[1] - t1).abs() < 1e-6, "{t:?}");
                    assert_eq!(u, if reversed { [1.0, 0.0] } else { [0.0, 1.0] });
                    // What is left are the self-meetings of the whole.
                    let selves = self_meetings(&whole, tolerance).unwrap();
                    assert!(found.points.len() <= 2 * selves.len(), "{found:?} {selves:?}");
                }
            }
        }
    }
}

#[test]
fn two_parts_of_a_curve_share_the_middle() {
    let mut next = numbers(6);
    for k in 0..40 {
        let whole = some_curve(2 + k % 6, &mut next);
        if !self_meetings(&whole, 1e-9).unwrap().is_empty() {
            continue;
        }
        let (a, b) = (whole.part(0.0, 0.6), whole.part(0.35, 1.0).reversed());
        let found = checked(&a, &b, 1e-9);
        assert_eq!(found.overlaps.len(), 1, "{found:?}");
        assert_eq!((found.overlaps[0].t[1], found.overlaps[0].u[0]), (1.0, 1.0));
        // Adjoining parts meet in the common end alone.
        let found = checked(&whole.part(0.0, 0.4), &whole.part(0.4, 1.0), 1e-9);
        let joint = found.points.iter().filter(|p| p.t == 1.0 && p.u == 0.0).count();
        assert_eq!((joint, found.overlaps.len()), (1, 0), "{found:?}");
    }
}

#[test]
fn a_spline_leaves_a_shared_stretch_at_a_knot() {
    let p = |x: f64, y: f64| Point::new(x, y);
    let clamped = [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0];
    let both = [p(0.0, 0.0), p(1.0, 0.0), p(2.0, 1.0), p(3.0, 0.0)];
    let make = |tail: [Point; 2]| Curve::nurbs(2, &clamped, &[&both[..], &tail[..]].concat(), None).unwrap();
    let (a, b) = (make([p(4.0, 1.0), p(5.0, 1.0)]), make([p(4.0, -3.0), p(5.0, 0.0)]));
    let found = checked(&a, &b, 1e-9);
    assert_eq!(found.overlaps.len(), 1, "{found:?}");
    let Overlap { t, u } = found.overlaps[0];
    assert!(t[0] == 0.0 && u[0] == 0.0);
    // The first four control points govern the first two of four spans.
    assert!((t[1] - 0.5).abs() < 1e-9 && (u[1] - 0.5).abs() < 1e-9, "{t:?} {u:?}");
}

#[test]
fn tangent_departure_from_a_common_end_is_one_meeting() {
    for tolerance in [0.0, 1e-12, 1e-9, 1e-6] {
        // Two circles tangent at their seams, inside and outside, full and in part, both kinds.
        for sweep in [TAU, PI, 1.0, -TAU, -1.0] {
            for x in [-1.0, 0.5, 4.0] {
                let r: f64 = 2.0 - x;
                let start = if r > 0.0 && x < 2.0 { 0.0 } else { PI };
                let a = Curve::arc(Point::ZERO, 2.0, 0.0, TAU).unwrap();
                let b = Curve::arc(Point::new(x, 0.0), r.abs(), start, sweep).unwrap();
                let axes = (Vec2::new(r.abs(), 0.0), Vec2::new(0.0, r.abs()));
                let c = Curve::ellipse(Point::new(x, 0.0), axes.0, axes.1, start, sweep).unwrap();
                for other in [b, c] {
                    let found = checked(&a, &other, tolerance);
                    assert_eq!((found.points.len(), found.overlaps.len()), (1, 0), "{x} {sweep} {tolerance} {found:?}");
                    assert_eq!((found.points[0].t, found.points[0].u), (0.0, 0.0));
                    assert_eq!(found.points[0].kind, MeetingKind::Touching);
                }
            }
        }
        // A parabola and a cubic that leave the origin along the axis.
        let p = |x: f64, y: f64| Point::new(x, y);
        let a = Curve::bezier(vec![p(0.0, 0.0), p(0.5, 0.0), p(1.0, 1.0)]).unwrap();
        let b = Curve::bezier(vec![p(0.0, 0.0), p(0.3, 0.0), p(0.7, 0.0), p(1.0, 2.0)]).unwrap();
        let found = checked(&a, &b, tolerance);
        let at_start = found.points.iter().filter(|p| p.t < 0.1).count();
        assert_eq!((at_start, found.points[0].t, found.points[0].u), (1, 0.0, 0.0), "{found:?}");
    }
}

#[test]
fn cubics_end_on_each_other() {
    let mut next = numbers(7);
    for k in 0..60 {
        let a = some_curve(1 + k % 7, &mut next);
        let t = 0.1 + 0.4 * (1.0 + next());
        let mut control = points(&mut next, 4);
        control[0] = a.point(t);
        let b = Curve::bezier(control).unwrap();
        let found = checked(&a, &b, 1e-9);
        let here: Vec<&Meeting> = found.points.iter().filter(|p| p.u == 0.0).collect();
        assert_eq!(here.len(), 1, "{found:?}");
        assert!((here[0].t - t).abs() < 1e-6 && here[0].kind == MeetingKind::Touching);
    }
}

#[test]
fn the_seam_of_a_closed_curve_is_met_once() {
    let line = Curve::line(Point::new(0.0, 0.0), Point::new(3.0, 0.0)).unwrap();
    for closed in [circle(0.0, 0.0, 1.0), round_ellipse(0.0, 0.0, 1.0).transformed(kurbo::Affine::rotate(-0.3))] {
        let found = checked(&closed, &line, 1e-9);
        assert_eq!(found.points.len(), 1, "{found:?}");
        assert_eq!((found.points[0].t, found.points[0].kind), (0.0, MeetingKind::Touching));
        assert_eq!(checked(&line, &closed, 1e-9).points.len(), 1);
    }
}

#[test]
fn a_loop_and_an_eight_meet_themselves_once() {
    let p = |x: f64, y: f64| Point::new(x, y);
    for (scale, offset) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e7)] {
        let map = kurbo::Affine::translate((offset, offset)) * kurbo::Affine::scale(scale);
        let tolerance = 1e-9 * scale;
        let looped = Curve::bezier(vec![p(0.0, 0.0), p(3.0, 2.0), p(-2.0, 2.0), p(1.0, 0.0)]).unwrap().transformed(map);
        let found = self_meetings(&looped, tolerance).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].kind, MeetingKind::Crossing);
        assert!((found[0].t + found[0].u - 1.0).abs() < 1e-6, "{found:?}");
        assert!(length(looped.point(found[0].t) - looped.point(found[0].u)) <= tolerance.max(1e-15 * offset));
        let eight = [p(1.0, 1.0), p(-1.0, -1.0), p(-2.0, 0.0), p(-1.0, 1.0), p(1.0, -1.0), p(2.0, 0.0)];
        let eight = Curve::periodic_spline(&eight).unwrap().transformed(map);
        let found = self_meetings(&eight, tolerance).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].kind, MeetingKind::Crossing);
        assert!(length(found[0].at - map * Point::ZERO) < 1e-3 * scale);
    }
}

#[test]
fn what_does_not_meet_itself_says_so() {
    let mut next = numbers(8);
    let p = |x: f64, y: f64| Point::new(x, y);
    let drop = Curve::bezier(vec![p(0.0, 0.0), p(3.0, 2.0), p(-3.0, 2.0), p(0.0, 0.0)]).unwrap();
    let ring = Curve::periodic_spline(&[p(1.0, 0.0), p(0.0, 1.0), p(-1.0, 0.0), p(0.0, -1.0)]).unwrap();
    for curve in [drop, ring, circle(0.0, 0.0, 1.0), parabola(), cubic_flex(), some_curve(0, &mut next)] {
        assert_eq!(self_meetings(&curve, 1e-9).unwrap(), Vec::new(), "{curve:?}");
    }
}

#[test]
fn self_meetings_agree_with_polylines() {
    let mut next = numbers(9);
    let mut crossed = 0;
    for k in 0..60 {
        let curve = match k % 3 {
            0 => Curve::bezier(points(&mut next, 4)).unwrap(),
            1 => Curve::bezier(points(&mut next, 9)).unwrap(),
            _ => Curve::natural_spline(&points(&mut next, 7)).unwrap(),
        };
        let found = self_meetings(&curve, 1e-9).unwrap();
        for p in &found {
            assert!(p.t < p.u && length(curve.point(p.t) - curve.point(p.u)) <= 1e-9);
        }
        if found.iter().any(|p| sine_at(&curve, &curve, p) < 0.05 || p.kind == MeetingKind::Touching) {
            continue;
        }
        let polyline = |n: usize| {
            let at = (0..=n).map(|k| curve.point(k as f64 / n as f64)).collect::<Vec<_>>();
            let side = |i: usize, j: usize| (at[i + 1] - at[i]).cross(at[j] - at[i]) > 0.0;
            let cross = |i: usize, j: usize| side(i, j) != side(i, j + 1) && side(j, i) != side(j, i + 1);
            (0..n).map(|i| (i + 2..n).filter(|&j| cross(i, j)).count()).sum::<usize>()
        };
        let (coarse, fine) = (polyline(300), polyline(503));
        if coarse == fine {
            assert_eq!(found.len(), fine, "{curve:?} {found:?}");
            crossed += fine;
        }
    }
    assert!(crossed > 20, "{crossed}");
}

#[test]
fn curves_just_outside_the_tolerance_do_not_meet_and_end() {
    // Two arcs beside each other: 3 tolerances apart all along, generic way and closed form.
    for make in [circle, round_ellipse] {
        let (a, b) = (circle(0.0, 0.0, 1.0), make(0.0, 0.0, 1.0 + 3e-7));
        assert_eq!(meetings(&a, &b, 1e-7), Ok(Meetings::default()));
    }
}

#[test]
fn a_budget_ends_hopeless_work_with_a_place() {
    let mut next = numbers(10);
    let a = some_curve(5, &mut next);
    let b = a.transformed(kurbo::Affine::translate((0.0, 1e-13)));
    let MeetingBudget { at } = meetings(&a, &b, 0.0).unwrap_err();
    assert!(a.bounds().inflate(1e-6, 1e-6).contains(at));
}

#[test]
fn a_long_spline_overlaps_itself_reversed() {
    let points: Vec<Point> = (0..300).map(f64::from).map(|x| Point::new(x, 3.0 * libm::sin(0.7 * x))).collect();
    let spline = Curve::natural_spline(&points).unwrap();
    for tolerance in [0.0, 3e-7] {
        let found = checked(&spline, &spline.reversed(), tolerance);
        assert_eq!((found.points.len(), found.overlaps.len()), (0, 1), "{found:?}");
        assert_eq!((found.overlaps[0].t, found.overlaps[0].u), ([0.0, 1.0], [1.0, 0.0]));
    }
}

#[test]
fn flat_arcs_with_far_centers_meet_like_lines() {
    let (start, end) = (Point::new(-1.0, 0.0), Point::new(1.0, 0.0));
    for bulge in [1e-3, 1e-7, 1e-10] {
        let flat = Curve::bulge(start, end, bulge).unwrap();
        // Sagitta: bulge times half the chord, to the right of the chord.
        let line = Curve::line(Point::new(0.0, -1.0), Point::new(0.0, 1.0)).unwrap();
        let found = checked(&flat, &line, 1e-12);
        assert_eq!((found.points.len(), found.points[0].kind), (1, MeetingKind::Crossing));
        assert!(length(found.points[0].at - Point::new(0.0, -bulge)) < 1e-12, "{bulge} {found:?}");
        let chord = checked(&flat, &Curve::line(start, end).unwrap(), 1e-12);
        assert_eq!(chord.points.iter().map(|p| (p.t, p.u)).collect::<Vec<_>>(), [(0.0, 0.0), (1.0, 1.0)]);
        let same = checked(&flat, &Curve::line(start, end).unwrap(), 2.0 * bulge);
        assert_eq!((same.points.len(), same.overlaps.len()), (0, 1));
    }
}

#[test]
fn curves_that_stand_still_or_have_no_length_are_met() {
    let p = |x: f64, y: f64| Point::new(x, y);
    // The speed is 0 at both ends.
    let slow = Curve::bezier(vec![p(0.0, 0.0), p(0.0, 0.0), p(1.0, 1.0), p(1.0, 1.0)]).unwrap();
    let line = Curve::line(p(0.0, 0.0), p(1.0, 1.0)).unwrap();
    for (a, b) in [(&slow, &slow), (&slow, &line), (&line, &slow)] {
        let found = checked(a, b, 1e-9);
        assert_eq!((found.points.len(), found.overlaps.len()), (0, 1), "{found:?}");
        assert_eq!((found.overlaps[0].t, found.overlaps[0].u), ([0.0, 1.0], [0.0, 1.0]));
    }
    let corner = Curve::bezier(vec![p(0.0, 0.0), p(0.0, 0.0), p(-1.0, 0.0), p(-1.0, -2.0)]).unwrap();
    let found = checked(&slow, &corner, 1e-9);
    assert_eq!(found.points.iter().map(|p| (p.t, p.u)).collect::<Vec<_>>(), [(0.0, 0.0)]);
    let dot = Curve::bezier(vec![p(0.5, 0.5); 3]).unwrap();
    assert_eq!(meetings(&line, &dot, 1e-9).unwrap().points.len(), 1);
    assert_eq!(meetings(&dot, &dot, 1e-9).unwrap().points.len(), 1);
    assert!(meetings(&corner, &dot, 1e-9).unwrap().points.is_empty());
}

#[test]
fn a_spline_that_rests_at_a_point_does_not_meet_itself_there() {
    let (p, q) = (Point::new(0.0, 0.0), Point::new(1.0, 1.0));
    let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0];
    for points in [[p, q, q, q, q, q], [p, p, p, p, p, q]] {
        let resting = Curve::nurbs(3, &knots, &points, None).unwrap();
        assert_eq!((resting.start(), resting.end()), (p, q));
        assert!(self_meetings(&resting, 1e-12).unwrap().is_empty());
    }
    assert_eq!(Curve::nurbs(3, &knots, &[p; 6], None).unwrap().bounds().area(), 0.0);
}

#[test]
fn a_curve_does_not_meet_itself_where_it_slows_down() {
    let p = |x: f64, y: f64| Point::new(x, y);
    let slowing = Curve::bezier(vec![p(-2.249, -4.0), p(-3.999, -4.0), p(-3.999, -4.0), p(-3.999, -4.0)]).unwrap();
    for tolerance in [4e-15, 1e-12, 1e-9] {
        assert!(self_meetings(&slowing, tolerance).unwrap().is_empty(), "{tolerance}");
    }
}

#[test]
fn touching_corners_of_a_polyline_are_met() {
    let p = |x: f64, y: f64| Point::new(x, y);
    let knots = [0.0, 0.0, 1.0, 2.0, 3.0, 3.0];
    let zigzag = Curve::nurbs(1, &knots, &[p(0.0, 1.0), p(1.0, 5e-10), p(2.0, 1.0), p(3.0, 4e-10)], None).unwrap();
    let line = Curve::line(p(-1.0, 0.0), p(4.0, 0.0)).unwrap();
    let found = checked(&zigzag, &line, 1e-9);
    assert_eq!(found.points.len(), 2, "{found:?}");
    assert!((found.points[0].t - 1.0 / 3.0).abs() < 1e-8 && found.points[1].t == 1.0);
    assert_eq!(count_of(&found, MeetingKind::Touching), 2);
}

#[test]
fn twenty_thousand_random_cubic_pairs_are_quick() {
    // The bound is for a release build; unoptimised builds take a tenth of the pairs and more time each.
    let pairs = if cfg!(debug_assertions) { 1000 } else { 20_000 };
    let mut next = numbers(11);
    let curves: Vec<Curve> = (0..200).map(|_| some_curve(4, &mut next)).collect();
    let start = std::time::Instant::now();
    let mut count = 0;
    for k in 0..pairs {
        count += meetings(&curves[k % 200], &curves[(k / 200 + k) % 200], 1e-9).unwrap().points.len();
    }
    println!("{pairs} pairs, {count} meetings, {:?}", start.elapsed());
    // Under a second on an idle machine; ten times that is a fault whatever else runs.
    assert!(start.elapsed().as_secs() < 10);
    assert!(count > pairs / 2);
}

/// A curve from the origin that heads along `angle` with a handle of the length `handle` there and `far` at its other
/// end, and bends to the left; of each kind that may have handles. Reversed where `end` is.
fn with_handles(kind: usize, angle: f64, handle: f64, far: f64, end: End) -> Curve {
    let ahead = Vec2::new(libm::cos(angle), libm::sin(angle));
    let place = |x: f64, y: f64| Point::ORIGIN + ahead * x + Vec2::new(-ahead.y, ahead.x) * y;
    let (first, last) = (Point::ORIGIN, place(1.0, 0.3));
    let (near, beside) = (place(handle, 0.0), place(1.0, 0.3 - far));
    let curve = match kind {
        0 => Curve::bezier(vec![first, near, last]),
        1 => Curve::bezier(vec![first, near, beside, last]),
        2 => Curve::rational_bezier(vec![first, near, beside, last], vec![1.0, 3.0, 0.5, 2.0]),
        3 => Curve::bezier(vec![first, near, near, place(0.6, 0.1), beside, last]),
        _ => {
            let knots = [0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0];
            Curve::nurbs(3, &knots, &[first, near, place(0.6, 0.1), beside, last], None)
        }
    };
    let curve = curve.unwrap();
    if end == End::Finish { curve.reversed() } else { curve }
}

#[test]
fn a_common_end_is_one_touching_however_short_the_handles_are() {
    let handles = [[0.0, 0.0], [0.0, 0.3], [0.3, 0.0], [1e-14, 1e-11], [1e-9, 1e-9], [1e-6, 0.0], [1e-3, 1e-3]];
    let ends = [End::Start, End::Finish].map(|e| [End::Start, End::Finish].map(|f| [e, f])).concat();
    for kinds in (0..5).flat_map(|i| (0..5).map(move |j| [i, j])) {
        for (angle, handles) in [1e-2, 0.3, PI / 2.0, 2.5, PI].into_iter().flat_map(|x| handles.map(|h| (x, h))) {
            for &ends in &ends {
                for (scale, offset) in [(1.0, 0.0), (1.0, 3.0), (2f64.powi(-200), 0.0), (2f64.powi(200), 0.0)] {
                    let by = kurbo::Affine::translate((offset, offset / 7.0));
                    let curve = |k: usize, angle| {
                        with_handles(kinds[k], angle, handles[k], handles[1], ends[k]).transformed(by).scaled(scale)
                    };
                    let (a, b) = (curve(0, 0.0), curve(1, angle));
                    let found = meetings(&a, &b, 1e-9 * scale);
                    let what =
                        format!("{kinds:?}, {angle}, handles {handles:?}, {ends:?}, {scale:e}, {offset}: {found:?}");
                    let found = found.expect(&what);
                    let parameter = |end: End| f64::from(u8::from(end == End::Finish));
                    let is_end = |m: &&Meeting| [m.t, m.u] == ends.map(parameter);
                    let common = a.point(parameter(ends[0]));
                    let there = |m: &&Meeting| length(m.at - common) <= 4e-9 * scale;
                    assert_eq!(found.points.iter().filter(is_end).count(), 1, "{what}");
                    assert_eq!(found.points.iter().filter(there).count(), 1, "{what}");
                    assert!(found.overlaps.is_empty(), "{what}");
                }
            }
        }
    }
}

#[test]
fn curves_that_part_slowly_far_from_the_origin_meet_once_where_they_part() {
    // Rounding moves the gap up and down by more than it grows from one sample to the next.
    for turn in 0..60 {
        let end = Point::ORIGIN + crate::geometry::direction(0.1 * f64::from(turn));
        let [a, b] = [end - Point::ORIGIN, Point::ORIGIN - end].map(|away| Point::new(1e7, -1e7) + away);
        for bulge in [1.0 + 1e-6, 1.0 - 3e-6, 1.0 + 1e-5] {
            let [p, q] = [1.0, bulge].map(|bulge| Curve::bulge(a, b, bulge).unwrap());
            let met = meetings(&p, &q, 3.6e-8).unwrap();
            let places: Vec<[f64; 2]> = met.points.iter().map(|m| [m.t, m.u]).collect();
            assert_eq!(places, [[0.0, 0.0], [1.0, 1.0]], "{turn} {bulge}");
            assert_eq!(met.overlaps, []);
        }
    }
}
