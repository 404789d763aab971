//! Cycles of curve sides, and the components that they go around.
//!
//! ```text
//!    q ◀───────── p        A side is a curve travelled in one of its two directions, with a face on its left. The side p → q goes on with
//!    │╲  face              the first curve clockwise of it in the star of q: b, not a.
//!  a │  ╲ b
//!    │    ╲
//! ```

use crate::domain::Domain;
use crate::domain::locate::{Side, left_of};
use crate::ids::{CurveId, Id, IdVec, PointId};
use crate::watch::{Progress, Stopped, Watch};

/// A curve side: the curve travelled forward has its face on the left, travelled backward the one on its right.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct DirectedEdge {
    pub curve: CurveId,
    pub side: Side,
}

impl DirectedEdge {
    pub fn index(self) -> usize {
        2 * self.curve.index() + self.side.index()
    }

    pub fn twin(self) -> Self {
        DirectedEdge { side: self.side.other(), ..self }
    }

    /// The point from which this side is travelled.
    pub fn tail(self, domain: &Domain) -> PointId {
        let [start, end] = domain.curves[self.curve].ends;
        match self.side {
            Side::Left => start,
            Side::Right => end,
        }
    }
}

/// Sides one after the other, each with the same face on its left.
pub(super) struct Cycle {
    pub edges: Vec<DirectedEdge>,
    /// The signed area that it goes around: negative where the face lies outside of it.
    pub area: f64,
    /// What it is connected with.
    pub component: usize,
}

/// The cycles of all sides, and their components.
pub(super) struct Cycles {
    /// By [`DirectedEdge::index`].
    pub cycle_of: Vec<usize>,
    pub cycles: Vec<Cycle>,
    /// By component: the cycle that sees the component from outside.
    pub outer: Vec<usize>,
}

impl Cycles {
    /// Traces the cycles of a domain whose points, curves and stars stand.
    pub fn trace(domain: &Domain, watch: &mut Watch) -> Result<Self, Stopped> {
        let component_of = components(domain);
        let (cycle_of, cycles) = cycles(domain, &component_of, watch)?;
        let count = cycles.iter().map(|c| c.component + 1).max().unwrap_or(0);
        let mut outer: Vec<Option<usize>> = vec![None; count];
        for (i, cycle) in cycles.iter().enumerate() {
            // The signed areas of a component's cycles add up to nothing, and the one around it is the only negative
            // one.
            let best = &mut outer[cycle.component];
            if best.is_none_or(|b| cycle.area < cycles[b].area) {
                *best = Some(i);
            }
        }
        Ok(Self { cycle_of, cycles, outer: outer.into_iter().flatten().collect() })
    }

    /// Whether a cycle is what is seen of its component from outside.
    pub fn is_outer(&self, cycle: usize) -> bool {
        self.outer[self.cycles[cycle].component] == cycle
    }

    /// The cycle of a side.
    pub fn of(&self, edge: DirectedEdge) -> &Cycle {
        &self.cycles[self.cycle_of[edge.index()]]
    }
}

pub(super) fn tracing(domain: &Domain, queued: usize) -> Progress {
    Progress { phase: "tracing", vertices: domain.points.len(), queued }
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

/// The cycle of every side, and the cycles.
fn cycles(
    domain: &Domain,
    component_of: &IdVec<PointId, usize>,
    watch: &mut Watch,
) -> Result<(Vec<usize>, Vec<Cycle>), Stopped> {
    // Where each side's tail stands in the star of its point.
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

/// The signed area that a cycle goes around, by Green about one of its points; summed with Neumaier's compensation.
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
