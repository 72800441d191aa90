//! The half period of one ratio in s and ρ.

use super::asking::{Question, Work, question};
#[cfg(feature = "cli")]
use super::field::flag;
use crate::error::{Error, Result};
use crate::number::Ratio;
use crate::report::document::Document;
use crate::report::polynomial;

question! {
    /// A, B, C, D and the trace of one ratio as polynomials in s and ρ.
    args struct Polynomial {
        /// h2/h1 = p/q.
        #[arg(long, value_name = "P/Q", allow_hyphen_values = true, value_parser = flag::<Ratio>)]
        ratio: Ratio,
    }
}

/// The largest p + q of polynomials unless a budget says otherwise: the entries have about p q/4 terms, with coefficients
/// of some p + q digits.
const MOST_KICKS: u64 = 120;

impl Question for Polynomial {
    const NAME: &'static str = "polynomial";
    const EXAMPLES: &'static [&'static str] =
        &["polynomial --ratio 5/3", "polynomial --ratio 5/3 --format latex"];
    type Answer = polynomial::Polynomials;

    fn answer(&self, work: &Work) -> Result<Self::Answer> {
        let (ratio, most) = (self.ratio, work.budget.unwrap_or(MOST_KICKS));
        if ratio.kicks() > most {
            let terms = u128::from(ratio.p()) * u128::from(ratio.q()) / 4 + 1;
            let cost = format!("polynomials of {ratio} have about {terms} terms each");
            return Err(Error::budget(cost, ratio.kicks()).or(format!("choose p + q <= {most}")));
        }
        Ok(polynomial::polynomials(ratio))
    }

    fn show(&self, answer: &Self::Answer) -> Document {
        polynomial::document(self.ratio, answer)
    }
}
