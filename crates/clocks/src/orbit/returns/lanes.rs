//! Four numbers side by side: the entries of a matrix, in one register.

use number::Twofold;
use number::vector::FloatRing;

/// Four numbers, with the operations of each.
pub trait Lanes<T>: Copy {
    fn of(x: [&T; 4]) -> Self;
    fn entries(self) -> [T; 4];
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    /// self + x y.
    fn plus_times(&self, x: &Self, y: &Self) -> Self;

    /// self + x y as a number that is not normalized yet, a sum of n products within n times as much, as long
    /// as n ≤ 64.
    #[inline(always)]
    fn gathered(&self, x: &Self, y: &Self) -> Self {
        self.plus_times(x, y)
    }

    /// What was gathered, as a number.
    #[inline(always)]
    fn settled(self) -> Self {
        self
    }

    /// In all four.
    #[inline(always)]
    fn splat(x: &T) -> Self {
        Self::of([x; 4])
    }
}

impl Lanes<Twofold> for Twofold<[f64; 4]> {
    #[inline(always)]
    fn of(x: [&Twofold; 4]) -> Self {
        Twofold { hi: x.map(|x| x.hi), lo: x.map(|x| x.lo) }
    }

    #[inline(always)]
    fn entries(self) -> [Twofold; 4] {
        std::array::from_fn(|i| Twofold { hi: self.hi[i], lo: self.lo[i] })
    }

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Twofold::plus(*self, *other)
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        Twofold::times(*self, *other)
    }

    #[inline(always)]
    fn plus_times(&self, x: &Self, y: &Self) -> Self {
        self.plus(&x.times(y))
    }

    /// The high parts one after the other, and what each step loses beside them: no step waits for the
    /// normalization of the one before.
    #[inline(always)]
    fn gathered(&self, x: &Self, y: &Self) -> Self {
        let (high, lost) = x.hi.two_product(y.hi);
        let (hi, rest) = self.hi.two_sum(high);
        let lost = lost.add(x.hi.mul_add(y.lo, x.lo.mul(y.hi)));
        Twofold { hi, lo: self.lo.add(rest.add(lost)) }
    }

    #[inline(always)]
    fn settled(self) -> Self {
        let (hi, lo) = self.hi.two_sum(self.lo);
        Twofold { hi, lo }
    }
}
