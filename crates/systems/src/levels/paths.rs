//! A second route to the first region and to growth: the action of the half period as one matrix over the
//! paths, and the full period kick by kick. No eigenvector of the fast stiffness enters, so it can be held
//! against the kernel.

use faer::{Mat, Scale};

use super::rigid::Hessians;
use crate::half::norm;
use crate::signs::inertia::{is_definite, proven};
use number::U;

/// The most rows of an action: its eigenvalues take seconds from there on.
const MOST_ROWS: usize = 1200;

/// The factors of both stiffnesses, and bounds (2-norm) on their errors.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    pub factors: [f64; 2],
    pub off: [f64; 2],
}

impl Near {
    /// The matrices themselves.
    pub const EXACTLY: Near = Near { factors: [1.0; 2], off: [0.0; 2] };
}

impl Hessians {
    /// Nodes of a half period of p inner steps behind the first: the last drift is half a step where p is
    /// odd.
    fn nodes(inner_steps: u64) -> usize {
        inner_steps.div_ceil(2) as usize
    }

    /// Whether an action of this many inner steps is small enough to be factorized.
    pub fn has_paths(&self, inner_steps: u64) -> bool {
        self.size().saturating_mul(Hessians::nodes(inner_steps)) <= MOST_ROWS
    }

    /// The products that [`Hessians::growth_of_period`] costs, about: two matrices a step, and eigenvalues of
    /// twice the size.
    pub fn cost_of_period(&self, inner_steps: u64) -> u64 {
        let cubes = inner_steps.saturating_mul(2).saturating_add(100);
        (self.size() as u64).saturating_pow(3).saturating_mul(cubes)
    }

    /// About the products that a scheme's actions take: ten matrices, each reduced or factorized.
    pub fn cost_of_paths(&self, inner_steps: u64) -> u64 {
        let rows = (self.size() as u64).saturating_mul(Hessians::nodes(inner_steps) as u64);
        rows.saturating_pow(3).saturating_mul(20)
    }

    /// J of `proofs/REGION.md`, section 1, in the time unit h, over x_0 … x_(N−1) (x_N = 0) or x_1 … x_N
    /// (x_0 = 0), and how far it may be off.
    fn action(&self, step: f64, inner_steps: u64, start_held: bool, near: Near) -> (Mat<f64>, f64) {
        let (n, last) = (self.size(), Hessians::nodes(inner_steps));
        let is_odd = !inner_steps.is_multiple_of(2);
        let square = (step / inner_steps as f64).powi(2);
        // A full fast kick, half a slow one.
        let [fast, slow] = [square * near.factors[0], square * near.factors[1] * inner_steps as f64 / 2.0];
        let spring = |j: usize| if is_odd && j == last { 2.0 } else { 1.0 };
        let weight = |node: usize| match node {
            0 => 0.5,
            node if node == last => {
                if is_odd {
                    0.0
                } else {
                    0.5
                }
            }
            _ => 1.0,
        };
        let first = usize::from(start_held);
        let entry = |i: usize, j: usize| {
            let (a, b, k, l) = (i / n + first, j / n + first, i % n, j % n);
            let same = f64::from(u8::from(k == l));
            if a.abs_diff(b) == 1 {
                return -spring(a.max(b)) * same;
            } else if a != b {
                return 0.0;
            }
            let left = if a > 0 { spring(a) } else { 0.0 };
            let right = if a < last { spring(a + 1) } else { 0.0 };
            let kick =
                weight(a) * fast * self.fast[(k, l)] + if a == 0 { slow * self.slow[(k, l)] } else { 0.0 };
            (left + right) * same - kick
        };
        let off = |level: usize, kick: f64| {
            let size = norm::frobenius(if level == 0 { &self.fast } else { &self.slow });
            kick * (self.errors[level] + near.off[level] / near.factors[level] + 8.0 * U * size)
        };
        (Mat::from_fn(n * last, n * last, entry), 1.01 * (off(0, fast) + off(1, slow)) + 16.0 * U)
    }

    /// Whether the action proves that all such matrices are stable at an outer step of p inner ones and at
    /// every smaller one.
    pub fn paths_prove_stable(&self, step: f64, inner_steps: u64, near: Near) -> bool {
        let [fast, slow] = near.factors;
        let total = &self.fast * Scale(fast) + &self.slow * Scale(slow);
        let off = |level: usize, matrix: &Mat<f64>| {
            near.factors[level] * (self.errors[level] + 4.0 * U * norm::frobenius(matrix)) + near.off[level]
        };
        let slack = 1.01 * (off(0, &self.fast) + off(1, &self.slow));
        is_definite(total, slack)
            && [false, true].into_iter().all(|start_held| {
                let (form, off) = self.action(step, inner_steps, start_held, near);
                is_definite(form, off)
            })
    }

    /// Whether the counts of negative eigenvalues of both actions differ, so that a real multiplier is off
    /// the circle.
    pub fn paths_prove_unstable(&self, step: f64, inner_steps: u64) -> bool {
        let counts = [false, true].map(|start_held| {
            let (form, off) = self.action(step, inner_steps, start_held, Near::EXACTLY);
            let found = proven(&form, off);
            (found.unknown == 0).then_some(found.negative)
        });
        matches!(counts, [Some(a), Some(b)] if a != b)
    }

    /// max ln |λ|/H over the eigenvalues of the full period, kick by kick, in doubles.
    pub fn growth_of_period(&self, step: f64, inner_steps: u64) -> f64 {
        let n = self.size();
        let h = step / inner_steps as f64;
        let mut period = Mat::<f64>::identity(2 * n, 2 * n);
        let kick = |period: &mut Mat<f64>, stiffness: &Mat<f64>, strength: f64| {
            let change = stiffness * period.subrows(0, n);
            for j in 0..2 * n {
                (0..n).for_each(|i| period[(n + i, j)] -= strength * change[(i, j)]);
            }
        };
        for k in 0..inner_steps {
            if k == 0 {
                kick(&mut period, &self.slow, step);
            }
            kick(&mut period, &self.fast, h);
            for j in 0..2 * n {
                (0..n).for_each(|i| period[(i, j)] += h * period[(n + i, j)]);
            }
        }
        let largest = period
            .eigenvalues()
            .map_or(f64::NAN, |all| all.into_iter().map(|x| x.norm()).fold(1.0, f64::max));
        largest.ln() / step
    }
}
