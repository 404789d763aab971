//! Work on several threads; one after the other without the feature `parallel`. What comes of it is the same either way.
//!
//! The threads are a pool of squinch's own, made at its first use: a process that forks after that has none of them in its child, which makes
//! a pool of its own then.

#[cfg(feature = "parallel")]
pub use pooled::{count, for_each, join, map, set_count};
#[cfg(not(feature = "parallel"))]
pub use serial::{count, for_each, join, map};

#[cfg(feature = "parallel")]
mod pooled {
    use rayon::prelude::*;
    use rayon::{ThreadPool, ThreadPoolBuilder};
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::{Arc, Mutex, PoisonError};

    /// The pool, and the process that made it.
    static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    /// Threads asked for; 0: as many as cores.
    static COUNT: AtomicUsize = AtomicUsize::new(0);

    /// Sets how many threads there are, before any work: the pool that is made first keeps its size. 0: as many as cores.
    pub fn set_count(threads: usize) {
        COUNT.store(threads, Ordering::Relaxed);
    }

    /// How many threads there are.
    pub fn count() -> usize {
        pool().map_or(1, |pool| pool.current_num_threads())
    }

    /// `None` where the system has no threads to give.
    fn pool() -> Option<Arc<ThreadPool>> {
        let process = std::process::id();
        let mut made = POOL.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, pool)) = &*made
            && *of == process
        {
            return Some(pool.clone());
        }
        let pool = Arc::new(ThreadPoolBuilder::new().num_threads(COUNT.load(Ordering::Relaxed)).build().ok()?);
        // The threads of a pool of another process are not here to be ended.
        std::mem::forget(made.replace((process, pool.clone())));
        Some(pool)
    }

    fn within<R: Send>(work: impl FnOnce() -> R + Send) -> R {
        match pool() {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Both, at the same time if there are threads.
    pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
        within(|| rayon::join(a, b))
    }

    /// Each of 0, 1, … below `n`, in any order.
    pub fn for_each(n: usize, work: impl Fn(usize) + Send + Sync) {
        within(|| (0..n).into_par_iter().for_each(work));
    }

    /// What comes of each item, in their order.
    pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Send + Sync) -> Vec<R> {
        within(|| items.par_iter().map(work).collect())
    }
}

#[cfg(not(feature = "parallel"))]
mod serial {
    /// How many threads there are.
    pub fn count() -> usize {
        1
    }

    /// Both, one after the other.
    pub fn join<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
        (a(), b())
    }

    /// Each of 0, 1, … below `n`.
    pub fn for_each(n: usize, work: impl Fn(usize)) {
        (0..n).for_each(work);
    }

    /// What comes of each item, in their order.
    pub fn map<T, R>(items: &[T], work: impl Fn(&T) -> R) -> Vec<R> {
        items.iter().map(work).collect()
    }
}
