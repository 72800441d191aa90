//! One ratio of steps, or all up to a sum: what `tongues` and `closings` range over.

use plot::Foot;

use crate::error::{Error, Result};
use crate::number::Ratio;
use crate::question::{Ratios, flag};

/// The flags that say which.
#[derive(Debug, clap::Args)]
pub struct Flags {
    /// h2/h1 = p/q; several, as 5/3,7/2, for a diagram.
    #[arg(long, value_name = "P/Q", allow_hyphen_values = true, value_delimiter = ',', value_parser = flag::<Ratio>)]
    ratio: Vec<Ratio>,
    /// All coprime p + q up to this number.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = flag::<u64>)]
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
            ([_, second, ..], None) => Err(Error::input("ratio", second, "is one too many: give one")),
            (named, max_sum) => Ratios::of(named.first().copied(), max_sum),
        }
    }
}

/// Below a figure.
pub fn below(ratios: Ratios, foot: Foot) -> Foot {
    match ratios {
        Ratios::One(ratio) => foot.value("*h*_2/*h*_1", ratio),
        Ratios::UpTo(max_sum) => foot.part(format!("all *h*_2/*h*_1 = *p*/*q*, *p* + *q* ≤ {max_sum}")),
    }
}
