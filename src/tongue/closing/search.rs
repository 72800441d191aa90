//! Where tongues close: the pairs (s*, ρ*) at which both edges are one point and Q = ±I.
//!
//! The two edges of tongue m belong to two problems, so they can cross as ρ grows. **Existence**: at two rational
//! ρ their order is certified, and differs; eigenvalues are continuous in ρ, so between the two they meet.
//! **Uniqueness**: Krawczyk's operator on F(s, ρ) = (X, Y), X and Y the two entries, maps a box strictly into
//! itself; so the box holds exactly one common zero, and a simple one (Krawczyk 1969, Moore 1977). **Completeness**: for
//! ρ > 0 all zeros s of an entry are real, so the common zeros in a range of ρ are exactly the real zeros there of the
//! resultant of X and Y in s, a polynomial in ρ; Sturm's theorem counts them. That is done for p + q up to
//! [`COMPLETE_UP_TO`]; beyond it the search finds every crossing that its samples of ρ bracket, and says so.
//!
//! ```
//! use kickdrift::number::rational::ratio;
//! use kickdrift::tongue::{Search, closings};
//! // A resonance that does not destabilize: 5/3, m = 4.
//! let found = closings("5/3".parse().unwrap(), &Search { m: Some(4), ..Search::default() }).unwrap();
//! let closing = &found.closings[0];
//! assert_eq!(closing.exact, Some((ratio(11, 4), ratio(114, 55))));
//! assert!(closing.below_verlet && found.closings.len() == 1 && found.complete);
//! ```

use num_traits::Signed;

use super::certify::{Closing, Order, certify, orders};
use crate::error::{Error, Result};
use crate::number::{Ratio, Rational, rational};
use crate::parallel::{go_on, try_map};
use crate::tongue::edge::Enclosure;
use crate::tongue::gap::count_closings;
use crate::tongue::string::Entry;

/// Up to this p + q the search is checked against the resultant.
pub const COMPLETE_UP_TO: u64 = 13;

/// What to search.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// One tongue only.
    pub m: Option<u64>,
    /// The closed range of ρ, positive.
    pub rho: (Rational, Rational),
    /// How many ρ are sampled, evenly in ln ρ.
    pub samples: usize,
}

impl Default for Search {
    /// All tongues, ρ from 1e-4 to 100, 400 samples.
    fn default() -> Self {
        Search {
            m: None,
            rho: (Rational::new(1.into(), 10_000.into()), Rational::from_integer(100.into())),
            samples: 400,
        }
    }
}

/// The closings that a search found for one ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    pub ratio: Ratio,
    /// In order of m, then ρ.
    pub closings: Vec<Closing>,
    /// Whether elimination proves that there are no others in the range.
    pub complete: bool,
}

/// The closings of p/q in a range of ρ.
///
/// # Errors
/// A range that is not positive or empty, fewer than 2 samples, and the errors of [`Tongues::new`](crate::tongue::Tongues::new).
pub fn closings(ratio: Ratio, search: &Search) -> Result<Found> {
    let rhos = samples(search)?;
    let mut found = Vec::new();
    let mut before: Option<(Rational, Vec<Order>)> = None;
    for rho in rhos {
        go_on()?;
        let orders = orders(ratio, &rho, search.m)?;
        for (k, order) in orders.iter().enumerate() {
            if order.closed {
                found.push((order.m, rho.clone(), rho.clone()));
            } else if let Some((earlier, list)) = &before
                && !list[k].closed
                && list[k].lower != order.lower
            {
                found.push((order.m, earlier.clone(), rho.clone()));
            }
        }
        before = Some((rho, orders));
    }
    found.sort();
    let closings: Vec<Closing> =
        found.into_iter().map(|(m, lo, hi)| certify(ratio, m, &lo, &hi)).collect::<Result<_>>()?;
    let complete = ratio.kicks() <= COMPLETE_UP_TO && is_complete(ratio, search, &closings)?;
    Ok(Found { ratio, closings, complete })
}

/// The same for the tongues of a list of closed ranges of labels alone: a search for one costs two edges a sample.
///
/// # Errors
/// As [`closings`], and a label beyond the last finite tongue, p + q − 2.
pub fn closings_of(ratio: Ratio, labels: &[(u64, u64)], search: &Search) -> Result<Found> {
    // The last tongue has no upper edge, and never closes.
    let last = ratio.kicks() - 2;
    if let Some(m) = labels.iter().map(|run| run.1).find(|&m| m > last) {
        return Err(Error::input("m", m, format!("{ratio} has the finite tongues 1 to {last}")));
    }
    let labels: Vec<u64> = (1..=last).filter(|m| labels.iter().any(|(a, b)| a <= m && m <= b)).collect();
    let of = |&m: &u64| closings(ratio, &Search { m: Some(m), ..search.clone() });
    let found: Vec<Found> = try_map(&labels, of)?;
    let complete = found.iter().all(|found| found.complete);
    Ok(Found { ratio, closings: found.into_iter().flat_map(|found| found.closings).collect(), complete })
}

/// The samples of ρ: doubles evenly spaced in ln ρ, the ends exact.
fn samples(search: &Search) -> Result<Vec<Rational>> {
    let (lo, hi) = &search.rho;
    if !lo.is_positive() || lo > hi {
        return Err(Error::input("rho-range", format!("{lo}..{hi}"), "give 0 < LO <= HI"));
    }
    if search.samples < 2 {
        return Err(Error::input("samples", search.samples, "a search needs at least 2"));
    }
    let (from, to) = (rational::to_f64(lo).ln(), rational::to_f64(hi).ln());
    let inner = (1..search.samples - 1).map(|k| {
        let x = (from + (to - from) * k as f64 / (search.samples - 1) as f64).exp();
        rational::from_f64_exact(x).expect("finite").clamp(lo.clone(), hi.clone())
    });
    let mut rhos: Vec<Rational> = std::iter::once(lo.clone()).chain(inner).chain([hi.clone()]).collect();
    rhos.dedup();
    Ok(rhos)
}

/// Whether the resultants have no more zeros in the range of ρ than closings were found.
fn is_complete(ratio: Ratio, search: &Search, closings: &[Closing]) -> Result<bool> {
    let (lo, hi) = &search.rho;
    let one_parity = |odd: bool| {
        let mut rhos: Vec<&Enclosure> =
            closings.iter().filter(|c| (c.m % 2 == 1) == odd).map(|closing| &closing.rho).collect();
        rhos.sort_by(|a, b| a.lo.cmp(&b.lo));
        let apart = rhos.windows(2).all(|pair| pair[0].hi < pair[1].lo);
        let Some(count) = count_closings(ratio, Entry::of_tongue(odd), lo, hi) else { return true };
        apart && count == rhos.len()
    };
    Ok(match search.m {
        // One tongue found everything that its parity has, or cannot know.
        Some(m) => one_parity(m % 2 == 1),
        None => one_parity(true) && one_parity(false),
    })
}
