//! Which steps are safe for these periods, bonds or Hessians, for how long, and why.

use plot::Figure;

use super::asking::{Fields, Question, Work, question};
use super::field::flag;
use crate::input::{SystemFile, SystemScene, of_archive};
use crate::report::advise as report;
use crate::report::document::Document;
use molecules::engine::{self, Reading};
use molecules::unit::{self, Dimension, TimeUnit, decimal};
use molecules::{
    self, Advice, Beads, Constraints, DirectFindings, Findings, Levers, MOST_PRODUCTS, Mode, Molecule,
    SOLVED, Scheme, Way,
};
use number::Rational;
use number::error::{Error, Result};
use number::parse::parse_rational;
use number::rational::to_f64;
use systems::Limits;

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
        #[arg(long, value_name = "N", value_parser = flag::<u64>)]
        bonds: Option<u64>,
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

question! {
    /// The input in exact numbers: modes on their clocks or a system, and schemes of steps; lengths of time
    /// in fs.
    struct Advised {
        /// How far every period may be off, relatively.
        band: Rational,
        /// The modes that vibrate.
        modes: Option<Vec<Mode>>,
        /// The steps, from the innermost to the outermost one.
        schemes: Vec<Scheme>,
        /// The length of the run.
        length: Option<Rational>,
        /// The temperature at which bonds of a known shape must stay, in K.
        temperature: Option<Rational>,
        /// The bonds of a known shape in the system.
        bonds: Option<u64>,
        /// The friction of the thermostat, 1/fs.
        friction: Option<Rational>,
        /// Modes that are held, on no clock.
        constrained: Option<Vec<Mode>>,
        /// The name of a system's file.
        file: Option<String>,
        /// The contents of the system's file, in place of modes.
        system: Option<SystemFile>,
        /// Whether what would let the step grow is left out.
        no_levers: bool,
        /// Whether the periods are the shortest of all motions on their clocks.
        all_modes: bool,
        /// Whether the bonds are harmonic.
        harmonic: bool,
        /// Ring polymers in place of atoms.
        beads: Option<Beads>,
        /// Whether all times are plain numbers, and not in fs.
        plain_time: bool,
    }
}

/// The advice.
pub enum Safe {
    /// On periods and bonds.
    Periods(Box<Advice>),
    /// On the Hessians of a system.
    Hessians(Box<(SystemScene, Findings)>),
    /// On forces that are no gradient.
    Direct(Box<(SystemScene, DirectFindings)>),
}

/// The advice, and how the question was read.
pub struct Answer {
    pub asked: Advised,
    pub safe: Safe,
    /// The engine's texts, read.
    reading: Option<Reading>,
    /// For people.
    notes: Vec<String>,
}

/// Kicks a second that advice on periods follows, and products a second of advice on Hessians, as measured.
const KICKS_A_SECOND: f64 = 5e6;
const PRODUCTS_A_SECOND: f64 = 1e10;

/// Levers of a molecule cost about as much as so many schemes.
const LEVERS: usize = 10;

/// Fastest periods of molecules, in fs.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 3.0..=3000.0;

/// Energies beyond 40 kT, of which exp(40) are needed to see one, are not measured.
const SEEN: std::ops::RangeInclusive<f64> = 1.0..=1e17;

impl Question for Advised {
    const NAME: &'static str = "advised";
    type Answer = Safe;

    fn answer(&self, work: &Work) -> Result<Safe> {
        let Some(file) = &self.system else {
            let modes = self.modes.clone().unwrap_or_default();
            let held = self.constrained.clone().unwrap_or_default();
            let question = molecules::Question::new(modes, self.schemes.clone(), self.band.clone())?;
            let question = question.holding(held).within(work.limits()).with_levers(!self.no_levers);
            let question = question.knowing_all_modes(self.all_modes).with_harmonic_bonds(self.harmonic);
            let mut question = question.with_beads(self.beads.clone()).in_units_of(self.unit());
            if self.modes.iter().flatten().any(|mode| mode.shape.is_some()) {
                let (temperature, seen) = self.heat()?;
                question = question.at_temperature(&temperature, &seen)?;
            } else if self.temperature.is_some() || self.bonds.is_some() {
                let remedy = "are about bonds of a known shape, and none is given: write one, as OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008";
                return Err(Error::input("temperature or bonds", "given", remedy));
            }
            if let Some(length) = &self.length {
                question = question.of_length(length.clone())?;
            }
            if let Some(rate) = &self.friction {
                question = question.with_friction(rate.clone())?;
            }
            work.announce("advice on these steps", question.cost() as f64 / KICKS_A_SECOND);
            return Ok(Safe::Periods(Box::new(question.answer()?)));
        };
        let scene = work.read(file)?;
        let (length, friction) = (self.length.as_ref(), self.friction.as_ref());
        let size = scene.model().size();
        if let Some(direct) = scene.direct()?.map(|direct| direct.with_harmonic_bonds(self.harmonic)) {
            let limits = Limits { products: work.budget.unwrap_or(MOST_PRODUCTS), ..Limits::default() };
            let seconds = direct.cost(&self.schemes)? as f64 / PRODUCTS_A_SECOND;
            work.announce(&format!("advice on {size} degrees of freedom"), seconds);
            let found = direct.advise(&self.schemes, &self.band, (length, friction), &limits)?;
            return Ok(Safe::Direct(Box::new((scene, found))));
        }
        // Levers are computed where they are cheap, whatever the budget: the document does not depend on it.
        let others: Vec<_> = self.schemes.iter().take(1).cycle().take(LEVERS).cloned().collect();
        let levers = !self.no_levers && Molecule::allow(size, &others, friction.is_some(), None).is_ok();
        let schemes = [&self.schemes[..], if levers { &others } else { &[] }].concat();
        let cost = Molecule::allow(size, &schemes, friction.is_some(), work.budget)?;
        let seconds = cost as f64 / PRODUCTS_A_SECOND;
        work.announce(&format!("advice on {size} degrees of freedom"), seconds);
        let molecule = scene.molecule()?.0.with_harmonic_bonds(self.harmonic);
        let mut findings = molecule.advise(&self.schemes, &self.band, length, friction)?;
        if levers {
            findings.levers = Some(self.of_hessians(file, &scene, work)?);
        }
        Ok(Safe::Hessians(Box::new((scene, findings))))
    }

    fn show(&self, safe: &Safe) -> Document {
        report::document(safe.view(), None, &[])
    }

    /// With the clocks that modes are on by their places.
    fn document(&self, safe: &Safe) -> Document {
        self.show(safe).inputs(self.placed(safe).input())
    }
}

impl Safe {
    fn view(&self) -> report::View<'_> {
        match self {
            Safe::Periods(advice) => report::View::Periods(advice),
            Safe::Hessians(pair) => report::View::Hessians(&pair.1),
            Safe::Direct(pair) => report::View::Direct(&pair.1),
        }
    }
}

impl Safe {
    /// The levers that would let the step grow, where that was asked.
    pub fn levers(&self) -> Option<&Levers> {
        match self {
            Safe::Periods(advice) => advice.levers.as_ref(),
            Safe::Hessians(pair) => pair.1.levers.as_ref(),
            Safe::Direct(_) => None,
        }
    }
}

impl Advised {
    fn unit(&self) -> TimeUnit {
        if self.plain_time { TimeUnit::Plain } else { TimeUnit::Femtoseconds }
    }

    /// The levers that would let the outer step of a molecule grow.
    fn of_hessians(&self, file: &SystemFile, scene: &SystemScene, work: &Work) -> Result<Levers> {
        let molecule = scene.molecule()?.0.with_harmonic_bonds(self.harmonic);
        let scheme = &self.schemes[0];
        let mut all = Levers::default();
        all.rows.push(molecule.lever("as given".into(), Way::Respa, scheme, &self.band)?);
        let given = |field: &str| !file.source()[field].is_null();
        let masses = molecules::heavy().map(|mass| decimal(&mass));
        let heavy =
            |mass: &String| (format!("hydrogens of {mass} amu"), Way::Hydrogens, Some(mass.clone()), None);
        let held = || Some("h-bonds".to_string());
        let mut ways: Vec<_> = masses.iter().map(heavy).collect();
        ways.push(("h-bonds held".into(), Way::Held, None, held()));
        ways.push((format!("both, {} amu", masses[0]), Way::HeldAndHeavy, Some(masses[0].clone()), held()));
        for (name, way, mass, constraints) in ways {
            if mass.is_some() && given("hydrogen_mass") || constraints.is_some() && given("constraints") {
                all.left_out.push(format!("{name}: the file says it"));
                continue;
            }
            let file = file.with([("hydrogen_mass", mass), ("constraints", constraints)]);
            let lever = work.read(&file).and_then(|other| {
                let moved = other.molecule()?.0.with_harmonic_bonds(self.harmonic);
                moved.lever(name.clone(), way, scheme, &self.band)
            });
            match lever {
                Ok(lever) => all.rows.push(lever),
                Err(error) => all.left_out.push(format!("{name}: {error}")),
            }
        }
        let is_of_two = scheme.steps().len() == 2;
        for (name, way) in SOLVED {
            match molecule.method(name, way, scheme, &self.band) {
                Some(lever) => all.rows.push(lever),
                None if is_of_two => all.left_out.push(format!("{name}: F + S is not proven definite")),
                None => {
                    all.left_out.push(format!("{name}: it is for two clocks, of which the slower one kicks"))
                }
            }
        }
        if is_of_two {
            let why = "MOLLY, equilibrium: Hessians do not say which motions the fast forces leave alone";
            all.left_out.push(why.into());
        }
        all.rows.extend(molecule.ratios(scheme, &self.band)?);
        if let Some(rate) = &self.friction {
            match molecule.masked(scheme, rate)? {
                Some(lever) => all.rows.push(lever),
                None => all.left_out.push("masked by the friction: not even the first step".into()),
            }
        }
        all.compare();
        Ok(all)
    }

    /// The temperature in K, and how many independent energies of bonds are seen: about one a picosecond.
    fn heat(&self) -> Result<(Rational, Rational)> {
        let temperature = self.temperature.clone().unwrap_or_else(|| Rational::from_integer(298.into()));
        let length = self.length.clone().unwrap_or_else(|| Rational::from_integer(100_000_000.into()));
        let bonds = self.bonds.unwrap_or(10_000);
        let seen = Rational::from_integer(bonds.into()) * length / Rational::from_integer(1000.into());
        if !SEEN.contains(&to_f64(&seen)) {
            let remedy = "choose 1 to 1e17 bonds times picoseconds: energies up to 40 kT are measured";
            return Err(Error::input("bonds", bonds, remedy));
        }
        Ok((temperature, seen))
    }

    fn placed(&self, safe: &Safe) -> Advised {
        match safe {
            Safe::Periods(advice) => Advised { modes: Some(advice.modes.clone()), ..self.clone() },
            Safe::Hessians(_) | Safe::Direct(_) => self.clone(),
        }
    }
}

impl Question for Advise {
    const NAME: &'static str = "advise";
    type Answer = Answer;

    fn answer(&self, work: &Work) -> Result<Answer> {
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
            let fastest = pair.1.groups[0].period.0;
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
        Ok(Answer { asked, safe, reading, notes })
    }

    fn show(&self, Answer { safe, reading, notes, .. }: &Answer) -> Document {
        report::document(safe.view(), reading.as_ref(), notes)
    }

    /// Echoes what was read of the words.
    fn document(&self, answer: &Answer) -> Document {
        self.show(answer).inputs(answer.asked.placed(&answer.safe).input())
    }

    fn figure(&self, answer: &Answer, _: &Work) -> Result<Option<Figure>> {
        let none = || {
            let remedy = "there is one step alone, and no multiple of another to draw: `kickdrift system FILE --scan outer=LO..HI:BY` draws the growth";
            Error::input("output", "a figure", remedy)
        };
        report::figure(answer.safe.view(), "Which outer steps are safe").ok_or_else(none).map(Some)
    }
}

impl Advise {
    /// The levers as a picture; `None` where there are none.
    pub fn levers_figure(&self, answer: &Answer) -> Option<Figure> {
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
                    "the text has heavy hydrogens, and periods have no masses: give those of the heavier molecule",
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
fn part(field: &str, text: &str) -> Result<Rational> {
    match text.trim().strip_suffix('%') {
        Some(percent) => Ok(parse_rational(field, percent)? / Rational::from_integer(100.into())),
        None => parse_rational(field, text),
    }
}
