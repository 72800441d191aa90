//! The figures of measured widths against the first-order law.

use plot::{Figure, Foot, typeset};

use super::atlas::share_of_pi;
use crate::cli::ratios::below;
use crate::error::{Error, Result};
use crate::number::{Laurent, Rational, rational};
use crate::question::Ratios;
use crate::report::strength::{self as report, figure};
use crate::tongue::Stiffness;
use crate::tongue::sampled::{self, Measured};

/// Tongues within this of the angle, in units of π, are measured: on a logarithmic axis |S_a| hardly changes there.
const HALF_WINDOW: (i64, i64) = (1, 50);

/// The tongues about p θ = m π near one angle.
///
/// # Errors
/// An angle that is no rational multiple of π, one ratio only, ρ = 0, a sum without such a tongue.
pub fn drawn(ratios: Ratios, stiffness: &Stiffness, theta: &Laurent) -> Result<Figure> {
    let share = share_of_pi(theta)?;
    let around = rational::ratio(HALF_WINDOW.0, HALF_WINDOW.1);
    let (max_sum, measured) = measure(ratios, stiffness, [&share - &around, &share + &around])?;
    if measured.is_empty() {
        let remedy =
            format!("no tongue with p + q <= {max_sum} is near this angle: choose a larger --max-sum");
        return Err(Error::input("theta", theta, remedy));
    }
    let d = HALF_WINDOW.1;
    let title = format!(
        "All tongues with *p* + *q* ≤ {max_sum}, *θ* = {} ± π/{d}, *ρ* = {}",
        typeset(theta),
        stiffness.rho
    );
    let foot = below(ratios, Foot::default().value("*ρ*", &stiffness.rho)).value("*θ*", theta);
    Ok(figure(rational::to_f64(&share), &title, &measured).footed(&foot))
}

/// All tongues that have a point p θ = m π: their widths against the law.
///
/// # Errors
/// One ratio only, ρ = 0, a sum without such a tongue.
pub fn widths(ratios: Ratios, stiffness: &Stiffness) -> Result<Figure> {
    let whole = |n: i64| rational::ratio(n, 1);
    let (max_sum, measured) = measure(ratios, stiffness, [whole(0), whole(1)])?;
    if measured.is_empty() {
        return Err(Error::input(
            "max-sum",
            max_sum,
            "has no tongue about p theta = m pi: choose a larger one",
        ));
    }
    let title = format!("All tongues with *p* + *q* ≤ {max_sum}, 0 < *m* < *p*; *ρ* = {}", stiffness.rho);
    let foot = below(ratios, Foot::default().value("*ρ*", &stiffness.rho));
    Ok(report::widths(&title, &measured).footed(&foot))
}

/// The sum, and its tongues with m/p between two shares of π.
fn measure(ratios: Ratios, stiffness: &Stiffness, shares: [Rational; 2]) -> Result<(u64, Vec<Measured>)> {
    let Ratios::UpTo(max_sum) = ratios else {
        return Err(Error::missing("max-sum", "this figure is of many ratios: give --max-sum N"));
    };
    Ok((max_sum, sampled::widths(max_sum, &stiffness.rho, &shares)?))
}
