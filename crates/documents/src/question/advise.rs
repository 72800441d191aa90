//! Which steps are safe for these periods, bonds or Hessians, for how long, and why.

use plot::Figure;

use super::advised::{Advised, Safe};
use super::asking::{Fields, Question, Work, question};
use crate::input::{SystemFile, of_archive};
use crate::report::advise as report;
use crate::report::document::Document;
use crate::report::shape::{Keys, Schema};
use molecules::engine::{self, Reading};
use molecules::unit::{self, Dimension, TimeUnit, decimal};
use molecules::{self, Constraints, Mode, Scheme};
use number::parse::parse_rational;
use number::{Error, Rational, Result};

question! {
    /// Which steps are safe, in the words of those who ask.
    args struct Advise {
        /// A period or wavenumber of a force, as OH=10fs, 3700/cm, slow=water or fast=protein,h-bonds; the
        /// last ones are on the slower clocks
        ///
        /// Where no time has a unit all are plain numbers, as --period bond=0.2 --steps 0.005,0.02 in
        /// Lennard-Jones units.
        #[arg(long, value_name = "[NAME=]T")]
        period: Vec<String>,
        /// A bond: k of E = k x^2/2 or K of E = K x^2, two masses in amu, the heavy atom's hydrogens if not 1
        ///
        /// In place of k=X also its shape, morse:D=X,a=Y or poly:k2=X,k3=Y,k4=Z, as aperture reads it.
        #[arg(long, value_name = "NAME:k=X,M1,M2[,N]")]
        bond: Vec<String>,
        /// The clocks of modes, 1 the fastest, as OH=1,bend=2.
        #[arg(long, value_name = "NAME=CLOCK,...", value_delimiter = ',')]
        on: Vec<String>,
        /// The steps from the innermost to the outermost one; again for another scheme.
        #[arg(long, value_name = "0.5fs,4fs")]
        steps: Vec<String>,
        /// The contents of an engine's files.
        #[arg(skip)]
        engine: Vec<String>,
        /// How far every period may be off.
        #[arg(long, value_name = "PART")]
        band: String = "5%",
        /// The length of the run, as 10ns.
        #[arg(long, value_name = "TIME")]
        length: Option<String>,
        /// The temperature at which bonds of a known shape must stay [default: 298K]
        #[arg(long, value_name = "T")]
        temperature: Option<String>,
        /// The bonds of a known shape, in a run of this length or of 100 ns [default: 10000]
        bonds as "N": Option<u64>,
        /// The friction of the thermostat, as 1/ps: does it mask what grows?
        #[arg(long, value_name = "RATE")]
        friction: Option<String>,
        /// Bonds that do not vibrate: h-bonds, all-bonds, or modes, as OH,NH [default: as the engine's text
        /// says]
        ///
        /// For Hessians h-bonds only, with the force of each potential in the file.
        #[arg(long, value_name = "WHICH")]
        constraints: Option<String>,
        /// Hydrogens of this mass in amu, taken from their heavy atoms.
        #[arg(long, value_name = "MASS")]
        hmr: Option<String>,
        /// Leaves out what would let the step grow.
        #[arg(long)]
        no_levers: bool,
        /// The periods given are the shortest of all motions on their clocks: no faster one is left unknown.
        #[arg(long)]
        all_modes: bool,
        /// The bonds are harmonic: a clock's own step may be longer than T/6.28.
        #[arg(long)]
        harmonic: bool,
        /// The file of Hessians in place of periods: one of a system, or FILE.npz.
        #[arg(skip)]
        file: Option<String>,
        /// The contents of a system's file.
        #[arg(skip)]
        system: Option<SystemFile>,
    }
}

/// The advice, and how the question was read.
pub struct AdviceRead {
    pub asked: Advised,
    pub safe: Safe,
    /// The engine's texts, read.
    reading: Option<Reading>,
    /// For people.
    notes: Vec<String>,
}

/// Fastest periods of molecules, in fs.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 3.0..=3000.0;

impl Question for Advise {
    const NAME: &'static str = "advise";
    const EXAMPLES: &'static [&'static str] = &[
        "advise --period OH=10fs --period slow=40fs --steps 0.5fs,4fs --steps 0.5fs,5fs",
        "advise --bond CH:K=340kcal/mol/A^2,12.011,1.008,3 --period 60fs --hmr 3.024 --steps 1fs,6fs --length 10ns",
        "advise data/scenes/flexible-water.json --steps 0.5fs,4.5fs",
    ];
    const USAGE: Option<&'static str> =
        Some("(FILE | --period <NAME=T>... | --bond <NAME:K=..>... | --engine <FILE>) [--steps <A,B>]...");
    type Answer = AdviceRead;

    /// On periods, on the Hessians of a system, or on its forces that are no gradient.
    fn schemas() -> Vec<(&'static str, Schema, Keys)> {
        let periods = Advised::keys().without(&["file", "system"]).requiring(&["modes", "schemes"]);
        let system = Advised::keys()
            .without(&["modes", "constrained", "all_modes", "plain_time"])
            .requiring(&["schemes", "file", "system"]);
        let input = |name| if name == "advise" { periods.clone() } else { system.clone() };
        report::schemas().map(|(name, schema)| (name, schema, input(name))).to_vec()
    }

    fn answer(&self, work: &Work) -> Result<AdviceRead> {
        let mut reading = self.reading()?;
        let archive = self.file.as_ref().filter(|file| self.system.is_none() && file.ends_with(".npz"));
        let system = match archive {
            Some(name) => Some(self.archive(name, reading.as_ref())?),
            None => self.system.clone(),
        };
        let asked = match &system {
            Some(file) => self.of_system(file, reading.as_ref(), work)?,
            None => self.of_periods(reading.as_ref())?,
        };
        if let Some(reading) = &mut reading {
            reading.remarks.extend(self.left_open(reading));
        }
        let safe = asked.answer(work)?;
        let mut notes = Vec::new();
        if let (Safe::Hessians(pair), Some(_)) = (&safe, archive) {
            let fastest = pair.1.fastest.period.0;
            if !PLAUSIBLE.contains(&fastest) {
                let given = format!("a fastest period of {fastest:.1e} fs");
                let remedy = "an archive is read as mass-weighted, in 1/ps^2: write a system file that says what it is";
                return Err(Error::input("fast", given, remedy));
            }
            notes.push("fast and slow as mass-weighted, in 1/ps^2, known to 1e-6 of their norms".into());
        }
        if let Some(mass) = self.hmr.as_ref().filter(|_| system.is_some()) {
            notes.push(format!("hydrogens of {mass}, their nearest heavy atoms lighter"));
        }
        Ok(AdviceRead { asked, safe, reading, notes })
    }

    fn show(&self, AdviceRead { safe, reading, notes, .. }: &AdviceRead) -> Document {
        report::document(safe.view(), reading.as_ref(), notes)
    }

    /// Echoes what was read of the words.
    fn document(&self, answer: &AdviceRead) -> Document {
        self.show(answer).inputs(answer.asked.placed(&answer.safe).input())
    }

    fn figure(&self, answer: &AdviceRead, _: &Work) -> Result<Option<Figure>> {
        let none = || {
            let remedy = "there is one step alone, and no multiple of another to draw: `kickdrift system FILE --scan outer=LO..HI:BY` draws the growth";
            Error::input("output", "a figure", remedy)
        };
        report::figure(answer.safe.view(), "Which outer steps are safe").ok_or_else(none).map(Some)
    }
}

impl Advise {
    /// The levers as a picture; `None` where there are none.
    pub fn levers_figure(&self, answer: &AdviceRead) -> Option<Figure> {
        let levers = answer.safe.levers().filter(|lever| !lever.rows.is_empty())?;
        Some(report::levers_figure(levers, "What would let the outer step grow", answer.asked.unit()))
    }

    /// Reads the engine's texts.
    fn reading(&self) -> Result<Option<Reading>> {
        if self.engine.is_empty() {
            return Ok(None);
        }
        let outer = self.steps.first().map(|steps| scheme(steps, TimeUnit::Femtoseconds)).transpose()?;
        let texts: Vec<&str> = self.engine.iter().map(String::as_str).collect();
        engine::read(&texts, outer.as_ref().map(Scheme::outer)).map(Some)
    }

    /// The unit of all times: an engine's, else none where no period and no step has one.
    fn unit(&self, reading: Option<&Reading>) -> TimeUnit {
        if let Some(reading) = reading {
            return reading.unit;
        }
        let values =
            self.period.iter().map(|text| text.split_once('=').map_or(text.as_str(), |(_, value)| value));
        let steps = self.steps.iter().flat_map(|steps| steps.split(','));
        let is_asked = !self.period.is_empty()
            && !self.steps.is_empty()
            && self.bond.is_empty()
            && self.system.is_none();
        if is_asked && values.chain(steps).all(unit::is_plain) {
            TimeUnit::Plain
        } else {
            TimeUnit::Femtoseconds
        }
    }

    /// The schemes that are given; beside an engine's a step alone is the outer one that its text lacks.
    fn given(&self, reading: Option<&Reading>) -> Result<Vec<Scheme>> {
        let unit = self.unit(reading);
        let given = self.steps.iter().map(|steps| scheme(steps, unit)).collect::<Result<Vec<_>>>()?;
        Ok(given.into_iter().filter(|scheme| reading.is_none() || scheme.steps().len() > 1).collect())
    }

    fn hydrogen(&self) -> Result<Option<Rational>> {
        self.hmr.as_deref().map(heavy_hydrogen).transpose()
    }

    /// The question about these schemes, still of nothing.
    fn of_schemes(&self, asked: Vec<Scheme>, reading: Option<&Reading>) -> Result<Advised> {
        // Steps that are given twice, or that the file has already, are answered once.
        let mut schemes: Vec<Scheme> = Vec::new();
        asked.into_iter().for_each(|scheme| {
            if !schemes.contains(&scheme) {
                schemes.push(scheme);
            }
        });
        let unit = self.unit(reading);
        let rational = |field: &str, text: &Option<String>, dimension| {
            text.as_deref().map(|text| measured(field, text, dimension, unit)).transpose()
        };
        Ok(Advised {
            band: part("band", &self.band)?,
            modes: None,
            schemes,
            length: rational("length", &self.length, Dimension::Time)?,
            temperature: self
                .temperature
                .as_deref()
                .map(|text| unit::rational("temperature", text, Dimension::Temperature))
                .transpose()?,
            bonds: self.bonds,
            friction: rational("friction", &self.friction, Dimension::Rate)?,
            constrained: None,
            file: None,
            system: None,
            no_levers: self.no_levers,
            all_modes: self.all_modes,
            harmonic: self.harmonic,
            beads: reading.and_then(|reading| reading.beads.clone()).filter(|beads| beads.count > 1),
            plain_time: unit == TimeUnit::Plain,
        })
    }

    /// What the engine's text says of bonds and masses, and cannot be applied to what was asked.
    fn left_open(&self, reading: &Reading) -> Vec<String> {
        let mut open: Vec<String> = Vec::new();
        let mut say = |why: &str| open.push(why.into());
        let of_hessians = self.file.is_some();
        if reading.constraints.is_some() && self.constraints.is_none() {
            if of_hessians {
                say(
                    "the text holds bonds, the Hessians given do not: add --constraints h-bonds if these are they",
                );
            } else if self.bond.is_empty() {
                say(
                    "the text holds bonds, and periods do not say which of them are bonds: leave those out, or name them, as --constraints OH",
                );
            }
        }
        if reading.hydrogen.is_some() && self.hmr.is_none() {
            if of_hessians {
                say("the text has heavy hydrogens, which the Hessians given do not: add --hmr");
            } else if self.bond.is_empty() {
                say(
                    "the text has heavy hydrogens, and periods have no masses: give the periods of the heavier molecule",
                );
            }
        }
        open
    }

    fn of_periods(&self, reading: Option<&Reading>) -> Result<Advised> {
        let asked = self.hydrogen()?;
        if asked.is_some() && self.bond.is_empty() {
            return Err(Error::input(
                "hmr",
                "given without a bond",
                "a period has no masses: give the bond, as CH:K=340kcal/mol/A^2,12.011,1.008",
            ));
        }
        let hydrogen = asked.or_else(|| reading.and_then(|reading| reading.hydrogen.clone()));
        let bonds = self.bond.iter().map(|text| Mode::from_bond(text, hydrogen.as_ref()));
        let unit = self.unit(reading);
        if unit == TimeUnit::Plain && !self.bond.is_empty() {
            let remedy =
                "has units, and the times have none: give its period as a plain number, as --period bond=0.2";
            return Err(Error::input("bond", self.bond.join(" "), remedy));
        }
        let period = |text: &String| match unit {
            TimeUnit::Femtoseconds => Mode::from_period(text),
            TimeUnit::Plain => Mode::from_plain_period(text),
        };
        let mut modes = bonds.chain(self.period.iter().map(period)).collect::<Result<Vec<_>>>()?;
        self.on.iter().try_for_each(|entry| place(&mut modes, entry))?;
        // The engine's own scheme first.
        let scheme = reading.map(|reading| reading.scheme.clone());
        let schemes: Vec<Scheme> = scheme.into_iter().chain(self.given(reading)?).collect();
        // Each on its clock before any is held: what is left of a slow clock stays there.
        schemes.first().into_iter().for_each(|first| molecules::place(&mut modes, first.steps().len()));
        let constraints = self.constraints.as_deref().map(Constraints::parse);
        let (modes, held) =
            match constraints.or_else(|| reading.and_then(|reading| reading.constraints.clone())) {
                Some(constraints) => constraints.split(modes)?,
                None => (modes, Vec::new()),
            };
        let constrained = (!held.is_empty()).then_some(held);
        Ok(Advised { modes: Some(modes), constrained, ..self.of_schemes(schemes, reading)? })
    }

    /// Of the system's own steps first, or the engine's; with the hydrogens and the constraints asked for.
    fn of_system(&self, file: &SystemFile, reading: Option<&Reading>, work: &Work) -> Result<Advised> {
        if self.all_modes {
            let remedy = "is about periods; Hessians have all their modes: leave it out";
            return Err(Error::input("all_modes", "true", remedy));
        }
        let mass = self.hydrogen()?.map(|mass| decimal(&mass));
        let held = self.constraints.as_deref().map(|which| which.trim().to_string());
        let file = file.with([("hydrogen_mass", mass), ("constraints", held)]);
        let scheme = match reading {
            Some(reading) => reading.scheme.clone(),
            None => work.read(&file)?.scheme()?,
        };
        let asked = self.of_schemes([scheme].into_iter().chain(self.given(reading)?).collect(), reading)?;
        Ok(Advised { file: self.file.clone(), system: Some(file), ..asked })
    }

    /// The arrays of an archive, with the steps given.
    fn archive(&self, name: &str, reading: Option<&Reading>) -> Result<SystemFile> {
        let own = reading.map(|reading| reading.scheme.clone());
        let scheme = own.or(self.given(reading)?.into_iter().next());
        let needed = || Error::missing("steps", "give the inner and the outer step, as 0.5fs,4fs");
        let scheme = scheme.ok_or_else(needed)?;
        let [inner, outer] = scheme.steps() else { return Err(needed()) };
        Ok(of_archive(name, [inner, outer]).into())
    }
}

fn heavy_hydrogen(text: &str) -> Result<Rational> {
    let with_unit = unit::dimension(text).map_or_else(|| format!("{text}amu"), |_| text.into());
    unit::rational("hmr", &with_unit, Dimension::Mass)
}

/// `OH=2`: the mode OH on the second clock.
fn place(modes: &mut [Mode], entry: &str) -> Result<()> {
    let form = || Error::input("on", entry, "write NAME=CLOCK, as OH=1; 1 is the fastest clock");
    let (name, clock) = entry.rsplit_once('=').ok_or_else(form)?;
    let clock = clock.trim().parse::<usize>().ok().and_then(|clock| clock.checked_sub(1)).ok_or_else(form)?;
    let names: Vec<String> = modes.iter().map(|mode| mode.name.clone()).collect();
    let found = modes.iter_mut().find(|mode| mode.name == name.trim());
    let mode = found.ok_or_else(|| {
        Error::input("on", entry, format!("there is no mode of this name, but {}", names.join(", ")))
    })?;
    mode.clock = Some(clock);
    Ok(())
}

fn scheme(text: &str, unit: TimeUnit) -> Result<Scheme> {
    Scheme::new(
        text.split(',').map(|step| measured("steps", step, Dimension::Time, unit)).collect::<Result<_>>()?,
    )
}

/// A time or a rate with its unit, or a plain number where times have none.
fn measured(field: &str, text: &str, dimension: Dimension, unit: TimeUnit) -> Result<Rational> {
    if unit == TimeUnit::Femtoseconds {
        return unit::rational(field, text, dimension);
    }
    let without_pi = || Error::input(field, text.trim(), "must be rational; write it without pi");
    unit::plain(field, text)?.as_rational().ok_or_else(without_pi)
}

/// `5%` or `1/20`.
pub(super) fn part(field: &str, text: &str) -> Result<Rational> {
    match text.trim().strip_suffix('%') {
        Some(percent) => Ok(parse_rational(field, percent)? / Rational::from_integer(100.into())),
        None => parse_rational(field, text),
    }
}
