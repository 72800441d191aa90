//! How hot a bond may be before the method throws it out, at given steps.

use num_traits::ToPrimitive;
use plot::Figure;

use super::advise::part;
use super::asking::{Question, Work, question};
use super::field::notation;
use crate::report::aperture as report;
use crate::report::document::Document;
use crate::report::shape::Schema;
use molecules::aperture::{Bond, Measured, Measurement, Step, band_of, energies_seen, hottest, hottest_of};
use molecules::check_band;
use molecules::unit::{self, Dimension};
use number::parallel::try_map;
use number::{Error, Rational, Result, to_f64};
use words::Word;

/// A quantity as it is written, and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity<const KIND: char> {
    text: String,
    pub value: Rational,
}

/// A length of time, in fs.
pub type Time = Quantity<'t'>;
/// A temperature, in K.
pub type Temperature = Quantity<'K'>;

/// Times as they are written, and their values in fs.
#[derive(Clone, Debug, PartialEq)]
pub struct Times {
    text: String,
    pub values: Vec<Rational>,
}

impl<const KIND: char> Quantity<KIND> {
    fn read(field: &str, text: &str) -> Result<Self> {
        let dimension = if KIND == 't' { Dimension::Time } else { Dimension::Temperature };
        Ok(Quantity { text: text.trim().into(), value: unit::rational(field, text, dimension)? })
    }
}

impl Times {
    fn list(field: &str, text: &str) -> Result<Self> {
        let time = |part: &str| unit::rational(field, part, Dimension::Time);
        Ok(Times { text: text.trim().into(), values: text.split(',').map(time).collect::<Result<_>>()? })
    }
}

/// A closed range of times as it is written, and its ends in fs.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeRange {
    text: String,
    pub ends: [Rational; 2],
}

impl TimeRange {
    fn read(field: &str, text: &str) -> Result<Self> {
        let form = || Error::input(field, text.trim(), "write a range of steps, as 1.2fs..2.6fs");
        let (lo, hi) = text.split_once("..").ok_or_else(form)?;
        let ends = [unit::rational(field, lo, Dimension::Time)?, unit::rational(field, hi, Dimension::Time)?];
        if ends[0] > ends[1] {
            return Err(Error::input(field, text.trim(), "ends before it begins: exchange both"));
        }
        Ok(TimeRange { text: text.trim().into(), ends })
    }
}

notation! {
    Bond: |_: &str, text: &str| Bond::read(text), ToString::to_string;
    Time: Time::read, |time: &Time| time.text.clone();
    Temperature: Temperature::read, |temperature: &Temperature| temperature.text.clone();
    Times: Times::list, |times: &Times| times.text.clone();
    TimeRange: TimeRange::read, |range: &TimeRange| range.text.clone();
}

question! {
    /// The least energy, in kT, at which a bond is lost: a measurement in doubles, no proof.
    args struct Aperture {
        /// The bond, as OH:K=553kcal/mol/A^2,15.999,1.008; in place of K=X also k=X, morse:D=X,a=Y, or
        /// poly:k2=X,k3=Y,k4=Z
        ///
        /// K of E = K x^2, k of E = k x^2/2, D and a of E = D (1 - exp(-a x))^2, k2, k3 and k4 of E = k2
        /// x^2 + k3 x^3 + k4 x^4.
        ///
        /// Masses in amu.
        bond as "NAME:SHAPE,M1,M2": Bond,
        /// The temperature.
        temperature as "T": Temperature = "298K",
        /// Steps, as 1.4fs or 1fs,2fs.
        steps as "TIME,...": Option<Times>,
        /// A closed range of steps, as 1.2fs..2.6fs.
        h_range as "LO..HI": Option<TimeRange>,
        /// From one step of the range to the next [default: 0.01fs]
        #[arg(requires = "h_range")]
        step as "TIME": Option<Time>,
        /// Another integrator than velocity Verlet: one of the catalogue, which word --list shows.
        #[arg(long, value_name = "NAME", conflicts_with_all = ["word", "substeps"])]
        method: Option<String>,
        /// Another integrator, as a word of kicks K, K1 (the bond), K2 (the slow force), drifts D, and O
        /// where a thermostat acts.
        #[arg(conflicts_with = "substeps")]
        word as "WORD": Option<Word>,
        /// r-RESPA: so many inner steps of the bond in each step of the slow force.
        #[arg(requires = "slow")]
        substeps as "N": Option<u64>,
        /// A slow harmonic force about the bond's rest: the period that it would give the bond alone, as
        /// 40fs.
        slow as "TIME": Option<Time>,
        /// Also the least E* of bonds whose periods are longer by up to this, as 5%: of steps h/(1 + band) to
        /// h.
        #[arg(long, value_name = "PART")]
        band: Option<String>,
        /// The bonds of the system that is meant.
        bonds as "N": u64 = "10000",
        /// The length of the run that is meant.
        length as "TIME": Time = "100ns",
    }
}

/// The most kicks of one bond unless a budget says otherwise: some minutes of one core.
const MOST_KICKS: u64 = 200_000_000_000;

/// Kicks a second and core, as measured of a Morse bond.
const KICKS_A_SECOND: f64 = 4e8;

/// The most inner steps.
const MOST_SUBSTEPS: u64 = 1000;

impl Aperture {
    /// The integrator.
    ///
    /// # Errors
    /// A name that is none, no inner steps or too many, two integrators.
    pub fn integrator(&self) -> Result<Word> {
        match (&self.method, &self.word, self.substeps) {
            (None, None, None) => Ok(words::method("velocity-verlet")?.word()),
            (Some(name), None, None) => Ok(words::method(name)?.word()),
            (None, Some(word), None) => Ok(word.clone()),
            (None, None, Some(n)) if (1..=MOST_SUBSTEPS).contains(&n) => {
                format!("K2(1/2) {n}*(K1(1/{}) D(1/{n}) K1(1/{})) K2(1/2)", 2 * n, 2 * n).parse()
            }
            (None, None, Some(n)) => Err(Error::input("substeps", n, format!("choose 1 to {MOST_SUBSTEPS}"))),
            _ => {
                let remedy = "choose one of a method, a word and substeps";
                Err(Error::input("method", "given beside another integrator", remedy))
            }
        }
    }

    /// The measurement, before any step.
    ///
    /// # Errors
    /// As [`Aperture::integrator`] and [`Measurement::new`].
    pub fn measurement(&self) -> Result<Measurement> {
        let slow = self.slow.as_ref().map(|slow| &slow.value);
        if self.substeps.is_some() && slow.is_none() {
            return Err(Error::missing("slow", "inner steps need a slow force beside them, as 40fs"));
        }
        Measurement::new(&self.bond, &self.temperature.value, &self.integrator()?, slow)
    }

    /// The steps asked for, in fs, in order, each once.
    ///
    /// # Errors
    /// Neither steps nor a range; a range of too many.
    fn all_steps(&self) -> Result<Vec<Rational>> {
        let mut all = self.steps.as_ref().map_or_else(Vec::new, |steps| steps.values.clone());
        if let Some(TimeRange { ends: [lo, hi], .. }) = &self.h_range {
            let by =
                self.step.as_ref().map_or_else(|| Rational::new(1.into(), 100.into()), |by| by.value.clone());
            let count = ((hi - lo) / &by).floor().to_integer().to_u64().unwrap_or(u64::MAX);
            if count >= MOST_STEPS {
                let remedy = format!("choose a longer one, for {MOST_STEPS} steps of the range at most");
                return Err(Error::input("step", unit::decimal(&by), remedy));
            }
            all.extend((0..=count).map(|n| lo + &by * Rational::from_integer(n.into())));
        }
        if all.is_empty() {
            return Err(Error::missing("steps", "give steps, as 1.4fs, or a range, as h-range 1.2fs..2.6fs"));
        }
        all.sort();
        all.dedup();
        Ok(all)
    }
}

/// A figure needs no more steps, and a text names them all.
const MOST_STEPS: u64 = 100_000;

impl Question for Aperture {
    const NAME: &'static str = "aperture";
    const USAGE: Option<&'static str> =
        Some("--bond <NAME:SHAPE,M1,M2> [--temperature <T>] (--steps <TIME,...> | --h-range <LO..HI>)");
    const EXAMPLES: &'static [&'static str] = &[
        "aperture --bond OH:morse:D=116kcal/mol,a=2.287/A,15.999,1.008 --steps 1.4fs,1.95fs",
        "aperture --bond OH:morse:D=116kcal/mol,a=2.287/A,16,1 --h-range 1.6fs..2.4fs --step 0.05fs --steps 2fs --output oh.png",
        "aperture --bond OH:morse:D=116kcal/mol,a=2.287/A,15.999,1.008 --substeps 4 --slow 40fs --steps 8fs",
    ];
    type Answer = Measured;

    fn schema() -> Option<Schema> {
        let title = "How hot a bond may be at each step before the method throws it out: a measurement in doubles, no proof";
        Some(Schema::new(title, report::keys()))
    }

    fn answer(&self, work: &Work) -> Result<Measured> {
        let (measurement, all) = (self.measurement()?, self.all_steps()?);
        let band = self.band.as_ref().map(|text| part("band", text)).transpose()?;
        band.as_ref().map_or(Ok(()), check_band)?;
        let bands: Vec<Vec<Rational>> = all
            .iter()
            .map(|step| band.as_ref().map_or_else(Vec::new, |band| band_of(&measurement, step, band)))
            .collect();
        let level = hottest_of(&energies_seen(self.bonds, &self.length.value)?);
        let count = all.len() + bands.iter().map(Vec::len).sum::<usize>();
        let cost = measurement.cost().saturating_mul(count as u64);
        let most = work.budget.unwrap_or(MOST_KICKS);
        if cost > most {
            let words = format!("{count} steps of this method may take {cost} kicks");
            return Err(Error::budget(words, cost).or("ask about fewer steps"));
        }
        work.announce("the aperture", cost as f64 / KICKS_A_SECOND);
        let bar = work.count(all.len() as u64, "steps");
        let asked: Vec<(&Rational, &Vec<Rational>)> = all.iter().zip(&bands).collect();
        let steps = try_map(&asked, |(step, band)| {
            let found = Step { band: hottest(&measurement, band)?, ..measurement.at(step)? };
            bar.advance(1);
            Ok(found)
        })?;
        let last = to_f64(all.last().expect("there are steps"));
        // Velocity Verlet's third of a turn lies below its limit, beyond it no resonance.
        let most = measurement.limit.unwrap_or(0.0).max(1.25 * last);
        Ok(Measured {
            bond: self.bond.clone(),
            temperature: self.temperature.value.clone(),
            word: self.integrator()?,
            resonances: measurement.resonances(most),
            measurement,
            steps,
            chosen: self.steps.as_ref().map_or_else(Vec::new, |steps| steps.values.clone()),
            meant: (self.bonds, self.length.value.clone()),
            level,
        })
    }

    fn show(&self, measured: &Measured) -> Document {
        report::document(measured)
    }

    fn figure(&self, measured: &Measured, _: &Work) -> Result<Option<Figure>> {
        Ok(Some(report::figure(measured)))
    }
}
