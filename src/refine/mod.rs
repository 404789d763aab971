//! Refinement in any dimension: the loop that drives an engine, the worst-first queue, the test for progress, the
//! counters, and the reason to stop.
//!
//! ```text
//!   drive:  ┌─▶ is `until` reached? ──────────────────── yes ──▶ cancel, finish
//!           │   every 64 steps: does the watch say stop? yes ──▶ cancel; steps for a valid mesh go on
//!           │   step() ───────────────────────────────── false ─▶ finish
//!           └─────┘ true
//! ```

use crate::geometry::Point;
use crate::watch::{Progress, Watch};
use std::collections::{BTreeMap, VecDeque};

/// A refinement that can be stopped between any two steps.
pub trait Engine {
    /// The result.
    type Outcome;

    /// Takes the next step. `false`: there is none left, or the run is over.
    fn step(&mut self) -> bool;

    /// Ends the refinement. What is needed for a valid mesh is still done.
    fn cancel(&mut self);

    /// Phase, number of vertices, and number of queued steps.
    fn progress(&self) -> Progress;

    /// Ends the run and returns its result. It may be called after any step.
    fn finish(self) -> Self::Outcome;
}

/// The phase of an engine that has no valid mesh yet.
pub const CONFORMING: &str = "conforming";

/// How far an engine is driven.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Until {
    /// Until no step is left, or the watch says stop.
    End,
    /// Until there is a valid mesh, the one from which refinement starts.
    Conforming,
    /// This number of steps.
    Steps(u64),
}

/// Takes steps of an engine until `until` is reached, or `watch` says to stop.
pub fn drive<E: Engine>(mut engine: E, until: Until, watch: &mut Watch) -> E::Outcome {
    /// Steps between two calls of the watch. A step takes microseconds on lines, milliseconds on curves of high degree.
    const STEPS: u64 = 64;
    let mut steps = 0u64;
    loop {
        let is_there = match until {
            Until::End => false,
            Until::Conforming => engine.progress().phase != CONFORMING,
            Until::Steps(most) => steps >= most,
        };
        if is_there {
            engine.cancel();
            return engine.finish();
        }
        if steps > 0 && steps.is_multiple_of(STEPS) && !watch(&engine.progress()) {
            engine.cancel();
        }
        if !engine.step() {
            return engine.finish();
        }
        steps += 1;
    }
}

/// Buckets of a [`WorstFirst`] queue: fine enough that "worst" means within a few percent.
const BUCKETS: usize = 256;

/// An empty bucket keeps its memory up to this number of items: most such buckets are filled again.
const SMALL: usize = 64;

/// A queue that returns the worst item first, and of items within about 1/256 of badness the oldest.
///
/// Buckets instead of a heap: a push and a pop take constant time at 10⁷ entries, and the order of items does not
/// depend on other items.
pub struct WorstFirst<T> {
    buckets: Vec<VecDeque<T>>,
    /// Buckets above this one are empty.
    top: usize,
    len: usize,
}

impl<T> Default for WorstFirst<T> {
    fn default() -> Self {
        Self { buckets: (0..BUCKETS).map(|_| VecDeque::new()).collect(), top: 0, len: 0 }
    }
}

impl<T> WorstFirst<T> {
    /// Adds an item of badness 0 (mild) to 1 (worst).
    pub fn push(&mut self, item: T, badness: f64) {
        let bucket = (badness.clamp(0.0, 1.0) * (BUCKETS - 1) as f64) as usize;
        self.buckets[bucket].push_back(item);
        self.top = self.top.max(bucket);
        self.len += 1;
    }

    /// Removes the oldest item of the worst bucket; `None` where the queue is empty.
    pub fn pop(&mut self) -> Option<T> {
        loop {
            if let Some(item) = self.buckets[self.top].pop_front() {
                self.len -= 1;
                return Some(item);
            }
            // An emptied bucket frees its memory, so that a queue that was once long does not stay large.
            if self.buckets[self.top].capacity() > SMALL {
                self.buckets[self.top] = VecDeque::new();
            }
            self.top = self.top.checked_sub(1)?;
        }
    }

    /// Badness of the item returned last, to within 1/256.
    pub fn badness(&self) -> f64 {
        self.top as f64 / (BUCKETS - 1) as f64
    }

    /// Number of items in the queue.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the queue has no items.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

/// Whether a worst-first refinement still makes progress, measured by the badness of its cells.
///
/// A refinement that ends removes its worst cells first, then milder ones, with relapses, until none is left. One that
/// does not end reaches the angle that the drawing allows, and from there on makes as many bad cells as it removes. So
/// its *mildest* badness, the least at which no worse cell was left, stays the same while the mesh grows.
pub struct Headway {
    patience: Patience,
    /// The mildest badness since the queue was empty last.
    mildest: f64,
    /// Size of the mesh (cells or vertices) when the mildest badness was met.
    since: usize,
}

/// The conditions that must all hold for a refinement to be given up.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Patience {
    /// The mesh has grown by this factor since the mildest badness was met.
    pub growth: f64,
    /// The mildest badness is no larger than this: worse cells resolve the detail of the drawing, which may take as
    /// long as it takes.
    pub mild: f64,
    /// The badness of the current cell exceeds the mildest one by at least this.
    pub relapse: f64,
}

impl Headway {
    /// Small meshes may grow by large factors and still end: growth counts beyond this size.
    const SMALL: f64 = 1000.0;

    /// The state before refinement begins.
    pub fn new(patience: Patience) -> Self {
        Self { patience, mildest: 1.0, since: 0 }
    }

    /// Notes that no bad cell is left when the mesh has a size.
    pub fn rest(&mut self, size: usize) {
        (self.mildest, self.since) = (1.0, size);
    }

    /// Notes the badness of the current cell when the mesh has a size. `false`: refinement makes no progress any more.
    /// A badness of 1 only says that the cell comes first, and does not count.
    pub fn goes_on(&mut self, badness: f64, size: usize) -> bool {
        if badness >= 1.0 {
            return true;
        }
        if badness < self.mildest {
            (self.mildest, self.since) = (badness, size);
        }
        let Patience { growth, mild, relapse } = self.patience;
        let grown = size as f64 > growth * self.since as f64 + Self::SMALL;
        !(grown && self.mildest <= mild && badness >= self.mildest + relapse)
    }
}

/// Why a refinement ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug, serde::Serialize, schemars::JsonSchema)]
pub enum StopReason {
    /// Nothing is left to refine.
    #[serde(rename = "done")]
    Done,
    /// The vertex budget is used up.
    #[serde(rename = "vertex budget")]
    VertexBudget,
    /// The watch stopped the run.
    #[serde(rename = "cancelled")]
    Cancelled,
    /// The watch stopped the run when the permitted time had passed.
    #[serde(rename = "timeout")]
    TimedOut,
    /// Features are nearer to each other than the coordinates can tell apart.
    #[serde(rename = "arithmetic")]
    Arithmetic,
    /// Angles do not get larger any more, however many vertices are inserted.
    #[serde(rename = "no progress")]
    NoProgress,
}

/// The end of a refinement: why, what is unresolved, and where.
#[derive(Clone, PartialEq, Debug)]
pub struct Stop {
    /// Why it ended.
    pub reason: StopReason,
    /// Cells that still miss a bound.
    pub unresolved: usize,
    /// The places of some of them.
    pub places: Vec<Point>,
    /// The smallest angle to which the mesh was refined, in degrees, where it is not the one asked for.
    pub angle_deg: Option<f64>,
}

/// What a refinement counted, by name in alphabetical order.
#[derive(Clone, PartialEq, Eq, Debug, Default, serde::Serialize, schemars::JsonSchema)]
#[serde(transparent)]
pub struct Counters(pub BTreeMap<&'static str, u64>);

impl Counters {
    /// Adds `n` to a counter, which starts at 0.
    pub fn add(&mut self, name: &'static str, n: u64) {
        *self.0.entry(name).or_default() += n;
    }

    /// The count under a name; 0 where nothing was counted under it.
    pub fn get(&self, name: &str) -> u64 {
        self.0.get(name).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_comes_first_and_equals_in_order() {
        let mut queue = WorstFirst::default();
        for (item, badness) in [("mild", 0.1), ("worst", 0.9), ("mid", 0.5), ("worst too", 0.9), ("off the scale", 7.0)]
        {
            queue.push(item, badness);
        }
        assert_eq!(queue.len(), 5);
        let order: Vec<_> = std::iter::from_fn(|| queue.pop()).collect();
        assert_eq!(order, ["off the scale", "worst", "worst too", "mid", "mild"]);
        assert!(queue.is_empty());
        queue.push("again", 0.3);
        assert_eq!(queue.pop(), Some("again"));
        assert!((queue.badness() - 0.3).abs() < 1.0 / 128.0);
    }

    #[test]
    fn headway_ends_where_the_mesh_grows_and_nothing_gets_milder() {
        let patience = Patience { growth: 2.0, mild: 0.5, relapse: 0.1 };
        let mut headway = Headway::new(patience);
        assert!(
            headway.goes_on(0.9, 1_000) && headway.goes_on(0.8, 100_000),
            "what is that bad may take as long as it likes"
        );
        assert!(headway.goes_on(0.4, 200_000));
        assert!(headway.goes_on(0.6, 400_000), "it has not grown by the factor");
        assert!(headway.goes_on(0.45, 500_000), "that is no relapse");
        assert!(headway.goes_on(1.0, 500_000), "what comes first tells nothing");
        assert!(!headway.goes_on(0.6, 500_000));
        headway.rest(500_000);
        assert!(headway.goes_on(0.45, 600_000) && headway.goes_on(0.7, 1_200_000));
        assert!(!headway.goes_on(0.7, 1_300_000));
    }
}
