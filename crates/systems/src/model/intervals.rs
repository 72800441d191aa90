//! Verdicts and growth rates of a model over the outer step, or over another number of it.

use num_traits::One;

use super::Model;
use crate::levels::Method;
use crate::spectrum::rate::middle;
use crate::vary::edges::{Family, Linear};
use crate::vary::nearest::Nearest;
use crate::vary::stretches::{Stretch, check_width, most_cells};
use crate::verdict::analysis::Analysis;
use crate::verdict::decide::{decide_around, decide_by};
use crate::verdict::limits::{Limits, Route};
use crate::verdict::measured::Holds;
use number::Rational;
use number::error::Result;
use number::rational::{from_f64_exact, to_f64};

/// A stretch that is open with the data and decided with data this many times as accurate is open by the
/// accuracy.
const BETTER: f64 = 1e3;

/// A number that is varied.
pub enum Number<'a> {
    /// The outer step, all steps in their ratios.
    Outer,
    /// A factor of one of two measured levels, 0 the fast one, and its present value.
    Scale(usize, f64),
    /// One on which masses or stiffnesses depend linearly, steps fixed, and the model of one of its values.
    Linear(&'a (dyn Fn(&Rational) -> Result<Model> + Sync)),
}

impl Model {
    /// The verdicts on all values of a number in a range, no interval wider than `width` times its larger end
    /// missed. Of measured stiffnesses they hold for all stiffnesses within their accuracy.
    ///
    /// # Errors
    /// As [`Family::stretches`]; a width outside \[10^-9, 1/10\].
    pub fn stretches(
        &self,
        number: &Number,
        range: (f64, f64),
        width: f64,
        limits: &Limits,
    ) -> Result<Vec<Stretch>> {
        check_width(width)?;
        match (number, self) {
            (Number::Scale(level, factor), Model::Measured(own)) => {
                own.stretches_of_scale(*level, range, *factor, (width, own.accuracy))
            }
            (Number::Linear(at), _) => {
                let at = |x: &Rational| Ok(at(x)?.moving()?.into_owned());
                Family { linear: Linear::Number, at: &at }.stretches(range, width, limits)
            }
            (_, Model::LocalSteps(own)) => own.stretches(range, limits),
            (_, Model::Along(_) | Model::NoGradient(_) | Model::Sparse(_)) => Err(self.no_intervals()),
            (_, Model::Measured(own)) => own.stretches(range, width, own.accuracy),
            _ => self.over_outer_steps(|family| family.stretches(range, width, limits)),
        }
    }

    /// How many of `stretches`, which are those of [`Model::stretches`], the accuracy of the data leaves
    /// open: data a thousand times as accurate decide most of such a stretch. `None` where stretches hold for
    /// the numbers given alone.
    ///
    /// # Errors
    /// As [`Model::stretches`].
    pub fn open_by_accuracy(&self, number: &Number, stretches: &[Stretch]) -> Result<Option<usize>> {
        let Some(own) = self.measured().filter(|_| !matches!(number, Number::Linear(_))) else {
            return Ok(None);
        };
        let accuracy = own.accuracy / BETTER;
        let is_told = |of: &Stretch| -> Result<bool> {
            let (range, all) = ((of.lo, of.hi), of.hi - of.lo);
            // Cells of an eighth, sharpened at their ends.
            let width = (all / of.lo.abs().max(of.hi.abs()) / 8.0).clamp(1e-9, 0.1);
            let found = match number {
                Number::Scale(level, factor) => {
                    own.stretches_of_scale(*level, range, *factor, (width, accuracy))?
                }
                _ => own.stretches(range, width, accuracy)?,
            };
            let told = found.iter().filter(|of| of.verdict != Holds::Undecided).map(|of| of.hi - of.lo);
            Ok(told.sum::<f64>() > all / 2.0)
        };
        // A place between neighbouring doubles is none.
        let untold = stretches.iter().filter(|of| of.verdict == Holds::Undecided && of.lo.next_up() < of.hi);
        let told = untold.map(is_told).collect::<Result<Vec<_>>>()?;
        Ok(Some(told.into_iter().filter(|told| *told).count()))
    }

    /// The products of doubles that these cost, roughly, where cells are narrow throughout.
    ///
    /// # Errors
    /// As [`Family::cost`]; a width outside \[10^-9, 1/10\].
    pub fn cost_of_stretches(
        &self,
        number: &Number,
        range: (f64, f64),
        width: f64,
        limits: &Limits,
    ) -> Result<f64> {
        check_width(width)?;
        self.cost_of_cells(number, range, most_cells(range, width), limits)
    }

    fn cost_of_cells(&self, number: &Number, range: (f64, f64), cells: f64, limits: &Limits) -> Result<f64> {
        match (number, self) {
            (Number::Linear(at), _) => {
                let at = |x: &Rational| Ok(at(x)?.moving()?.into_owned());
                Family { linear: Linear::Number, at: &at }.cost(range, cells, limits)
            }
            (_, Model::Measured(own)) => own.cost_of_cells(cells),
            (_, Model::LocalSteps(own)) => Ok(own.cost()),
            (_, Model::Along(_) | Model::NoGradient(_) | Model::Sparse(_)) => Err(self.no_intervals()),
            _ => self.over_outer_steps(|family| family.cost(range, cells, limits)),
        }
    }

    /// The products of doubles that [`Model::nearest_unstable`] takes, roughly.
    ///
    /// # Errors
    /// As [`Family::cost`].
    pub fn cost_of_nearest(&self, width: f64, limits: &Limits) -> Result<f64> {
        check_width(width)?;
        let step = to_f64(&self.outer_step());
        let cells = Nearest::most_cells(step, width);
        // Of two measured levels all below the first unstable step is one proof, and of waters a quarter of
        // what is above it is narrow cells.
        let is_measured = matches!(self, Model::Measured(levels) if levels.is_of_two_levels());
        let cells = if is_measured { cells / 4.0 } else { cells };
        self.cost_of_cells(&Number::Outer, Nearest::reach(step), cells, limits)
    }

    /// The result of `ask` on the systems of all outer steps.
    fn over_outer_steps<T>(&self, ask: impl Fn(&Family) -> Result<T>) -> Result<T> {
        if let Model::Implicit(own) = self {
            return ask(&Family { linear: Linear::Square, at: &|square| own.at_square(square) });
        }
        let (system, own) = (self.moving()?, self.outer_step());
        // In the old steps all stiffnesses grow as the square of the step does.
        let at = |square: &Rational| system.with(&(square / (&own * &own)), &Rational::one());
        ask(&Family { linear: Linear::Square, at: &at })
    }

    fn no_intervals(&self) -> number::error::Error {
        self.refused("the intervals of a step")
    }

    /// The unstable intervals of the outer step next to its own, all steps in their ratios: between half of
    /// it and twice it.
    ///
    /// # Errors
    /// As [`Model::stretches`] and [`Model::decide`].
    pub fn nearest_unstable(&self, width: f64, limits: &Limits) -> Result<Nearest> {
        let step = to_f64(&self.outer_step());
        if let Model::LocalSteps(own) = self {
            return Ok(Nearest::of(step, &own.stretches(Nearest::reach(step), limits)?));
        }
        let is_searched = matches!(self, Model::Measured(_) | Model::NoGradient(_) | Model::Sparse(_));
        if !is_searched {
            let exactly = |family: &Family| family.exactly(Nearest::reach(step), limits);
            if let Some(all) = self.over_outer_steps(exactly)? {
                return Ok(Nearest::of(step, &all));
            }
        }
        let own = self.holds(limits)?;
        Nearest::search((step, own), |range| self.stretches(&Number::Outer, range, width, limits))
    }

    /// The verdict with the outer step `outer` > 0, all steps in their ratios.
    ///
    /// # Errors
    /// As [`Model::decide`].
    pub fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        if let Some(own) = self.levels() {
            return own.decide_at(outer, limits);
        }
        let factor = outer / self.outer_step();
        match self {
            Model::NoGradient(own) => own.slowed(&factor)?.decide(Route::Cheapest, limits),
            Model::Along(_) => Err(self.refused("the verdict at another step")),
            Model::Sparse(own) => match own.at_step(outer) {
                Some(own) => own?.decide(limits),
                None => Err(self.refused("the verdict at another step")),
            },
            Model::Pi(own) => decide_around(&own.with(&Rational::one(), &factor)?, limits),
            Model::LocalSteps(own) => decide_by(Route::Cheapest, own.at(outer)?.system(), limits),
            Model::Implicit(own) => decide_by(Route::Cheapest, &own.at(outer)?, limits),
            _ => decide_by(Route::Cheapest, &self.moving()?.with(&Rational::one(), &factor)?, limits),
        }
    }

    /// The largest growth rate at each outer step, all steps in their ratios, per unit time, rounded; `None`
    /// where it is not known to a quarter, nor to be less than 10^-3 a step.
    ///
    /// # Errors
    /// As [`Model::decide`].
    pub fn growth_rates(&self, steps: &[f64], limits: &Limits) -> Result<Vec<Option<f64>>> {
        if let Some(own) = self.levels() {
            return own.growth_rates(steps);
        }
        let rate = |&step: &f64| {
            let outer = from_f64_exact(step).expect("a finite step");
            let known = |(lo, hi): &(f64, f64)| hi - lo <= 0.25 * lo || hi * step <= 1e-3;
            Ok(self.decide_at(&outer, limits)?.growth_rate().filter(known).map(middle))
        };
        number::parallel::try_map(steps, rate)
    }

    /// The longest step.
    pub fn outer_step(&self) -> Rational {
        self.steps().into_iter().max().unwrap_or_default()
    }

    /// The integrator: kicks and drifts, unless two levels have another.
    pub fn method(&self) -> Method {
        match self {
            Model::Implicit(_) => Method::ImplicitExplicit,
            _ => self.levels().map_or(Method::Respa, |own| own.method()),
        }
    }

    /// The inner steps in an outer one of two measured levels.
    pub fn inner_steps(&self) -> Option<u64> {
        self.levels().map(|own| own.inner_steps())
    }
}
