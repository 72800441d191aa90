//! The fields of advice that have parts of their own: modes, schemes of steps, beads.

use num_traits::Zero;
use serde_json::{Map, Value, json};

use super::field::{Field, notation, read};
use molecules::aperture;
use molecules::{Beads, Bond, Mode, Origin, Scheme, Typical};
use number::error::{Error, Result};
use number::parse::parse_rational;
use number::{ExactSign, Rational, Sign};

/// One of several that make a field.
trait Item: Sized {
    fn of(name: &str, value: &Value) -> Result<Self>;
    fn shown(&self) -> Value;
}

impl<T: Item> Field for Vec<T> {
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
    fn of(name: &str, value: &Value) -> Result<Self> {
        let text = value.as_str().map(Into::into);
        text.ok_or_else(|| Error::input(name, value, "write a text"))
    }

    fn shown(&self) -> Value {
        self.as_str().into()
    }
}

impl Item for Scheme {
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
    let plain = [Origin::Period, Origin::Wavenumber, Origin::Half, Origin::Whole, Origin::Shape];
    let all: Vec<Origin> = plain.into_iter().chain(Typical::all().map(Origin::Typical)).collect();
    let names = all.iter().map(|origin| origin.name()).collect::<Vec<_>>().join(", ");
    let found = all.into_iter().find(|origin| origin.name() == text);
    found.ok_or_else(|| Error::input(field, text, format!("is none of {names}")))
}

impl Item for Mode {
    fn of(name: &str, value: &Value) -> Result<Self> {
        let given = value.as_object().ok_or_else(|| Error::input(name, value, "write an object"))?;
        let at = |error: Error| {
            let field = format!("{name}.{}", error.field());
            error.at(field)
        };
        mode(given).map_err(at)
    }

    fn shown(&self) -> Value {
        let mut shown = json!({"name": self.name, "from": self.origin.name(), "clock": self.clock.map(|k| k + 1), "stiffness": self.stiffness.to_string()});
        if let Some(bond) = &self.bond {
            shown["bond"] = json!({"masses": bond.masses.each_ref().map(ToString::to_string), "hydrogens": bond.hydrogens});
            if let Some(heavy) = &bond.heavy {
                shown["bond"]["heavy"] = heavy.to_string().into();
            }
        }
        if let Some(shape) = &self.shape {
            shown["shape"] = shape.to_string().into();
        }
        shown
    }
}

fn bond(given: &Value) -> Result<Bond> {
    let form = || {
        Error::input("bond", given, "write {\"masses\": [M1, M2], \"hydrogens\": 1 to 4}, positive, in amu")
    };
    let object = given.as_object().ok_or_else(form)?;
    super::field::known(object, &["masses", "hydrogens", "heavy"])?;
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
    super::field::known(given, &["name", "from", "clock", "stiffness", "bond", "shape"])?;
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
