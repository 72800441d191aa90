//! Two doubles a lane.

use super::Vector;

/// hi + lo, |lo| ≤ ulp(hi)/2, in each lane: the operations of [`Twofold`](crate::Twofold) to the bit.
#[derive(Clone, Copy)]
pub struct Pair<V> {
    pub hi: V,
    pub lo: V,
}

impl<V: Vector> Pair<V> {
    /// hi + lo, |lo| ≤ |hi| (Dekker).
    #[inline(always)]
    fn joined(hi: V, lo: V) -> Self {
        let sum = hi.add(lo);
        Pair { hi: sum, lo: lo.sub(sum.sub(hi)) }
    }

    /// a + b to within 2^-104 (|a| + |b|).
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        let (hi, lo) = self.hi.two_sum(other.hi);
        Pair::joined(hi, lo.add(self.lo.add(other.lo)))
    }

    /// a − b, likewise.
    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        let (hi, lo) = self.hi.two_sub(other.hi);
        Pair::joined(hi, lo.add(self.lo.sub(other.lo)))
    }

    /// a b to within 2^-101 relative.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        let (hi, lost) = self.hi.two_product(other.hi);
        Pair::joined(hi, lost.add(self.hi.mul_add(other.lo, self.lo.mul(other.hi))))
    }

    /// a b to within 2^-103 relative; exact where b is a power of two.
    #[inline(always)]
    pub fn scaled(self, b: V) -> Self {
        let (hi, lost) = self.hi.two_product(b);
        Pair::joined(hi, self.lo.mul_add(b, lost))
    }
}
