//! A 2 × 2 matrix as a function on an interval: Taylor coefficients and a bound on all that they lack.
//!
//! M(t) = 2^e (Σ M_j t^j + E(t)), −1 ≤ t ≤ 1, |E(t)| ≤ ε in the spectral norm. With |M| the largest norm of Σ
//! M_j t^j the product has
//!
//! ```text
//!     ε_{BA} = |B| ε_A + |A| ε_B + ε_A ε_B + Σ_{i + j ≥ n} |B_i| |A_j| + rounding.
//! ```
//!
//! *The largest norm*: that of [[a, b], [c, d]] is (|z| + |w|)/2 with z = a + d + i (b − c), w = a − d + i
//! (b + c). With
//! |z(t)|² = Σ r_k t^k, r_k = Σ Re z_i z̄_j over i + j = k, it is at most r_0 + Σ |r_k|. Where M(t) turns by an angle that varies with
//! t, all r_k but r_0 vanish, and the bound is 1, while Σ |M_j| grows like an exponential of the angle's
//! range. So errors of turns add up and are not multiplied.
//!
//! *Rounding*, u the unit of the numbers, in the norm of Frobenius, which is at most √2 times the spectral
//! one. An entry of B_i A_j passes through at most 2 (i + j) + 3 operations on its way into the coefficient
//! i + j, so the product's is at most 2 u Σ (2 i + 2 j + 4) |B_i| |A_j|, the room left covering u² terms. For
//! a part of the interval, t = α + β t' with
//! |α| + |β| ≤ 1, the coefficient M_j passes through j + 1 sums at most and through products with α and β, j of them, each
//! within 3 u: √2 u Σ (6 j + 6) |M_j|. The bounds themselves are computed in doubles: [`UP`] covers their
//! roundings, and [`FLOOR`] what is lost where numbers underflow.

use super::coefficient::{Coefficient, near_ball};
use super::enclosure::Enclosure;
use super::turn::{Turn, angle, direction, principal};
use number::{Ball, power_of_two};

/// Some hundreds of roundings of positive numbers.
pub const UP: f64 = 1.0 + 1e-12;

/// More than any number of underflows, of squares too, adds to a function whose largest entry is near 1.
pub const FLOOR: f64 = 1e-150;

/// Room for the terms of a function of doubles, and of any function.
pub const FEW: usize = 16;
pub const MOST: usize = 48;

/// The sharper norm bound is skipped where the sum of all norms is at most this times the first.
const SHARPER_FROM: f64 = 1.01;

/// [[a, b], [c, d]] in a row.
pub type Entries<T> = [T; 4];

#[derive(Clone)]
pub struct Map<T> {
    /// [`Coefficient::TERMS`] of them at most.
    terms: Vec<Entries<T>>,
    /// No Σ M_j t^j has a larger norm.
    norm: f64,
    /// ε.
    error: f64,
    /// e.
    pub exponent: i128,
    /// The turn of (1, 0) at t = 0.
    pub turn: Option<Turn>,
    /// Last terms that are smaller than this, relatively, are left out of what is made of it.
    pub least: f64,
}

/// z and w of a matrix, real and imaginary parts: its spectral norm is (|z| + |w|)/2.
#[inline(always)]
fn parts<T: Coefficient>(m: &Entries<T>) -> [f64; 4] {
    let [a, b, c, d] = m.each_ref().map(T::near);
    [a + d, b - c, a - d, b + c]
}

/// The spectral norm of a matrix: (|(a + d, b − c)| + |(a − d, b + c)|)/2.
#[inline(always)]
pub fn norm<T: Coefficient>(m: &Entries<T>) -> f64 {
    let [x, y, u, v] = parts(m);
    0.5 * (length(x, y) + length(u, v)) * UP
}

/// At least the spectral norm, and at most 1.09 times as much: |(x, y)| ≤ max + (√2 − 1) min, without a root.
#[inline(always)]
pub fn about<T: Coefficient>(m: &Entries<T>) -> f64 {
    let [x, y, u, v] = parts(m).map(f64::abs);
    let length = |x: f64, y: f64| if x > y { x + 0.4143 * y } else { y + 0.4143 * x };
    0.5 * (length(x, y) + length(u, v)) * UP
}

/// |M_j|, about, and zeros beyond the last term.
#[inline(always)]
pub fn sizes<T: Coefficient, const N: usize>(terms: &[Entries<T>]) -> [f64; N] {
    let mut sizes = [0.0; N];
    for (value, term) in sizes.iter_mut().zip(terms) {
        *value = about(term);
    }
    sizes
}

/// A bound of the norm of Σ M_j t^j on [−1, 1]; `known` is such a bound already, or infinite.
#[inline(always)]
fn largest<T: Coefficient, const N: usize>(terms: &[Entries<T>], known: f64) -> f64 {
    let first = norm(&terms[0]);
    if known <= SHARPER_FROM * first {
        return known;
    }
    let mut sum = first;
    for term in &terms[1..] {
        sum += about(term);
    }
    sum *= UP;
    if sum <= SHARPER_FROM * first {
        return known.min(sum);
    }
    // r_k of z and of w, and those of their imaginary parts: in two lanes each.
    let mut values = [[0.0; 4]; N];
    for (values, term) in values.iter_mut().zip(terms) {
        *values = parts(term);
    }
    let n = terms.len().min(N);
    let mut squares = [0.0; 2];
    for k in 0..2 * n - 1 {
        let mut r = [0.0; 4];
        for i in (k + 1).saturating_sub(n)..k.div_ceil(2) {
            r = std::array::from_fn(|lane| r[lane] + values[i][lane] * values[k - i][lane]);
        }
        r = r.map(|r| 2.0 * r);
        if k % 2 == 0 {
            r = std::array::from_fn(|lane| r[lane] + values[k / 2][lane] * values[k / 2][lane]);
        }
        squares = [squares[0] + (r[0] + r[1]).abs(), squares[1] + (r[2] + r[3]).abs()];
    }
    // Entries are known to 2^-50; that, and what some hundreds of roundings do to all r_k together.
    let slack = 8e-13 * sum * sum;
    let [z, w] = squares.map(|square| (square + slack).sqrt());
    known.min(0.5 * (z + w) * UP)
}

/// [`largest`], with the room that a function of these numbers needs.
#[inline(always)]
fn largest_of<T: Coefficient>(terms: &[Entries<T>], known: f64) -> f64 {
    const { assert!(T::TERMS <= MOST) };
    if T::TERMS <= FEW { largest::<T, FEW>(terms, known) } else { largest::<T, MOST>(terms, known) }
}

/// |(x, y)|, but for what underflows.
#[inline(always)]
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// The image of (1, 0).
#[inline(always)]
pub fn image<T: Coefficient>(m: &Entries<T>) -> [f64; 2] {
    [m[0].near(), m[2].near()]
}

impl<T: Coefficient> Map<T> {
    /// From enclosures.
    pub fn new<E: Enclosure>(terms: &[Entries<E>], turn: Option<Turn>) -> Self {
        Map { turn, ..Map::enclosing(terms, E::near) }
    }

    /// From balls, without a turn.
    pub fn of_balls(terms: &[Entries<Ball>]) -> Self {
        Map::enclosing(terms, near_ball)
    }

    fn enclosing<E>(terms: &[Entries<E>], near: impl Fn(&E) -> (T, f64)) -> Self {
        let mut error = FLOOR;
        let mut taken = |enclosure: &E| {
            let (near, lost) = near(enclosure);
            error += lost;
            near
        };
        let terms: Vec<_> = terms.iter().map(|m| m.each_ref().map(&mut taken)).collect();
        Map::bounded(terms, error * UP, f64::INFINITY, 0)
    }

    /// The identity.
    pub fn identity() -> Self {
        let [zero, one] = [0.0, 1.0].map(T::of);
        Map { turn: Some(Turn::NONE), ..Map::of(vec![[one, zero, zero, one]]) }
    }

    /// Numbers as they are, without a turn.
    pub fn of(terms: Vec<Entries<T>>) -> Self {
        Map::kept(terms, 0.0, f64::INFINITY, 0)
    }

    /// Without a turn; the terms that are too many go to the error. No value of the terms kept exceeds
    /// `known` in norm.
    #[inline(always)]
    fn kept(mut terms: Vec<Entries<T>>, mut error: f64, known: f64, exponent: i128) -> Self {
        if terms.len() > T::TERMS {
            error = (error + terms.drain(T::TERMS..).map(|term| norm(&term)).sum::<f64>()) * UP;
        }
        Map { norm: largest_of(&terms, known), terms, error, exponent, turn: None, least: 0.25 * T::UNIT }
    }

    /// Without a turn, balanced; the error is ∞ where the exponent overflows.
    #[inline(always)]
    pub fn bounded(terms: Vec<Entries<T>>, error: f64, known: f64, exponent: i128) -> Self {
        let error = if exponent.unsigned_abs() > 1 << 125 { f64::INFINITY } else { error };
        let mut map = Map::kept(terms, error, known, exponent);
        map.balance();
        map
    }

    /// The coefficients, without the power of two.
    pub fn terms(&self) -> &[Entries<T>] {
        &self.terms
    }

    /// ε.
    #[inline(always)]
    pub fn bound(&self) -> f64 {
        self.error
    }

    /// A bound of the norm of Σ M_j t^j.
    #[inline(always)]
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// 2^e ε.
    pub fn error(&self) -> f64 {
        self.error * near_power(self.exponent)
    }

    /// ε over the norm of the middle.
    pub fn relative_error(&self) -> f64 {
        self.error / norm(&self.terms[0])
    }

    /// A bound of the norm of all values, with the power of two.
    pub fn size(&self) -> f64 {
        (self.norm + self.error) * near_power(self.exponent) * UP
    }

    /// Known within `error` beside what it is known by, without the power of two.
    pub fn known_within(mut self, error: f64) -> Self {
        self.error = (self.error + error) * UP + FLOOR;
        self
    }

    /// This matrix function with its remainder enlarged by `by` times its size.
    pub fn widened(mut self, by: f64) -> Self {
        self.error = (self.error + by * (self.norm + self.error)) * UP + FLOOR;
        self
    }

    /// Without the last terms that are far below the rounding of the first.
    pub fn trimmed(mut self) -> Self {
        let least = 1e-3 * T::UNIT * norm(&self.terms[0]);
        while self.terms.len() > 1 && norm(&self.terms[self.terms.len() - 1]) < least {
            let lost = self.terms.pop().map_or(0.0, |term| norm(&term));
            self.error = (self.error + lost) * UP;
            self.norm = (self.norm + lost) * UP;
        }
        self
    }

    /// In other numbers, each within two of their units.
    pub fn rounded<P: Coefficient>(&self) -> Map<P> {
        let (kept, dropped) = self.terms.split_at(self.terms.len().min(P::TERMS));
        let size = |terms: &[Entries<T>]| terms.iter().map(norm).sum::<f64>();
        let error = (self.error + size(dropped) + 3.0 * P::UNIT * size(kept)) * UP + FLOOR;
        let terms: Vec<_> = kept.iter().map(|m| m.each_ref().map(T::to)).collect();
        let least = self.least.max(0.25 * P::UNIT);
        Map { turn: self.turn, least, ..Map::kept(terms, error, f64::INFINITY, self.exponent) }
    }

    pub fn negative(mut self) -> Self {
        self.terms.iter_mut().flatten().for_each(|x| *x = x.negative());
        self
    }

    /// The sum of both, on the same interval; a sum has no turn.
    pub fn plus(&self, other: &Self) -> Self {
        let exponent = self.exponent.max(other.exponent);
        let scaled = |map: &Self| {
            let k = (map.exponent - exponent).max(-2000) as i32;
            let terms = map.terms.iter().map(|m| m.each_ref().map(|x| x.scale2(k))).collect::<Vec<_>>();
            (terms, map.error * power_of_two(k))
        };
        let ((mut terms, one), (others, two)) = (scaled(self), scaled(other));
        let size = |terms: &[Entries<T>]| terms.iter().map(norm).sum::<f64>();
        let rounding = 1.42 * T::UNIT * (size(&terms) + size(&others));
        let zero = || std::array::from_fn(|_| T::zero());
        terms.resize_with(terms.len().max(others.len()), zero);
        terms.iter_mut().flatten().zip(others.iter().flatten()).for_each(|(x, y)| *x = x.plus(y));
        let error = (one + two + rounding) * UP + FLOOR;
        Map::kept(terms, error, f64::INFINITY, exponent)
    }

    /// Whether the bound still leaves something.
    pub fn is_useful(&self) -> bool {
        self.error < 0.1 * about(&self.terms[0])
    }

    #[inline(always)]
    pub fn turn_after(&self, earlier: &Self, product: &Self) -> Option<Turn> {
        let (first, then) = (earlier.turn?, self.turn?);
        self.direction()?;
        first.then(then, product.direction()?)
    }

    /// The direction of the image of (1, 0) at t = 0, where it is known.
    #[inline(always)]
    pub fn direction(&self) -> Option<f64> {
        direction(image(&self.terms[0]), self.error)
    }

    /// With the coefficients on a part, but for the turn; Σ |M_j| and Σ j |M_j|, and what numbers that are
    /// shorter than these lose.
    #[inline(always)]
    pub fn moved(&self, mut terms: Vec<Entries<T>>, [sum, rank]: [f64; 2], lost: f64) -> Self {
        let rounding = 1.42 * T::UNIT * 6.0 * (sum + rank) + lost;
        let (mut dropped, least) = (0.0, self.least * about(&terms[0]));
        while let [_, .., last] = &terms[..]
            && dropped + about(last) < least
        {
            dropped += about(last);
            terms.pop();
        }
        let error = (self.error + rounding + dropped) * UP + FLOOR;
        let known = (self.norm + rounding + dropped) * UP;
        Map { least: self.least, ..Map::bounded(terms, error, known, self.exponent) }
    }

    /// The turn, followed along t from 0 to α, where the image's direction is `towards`, in so small steps
    /// that it changes by less than a right angle in each.
    #[inline(always)]
    pub fn turn_moved(&self, alpha: f64, towards: Option<f64>) -> Option<Turn> {
        let mut turn = self.turn?;
        let at = |t: f64| {
            let [mut x, mut y] = [0.0; 2];
            for term in self.terms.iter().rev() {
                let [a, b] = image(term);
                [x, y] = [x * t + a, y * t + b];
            }
            [x, y]
        };
        // |images|, and |d/dt of the image|, at most; what doubles round is far below the half that is left.
        let (mut sum, mut slope) = (0.0, 0.0);
        for (term, j) in self.terms.iter().zip(0u32..) {
            let [x, y] = image(term).map(f64::abs);
            (sum, slope) = (sum + x + y, slope + f64::from(j) * (x + y));
        }
        for steps in [1u32, 8, 64] {
            let change = slope * alpha.abs() / f64::from(steps);
            let moved = (0..steps).try_fold(turn, |turn, k| {
                let [x, y] = at(alpha * f64::from(k) / f64::from(steps));
                (length(x, y) > 2.0 * (change + self.error) + 1e-12 * sum).then_some(())?;
                let [x, y] = at(alpha * f64::from(k + 1) / f64::from(steps));
                let angle = angle([x, y]);
                Some(turn.on(principal(angle - turn.angle), angle))
            });
            if let Some(moved) = moved {
                turn = moved;
                let angle = towards?;
                return Some(turn.on(principal(angle - turn.angle), angle));
            }
        }
        None
    }

    /// Keeps the constant term's norm near 1; exact.
    #[inline(always)]
    fn balance(&mut self) {
        let size = about(&self.terms[0]);
        if !(1.0 / 16.0..=16.0).contains(&size) && size > 1e-200 && size < 1e200 {
            let k = -size.log2().round() as i32;
            self.terms.iter_mut().flatten().for_each(|x| *x = x.scale2(k));
            self.norm *= power_of_two(k);
            self.error = self.error * power_of_two(k) * UP + FLOOR;
            self.exponent -= i128::from(k);
        }
    }

    /// The entries at t = 0 without the power of two.
    pub fn enclosures<E: Enclosure>(&self, bits: u32) -> Entries<E> {
        self.terms[0].each_ref().map(|x| E::within(x, self.error, bits))
    }
}

/// 2^e as far as doubles reach.
fn near_power(e: i128) -> f64 {
    power_of_two(e.clamp(-2000, 2000) as i32)
}

/// Σ m_j and Σ j m_j.
#[inline(always)]
pub fn sums(sizes: &[f64]) -> [f64; 2] {
    let (mut sum, mut rank) = (0.0, 0.0);
    for (m, j) in sizes.iter().zip(0u32..) {
        (sum, rank) = (sum + m, rank + f64::from(j) * m);
    }
    [sum, rank]
}
