//! Counts that must come out exactly, the small ones from a route of their own: the full period, kick by
//! kick, in rational arithmetic, classified by its trace and by Q = ±I.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::support::{json, stdout, words};

fn rational(n: i64, d: i64) -> BigRational {
    BigRational::new(n.into(), d.into())
}

/// Kind and side at h1 = i d, h2 = j d of the staggered integrator: every kick whole, in the order of time.
fn classified(
    lambda1: &BigRational,
    lambda2: &BigRational,
    d: &BigRational,
    i: i64,
    j: i64,
) -> (&'static str, i64) {
    // Times in units of d: multiples of i and of j up to their least common multiple.
    let period = i.lcm(&j);
    let mut kicks: BTreeMap<i64, BigRational> = BTreeMap::new();
    for (step, lambda) in [(i, lambda1), (j, lambda2)] {
        for time in (0..period).step_by(step as usize) {
            *kicks.entry(time).or_default() += lambda * d * BigInt::from(step);
        }
    }
    let zero = || BigRational::zero();
    let (mut x, mut v) = ([BigRational::one(), zero()], [zero(), BigRational::one()]);
    let ends: Vec<i64> = kicks.keys().copied().skip(1).chain([period]).collect();
    for ((time, strength), end) in kicks.iter().zip(ends) {
        for (x, v) in x.iter_mut().zip(&mut v) {
            *v -= strength * &*x;
            *x += &*v * d * BigInt::from(end - time);
        }
    }
    let trace = &x[0] + &v[1];
    let side = if trace.is_negative() { -1 } else { 1 };
    let two = rational(2, 1);
    if trace.abs() < two {
        ("elliptic", 0)
    } else if trace.abs() > two {
        ("hyperbolic", side)
    } else if x[1].is_zero() && v[0].is_zero() {
        ("coexistence", side)
    } else {
        ("parabolic", side)
    }
}

/// λ1 = 16 with multiples of 1/20 makes s = i²/25: s = 1 at i = 5 (edges that are exactly rational), the
/// Verlet limit at i = 10, and two columns beyond it.
#[test]
fn a_map_agrees_pair_by_pair_with_the_full_period_in_rationals() {
    let line = "map --lambda1 16 --lambda2 16/25 --step 1/20 --h1-range 1/20..3/5 --h2-range 1/20..7/4";
    let csv = stdout(&words(line, &["--format", "csv"]));
    let rows: Vec<Vec<&str>> = csv.lines().skip(1).map(|row| row.split(',').collect()).collect();
    let mut rows = rows.iter();
    let mut counts: BTreeMap<&str, u64> = BTreeMap::new();
    let (lambda1, lambda2, d) = (rational(16, 1), rational(16, 25), rational(1, 20));
    for (i, j) in (1..=12).flat_map(|i| (1..=35).map(move |j| (i, j))) {
        let (kind, side) = classified(&lambda1, &lambda2, &d, i, j);
        *counts.entry(kind).or_default() += 1;
        if kind != "elliptic" {
            let [h1, h2] = [i, j].map(|n| (&d * BigInt::from(n)).to_string());
            let [p, q] = [j, i].map(|n| (n / i.gcd(&j)).to_string());
            let side = side.to_string();
            assert_eq!(rows.next().unwrap()[..6], [&h1, &h2, &p, &q, kind, &side], "i = {i}, j = {j}");
        }
    }
    assert!(rows.next().is_none());
    let map = json(&words(line, &[]));
    let count = |kinds: &[&str]| kinds.iter().map(|kind| counts.get(kind).copied().unwrap_or(0)).sum::<u64>();
    assert_eq!(map["pairs"], 12 * 35);
    assert_eq!(map["unstable"], count(&["hyperbolic", "parabolic"]));
    assert_eq!(map["stable"], count(&["elliptic", "coexistence"]));
    assert_eq!(map["parabolic"], count(&["parabolic"]));
    assert_eq!(map["coexistence"], count(&["coexistence"]));
    assert!(count(&["parabolic"]) > 0, "the grid was chosen to hold exact edges");
}

/// The counts of a plain double-precision full-period product over the paper's grid.
#[test]
fn figure_1_at_a_hundredth_has_2075_unstable_of_22050_pairs() {
    let line =
        "map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/100 --h1-range 1/100..2/pi --h2-range 1/100..7/2";
    let map = json(&words(line, &[]));
    assert_eq!((map["pairs"].as_u64(), map["unstable"].as_u64()), (Some(22_050), Some(2_075)));
    let tiers = &map["decided_by"];
    let decided: u64 = ["filter", "refine", "exact"].iter().map(|tier| tiers[tier].as_u64().unwrap()).sum();
    assert_eq!(decided, 22_050);
}
