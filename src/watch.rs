//! Long work reports its progress between steps, and asks whether to go on.
//!
//! The library has no clock. The caller may have one ([`Clock`]), or a limit on a count: when it is reached, the watch
//! returns `false`.

/// Called between the steps of long work, a few microseconds to a few milliseconds apart; `false` ends the work.
pub type Watch<'a> = dyn FnMut(&Progress) -> bool + 'a;

/// Seconds since a moment of the caller's choice; never decreasing.
pub type Clock<'a> = dyn Fn() -> f64 + 'a;

/// The clock of a caller that has none: no time passes.
pub fn no_clock() -> f64 {
    0.0
}

/// The progress of the work.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Progress {
    /// Name of the stage at work, in one word: `cutting`, `refining`.
    pub phase: &'static str,
    /// Vertices so far, or a lower bound of their final number.
    pub vertices: usize,
    /// The known number of steps left.
    pub queued: usize,
}

/// The watch ended the work.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("stopped")]
pub struct Stopped;

impl Progress {
    /// Calls the watch with this progress.
    ///
    /// # Errors
    /// [`Stopped`] where the watch returns `false`.
    pub fn tell(self, watch: &mut Watch) -> Result<(), Stopped> {
        if watch(&self) { Ok(()) } else { Err(Stopped) }
    }
}
