//! The one face of dense levels: two of an integer ratio by their eigenbasis, any others by the action.
//! Verdicts, ranges and advice ask both alike.

use std::fmt::Debug;

use faer::Mat;

use super::kernel::{AtRatio, Kernel, Outer, highest_frequency};
use super::nested::Nested;
use super::search::{Decided, Search, bracket_below};
use crate::bias::{self, BiasedMode, NoBias};
use crate::columns::combined;
use crate::half::period::Stiffness;
use crate::verdict::analysis::{Analysis, Instability};
use crate::verdict::measured::Removed;
use clocks::schedule::Schedule;
use number::{Error, Rational, Result};

/// Stiffnesses of levels, steps and rates in their unit of time; `steps` are those of all levels, innermost
/// first. What is proven of an outer step is so with all others in their ratios to it.
pub trait Source: Debug + Send + Sync {
    /// These levels at the ratios of some steps.
    ///
    /// # Errors
    /// Another number of them, ratios that are not answered for.
    fn at(&self, steps: &[Rational]) -> Result<Box<dyn Search + '_>>;

    /// The motions that were projected out.
    fn removed(&self) -> Option<&Removed>;

    /// λ of the innermost stiffness alone, increasing, rounded.
    fn fast_squares(&self) -> &[f64];

    /// Their modes as columns in the mass-weighted coordinates given: of length 1, rounded.
    fn fast_modes(&self) -> &Mat<f64>;

    /// The k-th of these.
    fn fast_mode(&self, k: usize) -> Vec<f64> {
        self.fast_modes().col(k).iter().copied().collect()
    }

    /// The highest frequency of each slower stiffness alone, rounded; 0 where it has none.
    fn slower_frequencies(&self) -> Vec<f64>;

    /// The verdict for all stiffnesses within `accuracy` of their norms, and what grows.
    ///
    /// # Errors
    /// As [`Source::at`], here and below.
    fn decide(&self, steps: &[Rational], accuracy: f64) -> Result<Decided>;

    /// The bias of each normal mode where these steps are stable.
    fn biased_modes(&self, steps: &[Rational]) -> Result<std::result::Result<Vec<BiasedMode>, NoBias>>;

    /// Positions of a pair of these in the mass-weighted coordinates given.
    fn shape(&self, x: &[f64]) -> Vec<f64>;

    /// The eigenbasis that other integrators of two levels are decided in.
    fn kernel(&self) -> Option<&Kernel> {
        None
    }
}

fn outer_of(steps: &[Rational]) -> Result<Outer> {
    let [inner, outer] = steps else {
        let remedy = "these Hessians are on two clocks: give two steps, as 0.5fs,4fs";
        return Err(Error::input("steps", format!("{} of them", steps.len()), remedy));
    };
    Outer::of_steps(inner, outer).ok_or_else(|| {
        let remedy =
            "Hessians on two clocks are answered for an outer step that is a multiple of the inner one";
        Error::input("steps", format!("a ratio of {}", outer / inner), remedy)
    })
}

impl Search for AtRatio<'_> {
    fn outer_step(&self) -> f64 {
        self.outer.step
    }

    fn region_end(&self) -> Option<(f64, f64)> {
        self.kernel.first_region_end(self.outer.inner_steps, 0.0)
    }

    fn is_stable(&self, step: f64) -> bool {
        self.outer(step).is_ok_and(|outer| self.kernel.is_stable(&outer, 0.0))
    }

    fn is_unstable(&self, step: f64) -> bool {
        self.outer(step).is_ok_and(|outer| self.kernel.is_unstable(&outer, 0.0))
    }

    fn unstable_end(&self, at: f64, width: f64) -> Result<Option<f64>> {
        // A little inwards, for the roundings of the roots.
        let inner = 0.999_999 * width;
        let middle = at / (1.0 - inner).sqrt();
        let grows = self.kernel.has_real_unstable_mode(&self.outer(middle)?, width);
        Ok(grows.then(|| middle * (1.0 + inner).sqrt()))
    }

    fn rate(&self, step: f64) -> Result<f64> {
        Ok(self.kernel.growth(&self.outer(step)?))
    }

    fn covers_band(&self, step: f64, band: f64, epsilon: f64) -> bool {
        self.outer(step).is_ok_and(|outer| self.kernel.covers_band(&outer, band, epsilon))
    }

    fn band_bracket(&self, holds: &dyn Fn(f64) -> bool) -> Option<(f64, f64)> {
        let end = self.kernel.band_end(self.outer.inner_steps);
        bracket_below(end, |step| end.is_finite() && holds(step))
    }

    fn damped_period(&self, step: f64, friction: f64) -> Option<(Mat<f64>, f64)> {
        self.kernel.damped_period(&self.outer(step).ok()?, friction)
    }
}

impl Kernel {
    /// As [`Search::first_unstable`], of all outer steps of as many inner ones.
    pub fn first_unstable(&self, inner_steps: u64) -> Option<(f64, f64)> {
        self.at(&Outer::new(1.0, inner_steps).ok()?).first_unstable()
    }

    /// As [`Search::band_edge`], of all outer steps of as many inner ones.
    pub fn band_edge(&self, inner_steps: u64, band: f64, epsilon: f64) -> Option<f64> {
        self.at(&Outer::new(1.0, inner_steps).ok()?).band_edge(band, epsilon)
    }
}

/// Two levels, the outer step a multiple of the inner one.
impl Source for Kernel {
    fn at(&self, steps: &[Rational]) -> Result<Box<dyn Search + '_>> {
        Ok(Box::new(self.at(&outer_of(steps)?)))
    }

    fn removed(&self) -> Option<&Removed> {
        self.removed.as_ref()
    }

    fn fast_squares(&self) -> &[f64] {
        &self.values
    }

    fn fast_modes(&self) -> &Mat<f64> {
        &self.modes
    }

    fn slower_frequencies(&self) -> Vec<f64> {
        vec![self.highest_slow_frequency()]
    }

    fn decide(&self, steps: &[Rational], accuracy: f64) -> Result<Decided> {
        let outer = outer_of(steps)?;
        let analysis = self.decide(&outer, &steps[1], accuracy);
        let measured = analysis.measured.as_ref().expect("Hessians are measured");
        Ok(Decided {
            holds: measured.holds,
            is_in_first_region: self.is_in_first_region(&outer, accuracy),
            margin: measured.margin.filter(|_| analysis.is_stable()),
            rate: growth(&analysis),
            growing: fastest_instability(&analysis)
                .map(|instability| [instability.shape.clone(), instability.quadrature.clone()]),
        })
    }

    /// In the eigenbasis, where a fast kick touches each mode alone.
    fn biased_modes(&self, steps: &[Rational]) -> Result<std::result::Result<Vec<BiasedMode>, NoBias>> {
        outer_of(steps)?;
        let fast = self.values.iter().enumerate().map(|(i, value)| (i, vec![(i, *value)])).collect();
        let kicks = vec![Stiffness::Rows(fast), Stiffness::Whole(self.slow.clone())];
        Ok(bias::of_levels(&schedule(steps)?, self.values.len(), kicks))
    }

    fn shape(&self, x: &[f64]) -> Vec<f64> {
        combined(&self.modes, x)
    }

    fn kernel(&self) -> Option<&Kernel> {
        Some(self)
    }
}

/// Any other number of levels, or ratios.
impl Source for Nested {
    fn at(&self, steps: &[Rational]) -> Result<Box<dyn Search + '_>> {
        Ok(Box::new(self.at(steps)?))
    }

    fn removed(&self) -> Option<&Removed> {
        self.removed.as_ref()
    }

    fn fast_squares(&self) -> &[f64] {
        &self.squares
    }

    fn fast_modes(&self) -> &Mat<f64> {
        &self.modes
    }

    fn slower_frequencies(&self) -> Vec<f64> {
        self.levels[1..].iter().map(|level| highest_frequency(&level.stiffness)).collect()
    }

    fn decide(&self, steps: &[Rational], accuracy: f64) -> Result<Decided> {
        let at = self.at(steps)?;
        Ok(at.decide(at.outer_step(), accuracy))
    }

    fn biased_modes(&self, steps: &[Rational]) -> Result<std::result::Result<Vec<BiasedMode>, NoBias>> {
        self.at(steps)?;
        let kicks = self.levels.iter().map(|level| Stiffness::Whole(level.stiffness.clone())).collect();
        Ok(bias::of_levels(&schedule(steps)?, self.size(), kicks))
    }

    fn shape(&self, x: &[f64]) -> Vec<f64> {
        self.basis.as_ref().map_or_else(|| x.to_vec(), |basis| combined(basis, x))
    }
}

fn schedule(steps: &[Rational]) -> Result<Schedule> {
    Schedule::new(steps, &vec![Rational::default(); steps.len()])
}

/// The largest growth rate, per unit of time, rounded; `None` where it is not decided whether anything grows.
fn growth(analysis: &Analysis) -> Option<f64> {
    let largest =
        instabilities(analysis).map(|instability| instability.multiplier.size().ln()).fold(0.0, f64::max);
    analysis.is_proof().then(|| largest / analysis.period.to_f64())
}

fn instabilities(analysis: &Analysis) -> impl Iterator<Item = &Instability> {
    analysis.parts.iter().flat_map(|part| &part.instabilities)
}

fn fastest_instability(analysis: &Analysis) -> Option<&Instability> {
    instabilities(analysis).max_by(|a, b| a.multiplier.size().total_cmp(&b.multiplier.size()))
}
