//! Path data and basic shapes → curves (SVG 2, chapters 9 and 10). Arcs stay arcs.

use crate::curve::Curve;
use crate::geometry::{Point, Vec2, finest_decimal};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use svgtypes::{NumberListParser, PathParser, PathSegment};

/// Larger numbers are refused: their squares and products must stay finite.
pub(super) const HUGE: f64 = 1e30;
/// tan(π/8): the bulge of a quarter of a circle.
const QUARTER_BULGE: f64 = std::f64::consts::SQRT_2 - 1.0;

/// Curves that are joined end to end.
#[derive(Clone, Debug, Default)]
pub(super) struct Subpath {
    /// The curves, each beginning where the one before ends.
    pub curves: Vec<Curve>,
    /// Whether it was closed by a command. A subpath that only ends where it began has no join there.
    pub closed: bool,
}

impl Subpath {
    fn ends(&self) -> Option<(Point, Point)> {
        Some((self.curves.first()?.start(), self.curves.last()?.end()))
    }

    /// The line by which painting closes an open subpath.
    pub fn closing(&self) -> Option<Curve> {
        let (start, end) = self.ends()?;
        (start != end).then(|| Curve::line(end, start).ok())?
    }

    /// Whether all of it lies on one line, and so encloses no area.
    pub fn is_flat(&self) -> bool {
        let Some((start, _)) = self.ends() else { return true };
        let away = self.curves.iter().map(|c| c.end() - start).find(|v| *v != Vec2::ZERO).unwrap_or_default();
        self.curves.iter().all(|c| c.is_straight() && away.cross(c.end() - start) == 0.0)
    }
}

/// The outline of an element.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    /// The subpaths, in the order of the data.
    pub subpaths: Vec<Subpath>,
    /// Number of commands of zero length, which draw nothing.
    pub empty: usize,
    /// Where the data are wrong, in characters from their beginning, and why. The data before are drawn.
    pub broken: Option<(Option<usize>, String)>,
    /// A number that is too large.
    pub huge: Option<f64>,
    /// The unit of the last decimal of its numbers; 0 where all are whole.
    pub last_decimal: f64,
}

/// Draws subpaths, command by command.
#[derive(Default)]
struct Pen {
    outline: Outline,
    /// The beginning of the subpath.
    start: Point,
    at: Point,
    /// The last control point, if the last command was of this degree. S and T reflect it.
    control: Option<(usize, Point)>,
    /// Whether the next curve begins a subpath.
    fresh: bool,
}

impl Pen {
    fn move_to(&mut self, to: Point) {
        (self.start, self.at, self.control, self.fresh) = (to, to, None, true);
    }

    /// Adds a curve from the pen's place, and moves the pen to its end. A curve of zero length is counted.
    fn add(&mut self, curve: Option<Curve>, to: Point) {
        self.control = None;
        self.at = to;
        let Some(curve) = curve else {
            self.outline.empty += 1;
            return;
        };
        if std::mem::take(&mut self.fresh) {
            self.outline.subpaths.push(Subpath::default());
        }
        if let Some(subpath) = self.outline.subpaths.last_mut() {
            subpath.curves.push(curve);
        }
    }

    fn line_to(&mut self, to: Point) {
        let line = (self.at != to).then(|| Curve::line(self.at, to).ok()).flatten();
        self.add(line, to);
    }

    /// Adds a Bézier curve from the pen's place over these points.
    fn bezier_to(&mut self, rest: &[Point]) {
        let points: Vec<Point> = std::iter::once(self.at).chain(rest.iter().copied()).collect();
        let [.., control, to] = points[..] else { return };
        let degree = points.len() - 1;
        let curve = points.iter().any(|p| *p != to).then(|| Curve::bezier(points).ok()).flatten();
        self.add(curve, to);
        self.control = Some((degree, control));
    }

    /// The first control point of a smooth curve of this degree.
    fn reflected(&self, degree: usize) -> Point {
        match self.control {
            Some((d, control)) if d == degree => self.at + (self.at - control),
            _ => self.at,
        }
    }

    fn arc_to(&mut self, radii: Vec2, turned_deg: f64, large: bool, positive: bool, to: Point) {
        let from = self.at;
        if from == to {
            return self.add(None, to);
        }
        match arc(from, to, Vec2::new(radii.x.abs(), radii.y.abs()), turned_deg, large, positive) {
            Some(curve) => self.add(Some(curve), to),
            None => self.line_to(to),
        }
    }

    fn close(&mut self) {
        if !self.fresh {
            if self.at != self.start {
                self.line_to(self.start);
            }
            self.outline.subpaths.last_mut().into_iter().for_each(|subpath| subpath.closed = true);
        }
        self.move_to(self.start);
    }

    /// The outline. `finest` is the finest decimal of its numbers, infinite where all are whole.
    fn finish(self, finest: f64) -> Outline {
        let last_decimal = if finest.is_finite() { finest } else { 0.0 };
        Outline { last_decimal, ..self.outline }
    }

    fn draw(&mut self, segment: PathSegment) {
        let origin = if segment.is_abs() { Vec2::ZERO } else { self.at.to_vec2() };
        let point = |x: f64, y: f64| Point::new(x, y) + origin;
        match segment {
            PathSegment::MoveTo { x, y, .. } => self.move_to(point(x, y)),
            PathSegment::LineTo { x, y, .. } => self.line_to(point(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => self.line_to(Point::new(x + origin.x, self.at.y)),
            PathSegment::VerticalLineTo { y, .. } => self.line_to(Point::new(self.at.x, y + origin.y)),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                self.bezier_to(&[point(x1, y1), point(x2, y2), point(x, y)]);
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                self.bezier_to(&[self.reflected(3), point(x2, y2), point(x, y)]);
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => self.bezier_to(&[point(x1, y1), point(x, y)]),
            PathSegment::SmoothQuadratic { x, y, .. } => self.bezier_to(&[self.reflected(2), point(x, y)]),
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                self.arc_to(Vec2::new(rx, ry), x_axis_rotation, large_arc, sweep, point(x, y));
            }
            PathSegment::ClosePath { .. } => self.close(),
        }
    }
}

/// An elliptic arc from its ends (SVG 2, appendix B.2). Radii that are too small are enlarged until the ellipse reaches
/// both ends. `None`: the arc is a straight line.
///
/// ```text
///    Two ellipses of the given radii pass through both ends. `large` and `positive` choose one of four arcs.
///
///         . - ~ - .                 positive: the angle grows from the x axis (right) to the y axis (down).
///       ´           `               large: the arc sweeps more than half a turn.
///      |   large     |
///       `.         .´               center left or right of the chord (from → to), and half_sweep of the small arc:
///    from ●───┬───● to                tan(half_sweep) = share / height
///          `~ | ~´                    share:  half of the chord     } where the ellipse
///           small                     height: from chord to center  } is the unit circle
/// ```
fn arc(from: Point, to: Point, radii: Vec2, turned_deg: f64, large: bool, positive: bool) -> Option<Curve> {
    if radii.x == 0.0 || radii.y == 0.0 {
        return None;
    }
    let sign = if positive { 1.0 } else { -1.0 };
    let half_chord = (to - from) * 0.5;
    if radii.x == radii.y {
        let half = libm::hypot(half_chord.x, half_chord.y);
        // The distance of the center from the chord; 0 where the chord is a diameter.
        let height = ((radii.x - half) * (radii.x + half)).max(0.0).sqrt();
        let radius = radii.x.max(half);
        let bulge = if large { (radius + height) / half } else { half / (radius + height) };
        return Curve::bulge(from, to, sign * bulge).ok();
    }
    let (sin, cos) = libm::sincos(turned_deg.to_radians());
    let axis = Vec2::new(cos, sin);
    // A vector in coordinates where the ellipse is the unit circle.
    let in_circle = |v: Vec2| Vec2::new(v.dot(axis) / radii.x, axis.cross(v) / radii.y);
    let half = in_circle(half_chord);
    let reach = libm::hypot(half.x, half.y);
    let grown = reach.max(1.0);
    let (u, v) = (axis * (radii.x * grown), Vec2::new(-axis.y, axis.x) * (radii.y * grown));
    let half = half / grown;
    let share = libm::hypot(half.x, half.y).min(1.0);
    let height = ((1.0 - share) * (1.0 + share)).max(0.0).sqrt();
    // The center lies left of the chord where the arc is small and the sense is positive.
    let side = if large == positive { -1.0 } else { 1.0 };
    let center = Vec2::new(-half.y, half.x) * (side * height / share);
    let start = libm::atan2(-half.y - center.y, -half.x - center.x);
    let half_sweep = libm::atan2(share, height);
    let sweep = sign * if large { TAU - 2.0 * half_sweep } else { 2.0 * half_sweep };
    let middle = from + half_chord + (u * center.x + v * center.y);
    let mut curve = Curve::ellipse(middle, u, v, start, sweep).ok()?;
    if let Curve::Ellipse(ellipse) = &mut curve {
        ellipse.ends = [from, to];
    }
    Some(curve)
}

impl Outline {
    /// The outline of path data, up to its first error.
    pub fn of_path(data: &str) -> Self {
        let mut pen = Pen::default();
        let mut finest = f64::INFINITY;
        for segment in PathParser::from(data) {
            match segment {
                Ok(segment) => {
                    finest = finer(finest, numbers(&segment));
                    if let Some(huge) = numbers(&segment).into_iter().map(f64::abs).find(|n| *n > HUGE) {
                        pen.outline.huge = Some(huge);
                        break;
                    }
                    pen.draw(segment);
                    // Sums of relative moves may become too large.
                    if let Some(huge) = [pen.at.x, pen.at.y].into_iter().find(|x| x.abs() > HUGE) {
                        pen.outline.huge = Some(huge);
                        break;
                    }
                }
                Err(error) => {
                    pen.outline.broken = Some((position(&error), error.to_string()));
                    break;
                }
            }
        }
        pen.finish(finest)
    }

    /// The outline of a line.
    pub fn of_line(from: Point, to: Point) -> Self {
        let mut pen = Pen::default();
        pen.move_to(from);
        pen.line_to(to);
        pen.finish(finer(f64::INFINITY, [from.x, from.y, to.x, to.y]))
    }

    /// The polygon of these corners.
    pub fn of_corners(corners: &[Point]) -> Self {
        let mut pen = Pen::default();
        for (k, &corner) in corners.iter().enumerate() {
            if k == 0 { pen.move_to(corner) } else { pen.line_to(corner) }
        }
        pen.close();
        pen.outline
    }

    /// The outline of a polyline, or of a polygon if `closed`. An odd number at the end is an error, as in path data.
    pub fn of_points(data: &str, closed: bool) -> Self {
        let mut pen = Pen::default();
        let mut numbers = NumberListParser::from(data);
        let (mut first, mut finest) = (true, f64::INFINITY);
        while let Some(x) = numbers.next() {
            let (x, y) = match (x, numbers.next()) {
                (Ok(x), Some(Ok(y))) => (x, y),
                (Err(error), _) | (_, Some(Err(error))) => {
                    pen.outline.broken = Some((position(&error), error.to_string()));
                    break;
                }
                (Ok(_), None) => {
                    pen.outline.broken = Some((None, "an odd number of coordinates".into()));
                    break;
                }
            };
            pen.outline.huge = pen.outline.huge.or([x, y].into_iter().find(|x| x.abs() > HUGE));
            finest = finer(finest, [x, y]);
            if std::mem::take(&mut first) { pen.move_to(Point::new(x, y)) } else { pen.line_to(Point::new(x, y)) }
        }
        if closed {
            pen.close();
        }
        pen.finish(finest)
    }

    /// The rectangle with corners rounded by these radii, from the left of its upper edge, clockwise on the page.
    pub fn of_rect(corner: Point, size: Vec2, radii: Vec2) -> Self {
        let mut pen = Pen::default();
        if !(size.x > 0.0 && size.y > 0.0) {
            pen.outline.empty = 1;
            return pen.outline;
        }
        let r = Vec2::new(radii.x.min(0.5 * size.x), radii.y.min(0.5 * size.y));
        let far = corner + size;
        let round = r.x > 0.0 && r.y > 0.0;
        let r = if round { r } else { Vec2::ZERO };
        // For each edge: the beginning and the end of the corner after it.
        let corners = [
            (Point::new(far.x - r.x, corner.y), Point::new(far.x, corner.y + r.y)),
            (Point::new(far.x, far.y - r.y), Point::new(far.x - r.x, far.y)),
            (Point::new(corner.x + r.x, far.y), Point::new(corner.x, far.y - r.y)),
            (Point::new(corner.x, corner.y + r.y), Point::new(corner.x + r.x, corner.y)),
        ];
        pen.move_to(corners[3].1);
        for (k, (to, end)) in corners.into_iter().enumerate() {
            if pen.at != to {
                pen.line_to(to);
            }
            if round {
                pen.add(quarter(to, end, r, k), end);
            }
        }
        pen.close();
        pen.outline
    }

    /// The ellipse of these half axes, from its rightmost point towards positive y.
    pub fn of_ellipse(center: Point, radii: Vec2) -> Self {
        let mut pen = Pen::default();
        let curve = if !(radii.x > 0.0 && radii.y > 0.0) {
            None
        } else if radii.x == radii.y {
            Curve::circle(center, radii.x).ok()
        } else {
            Curve::ellipse(center, Vec2::new(radii.x, 0.0), Vec2::new(0.0, radii.y), 0.0, TAU).ok()
        };
        let start = center + Vec2::new(radii.x, 0.0);
        pen.move_to(start);
        pen.add(curve, start);
        pen.close();
        pen.outline
    }
}

/// The rounded corner k of a rectangle: a quarter of an ellipse in the positive sense. Corner 0 is the top right one.
fn quarter(from: Point, to: Point, r: Vec2, k: usize) -> Option<Curve> {
    if r.x == r.y {
        return Curve::bulge(from, to, QUARTER_BULGE).ok();
    }
    let start = [-FRAC_PI_2, 0.0, FRAC_PI_2, PI][k];
    let center = if matches!(k, 0 | 2) { Point::new(from.x, to.y) } else { Point::new(to.x, from.y) };
    let mut curve = Curve::ellipse(center, Vec2::new(r.x, 0.0), Vec2::new(0.0, r.y), start, FRAC_PI_2).ok()?;
    if let Curve::Ellipse(ellipse) = &mut curve {
        ellipse.ends = [from, to];
    }
    Some(curve)
}

/// The lengths and the arc's angle among the numbers of a segment; 0 in place of others.
fn numbers(segment: &PathSegment) -> [f64; 6] {
    match *segment {
        PathSegment::MoveTo { x, y, .. }
        | PathSegment::LineTo { x, y, .. }
        | PathSegment::SmoothQuadratic { x, y, .. } => [x, y, 0.0, 0.0, 0.0, 0.0],
        PathSegment::HorizontalLineTo { x, .. } => [x, 0.0, 0.0, 0.0, 0.0, 0.0],
        PathSegment::VerticalLineTo { y, .. } => [0.0, y, 0.0, 0.0, 0.0, 0.0],
        PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => [x1, y1, x2, y2, x, y],
        PathSegment::SmoothCurveTo { x2: x1, y2: y1, x, y, .. } | PathSegment::Quadratic { x1, y1, x, y, .. } => {
            [x1, y1, x, y, 0.0, 0.0]
        }
        PathSegment::EllipticalArc { rx, ry, x_axis_rotation, x, y, .. } => [rx, ry, x_axis_rotation, x, y, 0.0],
        PathSegment::ClosePath { .. } => [0.0; 6],
    }
}

/// The finer one of a unit and the last decimals of some numbers.
fn finer(unit: f64, numbers: impl IntoIterator<Item = f64>) -> f64 {
    match finest_decimal(numbers) {
        0.0 => unit,
        found => unit.min(found),
    }
}

/// The number of characters before an error in the data; `None` where the data end too early.
fn position(error: &svgtypes::Error) -> Option<usize> {
    match error {
        svgtypes::Error::UnexpectedData(at)
        | svgtypes::Error::InvalidNumber(at)
        | svgtypes::Error::InvalidChar(_, at)
        | svgtypes::Error::InvalidString(_, at) => Some(at.saturating_sub(1)),
        _ => None,
    }
}
