//! Prime fields.

use kickdrift_number::*;
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

#[test]
fn all_roots_or_none_are_found() {
    let mut split = 0;
    for field in prime_fields().take(40) {
        // (x − 3) (x + 7) (x² + x − 1): all of its roots where 5 is a square.
        let minus = |n| field.sub(0, field.of(n));
        let product =
            [minus(3), field.of(7)].into_iter().fold(vec![minus(1), field.of(1), field.of(1)], |f, c| {
                let mut next = vec![0; f.len() + 1];
                for (i, &x) in f.iter().enumerate() {
                    next[i] = field.add(next[i], field.mul(x, c));
                    next[i + 1] = field.add(next[i + 1], x);
                }
                next
            });
        let is_square = field.power(field.of(5), (field.prime() - 1) / 2) == field.of(1);
        let roots = field.roots(&product);
        assert_eq!(roots.is_some(), is_square);
        let Some(roots) = roots else { continue };
        split += 1;
        assert!(roots.len() == 4 && roots.contains(&field.of(3)) && roots.contains(&minus(7)));
        let value = |x| product.iter().rev().fold(0, |sum, &c| field.add(field.mul(sum, x), c));
        assert!(roots.iter().all(|&x| value(x) == 0));
    }
    assert!((10..=30).contains(&split), "{split}");
}
