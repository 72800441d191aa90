//! The multipliers of a piece, and what the unstable ones are.

use std::cell::OnceCell;

use faer::c64;

use super::analysis::{Instability, Multiplier, exponent};
use super::float::FloatBlocks;
use super::modes::{NormalModes, Origin, Resonance};
use super::piece::{Piece, ROUGH};
use super::spectrum::{Spectrum, from_segment};
use crate::number::rational::to_f64;
use crate::verdict::Kind;

/// All multipliers over a period by increasing real part of μ (within a radius where one is proven), and if hyperbolic the
/// unstable ones with the shapes of their solutions.
pub(super) fn explained(
    (mu, radius): (&[c64], Option<f64>),
    shape: impl Fn(usize) -> Vec<c64>,
    kind: Kind,
    period: f64,
    resonance: impl Fn(&[c64], Origin, c64) -> Option<Resonance>,
) -> (Vec<Multiplier>, Vec<Instability>) {
    let mut order: Vec<usize> = (0..mu.len()).collect();
    order.sort_by(|&i, &j| mu[i].re.total_cmp(&mu[j].re));
    let multiplier = |&i: &usize| Multiplier::new(mu[i], radius);
    let multipliers = order.iter().map(multiplier).collect();
    if kind != Kind::Hyperbolic {
        return (multipliers, Vec::new());
    }
    // Conjugates tell the same; the farthest one from stability is there even if no disc is clear of it.
    let upper = |i: &&usize| mu[**i].im >= 0.0;
    let distance = |i: &usize| from_segment(mu[*i]);
    let farthest = order.iter().filter(upper).max_by(|a, b| distance(a).total_cmp(&distance(b)));
    let clear = |i: &&usize| distance(i) > radius.unwrap_or(ROUGH);
    let unstable = order.iter().filter(upper).filter(|i| clear(i) || Some(*i) == farthest);
    let instability = |&i: &usize| {
        let (z, shape) = (exponent(mu[i]), shape(i));
        let origin = if mu[i].im == 0.0 { Origin::RealPair } else { Origin::Collision };
        Instability {
            multiplier: multiplier(&i),
            origin,
            growth_rate: z.re / period,
            resonance: resonance(&shape, origin, z),
            shape: shape.iter().map(|c| c.re).collect(),
            quadrature: shape.iter().map(|c| c.im).collect(),
        }
    };
    (multipliers, unstable.map(instability).collect())
}

impl Piece {
    /// All multipliers by increasing real part of μ; of a hyperbolic piece the unstable ones explained, their shapes
    /// in the frame's coordinates.
    pub(super) fn explain(
        &self,
        spectrum: &Spectrum,
        blocks: &FloatBlocks,
        kind: Kind,
    ) -> (Vec<Multiplier>, Vec<Instability>) {
        let modes = OnceCell::new();
        let resonance = |shape: &[c64], origin, z| {
            let modes = modes.get_or_init(|| NormalModes::new(&self.system, &self.frame));
            modes.as_ref().map(|modes| modes.resonance(&self.system, shape, origin, z))
        };
        let shape = |i| spectrum.shape(i, &blocks.scales);
        explained((&spectrum.mu, spectrum.radius), shape, kind, to_f64(&self.system.period()), resonance)
    }

    /// Brings a shape from the piece's coordinates to those of the whole system of `n`, its longest entry 1.
    pub(super) fn place_shape(&self, instability: &mut Instability, n: usize, dofs: &[usize]) {
        let (re, im) = (self.lifted(&instability.shape), self.lifted(&instability.quadrature));
        (instability.shape, instability.quadrature) = (vec![0.0; n], vec![0.0; n]);
        for (local, &i) in dofs.iter().enumerate() {
            (instability.shape[i], instability.quadrature[i]) = (re[local], im[local]);
        }
        instability.normalize();
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
