//! Edges in doubles, and enclosures with rational ends.

use crate::tongue::string::Entry;
use number::{Rational, rational};

/// An edge of a tongue: the `index`-th positive zero of an entry, in an interval that holds no other zero of
/// it unless others are within the last place of a double.
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
    /// The middle of its enclosure, rounded.
    pub fn middle(&self) -> f64 {
        0.5 * (self.lo + self.hi)
    }

    /// Whether it is as narrow as an edge shall be.
    pub fn is_narrow(&self) -> bool {
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
