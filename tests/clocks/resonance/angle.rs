//! Angles of the fast clock.

use kickdrift::number::Rational;
use kickdrift::number::rational::ratio;
use kickdrift::resonance::*;

#[test]
fn a_resonance_is_at_distance_zero_and_its_neighbour_is_not() {
    let nearest = |s: Rational, p: u64| Angle::new(s).unwrap().nearest(p, 64);
    let told = |s: Rational, p: u64| (nearest(s.clone(), p).m, nearest(s, p).distance.to_f64_enclosure());
    for (s, p, m) in [(1, 3, 1), (1, 6, 2), (2, 2, 1), (2, 8, 4), (3, 3, 2)] {
        assert_eq!(told(ratio(s, 1), p), (m, (0.0, 0.0)), "s = {s}, p = {p}");
    }
    // Half-way, and half-way to the first resonance.
    assert_eq!([3, 1].map(|p| told(ratio(2, 1), p)), [(1, (0.5, 0.5)), (0, (0.5, 0.5))]);
    // Nearer to nothing than to the first resonance, exactly and enclosed; as near as 2/3 of T½ to that one.
    let weak = Angle::new(ratio(1, 1)).unwrap();
    assert_eq!(told(ratio(1, 1), 1), (0, (1.0 / 3.0, (1.0_f64 / 3.0).next_up())));
    assert!(weak.is_resonant(1, &ratio(2, 3)) && !weak.is_resonant(1, &ratio(66, 100)));
    assert_eq!(nearest(ratio(1, 100), 3).m, 0);
    // 1/3, enclosed by neighbouring doubles: the nearest one lies below it.
    assert_eq!(told(ratio(1, 1), 4), (1, (1.0 / 3.0, (1.0_f64 / 3.0).next_up())));
    // Elsewhere an enclosure that holds the exact value, and never only 0.
    let beside = ratio(1_000_000_000_000_000_001, 1_000_000_000_000_000_000);
    let (m, (lo, hi)) = told(beside, 3);
    assert!(m == 1 && lo < hi && hi > 0.0);
}
