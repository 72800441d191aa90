//! Algorithm 1 run on a system: energy, momentum and amplitude, and growth beside the prediction.

use plot::{Figure, Foot};

use super::asking::{Question, Work, question};
use super::field::notation;
use crate::input::{SystemFile, SystemScene};
use crate::report::document::Document;
use crate::report::shape::{Schema, Shape, TEXT};
use crate::report::simulate as report;
use number::error::Kind;
use number::parallel::go_on;
use number::parse::parse_rational;
use number::{Error, Result, to_f64};
use systems::avi::{Ends, Force, Run, Simulation, growth_rate, irreversibility, series};
use systems::{Limits, Route, middle};

question! {
    /// A run from rest at a displacement: the bonds themselves about the integrator's own orbit, or the
    /// equilibrium where that is one, linear systems about 0.
    args struct Simulate {
        /// The name of the system's file.
        #[arg(skip)]
        file: String,
        /// Its title, which documents take from the system.
        #[arg(skip)]
        title: Option<String>,
        /// The contents of the file.
        #[arg(skip)]
        system: SystemFile,
        /// Synchronization periods to run.
        periods as "N": u32 = "200",
        /// The starting displacement of each degree of freedom, as 1/10,0,0; one number moves the first
        /// alone.
        displace as "X": Displacement = "1/10",
        /// Algorithm 1 as printed: whole kicks at the start of a period, none at its end [default: half a
        /// kick at both]
        #[arg(long = "staggered", action = clap::ArgAction::SetTrue, value_parser = staggered)]
        form: Ends = "symmetric",
    }
}

/// The starting displacement of each degree of freedom; one number alone moves the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacement {
    text: String,
    values: Vec<f64>,
}

impl Displacement {
    fn parsed(field: &str, text: &str) -> Result<Self> {
        let read = |part: &str| Ok(to_f64(&parse_rational(field, part)?));
        let values = text.split(',').map(read).collect::<Result<Vec<_>>>()?;
        if values.iter().all(|&x| x == 0.0) {
            return Err(Error::input(field, text, "nothing would move: displace something"));
        }
        Ok(Displacement { text: text.into(), values })
    }

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

fn ends(field: &str, text: &str) -> Result<Ends> {
    Ends::named(text).ok_or_else(|| Error::input(field, text, "is symmetric or staggered"))
}

/// The value of a flag that is given or not.
fn staggered(text: &str) -> Result<Ends> {
    if text == "true" { Ok(Ends::Staggered) } else { ends("form", text) }
}

notation! {
    Displacement: Displacement::parsed, |displacement: &Displacement| displacement.text.clone(), TEXT;
    Ends: ends, |ends: &Ends| ends.name(), Shape::OneOf(&["symmetric", "staggered"]);
}

/// The most periods: the series is kept in memory, and is written as some 50 MB.
const MOST_PERIODS: u32 = 1_000_000;

/// The size of the deviations whose growth is measured: their squares are lost in it, and it is far above
/// roundoff.
const DEVIATION: f64 = 1e-6;

/// A run and the system that was run.
pub struct Simulated {
    pub scene: SystemScene,
    pub run: Run,
}

impl Question for Simulate {
    const NAME: &'static str = "simulate";
    const EXAMPLES: &'static [&'static str] =
        &["simulate data/scenes/fpu.json --periods 30 --figure run.pdf"];
    type Answer = Simulated;

    fn schema() -> Option<Schema> {
        // Documents have the title of the system.
        let rules = r#"{"allOf": [{"properties": {"input": {"required": ["title"]}}}]}"#;
        Some(Schema::new("A run of Algorithm 1", report::keys()).rules(rules))
    }

    fn answer(&self, work: &Work) -> Result<Simulated> {
        let scene = work.read(&self.system)?;
        let run = self.run(&scene, &work.products())?;
        Ok(Simulated { scene, run })
    }

    fn show(&self, answer: &Simulated) -> Document {
        report::document(&answer.run)
    }

    /// With the system's own title.
    fn document(&self, answer: &Simulated) -> Document {
        let title = Some(answer.scene.title().into());
        self.show(answer).inputs(super::Fields::input(&Simulate { title, ..self.clone() }))
    }

    fn figure(&self, Simulated { scene, run }: &Simulated, _: &Work) -> Result<Option<Figure>> {
        let foot = Foot::default().words(scene.title()).value("periods", self.periods);
        let foot = foot.value("displacement", &self.displace.text).words(self.form.name());
        let figure = report::figure(run, scene.title()).footed(&foot);
        Ok(Some(figure.in_units_of(scene.time_unit().unwrap_or("time"))))
    }
}

impl Simulate {
    /// The run, and the growth that the multipliers predict.
    fn run(&self, scene: &SystemScene, limits: &Limits) -> Result<Run> {
        if self.periods == 0 || self.periods > MOST_PERIODS {
            return Err(Error::input("periods", self.periods, format!("choose 1 to {MOST_PERIODS}")));
        }
        // Without an orbit to be found: about the equilibrium.
        let own_orbit = scene.own_orbit(limits).or_else(|error| match error.kind() {
            Kind::Input => Ok(None),
            _ => Err(error),
        })?;
        let predicted = match &own_orbit {
            Some(orbit) => orbit.analysis.growth_rate(),
            None => scene.model().decide(Route::Cheapest, limits)?.growth_rate(),
        };
        let predicted = predicted.map_or(f64::NAN, middle);
        let shift = self.displace.of(scene.model().size())?;
        let rest = vec![0.0; shift.len()];
        let Some(centre) =
            own_orbit.as_ref().map(|orbit| orbit.start.as_slice()).or_else(|| scene.equilibrium())
        else {
            let make = || scene.linear_simulation(shift.clone(), rest.clone());
            return self.measure(make, &rest, (predicted, None, true), limits);
        };
        let start: Vec<f64> = centre.iter().zip(&shift).map(|(x, d)| x + d).collect();
        let make =
            || Ok(scene.nonlinear_simulation(start.clone(), rest.clone())?.expect("a system with bonds"));
        let displacement = own_orbit.as_ref().map(|orbit| orbit.displacement);
        self.measure(make, centre, (predicted, displacement, scene.is_linear()), limits)
    }

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
        let work = || format!("{} periods of {} kicks", self.periods, simulation.clocks().strikes());
        let allowed = limits.allow(simulation.cost(period).saturating_mul(runs), work);
        allowed.map_err(|error| error.or("choose fewer periods"))?;
        if !simulation.energy().is_finite() {
            let remedy = "the energy there is beyond all doubles: choose a smaller displacement";
            return Err(Error::input("displace", &self.displace.text, remedy));
        }
        let series = series(&mut simulation, centre, self.periods as usize, (period, self.form));
        // The symmetric form is at rest at t = 0 on its own orbit; the multipliers are those of the staggered
        // one.
        let form = if displacement.is_some() { Ends::Symmetric } else { self.form };
        let measured = growth_rate(&mut make()?, centre, DEVIATION, (self.periods, form));
        let irreversibility = irreversibility(&mut make()?, period);
        go_on()?;
        Ok(Run { series, measured, predicted, irreversibility, linear, displacement })
    }
}
