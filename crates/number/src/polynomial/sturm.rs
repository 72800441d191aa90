//! Real roots of rational polynomials: counted by Sturm's theorem, isolated and refined by bisection.
//!
//! Inside, polynomials are primitive integer vectors (lowest coefficient first), scaled by positive
//! factors only, so that signs survive.

use std::ops::Neg;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::Polynomial;
use crate::{ExactSign, Rational, Sign};

/// A closed interval that holds one root: either a point, or one with a sign change and roots at no end.
pub type RootInterval = (Rational, Rational);

/// Coefficients of which the sign of a polynomial is decided.
pub trait SignAt: Sized {
    /// The sign of Σ f_k x^k.
    fn sign_at(f: &[Self], x: &Rational) -> Sign;
}

impl SignAt for BigInt {
    fn sign_at(f: &[Self], x: &Rational) -> Sign {
        sign_at(f, x)
    }
}

/// The Sturm chain of a polynomial's squarefree part: f, f', and negated remainders.
#[derive(Clone, Debug)]
pub struct Sturm<C = BigInt> {
    pub(super) chain: Vec<Vec<C>>,
    pub(super) bound: Rational,
}

impl Sturm {
    /// The chain of f ≠ 0.
    ///
    /// **Panics** if f = 0, whose roots cannot be counted.
    pub fn new(f: &Polynomial<Rational>) -> Sturm {
        assert!(!f.is_zero(), "the polynomial 0 has no Sturm chain");
        let f = f.squarefree();
        let mut chain = vec![integers(&f), integers(&f.derivative())];
        while chain[chain.len() - 1].len() > 1 {
            let rest = remainder(&chain[chain.len() - 2], &chain[chain.len() - 1]);
            chain.push(rest.into_iter().map(Neg::neg).collect());
        }
        chain.retain(|f| !f.is_empty());
        Sturm { chain, bound: f.root_bound() }
    }
}

impl<C: SignAt> Sturm<C> {
    /// The number of distinct real roots in the closed interval [lo, hi]; 0 if it is empty.
    pub fn count(&self, lo: &Rational, hi: &Rational) -> usize {
        if lo > hi {
            return 0;
        }
        let at_lo = usize::from(self.sign_at(lo) == Sign::Zero);
        self.variations(lo) - self.variations(hi) + at_lo
    }

    /// All real roots, increasing, in intervals that share at most an end, which is no root; see
    /// [`Sturm::refine`] to make these small.
    pub fn isolate(&self) -> Vec<RootInterval> {
        let mut roots = Vec::new();
        // The bound exceeds every root, so no end is a root.
        let mut open = vec![(-&self.bound, self.bound.clone())];
        while let Some((lo, hi)) = open.pop() {
            match self.variations(&lo) - self.variations(&hi) {
                0 => {}
                1 => roots.push((lo, hi)),
                _ => {
                    let middle = (&lo + &hi) / Rational::from_integer(2.into());
                    let (left, right) =
                        self.around(&middle, &((&hi - &lo) / Rational::from_integer(4.into())));
                    if left != right {
                        roots.push((middle.clone(), middle));
                    }
                    open.push((lo, left));
                    open.push((right, hi));
                }
            }
        }
        roots.sort();
        roots
    }

    /// (x, x) if x is no root; else the ends of an interval about x without another root.
    fn around(&self, x: &Rational, radius: &Rational) -> RootInterval {
        if self.sign_at(x) != Sign::Zero {
            return (x.clone(), x.clone());
        }
        let mut radius = radius.clone();
        loop {
            let (lo, hi) = (x - &radius, x + &radius);
            if self.count(&lo, &hi) == 1 {
                return (lo, hi);
            }
            radius /= Rational::from_integer(2.into());
        }
    }

    /// Bisects until the interval of the root is at most as wide as the given width > 0.
    pub fn refine(&self, (lo, hi): &RootInterval, width: &Rational) -> RootInterval {
        if lo == hi {
            return (lo.clone(), hi.clone());
        }
        let below = self.sign_at(lo);
        // Over one denominator: greatest common divisors of thousands of bits at each bisection would take
        // most of the time.
        let mut denominator = lo.denom().lcm(hi.denom());
        let over = |x: &Rational| x.numer() * (&denominator / x.denom());
        let (mut lo, mut hi) = (over(lo), over(hi));
        while (&hi - &lo) * width.denom() > width.numer() * &denominator {
            if (&lo + &hi).is_odd() {
                for integer in [&mut lo, &mut hi, &mut denominator] {
                    *integer <<= 1;
                }
            }
            let middle: BigInt = (&lo + &hi) >> 1;
            match self.sign_at(&Rational::new_raw(middle.clone(), denominator.clone())) {
                Sign::Zero => (lo, hi) = (middle.clone(), middle),
                sign if sign == below => lo = middle,
                _ => hi = middle,
            }
        }
        (Rational::new(lo, denominator.clone()), Rational::new(hi, denominator))
    }

    /// The sign of the squarefree part at x.
    pub fn sign_at(&self, x: &Rational) -> Sign {
        C::sign_at(&self.chain[0], x)
    }

    /// The number of sign changes along the chain at x, zeros left out.
    fn variations(&self, x: &Rational) -> usize {
        let signs = self.chain.iter().map(|f| C::sign_at(f, x)).filter(|sign| *sign != Sign::Zero);
        let signs: Vec<Sign> = signs.collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }
}

impl Polynomial<Rational> {
    /// A power of 2 above |x| for all roots x, the complex ones too: 1 + max |c_k / c_n| < 2^t (Cauchy).
    pub fn root_bound(&self) -> Rational {
        let monic = self.monic();
        let largest = monic.coefficients.iter().map(Signed::abs).max().unwrap_or_else(Rational::zero);
        let bound = (largest + Rational::one()).ceil().to_integer();
        Rational::from_integer(BigInt::one() << bound.bits())
    }

    /// The number of distinct real roots in the closed interval [lo, hi] (Sturm).
    ///
    /// **Panics** for the polynomial 0.
    pub fn count_roots(&self, lo: &Rational, hi: &Rational) -> usize {
        Sturm::new(self).count(lo, hi)
    }
}

/// The coefficients times a positive number: integers without a common factor.
pub fn integers(f: &Polynomial<Rational>) -> Vec<BigInt> {
    let denominator = f.coefficients.iter().fold(BigInt::one(), |lcm, c| lcm.lcm(c.denom()));
    primitive(f.coefficients.iter().map(|c| c.numer() * (&denominator / c.denom())).collect())
}

pub fn primitive(mut f: Vec<BigInt>) -> Vec<BigInt> {
    while f.last().is_some_and(Zero::is_zero) {
        f.pop();
    }
    let content = f.iter().fold(BigInt::zero(), |gcd, c| if gcd.is_one() { gcd } else { gcd.gcd(c) });
    if !content.is_one() {
        f.iter_mut().for_each(|c| *c /= &content);
    }
    f
}

/// A positive multiple of the remainder of a by b, primitive; empty if b divides a.
pub(super) fn remainder(a: &[BigInt], b: &[BigInt]) -> Vec<BigInt> {
    let mut rest = a.to_vec();
    let leading = b.last().expect("a divisor that is not 0");
    let (size, sign) = (leading.abs(), leading.signum());
    while rest.len() >= b.len() {
        let k = rest.len() - b.len();
        let factor = rest.last().expect("not empty") * &sign;
        // |l| rest − sign(l) top(rest) x^k b: the top coefficient vanishes.
        rest.iter_mut().for_each(|c| *c *= &size);
        for (integer, c) in rest[k..].iter_mut().zip(b) {
            *integer -= &factor * c;
        }
        while rest.last().is_some_and(Zero::is_zero) {
            rest.pop();
        }
    }
    primitive(rest)
}

/// The sign of f(n/d) = sign of Σ c_k n^k d^(m − k), d > 0, in integers.
pub fn sign_at(f: &[BigInt], x: &Rational) -> Sign {
    let (mut value, mut power) = (BigInt::zero(), BigInt::one());
    for c in f.iter().rev() {
        value = value * x.numer() + c * &power;
        power *= x.denom();
    }
    Rational::from_integer(value).sign()
}
