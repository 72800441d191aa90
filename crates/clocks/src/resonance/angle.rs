//! θ, the turn of the fast clock's solution in one step, and what follows from it.

use num_traits::Signed;

use crate::propagator::TwoClocks;
use number::{Ball, Rational, Real, Sign};

/// θ ∈ (0, π) with cos θ = 1 − s/2, that is s = 4 sin²(θ/2); enclosed.
#[derive(Clone, Debug)]
pub struct Angle<S> {
    s: S,
}

/// How far a pair is from the nearest resonance p θ = m π, m ≥ 1.
#[derive(Clone, Debug)]
pub struct Nearest {
    /// The integer nearest to p θ/π: 0, which is no resonance, where q h2 is shorter than half of T½.
    pub m: u64,
    /// p θ/π − m, enclosed: the distance of q h2 from m T½, in units of T½.
    pub distance: Ball,
}

impl<S: Real> Angle<S> {
    /// The angle of s = h1² L1, or `None` outside 0 < s < 4, where the fast clock alone does not turn.
    pub fn new(s: S) -> Option<Self> {
        let mut below_4 = S::from_rational(&Rational::from_integer(4.into()));
        below_4 -= s.clone();
        let turns = s.sign() == Sign::Positive && below_4.sign() == Sign::Positive;
        turns.then_some(Angle { s })
    }

    /// θ = 2 atan √(s/(4 − s)), with about `bits` correct bits.
    pub fn theta(&self, bits: u32) -> Ball {
        let s = self.s.enclosure(bits + 16);
        let mut rest = S::from_rational(&Rational::from_integer(4.into()));
        rest -= self.s.clone();
        // Both factors are positive, and from exact values: no cancellation near s = 4.
        let tan2 = s.div(&rest.enclosure(bits + 16), bits + 16).expect("4 - s > 0");
        tan2.sqrt(bits + 16).expect("s > 0").atan(bits + 8).scale2(1)
    }

    /// θ/π = h1/T½: the fast clock's step as a fraction of its effective half period.
    pub fn over_pi(&self, bits: u32) -> Ball {
        self.theta(bits + 8).div(&Ball::pi(bits + 16), bits + 8).expect("pi > 0")
    }

    /// The nearest resonance of a ratio with numerator p; its distance is exact where a double can hold it
    /// and θ/π is rational, so exactly 0 on a resonance.
    ///
    /// p θ/π is half an odd integer only if θ/π is rational, and then (unless s is one of the cyclotomic
    /// values) s = 2, p odd: the smaller m is taken.
    pub fn nearest(&self, p: u64, bits: u32) -> Nearest {
        self.nearest_from(0, p, bits)
    }

    /// The nearest m ≥ `least`.
    fn nearest_from(&self, least: u64, p: u64, bits: u32) -> Nearest {
        if let Some((m, distance)) = self.rational_nearest(least, p) {
            return Nearest { m, distance: Ball::from_rational(&distance, bits) };
        }
        let turns = self.over_pi(bits + 64).mul(&Ball::from_integer(&p.into()), bits + 64);
        let (twice, _) = turns.mid_scaled(1);
        let m = (twice / 2u8).max(least.into());
        let next: num_bigint::BigInt = &m + 1;
        let distance = |m: &num_bigint::BigInt| turns.sub(&Ball::from_integer(m), bits);
        let nearer = distance(&next).abs().compare(&distance(&m).abs()) == Some(std::cmp::Ordering::Less);
        let m = if nearer { next } else { m };
        Nearest { distance: distance(&m), m: m.try_into().unwrap_or(u64::MAX) }
    }
}

impl<S: Real> Angle<S> {
    /// Whether q h2 lies within `tolerance` half periods of an integer multiple of T½: |p θ/π − m| ≤
    /// tolerance for some m ≥ 1.
    ///
    /// Decided: θ/π is rational only where 2 cos θ is an algebraic integer. For rational s that leaves
    /// s = 1, 2, 3, and no transcendental s at all; elsewhere more bits always decide.
    pub fn is_resonant(&self, p: u64, tolerance: &Rational) -> bool {
        if let Some((_, distance)) = self.rational_nearest(1, p) {
            return distance.abs() <= *tolerance;
        }
        let mut bits = 64;
        loop {
            let nearest = self.nearest_from(1, p, bits);
            if let Some(order) = nearest.distance.abs().compare(&Ball::from_rational(tolerance, bits)) {
                return order.is_le();
            }
            bits *= 2;
        }
    }

    /// The nearest m ≥ `least` and p θ/π − m where θ/π is rational; of two the smaller m.
    fn rational_nearest(&self, least: u64, p: u64) -> Option<(u64, Rational)> {
        let turns = self.rational_over_pi()? * Rational::from_integer(p.into());
        let half = Rational::new(1.into(), 2.into());
        let m = (&turns - half).ceil().max(Rational::from_integer(least.into()));
        Some((m.to_integer().try_into().unwrap_or(u64::MAX), turns - m))
    }

    /// θ/π where s is 1, 2 or 3: 1/3, 1/2, 2/3.
    fn rational_over_pi(&self) -> Option<Rational> {
        let is = |n: i64| {
            let mut difference = self.s.clone();
            difference -= S::from_rational(&Rational::from_integer(n.into()));
            difference.sign() == Sign::Zero
        };
        let value = |n: i64, d: i64| Rational::new(n.into(), d.into());
        [(1, value(1, 3)), (2, value(1, 2)), (3, value(2, 3))]
            .into_iter()
            .find(|(s, _)| is(*s))
            .map(|(_, t)| t)
    }
}

impl<S: Real> TwoClocks<S> {
    /// The fast clock's angle; `None` beyond its Verlet limit s = 4.
    pub fn angle(&self) -> Option<Angle<S>> {
        Angle::new(self.fast().clone())
    }
}
