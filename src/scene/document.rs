//! A scene as it is written: texts, not yet quantities.

use serde::Deserialize;
use serde_json::Value;

use crate::error::{Error, Result};

/// The schema that this version reads.
const SCHEMA: &str = "kickdrift/scene/1";

/// An exact quantity as it is written: a text, or a JSON number, whose digits are taken as they stand.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "Value")]
pub struct Quantity(pub String);

impl Quantity {
    /// What is given, read by a parser that names the field.
    pub(super) fn read<T>(
        given: Option<&Quantity>,
        field: &str,
        parse: impl Fn(&str, &str) -> Result<T>,
    ) -> Result<Option<T>> {
        given.map(|quantity| parse(field, &quantity.0)).transpose()
    }
}

impl TryFrom<Value> for Quantity {
    type Error = String;

    fn try_from(value: Value) -> std::result::Result<Self, String> {
        match value {
            Value::String(text) => Ok(Quantity(text)),
            Value::Number(number) => Ok(Quantity(number.to_string())),
            other => Err(format!("{other} is no quantity: write a number, or a text as \"pi^2/25\"")),
        }
    }
}

/// The fields of a scene file; all quantities are exact. See data/schema/scene.json.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// `kickdrift/scene/1`.
    pub schema: String,
    /// Shown on figures and summaries.
    pub title: Option<String>,
    /// The stiffness of the fast force, 1/time².
    pub lambda1: Option<Quantity>,
    /// The stiffness of the slow force, 1/time².
    pub lambda2: Option<Quantity>,
    /// The step pairs.
    pub grid: Option<Grid>,
    /// The curves (a, b).
    pub families: Option<Families>,
    /// Nearness to a resonance in units of T½.
    pub tolerance: Option<Quantity>,
    /// h2/h1 = p/q for products about one ratio.
    pub ratio: Option<Quantity>,
    /// The bound on p and q of exhaustive checks.
    pub max: Option<u64>,
    /// All coprime p + q up to this, for products about many ratios.
    pub max_sum: Option<u64>,
    /// lambda2/lambda1, in place of lambda2.
    pub rho: Option<Quantity>,
    /// Where closings are searched.
    pub rho_range: Option<Quantity>,
    /// The steps that tongues and the atlas show.
    pub window: Option<Window>,
    /// What the atlas's colours show: family or growth.
    pub colour: Option<String>,
    /// The products, `NAME` or `NAME.FORMAT`.
    pub want: Vec<String>,
}

/// All multiples of the steps in closed ranges `LO..HI`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// The spacing of both steps.
    pub step: Option<Quantity>,
    /// The spacing of h1, where it differs.
    pub step1: Option<Quantity>,
    /// The spacing of h2, where it differs.
    pub step2: Option<Quantity>,
    /// The range of h1.
    pub h1: Quantity,
    /// The range of h2.
    pub h2: Quantity,
}

/// Closed ranges `LO..HI` of the steps.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Window {
    pub h1: Quantity,
    pub h2: Quantity,
}

/// Ranges `LO..HI` of a and b, and samples a curve.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Families {
    pub a: Option<Quantity>,
    pub b: Option<Quantity>,
    pub samples: Option<u32>,
}

impl Document {
    pub(super) fn check_schema(&self) -> Result<()> {
        if self.schema == SCHEMA {
            return Ok(());
        }
        Err(Error::input("schema", &self.schema, format!("this version reads {SCHEMA}")))
    }
}
