//! One file, many systems: any number of it replaced by the values of a range.
//!
//! A path names the number as it stands in the file: `potentials.1.step`, `build.steps.0`, `potentials.bond.scale` (a
//! potential by its name), `potentials.0.springs.2.2`. A last key that is not there yet is added (`scale`, `phase`).

use serde_json::Value;

use super::SystemScene;
use super::array::Arrays;
use super::document::no_system;
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::number::parse::parse_rational;

/// The most values of an axis, and the most points of a map.
const MOST_POINTS: usize = 100_000;

/// The values that one number of the file takes: lo, lo + by, ... up to hi, exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub path: String,
    pub lo: Rational,
    pub hi: Rational,
    pub by: Rational,
}

impl Axis {
    /// From `PATH=LO..HI:BY`.
    ///
    /// # Errors
    /// A text of another form, an empty range, a step that is not positive, too many values.
    pub fn parse(text: &str) -> Result<Axis> {
        let form = || Error::input("scan", text, "write PATH=LO..HI:BY, as potentials.1.step=1/10..2:1/20");
        let (path, range) = text.split_once('=').ok_or_else(form)?;
        let (ends, by) = range.rsplit_once(':').ok_or_else(form)?;
        let (lo, hi) = ends.split_once("..").ok_or_else(form)?;
        let read = |text: &str| parse_rational("scan", text);
        let axis = Axis { path: path.trim().into(), lo: read(lo)?, hi: read(hi)?, by: read(by)? };
        if axis.by <= Rational::default() {
            return Err(Error::input("scan", text, "the spacing after the colon must be positive"));
        }
        if axis.lo > axis.hi {
            return Err(Error::input("scan", text, "the range is empty: write the smaller number first"));
        }
        let last = ((&axis.hi - &axis.lo) / &axis.by).floor().to_integer();
        if last >= MOST_POINTS.into() {
            return Err(Error::input(
                "scan",
                text,
                format!("at most {MOST_POINTS} values: choose a larger spacing"),
            ));
        }
        Ok(axis)
    }

    /// All values, increasing.
    pub fn values(&self) -> Vec<Rational> {
        let next = |x: &Rational| Some(x + &self.by).filter(|x| *x <= self.hi);
        std::iter::successors(Some(self.lo.clone()), next).collect()
    }
}

/// A system file with two of its numbers open.
#[derive(Clone, Debug)]
pub struct Scan {
    template: Value,
    arrays: Arrays,
    pub x: Axis,
    pub y: Axis,
}

impl Scan {
    /// From the text of a system file.
    ///
    /// # Errors
    /// As [`SystemScene::read`] at the first point; a path that leads nowhere; too many points.
    pub fn read(text: &str, x: Axis, y: Axis) -> Result<Scan> {
        Scan::read_in("", text, x, y)
    }

    /// From the text of a system file, and the folder that the files it refers to are in, or these arrays in memory.
    ///
    /// # Errors
    /// As [`SystemScene::read_in`] at the first point; a path that leads nowhere; too many points.
    pub fn read_in(arrays: impl Into<Arrays>, text: &str, x: Axis, y: Axis) -> Result<Scan> {
        let arrays = arrays.into();
        // The file itself has to be sound, whatever its numbers are replaced by.
        SystemScene::read_in(arrays.clone(), text)?;
        let template: Value = serde_json::from_str(text).map_err(no_system)?;
        let points = x.values().len().saturating_mul(y.values().len());
        if points > MOST_POINTS {
            return Err(Error::input(
                "scan",
                format!("{points} points"),
                format!("at most {MOST_POINTS}: choose larger spacings"),
            ));
        }
        let mut file = template.clone();
        let [first, second] = [&x, &y].map(|axis| place(&mut file, &axis.path).map(std::ptr::from_mut));
        if first? == second? {
            return Err(Error::input(
                "scan",
                &y.path,
                "is varied along both axes: name two numbers of the file",
            ));
        }
        let scan = Scan { template, arrays, x, y };
        scan.at(&scan.x.lo, &scan.y.lo)?;
        Ok(scan)
    }

    /// The system at one point.
    ///
    /// # Errors
    /// As [`SystemScene::read`].
    pub fn at(&self, x: &Rational, y: &Rational) -> Result<SystemScene> {
        let mut file = self.template.clone();
        for (axis, value) in [(&self.x, x), (&self.y, y)] {
            *place(&mut file, &axis.path)? = Value::String(value.to_string());
        }
        SystemScene::from_json_in(self.arrays.clone(), file)
    }
}

/// The place that a path names.
fn place<'a>(file: &'a mut Value, path: &str) -> Result<&'a mut Value> {
    let nowhere = |key: &str| {
        let remedy =
            format!("{key} is not in the file: name a number of it, as potentials.1.step or build.steps.0");
        Error::input("scan", path, remedy)
    };
    let keys: Vec<&str> = path.split('.').collect();
    let mut at = file;
    for (depth, &key) in keys.iter().enumerate() {
        let is_last = depth + 1 == keys.len();
        at = match at {
            Value::Object(map) => {
                if is_last && !key.is_empty() {
                    map.entry(key).or_insert(Value::Null)
                } else {
                    map.get_mut(key).ok_or_else(|| nowhere(key))?
                }
            }
            Value::Array(items) => {
                let named = |item: &Value| item.get("name").and_then(Value::as_str) == Some(key);
                let index = key.parse().ok().or_else(|| items.iter().position(named));
                index.and_then(|i: usize| items.get_mut(i)).ok_or_else(|| nowhere(key))?
            }
            _ => return Err(nowhere(key)),
        };
    }
    match at {
        Value::Null | Value::String(_) | Value::Number(_) => Ok(at),
        _ => Err(nowhere("such a number")),
    }
}
