//! Matrix functions of an offset that depend on a box of steps (proofs/BANDS.md).
//!
//! ```text
//!     M(t, u) = Σ V_j t^j + Σ_i u_i Σ F_ij t^j + Σ_k w_k Σ G_kj t^j + E(t, u),
//!     |t|, |u₁|, |u₂| ≤ 1,     w = (u₁², u₁ u₂, u₂²),     |E| ≤ ε in the spectral norm.
//! ```
//!
//! With v = Σ |V_j|, f = Σ |F_ij|, g = Σ |G_kj| the product of two has
//!
//! ```text
//!     ε_BA = f_B g_A + g_B f_A + g_B g_A + (v_B + f_B + g_B) ε_A + (v_A + f_A + g_A + ε_A) ε_B
//!            + terms left out + rounding.
//! ```

use std::ops::Range;

use super::taylor::{Taylor, product_of_slopes};
use super::{FLOOR, UP};
use crate::vector::instructions::{Instructions, Task};

/// [[a, b], [c, d]] in a row.
pub type Matrix = [f64; 4];

const ZERO: Matrix = [0.0; 4];

/// Coefficients of V at most.
const MOST: usize = 32;

/// The monomials 1, u₁, u₂, u₁², u₁ u₂, u₂²: the order of each.
const MONOMIALS: usize = 6;
const ORDER: [usize; MONOMIALS] = [0, 1, 1, 2, 2, 2];

/// Which terms are kept: what is of a higher order in the box is bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// V and F: less than half of the work.
    First,
    /// G, too.
    Second,
}

impl Order {
    /// Coefficients of V, F and G at most.
    fn lengths(self) -> [usize; 3] {
        match self {
            Order::First => [MOST, 20, 0],
            Order::Second => [MOST, 20, 14],
        }
    }
}

/// So small a rest of V is left out, and so small a share of F and of G.
const LEAST: f64 = 1e-8;
const LEAST_SHARES: [f64; 2] = [3e-4, 3e-3];

/// An entry of a coefficient passes through fewer than 115 roundings on its way through a product or to a part, 2^-53 each; in the
/// norm of Frobenius twice that (proofs/BANDS.md).
const ROUNDING: f64 = 3e-14;

/// The monomial of a product of two, where it is of the second order at most.
const fn product_of_monomials(k: usize, l: usize) -> Option<usize> {
    match (k, l) {
        (0, one) | (one, 0) => Some(one),
        (1 | 2, 1 | 2) => Some(k + l + 1),
        _ => None,
    }
}

#[derive(Clone, Debug)]
pub struct Family {
    /// Monomial by monomial, powers of t in each.
    terms: Vec<Matrix>,
    /// Order by order, by powers of t: Σ |.| over the monomials of the order.
    norms: Vec<f64>,
    /// How many coefficients of a monomial there are, by order, and for how many there is room. The others are zero.
    lengths: [usize; 3],
    rooms: [usize; 3],
    order: Order,
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

/// The spectral norm: (|(a + d, b − c)| + |(a − d, b + c)|)/2.
#[inline(always)]
pub fn norm(m: &Matrix) -> f64 {
    let [a, b, c, d] = *m;
    let length = |x: f64, y: f64| (x * x + y * y).sqrt();
    0.5 * (length(a + d, b - c) + length(a - d, b + c)) * UP
}

impl Family {
    /// Nothing but zeros, so many in each monomial of an order.
    #[inline(always)]
    fn zero(order: Order, lengths: [usize; 3]) -> Self {
        let [values, slopes, squares] = lengths;
        let terms = vec![ZERO; values + 2 * slopes + 3 * squares];
        Family {
            terms,
            norms: vec![0.0; values + slopes + squares],
            lengths,
            rooms: lengths,
            order,
            error: 0.0,
        }
    }

    /// From the coefficients of its entries.
    pub fn new(order: Order, coefficients: &[[Taylor; 4]]) -> Self {
        let mut family = Family::zero(order, order.lengths().map(|most| most.min(coefficients.len())));
        family.error = FLOOR;
        for (j, entries) in coefficients.iter().enumerate() {
            let by_monomial = entries.map(|entry| entry.coefficients());
            for k in 0..MONOMIALS {
                let term = by_monomial.map(|entry| entry[k]);
                match family.of_mut(k).get_mut(j) {
                    Some(own) => *own = term,
                    None => family.error += norm(&term) * UP,
                }
            }
            family.error += entries.iter().map(|entry| entry.error).sum::<f64>() * UP;
        }
        family.measure();
        family
    }

    /// The identity.
    pub fn identity(order: Order) -> Self {
        let [one, zero] = [1.0, 0.0].map(|x| Taylor::constant(x, 0.0));
        Family::new(order, &[[one, zero, zero, one]])
    }

    /// This function with its remainder enlarged by `by`.
    pub fn widened(mut self, by: f64) -> Self {
        self.error = (self.error + by) * UP;
        self
    }

    /// In the middle of the box alone, and without what is not known: nothing is proven with it.
    pub fn keep_middle(&mut self) {
        self.lengths = [self.lengths[0], 0, 0];
        self.error = 0.0;
    }

    /// Where the coefficients of a monomial are.
    #[inline(always)]
    fn place(&self, k: usize) -> Range<usize> {
        let [values, slopes, squares] = self.rooms;
        let begin = [0, values, values + slopes, 0, squares, 2 * squares][k];
        let begin = if k < 3 { begin } else { begin + values + 2 * slopes };
        begin..begin + self.lengths[ORDER[k]]
    }

    /// The coefficients of a monomial.
    #[inline(always)]
    fn of(&self, k: usize) -> &[Matrix] {
        &self.terms[self.place(k)]
    }

    #[inline(always)]
    fn of_mut(&mut self, k: usize) -> &mut [Matrix] {
        let place = self.place(k);
        &mut self.terms[place]
    }

    /// The first coefficient of a monomial.
    fn at_zero(&self, k: usize) -> Matrix {
        self.of(k).first().copied().unwrap_or(ZERO)
    }

    /// The coefficients of V.
    pub fn values(&self) -> &[Matrix] {
        self.of(0)
    }

    /// The coefficients of F for u₁, and for u₂.
    pub fn slopes(&self) -> [&[Matrix]; 2] {
        [1, 2].map(|k| self.of(k))
    }

    /// The coefficients of G for u₁², u₁ u₂ and u₂².
    pub fn squares(&self) -> [&[Matrix]; 3] {
        [3, 4, 5].map(|k| self.of(k))
    }

    /// Σ |.| over the monomials of an order, by powers of t.
    #[inline(always)]
    fn norms(&self, order: usize) -> &[f64] {
        let [values, slopes, _] = self.rooms;
        &self.norms[[0, values, values + slopes][order]..][..self.lengths[order]]
    }

    /// Where its coefficients are those that they will be.
    #[inline(always)]
    fn measure(&mut self) {
        let mut begin = 0;
        for (order, monomials) in [0..1, 1..3, 3..6].into_iter().enumerate() {
            for j in 0..self.lengths[order] {
                let mut sum = 0.0;
                for k in monomials.clone() {
                    sum += norm(&self.of(k)[j]);
                }
                self.norms[begin + j] = sum;
            }
            begin += self.rooms[order];
        }
    }

    /// Without the last terms that are far below what counts.
    #[inline(always)]
    fn trim(&mut self) {
        for order in 0..3 {
            let norms = self.norms(order);
            let most = match (order, norms) {
                (0, _) => LEAST,
                (_, [first, ..]) => LEAST_SHARES[order - 1] * first,
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
        [0, 1, 2].map(|order| self.norms(order).iter().sum())
    }

    /// A bound on |V| + |F| + |G| + ε.
    pub fn size(&self) -> f64 {
        (self.sizes().iter().sum::<f64>() + self.error) * UP
    }

    /// V at t.
    pub fn at(&self, t: f64) -> Matrix {
        self.values().iter().rev().fold(ZERO, |sum, m| std::array::from_fn(|i| sum[i] * t + m[i]))
    }

    /// How far one of the steps moves it at t = 0.
    pub fn moved_by(&self, direction: usize) -> f64 {
        norm(&self.at_zero(1 + direction))
    }

    /// How far one of the steps bends it at t = 0.
    pub fn bent_by(&self, direction: usize) -> f64 {
        norm(&self.at_zero(3 + 2 * direction)) + 0.5 * norm(&self.at_zero(4))
    }

    /// About the largest trace at t = 0 in the box; no proof rests on it.
    pub fn largest_trace(&self) -> f64 {
        let trace = |m: Matrix| (m[0] + m[3]).abs();
        (0..MONOMIALS).map(|k| trace(self.at_zero(k))).sum::<f64>() + self.error
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

/// Σ j (j − 1) ⋯ (j − k + 1) |.| r^(j − 1) over the powers j ≥ 1: a bound on the k-th derivative, k ≥ 1, where |t| ≤ r and r ≥ 1.
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
        let (most_of, mut lengths, mut left_out) = (later.order.lengths(), [0; 3], 0.0);
        for p in 0..3 {
            for q in 0..3 - p {
                let (n, m, most) = (later.lengths[p], earlier.lengths[q], most_of[p + q]);
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
        let mut product = Family::zero(later.order, lengths);
        for k in 0..MONOMIALS {
            for l in 0..MONOMIALS {
                let Some(target) = product_of_monomials(k, l) else { continue };
                let sums = product.of_mut(target);
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

    /// Adds the derivative of this rank by t', times `by` and the powers of t' in `turns`; a bound on what has no place.
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
        for k in 0..MONOMIALS {
            Self::moved(moved.of_mut(k), alpha, beta);
        }
        moved.measure();
        let [values, slopes, squares] = whole.lengths;
        let lengths = if values > 1 && share.first() > 0.0 {
            [values, slopes.max(values), squares.max(slopes).max(values)]
        } else {
            whole.lengths
        };
        let most_of = whole.order.lengths();
        let mut part = Family::zero(whole.order, [0, 1, 2].map(|order| lengths[order].min(most_of[order])));
        for k in 0..MONOMIALS {
            for (own, term) in part.of_mut(k).iter_mut().zip(moved.of(k)) {
                *own = *term;
            }
        }
        // V(t + Δ) = V + V' Δ + ½ V'' Δ² + ..., F(t + Δ) = F + F' Δ + ..., Δ = (−1 ± t') (r₁ u₁ + r₂ u₂ + ...).
        let unit = 1.0 / beta;
        let (once, twice) = ([-1.0, turn], [1.0, -2.0 * turn, 1.0]);
        let bends = product_of_slopes(share.slopes, share.slopes).map(|x| 0.5 * x * unit * unit);
        let mut left_out = 0.0;
        for (i, by) in share.slopes.map(|x| x * unit).into_iter().enumerate() {
            left_out += Self::add(part.of_mut(1 + i), moved.of(0), 1, by, &once);
            for j in 0..2 {
                left_out += Self::add(part.of_mut(3 + i + j), moved.of(1 + j), 1, by, &once);
            }
        }
        for (k, (square, bend)) in share.squares.into_iter().zip(bends).enumerate() {
            left_out += Self::add(part.of_mut(3 + k), moved.of(0), 1, square * unit, &once);
            left_out += Self::add(part.of_mut(3 + k), moved.of(0), 2, bend, &twice);
        }
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
        // Where the center of the box is none of those u that count, t may leave [−1, 1] there, and powers of it grow.
        let beyond = (alpha.abs() + beta.abs()).max(1.0);
        let outside = (0..MOST).fold(1.0, |power, _| power * beyond);
        let both = |order: usize, k: usize| {
            derivative(whole.norms(order), k, 1.0) + derivative(whole.norms(order), k + 1, 1.0)
        };
        let along = share.first();
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

    /// Its polynomial at an offset and at a point of the box.
    fn value(family: &Family, t: f64, [u, v]: [f64; 2]) -> Matrix {
        let monomials = [1.0, u, v, u * u, u * v, v * v];
        let mut sum = ZERO;
        for (k, monomial) in monomials.into_iter().enumerate() {
            for (j, m) in family.of(k).iter().enumerate() {
                (0..4).for_each(|i| sum[i] += m[i] * monomial * t.powi(j as i32));
            }
        }
        sum
    }

    fn off(near: Matrix, exact: Matrix) -> f64 {
        norm(&[0, 1, 2, 3].map(|i| near[i] - exact[i]))
    }

    /// Coefficients that fall off by this factor each, and with the order.
    fn family(order: Order) -> impl Strategy<Value = Family> {
        (prop::collection::vec(prop::array::uniform24(-1.0..1.0), 1..DEGREE), 0.1..0.9, 0.01..0.5).prop_map(
            move |(terms, decay, unit): (Vec<[f64; 24]>, f64, f64)| {
                let coefficient = |(j, numbers): (usize, &[f64; 24])| {
                    let size = decay.powi(j as i32);
                    [0, 6, 12, 18].map(|n| Taylor {
                        center: size * numbers[n],
                        slopes: [1, 2].map(|i| size * unit * numbers[n + i]),
                        squares: [3, 4, 5].map(|i| size * unit * unit * numbers[n + i]),
                        error: 0.0,
                    })
                };
                Family::new(order, &terms.iter().enumerate().map(coefficient).collect::<Vec<_>>())
            },
        )
    }

    fn pair() -> impl Strategy<Value = (Family, Family)> {
        prop_oneof![Just(Order::First), Just(Order::Second)]
            .prop_flat_map(|order| (family(order), family(order)))
    }

    proptest! {
        #[test]
        fn products_and_parts_enclose_theirs(
            (later, earlier) in pair(), t in -1.0..=1.0f64, u in prop::array::uniform2(-1.0..=1.0f64),
            r in 0.2..0.8, slopes in prop::array::uniform2(-0.1..0.1), squares in prop::array::uniform3(-0.03..0.03),
        ) {
            // Terms beyond the first order are in ε.
            let own = |family: &Family| family.error + 1e-13 * family.size();
            let [[a, b, c, d], [e, f, g, h]] = [&later, &earlier].map(|family| value(family, t, u));
            let exact = [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h];
            let product = later.after(&earlier);
            prop_assert!(off(value(&product, t, u), exact) <= own(&product), "{product:?}");
            let share = Taylor { center: r, slopes, squares, error: 0.0 };
            let [_, d, e, p, q, s] = share.coefficients();
            let r = r + d * u[0] + e * u[1] + p * u[0] * u[0] + q * u[0] * u[1] + s * u[1] * u[1];
            for (cut, from) in [(Cut::Last, 1.0 - r * (1.0 - t)), (Cut::Before, (1.0 - r) * (1.0 + t) - 1.0)] {
                let part = later.part(cut, &share);
                prop_assert!(off(value(&part, t, u), value(&later, from, u)) <= own(&part), "{cut:?}: {part:?}");
            }
        }
    }
}
