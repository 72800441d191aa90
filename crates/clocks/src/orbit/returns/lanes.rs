//! Four numbers side by side: the entries of a matrix, in one register.

use number::Twofold;

/// Four numbers, with the operations of each.
pub trait Lanes<T>: Copy {
    fn of(x: [&T; 4]) -> Self;
    fn entries(self) -> [T; 4];
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    /// self + x y.
    fn plus_times(&self, x: &Self, y: &Self) -> Self;

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
}
