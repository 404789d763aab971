//! Planar faces of STEP files and of truck's solids, against areas in closed form, whichever way faces, bounds and
//! edges are turned.
#![cfg(feature = "cad")]

use approx::assert_relative_eq;
use squinch::cad::truck::drawing_of_truck_face;
use squinch::domain::{ArrangeOptions, Drawing};
use squinch::geometry::space::{cross, dot, minus, times, unit};
use squinch::geometry::{Frame, Point};
use squinch::import::{self, Format, Options, step};
use squinch::mesh::Mesh;
use squinch::meshio;
use squinch::run::request::Request;
use squinch::run::{Exit, Extent, Outcome, Plan, Source, run, run_drawing};
use squinch::watch::no_clock;
use std::f64::consts::PI;
use std::fmt::Write;

// ---- writing STEP ----

/// A STEP file under way: shapes in the coordinates of a plane in space.
struct Step {
    data: String,
    count: usize,
    frame: Frame,
    /// Turned over one by one, they leave the face the same.
    turned: Turned,
    faces: Vec<usize>,
    unit: &'static str,
}

/// What may be said either way round of the same face.
#[derive(Clone, Copy, Debug, Default)]
struct Turned {
    plane: bool,
    bounds: bool,
    curves: bool,
    edges: bool,
}

fn tilted() -> Frame {
    Frame::of_plane([10.0, -4.0, 2.5], [1.0, 2.0, 3.0], [1.0, 0.0, 0.0]).unwrap()
}

fn real(value: f64) -> String {
    let text = format!("{value:?}");
    match text.split_once('e') {
        Some((digits, exponent)) if digits.contains('.') => format!("{digits}E{exponent}"),
        Some((digits, exponent)) => format!("{digits}.E{exponent}"),
        None => text,
    }
}

fn triple(v: [f64; 3]) -> String {
    format!("({},{},{})", real(v[0]), real(v[1]), real(v[2]))
}

fn truth(value: bool) -> &'static str {
    if value { ".T." } else { ".F." }
}

fn refs(ids: &[usize]) -> String {
    ids.iter().map(|id| format!("#{id}")).collect::<Vec<_>>().join(",")
}

impl Step {
    fn new(frame: Frame, turned: Turned) -> Self {
        let unit = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))";
        Self { data: String::new(), count: 0, frame, turned, faces: Vec::new(), unit }
    }

    fn add(&mut self, entity: &str) -> usize {
        self.count += 1;
        writeln!(self.data, "#{}={entity};", self.count).unwrap();
        self.count
    }

    fn place(&mut self, place: [f64; 3]) -> usize {
        self.add(&format!("CARTESIAN_POINT('',{})", triple(place)))
    }

    fn point(&mut self, p: Point) -> usize {
        self.place(self.frame.place(p))
    }

    fn vertex(&mut self, p: Point) -> usize {
        let point = self.point(p);
        self.add(&format!("VERTEX_POINT('',#{point})"))
    }

    /// A placement whose first axis is turned by an angle, seen from above or from below.
    fn placement(&mut self, center: Point, angle: f64, below: bool) -> usize {
        let Frame { x, y, .. } = self.frame;
        let axis = times(self.frame.normal(), if below { -1.0 } else { 1.0 });
        let toward: [f64; 3] = std::array::from_fn(|k| x[k] * angle.cos() + y[k] * angle.sin());
        let center = self.point(center);
        let axis = self.add(&format!("DIRECTION('',{})", triple(axis)));
        let toward = self.add(&format!("DIRECTION('',{})", triple(toward)));
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{center},#{axis},#{toward})"))
    }

    /// An edge whose curve runs from `a` to `b`, unless all is turned.
    fn edge(&mut self, name: &str, a: usize, b: usize, curve: usize) -> usize {
        let (a, b, same) = if self.turned.edges { (b, a, false) } else { (a, b, true) };
        let same = truth(same != self.turned.curves);
        self.add(&format!("EDGE_CURVE('{name}',#{a},#{b},#{curve},{same})"))
    }

    fn line(&mut self, name: &str, a: (usize, Point), b: (usize, Point)) -> usize {
        let (from, to) = if self.turned.curves { (b, a) } else { (a, b) };
        let along = unit(minus(self.frame.place(to.1), self.frame.place(from.1))).unwrap();
        let start = self.point(from.1);
        let direction = self.add(&format!("DIRECTION('',{})", triple(along)));
        let vector = self.add(&format!("VECTOR('',#{direction},1.)"));
        let line = self.add(&format!("LINE('',#{start},#{vector})"));
        self.edge(name, a.0, b.0, line)
    }

    /// Counter-clockwise about the center.
    fn arc(&mut self, name: &str, a: usize, b: usize, center: Point, radii: [f64; 2], angle: f64) -> usize {
        let at = self.placement(center, angle, self.turned.curves);
        let [u, v] = radii;
        let curve = match u == v {
            true => self.add(&format!("CIRCLE('',#{at},{})", real(u))),
            false => self.add(&format!("ELLIPSE('',#{at},{},{})", real(u), real(v))),
        };
        self.edge(name, a, b, curve)
    }

    fn nurbs(
        &mut self,
        name: &str,
        ends: [usize; 2],
        degree: usize,
        knots: &[(f64, usize)],
        net: &[(Point, f64)],
    ) -> usize {
        let mut net = net.to_vec();
        let mut knots = knots.to_vec();
        if self.turned.curves {
            let last = knots[knots.len() - 1].0;
            net.reverse();
            knots = knots.iter().rev().map(|(knot, count)| (last - knot, *count)).collect();
        }
        let points: Vec<usize> = net.iter().map(|(p, _)| self.point(*p)).collect();
        let list = |values: Vec<String>| values.join(",");
        let counts = list(knots.iter().map(|(_, count)| count.to_string()).collect());
        let values = list(knots.iter().map(|(knot, _)| real(*knot)).collect());
        let weights = list(net.iter().map(|(_, weight)| real(*weight)).collect());
        let curve = self.add(&format!(
            "(BOUNDED_CURVE()B_SPLINE_CURVE({degree},({}),.UNSPECIFIED.,.F.,.F.)B_SPLINE_CURVE_WITH_KNOTS(({counts}),\
             ({values}),.UNSPECIFIED.)CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE(({weights}))\
             REPRESENTATION_ITEM(''))",
            refs(&points)
        ));
        self.edge(name, ends[0], ends[1], curve)
    }

    /// A loop of edges in the order and sense in which they are passed.
    fn bound(&mut self, edges: &[usize]) -> usize {
        let mut edges = edges.to_vec();
        let along = !self.turned.bounds;
        if !along {
            edges.reverse();
        }
        let sense = truth(along != self.turned.edges);
        let oriented: Vec<usize> =
            edges.iter().map(|edge| self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{sense})"))).collect();
        let path = self.add(&format!("EDGE_LOOP('',({}))", refs(&oriented)));
        self.add(&format!("FACE_BOUND('',#{path},{})", truth(along)))
    }

    fn face(&mut self, name: &str, bounds: &[usize]) {
        let at = self.placement(Point::new(-1.0, 0.5), 0.3, self.turned.plane);
        let plane = self.add(&format!("PLANE('',#{at})"));
        let same = truth(!self.turned.plane);
        let face = self.add(&format!("ADVANCED_FACE('{name}',({}),#{plane},{same})", refs(bounds)));
        self.faces.push(face);
    }

    fn rectangle(&mut self, [x0, y0, x1, y1]: [f64; 4], names: [&str; 4]) -> usize {
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| Point::new(x, y));
        let at = corners.map(|p| (self.vertex(p), p));
        let edges: Vec<usize> = (0..4).map(|i| self.line(names[i], at[i], at[(i + 1) % 4])).collect();
        self.bound(&edges)
    }

    fn hole(&mut self, name: &str, center: Point, radius: f64) -> usize {
        let start = self.vertex(center + radius * kurbo::Vec2::from_angle(0.7));
        let rim = self.arc(name, start, start, center, [radius; 2], 0.0);
        self.bound(&[rim])
    }

    fn text(mut self) -> String {
        let faces = refs(&self.faces.clone());
        let shell = self.add(&format!("OPEN_SHELL('',({faces}))"));
        let model = self.add(&format!("SHELL_BASED_SURFACE_MODEL('',(#{shell}))"));
        let base = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let inch = self.add(&format!("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{base})"));
        let length = self.add(&self.unit.replace("#inch", &format!("#{inch}")));
        let exact = self.add(&format!("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),#{length},'','')"));
        let context = self.add(&format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{exact}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length}))REPRESENTATION_CONTEXT('',''))"
        ));
        self.add(&format!("MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#{model}),#{context})"));
        format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n\
             FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
            self.data
        )
    }
}

// ---- reading and meshing ----

fn read(text: &str) -> Drawing {
    step::read(text.as_bytes(), "part", None).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refused(text: &str, face: Option<&str>) -> import::ImportError {
    step::read(text.as_bytes(), "part", face).expect_err("refused")
}

fn area_of(drawing: &Drawing) -> f64 {
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    domain.regions().iter().map(|region| region.area).sum()
}

fn every_turn() -> impl Iterator<Item = Turned> {
    let bit = |n: u8, k: u8| n >> k & 1 == 1;
    (0..16).map(move |n| Turned { plane: bit(n, 0), bounds: bit(n, 1), curves: bit(n, 2), edges: bit(n, 3) })
}

/// Every turn of a shape has the area, and the normal of the plane looks out of the solid, whatever the plane's own
/// does.
fn has_area(wanted: f64, shape: impl Fn(&mut Step)) {
    for turned in every_turn() {
        let mut step = Step::new(tilted(), turned);
        shape(&mut step);
        let text = step.text();
        let drawing = read(&text);
        assert_relative_eq!(drawing.faces[0].area.unwrap(), wanted, max_relative = 1e-9);
        assert_relative_eq!(area_of(&drawing), wanted, max_relative = 1e-9);
        let normal = drawing.frame.unwrap().normal();
        assert!(dot(normal, tilted().normal()) > 1.0 - 1e-12, "{turned:?}");
        assert_eq!(drawing.notes, Vec::<String>::new(), "{turned:?}");
    }
}

fn meshed(text: &str, request: &Request) -> Outcome {
    let source = Source { path: "part.step", bytes: text.as_bytes(), format: None, nodes: None, of_many: false };
    let outcome = run(&source, request, Extent::Whole(&mut |_| true), &no_clock);
    assert_eq!(outcome.exit, Exit::Done, "{:?}", outcome.report.failure);
    outcome
}

fn plate(turned: Turned) -> Step {
    let mut step = Step::new(tilted(), turned);
    let rim = step.rectangle([0.0, 0.0, 4.0, 3.0], ["foot", "right", "", "left"]);
    let hole = step.hole("bore", Point::new(2.5, 1.5), 0.5);
    step.face("plate", &[hole, rim]);
    step
}

fn vtu_of(outcome: &Outcome) -> Vec<u8> {
    let mesh = outcome.mesh.as_ref().unwrap();
    meshio::encode(mesh, &[], meshio::Format::Vtu, &meshio::WriteOptions::default()).unwrap().concat()
}

fn names(mesh: &Mesh) -> Vec<&str> {
    mesh.names.iter().map(|(_, name)| name).collect()
}

// ---- areas ----

#[test]
fn a_plate_with_a_hole_has_its_area_whichever_way_it_is_turned() {
    has_area(12.0 - PI / 4.0, |step| {
        let rim = step.rectangle([0.0, 0.0, 4.0, 3.0], ["a", "b", "c", "d"]);
        let hole = step.hole("bore", Point::new(2.5, 1.5), 0.5);
        step.face("plate", &[rim, hole]);
    });
}

#[test]
fn a_slot_with_arcs_at_its_ends_has_its_area() {
    let (length, radius) = (5.0, 1.25);
    has_area(2.0 * radius * length + PI * radius * radius, |step| {
        let corners =
            [(0.0, -radius), (length, -radius), (length, radius), (0.0, radius)].map(|(x, y)| Point::new(x, y));
        let at = corners.map(|p| (step.vertex(p), p));
        let edges = [
            step.line("foot", at[0], at[1]),
            step.arc("right", at[1].0, at[2].0, Point::new(length, 0.0), [radius; 2], 2.0),
            step.line("head", at[2], at[3]),
            step.arc("left", at[3].0, at[0].0, Point::ORIGIN, [radius; 2], -1.0),
        ];
        let bound = step.bound(&edges);
        step.face("slot", &[bound]);
    });
}

#[test]
fn ellipses_have_their_areas_whole_and_cut() {
    let (u, v, angle): (f64, f64, f64) = (3.0, 0.75, 0.4);
    let at = |theta: f64| {
        let (sin, cos) = angle.sin_cos();
        let (a, b) = (u * theta.cos(), v * theta.sin());
        Point::new(a * cos - b * sin, a * sin + b * cos)
    };
    has_area(PI * u * v, |step| {
        let start = step.vertex(at(1.0));
        let rim = step.arc("rim", start, start, Point::ORIGIN, [u, v], angle);
        let bound = step.bound(&[rim]);
        step.face("ellipse", &[bound]);
    });
    // The part from θ = 0.5 to 4 less its chord: ½ uv (Δ − sin Δ).
    let (from, to): (f64, f64) = (0.5, 4.0);
    has_area(0.5 * u * v * (to - from - (to - from).sin()), |step| {
        let [a, b] = [at(from), at(to)].map(|p| (step.vertex(p), p));
        let arc = step.arc("arc", a.0, b.0, Point::ORIGIN, [u, v], angle);
        let chord = step.line("chord", b, a);
        let bound = step.bound(&[arc, chord]);
        step.face("segment", &[bound]);
    });
}

#[test]
fn parabolas_and_hyperbolas_are_exact() {
    // The chord from t = −1 to t = 2 cuts F² Δ³ / 3 off the parabola (F t², 2 F t).
    let focal = 0.6;
    let on = |t: f64| Point::new(focal * t * t, 2.0 * focal * t);
    let cut = |step: &mut Step, from: Point, to: Point, curve: usize| {
        let [a, b] = [from, to].map(|p| (step.vertex(p), p));
        let conic = step.edge("conic", a.0, b.0, curve);
        let chord = step.line("chord", b, a);
        let bound = step.bound(&[conic, chord]);
        step.face("segment", &[bound]);
    };
    has_area(focal * focal * 27.0 / 3.0, |step| {
        let at = step.placement(Point::ORIGIN, 0.0, step.turned.curves);
        let curve = step.add(&format!("PARABOLA('',#{at},{})", real(focal)));
        cut(step, on(-1.0), on(2.0), curve);
    });
    // x = a cosh t, y = b sinh t between t = −0.5 and 1: the sector a b Δ/2 taken from its triangle.
    let (a, b) = (1.5, 0.8);
    let on = |t: f64| Point::new(a * t.cosh(), b * t.sinh());
    let (p, q) = (on(-0.5), on(1.0));
    let wanted = 0.5 * (p.x * q.y - p.y * q.x) - 0.5 * a * b * 1.5;
    has_area(wanted, |step| {
        let at = step.placement(Point::ORIGIN, 0.0, step.turned.curves);
        let curve = step.add(&format!("HYPERBOLA('',#{at},{},{})", real(a), real(b)));
        cut(step, p, q, curve);
    });
}

/// Control points with their weights.
type Net = Vec<(Point, f64)>;
/// Distinct knots with their multiplicities.
type Knots = Vec<(f64, usize)>;

/// A circle of radius 2 as four rational quadratics.
fn circle_net() -> (Knots, Net) {
    let corner = 0.5_f64.sqrt();
    let around = [(2, 0), (2, 2), (0, 2), (-2, 2), (-2, 0), (-2, -2), (0, -2), (2, -2), (2, 0)];
    let weight = |i: usize| if i.is_multiple_of(2) { 1.0 } else { corner };
    let net = around.iter().enumerate().map(|(i, (x, y))| (Point::new(f64::from(*x), f64::from(*y)), weight(i)));
    (vec![(0.0, 3), (1.0, 2), (2.0, 2), (3.0, 2), (4.0, 3)], net.collect())
}

#[test]
fn rational_splines_are_kept_and_trimmed_by_their_vertices() {
    let (knots, net) = circle_net();
    let at = |angle: f64| Point::new(2.0 * angle.cos(), 2.0 * angle.sin());
    // Whole from its seam, and whole from elsewhere.
    for start in [0.0, 2.0] {
        has_area(4.0 * PI, |step| {
            let start = step.vertex(at(start));
            let rim = step.nurbs("rim", [start; 2], 2, &knots, &net);
            let bound = step.bound(&[rim]);
            step.face("disk", &[bound]);
        });
    }
    // A part, and a part across the seam; the other part is a straight chord.
    for (from, to) in [(0.3, 4.0), (5.0, 2.0 * PI + 1.5)] {
        let sweep: f64 = to - from;
        has_area(2.0 * (sweep - sweep.sin()), |step| {
            let [a, b] = [at(from), at(to)].map(|p| (step.vertex(p), p));
            let arc = step.nurbs("arc", [a.0, b.0], 2, &knots, &net);
            let chord = step.line("chord", b, a);
            let bound = step.bound(&[arc, chord]);
            step.face("segment", &[bound]);
        });
    }
}

#[test]
fn polylines_and_curves_that_stand_for_others_are_read() {
    has_area(PI * 2.0 + 8.0, |step| {
        let [a, b] = [Point::new(2.0, 0.0), Point::new(-2.0, 0.0)].map(|p| (step.vertex(p), p));
        // Half a circle over a box of 4 by 2, whose three sides are one edge.
        let at = step.placement(Point::ORIGIN, 0.0, !step.turned.curves);
        let circle = step.add(&format!("CIRCLE('',#{at},2.)"));
        let trimmed = step.add(&format!("TRIMMED_CURVE('',#{circle},(#{}),(#{}),.F.,.CARTESIAN.)", a.0, b.0));
        let arc = step.add(&format!("SURFACE_CURVE('',#{trimmed},(),.CURVE_3D.)"));
        let arc = step.edge("arc", a.0, b.0, arc);
        let mut corners = [(-2.0, 0.0), (-2.0, -2.0), (2.0, -2.0), (2.0, 0.0)].map(|(x, y)| Point::new(x, y));
        if step.turned.curves {
            corners.reverse();
        }
        let points = corners.map(|p| step.point(p));
        let sides = step.add(&format!("POLYLINE('',({}))", refs(&points)));
        let sides = step.edge("sides", b.0, a.0, sides);
        let bound = step.bound(&[arc, sides]);
        step.face("arch", &[bound]);
    });
}

#[test]
fn a_flat_spline_surface_is_a_plane_with_its_own_normal() {
    for turned in every_turn() {
        let mut step = Step::new(tilted(), turned);
        let bound = step.rectangle([0.0, 0.0, 4.0, 3.0], ["a", "b", "c", "d"]);
        let mut net = [[(-1.0, -1.0), (-1.0, 5.0)], [(6.0, -1.0), (6.0, 5.0)]];
        if turned.plane {
            net.reverse();
        }
        let rows = net.map(|row| refs(&row.map(|(x, y)| step.point(Point::new(x, y))))).map(|row| format!("({row})"));
        let surface = step.add(&format!(
            "B_SPLINE_SURFACE_WITH_KNOTS('',1,1,({}),.PLANE_SURF.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)",
            rows.join(",")
        ));
        let face = step.add(&format!("ADVANCED_FACE('sheet',(#{bound}),#{surface},{})", truth(!turned.plane)));
        step.faces.push(face);
        let drawing = read(&step.text());
        assert_relative_eq!(area_of(&drawing), 12.0, max_relative = 1e-12);
        assert!(dot(drawing.frame.unwrap().normal(), tilted().normal()) > 1.0 - 1e-12, "{turned:?}");
    }
}

#[test]
fn an_edge_that_is_passed_both_ways_is_a_slit() {
    // A ring whose inner loop hangs on the outer one by a seam.
    let mut step = Step::new(tilted(), Turned::default());
    let (outer, inner) = (Point::new(3.0, 0.0), Point::new(1.0, 0.0));
    let (o, i) = (step.vertex(outer), step.vertex(inner));
    let rim = step.arc("rim", o, o, Point::ORIGIN, [3.0; 2], 0.0);
    let bore = step.arc("bore", i, i, Point::ORIGIN, [1.0; 2], 0.0);
    let seam = step.line("seam", (o, outer), (i, inner));
    let oriented = [(rim, true), (seam, true), (bore, false), (seam, false)]
        .map(|(edge, along)| step.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{})", truth(along))));
    let path = step.add(&format!("EDGE_LOOP('',({}))", refs(&oriented)));
    let bound = step.add(&format!("FACE_OUTER_BOUND('',#{path},.T.)"));
    step.face("ring", &[bound]);
    let drawing = read(&step.text());
    assert_relative_eq!(area_of(&drawing), 8.0 * PI, max_relative = 1e-9);
    assert_relative_eq!(drawing.faces[0].area.unwrap(), 8.0 * PI, max_relative = 1e-9);
}

// ---- meshes in space ----

#[test]
fn a_meshed_face_keeps_names_and_lies_in_its_plane() {
    let text = plate(Turned::default()).text();
    let outcome = meshed(&text, &Request::default());
    let mesh = outcome.mesh.as_ref().unwrap();
    let frame = mesh.frame.unwrap();
    let off = mesh.places().map(|p| dot(minus(p, tilted().origin), tilted().normal()).abs()).fold(0.0, f64::max);
    assert!(off < 1e-13, "{off}");
    assert!(dot(frame.normal(), tilted().normal()) > 1.0 - 1e-14);
    assert_eq!(mesh.unit.as_deref(), Some("mm"));
    let names = names(mesh);
    for name in ["plate", "foot", "right", "left", "bore"] {
        assert!(names.contains(&name), "{name} of {names:?}");
    }
    assert!(names.iter().any(|name| name.starts_with("edge #")), "{names:?}");
    // The area of the triangles in space, all of them seen from outside.
    let places: Vec<[f64; 3]> = mesh.places().collect();
    let normal = tilted().normal();
    let area: f64 = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| places[v.0 as usize]);
            0.5 * dot(cross(minus(b, a), minus(c, a)), normal)
        })
        .sum();
    assert_relative_eq!(area, 12.0 - PI / 4.0, max_relative = 1e-2);
}

#[test]
fn a_mesh_file_in_space_is_read_back_into_its_plane_and_verified() {
    let text = plate(Turned::default()).text();
    let outcome = meshed(&text, &Request::default());
    let mesh = outcome.mesh.as_ref().unwrap();
    let back = meshio::read(&vtu_of(&outcome), meshio::Format::Vtu, &[]).unwrap().mesh;
    assert_eq!((&back.nodes, back.frame), (&mesh.nodes, mesh.frame));
    let drawing = read(&text);
    let arranged = drawing.arrange(&ArrangeOptions::default()).unwrap();
    let (domain, plan) = Plan::new(&drawing, &arranged, &Request::default(), &mut |_| true).unwrap();
    let (verdict, untied) = plan.verify_file(Some(&domain), &back);
    assert!(verdict.kept() && untied.is_none());
}

// ---- choosing, units, headers ----

fn two_faces() -> Step {
    let mut step = Step::new(tilted(), Turned::default());
    let small = step.rectangle([0.0, 0.0, 1.0, 1.0], ["a", "b", "c", "d"]);
    step.face("small", &[small]);
    let large = step.rectangle([0.0, 0.0, 3.0, 1.0], ["a", "b", "c", "d"]);
    step.face("", &[large]);
    step
}

#[test]
fn the_largest_face_is_read_unless_another_is_asked_for() {
    let step = two_faces();
    let [small, large] = [step.faces[0] as u64, step.faces[1] as u64];
    let text = step.text();
    let drawing = read(&text);
    assert_relative_eq!(area_of(&drawing), 3.0, max_relative = 1e-12);
    assert!(drawing.notes[0].contains(&format!("#{small} small (area ")), "{:?}", drawing.notes);
    let ids: Vec<u64> = step::faces(text.as_bytes()).unwrap().iter().map(|face| face.id).collect();
    assert_eq!(ids, [small, large]);
    for wanted in ["small", &format!("#{small}"), &small.to_string()] {
        let drawing = step::read(text.as_bytes(), "part", Some(wanted)).unwrap();
        assert_relative_eq!(area_of(&drawing), 1.0, max_relative = 1e-12);
        assert_eq!(drawing.title, "part, small");
    }
    let request = Request { face: Some("small".into()), ..Request::default() };
    let outcome = meshed(&text, &request);
    assert_eq!(outcome.report.request.get("face"), "small");
    assert!(refused(&text, Some("door")).what.contains("no planar face of this number or name"));
}

#[test]
fn a_batch_meshes_every_face_where_it_is_asked_to() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("cad-every-face");
    let _ = std::fs::remove_dir_all(&folder); // left by an earlier run, if at all
    std::fs::create_dir_all(&folder).unwrap();
    let step = two_faces();
    let faces = step.faces.clone();
    std::fs::write(folder.join("part.step"), step.text()).unwrap();
    std::fs::write(folder.join("broken.step"), "ISO-10303-21;\nHEADER;\n").unwrap();
    let arguments = ["batch", "part.step", "broken.step", "--out-dir", "out", "--format", "vtu", "--face", "all"];
    let program = || std::process::Command::new(env!("CARGO_BIN_EXE_squinch"));
    let output = program().current_dir(&folder).args(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "the broken file fails alone");
    let lines = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<serde_json::Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let ends: Vec<_> = lines.iter().map(|l| (l["input"].as_str().unwrap().to_owned(), l["exit"].as_u64())).collect();
    let mut wanted: Vec<_> = faces.iter().map(|face| (format!("part.step#{face}"), Some(0))).collect();
    wanted.push(("broken.step".into(), Some(3)));
    assert_eq!(ends, wanted);
    for face in faces {
        assert!(folder.join(format!("out/part-face{face}.vtu")).exists(), "{face}");
    }
    let again = program().current_dir(&folder).args(arguments).arg("--resume").output().unwrap();
    assert_eq!(String::from_utf8(again.stdout).unwrap(), "", "what is done is not done again");
}

#[test]
fn units_are_told_and_converted() {
    let mut step = plate(Turned::default());
    step.unit = "(CONVERSION_BASED_UNIT('INCH',#inch)LENGTH_UNIT()NAMED_UNIT(*))";
    let text = step.text();
    let (unit, from) = read(&text).unit.unwrap();
    assert_eq!(unit, "in");
    assert!(from.starts_with("CONVERSION_BASED_UNIT #"), "{from}");
    let request = Request { unit: Some("mm".into()), ..Request::default() };
    let outcome = meshed(&text, &request);
    let mesh = outcome.mesh.as_ref().unwrap();
    let frame = mesh.frame.unwrap();
    assert_relative_eq!(
        outcome.report.quality.unwrap().exact_measure().unwrap(),
        (12.0 - PI / 4.0) * 25.4 * 25.4,
        max_relative = 1e-9
    );
    let origin = tilted().place(Point::new(-1.0, 0.5));
    for (read, drawn) in frame.origin.iter().zip(origin) {
        assert_relative_eq!(*read, 25.4 * drawn, max_relative = 1e-12);
    }
}

#[test]
fn old_files_without_a_file_name_are_read() {
    let text = plate(Turned::default()).text();
    let old = text.replace("FILE_NAME('','',(''),(''),'','','');\n", "");
    let drawing = read(&old);
    assert_eq!(drawing.notes, ["the header has no FILE_NAME: read as if it were empty"]);
    assert_eq!(drawing.curves, read(&text).curves);
}

#[test]
fn a_file_is_known_by_its_first_words_and_its_suffix() {
    let text = plate(Turned::default()).text();
    assert_eq!(Format::sniff(text.as_bytes()), Some(Format::Step));
    assert_eq!(import::format_of("a/part.STP".as_ref()), Some(Format::Step));
    let found = import::read(text.as_bytes(), Format::Step, "part", &Options::default()).unwrap();
    let import::Found::Drawing(drawing) = found else { panic!("a drawing") };
    assert_eq!((drawing.format.as_str(), drawing.title.as_str()), ("STEP", "part, plate"));
}

// ---- what is refused ----

#[test]
fn an_edge_off_the_plane_is_an_error_with_its_place() {
    let mut step = plate(Turned::default());
    let bump = tilted().place(Point::new(4.0, 3.0));
    let bent = times(tilted().normal(), 1e-3);
    let moved: [f64; 3] = std::array::from_fn(|k| bump[k] + bent[k]);
    step.data = step.data.replace(&triple(bump), &triple(moved));
    let error = refused(&step.text(), None);
    assert!(error.what.contains("leaves the plane of its face by 1.000e-3"), "{error}");
    assert!(error.line.is_some() && error.what.contains("EDGE_CURVE #"), "{error}");
}

#[test]
fn a_vertex_off_its_circle_is_an_error() {
    let mut step = plate(Turned::default());
    step.data = step.data.replace(",0.5);", ",0.49);");
    assert!(
        refused(&step.text(), None).what.contains("has a vertex off its curve by 1.000e-2"),
        "the hole's radius was changed"
    );
}

#[test]
fn curved_faces_are_counted_and_refused_by_name() {
    let mut step = plate(Turned::default());
    let at = step.placement(Point::ORIGIN, 0.0, false);
    let cylinder = step.add(&format!("CYLINDRICAL_SURFACE('',#{at},1.)"));
    let face = step.add(&format!("ADVANCED_FACE('',(),#{cylinder},.T.)"));
    let text = step.text();
    let drawing = read(&text);
    assert_eq!((drawing.skipped[0].entity.as_str(), drawing.skipped[0].count), ("faces on CYLINDRICAL_SURFACE", 1));
    assert!(refused(&text, Some(&face.to_string())).what.contains("lies on a CYLINDRICAL_SURFACE"));
    let curved = text.replace("PLANE(", "SPHERICAL_SURFACE(");
    assert!(refused(&curved, None).what.contains("the file has no planar face"), "{}", refused(&curved, None));
}

#[test]
fn curves_that_stand_for_themselves_are_refused() {
    let mut step = Step::new(tilted(), Turned::default());
    let start = step.vertex(Point::new(1.0, 0.0));
    let ring = step.count + 1;
    step.add(&format!("SURFACE_CURVE('',#{ring},(),.CURVE_3D.)"));
    let edge = step.edge("ring", start, start, ring);
    let bound = step.bound(&[edge]);
    step.face("ring", &[bound]);
    assert!(refused(&step.text(), None).what.contains("stands for itself"));
}

/// A generator of small numbers, the same on every machine (Marsaglia's xorshift).
struct Rng(u64);

impl Rng {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }
}

#[test]
fn damaged_files_give_errors_or_drawings_and_never_panic() {
    let (knots, net) = circle_net();
    let mut step = plate(Turned::default());
    let start = step.vertex(Point::new(2.0, 0.0));
    let rim = step.nurbs("rim", [start; 2], 2, &knots, &net);
    let bound = step.bound(&[rim]);
    step.face("disk", &[bound]);
    let text = step.text().into_bytes();
    let mut rng = Rng(0x9e37_79b9_7f4a_7c15);
    let (mut refused, rounds) = (0, 3000);
    for round in 0..rounds {
        let mut bytes = text.clone();
        match round % 4 {
            0 => bytes.truncate(rng.below(text.len())),
            1 => {
                let at = rng.below(text.len());
                bytes[at] = rng.below(256) as u8;
            }
            2 => {
                let (at, length) = (rng.below(text.len()), rng.below(60));
                bytes.drain(at..(at + length).min(text.len()));
            }
            // Digits into other digits: the syntax stands, what it says does not.
            _ => {
                for _ in 0..4 {
                    let digits: Vec<usize> = (0..bytes.len()).filter(|i| bytes[*i].is_ascii_digit()).collect();
                    let at = digits[rng.below(digits.len())];
                    bytes[at] = b'0' + rng.below(10) as u8;
                }
            }
        }
        if let Err(error) = step::read(&bytes, "part", None) {
            assert!(!error.what.is_empty() && !error.help.is_empty());
            refused += 1;
        }
    }
    assert!((rounds / 4..rounds).contains(&refused), "{refused} of {rounds}");
    for bytes in [
        &b""[..],
        b"ISO-10303-21;",
        b"ISO-10303-21;HEADER;",
        b"\xff\xfe",
        b"ISO-10303-21;HEADER;ENDSEC;DATA;ENDSEC;END-ISO-10303-21;",
    ] {
        assert!(step::read(bytes, "part", None).is_err());
    }
}

#[test]
fn a_multiplicity_that_would_fill_the_memory_is_refused() {
    let mut step = Step::new(tilted(), Turned::default());
    let (knots, net) = circle_net();
    let start = step.vertex(Point::new(2.0, 0.0));
    let rim = step.nurbs("rim", [start; 2], 2, &knots, &net);
    let bound = step.bound(&[rim]);
    step.face("disk", &[bound]);
    let text = step.text().replace("((3,2,2,2,3)", "((3,2,2,2,4000000000000)");
    assert!(refused(&text, None).what.contains("multiplicities"), "{}", refused(&text, None));
}

// ---- truck ----

mod truck {
    use super::*;
    use truck_modeling::{Face, Point3, Rad, Vector3, Wire, builder};

    /// Of a plate of 4 by 3 with a half disk on its right and a hole of radius ½.
    const AREA: f64 = 12.0 + PI * 2.25 / 2.0 - PI / 4.0;

    fn face() -> Face {
        let v = |x, y| builder::vertex(Point3::new(x, y, 0.0));
        let (a, b, c, d) = (v(0.0, 0.0), v(4.0, 0.0), v(4.0, 3.0), v(0.0, 3.0));
        let rim: Wire = vec![
            builder::line(&a, &b),
            builder::circle_arc(&b, &c, Point3::new(5.5, 1.5, 0.0)),
            builder::line(&c, &d),
            builder::bezier(&d, &a, vec![Point3::new(0.0, 2.0, 0.0), Point3::new(0.0, 1.0, 0.0)]),
        ]
        .into();
        let start = v(2.5, 1.2);
        let mut hole: Wire = builder::rsweep(&start, Point3::new(2.0, 1.2, 0.0), Vector3::unit_z(), Rad(7.0));
        hole.invert();
        let flat = builder::try_attach_plane(&[rim, hole]).unwrap();
        let turned = builder::rotated(&flat, Point3::new(1.0, 0.0, 0.0), Vector3::new(0.6, 0.8, 0.0), Rad(1.1));
        builder::translated(&turned, Vector3::new(7.0, -3.0, 11.0))
    }

    #[test]
    fn a_face_has_its_area_either_way_up() {
        let face = face();
        let up = drawing_of_truck_face(&face).unwrap();
        let down = drawing_of_truck_face(&face.inverse()).unwrap();
        for drawing in [&up, &down] {
            assert_relative_eq!(area_of(drawing), AREA, max_relative = 1e-9);
            assert!(drawing.curves.iter().any(|c| c.curve.kind() == "nurbs"), "arcs stay rational splines");
        }
        assert!(dot(up.frame.unwrap().normal(), down.frame.unwrap().normal()) < -1.0 + 1e-12);
    }

    #[test]
    fn a_face_comes_back_as_a_mesh_in_space() {
        let face = face();
        let drawing = drawing_of_truck_face(&face).unwrap();
        let outcome = run_drawing(&drawing, &Request::default(), Extent::Whole(&mut |_| true), &no_clock);
        assert_eq!(outcome.exit, Exit::Done, "{:?}", outcome.report.failure);
        let mesh = outcome.mesh.as_ref().unwrap();
        let frame = drawing.frame.unwrap();
        // Every vertex of truck's is a node, to the rounding of the frame.
        for vertex in face.vertex_iter() {
            let p = vertex.point();
            let gap = mesh
                .places()
                .map(|q| minus(q, [p.x, p.y, p.z]))
                .map(|d| dot(d, d).sqrt())
                .fold(f64::INFINITY, f64::min);
            assert!(gap < 1e-13, "{gap}");
        }
        assert!(mesh.places().all(|p| frame.height(p).abs() < 1e-13));
        let names = names(mesh);
        assert!(names.contains(&"face") && names.contains(&"edge 1") && names.contains(&"edge 7"), "{names:?}");
        assert_eq!(meshio::read(&vtu_of(&outcome), meshio::Format::Vtu, &[]).unwrap().mesh.nodes, mesh.nodes);
    }

    #[test]
    fn a_curved_face_is_refused() {
        let edge =
            builder::line(&builder::vertex(Point3::new(1.0, 0.0, 0.0)), &builder::vertex(Point3::new(1.0, 0.0, 1.0)));
        let barrel = builder::rsweep(&edge, Point3::new(0.0, 0.0, 0.0), Vector3::unit_z(), Rad(7.0));
        let error = drawing_of_truck_face(&barrel[0]).expect_err("curved");
        assert!(error.to_string().contains("only planar faces"), "{error}");
    }
}
