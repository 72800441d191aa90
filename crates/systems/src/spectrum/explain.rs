//! The multipliers of a piece, and what the unstable ones are.

use std::cell::OnceCell;
use std::cmp::Ordering;

use faer::c64;

use crate::exact::decide as exact;
use crate::half::float::FloatBlocks;
use crate::spectrum::discs::{Spectrum, from_segment};
use crate::spectrum::modes::{NormalModes, Origin, Resonance};
use crate::spectrum::rate;
use crate::spectrum::rate::{Multiplier, exponent};
use crate::verdict::analysis::Instability;
use crate::verdict::limits::Limits;
use crate::verdict::piece::{Piece, ROUGH};
use clocks::verdict::Kind;
use number::{Laurent, to_f64};

/// The order of multipliers: by increasing real part of μ, then by the imaginary one.
pub(crate) fn by_place(a: &c64, b: &c64) -> Ordering {
    a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im))
}

/// All multipliers over a period in order, and if hyperbolic the unstable ones with the shapes of their
/// solutions; `shape` takes the place among those given.
pub fn explained(
    found: Vec<Multiplier>,
    shape: impl Fn(usize) -> Vec<c64>,
    kind: Option<Kind>,
    period: &Laurent,
    resonance: impl Fn(&[c64], Origin, c64) -> Option<Resonance>,
) -> (Vec<Multiplier>, Vec<Instability>) {
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(|&i, &j| by_place(&found[i].mu, &found[j].mu));
    let multipliers = order.iter().map(|&i| found[i]).collect();
    if kind != Some(Kind::Hyperbolic) {
        return (multipliers, Vec::new());
    }
    // Conjugates grow alike; the fastest one is listed even if no disc is clear of stability.
    let upper = |i: &&usize| found[**i].mu.im >= 0.0;
    let (distance, growth) = (|i: &usize| from_segment(found[*i].mu), |i: &usize| found[*i].size());
    let fastest = order.iter().filter(upper).max_by(|a, b| growth(a).total_cmp(&growth(b)));
    let clear = |i: &&usize| distance(i) > found[**i].radius.unwrap_or(ROUGH);
    let unstable = order.iter().filter(upper).filter(|i| clear(i) || Some(*i) == fastest);
    let instability = |&i: &usize| {
        let (multiplier, shape) = (found[i], shape(i));
        let origin = if multiplier.mu.im == 0.0 { Origin::RealPair } else { Origin::Collision };
        Instability {
            multiplier,
            origin,
            growth_rate: multiplier.growth.map(|growth| rate::per_time(growth, period)),
            resonance: resonance(&shape, origin, exponent(multiplier.mu)),
            shape: shape.iter().map(|c| c.re).collect(),
            quadrature: shape.iter().map(|c| c.im).collect(),
        }
    };
    (multipliers, unstable.map(instability).collect())
}

/// Whether an enclosure of the largest growth shows fewer digits than documents do.
fn is_rough(found: &[Multiplier]) -> bool {
    let growth = found.iter().map(|multiplier| multiplier.growth).collect::<Option<Vec<_>>>();
    growth.is_none_or(|all| {
        let (lo, hi) = rate::largest(all.into_iter());
        hi - lo > 1e-9 * hi
    })
}

impl Piece {
    /// All multipliers by increasing real part of μ; of a hyperbolic piece the unstable ones explained, their
    /// shapes in the frame's coordinates.
    pub fn explain(
        &self,
        spectrum: &Spectrum,
        blocks: &FloatBlocks,
        kind: Option<Kind>,
        limits: &Limits,
    ) -> (Vec<Multiplier>, Vec<Instability>) {
        let modes = OnceCell::new();
        let resonance = |shape: &[c64], origin, z| {
            let modes = modes.get_or_init(|| NormalModes::new(&self.system, &self.frame));
            modes.as_ref().map(|modes| modes.resonance(&self.system, shape, origin, z))
        };
        let shape = |i| spectrum.shape(i, &blocks.scales);
        let period = Laurent::from_rational(self.system.period());
        let mut found = spectrum.multipliers();
        if kind == Some(Kind::Hyperbolic) && is_rough(&found) && self.is_exact {
            found = self.refined(&found, limits).unwrap_or(found);
        }
        explained(found, shape, kind, &period, resonance)
    }

    /// The multipliers from the characteristic polynomial, each in the place of the computed one that it
    /// stands for.
    fn refined(&self, found: &[Multiplier], limits: &Limits) -> Option<Vec<Multiplier>> {
        let mut exact = exact::multipliers(&self.system, &self.frame, limits)
            .filter(|multiplier| multiplier.len() == found.len())?;
        let mut order: Vec<usize> = (0..found.len()).collect();
        order.sort_by(|&i, &j| by_place(&found[i].mu, &found[j].mu));
        exact.sort_by(|a, b| by_place(&a.mu, &b.mu));
        let mut placed = exact.clone();
        order.iter().zip(exact).for_each(|(&i, multiplier)| placed[i] = multiplier);
        Some(placed)
    }

    /// Brings a shape from the piece's coordinates to those of the whole system of `n`, its longest entry 1.
    pub(crate) fn place_shape(&self, instability: &mut Instability, n: usize, dofs: &[usize]) {
        instability.lift(|y| {
            let mut whole = vec![0.0; n];
            dofs.iter().zip(self.lifted(y)).for_each(|(&i, value)| whole[i] = value);
            whole
        });
    }

    /// A position in the piece's coordinates as one of its component.
    fn lifted(&self, y: &[f64]) -> Vec<f64> {
        match &self.columns {
            Some(columns) => {
                let n = columns.first().map_or(0, Vec::len);
                (0..n).map(|i| columns.iter().zip(y).map(|(z, c)| to_f64(&z[i]) * c).sum()).collect()
            }
            None => self.frame.lift(y, &self.system),
        }
    }
}
