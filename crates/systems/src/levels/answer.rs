//! The verdict on two levels at one outer step, with how far it stands.

use faer::Side;
use num_complex::Complex64;

use super::kernel::{Kernel, Outer};
use crate::spectrum::discs::Spectrum;
use crate::spectrum::explain::explained;
use crate::spectrum::rate::Multiplier;
use crate::verdict::analysis::{Analysis, Evidence, Instability, Part};
use crate::verdict::measured::Measured;
use clocks::verdict::Kind;
use number::{Laurent, Rational};

impl Kernel {
    /// The verdict at an outer step, for the matrices given and for all within `accuracy`.
    pub fn decide(&self, outer: &Outer, period: &Rational, accuracy: f64) -> Analysis {
        let stable = self.is_stable(outer, 0.0);
        let counted = !stable && self.has_real_unstable_mode(outer, 0.0);
        let (proven, spectrum) = self.spectrum(outer, !(stable || counted)).unzip();
        let (kind, evidence) = match (stable, counted, proven.flatten()) {
            (true, ..) => (Some(Kind::Elliptic), Evidence::Signs),
            (_, true, _) => (Some(Kind::Hyperbolic), Evidence::Signs),
            (.., Some(kind)) => (Some(kind), Evidence::Discs),
            (.., None) => (None, Evidence::Estimate),
        };
        let unstable = kind == Some(Kind::Hyperbolic);
        let margin =
            if unstable { self.unstable_margin(outer, spectrum.as_ref()) } else { self.margin(outer) };
        let period = Laurent::from_rational(period.clone());
        let multipliers =
            spectrum.map(|spectrum| self.multipliers(&spectrum, kind, &period)).unwrap_or_default();
        let part = Part::new(self.size(), period, (kind, evidence), multipliers);
        let part = Part { dofs: (0..self.modes.nrows()).collect(), ..part };
        let measured = Some(Measured { margin, ..self.measured(outer, accuracy) });
        Analysis { measured, ..Analysis::of_part(part, 2, self.warnings(evidence, accuracy)) }
    }

    fn warnings(&self, evidence: Evidence, accuracy: f64) -> Vec<String> {
        let mut warnings: Vec<String> =
            self.removed.iter().filter_map(|removed| removed.warning(accuracy)).collect();
        if !self.is_total_definite() {
            let (lowest, mode) = self.lowest_total();
            let moves = match mode {
                Some(i) => format!(", of a mode that moves degree of freedom {i} most (from 0)"),
                None => String::new(),
            };
            warnings.push(format!(
                "the total stiffness is not proven positive definite: its lowest eigenvalue is {lowest:.3e}{moves}, so the \
                 system itself may be unstable, whatever the steps"
            ));
        }
        if evidence == Evidence::Estimate {
            warnings.push(
                "doubles do not decide (eigenvalues too close together or to the edge of stability)".into(),
            );
        }
        warnings
    }

    /// The lowest eigenvalue of F + S, and the mass-weighted coordinate that its mode moves most; rounded.
    fn lowest_total(&self) -> (f64, Option<usize>) {
        let Ok(eigen) = self.total().self_adjoint_eigen(Side::Lower) else { return (f64::NAN, None) };
        let amplitudes: Vec<_> = (0..self.size()).map(|k| eigen.U()[(k, 0)].into()).collect();
        let shape = self.shape(&amplitudes).into_iter().map(|x| x.re.abs()).enumerate();
        (eigen.S()[0], shape.max_by(|x, y| x.1.total_cmp(&y.1)).map(|(i, _)| i))
    }

    fn measured(&self, outer: &Outer, accuracy: f64) -> Measured {
        let first_unstable = self.first_unstable(outer.inner_steps);
        Measured {
            method: self.method.name(),
            accuracy,
            holds: self.verdict_within(outer, accuracy),
            margin: None,
            first_unstable,
            is_above_unstable: first_unstable.is_some_and(|(_, hi)| outer.step > hi),
            removed: self.removed.clone(),
        }
    }

    /// Every multiplier, and the shapes of those that grow.
    fn multipliers(
        &self,
        spectrum: &Spectrum,
        kind: Option<Kind>,
        period: &Laurent,
    ) -> (Vec<Multiplier>, Vec<Instability>) {
        let shape = |i: usize| {
            let amplitudes: Vec<_> = (0..self.size()).map(|k| spectrum.vectors[(k, i)]).collect();
            self.shape(&amplitudes)
        };
        let (multipliers, mut instabilities) =
            explained(spectrum.multipliers(), shape, kind, period, |_, _, _| None);
        instabilities.iter_mut().for_each(Instability::normalize);
        (multipliers, instabilities)
    }

    /// Mass-weighted positions of a combination of the modes.
    fn shape(&self, amplitudes: &[Complex64]) -> Vec<Complex64> {
        let nothing = Complex64::new(0.0, 0.0);
        let entry =
            |i| amplitudes.iter().enumerate().fold(nothing, |sum, (k, c)| sum + c * self.modes[(i, k)]);
        (0..self.modes.nrows()).map(entry).collect()
    }
}
