//! Widths of tongues beside the first-order law.

use num_traits::{ToPrimitive, Zero};

use crate::resonance::dominant_family;
use crate::tongue::{Gap, Tongues};
use number::parallel::try_map;
use number::{Error, Ratio, Rational, Result, rational};

/// A tongue about a point p θ = m π: that θ, the a of its dominant family, its number of slow kicks, and
/// width/(2 s ρ), which is |S| to first order (see [`crate::resonance::strength`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    pub theta: f64,
    pub a: i64,
    pub q: u64,
    pub strength: f64,
}

/// All tongues of p + q ≤ `max_sum` with m/p between two shares of π, 0 < m < p, in the order of p + q, p, m;
/// widths from certified edges, rounded.
///
/// # Errors
/// ρ = 0, and those of [`Tongues::gaps`].
pub fn widths(max_sum: u64, rho: &Rational, shares: &[Rational; 2]) -> Result<Vec<Measured>> {
    if rho.is_zero() {
        let remedy = "without a slow force there are no widths: choose a positive one";
        return Err(Error::input("rho", 0, remedy));
    }
    let near = rational::to_f64(rho);
    let one = |&ratio: &Ratio| -> Result<Vec<Measured>> {
        let whole = |x: Rational| x.to_integer().to_u64().unwrap_or(0);
        let terms = Rational::from_integer(ratio.p().into());
        let from = whole((&shares[0] * &terms).ceil()).max(1);
        let upto = whole((&shares[1] * &terms).floor()).min(ratio.p() - 1);
        if from > upto {
            return Ok(Vec::new());
        }
        let tongues = Tongues::new(ratio, rho)?;
        let gaps = tongues.gaps(from, upto)?;
        let measured = |gap: &Gap| {
            let s = tongues.resonance(gap.m, 64).mid_f64();
            let width = 0.5 * (gap.width.0 + gap.width.1);
            let theta = std::f64::consts::PI * gap.m as f64 / ratio.p() as f64;
            let a = dominant_family(ratio, gap.m).0;
            Measured { theta, a, q: ratio.q(), strength: width / (2.0 * s * near) }
        };
        Ok(gaps.iter().map(measured).collect())
    };
    let ratios: Vec<Ratio> = Ratio::up_to(max_sum).collect();
    let all: Vec<Vec<Measured>> = try_map(&ratios, one)?;
    Ok(all.into_iter().flatten().collect())
}
