//! Which shapes of a picture paint each face, and the names that result.

use super::arrangement::{Arrangement, Seen};
use super::faces::{Face, Faces};
use super::trace::DirectedEdge;
use crate::domain::Drawing;
use crate::domain::locate::Side;
use crate::geometry::extent;
use crate::ids::{ClipId, CurveId, IdVec, NameId, Names, SeenId, ShapeId};
use std::collections::{BTreeMap, BTreeSet};

/// The winding number of each shape around one face, and the shapes that fill it. It is stored for one face at a time,
/// and updated where a tour of all faces crosses a curve. So shapes nested a thousand deep cost no more than their
/// curves.
struct Paint<'a> {
    drawing: &'a Drawing,
    winding: BTreeMap<ShapeId, i32>,
    /// The painted shapes that fill the face, whether clipped or not.
    filled: BTreeSet<ShapeId>,
    /// By clip: those of its parts that fill the face.
    open: BTreeMap<ClipId, BTreeSet<ShapeId>>,
}

impl<'a> Paint<'a> {
    /// The paint of the unbounded face: none.
    fn nothing(drawing: &'a Drawing) -> Self {
        Self { drawing, winding: BTreeMap::new(), filled: BTreeSet::new(), open: BTreeMap::new() }
    }

    /// Whether the face lies in a clip and in all clips around that one.
    fn lies_in(&self, clip: Option<ClipId>) -> bool {
        let shapes = &self.drawing.shapes;
        let mut chain = std::iter::successors(clip, |&clip| self.drawing.clips[clip].within);
        chain.all(|clip| self.open.get(&clip).is_some_and(|parts| parts.iter().any(|&p| self.lies_in(shapes[p].clip))))
    }

    /// The shapes that fill the face and are not clipped there, the topmost first.
    fn seen(&self) -> impl Iterator<Item = ShapeId> {
        self.filled.iter().rev().copied().filter(|&shape| self.lies_in(self.drawing.shapes[shape].clip))
    }

    fn add(&mut self, shape: ShapeId, turns: i32) {
        let winding = self.winding.entry(shape).or_insert(0);
        *winding += turns;
        let fills = if self.drawing.shapes[shape].even_odd { *winding % 2 != 0 } else { *winding != 0 };
        let of_its_kind = match self.drawing.shapes[shape].part_of {
            None => &mut self.filled,
            Some(clip) => self.open.entry(clip).or_default(),
        };
        if fills {
            of_its_kind.insert(shape);
        } else {
            of_its_kind.remove(&shape);
        }
        if *winding == 0 {
            self.winding.remove(&shape);
        }
    }

    /// Updates the paint from the face on the left of `half` to the face across its curve.
    fn cross(&mut self, directed: DirectedEdge, arrangement: &Arrangement) {
        for (source, against) in arrangement.drawn_along(directed.curve) {
            if let Some(shape) = arrangement.drawing.curves[source as usize].shape {
                // The winding number on the left of a curve is greater by one than that on its right.
                let leaves_left = (directed.side == Side::Left) != against;
                self.add(shape, if leaves_left { -1 } else { 1 });
            }
        }
    }
}

/// The name of a fragment lists at most this many names of shapes, in about this many bytes: the topmost ones.
const LISTED_MAX: usize = 8;

const LISTED_BYTES: usize = 120;

/// The largest number of shapes read for one name: many shapes may have the same name.
const LOOKED_AT: usize = 64;

/// Names for the sets of shapes that fill faces.
struct FragmentNames<'a> {
    names: &'a mut Names,
    /// By the listed names and the number of further shapes below.
    known: BTreeMap<(Vec<NameId>, usize), NameId>,
}

impl FragmentNames<'_> {
    /// The names of the shapes, each once, the topmost first, joined by `+`; `+9 more` where further shapes lie below.
    fn of(&mut self, drawing: &Drawing, seen: &[ShapeId]) -> Option<NameId> {
        let (mut listed, mut passed, mut bytes): (Vec<NameId>, usize, usize) = (Vec::new(), 0, 0);
        for &shape in seen.iter().take(LOOKED_AT) {
            let name = drawing.shapes[shape].name;
            if !listed.contains(&name) {
                bytes += self.names.text(name).len() + 1;
                if listed.len() == LISTED_MAX || !listed.is_empty() && bytes > LISTED_BYTES {
                    break;
                }
                listed.push(name);
            }
            passed += 1;
        }
        let key = (listed, seen.len() - passed);
        if let (&[alone], 0) = (&key.0[..], key.1) {
            return Some(alone);
        }
        if key.0.is_empty() {
            return None;
        }
        if let Some(&known) = self.known.get(&key) {
            return Some(known);
        }
        let texts: Vec<&str> = key.0.iter().map(|&name| self.names.text(name)).collect();
        let more = if key.1 > 0 { format!("+{} more", key.1) } else { String::new() };
        let text = texts.join("+") + &more;
        // A shape may already have this name.
        let others = (2..).map(|k| format!("{text}#{k}"));
        let free = std::iter::once(text.clone()).chain(others).find(|text| self.names.find(text).is_none());
        let name = self.names.intern(&free.unwrap_or(text));
        self.known.insert(key, name);
        Some(name)
    }
}

/// The name of each face by the shapes that are visible on it: the topmost one or, with `fragments`, all.
pub(super) fn painted(
    arrangement: &Arrangement,
    faces: &Faces,
    names: &mut Names,
    fragments: bool,
) -> Vec<Option<NameId>> {
    let looked_at;
    let (seen, painters) = if arrangement.edges.iter().any(|edge| edge.paint.is_some()) {
        (&arrangement.seen, painters_beside(arrangement, faces))
    } else {
        let (seen, painters) = painters(arrangement, faces, fragments);
        looked_at = seen;
        (&looked_at, painters)
    };
    let mut fragment_names = FragmentNames { names, known: BTreeMap::new() };
    let mut name = |list: &Vec<ShapeId>| match fragments {
        true => fragment_names.of(arrangement.drawing, list),
        false => Some(arrangement.drawing.shapes[list[0]].name),
    };
    let named: IdVec<SeenId, Option<NameId>> = seen.lists.iter().map(&mut name).collect();
    painters.into_iter().map(|painter| painter.and_then(|id| named[id])).collect()
}

/// The topmost shape on each face, or all shapes on it. All outlines must still be edges.
pub(super) fn painters(arrangement: &Arrangement, faces: &Faces, all: bool) -> (Seen, Vec<Option<SeenId>>) {
    let mut seen = Seen::default();
    let most = if all { usize::MAX } else { 1 };
    let painters = by_paint(arrangement, faces, |_, paint| seen.id(paint.seen().take(most).collect()));
    (seen, painters)
}

/// By edge: whether a curve that belongs to no shape runs along it and is not clipped there. All outlines must still be
/// edges.
pub(super) fn lines_in_clips(arrangement: &Arrangement, faces: &Faces) -> IdVec<CurveId, bool> {
    let lines = |id: CurveId| {
        let drawn = arrangement.drawn_along(id).map(|(source, _)| &arrangement.drawing.curves[source as usize]);
        drawn.filter(|drawn| drawn.shape.is_none()).map(|drawn| drawn.clip)
    };
    let mut kept: IdVec<CurveId, bool> =
        arrangement.edges.ids().map(|id| lines(id).any(|clip| clip.is_none())).collect();
    if !arrangement.drawing.clips.is_empty() {
        by_paint(arrangement, faces, |cycles, paint| {
            for directed in cycles.iter().flat_map(|&cycle| &faces.cycles[cycle].edges) {
                kept[directed.curve] |= lines(directed.curve).any(|clip| paint.lies_in(clip));
            }
            None::<()>
        });
    }
    kept
}

/// The visible shapes of each face, as noted on the edges around it. The notes agree, except where a tolerance moved
/// one edge over another: then the greatest length of border decides.
fn painters_beside(arrangement: &Arrangement, faces: &Faces) -> Vec<Option<SeenId>> {
    let mut votes: Vec<BTreeMap<Option<SeenId>, f64>> = vec![BTreeMap::new(); faces.cycles.len()];
    for (id, edge) in arrangement.edges.enumerate() {
        let Some(paint) = edge.paint else { continue };
        for (side, seen) in [Side::Left, Side::Right].into_iter().zip(paint) {
            if let Some(face) = faces.face(DirectedEdge { curve: id, side }) {
                *votes[face].entry(seen).or_default() += extent(edge.bounds);
            }
        }
    }
    let most = |votes: BTreeMap<Option<SeenId>, f64>| votes.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    votes.into_iter().map(|votes| most(votes).and_then(|(seen, _)| seen)).collect()
}

/// The result of `of` for every bounded face. It is called with the cycles that bound the face and the face's paint.
///
/// ```text
///    ╭──── A ────────╮       A tour of the faces, by crossing edges and returning. From the unbounded face 1 into 2: A
///    │ 2  ╭── B ──╮  │   1   is added. Into 3: B is added. Back into 2: B is taken off. Back into 1: A is taken off.
///    │    │   3   │  │
///    │    ╰───────╯  │
///    ╰───────────────╯
/// ```
fn by_paint<T>(
    arrangement: &Arrangement,
    faces: &Faces,
    mut of: impl FnMut(&[usize], &Paint) -> Option<T>,
) -> Vec<Option<T>> {
    enum Step {
        Cross(DirectedEdge),
        Return(DirectedEdge),
    }
    let mut said: Vec<Option<T>> = faces.cycles.iter().map(|_| None).collect();
    if arrangement.drawing.shapes.is_empty() {
        return said;
    }
    let holds = faces.components_by_face();
    let cycles = |face: Face| {
        let around = holds[face.unwrap_or(faces.cycles.len())].iter().map(|&component| faces.outer[component]);
        face.into_iter().chain(around)
    };
    let sides = |face: Face| cycles(face).flat_map(|cycle| faces.cycles[cycle].edges.iter().copied());
    let mut seen = vec![false; faces.cycles.len()];
    let mut paint = Paint::nothing(arrangement.drawing);
    let mut steps: Vec<Step> = sides(None).map(Step::Cross).collect();
    while let Some(step) = steps.pop() {
        match step {
            Step::Return(directed) => paint.cross(directed.twin(), arrangement),
            Step::Cross(directed) => {
                let Some(face) = faces.face(directed.twin()).filter(|&face| !seen[face]) else { continue };
                seen[face] = true;
                paint.cross(directed, arrangement);
                said[face] = of(&cycles(Some(face)).collect::<Vec<usize>>(), &paint);
                steps.push(Step::Return(directed));
                steps.extend(sides(Some(face)).map(Step::Cross));
            }
        }
    }
    said
}
