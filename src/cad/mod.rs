//! From planar faces of solids to a [`Drawing`]: curves in space are projected into the plane of the face, each in its
//! own kind.
//!
//! `truck.rs` provides the faces of truck's solids, `import/step.rs` those of STEP files. Curved faces and solids are
//! future work.

mod edge;
pub mod truck;

pub use edge::{Edge, SpaceCurve};

use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve, FillRule, Shape};
use crate::geometry::{Frame, Point, Rect, bounds_of};

/// The largest distance, as a share of the face's diagonal, of an edge from the plane or from its vertices, unless the
/// file states more: the accuracy of modellers that write six digits. It is also the widest gap that
/// [`Drawing::arrange`] closes by default.
const SLACK: f64 = 1e-6;
/// Projections farther than this share of the diagonal are reported in a note.
const ROUNDING: f64 = 1e-9;

/// A planar face in space: a region of its plane, bounded by closed loops of edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The frame of its plane; the normal points out of the solid.
    pub frame: Frame,
    /// The name of the face.
    pub name: String,
    /// Where it came from, for messages: "ADVANCED_FACE #12".
    pub entity: String,
    /// The edges of each loop, end to end, in either sense.
    pub loops: Vec<Vec<Edge>>,
    /// The accuracy that the file states, as a length; 0 where it does not.
    pub uncertainty: f64,
}

/// Why a face cannot be projected into its plane.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{entity} {what} near ({}, {}, {})", at[0], at[1], at[2])]
pub struct FaceError {
    /// The face, or an edge of it.
    pub entity: String,
    /// What is wrong, as a predicate of the entity.
    pub what: String,
    /// A place in space.
    pub at: [f64; 3],
}

/// A face in its plane.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatFace {
    /// By loop: the curves of its edges in order, each with the index of its edge.
    loops: Vec<Vec<(Curve, usize)>>,
    /// The area, in the square of the unit of length.
    pub area: f64,
    /// The largest distance of the edges from the plane.
    pub off_plane: f64,
    /// The largest distance of the curves from the vertices.
    pub gap: f64,
    /// The diagonal of the box around it.
    pub diagonal: f64,
}

impl Face {
    /// The face's curves in the coordinates of its frame.
    ///
    /// # Errors
    /// Where an edge leaves the plane or misses its vertices by more than the tolerance, or is no valid curve.
    pub fn flat(&self) -> Result<FlatFace, FaceError> {
        let mut flat = FlatFace { loops: Vec::new(), area: 0.0, off_plane: 0.0, gap: 0.0, diagonal: 0.0 };
        let mut worst: [Option<&Edge>; 2] = [None; 2];
        for edges in &self.loops {
            let mut curves = Vec::new();
            for (index, edge) in edges.iter().enumerate() {
                let laid = edge.flat(&self.frame, self.uncertainty).map_err(|what| edge.error(what))?;
                if laid.off_plane > flat.off_plane {
                    (flat.off_plane, worst[0]) = (laid.off_plane, Some(edge));
                }
                if laid.gap > flat.gap {
                    (flat.gap, worst[1]) = (laid.gap, Some(edge));
                }
                curves.extend(laid.curves.into_iter().map(|curve| (curve, index)));
            }
            flat.loops.push(curves);
        }
        flat.measure();
        let slack = self.uncertainty.max(SLACK * flat.diagonal);
        for (value, edge, what) in [
            (flat.off_plane, worst[0], "leaves the plane of its face"),
            (flat.gap, worst[1], "has a vertex off its curve"),
        ] {
            if let Some(edge) = edge.filter(|_| value > slack) {
                return Err(edge.error(format!("{what} by {value:.3e}, more than the tolerance {slack:.3e},")));
            }
        }
        if flat.area > 0.0 {
            return Ok(flat);
        }
        Err(FaceError { entity: self.entity.clone(), what: "encloses no area".into(), at: self.frame.origin })
    }

    /// The face as a drawing: one shape with the face's name, filled between its loops, and a boundary for each name of
    /// edges.
    ///
    /// # Errors
    /// Those of [`Face::flat`].
    pub fn drawing(&self) -> Result<Drawing, FaceError> {
        let flat = self.flat()?;
        let mut drawing = Drawing { fill: FillRule::Shapes, frame: Some(self.frame), ..Drawing::default() };
        let name = drawing.names.intern(&self.name);
        let shape = Some(drawing.shapes.push(Shape::new(name, true, self.entity.clone())));
        for (edges, curves) in self.loops.iter().zip(&flat.loops) {
            for (curve, index) in curves {
                let edge = &edges[*index];
                let name = drawing.names.intern(&edge.name);
                drawing.curves.push(DrawnCurve { shape, ..DrawnCurve::new(curve.clone(), name, edge.entity.clone()) });
            }
        }
        if flat.off_plane > ROUNDING * flat.diagonal {
            let what = "edges leave the plane of the face and are projected onto it, the farthest by";
            drawing.notes.push(format!("{what} {:.3e}", flat.off_plane));
        }
        if flat.gap > ROUNDING * flat.diagonal {
            drawing
                .notes
                .push(format!("curves miss their vertices and are moved onto them, the farthest by {:.3e}", flat.gap));
        }
        Ok(drawing)
    }
}

impl FlatFace {
    /// Computes the diagonal and the area. The area is that of the largest loop minus those of the others, whichever
    /// loop the file calls the outer one and whatever their directions.
    fn measure(&mut self) {
        let boxes = self.loops.iter().flatten().map(|(curve, _)| curve.bounds());
        let Some(bounds) = boxes.reduce(|a, b| a.union(b)) else { return };
        self.diagonal = libm::hypot(bounds.width(), bounds.height());
        let enclosed = |curves: &Vec<(Curve, usize)>| -> f64 {
            let area: f64 = curves.iter().map(|(curve, _)| curve.signed_area(bounds.center())).sum();
            area.abs()
        };
        let areas: Vec<f64> = self.loops.iter().map(enclosed).collect();
        let largest = areas.iter().copied().fold(0.0, f64::max);
        self.area = 2.0 * largest - areas.iter().sum::<f64>();
    }
}

/// The diagonal of the box around points; 0 where there are none.
fn diagonal(points: impl IntoIterator<Item = Point>) -> f64 {
    bounds_of(points).map_or(0.0, |b: Rect| libm::hypot(b.width(), b.height()))
}
