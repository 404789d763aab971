//! Vectors in space, and the frames of planes in it.

use super::{Frame, Point, Vec2};

/// The vector sum a + b.
#[inline]
pub fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + b[k])
}

/// The difference a − b.
#[inline]
pub fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// The vector `a` times a number.
#[inline]
pub fn times(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|x| x * factor)
}

/// The dot product a · b.
#[inline]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product a × b.
#[inline]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The Euclidean length of a vector.
pub fn length(a: [f64; 3]) -> f64 {
    libm::hypot(libm::hypot(a[0], a[1]), a[2])
}

/// The unit vector in the direction of `a`; `None` where `a` has no direction.
pub fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    // Scaled first, so that neither tiny nor huge vectors underflow or overflow.
    let scaled = times(a, super::unit_scale(a[0].abs().max(a[1].abs()).max(a[2].abs())));
    let length = length(scaled);
    (length > 0.0 && length.is_finite()).then(|| times(scaled, 1.0 / length))
}

impl Frame {
    /// The frame of the plane through `origin` perpendicular to `normal`. Its x axis is the projection of `toward`;
    /// where `toward` is parallel to the normal, the projection of a coordinate axis. `None` where the normal has no
    /// direction.
    pub fn of_plane(origin: [f64; 3], normal: [f64; 3], toward: [f64; 3]) -> Option<Self> {
        let normal = unit(normal)?;
        let within = |v: [f64; 3]| {
            let v = unit(v)?;
            let v = minus(v, times(normal, dot(v, normal)));
            // Below this the direction is only rounding.
            if length(v) > 1e-9 { unit(v) } else { None }
        };
        let x = within(toward).or_else(|| within([1.0, 0.0, 0.0])).or_else(|| within([0.0, 1.0, 0.0]))?;
        // Once more, so that x is perpendicular to the normal up to the last bit.
        let x = unit(minus(x, times(normal, dot(x, normal))))?;
        let y = unit(cross(normal, x))?;
        origin.iter().all(|c| c.is_finite()).then_some(Self { origin, x, y })
    }

    /// The unit normal x × y: seen from its side, the plane is counter-clockwise.
    pub fn normal(&self) -> [f64; 3] {
        cross(self.x, self.y)
    }

    /// The projection of a place in space onto the plane, in the coordinates of the frame.
    pub fn flat(&self, place: [f64; 3]) -> Point {
        self.flat_vector(minus(place, self.origin)).to_point()
    }

    /// The projection of a vector onto the plane, in the coordinates of the frame.
    pub fn flat_vector(&self, v: [f64; 3]) -> Vec2 {
        Vec2::new(dot(v, self.x), dot(v, self.y))
    }

    /// The signed distance of a place from the plane, positive on the side of the normal.
    pub fn height(&self, place: [f64; 3]) -> f64 {
        dot(minus(place, self.origin), self.normal())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn a_frame_is_orthonormal_and_gives_back_what_it_places() {
        let hints = [[3.0, -1.0, 0.5], [1.0, 2.0, -2.0], [0.0; 3], [1e-200, 0.0, 0.0]];
        for normal in [[1.0, 2.0, -2.0], [0.0, 0.0, 1e-150], [0.0, 1e200, 1e200], [-1.0, 0.0, 0.0]] {
            for toward in hints {
                let frame = Frame::of_plane([10.0, -20.0, 30.0], normal, toward).unwrap();
                let axes = [frame.x, frame.y, frame.normal()];
                for (i, a) in axes.iter().enumerate() {
                    for (j, b) in axes.iter().enumerate() {
                        assert_abs_diff_eq!(dot(*a, *b), f64::from(u8::from(i == j)), epsilon = 1e-15);
                    }
                }
                assert!(dot(frame.normal(), unit(normal).unwrap()) > 1.0 - 1e-15);
                let p = Point::new(1.25, -7.5);
                let place = plus(frame.place(p), times(frame.normal(), 0.5));
                assert_abs_diff_eq!(frame.flat(place).distance(p), 0.0, epsilon = 1e-13);
                assert_abs_diff_eq!(frame.height(place), 0.5, epsilon = 1e-13);
            }
        }
        assert_eq!(Frame::of_plane([0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]), None);
        assert_eq!(Frame::of_plane([0.0; 3], [f64::NAN, 0.0, 1.0], [1.0, 0.0, 0.0]), None);
    }
}
