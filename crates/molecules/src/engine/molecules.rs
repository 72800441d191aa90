//! What a script of OpenMM's says of its molecules: bonds that are held, water, the masses of hydrogens. What
//! is not read is asked for.

use std::ops::Range;

use super::quantity::mass;
use super::reading::Reading;
use super::script::{Call, Script};
use crate::constraint::Constraints;
use crate::unit::decimal;

const UNREAD: &str = "the masses of hydrogens were not read: say them by --hmr";

/// Calls that make a system; more of them are none of a run.
const MOST_SYSTEMS: usize = 100;

pub(super) fn read(script: &Script, text: &str, reading: &mut Reading) {
    let systems = Systems::of(script, text);
    systems.bonds(reading);
    systems.masses(reading);
    if systems.mentions(&["setIntegrationForceGroups"]) {
        let remark = "setIntegrationForceGroups was not read: forces of other groups are never integrated";
        reading.remarks.push(remark.into());
    }
}

/// The calls that make systems.
struct Systems<'a> {
    script: &'a Script,
    text: &'a str,
    calls: Vec<Call<'a>>,
}

impl<'a> Systems<'a> {
    fn of(script: &'a Script, text: &'a str) -> Systems<'a> {
        let makes = |name: &str| ["createSystem", "create_system"].contains(&name);
        Systems { script, text, calls: script.calls(makes).take(MOST_SYSTEMS).collect() }
    }

    fn mentions(&self, names: &[&str]) -> bool {
        self.script.words().any(|(name, _)| names.contains(&name))
    }

    /// What each call gives for a keyword, the same ones once.
    fn values(&self, key: &str) -> Vec<Option<Range<usize>>> {
        let own = |call: &Call| {
            let arguments = self.script.arguments(call);
            arguments
                .into_iter()
                .find(|(name, _)| *name == Some(key))
                .map(|(_, range)| self.script.followed(range))
        };
        let mut values: Vec<Option<Range<usize>>> = self.calls.iter().map(own).collect();
        let shown = |range: &Option<Range<usize>>| range.clone().map(|range| &self.text[range]);
        values.dedup_by(|a, b| shown(a) == shown(b));
        values
    }

    fn bonds(&self, reading: &mut Reading) {
        let values = self.values("constraints");
        let last =
            |range: &Range<usize>| self.script.code()[range.clone()].rsplit('.').next().unwrap_or_default();
        let held = match &values[..] {
            [Some(range)] => Some(last(range)),
            _ => None,
        };
        reading.constraints = match held {
            Some("HBonds") => Some(Constraints::HBonds),
            Some("AllBonds" | "HAngles") => Some(Constraints::AllBonds),
            _ => None,
        };
        match (held, &reading.constraints) {
            (Some(own), Some(_)) => return reading.used.push(format!("constraints={own}")),
            (Some("None"), _) => {}
            _ if !values.iter().all(Option::is_none)
                || self.mentions(&["HBonds", "AllBonds", "HAngles", "addConstraint"]) =>
            {
                let remark = "which bonds are held was not read: say so by --constraints";
                return reading.remarks.push(remark.into());
            }
            _ => {}
        }
        let is_flexible =
            |range: &Option<Range<usize>>| range.clone().is_some_and(|range| &self.text[range] == "False");
        if !self.calls.is_empty() && !self.values("rigidWater").iter().all(is_flexible) {
            let remark =
                "water is rigid unless rigidWater=False: leave out the periods of its bonds and bends";
            reading.remarks.push(remark.into());
        }
    }

    fn masses(&self, reading: &mut Reading) {
        let values = self.values("hydrogenMass");
        let given = match &values[..] {
            [] | [None] => None,
            [Some(range)] => Some(range),
            _ => return reading.remarks.push(UNREAD.into()),
        };
        let range = given.filter(|given| &self.script.code()[(*given).clone()] != "None");
        match range.map(|range| mass(self.script, range.clone())) {
            Some(Some(size)) => {
                reading.used.push(format!("hydrogenMass={}", decimal(&size)));
                reading.hydrogen = Some(size);
            }
            None if given.is_some()
                || !["hydrogenMass", "setParticleMass"].iter().any(|text| self.text.contains(text)) => {}
            _ => reading.remarks.push(UNREAD.into()),
        }
    }
}
