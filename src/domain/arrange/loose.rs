//! Free ends: which of them are joined, which outlines do not quite close, and which lines are open.
//!
//! A *free end* is a node at which a single edge ends; its *chain* leads from there to the next free end or branch.
//!
//! ```text
//!   a ────────────── b     b and c are each other's nearest free ends. They are joined at the corner of their lines
//!   │                c     where rounding of the last decimal explains the gap, or within `close`. Otherwise, if
//!   │                │     such gaps close chains into a ring and each gap is short compared with its chains, the
//!   └────────────────┘     drawing is refused (`rings`). All other free ends are those of open lines.
//! ```

use super::Loose;
use super::arrangement::Arrangement;
use super::ends::{FreeEnd, Gap, Joints, Owner, far_end, nearest_ends};
use super::error::ArrangeError;
use super::repair::RepairKind;
use super::rings::missed_rings;
use crate::geometry::Point;
use crate::ids::{CurveId, IdVec, PointId};
use std::collections::BTreeSet;

/// A gap is narrower than this part of the chains beside it. Otherwise the shorter chain is a stub and no side of a
/// gap.
const NARROW: f64 = 0.5;

/// Two lines form a corner where the sine of the angle between them is at least this.
const SQUARE: f64 = 0.1;

/// The corner of two lines lies within this many gap widths of their ends.
const FARTHER: f64 = 2.0;

/// The largest number of places that a note lists.
const LISTED: usize = 3;

impl Arrangement<'_> {
    /// Joins free ends that are each other's nearest, within the gaps that the tolerances allow. Returns whether there
    /// were any.
    ///
    /// **Termination.** Every round but the last joins two ends or more.
    pub fn join_free_ends(&mut self) -> bool {
        let ends = self.free_ends();
        let mut left: Vec<usize> = (0..ends.len()).collect();
        let mut joined = false;
        loop {
            let gaps = self.gaps_to_join(&ends, &left);
            if gaps.is_empty() {
                return self.reach_open_lines(&ends, &left) || joined;
            }
            let gone: BTreeSet<usize> = gaps.iter().flat_map(|gap| gap.ends).collect();
            left.retain(|i| !gone.contains(i));
            gaps.iter().for_each(|gap| self.join(&ends, gap));
            joined = true;
        }
    }

    fn gaps_to_join(&self, ends: &[FreeEnd], left: &[usize]) -> Vec<Gap> {
        let tolerances = &self.tolerances;
        let bound = tolerances.gap.max(tolerances.written).max(tolerances.close);
        if bound == 0.0 {
            return Vec::new();
        }
        let nearest = nearest_ends(ends, left, |_| bound);
        let mut partner: Vec<Option<usize>> = vec![None; ends.len()];
        nearest.iter().for_each(|gap| partner[gap.ends[0]] = Some(gap.ends[1]));
        let is_gap = |gap: &Gap| {
            let [i, j] = gap.ends;
            let is_mutual = i < j && partner[j] == Some(i);
            let units = gap.ends.map(|end| ends[end].last_decimal).into_iter().filter(|&unit| unit > 0.0);
            let written = 2.0 * units.reduce(f64::min).unwrap_or(0.0) + tolerances.rounding;
            let reach = tolerances.gap.max(written.min(tolerances.written)).max(tolerances.close);
            // A chain no longer than the gap beside it would be folded onto itself.
            is_mutual && gap.width <= reach && gap.width < NARROW * ends[i].chain.min(ends[j].chain)
        };
        nearest.into_iter().filter(is_gap).collect()
    }

    /// Moves ends that stop short of open lines onto them, up to the distance `close`. Returns whether there were any.
    fn reach_open_lines(&mut self, ends: &[FreeEnd], left: &[usize]) -> bool {
        let close = self.tolerances.close;
        let mut shorts = if close > 0.0 { self.shorts(ends, left, |_| close.next_up()) } else { Vec::new() };
        shorts.retain(|short| short.width < NARROW * ends[short.end].chain);
        for short in &shorts {
            let Owner::Node(node) = ends[short.end].owner else { continue };
            let [a, b] = [self.nodes[node].origin.text(self.drawing), self.text_of(short.onto)];
            let what = format!("a gap between the end of {a} and {b} was closed");
            self.repair(RepairKind::GapClosed, short.at, short.width, what);
            (self.nodes[node].at, self.nodes[node].fresh) = (short.at, true);
        }
        !shorts.is_empty()
    }

    /// Moves both ends of a gap to their [`meeting_place`].
    fn join(&mut self, ends: &[FreeEnd], gap: &Gap) {
        let [Owner::Node(kept), Owner::Node(moved)] = gap.ends.map(|end| ends[end].owner) else { return };
        let [a, b] = [kept, moved].map(|node| self.nodes[node].origin.text(self.drawing));
        let what = format!("a gap between the ends of {a} and {b} was closed");
        let at = meeting_place(gap.ends.map(|end| &ends[end]), gap.width);
        self.repair(RepairKind::GapClosed, at, gap.width, what);
        let origin = self.nodes[kept].origin;
        for node in [kept, moved] {
            (self.nodes[node].at, self.nodes[node].origin, self.nodes[node].fresh) = (at, origin, true);
        }
    }

    /// Refuses outlines that do not quite close. Keeps, drops or refuses open lines as `loose` says. Returns notes for
    /// the user.
    ///
    /// # Errors
    /// With the ends, the gaps, and the option that closes them.
    pub fn settle_loose_ends(&mut self, loose: Loose) -> Result<Vec<String>, ArrangeError> {
        let mut ends = self.free_ends();
        if ends.is_empty() {
            return Ok(Vec::new());
        }
        let own = ends.len();
        ends.extend(self.off_plane_ends());
        if matches!(loose, Loose::Auto | Loose::Error)
            && let Some(missed) = missed_rings(self, &ends)
        {
            return Err(missed);
        }
        let open = self.open_edges();
        let told = self.tell_open(&ends[..own], &open, loose);
        match loose {
            Loose::Error => Err(self.open_refused(&ends[..own])),
            Loose::Auto | Loose::Keep => Ok(vec![told]),
            Loose::Drop => {
                let edges = std::mem::take(&mut self.edges);
                self.edges = edges.enumerate().filter(|(id, _)| !open.contains(id)).map(|(_, p)| p.clone()).collect();
                self.renumber();
                Ok(vec![told])
            }
        }
    }

    /// Edges on ways to free ends; they bound nothing. They are found by pruning: an edge at a free end is taken off,
    /// and so on.
    ///
    /// ```text
    ///   ┌─────┐ 3    2    1        1 is at a free end. When it is taken off, 2 is, then 3. The square stays.
    ///   │     ├────●────●────
    ///   └─────┘
    /// ```
    fn open_edges(&self) -> BTreeSet<CurveId> {
        let joints = Joints::new(self);
        let mut degree: IdVec<PointId, usize> = self.nodes.ids().map(|node| joints.degree(node)).collect();
        let mut free: Vec<PointId> = self.nodes.ids().filter(|&node| joints.is_free(node)).collect();
        let mut open = BTreeSet::new();
        while let Some(node) = free.pop() {
            let Some(&edge) = joints.0[node].iter().find(|edge| !open.contains(*edge)) else { continue };
            open.insert(edge);
            let beyond = far_end(&self.edges[edge], node);
            degree[beyond] -= 1;
            if degree[beyond] == 1 {
                free.push(beyond);
            }
        }
        open
    }

    /// A note: how many lines are open, how long they are, and where they end.
    fn tell_open(&self, ends: &[FreeEnd], open: &BTreeSet<CurveId>, loose: Loose) -> String {
        let drawn: BTreeSet<u32> = open.iter().map(|&id| self.edges[id].source).collect();
        let length: f64 = open.iter().map(|&id| self.edges[id].curve.length()).sum();
        let listed = ends.iter().take(LISTED).map(|end| self.place(end)).collect::<Vec<_>>().join(", ");
        let more = if ends.len() > LISTED { ", …" } else { "" };
        let lines = if drawn.len() == 1 { "1 line is open".into() } else { format!("{} lines are open", drawn.len()) };
        let fate = match loose {
            Loose::Drop => "were left out",
            Loose::Auto | Loose::Keep | Loose::Error => {
                "are mesh edges where they lie in a region (--loose drop leaves them out)"
            }
        };
        let length = self.tolerances.told(length);
        format!("{lines}: {length} in all, which bounds nothing, with ends at {listed}{more}; they {fate}.")
    }

    fn open_refused(&self, ends: &[FreeEnd]) -> ArrangeError {
        let first = &ends[0];
        let others = ends[1..].iter().map(|end| end.at.distance(first.at)).reduce(f64::min);
        let nearest = others.map_or_else(String::new, |gap| {
            format!("; the nearest other free end is {} away", self.tolerances.told(gap))
        });
        let what = format!("{} ends freely{nearest}", self.entity_of(first));
        ArrangeError::new(what, first.at, "close the outline, or mesh with open lines by --loose keep")
    }
}

/// Where two free ends are joined: at the corner of their lines if it is near, so that neither line turns; else at the
/// first end.
///
/// ```text
///   ────────── a · · · corner       a, b: the free ends, with the directions of their lines. `width` is their
///                      ·            distance.
///                      b
///                      │
/// ```
fn meeting_place([a, b]: [&FreeEnd; 2], width: f64) -> Point {
    let sine = a.direction.cross(b.direction);
    if sine.abs() < SQUARE {
        return a.at;
    }
    let corner = a.at + a.direction * ((b.at - a.at).cross(b.direction) / sine);
    let is_near = [a, b].iter().all(|end| end.at.distance(corner) <= FARTHER * width);
    if is_near { corner } else { a.at }
}
