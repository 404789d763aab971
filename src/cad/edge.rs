//! One edge of a face: a curve in space, trimmed by its vertices, projected into the plane of the face in its own kind.

use super::{FaceError, SLACK, diagonal};
use crate::curve::{Curve, CurveError, End};
use crate::geometry::space::{dot, length, minus};
use crate::geometry::{Frame, Point, Vec2};
use std::f64::consts::TAU;

/// An untrimmed curve in space.
#[derive(Clone, Debug, PartialEq)]
pub enum SpaceCurve {
    /// A straight line; the edge's vertices bound the part.
    Line,
    /// center + cos θ · u + sin θ · v, for perpendicular half axes; a circle where they are equally long.
    Ellipse { center: [f64; 3], u: [f64; 3], v: [f64; 3] },
    /// apex + t² · u + t · v, for perpendicular u, v.
    Parabola { apex: [f64; 3], u: [f64; 3], v: [f64; 3] },
    /// center + cosh t · u + sinh t · v, for perpendicular half axes.
    Hyperbola { center: [f64; 3], u: [f64; 3], v: [f64; 3] },
    /// B-spline or NURBS, with the full knot vector.
    Nurbs { degree: usize, knots: Vec<f64>, points: Vec<[f64; 3]>, weights: Option<Vec<f64>> },
}

/// A part of a curve between two vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// The curve along which the edge runs.
    pub curve: SpaceCurve,
    /// The first and the last vertex; equal for a closed curve once around.
    pub ends: [[f64; 3]; 2],
    /// Whether the edge, from first to last, runs in the direction of its curve.
    pub same_sense: bool,
    /// Whether its loop runs along it from last to first.
    pub backward: bool,
    /// The name of its boundary.
    pub name: String,
    /// Where it came from, for messages: "EDGE_CURVE #123 of face #45".
    pub entity: String,
}

/// An edge in the plane.
pub(super) struct FlatEdge {
    /// One curve; two where the vertex of a closed spline is not at the start of the spline.
    pub curves: Vec<Curve>,
    /// The largest distance of the edge from the plane.
    pub off_plane: f64,
    /// The largest distance of its curve's ends from its vertices.
    pub gap: f64,
}

/// The trimmed curves of an edge from its first vertex to its last, and the quantities of [`FlatEdge`].
type Laid = Result<FlatEdge, String>;

fn invalid(error: CurveError) -> String {
    format!("is no curve: {error},")
}

impl Edge {
    fn is_closed(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// The error that names this edge, at its first vertex.
    pub(super) fn error(&self, what: String) -> FaceError {
        FaceError { entity: self.entity.clone(), what, at: self.ends[0] }
    }

    /// The edge in the plane of a frame, in the direction of its loop, from vertex to vertex bit for bit. `uncertainty`
    /// is the accuracy that the file states, as a length.
    pub(super) fn flat(&self, frame: &Frame, uncertainty: f64) -> Laid {
        let ends = self.ends.map(|end| frame.flat(end));
        let mut laid = match &self.curve {
            SpaceCurve::Line => line(ends),
            SpaceCurve::Ellipse { center, u, v } => self.ellipse(ends, &Conic::new(frame, *center, *u, *v)),
            SpaceCurve::Parabola { apex, u, v } => parabola(ends, &Conic::new(frame, *apex, *u, *v)),
            SpaceCurve::Hyperbola { center, u, v } => hyperbola(ends, &Conic::new(frame, *center, *u, *v)),
            SpaceCurve::Nurbs { degree, knots, points, weights } => self.nurbs(
                frame,
                ends,
                &Net { degree: *degree, knots, points, weights: weights.as_deref() },
                uncertainty,
            ),
        }?;
        for end in self.ends {
            laid.off_plane = laid.off_plane.max(frame.height(end).abs());
        }
        meet_ends(&mut laid.curves, ends);
        if self.backward {
            laid.curves = laid.curves.iter().rev().map(Curve::reversed).collect();
        }
        Ok(laid)
    }

    fn ellipse(&self, ends: [Point; 2], conic: &Conic) -> Laid {
        conic.check()?;
        let angles = ends.map(|p| {
            let (cos, sin) = conic.coordinates(p);
            libm::atan2(sin, cos)
        });
        let ahead = angles[1] - angles[0];
        let forward = if self.is_closed() { TAU } else { ahead - TAU * libm::floor(ahead / TAU) };
        let sweep = match (self.same_sense, self.is_closed()) {
            (true, _) => forward,
            (false, true) => -TAU,
            (false, false) => forward - TAU,
        };
        let off_plane = conic.off_plane(|share| {
            let (sin, cos) = libm::sincos(angles[0] + sweep * share);
            (cos, sin)
        });
        let [u, v] = conic.lengths;
        let curve = if (u - v).abs() <= 1e-9 * u {
            let from_center = ends[0] - conic.center;
            let turn = sweep.copysign(sweep * conic.u.cross(conic.v));
            Curve::arc(conic.center, u, libm::atan2(from_center.y, from_center.x), turn)
        } else {
            Curve::ellipse(conic.center, conic.u, conic.v, angles[0], sweep)
        };
        let curve = curve.map_err(invalid)?;
        Ok(conic_edge(curve, ends, off_plane))
    }

    fn nurbs(&self, frame: &Frame, ends: [Point; 2], net: &Net, uncertainty: f64) -> Laid {
        let flat: Vec<Point> = net.points.iter().map(|p| frame.flat(*p)).collect();
        let curve = net.curve(&flat).map_err(invalid)?;
        let slack = uncertainty.max(SLACK * diagonal(flat.iter().copied()));
        let (parts, gap) = self.trimmed(&curve, ends, slack)?;
        // A flat hull of control points is sufficient. Otherwise the part of the curve along which the edge runs is
        // measured.
        let heights: Vec<Point> = net.points.iter().map(|p| Point::new(frame.height(*p), 0.0)).collect();
        let mut off_plane = heights.iter().map(|h| h.x.abs()).fold(0.0, f64::max);
        if off_plane > slack {
            let height = net.curve(&heights).map_err(invalid)?;
            let reach = |&(t0, t1): &(f64, f64)| {
                let bounds = height.bounds_of(t0, t1);
                bounds.x0.abs().max(bounds.x1.abs())
            };
            off_plane = parts.iter().map(reach).fold(0.0, f64::max);
        }
        let whole = |&(t0, t1): &(f64, f64)| (t0, t1) == (0.0, 1.0);
        let part = |range| if whole(range) { curve.clone() } else { curve.part(range.0, range.1) };
        let mut curves: Vec<Curve> = parts.iter().map(part).collect();
        if !self.same_sense {
            curves = curves.iter().rev().map(Curve::reversed).collect();
        }
        Ok(FlatEdge { curves, off_plane, gap })
    }

    /// The ranges of a curve along which the edge runs, in the curve's order, and the distance of the curve from the
    /// vertices.
    fn trimmed(&self, curve: &Curve, ends: [Point; 2], slack: f64) -> Result<(Vec<(f64, f64)>, f64), String> {
        let [from, to] = if self.same_sense { ends } else { [ends[1], ends[0]] };
        let place = |p: Point, side: End| {
            let (t, seam) = match side {
                End::Start => (0.0, curve.start()),
                End::Finish => (1.0, curve.end()),
            };
            // At the seam of a closed curve both ends are equally near; the end of the edge decides.
            if seam.distance(p) <= slack { (t, seam.distance(p)) } else { curve.nearest(p, 0.0, 1.0) }
        };
        let ((t0, gap0), (t1, gap1)) = (place(from, End::Start), place(to, End::Finish));
        let gap = gap0.max(gap1);
        let around = curve.start().distance(curve.end()) <= slack;
        let parts = match t0 < t1 && !(self.is_closed() && (t0, t1) != (0.0, 1.0)) {
            true => vec![(t0, t1)],
            false if around => vec![(t0, 1.0), (0.0, t1)],
            // An open curve has only one part between two points, whatever sense the file states.
            false if t1 < t0 => vec![(t1, t0)],
            false => return Err("begins and ends at one point of an open curve".into()),
        };
        Ok((parts.into_iter().filter(|(from, to)| from < to).collect(), gap))
    }
}

/// Moves the ends of a chain of curves to the vertices, bit for bit; each inner curve begins at the end of the one
/// before.
fn meet_ends(curves: &mut [Curve], ends: [Point; 2]) {
    let last = curves.len().saturating_sub(1);
    let mut from = ends[0];
    for (i, curve) in curves.iter_mut().enumerate() {
        let to = if i == last { ends[1] } else { curve.end() };
        *curve = curve.with_ends(from, to);
        from = to;
    }
}

fn line([a, b]: [Point; 2]) -> Laid {
    // An edge of no length is not drawn, as at the apex of a cone.
    let curves = if a == b { Vec::new() } else { vec![Curve::line(a, b).map_err(invalid)?] };
    Ok(FlatEdge { curves, off_plane: 0.0, gap: 0.0 })
}

/// The part of a parabola between two parameters: the middle control point is where the tangents at the ends meet.
fn parabola(ends: [Point; 2], conic: &Conic) -> Laid {
    conic.check()?;
    let [s, t] = ends.map(|p| conic.coordinates(p).1);
    let at = |along: f64, across: f64| conic.center + conic.u * along + conic.v * across;
    let curve = Curve::bezier(vec![at(s * s, s), at(s * t, 0.5 * (s + t)), at(t * t, t)]).map_err(invalid)?;
    let off_plane = conic.off_plane(|share| {
        let r = s + (t - s) * share;
        (r * r, r)
    });
    Ok(conic_edge(curve, ends, off_plane))
}

/// The part of a hyperbola between two parameters: the rational quadratic whose middle weight is cosh of half their
/// difference.
fn hyperbola(ends: [Point; 2], conic: &Conic) -> Laid {
    conic.check()?;
    let [s, t] = ends.map(|p| libm::asinh(conic.coordinates(p).1));
    let at = |along: f64, across: f64| conic.center + conic.u * along + conic.v * across;
    let on = |r: f64| at(libm::cosh(r), libm::sinh(r));
    let (middle, weight) = (0.5 * (s + t), libm::cosh(0.5 * (t - s)));
    let apex = at(libm::cosh(middle) / weight, libm::sinh(middle) / weight);
    let curve = Curve::rational_bezier(vec![on(s), apex, on(t)], vec![1.0, weight, 1.0]).map_err(invalid)?;
    let off_plane = conic.off_plane(|share| {
        let r = s + (t - s) * share;
        (libm::cosh(r), libm::sinh(r))
    });
    Ok(conic_edge(curve, ends, off_plane))
}

fn conic_edge(curve: Curve, ends: [Point; 2], off_plane: f64) -> FlatEdge {
    let gap = curve.start().distance(ends[0]).max(curve.end().distance(ends[1]));
    FlatEdge { curves: vec![curve], off_plane, gap }
}

/// A conic's center (or apex) and axes in the plane, and their heights above it.
struct Conic {
    center: Point,
    u: Vec2,
    v: Vec2,
    /// The lengths of the axes in space.
    lengths: [f64; 2],
    heights: [f64; 3],
}

impl Conic {
    fn new(frame: &Frame, center: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Self {
        let normal = frame.normal();
        Self {
            center: frame.flat(center),
            u: frame.flat_vector(u),
            v: frame.flat_vector(v),
            lengths: [length(u), length(v)],
            heights: [dot(minus(center, frame.origin), normal), dot(u, normal), dot(v, normal)],
        }
    }

    /// Refuses a conic that is perpendicular to the plane, or nearly so.
    fn check(&self) -> Result<(), String> {
        let [u, v] = self.lengths;
        let upright = self.u.cross(self.v).abs() <= 0.5 * u * v;
        if upright { Err("stands across the plane of its face".into()) } else { Ok(()) }
    }

    /// The coordinates a and b in p = center + a · u + b · v.
    fn coordinates(&self, p: Point) -> (f64, f64) {
        let (d, area) = (p - self.center, self.u.cross(self.v));
        (d.cross(self.v) / area, self.u.cross(d) / area)
    }

    /// The largest height over a part, sampled at seventeen places: the height is a smooth function that hardly bends
    /// between them.
    fn off_plane(&self, at: impl Fn(f64) -> (f64, f64)) -> f64 {
        let [center, u, v] = self.heights;
        let height = |i: u8| {
            let (a, b) = at(f64::from(i) / 16.0);
            (center + a * u + b * v).abs()
        };
        (0..=16).map(height).fold(0.0, f64::max)
    }
}

/// The data of a NURBS.
struct Net<'a> {
    degree: usize,
    knots: &'a [f64],
    points: &'a [[f64; 3]],
    weights: Option<&'a [f64]>,
}

impl Net<'_> {
    /// The curve with these knots and weights and the given images of the control points.
    fn curve(&self, images: &[Point]) -> Result<Curve, CurveError> {
        Curve::nurbs(self.degree, self.knots, images, self.weights)
    }
}
