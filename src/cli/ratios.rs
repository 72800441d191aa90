//! One ratio of steps, or all up to a sum: what `tongues` and `closings` range over.

use plot::Foot;

use super::args::{of, whole};
use crate::error::{Error, Result};
use crate::number::Ratio;
use crate::number::parse::parse_ratio;
use crate::report::document::Document;

/// The flags that say which.
#[derive(Debug, clap::Args)]
pub struct Flags {
    /// h2/h1 = p/q; several, as 5/3,7/2, for a diagram.
    #[arg(long, value_name = "P/Q", allow_hyphen_values = true, value_delimiter = ',', value_parser = of(parse_ratio))]
    ratio: Vec<Ratio>,
    /// All coprime p + q up to this number.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64>)]
    max_sum: Option<u64>,
}

impl Flags {
    /// Whether a sum is given.
    pub fn many(&self) -> bool {
        self.max_sum.is_some()
    }

    /// The ratios that were named, one or more.
    ///
    /// # Errors
    /// None, or a sum in their place.
    pub fn several(&self) -> Result<&[Ratio]> {
        match (&self.ratio[..], self.max_sum) {
            (named @ [_, ..], None) => Ok(named),
            _ => Err(Error::missing(
                "ratio",
                "a diagram is of ratios by name: give --ratio P/Q or --ratio P/Q,P/Q",
            )),
        }
    }

    /// The ratios.
    ///
    /// # Errors
    /// Neither flag or both.
    pub fn ratios(&self) -> Result<Ratios> {
        match (&self.ratio[..], self.max_sum) {
            (&[ratio], None) => Ok(Ratios::One(ratio)),
            ([_, second, ..], None) => Err(Error::input("ratio", second, "is one too many: give one")),
            ([], Some(max_sum)) => Ok(Ratios::UpTo(max_sum)),
            (_, Some(_)) => Err(Error::input("ratio", "given with --max-sum", "give one of them")),
            ([], None) => Err(Error::missing("ratio", "give --ratio P/Q, or --max-sum N for all p + q <= N")),
        }
    }
}

/// One ratio, or all coprime p + q up to a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ratios {
    One(Ratio),
    UpTo(u64),
}

impl Ratios {
    /// The same, if there are not too many.
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

    /// Below a figure.
    pub fn below(self, foot: Foot) -> Foot {
        match self {
            Ratios::One(ratio) => foot.value("*h*_2/*h*_1", ratio),
            Ratios::UpTo(max_sum) => foot.part(format!("all *h*_2/*h*_1 = *p*/*q*, *p* + *q* ≤ {max_sum}")),
        }
    }

    /// In words.
    pub fn words(self) -> String {
        match self {
            Ratios::One(ratio) => format!("h2/h1 = {ratio}"),
            Ratios::UpTo(max_sum) => format!("all h2/h1 = p/q, p + q <= {max_sum}"),
        }
    }

    /// Echoed as input.
    pub fn echo(self, document: Document) -> Document {
        match self {
            Ratios::One(ratio) => document.input("ratio", ratio.to_string()),
            Ratios::UpTo(max_sum) => document.input("max_sum", max_sum),
        }
    }
}
