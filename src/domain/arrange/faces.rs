//! Faces, and in which face each component lies.
//!
//! ```text
//!      ╭──────────────────────╮       A horizontal line through B crosses C next to its left, at a side of C that
//!      │ C   ╭─────╮   ╭───╮  │       bounds a face: B lies in it. A horizontal line through A crosses B next, at its
//!   ───┼─────┼─ B ─┼───┼ A ┼──┼──     outer cycle: A lies in the same face as B.
//!      │     ╰─────╯   ╰───╯  │
//!      ╰──────────────────────╯
//! ```

use super::error::{ArrangeError, Unarranged};
use super::trace::{Cycle, Cycles, DirectedEdge, tracing};
use crate::domain::Domain;
use crate::domain::locate::{Axis, Hit, Locator, Side};
use crate::geometry::{Rect, extent};
use crate::watch::{Progress, Watch};
use std::collections::BTreeSet;

/// The number of lines parallel to each axis that are tried through a component before its place is undecided. A line
/// fails only where it passes within rounding of a vertex or runs along a curve.
const LINES: usize = 64;

/// More than the width of the unit frame with the box of `keep all`: coordinates of at most 1, and 2√2 more on either
/// side.
const FRAME: f64 = 16.0;

/// A face, as the index of the cycle around it; `None`: the unbounded face.
pub(super) type Face = Option<usize>;

/// The cycles of all directed edges and their components (as in [`Cycles`]), and in which face each component lies.
pub(super) struct Faces {
    /// By [`DirectedEdge::index`]: the index of its cycle.
    pub cycle_of: Vec<usize>,
    /// The cycles.
    pub cycles: Vec<Cycle>,
    /// By component: its outer cycle, which has the face around the component on its left.
    pub outer: Vec<usize>,
    /// By component: the face in which it lies.
    pub parent: Vec<Face>,
}

impl Faces {
    /// Determines in which face each component of a domain lies, along lines that keep `margin` away from the ends of
    /// curves.
    ///
    /// # Errors
    ///
    /// Where all lines through a component fail, and where `watch` ends the run.
    pub fn new(cycles: Cycles, domain: &Domain, margin: f64, watch: &mut Watch) -> Result<Self, Unarranged> {
        let parent = parents(&cycles, domain, margin, watch)?;
        let Cycles { cycle_of, cycles, outer } = cycles;
        Ok(Self { cycle_of, cycles, outer, parent })
    }

    fn face_of_cycle(&self, cycle: usize) -> Face {
        let component = self.cycles[cycle].component;
        if self.outer[component] == cycle { self.parent[component] } else { Some(cycle) }
    }

    /// The face on the left of a directed edge.
    pub fn face(&self, edge: DirectedEdge) -> Face {
        self.face_of_cycle(self.cycle_of[edge.index()])
    }

    /// The components that lie in each face (by the index of its cycle); the last entry is the unbounded face.
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
    // If an outer cycle is visible from a component, both lie in the same face. Results are stored, so each component
    // is followed once.
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

/// Which cycles are visible from components along axis-parallel lines.
struct View<'a> {
    cycles: &'a Cycles,
    locator: Locator<'a>,
    margin: f64,
    /// By component.
    bounds: Vec<Rect>,
    /// By component, once it is known: the next cycle before the component's first crossing with some axis-parallel
    /// line. `Some(None)`: there is none.
    seen: Vec<Option<Option<usize>>>,
    /// By component: the number of the last line that met it.
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

    /// The lines to try through a component. If the component is only a few margins high, no horizontal line keeps
    /// clear of its ends, and vertical lines come first. Vertical lines may also be clear where no horizontal line is,
    /// as at the tip of two curves that separate slowly.
    fn lines_through(&self, component: usize) -> impl Iterator<Item = (Axis, f64)> + use<> {
        let bounds = self.bounds[component];
        let axes = [Axis::Horizontal, Axis::Vertical];
        let is_flat = bounds.height() <= 4.0 * self.margin;
        let in_order = axes.into_iter().cycle().skip(usize::from(is_flat)).take(axes.len());
        in_order.flat_map(move |axis| levels(bounds, axis).map(move |level| (axis, level)))
    }

    /// Determines the cycle visible from a component, if it is not known yet. The same line also settles the other
    /// components that it meets, so nested rings take a few lines altogether, not one each.
    fn look_from(&mut self, component: usize) -> Result<(), ArrangeError> {
        let bounds = self.bounds[component];
        for (axis, level) in self.lines_through(component) {
            let [low, high] = along(axis, bounds);
            let mut reach = 4.0 * extent(bounds);
            // The reach grows by a factor: most components have a neighbour nearby. The unit frame ends within a few
            // units.
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

    /// Two components may each be visible from the other, along lines at different levels. All components of such a
    /// ring lie in one face. The cycle next to the left of the leftmost of them on any line bounds the same face, so it
    /// becomes the visible cycle of each of them. This may close a further ring, with further components.
    ///
    /// ```text
    ///         ┌───┐     ┌───┐
    ///   ──────┼───┼─────┼───┼── 1      A is visible from B on line 1, B from A on line 2: a ring. Line 1 crosses A
    ///    ┌─┐  │ A │     │   │          first. Both now get what line 1 crosses before A: here nothing.
    ///   ─┼─┼──┼───┼─────┼───┼── 2
    ///    │ │  └───┘     │ B │
    ///    │ └────────────┘   │
    ///    └──────────────────┘
    /// ```
    fn part_rings(&mut self, watch: &mut Watch) -> Result<(), Unarranged> {
        // By component: the representative of the rings that it was part of.
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

    /// Rings of components: from each, the outer cycle of the next is visible.
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

    /// Sets the visible cycle of all components of a group: that before the first crossing of the group with a line
    /// through `component`. The line runs to the end of the frame.
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

    /// The cycle on the side of a crossing at larger coordinates.
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

    /// Notes the cycle that is visible from each component on a line, if it begins on the searched part of the line.
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

/// Levels across a box, spread evenly by the golden ratio, so that no regular pattern of vertices lies on all of them.
fn levels(bounds: Rect, axis: Axis) -> impl Iterator<Item = f64> {
    let (low, width) = match axis {
        Axis::Horizontal => (bounds.y0, bounds.height()),
        Axis::Vertical => (bounds.x0, bounds.width()),
    };
    (1..=LINES).map(move |k| low + width * (k as f64 * 0.618_033_988_749_894_9).fract())
}
