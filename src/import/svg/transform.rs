//! Transforms: the attribute and the property `transform`, the properties `translate`, `rotate` and `scale`, and their
//! origin (SVG 2, chapter 8; CSS Transforms 2).

use super::style::{Declared, Property};
use super::units::{Axis, Quantity, Viewport};
use crate::geometry::{Rect, Vec2};
use kurbo::{Affine, Size};

/// A map that compresses one direction by more than this leaves nothing visible.
const SQUEEZE_MIN: f64 = 1e-12;

/// The box that percentages and origins refer to; `None` where an element refers to its own box and has no extent.
pub(super) type ReferenceBox = Option<Rect>;

/// Whether the transform of an element depends on the box of the element.
pub(super) fn asks_for_own_box(declared: &Declared) -> bool {
    matches!(declared.given(Property::TransformBox), Some("fill-box" | "content-box" | "stroke-box" | "border-box"))
}

/// Whether a map reduces areas to nothing.
pub(super) fn is_flat(map: Affine) -> bool {
    let [a, b, c, d, ..] = map.as_coeffs();
    let size = a * a + b * b + c * c + d * d;
    map.determinant().abs() <= SQUEEZE_MIN * size
}

/// The map of an element. `Err` has the text that cannot be read.
///
/// ```text
///    map = T(origin) · translate · rotate · scale · transform · T(−origin)
///          ╰────────────────────── applied last ◀── applied first ──────╯
///
///    A point of the element is moved to the origin, then goes through `transform` (its functions from right to left),
///    `scale`, `rotate` and `translate`, and is moved back. The maps of the groups around it follow, from inside out.
/// ```
pub(super) fn of<'a>(declared: &Declared<'a>, viewport: Viewport, own: ReferenceBox) -> Result<Affine, &'a str> {
    let parts = [Property::Translate, Property::Rotate, Property::Scale, Property::Transform];
    if parts.into_iter().all(|part| declared.given(part).is_none()) {
        return Ok(Affine::IDENTITY);
    }
    let whole = Rect::from_origin_size((0.0, 0.0), viewport.size);
    let about = if asks_for_own_box(declared) { own.unwrap_or_default() } else { whole };
    // Percentages of both coordinates refer to the box.
    let units = Viewport { size: about.size(), ..viewport };
    let read = |part: Property, map: &dyn Fn(&'a str) -> Option<Affine>| match declared.given(part) {
        None | Some("none") => Ok(Affine::IDENTITY),
        Some(text) => map(text).ok_or(text),
    };
    let map = read(Property::Translate, &|text| translate(text, units))?
        * read(Property::Rotate, &rotate)?
        * read(Property::Scale, &scale)?
        * read(Property::Transform, &|text| list(text, units))?;
    let origin = match declared.given(Property::TransformOrigin) {
        None => Vec2::ZERO,
        Some(text) => about.origin().to_vec2() + origin(text, about.size(), units).ok_or(text)?,
    };
    Ok(Affine::translate(origin) * map * Affine::translate(-origin))
}

/// Cosine and sine of an angle in degrees; exact at quarter turns.
fn direction(degrees: f64) -> Vec2 {
    let quarters = degrees / 90.0;
    if quarters == libm::floor(quarters) {
        let turns = quarters - 4.0 * libm::floor(quarters / 4.0);
        return [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0)][turns as usize];
    }
    let (sin, cos) = libm::sincos(degrees.to_radians());
    Vec2::new(cos, sin)
}

fn turn(degrees: f64) -> Affine {
    let Vec2 { x, y } = direction(degrees);
    Affine::new([x, y, -y, x, 0.0, 0.0])
}

/// Quantities separated by blanks and at most one comma each; `None` where the text holds anything else.
fn quantities(text: &str) -> Option<Vec<Quantity<'_>>> {
    let mut found = Vec::new();
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (quantity, after) = Quantity::first(rest)?;
        found.push(quantity);
        let after = after.trim_start();
        rest = after.strip_prefix(',').unwrap_or(after).trim_start();
    }
    Some(found)
}

/// A number without unit, or a percentage as a number.
fn factor(quantity: Quantity) -> Option<f64> {
    match quantity.unit {
        "" => Some(quantity.number),
        "%" => Some(quantity.number / 100.0),
        _ => None,
    }
}

/// The map of a list of transform functions.
fn list(text: &str, units: Viewport) -> Option<Affine> {
    let mut map = Affine::IDENTITY;
    let mut rest = text.trim();
    while !rest.is_empty() {
        let (name, after) = rest.split_once('(')?;
        let (inner, after) = after.split_once(')')?;
        map *= function(name.trim(), &quantities(inner)?, units)?;
        rest = after.trim_start();
        rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
    }
    Some(map)
}

/// One transform function. Of the functions of space those are read that stay in the plane.
fn function(name: &str, given: &[Quantity], units: Viewport) -> Option<Affine> {
    let (x, y) = (|q: Quantity| units.measure(q, Axis::X), |q: Quantity| units.measure(q, Axis::Y));
    let slope = |q: Quantity| Some(libm::tan(q.degrees()?.to_radians()));
    Some(match (name, given) {
        ("matrix", &[a, b, c, d, e, f]) => Affine::new([factor(a)?, factor(b)?, factor(c)?, factor(d)?, x(e)?, y(f)?]),
        ("translate" | "translateX", &[tx]) => Affine::translate((x(tx)?, 0.0)),
        ("translateY", &[ty]) => Affine::translate((0.0, y(ty)?)),
        ("translate", &[tx, ty]) | ("translate3d", &[tx, ty, _]) => Affine::translate((x(tx)?, y(ty)?)),
        ("scale", &[s]) => Affine::scale(factor(s)?),
        ("scaleX", &[s]) => Affine::scale_non_uniform(factor(s)?, 1.0),
        ("scaleY", &[s]) => Affine::scale_non_uniform(1.0, factor(s)?),
        ("scale", &[sx, sy]) | ("scale3d", &[sx, sy, _]) => Affine::scale_non_uniform(factor(sx)?, factor(sy)?),
        ("rotate" | "rotateZ", &[angle]) => turn(angle.degrees()?),
        ("rotate", &[angle, cx, cy]) => {
            let center = Vec2::new(x(cx)?, y(cy)?);
            Affine::translate(center) * turn(angle.degrees()?) * Affine::translate(-center)
        }
        ("skewX", &[angle]) | ("skew", &[angle]) => Affine::new([1.0, 0.0, slope(angle)?, 1.0, 0.0, 0.0]),
        ("skewY", &[angle]) => Affine::new([1.0, slope(angle)?, 0.0, 1.0, 0.0, 0.0]),
        ("skew", &[along, up]) => Affine::new([1.0, slope(up)?, slope(along)?, 1.0, 0.0, 0.0]),
        _ => return None,
    })
}

fn translate(text: &str, units: Viewport) -> Option<Affine> {
    match quantities(text)?[..] {
        [x] => function("translate", &[x], units),
        [x, y] | [x, y, _] => function("translate", &[x, y], units),
        _ => None,
    }
}

fn rotate(text: &str) -> Option<Affine> {
    // `z 45deg` is a rotation about the axis normal to the plane.
    let text = text.trim();
    let angle = Quantity::parse(text.strip_prefix('z').or(text.strip_suffix('z')).unwrap_or(text))?;
    Some(turn(angle.degrees()?))
}

fn scale(text: &str) -> Option<Affine> {
    match quantities(text)?[..] {
        [s] => Some(Affine::scale(factor(s)?)),
        [x, y] | [x, y, _] => Some(Affine::scale_non_uniform(factor(x)?, factor(y)?)),
        _ => None,
    }
}

/// The origin of a transform, from the corner of its box.
pub(super) fn origin(text: &str, size: Size, units: Viewport) -> Option<Vec2> {
    let words: Vec<&str> = text.split([' ', ',', '\t', '\n']).filter(|word| !word.is_empty()).collect();
    let share = |word: &str| match word {
        "left" | "top" => Some(0.0),
        "center" => Some(0.5),
        "right" | "bottom" => Some(1.0),
        _ => None,
    };
    let along = |word: &str| share(word).map(|s| s * size.width).or_else(|| units.length(word, Axis::X));
    let up = |word: &str| share(word).map(|s| s * size.height).or_else(|| units.length(word, Axis::Y));
    match words[..] {
        [one @ ("top" | "bottom")] => Some(Vec2::new(0.5 * size.width, up(one)?)),
        [one] => Some(Vec2::new(along(one)?, 0.5 * size.height)),
        [y @ ("top" | "bottom"), x, ..] | [y, x @ ("left" | "right"), ..] => Some(Vec2::new(along(x)?, up(y)?)),
        [x, y, ..] => Some(Vec2::new(along(x)?, up(y)?)),
        [] => None,
    }
}
