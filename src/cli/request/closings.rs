//! Where tongues close, as it is asked for.

use crate::cli::args::Common;
use crate::cli::progress::{announce, progress};
use crate::cli::ratios::Ratios;
use crate::error::{Error, Result};
use crate::number::{Ratio, Rational};
use crate::parallel::try_map;
use crate::report::closings;
use crate::report::document::Document;
use crate::scene::shown_range;
use crate::tongue::{self, Found, Labels, Search};

/// All that `closings` asks.
#[derive(Clone, Debug)]
pub struct Question {
    pub ratios: Ratios,
    pub m: Option<Labels>,
    pub rho: (Rational, Rational),
    pub samples: usize,
    pub digits: u32,
}

/// Searches cost p + q squared for each of the samples.
const MOST_SUM: u64 = 200;
/// Steps of a search unless a budget says otherwise: all ratios up to the largest sum at ten times the usual samples. And the seconds of one.
const MOST_COST: u64 = 1_000_000_000_000;
const STEP: f64 = 1e-7;
const MOST_SAMPLES: usize = 1_000_000;
/// The boxes are known to 2^-100 of their centres.
const MOST_DIGITS: u32 = 28;

impl Question {
    /// The question, if it makes sense.
    ///
    /// # Errors
    /// A sum, a number of samples or digits out of range, labels of many ratios.
    pub fn new(
        ratios: Ratios,
        m: Option<Labels>,
        rho: (Rational, Rational),
        samples: usize,
        digits: u32,
    ) -> Result<Self> {
        let ratios = ratios.within(MOST_SUM)?;
        if matches!(ratios, Ratios::UpTo(_)) && m.is_some() {
            return Err(Error::input("m", "given with --max-sum", "labels are those of one --ratio"));
        }
        if !(2..=MOST_SAMPLES).contains(&samples) {
            return Err(Error::input("samples", samples, format!("choose 2 to {MOST_SAMPLES}")));
        }
        if !(1..=MOST_DIGITS).contains(&digits) {
            return Err(Error::input("digits", digits, format!("choose 1 to {MOST_DIGITS}")));
        }
        Ok(Question { ratios, m, rho, samples, digits })
    }

    /// The document `kickdrift/closings/1`; its rows with all columns, or with those that fit paper.
    ///
    /// # Errors
    /// As [`tongue::closings`].
    pub fn document(&self, common: &Common, all_columns: bool) -> Result<Document> {
        let list = self.ratios.list();
        let cost = list.iter().map(|ratio| self.cost(*ratio)).fold(0, u64::saturating_add);
        if cost > common.budget.unwrap_or(MOST_COST) {
            let work = format!("the closings of {} cost about {cost} steps of a search", self.ratios.words());
            return Err(Error::budget(work, cost).or("choose fewer samples, or ratios of smaller numbers"));
        }
        announce(common.quiet, &format!("the closings of {}", self.ratios.words()), cost as f64 * STEP);
        let bar = progress(common.quiet, list.len() as u64, "ratios");
        let one = |&ratio: &Ratio| {
            let found = self.of_ratio(ratio);
            bar.inc(1);
            found
        };
        let found: Vec<Found> = try_map(&list, one)?;
        bar.finish_and_clear();
        let (lo, hi) = &self.rho;
        let what = format!("{}, rho in {lo}..{hi}", self.ratios.words());
        Ok(self.echo(closings::document(&found, self.digits, &what, all_columns)))
    }

    /// (p + q)² for each of the samples.
    fn cost(&self, ratio: Ratio) -> u64 {
        ratio.kicks().saturating_pow(2).saturating_mul(self.samples as u64)
    }

    fn of_ratio(&self, ratio: Ratio) -> Result<Found> {
        let search = Search { m: None, rho: self.rho.clone(), samples: self.samples };
        match &self.m {
            None => tongue::closings(ratio, &search),
            Some(labels) => tongue::closings_of(ratio, &labels.0, &search),
        }
    }

    fn echo(&self, document: Document) -> Document {
        let labels = self.m.iter().map(|labels| ("m", labels.to_string()));
        self.ratios
            .echo(document)
            .inputs(labels)
            .input("rho_range", shown_range(&self.rho))
            .input("samples", self.samples)
            .input("digits", self.digits)
    }
}
