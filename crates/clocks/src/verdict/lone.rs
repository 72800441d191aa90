//! One clock alone: where the other one's kicks are zero, the verdict is a closed form.
//!
//! n kicks of strength s a period, cos θ = 1 − s/2. Q is conjugate to a turn by nθ for 0 < s < 4, so stable;
//! it is ±I where nθ is a multiple of π. For a rational s that is so at s = 1, 2 and 3 alone (Niven), and for
//! no transcendental one; cyclotomic numbers are left to the exact tier. For s < 0 and s > 4, θ or θ − π is
//! imaginary: Tr Q = 2 cosh or (−1)^n 2 cosh. At s = 4 Q is (−1)^n times a shear, and where neither clock
//! kicks it is a drift.

use super::kind::{Side, Verdict};
use crate::orbit::floquet::turn_signs;
use crate::propagator::TwoClocks;
use number::{Ball, Rational, Real, Sign};

/// Bits of s.
const BITS: u32 = 192;

/// The verdict of a pair one of whose clocks does nothing; `None` where both do something, and where Q may be
/// ±I at a cyclotomic s.
pub(super) fn verdict<S: Real>(clocks: &TwoClocks<S>) -> Option<Verdict> {
    let idle = S::is_zero;
    // A strength is per unit h1: the slow clock's own is λ2 h2² = (λ2 h1 h2)(p/q).
    match (idle(clocks.fast()), idle(clocks.slow())) {
        (false, true) => alone(clocks.fast(), clocks.p()),
        (true, false) => alone(clocks.swapped().fast(), clocks.q()),
        (true, true) => Some(Verdict::Parabolic(Side::Plus)),
        (false, false) => None,
    }
}

fn alone<S: Real>(exact: &S, n: u64) -> Option<Verdict> {
    let s = exact.enclosure(BITS);
    let is = |k: u64| {
        let k = Rational::from_integer(k.into());
        s.contains(&k) && (exact.clone() + -S::from_rational(&k)).sign() == Sign::Zero
    };
    // θ = π share/whole.
    for (s, share, whole) in [(1, 1, 3), (2, 1, 2), (3, 2, 3)] {
        if is(s) {
            let turns = Some(n / whole * share).filter(|_| n.is_multiple_of(whole));
            return Some(turns.map_or(Verdict::Elliptic, |m| Verdict::Coexistence(Side::of_half_turns(m))));
        }
    }
    if is(4) {
        return Some(Verdict::Parabolic(Side::of_half_turns(n)));
    }
    let s = &s;
    let beyond = s.sub(&Ball::from_integer(&4.into()), BITS).sign()?;
    match (s.sign()?, beyond) {
        (Sign::Negative, _) => Some(Verdict::Hyperbolic(Side::Plus)),
        (_, Sign::Positive) => Some(Verdict::Hyperbolic(Side::of_half_turns(n))),
        (Sign::Positive, Sign::Negative) => {
            let certain =
                turn_signs(s, n)?.iter().all(|sign| matches!(sign, Some(sign) if *sign != Sign::Zero));
            certain.then_some(Verdict::Elliptic)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::{Limits, Tier, decide_from};
    use number::{Cyclotomic, Ratio, Ring, ratio};

    #[test]
    fn the_closed_form_is_what_kicks_and_drifts_give() {
        let mut edges = 0;
        for (p, q) in [(1, 1), (5, 3), (4, 3), (3, 8), (12, 1), (1, 7), (101, 64)] {
            for s in [-3, -1, 1, 8, 10, 20, 25, 30, 39, 40, 41, 77] {
                let zero = Rational::from_integer(0.into());
                let fast = TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, 10), zero.clone());
                for clocks in [fast.swapped(), fast] {
                    let slow_way = decide_from(Tier::Refine, &clocks, &Limits::default()).unwrap().verdict;
                    assert_eq!(verdict(&clocks), Some(slow_way), "{p}/{q}, s = {s}/10, {clocks:?}");
                    edges += u32::from(matches!(slow_way, Verdict::Parabolic(_) | Verdict::Coexistence(_)));
                }
            }
        }
        // s = 4 always, s = 1, 2, 3 where n theta is a multiple of pi.
        assert!(edges > 20, "{edges}");
        let still = TwoClocks::new("5/3".parse().unwrap(), Rational::default(), Rational::default());
        let slow_way = decide_from(Tier::Refine, &still, &Limits::default()).unwrap().verdict;
        assert_eq!(verdict(&still), Some(slow_way));
    }

    #[test]
    fn the_other_cases_are_left_to_others() {
        assert_eq!(verdict(&TwoClocks::new("5/3".parse().unwrap(), ratio(1, 1), ratio(1, 9))), None);
        // n theta = 2 pi at a cyclotomic s: Q = I.
        let (s, zero) =
            (Cyclotomic::resonant_s(2, 5), <Cyclotomic as Ring>::from_rational(&Rational::default()));
        assert_eq!(verdict(&TwoClocks::new("5/3".parse().unwrap(), s, zero)), None);
    }
}
