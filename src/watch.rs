//! What long work tells and asks between its steps: how far it has come, and whether to go on.
//!
//! The library has no clock. Whoever calls it may have one ([`Clock`]), or a count that must not be passed: then the
//! watch says stop.

/// Asked between the steps of long work, a few microseconds to a few milliseconds apart; `false` ends the work.
pub type Watch<'a> = dyn FnMut(&Progress) -> bool + 'a;

/// Seconds since a moment of the caller's choice, never less than before.
pub type Clock<'a> = dyn Fn() -> f64 + 'a;

/// The clock of a caller that has none: no time passes.
pub fn no_clock() -> f64 {
    0.0
}

/// How far the work has come.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Progress {
    /// Name of the stage at work, in one word: `cutting`, `refining`.
    pub phase: &'static str,
    /// Vertices so far, or as many as there must be at least.
    pub vertices: usize,
    /// Steps that are known to wait.
    pub queued: usize,
}

/// The watch said stop.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("stopped")]
pub struct Stopped;

impl Progress {
    /// Tells the watch.
    ///
    /// # Errors
    /// [`Stopped`] where it says stop.
    pub fn tell(self, watch: &mut Watch) -> Result<(), Stopped> {
        if watch(&self) { Ok(()) } else { Err(Stopped) }
    }
}
