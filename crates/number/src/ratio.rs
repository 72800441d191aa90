//! The ratio of two steps: p/q in lowest terms.
//!
//! ```
//! use kickdrift_number::Ratio;
//! let ratio: Ratio = "14/4".parse().unwrap();
//! assert_eq!((ratio, ratio.to_string()), (Ratio::new(7, 2).unwrap(), "7/2".to_string()));
//! assert!(ratio > Ratio::new(10, 3).unwrap() && ratio.inverse() == Ratio::new(2, 7).unwrap());
//! // All of p + q ≤ 4, by p + q, then p.
//! let all: Vec<String> = Ratio::up_to(4).map(|ratio| ratio.to_string()).collect();
//! assert_eq!(all, ["1/1", "1/2", "2/1", "1/3", "3/1"]);
//! assert!(Ratio::new(1, 0).is_err() && "pi".parse::<Ratio>().is_err());
//! ```

use std::cmp::Ordering;
use std::fmt;

use num_integer::Integer;
use num_traits::ToPrimitive;

use super::Rational;
use crate::error::{Error, Result};

/// h2/h1 = p/q > 0 in lowest terms, p and q below 2^62: a period holds p fast and q slow kicks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ratio {
    p: u64,
    q: u64,
}

impl Ratio {
    /// 1/1: equal steps, or one clock.
    pub const ONE: Ratio = Ratio { p: 1, q: 1 };

    /// p/q, reduced to lowest terms.
    ///
    /// # Errors
    /// A zero, or 2^62 and more above or below the line.
    pub fn new(p: u64, q: u64) -> Result<Self> {
        let gcd = p.gcd(&q).max(1);
        Ratio::of_coprime(p / gcd, q / gcd)
            .ok_or_else(|| Error::input("ratio", format!("{p}/{q}"), "p and q must lie between 1 and 2^62"))
    }

    /// p/q, in lowest terms already; `None` for a zero, or 2^62 and more.
    pub(crate) fn of_coprime(p: u64, q: u64) -> Option<Self> {
        let small = |n: u64| (1..1 << 62).contains(&n);
        debug_assert!(p == 0 || q == 0 || p.gcd(&q) == 1);
        (small(p) && small(q)).then_some(Ratio { p, q })
    }

    /// The numerator: the number of fast kicks in a period.
    pub fn p(self) -> u64 {
        self.p
    }

    /// The denominator: the number of slow kicks in a period.
    pub fn q(self) -> u64 {
        self.q
    }

    /// (p, q).
    pub fn terms(self) -> (u64, u64) {
        (self.p, self.q)
    }

    /// p + q: the number of kicks in a period, coincident ones counted apart.
    pub fn kicks(self) -> u64 {
        self.p + self.q
    }

    /// q/p: the clocks with their roles exchanged.
    #[must_use]
    pub fn inverse(self) -> Self {
        Ratio { p: self.q, q: self.p }
    }

    /// Every ratio with p + q ≤ `sum`, by p + q, then p.
    pub fn up_to(sum: u64) -> impl Iterator<Item = Ratio> {
        let coprime = |(p, q): (u64, u64)| (p.gcd(&q) == 1).then_some(Ratio { p, q });
        (2..=sum).flat_map(|sum| (1..sum).map(move |p| (p, sum - p))).filter_map(coprime)
    }
}

impl From<Ratio> for Rational {
    fn from(ratio: Ratio) -> Self {
        // Lowest terms and a positive denominator are the invariant of both.
        Rational::new_raw(ratio.p.into(), ratio.q.into())
    }
}

impl TryFrom<&Rational> for Ratio {
    type Error = Error;

    fn try_from(x: &Rational) -> Result<Self> {
        let terms = x.numer().to_u64().zip(x.denom().to_u64());
        terms
            .and_then(|(p, q)| Ratio::new(p, q).ok())
            .ok_or_else(|| Error::input("ratio", x, "must be p/q with positive integers of at most 62 bits"))
    }
}

impl fmt::Display for Ratio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.p, self.q)
    }
}

impl Ord for Ratio {
    fn cmp(&self, other: &Self) -> Ordering {
        let cross = |a: u64, b: u64| u128::from(a) * u128::from(b);
        cross(self.p, other.q).cmp(&cross(other.p, self.q))
    }
}

impl PartialOrd for Ratio {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
