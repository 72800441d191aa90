//! A cheap proof that no entry of the half period vanishes: its residue does not.
//!
//! Over Q\[π\] an entry is a polynomial in π with rational coefficients, and zero iff all coefficients are.
//! Send π to some residue g modulo a prime p that divides no denominator: a ring homomorphism. Where the
//! image is not 0, the entry is not 0. The converse fails with a chance of about degree/p.

use num_bigint::BigInt;

use crate::propagator::TwoClocks;
use crate::schedule::{KickDrift, Kicks, Schedule};
use number::{Laurent, PrimeField, Rational};

/// Any prime field will do.
const FIELD: PrimeField = PrimeField::LARGEST;

/// Where π goes; any residue will do.
const PI: u64 = 0x0123_4567_89ab_cdef;

/// Whether none of A, B, C, D is zero, as far as residues show.
pub fn nonzero_entries(clocks: &TwoClocks<Laurent>) -> bool {
    entries(clocks).is_some_and(|entries| entries.into_iter().flatten().all(|entry| entry != 0))
}

/// H modulo p in the time unit of one tick; `None` where p divides a denominator.
fn entries(clocks: &TwoClocks<Laurent>) -> Option<[[u64; 2]; 2]> {
    let schedule = Schedule::two_clocks(clocks.ratio()).ok()?;
    let per_tick = FIELD.of_rational(&(schedule.tick() / BigInt::from(2)))?;
    let half = |k: &Laurent| residue(k).map(|k| FIELD.mul(k, per_tick));
    let (fast, slow) = (half(clocks.fast())?, half(clocks.slow())?);
    let kicks =
        Kicks::of_two_clocks([fast, slow, FIELD.add(fast, slow)], |half| [FIELD.add(half, half), half]);
    let one = FIELD.of(1);
    let mut residues = Residues([[one, 0], [0, one]]);
    kicks.lead(schedule.half_period(), &mut residues);
    Some(residues.0)
}

/// The product so far.
struct Residues([[u64; 2]; 2]);

impl KickDrift<u64> for Residues {
    fn drift(&mut self, ticks: u64) {
        let ([xs, vs], ticks) = (&mut self.0, FIELD.of(ticks));
        xs.iter_mut().zip(vs).for_each(|(x, v)| *x = FIELD.add(*x, FIELD.mul(ticks, *v)));
    }

    fn kick(&mut self, strength: &u64) {
        let [xs, vs] = &mut self.0;
        xs.iter_mut().zip(vs).for_each(|(x, v)| *v = FIELD.sub(*v, FIELD.mul(*strength, *x)));
    }
}

/// The image of Σ c_k π^k.
fn residue(x: &Laurent) -> Option<u64> {
    let term = |(k, c): &(i32, Rational)| {
        let base = if *k < 0 { FIELD.invert(PI) } else { PI };
        Some(FIELD.mul(FIELD.of_rational(c)?, FIELD.power(base, k.unsigned_abs().into())))
    };
    x.terms().iter().map(term).try_fold(0, |sum, term| Some(FIELD.add(sum, term?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagator::half_period;
    use number::Ratio;
    use number::Ring;
    use number::parse::parse;

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
