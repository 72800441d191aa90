//! The program itself, and the questions that it answers.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

use kickdrift::cli;
use kickdrift::error::Error;
use kickdrift::format::Format;
use kickdrift::question::{self, Work};
use kickdrift::recheck::{CheckedDocument, Options};
use kickdrift::report::document::Document;
use kickdrift::report::figure::file;
use kickdrift::scene::{Array, Arrays};
use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arguments::Budget;
use crate::error::raised;
use crate::job;

/// Runs the program with the arguments, its own name first; its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::program(arguments))
}

/// The document that answers a question, in each of its forms.
#[pyclass(frozen)]
pub struct Answer(Document);

/// Below an answer in a few lines.
const MORE: &str = "more: the whole answer and its tables in .details";

#[pymethods]
impl Answer {
    /// The document as json, csv, latex or text, or a text with all "details".
    fn render(&self, form: &str) -> PyResult<String> {
        if form == "details" {
            let text = self.0.clone().detailed().render(Format::Text);
            return text.map(|text| in_python(&text)).map_err(|error| raised(&error));
        }
        let format = Format::DOCUMENT.into_iter().find(|format| format.name() == form);
        let format =
            format.ok_or_else(|| raised(&Error::input("form", form, "is json, csv, latex or text")))?;
        let text = self.0.clone().below_answer(MORE).render(format).map_err(|error| raised(&error))?;
        Ok(if format == Format::Text { in_python(&text) } else { text })
    }
}

/// Flags that a text names, and the keywords that stand for them.
const KEYWORDS: [(&str, &str); 5] = [
    ("--harmonic", "harmonic=True"),
    ("--constraints h-bonds", "constraints=\"h-bonds\""),
    ("--constraints OH", "constraints=\"OH\""),
    ("--on angle=1", "on={\"angle\": 1}"),
    ("add --hmr", "give hmr"),
];

/// A text that tells a shell what to type, for Python.
fn in_python(text: &str) -> String {
    KEYWORDS.iter().fold(text.to_string(), |text, (flag, keyword)| text.replace(flag, keyword))
}

/// A field of a question: its text, or the texts of its parts.
#[derive(FromPyObject)]
pub enum Given {
    One(String),
    Several(Vec<String>),
}

/// Where the arrays are that a system refers to: in memory by name, or in a folder.
#[derive(FromPyObject)]
pub enum Place<'py> {
    Held(BTreeMap<String, PyReadonlyArrayDyn<'py, f64>>),
    Folder(PathBuf),
}

type Fields = serde_json::Map<String, serde_json::Value>;

fn read(fields: BTreeMap<String, Given>, place: Option<Place<'_>>) -> PyResult<(Fields, Arrays)> {
    let field = |(name, own)| match own {
        Given::One(text) => (name, text.into()),
        Given::Several(all) => (name, all.into()),
    };
    let arrays = match place {
        Some(Place::Held(arrays)) => held(arrays)?,
        Some(Place::Folder(folder)) => folder.as_path().into(),
        None => Arrays::from(""),
    };
    Ok((fields.into_iter().map(field).collect(), arrays))
}

/// Answers a question: its name, its fields, and where the arrays are that it refers to.
#[pyfunction]
#[pyo3(signature = (name, fields, budget = Budget(None), place = None))]
pub fn ask(
    py: Python<'_>,
    name: String,
    fields: BTreeMap<String, Given>,
    budget: Budget,
    place: Option<Place<'_>>,
) -> PyResult<Answer> {
    let (fields, arrays) = read(fields, place)?;
    job::run(py, move |_| {
        let work = Work { budget: budget.0, arrays: Some(&arrays), ..Work::default() };
        question::ask(&name, &fields, &work).map(Answer)
    })
}

/// Draws the same answer, as the text of a file of SVG that carries a command.
#[pyfunction]
pub fn draw(
    py: Python<'_>,
    name: String,
    fields: BTreeMap<String, Given>,
    budget: Budget,
    place: Option<Place<'_>>,
    command: String,
) -> PyResult<String> {
    let (fields, arrays) = read(fields, place)?;
    job::run(py, move |_| {
        let work = Work { budget: budget.0, arrays: Some(&arrays), ..Work::default() };
        let nothing = || Error::input("figure", &name, "has nothing to draw");
        let figure = question::draw(&name, &fields, &work)?.ok_or_else(nothing)?;
        Ok(String::from_utf8_lossy(&file(figure, &command, Format::Svg)?).into_owned())
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

/// How many rows hold, by which route, the sample drawn, what is not rechecked, and the rows that fail with
/// what they say and why that is wrong.
type Outcome = (u64, String, Option<(u64, u64)>, Vec<String>, Vec<(u64, String, String)>);

/// Finds the claims of a document again by another route.
#[pyfunction]
pub fn recheck(
    py: Python<'_>,
    text: String,
    all: bool,
    budget: Budget,
    folder: PathBuf,
) -> PyResult<Outcome> {
    job::run(py, move |_| {
        let options = Options { budget: budget.0, all, folder };
        let outcome = CheckedDocument::read(&text)?.verify(&options, None)?;
        let not_rechecked = outcome.not_rechecked.iter().map(ToString::to_string).collect();
        let failures = outcome.failures.iter();
        let failures = failures.map(|own| (own.row, own.place.clone(), own.why.to_string())).collect();
        let sample = outcome.sample;
        Ok((outcome.rows, outcome.route.to_string(), sample, not_rechecked, failures))
    })
}
