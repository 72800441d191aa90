//! `kickdrift verify`: every row of a document rechecked by another route than the one that made it.
//!
//! | document | made by | rechecked by |
//! |---|---|---|
//! | tongues | Rayleigh quotients of a string in doubles | exact signs of the half period at the ends of each enclosure |
//! | survey | the same | exact signs about the edges of the thin tongues |
//! | closings | Newton's method and Krawczyk's test | exact signs: the edges' order at both ends of the range of rho |
//! | verdict | the filter, as a rule | the full period, kick by kick, in exact arithmetic |
//! | map | the filter, as a rule | the refine tier, kick by kick |
//! | compare | the half period and the tan criterion | the full period, and θ enclosed |
//! | curves | arcsines | arctangents |
//! | polynomial | products of polynomials | the full period at rational points |
//! | proposition | Bézout's identity | eqs. (9) and (10) in integers |

mod closings;
mod curves;
mod exact;
mod integers;
mod listing;
mod plane;
mod read;
mod survey;
mod tongues;
mod verdict;

use std::path::PathBuf;

use crate::parallel::*;
use serde_json::{Value, json};

use super::args::Common;
use super::progress::progress;
use crate::error::{Error, Result};
use crate::format::Format;
use crate::report::document::Document;
use crate::verdict::Limits;
use read::{Fault, Row};

/// Flags of `verify`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A JSON document that kickdrift wrote.
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

/// What was found: how many rows, by which route, and those that do not hold.
pub struct Outcome {
    rows: u64,
    route: &'static str,
    /// (row from 1, its name, what is wrong), in order.
    failures: Vec<(u64, String, String)>,
}

/// What a check needs beside the document.
pub struct Context<'a> {
    limits: Limits,
    common: &'a Common,
}

type Check = fn(&Value, &Context) -> Result<Outcome>;

/// The documents that can be rechecked.
const CHECKS: [(&str, Check); 9] = [
    ("tongues", tongues::check),
    ("closings", closings::check),
    ("survey", survey::check),
    ("verdict", verdict::check),
    ("map", plane::check_map),
    ("compare", plane::check_compare),
    ("curves", curves::check),
    ("polynomial", integers::check_polynomial),
    ("proposition", integers::check_proposition),
];

/// Failures told in JSON; the count tells the rest.
const MOST_TOLD: usize = 100;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let document = self.read()?;
        let file = self.file.display().to_string();
        let names = || CHECKS.map(|(name, _)| name).join(", ");
        let schema = document["schema"].as_str().unwrap_or("");
        let name = schema.strip_prefix("kickdrift/").and_then(|rest| rest.strip_suffix("/1"));
        let Some((name, check)) = CHECKS.into_iter().find(|(known, _)| Some(*known) == name) else {
            let remedy = format!("verify rechecks kickdrift/NAME/1, NAME one of {}", names());
            return Err(Error::input(&format!("schema of {file}"), schema, remedy));
        };
        let outcome = check(&document, &Context { limits: common.limits(), common })?;
        if let Some((row, place, why)) = outcome.failures.first() {
            let (failed, rows) = (outcome.failures.len(), outcome.rows);
            let told = format!("{why} ({failed} of {rows} rows of {file} fail)");
            return Err(Error::input(&format!("row {row} of {name}"), place, told));
        }
        common.write(&outcome.document(&file, name), Format::Text)
    }

    fn read(&self) -> Result<Value> {
        let file = self.file.display();
        let bytes = std::fs::read(&self.file).map_err(|cause| {
            Error::io(&file, format!("cannot read it ({cause}): name a JSON document that kickdrift wrote"))
                .caused_by(cause)
        })?;
        serde_json::from_slice(&bytes).map_err(|cause| {
            Error::input(
                "file",
                &file,
                format!("is no JSON ({cause}): verify reads documents of --format json"),
            )
        })
    }
}

impl Outcome {
    fn document(&self, file: &str, name: &str) -> Document {
        let failures: Vec<Value> = (self.failures.iter().take(MOST_TOLD))
            .map(|(row, place, why)| json!({"row": row, "place": place, "why": why}))
            .collect();
        let holding = self.rows - self.failures.len() as u64;
        Document::new("verify")
            .input("file", file)
            .entry("document", format!("kickdrift/{name}/1"))
            .entry("rows", self.rows)
            .entry("holding", holding)
            .entry("route", self.route)
            .entry("failures", failures)
            .told(&[
                format!("{holding} of {} rows hold", self.rows),
                format!("  document     {name}"),
                format!("  route        {}", self.route),
            ])
    }
}

impl Context<'_> {
    /// Checks all rows in parallel.
    fn rows(
        &self,
        rows: &[Value],
        route: &'static str,
        check: impl Fn(&Row) -> std::result::Result<(), Fault> + Sync,
    ) -> Result<Outcome> {
        let bar = progress(self.common.quiet, rows.len() as u64, "rows");
        let one = |(i, value): (usize, &Value)| {
            let row = Row::new(value);
            let outcome = match check(&row) {
                Ok(()) => Ok(None),
                Err(Fault::Wrong(why)) => Ok(Some((i as u64 + 1, row.place(), why))),
                Err(Fault::Error(error)) => Err(error),
            };
            bar.inc(1);
            outcome
        };
        let failures: Vec<Option<_>> = rows.par_iter().enumerate().map(one).collect::<Result<_>>()?;
        bar.finish_and_clear();
        Ok(Outcome { rows: rows.len() as u64, route, failures: failures.into_iter().flatten().collect() })
    }
}
