//! Advice on Hessians: computed again, whole.

use serde_json::{Map, Value};

use crate::advise::Scheme;
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::recheck::context::{Context, Outcome, REMEDY};
use crate::recheck::system::same_values;
use crate::recheck::written::Written;
use crate::report::advise::of_molecule;
use crate::scene::SystemScene;

rows! {
    struct Input {
        #[serde(rename = "file")]
        _file: String,
        system: Value,
        band: Written<Rational>,
        schemes: Vec<Vec<Written<Rational>>>,
        length: Option<Written<Rational>>,
    }
}

/// `kickdrift/advise-system/1`.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(transparent)]
pub struct Claim(Map<String, Value>);

impl Claim {
    pub fn check(&self, context: &Context) -> Result<Outcome> {
        let input = self.0.get("input").cloned().unwrap_or_default();
        let input: Input = serde_json::from_value(input).map_err(|fault| {
            Error::input("input", "not what the schema says", format!("{fault}; {REMEDY}"))
        })?;
        let scene = SystemScene::from_json_in(&context.options.folder, input.system.clone())?;
        let steps =
            |own: &Vec<Written<Rational>>| Scheme::new(own.iter().map(|step| step.0.clone()).collect());
        let schemes = input.schemes.iter().map(steps).collect::<Result<Vec<_>>>()?;
        let length = input.length.as_ref().map(|length| &length.0);
        let findings = scene.molecule()?.0.advise(&schemes, &input.band, length)?;
        let mut told = self.0.clone();
        let engine = told.remove("engine");
        let again = of_molecule(&findings, None).value();
        let failures =
            context.failure(0, || "the document".into(), same_values(&told, &again))?.into_iter().collect();
        let mut not_rechecked = vec!["file: a name", "statement and source of published, unknown: words"];
        if engine.is_some() {
            not_rechecked.push("engine: its text is not part of the document");
        }
        let route = "computed again, by the same route: stiffnesses were measured";
        Ok(Outcome { rows: 1, route, sample: None, failures, not_rechecked })
    }
}
