//! Units, converted exactly.
//!
//! Everything is held in femtoseconds and amu. An amu is taken as 1 g/mol over the Avogadro constant, as
//! simulation engines do: then the Avogadro constant drops out of kcal/mol and kJ/mol, and all factors are
//! rational. (The measured amu, CODATA 2022, is larger by 1e-9 of itself.) The constants are those of the SI
//! since 2019 (BIPM, *The International System of Units*, 9th edition, table 1): c = 299792458 m/s,
//! e = 1.602176634e-19 C, N_A = 6.02214076e23/mol, all exact; 1 cal = 4.184 J (thermochemical, ISO 31-4),
//! exact too.
//!
//! ```
//! use kickdrift_molecules::unit::{Dimension, measured};
//! let (period, stiffness) = (measured("period", "0.01 ps", Dimension::Time)?, measured("k", "1106kcal/mol/A^2", Dimension::Stiffness)?);
//! assert_eq!(period.to_string(), "10"); // fs
//! assert_eq!(stiffness.to_string(), "289219/625000"); // amu/fs²
//! let error = measured("period", "10", Dimension::Time).unwrap_err();
//! assert_eq!(error.to_string(), "period = 10: has no unit: write 10fs (of time there are fs, ps, ns, s, au)");
//! # Ok::<(), kickdrift_molecules::number::error::Error>(())
//! ```

use num_bigint::BigInt;

use number::parse::{parse, parse_rational};
use number::{Error, ExactSign, Laurent, Rational, Result, Sign};

/// The unit that all times of a question have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeUnit {
    #[default]
    Femtoseconds,
    /// None: times are plain numbers, as in Lennard-Jones units.
    Plain,
}

impl TimeUnit {
    /// A length of time, as written.
    pub fn of(self, number: impl std::fmt::Display) -> String {
        match self {
            TimeUnit::Femtoseconds => format!("{number} fs"),
            TimeUnit::Plain => number.to_string(),
        }
    }

    /// A rate, as written.
    pub fn rate(self, number: impl std::fmt::Display) -> String {
        match self {
            TimeUnit::Femtoseconds => format!("{number}/ps"),
            TimeUnit::Plain => format!("{number} per unit of time"),
        }
    }

    /// Of lengths and of rates, in the heads of tables.
    pub fn names(self) -> [&'static str; 2] {
        match self {
            TimeUnit::Femtoseconds => ["fs", "1/ps"],
            TimeUnit::Plain => ["time", "1/time"],
        }
    }

    /// Units of time in that of rates.
    pub fn in_rates(self) -> u32 {
        match self {
            TimeUnit::Femtoseconds => 1000,
            TimeUnit::Plain => 1,
        }
    }
}

/// Whether a text is a number without a unit.
pub fn is_plain(text: &str) -> bool {
    dimension(text).is_none() && parse("number", text).is_ok()
}

/// The dimension of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// In fs.
    Time,
    /// In 1/cm.
    Wavenumber,
    /// In amu.
    Mass,
    /// Force over length, in amu/fs².
    Stiffness,
    /// One over time, in 1/fs.
    Rate,
    /// In amu nm²/fs².
    Energy,
    /// One over length, in 1/nm.
    Narrowness,
    /// Energy over the third power of a length, in amu/(fs² nm).
    Cubic,
    /// Energy over the fourth power of a length, in amu/(fs² nm²).
    Quartic,
    /// In kelvin.
    Temperature,
}

/// A unit: its names, the first one the usual, and its size in the unit of its dimension.
struct Unit {
    dimension: Dimension,
    names: &'static [&'static str],
    size: &'static str,
}

const fn unit(dimension: Dimension, names: &'static [&'static str], size: &'static str) -> Unit {
    Unit { dimension, names, size }
}

use Dimension::{Cubic, Energy, Mass, Narrowness, Quartic, Rate, Stiffness, Temperature, Time, Wavenumber};

/// Longer names stand before the shorter ones that they end in.
const UNITS: [Unit; 29] = [
    // ħ/E_h, measured (CODATA 2022); before the mass that its name ends in.
    unit(Time, &["atomic_unit", "a.u.", "au"], "2.4188843265864e-2"),
    unit(Time, &["fs"], "1"),
    unit(Time, &["ps"], "1000"),
    unit(Time, &["ns"], "1000000"),
    unit(Rate, &["1/fs", "/fs", "fs^-1"], "1"),
    unit(Rate, &["1/ps", "/ps", "ps^-1"], "1/1000"),
    unit(Time, &["s"], "1e15"),
    unit(Wavenumber, &["1/cm", "/cm", "cm^-1", "cm-1"], "1"),
    unit(Mass, &["amu", "g/mol", "Da", "u"], "1"),
    // 4184 J/mol over 1e-20 m² and 1e-3 kg/mol is 4.184e26/s².
    unit(Stiffness, &["kcal/mol/A^2", "kcal/(mol*A^2)"], "4.184e-4"),
    unit(Stiffness, &["kJ/mol/nm^2", "kJ/(mol*nm^2)"], "1e-6"),
    unit(Stiffness, &["kJ/mol/A^2", "kJ/(mol*A^2)"], "1e-4"),
    unit(Stiffness, &["kcal/mol/nm^2"], "4.184e-6"),
    // e N_A over 1e-20 m² and 1e-3 kg/mol.
    unit(Stiffness, &["eV/A^2"], "1.602176634e-19*6.02214076e23*1e-7"),
    // N_A over 1e-3 kg/mol, in 1/s².
    unit(Stiffness, &["N/m"], "6.02214076e23*1e3*1e-30"),
    // 1 kJ/mol is 1e6 m²/s² times 1 g/mol, and 1 m²/s² is 1e-12 nm²/fs².
    unit(Energy, &["kcal/mol"], "4.184e-6"),
    unit(Energy, &["kJ/mol"], "1e-6"),
    unit(Energy, &["eV"], "1.602176634e-19*6.02214076e23*1e-9"),
    unit(Narrowness, &["1/nm", "/nm", "nm^-1"], "1"),
    unit(Narrowness, &["1/A", "/A", "A^-1"], "10"),
    unit(Cubic, &["kcal/mol/A^3"], "4.184e-3"),
    unit(Cubic, &["kJ/mol/nm^3"], "1e-6"),
    unit(Cubic, &["kJ/mol/A^3"], "1e-3"),
    unit(Cubic, &["eV/A^3"], "1.602176634e-19*6.02214076e23*1e-6"),
    unit(Quartic, &["kcal/mol/A^4"], "4.184e-2"),
    unit(Quartic, &["kJ/mol/nm^4"], "1e-6"),
    unit(Quartic, &["kJ/mol/A^4"], "1e-2"),
    unit(Quartic, &["eV/A^4"], "1.602176634e-19*6.02214076e23*1e-5"),
    unit(Temperature, &["K"], "1"),
];

impl Dimension {
    fn words(self) -> &'static str {
        match self {
            Time => "of time there are fs, ps, ns, s, au",
            Wavenumber => "of wavenumbers there is 1/cm",
            Mass => "of mass there is amu",
            Stiffness => "of force constants there are kcal/mol/A^2, kJ/mol/nm^2, eV/A^2, N/m",
            Rate => "of rates there are 1/ps, 1/fs",
            Energy => "of energies there are kcal/mol, kJ/mol, eV",
            Narrowness => "of inverse lengths there are 1/nm, 1/A",
            Cubic => "of cubic constants there are kcal/mol/A^3, kJ/mol/nm^3, kJ/mol/A^3, eV/A^3",
            Quartic => "of quartic constants there are kcal/mol/A^4, kJ/mol/nm^4, kJ/mol/A^4, eV/A^4",
            Temperature => "of temperatures there is K",
        }
    }

    fn usual(self) -> &'static str {
        match self {
            Time => "fs",
            Wavenumber => "/cm",
            Mass => "amu",
            Stiffness => "kcal/mol/A^2",
            Rate => "/ps",
            Energy => "kcal/mol",
            Narrowness => "/nm",
            Cubic => "kcal/mol/A^3",
            Quartic => "kcal/mol/A^4",
            Temperature => "K",
        }
    }
}

/// The number before the unit, and the unit.
fn split(text: &str) -> Option<(String, &'static Unit)> {
    let text = text.trim().replace('Å', "A").replace('²', "^2").replace('⁻', "-").replace('¹', "1");
    UNITS.iter().flat_map(|unit| unit.names.iter().map(move |name| (*name, unit))).find_map(|(name, unit)| {
        let number = text.strip_suffix(name)?;
        // 37001/cm is no 3700 1/cm, and kcal/mol/A^2 no number with the unit 2.
        let apart = !name.starts_with(|c: char| c.is_ascii_digit()) || number.ends_with(char::is_whitespace);
        let ends =
            number.trim_end().ends_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | ')' | 'i' | 'π'));
        (apart && ends).then(|| (number.trim_end().trim_end_matches('*').into(), unit))
    })
}

/// The dimension of a text with a unit; `None` where it has none that is known.
pub fn dimension(text: &str) -> Option<Dimension> {
    split(text).map(|(_, unit)| unit.dimension)
}

/// A positive number with its unit, exactly, in the unit of its dimension.
///
/// # Errors
/// A unit that is missing, unknown or of another dimension, and a number that is not positive, named by
/// `field`.
pub fn measured(field: &str, text: &str, dimension: Dimension) -> Result<Laurent> {
    let number = signed(field, text, dimension)?;
    if number.sign() == Sign::Positive {
        Ok(number)
    } else {
        Err(Error::input(field, text.trim(), "must be positive"))
    }
}

/// As [`measured`], for numbers of any sign.
///
/// # Errors
/// As [`measured`], but for the sign.
pub fn signed(field: &str, text: &str, dimension: Dimension) -> Result<Laurent> {
    let Some((number, unit)) = split(text) else {
        let remedy = match parse(field, text) {
            Ok(_) => {
                format!("has no unit: write {}{} ({})", text.trim(), dimension.usual(), dimension.words())
            }
            Err(_) => {
                format!("write a number and its unit, as 10{} ({})", dimension.usual(), dimension.words())
            }
        };
        return Err(Error::input(field, text.trim(), remedy));
    };
    if unit.dimension != dimension {
        let remedy = format!(
            "has another unit than is asked for: write a number such as 10{} ({})",
            dimension.usual(),
            dimension.words()
        );
        return Err(Error::input(field, text.trim(), remedy));
    }
    let number = parse(field, &number).map_err(|error| Error::input(field, text.trim(), error.remedy()))?;
    let size = parse_rational("unit", unit.size).expect("the table of units is sound");
    Ok(&number * &Laurent::from_rational(size))
}

/// A positive number without a unit.
///
/// # Errors
/// A unit, no number, a number that is not positive, named by `field`.
pub fn plain(field: &str, text: &str) -> Result<Laurent> {
    if dimension(text).is_some() {
        let remedy = "has a unit, and other times have none: write all times as plain numbers, or all with their units";
        return Err(Error::input(field, text.trim(), remedy));
    }
    let number = parse(field, text)?;
    if number.sign() == Sign::Positive {
        Ok(number)
    } else {
        Err(Error::input(field, text.trim(), "must be positive"))
    }
}

/// As [`measured`], for numbers without π.
///
/// # Errors
/// As [`measured`]; a number that is not rational.
pub fn rational(field: &str, text: &str, dimension: Dimension) -> Result<Rational> {
    without_pi(field, text, &measured(field, text, dimension)?)
}

/// As [`rational`], for numbers of any sign.
///
/// # Errors
/// As [`rational`], but for the sign.
pub fn signed_rational(field: &str, text: &str, dimension: Dimension) -> Result<Rational> {
    without_pi(field, text, &signed(field, text, dimension)?)
}

fn without_pi(field: &str, text: &str, number: &Laurent) -> Result<Rational> {
    number
        .as_rational()
        .ok_or_else(|| Error::input(field, text.trim(), "must be rational; write it without pi"))
}

/// A mass of a bond in amu, its unit as a rule not written.
pub(super) fn mass(bond: &str, text: &str) -> Result<Rational> {
    let field = format!("bond {bond}: mass");
    let with_unit = dimension(text).map_or_else(|| format!("{}amu", text.trim()), |_| text.into());
    rational(&field, &with_unit, Dimension::Mass)
        .map_err(|error| Error::input(&field, text.trim(), error.remedy()))
}

/// The period in fs of a wavenumber in 1/cm: 1/(100 c ν̃) seconds, about 33356/ν̃; `None` where ν̃ is no c
/// π^k.
pub fn period_of_wavenumber(wavenumber: &Laurent) -> Option<Laurent> {
    let per_second = Laurent::from_rational(Rational::from_integer(BigInt::from(29_979_245_800_u64)));
    let femtoseconds = Laurent::from_rational(Rational::from_integer(BigInt::from(10).pow(15)));
    femtoseconds.checked_div(&(&per_second * wavenumber))
}

/// A rational as people write it: a decimal where it ends within 12 places, else a fraction.
///
/// ```
/// use kickdrift_molecules::{number::rational::ratio, unit::decimal};
/// assert_eq!([ratio(1, 2), ratio(4, 1), ratio(1, 3)].map(|x| decimal(&x)), ["0.5", "4", "1/3"]);
/// ```
pub fn decimal(x: &Rational) -> String {
    let scaled = x * Rational::from_integer(BigInt::from(10).pow(12));
    if !scaled.is_integer() {
        return x.to_string();
    }
    let negative = scaled.numer().sign() == num_bigint::Sign::Minus;
    let digits = format!("{:0>13}", scaled.numer().magnitude().to_string());
    let (whole, part) = digits.split_at(digits.len() - 12);
    let part = part.trim_end_matches('0');
    let point = if part.is_empty() { "" } else { "." };
    format!("{}{whole}{point}{part}", if negative { "-" } else { "" })
}
