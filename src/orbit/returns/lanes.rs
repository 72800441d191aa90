//! Four numbers side by side: the entries of a matrix, in one register.

use crate::number::Twofold;
use crate::vector::each;

/// Four numbers, with the operations of each.
pub trait Lanes<T>: Clone {
    fn of(x: [&T; 4]) -> Self;
    fn entries(self) -> [T; 4];
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;

    /// In all four.
    #[inline(always)]
    fn splat(x: &T) -> Self {
        Self::of([x; 4])
    }
}

/// Pairs of doubles, with the operations of [`Twofold`] to the bit.
#[derive(Clone)]
pub struct Twofolds {
    hi: [f64; 4],
    lo: [f64; 4],
}

/// hi + lo, |lo| ≤ |hi|.
#[inline(always)]
fn joined(hi: [f64; 4], lo: [f64; 4]) -> Twofolds {
    let sum: [f64; 4] = each(|i| hi[i] + lo[i]);
    Twofolds { hi: sum, lo: each(|i| lo[i] - (sum[i] - hi[i])) }
}

impl Lanes<Twofold> for Twofolds {
    #[inline(always)]
    fn of(x: [&Twofold; 4]) -> Self {
        Twofolds { hi: x.map(|x| x.hi), lo: x.map(|x| x.lo) }
    }

    #[inline(always)]
    fn entries(self) -> [Twofold; 4] {
        std::array::from_fn(|i| Twofold { hi: self.hi[i], lo: self.lo[i] })
    }

    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let (a, b) = (&self.hi, &other.hi);
        let sum: [f64; 4] = each(|i| a[i] + b[i]);
        let part: [f64; 4] = each(|i| sum[i] - a[i]);
        let lost: [f64; 4] = each(|i| (a[i] - (sum[i] - part[i])) + (b[i] - part[i]));
        joined(sum, each(|i| lost[i] + (self.lo[i] + other.lo[i])))
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let (a, b) = (&self.hi, &other.hi);
        let product: [f64; 4] = each(|i| a[i] * b[i]);
        let lost: [f64; 4] = each(|i| a[i].mul_add(b[i], -product[i]));
        joined(product, each(|i| lost[i] + a[i].mul_add(other.lo[i], self.lo[i] * b[i])))
    }
}
