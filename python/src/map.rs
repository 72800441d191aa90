//! The verdicts of a grid as NumPy arrays, each made once.

use std::sync::atomic::AtomicBool;

use kickdrift::error::{Result, filled};
use kickdrift::format::Format;
use kickdrift::map::{Band, Counters, Grid, Growing, Map as Task, Resources};
use kickdrift::number::Laurent;
use kickdrift::question::{self, Question};
use kickdrift::report::csv;
use kickdrift::report::figure::file;
use kickdrift::report::map::{MapTally, Rows, marked};
use kickdrift::report::plane::{Chart, Colouring};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::{Budget, Threads};
use crate::error::raised;
use crate::job;
use crate::number::quantity;
use crate::pair::{form, limits};

/// Columns of all pairs, column by column.
#[derive(Default)]
struct Arrays {
    verdict: Vec<u8>,
    tier: Vec<u8>,
    labels: Option<[Vec<i64>; 3]>,
    rates: Option<[Vec<f64>; 2]>,
}

/// A computed map without its arrays, which Python holds.
#[pyclass(frozen, module = "kickdrift._native")]
pub struct Map {
    asked: question::Map,
    grid: Grid,
    tally: MapTally,
    parts: Vec<Part>,
}

/// A band without its verdicts and tiers.
struct Part {
    first: u64,
    columns: usize,
    growing: Vec<Growing>,
}

/// The first and the last multiplier of the columns and of the rows of a grid.
#[pyfunction]
pub fn multipliers(
    stiffness: [Bound<'_, PyAny>; 2],
    steps: [Bound<'_, PyAny>; 2],
    ranges: [[Bound<'_, PyAny>; 2]; 2],
) -> PyResult<[(u64, u64); 2]> {
    let (_, grid) = asked(&stiffness, &steps, &ranges, (false, false))?;
    Ok([grid.columns(), grid.rows()])
}

/// Decides all pairs of a grid: the map, and its arrays by name.
#[pyfunction]
pub fn map<'py>(
    py: Python<'py>,
    stiffness: [Bound<'py, PyAny>; 2],
    steps: [Bound<'py, PyAny>; 2],
    ranges: [[Bound<'py, PyAny>; 2]; 2],
    products: (bool, bool),
    budget: Budget,
    threads: Threads,
) -> PyResult<(Map, Bound<'py, PyDict>)> {
    let (asked, grid) = asked(&stiffness, &steps, &ranges, products)?;
    let (map, arrays) = job::run(py, move |stopped| {
        let mut map = Map { asked, grid, tally: MapTally::default(), parts: Vec::new() };
        let arrays = map.compute(threads.0, budget.0, stopped)?;
        Ok((map, arrays))
    })?;
    let arrays = arrays.into_python(py, &map.grid)?;
    Ok((map, arrays))
}

/// The question, and its grid.
fn asked(
    stiffness: &[Bound<'_, PyAny>; 2],
    steps: &[Bound<'_, PyAny>; 2],
    [h1, h2]: &[[Bound<'_, PyAny>; 2]; 2],
    (label, growth): (bool, bool),
) -> PyResult<(question::Map, Grid)> {
    let both = |names: [&str; 2], [x, y]: &[Bound<'_, PyAny>; 2]| -> PyResult<[Laurent; 2]> {
        Ok([quantity(names[0], x)?, quantity(names[1], y)?])
    };
    let [lambda1, lambda2] = both(["lambda1", "lambda2"], stiffness)?;
    let [step1, step2] = both(["step1", "step2"], steps)?;
    let [h1_range, h2_range] = [both(["h1", "h1"], h1)?, both(["h2", "h2"], h2)?].map(|[lo, hi]| (lo, hi));
    let products = question::Map { label, growth, ..question::Map::default() };
    let asked = question::Map { lambda1, lambda2, step1, step2, h1_range, h2_range, ..products };
    let grid = asked.grid().map_err(|error| raised(&error))?;
    Ok((asked, grid))
}

impl Map {
    fn compute(&mut self, threads: usize, budget: Option<u64>, stopped: &AtomicBool) -> Result<Arrays> {
        let Map { asked, grid, tally, parts } = self;
        let products = asked.products();
        let resources = Resources { threads, limits: limits(budget), stopped: Some(stopped), done: None };
        let (pairs, task) = (grid.pairs(), Task::of(grid).with(products).within(resources));
        task.allow()?;
        let mut arrays = Arrays { verdict: filled(0, pairs)?, tier: filled(0, pairs)?, ..Arrays::default() };
        if products.label {
            arrays.labels = Some([filled(-1, pairs)?, filled(0, pairs)?, filled(0, pairs)?]);
        }
        if products.growth {
            arrays.rates = Some([filled(f64::NAN, pairs)?, filled(f64::NAN, pairs)?]);
        }
        let mut first = 0;
        task.for_each_band(|_, band| {
            tally.add(grid, &band);
            arrays.put(grid, first, &band);
            first += band.verdicts.len();
            parts.push(Part { first: band.first, columns: band.columns, growing: band.growing });
            Ok(())
        })?;
        Ok(arrays)
    }

    /// The bands as they were decided, from the arrays.
    fn bands<'a>(&'a self, verdicts: &'a [u8], tiers: &'a [u8]) -> impl Iterator<Item = Band> + 'a {
        let rows = self.grid.shape().1;
        let mut end = 0;
        self.parts.iter().map(move |Part { first, columns, growing }| {
            let pairs = end..end + columns * rows;
            end = pairs.end;
            let (verdicts, tiers) = (verdicts[pairs.clone()].to_vec(), tiers[pairs].to_vec());
            let (growing, counters) = (growing.clone(), Counters::default());
            Band { first: *first, columns: *columns, rows, verdicts, tiers, growing, counters }
        })
    }
}

impl Arrays {
    /// A band whose first pair is the one of this number.
    fn put(&mut self, grid: &Grid, first: usize, band: &Band) {
        let places = first..first + band.verdicts.len();
        self.verdict[places.clone()].copy_from_slice(&band.verdicts);
        self.tier[places].copy_from_slice(&band.tiers);
        if band.growing.is_empty() {
            return;
        }
        for pair in marked(grid, band) {
            let Some(growing) = pair.growing else { continue };
            let (n, found) = (first + growing.position as usize, pair.found());
            if let Some([m, a, b]) = &mut self.labels {
                m[n] = found.m.map_or(-1, |m| m as i64);
                (a[n], b[n]) = found.family.unwrap_or_default();
            }
            if let (Some([rate, error]), Some(own)) = (&mut self.rates, found.rate) {
                (rate[n], error[n]) = (own.middle(), own.error());
            }
        }
    }

    fn into_python<'py>(self, py: Python<'py>, grid: &Grid) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        let each = |(first, last): (u64, u64)| first..=last;
        let steps = |steps: Vec<f64>| PyArray1::from_vec(py, steps);
        all.set_item("h1", steps(each(grid.columns()).map(|i| grid.h1(i).to_f64()).collect()))?;
        all.set_item("h2", steps(each(grid.rows()).map(|j| grid.h2(j).to_f64()).collect()))?;
        all.set_item("verdict", shaped(py, grid, self.verdict)?)?;
        all.set_item("tier", shaped(py, grid, self.tier)?)?;
        for (name, values) in ["m", "a", "b"].into_iter().zip(self.labels.into_iter().flatten()) {
            all.set_item(name, shaped(py, grid, values)?)?;
        }
        for (name, values) in
            ["growth_rate", "growth_rate_error"].into_iter().zip(self.rates.into_iter().flatten())
        {
            all.set_item(name, shaped(py, grid, values)?)?;
        }
        Ok(all)
    }
}

/// The vector itself as an array (columns, rows): nothing is copied.
fn shaped<'py, T: numpy::Element>(
    py: Python<'py>,
    grid: &Grid,
    values: Vec<T>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let (columns, rows) = grid.shape();
    PyArray1::from_vec(py, values).reshape([columns, rows])
}

#[pymethods]
impl Map {
    /// The document in the form json or text; tables of many rows are the program's.
    fn render(&self, format: &str) -> PyResult<String> {
        let mut document = self.asked.document(&self.tally);
        if self.tally.counts.marked() == 0 {
            document = document.long_rows(Rows::new(&self.grid, self.asked.products()).table(&[]));
        }
        document.render(form(format)).map_err(|error| raised(&error))
    }

    /// The pairs that are not plainly stable as CSV, from the arrays.
    fn csv(&self, verdict: &Bound<'_, PyArray2<u8>>, tier: &Bound<'_, PyArray2<u8>>) -> PyResult<String> {
        let (verdict, tier) = (verdict.readonly(), tier.readonly());
        let (verdict, tier) = (verdict.as_slice()?, tier.as_slice()?);
        let mut rows = Rows::new(&self.grid, self.asked.products());
        let (columns, mut text) = (rows.columns(), Vec::new());
        let written = csv::write_header(&mut text, &columns).and_then(|()| {
            self.bands(verdict, tier).try_for_each(|band| {
                let cells = marked(&self.grid, &band).map(|pair| rows.cells(&pair));
                csv::write_rows(&mut text, &columns, cells)
            })
        });
        written.map_err(|error| raised(&error))?;
        Ok(String::from_utf8_lossy(&text).into_owned())
    }

    /// The picture of the verdicts, or of the biases of stable pairs, from the arrays.
    fn svg(
        &self,
        verdict: &Bound<'_, PyArray2<u8>>,
        tier: &Bound<'_, PyArray2<u8>>,
        by_bias: bool,
    ) -> PyResult<String> {
        let (verdict, tier) = (verdict.readonly(), tier.readonly());
        let (verdict, tier) = (verdict.as_slice()?, tier.as_slice()?);
        let (colouring, flag) =
            if by_bias { (Colouring::Bias, " --colour bias") } else { (Colouring::Verdict, "") };
        let mut chart = Chart::new(&self.grid, colouring);
        self.bands(verdict, tier).for_each(|band| chart.add(&self.grid, &band));
        let figure = chart.figure(&self.grid, &self.tally.counts, &[]).footed(&self.asked.foot());
        let bytes = file(figure, &(self.asked.bare().command() + flag), Format::Svg)
            .map_err(|error| raised(&error))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}
