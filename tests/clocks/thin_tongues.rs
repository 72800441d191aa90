//! Widths of tongues that doubles see as one point, against the digits of their edges.

use kickdrift::number::rational::{from_f64_exact, ratio, to_f64};
use kickdrift::number::{Ratio, Rational};
use kickdrift::tongue::{Gap, Tongues};
use num_bigint::BigInt;
use num_integer::Integer;
use proptest::prelude::*;

fn tongues(p: u64, q: u64, rho: &Rational) -> Tongues {
    Tongues::new(Ratio::new(p, q).unwrap(), rho).unwrap()
}

fn power_of_ten(n: i32) -> Rational {
    Rational::from_integer(BigInt::from(10)).pow(n)
}

/// The width from so many digits of both edges that twenty of its own are right: they must be in order, the
/// enclosure must hold it, and be narrow.
fn agrees_with_digits(tongues: &Tongues, gap: &Gap) {
    let upper = gap.upper.unwrap();
    let digits = (gap.lower.lo / gap.width.0).log10().ceil().max(0.0) as u32 + 20;
    let [x, y] = [&gap.lower, &upper].map(|edge| tongues.refine(edge, digits).unwrap());
    let (lo, hi) = (&y.lo - &x.hi, &y.hi - &x.lo);
    assert!(x.hi < y.lo && &hi - &lo < &lo * power_of_ten(-18), "{gap:?}");
    let exact = |width: f64| from_f64_exact(width).unwrap();
    assert!(exact(gap.width.0) <= lo && hi <= exact(gap.width.1), "{gap:?}: {}", to_f64(&lo));
    assert!(gap.width.1 <= 1.001 * gap.width.0, "{gap:?}");
}

/// Far thinner than a unit in the last place of its edges, or about as thin; but within the range of doubles.
fn is_thin(gap: &Gap) -> bool {
    !gap.closed && gap.width.0 > 1e-300 && gap.width.1 < 1e-12 * gap.lower.lo
}

/// Checks at most `limit` thin tongues of one ratio, and tells how many there were.
fn check_thin(p: u64, q: u64, rho: &Rational, limit: usize) -> usize {
    let tongues = tongues(p, q, rho);
    let gaps = tongues.all().unwrap();
    let thin: Vec<_> = gaps.iter().filter(|gap| is_thin(gap)).collect();
    thin.iter().take(limit).for_each(|gap| agrees_with_digits(&tongues, gap));
    thin.len()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn widths_agree_with_the_digits_of_the_edges(p in 1u64..40, q in 1u64..40, n in 1i64..100, decade in -5i32..=3) {
        let g = p.gcd(&q);
        check_thin(p / g, q / g, &(ratio(n, 10) * power_of_ten(decade)), 8);
    }
}

#[test]
fn widths_agree_with_the_digits_at_extreme_rho() {
    for decade in [-12, -9, 9, 12] {
        let rho = power_of_ten(decade);
        let pairs = [(3, 2), (7, 4), (4, 9), (9, 4), (19, 16), (16, 19)];
        let seen: usize = pairs.map(|(p, q)| check_thin(p, q, &rho, 6)).iter().sum();
        assert!(seen > 5, "{decade}: {seen}");
    }
}

#[test]
fn a_width_of_1e_60_of_the_edge_is_as_well_known_as_any() {
    // And one of 1e-94.
    for (p, q, most) in [(37, 33, 1e-60), (47, 51, 1e-94)] {
        let tongues = tongues(p, q, &ratio(1, 25));
        let gaps = tongues.all().unwrap();
        let thinner = |a: &&Gap, b: &&Gap| a.width.0.total_cmp(&b.width.0);
        let gap = gaps.iter().filter(|gap| gap.upper.is_some()).min_by(thinner).unwrap();
        assert!(gap.width.1 < most * gap.lower.lo && gap.width.1 <= gap.width.0 * (1.0 + 1e-6), "{gap:?}");
        agrees_with_digits(&tongues, gap);
    }
}

#[test]
fn next_to_a_closing_the_order_is_right_on_both_sides() {
    // 5/3, m = 4 closes at rho = 114/55: its two edges change places there.
    let closing = ratio(114, 55);
    for k in 1..20 {
        let hair = power_of_ten(-k);
        let [below, above] = [&closing - &hair, &closing + &hair].map(|rho| {
            let tongues = tongues(5, 3, &rho);
            let gap = tongues.gap(4).unwrap();
            agrees_with_digits(&tongues, &gap);
            gap
        });
        assert_ne!(below.lower.entry, above.lower.entry, "10^-{k}");
        let share = above.width.0 / below.width.0 - 1.0;
        assert!(k < 4 || share.abs() < 1e-2, "the widths fall linearly on both sides: {share}");
    }
    let gap = tongues(5, 3, &closing).gap(4).unwrap();
    assert!(gap.closed && gap.width == (0.0, 0.0));
}

#[test]
fn no_more_digits_of_an_edge_are_asked_for_a_width() {
    // A bound on how often the way in doubles gives up: never, at this and greater rho. At small rho tongues
    // below the Verlet limit are thin because the slow kicks are weak, not because their modes live far from
    // the ends.
    for rho in [ratio(1, 25), ratio(1, 1), ratio(25, 1)] {
        for (p, q) in Ratio::up_to(40).map(Ratio::terms) {
            let tongues = tongues(p, q, &rho);
            tongues.all().unwrap();
            assert_eq!(tongues.effort().precise, 0, "{p}/{q}, rho = {rho}");
        }
    }
}

#[test]
fn a_long_half_period_is_no_obstacle() {
    // 200 kicks in a period, and widths down to 1e-200; then kicks of strength 1e7.
    assert!(check_thin(107, 93, &ratio(1, 40), 3) > 30);
    let tongues = tongues(89, 87, &power_of_ten(-7));
    let gaps = tongues.all().unwrap();
    assert!(gaps.iter().any(|gap| gap.width.0 < 1e-200) && tongues.effort().precise < 40);
}

#[test]
fn two_edges_of_one_entry_within_one_double_are_told_apart() {
    let tongues = tongues(1999, 1001, &ratio(1, 25));
    let gaps = tongues.gaps(1918, 1921).unwrap();
    assert!(gaps.iter().all(|gap| !gap.closed && gap.width.0 > 0.0));
    let [first, second] = [gaps[0].upper.unwrap(), gaps[2].upper.unwrap()];
    assert_eq!((first.entry, first.index + 1), (second.entry, second.index));
    assert_eq!((first.lo, first.hi), (second.lo, second.hi));
    let [x, y] = [&first, &second].map(|edge| tongues.refine(edge, 40).unwrap());
    assert!(x.hi < y.lo);
}

#[test]
fn tongues_beyond_the_range_of_doubles_are_open_and_listed() {
    let gaps = tongues(619, 381, &ratio(1, 25)).all().unwrap();
    assert_eq!(gaps.len(), 999);
    assert!(gaps.iter().all(|gap| !gap.closed && gap.width.0 <= gap.width.1));
    assert!(gaps.iter().any(|gap| gap.width.1 < f64::MIN_POSITIVE));
}

#[test]
fn twenty_five_digits_by_counts_hold_sixty_by_signs() {
    let cases = [
        (7, 4, ratio(1, 25)),
        (40, 39, power_of_ten(12)),
        (43, 55, power_of_ten(-12)),
        (19, 16, ratio(7, 1)),
    ];
    for (p, q, rho) in cases {
        let tongues = tongues(p, q, &rho);
        for gap in tongues.all().unwrap() {
            for edge in [Some(gap.lower), gap.upper].into_iter().flatten() {
                let [wide, narrow] = [25, 60].map(|digits| tongues.refine(&edge, digits).unwrap());
                assert!(wide.lo <= narrow.lo && narrow.hi <= wide.hi, "{p}/{q}, {rho}: {edge:?}");
                assert!(wide.width() <= &wide.lo * power_of_ten(-25), "{p}/{q}, {rho}: {edge:?}");
            }
        }
    }
}

#[test]
fn the_tongues_of_weak_coupling_and_of_dense_clusters_are_enclosed() {
    for (p, q, rho) in
        [(40, 39, power_of_ten(12)), (43, 55, ratio(13, 10) * power_of_ten(-12)), (1389, 1450, ratio(7, 1))]
    {
        let gaps = tongues(p, q, &rho).all().unwrap();
        let narrow = |gap: &Gap| {
            gap.width.0 > 0.0 && gap.width.1 <= 1.001 * gap.width.0 || gap.width.1 < f64::MIN_POSITIVE
        };
        assert!(gaps.iter().filter(|gap| gap.upper.is_some()).all(narrow), "{p}/{q}, rho = {rho}");
    }
}
