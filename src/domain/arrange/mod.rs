//! Drawing → Domain: weld, meet, split, drop, trace, name. The only door to a [`Domain`].
//!
//! 1. `cut`: drawn curves are cut at breaks (cusps, tangent jumps), at their meetings with themselves, and once where they are closed.
//! 2. `cut`, `weld`: pieces are cut where they meet, places within the tolerance become one node, and pieces are moved by a similarity
//!    to end at their nodes, bit for bit; again, until nothing meets but at common ends. The node is the truth: a drawn end, where there
//!    is one, rather than a computed crossing. Pieces that coincide become one.
//! 3. `star`: the curves around every point, in order.
//! 4. `trace`, `fill`: faces, winding numbers, painted shapes, hole and region seeds, names.
//! 5. `hidden`: stretches of outlines that later shapes of a picture cover, and what clips cut away, are left out, and 2 to 4 repeated
//!    without them.
//!
//! **Invariant.** A drawn curve runs along pieces in its order, or its loss is itemised; every piece ends at the places of its two nodes, bit for
//! bit, and lies within the tolerance of its curve for every time that it was moved.
//!
//! **Result.** When a round finds nothing, no node lies within the tolerance of a piece but at its ends, and no two pieces meet but at common ends
//! (as far as [`meetings`](crate::curve::meetings) tells, which misses none by its own invariant). Such pieces with their stars are a plane graph:
//! the cycles of curve sides bound its faces, V − E + F = 1 + C, winding numbers follow from one face to the next. [`Domain::flaws`] holds all
//! of that against the domain by other means: each pair met anew, Euler's formula, winding numbers by rays.
//!
//! **Termination.** Each round welds two nodes or cuts a piece more than a tolerance from its ends; only moved pieces can meet anew. Pieces that
//! cross beside a common end would settle by a steady factor only, and are cut farther away. Still no proof: rounds have a budget, and its
//! end is an error with the place. Most drawings take four rounds, welds within 1e-4 of the diagonal up to a dozen.
//!
//! **What survives.** Of welded nodes a drawn end or break, of several the first drawn; computed crossings move to it. Of coincident curves the first
//! drawn, which remembers the others. A gap is closed at the end that was drawn first.
//!
//! A tolerance acts feature by feature: what is wider than it keeps its shape and its side of the border, whatever its length; only what
//! fits within it becomes a point or a line, and is itemised ([`RepairKind::Collapsed`]). A chain of shorter curves is thinned to steps
//! of about a tolerance, so a loop of such is safe from three tolerances on.
//!
//! Lines around one point, repeated ends and components in each other cost n log n. Compared each with each are still: pieces whose boxes meet
//! although they do not (rings in each other, fans of curves, long parallel slanted lines), and curves between the same two points.
//!
//! Within a tolerance that was asked for, curves that part slowly (from a tangent contact, or from a common end) are one as long as they are
//! within it: else the sliver between them, which begins at width 0, would stay at any tolerance. Bends far narrower than the tolerance become
//! corners.
//!
//! All of it happens in a frame scaled by a power of two, so that the same drawing at another such scale gives the same bits.

mod auxiliary;
mod cut;
mod fill;
mod hidden;
mod loose;
mod repair;
mod rings;
mod star;
mod trace;
mod weld;

use super::{Domain, DomainCurve, Drawing, FillRule};
use crate::curve::Curve;
use crate::geometry::{Point, Rect, magnitude, scaled, unit_scale};
use crate::ids::{IdVec, PointId};
use crate::watch::{Stopped, Watch};
use cut::{Network, extent};
use repair::{Cells, Places};
pub use repair::{Repair, RepairKind};
use std::collections::BTreeMap;

/// A drawn point this many times as far from the origin as the curves reach is a mistake, and would take 20 of the 53 bits of every
/// coordinate.
const STRAY: f64 = 1048576.0;

/// How a drawing is arranged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArrangeOptions {
    /// Ends nearer than this are one vertex; `None`: 1e-9 of the diagonal, and ends that meet nothing else up to 1e-6 of it, or two units of
    /// the last decimal in which they are written, at most 1e-3 of it. 0 heals nothing.
    pub tolerance: Option<f64>,
    /// `None`: the drawing's own rule.
    pub fill: Option<FillRule>,
    /// `keep all`: an axis-parallel box named `box` is added, one diagonal of the drawing away from it on every side, and every
    /// bounded face kept, whatever the fill rule and the hole seeds say.
    pub keep_all: bool,
    /// Where filled shapes of a picture overlap, each set of them has a region of its own, named by all of them, the topmost first:
    /// `leaf+stem`. Else the topmost shape has it all.
    pub fragments: bool,
    /// Free ends that are each other's nearest, or that stop short of an open line, are joined up to this far, and nothing else is welded by it.
    pub close: Option<f64>,
    pub loose: Loose,
    /// Whether `tolerance` was chosen for the user: ends that meet nothing else are joined as by default then.
    pub raised: bool,
}

/// What becomes of lines that bound nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loose {
    /// Plainly open lines are kept; outlines that miss closing are refused.
    #[default]
    Auto,
    /// All are kept.
    Keep,
    /// All are left out.
    Drop,
    /// All are refused.
    Error,
}

/// What cannot be repaired, where, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} at ({}, {})", at.x, at.y)]
pub struct ArrangeError {
    /// What is wrong, with the entities.
    pub what: String,
    pub at: Point,
    /// Further places of the same flaw, as many as `what` lists.
    pub also_at: Vec<Point>,
    /// What the user can do.
    pub help: String,
    /// Whether features that lie too near to each other are the reason: a coarser tolerance may make one of them.
    pub near: bool,
}

/// Why there is no domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unarranged {
    #[error(transparent)]
    Invalid(#[from] ArrangeError),
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl Unarranged {
    /// Its place times a factor.
    fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Invalid(error) => {
                let also_at = error.also_at.iter().map(|at| scaled(*at, factor)).collect();
                ArrangeError { at: scaled(error.at, factor), also_at, ..error }.into()
            }
            Self::Stopped(_) => self,
        }
    }
}

impl ArrangeError {
    fn new(what: impl Into<String>, at: Point, help: impl Into<String>) -> Self {
        Self { what: what.into(), at, also_at: Vec::new(), help: help.into(), near: false }
    }

    /// Features lie too near to each other.
    fn near(what: impl Into<String>, at: Point, help: impl Into<String>) -> Self {
        Self { near: true, ..Self::new(what, at, help) }
    }
}

/// Lengths below which things are one, in the unit frame.
#[derive(Clone, Copy, Debug)]
struct Tolerances {
    /// Ends nearer than this are one node.
    weld: f64,
    /// Free ends nearer than this are joined; 0: never.
    gap: f64,
    /// Free ends as near as the last decimals explain are joined up to this; 0: never.
    written: f64,
    /// Free ends nearer than this are joined as the user asks for; 0: not asked for.
    close: f64,
    /// Whether curves that part from each other slowly are one as long as they are within `weld`.
    zip: bool,
    /// What rounding does to coordinates.
    rounding: f64,
    /// The length, in the drawing's units, of one unit of the frame: for messages.
    unit: f64,
}

impl Tolerances {
    /// A length of the unit frame in the drawing's units, to six digits: for messages.
    fn told(&self, length: f64) -> f64 {
        format!("{:.5e}", length * self.unit).parse().unwrap_or(length * self.unit)
    }
}

impl Drawing {
    /// The domain that the drawing describes.
    ///
    /// # Errors
    ///
    /// Where there is nothing to mesh, a coordinate is not a finite number, or curves run so near to each other that rounded
    /// arithmetic cannot tell how they lie: with the place and the way out.
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

    /// What [`Drawing::arrange`] mends by default and leaves alone within a tolerance of 0: every repair of the default that is wider than
    /// the rounding of coordinates, or is not made within that.
    ///
    /// # Errors
    ///
    /// Those of [`Drawing::arrange_watched`], but for what the fill rule says: which faces are inside is not asked.
    pub fn unhealed(&self, watch: &mut Watch) -> Result<Vec<Repair>, Unarranged> {
        let factor = unit_scale(magnitude(self.check_extent()?));
        let (unit, tolerances) = self.in_unit_frame(factor, &ArrangeOptions::default())?;
        let settled = |tolerances, watch: &mut Watch| {
            let network = settled(&unit, tolerances, watch).map_err(|why| why.scaled(1.0 / factor))?;
            Ok(network.repairs)
        };
        let mut repairs: Vec<Repair> = settled(tolerances, watch)?;
        let exact = Tolerances { weld: tolerances.rounding, gap: 0.0, written: 0.0, ..tolerances };
        let made = match settled(exact, watch) {
            Ok(made) => made,
            // What cannot be arranged so is healed of nothing.
            Err(Unarranged::Invalid(_)) => Vec::new(),
            Err(stopped) => return Err(stopped),
        };
        let mut made = Places::of(&made, Cells::wider_than(tolerances.weld));
        repairs.retain(|repair| repair.size > tolerances.rounding || !made.take(repair));
        repairs.iter_mut().for_each(|repair| repair.scale(1.0 / factor));
        Ok(repairs)
    }

    /// Refuses a drawing without curves, with places that are no numbers, or whose extent leaves no digits to work with.
    fn check_extent(&self) -> Result<Rect, ArrangeError> {
        let stray = |p: Point| !p.is_finite();
        let places = self.points.iter().map(|p| (p.at, &p.entity)).chain(self.seeds.iter().map(|s| (s.at, &s.entity)));
        let bounds = self.curves.iter().map(|c| c.curve.bounds()).reduce(|a, b| a.union(b));
        let Some(bounds) = bounds else { return Err(self.no_curves()) };
        let refuse = |what: String, help: &str| Err(ArrangeError::new(what, bounds.center(), help));
        if let Some((_, entity)) = places.into_iter().find(|(at, _)| stray(*at)) {
            return refuse(format!("{entity} has a coordinate that is no finite number"), "correct it in the file");
        }
        let reach = STRAY * (magnitude(bounds) + extent(bounds));
        let strays = |p: &&super::DrawnPoint| p.at.x.abs().max(p.at.y.abs()) > reach;
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

    /// The drawing times a power of two, with the box of `keep all`, and its tolerances.
    fn in_unit_frame(&self, factor: f64, options: &ArrangeOptions) -> Result<(Drawing, Tolerances), ArrangeError> {
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
            if let super::SeedKind::Region { max_area: Some(area), .. } = &mut seed.kind {
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
        // Sixteen units of rounding of the largest number that points are computed from, as in the search for meetings: arcs from
        // their centers too, though of nearly straight ones no more than the default tolerance.
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
        // A tolerance that was asked for says what is one; else a contact of curves drawn to touch stays the point that it is.
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
        // What is run along it to a point may be much longer than it is across.
        Curve::Clothoid(clothoid) => magnitude(curve.bounds()).max(clothoid.length()),
        Curve::Line(_) | Curve::Bezier(_) | Curve::Spline(_) => magnitude(curve.bounds()),
    }
}

fn arrange_in_unit_frame(
    drawing: &Drawing,
    tolerances: Tolerances,
    options: &ArrangeOptions,
    watch: &mut Watch,
) -> Result<Domain, Unarranged> {
    let mut network = settled(drawing, tolerances, watch)?;
    let mut notes = network.settle_loose_ends(options.loose)?;
    let (mut domain, mut faces) = traced(&network, watch)?;
    let rule = if options.keep_all { FillRule::Regions } else { options.fill.unwrap_or(drawing.fill) };
    let whole = rule == FillRule::Shapes && !options.fragments;
    if (whole || !drawing.clips.is_empty()) && network.drop_hidden(&faces, !whole) {
        network.settle(watch)?;
        (domain, faces) = traced(&network, watch)?;
    }
    domain.repairs.append(&mut network.repairs);
    domain.notes.append(&mut notes);
    if fill::by_parity(rule) || rule == FillRule::NonZero {
        domain.notes.append(&mut auxiliary::remarks(&network, &domain, &faces));
    }
    trace::keep(&network, &mut domain, &faces, rule, options, watch)?;
    Ok(domain)
}

/// The settled network as a domain without regions, and its faces.
fn traced(network: &Network, watch: &mut Watch) -> Result<(Domain, trace::Faces), Unarranged> {
    let domain = bare_domain(network, watch)?;
    // Level lines keep twice the rounding away from ends of curves.
    let faces = trace::Faces::trace(&domain, 2.0 * network.tolerances.rounding, watch)?;
    Ok((domain, faces))
}

/// A drawing's curves welded and split until they meet at common ends only.
fn settled<'a>(drawing: &'a Drawing, tolerances: Tolerances, watch: &mut Watch) -> Result<Network<'a>, Unarranged> {
    let mut network = Network::new(drawing, tolerances, watch)?;
    network.settle(watch)?;
    if network.join_free_ends() {
        network.settle(watch)?;
    }
    network.itemise_collapsed();
    Ok(network)
}

/// Points, curves and stars, without regions.
fn bare_domain(network: &Network, watch: &mut Watch) -> Result<Domain, Unarranged> {
    let drawing = network.drawing;
    let (points, point_of) = used_points(network);
    let curve = |piece: &cut::Piece| DomainCurve {
        curve: piece.curve.clone(),
        ends: piece.ends.map(|end| point_of[end].expect("a piece ends at used points")),
        sides: [None, None],
        name: network.boundary_name(piece),
        source: piece.source,
    };
    let curves = network.pieces.iter().map(curve).collect();
    let stars = star::stars(&points, &curves, watch)?;
    let mut point_names = BTreeMap::new();
    for (drawn, &node) in drawing.points.iter().zip(&network.drawn_points) {
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
        tolerance: network.tolerances.weld,
        stars,
    })
}

/// The nodes at which pieces end or points were drawn, as points of P.
fn used_points(network: &Network) -> (IdVec<PointId, Point>, IdVec<PointId, Option<PointId>>) {
    let mut used: IdVec<PointId, bool> = vec![false; network.nodes.len()].into();
    let ends = network.pieces.iter().flat_map(|p| p.ends);
    ends.chain(network.drawn_points.iter().copied()).for_each(|node| used[node] = true);
    let mut points = IdVec::new();
    let point_of = network.nodes.enumerate().map(|(id, node)| used[id].then(|| points.push(node.at))).collect();
    (points, point_of)
}
