//! Geometry of numbers only, without curves or meshes: points and vectors, exact signs, insertion order, box hierarchy,
//! planes in space, numbers in text.

pub mod boxes;
pub mod exact;
pub mod exact_space;
mod expansion;
pub mod order;
pub mod order_space;
mod place;
pub mod rng;
pub mod space;
pub mod triangle;
pub mod written;

pub use kurbo::{Point, Rect, Vec2};
pub use place::Place;

/// The power of two that scales a coordinate magnitude to between ½ and 1; 1 for 0 and for numbers that are not finite.
///
/// Multiplying by it is exact, so a computation on scaled coordinates gives the same bits at every scale. The
/// expansions behind the exact signs overflow near 1e60 and underflow near 1e-60; scaled input is far from both.
pub fn unit_scale(magnitude: f64) -> f64 {
    if magnitude == 0.0 || !magnitude.is_finite() {
        return 1.0;
    }
    let (_, exponent) = libm::frexp(magnitude);
    libm::ldexp(1.0, -exponent)
}

/// One unit of the last decimal of a number that was read from text: 0.001 of 1.275, 0.1 of 3.0e1 + 0.5, 0 of a whole
/// number.
///
/// The shortest text that reads as the same number is the text that was written, except for zeros at its end.
pub fn last_decimal(x: f64) -> f64 {
    let text = format!("{:e}", x.abs());
    let Some((digits, exponent)) = text.split_once('e') else { return 0.0 };
    let decimals = digits.len().saturating_sub(2) as i32 - exponent.parse().unwrap_or(0);
    if decimals > 0 { libm::pow(10.0, -f64::from(decimals)) } else { 0.0 }
}

/// The smallest unit of the last decimal of several numbers; 0 where all are whole.
pub fn finest_decimal(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let units = numbers.into_iter().map(last_decimal).filter(|&unit| unit > 0.0);
    units.reduce(f64::min).unwrap_or(0.0)
}

/// The largest absolute coordinate of a box.
pub fn magnitude(bounds: Rect) -> f64 {
    bounds.x0.abs().max(bounds.x1.abs()).max(bounds.y0.abs()).max(bounds.y1.abs())
}

/// The length of a box's diagonal.
pub fn extent(bounds: Rect) -> f64 {
    bounds.size().to_vec2().hypot()
}

/// The smallest box around some points; `None` where there are none.
pub fn bounds_of(points: impl IntoIterator<Item = Point>) -> Option<Rect> {
    points.into_iter().map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))
}

/// `p` times a power of two, exact.
pub fn scaled(p: Point, factor: f64) -> Point {
    Point::new(p.x * factor, p.y * factor)
}

/// The unit vector at an angle from the x axis, counter-clockwise.
pub fn direction(angle_rad: f64) -> Vec2 {
    Vec2::new(libm::cos(angle_rad), libm::sin(angle_rad))
}

/// Angle from `u` counter-clockwise to `v`, in (−π, π].
pub fn turn_from(u: Vec2, v: Vec2) -> f64 {
    libm::atan2(u.cross(v), u.dot(v))
}

/// An orthonormal frame of a plane in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The place in space of the plane's origin.
    pub origin: [f64; 3],
    /// The unit vector along the plane's x axis.
    pub x: [f64; 3],
    /// The unit vector along the plane's y axis, perpendicular to `x`.
    pub y: [f64; 3],
}

impl Frame {
    /// The place in space of a point of the plane.
    pub fn place(&self, p: Point) -> [f64; 3] {
        std::array::from_fn(|k| self.origin[k] + p.x * self.x[k] + p.y * self.y[k])
    }
}

/// The length of a unit in metres. The unit may have a factor before it ("0.35 mm"). `None` for a unit that has no
/// fixed size ("chord", …) or is unknown.
pub fn metres(unit: &str) -> Option<f64> {
    if let Some((factor, unit)) = unit.split_once(' ') {
        let factor: f64 = factor.parse().ok().filter(|f: &f64| f.is_finite() && *f > 0.0)?;
        return metres_of_word(unit).map(|metres| factor * metres);
    }
    metres_of_word(unit)
}

fn metres_of_word(unit: &str) -> Option<f64> {
    let metres = match unit {
        "angstrom" => 1e-10,
        "nm" => 1e-9,
        "um" | "µm" => 1e-6,
        "mm" => 1e-3,
        "cm" => 1e-2,
        "dm" => 0.1,
        "m" => 1.0,
        "dam" => 10.0,
        "hm" => 100.0,
        "km" => 1e3,
        "Gm" => 1e9,
        "uin" => 2.54e-8,
        "mil" => 2.54e-5,
        "in" => 0.0254,
        "ft" => 0.3048,
        "yd" => 0.9144,
        "mi" => 1609.344,
        // The survey foot is 1200/3937 m (NIST Special Publication 811, B.6).
        "us-in" => 100.0 / 3937.0,
        "us-ft" => 1200.0 / 3937.0,
        "us-yd" => 3600.0 / 3937.0,
        "us-mi" => 5280.0 * 1200.0 / 3937.0,
        // Resolutions B2 of 2012 and 2015 of the International Astronomical Union.
        "au" => 149_597_870_700.0,
        "ly" => 9_460_730_472_580_800.0,
        "parsec" => 3.085_677_581_491_367e16,
        "pt" => 0.0254 / 72.0,
        "pc" => 0.0254 / 6.0, // CSS: a pica
        "px" => 0.0254 / 96.0,
        _ => return None,
    };
    Some(metres)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_may_have_a_factor() {
        assert_eq!(metres("0.5 mm"), Some(0.5e-3));
        assert_eq!(metres("px"), metres("in").map(|inch| inch / 96.0));
        for wrong in ["chord", "-1 mm", "0 mm", "nan mm", "mm mm", "2 3 mm", " mm", "2 "] {
            assert_eq!(metres(wrong), None, "{wrong}");
        }
    }
}
