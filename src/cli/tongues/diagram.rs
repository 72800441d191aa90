//! Diagrams of tongues: s across, ρ from 0 up.

use num_traits::Zero;
use plot::{Figure, Foot};

use crate::error::{Error, Result};
use crate::number::rational::to_f64;
use crate::number::{Ratio, Rational};
use crate::report::tongues::diagram::figure;
use crate::tongue::sampled::{Diagram, LARGEST_S};

/// Values of ρ: closer than lines are wide, on paper.
const SAMPLES: u32 = 120;
/// Beyond this labels cover everything.
const MOST_SUM: u64 = 40;

/// Draws the tongues of each ratio for 0 ≤ ρ ≤ `rho`.
///
/// # Errors
/// ρ = 0, a ratio with too many tongues to draw.
pub fn drawn(ratios: &[Ratio], rho: &Rational, width_mm: Option<f64>) -> Result<Figure> {
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
    Ok(figure(&diagrams, to_f64(rho), width_mm).footed(&foot))
}
