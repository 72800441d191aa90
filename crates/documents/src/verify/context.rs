//! The means of a check, and its outcome.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::input::Arrays;
use crate::question::{Watch, Work};
use clocks::tongue::Progress as Counter;
use clocks::verdict::Limits;
use number::parallel::try_map;
use number::{Error, Result};

/// The remedy for a document that cannot be read.
pub const REMEDY: &str = "whole documents, as kickdrift wrote them, can be rechecked";

/// Where there is no other route.
pub const ALONE: &str = "none: every value is computed again, by the same route";

/// A route's room at the end of a region, relative: the smallest eigenvalue of the action there is some 10^-6
/// of its largest.
pub const ROOM: f64 = 1e-6;

/// A trace this near to ±2 decides nothing in doubles.
pub const TRACE_ROOM: f64 = 1e-7;

/// How much is checked, and what one row may cost.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The highest cost of an answer, as when it is asked for.
    pub budget: Option<u64>,
    /// Whether the slower route takes every pair or tongue of a map or a survey, and not a sample of them.
    pub all: bool,
    /// Where the files are that a system of measured stiffnesses refers to.
    pub folder: PathBuf,
}

/// Hears how far a check is: rows done, rows in all.
pub type Progress<'a> = &'a (dyn Fn(u64, u64) + Sync);

/// The result of a check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// The rows of the document; one where it has none.
    pub rows: u64,
    /// In words, the other route.
    pub route: &'static str,
    /// Where the slower route took a sample: so many, of so many.
    pub sample: Option<(u64, u64)>,
    /// The claims that do not hold, in the order of the rows; last those about the whole document.
    pub failures: Vec<Failure>,
    /// The fields that were not rechecked, each with the reason.
    pub not_rechecked: Vec<String>,
}

impl Outcome {
    /// So many rows hold by this route.
    pub fn holding(route: &'static str, rows: u64) -> Outcome {
        Outcome { rows, route, sample: None, failures: Vec::new(), not_rechecked: Vec::new() }
    }

    /// A document that is checked as a whole.
    pub fn whole(route: &'static str, checked: Checked) -> Result<Outcome> {
        let failures = failure(0, checked)?.into_iter().collect();
        Ok(Outcome { failures, ..Outcome::holding(route, 1) })
    }
}

/// A row that does not hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Counted from 1; 0 for the document as a whole.
    pub row: u64,
    /// The row's name, as `p = 7, q = 3, m = 4`; empty where the document has no such row.
    pub place: String,
    /// The reason.
    pub why: String,
}

/// The reason why a row does not hold, or why it cannot be decided.
pub enum Fault {
    Wrong(String),
    Error(Error),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Fault::Error(error)
    }
}

impl Fault {
    /// The error of a wrong input.
    pub fn refused(self) -> Error {
        match self {
            Fault::Wrong(why) => Error::input("input", "given", why),
            Fault::Error(error) => error,
        }
    }
}

pub type Checked<T = ()> = std::result::Result<T, Fault>;

/// Names the checks that another route leaves out because of their cost.
pub fn too_costly(what: &str, error: &Error) -> String {
    let raise = |needed: u64| format!("a budget of {needed} allows it");
    format!("{what} by another route: {}", error.clone().or("").explain(raise))
}

/// That something holds, or what is wrong.
pub fn holds(truth: bool, wrong: impl FnOnce() -> String) -> Checked {
    if truth { Ok(()) } else { Err(Fault::Wrong(wrong())) }
}

/// Says where something does not hold, in documents that have no row of it.
pub fn located(place: impl std::fmt::Display, checked: Checked) -> Checked {
    checked.map_err(|fault| match fault {
        Fault::Wrong(why) => Fault::Wrong(format!("{place}: {why}")),
        error => error,
    })
}

/// Holds a value against the one found by another route.
pub fn same<T: PartialEq + std::fmt::Display>(name: &str, found: T, truth: T) -> Checked {
    holds(found == truth, || format!("{name} is {truth}, not {found}"))
}

/// Computing again shows progress as checking rows does.
impl Watch for Context<'_> {
    fn announce(&self, _: &str, _: f64) {}

    fn count(&self, length: u64, _: &str) -> Box<dyn Counter + '_> {
        Box::new(Done { progress: self.progress, done: AtomicU64::new(0), total: AtomicU64::new(length) })
    }
}

struct Done<'a> {
    progress: Option<Progress<'a>>,
    done: AtomicU64,
    total: AtomicU64,
}

impl Counter for Done<'_> {
    fn expect(&self, total: u64) {
        self.total.store(total, Ordering::Relaxed);
    }

    fn advance(&self, more: u64) {
        let done = self.done.fetch_add(more, Ordering::Relaxed) + more;
        self.progress.inspect(|progress| progress(done, self.total.load(Ordering::Relaxed)));
    }
}

/// A check at work.
pub struct Context<'a> {
    pub options: &'a Options,
    pub progress: Option<Progress<'a>>,
    /// The arrays that systems refer to.
    arrays: Arrays,
}

impl<'a> Context<'a> {
    pub fn new(options: &'a Options, progress: Option<Progress<'a>>) -> Self {
        Context { options, progress, arrays: Arrays::from(&options.folder) }
    }
}

impl Context<'_> {
    /// The highest cost of computing an answer again, and where its arrays are.
    pub fn work(&self) -> Work<'_> {
        Work { budget: self.options.budget, watch: Some(self), arrays: Some(&self.arrays), ..Work::default() }
    }

    /// The kicks that one verdict may compose.
    pub fn limits(&self) -> Limits {
        self.work().limits()
    }

    /// Checks all rows, side by side: what does not hold, in their order.
    pub fn rows<T: Sync>(&self, rows: &[T], check: impl Fn(&T) -> Checked + Sync) -> Result<Vec<Failure>> {
        let counter = self.count(rows.len() as u64, "rows");
        let one = |(row, item): &(u64, &T)| {
            let failure = failure(*row, check(item));
            counter.advance(1);
            failure
        };
        let found: Vec<_> = try_map(&(1..).zip(rows).collect::<Vec<_>>(), one)?;
        Ok(found.into_iter().flatten().collect())
    }

    /// The outcome of a whole document (`whole`) and of its rows.
    pub fn outcome<T: Sync>(
        &self,
        route: &'static str,
        whole: Checked,
        rows: &[T],
        check: impl Fn(&T) -> Checked + Sync,
    ) -> Result<Outcome> {
        let whole = failure(0, whole)?;
        let mut failures = self.rows(rows, check)?;
        failures.extend(whole);
        Ok(Outcome { failures, ..Outcome::holding(route, rows.len() as u64) })
    }
}

/// The failure of a row, 0 for the document as a whole, which whoever has the document names.
pub fn failure(row: u64, checked: Checked) -> Result<Option<Failure>> {
    match checked {
        Ok(()) => Ok(None),
        Err(Fault::Wrong(why)) => Ok(Some(Failure { row, place: String::new(), why })),
        Err(Fault::Error(error)) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn progress_counts_to_the_total_that_is_known_in_the_end() {
        let (options, told) = (Options::default(), Mutex::new(Vec::new()));
        let progress = |done: u64, total: u64| told.lock().unwrap().push((done, total));
        let context = Context::new(&options, Some(&progress));
        let counter = context.count(5, "tongues");
        counter.advance(2);
        counter.expect(3);
        counter.advance(1);
        assert_eq!(*told.lock().unwrap(), [(2, 5), (3, 3)]);
    }
}
