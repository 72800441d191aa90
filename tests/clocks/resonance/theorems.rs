//! The criteria of the theorems for one slow kick and for two, in rational arithmetic.

use kickdrift::number::{Rational, Sign};
use kickdrift::propagator::TwoClocks;
use kickdrift::propagator::methods::respa::power;
use nalgebra::Matrix2;
use num_traits::{One, Signed, Zero};

/// The paper's criterion for r-RESPA, exactly: for q = 1 and rational s, 0 < s < 4, is
/// tan φ > 1/alpha > 0 or 0 > tan φ > −alpha?
///
/// With τ = tan(θ/2), τ² = s/(4 − s), both tan φ/τ = Y/X, from (1 + iτ)^p = X + iτY, and alpha τ = h1 h2 L2
/// (1 + τ²)/4 are rational: no root is taken. For alpha < 0 (L2 < 0) the inequalities are mirrored:
/// tan φ < 1/alpha < 0 or 0 < tan φ < −alpha.
///
/// `None` unless q = 1 and 0 < s < 4.
pub fn papers_criterion(clocks: &TwoClocks<Rational>) -> Option<bool> {
    let (four, s) = (Rational::from_integer(4.into()), clocks.fast());
    if clocks.q() != 1 || !s.is_positive() || *s >= four {
        return None;
    }
    let tau2 = s / (&four - s);
    // The matrix [[1, −τ²], [1, 1]] acts on (X, Y) as multiplication by 1 + iτ.
    let one = Rational::one;
    let turned = power(Matrix2::new(one(), -tau2.clone(), one(), one()), clocks.p());
    let (x, y) = (&turned[(0, 0)], &turned[(1, 0)]);
    let alpha_tau = clocks.slow() * (one() + &tau2) / &four;
    // alpha tan φ > 1 is alpha τ Y/X > 1; tan φ/alpha in (−1, 0) is τ² Y/X / (alpha τ) in (−1, 0).
    if x.is_zero() || alpha_tau.is_zero() {
        // At a pole of tan, cos φ = 0 and Tr = −2 exactly: an edge. Without a slow force nothing is unstable.
        return Some(false);
    }
    let tan = y / x;
    let share = &tau2 * &tan / &alpha_tau;
    Some(&alpha_tau * &tan > one() || (share.is_negative() && share > -one()))
}

/// Theorem `tan_criterion_q2` in proofs/, for q = 2: with t = tan φ and c2 = cos²(θ/2), Tr < −2 iff
/// (1 − alpha t)(1 − alpha c2 t) < 0, and Tr > 2 iff t [t (1 − alpha² c2) + alpha (1 + c2)] < 0.
///
/// The side of the instability as a sign (zero: none), for rational 0 < s < 4; `None` unless q = 2 and there.
/// (p is odd, so t/τ = Y/X with τ = tan(θ/2), as in [`papers_criterion`].)
pub fn two_slow_kicks(clocks: &TwoClocks<Rational>) -> Option<Sign> {
    let (one, four, s) = (Rational::one(), Rational::from_integer(4.into()), clocks.fast());
    if clocks.q() != 2 || !s.is_positive() || *s >= four {
        return None;
    }
    let tau2 = s / (&four - s);
    let turned = power(Matrix2::new(one.clone(), -tau2.clone(), one.clone(), one.clone()), clocks.p());
    let (x, y) = (&turned[(0, 0)], &turned[(1, 0)]);
    let c2 = &one / (&one + &tau2);
    let alpha_tau = clocks.slow() * (&one + &tau2) / &four;
    // Everything is multiplied by X²: alpha t = alpha τ Y/X, t² = τ² Y²/X², alpha² = (alpha τ)²/τ².
    let below = (x - &alpha_tau * y) * (x - &alpha_tau * &c2 * y);
    let above = y * (y * (&tau2 - &alpha_tau * &alpha_tau * &c2) + &alpha_tau * (&one + &c2) * x);
    Some(match (below.is_negative(), above.is_negative()) {
        (true, _) => Sign::Negative,
        (_, true) => Sign::Positive,
        _ => Sign::Zero,
    })
}
