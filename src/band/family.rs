//! Matrix functions of an offset that depend on a box of steps (proofs/BANDS.md).
//!
//! ```text
//!     M(t, u) = Σ V_j t^j + Σ_i u_i Σ F_ij t^j + E(t, u),     |t|, |u₁|, |u₂| ≤ 1, |E| ≤ ε in the spectral norm.
//! ```
//!
//! With v = Σ |V_j|, f = Σ |F_ij| the product of two has
//!
//! ```text
//!     ε_BA = f_B f_A + (v_B + f_B) ε_A + (v_A + f_A + ε_A) ε_B + terms left out + rounding.
//! ```

use super::affine::Affine;
use super::{FLOOR, UP};
use crate::vector::instructions::{Instructions, Task};

/// [[a, b], [c, d]] in a row.
pub type Matrix = [f64; 4];

/// Coefficients of V, and of F.
const VALUES: usize = 32;
const SLOPES: usize = 20;

/// So small a rest of V is left out, and so small a share of F.
const LEAST: f64 = 1e-8;
const LEAST_SLOPE: f64 = 3e-4;

/// An entry of a coefficient passes through fewer than 85 roundings on its way through a product or to a part, 2^-53 each; in the
/// norm of Frobenius twice that (proofs/BANDS.md).
const ROUNDING: f64 = 2e-14;

#[derive(Clone, Debug)]
pub struct Family {
    values: [Matrix; VALUES],
    slopes: [[Matrix; SLOPES]; 2],
    /// How many coefficients of V and of F there are; the others are zero.
    lengths: [usize; 2],
    /// ε.
    pub error: f64,
}

/// The part of an interval that is cut off, of a share r of it, or what is left before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cut {
    /// The last share r: t = 1 − r (1 − t').
    Last,
    /// What lies before it: t = −1 + (1 − r) (1 + t').
    Before,
}

/// The spectral norm: (|(a + d, b − c)| + |(a − d, b + c)|)/2.
#[inline(always)]
pub fn norm(m: &Matrix) -> f64 {
    let [a, b, c, d] = *m;
    let length = |x: f64, y: f64| (x * x + y * y).sqrt();
    0.5 * (length(a + d, b - c) + length(a - d, b + c)) * UP
}

/// v, its derivatives' bounds Σ j |V_j| and Σ j (j − 1) |V_j|, f and Σ j |F_ij|.
struct Sizes {
    value: f64,
    first: f64,
    second: f64,
    slope: f64,
    slope_first: f64,
}

impl Family {
    /// From the coefficients of its entries, affine in u each.
    pub fn new(terms: &[[Affine; 4]]) -> Self {
        let mut family = Family {
            values: [[0.0; 4]; VALUES],
            slopes: [[[0.0; 4]; SLOPES]; 2],
            lengths: [terms.len(), terms.len()],
            error: FLOOR,
        };
        family.lengths[1] = terms.len().min(SLOPES);
        for (j, term) in terms.iter().enumerate() {
            family.values[j] = term.map(|entry| entry.center);
            for direction in [0, 1] {
                let slopes = term.map(|entry| entry.slopes[direction]);
                if j < SLOPES {
                    family.slopes[direction][j] = slopes
                } else {
                    family.error += norm(&slopes) * UP
                }
            }
            family.error += term.iter().map(|entry| entry.error).sum::<f64>() * UP;
        }
        family
    }

    /// The identity.
    pub fn identity() -> Self {
        let [one, zero] = [1.0, 0.0].map(|x| Affine::constant(x, 0.0));
        Family::new(&[[one, zero, zero, one]])
    }

    /// The same function, known up to `by` less well.
    pub fn widened(mut self, by: f64) -> Self {
        self.error = (self.error + by) * UP;
        self
    }

    /// In the middle of the box alone, and without what is not known: nothing is proven with it.
    pub fn keep_middle(&mut self) {
        self.slopes = [[[0.0; 4]; SLOPES]; 2];
        self.lengths[1] = 1;
        self.error = 0.0;
    }

    /// The coefficients of V.
    pub fn values(&self) -> &[Matrix] {
        &self.values[..self.lengths[0]]
    }

    /// The coefficients of F in one direction.
    pub fn slopes(&self, direction: usize) -> &[Matrix] {
        &self.slopes[direction][..self.lengths[1]]
    }

    #[inline(always)]
    fn sizes(&self) -> Sizes {
        let mut sizes = Sizes { value: 0.0, first: 0.0, second: 0.0, slope: 0.0, slope_first: 0.0 };
        for (j, m) in self.values().iter().enumerate() {
            let (j, size) = (j as f64, norm(m));
            sizes.value += size;
            sizes.first += j * size;
            sizes.second += j * (j - 1.0) * size;
        }
        for (j, (m, n)) in self.slopes(0).iter().zip(self.slopes(1)).enumerate() {
            let size = norm(m) + norm(n);
            sizes.slope += size;
            sizes.slope_first += j as f64 * size;
        }
        sizes
    }

    /// Without the last terms that are far below what counts.
    #[inline(always)]
    fn trim(&mut self) {
        let mut dropped = 0.0;
        while self.lengths[0] > 1 {
            let size = norm(&self.values[self.lengths[0] - 1]);
            if dropped + size > LEAST {
                break;
            }
            dropped += size;
            self.lengths[0] -= 1;
            self.values[self.lengths[0]] = [0.0; 4];
        }
        let slope = |own: &Self, j: usize| norm(&own.slopes[0][j]) + norm(&own.slopes[1][j]);
        let least = LEAST_SLOPE * slope(self, 0);
        let mut left_out = 0.0;
        while self.lengths[1] > 1 {
            let size = slope(self, self.lengths[1] - 1);
            if left_out + size > least {
                break;
            }
            left_out += size;
            self.lengths[1] -= 1;
            self.slopes.iter_mut().for_each(|slopes| slopes[self.lengths[1]] = [0.0; 4]);
        }
        self.error = (self.error + dropped + left_out) * UP;
    }

    /// A bound on |V| + |F| + ε.
    pub fn size(&self) -> f64 {
        let sizes = self.sizes();
        (sizes.value + sizes.slope + self.error) * UP
    }

    /// V at t.
    pub fn at(&self, t: f64) -> Matrix {
        self.values().iter().rev().fold([0.0; 4], |sum, m| std::array::from_fn(|i| sum[i] * t + m[i]))
    }

    /// How far one of the steps moves it at t = 0.
    pub fn moved_by(&self, direction: usize) -> f64 {
        norm(&self.slopes[direction][0])
    }

    /// About the largest trace at t = 0 in the box; no proof rests on it.
    pub fn largest_trace(&self) -> f64 {
        let trace = |m: &Matrix| (m[0] + m[3]).abs();
        trace(&self.values[0]) + trace(&self.slopes[0][0]) + trace(&self.slopes[1][0]) + self.error
    }

    /// `self` after `earlier`.
    pub fn after(&self, earlier: &Self) -> Self {
        Instructions::best().perform_alone(Product(self, earlier))
    }

    /// On a part of its interval, of a share r = r₀ + r₁ u₁ + r₂ u₂ ± ε_r or 1 − r. For all u that count, 0 ≤ r ≤ 1.
    pub fn part(&self, cut: Cut, share: &Affine) -> Self {
        Instructions::best().perform_alone(Part(self, cut, share))
    }
}

#[inline(always)]
fn add_product(sum: &mut Matrix, [a, b, c, d]: &Matrix, [e, f, g, h]: &Matrix) {
    sum[0] = a.mul_add(*e, b.mul_add(*g, sum[0]));
    sum[1] = a.mul_add(*f, b.mul_add(*h, sum[1]));
    sum[2] = c.mul_add(*e, d.mul_add(*g, sum[2]));
    sum[3] = c.mul_add(*f, d.mul_add(*h, sum[3]));
}

struct Product<'a>(&'a Family, &'a Family);

impl Task for Product<'_> {
    type Output = Family;

    #[inline(always)]
    fn run(self) -> Family {
        let Product(later, earlier) = self;
        let (b, a) = (later.sizes(), earlier.sizes());
        let lengths = [
            (later.lengths[0] + earlier.lengths[0] - 1).min(VALUES),
            (later.lengths[0].max(later.lengths[1]) + earlier.lengths[0].max(earlier.lengths[1]) - 1)
                .min(SLOPES),
        ];
        let mut product =
            Family { values: [[0.0; 4]; VALUES], slopes: [[[0.0; 4]; SLOPES]; 2], lengths, error: 0.0 };
        let mut dropped = 0.0;
        let mut norms = [[0.0; VALUES]; 2];
        let mut slope_norms = [[0.0; SLOPES]; 2];
        for (n, family) in [later, earlier].into_iter().enumerate() {
            family.values().iter().zip(&mut norms[n]).for_each(|(m, size)| *size = norm(m));
            for direction in [0, 1] {
                let slopes = family.slopes(direction).iter().zip(&mut slope_norms[n]);
                slopes.for_each(|(m, size)| *size += norm(m));
            }
        }
        for (i, m) in later.values().iter().enumerate() {
            for (j, n) in earlier.values().iter().enumerate() {
                if i + j < VALUES {
                    add_product(&mut product.values[i + j], m, n);
                } else {
                    dropped += norms[0][i] * norms[1][j];
                }
            }
            for (j, (first, second)) in earlier.slopes(0).iter().zip(earlier.slopes(1)).enumerate() {
                if i + j < SLOPES {
                    add_product(&mut product.slopes[0][i + j], m, first);
                    add_product(&mut product.slopes[1][i + j], m, second);
                } else {
                    dropped += norms[0][i] * slope_norms[1][j];
                }
            }
        }
        for (i, (first, second)) in later.slopes(0).iter().zip(later.slopes(1)).enumerate() {
            for (j, n) in earlier.values().iter().enumerate() {
                if i + j < SLOPES {
                    add_product(&mut product.slopes[0][i + j], first, n);
                    add_product(&mut product.slopes[1][i + j], second, n);
                } else {
                    dropped += slope_norms[0][i] * norms[1][j];
                }
            }
        }
        let whole = [b.value + b.slope, a.value + a.slope];
        let carried = whole[0] * earlier.error + (whole[1] + earlier.error) * later.error;
        let rounding = ROUNDING * whole[0] * whole[1];
        product.error = (b.slope * a.slope + carried + dropped + rounding) * UP + FLOOR;
        product.trim();
        product
    }
}

struct Part<'a>(&'a Family, Cut, &'a Affine);

impl Part<'_> {
    /// The coefficients in t' of t = α + β t'.
    #[inline(always)]
    fn moved(terms: &mut [Matrix], alpha: f64, beta: f64) {
        for i in 0..terms.len() {
            for j in (i..terms.len() - 1).rev() {
                let next = terms[j + 1];
                for (entry, next) in terms[j].iter_mut().zip(next) {
                    *entry = alpha.mul_add(next, *entry);
                }
            }
        }
        let mut power = 1.0;
        for term in terms {
            term.iter_mut().for_each(|entry| *entry *= power);
            power *= beta;
        }
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
        let sizes = whole.sizes();
        // Where the center of the box is none of those u that count, t may leave [−1, 1] there, and powers of it grow.
        let beyond = (alpha.abs() + beta.abs()).max(1.0);
        let outside = (0..VALUES).fold(1.0, |power, _| power * beyond);
        let mut part = whole.clone();
        let [values, slopes] = whole.lengths;
        Self::moved(&mut part.values[..values], alpha, beta);
        Self::moved(&mut part.slopes[0][..slopes], alpha, beta);
        Self::moved(&mut part.slopes[1][..slopes], alpha, beta);
        let mut slope_norms = [0.0; SLOPES];
        for (j, size) in slope_norms[..slopes].iter_mut().enumerate() {
            *size = norm(&part.slopes[0][j]) + norm(&part.slopes[1][j]);
        }
        // V(t + Δ) = V(t) + V'(t) Δ + ..., Δ = (−1 ± t') (r₁ u₁ + r₂ u₂ + ...). In t' the derivative is V'(t) β.
        let mut derivative = [[0.0; 4]; VALUES];
        for j in 1..values {
            derivative[j - 1] = whole.values[j].map(|entry| entry * j as f64);
        }
        let length = (values - 1).max(1);
        Self::moved(&mut derivative[..length], alpha, beta);
        let mut dropped = 0.0;
        let both = share.slopes[0].abs() + share.slopes[1].abs();
        let mut along = |j: usize, m: &Matrix, sign: f64| {
            if j < SLOPES {
                for direction in [0, 1] {
                    let by = sign * share.slopes[direction];
                    let slope = &mut part.slopes[direction][j];
                    slope.iter_mut().zip(m).for_each(|(entry, x)| *entry = by.mul_add(*x, *entry));
                }
            } else {
                dropped += norm(m) * both;
            }
        };
        if values > 1 {
            for (j, m) in derivative[..length].iter().enumerate() {
                along(j, m, -1.0);
                along(j + 1, m, turn);
            }
            part.lengths[1] = slopes.max(values).min(SLOPES);
        }
        // Between t at the center and t at u: |t'| ≤ 1 + δ/β, in the coefficients of the part. What is left of the slopes is bounded
        // on the part, too.
        let move_by = 2.0 * share.reach() * UP;
        let stretch = 1.0 + move_by / beta.abs() * UP;
        let (mut power, mut first, mut second, mut slope_first) = (1.0f64, 0.0, 0.0, 0.0);
        for j in 1..values {
            // Powers of the stretch that are one too high: j − 1 for the first derivative.
            let rank = j as f64;
            let size = norm(&part.values[j]) * power;
            first += rank * size;
            second += rank * (rank - 1.0) * size;
            power *= stretch;
        }
        let mut power = 1.0;
        for (j, size) in slope_norms[..slopes].iter().enumerate().skip(1) {
            slope_first += j as f64 * size * power;
            power *= stretch;
        }
        let carried = (first * 2.0 * share.error + slope_first * move_by) / beta.abs()
            + 0.5 * second * move_by * move_by / (beta * beta);
        let rounding = ROUNDING
            * (sizes.value
                + sizes.first
                + sizes.slope
                + sizes.slope_first
                + 2.0 * both * (sizes.first + sizes.second))
            * outside;
        part.error = (whole.error + carried + rounding + dropped) * UP + FLOOR;
        part.trim();
        part
    }
}
