//! OpenMM's serialized integrators and systems.
//!
//! `MTSIntegrator` is a custom integrator whose steps stand written out. What is none of its computations is
//! refused, and the places of all kicks and drifts are checked: a group kicks twice at each multiple of its
//! step, once at both ends.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use num_integer::Integer;
use roxmltree::Node;

use super::reading::{Engine, Loop, PS, Place, Reading, count, number, scheme, times};
use super::xml::{child, named, parse};
use crate::constraint::Constraints;
use number::rational::from_f64_meant;
use number::{Error, Rational, Result, to_f64};

const EXPRESSION: &str = "computationExpression";

/// Integrators that kick with all forces once a step.
pub(super) const PLAIN: [&str; 5] = [
    "VerletIntegrator",
    "LangevinIntegrator",
    "LangevinMiddleIntegrator",
    "NoseHooverIntegrator",
    "QTBIntegrator",
];

/// Force objects that exert no force.
const FORCELESS: [&str; 6] = [
    "AndersenThermostat",
    "CMMotionRemover",
    "MonteCarloAnisotropicBarostat",
    "MonteCarloBarostat",
    "MonteCarloFlexibleBarostat",
    "MonteCarloMembraneBarostat",
];

/// The serialized integrator in a text; `None` for a text that holds none.
pub(super) fn integrator(text: &str) -> Result<Option<Reading>> {
    let document = parse(text)?;
    let Some(node) = named(document.root_element(), "Integrator") else { return Ok(None) };
    let kind = node.attribute("type").unwrap_or("Integrator");
    if kind != "CustomIntegrator" && !PLAIN.contains(&kind) {
        let remedy =
            "is no integrator whose steps are read: kicks and drifts alone are read, and MTSIntegrator";
        return Err(Error::input("Integrator", kind, remedy));
    }
    let size = node.attributes().find(|attribute| attribute.name() == "stepSize");
    let size = size.ok_or_else(|| Error::missing("stepSize", "a serialized integrator has it, in ps"))?;
    // The double of a step that was computed: 0.009000000000000001 is 0.009.
    let stated = number("stepSize", size.value())?;
    let outer = from_f64_meant(to_f64(&stated)).unwrap_or(stated) * PS.size();
    let mut reading = Reading::new(Engine::OpenMm, text, scheme(vec![outer])?);
    reading.used = vec![format!("{kind} stepSize {}", size.value())];
    if kind == "CustomIntegrator" {
        written_out(&mut reading, node, text, size.range_value())?;
    } else {
        reading.forces = vec![all_forces(node)?];
        reading.places = vec![(size.range_value(), Place::Outer(PS))];
    }
    Ok(Some(reading))
}

/// The groups that an integrator was told to integrate.
fn all_forces(node: Node) -> Result<String> {
    let mask = node.attribute("integrationForceGroups").unwrap_or("-1");
    let bits = mask.parse::<i64>().ok().and_then(|mask| u32::try_from(mask & 0xffff_ffff).ok());
    let bad =
        || Error::input("integrationForceGroups", mask, "a whole number has a bit for each force group");
    match bits.ok_or_else(bad)? {
        u32::MAX => Ok("all forces".into()),
        0 => Err(Error::input("integrationForceGroups", mask, "no force is integrated")),
        bits => {
            let groups = (0..32).filter(|group| bits >> group & 1 == 1);
            Ok(groups.map(|group| format!("group {group}")).collect::<Vec<_>>().join(", "))
        }
    }
}

/// What a computation does to the orbit.
enum Piece {
    /// By half the force of a group over dt/n.
    Kick(u64, u64),
    /// By the velocity over dt/n.
    Drift(u64),
    Idle,
}

fn piece(expression: &str) -> Result<Piece> {
    let squeezed: String = expression.chars().filter(|c| !c.is_whitespace()).collect();
    if let Some((n, group)) = squeezed
        .strip_prefix("v+0.5*(dt/")
        .and_then(|rest| rest.strip_suffix("/m"))
        .and_then(|rest| rest.split_once(")*f"))
    {
        let group = group.parse::<u64>().ok().filter(|group| *group < 32);
        let range = || Error::input(EXPRESSION, expression, "a force group is a whole number from 0 to 31");
        return Ok(Piece::Kick(group.ok_or_else(range)?, count(EXPRESSION, n)?));
    }
    if let Some(n) = squeezed.strip_prefix("x+(dt/").and_then(|rest| rest.strip_suffix(")*v")) {
        return Ok(Piece::Drift(count(EXPRESSION, n)?));
    }
    // Constraints, and the thermostat of MTSLangevinIntegrator.
    let is_correction = squeezed.starts_with("v+(x-x1)/(dt/");
    if is_correction || ["", "x", "a*v+b*sqrt(kT/m)*gaussian"].contains(&squeezed.as_str()) {
        return Ok(Piece::Idle);
    }
    let remedy = "is no computation of MTSIntegrator: give the steps themselves, by --steps";
    Err(Error::input("CustomIntegrator", expression, remedy))
}

/// The evaluations of each group in an outer step, those of a group at equal distances.
fn evaluations(pieces: &[Piece]) -> Result<BTreeMap<u64, Vec<u64>>> {
    let strange = |what: &str| {
        Err(Error::input(
            "CustomIntegrator",
            what,
            "differ from MTSIntegrator's: give the steps themselves, by --steps",
        ))
    };
    // Parts of dt that all distances are multiples of.
    let parts = pieces.iter().try_fold(1_u64, |parts, piece| match piece {
        Piece::Kick(_, n) | Piece::Drift(n) => Some(parts.lcm(n)).filter(|parts| *parts <= 1_u64 << 40),
        Piece::Idle => Some(parts),
    });
    let Some(parts) = parts else { return strange("its distances") };
    let (mut time, mut kicks) = (0_u64, BTreeMap::<(u64, u64), Vec<u64>>::new());
    for piece in pieces {
        match piece {
            Piece::Kick(group, n) => kicks.entry((*n, *group)).or_default().push(time),
            Piece::Drift(n) => time = time.saturating_add(parts / n),
            Piece::Idle => {}
        }
    }
    if kicks.is_empty() || time != parts {
        return strange("its computations");
    }
    let mut counts: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
    let mut seen = BTreeSet::new();
    for ((n, group), times) in kicks {
        let expected = (0..n).flat_map(|turn| [turn, turn + 1]).map(|turn| turn * (parts / n));
        if !times.iter().copied().eq(expected) || !seen.insert(group) {
            return strange("the kicks of its groups");
        }
        counts.entry(n).or_default().push(group);
    }
    Ok(counts)
}

/// The levels of a custom integrator whose loops stand written out.
fn written_out(reading: &mut Reading, node: Node, text: &str, size: Range<usize>) -> Result<()> {
    let expressions = node.descendants().filter_map(|node| node.attribute(EXPRESSION));
    let pieces = expressions.map(piece).collect::<Result<Vec<_>>>()?;
    let counts = evaluations(&pieces)?;
    let outer = reading.scheme.outer().clone();
    let step = |n: &u64| &outer / times(&Rational::from_integer(1.into()), *n);
    let words = |groups: &Vec<u64>| {
        groups.iter().map(|group| format!("group {group}")).collect::<Vec<_>>().join(", ")
    };
    reading.forces = counts.values().rev().map(words).collect();
    reading.scheme = scheme(counts.keys().rev().map(step).collect())?;
    // Another ratio is another number of turns. Langevin's a and b belong to the innermost step, which stays.
    let counts: Vec<u64> = counts.into_keys().collect();
    reading.places = match counts[..] {
        [1] => vec![(size, Place::Outer(PS))],
        [1, next, ..] => match turns(node, text, next) {
            Some((range, own)) => vec![(size, Place::Outer(PS)), (range, Place::Loop(own))],
            None => vec![],
        },
        _ => vec![],
    };
    Ok(())
}

/// The loop over the level below the outermost: what stands between the kicks of the outermost level, if that
/// is one turn so many times.
fn turns(root: Node, text: &str, turns: u64) -> Option<(Range<usize>, Loop)> {
    let all: Vec<Node> = root.descendants().filter(|node| node.attribute(EXPRESSION).is_some()).collect();
    let is_outermost = |node: &&Node| {
        node.attribute(EXPRESSION).is_some_and(|attribute| attribute.starts_with("v+0.5*(dt/1)*f"))
    };
    let leading = all.iter().position(|node| is_outermost(&node))?;
    let first = leading + all[leading..].iter().take_while(is_outermost).count();
    let last = first + all[first..].iter().position(|node| is_outermost(&node))?;
    let each = (last - first) / usize::try_from(turns).ok()?;
    let expressions: Vec<_> = all[first..last].iter().map(|node| node.attribute(EXPRESSION)).collect();
    let texts = expressions.get(..each).filter(|expressions| !expressions.is_empty())?;
    if each * turns as usize != last - first || !expressions.chunks(each).all(|turn| turn == texts) {
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

/// The groups of a serialized system's forces, by their names.
pub(super) fn groups(text: &str, groups: &mut BTreeMap<u64, Vec<String>>) -> Result<bool> {
    let document = parse(text)?;
    let Some(system) = named(document.root_element(), "System") else { return Ok(false) };
    for force in system.descendants().filter(|node| node.has_tag_name("Force")) {
        let name = force.attribute("type").unwrap_or("Force");
        if FORCELESS.contains(&name) {
            continue;
        }
        let text = force.attribute("forceGroup").unwrap_or("0");
        let field = format!("forceGroup of {name}");
        let bad = || Error::input(&field, text, "a force group is a whole number from 0 to 31");
        groups.entry(text.parse().ok().filter(|g| *g < 32).ok_or_else(bad)?).or_default().push(name.into());
        // Ewald, PME and PME of dispersion have a part in reciprocal space; -1 leaves it with the rest.
        let has_reciprocal = force.attribute("method").is_none_or(|method| ["3", "4", "5"].contains(&method));
        let reciprocal =
            force.attribute("recipForceGroup").and_then(|attribute| attribute.parse::<u64>().ok());
        if let Some(group) = reciprocal.filter(|group| has_reciprocal && *group < 32) {
            groups.entry(group).or_default().push(format!("{name}, reciprocal space"));
        }
    }
    Ok(true)
}

/// Atoms lighter than this, in amu, may be hydrogens that took mass from their neighbours.
const LIGHT: f64 = 4.5;

/// Which bonds a serialized system holds, and what has to be known of them.
pub(super) fn held(text: &str) -> Result<(Option<Constraints>, Option<String>)> {
    let document = parse(text)?;
    let Some(system) = named(document.root_element(), "System") else { return Ok((None, None)) };
    let inside = |name: &str| {
        child(system, name).into_iter().flat_map(|node| node.children().filter(Node::is_element))
    };
    let pairs = inside("Constraints").count();
    if pairs == 0 {
        return Ok((None, None));
    }
    let masses: Vec<f64> = inside("Particles")
        .map(|node| node.attribute("mass").and_then(|mass| mass.parse().ok()).unwrap_or(0.0))
        .collect();
    let is_light = |bond: &Node| {
        let ends =
            ["p1", "p2"].map(|end| bond.attribute(end).and_then(|attribute| attribute.parse::<usize>().ok()));
        ends.iter().any(|end| end.and_then(|at| masses.get(at)).is_none_or(|mass| *mass < LIGHT))
    };
    let forces = || inside("Forces");
    let is_bonds = |node: &Node| node.attribute("type").is_some_and(|kind| kind.contains("Bond"));
    let bonds = forces().filter(|node| node.attribute("type") == Some("HarmonicBondForce"));
    let bonds: Vec<Node> =
        bonds.flat_map(|force| force.descendants()).filter(|node| node.has_tag_name("Bond")).collect();
    let free = bonds.iter().filter(|bond| is_light(bond)).count();
    let others = forces().any(|node| is_bonds(&node) && node.attribute("type") != Some("HarmonicBondForce"));
    Ok(if others || free > 0 {
        let remark = format!(
            "the system holds {pairs} distances, and not all of its bonds with hydrogen: say by --constraints which"
        );
        (None, Some(remark))
    } else if bonds.is_empty() {
        (Some(Constraints::AllBonds), None)
    } else {
        (Some(Constraints::HBonds), None)
    })
}
