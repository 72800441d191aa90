//! The time and the memory that a map may take.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::verdict::Limits;
use number::parallel::{Pool, go_on};
use number::{Error, Result};

/// The time and the memory that a map or a list of pairs may take.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resources<'a> {
    /// Threads to run on; 0 for as many as there are processors.
    pub threads: usize,
    /// `kicks` bounds those of a single pair; a map as a whole may compose 10^4 times as many.
    pub limits: Limits,
    /// The work ends with an error of the kind `Stopped` soon after this is set: it is looked at between any
    /// two groups of pairs.
    pub stopped: Option<&'a AtomicBool>,
    /// Counts the pairs of a list that are decided.
    pub done: Option<&'a AtomicUsize>,
}

impl Resources<'_> {
    pub(super) fn pool(&self) -> Result<Pool> {
        Pool::new(self.threads)
    }

    /// # Errors
    /// Where the work was stopped.
    pub(super) fn go_on(&self) -> Result<()> {
        match self.stopped {
            Some(stopped) if stopped.load(Ordering::Relaxed) => Err(Error::stopped("the map")),
            _ => go_on(),
        }
    }

    /// So many pairs more are decided.
    pub(super) fn count(&self, pairs: usize) {
        if let Some(done) = self.done {
            done.fetch_add(pairs, Ordering::Relaxed);
        }
    }
}
