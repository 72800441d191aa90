//! Algorithm 1 run on a system file: what to run, and what the run shows.

use std::str::FromStr;

use super::SystemScene;
use crate::avi::{Ends, Force, Run, Simulation, growth_rate, irreversibility, series};
use crate::error::{Error, Kind, Result};
use crate::number::parse::parse_rational;
use crate::number::rational::to_f64;
use crate::parallel::go_on;
use crate::system::{Limits, Route, middle};

/// The starting displacement of each degree of freedom; one number alone moves the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacement {
    text: String,
    values: Vec<f64>,
}

impl FromStr for Displacement {
    type Err = Error;

    /// Exact numbers between commas, as `1/10,0,0`.
    fn from_str(text: &str) -> Result<Self> {
        let read = |part: &str| Ok(to_f64(&parse_rational("displace", part)?));
        let values = text.split(',').map(read).collect::<Result<Vec<_>>>()?;
        if values.iter().all(|&x| x == 0.0) {
            return Err(Error::input("displace", text, "nothing would move: displace something"));
        }
        Ok(Displacement { text: text.into(), values })
    }
}

impl std::fmt::Display for Displacement {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

impl Displacement {
    /// One for each of `size` degrees of freedom.
    ///
    /// # Errors
    /// Where there are neither 1 nor `size` numbers.
    pub fn of(&self, size: usize) -> Result<Vec<f64>> {
        let given = self.values.len();
        if given != 1 && given != size {
            let remedy = format!("give 1 number or {size}, one a degree of freedom");
            return Err(Error::input("displace", &self.text, remedy));
        }
        Ok(self.values.iter().copied().chain(std::iter::repeat_n(0.0, size - given)).collect())
    }
}

/// A run that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRequest {
    /// Synchronization periods to run.
    pub periods: u32,
    pub displacement: Displacement,
    /// The kicks at the ends of a period: whole ones at its start, or halves at both ends.
    pub ends: Ends,
}

impl RunRequest {
    /// The most periods: the series is kept in memory, and is written as some 50 MB.
    pub const MOST_PERIODS: u32 = 1_000_000;
}

/// The size of the deviations whose growth is measured: their squares are lost in it, and it is far above roundoff.
const DEVIATION: f64 = 1e-6;

impl SystemScene {
    /// Runs Algorithm 1 from rest at the displacement: the bonds themselves about the integrator's own orbit, or the equilibrium
    /// where that is one, linear systems about 0;
    /// and predicts the growth by the multipliers.
    ///
    /// # Errors
    /// No periods or too many, a displacement of another size or of an energy beyond all doubles; a budget error with the cost,
    /// before the run; as [`Model::decide`](crate::system::Model::decide) and [`SystemScene::linear_simulation`].
    pub fn run(&self, request: &RunRequest, limits: &Limits) -> Result<Run> {
        let most = RunRequest::MOST_PERIODS;
        if request.periods == 0 || request.periods > most {
            return Err(Error::input("periods", request.periods, format!("choose 1 to {most}")));
        }
        // Without an orbit to be found: about the equilibrium.
        let own = self.own_orbit(limits).or_else(|error| match error.kind() {
            Kind::Input => Ok(None),
            _ => Err(error),
        })?;
        let predicted = match &own {
            Some(orbit) => orbit.analysis.growth_rate(),
            None => self.model.decide(Route::Cheapest, limits)?.growth_rate(),
        };
        let predicted = predicted.map_or(f64::NAN, middle);
        let shift = request.displacement.of(self.model.size())?;
        let rest = vec![0.0; shift.len()];
        let Some(centre) = own.as_ref().map(|orbit| orbit.start.as_slice()).or_else(|| self.equilibrium())
        else {
            let make = || self.linear_simulation(shift.clone(), rest.clone());
            return request.measure(make, &rest, (predicted, None, true), limits);
        };
        let start: Vec<f64> = centre.iter().zip(&shift).map(|(x, d)| x + d).collect();
        let make =
            || Ok(self.nonlinear_simulation(start.clone(), rest.clone())?.expect("a system with bonds"));
        let displacement = own.as_ref().map(|orbit| orbit.displacement);
        request.measure(make, centre, (predicted, displacement, self.is_linear()), limits)
    }
}

impl RunRequest {
    fn measure<F: Force<f64>>(
        &self,
        make: impl Fn() -> Result<Simulation<f64, F>>,
        centre: &[f64],
        (predicted, displacement, linear): (f64, Option<f64>, bool),
        limits: &Limits,
    ) -> Result<Run> {
        let mut simulation = make()?;
        let period = simulation.clocks().period();
        // The series, the measurement of growth, and one period forward and back.
        let runs = 2 * u64::from(self.periods) + 2;
        limits.allow(simulation.cost(period).saturating_mul(runs), || {
            format!("{} periods of {} kicks", self.periods, simulation.clocks().strikes())
        })?;
        if !simulation.energy().is_finite() {
            let remedy = "the energy there is beyond all doubles: choose a smaller displacement";
            return Err(Error::input("displace", &self.displacement, remedy));
        }
        let series = series(&mut simulation, centre, self.periods as usize, (period, self.ends));
        // The symmetric form is at rest at t = 0 on its own orbit; the multipliers are those of the staggered one.
        let form = if displacement.is_some() { Ends::Symmetric } else { self.ends };
        let measured = growth_rate(&mut make()?, centre, DEVIATION, (self.periods, form));
        let irreversibility = irreversibility(&mut make()?, period);
        go_on()?;
        Ok(Run { series, measured, predicted, irreversibility, linear, displacement })
    }
}
