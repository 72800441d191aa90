//! Dense stiffnesses in doubles as a model.

use std::borrow::Cow;
use std::sync::Arc;

use super::measured::{MeasuredSystem, rational};
use super::{Model, decide_slower, growth_of_decision};
use crate::friction::Friction;
use crate::levels::{Cells, Method, Outer};
use crate::linear::system::System;
use crate::vary::nearest::Nearest;
use crate::vary::stretches::{Stretch, cover};
use crate::verdict::analysis::Analysis;
use crate::verdict::limits::{DENSE, Limits, Route};
use crate::verdict::measured::Holds;
use number::{Rational, Result, to_f64};

/// A cell of a range of n degrees of freedom takes n² (n + this) products, as measured for 81 to 1,080 of
/// them: eigenvalues, factorizations and norms in wide cells that decide much, and in narrow ones; what goes
/// by entries is slower than products of matrices.
const CELL: f64 = 1100.0;

impl Model for MeasuredSystem {
    /// In mass-weighted coordinates with unit masses where the stiffnesses are.
    fn system(&self) -> &System {
        self.system.get_or_init(|| {
            let masses = self.body.masses.as_ref().filter(|_| !self.body.is_weighted);
            rational(masses.map_or(&vec![1.0; self.size()], |values| values), &self.potentials)
        })
    }

    fn size(&self) -> usize {
        self.size()
    }

    fn steps(&self) -> Vec<Rational> {
        self.steps()
    }

    /// Two eigenvalue problems, changes of basis, some fifty factorizations.
    fn cost(&self) -> u64 {
        (self.size() as u64).saturating_pow(3).saturating_mul(60) / DENSE
    }

    /// Two levels by their kernel, any others as a rational system of the doubles given and by the action.
    fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        let Some((outer, period)) = self.outer().filter(|_| route == Route::Cheapest) else {
            self.refuse_method("exact arithmetic")?;
            return self.decide_levels(route, limits);
        };
        self.allow(limits)?;
        self.decided(&outer, &period)
    }

    /// Of levels that are not two without the margin.
    fn at_point(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        if self.outer().is_some() {
            return self.decide(route, limits);
        }
        self.refuse_method("exact arithmetic")?;
        Ok(self.decide_projected(route, limits)?.0)
    }

    /// Of two levels in the eigenbasis, where it is known, else at the least cost for this one verdict.
    fn verdict(&self, times: f64, limits: &Limits) -> Result<Holds> {
        self.allow(limits)?;
        let accuracy = times * self.accuracy;
        let is_given = times == 0.0;
        match self.outer() {
            Some((outer, _)) if is_given && self.kernel.get().is_none() && self.method() == Method::Respa => {
                self.hessians()?.verdict(&outer)
            }
            Some((outer, _)) => Ok(self.kernel()?.verdict_within(&outer, accuracy)),
            None if is_given => Ok(self.decide_projected(Route::Cheapest, limits)?.0.holds()),
            None => self.over_steps(|levels, steps| {
                let outer = to_f64(steps.last().expect("at least one"));
                Ok(levels.at(steps)?.verdict_within(outer, accuracy))
            }),
        }
    }

    /// With as many inner steps in it as in its own.
    fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        self.allow(limits)?;
        match self.inner_steps() {
            Some(inner_steps) => self.decided(&Outer::new(to_f64(outer), inner_steps)?, outer),
            None => decide_slower(&*self.moving()?, &(outer / self.outer_step()), limits),
        }
    }

    fn moving(&self) -> Result<Cow<'_, System>> {
        self.moving()
    }

    fn to_run(&self) -> Result<&System> {
        self.refuse_constraints().and(self.refuse_method("a run")).map(|()| self.system())
    }

    fn growth_of_period(&self, limits: &Limits) -> Result<Option<f64>> {
        let Some((outer, _)) = self.outer() else { return Ok(None) };
        let (hessians, inner_steps) = (self.hessians()?, outer.inner_steps());
        let cost = hessians.cost_of_period(inner_steps);
        limits.allow_dense(cost, || "the full period, kick by kick,".into())?;
        Ok(Some(hessians.growth_of_step(self.method(), outer.step(), inner_steps)))
    }

    fn growth_at(&self, outer: f64, limits: &Limits) -> Result<Option<f64>> {
        if let Some(inner_steps) = self.inner_steps() {
            return Ok(self.kernel()?.growth_rate(&Outer::new(outer, inner_steps)?));
        }
        growth_of_decision(self, outer, limits)
    }

    fn friction(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        self.refuse_method("friction")?;
        let Some((outer, _)) = self.outer() else { return self.friction_projected(rate, limits) };
        // Some 20 eigenvalue problems of 2n rows, each 25 (2n)³.
        let cost = (self.size() as u64).saturating_pow(3).saturating_mul(4_000);
        limits.allow_dense(cost, || format!("the eigenvalues of a period of {} rows", 2 * self.size()))?;
        Ok(self.kernel()?.friction(&outer, rate))
    }

    /// Another than kicks and drifts has two levels.
    fn method(&self) -> Method {
        self.method()
    }

    fn inner_steps(&self) -> Option<u64> {
        self.outer().map(|(outer, _)| outer.inner_steps())
    }

    fn between(&self, range: (f64, f64), (width, times): (f64, f64), _: &Limits) -> Result<Vec<Stretch>> {
        let accuracy = times * self.accuracy;
        match self.inner_steps() {
            Some(inner_steps) => self.kernel()?.stretches(inner_steps, range, width, accuracy),
            None => self.over_steps(|levels, steps| levels.at(steps)?.stretches(range, width, accuracy)),
        }
    }

    fn between_exactly(&self, _: (f64, f64), _: &Limits) -> Result<Option<Vec<Stretch>>> {
        Ok(None)
    }

    fn cost_between(&self, _: (f64, f64), cells: f64, _: &Limits) -> Result<f64> {
        let n = self.size() as f64;
        let products = match self.inner_steps() {
            Some(_) => self.cost() as f64 * DENSE as f64 + cells * n * n * (n + CELL),
            None => self.over_steps(|levels, steps| Ok(levels.at(steps)?.cost_of_cells(cells)))?,
        };
        Ok(products / DENSE as f64)
    }

    /// Of two levels all below the first unstable step is one proof, and of waters a quarter of what is above
    /// it is narrow cells.
    fn cost_of_nearest(&self, width: f64, limits: &Limits) -> Result<f64> {
        let step = to_f64(&self.outer_step());
        let cells = Nearest::most_cells(step, width);
        let cells = if self.outer().is_some() { cells / 4.0 } else { cells };
        self.cost_between(Nearest::reach(step), cells, limits)
    }

    fn at_accuracy(self: Arc<Self>, accuracy: f64) -> Result<Arc<dyn Model>> {
        Ok(Arc::new(Arc::unwrap_or_clone(self).at_accuracy(accuracy)?))
    }

    fn keeping_rigid(self: Arc<Self>) -> Result<Arc<dyn Model>> {
        Ok(Arc::new(Arc::unwrap_or_clone(self).keeping_rigid()))
    }

    fn with_method(self: Arc<Self>, method: Method) -> Result<Arc<dyn Model>> {
        Ok(Arc::new(Arc::unwrap_or_clone(self).with_method(method)?))
    }

    fn copy_settings_from(&mut self, other: &dyn Model) {
        other.measured().into_iter().for_each(|other| self.copy_settings_from(other));
    }

    fn measured(&self) -> Result<&MeasuredSystem> {
        Ok(self)
    }
}

impl MeasuredSystem {
    /// Of one potential, too, which is one clock.
    fn decided(&self, outer: &Outer, period: &Rational) -> Result<Analysis> {
        let analysis = self.kernel()?.decide(outer, period, self.accuracy);
        Ok(Analysis { clocks: self.potentials.len(), ..analysis })
    }

    fn allow(&self, limits: &Limits) -> Result<()> {
        limits.allow(self.cost(), || format!("eigenvalues and factorizations of {} rows", self.size()))
    }

    /// The verdicts on a range of factors of one level, 0 the fast one, of the present value `factor`, all
    /// else as it is.
    pub(super) fn between_scales(
        &self,
        level: usize,
        (lo, hi): (f64, f64),
        factor: f64,
        (width, times): (f64, f64),
    ) -> Result<Vec<Stretch>> {
        let Some((outer, _)) = self.outer() else {
            return Ok(vec![Stretch { lo, hi, verdict: Holds::Undecided }]);
        };
        let cells = Cells::new(self.kernel()?, times * self.accuracy)?;
        cover((lo, hi), width, |lo, hi| {
            let (a, b) = (lo / factor, hi / factor);
            Ok(cells.verdict_scaled(&outer, level, (a.min(b), a.max(b))))
        })
    }
}
