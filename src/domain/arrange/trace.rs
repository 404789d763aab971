//! Faces: cycles of curve sides, which face holds which component, winding numbers, and the kept regions with their names.

use super::cut::{Network, extent};
use super::{ArrangeError, FillRule, Repair, RepairKind, Unarranged};
use crate::curve::End;
use crate::domain::locate::{Axis, Hit, Locator, Side, Sight, left_of};
use crate::domain::{Domain, Incident, Region, SeedKind};
use crate::geometry::{Point, Rect};
use crate::ids::{CurveId, Id, IdVec, NameId, PointId, RegionId};
use crate::watch::{Progress, Stopped, Watch};

/// Axis-parallel lines tried through a component before its place counts as undecided; each fails only by passing within rounding of
/// a vertex or along a curve.
const LINES: usize = 64;

/// More than the unit frame is wide, the box of `keep all` included: coordinates of at most 1 and 2√2 on either side.
const FRAME: f64 = 16.0;

/// A curve side: the curve travelled forward has its face on the left, travelled backward the one on its right.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Half {
    curve: CurveId,
    side: Side,
}

impl Half {
    fn index(self) -> usize {
        2 * self.curve.index() + self.side.index()
    }

    fn twin(self) -> Self {
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
type Face = Option<usize>;

/// The cycles of all sides, their components, and how components lie in each other.
pub(super) struct Faces {
    cycle_of: Vec<usize>,
    cycles: Vec<Cycle>,
    /// By component: the cycle that sees the component from outside.
    outer: Vec<usize>,
    /// By component: the face in which it lies.
    parent: Vec<Face>,
}

struct Cycle {
    halves: Vec<Half>,
    area: f64,
    component: usize,
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

    fn face(&self, half: Half) -> Face {
        self.face_of_cycle(self.cycle_of[half.index()])
    }

    /// The face in which every component lies.
    fn nest(&self, domain: &Domain, margin: f64, watch: &mut Watch) -> Result<Vec<Face>, Unarranged> {
        let locator = Locator::new(domain);
        let mut seen = Vec::with_capacity(self.outer.len());
        for component in 0..self.outer.len() {
            tracing(domain, self.outer.len() - component).tell(watch)?;
            seen.push(self.seen_from(component, domain, &locator, margin)?);
        }
        // A component seen from outside lies where that one lies, which is further left (of flat ones: further down). Each is followed
        // once: what lies behind it is remembered.
        let mut behind: Vec<Option<Face>> = vec![None; seen.len()];
        for component in 0..seen.len() {
            let mut way = Vec::new();
            let mut here = component;
            let face = loop {
                match (behind[here], seen[here]) {
                    (Some(face), _) => break face,
                    (None, Some(c)) if self.outer[self.cycles[c].component] == c && way.len() < seen.len() => {
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

    /// The first cycle that is seen from a component's leftmost crossing with a level line, looking left; of a component without
    /// height, looking down from it.
    fn seen_from(
        &self,
        component: usize,
        domain: &Domain,
        locator: &Locator,
        margin: f64,
    ) -> Result<Option<usize>, ArrangeError> {
        let halves = &self.cycles[self.outer[component]].halves;
        let boxes = halves.iter().map(|h| domain.curves[h.curve].curve.bounds());
        let bounds = boxes.reduce(|a, b| a.union(b)).unwrap_or_default();
        // A level line cannot pass a height of a few margins clear of its ends.
        let axis = if bounds.height() > 4.0 * margin { Axis::Horizontal } else { Axis::Vertical };
        let is_mine = |hit: &Hit| self.cycles[self.cycle_of[side_index(hit)]].component == component;
        for level in levels(bounds, axis) {
            let (low, high) = if axis == Axis::Horizontal { (bounds.x0, bounds.x1) } else { (bounds.y0, bounds.y1) };
            let mut reach = extent(bounds);
            // Looks ever further back: most components have a neighbour nearby. The unit frame ends within a few units.
            while let Some(hits) = locator.hits(axis, level, [low - reach, high], margin) {
                match hits.iter().position(is_mine) {
                    None => break,
                    Some(0) if reach > FRAME => return Ok(None),
                    Some(0) => reach *= 4.0,
                    Some(first) => {
                        let Hit { curve, before, .. } = hits[first - 1];
                        return Ok(Some(self.cycle_of[Half { curve, side: before.other() }.index()]));
                    }
                }
            }
        }
        Err(ArrangeError {
            what: "it cannot be told which face contains the curves".into(),
            at: bounds.center(),
            help: "remove curves that are hardly larger than the rounding of their coordinates".into(),
        })
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

// ---- which faces are inside ----

/// How often the drawn curves go around every face (by the cycle that bounds it); 0 of the unbounded face.
struct Windings<'a> {
    faces: &'a Faces,
    domain: &'a Domain,
    rule: FillRule,
    /// How often each curve counts, in its own direction; 0 where the same face lies on both sides.
    weight: Vec<i32>,
    winding: Vec<Option<i32>>,
}

fn is_inside(rule: FillRule, winding: i32) -> bool {
    match rule {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd => winding % 2 != 0,
        FillRule::Regions => true,
    }
}

impl Windings<'_> {
    fn of(&self, face: Face) -> i32 {
        face.map_or(0, |f| self.winding[f].unwrap_or(0))
    }

    /// Winding numbers of all faces, outer components first.
    fn settle(&mut self, counted: &[bool]) {
        let faces = self.faces;
        let mut inside: Vec<Vec<usize>> = vec![Vec::new(); faces.cycles.len()];
        let mut queue: Vec<usize> = Vec::new();
        for (component, parent) in faces.parent.iter().enumerate() {
            match parent {
                Some(face) => inside[*face].push(component),
                None => queue.push(component),
            }
        }
        let mut bounded: Vec<Vec<usize>> = vec![Vec::new(); faces.outer.len()];
        for (i, cycle) in faces.cycles.iter().enumerate() {
            if faces.outer[cycle.component] != i {
                bounded[cycle.component].push(i);
            }
        }
        while let Some(component) = queue.pop() {
            self.settle_component(component, &bounded[component], counted);
            queue.extend(bounded[component].iter().flat_map(|&face| inside[face].iter().copied()));
        }
    }

    fn settle_component(&mut self, component: usize, bounded: &[usize], counted: &[bool]) {
        let around = self.of(self.faces.parent[component]);
        let outer = self.faces.outer[component];
        let sides = bounded.iter().chain([&outer]).flat_map(|&cycle| &self.faces.cycles[cycle].halves);
        let closed = bounded.is_empty() || sides.clone().any(|half| counted[half.curve.index()]);
        if !closed {
            // Nothing but open curves that enclose something by crossing: filled where nothing around them is.
            let within = if is_inside(self.rule, around) { around } else { around + 1 };
            bounded.iter().for_each(|&face| self.winding[face] = Some(within));
        } else if self.is_balanced(sides.copied()) {
            self.spread(outer, around);
        } else {
            bounded.iter().for_each(|&face| self.winding[face] = Some(around + 1));
        }
    }

    /// Whether as many curves arrive as leave, at every point: only then is the winding number the same along every way.
    fn is_balanced(&self, sides: impl Iterator<Item = Half>) -> bool {
        let mut flow: Vec<(PointId, i32)> = Vec::new();
        for half in sides.filter(|h| h.side == Side::Left) {
            let weight = self.weight[half.curve.index()];
            let ends = self.domain.curves[half.curve].ends;
            flow.extend([(ends[0], weight), (ends[1], -weight)]);
        }
        flow.sort_unstable();
        flow.chunk_by(|a, b| a.0 == b.0).all(|chunk| {
            let net: i32 = chunk.iter().map(|f| f.1).sum();
            if self.rule == FillRule::EvenOdd { net % 2 == 0 } else { net == 0 }
        })
    }

    /// From the face around a component across its curves to all its faces.
    fn spread(&mut self, outer: usize, around: i32) {
        let mut stack = vec![(outer, around)];
        while let Some((cycle, winding)) = stack.pop() {
            for &half in &self.faces.cycles[cycle].halves {
                let beyond = self.faces.cycle_of[half.twin().index()];
                if beyond == outer || beyond == cycle || self.winding[beyond].is_some() {
                    continue;
                }
                let weight = self.weight[half.curve.index()];
                // The left of a curve that counts once winds once more than its right.
                let there = if half.side == Side::Left { winding - weight } else { winding + weight };
                self.winding[beyond] = Some(there);
                stack.push((beyond, there));
            }
        }
    }
}

/// Which drawn curves are parts of closed outlines, by their own ends: a curve at a free end is none, nor what is left free without it.
fn closed_outlines(network: &Network) -> Vec<bool> {
    let mut at: IdVec<PointId, Vec<usize>> = vec![Vec::new(); network.nodes.len()].into();
    for (i, ends) in network.drawn_ends.iter().enumerate() {
        ends.iter().flatten().for_each(|&end| at[end].push(i));
    }
    let mut closed: Vec<bool> = network.drawn_ends.iter().map(Option::is_some).collect();
    let mut degree: IdVec<PointId, usize> = at.iter().map(Vec::len).collect();
    let mut free: Vec<PointId> = degree.enumerate().filter(|&(_, &d)| d == 1).map(|(id, _)| id).collect();
    while let Some(end) = free.pop() {
        let Some(&gone) = at[end].iter().find(|&&i| closed[i]) else { continue };
        closed[gone] = false;
        for &other in network.drawn_ends[gone].iter().flatten() {
            degree[other] -= 1;
            if degree[other] == 1 {
                free.push(other);
            }
        }
    }
    closed
}

fn windings(network: &Network, domain: &Domain, faces: &Faces, rule: FillRule) -> Vec<i32> {
    let closed = closed_outlines(network);
    let same_face = |id: CurveId| {
        let [left, right] = [Side::Left, Side::Right].map(|side| faces.cycle_of[Half { curve: id, side }.index()]);
        left == right
    };
    let drawn = |id: CurveId| {
        let piece = &network.pieces[id];
        [(piece.source, false)].into_iter().chain(piece.merged.iter().copied())
    };
    let count = |(source, against): (u32, bool)| match closed[source as usize] {
        false => 0,
        true if against => -1,
        true => 1,
    };
    let weight = domain.curves.ids().map(|id| if same_face(id) { 0 } else { drawn(id).map(count).sum() });
    let counted: Vec<bool> = (domain.curves.ids())
        .map(|id| !same_face(id) && drawn(id).any(|(source, _)| closed[source as usize]))
        .collect();
    let winding = vec![None; faces.cycles.len()];
    let mut windings = Windings { faces, domain, rule, weight: weight.collect(), winding };
    windings.settle(&counted);
    windings.winding.into_iter().map(|w| w.unwrap_or(0)).collect()
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
    holes: bool,
    watch: &mut Watch,
) -> Result<(), Unarranged> {
    let winding = match rule {
        FillRule::Regions => vec![1; faces.cycles.len()],
        _ => windings(network, domain, faces, rule),
    };
    let is_bounded = |cycle: usize| faces.outer[faces.cycles[cycle].component] != cycle;
    let mut kept: Vec<bool> = (0..faces.cycles.len()).map(|c| is_bounded(c) && is_inside(rule, winding[c])).collect();
    let said = read_seeds(network, domain, faces, watch)?;
    for (face, said) in said.iter().enumerate() {
        kept[face] &= !(holes && *said == Some(Said::Hole));
    }
    if !kept.contains(&true) {
        return Err(nothing_to_mesh(network, faces).into());
    }
    let areas = face_areas(faces);
    let region_of = name_regions(domain, faces, &kept, &said, &areas);
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
        if sight.is_some_and(|s| s.distance <= network.tolerances.weld) {
            note("lies on a curve, and was taken for the face on one of its sides");
        }
        let new = match seed.kind {
            SeedKind::Hole => Said::Hole,
            SeedKind::Region { name, max_area } => Said::Region(name, max_area),
        };
        match face.map(|f| (f, said[f])) {
            None => note("lies in no bounded face and was not used"),
            Some((f, None)) => said[f] = Some(new),
            Some((_, Some(old))) if old == new => note("lies in a face that already has such a point"),
            Some(_) => note("lies in a face that another point speaks for, and was not used"),
        }
    }
    domain.repairs.extend(repairs);
    Ok(said)
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

/// One region for each name and area limit that seeds give, in their order; then one for each other kept face, the largest first.
fn name_regions(
    domain: &mut Domain,
    faces: &Faces,
    kept: &[bool],
    said: &[Option<Said>],
    areas: &[f64],
) -> Vec<Option<RegionId>> {
    let mut region_of = vec![None; faces.cycles.len()];
    let (mut named, mut unnamed) = (Vec::new(), Vec::new());
    for face in (0..kept.len()).filter(|&f| kept[f]) {
        match said[face] {
            Some(Said::Region(name, max_area)) => named.push((name, max_area, face)),
            _ => unnamed.push(face),
        }
    }
    let limit = |max_area: Option<f64>| max_area.unwrap_or(f64::INFINITY);
    named.sort_by(|a, b| a.0.cmp(&b.0).then(limit(a.1).total_cmp(&limit(b.1))).then(a.2.cmp(&b.2)));
    for group in named.chunk_by(|a, b| a.0 == b.0 && a.1 == b.1) {
        let (name, max_area, _) = group[0];
        let area = group.iter().map(|g| areas[g.2]).sum();
        let id = domain.regions.push(Region { name, area, max_area });
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
    let alone = placed.len() == 1;
    for (k, &(area, _, face)) in placed.iter().enumerate() {
        let name = if alone { "region".to_owned() } else { format!("region{}", k + 1) };
        let name = domain.names.intern(&name);
        region_of[face] = Some(domain.regions.push(Region { name, area, max_area: None }));
    }
    region_of
}

/// Says why no face is kept, at the first free end if that is why.
fn nothing_to_mesh(network: &Network, faces: &Faces) -> ArrangeError {
    let has_faces = faces.cycles.len() > faces.outer.len();
    let first = network.drawing.curves.first().map_or(Point::ORIGIN, |c| c.curve.start());
    if has_faces {
        return ArrangeError {
            what: "nothing to mesh: every closed region is a hole or outside by the fill rule".into(),
            at: first,
            help: "choose another fill rule (`regions` keeps every bounded face), or remove hole points".into(),
        };
    }
    let free = network.free_ends();
    let Some(&end) = free.first() else {
        return ArrangeError {
            what: "nothing to mesh: no closed region".into(),
            at: first,
            help: "the curves enclose nothing: draw a closed outline".into(),
        };
    };
    let at = network.nodes[end].at;
    let gap = free[1..].iter().map(|&n| network.nodes[n].at.distance(at)).fold(f64::INFINITY, f64::min);
    let gap = gap * network.tolerances.unit;
    ArrangeError {
        what: format!(
            "nothing to mesh: no closed region; {} ends freely",
            network.nodes[end].origin.text(network.drawing)
        ),
        at,
        help: format!("the nearest other free end is {gap} away: close the outline, or raise the tolerance above that"),
    }
}
