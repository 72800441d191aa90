//! Many pairs, side by side.

use kickdrift::map::{Pairs, Resources};
use kickdrift::number::Laurent;
use kickdrift::verdict::{Tier, Verdict};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::arguments::{Budget, Threads};
use crate::job::{self, Listener};
use crate::number::{is_refusal, quantity};
use crate::pair::limits;

/// lambda1, lambda2, h1, h2.
const FIELDS: [&str; 4] = ["lambda1", "lambda2", "h1", "h2"];

/// The names of verdicts, with the sign of the trace where it is ±2 or beyond, and of tiers, by their codes.
#[pyfunction]
pub fn names() -> (Vec<String>, Vec<&'static str>) {
    let sign = |verdict: Verdict| ["-", "", "+"][(verdict.side() + 1) as usize];
    let name = |verdict: Verdict| format!("{}{}", verdict.kind().name(), sign(verdict));
    (Verdict::ALL.map(name).to_vec(), Tier::ALL.map(Tier::name).to_vec())
}

/// Values that are read between two looks at signals, some milliseconds.
const BETWEEN_SIGNALS: usize = 4096;

/// The verdicts of pairs whose quantities are picked from four lists by four arrays of positions: positions
/// in `Verdict::ALL` and in `Tier::ALL`.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn verdicts<'py>(
    py: Python<'py>,
    values: [Bound<'py, PyList>; 4],
    positions: [PyReadonlyArray1<'py, i64>; 4],
    budget: Budget,
    threads: Threads,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyArray1<u8>>, Bound<'py, PyArray1<u8>>)> {
    let mut quantities: [Vec<Laurent>; 4] = Default::default();
    for ((own, list), field) in quantities.iter_mut().zip(&values).zip(FIELDS) {
        let read = |(n, value): (usize, Bound<'_, PyAny>)| {
            // Reading holds the interpreter: it hears signals here.
            if n.is_multiple_of(BETWEEN_SIGNALS) {
                py.check_signals()?;
            }
            quantity(field, &value).or_else(|error| match list.len() {
                2.. if is_refusal(py, &error) => quantity(&format!("{field}[{n}]"), &value),
                _ => Err(error),
            })
        };
        *own = list.iter().enumerate().map(read).collect::<PyResult<_>>()?;
    }
    let mut picked: [Vec<usize>; 4] = Default::default();
    for (own, array) in picked.iter_mut().zip(&positions) {
        *own = array.as_array().iter().map(|&n| n as usize).collect();
    }
    let listener = Listener { called: progress, total: picked[0].len() };
    let decided = job::run_heard(py, listener, move |stopped, done| {
        let resources = Resources {
            threads: threads.0,
            limits: limits(budget.0),
            stopped: Some(stopped),
            done: Some(done),
        };
        Pairs::new(quantities, picked)?.verdicts(&resources)
    })?;
    let verdicts = decided.iter().map(|decision| decision.verdict.index()).collect();
    let tiers = decided.iter().map(|decision| decision.decided_by as u8).collect();
    Ok((PyArray1::from_vec(py, verdicts), PyArray1::from_vec(py, tiers)))
}
