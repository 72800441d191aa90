//! The tongues of a ratio over ρ.

use super::LARGEST_S;
use crate::resonance::dominant_family;
use crate::tongue::{Closing, Gap, Search, Tongues, closings};
use number::parallel::try_map;
use number::{Ratio, Rational, Result, to_f64};

/// One tongue over ρ.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    pub m: u64,
    /// Its dominant family (a, b).
    pub family: (i64, i64),
    /// [lower s, upper s, ρ], ρ rising; where ρ is 0 both are the point p θ = m π. Edges are the middles of
    /// their enclosures.
    pub edges: Vec<[f64; 3]>,
}

/// All tongues of one ratio that begin below s = 4 at some ρ.
///
/// ```
/// use kickdrift_clocks::number::rational::ratio;
/// use kickdrift_clocks::tongue::sampled::Diagram;
/// let found = Diagram::new("5/3".parse()?, &ratio(5, 2), 10)?;
/// assert_eq!((found.bands.len(), found.closings.len()), (6, 1));
/// // The third begins at p theta = 3 pi and is open from there on.
/// let [lower, upper, rho] = found.bands[2].edges[1];
/// assert!(rho == 0.25 && lower < upper);
/// # Ok::<(), kickdrift_clocks::number::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    pub ratio: Ratio,
    pub bands: Vec<Band>,
    /// The points p θ = m π, 0 < m < p, in s: the same for every ρ.
    pub resonances: Vec<f64>,
    /// [s, ρ] of closed tongues below s = 4.
    pub closings: Vec<[f64; 2]>,
}

/// Closings are looked for from this share of the largest ρ on: below it tongues are thinner than lines.
const LEAST_SHARE: i64 = 1000;

impl Diagram {
    /// For ρ = `rho` n/`samples`, n from 1 on.
    ///
    /// # Errors
    /// ρ below 0 or 0, and those of [`Tongues::gaps`] and [`closings`].
    pub fn new(ratio: Ratio, rho: &Rational, samples: u32) -> Result<Diagram> {
        let step = rho / Rational::from_integer(samples.into());
        let rhos: Vec<Rational> = (1..=samples).map(|n| &step * Rational::from_integer(n.into())).collect();
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
        let middle = |(lo, hi): (f64, f64)| 0.5 * (lo + hi);
        let of = |closing: &Closing| [&closing.s, &closing.rho].map(|x| middle(x.to_f64()));
        Ok(Diagram {
            ratio,
            bands: bands.collect(),
            resonances: (1..ratio.p()).map(resonance).collect(),
            closings: found.closings.iter().filter(|closing| closing.below_verlet).map(of).collect(),
        })
    }
}
