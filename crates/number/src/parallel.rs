//! Work spread over threads: the results and their order are those of one thread. And work that its caller
//! may stop.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::error::{Error, Result, room};

thread_local! {
    /// The flag that stops the work under way on this thread.
    static STOP: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Runs `work`, all of which ends with an error of the kind `Stopped` soon after the flag is set, on whatever
/// threads it is: surveys, closings, comparisons, scans and simulations look at it piece by piece.
///
/// ```
/// use std::sync::{Arc, atomic::AtomicBool};
/// use kickdrift_number::error::Kind;
/// use kickdrift_number::parallel::{go_on, stoppable};
/// let flag = Arc::new(AtomicBool::new(true));
/// assert_eq!(stoppable(&flag, go_on).unwrap_err().kind(), Kind::Stopped);
/// ```
pub fn stoppable<R>(flag: &Arc<AtomicBool>, work: impl FnOnce() -> R) -> R {
    under(Some(flag.clone()), work)
}

/// Runs `work` under a flag or none, whatever this thread was under before.
fn under<R>(flag: Option<Arc<AtomicBool>>, work: impl FnOnce() -> R) -> R {
    struct Before(Option<Arc<AtomicBool>>);
    impl Drop for Before {
        fn drop(&mut self) {
            STOP.set(self.0.take());
        }
    }
    let _before = Before(STOP.replace(flag));
    work()
}

/// That nobody has stopped the work on this thread.
///
/// # Errors
/// Where somebody has.
pub fn go_on() -> Result<()> {
    let is_set =
        |flag: &Option<Arc<AtomicBool>>| flag.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed));
    if STOP.with_borrow(is_set) { Err(Error::stopped("the work")) } else { Ok(()) }
}

/// Threads of its own for one long computation.
pub struct Pool {
    threads: rayon::ThreadPool,
}

impl Pool {
    /// So many threads; 0 means one a core.
    ///
    /// # Errors
    /// An I/O error where the system does not give them.
    pub fn new(threads: usize) -> Result<Pool> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let refused = |cause| crate::error::Error::io("threads", &cause).caused_by(cause);
        Ok(Pool { threads: pool.map_err(refused)? })
    }

    /// Runs `work`, whose parallel iterators then use these threads; what stops this thread's work stops it.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let flag = STOP.with_borrow(Clone::clone);
        self.threads.install(|| under(flag, work))
    }

    /// The number of threads.
    pub fn size(&self) -> usize {
        self.threads.current_num_threads()
    }
}

/// `work` of each item, in the items' order; never stopped.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let found: Result<Vec<R>> = under(None, || try_map(items, |item| Ok(work(item))));
    found.expect("none of these fails")
}

/// As [`map`], for a function that may fail.
///
/// # Errors
/// That of the first item which fails, whatever the threads; items after it may be left out.
pub fn try_map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> Result<R> + Sync) -> Result<Vec<R>> {
    room((size_of::<Mutex<Option<Result<R>>>>() * items.len()) as u128, "fewer of them at once")?;
    let places: Vec<Mutex<Option<Result<R>>>> = items.iter().map(|_| Mutex::new(None)).collect();
    let (failed, flag) = (AtomicUsize::new(usize::MAX), STOP.with_borrow(Clone::clone));
    each(items.len(), &|n| {
        if n < failed.load(Ordering::Relaxed) {
            let found = under(flag.clone(), || go_on().and_then(|()| work(&items[n])));
            if found.is_err() {
                failed.fetch_min(n, Ordering::Relaxed);
            }
            *places[n].lock().expect("one thread a place") = Some(found);
        }
    });
    // Up to the first error every place is filled.
    places.into_iter().map_while(|place| place.into_inner().expect("one thread a place")).collect()
}

/// Two pieces of work, side by side where they are `worth` a thread; never stopped.
pub fn both<A: Send, B: Send>(
    worth: bool,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if worth {
        return rayon::join(|| under(None, first), || under(None, second));
    }
    (first(), second())
}

/// `work` of 0, 1, ..., n − 1, in any order: the only place that is compiled with the threads' machinery.
fn each(n: usize, work: &(dyn Fn(usize) + Sync)) {
    use rayon::prelude::*;
    (0..n).into_par_iter().for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;

    #[test]
    fn results_come_in_order_and_of_errors_the_first() {
        let items: Vec<u64> = (0..1000).collect();
        assert_eq!(map(&items, |n| n * n)[999], 999 * 999);
        let odd = |n: &u64| if *n > 700 { Err(Error::input("n", n, "too large")) } else { Ok(*n) };
        assert_eq!(try_map(&items[..701], odd).unwrap(), items[..701]);
        for _ in 0..20 {
            assert!(try_map(&items, odd).unwrap_err().to_string().contains("701"));
        }
    }
}
