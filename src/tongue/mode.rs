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
//! sums of two doubles. Without the roundings it is Newton's step for the mismatch at r. Steps before that use the
//! point before, too: κ is a smooth function of the mismatch, and two values with slopes give a cubic for it.
//!
//! **Theorem** (Weinstein; Temple, Kato). Let ε² = Σ ρ_j²/m_j/Σ m_j z_j². Some eigenvalue lies in \[μ − ε, μ + ε\]. If all
//! but the k-th are ≤ α or ≥ β with α < μ − ε and μ + ε < β, it is the k-th one, and
//!
//! ```text
//!     μ - ε²/(β - μ) <= κ_k <= μ + ε²/(μ - α).
//! ```
//!
//! **Roundings** of the quotient: see [`super::half`]. By Cauchy's inequality Σ |terms of Σ z ρ| ≤ ε Σ m z² with the ε that
//! is computed there, so n rounded terms put μ off by at most (n + 32) u ε; and n rounded masses, |μ − κ| being at most ε,
//! by as much again.

use super::half::{Arrival, deltas, halves};
use super::lanes::{LANES, Lanes, lanes, largest, lesser, two_products, two_sums};
use super::locate::Problems;
use super::string::HalfString;
use crate::number::U;
use crate::verdict::instructions::Task;

/// 2^-96.
const SLACK: f64 = f64::from_bits((1023 - 96) << 52);

/// Steps at most: as a rule three are enough.
const PASSES: u32 = 7;

/// A step shorter than this part of the distance to the neighbours is the last: what is left is about its square, in
/// units of the distance. So is one whose product with the step before is: what is left is about the product's square.
const CLOSE: f64 = 1e-4;

/// What bounds the search in each lane: the part of the bracket where the eigenvalue is, and bounds α, β of its
/// neighbours.
pub(super) struct Bounds {
    pub inner: [Lanes; 2],
    pub others: [Lanes; 2],
}

/// Modes and what they prove.
pub(super) struct Proofs {
    /// The eigenvalue's enclosure, times the ticks: an edge in s.
    pub edge: [Lanes; 2],
    /// The enclosure's radius before it is rounded to doubles, in units of μ; infinite where nothing is proven.
    pub radius: Lanes,
    /// μ, rounded.
    pub quotient: Lanes,
}

impl HalfString {
    /// Steps towards the zero from κ within the bounds, with the halves joined at the nodes `at`, and the modes where it ends.
    pub fn prove(&self, problems: &Problems, bounds: &Bounds, at: &Lanes) -> Proofs {
        self.instructions.perform(Proving { string: self, problems, bounds, at })
    }
}

struct Proving<'a> {
    string: &'a HalfString,
    problems: &'a Problems,
    bounds: &'a Bounds,
    at: &'a Lanes,
}

impl Task for Proving<'_> {
    type Output = Proofs;

    #[inline(always)]
    fn run(self) -> Proofs {
        let mut problems = *self.problems;
        let mass = lanes(|i| self.string.mass(self.at[i] as usize));
        let mut before = Point { kappa: problems.kappa, mismatch: [0.0; LANES], slope: [0.0; LANES] };
        // The step before: the first is plain Newton's, as long as a neighbour is far.
        let mut last = [f64::INFINITY; LANES];
        for _ in 0..PASSES {
            let point = Point::new(self.string, &problems, self.at, &mass);
            let next = point.zero(&before);
            let inside = self.within(&self.bounds.inner, &next);
            let distance = self.within(&self.bounds.others, &next);
            let step = lanes(|i| (next[i] - problems.kappa[i]).abs());
            problems.kappa = lanes(|i| if inside[i] > 0.0 { next[i] } else { problems.kappa[i] });
            // By how much the step, and its product with the step before, are too long.
            let reach = lanes(|i| CLOSE * distance[i]);
            let excess = lanes(|i| step[i] - reach[i]);
            let excess = lanes(|i| lesser(excess[i], step[i] * last[i] - reach[i] * distance[i]));
            let far = lanes(|i| if inside[i] > 0.0 { excess[i] } else { 0.0 });
            if largest(&far) <= 0.0 {
                break;
            }
            (before, last) = (point, step);
        }
        let [left, right] = halves::<true>(self.string, &problems, self.at);
        joined(self.string, &problems.kappa, self.at, [left.arrival(), right.arrival()])
            .prove(self.string, self.bounds)
    }
}

impl Proving<'_> {
    /// The distance to the nearer end: positive inside.
    #[inline(always)]
    fn within(&self, [lo, hi]: &[Lanes; 2], x: &Lanes) -> Lanes {
        lanes(|i| lesser(x[i] - lo[i], hi[i] - x[i]))
    }
}

/// The mismatch at r as a function of κ: its value, and −dκ of a unit of it, 1/Σ m z².
#[derive(Clone, Copy)]
struct Point {
    kappa: Lanes,
    mismatch: Lanes,
    slope: Lanes,
}

impl Point {
    #[inline(always)]
    fn new(string: &HalfString, problems: &Problems, at: &Lanes, mass: &Lanes) -> Self {
        let [left, right] = halves::<false>(string, problems, at);
        let kappa = problems.kappa;
        let own = lanes(|i| kappa[i] * mass[i]);
        let ((f, a), (g, b)) = (left.force_and_squares(), right.force_and_squares());
        let mismatch = lanes(|i| f[i] + g[i] - own[i]);
        let slope = lanes(|i| 1.0 / (a[i] + b[i] + mass[i]));
        Point { kappa, mismatch, slope }
    }

    /// Where the mismatch vanishes: by the cubic for κ as a function of it, through this point and the one before with
    /// the slopes; by Newton's step where that is no improvement of it, or there is no point before.
    #[inline(always)]
    fn zero(&self, before: &Point) -> Lanes {
        lanes(|i| {
            let (y, z) = (self.mismatch[i], before.mismatch[i]);
            let newton = y * self.slope[i];
            let inverse = 1.0 / (y - z);
            let chord = (self.kappa[i] - before.kappa[i]) * inverse;
            let [here, there] = [(-self.slope[i] - chord) * inverse, (chord + before.slope[i]) * inverse];
            let bend = y * y * (here - (here - there) * inverse * z);
            // No comparison holds for NaN.
            let bend = if bend.abs() < 0.5 * newton.abs() { bend } else { 0.0 };
            self.kappa[i] + (newton + bend)
        })
    }
}

/// The quotient of the two halves joined at the nodes `at`.
#[inline(always)]
fn joined(string: &HalfString, kappa: &Lanes, at: &Lanes, [left, right]: [Arrival; 2]) -> Modes {
    let table = |numbers: &[f64; 8]| lanes(|i| numbers[string.nodes[at[i] as usize].kind]);
    let (mass, lost, weight) = (table(&string.masses), table(&string.rests), table(&string.inverse_masses));
    let kick = lanes(|i| kappa[i] * mass[i]);
    let delta = deltas(kappa, &mass, &lost, &kick);
    let (force, first) = two_sums(&left.force, &right.force);
    let (most, second) = two_sums(&force, &lanes(|i| -kick[i]));
    let rest = lanes(|i| left.rest[i] + right.rest[i] + delta[i]);
    let mismatch = lanes(|i| most[i] + (first[i] + second[i] + rest[i]));
    let squares = lanes(|i| left.squares[i] + right.squares[i] + mass[i]);
    let correction = lanes(|i| (left.work[i] + right.work[i] + mismatch[i]) / squares[i]);
    let row = lanes(|i| mismatch[i].abs() + left.g[i] + right.g[i]);
    let residual = lanes(|i| left.residual[i] + right.residual[i] + row[i] * row[i] * weight[i]);
    let residual = lanes(|i| (1.01 * residual[i] / squares[i]).sqrt());
    // The mismatch is off by less than 2^-96 of its three terms; underflows are covered by 2^-96 κ.
    let terms = lanes(|i| (left.force[i].abs() + right.force[i].abs() + kick[i]) / squares[i] + kappa[i]);
    let rounded = 2.0 * (string.nodes.len() as f64 + 64.0) * U;
    let error = lanes(|i| 1.01 * (rounded * residual[i] + SLACK * terms[i]));
    let (hi, lo) = two_sums(kappa, &correction);
    Modes { hi, lo, error, residual }
}

/// Rayleigh quotients and their residuals.
struct Modes {
    /// μ = hi + lo, off by at most `error`.
    hi: Lanes,
    lo: Lanes,
    error: Lanes,
    /// ε.
    residual: Lanes,
}

impl Modes {
    /// The module's theorem.
    #[inline(always)]
    fn prove(&self, string: &HalfString, bounds: &Bounds) -> Proofs {
        let mu = &self.hi;
        // What the quotient's own uncertainty takes from the distances.
        let own = lanes(|i| 2.0 * (self.error[i] + f64::EPSILON * mu[i]));
        let down = lanes(|i| mu[i] - own[i] - bounds.others[0][i]);
        let up = lanes(|i| bounds.others[1][i] - own[i] - mu[i]);
        let least = lanes(|i| lesser(down[i], up[i]));
        let radius = lanes(|i| 1.01 * (self.residual[i] * (self.residual[i] / least[i]) + self.error[i]));
        // NaN proves nothing.
        let proven = lanes(|i| if self.residual[i] < least[i] { radius[i] / mu[i] } else { f64::INFINITY });
        Proofs { edge: self.rounded(string.ticks, &radius), radius: proven, quotient: *mu }
    }

    /// The doubles around [μ − radius, μ + radius] · ticks. What follows rounds by less than 10 u², a hundredth of the
    /// least radius.
    #[inline(always)]
    fn rounded(&self, ticks: f64, radius: &Lanes) -> [Lanes; 2] {
        let (product, rest) = two_products(&self.hi, &[ticks; LANES]);
        let rest = lanes(|i| ticks.mul_add(self.lo[i], rest[i]));
        let (nearest, rest) = two_sums(&product, &rest);
        let radius = lanes(|i| 1.02 * ticks * radius[i]);
        let (lo, below) = two_sums(&nearest, &lanes(|i| rest[i] - radius[i]));
        let (hi, above) = two_sums(&nearest, &lanes(|i| rest[i] + radius[i]));
        [
            lanes(|i| if below[i] < 0.0 { lo[i].next_down() } else { lo[i] }),
            lanes(|i| if above[i] > 0.0 { hi[i].next_up() } else { hi[i] }),
        ]
    }
}
