//! Vectors as plain arrays.

use super::{EXPONENTS, FloatRing, SIGN, Vector, double_of, each};

impl<const N: usize> FloatRing for [f64; N] {
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
    fn mul_sub(self, b: Self, c: Self) -> Self {
        each(|i| self[i].mul_add(b[i], -c[i]))
    }
}

impl<const N: usize> Vector for [f64; N] {
    const WIDTH: usize = N;
    type Mask = [bool; N];

    #[inline(always)]
    fn splat(x: f64) -> Self {
        [x; N]
    }

    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        each(|i| from[i])
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[..N].copy_from_slice(&self);
    }

    #[inline(always)]
    fn exceeds(self, limit: Self) -> [bool; N] {
        std::array::from_fn(|i| self[i] > limit[i])
    }

    #[inline(always)]
    fn alternatives(this: Self, that: Self) -> [Self; 2] {
        [this, that]
    }

    #[inline(always)]
    fn choose(mask: [bool; N], [this, that]: [Self; 2]) -> Self {
        each(|i| if mask[i] { this[i] } else { that[i] })
    }

    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        each(|i| (-self[i]).mul_add(b[i], c[i]))
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
    fn count_change_below(self, a: Self, b: Self, c: Self) -> Self {
        each(|i| {
            f64::from_bits(self[i].to_bits() + (((a[i].to_bits() ^ b[i].to_bits()) & c[i].to_bits()) >> 63))
        })
    }

    #[inline(always)]
    fn normalizing(self) -> Self {
        each(|i| f64::from_bits(EXPONENTS.wrapping_sub((self[i].to_bits() & !SIGN) >> 52) << 52))
    }

    #[inline(always)]
    fn logarithm(self) -> Self {
        each(|i| double_of((self[i].to_bits() & !SIGN) >> 20))
    }
}
