//! Counts, worst value and flaws of a check while it runs.

use super::{Check, Status, Worst};
use crate::geometry::Place;

/// Number of flaws that a check keeps as sentences.
const SENTENCES: usize = 10;

/// A check that is under way.
pub struct Tally {
    check: Check,
    /// Which values are worse: 1 the larger, −1 the smaller.
    sense: f64,
}

impl Check {
    /// The check that was not made.
    pub(super) fn not_asked(name: &'static str) -> Self {
        Self { name, status: Status::NotAsked, checked: 0, broken: 0, exempt: 0, worst: None, flaws: Vec::new() }
    }
}

impl Tally {
    /// A check whose largest value is the worst.
    pub fn highest(name: &'static str) -> Self {
        Self { check: Check::not_asked(name), sense: 1.0 }
    }

    /// A check whose smallest value is the worst.
    pub fn lowest(name: &'static str) -> Self {
        Self { check: Check::not_asked(name), sense: -1.0 }
    }

    /// Counts one more thing that was checked.
    pub fn count(&mut self) {
        self.check.checked += 1;
    }

    /// Counts one more thing that is exempt.
    pub fn exempt(&mut self) {
        self.check.exempt += 1;
    }

    /// Notes a value and its place; the worst is kept.
    #[inline]
    pub fn measure(&mut self, value: f64, at: impl Into<Place>) {
        if self.check.worst.is_none_or(|w| (value - w.value) * self.sense > 0.0) {
            self.check.worst = Some(Worst { value, at: at.into() });
        }
    }

    /// Counts one more thing that failed, and the reason.
    pub fn flaw(&mut self, sentence: impl FnOnce() -> String) {
        self.check.broken += 1;
        if self.check.flaws.len() < SENTENCES {
            self.check.flaws.push(sentence());
        }
    }

    /// Adds what was found elsewhere for the same check.
    pub fn append(&mut self, other: Self) {
        self.check.checked += other.check.checked;
        self.check.broken += other.check.broken;
        self.check.exempt += other.check.exempt;
        let room = SENTENCES.saturating_sub(self.check.flaws.len());
        self.check.flaws.extend(other.check.flaws.into_iter().take(room));
        if let Some(worst) = other.check.worst {
            self.measure(worst.value, worst.at);
        }
    }

    /// The finished check, with the status `held` where nothing failed.
    pub fn finish(mut self, held: Status) -> Check {
        self.check.status = if self.check.broken == 0 { held } else { Status::Broken };
        self.check
    }
}
