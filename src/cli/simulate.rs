//! `kickdrift simulate`: Algorithm 1 run, and its growth beside the predicted one.

use std::path::PathBuf;

use super::args::{Common, Format};
use super::system::read;
use crate::avi::{Force, Sample, Simulation, growth_rate, irreversibility, series};
use crate::error::{Error, Result};
use crate::number::parse::parse_rational;
use crate::number::rational::to_f64;
use crate::report::figure::png;
use crate::report::file::write_output;
use crate::report::simulate::{self as report, Run};
use crate::scene::SystemScene;
use crate::system::{Limits, decide_system};

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/fpu.json.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Synchronization periods to run.
    #[arg(long, value_name = "N", default_value_t = 200)]
    periods: u32,
    /// The starting displacement of each degree of freedom, as 1/10,0,0; one number moves the first alone.
    #[arg(long, value_name = "X", default_value = "1/10", allow_hyphen_values = true)]
    displace: String,
    /// Also draw energy and amplitude: FILE.svg or FILE.png.
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
}

/// Pixels per inch of PNG figures.
const DPI: f64 = 300.0;

/// The most periods: the series is kept in memory.
const MOST: u32 = 10_000_000;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if self.periods == 0 || self.periods > MOST {
            return Err(Error::input("periods", self.periods, format!("choose 1 to {MOST}")));
        }
        let scene = read(&self.file)?;
        let run = self.simulate(&scene, common)?;
        if let Some(path) = &self.figure {
            let svg = report::figure(&run, scene.title()).svg();
            let drawn = match path.extension().and_then(|e| e.to_str()) {
                Some("svg") => svg.into_bytes(),
                Some("png") => png::raster(&svg, DPI)?,
                _ => {
                    return Err(Error::input(
                        "figure",
                        path.display(),
                        "name a file that ends in .svg or .png",
                    ));
                }
            };
            write_output(Some(path), &drawn)?;
        }
        let document = report::document(&run)
            .input("file", self.file.file_name().unwrap_or_default().to_string_lossy())
            .input("title", scene.title())
            .input("periods", self.periods)
            .input("displace", &self.displace);
        common.write(&document, Format::Text)
    }

    fn simulate(&self, scene: &SystemScene, common: &Common) -> Result<Run> {
        let limits = common.budget.map_or_else(Limits::default, |products| Limits { products });
        let predicted = decide_system(scene.system(), &limits)?.growth_rate();
        let shift = self.shift(scene.system().size())?;
        let rest = vec![0.0; shift.len()];
        // Bonds are simulated about their equilibrium, linear systems about 0.
        if let Some(equilibrium) = scene.equilibrium() {
            let start: Vec<f64> = equilibrium.iter().zip(&shift).map(|(x, d)| x + d).collect();
            let make =
                || Ok(scene.nonlinear_simulation(start.clone(), rest.clone())?.expect("a system with bonds"));
            return self.measured(make, predicted, false);
        }
        self.measured(|| scene.linear_simulation(shift.clone(), rest.clone()), predicted, true)
    }

    fn measured<F: Force<f64>>(
        &self,
        make: impl Fn() -> Result<Simulation<f64, F>>,
        predicted: f64,
        linear: bool,
    ) -> Result<Run> {
        let mut simulation = make()?;
        let period = simulation.clocks().period;
        let series: Vec<Sample> = series(&mut simulation, self.periods as usize, period);
        let measured = if linear { Some(growth_rate(&mut make()?, self.periods)) } else { None };
        let irreversibility = irreversibility(&mut make()?, period);
        Ok(Run { series, measured, predicted, irreversibility })
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
        Ok(shift)
    }
}
