//! The ladder: every tier right, every tier's certificate honest.

mod kind;
mod long;
mod nodes;

use kickdrift::number::rational::ratio;
use kickdrift::number::{Ratio, Rational, Real, Sign, parse};
use kickdrift::propagator::{Oscillator, TwoClocks, full_period, half_period};
use kickdrift::verdict::{Decidable, Kind, Limits, Tier, decide, decide_from, growth};
use num_integer::Integer;
use num_traits::{One, Signed};
use proptest::prelude::*;

fn lowest(p: u64, q: u64) -> (u64, u64) {
    (p / p.gcd(&q), q / p.gcd(&q))
}

/// Pairs weak and strong, p below and above q, negative slow stiffness included.
fn pair() -> impl Strategy<Value = TwoClocks<Rational>> {
    let stiffness = prop_oneof![1i64..100, 100i64..3999, 3999i64..9000];
    (1u64..80, 1u64..80, stiffness, prop_oneof![-20i64..20, -3000i64..3000]).prop_map(|(p, q, s, k)| {
        let (p, q) = lowest(p, q);
        TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, 1000), ratio(k, 1000))
    })
}

fn kind_at(p: u64, q: u64, s: Rational, rho: Rational) -> (Kind, i8) {
    let decision =
        decide(&TwoClocks::with_rho(Ratio::new(p, q).unwrap(), s, rho), &Limits::default()).unwrap();
    (decision.verdict.kind(), decision.verdict.side())
}

/// ± 10^-40.
fn hair() -> Rational {
    Rational::new(One::one(), num_bigint::BigInt::from(10).pow(40))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    // Ledger: verdict; 1000 random pairs, new in each run, by every tier; the exact product over the full
    // period
    #[test]
    fn all_tiers_agree_with_the_full_product(clocks in pair()) {
        let trace = full_period(&clocks).trace();
        let distance = trace.abs() - ratio(2, 1);
        for tier in [Tier::Filter, Tier::Refine, Tier::Exact] {
            let decision = decide_from(tier, &clocks, &Limits::default()).unwrap();
            prop_assert!(decision.decided_by >= tier);
            match Sign::from_ordering(distance.cmp(&ratio(0, 1))) {
                Sign::Negative => prop_assert_eq!(decision.verdict.kind(), Kind::Elliptic),
                Sign::Positive => prop_assert_eq!(decision.verdict.kind(), Kind::Hyperbolic),
                Sign::Zero => prop_assert!(matches!(decision.verdict.kind(), Kind::Parabolic | Kind::Coexistence)),
            }
            let side = if distance.is_negative() { 0 } else { trace.signum().to_integer().try_into().unwrap() };
            prop_assert_eq!(decision.verdict.side(), side);
        }
    }

    // Ledger: growth; 1000 random pairs, new in each run; the exact trace
    #[test]
    fn the_trace_enclosure_holds_the_exact_trace(clocks in pair()) {
        let verdict = Decidable::half_signs(&clocks).verdict();
        let growth = growth(&clocks, verdict, &Limits::default()).unwrap();
        let trace = half_period(&clocks).trace();
        prop_assert!(growth.trace.contains(&trace));
        if let Some(ln) = growth.ln_multiplier {
            // |Tr| = 2 cosh(ln mu); compare by exp in many bits.
            let mu = ln.exp(256);
            let back = mu.add(&kickdrift::number::Ball::one().div(&mu, 256).unwrap(), 256);
            prop_assert!(back.contains(&trace.abs()));
        }
    }

    #[test]
    fn scaling_time_changes_nothing(h1 in 1i64..50, h2 in 1i64..50, l1 in 1i64..40, l2 in -10i64..40, c in 1i64..9) {
        let decide_at = |c: Rational| {
            let laurent = |x: Rational| kickdrift::number::Laurent::from_rational(x);
            let square = &c * &c;
            let oscillator = Oscillator::new(
                laurent(ratio(l1, 3) / &square), laurent(ratio(l2, 7) / &square),
                laurent(ratio(h1, 29) * &c), laurent(ratio(h2, 29) * &c),
            ).unwrap();
            decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict
        };
        prop_assert_eq!(decide_at(ratio(1, 1)), decide_at(ratio(c, 5)));
    }
}

#[test]
fn rational_edges_are_parabolic_and_a_hair_off_they_are_not() {
    // th = pi/3, pi/2, 2 pi/3 with q = 1 and p th = m pi: the upper edge of tongue m is exactly there.
    for (s, p) in [(1, 3), (1, 6), (2, 2), (2, 4), (3, 3), (3, 6), (1, 300), (2, 1000)] {
        let rho = ratio(1, 50);
        let (kind, side) = kind_at(p, 1, ratio(s, 1), rho.clone());
        assert_eq!(kind, Kind::Parabolic, "s = {s}, p = {p}");
        assert_eq!(kind_at(p, 1, ratio(s, 1) - hair(), rho.clone()), (Kind::Hyperbolic, side));
        assert_eq!(kind_at(p, 1, ratio(s, 1) + hair(), rho), (Kind::Elliptic, 0));
        // Without the slow force the tongue is closed.
        assert_eq!(kind_at(p, 1, ratio(s, 1), ratio(0, 1)), (Kind::Coexistence, side));
        assert_eq!(kind_at(p, 1, ratio(s, 1) + hair(), ratio(0, 1)), (Kind::Elliptic, 0));
    }
}

#[test]
fn velocity_verlet_ends_at_s_equal_4() {
    let at = |s: Rational| kind_at(1, 1, s, ratio(0, 1));
    assert_eq!(at(ratio(4, 1) - hair()), (Kind::Elliptic, 0));
    assert_eq!(at(ratio(4, 1)), (Kind::Parabolic, -1));
    assert_eq!(at(ratio(4, 1) + hair()), (Kind::Hyperbolic, -1));
}

#[test]
fn the_closing_of_5_3_is_the_identity_and_a_hair_off_it_is_not() {
    let (s, rho) = (ratio(11, 4), ratio(114, 55));
    assert_eq!(kind_at(5, 3, s.clone(), rho.clone()), (Kind::Coexistence, 1));
    let half = half_period(&TwoClocks::with_rho("5/3".parse().unwrap(), s.clone(), rho.clone()));
    assert_eq!((half.a(), half.d()), (&ratio(9, 4), &ratio(4, 9)));
    assert_eq!(kind_at(5, 3, s + hair(), rho).0, Kind::Elliptic);
}

#[test]
fn exact_ties_over_q_pi_are_decided() {
    // One kick a period of strength s + slow = pi + (4 - pi) = 4: parabolic, and only exactly so.
    let x = |text| parse::parse("x", text).unwrap();
    let at = |lambda2| {
        let oscillator = Oscillator::new(x("pi"), x(lambda2), x("1"), x("1")).unwrap();
        decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap()
    };
    assert_eq!((at("4 - pi").verdict.kind(), at("4 - pi").decided_by), (Kind::Parabolic, Tier::Exact));
    assert_eq!(at("4 - pi - 1e-40").verdict.kind(), Kind::Elliptic);
    assert_eq!(at("4 - pi + 1e-40").verdict.kind(), Kind::Hyperbolic);
    // s = h1^2 lambda1 can be rational though neither factor is.
    let verlet = Oscillator::new(x("4/pi^2"), x("0"), x("pi"), x("2*pi")).unwrap();
    assert_eq!(
        decide(&verlet.clocks().unwrap(), &Limits::default()).unwrap().verdict.kind(),
        Kind::Parabolic
    );
}

/// Steps and stiffnesses at the ends of any float's range: decided, with the trace and the growth enclosed.
#[test]
fn extreme_scales_are_decided() {
    let x = |text| parse::parse("x", text).unwrap();
    for (lambda1, lambda2, h1, h2, kind) in [
        ("1e-300", "1", "1e-300", "3e-300", Kind::Elliptic),
        ("pi", "1", "1e-300", "3e-300", Kind::Elliptic),
        ("1e300", "pi", "1e300", "3e300", Kind::Hyperbolic),
        ("1e300", "-1e300", "1e300", "1e300", Kind::Parabolic),
        ("2", "1e-300", "1", "5/3", Kind::Elliptic),
        ("2", "1e300", "1", "5/3", Kind::Hyperbolic),
        ("1e-600", "pi", "1e290", "2e290", Kind::Hyperbolic),
    ] {
        let clocks = Oscillator::new(x(lambda1), x(lambda2), x(h1), x(h2)).unwrap().clocks().unwrap();
        let verdict = decide(&clocks, &Limits::default()).unwrap().verdict;
        assert_eq!(verdict.kind(), kind, "{lambda1} {lambda2} {h1} {h2}");
        let growth = growth(&clocks, verdict, &Limits::default()).unwrap();
        let trace = half_period(&clocks).trace().enclosure(256);
        assert!(growth.trace.lower() <= trace.lower() && trace.upper() <= growth.trace.upper());
        assert_eq!(growth.label.is_some(), kind == Kind::Hyperbolic);
        assert_eq!(growth.ln_multiplier.is_some(), kind == Kind::Hyperbolic);
    }
}

/// Fifty updates decide; trace and label would take fifty thousand kicks.
#[test]
fn growth_is_computed_only_when_it_is_asked_for() {
    let clocks = TwoClocks::with_rho("100003/101".parse().unwrap(), ratio(1, 7), ratio(1, 25_000_000));
    let answer = decide(&clocks, &Limits { kicks: 1000 }).unwrap();
    assert_eq!(answer.decided_by, Tier::Filter);
    assert_eq!(answer.growth().unwrap_err().needed(), Some(50_052));
    assert_eq!(answer.trace().unwrap_err().needed(), Some(50_052));
}

#[test]
fn labels_count_half_turns() {
    // r-RESPA below its m-th resonance p th = m pi.
    for (p, m, s) in [(3, 1, 0.99), (3, 2, 2.99), (2, 1, 1.98)] {
        let s = Rational::from_float(s).unwrap();
        let clocks = TwoClocks::with_rho(Ratio::new(p, 1).unwrap(), s, ratio(1, 10));
        let verdict = decide(&clocks, &Limits::default()).unwrap().verdict;
        assert_eq!(growth(&clocks, verdict, &Limits::default()).unwrap().label, Some(m));
    }
}

/// 10^11 and 10^16 kicks, with label and growth.
#[test]
fn periods_that_nobody_follows_kick_by_kick_are_decided_at_once() {
    let x = |text| parse::parse("x", text).unwrap();
    for (h1, h2) in [("0.333333333333", "0.98"), ("0.31830988618379067", "1.4142135623730951")] {
        let pair = Oscillator::new(x("pi^2"), x("pi^2/25"), x(h1), x(h2)).unwrap();
        let answer = decide(&pair.clocks().unwrap(), &Limits::default()).unwrap();
        let growth = answer.growth().unwrap();
        assert_eq!(growth.ln_multiplier.is_some(), !answer.verdict.is_stable());
        assert_eq!(growth.label.is_some(), !answer.verdict.is_stable());
        // The resonance that the label names lies near: m θ-turns of the fast clock alone, less than one
        // tongue's width away.
        if let Some(m) = growth.label {
            let (h1, p) = (pair.h1().enclosure(64).mid_f64(), pair.clocks().unwrap().p() as f64);
            let theta = 2.0 * (0.5 * h1 * std::f64::consts::PI).asin();
            assert!((m as f64 - p * theta / std::f64::consts::PI).abs() < 0.1 * p, "{h1} {m}");
        }
    }
}

#[test]
fn a_period_beyond_the_budget_is_refused_before_it_begins() {
    let clocks =
        TwoClocks::with_rho(Ratio::new(1_000_000_001, 1_000_000_000).unwrap(), ratio(5, 1), ratio(1, 1));
    // Both clocks are beyond their own limits, and return maps decide all the same.
    assert_eq!(decide(&clocks, &Limits::default()).unwrap().verdict.kind(), Kind::Hyperbolic);
    let error = decide_from(Tier::Exact, &clocks, &Limits::default()).unwrap_err();
    assert!(error.needed() >= Some(1_000_000_000), "{error}");
}
/// A strength of 10^90 leaves the bound of the refine tier no room at any precision: balls tell the signs,
/// where exact arithmetic would multiply polynomials of degree 150 with every kick.
#[test]
fn high_powers_of_pi_are_decided_without_exact_arithmetic() {
    let x = |text| parse::parse("x", text).unwrap();
    for h2 in ["1/40", "7/400", "33/2000", "1"] {
        let clocks = Oscillator::new(x("(1+pi)^150"), x("1"), x("1/100"), x(h2)).unwrap().clocks().unwrap();
        // Below what exact arithmetic would cost: it is refused by this budget.
        let limits = Limits { kicks: 100_000 };
        let answer = decide(&clocks, &limits).unwrap();
        assert_eq!((answer.verdict.kind(), answer.decided_by), (Kind::Hyperbolic, Tier::Refine), "{h2}");
        assert!(answer.growth().unwrap().ln_multiplier.as_ref().unwrap().relative_accuracy_bits() >= 50);
        if h2 == "1/40" {
            assert_eq!(answer.verdict, half_period(&clocks).signs().verdict());
        }
    }
}

#[test]
fn exact_arithmetic_tells_what_many_powers_of_pi_cost() {
    let x = |text| parse::parse("x", text).unwrap();
    let clocks =
        |lambda1| Oscillator::new(x(lambda1), x("1"), x("1/100"), x("33/2000")).unwrap().clocks().unwrap();
    // Minutes, against milliseconds of one power: each of some 27 kicks multiplies by 151 of them.
    assert_eq!(Decidable::exact_cost(&clocks("pi^150"), 27), 27 * 27 * 27);
    let (dear, limits) = (clocks("(1+pi)^150"), Limits::default());
    assert_eq!(Decidable::exact_cost(&dear, 27), 27 * 27 * 27 * 151 * 151);
    assert!(
        decide_from(Tier::Exact, &dear, &limits)
            .unwrap_err()
            .needed()
            .is_some_and(|cost| cost > limits.kicks)
    );
}

/// Half turns a period, kick by kick in doubles: after one period any start has turned into the solution that
/// grows, if it grows much, and x is linear between kicks, so each change of its sign shows at the next kick.
fn half_turns(p: u64, q: u64, fast: f64, slow: f64) -> u64 {
    let (mut x, mut v, mut changes) = (1.0_f64, 0.3_f64, 0);
    for _ in 0..2 {
        let (mut now, mut next, mut changed) = (0, [0, 0], 0);
        while now < p * q {
            // In ticks of 1/q the fast clock strikes every q, the slow one every p.
            v -= x * (if next[0] == now { fast } else { 0.0 } + if next[1] == now { slow } else { 0.0 });
            next = [(now / q + 1) * q, (now / p + 1) * p];
            let until = next[0].min(next[1]);
            let before = x;
            x += v * (until - now) as f64 / q as f64;
            changed += u64::from(x * before < 0.0);
            now = until;
            let size = x.hypot(v);
            (x, v) = (x / size, v / size);
        }
        changes = changed;
    }
    changes
}

// Ledger: label; 40 random long periods, seed 7; half turns counted kick by kick
/// Both clocks beyond their own limits, or the fast one, or none: labels of long periods come from return
/// maps, or from kicks where these lose the turns.
#[test]
fn hyperbolic_pairs_of_long_periods_have_the_label_that_their_kicks_count() {
    let mut seed = 7u64;
    let mut random = |n: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % n
    };
    let mut seen = 0;
    while seen < 40 {
        let (p, q) = (16_384 + random(9000), 16_384 + random(9000));
        let (s, rho) = (ratio(1 + random(160) as i64, 10), ratio(1 + random(30) as i64, 10));
        if p.gcd(&q) != 1 {
            continue;
        }
        let clocks = TwoClocks::with_rho(Ratio::new(p, q).unwrap(), s, rho);
        let answer = decide(&clocks, &Limits::default()).unwrap();
        let growth = answer.growth().unwrap();
        // By e^50 and more, so that what decays is below a rounding after one period.
        if growth.ln_multiplier.as_ref().is_none_or(|ln| ln.mid_f64() < 50.0) {
            continue;
        }
        let [fast, slow] = [clocks.fast(), clocks.slow()].map(|k| k.enclosure(64).mid_f64());
        assert_eq!(growth.label, Some(half_turns(p, q, fast, slow)), "{p}/{q} {clocks:?}");
        seen += 1;
    }
    let at = |p, q| TwoClocks::with_rho(Ratio::new(p, q).unwrap(), ratio(8, 1), ratio(1, 8));
    assert_eq!(decide(&at(16411, 16421), &Limits::default()).unwrap().label().unwrap(), Some(16411));
}

/// Strengths of 83,000 bits: balls tell the signs, and exact arithmetic says what their digits cost before it
/// begins.
#[test]
fn long_strengths_cost_what_their_digits_do() {
    let x = |text| parse::parse("x", text).unwrap();
    let clocks =
        Oscillator::new(x("1e25000"), x("1e25000"), x("1"), x("1001/1000")).unwrap().clocks().unwrap();
    let answer = decide(&clocks, &Limits::default()).unwrap();
    assert_eq!((answer.verdict.kind(), answer.decided_by), (Kind::Hyperbolic, Tier::Refine));
    let error = decide_from(Tier::Exact, &clocks, &Limits::default()).unwrap_err();
    assert!(error.needed() > Some(Limits::default().kicks), "{error}");
}

/// 10^8 kicks of one clock, whose period is no longer for the other one.
#[test]
fn a_clock_beside_one_that_does_nothing_is_decided_in_closed_form() {
    let at = |p, q, s| kind_at(p, q, ratio(s, 1), ratio(0, 1));
    assert_eq!(at(49_999_991, 49_999_989, 4), (Kind::Parabolic, -1));
    assert_eq!(at(600_000, 100_003, 1), (Kind::Coexistence, 1));
    assert_eq!(at(600_001, 100_003, 1), (Kind::Elliptic, 0));
    assert_eq!(at(600_001, 100_003, 0), (Kind::Parabolic, 1));
}
