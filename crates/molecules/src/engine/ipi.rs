//! i-PI: `<timestep>` is the outermost step, `<nmts>` the iterations of each level, level 0 the outermost.

use roxmltree::Node;

use super::reading::{
    Engine, FS, MOST_LEVELS, PS, Place, Reading, Unit, count, no_gradient, number, scheme, times,
};
use super::xml::{child, named, parse, words};
use crate::beads::Beads;
use crate::unit::decimal;
use number::{Error, Rational, Result};

/// Units of time of i-PI, in fs.
const UNITS: [(&str, Unit); 10] = [
    ("femtosecond", FS),
    ("picosecond", PS),
    ("attosecond", Unit("0.001")),
    ("nanosecond", Unit("1e6")),
    ("microsecond", Unit("1e9")),
    ("second", Unit("1e15")),
    // CODATA 2018: 2.4188843265857(47)e-17 s; the last digits are measured.
    ("atomic_unit", Unit("0.024188843265857")),
    ("automatic", Unit("0.024188843265857")),
    ("", Unit("0.024188843265857")),
    // Å (amu/eV)^(1/2): 1.01805057e-14 s, with CODATA 2018.
    ("ase", Unit("10.1805057")),
];

/// Modes of `<dynamics>` whose step is half kicks of each level and drifts between them.
const MODES: [&str; 4] = ["nve", "nvt", "npt", "nst"];

pub(super) fn ipi(text: &str) -> Result<Reading> {
    let document = parse(text)?;
    let root = document.root_element();
    let nodes = dynamics(root)?;
    let mut reading = one(nodes[0], text)?;
    for &other in &nodes[1..] {
        let other = one(other, text)?;
        if other.scheme != reading.scheme || other.forces != reading.forces {
            let remedy = "take different steps: give a file with one of them";
            return Err(Error::input("dynamics", format!("{} of them", nodes.len()), remedy));
        }
        reading.places.extend(other.places);
    }
    reading.remarks.extend(other_motions(root));
    reading.remarks.extend(no_gradient(&direct(root, text)));
    let (rings, remark) = beads(root, text)?.unzip();
    reading.beads = rings;
    reading.remarks.extend(remark);
    Ok(reading)
}

/// The elements that take steps.
fn dynamics<'a>(root: Node<'a, 'a>) -> Result<Vec<Node<'a, 'a>>> {
    let own = |motion: Node<'a, 'a>| {
        (motion.attribute("mode") == Some("dynamics")).then(|| child(motion, "dynamics")).flatten()
    };
    let motions = || root.descendants().filter(|node| node.has_tag_name("motion"));
    let found: Vec<Node> = motions().filter_map(own).collect();
    if !found.is_empty() {
        return Ok(found);
    }
    let modes: Vec<&str> =
        motions().filter_map(|motion| motion.attribute("mode")).filter(|mode| *mode != "multi").collect();
    let value = if modes.is_empty() { "no <motion>".into() } else { modes.join(", ") };
    let remedy = "only the time steps of <motion mode='dynamics'> are read";
    Err(Error::input("motion", value, remedy))
}

/// Motions beside dynamics, and what stands in `<dynamics>` that bears on steps and is not read.
fn other_motions(root: Node) -> Option<String> {
    let motions = root.descendants().filter(|node| node.has_tag_name("motion"));
    let mut modes: Vec<&str> = motions.filter_map(|motion| motion.attribute("mode")).collect();
    modes.retain(|mode| !["dynamics", "multi"].contains(mode));
    modes.sort_unstable();
    modes.dedup();
    (!modes.is_empty()).then(|| format!("not read: motion {}", modes.join(", ")))
}

/// The reading of one `<dynamics>`.
fn one<'a>(node: Node<'a, 'a>, text: &'a str) -> Result<Reading> {
    let mode = node.attribute("mode").unwrap_or("nve");
    if !MODES.contains(&mode) {
        let remedy = "is no scheme of kicks and drifts that is known here: nve, nvt, npt and nst are";
        return Err(Error::input("dynamics mode", mode, remedy));
    }
    let form = "give it, as <timestep units='femtosecond'> 4.0 </timestep>";
    let timestep = child(node, "timestep").ok_or_else(|| Error::missing("timestep", form))?;
    let given = timestep.attribute("units").unwrap_or_default().trim();
    let unit = UNITS.iter().find(|(name, _)| *name == given).map(|(_, unit)| *unit);
    let unit = unit.ok_or_else(|| {
        Error::input("timestep units", given, "write femtosecond, picosecond, second, atomic_unit or ase")
    })?;
    let (value, place) = words(timestep, text)?;
    let outer = number("timestep", value)? * unit.size();
    let mut reading = Reading::new(Engine::Ipi, text, scheme(vec![outer.clone()])?);
    let shown = if given.is_empty() { "atomic_unit" } else { given };
    reading.used.push(format!("timestep {value} {shown}"));
    reading.places = vec![(place, Place::Outer(unit))];
    reading.forces = vec!["all forces".into()];
    let weights = weights(node, text)?;
    let levels = child(node, "nmts").map(|nmts| iterations(nmts, text)).transpose()?;
    let asked = levels.as_ref().map_or(1, Vec::len);
    if let Some((name, texts)) = weights.iter().find(|(_, texts)| texts.len() != asked) {
        let remedy = format!("i-PI refuses this: nmts has {asked} of them");
        return Err(Error::input("mts_weights", format!("{name}: {} levels", texts.len()), remedy));
    }
    if let Some(levels) = levels {
        reading.used.push(format!("nmts {}", shown_list(&levels)));
        nested(&mut reading, &levels, &weights)?;
    }
    reading.remarks.extend(unread(node));
    Ok(reading)
}

/// An iteration count with its place.
type Iterations = (u64, std::ops::Range<usize>);

fn shown_list(levels: &[Iterations]) -> String {
    let counts: Vec<String> = levels.iter().map(|(n, _)| n.to_string()).collect();
    format!("[{}]", counts.join(", "))
}

fn iterations(nmts: Node, text: &str) -> Result<Vec<Iterations>> {
    let (list, place) = words(nmts, text)?;
    let bare = || Error::input("nmts", list, "write [1,2]");
    let inside = list.strip_prefix('[').and_then(|list| list.strip_suffix(']')).ok_or_else(bare)?;
    let (mut levels, mut at) = (Vec::new(), place.start + 1);
    for part in inside.split(',') {
        if levels.len() == MOST_LEVELS {
            return Err(Error::input("nmts", list, "there are at most 16 levels"));
        }
        let text = part.trim();
        let start = at + (part.len() - part.trim_start().len());
        levels.push((count("nmts", text)?, start..start + text.len()));
        at += part.len() + 1;
    }
    Ok(levels)
}

/// The steps of each level that has forces, and where they stand.
fn nested(reading: &mut Reading, levels: &[Iterations], weights: &[(&str, Vec<String>)]) -> Result<()> {
    let on = |level: usize| {
        let object = weights.iter().map(|(name, texts)| (name, texts[level].as_str()));
        let named = object.filter(|(_, weight)| *weight != "0").map(|(name, weight)| {
            if weight == "1" { (*name).to_string() } else { format!("{weight} {name}") }
        });
        named.collect::<Vec<_>>().join(", ")
    };
    let mut step = reading.scheme.outer().clone();
    let (mut clocks, mut idle) = (Vec::new(), Vec::new());
    for (level, (n, _)) in levels.iter().enumerate() {
        step /= times(&Rational::from_integer(1.into()), *n);
        let forces = if weights.is_empty() { format!("mts_weights of level {level}") } else { on(level) };
        if forces.is_empty() {
            idle.push(level.to_string());
        } else {
            clocks.push((step.clone(), forces, level));
        }
    }
    clocks.reverse();
    if clocks.is_empty() {
        return Err(Error::input("mts_weights", "0", "no level has a force"));
    }
    let steps: Vec<Rational> = clocks.iter().map(|(step, ..)| step.clone()).collect();
    let (count, whole) = (steps.len(), scheme(steps)?);
    let distinct = whole.steps().len() == count;
    reading.forces = clocks.iter().map(|(_, forces, _)| forces.clone()).collect();
    reading.scheme = whole;
    if !idle.is_empty() {
        reading.remarks.push(format!("no force on level {}: no clock", idle.join(", ")));
    }
    if !distinct {
        reading.remarks.push("levels of equal steps are taken as one".into());
        reading.forces = vec!["forces of all its levels".into(); reading.scheme.steps().len()];
    }
    // An outermost level of several iterations, idle levels or levels of equal steps: then these two numbers
    // do not determine the steps.
    if levels[0].0 != 1 || !idle.is_empty() || !distinct {
        reading.places.clear();
    } else if let Some((_, second)) = levels.get(1) {
        reading.places.push((second.clone(), Place::LastRatio));
    }
    Ok(())
}

/// Each `<force>` of the dynamics' own system with its weights, level by level, the outermost first; without
/// any it has one level.
fn weights<'a>(node: Node<'a, 'a>, text: &'a str) -> Result<Vec<(&'a str, Vec<String>)>> {
    let system = node.ancestors().find(|node| node.has_tag_name("system"));
    let forces = system.and_then(|system| child(system, "forces"));
    let forces = forces.into_iter().flat_map(|forces| forces.children());
    let own = |node: Node<'a, 'a>| {
        let list = child(node, "mts_weights")
            .map(|node| words(node, text))
            .transpose()?
            .map_or("[1]", |pair| pair.0);
        let inside = list.trim_start_matches('[').trim_end_matches(']').split(',');
        let short = |part: &str| {
            let part = part.trim();
            // Without the sign of a zero.
            let plain = part.parse::<f64>().ok().map(|weight| format!("{}", weight + 0.0));
            plain.unwrap_or_else(|| part.into())
        };
        Ok((node.attribute("forcefield").unwrap_or("a force").trim(), inside.map(short).collect()))
    };
    forces.filter(|node| node.has_tag_name("force")).map(own).collect()
}

/// What stands in `<dynamics>` and was not read.
fn unread(node: Node) -> Option<String> {
    let known = ["timestep", "nmts", "thermostat", "barostat"];
    let names = node.children().filter(Node::is_element).map(|node| node.tag_name().name().to_string());
    let names: Vec<String> = names.filter(|name| !known.contains(&name.as_str())).collect();
    (!names.is_empty()).then(|| format!("not read: {} of dynamics", names.join(", ")))
}

/// The force fields whose model is asked for forces that it predicts directly: `non_conservative:True` among
/// the parameters.
fn direct<'a>(root: Node<'a, 'a>, text: &'a str) -> Vec<&'a str> {
    let is_direct = |node: &Node<'a, 'a>| {
        let parameters = named(*node, "parameters").and_then(|node| words(node, text).ok());
        let parameters = parameters.map_or("", |(text, _)| text).chars();
        let squeezed: String = parameters.filter(|c| !c.is_whitespace() && !"'\"".contains(*c)).collect();
        squeezed.to_ascii_lowercase().contains("non_conservative:true")
    };
    let fields = root.descendants().filter(|node| node.tag_name().name().starts_with("ff"));
    fields.filter(is_direct).filter_map(|node| Some(node.attribute("name")?.trim())).collect()
}

/// What is to be known of a ring polymer: its modes vibrate beside those that are asked about.
fn beads(root: Node, text: &str) -> Result<Option<(Beads, String)>> {
    let given =
        root.descendants().filter(|node| node.has_tag_name("initialize") || node.has_tag_name("beads"));
    let given: Vec<&str> = given.filter_map(|node| node.attribute("nbeads")).collect();
    let count = given.iter().filter_map(|text| text.trim().parse::<u32>().ok()).max().unwrap_or(1);
    let beads = Beads { count: count.into(), kelvin: kelvin(root, text) };
    if count < 2 {
        return Ok(None);
    }
    let modes = named(root, "normal_modes");
    let how = match modes.and_then(|modes| modes.attribute("propagator")).unwrap_or("exact") {
        "cayley" => "propagator cayley is stable for them at any step".to_string(),
        "bab" => {
            let pair =
                modes.and_then(|modes| child(modes, "nmts")).map(|node| words(node, text)).transpose()?;
            let n = pair.map_or("10", |pair| pair.0);
            format!("propagator bab takes them by kicks and drifts, {n} times in an innermost step")
        }
        _ => "propagator exact resonates where an outer step is near a multiple of half their period".into(),
    };
    let ends = beads.ends().map_or_else(String::new, |[fastest, _]| {
        let kelvin = beads.kelvin.as_ref().map(decimal).unwrap_or_default();
        format!(", of periods down to {fastest:.3} fs at {kelvin} K,")
    });
    let remark = format!("{count} beads: the modes of their rings{ends} vibrate beside yours; {how}");
    Ok(Some((beads, remark)))
}

/// The temperature of the rings in kelvin, where their frequencies are those of RPMD and it is given.
fn kelvin(root: Node, text: &str) -> Option<Rational> {
    let modes = named(root, "normal_modes").and_then(|modes| child(modes, "frequencies"));
    let is_physical = modes.is_none_or(|modes| modes.attribute("style").is_none_or(|style| style == "rpmd"));
    let given = root.descendants().find(|node| {
        node.has_tag_name("temperature") && node.attribute("units").map(str::trim) == Some("kelvin")
    });
    let (own, _) = given.filter(|_| is_physical).and_then(|node| words(node, text).ok())?;
    number("temperature", own).ok()
}
