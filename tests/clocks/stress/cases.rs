//! Cases by the thousand, each against exact rational arithmetic.

use kickdrift::number::rational::{from_f64_exact, ratio};
use kickdrift::number::{Ratio, Rational};
use kickdrift::propagator::{TwoClocks, half_period};
use kickdrift::verdict::{Decidable, Kind, Limits, Tier, decide, filter_trace};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};
use rayon::prelude::*;

use crate::stress::random::Random;
use crate::stress::record::Record;

/// Coprime numbers up to `most`.
fn coprime(random: &mut Random, most: u64) -> (u64, u64) {
    loop {
        let (p, q) = (1 + random.below(most), 1 + random.below(most));
        if p.gcd(&q) == 1 {
            return (p, q);
        }
    }
}

/// One pair, by the ladder and by exact arithmetic.
fn check(clocks: &TwoClocks<Rational>) -> Record {
    let decision = decide(clocks, &Limits::default()).expect("a short period");
    let exact = Decidable::half_signs(clocks).verdict();
    let mut record = Record { cases: 1, wrong: u64::from(decision.verdict != exact), ..Record::default() };
    record.by_tier[decision.decided_by as usize] = 1;
    record.ties = u64::from(matches!(exact.kind(), Kind::Parabolic | Kind::Coexistence));
    // A clock alone turns by a rational part of pi where it ties, which is known without its kicks.
    let is_alone = clocks.fast().is_zero() || clocks.slow().is_zero();
    let by_exact = decision.decided_by == Tier::Exact || is_alone;
    assert!(record.ties == 0 || by_exact, "only exact arithmetic knows a zero: {clocks:?}");
    record
}

/// The filter's trace against the exact one.
fn check_trace(clocks: &TwoClocks<Rational>) -> Record {
    let Some(enclosure) = filter_trace(clocks) else { return Record::default() };
    let trace = half_period(clocks).trace();
    let half = ratio(1, 2);
    let (mid, radius) =
        ((enclosure.lower() + enclosure.upper()) * &half, (enclosure.upper() - enclosure.lower()) * &half);
    let worst_ratio = ((trace.clone() - mid).abs() / radius).to_f64().expect("finite");
    Record {
        enclosures: 1,
        outside: u64::from(!enclosure.contains(&trace)),
        worst_ratio,
        ..Record::default()
    }
}

/// Pairs of all strengths: p, q <= 40, s in (0, 5], the slow kick of either sign and any size up to 8.
pub fn random(seed: u64, cases: u64) -> Record {
    const BATCH: u64 = 1000;
    let batch = |n: u64| {
        let mut random = Random::new(seed.wrapping_add(n.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        let mut record = Record::default();
        for case in 0..BATCH.min(cases - n * BATCH) {
            let ((p, q), scale) = (coprime(&mut random, 40), 1i64 << random.below(12));
            let s = ratio(1 + random.below(5 * 64) as i64, 64);
            let k = ratio(random.below(2 * 8 * 64) as i64 - 8 * 64, 64 * scale);
            let clocks = TwoClocks::new(Ratio::new(p, q).unwrap(), s, k);
            record = record.join(check(&clocks));
            if case % 50 == 0 {
                record = record.join(check_trace(&clocks));
            }
        }
        record
    };
    (0..cases.div_ceil(BATCH)).into_par_iter().map(batch).reduce(Record::default, Record::join)
}

/// About each of many edges in s, found by bisection in exact arithmetic down to two neighbouring doubles:
/// the doubles up to 40 steps to either side, and 10^-k beside the last stable one for k = 1 ... 40.
pub fn adversarial(seed: u64, cases: u64) -> Record {
    const AROUND: u64 = 40;
    const EACH: u64 = 2 * AROUND + 1 + 40;
    let edge = |n: u64| {
        let mut random = Random::new(seed.wrapping_add(n.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        let pair = Pair::new(&mut random);
        let stable = pair.edge(&mut random);
        let mut record = Record::default();
        for step in 0..=2 * AROUND {
            let bits = stable.to_bits() + step - AROUND;
            record = record.join(check(&pair.at(from_f64_exact(f64::from_bits(bits)).expect("finite"))));
        }
        for k in 1..=40u32 {
            let hair = Rational::new(1.into(), BigInt::from(10).pow(k));
            let base = from_f64_exact(stable).expect("finite");
            let s = if random.below(2) == 0 { base + hair } else { base - hair };
            record = record.join(check(&pair.at(s)));
        }
        record.join(check_trace(&pair.at(from_f64_exact(stable).expect("finite"))))
    };
    (0..cases.div_ceil(EACH)).into_par_iter().map(edge).reduce(Record::default, Record::join)
}

/// A ratio and rho.
struct Pair {
    ratio: Ratio,
    rho: Rational,
}

impl Pair {
    fn new(random: &mut Random) -> Pair {
        let (p, q) = coprime(random, 24);
        let rho = ratio(1 + random.below(60) as i64, 1 + random.below(200) as i64);
        Pair { ratio: Ratio::new(p, q).expect("two positive numbers"), rho }
    }

    fn at(&self, s: Rational) -> TwoClocks<Rational> {
        TwoClocks::with_rho(self.ratio, s, self.rho.clone())
    }

    fn stable(&self, s: f64) -> bool {
        let s = from_f64_exact(s).expect("finite");
        Decidable::half_signs(&self.at(s)).verdict().is_stable()
    }

    /// The last stable double beside an edge in 0 < s < 4.
    fn edge(&self, random: &mut Random) -> f64 {
        loop {
            let [one, other] = [(); 2].map(|()| random.below(4_000_000_000) as f64 * 1e-9 + 1e-10);
            if self.stable(one) == self.stable(other) {
                continue;
            }
            let (stable, unstable) = if self.stable(one) { (one, other) } else { (other, one) };
            // Positive doubles are ordered as their bits.
            let (mut inside, mut beyond) = (stable.to_bits(), unstable.to_bits());
            while inside.abs_diff(beyond) > 1 {
                let middle = inside.min(beyond) + inside.abs_diff(beyond) / 2;
                if self.stable(f64::from_bits(middle)) { inside = middle } else { beyond = middle }
            }
            return f64::from_bits(inside);
        }
    }
}
