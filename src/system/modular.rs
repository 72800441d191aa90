//! Linear algebra over prime fields of 62 bits, from which exact integers are put together.

use nalgebra::DMatrix;
use num_bigint::{BigInt, Sign};
use num_traits::{One, Zero};

/// The field of integers modulo a prime p < 2^62; elements are in Montgomery's form x 2^64 mod p.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    p: u64,
    /// −1/p mod 2^64.
    inverse: u64,
    /// 2^128 mod p.
    square: u64,
}

/// The primes below 2^62, decreasing.
pub(super) fn fields() -> impl Iterator<Item = Field> {
    (0..).map(|k| (1 << 62) - 1 - 2 * k).filter(|&p| is_prime(p)).map(Field::new)
}

/// Miller and Rabin with the first twelve primes, which decide all n < 3.3·10^24 (Sorenson and Webster 2015).
fn is_prime(n: u64) -> bool {
    const BASES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    if BASES.iter().any(|&base| n.is_multiple_of(base)) {
        return BASES.contains(&n);
    }
    let field = Field::new(n);
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

impl Field {
    /// For an odd p < 2^62.
    fn new(p: u64) -> Self {
        // Newton: each round doubles the correct bits of 1/p.
        let inverse = (0..6).fold(1u64, |x, _| x.wrapping_mul(2u64.wrapping_sub(p.wrapping_mul(x))));
        let square = (u128::MAX % u128::from(p) + 1) % u128::from(p);
        Field { p, inverse: inverse.wrapping_neg(), square: square as u64 }
    }

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

    pub fn add(&self, x: u64, y: u64) -> u64 {
        let sum = x + y;
        if sum >= self.p { sum - self.p } else { sum }
    }

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

    pub fn of_big(&self, x: &BigInt) -> u64 {
        // Horner in the digits: a product by 2^128 mod p in Montgomery's sense is one by 2^64.
        let digits = x.magnitude().iter_u64_digits().rev();
        let residue = digits.fold(0, |r, digit| self.add(self.mul(r, self.square), digit % self.p));
        let element = self.mul(residue, self.square);
        if x.sign() == Sign::Minus { self.sub(0, element) } else { element }
    }

    fn power(&self, x: u64, mut n: u64) -> u64 {
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

    pub fn matrix(&self, m: &DMatrix<BigInt>) -> DMatrix<u64> {
        m.map(|x| self.of_big(&x))
    }

    /// The rank, by elimination.
    pub fn rank(&self, mut m: DMatrix<u64>) -> usize {
        let mut rank = 0;
        for column in 0..m.ncols() {
            let Some(pivot) = (rank..m.nrows()).find(|&i| m[(i, column)] != 0) else { continue };
            m.swap_rows(rank, pivot);
            let inverse = self.invert(m[(rank, column)]);
            for i in rank + 1..m.nrows() {
                let factor = self.mul(m[(i, column)], inverse);
                for j in column..m.ncols() {
                    m[(i, j)] = self.sub(m[(i, j)], self.mul(factor, m[(rank, j)]));
                }
            }
            rank += 1;
        }
        rank
    }

    /// The coefficients of det(z − m), lowest first, monic; by reduction to Hessenberg's form.
    pub fn characteristic(&self, mut m: DMatrix<u64>) -> Vec<u64> {
        self.reduce_to_hessenberg(&mut m);
        // f_k = det(z − leading k x k) = (z − m_kk) f_(k−1) − Σ_i m_ik (subdiagonals i+1..k) f_(i−1).
        let mut f: Vec<Vec<u64>> = vec![vec![self.of(1)]];
        for k in 0..m.nrows() {
            let mut next = vec![0; k + 2];
            for (j, &c) in f[k].iter().enumerate() {
                next[j + 1] = self.add(next[j + 1], c);
                next[j] = self.sub(next[j], self.mul(m[(k, k)], c));
            }
            let mut below = self.of(1);
            for i in (0..k).rev() {
                below = self.mul(below, m[(i + 1, i)]);
                let factor = self.mul(below, m[(i, k)]);
                for (j, &c) in f[i].iter().enumerate() {
                    next[j] = self.sub(next[j], self.mul(factor, c));
                }
            }
            f.push(next);
        }
        f.pop().expect("not empty")
    }

    fn reduce_to_hessenberg(&self, m: &mut DMatrix<u64>) {
        let n = m.nrows();
        for k in 1..n.saturating_sub(1) {
            let Some(pivot) = (k..n).find(|&i| m[(i, k - 1)] != 0) else { continue };
            m.swap_rows(k, pivot);
            m.swap_columns(k, pivot);
            let inverse = self.invert(m[(k, k - 1)]);
            for i in k + 1..n {
                let factor = self.mul(m[(i, k - 1)], inverse);
                if factor == 0 {
                    continue;
                }
                for j in 0..n {
                    m[(i, j)] = self.sub(m[(i, j)], self.mul(factor, m[(k, j)]));
                }
                for j in 0..n {
                    m[(j, k)] = self.add(m[(j, k)], self.mul(factor, m[(j, i)]));
                }
            }
        }
    }

    /// The monic greatest common divisor of two polynomials, lowest coefficient first, b possibly empty.
    pub fn gcd(&self, mut a: Vec<u64>, mut b: Vec<u64>) -> Vec<u64> {
        while b.last() == Some(&0) {
            b.pop();
        }
        while let Some(&leading) = b.last() {
            let inverse = self.invert(leading);
            while a.len() >= b.len() {
                let factor = self.mul(a.pop().expect("not empty"), inverse);
                let k = a.len() + 1 - b.len();
                for (own, &c) in a[k..].iter_mut().zip(&b) {
                    *own = self.sub(*own, self.mul(factor, c));
                }
            }
            while a.last() == Some(&0) {
                a.pop();
            }
            std::mem::swap(&mut a, &mut b);
        }
        let inverse = a.last().map_or(0, |&leading| self.invert(leading));
        a.iter().map(|&c| self.mul(c, inverse)).collect()
    }
}

/// Integers known modulo a growing product of primes.
pub(super) struct Lift {
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
    pub fn join(&mut self, field: &Field, residues: &[u64]) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_computes() {
        let field = fields().next().unwrap();
        assert_eq!(field.prime(), (1 << 62) - 57); // the largest prime below 2^62
        let x = field.of(123_456_789_012_345_678);
        assert_eq!(field.value(field.mul(x, field.invert(x))), 1);
        let big = BigInt::from(-7) * (BigInt::one() << 300);
        let direct = field.mul(field.of(7), field.power(field.of(2), 300));
        assert_eq!(field.of_big(&big), field.sub(0, direct));
    }

    #[test]
    fn the_characteristic_polynomial_of_a_companion_matrix_is_its_polynomial() {
        let field = fields().nth(3).unwrap();
        // z^4 - 2 z^3 + 3 z^2 - 5 z + 7.
        let last = [-7, 5, -3, 2];
        let m =
            DMatrix::from_fn(4, 4, |i, j| BigInt::from(if j == 3 { last[i] } else { i64::from(i == j + 1) }));
        let got: Vec<_> = field.characteristic(field.matrix(&m));
        let want: Vec<_> = [7, -5, 3, -2, 1].map(|c| field.of_big(&BigInt::from(c))).into();
        assert_eq!(got, want);
    }
}
