//! The last tier: exact arithmetic, where zero is decided.
//!
//! Only signs are wanted, so positive factors may be dropped: over the rationals every matrix is scaled to
//! integers and no fraction is ever reduced. A balanced product tree keeps the factors of each
//! multiplication of equal length, so that fast multiplication pays. Over Q\[π\] and the cyclotomic fields
//! the generic half period does.
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::propagator::TwoClocks;
//! use kickdrift_clocks::verdict::Decidable;
//! // th = pi/3 and 3 | p: the upper edge of the tongue sits exactly on the resonance.
//! let signs = Decidable::half_signs(&TwoClocks::new("3/1".parse().unwrap(), ratio(1, 1), ratio(1, 10)));
//! assert_eq!((signs.verdict().kind().name(), signs.verdict().side()), ("parabolic", -1));
//! ```

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use crate::orbit::residue;
use crate::propagator::{HalfSigns, TwoClocks, half_period};
use crate::schedule::{KickDrift, Kicks, Schedule};
use number::{Cyclotomic, Laurent, Rational, Real, Sign};

/// Exact real numbers over which the four signs of the half period are decided.
pub trait Decidable: Real {
    /// The signs of A, B, C, D, exactly.
    ///
    /// # Panics
    /// Where the period has 2^62 ticks and more.
    fn half_signs(clocks: &TwoClocks<Self>) -> HalfSigns {
        half_period(clocks).signs()
    }

    /// The cost of [`Decidable::half_signs`] for a half period of so many kicks, in kicks of the refine tier
    /// (about 1 µs each): the numbers grow with every kick. Measured, good to a factor of some units.
    fn exact_cost(_clocks: &TwoClocks<Self>, kicks: u64) -> u64 {
        kicks.saturating_pow(3)
    }

    /// Whether a cheap test shows that none of A, B, C, D is zero, so that more bits must end with their
    /// signs. `false` says nothing.
    fn surely_nonzero(_clocks: &TwoClocks<Self>) -> bool {
        false
    }
}

/// Rational strengths are decided as such, whatever the stiffnesses and steps look like.
impl Decidable for Laurent {
    /// Over the rationals where both strengths are rational; otherwise generically.
    fn half_signs(clocks: &TwoClocks<Laurent>) -> HalfSigns {
        if let Some(rational) = clocks.as_rational() {
            return Decidable::half_signs(&rational);
        }
        half_period(clocks).signs()
    }

    /// As for the rationals where both strengths are rational. Otherwise a strength of n powers of π gives
    /// the entries up to n more with each kick, and each of them meets all n.
    fn exact_cost(clocks: &TwoClocks<Laurent>, kicks: u64) -> u64 {
        if let Some(rational) = clocks.as_rational() {
            return Decidable::exact_cost(&rational, kicks);
        }
        let strengths = [clocks.fast(), clocks.slow()];
        let powers = strengths.iter().map(|strength| strength.terms().len()).max().unwrap_or(0) as u64;
        let words = words(strengths.iter().flat_map(|strength| strength.terms()).map(|(_, c)| c));
        kicks.saturating_pow(3).saturating_mul(powers.saturating_mul(words).saturating_pow(2))
    }

    /// By residues: exact arithmetic over Q\[π\] is dear, and its only zeros are polynomial identities.
    fn surely_nonzero(clocks: &TwoClocks<Laurent>) -> bool {
        clocks.as_rational().is_none() && residue::nonzero_entries(clocks)
    }
}

impl Decidable for Cyclotomic {}

impl Decidable for Rational {
    /// By a product tree of integer matrices, about (p + q)/2 leaves.
    fn half_signs(clocks: &TwoClocks<Rational>) -> HalfSigns {
        let schedule = Schedule::two_clocks(clocks.ratio()).expect("a period short enough to compose");
        let [[a, b], [c, d]] = product(&Steps::new(clocks, &schedule), &schedule).entries;
        let sign = |n: &BigInt| Sign::from_ordering(n.cmp(&BigInt::zero()));
        HalfSigns::new(sign(&a), sign(&b), sign(&c), sign(&d))
    }

    /// The last few multiplications, of numbers as long as all strengths together, make up most of it.
    fn exact_cost(clocks: &TwoClocks<Rational>, kicks: u64) -> u64 {
        let digits = kicks.saturating_mul(words([clocks.fast(), clocks.slow()]));
        digits.saturating_add(digits.saturating_mul(digits) / 100)
    }
}

/// How many machine words the longest of some strengths has, above and below the line.
fn words<'a>(strengths: impl IntoIterator<Item = &'a Rational>) -> u64 {
    let bits = strengths.into_iter().map(|k| k.numer().bits() + k.denom().bits()).max().unwrap_or(0);
    // Strengths as people write them, two words, are what the costs were measured with.
    (bits / 128).max(1)
}

/// Tr Q = 2 (AD + BC) over the rationals, in lowest terms, by the product tree.
///
/// Its denominator divides a power of the strengths' common denominator, so common factors are found by
/// division by that small number instead of a greatest common divisor of two long ones.
///
/// # Panics
/// Where the period has 2^62 ticks and more.
pub fn exact_trace(clocks: &TwoClocks<Rational>) -> Rational {
    let schedule = Schedule::two_clocks(clocks.ratio()).expect("a period short enough to compose");
    let steps = Steps::new(clocks, &schedule);
    let half = product(&steps, &schedule);
    let [[a, b], [c, d]] = &half.entries;
    let mut trace = (a * d + b * c) * 2u8;
    let mut power = 2 * half.kicks;
    // Whole factors of the denominator first, then what part of it the last ones still share.
    while power > 0 && (&trace % &steps.denominator).is_zero() {
        trace /= &steps.denominator;
        power -= 1;
    }
    let mut denominator = steps.denominator.pow(power);
    loop {
        let shared = steps.denominator.gcd(&(&trace % &steps.denominator));
        let shared = shared.gcd(&(&denominator % &shared));
        if shared.is_one() || denominator.is_one() {
            return Rational::new_raw(trace, denominator);
        }
        trace /= &shared;
        denominator /= &shared;
    }
}

/// The denominator to the power `kicks` times a matrix of determinant 1.
struct Matrix {
    entries: [[BigInt; 2]; 2],
    kicks: u32,
}

impl Matrix {
    fn identity() -> Self {
        let entries = [[BigInt::one(), BigInt::zero()], [BigInt::zero(), BigInt::one()]];
        Matrix { entries, kicks: 0 }
    }

    /// `self · earlier`.
    fn times(&self, earlier: &Matrix) -> Matrix {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (&self.entries, &earlier.entries);
        let entries = [[a * e + b * g, a * f + b * h], [c * e + d * g, c * f + d * h]];
        Matrix { entries, kicks: self.kicks + earlier.kicks }
    }
}

/// The events' strengths as integers over one denominator, in the unit of time one tick.
struct Steps {
    denominator: BigInt,
    kicks: Kicks<BigInt>,
}

impl Steps {
    fn new(clocks: &TwoClocks<Rational>, schedule: &Schedule) -> Self {
        // In ticks a kick of strength k (unit h1) has strength k/ticks; halves make the denominator even.
        let halved = |k: &Rational| k / BigInt::from(2 * schedule.clocks()[0].step());
        let (fast, slow) = (halved(clocks.fast()), halved(clocks.slow()));
        let denominator = fast.denom().lcm(slow.denom());
        let numerator = |k: &Rational| k.numer() * (&denominator / k.denom());
        let (fast, slow) = (numerator(&fast), numerator(&slow));
        let halves = [fast.clone(), slow.clone(), fast + slow];
        Steps { denominator, kicks: Kicks::of_two_clocks(halves, |half| [&half * 2, half]) }
    }
}

/// A few factors, composed one by one.
struct Leaf<'a> {
    matrix: Matrix,
    denominator: &'a BigInt,
}

impl KickDrift<BigInt> for Leaf<'_> {
    fn drift(&mut self, ticks: u64) {
        let [xs, vs] = &mut self.matrix.entries;
        xs.iter_mut().zip(vs).for_each(|(x, v)| *x += &*v * ticks);
    }

    /// Times the denominator.
    fn kick(&mut self, strength: &BigInt) {
        self.matrix.kicks += 1;
        let [xs, vs] = &mut self.matrix.entries;
        for (x, v) in xs.iter_mut().zip(vs) {
            *v *= self.denominator;
            *v -= strength * &*x;
            *x *= self.denominator;
        }
    }
}

/// Events composed one by one before the tree takes over: below this the matrices are short.
const LEAF: usize = 16;

/// The product over the half period by binary counting: equally long partial products are joined.
fn product(steps: &Steps, schedule: &Schedule) -> Matrix {
    let mut events = schedule.half_period().peekable();
    let mut joined: Vec<(u32, Matrix)> = Vec::new();
    while events.peek().is_some() {
        let mut leaf = Leaf { matrix: Matrix::identity(), denominator: &steps.denominator };
        steps.kicks.lead(events.by_ref().take(LEAF), &mut leaf);
        let mut node = (0, leaf.matrix);
        while joined.last().is_some_and(|(level, _)| *level == node.0) {
            let (level, earlier) = joined.pop().expect("just seen");
            node = (level + 1, node.1.times(&earlier));
        }
        joined.push(node);
    }
    joined
        .into_iter()
        .rev()
        .map(|(_, m)| m)
        .reduce(|later, earlier| later.times(&earlier))
        .unwrap_or_else(Matrix::identity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::{Ratio, ratio};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_tree_and_the_plain_half_period_agree(
            p in 1u64..90, q in 1u64..90, s in -50i64..500, slow in -300i64..300, d in 1i64..120,
        ) {
            let (p, q) = (p / p.gcd(&q), q / p.gcd(&q));
            let clocks = TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, d), ratio(slow, 2 * d + 1));
            let half = half_period(&clocks);
            prop_assert_eq!(Decidable::half_signs(&clocks), half.signs());
            let trace = exact_trace(&clocks);
            prop_assert_eq!(trace.denom().gcd(trace.numer()), BigInt::one());
            prop_assert_eq!(trace, half.trace());
        }
    }
}
