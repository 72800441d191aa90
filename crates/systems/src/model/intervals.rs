//! Verdicts over the outer step of a model, or over another number of it.

use super::Model;
use crate::linear::system::System;
use crate::vary::edges::{Family, Linear};
use crate::vary::nearest::Nearest;
use crate::vary::stretches::{Stretch, check_width, most_cells};
use crate::verdict::limits::Limits;
use crate::verdict::measured::Holds;
use number::{Rational, Result, to_f64};

/// A stretch that is open with the data and decided with data this many times as accurate is open by the
/// accuracy.
const BETTER: f64 = 1e3;

/// A number that is varied.
pub enum Number<'a> {
    /// The outer step, all steps in their ratios.
    Outer,
    /// A factor of one of two measured levels, 0 the fast one, and its present value.
    Scale(usize, f64),
    /// One on which masses or stiffnesses depend linearly, steps fixed, and the system of one of its values.
    Linear(&'a (dyn Fn(&Rational) -> Result<System> + Sync)),
}

impl dyn Model {
    /// The verdicts on all values of a number in a range, no interval wider than `width` times its larger end
    /// missed. Of measured stiffnesses they hold for all stiffnesses within their accuracy.
    ///
    /// # Errors
    /// As [`Model::between`]; a width outside \[10^-9, 1/10\].
    pub fn stretches(
        &self,
        number: &Number,
        range: (f64, f64),
        width: f64,
        limits: &Limits,
    ) -> Result<Vec<Stretch>> {
        check_width(width)?;
        self.over(number, range, (width, 1.0), limits)
    }

    fn over(
        &self,
        number: &Number,
        range: (f64, f64),
        (width, times): (f64, f64),
        limits: &Limits,
    ) -> Result<Vec<Stretch>> {
        match number {
            Number::Outer => self.between(range, (width, times), limits),
            Number::Scale(level, factor) => {
                self.measured()?.between_scales(*level, range, *factor, (width, times))
            }
            Number::Linear(at) => Family { linear: Linear::Number, at }.stretches(range, width, limits),
        }
    }

    /// How many of `stretches`, which are those of a number, the accuracy of the data leaves open: data a
    /// thousand times as accurate decide most of such a stretch. `None` where stretches hold for the numbers
    /// given alone.
    ///
    /// # Errors
    /// As [`Model::between`].
    pub fn open_by_accuracy(
        &self,
        number: &Number,
        stretches: &[Stretch],
        limits: &Limits,
    ) -> Result<Option<usize>> {
        if self.measured().is_err() || matches!(number, Number::Linear(_)) {
            return Ok(None);
        }
        let is_told = |stretch: &Stretch| -> Result<bool> {
            let (range, all) = ((stretch.lo, stretch.hi), stretch.hi - stretch.lo);
            // Cells of an eighth, sharpened at their ends.
            let width = (all / stretch.lo.abs().max(stretch.hi.abs()) / 8.0).clamp(1e-9, 0.1);
            let found = self.over(number, range, (width, 1.0 / BETTER), limits)?;
            let told = found.iter().filter(|part| part.verdict != Holds::Undecided);
            Ok(told.map(|part| part.hi - part.lo).sum::<f64>() > all / 2.0)
        };
        // A place between neighbouring doubles is none.
        let is_open =
            |stretch: &&Stretch| stretch.verdict == Holds::Undecided && stretch.lo.next_up() < stretch.hi;
        let told = stretches.iter().filter(is_open).map(is_told).collect::<Result<Vec<_>>>()?;
        Ok(Some(told.into_iter().filter(|told| *told).count()))
    }

    /// The products that these stretches take, as limits count them, where cells are narrow throughout.
    ///
    /// # Errors
    /// As [`Model::cost_between`]; a width outside \[10^-9, 1/10\].
    pub fn cost_of_stretches(
        &self,
        number: &Number,
        range: (f64, f64),
        width: f64,
        limits: &Limits,
    ) -> Result<f64> {
        check_width(width)?;
        let cells = most_cells(range, width);
        match number {
            Number::Linear(at) => Family { linear: Linear::Number, at }.cost(range, cells, limits),
            _ => self.cost_between(range, cells, limits),
        }
    }

    /// The unstable intervals of the outer step next to its own, all steps in their ratios: between half of
    /// it and twice it.
    ///
    /// # Errors
    /// As [`Model::between`] and [`Model::verdict`].
    pub fn nearest_unstable(&self, width: f64, limits: &Limits) -> Result<Nearest> {
        let step = to_f64(&self.outer_step());
        if let Some(all) = self.between_exactly(Nearest::reach(step), limits)? {
            return Ok(Nearest::of(step, &all));
        }
        let verdict = self.verdict(1.0, limits)?;
        Nearest::search((step, verdict), |range| self.stretches(&Number::Outer, range, width, limits))
    }

    /// The largest growth rate at each outer step, as [`Model::growth_at`].
    ///
    /// # Errors
    /// As [`Model::decide`].
    pub fn growth_rates(&self, steps: &[f64], limits: &Limits) -> Result<Vec<Option<f64>>> {
        number::parallel::try_map(steps, |&step| self.growth_at(step, limits))
    }
}
