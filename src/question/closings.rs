//! Where tongues close.

use super::asking::{Question, Work, question};
use super::ratios::Ratios;
use crate::error::{Error, Result};
use crate::number::{Ratio, Rational};
use crate::parallel::try_map;
use crate::report::closings;
use crate::report::document::Document;
use crate::tongue::{self, Found, Labels, Search};

question! {
    /// The pairs (s, ρ) at which tongues of one ratio or of all are closed.
    struct Closings {
        /// h2/h1 = p/q.
        ratio: Option<Ratio>,
        /// In place of one ratio: all coprime p + q up to this number.
        max_sum: Option<u64>,
        /// Only these labels, of one ratio.
        m: Option<Labels>,
        /// The closed range of ρ, positive.
        rho_range: (Rational, Rational) = "1/10000..100",
        /// Values of ρ, evenly spaced in ln ρ, between which edges are seen to cross, where p + q > 24.
        samples: usize = "400",
        /// Significant digits of s and ρ.
        digits: u32 = "25",
    }
}

/// Searches cost p + q squared for each of the samples.
const MOST_SUM: u64 = 200;
/// Steps of a search unless a budget says otherwise: all ratios up to the largest sum at ten times the usual samples. And the seconds of one.
const MOST_COST: u64 = 1_000_000_000_000;
const STEP: f64 = 3e-7;
const MOST_SAMPLES: usize = 1_000_000;
/// The boxes are known to 2^-100 of their centres.
const MOST_DIGITS: u32 = 28;

impl Closings {
    /// The ratios that are searched.
    ///
    /// # Errors
    /// Neither one ratio nor a sum, a sum out of range.
    pub fn ratios(&self) -> Result<Ratios> {
        Ratios::of(self.ratio, self.max_sum)?.within(MOST_SUM)
    }

    fn words(&self) -> String {
        self.ratios().map(Ratios::words).unwrap_or_default()
    }

    /// (p + q)² for each of the samples.
    fn cost(&self, ratio: Ratio) -> u64 {
        ratio.kicks().saturating_pow(2).saturating_mul(self.samples as u64)
    }

    fn of_ratio(&self, ratio: Ratio) -> Result<Found> {
        let search = Search { m: None, rho: self.rho_range.clone(), samples: self.samples };
        match &self.m {
            None => tongue::closings(ratio, &search),
            Some(labels) => tongue::closings_of(ratio, &labels.0, &search),
        }
    }
}

impl Question for Closings {
    const NAME: &'static str = "closings";
    type Answer = Vec<Found>;

    fn answer(&self, work: &Work) -> Result<Vec<Found>> {
        let ratios = self.ratios()?;
        if matches!(ratios, Ratios::UpTo(_)) && self.m.is_some() {
            return Err(Error::input("m", "given with --max-sum", "labels are those of one --ratio"));
        }
        if !(2..=MOST_SAMPLES).contains(&self.samples) {
            return Err(Error::input("samples", self.samples, format!("choose 2 to {MOST_SAMPLES}")));
        }
        if !(1..=MOST_DIGITS).contains(&self.digits) {
            return Err(Error::input("digits", self.digits, format!("choose 1 to {MOST_DIGITS}")));
        }
        let list = ratios.list();
        let cost = list.iter().map(|ratio| self.cost(*ratio)).fold(0, u64::saturating_add);
        if cost > work.budget.unwrap_or(MOST_COST) {
            let name = format!("the closings of {} cost about {cost} steps of a search", ratios.words());
            return Err(Error::budget(name, cost).or("choose fewer samples, or ratios of smaller numbers"));
        }
        work.announce(&format!("the closings of {}", ratios.words()), cost as f64 * STEP);
        let bar = work.count(list.len() as u64, "ratios");
        try_map(&list, |&ratio| {
            let found = self.of_ratio(ratio);
            bar.advance(1);
            found
        })
    }

    fn show(&self, answer: &Vec<Found>) -> Document {
        let (lo, hi) = &self.rho_range;
        closings::document(answer, self.digits, &format!("{}, rho in {lo}..{hi}", self.words()))
    }
}
