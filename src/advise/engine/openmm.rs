//! OpenMM: integrators in Python, and serialized ones beside systems.
//!
//! `MTSIntegrator(dt, [(group, n), ...])` evaluates a force group n times in an outermost step dt, in half kicks nested by n. A group that has
//! forces and is not listed is never integrated, and OpenMM does not say so: that is an error here. So is a listed group without a force.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::quantity::time;
use super::reading::{Engine, Place, Reading, count, scheme, times};
use super::script::{Argument, Call, Script};
use super::{molecules, serialized, xml};
use crate::error::{Error, Result};
use crate::number::Rational;

/// Integrators with force groups; where dt is among their arguments.
const GROUPED: [(&str, usize); 2] = [("MTSLangevinIntegrator", 2), ("MTSIntegrator", 0)];

/// A script with more integrators than this is none of a run.
const MOST_INTEGRATORS: usize = 100;

/// Whether a text is a script of OpenMM: it imports it, or calls an integrator that OpenMM alone has.
pub(super) fn is_python(text: &str) -> bool {
    if !["openmm", "simtk", "MTS"].iter().any(|word| text.contains(word)) {
        return false;
    }
    let script = Script::new(text);
    let has = |names: &[&str]| script.words().any(|(name, _)| names.contains(&name));
    has(&["import"]) && has(&["openmm", "simtk"])
        || script.calls(|name| GROUPED.iter().any(|(own, _)| *own == name)).next().is_some()
}

pub(super) fn read(texts: &[&str]) -> Result<Reading> {
    let mut reading = None;
    for text in texts {
        let own = if xml::is_xml(text) { serialized::integrator(text)? } else { python(text)? };
        match (&reading, own) {
            (Some(_), Some(own)) => {
                let remedy = "is the second one: give the texts of one integrator";
                return Err(Error::input("integrator", own.used.join("; "), remedy));
            }
            (None, Some(own)) => reading = Some(own),
            (_, None) => {}
        }
    }
    let mut reading = reading.ok_or_else(|| {
        let remedy = "a system alone has no steps: give the integrator too, as Python text or serialized";
        Error::missing("integrator", remedy)
    })?;
    let mut groups = Groups::default();
    for text in texts {
        if xml::is_xml(text) {
            groups.is_whole |= serialized::groups(text, &mut groups.forces)?;
            let (held, remark) = serialized::held(text)?;
            reading.constraints = held.or(reading.constraints);
            reading.remarks.extend(remark);
        } else if !groups.is_whole {
            groups.read(text);
        }
    }
    groups.check(&mut reading)?;
    for force in &mut reading.forces {
        let names = force.strip_prefix("group ").and_then(|n| groups.forces.get(&n.parse().ok()?));
        if let Some(names) = names.filter(|names| !names.is_empty()) {
            *force = format!("{force} ({})", names.join(", "));
        }
    }
    Ok(reading)
}

/// The force groups that the texts give forces to.
#[derive(Default)]
struct Groups {
    /// With the names of their forces, where these are known.
    forces: BTreeMap<u64, Vec<String>>,
    /// These are all forces: a serialized system has them.
    is_whole: bool,
    /// The forces stand in a text that was read, and none is put into a group in a way that was not.
    is_read: bool,
    /// Some groups are no plain numbers.
    has_names: bool,
}

impl Groups {
    fn read(&mut self, text: &str) {
        let script = Script::new(text);
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

    /// That every group with forces is integrated, and every listed one has forces.
    fn check(&self, reading: &mut Reading) -> Result<()> {
        let listed: BTreeSet<u64> = reading
            .forces
            .iter()
            .flat_map(|force| force.split("group ").skip(1))
            .filter_map(|n| n.trim_end_matches([',', ' ']).parse().ok())
            .collect();
        if listed.is_empty() {
            return Ok(());
        }
        let shown = |groups: Vec<&u64>| {
            let noun = if groups.len() == 1 { "group" } else { "groups" };
            format!("{noun} {}", groups.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))
        };
        let missing: Vec<&u64> = self.forces.keys().filter(|group| !listed.contains(group)).collect();
        if !missing.is_empty() {
            let remedy = format!(
                "{} would never be integrated, and OpenMM does not say so: list every group that has forces",
                shown(missing)
            );
            return Err(Error::input(
                "force groups",
                format!(
                    "only {} listed",
                    shown(listed.iter().collect()).trim_start_matches("group").trim_start_matches('s').trim()
                ),
                remedy,
            ));
        }
        // Forces that are put into no group are in group 0.
        let is_known = self.is_whole || self.is_read && !self.has_names;
        let idle =
            listed.iter().filter(|group| !self.forces.contains_key(group) && (self.is_whole || **group != 0));
        let idle: Vec<&u64> = idle.collect();
        if is_known && !idle.is_empty() {
            let one = if idle.len() == 1 { "has" } else { "have" };
            let remedy = "put forces into it by setForceGroup: forces that are put into no group are all in group 0, and take its step";
            return Err(Error::input("force groups", format!("{} {one} no force", shown(idle)), remedy));
        }
        if self.has_names {
            reading.remarks.push("some force groups are set by variables, which are not followed: make sure that every group with forces is listed".into());
        } else if !is_known && self.forces.is_empty() {
            reading.remarks.push("no force is put into a group here: unless it is done elsewhere, all are in group 0, and take its step".into());
        }
        if !self.is_whole && !listed.contains(&0) {
            reading.remarks.push("group 0 is not listed: forces that are put into no group are in it, and would never be integrated".into());
        }
        Ok(())
    }
}

/// The one integrator of a script, with what it says of bonds and masses; `None` where it has none.
fn python(text: &str) -> Result<Option<Reading>> {
    let script = Script::new(text);
    let calls: Vec<Call> =
        script.calls(|name| name.ends_with("Integrator")).take(MOST_INTEGRATORS + 1).collect();
    if calls.len() > MOST_INTEGRATORS {
        let remedy = "give the text of one run";
        return Err(Error::input("integrator", format!("more than {MOST_INTEGRATORS} of them"), remedy));
    }
    let resets = script.calls(|name| name == "setStepSize").next();
    if let Some(call) = resets.filter(|_| !calls.is_empty()) {
        let value = format!("setStepSize({})", &text[call.inside]);
        let remedy =
            "sets another step than the integrator was made with: give the steps themselves, by --steps";
        return Err(Error::input("dt", value, remedy));
    }
    let mut reading: Option<Reading> = None;
    for call in &calls {
        let own = integrator(text, &script, call)?;
        match &mut reading {
            None => reading = Some(own),
            Some(first) if first.scheme == own.scheme && first.forces == own.forces => {
                first.places.extend(
                    own.places.into_iter().filter(|place| !first.places.contains(place)).collect::<Vec<_>>(),
                );
            }
            Some(first) => {
                let remedy = "take different steps: give the text with one of them";
                return Err(Error::input(
                    "integrator",
                    format!("{} and {}", first.used[0], own.used[0]),
                    remedy,
                ));
            }
        }
    }
    if let Some(reading) = &mut reading {
        molecules::read(&script, text, reading);
    }
    Ok(reading)
}

/// Called with these arguments.
fn integrator(text: &str, script: &Script, call: &Call) -> Result<Reading> {
    let arguments = script.arguments(call);
    let grouped = GROUPED.iter().find(|(name, _)| *name == call.name).map(|(_, first)| *first);
    let positional: Vec<&Range<usize>> =
        arguments.iter().filter(|(key, _)| key.is_none()).map(|(_, own)| own).collect();
    let keyword = |names: &[&str]| {
        arguments.iter().find(|(key, _)| key.is_some_and(|key| names.contains(&key))).map(|(_, own)| own)
    };
    let shown = || text[call.inside.clone()].split_whitespace().collect::<Vec<_>>().join(" ");
    let used = format!("{}({})", call.name, shown());
    let Some(first) = grouped.or_else(|| plain(call.name, positional.len(), &arguments)) else {
        let remedy = "is no integrator whose steps are read: give the steps themselves, by --steps";
        return Err(Error::input("integrator", used, remedy));
    };
    let form = || {
        let before = if first == 2 { "300*kelvin, 1/picosecond, " } else { "" };
        let behind = if grouped.is_some() { ", [(0,1),(1,8)]" } else { "" };
        Error::input(call.name, shown(), format!("write {}({before}4*femtoseconds{behind})", call.name))
    };
    let dt = keyword(&["dt", "stepSize", "timestep"])
        .or_else(|| positional.get(first).copied())
        .ok_or_else(form)?;
    let dt = time(script, text, dt.clone())?;
    let place = dt.place.clone().map(|(place, unit)| (place, Place::Outer(unit)));
    let mut reading = Reading::new(Engine::OpenMm, text, scheme(vec![dt.size])?);
    reading.used = vec![used];
    if grouped.is_some() {
        let list = keyword(&["groups"]).or_else(|| positional.get(first + 1).copied()).ok_or_else(form)?;
        levels(script, list.clone(), &mut reading, place)?;
    } else {
        reading.forces = vec!["all forces".into()];
        reading.places = place.into_iter().collect();
    }
    if first == 2 {
        reading
            .remarks
            .push("the thermostat's friction is not part of the verdict: it damps all modes alike".into());
    }
    Ok(reading)
}

/// Where dt is among the arguments of an integrator that kicks with all forces once a step; `None` for any other.
fn plain(name: &str, positional: usize, arguments: &[Argument]) -> Option<usize> {
    // Splittings of openmmtools may have several steps.
    let has_splitting = arguments.iter().any(|(key, _)| *key == Some("splitting"));
    match name {
        "VerletIntegrator" => Some(0),
        "NoseHooverIntegrator" if positional == 1 => Some(0),
        "LangevinIntegrator" if positional > 3 => None,
        _ if serialized::PLAIN.contains(&name) && !has_splitting => Some(2),
        _ => None,
    }
}

/// The groups of `MTSIntegrator` and its kind; dt stays theirs.
fn levels(
    script: &Script,
    list: Range<usize>,
    reading: &mut Reading,
    dt: Option<(Range<usize>, Place)>,
) -> Result<()> {
    let code = script.code();
    let list = script.followed(list);
    let shown = &code[list.clone()];
    if !(shown.starts_with('[') && script.is_bracketed(&list)) {
        return Err(Error::input(
            "groups",
            shown,
            "is not followed: write the list as [(0,1),(1,8)], or give the integrator as XmlSerializer.serialize writes it",
        ));
    }
    let mut entries: Vec<(u64, Option<Range<usize>>, u64)> = Vec::new();
    for pair in script.split(list.start + 1..list.end - 1) {
        let own = &code[pair.clone()];
        let bad =
            || Error::input("groups", own, "write each entry as (group, evaluations in an outermost step)");
        let is_pair = own.starts_with(['(', '[']) && script.is_bracketed(&pair);
        if !is_pair {
            return Err(bad());
        }
        let parts = script.split(pair.start + 1..pair.end - 1);
        let [group, n] = <[Range<usize>; 2]>::try_from(parts).map_err(|_| bad())?;
        let group = code[script.followed(group)].parse::<u64>().ok().filter(|g| *g < 32);
        let group = group
            .ok_or_else(|| Error::input("groups", own, "a force group is a whole number from 0 to 31"))?;
        if entries.iter().any(|(_, _, known)| *known == group) {
            return Err(Error::input(
                "groups",
                shown,
                format!("group {group} is listed twice, and would kick twice"),
            ));
        }
        let value = script.followed(n.clone());
        entries.push((count("groups", &code[value.clone()])?, Some(n).filter(|n| *n == value), group));
    }
    entries.sort_by_key(|(n, ..)| std::cmp::Reverse(*n));
    let Some((most, ..)) = entries.first() else {
        return Err(Error::input("groups", shown, "list at least one force group, as [(0,1),(1,8)]"));
    };
    if let Some(pair) = entries.windows(2).find(|pair| pair[0].0 % pair[1].0 != 0) {
        let remedy = format!("OpenMM refuses this: {} is no multiple of {}", pair[0].0, pair[1].0);
        return Err(Error::input("groups", shown, remedy));
    }
    let inner = reading.scheme.outer() / times(&Rational::from_integer(1.into()), *most);
    reading.scheme = scheme(entries.iter().map(|(n, ..)| times(&inner, most / n)).collect())?;
    let mut places: Vec<Option<(Range<usize>, Place)>> = vec![dt];
    let mut level = 0;
    for (i, (n, place, group)) in entries.iter().enumerate() {
        if i > 0 && entries[i - 1].0 != *n {
            level += 1;
        }
        match reading.forces.get_mut(level) {
            Some(forces) => *forces += &format!(", group {group}"),
            None => reading.forces.push(format!("group {group}")),
        }
        places.push(place.clone().map(|place| (place, Place::PerOuter(level))));
    }
    // With an outermost group that is itself evaluated more than once, dt stays: only then the counts do not determine the steps.
    let slowest = entries.last().map_or(1, |(n, ..)| *n);
    reading.places = places.into_iter().collect::<Option<_>>().filter(|_| slowest == 1).unwrap_or_default();
    Ok(())
}
