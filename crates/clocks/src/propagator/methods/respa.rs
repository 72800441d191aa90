//! r-RESPA with two levels, h2 = m h1 (paper section 3): V (Q_fast)^m V with Q_fast = Q_VV(h1, L1) and
//! V = K(h2 L2/2).
//!
//! With cos th = 1 − h1² L1/2 the fast step is a rotation seen askew, Q_fast = G R(th) G⁻¹, so
//! Tr = 2 [cos(m th) − alpha sin(m th)] (theorem `respa_trace` in proofs/).
//!
//! ```
//! use kickdrift_clocks::propagator::methods::respa;
//! // m = 1 is velocity Verlet with the summed stiffness.
//! let q = respa::propagator(0.25, 1, 3.0, 1.0);
//! assert_eq!(q.trace(), 2.0 - 0.25 * 0.25 * 4.0);
//! ```

use nalgebra::Matrix2;

use super::verlet;
use crate::propagator::kick;
use number::{Rational, Ring};

/// One outer step, by repeated squaring of the fast step: exact in every exact ring.
pub fn propagator<S: Ring>(h1: S, m: u64, lambda1: S, lambda2: S) -> Matrix2<S> {
    let multiple = S::from_rational(&Rational::new(m.into(), 2.into()));
    let half_kick = S::product(&h1, &lambda2) * multiple;
    let slow = kick(half_kick);
    &slow * power(verlet::velocity_form(h1, lambda1), m) * &slow
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
