//! The program itself: run as such, or for the bytes that it would write.

use std::ffi::OsString;
use std::path::PathBuf;

use kickdrift::cli;
use kickdrift::recheck::{Claim, Options};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::job;
use crate::pair::limits;

/// Runs the program with the arguments, its own name first; its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::program(arguments))
}

/// What the program would write for the arguments.
#[pyfunction]
pub fn answer<'py>(py: Python<'py>, arguments: Vec<OsString>) -> PyResult<Bound<'py, PyBytes>> {
    let name = OsString::from("kickdrift");
    let bytes = job::run(py, move |_| cli::answer(std::iter::once(name).chain(arguments)))?;
    Ok(PyBytes::new(py, &bytes))
}

/// How many rows hold, by which route, the sample drawn, what is not rechecked, and the rows that fail with what they
/// say and why that is wrong.
type Outcome = (u64, String, Option<(u64, u64)>, Vec<String>, Vec<(u64, String, String)>);

/// Finds the claims of a document again by another route.
#[pyfunction]
pub fn recheck(
    py: Python<'_>,
    text: String,
    all: bool,
    budget: Option<u64>,
    folder: PathBuf,
) -> PyResult<Outcome> {
    job::run(py, move |_| {
        let options = Options { limits: limits(budget), all, folder };
        let outcome = Claim::read(&text)?.recheck(&options, None)?;
        let not_rechecked = outcome.not_rechecked.iter().map(ToString::to_string).collect();
        let failures = outcome.failures.iter();
        let failures = failures.map(|own| (own.row as u64, own.place.clone(), own.why.to_string())).collect();
        let sample = outcome.sample.map(|(drawn, of)| (drawn as u64, of as u64));
        Ok((outcome.rows as u64, outcome.route.to_string(), sample, not_rechecked, failures))
    })
}
