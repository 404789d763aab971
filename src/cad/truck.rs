//! Faces of truck-modeling's solids.
//!
//! truck stores circular arcs as rational quadratic splines, and they arrive as such, exact. The axes of its planes
//! need be neither unit vectors nor perpendicular, so the frame is computed from the normal.

use super::{Edge, Face, FaceError, SpaceCurve};
use crate::domain::Drawing;
use crate::geometry::Frame;
use truck_modeling::{Curve, Point3, Surface, Vector3};

/// A planar face as a drawing in an orthonormal frame of its plane, with the normal of the oriented face. The region is
/// named `face`, the boundaries `edge 1`, `edge 2`, … in the order of the face's loops.
///
/// # Errors
/// For a curved face, for an edge that is an intersection curve, and where an edge leaves the plane; [`FaceError`] has
/// the place.
pub fn drawing_of_truck_face(face: &truck_modeling::Face) -> Result<Drawing, FaceError> {
    let fail = |what: &str, at| FaceError { entity: "the face".into(), what: what.into(), at };
    let Surface::Plane(plane) = face.oriented_surface() else {
        return Err(fail("is curved: only planar faces can be meshed yet", [0.0; 3]));
    };
    let origin = place(plane.origin());
    let frame = Frame::of_plane(origin, vector(plane.normal()), vector(plane.u_axis()));
    let frame = frame.ok_or_else(|| fail("has no normal", origin))?;
    let mut count = 0;
    let mut loops = Vec::new();
    for wire in face.boundaries() {
        let mut edges = Vec::new();
        for edge in wire.edge_iter() {
            count += 1;
            let ends = [edge.front(), edge.back()].map(|vertex| place(vertex.point()));
            edges.push(edge_of(&edge.oriented_curve(), ends, count)?);
        }
        loops.push(edges);
    }
    let face = Face { frame, name: "face".into(), entity: "the face".into(), loops, uncertainty: 0.0 };
    Ok(Drawing { format: "truck".into(), title: "truck face".into(), ..face.drawing()? })
}

/// The edge along the whole of a curve.
fn edge_of(curve: &Curve, ends: [[f64; 3]; 2], number: usize) -> Result<Edge, FaceError> {
    let (name, entity) = (format!("edge {number}"), format!("edge {number} of the face"));
    let space = match curve {
        Curve::Line(_) => SpaceCurve::Line,
        Curve::BSplineCurve(spline) => SpaceCurve::Nurbs {
            degree: spline.degree(),
            knots: spline.knot_vec().iter().copied().collect(),
            points: spline.control_points().iter().map(|p| place(*p)).collect(),
            weights: None,
        },
        Curve::NurbsCurve(nurbs) => SpaceCurve::Nurbs {
            degree: nurbs.degree(),
            knots: nurbs.knot_vec().iter().copied().collect(),
            // The control points are homogeneous in truck.
            points: nurbs.control_points().iter().map(|p| [p.x / p.w, p.y / p.w, p.z / p.w]).collect(),
            weights: Some(nurbs.control_points().iter().map(|p| p.w).collect()),
        },
        Curve::IntersectionCurve(_) => {
            let what = "is the intersection of two surfaces, which no curve of ours is exactly".into();
            return Err(FaceError { entity, what, at: ends[0] });
        }
    };
    Ok(Edge { curve: space, ends, same_sense: true, backward: false, name, entity })
}

fn place(p: Point3) -> [f64; 3] {
    [p.x, p.y, p.z]
}

fn vector(v: Vector3) -> [f64; 3] {
    [v.x, v.y, v.z]
}
