//! Basic shapes of CSS that cut elements: `circle(…)`, `ellipse(…)`, `inset(…)`, `polygon(…)` and `path(…)` (CSS Shapes
//! 1).

use super::path::Outline;
use super::units::{Axis, Quantity, Viewport};
use super::{selector, transform};
use crate::geometry::{Point, Rect, Vec2};
use kurbo::Affine;

/// The outline of a basic shape in its reference box, and whether its fill rule is even-odd.
pub(super) fn basic_outline(text: &str, about: Rect, viewport: Viewport) -> Option<(Outline, bool)> {
    let (name, inner) = text.split_once('(')?;
    let inner = inner.strip_suffix(')')?.trim();
    // `at` precedes the centre, `round` precedes the radii of corners.
    let (head, tail) =
        [" at ", "at ", " round "].into_iter().find_map(|word| inner.split_once(word)).unwrap_or((inner, ""));
    let words: Vec<&str> = head.split_ascii_whitespace().collect();
    let shape = BasicShape { about, units: Viewport { size: about.size(), ..viewport } };
    let nonzero = |outline| Some((outline, false));
    match name.trim() {
        "circle" => nonzero(shape.circle(&words, shape.center(tail)?)?),
        "ellipse" => nonzero(shape.ellipse(&words, shape.center(tail)?)?),
        "inset" => nonzero(shape.inset(&words, tail)?),
        "polygon" => shape.polygon(inner),
        "path" => Some(shape.path(inner)),
        _ => None,
    }
}

/// A basic shape: its reference box, and the viewport that its lengths refer to.
struct BasicShape {
    about: Rect,
    units: Viewport,
}

impl BasicShape {
    fn center(&self, place: &str) -> Option<Point> {
        match place.trim() {
            "" => Some(self.about.center()),
            place => Some(self.about.origin() + transform::origin(place, self.about.size(), self.units)?),
        }
    }

    fn circle(&self, words: &[&str], center: Point) -> Option<Outline> {
        let about = self.about;
        let sides = [center.x - about.x0, about.x1 - center.x, center.y - about.y0, about.y1 - center.y].map(f64::abs);
        let radius = match *words {
            [] | ["closest-side"] => sides.into_iter().fold(f64::INFINITY, f64::min),
            ["farthest-side"] => sides.into_iter().fold(0.0, f64::max),
            [radius] => self.units.length(radius, Axis::Both)?,
            _ => return None,
        };
        Some(Outline::of_ellipse(center, Vec2::new(radius, radius)))
    }

    fn ellipse(&self, words: &[&str], center: Point) -> Option<Outline> {
        let about = self.about;
        let near = |a: f64, b: f64| a.abs().min(b.abs());
        let radii = match *words {
            [] | ["closest-side", "closest-side"] => Vec2::new(
                near(center.x - about.x0, about.x1 - center.x),
                near(center.y - about.y0, about.y1 - center.y),
            ),
            [rx, ry] => Vec2::new(self.units.length(rx, Axis::X)?, self.units.length(ry, Axis::Y)?),
            _ => return None,
        };
        Some(Outline::of_ellipse(center, radii))
    }

    /// An inset rectangle. `corners` are the radii of its corners, empty where it has none.
    fn inset(&self, words: &[&str], corners: &str) -> Option<Outline> {
        let (about, length) = (self.about, |word: &str, axis| self.units.length(word, axis));
        let side = |k: usize, axis| length(words.get(k)?, axis);
        // Top, right, bottom, left. A missing side equals the opposite one.
        let top = side(0, Axis::Y)?;
        let right = side(1, Axis::X).or(side(0, Axis::X))?;
        let bottom = side(2, Axis::Y).unwrap_or(top);
        let left = side(3, Axis::X).unwrap_or(right);
        let size = Vec2::new(about.width() - left - right, about.height() - top - bottom);
        let mut radii = corners.split_ascii_whitespace();
        let round = match (radii.next(), radii.next()) {
            (None, _) => Vec2::ZERO,
            (Some(radius), None) => Vec2::new(length(radius, Axis::X)?, length(radius, Axis::Y)?),
            (Some(_), Some(_)) => return None,
        };
        Some(Outline::of_rect(Point::new(about.x0 + left, about.y0 + top), size, round))
    }

    fn polygon(&self, inner: &str) -> Option<(Outline, bool)> {
        let mut pieces: Vec<&str> = selector::list(inner).map(str::trim).collect();
        let even_odd = pieces.first() == Some(&"evenodd");
        if matches!(pieces.first(), Some(&"evenodd" | &"nonzero")) {
            pieces.remove(0);
        }
        let corner = |pair: &&str| {
            let (x, rest) = Quantity::first(pair.trim())?;
            let y = Quantity::parse(rest)?;
            Some(self.about.origin() + Vec2::new(self.units.measure(x, Axis::X)?, self.units.measure(y, Axis::Y)?))
        };
        let corners: Vec<Point> = pieces.iter().map(corner).collect::<Option<_>>()?;
        Some((Outline::of_corners(&corners), even_odd))
    }

    fn path(&self, inner: &str) -> (Outline, bool) {
        let (rule, data) = inner.split_once(',').filter(|(rule, _)| !rule.contains(['"', '\''])).unwrap_or(("", inner));
        let data = data.trim().trim_matches(['"', '\'']);
        let mut outline = Outline::of_path(data);
        let shift = Affine::translate(self.about.origin().to_vec2());
        outline.subpaths = outline.subpaths.into_iter().map(|s| s.transformed(shift)).collect();
        (outline, rule.trim() == "evenodd")
    }
}
