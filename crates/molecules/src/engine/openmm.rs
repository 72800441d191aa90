//! OpenMM: integrators in Python, and serialized ones beside systems.
//!
//! `MTSIntegrator(dt, [(group, n), ...])` evaluates a force group n times in an outermost step dt, in half
//! kicks nested by n. A group that has forces and is not listed is never integrated, and OpenMM does not say
//! so: that is an error here. So is a listed group without a force.

use std::ops::Range;

use super::groups::Groups;
use super::quantity::time;
use super::reading::{Engine, Place, Reading, count, scheme, times};
use super::script::{Argument, Call, Script};
use super::{molecules, serialized, xml};
use number::{Error, Rational, Result};

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
        || script.calls(|name| GROUPED.iter().any(|(text, _)| *text == name)).next().is_some()
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
        let remedy = if texts.iter().any(|text| xml::is_xml(text)) {
            "a system alone has no steps: give the integrator too, as Python text or serialized"
        } else {
            "the text names OpenMM and makes no integrator: give the script that does, or the steps themselves"
        };
        Error::missing("integrator", remedy)
    })?;
    let (serialized, scripts): (Vec<&str>, Vec<&str>) = texts.iter().partition(|text| xml::is_xml(text));
    for text in &serialized {
        let (held, remark) = serialized::held(text)?;
        reading.constraints = held.or(reading.constraints);
        reading.remarks.extend(remark);
    }
    Groups::of(&serialized, &scripts)?.name(&mut reading)?;
    Ok(reading)
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
        let Some(first) = &mut reading else {
            reading = Some(own);
            continue;
        };
        if first.scheme != own.scheme || first.forces != own.forces {
            let value = format!("{} and {}", first.used[0], own.used[0]);
            let remedy = "take different steps: give the text with one of them";
            return Err(Error::input("integrator", value, remedy));
        }
        // A number behind a name has one place.
        for place in own.places {
            if !first.places.contains(&place) {
                first.places.push(place);
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
        arguments.iter().filter(|(key, _)| key.is_none()).map(|(_, range)| range).collect();
    let keyword = |names: &[&str]| {
        arguments.iter().find(|(key, _)| key.is_some_and(|key| names.contains(&key))).map(|(_, range)| range)
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
    let followed = script.followed(dt.clone());
    let names = (followed != *dt && !text[dt.clone()].starts_with('('))
        .then(|| format!("{} = {}", &text[dt.clone()], &text[followed]));
    let dt = time(script, text, dt.clone())?;
    let place = dt.place.clone().map(|(place, unit)| (place, Place::Outer(unit)));
    let mut reading = Reading::new(Engine::OpenMm, text, scheme(vec![dt.size])?);
    reading.used = [used].into_iter().chain(names).collect();
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

/// Where dt is among the arguments of an integrator that kicks with all forces once a step; `None` for any
/// other.
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
    let mut entries = entries(script, &list)?;
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
    // With an outermost group that is itself evaluated more than once, dt stays: only then the counts do not
    // determine the steps.
    let slowest = entries.last().map_or(1, |(n, ..)| *n);
    reading.places = places.into_iter().collect::<Option<_>>().filter(|_| slowest == 1).unwrap_or_default();
    Ok(())
}

/// A group's evaluations in an outermost step, where the number stands if it is no name, and the group.
type Entry = (u64, Option<Range<usize>>, u64);

fn entries(script: &Script, list: &Range<usize>) -> Result<Vec<Entry>> {
    let code = script.code();
    let mut entries: Vec<Entry> = Vec::new();
    for pair in script.split(list.start + 1..list.end - 1) {
        let text = &code[pair.clone()];
        let bad =
            || Error::input("groups", text, "write each entry as (group, evaluations in an outermost step)");
        if !(text.starts_with(['(', '[']) && script.is_bracketed(&pair)) {
            return Err(bad());
        }
        let parts = script.split(pair.start + 1..pair.end - 1);
        let [group, n] = <[Range<usize>; 2]>::try_from(parts).map_err(|_| bad())?;
        let group = code[script.followed(group)].parse::<u64>().ok().filter(|g| *g < 32);
        let range = || Error::input("groups", text, "a force group is a whole number from 0 to 31");
        let group = group.ok_or_else(range)?;
        if entries.iter().any(|(_, _, known)| *known == group) {
            let remedy = format!("group {group} is listed twice, and would kick twice");
            return Err(Error::input("groups", text, remedy));
        }
        let value = script.followed(n.clone());
        entries.push((count("groups", &code[value.clone()])?, Some(n).filter(|n| *n == value), group));
    }
    Ok(entries)
}
