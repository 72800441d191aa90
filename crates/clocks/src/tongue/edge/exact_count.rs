//! Zeros counted exactly: for those so close that counts in doubles cannot separate them.

use std::ops::RangeInclusive;

use num_bigint::{BigInt, Sign as IntSign};
use num_integer::Integer;
use num_traits::{Signed, Zero};

use super::enclosure::Enclosure;
use super::function::EntryFunction;
use crate::schedule::{KickDrift, Kicks};
use crate::tongue::string::HalfString;
use number::{Rational, rational};

/// Bits to begin with, and beyond which counting is left to exact integers.
const BITS: RangeInclusive<u32> = 128..=1 << 13;

/// How many zeros lie in (0, s), and whether s is one.
fn count(function: &EntryFunction, s: &Rational) -> (u64, bool) {
    let mut bits = *BITS.start();
    while bits <= *BITS.end() {
        if let Some(count) = function.orbit(s, bits).and_then(|end| function.counted(&end)) {
            return (count, false);
        }
        bits *= 2;
    }
    exact_count(function, s)
}

/// Counts by the signs of x along the string in exact integers,
/// (x, v) carrying the kicks' common denominator as a positive factor.
fn exact_count(function: &EntryFunction, s: &Rational) -> (u64, bool) {
    let kappa = s / Rational::from_integer((2 * function.schedule.clocks()[0].step()).into());
    let slow = &kappa * &function.slow;
    let denominator = kappa.denom().lcm(slow.denom());
    let numerator = |x: &Rational| x.numer() * (&denominator / x.denom());
    let halves = [numerator(&kappa), numerator(&slow), numerator(&kappa) + numerator(&slow)];
    let kicks = Kicks::of_two_clocks(halves, |half| [&half * 2u8, half]);
    let even = function.entry.starts_free();
    let (x, v) = (BigInt::from(u8::from(even)), BigInt::from(u8::from(!even)));
    let mut orbit = IntegerOrbit { x, v, denominator, last: IntSign::Plus, changes: 0 };
    kicks.lead(function.schedule.half_period(), &mut orbit);
    let IntegerOrbit { x, v, changes, .. } = orbit;
    if !function.entry.ends_free() {
        return (changes, x.is_zero());
    }
    let falling = x.is_zero() || (!v.is_zero() && x.sign() != v.sign());
    (function.free_count(changes, falling), v.is_zero())
}

/// A solution on its way, and the sign changes of x so far.
struct IntegerOrbit {
    x: BigInt,
    v: BigInt,
    denominator: BigInt,
    last: IntSign,
    changes: u64,
}

impl KickDrift<BigInt> for IntegerOrbit {
    fn drift(&mut self, ticks: u64) {
        self.x += &self.v * ticks;
    }

    fn arrive(&mut self) {
        if self.x.sign() != IntSign::NoSign && self.x.sign() != self.last {
            (self.last, self.changes) = (self.x.sign(), self.changes + 1);
        }
    }

    /// Times the denominator.
    fn kick(&mut self, strength: &BigInt) {
        self.v *= &self.denominator;
        self.v -= strength * &self.x;
        self.x *= &self.denominator;
    }
}

/// Isolates a zero by halving with proven counts: for zeros so close that counts in doubles cannot separate
/// them apart. `around`, if given, is where doubles saw it.
pub fn isolate(
    function: &EntryFunction,
    string: &HalfString,
    index: usize,
    around: Option<(f64, f64)>,
) -> Enclosure {
    let exact = |x: f64| rational::from_f64_exact(x).expect("finite");
    let upto = string.dimensions[function.entry as usize] as u64;
    let bound = exact(2.0 * string.upper_bound * string.ticks);
    let mut cell = Cell { lo: Rational::zero(), hi: bound, below: 0, upto, index: index as u64 };
    let mut hints = around.map_or(Vec::new(), |(lo, hi)| vec![exact(hi), exact(lo)]);
    loop {
        let middle = || (&cell.lo + &cell.hi) / Rational::from_integer(2.into());
        let cut = hints.pop().filter(|x| cell.lo < *x && *x < cell.hi).unwrap_or_else(middle);
        let (count, is_zero) = count(function, &cut);
        if let Some(found) = cell.cut(cut, count, is_zero) {
            return found;
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
