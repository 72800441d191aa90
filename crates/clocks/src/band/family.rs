//! Matrix functions of an offset that depend on the ratio of the steps (proofs/BANDS.md).
//!
//! ```text
//!     M(t, u) = Σ V_j t^j + u Σ F_j t^j + u² Σ G_j t^j + E(t, u),     |t|, |u| ≤ 1,     |E| ≤ ε in the spectral norm.
//! ```
//!
//! With v = Σ |V_j|, f = Σ |F_j|, g = Σ |G_j| the product of two has
//!
//! ```text
//!     ε_BA = f_B g_A + g_B f_A + g_B g_A + (v_B + f_B + g_B) ε_A + (v_A + f_A + g_A + ε_A) ε_B
//!            + terms left out + rounding.
//! ```

use std::ops::Range;

use super::taylor::Taylor;
use crate::orbit::returns::{FLOOR, UP, norm};
use number::vector::instructions::{Instructions, Task};

/// [[a, b], [c, d]] in a row.
pub type Matrix = [f64; 4];

const ZERO: Matrix = [0.0; 4];

/// V, F and G: the powers of u.
const ORDERS: usize = 3;

/// Their coefficients at most.
const MOST: [usize; ORDERS] = [32, 20, 14];

/// Terms are cut where the rest of V is below this, and where it is below these shares of F and of G.
const TRUNCATION_V: f64 = 1e-8;
const TRUNCATION_FG: [f64; 2] = [3e-4, 3e-3];

/// An entry of a coefficient passes through fewer than 115 roundings on its way through a product or to a
/// part, 2^-53 each; in the norm of Frobenius twice that (proofs/BANDS.md).
const ROUNDING: f64 = 3e-14;

#[derive(Clone, Debug)]
pub struct Family {
    /// V, then F, then G, by powers of t in each.
    terms: Vec<Matrix>,
    /// Their spectral norms.
    norms: Vec<f64>,
    /// How many coefficients of each there are, and for how many there is room. The others are zero.
    lengths: [usize; ORDERS],
    rooms: [usize; ORDERS],
    /// ε.
    pub error: f64,
}

/// The part of an interval that is cut off, of a share r of it, or what is left before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cut {
    /// The last share r: t = 1 − r (1 − t').
    Last,
    /// The part before it: t = −1 + (1 − r) (1 + t').
    Before,
}

impl Family {
    /// Nothing but zeros.
    #[inline(always)]
    fn zero(lengths: [usize; ORDERS]) -> Self {
        let all = lengths.iter().sum();
        Family { terms: vec![ZERO; all], norms: vec![0.0; all], lengths, rooms: lengths, error: 0.0 }
    }

    /// From the coefficients of its entries.
    pub fn new(coefficients: &[[Taylor; 4]]) -> Self {
        let mut family = Family::zero(MOST.map(|most| most.min(coefficients.len())));
        family.error = FLOOR;
        for (j, entries) in coefficients.iter().enumerate() {
            let by_order = entries.map(|entry| entry.coefficients());
            for k in 0..ORDERS {
                let term = by_order.map(|entry| entry[k]);
                match family.of_mut(k).get_mut(j) {
                    Some(values) => *values = term,
                    None => family.error += norm(&term) * UP,
                }
            }
            family.error += entries.iter().map(|entry| entry.error).sum::<f64>() * UP;
        }
        family.measure();
        family
    }

    /// The identity.
    pub fn identity() -> Self {
        let [one, zero] = [1.0, 0.0].map(|x| Taylor::constant(x, 0.0));
        Family::new(&[[one, zero, zero, one]])
    }

    /// This function with its remainder enlarged by `by`.
    pub fn widened(mut self, by: f64) -> Self {
        self.error = (self.error + by) * UP;
        self
    }

    /// Where the coefficients of an order are.
    #[inline(always)]
    fn place(&self, k: usize) -> Range<usize> {
        let begin: usize = self.rooms[..k].iter().sum();
        begin..begin + self.lengths[k]
    }

    /// The coefficients of V, F or G.
    #[inline(always)]
    pub fn of(&self, k: usize) -> &[Matrix] {
        &self.terms[self.place(k)]
    }

    #[inline(always)]
    fn of_mut(&mut self, k: usize) -> &mut [Matrix] {
        let place = self.place(k);
        &mut self.terms[place]
    }

    /// Their norms.
    #[inline(always)]
    fn norms(&self, k: usize) -> &[f64] {
        &self.norms[self.place(k)]
    }

    /// Where its coefficients are those that they will be.
    #[inline(always)]
    fn measure(&mut self) {
        for k in 0..ORDERS {
            for j in self.place(k) {
                self.norms[j] = norm(&self.terms[j]);
            }
        }
    }

    /// Without the last terms that are far below what counts.
    #[inline(always)]
    fn trim(&mut self) {
        for order in 0..ORDERS {
            let norms = self.norms(order);
            let most = match (order, norms) {
                (0, _) => TRUNCATION_V,
                (_, [first, ..]) => TRUNCATION_FG[order - 1] * first,
                _ => 0.0,
            };
            let (mut length, mut left_out) = (norms.len(), 0.0);
            while length > 1 && left_out + norms[length - 1] <= most {
                length -= 1;
                left_out += norms[length];
            }
            self.lengths[order] = length;
            self.error = (self.error + left_out) * UP;
        }
    }

    /// v, f and g.
    #[inline(always)]
    fn sizes(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.norms(k).iter().sum())
    }

    /// A bound on |V| + |F| + |G| + ε.
    pub fn size(&self) -> f64 {
        (self.sizes().iter().sum::<f64>() + self.error) * UP
    }

    /// V at t.
    pub fn at(&self, t: f64) -> Matrix {
        self.of(0).iter().rev().fold(ZERO, |sum, m| std::array::from_fn(|i| sum[i] * t + m[i]))
    }

    /// How far the ratio moves it at t = 0.
    pub fn moved(&self) -> f64 {
        self.norms(1).first().copied().unwrap_or(0.0)
    }

    /// `self` after `earlier`.
    pub fn after(&self, earlier: &Self) -> Self {
        Instructions::best().perform_alone(Product(self, earlier))
    }

    /// On a part of its interval, of a share r(u) or 1 − r(u). For all u that count, 0 ≤ r ≤ 1.
    pub fn part(&self, cut: Cut, share: &Taylor) -> Self {
        Instructions::best().perform_alone(Part(self, cut, share))
    }
}

/// Σ j (j − 1) ⋯ (j − k + 1) |.| r^(j − 1) over the powers j ≥ 1: a bound on the k-th derivative, k ≥ 1,
/// where |t| ≤ r and r ≥ 1.
#[inline(always)]
fn derivative(norms: &[f64], k: usize, r: f64) -> f64 {
    let (mut sum, mut power) = (0.0, 1.0);
    for (j, size) in norms.iter().enumerate().skip(1) {
        sum += falling(j, k) * size * power;
        power *= r;
    }
    sum
}

/// j (j − 1) ⋯ (j − k + 1).
#[inline(always)]
fn falling(j: usize, k: usize) -> f64 {
    let mut product = 1.0;
    for i in 0..k {
        product *= j as f64 - i as f64;
    }
    product
}

#[inline(always)]
fn add_product(sum: &mut Matrix, [a, b, c, d]: &Matrix, [e, f, g, h]: &Matrix) {
    let (first, second) = ([a, a, c, c], [b, b, d, d]);
    let (upper, lower) = ([e, f, e, f], [g, h, g, h]);
    for i in 0..4 {
        sum[i] = first[i].mul_add(*upper[i], second[i].mul_add(*lower[i], sum[i]));
    }
}

struct Product<'a>(&'a Family, &'a Family);

impl Task for Product<'_> {
    type Output = Family;

    #[inline(always)]
    fn run(self) -> Family {
        let Product(later, earlier) = self;
        let (mut lengths, mut left_out) = ([0; ORDERS], 0.0);
        for p in 0..ORDERS {
            for q in 0..ORDERS - p {
                let (n, m, most) = (later.lengths[p], earlier.lengths[q], MOST[p + q]);
                if n > 0 && m > 0 {
                    lengths[p + q] = (n + m - 1).min(most).max(lengths[p + q]);
                }
                for (i, b) in later.norms(p).iter().enumerate().skip((most + 1).saturating_sub(m)) {
                    for a in &earlier.norms(q)[most.saturating_sub(i)..] {
                        left_out += b * a;
                    }
                }
            }
        }
        let mut product = Family::zero(lengths);
        for k in 0..ORDERS {
            for l in 0..ORDERS - k {
                let sums = product.of_mut(k + l);
                for (i, first) in later.of(k).iter().enumerate().take(sums.len()) {
                    for (sum, second) in sums[i..].iter_mut().zip(earlier.of(l)) {
                        add_product(sum, first, second);
                    }
                }
            }
        }
        let [[v_b, f_b, g_b], [v_a, f_a, g_a]] = [later.sizes(), earlier.sizes()];
        let whole = [v_b + f_b + g_b, v_a + f_a + g_a];
        let third = f_b * g_a + g_b * f_a + g_b * g_a;
        let carried = whole[0] * earlier.error + (whole[1] + earlier.error) * later.error;
        let rounding = ROUNDING * whole[0] * whole[1];
        product.error = (third + carried + left_out + rounding) * UP + FLOOR;
        product.measure();
        product.trim();
        product
    }
}

struct Part<'a>(&'a Family, Cut, &'a Taylor);

impl Part<'_> {
    /// The coefficients in t' of t = α + β t'.
    #[inline(always)]
    fn moved(terms: &mut [Matrix], alpha: f64, beta: f64) {
        for i in 0..terms.len() {
            let (last, others) = terms[i..].split_last_mut().expect("terms from i on");
            let mut next = *last;
            for term in others.iter_mut().rev() {
                for (entry, next) in term.iter_mut().zip(&mut next) {
                    *next = alpha.mul_add(*next, *entry);
                    *entry = *next;
                }
            }
        }
        let mut power = 1.0;
        for term in terms {
            for entry in term {
                *entry *= power;
            }
            power *= beta;
        }
    }

    /// Adds the derivative of this rank by t', times `by` and the powers of t' in `turns`; a bound on what
    /// has no place.
    #[inline(always)]
    fn add(sums: &mut [Matrix], terms: &[Matrix], rank: usize, by: f64, turns: &[f64]) -> f64 {
        let mut left_out = 0.0;
        for (j, term) in terms.iter().enumerate().skip(rank) {
            for (i, turn) in turns.iter().enumerate() {
                let factor = falling(j, rank) * by * turn;
                match sums.get_mut(i + j - rank) {
                    Some(sum) => {
                        for (sum, x) in sum.iter_mut().zip(term) {
                            *sum = factor.mul_add(*x, *sum);
                        }
                    }
                    None => left_out += norm(term) * factor.abs(),
                }
            }
        }
        left_out
    }
}

impl Task for Part<'_> {
    type Output = Family;

    #[inline(always)]
    fn run(self) -> Family {
        let Part(whole, cut, share) = self;
        let r = share.center;
        // ∂t/∂r = −1 ± t'.
        let (alpha, beta, turn) = match cut {
            Cut::Last => (1.0 - r, r, 1.0),
            Cut::Before => (-r, 1.0 - r, -1.0),
        };
        let mut moved = whole.clone();
        for k in 0..ORDERS {
            Self::moved(moved.of_mut(k), alpha, beta);
        }
        moved.measure();
        let [values, slopes, squares] = whole.lengths;
        let lengths = if values > 1 && share.slope != 0.0 {
            [values, slopes.max(values), squares.max(slopes).max(values)]
        } else {
            whole.lengths
        };
        let mut part = Family::zero([0, 1, 2].map(|k| lengths[k].min(MOST[k])));
        for k in 0..ORDERS {
            for (values, term) in part.of_mut(k).iter_mut().zip(moved.of(k)) {
                *values = *term;
            }
        }
        // V(t + Δ) = V + V' Δ + ½ V'' Δ² + ..., F(t + Δ) = F + F' Δ + ..., Δ = (−1 ± t') (r u + ...).
        let unit = 1.0 / beta;
        let (once, twice) = ([-1.0, turn], [1.0, -2.0 * turn, 1.0]);
        let (by, bend) = (share.slope * unit, share.square * unit);
        let left_out = Self::add(part.of_mut(1), moved.of(0), 1, by, &once)
            + Self::add(part.of_mut(2), moved.of(1), 1, by, &once)
            + Self::add(part.of_mut(2), moved.of(0), 1, bend, &once)
            + Self::add(part.of_mut(2), moved.of(0), 2, 0.5 * by * by, &twice);
        // Between t at the center and t at u: |t'| ≤ 1 + δ/β, in the coefficients of the part.
        let unit = unit.abs() * UP;
        let move_by = 2.0 * share.reach() * unit * UP;
        let rest = |order: usize, k: usize| derivative(moved.norms(order), k, 1.0 + move_by);
        let carried = rest(0, 1) * 2.0 * share.error * unit
            + rest(0, 2) * 2.0 * share.square_beside_affine() * unit * unit
            + rest(0, 3) * move_by * move_by * move_by / 6.0
            + rest(1, 1) * 2.0 * share.bent() * unit
            + rest(1, 2) * 0.5 * move_by * move_by
            + rest(2, 1) * move_by;
        // Where the center of the box is none of those u that count, t may leave [−1, 1] there, and powers of
        // it grow.
        let beyond = (alpha.abs() + beta.abs()).max(1.0);
        let outside = (0..MOST[0]).fold(1.0, |power, _| power * beyond);
        let both = |order: usize, k: usize| {
            derivative(whole.norms(order), k, 1.0) + derivative(whole.norms(order), k + 1, 1.0)
        };
        let along = share.slope.abs();
        let rounding = ROUNDING
            * outside
            * (whole.size()
                + both(0, 1)
                + both(1, 1)
                + both(2, 1)
                + 2.0 * share.reach() * both(0, 1)
                + 2.0 * along * along * both(0, 2)
                + 2.0 * along * both(1, 1));
        part.error = (whole.error + carried + left_out + rounding) * UP + FLOOR;
        part.measure();
        part.trim();
        part
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const DEGREE: usize = 12;

    /// Its polynomial at an offset and at a ratio.
    fn value(family: &Family, t: f64, u: f64) -> Matrix {
        let mut sum = ZERO;
        for k in 0..ORDERS {
            for (j, m) in family.of(k).iter().enumerate() {
                (0..4).for_each(|i| sum[i] += m[i] * u.powi(k as i32) * t.powi(j as i32));
            }
        }
        sum
    }

    fn off(near: Matrix, exact: Matrix) -> f64 {
        norm(&[0, 1, 2, 3].map(|i| near[i] - exact[i]))
    }

    /// Coefficients that fall off by this factor each, and with the order.
    fn family() -> impl Strategy<Value = Family> {
        (prop::collection::vec(prop::array::uniform12(-1.0..1.0), 1..DEGREE), 0.1..0.9, 0.01..0.5).prop_map(
            move |(terms, decay, unit): (Vec<[f64; 12]>, f64, f64)| {
                let coefficient = |(j, numbers): (usize, &[f64; 12])| {
                    let size = decay.powi(j as i32);
                    [0, 3, 6, 9].map(|n| Taylor {
                        center: size * numbers[n],
                        slope: size * unit * numbers[n + 1],
                        square: size * unit * unit * numbers[n + 2],
                        error: 0.0,
                    })
                };
                Family::new(&terms.iter().enumerate().map(coefficient).collect::<Vec<_>>())
            },
        )
    }

    proptest! {
        #[test]
        fn products_and_parts_enclose_theirs(
            (later, earlier) in (family(), family()), t in -1.0..=1.0f64, u in -1.0..=1.0f64,
            r in 0.2..0.8, slope in -0.1..0.1, square in -0.03..0.03,
        ) {
            // Terms beyond the second order are in ε.
            let own = |family: &Family| family.error + 1e-13 * family.size();
            let [[a, b, c, d], [e, f, g, h]] = [&later, &earlier].map(|family| value(family, t, u));
            let exact = [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h];
            let product = later.after(&earlier);
            prop_assert!(off(value(&product, t, u), exact) <= own(&product), "{product:?}");
            let share = Taylor { center: r, slope, square, error: 0.0 };
            let r = r + slope * u + square * u * u;
            for (cut, from) in [(Cut::Last, 1.0 - r * (1.0 - t)), (Cut::Before, (1.0 - r) * (1.0 + t) - 1.0)] {
                let part = later.part(cut, &share);
                prop_assert!(off(value(&part, t, u), value(&later, from, u)) <= own(&part), "{cut:?}: {part:?}");
            }
        }
    }
}
