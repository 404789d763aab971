//! Work on several threads; without the feature `parallel`, sequentially. The result is the same either way.
//!
//! The threads belong to a pool of squinch, which is made at its first use. The child of a fork after that has none of
//! these threads, and makes a pool of its own.

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

    /// The pool, once it is made.
    static POOL: Mutex<Option<Made>> = Mutex::new(None);
    /// The number of threads to make; 0: as many as cores.
    static COUNT: AtomicUsize = AtomicUsize::new(0);

    /// A pool, and the process that made it.
    struct Made {
        process: u32,
        pool: Arc<ThreadPool>,
    }

    /// Sets the number of threads; 0: as many as cores. Call it before any work: once the pool is made, its size is
    /// fixed.
    pub fn set_count(threads: usize) {
        COUNT.store(threads, Ordering::Relaxed);
    }

    /// The number of threads.
    pub fn count() -> usize {
        pool().map_or(1, |pool| pool.current_num_threads())
    }

    /// The pool of this process; `None` where the system cannot make threads.
    fn pool() -> Option<Arc<ThreadPool>> {
        let mut made = POOL.lock().unwrap_or_else(PoisonError::into_inner);
        pool_of(std::process::id(), &mut made, COUNT.load(Ordering::Relaxed))
    }

    /// The pool of a process: the one that it made, or a new one with `threads` threads.
    fn pool_of(process: u32, made: &mut Option<Made>, threads: usize) -> Option<Arc<ThreadPool>> {
        if let Some(made) = made.as_ref().filter(|made| made.process == process) {
            return Some(made.pool.clone());
        }
        let pool = Arc::new(ThreadPoolBuilder::new().num_threads(threads).build().ok()?);
        // The threads of a parent's pool do not exist in this process, so the pool must not be dropped.
        std::mem::forget(made.replace(Made { process, pool: pool.clone() }));
        Some(pool)
    }

    fn within<R: Send>(work: impl FnOnce() -> R + Send) -> R {
        match pool() {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Runs both, at the same time if there are threads.
    pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
        within(|| rayon::join(a, b))
    }

    /// Runs `work` for each of 0, 1, … below `n`, in any order.
    pub fn for_each(n: usize, work: impl Fn(usize) + Send + Sync) {
        within(|| (0..n).into_par_iter().for_each(work));
    }

    /// The results of `work` for all items, in their order.
    pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Send + Sync) -> Vec<R> {
        within(|| items.par_iter().map(work).collect())
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn a_pool_has_as_many_threads_as_asked_for_and_stays() {
            for threads in 1..4 {
                let mut made = None;
                let first = pool_of(1, &mut made, threads).expect("there are threads");
                assert_eq!(first.current_num_threads(), threads);
                let again = pool_of(1, &mut made, threads + 1).expect("it was made");
                assert!(Arc::ptr_eq(&first, &again), "the pool that is made first keeps its size");
            }
        }

        #[test]
        fn another_process_makes_a_pool_of_its_own() {
            let mut made = None;
            let parent = pool_of(1, &mut made, 2).expect("there are threads");
            let child = pool_of(2, &mut made, 2).expect("there are threads");
            assert!(!Arc::ptr_eq(&parent, &child));
            assert!(Arc::ptr_eq(&child, &pool_of(2, &mut made, 2).expect("it was made")));
            // It works, and so does the other one, in the process that it is of.
            for pool in [parent, child] {
                assert_eq!(pool.install(|| (0..1000_u32).into_par_iter().sum::<u32>()), 499_500);
            }
        }
    }
}

#[cfg(not(feature = "parallel"))]
mod serial {
    /// The number of threads.
    pub fn count() -> usize {
        1
    }

    /// Runs both, one after the other.
    pub fn join<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
        (a(), b())
    }

    /// Each of 0, 1, … below `n`.
    pub fn for_each(n: usize, work: impl Fn(usize)) {
        (0..n).for_each(work);
    }

    /// The results of `work` for all items, in their order.
    pub fn map<T, R>(items: &[T], work: impl Fn(&T) -> R) -> Vec<R> {
        items.iter().map(work).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn work_comes_out_as_if_done_one_after_the_other() {
        assert!(count() >= 1);
        let items: Vec<usize> = (0..1000).collect();
        let wanted: Vec<usize> = items.iter().map(|x| x * x).collect();
        assert_eq!(map(&items, |x| x * x), wanted, "in their order");
        let seen: Vec<AtomicUsize> = items.iter().map(|_| AtomicUsize::new(0)).collect();
        for_each(items.len(), |k| _ = seen[k].fetch_add(1, Ordering::Relaxed));
        assert!(seen.iter().all(|times| times.load(Ordering::Relaxed) == 1), "each once");
        // Work within work, as the verifier does it.
        let (a, b) = join(|| map(&items, |x| x + 1), || join(|| 3, || "four"));
        assert_eq!((a[999], b), (1000, (3, "four")));
        assert!(map(&[0; 0], |x: &i32| *x).is_empty());
    }
}
