//! Balls: rigorous enclosures of real numbers at any precision.
//!
//! A ball is the set [mid − rad, mid + rad] · 2^exp with an integer midpoint of any length and a
//! radius of some 30 bits. Every operation returns a ball that contains all results of the operation
//! on points of its arguments; the argument `bits` is the length to which the midpoint is rounded, and
//! what rounding loses goes into the radius.
//!
//! ```
//! use kickdrift_number::{Ball, Sign};
//! let (two, bits) = (Ball::from_integer(&2.into()), 200);
//! let root = two.sqrt(bits).unwrap();
//! let error = root.square(bits).sub(&two, bits);
//! assert_eq!(error.sign(), None); // contains 0: undecided, as it must be
//! assert!(error.to_f64_enclosure().1 < 1e-57);
//! assert_eq!(Ball::pi(bits).compare(&root), Some(std::cmp::Ordering::Greater));
//! ```

mod arith;
mod constants;
mod functions;
mod magnitude;
mod series;
mod trig;

use std::cmp::Ordering;

use num_bigint::{BigInt, Sign as IntSign};
use num_integer::Integer;
use num_traits::{Float, One, Signed, Zero};

use super::{Rational, Sign, float, rational};
use magnitude::Magnitude;

/// The length of a radius after rounding: what one more rounding adds is below 2^-29 of it.
const RADIUS_BITS: i64 = 30;

/// The largest |exp| of a ball.
const MAX_EXPONENT: i64 = 1 << 60;

/// A number that so many bits leave between two roundings is taken to be half way between two doubles.
const MOST_BITS_OF_NEAREST: u32 = 3072;

/// The set [mid − rad, mid + rad] · 2^exp.
///
/// Invariant: rad ≤ 2^30 + 1; |exp| ≤ 2^60, so that no sum of a few exponents overflows (what is smaller
/// becomes a ball about 0, an operation on what is larger **panics**); exp = 0 in the exact ball 0.
#[derive(Clone, Debug)]
pub struct Ball {
    mid: BigInt,
    rad: u64,
    exp: i64,
}

impl Ball {
    /// The exact number 0.
    pub fn zero() -> Ball {
        Ball { mid: BigInt::zero(), rad: 0, exp: 0 }
    }

    /// The exact number 1.
    pub fn one() -> Ball {
        Ball { mid: BigInt::one(), rad: 0, exp: 0 }
    }

    /// The integer n, exactly.
    pub fn from_integer(n: &BigInt) -> Ball {
        Ball { mid: n.clone(), rad: 0, exp: 0 }
    }

    /// The number that the double x is, exactly; `None` for infinities and NaN.
    pub fn from_f64(x: f64) -> Option<Ball> {
        let (whole, exponent, sign) = Float::integer_decode(x);
        let mid = BigInt::from(i64::from(sign)) * whole;
        x.is_finite().then(|| Ball { mid, rad: 0, exp: i64::from(exponent) }.normalized())
    }

    /// All numbers between two doubles; `None` unless both are finite.
    pub fn between(lo: f64, hi: f64, bits: u32) -> Option<Ball> {
        Some(Ball::from_f64(lo)?.union(&Ball::from_f64(hi)?, bits))
    }

    /// x, rounded to `bits` bits: exact if x is a dyadic rational that fits.
    pub fn from_rational(x: &Rational, bits: u32) -> Ball {
        let (numerator, denominator) = (x.numer(), x.denom());
        if denominator.is_one() {
            return Ball::rounded(numerator.clone(), 0, Magnitude::ZERO, bits);
        }
        // The quotient has bits + 1 or bits + 2 bits; its floor is off by less than one unit.
        let shift = i64::from(bits) + 2 + denominator.bits() as i64 - numerator.bits() as i64;
        let (quotient, remainder) = if shift >= 0 {
            (numerator << shift as u64).div_mod_floor(denominator)
        } else {
            numerator.div_mod_floor(&(denominator << (-shift) as u64))
        };
        let error = if remainder.is_zero() { Magnitude::ZERO } else { Magnitude::power_of_two(-shift) };
        Ball::rounded(quotient, -shift, error, bits)
    }

    /// The ball about mid 2^exp with radius `error`, its midpoint rounded down to `bits` bits, or fewer
    /// where the error makes the last ones meaningless.
    fn rounded(mid: BigInt, exp: i64, error: Magnitude, bits: u32) -> Ball {
        let excess = (mid.bits() as i64 - i64::from(bits)).max(0);
        let shift = error.top().map_or(excess, |top| excess.max(top - RADIUS_BITS - exp));
        if shift == 0 {
            return Ball { rad: error.units(exp), mid, exp }.normalized();
        }
        let inexact = mid.trailing_zeros().is_some_and(|zeros| zeros < shift as u64);
        let exp = exp + shift;
        // Rounding down loses less than one unit.
        Ball { mid: mid >> shift, rad: error.units(exp) + u64::from(inexact), exp }.normalized()
    }

    /// A ball that contains this one, its midpoint rounded to `bits` bits.
    pub fn round(&self, bits: u32) -> Ball {
        Ball::rounded(self.mid.clone(), self.exp, self.radius(), bits)
    }

    fn normalized(mut self) -> Ball {
        if self.rad == 0 && self.mid.is_zero() {
            self.exp = 0;
        }
        if self.exp >= -MAX_EXPONENT {
            assert!(self.exp <= MAX_EXPONENT, "exponent of a ball");
            return self;
        }
        Ball::rounded(BigInt::zero(), -MAX_EXPONENT, self.magnitude(), 64)
    }

    /// This ball with its radius enlarged by `extra`.
    fn widened(self, extra: Magnitude, bits: u32) -> Ball {
        if extra.is_zero() {
            return self;
        }
        let error = self.radius().plus(extra);
        Ball::rounded(self.mid, self.exp, error, bits)
    }

    /// All points within `distance` of 0, a double that is not negative.
    pub fn about_zero(distance: f64) -> Ball {
        let (whole, exponent, _) = Float::integer_decode(distance);
        // The first 30 of 53 bits, rounded up.
        Ball { mid: BigInt::zero(), rad: (whole >> 23) + 1, exp: i64::from(exponent) + 23 }
    }

    fn radius(&self) -> Magnitude {
        Magnitude::new(self.rad, self.exp)
    }

    /// An upper bound of |mid| 2^exp.
    fn mid_magnitude(&self) -> Magnitude {
        Magnitude::upper(self.mid.magnitude(), self.exp)
    }

    /// An upper bound of |x| over the ball.
    fn magnitude(&self) -> Magnitude {
        self.mid_magnitude().plus(self.radius())
    }

    /// The midpoint, as an exact ball.
    pub fn midpoint(&self) -> Ball {
        Ball { mid: self.mid.clone(), rad: 0, exp: self.exp }.normalized()
    }

    /// The ends of the ball, as exact balls.
    fn ends(&self) -> (Ball, Ball) {
        let end = |mid: BigInt| Ball { mid, rad: 0, exp: self.exp }.normalized();
        (end(&self.mid - self.rad), end(&self.mid + self.rad))
    }

    /// The exponent t with |x| < 2^t for every x in the ball; `None` for the exact ball 0.
    pub fn top(&self) -> Option<i64> {
        self.magnitude().top()
    }

    /// Is the ball a single number?
    pub fn is_exact(&self) -> bool {
        self.rad == 0
    }

    /// Does the ball contain 0?
    pub fn contains_zero(&self) -> bool {
        self.mid.bits() <= 64 && *self.mid.magnitude() <= self.rad.into()
    }

    /// The sign that all points of the ball share; `None` if there is none, that is: undecided.
    ///
    /// `Sign::Zero` is answered for the exact ball 0 only.
    pub fn sign(&self) -> Option<Sign> {
        match self.mid.sign() {
            IntSign::NoSign if self.rad == 0 => Some(Sign::Zero),
            _ if self.contains_zero() => None,
            IntSign::Minus => Some(Sign::Negative),
            _ => Some(Sign::Positive),
        }
    }

    /// The order of every point of this ball to every point of the other; `None` if it varies.
    pub fn compare(&self, other: &Ball) -> Option<Ordering> {
        if self.rad == 0 && other.rad == 0 {
            return Some(self.compare_exact(other));
        }
        let ((lower, upper), (other_lower, other_upper)) = (self.ends(), other.ends());
        if upper.compare_exact(&other_lower).is_lt() {
            Some(Ordering::Less)
        } else if lower.compare_exact(&other_upper).is_gt() {
            Some(Ordering::Greater)
        } else {
            None
        }
    }

    /// The order of two exact balls.
    fn compare_exact(&self, other: &Ball) -> Ordering {
        // With 64 guard bits the difference is exact unless the sizes differ so much that its sign is plain.
        let bits = self.mid.bits().max(other.mid.bits()) as u32 + 64;
        self.sub(other, bits).sign().expect("not a rounded zero").to_i8().cmp(&0)
    }

    /// Whether it is positive and no wider than its distance from 0, so that a quotient by it is sharp.
    pub fn is_away_from_zero(&self) -> bool {
        self.mid.is_positive() && self.mid >= BigInt::from(self.rad) * 3
    }

    /// The least point of the ball, exactly.
    pub fn lower(&self) -> Rational {
        rational::scale2(&(&self.mid - self.rad), self.exp)
    }

    /// The largest point of the ball, exactly.
    pub fn upper(&self) -> Rational {
        rational::scale2(&(&self.mid + self.rad), self.exp)
    }

    /// Does the ball contain x?
    pub fn contains(&self, x: &Rational) -> bool {
        self.lower() <= *x && *x <= self.upper()
    }

    /// The largest double ≤ the ball and the smallest double ≥ the ball (infinite on overflow).
    pub fn to_f64_enclosure(&self) -> (f64, f64) {
        let lower = float::enclose_dyadic(&(&self.mid - self.rad), self.exp).0;
        let upper = float::enclose_dyadic(&(&self.mid + self.rad), self.exp).1;
        (lower, upper)
    }

    /// The double nearest to the midpoint, beyond the largest one that: for display and first guesses, not
    /// for proofs.
    pub fn mid_f64(&self) -> f64 {
        float::nearest_dyadic(&self.mid, self.exp).clamp(f64::MIN, f64::MAX)
    }

    /// The double nearest to a number that is evaluated in ever more bits, as both ends of its enclosure
    /// round to it. Of a number half way between two doubles, which no bits tell apart, one of these.
    ///
    /// ```
    /// use kickdrift_number::Ball;
    /// let sine = |bits| Ball::pi(bits).div(&Ball::from_integer(&6.into()), bits).unwrap().sin(bits);
    /// assert_eq!(Ball::nearest_f64(sine), 0.5);
    /// ```
    pub fn nearest_f64(evaluated: impl Fn(u32) -> Ball) -> f64 {
        let mut bits = 96;
        loop {
            let ball = evaluated(bits);
            if bits >= MOST_BITS_OF_NEAREST || ball.has_nearest_f64() {
                return ball.mid_f64();
            }
            bits *= 2;
        }
    }

    /// Whether one double is the nearest to every point of the ball: [`Ball::mid_f64`], unless it is too
    /// large for one.
    pub fn has_nearest_f64(&self) -> bool {
        let end = |mid: BigInt| float::nearest_dyadic(&mid, self.exp);
        end(&self.mid - self.rad) == end(&self.mid + self.rad)
    }

    /// n and e of the midpoint n 2^e.
    pub fn middle(&self) -> (&BigInt, i64) {
        (&self.mid, self.exp)
    }

    /// A number that is not 0, known to so many bits of itself: `evaluated` in ever more bits until it is.
    pub(crate) fn to_accuracy(bits: u32, evaluated: impl Fn(u32) -> Ball) -> Ball {
        let mut working = bits + 32;
        loop {
            let ball = evaluated(working);
            if ball.relative_accuracy_bits() > i64::from(bits) {
                return ball.round(bits + 2);
            }
            working *= 2;
        }
    }

    /// How many leading bits the radius leaves intact, up to one: about log2 |mid / rad|.
    /// Negative for balls about 0; `i64::MAX` for exact balls.
    pub fn relative_accuracy_bits(&self) -> i64 {
        if self.rad == 0 {
            i64::MAX
        } else {
            self.mid.bits() as i64 - (64 - i64::from(self.rad.leading_zeros()))
        }
    }

    /// The fixed-point number nearest below the midpoint, and its error: (M, E) with
    /// M = ⌊mid 2^f⌋ and |x 2^f − M| ≤ E for every x in the ball.
    pub fn mid_scaled(&self, fraction_bits: i64) -> (BigInt, BigInt) {
        let shift = self.exp + fraction_bits;
        if shift >= 0 {
            return (&self.mid << shift, BigInt::from(self.rad) << shift);
        }
        let inexact = self.mid.trailing_zeros().is_some_and(|zeros| zeros < shift.unsigned_abs());
        // ⌈rad 2^shift⌉, and one more for the midpoint's floor.
        let radius = -((-BigInt::from(self.rad)) >> -shift);
        (&self.mid >> -shift, radius + u8::from(inexact))
    }

    /// The integer nearest to the midpoint.
    fn mid_nearest(&self) -> BigInt {
        (self.mid_scaled(1).0 + 1) >> 1
    }

    /// A ball that contains both, and so everything between them.
    pub fn union(&self, other: &Ball, bits: u32) -> Ball {
        // A point of either is at most |difference of the midpoints| / 2 + its radius from their middle.
        let (a, b) = (self.midpoint(), other.midpoint());
        let half_gap = a.sub(&b, bits).magnitude().scale2(-1);
        let (r, s) = (self.radius(), other.radius());
        let larger = if self.rad_at_least(other) { r } else { s };
        a.add(&b, bits).scale2(-1).widened(half_gap.plus(larger), bits)
    }

    fn rad_at_least(&self, other: &Ball) -> bool {
        self.radius().at_least(other.radius())
    }

    /// Is |mid| > 2^k?
    fn mid_exceeds(&self, k: i64) -> bool {
        let length = self.mid.bits() as i64 + self.exp;
        !self.mid.is_zero() && (length > k + 1 || (length == k + 1 && !is_power_of_two(&self.mid)))
    }
}

fn is_power_of_two(n: &BigInt) -> bool {
    n.trailing_zeros().is_some_and(|zeros| zeros + 1 == n.abs().bits())
}

#[cfg(test)]
mod tests;
