//! The hull tree of a curve: pieces, their halves, and so on, each with its control polygon, box, strip and cone of
//! tangents.
//!
//! Every kind of curve is a chain of Bézier spans in homogeneous coordinates: lines have degree one, circular and
//! elliptic arcs are cut into rational quadratics of at most a quarter turn. A piece lies in the convex hull of its
//! control points. Corner cutting only blends neighbouring legs, so every tangent and every chord of the piece lies in
//! the cone of the legs. Halves are made by de Casteljau's algorithm at the middle, at the first request, and stored: a
//! piece is halved only once, whatever it is compared with.
//!
//! ```text
//!             group                  A piece:   p₁ ●────────● p₂       hull    p₀ … p₃
//!            ╱     ╲                             ╱╭────────╮ ╲         spread  the strip along the chord that
//!       span 0     span 1                      ╱╭─╯        ╰──╮╲               contains the hull
//!       ╱    ╲     ╱    ╲                  p₀ ●───── chord ─────● p₃   cone    of the legs p₀p₁, p₁p₂ and p₂p₃
//!    halves  …    …     …
//! ```

use crate::curve::{Bezier, Cone, Curve, EllipticArc};
use crate::geometry::{Point, Rect, Vec2, magnitude};
use std::f64::consts::FRAC_PI_2;

/// A control point times its weight, and the weight.
type Homogeneous = [f64; 3];

/// One Bézier piece, or (without control points) a group of neighbouring pieces.
pub(super) struct HullNode {
    control: Vec<Homogeneous>,
    /// The control points; empty for a group.
    pub hull: Vec<Point>,
    /// The box around the hull.
    pub bounds: Rect,
    /// The range of the curve's parameter.
    pub t: [f64; 2],
    /// The range of its span's own parameter.
    s: [f64; 2],
    span: usize,
    /// The unit normal of the chord; zero where the chord has no length.
    pub normal: Vec2,
    /// The least and the largest signed distance of the hull from the line of the chord.
    pub spread: [f64; 2],
    /// The cone of tangents, if all legs are less than a right angle from the chord.
    pub cone: Option<Cone>,
    /// The longer side of the box.
    pub size: f64,
    /// Whether its first and its last point are ends of a span: ends of the curve, or knots, where the tangent may
    /// jump.
    pub span_end: [bool; 2],
    children: Option<[usize; 2]>,
}

impl HullNode {
    /// The start of the piece; not of a group.
    pub fn first(&self) -> Point {
        self.hull[0]
    }

    /// The end of the piece; not of a group.
    pub fn last(&self) -> Point {
        self.hull[self.hull.len() - 1]
    }

    /// Whether it is a group, which has no control points.
    pub fn is_group(&self) -> bool {
        self.hull.is_empty()
    }

    /// The width of the strip along the chord that contains the piece.
    pub fn width(&self) -> f64 {
        self.spread[1] - self.spread[0]
    }

    /// Whether the strip is no wider than an eighth of the piece's size, and all legs advance along the chord.
    pub fn is_slender(&self) -> bool {
        // The legs of such a piece are within about π/6 of its chord where they advance. There Newton's method is
        // quick.
        self.cone.is_some() && 8.0 * self.width() <= self.size
    }

    /// Whether the piece is straight, or a point, to within `gap`.
    pub fn is_straight(&self, gap: f64) -> bool {
        !self.is_group() && (self.size <= gap || (self.cone.is_some() && self.width() <= gap))
    }
}

/// How the curve's parameter depends on that of a span.
enum Pace {
    Even,
    /// A conic of half angle φ: tan(θ/2) = tan(φ/2)·(2s − 1) for the angle θ from its middle. This is tan(φ/2).
    Angle(f64),
}

struct Span {
    t: [f64; 2],
    pace: Pace,
}

impl Span {
    fn parameter(&self, s: f64) -> f64 {
        let [from, to] = self.t;
        match self.pace {
            _ if s == 0.0 => from,
            _ if s == 1.0 => to,
            Pace::Even => from + s * (to - from),
            Pace::Angle(k) => 0.5 * (from + to) + 0.5 * (to - from) * libm::atan(k * (2.0 * s - 1.0)) / libm::atan(k),
        }
    }
}

/// The hull tree of a curve.
pub(super) struct Hulls {
    spans: Vec<Span>,
    pieces: Vec<HullNode>,
    root: usize,
    /// The largest coordinate from which the curve is computed.
    pub magnitude: f64,
    /// The highest degree of a span.
    pub degree: usize,
    control_points: usize,
}

impl std::ops::Index<usize> for Hulls {
    type Output = HullNode;
    fn index(&self, i: usize) -> &HullNode {
        &self.pieces[i]
    }
}

impl Hulls {
    /// The tree of a curve down to its spans; halves are made on request.
    pub fn of(curve: &Curve) -> Self {
        let mut hulls =
            Self { spans: Vec::new(), pieces: Vec::new(), root: 0, magnitude: 0.0, degree: 1, control_points: 0 };
        match curve.as_kind().as_ellipse() {
            Some(conic) => hulls.add_conic(curve, &conic),
            None => {
                for span in curve.as_kind().spans(0.0, 1.0) {
                    hulls.add(span.range(), Pace::Even, homogeneous(&span.bezier));
                }
            }
        }
        hulls.magnitude = curve.as_kind().reach();
        hulls.group();
        hulls.magnitude = hulls.magnitude.max(magnitude(hulls[hulls.root].bounds));
        hulls
    }

    /// The index of the node for the whole curve.
    pub fn root(&self) -> usize {
        self.root
    }

    /// The number of control points that halving has made so far.
    pub fn control_points(&self) -> usize {
        self.control_points
    }

    fn add(&mut self, t: [f64; 2], pace: Pace, control: Vec<Homogeneous>) {
        let span = self.spans.len();
        self.spans.push(Span { t, pace });
        self.degree = self.degree.max(control.len() - 1);
        self.pieces.push(bezier_piece(control, span, [0.0, 1.0], t, [true; 2]));
    }

    /// Cuts an arc into rational quadratics.
    fn add_conic(&mut self, curve: &Curve, conic: &EllipticArc) {
        let (start, sweep) = (conic.start_rad, conic.sweep_rad);
        let axis = |angle: f64| libm::cos(angle) * conic.u + libm::sin(angle) * conic.v;
        let count = libm::ceil(sweep.abs() / FRAC_PI_2).clamp(1.0, 4.0);
        let half = 0.5 * sweep / count;
        let (sin, cos) = (libm::sin(half), libm::cos(half));
        for k in 0..count as usize {
            let t = [k as f64 / count, (k + 1) as f64 / count];
            let ends = t.map(|t| curve.point(t));
            // The shoulder is computed from the chord's middle, not from the center: a flat arc has a distant center.
            let shoulder = ends[0].midpoint(ends[1]) + axis(start + (2 * k + 1) as f64 * half) * (sin * sin / cos);
            let control = [(ends[0], 1.0), (shoulder, cos), (ends[1], 1.0)];
            self.add(t, Pace::Angle(libm::tan(0.5 * half)), control.map(|(p, w)| [p.x * w, p.y * w, w]).to_vec());
        }
    }

    /// Joins neighbours in pairs until one node is left.
    fn group(&mut self) {
        let mut level: Vec<usize> = (0..self.pieces.len()).collect();
        while level.len() > 1 {
            let pairs: Vec<Vec<usize>> = level.chunks(2).map(<[usize]>::to_vec).collect();
            level = pairs
                .into_iter()
                .map(|pair| match pair[..] {
                    [left, right] => {
                        self.pieces.push(group_piece(&self.pieces[left], &self.pieces[right], [left, right]));
                        self.pieces.len() - 1
                    }
                    _ => pair[0],
                })
                .collect();
        }
        self.root = level[0];
    }

    /// The children of a node; a piece is halved at the first request.
    pub fn halves(&mut self, i: usize) -> [usize; 2] {
        if let Some(children) = self.pieces[i].children {
            return children;
        }
        let piece = &self.pieces[i];
        let middle = 0.5 * (piece.s[0] + piece.s[1]);
        let t = self.spans[piece.span].parameter(middle).clamp(piece.t[0], piece.t[1]);
        let [left, right] = halved(&piece.control);
        let (span, s, ends, [t0, t1]) = (piece.span, piece.s, piece.span_end, piece.t);
        let left = bezier_piece(left, span, [s[0], middle], [t0, t], [ends[0], false]);
        let right = bezier_piece(right, span, [middle, s[1]], [t, t1], [false, ends[1]]);
        self.control_points += left.control.len() + right.control.len();
        let children = [self.pieces.len(), self.pieces.len() + 1];
        self.pieces.extend([left, right]);
        self.pieces[i].children = Some(children);
        children
    }
}

fn plain(points: &[Point]) -> Vec<Homogeneous> {
    points.iter().map(|p| [p.x, p.y, 1.0]).collect()
}

fn homogeneous(bezier: &Bezier) -> Vec<Homogeneous> {
    match &bezier.weights {
        None => plain(&bezier.points),
        Some(weights) => bezier.points.iter().zip(weights).map(|(p, &w)| [p.x * w, p.y * w, w]).collect(),
    }
}

/// De Casteljau's algorithm at the middle.
fn halved(control: &[Homogeneous]) -> [Vec<Homogeneous>; 2] {
    let n = control.len();
    let mut left = Vec::with_capacity(n);
    let mut right = control.to_vec();
    for last in (0..n).rev() {
        left.push(right[0]);
        for i in 0..last {
            let (p, q) = (right[i], right[i + 1]);
            right[i] = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])];
        }
    }
    [left, right]
}

fn bezier_piece(control: Vec<Homogeneous>, span: usize, s: [f64; 2], t: [f64; 2], span_end: [bool; 2]) -> HullNode {
    let hull: Vec<Point> = control.iter().map(|c| Point::new(c[0] / c[2], c[1] / c[2])).collect();
    let mut bounds = Rect::from_points(hull[0], hull[0]);
    hull.iter().for_each(|&p| bounds = bounds.union_pt(p));
    let chord = hull[hull.len() - 1] - hull[0];
    let normal = if chord == Vec2::ZERO { chord } else { Vec2::new(-chord.y, chord.x) / length(chord) };
    let size = bounds.width().max(bounds.height());
    let spread = if chord == Vec2::ZERO {
        [-size, size]
    } else {
        hull.iter().fold([0.0f64; 2], |[low, high], &p| {
            let d = normal.dot(p - hull[0]);
            [low.min(d), high.max(d)]
        })
    };
    let cone = cone(&hull, chord);
    HullNode { control, hull, bounds, t, s, span, normal, spread, cone, size, span_end, children: None }
}

fn group_piece(left: &HullNode, right: &HullNode, children: [usize; 2]) -> HullNode {
    let bounds = left.bounds.union(right.bounds);
    let size = bounds.width().max(bounds.height());
    HullNode {
        control: Vec::new(),
        hull: Vec::new(),
        bounds,
        t: [left.t[0], right.t[1]],
        s: [0.0, 1.0],
        span: 0,
        normal: Vec2::ZERO,
        spread: [-size, size],
        cone: None,
        size,
        span_end: [left.span_end[0], right.span_end[1]],
        children: Some(children),
    }
}

/// The cone of the legs, if it lies in the half plane along the chord.
fn cone(hull: &[Point], chord: Vec2) -> Option<Cone> {
    let mut cone = Cone::along(chord)?;
    let mut legs = hull.windows(2).map(|w| w[1] - w[0]).filter(|&leg| leg != Vec2::ZERO);
    legs.all(|leg| cone.widen(leg, chord)).then_some(cone)
}

/// The length of a vector (by `sqrt`, which gives the same bits on every machine).
pub(super) fn length(v: Vec2) -> f64 {
    v.hypot2().sqrt()
}
