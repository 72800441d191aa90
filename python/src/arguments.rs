//! Arguments that are no quantities: how much work there may be, on how many threads.

use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::error::refused;
use crate::number::shown;

/// The most kicks; `None` for as many as there are without a limit of one's own.
#[derive(Clone, Copy)]
pub struct Budget(pub Option<u64>);

/// Threads, 0 for one a core.
#[derive(Clone, Copy)]
pub struct Threads(pub usize);

impl<'py> FromPyObject<'_, 'py> for Budget {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Budget> {
        whole("budget", &value, "give a whole number of kicks, or None").map(Budget)
    }
}

impl<'py> FromPyObject<'_, 'py> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Threads> {
        let found = whole("threads", &value, "give a whole number of threads, or None for one a core")?;
        Ok(Threads(found.map_or(0, |n| usize::try_from(n).unwrap_or(usize::MAX))))
    }
}

/// A whole number of at least 0, or nothing; an error names the argument.
fn whole(field: &str, value: &Bound<'_, PyAny>, remedy: &str) -> PyResult<Option<u64>> {
    if value.is_none() {
        return Ok(None);
    }
    let py = value.py();
    let refusal = || shown(value).map(|shown| refused(py, field, shown, remedy));
    if value.is_instance_of::<PyBool>() {
        return Err(refusal()?);
    }
    match value.extract() {
        Ok(n) => Ok(Some(n)),
        Err(error) if is_no_value(py, &error) => Err(refusal()?),
        Err(error) => Err(error),
    }
}

/// Whether an exception says that a value is not what it should be; any other one is not ours, as Ctrl-C and
/// a lack of memory are not.
pub fn is_no_value(py: Python<'_>, error: &PyErr) -> bool {
    error.is_instance_of::<PyTypeError>(py)
        || error.is_instance_of::<PyValueError>(py)
        || error.is_instance_of::<PyOverflowError>(py)
}
