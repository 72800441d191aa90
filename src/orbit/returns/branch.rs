//! A matrix function on an interval of offsets, and how many products of such functions may be made.

use super::map::Map;
use super::number::Coefficient;
use crate::parallel::go_on;

/// A matrix function on the integers `start..start + length`, which are units of 1/q, and where it leads: x to x + stride.
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

    /// With the same function on a part of its interval.
    pub fn restricted(&self, start: i128, length: i128) -> Self {
        Branch { map: self.on(start, length), start, length, ..self.clone() }
    }
}

/// Products of functions that may still be made; `None` from whatever needs more.
pub struct Budget(pub u64);

impl Budget {
    /// Pays for as much work as so many products.
    pub fn spend(&mut self, products: u64) -> Option<()> {
        self.0 = self.0.checked_sub(products)?;
        go_on().ok()
    }

    /// `later` after `earlier`.
    pub fn product<T: Coefficient>(&mut self, later: &Map<T>, earlier: &Map<T>) -> Option<Map<T>> {
        self.0 = self.0.checked_sub(1)?;
        if self.0.is_multiple_of(64) {
            go_on().ok()?;
        }
        Some(later.after(earlier)).filter(Map::is_useful)
    }
}
