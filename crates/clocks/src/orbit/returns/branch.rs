//! A matrix function on an interval of offsets, and how many products of such functions may be made.

use super::coefficient::Coefficient;
use super::map::Map;
use super::row;
use number::parallel::go_on;

/// A matrix function on the integers `start..start + length`, which are units of 1/q, and where it leads: x
/// to x + stride.
#[derive(Clone)]
pub struct Branch<T> {
    pub map: Map<T>,
    pub start: i128,
    pub length: i128,
    pub stride: i128,
    /// The slow kicks that it holds.
    pub height: u128,
}

impl<T: Coefficient> Branch<T> {
    /// On a part of the interval, or at a point, a part of length 0.
    pub fn on(&self, start: i128, length: i128) -> Map<T> {
        if (start, length) == (self.start, self.length) {
            return self.map.clone();
        }
        let alpha = 2 * (start - self.start) - (self.length - length);
        let divisor = self.length as u128;
        let alpha = T::quotient(alpha, divisor);
        if length == 0 { self.map.at(&alpha) } else { self.map.part(&alpha, &T::quotient(length, divisor)) }
    }

    /// The product of n equidistant parts, or values at points, from `start` on; `None` where single products
    /// keep more digits.
    pub fn row(&self, n: usize, start: i128, length: i128) -> Option<Map<T>> {
        let first = 2 * (start - self.start) - (self.length - length);
        let divisor = self.length as u128;
        let mut places = [T::zero(); row::LONGEST];
        for (place, i) in places[..n].iter_mut().zip(0..) {
            *place = T::quotient(first + 2 * self.stride * i, divisor);
        }
        row::product(&self.map, &places[..n], &T::quotient(length, divisor))
    }

    /// With the same function on a part of its interval.
    pub fn restricted(&self, start: i128, length: i128) -> Self {
        Branch { map: self.on(start, length), start, length, ..self.clone() }
    }

    /// In other numbers.
    pub fn rounded<P: Coefficient>(&self) -> Branch<P> {
        let Branch { ref map, start, length, stride, height } = *self;
        Branch { map: map.rounded(), start, length, stride, height }
    }
}

/// The products of functions in doubles that may still be made, or as much work; `None` from whatever needs
/// more.
pub struct Budget(u64);

impl Budget {
    /// The highest cost of a run whose first levels are known in these numbers.
    pub fn of<T: Coefficient>() -> Self {
        Budget(T::PRODUCTS * T::COST)
    }

    /// Pays for as much work as so many products.
    pub fn spend<T: Coefficient>(&mut self, products: u64) -> Option<()> {
        self.0 = self.0.checked_sub(products * T::COST)?;
        go_on().ok()
    }

    /// `later` after `earlier`.
    pub fn product<T: Coefficient>(&mut self, later: &Map<T>, earlier: &Map<T>) -> Option<Map<T>> {
        let before = self.0;
        self.0 = before.checked_sub(T::COST)?;
        if before / HEARD != self.0 / HEARD {
            go_on().ok()?;
        }
        Some(later.after(earlier)).filter(Map::is_useful)
    }
}

/// After so much work it is asked whether to go on.
const HEARD: u64 = 64;
