//! What a period of two sparse levels does to positions, as an operator, with a bound on its roundings.
//!
//! With x = 1 − h² F/2, C = T_p(x), V = U_(p−1)(x) and M = (p/2) h² S, a period from rest in the middle of a slow kick takes positions y to C y − V M y. With
//! y = V z that is V (C − M V) z, and C − M V is symmetric in the scalar product of V where p θ < π, so V > 0. It is told by its excess beyond −1,
//!
//! ```text
//!     e(z) = (M V z − C z − z)/2:     the eigenvalues of e are −1 − μ.
//! ```
//!
//! U_k z follows by U_(k+1) = 2 x U_k − U_(k−1). Where a step of that is off by f_k, U_m z is by Σ U_(m−1−k) f_k, and |U_j| ≤ (j + 1) a on the spectrum:
//! a = 1 where F ≥ 0, and cosh((j + 1) t) ≤ exp(p h √−λ) with cosh t = 1 + h² |λ|/2 where an eigenvalue λ < 0 is the lowest.

use faer::Mat;

use super::region::SparseLevels;
use crate::number::U;
use crate::system::half::norm;
use crate::system::levels::kernel::{Outer, STEP_ERROR};

/// The operator at an outer step with p θ < π.
pub(super) struct Period<'a> {
    pub levels: &'a SparseLevels,
    pub outer: Outer,
    /// a.
    pub above: f64,
    /// How far a product with F or S may be from that without rigid motions, for a vector of length 1.
    errors: [f64; 2],
}

/// What becomes of some columns z.
pub(super) struct Image {
    /// V z and e(z), rounded,
    pub moved: Mat<f64>,
    pub excess: Mat<f64>,
    /// and no less than the lengths of their errors, column by column.
    pub errors: Vec<[f64; 2]>,
}

impl Period<'_> {
    /// At an outer step for which [`super::region::SparseLevels::ends`] and the chord tell that p θ < π; `low` is no more than the lowest eigenvalue of F.
    pub fn new(levels: &SparseLevels, outer: Outer, low: f64) -> Period<'_> {
        let (n, c) = (levels.size() as f64, levels.rigid.ncols() as f64);
        let square = levels.rigid.transpose() * &levels.rigid;
        let defect = &square - Mat::<f64>::identity(square.nrows(), square.ncols());
        // Of x − R Rᵀ x from the projection that is meant: |RᵀR − 1|; dot products of n terms, sums of c, once there and once for RᵀR.
        let project = 1.05 * (norm::frobenius(&defect) + (2.0 * c * (n + 4.0) + 4.0) * U);
        let project = if c == 0.0 { 0.0 } else { project };
        let errors = [&levels.fast, &levels.slow].map(|own| levels.both.size_of(own).1 as f64);
        let error =
            |k: usize| levels.errors[k] + 1.05 * (2.0 * project + (errors[k] + 2.0) * U) * levels.sizes[k];
        let beyond = outer.scaled_up(-low).max(0.0).sqrt() * outer.inner_steps as f64;
        Period { levels, outer, above: 1.01 * beyond.exp(), errors: [error(0), error(1)] }
    }

    /// No less than the norm of V.
    pub fn size(&self) -> f64 {
        1.01 * self.above * self.outer.inner_steps as f64
    }

    fn free(&self, x: Mat<f64>) -> Mat<f64> {
        let rigid = &self.levels.rigid;
        if rigid.ncols() == 0 { x } else { &x - rigid * (rigid.transpose() * &x) }
    }

    /// V z and e(z): p products with F, one with S.
    pub fn of(&self, z: &Mat<f64>) -> Image {
        let (levels, h2) = (self.levels, self.outer.inner_square);
        let pull = |x: &Mat<f64>| self.free(levels.alone.times(&levels.fast_alone, &self.free(x.clone())));
        let lengths = |x: &Mat<f64>| -> Vec<f64> { (0..x.ncols()).map(|j| x.col(j).norm_l2()).collect() };
        // A step: h² F x, its product, two sums; then what is subtracted.
        let size = h2 * levels.sizes[0];
        let local = 1.02 * (h2 * self.errors[0] + (STEP_ERROR + 3.0 * U) * size + 4.0 * U);
        let (mut before, mut now) = (Mat::zeros(z.nrows(), z.ncols()), z.clone());
        let mut own = lengths(z);
        let (mut last, mut errors) = (vec![0.0; own.len()], vec![[0.0; 2]; own.len()]);
        let mut moved = None;
        for k in 1..=self.outer.inner_steps {
            let pulled = pull(&now);
            let next = Mat::from_fn(z.nrows(), z.ncols(), |i, j| {
                2.0 * now[(i, j)] - h2 * pulled[(i, j)] - before[(i, j)]
            });
            if k == self.outer.inner_steps {
                moved =
                    Some((now.clone(), errors.iter().map(|[_, all]| self.above * all).collect::<Vec<_>>()));
            }
            for (j, [each, all]) in errors.iter_mut().enumerate() {
                *each += local * own[j] + 2.1 * U * last[j];
                *all += *each;
            }
            // C z = (U_p z − U_(p−2) z)/2 at the end.
            if k < self.outer.inner_steps {
                (before, now) = (now, next);
                last = std::mem::replace(&mut own, lengths(&now));
            } else {
                now = next;
            }
        }
        let (moved, off) = moved.expect("one step or more");
        let kick = self.outer.half_kick();
        let pulled = self.free(levels.both.times(&levels.slow, &self.free(moved.clone())));
        let excess = Mat::from_fn(z.nrows(), z.ncols(), |i, j| {
            (kick * pulled[(i, j)] - (now[(i, j)] - before[(i, j)]) / 2.0 - z[(i, j)]) / 2.0
        });
        let (long, far) = (lengths(&moved), [lengths(&now), lengths(&before), lengths(z)]);
        let error = |j: usize| {
            let kicked = (self.errors[1] + (STEP_ERROR + 4.0 * U) * levels.sizes[1]) * long[j]
                + levels.sizes[1] * off[j];
            let summed = 4.0 * U * far.iter().map(|own| own[j]).sum::<f64>();
            [1.01 * off[j], 0.51 * (kick * kicked + self.above * errors[j][1] + summed)]
        };
        Image { errors: (0..off.len()).map(error).collect(), moved, excess }
    }
}
