//! r-RESPA with two levels, h2 = m h1 (paper section 3): V (Q_fast)^m V with Q_fast = Q_VV(h1, L1) and
//! V = K(h2 L2/2).
//!
//! With cos th = 1 − h1² L1/2 the fast step is a rotation seen askew, Q_fast = G R(th) G⁻¹, so
//! Tr = 2 [cos(m th) − alpha sin(m th)] (theorem `respa_trace` in proofs/).
//!
//! ```
//! use kickdrift::propagator::methods::respa;
//! // m = 1 is velocity Verlet with the summed stiffness.
//! let q = respa::propagator(0.25, 1, 3.0, 1.0);
//! assert_eq!(q.trace(), 2.0 - 0.25 * 0.25 * 4.0);
//! ```

use nalgebra::Matrix2;

use super::verlet;
use crate::number::{Rational, Ring};
use crate::propagator::kick;

/// One outer step, by repeated squaring of the fast step: exact in every exact ring.
pub fn propagator<S: Ring>(h1: S, m: u64, lambda1: S, lambda2: S) -> Matrix2<S> {
    let multiple = S::from_rational(&Rational::new(m.into(), 2.into()));
    let half_kick = S::product(&h1, &lambda2) * multiple;
    let slow = kick(half_kick);
    &slow * power(verlet::velocity_form(h1, lambda1), m) * &slow
}

/// (Q_fast)^m = G R(m th) G⁻¹, with G = diag(1, sin(th)/h1) and R(m th) = [[cos, sin], [−sin, cos]].
///
/// Rounded (`f64`): for comparison with the exact power. NaN unless 0 < h1² L1 < 4.
pub fn rotated(h1: f64, m: u64, lambda1: f64) -> Matrix2<f64> {
    let s = h1 * h1 * lambda1;
    let (sin, cos) = ((s * (1.0 - s / 4.0)).sqrt(), 1.0 - s / 2.0);
    let (sin_m, cos_m) = (m as f64 * sin.atan2(cos)).sin_cos();
    let g = sin / h1;
    Matrix2::new(1.0, 0.0, 0.0, g)
        * Matrix2::new(cos_m, sin_m, -sin_m, cos_m)
        * Matrix2::new(1.0, 0.0, 0.0, 1.0 / g)
}

/// Q^m by repeated squaring: about 2 log2 m matrix products.
pub fn power<S: Ring>(mut q: Matrix2<S>, mut m: u64) -> Matrix2<S> {
    let mut result = Matrix2::new(S::one(), S::zero(), S::zero(), S::one());
    while m > 0 {
        if m & 1 == 1 {
            result = &result * &q;
        }
        m >>= 1;
        if m > 0 {
            q = &q * &q;
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn powers_of_the_fast_step_are_rotations(h1 in 0.1f64..1.0, s in 0.1f64..3.9, m in 0u64..50) {
            let lambda1 = s / (h1 * h1);
            let exact = power(verlet::velocity_form(h1, lambda1), m);
            // Condition: entries of G, G⁻¹ below 10, angle error m ulp / sin th below 50 · 1e-16 / 0.15.
            prop_assert!((exact - rotated(h1, m, lambda1)).amax() < 1e-11);
        }
    }

    #[test]
    fn the_trace_is_the_papers_formula() {
        let (h1, m, lambda1, lambda2) = (0.3, 7, 2.0, 0.5);
        let s: f64 = h1 * h1 * lambda1;
        let theta = (1.0 - s / 2.0f64).acos();
        let alpha = h1 * h1 * 7.0 * lambda2 / (2.0 * theta.sin());
        let formula = 2.0 * ((7.0 * theta).cos() - alpha * (7.0 * theta).sin());
        // A dozen products of numbers of size about 1.
        assert!((propagator(h1, m, lambda1, lambda2).trace() - formula).abs() < 1e-13);
    }
}
