//! Faces: cycles of curve sides, which face holds which component, winding numbers, and the kept regions with their names.

use super::cut::{Network, extent};
use super::fill::Fill;
use super::{ArrangeError, ArrangeOptions, FillRule, Repair, RepairKind, Unarranged};
use crate::curve::End;
use crate::domain::locate::{Axis, Hit, Locator, Side, Sight, left_of};
use crate::domain::{Domain, Drawing, Incident, Region, SeedKind};
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, IdVec, LayerId, NameId, PointId, RegionId};
use crate::watch::{Progress, Stopped, Watch};
use std::collections::{BTreeMap, BTreeSet};

/// Axis-parallel lines tried through a component before its place counts as undecided; each fails only by passing within rounding of
/// a vertex or along a curve.
const LINES: usize = 64;

/// More than the unit frame is wide, the box of `keep all` included: coordinates of at most 1 and 2√2 on either side.
const FRAME: f64 = 16.0;

/// A curve side: the curve travelled forward has its face on the left, travelled backward the one on its right.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Half {
    pub curve: CurveId,
    pub side: Side,
}

impl Half {
    pub fn index(self) -> usize {
        2 * self.curve.index() + self.side.index()
    }

    pub fn twin(self) -> Self {
        Half { side: self.side.other(), ..self }
    }

    /// The end of the curve from which this side is travelled.
    fn tail(self) -> Incident {
        let end = match self.side {
            Side::Left => End::Start,
            Side::Right => End::Finish,
        };
        Incident { curve: self.curve, end }
    }
}

/// A face: a cycle that bounds it from outside, known by its place; `None`: the unbounded face.
pub(super) type Face = Option<usize>;

/// The cycles of all sides, their components, and how components lie in each other.
pub(super) struct Faces {
    pub cycle_of: Vec<usize>,
    pub cycles: Vec<Cycle>,
    /// By component: the cycle that sees the component from outside.
    pub outer: Vec<usize>,
    /// By component: the face in which it lies.
    pub parent: Vec<Face>,
}

pub(super) struct Cycle {
    pub halves: Vec<Half>,
    pub area: f64,
    pub component: usize,
}

impl Faces {
    /// Traces the cycles of a domain whose points, curves and stars stand.
    pub fn trace(domain: &Domain, margin: f64, watch: &mut Watch) -> Result<Self, Unarranged> {
        let component_of = components(domain);
        let (cycle_of, cycles) = cycles(domain, &component_of, watch)?;
        let count = cycles.iter().map(|c| c.component + 1).max().unwrap_or(0);
        let mut outer: Vec<Option<usize>> = vec![None; count];
        for (i, cycle) in cycles.iter().enumerate() {
            // The signed areas of a component's cycles add up to nothing, and the one around it is the only negative one.
            let best = &mut outer[cycle.component];
            if best.is_none_or(|b| cycle.area < cycles[b].area) {
                *best = Some(i);
            }
        }
        let outer = outer.into_iter().flatten().collect();
        let mut faces = Faces { cycle_of, cycles, outer, parent: Vec::new() };
        faces.parent = faces.nest(domain, margin, watch)?;
        Ok(faces)
    }

    fn face_of_cycle(&self, cycle: usize) -> Face {
        let component = self.cycles[cycle].component;
        if self.outer[component] == cycle { self.parent[component] } else { Some(cycle) }
    }

    pub fn face(&self, half: Half) -> Face {
        self.face_of_cycle(self.cycle_of[half.index()])
    }

    /// The components that lie in each face (by its cycle) and, last, in the unbounded one.
    pub fn components_by_face(&self) -> Vec<Vec<usize>> {
        let mut holds = vec![Vec::new(); self.cycles.len() + 1];
        for (component, parent) in self.parent.iter().enumerate() {
            holds[parent.unwrap_or(self.cycles.len())].push(component);
        }
        holds
    }

    /// The face in which every component lies.
    fn nest(&self, domain: &Domain, margin: f64, watch: &mut Watch) -> Result<Vec<Face>, Unarranged> {
        let mut view = View::new(self, domain, margin);
        for component in 0..self.outer.len() {
            tracing(domain, self.outer.len() - component).tell(watch)?;
            view.look_from(component)?;
        }
        view.part_rings(watch)?;
        let seen = view.seen;
        // A component seen from outside lies where that one lies. Each is followed once: what lies behind it is remembered.
        let mut behind: Vec<Option<Face>> = vec![None; seen.len()];
        for component in 0..seen.len() {
            let mut way = Vec::new();
            let mut here = component;
            let face = loop {
                match (behind[here], seen[here].flatten()) {
                    (Some(face), _) => break face,
                    (None, Some(c)) if self.outer[self.cycles[c].component] == c => {
                        way.push(here);
                        here = self.cycles[c].component;
                    }
                    (None, face) => break face,
                }
            };
            way.into_iter().chain([here, component]).for_each(|passed| behind[passed] = Some(face));
        }
        Ok(behind.into_iter().map(Option::flatten).collect())
    }
}

/// What components see of each other along level lines.
struct View<'a> {
    faces: &'a Faces,
    locator: Locator<'a>,
    margin: f64,
    /// By component.
    bounds: Vec<Rect>,
    /// By component, once it is known: the first cycle that is seen from its first crossing with some axis-parallel line, looking back
    /// from there. `Some(None)`: nothing is there.
    seen: Vec<Option<Option<usize>>>,
    /// By component: the last line that met it.
    met: Vec<usize>,
    lines: usize,
}

impl<'a> View<'a> {
    fn new(faces: &'a Faces, domain: &'a Domain, margin: f64) -> Self {
        let count = faces.outer.len();
        let mut bounds: Vec<Option<Rect>> = vec![None; count];
        for (id, curve) in domain.curves.enumerate() {
            let own = &mut bounds[faces.cycles[faces.cycle_of[Half { curve: id, side: Side::Left }.index()]].component];
            let around = curve.curve.bounds();
            *own = Some(own.map_or(around, |b| b.union(around)));
        }
        let bounds = bounds.into_iter().map(Option::unwrap_or_default).collect();
        let (seen, met) = (vec![None; count], vec![0; count]);
        Self { faces, locator: Locator::new(domain), margin, bounds, seen, met, lines: 0 }
    }

    /// Lines to look along from a component. A level line cannot pass a height of a few margins clear of its ends; and where none is
    /// clear, as at the tip of two curves that part slowly, upright ones may be.
    fn lines_through(&self, component: usize) -> impl Iterator<Item = (Axis, f64)> + use<> {
        let bounds = self.bounds[component];
        let axes = [Axis::Horizontal, Axis::Vertical];
        let is_flat = bounds.height() <= 4.0 * self.margin;
        let in_order = axes.into_iter().cycle().skip(usize::from(is_flat)).take(axes.len());
        in_order.flat_map(move |axis| levels(bounds, axis).map(move |level| (axis, level)))
    }

    /// Finds out what a component sees, if that is not known yet, and with it what others see that its line meets: rings in each other
    /// are passed a few times all together, not each by each.
    fn look_from(&mut self, component: usize) -> Result<(), ArrangeError> {
        let bounds = self.bounds[component];
        for (axis, level) in self.lines_through(component) {
            let [low, high] = along(axis, bounds);
            let mut reach = 4.0 * extent(bounds);
            // Looks ever further back: most components have a neighbour nearby. The unit frame ends within a few units.
            while self.seen[component].is_none() {
                let Some(hits) = self.locator.hits(axis, level, [low - reach, high], self.margin) else { break };
                if !hits.iter().any(|hit| self.component_of(hit) == component) {
                    break;
                }
                self.note(axis, low - reach, &hits);
                if reach > FRAME {
                    self.seen[component].get_or_insert(None);
                }
                reach *= 4.0;
            }
            if self.seen[component].is_some() {
                return Ok(());
            }
        }
        Err(self.untold(component))
    }

    /// Two components may see each other, each from another level. Those of such a ring lie in one face, and what is seen left of the leftmost
    /// of them on any line bounds it, too: that is what all of them see from then on. A further ring joins further ones.
    fn part_rings(&mut self, watch: &mut Watch) -> Result<(), Unarranged> {
        // By component: one that it was in a ring with, the same of all of them.
        let mut group: Vec<usize> = (0..self.seen.len()).collect();
        loop {
            let rings = self.rings();
            if rings.is_empty() {
                return Ok(());
            }
            for ring in rings {
                Progress { phase: "tracing", vertices: group.len(), queued: ring.len() }.tell(watch)?;
                let joined: BTreeSet<usize> = ring.iter().map(|&component| group[component]).collect();
                group.iter_mut().filter(|g| joined.contains(g)).for_each(|g| *g = ring[0]);
                self.look_out_of(ring[0], &group)?;
            }
        }
    }

    /// Components that see each other from outside in a ring.
    fn rings(&self) -> Vec<Vec<usize>> {
        let next = |component: usize| {
            let cycle = self.seen[component].flatten()?;
            Some(self.faces.cycles[cycle].component).filter(|&c| self.faces.outer[c] == cycle)
        };
        let mut walked = vec![usize::MAX; self.seen.len()];
        let mut rings = Vec::new();
        for start in 0..self.seen.len() {
            let mut here = Some(start);
            while let Some(component) = here.filter(|&c| walked[c] == usize::MAX) {
                walked[component] = start;
                here = next(component);
            }
            if let Some(first) = here.filter(|&c| walked[c] == start) {
                let rest = std::iter::successors(next(first), |&c| next(c)).take_while(|&c| c != first);
                rings.push([first].into_iter().chain(rest).collect());
            }
        }
        rings
    }

    /// What the leftmost of a group sees on a line through one of them, which goes on to the end of the frame, all of them see.
    fn look_out_of(&mut self, component: usize, group: &[usize]) -> Result<(), ArrangeError> {
        for (axis, level) in self.lines_through(component) {
            let [low, high] = along(axis, self.bounds[component]);
            let Some(hits) = self.locator.hits(axis, level, [low - 4.0 * FRAME, high], self.margin) else { continue };
            let is_in = |hit: &Hit| group[self.component_of(hit)] == group[component];
            if let Some(first) = hits.iter().position(is_in) {
                let beyond = first.checked_sub(1).map(|k| self.cycle_beyond(&hits[k]));
                let members = self.seen.iter_mut().zip(group).filter(|(_, g)| **g == group[component]);
                members.for_each(|(seen, _)| *seen = Some(beyond));
                return Ok(());
            }
        }
        Err(self.untold(component))
    }

    /// The cycle that is seen from the right of a crossing.
    fn cycle_beyond(&self, hit: &Hit) -> usize {
        self.faces.cycle_of[Half { curve: hit.curve, side: hit.before.other() }.index()]
    }

    fn untold(&self, component: usize) -> ArrangeError {
        ArrangeError::near(
            "it cannot be told which face contains the curves",
            self.bounds[component].center(),
            "remove curves that are hardly larger than the rounding of their coordinates",
        )
    }

    fn component_of(&self, hit: &Hit) -> usize {
        self.faces.cycles[self.faces.cycle_of[side_index(hit)]].component
    }

    /// Notes what the components on a line see there that begin on the looked at part of it.
    fn note(&mut self, axis: Axis, from: f64, hits: &[Hit]) {
        self.lines += 1;
        for (k, hit) in hits.iter().enumerate() {
            let component = self.component_of(hit);
            let is_first = std::mem::replace(&mut self.met[component], self.lines) != self.lines;
            let begins = from <= along(axis, self.bounds[component])[0];
            if is_first && begins && k > 0 {
                let cycle = self.cycle_beyond(&hits[k - 1]);
                self.seen[component].get_or_insert(Some(cycle));
            }
        }
    }
}

/// The range of a box along an axis.
fn along(axis: Axis, bounds: Rect) -> [f64; 2] {
    match axis {
        Axis::Horizontal => [bounds.x0, bounds.x1],
        Axis::Vertical => [bounds.y0, bounds.y1],
    }
}

fn tracing(domain: &Domain, queued: usize) -> Progress {
    Progress { phase: "tracing", vertices: domain.points.len(), queued }
}

fn side_index(hit: &Hit) -> usize {
    Half { curve: hit.curve, side: hit.before }.index()
}

/// Levels across a box, spread evenly by the golden ratio, so that no regular pattern hits them all.
fn levels(bounds: Rect, axis: Axis) -> impl Iterator<Item = f64> {
    let (low, width) = match axis {
        Axis::Horizontal => (bounds.y0, bounds.height()),
        Axis::Vertical => (bounds.x0, bounds.width()),
    };
    (1..=LINES).map(move |k| low + width * (k as f64 * 0.618_033_988_749_894_9).fract())
}

/// The connected component of every point, numbered in order of their first curves.
fn components(domain: &Domain) -> IdVec<PointId, usize> {
    let mut component: IdVec<PointId, usize> = vec![usize::MAX; domain.points.len()].into();
    let mut count = 0;
    for curve in domain.curves.iter() {
        if component[curve.ends[0]] != usize::MAX {
            continue;
        }
        let mut stack = vec![curve.ends[0]];
        component[curve.ends[0]] = count;
        while let Some(p) = stack.pop() {
            for end in domain.star(p).iter().flat_map(|i| domain.curves[i.curve].ends) {
                if component[end] == usize::MAX {
                    component[end] = count;
                    stack.push(end);
                }
            }
        }
        count += 1;
    }
    component
}

fn cycles(
    domain: &Domain,
    component_of: &IdVec<PointId, usize>,
    watch: &mut Watch,
) -> Result<(Vec<usize>, Vec<Cycle>), Stopped> {
    // Where each side's tail stands in the star of its point.
    let mut place = vec![0; 2 * domain.curves.len()];
    for star in domain.stars.iter() {
        for (k, &i) in star.iter().enumerate() {
            place[Half { curve: i.curve, side: left_of(i) }.index()] = k;
        }
    }
    let next = |half: Half| {
        let twin = half.twin();
        let star = domain.star(tail_point(domain, twin));
        let before = star[(place[twin.index()] + star.len() - 1) % star.len()];
        Half { curve: before.curve, side: left_of(before) }
    };
    let mut cycle_of = vec![usize::MAX; 2 * domain.curves.len()];
    let mut cycles = Vec::new();
    let sides = domain.curves.ids().flat_map(|curve| [Side::Left, Side::Right].map(|side| Half { curve, side }));
    for first in sides {
        tracing(domain, domain.curves.len() - first.curve.index()).tell(watch)?;
        let mut halves = Vec::new();
        let mut half = first;
        while cycle_of[half.index()] == usize::MAX {
            cycle_of[half.index()] = cycles.len();
            halves.push(half);
            half = next(half);
        }
        if !halves.is_empty() {
            let component = component_of[tail_point(domain, first)];
            cycles.push(Cycle { area: area(domain, &halves), halves, component });
        }
    }
    Ok((cycle_of, cycles))
}

fn tail_point(domain: &Domain, half: Half) -> PointId {
    let ends = domain.curves[half.curve].ends;
    match half.tail().end {
        End::Start => ends[0],
        End::Finish => ends[1],
    }
}

/// The signed area that a cycle goes around, by Green about one of its points; summed with Neumaier's compensation.
fn area(domain: &Domain, halves: &[Half]) -> f64 {
    let Some(&first) = halves.first() else { return 0.0 };
    let origin = domain.points[tail_point(domain, first)];
    let (mut sum, mut lost) = (0.0f64, 0.0);
    for half in halves {
        let forward = domain.curves[half.curve].curve.green(origin);
        let term = if half.side == Side::Left { forward } else { -forward };
        let next = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + lost
}

// ---- regions ----

/// What the seeds say of a face.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Said {
    Hole,
    Region(NameId, Option<f64>),
}

/// Chooses the kept faces, names their regions and writes them on the sides of the curves. `network` is what the domain was made of.
pub(super) fn keep(
    network: &Network,
    domain: &mut Domain,
    faces: &Faces,
    rule: FillRule,
    options: &ArrangeOptions,
    watch: &mut Watch,
) -> Result<(), Unarranged> {
    let Fill { inside: mut kept, painted } = Fill::new(network, domain, faces, rule, options.fragments);
    let said = read_seeds(network, domain, faces, watch)?;
    for (face, said) in said.iter().enumerate() {
        kept[face] &= options.keep_all || *said != Some(Said::Hole);
    }
    if !kept.contains(&true) {
        return Err(nothing_to_mesh(network, faces, rule).into());
    }
    let areas = face_areas(faces);
    let labels = read_labels(network, domain, faces, watch)?;
    let mut named: Vec<Option<(NameId, Option<f64>)>> = vec![None; kept.len()];
    for face in (0..kept.len()).filter(|&face| kept[face]) {
        named[face] = match said[face] {
            Some(Said::Region(name, max_area)) => Some((name, max_area)),
            Some(Said::Hole) | None => {
                let label = || labels[face].map(|text| domain.names.intern(text));
                painted[face].or_else(label).map(|name| (name, None))
            }
        };
    }
    let region_of = name_regions(network, domain, faces, &kept, |face| named[face], &areas);
    let region = |half: Half| faces.face(half).and_then(|face| region_of[face]);
    for id in domain.curves.ids() {
        let sides = [Side::Left, Side::Right].map(|side| region(Half { curve: id, side }));
        domain.curves[id].sides = sides;
    }
    Ok(())
}

/// What the seeds say, by face. Holes win over region names; of several names the first.
fn read_seeds(
    network: &Network,
    domain: &mut Domain,
    faces: &Faces,
    watch: &mut Watch,
) -> Result<Vec<Option<Said>>, Stopped> {
    let seeds = &network.drawing.seeds;
    let mut said: Vec<Option<Said>> = vec![None; faces.cycles.len()];
    let mut repairs = Vec::new();
    let locator = Locator::new(domain);
    let is_hole = |k: &SeedKind| matches!(k, SeedKind::Hole);
    let holes_first = [true, false].into_iter().flat_map(|hole| seeds.iter().filter(move |s| is_hole(&s.kind) == hole));
    for (k, seed) in holes_first.enumerate() {
        tracing(domain, seeds.len() - k).tell(watch)?;
        let sight = locator.sight(seed.at);
        let face = sight.and_then(|Sight { curve, side, .. }| faces.face(Half { curve, side }));
        let mut note = |why: &str| {
            let what = format!("{} {why}", seed.entity);
            repairs.push(Repair { kind: RepairKind::Seed, at: [seed.at.x, seed.at.y], size: 0.0, what });
        };
        let on_curve = sight.is_some_and(|s| s.distance <= network.tolerances.weld);
        if on_curve && face.is_some() {
            note("lies on a curve, and was taken for the face on one of its sides");
        }
        let new = match seed.kind {
            SeedKind::Hole => Said::Hole,
            SeedKind::Region { name, max_area } => Said::Region(name, max_area),
        };
        match face.map(|f| (f, said[f])) {
            None if on_curve => note("lies on a curve beside no bounded face and was not used"),
            None => note("lies in no bounded face and was not used"),
            Some((f, None)) => said[f] = Some(new),
            Some((_, Some(old))) if old == new => note("lies in a face that already has such a point"),
            Some(_) => note("lies in a face that another point speaks for, and was not used"),
        }
    }
    domain.repairs.extend(repairs);
    Ok(said)
}

/// The text that stands in each face, where there is one only.
fn read_labels<'a>(
    network: &Network<'a>,
    domain: &Domain,
    faces: &Faces,
    watch: &mut Watch,
) -> Result<Vec<Option<&'a str>>, Stopped> {
    let labels = &network.drawing.labels;
    let mut said: Vec<BTreeSet<&str>> = vec![BTreeSet::new(); faces.cycles.len()];
    let locator = Locator::new(domain);
    for (k, label) in labels.iter().enumerate() {
        tracing(domain, labels.len() - k).tell(watch)?;
        let sight = locator.sight(label.at);
        if let Some(face) = sight.and_then(|Sight { curve, side, .. }| faces.face(Half { curve, side })) {
            said[face].insert(label.text.as_str());
        }
    }
    Ok(said.into_iter().map(|texts| texts.first().copied().filter(|_| texts.len() == 1)).collect())
}

/// The area of every bounded face: its own cycle less the outlines of the components in it.
fn face_areas(faces: &Faces) -> Vec<f64> {
    let mut areas: Vec<f64> = faces.cycles.iter().map(|c| c.area).collect();
    for (component, parent) in faces.parent.iter().enumerate() {
        if let Some(face) = parent {
            areas[*face] += faces.cycles[faces.outer[component]].area;
        }
    }
    areas
}

/// One region for each name and area limit that is given, in order of the names; then one for each other kept face, the largest
/// first, under a name that no other region has.
fn name_regions(
    network: &Network,
    domain: &mut Domain,
    faces: &Faces,
    kept: &[bool],
    given: impl Fn(usize) -> Option<(NameId, Option<f64>)>,
    areas: &[f64],
) -> Vec<Option<RegionId>> {
    let mut region_of = vec![None; faces.cycles.len()];
    let (mut named, mut unnamed) = (Vec::new(), Vec::new());
    for face in (0..kept.len()).filter(|&f| kept[f]) {
        match given(face) {
            Some((name, max_area)) => named.push((name, max_area, face)),
            None => unnamed.push(face),
        }
    }
    let limit = |max_area: Option<f64>| max_area.unwrap_or(f64::INFINITY);
    named.sort_by(|a, b| a.0.cmp(&b.0).then(limit(a.1).total_cmp(&limit(b.1))).then(a.2.cmp(&b.2)));
    for group in named.chunk_by(|a, b| a.0 == b.0 && a.1 == b.1) {
        let (name, max_area, _) = group[0];
        let area = group.iter().map(|g| areas[g.2]).sum();
        let id = domain.regions.push(Region { name, is_named: true, area, max_area });
        group.iter().for_each(|g| region_of[g.2] = Some(id));
    }
    let place = |face: usize| {
        let points = faces.cycles[face].halves.iter().map(|&h| domain.points[tail_point(domain, h)]);
        points.map(|p| [p.y, p.x]).min_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))).unwrap_or_default()
    };
    let mut placed: Vec<(f64, [f64; 2], usize)> = unnamed.into_iter().map(|f| (areas[f], place(f), f)).collect();
    placed.sort_by(|a, b| {
        let lower = a.1[0].total_cmp(&b.1[0]).then(a.1[1].total_cmp(&b.1[1]));
        b.0.total_cmp(&a.0).then(lower).then(a.2.cmp(&b.2))
    });
    let outlines: Vec<Option<&str>> =
        placed.iter().map(|&(_, _, face)| layer_of_outline(network, faces, face)).collect();
    let names = numbered(domain, &outlines);
    for ((area, _, face), name) in placed.into_iter().zip(names) {
        let name = domain.names.intern(&name);
        region_of[face] = Some(domain.regions.push(Region { name, is_named: false, area, max_area: None }));
    }
    region_of
}

/// The layer that most of the outline of a face is drawn on; `None` where the file has no layers, or for the one that every file has.
fn layer_of_outline<'a>(network: &Network<'a>, faces: &Faces, face: usize) -> Option<&'a str> {
    let drawing = network.drawing;
    let mut lengths: BTreeMap<LayerId, f64> = BTreeMap::new();
    for half in &faces.cycles[face].halves {
        let piece = &network.pieces[half.curve];
        if let Some(layer) = drawing.curves[piece.source as usize].layer {
            *lengths.entry(layer).or_default() += extent(piece.bounds);
        }
    }
    let (&layer, _) = lengths.iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    Some(drawing.layers[layer].name.as_str()).filter(|name| !name.is_empty() && *name != "0")
}

/// Names that no region has yet: of the layer, or `region`; with a number where several would have one.
fn numbered(domain: &Domain, outlines: &[Option<&str>]) -> Vec<String> {
    let mut taken: BTreeSet<String> = domain.regions.iter().map(|r| domain.name(r.name).to_owned()).collect();
    let bases: Vec<&str> = outlines.iter().map(|outline| outline.unwrap_or("region")).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    bases.iter().for_each(|&base| *counts.entry(base).or_default() += 1);
    let mut last: BTreeMap<&str, usize> = BTreeMap::new();
    let mut names = Vec::with_capacity(bases.len());
    for base in bases {
        let mut name = base.to_owned();
        let number = last.entry(base).or_default();
        while taken.contains(&name) || counts[base] > 1 && name == base {
            *number += 1;
            name = format!("{base}{number}");
        }
        taken.insert(name.clone());
        names.push(name);
    }
    names
}

/// Says why no face is kept, at the first free end if that is why.
fn nothing_to_mesh(network: &Network, faces: &Faces, rule: FillRule) -> ArrangeError {
    let has_faces = faces.cycles.len() > faces.outer.len();
    let first = network.drawing.curves.first().map_or(Point::ORIGIN, |c| c.curve.start());
    if let Some(error) = cut_away(network.drawing, rule) {
        return error;
    }
    if has_faces {
        return all_outside(rule, first);
    }
    let free = network.free_ends();
    let Some(end) = free.first() else {
        let help = "the curves enclose nothing: draw a closed outline";
        return ArrangeError::new("nothing to mesh: no closed region", first, help);
    };
    let gap = free[1..].iter().map(|other| other.at.distance(end.at)).reduce(f64::min);
    let away =
        gap.map_or_else(String::new, |gap| format!("{} away from the next free end: ", network.tolerances.told(gap)));
    let what = format!("nothing to mesh: no closed region; {} ends freely", network.entity_of(end));
    ArrangeError::new(what, end.at, format!("{away}close the outline by another curve"))
}

/// That clips leave nothing of the shapes, where all are cut.
fn cut_away(drawing: &Drawing, rule: FillRule) -> Option<ArrangeError> {
    match rule {
        FillRule::Shapes | FillRule::EvenOddAndShapes => {}
        FillRule::Regions | FillRule::NonZero | FillRule::EvenOdd => return None,
    }
    let mut painted = drawing.shapes.enumerate().filter(|(_, shape)| shape.part_of.is_none());
    let (id, shape) = painted.next()?;
    if shape.clip.is_none() || painted.any(|(_, other)| other.clip.is_none()) {
        return None;
    }
    let outline = drawing.curves.iter().find(|c| c.shape == Some(id));
    let part = drawing.shapes.iter().find(|part| part.part_of == shape.clip);
    let clip = part.map_or("a clip without extent", |part| &part.entity);
    let what =
        format!("nothing to mesh: {} and all other shapes are cut away; the first is cut by {clip}", shape.entity);
    let at = outline.map_or(Point::ORIGIN, |c| c.curve.start());
    Some(ArrangeError::new(what, at, "move the clip over what it cuts, or take it off"))
}

/// Why no face of a drawing that has some is kept.
fn all_outside(rule: FillRule, at: Point) -> ArrangeError {
    let error = |what: &str, help: &str| ArrangeError::new(format!("nothing to mesh: {what}"), at, help);
    match rule {
        FillRule::Regions => error("a hole point lies in every closed region", "remove hole points"),
        FillRule::NonZero | FillRule::EvenOdd | FillRule::Shapes | FillRule::EvenOddAndShapes => error(
            "every closed region is a hole or outside by the fill rule",
            "choose another fill rule (`regions` keeps every bounded face), or remove hole points",
        ),
    }
}
