//! One ratio of steps, or all up to a sum: what tongues and closings range over.

use plot::Foot;

use number::Ratio;
use number::error::{Error, Result};

/// The largest p + q of all ratios: there are 1.2 million of them below 2000.
pub const MOST_SUM: u64 = 2000;

/// One ratio, or all coprime p + q up to a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ratios {
    One(Ratio),
    UpTo(u64),
}

impl Ratios {
    /// The ratios of two fields, of which one is given.
    ///
    /// # Errors
    /// Neither or both.
    pub fn of(ratio: Option<Ratio>, max_sum: Option<u64>) -> Result<Ratios> {
        match (ratio, max_sum) {
            (Some(ratio), None) => Ok(Ratios::One(ratio)),
            (None, Some(max_sum)) => Ok(Ratios::UpTo(max_sum)),
            (Some(_), Some(_)) => Err(Error::input("ratio", "given with --max-sum", "give one of them")),
            (None, None) => {
                Err(Error::missing("ratio", "give --ratio P/Q, or --max-sum N for all p + q <= N"))
            }
        }
    }

    /// The fields `ratio` and `max_sum`.
    pub fn fields(self) -> (Option<Ratio>, Option<u64>) {
        match self {
            Ratios::One(ratio) => (Some(ratio), None),
            Ratios::UpTo(max_sum) => (None, Some(max_sum)),
        }
    }

    /// These ratios, if there are not too many.
    ///
    /// # Errors
    /// A sum that is not in 2..=`most`.
    pub fn within(self, most: u64) -> Result<Ratios> {
        match self {
            Ratios::UpTo(max_sum) if !(2..=most).contains(&max_sum) => {
                Err(Error::input("max-sum", max_sum, format!("choose 2 to {most}")))
            }
            _ => Ok(self),
        }
    }

    /// All of them, by p + q, then p.
    pub fn list(self) -> Vec<Ratio> {
        match self {
            Ratios::One(ratio) => vec![ratio],
            Ratios::UpTo(max_sum) => Ratio::up_to(max_sum).collect(),
        }
    }

    /// In words.
    pub fn words(self) -> String {
        match self {
            Ratios::One(ratio) => format!("h2/h1 = {ratio}"),
            Ratios::UpTo(max_sum) => format!("all h2/h1 = p/q, p + q <= {max_sum}"),
        }
    }

    /// Below a figure.
    #[must_use]
    pub fn below(self, foot: Foot) -> Foot {
        match self {
            Ratios::One(ratio) => foot.value("*h*_2/*h*_1", ratio),
            Ratios::UpTo(max_sum) => foot.part(format!("all *h*_2/*h*_1 = *p*/*q*, *p* + *q* ≤ {max_sum}")),
        }
    }
}
