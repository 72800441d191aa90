//! Beside certified edges, at the ends of all scales, over long periods.

use kickdrift::number::rational::ratio;
use kickdrift::number::{Ratio, Rational, Ring, parse};
use kickdrift::propagator::{Oscillator, TwoClocks};
use kickdrift::tongue::Tongues;
use kickdrift::verdict::{Decision, Kind, Limits, Tier, decide, decide_from, growth};
use num_bigint::BigInt;
use num_traits::{One, ToPrimitive};

fn at(clocks: &TwoClocks<Rational>) -> Decision {
    decide(clocks, &Limits::default()).unwrap().decision()
}

fn hair(k: u32) -> Rational {
    Rational::new(One::one(), BigInt::from(10).pow(k))
}

/// The verdict flips between 10^-k before and 10^-k after a certified edge.
#[test]
fn verdicts_flip_at_certified_edges() {
    for (p, q, m, rho) in
        [(7, 2, 4, ratio(1, 25)), (5, 3, 2, ratio(1, 3)), (11, 8, 9, ratio(7, 5)), (3, 7, 2, ratio(1, 2))]
    {
        let tongues = Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap();
        let gap = tongues.gap(m).unwrap();
        let edges = [gap.lower, gap.upper.unwrap()].map(|edge| tongues.refine(&edge, 50).unwrap());
        let width = &edges[1].lo - &edges[0].hi;
        for (edge, rising) in edges.iter().zip([true, false]) {
            for k in 1..=40 {
                let step = hair(k);
                if step >= width {
                    continue;
                }
                let verdict =
                    |s: Rational| at(&TwoClocks::with_rho(Ratio::new(p, q).unwrap(), s, rho.clone())).verdict;
                let (before, after) = (verdict(&edge.lo - &step), verdict(&edge.hi + &step));
                let (outside, inside) = if rising { (before, after) } else { (after, before) };
                assert_eq!(inside.kind(), Kind::Hyperbolic, "{p}/{q}, m = {m}, 10^-{k}");
                // Ten gaps of this size away there may be another tongue: only near the edge is it stable.
                if k > 2 {
                    assert_eq!(outside.kind(), Kind::Elliptic, "{p}/{q}, m = {m}, 10^-{k}");
                }
            }
        }
    }
}

/// Velocity Verlet flips at s = 4, whatever else hardly kicks.
#[test]
fn s_just_below_and_above_4() {
    for k in 1..=40 {
        let verlet = |s: Rational| at(&TwoClocks::new("1/1".parse().unwrap(), s, ratio(0, 1))).verdict.kind();
        assert_eq!(verlet(ratio(4, 1) - hair(k)), Kind::Elliptic);
        assert_eq!(verlet(ratio(4, 1) + hair(k)), Kind::Hyperbolic);
        // Two clocks of one step are one clock.
        let both = |s: Rational| at(&TwoClocks::new("1/1".parse().unwrap(), s, hair(45))).verdict.kind();
        assert_eq!(both(ratio(4, 1) - hair(k)), Kind::Elliptic);
        assert_eq!(both(ratio(4, 1) - hair(45)), Kind::Parabolic);
    }
}

/// Units do not matter, however small or large: time in units of 10^±300, stiffness to match.
#[test]
fn units_of_time_do_not_matter() {
    let x = |text: &str| parse::parse("x", text).unwrap();
    for (h1, h2) in [("0.631", "3.499"), ("1", "5/3"), ("7/11", "3")] {
        let decide_at = |exponent: i32| {
            let unit = x(&format!("10^{exponent}"));
            let stiffness = |l: &str| Ring::product(&x(l), &x(&format!("10^{}", -2 * exponent)));
            let (h1, h2) = (Ring::product(&x(h1), &unit), Ring::product(&x(h2), &unit));
            let clocks =
                Oscillator::new(stiffness("10"), stiffness("2/5"), h1, h2).unwrap().clocks().unwrap();
            decide(&clocks, &Limits::default()).unwrap().decision()
        };
        let here = decide_at(0);
        for exponent in [-324, -308, -300, -16, 16, 300, 308] {
            assert_eq!(decide_at(exponent), here, "10^{exponent}");
        }
    }
}

/// rho from 1e-300 to 1e300: decided, and by exact arithmetic the same.
#[test]
fn any_ratio_of_stiffnesses() {
    for exponent in [-300, -200, -100, -30, -17, -3, 0, 3, 17, 30, 100, 200, 300] {
        let power = BigInt::from(10).pow(i32::unsigned_abs(exponent));
        let rho = if exponent < 0 { Rational::new(One::one(), power) } else { Rational::from(power) };
        for (p, q) in [(1, 1), (3, 1), (1, 3), (7, 4), (4, 7), (20, 19)] {
            for s in [ratio(1, 1000), ratio(1, 1), ratio(2, 1), ratio(3, 1), ratio(399, 100), ratio(9, 1)] {
                for sign in [1, -1] {
                    let clocks =
                        TwoClocks::with_rho(Ratio::new(p, q).unwrap(), s.clone(), &rho * ratio(sign, 1));
                    let exact = decide_from(Tier::Exact, &clocks, &Limits::default()).unwrap();
                    assert_eq!(at(&clocks).verdict, exact.verdict, "{p}/{q}, s = {s}, 10^{exponent}");
                }
            }
        }
    }
}

/// A million kicks: the tiers agree, and the growth is right where the trace is far beyond doubles.
#[test]
fn a_period_of_a_million_kicks() {
    let limits = Limits::default();
    for (p, q, s, rho) in
        [(618_034, 381_966, ratio(1, 3), ratio(1, 25)), (500_001, 500_000, ratio(2, 1), ratio(1, 100))]
    {
        // In lowest terms.
        let common = num_integer::gcd(p, q);
        let clocks = TwoClocks::with_rho(Ratio::new(p / common, q / common).unwrap(), s, rho);
        let quick = decide(&clocks, &limits).unwrap();
        let slow = decide_from(Tier::Refine, &clocks, &limits).unwrap();
        assert_eq!(quick.verdict, slow.verdict);
    }
    // s > 4 on both clocks: each period multiplies by e^(a million).
    let clocks = TwoClocks::with_rho(Ratio::new(333_334, 333_333).unwrap(), ratio(5, 1), ratio(1, 1));
    let verdict = decide(&clocks, &limits).unwrap().verdict;
    let grown = growth(&clocks, verdict, &limits).unwrap();
    let (ln, trace) = (grown.ln_multiplier.unwrap(), grown.trace);
    // ln |Tr| = ln 2 cosh(ln mu): its bits tell.
    let log2 = (trace.lower().numer().bits() as f64 - trace.lower().denom().bits() as f64).abs();
    assert!(ln.mid_f64() > 1e5 && ln.relative_accuracy_bits() > 40);
    // A quotient of integers of n and d bits has n - d bits, give or take one.
    assert!((ln.mid_f64() / std::f64::consts::LN_2 - log2).abs() < 2.0, "{} {log2}", ln.mid_f64());
}

/// Subnormal and many-digit decimals mean what they say.
#[test]
fn decimals_mean_what_they_say() {
    let x = |text: &str| parse::parse("x", text).unwrap();
    // 5e-324 is no double's business: exactly 4 units of time² make the limit.
    let verlet = |lambda1: &str, h: &str| {
        let clocks = Oscillator::new(x(lambda1), x("0"), x(h), x(h)).unwrap().clocks().unwrap();
        decide(&clocks, &Limits::default()).unwrap().verdict.kind()
    };
    assert_eq!(verlet("4e648", "1e-324"), Kind::Parabolic);
    assert_eq!(verlet("1.6e647", "5e-324"), Kind::Parabolic);
    let digits = "1234567890".repeat(20);
    assert_eq!(verlet(&format!("3.{}", "9".repeat(200)), "1"), Kind::Elliptic);
    assert_eq!(verlet(&format!("4.{}1", "0".repeat(200)), "1"), Kind::Hyperbolic);
    assert_eq!(verlet(&format!("4/0.{digits}^2"), &format!("0.{digits}")), Kind::Parabolic);
}

/// On a point of coexistence Q = I, 10^-k beside it not.
#[test]
fn coexistence_is_a_point() {
    let (s, rho) = (ratio(11, 4), ratio(114, 55));
    let kind =
        |s: Rational, rho: Rational| at(&TwoClocks::with_rho("5/3".parse().unwrap(), s, rho)).verdict.kind();
    assert_eq!(kind(s.clone(), rho.clone()), Kind::Coexistence);
    for k in 1..=40 {
        for sign in [1, -1] {
            let step = hair(k) * ratio(sign, 1);
            assert_ne!(kind(&s + &step, rho.clone()), Kind::Coexistence);
            assert_ne!(kind(s.clone(), &rho + &step), Kind::Coexistence);
        }
    }
    assert!(hair(40).to_f64().unwrap() > 0.0);
}
