//! All tongues of all ratios, counted and compared.

use super::asking::{Question, Work, question};
use super::ratios::{MOST_SUM, Ratios};
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::report::document::Document;
use crate::report::survey;
use crate::tongue;

question! {
    /// All tongues of all coprime p + q up to a sum that begin below s = 4: counts, widths, the thinnest ones listed.
    struct Survey {
        /// The largest p + q.
        max_sum: u64,
        /// λ2/λ1.
        rho: Rational,
        /// Tongues that are listed.
        thinnest: usize = "10",
    }
}

/// Thin tongues listed unless a number is given, and at most.
pub const THINNEST: usize = 10;
const MOST_THIN: usize = 100_000;

impl Question for Survey {
    const NAME: &'static str = "survey";
    type Answer = tongue::Survey;

    fn answer(&self, _: &Work) -> Result<tongue::Survey> {
        if self.thinnest > MOST_THIN {
            return Err(Error::input("thinnest", self.thinnest, format!("choose at most {MOST_THIN}")));
        }
        Ratios::UpTo(self.max_sum).within(MOST_SUM)?;
        tongue::survey(self.max_sum, &self.rho, self.thinnest)
    }

    fn show(&self, answer: &tongue::Survey) -> Document {
        survey::document(answer)
    }
}
