//! Which faces are inside: by their winding numbers, or by the shapes of a picture that paint them.

use super::FillRule;
use super::arrangement::Arrangement;
use super::faces::{Face, Faces};
use super::paint::painted;
use super::trace::DirectedEdge;
use crate::domain::Domain;
use crate::domain::locate::Side;
use crate::ids::{CurveId, Id, IdVec, NameId, PointId};
use std::collections::{BTreeMap, BTreeSet};

/// The result of the fill rule for every face, by the index of the cycle around it.
pub(super) struct Fill {
    /// Whether the face is bounded and inside.
    pub inside: Vec<bool>,
    /// The name by the shapes that fill the face: that of the topmost one or, with `fragments`, those of all.
    pub painted: Vec<Option<NameId>>,
}

impl Fill {
    /// Applies a fill rule to the faces of a domain, and adds its notes and the names of fragments to the domain.
    pub fn new(arrangement: &Arrangement, domain: &mut Domain, faces: &Faces, rule: FillRule, fragments: bool) -> Self {
        let is_bounded = |cycle: usize| faces.outer[faces.cycles[cycle].component] != cycle;
        let painted = painted(arrangement, faces, &mut domain.names, fragments);
        let inside: Vec<bool> = match rule {
            FillRule::Regions => vec![true; faces.cycles.len()],
            FillRule::Shapes => painted.iter().map(Option::is_some).collect(),
            FillRule::NonZero | FillRule::EvenOdd => {
                let winding = windings(arrangement, domain, faces, rule);
                winding.into_iter().map(|w| is_inside(rule, w)).collect()
            }
            FillRule::EvenOddAndShapes => {
                let winding = windings(arrangement, domain, faces, rule);
                winding.into_iter().zip(&painted).map(|(w, paint)| is_inside(rule, w) || paint.is_some()).collect()
            }
        };
        let inside = inside.into_iter().enumerate().map(|(cycle, inside)| inside && is_bounded(cycle)).collect();
        Self { inside, painted }
    }
}

/// The winding number of every face (by the index of the cycle around it); 0 for the unbounded face.
struct Windings<'a> {
    faces: &'a Faces,
    domain: &'a Domain,
    rule: FillRule,
    /// The multiplicity of each curve: signed by direction, or by the odd-even rule without a sign; 0 for open lines,
    /// and where the same face lies on both sides.
    weight: Vec<i32>,
    winding: Vec<Option<i32>>,
    /// Curves that count once, however many drawn curves run along them.
    once: Vec<bool>,
}

/// How the multiplicity of an edge follows from the drawn curves along it.
enum Count {
    Once,
    /// As often as it is drawn, divided by how many times the whole component is drawn.
    Copies {
        divided_by: i32,
    },
}

fn is_inside(rule: FillRule, winding: i32) -> bool {
    match rule {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd | FillRule::EvenOddAndShapes => winding % 2 != 0,
        FillRule::Regions | FillRule::Shapes => true,
    }
}

/// Whether a fill rule reads only the parity of winding numbers.
pub(super) fn by_parity(rule: FillRule) -> bool {
    match rule {
        FillRule::EvenOdd | FillRule::EvenOddAndShapes => true,
        FillRule::NonZero | FillRule::Regions | FillRule::Shapes => false,
    }
}

impl Windings<'_> {
    fn of(&self, face: Face) -> i32 {
        face.map_or(0, |f| self.winding[f].unwrap_or(0))
    }

    /// Computes the winding numbers of all faces, outer components first.
    fn settle(&mut self, counted: &[bool]) {
        let faces = self.faces;
        let mut inside = faces.components_by_face();
        let mut queue = inside.pop().unwrap_or_default();
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
        let sides = bounded.iter().chain([&outer]).flat_map(|&cycle| &self.faces.cycles[cycle].edges);
        let closed = bounded.is_empty() || sides.clone().any(|directed| counted[directed.curve.index()]);
        if !closed {
            // The component has only open curves, which enclose faces because they cross. These faces are inside: with
            // the winding number around them if that is inside, else with one more.
            let within = if is_inside(self.rule, around) { around } else { around + 1 };
            bounded.iter().for_each(|&face| self.winding[face] = Some(within));
            return;
        }
        let curves: Vec<CurveId> =
            sides.filter(|directed| directed.side == Side::Left).map(|directed| directed.curve).collect();
        match self.counts(&curves).into_iter().find(|count| self.is_balanced(&curves, count)) {
            Some(count) => {
                if matches!(count, Count::Once) {
                    curves.iter().for_each(|id| self.once[id.index()] = true);
                }
                self.spread(outer, around, &count);
            }
            None => bounded.iter().for_each(|&face| self.winding[face] = Some(around + 1)),
        }
    }

    /// The ways to count the curves of a component, in the order in which they are tried. The first that is balanced at
    /// every point is used.
    ///
    /// By the odd-even rule, a stretch that is drawn several times is one contour and counts once. If that leaves an
    /// odd number of curves at some point, contours with a common wall were each drawn whole (two rooms). Then every
    /// copy counts; if everything is drawn an even number of times, the count is halved.
    ///
    /// ```text
    ///   ╭─────┬─────╮      Two rooms, each drawn whole: the wall is drawn twice. Counted once, three curves would end
    ///   │  1  ║  1  │      at each end of the wall, and no winding number would fit. Counted twice, both rooms are
    ///   ╰─────┴─────╯      inside.
    /// ```
    fn counts(&self, curves: &[CurveId]) -> Vec<Count> {
        if !by_parity(self.rule) {
            return vec![Count::Copies { divided_by: 1 }];
        }
        let common = curves.iter().map(|id| self.weight[id.index()].unsigned_abs()).fold(0, |a, b| a | b);
        vec![Count::Once, Count::Copies { divided_by: 1 << common.trailing_zeros().min(30) }]
    }

    fn weight(&self, id: CurveId, count: &Count) -> i32 {
        let weight = self.weight[id.index()];
        match count {
            Count::Once => weight.signum(),
            Count::Copies { divided_by } => weight / divided_by,
        }
    }

    /// Whether at every point as many curves arrive as leave (by the odd-even rule: their number is even). Only then is
    /// the winding number of a face the same along every way to it.
    fn is_balanced(&self, curves: &[CurveId], count: &Count) -> bool {
        let mut flow: Vec<(PointId, i32)> = Vec::new();
        for &id in curves {
            let weight = self.weight(id, count);
            let ends = self.domain.curves[id].ends;
            flow.extend([(ends[0], weight), (ends[1], -weight)]);
        }
        flow.sort_unstable();
        flow.chunk_by(|a, b| a.0 == b.0).all(|chunk| {
            let net: i32 = chunk.iter().map(|f| f.1).sum();
            if by_parity(self.rule) { net % 2 == 0 } else { net == 0 }
        })
    }

    /// Computes the winding numbers of a component's faces, from the face around it across one curve after another.
    ///
    /// ```text
    ///                      ▲
    ///     winding + weight │ winding       The winding number on the left of a curve is greater by the curve's weight.
    ///                      │
    /// ```
    fn spread(&mut self, outer: usize, around: i32, count: &Count) {
        let mut stack = vec![(outer, around)];
        while let Some((cycle, winding)) = stack.pop() {
            for &directed in &self.faces.cycles[cycle].edges {
                let beyond = self.faces.cycle_of[directed.twin().index()];
                if beyond == outer || beyond == cycle || self.winding[beyond].is_some() {
                    continue;
                }
                let weight = self.weight(directed.curve, count);
                // The winding number on the left of a curve is greater by its weight than that on its right.
                let there = if directed.side == Side::Left { winding - weight } else { winding + weight };
                self.winding[beyond] = Some(there);
                stack.push((beyond, there));
            }
        }
    }
}

/// By drawn curve: whether it is part of a closed outline. A curve at a free end is not, nor a curve whose end becomes
/// free without it. An end is not free where another curve carries on: an outline that is drawn twice in part. Outlines
/// of shapes are closed, and close no others.
pub(super) fn closed_outlines(arrangement: &Arrangement) -> Vec<bool> {
    let is_line = |i: usize| arrangement.drawing.curves[i].shape.is_none();
    let mut ends: Vec<Vec<PointId>> =
        arrangement.drawn_ends.iter().map(|ends| ends.iter().flatten().copied().collect()).collect();
    let mut closed: Vec<bool> = arrangement.drawn_ends.iter().map(Option::is_some).collect();
    for (end, others) in carried_on(arrangement) {
        others.into_iter().for_each(|other| ends[other].push(end));
    }
    let mut at: IdVec<PointId, Vec<usize>> = vec![Vec::new(); arrangement.nodes.len()].into();
    for (i, ends) in ends.iter().enumerate().filter(|&(i, _)| is_line(i)) {
        ends.iter().for_each(|&end| at[end].push(i));
    }
    let mut degree: IdVec<PointId, usize> = at.iter().map(Vec::len).collect();
    let mut free: Vec<PointId> = degree.enumerate().filter(|&(_, &d)| d == 1).map(|(id, _)| id).collect();
    while let Some(end) = free.pop() {
        let Some(&gone) = at[end].iter().find(|&&i| closed[i]) else { continue };
        closed[gone] = false;
        for &other in &ends[gone] {
            degree[other] -= 1;
            if degree[other] == 1 {
                free.push(other);
            }
        }
    }
    closed
}

/// Ends of a drawn curve a that lie within another curve b which in turn ends within a, by node, with all such b. A
/// curve that lies within another with both its ends copies a part of it, and is not carried on by it.
///
/// ```text
///   ──────── a ────────●               a ends within b, and b ends within a: where one ends, the other carries on.
///              ●──────── b ────────
/// ```
fn carried_on(arrangement: &Arrangement) -> BTreeMap<PointId, BTreeSet<usize>> {
    let ends_at =
        |source: usize, node: PointId| arrangement.drawn_ends[source].iter().flatten().any(|&end| end == node);
    // By the curve a that ends and the curve b that passes: the nodes where that is so.
    let mut ending: BTreeMap<(usize, usize), BTreeSet<PointId>> = BTreeMap::new();
    let overlaps = arrangement.edges.enumerate().filter(|(_, edge)| !edge.merged.is_empty());
    for (id, edge) in overlaps {
        let along: BTreeSet<usize> = arrangement.drawn_along(id).map(|(source, _)| source as usize).collect();
        for node in edge.ends {
            let (here, passing): (Vec<usize>, Vec<usize>) = along.iter().partition(|&&source| ends_at(source, node));
            for (a, b) in here.into_iter().flat_map(|a| passing.iter().map(move |&b| (a, b))) {
                ending.entry((a, b)).or_default().insert(node);
            }
        }
    }
    let mut carried: BTreeMap<PointId, BTreeSet<usize>> = BTreeMap::new();
    for (&(_, b), nodes) in ending.iter().filter(|&(&(a, b), _)| ending.contains_key(&(b, a))) {
        for &node in nodes {
            carried.entry(node).or_default().insert(b);
        }
    }
    carried
}

fn windings(arrangement: &Arrangement, domain: &mut Domain, faces: &Faces, rule: FillRule) -> Vec<i32> {
    let closed = closed_outlines(arrangement);
    let same_face = |id: CurveId| {
        let [left, right] =
            [Side::Left, Side::Right].map(|side| faces.cycle_of[DirectedEdge { curve: id, side }.index()]);
        left == right
    };
    let drawn = |id: CurveId| arrangement.drawn_along(id);
    // Outlines of shapes bound only what they fill, and do not change the parity around them.
    let of_shapes =
        |source: u32| rule == FillRule::EvenOddAndShapes && arrangement.drawing.curves[source as usize].shape.is_some();
    let count = |(source, against): (u32, bool)| match closed[source as usize] && !of_shapes(source) {
        false => 0,
        true if against && rule == FillRule::NonZero => -1,
        true => 1,
    };
    let weight = domain.curves.ids().map(|id| if same_face(id) { 0 } else { drawn(id).map(count).sum() });
    let counted: Vec<bool> = (domain.curves.ids())
        .map(|id| !same_face(id) && drawn(id).any(|(source, _)| closed[source as usize]))
        .collect();
    let (winding, once) = (vec![None; faces.cycles.len()], vec![false; domain.curves.len()]);
    let mut windings = Windings { faces, domain, rule, weight: weight.collect(), winding, once };
    windings.settle(&counted);
    let Windings { winding, once, .. } = windings;
    let once = domain.curves.ids().filter(|id| once[id.index()]);
    let copies: BTreeSet<u32> = once
        .flat_map(|id| arrangement.edges[id].merged.iter().map(|&(source, _)| source))
        .filter(|&s| !of_shapes(s))
        .collect();
    domain.notes.extend(tell_copies(copies.len()));
    winding.into_iter().map(|w| w.unwrap_or(0)).collect()
}

/// The note on how many curves are drawn over others.
fn tell_copies(count: usize) -> Option<String> {
    let curves = match count {
        0 => return None,
        1 => "1 curve is".into(),
        _ => format!("{count} curves are"),
    };
    Some(format!("{curves} drawn twice, in whole or in part: what lies over another curve is a copy, and counts once."))
}
