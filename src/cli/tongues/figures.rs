//! The other figures: diagrams over ρ, traces of one ratio, measured widths against the first-order law.

use num_traits::{One, Signed, Zero};
use plot::{Figure, Foot, typeset};

use clocks::tongue::sampled::{self, Diagram, LARGEST_S, Measured, Trace};
use clocks::tongue::{Labels, Stiffness};
use documents::question::Ratios;
use documents::report::{strength, tongues};
use number::{Error, Laurent, Ratio, Rational, Result, rational};

/// Values of ρ of a diagram: closer than lines are wide, on paper.
const SAMPLES: u32 = 120;
/// Beyond this p + q labels cover a diagram, and tongues of a trace are thinner than lines.
const MOST_SUM: u64 = 40;
/// Tongues within this of the angle, in units of π, are measured: on a logarithmic axis |S_a| hardly changes
/// there.
const HALF_WINDOW: (i64, i64) = (1, 50);

/// Draws the tongues of each ratio for 0 ≤ ρ ≤ `rho`.
pub fn diagram(ratios: &[Ratio], rho: &Rational, width_mm: Option<f64>) -> Result<Figure> {
    if rho.is_zero() {
        return Err(Error::input("rho", 0, "the diagram goes from 0 up to it: choose a positive one"));
    }
    if let Some(ratio) = ratios.iter().find(|ratio| ratio.kicks() > MOST_SUM) {
        return Err(Error::input("ratio", ratio, format!("a diagram is readable for p + q <= {MOST_SUM}")));
    }
    let diagrams: Vec<Diagram> =
        ratios.iter().map(|&ratio| Diagram::new(ratio, rho, SAMPLES)).collect::<Result<_>>()?;
    let all = ratios.iter().map(Ratio::to_string).collect::<Vec<_>>().join(", ");
    let foot = Foot::default().value("*h*_2/*h*_1", all).range("*ρ*", 0, rho).range("*s*", 0, LARGEST_S);
    Ok(tongues::diagram::figure(&diagrams, rational::to_f64(rho), width_mm).footed(&foot))
}

/// Tr Q through the tongues of a ratio, and through one of them: that of `labels`, else the widest.
pub fn trace(ratio: Ratio, rho: &Rational, labels: Option<&Labels>) -> Result<Figure> {
    if ratio.kicks() > MOST_SUM {
        return Err(Error::input("ratio", ratio, format!("traces are readable for p + q <= {MOST_SUM}")));
    }
    let m = labels.map(one).transpose()?;
    let trace = Trace::through(ratio, rho, m)?;
    let foot = Foot::default().value("*h*_2/*h*_1", ratio).value("*ρ*", rho).value("*m*", trace.near.m);
    Ok(tongues::trace::figure(&trace).footed(&foot))
}

fn one(labels: &Labels) -> Result<u64> {
    match labels.0[..] {
        [(m, upto)] if m == upto => Ok(m),
        _ => Err(Error::input("m", labels, "give one label: the trace goes through one tongue")),
    }
}

/// The tongues about p θ = m π near one angle.
pub fn strengths(ratios: Ratios, stiffness: &Stiffness, theta: &Laurent) -> Result<Figure> {
    let share = share_of_pi(theta)?;
    let around = rational::ratio(HALF_WINDOW.0, HALF_WINDOW.1);
    let (max_sum, measured) = measure(&ratios, stiffness, [&share - &around, &share + &around])?;
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
    let foot = ratios.below(Foot::default().value("*ρ*", &stiffness.rho)).value("*θ*", theta);
    Ok(strength::figure(rational::to_f64(&share), &title, &measured).footed(&foot))
}

/// All tongues that have a point p θ = m π: their widths against the law.
pub fn widths(ratios: Ratios, stiffness: &Stiffness) -> Result<Figure> {
    let whole = |n: i64| rational::ratio(n, 1);
    let (max_sum, measured) = measure(&ratios, stiffness, [whole(0), whole(1)])?;
    if measured.is_empty() {
        return Err(Error::input(
            "max-sum",
            max_sum,
            "has no tongue about p theta = m pi: choose a larger one",
        ));
    }
    let title = format!("All tongues with *p* + *q* ≤ {max_sum}, 0 < *m* < *p*; *ρ* = {}", stiffness.rho);
    let foot = ratios.below(Foot::default().value("*ρ*", &stiffness.rho));
    Ok(strength::widths(&title, &measured).footed(&foot))
}

/// The sum, and its tongues with m/p between two shares of π.
fn measure(ratios: &Ratios, stiffness: &Stiffness, shares: [Rational; 2]) -> Result<(u64, Vec<Measured>)> {
    let Ratios::UpTo(max_sum) = *ratios else {
        return Err(Error::missing("max-sum", "this figure is of many ratios: give --max-sum N"));
    };
    Ok((max_sum, sampled::widths(max_sum, &stiffness.rho, &shares)?))
}

/// θ/π of an angle strictly between 0 and π that is a rational multiple of π.
fn share_of_pi(theta: &Laurent) -> Result<Rational> {
    let share = theta.as_monomial().filter(|(power, _)| *power == 1).map(|(_, share)| share.clone());
    share.filter(|share| share.is_positive() && *share < One::one()).ok_or_else(|| {
        Error::input("theta", theta, "give a rational multiple of pi between 0 and pi, as pi/2")
    })
}
