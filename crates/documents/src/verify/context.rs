//! The means of a check, and its outcome.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::input::Arrays;
use crate::question::{Watch, Work};
use clocks::tongue::Progress;
use clocks::verdict::Limits;
use number::error::{Error, Result};
use number::parallel::try_map;

/// The remedy for a document that cannot be read.
pub const REMEDY: &str = "whole documents, as kickdrift wrote them, can be rechecked";

/// A route's room at the end of a region, relative: the smallest eigenvalue of the action there is some 10^-6
/// of its largest.
pub const ROOM: f64 = 1e-6;

/// How much is rechecked, and what one row may cost.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The highest cost of an answer, as when it is asked for.
    pub budget: Option<u64>,
    /// Whether the slower route takes every pair or tongue of a map or a survey, and not a sample of them.
    pub all: bool,
    /// Where the files are that a system of measured stiffnesses refers to.
    pub folder: PathBuf,
}

/// Called with the progress: rows done, rows in all.
pub type See<'a> = &'a (dyn Fn(u64, u64) + Sync);

/// The result of a recheck.
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

/// A row that does not hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Counted from 1; 0 for the document as a whole.
    pub row: u64,
    /// The row's name, as `p = 7, q = 3, m = 4`.
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

/// Holds a written value against the computed one.
pub fn same<T: PartialEq + std::fmt::Display>(name: &str, written: T, truth: T) -> Checked {
    holds(written == truth, || format!("{name} is {truth}, not {written}"))
}

/// A row that can be named.
pub trait Place: Sync {
    fn place(&self) -> String;
}

/// Computing again shows progress as checking rows does.
impl Watch for Context<'_> {
    fn announce(&self, _: &str, _: f64) {}

    fn count(&self, length: u64, _: &str) -> Box<dyn Progress + '_> {
        Box::new(Done { see: self.see, done: AtomicU64::new(0), count: length })
    }
}

struct Done<'a> {
    see: Option<See<'a>>,
    done: AtomicU64,
    count: u64,
}

impl Progress for Done<'_> {
    fn advance(&self, more: u64) {
        let done = self.done.fetch_add(more, Ordering::Relaxed) + more;
        self.see.inspect(|see| see(done, self.count));
    }
}

/// A check at work.
pub struct Context<'a> {
    pub options: &'a Options,
    pub see: Option<See<'a>>,
    /// The arrays that systems refer to.
    arrays: Arrays,
}

impl<'a> Context<'a> {
    pub fn new(options: &'a Options, see: Option<See<'a>>) -> Self {
        Context { options, see, arrays: Arrays::from(&options.folder) }
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
    pub fn rows<T: Place>(&self, rows: &[T], check: impl Fn(&T) -> Checked + Sync) -> Result<Vec<Failure>> {
        let (done, count) = (AtomicU64::new(0), rows.len() as u64);
        let one = |&(i, row): &(usize, &T)| {
            let failure = self.failure(i as u64 + 1, || row.place(), check(row));
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            self.see.inspect(|see| see(done, count));
            failure
        };
        let found: Vec<_> = try_map(&rows.iter().enumerate().collect::<Vec<_>>(), one)?;
        Ok(found.into_iter().flatten().collect())
    }

    pub fn failure(
        &self,
        row: u64,
        place: impl FnOnce() -> String,
        checked: Checked,
    ) -> Result<Option<Failure>> {
        match checked {
            Ok(()) => Ok(None),
            Err(Fault::Wrong(why)) => Ok(Some(Failure { row, place: place(), why })),
            Err(Fault::Error(error)) => Err(error),
        }
    }

    /// The outcome of a whole document (`whole`, named in words) and of its rows.
    pub fn outcome<T: Place>(
        &self,
        route: &'static str,
        (place, whole): (&str, Checked),
        rows: &[T],
        check: impl Fn(&T) -> Checked + Sync,
    ) -> Result<Outcome> {
        let whole = self.failure(0, || place.into(), whole)?;
        let mut failures = self.rows(rows, check)?;
        failures.extend(whole);
        let rows = rows.len() as u64;
        Ok(Outcome { rows, route, sample: None, failures, not_rechecked: Vec::new() })
    }
}
