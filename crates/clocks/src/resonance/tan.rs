//! The tan criterion: the paper's for r-RESPA (q = 1), and its form for every q.
//!
//! Let φ = p θ/2 = π q h2/T_eff. The paper: with q = 1 the pair is unstable iff tan φ > 1/alpha > 0 or
//! 0 > tan φ > −alpha. For every q the half period in Floquet coordinates gives four forms linear in t = tan
//! φ,
//!
//! ```text
//!     A ∝ cE + cO t,  C ∝ cO - cE t    (even start),      B, D likewise    (odd start),
//! ```
//!
//! so the pair is unstable iff t lies between the critical values −cE/cO of A and D (Tr < −2) or between the
//! values cO/cE of B and C (Tr > 2). (Theorems `tan_criterion_q1`, `tan_criterion` in proofs/.)
//!
//! None of this composes a kick of the fast clock, and nothing is asked of the verdict's ladder: it is a
//! route of its own. Angles drop out of the form: C_n = cos nθ and S_n = sin nθ/ sin θ are polynomials in s
//! (Chebyshev's), which the addition theorems give for any n at once,
//!
//! ```text
//!     C_{m+n} = C_m C_n - sin²θ S_m S_n,   S_{m+n} = S_m C_n + C_m S_n,   sin²θ = s - s²/4,
//! ```
//!
//! and with d = cO sin θ the update of a slow kick of strength k at t = n + σ is
//!
//! ```text
//!     E = (1-σ) C_n + σ C_{n+1},  O = (1-σ) S_n + σ S_{n+1},   x = cE E + d O,   cE += k x O,  d -= k x E.
//! ```
//!
//! The four signs are first enclosed, in balls of 128 bits and more; what stays undecided there, the edges
//! above all, is computed exactly.

use std::cmp::Ordering;

use crate::propagator::TwoClocks;
use crate::verdict::{Decidable, HalfSigns, Limits, PartialSigns, Tier, Verdict};
use number::{Ball, Enclosed, ExactSign, Rational, Real, Result, Ring};

/// The tan criterion for any q: the four forms enclosed, else computed exactly. q/2 slow kicks, whatever p.
///
/// # Errors
/// A budget error where only exact arithmetic would decide, and it costs more than the limits allow.
pub fn criterion<S: Decidable>(clocks: &TwoClocks<S>, limits: &Limits) -> Result<Verdict> {
    let kicks = clocks.q();
    // A kick and the turn before it lose some two bits in balls, so long periods are worth more of them. For
    // s > 4 the turns grow like e^(γ n), cosh γ = s/2 − 1, and each of q/2 kicks at n up to p/2 loses 2 γ
    // n/ln 2 of them.
    let grows =
        clocks.fast().enclosure(64).compare(&Ball::from_integer(&4.into())) == Some(Ordering::Greater);
    let pays = |bits: u64| grows && kicks.saturating_mul(bits) < MOST_BITS;
    let enclosed = enclosed_forms::<S, 128>(clocks)
        .or_else(|| enclosed_forms::<S, 512>(clocks))
        .or_else(|| (kicks > 200 || pays(2048)).then(|| enclosed_forms::<S, 2048>(clocks))?)
        .or_else(|| (kicks > 800 || pays(8192)).then(|| enclosed_forms::<S, 8192>(clocks))?)
        .or_else(|| pays(32_768).then(|| enclosed_forms::<S, 32_768>(clocks))?)
        .or_else(|| pays(131_072).then(|| enclosed_forms::<S, 131_072>(clocks))?);
    if let Some(verdict) = enclosed {
        return Ok(verdict);
    }
    // Turns and kicks apart make numbers twice as long as the half period's.
    limits.allow(S::exact_cost(clocks, clocks.ratio().kicks()), Tier::Exact)?;
    Ok(exact_criterion(clocks))
}

/// Bits of all kicks of one attempt in balls: seconds.
const MOST_BITS: u64 = 1 << 26;

/// The tan criterion for any q by exact arithmetic in the ring of s and the slow kick.
pub fn exact_criterion<S: ExactSign>(clocks: &TwoClocks<S>) -> Verdict {
    exact_forms(clocks).verdict()
}

/// The signs of the four forms at T/2, each times a positive factor.
fn exact_forms<S: ExactSign>(clocks: &TwoClocks<S>) -> HalfSigns {
    let [a, b, c, d] = forms(clocks).map(|form| form.sign());
    HalfSigns::new(a, b, c, d)
}

/// The verdict, where balls of so many bits decide enough of the four signs.
fn enclosed_forms<S: Real, const BITS: u32>(clocks: &TwoClocks<S>) -> Option<Verdict> {
    let enclosed = clocks.map(|x| Enclosed::<BITS>(x.enclosure(BITS)));
    let [a, b, c, d] = forms(&enclosed).map(|form| form.sign());
    PartialSigns { a, b, c, d }.verdict()
}

/// A, B, C, D, each times a positive factor.
fn forms<S: Ring>(clocks: &TwoClocks<S>) -> [S; 4] {
    let turns = Turns::new(clocks.fast());
    let (even, odd) = coefficients(clocks, &turns);
    let half_turn = HalfTurn::new(clocks.p(), clocks.fast(), &turns);
    let ((a, c), (b, d)) = (half_turn.forms(&even), half_turn.forms(&odd));
    [a, b, c, d]
}

/// (cE, d) after the slow kicks of the half period, for the even and the odd start.
fn coefficients<S: Ring>(clocks: &TwoClocks<S>, turns: &Turns<S>) -> ([S; 2], [S; 2]) {
    let (p, q) = (u128::from(clocks.p()), u128::from(clocks.q()));
    let (mut even, mut odd) = ([S::one(), S::zero()], [S::zero(), S::one()]);
    // From one slow kick to the next the fast clock makes ⌊p/q⌋ steps or one more.
    let short = turns.by(clocks.p() / clocks.q());
    let long = turns.sum(&short, &turns.once);
    let (mut n, mut turn) = (0, turns.by(0));
    for k in 0..=q / 2 {
        let (next, r) = (k * p / q, k * p % q);
        if k > 0 {
            turn = turns.sum(&turn, if next - n == p / q { &short } else { &long });
        }
        n = next;
        let sigma = S::from_rational(&Rational::new(r.into(), q.into()));
        let [e, o] = between(&turn, &turns.sum(&turn, &turns.once), &sigma);
        let whole = k > 0 && 2 * k != q;
        let weight = S::from_rational(&Rational::new(1.into(), if whole { 1 } else { 2 }.into()));
        let strength = S::product(clocks.slow(), &weight);
        for solution in [&mut even, &mut odd] {
            kick(solution, &strength, &e, &o);
        }
    }
    (even, odd)
}

fn kick<S: Ring>([c, d]: &mut [S; 2], strength: &S, e: &S, o: &S) {
    let mut x = S::product(c, e);
    x.add_product(d, o);
    let y = S::product(strength, &x);
    c.add_product(&y, o);
    d.sub_product(&y, e);
}

/// E and O at n + σ.
fn between<S: Ring>(now: &[S; 2], next: &[S; 2], sigma: &S) -> [S; 2] {
    [0, 1].map(|i| {
        let mut x = now[i].clone();
        x.add_product(sigma, &next[i]);
        x.sub_product(sigma, &now[i]);
        x
    })
}

/// Turns by nθ, as (C_n, S_n), and their addition theorems.
struct Turns<S> {
    once: [S; 2],
    sin2: S,
}

impl<S: Ring> Turns<S> {
    fn new(s: &S) -> Self {
        let half_s = S::product(s, &S::from_rational(&Rational::new(1.into(), 2.into())));
        let sin2 = s.clone() + -S::product(&half_s, &half_s);
        Turns { once: [S::one() + -half_s, S::one()], sin2 }
    }

    fn sum(&self, [c, s]: &[S; 2], [d, t]: &[S; 2]) -> [S; 2] {
        let mut cos = S::product(c, d);
        cos.sub_product(&self.sin2, &S::product(s, t));
        let mut sin = S::product(s, d);
        sin.add_product(c, t);
        [cos, sin]
    }

    /// The turn by nθ, by doubling.
    fn by(&self, n: u64) -> [S; 2] {
        (0..u64::BITS - n.leading_zeros()).rev().fold([S::one(), S::zero()], |turn, bit| {
            let twice = self.sum(&turn, &turn);
            if n >> bit & 1 == 1 { self.sum(&twice, &self.once) } else { twice }
        })
    }
}

/// cos φ and sin φ, φ = p θ/2, up to factors that are positive for 0 < θ < π and that only signs may ignore.
enum HalfTurn<S> {
    /// p even: cos φ = C_{p/2}, sin φ = sin θ S_{p/2}; with sin²θ.
    Even { cos: S, sin: S, sin2: S },
    /// p odd: cos φ = cos(θ/2) V, sin φ = sin(θ/2) W; with 2 cos²(θ/2) and 2 sin²(θ/2).
    Odd { cos: S, sin: S, twice_cos2: S, twice_sin2: S },
}

impl<S: Ring> HalfTurn<S> {
    fn new(p: u64, s: &S, turns: &Turns<S>) -> Self {
        let [cos, sin] = turns.by(p / 2);
        let constant = |n: i64, d: i64| S::from_rational(&Rational::new(n.into(), d.into()));
        let half_s = S::product(s, &constant(1, 2));
        if p.is_multiple_of(2) {
            return HalfTurn::Even { cos, sin, sin2: turns.sin2.clone() };
        }
        // cos(nθ + θ/2) = cos(θ/2) (C_n − 2 sin²(θ/2) S_n), sin(nθ + θ/2) = sin(θ/2) (C_n + 2 cos²(θ/2) S_n).
        let twice_cos2 = constant(2, 1) + -half_s.clone();
        let (mut v, mut w) = (cos.clone(), cos);
        v.sub_product(&half_s, &sin);
        w.add_product(&twice_cos2, &sin);
        HalfTurn::Odd { cos: v, sin: w, twice_cos2, twice_sin2: half_s }
    }

    /// cE cos φ + cO sin φ and cO cos φ − cE sin φ, each times a positive factor; cO = d/ sin θ.
    fn forms(&self, [c, d]: &[S; 2]) -> (S, S) {
        let form = |x: S, y: S| {
            let mut sum = S::product(c, &x);
            sum.add_product(d, &y);
            sum
        };
        match self {
            HalfTurn::Even { cos, sin, sin2 } => {
                (form(cos.clone(), sin.clone()), form(-S::product(sin2, sin), cos.clone()))
            }
            HalfTurn::Odd { cos, sin, twice_cos2, twice_sin2 } => (
                form(S::product(twice_cos2, cos), sin.clone()),
                form(-S::product(twice_sin2, sin), cos.clone()),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::{Ratio, ratio};

    #[test]
    fn the_forms_are_those_of_the_half_period_for_every_strength() {
        for ratio_of_steps in Ratio::up_to(14) {
            for (s, k) in [(-3, 2), (5, 9), (20, -7), (36, 1), (40, 3), (47, 11)] {
                let clocks = TwoClocks::new(ratio_of_steps, ratio(s, 10), ratio(k, 10));
                let signs = crate::propagator::half_period(&clocks).signs();
                assert_eq!(exact_forms(&clocks).all(), signs.all(), "{ratio_of_steps}, {s}/10, {k}/10");
                // 512 bits decide all but the edges, and of those nothing false.
                let enclosed = enclosed_forms::<_, 512>(&clocks);
                let edge = matches!(signs.verdict(), Verdict::Parabolic(_) | Verdict::Coexistence(_));
                assert!(
                    enclosed.map_or(edge, |found| found == signs.verdict()),
                    "{ratio_of_steps}, {s}/10, {k}/10"
                );
            }
        }
    }
}
