//! The far field: a circle around a section, and the sizes of a mesh for the flow within.

use super::curves::Section;
use crate::curve::Curve;
use crate::domain::{Drawing, Seed, SeedKind, SizeRequest};
use crate::geometry::{Point, Rect, Vec2};
use crate::import::ImportError;
use crate::import::airfoil::HELP;

/// Adds the circle `farfield` and the region `fluid`, with sizes along the chord, in the wake and far away. `center`,
/// `radius` and `chord` are in units of the drawing.
///
/// ```text
///         ╭───────────────────────╮
///       ╭─╯       × fluid         ╰─╮          `center` is mid-chord, × the seed of the region. Edges are 0.015 chords
///      │                             │         along nose–tail and 0.05 along wake–end, growing with the distance from
///      │     nose ◁═══════ wake····end         either, and at most 2.5 chords on the circle. The wake starts at the
///      │                             │         aftmost tail.
///       ╰─╮                       ╭─╯
///         ╰───────────────────────╯ farfield
/// ```
///
/// # Errors
///
/// Where the circle does not go around the section.
pub fn add_far_field(
    sections: &[Section],
    center: Point,
    radius: f64,
    chord: f64,
    drawing: &mut Drawing,
) -> Result<(), ImportError> {
    let bounds = drawing.bounds().unwrap_or(Rect::ZERO);
    let corners = [(bounds.x0, bounds.y0), (bounds.x0, bounds.y1), (bounds.x1, bounds.y0), (bounds.x1, bounds.y1)];
    let reach = corners.into_iter().map(|c| (Point::from(c) - center).hypot()).fold(0.0, f64::max);
    if reach >= radius {
        let what = format!("a far field of {} chords does not go around the section", radius / chord);
        return Err(ImportError::new(what, "give 1 chord or more, or 0 for the section itself"));
    }
    let circle = Curve::circle(center, radius).map_err(|e| ImportError::new(e.to_string(), HELP))?;
    drawing.add(circle, "farfield", "far field");
    // Halfway between the top of the section's box and the top of the circle.
    let at = Point::new(center.x, 0.5 * (bounds.y1 + center.y + radius));
    let name = drawing.names.intern("fluid");
    drawing.seeds.push(Seed { at, kind: SeedKind::Region { name, max_area: None }, entity: "fluid".into() });
    for s in sections {
        let along = SizeRequest::Near { from: s.nose, to: s.tail, edge: 0.015 * s.chord, grade: 0.15 };
        drawing.sizes.push(along);
    }
    let wake = sections.iter().map(|s| s.tail).reduce(|a, b| if b.x > a.x { b } else { a }).unwrap_or(center);
    let length = (2.5 * chord).min(0.9 * (center.x + radius - wake.x));
    let end = wake + Vec2::new(length, 0.0);
    drawing.sizes.push(SizeRequest::Near { from: wake, to: end, edge: 0.05 * chord, grade: 0.15 });
    let name = drawing.names.intern("farfield");
    drawing.sizes.push(SizeRequest::Boundary { name, edge: (2.5 * chord).min(0.5 * radius) });
    Ok(())
}
