//! Edges to any number of digits, from certified signs of the entry at rational points.
//!
//! Quadratic interval refinement (Abbott 2006): the interval is cut into N equal cells, the secant says which
//! one holds the zero, and the entry's signs at the cell's two ends prove it; then N is squared, else its
//! root is taken. The interval at the start is a few units in the last place of a double, where the entry is
//! straight to nearly as many digits again: so N begins that large, and the number of correct digits doubles
//! with every two signs. The proof is nothing but a change of sign. A sign comes from the refine tier of
//! [`crate::verdict`], with as many bits as the cell is small, and from exact arithmetic where that cannot
//! decide: then the point may be the zero itself.

use std::ops::RangeInclusive;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use super::enclosure::{Enclosure, negative_log2};
use super::function::EntryFunction;
use number::{Ball, Rational, Sign};

/// Binary digits that the curvature of an entry takes from the secant's: its other zeros are n or so, at
/// distances of some 1/n of their size. A wrong guess costs two signs.
const STRAIGHT: u32 = 12;

/// Shrinks an interval with one zero, simple and inside, until it is narrower than `relative` times itself.
/// `None` where a zero is neither known nor shown by the sign changes along the orbits of the two ends, and
/// where return maps cannot decide a sign.
pub fn shrink(
    function: &EntryFunction,
    start: &Enclosure,
    relative: &Rational,
    is_isolated: bool,
) -> Option<Enclosure> {
    let mut interval = Interval::from(start);
    let goal = negative_log2(relative);
    // log2 N: an interval of relative width 2^-d has its secant right to some d - STRAIGHT digits more.
    let mut cells = interval.digits().saturating_sub(STRAIGHT).max(2);
    let mut ends: Option<(Ball, Ball)> = None;
    while !interval.is_below(relative) {
        cells = cells.min(goal.saturating_sub(interval.digits()) + 3);
        // Enough bits to decide the entry's sign a cell away from the zero, as a rule.
        let bits = function.bits_for(interval.digits() + cells);
        let (below, above) = match ends.take() {
            Some(ends) => ends,
            None => {
                let value = |at: &BigInt| function.value(&interval.point(at), bits);
                let ((below, from), (above, upto)) = (value(&BigInt::zero())?, value(&interval.width)?);
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
        let value = |at: &BigInt| Some(function.value(&fine.point(at), bits)?.0);
        let (x, y) = (value(&from)?, value(&upto)?);
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

/// From lo to lo + width, in units of 1/(denominator 2^places): whole numbers, so that cutting reduces no
/// fractions.
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

    /// This interval with each unit cut into 2^cells.
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

    /// The one of 2^cells equal parts that the secant through the ends' values points to: where it begins, in
    /// the units of the cut interval, in which it is as wide as this one in its own.
    fn secant(&self, below: &Ball, above: &Ball, cells: u32) -> BigInt {
        let bits = cells + 64;
        let share = below.div(&below.sub(above, bits), bits).unwrap_or_else(|| Ball::one().scale2(-1));
        let last = (BigInt::one() << cells) - 1u8;
        share.mid_scaled(i64::from(cells)).0.clamp(BigInt::zero(), last) * &self.width
    }
}
