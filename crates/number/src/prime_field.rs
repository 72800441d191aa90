//! Prime fields of 62 bits: a cheap look at exact numbers.
//!
//! x ↦ x mod p is a ring homomorphism of the rationals whose denominators p does not divide. So what is not 0
//! modulo p is not 0, polynomials without a common factor modulo p that keep their degrees have none, and an
//! integer is put together from its residues modulo many primes.

use num_bigint::{BigInt, Sign};
use num_traits::{One, Zero};

use super::Rational;

/// The largest prime below 2^62.
const LARGEST: u64 = (1 << 62) - 57;

/// The field of integers modulo a prime p < 2^62; elements are in Montgomery's form x 2^64 mod p.
#[derive(Clone, Copy, Debug)]
pub struct PrimeField {
    p: u64,
    /// −1/p mod 2^64.
    inverse: u64,
    /// 2^128 mod p.
    square: u64,
}

/// The primes below 2^62, decreasing.
pub fn prime_fields() -> impl Iterator<Item = PrimeField> {
    (0..).map(|k| LARGEST - 2 * k).filter(|&p| is_prime(p)).map(PrimeField::new)
}

/// Miller and Rabin with the first twelve primes, which decide all n < 3.3·10^24 (Sorenson and Webster 2015).
fn is_prime(n: u64) -> bool {
    const BASES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    if BASES.iter().any(|&base| n.is_multiple_of(base)) {
        return BASES.contains(&n);
    }
    let field = PrimeField::new(n);
    let (one, minus_one) = (field.of(1), field.of(n - 1));
    let twos = (n - 1).trailing_zeros();
    BASES.iter().all(|&base| {
        let mut x = field.power(field.of(base), (n - 1) >> twos);
        if x == one || x == minus_one {
            return true;
        }
        (1..twos).any(|_| {
            x = field.mul(x, x);
            x == minus_one
        })
    })
}

impl PrimeField {
    /// The field of the largest of these primes.
    pub const LARGEST: PrimeField = PrimeField::new(LARGEST);

    /// For an odd p < 2^62.
    const fn new(p: u64) -> Self {
        // Newton: each round doubles the correct bits of 1/p.
        let (mut inverse, mut round) = (1u64, 0);
        while round < 6 {
            inverse = inverse.wrapping_mul(2u64.wrapping_sub(p.wrapping_mul(inverse)));
            round += 1;
        }
        let square = (u128::MAX % p as u128 + 1) % p as u128;
        PrimeField { p, inverse: inverse.wrapping_neg(), square: square as u64 }
    }

    /// p.
    pub fn prime(&self) -> u64 {
        self.p
    }

    /// x y.
    pub fn mul(&self, x: u64, y: u64) -> u64 {
        let t = u128::from(x) * u128::from(y);
        let m = (t as u64).wrapping_mul(self.inverse);
        let r = ((t + u128::from(m) * u128::from(self.p)) >> 64) as u64;
        if r >= self.p { r - self.p } else { r }
    }

    /// x + y.
    pub fn add(&self, x: u64, y: u64) -> u64 {
        let sum = x + y;
        if sum >= self.p { sum - self.p } else { sum }
    }

    /// x − y.
    pub fn sub(&self, x: u64, y: u64) -> u64 {
        if x >= y { x - y } else { x + self.p - y }
    }

    /// The integer x as an element.
    pub fn of(&self, x: u64) -> u64 {
        self.mul(x % self.p, self.square)
    }

    /// The element as an integer in [0, p).
    pub fn value(&self, x: u64) -> u64 {
        self.mul(x, 1)
    }

    /// The integer x as an element.
    pub fn of_big(&self, x: &BigInt) -> u64 {
        // Horner in the digits: a product by 2^128 mod p in Montgomery's sense is one by 2^64.
        let digits = x.magnitude().iter_u64_digits().rev();
        let residue = digits.fold(0, |r, digit| self.add(self.mul(r, self.square), digit % self.p));
        let element = self.mul(residue, self.square);
        if x.sign() == Sign::Minus { self.sub(0, element) } else { element }
    }

    /// The rational x as an element; `None` where p divides its denominator.
    pub fn of_rational(&self, x: &Rational) -> Option<u64> {
        let denominator = self.of_big(x.denom());
        (denominator != 0).then(|| self.mul(self.of_big(x.numer()), self.invert(denominator)))
    }

    /// x^n.
    pub fn power(&self, x: u64, mut n: u64) -> u64 {
        let (mut result, mut square) = (self.of(1), x);
        while n > 0 {
            if n & 1 == 1 {
                result = self.mul(result, square);
            }
            square = self.mul(square, square);
            n >>= 1;
        }
        result
    }

    /// 1/x, x ≠ 0.
    pub fn invert(&self, x: u64) -> u64 {
        self.power(x, self.p - 2)
    }

    /// The resultant of two polynomials, lowest coefficient first, whose last coefficients are not 0.
    pub fn resultant(&self, mut a: Vec<u64>, mut b: Vec<u64>) -> u64 {
        let mut result = self.of(1);
        while b.len() > 1 {
            let (m, n, leading) = (a.len() - 1, b.len() - 1, b[b.len() - 1]);
            self.reduce(&mut a, &b);
            let Some(d) = a.len().checked_sub(1) else { return 0 };
            // res(a, b) = (−1)^(mn) l^(m − d) res(b, a mod b).
            result = self.mul(result, self.power(leading, (m - d) as u64));
            result = if m * n % 2 == 1 { self.sub(0, result) } else { result };
            std::mem::swap(&mut a, &mut b);
        }
        self.mul(result, self.power(b[0], a.len() as u64 - 1))
    }

    /// a ← a mod b.
    fn reduce(&self, a: &mut Vec<u64>, b: &[u64]) {
        let inverse = self.invert(b[b.len() - 1]);
        while a.len() >= b.len() {
            let factor = self.mul(a.pop().expect("not empty"), inverse);
            let k = a.len() + 1 - b.len();
            for (count, &c) in a[k..].iter_mut().zip(b) {
                *count = self.sub(*count, self.mul(factor, c));
            }
        }
        while a.last() == Some(&0) {
            a.pop();
        }
    }

    /// The monic greatest common divisor of two polynomials, lowest coefficient first, b possibly empty.
    pub fn gcd(&self, mut a: Vec<u64>, mut b: Vec<u64>) -> Vec<u64> {
        while b.last() == Some(&0) {
            b.pop();
        }
        while !b.is_empty() {
            self.reduce(&mut a, &b);
            std::mem::swap(&mut a, &mut b);
        }
        let inverse = a.last().map_or(0, |&leading| self.invert(leading));
        a.iter().map(|&c| self.mul(c, inverse)).collect()
    }

    /// a b mod f.
    fn times_modulo(&self, a: &[u64], b: &[u64], f: &[u64]) -> Vec<u64> {
        let mut product = vec![0; (a.len() + b.len()).saturating_sub(1)];
        for (i, &x) in a.iter().enumerate() {
            for (count, &y) in product[i..].iter_mut().zip(b) {
                *count = self.add(*count, self.mul(x, y));
            }
        }
        self.reduce(&mut product, f);
        product
    }

    /// a^n mod f.
    fn power_modulo(&self, a: Vec<u64>, mut n: u64, f: &[u64]) -> Vec<u64> {
        let (mut result, mut square) = (vec![self.of(1)], a);
        self.reduce(&mut square, f);
        while n > 0 {
            if n & 1 == 1 {
                result = self.times_modulo(&result, &square, f);
            }
            square = self.times_modulo(&square, &square, f);
            n >>= 1;
        }
        result
    }

    /// The roots of a monic polynomial without multiple ones, lowest coefficient first, by increasing values;
    /// `None` where it has fewer than its degree (Cantor and Zassenhaus).
    pub fn roots(&self, f: &[u64]) -> Option<Vec<u64>> {
        let x = || vec![0, self.of(1)];
        if f.len() > 2 && self.power_modulo(x(), self.p, f) != x() {
            return None;
        }
        let (mut open, mut roots, mut shift) = (vec![f.to_vec()], Vec::new(), 0);
        while let Some(f) = open.pop() {
            match &f[..] {
                [] | [_] => {}
                [constant, _] => roots.push(self.sub(0, *constant)),
                _ => {
                    // (x + a)^((p − 1)/2) is 0, 1 or −1 at each root.
                    shift += 1;
                    let power = self.power_modulo(vec![self.of(shift), self.of(1)], (self.p - 1) / 2, &f);
                    open.extend([0, 1, self.p - 1].map(|value| {
                        let mut power = if power.is_empty() { vec![0] } else { power.clone() };
                        power[0] = self.sub(power[0], self.of(value));
                        self.gcd(f.clone(), power)
                    }));
                }
            }
        }
        roots.sort_by_key(|&root| self.value(root));
        Some(roots)
    }
}

/// Integers known modulo a growing product of primes.
pub struct Lift {
    values: Vec<BigInt>,
    product: BigInt,
}

impl Lift {
    pub fn new(n: usize) -> Self {
        Lift { values: vec![BigInt::zero(); n], product: BigInt::one() }
    }

    /// The product of the primes so far.
    pub fn product(&self) -> &BigInt {
        &self.product
    }

    /// Joins the residues modulo one more prime; whether any integer nearest 0 changed.
    pub fn join(&mut self, field: &PrimeField, residues: &[u64]) -> bool {
        let inverse = field.invert(field.of_big(&self.product));
        let next = &self.product * field.prime();
        let mut changed = false;
        for (value, &residue) in self.values.iter_mut().zip(residues) {
            let step = field.value(field.mul(field.sub(residue, field.of_big(value)), inverse));
            // The representative nearest 0 of value + product · step, |value| ≤ product/2.
            let step =
                if step > field.prime() / 2 { BigInt::from(step) - field.prime() } else { step.into() };
            changed |= !step.is_zero();
            *value += &self.product * step;
        }
        self.product = next;
        changed
    }

    pub fn into_values(self) -> Vec<BigInt> {
        self.values
    }
}
