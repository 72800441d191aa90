//! A number as the unevaluated sum of two doubles.

use num_traits::{Signed, ToPrimitive};

use super::vector::FloatRing;
use super::{Ball, Rational, float, rational};

/// Farther from 1 no number is taken from a ball.
const LARGEST: f64 = 1e30;

/// hi + lo, |lo| ≤ ulp(hi)/2; of a vector in each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twofold<V = f64> {
    pub hi: V,
    pub lo: V,
}

impl<V: FloatRing> Twofold<V> {
    /// hi + lo, |lo| ≤ |hi| (Dekker).
    #[inline(always)]
    fn joined(hi: V, lo: V) -> Self {
        let sum = hi.add(lo);
        Twofold { hi: sum, lo: lo.sub(sum.sub(hi)) }
    }

    /// a + b to within 2^-104 (|a| + |b|).
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        let (hi, lo) = self.hi.two_sum(other.hi);
        Twofold::joined(hi, lo.add(self.lo.add(other.lo)))
    }

    /// a − b, likewise.
    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        let (hi, lo) = self.hi.two_sub(other.hi);
        Twofold::joined(hi, lo.add(self.lo.sub(other.lo)))
    }

    /// a b to within 2^-101 relative.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        let (hi, lost) = self.hi.two_product(other.hi);
        Twofold::joined(hi, lost.add(self.hi.mul_add(other.lo, self.lo.mul(other.hi))))
    }

    /// a b to within 2^-103 relative; exact where b is a power of two.
    #[inline(always)]
    pub fn scaled(self, b: V) -> Self {
        let (hi, lost) = self.hi.two_product(b);
        Twofold::joined(hi, self.lo.mul_add(b, lost))
    }
}

impl Twofold {
    /// π to within 2^-108 relative.
    pub const PI: Twofold = Twofold { hi: std::f64::consts::PI, lo: 1.224_646_799_147_353_2e-16 };

    pub const ZERO: Twofold = Twofold { hi: 0.0, lo: 0.0 };

    /// a + b, exactly.
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Twofold {
        let (hi, lo) = a.two_sum(b);
        Twofold { hi, lo }
    }

    /// A half of it, exactly.
    #[inline(always)]
    pub fn half(self) -> Twofold {
        Twofold { hi: 0.5 * self.hi, lo: 0.5 * self.lo }
    }

    /// a + b for a small b, to within 2^-104 (|a.lo| + |b|).
    #[inline(always)]
    pub fn and(self, small: f64) -> Twofold {
        Twofold::joined(self.hi, self.lo + small)
    }

    /// a + b to within 2^-104 of itself, whatever cancels (Joldes, Muller, Popescu 2017, theorem 3.1: 3 u² +
    /// 13 u³).
    #[inline(always)]
    pub fn accurate_sum(self, other: Twofold) -> Twofold {
        let (s, t) = (Twofold::sum(self.hi, other.hi), Twofold::sum(self.lo, other.lo));
        let first = Twofold::joined(s.hi, s.lo + t.hi);
        Twofold::joined(first.hi, t.lo + first.lo)
    }

    /// a − b, likewise.
    #[inline(always)]
    pub fn accurate_difference(self, other: Twofold) -> Twofold {
        self.accurate_sum(other.negative())
    }

    /// a/b to within 2^-103 relative.
    #[inline(always)]
    pub fn over(self, b: f64) -> Twofold {
        let hi = self.hi / b;
        Twofold::joined(hi, ((-hi).mul_add(b, self.hi) + self.lo) / b)
    }

    /// √a to within 2^-101 relative, a > 0.
    #[inline(always)]
    pub fn root(self) -> Twofold {
        // One step of Newton's: with hi = √a (1 + e), |e| ≤ 2^-52.9, the rest e²/2 is below 2^-106.
        let hi = self.hi.sqrt();
        Twofold::joined(hi, ((-hi).mul_add(hi, self.hi) + self.lo) / (2.0 * hi))
    }

    /// a/b to within 2^-100 relative.
    #[inline(always)]
    pub fn divided_by(self, b: Twofold) -> Twofold {
        let hi = self.hi / b.hi;
        // a − hi b: the first difference is exact.
        let rest = (-hi).mul_add(b.hi, self.hi) + (self.lo - hi * b.lo);
        Twofold::joined(hi, rest / b.hi)
    }

    /// −a.
    #[inline(always)]
    pub fn negative(self) -> Twofold {
        Twofold { hi: -self.hi, lo: -self.lo }
    }

    /// |a|.
    #[inline(always)]
    pub fn magnitude(self) -> Twofold {
        if self.hi < 0.0 { self.negative() } else { self }
    }

    /// a/b to within 2^-104 relative, for whole numbers that doubles hold.
    #[inline]
    pub fn quotient(a: u64, b: u64) -> Option<Twofold> {
        const EXACT: u64 = 1 << 53;
        (a.max(b) <= EXACT).then(|| Twofold::of_whole(a as f64, b as f64))
    }

    /// a/b to within 2^-104 relative, for doubles that are whole numbers.
    #[inline(always)]
    pub fn of_whole(a: f64, b: f64) -> Twofold {
        let hi = a / b;
        // The quotient's remainder is a double.
        Twofold { hi, lo: (-hi).mul_add(b, a) / b }
    }

    /// x to within 2^-100 relative; `None` where the ball is wider than that, negative, or far from 1.
    pub fn from_ball(x: &Ball) -> Option<Twofold> {
        let near = x.mid_f64();
        if !(1.0 / LARGEST..=LARGEST).contains(&near) {
            return None;
        }
        // 105 places below the leading one.
        Twofold::from_fixed(x, 105 - ((near.to_bits() >> 52) as i64 - 1023), 32)
    }

    /// The precision that [`Twofold::near`] asks for.
    pub const ENCLOSURE_BITS: u32 = 160;

    /// x to within 2^-103 relative, of either sign; `None` where the ball is wider than that, or x is 0 or
    /// far from 1.
    pub fn near(x: &Ball) -> Option<Twofold> {
        let near = x.mid_f64();
        if !(1.0 / LARGEST..=LARGEST).contains(&near.abs()) {
            return None;
        }
        Twofold::from_fixed(x, 105 - ((near.abs().to_bits() >> 52) as i64 - 1023), 2)
    }

    /// x to within (`most` + 1) 2^-places, |x| 2^places below 2^107; `None` where the ball is wider.
    pub fn from_fixed(x: &Ball, places: i64, most: u64) -> Option<Twofold> {
        let (middle, error) = x.mid_scaled(places);
        let (middle, unit) = (middle.to_i128()?, float::power_of_two(-places as i32));
        let (high, low) = ((middle >> 53) as f64 * 2f64.powi(53), (middle & ((1 << 53) - 1)) as f64);
        (error <= most.into()).then(|| Twofold::sum(high * unit, low * unit))
    }

    /// x to within 2^-104 relative as long as neither part is subnormal, hi being the double nearest to x.
    pub fn from_rational(x: &Rational) -> Twofold {
        if let (Some(n @ 1..), Some(d)) = (x.numer().magnitude().to_u64(), x.denom().to_u64()) {
            let (hi, lo) = float::short_quotient(n, d);
            let two = Twofold { hi, lo };
            return if x.is_negative() { two.negative() } else { two };
        }
        let hi = rational::to_f64(x);
        let rest = match rational::from_f64_exact(hi) {
            Some(exact) if exact != *x => rational::to_f64(&(x - exact)),
            _ => 0.0,
        };
        Twofold { hi, lo: rest }
    }

    /// The double nearest to the product of what two stand for, each within 2^-104 relative; `None` where
    /// that is not certain, or a number far from 1.
    pub fn nearest_product(self, other: Twofold) -> Option<f64> {
        const RANGE: std::ops::Range<f64> = 1e-250..1e250;
        // Within 2^-101 + 2 2^-104 relative, and what the sums below round.
        let product = self.times(other);
        let slack = product.hi.abs() * 2f64.powi(-99);
        let (least, most) = (product.hi + (product.lo - slack), product.hi + (product.lo + slack));
        let in_range = [self.hi, other.hi, product.hi].iter().all(|x| RANGE.contains(&x.abs()));
        (in_range && least == most).then_some(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rational::ratio;
    use crate::{Laurent, Real};
    use proptest::prelude::*;

    fn ball(x: Twofold) -> Ball {
        let exact = |x: f64| Ball::from_rational(&Rational::from_float(x).unwrap(), 200);
        exact(x.hi).add(&exact(x.lo), 200)
    }

    /// |x / reference − 1| ≤ 2^-bits.
    fn within(x: Twofold, reference: &Ball, bits: i64) -> bool {
        let off = ball(x).sub(reference, 300).abs().div(&reference.abs(), 64).unwrap();
        off.upper() <= Rational::from_integer(2.into()).pow(-bits as i32)
    }

    proptest! {
        #[test]
        fn operations_are_as_near_as_they_say(a in 1i64.., b in 1i64.., c in 1i64.., d in 1i64..) {
            let (x, y) = (ratio(a, b), ratio(c, d));
            let (exact_x, exact_y) = (Ball::from_rational(&x, 300), Ball::from_rational(&y, 300));
            let two = |x: &Ball| Twofold::from_ball(x).unwrap();
            prop_assert!(within(two(&exact_x), &exact_x, 100));
            let negative = exact_x.neg();
            prop_assert!(within(Twofold::near(&negative).unwrap(), &negative, 103));
            let (x, y) = (two(&exact_x), two(&exact_y));
            let (in_x, in_y) = (ball(x), ball(y));
            prop_assert!(within(x.root(), &in_x.sqrt(300).unwrap(), 101));
            prop_assert!(within(x.divided_by(y), &in_x.div(&in_y, 300).unwrap(), 100));
            prop_assert!(within(x.times(y), &in_x.mul(&in_y, 300), 101));
            prop_assert!(within(x.plus(y), &in_x.add(&in_y, 300), 104));
        }

        #[test]
        fn numbers_in_two_doubles_are_as_near_as_they_say(a in -1i64 << 53..1 << 53, b in 1i64..1 << 53, k in -3i32..4) {
            let x = Laurent::monomial(ratio(a, b), k);
            let (reduced, small) = (ratio(a, b), k.abs() <= 2 && a != 0);
            prop_assert!(reduced.denom().bits() <= 53);
            prop_assert_eq!(x.two_doubles().is_some(), small);
            if let Some((hi, lo)) = x.two_doubles() {
                let two = Twofold { hi, lo };
                prop_assert!(hi + lo == hi && within(two, &x.enclosure(300), 99));
            }
        }
    }

    proptest! {
        #[test]
        fn products_are_rounded_as_exact_ones(
            a in any::<i64>(), b in 1i64.., c in any::<i64>(), d in 1i64.., tie in 0u32..3, scale in 0u32..200,
        ) {
            // Products of whole doubles lie on ties, or next to them.
            let whole = |x: i64, bits: u32| Rational::from_integer((x >> bits).into());
            let (x, y) = match tie {
                0 => (ratio(a, b), ratio(c, d)),
                1 => (whole(a, 11), whole(c, 61)),
                _ => (whole(a, 11), whole(c, 61) + ratio(1, 1 << 60)),
            };
            let x = x / Rational::from_integer(2.into()).pow(scale as i32);
            let (two_x, two_y) = (Twofold::from_rational(&x), Twofold::from_rational(&y));
            prop_assert!(two_x.hi == rational::to_f64(&x) && two_y.hi == rational::to_f64(&y));
            let rounded = two_x.nearest_product(two_y);
            let exact = rational::product_to_f64(&x, &y);
            prop_assert!(rounded.is_none_or(|rounded| rounded == exact));
            prop_assert!(rounded.is_some() || tie > 0 || exact == 0.0);
        }
    }

    #[test]
    fn pi_is_as_near_as_it_says() {
        assert!(within(Twofold::PI, &Ball::pi(300), 108));
    }

    #[test]
    fn wide_balls_and_far_ones_are_refused() {
        let third = Ball::from_rational(&ratio(1, 3), 90);
        assert!(Twofold::from_ball(&third).is_none() && Twofold::near(&third).is_none());
        assert!(Twofold::near(&Ball::zero()).is_none());
        assert!(Twofold::from_ball(&Ball::from_rational(&ratio(1, 3), 110).scale2(200)).is_none());
        assert!(Twofold::from_ball(&Ball::from_rational(&ratio(-1, 3), 110)).is_none());
    }
}
