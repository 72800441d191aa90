//! Families and labels.

use kickdrift::number::Ratio;
use kickdrift::resonance::*;
use num_integer::Integer;

#[test]
fn families_solve_m_and_the_dominant_one_beats_all_others() {
    for p in 1..30u64 {
        for q in (1..30u64).filter(|q| q.gcd(&p) == 1) {
            for m in 1..p {
                let (a, b) = dominant_family(Ratio::new(p, q).unwrap(), m);
                assert_eq!(a * p as i64 + b * q as i64, m as i64);
                let theta = std::f64::consts::PI * m as f64 / p as f64;
                let best = strength(a, theta).abs();
                for k in -5..=5 {
                    let other = strength(a + k * q as i64, theta).abs();
                    assert!(k == 0 || other < best, "p/q = {p}/{q}, m = {m}: a = {a} against {k}");
                }
            }
        }
    }
}

#[test]
fn growth_without_a_turn_is_no_resonance() {
    assert_eq!(dominant_family("5/3".parse().unwrap(), 0), (0, 0));
}

#[test]
fn respa_is_family_zero() {
    for (p, m) in [(2, 1), (7, 1), (9, 4)] {
        assert_eq!(families(Ratio::new(p, 1).unwrap(), m), (0, m as i64));
    }
    // Below th = pi/2 the family a = 0 wins over a = 1 for q = 1, above it the other.
    assert_eq!(dominant_family("9/1".parse().unwrap(), 2), (0, 2));
    assert_eq!(dominant_family("9/1".parse().unwrap(), 8), (1, -1));
}
