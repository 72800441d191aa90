//! Quantities from doubles and texts.

use kickdrift_number::*;

#[test]
fn doubles_are_taken_to_their_last_bit_or_refused() {
    for x in [0.1, -1e-300, f64::MAX, f64::from_bits(1), 0.0] {
        assert_eq!(Laurent::try_from(x).unwrap().as_rational(), Rational::from_float(x));
    }
    for x in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        assert!(Laurent::try_from(x).is_err() && Ratio::try_from(x).is_err());
    }
    assert_eq!(Ratio::try_from(2.5).unwrap().terms(), (5, 2));
    assert!(
        Ratio::try_from(0.0).is_err() && Ratio::try_from(-1.5).is_err() && Ratio::try_from(1e300).is_err()
    );
}

#[test]
fn exact_numbers_survive_a_document() {
    let (x, ratio): (Laurent, Ratio) = ("pi^2/25 - 3".parse().unwrap(), "7/2".parse().unwrap());
    let text = serde_json::to_string(&(&x, ratio)).unwrap();
    assert_eq!(text, r#"["-3 + pi^2/25","7/2"]"#);
    assert_eq!(serde_json::from_str::<(Laurent, Ratio)>(&text).unwrap(), (x, ratio));
    assert!(serde_json::from_str::<Ratio>("\"1/0\"").is_err());
}
