//! How large a cell may be, and where: limits on edges, areas, chord error and turning; per name; near sources; graded.

use crate::domain::Domain;
use crate::geometry::{Point, boxes};
use crate::ids::{CurveId, RegionId};

/// What is asked of cell sizes, in the drawing's units. `None` and empty: no limit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sizing {
    pub max_area: Option<f64>,
    pub max_edge: Option<f64>,
    /// Triangles with a circumradius below this are not refined for their angles.
    pub min_edge: Option<f64>,
    /// Largest distance from a mesh edge to its curve.
    pub chord_error: Option<f64>,
    /// Largest turning of the curve along a mesh edge.
    pub edge_turning_rad: Option<f64>,
    /// Growth of the limit a unit of distance away from a sized boundary.
    pub grade: Option<f64>,
    pub sources: Vec<Source>,
}

/// Where a size is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Edges on the boundary of this name.
    Boundary { name: String, edge: f64 },
    /// Edges in the region of this name.
    Region { name: String, edge: f64 },
    /// Cells near a segment, growing by `grade` a unit of distance.
    Near { from: Point, to: Point, edge: f64, grade: f64 },
}
