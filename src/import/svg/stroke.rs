//! The area of a stroke (SVG 2, section 13.5): the body along each curve, joins between bodies and caps at the ends.
//! Each is a closed outline that winds in the positive sense, so the rule "nonzero" unites them.
//!
//! ```text
//!      ┌───────────────┐╲ join: the corner outside of a turn
//!  cap │ ─ ─ ─body ─ ─ ┼ ╲
//!      └─────────────┌─┴──┐
//!                    │body│
//! ```
//!
//! The body of a line is a rectangle, that of an arc is a sector of a ring; both are exact. Offsets of other curves are
//! cubics within a distance that a note states.

use super::path::Subpath;
use crate::curve::{Curve, End};
use crate::geometry::{Point, Vec2};
use kurbo::{BezPath, PathEl, Shape as _};
use std::f64::consts::{PI, TAU};

/// The shape of the ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cap {
    Butt,
    Round,
    Square,
}

/// The shape of the corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Join {
    Miter,
    Round,
    Bevel,
}

/// How a stroke is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pen {
    /// Width in the coordinates of the element.
    pub width: f64,
    /// The shape of the ends.
    pub cap: Cap,
    /// The shape of the corners.
    pub join: Join,
    /// Largest length of a miter, in widths.
    pub miter_limit: f64,
    /// Lengths of dashes and gaps, alternating; empty for a solid line.
    pub dashes: Vec<f64>,
    /// The length into the dashes at which the stroke begins.
    pub dash_offset: f64,
}

/// Largest number of dashes of one element. With more the line is drawn solid.
const DASHES_MAX: f64 = 1e4;
/// Largest distance of the offset of a curve that is neither line nor arc, as a part of the width.
pub(super) const OFFSET_ERROR: f64 = 1e-4;
/// Two curves that turn by less than this (the sine of the angle) have no join.
const STRAIGHT_ON: f64 = 1e-7;

/// The area of a stroke.
#[derive(Default)]
pub(super) struct Covered {
    /// Its outlines, each in the positive sense.
    pub outlines: Vec<Subpath>,
    /// Whether some outlines are approximations.
    pub is_inexact: bool,
    /// Whether there were too many dashes.
    pub is_solid: bool,
}

/// The unit tangent of a curve at an end, in the direction of the curve.
fn along(curve: &Curve, end: End) -> Vec2 {
    let t = if end == End::Start { 0.0 } else { 1.0 };
    let side = if end == End::Start { End::Start } else { End::Finish };
    let v = curve.tangent(t, side);
    v / libm::hypot(v.x, v.y)
}

fn left(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

impl Pen {
    /// The area of the stroke along subpaths.
    pub fn cover(&self, subpaths: &[Subpath]) -> Covered {
        let mut covered = Covered::default();
        let period: f64 = self.dashes.iter().sum();
        let length: f64 = subpaths.iter().flat_map(|s| &s.curves).map(Curve::length).sum();
        let is_dashed = period > 0.0 && self.dashes.iter().all(|d| *d >= 0.0);
        covered.is_solid = is_dashed && length / period * self.dashes.len() as f64 > DASHES_MAX;
        for subpath in subpaths {
            if is_dashed && !covered.is_solid {
                self.dashed(subpath, period).iter().for_each(|dash| self.cover_subpath(dash, &mut covered));
            } else {
                self.cover_subpath(subpath, &mut covered);
            }
        }
        covered
    }

    fn cover_subpath(&self, subpath: &Subpath, covered: &mut Covered) {
        let curves = &subpath.curves;
        let (Some(first), Some(last)) = (curves.first(), curves.last()) else { return };
        for curve in curves {
            self.add_body(curve, covered);
        }
        for pair in curves.windows(2) {
            self.add_join(&pair[0], &pair[1], covered);
        }
        if subpath.closed {
            self.add_join(last, first, covered);
        } else {
            self.add_cap(first.start(), -along(first, End::Start), covered);
            self.add_cap(last.end(), along(last, End::Finish), covered);
        }
    }

    /// Adds a closed outline of these curves, in the positive sense.
    fn add(&self, curves: Vec<Curve>, covered: &mut Covered) {
        let origin = curves.first().map_or(Point::ORIGIN, Curve::start);
        let area: f64 = curves.iter().map(|c| c.signed_area(origin)).sum();
        let curves = if area < 0.0 { curves.iter().rev().map(Curve::reversed).collect() } else { curves };
        covered.outlines.push(Subpath { curves, closed: true });
    }

    fn add_polygon(&self, corners: &[Point], covered: &mut Covered) {
        let sides = (0..corners.len()).filter_map(|k| side(corners[k], corners[(k + 1) % corners.len()]));
        self.add(sides.collect(), covered);
    }

    fn add_body(&self, curve: &Curve, covered: &mut Covered) {
        let half = 0.5 * self.width;
        let [from, to] = [left(along(curve, End::Start)) * half, left(along(curve, End::Finish)) * half];
        let (start, end) = (curve.start(), curve.end());
        match curve {
            Curve::Line(_) => self.add_polygon(&[start + from, start - from, end - to, end + to], covered),
            Curve::Arc(arc) => {
                // The center is on the left of an arc in the positive sense.
                let outward = -arc.sweep_rad.signum();
                let ring = |radius: f64, from: Point, to: Point| {
                    let start = if radius < 0.0 { arc.start_rad + PI } else { arc.start_rad };
                    let curve = Curve::arc(arc.center, radius.abs(), start, arc.sweep_rad).ok()?;
                    Some(if arc.sweep_rad.abs() < TAU { curve.with_ends(from, to) } else { curve })
                };
                let outer = ring(arc.radius + half, start + from * outward, end + to * outward);
                let inner = ring(arc.radius - half, start - from * outward, end - to * outward);
                match (outer, inner) {
                    (Some(outer), Some(inner)) if arc.sweep_rad.abs() >= TAU => {
                        let hole = (arc.radius > half).then(|| inner.reversed());
                        self.add(std::iter::once(outer).chain(hole).collect(), covered);
                    }
                    (Some(outer), Some(inner)) if arc.radius > half => self.add_between(outer, inner, covered),
                    (outer, inner) => {
                        // The normals meet at the center. Each side of the arc covers a sector around it.
                        for arc_of_sector in [outer, inner].into_iter().flatten() {
                            let spokes =
                                [side(arc_of_sector.end(), arc.center), side(arc.center, arc_of_sector.start())];
                            self.add([Some(arc_of_sector)].into_iter().chain(spokes).flatten().collect(), covered);
                        }
                    }
                }
            }
            Curve::Ellipse(_) | Curve::Bezier(_) | Curve::Spline(_) | Curve::Clothoid(_) => {
                covered.is_inexact = true;
                let style = kurbo::Stroke::new(self.width).with_caps(kurbo::Cap::Butt).with_join(kurbo::Join::Round);
                let tolerance = OFFSET_ERROR * self.width;
                let path = kurbo_path(curve, tolerance);
                let outline = kurbo::stroke(path, &style, &kurbo::StrokeOpts::default(), tolerance);
                for part in subpaths_of(&outline) {
                    self.add(part, covered);
                }
            }
        }
    }

    /// Adds the area between two curves that run side by side.
    fn add_between(&self, one: Curve, other: Curve, covered: &mut Covered) {
        let sides = [side(one.end(), other.end()), Some(other.reversed()), side(other.start(), one.start())];
        self.add(std::iter::once(one).chain(sides.into_iter().flatten()).collect(), covered);
    }

    fn add_join(&self, before: &Curve, after: &Curve, covered: &mut Covered) {
        let (a, b, at) = (along(before, End::Finish), along(after, End::Start), before.end());
        let (sine, cosine) = (a.cross(b), a.dot(b));
        if sine.abs() < STRAIGHT_ON && cosine > 0.0 {
            return;
        }
        // The outer side of the turn.
        let out = if sine > 0.0 { -0.5 * self.width } else { 0.5 * self.width };
        let (from, to) = (at + left(a) * out, at + left(b) * out);
        let miter = 1.0 / ((1.0 + cosine).max(0.0) / 2.0).sqrt();
        match self.join {
            Join::Round => self.add_sector(at, from, libm::atan2(sine, cosine), to, covered),
            Join::Miter if miter <= self.miter_limit => {
                let tip = at + ((from - at) + (to - at)) / (1.0 + cosine);
                self.add_polygon(&[at, from, tip, to], covered);
            }
            Join::Miter | Join::Bevel => self.add_polygon(&[at, from, to], covered),
        }
    }

    fn add_cap(&self, at: Point, outward: Vec2, covered: &mut Covered) {
        let half = 0.5 * self.width;
        let (from, to) = (at - left(outward) * half, at + left(outward) * half);
        match self.cap {
            Cap::Butt => {}
            Cap::Round => self.add_sector(at, from, PI, to, covered),
            Cap::Square => {
                let ahead = outward * half;
                self.add_polygon(&[from, from + ahead, to + ahead, to], covered);
            }
        }
    }

    fn add_sector(&self, center: Point, from: Point, sweep: f64, to: Point, covered: &mut Covered) {
        let spoke = from - center;
        let arc = Curve::arc(center, 0.5 * self.width, libm::atan2(spoke.y, spoke.x), sweep);
        let arc = arc.ok().map(|arc| arc.with_ends(from, to));
        self.add([side(center, from), arc, side(to, center)].into_iter().flatten().collect(), covered);
    }

    /// The dashes of a subpath, each a subpath.
    fn dashed(&self, subpath: &Subpath, period: f64) -> Vec<Subpath> {
        // An odd list is used twice.
        let lengths = if self.dashes.len() % 2 == 1 { self.dashes.repeat(2) } else { self.dashes.clone() };
        let whole = if self.dashes.len() % 2 == 1 { 2.0 * period } else { period };
        let (mut at, mut left_of_it) = (0, 0.0);
        let mut offset = self.dash_offset - whole * libm::floor(self.dash_offset / whole);
        for (k, length) in lengths.iter().enumerate() {
            (at, left_of_it) = (k, length - offset);
            if left_of_it > 0.0 {
                break;
            }
            offset -= length;
        }
        // Rounding may leave a negative length for the last dash.
        left_of_it = left_of_it.max(0.0);
        let mut dashes = Vec::new();
        let mut dash = Subpath::default();
        for curve in &subpath.curves {
            let (mut from, mut rest) = (0.0, curve.length());
            loop {
                let is_drawn = at % 2 == 0;
                let to = if left_of_it < rest { parameter_after(curve, from, left_of_it, rest) } else { 1.0 };
                if is_drawn && to > from {
                    dash.curves.push(curve.part(from, to));
                }
                if left_of_it >= rest {
                    left_of_it -= rest;
                    break;
                }
                if is_drawn {
                    dashes.push(std::mem::take(&mut dash));
                }
                rest -= left_of_it;
                at = (at + 1) % lengths.len();
                left_of_it = lengths[at];
                from = to;
            }
        }
        dashes.push(dash);
        dashes.retain(|dash| !dash.curves.is_empty());
        dashes
    }
}

fn side(from: Point, to: Point) -> Option<Curve> {
    (from != to).then(|| Curve::line(from, to).ok()).flatten()
}

/// The parameter at which a curve is `length` longer than at `from`. `rest` is its length from there on.
fn parameter_after(curve: &Curve, from: f64, length: f64, rest: f64) -> f64 {
    let even = from + (1.0 - from) * length / rest;
    if curve.is_round() {
        return even;
    }
    // Newton's method, with bisection where a step leaves the bracket. 50 bisections reach the last bits.
    let (mut low, mut high, mut at) = (from, 1.0, even);
    for _ in 0..50 {
        let missing = length - curve.length_of(from, at);
        *(if missing > 0.0 { &mut low } else { &mut high }) = at;
        let newton = at + missing / curve.derivative(at).hypot();
        let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        if (next - at).abs() <= f64::EPSILON {
            break;
        }
        at = next;
    }
    at
}

/// A curve as a path of cubics, within a tolerance where it is not a cubic.
fn kurbo_path(curve: &Curve, tolerance: f64) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(curve.start());
    match curve {
        Curve::Bezier(bezier) if bezier.weights.is_none() && matches!(bezier.points.len(), 3 | 4) => {
            match bezier.points[..] {
                [_, b, c] => path.quad_to(b, c),
                [_, b, c, d] => path.curve_to(b, c, d),
                _ => {}
            }
        }
        Curve::Ellipse(ellipse) => {
            let map = kurbo::Affine::new([
                ellipse.u.x,
                ellipse.u.y,
                ellipse.v.x,
                ellipse.v.y,
                ellipse.center.x,
                ellipse.center.y,
            ]);
            let unit = kurbo::Arc::new((0.0, 0.0), (1.0, 1.0), ellipse.start_rad, ellipse.sweep_rad, 0.0);
            let size = libm::hypot(ellipse.u.hypot(), ellipse.v.hypot());
            // On the unit circle no tolerance finer than rounding has a meaning, and would need countless pieces.
            let finest = (0.1 * tolerance / size).max(f64::EPSILON);
            for element in unit.path_elements(finest).skip(1) {
                path.push(map * element);
            }
        }
        Curve::Line(_) | Curve::Arc(_) | Curve::Bezier(_) | Curve::Spline(_) | Curve::Clothoid(_) => {
            // SVG has no other kinds.
            path.line_to(curve.end());
        }
    }
    path
}

/// The closed outlines of a path of lines and cubics.
fn subpaths_of(path: &BezPath) -> Vec<Vec<Curve>> {
    let mut outlines: Vec<Vec<Curve>> = Vec::new();
    let (mut start, mut at) = (Point::ORIGIN, Point::ORIGIN);
    for element in path.elements() {
        let (curve, to) = match *element {
            PathEl::MoveTo(p) => {
                outlines.push(Vec::new());
                start = p;
                (None, p)
            }
            PathEl::LineTo(p) => (side(at, p), p),
            PathEl::QuadTo(b, p) => (Curve::bezier(vec![at, b, p]).ok(), p),
            PathEl::CurveTo(b, c, p) => (Curve::bezier(vec![at, b, c, p]).ok(), p),
            PathEl::ClosePath => (side(at, start), start),
        };
        at = to;
        if let (Some(curve), Some(outline)) = (curve, outlines.last_mut()) {
            outline.push(curve);
        }
    }
    outlines.retain(|outline| !outline.is_empty());
    outlines
}
