//! Sine, cosine and their inverses.

use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};

use super::functions::SPARE;
use super::{Ball, series};

/// Arguments beyond 2^this are not reduced modulo π/2: the answer is then the ball [−1, 1].
const REDUCED: i64 = 1 << 20;

/// Halvings of the arctangent's argument before its series.
const HALVINGS: i64 = 3;

impl Ball {
    /// sin x, to about `bits` bits: relatively for |x| ≤ 3/4, else absolutely.
    pub fn sin(&self, bits: u32) -> Ball {
        self.shifted_sine(0, bits)
    }

    /// cos x, to about `bits` bits absolutely.
    pub fn cos(&self, bits: u32) -> Ball {
        self.shifted_sine(1, bits)
    }

    /// sin(x + quarters π/2) = ± sin t or ± cos t with x = n π/2 + t.
    fn shifted_sine(&self, quarters: u8, bits: u32) -> Ball {
        let Some(top) = self.top() else {
            return if quarters == 0 { Ball::zero() } else { Ball::one() };
        };
        if top > REDUCED || self.radius().top().is_some_and(|top| top > 1) {
            return Ball { mid: 0.into(), rad: 1, exp: 0 };
        }
        let w = bits + SPARE;
        let (n, t) = self.midpoint().reduced(w, top);
        let n = (n + quarters) % 4;
        let value = if n.is_multiple_of(2) { t.sin_small(w) } else { t.cos_small(w) };
        let value = if n < 2 { value } else { value.neg() };
        // |sin'| ≤ 1.
        let error = value.radius().plus(self.radius());
        Ball::rounded(value.mid, value.exp, error, bits)
    }

    /// (n mod 4, t) with x = n π/2 + t, n the integer nearest to x / (π/2) up to rounding, so |t| < 0.8.
    fn reduced(self, w: u32, top: i64) -> (u8, Ball) {
        let size = top.max(0) as u32;
        let half_pi = Ball::pi(w + 2 * size + 8).scale2(-1);
        let n = self.div(&half_pi, size + 32).expect("π > 0").mid_nearest();
        if n.is_zero() {
            return (0, self);
        }
        let precise = w + 2 * size + 8;
        let t = self.sub(&half_pi.mul(&Ball::from_integer(&n), precise), precise);
        (n.mod_floor(&4.into()).to_u8().expect("0 to 3"), t)
    }

    /// sin t = t Σ (−t²)^k / (2k + 1)! for |t| ≤ 1.
    fn sin_small(&self, w: u32) -> Ball {
        let y = self.square(w).neg();
        self.mul(&series::sum(&y, w, |k| 2 * k * (2 * k + 1), series::unit), w)
    }

    /// cos t = Σ (−t²)^k / (2k)! for |t| ≤ 1.
    fn cos_small(&self, w: u32) -> Ball {
        let y = self.square(w).neg();
        series::sum(&y, w, |k| (2 * k - 1) * 2 * k, series::unit)
    }

    /// arctan x, to about `bits` bits relatively.
    pub fn atan(&self, bits: u32) -> Ball {
        let w = bits + SPARE;
        if self.mid_exceeds(0) && !self.contains_zero() {
            // arctan x = ± π/2 − arctan(1/x).
            let inverse = Ball::one().div(self, w).expect("not 0").atan(w);
            let quarter_turn = Ball::pi(w).scale2(-1);
            let quarter_turn = if self.mid.is_negative() { quarter_turn.neg() } else { quarter_turn };
            return quarter_turn.sub(&inverse, bits);
        }
        let value = self.midpoint().atan_of_exact(w);
        // arctan' ≤ 1.
        let error = value.radius().plus(self.radius());
        Ball::rounded(value.mid, value.exp, error, bits)
    }

    /// arctan t = 2 arctan(t / (1 + √(1 + t²))), thrice, then t Σ (−t²)^k / (2k + 1), for any t but fast
    /// for |t| ≤ 1.
    fn atan_of_exact(self, w: u32) -> Ball {
        let (one, mut t, mut halvings) = (Ball::one(), self, 0);
        while t.top().is_some_and(|top| top > -HALVINGS) {
            let root = t.square(w).add(&one, w).sqrt(w).expect("1 + t² > 0");
            t = t.div(&root.add(&one, w), w).expect("1 + √ > 0");
            halvings += 1;
        }
        let y = t.square(w).neg();
        t.mul(&series::sum(&y, w, series::unit, series::odd), w).scale2(halvings)
    }

    /// arcsin x of a number known to lie in [−1, 1]: other points of the ball are ignored;
    /// `None` if there are only others. To about `bits` bits relatively.
    pub fn asin(&self, bits: u32) -> Option<Ball> {
        let w = bits + SPARE;
        let ((lower, upper), one) = (self.ends(), Ball::one());
        if one.compare_exact(&lower).is_lt() || one.compare_exact(&upper.neg()).is_lt() {
            return None;
        }
        if self.radius().top().is_some_and(|top| top > -3) {
            // Wide: arcsin increases, so the ends (clipped) decide.
            let lower = if one.compare_exact(&lower.neg()).is_lt() { one.neg() } else { lower };
            let upper = if one.compare_exact(&upper).is_lt() { one } else { upper };
            return Some(lower.asin(bits)?.union(&upper.asin(bits)?, bits));
        }
        if self.mid.is_negative() {
            return self.neg().asin(bits).map(|value| value.neg());
        }
        let middle = self.midpoint();
        if middle.mid_exceeds(-1) {
            // arcsin x = π/2 − 2 arcsin √((1 − x)/2).
            let half_angle = self.half_chord(w)?.asin(w)?.scale2(1);
            return Some(Ball::pi(w).scale2(-1).sub(&half_angle, bits));
        }
        // arcsin m = arctan(m / √(1 − m²)); m ≤ 1/2 and r ≤ 1/8: the radius passes at most 1/√(1 −
        // (5/8)²) < 2.
        let cosine = Ball::one().sub(&middle.square(2 * w), w).sqrt(w)?;
        let value = middle.div(&cosine, w)?.atan(w);
        let error = value.radius().plus(self.radius().scale2(1));
        Some(Ball::rounded(value.mid, value.exp, error, bits))
    }

    /// arccos x of a number known to lie in [−1, 1]: other points of the ball are ignored;
    /// `None` if there are only others. To about `bits` bits relatively, near x = 1 too.
    pub fn acos(&self, bits: u32) -> Option<Ball> {
        let w = bits + SPARE;
        if self.mid.is_negative() {
            // arccos x = π − arccos(−x).
            return Some(Ball::pi(w).sub(&self.neg().acos(w)?, bits));
        }
        // arccos x = 2 arcsin √((1 − x)/2).
        Some(self.half_chord(w)?.asin(bits)?.scale2(1))
    }

    /// √((1 − x)/2), the sine of half the angle whose cosine is x.
    fn half_chord(&self, w: u32) -> Option<Ball> {
        let length = self.mid.bits() as u32;
        Ball::one().sub(self, w + length).scale2(-1).sqrt_clipped(w)
    }
}
