//! One ratio of steps, some, or all up to a sum: what tongues and closings range over.

use std::fmt::{Display, Formatter};

use plot::Foot;

use super::field::notation;
use crate::report::shape::Shape;
use number::parse::parse_ratio;
use number::{Error, Ratio, Result};

/// The largest p + q of all ratios: there are 1.2 million of them below 2000.
pub const MOST_SUM: u64 = 2000;

/// Ratios by name, each once: 7/3, or 3/2,5/2.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RatioList(Vec<Ratio>);

impl RatioList {
    /// The ratios, in the order in which they were named.
    pub fn ratios(&self) -> &[Ratio] {
        &self.0
    }

    /// As people write it.
    pub fn spaced(&self) -> String {
        self.to_string().replace(',', ", ")
    }

    fn parsed(field: &str, text: &str) -> Result<RatioList> {
        let ratios =
            text.split(',').map(|ratio| parse_ratio(field, ratio.trim())).collect::<Result<Vec<_>>>()?;
        match (1..ratios.len()).find(|&n| ratios[..n].contains(&ratios[n])) {
            Some(n) => Err(Error::input(field, ratios[n], "is named twice: name each ratio once")),
            None => Ok(RatioList(ratios)),
        }
    }
}

impl Display for RatioList {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.iter().map(ToString::to_string).collect::<Vec<_>>().join(","))
    }
}

const RATIO_LIST: Shape =
    Shape::Plain(r#"{"type": "string", "pattern": "^[0-9]+/[0-9]+(,[0-9]+/[0-9]+)*$"}"#);

notation! {
    RatioList: RatioList::parsed, ToString::to_string, RATIO_LIST;
}

/// One ratio, several, or all coprime p + q up to a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ratios {
    One(Ratio),
    Several(RatioList),
    UpTo(u64),
}

impl From<RatioList> for Ratios {
    fn from(list: RatioList) -> Ratios {
        if let [ratio] = list.0[..] { Ratios::One(ratio) } else { Ratios::Several(list) }
    }
}

impl Ratios {
    /// The ratios of two fields, of which one is given.
    ///
    /// # Errors
    /// Neither or both.
    pub fn of(named: Option<Ratios>, max_sum: Option<u64>) -> Result<Ratios> {
        match (named, max_sum) {
            (Some(named), None) => Ok(named),
            (None, Some(max_sum)) => Ok(Ratios::UpTo(max_sum)),
            (Some(_), Some(_)) => Err(Error::input("ratio", "given with --max-sum", "give one of them")),
            (None, None) => {
                Err(Error::missing("ratio", "give --ratio P/Q, or --max-sum N for all p + q <= N"))
            }
        }
    }

    /// The fields `ratio` and `max_sum`.
    pub fn fields(self) -> (Option<RatioList>, Option<u64>) {
        match self {
            Ratios::One(ratio) => (Some(RatioList(vec![ratio])), None),
            Ratios::Several(list) => (Some(list), None),
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

    /// All of them, in the order in which they were named; up to a sum by p + q, then p.
    pub fn list(&self) -> Vec<Ratio> {
        match self {
            Ratios::One(ratio) => vec![*ratio],
            Ratios::Several(list) => list.0.clone(),
            Ratios::UpTo(max_sum) => Ratio::up_to(*max_sum).collect(),
        }
    }

    /// In words.
    pub fn words(&self) -> String {
        match self {
            Ratios::One(ratio) => format!("h2/h1 = {ratio}"),
            Ratios::Several(list) => format!("h2/h1 = {}", list.spaced()),
            Ratios::UpTo(max_sum) => format!("all h2/h1 = p/q, p + q <= {max_sum}"),
        }
    }

    /// Below a figure.
    pub fn below(&self, foot: Foot) -> Foot {
        match self {
            Ratios::One(ratio) => foot.value("*h*_2/*h*_1", ratio),
            Ratios::Several(list) => foot.value("*h*_2/*h*_1", list.spaced()),
            Ratios::UpTo(max_sum) => foot.part(format!("all *h*_2/*h*_1 = *p*/*q*, *p* + *q* ≤ {max_sum}")),
        }
    }
}
