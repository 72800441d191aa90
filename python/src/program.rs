//! The program itself: run as such, or for the bytes that it would write.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

use kickdrift::cli;
use kickdrift::error::Error;
use kickdrift::format::Format;
use kickdrift::question::{self, Work};
use kickdrift::recheck::{Claim, Options};
use kickdrift::report::document::Document;
use kickdrift::scene::{Array, Arrays};
use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::raised;
use crate::job;

/// Runs the program with the arguments, its own name first; its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::program(arguments))
}

/// What the program would write for the arguments; about a system in memory, the text of its file and its arrays by name, where
/// one is given.
#[pyfunction]
#[pyo3(signature = (arguments, text = None, arrays = None))]
pub fn answer<'py>(
    py: Python<'py>,
    arguments: Vec<OsString>,
    text: Option<String>,
    arrays: Option<BTreeMap<String, PyReadonlyArrayDyn<'py, f64>>>,
) -> PyResult<Bound<'py, PyBytes>> {
    let name = OsString::from("kickdrift");
    let arrays = held(arrays.unwrap_or_default())?;
    let held = text.map(|text| cli::Held { text, arrays });
    let bytes = job::run(py, move |_| cli::answer_about(std::iter::once(name).chain(arguments), held))?;
    Ok(PyBytes::new(py, &bytes))
}

/// The document that answers a question, in each of its forms.
#[pyclass(frozen)]
pub struct Answer(Document);

#[pymethods]
impl Answer {
    /// The document as json, csv, latex or text.
    fn render(&self, form: &str) -> PyResult<String> {
        let format = Format::DOCUMENT.into_iter().find(|format| format.name() == form);
        let format =
            format.ok_or_else(|| raised(&Error::input("form", form, "is json, csv, latex or text")))?;
        self.0.render(format).map_err(|error| raised(&error))
    }
}

/// Answers a question: its name, and its fields as texts.
#[pyfunction]
#[pyo3(signature = (name, fields, budget = None))]
pub fn ask(
    py: Python<'_>,
    name: String,
    fields: BTreeMap<String, String>,
    budget: Option<u64>,
) -> PyResult<Answer> {
    job::run(py, move |_| {
        let fields = fields.into_iter().map(|(name, text)| (name, text.into())).collect();
        question::ask(&name, &fields, &Work { budget, ..Work::default() }).map(Answer)
    })
}

/// Arrays in memory that a system refers to by name.
pub fn held(arrays: BTreeMap<String, PyReadonlyArrayDyn<'_, f64>>) -> PyResult<Arrays> {
    let array = |(name, own): (String, PyReadonlyArrayDyn<'_, f64>)| {
        let values = own.as_array().iter().copied().collect();
        let array = Array::new(own.shape().to_vec(), values).map_err(|error| raised(&error.at(&name)))?;
        Ok((name, array))
    };
    Ok(Arrays::Held(Arc::new(arrays.into_iter().map(array).collect::<PyResult<_>>()?)))
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
        let options = Options { budget, all, folder };
        let outcome = Claim::read(&text)?.recheck(&options, None)?;
        let not_rechecked = outcome.not_rechecked.iter().map(ToString::to_string).collect();
        let failures = outcome.failures.iter();
        let failures = failures.map(|own| (own.row as u64, own.place.clone(), own.why.to_string())).collect();
        let sample = outcome.sample.map(|(drawn, of)| (drawn as u64, of as u64));
        Ok((outcome.rows as u64, outcome.route.to_string(), sample, not_rechecked, failures))
    })
}
