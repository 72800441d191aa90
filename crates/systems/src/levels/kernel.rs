//! The eigenbasis of the fast stiffness, computed once for every ratio and step.

use std::borrow::Cow;
use std::sync::OnceLock;

use faer::{Mat, Side};
use num_traits::ToPrimitive;

use super::basis::Basis;
use super::half::Half;
use super::method::Method;
use super::rigid::{Hessians, halved};
use crate::half::norm;
use crate::signs::inertia::{is_definite, spectral_norm};
use crate::verdict::limits::SIDE_BY_SIDE;
use crate::verdict::measured::Removed;
use number::parallel::both;
use number::{Error, Interval, Rational, Result, U, to_f64};

/// F = U (Λ + E₁) Uᵀ and S = U (S' + E₂) Uᵀ for an orthogonal U: Λ and S', and bounds on E₁ and E₂ (2-norm).
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Λ, increasing.
    pub(super) values: Vec<f64>,
    pub(super) fast_error: f64,
    /// S'.
    pub(super) slow: Mat<f64>,
    pub(super) slow_error: f64,
    /// Upper bounds of ‖F‖₂ and, once it is asked for, ‖S‖₂: of what these are known relative to.
    fast_norm: f64,
    slow_norm: OnceLock<f64>,
    slow_size: f64,
    /// Whether F + S is proven positive definite, once it is asked for.
    is_total_definite: OnceLock<bool>,
    /// The modes as columns in the mass-weighted coordinates given, rounded.
    pub(super) modes: Mat<f64>,
    pub(super) method: Method,
    /// The motions that were projected out before.
    pub removed: Option<Removed>,
}

/// An outer step of p inner ones.
#[derive(Clone, Copy, Debug)]
pub struct Outer {
    /// h², h the inner step, within 4 u of its size.
    pub(super) inner_square: f64,
    /// p.
    pub(super) inner_steps: u64,
    /// p h.
    pub(super) step: f64,
}

/// The relative error of [`Outer::inner_square`] and of a product with it, with room.
pub(super) const STEP_ERROR: f64 = 8.0 * U;

impl Outer {
    /// p inner steps in an outer step.
    ///
    /// # Errors
    /// A step that is not positive and finite, p = 0 or above a million.
    pub fn new(step: f64, inner_steps: u64) -> Result<Outer> {
        if !(step.is_finite() && step > 0.0) {
            return Err(Error::input("step", step, "a step must be positive"));
        }
        if inner_steps == 0 || inner_steps > 1_000_000 {
            return Err(Error::input("inner steps", inner_steps, "give 1 to a million inner steps"));
        }
        Ok(Outer { inner_square: (step / inner_steps as f64).powi(2), inner_steps, step })
    }

    /// Two rational steps, of which the outer one is a multiple of the inner one; `None` where it is not.
    pub fn of_steps(inner: &Rational, outer: &Rational) -> Option<Outer> {
        let ratio = outer / inner;
        let inner_steps = ratio.is_integer().then(|| ratio.to_integer().to_u64()).flatten()?;
        let checked = Outer::new(to_f64(outer), inner_steps).ok()?;
        Some(Outer { inner_square: to_f64(&(inner * inner)), ..checked })
    }

    /// p h.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// p.
    pub fn inner_steps(&self) -> u64 {
        self.inner_steps
    }

    /// (p/2) h², of which half an outer kick is the multiple in the time unit h.
    pub(super) fn half_kick(&self) -> f64 {
        self.inner_square * (self.inner_steps as f64 / 2.0)
    }

    /// h² x, rounded up.
    pub(super) fn scaled_up(&self, x: f64) -> f64 {
        let y = self.inner_square * x;
        (y + STEP_ERROR * y.abs()).next_up()
    }

    /// h² x, rounded down.
    pub(super) fn scaled_down(&self, x: f64) -> f64 {
        -self.scaled_up(-x)
    }
}

/// Two levels at the ratio of this outer step's to its inner ones.
#[derive(Clone, Copy, Debug)]
pub struct AtRatio<'a> {
    pub(super) kernel: &'a Kernel,
    pub(super) outer: Outer,
}

impl AtRatio<'_> {
    /// That outer step itself, or another one of as many inner ones.
    ///
    /// # Errors
    /// As [`Outer::new`].
    pub(super) fn outer(&self, step: f64) -> Result<Outer> {
        if step == self.outer.step { Ok(self.outer) } else { Outer::new(step, self.outer.inner_steps) }
    }
}

impl Kernel {
    /// These levels, searched over all outer steps of as many inner ones as there are in this one.
    pub fn at(&self, outer: &Outer) -> AtRatio<'_> {
        AtRatio { kernel: self, outer: *outer }
    }

    /// One eigendecomposition and four products, or as many small ones as the fast stiffness has blocks:
    /// molecules that no bond joins, as long as no rigid motion of all of them was projected out.
    ///
    /// # Errors
    /// Where the eigenvalue iteration fails: never seen, but not excluded.
    pub fn new(hessians: &Hessians) -> Result<Kernel> {
        let (fast, slow, m) = (&hessians.fast, &hessians.slow, hessians.size());
        let failed = || {
            Error::input("fast", "its eigenvalues", "the iteration does not converge: is the matrix sound?")
        };
        let basis = Basis::new(fast).ok_or_else(failed)?;
        let (checked, turned) =
            both(m >= SIDE_BY_SIDE, || basis.backward_error(fast), || halved(basis.turned(slow).as_ref()));
        let (error, defect) = checked.ok_or_else(failed)?;
        let fast_error = hessians.errors[0] + error;
        let (size, vectors, values) = (norm::frobenius(slow), basis.vectors(), basis.values);
        let rounding = 2.2 * (m as f64 + 4.0) * U * norm::frobenius(&vectors).powi(2) * size;
        let slow_error = hessians.errors[1] + rounding + 2.1 * defect * size;
        let fast_norm = values.iter().fold(0.0, |a: f64, x| a.max(x.abs())) + fast_error;
        let [fast_size, slow_size] = hessians.sizes;
        let modes = match &hessians.basis {
            Some(basis) => basis * &vectors,
            None => vectors,
        };
        Ok(Kernel {
            values,
            fast_error,
            slow: turned,
            slow_error,
            fast_norm: fast_norm.max(fast_size),
            slow_norm: OnceLock::new(),
            slow_size,
            is_total_definite: OnceLock::new(),
            modes,
            method: Method::default(),
            removed: hessians.removed.clone(),
        })
    }

    /// These modes under another integrator.
    #[must_use]
    pub fn with_method(self, method: Method) -> Kernel {
        Kernel { method, ..self }
    }

    /// Upper bounds of the 2-norms of both stiffnesses, of sums of potentials that share a clock those of the
    /// sums of their norms: what all are known relative to.
    pub fn norms(&self) -> [f64; 2] {
        let slow = || spectral_norm(&self.slow, self.slow_error).max(self.slow_size);
        [self.fast_norm, *self.slow_norm.get_or_init(slow)]
    }

    /// How far (2-norm) Λ and S' are from those of all stiffnesses within ε of their norms.
    pub(super) fn errors_within(&self, epsilon: f64) -> [f64; 2] {
        if epsilon == 0.0 {
            return [self.fast_error, self.slow_error];
        }
        let [fast, slow] = self.norms();
        [self.fast_error + epsilon * fast, self.slow_error + epsilon * slow]
    }

    /// How far (2-norm) h² Λ, computed, is from that of a fast stiffness within `shift`: that, and the
    /// rounding of h² and of the product.
    pub(super) fn moved(&self, outer: &Outer, shift: f64) -> f64 {
        1.01 * (outer.inner_square * shift + 2.0 * STEP_ERROR * outer.inner_square * self.fast_norm)
    }

    /// The fast half periods at the modes' own frequencies.
    pub(super) fn halves(&self, outer: &Outer) -> Vec<Half> {
        let half = |x: &f64| self.method.half(Interval::point(outer.inner_square * x), outer.inner_steps);
        self.values.iter().map(half).collect()
    }

    /// How far h² Λ reaches below 0, the fast stiffness being within `shift`.
    pub(super) fn below(&self, outer: &Outer, shift: f64) -> f64 {
        self.values.first().map_or(0.0, |lowest| (-outer.scaled_down(lowest - shift)).max(0.0))
    }

    /// The slow stiffness as it kicks, filtered, and how far (2-norm) that may be off, both stiffnesses being
    /// within these shifts.
    pub(super) fn filtered(&self, outer: &Outer, [fast, slow]: [f64; 2]) -> (Cow<'_, Mat<f64>>, f64) {
        if !self.method.has_filter() {
            return (Cow::Borrowed(&self.slow), slow);
        }
        let (m, p, size) = (self.size(), outer.inner_steps, self.norms()[1] + slow);
        let phi = |x: &f64| self.method.filter(Interval::point(outer.inner_square * x), p);
        let phi: Vec<Interval> = self.values.iter().map(phi).collect();
        let [.., slope] = self.method.slopes(p, self.below(outer, fast));
        let off =
            phi.iter().map(|interval| interval.error()).fold(0.0, f64::max) + slope * self.moved(outer, fast);
        let largest = phi.iter().map(|interval| interval.middle().abs()).fold(0.0, f64::max) + off;
        let kicks = Mat::from_fn(m, m, |i, j| phi[i].middle() * self.slow[(i, j)] * phi[j].middle());
        // Two roundings an entry.
        let rounding = 3.0 * U * largest * largest * norm::frobenius(&self.slow);
        (Cow::Owned(kicks), 1.01 * (2.0 * off * largest * size + largest * largest * slow + rounding))
    }

    /// Half an outer kick, and upper bounds of the norm of the true one and of its distance, the stiffnesses
    /// being within these shifts.
    pub(super) fn half_kick(&self, outer: &Outer, shifts: [f64; 2]) -> (Mat<f64>, [f64; 2]) {
        let (m, factor, [_, slow_norm]) = (self.size(), outer.half_kick(), self.norms());
        let (slow, shift) = self.filtered(outer, shifts);
        let off = shift + 2.0 * STEP_ERROR * norm::frobenius(slow.as_ref());
        let kick = Mat::from_fn(m, m, |i, j| factor * slow[(i, j)]);
        (kick, [1.01 * factor * (slow_norm + off), 1.01 * factor * off])
    }

    /// Whether F + S is proven positive definite.
    pub(super) fn is_total_definite(&self) -> bool {
        *self.is_total_definite.get_or_init(|| self.is_total_definite_within(0.0))
    }

    /// Whether that is so of all stiffnesses within ε of their norms.
    pub(super) fn is_total_definite_within(&self, epsilon: f64) -> bool {
        let (size, [fast, slow]) =
            (self.fast_norm + norm::frobenius(&self.slow), self.errors_within(epsilon));
        is_definite(self.total(), 1.01 * (fast + slow) + U * size)
    }

    /// Λ + S'.
    pub(super) fn total(&self) -> Mat<f64> {
        let mut total = self.slow.clone();
        (0..self.size()).for_each(|i| total[(i, i)] += self.values[i]);
        total
    }

    /// The number of modes.
    pub fn size(&self) -> usize {
        self.values.len()
    }

    /// The highest frequency of the slow stiffness, rounded; 0 where nothing is slow.
    pub fn highest_slow_frequency(&self) -> f64 {
        highest_frequency(&self.slow)
    }

    /// The highest frequency of the fast stiffness, rounded.
    pub fn highest_frequency(&self) -> f64 {
        self.values.last().copied().unwrap_or(0.0).max(0.0).sqrt()
    }
}

/// The highest frequency of a stiffness alone, rounded; 0 where it has none.
pub(super) fn highest_frequency(stiffness: &Mat<f64>) -> f64 {
    let values = stiffness.self_adjoint_eigenvalues(Side::Lower);
    values.map_or(0.0, |values| values.last().copied().unwrap_or(0.0).max(0.0).sqrt())
}
