//! One clock alone: where the other one's kicks are zero, the verdict is a closed form.
//!
//! n kicks of strength s a period, cos θ = 1 − s/2. Q is conjugate to a turn by nθ for 0 < s < 4, so stable; it is
//! ±I where nθ is a multiple of π, which is left to the exact tier. For s < 0 and s > 4, θ or θ − π is imaginary:
//! Tr Q = 2 cosh or (−1)^n 2 cosh.

use super::kind::{Side, Verdict};
use crate::number::{Ball, Real, Sign};
use crate::orbit::floquet::turn_signs;
use crate::propagator::TwoClocks;

/// Bits of s.
const BITS: u32 = 192;

/// The verdict of a pair one of whose clocks does nothing; `None` where both do something, where neither does, and
/// where Q may be ±I or s = 4.
pub(super) fn verdict<S: Real>(clocks: &TwoClocks<S>) -> Option<Verdict> {
    let idle = |x: &Ball| x.sign() == Some(Sign::Zero);
    let (fast, slow) = (clocks.fast().enclosure(BITS), clocks.slow().enclosure(BITS));
    // A strength is per unit h1: the slow clock's own is λ2 h2² = (λ2 h1 h2)(p/q).
    match (idle(&fast), idle(&slow)) {
        (false, true) => alone(&fast, clocks.p()),
        (true, false) => alone(&clocks.swapped().fast().enclosure(BITS), clocks.q()),
        _ => None,
    }
}

fn alone(s: &Ball, n: u64) -> Option<Verdict> {
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
    use crate::number::Ratio;
    use crate::number::Rational;
    use crate::number::rational::ratio;
    use crate::verdict::{Limits, Tier, decide_from};

    #[test]
    fn the_closed_form_is_what_kicks_and_drifts_give() {
        let mut decided = 0;
        for (p, q) in [(1, 1), (5, 3), (4, 3), (3, 8), (12, 1), (1, 7), (101, 64)] {
            for s in [-3, -1, 1, 8, 10, 25, 39, 41, 77] {
                let zero = Rational::from_integer(0.into());
                let fast = TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, 10), zero.clone());
                for clocks in [fast.swapped(), fast] {
                    let Some(verdict) = verdict(&clocks) else { continue };
                    let slow_way = decide_from(Tier::Refine, &clocks, &Limits::default()).unwrap().verdict;
                    assert_eq!(verdict, slow_way, "{p}/{q}, s = {s}/10, {clocks:?}");
                    decided += 1;
                }
            }
        }
        // s = 1 is theta = pi/3: Q = ±I for some of the n.
        assert!(decided > 110 && decided < 126, "{decided}");
    }

    #[test]
    fn the_other_cases_are_left_to_others() {
        let zero = Rational::from_integer(0.into());
        for (s, k) in [(ratio(1, 1), ratio(1, 9)), (zero.clone(), zero.clone()), (ratio(4, 1), zero.clone())]
        {
            assert_eq!(verdict(&TwoClocks::new("5/3".parse().unwrap(), s, k)), None);
        }
        // n theta = pi: Q = -I.
        assert_eq!(verdict(&TwoClocks::new("3/2".parse().unwrap(), ratio(1, 1), zero)), None);
    }
}
