//! Unevaluated sums of two doubles, for the last steps of a certificate.
//!
//! Errors of the three operations are below 2^-98 relative for operands of one sign (Joldes, Muller, Popescu,
//! "Tight and rigorous error bounds for basic building blocks of double-word arithmetic", 2017: 3u² + 13u³ for the
//! sum, 10u² or less for the product, 15u² + 56u³ for the quotient, u = 2^-53), barring overflow and underflow.

use num_traits::Zero;

use crate::number::{Rational, rational};

/// hi + lo, |lo| ≤ ulp(hi)/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Twofold {
    pub hi: f64,
    pub lo: f64,
}

/// The sum's nearest double and the exact rest (Knuth).
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// The product's nearest double and the exact rest (Dekker, Veltkamp).
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let c = 134217729.0 * x; // 2^27 + 1
        let high = c - (c - x);
        (high, x - high)
    };
    let (p, (ah, al), (bh, bl)) = (a * b, split(a), split(b));
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Twofold {
    /// a + b, exactly.
    pub fn sum(a: f64, b: f64) -> Twofold {
        let (hi, lo) = two_sum(a, b);
        Twofold { hi, lo }
    }

    /// x to within 2^-104 relative.
    pub fn from_rational(x: &Rational) -> Twofold {
        let hi = rational::to_f64(x);
        let rest = rational::from_f64_exact(hi).map_or_else(Rational::zero, |hi| x - hi);
        Twofold { hi, lo: rational::to_f64(&rest) }
    }

    pub fn plus(self, other: Twofold) -> Twofold {
        let (s, e) = two_sum(self.hi, other.hi);
        let (t, f) = two_sum(self.lo, other.lo);
        let Twofold { hi, lo } = Twofold::sum(s, e + t);
        Twofold::sum(hi, lo + f)
    }

    pub fn times(self, other: Twofold) -> Twofold {
        let (p, e) = two_product(self.hi, other.hi);
        Twofold::sum(p, e + (self.hi * other.lo + self.lo * other.hi))
    }

    pub fn over(self, other: Twofold) -> Twofold {
        let first = self.hi / other.hi;
        let product = other.times(Twofold { hi: first, lo: 0.0 });
        let rest = (self.hi - product.hi) + (self.lo - product.lo);
        Twofold::sum(first, rest / other.hi)
    }

    /// The doubles around [self − radius, self + radius], radius ≥ 0.
    pub fn around(self, radius: f64) -> (f64, f64) {
        let (lo, below) = two_sum(self.hi, (self.lo - radius).next_down());
        let (hi, above) = two_sum(self.hi, (self.lo + radius).next_up());
        (if below < 0.0 { lo.next_down() } else { lo }, if above > 0.0 { hi.next_up() } else { hi })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn exact(x: Twofold) -> Rational {
        rational::from_f64_exact(x.hi).unwrap() + rational::from_f64_exact(x.lo).unwrap()
    }

    proptest! {
        #[test]
        fn operations_are_as_accurate_as_they_say(a in 1e-5f64..1e5, b in 1e-5f64..1e5, c in 0f64..1e-17, d in 0f64..1e-17) {
            let (x, y) = (Twofold::sum(a, a * c), Twofold::sum(b, b * d));
            let close = |computed: Twofold, truth: Rational| {
                let error = rational::to_f64(&((exact(computed) - &truth) / truth)).abs();
                error < 2f64.powi(-98)
            };
            prop_assert!(close(x.plus(y), exact(x) + exact(y)));
            prop_assert!(close(x.times(y), exact(x) * exact(y)));
            prop_assert!(close(x.over(y), exact(x) / exact(y)));
            let (lo, hi) = x.around(0.0);
            let end = |e| rational::from_f64_exact(e).unwrap();
            prop_assert!(end(lo) <= exact(x) && exact(x) <= end(hi) && hi <= lo.next_up().next_up());
        }
    }
}
