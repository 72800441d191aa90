//! The field ℚ(2cos(π/n)): its generator and minimal polynomial.

use std::sync::Arc;

use num_bigint::BigInt;
use num_traits::{One, Zero};

use crate::Ball;
use crate::element::NumberField;

/// The field ℚ(c), c = 2cos(π/n); cheap to clone.
#[derive(Clone, Debug)]
pub struct CyclotomicField {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    n: u32,
    /// ψ, monic, lowest coefficient first.
    minimal: Vec<BigInt>,
}

impl CyclotomicField {
    /// ℚ(2cos(π/n)), of degree φ(2n)/2 for n ≥ 2 and 1 for n = 1.
    ///
    /// **Panics** if n = 0.
    pub fn new(n: u32) -> CyclotomicField {
        assert!(n > 0, "2cos(π/0)");
        CyclotomicField { shared: Arc::new(Shared { n, minimal: minimal_polynomial(n) }) }
    }

    /// The n of 2cos(π/n).
    pub fn n(&self) -> u32 {
        self.shared.n
    }
}

impl PartialEq for CyclotomicField {
    fn eq(&self, other: &CyclotomicField) -> bool {
        self.n() == other.n()
    }
}

impl NumberField for CyclotomicField {
    fn minimal(&self) -> &[BigInt] {
        &self.shared.minimal
    }

    fn generator(&self, bits: u32) -> Ball {
        let n = Ball::from_integer(&self.n().into());
        let angle = Ball::pi(bits + 8).div(&n, bits + 8).expect("n > 0");
        angle.cos(bits).scale2(1)
    }

    fn names(&self) -> (&'static str, String) {
        ("c", format!("2cos(pi/{})", self.n()))
    }
}

/// ψ_n, the minimal polynomial of 2cos(π/n), from Φ_2n (see the module's head).
fn minimal_polynomial(n: u32) -> Vec<BigInt> {
    if n == 1 {
        return vec![BigInt::from(2), BigInt::one()]; // 2cos π = −2
    }
    let phi = cyclotomic_polynomial(2 * n as usize);
    let d = phi.len() / 2;
    let mut psi = vec![BigInt::zero(); d + 1];
    psi[0] = phi[d].clone();
    let (mut before, mut t) = (vec![BigInt::from(2)], vec![BigInt::zero(), BigInt::one()]);
    for k in 1..=d {
        for (integer, c) in psi.iter_mut().zip(&t) {
            *integer += &phi[d - k] * c;
        }
        // T_{k+1} = c T_k − T_{k−1}.
        let mut next: Vec<BigInt> = std::iter::once(BigInt::zero()).chain(t.iter().cloned()).collect();
        next.iter_mut().zip(&before).for_each(|(integer, c)| *integer -= c);
        (before, t) = (t, next);
    }
    psi
}

/// Φ_m = Π_{d | m} (x^d − 1)^μ(m/d), lowest coefficient first.
fn cyclotomic_polynomial(m: usize) -> Vec<BigInt> {
    let divisors: Vec<(usize, i8)> =
        (1..=m).filter(|d| m.is_multiple_of(*d)).map(|d| (d, moebius(m / d))).collect();
    let mut product = vec![BigInt::one()];
    for &(d, _) in divisors.iter().filter(|(_, mu)| *mu == 1) {
        // times x^d − 1
        let mut next = vec![BigInt::zero(); product.len() + d];
        for (k, c) in product.iter().enumerate() {
            next[k + d] += c;
            next[k] -= c;
        }
        product = next;
    }
    for &(d, _) in divisors.iter().filter(|(_, mu)| *mu == -1) {
        // by x^d − 1, exactly: q_k = q_{k−d} − p_k
        let mut quotient: Vec<BigInt> = Vec::with_capacity(product.len() - d);
        for k in 0..product.len() - d {
            let carried = if k >= d { quotient[k - d].clone() } else { BigInt::zero() };
            quotient.push(carried - &product[k]);
        }
        product = quotient;
    }
    product
}

/// The Möbius function μ.
fn moebius(mut n: usize) -> i8 {
    let (mut mu, mut prime) = (1, 2);
    while n > 1 {
        if n.is_multiple_of(prime) {
            n /= prime;
            if n.is_multiple_of(prime) {
                return 0;
            }
            mu = -mu;
        }
        prime += 1;
    }
    mu
}
