//! Vectors as plain arrays.

use super::{EXPONENTS, LANES, SIGN, Vector, each};

impl Vector for [f64; LANES] {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        [x; LANES]
    }

    #[inline(always)]
    fn load(from: &[f64; LANES]) -> Self {
        *from
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; LANES]) {
        *to = self;
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        each(|i| self[i] + other[i])
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        each(|i| self[i] - other[i])
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        each(|i| self[i] * other[i])
    }

    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        each(|i| self[i].mul_add(b[i], c[i]))
    }

    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        each(|i| (-self[i]).mul_add(b[i], c[i]))
    }

    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        each(|i| self[i].mul_add(b[i], -c[i]))
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        each(|i| self[i] / other[i])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each(|i| self[i].sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        each(|i| self[i].abs())
    }

    #[inline(always)]
    fn any_above(self, limit: Self) -> bool {
        self.iter().zip(&limit).any(|(x, limit)| x > limit)
    }

    #[inline(always)]
    fn if_above(self, limit: Self, this: Self, that: Self) -> Self {
        each(|i| if self[i] > limit[i] { this[i] } else { that[i] })
    }

    #[inline(always)]
    fn below(self) -> Self {
        each(|i| f64::from_bits(self[i].to_bits().wrapping_sub(1)))
    }

    #[inline(always)]
    fn count_change(self, a: Self, b: Self) -> Self {
        each(|i| f64::from_bits(self[i].to_bits() + ((a[i].to_bits() ^ b[i].to_bits()) >> 63)))
    }

    #[inline(always)]
    fn normalizing(self) -> Self {
        each(|i| f64::from_bits(EXPONENTS.wrapping_sub((self[i].to_bits() & !SIGN) >> 52) << 52))
    }
}
