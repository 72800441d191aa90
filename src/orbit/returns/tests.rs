//! Against the tiers that follow every kick.

use super::*;
use crate::number::rational::ratio;
use crate::orbit::refine;
use crate::schedule::Schedule;

/// Enclosures that meet, signs and sign changes that do not contradict each other.
fn agree(found: &Ends, reference: &Ends, name: &str) {
    for (one, other) in [(&found.even, &reference.even), (&found.odd, &reference.odd)] {
        for (x, y) in [(&one.x, &other.x), (&one.v, &other.v)] {
            assert!(x.compare(y).is_none() || x.sign() == Some(Sign::Zero), "{name}: {x:?} {y:?}");
        }
        for (x, y) in [(one.signs.0, other.signs.0), (one.signs.1, other.signs.1)] {
            assert!(x.is_none() || y.is_none() || x == y, "{name}: signs");
        }
        assert!(
            one.nodes.is_none() || other.nodes.is_none() || one.nodes == other.nodes,
            "{name}: {one:?} {other:?}"
        );
    }
}

fn pair(p: u64, q: u64, s: Rational, k: Rational) -> (TwoClocks<Rational>, Schedule) {
    let ratio = Ratio::new(p, q).unwrap();
    (TwoClocks::new(ratio, s, k), Schedule::two_clocks(ratio).unwrap())
}

/// How many of the kinds of numbers in turn decide all four signs, and give the sign changes.
fn tally(p: u64, q: u64, s: Rational, k: Rational) -> [[bool; 2]; 3] {
    let name = format!("p/q = {p}/{q}, s = {s}, k = {k}");
    let (clocks, schedule) = pair(p, q, s, k);
    let reference = refine::run(&clocks, &schedule, 700).unwrap();
    PRECISIONS.map(|bits| {
        let Some(found) = run(&clocks, bits) else { return [false; 2] };
        agree(&found, &reference, &format!("{name}, {bits} bits"));
        [found.signs().complete().is_some(), found.even.nodes.is_some()]
    })
}

/// Weak and strong, attracting and repelling, h1 above and below h2. Two doubles decide them all.
#[test]
fn return_maps_are_what_kicks_give() {
    let mut state = 1u64;
    let mut next = |n: u64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) % n
    };
    let (mut pairs, mut counts) = (0, [[0; 2]; PRECISIONS.len()]);
    for size in [3, 10, 40, 200] {
        for weak in [1000, 100, 10, 1] {
            for _ in 0..8 {
                pairs += 1;
                let (p, q) = (1 + next(2 * size), 1 + next(size));
                let (s, k) = (1 + next(3998) as i64, next(2000) as i64 - 300);
                let found = tally(p, q, ratio(s, 1000), ratio(k, 1000 * weak));
                for (count, found) in counts.as_flattened_mut().iter_mut().zip(found.as_flattened()) {
                    *count += u32::from(*found);
                }
            }
        }
    }
    let [doubles, two, long] = counts;
    assert!(doubles.iter().all(|count| *count > pairs * 9 / 10), "{counts:?} of {pairs}");
    assert_eq!((two, long), ([pairs; 2], [pairs; 2]));
}

/// Beside simple ratios, where a partial quotient is long enough for normal forms: elliptic, hyperbolic and across |Tr| = 2.
#[test]
fn slow_products_are_what_kicks_give() {
    let mut state = 7u64;
    let mut next = |n: u64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) % n
    };
    for size in [40_000, 100_000] {
        for _ in 0..12 {
            let (n, k) = (1 + next(4), size + next(size));
            let (p, q) = if next(2) == 0 { (n * k + 1, k) } else { (n * k - 1, k) };
            let (s, strength) = (ratio(1 + next(3998) as i64, 1000), ratio(next(2000) as i64 - 300, 1000));
            let found = tally(p, q, s.clone(), strength.clone());
            eprintln!("{p}/{q} s = {s} k = {strength}: {found:?}");
        }
    }
}
