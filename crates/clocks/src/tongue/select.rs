//! Which tongues: by label, by family, by a window of s. Only these are computed.
//!
//! ```
//! use kickdrift_clocks::number::{Laurent, rational::ratio};
//! use kickdrift_clocks::tongue::{Selection, Tongues};
//! let tongues = Tongues::new("70/31".parse().unwrap(), &ratio(1, 25)).unwrap();
//! let [lo, hi] = [230, 232].map(|n| Laurent::from_rational(ratio(n, 100)));
//! let window = Selection { s: Some((lo, hi)), ..Selection::default() };
//! let found: Vec<u64> = tongues.select(&window).unwrap().iter().map(|gap| gap.m).collect();
//! assert_eq!(found, [39]);
//! assert!(tongues.effort().doubles < 20); // of 99 tongues
//! ```

use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;

use super::edge::{Edge, Tongues, counts};
use super::gap::Gap;
use super::string::MOST_KICKS;
use super::string::lanes::LANES;
use crate::resonance::dominant_family;
use number::parse::{parse_integer, parse_integer_range};
use number::{Error, Laurent, Result, rational};

/// A closed range of steps, or of s.
pub type Range = (Laurent, Laurent);

/// Labels as closed ranges, in writing `4`, `1,3`, `7..9` and such.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Labels(pub Vec<(u64, u64)>);

impl FromStr for Labels {
    type Err = Error;

    /// # Errors
    /// Another text, an empty range, a label below 1.
    fn from_str(text: &str) -> Result<Self> {
        let label = |m: i64| {
            let positive = u64::try_from(m).ok().filter(|&m| m > 0);
            positive.ok_or_else(|| Error::input("m", text, "labels begin at 1"))
        };
        let part = |part: &str| {
            if part.trim().is_empty() {
                return Err(Error::input("m", text, "has an empty item: list labels as 1,3,7..9"));
            }
            let (from, upto) = match part.contains("..") {
                true => parse_integer_range("m", part)?,
                false => parse_integer("m", part).map(|m| (m, m))?,
            };
            Ok((label(from)?, label(upto)?))
        };
        text.split(',').map(part).collect::<Result<_>>().map(Labels)
    }
}

impl fmt::Display for Labels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, &(from, upto)) in self.0.iter().enumerate() {
            let comma = if i > 0 { "," } else { "" };
            if from == upto { write!(f, "{comma}{from}") } else { write!(f, "{comma}{from}..{upto}") }?;
        }
        Ok(())
    }
}

/// Conditions that all must hold; what is `None` is no condition.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    pub m: Option<Labels>,
    /// Closed ranges of the dominant family's a and b.
    pub a: Option<(i64, i64)>,
    pub b: Option<(i64, i64)>,
    /// A closed window of s: the tongues that meet it, their edges included.
    pub s: Option<Range>,
}

/// Where at least one in so many tongues of a range is wanted, all of it is computed side by side.
const DENSE: u64 = 3;

/// The window is widened by this for the counts, whose own uncertainty is below 1e-8 for all strings that are
/// laid out.
const SLACK: f64 = 1e-6;

impl Selection {
    /// The tongues that begin at s = `limit` or below, and no other condition.
    pub fn below(limit: f64) -> Self {
        let limit = rational::from_f64_exact(limit).map(Laurent::from_rational);
        Selection { s: limit.map(|limit| (Laurent::from_integer(0), limit)), ..Selection::default() }
    }

    /// Whether a tongue meets the window of s, decided.
    pub(crate) fn meets_window(&self, tongues: &Tongues, gap: &Gap) -> Result<bool> {
        let Some((lo, hi)) = &self.s else { return Ok(true) };
        let is_above = |edge: &Edge| tongues.compare(edge, hi).map(Ordering::is_gt);
        let ends_below = |edge: &Edge| tongues.compare(edge, lo).map(Ordering::is_lt);
        Ok(lo <= hi && !is_above(&gap.lower)? && !gap.upper.as_ref().map_or(Ok(false), ends_below)?)
    }

    /// That the labels asked for exist.
    ///
    /// # Errors
    /// A label beyond the last tongue.
    pub(crate) fn check_labels(&self, tongues: &Tongues) -> Result<()> {
        let last = tongues.last();
        let ranges = self.m.iter().flat_map(|labels| &labels.0);
        match ranges.flat_map(|&(from, upto)| [from, upto]).find(|m| !(1..=last).contains(m)) {
            None => Ok(()),
            Some(m) => {
                let remedy = format!("{} has the tongues 1 to {last}", tongues.ratio());
                Err(Error::input("m", m, remedy))
            }
        }
    }

    /// The labels selected, as far as they are known before the edges, in order.
    ///
    /// # Errors
    /// A window of s of a period too long to be laid out.
    pub(crate) fn labels(&self, tongues: &Tongues) -> Result<Vec<u64>> {
        let all = Ok((1, tongues.last()));
        let (first, last) = self.s.as_ref().map_or(all, |window| labels_within(tongues, window))?;
        let within = |range: Option<(i64, i64)>, x: i64| range.is_none_or(|(lo, hi)| lo <= x && x <= hi);
        let wanted = |m: u64| {
            let listed = self.m.as_ref().is_none_or(|list| list.0.iter().any(|&(a, b)| a <= m && m <= b));
            let any = self.a.is_none() && self.b.is_none();
            listed
                && (any || {
                    let (a, b) = dominant_family(tongues.ratio(), m);
                    within(self.a, a) && within(self.b, b)
                })
        };
        let (from, upto) = self.m.as_ref().map_or((first, last), |list| {
            let (from, upto) =
                (list.0.iter().map(|pair| pair.0).min(), list.0.iter().map(|pair| pair.1).max());
            (from.unwrap_or(1).max(first), upto.unwrap_or(0).min(last))
        });
        if upto.saturating_sub(from) > MOST_KICKS {
            // So many labels are listed of no period that is too long to be laid out.
            tongues.string()?;
        }
        Ok((from..=upto).filter(|&m| wanted(m)).collect())
    }
}

/// A range of labels that holds all tongues which meet the window: an edge with an index not above the count
/// at its lower end lies below it, one with an index above the count at its upper end lies beyond.
fn labels_within(tongues: &Tongues, (lo, hi): &Range) -> Result<(u64, u64)> {
    let (lo, hi) = (lo.enclose_f64().0, hi.enclose_f64().1);
    if hi < lo || hi <= 0.0 {
        return Ok((1, 0));
    }
    let string = tongues.string()?;
    let counts = |s: f64| {
        // The counts neither underflow nor overflow within these.
        let kappa = (s / string.ticks).min(4.0 * string.upper_bound);
        counts(string, &[kappa; LANES]).map(|counts| if kappa < 1e-100 { 0 } else { counts[0] as u64 })
    };
    let ([a, b, c, d], [e, f, g, h]) = (counts(lo * (1.0 - SLACK)), counts(hi * (1.0 + SLACK)));
    let first = (2 * b.min(c) + 2).min(2 * a.min(d) + 1);
    let upto = (2 * f.max(g)).max((2 * e.max(h)).saturating_sub(1));
    Ok((first, upto.min(tongues.last())))
}

/// Ranges that hold all labels and not many others: those to compute side by side.
pub fn runs(labels: &[u64]) -> Vec<(u64, u64)> {
    let mut runs: Vec<(u64, u64)> = Vec::new();
    for &m in labels {
        match runs.last_mut().filter(|run| m - run.1 <= DENSE) {
            Some(run) => run.1 = m,
            None => runs.push((m, m)),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_hold_every_label() {
        assert_eq!(runs(&[2, 3, 6, 7, 20]), [(2, 7), (20, 20)]);
        assert_eq!(runs(&[]), []);
    }
}
