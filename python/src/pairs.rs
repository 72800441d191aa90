//! Many pairs, side by side.

use std::sync::atomic::{AtomicBool, Ordering};

use kickdrift::error::{Error, Result};
use kickdrift::map::{Resources, decide_all};
use kickdrift::number::{Laurent, Rational};
use kickdrift::propagator::{Oscillator, TwoClocks};
use kickdrift::verdict::{Decision, Tier, Verdict};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyList;
use rayon::prelude::*;

use crate::job;
use crate::number::quantity;
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

/// Pairs that are held in memory together.
const TOGETHER: usize = 1 << 18;

/// The verdicts of pairs whose quantities are picked from four lists by four arrays of positions: positions in
/// `Verdict::ALL` and in `Tier::ALL`.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn verdicts<'py>(
    py: Python<'py>,
    values: [Bound<'py, PyList>; 4],
    positions: [PyReadonlyArray1<'py, i64>; 4],
    budget: Option<u64>,
    threads: usize,
) -> PyResult<(Bound<'py, PyArray1<u8>>, Bound<'py, PyArray1<u8>>)> {
    let mut quantities: [Vec<Laurent>; 4] = Default::default();
    for ((own, list), field) in quantities.iter_mut().zip(&values).zip(FIELDS) {
        let read = |(n, value): (usize, Bound<'_, PyAny>)| {
            // Reading holds the interpreter: it hears signals here.
            if n.is_multiple_of(BETWEEN_SIGNALS) {
                py.check_signals()?;
            }
            quantity(field, &value)
        };
        *own = list.iter().enumerate().map(read).collect::<PyResult<_>>()?;
    }
    let mut picked: [Vec<usize>; 4] = Default::default();
    for (own, array) in picked.iter_mut().zip(&positions) {
        *own = array.as_array().iter().map(|&n| n as usize).collect();
    }
    let (verdicts, tiers) = job::run(py, move |stopped| {
        let pairs = Pairs { quantities, picked };
        let resources = Resources { threads, limits: limits(budget), stopped: Some(stopped) };
        pairs.decide(&resources, stopped)
    })?;
    Ok((PyArray1::from_vec(py, verdicts), PyArray1::from_vec(py, tiers)))
}

struct Pairs {
    quantities: [Vec<Laurent>; 4],
    picked: [Vec<usize>; 4],
}

/// A pair over the rationals where it can be, else over ℚ[π, 1/π].
enum Clocks {
    Rational(TwoClocks<Rational>),
    Pi(TwoClocks<Laurent>),
}

impl Pairs {
    fn decide(&self, resources: &Resources, stopped: &AtomicBool) -> Result<(Vec<u8>, Vec<u8>)> {
        let count = self.picked[0].len();
        let (mut verdicts, mut tiers) = (vec![0; count], vec![0; count]);
        for first in (0..count).step_by(TOGETHER) {
            let range = first..count.min(first + TOGETHER);
            let clocks: Vec<Clocks> =
                range.into_par_iter().map(|n| self.clocks(n, stopped)).collect::<Result<_>>()?;
            let (mut rational, mut pi) = (Parts::default(), Parts::default());
            for (n, clocks) in (first..).zip(clocks) {
                match clocks {
                    Clocks::Rational(clocks) => rational.push(n, clocks),
                    Clocks::Pi(clocks) => pi.push(n, clocks),
                }
            }
            let decided = decide_all(&rational.clocks, resources)?.into_iter().zip(&rational.places);
            let others = decide_all(&pi.clocks, resources)?.into_iter().zip(&pi.places);
            for (Decision { verdict, decided_by }, &n) in decided.chain(others) {
                (verdicts[n], tiers[n]) = (verdict.index(), decided_by as u8);
            }
        }
        Ok((verdicts, tiers))
    }

    fn clocks(&self, n: usize, stopped: &AtomicBool) -> Result<Clocks> {
        if stopped.load(Ordering::Relaxed) {
            return Err(Error::stopped("the verdicts"));
        }
        let [lambda1, lambda2, h1, h2] = [0, 1, 2, 3].map(|k| self.quantities[k][self.picked[k][n]].clone());
        let clocks = Oscillator::new(lambda1, lambda2, h1, h2)?.clocks();
        Ok(clocks.as_rational().map_or(Clocks::Pi(clocks), Clocks::Rational))
    }
}

/// Pairs of one kind and where they belong.
struct Parts<S> {
    places: Vec<usize>,
    clocks: Vec<TwoClocks<S>>,
}

impl<S> Default for Parts<S> {
    fn default() -> Self {
        Parts { places: Vec::new(), clocks: Vec::new() }
    }
}

impl<S> Parts<S> {
    fn push(&mut self, place: usize, clocks: TwoClocks<S>) {
        self.places.push(place);
        self.clocks.push(clocks);
    }
}
