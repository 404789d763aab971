//! Faces: which face holds which component.
//!
//! ```text
//!      ╭──────────────────╮
//!      │ C     ╭───╮      │      Level lines through each component tell it what it sees to its left, beginning at its first crossing: B
//!  ────│──○────│─B─│───●──│──    sees a side of C that bounds a face, and lies in that. A component that sees another from outside lies
//!      │       ╰───╯   A  │      where that one lies: A sees B from outside, and so lies in the same face of C.
//!      ╰──────────────────╯
//! ```

use super::error::{ArrangeError, Unarranged};
use super::trace::{Cycle, Cycles, DirectedEdge, tracing};
use crate::domain::Domain;
use crate::domain::locate::{Axis, Hit, Locator, Side};
use crate::geometry::{Rect, extent};
use crate::watch::{Progress, Watch};
use std::collections::BTreeSet;

/// Axis-parallel lines tried through a component before its place counts as undecided; each fails only by passing
/// within rounding of a vertex or along a curve.
const LINES: usize = 64;

/// More than the unit frame is wide, the box of `keep all` included: coordinates of at most 1 and 2√2 on either side.
const FRAME: f64 = 16.0;

/// A face: a cycle that bounds it from outside, known by its place; `None`: the unbounded face.
pub(super) type Face = Option<usize>;

/// The cycles of all sides, their components (as in [`Cycles`]), and how components lie in each other.
pub(super) struct Faces {
    pub cycle_of: Vec<usize>,
    pub cycles: Vec<Cycle>,
    /// By component: the cycle that sees the component from outside.
    pub outer: Vec<usize>,
    /// By component: the face in which it lies.
    pub parent: Vec<Face>,
}

impl Faces {
    /// Finds out in which face each component of a domain lies, along lines that keep `margin` away from ends of
    /// curves.
    pub fn new(cycles: Cycles, domain: &Domain, margin: f64, watch: &mut Watch) -> Result<Self, Unarranged> {
        let parent = parents(&cycles, domain, margin, watch)?;
        let Cycles { cycle_of, cycles, outer } = cycles;
        Ok(Self { cycle_of, cycles, outer, parent })
    }

    fn face_of_cycle(&self, cycle: usize) -> Face {
        let component = self.cycles[cycle].component;
        if self.outer[component] == cycle { self.parent[component] } else { Some(cycle) }
    }

    /// The face on the left of a side.
    pub fn face(&self, edge: DirectedEdge) -> Face {
        self.face_of_cycle(self.cycle_of[edge.index()])
    }

    /// The components that lie in each face (by its cycle) and, last, in the unbounded one.
    pub fn components_by_face(&self) -> Vec<Vec<usize>> {
        let mut holds = vec![Vec::new(); self.cycles.len() + 1];
        for (component, parent) in self.parent.iter().enumerate() {
            holds[parent.unwrap_or(self.cycles.len())].push(component);
        }
        holds
    }
}

/// The face in which every component lies.
fn parents(cycles: &Cycles, domain: &Domain, margin: f64, watch: &mut Watch) -> Result<Vec<Face>, Unarranged> {
    let mut view = View::new(cycles, domain, margin);
    for component in 0..cycles.outer.len() {
        tracing(domain, cycles.outer.len() - component).tell(watch)?;
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
                (None, Some(c)) if cycles.is_outer(c) => {
                    way.push(here);
                    here = cycles.cycles[c].component;
                }
                (None, face) => break face,
            }
        };
        way.into_iter().chain([here, component]).for_each(|passed| behind[passed] = Some(face));
    }
    Ok(behind.into_iter().map(Option::flatten).collect())
}

/// What components see of each other along level lines.
struct View<'a> {
    cycles: &'a Cycles,
    locator: Locator<'a>,
    margin: f64,
    /// By component.
    bounds: Vec<Rect>,
    /// By component, once it is known: the first cycle that is seen from its first crossing with some axis-parallel
    /// line, looking back from there. `Some(None)`: nothing is there.
    seen: Vec<Option<Option<usize>>>,
    /// By component: the last line that met it.
    met: Vec<usize>,
    lines: usize,
}

impl<'a> View<'a> {
    fn new(cycles: &'a Cycles, domain: &'a Domain, margin: f64) -> Self {
        let count = cycles.outer.len();
        let mut bounds: Vec<Option<Rect>> = vec![None; count];
        for (id, curve) in domain.curves.enumerate() {
            let own = &mut bounds[cycles.of(DirectedEdge { curve: id, side: Side::Left }).component];
            let around = curve.curve.bounds();
            *own = Some(own.map_or(around, |b| b.union(around)));
        }
        let bounds = bounds.into_iter().map(Option::unwrap_or_default).collect();
        let (seen, met) = (vec![None; count], vec![0; count]);
        Self { cycles, locator: Locator::new(domain), margin, bounds, seen, met, lines: 0 }
    }

    /// Lines to look along from a component. A level line cannot pass a height of a few margins clear of its ends; and
    /// where none is clear, as at the tip of two curves that part slowly, upright ones may be.
    fn lines_through(&self, component: usize) -> impl Iterator<Item = (Axis, f64)> + use<> {
        let bounds = self.bounds[component];
        let axes = [Axis::Horizontal, Axis::Vertical];
        let is_flat = bounds.height() <= 4.0 * self.margin;
        let in_order = axes.into_iter().cycle().skip(usize::from(is_flat)).take(axes.len());
        in_order.flat_map(move |axis| levels(bounds, axis).map(move |level| (axis, level)))
    }

    /// Finds out what a component sees, if that is not known yet, and with it what others see that its line meets:
    /// rings in each other are passed a few times all together, not each by each.
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

    /// Two components may see each other, each from another level. Those of such a ring lie in one face, and what is
    /// seen left of the leftmost of them on any line bounds it, too: that is what all of them see from then on. A
    /// further ring joins further ones.
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
            let cycle = self.seen[component].flatten().filter(|&cycle| self.cycles.is_outer(cycle))?;
            Some(self.cycles.cycles[cycle].component)
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

    /// What the leftmost of a group sees on a line through one of them, which goes on to the end of the frame, all of
    /// them see.
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
        self.cycles.cycle_of[DirectedEdge { curve: hit.curve, side: hit.before.other() }.index()]
    }

    fn untold(&self, component: usize) -> ArrangeError {
        ArrangeError::near(
            "it cannot be told which face contains the curves",
            self.bounds[component].center(),
            "remove curves that are hardly larger than the rounding of their coordinates",
        )
    }

    fn component_of(&self, hit: &Hit) -> usize {
        self.cycles.of(DirectedEdge { curve: hit.curve, side: hit.before }).component
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

/// Levels across a box, spread evenly by the golden ratio, so that no regular pattern hits them all.
fn levels(bounds: Rect, axis: Axis) -> impl Iterator<Item = f64> {
    let (low, width) = match axis {
        Axis::Horizontal => (bounds.y0, bounds.height()),
        Axis::Vertical => (bounds.x0, bounds.width()),
    };
    (1..=LINES).map(move |k| low + width * (k as f64 * 0.618_033_988_749_894_9).fract())
}
