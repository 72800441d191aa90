//! A cheap proof that no entry of the half period vanishes: its residue does not.
//!
//! Over Q\[π\] an entry is a polynomial in π with rational coefficients, and zero iff all coefficients are. Send
//! π to some residue g modulo a prime P that divides no denominator: a ring homomorphism. Where the image is not
//! 0, the entry is not 0. The converse fails with a chance of about degree/P.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::ToPrimitive;

use crate::number::{Laurent, Rational};
use crate::propagator::TwoClocks;
use crate::schedule::{Schedule, Weight};

/// 2^61 − 1, a prime.
const P: u64 = (1 << 61) - 1;

/// Where π goes; any residue will do.
const G: u64 = 0x0123_4567_89ab_cdef;

/// Whether none of A, B, C, D is zero, as far as residues show.
pub fn nonzero_entries(clocks: &TwoClocks<Laurent>) -> bool {
    entries(clocks).is_some_and(|entries| entries.into_iter().flatten().all(|entry| entry != 0))
}

/// H modulo P in the time unit of one tick; `None` where P divides a denominator.
fn entries(clocks: &TwoClocks<Laurent>) -> Option<[[u64; 2]; 2]> {
    let schedule = Schedule::two_clocks(clocks.ratio()).ok()?;
    let per_tick = inverse(2 * schedule.clocks()[0].step() % P)?;
    let half = |k: &Laurent| residue(k).map(|k| times(k, per_tick));
    let (fast, slow) = (half(clocks.fast())?, half(clocks.slow())?);
    let strengths = [0, fast, slow, (fast + slow) % P];
    let mut m = [[1, 0], [0, 1]];
    for event in schedule.half_period() {
        let halves = if event.weight == Weight::Full { 2 } else { 1 };
        let strength = times(strengths[event.kicks as usize], halves);
        let [xs, vs] = &mut m;
        for (x, v) in xs.iter_mut().zip(vs) {
            *x = (*x + times(event.drift % P, *v)) % P;
            *v = (*v + P - times(strength, *x)) % P;
        }
    }
    Some(m)
}

/// The image of Σ c_k π^k.
fn residue(x: &Laurent) -> Option<u64> {
    let term = |(k, c): &(i32, Rational)| {
        let base = if *k < 0 { inverse(G)? } else { G };
        Some(times(
            times(of_integer(c.numer()), inverse(of_integer(c.denom()))?),
            power(base, k.unsigned_abs().into()),
        ))
    };
    x.terms().iter().map(term).try_fold(0, |sum, term| Some((sum + term?) % P))
}

fn of_integer(n: &BigInt) -> u64 {
    n.mod_floor(&P.into()).to_u64().expect("a residue below 2^61")
}

fn times(x: u64, y: u64) -> u64 {
    (u128::from(x) * u128::from(y) % u128::from(P)) as u64
}

fn power(mut x: u64, mut n: u64) -> u64 {
    let mut result = 1;
    while n > 0 {
        if n & 1 == 1 {
            result = times(result, x);
        }
        x = times(x, x);
        n >>= 1;
    }
    result
}

/// By Fermat's little theorem.
fn inverse(x: u64) -> Option<u64> {
    (x != 0).then(|| power(x, P - 2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Ratio;
    use crate::number::Ring;
    use crate::number::parse::parse;
    use crate::propagator::half_period;

    fn clocks(ratio: Ratio, fast: &str, slow: &str) -> TwoClocks<Laurent> {
        TwoClocks::new(ratio, parse("fast", fast).unwrap(), parse("slow", slow).unwrap())
    }

    #[test]
    fn residues_of_the_exact_half_period() {
        for (p, q, fast, slow) in
            [(3, 2, "pi^2/7", "1/pi + 2"), (5, 3, "2/pi", "-pi/3"), (1, 4, "pi", "pi^3/5")]
        {
            let clocks = clocks(Ratio::new(p, q).unwrap(), fast, slow);
            let half = half_period(&clocks);
            let [[a, _], [_, d]] = entries(&clocks).unwrap();
            // A and D have no unit of time.
            assert_eq!([Some(a), Some(d)], [residue(half.a()), residue(half.d())]);
            assert!(nonzero_entries(&clocks));
        }
    }

    #[test]
    fn a_zero_is_never_called_nonzero() {
        // Strength s + slow = pi + (4 − pi) = 4 in one kick: an entry vanishes identically.
        let clocks = clocks(Ratio::ONE, "pi", "4 - pi");
        assert!(!nonzero_entries(&clocks));
        assert_eq!(Laurent::product(half_period(&clocks).a(), half_period(&clocks).d()).to_string(), "0");
    }
}
