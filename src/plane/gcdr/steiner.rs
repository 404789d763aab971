//! Steiner strategies: the choice of the point inside a selection region.
//!
//! ```text
//!         . - ~ ~ - .      Selection disk of the skinny triangle p q r, whose shortest edge is p q:
//!      .´   . - .   `.     around the circumcenter c, of radius reach = r(1 − δ₂) or r − δ₂ρ̄|pq|,
//!     r    : reach :  :    where r is the circumradius. The point is chosen in it.
//!     :    :   c   :  :
//!      `.   ` - ´   .´
//!       p ─ ~ ~ ─ q
//!
//!   x ●──────┤░░░░░░░░░░░░░░├──────● y   Selection interval of the segment s = x y: shares of the way
//!       interval[0]    interval[1]       from x to y, in the middle part |s|(1 − δ₁) or |s|(1 − μ).
//! ```

use super::parameters::radius_edge_of;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::rng::Rng;
use crate::geometry::{Point, Rect, direction};
use std::f64::consts::TAU;

/// A skinny triangle, and the disk in which its point is chosen; in the domain's own coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Skinny {
    /// Counter-clockwise; the first two are the ends of its shortest edge.
    pub corners: [Point; 3],
    /// The corner across each side (0: between corners 0 and 1, and so on); `None` where the side is a segment, or on
    /// the hull.
    pub across: [Option<Point>; 3],
    /// The circumcenter.
    pub center: Point,
    /// The circumradius.
    pub radius: f64,
    /// Radius of the disk around `center`, as the strategy's [`Disks`] say.
    pub reach: f64,
    /// The longest edge permitted there; infinite where there is no limit.
    pub size: f64,
}

/// An encroached segment, and the interval in which its point is chosen.
#[derive(Clone, Copy, Debug)]
pub struct Encroached {
    /// The start and the end of the segment.
    pub ends: [Point; 2],
    /// Shares of the way from end to end: the middle part of 1−δ₁ (type B) or 1−μ (type C).
    pub interval: [f64; 2],
    /// Whether a visible vertex that is not free lies in the diametral circle.
    pub type_c: bool,
}

/// Which skinny triangle is refined first. Algorithm 2 leaves it open; it changes the number of triangles by up to a
/// fourth.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Order {
    /// The triangle with the smallest angle.
    SmallestAngle,
    /// The triangle with the shortest edge.
    ShortestEdge,
    /// The triangle with the smallest circumcircle.
    SmallestCircle,
}

/// How large the selection disk of a skinny triangle is, of circumradius r and shortest edge l.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Disks {
    /// r(1−δ₂), as printed (Definition 3.1).
    Alike,
    /// r − δ₂ρ̄l: a larger part of the circle for a skinnier triangle, as in the second kind of disk of Chernikov &
    /// Chrisochoides (2009).
    ///
    /// That is Definition 3.1 with δ = δ₂ρ̄l/r in place of δ₂, a value for each triangle. Theorem 4.6 holds with the
    /// constants as printed. Case (1): R(p) ≥ δr = C₁l. Case (2): Lemma 4.5 needs only δ ≥ l/r, and δ₂ρ̄ ≥ 1 by (3.1).
    /// Case (3): half the segment is at least √(r² − (r − δ₂ρ̄l)²). That grows with r, and at r = ρ̄l it is the value
    /// of (4.5). So insertion radii are bounded, and refinement terminates, where C₁C₂ > 1. Densities are not bounded:
    /// B₁ = (2−δ)/δ has no largest value.
    ByShape,
}

/// F_A, F_B and F_C of Algorithm 2. The point is moved to the nearest place in the region, unless the strategy is
/// [free](Self::is_free).
pub trait SteinerStrategy {
    /// F_A: a point of the selection disk. It is also called for triangles that are only too large, unless the strategy
    /// is free.
    fn in_disk(&mut self, triangle: &Skinny) -> Point;

    /// F_B and F_C: the split point, as a share of the way from end to end within the interval.
    fn on_segment(&mut self, _segment: &Encroached) -> f64 {
        0.5
    }

    /// Which triangle comes first. Another order than by angle suits strategies whose points are far from the shortest
    /// edge.
    fn order(&self) -> Order {
        Order::SmallestAngle
    }

    /// The size of the disks for its points of type A. `ByShape` is for strategies whose points are far from the
    /// shortest edge in any case. Above 30° only equal disks shrink to centres, and a strategy that places points near
    /// edges there may not end before the budget.
    fn disks(&self) -> Disks {
        Disks::Alike
    }

    /// Whether its points of type A are taken as they are, in the region or not. Then nothing is proven.
    fn is_free(&self) -> bool {
        false
    }
}

/// The centre of every region: Chew's second algorithm.
#[derive(Clone, Copy, Debug, Default)]
pub struct Center;

impl SteinerStrategy for Center {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        triangle.center
    }
}

/// The off-centre (Üngör 2004): the place on the way to the circumcenter that is farthest from the shortest edge while
/// its triangle with that edge is not skinny. It is at least 0.95cos²(κ/2)/sin κ > ρ̄ edge lengths from that edge, so
/// it lies in its [disk](Disks::ByShape) as long as δ₂ ≤ 1.
#[derive(Clone, Copy, Debug)]
pub struct OffCenter {
    /// Distance from the shortest edge, in lengths of that edge.
    height: f64,
    free: bool,
}

impl OffCenter {
    /// `free`: points may lie outside the selection disks.
    pub fn new(angle_min_rad: f64, free: bool) -> Self {
        // A triangle of exactly that height might be skinny by rounding: it is 5 % lower.
        Self { height: 0.475 / libm::tan(0.5 * angle_min_rad), free }
    }

    fn point(&self, triangle: &Skinny) -> Point {
        let [p, q, _] = triangle.corners;
        let middle = p.midpoint(q);
        let (away, height) = (triangle.center - middle, self.height * p.distance(q));
        if away.hypot() <= height { triangle.center } else { middle + away * (height / away.hypot()) }
    }
}

impl SteinerStrategy for OffCenter {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        self.point(triangle)
    }

    fn order(&self) -> Order {
        Order::ShortestEdge
    }

    fn disks(&self) -> Disks {
        Disks::ByShape
    }

    fn is_free(&self) -> bool {
        self.free
    }
}

/// A point on the border of a petal might make a skinny triangle by rounding: the petal is smaller by this factor.
const PETAL: f64 = 0.98;

/// The locally optimal point (Erten & Üngör 2007). The *petal* of the shortest edge holds the places whose triangle
/// with that edge is not skinny. The point is the place in it that is farthest from the vertices of the triangle and
/// its neighbours.
#[derive(Clone, Copy, Debug)]
pub struct Optimal {
    off_center: OffCenter,
    rho: f64,
}

impl Optimal {
    /// `free`: points may lie outside the selection disks.
    pub fn new(angle_min_rad: f64, free: bool) -> Self {
        Self { off_center: OffCenter::new(angle_min_rad, free), rho: radius_edge_of(angle_min_rad) }
    }
}

impl SteinerStrategy for Optimal {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        let [p, q, r] = triangle.corners;
        let shortest = p.distance(q);
        let radius = PETAL * self.rho * shortest;
        let toward = (triangle.center - p.midpoint(q)) / (triangle.center.distance(p.midpoint(q)));
        let height = (radius * radius - 0.25 * shortest * shortest).max(0.0).sqrt();
        let petal = p.midpoint(q) + toward * height;
        let known = || [p, q, r].into_iter().chain(triangle.across.into_iter().flatten());
        let room = |at: Point| known().map(|v| v.distance(at)).fold(f64::INFINITY, f64::min);
        // Circumcenters of the neighbours across the longer sides. If one lies outside the petal, the candidate is
        // where the way to it leaves the petal.
        let around = [(q, r, triangle.across[1]), (r, p, triangle.across[2])];
        let vertices = around.into_iter().filter_map(|(a, b, across)| circumcenter([b, a, across?]));
        let candidates = vertices.filter_map(|voronoi| {
            if voronoi.distance(petal) <= radius {
                Some(voronoi)
            } else {
                leaves_disk(triangle.center, voronoi, petal, radius)
            }
        });
        let first = self.off_center.point(triangle);
        candidates.fold(first, |best, at| if room(at) > room(best) * (1.0 + 1e-9) { at } else { best })
    }

    fn order(&self) -> Order {
        if self.off_center.free { Order::SmallestCircle } else { Order::ShortestEdge }
    }

    fn disks(&self) -> Disks {
        Disks::ByShape
    }

    fn is_free(&self) -> bool {
        self.off_center.free
    }
}

fn circumcenter([a, b, c]: [Point; 3]) -> Option<Point> {
    let (u, v) = (b - a, c - a);
    let double = 2.0 * u.cross(v);
    let to_center =
        crate::geometry::Vec2::new(v.y * u.hypot2() - u.y * v.hypot2(), u.x * v.hypot2() - v.x * u.hypot2());
    Some(a + to_center / double).filter(|p| double != 0.0 && p.is_finite())
}

/// The last place on the segment from `a` to `b` that lies on the border of a disk.
fn leaves_disk(a: Point, b: Point, center: Point, radius: f64) -> Option<Point> {
    let (d, f) = (b - a, a - center);
    let (dd, df, ff) = (d.hypot2(), d.dot(f), f.hypot2() - radius * radius);
    let root = df * df - dd * ff;
    if root < 0.0 || dd == 0.0 {
        return None;
    }
    [(-df + root.sqrt()) / dd, (-df - root.sqrt()) / dd]
        .into_iter()
        .find(|t| (0.0..=1.0).contains(t))
        .map(|t| a + d * t)
}

/// The place on the border of the region that is nearest to a corner of the triangle or an end of the segment
/// (experiment 1 of the paper).
#[derive(Clone, Copy, Debug, Default)]
pub struct Extreme;

impl SteinerStrategy for Extreme {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        triangle.center + (triangle.corners[0] - triangle.center) * (triangle.reach / triangle.radius)
    }

    fn on_segment(&mut self, segment: &Encroached) -> f64 {
        segment.interval[0]
    }
}

/// A random place in the region, seeded (experiment 2).
#[derive(Clone, Debug)]
pub struct Random(Rng);

impl Random {
    /// The strategy with a seed: the same seed gives the same points in the same run.
    pub fn new(seed: u64) -> Self {
        Self(Rng::new(seed))
    }
}

impl SteinerStrategy for Random {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        let (angle, share) = (self.0.between(0.0, TAU), self.0.between(0.0, 1.0));
        triangle.center + direction(angle) * (triangle.reach * share.sqrt())
    }

    fn on_segment(&mut self, segment: &Encroached) -> f64 {
        let [from, to] = segment.interval;
        if from < to { self.0.between(from, to) } else { from }
    }
}

/// The point of a square grid nearest to the centre, if it lies in the region; else the centre.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// The distance between neighbouring grid points; the origin is one of them.
    pub pitch: f64,
}

impl SteinerStrategy for Grid {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        let snap = |x: f64| (x / self.pitch).round() * self.pitch;
        let at = Point::new(snap(triangle.center.x), snap(triangle.center.y));
        if at.distance(triangle.center) <= triangle.reach { at } else { triangle.center }
    }
}

/// The given place nearest to the centre, if it lies in the region; else the centre.
pub struct Places {
    places: Vec<Point>,
    boxes: BoxHierarchy,
}

impl Places {
    /// The strategy that chooses among the given places.
    pub fn new(places: impl IntoIterator<Item = Point>) -> Self {
        let places: Vec<Point> = places.into_iter().collect();
        let boxes = BoxHierarchy::new(places.iter().map(|&p| Rect::from_points(p, p)));
        Self { places, boxes }
    }
}

impl SteinerStrategy for Places {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        let away = |i: usize, _| self.places[i].distance(triangle.center);
        let nearest = self.boxes.nearest(triangle.center, triangle.reach, away);
        nearest.map_or(triangle.center, |(i, _)| self.places[i])
    }
}

/// The place on the way from the shortest edge to the centre at which the new edges to its ends have the permitted
/// length. The centre, where that is nearer or there is no limit.
#[derive(Clone, Copy, Debug, Default)]
pub struct BySize;

impl SteinerStrategy for BySize {
    fn in_disk(&mut self, triangle: &Skinny) -> Point {
        let [p, q, _] = triangle.corners;
        let middle = p.midpoint(q);
        let (half, away) = (0.5 * p.distance(q), triangle.center - middle);
        let height = (triangle.size * triangle.size - half * half).max(0.0).sqrt();
        if height < away.hypot() { middle + away * (height / away.hypot()) } else { triangle.center }
    }
}
