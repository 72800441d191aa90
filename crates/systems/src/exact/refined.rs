//! The eigenvalues μ of Bᵀ C over ℚ, to as many digits as the growth of the fastest asks for.
//!
//! Approximations z_i of the n simple roots of f(z) = Π (z − μ_i) all move by their corrections (Weierstrass;
//! Durand, Kerner)
//!
//! ```text
//!     w_i = f(z_i)/Π (z_i − z_j).
//! ```
//!
//! The matrix diag(z) − w (1, ..., 1) has the characteristic polynomial f, so by Gershgorin all roots lie in
//! the discs of radius n |w_i| about z_i, and in a disc that meets no other there is one. The z_i are
//! Gaussian integers over 2^bits and the products exact; the coefficients of f are known to 2^-fraction, and
//! so is each step of Horner's scheme: f(z) to 3 n max(1, |z|)^n of these.

use num_bigint::BigInt;
use num_complex::{Complex, Complex64};
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use crate::spectrum::rate::{self, Multiplier};
use number::rational::scale2;
use number::{Ball, Rational, U, to_f64};

type Gaussian = Complex<BigInt>;

/// 2^13 bits resolve an excess of 2^-8000: none is nearer to 0 among systems that exact arithmetic decides in
/// seconds.
const MOST_BITS: u32 = 1 << 13;

/// Corrections at one precision: from far, each takes away some n-th part of the distance.
const MOST_ROUNDS: usize = 1_000;

/// Products of words over n³ times those of one number: n² steps of Horner's scheme and n² factors, n words
/// of each, in complex numbers.
const PRODUCTS: u64 = 6;

/// Relative bits of the largest excess that a double's digits of its growth need.
const ACCURACY: u32 = 58;

struct Roots<'a> {
    /// Products of machine words that may still be spent.
    left: u64,
    /// The coefficients of a monic polynomial in z = d μ, the lowest first.
    f: &'a [BigInt],
    d: &'a BigInt,
    bits: u32,
    points: Vec<Gaussian>,
    /// Of the discs, in units of 2^-bits.
    radii: Vec<BigInt>,
}

/// A correction in units of 2^-bits, and how far it can be off.
struct Correction {
    w: Gaussian,
    off: BigInt,
}

/// The roots μ = z/d of a monic squarefree polynomial in z, each with an enclosure of its growth; the largest
/// to a double's digits. `None` where that takes more than [`MOST_BITS`], or more than `most` products of
/// machine words.
pub fn multipliers(f: &[BigInt], d: &BigInt, most: u64) -> Option<Vec<Multiplier>> {
    let mut roots = Roots { left: most, ..Roots::start(f, d) };
    loop {
        roots.settle()?;
        if let Some(found) = roots.are_apart().then(|| roots.accurate()).flatten() {
            return Some(found);
        }
        roots.refine()?;
    }
}

impl<'a> Roots<'a> {
    /// On a circle that no root is outside of (Fujiwara's), with no symmetry.
    fn start(f: &'a [BigInt], d: &'a BigInt) -> Roots<'a> {
        let (n, bits) = (f.len() - 1, 128);
        // log2 of |f_(n−k)|/d^k, over k, rounded up.
        let size = |k: usize| (f[n - k].bits() as i64).div_euclid(k as i64) + 2 - d.bits() as i64;
        let size = (1..=n).map(size).max().unwrap_or(0).max(-i64::from(bits) / 2) + 1;
        let point = |i: usize| {
            let angle = 0.4 + std::f64::consts::TAU * i as f64 / n as f64;
            let part =
                |x: f64| shifted(&BigInt::from((x * 2f64.powi(52)) as i64), i64::from(bits) - 52 + size);
            Complex::new(part(angle.cos()), part(angle.sin()))
        };
        Roots {
            points: (0..n).map(point).collect(),
            radii: vec![BigInt::zero(); n],
            f,
            d,
            bits,
            left: u64::MAX,
        }
    }

    /// The places of coefficients: a cluster of roots takes as many more as its product of distances is
    /// small.
    fn fraction(&self) -> u32 {
        2 * self.bits + 64
    }

    /// The coefficients in μ, rounded down.
    fn coefficients(&self) -> Vec<BigInt> {
        let (n, mut power) = (self.f.len() - 1, BigInt::one());
        let mut all = vec![BigInt::zero(); n + 1];
        for k in (0..=n).rev() {
            all[k] = (&self.f[k] << self.fraction()).div_floor(&power);
            power *= self.d;
        }
        all
    }

    /// Twice the bits.
    fn refine(&mut self) -> Option<()> {
        let more = self.bits;
        self.bits = self.bits.checked_mul(2).filter(|bits| *bits <= MOST_BITS)?;
        self.points.iter_mut().for_each(|z| *z = Complex::new(&z.re << more, &z.im << more));
        Some(())
    }

    /// The products of words that one correction of every root takes: Horner's scheme, and the distances to
    /// the others, whose product becomes n times as long as one of them.
    fn spend(&mut self) -> Option<()> {
        let parts = self.points.iter().map(|z| z.re.bits().max(z.im.bits())).max().unwrap_or(0);
        let (n, words) = (self.points.len() as u64, (parts.max(self.bits.into()) / 64 + 1));
        let (cube, square) = (n.saturating_pow(3), words.saturating_mul(words));
        self.left = self.left.checked_sub(cube.saturating_mul(square).saturating_mul(PRODUCTS))?;
        Some(())
    }

    /// Corrects until only what is not known of the corrections moves; `None` where two approximations meet,
    /// and where they cost too much.
    fn settle(&mut self) -> Option<()> {
        let (n, coefficients) = (BigInt::from(self.points.len()), self.coefficients());
        for round in 0..=MOST_ROUNDS {
            self.spend()?;
            let all = (0..self.points.len()).map(|i| self.correction(&coefficients, i));
            let all = all.collect::<Option<Vec<Correction>>>()?;
            let size = |correction: &Correction| correction.w.re.abs() + correction.w.im.abs();
            self.radii = all.iter().map(|correction| (size(correction) + &correction.off) * &n).collect();
            if round == MOST_ROUNDS || all.iter().all(|correction| size(correction) <= correction.off) {
                break;
            }
            self.points.iter_mut().zip(all).for_each(|(z, correction)| *z = &*z - correction.w);
        }
        Some(())
    }

    fn correction(&self, coefficients: &[BigInt], i: usize) -> Option<Correction> {
        let (x, n, bits, fraction) = (&self.points[i], self.f.len() - 1, self.bits as usize, self.fraction());
        let mut value = Complex::new(coefficients[n].clone(), BigInt::zero());
        for c in coefficients[..n].iter().rev() {
            value *= x;
            value = Complex::new((value.re >> bits) + c, value.im >> bits);
        }
        let others = self.points.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, other)| x - other);
        let product =
            others.fold(Complex::new(BigInt::one(), BigInt::zero()), |product, value| product * value);
        let size = product.norm_sqr();
        if size.is_zero() {
            return None;
        }
        // Both in units of 2^-(n bits).
        let moved = |x: &BigInt| shifted(x, (n * bits) as i64 - i64::from(fraction));
        let largest = ((x.re.abs() + x.im.abs()) >> bits) + 1u8;
        let off = moved(&(num_traits::pow(largest, n) * (3 * n))) + 2u8;
        let whole = Complex::new(moved(&value.re), moved(&value.im)) * product.conj();
        let w = Complex::new(whole.re.div_floor(&size), whole.im.div_floor(&size));
        Some(Correction { w, off: off / size.sqrt() + 3u8 })
    }

    fn meet(&self, i: usize, z: &Gaussian, j: usize) -> bool {
        let reach = &self.radii[i] + &self.radii[j];
        (z - &self.points[j]).norm_sqr() <= &reach * &reach
    }

    fn are_apart(&self) -> bool {
        let n = self.points.len();
        (0..n).all(|i| (0..i).all(|j| !self.meet(i, &self.points[i], j)))
    }

    /// Whether the root in an isolated disc is real: the conjugate one lies in the mirrored disc, which meets
    /// no other.
    fn is_real(&self, i: usize) -> bool {
        let mirrored = self.points[i].conj();
        (0..self.points.len()).all(|j| (i == j) == self.meet(i, &mirrored, j))
    }

    /// All roots, the discs being apart, where the largest excess is known accurately.
    fn accurate(&self) -> Option<Vec<Multiplier>> {
        let excesses: Vec<(Rational, Rational)> = (0..self.points.len()).map(|i| self.excess(i)).collect();
        let lo = excesses.iter().map(|excess| &excess.0).max()?;
        let hi = excesses.iter().map(|excess| &excess.1).max()?;
        if (hi - lo) * Rational::from_integer(BigInt::one() << ACCURACY) > *hi {
            return None;
        }
        Some(excesses.iter().enumerate().map(|(i, pair)| self.multiplier(i, pair)).collect())
    }

    fn excess(&self, i: usize) -> (Rational, Rational) {
        let (z, radius, scale) = (&self.points[i], &self.radii[i], -i64::from(self.bits));
        let inside = z.re < -radius.clone() && &z.re - radius > -(BigInt::one() << self.bits);
        if inside && self.is_real(i) {
            return Default::default();
        }
        let part = |x: &BigInt| Ball::from_integer(x).scale2(scale);
        let ball = rate::excess(&part(&z.re), &part(&z.im), 2 * self.bits + 64);
        let off = scale2(radius, scale);
        ((ball.lower() - &off).max(Rational::zero()), ball.upper() + off)
    }

    fn multiplier(&self, i: usize, (lo, hi): &(Rational, Rational)) -> Multiplier {
        let double = |x: &BigInt| to_f64(&scale2(x, -i64::from(self.bits)));
        let (z, radius) = (&self.points[i], double(&self.radii[i]));
        let im = if self.is_real(i) { 0.0 } else { double(&z.im) };
        let mu = Complex64::new(double(&z.re), im);
        // The roundings of both parts, and a real root's way to the axis.
        Multiplier::new(mu, Some(2.1 * (radius + U * mu.norm())), Some(rate::between(lo, hi)))
    }
}

/// x 2^k, rounded down.
fn shifted(x: &BigInt, k: i64) -> BigInt {
    if k >= 0 { x << k } else { x >> -k }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(coefficients: &[i64], d: i64) -> Vec<Multiplier> {
        let f: Vec<BigInt> = coefficients.iter().map(|&c| c.into()).collect();
        let mut found = multipliers(&f, &d.into(), u64::MAX).unwrap();
        found.sort_by(|a, b| a.mu.re.total_cmp(&b.mu.re).then(a.mu.im.total_cmp(&b.mu.im)));
        found
    }

    #[test]
    fn roots_of_an_integer_polynomial_come_with_their_growth() {
        // (z − 4)(z + 1)(z² + 2 z + 5), z = 2 μ: μ = 2, −1/2, −1/2 ± i.
        let found = of(&[-20, -23, -5, -1, 1], 2);
        let growth = |k: usize| found[k].growth.unwrap();
        let near = |(lo, hi): (f64, f64), x: f64| lo <= x + 1e-15 && x - 1e-15 <= hi && hi - lo < 1e-15;
        assert_eq!(found.iter().filter(|multiplier| multiplier.mu.im == 0.0).count(), 2);
        assert_eq!(found.iter().filter(|multiplier| multiplier.growth == Some((0.0, 0.0))).count(), 1);
        assert!(near(growth(3), 2.0 * 2f64.sqrt().asinh()), "{found:?}");
        // |μ| = |μ + 1| = √5/2.
        let pair = found.iter().find(|multiplier| multiplier.mu.im > 0.0).unwrap();
        assert!(near(pair.growth.unwrap(), 2.0 * ((5f64.sqrt() - 1.0) / 2.0).sqrt().asinh()), "{found:?}");
    }

    #[test]
    fn roots_that_cost_more_than_is_allowed_are_not_found() {
        let f: Vec<BigInt> = [-20, -23, -5, -1, 1].map(BigInt::from).to_vec();
        assert!(multipliers(&f, &2.into(), 1 << 10).is_none());
        assert!(multipliers(&f, &2.into(), 1 << 20).is_some());
    }

    #[test]
    fn a_root_beside_the_edge_is_told_from_its_neighbours() {
        // z = 10^15 μ: μ = 10^-15, −10^-15, and −1/2 − 10^-15.
        let d = BigInt::from(10u64.pow(15));
        let third: BigInt = &d / 2u8 + 1u8;
        let f = [-third.clone(), -BigInt::one(), third, BigInt::one()];
        let found = multipliers(&f, &d, u64::MAX).unwrap();
        let (lo, hi) = rate::largest(found.iter().filter_map(|multiplier| multiplier.growth));
        let want = 2.0 * 1e-15f64.sqrt().asinh();
        assert!(lo <= want * (1.0 + 1e-15) && want * (1.0 - 1e-15) <= hi && hi / lo - 1.0 < 1e-15);
    }
}
