//! The resonance predictions against the trace, each by its own route.

mod angle;
mod curve;
mod family;
mod proposition;
mod strength;
mod theorems;

use kickdrift::number::rational::ratio;
use kickdrift::number::{Cyclotomic, Ratio, Rational, Ring, Sign};
use kickdrift::propagator::TwoClocks;
use kickdrift::resonance::proposition::check;
use kickdrift::resonance::tan;
use kickdrift::verdict::{Decidable, Kind, Limits, Tier, decide, decide_from};
use num_integer::Integer;
use proptest::prelude::*;
use theorems::{papers_criterion, two_slow_kicks};

fn pair(p: u64, q: u64, s: i64, k: i64) -> TwoClocks<Rational> {
    let g = p.gcd(&q);
    TwoClocks::new(Ratio::new(p / g, q / g).unwrap(), ratio(s, 1000), ratio(k, 1000))
}

/// The trace's verdict by kicks and drifts, without Floquet coordinates.
fn by_trace<S: Decidable>(clocks: &TwoClocks<S>) -> kickdrift::verdict::Verdict {
    decide_from(Tier::Refine, clocks, &Limits::default()).unwrap().verdict
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn the_papers_criterion_is_the_trace_condition(p in 1u64..60, s in 1i64..4000, k in -900i64..900) {
        let clocks = pair(p, 1, s, k);
        let unstable = by_trace(&clocks).kind() == Kind::Hyperbolic;
        prop_assert_eq!(papers_criterion(&clocks), (s < 4000).then_some(unstable));
    }

    #[test]
    fn the_criterion_for_two_slow_kicks_is_the_trace_condition(p in 0u64..30, s in 1i64..4000, k in -900i64..900) {
        let clocks = pair(2 * p + 1, 2, s, k);
        let verdict = by_trace(&clocks);
        let side = if verdict.kind() == Kind::Hyperbolic { verdict.side() } else { 0 };
        let sign = two_slow_kicks(&clocks).map(Sign::to_i8);
        prop_assert_eq!(sign, Some(side));
    }

    #[test]
    fn the_general_criterion_is_the_trace_condition(p in 1u64..50, q in 1u64..50, s in 1i64..4000, k in -2000i64..2000) {
        let clocks = pair(p, q, s, k);
        let verdict = by_trace(&clocks);
        prop_assert_eq!(tan::criterion(&clocks, &Limits::default()).unwrap(), verdict);
        prop_assert_eq!(tan::exact_criterion(&clocks), verdict);
    }
}

#[test]
fn criteria_agree_on_exact_edges() {
    for (s, p) in [(1, 3), (2, 2), (2, 4), (3, 3), (1, 9), (2, 1), (2, 3)] {
        for k in [-100, 0, 100] {
            let clocks = TwoClocks::new(Ratio::new(p, 1).unwrap(), ratio(s, 1), ratio(k, 1000));
            let verdict = Decidable::half_signs(&clocks).verdict();
            assert_eq!(tan::exact_criterion(&clocks), verdict);
            assert_eq!(
                papers_criterion(&clocks),
                Some(verdict.kind() == Kind::Hyperbolic),
                "s={s} p={p} k={k}"
            );
        }
    }
}

/// At the exactly resonant point p th = m pi, in the cyclotomic field: for q = 1 the edge of the tongue is
/// there; for q = 3 the point lies on neither edge.
#[test]
fn resonant_points_are_decided_in_the_cyclotomic_field() {
    let rho = <Cyclotomic as Ring>::from_rational(&ratio(1, 25));
    for (p, q, m) in [(5, 1, 2), (7, 1, 3), (7, 2, 4), (9, 2, 4)] {
        let clocks =
            TwoClocks::with_rho(Ratio::new(p, q).unwrap(), Cyclotomic::resonant_s(m, p as u32), rho.clone());
        let decision = decide(&clocks, &Limits::default()).unwrap();
        assert_eq!(
            (decision.verdict.kind(), decision.decided_by),
            (Kind::Parabolic, Tier::Exact),
            "{p}/{q} {m}"
        );
    }
    let outside = TwoClocks::with_rho("7/3".parse().unwrap(), Cyclotomic::resonant_s(4, 7), rho);
    assert_eq!(decide(&outside, &Limits::default()).unwrap().verdict.kind(), Kind::Elliptic);
}

#[test]
fn the_proposition_holds_exactly_for_all_p_and_q_up_to_60() {
    let check = check(60, |_| ());
    assert_eq!(check.failures, []);
    assert!(check.backward > 100_000);
    // Points: the sum over p of (p - 1) times the number of q <= 60 coprime to p.
    let coprime = |p: u64| (1..=60u64).filter(|q| q.gcd(&p) == 1).count() as u64;
    assert_eq!(check.forward, (1..=60).map(|p| (p - 1) * coprime(p)).sum::<u64>());
}

/// For s > 4 the turns grow, and some thousand bits of balls are lost; exact arithmetic over Q[π] would take
/// minutes, and is beyond this budget.
#[test]
fn beyond_the_verlet_limit_balls_decide_the_tan_criterion() {
    let x = |text| kickdrift::number::parse::parse("x", text).unwrap();
    let oscillator =
        kickdrift::propagator::Oscillator::new(x("pi^2"), x("3/2"), x("20/31"), x("7/17")).unwrap();
    let (clocks, limits) = (oscillator.clocks().unwrap(), Limits { kicks: 1000 });
    assert!(Decidable::exact_cost(&clocks, clocks.ratio().kicks()) > limits.kicks);
    assert_eq!(tan::criterion(&clocks, &limits).unwrap(), by_trace(&clocks));
}
