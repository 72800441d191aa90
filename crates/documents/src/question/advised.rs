//! The typed question of advice, its answer, and its fields that have parts of their own: modes, schemes of
//! steps, beads.

use num_traits::Zero;
use serde_json::{Map, Value};

use super::asking::{Fields, Question, Work, question};
use super::field::{Field, notation, read};
use crate::input::{SystemFile, SystemScene};
use crate::report::advise as report;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{EXACT, POSITIVE, RATIONAL, Shape, TEXT};
use crate::report::table::Cell;
use molecules::aperture::energies_seen;
use molecules::unit::{TimeUnit, decimal};
use molecules::{
    Adds, Advice, Beads, Bond, DirectFindings, Findings, Levers, MOST_PRODUCTS, Mode, Molecule, Origin,
    SOLVED, Scheme, Status, Way, aperture,
};
use number::parse::parse_rational;
use number::{Error, ExactSign, Rational, Result, Sign};
use systems::Limits;

question! {
    /// The input in exact numbers: modes on their clocks or a system, and schemes of steps; lengths of time
    /// in fs.
    struct Advised {
        /// The part of itself by which every period may be off.
        band: Rational,
        /// The modes that vibrate.
        modes: Option<Vec<Mode>>,
        /// The steps in fs, from the innermost to the outermost one.
        schemes: Vec<Scheme>,
        /// The length of the run, in fs.
        length: Option<Rational>,
        /// The temperature at which bonds of a known shape must stay, in K; 298 unless given.
        temperature: Option<Rational>,
        /// The bonds of a known shape in the system; 10000 unless given.
        bonds: Option<u64>,
        /// The friction of the thermostat per fs: v times exp(-friction t) in the middle of every drift.
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
        /// Whether the bonds are harmonic: nothing published bounds a clock's own step.
        harmonic: bool,
        /// Ring polymers in place of atoms: how many beads, and their temperature, as 32 at 300 K.
        beads: Option<Beads>,
        /// Whether all times are plain numbers: read fs as the unit of time, and rates per ps as per that
        /// unit.
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

/// Kicks a second that advice on periods follows, and products a second of advice on Hessians, as measured.
const KICKS_A_SECOND: f64 = 5e6;
const PRODUCTS_A_SECOND: f64 = 1e10;

/// The step from which on a hot bond is lost, by both kinds of schemes: seconds, as measured of a Morse bond.
const HOT_BOND_SECONDS: f64 = 36.0;

/// Levers of a molecule cost about as much as so many schemes.
const LEVERS: usize = 10;

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
                let shapes = self.modes.iter().flatten().filter(|mode| mode.shape.is_some()).count();
                work.announce("how hot the bonds may be", shapes as f64 * HOT_BOND_SECONDS);
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
    /// Whether all steps asked about are proven stable with all periods within the band, below every unstable
    /// step: none is advised against. `None` where no steps are asked about.
    pub fn is_proven(&self) -> Option<bool> {
        fn all<T>(schemes: &[T], is_proven: impl Fn(&T) -> bool) -> Option<bool> {
            (!schemes.is_empty()).then(|| schemes.iter().all(is_proven))
        }
        let proven = |status: Status| matches!(status, Status::Safe | Status::Caution);
        match self {
            Safe::Periods(advice) => all(&advice.schemes, |scheme| proven(scheme.status)),
            Safe::Hessians(pair) => all(&pair.1.schemes, |scheme| proven(scheme.status)),
            Safe::Direct(pair) => {
                all(&pair.1.schemes, |scheme| [scheme.adds, scheme.in_band] == [Adds::Little; 2])
            }
        }
    }

    pub(super) fn view(&self) -> report::View<'_> {
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
    pub(super) fn unit(&self) -> TimeUnit {
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
        ways.push((
            format!("h-bonds held and hydrogens of {} amu", masses[0]),
            Way::HeldAndHeavy,
            Some(masses[0].clone()),
            held(),
        ));
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
            let why = "equilibrium MOLLY: Hessians do not say which motions the fast forces leave alone";
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
        Ok((temperature, energies_seen(bonds, &length)?))
    }

    pub(super) fn placed(&self, safe: &Safe) -> Advised {
        match safe {
            Safe::Periods(advice) => Advised { modes: Some(advice.modes.clone()), ..self.clone() },
            Safe::Hessians(_) | Safe::Direct(_) => self.clone(),
        }
    }
}

/// One of several that make a field.
trait Item: Sized {
    /// What documents hold of it.
    const SHAPE: Shape;

    fn of(name: &str, value: &Value) -> Result<Self>;
    fn shown(&self) -> Value;
}

impl<T: Item> Field for Vec<T> {
    const SHAPE: Shape = Shape::List(&T::SHAPE);
    const IS_REQUIRED: bool = false;

    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
        let one = |(k, value): (usize, &Value)| T::of(&format!("{name}[{k}]"), value);
        Some(match given {
            None => Ok(Vec::new()),
            Some(Value::Array(all)) => all.iter().enumerate().map(one).collect(),
            Some(other) => Err(Error::input(name, other, "write a list")),
        })
    }

    fn shown(&self) -> Option<Value> {
        (!self.is_empty()).then(|| self.iter().map(T::shown).collect())
    }
}

impl Item for String {
    const SHAPE: Shape = TEXT;

    fn of(name: &str, value: &Value) -> Result<Self> {
        let text = value.as_str().map(Into::into);
        text.ok_or_else(|| Error::input(name, value, "write a text"))
    }

    fn shown(&self) -> Value {
        self.as_str().into()
    }
}

impl Item for Scheme {
    const SHAPE: Shape = Shape::List(&RATIONAL);

    fn of(name: &str, value: &Value) -> Result<Self> {
        let steps = Vec::<String>::of(Some(value), name).transpose()?.unwrap_or_default();
        Scheme::new(steps.iter().map(|step| parse_rational(name, step)).collect::<Result<_>>()?)
    }

    fn shown(&self) -> Value {
        self.steps().iter().map(ToString::to_string).collect()
    }
}

notation! {
    Origin: origin, |origin: &Origin| origin.name();
    Beads: beads, |beads: &Beads| match &beads.kelvin {
        Some(kelvin) => format!("{} at {kelvin} K", beads.count),
        None => beads.count.to_string(),
    };
}

fn beads(field: &str, text: &str) -> Result<Beads> {
    let form =
        || Error::input(field, text, "write a number of beads and their temperature, as \"32 at 300 K\"");
    let (count, kelvin) = match text.split_once(" at ") {
        Some((count, kelvin)) => (count, Some(kelvin.strip_suffix(" K").ok_or_else(form)?)),
        None => (text, None),
    };
    let kelvin = kelvin.map(|kelvin| parse_rational(field, kelvin)).transpose()?;
    let count = count.parse().map_err(|_| form())?;
    Ok(Beads { count, kelvin: kelvin.filter(|kelvin| *kelvin > Rational::zero()) })
}

fn origin(field: &str, text: &str) -> Result<Origin> {
    let names = || Origin::all().map(Origin::name).collect::<Vec<_>>().join(", ");
    let found = Origin::all().find(|origin| origin.name() == text);
    found.ok_or_else(|| Error::input(field, text, format!("is none of {}", names())))
}

/// The record of a mode.
fn mode_record() -> Record<'static, Mode> {
    Record::new()
        .json("name", |mode: &Mode| mode.name.as_str().into())
        .says(TEXT, "")
        .json("from", |mode| mode.origin.name().into())
        .says(report::ORIGIN, "")
        .json("clock", |mode| mode.clock.map(|k| k + 1).into())
        .says(Shape::OrNull(&POSITIVE), "1 is the fastest; null of what constraints hold.")
        .json("stiffness", |mode| Cell::exact(&mode.stiffness))
        .says(EXACT, "k/m in 1/fs^2.")
        .optional("bond", |mode| Some(bond_record().entries(mode.bond.as_ref()?)))
        .says(Shape::Object(|| bond_record().keys()), "Its masses in amu as given, the hydrogens on its heavy atom, and the mass that hydrogens take in place of their own.")
        .optional("shape", |mode| Some(mode.shape.as_ref()?.to_string().into()))
        .says(TEXT, "The bond with its potential, as aperture reads it, where that is not harmonic.")
}

fn bond_record() -> Record<'static, Bond> {
    const MASSES: Shape = Shape::With(&Shape::List(&RATIONAL), r#"{"minItems": 2, "maxItems": 2}"#);
    const HYDROGENS: Shape = Shape::With(&POSITIVE, r#"{"maximum": 4}"#);
    Record::new()
        .value("masses", |bond: &Bond| bond.masses.each_ref().map(ToString::to_string).to_vec().into())
        .says(MASSES, "")
        .json("hydrogens", |bond| u64::from(bond.hydrogens).into())
        .says(HYDROGENS, "")
        .optional("heavy", |bond| Some(bond.heavy.as_ref()?.to_string().into()))
        .says(RATIONAL, "")
}

impl Item for Mode {
    const SHAPE: Shape = Shape::Object(|| mode_record().keys());

    fn of(name: &str, value: &Value) -> Result<Self> {
        let given = value.as_object().ok_or_else(|| Error::input(name, value, "write an object"))?;
        let at = |error: Error| {
            let field = format!("{name}.{}", error.field());
            error.at(field)
        };
        mode(given).map_err(at)
    }

    fn shown(&self) -> Value {
        mode_record().entries(self)
    }
}

fn bond(given: &Value) -> Result<Bond> {
    let form = || {
        Error::input("bond", given, "write {\"masses\": [M1, M2], \"hydrogens\": 1 to 4}, positive, in amu")
    };
    let object = given.as_object().ok_or_else(form)?;
    super::field::known(object, &["masses", "hydrogens", "heavy"], &[])?;
    let positive = |value: &Value| {
        super::field::parsed::<Rational>("bond", value).ok().filter(|mass| *mass > Rational::zero())
    };
    let masses: Vec<Rational> =
        object.get("masses").and_then(Value::as_array).into_iter().flatten().filter_map(positive).collect();
    let hydrogens =
        object.get("hydrogens").and_then(Value::as_u64).filter(|n| (1..=4).contains(n)).ok_or_else(form)?;
    let heavy = object.get("heavy").map(|mass| positive(mass).ok_or_else(form)).transpose()?;
    let masses: [Rational; 2] = masses.try_into().map_err(|_| form())?;
    Ok(Bond::new(masses, hydrogens as u8, heavy))
}

fn mode(given: &Map<String, Value>) -> Result<Mode> {
    super::field::known(given, &["name", "from", "clock", "stiffness", "bond", "shape"], &[])?;
    let clock = match given.get("clock") {
        None | Some(Value::Null) => None,
        Some(value) => {
            let place = value.as_u64().and_then(|as_u64| usize::try_from(as_u64).ok()?.checked_sub(1));
            let counted = || Error::input("clock", value, "clocks are counted from 1");
            Some(place.ok_or_else(counted)?)
        }
    };
    let mode = Mode {
        name: read("name", given, None)?,
        origin: read("from", given, None)?,
        stiffness: read("stiffness", given, None)?,
        clock,
        bond: given.get("bond").map(bond).transpose()?,
        shape: read::<Option<aperture::Bond>>("shape", given, None)?,
    };
    match mode.stiffness.sign() {
        Sign::Positive => Ok(mode),
        _ => Err(Error::input("stiffness", &mode.stiffness, "a mode vibrates: it must be positive")),
    }
}
