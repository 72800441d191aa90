//! The numbers that a pair's constants are made of: balls, and two doubles with a radius, a hundred times as
//! fast, where their digits suffice.

use num_bigint::BigUint;

use super::coefficient::{Coefficient, exact, near_ball, quotient};
use number::{Ball, Rational, Real, Sign, Twofold, power_of_two};

/// A real number, enclosed. Numbers of one pair have the same bits.
pub trait Enclosure: Clone {
    /// `None` where this kind of number does not hold x well.
    fn of<S: Real>(x: &S, bits: u32) -> Option<Self>;
    /// n/d.
    fn quotient(n: i128, d: u128, bits: u32) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    /// `None` where the divisor may be zero.
    fn over(&self, other: &Self) -> Option<Self>;
    /// `None` of what may be zero or less.
    fn root(&self) -> Option<Self>;
    fn negative(&self) -> Self;
    fn scale2(&self, k: i32) -> Self;
    /// Doubles below and above.
    fn ends(&self) -> (f64, f64);
    /// About log₂ |x|, however far from doubles.
    fn log2(&self) -> i32;
    fn ball(&self) -> Ball;
    /// A number near it, and how far from what is enclosed at most.
    fn near<T: Coefficient>(&self) -> (T, f64);
    /// All numbers within `error` of one that is no longer than two doubles, or than a ball where it is one.
    fn within<T: Coefficient>(middle: &T, error: f64, bits: u32) -> Self;

    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    /// A sign that is certain; zero only of what is enclosed exactly.
    fn sign(&self) -> Option<Sign> {
        match self.ends() {
            (lower, _) if lower > 0.0 => Some(Sign::Positive),
            (_, upper) if upper < 0.0 => Some(Sign::Negative),
            _ => None,
        }
    }
}

/// [[a, b], [c, d]]
pub type Matrix<E> = [E; 4];

/// `later` after `earlier`.
pub fn product<E: Enclosure>([a, b, c, d]: &Matrix<E>, [e, f, g, h]: &Matrix<E>) -> Matrix<E> {
    let of = |a: &E, e: &E, b: &E, g: &E| a.times(e).plus(&b.times(g));
    [of(a, e, b, g), of(a, f, b, h), of(c, e, d, g), of(c, f, d, h)]
}

/// A ball and the bits that it is computed with.
#[derive(Clone)]
pub struct Wide {
    ball: Ball,
    bits: u32,
}

impl Wide {
    pub fn new(ball: Ball, bits: u32) -> Self {
        Wide { ball, bits }
    }

    fn with(&self, ball: Ball) -> Self {
        Wide { ball, bits: self.bits }
    }
}

impl Enclosure for Wide {
    fn of<S: Real>(x: &S, bits: u32) -> Option<Self> {
        Some(Wide::new(x.enclosure(bits), bits))
    }

    fn quotient(n: i128, d: u128, bits: u32) -> Self {
        Wide::new(Ball::from_rational(&Rational::new(n.into(), d.into()), bits), bits)
    }

    fn plus(&self, other: &Self) -> Self {
        self.with(self.ball.add(&other.ball, self.bits))
    }

    fn times(&self, other: &Self) -> Self {
        self.with(self.ball.mul(&other.ball, self.bits))
    }

    fn over(&self, other: &Self) -> Option<Self> {
        self.ball.div(&other.ball, self.bits).map(|ball| self.with(ball))
    }

    fn root(&self) -> Option<Self> {
        self.sign().filter(|&sign| sign == Sign::Positive)?;
        self.ball.sqrt(self.bits).map(|ball| self.with(ball))
    }

    fn negative(&self) -> Self {
        self.with(self.ball.neg())
    }

    fn scale2(&self, k: i32) -> Self {
        self.with(self.ball.scale2(k.into()))
    }

    fn ends(&self) -> (f64, f64) {
        self.ball.to_f64_enclosure()
    }

    fn log2(&self) -> i32 {
        self.ball.top().map_or(0, |top| top.clamp(-(1 << 30), 1 << 30) as i32)
    }

    fn sign(&self) -> Option<Sign> {
        self.ball.sign()
    }

    fn ball(&self) -> Ball {
        self.ball.clone()
    }

    fn near<T: Coefficient>(&self) -> (T, f64) {
        near_ball(&self.ball)
    }

    fn within<T: Coefficient>(middle: &T, error: f64, bits: u32) -> Self {
        Wide::new(middle.ball().add(&Ball::about_zero(error), bits), bits)
    }
}

/// |x − middle| ≤ radius.
#[derive(Clone, Debug)]
pub struct Close {
    middle: Twofold,
    radius: f64,
}

/// Some roundings of positive doubles.
const UP: f64 = 1.0 + 1e-14;

/// More than underflow takes from one operation on what is below 10^60.
const FLOOR: f64 = 1e-240;

/// Strengths farther from 1 are left to balls.
const FARTHEST: f64 = 1e30;

/// 2^-k.
const fn unit(k: u64) -> f64 {
    f64::from_bits((1023 - k) << 52)
}

impl Close {
    pub fn new(middle: Twofold, radius: f64) -> Self {
        Close { middle, radius: radius * UP + FLOOR }
    }

    /// |x| at most.
    fn size(&self) -> f64 {
        (self.middle.hi.abs() + self.middle.lo.abs() + self.radius) * UP
    }

    /// The double near it, and how far at most.
    pub fn double(&self) -> (f64, f64) {
        (self.middle.hi, (self.middle.lo.abs() + self.radius) * UP)
    }
}

impl Enclosure for Close {
    fn of<S: Real>(x: &S, _: u32) -> Option<Self> {
        let two = x.two_doubles().map(|(hi, lo)| Twofold { hi, lo });
        let middle = two.or_else(|| Twofold::near(&x.enclosure(Twofold::ENCLOSURE_BITS)))?;
        let size = middle.hi.abs();
        (1.0 / FARTHEST..FARTHEST).contains(&size).then(|| Close::new(middle, unit(99) * size))
    }

    fn quotient(n: i128, d: u128, _: u32) -> Self {
        let middle = quotient(n, d);
        Close::new(middle, 3.0 * unit(101) * middle.hi.abs())
    }

    fn plus(&self, other: &Self) -> Self {
        let rounding = unit(104) * (self.size() + other.size());
        Close::new(self.middle.plus(other.middle), self.radius + other.radius + rounding)
    }

    fn times(&self, other: &Self) -> Self {
        let rounding = unit(101) * self.size() * other.size();
        let carried = self.size() * other.radius + other.size() * self.radius;
        Close::new(self.middle.times(other.middle), carried + rounding)
    }

    /// a/b − A/B = (a − A b/B)/b, and |b| is at least |B| − radius.
    fn over(&self, other: &Self) -> Option<Self> {
        let (lower, upper) = other.ends();
        let least = lower.max(-upper);
        let middle = self.middle.divided_by(other.middle);
        let quotient = middle.hi.abs() * UP;
        let carried = (self.radius + quotient * other.radius) / least + unit(100) * quotient;
        (least > 0.0 && carried.is_finite()).then(|| Close::new(middle, carried))
    }

    /// |√x − √X| ≤ |x − X|/√x.
    fn root(&self) -> Option<Self> {
        let (least, _) = self.ends();
        let carried = self.radius / least.sqrt();
        (least > 0.0).then(|| {
            let middle = self.middle.root();
            Close::new(middle, carried + unit(101) * middle.hi * UP)
        })
    }

    fn negative(&self) -> Self {
        Close { middle: self.middle.negative(), radius: self.radius }
    }

    fn scale2(&self, k: i32) -> Self {
        Close::new(self.middle.scaled(power_of_two(k)), self.radius * power_of_two(k))
    }

    fn ends(&self) -> (f64, f64) {
        let (middle, error) = self.double();
        ((middle - error).next_down(), (middle + error).next_up())
    }

    fn log2(&self) -> i32 {
        let size = self.size();
        if size > FLOOR && size.is_finite() { size.log2() as i32 } else { 0 }
    }

    fn ball(&self) -> Ball {
        let Twofold { hi, lo } = self.middle;
        exact(hi).add(&exact(lo), 2200).add(&Ball::about_zero(self.radius), 192)
    }

    fn near<T: Coefficient>(&self) -> (T, f64) {
        let (near, lost) = T::near_twofold(self.middle);
        (near, (lost + self.radius) * UP)
    }

    fn within<T: Coefficient>(middle: &T, error: f64, _: u32) -> Self {
        Close::new(middle.to(), error)
    }
}

/// Entries farther from 1 than 2^±this are scaled.
const LARGE: i32 = 64;

/// The exponent of the largest of these, and all of them without it, exactly.
pub fn balanced<E: Enclosure, const N: usize>(terms: [Matrix<E>; N]) -> ([Matrix<E>; N], i32) {
    let largest = terms.iter().flatten().map(E::log2).max().unwrap_or(0);
    if largest.abs() <= LARGE {
        return (terms, 0);
    }
    (terms.map(|term| term.map(|x| x.scale2(-largest))), largest)
}

/// One step's matrix to the n-th power, and the power of two that it is to be multiplied by: beyond what 128
/// bits hold, their largest number, which no ball takes.
pub fn power<E: Enclosure>(step: &Matrix<E>, one: &Matrix<E>, n: &BigUint) -> (Matrix<E>, i128) {
    let digits = (0..n.bits()).rev().map(|bit| n.bit(bit));
    digits.fold((one.clone(), 0i128), |(numbers, exponent), digit| {
        let square = product(&numbers, &numbers);
        let next = if digit { product(&square, step) } else { square };
        let ([next], scaled) = balanced([next]);
        (next, exponent.saturating_mul(2).saturating_add(scaled.into()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;
    use proptest::prelude::*;

    proptest! {
        /// Every operation's enclosure holds the exact result, and is not much wider than two doubles are.
        #[test]
        fn enclosures_hold_what_they_enclose(a in 1i64..1 << 50, b in 1u64..1 << 50, c in -1i64 << 50..1 << 50, d in 1u64..1 << 50) {
            let [x, y] = [(a, b), (c, d)].map(|(n, d)| Close::quotient(n.into(), d.into(), 0));
            let [exact_x, exact_y] = [ratio(a, b as i64), ratio(c, d as i64)];
            let holds = |close: &Close, exact: &Rational| {
                let (lower, upper) = close.ends();
                let ball = close.ball();
                ball.contains(exact)
                    && number::rational::from_f64_exact(lower).is_some_and(|lower| lower <= *exact)
                    && number::rational::from_f64_exact(upper).is_some_and(|upper| *exact <= upper)
                    && close.radius <= unit(96) * (x.size() + y.size() + x.size() * y.size() + close.size())
            };
            prop_assert!(holds(&x, &exact_x) && holds(&y, &exact_y));
            prop_assert!(holds(&x.plus(&y), &(&exact_x + &exact_y)));
            prop_assert!(holds(&x.minus(&y), &(&exact_x - &exact_y)));
            prop_assert!(holds(&x.times(&y), &(&exact_x * &exact_y)));
            if let Some(quotient) = y.over(&x) {
                prop_assert!(quotient.ball().contains(&(&exact_y / &exact_x)));
            }
            let root = x.root().unwrap();
            prop_assert!(root.times(&root).ball().contains(&exact_x));
        }
    }
}
