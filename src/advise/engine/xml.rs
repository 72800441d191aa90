//! XML: i-PI's input, OpenMM's serialized integrators and systems.

use std::collections::BTreeMap;
use std::ops::Range;

use roxmltree::{Document, Node};

use super::reading::{
    Engine, FS, Loop, MOST_LEVELS, PS, Place, Reading, Unit, count, no_gradient, number, scheme, times,
};
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::number::rational::{from_f64_meant, to_f64};

/// Elements nested more deeply than this are none of an engine's.
const DEEPEST: usize = 200;

fn parse(text: &str) -> Result<Document<'_>> {
    let mut depth: usize = 0;
    for (i, _) in text.match_indices('<') {
        match text.as_bytes().get(i + 1) {
            Some(b'/') => depth = depth.saturating_sub(1),
            Some(b'!' | b'?') => {}
            _ if text[i..].find('>').is_some_and(|end| !text[i..i + end].ends_with('/')) => depth += 1,
            _ => {}
        }
        if depth > DEEPEST {
            return Err(Error::input("engine", "XML nested too deeply", "give the engine's own input"));
        }
    }
    Document::parse(text).map_err(|cause| Error::input("engine", "XML", format!("cannot be read: {cause}")))
}

/// The engine by the root element; none for other XML.
///
/// # Errors
/// XML that is none.
pub(super) fn recognized(text: &str) -> Result<Option<Engine>> {
    Ok(match parse(text)?.root_element().tag_name().name() {
        "simulation" => Some(Engine::Ipi),
        "Integrator" | "System" => Some(Engine::OpenMm),
        _ => None,
    })
}

fn named<'a>(root: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    root.descendants().find(|node| node.is_element() && node.tag_name().name() == name)
}

/// The text of an element with its place, without white space around.
fn words<'a>(node: Node<'a, '_>, text: &'a str) -> (&'a str, usize) {
    let Some(child) = node.children().find(Node::is_text) else { return ("", 0) };
    let range = child.range();
    let own = text.get(range.clone()).unwrap_or_default();
    let start = range.start + (own.len() - own.trim_start().len());
    (own.trim(), start)
}

/// `<timestep>`, the outermost step; `<nmts>`, the iterations of each level, level 0 the outermost.
pub(super) fn ipi(text: &str) -> Result<Reading> {
    let document = parse(text)?;
    let root = document.root_element();
    let timestep = named(root, "timestep").ok_or_else(|| {
        Error::missing("timestep", "give it, as <timestep units='femtosecond'> 4.0 </timestep>")
    })?;
    let unit = match timestep.attribute("units") {
        Some("femtosecond") => FS,
        Some("picosecond") => PS,
        Some("second") => Unit("1e15"),
        // CODATA 2018: 2.4188843265857(47)e-17 s; the last digits are measured.
        None | Some("atomic_unit" | "automatic") => Unit("0.024188843265857"),
        Some(other) => {
            return Err(Error::input(
                "timestep units",
                other,
                "write femtosecond, picosecond, second or atomic_unit",
            ));
        }
    };
    let (value, start) = words(timestep, text);
    let outer = number("timestep", value)? * unit.size();
    let mut reading = Reading::new(Engine::Ipi, text, scheme(vec![outer.clone()])?);
    reading.used.push(format!("timestep {value}"));
    let Some(nmts) = named(root, "nmts") else {
        reading.forces = vec!["all forces".into()];
        reading.places = vec![(start..start + value.len(), Place::Outer(unit))];
        return Ok(reading);
    };
    let (list, from) = words(nmts, text);
    reading.used.push(format!("nmts {list}"));
    let inside = list
        .strip_prefix('[')
        .and_then(|list| list.strip_suffix(']'))
        .ok_or_else(|| Error::input("nmts", list, "write [1,2]"))?;
    let (mut steps, mut step, mut at, mut second) = (Vec::new(), outer, from + 1, 0..0);
    for (level, part) in inside.split(',').enumerate() {
        let own = part.trim();
        let n = count("nmts", own)?;
        if level >= MOST_LEVELS {
            return Err(Error::input("nmts", list, "there are at most 16 levels"));
        }
        let place = at + (part.len() - part.trim_start().len());
        if level == 1 {
            second = place..place + own.len();
        }
        at += part.len() + 1;
        step /= times(&Rational::from_integer(1.into()), n);
        steps.push(step.clone());
    }
    steps.reverse();
    let levels = steps.len();
    reading.scheme = scheme(steps)?;
    let weights = weights(root, text);
    let on = |level: usize| {
        let own = weights.iter().filter_map(|(name, weights)| {
            Some((name, *weights.get(level)?)).filter(|(_, weight)| *weight != "0")
        });
        let named = own
            .map(|(name, weight)| if weight == "1" { name.to_string() } else { format!("{weight} {name}") });
        named.collect::<Vec<_>>().join(", ")
    };
    reading.forces = (0..levels)
        .rev()
        .map(|level| if on(level).is_empty() { format!("mts_weights of level {level}") } else { on(level) })
        .collect();
    reading.remarks.extend(no_gradient(&direct(root, text)));
    if reading.scheme.steps().len() < levels {
        reading.remarks.push("levels of equal steps are taken as one".into());
        reading.forces = vec!["forces of all its levels".into(); reading.scheme.steps().len()];
    }
    // An outermost level of several iterations, or levels of equal steps: then these two numbers do not determine the steps.
    if inside.split(',').next().map(str::trim) == Some("1") && reading.scheme.steps().len() == levels {
        reading.places = vec![(start..start + value.len(), Place::Outer(unit))];
        if levels > 1 {
            reading.places.push((second, Place::LastRatio));
        }
    }
    Ok(reading)
}

/// Each `<force>` with its weights, level by level, the outermost first, as written.
fn weights<'a>(root: Node<'a, 'a>, text: &'a str) -> Vec<(&'a str, Vec<&'a str>)> {
    let forces = root.descendants().filter(|node| node.has_tag_name("force"));
    let own = |node: Node<'a, 'a>| {
        let inside = words(named(node, "mts_weights")?, text).0.strip_prefix('[')?.strip_suffix(']')?;
        let short = |part: &'a str| {
            let part = part.trim();
            if part.contains('.') { part.trim_end_matches('0').trim_end_matches('.') } else { part }
        };
        Some((node.attribute("forcefield")?.trim(), inside.split(',').map(short).collect()))
    };
    forces.filter_map(own).collect()
}

/// The force fields whose model is asked for forces that it predicts directly: `non_conservative:True` among the parameters.
fn direct<'a>(root: Node<'a, 'a>, text: &'a str) -> Vec<&'a str> {
    let is_direct = |node: &Node<'a, 'a>| {
        let parameters = named(*node, "parameters").map_or("", |node| words(node, text).0);
        let squeezed: String =
            parameters.chars().filter(|c| !c.is_whitespace() && !"'\"".contains(*c)).collect();
        squeezed.to_ascii_lowercase().contains("non_conservative:true")
    };
    let fields = root.descendants().filter(|node| node.tag_name().name().starts_with("ff"));
    fields.filter(is_direct).filter_map(|node| Some(node.attribute("name")?.trim())).collect()
}

const EXPRESSION: &str = "computationExpression";

/// The loop over the level below the outermost: what stands between the kicks of the outermost level, if that is one turn so many times.
fn turns(root: Node, text: &str, turns: u64) -> Option<(Range<usize>, Loop)> {
    let all: Vec<Node> = root.descendants().filter(|node| node.attribute(EXPRESSION).is_some()).collect();
    let is_outermost =
        |node: &&Node| node.attribute(EXPRESSION).is_some_and(|own| own.starts_with("v+0.5*(dt/1)*f"));
    let leading = all.iter().position(|node| is_outermost(&node))?;
    let first = leading + all[leading..].iter().take_while(is_outermost).count();
    let last = first + all[first..].iter().position(|node| is_outermost(&node))?;
    let each = (last - first) / usize::try_from(turns).ok()?;
    let expressions: Vec<_> = all[first..last].iter().map(|node| node.attribute(EXPRESSION)).collect();
    let own = expressions.get(..each).filter(|own| !own.is_empty())?;
    if each * turns as usize != last - first || !expressions.chunks(each).all(|turn| turn == own) {
        return None;
    }
    let (begin, end) = (all[first].range().start, all[last - 1].range().end);
    let turn = text.get(begin..all[first + each - 1].range().end)?.to_string();
    let gap = match all[..last].get(first + each) {
        Some(next) => text.get(begin + turn.len()..next.range().start)?.to_string(),
        None => String::new(),
    };
    Some((begin..end, Loop { turn, gap, turns }))
}

/// A serialized integrator: for a custom one the evaluations of each group stand in its computations, `v+0.5*(dt/8)*f1/m`.
/// `None` for a text that holds none.
pub(super) fn openmm(text: &str) -> Result<Option<Reading>> {
    if !text.trim_start().starts_with('<') {
        return Ok(None);
    }
    let document = parse(text)?;
    let root = document.root_element();
    let Some(node) = named(root, "Integrator") else { return Ok(None) };
    let attribute = node.attributes().find(|attribute| attribute.name() == "stepSize");
    let size =
        attribute.ok_or_else(|| Error::missing("stepSize", "a serialized integrator has it, in ps"))?;
    // The double of a step that was computed: 0.009000000000000001 is 0.009.
    let stated = number("stepSize", size.value())?;
    let outer = from_f64_meant(to_f64(&stated)).unwrap_or(stated) * PS.size();
    let kind = node.attribute("type").unwrap_or("Integrator");
    let mut counts: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
    for computation in node.descendants().filter_map(|node| node.attribute(EXPRESSION)) {
        let expression: String = computation.chars().filter(|c| !c.is_whitespace()).collect();
        let Some((n, group)) = expression.strip_prefix("v+0.5*(dt/").and_then(|rest| rest.split_once(")*f"))
        else {
            continue;
        };
        let group =
            group.strip_suffix("/m").and_then(|group| group.parse::<u64>().ok()).filter(|group| *group < 32);
        let Some(group) = group else { continue };
        let groups = counts.entry(count(EXPRESSION, n)?).or_default();
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    let mut reading = Reading::new(Engine::OpenMm, text, scheme(vec![outer.clone()])?);
    reading.used = vec![format!("{kind} stepSize {}", size.value())];
    if counts.is_empty() {
        if kind == "CustomIntegrator" {
            let remedy = "its computations are not those of MTSIntegrator: give the steps themselves";
            return Err(Error::input("Integrator", kind, remedy));
        }
        reading.forces = vec!["all forces".into()];
        reading.places = vec![(size.range_value(), Place::Outer(PS))];
        return Ok(Some(reading));
    }
    let steps = counts.keys().rev().map(|n| &outer / times(&Rational::from_integer(1.into()), *n)).collect();
    reading.scheme = scheme(steps)?;
    let words = |groups: &Vec<u64>| {
        groups.iter().map(|group| format!("group {group}")).collect::<Vec<_>>().join(", ")
    };
    reading.forces = counts.values().rev().map(words).collect();
    // The loops stand written out: another ratio is another number of turns. Langevin's a and b belong to the innermost step, which stays.
    let counts: Vec<u64> = counts.into_keys().collect();
    reading.places = match counts[..] {
        [1] => vec![(size.range_value(), Place::Outer(PS))],
        [1, next, ..] => match turns(node, text, next) {
            Some((range, own)) => vec![(size.range_value(), Place::Outer(PS)), (range, Place::Loop(own))],
            None => vec![],
        },
        _ => vec![],
    };
    Ok(Some(reading))
}

/// The groups of a serialized system's forces.
pub(super) fn groups(text: &str, groups: &mut BTreeMap<u64, Vec<String>>) -> Result<()> {
    let document = parse(text)?;
    let Some(system) = named(document.root_element(), "System") else { return Ok(()) };
    for force in system.descendants().filter(|node| node.tag_name().name() == "Force") {
        let name = force.attribute("type").unwrap_or("Force");
        let own = force.attribute("forceGroup").unwrap_or("0");
        let bad = || {
            Error::input(
                &format!("forceGroup of {name}"),
                own,
                "a force group is a whole number from 0 to 31",
            )
        };
        groups.entry(own.parse().ok().filter(|g| *g < 32).ok_or_else(bad)?).or_default().push(name.into());
        let reciprocal = force.attribute("recipForceGroup").and_then(|own| own.parse::<u64>().ok());
        if let Some(group) = reciprocal.filter(|group| *group < 32) {
            groups.entry(group).or_default().push(format!("{name}, reciprocal space"));
        }
    }
    Ok(())
}
