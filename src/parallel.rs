//! Work spread over threads; without the feature `parallel` one piece after the other. Same results, same order.
//!
//! Who works in parallel imports everything from here instead of rayon's prelude. Names of rayon that the library
//! does not use yet are added to `sequential` when it does.

#[cfg(feature = "parallel")]
pub(crate) use rayon::prelude::*;
#[cfg(not(feature = "parallel"))]
pub(crate) use sequential::*;

use crate::error::Result;

/// Threads of its own for one long computation.
pub(crate) struct Pool {
    #[cfg(feature = "parallel")]
    threads: rayon::ThreadPool,
}

#[cfg(feature = "parallel")]
impl Pool {
    /// So many threads; 0 means one a core.
    ///
    /// # Errors
    /// An I/O error where the system does not give them.
    pub(crate) fn new(threads: usize) -> Result<Pool> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let refused = |cause| crate::error::Error::io("threads", &cause).caused_by(cause);
        Ok(Pool { threads: pool.map_err(refused)? })
    }

    /// Runs `work`, whose parallel iterators then use these threads.
    pub(crate) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.threads.install(work)
    }

    /// The number of threads.
    pub(crate) fn size(&self) -> usize {
        self.threads.current_num_threads()
    }
}

#[cfg(not(feature = "parallel"))]
impl Pool {
    pub(crate) fn new(_threads: usize) -> Result<Pool> {
        Ok(Pool {})
    }

    pub(crate) fn install<R>(&self, work: impl FnOnce() -> R) -> R {
        work()
    }

    pub(crate) fn size(&self) -> usize {
        1
    }
}

/// Rayon's names for the iterators of the standard library.
#[cfg(not(feature = "parallel"))]
// Which of them are used depends on the other features.
#[allow(dead_code, unused_imports)]
mod sequential {
    pub(crate) trait IntoParallelIterator: IntoIterator + Sized {
        fn into_par_iter(self) -> Self::IntoIter {
            self.into_iter()
        }
    }

    impl<I: IntoIterator> IntoParallelIterator for I {}

    pub(crate) trait ParallelSlice<T> {
        fn par_iter(&self) -> std::slice::Iter<'_, T>;
        fn par_chunks(&self, length: usize) -> std::slice::Chunks<'_, T>;
    }

    impl<T> ParallelSlice<T> for [T] {
        fn par_iter(&self) -> std::slice::Iter<'_, T> {
            self.iter()
        }

        fn par_chunks(&self, length: usize) -> std::slice::Chunks<'_, T> {
            self.chunks(length)
        }
    }
}
