//! Zeros counted exactly: for those so close that counts in doubles cannot tell them apart.

use std::ops::RangeInclusive;

use num_bigint::{BigInt, Sign as IntSign};
use num_integer::Integer;
use num_traits::{Signed, Zero};

use super::precise::{Enclosure, Function};
use super::string::{Entry, HalfString};
use crate::number::{Rational, rational};
use crate::orbit::refine::{self, End};
use crate::schedule::{Event, Weight};

/// Bits to begin with, and beyond which counting is left to exact integers.
const BITS: RangeInclusive<u32> = 128..=1 << 13;

impl Function {
    /// How many zeros lie in (0, s), and whether s is one.
    fn count(&self, s: &Rational) -> (u64, bool) {
        let clocks = self.unreduced_clocks(s);
        let mut bits = *BITS.start();
        while bits <= *BITS.end() {
            let end = refine::run_one(&clocks, &self.schedule, bits, self.entry.starts_free());
            if let Some(count) = end.and_then(|end| self.counted(&end)) {
                return (count, false);
            }
            bits *= 2;
        }
        self.exact_count(s)
    }

    /// The zeros below the s of an orbit, where its signs are certain and s is none.
    pub fn counted(&self, end: &End) -> Option<u64> {
        let (changes, (x, v)) = (end.nodes?, (end.signs.0?, end.signs.1?));
        Some(if self.entry.ends_free() { self.free_count(changes, x != v) } else { changes })
    }

    /// At a free end the slope's zeros count; the rigid shift of C does not.
    fn free_count(&self, changes: u64, falling: bool) -> u64 {
        changes + u64::from(falling) - u64::from(self.entry == Entry::C)
    }

    /// The same by the signs of x along the string in exact integers,
    /// (x, v) carrying the kicks' common denominator as a positive factor.
    fn exact_count(&self, s: &Rational) -> (u64, bool) {
        let kappa = s / Rational::from_integer((2 * self.schedule.clocks()[0].step()).into());
        let slow = &kappa * &self.slow;
        let denominator = kappa.denom().lcm(slow.denom());
        let numerator = |x: &Rational| x.numer() * (&denominator / x.denom());
        let half =
            [BigInt::zero(), numerator(&kappa), numerator(&slow), numerator(&kappa) + numerator(&slow)];
        let even = self.entry.starts_free();
        let (mut x, mut v) = (BigInt::from(u8::from(even)), BigInt::from(u8::from(!even)));
        let (mut last, mut changes) = (IntSign::Plus, 0);
        for Event { drift, kicks, weight } in self.schedule.half_period() {
            x += &v * drift;
            if x.sign() != IntSign::NoSign && x.sign() != last {
                (last, changes) = (x.sign(), changes + 1);
            }
            if kicks != 0 {
                let parts = if weight == Weight::Half { 1u8 } else { 2 };
                v = v * &denominator - &half[kicks as usize] * parts * &x;
                x *= &denominator;
            }
        }
        if !self.entry.ends_free() {
            return (changes, x.is_zero());
        }
        let falling = x.is_zero() || (!v.is_zero() && x.sign() != v.sign());
        (self.free_count(changes, falling), v.is_zero())
    }

    /// Isolates a zero by halving with proven counts: for zeros so close that counts in doubles cannot tell them
    /// apart. `around`, if given, is where doubles saw it.
    pub fn isolate(&self, string: &HalfString, index: usize, around: Option<(f64, f64)>) -> Enclosure {
        let exact = |x: f64| rational::from_f64_exact(x).expect("finite");
        let upto = string.dimension(self.entry) as u64;
        let bound = exact(2.0 * string.upper_bound * string.ticks);
        let mut cell = Cell { lo: Rational::zero(), hi: bound, below: 0, upto, index: index as u64 };
        let mut hints = around.map_or(Vec::new(), |(lo, hi)| vec![exact(hi), exact(lo)]);
        loop {
            let middle = || (&cell.lo + &cell.hi) / Rational::from_integer(2.into());
            let cut = hints.pop().filter(|x| cell.lo < *x && *x < cell.hi).unwrap_or_else(middle);
            let (count, is_zero) = self.count(&cut);
            if let Some(found) = cell.cut(cut, count, is_zero) {
                return found;
            }
        }
    }
}

/// An interval with the zeros `below` + 1 ..= `upto`, on the way to the zero `index` alone.
struct Cell {
    lo: Rational,
    hi: Rational,
    below: u64,
    upto: u64,
    index: u64,
}

impl Cell {
    /// Cuts at x, with `count` zeros below it and perhaps one on it.
    fn cut(&mut self, x: Rational, count: u64, is_zero: bool) -> Option<Enclosure> {
        if is_zero && count + 1 == self.index {
            return Some(Enclosure { lo: x.clone(), hi: x });
        }
        let count = count + u64::from(is_zero);
        if count < self.index {
            (self.lo, self.below) = (x, count)
        } else {
            (self.hi, self.upto) = (x, count)
        }
        let alone = self.upto - self.below == 1 && self.lo.is_positive();
        alone.then(|| Enclosure { lo: self.lo.clone(), hi: self.hi.clone() })
    }
}
