//! Edges to any number of digits, from certified signs of the entry at rational points.
//!
//! Quadratic interval refinement (Abbott 2006): the interval is cut into N equal cells, the secant says which one
//! holds the zero, and the entry's signs at the cell's two ends prove it; then N is squared, else its root is
//! taken. The interval at the start is a few units in the last place of a double, where the entry is straight to
//! nearly as many digits again: so N begins that large, and the number of correct digits doubles with every two
//! signs. The proof is nothing but a change of sign. A sign comes from the refine tier of [`crate::verdict`], with as many bits as the cell is small,
//! and from exact arithmetic where that cannot tell: then the point may be the zero itself.

use std::ops::RangeInclusive;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use super::spectrum::Edge;
use super::string::Entry;
use crate::error::Result;
use crate::number::{Ball, Ratio, Rational, Sign, rational};
use crate::orbit::refine;
use crate::propagator::TwoClocks;
use crate::schedule::Schedule;
use crate::verdict::Decidable;

/// An interval with rational ends that holds exactly one zero of an entry; a point where that is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    pub lo: Rational,
    pub hi: Rational,
}

/// An entry of the half period as a function of s, for fixed p/q and ρ.
#[derive(Clone, Debug)]
pub(super) struct Function {
    ratio: Ratio,
    /// The slow clock's mass ρ p/q, in those of the fast one.
    pub slow: Rational,
    pub schedule: Schedule,
    pub entry: Entry,
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
}

impl Function {
    pub fn new(ratio: Ratio, rho: &Rational, entry: Entry) -> Result<Self> {
        let slow = rho * Rational::from(ratio);
        Ok(Function { ratio, slow, schedule: Schedule::two_clocks(ratio)?, entry })
    }

    fn clocks(&self, s: &Rational) -> TwoClocks<Rational> {
        TwoClocks::new(self.ratio, s.clone(), s * &self.slow)
    }

    /// The entry's exact sign at s.
    pub fn exact_sign(&self, s: &Rational) -> Sign {
        Decidable::half_signs(&self.clocks(s)).all()[self.entry as usize]
    }

    /// In no lowest terms: balls do not need them.
    pub fn unreduced_clocks(&self, s: &Rational) -> TwoClocks<Rational> {
        let slow = Rational::new_raw(s.numer() * self.slow.numer(), s.denom() * self.slow.denom());
        TwoClocks::new(self.ratio, s.clone(), slow)
    }

    /// The entry's value at s, with a certified sign, from `bits` bits; the exact ball 0 where it is 0. And how many zeros lie
    /// below s, if those bits tell.
    fn value(&self, s: &Rational, bits: u32) -> (Ball, Option<u64>) {
        let clocks = self.unreduced_clocks(s);
        let mut working = bits;
        while working <= PATIENCE * bits {
            if let Some(end) = refine::run_one(&clocks, &self.schedule, working, self.entry.starts_free()) {
                let count = self.counted(&end);
                let value = if self.entry.ends_free() { end.v } else { end.x };
                if value.sign().is_some() {
                    return (value, count);
                }
            }
            working *= 2;
        }
        (Ball::from_integer(&self.exact_sign(s).to_i8().into()), None)
    }

    /// Shrinks an interval with one zero, simple and inside, until it is narrower than `relative` times itself. `None`
    /// where that there is one is neither known nor told by the sign changes along the two ends' orbits.
    pub fn shrink(&self, start: &Enclosure, relative: &Rational, is_isolated: bool) -> Option<Enclosure> {
        let mut interval = Interval::from(start);
        let goal = negative_log2(relative);
        // log2 N: an interval of relative width 2^-d has its secant right to some d - STRAIGHT digits more.
        let mut cells = interval.digits().saturating_sub(STRAIGHT).max(2);
        let mut ends: Option<(Ball, Ball)> = None;
        while !interval.is_below(relative) {
            cells = cells.min(goal.saturating_sub(interval.digits()) + 3);
            // Enough bits to tell the entry's sign a cell away from the zero, as a rule.
            let bits = (interval.digits() + cells + 96).next_multiple_of(32);
            let (below, above) = match ends.take() {
                Some(ends) => ends,
                None => {
                    let value = |at: &BigInt| self.value(&interval.point(at), bits);
                    let ((below, from), (above, upto)) = (value(&BigInt::zero()), value(&interval.width));
                    let is_alone = from.zip(upto).is_some_and(|(from, upto)| upto == from + 1);
                    if !(is_isolated || is_alone) {
                        return None;
                    }
                    (below, above)
                }
            };
            match (below.sign(), above.sign()) {
                (Some(Sign::Zero), _) => return Some(interval.at(&BigInt::zero())),
                (_, Some(Sign::Zero)) => return Some(interval.at(&interval.width)),
                (a, b) => assert!(a != b, "one zero between {} and {}", start.lo, start.hi),
            }
            let (fine, from) = (interval.cut(cells), interval.secant(&below, &above, cells));
            let upto = &from + &interval.width;
            let value = |at: &BigInt| self.value(&fine.point(at), bits).0;
            let (x, y) = (value(&from), value(&upto));
            let all = BigInt::zero()..=fine.width.clone();
            let (part, signs, is_cell) = if x.sign() == above.sign() {
                (all.start()..=&from, (below, x), false)
            } else if y.sign() == below.sign() {
                (&upto..=all.end(), (y, above), false)
            } else {
                (&from..=&upto, (x, y), true)
            };
            (interval, ends) = (fine.part(part), Some(signs));
            cells = if is_cell { (2 * cells).min(1 << 12) } else { (cells / 2).max(1) };
        }
        Some(Enclosure { lo: interval.point(&BigInt::zero()), hi: interval.point(&interval.width) })
    }
}

/// From lo to lo + width, in units of 1/(denominator 2^places): whole numbers, so that cutting reduces no fractions.
#[derive(Clone, Debug)]
struct Interval {
    lo: BigInt,
    width: BigInt,
    /// 1 where the ends are dyadic, as those of doubles are.
    denominator: BigInt,
    places: u64,
}

impl From<&Enclosure> for Interval {
    fn from(enclosure: &Enclosure) -> Self {
        let common = enclosure.lo.denom().lcm(enclosure.hi.denom());
        let numerator = |x: &Rational| x.numer() * (&common / x.denom());
        let (lo, hi) = (numerator(&enclosure.lo), numerator(&enclosure.hi));
        let places = common.trailing_zeros().unwrap_or(0);
        Interval { width: hi - &lo, lo, denominator: common >> places, places }
    }
}

impl Interval {
    /// −log2 of the relative width, to within 2; 0 for a point.
    fn digits(&self) -> u32 {
        let length = (&self.lo + &self.width).bits();
        if self.width.is_zero() { 0 } else { length.saturating_sub(self.width.bits()) as u32 }
    }

    fn is_below(&self, relative: &Rational) -> bool {
        &self.width * relative.denom() <= &self.lo * relative.numer()
    }

    /// The point so many units above lo.
    fn point(&self, at: &BigInt) -> Rational {
        let numerator = &self.lo + at;
        let twos = numerator.trailing_zeros().unwrap_or(self.places).min(self.places);
        let (numerator, denominator) = (numerator >> twos, &self.denominator << (self.places - twos));
        if self.denominator.is_one() {
            Rational::new_raw(numerator, denominator)
        } else {
            Rational::new(numerator, denominator)
        }
    }

    /// That point alone.
    fn at(&self, at: &BigInt) -> Enclosure {
        let point = self.point(at);
        Enclosure { lo: point.clone(), hi: point }
    }

    /// The same in units of 2^cells in what was one.
    fn cut(&self, cells: u32) -> Interval {
        Interval {
            lo: &self.lo << cells,
            width: &self.width << cells,
            denominator: self.denominator.clone(),
            places: self.places + u64::from(cells),
        }
    }

    /// A part of it.
    fn part(&self, part: RangeInclusive<&BigInt>) -> Interval {
        let (from, upto) = part.into_inner();
        Interval { lo: &self.lo + from, width: upto - from, ..self.clone() }
    }

    /// The one of 2^cells equal parts that the secant through the ends' values points to: where it begins, in the units
    /// of the cut interval, in which it is as wide as this one in its own.
    fn secant(&self, below: &Ball, above: &Ball, cells: u32) -> BigInt {
        let bits = cells + 64;
        let share = below.div(&below.sub(above, bits), bits).unwrap_or_else(|| Ball::one().scale2(-1));
        let last = (BigInt::one() << cells) - 1u8;
        share.mid_scaled(i64::from(cells)).0.clamp(BigInt::zero(), last) * &self.width
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
