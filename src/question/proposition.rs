//! The Proposition, checked exhaustively.

use super::asking::{Question, Work, question};
#[cfg(feature = "cli")]
use super::field::flag;
use crate::error::{Error, Result};
use crate::report::document::Document;
use crate::report::proposition;
use crate::resonance::proposition::{Check, Witness, check};

question! {
    /// The Proposition for all coprime p, q up to a number, with all witnesses.
    args struct Proposition {
        /// All coprime p, q up to this number.
        #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = flag::<u64>)]
        max: u64 = "60",
    }
}

/// Witnesses beyond this bound alone would fill gigabytes.
const LARGEST_MAX: u64 = 400;

/// Seconds for each of max³ (1 + ln max) points and curves.
const POINT: f64 = 1.5e-6;

impl Question for Proposition {
    const NAME: &'static str = "proposition";
    const EXAMPLES: &'static [&'static str] = &["proposition --max 12"];
    type Answer = (Check, Vec<Witness>);

    fn answer(&self, work: &Work) -> Result<Self::Answer> {
        let max = self.max;
        if !(1..=LARGEST_MAX).contains(&max) {
            let remedy = format!("choose 1 to {LARGEST_MAX}; the number of witnesses grows like its cube");
            return Err(Error::input("max", max, remedy));
        }
        let name = format!("the Proposition up to {max}");
        if max.pow(3) > work.limits().kicks {
            let cost = format!("{name} has about {} points and curves", max.pow(3));
            return Err(Error::budget(cost, max.pow(3)).or("choose a smaller --max"));
        }
        work.announce(&name, (max as f64).powi(3) * (1.0 + (max as f64).ln()) * POINT);
        let mut witnesses = Vec::new();
        let check = check(max, |witness| witnesses.push(*witness));
        Ok((check, witnesses))
    }

    fn show(&self, (check, witnesses): &Self::Answer) -> Document {
        proposition::document(self.max, check, witnesses)
    }
}
