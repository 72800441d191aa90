//! `kickdrift simulate`: Algorithm 1 run, and its growth beside the predicted one.

use std::path::PathBuf;

use super::args::{Common, whole};
use super::system::{draw, limits, read};
use crate::avi::{Ends, Force, Simulation, growth_rate, irreversibility, series};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::parse::parse_rational;
use crate::number::rational::to_f64;
use crate::report::simulate::{self as report, Run};
use crate::scene::SystemScene;
use crate::system::{Limits, Route};

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/fpu.json.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Synchronization periods to run.
    #[arg(long, value_name = "N", default_value_t = 200, allow_negative_numbers = true, value_parser = whole::<u32>)]
    periods: u32,
    /// The starting displacement of each degree of freedom, as 1/10,0,0; one number moves the first alone.
    #[arg(long, value_name = "X", default_value = "1/10", allow_hyphen_values = true)]
    displace: String,
    /// Algorithm 1 as it stands: whole kicks at the start of a period, none at its end. Without it these kicks are halved,
    /// which makes the run symmetric in time.
    #[arg(long)]
    staggered: bool,
    /// Also draw energy, momentum and amplitude: FILE.svg, FILE.pdf or FILE.png.
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
}

/// The most periods: the series is kept in memory.
const MOST: u32 = 10_000_000;

/// The size of the deviations whose growth is measured: their squares are lost in it, and it is far above roundoff.
const SMALL: f64 = 1e-6;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if self.periods == 0 || self.periods > MOST {
            return Err(Error::input("periods", self.periods, format!("choose 1 to {MOST}")));
        }
        self.figure.as_ref().map_or(Ok(()), |path| common.apart_from_output("figure", path))?;
        let scene = read(&self.file)?;
        let run = self.simulate(&scene, common)?;
        if let Some(path) = &self.figure {
            draw("figure", path, &report::figure(&run, scene.title()))?;
        }
        let document = report::document(&run)
            .input("file", self.file.file_name().unwrap_or_default().to_string_lossy())
            .input("title", scene.title())
            .input_json("system", scene.source().clone())
            .input("periods", self.periods)
            .input("displace", &self.displace)
            .input("form", if self.staggered { "staggered" } else { "symmetric" });
        common.write(&document, Format::Text)
    }

    fn simulate(&self, scene: &SystemScene, common: &Common) -> Result<Run> {
        let limits = limits(common);
        let own = scene.own_orbit(&limits)?;
        let predicted = match &own {
            Some(orbit) => orbit.analysis.growth_rate(),
            None => scene.decide(Route::Cheapest, &limits)?.growth_rate(),
        };
        let displacement = own.as_ref().map(|orbit| orbit.displacement);
        let shift = self.shift(scene.system().size())?;
        let rest = vec![0.0; shift.len()];
        // Bonds are simulated about the integrator's own orbit or the equilibrium that is one, linear systems about 0.
        if let Some(centre) = own.as_ref().map(|orbit| orbit.start.as_slice()).or_else(|| scene.equilibrium())
        {
            let start: Vec<f64> = centre.iter().zip(&shift).map(|(x, d)| x + d).collect();
            let make =
                || Ok(scene.nonlinear_simulation(start.clone(), rest.clone())?.expect("a system with bonds"));
            return self.measured(make, centre, scene.is_linear(), (predicted, displacement), &limits);
        }
        let make = || scene.linear_simulation(shift.clone(), rest.clone());
        self.measured(make, &rest, true, (predicted, None), &limits)
    }

    fn measured<F: Force<f64>>(
        &self,
        make: impl Fn() -> Result<Simulation<f64, F>>,
        centre: &[f64],
        linear: bool,
        (predicted, displacement): (f64, Option<f64>),
        limits: &Limits,
    ) -> Result<Run> {
        let ends = if self.staggered { Ends::Staggered } else { Ends::Symmetric };
        let mut simulation = make()?;
        let period = simulation.clocks().period();
        // The series, the measurement of growth, and one period forward and back.
        let runs = 2 * u64::from(self.periods) + 2;
        limits.allow(simulation.cost(period).saturating_mul(runs), || {
            format!("{} periods of {} kicks", self.periods, simulation.clocks().strikes())
        })?;
        if !simulation.energy().is_finite() {
            let remedy = "the energy there is beyond all doubles: choose a smaller displacement";
            return Err(Error::input("displace", &self.displace, remedy));
        }
        let series = series(&mut simulation, centre, self.periods as usize, (period, ends));
        // The symmetric form is at rest at t = 0 on its own orbit; the multipliers are those of the staggered one.
        let form = if displacement.is_some() { Ends::Symmetric } else { ends };
        let measured = growth_rate(&mut make()?, centre, SMALL, (self.periods, form));
        let irreversibility = irreversibility(&mut make()?, period);
        Ok(Run { series, measured, predicted, irreversibility, linear, displacement })
    }

    /// The displacement of every degree of freedom.
    fn shift(&self, size: usize) -> Result<Vec<f64>> {
        let parts: Vec<&str> = self.displace.split(',').collect();
        if parts.len() != 1 && parts.len() != size {
            return Err(Error::input(
                "displace",
                &self.displace,
                format!("give 1 number or {size}, one a degree of freedom"),
            ));
        }
        let mut shift = vec![0.0; size];
        for (x, part) in shift.iter_mut().zip(parts) {
            *x = to_f64(&parse_rational("displace", part)?);
        }
        if shift.iter().all(|&x| x == 0.0) {
            return Err(Error::input("displace", &self.displace, "nothing would move: displace something"));
        }
        Ok(shift)
    }
}
