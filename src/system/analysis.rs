//! A system's verdict, part by part, each by the cheapest means that proves it.
//!
//! 1. Connected components and rigid modes are set apart; small components whose potentials commute are split
//!    along their rational eigenvectors.
//! 2. A part of one degree of freedom is the scalar problem: two clocks go to the certified ladder of
//!    [`verdict`](crate::verdict), more of them to exact signs.
//! 3. Any other part is tried in doubles with proven discs; where these do not tell, in exact arithmetic.
//! 4. Where exact arithmetic exceeds the budget and doubles prove nothing, the answer is an estimate and says so.

use num_complex::Complex64;

use super::compose::connected;
use super::exact::{Limits, MuCount, decide_exact};
use super::float::{self, FloatBlocks};
use super::frame::Frame;
use super::model::System;
use super::modes::{NormalModes, Origin, Resonance};
use super::single;
use super::sparse::{dot, null_space};
use super::spectrum::{Spectrum, from_segment};
use super::split::{Subspace, invariant_subspaces};
use crate::error::{Kind as ErrorKind, Result};
use crate::number::Rational;
use crate::number::rational::to_f64;
use crate::verdict::{Kind, Tier};

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// The scalar ladder.
    Scalar(Tier),
    /// Doubles with proven discs about every eigenvalue.
    Discs,
    /// Exact arithmetic.
    Exact,
    /// Doubles alone: not proven.
    Estimate,
}

impl Evidence {
    /// The name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Evidence::Scalar(tier) => tier.name(),
            Evidence::Discs => "discs",
            Evidence::Exact => "exact",
            Evidence::Estimate => "estimate",
        }
    }

    /// Whether the verdict is proven.
    pub fn is_proof(self) -> bool {
        self != Evidence::Estimate
    }
}

/// A pair λ, 1/λ of multipliers of one period: λ + 1/λ = 2 + 4 μ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multiplier {
    /// Rounded.
    pub mu: Complex64,
    /// The true μ is within this of it (as many true ones as discs, where discs meet); `None`: not bounded.
    pub radius: Option<f64>,
    /// The one with |λ| ≥ 1, rounded.
    pub lambda: Complex64,
}

impl Multiplier {
    /// λ = exp(2 asinh √μ).
    pub(super) fn new(mu: Complex64, radius: Option<f64>) -> Self {
        Multiplier { mu, radius, lambda: exponent(mu).exp() }
    }
}

/// ln λ = 2 asinh √μ, real part ≥ 0: λ + 1/λ = 2 + 4 sinh²(ln λ/2).
pub(super) fn exponent(mu: Complex64) -> Complex64 {
    let z = mu.sqrt().asinh() * 2.0;
    if z.re < 0.0 { -z } else { z }
}

/// A multiplier off the unit circle.
#[derive(Clone, Debug)]
pub struct Instability {
    /// Which one.
    pub multiplier: Multiplier,
    /// How it came there.
    pub origin: Origin,
    /// ln |λ|/T, per unit time, rounded.
    pub growth_rate: f64,
    /// The positions of the growing solution at t = 0 in the system's coordinates, largest entry 1; rounded. For a
    /// collision the real part of a complex shape.
    pub shape: Vec<f64>,
    /// The nearest resonance, by the normal modes in the shape; `None` where these could not be computed.
    pub resonance: Option<Resonance>,
}

/// An invariant part that was decided by itself.
#[derive(Clone, Debug)]
pub struct Part {
    /// The degrees of freedom of the system that take part.
    pub dofs: Vec<usize>,
    /// The number of its own, rigid modes left out.
    pub size: usize,
    /// Its synchronization period: that of the clocks that act on it.
    pub period: Rational,
    pub kind: Kind,
    pub evidence: Evidence,
    /// One for each pair of multipliers, by increasing real part of μ.
    pub multipliers: Vec<Multiplier>,
    pub instabilities: Vec<Instability>,
    /// The exact count of the μ, where exact arithmetic decided.
    pub roots: Option<MuCount>,
}

/// The answer for a whole system.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Hyperbolic if any part is, else parabolic, else coexistence, else elliptic.
    pub kind: Kind,
    /// The common null vectors of all potentials: they drift freely and are set apart.
    pub rigid_modes: Vec<Vec<Rational>>,
    pub parts: Vec<Part>,
    /// What a person should know beside the verdict.
    pub warnings: Vec<String>,
}

impl Analysis {
    /// Whether powers of the propagator stay bounded, rigid modes apart.
    pub fn is_stable(&self) -> bool {
        matches!(self.kind, Kind::Elliptic | Kind::Coexistence)
    }

    /// Whether every part's verdict is proven.
    pub fn is_proof(&self) -> bool {
        self.parts.iter().all(|part| part.evidence.is_proof())
    }

    /// The largest growth rate, 0 if stable.
    pub fn growth_rate(&self) -> f64 {
        let rates = self.parts.iter().flat_map(|part| &part.instabilities).map(|i| i.growth_rate);
        rates.fold(0.0, f64::max)
    }
}

/// Components of at most this size are brought to rational normal forms before anything else.
const SMALL: usize = 16;

/// The verdict on a system.
///
/// # Errors
/// A budget error of the scalar kernels. (A large part that only exact arithmetic could decide, beyond the
/// budget, is no error but an [`Evidence::Estimate`] with a warning.)
pub fn decide_system(system: &System, limits: &Limits) -> Result<Analysis> {
    let mut warnings = Vec::new();
    if !system.total_stiffness().is_positive_semidefinite() {
        warnings.push(
            "the total stiffness is indefinite: the system itself is unstable, whatever the steps".into(),
        );
    }
    let graphs = system.clocks().iter().map(|clock| &clock.stiffness).chain([system.mass()]);
    let (mut parts, mut rigid_modes) = (Vec::new(), Vec::new());
    for dofs in connected(system.size(), graphs) {
        let Some(component) = system.component(&dofs) else {
            rigid_modes.extend(dofs.iter().map(|&i| unit(system.size(), i)));
            continue;
        };
        let frame = Frame::new(&component);
        let place = |v: &Vec<Rational>| {
            let mut x = vec![Rational::default(); system.size()];
            dofs.iter().zip(v).for_each(|(&i, value)| x[i] = value.clone());
            x
        };
        rigid_modes.extend(frame.rigid.iter().map(|(_, v)| place(v)));
        for piece in pieces(component, frame) {
            parts.push(piece.decide(system.size(), &dofs, limits, &mut warnings)?);
        }
    }
    let kind = parts.iter().map(|part| part.kind).max_by_key(severity).unwrap_or(Kind::Elliptic);
    Ok(Analysis { kind, rigid_modes, parts, warnings })
}

fn unit(n: usize, i: usize) -> Vec<Rational> {
    (0..n).map(|j| Rational::from_integer(i64::from(i == j).into())).collect()
}

fn severity(kind: &Kind) -> u8 {
    match kind {
        Kind::Elliptic => 0,
        Kind::Coexistence => 1,
        Kind::Parabolic => 2,
        Kind::Hyperbolic => 3,
    }
}

/// A part of a component on its way to a verdict.
struct Piece {
    system: System,
    frame: Frame,
    /// x = Z y in the component's coordinates; `None` for the component itself.
    columns: Option<Subspace>,
}

/// The component itself, or what it splits into.
fn pieces(component: System, frame: Frame) -> Vec<Piece> {
    if component.size() > SMALL {
        return vec![Piece { system: component, frame, columns: None }];
    }
    // The M-orthogonal complement of the rigid modes.
    let conditions = frame.rigid.iter().map(|(_, n)| {
        let image = component.mass().times(n).into_iter().enumerate();
        image.filter(|(_, x)| *x != Rational::default()).collect()
    });
    let complement: Subspace =
        null_space(conditions.collect(), component.size()).into_iter().map(|(_, z)| z).collect();
    let Some(vibrating) = component.restricted(&complement) else { return Vec::new() };
    let whole = || vec![(0..vibrating.size()).map(|i| unit(vibrating.size(), i)).collect()];
    let subspaces = invariant_subspaces(&vibrating).unwrap_or_else(whole);
    let piece = |space: Subspace| {
        let system = vibrating.restricted(&space)?;
        let frame = Frame::new(&system);
        let lifted = |y: &Vec<Rational>| {
            let rows =
                (0..component.size()).map(|i| complement.iter().map(|z| z[i].clone()).collect::<Vec<_>>());
            rows.map(|row| dot(&row, y)).collect()
        };
        Some(Piece { system, frame, columns: Some(space.iter().map(lifted).collect()) })
    };
    subspaces.into_iter().filter_map(piece).collect()
}

impl Piece {
    fn decide(&self, n: usize, dofs: &[usize], limits: &Limits, warnings: &mut Vec<String>) -> Result<Part> {
        let mut part = if self.system.size() == 1 && self.frame.rigid.is_empty() {
            single::decide(&self.system)?
        } else {
            self.decide_many(limits, warnings)?
        };
        let taken =
            |i: &usize| self.columns.as_ref().is_none_or(|z| z.iter().any(|z| z[*i] != Rational::default()));
        part.dofs = (0..dofs.len()).filter(taken).map(|i| dofs[i]).collect();
        for instability in &mut part.instabilities {
            instability.shape = self.lifted(&instability.shape, n, dofs);
        }
        Ok(part)
    }

    fn decide_many(&self, limits: &Limits, warnings: &mut Vec<String>) -> Result<Part> {
        let blocks = float::half_period(&self.system, &self.frame);
        let spectrum = Spectrum::new(&blocks);
        let (mut roots, mut evidence) = (None, Evidence::Discs);
        let certified = spectrum.as_ref().and_then(Spectrum::certified);
        let kind = match certified {
            Some(kind) => kind,
            None => match decide_exact(&self.system, limits) {
                Ok(exact) => {
                    evidence = Evidence::Exact;
                    roots = Some(exact.roots);
                    exact.kind
                }
                Err(error) if error.kind() == ErrorKind::Budget && spectrum.is_some() => {
                    evidence = Evidence::Estimate;
                    warnings.push(format!(
                        "doubles do not prove the verdict on {} degrees of freedom (eigenvalues too close \
                         together or to the edge of stability): it is an estimate; {error}",
                        self.frame.kept.len()
                    ));
                    estimate(spectrum.as_ref().expect("just seen"))
                }
                Err(error) => return Err(error),
            },
        };
        let (multipliers, instabilities) = match &spectrum {
            Some(spectrum) => self.explain(spectrum, &blocks, kind),
            None => Default::default(),
        };
        let (size, period) = (self.frame.kept.len(), self.system.period());
        Ok(Part { dofs: Vec::new(), size, period, kind, evidence, multipliers, instabilities, roots })
    }

    /// The multipliers, and what the unstable ones are.
    fn explain(
        &self,
        spectrum: &Spectrum,
        blocks: &FloatBlocks,
        kind: Kind,
    ) -> (Vec<Multiplier>, Vec<Instability>) {
        let mut order: Vec<usize> = (0..spectrum.mu.len()).collect();
        order.sort_by(|&i, &j| spectrum.mu[i].re.total_cmp(&spectrum.mu[j].re));
        let multiplier = |&i: &usize| Multiplier::new(spectrum.mu[i], spectrum.radius);
        let multipliers = order.iter().map(multiplier).collect();
        if kind != Kind::Hyperbolic {
            return (multipliers, Vec::new());
        }
        let modes = NormalModes::new(&self.system, &self.frame);
        let period = to_f64(&self.system.period());
        // Conjugates tell the same; the farthest one from stability is there even if no disc is clear of it.
        let upper = |i: &&usize| spectrum.mu[**i].im >= 0.0;
        let farthest = order
            .iter()
            .filter(upper)
            .max_by(|a, b| from_segment(spectrum.mu[**a]).total_cmp(&from_segment(spectrum.mu[**b])));
        let clear = |i: &&usize| from_segment(spectrum.mu[**i]) > spectrum.radius.unwrap_or(ROUGH);
        let unstable = order.iter().filter(upper).filter(|i| clear(i) || Some(*i) == farthest);
        let instability = |&i: &usize| {
            let z = exponent(spectrum.mu[i]);
            let origin = if spectrum.mu[i].im == 0.0 { Origin::RealPair } else { Origin::Collision };
            let shape: Vec<_> = (0..blocks.m).map(|k| spectrum.vectors[(k, i)] / blocks.scales[k]).collect();
            let resonance = modes.as_ref().map(|modes| modes.resonance(&self.system, &shape, origin, z));
            Instability {
                multiplier: multiplier(&i),
                origin,
                growth_rate: z.re / period,
                shape: shape.iter().map(|c| c.re).collect(),
                resonance,
            }
        };
        (multipliers, unstable.map(instability).collect())
    }

    /// A shape in the piece's coordinates as one of the whole system, its largest entry 1.
    fn lifted(&self, y: &[f64], n: usize, dofs: &[usize]) -> Vec<f64> {
        let local = match &self.columns {
            Some(columns) => {
                let entry = |i: usize| columns.iter().zip(y).map(|(z, c)| to_f64(&z[i]) * c).sum();
                (0..dofs.len()).map(entry).collect()
            }
            None => self.frame.lift(y, &self.system),
        };
        let largest = local.iter().copied().fold(0.0, |a: f64, b: f64| if b.abs() > a.abs() { b } else { a });
        let mut shape = vec![0.0; n];
        dofs.iter().zip(&local).for_each(|(&i, x)| shape[i] = if largest == 0.0 { 0.0 } else { x / largest });
        shape
    }
}

/// Where nothing is proven: eigenvalues of a matrix of norm 1 with a well-conditioned basis are good to some
/// 10^-12; a double eigenvalue splits by the square root of that.
const ROUGH: f64 = 1e-6;

fn estimate(spectrum: &Spectrum) -> Kind {
    let unstable = spectrum.mu.iter().any(|&mu| from_segment(mu) > ROUGH);
    if unstable { Kind::Hyperbolic } else { Kind::Elliptic }
}
