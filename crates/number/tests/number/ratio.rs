//! Ratios in lowest terms.

use kickdrift_number::*;

#[test]
fn the_bounds_of_a_ratio_hold_after_it_is_reduced() {
    let most = (1 << 62) - 1;
    assert_eq!(Ratio::new(u64::MAX, u64::MAX).unwrap().terms(), (1, 1));
    assert_eq!(Ratio::new(most, 2).unwrap().kicks(), most + 2);
    for (p, q) in [(0, 1), (1, 0), (0, 0), (1 << 62, 1), (1, 1 << 62)] {
        assert_eq!(Ratio::new(p, q).unwrap_err().kind(), kickdrift_number::error::Kind::Input, "{p}/{q}");
    }
    let (below, above) = (Ratio::new(most - 1, most).unwrap(), Ratio::new(most, most - 1).unwrap());
    assert!(below < above && Rational::from(below) < Rational::from(above));
}
