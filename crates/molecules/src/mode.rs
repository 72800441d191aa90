//! Modes, the vibrations of advice: a stiffness over a mass, on one of the clocks.
//!
//! A period T is the stiffness (2 π/T)² of unit mass, exactly, in ℚ\[π\]; a bond is its force constant over
//! its reduced mass.
//!
//! ```
//! use kickdrift_molecules::Mode;
//! let mode = Mode::from_period("OH=10fs")?;
//! assert_eq!((mode.name.as_str(), mode.stiffness.to_string()), ("OH", "pi^2/25".to_string()));
//! // CHARMM's TIP3P: E = K x².
//! let bond = Mode::from_bond("OH:K=450kcal/mol/A^2,15.999,1.008", None)?;
//! let (lo, hi) = bond.period();
//! assert!(9.970 < lo && hi < 9.971);
//! # Ok::<(), kickdrift_molecules::number::error::Error>(())
//! ```

use super::aperture;
use super::caution::Place;
use super::typical::Typical;
use super::unit::{self, Dimension};
use number::{Ball, Error, Laurent, Rational, Real, Result};

/// Where a stiffness comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    Period,
    Wavenumber,
    /// A period that is known by name.
    Typical(&'static Typical),
    /// E = k x²/2, as GROMACS and OpenMM write it.
    Half,
    /// E = K x², as Amber and CHARMM write it: k = 2 K.
    Whole,
    /// The curvature at rest of a shape that is not harmonic.
    Shape,
}

impl Origin {
    /// Every one.
    pub fn all() -> impl Iterator<Item = Origin> {
        let plain = [Origin::Period, Origin::Wavenumber, Origin::Half, Origin::Whole, Origin::Shape];
        plain.into_iter().chain(Typical::all().map(Origin::Typical))
    }

    /// In words, in documents.
    pub fn name(self) -> &'static str {
        match self {
            Origin::Period => "period",
            Origin::Wavenumber => "wavenumber",
            Origin::Typical(typical) => typical.origin,
            Origin::Half => "k of E = k x^2/2",
            Origin::Whole => "K of E = K x^2",
            Origin::Shape => "curvature at rest",
        }
    }
}

/// A vibration and the clock that its force is on.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    pub name: String,
    pub origin: Origin,
    /// k/m in 1/fs², exactly; c π^k.
    pub stiffness: Laurent,
    /// 0 is the fastest clock; `None` where that follows from its place in the list.
    pub clock: Option<usize>,
    /// Its masses, where it is a bond.
    pub bond: Option<Bond>,
    /// Its potential, where that is known and not harmonic, with the masses as given.
    pub shape: Option<aperture::Bond>,
}

/// The masses of a bond.
#[derive(Clone, Debug, PartialEq)]
pub struct Bond {
    /// In amu, as given, the larger one first.
    pub masses: [Rational; 2],
    /// The hydrogens on its heavy atom.
    pub hydrogens: u8,
    /// The mass that hydrogens take in place of their own, from their heavy atom.
    pub heavy: Option<Rational>,
}

impl Bond {
    pub fn new(mut masses: [Rational; 2], hydrogens: u8, heavy: Option<Rational>) -> Bond {
        masses.sort_by(|a, b| b.cmp(a));
        Bond { masses, hydrogens, heavy }
    }

    /// Whether one of its atoms is a hydrogen, by the masses as given.
    fn has_hydrogen(&self) -> bool {
        self.masses.iter().any(is_hydrogen)
    }

    /// 1/m1 + 1/m2 with hydrogens of this mass.
    fn inverse_mass(&self, name: &str, heavy: Option<&Rational>) -> Result<Rational> {
        let given = self.masses.clone();
        let [m1, m2] = heavy.map_or(Ok(given.clone()), |mass| heavier(name, given, mass, self.hydrogens))?;
        Ok(m1.recip() + m2.recip())
    }
}

/// Periods are enclosed in so many bits before they become doubles.
const BITS: u32 = 96;

/// Some names of [`Typical`]; advice without a fast period lists all.
const EXAMPLES: &str =
    "slow=water, slow=protein, fast=water, fast=water,rigid, fast=protein,h-bonds, fast=protein,h-bonds,hmr3";

impl Mode {
    fn new(name: &str, origin: Origin, stiffness: Laurent) -> Mode {
        Mode { name: name.trim().into(), origin, stiffness, clock: None, bond: None, shape: None }
    }

    /// `NAME=10fs`, `10fs`, `NAME=3700/cm`, `slow=water`, `fast=water`: a period, a wavenumber, or what one
    /// of [`SLOW`](super::SLOW) or [`FAST`](super::FAST) is called.
    ///
    /// # Errors
    /// Names the period, with a unit that is missing or unknown.
    pub fn from_period(text: &str) -> Result<Mode> {
        let (name, value) = text.split_once('=').unwrap_or((text, text));
        let power = || Error::input("period", text.trim(), "must be a rational times a power of pi");
        let (origin, period) = if unit::dimension(value) == Some(Dimension::Wavenumber) {
            let wavenumber = unit::measured("period", value, Dimension::Wavenumber)?;
            (Origin::Wavenumber, unit::period_of_wavenumber(&wavenumber).ok_or_else(power)?)
        } else if let Some(known) = Typical::of(name, value) {
            let period = format!("{}fs", known.period);
            (Origin::Typical(known), unit::measured("period", &period, Dimension::Time)?)
        } else if value.contains(',') && value.trim().starts_with(|c: char| c.is_ascii_digit()) {
            return Err(Error::input(
                "period",
                text.trim(),
                "is a list: give each period by itself, as OH=10fs and slow=40fs",
            ));
        } else if value.trim().starts_with(|c: char| c.is_ascii_alphabetic())
            && !value.trim().starts_with("pi")
        {
            let remedy = format!(
                "write a period and its unit, as 10fs, a wavenumber, as 3700/cm, or a name that is known, as {EXAMPLES}"
            );
            return Err(Error::input("period", value.trim(), remedy));
        } else {
            (Origin::Period, unit::measured("period", value, Dimension::Time)?)
        };
        let turn = Laurent::monomial(Rational::from_integer(2.into()), 1);
        let frequency = turn.checked_div(&period).ok_or_else(power)?;
        Ok(Mode::new(name, origin, &frequency * &frequency))
    }

    /// `NAME=0.2`: a period that is a plain number, for times without a unit.
    ///
    /// # Errors
    /// Names the period, where it has a unit, is no number, or is not positive.
    pub fn from_plain_period(text: &str) -> Result<Mode> {
        let (name, value) = text.split_once('=').unwrap_or((text, text));
        let period = unit::plain("period", value)?;
        let turn = Laurent::monomial(Rational::from_integer(2.into()), 1);
        let power = || Error::input("period", text.trim(), "must be a rational times a power of pi");
        let frequency = turn.checked_div(&period).ok_or_else(power)?;
        Ok(Mode::new(name, Origin::Period, &frequency * &frequency))
    }

    /// `NAME:k=1106kcal/mol/A^2,15.999,1.008`: a force constant (k of E = k x²/2, K of E = K x²) and two
    /// masses in amu, behind them the number of hydrogens on the heavy atom where it is not 1. With
    /// `hydrogen`, a mass in amu, every hydrogen (1.1 amu and less) takes that mass and its heavy atom loses
    /// what its hydrogens have gained.
    ///
    /// # Errors
    /// Names the bond and the part that is wrong: no k or K, a unit, a mass, a heavy atom that would be left
    /// without mass.
    pub fn from_bond(text: &str, hydrogen: Option<&Rational>) -> Result<Mode> {
        let form = || {
            let remedy = "write NAME:k=CONSTANT,MASS,MASS, as OH:K=450kcal/mol/A^2,15.999,1.008 (k of E = k x^2/2, K of E = K x^2)";
            Error::input("bond", text.trim(), remedy)
        };
        let (name, rest) = text.split_once(':').ok_or_else(form)?;
        let parts: Vec<&str> = rest.split(',').map(str::trim).collect();
        if let Some(constant) = parts.first().filter(|part| !part.contains('=')) {
            let remedy = format!(
                "write k={constant} where E = k x^2/2 (GROMACS, OpenMM), K={constant} where E = K x^2 (Amber, CHARMM)"
            );
            return Err(Error::input(&format!("bond {name}"), constant, remedy));
        }
        let count = parts.iter().take_while(|part| part.contains('=')).count();
        let (constants, rest) = parts.split_at(count);
        let [m1, m2, hydrogens @ ..] = rest else { return Err(form()) };
        let count = match hydrogens {
            [] => 1,
            [n] => match n.parse::<u8>() {
                Ok(n @ 1..=4) => n,
                _ => {
                    let remedy = "a heavy atom has 1 to 4 hydrogens";
                    return Err(Error::input(&format!("bond {name}"), text, remedy));
                }
            },
            _ => return Err(form()),
        };
        let bond = Bond::new([unit::mass(name, m1)?, unit::mass(name, m2)?], count, None);
        let (origin, k, shape) = constant(name, constants, [m1, m2]).transpose().ok_or_else(form)??;
        let stiffness = &k * &Laurent::from_rational(bond.inverse_mass(name, None)?);
        let mode = Mode { bond: Some(bond), shape, ..Mode::new(name, origin, stiffness) };
        hydrogen.map_or(Ok(mode.clone()), |hydrogen| mode.with_hydrogens(hydrogen))
    }

    /// This bond with hydrogens of this mass in amu; unchanged where it is no bond, or has no hydrogen.
    ///
    /// # Errors
    /// A heavy atom that would be left without mass.
    pub fn with_hydrogens(&self, mass: &Rational) -> Result<Mode> {
        let Some(bond) = self.bond.as_ref().filter(|bond| bond.has_hydrogen()) else {
            return Ok(self.clone());
        };
        let after = bond.inverse_mass(&self.name, Some(mass))?
            / bond.inverse_mass(&self.name, bond.heavy.as_ref())?;
        let bond = Some(Bond { heavy: Some(mass.clone()), ..bond.clone() });
        Ok(Mode { stiffness: &self.stiffness * &Laurent::from_rational(after), bond, ..self.clone() })
    }

    /// Whether it is called slow, or known as a period of slow forces: then it is on no fast clock unless it
    /// is put there.
    pub fn is_called_slow(&self) -> bool {
        let by_origin = matches!(self.origin, Origin::Typical(typical) if !typical.is_fast);
        by_origin || self.name.to_lowercase().starts_with("slow")
    }

    /// The same of the fastest clock.
    pub fn is_called_fast(&self) -> bool {
        let by_origin = matches!(self.origin, Origin::Typical(typical) if typical.is_fast);
        by_origin || self.name.to_lowercase().starts_with("fast")
    }

    /// Whether one of the two atoms of a bond is a hydrogen; `None` where this is no bond.
    pub fn is_bond_with_hydrogen(&self) -> Option<bool> {
        self.bond.as_ref().map(Bond::has_hydrogen)
    }

    /// The period in fs with the masses as given, where heavy hydrogens have changed it; rounded.
    pub fn before(&self) -> Option<f64> {
        let bond = self.bond.as_ref().filter(|bond| bond.has_hydrogen())?;
        let now = bond.inverse_mass(&self.name, Some(bond.heavy.as_ref()?)).ok()?;
        let change = bond.inverse_mass(&self.name, None).ok()? / now;
        let light = Mode { stiffness: &self.stiffness * &Laurent::from_rational(change), ..self.clone() };
        (light.middle() != self.middle()).then(|| light.middle())
    }

    /// 2 π/√stiffness in fs, enclosed.
    pub fn period(&self) -> (f64, f64) {
        self.period_ball().to_f64_enclosure()
    }

    fn middle(&self) -> f64 {
        self.period_ball().mid_f64()
    }

    /// The period over `parts`, enclosed: T/5 and the like.
    pub fn part(&self, parts: u64) -> (f64, f64) {
        let parts = Ball::from_integer(&parts.into());
        self.period_ball().div(&parts, BITS).expect("at least one part").to_f64_enclosure()
    }

    /// The step that a published statement is about, enclosed.
    pub fn at(&self, place: Place) -> (f64, f64) {
        match place {
            Place::Part(parts) => self.part(parts),
            Place::Turn(k) => {
                let pi = Ball::pi(BITS);
                let angle = pi.div(&Ball::from_integer(&k.into()), BITS).expect("at least one step");
                let over_pi = self.period_ball().div(&pi, BITS).expect("pi > 0");
                over_pi.mul(&angle.sin(BITS), BITS).to_f64_enclosure()
            }
        }
    }

    /// T/π, velocity Verlet's own limit, enclosed.
    pub fn verlet(&self) -> (f64, f64) {
        self.period_ball().div(&Ball::pi(BITS), BITS).expect("pi > 0").to_f64_enclosure()
    }

    fn period_ball(&self) -> Ball {
        let frequency = self.stiffness.enclosure(BITS).sqrt(BITS).expect("stiffnesses are positive");
        Ball::pi(BITS).scale2(1).div(&frequency, BITS).expect("stiffnesses are positive")
    }
}

/// The force constant of a bond and where it comes from, and its shape where that is not harmonic; `None` of
/// other constants.
fn constant(
    name: &str,
    constants: &[&str],
    [m1, m2]: [&str; 2],
) -> Result<Option<(Origin, Laurent, Option<aperture::Bond>)>> {
    let measured = |text: &str| unit::measured(&format!("bond {name}"), text, Dimension::Stiffness);
    let named = constants.iter().filter_map(|part| part.split_once('=')).collect::<Vec<_>>();
    Ok(match &named[..] {
        [("k", value)] => Some((Origin::Half, measured(value)?, None)),
        [("K", value)] => Some((Origin::Whole, &measured(value)? * &Laurent::from_integer(2), None)),
        [(first, _), ..] if first.starts_with("morse:") || first.starts_with("poly:") => {
            let shape = aperture::Bond::read(&format!("{name}:{},{m1},{m2}", constants.join(",")))?;
            Some((Origin::Shape, Laurent::from_rational(shape.curvature()), Some(shape)))
        }
        _ => None,
    })
}

/// Atoms up to this mass, in amu, are hydrogens (deuterium is none).
fn is_hydrogen(mass: &Rational) -> bool {
    *mass <= Rational::new(11.into(), 10.into())
}

/// The masses after repartitioning: the sum over the heavy atom and its hydrogens stays.
fn heavier(bond: &str, masses: [Rational; 2], hydrogen: &Rational, count: u8) -> Result<[Rational; 2]> {
    let light = masses.each_ref().map(is_hydrogen);
    if light[0] == light[1] {
        return Ok(masses);
    }
    let (h, heavy) = if light[0] { (0, 1) } else { (1, 0) };
    let gain = (hydrogen - &masses[h]) * Rational::from_integer(count.into());
    let left = &masses[heavy] - gain;
    if left < masses[h] {
        let left = if left > Rational::default() {
            format!("{} amu", unit::decimal(&left))
        } else {
            "no mass".into()
        };
        let remedy = format!(
            "hydrogens of {} amu would leave its heavy atom {left}, less than a hydrogen has: take lighter ones",
            unit::decimal(hydrogen)
        );
        return Err(Error::input(&format!("bond {bond}"), unit::decimal(&masses[heavy]), remedy));
    }
    let mut all = masses;
    (all[h], all[heavy]) = (hydrogen.clone(), left);
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    fn period(bond: &str, hydrogen: Option<&Rational>) -> String {
        format!("{:.2}", Mode::from_bond(bond, hydrogen).unwrap().middle())
    }

    #[test]
    fn the_bonds_of_force_fields_have_their_known_periods() {
        let bonds = [
            ("OH:K=553kcal/mol/A^2,15.999,1.008", "8.99"),
            ("OH:k=1106kcal/mol/A^2,1.008,15.999", "8.99"),
            ("OH:k=462750.4kJ/mol/nm^2,15.999amu,1.008amu", "8.99"),
            ("OH:K=450kcal/mol/A^2,15.999,1.008", "9.97"),
            ("NH:K=434kcal/mol/A^2,14.007,1.008", "10.11"),
            ("CH:K=340kcal/mol/A^2,12.011,1.008", "11.36"),
            ("CC:K=310kcal/mol/A^2,12.011,12.011", "30.23"),
            ("CO:K=570kcal/mol/A^2,12.011,15.999", "23.83"),
        ];
        for (bond, expected) in bonds {
            assert_eq!(period(bond, None), expected, "{bond}");
        }
        // K read as k would be a period √2 too long.
        assert_eq!(period("OH:k=553kcal/mol/A^2,15.999,1.008", None), "12.72");
    }

    #[test]
    fn heavy_hydrogens_slow_their_bond_down() {
        let heavy = ratio(3024, 1000);
        // A methyl group and an amide.
        assert_eq!(period("CH:K=340kcal/mol/A^2,12.011,1.008,3", Some(&heavy)), "16.69");
        assert_eq!(period("NH:K=434kcal/mol/A^2,14.007,1.008", Some(&heavy)), "16.20");
        // No hydrogen, no change.
        let bond = Mode::from_bond("CC:K=310kcal/mol/A^2,12.011,12.011", Some(&heavy)).unwrap();
        assert_eq!(bond.before(), None);
        let error = Mode::from_bond("CH:K=340kcal/mol/A^2,12.011,1.008,4", Some(&ratio(5, 1))).unwrap_err();
        assert!(error.remedy().contains("no mass"), "{error}");
    }

    #[test]
    fn a_bond_that_is_not_one_is_told_apart() {
        for text in [
            "OH",
            "OH:553kcal/mol/A^2,1,2",
            "OH:k=553,1,2",
            "OH:k=553kcal/mol/A^2,1",
            "OH:k=5N/m,1,2,9",
            "OH:k=5N/m,1,2,1,1",
            "OH:k=5N/m,0,2",
        ] {
            let error = Mode::from_bond(text, None).unwrap_err();
            assert!(error.field().starts_with("bond") && !error.remedy().is_empty(), "{text}: {error}");
        }
        assert!(Mode::from_period("1+pi fs").is_err());
    }
}
