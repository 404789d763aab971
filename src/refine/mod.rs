//! What refinement in any dimension shares: the worst-first queue, the counters, and the reason to stop.

use crate::geometry::Point;
use std::collections::{BTreeMap, VecDeque};

/// Buckets of a [`WorstFirst`] queue: fine enough that "worst" means within a few percent.
const BUCKETS: usize = 256;

/// Items that a bucket keeps room for while it is empty: few are filled only once.
const SMALL: usize = 64;

/// A queue that hands out the worst first, first come first served within about 1/256 of badness.
///
/// Flat buckets instead of a heap: 10⁷ entries cost a push and a pop each, and the order does not depend on the sizes of others.
pub struct WorstFirst<T> {
    buckets: Vec<VecDeque<T>>,
    /// No bucket above this one holds anything.
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

    pub fn pop(&mut self) -> Option<T> {
        loop {
            if let Some(item) = self.buckets[self.top].pop_front() {
                self.len -= 1;
                return Some(item);
            }
            // An emptied bucket gives its memory back, so that a queue that was once long does not stay large.
            if self.buckets[self.top].capacity() > SMALL {
                self.buckets[self.top] = VecDeque::new();
            }
            self.top = self.top.checked_sub(1)?;
        }
    }

    pub fn len(&self) -> usize {
        self.len
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

/// Why a refinement ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug, serde::Serialize, schemars::JsonSchema)]
pub enum StopReason {
    #[serde(rename = "done")]
    Done,
    #[serde(rename = "vertex budget")]
    VertexBudget,
    #[serde(rename = "timeout")]
    Cancelled,
    /// Features nearer to each other than the coordinates can tell apart.
    #[serde(rename = "arithmetic")]
    Arithmetic,
}

/// The end of a refinement: why, what is owed, and where.
#[derive(Clone, PartialEq, Debug)]
pub struct Stop {
    pub reason: StopReason,
    /// Cells that still miss a bound.
    pub owed: usize,
    /// Some of the places where refinement is owed.
    pub places: Vec<Point>,
}

/// What a refinement counted, by name in alphabetical order.
#[derive(Clone, PartialEq, Eq, Debug, Default, serde::Serialize, schemars::JsonSchema)]
#[serde(transparent)]
pub struct Counters(pub BTreeMap<&'static str, u64>);

impl Counters {
    pub fn add(&mut self, name: &'static str, n: u64) {
        *self.0.entry(name).or_default() += n;
    }

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
    }
}
