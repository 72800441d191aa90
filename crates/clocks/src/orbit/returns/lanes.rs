//! Four numbers side by side: the entries of a matrix, in one register.

use number::Twofold;
use number::vector::Pair;

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

/// Pairs of doubles.
#[derive(Clone, Copy)]
pub struct Twofolds(Pair<[f64; 4]>);

impl Lanes<Twofold> for Twofolds {
    #[inline(always)]
    fn of(x: [&Twofold; 4]) -> Self {
        Twofolds(Pair { hi: x.map(|x| x.hi), lo: x.map(|x| x.lo) })
    }

    #[inline(always)]
    fn entries(self) -> [Twofold; 4] {
        std::array::from_fn(|i| Twofold { hi: self.0.hi[i], lo: self.0.lo[i] })
    }

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Twofolds(self.0.plus(other.0))
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        Twofolds(self.0.times(other.0))
    }

    #[inline(always)]
    fn plus_times(&self, x: &Self, y: &Self) -> Self {
        self.plus(&x.times(y))
    }
}
