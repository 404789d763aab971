//! Points, planes and curves in space (ISO 10303-42).

use super::MOST_NESTING;
use super::entity::{Entity, File, Result, parts, reference};
use crate::cad::SpaceCurve;
use crate::geometry::Frame;
use crate::geometry::space::{cross, dot, length, minus, plus, times, unit};
use step_io::parser::{Attribute, RawEntity};

/// Largest degree; modellers stop at 25. Splitting a spline into spans takes time that grows with the cube of the
/// degree.
const MOST_DEGREE: usize = 32;

/// Types that refer to another curve by their second attribute.
const STAND_INS: [&str; 5] =
    ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE", "BOUNDED_SURFACE_CURVE", "TRIMMED_CURVE"];

/// The types with the degree and control points of a spline; in a complex entity, the first.
const SPLINES: [&str; 5] =
    ["B_SPLINE_CURVE", "B_SPLINE_CURVE_WITH_KNOTS", "BEZIER_CURVE", "QUASI_UNIFORM_CURVE", "UNIFORM_CURVE"];

/// The surface of a face.
pub(super) enum Surface {
    Plane(Frame),
    /// The name of its type.
    Curved(String),
}

impl File<'_> {
    /// The three coordinates of an entity.
    pub(super) fn triple(&self, entity: &Entity) -> Result<[f64; 3]> {
        let reals = entity.reals(1)?;
        reals.try_into().map_err(|reals: Vec<f64>| entity.fail(format!("has {} coordinates, not 3", reals.len())))
    }

    /// A point.
    pub(super) fn point(&self, id: u64) -> Result<[f64; 3]> {
        let entity = self.entity(id, &["CARTESIAN_POINT"])?;
        let point = self.triple(&entity)?;
        if point.iter().all(|x| x.is_finite()) { Ok(point) } else { Err(entity.fail("is nowhere")) }
    }

    /// The point of a vertex.
    pub(super) fn vertex(&self, id: u64) -> Result<[f64; 3]> {
        self.point(self.entity(id, &["VERTEX_POINT"])?.reference(1)?)
    }

    /// A direction, if there is one.
    pub(super) fn direction(&self, entity: &Entity, i: usize) -> Result<Option<[f64; 3]>> {
        match entity.attributes.get(i) {
            Some(Attribute::EntityRef(id)) => {
                let direction = self.entity(*id, &["DIRECTION"])?;
                let [x, y, z] = self.triple(&direction)?;
                if unit([x, y, z]).is_none() {
                    return Err(direction.fail("has no direction"));
                }
                Ok(Some([x, y, z]))
            }
            _ => Ok(None),
        }
    }

    /// The axes of a placement in space. Missing axes are coordinate axes.
    pub(super) fn placement(&self, id: u64) -> Result<Frame> {
        let entity = self.entity(id, &["AXIS2_PLACEMENT_3D"])?;
        let axis = self.direction(&entity, 2)?.unwrap_or([0.0, 0.0, 1.0]);
        let toward = self.direction(&entity, 3)?.unwrap_or([1.0, 0.0, 0.0]);
        Frame::of_plane(self.point(entity.reference(1)?)?, axis, toward).ok_or_else(|| entity.fail("has no axes"))
    }

    /// The frame of a planar surface, by its type or by its control points.
    pub(super) fn plane(&self, id: u64, uncertainty: f64) -> Result<Surface> {
        if let Ok(plane) = self.entity(id, &["PLANE"]) {
            return Ok(Surface::Plane(self.placement(plane.reference(1)?)?));
        }
        let nets = ["B_SPLINE_SURFACE", "B_SPLINE_SURFACE_WITH_KNOTS", "BEZIER_SURFACE", "QUASI_UNIFORM_SURFACE"];
        let Ok(net) = self.entity(id, &nets) else {
            return Ok(Surface::Curved(self.first(id)?.kind.to_owned()));
        };
        // The part of a complex entity has no name before its attributes.
        let simple = usize::from(matches!(net.attributes.first(), Some(Attribute::String(_))));
        let mut rows = Vec::new();
        for row in net.list(2 + simple)? {
            let Attribute::List(row) = row else { return Err(net.fail("has a row that is not a list")) };
            let row =
                row.iter().map(|p| reference(p).ok_or_else(|| net.fail("has an entry that is not a control point")));
            rows.push(row.map(|id| self.point(id?)).collect::<Result<Vec<_>>>()?);
        }
        Ok(plane_of_net(&rows, uncertainty).map_or_else(|| Surface::Curved("B_SPLINE_SURFACE".into()), Surface::Plane))
    }

    /// The curve in space of an entity, and whether it has the same direction.
    pub(super) fn curve(&self, id: u64) -> Result<(SpaceCurve, bool)> {
        let (mut id, mut along) = (id, true);
        for _ in 0..MOST_NESTING {
            let Ok(stand_in) = self.entity(id, &STAND_INS) else { return Ok((self.space_curve(id)?, along)) };
            id = stand_in.reference(1)?;
            if stand_in.kind == "TRIMMED_CURVE" {
                along = along == stand_in.flag(4)?;
            }
        }
        Err(self.first(id)?.fail("stands for itself"))
    }

    /// The curve in space of an entity of a basic kind.
    pub(super) fn space_curve(&self, id: u64) -> Result<SpaceCurve> {
        if let Ok(spline) = self.entity(id, &SPLINES) {
            return self.spline(id, &spline);
        }
        let Ok(entity) = self.entity(id, &["LINE", "POLYLINE", "CIRCLE", "ELLIPSE", "PARABOLA", "HYPERBOLA"]) else {
            return Err(self.first(id)?.fail("is a curve of a kind that is not read"));
        };
        match entity.kind {
            "LINE" => Ok(SpaceCurve::Line),
            "POLYLINE" => self.polyline(&entity),
            _ => self.conic(&entity),
        }
    }

    /// A polyline.
    pub(super) fn polyline(&self, entity: &Entity) -> Result<SpaceCurve> {
        let points = entity.references(1)?.into_iter().map(|id| self.point(id)).collect::<Result<Vec<_>>>()?;
        // Clamped: the first and the last knot are double.
        let last = points.len().saturating_sub(1);
        let knots = (0..points.len() + 2).map(|i| i.saturating_sub(1).min(last) as f64).collect();
        Ok(SpaceCurve::Nurbs { degree: 1, knots, points, weights: None })
    }

    /// A conic.
    pub(super) fn conic(&self, entity: &Entity) -> Result<SpaceCurve> {
        let size = |i: usize| match entity.real(i)? {
            size if size > 0.0 => Ok(size),
            size => Err(entity.fail(format!("has the size {size}"))),
        };
        let Frame { origin, x, y } = self.placement(entity.reference(1)?)?;
        let first = size(2)?;
        Ok(match entity.kind {
            "CIRCLE" => SpaceCurve::Ellipse { center: origin, u: times(x, first), v: times(y, first) },
            "ELLIPSE" => SpaceCurve::Ellipse { center: origin, u: times(x, first), v: times(y, size(3)?) },
            // The first size is the focal distance.
            "PARABOLA" => SpaceCurve::Parabola { apex: origin, u: times(x, first), v: times(y, 2.0 * first) },
            _ => SpaceCurve::Hyperbola { center: origin, u: times(x, first), v: times(y, size(3)?) },
        })
    }

    /// A spline.
    pub(super) fn spline(&self, id: u64, entity: &Entity) -> Result<SpaceCurve> {
        let simple = usize::from(matches!(entity.attributes.first(), Some(Attribute::String(_))));
        let degree = entity.whole(simple)?;
        if degree > MOST_DEGREE {
            return Err(entity.fail(format!("is of degree {degree}; at most {MOST_DEGREE} is read")));
        }
        let points = entity.references(1 + simple)?.into_iter().map(|id| self.point(id)).collect::<Result<Vec<_>>>()?;
        let knots = match self.entity(id, &["B_SPLINE_CURVE_WITH_KNOTS"]) {
            // A simple entity has the attributes of its supertypes first.
            Ok(knots) => with_multiplicities(&knots, 6 * simple, degree, points.len())?,
            Err(_) => implied_knots(entity, self.graph.get(id), degree, points.len())?,
        };
        let weights = self.entity(id, &["RATIONAL_B_SPLINE_CURVE"]).ok().map(|part| part.reals(0)).transpose()?;
        Ok(SpaceCurve::Nurbs { degree, knots, points, weights })
    }
}

/// The frame of the plane of control points, with the normal of the surface; `None` where they are not in one plane.
pub(super) fn plane_of_net(rows: &[Vec<[f64; 3]>], uncertainty: f64) -> Option<Frame> {
    let origin = *rows.first()?.first()?;
    let offsets = || rows.iter().flatten().map(|p| minus(*p, origin));
    let extent = offsets().map(length).fold(0.0, f64::max);
    // The sum of the cross products of the diagonals of all cells. u × v is the normal of the surface, and rows follow
    // each other along u.
    let mut normal = [0.0; 3];
    for (below, above) in rows.iter().zip(rows.iter().skip(1)) {
        for (a, b) in below.windows(2).zip(above.windows(2)) {
            normal = plus(normal, cross(minus(b[1], a[0]), minus(a[1], b[0])));
        }
    }
    let along = rows.last()?.first().map(|p| minus(*p, origin))?;
    let frame = Frame::of_plane(origin, normal, along)?;
    let slack = uncertainty.max(1e-7 * extent);
    offsets().all(|d| dot(d, frame.normal()).abs() <= slack).then_some(frame)
}

/// The knots of a spline that gives each distinct knot with its multiplicity.
pub(super) fn with_multiplicities(entity: &Entity, first: usize, degree: usize, points: usize) -> Result<Vec<f64>> {
    let (counts, distinct) = (entity.reals(first)?, entity.reals(first + 1)?);
    let total: f64 = counts.iter().sum();
    let expected = points + degree + 1;
    if counts.len() != distinct.len() || counts.iter().any(|n| *n < 1.0) || total != expected as f64 {
        return Err(entity.fail(format!("has multiplicities that do not give {expected} knots")));
    }
    // The total bounds each multiplicity.
    let knots = distinct.iter().zip(&counts).flat_map(|(knot, count)| std::iter::repeat_n(*knot, *count as usize));
    Ok(knots.collect())
}

/// The knots that a type of spline implies: evenly spaced, clamped unless uniform, and of full multiplicity inside a
/// chain of Béziers.
pub(super) fn implied_knots(
    entity: &Entity,
    raw: Option<&RawEntity>,
    degree: usize,
    points: usize,
) -> Result<Vec<f64>> {
    let is = |kind: &str| raw.is_some_and(|raw| parts(raw).any(|part| part.kind == kind));
    let whole = points.checked_sub(1).filter(|n| degree > 0 && n % degree == 0).map(|n| n / degree);
    if is("UNIFORM_CURVE") {
        return Ok((0..points + degree + 1).map(|i| i as f64).collect());
    }
    if is("QUASI_UNIFORM_CURVE") && points > degree {
        let inner = points - degree;
        return Ok((0..points + degree + 1).map(|i| i.clamp(degree, degree + inner) as f64).collect());
    }
    match (is("BEZIER_CURVE"), whole) {
        (true, Some(spans)) => {
            let inner = (0..=spans).flat_map(|i| std::iter::repeat_n(i as f64, degree));
            Ok([0.0].into_iter().chain(inner).chain([spans as f64]).collect())
        }
        _ => Err(entity.fail("has no knots")),
    }
}
