//! A vibration mode near κ, and what its Rayleigh quotient proves about the eigenvalue.
//!
//! **The vector.** Run the recurrence from both ends to the node r where the mode lives (see [`super::locate`]), and
//! join the two halves there: z_j = x_j/x_r on the left, y_j/y_r on the right, so z_r = 1. All equations
//!
//! ```text
//!     F_j - F_{j+1} - κ m_j z_j = 0,        F_j = (z_j - z_{j-1})/ℓ_j
//! ```
//!
//! hold but for the roundings of each step, which are known exactly (as the errors of sums and products), and the one
//! at r, where the two halves do not quite meet. With the residuals ρ_j the quotient is
//!
//! ```text
//!     μ = Σ F_j² ℓ_j/Σ m_j z_j² = κ + Σ z_j ρ_j/Σ m_j z_j²:
//! ```
//!
//! a tiny correction to κ, so it needs a few digits only, and no cancellation ever occurs but at r, where it is done in
//! sums of two doubles. Without the roundings it is Newton's step for the mismatch at r.
//!
//! **Theorem** (Weinstein; Temple, Kato). Let ε² = Σ ρ_j²/m_j/Σ m_j z_j². Some eigenvalue lies in \[μ − ε, μ + ε\]. If all
//! but the k-th are ≤ α or ≥ β with α < μ − ε and μ + ε < β, it is the k-th one, and
//!
//! ```text
//!     μ - ε²/(β - μ) <= κ_k <= μ + ε²/(μ - α).
//! ```
//!
//! **Roundings.** With x' = x + ℓ v' + e and v' = v − k x + f, k the rounded κ m = k − δ, a row's residual is
//! (f + δ x) + e/ℓ − e'/ℓ' (e, ℓ of the spring before, e', ℓ' of the one after), and Σ z ρ is Σ x (f + δ x) + Σ e F but
//! for the mismatch, by summation by parts. ε is computed from |f| + |δ x| + |e/ℓ| + |e'/ℓ'|, an upper bound that
//! does not cancel. By Cauchy's inequality Σ |terms of Σ z ρ| ≤ ε Σ m z² with that ε, so n rounded terms put μ off by at
//! most (n + 32) u ε, and n rounded masses, |μ − κ| being at most ε, by as much again.

use super::lanes::{LANES, Lanes, lanes, normalizing, range, two_products, two_sums};
use super::locate::{Problems, start};
use super::string::{BLOCK, HalfString, Kicks, Step};
use super::twofold::Twofold;
use crate::verdict::instructions::Task;

const U: f64 = f64::EPSILON / 2.0;

/// A Rayleigh quotient and its residual, both proven.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// μ, off by at most `error`.
    pub quotient: Twofold,
    pub error: f64,
    /// ε.
    pub residual: f64,
}

impl HalfString {
    /// Newton's step for each lane from κ, with the halves joined at the nodes `at`.
    pub fn newton(&self, problems: &Problems, at: &Lanes) -> Lanes {
        self.instructions.perform(Improving { string: self, problems, at })
    }

    /// The modes near κ, one for each lane.
    pub fn modes(&self, problems: &Problems, at: &Lanes) -> [Mode; LANES] {
        self.instructions.perform(Proving { string: self, problems, at })
    }
}

struct Improving<'a> {
    string: &'a HalfString,
    problems: &'a Problems,
    at: &'a Lanes,
}

impl Task for Improving<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn run(self) -> Lanes {
        let kappa = &self.problems.kappa;
        let [left, right] = halves::<false>(self.string, self.problems, self.at);
        let mass = lanes(|i| self.string.mass(self.at[i] as usize));
        lanes(|i| {
            let mismatch = left.v[i] / left.x[i] + right.v[i] / right.x[i] - kappa[i] * mass[i];
            let squares = |side: &Side| side.squares[i] / (side.x[i] * side.x[i]);
            kappa[i] + mismatch / (squares(&left) + squares(&right) + mass[i])
        })
    }
}

struct Proving<'a> {
    string: &'a HalfString,
    problems: &'a Problems,
    at: &'a Lanes,
}

impl Task for Proving<'_> {
    type Output = [Mode; LANES];

    #[inline(always)]
    fn run(self) -> [Mode; LANES] {
        let [left, right] = halves::<true>(self.string, self.problems, self.at);
        std::array::from_fn(|i| {
            let node = self.string.nodes[self.at[i] as usize];
            joined(self.string, node.kind, self.problems.kappa[i], [&left, &right].map(|side| side.at(i)))
        })
    }
}

/// The two halves, each on arrival at r.
#[inline(always)]
fn halves<const PROVE: bool>(string: &HalfString, problems: &Problems, at: &Lanes) -> [Side; 2] {
    let tables = Tables::new::<PROVE>(string, &problems.kappa);
    let mut left = Side::new(&problems.starts_free);
    left.follow::<PROVE>(string, &tables, &string.forward, at);
    let mut right = Side::new(&problems.ends_free);
    let n = string.last() as f64;
    right.follow::<PROVE>(string, &tables, &string.backward, &lanes(|i| n - at[i]));
    [left, right]
}

/// By kind of node: the kick k, and δ = k − κ m to within 2^-50 of itself and 2^-103 κ m.
struct Tables {
    kicks: Kicks,
    deltas: Kicks,
}

impl Tables {
    #[inline(always)]
    fn new<const PROVE: bool>(string: &HalfString, kappa: &Lanes) -> Self {
        let kicks = string.kicks(kappa);
        let mut deltas = [[0.0; LANES]; 8];
        if PROVE {
            for (kind, delta) in deltas.iter_mut().enumerate() {
                *delta = lanes(|i| delta_of(string, kind, kappa[i], kicks[kind][i]));
            }
        }
        Tables { kicks, deltas }
    }
}

#[inline(always)]
fn delta_of(string: &HalfString, kind: usize, kappa: f64, kick: f64) -> f64 {
    -(kappa.mul_add(string.masses[kind], -kick) + kappa * string.rests[kind])
}

/// One half on its way: the node's amplitude, the slope before it, and the sums over the nodes passed, in the scale
/// of x (squares: of x²).
struct Side {
    x: Lanes,
    v: Lanes,
    /// e/ℓ of the spring just passed.
    g: Lanes,
    /// Σ m x².
    squares: Lanes,
    /// Σ x (f + δ x) + Σ e F.
    work: Lanes,
    /// Σ (|f| + |δ x| + |e/ℓ| + |e'/ℓ'|)²/m.
    residual: Lanes,
}

impl Side {
    #[inline(always)]
    fn new(free: &[bool; LANES]) -> Self {
        let (x, v) = start(free);
        let zero = [0.0; LANES];
        Side { x, v, g: zero, squares: zero, work: zero, residual: zero }
    }

    /// The first `until` steps, in each lane its own number.
    #[inline(always)]
    fn follow<const PROVE: bool>(
        &mut self,
        string: &HalfString,
        tables: &Tables,
        steps: &[Step],
        until: &Lanes,
    ) {
        let (least, most) = range(until);
        for (block, steps) in steps[..most as usize].chunks(BLOCK).enumerate() {
            for (k, step) in steps.iter().enumerate() {
                let t = (block * BLOCK + k) as f64;
                let next = self.step::<PROVE>(string, tables, step);
                if t < least { *self = next } else { self.take(next, |i| t < until[i]) }
            }
            self.rescale::<PROVE>();
        }
    }

    /// The kick at a node and the drift to the next.
    #[inline(always)]
    fn step<const PROVE: bool>(&self, string: &HalfString, tables: &Tables, step: &Step) -> Side {
        let (x, kick, mass) = (&self.x, &tables.kicks[step.kind], string.masses[step.kind]);
        let squares = lanes(|i| mass.mul_add(x[i] * x[i], self.squares[i]));
        if !PROVE {
            let v = lanes(|i| (-kick[i]).mul_add(x[i], self.v[i]));
            let x = lanes(|i| step.length.mul_add(v[i], x[i]));
            return Side { x, v, squares, ..*self };
        }
        let (kicked, product_error) = two_products(kick, x);
        let (v, sum_error) = two_sums(&self.v, &lanes(|i| -kicked[i]));
        let f = lanes(|i| sum_error[i] - product_error[i]);
        let shift = lanes(|i| tables.deltas[step.kind][i] * x[i]);
        let (drift, product_error) = two_products(&[step.length; LANES], &v);
        let (next, sum_error) = two_sums(x, &drift);
        let e = lanes(|i| -(product_error[i] + sum_error[i]));
        let g = lanes(|i| e[i] * step.inverse);
        let work = lanes(|i| x[i].mul_add(f[i] + shift[i], self.work[i]));
        let work = lanes(|i| e[i].mul_add(v[i] + g[i], work[i]));
        let row = lanes(|i| (f[i].abs() + shift[i].abs()) + (self.g[i].abs() + g[i].abs()));
        let weight = string.inverse_masses[step.kind];
        let residual = lanes(|i| (row[i] * weight).mul_add(row[i], self.residual[i]));
        Side { x: next, v, g, squares, work, residual }
    }

    /// Takes the next state where the lane still goes.
    #[inline(always)]
    fn take(&mut self, next: Side, goes: impl Fn(usize) -> bool) {
        let pick = |new: &Lanes, old: &Lanes| lanes(|i| if goes(i) { new[i] } else { old[i] });
        *self = Side {
            x: pick(&next.x, &self.x),
            v: pick(&next.v, &self.v),
            g: pick(&next.g, &self.g),
            squares: pick(&next.squares, &self.squares),
            work: pick(&next.work, &self.work),
            residual: pick(&next.residual, &self.residual),
        };
    }

    #[inline(always)]
    fn rescale<const PROVE: bool>(&mut self) {
        let factor = normalizing(&self.x, &self.v);
        let once = |x: &Lanes| lanes(|i| x[i] * factor[i]);
        let twice = |x: &Lanes| lanes(|i| x[i] * factor[i] * factor[i]);
        let (x, v, squares) = (once(&self.x), once(&self.v), twice(&self.squares));
        *self = if PROVE {
            let (work, residual) = (twice(&self.work), twice(&self.residual));
            Side { x, v, g: once(&self.g), squares, work, residual }
        } else {
            Side { x, v, squares, ..*self }
        };
    }

    /// One lane, scaled to x = 1.
    #[inline(always)]
    fn at(&self, i: usize) -> Arrival {
        let x = self.x[i];
        let force = self.v[i] / x;
        // The quotient's remainder is a double.
        let rest = (-force).mul_add(x, self.v[i]) / x;
        let square = 1.0 / (x * x);
        Arrival {
            force: (force, rest),
            g: (self.g[i] / x).abs(),
            squares: self.squares[i] * square,
            work: self.work[i] * square,
            residual: self.residual[i] * square,
        }
    }
}

/// A half on arrival at r, scaled to z_r = 1.
struct Arrival {
    force: (f64, f64),
    g: f64,
    squares: f64,
    work: f64,
    residual: f64,
}

/// The quotient of the two halves joined.
#[inline(always)]
fn joined(string: &HalfString, kind: usize, kappa: f64, [left, right]: [Arrival; 2]) -> Mode {
    let (mass, kick) = (string.masses[kind], kappa * string.masses[kind]);
    let (force, first) = two_sum(left.force.0, right.force.0);
    let (most, second) = two_sum(force, -kick);
    let rest = left.force.1 + right.force.1 + delta_of(string, kind, kappa, kick);
    let mismatch = most + (first + second + rest);
    let squares = left.squares + right.squares + mass;
    let correction = (left.work + right.work + mismatch) / squares;
    let row = mismatch.abs() + left.g + right.g;
    let residual = left.residual + right.residual + row * row * string.inverse_masses[kind];
    let residual = (1.01 * residual / squares).sqrt();
    // The mismatch is off by 2^-100 of its three terms; underflows are covered by 2^-100 κ.
    let terms = (left.force.0.abs() + right.force.0.abs() + kick) / squares + kappa;
    let error = 1.01 * (2.0 * (string.nodes.len() as f64 + 64.0) * U * residual + 2f64.powi(-100) * terms);
    // A mode not worth the name proves nothing.
    let residual = if residual.is_finite() && error.is_finite() { residual } else { f64::INFINITY };
    Mode { quotient: Twofold::sum(kappa, correction), error, residual }
}

/// As [`two_sums`].
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}
