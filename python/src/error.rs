//! The library's errors as the package's exceptions.

use kickdrift::error::{Error, Kind};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyType;

/// The library's error as `KickdriftError`, or as `BudgetError` where a higher limit helps.
pub fn raised(error: &Error) -> PyErr {
    Python::attach(|py| match error.kind() {
        Kind::Budget => {
            let (work, remedy) = (spoken(error.field()), spoken(error.remedy()));
            exception(py, "BudgetError", (work, error.needed(), remedy))
        }
        _ => {
            // Values are the user's own, but for those that say which flags exclude each other.
            let flags =
                |value: &str| if value.starts_with("given with ") { spoken(value) } else { value.into() };
            let value = error.value().map(flags);
            exception(py, "KickdriftError", (name(error.field()), value, spoken(error.remedy())))
        }
    })
}

/// Bad input that the library never sees.
pub fn refused(py: Python<'_>, field: &str, value: String, remedy: &str) -> PyErr {
    exception(py, "KickdriftError", (field, Some(value), remedy))
}

fn exception<'py>(py: Python<'py>, class: &str, parts: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py.import("kickdrift._errors").and_then(|module| {
        let class = module.getattr(class)?.cast_into::<PyType>()?;
        class.call1(parts)
    });
    match made {
        Ok(error) => PyErr::from_value(error),
        Err(error) => error,
    }
}

/// Work that ended without a result, which only a defect can bring about.
pub fn lost() -> PyErr {
    PyRuntimeError::new_err("the computation ended without a result: please report this with its input")
}

/// A flag's name as that of an argument.
fn name(field: &str) -> String {
    field.trim_start_matches('-').replace('-', "_")
}

/// A remedy without the flags of the command line: `--max-sum N` is `max_sum N` here.
fn spoken(text: &str) -> String {
    let word = |word: &str| {
        let at = word.find("--").filter(|at| word[at + 2..].starts_with(|c: char| c.is_ascii_lowercase()));
        at.map_or(word.to_string(), |at| format!("{}{}", &word[..at], word[at + 2..].replace('-', "_")))
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}
