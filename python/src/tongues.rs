//! Tongues, found once and written in each form.

use std::collections::BTreeMap;

use kickdrift::error::{Error, Result};
use kickdrift::format::Format;
use kickdrift::question::{self, Fields};
use kickdrift::report::csv;
use kickdrift::report::document::{Document, Layout};
use kickdrift::report::stream::JsonRows;
use kickdrift::report::table::Choice;
use kickdrift::report::tongues::{CAPTION, CAPTION_LATEX, TongueTally, needed, record};
use kickdrift::tongue::{Listing, Request, Selection, StepWindow, Stiffness, Tongue, Wanted};
use pyo3::prelude::*;

use crate::error::raised;
use crate::job;

/// All tongues that a question asks for.
#[pyclass(frozen, module = "kickdrift._native")]
pub struct Tongues {
    asked: question::Tongues,
    listing: Listing,
    columns: Columns,
    found: Vec<Tongue>,
}

/// What is asked for of each tongue beside its edges.
enum Columns {
    Usual,
    Groups,
    /// Columns by the names that CSV has.
    Named(Vec<String>),
}

/// The groups of columns, as the program names them.
const GROUPS: [&str; 5] = ["edges", "exact", "growth", "predicted", "first-order"];
/// Rows that may be computed, and those that a LaTeX table holds: as the program has them.
const MOST_ROWS: u64 = 30_000_000;
const MOST_ROWS_OF_LATEX: usize = 100_000;

/// Finds the tongues, with what the columns need, groups of them or the names that CSV has.
#[pyfunction]
pub fn tongues(
    py: Python<'_>,
    fields: BTreeMap<String, String>,
    columns: Option<Vec<String>>,
) -> PyResult<Tongues> {
    job::run(py, move |_| {
        let asked = read(fields)?;
        let (columns, wanted) = wanted(&asked, columns)?;
        let listing = asked.asked(wanted)?;
        allow(&asked, &listing)?;
        let mut found = Vec::new();
        listing.each(&(), |part| {
            found.extend_from_slice(part);
            Ok(())
        })?;
        Ok(Tongues { asked, listing, columns, found })
    })
}

/// The question; ρ is the quotient of both stiffnesses where they are given.
fn read(fields: BTreeMap<String, String>) -> Result<question::Tongues> {
    let is_rho_given = fields.contains_key("rho");
    let mut input: serde_json::Map<_, _> =
        fields.into_iter().map(|(name, text)| (name, text.into())).collect();
    input.entry("rho").or_insert_with(|| "0".into());
    let mut asked = question::Tongues::read(&input)?;
    asked.ratios()?;
    let rho = is_rho_given.then(|| asked.rho.clone());
    asked.rho = Stiffness::new(rho, asked.lambda1.clone(), asked.lambda2.clone())?.rho;
    Ok(asked)
}

fn wanted(asked: &question::Tongues, columns: Option<Vec<String>>) -> Result<(Columns, Wanted)> {
    let Some(names) = columns else {
        return Ok((Columns::Usual, Wanted { growth: asked.max_sum.is_none(), ..Wanted::all() }));
    };
    if names.iter().all(|name| GROUPS.contains(&name.as_str())) {
        let [_, exact, growth, predicted, first_order] =
            GROUPS.map(|group| names.iter().any(|name| name == group));
        return Ok((Columns::Groups, Wanted { family: true, exact, growth, predicted, first_order }));
    }
    let request = Request { lambda1: asked.lambda1.clone(), digits: asked.digits, ..Request::default() };
    let wanted = needed(&names, &request)?;
    Ok((Columns::Named(names), wanted))
}

/// That so many rows may be computed, where no window and no label says that they are fewer: p + q - 1 of
/// p/q.
fn allow(asked: &question::Tongues, listing: &Listing) -> Result<()> {
    let rows = listing.ratios.iter().map(|ratio| ratio.kicks() - 1).sum::<u64>();
    let is_whole = listing.window == StepWindow::default() && listing.selection == Selection::default();
    if !is_whole || rows <= MOST_ROWS {
        return Ok(());
    }
    let work =
        format!("the tongues of {} are {rows} rows, the budget is {MOST_ROWS}", asked.ratios()?.words());
    Err(Error::too_much(work, "choose a smaller --max-sum, or a window"))
}

#[pymethods]
impl Tongues {
    /// The document as json, csv or latex.
    fn render(&self, form: &str) -> PyResult<String> {
        let written = match form {
            "csv" => self.csv(),
            "latex" => self.latex(),
            _ => self.json(),
        };
        written.map_err(|error| raised(&error))
    }
}

impl Tongues {
    fn document(&self) -> Document {
        Document::new("tongues").inputs(self.asked.input())
    }

    fn tally(&self) -> TongueTally {
        let mut tally = TongueTally::default();
        self.found.iter().for_each(|tongue| tally.add(tongue));
        tally
    }

    fn json(&self) -> Result<String> {
        let mut bytes = Vec::new();
        let record = record(&self.listing.request, false);
        let head = self.document();
        let mut rows = JsonRows::begin(&mut bytes, &head, "tongues")?;
        self.found.iter().try_for_each(|tongue| rows.row(&record.entries(tongue).to_string()))?;
        rows.end(&self.tally().entries())?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    fn csv(&self) -> Result<String> {
        let mut bytes = Vec::new();
        let record = record(&self.listing.request, false);
        let all = record.columns();
        let choice = self.names().map(|names| Choice::new(&all, names)).transpose()?;
        let columns = choice.as_ref().map_or(&all[..], Choice::columns);
        csv::write_header(&mut bytes, columns)?;
        let rows = self.found.iter().map(|tongue| {
            let row = record.row(tongue);
            choice.as_ref().map_or_else(|| row.clone(), |choice| choice.row(&row))
        });
        csv::write_rows(&mut bytes, columns, rows)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// A table for paper, which has edges alone unless it is asked for more.
    fn latex(&self) -> Result<String> {
        if self.found.len() > MOST_ROWS_OF_LATEX {
            let cost = format!("{} rows are too many for a LaTeX table", self.found.len());
            return Err(Error::too_much(cost, "write csv or json"));
        }
        let mut request = self.listing.request.clone();
        if let Columns::Usual = self.columns {
            request.wanted = Wanted { family: true, ..Wanted::default() };
        }
        let record = record(&request, self.names().is_none());
        let mut table = record.table("tongues", CAPTION, []).captioned(CAPTION_LATEX);
        self.found.iter().for_each(|tongue| table.push(record.row(tongue)));
        let layout = Layout { columns: self.names().map(<[_]>::to_vec), digits: request.digits };
        let lines = self.tally().lines(&self.asked.words()?);
        self.document().summary(&lines).long_rows(table).laid_out(&layout)?.render(Format::Latex)
    }

    fn names(&self) -> Option<&[String]> {
        match &self.columns {
            Columns::Named(names) => Some(names),
            Columns::Usual | Columns::Groups => None,
        }
    }
}
