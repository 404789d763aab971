//! Drawing → Domain: weld, meet, split, drop, trace, name. [`Drawing::arrange`] is the only constructor of a
//! [`Domain`].
//!
//! 0. `frame`: the drawing is scaled to a size of about 1, and its tolerances are chosen.
//! 1. `cut`: drawn curves are cut at breaks (cusps, tangent jumps), at their meetings with themselves, and once where
//!    they are closed. The result is the nodes and edges of an `arrangement`.
//! 2. `candidates`, `meet`, `weld`: edges are cut where they meet, places within the tolerance become one node, and
//!    edges are moved by a similarity to end at their nodes, bit for bit. This is repeated until edges meet only at
//!    common ends. A node lies at a drawn end where there is one, else at a computed crossing. Edges that coincide
//!    become one.
//! 3. `ends`, `rings`, `loose`: free ends, the outlines that do not quite close because of them, and how lines that
//!    stay open are treated.
//! 4. `star`: the curves around every point, in order.
//! 5. `trace`, `faces`: cycles of directed edges, and which face each component lies in.
//! 6. `paint`, `fill`, `regions`: painted shapes, winding numbers, which faces are inside; hole and region seeds,
//!    names.
//! 7. `hidden`: stretches of outlines that later shapes of a picture occlude, and what clips cut away, are left out.
//!    Steps 2, 4 and 5 are repeated without them.
//!
//! `auxiliary` reports frames and crossing layers; `repair` lists what was repaired.
//!
//! **Invariant.** A drawn curve runs along edges in its order, or its loss is listed as a repair. Every edge ends at
//! the places of its two nodes, bit for bit. Each time an edge is moved, it moves by at most the tolerance.
//!
//! **Result.** When a round finds nothing, a node lies within the tolerance of an edge only where it is its end, and
//! two edges meet only at common ends (as far as [`meetings`](crate::curve::meetings) finds them; by its own invariant
//! it misses none). Such edges with their stars are a plane graph: the cycles of directed edges bound its faces, V −
//! E + F = 1 + C, and winding numbers follow from one face to the next. [`Domain::flaws`] checks all of that by other
//! means: it recomputes the meetings of each pair, and uses Euler's formula and winding numbers by rays.
//!
//! **Termination.** Each round welds two nodes or cuts an edge more than a tolerance from its ends. Only moved edges
//! can have new meetings. Edges that cross beside a common end would converge by a constant factor only, so they are
//! cut farther away. This is no proof: rounds have a budget, and when it is spent the result is an error with the
//! place. Most drawings take four rounds, those welded within 1e-4 of the diagonal up to a dozen.
//!
//! **What is kept.** Of welded nodes, a drawn end or break is kept, the first drawn of several; computed crossings move
//! to it. Of coincident curves the first drawn is kept, with a list of the others. A gap is closed at the end that was
//! drawn first.
//!
//! A tolerance acts feature by feature. A feature wider than the tolerance keeps its shape and its side of the border,
//! whatever its length. A feature that fits within it becomes a point or a line, and is listed
//! ([`RepairKind::Collapsed`]). A chain of shorter curves is thinned to steps of about a tolerance, so a loop of such
//! curves is kept from a width of three tolerances on.
//!
//! Lines around one point, repeated ends and nested components cost n log n. Two families are still compared each with
//! each, at n²: edges whose boxes meet although they do not (nested rings, fans of curves, long parallel slanted
//! lines), and curves between the same two points.
//!
//! Where the user gave a tolerance, curves that separate slowly (from a tangent contact, or from a common end) are one
//! as long as they are within it. Otherwise the sliver between them, which begins at width 0, would remain at any
//! tolerance. Bends far narrower than the tolerance become corners.
//!
//! All steps run in a frame scaled by a power of two, so the same drawing at another such scale gives the same bits.

mod arrangement;
mod auxiliary;
mod candidates;
mod cut;
mod ends;
mod error;
mod faces;
mod fill;
mod frame;
mod hidden;
mod loose;
mod meet;
mod paint;
mod regions;
mod repair;
mod rings;
mod star;
mod trace;
mod weld;

use super::{Domain, DomainCurve, Drawing, FillRule};
use crate::geometry::{Point, magnitude, unit_scale};
use crate::ids::{IdVec, PointId};
use crate::watch::{Stopped, Watch};
use arrangement::{Arrangement, Edge};
use cut::cut_drawing;
pub use error::{ArrangeError, Unarranged};
use faces::Faces;
use frame::Tolerances;
use repair::{Cells, Places};
pub use repair::{Repair, RepairKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use trace::Cycles;

/// How a drawing is arranged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArrangeOptions {
    /// Ends nearer than this are one vertex; `None`: 1e-9 of the diagonal, and ends that meet nothing else up to 1e-6
    /// of it, or two units of the last decimal in which they are written, at most 1e-3 of it. 0 heals nothing.
    pub tolerance: Option<f64>,
    /// `None`: the drawing's own rule.
    pub fill: Option<FillRule>,
    /// `keep all`: an axis-parallel box named `box` is added, one diagonal of the drawing away from it on every side,
    /// and every bounded face kept, whatever the fill rule and the hole seeds say.
    pub keep_all: bool,
    /// Where filled shapes of a picture overlap, each set of them has a region of its own, named by all of them, the
    /// topmost first: `leaf+stem`. Else the topmost shape has it all.
    pub fragments: bool,
    /// Free ends that are each other's nearest, or that stop short of an open line, are joined up to this far, and
    /// nothing else is welded by it.
    pub close: Option<f64>,
    /// How lines that bound no region are treated.
    pub loose: Loose,
    /// Whether `tolerance` was chosen for the user: ends that meet nothing else are joined as by default then.
    pub raised: bool,
}

/// How lines that bound nothing are treated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Loose {
    /// Plainly open lines are kept, outlines that miss closing refused.
    #[default]
    Auto,
    /// All are mesh edges where they lie in a region.
    Keep,
    /// All are left out.
    Drop,
    /// All are refused.
    Error,
}

impl Drawing {
    /// The domain that the drawing describes.
    ///
    /// # Errors
    ///
    /// Where there is nothing to mesh, a coordinate is not a finite number, or curves run so near to each other that
    /// rounded arithmetic cannot tell their order: with the place and a remedy.
    pub fn arrange(&self, options: &ArrangeOptions) -> Result<Domain, ArrangeError> {
        self.arrange_watched(options, &mut |_| true).map_err(|why| match why {
            Unarranged::Invalid(error) => error,
            Unarranged::Stopped(Stopped) => unreachable!("nobody says stop"),
        })
    }

    /// [`Drawing::arrange`], as long as `watch` says to go on.
    ///
    /// # Errors
    ///
    /// Those of [`Drawing::arrange`], and [`Unarranged::Stopped`].
    pub fn arrange_watched(&self, options: &ArrangeOptions, watch: &mut Watch) -> Result<Domain, Unarranged> {
        let bounds = self.check_extent()?;
        let factor = unit_scale(magnitude(bounds));
        let (unit, tolerances) = self.in_unit_frame(factor, options)?;
        match arrange_in_unit_frame(&unit, tolerances, options, watch) {
            Ok(domain) => Ok(domain.scaled(1.0 / factor)),
            Err(why) => Err(why.scaled(1.0 / factor)),
        }
    }

    /// The repairs that [`Drawing::arrange`] makes by default and does not make with a tolerance of 0: those wider than
    /// the rounding of coordinates, and those that the exact run lacks.
    ///
    /// # Errors
    ///
    /// Those of [`Drawing::arrange_watched`] except for those about the fill rule: which faces are inside is not
    /// computed.
    pub fn unhealed(&self, watch: &mut Watch) -> Result<Vec<Repair>, Unarranged> {
        let factor = unit_scale(magnitude(self.check_extent()?));
        let (unit, tolerances) = self.in_unit_frame(factor, &ArrangeOptions::default())?;
        let settled = |tolerances, watch: &mut Watch| {
            let arrangement = settled(&unit, tolerances, watch).map_err(|why| why.scaled(1.0 / factor))?;
            Ok(arrangement.repairs)
        };
        let mut repairs: Vec<Repair> = settled(tolerances, watch)?;
        let exact = Tolerances { weld: tolerances.rounding, gap: 0.0, written: 0.0, ..tolerances };
        let made = match settled(exact, watch) {
            Ok(made) => made,
            // A drawing that cannot be arranged exactly has no repairs to compare with.
            Err(Unarranged::Invalid(_)) => Vec::new(),
            Err(stopped) => return Err(stopped),
        };
        let mut made = Places::of(&made, Cells::wider_than(tolerances.weld));
        repairs.retain(|repair| repair.size > tolerances.rounding || !made.take(repair));
        repairs.iter_mut().for_each(|repair| repair.scale(1.0 / factor));
        Ok(repairs)
    }
}

fn arrange_in_unit_frame(
    drawing: &Drawing,
    tolerances: Tolerances,
    options: &ArrangeOptions,
    watch: &mut Watch,
) -> Result<Domain, Unarranged> {
    let mut arrangement = settled(drawing, tolerances, watch)?;
    let mut notes = arrangement.settle_loose_ends(options.loose)?;
    let (mut domain, mut faces) = traced(&arrangement, watch)?;
    let rule = if options.keep_all { FillRule::Regions } else { options.fill.unwrap_or(drawing.fill) };
    let whole = rule == FillRule::Shapes && !options.fragments;
    if (whole || !drawing.clips.is_empty()) && arrangement.drop_hidden(&faces, !whole) {
        arrangement.settle(watch)?;
        (domain, faces) = traced(&arrangement, watch)?;
    }
    domain.repairs.append(&mut arrangement.repairs);
    domain.notes.append(&mut notes);
    if fill::by_parity(rule) || rule == FillRule::NonZero {
        domain.notes.append(&mut auxiliary::remarks(&arrangement, &domain, &faces));
    }
    regions::keep(&arrangement, &mut domain, &faces, rule, options, watch)?;
    Ok(domain)
}

/// The settled arrangement as a domain without regions, and its faces.
fn traced(arrangement: &Arrangement, watch: &mut Watch) -> Result<(Domain, Faces), Unarranged> {
    let domain = bare_domain(arrangement, watch)?;
    let cycles = Cycles::trace(&domain, watch)?;
    // Level lines keep at least twice the rounding away from the ends of curves.
    let faces = Faces::new(cycles, &domain, 2.0 * arrangement.tolerances.rounding, watch)?;
    Ok((domain, faces))
}

/// A drawing's curves welded and split until they meet at common ends only.
fn settled<'a>(drawing: &'a Drawing, tolerances: Tolerances, watch: &mut Watch) -> Result<Arrangement<'a>, Unarranged> {
    let mut arrangement = cut_drawing(drawing, tolerances, watch)?;
    arrangement.settle(watch)?;
    if arrangement.join_free_ends() {
        arrangement.settle(watch)?;
    }
    arrangement.itemise_collapsed();
    Ok(arrangement)
}

/// Points, curves and stars, without regions.
fn bare_domain(arrangement: &Arrangement, watch: &mut Watch) -> Result<Domain, Unarranged> {
    let drawing = arrangement.drawing;
    let (points, point_of) = used_points(arrangement);
    let curve = |edge: &Edge| DomainCurve {
        curve: edge.curve.clone(),
        ends: edge.ends.map(|end| point_of[end].expect("an edge ends at used points")),
        sides: [None, None],
        name: arrangement.boundary_name(edge),
        source: edge.source,
    };
    let curves = arrangement.edges.iter().map(curve).collect();
    let stars = star::stars(&points, &curves, watch)?;
    let mut point_names = BTreeMap::new();
    for (drawn, &node) in drawing.points.iter().zip(&arrangement.drawn_points) {
        if let (Some(name), Some(point)) = (drawn.name, point_of[node]) {
            point_names.entry(point).or_insert(name);
        }
    }
    Ok(Domain {
        points,
        curves,
        regions: IdVec::new(),
        names: drawing.names.clone(),
        colours: drawing.colours.clone(),
        point_names,
        repairs: Vec::new(),
        notes: Vec::new(),
        tolerance: arrangement.tolerances.weld,
        stars,
    })
}

/// The nodes at which edges end or points were drawn, as points of P.
fn used_points(arrangement: &Arrangement) -> (IdVec<PointId, Point>, IdVec<PointId, Option<PointId>>) {
    let mut used: IdVec<PointId, bool> = vec![false; arrangement.nodes.len()].into();
    let ends = arrangement.edges.iter().flat_map(|p| p.ends);
    ends.chain(arrangement.drawn_points.iter().copied()).for_each(|node| used[node] = true);
    let mut points = IdVec::new();
    let point_of = arrangement.nodes.enumerate().map(|(id, node)| used[id].then(|| points.push(node.at))).collect();
    (points, point_of)
}
