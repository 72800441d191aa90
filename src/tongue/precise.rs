//! Edges to any number of digits, from certified signs of the entry at rational points.
//!
//! Quadratic interval refinement (Abbott 2006): the interval is cut into N equal cells, the secant says which one
//! holds the zero, and the entry's signs at the cell's two ends prove it; then N is squared, else its root is
//! taken. The interval at the start is a few units in the last place of a double, where the entry is straight to
//! nearly as many digits again: so N begins that large, and the number of correct digits doubles with every two
//! signs. The proof is nothing but a change of sign. A sign comes from the refine tier of [`crate::verdict`], with as many bits as the cell is small,
//! and from exact arithmetic where that cannot tell: then the point may be the zero itself.

use num_bigint::{BigInt, Sign as IntSign};
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::spectrum::Edge;
use super::string::{Entry, HalfString};
use crate::error::Result;
use crate::number::{Ball, Rational, Sign, rational};
use crate::propagator::{Event, Schedule, TwoClocks, Weight};
use crate::verdict::{Decidable, refine};

/// An interval with rational ends that holds exactly one zero of an entry; a point where that is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    pub lo: Rational,
    pub hi: Rational,
}

/// An entry of the half period as a function of s, for fixed p/q and ρ.
#[derive(Clone, Debug)]
pub(super) struct Function {
    p: u64,
    q: u64,
    /// The slow clock's mass ρ p/q, in those of the fast one.
    slow: Rational,
    schedule: Schedule,
    entry: Entry,
}

/// Bits beyond which the refine tier is not asked before exact arithmetic: so many times what the cell's size asks. Of a
/// long period they still cost far less than exact numbers, whose length grows with every kick; and a mode that lives
/// far from the ends wants twice the digits that its ends are small by.
const PATIENCE: u32 = 64;

/// Binary digits that the curvature of an entry takes from the secant's: its other zeros are n or so, at distances of
/// some 1/n of their size. A wrong guess costs two signs.
const STRAIGHT: u32 = 12;

/// −log2 x, to within 1; 0 for x = 0 or x ≥ 1.
pub(super) fn negative_log2(x: &Rational) -> u32 {
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

    /// −log2 of the relative width, to within 2; 0 for a point.
    fn digits(&self) -> u32 {
        let length = |x: &Rational| x.numer().bits() as i64 - x.denom().bits() as i64;
        let width = self.width();
        if width.is_zero() { 0 } else { (length(&self.hi) - length(&width)).max(0) as u32 }
    }

    fn is_below(&self, relative: &Rational) -> bool {
        self.width() <= &self.lo * relative
    }
}

impl Function {
    pub fn new(p: u64, q: u64, rho: &Rational, entry: Entry) -> Result<Self> {
        let slow = rho * Rational::new(p.into(), q.into());
        Ok(Function { p, q, slow, schedule: Schedule::two_clocks(p, q)?, entry })
    }

    fn clocks(&self, s: &Rational) -> TwoClocks<Rational> {
        TwoClocks::new(self.p, self.q, s.clone(), s * &self.slow)
    }

    /// The entry's exact sign at s.
    pub fn exact_sign(&self, s: &Rational) -> Sign {
        Decidable::half_signs(&self.clocks(s)).all()[self.entry as usize]
    }

    /// The entry's value at s, with a certified sign, from `bits` bits; the exact ball 0 where it is 0.
    fn value(&self, s: &Rational, bits: u32) -> Ball {
        let clocks = self.clocks(s);
        let mut working = bits;
        while working <= PATIENCE * bits {
            let end = refine::run_one(&clocks, &self.schedule, working, self.entry.starts_free());
            let value = end.map(|end| if self.entry.ends_free() { end.v } else { end.x });
            if let Some(value) = value.filter(|value| value.sign().is_some()) {
                return value;
            }
            working *= 2;
        }
        Ball::from_integer(&self.exact_sign(s).to_i8().into())
    }

    /// Whether the entry has different signs at the two ends, neither of them zero.
    pub fn changes_sign(&self, interval: &Enclosure) -> bool {
        const BITS: u32 = 128;
        let sign = |s: &Rational| self.value(s, BITS).sign();
        interval.lo < interval.hi
            && matches!(
                (sign(&interval.lo), sign(&interval.hi)),
                (Some(Sign::Negative), Some(Sign::Positive)) | (Some(Sign::Positive), Some(Sign::Negative))
            )
    }

    /// Shrinks an interval with one zero, simple and inside, until it is narrower than `relative` times itself.
    ///
    /// # Panics
    /// Where the entry has one sign at both ends: no interval with one simple zero.
    pub fn shrink(&self, start: &Enclosure, relative: &Rational) -> Enclosure {
        let mut interval = start.clone();
        let goal = negative_log2(relative);
        // log2 N: an interval of relative width 2^-d has its secant right to some d - STRAIGHT digits more.
        let mut cells = interval.digits().saturating_sub(STRAIGHT).max(2);
        let mut ends: Option<(Ball, Ball)> = None;
        while !interval.is_below(relative) {
            cells = cells.min(goal.saturating_sub(interval.digits()) + 3);
            let bits = self.bits_for(&interval, cells);
            let (below, above) = ends
                .take()
                .unwrap_or_else(|| (self.value(&interval.lo, bits), self.value(&interval.hi, bits)));
            match (below.sign(), above.sign()) {
                (Some(Sign::Zero), _) => return Enclosure { hi: interval.lo.clone(), lo: interval.lo },
                (_, Some(Sign::Zero)) => return Enclosure { lo: interval.hi.clone(), hi: interval.hi },
                (a, b) => assert!(a != b, "no change of sign between {} and {}", interval.lo, interval.hi),
            }
            let cell = self.cell(&interval, &below, &above, cells);
            let (x, y) = (self.value(&cell.lo, bits), self.value(&cell.hi, bits));
            if x.sign() == above.sign() {
                (interval.hi, ends) = (cell.lo, Some((below, x)));
                cells = (cells / 2).max(1);
            } else if y.sign() == below.sign() {
                (interval.lo, ends) = (cell.hi, Some((y, above)));
                cells = (cells / 2).max(1);
            } else {
                (interval, ends) = (cell, Some((x, y)));
                cells = (2 * cells).min(1 << 12);
            }
        }
        interval
    }

    /// Enough bits to tell the entry's sign a cell away from the zero, as a rule.
    fn bits_for(&self, interval: &Enclosure, cells: u32) -> u32 {
        (interval.digits() + cells + 96).next_multiple_of(32)
    }

    /// The one of 2^cells equal parts that the secant points to.
    fn cell(&self, interval: &Enclosure, below: &Ball, above: &Ball, cells: u32) -> Enclosure {
        const BITS: u32 = 64;
        let share = below.div(&below.sub(above, BITS), BITS).unwrap_or_else(|| Ball::one().scale2(-1));
        let last = (BigInt::one() << cells) - 1u8;
        let at = share.mid_scaled(i64::from(cells)).0.clamp(BigInt::zero(), last);
        let step = interval.width() / Rational::from_integer(BigInt::one() << cells);
        let lo = &interval.lo + &step * Rational::from_integer(at);
        Enclosure { hi: &lo + step, lo }
    }

    /// How many zeros lie in (0, s), and whether s is one: by the signs of x along the string in exact integers,
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
        // At a free end the slope's zeros count; the rigid shift of C does not.
        let falling = x.is_zero() || (!v.is_zero() && x.sign() != v.sign());
        (changes + u64::from(falling) - u64::from(self.entry == Entry::C), v.is_zero())
    }

    /// Isolates a zero by halving with exact counts: for zeros so close that counts in doubles cannot tell them
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
            let (count, is_zero) = self.exact_count(&cut);
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

/// The rational of least denominator in [lo, hi], 0 < lo ≤ hi (Stern and Brocot): the terms that the continued fractions of
/// lo and hi have in common, and the least that fits for the last one. Whole numbers that stay coprime: nothing is
/// ever reduced.
pub(super) fn simplest(lo: &Rational, hi: &Rational) -> Rational {
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
