//! The fields of a system file as they are written.

use num_traits::ToPrimitive;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use crate::input::json;
use number::error::{Error, Result};
use number::parse::{parse, parse_rational};
use number::{Laurent, Rational};

/// The sizes of steps, and of the ends of a range: their squares are doubles, too.
pub(super) const SIZES: std::ops::RangeInclusive<f64> = 1e-150..=1e150;

/// The most degrees of freedom: dense matrices of this size still fit.
pub(super) const LARGEST: usize = 4096;

/// An exact number: a text, or a JSON number, whose digits are taken as they stand. Anything else is kept
/// until a reader can name its field.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "Value")]
pub(super) enum Number {
    Text(String),
    Json(String),
    Other(Value),
}

impl From<Value> for Number {
    fn from(value: Value) -> Self {
        match value {
            Value::String(text) => Number::Text(text),
            Value::Number(number) => Number::Json(number.as_str().into()),
            other => Number::Other(other),
        }
    }
}

impl Number {
    fn text(&self, field: &str) -> Result<&str> {
        match self {
            Number::Text(text) | Number::Json(text) => Ok(text),
            Number::Other(value) => {
                Err(Error::input(field, value, "write an exact number, as \"1/4\" or 0.25"))
            }
        }
    }

    /// As a rational.
    pub fn read(&self, field: &str) -> Result<Rational> {
        parse_rational(field, self.text(field)?)
    }

    /// As an element of ℚ\[π, 1/π\].
    pub fn read_laurent(&self, field: &str) -> Result<Laurent> {
        parse(field, self.text(field)?)
    }

    /// As a count of at most `most`.
    pub fn count(&self, field: &str, most: usize) -> Result<usize> {
        let value = self.read(field)?;
        let count = value.is_integer().then(|| value.to_integer().to_usize()).flatten();
        let remedy = || Error::input(field, &value, format!("write a whole number of at most {most}"));
        count.filter(|&n| n <= most).ok_or_else(remedy)
    }

    /// As an index below n.
    pub fn index(&self, field: &str, n: usize) -> Result<usize> {
        let remedy = || format!("indices are 0 to {}", n.max(1) - 1);
        match self {
            Number::Json(digits) => {
                let index = digits.parse().ok().filter(|&i: &usize| i < n);
                index.ok_or_else(|| Error::input(field, digits, remedy()))
            }
            Number::Text(text) => {
                Err(Error::input(field, text, format!("write an index without quotes; {}", remedy())))
            }
            Number::Other(value) => Err(Error::input(field, value, remedy())),
        }
    }
}

/// That a text names no more degrees of freedom than dense matrices may have, its lists counted before their
/// elements are built.
pub(super) fn check_lengths(text: &str) -> Result<()> {
    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct Lengths {
        masses: Vec<IgnoredAny>,
        mass_matrix: Vec<IgnoredAny>,
        near: Vec<IgnoredAny>,
    }
    // Whatever is written otherwise is named by who reads it.
    let Lengths { masses, mass_matrix, near } = serde_json::from_str(text).unwrap_or_default();
    let all = [("masses", masses.len()), ("mass_matrix", mass_matrix.len()), ("near", near.len())];
    all.into_iter().try_for_each(|(field, n)| at_most(field, n))
}

/// That a list of one number for each degree of freedom is no longer than their largest number.
pub(super) fn at_most(field: &str, n: usize) -> Result<()> {
    if n <= LARGEST {
        return Ok(());
    }
    Err(Error::input(field, n, format!("at most {LARGEST} degrees of freedom")))
}

/// A system file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    pub schema: String,
    #[serde(rename = "title")]
    _title: Option<String>,
    #[serde(rename = "time_unit")]
    _time_unit: Option<String>,
    pub masses: Option<Vec<Number>>,
    pub mass_matrix: Option<Vec<Vec<Number>>>,
    pub potentials: Option<Vec<PotentialDocument>>,
    pub near: Option<Vec<Number>>,
    pub build: Option<Build>,
    pub mesh: Option<MeshDocument>,
    pub labels: Option<Vec<String>>,
    pub friction: Option<Number>,
    pub symmetric: Option<bool>,
    pub scheme: Option<String>,
    pub method: Option<String>,
    pub levels: Option<Vec<LevelDocument>>,
}

/// What takes substeps, see the reader of local steps.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LevelDocument {
    pub fine: Option<Vec<Number>>,
    pub elements: Option<Vec<Number>>,
    pub substeps: Number,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PotentialDocument {
    /// For people, and for paths of scans.
    #[serde(rename = "name")]
    _name: Option<String>,
    pub step: Number,
    pub phase: Option<Number>,
    /// A factor of all that the potential holds.
    pub scale: Option<Number>,
    #[serde(default)]
    pub springs: Vec<(Number, Option<Number>, Number)>,
    pub stiffness: Option<Vec<Vec<Number>>>,
    #[serde(default)]
    pub bonds: Vec<BondDocument>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BondDocument {
    pub i: Number,
    pub j: Option<Number>,
    pub form: String,
    pub k: Option<Number>,
    pub beta: Option<Number>,
    pub epsilon: Option<Number>,
    pub sigma: Option<Number>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Build {
    Chain { masses: Number, stiffness: Vec<Number>, steps: Vec<Number> },
    StiffSoft { pairs: Number, stiff: Number, steps: [Number; 2] },
    GradedBar { elements: Number, classes: Number, courant: Number },
    TetheredPair { masses: [Number; 2], stiffness: [Number; 2], steps: [Number; 2] },
}

/// Finite elements, see the reader of meshes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshDocument {
    pub nodes: Vec<Vec<Number>>,
    pub elements: Vec<Vec<Number>>,
    #[serde(default)]
    pub fixed: Vec<Fixed>,
    pub young: Number,
    pub density: Number,
    pub poisson: Option<Number>,
    pub thickness: Option<Number>,
    pub plane: Option<Plane>,
    pub step: Option<Number>,
    pub steps: Option<Vec<Number>>,
    pub classes: Option<Vec<Number>>,
    pub courant: Option<Number>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "this is neither a node nor a node and an axis, as 3 or [3, 1]")]
pub(super) enum Fixed {
    Axis([Number; 2]),
    Node(Number),
}

#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Plane {
    Stress,
    Strain,
}

/// The two ends of what joins i and j, j `None` for a wall.
pub(super) fn ends(field: &str, i: &Number, j: Option<&Number>, n: usize) -> Result<(usize, Option<usize>)> {
    let i = i.index(field, n)?;
    let j = j.map(|j| j.index(field, n)).transpose()?;
    if j == Some(i) {
        return Err(Error::input(field, i, "joins two different indices, or one and null"));
    }
    Ok((i, j))
}

/// Why a text is no system.
pub(super) fn no_system(cause: serde_json::Error) -> Error {
    let (line, column) = (cause.line(), cause.column());
    let place = if line > 0 { format!("line {line}, column {column}") } else { "this file".into() };
    Error::input(
        "system",
        place,
        format!(
            "{}; write one JSON object as in data/scenes/diatomic-tether.json",
            json::plain(&cause).trim_end_matches('?')
        ),
    )
}
