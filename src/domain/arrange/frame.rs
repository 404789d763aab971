//! The unit frame: the drawing times the power of two that gives it a size of about 1, and the lengths below which
//! features become one there.

use super::ArrangeOptions;
use super::error::ArrangeError;
use crate::curve::Curve;
use crate::domain::{Drawing, DrawnPoint, SeedKind};
use crate::geometry::{Point, Rect, extent, magnitude, scaled};

/// A drawn point this many times as far from the origin as the curves reach is refused as a mistake: it would take 20
/// of the 53 bits of every coordinate.
const STRAY: f64 = 1048576.0;

/// Lengths below which features become one, in the unit frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerances {
    /// Ends nearer than this are one node.
    pub weld: f64,
    /// Free ends nearer than this are joined; 0: never.
    pub gap: f64,
    /// Free ends are joined up to this where the last decimals in the file explain the gap; 0: never.
    pub written: f64,
    /// Free ends nearer than this are joined because the user asked for it; 0: not asked for.
    pub close: f64,
    /// Whether curves that part from each other slowly are one as long as they are within `weld`.
    pub zip: bool,
    /// A bound of the rounding error of computed coordinates.
    pub rounding: f64,
    /// The length of one unit of the frame in the drawing's units: for messages.
    pub unit: f64,
}

impl Tolerances {
    /// A length of the unit frame in the drawing's units, to six digits: for messages.
    pub fn told(&self, length: f64) -> f64 {
        format!("{:.5e}", length * self.unit).parse().unwrap_or(length * self.unit)
    }
}

impl Drawing {
    /// The box around the curves. Refuses a drawing without curves, with coordinates that are not finite, or whose
    /// extent is too small beside its distance from the origin to leave digits.
    pub(super) fn check_extent(&self) -> Result<Rect, ArrangeError> {
        let stray = |p: Point| !p.is_finite();
        let places = self.points.iter().map(|p| (p.at, &p.entity)).chain(self.seeds.iter().map(|s| (s.at, &s.entity)));
        let bounds = self.curves.iter().map(|c| c.curve.bounds()).reduce(|a, b| a.union(b));
        let Some(bounds) = bounds else { return Err(self.no_curves()) };
        let refuse = |what: String, help: &str| Err(ArrangeError::new(what, bounds.center(), help));
        if let Some((_, entity)) = places.into_iter().find(|(at, _)| stray(*at)) {
            return refuse(format!("{entity} has a coordinate that is no finite number"), "correct it in the file");
        }
        let reach = STRAY * (magnitude(bounds) + extent(bounds));
        let strays = |p: &&DrawnPoint| p.at.x.abs().max(p.at.y.abs()) > reach;
        if let Some(point) = self.points.iter().find(strays) {
            let what = format!("{} lies far from all curves, which are {:e} across", point.entity, extent(bounds));
            return Err(ArrangeError::new(what, point.at, "remove it, or correct its coordinates"));
        }
        let size = magnitude(bounds);
        if !bounds.is_finite() || (size != 0.0 && !(1e-140..1e140).contains(&size)) {
            // Areas are squares of lengths, and must neither overflow nor underflow (1e±308).
            return refuse(format!("coordinates as large as {size:e}"), "scale the drawing to usual numbers");
        }
        if extent(bounds) == 0.0 {
            return refuse("nothing to mesh: all curves lie in one point".into(), "check the units of the file");
        }
        // Fewer than 2^16 representable numbers across the drawing are too few for any mesh.
        if extent(bounds) < size * f64::EPSILON * 65536.0 {
            let what = format!("the drawing is {:e} across, but lies {size:e} from the origin", extent(bounds));
            return refuse(what, "move it nearer to the origin: its coordinates have no digits left");
        }
        Ok(bounds)
    }

    fn no_curves(&self) -> ArrangeError {
        let skipped: Vec<String> =
            self.skipped.iter().map(|s| format!("{} {} ({})", s.count, s.entity, s.why)).collect();
        let help = match skipped.is_empty() {
            true => "the file holds no curves".to_owned(),
            false => format!("the file holds no curves; left out: {}", skipped.join(", ")),
        };
        ArrangeError::new("nothing to mesh: the drawing has no curves", Point::ORIGIN, help)
    }

    /// The drawing times `factor`, a power of two, with the box of `keep all`, and its tolerances.
    pub(super) fn in_unit_frame(
        &self,
        factor: f64,
        options: &ArrangeOptions,
    ) -> Result<(Drawing, Tolerances), ArrangeError> {
        let mut unit = self.clone();
        for drawn in &mut unit.curves {
            drawn.curve = drawn.curve.scaled(factor);
            drawn.last_decimal *= factor;
        }
        unit.off_plane.iter_mut().for_each(|entity| entity.ends = entity.ends.map(|end| scaled(end, factor)));
        unit.points.iter_mut().for_each(|p| p.at = scaled(p.at, factor));
        unit.labels.iter_mut().for_each(|label| label.at = scaled(label.at, factor));
        for seed in &mut unit.seeds {
            seed.at = scaled(seed.at, factor);
            if let SeedKind::Region { max_area: Some(area), .. } = &mut seed.kind {
                *area *= factor * factor;
            }
        }
        let bounds = unit.curves.iter().map(|c| c.curve.bounds()).reduce(|a, b| a.union(b)).unwrap_or_default();
        let tolerances = unit.tolerances(bounds, factor, options)?;
        if options.keep_all {
            unit.add_box(bounds.inflate(extent(bounds), extent(bounds)));
        }
        Ok((unit, tolerances))
    }

    fn tolerances(&self, bounds: Rect, factor: f64, options: &ArrangeOptions) -> Result<Tolerances, ArrangeError> {
        let diagonal = extent(bounds);
        let refuse = |what: String| {
            Err(ArrangeError::new(
                what,
                bounds.center(),
                "give a welding distance of 0 or a small part of the drawing's size",
            ))
        };
        // Sixteen units of rounding of the largest number that points are computed from, as in the search for meetings.
        // Points of arcs are computed from their centers; for nearly straight arcs the default tolerance is the upper
        // limit.
        let carried = self.curves.iter().map(|c| carrier_magnitude(&c.curve)).fold(magnitude(bounds), f64::max);
        let coordinates = 16.0 * f64::EPSILON * magnitude(bounds);
        let rounding = (16.0 * f64::EPSILON * carried).min(1e-9 * diagonal).max(coordinates);
        let refused = |option: &str, given: f64| {
            (given.is_nan() || given < 0.0 || given * factor >= diagonal / 4.0)
                .then(|| format!("{option} of {given} for a drawing {} across", diagonal / factor))
        };
        if let Some(what) = options.close.and_then(|given| refused("a gap to close", given)) {
            return refuse(what);
        }
        let weld = match options.tolerance {
            None => 1e-9 * diagonal,
            Some(given) => match refused("a tolerance", given) {
                Some(what) => return refuse(what),
                None => given * factor,
            },
        };
        let joins = if options.tolerance.is_none() || options.raised { [1e-6, 1e-3] } else { [0.0, 0.0] };
        let [gap, written] = joins.map(|part| part * diagonal);
        let close = options.close.unwrap_or(0.0) * factor;
        // Only a tolerance that the user gave makes curves one along a slow contact. Otherwise a contact of curves
        // drawn to touch stays one point.
        let zip = options.tolerance.is_some_and(|given| given > 0.0);
        Ok(Tolerances { weld: weld.max(rounding), gap, written, close, zip, rounding, unit: 1.0 / factor })
    }

    /// Adds the sides of a box as boundary `box`.
    fn add_box(&mut self, bounds: Rect) {
        let [x0, x1, y0, y1] = [bounds.x0, bounds.x1, bounds.y0, bounds.y1];
        let corners = [Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)];
        for (k, side) in ["bottom", "right", "top", "left"].into_iter().enumerate() {
            if let Ok(line) = Curve::line(corners[k], corners[(k + 1) % 4]) {
                self.add(line, "box", format!("{side} of the box"));
            }
        }
    }
}

/// The largest number that a curve's points are computed from.
fn carrier_magnitude(curve: &Curve) -> f64 {
    let from = |center: Point, reach: f64| center.x.abs().max(center.y.abs()) + reach;
    match curve {
        Curve::Arc(arc) => from(arc.center, arc.radius),
        Curve::Ellipse(ellipse) => from(ellipse.center, ellipse.u.hypot().max(ellipse.v.hypot())),
        // The arc length up to a point may be much larger than the curve's extent.
        Curve::Clothoid(clothoid) => magnitude(curve.bounds()).max(clothoid.length()),
        Curve::Line(_) | Curve::Bezier(_) | Curve::Spline(_) => magnitude(curve.bounds()),
    }
}
