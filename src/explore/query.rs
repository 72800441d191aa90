//! An address's parameters, percent-decoded once, as typed quantities.

use std::collections::BTreeMap;

use num_bigint::BigUint;

use super::session::Session;
use clocks::tongue::Stiffness;
use documents::question::StepRange;
use number::parse::{parse, parse_range, parse_rational};
use number::{Error, Laurent, Rational, Result};

/// Parameters of one address, each given once.
#[derive(Debug, Default)]
pub(super) struct Query(BTreeMap<String, String>);

/// The most parameters, and the longest value in bytes: 200 levels need 70 digits a coordinate.
const MOST: usize = 32;
const LONGEST: usize = 2000;

impl Query {
    /// # Errors
    /// Too many parameters, one given twice, one too long, an escape that is none.
    pub fn parse(text: &str) -> Result<Query> {
        let mut found = BTreeMap::new();
        for part in text.split('&').filter(|part| !part.is_empty()) {
            let (key, value) = part.split_once('=').unwrap_or((part, ""));
            let (key, value) = (decoded(key)?, decoded(value)?);
            if value.len() > LONGEST {
                return Err(Error::input(&key, value, format!("is longer than {LONGEST} bytes")));
            }
            if found.len() == MOST {
                return Err(Error::input("query", text, format!("has more than {MOST} parameters")));
            }
            if let Some(before) = found.insert(key.clone(), value) {
                return Err(Error::input(&key, before, "is given twice; give it once"));
            }
        }
        Ok(Query(found))
    }

    /// The text of a parameter, empty ones taken as absent.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str).filter(|text| !text.is_empty())
    }

    /// Parses a parameter, if it is there.
    pub fn read<T>(&self, key: &str, parse: impl Fn(&str, &str) -> Result<T>) -> Result<Option<T>> {
        self.text(key).map(|text| parse(key, text)).transpose()
    }

    /// Parses a parameter that must be there.
    pub fn need<T>(&self, key: &str, parse: impl Fn(&str, &str) -> Result<T>) -> Result<T> {
        self.read(key, parse)?.ok_or_else(|| Error::missing(key, format!("add {key}=... to the address")))
    }

    /// The stiffnesses: as given, or the session's; `rho` in place of the slow one.
    pub fn stiffnesses(&self, session: &Session) -> Result<(Laurent, Laurent)> {
        let pair = session.stiffnesses();
        let known = |given: Option<Laurent>, value: Option<&Laurent>, key: &str| {
            given
                .or(value.cloned())
                .ok_or_else(|| Error::missing(key, "the file has no two stiffnesses: give them"))
        };
        let lambda1 = known(self.read("lambda1", parse)?, pair.map(|pair| &pair.0), "lambda1")?;
        let lambda2 = match self.read("rho", parse_rational)? {
            Some(rho) => &Laurent::from_rational(rho) * &lambda1,
            None => known(self.read("lambda2", parse)?, pair.map(|pair| &pair.1), "lambda2")?,
        };
        let both = (lambda1, lambda2);
        Session::shows(&both)?;
        Ok(both)
    }

    /// λ1 and ρ ≥ 0, for tongues.
    pub fn stiffness(&self, session: &Session) -> Result<Stiffness> {
        let (lambda1, lambda2) = self.stiffnesses(session)?;
        Stiffness::new(None, Some(lambda1), Some(lambda2))
    }

    /// The window of steps: as given, or the session's.
    pub fn window(&self, session: &Session) -> Result<[StepRange; 2]> {
        let [h1, h2] = [("h1", 0), ("h2", 1)].map(|(key, n)| {
            let given = self.read(key, parse_range)?.unwrap_or_else(|| session.window()[n].clone());
            if !(given.0.to_f64().is_finite() && given.1.to_f64().is_finite()) {
                let range = format!("{}..{}", given.0, given.1);
                return Err(Error::input(key, range, "is beyond doubles: choose another unit of time"));
            }
            if given.0 < given.1 {
                return Ok(given);
            }
            Err(Error::input(
                key,
                format!("{}..{}", given.0, given.1),
                "has no width: write the smaller step first",
            ))
        });
        Ok([h1?, h2?])
    }
}

/// A positive exact number.
pub(super) fn positive(field: &str, text: &str) -> Result<Rational> {
    let x = parse_rational(field, text)?;
    if x > Rational::default() { Ok(x) } else { Err(Error::input(field, text, "must be positive")) }
}

/// So many evenly spaced numbers, both ends included.
pub(super) fn spaced((lo, hi): &(Rational, Rational), samples: u64) -> Vec<Rational> {
    let whole = |n: u64| Rational::from_integer(n.into());
    let part = (hi - lo) / whole(samples - 1);
    (0..samples).map(|k| lo + &part * whole(k)).collect()
}

/// A whole number in digits.
pub(super) fn whole(field: &str, text: &str) -> Result<BigUint> {
    let digits = text.bytes().all(|byte| byte.is_ascii_digit());
    let number = digits.then(|| text.parse().ok()).flatten();
    number.ok_or_else(|| Error::input(field, text, "write a whole number in digits, 0 or more"))
}

/// A whole number within a range.
pub(super) fn count(lo: u64, hi: u64) -> impl Fn(&str, &str) -> Result<u64> {
    move |field, text| {
        let number = whole(field, text)?;
        let within = u64::try_from(number).ok().filter(|number| (lo..=hi).contains(number));
        within.ok_or_else(|| Error::input(field, text, format!("choose {lo} to {hi}")))
    }
}

fn decoded(text: &str) -> Result<String> {
    let wrong = || Error::input("query", text, "has an escape that is none, or is not UTF-8");
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'+' => b' ',
            b'%' => {
                let mut digit = || rest.next().and_then(|byte| char::from(byte).to_digit(16));
                let (high, low) = (digit().ok_or_else(wrong)?, digit().ok_or_else(wrong)?);
                (16 * high + low) as u8
            }
            plain => plain,
        });
    }
    String::from_utf8(bytes).map_err(|_| wrong())
}
