//! `kickdrift simulate`: Algorithm 1 run, and its growth beside the predicted one.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use super::args::{Common, from_str, whole};
use super::system::{draw, limits, read};
use crate::avi::{Ends, Force, Simulation, growth_rate, irreversibility, series};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::Rational;
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
    #[arg(long, value_name = "X", default_value = "1/10", allow_hyphen_values = true, value_parser = from_str::<Displacement>)]
    displace: Displacement,
    /// Algorithm 1 as it stands: whole kicks at the start of a period, none at its end. Without it these kicks are halved,
    /// which makes the run symmetric in time.
    #[arg(long)]
    staggered: bool,
    /// Also draw energy, momentum and amplitude: FILE.svg, FILE.pdf or FILE.png.
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
}

/// The most periods: the series is kept in memory.
const MOST_PERIODS: u32 = 10_000_000;

/// The size of the deviations whose growth is measured: their squares are lost in it, and it is far above roundoff.
const DEVIATION: f64 = 1e-6;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if self.periods == 0 || self.periods > MOST_PERIODS {
            return Err(Error::input("periods", self.periods, format!("choose 1 to {MOST_PERIODS}")));
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
        let predicted = scene.decide(Route::Cheapest, &limits)?.growth_rate();
        let shift = self.shift(scene.system().size())?;
        let rest = vec![0.0; shift.len()];
        // Bonds are simulated about their equilibrium, linear systems about 0.
        if let Some(centre) = scene.equilibrium() {
            let start: Vec<f64> = centre.iter().zip(&shift).map(|(x, d)| x + d).collect();
            let make =
                || Ok(scene.nonlinear_simulation(start.clone(), rest.clone())?.expect("a system with bonds"));
            return self.measured(make, centre, scene.is_linear(), (predicted, &limits));
        }
        let make = || scene.linear_simulation(shift.clone(), rest.clone());
        self.measured(make, &rest, true, (predicted, &limits))
    }

    fn measured<F: Force<f64>>(
        &self,
        make: impl Fn() -> Result<Simulation<f64, F>>,
        centre: &[f64],
        linear: bool,
        (predicted, limits): (f64, &Limits),
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
        let measured = growth_rate(&mut make()?, centre, DEVIATION, (self.periods, ends));
        let irreversibility = irreversibility(&mut make()?, period);
        Ok(Run { series, measured, predicted, irreversibility, linear })
    }

    /// The displacement of every degree of freedom.
    fn shift(&self, size: usize) -> Result<Vec<f64>> {
        let given = &self.displace.0;
        if given.len() != 1 && given.len() != size {
            return Err(Error::input(
                "displace",
                &self.displace,
                format!("give 1 number or {size}, one a degree of freedom"),
            ));
        }
        let mut shift: Vec<f64> = given.iter().map(to_f64).collect();
        shift.resize(size, 0.0);
        if shift.iter().all(|&x| x == 0.0) {
            return Err(Error::input("displace", &self.displace, "nothing would move: displace something"));
        }
        Ok(shift)
    }
}

/// What each degree of freedom is moved by, or the first one alone: numbers with commas between them.
#[derive(Clone, Debug)]
struct Displacement(Vec<Rational>);

impl FromStr for Displacement {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        text.split(',').map(|part| parse_rational("displace", part)).collect::<Result<_>>().map(Displacement)
    }
}

impl fmt::Display for Displacement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.iter().map(Rational::to_string).collect::<Vec<_>>().join(","))
    }
}
