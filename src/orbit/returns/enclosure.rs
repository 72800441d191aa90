//! The numbers that a pair's constants are made of: balls, and for doubles two doubles with a radius, a hundred times as fast.

use crate::number::{Ball, Rational, Real, Sign, Twofold};

/// A real number, enclosed. Numbers of one pair have the same bits.
pub trait Enclosure: Clone {
    /// `None` where this kind of number does not hold x well.
    fn of<S: Real>(x: &S, bits: u32) -> Option<Self>;
    /// n/d.
    fn quotient(n: i64, d: u64, bits: u32) -> Self;
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
    fn ball(&self) -> Ball;

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

    fn quotient(n: i64, d: u64, bits: u32) -> Self {
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

    fn sign(&self) -> Option<Sign> {
        self.ball.sign()
    }

    fn ball(&self) -> Ball {
        self.ball.clone()
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

    fn quotient(n: i64, d: u64, _: u32) -> Self {
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
        Close::new(self.middle.scaled(2f64.powi(k)), self.radius * 2f64.powi(k))
    }

    fn ends(&self) -> (f64, f64) {
        let (middle, error) = self.double();
        ((middle - error).next_down(), (middle + error).next_up())
    }

    fn ball(&self) -> Ball {
        let Twofold { hi, lo } = self.middle;
        let unit = Ball::one().neg().union(&Ball::one(), 64);
        exact(hi).add(&exact(lo), 2200).add(&exact(self.radius).mul(&unit, 64), 2200).round(192)
    }
}

/// n/d within 3 2^-101 relatively.
pub fn quotient(n: i64, d: u64) -> Twofold {
    if n == 0 {
        return Twofold::ZERO;
    }
    // n/d = 2^-shift (first + second 2^-64) 2^-64 within 2^-128 relatively.
    let shift = n.unsigned_abs().leading_zeros().saturating_sub(d.leading_zeros());
    let dividend = u128::from(n.unsigned_abs()) << shift;
    let (d, above) = (u128::from(d), dividend / u128::from(d));
    let first = (dividend % d) << 64;
    let second = (first % d) << 64;
    let [first, second] = [(above << 64) | (first / d), second / d];
    let hi = first as f64;
    let lo = (first as i128 - hi as i128) as f64;
    let unit = 2f64.powi(-64 - shift as i32).copysign(n as f64);
    let sum = Twofold::sum(hi, lo + second as f64 * 2f64.powi(-64));
    Twofold { hi: sum.hi * unit, lo: sum.lo * unit }
}

/// A double, exactly.
pub fn exact(x: f64) -> Ball {
    let (mantissa, exponent) = (x.to_bits() & ((1 << 52) - 1), (x.to_bits() >> 52 & 0x7ff) as i64);
    let (mantissa, exponent) =
        if exponent == 0 { (mantissa, -1074) } else { (mantissa | 1 << 52, exponent - 1075) };
    let ball = Ball::from_integer(&mantissa.into()).scale2(exponent);
    if x < 0.0 { ball.neg() } else { ball }
}

/// One step's matrix to the n-th power, n as its binary digits, the highest first.
pub fn power<E: Enclosure>(
    step: &Matrix<E>,
    one: &Matrix<E>,
    digits: impl Iterator<Item = bool>,
) -> Matrix<E> {
    digits.fold(one.clone(), |own, digit| {
        let square = product(&own, &own);
        if digit { product(&square, step) } else { square }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::rational::ratio;
    use proptest::prelude::*;

    proptest! {
        /// Every operation's enclosure holds the exact result, and is not much wider than two doubles are.
        #[test]
        fn enclosures_hold_what_they_enclose(a in 1i64..1 << 50, b in 1u64..1 << 50, c in -1i64 << 50..1 << 50, d in 1u64..1 << 50) {
            let [x, y] = [(a, b), (c, d)].map(|(n, d)| Close::quotient(n, d, 0));
            let [exact_x, exact_y] = [ratio(a, b as i64), ratio(c, d as i64)];
            let holds = |close: &Close, exact: &Rational| {
                let (lower, upper) = close.ends();
                let ball = close.ball();
                ball.contains(exact)
                    && crate::number::rational::from_f64_exact(lower).is_some_and(|lower| lower <= *exact)
                    && crate::number::rational::from_f64_exact(upper).is_some_and(|upper| *exact <= upper)
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
