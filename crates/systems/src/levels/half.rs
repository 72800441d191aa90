//! The fast half period of one mode, enclosed.

use number::Interval;

/// a, b, c, d of p velocity-Verlet steps, over half of them, in the time unit h: for s = h² w² = 4 sin²(θ/2)
/// and even p a = d = cos(p θ/2), b = sin(p θ/2)/sin θ, c = −sin(p θ/2) sin θ; for odd p the half ends in the
/// middle of a drift, a = cos(p θ/2) cos(θ/2), b = sin(p θ/2)/(2 sin(θ/2)), c = −2 sin(p θ/2) sin(θ/2), d =
/// cos(p θ/2)/cos(θ/2).
///
/// Kicks and drifts are followed as they come: their intervals widen by exp(√s p/2) roundings, a factor
/// e^(π/2) up to p θ = π.
#[derive(Clone, Copy, Debug)]
pub(super) struct Half {
    pub a: Interval,
    pub b: Interval,
    pub c: Interval,
    pub d: Interval,
    /// How often the odd solution changes its sign up to the end, of those at kicks and there; `None` where
    /// one is not certain.
    pub changes: Option<usize>,
}

impl Half {
    pub fn new(s: f64, p: u64) -> Half {
        let (s, zero, one) = (Interval::point(s), Interval::point(0.0), Interval::point(1.0));
        let kick = s.half();
        let (mut even, mut odd) = ([one, zero], [zero, one]);
        let (mut changes, mut last) = (Some(0), true);
        let mut see = |x: Interval| {
            let sign = x.sign();
            changes = changes.zip(sign).map(|(n, sign)| n + usize::from(sign != last));
            last = sign.unwrap_or(last);
        };
        for _ in 0..p / 2 {
            for [x, v] in [&mut even, &mut odd] {
                *v = *v - kick * *x;
                *x = *x + *v;
                *v = *v - kick * *x;
            }
            see(odd[0]);
        }
        if p % 2 == 1 {
            for [x, v] in [&mut even, &mut odd] {
                *v = *v - kick * *x;
                *x = *x + v.half();
            }
            see(odd[0]);
        }
        let ([a, c], [b, d]) = (even, odd);
        Half { a, b, c, d, changes }
    }

    /// Whether the odd solution moves towards 0 at the end; `None` where that is not certain.
    pub fn turns_back(&self) -> Option<bool> {
        Some(self.b.sign()? != self.d.sign()?)
    }

    /// Whether p θ < π for sure: the odd solution is positive all the way and still rising at the end.
    pub fn rises(&self) -> bool {
        self.changes == Some(0) && self.turns_back() == Some(false)
    }

    /// a/b = sin θ cot(p θ/2) or 2 sin(θ/2) cot: decreasing in s while p θ < 2 π.
    pub fn stretch(&self) -> Interval {
        self.a / self.b
    }

    /// −c/d = sin θ tan(p θ/2) or 2 sin(θ/2) tan: increasing in s while p θ < π.
    pub fn restoring(&self) -> Interval {
        -self.c / self.d
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_half_period_of_a_mode_is_that_of_its_angle() {
        for p in [1u64, 2, 3, 8, 9] {
            for turn in [0.1, 0.7, 0.99, 1.01, 1.7] {
                // p θ = turn π.
                let theta = turn * std::f64::consts::PI / p as f64;
                let (half, s) = (p as f64 * theta / 2.0, 4.0 * (theta / 2.0).sin().powi(2));
                let own = Half::new(s, p);
                let (a, b, c, d) = if p % 2 == 0 {
                    (half.cos(), half.sin() / theta.sin(), -half.sin() * theta.sin(), half.cos())
                } else {
                    let (x, y) = ((theta / 2.0).cos(), 2.0 * (theta / 2.0).sin());
                    (half.cos() * x, half.sin() / y, -half.sin() * y, half.cos() / x)
                };
                for (got, want) in [(own.a, a), (own.b, b), (own.c, c), (own.d, d)] {
                    // The formulas' own rounding, by the condition of cos and sin of some units.
                    assert!(got.lo - 1e-13 <= want && want <= got.hi + 1e-13, "{p} {turn}: {got:?} {want}");
                    assert!(got.error() < 1e-13, "{got:?}");
                }
                // One step alone has no angle beyond π.
                assert!(p == 1 || own.rises() == (turn < 1.0), "{p} {turn}");
            }
        }
    }
}
