//! Prime fields.

use kickdrift::number::*;
use num_bigint::BigInt;
use num_traits::One;

#[test]
fn the_field_computes() {
    let field = PrimeField::LARGEST;
    assert_eq!(prime_fields().next().map(|field| field.prime()), Some(field.prime()));
    let x = field.of(123_456_789_012_345_678);
    assert_eq!(field.value(field.mul(x, field.invert(x))), 1);
    let big = BigInt::from(-7) * (BigInt::one() << 300);
    let direct = field.mul(field.of(7), field.power(field.of(2), 300));
    assert_eq!(field.of_big(&big), field.sub(0, direct));
    let quotient = field.of_rational(&Rational::new((-7).into(), 3.into())).unwrap();
    assert_eq!(field.mul(quotient, field.of(3)), field.sub(0, field.of(7)));
    assert_eq!(field.of_rational(&Rational::new(1.into(), field.prime().into())), None);
}
