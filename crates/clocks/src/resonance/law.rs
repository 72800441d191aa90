//! The tongue of a resonance to first order in L2, enclosed; the file `strength` says how the law comes
//! about.

use num_bigint::BigInt;

use super::family::families;
use number::{Ball, Enclosed, Ratio, Rational, Ring};

/// The first-order prediction of a tongue, in s = h1² L1, enclosed.
#[derive(Clone, Debug)]
pub struct FirstOrder {
    /// The middle of the tongue.
    pub centre: Ball,
    /// Its width.
    pub width: Ball,
    /// ln of the multiplier at the middle, per period: q alpha |S|, half the width in the phase p θ.
    pub ln_multiplier: Ball,
}

/// The numbers of the law: the closed form of S cancels some log2 p³ bits.
type Number = Enclosed<256>;

/// The first-order tongue of h2/h1 = p/q about p θ = m π, for L2 = rho L1, 0 < m < p; the law's own error is
/// O(rho²).
pub fn first_order(ratio: Ratio, m: u64, rho: &Rational) -> Option<FirstOrder> {
    let p = ratio.p();
    if m == 0 || m >= p {
        return None;
    }
    let turn = half_turns(m.into(), p);
    let (sine, cosine) = (Enclosed(turn.sin(BITS)), Enclosed(turn.cos(BITS)));
    let (s0, s1) = means(ratio, m, &sine, &cosine);
    let s = whole(2) - whole(2) * cosine;
    // d = s rho; ds/dθ = 2 sin θ, the phase is p θ, and q alpha = s rho p/(2 sin θ).
    let d = s.clone() * Number::from_rational(rho);
    let Enclosed(turned) = d.clone() * whole(p) * s1.clone();
    Some(FirstOrder {
        centre: (s - d.clone() * s0).0,
        width: (d * whole(2) * s1).0,
        ln_multiplier: turned.div(&sine.0.scale2(1), BITS).expect("0 < theta < pi"),
    })
}

const BITS: u32 = 256;

/// S0 and |S| over the q slow kicks of one period, p θ = m π, in closed form.
///
/// With r = k p mod q, σ = r/q and m = a p + b q the phases e^{2 i n θ} are e^{-2π i b r/p}, a geometric
/// series in r. P(σ)² is quadratic in u = σ − 1/2, P = e^{iθ/2} (c + 2 i s u), c, s = cos, sin (θ/2), and the
/// kick at r = 0 may stand half at either end. So S is (c² C + s² C″/q² + 2 s c C′/q)/q up to its sign, C =
/// sin θ cot A with A = π b/p being Σ cos 2A(r − q/2), halved at both ends, and C′, C″ its derivatives in A;
/// at q A = −θ + a π these are
///
/// ```text
///     C' = sin θ/sin² A - q cos θ cot A,     C'' = 2 sin θ cot A/sin² A - 2 q cos θ/sin² A - q² sin θ cot A.
/// ```
fn means(ratio: Ratio, m: u64, sine: &Number, cosine: &Number) -> (Number, Number) {
    let (p, q) = ratio.terms();
    let a = half_turns(families(ratio, m).1.into(), p);
    let cot: Number = Enclosed(a.cos(BITS).div(&a.sin(BITS), BITS).expect("p does not divide b"));
    let square = whole(1) + cot.clone() * cot.clone();
    let (q, sum) = (whole(q), sine.clone() * cot.clone());
    let first = sine.clone() * square.clone() - q.clone() * cosine.clone() * cot;
    let second = whole(2) * square.clone() * sum.clone()
        - whole(2) * q.clone() * cosine.clone() * square
        - q.clone() * q.clone() * sum.clone();
    let over = |x: Number, n: &Number| Enclosed(x.0.div(&n.0, BITS).expect("positive"));
    let (plus, minus) = (whole(1) + cosine.clone(), whole(1) - cosine.clone());
    let squared = q.clone() * q.clone();
    let s = over(plus * sum, &whole(2)) + over(minus.clone() * second, &(whole(2) * squared.clone()));
    let s = over(s + over(sine.clone() * first, &q), &q);
    // |P|² = 1 − s σ (1 − σ), and Σ r (q − r) = q (q² − 1)/6.
    let s0 = whole(1) - over(minus * (squared.clone() - whole(1)), &(whole(3) * squared));
    (s0, Enclosed(s.0.abs()))
}

/// n π/p.
fn half_turns(n: BigInt, p: u64) -> Ball {
    Ball::pi(BITS + 16).mul(&Ball::from_rational(&Rational::new(n, p.into()), BITS + 16), BITS + 16)
}

fn whole(n: u64) -> Number {
    Enclosed(Ball::from_integer(&n.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resonance::strength;
    use num_complex::Complex64;

    /// Kick by kick, in doubles.
    fn summed(ratio: Ratio, m: u64) -> (f64, f64) {
        let (p, q) = ratio.terms();
        let turn = |n: u64, count: u64| Complex64::cis(std::f64::consts::PI * n as f64 / count as f64);
        let (mut s0, mut s1) = (0.0, Complex64::default());
        for k in 0..q {
            let (n, sigma) = (k * p / q, (k * p % q) as f64 / q as f64);
            let position = 1.0 - sigma + turn(m, p) * sigma;
            s0 += position.norm_sqr();
            s1 += position * position * turn(2 * n * m % (2 * p), p);
        }
        (s0 / q as f64, s1.norm() / q as f64)
    }

    fn closed(ratio: Ratio, m: u64) -> (f64, f64) {
        let turn = half_turns(m.into(), ratio.p());
        let (s0, s1) = means(ratio, m, &Enclosed(turn.sin(BITS)), &Enclosed(turn.cos(BITS)));
        (s0.0.mid_f64(), s1.0.mid_f64())
    }

    #[test]
    fn the_closed_form_is_the_sum_over_the_kicks() {
        for ratio in Ratio::up_to(30) {
            for m in 1..ratio.p() {
                let ((s0, s1), (t0, t1)) = (closed(ratio, m), summed(ratio, m));
                // 30 terms of size 1 in doubles.
                assert!((s0 - t0).abs() < 1e-14 && (s1 - t1).abs() < 1e-13, "{ratio}, m = {m}: {s1} {t1}");
            }
        }
    }

    #[test]
    fn the_mean_over_many_kicks_tends_to_the_strength() {
        // p/q = 301/100, m = 101 = 1·301 − 2·100: family (1, −2), theta = 101 pi/301.
        let theta = std::f64::consts::PI * 101.0 / 301.0;
        let (s0, s1) = closed("301/100".parse().unwrap(), 101);
        let s = 4.0 * (theta / 2.0f64).sin().powi(2);
        // The kicks sample sigma at spacing 1/100: errors of order 1/q.
        assert!((s0 - (1.0 - s / 6.0)).abs() < 1e-2);
        assert!((s1 - strength(1, theta).abs()).abs() < 1e-2);
    }
}
