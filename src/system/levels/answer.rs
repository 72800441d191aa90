//! The verdict on two levels at one outer step, with how far it stands.

use faer::{Mat, Side};
use num_complex::Complex64;

use super::half::Half;
use super::kernel::{Kernel, Outer};
use crate::number::{Laurent, Rational};
use crate::system::analysis::{Analysis, Evidence, Instability, Multiplier, Part};
use crate::system::explain::explained;
use crate::system::measured::Measured;
use crate::system::piece::estimate;
use crate::system::spectrum::Spectrum;
use crate::verdict::Kind;

impl Kernel {
    /// The verdict at an outer step, for the matrices given and for all within `accuracy`.
    pub fn decide(&self, outer: &Outer, period: &Rational, accuracy: f64) -> Analysis {
        let region = self.is_in_first_region(outer, 0.0);
        let stable = region || self.is_stable_by_index(outer, 0.0);
        let counted = !stable && self.has_real_unstable_mode(outer, 0.0);
        let beyond =
            (!(region || counted && self.is_symmetric(outer))).then(|| self.beyond(outer, 0.0)).flatten();
        let (kind, evidence) = match (&beyond, stable, counted) {
            (_, true, _) => (Kind::Elliptic, Evidence::Signs),
            (_, _, true) => (Kind::Hyperbolic, Evidence::Signs),
            (Some((Some(kind), _)), ..) => (*kind, Evidence::Discs),
            (Some((None, spectrum)), ..) => (estimate(spectrum), Evidence::Estimate),
            (None, ..) => (Kind::Hyperbolic, Evidence::Estimate),
        };
        let spectrum = beyond.map(|(_, spectrum)| spectrum);
        let unstable = kind == Kind::Hyperbolic && evidence.is_proof();
        let margin =
            if unstable { self.unstable_margin(outer, spectrum.as_ref()) } else { self.margin(outer) };
        let (multipliers, instabilities) = self.multipliers(outer, kind, spectrum);
        let part = Part {
            dofs: (0..self.modes.nrows()).collect(),
            size: self.size(),
            period: Laurent::from_rational(period.clone()),
            kind,
            evidence,
            multipliers,
            instabilities,
            roots: None,
            oscillator: None,
        };
        let measured = Some(Measured { margin, ..self.measured(outer, accuracy) });
        Analysis { measured, ..Analysis::of_part(part, 2, self.warnings(evidence)) }
    }

    fn warnings(&self, evidence: Evidence) -> Vec<String> {
        let mut warnings = Vec::new();
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
            warnings.push("doubles do not prove the verdict (eigenvalues too close together or to the edge of stability): it is an estimate".into());
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
        outer: &Outer,
        kind: Kind,
        spectrum: Option<Spectrum>,
    ) -> (Vec<Multiplier>, Vec<Instability>) {
        let Some((mu, radius, shapes)) = self.eigenvalues(outer, spectrum) else { return Default::default() };
        let mut order: Vec<usize> = (0..mu.len()).collect();
        order.sort_by(|&i, &j| mu[i].re.total_cmp(&mu[j].re).then(mu[i].im.total_cmp(&mu[j].im)));
        let sorted: Vec<_> = order.iter().map(|&i| mu[i]).collect();
        let shape = |i: usize| self.shape(&shapes(order[i]));
        let (multipliers, mut instabilities) =
            explained((&sorted, radius), shape, kind, outer.step, |_, _, _| None);
        instabilities.iter_mut().for_each(Instability::normalize);
        (multipliers, instabilities)
    }

    /// Whether p θ < π for every mode, so that cos p θ − V^½ M V^½ tells all multipliers.
    fn is_symmetric(&self, outer: &Outer) -> bool {
        let highest = self.values.last().copied().unwrap_or(0.0);
        Half::new(outer.inner_square * highest, outer.inner_steps).rises()
    }

    /// The μ, a radius where one is proven, and the eigenvectors in the basis of the modes: those of the spectrum, or, where
    /// p θ < π for all modes, of the symmetric cos p θ − V^½ M V^½ = 1 + 2 μ, V = 2 b d.
    #[allow(clippy::type_complexity)]
    fn eigenvalues(
        &self,
        outer: &Outer,
        spectrum: Option<Spectrum>,
    ) -> Option<(Vec<Complex64>, Option<f64>, Box<dyn Fn(usize) -> Vec<Complex64>>)> {
        if let Some(spectrum) = spectrum {
            let (mu, radius) = (spectrum.mu.clone(), spectrum.radius);
            let m = self.size();
            return Some((mu, radius, Box::new(move |i| (0..m).map(|k| spectrum.vectors[(k, i)]).collect())));
        }
        let m = self.size();
        let halves: Vec<Half> =
            self.values.iter().map(|x| Half::new(outer.inner_square * x, outer.inner_steps)).collect();
        let root: Vec<f64> = halves.iter().map(|h| (2.0 * h.b.mid() * h.d.mid()).max(0.0).sqrt()).collect();
        let cosine = |h: &Half| h.a.mid() * h.d.mid() + h.b.mid() * h.c.mid();
        let factor = outer.half_kick();
        let symmetric = Mat::from_fn(m, m, |i, j| {
            (if i == j { cosine(&halves[i]) } else { 0.0 }) - root[i] * factor * self.slow[(i, j)] * root[j]
        });
        let eigen = symmetric.self_adjoint_eigen(Side::Lower).ok()?;
        let mu = (0..m).map(|i| Complex64::new((eigen.S()[i] - 1.0) / 2.0, 0.0)).collect();
        let vectors = eigen.U().to_owned();
        let shape = move |i: usize| (0..m).map(|k| Complex64::new(root[k] * vectors[(k, i)], 0.0)).collect();
        Some((mu, None, Box::new(shape)))
    }

    /// Mass-weighted positions of a combination of the modes.
    fn shape(&self, amplitudes: &[Complex64]) -> Vec<Complex64> {
        let nothing = Complex64::new(0.0, 0.0);
        let entry =
            |i| amplitudes.iter().enumerate().fold(nothing, |sum, (k, c)| sum + c * self.modes[(i, k)]);
        (0..self.modes.nrows()).map(entry).collect()
    }
}
