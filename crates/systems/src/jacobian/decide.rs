//! The verdict on forces that are no gradient, their growth with the steps and without, the friction that
//! masks it.

use faer::{Mat, c64};
use nalgebra::DMatrix;

use super::friction::MOST_MASKED;
use super::model::{Clock, Jacobians};
use super::orbit;
use crate::columns::combined;
use crate::exact::decide::{MuCount, allow_blocks, judged_blocks};
use crate::half::norm;
use crate::spectrum::discs::Spectrum;
use crate::spectrum::explain::explained;
use crate::spectrum::rate;
use crate::verdict::analysis::{Analysis, Evidence, Part};
use crate::verdict::limits::{Limits, Route, degrees_of_freedom};
use clocks::verdict::Kind;
use number::{Laurent, Rational, Result, U, outward};

/// Results beside the verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct NoGradient {
    /// |J − Jᵀ|/|J + Jᵀ| of each potential, rounded.
    pub asymmetries: Vec<f64>,
    /// The growth rate of x'' = −A x itself, without steps, enclosed; `None`: not bounded.
    pub without_steps: Option<(f64, f64)>,
    /// The growth rate for all matrices within their accuracy, enclosed, where they were measured.
    pub within_accuracy: Option<(f64, f64)>,
    /// The least rate of friction per unit time under which nothing grows, rounded; 0 where nothing does,
    /// `None` where it was not looked for.
    pub masking: Option<f64>,
}

impl NoGradient {
    /// How much faster it grows with the steps of a verdict than without, enclosed; `None` where one of these
    /// is not bounded.
    pub fn added_by_steps(&self, analysis: &Analysis) -> Option<(f64, f64)> {
        let ((lo, hi), (least, most)) = (analysis.growth_rate()?, self.without_steps?);
        Some(outward((lo - most, hi - least))).filter(|(lo, hi)| lo.is_finite() && hi.is_finite())
    }
}

impl Jacobians {
    /// The verdict on the matrices given.
    ///
    /// # Errors
    /// A budget error where exact arithmetic is asked for and exceeds the limits.
    pub fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        limits.allow(self.cost(), || format!("a period of {}", degrees_of_freedom(self.size())))?;
        let (spectrum, _) = self.spectrum();
        let mut warnings = Vec::new();
        let by_discs =
            || spectrum.as_ref().and_then(Spectrum::by_discs).map(|kind| (Some(kind), Evidence::Discs));
        let found = if route == Route::Exact { None } else { by_discs() };
        let (decided, roots) = match found {
            Some(found) => (found, None),
            None => match self.exact(limits) {
                Ok((kind, roots)) => ((Some(kind), Evidence::Exact), Some(roots)),
                Err(error) if route == Route::Exact => return Err(error),
                Err(_) => {
                    warnings.push(format!(
                        "doubles do not decide {}: multipliers lie too close together or to the unit circle",
                        degrees_of_freedom(self.size())
                    ));
                    ((None, Evidence::Estimate), None)
                }
            },
        };
        let period = Laurent::from_rational(self.period());
        let multipliers = spectrum.as_ref().map_or_else(Default::default, |spectrum| {
            let shape = |i: usize| spectrum.shape(i, &vec![1.0; self.size()]);
            explained(spectrum.multipliers(), shape, decided.0, &period, |_, _, _| None)
        });
        let mut part = Part { roots, ..Part::new(self.size(), period, decided, multipliers) };
        let n = self.lift.nrows();
        part.dofs = (0..n).collect();
        part.instabilities.iter_mut().for_each(|instability| instability.lift(|y| self.lifted(y)));
        let clocks = self.clocks.len();
        Ok(Analysis { rigid_modes: self.rigid.clone(), ..Analysis::of_part(part, clocks, warnings) })
    }

    /// Products of doubles, roughly: both halves of a period, eigenvalues with vectors and their proof;
    /// periods with friction and their eigenvalues.
    pub fn cost(&self) -> u64 {
        let (n, kicks) = (self.size() as u64, self.schedule.strikes());
        let damped = if self.size() <= MOST_MASKED { 6_000 } else { 0 };
        n.saturating_pow(3).saturating_mul(kicks.saturating_add(60 + damped))
    }

    /// The results beside the verdict.
    pub fn no_gradient(&self) -> NoGradient {
        NoGradient {
            asymmetries: self.asymmetries.clone(),
            without_steps: self.without_steps(),
            within_accuracy: self.within_accuracy(),
            masking: (self.size() <= MOST_MASKED).then(|| self.masking()),
        }
    }

    /// The growth rate with these steps, per unit time, enclosed, for the matrices given; `None`: not
    /// bounded.
    pub fn growth_rate(&self) -> Option<(f64, f64)> {
        self.rate_of(self.spectrum().0.as_ref()?)
    }

    /// The enclosure for all matrices within their accuracy; also `None` for exact matrices.
    pub fn within_accuracy(&self) -> Option<(f64, f64)> {
        self.accuracy?;
        let (spectrum, error_within) = self.spectrum();
        self.rate_of(&spectrum.as_ref()?.with_error(*error_within)?)
    }

    fn rate_of(&self, spectrum: &Spectrum) -> Option<(f64, f64)> {
        if spectrum.by_discs() == Some(Kind::Elliptic) {
            return Some((0.0, 0.0));
        }
        let growth =
            spectrum.multipliers().iter().map(|multiplier| multiplier.growth).collect::<Option<Vec<_>>>()?;
        Some(rate::per_time(rate::largest(growth.into_iter()), &Laurent::from_rational(self.period())))
    }

    /// Positions of what grows fastest with these steps, real and imaginary part, rounded; `None` where
    /// nothing is seen to grow.
    pub fn fastest(&self) -> Option<[Vec<f64>; 2]> {
        let spectrum = self.spectrum().0.as_ref()?;
        let sizes = spectrum.multipliers().into_iter().map(|multiplier| multiplier.size()).enumerate();
        let (i, size) = sizes.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let shape = spectrum.shape(i, &vec![1.0; self.size()]);
        let part = |of: fn(&c64) -> f64| self.lifted(&shape.iter().map(of).collect::<Vec<_>>());
        (size > 1.0).then(|| [part(|z| z.re), part(|z| z.im)])
    }

    /// The eigenvalues of S for the matrices given, and how far S can be from that of others within their
    /// accuracy.
    pub(super) fn spectrum(&self) -> &(Option<Spectrum>, f64) {
        self.spectrum.get_or_init(|| {
            let (s, [error, within]) = orbit::half_product(self);
            (Spectrum::of(s, error.is_finite().then_some(error)), within)
        })
    }

    pub(super) fn lifted(&self, y: &[f64]) -> Vec<f64> {
        combined(&self.lift, y)
    }

    /// The kind by the characteristic polynomial of S, and where the μ lie: of doubles as the numbers that
    /// they are.
    ///
    /// # Errors
    /// A budget error.
    pub fn exact(&self, limits: &Limits) -> Result<(Kind, MuCount)> {
        allow_blocks(self.size(), (self.schedule.strikes() as f64, self.bits()), limits)?;
        let (blocks, product) = orbit::exact(self);
        Ok(judged_blocks(&product, blocks.each_ref()))
    }

    /// The bits of an entry of a kick.
    fn bits(&self) -> f64 {
        /// A double's digits over a power of two.
        const DOUBLE: u64 = 128;
        let bits = |m: &DMatrix<Rational>| m.iter().map(|x| x.numer().bits() + x.denom().bits()).max();
        let of = |clock: &Clock| clock.exact.as_ref().map_or(Some(DOUBLE), bits);
        let count = self.clocks.iter().filter_map(of).max().unwrap_or(0);
        (count + self.tick.numer().bits() + self.tick.denom().bits()) as f64
    }

    /// The growth rate of x'' = −A x itself, enclosed; `None`: not bounded.
    ///
    /// |Im √λ| of the eigenvalues λ of A = Σ A_k, whose discs have one radius r: (|λ| − Re λ)/2 is its square, and moves by r at most.
    pub fn without_steps(&self) -> Option<(f64, f64)> {
        let n = self.size();
        let mut sum = Mat::<f64>::zeros(n, n);
        self.clocks.iter().for_each(|clock| sum += &clock.matrix);
        let size: f64 = self.clocks.iter().map(|clock| norm::frobenius(&clock.matrix)).sum();
        let off = self.clocks.iter().map(|clock| clock.off).sum::<f64>()
            + self.clocks.len() as f64 * 1.1 * U * size;
        let spectrum = Spectrum::of(sum, Some(off))?;
        let radius = 1.01 * spectrum.radius()?;
        let alone = |i: usize| {
            spectrum
                .mu
                .iter()
                .enumerate()
                .all(|(j, other)| i == j || (spectrum.mu[i] - other).norm() > 2.01 * radius)
        };
        let growth = |(i, z): (usize, &c64)| {
            // A real one alone in its disc is real.
            if z.im == 0.0 && z.re > radius && alone(i) {
                return (0.0, 0.0);
            }
            let square = (z.norm() - z.re) / 2.0;
            let rounding = 4.0 * U * z.norm();
            (
                (square - radius - rounding).max(0.0).sqrt() * (1.0 - 1e-15),
                (square + radius + rounding).sqrt() * (1.0 + 1e-15),
            )
        };
        Some(rate::largest(spectrum.mu.iter().enumerate().map(growth)))
    }
}
