//! One file, many systems: any number of it replaced by the values of a range.
//!
//! A path names the number as it stands in the file: `potentials.1.step`, `build.steps.0`,
//! `potentials.bond.scale` (a potential by its name), `potentials.0.springs.2.2`. A last key that is not
//! there yet is added (`scale`, `phase`). An entry of a symmetric matrix off its diagonal is both:
//! `mass_matrix.0.1` is `mass_matrix.1.0`, too. `outer` is the longest step, all steps in their ratios.

use std::fmt::{Display, Formatter};
use std::str::FromStr;
use std::sync::Arc;

use serde_json::Value;

use super::part::Number;
use super::{SystemScene, sparse, with_method};
use number::parse::parse_rational;
use number::{Error, Rational, Result};

/// The most values of an axis, and the most points of a map.
pub(super) const MOST_POINTS: usize = 100_000;

/// The path that means all steps in their ratios, by the longest one.
pub(crate) const OUTER: &str = "outer";

/// The values that one number of the file takes: lo, lo + by, ... up to hi, exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    text: String,
    pub path: String,
    pub lo: Rational,
    pub hi: Rational,
    pub by: Rational,
}

impl FromStr for Axis {
    type Err = Error;

    /// From `PATH=LO..HI:BY`.
    ///
    /// # Errors
    /// A text of another form, an empty range, a step that is not positive, too many values.
    fn from_str(text: &str) -> Result<Axis> {
        let form = || Error::input("scan", text, "write PATH=LO..HI:BY, as potentials.1.step=1/10..2:1/20");
        let (path, range) = text.split_once('=').ok_or_else(form)?;
        let (ends, by) = range.rsplit_once(':').ok_or_else(form)?;
        let (lo, hi) = ends.split_once("..").ok_or_else(form)?;
        let read = |text: &str| parse_rational("scan", text);
        let (path, text) = (path.trim().into(), text.to_string());
        let axis = Axis { path, lo: read(lo)?, hi: read(hi)?, by: read(by)?, text };
        if axis.by <= Rational::default() {
            return Err(Error::input("scan", &axis, "the spacing after the colon must be positive"));
        }
        if axis.lo > axis.hi {
            return Err(Error::input("scan", &axis, "the range is empty: write the smaller number first"));
        }
        let last = ((&axis.hi - &axis.lo) / &axis.by).floor().to_integer();
        if last >= MOST_POINTS.into() {
            let remedy = format!("at most {MOST_POINTS} values: choose a larger spacing");
            return Err(Error::input("scan", &axis, remedy));
        }
        Ok(axis)
    }
}

impl Display for Axis {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

impl Axis {
    /// All values, increasing.
    pub fn values(&self) -> Vec<Rational> {
        let next = |x: &Rational| Some(x + &self.by).filter(|x| *x <= self.hi);
        std::iter::successors(Some(self.lo.clone()), next).collect()
    }
}

/// A system with one or two of its numbers open.
#[derive(Clone, Debug)]
pub struct Scan {
    scene: SystemScene,
    pub x: Axis,
    /// `None`: along x alone.
    pub y: Option<Axis>,
}

impl Scan {
    /// Of a system, whatever these numbers are in it; its accuracy, and whether it keeps rigid motions, stay
    /// as they are.
    ///
    /// # Errors
    /// As [`SystemScene::read`] at the first point; a path that leads nowhere; too many points.
    pub fn new(scene: SystemScene, x: Axis, y: Option<Axis>) -> Result<Scan> {
        if !scene.model().is_at_one_place() {
            let remedy = "varies no number of Hessians along an orbit: another step has another orbit";
            return Err(Error::input("scan", &x.path, remedy));
        }
        let points = x.values().len().saturating_mul(y.as_ref().map_or(1, |y| y.values().len()));
        if points > MOST_POINTS {
            let remedy = format!("at most {MOST_POINTS}: choose larger spacings");
            return Err(Error::input("scan", format!("{points} points"), remedy));
        }
        let mut file = scene.source().clone();
        let mut find = |axis: &Axis| place(&mut file, &axis.path, "scan").map(std::ptr::from_mut);
        if let (first, Some(y)) = (find(&x)?, &y)
            && first == find(y)?
        {
            let remedy = "is varied along both axes: name two numbers of the file";
            return Err(Error::input("scan", &y.path, remedy));
        }
        let scan = Scan { scene, x, y };
        scan.at(&scan.x.lo, &scan.ys()[0])?;
        Ok(scan)
    }

    /// The values along y; 0 alone where there is no such axis.
    pub fn ys(&self) -> Vec<Rational> {
        self.y.as_ref().map_or_else(|| vec![Rational::default()], Axis::values)
    }

    /// The paths of the numbers that are open.
    pub fn names(&self) -> Vec<String> {
        [Some(&self.x), self.y.as_ref()].into_iter().flatten().map(|axis| axis.path.clone()).collect()
    }

    /// The system at one point; y is not looked at where there is no such axis.
    ///
    /// # Errors
    /// As [`SystemScene::read`].
    pub fn at(&self, x: &Rational, y: &Rational) -> Result<SystemScene> {
        let second = self.y.as_ref().map(|axis| (axis.path.as_str(), y));
        let numbers: Vec<_> = [Some((self.x.path.as_str(), x)), second].into_iter().flatten().collect();
        self.scene.with("scan", &numbers)
    }
}

impl SystemScene {
    /// The number at a path in words, and the power of time in its unit: `potentials.soft.step` is the step
    /// of soft, a time.
    pub fn number(&self, path: &str) -> (String, i8) {
        let keys: Vec<&str> = path.split('.').collect();
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), String::from);
        let ends = |value: &Value, keys: [&str; 2]| {
            let ends = keys.map(|key| match key.parse::<usize>() {
                Ok(i) => value.get(i).map_or(Value::Null, Value::clone),
                Err(_) => value.get(key).map_or(Value::Null, Value::clone),
            });
            let shown = ends.iter().filter(|end| !end.is_null()).map(text).collect::<Vec<_>>();
            if shown.len() < 2 { format!("{} to its place", shown.concat()) } else { shown.join("–") }
        };
        // Of keys alone: names stay as they are.
        let plain = |keys: &str| keys.replace('_', " ");
        let words = match keys[..] {
            ["outer"] => "outer step".into(),
            ["masses", i] => format!("mass of particle {i}"),
            ["potentials", own, ref rest @ ..] => {
                let potential = found(&self.source["potentials"], own);
                let name =
                    potential["name"].as_str().map_or_else(|| format!("potential {own}"), String::from);
                match *rest {
                    ["springs", k, "2"] => {
                        format!("spring {} of {name}", ends(found(&potential["springs"], k), ["0", "1"]))
                    }
                    ["bonds", k, key] => {
                        format!("{key} of bond {} of {name}", ends(found(&potential["bonds"], k), ["i", "j"]))
                    }
                    [key] => format!("{} of {name}", plain(key)),
                    ref keys => format!("{} of {name}", plain(&keys.join(" "))),
                }
            }
            ["build" | "mesh", "steps", i] => format!("step {i}"),
            ["build" | "mesh", ref rest @ ..] => plain(&rest.join(" ")),
            ref keys => plain(&keys.join(" ")),
        };
        let last = keys.iter().rfind(|key| key.parse::<usize>().is_err());
        let time = match last {
            Some(&("outer" | "step" | "steps" | "phase")) => 1,
            Some(&"friction") => -1,
            _ => 0,
        };
        (words, time)
    }

    /// This file with other numbers at some of its paths; `field` is what errors name.
    pub fn with(&self, field: &str, numbers: &[(&str, &Rational)]) -> Result<SystemScene> {
        let mut file = self.source.clone();
        for (path, value) in numbers.iter().filter(|(path, _)| *path != OUTER) {
            *place(&mut file, path, field)? = Value::String(value.to_string());
            if let Some(mirrored) = mirrored(path) {
                *place(&mut file, &mirrored, field)? = Value::String(value.to_string());
            }
        }
        if let Some((_, outer)) = numbers.iter().find(|(path, _)| *path == OUTER) {
            scale_steps(&mut file, outer, field)?;
        }
        let is_step = |(path, _): &(&str, &Rational)| {
            *path == OUTER || path.starts_with("potentials.") && path.ends_with(".step")
        };
        if let Some(sparse_system) = self.model.sparse()
            && numbers.iter().all(is_step)
            && let Some(sparse_system) = sparse::with_steps(sparse_system, [&self.source, &file])?
        {
            return Ok(SystemScene { source: file, model: Arc::new(sparse_system), ..self.clone() });
        }
        let mut scene = SystemScene::from_json_in(self.arrays.clone(), file).map_err(|error| {
            // The file itself was read: a key was added that no system has.
            if error.field() == "system" { unknown_path(&self.source, field, numbers) } else { error }
        })?;
        let method = self.model.method();
        if scene.model.method() != method {
            scene.model = with_method(scene.model, scene.bonds.as_ref(), method)?;
        }
        Arc::get_mut(&mut scene.model).expect("just read").copy_settings_from(self.model());
        Ok(scene)
    }
}

/// All steps of a file in their ratios, the longest one this.
fn scale_steps(file: &mut Value, outer: &Rational, field: &str) -> Result<()> {
    if *outer <= Rational::default() {
        return Err(Error::input(field, outer, "steps are positive"));
    }
    let mut steps: Vec<&mut Value> = Vec::new();
    for (key, value) in file.as_object_mut().into_iter().flatten() {
        match (key.as_str(), value) {
            ("potentials", Value::Array(all)) => {
                steps.extend(all.iter_mut().filter_map(|value| value.get_mut("step")));
            }
            ("build" | "mesh", Value::Object(object)) => {
                for (key, value) in object.iter_mut() {
                    match (key.as_str(), value) {
                        ("step", value) => steps.push(value),
                        ("steps", Value::Array(all)) => steps.extend(all),
                        _ => {}
                    }
                }
            }
            _ => {}
        }
    }
    let read = |value: &&mut Value| Number::from((**value).clone()).read("step");
    let given = steps.iter().map(read).collect::<Result<Vec<_>>>()?;
    let longest =
        given.iter().max().cloned().filter(|value| *value > Rational::default()).ok_or_else(|| {
            Error::input(field, OUTER, "the file has no steps: name another number of it, as mesh.courant")
        })?;
    let factor = outer / longest;
    steps.into_iter().zip(given).for_each(|(value, step)| *value = (step * &factor).to_string().into());
    Ok(())
}

/// That one of these paths leads to no number of a system, and which ones of the file end like it.
fn unknown_path(file: &Value, field: &str, numbers: &[(&str, &Rational)]) -> Error {
    let mut known = Vec::new();
    number_paths(file, "", &mut known);
    let is_new = |path: &&str| *path != OUTER && !known.iter().any(|own| own == path);
    let path = numbers.iter().map(|(path, _)| *path).find(is_new).unwrap_or(OUTER);
    let last = path.rsplit('.').next();
    let like: Vec<&str> = known
        .iter()
        .map(String::as_str)
        .filter(|own| own.rsplit('.').next() == last)
        .take(MOST_LIKE)
        .collect();
    let remedy = match &like[..] {
        [] => "is no number of a system: name one of the file, as potentials.1.step or build.steps.0".into(),
        like => format!("is no number of the file; did you mean {}?", like.join(" or ")),
    };
    Error::input(field, path, remedy)
}

/// The most paths of which one may be meant.
const MOST_LIKE: usize = 3;

/// The paths of all numbers and texts in a file.
fn number_paths(value: &Value, path: &str, known: &mut Vec<String>) {
    let below = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| number_paths(value, &below(key), known)),
        Value::Array(all) => {
            all.iter().enumerate().for_each(|(n, value)| number_paths(value, &below(&n.to_string()), known));
        }
        Value::Number(_) | Value::String(_) => known.push(path.into()),
        Value::Null | Value::Bool(_) => (),
    }
}

/// The path of the entry (j, i) of a symmetric matrix for that of (i, j), i ≠ j.
fn mirrored(path: &str) -> Option<String> {
    let mut keys: Vec<&str> = path.split('.').collect();
    let k = keys.len().checked_sub(3)?;
    let is_apart = keys[k + 1..].iter().all(|key| key.parse::<usize>().is_ok()) && keys[k + 1] != keys[k + 2];
    keys.swap(k + 1, k + 2);
    (is_apart && ["mass_matrix", "stiffness"].contains(&keys[k])).then(|| keys.join("."))
}

/// An item by its place or its name; nothing where there is none.
pub(super) fn found<'a>(items: &'a Value, key: &str) -> &'a Value {
    let all = items.as_array().map_or(&[][..], Vec::as_slice);
    let named = || all.iter().position(|item| item["name"].as_str() == Some(key));
    key.parse().ok().or_else(named).and_then(|i: usize| all.get(i)).unwrap_or(&Value::Null)
}

/// The place that a path names.
pub(super) fn place<'a>(file: &'a mut Value, path: &str, field: &str) -> Result<&'a mut Value> {
    let example = if file.get("build").is_some() { "build.steps.0" } else { "potentials.1.step" };
    let nowhere = |key: &str| {
        let remedy = format!("{key} is not in the file: name a number of it, as {example}");
        Error::input(field, path, remedy)
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
                let named = |item: &Value| item["name"].as_str() == Some(key);
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
