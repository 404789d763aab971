//! Auxiliary lines, which are no edges of the part: drawing frames, outlines that cross those of another layer, and
//! bolt circles. Where winding numbers decide what is inside, they change the result. They are arranged as drawn, and a
//! note names the option that leaves them out.
//!
//! ```text
//!   ┌─────────────────────────────┐         By the odd-even rule the sheet around the part is inside, the part itself
//!   │  ╭───────────────╮          │         outside, and its holes ○ inside. A frame holds outlines that hold others
//!   │  │ ○   part    ○ │  ┌────┐  │         in turn; the boxes of a title block hold none.
//!   │  ╰───────────────╯  └────┘  │
//!   └─────────────────────────────┘
//! ```

use super::arrangement::Arrangement;
use super::faces::Faces;
use super::fill::closed_outlines;
use super::trace::DirectedEdge;
use crate::domain::Domain;
use crate::domain::locate::Side;
use crate::geometry::Point;
use crate::ids::{CurveId, Id, LayerId};
use std::collections::{BTreeMap, BTreeSet};

/// Parts of the usual names of layers with drawing frames, in the languages of common templates.
const FRAMES: [&str; 9] = ["frame", "border", "title", "sheet", "rahmen", "schriftfeld", "cadre", "cartouche", "marco"];

/// A bolt circle runs through at least this many holes.
const HOLES: usize = 3;

/// The notes on auxiliary lines in a drawing with layers.
pub(super) fn remarks(arrangement: &Arrangement, domain: &Domain, faces: &Faces) -> Vec<String> {
    if arrangement.drawing.layers.is_empty() {
        return Vec::new();
    }
    let outlines = Outlines::new(arrangement, faces);
    let mut remarks = outlines.frames();
    remarks.extend(outlines.crossings(domain));
    remarks.extend(outlines.bolt_circles(domain));
    remarks
}

/// The layers of closed outlines, by curve and by component.
struct Outlines<'a> {
    arrangement: &'a Arrangement<'a>,
    faces: &'a Faces,
    by_curve: Vec<BTreeSet<LayerId>>,
    /// By curve: the drawn curves along it that are closed and have a layer; mostly circles.
    circles: Vec<BTreeSet<usize>>,
    by_component: Vec<BTreeSet<LayerId>>,
}

impl<'a> Outlines<'a> {
    fn new(arrangement: &'a Arrangement<'a>, faces: &'a Faces) -> Self {
        let closed = closed_outlines(arrangement);
        let layers = |id: CurveId| {
            let sources =
                arrangement.drawn_along(id).map(|(source, _)| source as usize).filter(|&source| closed[source]);
            sources.filter_map(|source| arrangement.drawing.curves[source].layer).collect::<BTreeSet<_>>()
        };
        let is_circle = |source: usize| {
            let is_closed = arrangement.drawn_ends[source].is_some_and(|[start, end]| start == end);
            is_closed && arrangement.drawing.curves[source].layer.is_some()
        };
        let circles = |id: CurveId| {
            arrangement.drawn_along(id).map(|(source, _)| source as usize).filter(|&s| is_circle(s)).collect()
        };
        let by_curve: Vec<_> = arrangement.edges.ids().map(layers).collect();
        let circles = arrangement.edges.ids().map(circles).collect();
        let mut by_component = vec![BTreeSet::new(); faces.outer.len()];
        for (k, layers) in by_curve.iter().enumerate() {
            let directed = DirectedEdge { curve: CurveId::from_index(k), side: Side::Left };
            by_component[faces.cycles[faces.cycle_of[directed.index()]].component].extend(layers);
        }
        Self { arrangement, faces, by_curve, circles, by_component }
    }

    fn name(&self, layer: LayerId) -> &str {
        &self.arrangement.drawing.layers[layer].name
    }

    /// The component around a component.
    fn around(&self, component: usize) -> Option<usize> {
        self.faces.parent[component].map(|face| self.faces.cycles[face].component)
    }

    /// Notes on layers that look like drawing frames: all their outlines are nested, and the innermost holds outlines
    /// of other layers that hold others in turn. If the layer's name is that of a frame, it is enough that the
    /// innermost holds any.
    fn frames(&self) -> Vec<String> {
        let mut of_layer: BTreeMap<LayerId, Vec<usize>> = BTreeMap::new();
        for (component, layers) in self.by_component.iter().enumerate() {
            layers.iter().for_each(|&layer| of_layer.entry(layer).or_default().push(component));
        }
        let is_outline = |&component: &usize| !self.by_component[component].is_empty();
        let mut held: Vec<Vec<usize>> = vec![Vec::new(); self.by_component.len()];
        for component in (0..held.len()).filter(is_outline) {
            self.around(component).into_iter().for_each(|around| held[around].push(component));
        }
        let depth = |component: usize| {
            let inner = &held[component];
            if inner.iter().any(|&c| !held[c].is_empty()) { 2 } else { usize::from(!inner.is_empty()) }
        };
        let is_frame = |layer: LayerId, components: &[usize]| {
            let alone = components.iter().all(|&c| self.by_component[c].len() == 1);
            // The boxes of the title block hold no outlines.
            let holding: Vec<usize> = components.iter().copied().filter(|&c| depth(c) > 0).collect();
            let innermost = self.innermost(&holding).filter(|_| self.outermost(components) == 1);
            let name = self.name(layer).to_lowercase();
            let called = FRAMES.iter().any(|frame| name.contains(frame));
            alone && innermost.is_some_and(|component| depth(component) > usize::from(!called))
        };
        let frames = of_layer.iter().filter(|(layer, components)| is_frame(**layer, components));
        let told = |name: &str| {
            format!(
                "Layer {name} has an outline around outlines that hold others, as a drawing frame does: what lies between them counts as inside. --skip-layers {} leaves it out.",
                quoted(name)
            )
        };
        frames.map(|(&layer, _)| told(self.name(layer))).collect()
    }

    /// How many of these components lie in none of the others.
    fn outermost(&self, components: &[usize]) -> usize {
        let within = |component: usize| self.around(component).is_some_and(|around| components.contains(&around));
        components.iter().filter(|&&c| !within(c)).count()
    }

    /// The innermost of nested components; `None` where they are not nested.
    fn innermost(&self, components: &[usize]) -> Option<usize> {
        let around: BTreeSet<usize> = components.iter().filter_map(|&c| self.around(c)).collect();
        let mut inner = components.iter().filter(|c| !around.contains(c));
        match (self.outermost(components), inner.next(), inner.next()) {
            (1, Some(&innermost), None) => Some(innermost),
            _ => None,
        }
    }

    /// Notes on pairs of layers whose closed outlines cross.
    fn crossings(&self, domain: &Domain) -> Vec<String> {
        let places = crossings(domain, &self.by_curve);
        places.iter().map(|(&pair, places)| self.tell_crossing(pair, places)).collect()
    }

    /// Notes on circles that cross other circles of their layer, which do not cross each other.
    fn bolt_circles(&self, domain: &Domain) -> Vec<String> {
        let layer = |circle: usize| self.arrangement.drawing.curves[circle].layer;
        let mut crossed: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        let pairs = crossings(domain, &self.circles).into_keys().filter(|&[a, b]| layer(a) == layer(b));
        for [a, b] in pairs {
            crossed.entry(a).or_default().insert(b);
            crossed.entry(b).or_default().insert(a);
        }
        let is_bolt_circle =
            |holes: &BTreeSet<usize>| holes.len() >= HOLES && holes.iter().all(|hole| crossed[hole].is_disjoint(holes));
        let told = |(&circle, holes): (&usize, &BTreeSet<usize>)| {
            format!(
                "{} crosses {} circles of its layer, as a bolt circle does: inside and outside change places there. On a layer of its own it can be left out by --skip-layers.",
                self.arrangement.drawing.curves[circle].entity,
                holes.len()
            )
        };
        crossed.iter().filter(|(_, holes)| is_bolt_circle(holes)).map(told).collect()
    }

    /// The note on one pair of layers. The layer with fewer outlines is said to cross the other.
    fn tell_crossing(&self, pair: [LayerId; 2], places: &[Point]) -> String {
        let count = |layer: LayerId| self.by_curve.iter().filter(|layers| layers.contains(&layer)).count();
        let entities = |layer: LayerId| self.arrangement.drawing.layers[layer].line_types.values().sum::<usize>();
        let [across, others] = if [entities(pair[0]), count(pair[0])] < [entities(pair[1]), count(pair[1])] {
            pair
        } else {
            [pair[1], pair[0]]
        };
        let [x, y] = [places[0].x, places[0].y].map(|x| self.arrangement.tolerances.told(x));
        let more = if places.len() > 1 { format!(" and {} places more", places.len() - 1) } else { String::new() };
        let [across, others] = [across, others].map(|layer| self.name(layer));
        format!(
            "Closed outlines of layer {across} cross those of layer {others} at ({x}, {y}){more}: inside and outside change places there. --skip-layers {} leaves them out.",
            quoted(across)
        )
    }
}

/// The points at which closed outlines of two kinds cross, by the pair of kinds. `kinds` holds those of each curve of
/// the domain.
fn crossings<K: Copy + Ord>(domain: &Domain, kinds: &[BTreeSet<K>]) -> BTreeMap<[K; 2], Vec<Point>> {
    let mut places: BTreeMap<[K; 2], Vec<Point>> = BTreeMap::new();
    for (point, star) in domain.stars.enumerate() {
        let around: Vec<&BTreeSet<K>> =
            star.iter().map(|incident| &kinds[incident.curve.index()]).filter(|kinds| !kinds.is_empty()).collect();
        if around.len() < 4 {
            continue;
        }
        let met: BTreeSet<K> = around.iter().flat_map(|kinds| kinds.iter().copied()).collect();
        for &a in &met {
            for &b in met.range(a..).skip(1) {
                if take_turns(&around, a, b) {
                    places.entry([a, b]).or_default().push(domain.points[point]);
                }
            }
        }
    }
    places
}

/// Whether, in the order around a point, curves of only the kind a and curves of only the kind b take turns twice.
///
/// ```text
///     a   b          a   b
///      ╲ ╱            ╲ ╱         Left: a, b, a, b around the point, four changes: the outlines cross.
///       ●              ●          Right: a, b, b, a, two changes: they touch.
///      ╱ ╲            ╱ ╲
///     b   a          a   b
/// ```
fn take_turns<K: Copy + Ord>(around: &[&BTreeSet<K>], a: K, b: K) -> bool {
    let only = |kinds: &&BTreeSet<K>| match (kinds.contains(&a), kinds.contains(&b)) {
        (true, false) => Some(a),
        (false, true) => Some(b),
        (true, true) | (false, false) => None,
    };
    let turns: Vec<K> = around.iter().filter_map(only).collect();
    let changes = turns.iter().zip(turns.iter().cycle().skip(1)).filter(|(x, y)| x != y).count();
    changes >= 4
}

/// A name as it is typed in a shell.
fn quoted(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-.".contains(c);
    if name.chars().all(is_plain) { name.to_owned() } else { format!("'{name}'") }
}
