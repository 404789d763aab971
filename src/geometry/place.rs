//! Places, of the dimension of what lies there.

use super::Point;

/// A place in a drawing or in space: as JSON a list of its two or three coordinates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
#[serde(untagged)]
pub enum Place {
    /// In the plane: [x, y].
    Plane([f64; 2]),
    /// In space: [x, y, z].
    Space([f64; 3]),
}

impl Place {
    /// The coordinates: two or three.
    pub fn coordinates(&self) -> &[f64] {
        match self {
            Self::Plane(at) => at,
            Self::Space(at) => at,
        }
    }

    /// The coordinates of a place in the plane; `None` of one in space.
    pub fn in_plane(&self) -> Option<[f64; 2]> {
        match self {
            Self::Plane(at) => Some(*at),
            Self::Space(_) => None,
        }
    }
}

impl From<Point> for Place {
    fn from(p: Point) -> Self {
        Self::Plane([p.x, p.y])
    }
}

impl From<[f64; 2]> for Place {
    fn from(at: [f64; 2]) -> Self {
        Self::Plane(at)
    }
}

impl From<[f64; 3]> for Place {
    fn from(at: [f64; 3]) -> Self {
        Self::Space(at)
    }
}

impl PartialEq<[f64; 2]> for Place {
    fn eq(&self, other: &[f64; 2]) -> bool {
        self.coordinates() == other
    }
}

impl PartialEq<[f64; 3]> for Place {
    fn eq(&self, other: &[f64; 3]) -> bool {
        self.coordinates() == other
    }
}
