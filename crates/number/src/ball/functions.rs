//! Exponential, logarithm and inverse hyperbolic sine.
//!
//! Each function is computed at the exact midpoint; the radius then passes through a bound of the derivative.

use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::{Ball, Magnitude, series};

/// Bits by which intermediate results exceed the asked precision; the errors of all functions stay
/// below 2^12 units of their last intermediate place for precisions below 2^20.
pub(super) const SPARE: u32 = 16;

impl Ball {
    /// e^x, to about `bits` bits relatively; of what may lie below −2^40 the enclosure \[0, 2^−2^40\].
    ///
    /// **Panics** beyond x = 2^40, where the result is of no use to anyone.
    pub fn exp(&self, bits: u32) -> Ball {
        let radius = self.radius();
        if self.top().is_some_and(|top| top > 40) {
            let (lower, upper) = self.ends();
            let is_huge = |end: &Ball| end.top().is_some_and(|top| top > 40);
            assert!(upper.mid.is_negative() || !is_huge(&upper), "exponential of a number beyond 2^40");
            // e^x < 2^x for x < 0. Half of it about half of it.
            let tiny = Ball { mid: BigInt::one(), rad: 1, exp: -(1 << 40) - 1 };
            return match (is_huge(&upper), is_huge(&lower)) {
                (true, _) => tiny,
                (false, true) => tiny.union(&upper.exp(bits), bits),
                (false, false) => lower.exp(bits).union(&upper.exp(bits), bits),
            };
        }
        if radius.top().is_some_and(|top| top > 0) {
            let (lower, upper) = self.ends();
            return lower.exp(bits).union(&upper.exp(bits), bits);
        }
        let value = self.midpoint().exp_of_exact(bits);
        // |e^(m + d) − e^m| ≤ e^m (e^r − 1) ≤ e^m 2r for |d| ≤ r ≤ 1.
        let extra = value.magnitude().times(radius).scale2(1);
        value.widened(extra, bits)
    }

    /// e^x = 2^n (e^t)^(2^k) with x = n ln 2 + 2^k t, and Σ t^j / j! for the small t.
    fn exp_of_exact(&self, bits: u32) -> Ball {
        let halvings = bits.isqrt() / 2; // balances squarings against terms
        let w = bits + 2 * halvings + SPARE;
        let n = self.div(&Ball::ln2(64), 64).expect("ln 2 > 0").mid_nearest();
        let n_ln2 = Ball::from_integer(&n).mul(&Ball::ln2(w + 44), w + 44);
        let t = self.sub(&n_ln2, w + 44).scale2(-i64::from(halvings));
        let mut power = series::sum(&t, w, |k| k, series::unit);
        for _ in 0..halvings {
            power = power.square(w);
        }
        let power = power.scale2(n.to_i64().expect("|x| <= 2^40"));
        power.round(bits)
    }

    /// ln x, to about `bits` bits relatively, near x = 1 too; `None` unless every point of the ball is > 0.
    pub fn ln(&self, bits: u32) -> Option<Ball> {
        if self.mid <= BigInt::from(self.rad) {
            return None;
        }
        let value = self.midpoint().ln_of_exact(bits);
        if self.rad == 0 {
            return Some(value);
        }
        // |ln x − ln m| ≤ r / (m − r).
        let least = Magnitude::lower((&self.mid - self.rad).magnitude(), self.exp);
        Some(value.widened(self.radius().over(least), bits))
    }

    /// ln x = n ln 2 + 2 artanh((y − 1)/(y + 1)) with x = 2^n y, 2/3 ≤ y < 4/3.
    fn ln_of_exact(&self, bits: u32) -> Ball {
        let w = bits + SPARE;
        let length = self.mid.bits();
        let below_two_thirds = &self.mid * 3 < BigInt::one() << (length + 1);
        let n = self.exp + length as i64 - i64::from(below_two_thirds);
        let (y, one) = (self.scale2(-n), Ball::one());
        let exact = w + length as u32; // y − 1 must not lose what makes ln y accurate near 1
        let z = y.sub(&one, exact).div(&y.add(&one, w), w).expect("y + 1 > 0");
        let ln_y = z.atanh_small(w).scale2(1);
        if n.is_zero() {
            return ln_y.round(bits);
        }
        Ball::ln2(w + 64).mul(&Ball::from_integer(&n.into()), w).add(&ln_y, bits)
    }

    /// artanh z = z Σ z^2k / (2k + 1) for |z| ≤ 1/2.
    fn atanh_small(&self, w: u32) -> Ball {
        self.mul(&series::sum(&self.square(w), w, series::unit, series::odd), w)
    }

    /// arsinh x, to about `bits` bits relatively, however small x is.
    pub fn asinh(&self, bits: u32) -> Ball {
        if self.mid.is_negative() {
            return self.neg().asinh(bits).neg();
        }
        let value = self.midpoint().asinh_of_exact(bits);
        // The derivative 1/√(1 + x²) is at most 1, and at most 1/(m − r) where that is positive.
        let mut extra = self.radius();
        let (lower, _) = self.ends();
        if self.rad > 0 && !lower.mid.is_negative() && lower.mid_exceeds(0) {
            extra = extra.over(Magnitude::lower(lower.mid.magnitude(), lower.exp));
        }
        value.widened(extra, bits)
    }

    /// arsinh x = 2 artanh(x / (1 + √(1 + x²))) for 0 ≤ x ≤ 1/2, else ln(x + √(1 + x²)).
    fn asinh_of_exact(&self, bits: u32) -> Ball {
        let w = bits + SPARE;
        let one = Ball::one();
        let root = self.square(w).add(&one, w).sqrt(w).expect("1 + x² > 0");
        if self.mid_exceeds(-1) {
            return self.add(&root, w).ln(bits).expect("x + √(1 + x²) > 0");
        }
        let z = self.div(&root.add(&one, w), w).expect("1 + √ > 0");
        z.atanh_small(w).scale2(1).round(bits)
    }
}
