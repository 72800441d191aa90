//! Reading documents: every field by its name, every error with it.

use serde_json::Value;

use crate::error::Error;
use crate::number::parse::{parse, parse_rational};
use crate::number::{Laurent, Ratio, Rational, rational};

/// Why a row does not hold, or why that cannot be told.
pub enum Fault {
    Wrong(String),
    Error(Error),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Fault::Error(error)
    }
}

pub type Checked<T> = std::result::Result<T, Fault>;

/// That something holds, or what is wrong.
pub fn holds(truth: bool, wrong: impl FnOnce() -> String) -> Checked<()> {
    if truth { Ok(()) } else { Err(Fault::Wrong(wrong())) }
}

/// An object of a document.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a>(&'a Value);

impl<'a> Row<'a> {
    pub fn new(value: &'a Value) -> Self {
        Row(value)
    }

    /// Which row it is, for people.
    pub fn place(&self) -> String {
        let part = |key: &str| self.0.get(key).filter(|value| !value.is_object() && !value.is_array());
        let keys = ["p", "q", "m", "a", "b", "h1", "h2", "s", "rho", "entry"];
        let parts = keys.iter().filter_map(|key| Some(format!("{key} = {}", plain(part(key)?))));
        parts.collect::<Vec<_>>().join(", ")
    }

    fn missing(key: &str, what: &str) -> Fault {
        Fault::Wrong(format!("{key} is not {what}"))
    }

    pub fn get(&self, key: &str) -> Option<Row<'a>> {
        self.0.get(key).filter(|value| !value.is_null()).map(Row)
    }

    pub fn object(&self, key: &str) -> Checked<Row<'a>> {
        self.get(key).filter(|row| row.0.is_object()).ok_or_else(|| Self::missing(key, "an object"))
    }

    pub fn whole(&self, key: &str) -> Checked<u64> {
        self.0.get(key).and_then(Value::as_u64).ok_or_else(|| Self::missing(key, "a whole number"))
    }

    pub fn integer(&self, key: &str) -> Checked<i64> {
        self.0.get(key).and_then(Value::as_i64).ok_or_else(|| Self::missing(key, "an integer"))
    }

    pub fn float(&self, key: &str) -> Checked<f64> {
        self.0.get(key).and_then(Value::as_f64).ok_or_else(|| Self::missing(key, "a number"))
    }

    pub fn text(&self, key: &str) -> Checked<&'a str> {
        self.0.get(key).and_then(Value::as_str).ok_or_else(|| Self::missing(key, "a text"))
    }

    pub fn flag(&self, key: &str) -> Checked<bool> {
        self.0.get(key).and_then(Value::as_bool).ok_or_else(|| Self::missing(key, "true or false"))
    }

    /// The ends of an enclosure in order; an end beyond all doubles is null, the other one the last double before it.
    pub fn ends(&self, key: &str) -> Checked<(f64, f64)> {
        let object = self.object(key)?;
        let end = |side: &str, beyond: f64| match object.get(side) {
            None => Ok(beyond),
            Some(_) => object.float(side),
        };
        let (lo, hi) = (end("lo", f64::NEG_INFINITY)?, end("hi", f64::INFINITY)?);
        let told = (lo.is_finite() || hi == f64::MIN) && (hi.is_finite() || lo == f64::MAX);
        if told && lo <= hi { Ok((lo, hi)) } else { Err(Self::missing(key, "an enclosure with lo <= hi")) }
    }

    /// The ends of a finite enclosure, exactly.
    pub fn enclosure(&self, key: &str) -> Checked<(Rational, Rational)> {
        let (lo, hi) = self.ends(key)?;
        let ends = rational::from_f64_exact(lo).zip(rational::from_f64_exact(hi));
        ends.ok_or_else(|| Self::missing(key, "a finite enclosure"))
    }

    /// p/q, written in lowest terms.
    pub fn ratio(&self) -> Checked<Ratio> {
        let (p, q) = (self.whole("p")?, self.whole("q")?);
        let ratio = Ratio::new(p, q).ok().filter(|ratio| ratio.terms() == (p, q));
        ratio.ok_or_else(|| Fault::Wrong(format!("{p}/{q} is no ratio in lowest terms")))
    }

    pub fn rational(&self, key: &str) -> Checked<Rational> {
        parse_rational(key, self.text(key)?).map_err(|error| Fault::Wrong(error.to_string()))
    }

    pub fn quantity(&self, key: &str) -> Checked<Laurent> {
        parse(key, self.text(key)?).map_err(|error| Fault::Wrong(error.to_string()))
    }

    pub fn rows(&self, key: &str) -> Checked<&'a [Value]> {
        self.0
            .get(key)
            .and_then(Value::as_array)
            .map(Vec::as_slice)
            .ok_or_else(|| Self::missing(key, "a list"))
    }
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

/// A field that the whole document must have.
pub fn whole<T>(field: Checked<T>) -> crate::error::Result<T> {
    field.map_err(|fault| match fault {
        Fault::Error(error) => error,
        Fault::Wrong(why) => {
            Error::input("document", why, "verify reads whole documents, as kickdrift wrote them")
        }
    })
}
