//! A verdict without an eigenbasis: four factorizations.
//!
//! In the first stable region condition (1) of proofs/REGION.md is a/b(h² F) − (p/2) h² S > 0, with a/b of
//! one mode as a function of s = h² w². As a/b is concave where the odd solution is positive (section 7
//! there), it lies above its chord over any interval that holds the spectrum of h² F, and so does the matrix:
//! α − β h² F − (p/2) h² S > 0 proves (1). Condition (2) asks only for the highest s, and (3) follows from
//! (1) where F + S > 0.

use faer::{Mat, Side};

use super::half::Half;
use super::kernel::{Kernel, Outer, STEP_ERROR};
use super::rigid::Hessians;
use crate::half::norm;
use crate::signs::inertia::is_definite;
use crate::verdict::large::start;
use crate::verdict::limits::SIDE_BY_SIDE;
use crate::verdict::measured::Holds;
use number::parallel::both;
use number::{Result, U};

/// Steps of Lanczos's recursion for the ends of the spectrum: where it is dense at its ends, they are found
/// to some hundredths.
const STEPS: usize = 24;

/// How much wider than these estimates the interval is that is then proven, relative to ‖F‖.
const ROOM: f64 = 0.02;

/// How far below 0 the interval begins for a positive F, relative to ‖F‖: Cholesky's criterion proves that
/// for thousands of rows.
const ZERO: f64 = 1e-6;

/// Below so many rows the eigenbasis costs as little.
const FEW: usize = 32;

impl Hessians {
    /// The verdict that is proven at one outer step. Where many steps are asked for, [`Kernel`] serves them
    /// all.
    ///
    /// Cost: four Cholesky factorizations, side by side in pairs, where [`Hessians::is_stable_by_chord`]
    /// holds: a tenth of the eigenbasis that is made where it does not.
    ///
    /// ```
    /// use kickdrift_systems::Holds;
    /// use kickdrift_systems::levels::{Hessians, Outer};
    /// use nalgebra::DMatrix;
    /// let fast = DMatrix::from_row_slice(2, 2, &[1.0, 0.2, 0.2, 0.8]);
    /// let slow = DMatrix::from_row_slice(2, 2, &[0.05, 0.01, 0.01, 0.04]);
    /// let hessians = Hessians::new(&fast, &slow, 1e-9)?;
    /// // Outer steps of eight inner ones, in the unit of time of the Hessians.
    /// let outer = |step: f64| Outer::new(step, 8);
    /// assert_eq!(hessians.verdict(&outer(1.0)?)?, Holds::Stable);
    /// assert_eq!(hessians.verdict(&outer(2.93)?)?, Holds::Unstable);
    /// # Ok::<(), kickdrift_systems::number::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Kernel::new`].
    pub fn verdict(&self, outer: &Outer) -> Result<Holds> {
        if self.size() >= FEW && self.is_stable_by_chord(outer) {
            return Ok(Holds::Stable);
        }
        Ok(Kernel::new(self)?.verdict_within(outer, 0.0))
    }

    /// Whether the system is proven to be in the first stable region at this outer step, without the
    /// eigenvalues of F. `false` says nothing: near the end of the region the chord lies below a/b by more
    /// than there is room for.
    pub fn is_stable_by_chord(&self, outer: &Outer) -> bool {
        let side_by_side = self.size() >= SIDE_BY_SIDE;
        let sizes = [&self.fast, &self.slow].map(norm::frobenius);
        if !(sizes[0] + sizes[1]).is_finite() {
            return false;
        }
        let (ends, total) = both(
            side_by_side,
            || ends(self.size(), STEPS, |x| &self.fast * x),
            || self.is_positive(0.0, [1.0, 1.0], sizes),
        );
        let room = ROOM * ends[1].max(-ends[0]);
        // Where F is positive but for rounding the interval begins near 0.
        let low = if ends[0] > -room { -ZERO * ends[1] } else { ends[0] - room };
        let high = ends[1] + room;
        let Some([offset, slope]) = chord(outer, low, high).filter(|_| total) else { return false };
        let (above, below) = both(
            side_by_side,
            || self.is_positive(offset, [-slope * outer.inner_square, -outer.half_kick()], sizes),
            || self.is_positive(high, [-1.0, 0.0], sizes),
        );
        above && below && self.is_positive(-low, [1.0, 0.0], sizes)
    }

    /// Whether c + a F + b S > 0, a and b within [`STEP_ERROR`] of those meant.
    fn is_positive(&self, c: f64, [a, b]: [f64; 2], sizes: [f64; 2]) -> bool {
        let n = self.size();
        let mut sum = Mat::zeros(n, n);
        for j in 0..n {
            let [fast, slow] = [&self.fast, &self.slow].map(|m| &m.col_as_slice(j)[j..]);
            let sums = fast.iter().zip(slow).map(|(f, s)| a * f + b * s);
            sum.col_as_slice_mut(j)[j..].iter_mut().zip(sums).for_each(|(to, entry)| *to = entry);
            sum[(j, j)] += c;
        }
        let [fast, slow] = [0, 1].map(|k| ([a, b][k].abs(), sizes[k], self.errors[k]));
        // Two products and two sums an entry beside the factors' own errors; c on the diagonal, in the
        // 2-norm.
        let rounding = 2.0 * STEP_ERROR * (fast.0 * fast.1 + slow.0 * slow.1) + 4.0 * U * c.abs();
        is_definite(sum, 1.01 * (rounding + fast.0 * fast.2 + slow.0 * slow.2))
    }
}

/// α and β of a line α − β s that is no higher than a/b between the ends of the spectrum of h² F; `None`
/// where p θ < π is not certain up to there.
pub(super) fn chord(outer: &Outer, low: f64, high: f64) -> Option<[f64; 2]> {
    let ends = [outer.scaled_down(low), outer.scaled_up(high)];
    let halves = ends.map(|s| Half::new(s, outer.inner_steps));
    if !halves.iter().all(Half::rises) {
        return None;
    }
    let values = halves.map(|half| half.stretch().lo);
    let slope = (values[0] - values[1]) / (ends[1] - ends[0]);
    // The roundings of a product and a sum taken off.
    let below = |k: usize| {
        let rise = slope * ends[k];
        values[k] + rise - 4.0 * U * (values[k].abs() + rise.abs())
    };
    let offset = below(0).min(below(1));
    (slope.is_finite() && offset.is_finite()).then_some([offset, slope])
}

/// The lowest and the highest eigenvalue of a symmetric matrix of n rows, given by what it takes a vector to,
/// from within: so many steps of Lanczos's recursion, rounded.
pub(super) fn ends(n: usize, steps: usize, times: impl Fn(&Mat<f64>) -> Mat<f64>) -> [f64; 2] {
    let values = recursion(n, steps.min(n), times, |_| false).eigenvalues();
    [values.first().copied().unwrap_or(0.0), values.last().copied().unwrap_or(0.0)]
}

/// The lowest one, rounded, where the recursion finds it to `within` of itself in so many steps.
pub(super) fn lowest(
    n: usize,
    steps: usize,
    within: f64,
    times: impl Fn(&Mat<f64>) -> Mat<f64>,
) -> Option<f64> {
    let (mut next, mut last, mut is_found) = (32, f64::INFINITY, false);
    let all = recursion(n, steps, times, |so_far| {
        if so_far.diagonal.len() < next {
            return false;
        }
        next += next / 4;
        let value = so_far.eigenvalues().first().copied().unwrap_or(f64::INFINITY);
        is_found = last - value < within * value.abs();
        last = value;
        is_found
    });
    (is_found || all.is_used_up).then(|| all.eigenvalues().first().copied()).flatten()
}

/// The tridiagonal matrix of Lanczos's recursion.
#[derive(Default)]
struct Tridiagonal {
    diagonal: Vec<f64>,
    /// The entry before each of the diagonal's, 0 for the first.
    beside: Vec<f64>,
    /// What is found is exact but for rounding.
    is_used_up: bool,
}

impl Tridiagonal {
    /// In rising order; none where they are not found.
    fn eigenvalues(&self) -> Vec<f64> {
        let k = self.diagonal.len();
        let small = Mat::from_fn(k, k, |i, j| match i.abs_diff(j) {
            0 => self.diagonal[i],
            1 => self.beside[i.max(j)],
            _ => 0.0,
        });
        small.self_adjoint_eigenvalues(Side::Lower).unwrap_or_default()
    }
}

/// So many steps of the recursion, fewer where it `is_enough`, from a vector without a pattern.
fn recursion(
    n: usize,
    steps: usize,
    times: impl Fn(&Mat<f64>) -> Mat<f64>,
    mut is_enough: impl FnMut(&Tridiagonal) -> bool,
) -> Tridiagonal {
    let start = start(n);
    let start = Mat::from_fn(n, 1, |i, _| start[i]);
    let mut now = &start / faer::Scale(start.norm_l2());
    let mut before = Mat::<f64>::zeros(n, 1);
    let (mut tridiagonal, mut last) = (Tridiagonal::default(), 0.0);
    for _ in 0..steps {
        let mut next = times(&now) - &before * faer::Scale(last);
        let along = (next.transpose() * &now)[(0, 0)];
        next -= &now * faer::Scale(along);
        tridiagonal.diagonal.push(along);
        tridiagonal.beside.push(last);
        let length = next.norm_l2();
        tridiagonal.is_used_up = length <= 1e-12 * (along.abs() + last);
        if tridiagonal.is_used_up || is_enough(&tridiagonal) {
            break;
        }
        before = now;
        now = next / faer::Scale(length);
        last = length;
    }
    tridiagonal
}
