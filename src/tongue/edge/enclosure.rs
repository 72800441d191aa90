//! Edges in doubles, and enclosures with rational ends.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use crate::number::{Rational, rational};
use crate::tongue::string::Entry;

/// An edge of a tongue: the `index`-th positive zero of an entry, in an interval that holds no other zero of it unless
/// others are within the last place of a double.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    pub entry: Entry,
    /// 1, 2, ... from below.
    pub index: u32,
    /// The enclosure of s = h1² L1.
    pub lo: f64,
    pub hi: f64,
}

/// Some units in the last place, as a relative width: no wider is an edge that doubles certify.
const WIDEST: f64 = 2.5e-15;

impl Edge {
    /// Whether it is as narrow as an edge shall be.
    pub(crate) fn is_narrow(&self) -> bool {
        self.hi - self.lo <= WIDEST * self.lo
    }
}

/// An interval with rational ends that holds exactly one zero of an entry; a point where that is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    pub lo: Rational,
    pub hi: Rational,
}

/// −log2 x, to within 1; 0 for x = 0 or x ≥ 1.
pub(crate) fn negative_log2(x: &Rational) -> u32 {
    x.denom().bits().saturating_sub(x.numer().bits()) as u32
}

impl From<&Edge> for Enclosure {
    fn from(edge: &Edge) -> Self {
        let exact = |x: f64| rational::from_f64_exact(x).expect("an edge is finite");
        Enclosure { lo: exact(edge.lo), hi: exact(edge.hi) }
    }
}

impl Enclosure {
    /// The doubles around the enclosure.
    pub fn to_f64(&self) -> (f64, f64) {
        (rational::enclose_f64(&self.lo).0, rational::enclose_f64(&self.hi).1)
    }

    /// hi − lo.
    pub fn width(&self) -> Rational {
        &self.hi - &self.lo
    }

    /// The middle.
    pub fn middle(&self) -> Rational {
        (&self.lo + &self.hi) / Rational::from_integer(2.into())
    }
}

/// The rational of least denominator in [lo, hi], 0 < lo ≤ hi (Stern and Brocot): the terms that the continued fractions of
/// lo and hi have in common, and the least that fits for the last one. Whole numbers that stay coprime: nothing is
/// ever reduced.
pub(crate) fn simplest(lo: &Rational, hi: &Rational) -> Rational {
    let (mut lo, mut hi) = (lo.clone().into_raw(), hi.clone().into_raw());
    let (mut before, mut now) = ((BigInt::zero(), BigInt::one()), (BigInt::one(), BigInt::zero()));
    loop {
        let (mut term, rest) = lo.0.div_mod_floor(&lo.1);
        let (top, above) = hi.0.div_mod_floor(&hi.1);
        let is_last = rest.is_zero() || term < top;
        if !rest.is_zero() && is_last {
            term += 1u8;
        }
        let next = (&now.0 * &term + before.0, &now.1 * &term + before.1);
        (before, now) = (now, next);
        if is_last {
            return Rational::new_raw(now.0, now.1);
        }
        // What is left, rest/lo.1 ≤ x ≤ above/hi.1, upside down.
        (lo, hi) = ((hi.1, above), (lo.1, rest));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::rational::ratio;

    #[test]
    fn the_simplest_rational_has_the_least_denominator_of_all() {
        let mut seen = 0;
        for (a, b) in (1..60i64).flat_map(|b| (1..4 * b).map(move |a| (a, b))) {
            for width in [ratio(0, 1), ratio(1, 7 * b), ratio(1, 97), ratio(5, 3)] {
                let (lo, hi) = (ratio(a, b), ratio(a, b) + width);
                let found = simplest(&lo, &hi);
                assert!(lo <= found && found <= hi, "{found} in {lo}..{hi}");
                let least = (1..).map(BigInt::from).find(|d| {
                    let numerator = (&lo * Rational::from_integer(d.clone())).ceil();
                    numerator <= &hi * Rational::from_integer(d.clone())
                });
                assert_eq!(Some(found.denom()), least.as_ref(), "{lo}..{hi}");
                assert_eq!(Rational::new(found.numer().clone(), found.denom().clone()), found);
                seen += 1;
            }
        }
        assert!(seen > 10_000);
    }
}
