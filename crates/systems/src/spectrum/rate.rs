//! ln |λ| of a multiplier, enclosed.
//!
//! 1 + 2 μ = cosh(ln λ), and |cosh z − 1| + |cosh z + 1| = 2 cosh(Re z). So with the *excess*
//!
//! ```text
//!     e = (|μ| + |μ + 1| − 1)/2 ≥ 0:        ln |λ| = 2 asinh √e.
//! ```
//!
//! Over a disc of radius r about μ the excess moves by at most r, and since d ln λ/dμ = 1/√(μ (μ + 1)),
//! ln |λ| by at most r/√((|μ| − r) (|μ + 1| − r)).

use num_complex::Complex64;

use number::{Ball, Laurent, Rational, Real, from_f64_exact};

/// A pair λ, 1/λ of multipliers of one period: λ + 1/λ = 2 + 4 μ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multiplier {
    /// Rounded.
    pub mu: Complex64,
    /// The true μ is within this of it (as many true ones as discs, where discs meet); `None`: not bounded.
    pub radius: Option<f64>,
    /// An enclosure of ln |λ| for the one with |λ| ≥ 1 (of each of those whose discs meet); `None`: not
    /// bounded.
    pub growth: Option<(f64, f64)>,
    /// The one with |λ| ≥ 1, rounded.
    pub lambda: Complex64,
}

impl Multiplier {
    /// λ = exp(2 asinh √μ).
    pub fn new(mu: Complex64, radius: Option<f64>, growth: Option<(f64, f64)>) -> Self {
        Multiplier { mu, radius, growth, lambda: exponent(mu).exp() }
    }
}

impl Multiplier {
    /// |λ|, rounded.
    pub fn size(&self) -> f64 {
        self.lambda.norm()
    }
}

/// ln λ = 2 asinh √μ, real part ≥ 0: λ + 1/λ = 2 + 4 sinh²(ln λ/2).
pub fn exponent(mu: Complex64) -> Complex64 {
    let z = mu.sqrt().asinh() * 2.0;
    if z.re < 0.0 { -z } else { z }
}

/// With an excess of 2^-100, say for a pair 10^-15 beside the segment \[−1, 0\], these leave the digits of a
/// double.
const BITS: u32 = 256;

/// An enclosure of ln |λ| over a period, or of a growth rate.
pub type Range = (f64, f64);

fn exact(x: f64) -> Ball {
    Ball::from_rational(&from_f64_exact(x).unwrap_or_default(), BITS)
}

/// The excess of x + i y.
pub fn excess(x: &Ball, y: &Ball, bits: u32) -> Ball {
    let one = Ball::one();
    let size = |x: &Ball| {
        let square = x.square(bits).add(&y.square(bits), bits);
        square.sqrt_clipped(bits).expect("a sum of squares")
    };
    size(x).add(&size(&x.add(&one, bits)), bits).sub(&one, bits).scale2(-1)
}

/// 2 asinh √e between two excesses; what is below 0 counts as 0.
pub fn between(lo: &Rational, hi: &Rational) -> Range {
    let of = |e: &Rational| {
        let e = Ball::from_rational(e, BITS);
        e.sqrt_clipped(BITS).map_or_else(Ball::zero, |root| root.asinh(BITS).scale2(1)).to_f64_enclosure()
    };
    (of(lo).0.max(0.0), of(hi).1.max(0.0))
}

/// ln |λ| for all μ within `radius`.
pub fn about(mu: Complex64, radius: f64) -> Range {
    if !(mu.re.is_finite() && mu.im.is_finite() && radius.is_finite()) {
        return (0.0, f64::INFINITY);
    }
    let (x, y) = (exact(mu.re), exact(mu.im));
    let ball = if mu.im == 0.0 {
        // Exactly: no root cancels.
        let above = exact(mu.re.max(0.0));
        above.add(&exact((-mu.re).max(1.0)).sub(&Ball::one(), BITS), BITS)
    } else {
        excess(&x, &y, BITS)
    };
    let off = from_f64_exact(radius).unwrap_or_default();
    let by_excess = between(&(ball.lower() - &off), &(ball.upper() + &off));
    let nearer = mu.norm().min((mu + 1.0).norm());
    if radius > nearer / 2.0 {
        return by_excess;
    }
    // The roundings of some products of factors that do not cancel.
    let moved = 1.01 * radius / ((mu.norm() - radius) * ((mu + 1.0).norm() - radius)).sqrt();
    let (lo, hi) = between(&ball.lower(), &ball.upper());
    (by_excess.0.max((lo - moved).next_down()), by_excess.1.min((hi + moved).next_up()))
}

/// The largest of some enclosed numbers.
pub fn largest(ranges: impl Iterator<Item = Range>) -> Range {
    ranges.fold((0.0, 0.0), |(a, b): Range, (lo, hi)| (a.max(lo), b.max(hi)))
}

/// ln |λ|/T.
pub fn per_time((lo, hi): Range, period: &Laurent) -> Range {
    let period = period.enclosure(BITS);
    let over = |x: f64| exact(x).div(&period, BITS).map(|rate| rate.to_f64_enclosure());
    let above = if hi.is_finite() { over(hi) } else { None };
    (over(lo).map_or(0.0, |ends| ends.0.max(0.0)), above.map_or(f64::INFINITY, |ends| ends.1))
}

/// The middle, for figures and sums that are rounded.
pub fn middle((lo, hi): Range) -> f64 {
    if hi.is_finite() { lo + (hi - lo) / 2.0 } else { hi }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_of_a_disc_holds_the_growth_of_its_points_and_little_more() {
        let growth = |mu: Complex64| (mu.sqrt().asinh() * 2.0).re.abs();
        for (re, im) in
            [(2.0, 0.0), (-1.5, 0.0), (-0.3, 0.4), (-0.5, 1e-3), (0.2, -0.7), (-0.5, 0.0), (1e-9, 0.0)]
        {
            let mu = Complex64::new(re, im);
            for radius in [0.0, 1e-12, 1e-5, 1e-2] {
                let (lo, hi) = about(mu, radius);
                for k in 0..12 {
                    let point = mu + Complex64::from_polar(radius, f64::from(k));
                    // The roundings of the complex functions.
                    let (own, off) = (growth(point), 1e-14 + 1e-7 * f64::from(u8::from(re.abs() < 1e-6)));
                    assert!(lo - off <= own && own <= hi + off, "{mu} {radius}: {own} in {lo}..{hi}");
                }
                // The derivative of ln λ is at most 1/√(|μ| |μ + 1|).
                let slope = 1.0 / (mu.norm() * (mu + 1.0).norm()).sqrt();
                assert!(radius > 0.1 * mu.norm() || hi - lo <= 1e-15 + 3.0 * radius * slope, "{mu} {radius}");
            }
        }
        // Beside the segment: e = y²/(4 |x| (1 + x)) to first order, ln |λ| = y/√(|x| (1 + x)).
        let (lo, hi) = about(Complex64::new(-0.5, 1e-15), 0.0);
        assert!(lo > 1.999_999e-15 && hi < 2.000_001e-15 && hi - lo < 1e-30);
    }
}
