//! Numbers of 256 bits, without allocation.

use num_bigint::{BigInt, Sign};
use num_traits::Float;
use number::power_of_two;

/// The whole words of a mantissa, the lowest first.
const WORDS: usize = 4;

/// Its bits.
pub const LENGTH: u32 = 64 * WORDS as u32;

type Mantissa = [u64; WORDS];

/// ± mantissa 2^exponent; the highest bit of the mantissa is set, or it is zero.
///
/// Results are truncated: a product by less than 2^-255 of itself, a sum by less than 2^-254 of the larger of
/// the two.
#[derive(Clone, Copy, Debug)]
pub struct Long {
    is_negative: bool,
    mantissa: Mantissa,
    exponent: i64,
}

/// m 2^-by, what lies beyond the point cut off.
fn shifted_down(m: &Mantissa, by: u32) -> Mantissa {
    let (words, bits) = ((by / 64) as usize, by % 64);
    std::array::from_fn(|i| {
        let word = |i: usize| m.get(i + words).copied().unwrap_or(0);
        // A shift by 64 bits would be none.
        word(i) >> bits | (word(i + 1) << 1) << (63 - bits)
    })
}

/// m 2^by, for what has so many leading zeros.
fn shifted_up(m: &Mantissa, by: u32) -> Mantissa {
    let (words, bits) = ((by / 64) as usize, by % 64);
    std::array::from_fn(|i| {
        let word = |below: usize| i.checked_sub(words + below).map_or(0, |i| m[i]);
        word(0) << bits | (word(1) >> 1) >> (63 - bits)
    })
}

fn leading_zeros(m: &Mantissa) -> u32 {
    let top = m.iter().rposition(|&word| word != 0);
    top.map_or(LENGTH, |top| 64 * (WORDS - 1 - top) as u32 + m[top].leading_zeros())
}

/// The sum's words and whether it carries beyond them.
fn sum(a: &Mantissa, b: &Mantissa) -> (Mantissa, bool) {
    let mut carry = false;
    let sum = std::array::from_fn(|i| {
        let (sum, first) = a[i].overflowing_add(b[i]);
        let (sum, second) = sum.overflowing_add(carry.into());
        carry = first | second;
        sum
    });
    (sum, carry)
}

/// a − b, a ≥ b.
fn difference(a: &Mantissa, b: &Mantissa) -> Mantissa {
    let mut borrow = false;
    std::array::from_fn(|i| {
        let (rest, first) = a[i].overflowing_sub(b[i]);
        let (rest, second) = rest.overflowing_sub(borrow.into());
        borrow = first | second;
        rest
    })
}

impl Long {
    pub const ZERO: Long = Long { is_negative: false, mantissa: [0; WORDS], exponent: 0 };

    fn is_zero(&self) -> bool {
        self.mantissa[WORDS - 1] == 0
    }

    fn normalized(is_negative: bool, mantissa: Mantissa, exponent: i64) -> Long {
        let zeros = leading_zeros(&mantissa);
        if zeros == LENGTH {
            return Long::ZERO;
        }
        Long { is_negative, mantissa: shifted_up(&mantissa, zeros), exponent: exponent - i64::from(zeros) }
    }

    /// A double, exactly.
    pub fn of(x: f64) -> Long {
        let (mantissa, exponent, sign) = Float::integer_decode(x);
        Long::normalized(sign < 0, [mantissa, 0, 0, 0], exponent.into())
    }

    /// n 2^exponent, but for what lies beyond 256 bits.
    pub fn of_dyadic(n: &BigInt, exponent: i64) -> Long {
        let digits = n.magnitude().iter_u64_digits();
        let unread = digits.len().saturating_sub(WORDS + 1);
        // One word more than there is room for: the highest may have a single bit.
        let mut words = [0; WORDS + 1];
        words.iter_mut().zip(digits.skip(unread)).for_each(|(word, digit)| *word = digit);
        let [low, rest @ ..] = words;
        let zeros = leading_zeros(&rest);
        let (mantissa, power) = if zeros >= 64 {
            ([low, rest[0], rest[1], rest[2]], 0)
        } else {
            let mut mantissa = shifted_up(&rest, zeros);
            mantissa[0] |= (low >> 1) >> (63 - zeros);
            (mantissa, 64 - i64::from(zeros))
        };
        Long::normalized(n.sign() == Sign::Minus, mantissa, exponent + 64 * unread as i64 + power)
    }

    /// n and e of n 2^e.
    pub fn dyadic(&self) -> (BigInt, i64) {
        let words = self.mantissa.iter().flat_map(|&word| [word as u32, (word >> 32) as u32]);
        let sign = if self.is_negative { Sign::Minus } else { Sign::Plus };
        (BigInt::new(sign, words.collect()), self.exponent)
    }

    pub fn negative(self) -> Long {
        Long { is_negative: !self.is_negative, ..self }
    }

    pub fn plus(&self, other: &Long) -> Long {
        if self.is_zero() || other.is_zero() {
            return if self.is_zero() { *other } else { *self };
        }
        let size = |x: &Long| (x.exponent, x.mantissa[3], x.mantissa[2], x.mantissa[1], x.mantissa[0]);
        let (large, small) = if size(self) >= size(other) { (self, other) } else { (other, self) };
        let apart = large.exponent - small.exponent;
        if apart >= i64::from(LENGTH) {
            return *large;
        }
        let small_mantissa = shifted_down(&small.mantissa, apart as u32);
        if large.is_negative != small.is_negative {
            let rest = difference(&large.mantissa, &small_mantissa);
            return Long::normalized(large.is_negative, rest, large.exponent);
        }
        let (mut mantissa, carries) = sum(&large.mantissa, &small_mantissa);
        if carries {
            mantissa = shifted_down(&mantissa, 1);
            mantissa[WORDS - 1] |= 1 << 63;
        }
        Long { mantissa, exponent: large.exponent + i64::from(carries), ..*large }
    }

    pub fn times(&self, other: &Long) -> Long {
        if self.is_zero() || other.is_zero() {
            return Long::ZERO;
        }
        let mut all = [0u64; 2 * WORDS];
        for (i, &a) in self.mantissa.iter().enumerate() {
            let mut carry = 0;
            for (j, &b) in other.mantissa.iter().enumerate() {
                let part = u128::from(a) * u128::from(b) + u128::from(all[i + j]) + u128::from(carry);
                (all[i + j], carry) = (part as u64, (part >> 64) as u64);
            }
            all[i + WORDS] = carry;
        }
        let mut mantissa: Mantissa = std::array::from_fn(|i| all[i + WORDS]);
        // Both are at least 2^255: the product has 512 bits, or one less.
        let short = mantissa[WORDS - 1] >> 63 == 0;
        if short {
            mantissa = shifted_up(&mantissa, 1);
            mantissa[0] |= all[WORDS - 1] >> 63;
        }
        Long {
            is_negative: self.is_negative != other.is_negative,
            mantissa,
            exponent: self.exponent + other.exponent + i64::from(LENGTH) - i64::from(short),
        }
    }

    /// x 2^k, exactly.
    pub fn scale2(&self, k: i32) -> Long {
        if self.is_zero() { *self } else { Long { exponent: self.exponent + i64::from(k), ..*self } }
    }

    /// Halves of words as doubles, the lowest first; their sum is the number as long as doubles hold it.
    pub fn doubles(&self) -> impl Iterator<Item = f64> {
        let sign = if self.is_negative { -1.0 } else { 1.0 };
        let halves = self.mantissa.into_iter().flat_map(|word| [word & 0xffff_ffff, word >> 32]);
        let exponent = self.exponent;
        halves.enumerate().map(move |(i, half)| sign * scaled(half as f64, exponent + 32 * i as i64))
    }

    /// Within 2^-52 relatively.
    pub fn near(&self) -> f64 {
        let size = scaled(self.mantissa[WORDS - 1] as f64, self.exponent + 64 * (WORDS as i64 - 1));
        if self.is_negative { -size } else { size }
    }
}

/// x 2^k, for x < 2^64.
fn scaled(x: f64, k: i64) -> f64 {
    let half = (k / 2).clamp(-1020, 1000);
    let rest = (k - half).clamp(-1020, 1000);
    x * power_of_two(half as i32) * power_of_two(rest as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::Rational;
    use proptest::prelude::*;

    fn exact(x: &Long) -> Rational {
        let (n, e) = x.dyadic();
        let power = Rational::from_integer(2.into()).pow(e as i32);
        Rational::from_integer(n) * power
    }

    fn long() -> impl Strategy<Value = Long> {
        // Mantissas with runs of zeros and ones, too.
        let word = prop_oneof![any::<u64>(), Just(0), Just(u64::MAX), Just(1), Just(1 << 63)];
        (any::<bool>(), prop::array::uniform5(word), -300i64..300).prop_map(
            |(is_negative, words, exponent)| {
                let digits = words.iter().flat_map(|&word| [word as u32, (word >> 32) as u32]).collect();
                Long::of_dyadic(
                    &BigInt::new(if is_negative { Sign::Minus } else { Sign::Plus }, digits),
                    exponent,
                )
            },
        )
    }

    fn tiny(bits: u32) -> Rational {
        Rational::new(1.into(), BigInt::from(1) << bits)
    }

    fn size(x: &Rational) -> Rational {
        if *x < Rational::default() { -x.clone() } else { x.clone() }
    }

    proptest! {
        #[test]
        fn results_are_as_near_as_they_say(x in long(), y in long(), f in any::<f64>()) {
            let (a, b) = (exact(&x), exact(&y));
            prop_assert!(size(&(exact(&x.times(&y)) - &a * &b)) <= size(&(&a * &b)) * tiny(255));
            prop_assert!(size(&(exact(&x.plus(&y)) - (&a + &b))) <= (size(&a) + size(&b)) * tiny(254));
            prop_assert_eq!(exact(&x.plus(&x.negative())), Rational::default());
            prop_assert_eq!(exact(&x.scale2(-7)), &a * tiny(7));
            let near = Rational::from_float(x.near()).unwrap();
            prop_assert!(size(&(near - &a)) <= size(&a) * tiny(52));
            let sum: Rational = x.doubles().map(|half| Rational::from_float(half).unwrap()).sum();
            prop_assert_eq!(sum, a);
            if let Some(f_exact) = Rational::from_float(f) {
                prop_assert_eq!(exact(&Long::of(f)), f_exact);
            }
        }

        #[test]
        fn whole_numbers_lose_what_is_beyond_256_bits(n in prop::collection::vec(any::<u32>(), 0..24), k in -50i64..50) {
            let n = BigInt::new(Sign::Minus, n);
            let found = exact(&Long::of_dyadic(&n, k));
            let value = Rational::from_integer(n) * Rational::from_integer(2.into()).pow(k as i32);
            prop_assert!(size(&(found - &value)) <= size(&value) * tiny(255));
        }
    }
}
