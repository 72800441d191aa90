//! Where tongues close: the pairs (s*, ρ*) at which both edges are one point and Q = ±I.
//!
//! The two edges of tongue m belong to two problems, so they can cross as ρ grows. **Existence**: at two
//! rational ρ their order is certified, and differs; eigenvalues are continuous in ρ, so between the two they
//! meet. **Uniqueness**: Krawczyk's operator on F(s, ρ) = (X, Y), X and Y the two entries, maps a box
//! strictly into itself; so the box holds exactly one common zero, and a simple one (Krawczyk 1969,
//! Moore 1977). **Completeness**: for ρ > 0 all zeros s of an entry are real, so the common zeros in a range
//! of ρ are exactly the real zeros there of the resultant of X and Y in s, a polynomial in ρ; Descartes' rule
//! isolates them. That is done for p + q up to [`COMPLETE_UP_TO`]; beyond it the search finds every crossing
//! that its samples of ρ bracket, and says so.
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::tongue::{Search, closings};
//! // A resonance that does not destabilize: 5/3, m = 4.
//! let found = closings("5/3".parse().unwrap(), &Search { m: Some(4), ..Search::default() }).unwrap();
//! let closing = &found.closings[0];
//! assert_eq!(closing.exact, Some((ratio(11, 4), ratio(114, 55))));
//! assert!(closing.below_verlet && found.closings.len() == 1 && found.complete);
//! ```

use num_traits::Signed;

use super::certify::{Closing, Order, certify, orders};
use crate::tongue::gap::crossings;
use crate::tongue::string::Entry;
use number::parallel::{go_on, try_map};
use number::{Error, Ratio, Rational, Result, rational};

/// Up to this p + q the resultant brackets all closings.
pub const COMPLETE_UP_TO: u64 = 24;

/// The range of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// One tongue only.
    pub m: Option<u64>,
    /// The closed range of ρ, positive.
    pub rho: (Rational, Rational),
    /// How many ρ are sampled, evenly in ln ρ, where p + q is beyond [`COMPLETE_UP_TO`].
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
/// A range that is not positive or empty, fewer than 2 samples, and the errors of
/// [`Tongues::new`](crate::tongue::Tongues::new).
pub fn closings(ratio: Ratio, search: &Search) -> Result<Found> {
    let rhos = samples(search)?;
    let short = ratio.kicks() <= COMPLETE_UP_TO;
    let (brackets, complete) =
        if short { by_elimination(ratio, search)? } else { (by_samples(ratio, rhos, search.m)?, false) };
    let certified = |(m, lo, hi): &Bracket| certify(ratio, *m, lo, hi);
    Ok(Found { ratio, closings: try_map(&brackets, certified)?, complete })
}

/// Tongue m closes once, or an odd number of times, for ρ in a closed range.
type Bracket = (u64, Rational, Rational);

/// The tongues that close at each zero of the resultants, and whether exactly one closes at each zero: then
/// these are all.
fn by_elimination(ratio: Ratio, search: &Search) -> Result<(Vec<Bracket>, bool)> {
    let (mut found, mut complete) = (Vec::new(), true);
    for odd in [true, false].into_iter().filter(|&odd| search.m.is_none_or(|m| (m % 2 == 1) == odd)) {
        let zeros = crossings(ratio, Entry::of_tongue(odd), &search.rho.0, &search.rho.1);
        for (lo, hi) in zeros.unwrap_or_default() {
            go_on()?;
            let (below, above) = (orders(ratio, &lo, None)?, orders(ratio, &hi, None)?);
            let crossed = |(a, b): &(&Order, &Order)| if lo == hi { a.closed } else { a.lower != b.lower };
            let filter = below.iter().zip(&above).filter(|(a, _)| (a.m % 2 == 1) == odd);
            let closing: Vec<u64> = filter.filter(crossed).map(|(a, _)| a.m).collect();
            complete &= closing.len() == 1;
            let asked = closing.into_iter().filter(|&m| search.m.is_none_or(|asked| m == asked));
            found.extend(asked.map(|m| (m, lo.clone(), hi.clone())));
        }
    }
    found.sort();
    Ok((found, complete))
}

/// The closings that samples of ρ bracket.
fn by_samples(ratio: Ratio, rhos: Vec<Rational>, m: Option<u64>) -> Result<Vec<Bracket>> {
    let mut found = Vec::new();
    let mut before: Option<(Rational, Vec<Order>)> = None;
    for rho in rhos {
        go_on()?;
        let orders = orders(ratio, &rho, m)?;
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
    Ok(found)
}

/// As [`closings`], for the labels in a list of closed ranges alone: each label costs two edges a sample.
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
    if !(from.is_finite() && to.is_finite()) {
        return Err(Error::input(
            "rho-range",
            format!("{lo}..{hi}"),
            "give ends within the range of doubles",
        ));
    }
    let inner = (1..search.samples - 1).map(|k| {
        let x = (from + (to - from) * k as f64 / (search.samples - 1) as f64).exp();
        rational::from_f64_exact(x).expect("finite").clamp(lo.clone(), hi.clone())
    });
    let mut rhos: Vec<Rational> = std::iter::once(lo.clone()).chain(inner).chain([hi.clone()]).collect();
    rhos.dedup();
    Ok(rhos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_and_elimination_find_the_same() {
        let mut all = 0;
        for (p, q) in [(5, 3), (3, 5), (7, 2), (7, 4), (5, 8), (6, 7)] {
            let (ratio, search) = (Ratio::new(p, q).unwrap(), Search::default());
            let (brackets, complete) = by_elimination(ratio, &search).unwrap();
            let sampled = by_samples(ratio, samples(&search).unwrap(), None).unwrap();
            let labels = |found: &[Bracket]| found.iter().map(|(m, ..)| *m).collect::<Vec<_>>();
            assert!(complete, "{ratio}");
            all += brackets.len();
            assert_eq!(labels(&brackets), labels(&sampled), "{ratio}");
        }
        assert!(all > 4, "{all}");
    }
}
