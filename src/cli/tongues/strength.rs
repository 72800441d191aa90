//! The figure of measured widths against the first-order law.

use crate::parallel::try_map;
use num_traits::{ToPrimitive, Zero};

use super::atlas::share_of_pi;
use crate::cli::ratios::Ratios;
use crate::error::{Error, Result};
use crate::number::{Laurent, Ratio, Rational, rational};
use crate::report::figure::{Figure, typeset};
use crate::report::strength::{Measured, figure};
use crate::resonance::dominant_family;
use crate::tongue::{Gap, Stiffness, Tongues};

/// Tongues within this of the angle, in units of π, are measured: on a logarithmic axis |S_a| hardly changes there.
const HALF_WINDOW: (i64, i64) = (1, 50);

/// Draws the tongues about p θ = m π near one angle.
///
/// # Errors
/// An angle that is no rational multiple of π, one ratio only, ρ = 0, a sum without such a tongue.
pub fn drawn(ratios: Ratios, stiffness: &Stiffness, theta: &Laurent) -> Result<Figure> {
    let Ratios::UpTo(max_sum) = ratios else {
        return Err(Error::missing("max-sum", "this figure is of many ratios: give --max-sum N"));
    };
    if stiffness.rho.is_zero() {
        return Err(Error::input(
            "rho",
            0,
            "without a slow force there are no widths: choose a positive one",
        ));
    }
    let share = share_of_pi(theta)?;
    let measured = measure(max_sum, stiffness, &share)?;
    if measured.is_empty() {
        let remedy =
            format!("no tongue with p + q <= {max_sum} is near this angle: choose a larger --max-sum");
        return Err(Error::input("theta", theta, remedy));
    }
    let (n, d) = HALF_WINDOW;
    let title = format!(
        "All tongues with *p* + *q* ≤ {max_sum}, *θ* = {} ± π{n}/{d}, *ρ* = {}",
        typeset(theta),
        stiffness.rho
    )
    .replace("π1/", "π/");
    Ok(figure(rational::to_f64(&share), &title, &measured))
}

/// The tongues with m/p near the share, in the order of p + q, p, m.
fn measure(max_sum: u64, stiffness: &Stiffness, share: &Rational) -> Result<Vec<Measured>> {
    let around = rational::ratio(HALF_WINDOW.0, HALF_WINDOW.1);
    let rho = rational::to_f64(&stiffness.rho);
    let one = |&ratio: &Ratio| -> Result<Vec<Measured>> {
        let whole = |x: Rational| x.to_integer().to_u64().unwrap_or(0);
        let terms = Rational::from_integer(ratio.p().into());
        let from = whole(((share - &around) * &terms).ceil()).max(1);
        let upto = whole(((share + &around) * &terms).floor()).min(ratio.p() - 1);
        if from > upto {
            return Ok(Vec::new());
        }
        let tongues = Tongues::new(ratio, &stiffness.rho)?;
        let gaps = tongues.gaps(from, upto)?;
        let measured = |gap: &Gap| {
            let s = tongues.resonance(gap.m, 64).mid_f64();
            let width = 0.5 * (gap.width.0 + gap.width.1);
            Measured { a: dominant_family(ratio, gap.m).0, q: ratio.q(), strength: width / (2.0 * s * rho) }
        };
        Ok(gaps.iter().map(measured).collect())
    };
    let ratios: Vec<Ratio> = Ratio::up_to(max_sum).collect();
    let all: Vec<Vec<Measured>> = try_map(&ratios, one)?;
    Ok(all.into_iter().flatten().collect())
}
