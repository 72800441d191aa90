//! OpenMM: `MTSIntegrator` and `MTSLangevinIntegrator` in Python, and serialized integrators and systems.
//!
//! `MTSIntegrator(dt, [(group, n), ...])` evaluates a force group n times in an outermost step dt, in half kicks nested by n. A group that has
//! forces and is not listed is never integrated, and OpenMM does not say so: that is an error here.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::reading::{Engine, FS, PS, Place, Reading, Unit, count, number, scheme, times};
use super::xml;
use crate::error::{Error, Result};
use crate::number::Rational;

const CALLS: [(&str, usize); 2] = [("MTSLangevinIntegrator", 2), ("MTSIntegrator", 0)];

/// Where a call stands: its name, the place of dt among its arguments, what is in its parentheses.
struct Call {
    name: &'static str,
    first: usize,
    inside: Range<usize>,
}

pub(super) fn is_python(text: &str) -> bool {
    call(text).is_some()
}

/// The first call of one of the integrators, outside of comments.
fn call(text: &str) -> Option<Call> {
    let found = CALLS.iter().filter_map(|&(name, first)| {
        let is_call = |&(at, _): &(usize, &str)| {
            let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
            let before = &text[line..at];
            let follows = text[at + name.len()..].trim_start_matches([' ', '\t']).starts_with('(');
            follows
                && !before.contains('#')
                && !before.trim_start().starts_with("class ")
                && !before.ends_with(|c: char| c.is_alphanumeric())
        };
        let (at, _) = text.match_indices(name).find(is_call)?;
        let open = at + name.len() + text[at + name.len()..].find('(')? + 1;
        Some((at, Call { name, first, inside: open..closing(text, open)? }))
    });
    found.min_by_key(|(at, _)| *at).map(|(_, call)| call)
}

/// Where the parenthesis that was opened before `open` closes.
fn closing(text: &str, open: usize) -> Option<usize> {
    let mut depth = 1;
    for (i, c) in text[open..].char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(open + i);
        }
    }
    None
}

/// Ranges of the parts of `range` between commas that stand in no inner parentheses, without white space around.
fn split(text: &str, range: Range<usize>) -> Vec<Range<usize>> {
    let (mut parts, mut depth, mut from) = (Vec::new(), 0, range.start);
    for (i, c) in text[range.clone()].char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(trimmed(text, from..range.start + i));
                from = range.start + i + 1;
            }
            _ => {}
        }
    }
    parts.push(trimmed(text, from..range.end));
    parts.retain(|part| !part.is_empty());
    parts
}

fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let own = &text[range.clone()];
    let start = range.start + (own.len() - own.trim_start().len());
    start..start + own.trim().len()
}

pub(super) fn read(texts: &[&str]) -> Result<Reading> {
    let python = texts.iter().copied().find(|text| is_python(text));
    let mut reading = match python {
        Some(text) => integrator(text)?,
        None => {
            let serialized = texts.iter().find_map(|text| xml::openmm(text).transpose());
            let none = || {
                Error::missing(
                    "integrator",
                    "a system alone has no steps: give the integrator too, as Python text or serialized",
                )
            };
            serialized.ok_or_else(none)??
        }
    };
    let mut groups: BTreeMap<u64, Vec<String>> = BTreeMap::new();
    for text in texts {
        if text.trim_start().starts_with('<') {
            xml::groups(text, &mut groups)?;
        } else {
            python_groups(text, &mut groups, &mut reading.remarks);
        }
    }
    check(&reading, &groups)?;
    for force in &mut reading.forces {
        let names = force.strip_prefix("group ").and_then(|n| groups.get(&n.parse().ok()?));
        if let Some(names) = names.filter(|names| !names.is_empty()) {
            *force = format!("{force} ({})", names.join(", "));
        }
    }
    Ok(reading)
}

/// That every group with forces is integrated.
fn check(reading: &Reading, groups: &BTreeMap<u64, Vec<String>>) -> Result<()> {
    let listed: BTreeSet<u64> = reading
        .forces
        .iter()
        .flat_map(|force| force.split("group ").skip(1))
        .filter_map(|n| n.trim_end_matches([',', ' ']).parse().ok())
        .collect();
    if listed.is_empty() {
        return Ok(());
    }
    let missing: Vec<String> =
        groups.keys().filter(|group| !listed.contains(group)).map(ToString::to_string).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let noun = if missing.len() == 1 { "group" } else { "groups" };
    let remedy = format!(
        "{noun} {} would never be integrated, and OpenMM does not say so: list every group that has forces",
        missing.join(", ")
    );
    let shown: Vec<String> = listed.iter().map(ToString::to_string).collect();
    Err(Error::input("force groups", format!("only {} listed", shown.join(", ")), remedy))
}

fn integrator(text: &str) -> Result<Reading> {
    let call = call(text).expect("was recognized by it");
    let mut positional = Vec::new();
    let (mut dt, mut groups) = (None, None);
    for part in split(text, call.inside.clone()) {
        match text[part.clone()].split_once('=').map(|(key, _)| key.trim()) {
            Some("dt") => dt = Some(after_equals(text, part)),
            Some("groups") => groups = Some(after_equals(text, part)),
            Some(_) => {}
            None => positional.push(part),
        }
    }
    let form = || {
        let remedy = format!(
            "write {}({}4*femtoseconds, [(0,1),(1,8)])",
            call.name,
            if call.first == 2 { "300*kelvin, 1/picosecond, " } else { "" }
        );
        Error::input(call.name, &text[call.inside.clone()], remedy)
    };
    let dt = dt.or_else(|| positional.get(call.first).cloned()).ok_or_else(form)?;
    let groups = groups.or_else(|| positional.get(call.first + 1).cloned()).ok_or_else(form)?;
    let (place, unit) = time(text, dt)?;
    let outer = number("dt", &text[place.clone()])? * unit.size();
    let list = &text[groups.clone()];
    if !(list.starts_with('[') && list.ends_with(']') && list.len() >= 2) {
        return Err(Error::input(
            "groups",
            list,
            "write the list in place, as [(0,1),(1,8)]: names are not followed",
        ));
    }
    let mut entries: Vec<(u64, Range<usize>, u64)> = Vec::new();
    for pair in split(text, groups.start + 1..groups.end - 1) {
        let own = &text[pair.clone()];
        let bad =
            || Error::input("groups", own, "write each entry as (group, evaluations in an outermost step)");
        if !(own.starts_with('(') && own.ends_with(')') && own.len() >= 2) {
            return Err(bad());
        }
        let [group, n] =
            <[Range<usize>; 2]>::try_from(split(text, pair.start + 1..pair.end - 1)).map_err(|_| bad())?;
        let group = text[group].parse::<u64>().ok().filter(|g| *g < 32);
        let group = group
            .ok_or_else(|| Error::input("groups", own, "a force group is a whole number from 0 to 31"))?;
        entries.push((count("groups", &text[n.clone()])?, n, group));
    }
    entries.sort_by_key(|(n, ..)| std::cmp::Reverse(*n));
    let Some((most, ..)) = entries.first() else {
        return Err(Error::input("groups", list, "list at least one force group, as [(0,1),(1,8)]"));
    };
    if let Some(pair) = entries.windows(2).find(|pair| pair[0].0 % pair[1].0 != 0) {
        let remedy = format!("OpenMM refuses this: {} is no multiple of {}", pair[0].0, pair[1].0);
        return Err(Error::input("groups", list, remedy));
    }
    let inner = &outer / times(&Rational::from_integer(1.into()), *most);
    let steps = entries.iter().map(|(n, ..)| times(&inner, most / n)).collect();
    let mut reading = Reading::new(Engine::OpenMm, text, scheme(steps)?);
    reading.used = vec![format!(
        "{}({})",
        call.name,
        text[call.inside].split_whitespace().collect::<Vec<_>>().join(" ")
    )];
    let slowest = entries.last().expect("at least one entry").0;
    let mut level = 0;
    for (i, (n, place, group)) in entries.iter().enumerate() {
        if i > 0 && entries[i - 1].0 != *n {
            level += 1;
        }
        match reading.forces.get_mut(level) {
            Some(forces) => *forces += &format!(", group {group}"),
            None => reading.forces.push(format!("group {group}")),
        }
        // With an outermost group that is itself evaluated more than once, dt stays: only then the counts do not determine the steps.
        if slowest == 1 {
            reading.places.push((place.clone(), Place::PerOuter(level)));
        }
    }
    if slowest == 1 {
        reading.places.push((place, Place::Outer(unit)));
    }
    if call.name == "MTSLangevinIntegrator" {
        reading
            .remarks
            .push("the thermostat's friction is not part of the verdict: it damps all modes alike".into());
    }
    Ok(reading)
}

fn after_equals(text: &str, part: Range<usize>) -> Range<usize> {
    let at = text[part.clone()].find('=').map_or(part.start, |at| part.start + at + 1);
    trimmed(text, at..part.end)
}

/// The number in `4*unit.femtoseconds` or `0.004`, and its unit; OpenMM's own is the picosecond.
fn time(text: &str, range: Range<usize>) -> Result<(Range<usize>, Unit)> {
    let own = &text[range.clone()];
    let Some((left, right)) = own.split_once('*') else { return Ok((range, PS)) };
    let unit = |word: &str| {
        let word = word.trim().rsplit('.').next().unwrap_or_default();
        match word.strip_suffix('s').unwrap_or(word) {
            "femtosecond" => Some(FS),
            "picosecond" => Some(PS),
            "nanosecond" => Some(Unit("1000000")),
            "f" => Some(FS),
            _ => None,
        }
    };
    let star = range.start + left.len();
    match (unit(right), unit(left)) {
        (Some(size), _) => Ok((trimmed(text, range.start..star), size)),
        (_, Some(size)) => Ok((trimmed(text, star + 1..range.end), size)),
        _ => Err(Error::input("dt", own, "write the step as 4*femtoseconds or 0.004*picoseconds")),
    }
}

/// Groups that the text gives forces to; those that are no plain numbers are remarked.
fn python_groups(text: &str, groups: &mut BTreeMap<u64, Vec<String>>, remarks: &mut Vec<String>) {
    let mut unread = false;
    for name in ["setForceGroup(", "setReciprocalSpaceForceGroup("] {
        for (at, _) in text.match_indices(name) {
            let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
            let rest = &text[at + name.len()..];
            let argument = rest.split(')').next().unwrap_or_default().trim();
            if text[line..at].contains('#') {
                continue;
            }
            match argument.parse::<u64>() {
                Ok(group) if group < 32 => drop(groups.entry(group).or_default()),
                _ => unread = true,
            }
        }
    }
    if unread {
        remarks.push("some force groups are set by variables, which are not followed: make sure that every group with forces is listed".into());
    }
}
