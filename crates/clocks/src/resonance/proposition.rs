//! The paper's Proposition, exactly and with witnesses.
//!
//! Let θ = h1 π/T½. A pair of steps is *resonant* (eq. (9)) if h2/h1 = p/q in lowest terms and q h2 = m T½
//! for an integer m, that is p θ = m π. It lies on the curve (a, b) (eq. (10)) if
//!
//! ```text
//!     h2 = b T½ h1/(h1 - a T½),     that is     1/T½ = a/h1 + b/h2.
//! ```
//!
//! **Proposition.** A pair with h2/h1 = p/q is resonant iff it lies on a curve (a, b) with b ≠ 0; then
//! m = a p + b q. (Theorem `proposition` in proofs/. The paper takes any Bézout pair a p + b q = 1; for p = 1
//! that may have b = 0, and eq. (10) reads 0/0. Bézout pairs are not unique: one with b ≠ 0 always exists.)
//!
//! At a resonant point s = 4 sin²(m π/2p) = 2 − 2 cos(m π/p) is an element of the cyclotomic field
//! Q(2 cos(π/p)), where p θ = m π is the exact equation T_p(1 − s/2) = (−1)^m, T_p the Chebyshev polynomial.
//!
//! ```
//! use kickdrift_clocks::resonance::proposition::{witness, Witness};
//! let w = witness("1/1".parse().unwrap(), 1);
//! assert!(w.b != 0 && w.a * 1 + w.b * 1 == 1);
//! assert!(w.lies_on_its_curve() && w.is_resonant());
//! ```

use num_integer::Integer;
use num_traits::{One, Zero};

use super::family::families;
use number::cyclotomic::CyclotomicField;
use number::{Cyclotomic, Ratio, Rational, Ring};

/// A resonant point h2/h1 = p/q, p θ = m π, and a curve (a, b), b ≠ 0, through it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Witness {
    pub ratio: Ratio,
    pub m: u64,
    pub a: i64,
    pub b: i64,
}

/// The curve (a, b) with b ≠ 0 and the smallest |a| through the resonant point (p, q, m), 0 < m < p where θ <
/// π.
pub fn witness(ratio: Ratio, m: u64) -> Witness {
    let (a0, b0) = families(ratio, m);
    let (p, q) = (ratio.p() as i64, ratio.q() as i64);
    let candidates = [(a0, b0), (a0 - q, b0 + p), (a0 + q, b0 - p)];
    let nonzero = candidates.into_iter().filter(|&(_, b)| b != 0);
    let (a, b) = nonzero.min_by_key(|&(a, _)| a.abs()).expect("at most one of three has b = 0");
    Witness { ratio, m, a, b }
}

impl Witness {
    /// Eq. (10), exactly: in the unit h1, T½ = p/m at the resonance, and b T½/(1 − a T½) must be p/q.
    /// (The curve passes through the pair; its denominator does not vanish since b ≠ 0.)
    pub fn lies_on_its_curve(&self) -> bool {
        point_on_curve(self.a, self.b, &half_period(self.ratio.p(), self.m)) == Some(self.ratio.into())
    }

    /// Eq. (9), exactly, in the cyclotomic field: T_p(1 − s/2) = (−1)^m and q h2 = m T½.
    pub fn is_resonant(&self) -> bool {
        let (p, q) = self.ratio.terms();
        let period = Rational::from(self.ratio) * Rational::from_integer(q.into());
        let turns = half_period(p, self.m) * Rational::from_integer(self.m.into());
        period == turns && closes_in(&field(p), p, self.m)
    }
}

/// T½/h1 = p/m at p θ = m π.
fn half_period(p: u64, m: u64) -> Rational {
    fraction(p, m)
}

/// h2/h1 on the curve (a, b) where T½/h1 = t: b t/(1 − a t), or `None` where the curve has no such point.
pub fn point_on_curve(a: i64, b: i64, t: &Rational) -> Option<Rational> {
    let denominator = Rational::one() - Rational::from_integer(a.into()) * t;
    (!denominator.is_zero()).then(|| Rational::from_integer(b.into()) * t / denominator)
}

/// The converse: a pair with h2/h1 = p/q on the curve (a, b) has T½/h1 = p/(a p + b q), so it is resonant
/// with m = a p + b q. `None` where m ≤ 0: no step h1 > 0 has such a T½.
///
/// With b ≠ 0 and x = h1/T½, eq. (10) reads p/q (x − a) = b.
pub fn resonance_on_curve(ratio: Ratio, a: i64, b: i64) -> Option<u64> {
    let over_pi =
        Rational::from(ratio.inverse()) * Rational::from_integer(b.into()) + Rational::from_integer(a.into());
    let m = over_pi * Rational::from_integer(ratio.p().into());
    (m.is_integer() && m > Rational::zero()).then(|| u64::try_from(m.to_integer()).ok()).flatten()
}

/// Q(2 cos(π/p)).
fn field(p: u64) -> CyclotomicField {
    CyclotomicField::new(u32::try_from(p).expect("a p whose field fits in memory"))
}

/// Whether T_p(1 − s/2) = (−1)^m at s = 2 − 2 cos(m π/p), by V_p(x) = 2 T_p(x/2), V_{k+1} = x V_k − V_{k−1},
/// x = 2 cos(m π/p).
fn closes_in(field: &CyclotomicField, p: u64, m: u64) -> bool {
    let x = field.two_cos(m as i64);
    let two = <Cyclotomic as Ring>::from_rational(&fraction(2, 1));
    let (mut before, mut now) = (two.clone(), x.clone());
    for _ in 1..p {
        let mut next = Cyclotomic::product(&x, &now);
        next -= before;
        (before, now) = (now, next);
    }
    now == if m.is_even() { two } else { -two }
}

/// The result of an exhaustive check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Check {
    /// Resonant points (p, q, m) examined, each with a witness that satisfies eqs. (9) and (10).
    pub forward: u64,
    /// Curves (a, b) at a ratio p/q examined, each resonant with m = a p + b q.
    pub backward: u64,
    /// Points or curves at which the Proposition fails.
    pub failures: Vec<Witness>,
}

/// The Proposition for all coprime p, q ≤ `max` and all 0 < m < p, and back for all curves with |a| ≤ `max`
/// through each ratio; every witness is shown to `visit`.
pub fn check(max: u64, mut visit: impl FnMut(&Witness)) -> Check {
    let mut result = Check::default();
    for p in 1..=max {
        let field = field(p);
        let closes: Vec<bool> = (0..p).map(|m| m > 0 && closes_in(&field, p, m)).collect();
        for ratio in (1..=max).filter(|q| q.gcd(&p) == 1).filter_map(|q| Ratio::new(p, q).ok()) {
            let q = ratio.q();
            for m in 1..p {
                let w = witness(ratio, m);
                result.forward += 1;
                let resonant = closes[m as usize]
                    && fraction(p, q) * fraction(q, 1) == half_period(p, m) * fraction(m, 1);
                let holds = w.b != 0 && w.a * p as i64 + w.b * q as i64 == m as i64 && w.lies_on_its_curve();
                if holds && resonant { visit(&w) } else { result.failures.push(w) }
            }
            backward(ratio, max as i64, &closes, &mut result);
        }
    }
    result
}

/// Every curve |a| ≤ `max` that has a point with h2/h1 = p/q below the Verlet limit, 0 < θ/π < 1.
fn backward(ratio: Ratio, max: i64, closes: &[bool], result: &mut Check) {
    let (p, q) = (ratio.p() as i64, ratio.q() as i64);
    for a in -max..=max {
        // 0 < a + b q/p < 1.
        let lowest = (-a * p).div_euclid(q) + 1;
        let curves = (lowest..).take_while(|b| a * p + b * q < p).filter(|&b| b != 0);
        for b in curves {
            result.backward += 1;
            let m = resonance_on_curve(ratio, a, b);
            let on_curve = |m| point_on_curve(a, b, &half_period(ratio.p(), m)) == Some(ratio.into());
            if !m.is_some_and(|m| closes[m as usize] && on_curve(m)) {
                result.failures.push(Witness { ratio, m: m.unwrap_or(0), a, b });
            }
        }
    }
}

fn fraction(p: u64, q: u64) -> Rational {
    Rational::new(p.into(), q.into())
}
