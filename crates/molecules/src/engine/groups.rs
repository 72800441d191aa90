//! The force groups of OpenMM's forces: each group with forces is integrated, and each that is listed has
//! forces.

use std::collections::{BTreeMap, BTreeSet};

use super::reading::Reading;
use super::script::Script;
use super::serialized;
use number::{Error, Result};

/// The force groups that the texts give forces to.
#[derive(Default)]
pub(super) struct Groups {
    /// With the names of their forces, where these are known.
    forces: BTreeMap<u64, Vec<String>>,
    /// These are all forces: a serialized system has them.
    is_whole: bool,
    /// A script that was read makes the forces.
    is_read: bool,
    /// Some groups are no plain numbers.
    has_names: bool,
}

impl Groups {
    /// Of serialized systems, or else of scripts.
    pub fn of(serialized: &[&str], scripts: &[&str]) -> Result<Groups> {
        let mut groups = Groups::default();
        for text in serialized {
            groups.is_whole |= serialized::groups(text, &mut groups.forces)?;
        }
        if !groups.is_whole {
            scripts.iter().for_each(|text| groups.read(&Script::new(text)));
        }
        Ok(groups)
    }

    fn read(&mut self, script: &Script) {
        let sets = |name: &str| {
            let lower = name.to_ascii_lowercase().replace('_', "");
            lower.contains("forcegroup") && !lower.starts_with("get") && name != "setIntegrationForceGroups"
        };
        for call in script.calls(sets) {
            let known = ["setForceGroup", "setReciprocalSpaceForceGroup"].contains(&call.name);
            let argument = script.followed(call.inside.clone());
            match script.code()[argument].parse::<u64>() {
                Ok(group) if known && group < 32 => drop(self.forces.entry(group).or_default()),
                _ => self.has_names = true,
            }
        }
        let makes = |name: &str| ["createSystem", "create_system", "addForce"].contains(&name);
        self.is_read |= script.calls(makes).next().is_some();
    }

    /// Names the forces of each clock.
    ///
    /// # Errors
    /// A group with forces that is not listed; one that is listed and has none.
    pub fn name(&self, reading: &mut Reading) -> Result<()> {
        let numbers = reading.forces.iter().flat_map(|force| force.split("group ").skip(1));
        let listed: BTreeSet<u64> =
            numbers.filter_map(|n| n.trim_end_matches([',', ' ']).parse().ok()).collect();
        if listed.is_empty() {
            return Ok(());
        }
        let missing: Vec<u64> = self.forces.keys().filter(|group| !listed.contains(group)).copied().collect();
        if !missing.is_empty() {
            let noun = if missing.len() == 1 { "group" } else { "groups" };
            let remedy = format!(
                "{noun} {} would never be integrated, and OpenMM does not say so: list every group that has forces",
                shown(&missing)
            );
            let value = format!("only {} listed", shown(&Vec::from_iter(listed)));
            return Err(Error::input("force groups", value, remedy));
        }
        self.none_is_idle(&listed)?;
        reading.remarks.extend(self.remarks(&listed).map(String::from));
        for force in &mut reading.forces {
            let names = force.strip_prefix("group ").and_then(|n| self.forces.get(&n.parse().ok()?));
            if let Some(names) = names.filter(|names| !names.is_empty()) {
                *force = format!("{force} ({})", names.join(", "));
            }
        }
        Ok(())
    }

    /// Whether all forces and their groups are known.
    fn is_known(&self) -> bool {
        self.is_whole || self.is_read && !self.has_names
    }

    fn none_is_idle(&self, listed: &BTreeSet<u64>) -> Result<()> {
        // Forces of a script that are put into no group are in group 0.
        let has_forces = |group: &u64| self.forces.contains_key(group) || *group == 0 && !self.is_whole;
        let idle: Vec<u64> = listed.iter().filter(|group| !has_forces(group)).copied().collect();
        if idle.is_empty() || !self.is_known() {
            return Ok(());
        }
        let (noun, has) = if idle.len() == 1 { ("group", "has") } else { ("groups", "have") };
        let remedy = "put forces into it by setForceGroup: forces that are put into no group are all in group 0, and take its step";
        Err(Error::input("force groups", format!("{noun} {} {has} no force", shown(&idle)), remedy))
    }

    /// What is to be made sure of where not all is known.
    fn remarks(&self, listed: &BTreeSet<u64>) -> impl Iterator<Item = &'static str> {
        let unknown = if self.has_names {
            Some(
                "some force groups are set by variables, which are not followed: make sure that every group with forces is listed",
            )
        } else if !self.is_known() && self.forces.is_empty() {
            Some(
                "no force is put into a group here: unless it is done elsewhere, all are in group 0, and take its step",
            )
        } else {
            None
        };
        let zero = !self.is_whole && !listed.contains(&0);
        let zero = zero.then_some(
            "group 0 is not listed: forces that are put into no group are in it, and would never be integrated",
        );
        unknown.into_iter().chain(zero)
    }
}

fn shown(groups: &[u64]) -> String {
    groups.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
