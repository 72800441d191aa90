//! Quantities in a Python script: products of numbers and units, by names that are set once.

use std::ops::Range;

use super::reading::{FS, PS, Unit, number};
use super::script::Script;
use number::{Error, Rational, Result};

/// A time in fs, and where its number stands, if one determines it.
pub(super) struct Time {
    pub size: Rational,
    pub place: Option<(Range<usize>, Unit)>,
}

/// The number in `4*unit.femtoseconds` or `0.004`; OpenMM's own unit is the picosecond.
pub(super) fn time(script: &Script, text: &str, range: Range<usize>) -> Result<Time> {
    let shown = text[range.clone()].split_whitespace().collect::<Vec<_>>().join(" ");
    let refused = || {
        let remedy = "write a positive number here, as 4*femtoseconds or 0.004*picoseconds (names that are set once to one are followed), or give the integrator as XmlSerializer.serialize writes it";
        Error::input("dt", &shown, remedy)
    };
    let mut product = Product::new();
    product.take(script, range, 1, time_unit).ok_or_else(refused)?;
    let size = match product.power {
        1 => product.size,
        0 => product.size * PS.size(),
        _ => return Err(refused()),
    };
    if product.numbers.is_empty() {
        return Err(refused());
    }
    let one = <[(Range<usize>, Rational); 1]>::try_from(product.numbers).ok();
    let place = one.and_then(|[(place, literal)]| {
        let unit = [FS, PS, Unit("1e6")].into_iter().find(|unit| &literal * unit.size() == size)?;
        Some((place, unit))
    });
    Ok(Time { size, place })
}

/// A time in fs.
fn time_unit(word: &str) -> Option<Rational> {
    let size = match word.strip_suffix('s').unwrap_or(word) {
        "femtosecond" | "f" => "1",
        "picosecond" | "p" => "1000",
        "nanosecond" | "n" => "1e6",
        "attosecond" => "0.001",
        _ => return None,
    };
    Some(Unit(size).size())
}

/// A mass in amu.
fn mass_unit(word: &str) -> Option<Rational> {
    let is_amu =
        ["amu", "amus", "dalton", "daltons", "atomic_mass_unit", "atomic_mass_units"].contains(&word);
    is_amu.then(|| Rational::from_integer(1.into()))
}

/// A product of numbers and units.
struct Product {
    size: Rational,
    /// How often a unit is in it.
    power: i32,
    numbers: Vec<(Range<usize>, Rational)>,
    /// How many more factors are looked at: names may stand for each other.
    left: u32,
}

impl Product {
    fn new() -> Product {
        Product { size: Rational::from_integer(1.into()), power: 0, numbers: vec![], left: 50 }
    }

    /// Takes these factors to the power 1 or -1; `None` where one is no number and no unit.
    fn take(
        &mut self,
        script: &Script,
        range: Range<usize>,
        sign: i32,
        unit: fn(&str) -> Option<Rational>,
    ) -> Option<()> {
        self.left = self.left.checked_sub(1)?;
        let range = script.followed(range);
        let code = script.code();
        let factors = script.factors(range.clone());
        if factors.len() > 1 {
            return factors.into_iter().try_for_each(|(divides, range)| {
                self.take(script, range, if divides { -sign } else { sign }, unit)
            });
        }
        let text = &code[range.clone()];
        if let Some(inside) = script.call_of(range.clone(), "Quantity") {
            return script.split(inside).into_iter().try_for_each(|part| {
                let value = part.start + code[part.clone()].find('=').map_or(0, |at| at + 1);
                self.take(script, value..part.end, sign, unit)
            });
        }
        let size = match unit(text.rsplit('.').next().unwrap_or(text)) {
            Some(size) => {
                self.power += sign;
                size
            }
            None => {
                let size = number("dt", text).ok()?;
                self.numbers.push((range, size.clone()));
                size
            }
        };
        self.size = if sign < 0 { &self.size / size } else { &self.size * size };
        Some(())
    }
}

/// A mass in amu; OpenMM's own unit is that one.
pub(super) fn mass(script: &Script, range: Range<usize>) -> Option<Rational> {
    let mut product = Product::new();
    product.take(script, range, 1, mass_unit)?;
    (product.power < 2 && product.numbers.len() == 1).then_some(product.size)
}
