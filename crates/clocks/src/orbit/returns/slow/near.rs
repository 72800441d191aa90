//! Factors so near to ±1, in fit coordinates, that all those of a piece together do little.
//!
//! At |Tr| = 2 a factor A is ±(1 + N), N² = 0. In coordinates G in which N's entry and what the other one
//! becomes along the piece are equally small, B = G A G⁻¹ = c + X with n |X| of some units for all n steps of
//! the piece. So the products of 2^i factors vary like exponentials of 2^i X, and are functions on all of the
//! piece as long as 2^i |X| < 1.

use super::super::branch::{Branch, Budget};
use super::super::coefficient::Coefficient;
use super::super::map::Map;
use super::normal::inverses;

/// The most that the factors of a piece may do together, n |X|.
const TOGETHER: f64 = 64.0;

/// The most that a power may do, so that its series converges in all its terms.
const POWER: f64 = 0.5;

pub struct Near<T> {
    /// G.
    to: Map<T>,
    /// G⁻¹.
    from: Map<T>,
    /// The products of 2^i factors, where all of these lie on the piece.
    powers: Vec<Branch<T>>,
    stride: i128,
}

/// Entries of the middle, near.
fn middle<T: Coefficient>(map: &Map<T>) -> [f64; 4] {
    map.terms()[0].each_ref().map(T::near)
}

/// |X|/|c| at most, along the piece.
fn distance<T: Coefficient>(map: &Map<T>) -> f64 {
    let size = |term: &[T; 4]| {
        let [a, b, c, d] = term.each_ref().map(T::near);
        (0.5 * (a - d).abs() + b.abs() + c.abs(), 0.5 * (a + d).abs())
    };
    let (first, centre) = size(&map.terms()[0]);
    let rest: f64 = map.terms()[1..].iter().map(|term| size(term).0 + size(term).1).sum();
    (first + rest) / centre
}

/// The coordinates in which a matrix function is nearest to a multiple of 1: a turn that makes its middle's
/// other entry least, then a stretch that makes both alike.
fn fit<T: Coefficient>(map: &Map<T>) -> Option<[f64; 4]> {
    let [a, b, c, d] = middle(map);
    let (alpha, even, odd) = (0.5 * (a - d), 0.5 * (b + c), 0.5 * (b - c));
    let aim = std::f64::consts::FRAC_PI_2.copysign(odd);
    let turn = super::super::turn::principal(aim - even.atan2(alpha)) / 2.0;
    let (sin, cos) = turn.sin_cos();
    // The entries beside the diagonal of R X R^T along the piece.
    let beside = |term: &[T; 4]| {
        let [a, b, c, d] = term.each_ref().map(T::near);
        let (alpha, even, odd) = (0.5 * (a - d), 0.5 * (b + c), 0.5 * (b - c));
        let even = 2.0 * sin * cos * alpha + (cos * cos - sin * sin) * even;
        [(even + odd).abs(), (even - odd).abs()]
    };
    let [upper, lower] = map.terms().iter().map(beside).fold([0.0; 2], |[u, l], [x, y]| [u + x, l + y]);
    let stretch = (lower / upper).sqrt().sqrt();
    (1e-60..1e60).contains(&stretch).then_some([stretch * cos, -stretch * sin, sin / stretch, cos / stretch])
}

impl<T: Coefficient> Near<T> {
    /// Within `Some`, `None` where the factors of the piece do too much; `None` where the budget does not
    /// last.
    #[allow(clippy::option_option)]
    pub fn new(piece: &Branch<T>, steps: u128, budget: &mut Budget) -> Option<Option<Self>> {
        let Some(entries) = fit(&piece.map) else { return Some(None) };
        let Some((to, from)) = inverses(Map::of(vec![entries.map(T::of)])) else { return Some(None) };
        let map = to.after(&piece.map).after(&from);
        let distance = distance(&map);
        let few = distance * steps as f64 <= TOGETHER && map.is_useful();
        if !few {
            return Some(None);
        }
        let (stride, reach) = (piece.stride, piece.stride.abs());
        let mut powers = vec![Branch { map, ..piece.clone() }];
        loop {
            let last = &powers[powers.len() - 1];
            let factors = 1i128 << powers.len();
            // 2^i more factors behind: less of the piece is left, at least half of it.
            let length = last.length - reach * (factors / 2);
            if distance * factors as f64 > POWER || 2 * length < piece.length {
                break;
            }
            let start = if stride > 0 { last.start } else { last.start + reach * (factors / 2) };
            let next = last.on(start + stride * (factors / 2), length);
            let map = budget.product(&next, &last.on(start, length))?.trimmed();
            powers.push(Branch { map, start, length, ..piece.clone() });
        }
        Some(Some(Near { to, from, powers, stride }))
    }

    /// The coordinates, G.
    pub fn enter(&self) -> Map<T> {
        self.to.clone()
    }

    /// G⁻¹.
    pub fn leave(&self) -> Map<T> {
        self.from.clone()
    }

    /// G P_n G⁻¹ from start..start + length, or a point, as long as all of it lies on the piece.
    pub fn product(&self, n: u128, start: i128, length: i128, budget: &mut Budget) -> Option<Map<T>> {
        let (mut product, mut x, mut left): (Option<Map<T>>, i128, u128) = (None, start, n);
        for (log2, power) in self.powers.iter().enumerate().rev() {
            while left >> log2 > 0 {
                let next = power.on(x, length);
                product = Some(match product {
                    Some(product) => budget.product(&next, &product)?,
                    None => next,
                });
                x += self.stride << log2;
                left -= 1 << log2;
            }
        }
        product
    }
}
