//! Velocity Verlet for x'' + L x = 0, in velocity form (paper eq. (1)); eqs. (2)-(3), the staggered form, are
//! D(h) K(hL), its conjugate.
//!
//! ```
//! use kickdrift_clocks::propagator::{drift, kick, methods::verlet};
//! let (h, l) = (0.5, 3.0);
//! assert_eq!(verlet::velocity_form(h, l).trace(), (drift(h) * kick(h * l)).trace());
//! ```

use nalgebra::Matrix2;

use crate::propagator::{drift, kick};
use number::{Rational, Ring};

/// Q_VV = K(hL/2) D(h) K(hL/2) = [[1 − h²L/2, h], [−hL(1 − h²L/4), 1 − h²L/2]].
///
/// Its powers are bounded iff 0 < h²L < 4 (theorem `verlet` in proofs/); at h²L = 4 it is a
/// Jordan block and grows linearly, which the paper's "|eigenvalue| ≤ 1 iff h √L ≤ 2" does not see.
pub fn velocity_form<S: Ring>(h: S, stiffness: S) -> Matrix2<S> {
    let one_half = S::from_rational(&Rational::new(1.into(), 2.into()));
    let half_kick = S::product(&h, &stiffness) * one_half;
    kick(half_kick.clone()) * drift(h) * kick(half_kick)
}
