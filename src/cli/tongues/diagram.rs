//! Diagrams of tongues: s across, ρ from 0 up.

use num_traits::Zero;

use crate::error::{Error, Result};
use crate::number::rational::to_f64;
use crate::number::{Ratio, Rational};
use crate::parallel::try_map;
use crate::report::figure::{Figure, Foot};
use crate::report::tongues::diagram::{Band, Diagram, LARGEST_S, figure};
use crate::resonance::dominant_family;
use crate::tongue::{Gap, Search, Tongues, closings};

/// Values of ρ: closer than lines are wide, on paper.
const SAMPLES: i64 = 120;
/// Beyond this labels cover everything.
const MOST_SUM: u64 = 40;
/// Closings are looked for from this share of the largest ρ on: below it tongues are thinner than lines.
const LEAST_SHARE: i64 = 1000;

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
    let diagrams: Vec<Diagram> = ratios.iter().map(|&ratio| diagram(ratio, rho)).collect::<Result<_>>()?;
    let all = ratios.iter().map(Ratio::to_string).collect::<Vec<_>>().join(", ");
    let foot = Foot::default().value("*h*_2/*h*_1", all).range("*ρ*", 0, rho).range("*s*", 0, LARGEST_S);
    Ok(figure(&diagrams, to_f64(rho), width_mm).footed(&foot))
}

fn diagram(ratio: Ratio, rho: &Rational) -> Result<Diagram> {
    let step = rho / Rational::from_integer(SAMPLES.into());
    let rhos: Vec<Rational> = (1..=SAMPLES).map(|n| &step * Rational::from_integer(n.into())).collect();
    let slices: Vec<Vec<Gap>> = try_map(&rhos, |rho| {
        let tongues = Tongues::new(ratio, rho)?;
        tongues.gaps(1, tongues.last() - 1)
    })?;
    let tongues = Tongues::new(ratio, rho)?;
    let resonance = |m: u64| tongues.resonance(m, 64).mid_f64();
    let band = |m: u64| {
        let begin = (m < ratio.p()).then(|| [resonance(m), resonance(m), 0.0]);
        let edges = slices.iter().zip(&rhos).map(|(gaps, rho)| {
            let [lower, upper] = gaps[m as usize - 1].middles();
            [lower, upper, to_f64(rho)]
        });
        Band { m, family: dominant_family(ratio, m), edges: begin.into_iter().chain(edges).collect() }
    };
    let bands =
        (1..tongues.last()).map(band).filter(|band| band.edges.iter().any(|edge| edge[0] < LARGEST_S));
    let least = rho / Rational::from_integer(LEAST_SHARE.into());
    let found = closings(ratio, &Search { rho: (least, rho.clone()), ..Search::default() })?;
    let of = |closing: &crate::tongue::Closing| {
        [&closing.s, &closing.rho].map(|x| {
            let (lo, hi) = x.to_f64();
            0.5 * (lo + hi)
        })
    };
    Ok(Diagram {
        ratio,
        bands: bands.collect(),
        resonances: (1..ratio.p()).map(resonance).collect(),
        closings: found.closings.iter().filter(|closing| closing.below_verlet).map(of).collect(),
    })
}
