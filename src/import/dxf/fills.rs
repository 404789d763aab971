//! The meaning of the hatches of a drawing. Where nothing else is drawn, they are filled shapes. Otherwise each is a
//! name of a region, an outline, or a region.

use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve, FillRule, Seed, SeedKind, Shape};
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect, Vec2};
use crate::ids::{LayerId, NameId};
use std::collections::BTreeSet;

/// Outlines nearer to each other than this part of their extent are copies, whatever their digits.
const COPY: f64 = 1e-4;
/// Outlines farther apart than this part are not copies, whatever their digits.
const FARTHEST_COPY: f64 = 1e-2;
/// Largest distance of a curve from a polygon that stands for it, as a part of the polygon's sides. The corners of the
/// polygon lie on the curve. A hexagon for a circle has this distance; LibreCAD writes hatched circles with seven
/// sides. If such a polygon counted as an outline, it would cut the part at each corner.
const SAGITTA: f64 = 0.15;

/// The hatched area of one entity.
pub(super) struct Fill {
    /// The name of its layer.
    pub name: NameId,
    /// Its layer.
    pub layer: LayerId,
    /// The handle of the entity.
    pub handle: Option<u64>,
    /// See [`DrawnCurve::last_decimal`].
    pub last_decimal: f64,
    /// Closed outlines; the area lies between them by the even-odd rule.
    pub loops: Vec<Vec<Curve>>,
    /// The entity, for messages.
    pub entity: String,
}

impl Fill {
    fn curves(&self) -> impl Iterator<Item = &Curve> {
        self.loops.iter().flatten()
    }

    fn drawn(&self, curves: &[Curve]) -> impl Iterator<Item = DrawnCurve> {
        curves.iter().map(|curve| DrawnCurve {
            layer: Some(self.layer),
            handle: self.handle,
            last_decimal: self.last_decimal,
            ..DrawnCurve::new(curve.clone(), self.name, self.entity.clone())
        })
    }

    /// Adds the area as a filled shape.
    fn paint(&self, drawing: &mut Drawing) {
        let shape = drawing.shapes.push(Shape::new(self.name, true, self.entity.clone()));
        for outline in &self.loops {
            drawing.curves.extend(self.drawn(outline).map(|drawn| DrawnCurve { shape: Some(shape), ..drawn }));
        }
    }

    fn name(&self, at: Point, drawing: &mut Drawing) {
        let kind = SeedKind::Region { name: self.name, max_area: None };
        drawing.seeds.push(Seed { at, kind, entity: self.entity.clone() });
    }
}

/// Adds the hatches to a drawing that has all other curves.
pub(super) fn add(fills: &[Fill], drawing: &mut Drawing) {
    if fills.is_empty() {
        return;
    }
    if drawing.curves.is_empty() {
        drawing.fill = FillRule::Shapes;
        return fills.iter().for_each(|fill| fill.paint(drawing));
    }
    let layers: BTreeSet<Option<LayerId>> = drawing.curves.iter().map(|c| c.layer).collect();
    let is_alone = |fill: &Fill| !layers.contains(&Some(fill.layer));
    let mut told = Told::default();
    let outlines = Outlines::of(drawing);
    let mut fresh: Vec<DrawnCurve> = Vec::new();
    let mut regions = vec![false; fills.len()];
    for (fill, is_region) in fills.iter().zip(&mut regions) {
        let (copies, own): (Vec<_>, Vec<_>) =
            fill.loops.iter().partition(|outline| outlines.repeat(outline, fill.last_decimal));
        if is_alone(fill) && !own.is_empty() {
            *is_region = true;
            continue;
        }
        told.copies += copies.len();
        told.outlines += own.len();
        own.into_iter().for_each(|outline| fresh.extend(fill.drawn(outline)));
    }
    drawing.curves.append(&mut fresh);
    let mut outlines = Outlines::of(drawing);
    let places: Vec<Option<Place>> = fills.iter().map(|fill| outlines.place(fill)).collect();
    for ((fill, place), is_region) in fills.iter().zip(places).zip(regions) {
        match place {
            Some(Place::Inside(at) | Place::Unknown(at)) if !is_region => fill.name(at, drawing),
            // A hatched region exists, even if the outlines alone would make it a hole. On a layer of outlines the
            // outlines decide.
            Some(_) if is_region || is_alone(fill) => {
                told.regions += 1;
                fill.paint(drawing);
            }
            Some(_) | None => {}
        }
    }
    if !drawing.shapes.is_empty() {
        drawing.fill = FillRule::EvenOddAndShapes;
    }
    drawing.notes.extend(told.notes());
}

/// Counts of what hatches became.
#[derive(Default)]
struct Told {
    copies: usize,
    outlines: usize,
    regions: usize,
}

impl Told {
    fn notes(&self) -> impl Iterator<Item = String> {
        let notes = [
            (self.copies, "Hatches name the regions that they lie in; boundaries of them that repeat other outlines"),
            (self.outlines, "Boundaries of hatches that repeat no outline, and are outlines of their layers"),
            (self.regions, "Hatches on layers of their own, each a region of its own extent"),
        ];
        notes.into_iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{what}: {count}."))
    }
}

/// The position of a hatch, with a place well within it.
enum Place {
    /// Inside of the outlines, too.
    Inside(Point),
    /// Outside of the outlines or in their holes, everywhere.
    Outside,
    /// Open lines leave the position unknown.
    Unknown(Point),
}

/// The outlines of a drawing, indexed by place.
struct Outlines<'a> {
    curves: Vec<&'a DrawnCurve>,
    tree: BoxHierarchy,
    bounds: Rect,
    /// Number of curves that may still be examined for the places of hatches: some seconds.
    left: usize,
}

/// See [`Outlines::left`].
const LOOKED_AT: usize = 1 << 25;

impl<'a> Outlines<'a> {
    fn of(drawing: &'a Drawing) -> Self {
        let curves: Vec<&DrawnCurve> = drawing.curves.iter().collect();
        let tree = BoxHierarchy::new(curves.iter().map(|c| c.curve.bounds()));
        let bounds = tree.boxes().iter().copied().reduce(|a, b| a.union(b)).unwrap_or_default();
        Self { curves, tree, bounds, left: LOOKED_AT }
    }

    /// Whether outlines run along these curves all the way, up to the digits of both, or as a polygon on them.
    fn repeat(&self, outline: &[Curve], last_decimal: f64) -> bool {
        let bounds = outline.iter().map(Curve::bounds).reduce(|a, b| a.union(b)).unwrap_or_default();
        let extent = bounds.width().max(bounds.height());
        outline.iter().all(|curve| self.run_along(curve, extent, last_decimal))
    }

    fn run_along(&self, curve: &Curve, extent: f64, last_decimal: f64) -> bool {
        /// Parameters that are examined. Curves seldom have joints there.
        const SAMPLES: [f64; 7] = [0.0, 0.137, 0.319, 0.5, 0.687, 0.871, 1.0];
        let reach = (FARTHEST_COPY * extent).max(SAGITTA * curve.length());
        SAMPLES.into_iter().all(|t| {
            let distance = |i: usize, p: Point| self.curves[i].curve.nearest(p, 0.0, 1.0).1;
            let at = curve.point(t);
            let Some((near, away)) = self.tree.nearest(at, reach, |i, _| distance(i, at)) else { return false };
            let other = &self.curves[near].curve;
            let digits = 2.0 * (last_decimal + self.curves[near].last_decimal);
            let slack = digits.min(FARTHEST_COPY * extent).max(COPY * extent);
            let is_chord = |line: &Curve, arc: &Curve| {
                let ends = [line.start(), line.end()];
                let stands = line.is_straight() && !arc.is_straight() && away <= SAGITTA * line.length();
                stands && ends.into_iter().all(|end| arc.nearest(end, 0.0, 1.0).1 <= slack)
            };
            away <= slack || is_chord(curve, other) || is_chord(other, curve)
        })
    }

    /// The position of a hatch: the middle of its longest stretch on a few horizontal lines, preferably of one that is
    /// inside of the outlines.
    fn place(&mut self, fill: &Fill) -> Option<Place> {
        /// Heights of the lines, as parts of the whole. Drawings seldom have corners there.
        const LINES: [f64; 5] = [0.5037, 0.2963, 0.7193, 0.1043, 0.8989];
        let bounds = fill.curves().map(Curve::bounds).reduce(|a, b| a.union(b))?;
        let (mut inside, mut outside, mut unknown) = (Widest::default(), Widest::default(), Widest::default());
        for share in LINES {
            let y = bounds.y0 + share * bounds.height();
            let hatched = crossings(fill.curves(), y);
            // A line through a joint may miss it. Then it does not tell inside from outside.
            if !hatched.len().is_multiple_of(2) {
                continue;
            }
            let drawn = self.crossings(y);
            let is_known = self.left > 0 && drawn.len().is_multiple_of(2);
            let mut places = [&hatched[..], &drawn[..]].concat();
            places.sort_by(f64::total_cmp);
            for ends in places.windows(2) {
                let middle = 0.5 * (ends[0] + ends[1]);
                let is_within = |places: &[f64]| places.partition_point(|x| *x < middle) % 2 == 1;
                if is_within(&hatched) {
                    let stretch = match (is_known, is_within(&drawn)) {
                        (false, _) => &mut unknown,
                        (true, true) => &mut inside,
                        (true, false) => &mut outside,
                    };
                    stretch.add(ends[1] - ends[0], Point::new(middle, y));
                }
            }
        }
        // Stretches within the digits of the file do not count.
        let least = COPY * bounds.width();
        let wide = |widest: Widest| widest.0.filter(|(width, _)| *width > least).map(|(_, at)| at);
        let places =
            [wide(inside).map(Place::Inside), wide(unknown).map(Place::Unknown), wide(outside).map(|_| Place::Outside)];
        places.into_iter().flatten().next()
    }

    /// The x of the outlines at a height, from left to right. Copies count once.
    fn crossings(&mut self, y: f64) -> Vec<f64> {
        let mut met = Vec::new();
        let across = Rect::new(self.bounds.x0, y, self.bounds.x1, y);
        self.tree.meeting(across, |i| {
            met.push(&self.curves[i].curve);
            met.len() < self.left
        });
        self.left = self.left.saturating_sub(met.len());
        let mut places = crossings(met, y);
        let same = 1e-9 * self.bounds.width(); // as arranging welds
        places.dedup_by(|b, a| *b - *a <= same);
        places
    }
}

/// The x of some curves at a height, from left to right.
fn crossings<'c>(curves: impl IntoIterator<Item = &'c Curve>, y: f64) -> Vec<f64> {
    let (from, right) = (Point::new(0.0, y), Vec2::new(1.0, 0.0));
    let places = |curve: &'c Curve| curve.line_crossings(from, right, 0.0, 1.0).into_iter().map(|t| curve.point(t).x);
    let mut places: Vec<f64> = curves.into_iter().flat_map(places).collect();
    places.sort_by(f64::total_cmp);
    places
}

/// The widest of some stretches, and its middle.
#[derive(Default)]
struct Widest(Option<(f64, Point)>);

impl Widest {
    fn add(&mut self, width: f64, middle: Point) {
        if self.0.is_none_or(|(widest, _)| width > widest) {
            self.0 = Some((width, middle));
        }
    }
}
