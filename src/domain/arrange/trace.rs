//! Cycles of directed edges, and the components that they go around.
//!
//! ```text
//!    q ◀───────── p      A directed edge is a curve travelled in one of its two directions, with a face on its left.
//!    │╲  face            Its cycle goes on with the next curve clockwise in the star of q: after p → q comes b, not a.
//!  a │  ╲ b
//!    │    ╲
//! ```

use crate::domain::Domain;
use crate::domain::locate::{Side, left_of};
use crate::ids::{CurveId, Id, IdVec, PointId};
use crate::watch::{Progress, Stopped, Watch};

/// A curve travelled in one of its directions: forward with the face on the curve's left, backward with the face on its
/// right. In both cases the face lies on the left of the travel.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct DirectedEdge {
    /// The curve.
    pub curve: CurveId,
    /// The side of the curve on which the face lies: left of it where it is travelled forward.
    pub side: Side,
}

impl DirectedEdge {
    /// A number below twice the number of curves, for tables by directed edge.
    pub fn index(self) -> usize {
        2 * self.curve.index() + self.side.index()
    }

    /// The same curve travelled the other way.
    pub fn twin(self) -> Self {
        DirectedEdge { side: self.side.other(), ..self }
    }

    /// The point at which it begins.
    pub fn tail(self, domain: &Domain) -> PointId {
        let [start, end] = domain.curves[self.curve].ends;
        match self.side {
            Side::Left => start,
            Side::Right => end,
        }
    }
}

/// A closed sequence of directed edges with the same face on their left.
pub(super) struct Cycle {
    /// In the order of travel.
    pub edges: Vec<DirectedEdge>,
    /// The signed area that it encloses: negative where the face lies outside of the cycle.
    pub area: f64,
    /// The connected component of its curves.
    pub component: usize,
}

/// The cycles of all directed edges, and their components.
pub(super) struct Cycles {
    /// By [`DirectedEdge::index`].
    pub cycle_of: Vec<usize>,
    /// The cycles, in the order of their first curves.
    pub cycles: Vec<Cycle>,
    /// By component: its outer cycle, which has the face around the component on its left.
    pub outer: Vec<usize>,
}

impl Cycles {
    /// Traces the cycles of a domain whose points, curves and stars are complete.
    pub fn trace(domain: &Domain, watch: &mut Watch) -> Result<Self, Stopped> {
        let component_of = components(domain);
        let (cycle_of, cycles) = cycles(domain, &component_of, watch)?;
        let count = cycles.iter().map(|c| c.component + 1).max().unwrap_or(0);
        let mut outer: Vec<Option<usize>> = vec![None; count];
        for (i, cycle) in cycles.iter().enumerate() {
            // The signed areas of a component's cycles add up to 0, and only that of the outer cycle is negative.
            let best = &mut outer[cycle.component];
            if best.is_none_or(|b| cycle.area < cycles[b].area) {
                *best = Some(i);
            }
        }
        Ok(Self { cycle_of, cycles, outer: outer.into_iter().flatten().collect() })
    }

    /// Whether a cycle is the outer one of its component.
    pub fn is_outer(&self, cycle: usize) -> bool {
        self.outer[self.cycles[cycle].component] == cycle
    }

    /// The cycle of a directed edge.
    pub fn of(&self, edge: DirectedEdge) -> &Cycle {
        &self.cycles[self.cycle_of[edge.index()]]
    }
}

/// The progress of tracing, with `queued` steps left.
pub(super) fn tracing(domain: &Domain, queued: usize) -> Progress {
    Progress { phase: "tracing", vertices: domain.points.len(), queued }
}

/// The connected component of every point. Components are numbered in the order of their first curves.
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

/// The cycle of every directed edge, and the cycles.
fn cycles(
    domain: &Domain,
    component_of: &IdVec<PointId, usize>,
    watch: &mut Watch,
) -> Result<(Vec<usize>, Vec<Cycle>), Stopped> {
    // The place of each directed edge in the star of its tail.
    let mut place = vec![0; 2 * domain.curves.len()];
    for star in domain.stars.iter() {
        for (k, &i) in star.iter().enumerate() {
            place[DirectedEdge { curve: i.curve, side: left_of(i) }.index()] = k;
        }
    }
    let next = |edge: DirectedEdge| {
        let twin = edge.twin();
        let star = domain.star(twin.tail(domain));
        let before = star[(place[twin.index()] + star.len() - 1) % star.len()];
        DirectedEdge { curve: before.curve, side: left_of(before) }
    };
    let mut cycle_of = vec![usize::MAX; 2 * domain.curves.len()];
    let mut cycles = Vec::new();
    let sides =
        domain.curves.ids().flat_map(|curve| [Side::Left, Side::Right].map(|side| DirectedEdge { curve, side }));
    for first in sides {
        tracing(domain, domain.curves.len() - first.curve.index()).tell(watch)?;
        let mut edges = Vec::new();
        let mut edge = first;
        while cycle_of[edge.index()] == usize::MAX {
            cycle_of[edge.index()] = cycles.len();
            edges.push(edge);
            edge = next(edge);
        }
        if !edges.is_empty() {
            let component = component_of[first.tail(domain)];
            cycles.push(Cycle { area: area(domain, &edges), edges, component });
        }
    }
    Ok((cycle_of, cycles))
}

/// The signed area that a cycle encloses, by Green's theorem about one of its points; summed with Neumaier's
/// compensation.
fn area(domain: &Domain, edges: &[DirectedEdge]) -> f64 {
    let Some(&first) = edges.first() else { return 0.0 };
    let origin = domain.points[first.tail(domain)];
    let (mut sum, mut lost) = (0.0f64, 0.0);
    for edge in edges {
        let forward = domain.curves[edge.curve].curve.signed_area(origin);
        let term = if edge.side == Side::Left { forward } else { -forward };
        let next = sum + term;
        lost += if sum.abs() >= term.abs() { (sum - next) + term } else { (term - next) + sum };
        sum = next;
    }
    sum + lost
}
